/* SPDX-License-Identifier: MIT */
/* Scenes, with SIMD vectors of 16 bytes: SSE2 on x86-64, and all other processors. */
#include "../simd/targets.h"
#if SPRING_HAS_V128
#define SPRING_VECTOR       16
#define SPRING_SCENE_TABLE  spring_scene_v128
#define SPRING_COMMON_TABLE spring_common_v128
#include "scene_tmpl.h"
#endif
