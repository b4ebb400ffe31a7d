/* SPDX-License-Identifier: MIT */
/*
 * spring-bench: the cost of a step of a spring, compared with limits measured in the same run. See rows.h for the
 * method.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/timing.h"
#include "rows.h"

enum { most_rows = 512 };
static bench_row rows[most_rows];
static size_t row_count;
static const char *kernels[most_rows + 1]; /* distinct names, ended by NULL */

static const char *const parts[] = {"spring", "batch", "scene", "small", NULL}, *const precisions[] = {"double",
                                                                                                       "float", NULL};
static int only_part = -1, only_kernel = -1, only_precision = -1;
static uint64_t only_count, calls;
static bool quick;

static const cli_option options[] = {
    {"part", CLI_CHOICE, .choice = &only_part, .choices = parts, .value = "PART",
     .help = "spring (one spring), batch, scene or small"},
    {"kernel", CLI_CHOICE, .choice = &only_kernel, .choices = kernels, .value = "NAME",
     .help = "only the rows with this name"},
    {"precision", CLI_CHOICE, .choice = &only_precision, .choices = precisions, .value = "P",
     .help = "double or float"},
    {"count", CLI_COUNT, .count = &only_count, .least = 1, .value = "N",
     .help = "only rows with this number of springs or links"},
    {"calls", CLI_COUNT, .count = &calls, .least = 1, .value = "N",
     .help = "make only N calls, for tools that count instructions"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer and shorter samples; takes a few seconds"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-bench",
    .summary = "Measure the cost of a step, compared with a limit measured in the same run.",
    .details =
        "Two ratios of times in the same run are the most important. speedup is the time of a plain loop over\n"
        "the time of the library (nan: no plain loop). ratio is the time of the library over the time of a\n"
        "limit. The goals are goal_speedup and goal_excess_ns (0: no goal), and goal_ratio and goal_ns (inf:\n"
        "no goal).\n\n"
        "Part spring: METHOD is spring_advance() over many steps. exact_call is a loop of calls of the kernel.\n"
        "The limit \"loop\" is a hand-written loop over the same steps, in registers: Euler; kick, drift, kick;\n"
        "the four stages of rk4. The limit \"kicks\", for other methods, is one kick and one drift for each\n"
        "force evaluation. The limit \"textbook\" is the formula of the exact solution, with exp, cos and sin, or\n"
        "cosh and sinh. leapfrog_denormal starts from 1e-310 m. Its limit, \"ordinary\", is leapfrog from an\n"
        "ordinary start.\n\n"
        "Part batch: METHOD_batch_N is spring_batch_advance() with N steps per call, and omega2 is an array.\n"
        "In _shared_X, _own_X and _zero_X, X is shared, an array, and an array of zeros. _settled starts from\n"
        "1e-310 m. In _mixed, every second spring is overdamped. In _unaligned, arrays begin 8\n"
        "bytes after a multiple of 64. The limits use SIMD vectors as wide as the library's. \"streams\" reads\n"
        "and writes the same arrays without arithmetic, and its time is divided by the number of steps per\n"
        "call. \"arithmetic\" does the multiplications and additions of a step in registers, with given\n"
        "coefficients: a full step of leapfrog, rk4 and the exact solution, and for other methods one kick\n"
        "and one drift, which every step needs. The slower one is the limit: streams for one step, arithmetic\n"
        "for many. For own parameters of the exact solution, the limit is the textbook formula. For _settled\n"
        "and _unaligned, it is the same kernel without this property.\n\n"
        "Part scene: METHOD_SHAPE_N is spring_scene_advance() with N steps per call: a rope, a sheet or a\n"
        "block of jelly with structural, shear and bend springs, or water, a height field, with gravity and\n"
        "pinned edges. In _links_shuffled, links are in random order. In _shuffled, particles are also\n"
        "numbered at random. The plain loop is a loop over an array of links and one over an array of\n"
        "particles, with a division and a square root per link, compiled with -O2. Limits: \"streams\" reads\n"
        "and writes the state, and reads forces and links. \"arithmetic\" does the arithmetic of the links, once\n"
        "per link, in registers. The limit of float is the same scene in double. The limit of a feature (_drag,\n"
        "_damping, ...) or of another method is \"leapfrog\" without it. The limit of a rope with one step per\n"
        "call is \"16_steps\" per call. init_sheet is spring_scene_init(). Its limit is reading the links of a\n"
        "definition. Goals that depend on the vector width are for this processor.\n\n"
        "Part small: METHOD_SCENE is spring_scene_advance() for one to six particles. Times are per force\n"
        "evaluation, and count is the number of evaluations per step. Limits: \"written_out\" is the same\n"
        "method, hand-written in C for this scene. \"callback\" is the callback alone.\n\n"
        "Times are medians of samples of processor time, which alternate with samples of the limit. spread is\n"
        "the distance between the quartiles over the median, the largest of kernel, limit and baseline.\n"
        "verdict is ok, noisy (spread above 0.05: the machine was busy, and the row proves nothing) or\n"
        "above_goal. The exit status does not depend on the verdict.",
    .columns = "kernel precision count ns_per_spring_step limit_ns ratio spread verdict goal_ratio goal_ns limit "
               "baseline_ns speedup goal_speedup step_ns goal_excess_ns",
    .meaning = "count is the number of springs, or of links of a scene. limit is the name of the limit. baseline_ns\n"
               "is the time of the plain loop. step_ns is the time of a step of all springs or links. goal_excess_ns\n"
               "is the longest time by which step_ns may exceed the limit.",
    .shown = {"count", "ns_per_spring_step"},
    .examples = {"--quick --part spring", "--quick --kernel leapfrog_batch_1",
                 "--quick --part batch --count 1000 -o bench.tsv"},
    .options = options,
};

void bench_add(const bench_row *row, const void *subject, size_t bytes)
{
    void *kept = malloc(bytes);
    if (kept == NULL || row_count == most_rows)
        cli_fail(CLI_FAILED, "no room for more than %zu rows", row_count);
    rows[row_count] = *row;
    rows[row_count].subject = memcpy(kept, subject, bytes);
    int k = 0;
    while (kernels[k] != NULL && strcmp(kernels[k], row->kernel) != 0)
        k++;
    kernels[k] = rows[row_count++].kernel;
}

static void write_row(cli_table *table, const bench_row *r)
{
    const bench_times t = bench_measure(r, quick);
    const double ratio = t.ours / t.limit, speedup = t.baseline / t.ours;
    const double step_ns = t.ours * (double)r->count, excess = step_ns - t.limit * (double)r->count;
    const bool holds = ratio <= r->goal_ratio && t.ours <= r->goal_ns && !(speedup < r->goal_speedup) &&
                       (r->goal_excess_ns == 0 || excess <= r->goal_excess_ns);
    cli_row(table, "%s\t%s\t%" PRIu64 "\t%.4g\t%.4g\t%.4g\t%.2g\t%s\t%.4g\t%.4g\t%s\t%.4g\t%.4g\t%.4g\t%.4g\t%.4g",
            r->kernel, r->precision, r->count, t.ours, t.limit, ratio, t.spread,
            bench_is_noisy(t.spread) ? "noisy"
            : holds                  ? "ok"
                                     : "above_goal",
            r->goal_ratio, r->goal_ns, t.limit_name, t.baseline, speedup, r->goal_speedup, step_ns, r->goal_excess_ns);
}

/* ------------------------------------------------------------------------------------------------------ the table */

static bool wanted(const bench_row *r)
{
    return (only_part < 0 || strcmp(parts[only_part], r->part) == 0) &&
           (only_kernel < 0 || strcmp(kernels[only_kernel], r->kernel) == 0) && !(quick && r->long_only) &&
           (only_precision < 0 || strcmp(precisions[only_precision], r->precision) == 0) &&
           (only_count == 0 || only_count == r->count);
}

static void check_any_wanted(void)
{
    for (const bench_row *r = rows; r < rows + row_count; r++)
        if (wanted(r))
            return;
    cli_fail(CLI_USAGE, "no row matches --part, --kernel, --precision and --count%s",
             quick ? "; --quick leaves some out" : "");
}

int main(int argc, char **argv)
{
    bench_add_springs();
    bench_add_batches();
    bench_add_scenes();
    bench_add_small_scenes();
    cli_parse(&program, argc, argv);
    check_any_wanted();
    cli_table *table = cli_open_output();
    timing_stamp(table);
    cli_columns(table, program.columns);
    for (const bench_row *r = rows; r < rows + row_count; r++) {
        cli_progress((double)(r - rows) / (double)row_count);
        if (!wanted(r))
            continue;
        if (calls > 0)
            r->time(r, 0, calls);
        else
            write_row(table, r);
    }
    cli_finish();
    return 0;
}
