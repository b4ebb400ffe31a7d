/* SPDX-License-Identifier: MIT */
/*
 * Functions between this file and target_end.h use the instructions for vectors of SPRING_VECTOR bytes: 16, or 32 or 64
 * if SPRING_LONG_VECTORS is set. System headers are included before this file.
 *
 * Targets are set by pragmas, not by build flags, so that the sources compile without flags.
 */
#ifndef SPRINGSTEP_TARGET_BEGIN_H
#define SPRINGSTEP_TARGET_BEGIN_H

#include "targets.h"

/* Kernels for vectors of 16 bytes on x86-64 serve processors without AVX2, which are rare. They are compiled for size:
   conditions that other kernels compile as constants, one loop for each combination, are tested in the loop. */
#if SPRING_VECTOR == 16 && SPRING_HAS_V256
#define SPRING_COMPACT        1
#define SPRING_CONTACT_INLINE static inline /* for functions of contact_rest_tmpl.h */
#else
#define SPRING_COMPACT        0
#define SPRING_CONTACT_INLINE SPRING_INLINE
#endif

#if SPRING_COMPACT && defined(__clang__)
#pragma clang attribute push(__attribute__((minsize)), apply_to = function)
#elif SPRING_COMPACT
#pragma GCC push_options
#pragma GCC optimize("Os")
#elif SPRING_VECTOR == 16
#elif defined(__clang__) && SPRING_VECTOR == 32
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#elif defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq,avx512vl"))), apply_to = function)
#elif SPRING_VECTOR == 32
#pragma GCC push_options
#pragma GCC target("avx2")
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl")
#endif

#endif
