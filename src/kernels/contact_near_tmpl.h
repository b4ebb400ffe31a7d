/* SPDX-License-Identifier: MIT */
/*
 * Finding particles that may touch a collider. Their contacts are computed one at a time, by scene/contact.c.
 *
 * Method    For each particle, the distance from a collider at the start is compared with the length of the path. If R
 *           is the reach of the collider, (R + |d|)^2 <= (1 + e) R^2 + (1 + 1/e) d^2 for every e > 0. The bound with
 *           e = 1/16 is close for fast particles, the bound with e = 1/256 for slow ones. All factors are rounded up,
 *           for rounding errors. The root of the first bound is below 1.04 R + 4.2 |d|. So colliders are left out whose
 *           boxes, extended by this, do not meet the box of a chunk of particles. This changes no result.
 */
#ifndef SPRINGSTEP_CONTACT_NEAR_TMPL_H
#define SPRINGSTEP_CONTACT_NEAR_TMPL_H

#include "../simd/real3_tmpl.h"
#include "leapfrog_particles_tmpl.h"
#include "scene_kernels.h"

static void copy_motion(const scene_particles *p, const scene_motion *m, size_t first, size_t count, kept_motion *k)
{
    for (uint32_t a = 0; a < p->axes; a++)
        for (size_t i = 0; i < count; i += lanes) {
            const size_t at = a * p->stride + first + i;
            vec_store(k->x0[a] + i, vec_load(m->x0 + at));
            vec_store(k->v0[a] + i, vec_load(m->v0 + at));
            vec_store(k->force[a] + i, vec_load(m->force + at));
        }
}

/* Lanes whose particle may touch the collider on its path from x0 to x. */
SPRING_INLINE lane_mask may_touch(const collider_bound *c, real3 x0, real3 x, real radius)
{
    if (c->shape == SPRING_PLANE) { /* the gap along the path is linear */
        const real size = vec_abs(x0.x) + vec_abs(x0.y) + vec_abs(x0.z);
        const real reach = radius + (c->reach + 32 * SCALAR_EPSILON * size);
        return not_mask(dot3(x0, splat3(c->axis[0])) - c->offset[0] >= reach) |
               not_mask(dot3(x, splat3(c->axis[1])) - c->offset[1] >= reach);
    }
    real3 arm = minus3(x0, splat3(c->at));
    const real3 d = minus3(minus3(x, x0), splat3(c->shift));
    real square = splat(0);
    if (c->shape == SPRING_CAPSULE) {
        const real3 axis = splat3(c->segment);
        const real along = vec_min(vec_not_negative(dot3(arm, axis) * c->inverse_square), splat(1));
        arm = plus_scaled3(arm, -along, axis);
    }
    if (c->shape == SPRING_BOX) {
        SPRING_ROLLED
        for (int i = 0; i < 3; i++) {
            const real over = vec_not_negative(vec_abs(dot3(arm, splat3(c->axis[i]))) - c->half[i]);
            square += over * over;
        }
    } else
        square = dot3(arm, arm);
    const real reach = c->reach + c->growth * radius, reach_squared = reach * reach;
    const real way = c->growth * c->growth * dot3(d, d);
    return not_mask(
        square > vec_min((scalar)1.07 * reach_squared + (scalar)17.1 * way, (scalar)1.006 * reach_squared + 258 * way));
}

/* The box of the starts of paths, and a bound on their lengths. One of each per lane. */
typedef struct path_bounds {
    real low[3], minus_high[3], minus_way; /* [m] */
} path_bounds;

SPRING_INLINE void begin_bounds(path_bounds *b)
{
    for (int a = 0; a < 3; a++)
        b->low[a] = b->minus_high[a] = splat(SCALAR_MAX);
    b->minus_way = splat(0);
}

SPRING_INLINE void extend_bounds(path_bounds *b, lane_mask where, real3 from, real3 to)
{
    const real start[3] = {from.x, from.y, from.z};
    for (int a = 0; a < 3; a++) {
        b->low[a] = select_real(where, vec_min(start[a], b->low[a]), b->low[a]);
        b->minus_high[a] = select_real(where, vec_min(-start[a], b->minus_high[a]), b->minus_high[a]);
    }
    const real3 d = minus3(to, from);
    const real minus_way = vec_minus_abs(d.x) - vec_abs(d.y) - vec_abs(d.z);
    b->minus_way = select_real(where, vec_min(minus_way, b->minus_way), b->minus_way);
}

SPRING_INLINE scalar least_of_lanes(real a)
{
    scalar each[lanes], least;
    vec_store(each, a);
    least = each[0];
    for (size_t i = 1; i < lanes; i++)
        least = each[i] < least ? each[i] : least;
    return least;
}

/* Sets the bits of the colliders that particles with these paths may touch, and the bound on the lengths. */
SPRING_NOINLINE uint32_t boxes_on_paths(const collider_bounds *c, const path_bounds *b, scalar *most)
{
    scalar low[3], high[3], size = 0;
    for (int a = 0; a < 3; a++) {
        low[a] = least_of_lanes(b->low[a]);
        high[a] = -least_of_lanes(b->minus_high[a]);
        const scalar below = low[a] < 0 ? -low[a] : low[a], above = high[a] < 0 ? -high[a] : high[a];
        size += below > above ? below : above;
    }
    const scalar way = *most = -least_of_lanes(b->minus_way);
    const scalar margin = (scalar)way_of_box * c->growth * way + 64 * SCALAR_EPSILON * (size + way);
    uint32_t meet = 0;
    for (size_t k = 0; k < c->count; k += lanes) {
        lane_mask apart = {0};
        for (int a = 0; a < 3; a++)
            apart |= (vec_load(c->low[a] + k) > high[a] + margin) | (vec_load(c->high[a] + k) < low[a] - margin);
        if (!any(not_mask(apart)))
            continue;
        uint32_t each[lanes];
        store_bits(each, bits_where(not_mask(apart), 1));
        for (size_t i = 0; i < lanes; i++)
            meet |= each[i] << (k + i);
    }
    return meet;
}

SPRING_INLINE real3 load_place(const scalar *quantity, size_t stride, uint32_t axes)
{
    return (real3){vec_load(quantity), vec_load(quantity + stride),
                   axes > 2 ? vec_load(quantity + 2 * stride) : splat(0)};
}

static bool find_near_colliders(resting_chunk *r)
{
    const collider_bounds *const c = r->bounds;
    const scene_particles *const p = r->particles;
    const scalar *const x0 = r->kept->x0[0], *const x = r->kick_drift->x + r->first;
    const size_t count = r->count;
    path_bounds b;
    begin_bounds(&b);
    for (size_t i = 0; i < count; i += lanes) /* without padding lanes */
        extend_bounds(&b, first_lanes(count - i < lanes ? count - i : lanes),
                      load_place(x0 + i, contact_chunk, p->axes), load_place(x + i, p->stride, p->axes));
    r->nearby = boxes_on_paths(c, &b, &r->way);
    if (r->nearby == 0) {
        memset(r->candidate, 0, count * sizeof *r->candidate);
        return false;
    }
    unsigned index[most_colliders], left = 0;
    for (unsigned k = 0; k < c->count; k++) {
        index[left] = k;
        left += r->nearby >> k & 1;
    }
    lane_mask found = {0};
    for (size_t i = 0; i < count; i += lanes) {
        const real3 from = load_place(x0 + i, contact_chunk, p->axes), to = load_place(x + i, p->stride, p->axes);
        const real radius = r->radius_stride != 0 ? vec_load(r->radius + r->first + i) : splat(*r->radius);
        lane_bits bits = bits_where((lane_mask){0}, 0);
        for (unsigned k = 0; k < left; k++) {
            const lane_mask touch = may_touch(&c->each[index[k]], from, to, radius);
            bits |= bits_where(touch, UINT32_C(1) << index[k]);
            found |= touch;
        }
        store_bits(r->candidate + i, bits);
    }
    return any(found);
}

#endif
