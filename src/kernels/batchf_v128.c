/* SPDX-License-Identifier: MIT */
/* Batches, in single precision, with SIMD vectors of 16 bytes: SSE2 on x86-64, and all other processors. */
#include "../simd/targets.h"
#if SPRING_HAS_V128
#define SPRING_FLOAT
#define SPRING_VECTOR       16
#define SPRING_BATCH_TABLE  spring_batch_v128
#define SPRING_EXACT_KERNEL spring_exact_v128
#include "batch_tmpl.h"
#endif
