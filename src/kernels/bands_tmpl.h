/* SPDX-License-Identifier: MIT */
/*
 * The forces of bands: links with a constant index offset between their ends, as in a rope, a sheet or a block.
 *
 * Method    For each tile of slots, the forces of every band on the lower ends are computed and stored. The force on a
 *           particle is the sum of the forces of the links whose lower end it is, minus the forces of the links whose
 *           upper end it is. The latter are `offset` slots back, so a band has a ring buffer of its last offset + tile
 *           forces. Each link is computed once, and no force is scattered. Both ends get the same bits, so momentum is
 *           conserved to rounding error. The order of additions does not depend on the vector width. A tile reads no
 *           position and no velocity of earlier tiles, which a fused pass may have advanced already.
 * Law       delta (k (1 - rest/length) + c (relative velocity . delta)/length^2), or 0 if both ends are at one point.
 *           On one axis k (delta - rest) + c (relative velocity). A tension-only link has no force unless it is longer
 *           than its rest length and pulls. A link of rest length 0 is linear: k delta + c (relative velocity).
 *           A three-point link at i, i + offset and i + 2 offset has s = k (x_i - 2 x_mid + x_end), with c and
 *           velocities added likewise; its forces are -s, 2 s and -s.
 * Accuracy  1/length is vec_inverse_sqrt(): 1 ulp, in float 1.5 ulp
 */
#ifndef SPRINGSTEP_BANDS_TMPL_H
#define SPRINGSTEP_BANDS_TMPL_H

#include "../simd/real_tmpl.h"
#include "scene_kernels.h"

/* Vectors of links per iteration, at most: their square roots overlap. A link on one axis has no root and few
   operations, so more vectors amortise the loop (measured for vectors of 16 and 64 bytes). */
enum { most_together = 4 };

SPRING_INLINE size_t links_together(uint32_t axes)
{
    return axes == 1 && SPRING_VECTOR != 32 ? 4 : 2;
}

/* Replaces `delta`, the vectors from lower to upper ends, by the forces on the lower ends. Slots without a link are set
   to 0 by selection, not by multiplication, because their particles may be infinitely far apart. */
SPRING_INLINE void to_forces(uint32_t axes, real (*delta)[3], real (*relative)[3], const lane_mask *joined,
                             const real *k, const real *rest, const real *c, bool damped, bool tension_only)
{
    const size_t together = links_together(axes);
    real scale[most_together]; /* the squared length, then 1/length, then force/length */
    real rate[most_together];
    lane_mask acts[most_together]; /* lanes whose link has a force */
    SPRING_UNROLL
    for (size_t m = 0; m < together; m++) {
        real square = delta[m][0] * delta[m][0];
        rate[m] = damped ? delta[m][0] * relative[m][0] : splat(0);
        SPRING_UNROLL
        for (uint32_t a = 1; a < axes; a++) {
            square += delta[m][a] * delta[m][a];
            if (damped)
                rate[m] += delta[m][a] * relative[m][a];
        }
        scale[m] = square;
    }
    vec_inverse_sqrt(scale, joined, (int)together);
    SPRING_UNROLL
    for (size_t m = 0; m < together; m++) {
        const real inverse = scale[m];
        const real stretch = 1 - (tension_only ? vec_abs(rest[m]) : rest[m]) * inverse;
        scale[m] = k[m] * stretch;
        if (damped)
            scale[m] += c[m] * (rate[m] * inverse * inverse);
        acts[m] = joined[m];
        if (tension_only) { /* NaN remains, so that it is detected */
            const lane_mask pulls = rest[m] < 0;
            scale[m] = select_real(pulls, vec_not_negative(scale[m]), scale[m]);
            if (damped)
                acts[m] &= not_mask(pulls & (stretch <= 0));
        }
    }
    SPRING_UNROLL
    for (size_t m = 0; m < together; m++) {
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++)
            delta[m][a] = select_real(acts[m], scale[m] * delta[m][a], splat(0));
    }
}

/* On one axis a link is a linear spring. */
SPRING_INLINE void to_linear_forces(real (*delta)[3], real (*relative)[3], const lane_mask *joined, const real *k,
                                    const real *rest, const real *c, bool damped)
{
    SPRING_UNROLL
    for (size_t m = 0; m < links_together(1); m++) {
        const real pull = k[m] * (delta[m][0] - rest[m]);
        delta[m][0] = select_real(joined[m], damped ? pull + c[m] * relative[m][0] : pull, splat(0));
    }
}

SPRING_NOINLINE void clear_slots(scalar *force, size_t axis, size_t slots, uint32_t axes)
{
    for (uint32_t a = 0; a < axes; a++)
        for (size_t j = 0; j < slots; j += lanes)
            vec_store(force + a * axis + j, splat(0));
}

/* Computes the forces of a band on `slots` particles from t on, the lower ends of its links. Forces along axis a are
   stored at force + a * axis. Slots after the last vector that has links keep their content. */
typedef void tile_kernel(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v, ptrdiff_t t,
                         size_t slots, scalar *force, size_t axis);

/* See tile_kernel. shared: all slots have the same coefficients; a constant, so that the compiler keeps them in
   registers. */
SPRING_INLINE void tile_forces(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                               ptrdiff_t t, size_t slots, scalar *force, size_t axis, uint32_t axes, bool damped,
                               bool shared)
{
    const size_t stride = s->stride;
    const bool tension_only = axes > 1 && s->tension_only;
    const ptrdiff_t offset = band->offset, slot = t - band->start;
    const int8_t *const occupied = band->occupied + slot;
    const ptrdiff_t stride_c = shared ? 0 : band->coefficient_stride;
    const scalar *const stiffness = band->stiffness + slot * stride_c,
                        *const rest_length = band->rest + slot * stride_c,
                        *const damping = damped ? band->damping + slot * stride_c : NULL;
    SPRING_PREFETCH(occupied + tile); /* too few cache lines for the hardware prefetcher to detect a stream */
    const size_t left = (size_t)(band->end - t), count = left < slots ? left : slots;
    const size_t together = links_together(axes);
    for (size_t j = 0; j < count; j += together * lanes) {
        real delta[most_together][3], relative[most_together][3];
        real k[most_together], rest[most_together], c[most_together];
        lane_mask joined[most_together];
        SPRING_UNROLL
        for (size_t m = 0; m < together; m++) {
            const size_t i = j + m * lanes;
            const ptrdiff_t number = (ptrdiff_t)i * stride_c;
            k[m] = vec_load(stiffness + number);
            rest[m] = vec_load(rest_length + number);
            c[m] = damped ? vec_load(damping + number) : splat(0);
            joined[m] = vec_load_mask(occupied + i);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                const scalar *const at = x + a * stride + t + i, *const with = v + a * stride + t + i;
                delta[m][a] = vec_load(at + offset) - vec_load(at);
                relative[m][a] = damped ? vec_load(with + offset) - vec_load(with) : splat(0);
            }
        }
        if (axes == 1)
            to_linear_forces(delta, relative, joined, k, rest, c, damped);
        else
            to_forces(axes, delta, relative, joined, k, rest, c, damped, tension_only);
        SPRING_UNROLL
        for (size_t m = 0; m < together; m++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                vec_store(force + a * axis + j + m * lanes, delta[m][a]);
        }
    }
}

/* On one axis a link has few operations, so that loads of equal coefficients would matter. */
SPRING_INLINE void linear_tile(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                               ptrdiff_t t, size_t slots, scalar *force, size_t axis, bool damped)
{
    if (band->coefficient_stride == 0 && !SPRING_COMPACT)
        tile_forces(s, band, x, v, t, slots, force, axis, 1, damped, true);
    else
        tile_forces(s, band, x, v, t, slots, force, axis, 1, damped, false);
}

/* Undamped, except in compact kernels, which test it in the loop. */
SPRING_NOINLINE void tile_on_1_axis(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                                    ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    linear_tile(s, band, x, v, t, slots, force, axis, SPRING_COMPACT && s->terms == STIFFNESS_AND_DAMPING_TERM);
}

SPRING_NOINLINE void damped_tile_on_1_axis(const scene_links *s, const scene_band *band, const scalar *x,
                                           const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    linear_tile(s, band, x, v, t, slots, force, axis, true);
}

SPRING_NOINLINE void tile_on_2_axes(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                                    ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_forces(s, band, x, v, t, slots, force, axis, 2, SPRING_COMPACT && s->terms == STIFFNESS_AND_DAMPING_TERM,
                false);
}

SPRING_NOINLINE void damped_tile_on_2_axes(const scene_links *s, const scene_band *band, const scalar *x,
                                           const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_forces(s, band, x, v, t, slots, force, axis, 2, true, false);
}

SPRING_NOINLINE void tile_on_3_axes(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                                    ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_forces(s, band, x, v, t, slots, force, axis, 3, SPRING_COMPACT && s->terms == STIFFNESS_AND_DAMPING_TERM,
                false);
}

SPRING_NOINLINE void damped_tile_on_3_axes(const scene_links *s, const scene_band *band, const scalar *x,
                                           const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_forces(s, band, x, v, t, slots, force, axis, 3, true, false);
}

/* Like tile_forces(), for an exponential kick: the rate of a link is lowered by its turning term. Stores the turning
   terms, and the factors by which the vectors between its ends become directions. Two loops, since a processor overlaps
   more iterations of a short loop. */
SPRING_INLINE void tile_freezing_forces(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                                        ptrdiff_t t, size_t slots, scalar *force, size_t axis, uint32_t axes)
{
    const size_t stride = s->stride, left = (size_t)(band->end - t), count = left < slots ? left : slots;
    const ptrdiff_t offset = band->offset, slot = t - band->start, stride_c = band->coefficient_stride;
    const int8_t *const occupied = band->occupied + slot;
    const scalar *const stiffness = band->stiffness + slot * stride_c;
    const scalar *const rest_length = band->rest + slot * stride_c;
    scalar *const scales = band->direction_scale + slot, *const turnings = scales + s->turning_offset;
    const scalar *const roots = scales + s->root_offset;
    const scalar span = s->turning_time, inverse_span = 1 / (2 * span);
    const size_t together = links_together(axes);
    size_t j = 0;
    for (; j < count; j += together * lanes) {
        real inverse[most_together];
        lane_mask joined[most_together];
        SPRING_UNROLL
        for (size_t m = 0; m < together; m++) {
            joined[m] = vec_load_mask(occupied + j + m * lanes);
            inverse[m] = splat(0);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                const scalar *const at = x + a * stride + t + j + m * lanes;
                const real delta = vec_load(at + offset) - vec_load(at);
                inverse[m] += delta * delta;
            }
        }
        vec_inverse_sqrt(inverse, joined, (int)together);
        SPRING_UNROLL
        for (size_t m = 0; m < together; m++)
            vec_store(scales + j + m * lanes, inverse[m]);
    }
    const size_t end = j;
    for (j = 0; j < end; j += lanes) {
        const ptrdiff_t number = (ptrdiff_t)j * stride_c;
        const real root = vec_not_negative(vec_load(roots + j)), c = root * root, inverse = vec_load(scales + j);
        real delta[3], square = splat(0), rate = splat(0), speed_square = splat(0);
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++) {
            const scalar *const at = x + a * stride + t + j, *const with = v + a * stride + t + j;
            const real relative = vec_load(with + offset) - vec_load(with);
            delta[a] = vec_load(at + offset) - vec_load(at);
            square += delta[a] * delta[a];
            rate += delta[a] * relative;
            speed_square += relative * relative;
        }
        const real rest = vec_load(rest_length + number), stretch = 1 - vec_abs(rest) * inverse;
        lane_mask acts = vec_load_mask(occupied + j);
        acts &= not_mask((rest < 0) & (stretch <= 0));
        const real inverse_square = inverse * inverse, unit = root * inverse;
        real scale = vec_load(stiffness + number) * stretch + c * (rate * inverse_square);
        if (span > 0) {
            const real across = vec_not_negative(speed_square * square - rate * rate); /* |delta x relative|^2 */
            const real angle = span * inverse_square, turned = vec_min(angle * angle * across, splat(1));
            const real turning = (turned + turned * turned * ((scalar)0.25 + (scalar)0.125 * turned)) * inverse_span;
            vec_store(turnings + j, select_real(acts, turning * (2 * unit * square), splat(0)));
            scale -= c * turning;
        }
        vec_store(scales + j, select_real(acts, unit, splat(0)));
        SPRING_UNROLL
        for (uint32_t a = 0; a < axes; a++)
            vec_store(force + a * axis + j, select_real(acts, scale * delta[a], splat(0)));
    }
}

/* On one axis, the factors are the roots. As many slots as damping tiles read are stored. */
SPRING_NOINLINE void freezing_tile_on_1_axis(const scene_links *s, const scene_band *band, const scalar *x,
                                             const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    (void)axis;
    const ptrdiff_t offset = band->offset, slot = t - band->start, stride_c = band->coefficient_stride;
    const size_t left = (size_t)(band->end - t), count = left < slots ? left : slots;
    const size_t together = links_together(1) * lanes;
    for (size_t j = 0; j < (count + together - 1) / together * together; j += lanes) {
        const ptrdiff_t i = slot + (ptrdiff_t)j;
        const lane_mask joined = vec_load_mask(band->occupied + i);
        const real k = vec_load(band->stiffness + i * stride_c), rest = vec_load(band->rest + i * stride_c);
        const real root = vec_load(band->direction_scale + s->root_offset + i);
        const scalar *const at = x + t + j, *const with = v + t + j;
        const real delta = vec_load(at + offset) - vec_load(at), relative = vec_load(with + offset) - vec_load(with);
        vec_store(band->direction_scale + i, select_real(joined, root, splat(0)));
        vec_store(force + j, select_real(joined, k * (delta - rest) + root * root * relative, splat(0)));
    }
}

SPRING_NOINLINE void freezing_tile_on_2_axes(const scene_links *s, const scene_band *band, const scalar *x,
                                             const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_freezing_forces(s, band, x, v, t, slots, force, axis, 2);
}

SPRING_NOINLINE void freezing_tile_on_3_axes(const scene_links *s, const scene_band *band, const scalar *x,
                                             const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_freezing_forces(s, band, x, v, t, slots, force, axis, 3);
}

/* Like tile_forces(), for damping alone along stored directions d: the force is d (d . relative velocity + turning).
   On one axis d is direction_scale, otherwise this times the vector between the ends. */
SPRING_INLINE void tile_damping_forces(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                                       ptrdiff_t t, size_t slots, scalar *force, size_t axis, uint32_t axes)
{
    const size_t stride = s->stride, left = (size_t)(band->end - t), count = left < slots ? left : slots;
    const ptrdiff_t offset = band->offset;
    const scalar *const scales = band->direction_scale + (t - band->start);
    const scalar *const turnings = scales + s->turning_offset;
    const int8_t *const occupied = band->occupied + (t - band->start);
    const scalar weight = axes > 1 ? s->turning_weight : 0;
    const size_t together = links_together(axes);
    for (size_t j = 0; j < count; j += together * lanes) {
        SPRING_UNROLL
        for (size_t m = 0; m < together; m++) {
            const size_t i = j + m * lanes;
            const real scale = vec_load(scales + i);
            const lane_mask joined = vec_load_mask(occupied + i); /* 0 times an infinite distance would be NaN */
            real delta[3], rate = splat(0);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++) {
                const scalar *const at = x + a * stride + t + i, *const with = v + a * stride + t + i;
                const real relative = vec_load(with + offset) - vec_load(with);
                delta[a] = axes > 1 ? vec_load(at + offset) - vec_load(at) : splat(1);
                rate += axes > 1 ? delta[a] * relative : relative;
            }
            rate *= scale;
            if (weight != 0)
                rate += weight * vec_load(turnings + i);
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                vec_store(force + a * axis + i, select_real(joined, scale * rate * delta[a], splat(0)));
        }
    }
}

SPRING_NOINLINE void damping_tile_on_1_axis(const scene_links *s, const scene_band *band, const scalar *x,
                                            const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_damping_forces(s, band, x, v, t, slots, force, axis, 1);
}

SPRING_NOINLINE void damping_tile_on_2_axes(const scene_links *s, const scene_band *band, const scalar *x,
                                            const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_damping_forces(s, band, x, v, t, slots, force, axis, 2);
}

SPRING_NOINLINE void damping_tile_on_3_axes(const scene_links *s, const scene_band *band, const scalar *x,
                                            const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    tile_damping_forces(s, band, x, v, t, slots, force, axis, 3);
}

/* Replaces the forces of links of rest length 0, which are linear and damped in all directions. Of these, other kernels
   damp only the motion along the link and, in an exponential kick, none, since their roots are negative. */
SPRING_NOINLINE void replace_linear_forces(const scene_links *s, const scene_band *band, const scalar *x,
                                           const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    const size_t left = (size_t)(band->end - t), count = left < slots ? left : slots;
    const ptrdiff_t offset = band->offset, slot = t - band->start, stride_c = band->coefficient_stride;
    const bool frozen = s->terms == FREEZING_TERMS || s->terms == DAMPING_TERM;
    for (size_t j = 0; j < count; j += lanes) {
        const ptrdiff_t i = slot + (ptrdiff_t)j, number = i * stride_c;
        const lane_mask joined = vec_load_mask(band->occupied + i);
        const real rest = vec_load(band->rest + number);
        const real k = s->terms == DAMPING_TERM ? splat(0) : vec_load(band->stiffness + number);
        real c = frozen ? vec_load(band->direction_scale + s->root_offset + i) : vec_load(band->damping + number);
        if (frozen)
            c *= c;
        SPRING_ROLLED
        for (uint32_t a = 0; a < s->axes; a++) {
            const scalar *const at = x + a * s->stride + t + j, *const with = v + a * s->stride + t + j;
            const real pull =
                k * (vec_load(at + offset) - vec_load(at)) + c * (vec_load(with + offset) - vec_load(with));
            scalar *const to = force + a * axis + j;
            vec_store(to, select_real(joined, select_real(rest == 0, pull, vec_load(to)), splat(0)));
        }
    }
}

/* The second difference of three numbers that are `offset` apart. */
SPRING_INLINE real second_difference(const scalar *at, ptrdiff_t offset)
{
    const real middle = vec_load(at + offset);
    return (vec_load(at) - middle) + (vec_load(at + 2 * offset) - middle);
}

/* A tile_kernel for three-point links. Axes are independent. */
SPRING_INLINE void three_point_tile(const scene_links *s, const scene_band *band, const scalar *x, const scalar *v,
                                    ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    const size_t left = (size_t)(band->end - t), count = left < slots ? left : slots, stride = s->stride;
    const uint32_t axes = s->axes;
    const ptrdiff_t offset = band->offset, slot = t - band->start;
    const bool stiff = s->terms != DAMPING_TERM, damped = s->terms != STIFFNESS_TERM;
    const scalar *const root =
        s->terms > STIFFNESS_AND_DAMPING_TERM ? band->direction_scale + s->root_offset + slot : NULL;
    const scalar *const stiffness = band->stiffness + slot;
    const scalar *const damping = damped && root == NULL ? band->damping + slot : root;
    const int8_t *const occupied = band->occupied + slot;
    for (size_t j = 0; j < count && stiff; j += lanes) {
        const lane_mask joined = vec_load_mask(occupied + j);
        const real k = vec_load(stiffness + j);
        const scalar *at = x + t + j;
        scalar *to = force + j;
        SPRING_ROLLED
        for (uint32_t a = 0; a < axes; a++, at += stride, to += axis)
            vec_store(to, select_real(joined, k * second_difference(at, offset), splat(0)));
    }
    for (size_t j = 0; j < count && damped; j += lanes) {
        const lane_mask joined = vec_load_mask(occupied + j);
        const real r = vec_load(damping + j), c = root != NULL ? r * r : r;
        SPRING_ROLLED
        for (uint32_t a = 0; a < axes; a++) {
            const real pull = c * second_difference(v + a * stride + t + j, offset);
            scalar *const to = force + a * axis + j;
            vec_store(to, select_real(joined, stiff ? vec_load(to) + pull : pull, splat(0)));
        }
    }
}

/* Forces to be added to the particles of a tile, or subtracted. Forces along axis a are at force + a * axis. */
typedef struct kept_forces {
    const scalar *force;
    size_t axis;
} kept_forces;

/* Sets `to` to the sum of the forces of all bands on `count` particles. */
typedef void gather_kernel(scalar *to, size_t stride, size_t count, const kept_forces *plus, size_t pluses,
                           const kept_forces *minus, size_t minuses);

SPRING_INLINE void gather(scalar *to, size_t stride, size_t count, const kept_forces *plus, size_t pluses,
                          const kept_forces *minus, size_t minuses, uint32_t axes)
{
    enum { most = 4 };
    const size_t some = axes == 1 && SPRING_VECTOR == 16 ? most : 2; /* vectors per iteration */
    for (size_t j = 0; j < count; j += some * lanes) {
        real force[most][3];
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                force[m][a] = splat(0);
        }
        for (const kept_forces *k = plus; k < plus + pluses; k++) {
            SPRING_UNROLL
            for (size_t m = 0; m < some; m++) {
                SPRING_UNROLL
                for (uint32_t a = 0; a < axes; a++)
                    force[m][a] += vec_load(k->force + a * k->axis + j + m * lanes);
            }
        }
        for (const kept_forces *k = minus; k < minus + minuses; k++) {
            SPRING_UNROLL
            for (size_t m = 0; m < some; m++) {
                SPRING_UNROLL
                for (uint32_t a = 0; a < axes; a++)
                    force[m][a] -= vec_load(k->force + a * k->axis + j + m * lanes);
            }
        }
        SPRING_UNROLL
        for (size_t m = 0; m < some; m++) {
            SPRING_UNROLL
            for (uint32_t a = 0; a < axes; a++)
                vec_store(to + a * stride + j + m * lanes, force[m][a]);
        }
    }
}

SPRING_INLINE void gather_on_1_axis(scalar *to, size_t stride, size_t count, const kept_forces *plus, size_t pluses,
                                    const kept_forces *minus, size_t minuses)
{
    gather(to, stride, count, plus, pluses, minus, minuses, 1);
}

SPRING_NOINLINE void gather_on_2_axes(scalar *to, size_t stride, size_t count, const kept_forces *plus, size_t pluses,
                                      const kept_forces *minus, size_t minuses)
{
    gather(to, stride, count, plus, pluses, minus, minuses, 2);
}

SPRING_NOINLINE void gather_on_3_axes(scalar *to, size_t stride, size_t count, const kept_forces *plus, size_t pluses,
                                      const kept_forces *minus, size_t minuses)
{
    gather(to, stride, count, plus, pluses, minus, minuses, 3);
}

/* Copies the first tile of a ring behind its last tile, so that any `tile` consecutive slots are contiguous. */
typedef void repeat_kernel(scalar *force, ptrdiff_t ring, size_t slots, size_t axis, uint32_t axes);

SPRING_INLINE void inlined_repeat_tile(scalar *force, ptrdiff_t ring, size_t slots, size_t axis, uint32_t axes)
{
    for (uint32_t a = 0; a < axes; a++)
        for (size_t j = 0; j < slots; j += lanes)
            vec_store(force + a * axis + ring + j, vec_load(force + a * axis + j));
}

SPRING_NOINLINE void repeat_tile(scalar *force, ptrdiff_t ring, size_t slots, size_t axis, uint32_t axes)
{
    inlined_repeat_tile(force, ring, slots, axis, axes);
}

/* The place in the ring of a band that is `offset` before a place. */
SPRING_INLINE ptrdiff_t place_before(const scene_band *band, ptrdiff_t place)
{
    return place < band->back ? place - band->back + band->ring : place - band->back;
}

/* ---------------------------------------------------------------------------------------------- three-point links */

/* Whether links of a band whose lower ends are `distance` before a tile at t act on it. */
SPRING_INLINE bool reaches(const scene_band *band, ptrdiff_t distance, ptrdiff_t t)
{
    return t < band->end + distance && t + tile > band->start + distance;
}

/* Adds 2 middle - low - high to the forces on a tile. NULL: no link of the band acts there */
SPRING_INLINE void add_triple(scalar *to, size_t stride, size_t count, uint32_t axes, const scalar *low,
                              const scalar *middle, const scalar *high, size_t axis)
{
    const bool whole = low != NULL && middle != NULL && high != NULL;
    for (uint32_t a = 0; a < axes; a++)
        for (size_t j = 0; j < count; j += lanes) {
            const size_t i = a * axis + j;
            real sum = vec_load(to + a * stride + j);
            if (whole) {
                sum += 2 * vec_load(middle + i) - (vec_load(low + i) + vec_load(high + i));
            } else {
                sum -= low != NULL ? vec_load(low + i) : splat(0);
                sum += middle != NULL ? 2 * vec_load(middle + i) : splat(0);
                sum -= high != NULL ? vec_load(high + i) : splat(0);
            }
            vec_store(to + a * stride + j, sum);
        }
}

/* Adds the forces of the bands of three-point links on a tile. Their rings are used as in for_each_tile(). */
SPRING_NOINLINE void add_three_point_bands(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out,
                                           ptrdiff_t t, size_t count)
{
    for (const scene_band *band = s->band + s->bands; band < s->band + s->all_bands; band++) {
        const ptrdiff_t ring = band->ring, place = t % ring;
        const ptrdiff_t end = (band->end + (ptrdiff_t)lanes - 1) / (ptrdiff_t)lanes * (ptrdiff_t)lanes;
        const size_t axis = (size_t)(ring + tile);
        scalar *const kept = out->rings + band->ring_start, *const low = kept + place;
        const bool has_low = t >= band->start && t < band->end;
        if (t == 0) /* no link has a lower end before the first particle */
            clear_slots(kept + ring - tile, axis, tile, s->axes);
        if ((t == band->start - tile || t + (ptrdiff_t)count > end) && t < end + tile)
            clear_slots(low, axis, count, s->axes);
        if (has_low)
            three_point_tile(s, band, x, v, t, count, low, axis);
        if (place == 0)
            inlined_repeat_tile(low, ring, count, axis, s->axes);
        const ptrdiff_t middle = place_before(band, place), high = place_before(band, middle);
        add_triple(out->force + t, s->stride, count, s->axes, has_low ? low : NULL,
                   reaches(band, band->offset, t) ? kept + middle : NULL,
                   reaches(band, 2 * band->offset, t) ? kept + high : NULL, axis);
    }
}

/* See band_kernel. The rings contain the forces of earlier links. `t` is the first particle of a tile, place[r] its
   place in ring r, `axis` the stride between the axes of a ring, and `end` the end of the vectors that have links. */
SPRING_INLINE void for_each_tile(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out, size_t from,
                                 size_t to, uint32_t axes, tile_kernel *forces, repeat_kernel *repeat,
                                 gather_kernel *sum)
{
    ptrdiff_t place[most_bands]; /* of the tile, in each ring */
    for (size_t r = 0; r < s->bands; r++) {
        const scene_band *band = &s->band[r];
        place[r] = (ptrdiff_t)from % band->ring;
        if (from == 0) { /* no link has a lower end before the first particle */
            const size_t before = (size_t)(band->offset < tile ? (band->offset + lanes - 1) / lanes * lanes : tile);
            clear_slots(out->rings + band->ring_start + band->ring - before, (size_t)(band->ring + tile), before, axes);
        }
    }
    for (ptrdiff_t t = (ptrdiff_t)from; t < (ptrdiff_t)to; t += tile) {
        kept_forces plus[most_bands], minus[most_bands];
        size_t pluses = 0, minuses = 0;
        const size_t left = s->particles - (size_t)t, count = left < tile ? left : tile;
        for (size_t r = 0; r < s->bands; r++) {
            const scene_band *band = &s->band[r];
            const ptrdiff_t ring = band->ring;
            const size_t axis = (size_t)(ring + tile);
            scalar *const kept = out->rings + band->ring_start, *const force = kept + place[r];
            const ptrdiff_t end = (band->end + (ptrdiff_t)lanes - 1) / (ptrdiff_t)lanes * (ptrdiff_t)lanes;
            if ((t == band->start - tile || t + (ptrdiff_t)count > end) && t < end + tile)
                clear_slots(force, axis, count, axes); /* upper ends of links may read slots without links */
            if (t >= band->start && t < band->end) {
                forces(s, band, x, v, t, count, force, axis);
                if (axes > 1 && s->isotropic)
                    replace_linear_forces(s, band, x, v, t, count, force, axis);
                plus[pluses++] = (kept_forces){force, axis};
            }
            if (place[r] == 0)
                repeat(force, ring, count, axis, axes);
            if (t < band->end + band->offset && t + tile > band->start + band->offset)
                minus[minuses++] = (kept_forces){kept + place_before(band, place[r]), axis};
            place[r] = place[r] + tile < ring ? place[r] + tile : 0;
        }
        sum(out->force + t, s->stride, count, plus, pluses, minus, minuses);
        if (s->all_bands > s->bands)
            add_three_point_bands(s, x, v, out, t, count);
    }
}

/* A loop of its own for one axis. Its links have few operations: with vectors of 64 bytes, calls of a tile_kernel and a
   gather_kernel for each tile would take an eighth of the time in double and a fifth in float. */
SPRING_INLINE void inlined_tile_on_1_axis(const scene_links *s, const scene_band *band, const scalar *x,
                                          const scalar *v, ptrdiff_t t, size_t slots, scalar *force, size_t axis)
{
    if (s->terms == STIFFNESS_TERM)
        linear_tile(s, band, x, v, t, slots, force, axis, false);
    else if (s->terms == STIFFNESS_AND_DAMPING_TERM)
        linear_tile(s, band, x, v, t, slots, force, axis, true);
    else
        (s->terms == FREEZING_TERMS ? freezing_tile_on_1_axis : damping_tile_on_1_axis)(s, band, x, v, t, slots, force,
                                                                                        axis);
}

SPRING_NOINLINE void inlined_forces_on_1_axis(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out,
                                              size_t from, size_t to)
{
    for_each_tile(s, x, v, out, from, to, 1, inlined_tile_on_1_axis, inlined_repeat_tile, gather_on_1_axis);
}

static void compute_band_forces(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out, size_t from,
                                size_t to)
{
    enum { inlined = SPRING_VECTOR == 64 }; /* on one axis */
    static tile_kernel *const undamped[] = {inlined ? NULL : tile_on_1_axis, tile_on_2_axes, tile_on_3_axes};
    static tile_kernel *const damped[] = {inlined ? NULL : damped_tile_on_1_axis, damped_tile_on_2_axes,
                                          damped_tile_on_3_axes};
    static tile_kernel *const freezing[] = {inlined ? NULL : freezing_tile_on_1_axis, freezing_tile_on_2_axes,
                                            freezing_tile_on_3_axes};
    static tile_kernel *const damping[] = {inlined ? NULL : damping_tile_on_1_axis, damping_tile_on_2_axes,
                                           damping_tile_on_3_axes};
    static gather_kernel *const gathers[] = {inlined ? NULL : gather_on_1_axis, gather_on_2_axes, gather_on_3_axes};
    const uint32_t axes = s->axes;
    if (inlined && axes == 1) {
        inlined_forces_on_1_axis(s, x, v, out, from, to);
        return;
    }
    tile_kernel *const forces = s->terms == FREEZING_TERMS                                  ? freezing[axes - 1]
                                : s->terms == DAMPING_TERM                                  ? damping[axes - 1]
                                : s->terms == STIFFNESS_AND_DAMPING_TERM && !SPRING_COMPACT ? damped[axes - 1]
                                                                                            : undamped[axes - 1];
    for_each_tile(s, x, v, out, from, to, axes, forces, repeat_tile, gathers[axes - 1]);
}

#endif
