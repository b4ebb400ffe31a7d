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

SPRING_INLINE quad quad_where_greater(quad a, quad b, quad than) /* else 0 */
{
    return quad_of(b.at[0] > than.at[0] ? a.at[0] : 0, b.at[1] > than.at[1] ? a.at[1] : 0,
                   b.at[2] > than.at[2] ? a.at[2] : 0, b.at[3] > than.at[3] ? a.at[3] : 0);
}

SPRING_INLINE quad quad_sqrt(quad a)
{
    return quad_of(scalar_sqrt(a.at[0]), scalar_sqrt(a.at[1]), scalar_sqrt(a.at[2]), scalar_sqrt(a.at[3]));
}
