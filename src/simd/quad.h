/* SPDX-License-Identifier: MIT */
/* Four numbers: the axes of one particle, side by side; those it does not have are 0. */
#ifndef SPRINGSTEP_QUAD_H
#define SPRINGSTEP_QUAD_H

#include "real.h"

enum { quad_size = 4 };

#if defined(SPRING_VECTOR) && defined(__GNUC__)
typedef scalar quad __attribute__((vector_size(quad_size * sizeof(scalar))));

SPRING_INLINE quad quad_of(scalar a, scalar b, scalar c, scalar d)
{
    return (quad){a, b, c, d};
}

SPRING_INLINE scalar quad_at(quad q, int i)
{
    return q[i];
}

SPRING_INLINE quad quad_plus(quad a, quad b)
{
    return a + b;
}

SPRING_INLINE quad quad_minus(quad a, quad b)
{
    return a - b;
}

SPRING_INLINE quad quad_times(quad a, quad b)
{
    return a * b;
}

SPRING_INLINE quad quad_over(quad a, quad b)
{
    return a / b;
}
#else
typedef struct quad {
    scalar at[quad_size];
} quad;

SPRING_INLINE quad quad_of(scalar a, scalar b, scalar c, scalar d)
{
    return (quad){{a, b, c, d}};
}

SPRING_INLINE scalar quad_at(quad q, int i)
{
    return q.at[i];
}

SPRING_INLINE quad quad_plus(quad a, quad b)
{
    return quad_of(a.at[0] + b.at[0], a.at[1] + b.at[1], a.at[2] + b.at[2], a.at[3] + b.at[3]);
}

SPRING_INLINE quad quad_minus(quad a, quad b)
{
    return quad_of(a.at[0] - b.at[0], a.at[1] - b.at[1], a.at[2] - b.at[2], a.at[3] - b.at[3]);
}

SPRING_INLINE quad quad_times(quad a, quad b)
{
    return quad_of(a.at[0] * b.at[0], a.at[1] * b.at[1], a.at[2] * b.at[2], a.at[3] * b.at[3]);
}

SPRING_INLINE quad quad_over(quad a, quad b)
{
    return quad_of(a.at[0] / b.at[0], a.at[1] / b.at[1], a.at[2] / b.at[2], a.at[3] / b.at[3]);
}
#endif

SPRING_INLINE quad quad_all(scalar a)
{
    return quad_of(a, a, a, a);
}

SPRING_INLINE quad quad_sqrt(quad a)
{
#if SPRING_X86_64 && defined(SPRING_VECTOR) && !defined(SPRING_FLOAT) && defined(__GNUC__) && SPRING_VECTOR >= 32
    return (quad)_mm256_sqrt_pd((__m256d)a);
#elif SPRING_X86_64 && defined(SPRING_VECTOR) && !defined(SPRING_FLOAT) && defined(__GNUC__)
    __m128d half[2];
    memcpy(half, &a, sizeof half);
    half[0] = _mm_sqrt_pd(half[0]);
    half[1] = _mm_sqrt_pd(half[1]);
    memcpy(&a, half, sizeof half);
    return a;
#elif SPRING_X86_64 && defined(SPRING_VECTOR) && defined(__GNUC__)
    return (quad)_mm_sqrt_ps((__m128)a);
#else
    return quad_of(scalar_sqrt(quad_at(a, 0)), scalar_sqrt(quad_at(a, 1)), scalar_sqrt(quad_at(a, 2)),
                   scalar_sqrt(quad_at(a, 3)));
#endif
}

/* Of the axes. */
SPRING_INLINE scalar quad_dot(quad a, quad b)
{
    const quad product = quad_times(a, b);
    return quad_at(product, 0) + quad_at(product, 1) + quad_at(product, 2);
}

/* Is none infinite or NaN? */
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
