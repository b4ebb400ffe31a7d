/* SPDX-License-Identifier: MIT */
/*
 * The kernels of particles_tmpl.h for scenes with colliders. First, all particles are advanced without colliders, one
 * SIMD vector of particles at a time with all their axes. Particles that may be in contact are collected in a queue,
 * and are advanced again in full SIMD vectors by resolve_...(). Few particles touch a collider, so most vectors of
 * neighbours would be nearly empty.
 */
#ifndef SPRINGSTEP_CONTACT_LOOPS_TMPL_H
#define SPRINGSTEP_CONTACT_LOOPS_TMPL_H

#include "contact_collide_tmpl.h"
#include "particles_tmpl.h"

/* --------------------------------------------------------------------------------------------------- the particles */

/* A vector of particles, with all their axes. */
typedef struct particle_vector {
    size_t first; /* particle */
    uint32_t axes;
    size_t stride; /* elements from one axis to the next */
    real inverse_mass;
    mask free;
    real drag; /* [1/s] */
    bool dragged;
    implicit_factors damping; /* of an implicit kick; unset without drag */
} particle_vector;

/* A quantity along one axis. */
SPRING_INLINE real load_axis(const particle_vector *p, const scalar *quantity, uint32_t axis)
{
    return vec_load(quantity + axis * p->stride + p->first);
}

SPRING_INLINE real3 load_axes(const particle_vector *p, const scalar *quantity)
{
    return (real3){load_axis(p, quantity, 0), load_axis(p, quantity, 1),
                   p->axes > 2 ? load_axis(p, quantity, 2) : splat(0)};
}

SPRING_INLINE void store_axes(const particle_vector *p, scalar *quantity, real3 value)
{
    vec_store(quantity + p->first, value.x);
    vec_store(quantity + p->stride + p->first, value.y);
    if (p->axes > 2)
        vec_store(quantity + 2 * p->stride + p->first, value.z);
}

/* The following functions have the same operations as leapfrog_particles_tmpl.h, so that the results of a particle
   without contacts are bit-identical to a scene without colliders. */
SPRING_INLINE real free_on_axis(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                uint32_t axis)
{
    const real held = s->held_stride != 0 ? load_axis(p, s->held, axis) : splat(-(scalar)0);
    const real gravity = vec_load(s->gravity + axis * padding);
    return select_real(p->free, p->inverse_mass * (load_axis(p, m->force, axis) + held) + gravity, splat(0));
}

SPRING_INLINE real3 free_on_axes(const scene_particles *s, const scene_motion *m, const particle_vector *p)
{
    return (real3){free_on_axis(s, m, p, 0), free_on_axis(s, m, p, 1),
                   p->axes > 2 ? free_on_axis(s, m, p, 2) : splat(0)};
}

SPRING_INLINE real3 minus_drag(const particle_vector *p, real3 free, real3 v)
{
    return p->dragged ? plus_scaled3(free, -p->drag, v) : free;
}

SPRING_INLINE real3 kicked_implicitly3(const scene_motion *m, const particle_vector *p, real3 v0, real3 free)
{
    const real3 u = plus_scaled3(v0, splat(m->kick), free);
    if (!p->dragged)
        return u;
    return (real3){implicit_velocity(u.x, &p->damping), implicit_velocity(u.y, &p->damping),
                   implicit_velocity(u.z, &p->damping)};
}

SPRING_INLINE void set_mass(particle_vector *p, const scene_particles *s, const scene_motion *m, real inverse_mass)
{
    p->inverse_mass = inverse_mass;
    p->free = inverse_mass > 0;
    p->drag = s->drag * inverse_mass;
    if (p->dragged)
        p->damping = implicit_factors_of(m->kick * p->drag);
}

SPRING_INLINE mask not_finite3(real3 a)
{
    return not_finite(a.x) | not_finite(a.y) | not_finite(a.z);
}

SPRING_INLINE mask too_fast3(const scene_motion *m, const particle_vector *p, real3 v)
{
    const mask slow = (vec_abs(v.x) <= m->max_speed) & (vec_abs(v.y) <= m->max_speed) & (vec_abs(v.z) <= m->max_speed);
    return not_mask(slow) & p->free;
}

/* Lanes whose particle touches a collider; bits: [lanes] */
SPRING_INLINE mask touching(const uint32_t *bits)
{
    uint32_t all = 0;
    for (size_t i = 0; i < lanes; i++)
        all |= bits[i];
    return SPRING_UNLIKELY(all != 0) ? has_bits(load_bits(bits), UINT32_MAX) : (mask){0};
}

/* Lanes whose particle may touch a collider during its displacement d. */
SPRING_INLINE mask near_colliders(const scene_contacts *t, const particle_vector *p, real3 x0, real3 d)
{
    const real square = dot3(d, d);
    mask nearby = not_mask(square <= SCALAR_MAX); /* if the square overflows, any collider may be near */
    for (unsigned i = 0; i < t->count; i++)
        nearby |= may_touch(&t->collider[i], x0, d, square);
    return nearby & p->free;
}

/* ------------------------------------------------------------------------------------------------------- the queue */

/* The queued quantities of a motion: x0, v0 and, for kick_drift, the acceleration without drag; for
   implicit_kick_drift, the acceleration of the kick; for last_stage and drift_kick_drift, the free position and
   velocity after the motion. For implicit_kick they are x and v after the free motion. */
enum { QUEUED_X0, QUEUED_V0, QUEUED_THIRD, QUEUED_FOURTH, queued_quantities, queue_size = 2 * lanes };

typedef struct contact_queue {
    size_t count;
    int quantities; /* stored for each particle */
    uint32_t particle[queue_size];
    uint32_t stops[queue_size]; /* bits of the colliders at which stop_at_colliders() stops the particle */
    scalar inverse_mass[queue_size];
    scalar value[queued_quantities][3][queue_size];
} contact_queue;

/* value: [quantities] */
SPRING_NOINLINE void enqueue(contact_queue *q, const particle_vector *p, const uint32_t *stops, mask where,
                             int quantities, const real3 *const value[])
{
    scalar each[queued_quantities][3][lanes], inverse_mass[lanes];
    uint32_t queued[lanes];
    store_bits(queued, bits_where(where, 1));
    q->quantities = quantities;
    vec_store(inverse_mass, p->inverse_mass);
    for (int k = 0; k < quantities; k++) {
        vec_store(each[k][0], value[k]->x);
        vec_store(each[k][1], value[k]->y);
        vec_store(each[k][2], value[k]->z);
    }
    unsigned left = 0; /* bit i: lane i; a branch for each lane would be mispredicted often */
    for (size_t lane = 0; lane < lanes; lane++)
        left |= queued[lane] << lane;
    for (; left != 0; left &= left - 1) {
        const size_t lane = SPRING_LOWEST_BIT(left), at = q->count++;
        q->particle[at] = (uint32_t)(p->first + lane);
        q->stops[at] = stops[lane];
        q->inverse_mass[at] = inverse_mass[lane];
        for (int k = 0; k < quantities; k++)
            for (int a = 0; a < 3; a++)
                q->value[k][a][at] = each[k][a][lane];
    }
}

SPRING_INLINE real3 queued_value(const contact_queue *q, int quantity)
{
    const scalar(*const value)[queue_size] = q->value[quantity];
    return (real3){vec_load(value[0]), vec_load(value[1]), vec_load(value[2])};
}

SPRING_INLINE size_t first_group(const contact_queue *q)
{
    return q->count < (size_t)lanes ? q->count : (size_t)lanes;
}

/* Fills up the last group with pinned copies of its first particle. */
SPRING_NOINLINE void fill_group(contact_queue *q)
{
    for (size_t i = q->count; i < lanes; i++) {
        q->inverse_mass[i] = 0;
        q->stops[i] = 0;
        for (int k = 0; k < q->quantities; k++)
            for (int a = 0; a < 3; a++)
                q->value[k][a][i] = q->value[k][a][0];
    }
}

SPRING_INLINE void remove_group(contact_queue *q)
{
    q->count -= first_group(q);
    for (size_t i = 0; i < q->count; i++) {
        q->particle[i] = q->particle[lanes + i];
        q->stops[i] = q->stops[lanes + i];
    }
    vec_store(q->inverse_mass, vec_load(q->inverse_mass + lanes));
    for (int k = 0; k < q->quantities; k++)
        for (int a = 0; a < 3; a++)
            vec_store(q->value[k][a], vec_load(q->value[k][a] + lanes));
}

/* Writes a quantity of the particles of the first group. */
SPRING_INLINE void scatter(const contact_queue *q, const particle_vector *p, scalar *quantity, real3 value)
{
    const size_t count = first_group(q);
    scalar on_axis[3][lanes];
    vec_store(on_axis[0], value.x);
    vec_store(on_axis[1], value.y);
    vec_store(on_axis[2], value.z);
    for (uint32_t a = 0; a < p->axes; a++)
        for (size_t i = 0; i < count; i++)
            quantity[a * p->stride + q->particle[i]] = on_axis[a][i];
}

/* Computes the contacts of the first group during a drift. */
SPRING_INLINE void drift_group(const scene_contacts *t, const contact_queue *q, drifting *d)
{
    collide_all(t, d);
    uint32_t touched[lanes];
    store_bits(touched, d->touched);
    const size_t count = first_group(q);
    for (size_t i = 0; i < count; i++)
        t->touched[q->particle[i]] |= touched[i];
}

/* ------------------------------------------------------------------------------------------ motions with contacts */

SPRING_NOINLINE mask resolve_kick_drift(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                        bool ends_previous)
{
    const real3 x0 = queued_value(q, QUEUED_X0), free_accel = queued_value(q, QUEUED_THIRD);
    real3 v0 = queued_value(q, QUEUED_V0);
    mask wrong = {0};
    drifting d;
    d.start.count = 0;
    d.start.kept = 0;
    if (ends_previous) {
        stop_at_colliders(m->contacts, load_bits(q->stops), DRIFT_START, p->free, &x0, &v0, &d.start);
        wrong = too_fast3(m, p, v0);
    }
    const real3 accel = minus_drag(p, free_accel, v0), w = plus_scaled3(v0, splat(m->kick), accel);
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
    real3 predicted = kicked_implicitly3(m, p, d.w, free_accel);
    kept_contacts found;
    stop_at_colliders(m->contacts, d.touched, DRIFT_END, p->free, &x, &predicted, &found);
    scatter(q, p, m->predicted, predicted);
    return wrong | not_finite3(predicted);
}

SPRING_NOINLINE mask resolve_implicit_kick(const scene_motion *m, const particle_vector *p, const contact_queue *q)
{
    const real3 x = queued_value(q, QUEUED_X0);
    real3 v = queued_value(q, QUEUED_V0);
    kept_contacts found;
    stop_at_colliders(m->contacts, load_bits(q->stops), DRIFT_END, p->free, &x, &v, &found);
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
    stop_at_colliders(m->contacts, d.touched, DRIFT_END, p->free, &x, &v, &found);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, v);
    return not_finite3(x) | too_fast3(m, p, v);
}

/* --------------------------------------------------------------------------------------------------------- the loop */

typedef enum contact_motion {
    KICK_DRIFT,     /* first, since only these two predict velocities */
    END_KICK_DRIFT, /* after the implicit kick that ends the previous step */
    IMPLICIT_KICK_DRIFT,
    LAST_STAGE,
    DRIFT_KICK_DRIFT,
    IMPLICIT_KICK /* a kick of 0 only removes the velocity components into colliders */
} contact_motion;

/* Advances one vector of particles without colliders, and adds the particles that may be in contact to the queue.
   Returns the lanes whose result is infinite, NaN or too fast. Queued particles are included, except for their speed:
   static friction could cancel an infinite force. */
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
    const bool whole = motion == LAST_STAGE || motion == DRIFT_KICK_DRIFT; /* a whole step, not a drift */
    if (motion == DRIFT_KICK_DRIFT) {
        const real drift = splat(m->drift);
        v = load_axes(p, m->stage->v);
        x = plus_scaled3(plus_scaled3(x0, drift, v0), drift, v);
    } else if (motion == LAST_STAGE) {
        const real3 dx = load_axes(p, m->stage->v), dv = minus_drag(p, free, dx);
        const real weight = splat(m->stage->weight);
        x = plus_scaled3(x0, splat(m->drift), plus_scaled3(load_axes(p, m->stage->sum_x), weight, dx));
        v = plus_scaled3(v0, splat(m->kick), plus_scaled3(load_axes(p, m->stage->sum_v), weight, dv));
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
    if (whole) {
        d = minus3(x, x0);
        third = x;
        fast = too_fast3(m, p, v);
    }
    queued |= near_colliders(t, p, x0, d);
    if (SPRING_UNLIKELY(any(queued)))
        enqueue(q, p, before, queued, whole ? 4 : 3, (const real3 *const[]){&x0, &v0, &third, &v});
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
    case DRIFT_KICK_DRIFT:
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
    return move_with_contacts(p, m, from, to, m->ends_previous ? END_KICK_DRIFT : KICK_DRIFT);
}

static bool move_implicit_kick_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, IMPLICIT_KICK);
}

static bool move_implicit_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, IMPLICIT_KICK_DRIFT);
}

static bool move_drift_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, DRIFT_KICK_DRIFT);
}

static bool move_last_stage_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return move_with_contacts(p, m, from, to, LAST_STAGE);
}

#endif
