/* SPDX-License-Identifier: MIT */
/*
 * How fast can a cloth be dragged? The middle of its lower edge is moved to and fro for a second and released. After
 * that, any gain of energy is an error of the step. docs/dragging.md explains the table.
 *
 *     cc -std=c11 -O2 fast_hand.c -lspringstep -lm -o fast_hand
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 17, N = SIDE * SIDE, GRABBED = N - 1 - SIDE / 2, LINKS = 4 * N, FRAMES = 60 };
static const double frame_time = 1.0 / FRAMES;                    /* [s] */
static const double spacing = 0.05, stiffness = 200, mass = 0.01; /* [m], [N/m], [kg] */
static const double stroke = 0.4; /* [m] motion of the hand, sideways and up, within reach of the cloth */

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

typedef struct outcome {
    double stretch; /* largest ratio of length to rest length during the drag */
    double gain;    /* largest gain of energy in the next two seconds, relative to the elastic and kinetic energy */
} outcome;

static double total(spring_scene_energies e)
{
    return e.kinetic + e.elastic + e.gravity;
}

static double longest(const spring_scene *cloth, const spring_link *link, size_t links)
{
    static double x[N][3];
    double most = 0;
    must(spring_scene_get(cloth, SPRING_POSITION, x[0], 0, 0, N));
    for (size_t i = 0; i < links; i++) {
        const double *a = x[link[i].a], *b = x[link[i].b];
        const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        most = fmax(most, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / link[i].rest);
    }
    return most;
}

/* speed [m/s] of the hand; step relative to the stable step; damping of links [N s/m] */
static outcome drag(double speed, double step, double damping)
{
    static double position[3 * N];
    static uint8_t pinned[N];
    static spring_link link[LINKS];
    const spring_grid sheet = {.count = {SIDE, SIDE},
                               .spacing = spacing,
                               .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                               .stiffness = stiffness,
                               .damping = damping,
                               .pinned = SPRING_GRID_FIRST_Y};
    size_t particles, links, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, position, pinned, link));
    const spring_scene_def def = {.flags = SPRING_SCENE_EDITABLE,
                                  .particles = particles,
                                  .links = links,
                                  .position = position,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, 9.81, 0}}; /* the sheet hangs along +y */
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *cloth;
    if (memory == NULL)
        exit(1);
    must(spring_scene_init(memory, bytes, &def, &cloth));
    const double n = ceil(frame_time / (step * spring_scene_stable_step(cloth, SPRING_LEAPFROG)));
    const double dt = frame_time / n;

    const uint8_t yes = 1, no = 0;
    double home[3];
    must(spring_scene_get(cloth, SPRING_POSITION, home, 0, GRABBED, 1));
    must(spring_scene_set_pinned(cloth, GRABBED, 1, &yes));
    outcome result = {0};
    for (int i = 1; i <= FRAMES; i++) {
        const double way = fmod(speed * i * frame_time, 2 * stroke), out = way < stroke ? way : 2 * stroke - way;
        const double hand[3] = {home[0], home[1] - 0.6 * out, 0.8 * out};
        must(spring_scene_drive(cloth, GRABBED, hand, frame_time));
        must(spring_scene_advance(cloth, SPRING_LEAPFROG, dt, (uint64_t)n));
        result.stretch = fmax(result.stretch, longest(cloth, link, links));
    }
    must(spring_scene_set_pinned(cloth, GRABBED, 1, &no));
    const spring_scene_energies start = spring_scene_energy(cloth);
    double most = total(start);
    for (int i = 0; i < 2 * FRAMES; i++) {
        must(spring_scene_advance(cloth, SPRING_LEAPFROG, dt, (uint64_t)n));
        most = fmax(most, total(spring_scene_energy(cloth)));
    }
    result.gain = (most - total(start)) / (start.kinetic + start.elastic);
    free(memory);
    return result;
}

int main(void)
{
    const double wave = spacing * sqrt(stiffness / mass); /* [m/s] wave speed, the fastest that the cloth can follow */
    const double damping = 0.02;                          /* [N s/m] */
    printf("| hand/wave | hand [m/s] | stretch | gain, step 1 | 1/2 | 1/4 | 1/8 | damped: stretch | gain, step 1 |\n");
    printf("|---|---|---|---|---|---|---|---|---|\n");
    for (double ratio = 0.125; ratio <= 2; ratio *= 2) {
        const double speed = ratio * wave;
        printf("| %g | %.1f | %.1f |", ratio, speed, drag(speed, 0.125, 0).stretch);
        for (double step = 1; step >= 0.125; step /= 2)
            printf(" %.0f %% |", 100 * drag(speed, step, 0).gain);
        printf(" %.1f | %.0f %% |\n", drag(speed, 0.125, damping).stretch, 100 * drag(speed, 1, damping).gain);
    }
    return 0;
}
