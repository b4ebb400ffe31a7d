/* SPDX-License-Identifier: MIT */
/* Runs a scene while its state is finite, and measures and hashes the state. */
#ifndef SPRINGSTEP_SCENE_RUN_H
#define SPRINGSTEP_SCENE_RUN_H

#include <springstep/scene.h>

/** The step [s] of a frame: 1/(rate steps). All programs use this function, so that they round alike. */
double scene_run_step(double frame_rate, uint64_t steps_per_frame);

/** The total energy [J]. */
double scene_run_total(const spring_scene_energies *e);

/** The Euclidean distance of two vectors of positions. */
double scene_run_distance(const double *a, const double *b, size_t count);

/** Returns true if the positions, velocities and energies of the scene are finite. */
bool scene_run_holds(const spring_scene *scene);

/**
 * Takes up to n steps. Stops before a step after which the state or the energy would overflow.
 *
 * @param saved  memory for a copy of the scene: `bytes` bytes, with the same alignment
 * @return the number of steps taken
 */
uint64_t scene_run_steps(spring_scene *scene, void *saved, size_t bytes, spring_method m, double dt, uint64_t n);

/** 64-bit FNV-1a hash of all positions, then of all velocities, as doubles: particle by particle, axis by axis, the
    lowest byte first.
    Source: Fowler, Noll, Vo; RFC 9923. */
uint64_t scene_run_hash(const spring_scene *scene, size_t particles, uint32_t axes);

#endif
