/* SPDX-License-Identifier: MIT */
/* What tools that measure time share: the clock, and the stamp that says where and when. */
#ifndef SPRINGSTEP_TIMING_H
#define SPRINGSTEP_TIMING_H

#include "common/cli.h"

double timing_now(void);  /* [ns], from a clock that only runs forward */
double timing_busy(void); /* [ns] this process has had of the processors: those of other processes do not count */

/** Stamp a table with the compiler's flags, the processor, its load and the date. */
void timing_stamp(cli_table *table);

#endif
