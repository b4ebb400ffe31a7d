/* SPDX-License-Identifier: MIT */
/* The samples of rows; see rows.h. */
#include "rows.h"

#include <stdlib.h>

#include "common/timing.h"

enum { most_samples = 51, timed = bench_baseline + 1 }; /* the kernel, its limits, the baseline */

/* The number of calls that fill this time. */
static uint64_t calls_for(const bench_row *r, int which, double time_ns)
{
    uint64_t n = 1;
    while (r->time(r, which, n) < time_ns)
        n *= 2;
    return n;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct figure {
    double median, spread;
} figure;

static figure summarise(double *samples, size_t count)
{
    qsort(samples, count, sizeof *samples, ascending);
    const double median = samples[count / 2];
    return (figure){median, (samples[count - 1 - count / 4] - samples[count / 4]) / median};
}

bench_times bench_measure(const bench_row *r, bool quick)
{
    const double sample_ns = quick ? 2.5e5 : 2e6, row_ns = quick ? 1e7 : 1.25e8;
    const size_t few = 3, least = quick ? few : 11, most = quick ? 7 : most_samples;
    bool is_used[timed] = {true, [bench_baseline] = r->baseline != NULL};
    for (int k = 0; k < bench_most_limits; k++)
        is_used[1 + k] = r->limits[k] != NULL;
    double samples[timed][most_samples];
    uint64_t n[timed];
    for (int k = 0; k < timed; k++)
        n[k] = is_used[k] ? calls_for(r, k, sample_ns) : 0;
    size_t count = 0;
    const double begin = timing_now();
    for (double spent = 0; count < few || (count < least && spent < 5 * row_ns) || (count < most && spent < row_ns);
         spent = timing_now() - begin) {
        for (int k = 0; k < timed; k++)
            if (is_used[k])
                samples[k][count] = r->time(r, k, n[k]) / (double)n[k] / (double)r->count / (double)r->steps;
        count++;
    }
    figure figures[timed];
    for (int k = 0; k < timed; k++)
        figures[k] = is_used[k] ? summarise(samples[k], count) : (figure){NAN, 0};
    int slowest = 1;
    for (int k = 2; k <= bench_most_limits; k++)
        if (figures[k].median > figures[slowest].median)
            slowest = k;
    const figure ours = figures[0], limit = figures[slowest], baseline = figures[bench_baseline];
    return (bench_times){
        .ours = ours.median,
        .limit = limit.median,
        .baseline = baseline.median,
        .limit_name = r->limits[slowest - 1],
        .spread = fmax(fmax(ours.spread, limit.spread), baseline.spread),
    };
}

bool bench_is_noisy(double spread)
{
    return !(spread <= 0.05); /* also in the help text */
}
