/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a call of the library: it must come back, and keep its promises. With libFuzzer's driver or with replay.c.
 *
 * The bytes are read as doubles, so the fuzzer reaches NaN, denormals and every sign; an input is at most sizeof(input) bytes.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/clock.h>
#include <springstep/spring.h>

#include "fuzz.h"

typedef struct input {
    spring_state s;
    spring_params p;
    double dt, x_tol, v_tol;
    uint64_t n;
    uint32_t max_steps;
    int32_t method;
    spring_clock clock;
} input;

static void must(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "fuzz_api: %s\n", what);
    abort();
}

static bool same(spring_state a, spring_state b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void check_advance(const input *in, spring_method m)
{
    static void (*const kernels[])(spring_state *, const spring_params *,
                                   double) = {spring_step_euler, spring_step_leapfrog, spring_step_rk4};
    const uint64_t most = 20000; /* several looks at the state, and still thousands of runs a second */
    const uint64_t n = in->n % most;
    spring_state s = in->s;
    const spring_status status = spring_advance(&s, &in->p, m, in->dt, n);
    if (status != SPRING_OK) {
        must(status == SPRING_EINVAL || status == SPRING_ENONFINITE, "no other status is documented");
        must(same(s, in->s), "an error leaves the state as it was, to the bit");
        return;
    }
    must(isfinite(s.x) && isfinite(s.v), "the state is finite after SPRING_OK");
    if (n == 0 || in->dt == 0)
        must(same(s, in->s), "nothing to do changes nothing");
    else if (m != SPRING_EXACT && n <= 64) {
        spring_state kernel = in->s;
        for (uint64_t i = 0; i < n; i++)
            kernels[m](&kernel, &in->p, in->dt);
        must(same(s, kernel), "n steps are n kernel calls, to the bit");
    }
}

static void check_questions(const input *in, spring_method m)
{
    spring_state s = in->s;
    const bool good =
        spring_advance(&s, &in->p, SPRING_EXACT, 0, 0) == SPRING_OK; /* finite state, valid parameters */
    const double limit = spring_stable_step(&in->p, m), rest = spring_rest_time(&in->s, &in->p, in->x_tol);
    const bool known = good && spring_method_name(m) != NULL;
    must(known ? limit >= 0 : isnan(limit) || !good,
         "a stable step is a time, 0 or infinite; NaN for no method");
    must(good || isnan(rest), "no rest time from bad input");
    must(!good || !(in->x_tol >= 0) || rest >= 0, "a rest time is a time, 0 or infinite");
    must(good || !spring_at_rest(&in->s, &in->p, in->x_tol, in->v_tol), "nothing is at rest from bad input");
    const spring_params made[] = {spring_params_hertz(in->s.x, in->s.v),
                                  spring_params_half_life(in->s.x, in->s.v)};
    for (int i = 0; i < 2; i++) {
        const bool refused = isnan(made[i].mass);
        s = (spring_state){0, 0};
        must(spring_advance(&s, &made[i], SPRING_LEAPFROG, 0, 0) == (refused ? SPRING_EINVAL : SPRING_OK),
             "parameters are valid or all NaN");
    }
}

static void check_clock(const input *in)
{
    spring_clock clock = in->clock;
    double alpha = NAN;
    const uint64_t steps = spring_clock_tick(&clock, in->x_tol, in->dt, in->max_steps, &alpha);
    must(alpha >= 0 && alpha < 1, "alpha is a fraction of a step");
    must(steps <= in->max_steps, "no more steps than allowed");
    if (in->clock.pending >= 0 && in->x_tol >= 0 && isfinite(in->clock.pending + in->x_tol) && in->dt > 0 &&
        isfinite(in->dt))
        must(clock.pending < in->dt, "less than a step waits");
    else
        must(steps == 0 && memcmp(&clock, &in->clock, sizeof clock) == 0,
             "bad input leaves the clock as it was");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input in = {.p = {.mass = 1}};
    memcpy(&in, data, size < sizeof in ? size : sizeof in);
    const spring_method m = (spring_method)(in.method % 5); /* one beyond the last; negative ones as well */
    check_advance(&in, m);
    check_questions(&in, m);
    check_clock(&in);
    return 0;
}
