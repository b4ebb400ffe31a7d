/* SPDX-License-Identifier: MIT */
/* Checks and sets the arithmetic that all sources require: IEEE 754 in the declared type, with one rounding per
   operation. Included first. */
#ifndef SPRINGSTEP_ARITHMETIC_H
#define SPRINGSTEP_ARITHMETIC_H

#include <float.h>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST)
#error "springstep promises the same bits everywhere and notices NaN: compile it without -ffast-math"
#endif
/* In GNU mode, gcc defines 16 for processors with half precision. This concerns _Float16; float and double are as with
   0. tcc does not define it; on x86-64, only long double is wider than declared. */
#if defined(FLT_EVAL_METHOD) ? FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16 : !defined(__x86_64__)
#error "springstep needs types as declared; 32-bit x86: -msse2 -mfpmath=sse, s390x: -fexcess-precision=fast"
#endif

/* A program that compiles src/ itself may lack -ffp-contract=off. gcc 12 ignores the standard pragma and contracts
   expressions in GNU mode. It also combines the loads of x and v into a wide load, which waits for the two narrow
   stores of the previous call: spring_advance() by one step took 15 ns instead of 9. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off", "no-tree-slp-vectorize")
#endif

#if defined(_MSC_VER)
#pragma fp_contract(off)
#endif

_Static_assert((long long)9007199254740991.0 == 9007199254740991,
               "springstep needs constants in double: compile it without -fsingle-precision-constant");

/* Linkage of names that the sources share and programs do not see: declarations, and definitions of tables. */
#ifndef SPRING_INTERNAL
#define SPRING_INTERNAL extern
#define SPRING_TABLE
#endif

/* Vector types of GNU C. On 32-bit ARM float vectors would use instructions that flush denormal numbers to 0. */
#ifndef SPRING_VECTORS
#if defined(__GNUC__) && !defined(__arm__)
#define SPRING_VECTORS 1
#else
#define SPRING_VECTORS 0
#endif
#endif

/* Whether single functions may be compiled for a different instruction set. */
#ifndef SPRING_X86_64
#if defined(__GNUC__) && defined(__x86_64__)
#define SPRING_X86_64 1
#else
#define SPRING_X86_64 0
#endif
#endif

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The square root, correctly rounded. sqrt() of mingw-w64's C library is not. */
#if defined(__GNUC__) && defined(__SSE2__)
#include <emmintrin.h>
#else
#include <math.h>
#endif
static inline double spring_sqrt(double a)
{
#if defined(__GNUC__) && defined(__SSE2__)
    const __m128d both = _mm_set1_pd(a); /* Valgrind 3.19 lacks an instruction that _mm_set_sd() may become */
    return _mm_cvtsd_f64(_mm_sqrt_sd(both, both));
#else
    return sqrt(a);
#endif
}

/* The macros of math.h would cause warnings with mingw-w64, that a double may become a float. */
static inline bool spring_finite(double a)
{
    return a - a == 0;
}

static inline bool spring_sign_bit(double a)
{
    uint64_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits >> 63 != 0;
}

#endif
