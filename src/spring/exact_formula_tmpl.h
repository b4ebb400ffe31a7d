/* SPDX-License-Identifier: MIT */
/*
 * The exact (closed-form) solution of a damped, loaded spring, on `real`: one spring or a SIMD vector of springs.
 *
 * Method    With b = g/2, D = w - b^2 and, if the roots p < q are real, h = (1 - d)/gap, d = e^(-gap |t|):
 *
 *               x(t) = E (F x0 + H v0) + P a      D >= 0: E = e^(-bt)   F = cos + b H   H = sin(split t)/split
 *               v(t) = E (G v0 - w H x0 + H a)                          G = cos - b H   split = sqrt(D)
 *                                                 D < 0:  E = e^(-pt)   F = 1 + p h     H = h      for t > 0
 *                                                                       G = d - p h     split = sqrt(-D)
 *                                                 E = e^(-qt), F = d - p h, G = 1 + p h, H = -h    for t < 0
 *
 *           q = b + split, p = w/q, gap = 2 split. No difference cancels more than the solution itself does, and both
 *           forms hold up to critical damping, where H = t. P is the integral of E H: (1 - E F)/w or, with real roots,
 *           ((1 - e^(-pt))/p - E H)/q. If the larger root times t is below 1, both would cancel. P is then the power
 *           series of t^2 times a divided difference of the exponential at 0 and the roots. Powers of two of E are
 *           applied in two halves, so that a large state times a tiny factor does not overflow or underflow early.
 * Special   w = 0 is a free particle. A t that is not finite gives NaN.
 * Accuracy  see spring.h; tests/spring/test_exact.c prints the largest error found. Without the rounding errors of w
 *           and b^2 it would be hundreds of times the bound near critical damping.
 * Source    textbook; divided differences: Higham, Functions of Matrices (2008), section B.16
 */
#ifndef SPRINGSTEP_EXACT_FORMULA_TMPL_H
#define SPRINGSTEP_EXACT_FORMULA_TMPL_H

#include "../simd/real_tmpl.h"
#include "propagator.h"
#include "roots.h"
#include "split_tmpl.h"

typedef struct exact_coefficients {
    real half;           /* of E, see exact_halves */
    real F, G, H, wH, P; /* times the other half; H [s], wH [1/s]; P [s^2] is complete */
    real decay_rate;     /* [1/s] of E; for t > 0, of the slowest mode */
} exact_coefficients;

/* Coefficients that are equal for all springs, computed once in double. */
SPRING_INLINE exact_coefficients exact_prepare(const spring_propagator *y)
{
    return (exact_coefficients){
        splat((scalar)y->half), splat((scalar)y->F), splat((scalar)y->G),          splat((scalar)y->H),
        splat((scalar)y->wH),   splat((scalar)y->P), splat((scalar)y->decay_rate),
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

#ifndef SPRING_FLOAT
/* 1 - e^x and e^x for -750 <= x <= 0 */
typedef struct exact_decay {
    real lost, left;
} exact_decay;

SPRING_INLINE exact_decay exact_decay_of(real x)
{
    const exponential y = exponential_of(select_real(x < -750, splat(-750), x)); /* 0 from there on */
    const real power = power_of_two(y.k), part = power * y.e;
    return (exact_decay){(1 - power) - part, power + part};
}

/* e^x as a product of two numbers, which overflow or underflow much later than e^x */
typedef struct exact_halves {
    real half, other; /* half is a power of two */
} exact_halves;

SPRING_INLINE exact_halves exact_halves_of(real x)
{
    const exponential y = exponential_of(select_real(x < -1500, splat(-1500), select_real(x > 1500, splat(1500), x)));
    const real k = nearest(y.k / 2), power = power_of_two(k);
    return (exact_halves){power_of_two(y.k - k), power + power * y.e};
}

/* Numbers below this do not change 1, even as a sum of many squares. */
static const scalar exact_tiny = 0x1p-55;

/* P/t^2 as the sum of h_n/(n + 2)!, h_n = -sum h_(n-1) - product h_(n-2), by Horner's rule. sum, product: of the roots
   times t. If these are below 1, the first omitted term is 8e-18. */
SPRING_INLINE real exact_short_response(real sum, real product)
{
    /* clang-format off */
    static const scalar c[] = {1. / 2, 1. / 6, 1. / 24, 1. / 120, 1. / 720, 1. / 5040, 1. / 40320, 1. / 362880,
                               1. / 3628800, 1. / 39916800, 1. / 479001600, 1. / 6227020800, 1. / 87178291200,
                               1. / 1307674368000, 1. / 20922789888000, 1. / 355687428096000, 1. / 6402373705728000,
                               1. / 121645100408832000};
    /* clang-format on */
    real newer = splat(0), older = splat(0);
    for (int i = sizeof c / sizeof c[0]; i-- > 0;) {
        const real next = (c[i] - product * older) - sum * newer;
        older = newer;
        newer = next;
    }
    return newer;
}

SPRING_INLINE exact_coefficients exact_coefficients_of(real w, real b, real rest, real time, bool loaded)
{
    const real t = time + (time - time);
    const spring_split r = spring_split_of(w, b, rest);
    const lane_mask real_roots = r.overdamped, complex_roots = not_mask(real_roots), forward = t > 0;
    const real angle = r.split * t, size = vec_abs(angle);
    const lane_mask still = size < exact_tiny;
    real slow = b, fast = b, rate = b, F = t, G = t, H = t;
    if (any(complex_roots)) {
        const sine_cosine y = sine_cosine_of(angle);
        H = select_real(still, t, y.sine * (1 / r.split));
        F = y.cosine + b * H;
        G = y.cosine - b * H;
    }
    if (any(real_roots)) {
        const exact_decay d = exact_decay_of(-2 * size);
        fast = b + r.split;
        slow = w / fast;
        const real h = select_real(still, vec_abs(t), d.lost / (2 * r.split)), more = slow * h;
        rate = select_real(real_roots, select_real(forward, slow, fast), rate);
        F = select_real(real_roots, select_real(forward, 1 + more, d.left - more), F);
        G = select_real(real_roots, select_real(forward, d.left - more, 1 + more), G);
        H = select_real(real_roots, select_real(forward, h, -h), H);
    }
    const exact_halves E = exact_halves_of(-rate * t);
    exact_coefficients c = {E.half, E.other * F, E.other * G, E.other * H, w * (E.other * H), splat(0), rate};
    const lane_mask no_stiffness = w == 0; /* half F is 1, also where d.left has underflowed */
    if (any(no_stiffness))
        c.F = select_real(no_stiffness, 1 / E.half, c.F);
    if (!loaded)
        return c;

    const real product = w * t * t, largest = select_real(real_roots, fast * t, product);
    if (any(complex_roots))
        c.P = (1 - E.half * c.F) / w;
    if (any(real_roots)) {
        const real size_slow = slow * vec_abs(t);
        const exact_decay d = exact_decay_of(-size_slow);
        const real lost = d.lost / (slow * select_real(forward, splat(1), -d.left)); /* (1 - e^(-pt))/p */
        const real P = (select_real(size_slow < exact_tiny, t, lost) - E.half * c.H) / fast;
        c.P = select_real(real_roots, P, c.P);
    }
    const lane_mask brief = vec_abs(largest) < 1;
    if (any(brief))
        c.P = select_real(brief, t * t * exact_short_response(2 * (b * t), product), c.P);
    return c;
}

#endif

#endif
