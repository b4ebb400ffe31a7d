/* SPDX-License-Identifier: MIT */
/*
 * All kernels for one vector length and precision: SPRING_VECTOR bytes, double or with SPRING_FLOAT float, under the
 * names SPRING_BATCH_TABLE and SPRING_SCENE_TABLE. Included once in each of kernels_v128.c, ..., kernelsf_v512.c.
 */
#define SPRING_SHAPE_BATCH

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* How quads are passed depends on the target; they never are, and compilers warn all the same: gcc at the last line. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

#include "simd/target_begin.h"

#include "methods.h"
#include "scene_table.h"

#define BATCH_ROW(value, method) [value] = method##_batch,
SPRING_TABLE const batch_kernels SPRING_BATCH_TABLE = {.group = group, .method = {SPRING_METHODS(BATCH_ROW)}};

SPRING_TABLE const scene_kernels SPRING_SCENE_TABLE = SCENE_KERNELS;

#include "simd/target_end.h"
