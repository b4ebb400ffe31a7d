/* SPDX-License-Identifier: MIT */
/* The exact solution of springs that share their parameters, and so their coefficients. With targets, one comparison
   for a group of springs usually shows that no spring lands. */
#ifndef SPRINGSTEP_EXACT_SHARED_TMPL_H
#define SPRINGSTEP_EXACT_SHARED_TMPL_H

#include "landing_tmpl.h"
#include "spring_group_tmpl.h"

SPRING_INLINE bool advance_shared(const batch_run *b, bool loaded)
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
            exact_step(&x[k], &v[k], loaded ? rate(b->accel, j) : splat(0), &c, loaded);
        }
        all &= store_group(b, i, b->x + i, b->v + i, x, v, vectors, (lane_mask){0});
    }
    return all;
}

/* The rest position; infinite if there is a load and no stiffness. */
SPRING_INLINE real follow_rest(real target, real a, real w)
{
    return select_real(a != 0, target + a / w, target);
}

/* If no |y| of a group is below relative * (the largest |x|) + absolute, no spring of the group lands or settles. This
   follows from |rest| <= |x| + |y| and d <= eps/2 |rest|, with a factor of 2 or more to spare. */
typedef struct follow_limit {
    real relative, absolute;
} follow_limit;

SPRING_INLINE follow_limit follow_limit_of(const exact_landing *b, scalar fraction)
{
    const bool single = sizeof(scalar) == sizeof(float);
    const scalar eps = single ? (scalar)FLT_EPSILON : (scalar)DBL_EPSILON;
    const scalar normal = single ? (scalar)FLT_MIN : (scalar)DBL_MIN, x_tol = (scalar)b->x_tol;
    const scalar distance = fraction > 0 ? 4 / fraction : 4; /* [eps |x|] */
    return (follow_limit){splat(distance * eps), splat(distance * normal + 2 * x_tol)};
}

/* A vector of springs with stiffness after a step, before it is stored. */
typedef struct followed {
    real x, v, y, rest;
} followed;

SPRING_INLINE followed follow_vector(const batch_run *b, size_t i, const follow_coefficients *c, bool loaded)
{
    const real target = vec_load(b->target + i);
    const real rest = loaded ? follow_rest(target, rate(b->accel, i), c->omega2) : target;
    real y = vec_load(b->x + i) - rest, u = vec_load(b->v + i);
    exact_step(&y, &u, splat(0), &c->exact, false);
    return (followed){rest + y, u, y, rest};
}

/* Advances a group whose springs may land or settle. Returns false if a spring keeps its state. */
SPRING_NOINLINE bool land_group(const batch_run *b, size_t i, const follow_coefficients *c)
{
    real x[vectors], v[vectors];
    for (size_t k = 0; k < vectors; k++) {
        const size_t j = i + k * lanes;
        const followed s = follow_vector(b, j, c, b->accel.first != NULL);
        x[k] = s.x;
        v[k] = s.v;
        *b->landing.moving += settle(&b->landing, j, &x[k], &v[k], s.y, s.rest, c, sizeof(scalar) == sizeof(float));
    }
    return store_group(b, i, b->x + i, b->v + i, x, v, vectors, (lane_mask){0});
}

/* Springs with equal coefficients, and with stiffness. unit: exact_coefficients.half is 1, as for most time steps. */
SPRING_INLINE bool follow_shared(const batch_run *run, bool unit)
{
    const batch_run b = *run; /* a local copy, so that stores cannot alias its fields */
    const bool loaded = b.accel.first != NULL;
    const bool single = sizeof(scalar) == sizeof(float);
    follow_coefficients c =
        follow_prepare(exact_prepare(b.propagator), splat(b.omega2.first[0]), splat((scalar)b.t), single);
    scalar fraction[lanes];
    vec_store(fraction, c.fraction);
    const follow_limit limit = follow_limit_of(&b.landing, fraction[0]);
    if (unit)
        c.exact.half = splat(1);
    size_t moving = 0;
    bool all = true;
    for (size_t i = 0; i < b.count; i += group) {
        real x[vectors], v[vectors], least_distance = splat((scalar)INFINITY), minus_largest = splat(0);
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++) {
            const followed s = follow_vector(&b, i + k * lanes, &c, loaded);
            x[k] = s.x;
            v[k] = s.v;
            least_distance = vec_min(vec_abs(s.y), least_distance);
            minus_largest = vec_min(vec_minus_abs(s.x), minus_largest);
        }
        if (SPRING_UNLIKELY(any(least_distance <= limit.absolute - limit.relative * minus_largest))) {
            all &= land_group(run, i, &c);
            continue;
        }
        moving += counted_from(&b.landing, i, group);
        all &= store_group(run, i, b.x + i, b.v + i, x, v, vectors, (lane_mask){0});
    }
    *b.landing.moving += moving;
    return all;
}

#endif
