/* SPDX-License-Identifier: MIT */
/*
 * The motion of the particles of a scene with all methods except leapfrog, for which see leapfrog_particles_tmpl.h.
 * scene_kernels.h gives the formula of each kernel.
 */
#ifndef SPRINGSTEP_PARTICLES_TMPL_H
#define SPRINGSTEP_PARTICLES_TMPL_H

#include "leapfrog_particles_tmpl.h"

SPRING_INLINE lane_mask update_implicit_kick_drift(const scene_motion *m, const coordinates *c, unsigned variant)
{
    (void)variant;
    const real v = kicked_implicitly(m, c, vec_load(m->v0 + c->at), free_acceleration(m, c));
    const lane_mask hidden = not_finite(m->kick * c->drag); /* 1/(1 + q) is 0 for infinite q */
    return store_end(m, c, vec_load(m->x0 + c->at) + m->drift * v, v) | hidden;
}

static bool move_implicit_kick_drift(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_implicit_kick_drift, 0, true);
}

/* ------------------------------------------------------------------------------------ stages of Runge-Kutta methods */

enum { NO_SUM, FIRST_SUM, NEXT_SUM };

SPRING_INLINE lane_mask update_stage(const scene_motion *m, const coordinates *c, unsigned variant)
{
    const scene_stage *const s = m->stage;
    const real dx = vec_load(s->v + c->at), dv = dragged_acceleration(m, c, dx);
    if (variant == FIRST_SUM) {
        vec_store(s->sum_x + c->at, dx);
        vec_store(s->sum_v + c->at, dv);
    } else if (variant == NEXT_SUM) {
        vec_store(s->sum_x + c->at, vec_load(s->sum_x + c->at) + s->weight * dx);
        vec_store(s->sum_v + c->at, vec_load(s->sum_v + c->at) + s->weight * dv);
    }
    const real x = vec_load(m->x0 + c->at) + m->drift * dx, v = vec_load(m->v0 + c->at) + m->kick * dv;
    if (variant == NO_SUM)
        return store_end(m, c, x, v);
    store_state(m, c, x, v);
    return not_finite(x) | not_finite(v);
}

static bool move_stage(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_stage, NO_SUM, true);
}

static bool move_first_stage(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_stage, FIRST_SUM, true);
}

static bool move_next_stage(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_stage, NEXT_SUM, true);
}

SPRING_INLINE lane_mask update_last_stage(const scene_motion *m, const coordinates *c, unsigned variant)
{
    (void)variant;
    const scene_stage *const s = m->stage;
    const real dx = vec_load(s->v + c->at), dv = dragged_acceleration(m, c, dx);
    return store_end(m, c, vec_load(m->x0 + c->at) + m->drift * (vec_load(s->sum_x + c->at) + s->weight * dx),
                     vec_load(m->v0 + c->at) + m->kick * (vec_load(s->sum_v + c->at) + s->weight * dv));
}

static bool move_last_stage(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_last_stage, 0, true);
}

/* The acceleration of stage `number`: of x or, with drag, of y = e^(drag t/2) (x - x0), where t is the time since the
   start of the step. */
SPRING_INLINE real nystrom_acceleration(const scene_motion *m, const coordinates *c, size_t number)
{
    const real free = free_acceleration(m, c);
    if (!c->dragged || number == 1)
        return free;
    const real half = c->drag / 2, moved = vec_load(m->nystrom->stage_x + c->at) - vec_load(m->x0 + c->at);
    return vec_load(m->nystrom->growth + c->mass) * (free + half * half * moved);
}

/* The weighted sum of the stored accelerations of the first `count` stages. */
SPRING_INLINE real nystrom_sum(const scene_motion *m, const coordinates *c, const scalar *weight, size_t count)
{
    real sum = weight[0] * vec_load(m->nystrom->accel + c->at);
    SPRING_ROLLED
    for (size_t i = 1; i < count; i++)
        sum += weight[i] * vec_load(m->nystrom->accel + i * m->nystrom->accel_stride + c->at);
    return sum;
}

SPRING_INLINE lane_mask update_nystrom_stage(const scene_motion *m, const coordinates *c, unsigned number)
{
    const real accel = nystrom_acceleration(m, c, number), last = m->nystrom->weight_x[number - 1] * accel;
    const real sum = number > 1 ? nystrom_sum(m, c, m->nystrom->weight_x, number - 1) + last : last;
    const real moved = m->drift * vec_load(m->v0 + c->at) + m->nystrom->square * sum;
    const real x = vec_load(m->x0 + c->at) + (c->dragged ? vec_load(m->nystrom->decay + c->mass) * moved : moved);
    vec_store(m->nystrom->accel + (number - 1) * m->nystrom->accel_stride + c->at, accel);
    vec_store(m->x + c->at, x);
    return not_finite(x);
}

static bool move_nystrom_stage(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_nystrom_stage, (unsigned)m->nystrom->number, true);
}

SPRING_INLINE lane_mask update_nystrom_end(const scene_motion *m, const coordinates *c, unsigned variant)
{
    (void)variant;
    const size_t stored = nystrom_stages;
    const real accel = nystrom_acceleration(m, c, stored + 1), x0 = vec_load(m->x0 + c->at),
               v0 = vec_load(m->v0 + c->at);
    const real moved = m->drift * v0 + m->nystrom->square * nystrom_sum(m, c, m->nystrom->weight_x, stored);
    const real kick =
        m->kick * (nystrom_sum(m, c, m->nystrom->weight_v, stored) + m->nystrom->weight_v[stored] * accel);
    if (!c->dragged)
        return store_end(m, c, x0 + moved, v0 + kick);
    const real decay = vec_load(m->nystrom->decay + c->mass), loss = vec_load(m->nystrom->loss + c->mass);
    return store_end(m, c, x0 + decay * moved, v0 + (loss * v0 + decay * (kick - c->drag / 2 * moved)));
}

static bool move_nystrom_end(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_nystrom_end, 0, true);
}

/* ------------------------------------------------------------------------------------------------ exponential kick */

SPRING_INLINE lane_mask update_drift(const scene_motion *m, const coordinates *c, unsigned variant)
{
    (void)variant;
    const real x = vec_load(m->x0 + c->at) + m->drift * vec_load(m->v0 + c->at);
    vec_store(m->x + c->at, x);
    return not_finite(x);
}

static bool move_drift(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_drift, 0, false);
}

/* The drift before the kick, which contacts replace, and the drift after it. */
SPRING_INLINE lane_mask update_drift_kick_drift(const scene_motion *m, const coordinates *c, unsigned variant)
{
    (void)variant;
    const real v = vec_load(m->stage->v + c->at);
    const real middle = vec_load(m->x0 + c->at) + m->drift * vec_load(m->v0 + c->at);
    return store_end(m, c, middle + m->drift * v, v);
}

static bool move_drift_kick_drift(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_drift_kick_drift, 0, false);
}

/* mass'/mass of an exponential kick with drag; q = h drag/mass */
SPRING_INLINE real mass_increase(real q)
{
    return 1 + q * ((scalar)0.5 + q / (12 + 2 * q));
}

/* mass/mass' in a time h. */
SPRING_INLINE real mass_ratio(const coordinates *c, scalar h)
{
    return c->dragged ? 1 / mass_increase(h * c->drag) : splat(1);
}

SPRING_INLINE lane_mask update_residual(const scene_motion *m, const coordinates *c, unsigned variant)
{
    (void)variant;
    const real residual = mass_ratio(c, m->kick) * dragged_acceleration(m, c, vec_load(m->v0 + c->at));
    vec_store(m->v + c->at, residual);
    return not_finite(residual);
}

static bool move_residual(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_residual, 0, true);
}

/* A term of Clenshaw's recurrence. The residual of a pinned particle is 0, so its terms are 0, too. */
SPRING_INLINE lane_mask update_series_term(const scene_motion *m, const coordinates *c, unsigned last)
{
    const scene_series *const s = m->series;
    const lane_mask free = c->inverse_mass > 0;
    const real inverse_mass = mass_ratio(c, s->h) * c->inverse_mass;
    const real accel = select_real(free, inverse_mass * vec_load(m->force + c->at), splat(0));
    const real term = s->coefficient * vec_load(s->residual + c->at) +
                      (s->before_weight * vec_load(s->before + c->at) -
                       s->second_weight * vec_load(s->second_before + c->at) + s->force_weight * accel);
    if (!last) {
        vec_store(m->v + c->at, term);
        return (lane_mask){0};
    }
    const real v0 = vec_load(m->v0 + c->at), v = select_real(free, v0 + m->kick * term, v0);
    vec_store(m->v + c->at, v);
    if (m->x == NULL)
        return too_fast(m, c, v);
    const real x = vec_load(m->x0 + c->at) + m->drift * v;
    vec_store(m->x + c->at, x);
    return not_finite(x) | too_fast(m, c, v);
}

SPRING_NOINLINE bool move_any_series_term(const scene_particles *p, const scene_motion *m, size_t from, size_t to,
                                          unsigned last)
{
    return for_each_vector(p, m, from, to, update_series_term, last, false);
}

static bool move_series_term(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_any_series_term(p, m, from, to, 0);
}

static bool move_last_series_term(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_any_series_term(p, m, from, to, 1);
}

/* -------------------------------------------------------------------------------- kicks, and drifts with exact drag */

SPRING_INLINE lane_mask update_kick_damped_drift(const scene_motion *m, const coordinates *c, unsigned variant)
{
    const real free = free_acceleration(m, c), start = vec_load(m->v0 + c->at);
    const real v0 = (variant & ENDS_PREVIOUS) != 0 ? start + m->kick * free : start;
    const real v = v0 + m->kick * free, x = vec_load(m->x0 + c->at) + vec_load(m->damped_drift->span + c->mass) * v;
    store_state(m, c, x, v + vec_load(m->damped_drift->loss + c->mass) * v);
    return (variant & ENDS_PREVIOUS) != 0 ? not_finite(x) | too_fast(m, c, v0) : not_finite(x);
}

static bool move_kick_damped_drift(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_vector(p, m, from, to, update_kick_damped_drift, m->ends_previous ? ENDS_PREVIOUS : 0, true);
}

#endif
