/* SPDX-License-Identifier: MIT */
/*
 * Cutting the links of a scene that are longer than a limit.
 *
 * Method    Usually no link tears. So kernels/stretch_tmpl.h first tests whether any link of a band is beyond the least
 *           of all limits. Only if a link may be, all links are tested in double, in the order of their indices.
 */
#include "pass.h"
#include "weighted_links.h"

/* The least limit of a link; NaN if one is negative or NaN. */
static double least_limit(const double *limit, size_t links)
{
    double least = (double)INFINITY;
    bool valid = true;
    for (size_t i = 0; i < links; i++) {
        valid &= limit[i] >= 0;
        least = limit[i] < least ? limit[i] : least;
    }
    return valid ? least : (double)NAN;
}

/* With one axis the length has the sign of the link. */
static double length_of(const spring_scene *s, const spring_link *link)
{
    double delta = 0, square = 0;
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        const scalar *x = scene_state(s, SPRING_POSITION, a);
        delta = (double)x[link->b] - (double)x[link->a];
        square += delta * delta;
    }
    return s->layout.axes == 1 ? delta : spring_sqrt(square);
}

static bool is_longer(const spring_scene *s, const spring_link *link, double stretch)
{
    return (link->stiffness > 0 || link->damping > 0) && link->rest > 0 && length_of(s, link) > stretch * link->rest;
}

static bool any_unbanded_longer(const spring_scene *s, double stretch)
{
    const uint32_t *a = scene_read(s, ARRAY_LINK_A), *b = scene_read(s, ARRAY_LINK_B);
    const scalar *stiffness = scene_read(s, ARRAY_LINK_STIFFNESS), *rest = scene_read(s, ARRAY_LINK_REST);
    const scalar *damping = scene_read(s, ARRAY_LINK_DAMPING);
    for (size_t i = 0; i < s->layout.unbanded; i++) {
        const bool reversed = s->layout.axes == 1 && rest[i] < 0;
        const spring_link link = {.a = reversed ? b[i] : a[i],
                                  .b = reversed ? a[i] : b[i],
                                  .rest = fabs((double)rest[i]),
                                  .stiffness = (double)stiffness[i],
                                  .damping = (double)damping[i]};
        if (is_longer(s, &link, stretch))
            return true;
    }
    return false;
}

/* Returns whether a link may be longer than `stretch` times its rest length; false only if none is. */
static bool any_longer(const scene_kernels *kernels, spring_scene *s, double stretch)
{
    const double largest = 1e9; /* beyond it, (stretch rest)^2 could overflow in the kernel */
    if (stretch == (double)INFINITY)
        return false;
    if (stretch > largest || any_unbanded_longer(s, stretch))
        return true;
    scene_band band[most_bands];
    const scene_links links = scene_prepare_links(s, band);
    return s->layout.bands > 0 &&
           kernels->common->stretched(&links, scene_state(s, SPRING_POSITION, 0), (scalar)stretch);
}

/* Cuts the weighted links that contain both ends of a link. */
static void cut_weighted_links(spring_scene *s, const spring_link *link)
{
    const stored_weighted *const all = scene_read(s, ARRAY_WEIGHTED);
    for (size_t i = 0; i < s->layout.weighted; i++) {
        int ends = 0;
        for (int k = 0; k < all[i].points; k++)
            ends += all[i].particle[k] == link->a || all[i].particle[k] == link->b;
        if (ends < 2)
            continue;
        spring_weighted_link cut = scene_weighted(&all[i]);
        cut.stiffness = cut.damping = 0;
        spring_scene_set_weighted_links(s, i, 1, &cut);
    }
}

spring_status spring_scene_tear_with(const scene_kernels *kernels, spring_scene *s, double stretch, const double *limit,
                                     uint32_t *torn, size_t capacity, size_t *count)
{
    if (s == NULL || (torn == NULL && capacity > 0))
        return SPRING_EINVAL;
    if (!scene_is_editable(s))
        return SPRING_EDISABLED;
    const double least = limit != NULL ? least_limit(limit, s->layout.links) : stretch;
    if (!(least >= 0))
        return SPRING_EINVAL;
    size_t found = 0;
    const size_t links = any_longer(kernels, s, least) ? s->layout.links : 0;
    for (size_t i = 0; i < links; i++) {
        spring_link link;
        spring_scene_get_link(s, i, &link);
        if ((link.flags & SPRING_LINK_TETHER) != 0 || !is_longer(s, &link, limit != NULL ? limit[i] : stretch))
            continue;
        link.stiffness = link.damping = 0;
        scene_replace_link(s, i, &link);
        cut_weighted_links(s, &link);
        if (found < capacity)
            torn[found] = (uint32_t)i;
        found++;
    }
    if (count != NULL)
        *count = found;
    return SPRING_OK;
}

spring_status spring_scene_tear(spring_scene *s, double stretch, const double *limit, uint32_t *torn, size_t capacity,
                                size_t *count)
{
    return spring_scene_tear_with(SPRING_BEST_KERNELS(&spring_scene_v128, &spring_scene_v256, &spring_scene_v512), s,
                                  stretch, limit, torn, capacity, count);
}
