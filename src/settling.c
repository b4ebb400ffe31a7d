/* SPDX-License-Identifier: MIT */
/*
 * The settling time: when a spring has come to rest.
 *
 * Method    Measured from the rest position, y(t) is monotone between the zeros of v, which are known: evenly spaced
 *           by pi/split for an oscillating spring, at most one for an overdamped one. The swings at these turning
 *           points shrink by a fixed factor, so the last swing beyond x_tol is found by a logarithm; after it y enters
 *           the band for good, at a crossing found by bisection on the exact solution.
 * Special   no stiffness: the particle stops at x + v/g, if there is damping and no load.
 * Accuracy  bisection ends at adjacent doubles; what it bisects is the exact solution as computed, so a tolerance
 *           within its rounding error of the state gives a time that means nothing
 */
#include <stddef.h>

#include "propagator.h"
#include "roots.h"
#include "simd/real.h"

static const double pi = 3.141592653589793;

static double swing(spring_state start, const spring_params *p, double t)
{
    return fabs(spring_exact(start, p, t).x);
}

/* The first time in (inside .. outside], |y(outside)| > tol >= |y(inside)|, from which on |y| <= tol. */
static double bisect(spring_state start, const spring_params *p, double outside, double inside, double tol)
{
    for (;;) {
        const double middle = outside + (inside - outside) / 2;
        if (!(middle > outside && middle < inside))
            return inside;
        if (swing(start, p, middle) <= tol)
            inside = middle;
        else
            outside = middle;
    }
}

static double log_ratio(double large, double small) /* small may be 0, of either sign */
{
    const double ratio = large / small;
    return isinf(ratio) ? log(large) - log(small) : log(ratio);
}

/* A state in the same direction, of a size that squares of frequencies cannot make overflow. */
static spring_state direction(spring_state y)
{
    int exponent;
    frexp(fmax(fabs(y.x), fabs(y.v)), &exponent);
    return (spring_state){ldexp(y.x, -exponent), ldexp(y.v, -exponent)};
}

static double settling_oscillating(spring_state y, const spring_params *p, const spring_roots *r, double tol)
{
    const double spacing = pi / r->split;
    const spring_state u = direction(y);
    /* a zero of v in (-spacing, spacing] */
    double first = atan2(u.v * r->split, r->w * u.x + r->b * u.v) / r->split;
    if (first < 0)
        first += spacing;
    const double largest = swing(y, p, first);
    if (!(largest > tol))
        return fabs(y.x) > tol ? bisect(y, p, 0, first, tol) : 0;
    if (r->b == 0 || tol == 0)
        return INFINITY;
    double last = first + floor(log_ratio(largest, tol) / (r->b * spacing)) * spacing;
    if (!(swing(y, p, last) > tol)) /* rounding of the logarithm, either way */
        last -= spacing;
    else if (swing(y, p, last + spacing) > tol)
        last += spacing;
    return bisect(y, p, last, last + spacing, tol);
}

static double settling_creeping(spring_state y, const spring_params *p, const spring_roots *r, double tol)
{
    const spring_state u = direction(y);
    const double T = u.v / (r->w * u.x + r->b * u.v); /* tanh(split t)/split at the turning point */
    double turn = 0;
    if (T > 0 && r->split * T < 1)
        turn = r->split > 0 ? atanh(r->split * T) / r->split : T;
    if (!(swing(y, p, turn) > tol))
        return fabs(y.x) > tol ? bisect(y, p, 0, turn, tol) : 0;
    if (tol == 0)
        return INFINITY;
    double span = 1 / spring_slow_root(r);
    while (span < INFINITY && swing(y, p, turn + span) > tol)
        span *= 2;
    return span < INFINITY ? bisect(y, p, turn, turn + span, tol) : INFINITY;
}

static double settling_free(double v, double g, double tol)
{
    if (v == 0)
        return 0;
    const double distance = fabs(v / g); /* still to go; infinite without damping */
    return distance > tol ? log_ratio(distance, tol) / g : 0;
}

double spring_settling_time(const spring_state *s, const spring_params *p, double x_tol)
{
    if (s == NULL || !isfinite(s->x) || !isfinite(s->v) || !spring_params_valid(p) || !(x_tol >= 0))
        return NAN;
    const spring_roots r = spring_roots_of(p);
    if (r.w == 0)
        return p->load == 0 ? settling_free(s->v, 2 * r.b, x_tol) : INFINITY;
    const spring_params unloaded = {p->mass, p->stiffness, p->damping, 0};
    const spring_state y = {s->x - p->load / p->stiffness, s->v};
    if (!isfinite(y.x))
        return INFINITY;
    if (r.overdamped || r.split == 0)
        return settling_creeping(y, &unloaded, &r, x_tol);
    return settling_oscillating(y, &unloaded, &r, x_tol);
}
