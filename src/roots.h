/* SPDX-License-Identifier: MIT */
/* The roots of r^2 + g r + w, the characteristic equation of a spring, free of cancellation. */
#ifndef SPRINGSTEP_ROOTS_H
#define SPRINGSTEP_ROOTS_H

#include <math.h>
#include <stdbool.h>

#include <springstep/spring.h>

/* -b +- i split, or -b +- split where overdamped. Every quotient and square root enters with its own rounding error
   added back, so that w - b^2 has full relative accuracy even where it is all but zero (critical damping). */
typedef struct spring_roots {
    double w;        /* [1/s^2] stiffness/mass, rounded once */
    double omega;    /* [1/s]   sqrt(stiffness/mass) */
    double b;        /* [1/s]   damping/(2 mass) */
    double split;    /* [1/s]   sqrt |omega^2 - b^2| */
    bool overdamped; /*         omega < b */
} spring_roots;

spring_roots spring_roots_of(const spring_params *p);

static inline double spring_fast_root(const spring_roots *r) /* [1/s], of an overdamped spring */
{
    return r->b + r->split;
}

static inline double spring_slow_root(const spring_roots *r) /* [1/s]; b - split would cancel */
{
    return r->w / (r->b + r->split);
}

/* sqrt(a^2 + b^2), a and b >= 0, without squares that overflow. (hypot() has other last bits in each C library.) */
static inline double spring_hypot(double a, double b)
{
    const double large = fmax(a, b), small = fmin(a, b);
    const double ratio = large > 0 && large < INFINITY ? small / large : 0;
    return large * sqrt(1 + ratio * ratio);
}

#endif
