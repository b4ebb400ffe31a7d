/* SPDX-License-Identifier: MIT */
/*
 * Finding particles that may touch a collider. Their contacts are computed one at a time, by scene/contact.c.
 *
 * Method    The box of the paths of a chunk of particles is compared with boxes that contain the colliders. For colliders
 *           that are left, the distance at the start is compared with the length of the path of each particle. If R is
 *           the reach of the collider, (R + |d|)^2 <= (1 + e) R^2 + (1 + 1/e) d^2 for every e > 0. The bound with
 *           e = 1/16 is close for fast particles, the bound with e = 1/256 for slow ones. All factors are rounded up,
 *           for rounding errors.
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
    const real reach = c->reach + radius, reach_squared = reach * reach, way = c->growth_squared * dot3(d, d);
    return not_mask(
        square > vec_min((scalar)1.07 * reach_squared + (scalar)17.1 * way, (scalar)1.006 * reach_squared + 258 * way));
}

/* Bits of the colliders whose boxes meet the box from `low` to -minus_high. */
SPRING_NOINLINE uint32_t boxes_that_meet(const collider_bounds *c, const real low[3], const real minus_high[3])
{
    scalar bounds[2][3] = {{0}}, extent = 0, size = 0;
    for (int a = 0; a < 3; a++) {
        scalar each[2][lanes];
        vec_store(each[0], low[a]);
        vec_store(each[1], minus_high[a]);
        for (int side = 0; side < 2; side++) {
            bounds[side][a] = each[side][0];
            for (size_t i = 1; i < lanes; i++)
                bounds[side][a] = each[side][i] < bounds[side][a] ? each[side][i] : bounds[side][a];
        }
        extent += -bounds[1][a] - bounds[0][a];
        const double below = fabs((double)bounds[0][a]), above = fabs((double)bounds[1][a]);
        size += 2 * (scalar)(below > above ? below : above);
    }
    const scalar margin = c->turning * extent + 32 * SCALAR_EPSILON * size;
    uint32_t meet = 0;
    for (size_t k = 0; k < c->count; k += lanes) {
        lane_mask apart = {0};
        for (int a = 0; a < 3; a++)
            apart |=
                (vec_load(c->low[a] + k) > margin - bounds[1][a]) | (vec_load(c->high[a] + k) < bounds[0][a] - margin);
        if (!any(not_mask(apart)))
            continue;
        uint32_t each[lanes];
        store_bits(each, bits_where(not_mask(apart), 1));
        for (size_t i = 0; i < lanes; i++)
            meet |= each[i] << (k + i);
    }
    return meet;
}

/* The same for the path of each particle and collider k. All operations are monotonic, so no particle meets a box that
   boxes_that_meet() excludes, whatever other paths it is given with. */
SPRING_INLINE lane_mask meets_box(const collider_bounds *c, unsigned k, real3 from, real3 to)
{
    const real low[3] = {vec_min(from.x, to.x), vec_min(from.y, to.y), vec_min(from.z, to.z)};
    const real minus_high[3] = {vec_min(-from.x, -to.x), vec_min(-from.y, -to.y), vec_min(-from.z, -to.z)};
    real extent = splat(0), size = splat(0);
    for (int a = 0; a < 3; a++) {
        const real below = vec_abs(low[a]), above = vec_abs(minus_high[a]);
        extent += -minus_high[a] - low[a];
        size += 2 * select_real(below > above, below, above);
    }
    const real margin = c->turning * extent + 32 * SCALAR_EPSILON * size;
    lane_mask apart = not_mask(size >= 0) & (size >= 0);
    for (int a = 0; a < 3; a++)
        apart |= (c->low[a][k] > margin - minus_high[a]) | (c->high[a][k] < low[a] - margin);
    return not_mask(apart);
}

SPRING_INLINE real3 load_place(const scalar *quantity, size_t stride, uint32_t axes)
{
    return (real3){vec_load(quantity), vec_load(quantity + stride),
                   axes > 2 ? vec_load(quantity + 2 * stride) : splat(0)};
}

static bool find_near_colliders(const collider_bounds *c, const scene_particles *p, const kept_motion *kept,
                                const scalar *x, const scalar *radius, size_t radius_stride, size_t first, size_t count,
                                uint32_t nearby[contact_chunk])
{
    real low[3], minus_high[3];
    for (uint32_t a = 0; a < 3; a++)
        low[a] = minus_high[a] = splat(a < p->axes ? SCALAR_MAX : 0);
    for (uint32_t a = 0; a < p->axes; a++)
        for (size_t i = 0; i < count; i += lanes) {
            const real from = vec_load(kept->x0[a] + i), to = vec_load(x + a * p->stride + first + i);
            const lane_mask some = first_lanes(count - i < lanes ? count - i : lanes); /* without padding lanes */
            low[a] = vec_min(select_real(some, vec_min(from, to), low[a]), low[a]);
            minus_high[a] = vec_min(select_real(some, vec_min(-from, -to), minus_high[a]), minus_high[a]);
        }
    const uint32_t meet = boxes_that_meet(c, low, minus_high);
    unsigned index[most_colliders], left = 0;
    for (unsigned k = 0; k < c->count; k++) {
        index[left] = k;
        left += meet >> k & 1;
    }
    lane_mask found = {0};
    if (left == 0)
        memset(nearby, 0, count * sizeof *nearby);
    for (size_t i = 0; i < count && left > 0; i += lanes) {
        const real3 from = load_place(kept->x0[0] + i, contact_chunk, p->axes);
        const real3 to = load_place(x + first + i, p->stride, p->axes);
        const real r = radius_stride != 0 ? vec_load(radius + first + i) : splat(*radius);
        lane_bits bits = bits_where((lane_mask){0}, 0);
        for (unsigned k = 0; k < left; k++) {
            const lane_mask touch = may_touch(&c->each[index[k]], from, to, r);
            bits |= bits_where(touch, UINT32_C(1) << index[k]);
            found |= touch;
        }
        store_bits(nearby + i, bits);
    }
    return any(found);
}

#endif
