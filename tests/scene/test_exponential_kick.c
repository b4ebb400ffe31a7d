/* SPDX-License-Identifier: MIT */
/* Leapfrog with an exponential kick: against a plain loop over links, creep, turning, saturation, energy, contacts. */
#include <stdio.h>

#include "test_contact.h"
#include "scene/exponential_kick.h"

/* ---------------------------------------------------------------------------------------------------- a plain step */

enum { most_all = most_links + most_weighted };

/* The step of scene/exponential_kick.h in double, by a loop over links and sums of T_k(Y) r. */
typedef struct plain_kick {
    const spring_scene_def *def;
    uint32_t axes;
    double h, weight[most];                                    /* 1/mass' */
    double root[most_all], scale[most_all], turning[most_all]; /* of links, then of weighted links */
    double r[3 * most], r2[3 * most];
} plain_kick;

/* A link as a weighted link. */
static spring_weighted_link link_at(const spring_scene_def *def, size_t j)
{
    if (j >= def->links)
        return def->weighted_link[j - def->links];
    const spring_link *l = &def->link[j];
    return (spring_weighted_link){
        .particle = {l->a, l->b}, .weight = {-1, 1}, l->rest, l->stiffness, is_idle(def, l) ? 0 : l->damping};
}

static void add_to_particles(const spring_weighted_link *w, uint32_t axes, const double *force, double factor,
                             const double *mass_factor, double *out)
{
    for (int i = 0; i < 4; i++)
        for (uint32_t a = 0; a < axes && w->weight[i] != 0; a++)
            out[w->particle[i] * axes + a] -= (double)(scalar)w->weight[i] * factor * force[a] *
                                              (mass_factor != NULL ? mass_factor[w->particle[i]] : 1);
}

/* sqrt(damping), saturated. Returns the largest h G. */
static double find_roots(plain_kick *k)
{
    const spring_scene_def *def = k->def;
    static double sum[most];
    double reach = 0;
    memset(sum, 0, sizeof sum);
    for (size_t j = 0; j < def->links + def->weighted_links; j++) {
        const spring_weighted_link w = link_at(def, j);
        double free = 0;
        for (int i = 0; i < 4; i++)
            free += w.weight[i] != 0 && !pinned_in(def, w.particle[i]) ? fabs(w.weight[i]) : 0;
        for (int i = 0; i < 4; i++)
            if (w.weight[i] != 0)
                sum[w.particle[i]] += (double)(scalar)w.damping * fabs(w.weight[i]) * free;
    }
    for (size_t i = 0; i < def->particles; i++) {
        sum[i] = pinned_in(def, i) ? 0 : k->h * sum[i] / mass_in(def, i);
        reach = fmax(reach, sum[i]);
    }
    for (size_t j = 0; j < def->links + def->weighted_links; j++) {
        const spring_weighted_link w = link_at(def, j);
        double most_of_ends = 0;
        for (int i = 0; i < 4; i++)
            most_of_ends = fmax(most_of_ends, w.weight[i] != 0 ? sum[w.particle[i]] : 0);
        k->root[j] = sqrt((double)(scalar)w.damping * fmin(1, most_damping / most_of_ends));
    }
    return fmin(reach, most_damping);
}

/* r and r2 at x and v. force: of the callback, added. */
static void find_residual(plain_kick *k, const double *x, const double *v, const double *force)
{
    const spring_scene_def *def = k->def;
    const uint32_t axes = k->axes;
    memset(k->r2, 0, sizeof k->r2);
    memcpy(k->r, force, 3 * def->particles * sizeof *force);
    for (size_t j = 0; j < def->links + def->weighted_links; j++) {
        const spring_weighted_link w = link_at(def, j);
        const spring_link *const l = j < def->links ? &def->link[j] : NULL;
        double delta[3] = {0}, relative[3] = {0}, square = 0, dot = 0, speed = 0, sizes;
        weighted_vector(&w, axes, x, delta, &sizes);
        weighted_vector(&w, axes, v, relative, &sizes);
        for (uint32_t a = 0; a < axes; a++) {
            square += delta[a] * delta[a];
            dot += delta[a] * relative[a];
            speed += relative[a] * relative[a];
        }
        const double c = k->root[j] * k->root[j], length = sqrt(square), rate = length > 0 ? dot / length : 0;
        const bool linear = axes == 1 || w.rest == 0;
        k->scale[j] = k->turning[j] = 0;
        if ((w.stiffness == 0 && w.damping == 0) || (l != NULL && is_idle(def, l)) ||
            (l != NULL && pulls_only(def, l) && length <= w.rest) || (!linear && length == 0))
            continue;
        double turned = 0, pull[3];
        if (!linear) {
            const double t = fmin(1, fmax(0, k->h * k->h * (speed - rate * rate) / square));
            turned = length / (2 * k->h) * t * (1 + t / 4 + t * t / 8);
        }
        k->scale[j] = linear ? -k->root[j] : k->root[j] / length;
        k->turning[j] = 2 * k->root[j] * turned;
        for (uint32_t a = 0; a < axes; a++) {
            const double along = linear ? 0 : delta[a] / length;
            pull[a] = linear ? w.stiffness * (delta[a] - (axes == 1 ? w.rest : 0)) + c * relative[a]
                             : (w.stiffness * (length - w.rest) + c * (rate - turned)) * along;
            delta[a] = along;
        }
        add_to_particles(&w, axes, pull, 1, NULL, k->r);
        add_to_particles(&w, axes, delta, -k->root[j] * k->turning[j], NULL, k->r2);
    }
    for (size_t i = 0; i < def->particles; i++) {
        const double mass = mass_in(def, i), q = k->h * def->drag / mass;
        k->weight[i] = pinned_in(def, i) ? 0 : 1 / (mass * (1 + q / 2 + q * q / (12 + 2 * q)));
        for (uint32_t a = 0; a < axes; a++) {
            double *r = &k->r[i * axes + a];
            *r = k->weight[i] * (*r - def->drag * v[i * axes + a] + mass * def->gravity[a]);
            k->r2[i * axes + a] *= k->weight[i];
        }
    }
}

/* out = Y u, Y = 1 - h Z/rho */
static void apply_y(const plain_kick *k, double rho, const double *x, const double *u, double *out)
{
    const spring_scene_def *def = k->def;
    const uint32_t axes = k->axes;
    memcpy(out, u, axes * def->particles * sizeof *u);
    for (size_t j = 0; j < def->links + def->weighted_links; j++) {
        const spring_weighted_link w = link_at(def, j);
        double delta[3], relative[3], rate = 0, sizes;
        weighted_vector(&w, axes, x, delta, &sizes);
        weighted_vector(&w, axes, u, relative, &sizes);
        for (uint32_t a = 0; a < axes; a++)
            rate += delta[a] * relative[a];
        for (uint32_t a = 0; a < axes && k->scale[j] > 0; a++)
            relative[a] = rate * delta[a];
        add_to_particles(&w, axes, relative, k->h / rho * k->scale[j] * k->scale[j], k->weight, out);
    }
}

/* sum = p r - m r2 */
static void sum_series(plain_kick *k, double reach, const double *x, double *sum)
{
    static double before[3 * most], now[3 * most], next[3 * most];
    static double d[512], e[512];
    const size_t count = k->axes * k->def->particles;
    const damping_series p = spring_damping_series(reach);
    const double rho = p.terms == 2 ? 1 : p.rho;
    memset(e, 0, sizeof e);
    if (p.terms == 2) { /* p = 1 - z/2 = 1/2 + Y/2 for rho = 1, m = 1/2 */
        d[0] = e[0] = 1;
        d[1] = 0.5;
    } else {
        series_term t = spring_last_term(&p);
        while (t.k > 0) {
            spring_previous_term(&p, &t);
            d[t.k] = t.d;
            e[t.k] = t.e;
        }
    }
    memset(sum, 0, count * sizeof *sum);
    for (int which = 0; which < 2; which++) {
        const double *c = which == 0 ? d : e, sign = which == 0 ? 1 : -1;
        memcpy(now, which == 0 ? k->r : k->r2, count * sizeof *now);
        for (unsigned n = 0; n < p.terms; n++) {
            for (size_t i = 0; i < count; i++)
                sum[i] += sign * (n == 0 ? c[0] / 2 : c[n]) * now[i];
            apply_y(k, rho, x, now, next);
            for (size_t i = 0; i < count; i++) {
                const double t = n == 0 ? next[i] : 2 * next[i] - before[i];
                before[i] = now[i];
                now[i] = t;
            }
        }
    }
}

/* A callback: a uniform field, or one that turns velocities. */
typedef struct field {
    uint32_t axes;
    double strength, magnetic;
} field;

static void add_field(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                      scalar *const force[3])
{
    const field *f = user;
    (void)x;
    for (size_t i = 0; i < particles; i++) {
        force[0][i] += (scalar)(f->strength * (1 + t) + f->magnetic * (double)v[f->axes - 1][i]);
        force[f->axes - 1][i] -= (scalar)(f->magnetic * (double)v[0][i]);
    }
}

static void plain_field(const field *f, double t, size_t particles, const double *v, double *force)
{
    memset(force, 0, 3 * particles * sizeof *force);
    for (size_t i = 0; i < particles; i++) {
        force[i * f->axes] += f->strength * (1 + t) + f->magnetic * v[i * f->axes + f->axes - 1];
        force[i * f->axes + f->axes - 1] -= f->magnetic * v[i * f->axes];
    }
}

/* One step from the state y. Returns the number of terms. */
static unsigned plain_step(plain_kick *k, const field *f, bool repeats, state *y)
{
    static double change[3 * most], force[3 * most], mean[3 * most];
    const double reach = find_roots(k);
    const unsigned terms = spring_damping_series(reach).terms;
    const size_t count = k->axes * k->def->particles;
    for (size_t i = 0; i < count; i++)
        y->x[i] += k->h / 2 * y->v[i];
    memcpy(mean, y->v, sizeof mean);
    for (int round = 0; round < (repeats ? 2 : 1); round++) {
        plain_field(f, k->h / 2, k->def->particles, mean, force);
        find_residual(k, y->x, y->v, force);
        sum_series(k, reach, y->x, change);
        for (size_t i = 0; i < count; i++)
            mean[i] = y->v[i] + k->h / 2 * change[i];
    }
    for (size_t i = 0; i < count; i++) {
        y->v[i] += k->h * change[i];
        y->x[i] += k->h / 2 * y->v[i];
    }
    return terms;
}

/* Random scenes of every layout and with every feature, against the plain step. */
static void plain_steps(void)
{
    static const uint32_t grids[][3] = {{3, 1, 1}, {4, 3, 1}, {9, 7, 1}, {4, 3, 3}, {70, 1, 1}};
    static const double reaches[] = {0.45, 0.7, 5, 60, 990, 1e6};
    static model m;
    static plain_kick k;
    static state want, near, got;
    unsigned saturated = 0, two = 0;
    for (unsigned number = 0; number < 240; number++) {
        const uint32_t axes = 1 + number % 3;
        build(&m, grids[number / 3 % 5], axes, (number * 389) % feature_masks | DAMPED);
        const bool damped_callback = number % 7 == 0, called = number % 7 < 3;
        field f = {axes, called ? 3.1 : 0, damped_callback && axes > 1 ? 0.7 : 0};
        const bool turns_fast = number % 7 == 3;
        if (number % 5 < 3 && !turns_fast)
            add_further_links(&m, true);
        for (size_t j = 0; j < m.def.links && number % 11 == 0; j++)
            m.link[j].rest = j % 3 == 0 ? 0 : m.link[j].rest;
        for (size_t i = 0; i < axes * m.def.particles && turns_fast; i++)
            m.velocity[i] *= 10; /* links turn by more than one radian per step */
        m.def.methods = 1u << SPRING_LEAPFROG;
        m.def.flags |= (number % 4 == 0 && axes > 1 ? SPRING_SCENE_TENSION_ONLY : 0u) |
                       (damped_callback ? 0u : SPRING_SCENE_FORCE_IGNORES_VELOCITY);
        m.def.force = called ? add_field : NULL;
        m.def.user = &f;
        spring_scene *s = scene_of(&m.def);
        const scene_bounds *b = spring_scene_find_bounds(s);
        const double h = fmin(0.3 * spring_scene_stable_step(s, SPRING_LEAPFROG), 10);
        const double more = reaches[number % 6] / (h * b->link_damping);
        free(s);
        if (!(more < INFINITY)) /* no damped link between free particles */
            continue;
        for (size_t j = 0; j < m.def.links; j++)
            m.link[j].damping *= more;
        for (size_t j = 0; j < m.def.weighted_links; j++)
            m.weighted[j].damping *= more;
        s = scene_of(&m.def);
        get_state(s, m.def.particles, &want);
        k.def = &m.def;
        k.axes = axes;
        k.h = (double)(scalar)h;
        const state start = want;
        const unsigned terms = plain_step(&k, &f, damped_callback, &want);
        double sensitivity = 0; /* the largest change of a velocity by a rounding error of each initial position */
        for (int trial = 0; trial < 4; trial++) {
            near = start;
            for (size_t i = 0; i < axes * m.def.particles; i++)
                near.x[i] *= random_bits() % 2 ? 1 + EPS : 1 - EPS;
            plain_step(&k, &f, damped_callback, &near);
            for (size_t i = 0; i < axes * m.def.particles; i++)
                sensitivity = fmax(sensitivity, fabs(near.v[i] - want.v[i]));
        }
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, k.h, 1) == SPRING_OK, "one step");
        get_state(s, m.def.particles, &got);
        double speed = 1, place = 1;
        for (size_t i = 0; i < axes * m.def.particles; i++) {
            speed = fmax(speed, fabs(want.v[i]));
            place = fmax(place, fabs(want.x[i]));
        }
        double shortest = place; /* link: the rounding errors of positions turn it most */
        for (size_t j = 0; j < m.def.links + m.def.weighted_links && axes > 1; j++)
            shortest = fmin(shortest, k.scale[j] > 0 ? k.root[j] / k.scale[j] : shortest);
        /* The residual is as large as h Z v, and the terms of the series cancel. */
        const double reach = fmin(reaches[number % 6], most_damping);
        const double angle =
            h * speed / shortest; /* by which a link turns in a step; the turning term grows with its square */
        const double bound = 8 * EPS * (speed + place / h) * (1 + reach * place / shortest) * (1 + angle * angle) +
                             4 * sensitivity; /* positions are rounded a few times */
        for (size_t i = 0; i < axes * m.def.particles; i++) {
            CHECK_CLOSE(got.v[i], want.v[i], bound, "rounding errors of the residual and of the series");
            CHECK_CLOSE(got.x[i], want.x[i], h * bound + 4 * EPS * place, "the same, in half a step");
        }
        saturated += reaches[number % 6] > most_damping;
        two += terms == 2;
        spring_scene *other = scene_of(&m.def); /* continues with another step: nothing of the first one is left */
        set_state(other, m.def.particles, &got);
        if (called) /* the time of its callback is another */
            spring_scene_set_force(s, NULL, NULL), spring_scene_set_force(other, NULL, NULL);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.7 * k.h, 2) == SPRING_OK &&
                  spring_scene_advance(other, SPRING_LEAPFROG, 0.7 * k.h, 2) == SPRING_OK &&
                  same_bits(s, other, m.def.particles, axes),
              "positions and velocities are the whole state");
        free(s), free(other);
    }
    CHECK(saturated > 20 && two > 20, "with few terms, and with saturated links");
}

/* ------------------------------------------------------------------------------------------------- creep and turning */

/* A particle on one overdamped link relaxes at the rate of the exact solution. Beyond saturation it relaxes faster than
   that, in most_damping/(h^2 omega2) steps. */
static void creep(void)
{
    static const double damping[] = {100, 1000, 1e5, 1e9}, most_error[] = {0.03, 0.005, 0.001, 1e-6};
    const double stiffness = 100, mass = 1, dt = 0.05;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (int i = 0; i < 4; i++) {
            double x[6] = {0}, v[6];
            x[2 * axes - 1] = 1.5; /* the length, along the last axis */
            const uint8_t pinned[] = {1, 0};
            const spring_link link = {.a = 0, .b = 1, .rest = 1, .stiffness = stiffness, .damping = damping[i]};
            spring_scene_def def = joined(axes, 2, x, NULL, 1, &link);
            def.pinned = pinned, def.mass_all = mass;
            spring_scene *s = scene_of(&def);
            const double saturated = fmin(damping[i], most_damping / dt * mass), half = saturated / 2 / mass;
            const double omega2 = stiffness / mass, exact = omega2 / (half + sqrt(half * half - omega2));
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 40) == SPRING_OK, "stable");
            spring_scene_get(s, SPRING_POSITION, x, 0, 0, 2);
            spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 2);
            const double left = x[2 * axes - 1] - 1, rate = -v[2 * axes - 1] / left;
            const double rounding = 4 * EPS * saturated * dt / (exact * dt * dt); /* of positions, per step */
            CHECK_CLOSE(rate, exact, (most_error[i] + rounding) * exact, "as the study of the scheme measured");
            CHECK(left > 0 && left < 0.5, "towards the rest length");
            free(s);
        }
}

/* Two particles on a link turn about each other by 0.1 rad per step. The stretch is that of the centripetal force. */
static void turning_dumbbell(void)
{
    const double dt = 0.01, turns = 10, length = 1, mass = 1.7, stretch = 0.02;
    for (double reach = 1; reach < 2e4; reach *= 10) {
        const double x[] = {-length / 2, 0, 0, length / 2, 0, 0};
        const double v[] = {0, -turns * length / 2, 0, 0, turns * length / 2, 0};
        const spring_link link = {.a = 0,
                                  .b = 1,
                                  .rest = length - stretch,
                                  .stiffness = mass * turns * turns * length / 2 / stretch,
                                  .damping = reach / dt * mass / 2};
        const spring_scene_def def = {
            .particles = 2, .links = 1, .position = x, .velocity = v, .mass_all = mass, .link = &link};
        spring_scene *s = scene_of(&def);
        const double start = total_energy(s), momentum = mass * turns * length * length / 2;
        for (int i = 0; i < 2000; i++) {
            double y[6], w[6];
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK, "stable");
            spring_scene_get(s, SPRING_POSITION, y, 0, 0, 2);
            spring_scene_get(s, SPRING_VELOCITY, w, 0, 0, 2);
            const double now = hypot(y[3] - y[0], y[4] - y[1]) - link.rest;
            const double angular = mass * (y[0] * w[1] - y[1] * w[0] + y[3] * w[4] - y[4] * w[3]);
            CHECK_CLOSE(now, stretch, 0.1 * stretch, "4.2 times at dt G = 10 without the turning term");
            CHECK_BELOW(total_energy(s), 1.01 * start, "1.2 times without");
            CHECK_CLOSE(angular, momentum, (sizeof(scalar) == 4 ? 1e-3 : 1e-9) * momentum, "forces are central");
        }
        free(s);
    }
}

#ifndef SPRING_FLOAT

static double mean_strain(const spring_scene *s, const model *m)
{
    static state y;
    double sum = 0;
    get_state(s, m->def.particles, &y);
    for (size_t j = 0; j < m->def.links; j++) {
        double square = 0;
        for (size_t a = 0; a < 3; a++)
            square += pow(y.x[3 * m->link[j].b + a] - y.x[3 * m->link[j].a + a], 2);
        sum += sqrt(square) / m->link[j].rest - 1;
    }
    return sum / (double)m->def.links;
}

/* A cloth that spins in its plane by 0.05 rad per step, heavily damped: the mean strain is that of RK4. */
static void spinning_cloth(void)
{
    static model m;
    const spring_grid g = {.count = {8, 8, 1}, .axes = 3, .spacing = 1.0 / 7, .families = 7, .stiffness = 30};
    build_grid(&m, &g, 1.0 / 49);
    m.def.methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4;
    const double dt = 0.5 * stable_step_of(&m.def, SPRING_LEAPFROG), turns = 0.05 / dt;
    for (size_t j = 0; j < m.def.links; j++)
        m.link[j].damping = 1;
    spring_scene *s = scene_of(&m.def);
    const double more = 1000 / dt / spring_scene_find_bounds(s)->link_damping;
    free(s);
    for (size_t j = 0; j < m.def.links; j++)
        m.link[j].damping = more;
    for (size_t i = 0; i < m.def.particles; i++) {
        m.velocity[3 * i] = -turns * (m.position[3 * i + 1] - 0.5);
        m.velocity[3 * i + 1] = turns * (m.position[3 * i] - 0.5);
        m.velocity[3 * i + 2] = 0;
    }
    s = scene_of(&m.def);
    spring_scene *reference = scene_of(&m.def);
    const uint64_t steps = 150, fine = steps * 600; /* dt G = 1.7 */
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, steps) == SPRING_OK &&
              spring_scene_advance(reference, SPRING_RK4, (double)steps * dt / (double)fine, fine) == SPRING_OK,
          "stable");
    const double want = mean_strain(reference, &m);
    CHECK_CLOSE(mean_strain(s, &m), want, 0.02 * want, "3.8 times for a splitting of leapfrog and damping");
    CHECK(want > 0.005, "so that it shows");
    free(s), free(reference);
}

#endif

/* ------------------------------------------------------------------------------------------------------------ energy */

/* A random net in motion, of any layout: links near their rest lengths, most of them damped, pinned particles at rest.
   A link turns by about `turn` per step. Returns the step, a fraction of the stable step. */
static double build_net(model *m, unsigned number, double fraction, double turn)
{
    static const uint32_t grids[][3] = {{4, 3, 1}, {6, 1, 1}, {9, 7, 1}, {3, 3, 3}, {40, 1, 1}};
    const uint32_t axes = 2 + number % 2;
    build(m, grids[number % 5], axes,
          (number * 37) % feature_masks & (SHUFFLED | REVERSED | STRAY | PINNED | EDITABLE));
    const double damping = random_log(1e-3, 1e5);
    m->def.mass = m->mass;
    m->def.mass_all = 0;
    for (size_t i = 0; i < m->def.particles; i++)
        m->mass[i] = random_log(0.1, 10);
    double shortest = INFINITY;
    for (size_t j = 0; j < m->def.links; j++) {
        spring_link *l = &m->link[j];
        double square = 0;
        for (uint32_t a = 0; a < axes; a++)
            square += pow(m->position[l->a * axes + a] - m->position[l->b * axes + a], 2);
        l->rest = sqrt(square) * random_uniform(0.9, 1.1);
        l->stiffness = random_log(1, 1000);
        l->damping = random_bits() % 5 ? damping * random_log(1, 1000) : 0;
        shortest = fmin(shortest, sqrt(square));
    }
    m->def.flags |= number / 2 % 2 ? SPRING_SCENE_TENSION_ONLY : 0u;
    m->def.methods = 1u << SPRING_LEAPFROG;
    const double dt = fraction * fmin(stable_step_of(&m->def, SPRING_LEAPFROG), 10);
    for (size_t i = 0; i < axes * m->def.particles; i++)
        m->velocity[i] = pinned_in(&m->def, i / axes) ? 0 : turn * shortest / dt / sqrt(2) * random_uniform(-1, 1);
    return dt;
}

/* The largest energy of a run relative to its start. */
static double growth_of(const model *m, double dt, int steps)
{
    spring_scene *s = scene_of(&m->def);
    const double start = total_energy(s);
    double largest = start;
    for (int i = 0; i < steps; i += 10) {
        if (spring_scene_advance(s, SPRING_LEAPFROG, dt, 10) != SPRING_OK)
            largest = INFINITY;
        largest = fmax(largest, total_energy(s));
    }
    free(s);
    return largest / start;
}

/* SPRINGSTEP_SCENES=3000 SPRINGSTEP_STEPS=10000 in the environment: more of them, for longer. */
static void damping_adds_no_energy(void)
{
    static model m;
    const char *scenes = getenv("SPRINGSTEP_SCENES"), *steps = getenv("SPRINGSTEP_STEPS");
    const int count = scenes != NULL ? atoi(scenes) : 40, length = steps != NULL ? atoi(steps) : 1000;
    const struct {
        double fraction, most, exceptions; /* links that are compressed to half exceed the stable step: scene.h */
    } cases[] = {{0.5, 1.05, 0}, {0.9, 1.3, 0.01}};
    for (int c = 0; c < 2; c++) {
        double worst = 0;
        int exponential = 0, grown = 0;
        for (int number = 0; number < count; number++) {
            const double dt = build_net(&m, (unsigned)number, cases[c].fraction, number / 4 % 2 ? 0.03 : 0.3);
            spring_scene *s = scene_of(&m.def);
            const bool beyond = dt * spring_scene_find_bounds(s)->link_damping > 0.4;
            free(s);
            const double growth = growth_of(&m, dt, length);
            for (size_t j = 0; j < m.def.links; j++)
                m.link[j].damping = 0;
            const double undamped = growth_of(&m, dt, length);
            if (!beyond || undamped > cases[c].most) /* the step is too long for this net even without damping */
                continue;
            exponential++;
            worst = fmax(worst, growth);
            grown += growth > cases[c].most;
        }
        printf("# dt %g of the bound: energy at most %.3f of the start in %d nets\n", cases[c].fraction, worst,
               exponential);
        CHECK(grown <= cases[c].exceptions * exponential, "damping adds no energy");
        CHECK(exponential > count / 2, "most of these scenes use it");
    }
}

/* ---------------------------------------------------------------------------------------------------------- contacts */

/* A block of jelly on a plane, whose weight its links carry to the floor. */
static spring_scene *block_of(model *m, uint32_t side, double damping, double friction, const double normal[3])
{
    const spring_grid g = {.count = {side, side, side},
                           .axes = 3,
                           .spacing = 0.25 / 3,
                           .families = 3,
                           .stiffness = 4000,
                           .damping = damping};
    build_grid(m, &g, 1.0 / 64);
    m->def.mass = NULL, m->def.pinned = NULL;
    m->def.gravity[2] = -gravity, m->def.colliders = 1, m->def.methods = 1u << SPRING_LEAPFROG;
    spring_collider plane = {.shape = SPRING_PLANE, .friction = friction};
    memcpy(plane.axis[0], normal, sizeof plane.axis[0]);
    return scene_with(&m->def, &plane);
}

/* Turns a block about the y axis, lifts it and gives it a velocity, which may be NULL. */
static void throw_block(spring_scene *s, model *m, double angle, double height, const double *v)
{
    for (size_t p = 0; p < m->def.particles; p++) {
        double *const x = &m->position[3 * p], x0 = x[0];
        x[0] = x0 * cos(angle) - x[2] * sin(angle);
        x[2] = x0 * sin(angle) + x[2] * cos(angle) + height;
        if (v != NULL)
            memcpy(&m->velocity[3 * p], v, 3 * sizeof *v);
    }
    spring_scene_set(s, SPRING_POSITION, m->position, 0, 0, m->def.particles);
    spring_scene_set(s, SPRING_VELOCITY, m->velocity, 0, 0, m->def.particles);
}

/* The impulse on the collider in a step. */
static spring_impulse impulse_in_step(spring_scene *s, double dt)
{
    spring_impulse j;
    run(s, SPRING_LEAPFROG, dt, 1);
    spring_scene_impulses(s, &j, 0, 1);
    return j;
}

/* Advances it in calls of 10 steps. again: before each call, the same collider is set again. */
static void advance_in_calls(spring_scene *s, double dt, uint64_t steps, bool again)
{
    spring_collider c;
    uint32_t count = 1;
    CHECK(spring_scene_get_colliders(s, &c, &count) == SPRING_OK, "its collider");
    for (uint64_t done = 0; done < steps; done += 10) {
        if (again)
            set(s, &c, count);
        run(s, SPRING_LEAPFROG, dt, 10);
    }
}

static uint32_t height(void *user, const double point[3], double gap[3], double normal[3][3])
{
    (void)user;
    gap[0] = point[2];
    normal[0][2] = 1;
    return 1;
}

/* It comes to rest where it does with light damping, with friction and without, and does not sink at any damping. The floor
   may be a custom body, and it may be set again before each call. */
static void rests_as_without_damping(void)
{
    static model m;
    const double up[] = {0, 0, 1}, dt = 0.0003;
    static const struct {
        double damping;
        bool custom, set;
    } cases[] = {{0.3, false, false}, {600, false, false}, {600, false, true}, {600, true, true}};
    enum { many = sizeof cases / sizeof cases[0] };
    for (int rough = 0; rough < 2; rough++) {
        const double friction = rough ? 0.5 : 0;
        const spring_collider custom = {.shape = SPRING_CUSTOM, .gap = height, .thickness = 1, .friction = friction};
        double top[many];
        for (int i = 0; i < many; i++) {
            spring_scene *s = block_of(&m, 4, cases[i].damping, friction, up);
            static state y;
            if (cases[i].custom)
                spring_scene_set_colliders(s, &custom, 1);
            advance_in_calls(s, dt, 7000, cases[i].set);
            CHECK(spring_scene_at_rest(s, 1e-3, sizeof(scalar) == 4 ? 0.3 : 0.02),
                  "the forces on every particle are in balance");
            get_state(s, m.def.particles, &y);
            top[i] = 0;
            for (size_t p = 0; p < m.def.particles; p++)
                top[i] = fmax(top[i], y.x[3 * p + 2]);
            CHECK_CLOSE(top[i], 0.2499, 1e-4, "the weight compresses it by 0.1 mm; it has not sunk into itself");
            free(s);
        }
        for (int i = 1; i < many; i++)
            CHECK_CLOSE(top[i], top[0], 2e-5, "not quite to equal places: friction holds it where it stops");
    }
}

/* A cube comes to rest to rounding error, also on a plane that is set before each call. */
static void rests_on_a_plane_that_is_set(void)
{
    static model m;
    const double up[] = {0, 0, 1};
    for (int i = 0; i < 2; i++) {
        spring_scene *s = block_of(&m, 2, 3, 0.7, up);
        static state y;
        advance_in_calls(s, 0.75 * spring_scene_stable_step(s, SPRING_LEAPFROG), 4000, i > 0);
        get_state(s, m.def.particles, &y);
        for (size_t k = 0; k < 3 * m.def.particles; k++)
            CHECK_BELOW(fabs(y.v[k]), 2000 * EPS, "at rest [m/s]");
        free(s);
    }
}

/* On a slope that is nearly too steep, many particles need more friction than there is, and others carry the rest. The
   forces on every particle come into balance, however stiff the dampers. */
static void rests_with_friction_at_its_limit(void)
{
    static model m;
    static const struct {
        double damping, friction, slope;
        bool set;
    } cases[] = {{3, 0.5, 0.3, false}, {12, 0.7, 0.68, false}, {60, 0.5, 0.3, true}, {60, 0.7, 0.68, false}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double steep = sizeof(scalar) == 4 && i == 3 ? 0.65 : cases[i].slope; /* docs/details.md */
        const double slope = atan(steep), up[] = {sin(slope), 0, cos(slope)};
        spring_scene *s = block_of(&m, 3, cases[i].damping, cases[i].friction, up);
        throw_block(s, &m, -slope, 0, NULL);
        advance_in_calls(s, 0.5 * spring_scene_stable_step(s, SPRING_LEAPFROG), 6000, cases[i].set);
        const bool single = sizeof(scalar) == 4;
        CHECK(spring_scene_at_rest(s, single ? 1e-3 : 1e-6, single ? 0.3 : 1e-6),
              "at rest, with all forces in balance");
        free(s);
    }
}

/* A block that static friction holds moves like one whose bottom is pinned when gravity begins to push it sideways. */
static void is_held_as_if_pinned(void)
{
    static model m;
    enum { side = 3 };
    static const uint8_t bottom[side * side * side] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    const double up[] = {0, 0, 1}, aside[] = {3, 0, -9.81};
    const spring_collider custom = {.shape = SPRING_CUSTOM, .gap = height, .thickness = 1, .friction = 2};
    double moved[3];
    for (int i = 0; i < 3; i++) { /* pinned, on a plane, on a custom body */
        spring_scene *s = block_of(&m, side, 60, 2, up);
        if (i == 0) {
            free(s);
            m.def.pinned = bottom;
            s = scene_of(&m.def);
        }
        if (i == 2)
            spring_scene_set_colliders(s, &custom, 1);
        static state start, y;
        advance_in_calls(s, 0.0003, 6000, false);
        get_state(s, m.def.particles, &start);
        spring_scene_set_gravity(s, aside);
        advance_in_calls(s, 0.0003, 100, false);
        get_state(s, m.def.particles, &y);
        const size_t top = 3 * (m.def.particles - 1);
        moved[i] = y.x[top] - start.x[top];
        free(s);
    }
    CHECK(moved[0] > 1e-5, "it moves [m]");
    for (int i = 1; i < 3; i++)
        CHECK_CLOSE(moved[i], moved[0], 1e-4 * moved[0], "its bottom does not move");
}

/* On a slope it slides as a rigid body: with g (sin - mu cos), and not at all if friction is larger; also if the slope is
   set again before each call. */
static void slides_down_a_slope(void)
{
    static model m;
    const double slope = 0.3, up[] = {sin(slope), 0, cos(slope)}, dt = 0.0003;
    const uint64_t third = 700;
    static const double friction[] = {0, 0.2, 0.5};
    for (int i = 0; i < 6; i++) {
        const double mu = friction[i % 3];
        spring_scene *s = block_of(&m, 4, 600, mu, up);
        throw_block(s, &m, -slope, 0, NULL);
        static state y;
        double speed[2] = {0}; /* after a third of the time, when it has settled, and at the end */
        for (int part = 0; part < 2; part++) {
            advance_in_calls(s, dt, part == 0 ? third : 2 * third, i >= 3);
            get_state(s, m.def.particles, &y);
            for (size_t p = 0; p < m.def.particles; p++)
                speed[part] += (y.v[3 * p] * cos(slope) - y.v[3 * p + 2] * sin(slope)) / (double)m.def.particles;
        }
        const double accel = (speed[1] - speed[0]) / (2 * (double)third * dt);
        CHECK_CLOSE(accel, fmax(0, 9.81 * (sin(slope) - mu * cos(slope))), 3e-4 * 9.81, "as a rigid body");
        for (size_t p = 0; p < m.def.particles; p++)
            CHECK_CLOSE(y.v[3 * p] * cos(slope) - y.v[3 * p + 2] * sin(slope), speed[1], 1e-3, "no vibration");
        free(s);
    }
}

/* A block that is pushed along a plane stops after u^2/(2 mu g), and friction is mu times the load in each step to
   friction_tolerance, however stiff the dampers. */
static void stops_by_friction(void)
{
    static model m;
    static state y;
    const double mu = 0.6, u = 5, up[] = {0, 0, 1}, tolerance = friction_tolerance;
    static const struct {
        double damping, of_stable_step;
    } cases[] = {{10, 0.9}, {95, 0.5}, {95, 0.9}, {224, 0.9}};
    for (int i = 0; i < 8; i++) {
        spring_scene *s = block_of(&m, 2, cases[i / 2].damping, mu, up);
        const double dt = cases[i / 2].of_stable_step * spring_scene_stable_step(s, SPRING_LEAPFROG);
        const double angle = i % 2 ? 0.7 : 0;
        run(s, SPRING_LEAPFROG, dt, 2000);
        get_state(s, m.def.particles, &y);
        const double x0 = y.x[0], y0 = y.x[1];
        for (size_t p = 0; p < m.def.particles; p++) {
            y.v[3 * p] += u * cos(angle);
            y.v[3 * p + 1] += u * sin(angle);
        }
        spring_scene_set(s, SPRING_VELOCITY, y.v, 0, 0, m.def.particles);
        for (double t = 0; t < 1.2 * u / (mu * 9.81); t += dt) {
            const spring_impulse j = impulse_in_step(s, dt);
            CHECK_BELOW(hypot(j.linear[0], j.linear[1]), mu * fabs(j.linear[2]) * (1 + tolerance) + tolerance * dt,
                        "Coulomb's law");
        }
        get_state(s, m.def.particles, &y);
        CHECK_CLOSE(hypot(y.x[0] - x0, y.x[1] - y0), u * u / (2 * mu * 9.81), 1e-3, "the way of a rigid block");
        free(s);
    }
}

/* While dampers stop a block that lands, the impulse of friction is that of the whole load. */
static void lands_with_friction(void)
{
    static model m;
    const double friction = 0.3, up[] = {0, 0, 1}, velocity[] = {5, 0, -3};
    static const double damping[] = {3, 12, 60};
    for (int i = 0; i < 3; i++) {
        spring_scene *s = block_of(&m, 3, damping[i], friction, up);
        throw_block(s, &m, 0, 0.01, velocity);
        double sum[3] = {0};
        for (int step = 0; step < 300; step++) {
            const spring_impulse j = impulse_in_step(s, 0.0003);
            for (int a = 0; a < 3; a++)
                sum[a] += j.linear[a];
        }
        CHECK_CLOSE(sum[0] / -sum[2], friction, 0.02 * friction, "it slides all the time");
        CHECK(-sum[2] > 3 * (double)m.def.particles * m.def.mass_all, "it has landed");
        free(s);
    }
}

/* Cubes with light to heavy damping are thrown on a floor, and tumble. Friction that stops a particle within a step may
   exceed its limit in this step. If colliders pulled particles in the kick, the excess would be ten times as large. */
static void tumbles(void)
{
    static model m;
    const double mu = 0.6, up[] = {0, 0, 1}, speed = 6;
    double worst = 0; /* [N s] excess of friction in a step */
    for (int i = 0; i < 300; i++) {
        spring_scene *s = block_of(&m, 2, random_log(0.3, 300), mu, up);
        const double angle = random_uniform(0, 6), v[] = {random_uniform(0, speed), 0, -3};
        throw_block(s, &m, angle, 0.3, v);
        const double dt = random_uniform(0.3, 0.9) * spring_scene_stable_step(s, SPRING_LEAPFROG);
        for (double t = 0; t < 2; t += dt) {
            const spring_impulse j = impulse_in_step(s, dt);
            worst = fmax(worst, hypot(j.linear[0], j.linear[1]) - mu * fabs(j.linear[2]));
        }
        free(s);
    }
    printf("# friction exceeds its limit by up to %.2g N s in a step\n", worst);
    CHECK_BELOW(worst, 0.004 * speed * (double)m.def.particles * m.def.mass_all, "a small part of the momentum");
}

/* A damped dumbbell is thrown on a rough floor in any direction. The reaction of its damper to its rotation is not a load
   that friction of the kick may use. */
static void lands_while_it_turns(void)
{
    static const double stiffness = 640, mass = 0.05, rest = 0.15, speed = 5;
    for (int i = 0; i < 240; i++) {
        const double angle = random_uniform(-1.5, 1.5), ratio = random_log(1, 1e4), turned = 0.15; /* [rad] in a step */
        const double dt = turned * rest / (speed * sqrt(2));
        const double position[] = {0, 0.16, 0, rest * sin(angle), 0.16 + rest * cos(angle), 0},
                     velocity[] = {speed, -speed, 0, speed, -speed, 0};
        const spring_link link = {0, 1, rest, stiffness, ratio * sqrt(2 * stiffness * mass), 0};
        spring_scene_def def = falling(2, position, velocity, mass);
        def.links = 1, def.link = &link, def.methods = 1u << SPRING_LEAPFROG;
        spring_collider c = ground;
        c.friction = random_uniform(0, 1);
        spring_scene *s = scene_with(&def, &c);
        CHECK(dt < 0.3 * spring_scene_stable_step(s, SPRING_LEAPFROG), "stable");
        const double kinetic = spring_scene_energy(s).kinetic;
        for (double before = total_energy(s), t = 0; t < 0.3; t += dt) {
            run(s, SPRING_LEAPFROG, dt, 1);
            const double after = total_energy(s);
            CHECK_BELOW(fmax(after - before, 0), turned * turned * kinetic,
                        "links turn by this angle: the neglected terms are of its square");
            before = after;
        }
        free(s);
    }
}

/* A turned block that falls on a plane with restitution: impacts add no energy, however stiff the dampers. */
static void impacts_add_no_energy(void)
{
    static model m;
    const double up[] = {0, 0, 1}, dt = 0.0004;
    static const double damping[] = {2, 6, 600};
    for (int i = 0; i < 3; i++)
        for (int rough = 0; rough < 2; rough++) {
            spring_scene *s = block_of(&m, 4, damping[i], rough ? 0.4 : 0, up);
            const spring_collider plane = {
                .shape = SPRING_PLANE, .axis = {{0, 0, 1}}, .friction = rough ? 0.4 : 0, .restitution = 0.6};
            set(s, &plane, 1);
            throw_block(s, &m, asin(0.6), 0.1, (double[]){0, 0, -2});
            const double start = total_energy(s);
            for (int part = 0; part < 150; part++) {
                run(s, SPRING_LEAPFROG, dt, 10);
                CHECK_BELOW(total_energy(s), start * (1 + 1000 * EPS), "at most what it started with");
            }
            CHECK_BELOW(total_energy(s), 0.6 * start, "and much is dissipated");
            free(s);
        }
}

/* Where damping reduces the speed after a bounce, the load of the impact is smaller, and so is its friction. */
static void bounces_with_friction(void)
{
    static model m;
    const double mu = 0.3, up[] = {0, 0, 1}, velocity[] = {5, 1, -3}, dt = 0.001;
    static const double damping[] = {3, 50, 1e3, 1e5}, restitution[] = {0.2, 0.5, 1};
    for (int i = 0; i < 12; i++) {
        spring_scene *s = block_of(&m, 2, damping[i / 3], mu, up);
        const spring_collider plane = {
            .shape = SPRING_PLANE, .axis = {{0, 0, 1}}, .friction = mu, .restitution = restitution[i % 3]};
        set(s, &plane, 1);
        throw_block(s, &m, 0, 0.05, velocity);
        spring_impulse j = {.linear = {0}};
        for (int step = 0; step < 100 && j.linear[2] == 0; step++)
            j = impulse_in_step(s, dt);
        const double load = -j.linear[2];
        CHECK(load > 1.4 * (double)m.def.particles * m.def.mass_all, "the particles at the bottom stop, at least");
        CHECK_CLOSE(hypot(j.linear[0], j.linear[1]), mu * load, 1000 * EPS, "all of them slide");
        free(s);
    }
}

/* Two ropes at infinite distance. They form a band, with a slot without a link between them. */
static void infinite_distance(void)
{
    enum { half = 10, count = 2 * half };
    double x[count][2], v[count][2] = {{0}}, now[count][2];
    spring_link link[count];
    spring_scene_def def = {.axes = 2, .particles = count, .position = x[0], .velocity = v[0], .link = link};
    for (uint32_t i = 0; i < count; i++) {
        x[i][0] = (i < half ? -0.9 : 0.9) * (double)SCALAR_MAX;
        x[i][1] = i % half;
        v[i][1] = i % half == 0;
        if (i % half > 0)
            link[def.links++] = (spring_link){i - 1, i, 1, 10, 100, 0};
    }
    for (int k = 0; k < kernel_count; k++) {
        if (kernels_of(k) == NULL)
            continue;
        spring_scene *s = scene_of(&def);
        CHECK(s->layout.bands == 1 && spring_scene_advance_with(kernels_of(k), s, SPRING_LEAPFROG, 0.1, 3) == SPRING_OK,
              "all forces are finite");
        spring_scene_get(s, SPRING_VELOCITY, now[0], 0, 0, count);
        CHECK_BELOW(fabs(now[0][1]), 0.5, "the links are damped");
        CHECK(memcmp(now, now + half, half * sizeof now[0]) == 0, "both ropes alike");
        free(s);
    }
}

/* Three particles in a line, whose weighted link with a rest length has the vector 0, and a link that is damped heavily. */
static spring_scene_def heavy_line(void)
{
    static const double x[8] = {0, 0, 1, 0, 2, 0, 3, 0};
    static const spring_link link = {2, 3, 1, 10, 1000, 0};
    static const spring_weighted_link weighted = {
        .particle = {0, 1, 2}, .weight = {1, -2, 1}, .rest = 0.1, .stiffness = 7, .damping = 2};
    spring_scene_def def = joined(2, 4, x, NULL, 1, &link);
    def.methods = 1u << SPRING_LEAPFROG, def.mass_all = 0.7, def.weighted_links = 1, def.weighted_link = &weighted;
    return def;
}

static void without_direction(void)
{
    const spring_scene_def def = heavy_line();
    spring_scene *s = scene_of(&def);
    double x[8];
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 5) == SPRING_OK, "a link without direction has no force");
    spring_scene_get(s, SPRING_POSITION, x, 0, 0, 4);
    CHECK(memcmp(x, def.position, sizeof x) == 0, "all links are at rest");
    free(s);
}

/* A link and a weighted link that are far shorter than their rest length push their ends apart. */
static void very_short_links(void)
{
    const double length = sizeof(scalar) == sizeof(float) ? 1e-15 : 1e-120;
    const double x[8] = {0, 0, length, 0, length, length, 0, length};
    const spring_link link = {0, 1, 0.1, 10, 100, 0};
    const spring_weighted_link weighted = {
        .particle = {2, 3}, .weight = {-1, 1}, .rest = 0.1, .stiffness = 10, .damping = 100};
    spring_scene_def def = joined(2, 4, x, NULL, 1, &link);
    def.mass_all = 0.7, def.weighted_links = 1, def.weighted_link = &weighted;
    for (int k = 0; k < kernel_count; k++) {
        if (kernels_of(k) == NULL)
            continue;
        spring_scene *s = scene_of(&def);
        double now[8];
        CHECK(spring_scene_advance_with(kernels_of(k), s, SPRING_LEAPFROG, 0.02, 1) == SPRING_OK,
              "all forces are finite");
        spring_scene_get(s, SPRING_VELOCITY, now, 0, 0, 4);
        CHECK(now[2] > 0 && now[0] == -now[2], "the ends move apart");
        CHECK_CLOSE(now[4], now[2], 16 * EPS, "both links alike");
        free(s);
    }
}

/* Adds a force that is not finite in the call that counts down to 0. */
static void bad_in_call(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                        scalar *const force[3])
{
    int *left = user;
    (void)t, (void)particles, (void)x, (void)v;
    if (--*left == 0)
        force[0][1] += (scalar)INFINITY;
}

/* A callback that uses velocities is called twice in a step. */
static void forces_not_finite(void)
{
    spring_scene_def def = heavy_line();
    for (int bad = 1; bad <= 3; bad++) {
        int left = bad;
        def.force = bad_in_call;
        def.user = &left;
        spring_scene *s = scene_of(&def);
        const spring_status status = spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 1);
        CHECK(status == (bad <= 2 ? SPRING_ENONFINITE : SPRING_OK), "in the first or in the second call");
        free(s);
    }
}

int main(void)
{
    static const test tests[] = {
        {"a step", plain_steps},
        {"infinite distance", infinite_distance},
        {"weighted links without direction", without_direction},
        {"forces that are not finite", forces_not_finite},
        {"creep", creep},
        {"turning", turning_dumbbell},
#ifndef SPRING_FLOAT
        {"spinning cloth", spinning_cloth},
#endif
        {"energy", damping_adds_no_energy},
        {"rests on a floor", rests_as_without_damping},
        {"rests on a plane that is set", rests_on_a_plane_that_is_set},
        {"rests with friction at its limit", rests_with_friction_at_its_limit},
        {"is held as if pinned", is_held_as_if_pinned},
        {"very short links", very_short_links},
        {"slides down a slope", slides_down_a_slope},
        {"lands with friction", lands_with_friction},
        {"stops by friction", stops_by_friction},
        {"tumbles", tumbles},
        {"lands while it turns", lands_while_it_turns},
        {"impacts", impacts_add_no_energy},
        {"bounces with friction", bounces_with_friction},
    };
    return RUN_TESTS("scene_exponential_kick", tests);
}
