/* SPDX-License-Identifier: MIT */
/*
 * Whether any link of a band is stretched beyond a limit: a fast test, after which the caller decides exactly.
 *
 * Method    length^2 is compared with (stretch rest)^2, without a root. Both have relative errors below 8 eps. The
 *           tolerance `nearly` is larger, so no link beyond the limit is missed.
 */
#ifndef SPRINGSTEP_STRETCH_TMPL_H
#define SPRINGSTEP_STRETCH_TMPL_H

#include "../simd/real_tmpl.h"
#include "scene_kernels.h"

SPRING_INLINE bool band_stretched(const scene_links *s, const scene_band *band, const scalar *x, real stretch)
{
    const real nearly = splat((scalar)(1 - 0x1p-18)); /* 1 - 4e-6: more than the rounding errors, also in float */
    const ptrdiff_t stride_c = band->coefficient_stride;
    mask longer = {0};
    for (ptrdiff_t t = band->start; t < band->end; t += (ptrdiff_t)lanes) {
        const ptrdiff_t slot = t - band->start;
        const real rest = vec_load(band->rest + slot * stride_c), bound = stretch * rest;
        real square = splat(0);
        SPRING_ROLLED
        for (uint32_t a = 0; a < s->axes; a++) {
            const scalar *const at = x + a * s->stride + t;
            const real delta = vec_load(at + band->offset) - vec_load(at);
            square += delta * delta;
        }
        const mask beyond = (rest != 0) & not_mask(square < nearly * (bound * bound));
        if (SPRING_UNLIKELY(any(beyond))) /* may include cut links */
            longer |= beyond & vec_load_mask(band->occupied + slot);
    }
    return any(longer);
}

static bool any_stretched(const scene_links *s, const scalar *x, scalar stretch)
{
    bool longer = false;
    for (size_t i = 0; i < s->bands && !longer; i++)
        longer = band_stretched(s, &s->band[i], x, splat(stretch));
    return longer;
}

#endif
