/* SPDX-License-Identifier: MIT */
/*
 * A feature with the value 0 is bit-identical to a loop without the feature. The methods are compiled into this test,
 * since spring_advance() always chooses the shortest loop.
 */
#include "methods/methods.h"

#include "check.h"

#define METHOD(value, info, row) &(row),
static const method_row *const methods[] = {METHODS(METHOD)};
static const spring_method steppers[] = {
#define STEPPER(value, prepare, start, step) value,
    STEP_METHODS(STEPPER)};
enum { stepper_count = sizeof steppers / sizeof steppers[0] };

/* Zeros of both signs, the smallest and the largest numbers, and some between: where signs and underflow could show. */
static const double corners[] = {0.0, -0.0, 5e-324, -5e-324, 1e-310, -1e-310, 2.3e-308, -2.3e-308,
                                 0.7, -0.7, 1.5,    -1.5,    1e150,  -1e150,  1e-160,   -1e-160};
static const size_t corner_count = sizeof corners / sizeof corners[0];

/* n steps by the loop for damped and loaded springs or by a shorter one, whatever gamma and accel are. */
static spring_state steps(spring_method m, spring_state s, spring_rates r, double dt, uint64_t n, bool damped,
                          bool loaded)
{
#define STEPS(value, prepare, start, step) \
    case value:                            \
        return SPRING_BY_FEATURES(damped, loaded, take_steps, s, &r, dt, n, prepare, start, step);
    switch ((int)m) {
        STEP_METHODS(STEPS)
    }
    return s;
}

static void zero_is_absent_from(spring_method m, spring_state s, double stiffness, double dt)
{
    const spring_rates r = {stiffness, 0, 0};
    for (uint64_t n = 1; n <= 2; n++) {
        const spring_state plain = steps(m, s, r, dt, n, false, false);
        CHECK_STATE(steps(m, s, r, dt, n, true, false), plain, "damping 0");
        CHECK_STATE(steps(m, s, r, dt, n, false, true), plain, "load 0");
        CHECK_STATE(steps(m, s, r, dt, n, true, true), plain, "damping 0 and load 0");
    }
    const spring_rates damped = {stiffness, 0.6, 0}, heavy = {stiffness, 900, 0}, loaded = {stiffness, 0, 0.4};
    CHECK_STATE(steps(m, s, damped, dt, 2, true, true), steps(m, s, damped, dt, 2, true, false), "damped, load 0");
    CHECK_STATE(steps(m, s, heavy, dt, 2, true, true), steps(m, s, heavy, dt, 2, true, false), "overdamped, load 0");
    CHECK_STATE(steps(m, s, loaded, dt, 2, true, true), steps(m, s, loaded, dt, 2, false, true), "loaded, damping 0");
}

static void zero_is_absent(void)
{
    static const double stiffness[] = {0, 1e-310, 0.3, 2.7, 1e12};
    static const double steps_taken[] = {0.01, -0.01, 0.7, -0.7, 1e-300, 1e-6};
    for (size_t m = 0; m < stepper_count; m++)
        for (size_t i = 0; i < corner_count * corner_count * 5 * 6; i++) {
            const spring_state s = {corners[i % corner_count], corners[i / corner_count % corner_count]};
            zero_is_absent_from(steppers[m], s, stiffness[i / corner_count / corner_count % 5],
                                steps_taken[i / corner_count / corner_count / 5]);
        }
}

/* -0.0 is a legal value of every parameter, and is 0. */
static void negative_zero_is_zero(void)
{
    for (size_t i = 0; i < corner_count * corner_count; i++) {
        const spring_params p = {1.3, -0.0, -0.0, -0.0}, q = {1.3, 0, 0, 0};
        const spring_state start = {corners[i % corner_count], corners[i / corner_count]};
        const spring_rates a = spring_rates_of(&p), b = spring_rates_of(&q);
        CHECK_BITS(a.omega2, 0.0, "one sign of zero");
        CHECK_BITS(a.gamma, 0.0, "one sign of zero");
        CHECK_BITS(a.accel, 0.0, "one sign of zero");
        for (size_t m = 0; m < stepper_count; m++)
            CHECK_STATE(steps(steppers[m], start, a, 0.1, 1, true, true),
                        steps(steppers[m], start, b, 0.1, 1, false, false), "-0 is 0");
    }
}

/* Every method for springs has what it needs, and is either the exact solution or has a formula. */
static void methods_are_complete(void)
{
    int for_springs = 0;
    for (size_t m = 0; m < SPRING_METHOD_COUNT; m++) {
        const method_row *method = methods[m];
        CHECK(method->info->springs == (method->kernel != NULL && method->stable_step != NULL), method->info->name);
        for_springs += method->info->springs && strcmp(method->info->name, "exact") != 0;
    }
    CHECK(for_springs == stepper_count, "each has a formula");
}

int main(void)
{
    static const test tests[] = {
        {"a zero feature is an absent one, bit for bit", zero_is_absent},
        {"negative zeros", negative_zero_is_zero},
        {"methods are complete", methods_are_complete},
    };
    return RUN_TESTS("shapes", tests);
}
