/* SPDX-License-Identifier: MIT */
/*
 * A step of a spring that follows a target, on `real`: one spring or a SIMD vector of springs.
 *
 * Method    The rest position moves at the constant velocity T'. So y = x - rest and u = v - T' obey the equation of a
 *           spring without load, and the exact solution (exact_formula_tmpl.h) advances them.
 * Landing   x is stored with an error of up to d, half an ulp, so it stops where a step would change it by less. To
 *           reach the target nevertheless, a spring is placed on it at rest if dt > 0 and
 *
 *               hypot(y, u/omega) f <= 9/4 d,   f = max(min(1, r dt), f0),   r the decay rate of its slowest mode.
 *
 *           With f0 = 0, the condition is true wherever rounding can stop a spring. With an error of +-d in x after
 *           each step, (y, u/omega) ends up within the sum of +-d Phi(i dt) (1, 0) over i >= 1, where Phi is the
 *           propagator of (y, u/omega). The sum times r dt is largest at critical damping for dt -> 0, where it is d
 *           times the integral of Phi (1, 0) omega dt: d (2, 1), of norm sqrt(5) d = 2.236 d. (It tends to d for large
 *           damping ratios, to 2/pi d for small ones.) 9/4 leaves room for the rounding errors of a step. v adds
 *           nothing, since its error is relative. d is half an ulp of the larger of x and the rest position, since a
 *           power of two may lie between them.
 * Limit     f0 > 0 makes x continuous in dt: a spring lands from at most 9/4 d/f0, however short the step is. If
 *           r dt < f0, rounding may stop a spring before it lands, up to sqrt(5) d/(r dt) away. In double, f0 = 2^-16:
 *           73 728 ulps, less than 1.7e-11 of the larger of |x| and |rest|. A spring of 0.02 Hz with a damping ratio of
 *           10 still lands at 240 Hz. In float, as many ulps would be a visible jump of up to 0.9 %, so f0 = 2^-11:
 *           2304 ulps, less than 0.03 %. This is the largest power of two with which the slowest springs of user
 *           interfaces land at 240 Hz. (A duration of 5 s and a bounce of 0.9 have r dt = 1.07 * 2^-11.)
 * Special   Without stiffness, only u decays. Near 0, an ulp is arbitrarily small, so a spring lands where numbers
 *           would become denormal.
 */
#ifndef SPRINGSTEP_FOLLOW_FORMULA_TMPL_H
#define SPRINGSTEP_FOLLOW_FORMULA_TMPL_H

#include "exact_formula_tmpl.h"

/* The coefficients of a step. */
typedef struct follow_coefficients {
    exact_coefficients exact;
    real omega2;
    real fraction; /* f, about the fraction of its distance that a spring moves in a step; 0 if it does not land */
} follow_coefficients;

/* f0, see above. single: x is stored as a float, even if it is computed in double. */
SPRING_INLINE real follow_least_fraction(bool single)
{
    return splat(single ? (scalar)0x1p-11 : (scalar)0x1p-16);
}

SPRING_INLINE follow_coefficients follow_prepare(exact_coefficients exact, real omega2, real dt, bool single)
{
    const real f0 = follow_least_fraction(single), decay = exact.decay_rate * dt;
    const lane_mask lands = (decay > 0) & (omega2 > 0);
    const real fraction = select_real(decay < f0, f0, select_real(decay < 1, decay, splat(1)));
    return (follow_coefficients){exact, omega2, select_real(lands, fraction, splat(0))};
}

/* Half an ulp of a >= 0 that is not denormal, exactly. It uses a/2, since the number after the largest is infinite. */
SPRING_INLINE real half_ulp(real a)
{
    const scalar u = (sizeof(scalar) == sizeof(float) ? (scalar)FLT_EPSILON : (scalar)DBL_EPSILON) / 2;
    const real half = a / 2, next = half + half * (u + 2 * u * u);
    return next - half;
}

/* sqrt(a^2 + b^2), a and b >= 0, without squares that overflow: spring_hypot() on `real` */
SPRING_INLINE real vec_hypot(real a, real b)
{
    const lane_mask larger = a > b;
    const real large = select_real(larger, a, b), lesser = select_real(larger, b, a);
    const real ratio = lesser / select_real(large > 0, large, splat(1));
    return large * vec_sqrt(1 + ratio * ratio);
}

/* Whether a spring lands: see above. single: as in follow_prepare(). */
SPRING_INLINE lane_mask follow_lands(real x, real rest, real y, real u, const follow_coefficients *c, bool single)
{
    const scalar ulps = single && sizeof(scalar) == sizeof(double) ? (scalar)0x1p29 : 1; /* an ulp of float in double */
    const scalar least = single ? (scalar)FLT_MIN : (scalar)DBL_MIN;
    const scalar reach = 2.25; /* [d] 9/4, see above */
    const real x_size = vec_abs(x), rest_size = vec_abs(rest), distance = vec_abs(y);
    const real tolerance = half_ulp(select_real(x_size > rest_size, x_size, rest_size)) * (reach * ulps) + least;
    const lane_mask nearby = (c->fraction > 0) & (distance * c->fraction <= tolerance);
    if (!any(nearby))
        return nearby;
    const real speed = vec_abs(u) / vec_sqrt(select_real(nearby, c->omega2, splat(1)));
    return nearby & (vec_hypot(distance, speed) * c->fraction <= tolerance);
}

#endif
