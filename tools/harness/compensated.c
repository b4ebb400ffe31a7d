/* SPDX-License-Identifier: MIT */
/*
 * Leapfrog and RK4 with compensated summation; see compensated.h.
 *
 * Source    Knuth, The Art of Computer Programming 2 (1997), section 4.2.2 (the rounding error of a sum is a double);
 *           Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section VIII.5 (its use in a long run)
 */
#include "harness/compensated.h"

/* sum + rest += d, where rest is at most an ulp of sum */
static inline void add(double *sum, double *rest, double d)
{
    const double add = d + *rest, total = *sum + add, added = total - *sum;
    *rest = (*sum - (total - added)) + (add - added);
    *sum = total;
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

bool compensated_knows(spring_method m)
{
    return m == SPRING_LEAPFROG || m == SPRING_RK4;
}

void compensated_advance(compensated_state *s, const spring_params *p, spring_method m, double dt, uint64_t n)
{
    const double w = p->stiffness / p->mass;
    compensated_state now = *s; /* a local copy, so that the compiler can keep it in registers */
    (m == SPRING_LEAPFROG ? leapfrog_steps : rk4_steps)(&now, w, dt, n);
    *s = now;
}
