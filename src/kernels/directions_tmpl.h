/* SPDX-License-Identifier: MIT */
/* The directions of banded links at given positions, for damping along frozen directions; see scene/chebyshev.h. */
#ifndef SPRINGSTEP_DIRECTIONS_TMPL_H
#define SPRINGSTEP_DIRECTIONS_TMPL_H

#include "../simd/real_tmpl.h"
#include "scene_kernels.h"

/* See direction_kernel. */
SPRING_INLINE void all_band_directions(const scene_links *s, const scalar *x, scalar *direction, uint32_t axes)
{
    for (const scene_band *band = s->band; band < s->band + s->bands; band++) {
        scalar *const of_band = direction + (band->direction - s->band[0].direction);
        for (size_t j = 0; j < (size_t)(band->end - band->start); j += lanes) {
            const mask joined = vec_load_mask(band->occupied + j);
            real root = vec_sqrt(vec_load(band->damping + (ptrdiff_t)j * band->coefficient_stride));
            real delta[3], inverse = splat(0);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                const scalar *const at = x + a * s->stride + band->start + j;
                delta[a] = vec_load(at + band->offset) - vec_load(at);
                inverse += delta[a] * delta[a];
            }
            if (axes > 1)
                vec_inverse_sqrt(&inverse, &joined, 1);
            if (s->tension_only) { /* a slack link is not damped */
                const real rest = vec_load(band->rest + (ptrdiff_t)j * band->coefficient_stride);
                root = select_real(rest * inverse < 1, root, splat(0));
            }
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                vec_store(of_band + a * band->direction_stride + j,
                          select_real(joined, axes == 1 ? root : root * (inverse * delta[a]), splat(0)));
        }
    }
}

static void compute_band_directions(const scene_links *s, const scalar *x, scalar *direction)
{
    if (s->axes == 1)
        all_band_directions(s, x, direction, 1);
    else if (s->axes == 2)
        all_band_directions(s, x, direction, 2);
    else
        all_band_directions(s, x, direction, 3);
}

#endif
