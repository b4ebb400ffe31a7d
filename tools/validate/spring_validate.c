/* SPDX-License-Identifier: MIT */
/*
 * spring-validate: compares every method on every corner case with independent references. Scenes are in
 * validate_scene.c.
 *
 * Each case and method is compared with the same method in exact arithmetic (the difference is rounding error), with
 * the exact solution (rounding and truncation error), and with external solvers. Every bound is derived, and its row
 * names the derivation.
 */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include <springstep/spring.h>

#include "common/cli.h"
#include "harness/cases.h"
#include "harness/ode.h"
#include "harness/reference.h"
#include "rows.h"

static const char **case_names; /* ended by NULL */
static int only_case = -1;
static bool list_only, quick;

static cli_option options[] = {
    {"case", CLI_CHOICE, .choice = &only_case, .value = "NAME", .help = "run only this case; --list prints the names"},
    {"list", CLI_FLAG, .flag = &list_only, .help = "list the cases and the fault that each case is designed to find"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "skip the cases that take long, unless named"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-validate",
    .summary = "Check every method against independent references on a catalogue of corner cases.",
    .details = "References for springs: iterate is the same method in 115-digit arithmetic. solution is the exact\n"
               "solution in 115 digits. drive is the motion under the continuous drive from which the loads are\n"
               "sampled. The independent solvers are gsl-rk4, arkode-rk4, gsl-rk8pd, cvode-adams and cvode-bdf.\n\n"
               "References for scenes: definition is the same method in a second program. modes and reduced-mass are\n"
               "exact expressions for linear scenes. dispersion is the frequency of standing waves on sheets. These\n"
               "waves run 1 m in (x, v/omega), so their errors are relative errors of the frequency. digits and\n"
               "formula are the exact solution. The independent solvers are gsl-rk4, arkode-rk4, gsl-rk8pd and\n"
               "cvode-adams.\n\n"
               "For the exact solution, or the first solver if there is none, each scene has three rows: for a step,\n"
               "for half the step, and for the value extrapolated from both.",
    .columns = "case method witness dt_s steps error bound verdict reason uncertainty force_evaluations shape",
    .meaning = "witness is the reference solution. error and bound are distances in (x, v/omega) [m]. reason lists\n"
               "the terms of the bound. verdict is pass, fail or skip, and the exit status is 1 if any check fails.\n"
               "uncertainty is the uncertainty of the reference [m], which is its difference from a run of its own\n"
               "that is ten times coarser. It is 0 for exact solutions in multiple precision. force_evaluations\n"
               "counts the evaluations of the reference, and is 0 if it has none. shape is spring or scene.",
    .shown = {"dt_s", "error"},
    .examples = {"--list", "--case fast-root", "--case turning-point -o checks.tsv"},
    .options = options,
};

static cli_table *table;
static unsigned failures;

void validate_check(const validate_row *r)
{
    const bool pass = r->error <= r->bound; /* false for NaN */
    failures += !pass;
    cli_row(table, "%s\t%s\t%s\t%.17g\t%" PRIu64 "\t%.17g\t%.17g\t%s\t%s\t%.17g\t%" PRIu64 "\t%s", r->of, r->method,
            r->reference, r->dt, r->steps, r->error, r->bound, pass ? "pass" : "fail", r->reason, r->uncertainty,
            r->evaluations, r->scene ? "scene" : "spring");
}

/* ------------------------------------------------------------------------ multiple precision, segment by segment */

/* The accuracy of spring_step_exact() (spring.h), and the contribution of the response to a load. */
static double exact_bound(const reference *exact, const segment *s, double t)
{
    const double omega = sqrt(s->p.stiffness / s->p.mass), g = s->p.damping / s->p.mass;
    const double zeta = omega > 0 ? g / (2 * omega) : 0;
    const double relative = 4 * DBL_EPSILON * (1 + omega * fabs(t) * fmax(1, zeta));
    const double load = fabs(s->p.load / s->p.mass);
    const double response = load * (omega > 0 ? fmin(t * t, 2 / (omega * omega)) : t * t);
    return relative * (mpfr_get_d(exact->size, MPFR_RNDU) + 2 * response) + DBL_MIN;
}

static void against_references(const validation_case *c, spring_method m)
{
    spring_state got;
    const segment first = case_segment(c, m, &got);
    const uint64_t segments = c->vary != NULL ? first.n : 1;
    reference iterate, exact;
    reference_init(&iterate);
    reference_init(&exact);
    reference_start(&iterate, &first.p, got);
    reference_start(&exact, &first.p, got);
    reference_bounds *bounds = reference_bounds_new(&first.p, got);
    bool done = true;
    double exact_rounding = 0;
    for (uint64_t i = 0; i < segments; i++) {
        segment s = first;
        if (c->vary != NULL) {
            s.n = 1;
            c->vary(c, i, &s);
        }
        done = done && spring_advance(&got, &s.p, m, s.dt, s.n) == SPRING_OK;
        const double t = s.dt * (double)s.n;
        reference_exact(&exact, &s.p, t);
        if (m == SPRING_EXACT) {
            exact_rounding += exact_bound(&exact, &s, t);
        } else {
            reference_iterate(&iterate, &s.p, m, s.dt, s.n);
            reference_bounds_add(bounds, &s.p, m, s.dt, s.n);
        }
    }
    if (!done)
        got = (spring_state){NAN, NAN};
    double rounding, truncation;
    reference_bounds_end(bounds, &rounding, &truncation);

    validate_row f = {.of = c->name, .method = spring_method_name(m), .dt = first.dt, .steps = first.n};
    if (m != SPRING_EXACT) {
        f.reference = "iterate";
        f.error = reference_distance(&iterate, got);
        f.bound = rounding;
        f.reason = "rounding";
        validate_check(&f);
    }
    f.reference = "solution";
    f.error = reference_distance(&exact, got);
    f.bound = m == SPRING_EXACT ? exact_rounding : rounding + truncation;
    f.reason = m == SPRING_EXACT ? "rounding of the exact solution" : "truncation + rounding";
    validate_check(&f);
    if (c->drive > 0) {
        spring_state drive;
        const double sampling = case_driven(c, first.dt, first.dt * (double)first.n, &drive);
        const double omega = sqrt(first.p.stiffness / first.p.mass);
        f.reference = "drive";
        f.error = hypot(got.x - drive.x, (got.v - drive.v) / omega);
        f.bound += sampling;
        f.reason = m == SPRING_EXACT ? "load sampled once a step" : "load sampled once a step + truncation + rounding";
        validate_check(&f);
    }
    reference_clear(&iterate);
    reference_clear(&exact);
}

/* -------------------------------------------------------------------------------------- external solvers */

/* RK4 with the same step in another implementation: the difference is the rounding error of both. */
static void against_rk4(const validation_case *c, const char *reference_name,
                        const char *(*solve)(ode *, double *, double, uint64_t), unsigned our_steps_a_step)
{
    spring_state start;
    const segment s = case_segment(c, SPRING_RK4, &start);
    const double omega = sqrt(s.p.stiffness / s.p.mass), scale[] = {1, omega};
    const uint64_t n = s.n / our_steps_a_step;
    ode o = {.size = 2, .derivative = ode_spring_derivative, .data = &s.p, .scale = scale};
    double y[] = {start.x, start.v};
    double rounding, truncation;
    reference_bounds *bounds = reference_bounds_new(&s.p, start);
    reference_bounds_add(bounds, &s.p, SPRING_RK4, s.dt, n * our_steps_a_step);
    reference_bounds_end(bounds, &rounding, &truncation);
    validate_row f = {
        .of = c->name, .method = "rk4", .reference = reference_name, .dt = s.dt, .steps = n * our_steps_a_step};
    const char *message = solve(&o, y, s.dt * our_steps_a_step, n);
    if (message != NULL)
        cli_fail(CLI_FAILED, "%s: %s: %s", c->name, reference_name, message);
    spring_state got = start;
    spring_advance(&got, &s.p, SPRING_RK4, s.dt, f.steps);
    f.error = hypot(got.x - y[0], (got.v - y[1]) / omega);
    f.bound = 2 * rounding;
    f.reason = "rounding on both sides";
    f.evaluations = o.evaluations;
    validate_check(&f);
}

typedef const char *adaptive_solver(ode *o, double *y, double duration, double tolerance);

/* The exact solution against a general solver. The error of the solver is estimated by a second run with ten times the
   tolerance: if the error of the first run is at most two thirds of the error of the second, it is at most twice their
   difference. The local tolerance is added for the last step. */
static void against_adaptive(const validation_case *c, const char *reference_name, adaptive_solver *solve)
{
    const double finest = 1e-11; /* below, CVODE's errors stop falling */
    const double tolerance = c->tolerance > 0 ? c->tolerance : finest;
    spring_state start;
    const segment s = case_segment(c, SPRING_LEAPFROG, &start);
    const double omega = sqrt(s.p.stiffness / s.p.mass), duration = s.dt * (double)s.n;
    const double size = hypot(start.x, start.v / omega) + fabs(c->rest), scale[] = {size, size * omega};
    double y[2][2];
    ode o = {.size = 2, .derivative = ode_spring_derivative, .data = &s.p, .scale = scale};
    for (int i = 0; i < 2; i++) {
        o.evaluations = 0;
        y[i][0] = start.x;
        y[i][1] = start.v;
        const char *message = solve(&o, y[i], duration, i == 0 ? 10 * tolerance : tolerance);
        if (message != NULL)
            cli_fail(CLI_FAILED, "%s: %s: %s", c->name, reference_name, message);
    }
    reference exact;
    reference_init(&exact);
    reference_start(&exact, &s.p, start);
    reference_exact(&exact, &s.p, duration);
    spring_state got = start;
    spring_advance(&got, &s.p, SPRING_EXACT, s.dt, s.n);
    validate_row f = {.of = c->name, .method = "exact", .reference = reference_name, .dt = s.dt, .steps = s.n};
    f.error = hypot(got.x - y[1][0], (got.v - y[1][1]) / omega);
    f.uncertainty = hypot(y[0][0] - y[1][0], (y[0][1] - y[1][1]) / omega);
    f.bound = 2 * f.uncertainty + tolerance * size + exact_bound(&exact, &s, duration);
    f.reason = "twice the uncertainty of the reference + its local tolerance";
    f.evaluations = o.evaluations;
    validate_check(&f);
    reference_clear(&exact);
}

static void run_case(const validation_case *c)
{
    for (int i = 0; i < SPRING_METHOD_COUNT; i++)
        if (case_takes(c, spring_method_at(i)))
            against_references(c, spring_method_at(i));
    if (!c->external)
        return;
    against_rk4(c, "gsl-rk4", ode_gsl_rk4, 2);
    against_rk4(c, "arkode-rk4", ode_arkstep_rk4, 1);
    against_adaptive(c, "gsl-rk8pd", ode_gsl_rk8pd);
    against_adaptive(c, "cvode-adams", ode_cvode_adams);
    against_adaptive(c, "cvode-bdf", ode_cvode_bdf);
}

static void name_cases(void)
{
    case_names = calloc(case_count + scene_case_count + 1, sizeof *case_names);
    if (case_names == NULL)
        exit(CLI_FAILED);
    for (size_t i = 0; i < case_count; i++)
        case_names[i] = cases[i].name;
    for (size_t i = 0; i < scene_case_count; i++)
        case_names[case_count + i] = scene_cases[i].name;
    options[0].choices = case_names;
}

int main(int argc, char **argv)
{
    name_cases();
    cli_parse(&program, argc, argv);
    if (list_only && (only_case >= 0 || quick))
        cli_fail(CLI_USAGE, "--%s: has no effect with --list", quick ? "quick" : "case");
    table = cli_open_output();
    cli_columns(table, list_only ? "case purpose" : program.columns);
    for (size_t i = 0; i < case_count + scene_case_count; i++) {
        const validation_case *c = i < case_count ? &cases[i] : NULL;
        const scene_case *scene = c == NULL ? &scene_cases[i - case_count] : NULL;
        const bool chosen = only_case < 0 ? !quick || !(c != NULL ? c->slow : scene->slow) : i == (size_t)only_case;
        if (list_only)
            cli_row(table, "%s\t%s", case_names[i], c != NULL ? c->purpose : scene->purpose);
        else if (chosen && c != NULL)
            run_case(c);
        else if (chosen)
            validate_scene(scene);
        cli_progress((double)(i + 1) / (double)(case_count + scene_case_count));
    }
    cli_finish();
    free(case_names);
    mpfr_free_cache();
    return failures > 0 ? CLI_FAILED : 0;
}
