/* SPDX-License-Identifier: MIT */
/* The energy that motion gains with steps near the stable step. */
#ifndef SPRINGSTEP_WORK_STEPS_H
#define SPRINGSTEP_WORK_STEPS_H

#include <stdbool.h>

#include "common/cli.h"

extern const char steps_columns[];

/** Runs all motions with steps of several fractions of the stable step, and writes a row for each. */
void steps_write(cli_table *table, bool quick);

#endif
