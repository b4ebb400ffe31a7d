/* SPDX-License-Identifier: MIT */
/* The kernels of a scene in vectors of 16 bytes: SSE2 on x86-64, and for every other processor. */
#define SPRING_VECTOR 16
#include "scene_kernels.h"

const scene_kernels SCENE(v128) = SCENE_KERNELS;
