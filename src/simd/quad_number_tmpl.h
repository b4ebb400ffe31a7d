/* SPDX-License-Identifier: MIT */
/* `quad` as numbers; see quad_tmpl.h. */
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

SPRING_INLINE quad quad_zero_where(quad a, quad b, quad c, quad sign)
{
    quad r = a;
    for (int i = 0; i < quad_size; i++)
        r.at[i] = sign.at[i] >= 0 || (b.at[i] > 0 && c.at[i] > 0) ? a.at[i] : 0;
    return r;
}

SPRING_INLINE quad quad_abs(quad a)
{
    quad r = a;
    for (int i = 0; i < quad_size; i++)
        r.at[i] = a.at[i] < 0 ? -a.at[i] : a.at[i];
    return r;
}

SPRING_INLINE quad quad_sqrt(quad a)
{
    return quad_of(scalar_sqrt(a.at[0]), scalar_sqrt(a.at[1]), scalar_sqrt(a.at[2]), scalar_sqrt(a.at[3]));
}
