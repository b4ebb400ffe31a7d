/* SPDX-License-Identifier: MIT */
/* The kernels of particles.h for scenes with colliders: free_...() computes the motion without contacts, resolve_...()
   with contacts. */
#ifndef SPRINGSTEP_CONTACT_KERNELS_H
#define SPRINGSTEP_CONTACT_KERNELS_H

#include "contact_queue.h"

/* --------------------------------------------------------------------------------------------------- kick and drift */

SPRING_INLINE void clear_touched(const scene_contacts *t, size_t first)
{
    if (!t->adds)
        memset(t->touched + first, 0, lanes * sizeof *t->touched);
}

SPRING_INLINE mask free_kick_drift(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                   contact_queue *q, unsigned variant)
{
    const uint32_t *const before = m->contacts->before + p->first;
    const real3 free = free_on_axes(s, m, p), x0 = load_axes(p, m->x0), start = load_axes(p, m->v0);
    const real3 v0 = (variant & ENDS_STEP) != 0 ? kicked_implicitly3(m, p, start, free) : start;
    const real3 w = plus_scaled3(v0, splat(m->kick), minus_drag(p, free, v0)), d = times3(splat(m->drift), w);
    mask queued = near_colliders(m->contacts, p, x0, d);
    if ((variant & ENDS_STEP) != 0)
        queued |= touching(before) & p->free;
    if (SPRING_UNLIKELY(any(queued)))
        enqueue(q, p, before, queued, 3, (const real3 *const[]){&x0, &v0, &free});
    clear_touched(m->contacts, p->first);
    const real3 x = plus3(x0, d);
    store_axes(p, m->x, x);
    store_axes(p, m->v, w);
    mask wrong = not_finite3(x) | not_finite3(w);
    if ((variant & ENDS_STEP) != 0)
        wrong |= too_fast3(m, p, v0) & not_mask(queued);
    if (m->predicted != NULL) {
        const real3 predicted = kicked_implicitly3(m, p, w, free);
        store_axes(p, m->predicted, predicted);
        wrong |= not_finite3(predicted);
    }
    return wrong;
}

SPRING_NOINLINE mask resolve_kick_drift(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                        unsigned variant)
{
    const real3 x0 = queued_value(q, QUEUED_X0), free = queued_value(q, QUEUED_THIRD);
    real3 v0 = queued_value(q, QUEUED_V0);
    mask wrong = {0};
    drifting d;
    d.known = 0;
    if ((variant & ENDS_STEP) != 0) {
        d.known = stop_at_colliders(m->contacts, load_bits(q->before), STEP_START, p->free, &x0, &v0, d.start);
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
    contact_point found[most_colliders];
    stop_at_colliders(m->contacts, d.touched, STEP_END, p->free, &x, &predicted, found);
    scatter(q, p, m->predicted, predicted);
    return wrong | not_finite3(predicted);
}

SPRING_NOINLINE bool move_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return m->ends_step ? for_each_particle(p, m, from, to, free_kick_drift, resolve_kick_drift, ENDS_STEP)
                        : for_each_particle(p, m, from, to, free_kick_drift, resolve_kick_drift, 0);
}

/* -------------------------------------------------------------------------------------------------------- last kick */

/* A kick of 0 only removes the velocity components into colliders. */
SPRING_INLINE mask free_implicit_kick(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                      contact_queue *q, unsigned variant)
{
    (void)variant;
    const uint32_t *const touched = m->contacts->touched + p->first;
    const real3 v = kicked_implicitly3(m, p, load_axes(p, m->v0), free_on_axes(s, m, p));
    const mask queued = touching(touched) & p->free;
    if (SPRING_UNLIKELY(any(queued))) {
        const real3 x = load_axes(p, m->contacts->x);
        enqueue(q, p, touched, queued, 2, (const real3 *const[]){&x, &v});
    }
    store_axes(p, m->v, v);
    return not_finite3(v) | (too_fast3(m, p, v) & not_mask(queued));
}

SPRING_NOINLINE mask resolve_implicit_kick(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                           unsigned variant)
{
    (void)variant;
    const real3 x = queued_value(q, QUEUED_X0);
    real3 v = queued_value(q, QUEUED_V0);
    contact_point found[most_colliders];
    stop_at_colliders(m->contacts, load_bits(q->before), STEP_END, p->free, &x, &v, found);
    scatter(q, p, m->v, v);
    return too_fast3(m, p, v);
}

SPRING_NOINLINE bool move_implicit_kick_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_particle(p, m, from, to, free_implicit_kick, resolve_implicit_kick, 0);
}

/* ------------------------------------------------------------------------------------------------- symplectic Euler */

SPRING_INLINE mask free_implicit_kick_drift(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                            contact_queue *q, unsigned variant)
{
    (void)variant;
    const real3 free = free_on_axes(s, m, p), x0 = load_axes(p, m->x0);
    const real3 w = kicked_implicitly3(m, p, load_axes(p, m->v0), free), d = times3(splat(m->drift), w);
    const mask queued = near_colliders(m->contacts, p, x0, d), hidden = not_finite(m->kick * p->drag);
    if (SPRING_UNLIKELY(any(queued))) {
        const real3 accel = minus_drag(p, free, w);
        enqueue(q, p, m->contacts->before + p->first, queued, 3, (const real3 *const[]){&x0, &w, &accel});
    }
    clear_touched(m->contacts, p->first);
    const real3 x = plus3(x0, d);
    store_axes(p, m->x, x);
    store_axes(p, m->v, w);
    return hidden | not_finite3(x) | not_finite3(w) | (too_fast3(m, p, w) & not_mask(queued));
}

SPRING_NOINLINE mask resolve_implicit_kick_drift(const scene_motion *m, const particle_vector *p,
                                                 const contact_queue *q, unsigned variant)
{
    (void)variant;
    const real3 x0 = queued_value(q, QUEUED_X0), w = queued_value(q, QUEUED_V0);
    drifting d;
    d.x0 = x0;
    d.accel = queued_value(q, QUEUED_THIRD);
    d.d = times3(splat(m->drift), w);
    d.w = w;
    d.free = p->free;
    d.h = m->drift;
    d.kappa = 1;
    d.known = 0;
    drift_group(m->contacts, q, &d);
    const real3 x = plus3(x0, d.d);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, d.w);
    return not_finite3(x) | too_fast3(m, p, d.w);
}

SPRING_NOINLINE bool move_implicit_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from,
                                                      size_t to)
{
    return for_each_particle(p, m, from, to, free_implicit_kick_drift, resolve_implicit_kick_drift, 0);
}

/* -------------------------------------------------------------------------------------------------------------- RK4 */

SPRING_INLINE mask free_last_stage(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                   contact_queue *q, unsigned variant)
{
    (void)variant;
    const real3 dx = load_axes(p, m->stage_v), dv = minus_drag(p, free_on_axes(s, m, p), dx);
    const real3 x0 = load_axes(p, m->x0), v0 = load_axes(p, m->v0);
    const real weight = splat(m->weight);
    const real3 x = plus_scaled3(x0, splat(m->drift), plus_scaled3(load_axes(p, m->sum_x), weight, dx));
    const real3 v = plus_scaled3(v0, splat(m->kick), plus_scaled3(load_axes(p, m->sum_v), weight, dv));
    const mask queued = near_colliders(m->contacts, p, x0, minus3(x, x0));
    if (SPRING_UNLIKELY(any(queued)))
        enqueue(q, p, m->contacts->before + p->first, queued, 4, (const real3 *const[]){&x0, &v0, &x, &v});
    clear_touched(m->contacts, p->first);
    store_axes(p, m->x, x);
    store_axes(p, m->v, v);
    return not_finite3(x) | not_finite3(v) | (too_fast3(m, p, v) & not_mask(queued));
}

/* Contacts are computed as for a drift with the mean velocity and kicks by the mean acceleration. */
SPRING_NOINLINE mask resolve_last_stage(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                        unsigned variant)
{
    (void)variant;
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
    d.known = 0;
    drift_group(m->contacts, q, &d);
    const mask changed = has_bits(d.touched, UINT32_MAX);
    const real3 x = select3(changed, plus3(x0, d.d), x1);
    real3 v = select3(changed, plus3(d.w, second_kick), v1);
    contact_point found[most_colliders];
    stop_at_colliders(m->contacts, d.touched, STEP_END, p->free, &x, &v, found);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, v);
    return not_finite3(x) | too_fast3(m, p, v);
}

SPRING_NOINLINE bool move_last_stage_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_particle(p, m, from, to, free_last_stage, resolve_last_stage, 0);
}

#endif
