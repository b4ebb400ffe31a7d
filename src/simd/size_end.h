/* SPDX-License-Identifier: MIT */
/* Ends what size_begin.h begins. */
#if defined(__clang__) && defined(__GNUC__)
#pragma clang attribute pop
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif
