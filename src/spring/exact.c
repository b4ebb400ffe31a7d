/* SPDX-License-Identifier: MIT */
/* The exact solution of one spring: exact_formula_tmpl.h for one number instead of a SIMD vector. */
#include "exact_formula_tmpl.h"

spring_propagator spring_propagator_of(const spring_quotients *r, double t, bool loaded)
{
    const exact_coefficients c = exact_coefficients_of(r->omega2, r->b, r->rest, t, loaded);
    return (spring_propagator){c.half, c.F, c.G, c.H, c.wH, c.P, c.decay_rate};
}

spring_state spring_exact(spring_state s, const spring_params *p, double t)
{
    const spring_quotients r = spring_quotients_of(p->stiffness, p->damping, p->mass);
    const double a = p->load / p->mass;
    const spring_propagator propagator = spring_propagator_of(&r, t, a != 0);
    const exact_coefficients c = exact_prepare(&propagator);
    exact_step(&s.x, &s.v, a, &c, a != 0);
    return s;
}

double spring_expm1(double x)
{
    const double beyond = 750; /* 0, or infinite */
    const exponential y = exponential_of(x > beyond ? beyond : x < -beyond ? -beyond : x);
    const double power = power_of_two(y.k);
    return (power - 1) + power * y.e;
}

void spring_sine_cosine(double angle, double *sine, double *cosine)
{
    const sine_cosine both = sine_cosine_of(angle);
    *sine = both.sine;
    *cosine = both.cosine;
}

void spring_step_exact(spring_state *s, const spring_params *p, double dt)
{
    *s = spring_exact(*s, p, dt);
}
