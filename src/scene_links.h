/* SPDX-License-Identifier: MIT */
/* The links of a scene: where they lie, which are valid, and writing them. */
#ifndef SPRINGSTEP_SCENE_LINKS_H
#define SPRINGSTEP_SCENE_LINKS_H

#include "scene_block.h"

/* A link by its slot, the lower end of a band first. */
typedef struct slotted_link {
    uint32_t a, b;
    scalar *stiffness, *rest, *damping; /* damping NULL: not modelled */
    int8_t *occupied;                   /* NULL: an edge */
} slotted_link;

SPRING_INLINE slotted_link scene_link(const spring_scene *s, size_t index)
{
    const scene_plan *p = &s->plan;
    const size_t slot = p->slot != 0 ? scene_indices(s, p->slot)[index] : index;
    if (slot >= p->band_slots) {
        const size_t i = slot - p->band_slots;
        return (slotted_link){
            scene_indices(s, p->edge_a)[i],
            scene_indices(s, p->edge_b)[i],
            scene_array(s, p->edge_stiffness) + i,
            scene_array(s, p->edge_rest) + i,
            p->edge_damping != 0 ? scene_array(s, p->edge_damping) + i : NULL,
            NULL,
        };
    }
    const band_plan *band = p->band;
    while (band + 1 < p->band + p->bands && band[1].slots <= slot)
        band++;
    const uint32_t a = (uint32_t)(band->first / tile * tile + slot - band->slots);
    const size_t number = band->coefficients + (band->equal ? 0 : slot - band->slots);
    return (slotted_link){
        a,
        a + band->offset,
        scene_array(s, p->band_stiffness) + number,
        scene_array(s, p->band_rest) + number,
        p->band_damping != 0 ? scene_array(s, p->band_damping) + number : NULL,
        scene_bytes_at(s, p->occupied) + slot,
    };
}

static inline bool scene_fits(double value) /* is finite as a scalar, too */
{
    return spring_finite((scalar)value);
}

static inline bool scene_not_negative(double value)
{
    return value >= 0 && scene_fits(value);
}

static inline bool scene_mass_valid(double mass)
{
    return mass > 0 && scene_fits(mass) && scene_fits(1 / mass);
}

/* The field of a link that is not valid, wherever it lies; NULL: none. */
static inline const char *scene_link_invalid_field(const spring_link *link)
{
    return !scene_not_negative(link->rest)        ? "link.rest"
           : !scene_not_negative(link->stiffness) ? "link.stiffness"
           : !scene_not_negative(link->damping)   ? "link.damping"
                                                  : NULL;
}

/* The field that is too large for the masses at the ends; NULL: none. */
static inline const char *scene_link_overflows(const spring_link *link, double inverse_a, double inverse_b)
{
    const double lightest = fmax(inverse_a, inverse_b);
    return !scene_fits(2 * (link->stiffness * lightest)) ? "link.stiffness"
           : !scene_fits(2 * (link->damping * lightest)) ? "link.damping"
                                                         : NULL;
}

static inline void scene_place_gravity(spring_scene *s, const double *gravity)
{
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        s->gravity[a] = gravity[a];
        for (size_t i = 0; i < padding; i++)
            if (!s->plan.small)
                s->gravity_vectors[a][i] = (scalar)gravity[a];
            else if (i % quad_size == a)
                s->gravity_vectors[0][i] = (scalar)gravity[a];
    }
}

/* Of a quad all numbers, those of no axis too. */
static inline void scene_place_inverse_mass(spring_scene *s, size_t i, scalar inverse)
{
    for (size_t k = 0; k < s->plan.step; k++)
        scene_array(s, s->plan.inverse_mass)[s->plan.step * i + k] = inverse;
}

/* Write the coefficients of a link into its slot. */
static inline void scene_place(spring_scene *s, size_t index, const spring_link *link)
{
    const slotted_link at = scene_link(s, index);
    *at.stiffness = (scalar)link->stiffness;
    const scalar rest = (scalar)fabs(link->rest); /* -0.0 would turn a link on one axis */
    *at.rest = s->plan.axes == 1 && at.a != link->a ? -rest : rest;
    if (at.damping != NULL)
        *at.damping = (scalar)link->damping;
    if (at.occupied != NULL)
        *at.occupied = *at.stiffness > 0 || (scalar)link->damping > 0 ? -1 : 0;
}

#endif
