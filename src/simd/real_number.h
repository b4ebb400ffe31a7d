/* SPDX-License-Identifier: MIT */
/* `real` as one number; see real.h. */
typedef scalar real;
typedef bool mask;

SPRING_INLINE real splat(scalar s)
{
    return s;
}

SPRING_INLINE mask not_finite(real a)
{
    return !(a - a == 0);
}

SPRING_INLINE mask sign_bit(real a)
{
    return signbit(a) != 0;
}

SPRING_INLINE bool any(mask t)
{
    return t;
}

SPRING_INLINE real select_real(mask t, real a, real b)
{
    return t ? a : b;
}

SPRING_INLINE mask vec_load_mask(const int8_t *p)
{
    return *p != 0;
}

SPRING_INLINE real vec_sqrt(real a)
{
    return (real)sqrt((double)a);
}

SPRING_INLINE real vec_abs(real a)
{
    return (real)fabs((double)a);
}

/* See real_vector.h: the same bits. */
SPRING_INLINE void vec_inverse_sqrt(real *a, const mask *where, int many)
{
    (void)where;
    for (int k = 0; k < many; k++) {
#ifndef SPRING_FLOAT
        if (a[k] >= 0x1p-84 && a[k] < 0x1p44) {
            const real y = (real)(1 / sqrtf((float)a[k])), r = 1 - a[k] * (y * y);
            a[k] = y + y * r * (0.5 + 0.375 * r);
            continue;
        }
#endif
        a[k] = a[k] > 0 ? 1 / vec_sqrt(a[k]) : 0;
    }
}
