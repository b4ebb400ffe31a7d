/* SPDX-License-Identifier: MIT */
/* The kernels of a batch in vectors of 16 bytes: SSE2 on x86-64, and for every other processor. */
#define SPRING_VECTOR 16
#include "batch_kernels.h"

const batch_kernels BATCH(v128) = BATCH_KERNELS;
