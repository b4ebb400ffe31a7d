/* SPDX-License-Identifier: MIT */
/*
 * The motion of the particles of a scene, in the vectors that real.h is set to: the parts of a step, kick, solved kick,
 * drift and stages. A particle that is pinned has inverse mass 0.
 */
#ifndef SPRINGSTEP_MOTION_KERNELS_H
#define SPRINGSTEP_MOTION_KERNELS_H

#include "scene_kernels.h"
#include "solved_kick.h"

/* A vector of coordinates on one axis, of particles from i. */
typedef struct coordinates {
    size_t at;         /* in the arrays of a quantity */
    real inverse_mass; /* 0: pinned */
    real gravity;
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
    const real free = free_acceleration(s, c);
    return s->drag != 0 ? free - c->drag * v : free;
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
SPRING_INLINE bool all_coordinates(const scene_motion *motion, size_t from, size_t to, motion_part *part, bool solved)
{
    const scene_motion own = *motion, *const s = &own; /* no store changes it, for all a compiler knows */
    const coordinates all = {.kick = splat(s->kick), .drift = splat(s->drift), .weight = splat(s->weight)};
    mask wrong = {0};
    for (size_t i = from; i < to; i += lanes) {
        coordinates c = coordinates_from(s, i, all, solved);
        for (uint32_t a = 0; a < s->axes; a++) {
            SPRING_HOT_LOOP("coordinate", lanes);
            c.at = a * s->stride + i;
            c.gravity = vec_load(s->gravity + a * padding + i % quad_size); /* a vector may be shorter than a quad */
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

SPRING_INLINE real solved_velocity(const scene_motion *s, const coordinates *c, real v0, real free)
{
    const real u = v0 + c->kick * free;
    return s->drag != 0 ? c->share.keep * u + c->share.lose * u : u;
}

SPRING_INLINE mask kick_drift_predict_part(const scene_motion *s, const coordinates *c)
{
    const real v0 = vec_load(s->v0 + c->at), free = free_acceleration(s, c);
    const real v = v0 + c->kick * (s->drag != 0 ? free - c->drag * v0 : free);
    const real predicted = solved_velocity(s, c, v, free);
    vec_store(s->predicted + c->at, predicted);
    return move_to(s, c, vec_load(s->x0 + c->at) + c->drift * v, v) | not_finite(predicted);
}

SPRING_INLINE mask solved_kick_part(const scene_motion *s, const coordinates *c)
{
    const real v = solved_velocity(s, c, vec_load(s->v0 + c->at), free_acceleration(s, c));
    vec_store(s->v + c->at, v);
    return not_finite(v);
}

SPRING_INLINE mask solved_kick_drift_part(const scene_motion *s, const coordinates *c)
{
    const real v = solved_velocity(s, c, vec_load(s->v0 + c->at), free_acceleration(s, c));
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

static bool kick_drift(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, kick_drift_part, false);
}

static bool kick_drift_predict(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, kick_drift_predict_part, true);
}

static bool solved_kick(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, solved_kick_part, true);
}

static bool solved_kick_drift(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, solved_kick_drift_part, true);
}

static bool stage(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, stage_part, false);
}

static bool first_stage(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, first_stage_part, false);
}

static bool next_stage(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, next_stage_part, false);
}

static bool last_stage(const scene_motion *s, size_t from, size_t to)
{
    return all_coordinates(s, from, to, last_stage_part, false);
}

#endif
