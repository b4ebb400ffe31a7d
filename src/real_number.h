/* SPDX-License-Identifier: MIT */
/* `real` as one number; see real.h. */
typedef scalar real;
typedef bool truth;

SPRING_INLINE real splat(scalar s)
{
    return s;
}

SPRING_INLINE truth not_finite(real a)
{
    return !(a - a == 0);
}

SPRING_INLINE truth sign_bit(real a)
{
    return signbit(a) != 0;
}

SPRING_INLINE bool any(truth t)
{
    return t;
}

SPRING_INLINE real select_real(truth t, real a, real b)
{
    return t ? a : b;
}

SPRING_INLINE truth load_truth(const int8_t *p)
{
    return *p != 0;
}

SPRING_INLINE real root(real a)
{
    return (real)sqrt((double)a);
}

SPRING_INLINE real magnitude(real a)
{
    return (real)fabs((double)a);
}
