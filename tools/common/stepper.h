/* SPDX-License-Identifier: MIT */
/* A method together with the arithmetic it is computed in: what --method and --arithmetic choose. */
#ifndef SPRINGSTEP_STEPPER_H
#define SPRINGSTEP_STEPPER_H

#include <springstep/spring.h>

#include "common/cli.h"
#include "common/run_length.h"

typedef struct stepper {
    int method;     /* a spring_method; int, as the target of an option */
    int arithmetic; /* index into stepper_arithmetics: 0 the library's */
} stepper;

extern const char *const stepper_arithmetics[];

/* Steps to take between two looks at the clock: a fraction of a second. */
static const uint64_t stepper_leap = UINT64_C(1) << 24;

/** The name of the method. */
const char *stepper_name(const stepper *m);

/** Exit with CLI_USAGE if the method does not come in that arithmetic. */
void stepper_check(const stepper *m);

/** run_length_remark_step() of the method. */
void stepper_remark(const stepper *m, const spring_params *p, double dt);

/** Stamp a table with the method. */
void stepper_comment(const stepper *m, cli_table *table);

/** spring_advance() in the chosen arithmetic. */
spring_status stepper_advance(const stepper *m, spring_state *s, const spring_params *p, double dt, uint64_t n);

#endif
