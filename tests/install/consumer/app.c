/* SPDX-License-Identifier: MIT */
/* A C program that uses the installed library: prints its version and where a spring is after a second. */
#include <stdio.h>

#include <springstep/clock.h>
#include <springstep/spring.h>

int main(void)
{
    const spring_params p = {.mass = 1.3, .stiffness = 2.7};
    spring_state s = {.x = 1.0};
    spring_clock clock = {0};
    const double dt = 1.0 / 256;
    const uint64_t n = spring_clock_tick(&clock, 1.0, dt, 1000, NULL);
    if (spring_advance(&s, &p, SPRING_LEAPFROG, dt, n) != SPRING_OK)
        return 1;
    printf("%s %a\n", spring_version(), s.x);
    return 0;
}
