/* SPDX-License-Identifier: MIT */
/* The methods for scenes: one stepper each, see steppers.c. method_limits.h has their stable steps. */
#ifndef SPRINGSTEP_STEPPERS_H
#define SPRINGSTEP_STEPPERS_H

#include "block.h"

typedef struct scene_step scene_step; /* pass.h */

/* A step ends at the first number that is not finite, so that a callback sees finite numbers only. */
typedef struct scene_outcome {
    bool finite;
    cached_force cached; /* at the end of the step */
} scene_outcome;

typedef scene_outcome step_function(scene_step *); /* takes a step of a method */

SPRING_INTERNAL step_function *const spring_scene_steppers[SPRING_METHOD_COUNT]; /* NULL: not for scenes */

#endif
