/* SPDX-License-Identifier: MIT */
/*
 * The rows of spring-bench: what is timed, and what it is compared with. parts.h puts them into the table; spring_bench.c takes the
 * samples and writes it.
 */
#ifndef SPRINGSTEP_BENCH_ROWS_H
#define SPRINGSTEP_BENCH_ROWS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { bench_most_limits = 2, bench_baseline = bench_most_limits + 1 };

typedef struct bench_row bench_row;

struct bench_row {
    const char *part;
    char kernel[64];
    const char *precision;
    uint64_t count, steps;                 /* springs, or links; steps a call */
    double goal_ratio, goal_ns;            /* [1], [ns]; INFINITY: none */
    double goal_excess_ns;                 /* [ns] more than the limit, a step of all of them; 0: none */
    double goal_speedup;                   /* [1]; 0: none */
    const char *limits[bench_most_limits]; /* their names, NULL where there are fewer; the slowest one counts */
    const char *baseline;                  /* its name; NULL: none */
    bool long_only;                        /* not with --quick */

    /* Makes so many calls of the kernel (which = 0), of limit number which or of the baseline (bench_baseline), and
       returns the time they take [ns]. */
    double (*time)(const bench_row *row, int which, uint64_t calls);
    const void *subject; /* what time() works from */
};

/** Put a row and its subject, of so many bytes, into the table: both are copied. */
void bench_add(const bench_row *row, const void *subject, size_t bytes);

/** The rows so far; the names of their kernels, each once, ended by NULL. */
const bench_row *bench_rows(size_t *count);
extern const char *bench_kernels[];

#endif
