/* SPDX-License-Identifier: MIT */
/* The float twin of scene_v512.c. */
#define SPRING_FLOAT
#include "scene_v512.c"
