/* SPDX-License-Identifier: MIT */
/*
 * The loops over the springs of a batch, on the SIMD vectors of real_tmpl.h.
 *
 * Method    A group of a few vectors is loaded into registers, advanced by all steps, and stored. The independent
 *           chains of operations hide the latency, and memory is read once for any number of steps. A spring that must
 *           keep its state is not stored.
 * Requires  A method must give an infinite or NaN x or v if a rate is infinite or NaN, since only x and v are checked
 *           afterwards. A rate of 0 must give the same bits as a step without this rate.
 */
#ifndef SPRINGSTEP_SPRINGS_TMPL_H
#define SPRINGSTEP_SPRINGS_TMPL_H

#include "../methods/methods.h"
#include "exact_shared_tmpl.h"

/* Computes the coefficients of the group from spring i on. Returns sign bits where a rate is negative. */
SPRING_INLINE lane_mask prepare_group(step_coefficients c[vectors], const batch_run *b, size_t i, real h,
                                      method_prepare *prepare, bool damped, bool loaded)
{
    lane_mask signs = {0};
    SPRING_ROLLED
    for (size_t k = 0; k < vectors; k++) {
        const spring_rates r = rates_at(b, i + k * lanes, damped, loaded);
        prepare(&c[k], r, h, damped, loaded);
        signs |= sign_bit(r.omega2) | sign_bit(r.gamma);
    }
    return signs;
}

SPRING_INLINE void step_group(real *x, real *v, real h, const step_coefficients c[vectors], uint64_t n,
                              method_start *start, method_step *step, bool damped, bool loaded)
{
    real kept[vectors];
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++)
        kept[k] = start(x[k], &c[k], loaded);
    for (; n > 0; n--) {
        vec_keep_in_memory(c);
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++)
            step(&x[k], &v[k], &kept[k], h, &c[k], damped, loaded);
    }
}

/* Advances the group from spring i on. Returns false if a spring keeps its state. b: a copy of *run. */
SPRING_INLINE bool advance_group(const batch_run *run, const batch_run *b, size_t i, real h,
                                 const step_coefficients c[vectors], lane_mask signs, method_start *start,
                                 method_step *step, bool damped, bool loaded)
{
    real x[vectors], v[vectors];
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++) {
        x[k] = vec_load(b->x + i + k * lanes);
        v[k] = vec_load(b->v + i + k * lanes);
    }
    uint64_t left = b->n;
    do {
        const uint64_t some = left < SPRING_CHECK_INTERVAL ? left : SPRING_CHECK_INTERVAL;
        left -= some;
        if (SPRING_COMPACT || step == euler_step)
            step_group(x, v, h, c, some, start, step, damped, loaded);
        else
            SPRING_BY_FEATURES(damped, loaded, step_group, x, v, h, c, some, start, step);
    } while (left > 0 && !none_finite(x, v));
    return store_group(run, i, b->x + i, b->v + i, x, v, vectors, signs);
}

/* Group by group. The loop over steps is compiled for each set of features, all other code once. Euler, which is never
   stable without damping, has one loop. */
SPRING_INLINE bool advance_groups(const batch_run *run, method_prepare *prepare, method_start *start, method_step *step,
                                  bool damped, bool loaded)
{
    const batch_run b = *run; /* a local copy, so that stores cannot alias its fields */
    const bool shared = b.omega2.stride + b.gamma.stride + b.accel.stride == 0;
    const real h = splat(b.dt);
    step_coefficients c[vectors];
    lane_mask signs = {0};
    bool all = true;
    for (size_t i = 0; i < b.count; i += group) {
        if (i == 0 || !shared)
            signs = prepare_group(c, &b, i, h, prepare, damped, loaded);
        all &= advance_group(run, &b, i, h, c, signs, start, step, damped, loaded);
    }
    return all;
}

/* A single step of leapfrog, vector by vector. The processor overlaps independent vectors by itself, and groups are slower
   for springs in memory. */
SPRING_INLINE bool advance_once(const batch_run *run, method_prepare *prepare, method_start *start, method_step *step,
                                bool damped, bool loaded)
{
    const batch_run b = *run;
    const real h = splat(b.dt);
    bool all = true;
    for (size_t i = 0; i < b.count; i += lanes) {
        const spring_rates r = rates_at(&b, i, damped, loaded);
        step_coefficients c = {.omega2 = splat(0)}; /* gcc warns about fields of features that are off */
        prepare(&c, r, h, damped, loaded);
        real x = vec_load(b.x + i), v = vec_load(b.v + i), kept = start(x, &c, loaded);
        step(&x, &v, &kept, h, &c, damped, loaded);
        all &= store_group(run, i, b.x + i, b.v + i, &x, &v, 1, sign_bit(r.omega2) | sign_bit(r.gamma));
    }
    return all;
}

/* Leapfrog has a loop over single steps for each set of features; with vectors of 64 bytes, one loop. */
SPRING_INLINE bool advance_by(const batch_run *b, method_prepare *prepare, method_start *start, method_step *step)
{
    const bool damped = b->gamma.first != NULL, loaded = b->accel.first != NULL;
    if (b->n > 1 || step != leapfrog_step || SPRING_COMPACT)
        return advance_groups(b, prepare, start, step, damped, loaded);
    return SPRING_VECTOR < 64 ? SPRING_BY_FEATURES(damped, loaded, advance_once, b, prepare, start, step)
                              : advance_once(b, prepare, start, step, damped, loaded);
}

static bool advance_each_exactly(const batch_run *b)
{
    const exact_run each = {
        .count = b->count,
        .single = sizeof(scalar) == sizeof(float),
        .x = b->x,
        .v = b->v,
        .omega2 = {b->omega2.first, b->omega2.stride},
        .gamma = {b->gamma.first, b->gamma.stride},
        .accel = {b->accel.first, b->accel.stride},
        .target = b->target,
        .landing = b->landing,
        .t = b->t,
    };
    return SPRING_EXACT_KERNEL(&each);
}

#if SPRING_VECTOR < 64
static bool advance_exactly(const batch_run *b)
{
    const bool loaded = b->accel.first != NULL;
    if (b->propagator == NULL)
        return advance_each_exactly(b);
    if (b->target == NULL)
        return SPRING_COMPACT ? advance_shared(b, loaded) : loaded ? advance_shared(b, true) : advance_shared(b, false);
    return b->propagator->half == 1 && !SPRING_COMPACT ? follow_shared(b, true) : follow_shared(b, false);
}
#endif

static bool advance_springs(const batch_run *b)
{
#if SPRING_VECTOR < 64
#define STEP_METHOD(value, prepare, start, step) \
    case value:                                  \
        return advance_by(b, prepare, start, step);
    switch ((int)b->method) {
        STEP_METHODS(STEP_METHOD)
    }
#undef STEP_METHOD
    return advance_exactly(b);
#else
    /* Leapfrog, and exact solutions with different coefficients, gain most from vectors of 64 bytes. */
    if (b->method == SPRING_LEAPFROG)
        return advance_by(b, leapfrog_prepare, leapfrog_force, leapfrog_step);
    if (b->method == SPRING_EXACT && b->propagator == NULL)
        return advance_each_exactly(b);
    return spring_batch_v256.advance(b);
#endif
}

#endif
