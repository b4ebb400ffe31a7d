/* SPDX-License-Identifier: MIT */
/* Instruction sets that have kernels, and the choice for this processor. */
#ifndef SPRINGSTEP_TARGETS_H
#define SPRINGSTEP_TARGETS_H

#include "arithmetic.h"

#if SPRING_X86_64
#include <immintrin.h> /* before a target is set, since it sets its own */
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

/* Vectors longer than 16 bytes. gcc for Windows may keep them on the stack without the alignment that it assumes (GCC
   bug 54412; not every build has the fix). */
#if SPRING_X86_64 && !(defined(_WIN32) && !defined(__clang__))
#define SPRING_LONG_VECTORS 1
#else
#define SPRING_LONG_VECTORS 0
#endif

/* The widest of three tables of kernels that the processor supports: for vectors of 16, of 32 (AVX2) or of 64 bytes
   (AVX-512). */
#if SPRING_LONG_VECTORS
#define SPRING_BEST_KERNELS(v128, v256, v512)                                          \
    (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") ? (v512) \
     : __builtin_cpu_supports("avx2")                                         ? (v256) \
                                                                              : (v128))
#else
#define SPRING_BEST_KERNELS(v128, v256, v512) (v128)
#endif

#endif
