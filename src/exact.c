/* SPDX-License-Identifier: MIT */
/*
 * The closed-form solution of a damped, loaded spring.
 *
 * Method    With b = g/2, D = w - b^2 and s = D t^2,
 *
 *               x(t) = F x0 + H v0 + P a        F = e^(-bt) (C + bt S)     C = cos sqrt(s)  or cosh sqrt(-s)
 *               v(t) = -w H x0 + G v0 + H a     G = e^(-bt) (C - bt S)     S = sin sqrt(s)/sqrt(s)  or with sinh
 *                                               H = e^(-bt) t S            P = (1 - F)/w, the integral of H
 *
 *           C and S are entire functions of s: near s = 0 they are power series and nothing happens at critical
 *           damping. Far beyond it e^(-bt) cosh would be 0 times infinity: there the two roots p, q are taken apart,
 *
 *               H = e^(-pt) (1 - e^(-(q-p)t))/(q - p),  F = e^(-pt) (q - p e^(-(q-p)t))/(q - p),  p the slow root.
 *
 *           Every exponential is applied as two halves, so that a large start times a tiny factor is neither 0 nor
 *           infinite before it has to be. 1 - F cancels for short times and for stiffness 0: there P has its own forms.
 * Special   w = 0 is a free particle; n dt that overflows gives NaN.
 * Accuracy  see spring.h; largest error seen 0.62 of that bound (tests/test_exact.c). Without the rounding errors in D
 *           (roots.c) it would be hundreds of times the bound near critical damping.
 * Source    textbook; entire functions of s as in Higham, Functions of Matrices (2008), section 12.4 (matrix cosine)
 */
#include <stddef.h>

#include "exact.h"

typedef struct propagator {
    double half;    /* e^(-pt/2) or e^(-bt/2): every entry below still lacks its square */
    double F, G, H; /* H [s] */
} propagator;

/* 1/(2k)! and 1/(2k+1)! */
/* clang-format off */
static const double even[] = {1, 1. / 2, 1. / 24, 1. / 720, 1. / 40320, 1. / 3628800, 1. / 479001600,
                              1. / 87178291200, 1. / 20922789888000, 1. / 6402373705728000};
static const double odd[] = {1, 1. / 6, 1. / 120, 1. / 5040, 1. / 362880, 1. / 39916800, 1. / 6227020800,
                             1. / 1307674368000, 1. / 355687428096000, 1. / 121645100408832000};
/* clang-format on */

/* cos(sqrt(s)) and sin(sqrt(s))/sqrt(s) for |s| <= 1: the first omitted terms are 4e-19 and 2e-20. */
static void entire(double s, double *C, double *S)
{
    double c = 0, d = 0;
    for (size_t k = sizeof even / sizeof even[0]; k-- > 0;) {
        c = even[k] - s * c;
        d = odd[k] - s * d;
    }
    *C = c;
    *S = d;
}

static propagator propagate(const spring_roots *r, double t)
{
    const double theta = r->split * t, b = r->b;
    if (fabs(theta) <= 1) {
        double C, S;
        entire(r->overdamped ? -theta * theta : theta * theta, &C, &S);
        return (propagator){exp(-b * t / 2), C + b * t * S, C - b * t * S, t * S};
    }
    if (!r->overdamped) {
        const double C = cos(theta), S = sin(theta) / r->split;
        return (propagator){exp(-b * t / 2), C + b * S, C - b * S, S};
    }
    const double p = t > 0 ? spring_slow_root(r) : spring_fast_root(r);
    const double q = t > 0 ? spring_fast_root(r) : spring_slow_root(r);
    const double gap = t > 0 ? 2 * r->split : -2 * r->split; /* q - p, which would cancel */
    const double D = exp(-gap * t);
    return (propagator){exp(-p * t / 2), (q - p * D) / gap, (q * D - p) / gap, -expm1(-gap * t) / gap};
}

/* The displacement from rest after time t under unit acceleration [s^2]. */
static double response(const spring_roots *r, const propagator *y, double t)
{
    const double tau = r->omega * t, beta = r->b * t;
    if (tau * tau < 0.5 && beta * beta <= 2) {
        /* u'' = 1 - tau^2 u - 2 beta u' on [0, 1]: the power series of its solution from rest, at 1 */
        double u = 0.5, older = 0, newer = 0.5;
        for (int n = 3; fabs(older) + fabs(newer) > DBL_EPSILON / 16; n++) {
            const double term = (-tau * tau * older - 2 * beta * (n - 1) * newer) / (n * (n - 1.0));
            older = newer;
            newer = term;
            u += term;
        }
        return t * t * u;
    }
    const double slow = r->overdamped ? spring_slow_root(r) : 0;
    if (r->overdamped && fabs(slow * t) < 0.5) {
        const double fast = spring_fast_root(r);
        const double slow_part = slow > 0 ? -expm1(-slow * t) / slow : t;
        return (slow_part + expm1(-fast * t) / fast) / (2 * r->split);
    }
    return (1 - y->half * y->half * y->F) / r->w;
}

spring_propagator spring_propagator_of(const spring_params *p, double t, bool loaded)
{
    const spring_roots r = spring_roots_of(p);
    const propagator y = propagate(&r, t);
    return (spring_propagator){
        .half = y.half,
        .F = y.half * y.F,
        .G = y.half * y.G,
        .H = y.half * y.H,
        .wH = r.w * (y.half * y.H),
        .P = loaded ? response(&r, &y, t) : 0,
    };
}

spring_state spring_exact(spring_state s, const spring_params *p, double t)
{
    const double a = p->load / p->mass;
    const spring_propagator y = spring_propagator_of(p, t, a != 0);
    const exact_coefficients c = exact_prepare(&y);
    exact_step(&s.x, &s.v, a, &c, a != 0);
    return s;
}

void spring_step_exact(spring_state *s, const spring_params *p, double dt)
{
    *s = spring_exact(*s, p, dt);
}
