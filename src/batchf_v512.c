/* SPDX-License-Identifier: MIT */
/* The float twin of batch_v512.c. */
#define SPRING_FLOAT
#include "batch_v512.c"
