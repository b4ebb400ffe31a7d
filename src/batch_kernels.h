/* SPDX-License-Identifier: MIT */
/*
 * The kernels of a batch: one for each method and combination of features, in the vectors that real.h is set to.
 *
 * Method    A group of a few vectors is loaded, with its coefficients, into registers, takes all its steps there, and
 *           is stored: several independent chains of operations keep the processor busy, and memory is read once
 *           however many steps there are. Since nothing is stored before the end, rolling a spring back costs nothing.
 *           batch.c includes this for the declarations, kernels.h for each vector length and precision.
 */
#ifndef SPRINGSTEP_BATCH_KERNELS_H
#define SPRINGSTEP_BATCH_KERNELS_H

#include "rates.h"
#include "simd/real.h"
#include "twins.h"

struct spring_propagator;

/* What a kernel works on. count is a multiple of the group. */
typedef struct batch_block {
    size_t count;
    scalar *x, *v;
    const scalar *w, *g, *a;
    size_t a_step; /* 1: an element a spring; 0: a holds a vector of equal elements, for all */
    scalar dt;
    uint64_t n;
    const struct spring_propagator *propagator; /* of the exact solution, for w, g and n dt */
} batch_block;

typedef bool batch_kernel(const batch_block *b); /* false: at least one spring has kept its state */

enum sharing { SHARED, EACH, NONE }; /* one element for all, one each, not modelled */

typedef struct batch_method {
    batch_kernel *kernel[2][3][2]; /* by sharing of w, sharing of g, loaded; NULL: each spring by spring_advance() */
} batch_method;

typedef struct batch_kernels {
    size_t group; /* springs that are advanced together */
    const batch_method *method[SPRING_METHOD_COUNT];
} batch_kernels;

extern const batch_kernels spring_batch_v128, spring_batch_v256, spring_batch_v512; /* by bits of a vector */

/* spring_batch_advance() with a given instruction set, for tests. */
spring_status spring_batch_advance_with(const batch_kernels *kernels, const spring_batch *b, spring_method m, scalar dt,
                                        uint64_t n);

#ifdef SPRING_VECTOR

/* Vectors in a group: enough to hide the latency of a step, few enough for the registers (32 of 64 bytes, else 16). */
enum { vectors = SPRING_VECTOR == 64 ? 8 : 4, group = vectors * lanes };

SPRING_INLINE real rate(const scalar *p, size_t i, enum sharing s)
{
    return s == NONE ? splat(0) : (s == SHARED ? splat(*p) : vec_load(p + i)) + 0;
}

/* The rates of the vector of springs from i. */
SPRING_INLINE spring_rates rates_at(const batch_block *b, size_t i, enum sharing w, enum sharing g, bool loaded)
{
    return (spring_rates){
        rate(b->w, i, w),
        rate(b->g, i, g),
        loaded ? rate(b->a, i * b->a_step, EACH) : splat(0),
    };
}

/* Stores the springs of a group that may advance; false if one keeps its state. */
SPRING_NOINLINE bool store_valid(const batch_block *b, size_t i, const real *x, const real *v, size_t many,
                                 enum sharing w, enum sharing g)
{
    scalar x1[group], v1[group];
    memcpy(x1, x, many * sizeof *x);
    memcpy(v1, v, many * sizeof *v);
    bool all = true;
    for (size_t j = 0; j < many * lanes; j++) {
        const bool finite = isfinite(x1[j]) && isfinite(v1[j]);
        if (finite && !(w == EACH && b->w[i + j] < 0) && !(g == EACH && b->g[i + j] < 0)) {
            b->x[i + j] = x1[j];
            b->v[i + j] = v1[j];
        } else {
            all = false;
        }
    }
    return all;
}

/* Stores a group; false if a spring keeps its state. Whether one might have to is asked for all of them at once: a sum
   is not finite if a part of it is not, nor is it if it overflows, and a sign is set if a rate is negative, or -0. */
SPRING_INLINE bool store_group(const batch_block *b, size_t i, const real *x, const real *v, size_t many,
                               enum sharing w, enum sharing g)
{
    real sum = x[0] + v[0];
    mask signs = {0};
    SPRING_UNROLL
    for (size_t k = 0; k < many; k++) {
        if (k > 0)
            sum += x[k] + v[k];
        if (w == EACH)
            signs |= sign_bit(vec_load(b->w + i + k * lanes));
        if (g == EACH)
            signs |= sign_bit(vec_load(b->g + i + k * lanes));
    }
    if (SPRING_UNLIKELY(any(not_finite(sum) | signs))) {
        real x1[vectors], v1[vectors]; /* x and v themselves stay in registers */
        memcpy(x1, x, many * sizeof *x);
        memcpy(v1, v, many * sizeof *v);
        return store_valid(b, i, x1, v1, many, w, g);
    }
    SPRING_UNROLL
    for (size_t k = 0; k < many; k++) {
        vec_store(b->x + i + k * lanes, x[k]);
        vec_store(b->v + i + k * lanes, v[k]);
    }
    return true;
}

/* Is no spring of a group finite any more? */
SPRING_INLINE bool all_lost(const real *x, const real *v)
{
    mask finite = {0};
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++)
        finite |= (x[k] - x[k] == 0) & (v[k] - v[k] == 0);
    return !any(finite);
}

#endif

#endif
