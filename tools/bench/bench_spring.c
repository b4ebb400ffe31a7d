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
#include "parts.h"
#include "rows.h"

/* Light damping and short steps: within the few hundred seconds that a sample simulates, nothing overflows, decays to 0
   or becomes subnormal. */
static volatile const double mass = 1.3, stiffness = 2.7, damping = 0.06, load = 0.9, x0 = 0.83, v0 = -0.59;
static volatile const double dt = 1e-4;
static volatile double sink;

/* ------------------------------------------------------------------------------------------------- the plain loop */

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline)) /* specialises loops for constant arguments */
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

INLINE spring_state plain_kick_and_drift(spring_state s, model m, double h)
{
    s.v += h * acceleration(s.x, s.v, m);
    s.x += h * s.v;
    return s;
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
    const model m = {p->stiffness / p->mass, p->damping / p->mass, p->load / p->mass, p->damping != 0, p->load != 0};
    const uint64_t forces = (uint64_t)spring_method_describe(method)->forces_per_step;
    switch (method) {
    case SPRING_EULER:
        return plain_steps(plain_euler, s, m, h, n);
    case SPRING_LEAPFROG:
        return plain_steps(plain_leapfrog, s, m, h, n);
    case SPRING_RK4:
        return plain_steps(plain_rk4, s, m, h, n);
    case SPRING_EXACT:
        for (; n > 0; n--)
            s = bench_textbook(s, m.w, m.g, m.a, dt, m.damped,
                               m.loaded); /* volatile dt: evaluated in every step, as in the library */
        return s;
    default: /* "kicks": a kick and a drift for each force evaluation */
        return plain_steps(plain_kick_and_drift, s, m, h / (double)forces, n * forces);
    }
}

/* --------------------------------------------------------------------------------------------------- the library */

typedef enum form { ADVANCE, CALL, ADVANCE_1 } form;

static spring_state run_library(spring_method method, form f, spring_state s, const spring_params *p, double h,
                                uint64_t n)
{
    spring_step_fn *const step = spring_method_kernel(method);
    switch (f) {
    case ADVANCE:
        spring_advance(&s, p, method, h, n);
        break;
    case CALL:
        for (; n > 0; n--)
            step(&s, p, h);
        break;
    case ADVANCE_1:
        for (; n > 0; n--)
            spring_advance(&s, p, method, h, 1);
        break;
    }
    return s;
}

/* ------------------------------------------------------------------------------------------------------- the rows */

typedef struct subject {
    spring_method method;
    form form;
    bool damped, loaded;
    double size; /* of the initial state; if it is not 1, the limit is the same kernel at 1 */
} subject;

static double run(const bench_row *row, int which, uint64_t n)
{
    const subject *r = row->subject;
    const bool limit = which > 0, plain = limit && r->size == 1;
    const double size = limit ? 1 : r->size;
    const spring_params p = {mass, stiffness, r->damped ? damping : 0, r->loaded ? load : 0};
    spring_state s = {size * x0, size * v0};
    const double h = dt, begin = timing_busy();
    s = plain ? run_plain(r->method, s, &p, h, n) : run_library(r->method, r->form, s, &p, h, n);
    const double elapsed = timing_busy() - begin;
    sink = s.x + s.v;
    return elapsed;
}

static void add(const subject *r, const char *ending)
{
    const char *name = spring_method_name(r->method);
    const bool whole = r->form == ADVANCE && r->size == 1 && !r->damped && !r->loaded;
    bench_row row = {
        .part = "spring",
        .precision = "double",
        .count = 1,
        .steps = 1,
        .goal_ratio = whole && r->method == SPRING_LEAPFROG ? 0.95
                      : whole && r->method == SPRING_RK4    ? 0.45
                                                            : INFINITY,
        .goal_ns = r->form != ADVANCE && r->method != SPRING_EXACT ? 12 : INFINITY,
        .limits = {r->size != 1 ? "ordinary" : limit_of(r->method)},
        .time = run,
    };
    snprintf(row.kernel, sizeof row.kernel, "%s%s%s%s%s", name, r->damped ? "_damped" : "", r->loaded ? "_loaded" : "",
             r->size != 1 ? "_denormal" : "", ending);
    bench_add(&row, r, sizeof *r);
}

void bench_add_springs(void)
{
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        if (!cli_for_steps(spring_method_describe(m)))
            continue;
        for (int features = 0; features < 4; features++)
            add(&(subject){m, ADVANCE, features % 2 == 1, features / 2 == 1, 1}, "");
        add(&(subject){m, CALL, false, false, 1}, "_call");
        add(&(subject){m, ADVANCE_1, false, false, 1}, "_advance_1");
    }
    add(&(subject){SPRING_EXACT, CALL, false, false, 1}, "_call");
    add(&(subject){SPRING_EXACT, CALL, true, false, 1}, "_call");
    add(&(subject){SPRING_EXACT, CALL, true, true, 1}, "_call");
    add(&(subject){SPRING_EXACT, ADVANCE_1, true, true, 1}, "_advance_1");
    add(&(subject){SPRING_LEAPFROG, ADVANCE, false, false, 1e-310}, "");
}
