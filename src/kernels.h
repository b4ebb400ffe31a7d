/* SPDX-License-Identifier: MIT */
/*
 * All kernels for one vector length and precision: SPRING_VECTOR bytes, double or with SPRING_FLOAT float, under the
 * names SPRING_BATCH_TABLE and SPRING_SCENE_TABLE. Included once in each of kernels_v128.c, ..., kernelsf_v512.c.
 */
#define SPRING_SHAPE_BATCH
#include "simd/targets.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if SPRING_TARGET_EXISTS

/* How quads are passed depends on the target; they never are, and compilers warn all the same: gcc at the last line. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

SPRING_TARGET_BEGIN

#include "batch_kernels.h"
#include "methods.h"
#include "scene_kernels.h"

#define BATCH_ROW(value, method) [value] = method##_batch,
const batch_kernels SPRING_BATCH_TABLE = {.group = group, .method = {SPRING_METHODS(BATCH_ROW)}};

const scene_kernels SPRING_SCENE_TABLE = SCENE_KERNELS;

SPRING_TARGET_END

#endif
