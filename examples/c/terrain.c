/* SPDX-License-Identifier: MIT */
/*
 * Ropes and loose stones slide down a hill into a valley. The ground is a height map, as a custom body.
 *
 *     cc -std=c11 terrain.c -lspringstep -lm -o terrain
 *
 * ground_gap() works for any height map. The gap is the height above the ground divided by sqrt(1 + steepest^2), which is at
 * most the distance from the ground. So a particle of radius r rests r sqrt(1 + steepest^2) above the ground.
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROWS = 20, ROW = 20, N = ROWS * ROW, SIDE = 33, STEPS = 8 }; /* STEPS steps per frame */
static const double frame = 1.0 / 60, radius = 0.02;                /* [s], [m] of every particle */

typedef struct terrain {
    double height[SIDE][SIDE]; /* [m] of the point (x, z) = (j cell, i cell) at [i][j] */
    double cell, steepest;     /* [m], largest slope */
} terrain;

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

/* The height of the ground and its slopes along x and z. It is bilinear in each cell, and level beyond the map. */
static double ground(const terrain *t, double x, double z, double slope[2])
{
    const double p = x / t->cell, q = z / t->cell, u = fmin(fmax(p, 0), SIDE - 1), v = fmin(fmax(q, 0), SIDE - 1);
    const int i = (int)fmin(u, SIDE - 2), j = (int)fmin(v, SIDE - 2);
    const double *h0 = &t->height[j][i], *h1 = &t->height[j + 1][i], a = u - i, b = v - j;
    slope[0] = u == p ? ((1 - b) * (h0[1] - h0[0]) + b * (h1[1] - h1[0])) / t->cell : 0;
    slope[1] = v == q ? ((1 - a) * (h1[0] - h0[0]) + a * (h1[1] - h0[1])) / t->cell : 0;
    return (1 - b) * ((1 - a) * h0[0] + a * h0[1]) + b * ((1 - a) * h1[0] + a * h1[1]);
}

static uint32_t ground_gap(void *user, const double point[3], double gap[3], double normal[3][3])
{
    const terrain *t = user;
    double slope[2];
    gap[0] = (point[1] - ground(t, point[0], point[2], slope)) / sqrt(1 + t->steepest * t->steepest);
    const double length = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
    normal[0][0] = -slope[0] / length, normal[0][1] = 1 / length, normal[0][2] = -slope[1] / length;
    return 1;
}

static void make_terrain(terrain *t)
{
    double dx = 0, dz = 0;
    t->cell = 0.25;
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) { /* a valley along z at x = 4.5 m, with bumps */
            const double x = j * t->cell - 4.5, z = i * t->cell - 4;
            t->height[i][j] = 0.1 * x * x + 0.05 * z * z + 0.1 * sin(2.2 * x) * cos(1.9 * z);
            dx = fmax(dx, j > 0 ? fabs(t->height[i][j] - t->height[i][j - 1]) / t->cell : 0);
            dz = fmax(dz, i > 0 ? fabs(t->height[i][j] - t->height[i - 1][j]) / t->cell : 0);
        }
    t->steepest = hypot(dx, dz);
}

static void show(const spring_scene *s, terrain *t)
{
    static double x[N][3], v[N][3];
    double least = INFINITY, fastest = 0, mean[2] = {0}, gap[3], normal[3][3];
    must(spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, N));
    must(spring_scene_get(s, SPRING_VELOCITY, v[0], 0, 0, N));
    for (int i = 0; i < N; i++) {
        ground_gap(t, x[i], gap, normal);
        least = fmin(least, gap[0] - radius);
        fastest = fmax(fastest, sqrt(v[i][0] * v[i][0] + v[i][1] * v[i][1] + v[i][2] * v[i][2]));
        mean[i / ROW % 2] += x[i][0] * 2 / N;
    }
    printf("%4.1f s  mean x: ropes %.2f m, stones %.2f m  least gap %.1e m  fastest %.1e m/s\n", spring_scene_time(s),
           mean[0], mean[1], least, fastest);
}

int main(void)
{
    static double x[N][3];
    static spring_link link[N];
    static terrain map;
    double slope[2];
    size_t links = 0, bytes;
    make_terrain(&map);
    for (int i = 0; i < N; i++) { /* every other row is a rope, the others are stones */
        x[i][0] = 0.5 + 0.15 * (i / ROW);
        x[i][2] = 2.5 + 0.15 * (i % ROW);
        x[i][1] = ground(&map, x[i][0], x[i][2], slope) + 0.3;
        if (i / ROW % 2 == 0 && i % ROW > 0)
            link[links++] = (spring_link){(uint32_t)i - 1, (uint32_t)i, 0.15, 2000, 0.5, 0};
    }
    const spring_scene_def def = {.particles = N,
                                  .links = links,
                                  .position = x[0],
                                  .mass_all = 0.02,
                                  .link = link,
                                  .gravity = {0, -9.81, 0},
                                  .colliders = 1,
                                  .particle_radius = radius};
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *s = NULL;
    must(memory == NULL ? SPRING_ENOMEM : spring_scene_init(memory, bytes, &def, &s));
    const spring_collider c = {
        .shape = SPRING_CUSTOM, .gap = ground_gap, .user = &map, .thickness = 1, .friction = 0.2, .restitution = 0.2};
    must(spring_scene_set_colliders(s, &c, 1)); /* it does not move */
    for (int i = 0; i <= 10 * 60; i++) {
        if (i % 60 == 0)
            show(s, &map);
        must(spring_scene_advance(s, SPRING_LEAPFROG, frame / STEPS, STEPS));
    }
    free(memory);
    return 0;
}
