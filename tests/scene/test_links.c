/* SPDX-License-Identifier: MIT */
/* Weighted links, flags of links and links of rest length 0: definitions, forces as derivatives of the energy, the
   stable step, attachments, damping in all directions. */
#include <stdio.h>

#include "test_scene.h"

static model m;

/* --------------------------------------------------------------------------------------------------- definitions */

static void check_refused(spring_weighted_link w, spring_status status, const char *field)
{
    m.weighted[1] = w;
    const char *found = NULL;
    size_t index = 77;
    CHECK(spring_scene_check(&m.def, &found, &index) == status && (field == NULL) == (found == NULL), field);
    CHECK(field == NULL || (strcmp(found, field) == 0 && index == 1), field);
}

static void definitions(void)
{
    build(&m, (uint32_t[]){5, 1, 1}, 3, 0);
    const spring_weighted_link good = {{0, 1, 2, 3}, {0.2, 0.3, 0.5, -1}, 0.1, 20, 0.3};
    const double huge = sizeof(scalar) == 4 ? 3e38 : 1.7e308;
    spring_weighted_link w = m.weighted[0] = good;
    m.def.weighted_link = m.weighted;
    m.def.weighted_links = 2;
    m.def.methods = 1u << SPRING_LEAPFROG;
    check_refused(w, SPRING_OK, NULL);
    w.weight[2] = 0, w.weight[3] = -0.5, w.particle[2] = UINT32_MAX;
    check_refused(w, SPRING_OK, NULL); /* an unused particle */
    memset(&w, 0, sizeof w);
    check_refused(w, SPRING_OK, NULL); /* of no particle */
    w = good, w.particle[1] = 5;
    check_refused(w, SPRING_ERANGE, "weighted_link.particle");
    w = good, w.particle[1] = 3;
    check_refused(w, SPRING_EINVAL, "weighted_link.particle");
    w = good, w.weight[1] += 2e-12;
    check_refused(w, SPRING_EINVAL, "weighted_link.weight");
    w = good, w.weight[1] = NAN;
    check_refused(w, SPRING_EINVAL, "weighted_link.weight");
    w = good, w.rest = -0.1;
    check_refused(w, SPRING_EINVAL, "weighted_link.rest");
    w = good, w.stiffness = INFINITY;
    check_refused(w, SPRING_EINVAL, "weighted_link.stiffness");
    w = good, w.damping = -1;
    check_refused(w, SPRING_EINVAL, "weighted_link.damping");
    w = good, w.stiffness = huge;
    check_refused(w, SPRING_EINVAL, "weighted_link.stiffness"); /* the row of the stable step overflows */
    m.weighted[1] = good;
    m.def.weighted_link = NULL;
    const char *field = NULL;
    CHECK(spring_scene_check(&m.def, &field, NULL) == SPRING_EINVAL && strcmp(field, "weighted_link") == 0, "NULL");
    m.def.weighted_link = m.weighted;
    m.def.methods = 1u << SPRING_RKN8;
    CHECK(spring_scene_check(&m.def, &field, NULL) == SPRING_EUNSUPPORTED, "damped");
    m.weighted[0].damping = m.weighted[1].damping = 0;
    CHECK(spring_scene_check(&m.def, &field, NULL) == SPRING_OK, "without damping, with every method");
    m.link[2].flags = 4;
    CHECK(spring_scene_check(&m.def, &field, NULL) == SPRING_EINVAL && strcmp(field, "link.flags") == 0, "unknown");
    for (uint32_t flags = 1; flags < 4; flags++) {
        m.link[2].flags = flags;
        m.link[2].rest = 0;
        CHECK(spring_scene_check(&m.def, &field, NULL) == SPRING_EUNSUPPORTED, "RKN8, whatever the rest length is");
        m.def.axes = 1;
        m.def.methods = 0;
        CHECK(spring_scene_check(&m.def, &field, NULL) == SPRING_EUNSUPPORTED && strcmp(field, "link.flags") == 0,
              "one axis");
        m.def.axes = 3;
        m.def.methods = 1u << SPRING_RKN8;
    }
}

/* -------------------------------------------------------------------------------------------- energy, stable step */

enum { few = 5, most_rows = 3 * few };

/* Few particles with links of all kinds, stretched or compressed by up to this factor. */
static void build_few(uint32_t axes, double factor, bool damped)
{
    const size_t particles = 2 + below(few - 1);
    m.def = (spring_scene_def){.axes = axes, .particles = particles, .position = m.position, .velocity = m.velocity};
    for (size_t i = 0; i < particles * axes; i++) {
        m.position[i] = random_uniform(-1, 1);
        m.velocity[i] = random_uniform(-1, 1);
    }
    for (size_t i = 0; i < particles; i++) {
        m.mass[i] = random_log(1e-3, 1e3);
        m.pinned[i] = below(5) == 0;
    }
    m.def.mass = m.mass;
    m.def.pinned = m.pinned;
    m.def.link = m.link;
    m.def.weighted_link = m.weighted;
    m.def.links = below(2 * few);
    for (size_t i = 0; i < m.def.links; i++) {
        const uint32_t a = below(particles), b = (uint32_t)below(particles - 1);
        m.link[i] = (spring_link){.a = a, .b = b < a ? b : b + 1, .stiffness = random_log(1, 1e3)};
        m.link[i].damping = damped ? random_log(0.01, 1) : 0;
        double square = 0;
        for (uint32_t d = 0; d < axes; d++)
            square += pow(m.position[m.link[i].a * axes + d] - m.position[m.link[i].b * axes + d], 2);
        m.link[i].rest = below(5) == 0 ? 0 : sqrt(square) / random_log(1 / factor, factor);
        m.link[i].flags = axes == 1 ? 0 : (uint32_t)below(4);
    }
    m.def.weighted_links = particles < 4 ? 0 : below(2 * few);
    for (size_t i = 0; i < m.def.weighted_links; i++) {
        m.weighted[i] = random_weighted(particles, 0, 0);
        m.weighted[i].damping = damped ? random_log(0.01, 1) : 0;
        double d[3], size, square = 0;
        weighted_vector(&m.weighted[i], axes, m.position, d, &size);
        for (uint32_t a = 0; a < axes; a++)
            square += d[a] * d[a];
        m.weighted[i].rest = below(3) == 0 ? 0 : sqrt(square) / random_log(1 / factor, factor);
    }
    m.def.methods = 1u << SPRING_LEAPFROG;
}

static double elastic_at(const double *x)
{
    m.def.position = x;
    spring_scene *s = scene_of(&m.def);
    const double elastic = spring_scene_energy(s).elastic;
    free(s);
    m.def.position = m.position;
    return elastic;
}

/* Forces are minus the derivative of the energy that spring_scene_energy() returns. */
static void energy(void)
{
    for (int number = 0; number < 1000; number++) {
        const uint32_t axes = 1 + (uint32_t)below(3);
        double force[3 * few] = {0}, stiffest = 1, x[3 * few];
        build_few(axes, 3, false);
        plain_forces(&m.def, axes, m.position, m.velocity, force, NULL);
        for (size_t i = 0; i < m.def.links; i++)
            stiffest += m.link[i].stiffness;
        for (size_t i = 0; i < m.def.weighted_links; i++)
            stiffest += 4 * m.weighted[i].stiffness;
        const size_t k = below(axes * m.def.particles);
        const double step = sizeof(scalar) == 4 ? 1e-2 : 1e-5;
        memcpy(x, m.position, axes * m.def.particles * sizeof *x);
        x[k] = m.position[k] + step;
        const double upper = elastic_at(x);
        x[k] = m.position[k] - step;
        const double lower = elastic_at(x);
        const double rounding = 10 * EPS * (upper + lower) / step;
        CHECK_CLOSE(-(upper - lower) / (2 * step), force[k], 30 * step * step * stiffest + rounding,
                    "a difference quotient, and rounding");
    }
}

/* Adds k w w^T (n n^T + (1 - rest/length) (1 - n n^T)), the derivative of the forces of a link, for w = weights/sqrt(mass)
   of its free particles. */
static void add_to_matrix(double matrix[most_rows][most_rows], const spring_weighted_link *w, uint32_t axes)
{
    double d[3], size, square = 0;
    weighted_vector(w, axes, m.position, d, &size);
    for (uint32_t a = 0; a < axes; a++)
        square += d[a] * d[a];
    const double length = sqrt(square), across = axes == 1 || w->rest == 0 ? 1 : 1 - w->rest / length;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            if (w->weight[i] == 0 || w->weight[j] == 0 || m.pinned[w->particle[i]] || m.pinned[w->particle[j]])
                continue;
            const double k =
                w->stiffness * w->weight[i] * w->weight[j] / sqrt(m.mass[w->particle[i]] * m.mass[w->particle[j]]);
            for (uint32_t a = 0; a < axes; a++)
                for (uint32_t b = 0; b < axes; b++)
                    matrix[w->particle[i] * axes + a][w->particle[j] * axes + b] +=
                        k * ((a == b ? across : 0) + (1 - across) * d[a] * d[b] / square);
        }
}

/* The largest eigenvalue of a symmetric matrix, by Jacobi's rotations. */
static double largest_eigenvalue(double a[most_rows][most_rows], size_t n)
{
    for (int sweep = 0; sweep < 12; sweep++)
        for (size_t p = 0; p < n; p++)
            for (size_t q = p + 1; q < n; q++) {
                if (a[p][q] == 0)
                    continue;
                const double angle = 0.5 * atan2(2 * a[p][q], a[q][q] - a[p][p]), c = cos(angle), s = sin(angle);
                for (size_t k = 0; k < n; k++) {
                    const double u = a[k][p], v = a[k][q];
                    a[k][p] = c * u - s * v, a[k][q] = s * u + c * v;
                }
                for (size_t k = 0; k < n; k++) {
                    const double u = a[p][k], v = a[q][k];
                    a[p][k] = c * u - s * v, a[q][k] = s * u + c * v;
                }
            }
    double largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, a[i][i]);
    return largest;
}

/* The largest row sum of a matrix that bounds the derivatives of the forces; see spring_scene_stable_step(). */
static double largest_row(void)
{
    double row[few] = {0}, largest = 0;
    for (size_t j = 0; j < m.def.links + m.def.weighted_links; j++) {
        const spring_link *const l = j < m.def.links ? &m.link[j] : NULL;
        const spring_weighted_link w =
            l == NULL ? m.weighted[j - m.def.links] : (spring_weighted_link){{l->a, l->b}, {-1, 1}, 0, l->stiffness, 0};
        double free = 0;
        for (int i = 0; i < 4 && !(l != NULL && is_idle(&m.def, l)); i++)
            free += w.weight[i] != 0 && !m.pinned[w.particle[i]] ? fabs(w.weight[i]) : 0;
        for (int i = 0; i < 4; i++)
            if (w.weight[i] != 0)
                row[w.particle[i]] += w.stiffness * fabs(w.weight[i]) * free;
    }
    for (size_t i = 0; i < m.def.particles; i++)
        largest = fmax(largest, m.pinned[i] ? 0 : row[i] / m.mass[i]);
    return largest;
}

/* The square of 2/(stable step) is an upper bound of the eigenvalues, at every deformation. */
static void stable_step(void)
{
    double closest = 0;
    for (int number = 0; number < 10000; number++) {
        const uint32_t axes = 1 + (uint32_t)below(3);
        double matrix[most_rows][most_rows] = {{0}};
        build_few(axes, 20, false);
        for (size_t i = 0; i < m.def.links; i++) {
            const spring_link *l = &m.link[i];
            const link_force f = evaluate_link(l, axes, m.position, m.velocity);
            if (is_idle(&m.def, l) || (pulls_only(&m.def, l) && f.length <= l->rest))
                continue;
            const spring_weighted_link w = {{l->a, l->b}, {-1, 1}, l->rest, l->stiffness, 0};
            add_to_matrix(matrix, &w, axes);
        }
        for (size_t i = 0; i < m.def.weighted_links; i++)
            add_to_matrix(matrix, &m.weighted[i], axes);
        const double largest = largest_eigenvalue(matrix, axes * m.def.particles);
        const double bound = pow(2 / stable_step_of(&m.def, SPRING_LEAPFROG), 2);
        CHECK(largest <= bound * (1 + 200 * EPS), "rounding errors of the sums and of 12 sweeps of rotations");
        CHECK_CLOSE(bound, largest_row(), 50 * EPS * bound, "the largest row; rounding errors of sums of 20 terms");
        closest = fmax(closest, bound > 0 ? largest / bound : 0);
    }
    CHECK(closest > 1 - 1e-6, "the bound is reached");
}

/* ------------------------------------------------------------------------------------------------------ attachments */

/* A particle attached to a point in a triangle, and one at the end of a weighted spring. */
static spring_scene *attach(double damping, double rest)
{
    static const double position[] = {0, 0, 0, 1, 0, 0.1, 0.2, 0.9, 0, 0.4, 0.3, 0.5};
    build(&m, (uint32_t[]){4, 1, 1}, 3, 0);
    memcpy(m.position, position, sizeof position);
    m.link[0] = (spring_link){0, 1, 1, 90, 0, 0};
    m.link[1] = (spring_link){1, 2, 1.2, 70, 0, 0};
    m.link[2] = (spring_link){2, 0, 0.9, 80, 0, 0};
    m.weighted[0] = (spring_weighted_link){{3, 0, 1, 2}, {-1, 0.5, 0.2, 0.3}, rest, 60, damping};
    m.def.links = 3;
    m.def.mass = m.mass;
    m.def.weighted_link = m.weighted;
    m.def.weighted_links = 1;
    m.def.methods = 1u << SPRING_LEAPFROG;
    return scene_of(&m.def);
}

static void momentum(void)
{
    double largest = 0; /* change by a torque, relative to the momenta */
    for (int i = 0; i < 20; i++) {
        spring_scene *s = attach(i % 2 ? 0.3 : 0, i % 4 < 2 ? 0 : 0.2);
        const momenta before = momenta_of(&m, s);
        const double dt = 0.3 * spring_scene_stable_step(s, SPRING_LEAPFROG);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1000) == SPRING_OK, "stable");
        const momenta after = momenta_of(&m, s);
        const bool torque = i % 2 == 1 && i % 4 < 2; /* damping in all directions exerts one */
        double change = 0;
        for (int a = 0; a < 3; a++) {
            CHECK_CLOSE(after.linear[a], before.linear[a], 1000 * EPS * before.size,
                        "forces on both sides are equal; one rounding error of the velocities per step");
            if (!torque)
                CHECK_CLOSE(after.angular[a], before.angular[a], 2000 * EPS * (before.size + after.size),
                            "forces along the vector of a link exert no torque");
            change = fmax(change, fabs(after.angular[a] - before.angular[a]));
        }
        largest = torque ? fmax(largest, change / before.size) : largest;
        free(s);
    }
    CHECK(largest > 1e-3, "damping in all directions exerts a torque");
}

/* A particle that circles about the point it is attached to comes to rest. Damping along the link alone would not see
   its motion. */
static void whirl(void)
{
    for (int weighted = 0; weighted < 2; weighted++)
        for (int heavy = 0; heavy < 2; heavy++) {
            const double mass = 1.3, stiffness = 40, omega = sqrt(stiffness / mass), ratio = heavy ? 1 : 0.1;
            const double damping = 2 * ratio * sqrt(stiffness * mass), x[] = {0, 0, 0, 0.5, 0, 0};
            const double v[] = {0, 0, 0, 0, 0.5 * omega, 0};
            const uint8_t pinned[] = {1, 0};
            const spring_link link = {0, 1, 0, stiffness, damping, 0};
            const spring_weighted_link w = {{0, 1}, {-1, 1}, 0, stiffness, damping};
            spring_scene_def def = joined(3, 2, x, v, !weighted, &link);
            def.pinned = pinned, def.mass_all = mass, def.weighted_links = (size_t)weighted, def.weighted_link = &w;
            spring_scene *s = scene_of(&def);
            const double start = total_energy(s), dt = (heavy ? 0.9 : 0.02) / omega; /* heavy: an exponential kick */
            const uint64_t steps = (uint64_t)(10 / (omega * dt));
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, steps) == SPRING_OK, "stable");
            const double left = exp(-2 * ratio * omega * dt * (double)steps); /* of the energy, underdamped */
            if (heavy)
                CHECK_BELOW(total_energy(s) / start, 1e-4, "critically damped for ten radians");
            else
                CHECK_CLOSE(total_energy(s) / start, left, 0.01 * left, "error of order dt^2");
            free(s);
        }
}

/* The rate that spring_weighted_link states. */
static void hoop(void)
{
    enum { count = 24 };
    const double pi = 3.14159265358979324, radius = 0.4, mass = 0.1, damping = 40, turning = 3; /* [rad/s] */
    build(&m, (uint32_t[]){count, 1, 1}, 3, 0);
    for (uint32_t i = 0; i < count; i++) {
        const double phi = 2 * pi * i / count, x = radius * cos(phi), y = radius * sin(phi);
        memcpy(m.position + 3 * i, (double[]){x, y, 0}, 3 * sizeof x);
        memcpy(m.velocity + 3 * i, (double[]){-turning * y, turning * x, 0}, 3 * sizeof x);
        m.mass[i] = mass;
        m.link[i] = (spring_link){i, (i + 1) % count, 2 * radius * sin(pi / count), 4000, 0, 0};
        m.weighted[i] = (spring_weighted_link){{i, (i + 1) % count, (i + 2) % count}, {0.5, -1, 0.5}, 0, 30, damping};
    }
    m.def.links = m.def.weighted_links = count;
    m.def.weighted_link = m.weighted;
    m.def.mass = m.mass;
    m.def.methods = 1u << SPRING_LEAPFROG;
    spring_scene *s = scene_of(&m.def);
    const double start = momenta_of(&m, s).angular[2], dt = 1. / 2000, second = 1 - cos(2 * pi / count);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 2000) == SPRING_OK, "stable");
    const double left = momenta_of(&m, s).angular[2] / start;
    printf("# a free hoop keeps %.3f of its angular momentum in 1 s\n", left);
    CHECK_CLOSE(left, exp(-second * second * damping / mass), 1e-8 + 100 * EPS, "order dt^2, and rounding");
    free(s);
}

int main(void)
{
    static const test tests[] = {
        {"definitions", definitions}, {"energy", energy}, {"stable step", stable_step},
        {"momentum", momentum},       {"whirl", whirl},   {"hoop", hoop},
    };
    return RUN_TESTS("links", tests);
}
