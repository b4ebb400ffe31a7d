/* SPDX-License-Identifier: MIT */
/* Which vectors does this processor have? */
#ifndef SPRINGSTEP_PROCESSOR_H
#define SPRINGSTEP_PROCESSOR_H

#include "arithmetic.h"

/* The first of the kernels for vectors of 16 bytes, or the widest that the processor has instructions for: AVX2 for 32,
   AVX-512 for 64. */
#if SPRING_X86_64
#define SPRING_BEST_KERNELS(v128, v256, v512)                                         \
    (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") ? (v512) \
     : __builtin_cpu_supports("avx2")                                        ? (v256) \
                                                                             : (v128))
#else
#define SPRING_BEST_KERNELS(v128, v256, v512) (v128)
#endif

#endif
