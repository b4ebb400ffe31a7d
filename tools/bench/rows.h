/* SPDX-License-Identifier: MIT */
/*
 * The rows of spring-bench: timed kernels and their comparisons, and their samples.
 *
 * Method    A sample is the time of a fixed number of calls. Samples of the library and of its comparisons alternate,
 *           so that temporary slowdowns of the machine affect all of them. Each result is the median of its samples. If
 *           there are two limits, the slower one counts. Samples are processor time, so other processes affect them
 *           only through caches and memory bandwidth.
 */
#ifndef SPRINGSTEP_BENCH_ROWS_H
#define SPRINGSTEP_BENCH_ROWS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/spring.h>

enum { bench_most_limits = 2, bench_baseline = bench_most_limits + 1 };

typedef struct bench_row bench_row;

struct bench_row {
    const char *part;
    char kernel[64];
    const char *precision;
    uint64_t count, steps;                 /* springs or links; steps per call */
    double goal_ratio, goal_ns;            /* [1], [ns]; INFINITY: none */
    double goal_excess_ns;                 /* [ns] above the limit, per step of all springs or links; 0: none */
    double goal_speedup;                   /* [1]; 0: none */
    const char *limits[bench_most_limits]; /* names, padded with NULL; the slowest limit counts */
    const char *baseline;                  /* name; NULL: none */
    bool long_only;                        /* not with --quick */

    /* Makes `calls` calls of the kernel (which = 0), of limit number `which` or of the baseline (bench_baseline).
       Returns their time [ns]. */
    double (*time)(const bench_row *row, int which, uint64_t calls);
    const void *subject; /* for time() */
};

/** Adds copies of a row and of its subject of `bytes` bytes to the table. */
void bench_add(const bench_row *row, const void *subject, size_t bytes);

/* Each function adds the rows of its part to the table. */
void bench_add_springs(void);
void bench_add_batches(void);
void bench_add_scenes(void);
void bench_add_small_scenes(void);

/** The textbook formula of a spring that is not critically damped; `damped`, `loaded` are false if g, a are zero. */
spring_state bench_textbook(spring_state s, double w, double g, double a, double t, bool damped, bool loaded);

/* samples.c; spring-engines uses it, too */

typedef struct bench_times {
    double ours, limit, baseline; /* [ns] per spring, or link, and step; NAN: there is none */
    const char *limit_name;       /* the slower limit */
    double spread;                /* interquartile range over median, the largest of the three */
} bench_times;

/** Measures a row; quick: with fewer and shorter samples. */
bench_times bench_measure(const bench_row *row, bool quick);

/** Returns true if the spread is so large that the row is inconclusive, because the machine was busy. */
bool bench_is_noisy(double spread);

#endif
