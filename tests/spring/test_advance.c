/* SPDX-License-Identifier: MIT */
/* spring_advance(): bit-identical to n kernel calls, every error path, and an unchanged state after an error. The table
   of methods. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "test_methods.h"

static const double bad_numbers[] = {NAN, INFINITY, -INFINITY};

static spring_params random_params(void)
{
    spring_params p = {.mass = random_log(1e-3, 1e3), .stiffness = random_log(1e-3, 1e3)};
    if (random_bits() % 2)
        p.damping = random_log(1e-4, 1) * sqrt(p.mass * p.stiffness);
    if (random_bits() % 2)
        p.load = p.stiffness * random_uniform(-1, 1);
    return p;
}

static void equals_kernel_calls(void)
{
    static const uint64_t counts[] = {1, 2, 7, 4095, 4096, 4097, 10000};
    for (size_t i = 0; i < 7 * 20; i++) {
        const uint64_t n = counts[i % 7];
        const spring_params p = random_params();
        const double dt = (i % 2 ? -0.001 : 0.01) * sqrt(p.mass / p.stiffness);
        const spring_state start = {random_uniform(-1, 1), random_uniform(-1, 1)};
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            spring_state all = start, ones = start, kernel = start;
            CHECK(spring_advance(&all, &p, *m, dt, n) == SPRING_OK, "good input");
            for (uint64_t j = 0; j < n; j++) {
                spring_advance(&ones, &p, *m, dt, 1);
                spring_method_kernel (*m)(&kernel, &p, dt);
            }
            CHECK_STATE(all, kernel, "n steps are n kernel calls");
            CHECK_STATE(all, ones, "n steps are n times one step");
        }
    }
}

static void exact_is_one_evaluation(void)
{
    for (int i = 0; i < 100; i++) {
        const spring_params p = random_params();
        const spring_state start = {random_uniform(-1, 1), random_uniform(-1, 1)};
        const uint64_t n = random_bits() % 1000000;
        spring_state all = start, one = start;
        CHECK(spring_advance(&all, &p, SPRING_EXACT, 1e-3, n) == SPRING_OK, "good input");
        if (n > 0)
            spring_step_exact(&one, &p, 1e-3 * (double)n);
        CHECK_STATE(all, one, "one evaluation over n dt");
    }
}

static void nothing_to_do(void)
{
    const spring_params p = {1.3, 2.7, 0.6, 0.4};
    const spring_state start = {-0.0, 5e-324};
    for (const spring_method *m = spring_methods(); *m != no_method; m++) {
        spring_state s = start;
        CHECK(spring_advance(&s, &p, *m, 0.1, 0) == SPRING_OK, "n = 0");
        CHECK(spring_advance(&s, &p, *m, 0.0, 5) == SPRING_OK, "dt = 0");
        CHECK(spring_advance(&s, &p, *m, -0.0, UINT64_MAX) == SPRING_OK, "dt = -0");
        CHECK_STATE(s, start, "changes nothing");
    }
}

static void refuse(spring_state start, spring_params p, spring_method m, double dt, uint64_t n, const char *why)
{
    spring_state s = start;
    CHECK(spring_advance(&s, &p, m, dt, n) == SPRING_EINVAL, why);
    CHECK(memcmp(&s, &start, sizeof s) == 0, "an error leaves the state as it was");
}

static void refuses_bad_input(void)
{
    const spring_params good = {1.3, 2.7, 0.6, 0.4};
    const spring_params bad_params[] = {
        {NAN, 2.7, 0.6, 0.4},      {INFINITY, 2.7, 0.6, 0.4},  {0, 2.7, 0.6, 0.4},        {-0.0, 2.7, 0.6, 0.4},
        {-1.3, 2.7, 0.6, 0.4},     {1.3, NAN, 0.6, 0.4},       {1.3, INFINITY, 0.6, 0.4}, {1.3, -2.7, 0.6, 0.4},
        {1.3, 2.7, NAN, 0.4},      {1.3, 2.7, INFINITY, 0.4},  {1.3, 2.7, -5e-324, 0.4},  {1.3, 2.7, 0.6, NAN},
        {1.3, 2.7, 0.6, INFINITY}, {1.3, 2.7, 0.6, -INFINITY}, {1e-200, 1e200, 0.6, 0.4}, {1e-200, 2.7, 1e200, 0.4},
        {1e-200, 2.7, 0.6, -1e200}};
    const spring_state start = {0.3, -0.7};
    for (const spring_method *m = spring_methods(); *m != no_method; m++) {
        spring_state s = start;
        CHECK(spring_advance(NULL, &good, *m, 0.1, 1) == SPRING_EINVAL, "no state");
        CHECK(spring_advance(&s, NULL, *m, 0.1, 1) == SPRING_EINVAL, "no parameters");
        CHECK_STATE(s, start, "an error leaves the state as it was");
        for (size_t i = 0; i < 3; i++) {
            const double bad = bad_numbers[i];
            refuse((spring_state){bad, 1}, good, *m, 0.1, 1, "x not finite");
            refuse((spring_state){1, bad}, good, *m, 0.1, 1, "v not finite");
            refuse(start, good, *m, bad, 1, "dt not finite");
            refuse(start, good, *m, bad, 0, "dt not finite, even for no steps");
        }
        for (size_t i = 0; i < sizeof bad_params / sizeof bad_params[0]; i++)
            refuse(start, bad_params[i], *m, 0.1, 1, "a bad parameter, or a quotient that overflows");
    }
    for (int m = -2; m < 100; m++)
        if (m < 0 || m >= SPRING_METHOD_COUNT)
            refuse(start, good, (spring_method)m, 0.1, 1, "no such method");
}

static void accepts_the_edges(void)
{
    spring_state s = {1, 2};
    const spring_params negative_zeros = {1.3, -0.0, -0.0, -0.0};
    CHECK(spring_advance(&s, &negative_zeros, SPRING_LEAPFROG, 0.5, 3) == SPRING_OK, "-0 is not negative");
    CHECK_CLOSE(s.x, 4, 8 * DBL_EPSILON, "a free particle");
    CHECK_BITS(s.v, 2, "a free particle keeps its velocity");
    s = (spring_state){5e-324, -5e-324};
    const spring_params p = {1e-300, 1e-300, 0, 0};
    CHECK(spring_advance(&s, &p, SPRING_RK4, 0.1, 100) == SPRING_OK, "denormal state, tiny mass");
    CHECK(spring_advance(&s, &p, SPRING_EXACT, 1e-3, UINT64_MAX) == SPRING_OK, "2^64 - 1 steps, evaluated once");
}

/* Overflow is reported, the state kept; 2^64 - 1 steps end soon because it is noticed. */
static void overflow(void)
{
    const spring_state start = {1, 0.5};
    const spring_params p = {1.3, 2.7, 0.1, 0.2};
    for (const spring_method *m = steppers(); *m != no_method; m++) {
        spring_state s = start;
        CHECK(spring_advance(&s, &p, *m, 10, UINT64_MAX) == SPRING_ENONFINITE, "far beyond the stable step");
        CHECK_STATE(s, start, "an overflow leaves the state as it was");
        s = start;
        CHECK(spring_advance(&s, &p, *m, 1.7e308, 1) == SPRING_ENONFINITE, "coefficients overflow");
        CHECK_STATE(s, start, "an overflow leaves the state as it was");
    }
    /* overflows in the last step of a call, and in the first after a look */
    const spring_params free_fall = {1.3, 0, 0, 0};
    for (uint64_t n = 4090; n < 4100; n++) {
        const spring_state fast = {0, 1.7e308 / (double)n * 1.0625};
        spring_state s = fast;
        CHECK(spring_advance(&s, &free_fall, SPRING_EULER, 1, n) == SPRING_ENONFINITE, "x passes the largest double");
        CHECK_STATE(s, fast, "an overflow leaves the state as it was");
        CHECK(spring_advance(&s, &free_fall, SPRING_EULER, 1, n * 9 / 10) == SPRING_OK, "just before");
    }
    spring_state s = start;
    const spring_params growing = {1.3, 2.7, 1.0, 0};
    CHECK(spring_advance(&s, &growing, SPRING_EXACT, -1e6, 1) == SPRING_ENONFINITE, "backwards damping overflows");
    CHECK(spring_advance(&s, &growing, SPRING_EXACT, 1e300, UINT64_MAX) == SPRING_ENONFINITE, "n dt overflows");
    CHECK_STATE(s, start, "an overflow leaves the state as it was");
}

/* Among denormal numbers stiffness/mass is rounded by much: every method moves the spring of the rounded quotient. */
static void denormal_quotients(void)
{
    const spring_params given = {3, 10 * DBL_TRUE_MIN, 0, 0}, rounded = {1, 3 * DBL_TRUE_MIN, 0, 0};
    for (const spring_method *m = spring_methods(); *m != no_method; m++) {
        spring_state a = {0.8, -3e-162}, b = a;
        spring_advance(&a, &given, *m, 1e161, 2); /* 0.4 rad */
        spring_advance(&b, &rounded, *m, 1e161, 2);
        CHECK_STATE(a, b, "the same quotient");
    }
}

/* Every value of the enumeration stands once in the table, under a name of its own. */
static void table_of_methods(void)
{
    bool seen[SPRING_METHOD_COUNT] = {false};
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        const spring_method_info *info = spring_method_describe(m);
        CHECK(m >= 0 && m < no_method && !seen[m] && info != NULL, "a method, for the first time");
        seen[m] = true;
        CHECK(info->springs || info->scenes, "a method is for something");
        CHECK(info->order >= 0 && (info->order > 0) == (info->forces_per_step > 0), "who steps evaluates forces");
        CHECK((spring_method_kernel(m) != NULL) == info->springs, "a kernel for one spring");
        CHECK(spring_method_name(m) == info->name && strlen(info->label) > 0, "names for programs and for texts");
        CHECK(strspn(info->name, "abcdefghijklmnopqrstuvwxyz0123456789-") == strlen(info->name) &&
                  strlen(info->name) > 0,
              "a word of the command line");
        for (int j = 0; j < i; j++)
            CHECK(strcmp(info->name, spring_method_name(spring_method_at(j))) != 0, "of no other method");
    }
    const spring_method none[] = {(spring_method)-1, no_method, spring_method_at(-1),
                                  spring_method_at(SPRING_METHOD_COUNT)};
    CHECK(none[2] == no_method && none[3] == no_method, "no place");
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
        CHECK(spring_method_describe(none[i]) == NULL && spring_method_name(none[i]) == NULL &&
                  spring_method_kernel(none[i]) == NULL,
              "no method");
}

static void names(void)
{
    static const struct {
        spring_method method;
        const char *name;
        spring_step_fn *kernel;
    } fixed[] = {
        {SPRING_EULER, "euler", spring_step_euler},
        {SPRING_LEAPFROG, "leapfrog", spring_step_leapfrog},
        {SPRING_RK4, "rk4", spring_step_rk4},
        {SPRING_EXACT, "exact", spring_step_exact},
    };
    for (size_t i = 0; i < sizeof fixed / sizeof fixed[0]; i++)
        CHECK(strcmp(spring_method_name(fixed[i].method), fixed[i].name) == 0 &&
                  spring_method_kernel(fixed[i].method) == fixed[i].kernel,
              "what other programs rely on");
    for (int i = SPRING_OK; i <= SPRING_EMISMATCH; i++)
        for (int j = SPRING_OK; j < i; j++)
            CHECK(strcmp(spring_status_string((spring_status)i), spring_status_string((spring_status)j)) != 0,
                  "each status has its own words");
    CHECK(strcmp(spring_status_string((spring_status)99), "unknown status") == 0, "never NULL");
    CHECK(strcmp(spring_version(), SPRING_VERSION) == 0, "header and library agree");
}

int main(void)
{
    static const test tests[] = {
        {"n steps are n kernel calls, bit for bit", equals_kernel_calls},
        {"the exact solution is one evaluation", exact_is_one_evaluation},
        {"no steps, no change", nothing_to_do},
        {"bad input is refused", refuses_bad_input},
        {"zeros, denormals and 2^64 - 1 steps", accepts_the_edges},
        {"overflow", overflow},
        {"denormal quotients", denormal_quotients},
        {"the table of methods", table_of_methods},
        {"names", names},
    };
    return RUN_TESTS("advance", tests);
}
