/* SPDX-License-Identifier: MIT */
/* Vectors in space, one in each lane. With two axes z is 0. */
#ifndef SPRINGSTEP_REAL3_TMPL_H
#define SPRINGSTEP_REAL3_TMPL_H

#include "real_tmpl.h"

typedef struct real3 {
    real x, y, z;
#ifdef __TINYC__
    real in_memory[2]; /* tcc 0.9.27 returns a structure of three floats wrongly, and one of five by its address */
#endif
} real3;

SPRING_INLINE real3 splat3(const scalar v[3])
{
    return (real3){splat(v[0]), splat(v[1]), splat(v[2])};
}

SPRING_INLINE real3 plus3(real3 a, real3 b)
{
    return (real3){a.x + b.x, a.y + b.y, a.z + b.z};
}

SPRING_INLINE real3 minus3(real3 a, real3 b)
{
    return (real3){a.x - b.x, a.y - b.y, a.z - b.z};
}

SPRING_INLINE real3 times3(real s, real3 a)
{
    return (real3){s * a.x, s * a.y, s * a.z};
}

SPRING_INLINE real3 plus_scaled3(real3 a, real s, real3 b) /* a + s b */
{
    return (real3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

SPRING_INLINE real dot3(real3 a, real3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

SPRING_INLINE real3 cross3(real3 a, real3 b)
{
    return (real3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

SPRING_INLINE real3 select3(lane_mask t, real3 a, real3 b)
{
    return (real3){select_real(t, a.x, b.x), select_real(t, a.y, b.y), select_real(t, a.z, b.z)};
}

#endif
