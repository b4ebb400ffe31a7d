/* SPDX-License-Identifier: MIT */
/* Scenes, with SIMD vectors of 64 bytes: AVX-512. */
#include "../simd/targets.h"
#if SPRING_HAS_V512
#define SPRING_VECTOR       64
#define SPRING_SCENE_TABLE  spring_scene_v512
#define SPRING_COMMON_TABLE spring_common_v256
#include "scene_tmpl.h"
#endif
