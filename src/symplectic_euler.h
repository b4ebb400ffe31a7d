/* SPDX-License-Identifier: MIT */
/*
 * Symplectic (semi-implicit) Euler for a damped, loaded spring; the damping is solved for.
 *
 * Method    v1 = (v - ((h w) x - h a)) / (1 + q),   x1 = x + h v1,   q = h g
 *           Without damping two shears: they keep the phase-space area whatever the rounding, so the energy error stays
 *           bounded over any number of steps. It is leapfrog seen half a step late: x and v + h/2 (a - w x) are a
 *           leapfrog run.
 * Order     1. Without damping it conserves v^2/2 + w x^2/2 - h w x v/2: the energy error is at most about z/2 of E,
 *           z = h sqrt(w), and the phase is leapfrog's.
 * Limit     trace 1 + (1 - h^2 w)/(1 + q), determinant 1/(1 + q): stable for h^2 w < 4 + 2 h g, that is
 *           h < (g + sqrt(g^2 + 4 w))/w.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 */
#ifndef SPRINGSTEP_SYMPLECTIC_EULER_H
#define SPRINGSTEP_SYMPLECTIC_EULER_H

#include "method.h"
#include "solved_kick.h"

typedef struct symplectic_euler_coefficients {
    real hw, ha;
    real keep, lose; /* 1/(1 + q) = keep + lose, see solved_kick.h */
} symplectic_euler_coefficients;

SPRING_INLINE void symplectic_euler_prepare(symplectic_euler_coefficients *c, spring_rates r, real h, bool damped,
                                            bool loaded)
{
    c->hw = h * r.w;
    if (loaded)
        c->ha = h * r.a + 0;
    if (damped) {
        const real q = h * r.g;
        const solved_share share = solved_share_of(q);
        c->keep = share.keep + (q - q); /* NaN where q is infinite: 1/(1 + q) would hide it */
        c->lose = share.lose;
    }
}

SPRING_INLINE void symplectic_euler_step(real *x, real *v, real h, const symplectic_euler_coefficients *c, bool damped,
                                         bool loaded)
{
    const real pull = c->hw * *x;
    const real u = *v - (loaded ? pull - c->ha : pull);
    *v = damped ? c->keep * u + c->lose * u : u;
    *x += h * *v;
}

#if defined(SPRING_SHAPE_ONE)
#define SPRING_METHOD symplectic_euler
#include "one_loop.h"

void spring_step_symplectic_euler(spring_state *s, const spring_params *p, double dt)
{
    symplectic_euler_one_step(s, p, dt);
}

/* (g + sqrt(g^2 + 4 w))/w = 2 (b + sqrt(b^2 + omega^2))/omega^2 */
static double symplectic_euler_stable_step(const spring_roots *r)
{
    return r->omega > 0 ? 2 / r->omega * ((r->b + spring_hypot(r->b, r->omega)) / r->omega) : INFINITY;
}

static step_terms symplectic_euler_terms(step_rates r)
{
    return (step_terms){.share = 1, .term = {[1] = {r.G, r.a, -r.c, 0}, {-r.a * r.c, 0, 0, 0}}};
}

static const one_method symplectic_euler_one = {
    .info = {.name = "symplectic-euler",
             .order = 1,
             .forces_per_step = 1,
             .symplectic = true,
             .springs = true,
             .scenes = true,
             .label = "symplectic Euler"},
    .kernel = spring_step_symplectic_euler,
    .loop = {{symplectic_euler_plain, symplectic_euler_loaded},
             {symplectic_euler_damped, symplectic_euler_damped_loaded}},
    .stable_step = symplectic_euler_stable_step,
    .terms = symplectic_euler_terms,
    .digest = UINT64_C(0x6cfdd78e15b74620),
};

#elif defined(SPRING_SHAPE_BATCH)
#define SPRING_METHOD symplectic_euler
#include "batch_loop.h"

#elif defined(SPRING_SHAPE_SCENE)
static scene_outcome symplectic_euler_scene_step(const scene_step *s)
{
    const scene_motion m = scene_motion_of(s);
    return (scene_outcome){.finite = scene_move(s, &m, s->kernels->solved_kick_drift)};
}

/* Damping of links is explicit and costs stability, drag is solved for and gives some back: a motion with stiffness k,
   damping of links c and drag d, all over the mass, is stable for h^2 k + 2 h c < 4 + 2 h d. */
static double symplectic_euler_scene_stable_step(const scene_bounds *b)
{
    const double excess = b->link_damping - b->least_drag;
    const double root = spring_hypot(fabs(excess), 2 * spring_sqrt(b->stiffness));
    if (excess > 0 || root == 0 || root == INFINITY) /* infinite: no step is known */
        return 4 / (excess + root);
    return (root - excess) / b->stiffness;
}

static const scene_method symplectic_euler_scene = {
    .step = symplectic_euler_scene_step,
    .stable_step = symplectic_euler_scene_stable_step,
};
#endif

#endif
