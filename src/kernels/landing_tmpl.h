/* SPDX-License-Identifier: MIT */
/* Springs that follow targets: follow_formula_tmpl.h on SIMD vectors. A spring is placed on its target if it lands, as
   in spring_follow(), or if it is within the tolerances. Springs that are not at rest on their targets are counted. */
#ifndef SPRINGSTEP_LANDING_TMPL_H
#define SPRINGSTEP_LANDING_TMPL_H

#include "../spring/follow_formula_tmpl.h"
#include "../spring/propagator.h"

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
    lane_mask rests = (vec_abs(*x - rest) <= (scalar)b->x_tol) & (vec_abs(*v) <= (scalar)b->v_tol);
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

#endif
