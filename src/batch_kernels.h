/* SPDX-License-Identifier: MIT */
/*
 * The kernels of a batch: one for each method and combination of features, in the vectors that real.h is set to.
 *
 * Method    A group of a few vectors is loaded, with its coefficients, into registers, takes all its steps there, and is
 *           stored: several independent chains of operations keep the processor busy, and memory is read once however many
 *           steps there are. Since nothing is stored before the end, undoing a spring costs nothing.
 *           Included by batch_v128.c, batch_v256.c, batch_v512.c and their float twins, one for each vector length, and by
 *           batch.c for the declarations.
 */
#ifndef SPRINGSTEP_BATCH_KERNELS_H
#define SPRINGSTEP_BATCH_KERNELS_H

#include "exact.h"
#include "real.h"

#include <springstep/batch.h>

#ifdef SPRING_FLOAT
#define BATCH(name) spring_batchf_##name
typedef spring_batchf batch;
#else
#define BATCH(name) spring_batch_##name
typedef spring_batch batch;
#endif

/* What a kernel works on. count is a multiple of the group. */
typedef struct batch_block {
    size_t count;
    scalar *x, *v;
    const scalar *w, *g, *a;
    size_t a_step; /* 1: an element a spring; 0: a holds a vector of equal elements, for all */
    scalar dt;
    uint64_t n;
    const spring_propagator *propagator; /* for the closed form, of w, g and n dt */
} batch_block;

typedef bool batch_kernel(const batch_block *b); /* false: at least one spring has kept its state */

enum sharing { SHARED, EACH, NONE }; /* one element for all, one each, not modelled */

typedef struct batch_kernels {
    size_t group;                    /* springs that are advanced together */
    batch_kernel *steps[3][2][3][2]; /* by method, sharing of w, sharing of g, loaded */
    batch_kernel *exact[2];          /* by loaded; w and g shared */
} batch_kernels;

extern const batch_kernels BATCH(v128), BATCH(v256), BATCH(v512); /* by bytes of a vector */

/* spring_batch_advance() with the instruction set of one's choice, for tests. */
spring_status BATCH(advance_with)(const batch_kernels *kernels, const batch *b, spring_method m, scalar dt,
                                  uint64_t n);

#ifdef SPRING_VECTOR

#include "euler.h"
#include "leapfrog.h"
#include "rk4.h"

/* Vectors in a group: enough to hide the latency of a step, few enough for the registers (32 of 64 bytes, else 16). */
enum { vectors = SPRING_VECTOR == 64 ? 8 : 4, group = vectors * lanes };

/* Steps between two looks at whether there is anything left to advance. */
static const uint64_t check_interval = 4096;

#if defined(__GNUC__)
#define SPRING_RARE(condition) __builtin_expect(condition, 0)
#define SPRING_APART           static __attribute__((noinline)) /* kept out of the code that runs */
#else
#define SPRING_RARE(condition) (condition)
#define SPRING_APART           static
#endif

SPRING_INLINE real rate(const scalar *p, size_t i, enum sharing s)
{
    return s == NONE ? splat(0) : (s == SHARED ? splat(*p) : load(p + i)) + 0;
}

/* The rates of the vector of springs from i. */
SPRING_INLINE spring_rates rates_at(const batch_block *b, size_t i, enum sharing w, enum sharing g,
                                    bool loaded)
{
    return (spring_rates){
        rate(b->w, i, w),
        rate(b->g, i, g),
        loaded ? rate(b->a, i * b->a_step, EACH) : splat(0),
    };
}

/* Stores the springs of a group that may advance; false if one keeps its state. */
SPRING_APART bool store_valid(const batch_block *b, size_t i, const real *x, const real *v, size_t many,
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

/* Stores a group; false if a spring keeps its state. Whether one might have to is asked for all of them at once: a sum is
   not finite if a part of it is not, nor is it if it overflows, and a sign is set if a rate is negative, or -0. */
SPRING_INLINE bool store_group(const batch_block *b, size_t i, const real *x, const real *v, size_t many,
                               enum sharing w, enum sharing g)
{
    real sum = x[0] + v[0];
    truth signs = {0};
    SPRING_UNROLL
    for (size_t k = 0; k < many; k++) {
        if (k > 0)
            sum += x[k] + v[k];
        if (w == EACH)
            signs |= sign_bit(load(b->w + i + k * lanes));
        if (g == EACH)
            signs |= sign_bit(load(b->g + i + k * lanes));
    }
    if (SPRING_RARE(any(not_finite(sum) | signs))) {
        real x1[vectors], v1[vectors]; /* x and v themselves stay in registers */
        memcpy(x1, x, many * sizeof *x);
        memcpy(v1, v, many * sizeof *v);
        return store_valid(b, i, x1, v1, many, w, g);
    }
    SPRING_UNROLL
    for (size_t k = 0; k < many; k++) {
        store(b->x + i + k * lanes, x[k]);
        store(b->v + i + k * lanes, v[k]);
    }
    return true;
}

/* Is no spring of a group finite any more? */
SPRING_INLINE bool all_lost(const real *x, const real *v)
{
    truth finite = {0};
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++)
        finite |= (x[k] - x[k] == 0) & (v[k] - v[k] == 0);
    return !any(finite);
}

#define SPRING_METHOD euler
#include "batch_loop.h"
#define SPRING_METHOD leapfrog
#include "batch_loop.h"
#define SPRING_METHOD rk4
#include "batch_loop.h"

SPRING_INLINE bool exact_batch(const batch_block *b, bool loaded)
{
    const exact_coefficients c = exact_prepare(b->propagator);
    bool all = true;
    for (size_t i = 0; i < b->count; i += group) {
        real x[vectors], v[vectors];
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++) {
            const size_t j = i + k * lanes;
            x[k] = load(b->x + j);
            v[k] = load(b->v + j);
            exact_step(&x[k], &v[k], rates_at(b, j, NONE, NONE, loaded).a, &c, loaded);
        }
        all &= store_group(b, i, x, v, vectors, SHARED, SHARED);
    }
    return all;
}

static bool exact(const batch_block *b)
{
    return exact_batch(b, false);
}

static bool exact_loaded(const batch_block *b)
{
    return exact_batch(b, true);
}

#define BATCH_ROW(m, w, g)                    \
    {                                         \
        m##_##w##_##g, m##_##w##_##g##_loaded \
    }
#define BATCH_TABLE(m, w)                                                     \
    {                                                                         \
        BATCH_ROW(m, w, SHARED), BATCH_ROW(m, w, EACH), BATCH_ROW(m, w, NONE) \
    }
#define BATCH_STEPS(m)                               \
    {                                                \
        BATCH_TABLE(m, SHARED), BATCH_TABLE(m, EACH) \
    }
#define BATCH_KERNELS                                                         \
    {                                                                         \
        group, {BATCH_STEPS(euler), BATCH_STEPS(leapfrog), BATCH_STEPS(rk4)}, \
        {                                                                     \
            exact, exact_loaded                                               \
        }                                                                     \
    }

#endif

#endif
