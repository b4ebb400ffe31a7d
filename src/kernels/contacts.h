/* SPDX-License-Identifier: MIT */
/*
 * Contacts of particles with colliders, as constraints on the drift, with the time of impact.
 *
 * Method    Drift, for each collider in turn. x0 is the position, w the velocity after the kick, a the acceleration of that
 *           kick, d = h w the displacement, V the velocity of the surface, n the normal, theta the fraction of the step
 *           before the contact; w holds the fraction kappa of the kick of the step (leapfrog 1/2, symplectic Euler 1).
 *           1. A particle that is inside at the start is moved out along n, without a change of velocity.
 *           2. Time of impact, by Newton's method on the gap along the path. The gap to a convex body is a convex function
 *              of the fraction, so the method never overshoots: theta <- theta + gap/(rate of approach).
 *           3. Impact, with u = w + (theta - kappa) h a - V, if n.u < 0: the impulse -(1 + e) n.u n, and friction of at
 *              most mu times that along -u_t. The rest of the path, (1 - theta) h, has the changed velocity.
 *           4. Pressing, if the rest of the path still ends inside. A contact in the first half of the step: lambda n with
 *              the lambda for which the path ends on the surface, and friction of at most mu lambda. Static friction holds
 *              a particle exactly: w = V, d = h V. In the second half, or at a second contact in the step: the path is
 *              projected to the tangent plane, and w loses its component into the collider.
 *           5. What is inside a collider at the end (corners, turning capsules) is moved to its surface, likewise.
 *           Last kick, for colliders that were touched: v loses its component into the collider, with friction of at most mu
 *           times that; static friction gives v = V exactly.
 * Order     2 with leapfrog, also across impacts and with sliding friction; see docs/evidence.md.
 * Source    impulses: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988); the constraint in the
 *           drift: Andersen, RATTLE, J. Comput. Phys. 52 (1983). tests/test_scene_contacts.c has the closed forms.
 */
#ifndef SPRINGSTEP_CONTACTS_H
#define SPRINGSTEP_CONTACTS_H

#include "colliders.h"
#include "particles.h"

enum { impact_iterations = 4, friction_passes = 2, surface_iterations = 2, corner_passes = 2 };

/* A fraction of a step that is a rounding error. */
static const scalar least_fraction = 64 * (sizeof(scalar) == sizeof(float) ? (scalar)FLT_EPSILON : (scalar)DBL_EPSILON);

/* A vector of particles in a drift. */
typedef struct drifting {
    real3 x0;     /* [m] */
    real3 accel;  /* [m/s^2] of the kick before the drift */
    real3 d;      /* [m] displacement */
    real3 w;      /* [m/s] velocity during the drift */
    mask free;    /* not pinned */
    mask touched; /* some collider in this step */
    scalar h;     /* [s] duration of the drift */
    scalar kappa; /* fraction of the kick of the step that w holds */
} drifting;

/* 1 for 0. */
SPRING_INLINE real inverse_of(real a)
{
    return 1 / select_real(a > 0, a, splat(1));
}

/* The change of a tangential velocity by friction, against it and at most `limit`. */
SPRING_INLINE real3 slowed_by(real3 tangential, real limit)
{
    const real speed = vec_sqrt(dot3(tangential, tangential));
    return select3(speed > limit, times3(limit * inverse_of(speed), tangential), tangential);
}

SPRING_INLINE real3 tangential_to(real3 normal, real3 u)
{
    return plus_scaled3(u, -dot3(u, normal), normal);
}

/* w without its component into a surface that moves at `surface`, and with friction. *slip: what friction took away. */
SPRING_INLINE real3 clipped(const scene_collider *c, real3 normal, real3 surface, real3 w, scalar h, real3 *slip)
{
    const real3 u = minus3(w, surface);
    const real rate = dot3(u, normal), lost = select_real(rate * h < 0, -rate, splat(0));
    *slip = slowed_by(tangential_to(normal, u), c->friction * vec_abs(lost));
    return minus3(plus_scaled3(w, lost, normal), *slip);
}

/* Steps 1 and 2: finds the contact in the lanes that it returns. */
SPRING_INLINE mask find_impact(const scene_collider *c, drifting *p, contact_point *at, real *gap, real *fraction,
                               mask *pushed)
{
    find_contact(c, STEP_START, splat(0), &p->x0, at);
    const real slop = contact_slop(c, p->x0);
    mask hit = p->free;
    *pushed = hit & (at->gap < -slop);
    *gap = select_real(at->gap < slop, splat(0), at->gap); /* a rounding error divided by h would be a velocity */
    *fraction = splat(0);
    for (int i = 0;; i++) {
        const real rate = dot3(at->normal, minus3(p->d, shift_at(c, at)));
        hit &= *pushed | not_mask(*gap + (1 - *fraction) * rate >= 0);
        if (i == impact_iterations || !any(hit))
            return hit;
        const real step = *gap / -rate;
        const mask on = hit & not_mask(*pushed) & (step > least_fraction * (1 - *fraction));
        if (!any(on))
            return hit;
        *fraction = select_real(on, *fraction + step, *fraction);
        const real3 x = plus_scaled3(p->x0, *fraction, p->d);
        contact_point next;
        find_contact(c, WITHIN_STEP, *fraction, &x, &next);
        *gap = select_real(on, vec_not_negative(next.gap), *gap);
        at->normal = select3(on, next.normal, at->normal);
        at->arm = select3(on, next.arm, at->arm);
        at->along = select_real(on, next.along, at->along);
    }
}

/* Step 4 in the first half of the step: the path ends on the surface. inward: [m] how far it ends below the tangent plane,
   negative; left: [s] of the step. */
SPRING_NOINLINE void press_from_start(const scene_collider *c, drifting *p, mask where, const contact_point *at,
                                      const real3 *surface, real inward, real left, real fraction)
{
    const real duration = vec_abs(left), inverse_duration = inverse_of(duration);
    const real3 x1 = plus3(p->x0, p->d), n = at->normal;
    const real3 sliding = tangential_to(n, minus3(p->w, *surface));
    const real3 at_start = tangential_to(n, minus3(plus_scaled3(p->w, splat(-p->kappa * p->h), p->accel), *surface));
    const real speed = vec_sqrt(dot3(sliding, sliding)), start_speed = vec_sqrt(dot3(at_start, at_start));
    const real inverse_speed = inverse_of(speed), inverse_start_speed = inverse_of(start_speed);
    const mask along_start = dot3(at_start, sliding) > (scalar)0.5 * start_speed * speed;
    const int passes = c->friction > 0 ? friction_passes : 0;
    real lambda = vec_not_negative(-inward) * inverse_duration;
    real3 slip = {splat(0), splat(0), splat(0)}, x = x1;
    mask stuck = where & not_mask(where);
    for (int pass = 0;; pass++) {
        const int iterations = c->shape == SPRING_PLANE ? 0 : pass == passes ? surface_iterations : 1;
        for (int i = 0; i < iterations; i++) { /* Newton's method, with 2 - cosine for 1/cosine, which is never less */
            const real3 guess = plus_scaled3(x, lambda * duration, n);
            contact_point there;
            find_contact(c, STEP_END, splat(0), &guess, &there);
            const real cosine = dot3(n, there.normal), next = lambda - there.gap * inverse_duration * (2 - cosine);
            lambda = select_real(cosine > (scalar)0.1, vec_not_negative(next), lambda);
        }
        if (pass == passes)
            break;
        const real limit = c->friction * lambda;
        const mask slides = speed > limit;
        stuck |= where & not_mask(slides) & (fraction < least_fraction);
        if (!any(where & not_mask(stuck)))
            break;
        slip = select3(slides, times3(limit * inverse_speed, sliding), sliding);
        /* Along the velocity at the start: then the kicks before and after the drift are adjoint. */
        const mask fast = slides & along_start & (start_speed > 2 * limit);
        slip = select3(fast, times3(limit * inverse_start_speed, at_start), slip);
        x = plus_scaled3(x1, -left, slip);
    }
    const real3 w = plus_scaled3(minus3(p->w, slip), p->h < 0 ? -lambda : lambda, n);
    const real3 d = plus_scaled3(minus3(x, p->x0), lambda * duration, n);
    p->w = select3(where, select3(stuck, *surface, w), p->w);
    p->d = select3(where, select3(stuck, times3(splat(p->h), *surface), d), p->d);
}

/* Step 4 later in the step, or at a second contact. */
SPRING_NOINLINE void press_late(const scene_collider *c, drifting *p, mask where, const contact_point *at,
                                const real3 *surface, real inward, real left)
{
    real3 slip;
    const real3 w = clipped(c, at->normal, *surface, p->w, p->h, &slip);
    const real3 to_plane = plus_scaled3(p->d, vec_not_negative(-inward), at->normal);
    const real3 d = plus_scaled3(to_plane, -left, slip), x = plus3(p->x0, d);
    contact_point there;
    find_contact(c, STEP_END, splat(0), &x, &there);
    p->w = select3(where, w, p->w);
    p->d = select3(where, plus_scaled3(d, vec_not_negative(-there.gap), there.normal), p->d);
}

/* Steps 1 to 4 with one collider. Returns the lanes that touch it. */
SPRING_NOINLINE mask collide(const scene_collider *c, drifting *p)
{
    contact_point at;
    real gap, fraction;
    mask pushed;
    const mask hit = find_impact(c, p, &at, &gap, &fraction, &pushed);
    if (!any(hit))
        return hit;
    const real left = (1 - fraction) * p->h;
    const real3 n = at.normal, surface = surface_velocity(c, &at), way = times3(fraction, p->d);

    const real3 at_impact = plus_scaled3(p->w, (fraction - p->kappa) * p->h, p->accel);
    const real3 u = minus3(select3(p->touched, p->w, at_impact), surface);
    const real rate = dot3(u, n);
    const mask bounces = hit & (rate * p->h < -contact_slop(c, p->x0)) & not_mask(p->touched & (fraction <= 0));
    if (any(bounces)) {
        const real impulse = -(1 + c->restitution) * rate;
        const real3 friction = slowed_by(tangential_to(n, u), c->friction * vec_abs(impulse));
        const real3 change = minus3(times3(impulse, n), friction);
        p->w = select3(bounces, plus3(p->w, change), p->w);
        p->d = select3(bounces, plus_scaled3(p->d, left, change), p->d);
    }
    p->d = plus_scaled3(p->d, select_real(pushed, -at.gap, splat(0)), n);

    const real3 rest_of_path = minus3(p->d, way), shift = shift_at(c, &at);
    const real inward = gap + dot3(n, rest_of_path) - (1 - fraction) * dot3(n, shift);
    const mask ends_above = hit & (inward >= 0); /* the tangent plane */
    mask outside = ends_above;
    if (any(ends_above)) {
        const real3 x = plus3(p->x0, p->d);
        contact_point there;
        find_contact(c, STEP_END, splat(0), &x, &there);
        outside = ends_above & (there.gap >= 0);
    }
    const mask presses = hit & not_mask(outside) & (fraction < 1);
    const mask late = presses & ((fraction > (scalar)0.5) | p->touched | pushed);
    if (any(late))
        press_late(c, p, late, &at, &surface, inward, left);
    const mask early = presses & not_mask(late);
    if (any(early))
        press_from_start(c, p, early, &at, &surface, inward, left, fraction);
    return hit;
}

/* Step 5 for one collider, in the lanes `where`. Returns those that were inside. */
SPRING_NOINLINE mask leave_collider(const scene_collider *c, drifting *p, mask where)
{
    const real3 x = plus3(p->x0, p->d);
    contact_point there;
    find_contact(c, STEP_END, splat(0), &x, &there);
    const mask inside = where & (there.gap < -contact_slop(c, p->x0));
    if (!any(inside))
        return inside;
    const real3 surface = surface_velocity(c, &there);
    real3 slip;
    const real3 w = clipped(c, there.normal, surface, p->w, p->h, &slip);
    p->w = select3(inside, w, p->w);
    p->d = select3(inside, plus_scaled3(p->d, -there.gap, there.normal), p->d);
    return inside;
}

/* The contacts of a vector of particles in a drift. touched: [lanes] gets a bit for each collider. */
SPRING_NOINLINE void collide_all(const scene_contacts *t, drifting *p, uint32_t *touched)
{
    p->touched = p->free & not_mask(p->free);
    for (unsigned i = 0; i < t->count; i++) {
        const scene_collider *const c = &t->collider[i];
        if (!any(p->free & may_touch(c, p->x0, p->d, dot3(p->d, p->d))))
            continue;
        const mask hit = collide(c, p);
        add_bit(touched, i, hit);
        p->touched |= hit;
    }
    mask moved = p->free;
    for (int pass = 0; pass < corner_passes && any(moved); pass++) {
        const mask before = moved;
        moved = p->free & not_mask(p->free);
        for (unsigned i = 0; i < t->count; i++) {
            const scene_collider *const c = &t->collider[i];
            if (!any(before & may_touch(c, p->x0, p->d, dot3(p->d, p->d))))
                continue;
            const mask inside = leave_collider(c, p, before);
            add_bit(touched, i, inside);
            p->touched |= inside;
            moved |= inside;
        }
    }
}

/* The last kick: velocities lose their components into the colliders that were touched. */
SPRING_NOINLINE void stop_at_colliders(const scene_contacts *t, const uint32_t *touched, pose_time when, mask free,
                                       const real3 *x, real3 *v)
{
    for (unsigned i = 0; i < t->count; i++) {
        const scene_collider *const c = &t->collider[i];
        const mask touches = free & with_bits(touched, UINT32_C(1) << i);
        if (!any(touches))
            continue;
        contact_point at;
        find_contact(c, when, splat(0), x, &at);
        const real3 surface = surface_velocity(c, &at), u = minus3(*v, surface);
        const real rate = dot3(u, at.normal);
        const mask enters = touches & (rate * t->h < 0);
        const real3 tangential = tangential_to(at.normal, u);
        const real limit = c->friction * vec_abs(rate);
        const mask slides = vec_sqrt(dot3(tangential, tangential)) > limit;
        const real3 slip = slowed_by(tangential, limit);
        const real3 slid = minus3(plus_scaled3(*v, -rate, at.normal), slip);
        *v = select3(enters, select3(slides, slid, surface), *v);
    }
}

/* See normal_kernel. */
static void find_contact_normal(const scene_collider *c, const scalar x[3], scalar normal[3])
{
    const real3 at = splat3(x);
    contact_point p;
    find_contact(c, STEP_START, splat(0), &at, &p);
    scalar each[3][lanes];
    vec_store(each[0], p.normal.x);
    vec_store(each[1], p.normal.y);
    vec_store(each[2], p.normal.z);
    for (int a = 0; a < 3; a++)
        normal[a] = each[a][0];
}

/* ------------------------------------------------------------------------------------------------------------ kernels */

/* A vector of particles, for formulas on all axes at once. */
typedef struct particle_vector {
    size_t first; /* particle */
    bool quads;   /* quantities are arrays of quads */
    uint32_t axes;
    size_t stride; /* elements from one axis to the next */
    real inverse_mass;
    mask free;
    real drag; /* [1/s] */
    bool dragged;
    implicit_factors damping; /* of an implicit kick; unset without drag */
} particle_vector;

/* A quantity on one axis. */
SPRING_INLINE real load_axis(const particle_vector *p, const scalar *quantity, uint32_t axis)
{
    if (!p->quads)
        return vec_load(quantity + axis * p->stride + p->first);
    scalar each[lanes];
    for (size_t i = 0; i < lanes; i++)
        each[i] = quantity[quad_size * (p->first + i) + axis];
    return vec_load(each);
}

SPRING_INLINE void store_axis(const particle_vector *p, scalar *quantity, uint32_t axis, real value)
{
    if (!p->quads) {
        vec_store(quantity + axis * p->stride + p->first, value);
        return;
    }
    scalar each[lanes];
    vec_store(each, value);
    for (size_t i = 0; i < lanes; i++)
        quantity[quad_size * (p->first + i) + axis] = each[i];
}

SPRING_INLINE real3 load_axes(const particle_vector *p, const scalar *quantity)
{
    return (real3){load_axis(p, quantity, 0), load_axis(p, quantity, 1),
                   p->axes > 2 ? load_axis(p, quantity, 2) : splat(0)};
}

SPRING_INLINE void store_axes(const particle_vector *p, scalar *quantity, real3 value)
{
    store_axis(p, quantity, 0, value.x);
    store_axis(p, quantity, 1, value.y);
    if (p->axes > 2)
        store_axis(p, quantity, 2, value.z);
}

/* The operations of the following functions are those of particles.h, so that a particle that touches nothing has the
   results of a scene without colliders. */
SPRING_INLINE real free_on_axis(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                uint32_t axis)
{
    const real held = s->held_stride != 0 ? load_axis(p, s->held, axis) : splat(-(scalar)0);
    const real gravity = splat(p->quads ? s->gravity[axis] : s->gravity[axis * padding]);
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
    return SPRING_UNLIKELY(all != 0) ? with_bits(bits, UINT32_MAX) : (mask){0};
}

/* Lanes whose particle may touch a collider during its motion d. */
SPRING_INLINE mask near_colliders(const scene_contacts *t, const particle_vector *p, real3 x0, real3 d)
{
    const real square = dot3(d, d);
    mask near = not_finite(square); /* nothing is known of a motion whose square overflows */
    for (unsigned i = 0; i < t->count; i++)
        near |= may_touch(&t->collider[i], x0, d, square);
    return near & p->free;
}

/* Particles that may be in contact are collected, so that contacts are computed for full SIMD vectors of them. */
enum { QUEUED_X0, QUEUED_V0, QUEUED_THIRD, QUEUED_FOURTH, queued_quantities, queue_size = 2 * lanes };

typedef struct contact_queue {
    size_t count;
    int quantities; /* that its particles have */
    uint32_t particle[queue_size];
    uint32_t before[queue_size]; /* bits of the colliders that it touched in the step before */
    scalar inverse_mass[queue_size];
    scalar value[queued_quantities][3][queue_size];
} contact_queue;

/* value: [quantities] */
SPRING_NOINLINE void enqueue(contact_queue *q, const particle_vector *p, const uint32_t *before, mask where,
                             int quantities, const real3 *const value[])
{
    scalar each[queued_quantities][3][lanes], inverse_mass[lanes];
    uint32_t queued[lanes];
    memset(queued, 0, sizeof queued);
    add_bit(queued, 0, where);
    q->quantities = quantities;
    vec_store(inverse_mass, p->inverse_mass);
    for (int k = 0; k < quantities; k++) {
        vec_store(each[k][0], value[k]->x);
        vec_store(each[k][1], value[k]->y);
        vec_store(each[k][2], value[k]->z);
    }
    for (size_t lane = 0; lane < lanes; lane++) {
        if (queued[lane] == 0)
            continue;
        const size_t at = q->count++;
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

/* The last group is filled up with its first particle, pinned. */
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
    q->count -= lanes;
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
    const size_t each = p->quads ? quad_size : 1, stride = p->quads ? 1 : p->stride, count = first_group(q);
    scalar on_axis[3][lanes];
    vec_store(on_axis[0], value.x);
    vec_store(on_axis[1], value.y);
    vec_store(on_axis[2], value.z);
    for (uint32_t a = 0; a < p->axes; a++)
        for (size_t i = 0; i < count; i++)
            quantity[a * stride + each * q->particle[i]] = on_axis[a][i];
}

/* The contacts of a group in a drift; touched: [lanes]. */
SPRING_INLINE void drift_group(const scene_contacts *t, const contact_queue *q, drifting *d, uint32_t *touched)
{
    memset(touched, 0, lanes * sizeof *touched);
    collide_all(t, d, touched);
    const size_t count = first_group(q);
    for (size_t i = 0; i < count; i++)
        t->touched[q->particle[i]] |= touched[i];
}

/* Moves one vector of particles as if there were no colliders, and puts those that may be in contact into the queue.
   Returns the lanes of the others whose result is infinite or NaN. */
typedef mask free_update(const scene_particles *s, const scene_motion *m, const particle_vector *p, contact_queue *q,
                         unsigned variant);
/* Moves the first group of the queue. */
typedef mask contact_update(const scene_motion *m, const particle_vector *p, const contact_queue *q, unsigned variant);

/* As for_each_vector(), with all axes of a particle at once. */
SPRING_INLINE bool for_each_particle(const scene_particles *particles, const scene_motion *motion, size_t from,
                                     size_t to, free_update *update, contact_update *resolve, unsigned variant)
{
    const scene_particles s = *particles;
    const scene_motion m = *motion;
    const size_t each = m.contacts->quads ? quad_size : 1, count = s.count / each;
    contact_queue q;
    q.count = 0;
    mask wrong = {0};
    particle_vector p, queued;
    p.quads = queued.quads = m.contacts->quads;
    p.axes = queued.axes = m.contacts->axes;
    p.stride = queued.stride = s.stride;
    p.dragged = queued.dragged = s.drag != 0;
    for (size_t i = from / each; i < to / each; i += lanes) {
        p.first = i;
        real inverse_mass = s.mass_stride == 0 ? vec_load(s.inverse_mass) : load_axis(&p, s.inverse_mass, 0);
        if (SPRING_UNLIKELY(i + lanes > count))
            inverse_mass = select_real(vec_load(lane_number) < splat((scalar)(count - i)), inverse_mass, splat(0));
        set_mass(&p, &s, &m, inverse_mass);
        wrong |= update(&s, &m, &p, &q, variant);
        if (SPRING_UNLIKELY(q.count >= (size_t)lanes)) {
            set_mass(&queued, &s, &m, vec_load(q.inverse_mass));
            wrong |= resolve(&m, &queued, &q, variant);
            remove_group(&q);
        }
    }
    if (q.count > 0) {
        fill_group(&q);
        set_mass(&queued, &s, &m, vec_load(q.inverse_mass));
        wrong |= resolve(&m, &queued, &q, variant);
    }
    return !any(wrong);
}

/* ------------------------------------------------------------------------------------------------------- kick and drift */

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
        wrong |= too_fast3(m, p, v0);
    if (m->predicted != NULL) {
        const real3 predicted = kicked_implicitly3(m, p, w, free);
        store_axes(p, m->predicted, predicted);
        wrong |= not_finite3(predicted);
    }
    return wrong & not_mask(queued);
}

SPRING_NOINLINE mask resolve_kick_drift(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                        unsigned variant)
{
    const real3 x0 = queued_value(q, QUEUED_X0), free = queued_value(q, QUEUED_THIRD);
    real3 v0 = queued_value(q, QUEUED_V0);
    mask wrong = {0};
    if ((variant & ENDS_STEP) != 0) {
        stop_at_colliders(m->contacts, q->before, STEP_START, p->free, &x0, &v0);
        wrong = too_fast3(m, p, v0);
    }
    const real3 accel = minus_drag(p, free, v0), w = plus_scaled3(v0, splat(m->kick), accel);
    drifting d;
    d.x0 = x0;
    d.accel = accel;
    d.d = times3(splat(m->drift), w);
    d.w = w;
    d.free = p->free;
    d.h = m->drift;
    d.kappa = (scalar)0.5;
    uint32_t touched[lanes];
    drift_group(m->contacts, q, &d, touched);
    const real3 x = plus3(x0, d.d);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, d.w);
    wrong |= not_finite3(x) | not_finite3(d.w);
    if (m->predicted == NULL)
        return wrong;
    real3 predicted = kicked_implicitly3(m, p, d.w, free);
    stop_at_colliders(m->contacts, touched, STEP_END, p->free, &x, &predicted);
    scatter(q, p, m->predicted, predicted);
    return wrong | not_finite3(predicted);
}

SPRING_NOINLINE bool move_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return m->ends_step ? for_each_particle(p, m, from, to, free_kick_drift, resolve_kick_drift, ENDS_STEP)
                        : for_each_particle(p, m, from, to, free_kick_drift, resolve_kick_drift, 0);
}

/* --------------------------------------------------------------------------------------------------------- last kick */

/* With kick 0 it only removes velocity into the colliders. */
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
    return too_fast3(m, p, v) & not_mask(queued);
}

SPRING_NOINLINE mask resolve_implicit_kick(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                           unsigned variant)
{
    (void)variant;
    const real3 x = queued_value(q, QUEUED_X0);
    real3 v = queued_value(q, QUEUED_V0);
    stop_at_colliders(m->contacts, q->before, STEP_END, p->free, &x, &v);
    scatter(q, p, m->v, v);
    return too_fast3(m, p, v);
}

SPRING_NOINLINE bool move_implicit_kick_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_particle(p, m, from, to, free_implicit_kick, resolve_implicit_kick, 0);
}

/* -------------------------------------------------------------------------------------------------- symplectic Euler */

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
    return hidden | ((not_finite3(x) | too_fast3(m, p, w)) & not_mask(queued));
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
    uint32_t touched[lanes];
    drift_group(m->contacts, q, &d, touched);
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

/* --------------------------------------------------------------------------------------------------------------- RK4 */

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
    return (not_finite3(x) | too_fast3(m, p, v)) & not_mask(queued);
}

/* As a drift with the mean velocity and kicks by the mean acceleration. */
SPRING_NOINLINE mask resolve_last_stage(const scene_motion *m, const particle_vector *p, const contact_queue *q,
                                        unsigned variant)
{
    (void)variant;
    const scalar h = m->contacts->h;
    const real3 x0 = queued_value(q, QUEUED_X0), v0 = queued_value(q, QUEUED_V0);
    const real3 x1 = queued_value(q, QUEUED_THIRD), v1 = queued_value(q, QUEUED_FOURTH);
    const real3 way = minus3(x1, x0), w = times3(splat(1 / h), way), second_kick = minus3(v1, w);
    drifting d;
    d.x0 = x0;
    d.accel = times3(splat(1 / h), minus3(v1, v0));
    d.d = way;
    d.w = w;
    d.free = p->free;
    d.h = h;
    d.kappa = (scalar)0.5;
    uint32_t touched[lanes];
    drift_group(m->contacts, q, &d, touched);
    const mask changed = touching(touched);
    const real3 x = select3(changed, plus3(x0, d.d), x1);
    real3 v = select3(changed, plus3(d.w, second_kick), v1);
    stop_at_colliders(m->contacts, touched, STEP_END, p->free, &x, &v);
    scatter(q, p, m->x, x);
    scatter(q, p, m->v, v);
    return not_finite3(x) | too_fast3(m, p, v);
}

SPRING_NOINLINE bool move_last_stage_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_particle(p, m, from, to, free_last_stage, resolve_last_stage, 0);
}

#endif
