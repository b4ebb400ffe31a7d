/* SPDX-License-Identifier: MIT */
/* TAP output for CUnit (whose JUnit writer aborts when a test fails, CUnit 2.1-3), and the checks. */
#include <CUnit/CUnit.h>
#include <CUnit/TestRun.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static uint64_t seed = 20240917;         /* or the environment variable SPRING_SEED */
static const unsigned most_failures = 5; /* of a test; the next one ends it */

static uint64_t generator;
static unsigned failures, number;
static const char *skipped; /* why */
static double closest;      /* largest error/bound in this test: how near to failing it came */

static bool report(bool ok, const char *what, const char *file, unsigned line)
{
    const CU_BOOL last = failures == most_failures ? CU_TRUE : CU_FALSE;
    CU_assertImplementation(ok ? CU_TRUE : CU_FALSE, line, what, file, "", last);
    failures += !ok;
    return !ok;
}

void check(bool ok, const char *why, const char *what, const char *file, unsigned line)
{
    if (report(ok, what, file, line))
        printf("# %s:%u: not true: %s (%s)\n", file, line, what, why);
}

void check_close(double got, double want, double bound, const char *why, const char *what, const char *file,
                 unsigned line)
{
    const double error = got == want ? 0 : fabs(got - want); /* equal infinities are close */
    if (bound > 0)
        closest = fmax(closest, error / bound);
    if (report(error <= bound, what, file, line))
        printf("# %s:%u: %s\n#   got %.17g, want %.17g, error %.3g, bound %.3g (%s)\n", file, line, what, got, want,
               error, bound, why);
}

void skip(const char *why)
{
    skipped = why;
}

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

void check_bits(double got, double want, const char *why, const char *what, const char *file, unsigned line)
{
    if (report(bits_of(got) == bits_of(want), what, file, line))
        printf("# %s:%u: %s\n#   got %a, want %a (%s)\n", file, line, what, got, want, why);
}

void check_state(spring_state got, spring_state want, const char *why, const char *what, const char *file,
                 unsigned line)
{
    const bool same = bits_of(got.x) == bits_of(want.x) && bits_of(got.v) == bits_of(want.v);
    if (report(same, what, file, line))
        printf("# %s:%u: %s\n#   got (%a, %a), want (%a, %a) (%s)\n", file, line, what, got.x, got.v, want.x, want.v,
               why);
}

uint64_t random_bits(void)
{
    uint64_t z = generator += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

double random_uniform(double low, double high)
{
    return low + (high - low) * (double)(random_bits() >> 11) * 0x1p-53;
}

double random_log(double low, double high)
{
    return exp(random_uniform(log(low), log(high)));
}

static void on_start(const CU_pTest case_started, const CU_pSuite suite)
{
    (void)case_started;
    (void)suite;
    generator = seed;
    failures = 0;
    closest = 0;
    skipped = NULL;
}

static void on_complete(const CU_pTest case_done, const CU_pSuite suite, const CU_pFailureRecord failure)
{
    (void)suite;
    printf("%s %u - %s", failure == NULL ? "ok" : "not ok", ++number, case_done->pName);
    printf(skipped != NULL ? " # SKIP %s\n" : "\n", skipped);
    if (closest > 0)
        printf("# largest error %.3g of its bound\n", closest);
}

size_t random_cases(size_t usual)
{
    const char *const fewer = getenv("SPRING_FEWER");
    const size_t divisor = fewer != NULL ? strtoull(fewer, NULL, 10) : 0;
    return divisor > 0 ? usual / divisor : usual;
}

int run_tests(const char *suite, const test *tests, size_t count)
{
    const char *const chosen = getenv("SPRING_SEED");
    if (chosen != NULL)
        seed = strtoull(chosen, NULL, 10);
    if (CU_initialize_registry() != CUE_SUCCESS)
        return EXIT_FAILURE;
    const CU_pSuite cunit_suite = CU_add_suite(suite, NULL, NULL);
    const char *const only = getenv("SPRING_CASE"); /* runs one test alone */
    for (size_t i = 0; cunit_suite != NULL && i < count; i++)
        if ((only == NULL || strcmp(only, tests[i].name) == 0) &&
            CU_add_test(cunit_suite, tests[i].name, tests[i].run) == NULL)
            return EXIT_FAILURE;
    CU_set_test_start_handler(on_start);
    CU_set_test_complete_handler(on_complete);
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* a crash or an interruption loses no line */
    printf("1..%u\n# random numbers from seed %llu\n", CU_get_registry()->uiNumberOfTests, (unsigned long long)seed);
    const CU_ErrorCode status = CU_run_all_tests();
    CU_cleanup_registry();
    return status == CUE_SUCCESS ? EXIT_SUCCESS : EXIT_FAILURE; /* failures are in the TAP */
}
