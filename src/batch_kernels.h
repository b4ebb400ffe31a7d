/* SPDX-License-Identifier: MIT */
/* What the kernels of a batch work on, and their table: one of each method. */
#ifndef SPRINGSTEP_BATCH_KERNELS_H
#define SPRINGSTEP_BATCH_KERNELS_H

#include "propagator.h"
#include "simd/scalar.h"
#include "twins.h"

/* An array of parameters: an element for each spring, or a vector of equal elements for all of them. */
typedef struct batch_array {
    const scalar *first;
    size_t step; /* from spring to spring: 1, or 0 */
} batch_array;

/* What a kernel works on. count is a multiple of the group. */
typedef struct batch_block {
    size_t count;
    scalar *x, *v;
    batch_array w, g, a;
    scalar dt;
    uint64_t n;
    const spring_propagator *propagator; /* of the exact solution, of all springs; NULL: each its own */
} batch_block;

typedef bool batch_kernel(const batch_block *b); /* false: at least one spring has kept its state */

typedef struct batch_kernels {
    size_t group_size; /* springs that are advanced together */
    batch_kernel *method[SPRING_METHOD_COUNT];
} batch_kernels;

SPRING_INTERNAL const batch_kernels spring_batch_v128; /* by bits of a vector */
#if SPRING_LONG_VECTORS
SPRING_INTERNAL const batch_kernels spring_batch_v256, spring_batch_v512;
#endif

/* spring_batch_advance() with a given instruction set, for tests. */
SPRING_INTERNAL spring_status spring_batch_advance_with(const batch_kernels *kernels, const spring_batch *b,
                                                        spring_method m, scalar dt, uint64_t n);

#endif
