/* SPDX-License-Identifier: MIT */
/* The rows of spring-bench; see rows.h. */
#include "rows.h"

#include <stdlib.h>
#include <string.h>

#include "common/cli.h"

enum { most_rows = 512 };
static bench_row rows[most_rows];
static size_t row_count;
const char *bench_kernels[most_rows + 1];

void bench_add(const bench_row *row, const void *subject, size_t bytes)
{
    void *kept = malloc(bytes);
    if (kept == NULL || row_count == most_rows)
        cli_fail(CLI_FAILED, "no room for more than %zu rows", row_count);
    memcpy(kept, subject, bytes);
    rows[row_count] = *row;
    rows[row_count].subject = kept;
    int k = 0;
    while (bench_kernels[k] != NULL && strcmp(bench_kernels[k], row->kernel) != 0)
        k++;
    bench_kernels[k] = rows[row_count++].kernel;
}

const bench_row *bench_rows(size_t *count)
{
    *count = row_count;
    return rows;
}
