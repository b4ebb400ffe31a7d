/* SPDX-License-Identifier: MIT */
/*
 * One step of each method for scenes. The steps of RK4, RKN8 and SRKN6 are in runge_kutta.h.
 *
 * The formulas are in the files in methods/. Here a(x, v) is the acceleration of a particle by its links, gravity, drag
 * and the callback. The stable steps are in method_limits.c.
 */
#include "exponential_kick.h"
#include "runge_kutta.h"

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

/* v1 = v + h a(x, v1), with implicit drag and explicit damping of links;  x1 = x + h v1 */
static scene_outcome scene_symplectic_euler(scene_step *s)
{
    find_start_force(s);
    scene_motion m = s->whole;
    m.contacts = with_contacts(s, IMPLICIT_KICK_DRIFT_CONTACTS);
    return (scene_outcome){.finite = move(s, s->kernels->common->implicit_kick_drift, &m)};
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

SPRING_TABLE step_function *const spring_scene_steppers[SPRING_METHOD_COUNT] = {
    [SPRING_EULER] = scene_euler,       [SPRING_SYMPLECTIC_EULER] = scene_symplectic_euler,
    [SPRING_LEAPFROG] = scene_leapfrog, [SPRING_RK4] = scene_rk4,
    [SPRING_RKN8] = scene_rkn8,         [SPRING_SRKN6] = scene_srkn6,
};
