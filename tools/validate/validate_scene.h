/* SPDX-License-Identifier: MIT */
#ifndef VALIDATE_SCENE_H
#define VALIDATE_SCENE_H

#include "harness/scenes.h"

/* Check a scene with every method, against every reference that it has. */
void validate_scene(const scene_case *c);

#endif
