/* SPDX-License-Identifier: MIT */
/* The kernels of a scene in vectors of 64 bytes: AVX-512. */
#include "arithmetic.h"

#if SPRING_X86_64

#include <immintrin.h>
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512dq")
#endif

#define SPRING_VECTOR 64
#include "scene_kernels.h"

const scene_kernels SCENE(v512) = SCENE_KERNELS;

#if defined(__clang__)
#pragma clang attribute pop
#endif

#endif
