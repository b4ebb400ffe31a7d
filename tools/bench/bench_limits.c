/* SPDX-License-Identifier: MIT */
/* The limits of batches and scenes, for each vector width and precision; kernels in bench_limits_kernels.h. GNU C. */
#include "bench_limits.h"

#include <math.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

/* An empty asm statement that could change a vector. It forces the compiler to have the vector in a register, and to
   keep the loads before and the stores after it. */
#if defined(__x86_64__)
#define TOUCH(vector) __asm__ volatile("" : "+v"(vector))
#elif defined(__aarch64__)
#define TOUCH(vector) __asm__ volatile("" : "+w"(vector))
#else
#define TOUCH(vector) __asm__ volatile("" : "+m"(vector)) /* through memory, which is slower */
#endif

#define INLINE static inline __attribute__((always_inline)) /* specialises kernels for constant flags */
#if defined(__clang__)
#define UNROLL _Pragma("clang loop unroll(full)")
#else
#define UNROLL _Pragma("GCC unroll 16")
#endif

/* Coefficients and initial state of a step: realistic in size, and unknown to the compiler. */
static volatile const double coefficient[] = {1e-4, 2.1e-4, 3.2e-6, 7.1e-5, 0.9999, -1.3e-5}, start[] = {0.83, -0.59};

#define PASTE(name, precision, bytes)  name##_##precision##_##bytes
#define PASTED(name, precision, bytes) PASTE(name, precision, bytes)
#define NAME(name)                     PASTED(name, SCALAR, BYTES)

#define SCALAR double
#define BYTES  16
#if defined(__x86_64__)
#define ROOT(a) _mm_sqrt_pd((__m128d)(a))
#endif
#include "bench_limits_kernels.h"
#define SCALAR float
#define BYTES  16
#if defined(__x86_64__)
#define ROOT(a) _mm_sqrt_ps((__m128)(a))
#endif
#include "bench_limits_kernels.h"

#if defined(__x86_64__)

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
#define SCALAR  double
#define BYTES   32
#define ROOT(a) _mm256_sqrt_pd((__m256d)(a))
#include "bench_limits_kernels.h"
#define SCALAR  float
#define BYTES   32
#define ROOT(a) _mm256_sqrt_ps((__m256)(a))
#include "bench_limits_kernels.h"
#if defined(__clang__)
#pragma clang attribute pop
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512dq")
#endif
#define SCALAR  double
#define BYTES   64
#define ROOT(a) _mm512_sqrt_pd((__m512d)(a))
#include "bench_limits_kernels.h"
#define SCALAR  float
#define BYTES   64
#define ROOT(a) _mm512_sqrt_ps((__m512)(a))
#include "bench_limits_kernels.h"
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif

const bench_limits *bench_limits_of(bool single)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        return single ? &limits_float_64 : &limits_double_64;
    if (__builtin_cpu_supports("avx2"))
        return single ? &limits_float_32 : &limits_double_32;
#endif
    return single ? &limits_float_16 : &limits_double_16;
}
