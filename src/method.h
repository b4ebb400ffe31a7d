/* SPDX-License-Identifier: MIT */
/*
 * What a method is: its name, its stable step, and its forms, one for each shape of data.
 *
 * A method is a formula (euler.h, leapfrog.h, rk4.h, exact.h: an inline step on x and v, for one spring or a vector of
 * them), a file for one spring (euler.c, ...), and one row of methods[] in spring.c.
 */
#ifndef SPRINGSTEP_METHOD_H
#define SPRINGSTEP_METHOD_H

#include "real.h"

#include <springstep/spring.h>

bool spring_params_valid(const spring_params *p); /* by the rules of SPRING_EINVAL; NULL is not */

SPRING_INLINE spring_rates spring_rates_of(const spring_params *p)
{
    return (spring_rates){p->stiffness / p->mass + 0.0, p->damping / p->mass + 0.0, p->load / p->mass + 0.0};
}

/* The roots of r^2 + g r + w, free of cancellation: -b +- i split, or -b +- split where overdamped. Every quotient
   and root enters with its own rounding error added back, so that w - b^2 has full relative accuracy even where it is
   all but zero (critical damping). */
typedef struct spring_roots {
    double w;        /* [1/s^2] stiffness/mass, rounded once */
    double omega;    /* [1/s]   sqrt(stiffness/mass) */
    double b;        /* [1/s]   damping/(2 mass) */
    double split;    /* [1/s]   sqrt |omega^2 - b^2| */
    bool overdamped; /*         omega < b */
} spring_roots;

spring_roots spring_roots_of(const spring_params *p);

SPRING_INLINE double spring_fast_root(const spring_roots *r) /* [1/s], of an overdamped spring */
{
    return r->b + r->split;
}

SPRING_INLINE double spring_slow_root(const spring_roots *r) /* [1/s]; b - split would cancel */
{
    return r->w / (r->b + r->split);
}

/* The same with the rates at hand: r is what spring_rates_of() made of p. */
SPRING_INLINE bool spring_rates_valid(const spring_params *p, const spring_rates *r)
{
    return p->mass > 0 && isfinite(p->mass) && p->stiffness >= 0 && isfinite(r->w) && p->damping >= 0 &&
           isfinite(r->g) && isfinite(r->a);
}

spring_state spring_exact(spring_state s, const spring_params *p,
                          double t); /* spring_step_exact(), by value */

typedef struct spring_method_row {
    const char *name;
    spring_state (*steps)(spring_state s, const spring_rates *r, double dt,
                          uint64_t n);            /* n kernel calls in one;
                                                               NULL: closed form, n steps are one over n dt */
    double (*stable_step)(const spring_roots *r); /* [s] */
} spring_method_row;

extern const spring_method_row spring_method_euler, spring_method_leapfrog, spring_method_rk4,
    spring_method_exact;

#endif
