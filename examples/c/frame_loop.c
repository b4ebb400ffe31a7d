/* SPDX-License-Identifier: MIT */
/*
 * A rope hangs from a moving hand, in frames of any duration, with the loop of docs/games.md. The program prints how far
 * the free end moves relative to a hand of constant velocity, its error with a hand that swings, how far a long frame
 * stretches the rope, and how many frames fail if the hand jumps.
 *
 *     cc -std=c11 frame_loop.c -lspringstep -lm -o frame_loop
 */
#include <springstep/clock.h>
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 20 };
static const double pi = 3.14159265358979324;
static const double spacing = 0.1, stiffness = 2000, damping = 0.5, mass = 0.05, gravity = 9.81;

/* Moves the whole scene by a fraction of the way from its pinned particle to the hand. */
static void move_along(spring_scene *s, const double hand[3], double fraction)
{
    double move[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, pin[3]; /* rows of [A b]: x = A x + b, v = A v */
    spring_scene_get(s, SPRING_POSITION, pin, 0, 0, 1);
    for (int i = 0; i < 3; i++)
        move[4 * i + 3] = fraction * (hand[i] - pin[i]);
    spring_scene_transform(s, move);
}

static spring_status advance_frame(spring_scene *s, spring_clock *clock, double frame_time, const double hand[3])
{
    const double dt = 1.0 / 960;                                           /* [s] */
    const uint64_t n = spring_clock_tick(clock, frame_time, dt, 64, NULL); /* at most 64 steps in a frame */
    if (n == 0)
        return SPRING_OK;
    /* `time`: from the end of the last frame's steps to the render time, without skipped time */
    const double steps = (double)n * dt, time = steps + clock->pending; /* [s] */
    if (clock->skipped > 0)
        move_along(s, hand, clock->skipped / (clock->skipped + time));
    spring_scene_drive(s, 0, hand, time);
    const spring_status status = spring_scene_advance(s, SPRING_LEAPFROG, dt, n);
    if (status != SPRING_OK) /* no step was taken: the time of these steps is skipped as well */
        move_along(s, hand, steps / time);
    return status;
}

/* Positions at the render time, which is `pending` after the simulation time. v is a work array. */
static void positions_now(const spring_scene *s, size_t particles, double pending, float (*x)[3], float (*v)[3])
{
    spring_scene_getf(s, SPRING_POSITION, x[0], 3, 0, particles);
    spring_scene_getf(s, SPRING_VELOCITY, v[0], 3, 0, particles);
    for (size_t i = 0; i < particles; i++)
        for (int axis = 0; axis < 3; axis++)
            x[i][axis] += (float)pending * v[i][axis];
}

typedef struct motion {
    double speed, swing, jump; /* of the hand, along x: [m/s], [m] amplitude at 1 Hz, [m] in the middle of the run */
    double rate, noise, hitch; /* frames per second; [s] largest noise of their times, and a pause in the middle */
} motion;

typedef struct result {
    double moved, stretch, end; /* [m] motion of the end relative to the hand; relative; [m] the end at last, along x */
    int failed;                 /* frames that failed */
} result;

/* Runs for two seconds and the pause. The rope hangs at rest relative to the hand, and is measured as it is drawn. */
static result run(const motion m)
{
    spring_link link[N];
    double x0[N][3] = {{0}}, v0[N][3] = {{m.speed}}, t = 0;
    const uint8_t pinned[N] = {1};
    for (uint32_t i = 1; i < N; i++) {
        link[i - 1] = (spring_link){i - 1, i, spacing, stiffness, damping, 0};
        x0[i][1] = x0[i - 1][1] - spacing - mass * gravity * (N - i) / stiffness;
        v0[i][0] = m.speed;
    }
    spring_scene_def def = {.flags = SPRING_SCENE_TENSION_ONLY, .particles = N, .links = N - 1, .position = x0[0]};
    def.velocity = v0[0], def.mass_all = mass, def.pinned = pinned, def.link = link, def.max_speed = 100;
    def.gravity[1] = -gravity;
    size_t bytes = 0;
    spring_scene *rope;
    spring_scene_bytes(&def, &bytes);
    void *memory = malloc(bytes);
    if (spring_scene_init(memory, bytes, &def, &rope) != SPRING_OK)
        exit(1);
    spring_clock clock = {0};
    result r = {0};
    uint32_t random = 1;
    for (int frame = 1, half = (int)m.rate; frame <= 2 * half; frame++) {
        float x[N][3], v[N][3];
        random = 1664525 * random + 1013904223; /* Numerical Recipes */
        const double noise = m.noise * (random / 2147483648.0 - 1), frame_time = 1 / m.rate + noise;
        t += frame_time + (frame == half ? m.hitch : 0);
        const double hand[3] = {m.speed * t + m.swing * (1 - cos(2 * pi * t)) + (frame < half ? 0 : m.jump)};
        r.failed += advance_frame(rope, &clock, frame_time + (frame == half ? m.hitch : 0), hand) != SPRING_OK;
        positions_now(rope, N, clock.pending, x, v);
        r.moved = fmax(r.moved, hypot(x[N - 1][0] - hand[0], x[N - 1][1] - x0[N - 1][1]));
        for (int i = 1; i < N; i++)
            r.stretch = fmax(r.stretch, hypot(x[i][0] - x[i - 1][0], x[i][1] - x[i - 1][1]) / spacing - 1);
        r.end = x[N - 1][0];
    }
    free(memory);
    return r;
}

int main(void)
{
    const double exact = run((motion){.swing = 0.05, .rate = 960}).end; /* one step in each frame */
    for (const double *fps = (double[]){60, 75, 120, 144, 165, 240, 1000, 4000, 0}; *fps > 0; fps++)
        printf("%4.0f fps  even %.4f mm  noise %.4f mm  swing %.3f mm\n", *fps,
               1e3 * run((motion){.speed = 10, .rate = *fps}).moved,
               1e3 * run((motion){.speed = 10, .rate = *fps, .noise = fmin(5e-4, 1 / *fps)}).moved,
               1e3 * fabs(run((motion){.swing = 0.05, .rate = *fps}).end - exact));
    for (const double *hitch = (double[]){0, 0.25, 5, 60, -1}; *hitch >= 0; hitch++) {
        const result r = run((motion){.speed = 5, .rate = 60, .hitch = *hitch});
        printf("pause of %.2f s  stretch %.2f %%  failed %d\n", *hitch, 100 * r.stretch, r.failed);
    }
    printf("jump of 5 m  failed %d\n", run((motion){.jump = 5, .rate = 60}).failed);
    return 0;
}
