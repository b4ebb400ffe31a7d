// SPDX-License-Identifier: MIT
// The same in C++.
#include <cinttypes>
#include <cstdio>

#include <springstep/clock.h>
#include <springstep/spring.h>

int main()
{
    const spring_params p{1.3, 2.7, 0.0, 0.0};
    spring_state s{1.0, 0.0};
    spring_clock clock{};
    const double dt = 1.0 / 256;
    const std::uint64_t n = spring_clock_tick(&clock, 1.0, dt, 1000, nullptr);
    if (spring_advance(&s, &p, SPRING_LEAPFROG, dt, n) != SPRING_OK)
        return 1;
    std::printf("%s %a\n", spring_version(), s.x);
    return 0;
}
