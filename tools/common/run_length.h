/* SPDX-License-Identifier: MIT */
/* How long a run is, for tools that make one: any two of --dt, --steps and --duration say it. */
#ifndef SPRINGSTEP_RUN_LENGTH_H
#define SPRINGSTEP_RUN_LENGTH_H

#include <stdint.h>

#include <springstep/spring.h>

/* The targets of these three options. What they hold before is the default; 0: there is none. */
typedef struct run_length {
    double dt, duration; /* [s] > 0 */
    uint64_t steps;
} run_length;

/**
 * The third from the two that are given; a default stands in for what is missing.
 *
 * From a step and a duration the number of steps is the nearest whole number, at least 1. The duration stays what was
 * asked for: the run ends at dt times steps. Exits with CLI_USAGE if all three are given, if too few are known, and for more
 * than 2^53 steps: up to there times are exact.
 */
void run_length_settle(run_length *run);

/** Say so if the run ends at another time than it was asked for. */
void run_length_remark_end(const run_length *run);

/** Say so if a step is not stable.
    @param dt      the longest step of the run [s]
    @param stable  the stable step [s]; 0: none is, infinity: all are */
void run_length_remark_step(double dt, double stable, spring_method m);

#endif
