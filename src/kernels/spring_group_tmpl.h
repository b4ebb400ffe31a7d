/* SPDX-License-Identifier: MIT */
/* Groups of springs: a few SIMD vectors that are loaded, advanced and stored together. */
#ifndef SPRINGSTEP_SPRING_GROUP_TMPL_H
#define SPRINGSTEP_SPRING_GROUP_TMPL_H

#include "../spring/rates_tmpl.h"
#include "batch_kernels.h"

/* Vectors in a group: enough to hide the latency of a step, few enough for the registers (32 of 64 bytes, or 16). */
enum { vectors = SPRING_VECTOR == 64 ? 8 : 4, group = vectors * lanes };

/* Reads the values of a parameter for a vector of springs, from spring i on. */
SPRING_INLINE real rate(batch_array p, size_t i)
{
    return vec_load(p.first + i * p.stride) + 0;
}

SPRING_INLINE spring_rates rates_at(const batch_run *b, size_t i, bool damped, bool loaded)
{
    return (spring_rates){
        .omega2 = rate(b->omega2, i),
        .gamma = damped ? rate(b->gamma, i) : splat(0),
        .accel = loaded ? rate(b->accel, i) : splat(0),
    };
}

SPRING_INLINE bool negative(batch_array p, size_t i)
{
    return p.first != NULL && p.first[i * p.stride] < 0;
}

/* Stores the springs of a group that are finite and have no negative rate. Returns false if a spring is not stored. */
SPRING_NOINLINE bool store_valid(const batch_run *b, size_t i, const real *x, const real *v, size_t many)
{
    scalar x1[group], v1[group];
    memcpy(x1, x, many * sizeof *x);
    memcpy(v1, v, many * sizeof *v);
    bool all = true;
    for (size_t j = 0; j < many * lanes; j++) {
        if (scalar_finite(x1[j]) && scalar_finite(v1[j]) && !negative(b->omega2, i + j) && !negative(b->gamma, i + j)) {
            b->x[i + j] = x1[j];
            b->v[i + j] = v1[j];
        } else {
            all = false;
        }
    }
    return all;
}

/* Checks whether a spring of a group may have to keep its state. A sum is not finite if one of its terms is not finite,
   or if it overflows. signs: not 0 where a rate is negative. */
SPRING_INLINE bool may_be_invalid(const real *x, const real *v, size_t many, lane_mask signs)
{
    real sum = x[0] + v[0];
    SPRING_UNROLL
    for (size_t k = 1; k < many; k++)
        sum += x[k] + v[k];
    return any(not_finite(sum) | signs);
}

/* Stores the group from spring i on, at x_to and v_to. Returns false if a spring keeps its state. */
SPRING_INLINE bool store_group(const batch_run *b, size_t i, scalar *x_to, scalar *v_to, const real *x, const real *v,
                               size_t many, lane_mask signs)
{
    if (SPRING_UNLIKELY(may_be_invalid(x, v, many, signs))) {
        real x1[vectors], v1[vectors]; /* copies, so that x and v stay in registers */
        memcpy(x1, x, many * sizeof *x);
        memcpy(v1, v, many * sizeof *v);
        return store_valid(b, i, x1, v1, many);
    }
    SPRING_UNROLL
    for (size_t k = 0; k < many; k++) {
        vec_store(x_to + k * lanes, x[k]);
        vec_store(v_to + k * lanes, v[k]);
    }
    return true;
}

SPRING_INLINE bool none_finite(const real *x, const real *v)
{
    lane_mask finite = {0};
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++)
        finite |= (x[k] - x[k]) + (v[k] - v[k]) == 0;
    return !any(finite);
}

#endif
