/* SPDX-License-Identifier: MIT */
/*
 * Leapfrog (kick, drift, kick) for a damped, loaded spring; the last half kick is solved for the velocity.
 *
 * Method    kick   v' = v - (K x - A + q v)          K = w h/2,  A = a h/2,  q = g h/2
 *           drift  x1 = x + h v'
 *           kick   v1 = (v' - (K x1 - A)) / (1 + q)
 *           Kick and drift are shears: they keep the phase-space area whatever the rounding of K, so the energy error
 *           of an undamped spring stays bounded over any number of steps.
 * Order     2. Undamped phase error after time T: w^(3/2) h^2 T/24; energy error at most z^2/4 of E,
 *           z^2 = w h^2, from a start at rest, and z^2/4/(1 - z^2/4) of E from any.
 * Limit     h sqrt(w) < 2 at every damping: the step has trace 2 (1 - w h^2/2)/(1 + q), determinant (1 - q)/(1 + q).
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 */
#ifndef SPRINGSTEP_LEAPFROG_H
#define SPRINGSTEP_LEAPFROG_H

#include "real.h"

typedef struct leapfrog_coefficients {
    real h, K, A, q;
    real keep, lose; /* 1/(1 + q) = keep + lose, see leapfrog_share_of() */
} leapfrog_coefficients;

/* u/(1 + q) as u - u q/(1 + q) while q <= 1: rounding 1 + q, or its reciprocal, would be an error of the same sign in
   every step, and the amplitude of a lightly damped spring would drift by n eps/2. Beyond, u times the reciprocal,
   since the difference would cancel. One formula for both: keep u + lose u, (keep, lose) = (1, -q/(1 + q)) or
   (1/(1 + q), 0). */
typedef struct leapfrog_share {
    real keep, lose;
} leapfrog_share;

SPRING_INLINE leapfrog_share leapfrog_share_of(real q)
{
    const truth light = magnitude(q) <= 1;
    return (leapfrog_share){
        select_real(light, splat(1), 1 / (1 + q)),
        select_real(light, 0 - q / (1 + q), splat(0)),
    };
}

SPRING_INLINE leapfrog_coefficients leapfrog_prepare(spring_rates r, real h)
{
    const real half = h / 2, q = half * r.g;
    const leapfrog_share share = leapfrog_share_of(q);
    return (leapfrog_coefficients){
        .h = h,
        .K = half * r.w,
        .A = half * r.a + 0,
        .q = q,
        .keep = share.keep,
        .lose = share.lose,
    };
}

SPRING_INLINE real leapfrog_force(real x, const leapfrog_coefficients *c, bool loaded) /* times -h/2m */
{
    return loaded ? c->K * x - c->A : c->K * x;
}

SPRING_INLINE real leapfrog_kick(real x, real v, const leapfrog_coefficients *c, bool damped, bool loaded)
{
    return v - (damped ? leapfrog_force(x, c, loaded) + c->q * v : leapfrog_force(x, c, loaded));
}

SPRING_INLINE real leapfrog_drift(real x, real v, const leapfrog_coefficients *c)
{
    return x + c->h * v;
}

SPRING_INLINE real leapfrog_solve(real x, real v, const leapfrog_coefficients *c, bool damped, bool loaded)
{
    const real u = v - leapfrog_force(x, c, loaded);
    return damped ? c->keep * u + c->lose * u : u;
}

SPRING_INLINE void leapfrog_step(real *x, real *v, const leapfrog_coefficients *c, bool damped, bool loaded)
{
    *v = leapfrog_kick(*x, *v, c, damped, loaded);
    *x = leapfrog_drift(*x, *v, c);
    *v = leapfrog_solve(*x, *v, c, damped, loaded);
}

#endif
