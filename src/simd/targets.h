/* SPDX-License-Identifier: MIT */
/* Instruction sets: those with kernels, and those of this processor. */
#ifndef SPRINGSTEP_TARGETS_H
#define SPRINGSTEP_TARGETS_H

#include "arithmetic.h"

#if SPRING_X86_64
#include <immintrin.h> /* before a target is set: it sets its own */
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

/* Vectors longer than 16 bytes. gcc for Windows may keep them on the stack as if that were aligned to their length (GCC
   bug 54412; not every build of it has the fix). */
#if SPRING_X86_64 && !(defined(_WIN32) && !defined(__clang__))
#define SPRING_LONG_VECTORS 1
#else
#define SPRING_LONG_VECTORS 0
#endif

/* Of three tables of kernels, for vectors of 16, 32 and 64 bytes, the widest that the processor has instructions for:
   AVX2 for 32, AVX-512 for 64. */
#if SPRING_LONG_VECTORS
#define SPRING_BEST_KERNELS(v128, v256, v512)                                          \
    (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") ? (v512) \
     : __builtin_cpu_supports("avx2")                                         ? (v256) \
                                                                              : (v128))
#else
#define SPRING_BEST_KERNELS(v128, v256, v512) (v128)
#endif

#endif
