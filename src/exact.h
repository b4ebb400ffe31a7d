/* SPDX-License-Identifier: MIT */
/*
 * The exact (closed-form) solution as a method. Springs of a batch that are all alike share coefficients, computed once;
 * others take a formula each (exact_formula.h), in double whatever the precision of the batch.
 */
#ifndef SPRINGSTEP_EXACT_H
#define SPRINGSTEP_EXACT_H

#include "exact_formula.h"
#include "method.h"
#include "propagator.h"

/* Of springs that are all alike: computed once in double. */
SPRING_INLINE exact_coefficients exact_prepare(const spring_propagator *y)
{
    return (exact_coefficients){
        splat((scalar)y->half), splat((scalar)y->F),  splat((scalar)y->G),
        splat((scalar)y->H),    splat((scalar)y->wH), splat((scalar)y->P),
    };
}

#if defined(SPRING_SHAPE_ONE)
static double exact_stable_step(const spring_roots *r)
{
    (void)r;
    return INFINITY;
}

static const one_method exact_one = {
    .info = {.name = "exact", .order = 0, .forces_per_step = 0, .symplectic = true, .springs = true, .label = "exact"},
    .kernel = spring_step_exact,
    .stable_step = exact_stable_step,
    .digest = UINT64_C(0x00349312ac922285),
};

#elif defined(SPRING_SHAPE_BATCH)
SPRING_INLINE bool exact_springs(const batch_block *b, bool loaded)
{
    const exact_coefficients c = exact_prepare(b->propagator);
    bool all = true;
    for (size_t i = 0; i < b->count; i += group) {
        real x[vectors], v[vectors];
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++) {
            const size_t j = i + k * lanes;
            x[k] = vec_load(b->x + j);
            v[k] = vec_load(b->v + j);
            exact_step(&x[k], &v[k], loaded ? rate(b->a, j) : splat(0), &c, loaded);
        }
        all &= store_group(b, i, b->x + i, b->v + i, x, v, vectors, (mask){0});
    }
    return all;
}

#ifndef SPRING_FLOAT
SPRING_INLINE real exact_load(const void *array, size_t i, bool single)
{
    return single ? vec_load_float((const float *)array + i) : vec_load((const double *)array + i);
}

SPRING_INLINE void exact_store(void *array, size_t i, real a, bool single)
{
    if (single)
        vec_store_float((float *)array + i, a);
    else
        vec_store((double *)array + i, a);
}

/* NaN if it is negative, or infinite: so the spring keeps its state. Of -0 it is 0. */
SPRING_INLINE real exact_rate(exact_array p, size_t i, bool single)
{
    const real rate = exact_load(p.first, i * p.step, single);
    return select_real(rate >= 0, rate + (rate - rate), splat(NAN));
}

/* Stores the springs of a vector that may advance; false, since one may not. */
SPRING_NOINLINE bool exact_store_valid(const exact_block *b, size_t i, const double *x, const double *v, double beyond)
{
    for (size_t k = 0; k < lanes; k++) {
        if (!(fabs(x[k]) < beyond && fabs(v[k]) < beyond))
            continue;
        if (b->single) {
            ((float *)b->x)[i + k] = (float)x[k];
            ((float *)b->v)[i + k] = (float)v[k];
        } else {
            ((double *)b->x)[i + k] = x[k];
            ((double *)b->v)[i + k] = v[k];
        }
    }
    return false;
}

bool SPRING_EXACT_KERNEL(const exact_block *block)
{
    const exact_block b = *block; /* which no store can change, for all the compiler knows */
    const bool damped = b.g.first != NULL, loaded = b.a.first != NULL;
    const double beyond = b.single ? 0x1.ffffffp127 : INFINITY; /* becomes infinite when it is stored */
    bool all = true;
    for (size_t i = 0; i < b.count; i += lanes) {
        const real w = exact_rate(b.w, i, b.single), g = damped ? exact_rate(b.g, i, b.single) : splat(0);
        const real a = loaded ? exact_load(b.a.first, i * b.a.step, b.single) : splat(0);
        const exact_coefficients c = exact_coefficients_of(w, g / 2, splat(0), splat(b.t), loaded);
        real x = exact_load(b.x, i, b.single), v = exact_load(b.v, i, b.single);
        exact_step(&x, &v, a, &c, loaded);
        if (SPRING_UNLIKELY(any(not_mask((vec_abs(x) < beyond) & (vec_abs(v) < beyond))))) {
            double x1[lanes], v1[lanes];
            memcpy(x1, &x, sizeof x);
            memcpy(v1, &v, sizeof v);
            all = exact_store_valid(&b, i, x1, v1, beyond);
        } else {
            exact_store(b.x, i, x, b.single);
            exact_store(b.v, i, v, b.single);
        }
    }
    return all;
}
#endif

static bool exact_each(const batch_block *b)
{
    const exact_block block = {
        .count = b->count,
        .single = sizeof(scalar) == sizeof(float),
        .x = b->x,
        .v = b->v,
        .w = {b->w.first, b->w.step},
        .g = {b->g.first, b->g.step},
        .a = {b->a.first, b->a.step},
        .t = (double)b->dt * (double)b->n,
    };
    return SPRING_EXACT_KERNEL(&block);
}

static bool exact_batch(const batch_block *b)
{
    if (b->propagator == NULL)
        return exact_each(b);
    return b->a.first != NULL ? exact_springs(b, true) : exact_springs(b, false);
}

#elif defined(SPRING_SHAPE_SCENE)
static const scene_method exact_scene = {0};
#endif

#endif
