/* SPDX-License-Identifier: MIT */
/*
 * One step of each method for scenes, and its stable step. The steps of RK4, RKN8 and SRKN6 are in runge_kutta.h.
 *
 * The formulas are in the files in methods/. Here a(x, v) is the acceleration of a particle by its links, gravity, drag
 * and the callback. The stable steps follow from bounds on the sums over the links of a particle (stable_step.c).
 */
#include "exponential_kick.h"
#include "runge_kutta.h"
#include "../spring/roots.h"

#include "../simd/size_begin.h"

/* x1 = x + h v;  v1 = v + h a(x, v) */
static scene_outcome scene_euler(scene_step *s)
{
    find_start_force(s);
    const scene_stage start = {.v = s->whole.v0};
    scene_motion m = s->whole;
    m.stage = &start;
    return (scene_outcome){.finite = move(s, s->kernels->common->stage, &m)};
}

static double scene_euler_limit(const scene_bounds *b)
{
    return b->stiffness_sum > 0 ? fmin(b->drag / b->stiffness_sum, 2 / b->damping) : 2 / b->damping;
}

/* v1 = v + h a(x, v1), with implicit drag and explicit damping of links;  x1 = x + h v1 */
static scene_outcome scene_symplectic_euler(scene_step *s)
{
    find_start_force(s);
    scene_motion m = s->whole;
    m.contacts = with_contacts(s, IMPLICIT_KICK_DRIFT_CONTACTS);
    return (scene_outcome){.finite = move(s, s->kernels->common->implicit_kick_drift, &m)};
}

/* Explicit link damping lowers the limit, and implicit drag raises it. A motion with stiffness k, link damping c and
   drag d, all divided by the mass, is stable for h^2 k + 2 h c < 4 + 2 h d. */
static double scene_symplectic_euler_limit(const scene_bounds *b)
{
    const double excess = b->link_damping - b->least_drag;
    const double root = spring_hypot(fabs(excess), 2 * spring_sqrt(b->stiffness));
    if (excess > 0 || root == 0 || root == (double)INFINITY) /* infinite: no stable step is known */
        return 4 / (excess + root);
    return (root - excess) / b->stiffness;
}

#include "../simd/size_end.h"

/* Kick, drift, evaluate, implicit kick. The last kick of a step and the first kick of the next are one fused pass over
   the particles, with the results of two passes.
   If forces other than drag depend on velocities, they are evaluated at predicted velocities v*. Let v' be the velocity
   after the first half kick, by the force F0, and a(F, v) the acceleration by a force, gravity and the drag at v. The
   prediction is v* = v' + h/2 a(F0, v*). The force F1 at x1 and v* gives v1 = v' + h/2 a(F1, v1). The next step starts
   with F1, so F1 is part of the state. The forces of a callback that uses velocities are not kept, since its data may
   change between calls. Then forces are evaluated twice a step, and each kick is a separate pass. */
static scene_outcome scene_leapfrog(scene_step *s)
{
    if (s->damping.terms > 0)
        return scene_exponential_leapfrog(s);
    const bool keeps = !scene_callback_uses_velocity(s->scene), uses_velocity = scene_forces_use_velocity(s->scene);
    const bool previous_kick_is_pending = keeps && !s->first, defers_last_kick = keeps && !s->last;
    find_start_force(s);
    scene_motion kick_drift = s->whole, last_kick = s->whole;
    kick_drift.kick = last_kick.kick = s->h / 2;
    kick_drift.ends_previous = previous_kick_is_pending;
    kick_drift.contacts = with_contacts(s, KICK_DRIFT_CONTACTS);
    last_kick.contacts = with_contacts(s, IMPLICIT_KICK_CONTACTS);
    kick_drift.predicted = uses_velocity ? predicted_velocities(s) : NULL;
    last_kick.v0 = kick_drift.v;
    last_kick.force = s->forces.force;
    particle_kernel *const implicit_kick = defers_last_kick ? NULL : s->kernels->implicit_kick;
    const scalar *const v = uses_velocity ? kick_drift.predicted : kick_drift.v;
    return (scene_outcome){
        .finite = move_evaluate_move(s, s->kernels->kick_drift, &kick_drift, v, 1, implicit_kick, &last_kick),
        .cached = !keeps          ? NO_FORCE
                  : uses_velocity ? PREDICTED_FORCE
                                  : FORCE,
    };
}

#include "../simd/size_begin.h"

static double scene_leapfrog_limit(const scene_bounds *b)
{
    return 2 / spring_sqrt(b->stiffness);
}

/* Explicit damping c of links is stable for h^2 k/4 + h c < 1. Beyond 0.9 of it, or for h c > 0.4, the exponential kick
   is more accurate at a similar cost. */
static double scene_leapfrog_explicit_limit(const scene_bounds *b)
{
    const double least = 0.9, most = 0.4, damping = b->damping / least;
    return fmin(most / b->link_damping, 2 / (damping + spring_hypot(damping, spring_sqrt(b->stiffness))));
}

static double scene_rk4_limit(const scene_bounds *b)
{
    const double limit = 2.61; /* for |h z| below it RK4 is stable in the whole left half plane */
    return limit / fmax(spring_sqrt(b->stiffness), b->damping);
}

/* A growth far beyond e^20 would overflow in float, and leave no significant digit of a stage. */
static double scene_rkn8_limit(const scene_bounds *b)
{
    return fmin(3.14 / spring_sqrt(b->stiffness), 40 / b->damping);
}

/* With heavy drag, the growth in backward drifts would exceed the decay in the others; see srkn6.h. */
static double scene_srkn6_limit(const scene_bounds *b)
{
    return fmin(9.07 / spring_sqrt(b->stiffness), 20 / b->damping);
}

#include "../simd/size_end.h"

SPRING_TABLE const scene_stepper spring_scene_steppers[SPRING_METHOD_COUNT] = {
    [SPRING_EULER] = {.step = scene_euler, .stable_step = scene_euler_limit},
    [SPRING_SYMPLECTIC_EULER] = {.step = scene_symplectic_euler, .stable_step = scene_symplectic_euler_limit},
    [SPRING_LEAPFROG] = {.step = scene_leapfrog,
                         .stable_step = scene_leapfrog_limit,
                         .predicts = true,
                         .explicit_limit = scene_leapfrog_explicit_limit},
    [SPRING_RK4] = {.step = scene_rk4, .stable_step = scene_rk4_limit, .stages = 4},
    [SPRING_RKN8] = {.step = scene_rkn8,
                     .stable_step = scene_rkn8_limit,
                     .stages = rkn8_stages + 1,
                     .mass_factors = RKN8_FACTORS},
    [SPRING_SRKN6] = {.step = scene_srkn6, .stable_step = scene_srkn6_limit, .mass_factors = SRKN6_FACTORS},
};
