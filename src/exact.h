/* SPDX-License-Identifier: MIT */
/*
 * The exact (closed-form) solution as a method: what exact.c computes once from a spring and a time, and how that moves
 * any state.
 *
 * Method    x1 = e ((e F) x + (e H) v) + P a,   v1 = e ((e G) v - (e w H) x) + e (e H) a,   e the square root of the
 *           decay
 */
#ifndef SPRINGSTEP_EXACT_H
#define SPRINGSTEP_EXACT_H

#include "method.h"
#include "propagator.h"

typedef struct exact_coefficients {
    real half, F, G, H, wH, P;
} exact_coefficients;

SPRING_INLINE exact_coefficients exact_prepare(const spring_propagator *y)
{
    return (exact_coefficients){
        splat((scalar)y->half), splat((scalar)y->F),  splat((scalar)y->G),
        splat((scalar)y->H),    splat((scalar)y->wH), splat((scalar)y->P),
    };
}

SPRING_INLINE void exact_step(real *x, real *v, real a, const exact_coefficients *c, bool loaded)
{
    const real x0 = *x, v0 = *v;
    *x = c->half * (c->F * x0 + c->H * v0);
    *v = c->half * (c->G * v0 - c->wH * x0);
    if (loaded) {
        *x = select_real(a != 0, *x + c->P * a, *x); /* P may be infinite */
        *v = select_real(a != 0, *v + c->half * (c->H * a), *v);
    }
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

/* For springs of equal stiffness and damping: others take an evaluation each. */
static bool exact_batch(const batch_block *b)
{
    return b->a.first != NULL ? exact_springs(b, true) : exact_springs(b, false);
}

#elif defined(SPRING_SHAPE_SCENE)
static const scene_method exact_scene = {0};
#endif

#endif
