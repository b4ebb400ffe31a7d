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

/* Sets the table for the following rows. */
void validate_into(cli_table *table);

/* Writes a row with its verdict. */
void validate_check(const validate_row *row);

/* The number of failed rows. */
unsigned validate_failures(void);

#endif
