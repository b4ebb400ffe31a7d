/* SPDX-License-Identifier: MIT */
/*
 * Explicit Euler for a damped, loaded spring.
 *
 * Method    x1 = x + h v;   v1 = v - ((h w) x - h a + (h g) v)
 * Order     1. Undamped error after time T: about (w h T/2) times the amplitude.
 * Limit     (1 + h r) over the roots r of the spring must lie in the unit circle: h < g/w for complex roots,
 *           h < 2/(fast root) for real ones. Never stable without damping: a step multiplies the energy E by 1 + w h^2.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/spring/test_iterate.c)
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section I.7
 */
#ifndef SPRINGSTEP_EULER_TMPL_H
#define SPRINGSTEP_EULER_TMPL_H

#include "method_tmpl.h"

SPRING_INLINE void euler_prepare(step_coefficients *c, spring_rates r, real h, bool damped, bool loaded)
{
    c->omega2 = h * r.omega2;
    if (damped)
        c->gamma = h * r.gamma + 0; /* + 0 turns the -0 of a negative step into 0 */
    if (loaded)
        c->accel = h * r.accel + 0;
}

SPRING_INLINE void euler_step(real *x, real *v, real *kept, real h, const step_coefficients *c, bool damped,
                              bool loaded)
{
    (void)kept;
    real pull = c->omega2 * *x;
    if (loaded)
        pull -= c->accel;
    if (damped)
        pull += c->gamma * *v;
    *x += h * *v;
    *v -= pull;
}

#ifndef SPRING_VECTOR
void spring_step_euler(spring_state *s, const spring_params *p, double dt)
{
    take_one_step(s, p, dt, euler_prepare, keeps_nothing, euler_step);
}

static double euler_stable_step(const spring_roots *r)
{
    if (r->overdamped)
        return 2 / spring_fast_root(r);
    if (r->omega2 > 0)
        return 2 * r->b / r->omega2;
    return (double)INFINITY;
}

static step_terms euler_terms(step_rates r)
{
    return exponential_terms(r, 1);
}

static const spring_method_info euler_info = {
    .name = "euler", .order = 1, .forces_per_step = 1, .springs = true, .scenes = true, .label = "Euler"};
static const method_row euler_method = {
    .info = &euler_info,
    .kernel = spring_step_euler,
    .stable_step = euler_stable_step,
    .terms = euler_terms,
    .digest = UINT64_C(0x6787cf92808bbfe2),
};
#endif

#endif
