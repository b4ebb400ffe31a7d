/* SPDX-License-Identifier: MIT */
/*
 * The smallest n from which on the error never exceeds E.
 *
 * In exact arithmetic n steps of z = H/n give x_n = rho^n cos(n phi), with growth rho and phase phi a step. Hence
 *
 *     |x_n - cos H| <= |rho^n - 1| + |n phi - H|,
 *
 * and both terms fall as n grows, at least while z <= 1: log(rho)/z and (phi - z)/z are monotone in z there.
 *
 *     Euler     rho^2 = 1 + z^2                 phi = atan z             (log(1 + z^2)/z rises up to z = 1.98)
 *     leapfrog  rho = 1                         phi = 2 asin(z/2)
 *     RK4       rho^2 = 1 - z^6/72 + z^8/576    tan phi = (z - z^3/6)/(1 - z^2/2 + z^4/24)
 *               (z^5/72 - z^7/576 rises up to z = 2.39; 1 - dphi/dz = z^4 (1 - z^2/2 + z^4/24)/(24 rho^2) up to 1.27)
 *
 * So where this bound comes down to E, found by bisection, everything above is settled; below, x_n itself is looked at
 * for one n after the other until its error exceeds E.
 * Rounding adds at most 2 eps (1 + z^2)^2 <= 8 eps a step (src/leapfrog.c, and the same for the others), which the
 * bound includes; it grows with n and would in the end exceed any E, so "never" is meant up to that.
 */
#include "equal_error.h"

#include <float.h>
#include <math.h>

#include "common/cli.h"

typedef struct iterate {
    double log_growth, phase; /* after all n steps: n log(rho), n phi */
} iterate;

static iterate iterate_after(spring_method m, double duration, uint64_t n)
{
    const double z = duration / (double)n, z2 = z * z;
    double log_rho2 = 0, phi = 0; /* of one step */
    switch (m) {
    case SPRING_EULER:
        log_rho2 = log1p(z2);
        phi = atan(z);
        break;
    case SPRING_LEAPFROG:
        phi = 2 * asin(z / 2); /* NaN where unstable */
        break;
    default:
        log_rho2 = log1p(z2 * z2 * z2 * (z2 / 576 - 1.0 / 72));
        phi = atan2(z - z * z2 / 6, 1 - z2 / 2 + z2 * z2 / 24);
        break;
    }
    return (iterate){(double)n * log_rho2 / 2, (double)n * phi};
}

static double rounding_bound(uint64_t n)
{
    return 8 * DBL_EPSILON * (double)n;
}

static double error_bound(spring_method m, double duration, uint64_t n)
{
    const iterate u = iterate_after(m, duration, n);
    return fabs(expm1(u.log_growth)) + fabs(u.phase - duration) + rounding_bound(n);
}

static double iterate_error(spring_method m, double duration, uint64_t n)
{
    const iterate u = iterate_after(m, duration, n);
    return fabs(exp(u.log_growth) * cos(u.phase) - cos(duration));
}

static _Noreturn void fail_for_rounding(spring_method m, double error)
{
    cli_fail(CLI_FAILED, "%s cannot be shown to stay within %.17g m: rounding is of that size",
             spring_method_name(m), error);
}

static uint64_t settled_from(spring_method m, double duration, double error)
{
    const double largest = 1e9; /* [s]; the phase at the end is then known to 1e-7 */
    if (error < 100 * DBL_EPSILON * duration || duration > largest)
        fail_for_rounding(m, error);
    uint64_t low = (uint64_t)duration, high = low + 1; /* z <= 1 from high on */
    while (!(error_bound(m, duration, high) <= error)) {
        if (rounding_bound(high) > error)
            fail_for_rounding(m, error);
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

uint64_t equal_error_steps(spring_method m, double duration, double error)
{
    uint64_t n = settled_from(m, duration, error);
    while (n > 1 && iterate_error(m, duration, n - 1) <= error)
        n--;
    return n;
}

uint64_t equal_error_first_steps(spring_method m, double duration, double error)
{
    uint64_t n = 1;
    while (!(iterate_error(m, duration, n) <= error))
        n++;
    return n;
}
