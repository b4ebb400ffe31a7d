/* SPDX-License-Identifier: MIT */
/*
 * The motion of the particles of a scene, in the vectors that real.h is set to: the parts of a step, kick, solved kick,
 * drift and stages. A particle that is pinned has inverse mass 0.
 */
#ifndef SPRINGSTEP_MOTION_KERNELS_H
#define SPRINGSTEP_MOTION_KERNELS_H

#include "scene_kernels.h"
#include "simd/quad.h"
#include "solved_kick.h"

/* A vector of coordinates on one axis. */
typedef struct coordinates {
    size_t at;         /* in the arrays of a quantity */
    size_t mass;       /* in those of masses */
    real inverse_mass; /* 0: pinned */
    real gravity;
    real drag;          /* [1/s] */
    bool dragged;       /* is there any? */
    solved_share share; /* of a solved kick; without drag unset */
} coordinates;

static const scalar lane_number[padding] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/* By force and gravity. A particle that is pinned feels no force, not even an infinite one. */
SPRING_INLINE real free_acceleration(const scene_motion *s, const coordinates *c)
{
    const real free = c->inverse_mass * vec_load(s->force + c->at) + c->gravity;
    return select_real(c->inverse_mass > 0, free, splat(0));
}

SPRING_INLINE real acceleration(const scene_motion *s, const coordinates *c, real v)
{
    const real free = free_acceleration(s, c);
    return c->dragged ? free - c->drag * v : free;
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
SPRING_INLINE bool all_coordinates(const scene_particles *particles, const scene_motion *motion, size_t from, size_t to,
                                   motion_part *part)
{
    const scene_particles p = *particles; /* no store changes these, for all a compiler knows */
    const scene_motion m = *motion;
    mask wrong = {0};
    for (uint32_t a = 0; a < p.axes; a++) {
        const scalar *const quad_gravity = p.gravity + a * padding;
        const real gravity = vec_load(quad_gravity);
        for (size_t i = from; i < to; i += lanes) {
            SPRING_HOT_LOOP("coordinate", lanes);
            real inverse_mass = vec_load(p.inverse_mass + i * p.mass_step);
            if (SPRING_UNLIKELY(i + lanes > p.count)) /* what fills the last vector stays where it is, and finite */
                inverse_mass =
                    select_real(vec_load(lane_number) < splat((scalar)(p.count - i)), inverse_mass, splat(0));
            coordinates c = {
                .at = a * p.stride + i,
                .mass = i * p.mass_step,
                .inverse_mass = inverse_mass,
                .gravity = lanes < (size_t)quad_size ? vec_load(quad_gravity + i % quad_size) : gravity,
                .drag = p.drag * inverse_mass,
                .dragged = p.drag != 0,
            };
            if (c.dragged)
                c.share = solved_share_of(m.kick * c.drag);
            wrong |= part(&m, &c);
        }
    }
    return !any(wrong);
}

SPRING_INLINE real solved_velocity(const scene_motion *s, const coordinates *c, real v0, real free)
{
    const real u = v0 + s->kick * free;
    return c->dragged ? c->share.keep * u + c->share.lose * u : u;
}

/* again: after the solved kick that ends the step before */
SPRING_INLINE mask kick_and_drift(const scene_motion *s, const coordinates *c, bool again, bool predict)
{
    const real free = free_acceleration(s, c), start = vec_load(s->v0 + c->at);
    const real v0 = again ? solved_velocity(s, c, start, free) : start;
    const real v = v0 + s->kick * (c->dragged ? free - c->drag * v0 : free);
    const mask wrong = move_to(s, c, vec_load(s->x0 + c->at) + s->drift * v, v);
    if (!predict)
        return wrong;
    const real predicted = solved_velocity(s, c, v, free);
    vec_store(s->predicted + c->at, predicted);
    return wrong | not_finite(predicted);
}

SPRING_INLINE mask kick_drift_part(const scene_motion *s, const coordinates *c)
{
    return kick_and_drift(s, c, false, false);
}

SPRING_INLINE mask kick_drift_predict_part(const scene_motion *s, const coordinates *c)
{
    return kick_and_drift(s, c, false, true);
}

SPRING_INLINE mask kick_kick_drift_part(const scene_motion *s, const coordinates *c)
{
    return kick_and_drift(s, c, true, false);
}

SPRING_INLINE mask kick_kick_drift_predict_part(const scene_motion *s, const coordinates *c)
{
    return kick_and_drift(s, c, true, true);
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
    const mask hidden = not_finite(s->kick * c->drag); /* in 1/(1 + q) */
    return move_to(s, c, vec_load(s->x0 + c->at) + s->drift * v, v) | hidden;
}

SPRING_INLINE mask move_along(const scene_motion *s, const coordinates *c, real dx, real dv)
{
    return move_to(s, c, vec_load(s->x0 + c->at) + s->drift * dx, vec_load(s->v0 + c->at) + s->kick * dv);
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
    vec_store(s->sum_x + c->at, vec_load(s->sum_x + c->at) + s->weight * dx);
    vec_store(s->sum_v + c->at, vec_load(s->sum_v + c->at) + s->weight * dv);
    return move_along(s, c, dx, dv);
}

SPRING_INLINE mask last_stage_part(const scene_motion *s, const coordinates *c)
{
    const real dx = vec_load(s->slope + c->at), dv = acceleration(s, c, dx);
    return move_along(s, c, vec_load(s->sum_x + c->at) + dx, vec_load(s->sum_v + c->at) + dv);
}

/* The acceleration of a stage, number `stage` from 1 on, by the force found there: of x, or with drag of
   y = e^(drag t/2) (x - x0), t from the start of the step. */
SPRING_INLINE real nystrom_slope(const scene_motion *s, const coordinates *c, size_t stage)
{
    const real free = free_acceleration(s, c);
    if (!c->dragged || stage == 1)
        return free;
    const real half = c->drag / 2, moved = vec_load(s->nystrom->stage_x + c->at) - vec_load(s->x0 + c->at);
    return vec_load(s->nystrom->growth + c->mass) * (free + half * half * moved);
}

/* Of slopes that are stored. */
SPRING_INLINE real nystrom_sum(const scene_motion *s, const coordinates *c, const scalar *weight, size_t count)
{
    real sum = weight[0] * vec_load(s->nystrom->slopes + c->at);
    SPRING_UNROLL
    for (size_t i = 1; i < count; i++)
        sum += weight[i] * vec_load(s->nystrom->slopes + i * s->nystrom->slope_step + c->at);
    return sum;
}

SPRING_INLINE mask stage_of_nystrom(const scene_motion *s, const coordinates *c, size_t stage)
{
    const real slope = nystrom_slope(s, c, stage), last = s->nystrom->weight_x[stage - 1] * slope;
    const real sum = stage > 1 ? nystrom_sum(s, c, s->nystrom->weight_x, stage - 1) + last : last;
    const real moved = s->drift * vec_load(s->v0 + c->at) + s->nystrom->square * sum;
    const real x = vec_load(s->x0 + c->at) + (c->dragged ? vec_load(s->nystrom->decay + c->mass) * moved : moved);
    vec_store(s->nystrom->slopes + (stage - 1) * s->nystrom->slope_step + c->at, slope);
    vec_store(s->x + c->at, x);
    return not_finite(x);
}

SPRING_INLINE mask nystrom_end_part(const scene_motion *s, const coordinates *c)
{
    const size_t stored = nystrom_stages;
    const real slope = nystrom_slope(s, c, stored + 1), x0 = vec_load(s->x0 + c->at), v0 = vec_load(s->v0 + c->at);
    const real moved = s->drift * v0 + s->nystrom->square * nystrom_sum(s, c, s->nystrom->weight_x, stored);
    const real kick =
        s->kick * (nystrom_sum(s, c, s->nystrom->weight_v, stored) + s->nystrom->weight_v[stored] * slope);
    if (!c->dragged)
        return move_to(s, c, x0 + moved, v0 + kick);
    const real decay = vec_load(s->nystrom->decay + c->mass), loss = vec_load(s->nystrom->loss + c->mass);
    return move_to(s, c, x0 + decay * moved, v0 + (loss * v0 + decay * (kick - c->drag / 2 * moved)));
}

#define NYSTROM_STAGE(stage)                                                                     \
    SPRING_INLINE mask nystrom_stage_##stage##_part(const scene_motion *s, const coordinates *c) \
    {                                                                                            \
        return stage_of_nystrom(s, c, stage);                                                    \
    }

NYSTROM_STAGE(1)
NYSTROM_STAGE(2)
NYSTROM_STAGE(3)
NYSTROM_STAGE(4)
NYSTROM_STAGE(5)
NYSTROM_STAGE(6)
NYSTROM_STAGE(7)

#define MOTION_KERNEL(name)                                                                          \
    static bool move_##name(const scene_particles *p, const scene_motion *s, size_t from, size_t to) \
    {                                                                                                \
        return all_coordinates(p, s, from, to, name##_part);                                         \
    }

MOTION_KERNEL(kick_drift)
MOTION_KERNEL(kick_drift_predict)
MOTION_KERNEL(kick_kick_drift)
MOTION_KERNEL(kick_kick_drift_predict)
MOTION_KERNEL(solved_kick)
MOTION_KERNEL(solved_kick_drift)
MOTION_KERNEL(stage)
MOTION_KERNEL(first_stage)
MOTION_KERNEL(next_stage)
MOTION_KERNEL(last_stage)
MOTION_KERNEL(nystrom_stage_1)
MOTION_KERNEL(nystrom_stage_2)
MOTION_KERNEL(nystrom_stage_3)
MOTION_KERNEL(nystrom_stage_4)
MOTION_KERNEL(nystrom_stage_5)
MOTION_KERNEL(nystrom_stage_6)
MOTION_KERNEL(nystrom_stage_7)
MOTION_KERNEL(nystrom_end)

#endif
