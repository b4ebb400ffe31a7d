/* SPDX-License-Identifier: MIT */
/* The distance between the roots of a spring, on `real`, in double: see roots.h. */
#ifndef SPRINGSTEP_SPLIT_TMPL_H
#define SPRINGSTEP_SPLIT_TMPL_H

#include "../simd/elementary_tmpl.h"

#ifndef SPRING_FLOAT

/* split = sqrt |w - b^2|; overdamped: w < b^2 */
typedef struct spring_split {
    real split;
    lane_mask overdamped;
} spring_split;

/* rest: the rounding error of w - b^2, where w is omega^2 rounded */
SPRING_INLINE spring_split spring_split_of(real w, real b, real rest)
{
    real scale = splat(1), back = splat(1);
    const lane_mask large = (b > 0x1p400) | (w > 0x1p800), tiny = (b < 0x1p-400) & (w < 0x1p-800);
    if (SPRING_UNLIKELY(any(large | tiny))) { /* squares or their rounding errors might overflow or underflow */
        scale = select_real(large, splat(0x1p-700), select_real(tiny, splat(0x1p600), scale));
        back = select_real(large, splat(0x1p700), select_real(tiny, splat(0x1p-600), back));
    }
    const real c = b * scale, square = c * c;
    const real D = (((w * scale) * scale - square) - square_error(c, square)) + (rest * scale) * scale;
    return (spring_split){vec_sqrt(vec_abs(D)) * back, D < 0};
}

#endif

#endif
