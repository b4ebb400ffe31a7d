/* SPDX-License-Identifier: MIT */
/* Custom bodies: a height field, the inside of a sphere, a triangle mesh, shells and faces, and their saved states. */
#include "test_contact.h"

#include <stdio.h>

/* Solid between the radii 0.9 and 0.9 + *user. */
static uint32_t shell(void *user, const double p[3], double gap[3], double normal[3][3])
{
    const double half = *(const double *)user / 2, middle = 0.9 + half, r = length(p);
    gap[0] = fabs(r - middle) - half;
    for (int a = 0; a < 3; a++)
        normal[0][a] = (r > middle ? 1 : -1) * p[a] / r;
    return 1;
}

static uint32_t hollow_sphere(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const double r = length(y);
    for (int a = 0; a < 3; a++)
        normal[0][a] = r > 0 ? -y[a] / r : a == 1;
    gap[0] = *(double *)user - r;
    return 1;
}

/* A height field h = A sin 3x cos 2z, over its largest slope. */
static uint32_t hills(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const double A = *(double *)user, h = A * sin(3 * y[0]) * cos(2 * y[2]), slope = sqrt(1 + 9 * A * A);
    const double n[3] = {-3 * A * cos(3 * y[0]) * cos(2 * y[2]), 1, 2 * A * sin(3 * y[0]) * sin(2 * y[2])};
    for (int a = 0; a < 3; a++)
        normal[0][a] = n[a] / length(n);
    gap[0] = (y[1] - h) / slope;
    return 1;
}

typedef struct mesh {
    size_t count;
    double at[512][3][3];
} mesh;

static void nearest_on_triangle(const double t[3][3], const double p[3], double out[3])
{
    double best = INFINITY, ab[3], ac[3], n[3], ap[3];
    for (int a = 0; a < 3; a++)
        ab[a] = t[1][a] - t[0][a], ac[a] = t[2][a] - t[0][a], ap[a] = p[a] - t[0][a];
    cross(ab, ac, n);
    double c1[3], c2[3];
    cross(ap, ac, c1);
    cross(ab, ap, c2);
    const double u = dot(c1, n) / dot(n, n), v = dot(c2, n) / dot(n, n);
    if (u >= 0 && v >= 0 && u + v <= 1) {
        for (int a = 0; a < 3; a++)
            out[a] = t[0][a] + u * ab[a] + v * ac[a];
        return;
    }
    for (int k = 0; k < 3; k++) {
        double edge[3], from[3], q[3], square = 0;
        for (int a = 0; a < 3; a++)
            edge[a] = t[(k + 1) % 3][a] - t[k][a], from[a] = p[a] - t[k][a];
        const double f = fmin(1, fmax(0, dot(from, edge) / dot(edge, edge)));
        for (int a = 0; a < 3; a++)
            q[a] = t[k][a] + f * edge[a], square += (p[a] - q[a]) * (p[a] - q[a]);
        if (square < best) {
            best = square;
            memcpy(out, q, sizeof q);
        }
    }
}

/* A shell: the distance from its triangles, to which the radius of the collider is added. */
static uint32_t mesh_distance(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const mesh *m = user;
    gap[0] = INFINITY;
    for (size_t i = 0; i < m->count; i++) {
        double q[3] = {0}, d[3];
        nearest_on_triangle(m->at[i], y, q);
        for (int a = 0; a < 3; a++)
            d[a] = y[a] - q[a];
        const double r = length(d);
        if (r < gap[0]) {
            gap[0] = r;
            for (int a = 0; a < 3; a++)
                normal[0][a] = r > 0 ? d[a] / r : a == 1;
        }
    }
    return 1;
}

static void add_triangle(mesh *m, const double a[3], const double b[3], const double c[3], int level)
{
    if (level == 0) {
        memcpy(m->at[m->count][0], a, 3 * sizeof *a);
        memcpy(m->at[m->count][1], b, 3 * sizeof *b);
        memcpy(m->at[m->count++][2], c, 3 * sizeof *c);
        return;
    }
    double ab[3], bc[3], ca[3];
    for (int k = 0; k < 3; k++)
        ab[k] = a[k] + b[k], bc[k] = b[k] + c[k], ca[k] = c[k] + a[k];
    const double l[3] = {length(ab), length(bc), length(ca)};
    for (int k = 0; k < 3; k++)
        ab[k] /= l[0], bc[k] /= l[1], ca[k] /= l[2];
    add_triangle(m, a, ab, ca, level - 1);
    add_triangle(m, ab, b, bc, level - 1);
    add_triangle(m, ca, bc, c, level - 1);
    add_triangle(m, ab, bc, ca, level - 1);
}

static void ball_of_triangles(mesh *m, int level)
{
    m->count = 0;
    for (int i = 0; i < 8; i++) {
        const double a[3] = {i & 1 ? -1 : 1, 0, 0}, b[3] = {0, i & 2 ? -1 : 1, 0}, c[3] = {0, 0, i & 4 ? -1 : 1};
        add_triangle(m, a, b, c, level);
    }
}

/* Shoots 50 particles about. Returns how many end on the other side. */
static int shots(spring_collider c, double radius, double speed, bool field, double g)
{
    enum { count = 50 };
    double x[count][3], v[count][3];
    for (int i = 0; i < count; i++) {
        double to[3], at[3];
        random_unit(to, 3);
        random_unit(at, 3);
        const double far = random_uniform(0, 0.5), u = speed * random_uniform(0.5, 1);
        for (int a = 0; a < 3; a++) {
            x[i][a] = field ? (a == 1 ? random_uniform(0.5, 1.5) : random_uniform(0, 4)) : far * at[a];
            v[i][a] = field ? speed * (a == 1 ? -random_uniform(0, 1) : random_uniform(-0.5, 0.5)) : u * to[a];
        }
    }
    spring_scene_def def = falling(count, x[0], v[0], 0.3);
    def.gravity[1] = -g, def.particle_radius = radius;
    spring_scene *s = scene_with(&def, &c);
    int out = 0;
    for (int k = 0; k < 300; k++)
        run(s, SPRING_LEAPFROG, 1. / 480, 1);
    for (size_t i = 0; i < count; i++) {
        double now[3], gap[3], normal[3][3];
        spring_scene_get(s, SPRING_POSITION, now, 0, i, 1);
        hills(c.user, now, gap, normal);
        out += field ? gap[0] < -1e-5 : !(length(now) < 1);
    }
    free(s);
    return out;
}

static void custom_bodies(void)
{
    static mesh fine, coarse;
    double radius = 1, height = 0.15, wall = 0.2;
    ball_of_triangles(&fine, 2);
    ball_of_triangles(&coarse, 0);
    int out = 0, all = 0;
    for (int bounces = 0; bounces < 2; bounces++) {
        spring_collider c = {.shape = SPRING_CUSTOM, .thickness = 0.04, .restitution = bounces * 0.9, .friction = 0.3};
        c.gap = hollow_sphere, c.user = &radius;
        out += shots(c, 0.01, 500, false, gravity);
        c.friction = 0, c.spin[0] = 1.5, c.spin[1] = 5;
        out += shots(c, 0.01, 500, false, gravity);
        c.friction = 0.3, c.spin[0] = c.spin[1] = 0, c.gap = hills, c.user = &height;
        out += shots(c, 0.01, 500, true, gravity);
        out += shots(c, 0.01, 5, true, gravity);
        c.gap = mesh_distance, c.user = &fine, c.radius = 0.01, c.thickness = 0.02;
        out += shots(c, 0.01, 500, false, 0);
        c.friction = 0, c.spin[1] = 3;
        out += shots(c, 0.01, 20, false, gravity);
        c.user = &coarse, c.spin[1] = 0, c.radius = 0.005, c.thickness = 0.01;
        out += shots(c, 0.005, 500, false, gravity);
        /* several diameters per step, so particles hit the wall again within a step and move straight into it */
        c = (spring_collider){.shape = SPRING_CUSTOM, .gap = shell, .user = &wall, .thickness = wall};
        c.restitution = bounces, c.friction = 0.3;
        out += shots(c, 0, 3000, false, 0);
        all += 8 * 50;
    }
    printf("# %d of %d particles left\n", out, all);
    CHECK(out == 0, "none passes through");
}

/* Slides on a body for a second. */
static void slide_on(spring_collider c, const double x[3], const double v[3], uint64_t steps, double out[3])
{
    double at[3] = {x[0], x[1], x[2]}, gap[3], n[3][3], u[3];
    for (int k = 0; k < 200; k++) {
        c.gap(c.user, at, gap, n);
        for (int a = 0; a < 3; a++)
            at[a] -= gap[0] * n[0][a];
    }
    c.gap(c.user, at, gap, n);
    for (int a = 0; a < 3; a++)
        u[a] = v[a] - dot(v, n[0]) * n[0][a];
    end_of(particle_on(&c, 1, at, u, down), SPRING_LEAPFROG, 1. / (double)steps, steps, out, u);
}

static void custom_order(void)
{
    double radius = 1, height = 0.15;
    for (int kind = 0; kind < 4 && in_double; kind++) {
        spring_collider c = {
            .shape = SPRING_CUSTOM, .thickness = 0.04, .friction = kind & 1 ? (kind & 2 ? 0.1 : 0.2) : 0};
        c.gap = kind & 2 ? hills : hollow_sphere, c.user = kind & 2 ? &height : &radius;
        const double x[3] = {kind & 2 ? 0.2 : 0.6, kind & 2 ? 0.1 : -0.7, 0.1},
                     v[3] = {kind & 2 ? 1 : 0.3, 0, kind & 2 ? 0.4 : 0.8};
        double best[3], now[3], error[2];
        slide_on(c, x, v, 1 << 15, best);
        for (int fine = 0; fine < 2; fine++) {
            slide_on(c, x, v, fine ? 1024 : 64, now);
            for (int a = 0; a < 3; a++)
                now[a] -= best[a];
            error[fine] = length(now);
        }
        printf("# %s: order %.2f\n", kind & 2 ? "hills" : "inside of a sphere", log2(error[0] / error[1]) / 4);
        CHECK(log2(error[0] / error[1]) / 4 >= 1.9, "second order");
    }
}

static uint32_t not_finite_gap(void *user, const double y[3], double gap[3], double normal[3][3])
{
    (void)user;
    gap[0] = y[1] > 0.5 ? y[1] : (double)NAN;
    normal[0][0] = normal[0][2] = 0, normal[0][1] = 1;
    return 1;
}

static faces floor_and_wall = {2, {{0, 1, 0}, {1, 0, 0}}}, valley = {2, {{0.8, 0.6, 0}, {-0.8, 0.6, 0}}};

/* A valley of two faces, as two contacts of one body: a particle rests in it. Gaps that are not finite are reported. */
static void contacts_of_a_custom_body(void)
{
    const double x[3] = {0.1, 1, 0};
    spring_scene *s = particle_on(NULL, 1, x, none, down);
    spring_collider c = {.shape = SPRING_CUSTOM, .thickness = 1, .gap = gaps_of_faces, .user = &valley};
    double now[3], v[3];
    set(s, &c, 1);
    run(s, SPRING_LEAPFROG, 1. / 480, 4800);
    get(s, now, v);
    CHECK_BELOW(length(v), in_double ? 1e-10 : 1e-3, "at rest");
    CHECK_BELOW(hypot(now[0], now[1]), 1e-4, "at the bottom");
    CHECK(spring_scene_at_rest(s, 1e-3, 1e-3), "balanced by both contacts");
    free(s);
    s = particle_on(NULL, 1, x, none, down);
    c.gap = not_finite_gap;
    set(s, &c, 1);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1. / 480, 4800) == SPRING_ENONFINITE, "reported");
    get(s, now, v);
    CHECK(now[1] == 1, "nothing has changed");
    free(s);
}

/* A particle slides over the floor of a custom body to its wall, and not less far, wherever the body is and however thick. */
static void corner_of_a_custom_body(void)
{
    for (int k = 0; k < 60; k++) {
        const double at = k % 4 ? random_log(0.1, 100) : 0, thickness = random_log(1, 1e6), speed = random_log(0.1, 10);
        const double x[3] = {at + 0.7 * speed, 0, 0}, v[3] = {-speed, 0, 0}, dt = 1. / 480;
        spring_collider c = {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .user = &floor_and_wall, .at = {at}};
        c.thickness = thickness;
        /* rounding errors of positions, and 1000 slops of the function, see contact.c */
        const double off = fmax(100 * EPS * (at + 1), 8e3 * DBL_EPSILON * (2 * at + 1 + thickness));
        spring_scene *s = particle_on(&c, 1, x, v, down);
        double now[3], w[3] = {-speed, 0, 0};
        for (int n = 0; n < 480 && w[0] < -speed / 2; n++) {
            run(s, contact_methods[k % second_order], dt, 1);
            get(s, now, w);
        }
        CHECK_BELOW(now[0] - at, off, "it stops at the wall");
        CHECK_BELOW(w[0], off / dt, "a rounding error");
        free(s);
    }
}

/* A state does not have the functions of custom bodies: those of the scene stay, and must be in the same places. */
static void saved_bodies(void)
{
    const double x[3] = {0.7, 1, -0.9};
    spring_scene *s = particle_on(NULL, 2, x, none, down), *other = particle_on(NULL, 2, none, none, none);
    spring_collider c[2] = {unit_box, {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .thickness = 0.1}};
    c[1].user = &valley, c[1].friction = 0.1;
    c[0].at[1] = -5;
    c[0].acceleration[1] = 0.3;
    c[0].spin_acceleration[2] = 0.2;
    c[0].mask = c[1].mask = 6;
    c[1].surface[0] = 0.1;
    set(s, c, 2);
    run(s, SPRING_LEAPFROG, 1. / 480, 100);
    size_t bytes = 0;
    spring_scene_save(s, NULL, &bytes);
    uint8_t *const saved = malloc(bytes);
    CHECK(spring_scene_save(s, saved, &bytes) == SPRING_OK, "a state");
    CHECK(spring_scene_load(other, saved, bytes) == SPRING_EINVAL, "no custom body at index 1");
    const spring_collider wrong[2] = {c[1], c[0]};
    set(other, wrong, 2);
    CHECK(spring_scene_load(other, saved, bytes) == SPRING_EINVAL, "a custom body in another place");
    const spring_collider right[2] = {{.shape = SPRING_SPHERE, .radius = 1},
                                      {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .user = &valley, .thickness = 3}};
    set(other, right, 2);
    CHECK(spring_scene_load(other, saved, bytes) == SPRING_OK, "all but the function is in the state");
    run(s, SPRING_LEAPFROG, 1. / 480, 500);
    run(other, SPRING_LEAPFROG, 1. / 480, 500);
    CHECK(same_bits(s, other, 1, 3), "they go on alike");
    free(saved);
    free(s);
    free(other);
}

static const test tests[] = {
    {"custom bodies", custom_bodies},
    {"order on custom bodies", custom_order},
    {"contacts of a custom body", contacts_of_a_custom_body},
    {"corner of a custom body", corner_of_a_custom_body},
    {"saved bodies", saved_bodies},
};

int main(void)
{
    return RUN_TESTS("custom bodies", tests);
}
