/* SPDX-License-Identifier: MIT */
/*
 * The least number of steps from which the error never exceeds E.
 *
 * In exact arithmetic, n steps of any method with z = H/n rotate the initial state (see reference_turn):
 *
 *     x_n = A (cos(H + d) + a sin(H + d)),   A = exp(n log_growth), d = n ahead, a = x_to_x
 *
 * Hence |x_n - cos H| <= |A - 1| + |d| + A |a|. For z <= 1, all three terms decrease as n grows: log_growth/z, ahead/z
 * and a are power series in z that are dominated by their first term. (The program also checks that the bound
 * decreases.) The n at which the bound is E is found by bisection; the error is below E for all larger n.
 * For smaller n, x_n itself is evaluated. Since A, d and a are monotone, x_n at one end of a range of n differs from
 * all others in the range by no more than
 *
 *     |difference of A| (1 + |a|) + A (1 + |a|) |difference of d| + A |difference of a|        (the largest A and |a|)
 *
 * and |x_n| <= A sqrt(1 + a^2). A whole range is skipped at once if these bounds decide it.
 * Rounding adds at most 2 eps (1 + z^2)^2 <= 8 eps per step (harness/reference.h), which the bound includes. It grows
 * with n and eventually exceeds any E, so "never" means: before that.
 */
#include "equal_error.h"

#include <float.h>
#include <math.h>

#include "common/cli.h"
#include "harness/reference.h"

static const spring_params spring = {.mass = 1, .stiffness = 1};

typedef struct iterate_end { /* the result of n steps */
    double A, d, a;
    double error; /* |x_n - cos H| */
} iterate_end;

static iterate_end end_of(spring_method m, double duration, uint64_t n)
{
    reference_turn t;
    if (!reference_turn_of(&t, m, 1, duration / (double)n))
        return (iterate_end){INFINITY, INFINITY, INFINITY, INFINITY};
    const double N = (double)n, A = exp(N * t.log_growth), d = N * t.ahead, a = t.x_to_x;
    const double half = d / 2; /* cos(H + d) - cos H, without cancellation */
    const double turned = -2 * sin(duration + half) * sin(half);
    const double error = fabs(A * (turned + a * sin(duration + d)) + expm1(N * t.log_growth) * cos(duration));
    return (iterate_end){A, d, a, error};
}

static double rounding_bound(uint64_t n)
{
    return 8 * DBL_EPSILON * (double)n;
}

static double error_bound(spring_method m, double duration, uint64_t n)
{
    const iterate_end e = end_of(m, duration, n);
    return fabs(e.A - 1) + fabs(e.d) + e.A * fabs(e.a) + rounding_bound(n);
}

static _Noreturn void fail_for_rounding(spring_method m, double error)
{
    cli_fail(
        CLI_FAILED,
        "%s cannot be shown to stay within %.17g m, because the bound of its rounding error, 8 eps n, is of that size",
        spring_method_name(m), error);
}

/* For steps above 1 s, which may not be rotations, each n is evaluated from the n-th power of the step. */
static const uint64_t most_tried = 100000;

static double error_of_long_steps(spring_method m, double duration, uint64_t n)
{
    long double x = 1, v = 0;
    reference_mode(m, 1, duration / (double)n, n, &x, &v);
    return fabs((double)x - cos(duration));
}

/* The least number of steps of at most 1 s. */
static uint64_t fewest(double duration)
{
    return (uint64_t)fmin(fmax(ceil(duration), 1), 0x1p62); /* longer durations are rejected */
}

static uint64_t settled_from(spring_method m, double duration, double error)
{
    const double largest = 1e9; /* [s]; the phase at the end is then known to 1e-7 */
    if (error < 100 * DBL_EPSILON * duration || duration > largest)
        fail_for_rounding(m, error);
    uint64_t low = fewest(duration) - 1, high = low + 1;
    double bound, before = INFINITY;
    while (!((bound = error_bound(m, duration, high)) <= error)) {
        if (rounding_bound(high) > error || !(bound <= before))
            fail_for_rounding(m, error);
        before = bound;
        low = high;
        high *= 2;
    }
    while (high - low > 1) {
        const uint64_t middle = low + (high - low) / 2;
        if (error_bound(m, duration, middle) <= error)
            high = middle;
        else
            low = middle;
    }
    return high;
}

/* A bound on the difference of x_n from its value at one end of a range, from both ends. */
static double spread(const iterate_end *p, const iterate_end *q)
{
    const double A = fmax(p->A, q->A), a = fmax(fabs(p->a), fabs(q->a));
    return fabs(p->A - q->A) * (1 + a) + A * (1 + a) * fabs(p->d - q->d) + A * fabs(p->a - q->a);
}

uint64_t equal_error_steps(spring_method m, double duration, double error)
{
    const uint64_t least = fewest(duration);
    uint64_t n = settled_from(m, duration, error), some = 1;
    iterate_end last = end_of(m, duration, n);
    while (n > least) {
        some = some < n - least ? some : n - least;
        const iterate_end first = end_of(m, duration, n - some);
        const double largest = fmax(first.A, last.A) * hypot(1, fmax(fabs(first.a), fabs(last.a)));
        const bool within =
            some == 1 ? first.error <= error
                      : first.error + spread(&first, &last) <= error || largest + fabs(cos(duration)) <= error;
        if (!within && some == 1)
            break;
        if (!within) {
            some /= 2;
            continue;
        }
        n -= some;
        last = first;
        some *= 2;
    }
    while (n <= least && least <= most_tried && n > 1 && error_of_long_steps(m, duration, n - 1) <= error)
        n--;
    return n;
}

uint64_t equal_error_first_steps(spring_method m, double duration, double error)
{
    const uint64_t least = fewest(duration);
    if (least > most_tried)
        return 0;
    for (uint64_t n = 1; n < least; n++)
        if (error_of_long_steps(m, duration, n) <= error)
            return n;
    uint64_t n = least, some = 1;
    iterate_end first = end_of(m, duration, n);
    while (!(first.error <= error)) {
        const iterate_end last = end_of(m, duration, n + some);
        const bool beyond = some == 1 || first.error - spread(&first, &last) > error;
        if (!beyond) {
            some /= 2;
            continue;
        }
        n += some;
        first = last;
        some *= 2;
    }
    return n;
}

double error_coefficient(spring_method m, double duration)
{
    const int order = spring_method_describe(m)->order;
    const int bits =
        order * 60 <= 240 ? 60 : 240 / order; /* after n^-order, a hundred bits of the references are left */
    reference r;
    mpfr_t error;
    reference_init(&r);
    mpfr_init2(error, mpfr_get_prec(r.x));
    reference_start(&r, &spring, (spring_state){1, 0});
    reference_iterate(&r, &spring, m, ldexp(duration, -bits), UINT64_C(1) << bits);
    mpfr_set_d(error, duration, MPFR_RNDN);
    mpfr_cos(error, error, MPFR_RNDN);
    mpfr_sub(error, r.x, error, MPFR_RNDN);
    mpfr_mul_2si(error, error, (long)order * bits, MPFR_RNDN);
    const double coefficient = fabs(mpfr_get_d(error, MPFR_RNDN));
    mpfr_clear(error);
    reference_clear(&r);
    return coefficient;
}
