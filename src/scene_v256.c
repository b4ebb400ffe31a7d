/* SPDX-License-Identifier: MIT */
/* The kernels of a scene in vectors of 32 bytes: AVX2. */
#include "arithmetic.h"

#if SPRING_X86_64

#include <immintrin.h>
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif

#define SPRING_VECTOR 32
#include "scene_kernels.h"

const scene_kernels SCENE(v256) = SCENE_KERNELS;

#if defined(__clang__)
#pragma clang attribute pop
#endif

#endif
