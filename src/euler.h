/* SPDX-License-Identifier: MIT */
/*
 * Explicit Euler for a damped, loaded spring.
 *
 * Method    x1 = x + h v;   v1 = v - ((h w) x - h a + (h g) v)
 * Order     1. Undamped error after time T: about (w h T/2) times the amplitude.
 * Limit     (1 + h r) over the roots r of the spring must lie in the unit circle: h < g/w for complex roots,
 *           h < 2/(fast root) for real ones. Undamped never: E grows by 1 + w h^2 a step, exactly.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section I.7
 */
#ifndef SPRINGSTEP_EULER_H
#define SPRINGSTEP_EULER_H

#include "real.h"

typedef struct euler_coefficients {
    real h, hw, hg, ha;
} euler_coefficients;

SPRING_INLINE euler_coefficients euler_prepare(spring_rates r, real h)
{
    return (euler_coefficients){.h = h, .hw = h * r.w, .hg = h * r.g + 0, .ha = h * r.a + 0};
}

SPRING_INLINE void euler_step(real *x, real *v, const euler_coefficients *c, bool damped, bool loaded)
{
    real pull = c->hw * *x;
    if (loaded)
        pull -= c->ha;
    if (damped)
        pull += c->hg * *v;
    *x += c->h * *v;
    *v -= pull;
}

#endif
