/* SPDX-License-Identifier: MIT */
/* Scenes, with SIMD vectors of 32 bytes: AVX2. */
#include "../simd/targets.h"
#if SPRING_HAS_V256
#define SPRING_VECTOR       32
#define SPRING_SCENE_TABLE  spring_scene_v256
#define SPRING_COMMON_TABLE spring_common_v256
#include "scene_tmpl.h"
#endif
