/* SPDX-License-Identifier: MIT */
/* The clock of tools that measure time, and a stamp with host and date. */
#ifndef SPRINGSTEP_TIMING_H
#define SPRINGSTEP_TIMING_H

#include "common/cli.h"

double timing_now(void);  /* [ns], from a monotonic clock */
double timing_busy(void); /* [ns] of processor time that this process has used */

/** Writes the compiler's flags, the processor, its load and the date into the stamp of a table. */
void timing_stamp(cli_table *table);

#endif
