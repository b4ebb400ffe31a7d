/* SPDX-License-Identifier: MIT */
/*
 * spring-stability: the stability limit of each method, found by taking steps and without any formula.
 *
 * A step is unstable if a generic start grows: ln(max |y| over steps N/2 ... N / max |y| over steps N/4 ... N/2) > 1e-3
 * with N = 10^6. Below a damping ratio of 0.1, growth near the limit is too slow for this: one part in 10^4 above the
 * limit, Euler at 0.01 grows by 2 % in 10^6 steps. There the growth is taken from the eigenvalues of the matrix of a
 * step, which is formed from steps of two basis states. The limit is found by bisection.
 *
 * With --map: the error of each method after ten periods, over the step and the damping ratio, stable or not.
 */
#include <math.h>
#include <stddef.h>

#include <springstep/spring.h>

#include "common/cli.h"

static uint64_t points = 64;
static bool map;

static const cli_option options[] = {
    {"points", CLI_COUNT, .count = &points, .least = 1, .most = 10000, .value = "N",
     .help = "number of damping ratios from 0.01 to 100, in addition to 0"},
    {"map", CLI_FLAG, .flag = &map,
     .help = "instead, print the error after ten periods on a grid\n"
             "The grid has N damping ratios from 0.01 to 100 and N steps omega dt from 0.001 to 10."},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-stability",
    .summary = "Measure the stable step of each method as a function of the damping ratio.",
    .details = "The limit is found by simulation. This takes about a minute with the default number of points.",
    .columns = "method damping_ratio limit_measured limit_theory relative_error",
    .meaning = "limit_measured is the largest stable step omega dt found by simulation. limit_theory is the stable\n"
               "step omega dt of spring_stable_step().\n\n"
               "With --map: method, omega_dt, damping_ratio, error. The error is the distance from the exact state\n"
               "in (x, v/omega), relative to the start at rest, after the whole number of steps nearest to ten\n"
               "undamped periods. It is inf if the state overflows.",
    .shown = {"damping_ratio", "limit_measured"},
    .examples = {"--points 1", "--map --points 10", "--map --points 50 -o map.tsv"},
    .options = options,
};

static const double mass = 1.3, omega = 2.7; /* [kg], [1/s] */

static const uint64_t N = 1000000;        /* steps of a trial */
static const double growth_seen = 1e-3;   /* increase of the logarithm from one window to the next */
static const double least_by_trial = 0.1; /* least damping ratio for trials */
static const double width = 1e-6;         /* relative width of the bisection; the required accuracy is 1e-4 */
static const double negligible = 1e-200;  /* a state that started at size 1 counts as decayed below this */

static spring_params spring_of(double damping_ratio)
{
    return (spring_params){mass, mass * omega * omega, 2 * damping_ratio * mass * omega, 0};
}

static spring_state generic_start(void)
{
    return (spring_state){0.8, -0.9 * omega};
}

static double largest(spring_state *s, const spring_params *p, spring_method m, double dt, uint64_t n)
{
    spring_step_fn *const step = spring_method_kernel(m);
    double most = 0;
    for (; n > 0; n--) {
        step(s, p, dt);
        const double size = fabs(s->x) + fabs(s->v) * (1 / omega);
        if (size > most)
            most = size;
    }
    return isfinite(s->x) && isfinite(s->v) ? most : INFINITY;
}

static bool grows_by_trial(const spring_params *p, spring_method m, double dt)
{
    spring_state s = generic_start();
    for (uint64_t n = 0; n < N / 4; n += 1000) {
        const double size = largest(&s, p, m, dt, 1000);
        if (!isfinite(size) || size < negligible)
            return !isfinite(size);
    }
    const double early = largest(&s, p, m, dt, N / 4);
    if (!isfinite(early) || early < negligible)
        return !isfinite(early);
    const double late = largest(&s, p, m, dt, N / 2);
    return !isfinite(late) || log(late / early) > growth_seen;
}

/* ln of the modulus of the larger eigenvalue of the matrix of a step. */
static double growth_of_map(const spring_params *p, spring_method m, double dt)
{
    spring_step_fn *const step = spring_method_kernel(m);
    spring_state e = {1, 0}, f = {0, omega};
    step(&e, p, dt);
    step(&f, p, dt);
    const double half_trace = (e.x + f.v / omega) / 2, det = (e.x * f.v - e.v * f.x) / omega;
    const double under_root = half_trace * half_trace - det;
    return under_root < 0 ? log(det) / 2 : log(fabs(half_trace) + sqrt(under_root));
}

/* The computed growth of a norm-preserving map is the rounding error of its entries. */
static const double growth_of_rounding = 1e-14;

static bool grows(const spring_params *p, double damping_ratio, spring_method m, double dt)
{
    if (damping_ratio >= least_by_trial)
        return grows_by_trial(p, m, dt);
    return growth_of_map(p, m, dt) > growth_of_rounding;
}

/* Checks that no step is stable, instead of bisecting: steps of every size with resolvable growth must grow. */
static bool always_grows(const spring_params *p, spring_method m)
{
    for (double z = 0.01; z < 10; z *= 1.1)
        if (!(growth_of_map(p, m, z / omega) > growth_of_rounding))
            return false;
    return true;
}

static double measured_limit(double damping_ratio, spring_method m)
{
    const spring_params p = spring_of(damping_ratio);
    if (damping_ratio == 0 && always_grows(&p, m))
        return 0;
    double high = 1e-3;
    while (!grows(&p, damping_ratio, m, high / omega) && high < 1e6)
        high *= 2;
    double low = high / 2;
    while (high - low > width * high) {
        const double middle = (low + high) / 2;
        if (grows(&p, damping_ratio, m, middle / omega))
            high = middle;
        else
            low = middle;
    }
    return low;
}

/* ---------------------------------------------------------------------------------------------------------- rows */

/* The i-th of N values, equally spaced on a logarithmic axis. */
static double spaced(double first, double last, uint64_t i)
{
    const double part = points > 1 ? (double)i / (double)(points - 1) : 0;
    return first * pow(last / first, part);
}

static double damping_ratio_of(uint64_t i)
{
    return spaced(0.01, 100, i);
}

static void write_limit(cli_table *table, spring_method m, double damping_ratio)
{
    const spring_params p = spring_of(damping_ratio);
    const double measured = measured_limit(damping_ratio, m);
    const double theory = spring_stable_step(&p, m) * omega;
    const double error = theory > 0 ? fabs(measured - theory) / theory : fabs(measured - theory);
    cli_row(table, "%s\t%.17g\t%.17g\t%.17g\t%.17g", spring_method_name(m), damping_ratio, measured, theory, error);
}

static void write_limits(cli_table *table, spring_method m, uint64_t i)
{
    if (i == 0)
        write_limit(table, m, 0);
    write_limit(table, m, damping_ratio_of(i));
}

static double error_after_ten_periods(const spring_params *p, spring_method m, double dt)
{
    const double duration = 10 * 6.283185307179586 / omega;
    const uint64_t n = (uint64_t)rint(duration / dt);
    const spring_state start = generic_start();
    spring_state got = start, exact = start;
    if (spring_advance(&got, p, m, dt, n) != SPRING_OK)
        return INFINITY;
    spring_advance(&exact, p, SPRING_EXACT, dt, n);
    return hypot(got.x - exact.x, (got.v - exact.v) / omega) / hypot(start.x, start.v / omega);
}

static void write_errors(cli_table *table, spring_method m, uint64_t i)
{
    const double damping_ratio = damping_ratio_of(i);
    const spring_params p = spring_of(damping_ratio);
    for (uint64_t j = 0; j < points; j++) {
        const double omega_dt = spaced(0.001, 10, j);
        cli_row(table, "%s\t%.17g\t%.17g\t%.17g", spring_method_name(m), omega_dt, damping_ratio,
                error_after_ten_periods(&p, m, omega_dt / omega));
    }
}

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    cli_table *table = cli_open_output();
    cli_columns(table, map ? "method omega_dt damping_ratio error" : program.columns);
    for (int k = 0; k < SPRING_METHOD_COUNT; k++) {
        const spring_method m = spring_method_at(k);
        if (!cli_for_steps(spring_method_describe(m)))
            continue;
        for (uint64_t i = 0; i < points; i++) {
            (map ? write_errors : write_limits)(table, m, i);
            cli_progress((k + (double)(i + 1) / (double)points) / SPRING_METHOD_COUNT);
        }
    }
    cli_finish();
    return 0;
}
