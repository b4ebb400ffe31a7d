/* SPDX-License-Identifier: MIT */
/* `quad` as a vector; see quad_tmpl.h. */
typedef scalar quad __attribute__((vector_size(quad_size * sizeof(scalar))));
typedef scalar_bits quad_bits __attribute__((vector_size(quad_size * sizeof(scalar))));

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

/* a, but 0 where `sign` is negative and b or c is not positive. */
SPRING_INLINE quad quad_zero_where(quad a, quad b, quad c, quad sign)
{
    return (quad)((quad_bits)a & (quad_bits)((sign >= 0) | ((b > 0) & (c > 0))));
}

SPRING_INLINE quad quad_abs(quad a)
{
    const quad minus_zero = {-(scalar)0, -(scalar)0, -(scalar)0, -(scalar)0};
    return (quad)((quad_bits)a & ~(quad_bits)minus_zero);
}

SPRING_INLINE quad quad_sqrt(quad a)
{
#if SPRING_X86_64 && defined(SPRING_FLOAT)
    return (quad)_mm_sqrt_ps((__m128)a);
#elif SPRING_X86_64
    return (quad)_mm256_sqrt_pd((__m256d)a);
#else
    return quad_of(scalar_sqrt(a[0]), scalar_sqrt(a[1]), scalar_sqrt(a[2]), scalar_sqrt(a[3]));
#endif
}
