/* SPDX-License-Identifier: MIT */
/* Four numbers: the axes of one particle, side by side. Unused axes are 0. */
#ifndef SPRINGSTEP_QUAD_TMPL_H
#define SPRINGSTEP_QUAD_TMPL_H

#include "real_tmpl.h"

#if defined(SPRING_VECTOR) && SPRING_VECTORS
#if SPRING_VECTOR == 16 && !defined(SPRING_FLOAT)
#include "quad_pair_tmpl.h"
#else
#include "quad_vector_tmpl.h"
#endif
#else
#include "quad_number_tmpl.h"
#endif

SPRING_INLINE quad quad_all(scalar a)
{
    return quad_of(a, a, a, a);
}

/* The dot product over the three axes. */
SPRING_INLINE scalar quad_dot(quad a, quad b)
{
    const quad product = quad_times(a, b);
    return quad_at(product, 0) + quad_at(product, 1) + quad_at(product, 2);
}

/* Whether all four numbers are finite. */
SPRING_INLINE bool quad_finite(quad a)
{
    const quad zero = quad_minus(a, a);
    return quad_at(zero, 0) + quad_at(zero, 1) + (quad_at(zero, 2) + quad_at(zero, 3)) == 0;
}

SPRING_INLINE quad quad_load(const scalar *p) /* of any alignment */
{
    quad q;
    memcpy(&q, p, sizeof q);
    return q;
}

SPRING_INLINE void quad_store(scalar *p, quad q)
{
    memcpy(p, &q, sizeof q);
}

#endif
