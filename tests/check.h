/* SPDX-License-Identifier: MIT */
/* Checks that print the compared values, random numbers from a printed seed, and a runner for CUnit tests with TAP. */
#ifndef CHECK_H
#define CHECK_H

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/spring.h>

/* True only for error <= bound, so NaN fails. On failure got, want, error, bound and the reason are printed. */
#define CHECK_CLOSE(got, want, bound, why) check_close((got), (want), (bound), (why), #got, __FILE__, __LINE__)
/* The error itself, where it was formed in higher precision. */
#define CHECK_BELOW(error, bound, why) check_close((error), 0, (bound), (why), #error, __FILE__, __LINE__)
/* The same bits: -0.0 is not 0.0. */
#define CHECK_BITS(got, want, why)  check_bits((got), (want), (why), #got, __FILE__, __LINE__)
#define CHECK_STATE(got, want, why) check_state((got), (want), (why), #got, __FILE__, __LINE__)
#define CHECK(condition, why)       check((condition), (why), #condition, __FILE__, __LINE__)

void check(bool ok, const char *why, const char *what, const char *file, unsigned line);
void check_close(double got, double want, double bound, const char *why, const char *what, const char *file,
                 unsigned line);
void check_bits(double got, double want, const char *why, const char *what, const char *file, unsigned line);
void check_state(spring_state got, spring_state want, const char *why, const char *what, const char *file,
                 unsigned line);

/* Say loudly that this test cannot be run here; it counts as skipped, unless a check fails. */
void skip(const char *why);

/* splitmix64 (Steele, Lea, Flood 2014), started anew for every test */
uint64_t random_bits(void);
double random_uniform(double low, double high);
double random_log(double low, double high); /* uniform in the logarithm */

/* The number of random cases to test: `usual`, divided by the environment variable SPRING_FEWER, for slow builds. */
size_t random_cases(size_t usual);

typedef struct test {
    const char *name;
    void (*run)(void);
} test;

/* Runs the tests, prints TAP, returns the exit status. */
int run_tests(const char *suite, const test *tests, size_t count);
#define RUN_TESTS(suite, tests) run_tests((suite), (tests), sizeof(tests) / sizeof(tests)[0])

#endif
