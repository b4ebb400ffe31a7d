/* SPDX-License-Identifier: MIT */
/*
 * The kernels as compilers without vectors of GNU C compile them: `real` is one number (real_number.h). The headers of the
 * system and of the library come first, since they need to know their compiler; KERNELS is one of the files of src/.
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
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical" /* a truth is a bool here */
#elif defined(__GNUC__)
#pragma GCC diagnostic ignored \
    "-Wmaybe-uninitialized" /* loops over axes are not unrolled: gcc 12 doubts them */
#endif
#undef __clang__
#undef __GNUC__
#define spring_batch_v128  plain_batch
#define spring_batchf_v128 plain_batch
#define spring_scene_v128  plain_scene
#define spring_scenef_v128 plain_scene
#include KERNELS
