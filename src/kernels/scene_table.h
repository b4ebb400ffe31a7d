/* SPDX-License-Identifier: MIT */
/* The table of the kernels of a scene, in the vectors that real.h is set to. */
#ifndef SPRINGSTEP_SCENE_TABLE_H
#define SPRINGSTEP_SCENE_TABLE_H

#include "links.h"
#include "particles.h"

/* In double quads are of 32 bytes, in float of 16. */
#if SPRING_VECTOR == 16
#define SPRING_SMALL_TABLE SPRING_SCENE_TABLE
#elif defined(SPRING_FLOAT)
#define SPRING_SMALL_TABLE spring_scene_v128
#else
#define SPRING_SMALL_TABLE spring_scene_v256
#endif

#define BAND_KERNELS(axes)                                                                                       \
    static void all_bands_##axes(const scene_links *s, const scalar *x, const scalar *v, size_t from, size_t to) \
    {                                                                                                            \
        all_bands(s, x, v, from, to, axes, false);                                                               \
    }                                                                                                            \
    static void all_bands_##axes##_damped(const scene_links *s, const scalar *x, const scalar *v, size_t from,   \
                                          size_t to)                                                             \
    {                                                                                                            \
        all_bands(s, x, v, from, to, axes, true);                                                                \
    }

BAND_KERNELS(1)
BAND_KERNELS(2)
BAND_KERNELS(3)

#define FORCE_KERNELS(kernel, axes)                                                              \
    static void kernel##_##axes(const scene_links *s, const scalar *x, const scalar *v)          \
    {                                                                                            \
        kernel(s, x, v, axes, false);                                                            \
    }                                                                                            \
    static void kernel##_##axes##_damped(const scene_links *s, const scalar *x, const scalar *v) \
    {                                                                                            \
        kernel(s, x, v, axes, true);                                                             \
    }

FORCE_KERNELS(all_edges, 1)
FORCE_KERNELS(all_edges, 2)
FORCE_KERNELS(all_edges, 3)

#define QUAD_KERNELS(kernel)                                                            \
    static void kernel##_plain(const scene_links *s, const scalar *x, const scalar *v)  \
    {                                                                                   \
        kernel(s, x, v, false);                                                         \
    }                                                                                   \
    static void kernel##_damped(const scene_links *s, const scalar *x, const scalar *v) \
    {                                                                                   \
        kernel(s, x, v, true);                                                          \
    }

QUAD_KERNELS(all_records)
QUAD_KERNELS(all_quads)

/* clang-format off */
#define FORCE_TABLE(kernel, axes) {kernel##_##axes, kernel##_##axes##_damped}
#define SCENE_KERNELS { \
    .small = &SPRING_SMALL_TABLE, \
    .bands = {FORCE_TABLE(all_bands, 1), FORCE_TABLE(all_bands, 2), FORCE_TABLE(all_bands, 3)}, \
    .edges = {FORCE_TABLE(all_edges, 1), FORCE_TABLE(all_edges, 2), FORCE_TABLE(all_edges, 3)}, \
    .records = {all_records_plain, all_records_damped}, \
    .quads = {all_quads_plain, all_quads_damped}, \
    .kick_drift = {{move_kick_drift, move_kick_drift_predict}, {move_kick_kick_drift, move_kick_kick_drift_predict}}, \
    .solved_kick = move_solved_kick, \
    .solved_kick_drift = move_solved_kick_drift, \
    .stage = move_stage, \
    .first_stage = move_first_stage, \
    .next_stage = move_next_stage, \
    .last_stage = move_last_stage, \
    .nystrom_stage = {move_nystrom_stage_1, move_nystrom_stage_2, move_nystrom_stage_3, move_nystrom_stage_4, \
                      move_nystrom_stage_5, move_nystrom_stage_6, move_nystrom_stage_7}, \
    .nystrom_end = move_nystrom_end, \
}
/* clang-format on */

#endif
