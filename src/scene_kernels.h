/* SPDX-License-Identifier: MIT */
/*
 * The loops over the particles and links of a scene, in the vectors that real.h is set to.
 *
 * Bands     Links of constant offset, as in a rope, a sheet or a block, lie in one band, by their lower end; where the
 *           band has no link its stiffness is 0. Bands are gathered: each particle looks at its neighbours at fixed
 *           distances on both sides, and nothing is scattered. Every force is computed twice, once for either end, with
 *           opposite signs and otherwise the same bits, so momentum is conserved to rounding.
 * Edges     All other links, the edge list, in blocks: gather, vector arithmetic, scatter in the order of the links.
 * Motion    The parts of a step: kick, solved kick, drift, stages. A particle that is pinned has inverse mass 0.
 */
#ifndef SPRINGSTEP_SCENE_KERNELS_H
#define SPRINGSTEP_SCENE_KERNELS_H

#include "simd/real.h"
#include "solved_kick.h"
#include "twins.h"

enum { padding = 16 }; /* elements before and after what vectors read: as many as the longest vector has lanes */

/* Links whose upper end is `offset` particles after the lower one. Arrays start `padding` before the first lower end.
   */
typedef struct scene_band {
    ptrdiff_t offset;
    ptrdiff_t first, end;    /* of the lower ends */
    const int8_t *occupied;  /* -1 where there is a link, else 0; NULL: each slot has coefficients */
    const scalar *stiffness; /* [N/m]; of a vector of equal links, or of each slot, 0 where there is no link */
    const scalar *rest;      /* [m]; negative on one axis where the link runs from the upper end to the lower */
    const scalar *damping;   /* [N s/m]; NULL: none in the scene */
} scene_band;

typedef struct scene_edges {
    size_t count;
    const uint32_t *a, *b;
    const scalar *stiffness, *rest, *damping; /* damping as in scene_band */
} scene_edges;

typedef struct scene_links { /* what a force kernel works on */
    size_t particles;
    size_t stride; /* elements from one axis to the next */
    const scalar *x, *v;
    scalar *force;
    size_t bands;
    const scene_band *band;
    scene_edges edge_list;
} scene_links;

/* A part of a step. A kernel uses what its line in scene_kernels says. */
typedef struct scene_motion {
    size_t particles;
    uint32_t axes;
    size_t stride;              /* elements from one axis to the next */
    const scalar *inverse_mass; /* NULL: one for all */
    scalar inverse_mass_all;
    scalar gravity[3];
    scalar drag;
    scalar kick, drift; /* [s] how long forces act on v, and v on x */
    const scalar *force;
    const scalar *x0, *v0; /* from */
    scalar *x, *v;         /* to */
    const scalar *slope;   /* the velocity of the stage that the force belongs to; v0 at first */
    scalar *sum_x, *sum_v; /* weighted sums of the slopes of stages, and of their accelerations */
    scalar weight;         /* of this stage */
} scene_motion;

typedef void scene_link_kernel(const scene_links *);
typedef bool scene_motion_kernel(const scene_motion *); /* false: a number is infinite or NaN */

/* With a(u) the acceleration by force, gravity and the drag of u: */
typedef struct scene_kernels {
    scene_link_kernel *bands[3][2]; /* by axes - 1, damping */
    scene_link_kernel *edges[3][2];
    scene_motion_kernel *kick_drift;        /* v = v0 + kick a(v0);       x = x0 + drift v */
    scene_motion_kernel *solved_kick;       /* v = v0 + kick a(v) */
    scene_motion_kernel *solved_kick_drift; /* v = v0 + kick a(v);  x = x0 + drift v */
    scene_motion_kernel *stage;             /* v = v0 + kick a(slope);    x = x0 + drift slope */
    scene_motion_kernel *first_stage;       /* the same, and the sums are slope and a(slope) */
    scene_motion_kernel *next_stage;        /* the same, and they are added to the sums, times weight */
    scene_motion_kernel *last_stage;        /* v = v0 + kick (sum_v + a(slope));   x = x0 + drift (sum_x + slope) */
} scene_kernels;

extern const scene_kernels spring_scene_v128, spring_scene_v256, spring_scene_v512; /* by bits of a vector */

#ifdef SPRING_VECTOR

/* ---------------------------------------------------------------------------------------------------------- links */

/* The force of a link on one of its ends is this times the delta to the other end: k (1 - rest/length), and with
   damping c (relative velocity . delta)/length^2. Not a number where both are at one point: see to_force(). */
SPRING_INLINE real pull(uint32_t axes, const real *delta, const real *relative, real square, real k, real rest, real c,
                        bool damped)
{
    real scale = k * (1 - rest / vec_sqrt(square));
    if (damped) {
        real rate = delta[0] * relative[0];
        SPRING_UNROLL
        for (uint32_t a = 1; a < axes; a++)
            rate += delta[a] * relative[a];
        scale += c * (rate / square);
    }
    return scale;
}

/* Turns the delta from one end of a link to the other into the force on the one. Where there is no link, or no
   direction, that is 0, selected and not multiplied: particles that are not joined may be infinitely far apart. */
SPRING_INLINE void to_force(uint32_t axes, real *delta, const real *relative, mask joined, real k, real rest, real c,
                            bool damped)
{
    if (axes == 1) {
        const real pull = k * (delta[0] - rest);
        delta[0] = select_real(joined, damped ? pull + c * relative[0] : pull, splat(0));
        return;
    }
    real square = delta[0] * delta[0];
    SPRING_UNROLL
    for (uint32_t a = 1; a < axes; a++)
        square += delta[a] * delta[a];
    const real scale = pull(axes, delta, relative, square, k, rest, c, damped);
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++)
        delta[a] = select_real(joined & (square > 0), scale * delta[a], splat(0));
}

/* Adds what one side of a band does to the vector of particles from i: the upper neighbours, or the lower. */
SPRING_INLINE void gather_side(const scene_links *s, const scene_band *band, ptrdiff_t i, bool upper, uint32_t axes,
                               bool damped, const real *x, const real *v, real *force)
{
    const ptrdiff_t offset = upper ? band->offset : -band->offset;
    const ptrdiff_t at = (upper ? i : i + offset) - band->first + padding;
    const ptrdiff_t number = band->occupied != NULL ? 0 : at;
    const real k = vec_load(band->stiffness + number), c = damped ? vec_load(band->damping + number) : splat(0);
    const real rest = vec_load(band->rest + number);
    const mask joined = band->occupied != NULL ? vec_load_mask(band->occupied + at) : (k > 0) | (c > 0);
    real delta[3], relative[3];
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++) {
        delta[a] = vec_load(s->x + a * s->stride + i + offset) - x[a];
        if (damped)
            relative[a] = vec_load(s->v + a * s->stride + i + offset) - v[a];
    }
    /* On one axis the rest length has the direction from the lower end to the upper. */
    to_force(axes, delta, relative, joined, k, axes == 1 && !upper ? -rest : rest, c, damped);
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++)
        force[a] += delta[a];
}

/* The vector of particles from i; everywhere: each side of each band reaches all of them. */
SPRING_INLINE void bands_at(const scene_links *s, ptrdiff_t i, uint32_t axes, bool damped, bool everywhere)
{
    real x[3], v[3], force[3];
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++) {
        x[a] = vec_load(s->x + a * s->stride + i);
        if (damped)
            v[a] = vec_load(s->v + a * s->stride + i);
        force[a] = splat(0);
    }
    const scene_band *const end = s->band + s->bands;
    for (const scene_band *band = s->band; band < end; band++) {
        if (everywhere || (i + lanes > band->first && i < band->end))
            gather_side(s, band, i, true, axes, damped, x, v, force);
        if (everywhere || (i + lanes > band->first + band->offset && i < band->end + band->offset))
            gather_side(s, band, i, false, axes, damped, x, v, force);
    }
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++)
        vec_store(s->force + a * s->stride + i, force[a]);
}

SPRING_INLINE void bands(const scene_links *s, uint32_t axes, bool damped)
{
    const ptrdiff_t particles = (ptrdiff_t)s->particles;
    ptrdiff_t from = 0, to = particles; /* between them every side of every band reaches all of a vector */
    for (size_t r = 0; r < s->bands; r++) {
        const scene_band *band = &s->band[r];
        from = band->first + band->offset > from ? band->first + band->offset : from;
        to = band->end < to ? band->end : to;
    }
    ptrdiff_t i = 0;
    for (; i < particles && i < from; i += lanes)
        bands_at(s, i, axes, damped, false);
    for (; i + lanes <= to; i += lanes)
        bands_at(s, i, axes, damped, true);
    for (; i < particles; i += lanes)
        bands_at(s, i, axes, damped, false);
}

enum { edge_block = 64 }; /* links whose ends are gathered together: they stay in the first cache */

SPRING_INLINE void edges(const scene_links *s, uint32_t axes, bool damped)
{
    const scene_edges *l = &s->edge_list;
    for (size_t first = 0; first < l->count; first += edge_block) {
        const size_t count = l->count - first < edge_block ? l->count - first : edge_block;
        const uint32_t *from = l->a + first, *to = l->b + first;
        scalar delta[3][edge_block], relative[3][edge_block];
        for (size_t j = 0; j < count; j++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                delta[a][j] = s->x[a * s->stride + to[j]] - s->x[a * s->stride + from[j]];
                if (damped)
                    relative[a][j] = s->v[a * s->stride + to[j]] - s->v[a * s->stride + from[j]];
            }
        }
        for (size_t j = count; j % lanes != 0; j++) /* what fills the last vector */
            for (uint32_t a = 0; a < axes; a++)
                delta[a][j] = relative[a][j] = 0;
        for (size_t j = 0; j < count; j += lanes) {
            const real k = vec_load(l->stiffness + first + j), rest = vec_load(l->rest + first + j);
            const real c = damped ? vec_load(l->damping + first + j) : splat(0);
            real w[3], r[3];
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                w[a] = vec_load(&delta[a][j]);
                r[a] = damped ? vec_load(&relative[a][j]) : splat(0);
            }
            to_force(axes, w, r, (k > 0) | (c > 0), k, rest, c, damped);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                vec_store(&delta[a][j], w[a]);
        }
        for (size_t j = 0; j < count; j++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                s->force[a * s->stride + from[j]] += delta[a][j];
                s->force[a * s->stride + to[j]] -= delta[a][j];
            }
        }
    }
}

/* --------------------------------------------------------------------------------------------------------- motion */

/* A vector of coordinates on one axis, of particles from i. */
typedef struct coordinates {
    size_t at;         /* in the arrays of a quantity */
    real inverse_mass; /* 0: pinned */
    scalar gravity;
    real drag;                /* [1/s] */
    solved_share share;       /* of a solved kick; else unset */
    real kick, drift, weight; /* as in scene_motion, where a store might have changed them for all a compiler knows */
} coordinates;

static const scalar lane_number[padding] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/* c: with kick, drift and weight. */
SPRING_INLINE coordinates coordinates_from(const scene_motion *s, size_t i, coordinates c, bool solved)
{
    real inverse_mass = s->inverse_mass != NULL ? vec_load(s->inverse_mass + i) : splat(s->inverse_mass_all);
    if (i + lanes > s->particles) /* what fills the last vector stays where it is, and finite */
        inverse_mass = select_real(vec_load(lane_number) < splat((scalar)(s->particles - i)), inverse_mass, splat(0));
    c.inverse_mass = inverse_mass;
    c.drag = s->drag * inverse_mass;
    if (solved)
        c.share = solved_share_of(c.kick * c.drag);
    return c;
}

/* By force and gravity. A particle that is pinned feels no force, not even an infinite one. */
SPRING_INLINE real free_acceleration(const scene_motion *s, const coordinates *c)
{
    const real free = c->inverse_mass * vec_load(s->force + c->at) + c->gravity;
    return select_real(c->inverse_mass > 0, free, splat(0));
}

SPRING_INLINE real acceleration(const scene_motion *s, const coordinates *c, real v)
{
    return free_acceleration(s, c) - c->drag * v;
}

SPRING_INLINE mask move_to(const scene_motion *s, const coordinates *c, real x, real v)
{
    vec_store(s->x + c->at, x);
    vec_store(s->v + c->at, v);
    return not_finite(x) | not_finite(v);
}

/* What a kernel does with one vector; the lanes that are infinite or NaN after it. */
typedef mask motion_part(const scene_motion *s, const coordinates *c);

/* The one loop of all kernels. */
SPRING_INLINE bool all_coordinates(const scene_motion *s, motion_part *part, bool solved)
{
    const coordinates all = {.kick = splat(s->kick), .drift = splat(s->drift), .weight = splat(s->weight)};
    mask wrong = {0};
    for (size_t i = 0; i < s->particles; i += lanes) {
        coordinates c = coordinates_from(s, i, all, solved);
        for (uint32_t a = 0; a < s->axes; a++) {
            c.at = a * s->stride + i;
            c.gravity = s->gravity[a];
            wrong |= part(s, &c);
        }
    }
    return !any(wrong);
}

SPRING_INLINE mask kick_drift_part(const scene_motion *s, const coordinates *c)
{
    const real v0 = vec_load(s->v0 + c->at);
    const real v = v0 + c->kick * acceleration(s, c, v0);
    return move_to(s, c, vec_load(s->x0 + c->at) + c->drift * v, v);
}

SPRING_INLINE real solved_velocity(const scene_motion *s, const coordinates *c)
{
    const real u = vec_load(s->v0 + c->at) + c->kick * free_acceleration(s, c);
    return s->drag != 0 ? c->share.keep * u + c->share.lose * u : u;
}

SPRING_INLINE mask solved_kick_part(const scene_motion *s, const coordinates *c)
{
    const real v = solved_velocity(s, c);
    vec_store(s->v + c->at, v);
    return not_finite(v);
}

SPRING_INLINE mask solved_kick_drift_part(const scene_motion *s, const coordinates *c)
{
    const real v = solved_velocity(s, c);
    const mask hidden = not_finite(c->kick * c->drag); /* in 1/(1 + q) */
    return move_to(s, c, vec_load(s->x0 + c->at) + c->drift * v, v) | hidden;
}

SPRING_INLINE mask move_along(const scene_motion *s, const coordinates *c, real dx, real dv)
{
    return move_to(s, c, vec_load(s->x0 + c->at) + c->drift * dx, vec_load(s->v0 + c->at) + c->kick * dv);
}

SPRING_INLINE mask stage_part(const scene_motion *s, const coordinates *c)
{
    const real dx = vec_load(s->slope + c->at);
    return move_along(s, c, dx, acceleration(s, c, dx));
}

SPRING_INLINE mask first_stage_part(const scene_motion *s, const coordinates *c)
{
    const real dx = vec_load(s->slope + c->at), dv = acceleration(s, c, dx);
    vec_store(s->sum_x + c->at, dx);
    vec_store(s->sum_v + c->at, dv);
    return move_along(s, c, dx, dv);
}

SPRING_INLINE mask next_stage_part(const scene_motion *s, const coordinates *c)
{
    const real dx = vec_load(s->slope + c->at), dv = acceleration(s, c, dx);
    vec_store(s->sum_x + c->at, vec_load(s->sum_x + c->at) + c->weight * dx);
    vec_store(s->sum_v + c->at, vec_load(s->sum_v + c->at) + c->weight * dv);
    return move_along(s, c, dx, dv);
}

SPRING_INLINE mask last_stage_part(const scene_motion *s, const coordinates *c)
{
    const real dx = vec_load(s->slope + c->at), dv = acceleration(s, c, dx);
    return move_along(s, c, vec_load(s->sum_x + c->at) + dx, vec_load(s->sum_v + c->at) + dv);
}

static bool kick_drift(const scene_motion *s)
{
    return all_coordinates(s, kick_drift_part, false);
}

static bool solved_kick(const scene_motion *s)
{
    return all_coordinates(s, solved_kick_part, true);
}

static bool solved_kick_drift(const scene_motion *s)
{
    return all_coordinates(s, solved_kick_drift_part, true);
}

static bool stage(const scene_motion *s)
{
    return all_coordinates(s, stage_part, false);
}

static bool first_stage(const scene_motion *s)
{
    return all_coordinates(s, first_stage_part, false);
}

static bool next_stage(const scene_motion *s)
{
    return all_coordinates(s, next_stage_part, false);
}

static bool last_stage(const scene_motion *s)
{
    return all_coordinates(s, last_stage_part, false);
}

/* ------------------------------------------------------------------------------------------------------ the table */

#define LINK_KERNELS(kernel, axes)                             \
    static void kernel##_##axes(const scene_links *s)          \
    {                                                          \
        kernel(s, axes, false);                                \
    }                                                          \
    static void kernel##_##axes##_damped(const scene_links *s) \
    {                                                          \
        kernel(s, axes, true);                                 \
    }

LINK_KERNELS(bands, 1)
LINK_KERNELS(bands, 2)
LINK_KERNELS(bands, 3)
LINK_KERNELS(edges, 1)
LINK_KERNELS(edges, 2)
LINK_KERNELS(edges, 3)

/* clang-format off */
#define LINK_TABLE(kernel) \
    {{kernel##_1, kernel##_1_damped}, {kernel##_2, kernel##_2_damped}, {kernel##_3, kernel##_3_damped}}
#define SCENE_KERNELS { \
    .bands = LINK_TABLE(bands), \
    .edges = LINK_TABLE(edges), \
    .kick_drift = kick_drift, \
    .solved_kick = solved_kick, \
    .solved_kick_drift = solved_kick_drift, \
    .stage = stage, \
    .first_stage = first_stage, \
    .next_stage = next_stage, \
    .last_stage = last_stage, \
}
/* clang-format on */

#endif

#endif
