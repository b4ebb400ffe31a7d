/* SPDX-License-Identifier: MIT */
/* Presets and disturbances for programs: whatever is wrong ends the program with a message. */
#ifndef SPRINGSTEP_SCENE_START_H
#define SPRINGSTEP_SCENE_START_H

#include "disturbances.h"
#include "presets.h"

/** As preset_init(). */
void start_preset(preset *r, const preset_settings *s);

/** As preset_start(), for one method and for leapfrog, whose stable step is a measure for all. */
spring_scene *start_scene(const preset *r, spring_method m, size_t *bytes);

/** The disturbances of a list, which become the callback of the scene; NULL if there is none. */
disturbances *start_disturbances(preset *r, const disturbance *list, size_t count);

/** Pokes the scene if it is water; NULL if it is none. */
disturbances *start_poke(preset *r, const preset_settings *s);

#endif
