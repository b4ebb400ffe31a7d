/* SPDX-License-Identifier: MIT */
/*
 * Contacts of particles with colliders: constraints on the drift, with the time of impact.
 *
 * Symbols   x0 is the position, w the velocity after the kick, a the acceleration of that kick, d = h w the
 *           displacement, V the velocity of the surface, n the normal, and theta the fraction of the step before the
 *           contact. w includes the fraction kappa of the kick of the step (leapfrog 1/2, symplectic Euler 1).
 * Drift     For each collider in turn:
 *           1. A particle that is inside at the start is moved out along n, without a change of velocity.
 *           2. Newton's method on the gap along the path gives the time of impact: theta <- theta + gap/(rate of
 *              approach). The gap to a convex body that does not turn is a convex function of the fraction, so the
 *              method never overshoots.
 *           3. Impact, if n.u < 0 for u = w + (theta - kappa) h a - V: the impulse is -(1 + e) n.u n times the mass,
 *              with friction along -u_t of at most mu times its size. The rest of the path, (1 - theta) h, has the
 *              changed velocity.
 *           4. Pressing, if the rest of the path still ends inside. Early, in the first half of the step: the impulse
 *              is lambda n, with the lambda for which the path ends on the surface, and friction is at most mu lambda.
 *              Static friction holds a particle exactly: w = V, d = h V. Late, in the second half of the step, at a
 *              second contact in the step, or after 1: the path is projected to the tangent plane, and w loses its
 *              component into the collider.
 *           5. All colliders before the last one that a particle touched are tested again, with its new path. A
 *              particle that is still inside at the end (corners, turning capsules) is moved to the surface, and w
 *              loses its component into the collider.
 * Kick      The last kick, for colliders that were touched: v loses its component into the collider, with friction of
 *           at most mu times this component. Static friction gives v = V exactly.
 * Order     2 with leapfrog, also across impacts and with sliding friction; see docs/evidence.md.
 * Source    impulses: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988); the constraint in
 *           the drift: Andersen, RATTLE, J. Comput. Phys. 52 (1983). tests/scene/test_contacts.c has the closed forms.
 */
#ifndef SPRINGSTEP_CONTACT_COLLIDE_TMPL_H
#define SPRINGSTEP_CONTACT_COLLIDE_TMPL_H

#include "contact_distance_tmpl.h"

enum {
    impact_iterations = 8,  /* of step 2 */
    friction_passes = 2,    /* of step 4: friction changes where the path ends, and so the impulse */
    surface_iterations = 2, /* of step 4, in its last pass */
    corner_passes = 2,      /* of step 5 */
    stop_rounds = 32        /* of the last kick */
};
enum { most_kept = 3 }; /* contacts */

/* Fractions of a step up to this size are rounding errors. */
static const scalar least_fraction = 64 * SCALAR_EPSILON;

/* Contacts of a vector of particles at one time, by collider. Only the first few are kept, so that the stack stays
   small; others are computed again. */
typedef struct kept_contacts {
    unsigned count;
    uint32_t kept; /* bit i: the contact with collider i is kept, at index[i] */
    uint8_t index[most_colliders];
    contact_point at[most_kept];
} kept_contacts;

SPRING_INLINE void keep_contact(kept_contacts *k, unsigned i, const contact_point *p)
{
    if (k->count == most_kept)
        return;
    k->at[k->count] = *p;
    k->index[i] = (uint8_t)k->count++;
    k->kept |= UINT32_C(1) << i;
}

/* The contact with collider i at x. */
SPRING_INLINE void recall_contact(const kept_contacts *k, const scene_collider *c, unsigned i, pose_time when,
                                  const real3 *x, contact_point *p)
{
    if ((k->kept >> i & 1) != 0)
        *p = k->at[k->index[i]];
    else
        find_contact(c, when, splat(0), x, p);
}

/* A vector of particles in a drift. */
typedef struct drifting {
    real3 x0;            /* [m] */
    real3 accel;         /* [m/s^2] of the kick before the drift */
    real3 d;             /* [m] displacement */
    real3 w;             /* [m/s] velocity during the drift */
    mask free;           /* not pinned */
    lane_bits touched;   /* bit i: collider i, in this step */
    lane_bits outside;   /* bit i: the path is known to end outside of collider i, to within contact_slop() */
    scalar h;            /* [s] duration of the drift */
    scalar kappa;        /* fraction of the kick of the step that w includes */
    kept_contacts start; /* at x0, at the start of the step */
} drifting;

/* The part of a tangential velocity that friction removes, at most `limit`. */
SPRING_INLINE real3 friction_loss(real3 tangential, real limit)
{
    real inverse;
    const real speed = length_from(dot3(tangential, tangential), &inverse);
    return select3(speed > limit, times3(limit * inverse, tangential), tangential);
}

SPRING_INLINE real3 tangential_to(real3 normal, real3 u)
{
    return plus_scaled3(u, -dot3(u, normal), normal);
}

/* w without its component into a surface that moves at velocity `surface`, and with friction. *slip: the velocity that
   friction removed. */
SPRING_INLINE real3 clipped(const scene_collider *c, real3 normal, real3 surface, real3 w, scalar h, real3 *slip)
{
    const real3 u = minus3(w, surface);
    const real rate = dot3(u, normal), lost = select_real(rate * h < 0, -rate, splat(0));
    *slip = friction_loss(tangential_to(normal, u), c->friction * vec_abs(lost));
    return minus3(plus_scaled3(w, lost, normal), *slip);
}

/* Steps 1 and 2 with collider i in the lanes `nearby`. Returns the lanes with a contact. *at: the contact at its time,
   except at->gap, the gap at the start. *gap: at the time of the contact. */
SPRING_INLINE mask find_impact(const scene_collider *c, unsigned i, const drifting *p, mask nearby, contact_point *at,
                               real *gap, real *fraction, mask *pushed)
{
    recall_contact(&p->start, c, i, DRIFT_START, &p->x0, at);
    const real slop = contact_slop(c, p->x0);
    mask hit = nearby;
    *pushed = hit & (at->gap < -slop);
    *gap = select_real(at->gap < slop, splat(0), at->gap); /* a rounding error divided by h would be a velocity */
    *fraction = splat(0);
    for (int iteration = 0;; iteration++) {
        const real rate = dot3(at->normal, minus3(p->d, shift_at(c, at)));
        hit &= *pushed | not_mask(*gap + (1 - *fraction) * rate >= 0);
        if (iteration == impact_iterations || !any(hit))
            return hit;
        const real step = *gap / -rate;
        const mask on = hit & not_mask(*pushed) & (step > least_fraction * (1 - *fraction));
        if (!any(on))
            return hit;
        *fraction = select_real(on, *fraction + step, *fraction);
        const real3 x = plus_scaled3(p->x0, *fraction, p->d);
        contact_point next;
        find_contact(c, WITHIN_DRIFT, *fraction, &x, &next);
        *gap = select_real(on, vec_not_negative(next.gap), *gap);
        at->normal = select3(on, next.normal, at->normal);
        at->arm = select3(on, next.arm, at->arm);
        at->along = select_real(on, next.along, at->along);
    }
}

/* Step 4, early: moves the end of the path to the surface. inward: [m] gap between the end of
   the path and the tangent plane, negative; left: [s] rest of the step. Returns the lanes whose path is known to end
   outside. */
SPRING_NOINLINE mask press_from_start(const scene_collider *c, drifting *p, mask where, const contact_point *at,
                                      const real3 *surface, real inward, real left, real fraction)
{
    const real duration = vec_abs(left), inverse_duration = inverse_of(duration);
    const real3 x1 = plus3(p->x0, p->d), n = at->normal;
    const real3 sliding = tangential_to(n, minus3(p->w, *surface));
    const real3 at_start = tangential_to(n, minus3(plus_scaled3(p->w, splat(-p->kappa * p->h), p->accel), *surface));
    real inverse_speed, inverse_start_speed;
    const real speed = length_from(dot3(sliding, sliding), &inverse_speed);
    const real start_speed = length_from(dot3(at_start, at_start), &inverse_start_speed);
    const mask along_start = dot3(at_start, sliding) > (scalar)0.5 * start_speed * speed;
    const int passes = c->friction > 0 ? friction_passes : 0;
    real lambda = vec_not_negative(-inward) * inverse_duration;
    real3 slip = {splat(0), splat(0), splat(0)}, x = x1;
    mask stuck = {0}, settled;
    const real tolerance = (scalar)0.25 * contact_slop(c, p->x0);
    for (int pass = 0;; pass++) {
        const int iterations = c->shape == SPRING_PLANE ? 0 : pass == passes ? surface_iterations : 1;
        settled = iterations == 0 ? where : (mask){0};
        /* Newton's method, with 2 - cosine in place of 1/cosine, which is never less. The gap is convex, so at least
           g (1 - cosine)^2 of a gap g remains after an iteration. */
        for (int i = 0; i < iterations; i++) {
            const real3 guess = plus_scaled3(x, lambda * duration, n);
            contact_point there;
            find_contact(c, DRIFT_END, splat(0), &guess, &there);
            const real cosine = dot3(n, there.normal), next = lambda - there.gap * inverse_duration * (2 - cosine);
            const mask ahead = (cosine > (scalar)0.1) & not_mask(settled);
            lambda = select_real(ahead, vec_not_negative(next), lambda);
            settled |= ahead & (vec_abs(there.gap) * (1 - cosine) <= tolerance);
            if (!any(where & not_mask(settled)))
                break;
        }
        if (pass == passes)
            break;
        const real limit = c->friction * lambda;
        const mask slides = speed > limit;
        stuck |= where & not_mask(slides) & (fraction < least_fraction);
        if (!any(where & not_mask(stuck)))
            break;
        slip = select3(slides, times3(limit * inverse_speed, sliding), sliding);
        /* Friction along the velocity at the start makes the kicks before and after the drift adjoint. */
        const mask fast = slides & along_start & (start_speed > 2 * limit);
        slip = select3(fast, times3(limit * inverse_start_speed, at_start), slip);
        x = plus_scaled3(x1, -left, slip);
    }
    const real3 w = plus_scaled3(minus3(p->w, slip), p->h < 0 ? -lambda : lambda, n);
    const real3 d = plus_scaled3(minus3(x, p->x0), lambda * duration, n);
    p->w = select3(where, select3(stuck, *surface, w), p->w);
    p->d = select3(where, select3(stuck, times3(splat(p->h), *surface), d), p->d);
    /* A stuck particle keeps its distance from a collider that does not spin or turn, to within rounding errors. */
    const mask keeps =
        c->spins || collider_turns(c) ? (mask){0} : stuck & (at->gap > (scalar)-0.5 * contact_slop(c, p->x0));
    return where & ((settled & not_mask(stuck)) | keeps);
}

/* Step 4, late. */
SPRING_NOINLINE void press_late(const scene_collider *c, drifting *p, mask where, const contact_point *at,
                                const real3 *surface, real inward, real left)
{
    real3 slip;
    const real3 w = clipped(c, at->normal, *surface, p->w, p->h, &slip);
    const real3 to_plane = plus_scaled3(p->d, vec_not_negative(-inward), at->normal);
    const real3 d = plus_scaled3(to_plane, -left, slip), x = plus3(p->x0, d);
    contact_point there;
    find_contact(c, DRIFT_END, splat(0), &x, &there);
    p->w = select3(where, w, p->w);
    p->d = select3(where, plus_scaled3(d, vec_not_negative(-there.gap), there.normal), p->d);
}

/* Records the lanes that touch collider i, and the lanes whose path is known to end outside of it. A contact changes
   the path, so it clears the bits of `outside` of all other colliders. */
SPRING_INLINE void record_contact(drifting *p, unsigned i, mask hit, mask outside)
{
    const uint32_t bit = UINT32_C(1) << i;
    p->touched |= bits_where(hit, bit);
    p->outside = (p->outside & ~bits_where(hit, UINT32_MAX)) | bits_where(outside, bit);
}

/* Steps 1 to 4 with collider i in the lanes `nearby` that may_touch() finds. Other lanes must not change: a gap that is
   a rounding error counts as 0 here, so results would depend on which particles share the vector. */
SPRING_NOINLINE void collide(const scene_collider *c, unsigned i, drifting *p, mask nearby)
{
    contact_point at;
    real gap, fraction;
    mask pushed;
    const mask hit = find_impact(c, i, p, nearby, &at, &gap, &fraction, &pushed);
    const mask missed = collider_turns(c) ? (mask){0} : nearby & not_mask(hit); /* the gap along the path is convex */
    if (!any(hit)) {
        record_contact(p, i, hit, missed);
        return;
    }
    const real left = (1 - fraction) * p->h;
    const real3 n = at.normal, surface = surface_velocity(c, &at), way = times3(fraction, p->d);

    const real3 at_impact = plus_scaled3(p->w, (fraction - p->kappa) * p->h, p->accel);
    const mask again = has_bits(p->touched, UINT32_MAX);
    const real3 u = minus3(select3(again, p->w, at_impact), surface);
    const real rate = dot3(u, n);
    const mask bounces = hit & (rate * p->h < -contact_slop(c, p->x0)) & not_mask(again & (fraction <= 0));
    if (any(bounces)) {
        const real impulse = -(1 + c->restitution) * rate; /* [m/s] divided by the mass */
        const real3 friction = friction_loss(tangential_to(n, u), c->friction * vec_abs(impulse));
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
        find_contact(c, DRIFT_END, splat(0), &x, &there);
        outside = ends_above & (there.gap >= 0);
    }
    const mask presses = hit & not_mask(outside) & (fraction < 1);
    const mask late = presses & ((fraction > (scalar)0.5) | again | pushed);
    if (any(late))
        press_late(c, p, late, &at, &surface, inward, left);
    const mask early = presses & not_mask(late);
    if (any(early))
        outside |= press_from_start(c, p, early, &at, &surface, inward, left, fraction);
    record_contact(p, i, hit, outside | missed);
}

/* Step 5 for collider i, in the lanes `where`. Returns the lanes that were inside. */
SPRING_NOINLINE mask leave_collider(const scene_collider *c, unsigned i, drifting *p, mask where)
{
    const real3 x = plus3(p->x0, p->d);
    contact_point there;
    find_contact(c, DRIFT_END, splat(0), &x, &there);
    const mask inside = where & (there.gap < -contact_slop(c, p->x0));
    if (!any(inside))
        return inside;
    const real3 surface = surface_velocity(c, &there);
    real3 slip;
    const real3 w = clipped(c, there.normal, surface, p->w, p->h, &slip);
    p->w = select3(inside, w, p->w);
    p->d = select3(inside, plus_scaled3(p->d, -there.gap, there.normal), p->d);
    record_contact(p, i, inside, (mask){0});
    return inside;
}

/* Free lanes of `where` whose path may touch a collider. */
SPRING_NOINLINE mask path_may_touch(const scene_collider *c, const drifting *p, mask where)
{
    return where & p->free & may_touch(c, p->x0, p->d, dot3(p->d, p->d));
}

/* Computes the contacts of a vector of particles during a drift. */
SPRING_NOINLINE void collide_all(const scene_contacts *t, drifting *p)
{
    p->touched = p->outside = bits_where((mask){0}, 0);
    for (unsigned i = 0; i < t->count; i++) {
        const mask nearby = path_may_touch(&t->collider[i], p, p->free);
        if (any(nearby))
            collide(&t->collider[i], i, p, nearby);
    }
    for (unsigned i = 0; i + 1 < t->count; i++) {
        const mask deflected = p->free & has_bits(p->touched, UINT32_MAX << i << 1); /* by a later collider */
        if (!any(deflected))
            break;
        const mask nearby = path_may_touch(&t->collider[i], p, deflected);
        if (any(nearby))
            collide(&t->collider[i], i, p, nearby);
    }
    mask moved = p->free;
    for (int pass = 0; pass < corner_passes && any(moved); pass++) {
        const mask before = moved;
        moved = (mask){0};
        for (unsigned i = 0; i < t->count; i++) {
            const scene_collider *const c = &t->collider[i];
            const mask open = before & not_mask(has_bits(p->outside, UINT32_C(1) << i));
            if (!any(open))
                continue;
            const mask nearby = path_may_touch(c, p, open);
            if (any(nearby))
                moved |= leave_collider(c, i, p, nearby);
        }
    }
}

/* The last kick: removes the velocity components into the colliders that were touched. With several colliders, this is
   projected Gauss-Seidel: in further rounds, each collider corrects its impulse, which stays non-negative. Friction
   acts in the first round only. *found: some of the contacts. */
SPRING_NOINLINE void stop_at_colliders(const scene_contacts *t, lane_bits touched, pose_time when, mask free,
                                       const real3 *x, real3 *v, kept_contacts *found)
{
    real pressed[most_colliders]; /* [m/s] along the normal */
    mask several = {0}, any_yet = {0};
    contact_point at;
    found->count = 0;
    found->kept = 0;
    for (unsigned i = 0; i < t->count; i++) {
        const scene_collider *const c = &t->collider[i];
        const mask touches = free & has_bits(touched, UINT32_C(1) << i);
        if (!any(touches))
            continue;
        several |= any_yet & touches;
        any_yet |= touches;
        find_contact(c, when, splat(0), x, &at);
        keep_contact(found, i, &at);
        const real3 surface = surface_velocity(c, &at);
        const real3 u = minus3(*v, surface), tangential = tangential_to(at.normal, u);
        const real rate = dot3(u, at.normal), limit = c->friction * vec_abs(rate);
        const mask enters = touches & (rate * t->h < 0);
        real inverse;
        const mask slides = length_from(dot3(tangential, tangential), &inverse) > limit;
        const real3 slid = minus3(plus_scaled3(*v, -rate, at.normal), times3(limit * inverse, tangential));
        *v = select3(enters, select3(slides, slid, surface), *v);
        pressed[i] = select_real(enters, -rate, splat(0));
    }
    for (int round = 1; round < stop_rounds && any(several); round++)
        for (unsigned i = 0; i < t->count; i++) {
            const scene_collider *const c = &t->collider[i];
            const mask again = several & free & has_bits(touched, UINT32_C(1) << i);
            if (!any(again))
                continue;
            recall_contact(found, c, i, when, x, &at);
            const real wanted = pressed[i] - dot3(minus3(*v, surface_velocity(c, &at)), at.normal);
            const real now = select_real(wanted * t->h > 0, wanted, splat(0));
            *v = select3(again, plus_scaled3(*v, now - pressed[i], at.normal), *v);
            pressed[i] = select_real(again, now, pressed[i]);
        }
}

static void first_lane3(real3 from, scalar to[3])
{
    scalar each[lanes];
    vec_store(each, from.x);
    to[0] = each[0];
    vec_store(each, from.y);
    to[1] = each[0];
    vec_store(each, from.z);
    to[2] = each[0];
}

/* See surface_kernel. */
static void find_contact_surface(const scene_collider *c, const scalar x[3], scalar normal[3], scalar velocity[3])
{
    contact_point p;
    find_contact(c, DRIFT_START, splat(0), &(const real3){splat(x[0]), splat(x[1]), splat(x[2])}, &p);
    first_lane3(p.normal, normal);
    first_lane3(surface_velocity(c, &p), velocity);
}

#endif
