/* SPDX-License-Identifier: MIT */
/* The float twin of scene.c. */
#define SPRING_FLOAT
#include "scene.c"
