/* SPDX-License-Identifier: MIT */
/* The methods for scenes: one stepper each, see steppers.c. */
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

typedef struct scene_stepper {
    step_function *step; /* NULL: the method is not for scenes */
    double (*stable_step)(const scene_bounds *b);
    bool predicts; /* stores predicted velocities, and the forces at these, if forces depend on velocities */
    double (*explicit_limit)(const scene_bounds *b); /* of dt; beyond, kicks are exponential: exponential_kick.h */
    unsigned stages;                                 /* quantities of all particles that it stores for its stages */
    unsigned mass_factors;                           /* numbers that it stores for each mass, with drag */
} scene_stepper;

SPRING_INTERNAL const scene_stepper spring_scene_steppers[SPRING_METHOD_COUNT];

#endif
