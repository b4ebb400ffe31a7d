/* SPDX-License-Identifier: MIT */
/* Ends the target that target_begin.h sets. */
#if SPRING_VECTOR == 16 && !SPRING_COMPACT
#elif defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
