/* SPDX-License-Identifier: MIT */
/* Particles that may be in contact: vectors of particles with all their axes, and the queue that collects them. */
#ifndef SPRINGSTEP_CONTACT_QUEUE_TMPL_H
#define SPRINGSTEP_CONTACT_QUEUE_TMPL_H

#include "contact_collide_tmpl.h"
#include "particles_tmpl.h"

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

/* The following functions have the same operations as particles_tmpl.h, so that the results of a particle without
   contacts are bit-identical to a scene without colliders. */
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

enum { QUEUED_X0, QUEUED_V0, QUEUED_THIRD, QUEUED_FOURTH, queued_quantities, queue_size = 2 * lanes };

typedef struct contact_queue {
    size_t count;
    int quantities; /* stored for each particle */
    uint32_t particle[queue_size];
    uint32_t before[queue_size]; /* bits of the colliders touched in the previous step */
    scalar inverse_mass[queue_size];
    scalar value[queued_quantities][3][queue_size];
} contact_queue;

/* value: [quantities] */
SPRING_NOINLINE void enqueue(contact_queue *q, const particle_vector *p, const uint32_t *before, mask where,
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
        q->before[at] = before[lane];
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
        q->before[i] = 0;
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
        q->before[i] = q->before[lanes + i];
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

#endif
