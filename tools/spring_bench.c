/* SPDX-License-Identifier: MIT */
/*
 * spring-bench: what a step costs, beside the plain loop that anybody would write.
 *
 * Method    A sample is the time of a fixed number of steps, from the same start. Samples of the library and of the
 *           plain loop alternate, so that what slows the machine down for a while slows both; each figure is the median
 *           of its samples. Start and parameters come out of volatile objects and the end goes into one: nothing can
 *           be computed by the compiler, or left out.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/spring.h>

#include "cli.h"
#include "timing.h"

static int only_kernel = -1;
static bool quick;

static cli_option options[] = {
    {"kernel", CLI_CHOICE, .choice = &only_kernel, .value = "NAME", .help = "only this row"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer and shorter samples: a second in all"},
    {.name = NULL},
};

static const double noisy_spread = 0.05; /* --help says it, too */

static const cli_program program = {
    .name = "spring-bench",
    .summary = "What a step of a spring costs, beside a plain loop in the same run.",
    .details =
        "Columns: kernel, precision, count (springs), ns_per_spring_step, limit_ns (the plain loop),\n"
        "ratio (of the two), spread, verdict, goal_ratio and goal_ns (what the library promises; inf:\n"
        "nothing).\n\n"
        "Kernels: METHOD is spring_advance() over many steps, METHOD_call a loop of calls of the kernel,\n"
        "METHOD_advance_1 of spring_advance() by one step; _damped, _loaded: with damping, with load.\n"
        "Limits: the same steps written out in a loop, in registers: Euler; kick, drift, kick; the four\n"
        "stages of rk4; for exact the textbook formula of an underdamped spring, exp, cos and sin.\n"
        "leapfrog_denormal starts from 1e-310 m; its limit is leapfrog from an ordinary start.\n\n"
        "Figures are medians of samples that alternate with those of the limit. spread is the distance\n"
        "between the quartiles over the median, the larger one of kernel and limit. verdict is ok, noisy\n"
        "(spread above 0.05: the machine was busy, the row proves nothing) or above_goal. No verdict\n"
        "changes the exit status: time is for people to judge.",
    .options = options,
};

/* Light damping and short steps: over the few hundred seconds that a sample lasts for the spring,
   nothing overflows, dies out or becomes denormal. */
static volatile const double mass = 1.3, stiffness = 2.7, damping = 0.06, load = 0.9, x0 = 0.83, v0 = -0.59;
static volatile const double dt = 1e-4;
static volatile double sink;

/* ------------------------------------------------------------------------------------------------- the plain loop */

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline)) /* constant arguments shape the loops */
#else
#define INLINE static inline
#endif

typedef struct model {
    double w, g, a; /* stiffness/mass [1/s^2], damping/mass [1/s], load/mass [m/s^2] */
    bool damped, loaded;
} model;

INLINE double acceleration(double x, double v, model m)
{
    double result = -(m.w * x);
    if (m.loaded)
        result += m.a;
    if (m.damped)
        result -= m.g * v;
    return result;
}

INLINE spring_state plain_euler(spring_state s, model m, double h)
{
    return (spring_state){s.x + h * s.v, s.v + h * acceleration(s.x, s.v, m)};
}

INLINE spring_state plain_leapfrog(spring_state s, model m, double h)
{
    s.v += h / 2 * acceleration(s.x, s.v, m);
    s.x += h * s.v;
    s.v += h / 2 * acceleration(s.x, 0, m);
    if (m.damped)
        s.v *= 1 / (1 + h / 2 * m.g); /* computed once, before the loop */
    return s;
}

INLINE spring_state plain_rk4(spring_state s, model m, double h)
{
    const spring_state k1 = {s.v, acceleration(s.x, s.v, m)};
    const spring_state y2 = {s.x + h / 2 * k1.x, s.v + h / 2 * k1.v};
    const spring_state k2 = {y2.v, acceleration(y2.x, y2.v, m)};
    const spring_state y3 = {s.x + h / 2 * k2.x, s.v + h / 2 * k2.v};
    const spring_state k3 = {y3.v, acceleration(y3.x, y3.v, m)};
    const spring_state y4 = {s.x + h * k3.x, s.v + h * k3.v};
    const spring_state k4 = {y4.v, acceleration(y4.x, y4.v, m)};
    return (spring_state){
        s.x + h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x),
        s.v + h / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v),
    };
}

INLINE spring_state plain_exact(spring_state s, model m, double t)
{
    const double b = m.g / 2, split = sqrt(m.w - b * b);
    const double E = m.damped ? exp(-b * t) : 1, C = cos(split * t), S = sin(split * t) / split;
    const double rest = m.loaded ? m.a / m.w : 0, y = s.x - rest;
    return (spring_state){rest + E * (C * y + S * (s.v + b * y)), E * (C * s.v - S * (m.w * y + b * s.v))};
}

typedef spring_state plain_step(spring_state s, model m, double h);

INLINE spring_state plain_loop(plain_step *step, spring_state s, model m, double h, uint64_t n)
{
    for (; n > 0; n--)
        s = step(s, m, h);
    return s;
}

INLINE spring_state plain_steps(plain_step *step, spring_state s, model m, double h, uint64_t n)
{
    const double w = m.w, g = m.g, a = m.a;
    if (m.damped && m.loaded)
        return plain_loop(step, s, (model){w, g, a, true, true}, h, n);
    if (m.damped)
        return plain_loop(step, s, (model){w, g, 0, true, false}, h, n);
    if (m.loaded)
        return plain_loop(step, s, (model){w, 0, a, false, true}, h, n);
    return plain_loop(step, s, (model){w, 0, 0, false, false}, h, n);
}

static spring_state run_plain(spring_method method, spring_state s, const spring_params *p, double h,
                              uint64_t n)
{
    const model m = {p->stiffness / p->mass, p->damping / p->mass, p->load / p->mass, p->damping != 0,
                     p->load != 0};
    switch (method) {
    case SPRING_EULER:
        return plain_steps(plain_euler, s, m, h, n);
    case SPRING_LEAPFROG:
        return plain_steps(plain_leapfrog, s, m, h, n);
    case SPRING_RK4:
        return plain_steps(plain_rk4, s, m, h, n);
    case SPRING_EXACT:
        for (; n > 0; n--)
            s = plain_exact(s, m, dt); /* volatile: evaluated anew at every step, as the library does */
    }
    return s;
}

/* --------------------------------------------------------------------------------------------------- the library */

typedef enum form { ADVANCE, CALL, ADVANCE_1 } form;

static void (*const kernels[])(spring_state *s, const spring_params *p, double dt) = {
    [SPRING_EULER] = spring_step_euler,
    [SPRING_LEAPFROG] = spring_step_leapfrog,
    [SPRING_RK4] = spring_step_rk4,
    [SPRING_EXACT] = spring_step_exact,
};

static spring_state run_library(spring_method method, form f, spring_state s, const spring_params *p,
                                double h, uint64_t n)
{
    switch (f) {
    case ADVANCE:
        spring_advance(&s, p, method, h, n);
        break;
    case CALL:
        for (; n > 0; n--)
            kernels[method](&s, p, h);
        break;
    case ADVANCE_1:
        for (; n > 0; n--)
            spring_advance(&s, p, method, h, 1);
        break;
    }
    return s;
}

/* ---------------------------------------------------------------------------------------------------- the samples */

enum { most_samples = 101 };

typedef struct row {
    const char *kernel;
    spring_method method;
    form form;
    bool damped, loaded;
    double goal_ratio, goal_ns; /* [1], [ns] */
    double size;                /* of the start; where it is not 1, the limit is the same kernel at 1 */
} row;

/* Time of a step of a kernel, or of its limit [ns]. */
static double sample(const row *r, bool limit, uint64_t n)
{
    const bool plain = limit && r->size == 1;
    const double size = limit ? 1 : r->size;
    const spring_params p = {mass, stiffness, r->damped ? damping : 0, r->loaded ? load : 0};
    spring_state s = {size * x0, size * v0};
    const double h = dt, start = timing_now();
    s = plain ? run_plain(r->method, s, &p, h, n) : run_library(r->method, r->form, s, &p, h, n);
    const double elapsed = timing_now() - start;
    sink = s.x + s.v;
    return elapsed / (double)n;
}

/* As many steps as fill the time. */
static uint64_t steps_for(const row *r, bool limit, double time_ns)
{
    uint64_t n = 1024;
    while (sample(r, limit, n) * (double)n < time_ns)
        n *= 2;
    return n;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct figure {
    double median, spread;
} figure;

static figure summarise(double *samples, size_t count)
{
    qsort(samples, count, sizeof *samples, ascending);
    const double median = samples[count / 2];
    return (figure){median, (samples[count - 1 - count / 4] - samples[count / 4]) / median};
}

/* Measures and writes one row. */
static void measure(cli_table *table, const row *r)
{
    const size_t count = quick ? 15 : most_samples;
    const double sample_ns = quick ? 1e6 : 4e6;
    double kernel[most_samples], beside[most_samples];
    const uint64_t n = steps_for(r, false, sample_ns), n_beside = steps_for(r, true, sample_ns);
    for (size_t i = 0; i < count; i++) {
        kernel[i] = sample(r, false, n);
        beside[i] = sample(r, true, n_beside);
    }
    const figure ours = summarise(kernel, count), limit = summarise(beside, count);
    const double ratio = ours.median / limit.median, spread = fmax(ours.spread, limit.spread);
    const bool noisy = !(spread <= noisy_spread);
    const bool holds = ratio <= r->goal_ratio && ours.median <= r->goal_ns;
    cli_row(table, "%s\tdouble\t1\t%.4g\t%.4g\t%.4g\t%.2g\t%s\t%g\t%g", r->kernel, ours.median, limit.median,
            ratio, spread,
            noisy   ? "noisy"
            : holds ? "ok"
                    : "above_goal",
            r->goal_ratio, r->goal_ns);
}

/* ------------------------------------------------------------------------------------------------------ the table */

static const row rows[] = {
    {"euler", SPRING_EULER, ADVANCE, false, false, INFINITY, INFINITY, 1},
    {"euler_damped", SPRING_EULER, ADVANCE, true, false, INFINITY, INFINITY, 1},
    {"euler_loaded", SPRING_EULER, ADVANCE, false, true, INFINITY, INFINITY, 1},
    {"euler_damped_loaded", SPRING_EULER, ADVANCE, true, true, INFINITY, INFINITY, 1},
    {"leapfrog", SPRING_LEAPFROG, ADVANCE, false, false, 0.95, INFINITY, 1},
    {"leapfrog_damped", SPRING_LEAPFROG, ADVANCE, true, false, INFINITY, INFINITY, 1},
    {"leapfrog_loaded", SPRING_LEAPFROG, ADVANCE, false, true, INFINITY, INFINITY, 1},
    {"leapfrog_damped_loaded", SPRING_LEAPFROG, ADVANCE, true, true, INFINITY, INFINITY, 1},
    {"rk4", SPRING_RK4, ADVANCE, false, false, 0.45, INFINITY, 1},
    {"rk4_damped", SPRING_RK4, ADVANCE, true, false, INFINITY, INFINITY, 1},
    {"rk4_loaded", SPRING_RK4, ADVANCE, false, true, INFINITY, INFINITY, 1},
    {"rk4_damped_loaded", SPRING_RK4, ADVANCE, true, true, INFINITY, INFINITY, 1},
    {"euler_call", SPRING_EULER, CALL, false, false, INFINITY, 12, 1},
    {"euler_advance_1", SPRING_EULER, ADVANCE_1, false, false, INFINITY, 12, 1},
    {"leapfrog_call", SPRING_LEAPFROG, CALL, false, false, INFINITY, 12, 1},
    {"leapfrog_advance_1", SPRING_LEAPFROG, ADVANCE_1, false, false, INFINITY, 12, 1},
    {"rk4_call", SPRING_RK4, CALL, false, false, INFINITY, 12, 1},
    {"rk4_advance_1", SPRING_RK4, ADVANCE_1, false, false, INFINITY, 12, 1},
    {"exact_call", SPRING_EXACT, CALL, false, false, INFINITY, INFINITY, 1},
    {"exact_damped_call", SPRING_EXACT, CALL, true, false, INFINITY, INFINITY, 1},
    {"exact_damped_loaded_call", SPRING_EXACT, CALL, true, true, INFINITY, INFINITY, 1},
    {"exact_damped_loaded_advance_1", SPRING_EXACT, ADVANCE_1, true, true, INFINITY, INFINITY, 1},
    {"leapfrog_denormal", SPRING_LEAPFROG, ADVANCE, false, false, INFINITY, INFINITY, 1e-310},
};

enum { row_count = sizeof rows / sizeof rows[0] };

static void name_kernels(void)
{
    static const char *names[row_count + 1]; /* ended by NULL */
    for (size_t i = 0; i < row_count; i++)
        names[i] = rows[i].kernel;
    options[0].choices = names;
}

int main(int argc, char **argv)
{
    name_kernels();
    cli_parse(&program, argc, argv);
    cli_table *table = cli_open_output();
    timing_stamp(table);
    cli_columns(table,
                "kernel precision count ns_per_spring_step limit_ns ratio spread verdict goal_ratio goal_ns");
    for (size_t i = 0; i < row_count; i++) {
        cli_progress((double)i / row_count);
        if (only_kernel < 0 || i == (size_t)only_kernel)
            measure(table, &rows[i]);
    }
    cli_finish();
    return 0;
}
