/* SPDX-License-Identifier: MIT */
/*
 * All kernels for one vector length and precision: SPRING_VECTOR bytes, double or with SPRING_FLOAT float, under the
 * names SPRING_BATCH_TABLE and SPRING_SCENE_TABLE. Included once in each of kernels_v128.c, ..., kernelsf_v512.c.
 */
#ifndef SPRING_NO_BATCH
#define SPRING_SHAPE_BATCH
#endif

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "simd/target_begin.h"

#include "methods.h"
#include "scene_table.h"

#ifndef SPRING_NO_BATCH
#define BATCH_ROW(value, method) [value] = method##_batch,
SPRING_TABLE const batch_kernels SPRING_BATCH_TABLE = {.group_size = group, .method = {SPRING_METHODS(BATCH_ROW)}};
#endif

#ifndef SPRING_NO_SCENE
SPRING_TABLE const scene_kernels SPRING_SCENE_TABLE = SCENE_KERNELS;
#endif

#include "simd/target_end.h"
