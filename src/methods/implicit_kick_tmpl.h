/* SPDX-License-Identifier: MIT */
/* A kick with implicit damping: v = u/(1 + q), where u is the velocity after an explicit kick without damping and q is
   the damping rate times the length of the kick. */
#ifndef SPRINGSTEP_IMPLICIT_KICK_TMPL_H
#define SPRINGSTEP_IMPLICIT_KICK_TMPL_H

#include "../simd/real_tmpl.h"

/* 1/(1 + q) as a sum: (1, -q/(1 + q)) for q <= 1, else (0, 1/(1 + q)). Rounding 1 + q or its reciprocal would cause an
   error of the same sign in every step, and the amplitude of a lightly damped spring would drift by n eps/2. For q > 1
   the first form would cancel. */
typedef struct implicit_factors {
    real leading, correction;
} implicit_factors;

SPRING_INLINE implicit_factors implicit_factors_of(real q)
{
    const lane_mask light = vec_abs(q) <= 1;
    return (implicit_factors){
        .leading = select_real(light, splat(1), splat(0)),
        .correction = select_real(light, 0 - q, splat(1)) / (1 + q),
    };
}

SPRING_INLINE real implicit_velocity(real u, const implicit_factors *f)
{
    return f->leading * u + f->correction * u;
}

#endif
