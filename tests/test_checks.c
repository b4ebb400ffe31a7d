/* SPDX-License-Identifier: MIT */
/*
 * Tests of the checks: each must fail when it should, with a message. This program does not rely on the checks. It
 * prints its own TAP, and runs itself once per scenario to capture the output of a test program.
 */
#define _POSIX_C_SOURCE 200809L /* popen() */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

typedef struct scenario {
    const char *name;
    void (*run)(void);
    bool holds;
    double got, want, bound;
} scenario;

static const scenario *current;
static const char reason[] = "because";

static void conditions(void)
{
    CHECK(current->got > 0, reason);
}

static void closeness(void)
{
    CHECK_CLOSE(current->got, current->want, current->bound, reason);
}

static void smallness(void)
{
    CHECK_BELOW(current->got, current->bound, reason);
}

static void bits(void)
{
    CHECK_BITS(current->got, current->want, reason);
}

static void state_x(void)
{
    CHECK_STATE(((spring_state){current->got, 1}), ((spring_state){current->want, 1}), reason);
}

static void state_v(void)
{
    CHECK_STATE(((spring_state){1, current->got}), ((spring_state){1, current->want}), reason);
}

static void failure_before_success(void)
{
    CHECK(false, reason);
    CHECK(true, "this one holds");
}

static void failure_and_skip(void)
{
    skip("this must not hide it");
    CHECK(false, reason);
}

static void failures_without_end(void)
{
    for (;;)
        CHECK(false, reason);
}

static void good_start(void)
{
    CHECK(random_bits() != random_bits(), reason);
}

static uint64_t first_number;

static void remember_first_number(void)
{
    first_number = random_bits();
}

static void first_number_again(void)
{
    CHECK(random_bits() == first_number, reason);
}

static const scenario scenarios[] = {
    {"true", conditions, true, .got = 1},
    {"false", conditions, false, .got = 0},
    {"at the bound", closeness, true, 1.5, 1, 0.5},
    {"a hair beyond the bound", closeness, false, 1.5, 1, 0.5 - DBL_EPSILON},
    {"beyond the bound", closeness, false, 1.5, 1, 0.49},
    {"beyond the bound, below", closeness, false, 1, 1.5, 0.49},
    {"equal, bound 0", closeness, true, 0.3, 0.3, 0},
    {"an ulp off, bound 0", closeness, false, 1, 1 + DBL_EPSILON, 0},
    {"negative bound", closeness, false, 1, 1, -1},
    {"got NaN", closeness, false, NAN, 1, INFINITY},
    {"want NaN", closeness, false, 1, NAN, INFINITY},
    {"bound NaN", closeness, false, 1, 1, NAN},
    {"equal infinities", closeness, true, INFINITY, INFINITY, 0},
    {"opposite infinities", closeness, false, INFINITY, -INFINITY, 1e300},
    {"infinite for finite", closeness, false, INFINITY, 1, 1e300},
    {"error at the bound", smallness, true, .got = 0.5, .bound = 0.5},
    {"error beyond the bound", smallness, false, .got = 0.5, .bound = 0.49},
    {"error beyond the bound, negative", smallness, false, .got = -0.5, .bound = 0.49},
    {"error NaN", smallness, false, .got = NAN, .bound = INFINITY},
    {"same bits", bits, true, 0.3, 0.3, 0},
    {"signs of zero", bits, false, 0.0, -0.0, 0},
    {"last bit", bits, false, 1, 1 + DBL_EPSILON, 0},
    {"the same NaN", bits, true, NAN, NAN, 0},
    {"same state", state_x, true, -0.0, -0.0, 0},
    {"signs of zero in x", state_x, false, 0.0, -0.0, 0},
    {"signs of zero in v", state_v, false, 0.0, -0.0, 0},
    {"last bit of x", state_x, false, 1, 1 + DBL_EPSILON, 0},
    {"last bit of v", state_v, false, 1, 1 + DBL_EPSILON, 0},
    {"a failure before a success", failure_before_success, false, 0, 0, 0},
    {"failures without end", failures_without_end, false, 0, 0, 0},
    {"a failure in a skipped test", failure_and_skip, false, 0, 0, 0},
};
static const size_t scenario_count = sizeof scenarios / sizeof scenarios[0];

/* The child: one scenario between two tests that hold, the last of which sees the random numbers of the first again. */
static int play(size_t index)
{
    current = &scenarios[index];
    const test tests[] = {
        {"first", remember_first_number},
        {current->name, current->run},
        {"random numbers differ", good_start},
        {"and start anew", first_number_again},
    };
    return RUN_TESTS("scenario", tests);
}

/* -------------------------------------------------------------------------------------------------- the parent */

static unsigned points, failures;

static void point(bool ok, const char *name)
{
    failures += !ok;
    printf("%s %u - %s\n", ok ? "ok" : "not ok", ++points, name);
}

static bool has_line(const char *text, const char *start, const char *rest)
{
    char line[200];
    snprintf(line, sizeof line, "\n%s%s\n", start, rest);
    return strstr(text, line) != NULL;
}

/* Does the child print what it should, status 0? "\n" stands before the first line. */
static bool as_expected(const char *program, const scenario *s)
{
    char command[4096], text[8192] = "\n";
    snprintf(command, sizeof command, "'%s' %td", program, s - scenarios);
    FILE *child = popen(command, "r");
    if (child == NULL)
        return false;
    text[1 + fread(text + 1, 1, sizeof text - 2, child)] = '\0';
    const bool skipped = s->run == failure_and_skip;
    char name[100];
    snprintf(name, sizeof name, "%s%s", s->name, skipped ? " # SKIP this must not hide it" : "");
    return pclose(child) == 0 && has_line(text, "1..4", "") && has_line(text, "ok 1 - ", "first") &&
           has_line(text, s->holds ? "ok 2 - " : "not ok 2 - ", name) &&
           has_line(text, "ok 3 - ", "random numbers differ") && has_line(text, "ok 4 - ", "and start anew") &&
           (strstr(text, "(because)") == NULL) == s->holds;
}

static bool published_numbers(void)
{
    return random_bits() == 0xe220a8397b1dcdaf && random_bits() == 0x6e789e6aa1b965f4 &&
           random_bits() == 0x06c45d188009454f; /* splitmix64 from 0, the reference implementation's */
}

int main(int argc, char **argv)
{
    if (argc > 1)
        return play(strtoul(argv[1], NULL, 10));
    printf("1..%zu\n", scenario_count + 1);
    point(published_numbers(), "the published numbers of splitmix64");
    for (size_t i = 0; i < scenario_count; i++)
        point(as_expected(argv[0], &scenarios[i]), scenarios[i].name);
    return failures > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
