/* SPDX-License-Identifier: MIT */
/*
 * A heavy ball of your own, which is not part of the scene, falls on a cloth that hangs between two bars, and comes to rest.
 * Then a hand pulls it down and lets go: the cloth throws it like a sling.
 *
 *     cc -std=c11 ball.c -lspringstep -lm -o ball
 *
 * The ball is a collider. The impulses that particles gave to it in a call change its velocity after the call:
 *
 *     V += J/M + g T        with the impulse J of a call that advances the scene by T
 *
 * Its `acceleration` in the next call is that of the last one, g + J/(M T), extrapolated by half of the change of J/(M T)
 * from one call to the next. For a ball on a single spring, this is stable for omega T <= 0.6, where omega^2 =
 * (stiffness that the ball feels)/M. docs/games.md has further conditions. While the hand holds the ball, its velocity
 * is the hand's.
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 15, N = SIDE * SIDE, EXCHANGES = 2, STEPS = 32 }; /* STEPS steps between exchanges */
static const double frame = 1.0 / 60, g[3] = {0, -9.81, 0}, mass = 5, radius = 0.2,
                    air = 1, /* [1/s] drag of the ball */
    hand[3] = {0, -0.6, 0};  /* [m/s] */

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

int main(void)
{
    const spring_grid sheet = {.count = {SIDE, SIDE},
                               .spacing = 0.06,
                               .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                               .stiffness = 1000,
                               .damping = 0.1,
                               .pinned = SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X};
    static double x[N][3];
    static uint8_t pinned[N];
    static spring_link link[6 * N];
    size_t particles, links, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, x[0], pinned, link));
    for (int i = 0; i < N; i++) { /* flat, about the origin */
        x[i][0] -= 0.42;
        x[i][2] = x[i][1] - 0.42;
        x[i][1] = 0;
    }
    const spring_scene_def def = {.particles = particles,
                                  .links = links,
                                  .position = x[0],
                                  .pinned = pinned,
                                  .mass_all = 0.002,
                                  .link = link,
                                  .gravity = {g[0], g[1], g[2]},
                                  .drag = 0.001,
                                  .colliders = 1,
                                  .particle_radius = 0.01};
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *cloth;
    if (memory == NULL)
        return 1;
    must(spring_scene_init(memory, bytes, &def, &cloth));

    const double T = frame / EXCHANGES;
    double pushed[3] = {0}; /* [m/s^2] by the impulses of the last call */
    spring_collider ball = {
        .shape = SPRING_SPHERE, .at = {0.013, radius + 0.03, 0.007}, .radius = radius, .friction = 0.3};
    for (int i = 1; i <= 21 * 60 + 20; i++) {
        const bool held = i > 20 * 60 && i <= 20 * 60 + 30;
        for (int k = 0; k < EXCHANGES; k++) {
            spring_impulse given;
            must(spring_scene_set_colliders(cloth, &ball, 1));
            must(spring_scene_advance(cloth, SPRING_LEAPFROG, T / STEPS, STEPS));
            must(spring_scene_impulses(cloth, &given, 0, 1));
            for (int a = 0; a < 3; a++) {
                const double push = given.linear[a] / (mass * T), accel = g[a] + push - air * ball.velocity[a];
                ball.at[a] += T * ball.velocity[a] + T * T / 2 * ball.acceleration[a]; /* where the collider is now */
                ball.velocity[a] = held ? hand[a] : ball.velocity[a] + T * accel;
                ball.acceleration[a] = held ? 0 : accel + (push - pushed[a]) / 2;
                pushed[a] = push;
            }
        }
        if (i % 120 == 0 || (i > 20 * 60 && i % 10 == 0))
            printf("%4.1f s  height %.4f m  speed %.1e m/s\n", i * frame, ball.at[1],
                   hypot(hypot(ball.velocity[0], ball.velocity[1]), ball.velocity[2]));
    }
    free(memory);
    return 0;
}
