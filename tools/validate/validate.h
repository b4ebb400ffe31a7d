/* SPDX-License-Identifier: MIT */
/* What the two parts of spring-validate share: one row of its table. */
#ifndef VALIDATE_H
#define VALIDATE_H

#include <stdbool.h>
#include <stdint.h>

#include "harness/ode.h"
#include "harness/scenes.h"

typedef struct finding {
    const char *of, *method, *witness, *reason;
    double dt;
    uint64_t steps;
    double error, bound, uncertainty;
    uint64_t evaluations;
    bool scene;
} finding;

void judge(const finding *f); /* writes the row */

/* CVODE with Adams' methods or BDF, as the adaptive solvers of ode.h are called. */
const char *adams(ode *o, double *y, double duration, double tolerance);
const char *bdf(ode *o, double *y, double duration, double tolerance);

void validate_scene(const scene_case *c);

#endif
