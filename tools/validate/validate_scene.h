/* SPDX-License-Identifier: MIT */
#ifndef VALIDATE_SCENE_H
#define VALIDATE_SCENE_H

#include "harness/scenes.h"

/* Checks a scene with every method against all its references. */
void validate_scene(const scene_case *c);

#endif
