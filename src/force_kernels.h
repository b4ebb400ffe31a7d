/* SPDX-License-Identifier: MIT */
/*
 * The forces of a scene's links on its particles, in the vectors that real.h is set to.
 *
 * Bands     Links of constant offset, as in a rope, a sheet or a block, lie in one band, by their lower end. Each link
 *           is computed once: for a tile of slots the forces of every band on its lower ends are kept; then each
 *           particle of the tile adds those of which it is the lower end, and subtracts those of which it is the upper
 *           one, `offset` slots before. So a band keeps a ring of its last offset + tile forces. Nothing is scattered,
 *           both ends feel the same bits, so momentum is conserved to rounding, and the order of additions does not
 *           depend on the length of vectors. A tile reads no position and no velocity of the tiles before it.
 * Edges     All other links, the edge list, one by one in their order; a particle's axes lie side by side, in a quad.
 * Law       k (1 - rest/length) delta, and with damping c (relative velocity . delta)/length^2 delta; nothing where
 *           both ends are at one point. Of a band 1/length is vec_inverse_sqrt(), to 1 ulp, in float 1.5; of an edge
 *           the square root is rounded, and the quotient rest/length.
 */
#ifndef SPRINGSTEP_FORCE_KERNELS_H
#define SPRINGSTEP_FORCE_KERNELS_H

#include "scene_kernels.h"
#include "simd/quad.h"

/* ---------------------------------------------------------------------------------------------------------- bands */

/* Vectors of links that are computed at once: while some wait for a root, others are computed. On one axis there is none
   to wait for, and a loop of few operations is worth more of them: measured for vectors of 16 and of 64 bytes. */
enum { most_together = 4 };

SPRING_INLINE size_t links_together(uint32_t axes)
{
    return axes == 1 && SPRING_VECTOR != 32 ? 4 : 2;
}

/* Turns deltas from the lower ends of links to the upper into forces on the lower. Where there is no link that is 0,
   selected and not multiplied: particles that are not joined may be infinitely far apart. */
SPRING_INLINE void to_forces(uint32_t axes, real (*delta)[3], real (*relative)[3], const mask *joined, const real *k,
                             const real *rest, const real *c, bool damped)
{
    const size_t together = links_together(axes);
    real scale[most_together], rate[most_together];
    SPRING_UNROLL
    for (size_t m = 0; m < together; m++) {
        real square = delta[m][0] * delta[m][0];
        rate[m] = damped ? delta[m][0] * relative[m][0] : splat(0);
        SPRING_UNROLL
        for (uint32_t a = 1; a < axes; a++) {
            square += delta[m][a] * delta[m][a];
            if (damped)
                rate[m] += delta[m][a] * relative[m][a];
        }
        scale[m] = square;
    }
    vec_inverse_sqrt(scale, joined, (int)together);
    SPRING_UNROLL
    for (size_t m = 0; m < together; m++) {
        const real inverse = scale[m];
        scale[m] = k[m] * (1 - rest[m] * inverse);
        if (damped)
            scale[m] += c[m] * (rate[m] * inverse * inverse);
    }
    SPRING_UNROLL
    for (size_t m = 0; m < together; m++) {
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++)
            delta[m][a] = select_real(joined[m], scale[m] * delta[m][a], splat(0));
    }
}

/* On one axis a link is a linear spring. */
SPRING_INLINE void to_linear_forces(real (*delta)[3], real (*relative)[3], const mask *joined, const real *k,
                                    const real *rest, const real *c, bool damped)
{
    SPRING_UNROLL
    for (size_t m = 0; m < links_together(1); m++) {
        const real pull = k[m] * (delta[m][0] - rest[m]);
        delta[m][0] = select_real(joined[m], damped ? pull + c[m] * relative[m][0] : pull, splat(0));
    }
}

SPRING_INLINE void clear_slots(scalar *force, size_t axis, size_t slots, uint32_t axes)
{
    for (uint32_t a = 0; a < axes; a++)
        for (size_t j = 0; j < slots; j += lanes)
            vec_store(force + a * axis + j, splat(0));
}

/* The forces of a band in `slots` slots from t, of axis a at force + a * axis; shared: they all
   have the same coefficients, and the compiler is to know it. */
SPRING_INLINE void tile_forces(const scene_band *band, const scalar *x, const scalar *v, size_t stride, ptrdiff_t t,
                               size_t slots, scalar *force, size_t axis, uint32_t axes, bool damped, bool shared)
{
    const ptrdiff_t offset = band->offset, slot = t - band->start;
    const int8_t *const occupied = band->occupied + slot;
    const ptrdiff_t step = shared ? 0 : band->coefficient_step;
    const scalar *const stiffness = band->stiffness + slot * step, *const length = band->rest + slot * step,
                        *const damping = damped ? band->damping + slot * step : NULL;
    SPRING_PREFETCH(occupied + tile); /* a line in a megabyte: too few for the processor to notice a stream */
    const size_t left = (size_t)(band->end - t), count = left < slots ? left : slots;
    const size_t together = links_together(axes);
    size_t j = 0;
    for (; j < count; j += together * lanes) {
        SPRING_HOT_LOOP("link", together * lanes);
        real delta[most_together][3], relative[most_together][3];
        real k[most_together], rest[most_together], c[most_together];
        mask joined[most_together];
        SPRING_UNROLL
        for (size_t m = 0; m < together; m++) {
            const size_t i = j + m * lanes;
            const ptrdiff_t number = (ptrdiff_t)i * step;
            k[m] = vec_load(stiffness + number);
            rest[m] = vec_load(length + number);
            c[m] = damped ? vec_load(damping + number) : splat(0);
            joined[m] = vec_load_mask(occupied + i);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                const scalar *const at = x + a * stride + t + i, *const with = v + a * stride + t + i;
                delta[m][a] = vec_load(at + offset) - vec_load(at);
                if (damped)
                    relative[m][a] = vec_load(with + offset) - vec_load(with);
            }
        }
        if (axes == 1)
            to_linear_forces(delta, relative, joined, k, rest, c, damped);
        else
            to_forces(axes, delta, relative, joined, k, rest, c, damped);
        SPRING_UNROLL
        for (size_t m = 0; m < together; m++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                vec_store(force + a * axis + j + m * lanes, delta[m][a]);
        }
    }
    if (j < slots)
        clear_slots(force + j, axis, slots - j, axes);
}

SPRING_INLINE void band_forces(const scene_band *band, const scalar *x, const scalar *v, size_t stride, ptrdiff_t t,
                               size_t slots, scalar *force, size_t axis, uint32_t axes, bool damped)
{
    if (axes == 1 && band->coefficient_step == 0) /* such a link is so quick that loading coefficients counts */
        tile_forces(band, x, v, stride, t, slots, force, axis, axes, damped, true);
    else
        tile_forces(band, x, v, stride, t, slots, force, axis, axes, damped, false);
}

/* Forces that are added to those of a tile, or subtracted: of axis a at force + a * axis. */
typedef struct kept_forces {
    const scalar *force;
    size_t axis;
} kept_forces;

/* The bands' forces on `count` particles from t. */
SPRING_INLINE void gather(const scene_links *s, ptrdiff_t t, size_t count, const kept_forces *plus, size_t pluses,
                          const kept_forces *minus, size_t minuses, uint32_t axes)
{
    enum { most = 4 };
    const size_t some = axes == 1 && SPRING_VECTOR == 16 ? most : 2; /* vectors at once */
    scalar *const to = s->force + t;
    const size_t stride = s->stride;
    for (size_t j = 0; j < count; j += some * lanes) {
        real force[most][3];
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                force[m][a] = splat(0);
        }
        for (const kept_forces *k = plus; k < plus + pluses; k++) {
            SPRING_HOT_LOOP("link-end", some * lanes);
            SPRING_UNROLL
            for (size_t m = 0; m < some; m++) {
                SPRING_UNROLL
                for (uint32_t a = 0; a < axes; a++)
                    force[m][a] += vec_load(k->force + a * k->axis + j + m * lanes);
            }
        }
        for (const kept_forces *k = minus; k < minus + minuses; k++) {
            SPRING_HOT_LOOP("link-end", some * lanes);
            SPRING_UNROLL
            for (size_t m = 0; m < some; m++) {
                SPRING_UNROLL
                for (uint32_t a = 0; a < axes; a++)
                    force[m][a] -= vec_load(k->force + a * k->axis + j + m * lanes);
            }
        }
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                vec_store(to + a * stride + j + m * lanes, force[m][a]);
        }
    }
}

/* The first tile of a ring stands behind the last once more, so that any `tile` slots in a row lie so. */
SPRING_INLINE void repeat_tile(scalar *force, ptrdiff_t ring, size_t slots, size_t axis, uint32_t axes)
{
    for (uint32_t a = 0; a < axes; a++)
        for (size_t j = 0; j < slots; j += lanes)
            vec_store(force + a * axis + ring + j, vec_load(force + a * axis + j));
}

/* The bands' forces on particles from ... to - 1. Those before them have theirs: their forces are in the rings. */
SPRING_INLINE void all_bands(const scene_links *s, const scalar *x, const scalar *v, size_t from, size_t to,
                             uint32_t axes, bool damped)
{
    ptrdiff_t slot[most_bands]; /* of the tile, in each ring */
    for (size_t r = 0; r < s->bands; r++) {
        const scene_band *band = &s->band[r];
        slot[r] = (ptrdiff_t)from % band->ring;
        if (from == 0) { /* there are no forces before the first */
            const size_t before = (size_t)(band->offset < tile ? (band->offset + lanes - 1) / lanes * lanes : tile);
            clear_slots(band->force + band->ring - before, (size_t)(band->ring + tile), before, axes);
        }
    }
    for (ptrdiff_t t = (ptrdiff_t)from; t < (ptrdiff_t)to; t += tile) {
        kept_forces plus[most_bands], minus[most_bands];
        size_t pluses = 0, minuses = 0;
        const size_t left = s->particles - (size_t)t, count = left < tile ? left : tile;
        for (size_t r = 0; r < s->bands; r++) {
            const scene_band *band = &s->band[r];
            const ptrdiff_t ring = band->ring, other = slot[r] - band->back;
            const size_t axis = (size_t)(ring + tile);
            scalar *const force = band->force + slot[r];
            if (t >= band->start && t < band->end) {
                band_forces(band, x, v, s->stride, t, count, force, axis, axes, damped);
                plus[pluses++] = (kept_forces){force, axis};
            } else if (t >= band->start - tile && t < band->end + tile) { /* upper ends may reach so far */
                clear_slots(force, axis, count, axes);
            }
            if (slot[r] == 0)
                repeat_tile(force, ring, count, axis, axes);
            if (t < band->end + band->offset && t + tile > band->start + band->offset)
                minus[minuses++] = (kept_forces){band->force + (other < 0 ? other + ring : other), axis};
            slot[r] = slot[r] + tile < ring ? slot[r] + tile : 0;
        }
        gather(s, t, count, plus, pluses, minus, minuses, axes);
    }
}

/* ---------------------------------------------------------------------------------------------------------- edges */

/* The force of an edge is this times the delta between its ends. rate: relative velocity . delta */
SPRING_INLINE scalar edge_scale(const scene_edges *l, size_t j, scalar square, scalar rate, bool damped)
{
    const scalar scale = l->stiffness[j] * (1 - l->rest[j] / scalar_sqrt(square));
    return damped ? scale + l->damping[j] * (rate / square) : scale;
}

/* An edge that is cut does nothing, however far apart its ends are. */
SPRING_INLINE bool edge_pulls(const scene_edges *l, size_t j, bool damped)
{
    return l->stiffness[j] > 0 || (damped && l->damping[j] > 0);
}

/* The edge list, from arrays of each axis. */
SPRING_INLINE void all_edges(const scene_links *s, const scalar *x, const scalar *v, uint32_t axes, bool damped)
{
    const scene_edges *const l = &s->edge_list;
    for (size_t j = 0; j < l->count; j++) {
        const size_t from = l->a[j], to = l->b[j];
        scalar delta[3], scale = 1, square = 0, rate = 0;
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++) {
            delta[a] = x[a * s->stride + to] - x[a * s->stride + from];
            square += delta[a] * delta[a];
            if (damped)
                rate += delta[a] * (v[a * s->stride + to] - v[a * s->stride + from]);
        }
        if (!edge_pulls(l, j, damped) || (axes > 1 && !(square > 0)))
            continue;
        SPRING_HOT_LOOP("edge", 1);
        if (axes == 1) {
            delta[0] = l->stiffness[j] * (delta[0] - l->rest[j]);
            if (damped)
                delta[0] += l->damping[j] * (v[to] - v[from]);
        } else {
            scale = edge_scale(l, j, square, rate, damped);
        }
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++) {
            s->force[a * s->stride + from] += scale * delta[a];
            s->force[a * s->stride + to] -= scale * delta[a];
        }
    }
}

SPRING_INLINE void one_quad_edge(const scene_edges *l, size_t j, const scalar *x, const scalar *v, scalar *force,
                                 size_t step, bool damped)
{
    const size_t a = step * l->a[j], b = step * l->b[j];
    const quad delta = quad_minus(quad_load(x + b), quad_load(x + a));
    const scalar square = quad_dot(delta, delta);
    if (!edge_pulls(l, j, damped) || !(square > 0))
        return;
    const scalar rate = damped ? quad_dot(delta, quad_minus(quad_load(v + b), quad_load(v + a))) : 0;
    const quad pull = quad_times(quad_all(edge_scale(l, j, square, rate, damped)), delta);
    quad_store(force + a, quad_plus(quad_load(force + a), pull));
    quad_store(force + b, quad_minus(quad_load(force + b), pull));
}

/* The edge list, from quads: x, v and force of particle i at step * i. Four links share a root and a quotient. */
SPRING_INLINE void quad_edges(const scene_edges *edges, const scalar *x, const scalar *v, scalar *force, size_t step,
                              bool damped)
{
    const scene_edges own = *edges, *const l = &own; /* no store changes it, for all a compiler knows */
    const size_t ahead = 32; /* links, whose ends are fetched: where the scene fits into no cache */
    const size_t some = quad_size, fours = l->count / some * some;
    for (size_t j = 0; j < fours; j += some) {
        if (j + ahead < fours) {
            SPRING_UNROLL
            for (size_t m = 0; m < some; m++) {
                SPRING_PREFETCH(x + step * l->a[j + ahead + m]);
                SPRING_PREFETCH(x + step * l->b[j + ahead + m]);
            }
        }
        quad delta[4];
        scalar squares[4], rates[4] = {0};
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            const size_t a = step * l->a[j + m], b = step * l->b[j + m];
            delta[m] = quad_minus(quad_load(x + b), quad_load(x + a));
            squares[m] = quad_dot(delta[m], delta[m]);
            if (damped)
                rates[m] = quad_dot(delta[m], quad_minus(quad_load(v + b), quad_load(v + a)));
        }
        const quad square = quad_of(squares[0], squares[1], squares[2], squares[3]);
        quad scale = quad_times(quad_load(l->stiffness + j),
                                quad_minus(quad_all(1), quad_over(quad_load(l->rest + j), quad_sqrt(square))));
        if (damped)
            scale = quad_plus(scale, quad_times(quad_load(l->damping + j),
                                                quad_over(quad_of(rates[0], rates[1], rates[2], rates[3]), square)));
        if (SPRING_UNLIKELY(!quad_finite(quad_plus(scale, square)))) { /* ends at one place, or very far apart */
            for (size_t m = 0; m < some; m++)
                one_quad_edge(l, j + m, x, v, force, step, damped);
            continue;
        }
        SPRING_HOT_LOOP("edge", quad_size);
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            const size_t a = step * l->a[j + m], b = step * l->b[j + m];
            const quad pull = quad_times(quad_all(quad_at(scale, (int)m)), delta[m]);
            quad_store(force + a, quad_plus(quad_load(force + a), pull));
            quad_store(force + b, quad_minus(quad_load(force + b), pull));
        }
    }
    for (size_t j = fours; j < l->count; j++)
        one_quad_edge(l, j, x, v, force, step, damped);
}

/* What the edges of a scene without order read and write: of each particle position, velocity if links are damped, and
   force, in one record. */
SPRING_INLINE size_t force_in_record(bool damped)
{
    return (damped ? 2 : 1) * quad_size;
}

SPRING_INLINE void fill_records(const scene_links *s, const scalar *x, const scalar *v, uint32_t axes, bool damped)
{
    const size_t at_force = force_in_record(damped), step = at_force + quad_size;
    for (size_t i = 0; i < s->particles; i++) {
        scalar *record = s->records + step * i;
        for (size_t k = 0; k < step; k += quad_size) /* what no axis uses is 0, whatever links were damped before */
            quad_store(record + k, quad_all(0));
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++) {
            record[a] = x[a * s->stride + i];
            if (damped)
                record[quad_size + a] = v[a * s->stride + i];
            record[at_force + a] = s->bands > 0 ? s->force[a * s->stride + i] : 0;
        }
    }
}

SPRING_INLINE void take_forces(const scene_links *s, uint32_t axes, bool damped)
{
    const size_t at_force = force_in_record(damped), step = at_force + quad_size;
    for (size_t i = 0; i < s->particles; i++) {
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++)
            s->force[a * s->stride + i] = s->records[step * i + at_force + a];
    }
}

SPRING_INLINE void all_records(const scene_links *s, const scalar *x, const scalar *v, bool damped)
{
    const size_t at_force = force_in_record(damped);
    if (s->axes == 3)
        fill_records(s, x, v, 3, damped);
    else
        fill_records(s, x, v, 2, damped);
    quad_edges(&s->edge_list, s->records, s->records + quad_size, s->records + at_force, at_force + quad_size, damped);
    if (s->axes == 3)
        take_forces(s, 3, damped);
    else
        take_forces(s, 2, damped);
}

/* The forces of a small scene, whose arrays are of quads. */
SPRING_INLINE void all_quads(const scene_links *s, const scalar *x, const scalar *v, bool damped)
{
    for (size_t i = 0; i < s->particles; i++)
        quad_store(s->force + quad_size * i, quad_all(0));
    quad_edges(&s->edge_list, x, v, s->force, quad_size, damped);
}

#endif
