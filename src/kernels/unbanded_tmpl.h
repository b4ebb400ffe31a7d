/* SPDX-License-Identifier: MIT */
/*
 * The forces of unbanded links, one after another in their order. The axes of a particle are side by side in a quad.
 *
 * Law       see bands_tmpl.h
 * Accuracy  the square root and the quotient rest/length are correctly rounded
 */
#ifndef SPRINGSTEP_UNBANDED_TMPL_H
#define SPRINGSTEP_UNBANDED_TMPL_H

#include "../simd/quad_tmpl.h"
#include "link_law.h"
#include "bands_tmpl.h"

/* The force of a link divided by the vector between its ends. rate: relative velocity . delta */
SPRING_INLINE scalar link_scale(const unbanded_links *l, size_t j, scalar square, scalar rate, bool damped)
{
    const bool pulls = l->rest[j] < 0;
    const scalar rest = pulls ? -l->rest[j] : l->rest[j];
    const scalar stretch = 1 - rest / scalar_sqrt(square), pull = l->stiffness[j] * stretch;
    const scalar scale = damped ? pull + l->damping[j] * (rate / square) : pull;
    return pulls && (stretch <= 0 || scale <= 0) ? 0 : scale; /* NaN is not slack, so that it is detected */
}

/* A cut link has no force, however far apart its ends are. */
SPRING_INLINE bool link_acts(const unbanded_links *l, size_t j, bool damped)
{
    return l->stiffness[j] > 0 || (damped && l->damping[j] > 0);
}

/* Compact kernels and WebAssembly do not have a copy of the loops for each number of axes. clang warns of such a loop. */
#if SPRING_COMPACT || defined(__wasm__)
#define COPY_PER_AXES 0
#define UNROLL_AXES
#else
#define COPY_PER_AXES 1
#define UNROLL_AXES   SPRING_UNROLL
#endif

/* Quantities have an array for each axis. */
SPRING_INLINE void all_unbanded(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out,
                                uint32_t axes, bool damped)
{
    const unbanded_links *const l = &s->unbanded;
    for (size_t j = 0; j < l->count; j++) {
        const size_t from = l->a[j], to = l->b[j];
        scalar delta[3] = {0}, scale = 1, square = 0, rate = 0;
        UNROLL_AXES
        for (uint32_t a = 0; a < axes; a++) {
            delta[a] = x[a * s->stride + to] - x[a * s->stride + from];
            square += delta[a] * delta[a];
            if (damped)
                rate += delta[a] * (v[a * s->stride + to] - v[a * s->stride + from]);
        }
        const bool linear = axes == 1 || l->rest[j] == 0;
        if (!link_acts(l, j, damped) || (!linear && !(square > 0)))
            continue;
        if (!linear)
            scale = link_scale(l, j, square, rate, damped);
        UNROLL_AXES
        for (uint32_t a = 0; a < axes; a++) {
            if (!linear)
                continue;
            delta[a] = l->stiffness[j] * (axes == 1 ? delta[a] - l->rest[j] : delta[a]);
            if (damped)
                delta[a] += l->damping[j] * (v[a * s->stride + to] - v[a * s->stride + from]);
        }
        UNROLL_AXES
        for (uint32_t a = 0; a < axes; a++) {
            out->force[a * s->stride + from] += scale * delta[a];
            out->force[a * s->stride + to] -= scale * delta[a];
        }
    }
}
#undef UNROLL_AXES

/* Not inlined, since it is called for few links. */
SPRING_NOINLINE void one_quad_link(const unbanded_links *l, size_t j, const scalar *x, const scalar *v, scalar *force,
                                   size_t stride, bool damped)
{
    const bool linear = l->rest[j] == 0;
    const size_t a = stride * l->a[j], b = stride * l->b[j];
    const quad delta = quad_minus(quad_load(x + b), quad_load(x + a));
    const quad relative = damped ? quad_minus(quad_load(v + b), quad_load(v + a)) : quad_all(0);
    const scalar square = quad_dot(delta, delta);
    if (!link_acts(l, j, damped) || (!linear && !(square > 0)))
        return;
    const scalar scale = linear ? l->stiffness[j] : link_scale(l, j, square, quad_dot(delta, relative), damped);
    quad pull = quad_times(quad_all(scale), delta);
    if (linear && damped)
        pull = quad_plus(pull, quad_times(quad_all(l->damping[j]), relative));
    quad_store(force + a, quad_plus(quad_load(force + a), pull));
    quad_store(force + b, quad_minus(quad_load(force + b), pull));
}

/* Quantities are quads: x, v and force of particle i are at stride * i. Four links share a square root and a quotient.
   */
SPRING_INLINE void quad_links(const scene_links *s, const scalar *x, const scalar *v, scalar *force, size_t stride,
                              bool damped)
{
    const unbanded_links own = s->unbanded, *const l = &own; /* a local copy, so that stores cannot alias its fields */
    const bool tension_only = s->tension_only, isotropic = damped && s->isotropic;
    const size_t ahead = 32; /* [links] prefetch distance, for scenes larger than the cache */
    const size_t some = quad_size, fours = l->count / some * some;
    for (size_t j = 0; j < fours; j += some) {
        if (j + ahead < fours) {
            SPRING_UNROLL
            for (size_t m = 0; m < some; m++) {
                SPRING_PREFETCH(x + stride * l->a[j + ahead + m]);
                SPRING_PREFETCH(x + stride * l->b[j + ahead + m]);
            }
        }
        quad delta[4];
        scalar squares[4], rates[4] = {0};
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            const size_t a = stride * l->a[j + m], b = stride * l->b[j + m];
            delta[m] = quad_minus(quad_load(x + b), quad_load(x + a));
            squares[m] = quad_dot(delta[m], delta[m]);
            if (damped)
                rates[m] = quad_dot(delta[m], quad_minus(quad_load(v + b), quad_load(v + a)));
        }
        const quad square = quad_of(squares[0], squares[1], squares[2], squares[3]);
        const quad signed_rest = quad_load(l->rest + j), rest = tension_only ? quad_abs(signed_rest) : signed_rest;
        const quad stretch = quad_minus(quad_all(1), quad_over(rest, quad_sqrt(square)));
        quad scale = quad_times(quad_load(l->stiffness + j), stretch);
        if (damped)
            scale = quad_plus(scale, quad_times(quad_load(l->damping + j),
                                                quad_over(quad_of(rates[0], rates[1], rates[2], rates[3]), square)));
        const bool linear = isotropic && l->rest[j] * l->rest[j + 1] * l->rest[j + 2] * l->rest[j + 3] == 0;
        /* both ends at one point, or very far apart, or a link of rest length 0 */
        if (SPRING_UNLIKELY(linear || !quad_finite(quad_plus(scale, square)))) {
            for (size_t m = 0; m < some; m++)
                one_quad_link(l, j + m, x, v, force, stride, damped);
            continue;
        }
        if (tension_only)
            scale = quad_zero_where(scale, scale, damped ? stretch : scale, signed_rest);
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            const size_t a = stride * l->a[j + m], b = stride * l->b[j + m];
            const quad pull = quad_times(quad_all(quad_at(scale, (int)m)), delta[m]);
            quad_store(force + a, quad_plus(quad_load(force + a), pull));
            quad_store(force + b, quad_minus(quad_load(force + b), pull));
        }
    }
    for (size_t j = fours; j < l->count; j++)
        one_quad_link(l, j, x, v, force, stride, damped);
}

/* ------------------------------------------------------------------------------------- links of an exponential kick */

/* Like all_unbanded(), with the terms of freezing tiles in bands_tmpl.h. */
SPRING_NOINLINE void all_unbanded_freezing(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out)
{
    const unbanded_links *const l = &s->unbanded;
    for (size_t j = 0; j < l->count; j++) {
        const size_t from = l->a[j], to = l->b[j];
        const scalar root = l->root[j], c = root * root;
        scalar delta[3], relative[3], square = 0, rate = 0, across = 0, scale = 1;
        for (uint32_t a = 0; a < s->axes; a++) {
            relative[a] = v[a * s->stride + to] - v[a * s->stride + from];
            delta[a] = x[a * s->stride + to] - x[a * s->stride + from];
            square += delta[a] * delta[a];
            rate += delta[a] * relative[a];
            across += relative[a] * relative[a];
        }
        l->direction_scale[j] = l->turning[j] = 0;
        if (!link_acts(l, j, true))
            continue;
        if (s->axes == 1 || l->rest[j] == 0) {
            l->direction_scale[j] = root;
            for (uint32_t a = 0; a < s->axes; a++)
                delta[a] = l->stiffness[j] * (s->axes == 1 ? delta[a] - l->rest[j] : delta[a]) + c * relative[a];
        } else {
            const bool pulls = l->rest[j] < 0;
            const scalar rest = pulls ? -l->rest[j] : l->rest[j];
            const scalar inverse = 1 / scalar_sqrt(square), stretch = 1 - rest * inverse;
            if (square == 0 || (pulls && stretch <= 0))
                continue;
            const scalar inverse_square = inverse * inverse;
            const scalar turning = turning_rate(s->turning_time, inverse_square, across * square - rate * rate);
            l->direction_scale[j] = root * inverse;
            l->turning[j] = turning * (2 * (root * inverse) * square);
            scale = l->stiffness[j] * stretch + c * (rate * inverse_square) - c * turning;
        }
        for (uint32_t a = 0; a < s->axes; a++) {
            out->force[a * s->stride + from] += scale * delta[a];
            out->force[a * s->stride + to] -= scale * delta[a];
        }
    }
}

/* Damping alone, as in damping tiles. Quantities have an array for each axis. */
SPRING_INLINE void all_unbanded_damping(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out,
                                        uint32_t axes)
{
    const unbanded_links *const l = &s->unbanded;
    for (size_t j = 0; j < l->count; j++) {
        const size_t from = l->a[j], to = l->b[j];
        const scalar scale = l->direction_scale[j];
        scalar delta[3] = {1}, relative[3], rate = 0;
        for (uint32_t a = 0; a < axes; a++) {
            delta[a] = axes > 1 ? x[a * s->stride + to] - x[a * s->stride + from] : 1;
            relative[a] = v[a * s->stride + to] - v[a * s->stride + from];
            rate += delta[a] * relative[a];
        }
        const scalar pull = scale * (scale * rate + s->turning_weight * l->turning[j]);
        for (uint32_t a = 0; a < axes; a++) {
            const scalar force = scale < 0 ? scale * scale * relative[a] : pull * delta[a];
            out->force[a * s->stride + from] += force;
            out->force[a * s->stride + to] -= force;
        }
    }
}

/* The same with quads, as in quad_links(). */
SPRING_INLINE void quad_damping(const scene_links *s, const scalar *x, const scalar *v, scalar *force, size_t stride)
{
    const unbanded_links own = s->unbanded, *const l = &own;
    const scalar weight = s->turning_weight;
    for (size_t j = 0; j < l->count; j++) {
        const size_t a = stride * l->a[j], b = stride * l->b[j];
        const quad delta = quad_minus(quad_load(x + b), quad_load(x + a));
        const quad relative = quad_minus(quad_load(v + b), quad_load(v + a));
        const scalar scale = l->direction_scale[j], rate = quad_dot(delta, relative);
        const quad pull = scale < 0 ? quad_times(quad_all(scale * scale), relative)
                                    : quad_times(quad_all(scale * (scale * rate + weight * l->turning[j])), delta);
        quad_store(force + a, quad_plus(quad_load(force + a), pull));
        quad_store(force + b, quad_minus(quad_load(force + b), pull));
    }
}

/* Weighted links of rest length 0, with quads: the operations of add_linear_link() in scene/weighted.c. */
SPRING_INLINE void quad_weighted(const scene_links *s, const scalar *x, const scalar *v, scalar *force, size_t stride,
                                 bool damped)
{
    for (size_t j = 0; j < s->weighted; j++) {
        const stored_weighted *const l = &s->weighted_link[j];
        if (!weighted_acts(l))
            continue;
        const size_t first = stride * l->particle[0];
        const quad x_first = quad_load(x + first), v_first = damped ? quad_load(v + first) : quad_all(0);
        quad vector = quad_all(0), rate = vector, sum = vector;
        for (int i = 1; i < l->points; i++) {
            const size_t at = stride * l->particle[i];
            const quad w = quad_all(l->weight[i]), part = quad_times(w, quad_minus(quad_load(x + at), x_first));
            vector = i > 1 ? quad_plus(vector, part) : part;
            if (damped) {
                const quad change = quad_times(w, quad_minus(quad_load(v + at), v_first));
                rate = i > 1 ? quad_plus(rate, change) : change;
            }
        }
        quad pull = quad_times(quad_all(s->terms == DAMPING_TERM ? 0 : l->stiffness), vector);
        if (damped)
            pull = quad_plus(pull, quad_times(quad_all(weighted_damping(s, l)), rate));
        for (int i = 1; i < l->points; i++) {
            scalar *const to = force + stride * l->particle[i];
            const quad part = quad_times(quad_all(l->weight[i]), pull);
            quad_store(to, quad_minus(quad_load(to), part));
            sum = i > 1 ? quad_plus(sum, part) : part;
        }
        quad_store(force + first, quad_plus(quad_load(force + first), sum));
    }
}

/* A record has the position, the velocity (if links are damped) and the force of a particle side by side, for scenes
   with many unbanded or weighted links. */
SPRING_INLINE size_t force_in_record(bool damped)
{
    return (damped ? 2 : 1) * quad_size;
}

SPRING_INLINE void fill_records(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out,
                                uint32_t axes, bool damped)
{
    const size_t at_force = force_in_record(damped), stride = at_force + quad_size;
    for (size_t i = 0; i < s->particles; i++) {
        scalar *record = out->records + stride * i;
        for (size_t k = 0; k < stride; k += quad_size) /* unused numbers are 0 */
            quad_store(record + k, quad_all(0));
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++) {
            record[a] = x[a * s->stride + i];
            if (damped)
                record[quad_size + a] = v[a * s->stride + i];
            record[at_force + a] = s->all_bands > 0 ? out->force[a * s->stride + i] : 0;
        }
    }
}

SPRING_INLINE void forces_of_records(const scene_links *s, scene_forces *out, uint32_t axes, bool damped)
{
    const size_t at_force = force_in_record(damped), stride = at_force + quad_size;
    for (size_t i = 0; i < s->particles; i++) {
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++)
            out->force[a * s->stride + i] = out->records[stride * i + at_force + a];
    }
}

SPRING_INLINE void all_records(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out, bool damped)
{
    const size_t at_force = force_in_record(damped), stride = at_force + quad_size;
    scalar *const records = out->records;
    if (s->axes == 3)
        fill_records(s, x, v, out, 3, damped);
    else
        fill_records(s, x, v, out, 2, damped);
    if (damped && s->terms == DAMPING_TERM)
        quad_damping(s, records, records + quad_size, records + at_force, stride);
    else
        quad_links(s, records, records + quad_size, records + at_force, stride, damped);
    if (!s->nonlinear)
        quad_weighted(s, records, records + quad_size, records + at_force, stride, damped);
    if (s->axes == 3)
        forces_of_records(s, out, 3, damped);
    else
        forces_of_records(s, out, 2, damped);
}

static void compute_record_forces(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out)
{
    if (SPRING_COMPACT)
        all_records(s, x, v, out, s->terms != STIFFNESS_TERM);
    else if (s->terms == STIFFNESS_TERM)
        all_records(s, x, v, out, false);
    else
        all_records(s, x, v, out, true);
}

/* function(..., axes, damped) with both as constants. */
#define SPRING_BY_AXES(axes, damped, function, ...)                                                \
    ((axes) == 1   ? (damped) ? function(__VA_ARGS__, 1, true) : function(__VA_ARGS__, 1, false)   \
       : (axes) == 2 ? (damped) ? function(__VA_ARGS__, 2, true) : function(__VA_ARGS__, 2, false) \
       : (damped) ? function(__VA_ARGS__, 3, true)                                                 \
                   : function(__VA_ARGS__, 3, false))

static void compute_unbanded_forces(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out)
{
    const bool damped = s->terms == STIFFNESS_AND_DAMPING_TERM;
    if (s->all_bands == 0)
        for (uint32_t a = 0; a < s->axes; a++)
            memset(out->force + a * s->stride, 0, s->particles * sizeof *out->force);
    if (s->terms == FREEZING_TERMS)
        all_unbanded_freezing(s, x, v, out);
    else if (s->terms == DAMPING_TERM)
        all_unbanded_damping(s, x, v, out, s->axes);
    else if (!COPY_PER_AXES)
        all_unbanded(s, x, v, out, s->axes, damped);
    else
        SPRING_BY_AXES(s->axes, damped, all_unbanded, s, x, v, out);
}
#undef COPY_PER_AXES

#endif
