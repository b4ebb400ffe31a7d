/* SPDX-License-Identifier: MIT */
/*
 * What the files of spring-bench share. bench_spring.c, bench_batch.c and bench_scene.c each know their rows: what is
 * timed, and beside what. spring_bench.c takes the samples and writes the table.
 */
#ifndef SPRINGSTEP_BENCH_H
#define SPRINGSTEP_BENCH_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include <springstep/spring.h>

enum { bench_most_limits = 2, bench_baseline = bench_most_limits + 1 };

typedef struct bench_row bench_row;

struct bench_row {
    const char *part;
    char kernel[48];
    const char *precision;
    uint64_t count, steps;      /* springs, or links; steps a call */
    double goal_ratio, goal_ns; /* [1], [ns]; INFINITY: none */
    double goal_speedup;        /* [1]; 0: none */
    const char
        *limits[bench_most_limits]; /* their names, NULL where there are fewer; the slowest one counts */
    const char *baseline;           /* its name; NULL: none */
    bool long_only;                 /* not with --quick */

    /* Makes so many calls of the kernel (which = 0), of limit number which or of the baseline (bench_baseline), and
       returns the time they take [ns]. */
    double (*time)(const bench_row *row, int which, uint64_t calls);
    const void *subject; /* what time() works from */
};

/** Put a row into the table. The row is copied, what it points to is not. */
void bench_add(const bench_row *row);

/* Each puts the rows of its part into the table. */
void bench_add_springs(void);
void bench_add_batches(void);
void bench_add_scenes(void);

/** The textbook formula of an underdamped spring; damped, loaded: say false where g, a are zero. */
spring_state bench_textbook(spring_state s, double w, double g, double a, double t, bool damped, bool loaded);

#endif
