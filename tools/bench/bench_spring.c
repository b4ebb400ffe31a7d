/* SPDX-License-Identifier: MIT */
/*
 * spring-bench, one spring: the library compared with a plain loop.
 *
 * The initial state and the parameters are read from volatile objects, and the result is written to one, so that the
 * compiler cannot evaluate or omit anything.
 */
#include <stdio.h>

#include "common/cli.h"
#include "common/timing.h"
#include "rows.h"

/* Short steps: within the few hundred seconds that a sample simulates, nothing overflows or becomes subnormal. */
static volatile const double mass = 1.3, stiffness = 2.7, zero = 0, x0 = 0.83, v0 = -0.59;
static volatile const double dt = 1e-4;
static volatile double sink;

/* ------------------------------------------------------------------------------------------------- the plain loop */

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline)) /* specialises loops for constant arguments */
#else
#define INLINE static inline
#endif

INLINE double acceleration(double x, double w)
{
    return -(w * x);
}

INLINE spring_state plain_euler(spring_state s, double w, double h)
{
    return (spring_state){s.x + h * s.v, s.v + h * acceleration(s.x, w)};
}

INLINE spring_state plain_kick_and_drift(spring_state s, double w, double h)
{
    s.v += h * acceleration(s.x, w);
    s.x += h * s.v;
    return s;
}

INLINE spring_state plain_leapfrog(spring_state s, double w, double h)
{
    s.v += h / 2 * acceleration(s.x, w);
    s.x += h * s.v;
    s.v += h / 2 * acceleration(s.x, w);
    return s;
}

INLINE spring_state plain_rk4(spring_state s, double w, double h)
{
    const spring_state k1 = {s.v, acceleration(s.x, w)};
    const spring_state k2 = {s.v + h / 2 * k1.v, acceleration(s.x + h / 2 * k1.x, w)};
    const spring_state k3 = {s.v + h / 2 * k2.v, acceleration(s.x + h / 2 * k2.x, w)};
    const spring_state k4 = {s.v + h * k3.v, acceleration(s.x + h * k3.x, w)};
    return (spring_state){
        s.x + h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x),
        s.v + h / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v),
    };
}

typedef spring_state plain_step(spring_state s, double w, double h);

INLINE spring_state plain_loop(plain_step *step, spring_state s, double w, double h, uint64_t n)
{
    for (; n > 0; n--)
        s = step(s, w, h);
    return s;
}

spring_state bench_textbook(spring_state s, double w, double g, double a, double t, bool damped, bool loaded)
{
    const double b = g / 2, D = w - b * b, split = sqrt(fabs(D)), E = damped ? exp(-b * t) : 1;
    const double C = D > 0 ? cos(split * t) : cosh(split * t), S = (D > 0 ? sin(split * t) : sinh(split * t)) / split;
    const double rest_x = loaded ? a / w : 0, y = s.x - rest_x;
    return (spring_state){rest_x + E * (C * y + S * (s.v + b * y)), E * (C * s.v - S * (w * y + b * s.v))};
}

static const char *limit_of(spring_method m)
{
    static const char *const names[SPRING_METHOD_COUNT] = {
        [SPRING_EULER] = "loop", [SPRING_LEAPFROG] = "loop", [SPRING_RK4] = "loop", [SPRING_EXACT] = "textbook"};
    return names[m] != NULL ? names[m] : "kicks";
}

static spring_state run_plain(spring_method method, spring_state s, const spring_params *p, double h, uint64_t n)
{
    const double w = p->stiffness / p->mass;
    const uint64_t forces = (uint64_t)spring_method_describe(method)->forces_per_step;
    switch (method) {
    case SPRING_EULER:
        return plain_loop(plain_euler, s, w, h, n);
    case SPRING_LEAPFROG:
        return plain_loop(plain_leapfrog, s, w, h, n);
    case SPRING_RK4:
        return plain_loop(plain_rk4, s, w, h, n);
    case SPRING_EXACT: /* volatile dt: evaluated in every step, as in the library */
        for (; n > 0; n--)
            s = bench_textbook(s, w, p->damping, p->load, dt, p->damping != 0, p->load != 0);
        return s;
    default: /* "kicks": a kick and a drift for each force evaluation */
        return plain_loop(plain_kick_and_drift, s, w, h / (double)forces, n * forces);
    }
}

/* ------------------------------------------------------------------------------------------------------- the rows */

typedef struct subject {
    spring_method method;
    double size; /* of the initial state; if it is not 1, the limit is the same kernel at 1 */
} subject;

static double run(const bench_row *row, int which, uint64_t n)
{
    const subject *r = row->subject;
    const bool limit = which > 0;
    const double size = limit ? 1 : r->size;
    const spring_params p = {mass, stiffness, zero, zero};
    spring_state s = {size * x0, size * v0};
    const double h = dt, begin = timing_busy();
    if (limit && r->size == 1)
        s = run_plain(r->method, s, &p, h, n);
    else if (r->method != SPRING_EXACT)
        spring_advance(&s, &p, r->method, h, n);
    else
        for (spring_step_fn *const step = spring_method_kernel(SPRING_EXACT); n > 0; n--)
            step(&s, &p, h);
    const double elapsed = timing_busy() - begin;
    sink = s.x + s.v;
    return elapsed;
}

static void add(spring_method m, double size, const char *ending)
{
    const subject s = {m, size};
    bench_row row = {
        .part = "spring",
        .precision = "double",
        .count = 1,
        .steps = 1,
        .goal_ratio = size != 1              ? INFINITY
                      : m == SPRING_LEAPFROG ? 0.95
                      : m == SPRING_RK4      ? 0.45
                                             : INFINITY,
        .goal_ns = INFINITY,
        .limits = {size != 1 ? "ordinary" : limit_of(m)},
        .time = run,
    };
    snprintf(row.kernel, sizeof row.kernel, "%s%s", spring_method_name(m), ending);
    bench_add(&row, &s, sizeof s);
}

void bench_add_springs(void)
{
    for (int i = 0; i < SPRING_METHOD_COUNT; i++)
        if (cli_for_steps(spring_method_describe(spring_method_at(i))))
            add(spring_method_at(i), 1, "");
    add(SPRING_EXACT, 1, "_call");
    add(SPRING_LEAPFROG, 1e-310, "_denormal");
}
