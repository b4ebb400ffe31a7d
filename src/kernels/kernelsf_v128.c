/* SPDX-License-Identifier: MIT */
/* Kernels in vectors of 16 bytes, in float: SSE2 on x86-64, and for every other processor. */
#define SPRING_FLOAT
#define SPRING_VECTOR       16
#define SPRING_BATCH_TABLE  spring_batch_v128
#define SPRING_SCENE_TABLE  spring_scene_v128
#define SPRING_EXACT_KERNEL spring_exact_v128
#include "kernels.h"
