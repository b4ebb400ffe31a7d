/* SPDX-License-Identifier: MIT */
/* The parts of spring-validate: the rows of its table, one for each check, and the checks of scenes. */
#ifndef VALIDATE_ROWS_H
#define VALIDATE_ROWS_H

#include <stdbool.h>
#include <stdint.h>

#include "harness/scenes.h"

typedef struct validate_row {
    const char *of, *method, *reference, *reason;
    double dt;
    uint64_t steps;
    double error, bound, uncertainty;
    uint64_t evaluations;
    bool scene;
} validate_row;

/* Writes a row with its verdict. */
void validate_check(const validate_row *row);

/* Checks a scene with every method against all its references. */
void validate_scene(const scene_case *c);

#endif
