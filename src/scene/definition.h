/* SPDX-License-Identifier: MIT */
/* The definition of a scene of either precision: its values with their defaults, and functions that are compiled once
   for both precisions. Their argument `precision` is sizeof(scalar) of the scene. */
#ifndef SPRINGSTEP_DEFINITION_H
#define SPRINGSTEP_DEFINITION_H

#include "layout.h"
#include "../simd/arithmetic.h"

#include <math.h>

#include <springstep/scene.h>

/* ----------------------------------------------------------------------------------------------------------- values */

/* A value as the scene stores it. */
static inline double stored_value(size_t precision, double value)
{
    return precision == sizeof(float) ? (double)(float)value : value;
}

static inline bool value_fits(size_t precision, double value) /* finite in the precision of the scene */
{
    return spring_finite(stored_value(precision, value));
}

static inline bool value_not_negative(size_t precision, double value)
{
    return value >= 0 && value_fits(precision, value);
}

static inline bool mass_valid(size_t precision, double mass)
{
    return mass > 0 && value_fits(precision, mass) && value_fits(precision, 1 / mass);
}

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
static inline double inverse_mass_of(const spring_scene_def *def, size_t precision, size_t i)
{
    return is_pinned(def, i) ? 0 : stored_value(precision, 1 / mass_of(def, i));
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

/* |weight| of a particle times the sum of |weight| over the particles that are not pinned. This times the stiffness
   bounds the row of the stiffness matrix, as 2 stiffness or 1 stiffness does for a link. */
static inline double weighted_row(const double weight[4], const double inverse_mass[4], int i)
{
    double sum = 0;
    for (int j = 0; j < 4; j++)
        sum += inverse_mass[j] > 0 ? fabs(weight[j]) : 0;
    return fabs(weight[i]) * sum;
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

/* A link whose weights are (w, -2w, w), at particles with a constant offset, and whose rest length is 0. */
typedef struct three_points {
    uint32_t lower, offset; /* offset: 0 if the link is none */
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
    return (three_points){up ? particle[0] : particle[2], fits ? offset : 0};
}

/* ----------------------------------------------------------------------------------------- functions on definitions */

SPRING_INTERNAL spring_status spring_definition_check(const spring_scene_def *def, size_t precision, const char **field,
                                                      size_t *index);
SPRING_INTERNAL spring_status spring_definition_soften(const spring_scene_def *def, size_t precision, double dt,
                                                       double fraction, spring_link *link);
SPRING_INTERNAL spring_status spring_definition_tethers(const spring_scene_def *def, size_t precision, double fraction,
                                                        double slack, spring_link *out, size_t *count, uint32_t *work,
                                                        double *distance);

/* Checks a definition, and finds the layout of its scene. Returns SPRING_ERANGE also if the scene exceeds the
   address space. */
SPRING_INTERNAL spring_status spring_definition_layout(const spring_scene_def *def, const element_sizes *size,
                                                       scene_layout *l);

/* A number that identifies the ends and the order of the links: a saved state has it instead of them. With one axis,
   also their directions, unless links may be edited. With colliders, also the arrays of particles. */
SPRING_INTERNAL uint64_t spring_definition_ends(const spring_scene_def *def);

/* Finds the slots of all links, and the ends of those that are in no band: ARRAY_SLOTS, ARRAY_LINK_A, ARRAY_LINK_B and
   ARRAY_FLAGS, or NULL. */
SPRING_INTERNAL void spring_layout_links(const scene_layout *l, const spring_scene_def *def, uint32_t *slots,
                                         uint32_t *end_a, uint32_t *end_b, uint8_t *flags);

/* The slot of the next weighted link in its band, or no_slot. next: least lower end that each band still accepts, at
   first 0 */
SPRING_INTERNAL uint32_t spring_layout_weighted_slot(const scene_layout *l, const spring_weighted_link *link,
                                                     uint32_t next[most_bands]);

/* The particles of a weighted link, see stored_weighted. Returns their number. */
SPRING_INTERNAL uint8_t spring_weighted_points(const spring_weighted_link *link, uint32_t particle[4],
                                               uint8_t place[4]);

/* The field of a link that is not valid for any masses; NULL: none. */
SPRING_INTERNAL const char *spring_link_invalid_field(const spring_link *link, size_t precision);
SPRING_INTERNAL const char *spring_weighted_invalid_field(const spring_weighted_link *link, size_t precision);

/* The field that is too large for the masses of its particles; NULL: none. */
SPRING_INTERNAL const char *spring_link_overflows(const spring_link *link, size_t precision, double inverse_a,
                                                  double inverse_b);
SPRING_INTERNAL const char *spring_weighted_overflows(const spring_weighted_link *link, size_t precision,
                                                      const double inverse_mass[4]);

#endif
