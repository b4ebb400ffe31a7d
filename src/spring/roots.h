/* SPDX-License-Identifier: MIT */
/* The roots of the characteristic equation of a spring, r^2 + gamma r + omega^2 = 0, without cancellation. */
#ifndef SPRINGSTEP_ROOTS_H
#define SPRINGSTEP_ROOTS_H

#include "../simd/arithmetic.h"

#include <math.h>
#include <stdbool.h>

#include <springstep/spring.h>

/* The roots are -b +- i split, or -b +- split if overdamped. The rounding errors of all quotients and squares are added
   back, so that omega^2 - b^2 has full relative accuracy even near critical damping. */
typedef struct spring_roots {
    double omega2;   /* [1/s^2] stiffness/mass, rounded once */
    double omega;    /* [1/s]   sqrt(stiffness/mass) */
    double b;        /* [1/s]   damping/(2 mass) */
    double split;    /* [1/s]   sqrt |omega^2 - b^2| */
    bool overdamped; /*         omega < b */
} spring_roots;

/* omega2 and b rounded; the exact omega^2 - b^2 is omega2 - b^2 + rest */
typedef struct spring_quotients {
    double omega2, b, rest;
} spring_quotients;

/* k, c, m: stiffness, damping, mass. By value: clang 14 would load two of them at once, which waits for two stores. */
SPRING_INTERNAL spring_quotients spring_quotients_of(double k, double c, double m);

SPRING_INTERNAL spring_roots spring_roots_of(const spring_params *p);

static inline double spring_fast_root(const spring_roots *r) /* [1/s], of an overdamped spring */
{
    return r->b + r->split;
}

/* sqrt(a^2 + b^2), a and b >= 0, without squares that overflow. (hypot() has other last bits in each C library.) */
static inline double spring_hypot(double a, double b)
{
    const double large = fmax(a, b), lesser = fmin(a, b);
    const double ratio = large > 0 && large < (double)INFINITY ? lesser / large : 0;
    return large * spring_sqrt(1 + ratio * ratio);
}

#endif
