/* SPDX-License-Identifier: MIT */
/*
 * All kernels for one vector width and precision: SPRING_VECTOR bytes, double or with SPRING_FLOAT float, as the tables
 * SPRING_BATCH_TABLE and SPRING_SCENE_TABLE. Included by the sources of this folder.
 */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "../simd/target_begin.h"

#ifndef SPRING_NO_BATCH
#include "springs.h"
SPRING_TABLE const batch_kernels SPRING_BATCH_TABLE = {.group_size = group, .advance = advance_springs};
#endif

#ifndef SPRING_NO_SCENE
#include "bands.h"
#include "particles.h"
#include "unbanded.h"

/* Quads have 32 bytes in double and 16 in float. */
#if SPRING_VECTOR == 16
#define SMALL_TABLE SPRING_SCENE_TABLE
#elif defined(SPRING_FLOAT)
#define SMALL_TABLE spring_scene_v128
#else
#define SMALL_TABLE spring_scene_v256
#endif

SPRING_TABLE const scene_kernels SPRING_SCENE_TABLE = {
    .small = &SMALL_TABLE,
    .band_forces = band_forces,
    .unbanded_forces = unbanded_forces,
    .record_forces = record_forces,
    .quad_forces = quad_forces,
    .kick_drift = kick_drift,
    .implicit_kick = implicit_kick,
    .implicit_kick_drift = implicit_kick_drift,
    .stage = stage,
    .first_stage = first_stage,
    .next_stage = next_stage,
    .last_stage = last_stage,
    .nystrom_stage = nystrom_stage,
    .nystrom_end = nystrom_end,
};
#endif

#include "../simd/target_end.h"
