/* SPDX-License-Identifier: MIT */
/* A method and its arithmetic, as chosen by --method and --arithmetic. */
#ifndef SPRINGSTEP_STEPPER_H
#define SPRINGSTEP_STEPPER_H

#include <springstep/spring.h>

#include "common/cli.h"
#include "common/run_length.h"

typedef struct stepper {
    int method;     /* a spring_method; int, as the target of an option */
    int arithmetic; /* index into stepper_arithmetics; 0: as the library */
} stepper;

extern const char *const stepper_arithmetics[];

/* Steps between two calls of cli_progress(): a fraction of a second. */
static const uint64_t stepper_leap = UINT64_C(1) << 24;

/** The name of the method. */
const char *stepper_name(const stepper *m);

/** Exits with CLI_USAGE if the method is not available in that arithmetic. */
void stepper_check(const stepper *m);

/** Calls run_length_remark_step() with the stable step of the method. */
void stepper_remark(const stepper *m, const spring_params *p, double dt);

/** Writes the method into the stamp of a table. */
void stepper_comment(const stepper *m, cli_table *table);

/** spring_advance() in the chosen arithmetic. */
spring_status stepper_advance(const stepper *m, spring_state *s, const spring_params *p, double dt, uint64_t n);

/** Takes n steps with the sum of the original study, y += (h/6) (k1 + 2 k2 + 2 k3 + k4), and reproduces it to the last
    digit. The library computes the same step from a polynomial, with other rounding errors. Works from stiffness/mass,
    damping/mass and load/mass, each rounded once, and does not check its parameters. */
void stages_advance(spring_state *s, const spring_params *p, double h, uint64_t n);

#endif
