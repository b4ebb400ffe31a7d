/* SPDX-License-Identifier: MIT */
/*
 * The classical Runge-Kutta method of order 4 for a damped, loaded spring, in split form.
 *
 * Method    y' = M y + b with M = (0 1; -w -g), b = (0, a). The four stages collapse to
 *
 *               y1 = y + h (M y + b) + h Q (M y + b),   Q = Z/2 + Z^2/6 + Z^3/24,   Z = h M
 *
 *           Euler's step plus a correction, whose entries follow from two polynomials in W = w h^2, G = g h:
 *
 *               Q (0, 1) = (h E, F):   E = 1/2 - G/6 + (G^2 - W)/24
 *                                      F = -G/2 + (G^2 - W)/6 + G (2 W - G^2)/24
 *               x1 = x + (h v           + (-W E x   + h F v         + h^2 E a))
 *               v1 = v + (h (a - w x - g v) + (-w h F x - (W E + G F) v + h F a))
 *
 *           Kept apart, the two parts round better than their sum: the correction's error is small because it is
 *           small, and h v is rounded once. (Summed coefficients carry one rounding error into every step.)
 * Order     4. Undamped phase error after time T: w^(5/2) h^4 T/120; energy is lost at (w h^2)^3/72 a step.
 * Limit     |R(h r)| = 1 over the roots r of the spring, R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24: h omega = 2 sqrt 2
 *           without damping, h = 2.785.../(fast root) for real roots, Newton's method on |R|^2 = 1 in between.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1
 */
#ifndef SPRINGSTEP_RK4_H
#define SPRINGSTEP_RK4_H

#include "real.h"

typedef struct rk4_coefficients {
    real h, hw, hg, ha;  /* Euler's part */
    real xx, xv, vx, vv; /* the correction to x and v, from x and v */
    real x_load, v_load; /* minus the correction from the load: subtracting a zero changes no bit */
} rk4_coefficients;

SPRING_INLINE rk4_coefficients rk4_prepare(spring_rates r, real h)
{
    const real hw = h * r.w, W = h * hw, G = h * r.g;
    const real E = (12 - 4 * G + (G * G - W)) * (scalar)(1.0 / 24);
    const real F = (4 * (G * G - W) - 12 * G + G * (2 * W - G * G)) * (scalar)(1.0 / 24);
    return (rk4_coefficients){
        .h = h,
        .hw = hw,
        .hg = G + 0,
        .ha = h * r.a + 0,
        .xx = -W * E,
        .xv = h * F,
        .vx = -hw * F,
        .vv = -W * E - G * F,
        .x_load = 0 - h * E * (h * r.a),
        .v_load = 0 - F * (h * r.a),
    };
}

SPRING_INLINE void rk4_step(real *x, real *v, const rk4_coefficients *c, bool damped, bool loaded)
{
    real pull = c->hw * *x;
    real dx = c->xx * *x + c->xv * *v;
    real dv = c->vx * *x + c->vv * *v;
    if (loaded) {
        pull -= c->ha;
        dx -= c->x_load;
        dv -= c->v_load;
    }
    if (damped)
        pull += c->hg * *v;
    *x += c->h * *v + dx;
    *v += dv - pull;
}

#endif
