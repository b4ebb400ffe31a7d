/* SPDX-License-Identifier: MIT */
/*
 * The characteristic roots of a spring, r^2 + (c/m) r + k/m = 0, without cancellation.
 *
 * Method    Near critical damping, the computed w - b^2 consists of rounding errors only. So the exact rounding error
 *           of the square is added, and also the rounding errors of the quotients w = k/m and g = c/m:
 *           n/d = q + (n - q d)/d to twice the precision.
 * Accuracy  omega, b, and split: 2 eps, relative, at every damping ratio
 * Source    Higham, Accuracy and Stability of Numerical Algorithms (2002), section 1.8 (the quadratic equation);
 *           Ogita, Rump, Oishi, Accurate sum and dot product, SIAM J. Sci. Comput. 26 (2005) (error-free products)
 */
#include "roots.h"
#include "split_tmpl.h"

/* n - q d, where q is n/d rounded; exact */
static double remainder_of(double n, double d, double q)
{
    const double product = q * d;
    return (n - product) - product_error(q, d, product);
}

/* n/d - q, the rounding error of the quotient q, for numbers of any size. The error of a denormal q is much more than
   eps q, but the steppers use q itself. So this error, at most half of the smallest number, is rounded to 0. */
static double rest_of(double n, double d, double q)
{
    int by_n, by_d, by_q;
    n = frexp(n, &by_n);
    d = frexp(d, &by_d);
    q = frexp(q, &by_q);
    return ldexp(remainder_of(ldexp(n, by_n - by_d - by_q), d, q) / d, by_q);
}

/* Such numbers, their products, and the rounding errors of these products neither overflow nor underflow. */
static bool moderate(double a)
{
    return a > 0x1p-400 && a < 0x1p400;
}

spring_quotients spring_quotients_of(double k, double c, double m)
{
    /* + 0.0 as in spring_rates_of(): a stiffness or damping of -0.0 would give roots, and times, of -infinity */
    const double w = k / m + 0.0, g = c / m + 0.0, b = g / 2;
    const double rest = moderate(m) && moderate(w) && (moderate(g) || g == 0)
                            ? (remainder_of(k, m, w) - b * remainder_of(c, m, g)) * (1 / m)
                            : rest_of(k, m, w) - b * rest_of(c, m, g);
    /* The rest overflows only where b^2 is far larger than w. */
    return (spring_quotients){w, b, spring_finite(rest) ? rest : 0};
}

spring_roots spring_roots_of(const spring_params *p)
{
    const spring_quotients q = spring_quotients_of(p->stiffness, p->damping, p->mass);
    const spring_split y = spring_split_of(q.omega2, q.b, q.rest);
    return (spring_roots){
        .omega2 = q.omega2,
        .omega = spring_sqrt(q.omega2),
        .b = q.b,
        .split = y.split,
        .overdamped = y.overdamped,
    };
}
