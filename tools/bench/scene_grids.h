/* SPDX-License-Identifier: MIT */
/* The scenes of spring-bench: ropes, sheets, blocks of jelly and water, in natural and in other orders. */
#ifndef SPRINGSTEP_BENCH_SCENE_GRIDS_H
#define SPRINGSTEP_BENCH_SCENE_GRIDS_H

#include <springstep/scene.h>

typedef enum scene_shape { ROPE, SHEET, JELLY, WATER } scene_shape;

/* SHUFFLED: links and particles are shuffled. */
typedef enum scene_order { NATURAL, LINKS_SHUFFLED, SHUFFLED } scene_order;

/* The arrays of a definition. */
typedef struct scene_arrays {
    size_t particles, links;
    double *position, *mass; /* different masses, for scenes with this feature */
    uint8_t *pinned;
    spring_link *link;
} scene_arrays;

static const double scene_mass = 0.1, scene_gravity[3] = {0.3, -9.81, -0.5}; /* [kg], [m/s^2] */

/** Memory aligned for a scene, padded to a whole vector; exits if out of memory. */
void *scene_allocate(size_t bytes);

uint32_t scene_axes(scene_shape shape);

/** The number of links of a scene with `side` particles along an edge. */
size_t scene_links(scene_shape shape, uint32_t side);

/** Fills arrays, reproducibly; damping [N s/m] of every link. */
void scene_fill(scene_arrays *all, scene_shape shape, uint32_t side, scene_order order, double damping);

#endif
