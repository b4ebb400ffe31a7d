/* SPDX-License-Identifier: MIT */
/*
 * What the formulas compute with: `real`, one number for a single spring or a vector of them, one a spring, for a batch.
 *
 * The file that includes this decides: SPRING_FLOAT for float instead of double, SPRING_VECTOR for vectors of so many
 * bytes. Lane by lane every operation is the scalar one, so a spring has the same bits in any lane of any vector.
 * Compilers without vectors of the GNU kind get one number, and whatever their loops make of it.
 */
#ifndef SPRINGSTEP_REAL_H
#define SPRINGSTEP_REAL_H

#include "arithmetic.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(SPRING_VECTOR) && SPRING_X86_64
#include <immintrin.h>
#endif

#if defined(__GNUC__)
#define SPRING_INLINE static inline __attribute__((always_inline)) /* constant flags must vanish at -O1 too */
#else
#define SPRING_INLINE static inline
#endif

/* Before a loop whose arrays are to live in registers. */
#if defined(__clang__)
#define SPRING_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define SPRING_UNROLL _Pragma("GCC unroll 8")
#else
#define SPRING_UNROLL
#endif

#ifdef SPRING_FLOAT
typedef float scalar;
typedef int32_t scalar_bits;
#else
typedef double scalar;
typedef int64_t scalar_bits;
#endif

#if defined(SPRING_VECTOR) && defined(__GNUC__)

typedef scalar real __attribute__((vector_size(SPRING_VECTOR)));
typedef scalar_bits truth
    __attribute__((vector_size(SPRING_VECTOR))); /* of a comparison: -1 or 0 in each lane */

SPRING_INLINE real splat(scalar s)
{
    return s - (real){0}; /* -0.0 stays -0.0 */
}

/* Not 0 in the lanes that are infinite or NaN. */
SPRING_INLINE truth not_finite(real a)
{
    return (truth)(a - a);
}

/* Is any bit set? */
SPRING_INLINE bool any(truth t)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64
    return _mm512_test_epi64_mask((__m512i)t, (__m512i)t) != 0;
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return !_mm256_testz_si256((__m256i)t, (__m256i)t);
#elif SPRING_X86_64
    return _mm_movemask_epi8(_mm_cmpeq_epi8((__m128i)t, _mm_setzero_si128())) != 0xffff;
#else
    uint64_t part[sizeof t / sizeof(uint64_t)], all = 0;
    memcpy(part, &t, sizeof t);
    for (size_t i = 0; i < sizeof part / sizeof part[0]; i++)
        all |= part[i];
    return all != 0;
#endif
}

SPRING_INLINE real select_real(truth t, real a, real b)
{
    return (real)((t & (truth)a) | (~t & (truth)b));
}

/* From a byte a lane, -1 or 0. */
SPRING_INLINE truth load_truth(const int8_t *p)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64 && defined(SPRING_FLOAT)
    return (truth)_mm512_cvtepi8_epi32(_mm_loadu_si128((const __m128i *)p));
#elif SPRING_X86_64 && SPRING_VECTOR == 64
    return (truth)_mm512_cvtepi8_epi64(_mm_loadl_epi64((const __m128i *)p));
#elif SPRING_X86_64 && SPRING_VECTOR == 32 && defined(SPRING_FLOAT)
    return (truth)_mm256_cvtepi8_epi32(_mm_loadl_epi64((const __m128i *)p));
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    int four;
    memcpy(&four, p, sizeof four);
    return (truth)_mm256_cvtepi8_epi64(_mm_cvtsi32_si128(four));
#else
    truth t;
    for (size_t i = 0; i < sizeof t / sizeof(scalar); i++)
        t[i] = p[i];
    return t;
#endif
}

SPRING_INLINE real root(real a)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64 && defined(SPRING_FLOAT)
    return (real)_mm512_sqrt_ps((__m512)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 64
    return (real)_mm512_sqrt_pd((__m512d)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 32 && defined(SPRING_FLOAT)
    return (real)_mm256_sqrt_ps((__m256)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return (real)_mm256_sqrt_pd((__m256d)a);
#elif SPRING_X86_64 && defined(SPRING_FLOAT)
    return (real)_mm_sqrt_ps((__m128)a);
#elif SPRING_X86_64
    return (real)_mm_sqrt_pd((__m128d)a);
#else
    scalar each[sizeof a / sizeof(scalar)];
    memcpy(each, &a, sizeof a);
    for (size_t i = 0; i < sizeof each / sizeof each[0]; i++)
        each[i] = (scalar)sqrt((double)each[i]); /* rounding twice changes nothing for a square root */
    memcpy(&a, each, sizeof a);
    return a;
#endif
}

SPRING_INLINE real magnitude(real a)
{
    return (real)(~(truth)splat(-(scalar)0) & (truth)a);
}

#else

typedef scalar real;
typedef bool truth;

SPRING_INLINE real splat(scalar s)
{
    return s;
}

SPRING_INLINE truth not_finite(real a)
{
    return !(a - a == 0);
}

SPRING_INLINE bool any(truth t)
{
    return t;
}

SPRING_INLINE real select_real(truth t, real a, real b)
{
    return t ? a : b;
}

SPRING_INLINE truth load_truth(const int8_t *p)
{
    return *p != 0;
}

SPRING_INLINE real root(real a)
{
    return (real)sqrt((double)a);
}

SPRING_INLINE real magnitude(real a)
{
    return (real)fabs((double)a);
}

#endif

SPRING_INLINE real load(const scalar *p) /* of any alignment */
{
    real r;
    memcpy(&r, p, sizeof r);
    return r;
}

SPRING_INLINE void store(scalar *p, real r)
{
    memcpy(p, &r, sizeof r);
}

enum { lanes = sizeof(real) / sizeof(scalar) };

/* What a stepper works from. Here and in the coefficients made of them, adding 0 turns -0 into 0: a zero feature then
   has one sign, and the long formulas of the steppers give the bits of the short ones (tests/test_shapes.c). */
typedef struct spring_rates {
    real w; /* [1/s^2] stiffness/mass */
    real g; /* [1/s]   damping/mass   */
    real a; /* [m/s^2] load/mass      */
} spring_rates;

/* What is written once for all methods is included with SPRING_METHOD set to one, and names its parts so. */
#define SPRING_PASTE(method, name)  method##_##name
#define SPRING_PASTED(method, name) SPRING_PASTE(method, name)
#define METHOD(name)                SPRING_PASTED(SPRING_METHOD, name)

#endif
