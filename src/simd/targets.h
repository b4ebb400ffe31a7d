/* SPDX-License-Identifier: MIT */
/*
 * Instruction sets: which functions are compiled for which, and which of them this processor has.
 *
 * Targets are set by pragma, not by flags of the build, so the sources of src compile alone, without flags.
 */
#ifndef SPRINGSTEP_TARGETS_H
#define SPRINGSTEP_TARGETS_H

#include "arithmetic.h"

#if SPRING_X86_64
#include <immintrin.h> /* before a target is set: it sets its own */
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

/* Vectors longer than 16 bytes. gcc for Windows may keep them on the stack as if that were aligned to their length (GCC
   bug 54412; not every build of it has the mend). */
#if SPRING_X86_64 && !(defined(_WIN32) && !defined(__clang__))
#define SPRING_LONG_VECTORS 1
#else
#define SPRING_LONG_VECTORS 0
#endif

/* SPRING_TARGET_BEGIN ... SPRING_TARGET_END: functions between them use the instructions for vectors of SPRING_VECTOR
   bytes. SPRING_TARGET_EXISTS: there are such instructions. */
#if !defined(SPRING_VECTOR) || SPRING_VECTOR == 16
#define SPRING_TARGET_EXISTS 1
#define SPRING_TARGET_BEGIN
#define SPRING_TARGET_END
#elif !SPRING_LONG_VECTORS
#define SPRING_TARGET_EXISTS 0
#else
#define SPRING_TARGET_EXISTS 1
#if SPRING_VECTOR == 64
#define SPRING_TARGET "avx512f,avx512dq,avx512vl"
#else
#define SPRING_TARGET "avx2"
#endif
#define SPRING_PRAGMA(text) _Pragma(#text)
#if defined(__clang__)
#define SPRING_TARGET_PRAGMA(set) SPRING_PRAGMA(clang attribute push(__attribute__((target(set))), apply_to = function))
#define SPRING_TARGET_BEGIN       SPRING_TARGET_PRAGMA(SPRING_TARGET)
#define SPRING_TARGET_END         _Pragma("clang attribute pop")
#else
#define SPRING_TARGET_PRAGMA(set) _Pragma("GCC push_options") SPRING_PRAGMA(GCC target(set))
#define SPRING_TARGET_BEGIN       SPRING_TARGET_PRAGMA(SPRING_TARGET)
#define SPRING_TARGET_END         _Pragma("GCC pop_options")
#endif
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
