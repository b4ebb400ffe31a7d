/* SPDX-License-Identifier: MIT */
/*
 * Leapfrog and RK4 with compensated summation: the rounding error of each sum is kept and added to the next.
 *
 * The library does not use it, for speed. Here it separates the rounding error of x and v from other errors.
 */
#ifndef SPRINGSTEP_HARNESS_COMPENSATED_H
#define SPRINGSTEP_HARNESS_COMPENSATED_H

#include <stdbool.h>
#include <stdint.h>

#include <springstep/spring.h>

enum { compensated_springs = 8 }; /* advanced together: with SIMD that takes hardly longer than one */

/* States x + x_rest, v + v_rest. */
typedef struct compensated_state {
    double x[compensated_springs], v[compensated_springs];           /* [m], [m/s] */
    double x_rest[compensated_springs], v_rest[compensated_springs]; /* 0 at the start */
} compensated_state;

/** Returns true if the method has a compensated version. */
bool compensated_knows(spring_method m);

/** Takes n steps of all springs by the library's formulas for SPRING_LEAPFROG or SPRING_RK4; no damping, no load. */
void compensated_advance(compensated_state *s, const spring_params *p, spring_method m, double dt, uint64_t n);

#endif
