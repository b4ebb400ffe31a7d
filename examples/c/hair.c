/* SPDX-License-Identifier: MIT */
/*
 * Hair on a head that shakes. Each hair is a rod: a row of springs that keeps its length, and weighted links that resist
 * bending. It stands for a strand, so it is stiffer than a real hair, which has about 8e-9 N m^2. The first two particles
 * of a hair are pinned to the head, which holds its direction.
 *
 *     cc -std=c11 hair.c -lspringstep -lm -o hair
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { HAIRS = 80, SEGMENTS = 10, ROW = SEGMENTS + 2, N = HAIRS * ROW, STEPS = 24 };
static const double frame = 1.0 / 60, radius = 0.1;                          /* [s], [m] of the head */
static const double length = 0.2, rigidity = 1e-5, mass = 2e-5, drag = 4e-5; /* [m], [N m^2], [kg], [N s/m] */
static const double stiffness = 5, damping = 1e-3, damping_time = 5e-3;      /* [N/m], [N s/m], [s] */
static double x[N][3];

static void must(spring_status status)
{
    if (status != SPRING_OK)
        exit(fprintf(stderr, "%s\n", spring_status_string(status)));
}

/* The head shakes for 1 s. It turns by this angle about the vertical axis. */
static double angle_at(double t)
{
    return t < 1 ? 0.8 * sin(4 * acos(-1) * t) * sin(acos(-1) * t) : 0;
}

/* Particle j of hair i, if it stands straight on a head that is turned by `angle`. The roots cover the upper half. */
static void place(int i, int j, double angle, double at[3])
{
    const double up = 1 - (i + 0.5) / HAIRS, out = sqrt(1 - up * up), turn = 2.399963 * i + angle;
    const double away = radius + (j - 1) * length / SEGMENTS;
    at[0] = away * out * cos(turn), at[1] = away * up, at[2] = away * out * sin(turn);
}

/* Particles 0 and 1 of each hair move with the head. */
static void shake(spring_scene *s, int i)
{
    const double now = angle_at(i * frame), next = angle_at((i + 1) * frame);
    const spring_collider head = {
        .shape = SPRING_SPHERE, .radius = radius, .spin = {0, (now - next) / frame, 0}, .friction = 0.3};
    must(spring_scene_set_colliders(s, &head, 1));
    for (int k = 0; k < HAIRS; k++)
        for (int j = 0; j < 2; j++) {
            double target[3];
            place(k, j, next, target);
            must(spring_scene_drive(s, (size_t)(ROW * k + j), target, frame));
        }
}

static void show(const spring_scene *s, double angle)
{
    double behind = 0, droop = 0, longest = 0;
    must(spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, N));
    for (int k = 0; k < HAIRS; k++) {
        const double(*hair)[3] = (const double(*)[3])x[ROW * k], *tip = hair[ROW - 1];
        double straight[3], arc = 0;
        place(k, ROW - 1, angle, straight);
        behind +=
            atan2(straight[2] * tip[0] - straight[0] * tip[2], straight[0] * tip[0] + straight[2] * tip[2]) / HAIRS;
        droop += (straight[1] - tip[1]) / HAIRS;
        for (int j = 1; j + 1 < ROW; j++)
            arc += hypot(hypot(hair[j + 1][0] - hair[j][0], hair[j + 1][1] - hair[j][1]), hair[j + 1][2] - hair[j][2]);
        longest = fmax(longest, arc);
    }
    printf("%.2f s  head turned by %+.2f  tips behind by %+.2f  and below by %.3f m  longest hair %.4f m  kinetic %.1e "
           "J\n",
           spring_scene_time(s), angle, behind, droop, longest, spring_scene_energy(s).kinetic);
}

int main(void)
{
    static spring_link link[N];
    static spring_weighted_link bend[N];
    static uint8_t pinned[N];
    size_t links = 0, bends = 0, bytes;
    for (int k = 0; k < HAIRS; k++) {
        const uint32_t first = (uint32_t)(ROW * k);
        for (int j = 0; j < ROW; j++) {
            place(k, j, 0, x[first + (uint32_t)j]);
            pinned[first + (uint32_t)j] = j < 2;
        }
        for (uint32_t j = first + 1; j + 1 < first + ROW; j++)
            link[links++] = (spring_link){j, j + 1, length / SEGMENTS, stiffness, damping, 0};
        size_t count = N - bends;
        must(spring_bend_rod(ROW, 3, x[first], &pinned[first], rigidity, damping_time, &bend[bends], &count));
        for (size_t end = bends + count; bends < end;
             bends++) /* from particles of the hair to particles of the scene */
            for (int i = 0; i < 3; i++)
                bend[bends].particle[i] += first;
    }
    spring_scene_def def = {.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, .particles = N, .position = x[0]};
    def.mass_all = mass, def.drag = drag, def.pinned = pinned, def.gravity[1] = -9.81;
    def.links = links, def.link = link, def.weighted_links = bends, def.weighted_link = bend;
    def.colliders = 1, def.particle_radius = 0.002;
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *s;
    must(spring_scene_init(memory, bytes, &def, &s)); /* NULL memory gives SPRING_EINVAL */
    for (int i = 0; i <= 240; i++) {
        if (i % 12 == 0)
            show(s, angle_at(i * frame));
        shake(s, i);
        must(spring_scene_advance(s, SPRING_LEAPFROG, frame / STEPS, STEPS));
    }
    free(memory);
    return 0;
}
