/* SPDX-License-Identifier: MIT */
/* Presets and disturbances for programs: any error ends the program with a message. */
#ifndef SPRINGSTEP_SCENE_START_H
#define SPRINGSTEP_SCENE_START_H

#include "disturbances.h"
#include "presets.h"

/** As preset_init(). */
void start_preset(preset *r, const preset_settings *s);

/** Adds bending stiffness and tethers if they are > 0: preset_bend() and preset_tether(). */
void start_links(preset *r, double bend, double tethers);

/** Creates a scene in one block of *bytes bytes (NULL: not needed); release it with free(). */
spring_scene *start_definition(const spring_scene_def *def, size_t *bytes);

/** As preset_start(), for one method and for leapfrog, whose stable step is the scale for all methods. */
spring_scene *start_scene(const preset *r, spring_method m, size_t *bytes);

/** As start_scene() in single precision, for leapfrog and a scene without a callback. NULL if the scene is not
    representable in single precision. */
spring_scenef *start_single(const preset *r);

/** The stable step of a scene at its start. */
double start_stable_step(const preset *r, spring_method m);

/** The stable step of leapfrog in single precision, without a callback; NaN if the scene is not representable in it. */
double start_stable_step_in_float(const preset *r);

/** Makes a list of disturbances, which may be empty, the callback of the scene. */
disturbances *start_disturbances(preset *r, const disturbance *list, size_t count);

/** Adds the default poke if the scene is height-field water, otherwise returns NULL. */
disturbances *start_poke(preset *r, const preset_settings *s);

#endif
