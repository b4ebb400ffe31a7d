/* SPDX-License-Identifier: MIT */
/*
 * spring-work: time against error, for every stepper of the library and for GSL and SUNDIALS on the same springs.
 *
 * Method    A run is repeated in a loop that is long enough to time (a fifth of a millisecond), and the loop five times;
 *           the time is the shortest. Solvers are called as their manuals recommend, do no output while they are timed,
 *           and evaluate the same right-hand side, which counts its calls in a run of its own.
 * Error     |(x, v/omega) - true| at the end, the truth from the closed form.
 */
#include <math.h>
#include <stddef.h>

#include <springstep/spring.h>

#include "cli.h"
#include "equal_error.h"
#include "harness/ode.h"
#include "harness/stages.h"
#include "timing.h"

/* ------------------------------------------------------------------------------------------------- the problems */

typedef struct problem {
    const char *name;
    spring_params p;
    spring_state start;
    double duration;   /* [s] */
    double least_step; /* [s] the finest step of a sweep */
    bool peers;        /* with GSL and SUNDIALS */
} problem;

#define PERIODS(n) ((n)*6.283185307179586 / 1.4411533842457842) /* [s] of sqrt(2.7/1.3) */

static const problem problems[] = {
    {"seed-1000s", {1, 1, 0, 0}, {1, 0}, 1000, 1e-4, false},
    {"ideal-1", {1.3, 2.7, 0, 0}, {0.8, -0.9}, PERIODS(1), 1e-5, true},
    {"ideal-10", {1.3, 2.7, 0, 0}, {0.8, -0.9}, PERIODS(10), 1e-4, true},
    {"ideal-100", {1.3, 2.7, 0, 0}, {0.8, -0.9}, PERIODS(100), 1e-3, true},
    {"ideal-10000", {1.3, 2.7, 0, 0}, {0.8, -0.9}, PERIODS(10000), 1e-2, true},
    {"damped", {1.3, 2.7, 0.4, 0}, {0.8, -0.9}, PERIODS(5), 1e-4, true},
    {"loaded", {1.3, 2.7, 0.1, 0.9}, {0.8, -0.9}, PERIODS(10), 1e-4, true},
    {"stiff", {1.3, 2.7, 370, 0}, {0.8, -0.9}, 100, 1e-3, true},
};
static const size_t problem_count = sizeof problems / sizeof problems[0];

/* -------------------------------------------------------------------------------------------------- the solvers */

typedef struct effort { /* what is varied: one of them */
    uint64_t steps;
    double tolerance;
} effort;

typedef struct solver solver;

struct solver {
    const char *name;
    const char *(*run)(const solver *s, const problem *q, effort e, ode *o, double *y); /* as in ode.h */
    bool adaptive, peer;
    uint64_t evaluations_a_step; /* of the library, which has no right-hand side to count */
    spring_method method;        /* of by_advance() */
};

static const char *by_advance(const solver *s, const problem *q, effort e, ode *o, double *y)
{
    (void)o;
    spring_state state = {y[0], y[1]};
    const spring_status status =
        spring_advance(&state, &q->p, s->method, q->duration / (double)e.steps, e.steps);
    y[0] = state.x;
    y[1] = state.v;
    return status == SPRING_OK ? NULL : spring_status_string(status);
}

static const char *rk4_stages(const solver *self, const problem *q, effort e, ode *o, double *y)
{
    (void)self;
    (void)o;
    spring_state s = {y[0], y[1]};
    stages_advance(&s, &q->p, q->duration / (double)e.steps, e.steps);
    y[0] = s.x;
    y[1] = s.v;
    return isfinite(s.x) && isfinite(s.v) ? NULL : "overflow";
}

static const char *gsl_rk4(const solver *s, const problem *q, effort e, ode *o, double *y)
{
    (void)s;
    return ode_gsl_rk4(o, y, q->duration / (double)e.steps, e.steps);
}

static const char *gsl_rk8pd(const solver *s, const problem *q, effort e, ode *o, double *y)
{
    (void)s;
    return ode_gsl_rk8pd(o, y, q->duration, e.tolerance);
}

static const char *arkode_rk4(const solver *s, const problem *q, effort e, ode *o, double *y)
{
    (void)s;
    return ode_arkstep_rk4(o, y, q->duration / (double)e.steps, e.steps);
}

static const char *cvode_adams(const solver *s, const problem *q, effort e, ode *o, double *y)
{
    (void)s;
    return ode_cvode(o, y, q->duration, ODE_ADAMS, e.tolerance);
}

static const char *cvode_bdf(const solver *s, const problem *q, effort e, ode *o, double *y)
{
    (void)s;
    return ode_cvode(o, y, q->duration, ODE_BDF, e.tolerance);
}

static const solver solvers[] = {
    /* the steppers first, in the order of spring_method */
    {.name = "euler", .run = by_advance, .method = SPRING_EULER, .evaluations_a_step = 1},
    {.name = "leapfrog", .run = by_advance, .method = SPRING_LEAPFROG, .evaluations_a_step = 1},
    {.name = "rk4", .run = by_advance, .method = SPRING_RK4, .evaluations_a_step = 4},
    {.name = "rk4-stages", .run = rk4_stages, .evaluations_a_step = 4},
    {.name = "exact", .run = by_advance, .method = SPRING_EXACT},
    {.name = "gsl-rk4", .run = gsl_rk4, .peer = true},
    {.name = "gsl-rk8pd", .run = gsl_rk8pd, .peer = true, .adaptive = true},
    {.name = "arkode-rk4", .run = arkode_rk4, .peer = true},
    {.name = "cvode-adams", .run = cvode_adams, .peer = true, .adaptive = true},
    {.name = "cvode-bdf", .run = cvode_bdf, .peer = true, .adaptive = true},
};
static const size_t solver_count = sizeof solvers / sizeof solvers[0];

/* -------------------------------------------------------------------------------------------- the command line */

static const char *problem_names[sizeof problems / sizeof problems[0] + 1]; /* ended by NULL */
static int only_problem = -1;
static bool quick;

static const cli_option options[] = {
    {"problem", CLI_CHOICE, .choice = &only_problem, .choices = problem_names, .value = "NAME",
     .help = "only this problem"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer points, none that takes long"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-work",
    .summary = "Time against error of every stepper, beside GSL and SUNDIALS, in one run.",
    .details =
        "Columns: problem, solver, steps (0: the solver chooses), force_evaluations, time_s (the shortest of "
        "five\n"
        "loops), error (|(x, v/omega) - true| [m]), error_x (|x - true x| [m]), effort: sweep (of steps or "
        "tolerances),\n"
        "seed (the number of steps of the seed study) or equal (the smallest number of steps from which on "
        "the error\n"
        "in x never exceeds Euler's at 10^7 steps), and tolerance (0 for fixed steps).\n"
        "Problems: seed-1000s is the study's long run, m = k = 1; the others have m = 1.3 kg, k = 2.7 N/m.\n"
        "Solvers: rk4-stages evaluates the four stages one by one; exact is no stepper: one evaluation "
        "whatever the\n"
        "duration. A run that explodes, or ends further off than the start was from rest, has no row.",
    .options = options,
};

/* ---------------------------------------------------------------------------------------------------- the work */

static const char *run_once(const problem *q, const solver *s, effort e, ode *o, double *y)
{
    y[0] = q->start.x;
    y[1] = q->start.v;
    o->evaluations = 0;
    return s->run(s, q, e, o, y);
}

/* Seconds a run takes: the shortest of five loops, or of two where one takes longer than a fifth of a second. */
static double time_of(const problem *q, const solver *s, effort e, ode *o)
{
    const double long_enough = 2e-4, long_run = 0.2;
    double y[2], best = INFINITY;
    uint64_t runs = 1;
    for (int loops = 0; loops < (best > long_run ? 2 : 5); loops++) {
        const double begin = timing_now();
        for (uint64_t i = 0; i < runs; i++)
            run_once(q, s, e, o, y);
        const double spent = 1e-9 * (timing_now() - begin); /* [s] */
        best = fmin(best, spent / (double)runs);
        if (spent < long_enough) {
            runs *= 2;
            loops = -1;
            best = INFINITY;
        }
    }
    return best;
}

static void measure(cli_table *table, const problem *q, const solver *s, effort e, const char *why)
{
    const double omega = sqrt(q->p.stiffness / q->p.mass), rest = q->p.load / q->p.stiffness;
    const double size = hypot(q->start.x - rest, q->start.v / omega), scale[] = {size, size * omega};
    ode o = {.size = 2, .derivative = ode_spring_derivative, .data = &q->p, .scale = scale};
    spring_state truth = q->start;
    double y[2];
    spring_step_exact(&truth, &q->p, q->duration);
    if (run_once(q, s, e, &o, y) != NULL)
        return;
    const double error = hypot(y[0] - truth.x, (y[1] - truth.v) / omega);
    if (!(error <= size))
        return;
    const uint64_t evaluations = s->peer ? o.evaluations : e.steps * s->evaluations_a_step;
    cli_row(table, "%s\t%s\t%" PRIu64 "\t%" PRIu64 "\t%.4g\t%.17g\t%.17g\t%s\t%g", q->name, s->name, e.steps,
            evaluations, time_of(q, s, e, &o), error, fabs(y[0] - truth.x), why, e.tolerance);
}

/* From four steps a period, or the stable step of a heavily damped spring, to the finest. */
static void sweep_steps(cli_table *table, const problem *q, const solver *s)
{
    const double omega = sqrt(q->p.stiffness / q->p.mass),
                 coarsest = fmin(1.5 / omega, 2 * q->p.mass / q->p.damping);
    const double finest = quick ? fmax(q->least_step, q->duration / 2e5) : q->least_step;
    const double most = rint(q->duration / finest), factor = quick ? 4 : sqrt(2);
    for (double n = ceil(q->duration / coarsest); n < most * 0.999; n = ceil(n * factor))
        measure(table, q, s, (effort){.steps = (uint64_t)n}, "sweep");
    measure(table, q, s, (effort){.steps = (uint64_t)most}, "sweep");
}

static void sweep_tolerances(cli_table *table, const problem *q, const solver *s)
{
    const double tightest = quick ? 1e-9 : 1e-14;
    for (double tolerance = 1e-2; tolerance > 0.5 * tightest; tolerance /= quick ? 100 : 10)
        measure(table, q, s, (effort){.tolerance = tolerance}, "sweep");
}

/* The seed study's comparison: as exact as Euler in 10^7 steps, by its numbers of steps and by those found here. */
static void equal_error(cli_table *table, const problem *q)
{
    static const uint64_t of_the_seed[] = {
        [SPRING_EULER] = 10000000, [SPRING_LEAPFROG] = 35000, [SPRING_RK4] = 3700};
    spring_state s = q->start, truth = q->start;
    spring_advance(&s, &q->p, SPRING_EULER, q->duration / 1e7, 10000000);
    spring_step_exact(&truth, &q->p, q->duration);
    const double error = fabs(s.x - truth.x);
    for (int m = SPRING_EULER; m <= SPRING_RK4; m++) {
        measure(table, q, &solvers[m], (effort){.steps = of_the_seed[m]}, "seed");
        const uint64_t found =
            m == SPRING_EULER ? of_the_seed[m] : equal_error_steps((spring_method)m, q->duration, error);
        measure(table, q, &solvers[m], (effort){.steps = found}, "equal");
    }
}

static void work_on(cli_table *table, const problem *q)
{
    for (size_t i = 0; i < solver_count; i++) {
        const solver *s = &solvers[i];
        if (s->peer && !q->peers)
            continue;
        if (s->method == SPRING_EXACT)
            measure(table, q, s, (effort){.steps = 1}, "sweep");
        else if (s->adaptive)
            sweep_tolerances(table, q, s);
        else
            sweep_steps(table, q, s);
    }
    if (q == &problems[0])
        equal_error(table, q);
}

int main(int argc, char **argv)
{
    for (size_t i = 0; i < problem_count; i++)
        problem_names[i] = problems[i].name;
    cli_parse(&program, argc, argv);
    cli_table *table = cli_open_output();
    timing_stamp(table);
    cli_columns(table, "problem solver steps force_evaluations time_s error error_x effort tolerance");
    for (size_t i = 0; i < problem_count; i++) {
        if (only_problem < 0 || i == (size_t)only_problem)
            work_on(table, &problems[i]);
        cli_progress((double)(i + 1) / (double)problem_count);
    }
    cli_finish();
    return 0;
}
