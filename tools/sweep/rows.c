/* SPDX-License-Identifier: MIT */
/* The rows of a sweep as text; see rows.h. */
#define _POSIX_C_SOURCE 200809L /* open_memstream() */
#include "sweep/rows.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void grid_columns(const grid *g, char *text, size_t size)
{
    FILE *out = fmemopen(text, size, "w");
    for (size_t i = 0; out != NULL && i < g->axes; i++)
        fprintf(out, "%s\t", sweep_parameters[g->axis[i].parameter].column);
    if (out == NULL)
        return;
    fputs("method\terror\tenergy_error\tstatus", out);
    for (size_t i = 0; i < g->measures; i++)
        fprintf(out, "\t%s", sweep_measure_names[g->measure[i]]);
    fputc('\n', out);
    fclose(out);
}

/* Prints NaN without sign, because the sign of 0/0 differs between processors. */
static void print_number(FILE *out, double x)
{
    if (isnan(x))
        fputs("nan", out);
    else
        fprintf(out, "%.17g", x);
}

static bool print_rows(FILE *out, const grid *g, sweep_memory *memory, uint64_t point)
{
    double value[SWEEP_PARAMETERS];
    sweep_result results[SPRING_METHOD_COUNT];
    if (!grid_measure(g, memory, point, 1, value, results))
        return false;
    for (size_t k = 0; k < g->methods; k++) {
        const sweep_result *r = &results[k];
        for (size_t i = 0; i < g->axes; i++)
            fprintf(out, "%.17g\t", value[i]);
        fprintf(out, "%s\t", spring_method_name(g->method[k]));
        print_number(out, r->number[SWEEP_ERROR]);
        fputc('\t', out);
        print_number(out, r->number[SWEEP_ENERGY_ERROR]);
        fprintf(out, "\t%s", sweep_status_names[r->status]);
        for (size_t i = 0; i < g->measures; i++) {
            fputc('\t', out);
            print_number(out, r->number[g->measure[i]]);
        }
        fputc('\n', out);
    }
    return true;
}

char *grid_block(const grid *g, sweep_memory *memory, uint64_t block, size_t *length)
{
    char *text = NULL;
    FILE *out = open_memstream(&text, length);
    if (out == NULL)
        return NULL;
    const uint64_t first = block * g->points_of_block, count = grid_block_size(g, block);
    bool done = true;
    for (uint64_t i = 0; i < count && done; i++)
        done = print_rows(out, g, memory, first + i);
    if (fclose(out) == 0 && done)
        return text;
    free(text);
    return NULL;
}
