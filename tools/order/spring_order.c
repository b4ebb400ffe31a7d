/* SPDX-License-Identifier: MIT */
/*
 * spring-order: the error of a method after a fixed time as a function of the number of steps.
 *
 * The spring has mass 1 kg and stiffness 1 N/m and starts at rest from x = 1 m, so its exact position is cos(t).
 */
#include <math.h>
#include <stddef.h>

#include <mpfr.h>

#include <springstep/spring.h>

#include "common/cli.h"
#include "common/stepper.h"
#include "equal_error.h"

static const spring_params spring = {.mass = 1, .stiffness = 1};
static const spring_state start = {.x = 1, .v = 0};

static stepper chosen;
static double duration = 1;
static uint64_t n_min, n_max, n_step;
static bool fit;
static double match_error;

static const cli_option options[] = {
    {"method", CLI_METHOD, .choice = &chosen.method, .offers = cli_for_springs, .required = true, .value = "M"},
    {"arithmetic", CLI_CHOICE, .choice = &chosen.arithmetic, .choices = stepper_arithmetics, .value = "A",
     .help = "library, or stages (rk4 only: computes k1 to k4)"},
    {"duration", CLI_POSITIVE, .real = &duration, .value = "H", .help = "time at which the error is measured [s]"},
    {"n-min", CLI_COUNT, .count = &n_min, .least = 1, .most = CLI_MOST_STEPS, .value = "N",
     .help = "smallest number of steps (default: 10; for order 4 and above: 5)"},
    {"n-max", CLI_COUNT, .count = &n_max, .least = 1, .most = CLI_MOST_STEPS, .value = "N",
     .help = "largest number of steps (default: 10000; for order 4 and above: 1000)"},
    {"n-step", CLI_COUNT, .count = &n_step, .least = 1, .most = CLI_MOST_STEPS, .value = "N",
     .help = "increment of the number of steps (default: 10; for order 4 and above: 5)"},
    {"fit", CLI_FLAG, .flag = &fit,
     .help = "instead of the errors, print the power law through all of them\n"
             "The law is the least-squares line of log(error) against log(n). The table has one row."},
    {"match-error", CLI_POSITIVE, .real = &match_error, .value = "E",
     .help = "instead, print the smallest n from which on no error exceeds E [m] < 2\n"
             "The table has one row."},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-order",
    .summary = "Measure the position error of a spring after a fixed time, for different numbers of steps.",
    .details = "The spring has a mass of 1 kg and a stiffness of 1 N/m, and starts at rest from x = 1 m. The error\n"
               "is |x - cos H|.",
    .columns = "method n dt_s error_m force_evaluations",
    .meaning = "n is the number of steps. dt_s is the step. force_evaluations counts the whole run.\n\n"
               "With --fit: method, coefficient_m and exponent (error = coefficient n^exponent), r_squared, points,\n"
               "and theory_coefficient_m, which is the leading-order coefficient of the method without rounding\n"
               "error.\n\n"
               "With --match-error: the columns of a single run, match_error_m (E), previous_error_m (the error of n\n"
               "- 1 steps, more than E) and first_n, the smallest n whose error does not exceed E. Between first_n\n"
               "and n, errors may exceed E again. If H is more than 10^5 s, steps of more than 1 s are not examined\n"
               "and first_n is 0.\n\n"
               "The rounding error of --arithmetic affects the last digits of the fit for rk4, whose errors go down\n"
               "to 1e-14.",
    .shown = {"n", "error_m"},
    .examples = {"--method rk4 -o order.tsv", "--method leapfrog --fit",
                 "--method rk4 --duration 100 --match-error 1e-6"},
    .options = options,
};

static double measured_error(uint64_t n)
{
    const double dt = duration / (double)n;
    const uint64_t leap = chosen.method == SPRING_EXACT ? n : stepper_leap; /* one evaluation */
    spring_state s = start;
    spring_status status = SPRING_OK;
    for (uint64_t done = 0; done < n && status == SPRING_OK; done += leap) {
        status = stepper_advance(&chosen, &s, &spring, dt, n - done < leap ? n - done : leap);
        if (n > leap)
            cli_progress((double)done / (double)n);
    }
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "%" PRIu64 " steps of %.17g s: %s", n, dt, spring_status_string(status));
    return fabs(s.x - cos(duration));
}

static uint64_t force_evaluations(uint64_t n)
{
    return n * (uint64_t)spring_method_describe((spring_method)chosen.method)->forces_per_step;
}

static void write_errors(cli_table *table)
{
    cli_columns(table, program.columns);
    for (uint64_t n = n_min; n <= n_max; n += n_step) {
        cli_row(table, "%s\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64, stepper_name(&chosen), n, duration / (double)n,
                measured_error(n), force_evaluations(n));
        cli_progress((double)n / (double)n_max);
    }
}

/* ------------------------------------------------------------------------------------------------ the power law */

/* Fits a line through (log n, log error). Sums are about the means, in a second pass, to avoid cancellation. */
static void write_fit(cli_table *table)
{
    double points = 0, mean_x = 0, mean_y = 0;
    for (uint64_t n = n_min; n <= n_max; n += n_step) {
        const double error = measured_error(n);
        if (!(error > 0))
            cli_fail(CLI_FAILED, "the error is 0 for %" PRIu64 " steps, which no power law can fit", n);
        points += 1;
        mean_x += (log((double)n) - mean_x) / points;
        mean_y += (log(error) - mean_y) / points;
    }
    double xx = 0, xy = 0, yy = 0;
    for (uint64_t n = n_min; n <= n_max; n += n_step) {
        const double x = log((double)n) - mean_x, y = log(measured_error(n)) - mean_y;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const double exponent = xy / xx;
    cli_columns(table, "method coefficient_m exponent r_squared points theory_coefficient_m");
    cli_row(table, "%s\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g", stepper_name(&chosen), exp(mean_y - exponent * mean_x),
            exponent, xy * xy / (xx * yy), points, error_coefficient((spring_method)chosen.method, duration));
}

static void write_match(cli_table *table)
{
    const uint64_t n = equal_error_steps((spring_method)chosen.method, duration, match_error);
    const double error = measured_error(n), previous = n > 1 ? measured_error(n - 1) : INFINITY;
    const bool longest = (double)n - 1 < duration; /* steps above 1 s may not have been considered */
    if (!(error <= match_error && (previous > match_error || longest)))
        cli_fail(CLI_FAILED,
                 "theory predicts %" PRIu64 " steps, but their error is %.17g m, and with one step less %.17g m", n,
                 error, previous);
    cli_columns(table, "method n dt_s error_m force_evaluations match_error_m previous_error_m first_n");
    cli_row(table, "%s\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64, stepper_name(&chosen), n,
            duration / (double)n, error, force_evaluations(n), match_error, previous,
            equal_error_first_steps((spring_method)chosen.method, duration, match_error));
}

/* --------------------------------------------------------------------------------------------------------------- */

static void settle_options(void)
{
    stepper_check(&chosen);
    /* as in the original study */
    const bool accurate = spring_method_describe((spring_method)chosen.method)->order >= 4;
    if (n_min == 0)
        n_min = accurate ? 5 : 10;
    if (n_max == 0)
        n_max = accurate ? 1000 : 10000;
    if (n_step == 0)
        n_step = accurate ? 5 : 10;
    if (n_max < n_min)
        cli_fail(CLI_USAGE, "--n-max: \"%" PRIu64 "\" is not a number of at least --n-min, %" PRIu64, n_max, n_min);
    if (fit && n_max - n_min < n_step)
        cli_fail(CLI_USAGE, "--fit: requires two points or more; --n-max should be at least --n-min + --n-step");
    if (fit && match_error > 0)
        cli_fail(CLI_USAGE, "--fit: cannot be combined with --match-error");
    if (!(match_error < 2))
        cli_fail(CLI_USAGE,
                 "--match-error: \"%g\" is more than the distance of two ends of a swing; it should be less "
                 "than 2",
                 match_error);
    if ((fit || match_error > 0) && !cli_for_steps(spring_method_describe((spring_method)chosen.method))) {
        char steppers[200];
        cli_list_methods(steppers, sizeof steppers, cli_for_steps);
        cli_fail(CLI_USAGE, "--method: \"%s\" has only rounding error; it should be one of %s here",
                 stepper_name(&chosen), steppers);
    }
}

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    settle_options();
    cli_table *table = cli_open_output();
    stepper_comment(&chosen, table);
    if (fit)
        write_fit(table);
    else if (match_error > 0)
        write_match(table);
    else
        write_errors(table);
    cli_finish();
    mpfr_free_cache();
    return 0;
}
