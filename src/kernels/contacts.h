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

/* The change of a tangential velocity by friction, against it and at most `limit`. */
SPRING_INLINE real3 slowed_by(real3 tangential, real limit)
{
    const real speed = vec_sqrt(dot3(tangential, tangential));
    const mask slides = speed > limit;
    return select3(slides, times3(limit / select_real(slides, speed, splat(1)), tangential), tangential);
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
    const collider_pose start = pose_at_start(c);
    find_contact(c, &start, &p->x0, at);
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
        const collider_pose pose = pose_within(c, *fraction);
        const real3 x = plus_scaled3(p->x0, *fraction, p->d);
        contact_point next;
        find_contact(c, &pose, &x, &next);
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
    const real duration = vec_abs(left);
    const collider_pose end = pose_at_end(c);
    const real3 x1 = plus3(p->x0, p->d), n = at->normal;
    const real3 sliding = tangential_to(n, minus3(p->w, *surface));
    const real3 at_start = tangential_to(n, minus3(plus_scaled3(p->w, splat(-p->kappa * p->h), p->accel), *surface));
    const real speed = vec_sqrt(dot3(sliding, sliding)), start_speed = vec_sqrt(dot3(at_start, at_start));
    const mask along_start = dot3(at_start, sliding) > (scalar)0.5 * start_speed * speed;
    const int passes = c->friction > 0 ? friction_passes : 0;
    real lambda = vec_not_negative(-inward) / select_real(duration > 0, duration, splat(1));
    real3 slip = {splat(0), splat(0), splat(0)}, x = x1;
    mask stuck = where & not_mask(where);
    for (int pass = 0;; pass++) {
        for (int i = 0; i < surface_iterations && c->shape != SPRING_PLANE; i++) {
            const real3 guess = plus_scaled3(x, lambda * duration, n);
            contact_point there;
            find_contact(c, &end, &guess, &there);
            const real cosine = dot3(n, there.normal);
            const mask usable = cosine > (scalar)0.1;
            const real next = lambda - there.gap / (duration * select_real(usable, cosine, splat(1)));
            lambda = select_real(usable, vec_not_negative(next), lambda);
        }
        if (pass == passes)
            break;
        const real limit = c->friction * lambda;
        stuck |= where & not_mask(speed > limit) & (fraction < least_fraction);
        slip = slowed_by(sliding, limit);
        /* Along the velocity at the start: then the kicks before and after the drift are adjoint. */
        const mask fast = along_start & (start_speed > 2 * limit) & (speed > limit);
        slip = select3(fast, times3(limit / select_real(fast, start_speed, splat(1)), at_start), slip);
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
    const collider_pose end = pose_at_end(c);
    contact_point there;
    find_contact(c, &end, &x, &there);
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
    const real rate = dot3(u, n), impulse = -(1 + c->restitution) * rate;
    const mask bounces = hit & (rate * p->h < 0) & not_mask(p->touched & (fraction <= 0));
    const real3 friction = slowed_by(tangential_to(n, u), c->friction * vec_abs(impulse));
    const real3 change = minus3(times3(impulse, n), friction);
    p->w = select3(bounces, plus3(p->w, change), p->w);
    p->d = select3(bounces, plus_scaled3(p->d, left, change), p->d);
    p->d = plus_scaled3(p->d, select_real(pushed, -at.gap, splat(0)), n);

    const real3 rest_of_path = minus3(p->d, way), shift = shift_at(c, &at);
    const real inward = gap + dot3(n, rest_of_path) - (1 - fraction) * dot3(n, shift);
    const collider_pose end = pose_at_end(c);
    const real3 x = plus3(p->x0, p->d);
    contact_point there;
    find_contact(c, &end, &x, &there);
    const mask outside = (inward >= 0) & (there.gap >= 0);
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
    const collider_pose end = pose_at_end(c);
    const real3 x = plus3(p->x0, p->d);
    contact_point there;
    find_contact(c, &end, &x, &there);
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
SPRING_NOINLINE void stop_at_colliders(const scene_contacts *t, const uint32_t *touched, bool at_end, scalar h,
                                       mask free, const real3 *x, real3 *v)
{
    for (unsigned i = 0; i < t->count; i++) {
        const scene_collider *const c = &t->collider[i];
        const mask touches = free & with_bit(touched, i);
        if (!any(touches))
            continue;
        const collider_pose pose = at_end ? pose_at_end(c) : pose_at_start(c);
        contact_point at;
        find_contact(c, &pose, x, &at);
        const real3 surface = surface_velocity(c, &at), u = minus3(*v, surface);
        const real rate = dot3(u, at.normal);
        const mask enters = touches & (rate * h < 0);
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
    const collider_pose pose = pose_at_start(c);
    const real3 at = splat3(x);
    contact_point p;
    find_contact(c, &pose, &at, &p);
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

SPRING_INLINE mask not_finite3(real3 a)
{
    return not_finite(a.x) | not_finite(a.y) | not_finite(a.z);
}

SPRING_INLINE mask too_fast3(const scene_motion *m, const particle_vector *p, real3 v)
{
    const mask slow = (vec_abs(v.x) <= m->max_speed) & (vec_abs(v.y) <= m->max_speed) & (vec_abs(v.z) <= m->max_speed);
    return not_mask(slow) & p->free;
}

SPRING_INLINE bool any_bit(const uint32_t *touched)
{
    uint32_t all = 0;
    for (size_t i = 0; i < lanes; i++)
        all |= touched[i];
    return all != 0;
}

SPRING_INLINE void end_in_contact(const scene_motion *m, const particle_vector *p, const uint32_t *touched, bool at_end,
                                  real3 x, real3 *v)
{
    if (SPRING_UNLIKELY(any_bit(touched)))
        stop_at_colliders(m->contacts, touched, at_end, m->contacts->h, p->free, &x, v);
}

/* The drift, with contacts. touched: [lanes] is set. */
SPRING_INLINE void drift_to_colliders(const scene_contacts *t, drifting *d, uint32_t *touched)
{
    memset(touched, 0, lanes * sizeof *touched);
    const real square = dot3(d->d, d->d);
    mask near = not_finite(square); /* nothing is known of a motion whose square overflows */
    for (unsigned i = 0; i < t->count; i++)
        near |= may_touch(&t->collider[i], d->x0, d->d, square);
    if (SPRING_UNLIKELY(any(near & d->free)))
        collide_all(t, d, touched);
}

SPRING_INLINE void store_touched(const scene_contacts *t, size_t first, const uint32_t *touched)
{
    for (size_t i = 0; i < lanes; i++)
        t->touched[first + i] = t->adds ? t->touched[first + i] | touched[i] : touched[i];
}

typedef mask contact_update(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                            unsigned variant);

/* As for_each_vector(), with all axes of a particle at once. */
SPRING_INLINE bool for_each_particle(const scene_particles *particles, const scene_motion *motion, size_t from,
                                     size_t to, contact_update *update, unsigned variant)
{
    const scene_particles s = *particles;
    const scene_motion m = *motion;
    const bool quads = m.contacts->quads;
    const size_t each = quads ? quad_size : 1, count = s.count / each;
    mask wrong = {0};
    for (size_t i = from / each; i < to / each; i += lanes) {
        particle_vector p = {
            .first = i,
            .quads = quads,
            .axes = m.contacts->axes,
            .stride = s.stride,
            .dragged = s.drag != 0,
        };
        p.inverse_mass = s.mass_stride == 0 ? vec_load(s.inverse_mass) : load_axis(&p, s.inverse_mass, 0);
        if (SPRING_UNLIKELY(i + lanes > count))
            p.inverse_mass = select_real(vec_load(lane_number) < splat((scalar)(count - i)), p.inverse_mass, splat(0));
        p.free = p.inverse_mass > 0;
        p.drag = s.drag * p.inverse_mass;
        if (p.dragged)
            p.damping = implicit_factors_of(m.kick * p.drag);
        wrong |= update(&s, &m, &p, variant);
    }
    return !any(wrong);
}

SPRING_INLINE mask update_kick_drift_contact(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                             unsigned variant)
{
    const real3 free = free_on_axes(s, m, p), x0 = load_axes(p, m->x0);
    real3 v0 = load_axes(p, m->v0);
    mask wrong = {0};
    if ((variant & ENDS_STEP) != 0) {
        v0 = kicked_implicitly3(m, p, v0, free);
        end_in_contact(m, p, m->contacts->before + p->first, false, x0, &v0);
        wrong = too_fast3(m, p, v0);
    }
    const real3 accel = minus_drag(p, free, v0), w = plus_scaled3(v0, splat(m->kick), accel);
    drifting d = {.x0 = x0,
                  .accel = accel,
                  .d = times3(splat(m->drift), w),
                  .w = w,
                  .free = p->free,
                  .h = m->drift,
                  .kappa = (scalar)0.5};
    uint32_t touched[lanes];
    drift_to_colliders(m->contacts, &d, touched);
    const real3 x = plus3(x0, d.d);
    store_touched(m->contacts, p->first, touched);
    store_axes(p, m->x, x);
    store_axes(p, m->v, d.w);
    wrong |= not_finite3(x) | not_finite3(d.w);
    if (m->predicted == NULL)
        return wrong;
    real3 predicted = kicked_implicitly3(m, p, d.w, free);
    end_in_contact(m, p, touched, true, x, &predicted);
    store_axes(p, m->predicted, predicted);
    return wrong | not_finite3(predicted);
}

SPRING_NOINLINE bool move_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return m->ends_step ? for_each_particle(p, m, from, to, update_kick_drift_contact, ENDS_STEP)
                        : for_each_particle(p, m, from, to, update_kick_drift_contact, 0);
}

/* With kick 0 it only removes velocity into the colliders. */
SPRING_INLINE mask update_implicit_kick_contact(const scene_particles *s, const scene_motion *m,
                                                const particle_vector *p, unsigned variant)
{
    (void)variant;
    real3 v = kicked_implicitly3(m, p, load_axes(p, m->v0), free_on_axes(s, m, p));
    end_in_contact(m, p, m->contacts->touched + p->first, true, load_axes(p, m->contacts->x), &v);
    store_axes(p, m->v, v);
    return too_fast3(m, p, v);
}

SPRING_NOINLINE bool move_implicit_kick_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_particle(p, m, from, to, update_implicit_kick_contact, 0);
}

SPRING_INLINE mask update_implicit_kick_drift_contact(const scene_particles *s, const scene_motion *m,
                                                      const particle_vector *p, unsigned variant)
{
    (void)variant;
    const real3 free = free_on_axes(s, m, p), x0 = load_axes(p, m->x0);
    const real3 w = kicked_implicitly3(m, p, load_axes(p, m->v0), free);
    const mask hidden = not_finite(m->kick * p->drag);
    drifting d = {.x0 = x0,
                  .accel = minus_drag(p, free, w),
                  .d = times3(splat(m->drift), w),
                  .w = w,
                  .free = p->free,
                  .h = m->drift,
                  .kappa = 1};
    uint32_t touched[lanes];
    drift_to_colliders(m->contacts, &d, touched);
    const real3 x = plus3(x0, d.d);
    store_touched(m->contacts, p->first, touched);
    store_axes(p, m->x, x);
    store_axes(p, m->v, d.w);
    return hidden | not_finite3(x) | too_fast3(m, p, d.w);
}

SPRING_NOINLINE bool move_implicit_kick_drift_contact(const scene_particles *p, const scene_motion *m, size_t from,
                                                      size_t to)
{
    return for_each_particle(p, m, from, to, update_implicit_kick_drift_contact, 0);
}

/* RK4, where a particle may touch a collider, as a drift with the mean velocity and a kick by the mean acceleration. */
SPRING_INLINE mask update_last_stage_contact(const scene_particles *s, const scene_motion *m, const particle_vector *p,
                                             unsigned variant)
{
    (void)variant;
    const scalar h = m->contacts->h;
    const real3 dx = load_axes(p, m->stage_v), dv = minus_drag(p, free_on_axes(s, m, p), dx);
    const real3 x0 = load_axes(p, m->x0), v0 = load_axes(p, m->v0);
    const real weight = splat(m->weight);
    real3 x = plus_scaled3(x0, splat(m->drift), plus_scaled3(load_axes(p, m->sum_x), weight, dx));
    real3 v = plus_scaled3(v0, splat(m->kick), plus_scaled3(load_axes(p, m->sum_v), weight, dv));
    const real3 way = minus3(x, x0), w = times3(splat(1 / h), way), second_kick = minus3(v, w);
    drifting d = {.x0 = x0,
                  .accel = times3(splat(1 / h), minus3(v, v0)),
                  .d = way,
                  .w = w,
                  .free = p->free,
                  .h = h,
                  .kappa = (scalar)0.5};
    uint32_t touched[lanes];
    drift_to_colliders(m->contacts, &d, touched);
    if (SPRING_UNLIKELY(any_bit(touched))) {
        x = select3(d.touched, plus3(x0, d.d), x);
        v = select3(d.touched, plus3(d.w, second_kick), v);
        stop_at_colliders(m->contacts, touched, true, h, p->free, &x, &v);
    }
    store_touched(m->contacts, p->first, touched);
    store_axes(p, m->x, x);
    store_axes(p, m->v, v);
    return not_finite3(x) | too_fast3(m, p, v);
}

SPRING_NOINLINE bool move_last_stage_contact(const scene_particles *p, const scene_motion *m, size_t from, size_t to)
{
    return for_each_particle(p, m, from, to, update_last_stage_contact, 0);
}

#endif
