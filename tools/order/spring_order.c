/* SPDX-License-Identifier: MIT */
/*
 * spring-order: the error of a method after a fixed time, against the number of steps.
 *
 * The spring has mass 1 kg and stiffness 1 N/m and starts at rest from x = 1 m, so its exact position is cos(t). The
 * error in position after time H in n steps of z = H/n is known to leading order,
 *
 *     Euler     |cos H| H^2/(2 n)        amplitude grows by z^2/2 a step
 *     leapfrog  |sin H| H^3/(24 n^2)     phase advances by z^3/24 a step
 *     RK4       |sin H| H^5/(120 n^4)    phase lags by z^5/120 a step
 */
#include <math.h>
#include <stddef.h>

#include <springstep/spring.h>

#include "common/cli.h"
#include "equal_error.h"
#include "common/stepper.h"

static const spring_params spring = {.mass = 1, .stiffness = 1};
static const spring_state start = {.x = 1, .v = 0};

typedef struct method_row {
    uint64_t n_min, n_max, n_step; /* of the seed study */
    uint64_t force_evaluations;    /* a step */
} method_row;

static const method_row methods[] = {
    [SPRING_EULER] = {10, 10000, 10, 1},
    [SPRING_LEAPFROG] = {10, 10000, 10, 1},
    [SPRING_RK4] = {5, 1000, 5, 4},
    [SPRING_EXACT] = {10, 10000, 10, 0},
};

static stepper chosen;
static double duration = 1;
static uint64_t n_min, n_max, n_step;
static bool fit;
static double match_error;

static const cli_option options[] = {
    {"method", CLI_CHOICE, .choice = &chosen.method, .choices = cli_methods, .required = true, .value = "M",
     .help = "euler, leapfrog, rk4 or exact"},
    {"arithmetic", CLI_CHOICE, .choice = &chosen.arithmetic, .choices = stepper_arithmetics, .value = "A",
     .help = "library (the default) or, for rk4, stages: k1, k2, k3, k4 one by one"},
    {"duration", CLI_POSITIVE, .real = &duration, .value = "H",
     .help = "time at which the error is taken [s] (default: 1)"},
    {"n-min", CLI_COUNT, .count = &n_min, .least = 1, .most = UINT64_C(1) << 53, .value = "N",
     .help = "smallest number of steps (default: 10, rk4: 5)"},
    {"n-max", CLI_COUNT, .count = &n_max, .least = 1, .most = UINT64_C(1) << 53, .value = "N",
     .help = "largest (default: 10000, rk4: 1000)"},
    {"n-step", CLI_COUNT, .count = &n_step, .least = 1, .most = UINT64_C(1) << 53, .value = "N",
     .help = "from one to the next (default: 10, rk4: 5)"},
    {"fit", CLI_FLAG, .flag = &fit,
     .help = "instead of the errors, one row with the power law through all of them:\n"
             "the least-squares line of log(error) against log(n)"},
    {"match-error", CLI_POSITIVE, .real = &match_error, .value = "E",
     .help = "instead, one row for the smallest n from which on the error never\n"
             "exceeds E [m]"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-order",
    .summary = "The error in position of a spring after a fixed time, against the number of steps.",
    .details =
        "The spring has mass 1 kg and stiffness 1 N/m and starts at rest from x = 1 m; the error is\n"
        "|x - cos H|.\n\n"
        "Columns: method, n (steps), dt_s (step), error_m, force_evaluations (in the whole run).\n"
        "With --fit: method, coefficient_m and exponent (error = coefficient n^exponent), r_squared,\n"
        "points, and theory_coefficient_m, to leading order: |cos H| H^2/2 for euler, |sin H| H^3/24\n"
        "for leapfrog, |sin H| H^5/120 for rk4.\n"
        "With --match-error: the columns of a single run, then match_error_m (E), previous_error_m (at\n"
        "n - 1, more than E) and first_n, the smallest n whose error happens not to exceed E; it may do\n"
        "so again beyond.\n"
        "The rounding of --arithmetic shows in the last digits of rk4's fit: its errors end at 1e-14.",
    .options = options,
};

static double measured_error(uint64_t n)
{
    spring_state s = start;
    const spring_status status = stepper_advance(&chosen, &s, &spring, duration / (double)n, n);
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "%" PRIu64 " steps of %.17g s: %s", n, duration / (double)n,
                 spring_status_string(status));
    return fabs(s.x - cos(duration));
}

static uint64_t force_evaluations(uint64_t n)
{
    return n * methods[chosen.method].force_evaluations;
}

static void write_errors(cli_table *table)
{
    cli_columns(table, "method n dt_s error_m force_evaluations");
    for (uint64_t n = n_min; n <= n_max; n += n_step) {
        cli_row(table, "%s\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64, cli_methods[chosen.method], n,
                duration / (double)n, measured_error(n), force_evaluations(n));
        cli_progress((double)n / (double)n_max);
    }
}

/* ------------------------------------------------------------------------------------------------ the power law */

static double theory_coefficient(void)
{
    const double H = duration;
    switch (chosen.method) {
    case SPRING_EULER:
        return fabs(cos(H)) * H * H / 2;
    case SPRING_LEAPFROG:
        return fabs(sin(H)) * H * H * H / 24;
    default:
        return fabs(sin(H)) * H * H * H * H * H / 120;
    }
}

/* The line through (log n, log error). Sums are taken about the means in a second pass: the runs are cheap, and
   nothing cancels. */
static void write_fit(cli_table *table)
{
    double points = 0, mean_x = 0, mean_y = 0;
    for (uint64_t n = n_min; n <= n_max; n += n_step) {
        const double error = measured_error(n);
        if (!(error > 0))
            cli_fail(CLI_FAILED, "the error is 0 for %" PRIu64 " steps: no power law goes through it", n);
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
    cli_row(table, "%s\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g", cli_methods[chosen.method],
            exp(mean_y - exponent * mean_x), exponent, xy * xy / (xx * yy), points, theory_coefficient());
}

static void write_match(cli_table *table)
{
    const uint64_t n = equal_error_steps((spring_method)chosen.method, duration, match_error);
    const double error = measured_error(n), previous = n > 1 ? measured_error(n - 1) : INFINITY;
    if (!(error <= match_error && previous > match_error))
        cli_fail(CLI_FAILED,
                 "theory says %" PRIu64 " steps, but with them the error is %.17g m, with one less %.17g m",
                 n, error, previous);
    cli_columns(table, "method n dt_s error_m force_evaluations match_error_m previous_error_m first_n");
    cli_row(table, "%s\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64,
            cli_methods[chosen.method], n, duration / (double)n, error, force_evaluations(n), match_error,
            previous, equal_error_first_steps((spring_method)chosen.method, duration, match_error));
}

/* --------------------------------------------------------------------------------------------------------------- */

static void settle_options(void)
{
    stepper_check(&chosen);
    const method_row *study = &methods[chosen.method];
    if (n_min == 0)
        n_min = study->n_min;
    if (n_max == 0)
        n_max = study->n_max;
    if (n_step == 0)
        n_step = study->n_step;
    if (n_max < n_min)
        cli_fail(CLI_USAGE, "--n-max: \"%" PRIu64 "\" is not a number of at least --n-min, %" PRIu64, n_max,
                 n_min);
    if (fit && n_max - n_min < n_step)
        cli_fail(CLI_USAGE, "--fit: takes two points or more; --n-max should be at least --n-min + --n-step");
    if (fit && match_error > 0)
        cli_fail(CLI_USAGE, "--fit: cannot be combined with --match-error; it should be one of them");
    if ((fit || match_error > 0) && chosen.method == SPRING_EXACT)
        cli_fail(CLI_USAGE,
                 "--method: \"exact\" has no error but rounding; it should be euler, leapfrog or rk4 here");
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
    return 0;
}
