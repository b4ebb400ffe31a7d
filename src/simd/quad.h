/* SPDX-License-Identifier: MIT */
/* Four numbers: the axes of one particle, side by side; those it does not have are 0. */
#ifndef SPRINGSTEP_QUAD_H
#define SPRINGSTEP_QUAD_H

#include "real.h"

enum { quad_size = 4 };

#if defined(SPRING_VECTOR) && defined(__GNUC__)
typedef scalar quad __attribute__((vector_size(quad_size * sizeof(scalar))));

SPRING_INLINE quad quad_plus(quad a, quad b)
{
    return a + b;
}

SPRING_INLINE quad quad_minus(quad a, quad b)
{
    return a - b;
}

SPRING_INLINE quad quad_times(scalar s, quad a)
{
    return s * a;
}

SPRING_INLINE scalar quad_dot(quad a, quad b)
{
    const quad product = a * b;
    return product[0] + product[1] + product[2];
}
#else
typedef struct quad {
    scalar of[quad_size];
} quad;

SPRING_INLINE quad quad_plus(quad a, quad b)
{
    return (quad){{a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2], 0}};
}

SPRING_INLINE quad quad_minus(quad a, quad b)
{
    return (quad){{a.of[0] - b.of[0], a.of[1] - b.of[1], a.of[2] - b.of[2], 0}};
}

SPRING_INLINE quad quad_times(scalar s, quad a)
{
    return (quad){{s * a.of[0], s * a.of[1], s * a.of[2], 0}};
}

SPRING_INLINE scalar quad_dot(quad a, quad b)
{
    return a.of[0] * b.of[0] + a.of[1] * b.of[1] + a.of[2] * b.of[2];
}
#endif

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
