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
#include <float.h>
#include <math.h>
#include <stddef.h>

#include <springstep/spring.h>

#include "cli.h"
#include "stepper.h"

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

/* -------------------------------------------------------------------------------------------------- equal error */
/*
 * The smallest n from which on the error never exceeds E.
 *
 * In exact arithmetic n steps of z = H/n give x_n = rho^n cos(n phi), with growth rho and phase phi a step. Hence
 *
 *     |x_n - cos H| <= |rho^n - 1| + |n phi - H|,
 *
 * and both terms fall as n grows, at least while z <= 1: log(rho)/z and (phi - z)/z are monotone in z there.
 *
 *     Euler     rho^2 = 1 + z^2                 phi = atan z             (log(1 + z^2)/z rises up to z = 1.98)
 *     leapfrog  rho = 1                         phi = 2 asin(z/2)
 *     RK4       rho^2 = 1 - z^6/72 + z^8/576    tan phi = (z - z^3/6)/(1 - z^2/2 + z^4/24)
 *               (z^5/72 - z^7/576 rises up to z = 2.39; 1 - dphi/dz = z^4 (1 - z^2/2 + z^4/24)/(24 rho^2) up to 1.27)
 *
 * So where this bound comes down to E, found by bisection, everything above is settled; below, x_n itself is looked at
 * for one n after the other until its error exceeds E. The answer is confirmed by the method itself.
 * Rounding adds at most 2.5 eps a step (src/leapfrog.c; less for the others), which the bound includes; it grows with n
 * and would in the end exceed any E, so "never" is meant up to that.
 */
typedef struct iterate {
    double log_growth, phase; /* after all n steps: n log(rho), n phi */
} iterate;

static iterate iterate_after(uint64_t n)
{
    const double z = duration / (double)n, z2 = z * z;
    double log_rho2 = 0, phi = 0; /* of one step */
    switch (chosen.method) {
    case SPRING_EULER:
        log_rho2 = log1p(z2);
        phi = atan(z);
        break;
    case SPRING_LEAPFROG:
        phi = 2 * asin(z / 2); /* NaN where unstable */
        break;
    default:
        log_rho2 = log1p(z2 * z2 * z2 * (z2 / 576 - 1.0 / 72));
        phi = atan2(z - z * z2 / 6, 1 - z2 / 2 + z2 * z2 / 24);
        break;
    }
    return (iterate){(double)n * log_rho2 / 2, (double)n * phi};
}

static double rounding_bound(uint64_t n)
{
    return 2.5 * DBL_EPSILON * (double)n;
}

static double error_bound(uint64_t n)
{
    const iterate u = iterate_after(n);
    return fabs(expm1(u.log_growth)) + fabs(u.phase - duration) + rounding_bound(n);
}

static double iterate_error(uint64_t n)
{
    const iterate u = iterate_after(n);
    return fabs(exp(u.log_growth) * cos(u.phase) - cos(duration));
}

static _Noreturn void fail_for_rounding(void)
{
    cli_fail(CLI_FAILED, "%s cannot be shown to stay within %.17g m: rounding is of that size",
             cli_methods[chosen.method], match_error);
}

static uint64_t settled_from(void)
{
    const double largest = 1e9; /* [s]; the phase at the end is then known to 1e-7 */
    if (match_error < 100 * DBL_EPSILON * duration || duration > largest)
        fail_for_rounding();
    uint64_t low = (uint64_t)duration, high = low + 1; /* z <= 1 from high on */
    while (!(error_bound(high) <= match_error)) {
        if (rounding_bound(high) > match_error)
            fail_for_rounding();
        low = high;
        high *= 2;
    }
    while (high - low > 1) {
        const uint64_t middle = low + (high - low) / 2;
        if (error_bound(middle) <= match_error)
            high = middle;
        else
            low = middle;
    }
    return high;
}

static void write_match(cli_table *table)
{
    uint64_t n = settled_from();
    while (n > 1 && iterate_error(n - 1) <= match_error)
        n--;
    const double error = measured_error(n), previous = n > 1 ? measured_error(n - 1) : INFINITY;
    if (!(error <= match_error && previous > match_error))
        cli_fail(CLI_FAILED,
                 "theory says %" PRIu64 " steps, but with them the error is %.17g m, with one less %.17g m",
                 n, error, previous);
    uint64_t first = 1;
    while (!(iterate_error(first) <= match_error))
        first++;
    cli_columns(table, "method n dt_s error_m force_evaluations match_error_m previous_error_m first_n");
    cli_row(table, "%s\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64 "\t%.17g\t%.17g\t%" PRIu64,
            cli_methods[chosen.method], n, duration / (double)n, error, force_evaluations(n), match_error,
            previous, first);
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
