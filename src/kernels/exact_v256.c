/* SPDX-License-Identifier: MIT */
/* The exact solution of springs with different parameters, with SIMD vectors of 32 bytes: AVX2. */
#include "../simd/targets.h"
#if SPRING_HAS_V256
#define SPRING_VECTOR       32
#define SPRING_EXACT_KERNEL spring_exact_v256
#include "exact_tmpl.h"
#endif
