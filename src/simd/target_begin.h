/* SPDX-License-Identifier: MIT */
/*
 * From here to target_end.h functions use the instructions for vectors of SPRING_VECTOR bytes: 16, or where
 * SPRING_LONG_VECTORS says so 32 or 64. Headers of the system stand before it.
 *
 * Targets are set by pragma, not by flags of the build, so the sources of src compile alone, without flags.
 */
#ifndef SPRINGSTEP_TARGET_BEGIN_H
#define SPRINGSTEP_TARGET_BEGIN_H

#include "targets.h"

#if SPRING_VECTOR == 16
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
