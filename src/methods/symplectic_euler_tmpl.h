/* SPDX-License-Identifier: MIT */
/*
 * Symplectic (semi-implicit) Euler for a damped, loaded spring. The damping is implicit.
 *
 * Method    v1 = (v - ((h w) x - h a)) / (1 + q),   x1 = x + h v1,   q = h g
 *           Without damping the step is two shears, which preserve the phase-space area at any rounding error of their
 *           coefficients. So the energy error stays bounded over any number of steps. The method is leapfrog with an
 *           offset of half a step: x and v + h/2 (a - w x) are a leapfrog run.
 * Order     1. Without damping the step conserves v^2/2 + w x^2/2 - h w x v/2. The energy error is at most about z/2 of
 *           E from rest, and z from any start, z = h sqrt(w). The phase error is the same as with leapfrog.
 * Limit     trace 1 + (1 - h^2 w)/(1 + q), determinant 1/(1 + q): stable for h^2 w < 4 + 2 h g, that is
 *           h < (g + sqrt(g^2 + 4 w))/w.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/spring/test_iterate.c)
 * Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 */
#ifndef SPRINGSTEP_SYMPLECTIC_EULER_TMPL_H
#define SPRINGSTEP_SYMPLECTIC_EULER_TMPL_H

#include "method_tmpl.h"

SPRING_INLINE void symplectic_euler_prepare(step_coefficients *c, spring_rates r, real h, bool damped, bool loaded)
{
    c->omega2 = h * r.omega2;
    if (loaded)
        c->accel = h * r.accel + 0;
    if (damped) {
        const real q = h * r.gamma;
        c->damping = implicit_factors_of(q);
        c->damping.leading += q - q; /* NaN for infinite q, where 1/(1 + q) would be 0 */
    }
}

SPRING_INLINE void symplectic_euler_step(real *x, real *v, real *kept, real h, const step_coefficients *c, bool damped,
                                         bool loaded)
{
    (void)kept;
    const real pull = c->omega2 * *x;
    const real u = *v - (loaded ? pull - c->accel : pull);
    *v = damped ? implicit_velocity(u, &c->damping) : u;
    *x += h * *v;
}

#ifndef SPRING_VECTOR
void spring_step_symplectic_euler(spring_state *s, const spring_params *p, double dt)
{
    take_one_step(s, p, dt, symplectic_euler_prepare, keeps_nothing, symplectic_euler_step);
}

/* (g + sqrt(g^2 + 4 w))/w = 2 (b + sqrt(b^2 + omega^2))/omega^2 */
static double symplectic_euler_stable_step(const spring_roots *r)
{
    return r->omega > 0 ? 2 / r->omega * ((r->b + spring_hypot(r->b, r->omega)) / r->omega) : (double)INFINITY;
}

static step_terms symplectic_euler_terms(step_rates r)
{
    return (step_terms){.implicit = 1, .term = {[1] = {r.G, r.a, -r.c, 0}, {-r.a * r.c, 0, 0, 0}}};
}

static const spring_method_info symplectic_euler_info = {.name = "symplectic-euler",
                                                         .order = 1,
                                                         .forces_per_step = 1,
                                                         .symplectic = true,
                                                         .springs = true,
                                                         .scenes = true,
                                                         .label = "symplectic Euler"};
static const method_row symplectic_euler_method = {
    .info = &symplectic_euler_info,
    .kernel = spring_step_symplectic_euler,
    .stable_step = symplectic_euler_stable_step,
    .terms = symplectic_euler_terms,
    .digest = UINT64_C(0x6cfdd78e15b74620),
};
#endif

#endif
