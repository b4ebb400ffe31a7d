/* SPDX-License-Identifier: MIT */
/* The float twin of batch.c. */
#define SPRING_FLOAT
#include "batch.c"
