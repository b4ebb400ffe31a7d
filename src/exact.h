/* SPDX-License-Identifier: MIT */
/*
 * The closed form as a step: what exact.c computes once from a spring and a time, and how it moves any state.
 *
 * Method    x1 = e ((e F) x + (e H) v) + P a,   v1 = e ((e G) v - (e w H) x) + e (e H) a,   e the square root of the decay
 */
#ifndef SPRINGSTEP_EXACT_H
#define SPRINGSTEP_EXACT_H

#include "real.h"

#include <springstep/spring.h>

typedef struct spring_propagator {
    double half;           /* e^(-bt/2), or of the root that lasts */
    double F, G, H, wH, P; /* times half; H [s], wH [1/s]; P [s^2] is complete */
} spring_propagator;

spring_propagator spring_propagator_of(const spring_params *p, double t,
                                       bool loaded); /* without loaded, P = 0 */

typedef struct exact_coefficients {
    real half, F, G, H, wH, P;
} exact_coefficients;

SPRING_INLINE exact_coefficients exact_prepare(const spring_propagator *y)
{
    return (exact_coefficients){
        splat((scalar)y->half), splat((scalar)y->F),  splat((scalar)y->G),
        splat((scalar)y->H),    splat((scalar)y->wH), splat((scalar)y->P),
    };
}

SPRING_INLINE void exact_step(real *x, real *v, real a, const exact_coefficients *c, bool loaded)
{
    const real x0 = *x, v0 = *v;
    *x = c->half * (c->F * x0 + c->H * v0);
    *v = c->half * (c->G * v0 - c->wH * x0);
    if (loaded) {
        *x = select_real(a != 0, *x + c->P * a, *x); /* P may be infinite */
        *v = select_real(a != 0, *v + c->half * (c->H * a), *v);
    }
}

#endif
