/* SPDX-License-Identifier: MIT */
/*
 * One spring: parameters from frequency and damping ratio, an accurate step, and a second of motion compared with the
 * exact solution.
 *
 *     cc -std=c11 spring.c -lspringstep -lm -o spring
 */
#include <springstep/spring.h>
#include <math.h>
#include <stdio.h>

int main(void)
{
    const spring_params p = spring_params_hertz(2.0, 0.1); /* 2 Hz, a tenth of critical damping, 1 kg */
    const spring_state start = {1.0, 0.0};                 /* displaced by 1 m, at rest */
    const double frame_time = 1.0 / 60;                    /* [s] */

    /* The longest step with an error below 1 % after one second, shortened to a whole fraction of a frame. */
    const double longest = spring_accurate_step(&p, SPRING_LEAPFROG, 1.0, 0.01);
    if (!(longest > 0))
        return 1;
    const double steps = ceil(frame_time / longest), dt = frame_time / steps;
    printf("stable below %.4f s, accurate below %.4f s: %.0f steps a frame\n", spring_stable_step(&p, SPRING_LEAPFROG),
           longest, steps);

    spring_state s = start;
    for (int frame = 1; frame <= 60; frame++) {
        const spring_status status = spring_advance(&s, &p, SPRING_LEAPFROG, dt, (uint64_t)steps);
        if (status != SPRING_OK) {
            fprintf(stderr, "%s\n", spring_status_string(status));
            return 1;
        }
        if (frame % 6 != 0)
            continue;
        spring_state exact = start; /* one evaluation for any duration */
        spring_step_exact(&exact, &p, frame * frame_time);
        printf("%.1f s  x %+.4f m  exact %+.4f m  energy %.3f J\n", frame * frame_time, s.x, exact.x,
               spring_energy(&s, &p));
    }
    return 0;
}
