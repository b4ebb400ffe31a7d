/* SPDX-License-Identifier: MIT */
/* The stretch of ropes and sheets under their own weight: the formulas of spring_grid in scene.h and settled scenes. */
#include "test_scene.h"

static const double mass = 0.013, gravity = 9.81, spacing = 0.11; /* [kg], [m/s^2], [m] */
static const double balanced = 1e-5; /* of gravity: the largest acceleration of a scene at rest */

typedef struct hanging {
    double weight;  /* [N] of the free particles */
    double sinks;   /* [m] the largest distance of a particle from where links at rest length have it */
    double stretch; /* the largest of a link */
} hanging;

static double distance(uint32_t axes, const double *x, const double *y)
{
    double sum = 0;
    for (uint32_t a = 0; a < axes; a++)
        sum += (x[a] - y[a]) * (x[a] - y[a]);
    return sqrt(sum);
}

/* Lets a grid come to rest, which starts at its rest lengths; gravity is along the last axis. */
static hanging settle(const spring_grid *g, bool by_corners)
{
    static double start[3 * 1024], x[3 * 1024];
    static uint8_t pinned[1024];
    static spring_link link[6144];
    size_t particles, links;
    CHECK(spring_grid_size(g, &particles, &links) == SPRING_OK && particles <= 1024 && links <= 6144, "fits");
    spring_grid_fill(g, start, pinned, link);
    pinned[0] = 1;
    if (by_corners)
        pinned[g->count[0] - 1] = 1;
    const double length = spacing * fmax(g->count[0], g->count[1]), rate = 2 * sqrt(gravity / length);
    spring_scene_def def = {.axes = g->axes,
                            .particles = particles,
                            .links = links,
                            .position = start,
                            .mass_all = mass,
                            .pinned = pinned,
                            .link = link,
                            .drag = rate * mass,
                            .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY};
    def.gravity[g->axes - 1] = gravity;
    spring_scene *s = scene_of(&def);
    const double dt = 0.5 * spring_scene_stable_step(s, SPRING_LEAPFROG);
    bool at_rest = false;
    for (int i = 0; i < 1000 && !at_rest; i++) {
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, (uint64_t)ceil(1 / (rate * dt))) == SPRING_OK, "stable");
        at_rest = spring_scene_at_rest(s, balanced * gravity / rate, balanced * gravity);
    }
    CHECK(at_rest, "drag brings it to rest");
    spring_scene_get(s, SPRING_POSITION, x, 0, 0, particles);
    free(s);
    hanging h = {0, 0, 0};
    for (size_t i = 0; i < particles; i++) {
        h.weight += pinned[i] ? 0 : mass * gravity;
        h.sinks = fmax(h.sinks, distance(g->axes, &x[g->axes * i], &start[g->axes * i]));
    }
    for (size_t i = 0; i < links; i++)
        h.stretch =
            fmax(h.stretch, distance(g->axes, &x[g->axes * link[i].a], &x[g->axes * link[i].b]) / link[i].rest - 1);
    return h;
}

static void ropes(void)
{
    for (uint32_t n = 1; n <= 40; n = 2 * n + 1) {
        const double k = 17 * n * n;
        const spring_grid g = {.count = {n + 1}, .axes = 1, .spacing = spacing, .stiffness = k};
        const hanging h = settle(&g, false);
        const double longer = mass * gravity * n * (n + 1) / (2 * k), stretch = n * mass * gravity / (k * spacing);
        CHECK_CLOSE(h.sinks, longer, 1e-4 * longer, "the sum over all links, whose forces balance to 1e-5");
        CHECK_CLOSE(h.stretch, stretch, 1e-4 * stretch, "the first link carries all particles");
    }
}

static void sheets_by_an_edge(void)
{
    for (uint32_t n = 3; n <= 24; n *= 2) {
        const double k = 17 * n * n;
        const spring_grid g = {
            .count = {9, n + 1}, .axes = 2, .spacing = spacing, .stiffness = k, .pinned = SPRING_GRID_FIRST_Y};
        const hanging h = settle(&g, false);
        const double longer = mass * gravity * n * (n + 1) / (2 * k), stretch = n * mass * gravity / (k * spacing);
        CHECK_CLOSE(h.sinks, longer, 1e-4 * longer, "each column is a rope");
        CHECK_CLOSE(h.stretch, stretch, 1e-4 * stretch, "each column is a rope");
    }
}

/* The weight of a sheet of n by n particles without the pinned ones. */
static double weight_of(uint32_t n)
{
    return (n * n - 2) * mass * gravity;
}

static void nets_by_two_corners(void)
{
    const double relative[] = {30, 80, 200}; /* stiffness spacing / weight: links stretch by 1 to 3.6 % */
    for (uint32_t n = 12; n <= 32; n += 10)
        for (int i = 0; i < 3; i++) {
            const double k = relative[i] * weight_of(n) / spacing;
            const spring_grid g = {.count = {n, n}, .axes = 2, .spacing = spacing, .stiffness = k};
            const hanging h = settle(&g, true);
            CHECK_CLOSE(h.weight, weight_of(n), 1e-12 * h.weight, "the weight");
            const double share = h.weight / (k * spacing), stretch = cbrt(share * share / 24);
            const double sinks = (n - 1) * spacing * cbrt(share * 3 / 64);
            CHECK_CLOSE(h.stretch, stretch, 0.05 * stretch, "the first row is a cable with all of the weight");
            CHECK_CLOSE(h.sinks, sinks, 0.05 * sinks, "as deep as this cable hangs");
        }
}

/* Level at the start, so that they fold as cloth does. */
static void sheets_by_two_corners(void)
{
    const double measured[] = {0.30, 0.175}; /* without bend springs, with them */
    for (int bend = 0; bend < 2; bend++)
        for (uint32_t n = 8; n <= 24; n += 8) {
            const double k = 40 * weight_of(n) / spacing;
            const spring_grid g = {
                .count = {n, n},
                .axes = 3,
                .spacing = spacing,
                .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | (bend ? SPRING_GRID_BEND : 0),
                .stiffness = k,
            };
            const double stretch = measured[bend] * weight_of(n) / (k * spacing);
            CHECK_CLOSE(settle(&g, true).stretch, stretch, 0.05 * stretch,
                        "the links at a corner carry half of the weight, which they share");
        }
}

int main(void)
{
    static const test tests[] = {
        {"ropes", ropes},
        {"sheets that hang by an edge", sheets_by_an_edge},
        {"sheets of structural springs that hang by two corners", nets_by_two_corners},
        {"sheets with shear and bend springs that hang by two corners", sheets_by_two_corners},
    };
    return RUN_TESTS("scene_hanging", tests);
}
