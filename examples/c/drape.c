/* SPDX-License-Identifier: MIT */
/*
 * A cloth falls onto a sphere and the ground, slides a little and comes to rest by friction.
 *
 *     cc -std=c11 drape.c -lspringstep -lm -o drape
 *
 * Colliders act on particles, not on the links between them. With a spacing that is small compared with the sphere, the
 * radius of the particles keeps links outside as well.
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 25, N = SIDE * SIDE, STEPS = 12 };
static const double frame = 1.0 / 60;                    /* [s] */
static const double ball[3] = {0, 0.3, 0}, radius = 0.3; /* [m] */
static const double skin = 0.01;                         /* [m] radius of a particle */

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

static double from_ball(const double x[3])
{
    return hypot(hypot(x[0] - ball[0], x[1] - ball[1]), x[2] - ball[2]) - radius;
}

int main(void)
{
    const spring_grid sheet = {.count = {SIDE, SIDE},
                               .spacing = 0.05,
                               .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                               .stiffness = 30,
                               .damping = 0.03};
    static double x[N][3];
    static spring_link link[6 * N]; /* fewer than six per particle */
    size_t particles, links, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, x[0], NULL, link));
    for (int i = 0; i < N; i++) { /* flat, above the ball */
        x[i][0] -= 0.5;
        x[i][2] = x[i][1] - 0.6;
        x[i][1] = 0.8;
    }
    const spring_scene_def def = {.particles = particles,
                                  .links = links,
                                  .position = x[0],
                                  .mass_all = 0.007,
                                  .link = link,
                                  .gravity = {0, -9.81, 0},
                                  .drag = 0.007,
                                  .colliders = 2,
                                  .particle_radius = skin};
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *cloth;
    if (memory == NULL)
        return 1;
    must(spring_scene_init(memory, bytes, &def, &cloth));
    if (!(frame / STEPS < 0.5 * spring_scene_stable_step(cloth, SPRING_LEAPFROG)))
        return 1;
    const spring_collider colliders[2] = {
        {.shape = SPRING_SPHERE, .at = {ball[0], ball[1], ball[2]}, .radius = radius, .friction = 0.5},
        {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .friction = 0.8}};
    must(spring_scene_set_colliders(cloth, colliders, 2)); /* set once, since they do not move */

    for (int i = 1; i <= 6 * 60; i++) {
        must(spring_scene_advance(cloth, SPRING_LEAPFROG, frame / STEPS, STEPS));
        if (i % 20 != 0)
            continue;
        static uint32_t mask[N];
        must(spring_scene_touching(cloth, mask, 0, N));
        must(spring_scene_get(cloth, SPRING_POSITION, x[0], 0, 0, N));
        double lowest = INFINITY, nearest = INFINITY;
        size_t on_ball = 0, on_ground = 0;
        for (int k = 0; k < N; k++) {
            lowest = fmin(lowest, x[k][1] - skin);
            nearest = fmin(nearest, from_ball(x[k]) - skin);
            on_ball += (mask[k] & 1) != 0;
            on_ground += (mask[k] & 2) != 0;
        }
        printf(
            "%.2f s  above ground %+.1e m  from the ball %+.1e m  on the ball %zu  on the ground %zu  kinetic %.1e J  "
            "%s\n",
            spring_scene_time(cloth), lowest, nearest, on_ball, on_ground, spring_scene_energy(cloth).kinetic,
            spring_scene_at_rest(cloth, 0.02, 1) ? "at rest" : "moving");
    }
    free(memory);
    return 0;
}
