/* SPDX-License-Identifier: MIT */
/* The type that springs are stored in: double, or float with SPRING_FLOAT. */
#ifndef SPRINGSTEP_SCALAR_H
#define SPRINGSTEP_SCALAR_H

#include "arithmetic.h"

#include <float.h>
#include <stdint.h>

#ifdef SPRING_FLOAT
typedef float scalar;
typedef int32_t scalar_bits;
#else
typedef double scalar;
typedef int64_t scalar_bits;
#endif

/* The largest finite number. */
#define SCALAR_MAX (sizeof(scalar) == sizeof(float) ? (scalar)FLT_MAX : (scalar)DBL_MAX)

#define SCALAR_EPSILON (sizeof(scalar) == sizeof(float) ? (scalar)FLT_EPSILON : (scalar)DBL_EPSILON)

static inline bool scalar_finite(scalar a)
{
    return a - a == 0;
}

#endif
