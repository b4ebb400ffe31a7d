/* SPDX-License-Identifier: MIT */
/* The table of spring-validate: a row for each check. */
#ifndef VALIDATE_ROWS_H
#define VALIDATE_ROWS_H

#include <stdbool.h>
#include <stdint.h>

#include "common/cli.h"

typedef struct validate_row {
    const char *of, *method, *reference, *reason;
    double dt;
    uint64_t steps;
    double error, bound, uncertainty;
    uint64_t evaluations;
    bool scene;
} validate_row;

/* The table that rows are written to from now on. */
void validate_into(cli_table *table);

/* Write a row with its verdict. */
void validate_check(const validate_row *row);

/* How many of them failed. */
unsigned validate_failures(void);

#endif
