/* SPDX-License-Identifier: MIT */
/* Reading and writing weighted links. */
#ifndef SPRINGSTEP_WEIGHTED_LINKS_H
#define SPRINGSTEP_WEIGHTED_LINKS_H

#include "stored_links.h"

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

/* Adds a weighted link to the counts of the scene, or removes it. */
static inline void scene_count_weighted(spring_scene *s, const stored_weighted *l, bool added)
{
    const uint64_t one = added ? 1 : (uint64_t)-1;
    s->damped_links += l->damping > 0 ? one : 0;
    s->damped_weighted += l->damping > 0 ? one : 0;
    s->loose += l->banded ? 0 : (size_t)one;
    s->nonlinear += l->rest > 0 && s->layout.axes > 1 ? (size_t)one : 0;
}

#include "../simd/size_begin.h"

/* Whether weights, in the precision of the scene, are those of a link in a band: (-2w, w, w, 0). */
static inline bool weights_of_band(const scalar w[4])
{
    return w[1] != 0 && w[1] == w[2] && w[0] == -2 * w[1] && w[3] == 0;
}

/* In single precision the first weight is minus the sum of the others, which add_pull() uses in its place, so that the
   sum of the weights is 0. */
static inline double first_weight(const stored_weighted *l)
{
    double others = 0;
    for (int i = 1; i < l->points; i++)
        others += (double)l->weight[i];
    return l->points > 0 && sizeof(scalar) < sizeof(double) ? -others : (double)l->weight[0];
}

/* Stores the coefficients of a link, also in its slot of a band if it fits there. Weights may underflow. */
static inline void scene_write_weighted(spring_scene *s, stored_weighted *to, const spring_weighted_link *link)
{
    for (int i = 0; i < to->points; i++)
        to->weight[i] = (scalar)link->weight[to->place[i]];
    to->weight[0] = (scalar)first_weight(to);
    to->rest = (scalar)fabs(link->rest);
    to->stiffness = (scalar)link->stiffness;
    to->damping = (scalar)link->damping;
    to->banded = to->slot != no_slot && three_points_of(link).offset > 0 && weights_of_band(to->weight);
    if (to->slot != no_slot)
        scene_fill_slot(s, to, scene_slot_place(s, to->slot).index);
}

/* The link with its values in the precision of the scene. */
static inline spring_weighted_link scene_weighted(const stored_weighted *l)
{
    spring_weighted_link link = {
        .rest = (double)l->rest, .stiffness = (double)l->stiffness, .damping = (double)l->damping};
    for (int i = 0; i < l->points; i++) {
        link.particle[l->place[i]] = l->particle[i];
        link.weight[l->place[i]] = i > 0 ? (double)l->weight[i] : first_weight(l);
    }
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
