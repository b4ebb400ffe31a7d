/* SPDX-License-Identifier: MIT */
/*
 * The settling time of a spring.
 *
 * Method    Measured from the rest position, y(t) is monotone between the zeros of v, the turning points. They are
 *           spaced by pi/split for an oscillating spring; an overdamped spring has at most one. The amplitude at the
 *           turning points decreases by a fixed factor. After the last turning point beyond x_tol, |y| falls below
 *           x_tol and stays below. The first turning point and the crossing are found by bisection of time on the exact
 *           solution, so the time is bit-identical wherever the solution is. The velocity obeys the equation of a spring
 *           without load, with the acceleration as its derivative, so the same search finds when it stays within v_tol.
 * Special   Without stiffness, the particle stops at x + v/g if there is damping and no load. At an infinite time, the
 *           exact solution is NaN, which ends every search.
 * Accuracy  bisection of the computed exact solution ends at adjacent doubles. For a tolerance within the rounding
 *           error of the state, the result is not significant
 */
#include <stddef.h>

#include "exact_formula_tmpl.h"
#include "propagator.h"

#include "../simd/size_begin.h"

static const double pi = 3.141592653589793;

typedef struct motion {
    spring_state start; /* from the rest position */
    spring_params params;
    spring_roots roots;
    double tol; /* [m] */
} motion;

/* Of the rest position or, without stiffness, of the point where the particle will stop, v/g ahead. */
static bool is_within(const motion *m, double t)
{
    const double g = 2 * m->roots.b;
    if (m->roots.omega2 > 0)
        return !(fabs(spring_exact(m->start, &m->params, t).x) > m->tol);
    const exact_halves E = exact_halves_of(-g * t);
    return !(fabs(m->start.v * E.other * E.half / g) > m->tol);
}

static bool has_turned(const motion *m, double t)
{
    const double v = spring_exact(m->start, &m->params, t).v;
    return !(m->start.v > 0 ? v > 0 : v < 0);
}

/* The first time in (before .. after] at which is_true() holds. It does not hold at `before`. */
static double first_time(const motion *m, bool is_true(const motion *, double), double before, double after)
{
    for (;;) {
        const double middle = before + (after - before) / 2;
        if (!(middle > before && middle < after))
            return after;
        if (is_true(m, middle))
            after = middle;
        else
            before = middle;
    }
}

/* A time at which is_true() holds: `from` plus 1/b, doubled as often as necessary; may be infinite. */
static double some_time(const motion *m, bool is_true(const motion *, double), double from)
{
    double span = 1 / m->roots.b;
    while (!is_true(m, from + span))
        span *= 2;
    return from + span;
}

/* The time after the last turning point beyond the tolerance. Turning point n is at first + n spacing, and turning
   point 0 is beyond. Bisection between turning points n and 2n, n a power of two, tests turning points alone until the
   interval is one spacing. */
static double after_last_swing(const motion *m, double first, double spacing)
{
    double beyond = 0, within = 1;
    while (!is_within(m, first + within * spacing)) {
        beyond = within;
        within *= 2;
    }
    return first_time(m, is_within, first + beyond * spacing, first + within * spacing);
}

static double settling_oscillating(const motion *m)
{
    const double spacing = pi / m->roots.split;
    const double first = m->start.v != 0 ? first_time(m, has_turned, 0, spacing) : 0;
    if (is_within(m, first))
        return is_within(m, 0) ? 0 : first_time(m, is_within, 0, first);
    return m->roots.b == 0 ? (double)INFINITY : after_last_swing(m, first, spacing);
}

/* If a spring never turns, has_turned() holds once its velocity underflows; then the spring is at rest. */
static double settling_creeping(const motion *m)
{
    const double turn = m->start.v != 0 ? first_time(m, has_turned, 0, some_time(m, has_turned, 0)) : 0;
    if (is_within(m, turn))
        return is_within(m, 0) ? 0 : first_time(m, is_within, 0, turn);
    return first_time(m, is_within, turn, some_time(m, is_within, turn));
}

double spring_settling_time(const spring_state *s, const spring_params *p, double x_tol)
{
    if (s == NULL || !spring_finite(s->x) || !spring_finite(s->v) || !spring_params_valid(p) || !(x_tol >= 0))
        return (double)NAN;
    motion m = {
        .start = {s->x, s->v},
        .params = {p->mass, p->stiffness, p->damping, 0},
        .roots = spring_roots_of(p),
        .tol = x_tol,
    };
    if (m.roots.omega2 > 0)
        m.start.x -= p->load / p->stiffness;
    if (!spring_finite(m.start.x) || (m.roots.omega2 == 0 && p->load != 0))
        return (double)INFINITY;
    if (m.tol == 0) /* a moving spring does not stay at distance 0 */
        return m.start.v == 0 && is_within(&m, 0) ? 0 : (double)INFINITY;
    return m.roots.overdamped || m.roots.split == 0 ? settling_creeping(&m) : settling_oscillating(&m);
}

double spring_rest_time(const spring_state *s, const spring_params *p, double x_tol, double v_tol)
{
    const double time = spring_settling_time(s, p, x_tol);
    if (time != time || !(v_tol >= 0))
        return (double)NAN;
    const spring_roots r = spring_roots_of(p);
    const spring_params unloaded = {p->mass, p->stiffness, p->damping, 0};
    const double y = r.omega2 > 0 ? s->x - p->load / p->stiffness : 0;
    const spring_state rate = {s->v, -r.omega2 * y - 2 * r.b * s->v};
    if (!spring_finite(time) || !spring_finite(rate.v))
        return (double)INFINITY;
    return fmax(time, spring_settling_time(&rate, &unloaded, v_tol));
}

#include "../simd/size_end.h"
