/* SPDX-License-Identifier: MIT */
/* A kick whose damping is solved for: v = u/(1 + q), q the damping times the length of the kick. */
#ifndef SPRINGSTEP_SOLVED_KICK_H
#define SPRINGSTEP_SOLVED_KICK_H

#include "simd/real.h"

/* u/(1 + q) as u - u q/(1 + q) while q <= 1: rounding 1 + q, or its reciprocal, would be an error of the same sign in
   every step, and the amplitude of a lightly damped spring would drift by n eps/2. Beyond, u times the reciprocal,
   since the difference would cancel. One formula for both: keep u + lose u, (keep, lose) = (1, -q/(1 + q)) or
   (0, 1/(1 + q)). */
typedef struct solved_share {
    real keep, lose;
} solved_share;

SPRING_INLINE solved_share solved_share_of(real q)
{
    const mask light = vec_abs(q) <= 1;
    return (solved_share){
        .keep = select_real(light, splat(1), splat(0)),
        .lose = select_real(light, 0 - q, splat(1)) / (1 + q),
    };
}

#endif
