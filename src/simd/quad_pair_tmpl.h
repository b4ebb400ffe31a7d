/* SPDX-License-Identifier: MIT */
/* `quad` as two vectors of 16 bytes; see quad_tmpl.h. */
typedef struct quad {
    real low, high;
} quad;

SPRING_INLINE quad quad_of(scalar a, scalar b, scalar c, scalar d)
{
    return (quad){(real){a, b}, (real){c, d}};
}

SPRING_INLINE scalar quad_at(quad q, int i)
{
    return i < 2 ? q.low[i] : q.high[i - 2];
}

SPRING_INLINE quad quad_plus(quad a, quad b)
{
    return (quad){a.low + b.low, a.high + b.high};
}

SPRING_INLINE quad quad_minus(quad a, quad b)
{
    return (quad){a.low - b.low, a.high - b.high};
}

SPRING_INLINE quad quad_times(quad a, quad b)
{
    return (quad){a.low * b.low, a.high * b.high};
}

SPRING_INLINE quad quad_over(quad a, quad b)
{
    return (quad){a.low / b.low, a.high / b.high};
}

SPRING_INLINE quad quad_zero_where(quad a, quad b, quad c, quad sign)
{
    return (quad){select_real((sign.low >= 0) | ((b.low > 0) & (c.low > 0)), a.low, splat(0)),
                  select_real((sign.high >= 0) | ((b.high > 0) & (c.high > 0)), a.high, splat(0))};
}

SPRING_INLINE quad quad_abs(quad a)
{
    return (quad){vec_abs(a.low), vec_abs(a.high)};
}

SPRING_INLINE quad quad_sqrt(quad a)
{
    return (quad){vec_sqrt(a.low), vec_sqrt(a.high)};
}
