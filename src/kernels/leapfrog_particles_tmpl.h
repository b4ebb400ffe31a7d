/* SPDX-License-Identifier: MIT */
/*
 * The motion of the particles of a scene on SIMD vectors: the loop over particles, and the kicks and drifts of
 * leapfrog. scene_kernels.h gives the formula of each kernel. A pinned particle has inverse mass 0.
 */
#ifndef SPRINGSTEP_LEAPFROG_PARTICLES_TMPL_H
#define SPRINGSTEP_LEAPFROG_PARTICLES_TMPL_H

#include "../methods/implicit_kick_tmpl.h"
#include "../simd/real_tmpl.h"
#include "scene_kernels.h"

/* A vector of coordinates along one axis. */
typedef struct coordinates {
    size_t at;         /* index in the arrays of a quantity */
    size_t mass;       /* index in the arrays of masses */
    real inverse_mass; /* 0: pinned */
    real gravity;
    real drag;                /* [1/s] */
    bool dragged;             /* the scene has drag */
    implicit_factors damping; /* of an implicit kick; unset without drag */
    bool holds;               /* constant: there may be held forces */
    real held;                /* [N] held force */
} coordinates;

/* The first `count` lanes, 1 <= count <= padding. */
SPRING_INLINE lane_mask first_lanes(size_t count)
{
    static const int8_t bytes[2 * padding] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    return vec_load_mask(bytes + padding - count);
}

/* By force, held force and gravity. No force accelerates a pinned particle, not even an infinite one. */
SPRING_INLINE real free_acceleration(const scene_motion *m, const coordinates *c)
{
    const real force = c->holds ? vec_load(m->force + c->at) + c->held : vec_load(m->force + c->at);
    const real free = c->inverse_mass * force + c->gravity;
    return select_real(c->inverse_mass > 0, free, splat(0));
}

SPRING_INLINE real dragged_acceleration(const scene_motion *m, const coordinates *c, real v)
{
    const real free = free_acceleration(m, c);
    return c->dragged ? free - c->drag * v : free;
}

/* Lanes of free particles whose velocity at the end of a step is above max_speed, infinite or NaN. */
SPRING_INLINE lane_mask too_fast(const scene_motion *m, const coordinates *c, real v)
{
    return not_mask(vec_abs(v) <= m->max_speed) & (c->inverse_mass > 0);
}

SPRING_INLINE void store_state(const scene_motion *m, const coordinates *c, real x, real v)
{
    vec_store(m->x + c->at, x);
    vec_store(m->v + c->at, v);
}

/* Stores the state at the end of a step. Returns the lanes that are not finite or too fast. */
SPRING_INLINE lane_mask store_end(const scene_motion *m, const coordinates *c, real x, real v)
{
    store_state(m, c, x, v);
    return not_finite(x) | too_fast(m, c, v);
}

/* Advances one vector of coordinates. Returns the lanes whose result is infinite, NaN or too fast. variant is a
   constant. */
typedef lane_mask particle_update(const scene_motion *m, const coordinates *c, unsigned variant);

/* The loop of all kernels. holds is a constant; if true, a scene without held forces adds -0, which changes no bit. */
SPRING_INLINE bool for_each_vector(const scene_particles *particles, const scene_motion *motion, size_t from, size_t to,
                                   particle_update *update, unsigned variant, bool holds)
{
    const scene_particles p = *particles; /* local copies, so that stores cannot alias their fields */
    const scene_motion m = *motion;
    lane_mask wrong = {0};
    for (uint32_t a = 0; a < p.axes; a++) {
        const real gravity = vec_load(p.gravity + a * padding);
        const scalar *const held = p.held + a * p.stride * p.held_stride;
        for (size_t i = from; i < to; i += lanes) {
            real inverse_mass = vec_load(p.inverse_mass + i * p.mass_stride);
            if (SPRING_UNLIKELY(i + lanes > p.count)) /* padding lanes of the last vector keep their finite values */
                inverse_mass = select_real(first_lanes(p.count - i), inverse_mass, splat(0));
            coordinates c = {
                .at = a * p.stride + i,
                .mass = i * p.mass_stride,
                .inverse_mass = inverse_mass,
                .gravity = gravity,
                .drag = p.drag * inverse_mass,
                .dragged = p.drag != 0,
                .holds = holds,
                .held = holds ? vec_load(held + i * p.held_stride) : splat(0),
            };
            if (c.dragged)
                c.damping = implicit_factors_of(m.kick * c.drag);
            wrong |= update(&m, &c, variant);
        }
    }
    return !any(wrong);
}

/* The velocity after an implicit kick by the acceleration `free`. */
SPRING_INLINE real kicked_implicitly(const scene_motion *m, const coordinates *c, real v0, real free)
{
    const real u = v0 + m->kick * free;
    return c->dragged ? implicit_velocity(u, &c->damping) : u;
}

enum { ENDS_PREVIOUS = 1, PREDICTS = 2 };

SPRING_INLINE lane_mask update_kick_drift(const scene_motion *m, const coordinates *c, unsigned variant)
{
    const real free = free_acceleration(m, c), start = vec_load(m->v0 + c->at);
    const real v0 = (variant & ENDS_PREVIOUS) != 0 ? kicked_implicitly(m, c, start, free) : start;
    const real v = v0 + m->kick * (c->dragged ? free - c->drag * v0 : free), x = vec_load(m->x0 + c->at) + m->drift * v;
    store_state(m, c, x, v);
    lane_mask wrong = not_finite(x); /* also if v0 or v is not finite */
    if ((variant & ENDS_PREVIOUS) != 0)
        wrong |= (vec_abs(v0) > m->max_speed) & (c->inverse_mass > 0); /* not NaN, see above */
    if ((variant & PREDICTS) == 0)
        return wrong;
    const real predicted = kicked_implicitly(m, c, v, free);
    vec_store(m->predicted + c->at, predicted);
    return wrong | not_finite(predicted);
}

/* Without held forces. */
static bool move_kick_drift_free(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    if (m->predicted == NULL)
        return m->ends_previous ? for_each_vector(p, m, from, to, update_kick_drift, ENDS_PREVIOUS, false)
                                : for_each_vector(p, m, from, to, update_kick_drift, 0, false);
    return m->ends_previous ? for_each_vector(p, m, from, to, update_kick_drift, ENDS_PREVIOUS | PREDICTS, false)
                            : for_each_vector(p, m, from, to, update_kick_drift, PREDICTS, false);
}

SPRING_INLINE lane_mask update_implicit_kick(const scene_motion *m, const coordinates *c, unsigned variant)
{
    (void)variant;
    const real v = kicked_implicitly(m, c, vec_load(m->v0 + c->at), free_acceleration(m, c));
    vec_store(m->v + c->at, v);
    return too_fast(m, c, v);
}

/* Without held forces. */
static bool move_implicit_kick_free(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_implicit_kick, 0, false);
}

/* --------------------------------------------------------------------------------------------------------- kernels */

#if SPRING_VECTOR < 64

/* Leapfrog has separate loops for held forces, so that they cost other scenes nothing. */
SPRING_NOINLINE bool move_kick_drift_held(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    const unsigned ends = m->ends_previous ? ENDS_PREVIOUS : 0, predicts = m->predicted != NULL ? PREDICTS : 0;
    return for_each_vector(p, m, from, to, update_kick_drift, ends | predicts, true);
}

SPRING_NOINLINE bool move_implicit_kick_held(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_implicit_kick, 0, true);
}

#endif

/* With held forces, vectors of 64 bytes use the kernels for shorter vectors. */
static bool move_kick_drift(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
#if SPRING_VECTOR == 64
    if (p->held_stride != 0)
        return SPRING_COMMON_TABLE.kick_drift(p, m, from, to);
#else
    if (p->held_stride != 0 || SPRING_COMPACT)
        return move_kick_drift_held(p, m, from, to);
#endif
    return move_kick_drift_free(p, m, from, to);
}

static bool move_implicit_kick(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
#if SPRING_VECTOR == 64
    if (p->held_stride != 0)
        return SPRING_COMMON_TABLE.implicit_kick(p, m, from, to);
#else
    if (p->held_stride != 0 || SPRING_COMPACT)
        return move_implicit_kick_held(p, m, from, to);
#endif
    return move_implicit_kick_free(p, m, from, to);
}

#endif
