/* SPDX-License-Identifier: MIT */
/*
 * A scene as it lies in its block of memory: this structure, and behind it arrays that are found by their offsets from
 * it, never by pointers, so that the block may be copied to any other place.
 */
#ifndef SPRINGSTEP_SCENE_BLOCK_H
#define SPRINGSTEP_SCENE_BLOCK_H

#include "scene_kernels.h"

#include <springstep/scene.h>

#ifdef SPRING_FLOAT
typedef spring_scenef scene;
typedef spring_scenef_def scene_def;
typedef spring_scenef_force_fn scene_force_fn;
#else
typedef spring_scene scene;
typedef spring_scene_def scene_def;
typedef spring_force_fn scene_force_fn;
#endif

enum {
    most_rows = 32, /* of links; a block with diagonals and bending links has 16 */
    most_frames =
        3, /* positions and velocities: two that take turns for rule "all or nothing", one for RK4's stages */
};

/* A row of links, and where it is kept: it has `places`, from `padding` before the first lower end to `padding` after the
   last, and numbers for each of them; or, where all links are equal and stay so, one vector of numbers for all, and for
   each place a byte that says whether it is taken. */
typedef struct row_place {
    uint32_t offset;     /* from the lower end of a link to its upper end */
    uint32_t first, end; /* of the lower ends */
    bool equal;
    size_t start;   /* of its places among those of all rows */
    size_t numbers; /* of its numbers among those of all rows */
    size_t present; /* of its bytes, if it is equal */
} row_place;

/* What a scene consists of, and where: offsets in bytes from its start, 0 for what it does not have. */
typedef struct scene_plan {
    uint32_t axes, flags, methods;
    size_t particles, links;
    size_t stride;                             /* elements from one axis of a quantity to the next */
    size_t row_places, row_numbers, row_bytes; /* in all rows together */
    size_t list_links;                         /* that lie in no row */
    uint32_t rows;
    row_place row[most_rows]; /* by ascending offset */
    size_t x[most_frames], v[most_frames];
    uint32_t work; /* the frame of RK4's stages */
    size_t force;
    size_t predicted;    /* velocities */
    size_t sum_x, sum_v; /* RK4 */
    size_t inverse_mass;
    size_t row_present, row_stiffness, row_rest, row_damping;
    size_t list_a, list_b, list_stiffness, list_rest, list_damping;
    size_t slot; /* of each link: a place in the rows, or row_places and its place in the list */
    size_t bytes;
} scene_plan;

#ifdef SPRING_FLOAT
struct spring_scenef
#else
struct spring_scene
#endif
{
    scene_plan plan;
    scene_force_fn *force;
    void *user;
    double mass_all, drag, gravity[3];
    double t0, dt; /* time is t0 + steps dt */
    uint64_t steps;
    uint64_t damped_links;
    uint32_t frame;  /* that holds the state */
    bool force_kept; /* force is that of the state */
    bool broken;     /* an advance without undo has failed */
    bool limits_known;
    double L, G, K; /* [1/s^2], [1/s], [N/m]: see spring_scene_stable_step() */
};

/* spring_scene_advance() with the instruction set of one's choice, for tests. */
spring_status SCENE(advance_with)(const scene_kernels *kernels, scene *s, spring_method m, double dt,
                                  uint64_t n);

/* The arrays of a quantity, one for each axis. */
SPRING_INLINE scalar *scene_axis(const scene *s, size_t offset, uint32_t axis)
{
    return (scalar *)((char *)(uintptr_t)s + offset) + axis * s->plan.stride + padding;
}

SPRING_INLINE scalar *scene_array(const scene *s, size_t offset)
{
    return (scalar *)((char *)(uintptr_t)s + offset);
}

SPRING_INLINE uint32_t *scene_indices(const scene *s, size_t offset)
{
    return (uint32_t *)((char *)(uintptr_t)s + offset);
}

SPRING_INLINE int8_t *scene_bytes_at(const scene *s, size_t offset)
{
    return (int8_t *)(uintptr_t)s + offset;
}

/* A link by its place, the lower end of a row first. */
typedef struct placed_link {
    uint32_t a, b;
    scalar *stiffness, *rest, *damping; /* damping NULL: not modelled */
} placed_link;

SPRING_INLINE placed_link scene_link(const scene *s, size_t index)
{
    const scene_plan *p = &s->plan;
    const size_t slot = scene_indices(s, p->slot)[index];
    if (slot >= p->row_places) {
        const size_t i = slot - p->row_places;
        return (placed_link){
            scene_indices(s, p->list_a)[i],
            scene_indices(s, p->list_b)[i],
            scene_array(s, p->list_stiffness) + i,
            scene_array(s, p->list_rest) + i,
            p->list_damping != 0 ? scene_array(s, p->list_damping) + i : NULL,
        };
    }
    const row_place *row = p->row;
    while (row + 1 < p->row + p->rows && row[1].start <= slot)
        row++;
    const uint32_t a = row->first + (uint32_t)(slot - row->start - padding);
    const size_t number = row->numbers + (row->equal ? 0 : slot - row->start);
    return (placed_link){
        a,
        a + row->offset,
        scene_array(s, p->row_stiffness) + number,
        scene_array(s, p->row_rest) + number,
        p->row_damping != 0 ? scene_array(s, p->row_damping) + number : NULL,
    };
}

SPRING_INLINE double inverse_mass_at(const scene *s, size_t i)
{
    return s->plan.inverse_mass != 0 ? (double)scene_array(s, s->plan.inverse_mass)[i] : 1 / s->mass_all;
}

#endif
