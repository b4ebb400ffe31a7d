/* SPDX-License-Identifier: MIT */
/* The remaining time that a tool shows on a terminal. */
#include <string.h>

#include "check.h"
#include "common/cli_parts.h"

static const struct {
    double fraction, spent; /* done; [s] since the start */
    const char *told;
} cases[] = {
    {0.5, 1, ""}, /* within a tick of the clock */
    {0.5, 2, ", 2 s left"},
    {0.25, 30, ", 90 s left"},
    {0.2, 24.85, ", 99 s left"},
    {0.2, 25, ", 2 min left"},
    {0.25, 60, ", 3 min left"},
    {0.01, 60, ", 99 min left"},
    {0.01, 100, ", 3 h left"},
    {0.001, 3600, ", 999 h left"},
    {0.001, 3700, ""},
    {0, 60, ""},
    {1, 60, ", 0 s left"},
};

static void time_left(void)
{
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[32];
        cli_describe_time_left(text, sizeof text, cases[i].fraction, cases[i].spent);
        CHECK(strcmp(text, cases[i].told) == 0, cases[i].told);
    }
}

static const test tests[] = {
    {"time left, in the unit that suits it", time_left},
};

int main(void)
{
    return RUN_TESTS("time_left", tests);
}
