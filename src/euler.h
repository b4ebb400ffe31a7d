/* SPDX-License-Identifier: MIT */
/*
 * Explicit Euler for a damped, loaded spring.
 *
 * Method    x1 = x + h v;   v1 = v - ((h w) x - h a + (h g) v)
 * Order     1. Undamped error after time T: about (w h T/2) times the amplitude.
 * Limit     (1 + h r) over the roots r of the spring must lie in the unit circle: h < g/w for complex roots,
 *           h < 2/(fast root) for real ones. Undamped never: E grows by 1 + w h^2 a step, exactly.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section I.7
 */
#ifndef SPRINGSTEP_EULER_H
#define SPRINGSTEP_EULER_H

#include "method.h"

typedef struct euler_coefficients {
    real hw, hg, ha;
} euler_coefficients;

SPRING_INLINE void euler_prepare(euler_coefficients *c, spring_rates r, real h, bool damped, bool loaded)
{
    c->hw = h * r.w;
    if (damped)
        c->hg = h * r.g + 0;
    if (loaded)
        c->ha = h * r.a + 0;
}

SPRING_INLINE void euler_step(real *x, real *v, real h, const euler_coefficients *c, bool damped, bool loaded)
{
    real pull = c->hw * *x;
    if (loaded)
        pull -= c->ha;
    if (damped)
        pull += c->hg * *v;
    *x += h * *v;
    *v -= pull;
}

#if defined(SPRING_SHAPE_ONE)
#define SPRING_METHOD euler
#include "one_loop.h"

void spring_step_euler(spring_state *s, const spring_params *p, double dt)
{
    euler_one_step(s, p, dt);
}

static double euler_stable_step(const spring_roots *r)
{
    if (r->overdamped)
        return 2 / spring_fast_root(r);
    if (r->w > 0)
        return 2 * r->b / r->w;
    return INFINITY;
}

static step_terms euler_terms(step_rates r)
{
    return exponential_terms(r, 1);
}

static const one_method euler_one = {
    .info = {.name = "euler", .order = 1, .forces_per_step = 1, .springs = true, .scenes = true, .label = "Euler"},
    .kernel = spring_step_euler,
    .loop = {{euler_plain, euler_loaded}, {euler_damped, euler_damped_loaded}},
    .stable_step = euler_stable_step,
    .terms = euler_terms,
    .digest = UINT64_C(0x6787cf92808bbfe2),
};

#elif defined(SPRING_SHAPE_BATCH)
#define SPRING_METHOD euler
#include "batch_loop.h"

#elif defined(SPRING_SHAPE_SCENE)
static scene_outcome euler_scene_step(const scene_step *s)
{
    const scene_motion m = scene_motion_of(s);
    return (scene_outcome){.finite = scene_move(s, &m, s->kernels->stage)};
}

static double euler_scene_stable_step(const scene_bounds *b)
{
    return b->stiffness_sum > 0 ? fmin(b->drag / b->stiffness_sum, 2 / b->damping) : 2 / b->damping;
}

static const scene_method euler_scene = {.step = euler_scene_step, .stable_step = euler_scene_stable_step};
#endif

#endif
