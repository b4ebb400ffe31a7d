/* SPDX-License-Identifier: MIT */
/* Functions between this file and size_end.h are compiled for size: they are rarely called, or take little time. */
#if defined(__clang__) && defined(__GNUC__)
#pragma clang attribute push(__attribute__((minsize)), apply_to = function)
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("Os")
#endif
