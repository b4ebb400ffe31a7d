/* SPDX-License-Identifier: MIT */
/*
 * What the formulas compute with: `real`, one number for a single spring or a vector of them, one a spring, for a
 * batch.
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

#if defined(__GNUC__)
#define SPRING_INLINE              static inline __attribute__((always_inline)) /* constant flags vanish at -O1 too */
#define SPRING_NOINLINE            static __attribute__((noinline))             /* kept out of the code that runs */
#define SPRING_UNLIKELY(condition) __builtin_expect(condition, 0)
#define SPRING_PREFETCH(address)   __builtin_prefetch(address)
#else
#define SPRING_INLINE              static inline
#define SPRING_NOINLINE            static
#define SPRING_UNLIKELY(condition) (condition)
#define SPRING_PREFETCH(address)   (void)(address)
#endif

/* Before a loop whose arrays are to live in registers. */
#if defined(__clang__)
#define SPRING_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define SPRING_UNROLL _Pragma("GCC unroll 8")
#else
#define SPRING_UNROLL
#endif

/* Before a loop with a long body, which is to be there once. */
#if defined(__clang__)
#define SPRING_ROLLED _Pragma("clang loop unroll(disable)")
#elif defined(__GNUC__)
#define SPRING_ROLLED _Pragma("GCC unroll 1")
#else
#define SPRING_ROLLED
#endif

/* For tools/bench/instructions, which looks for it in the assembly: the innermost loop around this is a hot one, and a
   pass through it does so many ("link", 8) of a thing. It stands behind what ends a pass early. */
#ifdef SPRING_MCA
#define SPRING_HOT_LOOP(thing, count) __asm__ volatile("# hot loop: " thing " %c0" : : "i"(count))
#else
#define SPRING_HOT_LOOP(thing, count) ((void)0)
#endif

#ifdef SPRING_FLOAT
typedef float scalar;
typedef int32_t scalar_bits;
#else
typedef double scalar;
typedef int64_t scalar_bits;
#endif

SPRING_INLINE scalar scalar_sqrt(scalar a)
{
    return (scalar)spring_sqrt((double)a); /* in float rounded twice, which changes nothing for a square root */
}

#if defined(SPRING_VECTOR) && SPRING_VECTORS
#include "real_vector.h"
#else
#include "real_number.h"
#endif

SPRING_INLINE real vec_load(const scalar *p) /* of any alignment */
{
    real r;
    memcpy(&r, p, sizeof r);
    return r;
}

SPRING_INLINE void vec_store(scalar *p, real r)
{
    memcpy(p, &r, sizeof r);
}

/* In a loop that reads an array of which registers hold a part at best. Instructions of x86 read operands from memory at
   no cost; compilers would copy the array to another part of the stack before the loop. */
SPRING_INLINE void vec_read_again(const void *array)
{
#if SPRING_X86_64
    __asm__ volatile("" : : "r"(array) : "memory");
#else
    (void)array;
#endif
}

enum { lanes = sizeof(real) / sizeof(scalar) };

#endif
