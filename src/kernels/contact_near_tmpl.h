/* SPDX-License-Identifier: MIT */
/*
 * Finding particles that may touch a collider.
 *
 * Method    A particle of radius r may touch a collider on the path d if its distance from the core of the collider at the
 *           start is at most reach + growth (r + |d - shift|): see contact_body. |d - shift| is replaced by the sum of
 *           its components, which is not smaller.
 *
 *           Most chunks of particles are far from most colliders. The clearance of a chunk from a collider is a lower
 *           bound on the distance of its particles from the core at the start of a step. It is kept during a call: a step
 *           reduces it by the longest path and by the displacement of the core. The collider is left out while the
 *           clearance exceeds the right side of the inequality. This changes no result.
 */
#ifndef SPRINGSTEP_CONTACT_NEAR_TMPL_H
#define SPRINGSTEP_CONTACT_NEAR_TMPL_H

#include "../simd/real3_tmpl.h"
#include "leapfrog_particles_tmpl.h"
#include "scene_kernels.h"

static void copy_motion(const scene_particles *p, const scene_motion *m, size_t first, size_t count, kept_motion *k)
{
    const bool predicts = m->predicted == m->force;
    k->force = predicts ? k->force_copy[0] : m->force + first;
    k->force_stride = predicts ? contact_chunk : p->stride;
    for (uint32_t a = 0; a < p->axes; a++)
        for (size_t i = 0; i < count; i += lanes) {
            const size_t at = a * p->stride + first + i;
            vec_store(k->x0[a] + i, vec_load(m->x0 + at));
            vec_store(k->v0[a] + i, vec_load(m->v0 + at));
            if (predicts)
                vec_store(k->force_copy[a] + i, vec_load(m->force + at));
        }
}

/* Lanes whose particle may touch the collider on its path from x0 to x. away: the squared distance from its core at the
   start, of a plane the distance */
SPRING_INLINE lane_mask may_touch(const collider_bound *c, real3 x0, real3 x, real radius, real *away)
{
    if (c->shape == SPRING_PLANE) { /* the gap along the path is linear */
        const real size = vec_abs(x0.x) + vec_abs(x0.y) + vec_abs(x0.z);
        const real rounding = 32 * SCALAR_EPSILON * size, reach = radius + (c->reach + rounding);
        const real gap = dot3(x0, splat3(c->axis[0])) - c->offset[0];
        *away = gap - 2 * rounding;
        return not_mask(gap > reach) | not_mask(dot3(x, splat3(c->axis[1])) - c->offset[1] > reach);
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
    *away = square;
    const real way = vec_abs(d.x) + vec_abs(d.y) + vec_abs(d.z);
    const real wide = (1 + 16 * SCALAR_EPSILON) * (c->reach + c->growth * (radius + way));
    return not_mask(square > wide * wide);
}

SPRING_INLINE real3 load_place(const scalar *quantity, size_t stride, uint32_t axes)
{
    return (real3){vec_load(quantity), vec_load(quantity + stride),
                   axes > 2 ? vec_load(quantity + 2 * stride) : splat(0)};
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

/* Minus a bound on the length of paths. */
SPRING_INLINE real minus_way(real3 from, real3 to)
{
    const real3 d = minus3(to, from);
    return vec_minus_abs(d.x) - vec_abs(d.y) - vec_abs(d.z);
}

/* Lanes from i on that are particles of the chunk. */
SPRING_INLINE lane_mask lanes_of_chunk(const candidate_chunk *r, size_t i)
{
    return first_lanes(r->count - i < lanes ? r->count - i : lanes);
}

SPRING_INLINE scalar longest_way(const candidate_chunk *r)
{
    const scalar *const x0 = r->kept->x0[0], *const x = r->step->x + r->first;
    const scene_particles *const p = r->particles;
    real least = splat(0);
    for (size_t i = 0; i < r->count; i += lanes) {
        const real each = minus_way(load_place(x0 + i, contact_chunk, p->axes), load_place(x + i, p->stride, p->axes));
        least = select_real(lanes_of_chunk(r, i), vec_min(each, least), least);
    }
    return -least_of_lanes(least);
}

/* Bits of the colliders that a chunk may touch on paths of this length. The clearance is reduced by the step. */
SPRING_NOINLINE uint32_t reached_on_way(const candidate_chunk *r, scalar way)
{
    const collider_bounds *const c = r->bounds;
    uint32_t reached = 0;
    for (size_t k = 0; k < c->count; k += lanes) {
        const real clear = vec_load(r->clearance + k), both = way + vec_load(c->displacement + k);
        uint32_t each[lanes];
        store_bits(each, bits_where(not_mask(clear > vec_load(c->wide + k) + vec_load(c->factor + k) * both), 1));
        for (size_t i = 0; i < lanes && k + i < c->count; i++)
            reached |= each[i] << (k + i);
        vec_store(r->clearance + k, (1 - 4 * SCALAR_EPSILON) * clear - (scalar)rounded_up * both);
    }
    return reached;
}

/* Finds the clearance from the box of the chunk, and removes colliders from r->nearby. */
SPRING_NOINLINE void compare_boxes(candidate_chunk *r)
{
    const collider_bounds *const c = r->bounds;
    const scene_particles *const p = r->particles;
    real low[3], minus_high[3];
    scalar least[3], most[3], size = 0;
    for (int a = 0; a < 3; a++)
        low[a] = minus_high[a] = splat(SCALAR_MAX);
    for (size_t i = 0; i < r->count; i += lanes) {
        const lane_mask where = lanes_of_chunk(r, i);
        const real3 from = load_place(r->kept->x0[0] + i, contact_chunk, p->axes);
        const real start[3] = {from.x, from.y, from.z};
        for (int a = 0; a < 3; a++) {
            low[a] = select_real(where, vec_min(start[a], low[a]), low[a]);
            minus_high[a] = select_real(where, vec_min(-start[a], minus_high[a]), minus_high[a]);
        }
    }
    for (int a = 0; a < 3; a++) {
        least[a] = least_of_lanes(low[a]);
        most[a] = -least_of_lanes(minus_high[a]);
        const scalar below = least[a] < 0 ? -least[a] : least[a], above = most[a] < 0 ? -most[a] : most[a];
        size += below > above ? below : above;
    }
    for (size_t k = 0; k < c->count; k += lanes) {
        real gap = splat(-SCALAR_MAX);
        for (int a = 0; a < 3; a++) {
            gap = -vec_min(-gap, most[a] - vec_load(c->low[a] + k));
            gap = -vec_min(-gap, vec_load(c->high[a] + k) - least[a]);
        }
        gap -= 64 * SCALAR_EPSILON * size;
        const real both = r->way + vec_load(c->displacement + k), clear = vec_load(r->clearance + k);
        const lane_mask apart = gap > vec_load(c->factor + k) * both;
        uint32_t each[lanes];
        store_bits(each, bits_where(apart, 1));
        for (size_t i = 0; i < lanes && k + i < c->count; i++)
            r->nearby &= ~(each[i] << (k + i));
        vec_store(r->clearance + k, select_real(apart, gap + vec_load(c->wide + k) - (scalar)rounded_up * both, clear));
    }
}

/* Adds collider k to the candidates. Returns the bits of the vectors that have one. */
SPRING_NOINLINE uint64_t find_candidates(candidate_chunk *r, unsigned k)
{
    const collider_bound *const c = &r->bounds->each[k];
    const scene_particles *const p = r->particles;
    const scalar *const x0 = r->kept->x0[0], *const x = r->step->x + r->first;
    real least = splat(SCALAR_MAX);
    uint64_t found = 0;
    for (size_t i = 0; i < r->count; i += lanes) {
        const real3 from = load_place(x0 + i, contact_chunk, p->axes), to = load_place(x + i, p->stride, p->axes);
        const real radius = r->radius_stride != 0 ? vec_load(r->radius + r->first + i) : splat(*r->radius);
        const real inverse_mass = vec_load(p->inverse_mass + (r->first + i) * p->mass_stride);
        const lane_mask moves = lanes_of_chunk(r, i) & (inverse_mass > 0);
        real away;
        const lane_mask touch = moves & may_touch(c, from, to, radius, &away);
        least = select_real(moves, vec_min(away, least), least);
        if (!any(touch))
            continue;
        store_bits(r->candidate + i, load_bits(r->candidate + i) | bits_where(touch, UINT32_C(1) << k));
        found |= UINT64_C(1) << i / lanes;
    }
    if (found != 0) {
        r->clearance[k] = -SCALAR_MAX;
        return found;
    }
    if (c->shape != SPRING_PLANE)
        least = (1 - 16 * SCALAR_EPSILON) * vec_sqrt(least);
    r->clearance[k] = least_of_lanes(least) - (scalar)rounded_up * (r->way + r->bounds->displacement[k]);
    return 0;
}

static bool find_near_colliders(candidate_chunk *r)
{
    for (size_t k = 0; k < r->bounds->count && r->begins; k += lanes)
        vec_store(r->clearance + k, splat(-SCALAR_MAX));
    r->way = longest_way(r);
    r->nearby = reached_on_way(r, r->way);
    r->listed = 0;
    if (r->nearby == 0)
        return false;
    const uint32_t all_but_one = r->nearby & (r->nearby - 1);
    if ((all_but_one & (all_but_one - 1)) != 0) /* a box costs about as much as two colliders */
        compare_boxes(r);
    uint64_t found = 0;
    memset(r->candidate, 0, sizeof r->candidate);
    for (unsigned k = 0; k < r->bounds->count; k++)
        if ((r->nearby >> k & 1) != 0)
            found |= find_candidates(r, k);
    for (size_t i = 0; found != 0; i += lanes, found >>= 1)
        for (size_t j = i; j < i + lanes && (found & 1) != 0; j++) {
            r->list[r->listed] = (uint8_t)j;
            r->listed += r->candidate[j] != 0;
        }
    return r->listed > 0;
}

#endif
