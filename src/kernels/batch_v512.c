/* SPDX-License-Identifier: MIT */
/* Batches, with SIMD vectors of 64 bytes: AVX-512. */
#include "../simd/targets.h"
#if SPRING_HAS_V512
#define SPRING_VECTOR       64
#define SPRING_BATCH_TABLE  spring_batch_v512
#define SPRING_EXACT_KERNEL spring_exact_v512
#include "batch_tmpl.h"
#endif
