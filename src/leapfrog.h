/* SPDX-License-Identifier: MIT */
/*
 * Leapfrog (kick, drift, kick) for a damped, loaded spring; the last half kick is solved for the velocity.
 *
 * Method    kick   v' = v - (K x - A + q v)          K = w h/2,  A = a h/2,  q = g h/2
 *           drift  x1 = x + h v'
 *           kick   v1 = (v' - (K x1 - A)) / (1 + q)
 *           Kick and drift are shears: they keep the phase-space area whatever the rounding of K, so the energy error
 *           of an undamped spring stays bounded over any number of steps.
 * Order     2. Undamped phase error after time T: w^(3/2) h^2 T/24; energy error at most z^2/4 of E,
 *           z^2 = w h^2, from a start at rest, and z^2/4/(1 - z^2/4) of E from any.
 * Limit     h sqrt(w) < 2 at every damping: the step has trace 2 (1 - w h^2/2)/(1 + q), determinant (1 - q)/(1 + q).
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 */
#ifndef SPRINGSTEP_LEAPFROG_H
#define SPRINGSTEP_LEAPFROG_H

#include "method.h"
#include "solved_kick.h"

typedef struct leapfrog_coefficients {
    real K, A, q;
    real keep, lose; /* 1/(1 + q) = keep + lose, see solved_kick.h */
} leapfrog_coefficients;

SPRING_INLINE void leapfrog_prepare(leapfrog_coefficients *c, spring_rates r, real h, bool damped, bool loaded)
{
    const real half = h / 2;
    c->K = half * r.w;
    if (loaded)
        c->A = half * r.a + 0;
    if (damped) {
        c->q = half * r.g;
        const solved_share share = solved_share_of(c->q);
        c->keep = share.keep;
        c->lose = share.lose;
    }
}

SPRING_INLINE real leapfrog_force(real x, const leapfrog_coefficients *c, bool loaded) /* times -h/2m */
{
    return loaded ? c->K * x - c->A : c->K * x;
}

SPRING_INLINE real leapfrog_kick(real v, real force, const leapfrog_coefficients *c, bool damped)
{
    return v - (damped ? force + c->q * v : force);
}

SPRING_INLINE real leapfrog_drift(real x, real v, real h)
{
    return x + h * v;
}

SPRING_INLINE real leapfrog_solve(real v, real force, const leapfrog_coefficients *c, bool damped)
{
    const real u = v - force;
    return damped ? c->keep * u + c->lose * u : u;
}

/* force: that at x, which the last kick of a step leaves to the first of the next. */
SPRING_INLINE void leapfrog_step_from(real *x, real *v, real *force, real h, const leapfrog_coefficients *c,
                                      bool damped, bool loaded)
{
    *v = leapfrog_kick(*v, *force, c, damped);
    *x = leapfrog_drift(*x, *v, h);
    *force = leapfrog_force(*x, c, loaded);
    *v = leapfrog_solve(*v, *force, c, damped);
}

SPRING_INLINE void leapfrog_step(real *x, real *v, real h, const leapfrog_coefficients *c, bool damped, bool loaded)
{
    real force = leapfrog_force(*x, c, loaded);
    leapfrog_step_from(x, v, &force, h, c, damped, loaded);
}

#if defined(SPRING_SHAPE_ONE)
#define SPRING_METHOD leapfrog
#include "one_loop.h"

void spring_step_leapfrog(spring_state *s, const spring_params *p, double dt)
{
    leapfrog_one_step(s, p, dt);
}

static double leapfrog_stable_step(const spring_roots *r)
{
    return 2 / r->omega; /* IEEE 754: infinite without stiffness */
}

static step_terms leapfrog_terms(step_rates r)
{
    const double a = r.a, c = r.c, q = r.G / 2, W = a * c;
    return (step_terms){
        .share = 0.5,
        .term = {[1] = {q, a, -c, -q}, {-W / 2, 0, 0, -W / 2}, {-q * W / 2, -q * q * a, c * W / 4, q * W / 2}},
    };
}

static const one_method leapfrog_one = {
    .info = {.name = "leapfrog",
             .order = 2,
             .forces_per_step = 1,
             .symplectic = true,
             .springs = true,
             .scenes = true,
             .label = "leapfrog"},
    .kernel = spring_step_leapfrog,
    .loop = {{leapfrog_plain, leapfrog_loaded}, {leapfrog_damped, leapfrog_damped_loaded}},
    .stable_step = leapfrog_stable_step,
    .terms = leapfrog_terms,
    .digest = UINT64_C(0x4f14f334987d813a),
};

#elif defined(SPRING_SHAPE_BATCH)
#define SPRING_METHOD leapfrog
#define SPRING_OWN_STEPS
SPRING_INLINE void leapfrog_steps(real *x, real *v, real h, const leapfrog_coefficients c[vectors], uint64_t n,
                                  bool damped, bool loaded)
{
    real force[vectors];
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++)
        force[k] = leapfrog_force(x[k], &c[k], loaded);
    for (; n > 0; n--) {
        SPRING_HOT_LOOP("spring", group);
        vec_read_again(c);
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++)
            leapfrog_step_from(&x[k], &v[k], &force[k], h, &c[k], damped, loaded);
    }
}
#include "batch_loop.h"

#elif defined(SPRING_SHAPE_SCENE)
/* Velocities that forces depend on are predicted from the forces at the start of the step: v* = v' + h/2 a(v*), with
   only drag at v*; v1 = v' + h/2 a(x1, v*). So the forces are found once a step, and kept at (x1, v*): being those of a
   velocity that is not the state's, they are part of it. The last kick of a step and the first of the next are one pass
   over the particles. A callback that uses velocities may have changed from call to call: then no forces are kept, they
   are found twice, and each kick is a pass. */
static scene_outcome leapfrog_scene_step(const scene_step *s)
{
    const bool keeps = !scene_callback_uses_velocity(s->scene), predicts = scene_forces_use_velocity(s->scene);
    scene_motion first = scene_motion_of(s), last = scene_motion_of(s);
    first.kick = last.kick = s->h / 2;
    first.predicted = predicts ? scene_predicted(s) : NULL;
    last.force = scene_force_of(s->scene, s->to);
    last.v0 = first.v;
    const bool finite =
        scene_sweep(s, &first, s->kernels->kick_drift[keeps && !s->first][predicts],
                    predicts ? first.predicted : first.v, 1, &last, keeps && !s->last ? NULL : s->kernels->solved_kick);
    return (scene_outcome){.finite = finite, .known = !keeps ? NO_FORCE : predicts ? PREDICTED_FORCE : FORCE};
}

/* With link damping, of stiffness k and damping c over the mass: h^2 k/4 + h c < 1. */
static double leapfrog_scene_stable_step(const scene_bounds *b)
{
    return b->link_damping > 0 ? 2 / (b->damping + spring_hypot(b->damping, spring_sqrt(b->stiffness)))
                               : 2 / spring_sqrt(b->stiffness);
}

static const scene_method leapfrog_scene = {
    .step = leapfrog_scene_step,
    .stable_step = leapfrog_scene_stable_step,
    .predicts = true,
};
#endif

#endif
