/* SPDX-License-Identifier: MIT */
/* Batches in single precision; see kernels/single_precision.h. */
#define SPRING_FLOAT
#include "batch.c"
