/* SPDX-License-Identifier: MIT */
/*
 * Timing of a row of rows.h.
 *
 * Method    A sample is the time of a fixed number of calls. Samples of the library and of its comparisons alternate,
 *           so that temporary slowdowns of the machine affect all of them. Each result is the median of its samples. If
 *           there are two limits, the slower one counts. Samples are processor time, so other processes affect them
 *           only through caches and memory bandwidth.
 */
#ifndef SPRINGSTEP_BENCH_SAMPLES_H
#define SPRINGSTEP_BENCH_SAMPLES_H

#include "rows.h"

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
