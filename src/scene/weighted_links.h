/* SPDX-License-Identifier: MIT */
/* Reading, checking and writing weighted links. */
#ifndef SPRINGSTEP_WEIGHTED_LINKS_H
#define SPRINGSTEP_WEIGHTED_LINKS_H

#include "stored_links.h"

#include "../simd/size_begin.h"

/* The field of a weighted link that is not valid for any particles and masses; NULL: none. */
static inline const char *weighted_invalid_field(const spring_weighted_link *link)
{
    const double tolerance = 1e-12; /* of the sum, relative to the largest weight: rounding errors of decimal numbers */
    double sum = 0, largest = 0;
    for (int i = 0; i < 4; i++) {
        if (!scene_fits(link->weight[i]))
            return "weighted_link.weight";
        sum += link->weight[i];
        largest = fmax(largest, fabs(link->weight[i]));
    }
    return !(fabs(sum) <= tolerance * largest)    ? "weighted_link.weight"
           : !scene_not_negative(link->rest)      ? "weighted_link.rest"
           : !scene_not_negative(link->stiffness) ? "weighted_link.stiffness"
           : !scene_not_negative(link->damping)   ? "weighted_link.damping"
                                                  : NULL;
}

/* |weight| of a particle times the sum of |weight| over the particles that are not pinned. This times the stiffness
   bounds the row of the stiffness matrix, as 2 stiffness or 1 stiffness does for a link. */
static inline double weighted_row(const double weight[4], const double inverse_mass[4], int i)
{
    double sum = 0;
    for (int j = 0; j < 4; j++)
        sum += inverse_mass[j] > 0 ? fabs(weight[j]) : 0;
    return fabs(weight[i]) * sum;
}

/* The field that is too large for the masses; NULL: none. */
static inline const char *weighted_overflows(const spring_weighted_link *link, const double inverse_mass[4])
{
    for (int i = 0; i < 4; i++) {
        const double row = weighted_row(link->weight, inverse_mass, i);
        if (!scene_fits(link->stiffness * row) || !scene_fits(link->stiffness * row * inverse_mass[i]))
            return "weighted_link.stiffness";
        if (!scene_fits(link->damping * row) || !scene_fits(link->damping * row * inverse_mass[i]))
            return "weighted_link.damping";
    }
    return NULL;
}

/* A link whose weights are (w, -2w, w), at particles with a constant offset, and whose rest length is 0. */
typedef struct three_points {
    uint32_t lower, offset; /* offset: 0 if the link is none */
    double weight;          /* w */
} three_points;

static inline three_points three_points_of(const spring_weighted_link *link)
{
    uint32_t particle[4] = {0};
    double weight[4] = {0};
    int points = 0;
    for (int i = 0; i < 4; i++)
        if (link->weight[i] != 0) {
            particle[points] = link->particle[i];
            weight[points++] = link->weight[i];
        }
    const bool up = particle[1] > particle[0];
    const uint32_t offset = up ? particle[1] - particle[0] : particle[0] - particle[1];
    const bool evenly = up ? particle[2] > particle[1] && particle[2] - particle[1] == offset
                           : particle[1] > particle[2] && particle[1] - particle[2] == offset;
    const bool fits = points == 3 && evenly && weight[0] == weight[2] && weight[1] == -2 * weight[0] && link->rest == 0;
    return (three_points){up ? particle[0] : particle[2], fits ? offset : 0, weight[0]};
}

/* Stores the coefficients of a link in its slot of a band, with 0 if no band computes it. index: that of the slot */
static inline void scene_fill_slot(spring_scene *s, const stored_weighted *l, size_t index)
{
    const double weight = (double)l->weight[1], square = l->banded ? weight * weight : 0;
    scalar *const stiffness = scene_memory(s, ARRAY_BAND_STIFFNESS);
    scalar *const damping = scene_memory(s, ARRAY_BAND_DAMPING);
    int8_t *const occupied = scene_memory(s, ARRAY_OCCUPIED);
    stiffness[index] = (scalar)((double)l->stiffness * square);
    if (damping != NULL)
        damping[index] = (scalar)((double)l->damping * square);
    occupied[l->slot] = square > 0 && (l->stiffness > 0 || l->damping > 0) ? -1 : 0;
}

/* Stores the coefficients of a link, also in its slot of a band if it fits there. */
static inline void scene_write_weighted(spring_scene *s, stored_weighted *to, const spring_weighted_link *link)
{
    for (int i = 0; i < to->points; i++)
        to->weight[i] = (scalar)link->weight[to->place[i]];
    to->rest = (scalar)fabs(link->rest);
    to->stiffness = (scalar)link->stiffness;
    to->damping = (scalar)link->damping;
    to->banded = to->slot != no_slot && three_points_of(link).offset > 0;
    if (to->slot != no_slot)
        scene_fill_slot(s, to, scene_slot_place(s, to->slot).index);
}

/* The link with its values in the precision of the scene. In single precision the first weight is minus the sum of the
   others, which add_weighted_link() uses in its place, so that the sum of the weights is 0. */
static inline spring_weighted_link scene_weighted(const stored_weighted *l)
{
    spring_weighted_link link = {
        .rest = (double)l->rest, .stiffness = (double)l->stiffness, .damping = (double)l->damping};
    double others = 0;
    for (int i = 0; i < l->points; i++) {
        link.particle[l->place[i]] = l->particle[i];
        link.weight[l->place[i]] = (double)l->weight[i];
        others += i > 0 ? (double)l->weight[i] : 0;
    }
    if (l->points > 0 && sizeof(scalar) < sizeof(double))
        link.weight[l->place[0]] = -others;
    return link;
}

/* The inverse masses of its particles; 0 where the weight is 0. */
static inline void weighted_inverse_masses(const spring_scene *s, const spring_weighted_link *link, double inverse[4])
{
    for (int i = 0; i < 4; i++)
        inverse[i] = link->weight[i] != 0 ? inverse_mass_at(s, link->particle[i]) : 0;
}

#include "../simd/size_end.h"

#endif
