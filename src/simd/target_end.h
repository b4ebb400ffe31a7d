/* SPDX-License-Identifier: MIT */
/* The end of what target_begin.h begins. */
#if SPRING_VECTOR == 16
#elif defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
