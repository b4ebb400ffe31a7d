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

/* The longest vectors in bits: 128, 256 (AVX2) or 512 (AVX-512). Shorter ones make the library smaller. */
#ifndef SPRING_MAX_VECTOR
#define SPRING_MAX_VECTOR 512
#elif SPRING_MAX_VECTOR != 128 && SPRING_MAX_VECTOR != 256 && SPRING_MAX_VECTOR != 512
#error "SPRING_MAX_VECTOR must be 128, 256 or 512"
#endif

/* The shortest vectors in bits: the program runs only on processors that the compiler flags allow. */
#if SPRING_LONG_VECTORS && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define SPRING_LEAST_VECTOR 512
#elif SPRING_LONG_VECTORS && defined(__AVX2__)
#define SPRING_LEAST_VECTOR 256
#else
#define SPRING_LEAST_VECTOR 128
#endif
#if SPRING_LEAST_VECTOR > SPRING_MAX_VECTOR
#error "the compiler flags require AVX2 or AVX-512, and SPRING_MAX_VECTOR excludes it"
#endif

/* Vector lengths that have kernels. Those of 256 bits are part of those of 512 bits. */
#define SPRING_HAS_V128 (SPRING_LEAST_VECTOR == 128)
#define SPRING_HAS_V256 (SPRING_LONG_VECTORS && SPRING_MAX_VECTOR >= 256)
#define SPRING_HAS_V512 (SPRING_LONG_VECTORS && SPRING_MAX_VECTOR == 512)

/* The widest of three tables of kernels that the processor supports: for vectors of 128, of 256 or of 512 bits. */
#define SPRING_RUNS_V512 (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
#define SPRING_RUNS_V256 __builtin_cpu_supports("avx2")
#if !SPRING_HAS_V256
#define SPRING_BEST_KERNELS(v128, v256, v512) (v128)
#elif SPRING_LEAST_VECTOR == 512
#define SPRING_BEST_KERNELS(v128, v256, v512) (v512)
#elif SPRING_LEAST_VECTOR == 256 && !SPRING_HAS_V512
#define SPRING_BEST_KERNELS(v128, v256, v512) (v256)
#elif SPRING_LEAST_VECTOR == 256
#define SPRING_BEST_KERNELS(v128, v256, v512) (SPRING_RUNS_V512 ? (v512) : (v256))
#elif !SPRING_HAS_V512
#define SPRING_BEST_KERNELS(v128, v256, v512) (SPRING_RUNS_V256 ? (v256) : (v128))
#else
#define SPRING_BEST_KERNELS(v128, v256, v512) (SPRING_RUNS_V512 ? (v512) : SPRING_RUNS_V256 ? (v256) : (v128))
#endif

#endif
