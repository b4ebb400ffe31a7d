/* SPDX-License-Identifier: MIT */
/* Springs of a batch that follow targets: follow_formula.h on SIMD vectors. A spring is placed on its target if it
   lands, as in spring_follow(), or if it is within the tolerances. Springs that are not at rest on their targets are
   counted. */
#ifndef SPRINGSTEP_FOLLOW_SPRINGS_H
#define SPRINGSTEP_FOLLOW_SPRINGS_H

#include "../spring/follow_formula.h"
#include "spring_group.h"

/* The number of springs that are counted, of `many` springs from spring i on. */
SPRING_INLINE size_t counted_from(const exact_landing *b, size_t i, size_t many)
{
    return i >= b->counted ? 0 : b->counted - i < many ? b->counted - i : many;
}

/* Places the springs of a vector that land or have settled on their targets. Returns the number of other springs,
   including NaN. */
SPRING_INLINE size_t settle(const exact_landing *b, size_t i, real *x, real *v, real y, real rest,
                            const follow_coefficients *c, bool single)
{
    size_t moving = counted_from(b, i, lanes);
    mask rests = (vec_abs(*x - rest) <= (scalar)b->x_tol) & (vec_abs(*v) <= (scalar)b->v_tol);
    if (any(not_mask(rests)))
        rests = rests | follow_lands(*x, rest, y, *v, c, single);
    if (!any(rests))
        return moving;
    *x = select_real(rests, rest, *x);
    *v = select_real(rests, splat(0), *v);
    if (!any(not_mask(rests)))
        return 0;
    scalar one[lanes];
    vec_store(one, select_real(rests, splat(1), splat(0)));
    for (size_t k = moving; k-- > 0;)
        moving -= one[k] > 0;
    return moving;
}

/* The rest position; infinite if there is a load and no stiffness. */
SPRING_INLINE real follow_rest(real target, real a, real w)
{
    return select_real(a != 0, target + a / w, target);
}

/* If no |y| of a group is below slope * (the largest |x|) + least, no spring of the group lands or settles. This
   follows from |rest| <= |x| + |y| and d <= eps/2 |rest|, with a factor of 2 or more to spare. */
typedef struct follow_limit {
    real slope, least;
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
    return store_group(b, i, b->x + i, b->v + i, x, v, vectors, (mask){0});
}

/* Springs with equal coefficients, and with stiffness. unit: exact_coefficients.half is 1, as for most time steps. */
SPRING_INLINE bool follow_alike(const batch_run *run, bool unit)
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
        if (SPRING_UNLIKELY(any(least_distance <= limit.least - limit.slope * minus_largest))) {
            all &= land_group(run, i, &c);
            continue;
        }
        moving += counted_from(&b.landing, i, group);
        all &= store_group(run, i, b.x + i, b.v + i, x, v, vectors, (mask){0});
    }
    *b.landing.moving += moving;
    return all;
}

#ifndef SPRING_FLOAT
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

/* A vector of springs with different coefficients, from spring i on. The rest position is rounded as in follow_alike().
   For a spring without stiffness, y = x, or NaN if the target is not finite. */
SPRING_INLINE void follow_each(const exact_run *b, size_t i, real *x, real *v, real w, real a,
                               const exact_coefficients *exact, bool loaded)
{
    const mask is_free = w == 0;
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
#endif

#endif
