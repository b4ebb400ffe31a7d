/* SPDX-License-Identifier: MIT */
/*
 * Weighted links that are not in bands: their forces, one after another in their order, and how they are read and set.
 * quad_weighted() of kernels/unbanded_tmpl.h has the same operations for linear links of scenes with records.
 *
 * Law       F_i = -w_i p,  p = d (k (1 - rest/|d|) + c (d . d')/|d|^2),  d = sum of w_i x_i. For rest length 0 and on one
 *           axis p is linear: k d + c d', or k (d - rest) + c d'. The force on the first particle is minus the sum of
 *           the others, so momentum is conserved to rounding error.
 * Kick      In an exponential kick, d is the direction that is frozen. The damping of a linear link acts in all
 *           directions, and has no turning term.
 */
#include "../kernels/link_law.h"
#include "../spring/roots.h"
#include "pass.h"
#include "weighted_links.h"

/* The sum of weight (x - x of the first particle) on an axis. */
SPRING_INLINE scalar weighted_sum(const stored_weighted *l, const scalar *x, int points)
{
    const scalar first = x[l->particle[0]];
    scalar sum = l->weight[1] * (x[l->particle[1]] - first);
    SPRING_ROLLED
    for (int i = 2; i < points; i++)
        sum += l->weight[i] * (x[l->particle[i]] - first);
    return sum;
}

/* Adds the forces of a link on an axis. */
SPRING_INLINE void add_pull(const stored_weighted *l, scalar pull, scalar *force, int points)
{
    scalar sum = l->weight[1] * pull;
    force[l->particle[1]] -= sum;
    SPRING_ROLLED
    for (int i = 2; i < points; i++) {
        const scalar part = l->weight[i] * pull;
        force[l->particle[i]] -= part;
        sum += part;
    }
    force[l->particle[0]] += sum;
}

/* The force of a link that has a direction, divided by its vector d. See all_unbanded(), and all_unbanded_freezing(). */
static scalar force_by_vector(const scene_links *s, stored_weighted *l, const scalar relative[3], const scalar d[3])
{
    const bool frozen = s->terms == FREEZING_TERMS;
    const scalar damping = s->terms == STIFFNESS_TERM ? 0 : frozen ? l->root * l->root : l->damping;
    scalar square = 0, rate = 0, speed_square = 0, scale = 0;
    for (uint32_t a = 0; a < s->axes; a++) {
        square += d[a] * d[a];
        rate += d[a] * relative[a];
        speed_square += relative[a] * relative[a];
    }
    if (s->terms == DAMPING_TERM) {
        scale = l->direction_scale * (l->direction_scale * rate + s->turning_weight * l->turning);
    } else if (!(square == 0)) { /* NaN is detected */
        const scalar inverse = 1 / (scalar)spring_sqrt((double)square);
        scalar slower = 0;
        if (frozen) {
            const scalar root = l->root * inverse;
            slower = turning_rate(s->turning_time, inverse * inverse, speed_square * square - rate * rate);
            l->turning = slower * (2 * root * square);
            l->direction_scale = root;
        }
        scale = l->stiffness * (1 - l->rest * inverse);
        if (damping > 0)
            scale += damping * (rate * (inverse * inverse) - slower);
    } else if (frozen) {
        l->direction_scale = l->turning = 0;
    }
    return scale;
}

/* Rest length 0, or one axis. Axes are independent. */
SPRING_INLINE void add_linear_link(const scene_links *s, const stored_weighted *l, const scalar *x, const scalar *v,
                                   scalar *force, int points)
{
    const scalar rest = s->axes == 1 ? l->rest : 0, stiffness = s->terms == DAMPING_TERM ? 0 : l->stiffness;
    const scalar damping = weighted_damping(s, l);
    SPRING_ROLLED
    for (uint32_t a = 0; a < s->axes; a++) {
        scalar pull = stiffness * (weighted_sum(l, x + a * s->stride, points) - rest);
        if (s->terms != STIFFNESS_TERM)
            pull += damping * weighted_sum(l, v + a * s->stride, points);
        add_pull(l, pull, force + a * s->stride, points);
    }
}

static void add_directed_link(const scene_links *s, stored_weighted *l, const scalar *x, const scalar *v, scalar *force)
{
    scalar d[3], relative[3] = {0};
    for (uint32_t a = 0; a < s->axes; a++) {
        d[a] = weighted_sum(l, x + a * s->stride, l->points);
        if (s->terms != STIFFNESS_TERM)
            relative[a] = weighted_sum(l, v + a * s->stride, l->points);
    }
    const scalar scale = force_by_vector(s, l, relative, d);
    for (uint32_t a = 0; a < s->axes; a++)
        add_pull(l, scale * d[a], force + a * s->stride, l->points);
}

void spring_scene_add_weighted(const scene_links *s, const scalar *x, const scalar *v, scalar *force)
{
    const scene_links own = *s; /* a local copy, so that stores cannot alias its fields */
    for (size_t j = 0; j < own.weighted; j++) {
        stored_weighted *const l = &own.weighted_link[j];
        if (!weighted_acts(l))
            continue;
        if (own.axes > 1 && l->rest > 0)
            add_directed_link(&own, l, x, v, force);
        else if (l->points == 3)
            add_linear_link(&own, l, x, v, force, 3);
        else
            add_linear_link(&own, l, x, v, force, l->points);
    }
}

void spring_scene_weighted_vector(const spring_scene *s, const stored_weighted *l, double d[3])
{
    for (uint32_t a = 0; a < 3; a++) {
        const scalar *const x = a < s->layout.axes ? scene_state(s, SPRING_POSITION, a) : NULL;
        d[a] = 0;
        for (int i = 1; i < l->points && x != NULL; i++)
            d[a] += (double)l->weight[i] * ((double)x[l->particle[i]] - (double)x[l->particle[0]]);
    }
}

#include "../simd/size_begin.h"

/* ------------------------------------------------------------------------------------------------------ get and set */

/* Whether a link may replace a weighted link. */
static bool replaces(const spring_scene *s, const stored_weighted *old, const spring_weighted_link *link)
{
    const spring_weighted_link now = scene_weighted(old);
    bool defined[4] = {false};
    for (int i = 0; i < old->points; i++)
        defined[old->place[i]] = true;
    for (int i = 0; i < 4; i++)
        if (link->weight[i] != 0 && (!defined[i] || link->particle[i] != now.particle[i]))
            return false;
    if (spring_weighted_invalid_field(link, sizeof(scalar)) != NULL)
        return false;
    double inverse[4];
    weighted_inverse_masses(s, link, inverse);
    return spring_weighted_overflows(link, sizeof(scalar), inverse) == NULL;
}

spring_status spring_scene_set_weighted_links(spring_scene *s, size_t first, size_t count,
                                              const spring_weighted_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if (!scene_is_editable(s))
        return SPRING_EDISABLED;
    if (first > s->layout.weighted || count > s->layout.weighted - first)
        return SPRING_ERANGE;
    stored_weighted *const all = scene_memory(s, ARRAY_WEIGHTED);
    for (size_t i = 0; i < count; i++)
        if (!replaces(s, &all[first + i], &link[i]))
            return SPRING_EINVAL;
    for (size_t i = 0; i < count; i++) {
        stored_weighted *const to = &all[first + i];
        scene_count_weighted(s, to, false);
        scene_write_weighted(s, to, &link[i]);
        scene_count_weighted(s, to, true);
    }
    if (count > 0) {
        s->bounds_known = false;
        scene_drop_forces(s);
    }
    return SPRING_OK;
}

spring_status spring_scene_get_weighted_link(const spring_scene *s, size_t index, spring_weighted_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if (index >= s->layout.weighted)
        return SPRING_ERANGE;
    const stored_weighted *const all = scene_read(s, ARRAY_WEIGHTED);
    *link = scene_weighted(&all[index]);
    return SPRING_OK;
}

#include "../simd/size_end.h"
