/* SPDX-License-Identifier: MIT */
/* The exact solution of springs with different parameters (../spring/exact_formula_tmpl.h), for one vector width
   (SPRING_VECTOR bytes), as the function SPRING_EXACT_KERNEL. It computes in double for batches of both precisions,
   since in float the phase would have an error of 6e-8 omega t. Included by the sources exact_*.c of this folder. */
#ifndef SPRINGSTEP_EXACT_TMPL_H
#define SPRINGSTEP_EXACT_TMPL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "../simd/target_begin.h"

#include "landing_tmpl.h"

SPRING_INLINE real exact_load(const void *array, size_t i, bool single)
{
    return single ? vec_load_float((const float *)array + i) : vec_load((const double *)array + i);
}

/* a, rounded to float if `single`. */
SPRING_INLINE real rounded(real a, bool single)
{
    float each[lanes];
    if (!single)
        return a;
    vec_store_float(each, a);
    return vec_load_float(each);
}

/* A vector of springs with different coefficients, from spring i on. The rest position is rounded as in
   follow_shared(). For a spring without stiffness, y = x, or NaN if the target is not finite. */
SPRING_INLINE void follow_each(const exact_run *b, size_t i, real *x, real *v, real w, real a,
                               const exact_coefficients *exact, bool loaded)
{
    const lane_mask is_free = w == 0;
    const real target = exact_load(b->target, i, b->single);
    const real shift = rounded(a / w, b->single),
               rest = rounded(select_real(a != 0, target + shift, target), b->single);
    const real to = select_real(is_free, target - target, rest);
    const follow_coefficients c = follow_prepare(*exact, w, splat(b->t), b->single);
    real y = *x - to;
    exact_step(&y, v, select_real(is_free, a, splat(0)), exact, loaded);
    *x = to + y;
    *b->landing.moving += settle(&b->landing, i, x, v, y, rest, &c, b->single);
}
SPRING_INLINE void exact_store(void *array, size_t i, real a, bool single)
{
    if (single)
        vec_store_float((float *)array + i, a);
    else
        vec_store((double *)array + i, a);
}

/* A negative or infinite rate becomes NaN, so that the spring keeps its state; -0 becomes 0. */
SPRING_INLINE real exact_rate(exact_array p, size_t i, bool single)
{
    const real rate = exact_load(p.first, i * p.stride, single);
    return select_real(rate >= 0, rate + (rate - rate), splat((scalar)NAN));
}

/* Stores the springs of a vector whose new state is finite. Always returns false: at least one spring is not stored. */
SPRING_NOINLINE bool exact_store_valid(const exact_run *b, size_t i, const double *x, const double *v, double beyond)
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

bool SPRING_EXACT_KERNEL(const exact_run *run)
{
    const exact_run b = *run; /* a local copy, so that stores cannot alias its fields */
    const bool damped = b.gamma.first != NULL, loaded = b.accel.first != NULL;
    const double beyond = b.single ? 0x1.ffffffp127 : (double)INFINITY; /* numbers from here on become infinite */
    bool all = true;
    for (size_t i = 0; i < b.count; i += lanes) {
        const real w = exact_rate(b.omega2, i, b.single), g = damped ? exact_rate(b.gamma, i, b.single) : splat(0);
        const real a = loaded ? exact_load(b.accel.first, i * b.accel.stride, b.single) : splat(0);
        const bool shifted = b.target != NULL && !any(not_mask(w > 0)); /* a load only shifts the rest position */
        const exact_coefficients c = exact_coefficients_of(w, g / 2, splat(0), splat(b.t), loaded && !shifted);
        real x = exact_load(b.x, i, b.single), v = exact_load(b.v, i, b.single);
        if (b.target != NULL)
            follow_each(&b, i, &x, &v, w, a, &c, loaded);
        else
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

#include "../simd/target_end.h"
#endif
