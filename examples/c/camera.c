/* SPDX-License-Identifier: MIT */
/*
 * A camera that follows a runner in three dimensions: a batch of three springs, one for each axis, that share stiffness and
 * damping. The exact solution moves them, so a frame may be of any length.
 *
 *     cc -std=c11 camera.c -lspringstep -lm -o camera
 *
 * Critical damping: it never swings over. Behind a runner at speed u it stays by damping/stiffness * u = 2 u / omega;
 * a load of damping * speed, beside stiffness * goal, takes that away.
 */
#include <springstep/batch.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

/* The runner at time t [s]: along a slope at 6.5 m/s for three seconds; then he stands. */
static void runner(double t, double place[3], double speed[3])
{
    const double u[3] = {6, 1.5, 2}, start[3] = {10, 0, -4}; /* [m/s], [m] */
    for (int axis = 0; axis < 3; axis++) {
        place[axis] = start[axis] + u[axis] * fmin(t, 3);
        speed[axis] = t < 3 ? u[axis] : 0;
    }
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static int follow(bool ahead)
{
    const spring_params p = spring_params_hertz(1.0, 1.0); /* mass 1: stiffness is omega^2, damping gamma */
    double x[3], v[3] = {0}, accel[3], place[3], speed[3];
    const spring_batch camera = {.count = 3,
                                 .x = x,
                                 .v = v,
                                 .omega2 = &p.stiffness,
                                 .gamma = &p.damping,
                                 .accel = accel,
                                 .shared = SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA};
    runner(0, x, speed); /* the camera starts at the runner */
    double t = 0;
    for (int frame = 1; t < 6; frame++) {
        const double frame_time = frame % 5 == 0 ? 1.0 / 30 : 1.0 / 60;
        runner(t + frame_time / 2, place, speed); /* a load that changes: in the middle of the step, for second order */
        for (int axis = 0; axis < 3; axis++)
            accel[axis] = p.stiffness * place[axis] + (ahead ? p.damping * speed[axis] : 0);
        if (spring_batch_advance(&camera, SPRING_EXACT, frame_time, 1) != SPRING_OK)
            return 1;
        t += frame_time;
        runner(t, place, speed);
        if (frame % 25 == 0)
            printf("%.2f s  camera %6.3f %6.3f %6.3f  behind %.3f m\n", t, x[0], x[1], x[2], distance(x, place));
    }
    return 0;
}

int main(void)
{
    printf("behind him by 2 u / omega = %.3f m\n", 2 * 6.5 / (2 * acos(-1)));
    if (follow(false) != 0)
        return 1;
    printf("with a load for his speed, too\n");
    return follow(true);
}
