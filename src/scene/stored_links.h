/* SPDX-License-Identifier: MIT */
/* Reading and writing the links of a scene. */
#ifndef SPRINGSTEP_STORED_LINKS_H
#define SPRINGSTEP_STORED_LINKS_H

#include "block.h"
#include "definition.h"

#include <math.h>

#include "../simd/size_begin.h"

/* Where a link is stored. */
typedef struct link_place {
    uint32_t a, b; /* its ends; in a band the lower one first */
    bool banded;   /* else the index is among the unbanded links */
    size_t slot;   /* banded: among the slots of all bands */
    size_t index;  /* of its coefficients */
} link_place;

static inline link_place scene_slot_place(const spring_scene *s, size_t slot)
{
    const scene_layout *l = &s->layout;
    const uint32_t *a = scene_read(s, ARRAY_LINK_A), *b = scene_read(s, ARRAY_LINK_B);
    if (slot >= l->band_slots) {
        const size_t i = slot - l->band_slots;
        return (link_place){a[i], b[i], false, slot, i};
    }
    const band_layout *band = l->band;
    while (band + 1 < l->band + l->bands && band[1].slots <= slot)
        band++;
    const uint32_t lower = (uint32_t)(band->first / tile * tile + slot - band->slots);
    return (link_place){lower, lower + band->offset, true, slot,
                        band->coefficients + (band->equal ? 0 : slot - band->slots)};
}

static inline link_place scene_link_place(const spring_scene *s, size_t index)
{
    const uint32_t *slots = scene_read(s, ARRAY_SLOTS);
    return scene_slot_place(s, slots != NULL ? slots[index] : index);
}

/* A link in the precision of the scene. */
typedef struct stored_link {
    uint32_t a, b;
    scalar stiffness, rest, damping; /* rest: negative on one axis if the definition has a and b in the other order */
} stored_link;

static inline stored_link scene_link(const spring_scene *s, size_t index)
{
    const link_place at = scene_link_place(s, index);
    const scalar *stiffness = scene_read(s, at.banded ? ARRAY_BAND_STIFFNESS : ARRAY_LINK_STIFFNESS);
    const scalar *rest = scene_read(s, at.banded ? ARRAY_BAND_REST : ARRAY_LINK_REST);
    const scalar *damping = scene_read(s, at.banded ? ARRAY_BAND_DAMPING : ARRAY_LINK_DAMPING);
    const scalar size = s->layout.axes > 1 && rest[at.index] < 0 ? -rest[at.index] : rest[at.index];
    return (stored_link){at.a, at.b, stiffness[at.index], size, damping != NULL ? damping[at.index] : 0};
}

static inline void scene_write_link(spring_scene *s, size_t index, const spring_link *link)
{
    const link_place at = scene_link_place(s, index);
    scalar *stiffness = scene_memory(s, at.banded ? ARRAY_BAND_STIFFNESS : ARRAY_LINK_STIFFNESS);
    scalar *rests = scene_memory(s, at.banded ? ARRAY_BAND_REST : ARRAY_LINK_REST);
    scalar *damping = scene_memory(s, at.banded ? ARRAY_BAND_DAMPING : ARRAY_LINK_DAMPING);
    int8_t *occupied = scene_memory(s, ARRAY_OCCUPIED);
    const scalar rest = (scalar)fabs(link->rest); /* -0.0 would reverse a link on one axis */
    stiffness[at.index] = (scalar)link->stiffness;
    const bool negative = s->layout.axes == 1 ? at.a != link->a : scene_link_flags(s, index) != 0;
    rests[at.index] = negative ? -rest : rest; /* see scene_band */
    if (damping != NULL)
        damping[at.index] = (scalar)link->damping;
    if (at.banded)
        occupied[at.slot] = (scalar)link->stiffness > 0 || (scalar)link->damping > 0 ? -1 : 0;
}

/* NULL: the link is no tether. */
static inline const tether *scene_tether(const spring_scene *s, size_t index)
{
    const tether *const all = scene_read(s, ARRAY_TETHERS);
    size_t first = 0, end = s->layout.tethers;
    while (first < end) {
        const size_t middle = (first + end) / 2;
        if (all[middle].link == index)
            return &all[middle];
        if (all[middle].link < index)
            first = middle + 1;
        else
            end = middle;
    }
    return NULL;
}

/* The coefficients of a link without those of a tether that does not act, which are stored in ARRAY_TETHERS alone. */
static inline spring_link acting_link(spring_scene *s, size_t index, const spring_link *link)
{
    spring_link acting = *link;
    const tether *const defined = scene_tether(s, index);
    if (defined == NULL)
        return acting;
    tether *const all = scene_memory(s, ARRAY_TETHERS), *const t = all + (defined - all);
    t->stiffness = (scalar)link->stiffness;
    t->damping = (scalar)link->damping;
    if ((inverse_mass_at(s, link->a) == 0) == (inverse_mass_at(s, link->b) == 0))
        acting.stiffness = acting.damping = 0;
    return acting;
}

/* Counts a damped link. */
static inline void scene_count_damped(spring_scene *s, double rest, double damping, bool added)
{
    const uint64_t one = added ? 1 : (uint64_t)-1;
    s->damped_links += (scalar)damping > 0 ? one : 0;
    s->isotropic_links += (scalar)damping > 0 && (scalar)rest == 0 && s->layout.axes > 1 ? one : 0;
}

/* Changes a link: drops the forces of the scene, and its bounds if they change. */
static inline void scene_replace_link(spring_scene *s, size_t index, const spring_link *link)
{
    const stored_link old = scene_link(s, index);
    const spring_link acting = acting_link(s, index, link);
    scene_count_damped(s, (double)old.rest, (double)old.damping, false);
    scene_count_damped(s, acting.rest, acting.damping, true);
    const bool same_kind = ((scalar)acting.rest == 0) == (old.rest == 0); /* the sign of its root */
    if ((scalar)acting.stiffness != old.stiffness || (scalar)acting.damping != old.damping || !same_kind)
        s->bounds_known = false;
    scene_write_link(s, index, &acting);
    scene_drop_forces(s);
}

/* ---------------------------------------------------------------------------------------------------- other values */

static inline void scene_store_gravity(spring_scene *s, const double *gravity)
{
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        s->gravity[a] = gravity[a];
        for (size_t i = 0; i < padding; i++)
            s->gravity_vectors[a][i] = (scalar)gravity[a];
    }
}

static inline void scene_set_inverse_mass(spring_scene *s, size_t i, scalar inverse)
{
    scalar *const mass = scene_memory(s, ARRAY_INVERSE_MASS);
    mass[i] = inverse;
}

#include "../simd/size_end.h"

#endif
