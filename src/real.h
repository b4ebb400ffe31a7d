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
#include "real_vector.h"
#else
#include "real_number.h"
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
