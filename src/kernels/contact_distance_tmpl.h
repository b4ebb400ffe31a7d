/* SPDX-License-Identifier: MIT */
/*
 * Distances from colliders: the signed gap between a particle and the surface of a plane, sphere, capsule or box, and
 * the normal there.
 *
 * Method    All shapes except planes are a core (a point, a segment or a box) with a radius. The gap is the distance
 *           from the core minus the radius. Inside the core of a box, that distance is minus the distance from the
 *           nearest face.
 * Accuracy  a few eps (|x|_1 + radius), for capsules plus their length, see contact_slop(). Planes are stored by their
 *           offset normal . at, so the distance of `at` does not matter.
 */
#ifndef SPRINGSTEP_CONTACT_DISTANCE_TMPL_H
#define SPRINGSTEP_CONTACT_DISTANCE_TMPL_H

#include "../simd/real_tmpl.h"
#include "../simd/real3_tmpl.h"
#include "scene_kernels.h"

/* The time of a pose: the start or the end of a drift, or a fraction of it. */
typedef enum pose_time { DRIFT_START, DRIFT_END, WITHIN_DRIFT } pose_time;

SPRING_INLINE real3 place_of(pose_time when, real fraction, const scalar start[3], const scalar end[3],
                             const scalar shift[3])
{
    return when == WITHIN_DRIFT ? plus_scaled3(splat3(start), fraction, splat3(shift))
                                : splat3(when == DRIFT_END ? end : start);
}

/* The point on a collider that is nearest to a particle. */
typedef struct contact_point {
    real gap;     /* [m] negative inside */
    real3 normal; /* unit vector, out of the collider */
    real3 arm;    /* [m] to the particle from `at` or, for a capsule, from the nearest point of its axis */
    real along;   /* capsule: position of that point, from 0 at `at` to 1 at `to`; else 0 */
} contact_point;

/* 1/a if a > 0, else 1. */
SPRING_INLINE real inverse_of(real a)
{
    return 1 / select_real(a > 0, a, splat(1));
}

/* The length of a vector whose square is given; *inverse: 1/length, or 0 for 0. The error is at most 3 ulp. This is
   faster than a square root and then a division. */
SPRING_INLINE real length_from(real square, real *inverse)
{
    const mask all = not_mask((mask){0});
    *inverse = square;
    vec_inverse_sqrt(inverse, &all, 1);
    return square * *inverse;
}

/* from_core: from the nearest point of the core to the particle. In the core itself, the normal is +y. */
SPRING_INLINE void set_round(contact_point *p, real3 from_core, scalar radius)
{
    real inverse;
    const real distance = length_from(dot3(from_core, from_core), &inverse);
    p->normal = select3(inverse > 0, times3(inverse, from_core), (real3){splat(0), splat(1), splat(0)});
    p->gap = distance - radius;
}

SPRING_INLINE real nearest_on_axis(real3 axis, real3 from_at)
{
    const real square = dot3(axis, axis);
    const real along = dot3(from_at, axis) / select_real(square > 0, square, splat(1));
    return vec_min(vec_not_negative(along), splat(1));
}

SPRING_INLINE void set_box(contact_point *p, const scene_collider *c)
{
    real3 outside = {splat(0), splat(0), splat(0)}, face = outside;
    real square = splat(0), depth = splat(-SCALAR_MAX);
    SPRING_UNROLL
    for (int i = 0; i < 3; i++) {
        const real3 axis = splat3(c->axis[i]);
        const real side = dot3(p->arm, axis), beyond = vec_abs(side) - c->half[i];
        const real sign = select_real(side < 0, splat(-1), splat(1));
        const real over = vec_not_negative(beyond);
        outside = plus_scaled3(outside, sign * over, axis);
        square += over * over;
        face = select3(beyond > depth, times3(sign, axis), face);
        depth = select_real(beyond > depth, beyond, depth);
    }
    set_round(p, outside, c->radius);
    const mask in_core = not_mask(square > 0);
    p->normal = select3(in_core, face, p->normal);
    p->gap = select_real(in_core, depth - c->radius, p->gap);
}

/* fraction: of the drift, for WITHIN_DRIFT */
SPRING_NOINLINE void find_contact(const scene_collider *c, pose_time when, real fraction, const real3 *x,
                                  contact_point *p)
{
    const real3 at = place_of(when, fraction, c->at, c->at_end, c->shift);
    p->along = splat(0);
    p->arm = minus3(*x, at);
    switch (c->shape) {
    case SPRING_PLANE: {
        const real offset = when == WITHIN_DRIFT ? c->offset + fraction * c->offset_shift
                                                 : splat(when == DRIFT_END ? c->offset_end : c->offset);
        p->normal = splat3(c->axis[0]);
        p->gap = dot3(*x, p->normal) - offset;
        break;
    }
    case SPRING_CAPSULE: {
        const real3 axis = minus3(place_of(when, fraction, c->to, c->to_end, c->shift_to), at);
        p->along = nearest_on_axis(axis, p->arm);
        p->arm = plus_scaled3(p->arm, -p->along, axis);
        set_round(p, p->arm, c->radius);
        break;
    }
    case SPRING_BOX:
        set_box(p, c);
        break;
    case SPRING_SPHERE:
        set_round(p, p->arm, c->radius);
        break;
    }
}

/* [m] Gaps below this are rounding errors. */
SPRING_INLINE real contact_slop(const scene_collider *c, real3 x)
{
    const scalar eps = sizeof(scalar) == sizeof(float) ? (scalar)FLT_EPSILON : (scalar)DBL_EPSILON;
    return 8 * eps * (vec_abs(x.x) + vec_abs(x.y) + vec_abs(x.z) + c->radius);
}

/* [m] displacement of the collider during the step, at the contact. */
SPRING_INLINE real3 shift_at(const scene_collider *c, const contact_point *p)
{
    const real3 at = splat3(c->shift);
    return c->shape == SPRING_CAPSULE ? plus_scaled3(at, p->along, minus3(splat3(c->shift_to), at)) : at;
}

/* Whether the collider turns during the step. If so, the gap along a straight path is not convex. */
SPRING_INLINE bool collider_turns(const scene_collider *c)
{
    return c->shape == SPRING_CAPSULE &&
           (c->shift[0] != c->shift_to[0] || c->shift[1] != c->shift_to[1] || c->shift[2] != c->shift_to[2]);
}

/* [m/s] velocity of the surface at the contact. */
SPRING_INLINE real3 surface_velocity(const scene_collider *c, const contact_point *p)
{
    real3 v = splat3(c->velocity);
    if (c->shape == SPRING_CAPSULE)
        v = plus_scaled3(v, p->along, minus3(splat3(c->velocity_to), v));
    return c->spins ? plus3(v, cross3(splat3(c->spin), p->arm)) : v;
}

/* Lanes whose particle may touch the collider on its path from x to x + d. The test is conservative: if R is the radius
   plus the displacement of the collider, (R + |d|)^2 <= (1 + e) R^2 + (1 + 1/e) d^2 for every e > 0. The bound with
   e = 1/16 is close for fast particles, the bound with e = 1/256 for slow ones; reach_fast and reach_slow are their
   first terms. All factors are rounded up, for rounding errors. */
SPRING_INLINE mask may_touch(const scene_collider *c, real3 x, real3 d, real d_squared)
{
    if (c->shape == SPRING_PLANE) {
        const real3 normal = splat3(c->axis[0]);
        const real gap = dot3(x, normal) - c->offset, change = dot3(d, normal) - c->offset_shift;
        return not_mask(gap >= 0) | not_mask(gap + change >= 0);
    }
    real3 arm = minus3(x, splat3(c->at));
    real square = splat(0);
    if (c->shape == SPRING_CAPSULE) {
        const real3 axis = minus3(splat3(c->to), splat3(c->at));
        const real along = vec_min(vec_not_negative(dot3(arm, axis) * c->inverse_square), splat(1));
        arm = plus_scaled3(arm, -along, axis);
    }
    if (c->shape == SPRING_BOX) {
        SPRING_UNROLL
        for (int i = 0; i < 3; i++) {
            const real over = vec_not_negative(vec_abs(dot3(arm, splat3(c->axis[i]))) - c->half[i]);
            square += over * over;
        }
    } else
        square = dot3(arm, arm);
    return not_mask(square > vec_min(c->reach_fast + (scalar)17.1 * d_squared, c->reach_slow + 258 * d_squared));
}

#endif
