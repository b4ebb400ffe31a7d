/* SPDX-License-Identifier: MIT */
/*
 * A camera follows a runner in three dimensions, with one spring per axis. Frame times may vary.
 *
 *     cc -std=c11 camera.c -lspringstep -lm -o camera
 *
 * Damping is critical, so the camera does not overshoot. If it follows only the position of the runner, it lags by
 * about damping/stiffness * u = 2 u / omega at speed u. With the mean velocity of each frame as well, it does not lag.
 */
#include <math.h>
#include <springstep/spring.h>
#include <stdbool.h>
#include <stdio.h>

/* The runner at time t [s]: up a slope at 6.5 m/s for three seconds, then at rest. */
static void runner(double t, double place[3])
{
    const double u[3] = {6, 1.5, 2}, start[3] = {10, 0, -4}; /* [m/s], [m] */
    for (int axis = 0; axis < 3; axis++)
        place[axis] = start[axis] + u[axis] * fmin(t, 3);
}

static int follow(bool with_velocity)
{
    const spring_params p = spring_params_hertz(1.0, 1.0);
    double place[3], last[3];
    runner(0, place);
    spring_state camera[3] = {{place[0], 0}, {place[1], 0}, {place[2], 0}};
    double t = 0;
    for (int frame = 1; t < 6 - 1e-9; frame++) {
        const double frame_time = frame % 5 == 0 ? 1.0 / 30 : 1.0 / 60;
        runner(t, last);
        runner(t += frame_time, place);
        double behind = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double target_velocity = with_velocity ? (place[axis] - last[axis]) / frame_time : 0;
            if (spring_follow(&camera[axis], &p, place[axis], target_velocity, frame_time) != SPRING_OK)
                return 1;
            behind = hypot(behind, camera[axis].x - place[axis]);
        }
        if (frame % 25 == 0)
            printf("%.2f s  camera %6.3f %6.3f %6.3f  behind %.3f m\n", t, camera[0].x, camera[1].x, camera[2].x,
                   behind);
    }
    return 0;
}

int main(void)
{
    printf("behind him by about 2 u / omega = %.3f m\n", 2 * 6.5 / (2 * acos(-1)));
    if (follow(false) != 0)
        return 1;
    printf("with his velocity\n");
    return follow(true);
}
