// SPDX-License-Identifier: MIT
// The same in C++.
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include <springstep/batch.h>
#include <springstep/clock.h>
#include <springstep/spring.h>

int main()
{
    const spring_params p{1.3, 2.7, 0.0, 0.0};
    spring_state s{1.0, 0.0};
    spring_clock clock{};
    const double dt = 1.0 / std::ceil(1.0 / spring_accurate_step(&p, SPRING_LEAPFROG, 1.0, 1e-5));
    const std::uint64_t n = spring_clock_tick(&clock, 1.0, dt, 1000, nullptr);
    if (spring_advance(&s, &p, SPRING_LEAPFROG, dt, n) != SPRING_OK)
        return 1;
    double x[] = {1.0, 0.5, 0.25}, v[] = {0.0, 0.0, 0.0};
    float xf[] = {1.0f}, vf[] = {0.0f};
    const double omega2 = 2.7 / 1.3;
    const float omega2f = 2.0f;
    const spring_batch b{3, x, v, &omega2, nullptr, nullptr, SPRING_SHARED_OMEGA2};
    const spring_batchf bf{1, xf, vf, &omega2f, nullptr, nullptr, 0};
    if (spring_batch_advance(&b, SPRING_LEAPFROG, dt, n) != SPRING_OK || x[0] != s.x || x[1] != s.x / 2 ||
        spring_batchf_advance(&bf, SPRING_LEAPFROG, dt, n) != SPRING_OK)
        return 1;
    std::printf("%s %a %a\n", spring_version(), s.x, static_cast<double>(xf[0]));
    return 0;
}
