/* SPDX-License-Identifier: MIT */
/*
 * Leapfrog and RK4 with compensated summation: what an addition rounds away is kept, and added the next time.
 *
 * The library does without, for speed; here it shows how much of an error is the rounding of x and v themselves.
 */
#ifndef SPRINGSTEP_HARNESS_COMPENSATED_H
#define SPRINGSTEP_HARNESS_COMPENSATED_H

#include <stdbool.h>
#include <stdint.h>

#include <springstep/spring.h>

enum { compensated_springs = 8 }; /* stepped side by side, for a processor takes hardly longer than for one */

/* States x + x_rest, v + v_rest. */
typedef struct compensated_state {
    double x[compensated_springs], v[compensated_springs];           /* [m], [m/s] */
    double x_rest[compensated_springs], v_rest[compensated_springs]; /* 0 at the start */
} compensated_state;

/** Are there compensated sums of this method? */
bool compensated_knows(spring_method m);

/** n steps of all springs, with the library's formulas for SPRING_LEAPFROG or SPRING_RK4; no damping, no load. */
void compensated_advance(compensated_state *s, const spring_params *p, spring_method m, double dt, uint64_t n);

#endif
