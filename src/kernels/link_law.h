/* SPDX-License-Identifier: MIT */
/* The force law of a link, for single numbers. bands_tmpl.h has it for SIMD vectors. */
#ifndef SPRINGSTEP_LINK_LAW_H
#define SPRINGSTEP_LINK_LAW_H

#include "../simd/arithmetic.h"
#include "../simd/scalar.h"

/* [N] positive if the link pulls; rate: [m/s] rate of change of the length */
static inline double link_tension(double stiffness, double rest, double damping, double length, double rate)
{
    return stiffness * (length - rest) + damping * rate;
}

/* Larger angles of turning count as this one, so that the square of the angle of a very short link is finite. (In bands,
   vec_min() makes it 1.) */
static const scalar most_angle = sizeof(scalar) == sizeof(float) ? (scalar)1e18 : (scalar)1e150;

/* [1/s] delta/length of scene/exponential_kick.h: how much the rate of a link, divided by its length, is lowered because
   it turns. across: the square of |vector of the link x its derivative|. span: [s] the time step */
static inline scalar turning_rate(scalar span, scalar inverse_square, scalar across)
{
    const scalar turns = span * inverse_square, angle = turns < most_angle ? turns : most_angle;
    const scalar turn = angle * angle * across;
    const scalar turned = turn < 0 ? 0 : turn > 1 ? 1 : turn;
    return (turned + turned * turned * ((scalar)0.25 + (scalar)0.125 * turned)) * (1 / (2 * span));
}

#endif
