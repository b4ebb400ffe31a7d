/* SPDX-License-Identifier: MIT */
/*
 * The bits of many springs after many steps, in hexadecimal: the same from every compiler, flag and processor.
 *
 * Only what the library computes with + - * / sqrt and fma is here; the closed form is as reproducible as the C
 * library's exp, sin and cos. The expected output is bits.txt; it changes only with a "Results" line in CHANGELOG.md.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include <springstep/clock.h>
#include <springstep/spring.h>

static void print(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    printf(" %016" PRIx64, bits);
}

int main(void)
{
    static const struct {
        const char *name;
        spring_params p;
        double dt;
    } cases[] = {
        {"plain", {1.3, 2.7, 0, 0}, 0.01},        {"damped", {1.3, 2.7, 0.06, 0}, 0.013},
        {"loaded", {0.7, 2.7, 0, 0.9}, 0.017},    {"both", {1.9, 3.1, 0.05, -0.7}, 0.011},
        {"backwards", {1.3, 2.7, 0, 0.9}, -0.01}, {"undone", {1.3, 2.7, 0.06, 0.2}, -0.003},
        {"critical", {1.0, 4.0, 4.0, 0.3}, 0.01}, {"overdamped", {1.7, 0.3, 5.1, 0}, 0.1},
        {"heavy", {7e20, 2e19, 1e17, 3e18}, 0.3}, {"light", {3e-22, 7e-21, 1e-23, 2e-22}, 0.02},
        {"free", {1.3, 0, 0, 0.9}, 0.01},         {"dragged", {1.3, 0, 0.6, 0.9}, 0.01},
    };
    static const spring_method methods[] = {SPRING_EULER, SPRING_LEAPFROG, SPRING_RK4};

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (size_t j = 0; j < sizeof methods / sizeof methods[0]; j++) {
            spring_state s = {0.83, -0.59};
            const spring_status status = spring_advance(&s, &cases[i].p, methods[j], cases[i].dt, 1000);
            printf("%s %s %s", cases[i].name, spring_method_name(methods[j]), spring_status_string(status));
            print(s.x);
            print(s.v);
            print(spring_energy(&s, &cases[i].p));
            print(spring_stable_step(&cases[i].p, methods[j]));
            printf("\n");
        }

    spring_clock clock = {0};
    double alpha = 0;
    uint64_t steps = 0;
    for (int frame = 1; frame <= 1000; frame++)
        steps += spring_clock_tick(&clock, 0.37 / (frame % 29 + 1), 1.0 / 240, 7, &alpha);
    printf("clock %" PRIu64, steps);
    print(alpha);
    print(clock.pending);
    print(clock.dropped);
    printf("\n");
    return 0;
}
