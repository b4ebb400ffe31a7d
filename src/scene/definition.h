/* SPDX-License-Identifier: MIT */
/* The values of a scene definition, with its defaults. */
#ifndef SPRINGSTEP_DEFINITION_H
#define SPRINGSTEP_DEFINITION_H

#include "weighted_links.h"

static inline uint32_t axes_of(const spring_scene_def *def)
{
    return def->axes == 0 ? 3 : def->axes;
}

static inline bool is_pinned(const spring_scene_def *def, size_t i)
{
    return def->pinned != NULL && def->pinned[i] != 0;
}

static inline double mass_of(const spring_scene_def *def, size_t i)
{
    return def->mass != NULL ? def->mass[i] : def->mass_all == 0 ? 1 : def->mass_all;
}

/* 0: pinned */
static inline scalar inverse_mass_of(const spring_scene_def *def, size_t i)
{
    return is_pinned(def, i) ? 0 : (scalar)(1 / mass_of(def, i));
}

/* A tether acts while exactly one of its ends is pinned. */
static inline bool defined_link_acts(const spring_scene_def *def, const spring_link *link)
{
    return (link->flags & SPRING_LINK_TETHER) == 0 || is_pinned(def, link->a) != is_pinned(def, link->b);
}

/* What a link adds to the row sum of the stiffness matrix of its end `end` [N/m]; 0 for a pinned particle. */
static inline double link_row(const spring_scene_def *def, const spring_link *link, uint32_t end)
{
    const uint32_t other = end == link->a ? link->b : link->a;
    return is_pinned(def, end) || !defined_link_acts(def, link) ? 0
           : is_pinned(def, other)                              ? link->stiffness
                                                                : 2 * link->stiffness;
}

/* What a weighted link adds to the row sum of its particle[i] [N/m]; 0 for a pinned particle. */
static inline double weighted_link_row(const spring_scene_def *def, const spring_weighted_link *link, int i)
{
    double free[4];
    for (int j = 0; j < 4; j++)
        free[j] = link->weight[j] != 0 && !is_pinned(def, link->particle[j]) ? 1 : 0;
    return free[i] > 0 ? link->stiffness * weighted_row(link->weight, free, i) : 0;
}

static inline bool has_damped_links(const spring_scene_def *def)
{
    for (size_t i = 0; i < def->links; i++)
        if (def->link[i].damping > 0)
            return true;
    for (size_t i = 0; i < def->weighted_links; i++)
        if (def->weighted_link[i].damping > 0)
            return true;
    return false;
}

/* All flags of links. */
static inline uint32_t link_flags(const spring_scene_def *def)
{
    uint32_t flags = 0;
    for (size_t i = 0; i < def->links; i++)
        flags |= def->link[i].flags;
    return flags;
}

#endif
