/* SPDX-License-Identifier: MIT */
/* The float twins of batches and scenes, from the same sources: see twins.h. */
#define SPRING_FLOAT
#include "batch.c"
#include "scene_init.c"
#include "scene_step.c"
#include "scene.c"
