/* SPDX-License-Identifier: MIT */
/*
 * What the kernels of a batch do before and after the steps, in the vectors that real.h is set to.
 *
 * Method    A group of a few vectors is loaded into registers, takes all its steps there, and is stored: several
 *           independent chains of operations keep the processor busy, and memory is read once however many steps there
 *           are. Since nothing is stored before the end, rolling a spring back costs nothing.
 */
#ifndef SPRINGSTEP_BATCH_GROUP_H
#define SPRINGSTEP_BATCH_GROUP_H

#include "batch_kernels.h"
#include "rates.h"

/* Vectors in a group: enough to hide the latency of a step, few enough for the registers (32 of 64 bytes, else 16). */
enum { vectors = SPRING_VECTOR == 64 ? 8 : 4, group = vectors * lanes };

SPRING_INLINE real rate(batch_array p, size_t i)
{
    return vec_load(p.first + i * p.step) + 0;
}

/* The rates of the vector of springs from i. */
SPRING_INLINE spring_rates rates_at(const batch_block *b, size_t i, bool damped, bool loaded)
{
    return (spring_rates){
        .w = rate(b->w, i),
        .g = damped ? rate(b->g, i) : splat(0),
        .a = loaded ? rate(b->a, i) : splat(0),
    };
}

SPRING_INLINE bool negative(batch_array p, size_t i)
{
    return p.first != NULL && p.first[i * p.step] < 0;
}

/* Stores the springs of a group that may advance; false if one keeps its state. */
SPRING_NOINLINE bool store_valid(const batch_block *b, size_t i, const real *x, const real *v, size_t many)
{
    scalar x1[group], v1[group];
    memcpy(x1, x, many * sizeof *x);
    memcpy(v1, v, many * sizeof *v);
    bool all = true;
    for (size_t j = 0; j < many * lanes; j++) {
        if (spring_finite(x1[j]) && spring_finite(v1[j]) && !negative(b->w, i + j) && !negative(b->g, i + j)) {
            b->x[i + j] = x1[j];
            b->v[i + j] = v1[j];
        } else {
            all = false;
        }
    }
    return all;
}

/* Might a spring have to keep its state? This is asked for a group at once: a sum is not finite if a part of it is not,
   nor is it if it overflows; signs has a bit if a rate is negative. */
SPRING_INLINE bool doubtful(const real *x, const real *v, size_t many, mask signs)
{
    real sum = x[0] + v[0];
    SPRING_UNROLL
    for (size_t k = 1; k < many; k++)
        sum += x[k] + v[k];
    return any(not_finite(sum) | signs);
}

/* Stores a group at x_to and v_to, where its springs, from i, are in b; false if a spring keeps its state. */
SPRING_INLINE bool store_group(const batch_block *b, size_t i, scalar *x_to, scalar *v_to, const real *x, const real *v,
                               size_t many, mask signs)
{
    if (SPRING_UNLIKELY(doubtful(x, v, many, signs))) {
        real x1[vectors], v1[vectors]; /* x and v themselves stay in registers */
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

/* Is no spring of a group finite any more? */
SPRING_INLINE bool all_lost(const real *x, const real *v)
{
    mask finite = {0};
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++)
        finite |= (x[k] - x[k]) + (v[k] - v[k]) == 0;
    return !any(finite);
}

#endif
