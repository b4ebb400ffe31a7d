/* SPDX-License-Identifier: MIT */
/*
 * How long what is in a row of rows.h takes.
 *
 * Method    A sample is the time of a fixed number of calls. Samples of the library and of what they are compared with
 *           alternate, so that what slows the machine down for a while slows all of them; each figure is the median of
 *           its samples. Of two limits the slower one counts: nothing can be faster than either. Processor time is what
 *           is measured: other processes take part of the caches and of the memory's time, but not of the clock's.
 */
#ifndef SPRINGSTEP_BENCH_SAMPLES_H
#define SPRINGSTEP_BENCH_SAMPLES_H

#include "rows.h"

typedef struct bench_times {
    double ours, limit, baseline; /* [ns] per spring, or link, and step; NAN: there is none */
    const char *limit_name;       /* of the slower limit */
    double spread;                /* the distance between the quartiles over the median, the largest of the three */
} bench_times;

/** Measure a row; quick: by fewer and shorter samples. */
bench_times bench_measure(const bench_row *row, bool quick);

/** Of a spread: was the machine busy, and the row proves nothing? */
bool bench_is_noisy(double spread);

#endif
