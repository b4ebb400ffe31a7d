/* SPDX-License-Identifier: MIT */
/*
 * `real`, the type in which formulas are written: one number, or a SIMD vector of springs, links or coordinates.
 *
 * The including file defines SPRING_FLOAT for float instead of double, and SPRING_VECTOR as the size of a vector in
 * bytes. In each lane, every operation is the scalar operation, so results are bit-identical in any lane of any vector.
 * With compilers that lack the vector types of GNU C, `real` is one number.
 */
#ifndef SPRINGSTEP_REAL_TMPL_H
#define SPRINGSTEP_REAL_TMPL_H

#include "arithmetic.h"
#include "compiler.h"
#include "scalar.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

SPRING_INLINE scalar scalar_sqrt(scalar a)
{
    return (scalar)spring_sqrt((double)a); /* in float rounded twice, which does not change a square root */
}

#if defined(SPRING_VECTOR) && SPRING_VECTORS
#include "real_vector_tmpl.h"
#else
#include "real_number_tmpl.h"
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

/* Placed in a loop that reads an array which is too large for the registers. x86 instructions read operands from memory
   at no cost, but compilers would copy the array to another place on the stack before the loop. */
SPRING_INLINE void vec_keep_in_memory(const void *array)
{
#if SPRING_X86_64
    __asm__ volatile("" : : "r"(array) : "memory");
#else
    (void)array;
#endif
}

enum { lanes = sizeof(real) / sizeof(scalar) };

#endif
