/* SPDX-License-Identifier: MIT */
/*
 * spring-bench: what a step of a spring costs, compared with a limit that is measured in the same run; samples.h says how.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/timing.h"
#include "parts.h"
#include "samples.h"

static const char *const parts[] = {"spring", "batch", "scene", "small", NULL}, *const precisions[] = {"double",
                                                                                                       "float", NULL};
static int only_part = -1, only_kernel = -1, only_precision = -1;
static uint64_t only_count, calls;
static bool quick;

static const cli_option options[] = {
    {"part", CLI_CHOICE, .choice = &only_part, .choices = parts, .value = "PART",
     .help = "spring (one at a time), batch, scene or small"},
    {"kernel", CLI_CHOICE, .choice = &only_kernel, .choices = bench_kernels, .value = "NAME",
     .help = "only the rows of this name"},
    {"precision", CLI_CHOICE, .choice = &only_precision, .choices = precisions, .value = "P",
     .help = "double or float"},
    {"count", CLI_COUNT, .count = &only_count, .least = 1, .value = "N",
     .help = "only rows of so many springs, or links"},
    {"calls", CLI_COUNT, .count = &calls, .least = 1, .value = "N",
     .help = "only make so many calls, for tools that count instructions"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer and shorter samples: a few seconds in all"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-bench",
    .summary = "What a step of a spring costs, compared with a limit measured in the same run.",
    .details =
        "What tells most are two ratios of times in the same run: speedup, how many times as fast as a\n"
        "plain loop the library is (nan: there is none), and ratio, its time over that of a limit. Goals\n"
        "are what the library promises: goal_speedup (0: nothing), goal_ratio and goal_ns (inf:\n"
        "nothing), goal_excess_ns (0: nothing).\n\n"
        "Part spring: METHOD is spring_advance() over many steps, METHOD_call a loop of calls of\n"
        "the kernel, METHOD_advance_1 of spring_advance() by one step; _damped, _loaded: with\n"
        "damping, with load. Limit \"loop\": the same steps written out in a loop, in registers:\n"
        "Euler; kick, drift, kick; the four stages of rk4. \"kicks\", of other methods: one kick and\n"
        "one drift for each force evaluation. \"textbook\": its formula, by exp, cos and sin, or cosh\n"
        "and sinh. leapfrog_denormal starts from 1e-310 m; its limit,\n"
        "\"ordinary\", is leapfrog from an ordinary start.\n\n"
        "Part batch: METHOD_batch_N is spring_batch_advance() by N steps a call, omega2 an array;\n"
        "_shared_X, _own_X, _zero_X: with X shared, an array, an array of zeros; _settled: from\n"
        "1e-310 m (float: 1e-41); _mixed: every second spring overdamped; _unaligned: arrays that\n"
        "begin 8 bytes after a multiple of 64.\n"
        "Limits, in vectors as wide as the library's: \"streams\" reads and writes the same arrays,\n"
        "does no arithmetic, and its time is shared out among the steps of a call; \"arithmetic\"\n"
        "does the multiplications and additions of a step in registers, with coefficients that are\n"
        "there: those of leapfrog, rk4 and the exact solution; of other methods those of one kick and\n"
        "one drift, which no step can do without.\n"
        "The slower one is the limit: streams for one step, arithmetic for many. For own\n"
        "parameters of the exact solution it is the textbook's formula; for settled and unaligned,\n"
        "the same kernel without that.\n\n"
        "Part scene: METHOD_SHAPE_N is spring_scene_advance() by N steps a call: a rope, a sheet or a\n"
        "block of jelly with structural, shear and bend links, or water, a height field; with gravity\n"
        "and pinned edges. _links_shuffled: links in random order; _shuffled: particles numbered at\n"
        "random, too; _renumbered: that after spring_links_renumber(), whose limit is the plain loop\n"
        "before, \"shuffled_list\". The plain loop is that over an array of links and one of particles, with a\n"
        "division and a square root a link, compiled with -O2. Limits: \"streams\" reads and writes the\n"
        "state and reads forces and links; \"arithmetic\" does that of the links, each once, in\n"
        "registers. float's limit is the same scene in double; that of a feature (_drag, _damping, ...)\n"
        "or of another method is \"leapfrog\" without it; that of a rope by one step a call,\n"
        "\"16_steps\" a call. init_SHAPE is spring_scene_init(), and renumber_SHAPE the call\n"
        "that orders its links, compared with reading the links of a definition. Goals that depend on the width of "
        "vectors are those of this processor's.\n\n"
        "Part small: METHOD_SCENE is spring_scene_advance() of one to six particles. Figures are per force\n"
        "evaluation, count is that of evaluations per step. Limits: \"written_out\" is the same method in C\n"
        "for this one scene; \"callback\" is the callback alone.\n\n"
        "Figures are medians of samples, in processor time, that alternate with those of the\n"
        "limit. spread is the distance between the quartiles over the median, the larger one of\n"
        "kernel, limit and baseline. verdict is ok, noisy (spread above 0.05: the machine was busy, the\n"
        "row proves nothing) or above_goal. No verdict changes the exit status: time is for people to\n"
        "judge.",
    .columns = "kernel precision count ns_per_spring_step limit_ns ratio spread verdict goal_ratio goal_ns limit "
               "baseline_ns speedup goal_speedup step_ns goal_excess_ns",
    .meaning = "count is that of springs, or of links of a scene; limit is the name of the limit, baseline_ns the\n"
               "time of the plain loop, step_ns that of a step of all springs or links, goal_excess_ns how much\n"
               "longer than with the limit that may take.",
    .shown = {"count", "ns_per_spring_step"},
    .examples = {"--quick --part spring", "--quick --kernel leapfrog_batch_1",
                 "--quick --part batch --count 1000 -o bench.tsv"},
    .options = options,
};

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
           (only_kernel < 0 || strcmp(bench_kernels[only_kernel], r->kernel) == 0) && !(quick && r->long_only) &&
           (only_precision < 0 || strcmp(precisions[only_precision], r->precision) == 0) &&
           (only_count == 0 || only_count == r->count);
}

static void check_any_wanted(void)
{
    size_t count;
    const bench_row *rows = bench_rows(&count);
    for (const bench_row *r = rows; r < rows + count; r++)
        if (wanted(r))
            return;
    cli_fail(CLI_USAGE, "no row is of all that --part, --kernel, --precision and --count ask for%s",
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
    size_t count;
    const bench_row *rows = bench_rows(&count);
    for (const bench_row *r = rows; r < rows + count; r++) {
        cli_progress((double)(r - rows) / (double)count);
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
