/* SPDX-License-Identifier: MIT */
/*
 * spring-run: simulates one spring and compares it with its exact solution.
 *
 * The time of step i is i dt, and the exact solution is evaluated from the start. Neither accumulates from row to row.
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include <springstep/spring.h>

#include "common/cli.h"
#include "common/stepper.h"

static stepper chosen;
static run_length length;
static uint64_t every;
static double from;
static const char *envelope_path;
static uint64_t envelope_columns = 600;
static spring_params spring = {.mass = 1, .stiffness = 1};
static spring_state start = {.x = 1};

static const cli_option options[] = {
    {"method", CLI_METHOD, .choice = &chosen.method, .offers = cli_for_springs, .required = true, .value = "M"},
    {"duration", CLI_POSITIVE, .real = &length.duration, .value = "H",
     .help = "simulated time [s]; two of H, N and DT set the third"},
    {"steps", CLI_COUNT, .count = &length.steps, .least = 1, .most = CLI_MOST_STEPS, .value = "N",
     .help = "number of steps"},
    {"dt", CLI_POSITIVE, .real = &length.dt, .value = "DT",
     .help = "step [s]\n"
             "A duration is rounded to whole steps."},
    {"every", CLI_COUNT, .count = &every, .least = 1, .value = "K",
     .help = "print every K-th step, including the start; otherwise only the end"},
    {"from", CLI_REAL, .real = &from, .value = "T", .needs = &every,
     .help = "print no rows before time T [s], except the end"},
    {"mass", CLI_POSITIVE, .real = &spring.mass, .value = "m", .help = "mass [kg]"},
    {"stiffness", CLI_NOT_NEGATIVE, .real = &spring.stiffness, .value = "k", .help = "stiffness [N/m]"},
    {"damping", CLI_NOT_NEGATIVE, .real = &spring.damping, .value = "c", .help = "damping [N s/m]"},
    {"load", CLI_REAL, .real = &spring.load, .value = "f", .help = "constant force [N]"},
    {"x0", CLI_REAL, .real = &start.x, .value = "x", .help = "initial displacement [m]"},
    {"v0", CLI_REAL, .real = &start.v, .value = "v", .help = "initial velocity [m/s]"},
    {"arithmetic", CLI_CHOICE, .choice = &chosen.arithmetic, .choices = stepper_arithmetics, .value = "A",
     .help = "library, or stages (rk4 only: computes k1 to k4)"},
    {"envelope", CLI_FILE, .file = &envelope_path, .value = "FILE",
     .help = "also write the envelope of the error to FILE\n"
             "The envelope is the minimum and maximum over all steps, for each of --columns equal parts of the\n"
             "run."},
    {"columns", CLI_COUNT, .count = &envelope_columns, .least = 1, .most = 1000000, .value = "N",
     .needs = &envelope_path, .help = "number of parts of the envelope"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-run",
    .summary = "Simulate one spring and compare it with its exact solution.",
    .details = "Times are i DT from the start, or i H/N. The exact solution is computed from the start in one\n"
               "evaluation.\n\n"
               "If the spring explodes, that is, if its state or its energy becomes infinite, the output ends, the\n"
               "time is printed on standard error, and the exit status is 1. A warning is printed if the step is not\n"
               "below the stable step, or if the duration is not a whole number of steps.",
    .columns = "method step t_s x_m v_m_per_s energy_J exact_x_m error_m",
    .meaning =
        "energy_J is m v^2/2 + k x^2/2 - load x. error_m is |x_m - exact_x_m|. The last row is the final\n"
        "state. exact_x_m has a rounding error of up to about 4 eps (1 + omega t) times the amplitude, with\n"
        "eps = 2.2e-16 and omega = sqrt(k/m). With --method exact, one evaluation covers the steps from one row to\n"
        "the next, at most 2^24 steps (with --envelope, one step), and error_m compares two evaluations of\n"
        "the same formula. It does not contain the rounding error of exact_x_m, and may be 0.\n\n"
        "Columns of the envelope: method, t_s (the middle of the part), error_min_m and error_max_m. The\n"
        "errors have the sign of x_m - exact_x_m. Parts without a step have no row.",
    .shown = {"t_s", "x_m"},
    .examples = {"--method leapfrog --duration 10 --dt 0.01 --every 1 -o spring.tsv",
                 "--method exact --duration 2 --steps 120 --every 1 --stiffness 40 --damping 3",
                 "--method rk4 --dt 1e-3 --steps 1e6 --envelope error.tsv"},
    .options = options,
};

/* The time of step i is i span/parts, from values of the command line, so it does not contain the rounding of dt. */
static double span, parts;

/* At 1000 s a double resolves time to 6e-14 s only, and RK4's error is smaller. So the time is a sum of two doubles.
   The second is far below any dt, so the motion over it is linear. */
static double exact_x(uint64_t step)
{
    int exponent; /* split off the duration, so that no product overflows */
    const double H = frexp(span, &exponent), i = (double)step, n = parts;
    const double product = i * H, t = product / n;
    const double rest = (fma(-t, n, product) + fma(i, H, -product)) / n;
    spring_state s = start;
    spring_step_exact(&s, &spring, ldexp(t, exponent));
    return s.x + ldexp(rest, exponent) * s.v;
}

static void write_state(cli_table *table, uint64_t step, const spring_state *s)
{
    const double exact = exact_x(step);
    cli_row(table, "%s\t%" PRIu64 "\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g", stepper_name(&chosen), step,
            (double)step * length.dt, s->x, s->v, spring_energy(s, &spring), exact, fabs(s->x - exact));
}

/* ------------------------------------------------------------------------------------------------- the envelope */

typedef struct envelope {
    cli_table *table; /* NULL: no envelope */
    uint64_t part;    /* index of the current part */
    double min, max;  /* [m] of the error so far in this part */
} envelope;

static void write_part(const envelope *e)
{
    cli_row(e->table, "%s\t%.17g\t%.17g\t%.17g", stepper_name(&chosen),
            ((double)e->part + 0.5) / (double)envelope_columns * (double)length.steps * length.dt, e->min, e->max);
}

static void add_to_envelope(envelope *e, uint64_t step, const spring_state *s)
{
    const double error = s->x - exact_x(step);
    uint64_t part = (uint64_t)((double)step / (double)length.steps * (double)envelope_columns);
    if (part == envelope_columns) /* the last step belongs to the last part */
        part--;
    if (part != e->part) {
        write_part(e);
        *e = (envelope){e->table, part, INFINITY, -INFINITY};
    }
    e->min = fmin(e->min, error);
    e->max = fmax(e->max, error);
}

/* -------------------------------------------------------------------------------------------------------- the run */

/* The number of steps until the next output, measurement or progress message. */
static uint64_t steps_at_once(uint64_t step)
{
    uint64_t n = stepper_leap;
    if (envelope_path != NULL)
        n = 1;
    if (every > 0 && n > every - step % every)
        n = every - step % every;
    return n < length.steps - step ? n : length.steps - step;
}

/* Takes n steps, or none if the state or the energy would overflow. */
static bool take(spring_state *s, uint64_t n)
{
    spring_state next = *s;
    if (stepper_advance(&chosen, &next, &spring, length.dt, n) != SPRING_OK || !isfinite(spring_energy(&next, &spring)))
        return false;
    *s = next;
    return true;
}

/* Finds and prints the time of the overflow, if n steps from here fail. */
static void tell_explosion(spring_state *s, uint64_t step, uint64_t n)
{
    for (; n > 0; n /= 2)
        while (take(s, n))
            step += n;
    cli_warn("the spring explodes: step %" PRIu64
             ", to t = %.17g s, makes its state or its energy infinite; before this step, x = %g m and v = %g m/s",
             step + 1, (double)(step + 1) * length.dt, s->x, s->v);
}

/* Returns false if the state overflowed. */
static bool run(cli_table *table, envelope *e)
{
    spring_state s = start;
    for (uint64_t step = 0;;) {
        const bool row_due = every > 0 && step % every == 0 && (double)step * length.dt >= from;
        if (row_due || step == length.steps)
            write_state(table, step, &s);
        if (e->table != NULL)
            add_to_envelope(e, step, &s);
        if (step == length.steps)
            return true;
        const uint64_t n = steps_at_once(step);
        if (!take(&s, n)) {
            tell_explosion(&s, step, n);
            return false;
        }
        step += n;
        cli_progress((double)step / (double)length.steps);
    }
}

static void check_options(void)
{
    stepper_check(&chosen);
    if (!spring_params_valid(&spring))
        cli_fail(CLI_USAGE, "--mass: \"%g\" is too small: stiffness/mass, damping/mass, load/mass should be finite",
                 spring.mass);
}

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    check_options();
    run_length_settle(&length);
    span = cli_given(&length.dt) ? length.dt : length.duration;
    parts = cli_given(&length.dt) ? 1 : (double)length.steps;

    cli_table *table = cli_open_output();
    envelope e = {.min = INFINITY, .max = -INFINITY};
    if (envelope_path != NULL)
        e.table = cli_open_file("envelope", envelope_path);
    stepper_comment(&chosen, table);
    cli_columns(table, program.columns);
    if (e.table != NULL) {
        stepper_comment(&chosen, e.table);
        cli_columns(e.table, "method t_s error_min_m error_max_m");
    }
    run_length_remark_end(&length);
    stepper_remark(&chosen, &spring, length.dt);
    const bool survived = run(table, &e);
    if (e.table != NULL)
        write_part(&e);
    cli_finish();
    return survived ? 0 : CLI_FAILED;
}
