/* SPDX-License-Identifier: MIT */
/*
 * The loops over the particles and links of a scene, in the vectors that real.h is set to.
 *
 * Rows      Links whose ends are the same number of particles apart, as in a rope, a sheet or a block, lie in one row,
 *           by their lower end; where the row has no link its stiffness is 0. Each particle pulls from both sides: it
 *           gathers from neighbours at fixed distances and nothing is scattered. Every force is computed twice, once for
 *           either end, with opposite signs and otherwise the same bits, so momentum is conserved to rounding.
 * List      All other links, in blocks: gather, vector arithmetic, scatter in the order of the links.
 * Motion    The parts of a step: kick, drift, stages. A particle that is pinned has inverse mass 0.
 */
#ifndef SPRINGSTEP_SCENE_KERNELS_H
#define SPRINGSTEP_SCENE_KERNELS_H

#include "leapfrog.h"
#include "real.h"

#include <stddef.h>

#ifdef SPRING_FLOAT
#define SCENE(name) spring_scenef_##name
#else
#define SCENE(name) spring_scene_##name
#endif

enum {
    padding = 16
}; /* elements before and after what vectors read: as many as the longest vector has lanes */

/* Links whose upper end is `offset` particles after the lower one. Arrays start `padding` before the first lower end. */
typedef struct scene_row {
    ptrdiff_t offset;
    ptrdiff_t first, end;  /* of the lower ends */
    const int8_t *present; /* -1 where there is a link, else 0; NULL: each link has numbers of its own */
    const scalar
        *stiffness;        /* [N/m]; of a vector of equal links, or of each place, 0 where there is no link */
    const scalar *rest;    /* [m]; negative on one axis where the link runs from the upper end to the lower */
    const scalar *damping; /* [N s/m]; NULL: none in the scene */
} scene_row;

typedef struct scene_list {
    size_t count;
    const uint32_t *a, *b;
    const scalar *stiffness, *rest, *damping; /* damping as in scene_row */
} scene_list;

typedef struct scene_links { /* what a force kernel works on */
    size_t particles;
    size_t stride; /* elements from one axis to the next */
    const scalar *x, *v;
    scalar *force;
    size_t rows;
    const scene_row *row;
    scene_list list;
} scene_links;

typedef struct scene_motion { /* what moves particles; the pointers are set for each kernel, see there */
    size_t particles;
    uint32_t axes;
    size_t stride;              /* elements from one axis to the next */
    const scalar *inverse_mass; /* NULL: one for all */
    scalar inverse_mass_all;
    scalar gravity[3];
    scalar drag;
    scalar h;
    const scalar *force;
    const scalar *x0, *v0; /* from */
    scalar *x, *v;         /* to */
    const scalar *stage_v; /* RK4: velocity of the stage that `force` belongs to */
    scalar *sum_x, *sum_v; /* RK4: weighted sums of the stages */
} scene_motion;

typedef void scene_link_kernel(const scene_links *);
typedef bool scene_motion_kernel(const scene_motion *); /* false: a number is infinite or NaN */

typedef struct scene_kernels {
    scene_link_kernel *rows[3][2]; /* by axes - 1, damping */
    scene_link_kernel *list[3][2];
    scene_motion_kernel *euler;        /* x0, v0 -> x, v */
    scene_motion_kernel *kick_drift;   /* x0, v0 -> x, v */
    scene_motion_kernel *kick;         /* v0 -> v, drag solved for */
    scene_motion_kernel *rk4_stage[3]; /* stage_v, x0, v0 -> x, v, sums */
    scene_motion_kernel *rk4_end;      /* stage_v, x0, v0, sums -> x, v */
} scene_kernels;

extern const scene_kernels SCENE(v128), SCENE(v256), SCENE(v512); /* by bytes of a vector */

#ifdef SPRING_VECTOR

/* ---------------------------------------------------------------------------------------------------------- links */

/* The force of a link on one of its ends is this times the way to the other end: k (1 - rest/length), and with damping
   c (relative velocity . way)/length^2. Not a number where both are at one place: see to_force(). */
SPRING_INLINE real pull(uint32_t axes, const real *way, const real *relative, real square, real k, real rest,
                        real c, bool damped)
{
    real scale = k * (1 - rest / root(square));
    if (damped) {
        real rate = way[0] * relative[0];
        SPRING_UNROLL
        for (uint32_t a = 1; a < axes; a++)
            rate += way[a] * relative[a];
        scale += c * (rate / square);
    }
    return scale;
}

/* Turns the way from one end of a link to the other into the force on the one. Where there is no link, or no direction,
   that is 0, selected and not multiplied: particles that are not joined may be infinitely far apart. */
SPRING_INLINE void to_force(uint32_t axes, real *way, const real *relative, truth joined, real k, real rest,
                            real c, bool damped)
{
    if (axes == 1) {
        const real pull = k * (way[0] - rest);
        way[0] = select_real(joined, damped ? pull + c * relative[0] : pull, splat(0));
        return;
    }
    real square = way[0] * way[0];
    SPRING_UNROLL
    for (uint32_t a = 1; a < axes; a++)
        square += way[a] * way[a];
    const real scale = pull(axes, way, relative, square, k, rest, c, damped);
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++)
        way[a] = select_real(joined & (square > 0), scale * way[a], splat(0));
}

/* Adds what one side of a row does to the vector of particles from i: the upper neighbours, or the lower. */
SPRING_INLINE void pull_side(const scene_links *s, const scene_row *row, ptrdiff_t i, bool upper,
                             uint32_t axes, bool damped, const real *x, const real *v, real *force)
{
    const ptrdiff_t offset = upper ? row->offset : -row->offset;
    const ptrdiff_t at = (upper ? i : i + offset) - row->first + padding;
    const ptrdiff_t number = row->present != NULL ? 0 : at;
    const real k = load(row->stiffness + number), c = damped ? load(row->damping + number) : splat(0);
    const real rest = load(row->rest + number);
    const truth joined = row->present != NULL ? load_truth(row->present + at) : (k > 0) | (c > 0);
    real way[3], relative[3];
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++) {
        way[a] = load(s->x + a * s->stride + i + offset) - x[a];
        if (damped)
            relative[a] = load(s->v + a * s->stride + i + offset) - v[a];
    }
    /* On one axis the rest length has the direction from the lower end to the upper. */
    to_force(axes, way, relative, joined, k, axes == 1 && !upper ? -rest : rest, c, damped);
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++)
        force[a] += way[a];
}

/* The vector of particles from i; everywhere: each side of each row reaches all of them. */
SPRING_INLINE void rows_at(const scene_links *s, ptrdiff_t i, uint32_t axes, bool damped, bool everywhere)
{
    real x[3], v[3], force[3];
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++) {
        x[a] = load(s->x + a * s->stride + i);
        if (damped)
            v[a] = load(s->v + a * s->stride + i);
        force[a] = splat(0);
    }
    const scene_row *const end = s->row + s->rows;
    for (const scene_row *row = s->row; row < end; row++) {
        if (everywhere || (i + lanes > row->first && i < row->end))
            pull_side(s, row, i, true, axes, damped, x, v, force);
        if (everywhere || (i + lanes > row->first + row->offset && i < row->end + row->offset))
            pull_side(s, row, i, false, axes, damped, x, v, force);
    }
    SPRING_UNROLL
    for (uint32_t a = 0; a < axes; a++)
        store(s->force + a * s->stride + i, force[a]);
}

SPRING_INLINE void rows(const scene_links *s, uint32_t axes, bool damped)
{
    const ptrdiff_t particles = (ptrdiff_t)s->particles;
    ptrdiff_t from = 0, to = particles; /* between them every side of every row reaches all of a vector */
    for (size_t r = 0; r < s->rows; r++) {
        const scene_row *row = &s->row[r];
        from = row->first + row->offset > from ? row->first + row->offset : from;
        to = row->end < to ? row->end : to;
    }
    ptrdiff_t i = 0;
    for (; i < particles && i < from; i += lanes)
        rows_at(s, i, axes, damped, false);
    for (; i + lanes <= to; i += lanes)
        rows_at(s, i, axes, damped, true);
    for (; i < particles; i += lanes)
        rows_at(s, i, axes, damped, false);
}

enum { block = 64 }; /* links whose ends are gathered together: they stay in the first cache */

SPRING_INLINE void list(const scene_links *s, uint32_t axes, bool damped)
{
    const scene_list *l = &s->list;
    for (size_t first = 0; first < l->count; first += block) {
        const size_t count = l->count - first < block ? l->count - first : block;
        const uint32_t *from = l->a + first, *to = l->b + first;
        scalar way[3][block], relative[3][block];
        for (size_t j = 0; j < count; j++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                way[a][j] = s->x[a * s->stride + to[j]] - s->x[a * s->stride + from[j]];
                if (damped)
                    relative[a][j] = s->v[a * s->stride + to[j]] - s->v[a * s->stride + from[j]];
            }
        }
        for (size_t j = count; j % lanes != 0; j++) /* what fills the last vector */
            for (uint32_t a = 0; a < axes; a++)
                way[a][j] = relative[a][j] = 0;
        for (size_t j = 0; j < count; j += lanes) {
            const real k = load(l->stiffness + first + j), rest = load(l->rest + first + j);
            const real c = damped ? load(l->damping + first + j) : splat(0);
            real w[3], r[3];
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                w[a] = load(&way[a][j]);
                r[a] = damped ? load(&relative[a][j]) : splat(0);
            }
            to_force(axes, w, r, (k > 0) | (c > 0), k, rest, c, damped);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                store(&way[a][j], w[a]);
        }
        for (size_t j = 0; j < count; j++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                s->force[a * s->stride + from[j]] += way[a][j];
                s->force[a * s->stride + to[j]] -= way[a][j];
            }
        }
    }
}

/* --------------------------------------------------------------------------------------------------------- motion */

typedef struct particle_vector { /* what is the same on every axis */
    real inverse_mass;
    real drag; /* [1/s] */
} particle_vector;

static const scalar lane_number[padding] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

SPRING_INLINE particle_vector particles_at(const scene_motion *s, size_t i)
{
    real inverse_mass = s->inverse_mass != NULL ? load(s->inverse_mass + i) : splat(s->inverse_mass_all);
    if (i + lanes > s->particles) /* what fills the last vector stays where it is, and finite */
        inverse_mass =
            select_real(load(lane_number) < splat((scalar)(s->particles - i)), inverse_mass, splat(0));
    return (particle_vector){inverse_mass, s->drag * inverse_mass};
}

/* Without drag. A particle that is pinned feels no force, not even an infinite one. */
SPRING_INLINE real acceleration(const scene_motion *s, const particle_vector *p, uint32_t a, size_t i)
{
    const real free = p->inverse_mass * load(s->force + i) + s->gravity[a];
    return select_real(p->inverse_mass > 0, free, splat(0));
}

#define FOR_EACH_VECTOR(s, i) for (size_t i = 0; i < (s)->particles; i += lanes)

static bool euler(const scene_motion *s)
{
    const real h = splat(s->h);
    truth wrong = {0};
    FOR_EACH_VECTOR(s, i)
    {
        const particle_vector p = particles_at(s, i);
        for (uint32_t a = 0; a < s->axes; a++) {
            const size_t at = a * s->stride + i;
            const real v = load(s->v0 + at);
            const real x1 = load(s->x0 + at) + h * v;
            const real v1 = v + h * (acceleration(s, &p, a, at) - p.drag * v);
            store(s->x + at, x1);
            store(s->v + at, v1);
            wrong |= not_finite(x1) | not_finite(v1);
        }
    }
    return !any(wrong);
}

static bool kick_drift(const scene_motion *s)
{
    const real h = splat(s->h), half = h / 2;
    truth wrong = {0};
    FOR_EACH_VECTOR(s, i)
    {
        const particle_vector p = particles_at(s, i);
        for (uint32_t a = 0; a < s->axes; a++) {
            const size_t at = a * s->stride + i;
            const real v = load(s->v0 + at);
            const real v1 = v + half * (acceleration(s, &p, a, at) - p.drag * v);
            const real x1 = load(s->x0 + at) + h * v1;
            store(s->x + at, x1);
            store(s->v + at, v1);
            wrong |= not_finite(x1) | not_finite(v1);
        }
    }
    return !any(wrong);
}

static bool kick(const scene_motion *s)
{
    const real half = splat(s->h) / 2;
    truth wrong = {0};
    FOR_EACH_VECTOR(s, i)
    {
        const particle_vector p = particles_at(s, i);
        const leapfrog_share share = leapfrog_share_of(half * p.drag);
        for (uint32_t a = 0; a < s->axes; a++) {
            const size_t at = a * s->stride + i;
            const real u = load(s->v0 + at) + half * acceleration(s, &p, a, at);
            const real v1 = s->drag != 0 ? share.keep * u + share.lose * u : u;
            store(s->v + at, v1);
            wrong |= not_finite(v1);
        }
    }
    return !any(wrong);
}

/* Adds a stage to the weighted sums and goes on to the state of the next one. */
SPRING_INLINE bool rk4_stage(const scene_motion *s, bool first, scalar weight, scalar fraction)
{
    const real step = splat(s->h) * fraction;
    truth wrong = {0};
    FOR_EACH_VECTOR(s, i)
    {
        const particle_vector p = particles_at(s, i);
        for (uint32_t a = 0; a < s->axes; a++) {
            const size_t at = a * s->stride + i;
            const real dx = load(s->stage_v + at);
            const real dv = acceleration(s, &p, a, at) - p.drag * dx;
            const real x1 = load(s->x0 + at) + step * dx;
            const real v1 = load(s->v0 + at) + step * dv;
            store(s->sum_x + at, first ? dx : load(s->sum_x + at) + weight * dx);
            store(s->sum_v + at, first ? dv : load(s->sum_v + at) + weight * dv);
            store(s->x + at, x1);
            store(s->v + at, v1);
            wrong |= not_finite(x1) | not_finite(v1);
        }
    }
    return !any(wrong);
}

static bool rk4_stage_1(const scene_motion *s)
{
    return rk4_stage(s, true, 1, (scalar)0.5);
}

static bool rk4_stage_2(const scene_motion *s)
{
    return rk4_stage(s, false, 2, (scalar)0.5);
}

static bool rk4_stage_3(const scene_motion *s)
{
    return rk4_stage(s, false, 2, 1);
}

static bool rk4_end(const scene_motion *s)
{
    const real sixth = splat(s->h) / 6;
    truth wrong = {0};
    FOR_EACH_VECTOR(s, i)
    {
        const particle_vector p = particles_at(s, i);
        for (uint32_t a = 0; a < s->axes; a++) {
            const size_t at = a * s->stride + i;
            const real dx = load(s->stage_v + at);
            const real dv = acceleration(s, &p, a, at) - p.drag * dx;
            const real x1 = load(s->x0 + at) + sixth * (load(s->sum_x + at) + dx);
            const real v1 = load(s->v0 + at) + sixth * (load(s->sum_v + at) + dv);
            store(s->x + at, x1);
            store(s->v + at, v1);
            wrong |= not_finite(x1) | not_finite(v1);
        }
    }
    return !any(wrong);
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

LINK_KERNELS(rows, 1)
LINK_KERNELS(rows, 2)
LINK_KERNELS(rows, 3)
LINK_KERNELS(list, 1)
LINK_KERNELS(list, 2)
LINK_KERNELS(list, 3)

#define LINK_TABLE(kernel)                                                \
    {                                                                     \
        {kernel##_1, kernel##_1_damped}, {kernel##_2, kernel##_2_damped}, \
        {                                                                 \
            kernel##_3, kernel##_3_damped                                 \
        }                                                                 \
    }

/* clang-format off */
#define SCENE_KERNELS {                                                                                        \
    LINK_TABLE(rows), LINK_TABLE(list), euler, kick_drift, kick, {rk4_stage_1, rk4_stage_2, rk4_stage_3}, rk4_end \
}
/* clang-format on */

#endif

#endif
