/* SPDX-License-Identifier: MIT */
/* The exact solution of springs with different parameters, with SIMD vectors of 64 bytes: AVX-512. */
#include "../simd/targets.h"
#if SPRING_HAS_V512
#define SPRING_VECTOR       64
#define SPRING_EXACT_KERNEL spring_exact_v512
#include "exact_tmpl.h"
#endif
