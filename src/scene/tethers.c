/* SPDX-License-Identifier: MIT */
/*
 * Tethers: for each particle that hangs on pinned particles, a tension-only link to the nearest of them.
 *
 * Method    The distance along links from the nearest pinned particle follows from sweeps over all links, in alternating
 *           directions, until no distance becomes smaller (Bellman, Ford). If the links of a rope or a sheet are sorted,
 *           a sweep carries distances along whole rows, and a few sweeps are enough.
 * Stiffness The stable step follows from row sums of the stiffness matrix (stable_step.c). A tether adds its stiffness
 *           once to the row of its free end. With the fraction f of this row, no row grows by more than 1 + f.
 */
#include "definition.h"

#include <string.h>

#include "../simd/size_begin.h"

static const uint32_t no_pin = UINT32_MAX;

/* For each particle, the nearest pinned particle that links connect it with, and the distance. */
typedef struct hanging {
    double *distance, *row; /* row: sum of stiffness, as in the stable step */
    uint32_t *pin;
    uint32_t *joined; /* whether a link joins it to a pinned particle */
} hanging;

static bool connects(const spring_link *link)
{
    return link->stiffness > 0 && (link->flags & SPRING_LINK_TETHER) == 0;
}

/* Returns whether the way from end `from` of a link shortens the distance of its end `to`. */
static bool shorten(const hanging *h, uint32_t from, uint32_t to, double rest)
{
    const double distance = h->distance[from] + rest;
    if (h->pin[from] == no_pin || h->distance[to] < distance ||
        (h->distance[to] == distance && h->pin[to] <= h->pin[from]))
        return false;
    h->distance[to] = distance;
    h->pin[to] = h->pin[from];
    return true;
}

static void find_distances(const spring_scene_def *def, const hanging *h)
{
    for (uint32_t i = 0; i < def->particles; i++) {
        h->pin[i] = is_pinned(def, i) ? i : no_pin;
        h->distance[i] = is_pinned(def, i) ? 0 : (double)INFINITY;
    }
    bool shorter = true;
    for (bool forwards = true; shorter; forwards = !forwards) {
        shorter = false;
        for (size_t i = 0; i < def->links; i++) {
            const spring_link *link = &def->link[forwards ? i : def->links - 1 - i];
            if (connects(link)) {
                shorter |= shorten(h, link->a, link->b, link->rest);
                shorter |= shorten(h, link->b, link->a, link->rest);
            }
        }
    }
}

static void find_rows(const spring_scene_def *def, const hanging *h)
{
    memset(h->row, 0, def->particles * sizeof *h->row);
    memset(h->joined, 0, def->particles * sizeof *h->joined);
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        h->row[link->a] += link_row(def, link, link->a);
        h->row[link->b] += link_row(def, link, link->b);
        h->joined[link->a] |= connects(link) && is_pinned(def, link->b);
        h->joined[link->b] |= connects(link) && is_pinned(def, link->a);
    }
    for (size_t i = 0; i < def->weighted_links; i++)
        for (int j = 0; j < 4; j++)
            if (def->weighted_link[i].weight[j] != 0)
                h->row[def->weighted_link[i].particle[j]] += weighted_link_row(def, &def->weighted_link[i], j);
}

static bool hangs(const spring_scene_def *def, const hanging *h, size_t i)
{
    return !is_pinned(def, i) && h->pin[i] != no_pin && h->joined[i] == 0;
}

static spring_link tether_of(const hanging *h, uint32_t i, double fraction, double slack)
{
    return (spring_link){.a = i,
                         .b = h->pin[i],
                         .rest = h->distance[i] * (1 + slack),
                         .stiffness = fraction * h->row[i],
                         .flags = SPRING_LINK_TETHER};
}

spring_status spring_definition_tethers(const spring_scene_def *def, size_t precision, double fraction, double slack,
                                        spring_link *out, size_t *count, uint32_t *work, double *distance)
{
    const spring_status status = spring_definition_check(def, precision, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    if (!(fraction > 0 && spring_finite(fraction) && slack >= 0 && spring_finite(slack)) || count == NULL ||
        work == NULL || distance == NULL)
        return SPRING_EINVAL;
    if (axes_of(def) == 1)
        return SPRING_EUNSUPPORTED;
    const hanging h = {distance, distance + def->particles, work, work + def->particles};
    find_distances(def, &h);
    find_rows(def, &h);
    size_t found = 0;
    for (uint32_t i = 0; i < def->particles; i++)
        if (hangs(def, &h, i)) {
            const spring_link link = tether_of(&h, i, fraction, slack);
            if (spring_link_invalid_field(&link, precision) != NULL ||
                spring_link_overflows(&link, precision, inverse_mass_of(def, precision, i), 0) != NULL)
                return SPRING_EINVAL;
            found++;
        }
    const size_t room = *count;
    *count = found;
    if (out == NULL || room < found)
        return out == NULL ? SPRING_OK : SPRING_ENOMEM;
    for (uint32_t i = 0; i < def->particles; i++)
        if (hangs(def, &h, i))
            *out++ = tether_of(&h, i, fraction, slack);
    return SPRING_OK;
}

#include "../simd/size_end.h"
