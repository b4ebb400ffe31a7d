/* SPDX-License-Identifier: MIT */
/* Kernels with SIMD vectors of 64 bytes, single precision: AVX-512. */
#include "../simd/targets.h"
#if SPRING_HAS_V512
#define SPRING_FLOAT
#define SPRING_VECTOR       64
#define SPRING_BATCH_TABLE  spring_batch_v512
#define SPRING_SCENE_TABLE  spring_scene_v512
#define SPRING_COMMON_TABLE spring_common_v256
#define SPRING_EXACT_KERNEL spring_exact_v512
#include "kernels.h"
#endif
