/* SPDX-License-Identifier: MIT */
/* Building a scene from its definition: filling its arrays. */
#include "definition.h"
#include "weighted_links.h"

#include "../simd/size_begin.h"

_Static_assert(sizeof(public_scene_def) == sizeof(spring_scene_def), "definitions have the same fields");
_Static_assert(offsetof(public_scene_def, mask) == offsetof(spring_scene_def, mask), "fields have the same offsets");

/* Copies a definition to the type for double, which functions for both precisions use. They never call its callback. */
static const spring_scene_def *common_definition(const public_scene_def *def, spring_scene_def *copy)
{
    if (def == NULL)
        return NULL;
    memcpy(copy, def, sizeof *copy);
    return copy;
}

static const element_sizes sizes = {
    .number = sizeof(scalar),
    .block = sizeof(spring_scene),
    .tether_link = sizeof(tether),
    .weighted = sizeof(stored_weighted),
    .bounds_head = offsetof(collider_bounds, each),
    .bound = sizeof(collider_bound),
};

/* Copies a definition, and finds the layout of its scene. */
static spring_status find_layout(const public_scene_def *from, spring_scene_def *def, scene_layout *layout)
{
    return spring_definition_layout(common_definition(from, def), &sizes, layout);
}

spring_status spring_scene_bytes(const public_scene_def *from, size_t *bytes)
{
    if (bytes == NULL)
        return SPRING_EINVAL;
    spring_scene_def def;
    scene_layout layout;
    const spring_status status = find_layout(from, &def, &layout);
    if (status == SPRING_OK)
        *bytes = (size_t)layout.bytes;
    return status;
}

/* Moves the arrays so that they are aligned in this memory. A copy of the block has them at the same offsets, so there
   they are aligned to 8 bytes at least, which all loads and stores accept. */
static void align_arrays(scene_layout *l, const void *memory)
{
    const size_t beyond = (uintptr_t)memory % SPRING_SCENE_ALIGN, shift = beyond > 0 ? SPRING_SCENE_ALIGN - beyond : 0;
    for (int a = 0; a < ARRAY_COUNT; a++)
        l->offset[a] += l->offset[a] != SIZE_MAX ? shift : 0;
}

/* ---------------------------------------------------------------------------------------------------------- filling */

/* The inverse mass of a particle when it is not pinned; 0: its mass is not valid. */
static scalar free_inverse_mass_of(const spring_scene_def *def, size_t i)
{
    const double all = def->mass_all == 0 ? 1 : def->mass_all;
    const double mass = def->mass != NULL && def->mass[i] > 0 ? def->mass[i] : all;
    return mass_valid(sizeof(scalar), mass) ? (scalar)(1 / mass) : 0;
}

static void fill_contacts(spring_scene *s, const spring_scene_def *def)
{
    scalar *const radius = scene_memory(s, ARRAY_RADIUS), *const friction = scene_memory(s, ARRAY_FRICTION);
    uint32_t *const bits = scene_memory(s, ARRAY_BITS);
    scalar largest = 0;
    for (size_t i = 0; i < def->particles && radius != NULL; i++) {
        radius[i] = (scalar)def->radius[i];
        largest = radius[i] > largest ? radius[i] : largest;
    }
    if (radius != NULL)
        s->largest_radius = largest;
    for (size_t i = 0; i < def->particles && friction != NULL; i++)
        friction[i] = (scalar)def->friction[i];
    if (bits != NULL)
        memcpy(bits, def->mask, def->particles * sizeof *bits);
}

static void fill_particles(spring_scene *s, const spring_scene_def *def)
{
    const uint32_t axes = s->layout.axes;
    for (uint32_t a = 0; a < axes; a++) {
        scalar *x = scene_axis(s, ARRAY_X_0, a), *v = scene_axis(s, ARRAY_V_0, a);
        for (size_t i = 0; i < def->particles; i++) {
            x[i] = (scalar)def->position[i * axes + a];
            v[i] = def->velocity != NULL ? (scalar)def->velocity[i * axes + a] : 0;
        }
    }
    for (size_t i = 0; i < def->particles && scene_has(s, ARRAY_INVERSE_MASS); i++)
        scene_set_inverse_mass(s, i, (scalar)inverse_mass_of(def, sizeof(scalar), i));
    fill_contacts(s, def);
    scalar *freed = scene_memory(s, ARRAY_FREE_MASS);
    for (size_t i = 0; i < def->particles && freed != NULL; i++)
        freed[i] = free_inverse_mass_of(def, i);
}

/* Copies the first element of a vector to the others. */
static void spread(scalar *vector)
{
    for (size_t i = 1; i < padding; i++)
        vector[i] = vector[0];
}

static void fill_links(spring_scene *s, const spring_scene_def *def)
{
    const scene_layout *l = &s->layout;
    tether *tethers = scene_memory(s, ARRAY_TETHERS);
    spring_layout_links(l, def, scene_memory(s, ARRAY_SLOTS), scene_memory(s, ARRAY_LINK_A),
                        scene_memory(s, ARRAY_LINK_B), scene_memory(s, ARRAY_FLAGS));
    for (size_t i = 0; i < def->links && tethers != NULL; i++)
        if ((def->link[i].flags & SPRING_LINK_TETHER) != 0)
            *tethers++ = (tether){.link = (uint32_t)i};
    for (size_t i = 0; i < def->links; i++) {
        const spring_link acting = acting_link(s, i, &def->link[i]);
        scene_write_link(s, i, &acting);
        scene_count_damped(s, acting.rest, acting.damping, true);
    }
    const scene_array coefficients[] = {ARRAY_BAND_STIFFNESS, ARRAY_BAND_REST, ARRAY_BAND_DAMPING};
    for (int k = 0; k < 3; k++) {
        scalar *all = scene_memory(s, coefficients[k]);
        for (uint32_t r = 0; r < l->bands && all != NULL; r++)
            if (l->band[r].equal)
                spread(all + l->band[r].coefficients);
    }
}

static void fill_weighted_links(spring_scene *s, const spring_scene_def *def)
{
    uint32_t next[most_bands] = {0};
    stored_weighted *const all = scene_memory(s, ARRAY_WEIGHTED);
    for (size_t i = 0; i < def->weighted_links; i++) {
        const spring_weighted_link *link = &def->weighted_link[i];
        all[i].points = spring_weighted_points(link, all[i].particle, all[i].place);
        all[i].slot = spring_layout_weighted_slot(&s->layout, link, next);
        scene_write_weighted(s, &all[i], link);
        scene_count_weighted(s, &all[i], true);
    }
}

enum { least_alignment = 8 }; /* [bytes] of malloc() on all systems, also with 32 bits */
_Static_assert(_Alignof(spring_scene) <= least_alignment, "memory from malloc() can hold a scene");

spring_status spring_scene_init(void *memory, size_t bytes, const public_scene_def *from, spring_scene **result)
{
    if (result == NULL)
        return SPRING_EINVAL;
    *result = NULL;
    spring_scene_def def;
    scene_layout layout;
    const spring_status status = find_layout(from, &def, &layout);
    if (status != SPRING_OK)
        return status;
    if (memory == NULL)
        return SPRING_EINVAL;
    if ((uintptr_t)memory % least_alignment != 0)
        return SPRING_EALIGN;
    if (bytes < layout.bytes)
        return SPRING_ENOMEM;
    align_arrays(&layout, memory);
    memset(memory, 0, (size_t)layout.bytes);
    spring_scene *s = memory;
    *s = (spring_scene){
        .layout = layout,
        .force = from->force,
        .user = def.user,
        .mass_all = def.mass_all == 0 ? 1 : def.mass_all,
        .drag = def.drag,
        .particle_radius = (scalar)def.particle_radius,
        .largest_radius = (scalar)def.particle_radius,
        .max_speed = def.max_speed > 0 ? (scalar)def.max_speed : SCALAR_MAX,
    };
    s->inverse_mass_vector[0] = (scalar)(1 / s->mass_all);
    spread(s->inverse_mass_vector);
    scene_store_gravity(s, def.gravity);
    fill_particles(s, &def);
    fill_links(s, &def);
    fill_weighted_links(s, &def);
    s->ends = spring_definition_ends(&def);
    *result = s;
    return SPRING_OK;
}

/* ----------------------------------------------------------------------------------------- functions on definitions */

spring_status spring_scene_check(const public_scene_def *def, const char **field, size_t *index)
{
    spring_scene_def copy;
    return spring_definition_check(common_definition(def, &copy), sizeof(scalar), field, index);
}

spring_status spring_links_soften(const public_scene_def *def, double dt, double fraction, spring_link *link)
{
    spring_scene_def copy;
    return spring_definition_soften(common_definition(def, &copy), sizeof(scalar), dt, fraction, link);
}

spring_status spring_links_tethers(const public_scene_def *def, double fraction, double slack, spring_link *out,
                                   size_t *count, uint32_t *work, double *distance)
{
    spring_scene_def copy;
    return spring_definition_tethers(common_definition(def, &copy), sizeof(scalar), fraction, slack, out, count, work,
                                     distance);
}

#include "../simd/size_end.h"
