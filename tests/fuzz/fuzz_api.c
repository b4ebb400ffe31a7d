/* SPDX-License-Identifier: MIT */
/*
 * Arbitrary bytes as calls of the library, which must return and satisfy the documentation. With libFuzzer's driver or
 * with replay.c.
 *
 * The bytes are read as doubles, so the fuzzer reaches NaN, denormals and every sign; an input is at most sizeof(input)
 * bytes.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/batch.h>
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
    uint32_t count, features, shared, first_part; /* of a batch */
    double more[8];
} input;

static bool same(spring_state a, spring_state b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void check_advance(const input *in, spring_method m)
{
    const spring_method_info *info = spring_method_describe(m);
    const uint64_t most = 20000; /* several looks at the state, and still thousands of runs a second */
    const uint64_t n = in->n % most;
    spring_state s = in->s;
    const spring_status status = spring_advance(&s, &in->p, m, in->dt, n);
    if (status != SPRING_OK) {
        must(status == SPRING_EINVAL || status == SPRING_ENONFINITE ||
                 (status == SPRING_EUNSUPPORTED && info != NULL && !info->springs),
             "no other status is documented");
        must(same(s, in->s), "an error leaves the state as it was, to the bit");
        return;
    }
    must(info != NULL && info->springs, "a method for springs");
    must(isfinite(s.x) && isfinite(s.v), "the state is finite after SPRING_OK");
    if (n == 0 || in->dt == 0)
        must(same(s, in->s), "nothing to do changes nothing");
    else if (info->order > 0 && n <= 64) {
        spring_state kernel = in->s;
        for (uint64_t i = 0; i < n; i++)
            spring_method_kernel(m)(&kernel, &in->p, in->dt);
        must(same(s, kernel), "n steps are n kernel calls, to the bit");
    }
}

static void check_questions(const input *in, spring_method m)
{
    spring_state s = in->s;
    const bool good = spring_advance(&s, &in->p, SPRING_EXACT, 0, 0) == SPRING_OK; /* finite state, valid parameters */
    const double limit = spring_stable_step(&in->p, m), settling = spring_settling_time(&in->s, &in->p, in->x_tol);
    const spring_method_info *info = spring_method_describe(m);
    const bool known = good && info != NULL && info->springs;
    must(known ? limit >= 0 : isnan(limit) || !good, "a stable step is a time, 0 or infinite; NaN for no method");
    must(good || isnan(settling), "no settling time from bad input");
    must(!good || !(in->x_tol >= 0) || settling >= 0, "a settling time is a time, 0 or infinite");
    const double rest = spring_rest_time(&in->s, &in->p, in->x_tol, in->v_tol);
    must(good && in->x_tol >= 0 && in->v_tol >= 0 ? rest >= settling : isnan(rest), "both tolerances, or bad input");
    must(good || !spring_at_rest(&in->s, &in->p, in->x_tol, in->v_tol), "nothing is at rest from bad input");
    const double duration = in->x_tol, tolerance = in->v_tol;
    const double step = spring_accurate_step(&in->p, m, duration, tolerance);
    const double error = spring_step_error(&in->p, m, duration, in->dt);
    const bool can = spring_params_valid(&in->p) && info != NULL && info->springs && duration > 0 && isfinite(duration);
    must(can && tolerance > 0 && isfinite(tolerance) ? step >= 0 && step <= duration : isnan(step),
         "an accurate step is a part of the duration, or 0; NaN from bad input");
    must(can && in->dt > 0 && isfinite(in->dt) ? error >= 0 : isnan(error), "an error is 0, more, or infinite");
    const bool known_well = tolerance < 1 && step >= DBL_MIN && duration < 1e9 * step; /* else rounding shows */
    must(!known_well || spring_step_error(&in->p, m, duration, step) <= tolerance * (1 + 1e-6),
         "the accurate step is accurate");
    const spring_params made[] = {spring_params_hertz(in->s.x, in->s.v), spring_params_half_life(in->s.x, in->s.v)};
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
    must(steps <= in->max_steps, "no more steps than allowed");
    if (in->clock.pending >= 0 && isfinite(in->x_tol) && isfinite(in->clock.pending + fmax(in->x_tol, 0)) &&
        in->dt > 0 && isfinite(in->dt))
        must(clock.pending < in->dt && alpha >= 0 && alpha < 1, "less than a step waits");
    else
        must(steps == 0 && isnan(alpha) && memcmp(&clock, &in->clock, sizeof clock) == 0,
             "bad input leaves the clock as it was, and alpha is NaN");
}

enum { most_springs = 200, arrays = 5 };

/* Arrays of numbers from the input, of any bits, and others made of them. */
static void fill(double array[arrays][most_springs], const input *in)
{
    double numbers[sizeof *in / sizeof(double)];
    memcpy(numbers, in, sizeof numbers);
    const size_t given = sizeof numbers / sizeof numbers[0];
    for (size_t i = 0; i < arrays; i++)
        for (size_t j = 0; j < most_springs; j++)
            array[i][j] = numbers[(i * 3 + j) % given] + (j < given ? 0 : (double)(j % 7));
}

static void check_batch(const input *in, spring_method m)
{
    static double now[arrays][most_springs], start[arrays][most_springs];
    const size_t count = in->count % (most_springs + 1);
    const uint64_t n = 1 + in->n % 60;
    const bool damped = in->features & 1, loaded = in->features & 2;
    fill(start, in);
    memcpy(now, start, sizeof now);
    const spring_batch b = {count,          now[0], now[1], now[2], damped ? now[3] : NULL, loaded ? now[4] : NULL,
                            in->shared % 16};
    const spring_status status = spring_batch_advance(&b, m, in->dt, n);
    bool failed = false;
    for (size_t i = 0; i < count; i++) {
        const spring_params p = {1, start[2][b.shared & SPRING_SHARED_OMEGA2 ? 0 : i],
                                 damped ? start[3][b.shared & SPRING_SHARED_GAMMA ? 0 : i] : 0,
                                 loaded ? start[4][b.shared & SPRING_SHARED_ACCEL ? 0 : i] : 0};
        spring_state s = {start[0][i], start[1][i]};
        failed |= spring_advance(&s, &p, m, in->dt, n) != SPRING_OK;
        must(status == SPRING_EINVAL || status == SPRING_EUNSUPPORTED || same(s, (spring_state){now[0][i], now[1][i]}),
             "each spring is as if advanced alone, to the bit");
    }
    if (status == SPRING_EINVAL || status == SPRING_EUNSUPPORTED)
        must(memcmp(now, start, sizeof now) == 0, "a bad batch does not change");
    else
        must(in->dt == 0 || status == (failed ? SPRING_EPARTIAL : SPRING_OK), "a spring that fails is reported");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input in = {.p = {.mass = 1}};
    memcpy(&in, data, size < sizeof in ? size : sizeof in);
    const spring_method m = (spring_method)(in.method % (SPRING_METHOD_COUNT + 1)); /* negative ones as well */
    check_advance(&in, m);
    check_questions(&in, m);
    check_clock(&in);
    check_batch(&in, m);
    return 0;
}
