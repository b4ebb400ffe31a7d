/* SPDX-License-Identifier: MIT */
/* Springs of a batch that follow targets: follow_formula.h on SIMD vectors. A spring lands as a single one does, and if it
   is within the tolerances. The springs that do not rest on their targets are counted. */
#ifndef SPRINGSTEP_FOLLOW_SPRINGS_H
#define SPRINGSTEP_FOLLOW_SPRINGS_H

#include "../spring/follow_formula.h"
#include "spring_group.h"

/* Of `many` springs from spring i on, those that are counted. */
SPRING_INLINE size_t counted_from(const exact_landing *b, size_t i, size_t many)
{
    return i >= b->counted ? 0 : b->counted - i < many ? b->counted - i : many;
}

/* Places the springs of a vector that have settled on their targets. Returns the number of others. NaN never settles. */
SPRING_INLINE size_t settle(const exact_landing *b, size_t i, real *x, real *v, real rest)
{
    size_t moving = counted_from(b, i, lanes);
    const mask settled = (vec_abs(*x - rest) <= (scalar)b->x_tol) & (vec_abs(*v) <= (scalar)b->v_tol);
    if (!any(settled))
        return moving;
    scalar has_settled[lanes];
    vec_store(has_settled, select_real(settled, splat(1), splat(0)));
    for (size_t k = moving; k-- > 0;)
        moving -= has_settled[k] > 0;
    *x = select_real(settled, rest, *x);
    *v = select_real(settled, splat(0), *v);
    return moving;
}

/* The rest position. Without stiffness a load leaves none: infinite. */
SPRING_INLINE real follow_rest(real target, real a, real w)
{
    return select_real(a != 0, target + a / w, target);
}

/* Where |y| is larger, a spring neither lands nor settles: limit = slope |rest| + least. From |x| <= (1 + eps) (|rest| + |y|)
   and d <= eps/2 |x|, with factors of 2 to spare; and from share >= 32 eps, else the limit is infinite. */
typedef struct follow_limit {
    real slope, least;
} follow_limit;

SPRING_INLINE follow_limit follow_limit_of(const exact_landing *b, scalar share)
{
    const bool single = sizeof(scalar) == sizeof(float);
    const scalar eps = single ? (scalar)FLT_EPSILON : (scalar)DBL_EPSILON;
    const scalar normal = single ? (scalar)FLT_MIN : (scalar)DBL_MIN, x_tol = (scalar)b->x_tol;
    if (share > 0 && share < 32 * eps)
        return (follow_limit){splat(0), splat(INFINITY)};
    const scalar per_share = share > 0 ? 4 / share : 4;
    return (follow_limit){splat(per_share * eps), splat(per_share * normal + 2 * x_tol)};
}

/* A group of which some springs may land or settle. Returns the number of springs that still move. */
SPRING_NOINLINE size_t land_group(const exact_landing *b, size_t i, real *x, real *v, const real *y, const real *rest,
                                  const follow_coefficients *c)
{
    size_t moving = 0;
    for (size_t k = 0; k < vectors; k++) {
        const mask lands = follow_lands(x[k], rest[k], y[k], v[k], c, sizeof(scalar) == sizeof(float));
        x[k] = select_real(lands, rest[k], x[k]);
        v[k] = select_real(lands, splat(0), v[k]);
        moving += settle(b, i + k * lanes, &x[k], &v[k], rest[k]);
    }
    return moving;
}

/* Springs with equal coefficients and stiffness. */
SPRING_INLINE bool follow_alike(const batch_run *run, bool loaded)
{
    const batch_run b = *run; /* a local copy, so that stores cannot alias its fields */
    const real w = splat(b.omega2.first[0]);
    const follow_coefficients c = follow_prepare(exact_prepare(b.propagator), w, splat((scalar)b.t));
    scalar share[lanes];
    vec_store(share, c.share);
    const follow_limit limit = follow_limit_of(&b.landing, share[0]);
    size_t moving = 0;
    bool all = true;
    for (size_t i = 0; i < b.count; i += group) {
        real x[vectors], v[vectors], y[vectors], rest[vectors];
        mask near = {0};
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++) {
            const size_t j = i + k * lanes;
            const real target = vec_load(b.target + j);
            rest[k] = loaded ? follow_rest(target, rate(b.accel, j), w) : target;
            y[k] = vec_load(b.x + j) - rest[k];
            v[k] = vec_load(b.v + j);
            exact_step(&y[k], &v[k], splat(0), &c.exact, false);
            x[k] = rest[k] + y[k];
            near |= vec_abs(y[k]) <= limit.slope * vec_abs(rest[k]) + limit.least;
        }
        if (SPRING_UNLIKELY(any(near)))
            moving += land_group(&b.landing, i, x, v, y, rest, &c);
        else
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

/* a, or with `single` a as a float */
SPRING_INLINE real rounded(real a, bool single)
{
    float each[lanes];
    if (!single)
        return a;
    vec_store_float(each, a);
    return vec_load_float(each);
}

/* A vector of springs with coefficients of their own, from spring i on. The rest position is rounded as in
   follow_alike(). A spring without stiffness is measured from where it is; its target has to be finite. */
SPRING_INLINE void follow_each(const exact_run *b, size_t i, real *x, real *v, real w, real a,
                               const exact_coefficients *exact, bool loaded)
{
    const mask is_free = w == 0;
    const real target = exact_load(b->target, i, b->single);
    const real shift = rounded(a / w, b->single), rest = rounded(select_real(a != 0, target + shift, target), b->single);
    const real to = select_real(is_free, target - target, rest);
    const follow_coefficients c = follow_prepare(*exact, w, splat(b->t));
    real y = *x - to;
    exact_step(&y, v, select_real(is_free, a, splat(0)), exact, loaded);
    *x = to + y;
    const mask lands = follow_lands(*x, to, y, *v, &c, b->single);
    *x = select_real(lands, to, *x);
    *v = select_real(lands, splat(0), *v);
    *b->landing.moving += settle(&b->landing, i, x, v, rest);
}
#endif

#endif
