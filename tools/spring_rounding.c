/* SPDX-License-Identifier: MIT */
/*
 * spring-rounding: how the rounding errors of a long run grow, from several starts, with and without compensated sums.
 *
 * The computed state is compared with the same method in exact arithmetic, so the difference is rounding error only.
 */
#include <math.h>
#include <stddef.h>

#include <springstep/spring.h>

#include "common/cli.h"
#include "common/run_length.h"
#include "harness/reference.h"

static const char *const sums[] = {"plain", "compensated", NULL};
enum { PLAIN, COMPENSATED };

enum { first_row = 10000 }; /* steps */

static int method, sum;
static run_length length = {.steps = 10000000, .dt = 0.01};

static const cli_option options[] = {
    {"method", CLI_METHOD, .choice = &method, .offers = cli_for_steps, .required = true, .value = "M"},
    {"sum", CLI_CHOICE, .choice = &sum, .choices = sums, .required = true, .value = "S",
     .help = "plain, as in the library, or compensated (leapfrog and rk4 only)"},
    {"steps", CLI_COUNT, .count = &length.steps, .least = first_row, .most = CLI_MOST_STEPS, .value = "N",
     .help = "print rows up to N steps"},
    {"dt", CLI_POSITIVE, .real = &length.dt, .value = "DT", .help = "step [s]"},
    {"duration", CLI_POSITIVE, .real = &length.duration, .value = "H",
     .help = "simulated time [s]; two of H, N and DT set the third"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-rounding",
    .summary = "Measure how the rounding errors of an undamped spring grow with the number of steps.",
    .details = "The computed state is compared with the same method in 115-digit arithmetic, so the difference is\n"
               "rounding error only. 1e9 steps take about half a minute.\n\n"
               "A warning is printed if the step is not below the stable step.",
    .columns = "method sum start steps dt_s state_error energy_error coefficient_error",
    .meaning = "start is 0 to 7: initial phases, spread evenly over a period. There are two rows for each power of\n"
               "ten from 1e4 steps to N. state_error is relative to the amplitude, in (x, v/omega). energy_error is\n"
               "relative to the energy. coefficient_error is the phase shift [rad] caused by the rounding error of\n"
               "dt stiffness/mass, which is the same in every step.",
    .shown = {"steps", "state_error"},
    .examples = {"--method leapfrog --sum plain --steps 1e5", "--method rk4 --sum compensated --steps 1e5",
                 "--method euler --sum plain --dt 0.001 --duration 100 -o rounding.tsv"},
    .options = options,
};

/* ----------------------------------------------------------------------------------------------- compensated sums */

/*
 * Leapfrog and RK4 with compensated summation: the rounding error of each sum is kept and added to the next. The library
 * does not use it, for speed. Here it separates the rounding error of x and v from other errors.
 *
 * Source    Knuth, The Art of Computer Programming 2 (1997), section 4.2.2 (the rounding error of a sum is a double);
 *           Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section VIII.5 (its use in a long run)
 */
enum { compensated_springs = 8 }; /* advanced together: with SIMD that takes hardly longer than one */

/* States x + x_rest, v + v_rest. */
typedef struct compensated_state {
    double x[compensated_springs], v[compensated_springs];           /* [m], [m/s] */
    double x_rest[compensated_springs], v_rest[compensated_springs]; /* 0 at the start */
} compensated_state;

/* number + rest += d, where rest is at most an ulp of the number */
static inline void add(double *number, double *rest, double d)
{
    const double add = d + *rest, total = *number + add, added = total - *number;
    *rest = (*number - (total - added)) + (add - added);
    *number = total;
}

static void leapfrog_steps(compensated_state *s, double w, double h, uint64_t n)
{
    const double K = h / 2 * w;
    for (; n > 0; n--)
        for (int i = 0; i < compensated_springs; i++) {
            add(&s->v[i], &s->v_rest[i], -(K * s->x[i]));
            add(&s->x[i], &s->x_rest[i], h * s->v[i]);
            add(&s->v[i], &s->v_rest[i], -(K * s->x[i]));
        }
}

/* src/methods/rk4_tmpl.h without damping: E = 1/2 - W/24, F = -W/6. */
static void rk4_steps(compensated_state *s, double w, double h, uint64_t n)
{
    const double hw = h * w, W = h * hw, same = -W * (12 - W) / 24, cross = -W / 6;
    const double hcross = h * cross, hwcross = hw * cross;
    for (; n > 0; n--)
        for (int i = 0; i < compensated_springs; i++) {
            const double x = s->x[i], v = s->v[i];
            add(&s->x[i], &s->x_rest[i], h * v + (same * x + hcross * v));
            add(&s->v[i], &s->v_rest[i], (same * v - hwcross * x) - hw * x);
        }
}

/* ------------------------------------------------------------------------------------------------------- the run */

static const spring_params spring = {.mass = 1.3, .stiffness = 2.7};

static void advance(compensated_state *s, uint64_t n)
{
    const spring_method m = (spring_method)method;
    if (sum == COMPENSATED) {
        compensated_state now = *s; /* a local copy, so that the compiler can keep it in registers */
        (m == SPRING_LEAPFROG ? leapfrog_steps : rk4_steps)(&now, spring.stiffness / spring.mass, length.dt, n);
        *s = now;
        return;
    }
    for (int i = 0; i < compensated_springs; i++) {
        spring_state one = {s->x[i], s->v[i]};
        spring_advance(&one, &spring, m, length.dt, n);
        s->x[i] = one.x;
        s->v[i] = one.v;
    }
}

static compensated_state starts(void)
{
    const double two_pi = 6.283185307179586, omega = sqrt(spring.stiffness / spring.mass);
    compensated_state s = {.x = {0}};
    for (int i = 0; i < compensated_springs; i++) {
        const double phase = two_pi * (i + 0.3) / compensated_springs; /* no start on an axis */
        s.x[i] = cos(phase);
        s.v[i] = omega * sin(phase);
    }
    return s;
}

static double coefficient_error(uint64_t n)
{
    const double w = spring.stiffness / spring.mass, hw = length.dt * w;
    return (double)n * length.dt * sqrt(w) * fabs(fma(length.dt, w, -hw) / hw) / 2;
}

static void compare(cli_table *table, const compensated_state *from, const compensated_state *s, uint64_t n)
{
    reference iterate;
    reference_init(&iterate);
    for (int i = 0; i < compensated_springs; i++) {
        const spring_state start = {from->x[i], from->v[i]}, got = {s->x[i], s->v[i]};
        reference_start(&iterate, &spring, start);
        reference_iterate(&iterate, &spring, (spring_method)method, length.dt, n);
        cli_row(table, "%s\t%s\t%d\t%" PRIu64 "\t%.17g\t%.17g\t%.17g\t%.17g", spring_method_name((spring_method)method),
                sums[sum], i, n, length.dt, reference_distance(&iterate, got), reference_energy_error(&iterate, got),
                coefficient_error(n));
    }
    reference_clear(&iterate);
}

/* 1e4, 3e4, 1e5, ... steps */
static uint64_t next_row(uint64_t n)
{
    return n % 3 == 0 ? n / 3 * 10 : n * 3;
}

int main(int argc, char **argv)
{
    const uint64_t leap = UINT64_C(1) << 22; /* steps between two calls of cli_progress() */
    cli_parse(&program, argc, argv);
    if (sum == COMPENSATED && method != SPRING_LEAPFROG && method != SPRING_RK4)
        cli_fail(CLI_USAGE, "--sum: \"compensated\" is for leapfrog and rk4 only; with --method %s it should be plain",
                 spring_method_name((spring_method)method));
    run_length_settle(&length);
    if (length.steps < first_row)
        cli_fail(CLI_USAGE,
                 "--duration: \"%g\" makes %" PRIu64 " steps of %g s; it should be at least %d of them, %g s",
                 length.duration, length.steps, length.dt, first_row, first_row * length.dt);
    uint64_t last = first_row;
    while (next_row(last) <= length.steps)
        last = next_row(last);
    cli_table *table = cli_open_output();
    cli_columns(table, program.columns);
    run_length_remark_step(length.dt, spring_stable_step(&spring, (spring_method)method), (spring_method)method);
    const compensated_state from = starts();
    compensated_state s = from;
    uint64_t done = 0;
    for (uint64_t n = first_row; n <= last; n = next_row(n)) {
        while (done < n) {
            const uint64_t some = n - done < leap ? n - done : leap;
            advance(&s, some);
            done += some;
            cli_progress((double)done / (double)last);
        }
        compare(table, &from, &s, n);
    }
    cli_finish();
    mpfr_free_cache();
    return 0;
}
