/* SPDX-License-Identifier: MIT */
/* The kernels of batches: their arguments and their table. */
#ifndef SPRINGSTEP_BATCH_KERNELS_H
#define SPRINGSTEP_BATCH_KERNELS_H

#include "../simd/scalar.h"
#include "../simd/targets.h"
#include "../spring/propagator.h"
#include "single_precision.h"

#include <stdbool.h>
#include <stddef.h>

/* Values of a parameter: one for each spring, or a SIMD vector of equal values for all springs. */
typedef struct batch_array {
    const scalar *first; /* NULL: all values are 0 */
    size_t stride;       /* from spring to spring: 1, or 0 */
} batch_array;

/* n steps of `count` springs, a multiple of the group size. */
typedef struct batch_run {
    spring_method method;
    size_t count;
    scalar *x, *v; /* read and written */
    batch_array omega2, gamma, accel;
    scalar dt;
    uint64_t n;
    double t;                            /* exact solution: n dt */
    const scalar *target;                /* exact solution: NULL, or a target for each spring */
    exact_landing landing;               /* of springs with targets */
    const spring_propagator *propagator; /* exact solution, if all springs have equal parameters; else NULL */
} batch_run;

typedef struct batch_kernels {
    size_t group_size;                    /* springs that are advanced together */
    bool (*advance)(const batch_run *b);  /* false: at least one spring kept its state */
    const struct batch_kernels *narrower; /* with smaller groups; NULL: there are none */
} batch_kernels;

/* Named by the bits of a SIMD vector. */
#if SPRING_HAS_V128
SPRING_INTERNAL const batch_kernels spring_batch_v128;
#endif
#if SPRING_HAS_V256
SPRING_INTERNAL const batch_kernels spring_batch_v256;
#endif
#if SPRING_HAS_V512
SPRING_INTERNAL const batch_kernels spring_batch_v512;
#endif

#if defined(SPRING_FLOAT) || !defined(SPRING_NO_DOUBLE)
/* spring_batch_advance() with a given instruction set, for tests. */
SPRING_INTERNAL spring_status spring_batch_advance_with(const batch_kernels *kernels, const spring_batch *b,
                                                        spring_method m, double step, uint64_t n);

/* spring_batch_follow() with a given instruction set, for tests. */
SPRING_INTERNAL spring_status spring_batch_follow_with(const batch_kernels *kernels, const spring_batch *b,
                                                       const scalar *target, double dt, double x_tol, double v_tol,
                                                       size_t *moving);
#endif

#endif
