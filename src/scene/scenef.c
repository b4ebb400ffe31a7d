/* SPDX-License-Identifier: MIT */
/* Scenes in single precision; see kernels/single_precision.h. */
#define SPRING_FLOAT
#include "colliders.c"
#include "edit.c"
#include "init.c"
#include "save.c"
#include "stable_step.c"
#include "state.c"
#include "step.c"
#include "steppers.c"
#include "tear.c"
#include "transform.c"
#include "weighted.c"
