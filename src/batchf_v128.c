/* SPDX-License-Identifier: MIT */
/* The float twin of batch_v128.c. */
#define SPRING_FLOAT
#include "batch_v128.c"
