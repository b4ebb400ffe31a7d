/* SPDX-License-Identifier: MIT */
/* The float twin of scene_init.c. */
#define SPRING_FLOAT
#include "scene_init.c"
