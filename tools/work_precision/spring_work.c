/* SPDX-License-Identifier: MIT */
/*
 * spring-work: error versus time (work-precision data) for every step method of the library and for GSL, SUNDIALS and
 * Boost.odeint on the same problems.
 *
 * Method    A run is repeated in a loop that is long enough to time (a fifth of a millisecond), and the loop five
 *           times; the shortest time counts. A run of more than 10 ms is repeated once, and a run of more than 50 ms is
 *           not repeated. Solvers are called as their manuals recommend and produce no output while they are timed. All
 *           external solvers evaluate the same right-hand side. The setup of solvers and scenes is not timed.
 * Error     |(x, v/omega) - exact| at the end, relative to the size of the motion; see work_problems.c.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/timing.h"
#include "order/equal_error.h"
#include "work.h"
#include "work_cape.h"
#include "work_steps.h"

/* -------------------------------------------------------------------------------------------- the command line */

enum { MOST_PROBLEMS = 32, MOST_ROWS = 4096 }; /* rows of one problem */

static const char *problem_names[MOST_PROBLEMS + 1]; /* ended by NULL */
static int only_problem = -1;
static bool quick;
static const char *table_file, *forces_file, *long_file;

static const cli_option options[] = {
    {"problem", CLI_CHOICE, .choice = &only_problem, .choices = problem_names, .value = "NAME",
     .help = "only this problem"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer and shorter runs"},
    {"table", CLI_FILE, .file = &table_file, .value = "FILE",
     .help = "also write the cheapest stepper and external solver for each error"},
    {"forces", CLI_FILE, .file = &forces_file, .value = "FILE",
     .help = "also write the time of one force evaluation for each problem"},
    {"long", CLI_FILE, .file = &long_file, .value = "FILE",
     .help = "also write errors and observables of long runs of stiff scenes"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-work",
    .summary = "Measure time and error of every stepper and of GSL, SUNDIALS and odeint.",
    .details =
        "Problems: seed-1000s is the long run of the original study, with m = k = 1. Other springs have m =\n"
        "1.3 kg and k = 2.7 N/m. stiff-cloth (32 x 32 particles, hangs by two corners), stiff-rope (32\n"
        "particles, the last one a hundred times as heavy) and damped-cloth (16 x 16 particles) have\n"
        "sqrt(L)/60 Hz = 50, where L is the bound of spring_scene_stable_step(). damped-cloth also has\n"
        "damping/mass/60 Hz = 100.\n\n"
        "Solvers: rk4-stages evaluates the four stages one by one. exact is one formula for any duration and\n"
        "evaluates no forces. leapfrog-softened lowers the stiffness until the step is 0.95 of the stable\n"
        "step. xpbd takes substeps of one iteration over all links, as game engines do. bdf2-cg is backward\n"
        "differentiation of order 2 with one linearisation per step and preconditioned conjugate gradients.\n"
        "projective is projective dynamics with a prefactored matrix and one iteration per step, for undamped\n"
        "links. leapfrog-softened, xpbd, bdf2-cg and projective run only scenes of distance springs in space.\n"
        "cvode-bdf2 is CVODE's BDF of order 2 at most, with 30 Krylov vectors. gsl-rk4 uses step doubling, "
        "which is counted.\n"
        "odeint-rkf78, odeint-bulirsch-stoer and odeint-sb3a-m4 are available if Boost was found at build\n"
        "time, arkode-sprk6 with SUNDIALS 6.6 or later. odeint-sb3a-m4 and arkode-sprk6 are symplectic, for\n"
        "problems without drag and damping. A run that explodes, or whose error is more than three times\n"
        "the size of the motion, has no row.\n\n"
        "cape and steps run only if they are chosen, and have other columns. cape: 20 x 30 particles hang on the "
        "shoulders of\n"
        "a figure of five capsules that runs, turns and hops for 60 s in wind, in frames of 8 to 40 ms. It\n"
        "stands still for the last 10 s. The links of leapfrog are as stiff as the fraction of the stable\n"
        "step allows; those of XPBD are rigid. xpbd-mesh has lists of links for each colour. xpbd-sheet is\n"
        "written for sheets only. steps: scenes are released at rest and run for a minute or longer, with steps\n"
        "of several fractions of the stable step.",
    .columns = "problem solver steps force_evaluations time_s error error_x effort tolerance energy_error uncertainty "
               "stretch stable_fraction",
    .meaning =
        "force_evaluations is known by definition for one spring with the library, and counted otherwise.\n"
        "time_s is the shortest of up to five loops, without setup. error is |(x, v/omega) - exact| relative\n"
        "to the size of the motion. error_x is |x - exact x| [m] (nan for scenes). effort is sweep (of steps\n"
        "or tolerances), seed (the number of steps of the original study), equal (the smallest number of\n"
        "steps from which on the error in x never exceeds the error of Euler with 10^7 steps) or crossing (the\n"
        "last number of evaluations for which leapfrog is ahead of RK4, and the next one). tolerance is 0 for\n"
        "fixed steps. energy_error is relative to the initial energy, or for a scene to the final kinetic\n"
        "energy (nan if a callback adds forces). uncertainty is the uncertainty of the exact final state of a\n"
        "scene. An error of up to five times this value is an upper bound, and is not resolved. stretch is\n"
        "the largest length/rest length of a link, minus 1. stable_fraction is the step divided by the stable step\n"
        "of the library (nan for other solvers).\n\n"
        "With --table: for each error, the cheapest measured row whose error, and the error of the next finer\n"
        "row if there is one, is not larger. solver, dt_s, time_s and steps are from the steppers, with steps\n"
        "below the stable step. peer and peer_time_s are from GSL, SUNDIALS and odeint. ratio is\n"
        "peer_time_s/time_s. exact_time_s is the time of the exact solution. nan means none.\n\n"
        "With --forces: time_ns is the time of one force evaluation. springstep is a step of leapfrog, or of\n"
        "symplectic Euler if links are damped, divided by its evaluations. others is the function that GSL,\n"
        "SUNDIALS and odeint call. xpbd is one substep. links is the number of links (1 for a spring). ratio\n"
        "is time_ns divided by time_ns of springstep.\n\n"
        "With --long: runs of stiff-cloth and stiff-rope over 10 s, with 1, 2, 4 ... 64 steps per frame of 1/60 s, "
        "and\n"
        "of CVODE's BDF with the tolerance 1e-2. (With --quick: 2 s, 1 and 32 steps, without CVODE.) frame_s is the\n"
        "time per frame. error_500ms, error_1s and error_2s are errors after these times. In row reference they are\n"
        "the differences between runs of GSL's rk8pd with 8000 and 16000 steps per second (2000 and 4000), from\n"
        "which all errors are measured. The motion is chaotic, so positions are not predictable after 2 s. The\n"
        "other columns are means over the second half: sag_m is the depth of the lowest particle, stretch of the\n"
        "longest link, stretch_99 the 99th percentile. energy_change is the change of energy in the whole run,\n"
        "relative to the mean potential energy that gravity released. Runs that change it by more than 100 times\n"
        "that have no row, and neither have runs of CVODE that take more than 2 s per second.\n\n"
        "The columns of cape: tethers is none, all, or rows (every seventh row, from the hem). fraction is\n"
        "dt divided by the stable step. damping_ratio is that of a link between two particles. effort is\n"
        "what is varied; no-figure has no figure. steps_per_frame are steps per 1/60 s, and time_us is the "
        "processor time per 1/60 s.\n"
        "column_stretch is the 99th percentile over all frames and columns of length/rest length, minus 1,\n"
        "and link_stretch that of the most stretched link along rows or columns. depth_m is the largest\n"
        "depth of a particle in the figure at the end of a frame, and kinetic_J the mean kinetic energy,\n"
        "both while the figure moves. jitter_mps is the root mean square of speeds in the last second. With\n"
        "--table: the time at a column stretch of 6 and 3 %, from a power law through the runs.\n\n"
        "The column of steps: energy_gain is the largest gain of energy, relative to the largest kinetic\n"
        "energy of the first two seconds.",
    .shown = {"time_s", "error"},
    .examples = {"--quick --problem ideal-1", "--quick --problem damped -o work.tsv",
                 "--quick --problem elastic-pendulum --table cheapest.tsv"},
    .options = options,
};

/* ---------------------------------------------------------------------------------------------------- the rows */

typedef struct work_row {
    const work_solver *solver;
    uint64_t steps;
    double time, error;
    double fraction; /* of the stable step; NaN: not a stepper */
} work_row;

static work_row rows[MOST_ROWS]; /* of the current problem */
static size_t row_count;

static void remember(const work_solver *s, uint64_t steps, double time, double error, double fraction)
{
    if (row_count == MOST_ROWS)
        cli_fail(CLI_FAILED, "more than %d rows of one problem", MOST_ROWS);
    rows[row_count++] = (work_row){s, steps, time, error, fraction};
}

/* The time of a run [s], the shortest of several loops. Long runs are interrupted by other processes, so they use the
   processor time, whose clock is too slow for short runs. */
static double time_of(work *w, const work_solver *s, work_effort e, double first, double *y)
{
    const double long_enough = 2e-4, long_run = 0.01, longer_run = 0.05, interrupted = 1e-3; /* [s] */
    const int loops = first > longer_run ? 0 : first > long_run ? 1 : 5; /* in addition to the first run */
    double best = first > long_run ? first : INFINITY;
    uint64_t runs = 1;
    w->clock = first > interrupted ? timing_busy : timing_now;
    for (int i = 0; i < loops; i++) {
        const double spent = work_run(w, s, e, runs, y).spent;
        best = fmin(best, spent / (double)runs);
        if (spent < long_enough) {
            runs *= 2;
            i = -1;
            best = INFINITY;
        }
    }
    return best;
}

/* The step of a stepper of the library, divided by its stable step. NaN for other solvers. */
static double stable_fraction(const work *w, const work_solver *s, uint64_t steps)
{
    if (s->side != WORK_STEPPER)
        return NAN;
    const bool scene = w->problem->kind == WORK_SCENE;
    const double stable =
        scene ? spring_scene_stable_step(w->fresh, s->method) : spring_stable_step(&w->problem->p, s->method);
    return w->duration / (double)steps / stable;
}

/* Writes a row if the run succeeded. Returns the time of the first run [s]. */
static double measure(cli_table *table, work *w, const work_solver *s, work_effort e, const char *why)
{
    double *y = scene_room(w->size, sizeof *y);
    w->clock = timing_busy;
    const work_result r = work_run(w, s, e, 1, y);
    const double error = work_error(w, y), lost = 3; /* opposite phase is an error of about 2 */
    if (r.failure == NULL && error <= lost) {
        const bool scene = w->problem->kind == WORK_SCENE;
        const uint64_t evaluations =
            scene && s->side == WORK_STEPPER ? work_count(w, s->method, e.steps) : r.evaluations;
        const double error_x = scene ? NAN : fabs(y[0] - w->exact[0]), energy_error = work_energy_error(w, y);
        const double time = time_of(w, s, e, r.spent, y), fraction = stable_fraction(w, s, r.steps);
        cli_row(table, "%s\t%s\t%" PRIu64 "\t%" PRIu64 "\t%.4g\t%.17g\t%.17g\t%s\t%.4g\t%.17g\t%.3g\t%.6g\t%.4g",
                w->problem->name, s->name, r.steps, evaluations, time, error, error_x, why, e.tolerance, energy_error,
                w->uncertainty, work_stretch(w, y), fraction);
        remember(s, r.steps, time, error, fraction);
    }
    free(y);
    return r.spent;
}

/* ------------------------------------------------------------------------------------------------- what is varied */

static double longest(const work *w)
{
    return w->problem->longest * (quick ? 0.04 : 1);
}

/* Returns true if the last row is of this external solver and has the smallest error of all external rows. */
static bool leads(const work_solver *s)
{
    if (row_count == 0 || rows[row_count - 1].solver != s || s->side != WORK_EXTERNAL)
        return false;
    for (size_t i = 0; i + 1 < row_count; i++)
        if (rows[i].solver->side == WORK_EXTERNAL && rows[i].error <= rows[row_count - 1].error)
            return false;
    return true;
}

/* Returns whether a sweep continues after a run of this time. External solvers get more time while they have the
   smallest error, so that small errors are compared as well, and if they are adaptive, since these are slow at any
   tolerance. */
static bool goes_on(const work *w, const work_solver *s, double spent)
{
    const double more = leads(s) ? 4 : s->adaptive != NULL ? 2 : 1;
    return spent <= more * longest(w);
}

static void sweep_steps(cli_table *table, work *w, const work_solver *s)
{
    const bool study = w->problem->kind == WORK_STUDY; /* the report needs its finest step */
    const double finest = quick && !study ? fmax(w->finest, w->duration / 2e6) : w->finest;
    const double most = rint(w->duration / finest), factor = quick ? 4 : sqrt(sqrt(2)); /* infinite for a scene */
    const bool any_step = s->side == WORK_XPBD || s->side == WORK_SOFTENED || s->side == WORK_IMPLICIT || w->damped;
    /* The longest stable step is measured unless that takes far longer. NaN or infinity: there is none. */
    const double stable = floor(stable_fraction(w, s, 1)) + 1, longer = 8;
    double n = ceil(any_step ? fmin(w->duration / w->coarsest, 60 * w->duration) : w->duration / w->coarsest),
           spent = 0;
    while (n < most * 0.999 && (goes_on(w, s, spent) || (n <= stable && spent <= longer * longest(w)))) {
        spent = measure(table, w, s, (work_effort){.steps = (uint64_t)n}, "sweep");
        const double next = ceil(n * factor);
        n = n < stable && stable < next ? stable : next;
    }
    if (goes_on(w, s, spent))
        measure(table, w, s, (work_effort){.steps = (uint64_t)most}, "sweep");
}

static void sweep_tolerances(cli_table *table, work *w, const work_solver *s)
{
    const double tightest = quick ? 1e-9 : 1e-14, factor = quick ? 100 : sqrt(10);
    double spent = 0;
    for (double tolerance = 1e-2; tolerance > 0.9 * tightest && goes_on(w, s, spent); tolerance /= factor)
        spent = measure(table, w, s, (work_effort){.tolerance = tolerance}, "sweep");
}

/* The comparison of the original study: the accuracy of 10^7 Euler steps, with the step numbers of the study and with
   those of equal_error_steps(). */
static void equal_error(cli_table *table, work *w)
{
    static const uint64_t of_the_study[SPRING_METHOD_COUNT] = {
        [SPRING_EULER] = 10000000, [SPRING_LEAPFROG] = 35000, [SPRING_RK4] = 3700};
    double y[2];
    work_run(w, work_solver_of(SPRING_EULER), (work_effort){.steps = of_the_study[SPRING_EULER]}, 1, y);
    const double error = fabs(y[0] - w->exact[0]);
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        const work_solver *s = work_solver_of(m);
        if (s->side != WORK_STEPPER || !work_applies(w, s))
            continue;
        const uint64_t found = m == SPRING_EULER ? of_the_study[m] : equal_error_steps(m, w->duration, error);
        if (of_the_study[m] > 0)
            measure(table, w, s, (work_effort){.steps = of_the_study[m]}, "seed");
        measure(table, w, s, (work_effort){.steps = found}, "equal");
    }
}

static double error_after(work *w, spring_method m, uint64_t steps)
{
    double y[2];
    work_run(w, work_solver_of(m), (work_effort){.steps = steps}, 1, y);
    return work_error(w, y);
}

/* Finds the least number of force evaluations, up to `most` per period, from which RK4 is more accurate. */
static void crossing(cli_table *table, work *w)
{
    const uint64_t least = 24 * w->problem->periods, most = 80 * w->problem->periods;
    uint64_t found = most + 4;
    while (found > least + 4 && error_after(w, SPRING_RK4, found / 4 - 1) < error_after(w, SPRING_LEAPFROG, found - 4))
        found -= 4;
    if (found > most)
        cli_fail(CLI_FAILED, "%s: RK4 should be ahead of leapfrog with %" PRIu64 " evaluations, but is not",
                 w->problem->name, most);
    for (uint64_t evaluations = found - 4; evaluations <= found; evaluations += 4) {
        measure(table, w, work_solver_of(SPRING_LEAPFROG), (work_effort){.steps = evaluations}, "crossing");
        measure(table, w, work_solver_of(SPRING_RK4), (work_effort){.steps = evaluations / 4}, "crossing");
    }
}

/* ---------------------------------------------------------------------------------------------------- the table */

/* Returns true if this row and the next finer one are within the error, since one small error can be accidental. */
static bool is_enough(size_t i, double error)
{
    const bool last = i + 1 == row_count || rows[i + 1].solver != rows[i].solver;
    return rows[i].error <= error && (last || rows[i + 1].error <= error);
}

/* Of the steppers of the library, with stable steps only: longer ones may be accurate at first and then explode. */
static const work_row *cheapest(work_side side, double error)
{
    const work_row *best = NULL;
    for (size_t i = 0; i < row_count; i++)
        if (rows[i].solver->side == side && is_enough(i, error) && !(rows[i].fraction >= 1) &&
            (best == NULL || rows[i].time < best->time))
            best = &rows[i];
    return best;
}

static double time_or_nan(const work_row *row)
{
    return row != NULL ? row->time : NAN;
}

static void write_levels(cli_table *table, const work *w)
{
    for (int power = 1; power <= 12; power++) {
        const double error = pow(10, -power);
        const work_row *ours = cheapest(WORK_STEPPER, error), *external = cheapest(WORK_EXTERNAL, error),
                       *exact = cheapest(WORK_EXACT, error);
        cli_row(table, "%s\t1e-%d\t%s\t%.4g\t%.4g\t%s\t%.4g\t%.4g\t%" PRIu64 "\t%.4g", w->problem->name, power,
                ours != NULL ? ours->solver->name : "none", ours != NULL ? w->duration / (double)ours->steps : NAN,
                time_or_nan(ours), external != NULL ? external->solver->name : "none", time_or_nan(external),
                time_or_nan(external) / time_or_nan(ours), ours != NULL ? ours->steps : 0, time_or_nan(exact));
    }
}

/* --------------------------------------------------------------------------------------------------- the forces */

typedef struct force_times {
    double ours, others, xpbd; /* [ns] */
} force_times;

/* Times loops of each in turn and takes the shortest, so that interruptions and clock rates affect all equally. */
static force_times time_forces(work *w)
{
    /* Leapfrog treats heavy damping separately from other forces. */
    const spring_method m = w->damped ? SPRING_SYMPLECTIC_EULER : SPRING_LEAPFROG;
    const int loops = quick ? 10 : 50;
    const bool scene = w->problem->kind == WORK_SCENE;
    const uint64_t n = w->size > 100 ? 50 : 5000, ours = scene ? work_count(w, m, n) : n;
    double *y = scene_room(w->size, sizeof *y), *dy = scene_room(w->size, sizeof *dy);
    force_times t = {INFINITY, INFINITY, w->xpbd != NULL ? INFINITY : NAN};
    const double duration = w->duration;
    w->clock = timing_now;
    w->duration = fmin(duration, (double)n * w->coarsest / 20); /* stable */
    for (int i = 0; i < loops; i++) {
        t.ours =
            fmin(t.ours, 1e9 * work_run(w, work_solver_of(m), (work_effort){.steps = n}, 1, y).spent / (double)ours);
        const double begin = timing_now();
        for (uint64_t k = 0; k < n; k++)
            w->derivative(0, w->start, dy, w->data);
        t.others = fmin(t.others, (timing_now() - begin) / (double)n);
        if (w->xpbd != NULL) {
            work_xpbd_start(w->xpbd, &w->scene, w->duration / (double)n);
            const double start = timing_now();
            work_xpbd_advance(w->xpbd, n);
            t.xpbd = fmin(t.xpbd, (timing_now() - start) / (double)n);
        }
    }
    w->duration = duration;
    free(y);
    free(dy);
    return t;
}

static void write_forces(cli_table *table, work *w)
{
    const force_times t = time_forces(w);
    const size_t links = w->problem->kind == WORK_SCENE ? w->scene.def.links : 1;
    const struct {
        const char *name;
        double time;
    } row[] = {{"springstep", t.ours}, {"others", t.others}, {"xpbd", t.xpbd}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++)
        if (!isnan(row[i].time))
            cli_row(table, "%s\t%s\t%zu\t%.4g\t%.4g\t%.4g", w->problem->name, row[i].name, links, row[i].time,
                    row[i].time / (double)links, row[i].time / t.ours);
}

/* ---------------------------------------------------------------------------------------------------- the work */

static void work_on(cli_table *table, cli_table *levels, cli_table *forces, cli_table *further,
                    const work_problem *problem)
{
    work w;
    work_open(&w, problem);
    row_count = 0;
    for (size_t i = 0; i < work_solver_count; i++) {
        const work_solver *s = work_solver_at(i);
        if (!work_applies(&w, s))
            continue;
        if (s->side == WORK_EXACT)
            measure(table, &w, s, (work_effort){.steps = 1}, "sweep");
        else if (s->adaptive != NULL)
            sweep_tolerances(table, &w, s);
        else
            sweep_steps(table, &w, s);
    }
    if (levels != NULL && problem->kind != WORK_STUDY)
        write_levels(levels, &w);
    if (forces != NULL)
        write_forces(forces, &w);
    if (further != NULL && problem->own != NULL && strncmp(problem->name, "stiff-", 6) == 0)
        work_long(further, &w, quick);
    if (problem->kind == WORK_STUDY)
        equal_error(table, &w);
    if (problem->periods > 0)
        crossing(table, &w);
    work_close(&w);
}

/* Stamps the versions of the external libraries, and whether SUNDIALS is optimised. */
static void stamp_versions(cli_table *table)
{
    static double slowness;
    if (!(slowness > 0))
        slowness = ode_sundials_slowness(timing_now);
    cli_comment(table, "gsl: %s", ode_gsl_version());
    cli_comment(table, "sundials: %s%s", ode_sundials_version(), slowness >= ODE_UNOPTIMISED ? ", unoptimised" : "");
    cli_comment(table, "sundials_vector_sum: %.2g times a plain loop", slowness);
#ifdef SPRING_ODEINT
    cli_comment(table, "odeint: Boost %s", ode_odeint_version());
#else
    cli_comment(table, "odeint: none");
#endif
}

/* Opens the table of an option; NULL if the option is not given. */
static cli_table *open_further(const char *option, const char *path, const char *columns)
{
    if (path == NULL)
        return NULL;
    cli_table *table = cli_open_file(option, path);
    timing_stamp(table);
    stamp_versions(table);
    cli_columns(table, columns);
    return table;
}

/* The problems without an exact solution. */
static void work_apart(cli_table *table)
{
    if (only_problem > (int)work_problem_count) {
        cli_columns(table, steps_columns);
        steps_write(table, quick);
        return;
    }
    cli_columns(table, cape_columns);
    cli_table *equal = table_file != NULL ? cli_open_file("table", table_file) : NULL;
    if (equal != NULL) {
        timing_stamp(equal);
        cli_columns(equal, cape_equal_columns);
    }
    cape_write(table, equal, quick);
}

int main(int argc, char **argv)
{
    for (size_t i = 0; i < work_problem_count && i + 2 < MOST_PROBLEMS; i++)
        problem_names[i] = work_problems[i].name;
    problem_names[work_problem_count] = "cape"; /* these have other columns */
    problem_names[work_problem_count + 1] = "steps";
    cli_parse(&program, argc, argv);
    if (only_problem >= (int)work_problem_count && forces_file != NULL)
        cli_fail(CLI_USAGE, "--forces: is not for %s", problem_names[only_problem]);
    if (only_problem >= (int)work_problem_count && long_file != NULL)
        cli_fail(CLI_USAGE, "--long: is not for %s", problem_names[only_problem]);
    if (only_problem > (int)work_problem_count && table_file != NULL)
        cli_fail(CLI_USAGE, "--table: is not for %s", problem_names[only_problem]);
    cli_table *table = cli_open_output();
    timing_stamp(table);
    if (only_problem >= (int)work_problem_count) {
        work_apart(table);
        cli_finish();
        return 0;
    }
    stamp_versions(table);
    cli_columns(table, program.columns);
    cli_table *levels =
        open_further("table", table_file, "problem error solver dt_s time_s peer peer_time_s ratio steps exact_time_s");
    cli_table *forces = open_further("forces", forces_file, "problem evaluation links time_ns link_ns ratio");
    cli_table *further =
        open_further("long", long_file,
                     "problem solver steps_per_frame tolerance duration_s frame_s error_500ms error_1s "
                     "error_2s sag_m stretch stretch_99 energy_change");
    for (size_t i = 0; i < work_problem_count; i++) {
        const bool chosen = only_problem < 0 || i == (size_t)only_problem;
        if (chosen)
            work_on(table, levels, forces, further, &work_problems[i]);
        cli_progress((double)(i + 1) / (double)work_problem_count);
    }
    cli_finish();
    return 0;
}
