/* SPDX-License-Identifier: MIT */
/* Steps of a scene for as long as it holds, and a hash of its state. */
#ifndef SPRINGSTEP_SCENE_RUN_H
#define SPRINGSTEP_SCENE_RUN_H

#include <springstep/scene.h>

/** The step [s] of a frame that is divided into so many: 1/(rate steps), so computed everywhere. */
double scene_run_step(double frame_rate, uint64_t steps_per_frame);

/** Are the positions, velocities and energies of the scene finite? */
bool scene_run_holds(const spring_scene *scene);

/**
 * Takes n steps, or as many as the scene survives: none after which its state or its energy would overflow.
 *
 * @param saved  memory for a copy of the scene, of so many bytes, equally aligned
 * @return the steps taken
 */
uint64_t scene_run_steps(spring_scene *scene, void *saved, size_t bytes, spring_method m, double dt, uint64_t n);

/** FNV-1a, 64 bits, over the doubles of all positions and then of all velocities, particle by particle, axis by axis, the
    lowest byte first.
    Source: Fowler, Noll, Vo; RFC 9923. */
uint64_t scene_run_hash(const spring_scene *scene, size_t particles, uint32_t axes);

#endif
