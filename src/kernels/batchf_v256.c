/* SPDX-License-Identifier: MIT */
/* Batches, in single precision, with SIMD vectors of 32 bytes: AVX2. */
#include "../simd/targets.h"
#if SPRING_HAS_V256
#define SPRING_FLOAT
#define SPRING_VECTOR       32
#define SPRING_BATCH_TABLE  spring_batch_v256
#define SPRING_EXACT_KERNEL spring_exact_v256
#include "batch_tmpl.h"
#endif
