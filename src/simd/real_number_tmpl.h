/* SPDX-License-Identifier: MIT */
/* `real` as one number; see real_tmpl.h. */
typedef scalar real;
typedef bool lane_mask;
typedef uint64_t real_bits; /* of a double */

SPRING_INLINE real splat(scalar s)
{
    return s;
}

SPRING_INLINE lane_mask not_finite(real a)
{
    return !(a - a == 0);
}

SPRING_INLINE lane_mask sign_bit(real a)
{
    return spring_sign_bit((double)a);
}

SPRING_INLINE bool any(lane_mask t)
{
    return t;
}

SPRING_INLINE lane_mask not_mask(lane_mask t)
{
    return !t;
}

SPRING_INLINE real select_real(lane_mask t, real a, real b)
{
    return t ? a : b;
}

SPRING_INLINE real vec_not_negative(real a)
{
    return a < 0 ? 0 : a;
}

SPRING_INLINE lane_mask vec_load_mask(const int8_t *p)
{
    return *p != 0;
}

SPRING_INLINE real vec_load_places(const scalar *from, const size_t *place)
{
    return from[*place];
}

typedef uint32_t lane_bits;

SPRING_INLINE lane_bits load_bits(const uint32_t *p)
{
    return *p;
}

SPRING_INLINE void store_bits(uint32_t *p, lane_bits b)
{
    *p = b;
}

SPRING_INLINE lane_bits bits_where(lane_mask t, uint32_t bits)
{
    return t ? bits : 0;
}

SPRING_INLINE lane_mask are_bits(lane_bits b, uint32_t bits)
{
    return b == bits;
}

SPRING_INLINE real vec_sqrt(real a)
{
    return scalar_sqrt(a);
}

SPRING_INLINE real vec_abs(real a)
{
    return (real)fabs((double)a);
}

SPRING_INLINE real vec_minus_abs(real a)
{
    return -vec_abs(a);
}

/* The smaller; b if a is NaN. */
SPRING_INLINE real vec_min(real a, real b)
{
    return a < b ? a : b;
}

#ifndef SPRING_FLOAT
SPRING_INLINE real_bits to_bits(real a)
{
    real_bits b;
    memcpy(&b, &a, sizeof b);
    return b;
}

SPRING_INLINE real from_bits(real_bits b)
{
    real a;
    memcpy(&a, &b, sizeof a);
    return a;
}

SPRING_INLINE real vec_load_float(const float *p)
{
    return (real)*p;
}

SPRING_INLINE void vec_store_float(float *p, real r)
{
    *p = (float)r;
}
#endif

/* Bit-identical to the function in real_vector_tmpl.h. */
SPRING_INLINE void vec_inverse_sqrt(real *a, const lane_mask *where, int many)
{
    (void)where;
    for (int k = 0; k < many; k++) {
#ifndef SPRING_FLOAT
        if (a[k] >= 0x1p-84 && a[k] < 0x1p44) {
            const real y = (real)(1 / (float)spring_sqrt((double)(float)a[k])), r = 1 - a[k] * (y * y);
            a[k] = y + y * r * (0.5 + 0.375 * r);
            continue;
        }
#endif
        a[k] = a[k] > 0 ? 1 / vec_sqrt(a[k]) : 0;
    }
}
