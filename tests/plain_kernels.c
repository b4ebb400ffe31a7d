/* SPDX-License-Identifier: MIT */
/*
 * The kernels as compiled by compilers without the vector extensions of GNU C: `real` is one number
 * (simd/real_number_tmpl.h). System and library headers are included first, since they depend on the actual compiler.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <springstep/batch.h>
#include <springstep/scene.h>

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical" /* a mask is a bool here */
#elif defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" /* loops over axes are not unrolled: gcc 12 doubts them */
#endif
#undef __clang__
#undef __GNUC__
#include "spring/propagator.h"
#define SPRING_VECTOR       16
#define SPRING_BATCH_TABLE  plain_batch
#define SPRING_SCENE_TABLE  plain_scene
#define SPRING_COMMON_TABLE plain_common
#define SPRING_EXACT_KERNEL plain_exact /* one, in double, for both precisions */
extern exact_kernel plain_exact;
#include "kernels/batch_tmpl.h"
#include "kernels/scene_tmpl.h"
#ifndef SPRING_FLOAT
#include "kernels/exact_tmpl.h"
#endif
