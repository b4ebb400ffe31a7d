/* SPDX-License-Identifier: MIT */
/*
 * Particles that rest or slide on one collider during a step: the frequent case of scene/contact.c, on SIMD vectors, in
 * the precision of the scene. contact.c has the formulas and the symbols.
 *
 * Method    Particles whose path may touch one collider only are taken together. Where the contact begins at the start of
 *           the step, the last kick of the previous step, the impact (item 3), pressing from the start (item 4) and
 *           friction are computed here. All other particles are left to contact.c: contacts that begin within the step,
 *           particles inside a collider, corners, custom bodies, surfaces that move in the frame of their body, and negative
 *           steps. The choice depends on the particle only, so results do not depend on the vector width.
 */
#ifndef SPRINGSTEP_CONTACT_REST_TMPL_H
#define SPRINGSTEP_CONTACT_REST_TMPL_H

#include "contact_near_tmpl.h"

/* The nearest point of a surface. */
typedef struct near_lanes {
    real gap;
    real3 normal;
    real along; /* of a capsule */
} near_lanes;

/* Particles on one collider. */
typedef struct resting_lanes {
    const contact_body *b;
    real3 x0, v0, w, d; /* as in contact_particle; v0 after impacts */
    real radius, friction, slop;
    real3 change; /* [m/s] by the contact */
    lane_mask touching, failed;
} resting_lanes;

SPRING_CONTACT_INLINE real3 splat_vector(vector3 v)
{
    return (real3){splat((scalar)v.x), splat((scalar)v.y), splat((scalar)v.z)};
}

SPRING_CONTACT_INLINE real3 zero_lanes(void)
{
    return (real3){splat(0), splat(0), splat(0)};
}

SPRING_CONTACT_INLINE real length_lanes(real3 a)
{
    return vec_sqrt(dot3(a, a));
}

SPRING_CONTACT_INLINE real3 tangential_lanes(real3 u, real3 n)
{
    return plus_scaled3(u, -dot3(u, n), n);
}

SPRING_CONTACT_INLINE real sum_of_sizes(real3 a)
{
    return vec_abs(a.x) + vec_abs(a.y) + vec_abs(a.z);
}

SPRING_CONTACT_INLINE lane_mask are_slow(const real3 *v, scalar fastest)
{
    return (vec_abs(v->x) <= fastest) & (vec_abs(v->y) <= fastest) & (vec_abs(v->z) <= fastest);
}

/* Whether the surface is its own tangent plane throughout the step. */
SPRING_CONTACT_INLINE bool is_fixed_plane(const contact_body *b)
{
    return b->shape == SPRING_PLANE && !b->turns;
}

/* Whether the axes of the frame are those of the scene. */
SPRING_CONTACT_INLINE bool has_plain_frame(const contact_body *b)
{
    return !b->turns && (b->shape == SPRING_SPHERE || b->shape == SPRING_CAPSULE);
}

SPRING_CONTACT_INLINE real3 direction_in_lanes(const contact_body *b, const body_pose *p, real3 a)
{
    if (has_plain_frame(b))
        return a;
    return (real3){dot3(a, splat_vector(p->axis[0])), dot3(a, splat_vector(p->axis[1])),
                   dot3(a, splat_vector(p->axis[2]))};
}

SPRING_CONTACT_INLINE real3 direction_out_lanes(const contact_body *b, const body_pose *p, real3 y)
{
    if (has_plain_frame(b))
        return y;
    return plus_scaled3(plus_scaled3(times3(y.x, splat_vector(p->axis[0])), y.y, splat_vector(p->axis[1])), y.z,
                        splat_vector(p->axis[2]));
}

SPRING_CONTACT_INLINE real3 place_in_lanes(const contact_body *b, const body_pose *p, real3 x)
{
    return direction_in_lanes(b, p, minus3(x, splat_vector(p->at)));
}

SPRING_CONTACT_INLINE vector3 vector_between(vector3 a, vector3 b)
{
    return (vector3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* The displacement from x0 to x0 + d in the frame. Differences of positions would have their rounding errors. */
SPRING_CONTACT_INLINE real3 way_in_lanes(const contact_body *b, real3 x0, real3 d)
{
    real3 way = direction_in_lanes(b, &b->end, minus3(d, splat_vector(vector_between(b->end.at, b->start.at))));
    if (!b->turns)
        return way;
    const real3 arm = minus3(x0, splat_vector(b->start.at));
    real *const each[3] = {&way.x, &way.y, &way.z};
    for (int i = 0; i < 3; i++)
        *each[i] += dot3(arm, splat_vector(vector_between(b->end.axis[i], b->start.axis[i])));
    return way;
}

/* The displacement of a point of the body, at y in its frame. */
SPRING_CONTACT_INLINE real3 way_of_body(const contact_body *b, real3 y)
{
    real3 way = splat_vector(vector_between(b->end.at, b->start.at));
    const real each[3] = {y.x, y.y, y.z};
    for (int i = 0; i < 3 && b->turns; i++)
        way = plus_scaled3(way, each[i], splat_vector(vector_between(b->end.axis[i], b->start.axis[i])));
    return way;
}

SPRING_CONTACT_INLINE void round_lanes(near_lanes *out, real3 from_core, real radius)
{
    const real square = dot3(from_core, from_core), distance = vec_sqrt(square);
    const real3 up = {splat(0), splat(1), splat(0)};
    out->normal = select3(square > 0, times3(1 / distance, from_core), up);
    out->gap = distance - radius;
}

SPRING_NOINLINE void capsule_lanes(near_lanes *out, const real3 *y, const vector3 *segment, const real *radius)
{
    const double square = segment->x * segment->x + segment->y * segment->y + segment->z * segment->z;
    const real3 axis = splat_vector(*segment);
    const real along = square > 0 ? dot3(*y, axis) / splat((scalar)square) : splat(0);
    out->along = vec_min(vec_not_negative(along), splat(1));
    round_lanes(out, plus_scaled3(*y, -out->along, axis), *radius);
}

SPRING_CONTACT_INLINE void box_lanes(near_lanes *out, const contact_body *b, real3 y, real radius)
{
    const real half[3] = {splat((scalar)b->half[0]), splat((scalar)b->half[1]), splat((scalar)b->half[2])};
    const real3 gap = {vec_abs(y.x) - half[0], vec_abs(y.y) - half[1], vec_abs(y.z) - half[2]};
    const lane_mask z_first = (gap.z > gap.x) & (gap.z > gap.y), y_first = not_mask(z_first) & (gap.y > gap.x);
    const lane_mask x_over = gap.x > 0, y_over = gap.y > 0, z_over = gap.z > 0;
    const real zero = splat(0), one = splat(1);
    const real3 side = {select_real(y.x < 0, -one, one), select_real(y.y < 0, -one, one),
                        select_real(y.z < 0, -one, one)};
    out->normal = (real3){select_real(z_first | y_first, zero, side.x), select_real(y_first, side.y, zero),
                          select_real(z_first, side.z, zero)};
    out->gap = select_real(z_first, gap.z, select_real(y_first, gap.y, gap.x)) - radius;
    const lane_mask edge = (x_over & y_over) | (y_over & z_over) | (z_over & x_over);
    if (!any(edge))
        return;
    near_lanes corner;
    round_lanes(&corner,
                (real3){select_real(x_over, side.x * gap.x, zero), select_real(y_over, side.y * gap.y, zero),
                        select_real(z_over, side.z * gap.z, zero)},
                radius);
    out->normal = select3(edge, corner.normal, out->normal);
    out->gap = select_real(edge, corner.gap, out->gap);
}

/* The nearest point of the surface from *y in the frame, at the start or the end of the step. */
SPRING_NOINLINE void nearest_lanes(const contact_body *b, bool at_end, const real3 *y, const real *particle_radius,
                                   near_lanes *out)
{
    const real radius = (scalar)b->radius + *particle_radius;
    out->along = splat(0);
    if (b->shape == SPRING_PLANE) {
        out->normal = (real3){splat(1), splat(0), splat(0)};
        out->gap = y->x - radius;
    } else if (b->shape == SPRING_CAPSULE)
        capsule_lanes(out, y, at_end ? &b->end.segment : &b->start.segment, &radius);
    else if (b->shape == SPRING_BOX)
        box_lanes(out, b, *y, radius);
    else
        round_lanes(out, *y, radius);
}

/* [m/s] Velocity of a point of the body at x. */
SPRING_CONTACT_INLINE real3 body_velocity(const contact_body *b, const body_pose *p, real along, real3 x)
{
    const real3 v = splat_vector(p->velocity);
    if (b->shape == SPRING_CAPSULE)
        return plus_scaled3(v, along, splat_vector(p->stretching));
    return b->turns ? plus3(v, cross3(splat_vector(p->spin), minus3(x, splat_vector(p->at)))) : v;
}

/* The normal of the surface at x, where it touches, and the velocity of the body there. */
SPRING_NOINLINE void surface_lanes(const contact_body *b, const body_pose *p, const real3 *x, const real *radius,
                                   real3 *normal, real3 *velocity)
{
    near_lanes at;
    if (b->shape == SPRING_CAPSULE) { /* not in its frame, which begins anew in each step */
        const real3 arm = minus3(*x, splat_vector(p->at));
        const real distance = (scalar)b->radius + *radius;
        capsule_lanes(&at, &arm, &p->along, &distance);
    } else {
        const real3 y = place_in_lanes(b, p, *x);
        nearest_lanes(b, false, &y, radius, &at);
        at.normal = direction_out_lanes(b, p, at.normal);
    }
    *normal = at.normal;
    *velocity = body_velocity(b, p, at.along, *x);
}

/* The last kick: removes the component of v into the body. */
SPRING_NOINLINE void stop_lanes(const contact_body *b, const body_pose *p, const real3 *x, const real *radius,
                                const real *friction, lane_mask where, real3 *v)
{
    real3 normal, velocity;
    surface_lanes(b, p, x, radius, &normal, &velocity);
    const real3 u = minus3(*v, velocity);
    const real rate = dot3(u, normal);
    const real3 along = plus_scaled3(u, -rate, normal);
    const real limit = (scalar)b->friction * *friction * vec_abs(rate), square = dot3(along, along);
    const lane_mask sticks = square <= limit * limit;
    const real3 slides =
        minus3(plus_scaled3(*v, -rate, normal), times3(limit / vec_sqrt(select_real(sticks, splat(1), square)), along));
    *v = select3(where & (rate < 0), select3(sticks, velocity, slides), *v);
}

/* Items 1 and 2: lanes in which the contact begins at the start of the step are touching. */
SPRING_CONTACT_INLINE void meet_lanes(resting_lanes *q, near_lanes *at, real3 *start, real3 *way, real3 *normal,
                                      real *gap)
{
    const contact_body *const b = q->b;
    const scalar epsilon = 8 * SCALAR_EPSILON;
    q->slop = epsilon * (sum_of_sizes(q->x0) + ((scalar)b->rounding_scale + q->radius));
    *start = place_in_lanes(b, &b->start, q->x0);
    *way = way_in_lanes(b, q->x0, q->d);
    nearest_lanes(b, false, start, &q->radius, at);
    real rate = dot3(at->normal, *way);
    if (b->shape == SPRING_CAPSULE && b->turns)
        rate -= at->along * dot3(at->normal, splat_vector(vector_between(b->end.segment, b->start.segment)));
    const lane_mask later = at->gap >= q->slop;
    const real ahead = select_real(later, at->gap, splat(0));
    q->touching = not_mask(ahead + rate >= 0);
    q->failed = (at->gap < -q->slop) | (q->touching & later);
    *gap = select_real(vec_abs(at->gap) > q->slop / 2, at->gap, splat(0));
    *normal = direction_out_lanes(b, &b->start, at->normal);
}

static const scalar least_cosine_lanes = (scalar)0.1;

SPRING_CONTACT_INLINE real cosine_lanes(real3 n, real3 n_end)
{
    const real cosine = dot3(n, n_end);
    return select_real(cosine > least_cosine_lanes, cosine, splat(least_cosine_lanes));
}

/* The nearest point of the surface from *x at the end of the step, with its normal in the scene. */
SPRING_NOINLINE void nearest_at_end(const resting_lanes *q, const real3 *x, near_lanes *out)
{
    const real3 y = place_in_lanes(q->b, &q->b->end, *x);
    nearest_lanes(q->b, true, &y, &q->radius, out);
    out->normal = direction_out_lanes(q->b, &q->b->end, out->normal);
}

/* Sliding over a step. */
typedef struct slide_lanes {
    real3 u0, A;            /* [m/s] at the start, and its change by other forces */
    real speed;             /* |u0| */
    lane_mask still, where; /* u0 is 0; lanes to compute */
    real3 mean, kick;       /* as in contact.c */
    lane_mask sticks;
} slide_lanes;

/* u' = A - F u/|u| from u0 for a unit of time: slide_from() of contact.c, which explains the cases. */
SPRING_NOINLINE void find_slide(slide_lanes *s, const real *friction, int most_parts)
{
    const scalar parallel = 4096 * SCALAR_EPSILON; /* sine of an angle */
    const real3 zero = zero_lanes(), A = s->A;
    const real F = *friction, square = s->speed * s->speed, push = dot3(A, A);
    const lane_mask holds = s->still & (push <= F * F), slides = s->where & not_mask(holds);
    const lane_mask held = s->where & holds;
    s->mean = select3(held, zero, s->mean);
    s->kick = select3(held, zero, s->kick);
    s->sticks = held | (not_mask(s->where) & s->sticks);
    if (!any(slides))
        return;
    const real3 across = cross3(s->u0, A);
    const lane_mask turns = (square < 64 * F * F) & (dot3(across, across) > parallel * parallel * square * push);
    const real part = select_real(turns, splat(1 / (scalar)most_parts), splat(1)), f = F * part;
    const real3 a = times3(part, A);
    const int parts = any(slides & turns) ? most_parts : 1;
    real3 u = s->u0, sum = zero, direction = zero;
    lane_mask sticks = not_mask(turns) & turns;
    for (int i = 0; i < parts; i++) {
        const lane_mask now = i == 0 ? not_mask(turns) | turns : turns;
        const real speed = i == 0 ? s->speed : length_lanes(u);
        const lane_mask moves = speed > 0;
        const real3 along = select3(moves, times3(1 / speed, u), zero);
        const real deceleration = f - dot3(a, along);
        const lane_mask on = moves & not_mask(deceleration > speed);
        const real3 free = plus3(u, a), once = plus_scaled3(free, -f / 2, along);
        real3 next = plus_scaled3(once, -f / 2, along), pull = along; /* on a line */
        if (parts > 1) {
            const real3 end = plus_scaled3(free, -f, along);
            const real3 heun = plus_scaled3(once, -f / 2 / length_lanes(end), end);
            const real length = length_lanes(free);
            const real3 slow = select3(length > f, times3(1 - f / length, free), zero);
            next = select3(turns, select3(speed > 4 * f, heun, slow), next);
            const real size = length_lanes(next);
            pull = select3(turns & (size > 0), times3(1 / size, next), pull);
        }
        real3 way = plus3(u, next);
        lane_mask stuck = not_mask(dot3(next, next) > 0);
        if (any(slides & not_mask(on))) { /* lanes that stop, or start from rest */
            const real stop = select_real(moves, speed / deceleration, splat(0)), rest = 1 - stop, limit = f * rest;
            const real3 at_stop =
                select3(moves, tangential_lanes(plus_scaled3(u, stop, plus_scaled3(a, -f, along)), along), zero);
            const real3 pushed = plus_scaled3(at_stop, rest, a);
            const real length = length_lanes(pushed);
            const lane_mask ends = length <= limit;
            const real3 toward = times3(1 / length, pushed), last = plus_scaled3(pushed, -limit, toward);
            const real settles = select_real(f > 0, vec_min(rest, length_lanes(at_stop) / f), splat(0));
            const real3 further = select3(ends, times3(settles, at_stop), times3(rest, plus3(at_stop, last)));
            way = select3(on, way, plus3(times3(stop, plus3(u, at_stop)), further));
            next = select3(on, next, select3(ends, zero, last));
            pull = select3(on, pull, toward);
            stuck = (on & stuck) | (not_mask(on) & ends);
        }
        u = select3(now, next, u);
        direction = select3(now, pull, direction);
        sum = plus3(sum, select3(now, way, zero));
        sticks = (now & stuck) | (not_mask(now) & sticks);
    }
    s->sticks |= slides & sticks;
    s->mean = select3(slides, times3(part * (scalar)0.5, sum), s->mean);
    const real3 kick = plus_scaled3(plus_scaled3(u, splat((scalar)-0.5), A), (scalar)0.5 * F, direction);
    s->kick = select3(slides, select3(sticks, zero, kick), s->kick);
}

/* Item 4, early: the lambda for which x + lambda h n lies on the surface at the end. clear: lanes that surely do. After a
   step s of Newton's method, the gap to a surface of radius R is less than s^2 sin^2/(2 R), with the angle between the
   normals. */
SPRING_NOINLINE void find_lambda_lanes(const resting_lanes *q, const real3 *x, const real3 *n, scalar h, int most,
                                       lane_mask where, real *lambda, lane_mask *clear, lane_mask *failed)
{
    const real near_enough = q->slop / 4, radius = (scalar)q->b->radius + q->radius;
    *clear = (lane_mask){0};
    for (int i = 0; i < most && any(where & not_mask(*clear)); i++) {
        near_lanes there;
        const real3 at = plus_scaled3(*x, *lambda * h, *n);
        nearest_at_end(q, &at, &there);
        const real cosine = dot3(*n, there.normal), step = there.gap / cosine;
        *clear |= vec_abs(there.gap) < near_enough;
        *failed |= not_mask(*clear) & not_mask(cosine > least_cosine_lanes);
        *lambda = select_real(*clear, *lambda, vec_not_negative(*lambda - step / h));
        *clear |= step * step * (1 - cosine * cosine) <= near_enough * radius;
    }
}

/* Item 3, in some lanes. */
SPRING_NOINLINE void hit_lanes(resting_lanes *q, const real3 *u, const real3 *n, const real *rate, lane_mask impact,
                               scalar h)
{
    const real normal = -(1 + (scalar)q->b->restitution) * *rate;
    const real limit = (scalar)q->b->friction * q->friction * vec_abs(normal);
    const real3 along = tangential_lanes(*u, *n);
    const real square = dot3(along, along);
    const lane_mask slides = square > limit * limit;
    const real share = select_real(slides, limit / vec_sqrt(select_real(slides, square, splat(1))), splat(1));
    const real3 change = minus3(times3(normal, *n), times3(share, along));
    q->change = select3(impact, change, q->change);
    q->v0 = select3(impact, plus3(q->v0, change), q->v0);
    q->w = select3(impact, plus3(q->w, change), q->w);
    q->d = select3(impact, plus_scaled3(q->d, splat(h), change), q->d);
}

/* Pressing from the start of the step. Lanes that hold are carried by the body; `free` lanes slide. */
typedef struct pressing_lanes {
    real3 x1, along; /* [m] the end without pressing, and the way along the surface */
    real3 n, n_end;  /* normal in the scene, and its direction at the end of the step */
    real3 shift;     /* [m] by friction */
    real inward;     /* [m] from the tangent plane, at the end without pressing */
    real toward, lambda;
    slide_lanes sliding;
    lane_mask presses, clear, failed;
} pressing_lanes;

/* Friction changes where the path ends, and so the impulse: two passes, in the lanes with friction. */
SPRING_CONTACT_INLINE void find_friction(const resting_lanes *q, const near_lanes *there, scalar h, pressing_lanes *s)
{
    const contact_body *const b = q->b;
    const real mu = (scalar)b->friction * q->friction;
    lane_mask rubs = s->presses & (mu > 0);
    for (int pass = 0; pass < 2 && any(rubs); pass++) {
        lane_mask clear = s->clear;
        real lambda = s->lambda;
        if (pass == 0) {
            lambda = vec_not_negative(-there->gap) / (h * cosine_lanes(s->n, there->normal));
        } else {
            const real3 x = plus3(s->x1, s->shift);
            if (b->turns)
                lambda = vec_not_negative(-(s->inward + dot3(s->n_end, s->shift))) / (h * s->toward);
            if (!is_fixed_plane(b))
                find_lambda_lanes(q, &x, &s->n, h, 1, rubs, &lambda, &clear, &s->failed);
        }
        const real friction = 2 * mu * lambda;
        s->sliding.where = rubs;
        find_slide(&s->sliding, &friction, pass == 0 ? 1 : 4);
        s->lambda = select_real(rubs, lambda, s->lambda);
        s->clear = (rubs & clear) | (not_mask(rubs) & s->clear);
        s->shift = select3(rubs, minus3(times3(splat(h), s->sliding.mean), s->along), s->shift);
        if (b->shape != SPRING_CAPSULE) /* lanes that hold have their result */
            rubs &= not_mask(s->sliding.sticks & (dot3(s->sliding.mean, s->sliding.mean) == 0));
    }
}

/* [m] The displacement of the point of the body that a particle at *y in its frame rests on. */
SPRING_CONTACT_INLINE real3 ride_of(const contact_body *b, real3 y, real along)
{
    const real3 ride = b->moves ? way_of_body(b, y) : zero_lanes();
    if (b->shape != SPRING_CAPSULE || !b->turns)
        return ride;
    const real3 longer = splat_vector(vector_between(b->end.segment, b->start.segment));
    return plus_scaled3(ride, along, direction_out_lanes(b, &b->end, longer));
}

/* Items 3 and 4 from the start of the step, in the lanes that touch. */
SPRING_CONTACT_INLINE void press_lanes(resting_lanes *q, const near_lanes *at, real3 y0, real3 way, real3 n, real gap,
                                       scalar h)
{
    const contact_body *const b = q->b;
    const real3 velocity = body_velocity(b, &b->start, at->along, q->x0);
    real3 u = minus3(q->v0, velocity);
    const real rate = dot3(u, n);
    const lane_mask impact = q->touching & (rate * h < -q->slop);
    if (any(impact)) {
        const real3 d = q->d;
        hit_lanes(q, &u, &n, &rate, impact, h);
        u = minus3(q->v0, velocity);
        way = plus3(way, direction_in_lanes(b, &b->end, minus3(q->d, d)));
    }
    pressing_lanes s;
    near_lanes there;
    s.x1 = plus3(q->x0, q->d);
    nearest_at_end(q, &s.x1, &there);
    s.inward = gap + dot3(at->normal, way);
    s.presses = q->touching & not_mask((s.inward >= 0) & (there.gap >= 0));
    if (!any(s.presses))
        return;
    s.n = s.n_end = n;
    s.toward = splat(1);
    if (!has_plain_frame(b)) {
        s.n_end = direction_out_lanes(b, &b->end, at->normal);
        s.toward = cosine_lanes(n, s.n_end);
        way = direction_out_lanes(b, &b->end, way);
    }
    s.along = tangential_lanes(way, n);
    s.shift = zero_lanes();
    s.lambda = vec_not_negative(-s.inward) / (h * s.toward);
    s.failed = not_mask(s.presses) & s.presses;
    s.clear = not_mask(s.failed);
    const real inverse = splat(1 / h);
    const real3 mean = times3(inverse, s.along);
    s.sliding.u0 = tangential_lanes(u, n);
    s.sliding.A = times3(splat(2), minus3(mean, s.sliding.u0));
    s.sliding.mean = s.sliding.kick = mean;
    s.sliding.sticks = s.failed;
    s.sliding.speed = length_lanes(s.sliding.u0);
    s.sliding.still = s.sliding.speed == 0;
    find_friction(q, &there, h, &s);
    const lane_mask carried = s.sliding.sticks & (s.sliding.speed * h <= q->slop), free = s.presses & not_mask(carried);
    real3 d = zero_lanes(), change = d;
    if (any(free)) {
        const real3 x = plus3(s.x1, s.shift);
        if (!is_fixed_plane(b))
            find_lambda_lanes(q, &x, &n, h, 3, free, &s.lambda, &s.clear, &s.failed);
        d = plus_scaled3(plus3(q->d, s.shift), s.lambda * h, n);
        change = plus_scaled3(minus3(s.sliding.kick, mean), s.lambda, n);
        if (any(free & not_mask(s.clear))) { /* otherwise item 5 follows */
            const real3 x_end = plus3(q->x0, d);
            nearest_at_end(q, &x_end, &there);
            s.failed |= not_mask(s.clear) & not_mask(there.gap >= -q->slop);
        }
    }
    s.failed &= free;
    if (any(s.presses & carried)) {
        const real3 ride = ride_of(b, y0, at->along);
        s.failed |= carried & (at->gap < -q->slop / 2);
        d = select3(carried, ride, d);
        change = select3(carried, minus3(times3(inverse, ride), q->w), change);
    }
    q->failed |= s.presses & s.failed;
    q->d = select3(s.presses, d, q->d);
    q->w = select3(s.presses, plus3(q->w, change), q->w);
    q->change = select3(s.presses, plus3(q->change, change), q->change);
}

/* Particles of a chunk, one in each lane. */
typedef struct picked_particles {
    size_t place[lanes]; /* in the chunk; of consecutive particles only the first is set */
    lane_mask where;     /* the lanes to compute; others have the values of some particle */
    bool consecutive;
} picked_particles;

/* With at most two lanes, a vector with any of these particles is computed as it is: one lane is half of it. */
enum { always_consecutive = lanes <= 2 };

SPRING_CONTACT_INLINE bool are_consecutive(const picked_particles *l)
{
    return always_consecutive || l->consecutive;
}

SPRING_NOINLINE void pick_each(const picked_particles *l, const scalar *from, size_t stride, uint32_t axes, real *to)
{
    for (uint32_t a = 0; a < axes; a++)
        to[a] = vec_load_places(from + a * stride, l->place);
}

/* A quantity of these particles. from: of the first particle of the chunk; step: between particles, 1, or 0: it is one
   vector for all particles */
SPRING_CONTACT_INLINE real pick(const picked_particles *l, const scalar *from, size_t step)
{
    real picked;
    if (are_consecutive(l) || step == 0)
        return vec_load(from + step * l->place[0]);
    pick_each(l, from, 0, 1, &picked);
    return picked;
}

/* The same on each axis; stride: between axes. */
SPRING_CONTACT_INLINE real3 pick3(const picked_particles *l, const scalar *from, size_t stride, size_t step,
                                  uint32_t axes)
{
    if (are_consecutive(l) || step == 0)
        return load_place(from + step * l->place[0], stride, axes);
    real to[3] = {splat(0), splat(0), splat(0)};
    pick_each(l, from, stride, axes, to);
    return (real3){to[0], to[1], to[2]};
}

/* One copy, for functions that take little time. */
SPRING_NOINLINE real3 pick3_rarely(const picked_particles *l, const scalar *from, size_t stride, size_t step,
                                   uint32_t axes)
{
    return pick3(l, from, stride, step, axes);
}

/* The radius, and the factor of friction. */
SPRING_CONTACT_INLINE void pick_surface(const candidate_chunk *r, const picked_particles *l, real *radius,
                                        real *friction)
{
    *radius = pick(l, r->radius + r->first * r->radius_stride, r->radius_stride);
    *friction = splat(1);
    if (r->friction != NULL)
        *friction = pick(l, r->friction + r->first, 1);
}

SPRING_NOINLINE void put_each(const picked_particles *l, const lane_mask *where, const real each[3], scalar *to,
                              size_t stride, uint32_t axes)
{
    scalar value[3][lanes];
    uint32_t changes[lanes];
    store_bits(changes, bits_where(*where, 1));
    for (uint32_t a = 0; a < axes; a++)
        vec_store(value[a], each[a]);
    for (size_t j = 0; j < lanes; j++)
        for (uint32_t a = 0; a < axes && changes[j] != 0; a++)
            to[a * stride + l->place[j]] = value[a][j];
}

SPRING_NOINLINE void put3(const picked_particles *l, const lane_mask *where, const real3 *value, scalar *to,
                          size_t stride, uint32_t axes)
{
    const real each[3] = {value->x, value->y, value->z};
    if (!are_consecutive(l)) {
        put_each(l, where, each, to, stride, axes);
        return;
    }
    for (uint32_t a = 0; a < axes; a++) {
        scalar *const at = to + a * stride + l->place[0];
        vec_store(at, select_real(*where, each[a], vec_load(at)));
    }
}

/* Removes lanes whose changed path may touch another collider. */
SPRING_NOINLINE void leave_to_others(candidate_chunk *r, unsigned c, const resting_lanes *q, lane_mask *fine)
{
    const real3 x = plus3(q->x0, q->d);
    const scalar way = -least_of_lanes(select_real(*fine & q->touching, minus_way(q->x0, x), splat(0)));
    if (way > r->way) {
        r->nearby |= reached_on_way(r, way);
        r->way = way;
    }
    for (unsigned o = 0; o < r->bounds->count; o++) {
        real away;
        if (o != c && (r->nearby >> o & 1) != 0)
            *fine &= not_mask(q->touching & may_touch(&r->bounds->each[o], q->x0, x, q->radius, &away));
    }
}

SPRING_CONTACT_INLINE void pick_resting(const candidate_chunk *r, const picked_particles *l, unsigned c,
                                        resting_lanes *q)
{
    q->b = &r->setting->body[c];
    q->x0 = pick3(l, r->kept->x0[0], contact_chunk, 1, r->particles->axes);
    q->v0 = pick3(l, r->kept->v0[0], contact_chunk, 1, r->particles->axes);
    pick_surface(r, l, &q->radius, &q->friction);
}

/* Items 2 to 4. Returns the lanes that have a valid result; others are left to contact.c. */
SPRING_NOINLINE lane_mask rest_lanes(candidate_chunk *r, const picked_particles *l, unsigned c, resting_lanes *q)
{
    const scalar h = (scalar)r->setting->h;
    lane_mask fine = l->where & are_slow(&q->v0, r->step->max_speed);
    near_lanes at;
    real3 y0, way, n;
    real gap;
    q->change = zero_lanes();
    meet_lanes(q, &at, &y0, &way, &n, &gap);
    q->touching &= l->where;
    if (any(q->touching))
        press_lanes(q, &at, y0, way, n, gap, h);
    const real3 x = plus3(q->x0, q->d);
    fine &= not_mask(q->failed) & not_mask(not_finite(x.x) | not_finite(x.y) | not_finite(x.z));
    if (r->bounds->count > 1 && any(fine & q->touching))
        leave_to_others(r, c, q, &fine);
    return fine;
}

/* Writes the results of lanes that touch a collider. */
SPRING_NOINLINE void put_resting(candidate_chunk *r, const picked_particles *l, const lane_mask *done,
                                 const resting_lanes *q, const real3 *x, const real3 *v)
{
    const scene_particles *const p = r->particles;
    put3(l, done, x, r->step->x + r->first, p->stride, p->axes);
    put3(l, done, v, r->step->v + r->first, p->stride, p->axes);
    put3(l, done, &q->change, r->change, contact_chunk, 3);
}

/* The velocity after an implicit kick by the acceleration `free`. */
SPRING_CONTACT_INLINE real end_of_kick(const scene_motion *m, bool dragged, const implicit_factors *damping, real v0,
                                       real free)
{
    const real u = v0 + m->kick * free;
    return dragged ? implicit_velocity(u, damping) : u;
}

/* A kick and a drift of particles that may touch collider c only: see rest_step. */
static lane_bits rest_on_collider(candidate_chunk *r, const picked_particles *l, unsigned c)
{
    const scene_particles *const p = r->particles;
    const scene_motion *const m = r->step;
    const size_t first = r->first;
    const uint32_t axes = p->axes;
    const bool dragged = p->drag != 0, implicit = m->contacts == IMPLICIT_KICK_DRIFT_CONTACTS;
    resting_lanes q;
    const real inverse_mass = pick(l, p->inverse_mass + first * p->mass_stride, p->mass_stride);
    const real3 force = pick3(l, r->kept->force, r->kept->force_stride, 1, axes);
    const real3 held = pick3(l, p->held + first * p->held_stride, p->stride * p->held_stride, p->held_stride, axes);
    const real pull[3] = {force.x + held.x, force.y + held.y, force.z + held.z};
    pick_resting(r, l, c, &q);
    const real drag = p->drag * inverse_mass;
    implicit_factors damping = {splat(1), splat(0)};
    if (dragged)
        damping = implicit_factors_of(m->kick * drag);
    real free[3], v0[3] = {q.v0.x, q.v0.y, q.v0.z}, w[3];
    for (uint32_t a = 0; a < 3; a++) {
        free[a] = a < axes ? inverse_mass * pull[a] + vec_load(p->gravity + a * padding) : splat(0);
        if (m->ends_previous)
            v0[a] = end_of_kick(m, dragged, &damping, v0[a], free[a]);
        const real accel = dragged ? free[a] - drag * v0[a] : free[a];
        w[a] = implicit ? end_of_kick(m, dragged, &damping, v0[a], free[a]) : v0[a] + m->kick * accel;
    }
    q.v0 = (real3){v0[0], v0[1], v0[2]};
    q.w = (real3){w[0], w[1], w[2]};
    q.d = times3(splat(m->drift), q.w);
    lane_mask fine = rest_lanes(r, l, c, &q);
    if (implicit)
        fine &= are_slow(&q.w, m->max_speed);
    const lane_mask done = fine & q.touching;
    if (!any(done))
        return bits_where(fine, RESTS_DONE);
    const real3 x = plus3(q.x0, q.d);
    if (m->predicted != NULL) {
        real3 predicted = {end_of_kick(m, dragged, &damping, q.w.x, free[0]),
                           end_of_kick(m, dragged, &damping, q.w.y, free[1]),
                           end_of_kick(m, dragged, &damping, q.w.z, free[2])};
        stop_lanes(q.b, &q.b->end, &x, &q.radius, &q.friction, q.touching, &predicted);
        put3(l, &done, &predicted, m->predicted + first, p->stride, axes);
    }
    put_resting(r, l, &done, &q, &x, &q.w);
    return bits_where(fine, RESTS_DONE) | bits_where(done, RESTS_TOUCHING);
}

/* The same for a whole step: it counts as a drift with its mean velocity between two kicks. */
static lane_bits rest_in_whole_step(candidate_chunk *r, const picked_particles *l, unsigned c)
{
    const scene_particles *const p = r->particles;
    const scene_motion *const m = r->step;
    resting_lanes q;
    pick_resting(r, l, c, &q);
    const real3 v_free = pick3_rarely(l, m->v + r->first, p->stride, 1, p->axes);
    const real3 x_free = pick3_rarely(l, m->x + r->first, p->stride, 1, p->axes);
    q.d = minus3(x_free, q.x0);
    q.w = times3(splat(1 / (scalar)r->setting->h), q.d);
    lane_mask fine = rest_lanes(r, l, c, &q);
    if (!any(fine & q.touching))
        return bits_where(fine, RESTS_DONE);
    const real3 x = plus3(q.x0, q.d);
    real3 v = plus3(v_free, q.change);
    stop_lanes(q.b, &q.b->end, &x, &q.radius, &q.friction, q.touching, &v);
    q.change = minus3(v, v_free);
    fine &= are_slow(&v, m->max_speed);
    const lane_mask done = fine & q.touching;
    put_resting(r, l, &done, &q, &x, &v);
    put3(l, &done, &x_free, r->kept->x0[0], contact_chunk, p->axes);
    return bits_where(fine, RESTS_DONE) | bits_where(done, RESTS_TOUCHING);
}

static lane_bits stop_on_collider(candidate_chunk *r, const picked_particles *l, unsigned c)
{
    const contact_body *const b = &r->setting->body[c];
    const scene_particles *const p = r->particles;
    const scene_motion *const m = r->step;
    const real3 x = pick3(l, r->place, p->stride, 1, p->axes);
    const real3 kicked = pick3(l, m->v + r->first, p->stride, 1, p->axes);
    real radius, friction;
    pick_surface(r, l, &radius, &friction);
    real3 v = kicked;
    stop_lanes(b, r->at_end ? &b->end : &b->start, &x, &radius, &friction, l->where, &v);
    const lane_mask fine = l->where & are_slow(&v, m->max_speed);
    const real3 change = minus3(v, kicked);
    put3(l, &fine, &v, m->v + r->first, p->stride, p->axes);
    put3(l, &fine, &change, r->change, contact_chunk, 3);
    return bits_where(fine, RESTS_DONE | RESTS_TOUCHING);
}

/* [m/s] The changes of the velocity of a body under particles at x with the velocity v: in the step, and until its middle. */
SPRING_NOINLINE void velocity_changes(const contact_body *b, scalar h, const real3 *x, const real3 *v, real3 *in_step,
                                      real3 *until_middle)
{
    const real3 middle = plus_scaled3(*x, splat(h / 2), *v);
    const real3 carried =
        plus3(splat_vector(b->end.at), direction_out_lanes(b, &b->end, place_in_lanes(b, &b->start, *x)));
    const real3 place[4] = {*x, middle, middle, carried};
    real3 at[4];
    SPRING_ROLLED
    for (int i = 0; i < 4; i++)
        at[i] = body_velocity(b, i < 2 ? &b->start : &b->end, splat(0), place[i]);
    *in_step = minus3(at[3], at[0]);
    *until_middle = minus3(plus_scaled3(at[1], splat((scalar)0.5), minus3(at[2], at[1])), at[0]);
}

/* Particles that touch collider c at the start of the step and press on it: see presses(). They should neither leave it nor
   slide at the end of the step. Contacts that are computed after the kick have impacts. */
static lane_bits pressing_on_collider(candidate_chunk *r, const picked_particles *l, unsigned c)
{
    const contact_body *const b = &r->setting->body[c];
    const scene_particles *const p = r->particles;
    const scene_motion *const m = r->step;
    const size_t first = r->first, stride = p->stride;
    const scalar h = (scalar)r->setting->h;
    const real3 x = pick3_rarely(l, r->place, stride, 1, p->axes),
                v = pick3_rarely(l, m->v0 + first, stride, 1, p->axes),
                residual = pick3_rarely(l, m->v + first, stride, 1, p->axes);
    real radius, friction;
    pick_surface(r, l, &radius, &friction);
    real3 normal, velocity, in_step = zero_lanes(), until_middle = in_step;
    surface_lanes(b, &b->start, &x, &radius, &normal, &velocity);
    const real3 u = minus3(v, velocity);
    const real load = -h * dot3(residual, normal), leaving = dot3(u, normal);
    const real rounding = 64 * SCALAR_EPSILON * (sum_of_sizes(v) + sum_of_sizes(velocity));
    const lane_mask presses = l->where & (load > 0) & ((leaving <= rounding) | (leaving <= r->returning * load));
    if (!any(presses))
        return bits_where(l->where, RESTS_DONE);
    if (b->moves)
        velocity_changes(b, h, &x, &v, &in_step, &until_middle);
    const real3 wanted = plus_scaled3(minus3(in_step, u), select_real(leaving < 0, leaving, splat(0)), normal);
    const real change = dot3(wanted, normal);
    const real3 slip = minus3(u, until_middle);
    /* as in pressed_value */
    const real3 value[6] = {{splat((scalar)FREE_IN_PLANE), splat((scalar)c), (scalar)b->friction * friction},
                            normal,
                            normal,
                            times3(change / h, normal),
                            plus_scaled3(wanted, -change, normal),
                            plus_scaled3(slip, -dot3(slip, normal), normal)};
    for (size_t i = 0; i < 6; i++)
        put3(l, &presses, &value[i], r->pressed + 3 * i * stride + first, stride, 3);
    return bits_where(l->where, RESTS_DONE) | bits_where(presses, RESTS_PRESSED);
}

/* Computes the contact of some particles with collider c, their only candidate. Returns bits of rest_result. */
typedef lane_bits rest_step(candidate_chunk *r, const picked_particles *l, unsigned c);

/* Computes the particles at the places of a list, which are not consecutive. */
SPRING_NOINLINE void step_listed(candidate_chunk *r, unsigned c, const uint8_t *list, size_t listed, rest_step *step)
{
    for (size_t k = 0; k < listed; k += lanes) {
        const size_t many = listed - k < lanes ? listed - k : lanes;
        picked_particles l = {.where = first_lanes(many)};
        uint32_t result[lanes];
        for (size_t j = 0; j < lanes; j++)
            l.place[j] = list[k + (j < many ? j : 0)];
        store_bits(result, step(r, &l, c));
        for (size_t j = 0; j < many; j++)
            r->done[l.place[j]] |= result[j];
    }
}

/* Vectors of consecutive particles of which at least half have this collider as their only candidate are computed as
   they are. Other particles are collected first. Returns the bits of the colliders that had particles. */
SPRING_NOINLINE uint32_t for_each_candidate(candidate_chunk *r, rest_step *step)
{
    const uint32_t nearby = r->nearby;
    uint32_t found = 0;
    for (unsigned c = 0; c < r->setting->count; c++) {
        const contact_body *const b = &r->setting->body[c];
        if ((nearby >> c & 1) == 0 || b->slips || b->degenerate || is_custom(b->shape))
            continue;
        picked_particles l;
        uint8_t list[contact_chunk];
        size_t listed = 0;
        l.consecutive = true;
        for (size_t i = 0; i < r->count; i += lanes) {
            uint32_t ours[lanes]; /* 1 where it is */
            size_t many = 0;
            l.where = are_bits(load_bits(r->candidate + i), UINT32_C(1) << c);
            if (!any(l.where))
                continue;
            store_bits(ours, bits_where(l.where, 1));
            for (size_t j = 0; j < lanes; j++) {
                list[listed + many] = (uint8_t)(i + j);
                many += ours[j];
            }
            found |= UINT32_C(1) << c;
            l.place[0] = i;
            if (!always_consecutive && 2 * many < lanes)
                listed += many;
            else
                store_bits(r->done + i, load_bits(r->done + i) | step(r, &l, c));
        }
        if (!always_consecutive)
            step_listed(r, c, list, listed, step);
    }
    return found;
}

/* The partial sums of impulses, by the place in the chunk, so that they do not depend on the vector width. */
enum { impulse_sums = 8, sum_vectors = impulse_sums > lanes ? impulse_sums / lanes : 1 };

/* Adds the impulses of the changes of velocity of particles at x to collider c. `moves`: the contact also moved them, to x
   of the step. Moments are summed about the first particle of the chunk, which single precision resolves better than a
   distant origin. */
SPRING_NOINLINE void add_impulses_of(const candidate_chunk *r, unsigned c, const scalar *x, size_t stride, bool moves)
{
    const scene_particles *const p = r->particles;
    const real3 from = {splat(x[0]), splat(x[stride]), splat(p->axes > 2 ? x[2 * stride] : 0)};
    real sum[sum_vectors][6];
    for (int k = 0; k < sum_vectors; k++)
        for (int q = 0; q < 6; q++)
            sum[k][q] = splat(0);
    for (size_t i = 0; i < r->count; i += lanes) {
        const lane_mask where = are_bits(load_bits(r->candidate + i), UINT32_C(1) << c) &
                                are_bits(load_bits(r->done + i), RESTS_DONE | RESTS_TOUCHING);
        if (!any(where))
            continue;
        const real minus_mass = -1 / vec_load(p->inverse_mass + (r->first + i) * p->mass_stride);
        const real3 at = load_place(x + i, stride, p->axes);
        const real3 impulse = times3(minus_mass, load_place(r->change + i, contact_chunk, 3));
        real3 moment = cross3(minus3(at, from), impulse);
        if (moves) {
            const size_t end = r->first + i;
            const real3 way = minus3(load_place(r->step->x + end, p->stride, p->axes), at);
            const real3 lost = times3(minus_mass, load_place(r->step->v + end, p->stride, p->axes));
            moment = plus3(moment, cross3(way, lost));
        }
        const real each[6] = {impulse.x, impulse.y, impulse.z, moment.x, moment.y, moment.z};
        for (int q = 0; q < 6; q++)
            sum[i / lanes % sum_vectors][q] += select_real(where, each[q], splat(0));
    }
    double total[6] = {0}, arm[3];
    for (int k = 0; k < sum_vectors; k++)
        for (int q = 0; q < 6; q++) {
            scalar part[lanes];
            vec_store(part, sum[k][q]);
            for (size_t j = 0; j < lanes; j++)
                total[q] += (double)part[j];
        }
    spring_impulse *const of_body = &r->setting->impulse[c];
    for (uint32_t a = 0; a < 3; a++)
        arm[a] = (a < p->axes ? (double)x[a * stride] : 0) - r->setting->origin[c][a];
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, d = (a + 2) % 3;
        of_body->linear[a] += total[a];
        of_body->angular[a] += total[3 + a] + (arm[b] * total[d] - arm[d] * total[b]);
    }
}

/* colliders: their bits */
SPRING_CONTACT_INLINE void add_impulses(const candidate_chunk *r, uint32_t colliders, const scalar *x, size_t stride,
                                        bool moves)
{
    for (unsigned c = 0; c < r->setting->count; c++)
        if ((colliders >> c & 1) != 0)
            add_impulses_of(r, c, x, stride, moves);
}

static void stop_touching(candidate_chunk *r)
{
    add_impulses(r, for_each_candidate(r, stop_on_collider), r->place, r->particles->stride, false);
}

static void detect_pressing(candidate_chunk *r)
{
    for_each_candidate(r, pressing_on_collider);
}

static void advance_resting(candidate_chunk *r)
{
    rest_step *const step = r->step->contacts == WHOLE_STEP_CONTACTS ? rest_in_whole_step : rest_on_collider;
    add_impulses(r, for_each_candidate(r, step), r->kept->x0[0], contact_chunk, true);
}

#endif
