/* SPDX-License-Identifier: MIT */
/* The loop with which scenes are compared: well written, with a structure per particle and an array of links. */
#ifndef SPRINGSTEP_BENCH_PLAIN_LOOP_H
#define SPRINGSTEP_BENCH_PLAIN_LOOP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/scene.h>

typedef struct plain_particle {
    double x[3], v[3], force[3];
    double inverse_mass; /* 0: pinned */
} plain_particle;

typedef struct plain_scene {
    size_t particles, links;
    plain_particle *particle;
    const spring_link *link;
    double gravity[3], drag;
    bool damped; /* links are damped */
} plain_scene;

/** Leapfrog; the forces at the end of a step are reused at the start of the next. */
void plain_advance(const plain_scene *s, double dt, uint64_t steps);

#endif
