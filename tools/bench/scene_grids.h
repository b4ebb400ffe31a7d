/* SPDX-License-Identifier: MIT */
/* The scenes that spring-bench times: ropes, sheets, blocks of jelly and water, in natural order and in others. */
#ifndef SPRINGSTEP_BENCH_SCENE_GRIDS_H
#define SPRINGSTEP_BENCH_SCENE_GRIDS_H

#include <springstep/scene.h>

typedef enum scene_shape { ROPE, SHEET, JELLY, WATER } scene_shape;

/* SHUFFLED: links and the numbers of particles. RENUMBERED: the same, and then spring_links_renumber(). */
typedef enum scene_order { NATURAL, LINKS_SHUFFLED, SHUFFLED, RENUMBERED } scene_order;

/* The arrays of a definition. */
typedef struct scene_arrays {
    size_t particles, links;
    double *position, *mass; /* masses that differ, for scenes that model them */
    uint8_t *pinned;
    spring_link *link;
} scene_arrays;

static const double scene_mass = 0.1, scene_gravity[3] = {0.3, -9.81, -0.5}; /* [kg], [m/s^2] */

/** Memory that is aligned for a scene, up to the next whole vector; ends the program where there is none. */
void *scene_allocate(size_t bytes);

uint32_t scene_axes(scene_shape shape);

/** How many links a scene of so many particles along an edge has. */
size_t scene_links(scene_shape shape, uint32_t side);

/** Fill arrays anew; damping [N s/m] of every link. The same every time. */
void scene_fill(scene_arrays *all, scene_shape shape, uint32_t side, scene_order order, double damping);

/** spring_links_renumber(): the links of shuffled arrays, and where to order[] their particles. */
void scene_renumber(scene_arrays *all, uint32_t *order);

#endif
