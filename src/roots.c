/* SPDX-License-Identifier: MIT */
/*
 * The characteristic roots of a spring, r^2 + (c/m) r + k/m = 0, without cancellation.
 *
 * Method    omega^2 - b^2 = (omega - b)(omega + b). Near critical damping omega - b is all rounding error, so each of
 *           k/m, its square root and c/2m carries its own error along: n/d = q + fma(-q, d, n)/d to twice the
 *           precision. These fma() are calls for an exact remainder, in software where there is no such instruction; a
 *           product and a sum that merely stand side by side are never fused.
 * Accuracy  omega, b, and split: 2 eps, relative, at every damping ratio
 * Source    Higham, Accuracy and Stability of Numerical Algorithms (2002), section 1.8 (the quadratic equation);
 *           Ogita, Rump, Oishi, Accurate sum and dot product, SIAM J. Sci. Comput. 26 (2005) (error-free products)
 */
#include "roots.h"

#include "simd/real.h"

/* n/d - q, the rounding error of the quotient q. A denormal q is off by much more than eps of it, and is the spring
   that the steppers move: there it counts as exact. */
static double rest_of(double n, double d, double q)
{
    return q >= DBL_MIN ? fma(-q, d, n) / d : 0;
}

spring_roots spring_roots_of(const spring_params *p)
{
    /* + 0.0 as in spring_rates_of(): a stiffness or damping of -0.0 would give roots, and times, of -infinity */
    const double w = p->stiffness / p->mass + 0.0, w_rest = rest_of(p->stiffness, p->mass, w);
    const double g = p->damping / p->mass + 0.0, g_rest = rest_of(p->damping, p->mass, g);
    const double omega = sqrt(w), omega_rest = omega > 0 ? (fma(-omega, omega, w) + w_rest) / (2 * omega) : 0;
    const double b = g / 2;
    const double sum = omega + b, difference = (omega - b) + (omega_rest - g_rest / 2);
    return (spring_roots){
        .w = w,
        .omega = omega,
        .b = b,
        .split = sum > 0 ? sqrt(fabs(difference) / sum) * sum : 0, /* the product of both might overflow */
        .overdamped = difference < 0,
    };
}
