/* SPDX-License-Identifier: MIT */
/*
 * Leapfrog (kick, drift, kick) for a damped, loaded spring. The last half kick is implicit in the damping.
 *
 * Method    kick   v' = v - (K x - A + q v)          K = w h/2,  A = a h/2,  q = g h/2
 *           drift  x1 = x + h v'
 *           kick   v1 = (v' - (K x1 - A)) / (1 + q)
 *           Kick and drift are shears, which preserve the phase-space area at any rounding error of K. So the energy
 *           error of an undamped spring stays bounded over any number of steps.
 * Order     2. Undamped phase error after time T: w^(3/2) h^2 T/24; energy error at most z^2/4 of E,
 *           z^2 = w h^2, from a start at rest, and z^2/4/(1 - z^2/4) of E from any.
 * Limit     h sqrt(w) < 2 at every damping: the step has trace 2 (1 - w h^2/2)/(1 + q), determinant (1 - q)/(1 + q).
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/spring/test_iterate.c)
 * Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 */
#ifndef SPRINGSTEP_LEAPFROG_TMPL_H
#define SPRINGSTEP_LEAPFROG_TMPL_H

#include "method_tmpl.h"

SPRING_INLINE void leapfrog_prepare(step_coefficients *c, spring_rates r, real h, bool damped, bool loaded)
{
    const real half = h / 2;
    c->omega2 = half * r.omega2;
    if (loaded)
        c->accel = half * r.accel + 0;
    if (damped) {
        c->gamma = half * r.gamma;
        c->damping = implicit_factors_of(c->gamma);
    }
}

/* -h/2 times the acceleration at x, without damping */
SPRING_INLINE real leapfrog_force(real x, const step_coefficients *c, bool loaded)
{
    return loaded ? c->omega2 * x - c->accel : c->omega2 * x;
}

/* force: at x; the first kick of the next step reuses it */
SPRING_INLINE void leapfrog_step(real *x, real *v, real *force, real h, const step_coefficients *c, bool damped,
                                 bool loaded)
{
    *v -= damped ? *force + c->gamma * *v : *force;
    *x += h * *v;
    *force = leapfrog_force(*x, c, loaded);
    *v -= *force;
    if (damped)
        *v = implicit_velocity(*v, &c->damping);
}

#ifndef SPRING_VECTOR
void spring_step_leapfrog(spring_state *s, const spring_params *p, double dt)
{
    take_one_step(s, p, dt, leapfrog_prepare, leapfrog_force, leapfrog_step);
}

static double leapfrog_stable_step(const spring_roots *r)
{
    return 2 / r->omega; /* infinite without stiffness, by IEEE 754 */
}

static step_terms leapfrog_terms(step_rates r)
{
    const double a = r.a, c = r.c, q = r.G / 2, W = a * c;
    return (step_terms){
        .implicit = 0.5,
        .term = {[1] = {q, a, -c, -q}, {-W / 2, 0, 0, -W / 2}, {-q * W / 2, -q * q * a, c * W / 4, q * W / 2}},
    };
}

static const spring_method_info leapfrog_info = {.name = "leapfrog",
                                                 .order = 2,
                                                 .forces_per_step = 1,
                                                 .symplectic = true,
                                                 .springs = true,
                                                 .scenes = true,
                                                 .label = "leapfrog"};
static const method_row leapfrog_method = {
    .info = &leapfrog_info,
    .kernel = spring_step_leapfrog,
    .stable_step = leapfrog_stable_step,
    .terms = leapfrog_terms,
    .digest = UINT64_C(0x4f14f334987d813a),
};
#endif

#endif
