/* SPDX-License-Identifier: MIT */
/* The length of a run, from any two of --dt, --steps and --duration. */
#ifndef SPRINGSTEP_RUN_LENGTH_H
#define SPRINGSTEP_RUN_LENGTH_H

#include <stdint.h>

#include <springstep/spring.h>

/* The targets of these three options. Their initial values are the defaults; 0: no default. */
typedef struct run_length {
    double dt, duration; /* [s] > 0 */
    uint64_t steps;
} run_length;

/**
 * Computes the third value from the two that are given, or from one and a default.
 *
 * With a step and a duration, the number of steps is duration/dt rounded to the nearest whole number, at least 1. The
 * run then ends at dt * steps; `duration` keeps the requested value. Exits with CLI_USAGE if all three are given, if
 * too few are known, or for more than 2^53 steps (CLI_MOST_STEPS).
 */
void run_length_settle(run_length *run);

/** Warns if the run does not end at the requested time. */
void run_length_remark_end(const run_length *run);

/** Warns if a step is not stable.
    @param dt      the longest step of the run [s]
    @param stable  the stability limit [s]; 0: no step is stable, infinity: every step is */
void run_length_remark_step(double dt, double stable, spring_method m);

#endif
