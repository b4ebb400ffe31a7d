/* SPDX-License-Identifier: MIT */
/* The float twin of scene_v128.c. */
#define SPRING_FLOAT
#include "scene_v128.c"
