/* SPDX-License-Identifier: MIT */
/* A C program that uses the installed library: prints its version and where a spring is after a second, alone and in a
   batch. It calls ceil(), as the README's does: every road has to bring libm along. */
#include <math.h>
#include <stdio.h>

#include <springstep/batch.h>
#include <springstep/clock.h>
#include <springstep/spring.h>

int main(void)
{
    const spring_params p = {.mass = 1.3, .stiffness = 2.7};
    spring_state s = {.x = 1.0};
    spring_clock clock = {0};
    const double dt = 1.0 / ceil(1.0 / spring_accurate_step(&p, SPRING_LEAPFROG, 1.0, 1e-5));
    const uint64_t n = spring_clock_tick(&clock, 1.0, dt, 1000, NULL);
    if (spring_advance(&s, &p, SPRING_LEAPFROG, dt, n) != SPRING_OK)
        return 1;
    double x[] = {1.0, 0.5, 0.25}, v[] = {0.0, 0.0, 0.0};
    float xf[] = {1.0f}, vf[] = {0.0f};
    const double omega2 = 2.7 / 1.3;
    const float omega2f = 2.0f;
    const spring_batch b = {.count = 3, .x = x, .v = v, .omega2 = &omega2, .shared = SPRING_SHARED_OMEGA2};
    const spring_batchf bf = {.count = 1, .x = xf, .v = vf, .omega2 = &omega2f};
    if (spring_batch_advance(&b, SPRING_LEAPFROG, dt, n) != SPRING_OK || x[0] != s.x || x[1] != s.x / 2 ||
        spring_batchf_advance(&bf, SPRING_LEAPFROG, dt, n) != SPRING_OK)
        return 1;
    printf("%s %a %a\n", spring_version(), s.x, (double)xf[0]);
    return 0;
}
