/* SPDX-License-Identifier: MIT */
/*
 * The kernels of particles_tmpl.h for scenes with colliders. First, all particles are advanced without colliders, one
 * SIMD vector of particles at a time with all their axes. Particles that may be in contact are collected in a queue,
 * and are advanced again in full SIMD vectors by resolve_...(). Few particles touch a collider, so most vectors of
 * neighbours would be nearly empty.
 */
#ifndef SPRINGSTEP_CONTACT_LOOPS_TMPL_H
#define SPRINGSTEP_CONTACT_LOOPS_TMPL_H

#include "contact_queue_tmpl.h"

SPRING_NOINLINE mask resolve_kick_drift(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                        bool ends_step)
{
    const real3 x0 = queued_value(q, QUEUED_X0), free = queued_value(q, QUEUED_THIRD);
    real3 v0 = queued_value(q, QUEUED_V0);
    mask wrong = {0};
    drifting d;
    d.start.count = 0;
    d.start.kept = 0;
    if (ends_step) {
        stop_at_colliders(m->contacts, load_bits(q->before), STEP_START, p->free, &x0, &v0, &d.start);
        wrong = too_fast3(m, p, v0);
    }
    const real3 accel = minus_drag(p, free, v0), w = plus_scaled3(v0, splat(m->kick), accel);
    d.x0 = x0;
    d.accel = accel;
    d.d = times3(splat(m->drift), w);
    d.w = w;
    d.free = p->free;
    d.h = m->drift;
    d.kappa = (scalar)0.5;
    drift_group(m->contacts, q, &d);
    const real3 x = plus3(x0, d.d);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, d.w);
    wrong |= not_finite3(x) | not_finite3(d.w);
    if (m->predicted == NULL)
        return wrong;
    real3 predicted = kicked_implicitly3(m, p, d.w, free);
    kept_contacts found;
    stop_at_colliders(m->contacts, d.touched, STEP_END, p->free, &x, &predicted, &found);
    scatter(q, p, m->predicted, predicted);
    return wrong | not_finite3(predicted);
}

SPRING_NOINLINE mask resolve_implicit_kick(const scene_motion *m, const particle_vector *p, const contact_queue *q)
{
    const real3 x = queued_value(q, QUEUED_X0);
    real3 v = queued_value(q, QUEUED_V0);
    kept_contacts found;
    stop_at_colliders(m->contacts, load_bits(q->before), STEP_END, p->free, &x, &v, &found);
    scatter(q, p, m->v, v);
    return too_fast3(m, p, v);
}

SPRING_NOINLINE mask resolve_implicit_kick_drift(const scene_motion *m, const particle_vector *p,
                                                 const contact_queue *q)
{
    const real3 x0 = queued_value(q, QUEUED_X0), w = queued_value(q, QUEUED_V0);
    drifting d;
    d.x0 = x0;
    d.accel = queued_value(q, QUEUED_THIRD);
    d.d = times3(splat(m->drift), w);
    d.w = w;
    d.free = p->free;
    d.h = m->drift;
    d.kappa = 1;
    d.start.kept = 0;
    drift_group(m->contacts, q, &d);
    const real3 x = plus3(x0, d.d);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, d.w);
    return not_finite3(x) | too_fast3(m, p, d.w);
}

/* Contacts are computed as for a drift with the mean velocity and kicks by the mean acceleration. */
SPRING_NOINLINE mask resolve_last_stage(const scene_motion *m, const particle_vector *p, const contact_queue *q)
{
    const scalar h = m->contacts->h;
    const real3 x0 = queued_value(q, QUEUED_X0), v0 = queued_value(q, QUEUED_V0);
    const real3 x1 = queued_value(q, QUEUED_THIRD), v1 = queued_value(q, QUEUED_FOURTH);
    const real3 way = minus3(x1, x0), w = over3(way, splat(h)), second_kick = minus3(v1, w);
    drifting d;
    d.x0 = x0;
    d.accel = over3(minus3(v1, v0), splat(h));
    d.d = way;
    d.w = w;
    d.free = p->free;
    d.h = h;
    d.kappa = (scalar)0.5;
    d.start.kept = 0;
    drift_group(m->contacts, q, &d);
    const mask changed = has_bits(d.touched, UINT32_MAX);
    const real3 x = select3(changed, plus3(x0, d.d), x1);
    real3 v = select3(changed, plus3(d.w, second_kick), v1);
    kept_contacts found;
    stop_at_colliders(m->contacts, d.touched, STEP_END, p->free, &x, &v, &found);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, v);
    return not_finite3(x) | too_fast3(m, p, v);
}

/* --------------------------------------------------------------------------------------------------------- the loop */

typedef enum contact_motion {
    KICK_DRIFT,
    END_KICK_DRIFT, /* after the implicit kick that ends the previous step */
    IMPLICIT_KICK_DRIFT,
    LAST_STAGE,
    IMPLICIT_KICK /* a kick of 0 only removes the velocity components into colliders */
} contact_motion;

/* Advances one vector of particles without colliders, and adds the particles that may be in contact to the queue.
   Returns the lanes whose result is infinite or NaN, including queued particles: static friction could cancel an
   infinite force. */
SPRING_INLINE mask advance_freely(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                  contact_queue *q, contact_motion motion)
{
    const scene_contacts *const t = m->contacts;
    const real3 free = free_on_axes(s, m, p), start = load_axes(p, m->v0);
    if (motion == IMPLICIT_KICK) {
        const real3 v = kicked_implicitly3(m, p, start, free);
        const mask queued = touching(t->touched + p->first) & p->free;
        if (SPRING_UNLIKELY(any(queued))) {
            const real3 x = load_axes(p, t->x);
            enqueue(q, p, t->touched + p->first, queued, 2, (const real3 *const[]){&x, &v});
        }
        store_axes(p, m->v, v);
        return not_finite3(v) | (too_fast3(m, p, v) & not_mask(queued));
    }
    const real3 x0 = load_axes(p, m->x0);
    const uint32_t *const before = t->before + p->first;
    real3 v0 = start, third = free, x, v, d; /* v: after the motion */
    mask wrong = {0}, queued = {0}, fast = {0};
    if (motion == LAST_STAGE) {
        const real3 dx = load_axes(p, m->stage->v), dv = minus_drag(p, free, dx);
        const real weight = splat(m->stage->weight);
        x = plus_scaled3(x0, splat(m->drift), plus_scaled3(load_axes(p, m->stage->sum_x), weight, dx));
        v = plus_scaled3(v0, splat(m->kick), plus_scaled3(load_axes(p, m->stage->sum_v), weight, dv));
        d = minus3(x, x0);
        third = x;
        fast = too_fast3(m, p, v);
    } else {
        if (motion != KICK_DRIFT) {
            v0 = kicked_implicitly3(m, p, start, free);
            fast = too_fast3(m, p, v0);
        }
        if (motion == END_KICK_DRIFT)
            queued = touching(before) & p->free;
        const real3 accel = minus_drag(p, free, v0);
        if (motion == IMPLICIT_KICK_DRIFT) {
            v = v0;
            third = accel;
            wrong = not_finite(m->kick * p->drag); /* 1/(1 + q) is 0 for infinite q */
        } else {
            v = plus_scaled3(v0, splat(m->kick), accel);
        }
        d = times3(splat(m->drift), v);
        x = plus3(x0, d);
    }
    queued |= near_colliders(t, p, x0, d);
    if (SPRING_UNLIKELY(any(queued)))
        enqueue(q, p, before, queued, motion == LAST_STAGE ? 4 : 3, (const real3 *const[]){&x0, &v0, &third, &v});
    if (!t->adds)
        memset(t->touched + p->first, 0, lanes * sizeof *t->touched);
    store_axes(p, m->x, x);
    store_axes(p, m->v, v);
    wrong |= not_finite3(x) | not_finite3(v) | (fast & not_mask(queued));
    if (m->predicted != NULL && motion <= END_KICK_DRIFT) {
        const real3 predicted = kicked_implicitly3(m, p, v, free);
        store_axes(p, m->predicted, predicted);
        wrong |= not_finite3(predicted);
    }
    return wrong;
}

/* Advances the first group of the queue, with contacts. */
SPRING_INLINE mask resolve(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                           contact_motion motion)
{
    switch (motion) {
    case IMPLICIT_KICK:
        return resolve_implicit_kick(m, p, q);
    case IMPLICIT_KICK_DRIFT:
        return resolve_implicit_kick_drift(m, p, q);
    case LAST_STAGE:
        return resolve_last_stage(m, p, q);
    default:
        return resolve_kick_drift(m, p, q, motion == END_KICK_DRIFT);
    }
}

/* Like for_each_vector(), with all axes of a particle at once. The motion is not a constant: tests of it take little
   time compared with the tests of colliders. */
SPRING_NOINLINE bool move_with_contacts(const scene_particles *particles, const scene_motion *motion, size_t from,
                                        size_t to, contact_motion kind)
{
    const scene_particles s = *particles;
    const scene_motion m = *motion;
    contact_queue q;
    q.count = 0;
    mask wrong = {0};
    particle_vector p, queued;
    p.axes = queued.axes = m.contacts->axes;
    p.stride = queued.stride = s.stride;
    p.dragged = queued.dragged = s.drag != 0;
    for (size_t i = from; i < to || q.count > 0; i += lanes) {
        if (i < to) {
            p.first = i;
            real inverse_mass = s.mass_stride == 0 ? vec_load(s.inverse_mass) : load_axis(&p, s.inverse_mass, 0);
            if (SPRING_UNLIKELY(i + lanes > s.count))
                inverse_mass = select_real(first_lanes(s.count - i), inverse_mass, splat(0));
            set_mass(&p, &s, &m, inverse_mass);
            wrong |= advance_freely(&s, &m, &p, &q, kind);
            if (q.count < (size_t)lanes)
                continue;
        } else {
            fill_group(&q);
        }
        set_mass(&queued, &s, &m, vec_load(q.inverse_mass));
        wrong |= resolve(&m, &queued, &q, kind);
        remove_group(&q);
    }
    return !any(wrong);
}

static bool move_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, m->ends_step ? END_KICK_DRIFT : KICK_DRIFT);
}

static bool move_implicit_kick_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, IMPLICIT_KICK);
}

static bool move_implicit_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, IMPLICIT_KICK_DRIFT);
}

static bool move_last_stage_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, LAST_STAGE);
}

#endif
