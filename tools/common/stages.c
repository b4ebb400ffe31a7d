/* SPDX-License-Identifier: MIT */
/*
 * The classical Runge-Kutta method of order 4, stage by stage:
 *
 *     k1 = f(y),  k2 = f(y + h/2 k1),  k3 = f(y + h/2 k2),  k4 = f(y + h k3),   f(x, v) = (v, a - w x - g v)
 *
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1;
 *           GNU Scientific Library 2.7.1, ode-initval2/rk4.c, for the order of its sum
 */
#include "common/stages.h"

typedef struct rates {
    double w, g, a; /* stiffness/mass [1/s^2], damping/mass [1/s], load/mass [m/s^2] */
} rates;

typedef struct stages {
    spring_state k1, k2, k3, k4; /* dx/dt and dv/dt at the four stages */
} stages;

static rates rates_of(const spring_params *p)
{
    return (rates){p->stiffness / p->mass, p->damping / p->mass, p->load / p->mass};
}

static inline spring_state slope(spring_state y, rates r)
{
    return (spring_state){y.v, r.a - r.w * y.x - r.g * y.v};
}

static inline spring_state add(spring_state y, double h, spring_state k)
{
    return (spring_state){y.x + h * k.x, y.v + h * k.v};
}

static inline stages evaluate(spring_state y, rates r, double h)
{
    const spring_state k1 = slope(y, r);
    const spring_state k2 = slope(add(y, h / 2, k1), r);
    const spring_state k3 = slope(add(y, h / 2, k2), r);
    const spring_state k4 = slope(add(y, h, k3), r);
    return (stages){k1, k2, k3, k4};
}

void stages_advance(spring_state *s, const spring_params *p, double h, uint64_t n)
{
    const rates r = rates_of(p);
    spring_state y = *s;
    for (; n > 0; n--) {
        const stages k = evaluate(y, r, h);
        const spring_state sum = {k.k1.x + 2 * k.k2.x + 2 * k.k3.x + k.k4.x, k.k1.v + 2 * k.k2.v + 2 * k.k3.v + k.k4.v};
        y = add(y, h / 6, sum);
    }
    *s = y;
}

void stages_advance_gsl(spring_state *s, const spring_params *p, double h, uint64_t n)
{
    const rates r = rates_of(p);
    spring_state y = *s;
    for (; n > 0; n--) {
        const stages k = evaluate(y, r, h);
        y = add(add(add(add(y, h / 6, k.k1), h / 3, k.k2), h / 3, k.k3), h / 6, k.k4);
    }
    *s = y;
}
