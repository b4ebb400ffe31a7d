/* SPDX-License-Identifier: MIT */
/* The rows of a sweep as text. Nothing here prints or ends the program. */
#ifndef SPRINGSTEP_SWEEP_ROWS_H
#define SPRINGSTEP_SWEEP_ROWS_H

#include "sweep/grid.h"

/** Writes the names of the columns, separated by tabs, and "\n"; at most `size` characters. */
void grid_columns(const grid *g, char *text, size_t size);

/** Returns the rows of a block as text; release it with free(). NULL: out of memory. */
char *grid_block(const grid *g, sweep_memory *memory, uint64_t block, size_t *length);

#endif
