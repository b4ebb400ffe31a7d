/* SPDX-License-Identifier: MIT */
/* The number of steps that a method needs for one spring; see plan.h. */
#include <math.h>

#include "common/timing.h"
#include "plan.h"

static const double most_steps = 3e8; /* of a measured run: a second or two */

/* The largest singular value of (a b; c d). */
static double norm(double a, double b, double c, double d)
{
    return (hypot(a + d, b - c) + hypot(a - d, b + c)) / 2;
}

/* Compares a run from both unit states with the exact solution: at each of the first 2^16 steps, where fast-decaying
   components have their error, and at as many of the others. */
static double measured_error(const spring_params *p, spring_method m, double duration, double steps)
{
    const double dense = 65536, omega = fmax(sqrt(p->stiffness / p->mass), 1 / duration), dt = duration / steps;
    const uint64_t n = (uint64_t)steps, stride = (uint64_t)ceil(steps / dense);
    const spring_state start[2] = {{1, 0}, {0, omega}};
    spring_state run[2] = {start[0], start[1]};
    double most = 0;
    for (uint64_t i = 0; i < n;) {
        const uint64_t wanted = (double)i < dense ? 1 : stride, some = wanted < n - i ? wanted : n - i;
        i += some;
        spring_state off[2];
        for (int k = 0; k < 2; k++) {
            if (spring_advance(&run[k], p, m, dt, some) != SPRING_OK)
                return INFINITY;
            spring_state exact = start[k];
            spring_step_exact(&exact, p, dt * (double)i);
            off[k] = (spring_state){run[k].x - exact.x, run[k].v - exact.v};
        }
        most = fmax(most, norm(off[0].x, off[1].x, off[0].v / omega, off[1].v / omega));
    }
    return most;
}

/* Running time [s]: the shortest of five loops of at least 0.2 ms. */
static double time_of(const spring_params *p, spring_method m, double dt, uint64_t n)
{
    const double long_enough = 2e5; /* [ns] */
    double best = INFINITY;
    uint64_t runs = 1;
    for (int loop = 0; loop < 5; loop++) {
        spring_state s = {0.8, -0.9};
        const double before = timing_now();
        for (uint64_t i = 0; i < runs; i++)
            spring_advance(&s, p, m, dt, n);
        const double spent = timing_now() - before;
        best = fmin(best, spent / (double)runs);
        if (spent < long_enough) {
            runs *= 2;
            loop = -1;
            best = INFINITY;
        }
    }
    return best * 1e-9;
}

plan_row plan_spring(const spring_params *p, spring_method m, double duration, double error)
{
    const double dt = spring_accurate_step(p, m, duration, error);
    if (dt == 0)
        return (plan_row){.method = m, .predicted = NAN, .measured = NAN, .uncertainty = NAN, .time = INFINITY};
    const double steps = rint(duration / dt), timed = fmin(steps, most_steps / 30);
    return (plan_row){
        .method = m,
        .steps = steps,
        .dt = dt,
        .evaluations = steps * spring_method_describe(m)->forces_per_step,
        .predicted = spring_step_error(p, m, duration, dt),
        .measured = steps <= most_steps ? measured_error(p, m, duration, steps) : NAN,
        .uncertainty = 0,
        .time = time_of(p, m, dt, (uint64_t)timed) * (steps / timed),
    };
}
