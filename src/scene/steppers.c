/* SPDX-License-Identifier: MIT */
/*
 * One step of each method for scenes, and its stable step.
 *
 * The formulas are in the files in methods/. Here a(x, v) is the acceleration of a particle by its links, gravity, drag
 * and the callback. The stable steps follow from bounds on the sums over the links of a particle (stable_step.c).
 */
#include "chebyshev.h"
#include "../methods/rkn8_tableau.h"
#include "../methods/srkn6_coefficients.h"
#include "../spring/propagator.h"
#include "../spring/roots.h"

/* x1 = x + h v;  v1 = v + h a(x, v) */
static scene_outcome scene_euler(scene_step *s)
{
    find_start_force(s, v_at(s, s->from));
    const scene_motion m = whole_step(s);
    return (scene_outcome){.finite = move(s, s->kernels->stage, &m)};
}

static double scene_euler_limit(const scene_bounds *b)
{
    return b->stiffness_sum > 0 ? fmin(b->drag / b->stiffness_sum, 2 / b->damping) : 2 / b->damping;
}

/* v1 = v + h a(x, v1), with implicit drag and explicit damping of links;  x1 = x + h v1 */
static scene_outcome scene_symplectic_euler(scene_step *s)
{
    find_start_force(s, v_at(s, s->from));
    const scene_motion m = whole_step(s);
    return (scene_outcome){.finite = move(s, s->kernels->implicit_kick_drift, &m)};
}

/* Explicit link damping lowers the limit, and implicit drag raises it. A motion with stiffness k, link damping c and
   drag d, all divided by the mass, is stable for h^2 k + 2 h c < 4 + 2 h d. */
static double scene_symplectic_euler_limit(const scene_bounds *b)
{
    const double excess = b->link_damping - b->least_drag;
    const double root = spring_hypot(fabs(excess), 2 * spring_sqrt(b->stiffness));
    if (excess > 0 || root == 0 || root == INFINITY) /* infinite: no stable step is known */
        return 4 / (excess + root);
    return (root - excess) / b->stiffness;
}

/* Removes the velocity components into touched colliders again, since link damping changes velocities. */
static bool stop_at_contacts(scene_step *s, const scene_motion *last_kick)
{
    scene_motion m = *last_kick;
    m.kick = 0;
    return s->contacts.count == 0 || move(s, s->kernels->implicit_kick, &m);
}

/* Leapfrog without link damping for half a step, link damping for the whole step, and leapfrog for the other half. Each
   half is kick, drift, evaluate, implicit kick. As in scene_leapfrog(), the forces of a callback that uses velocities
   are not kept, and are evaluated at predicted velocities. */
static scene_outcome scene_leapfrog_with_heavy_damping(scene_step *s)
{
    const bool keeps = !scene_callback_uses_velocity(s->scene);
    find_start_force(s, v_at(s, s->from));
    scene_motion kick_drift = whole_step(s), last_kick = whole_step(s);
    kick_drift.kick = last_kick.kick = s->h / 4;
    kick_drift.drift = s->h / 2;
    kick_drift.ends_step = keeps && !s->first;
    kick_drift.predicted = keeps ? NULL : predicted_velocities(s);
    last_kick.v0 = kick_drift.v;
    last_kick.force = force_at(s, s->to);
    last_kick.max_speed = SCALAR_MAX; /* not yet the end of the step */
    const scalar *const v = keeps ? kick_drift.v : kick_drift.predicted;
    particle_kernel *const implicit_kick = s->kernels->implicit_kick;
    place_colliders(s, 0, 0.5);
    if (!move_evaluate_move(s, s->kernels->kick_drift, &kick_drift, v, 0.5, implicit_kick, &last_kick) ||
        !damp_links(s, kick_drift.x, kick_drift.v) || !stop_at_contacts(s, &last_kick))
        return (scene_outcome){.finite = false};
    place_colliders(s, 0.5, 1);
    if (!keeps)
        evaluate(s, kick_drift.x, kick_drift.v, 0.5);
    kick_drift.x0 = kick_drift.x;
    kick_drift.v0 = kick_drift.v;
    kick_drift.force = last_kick.force;
    kick_drift.ends_step = false;
    last_kick.max_speed = s->scene->max_speed;
    return (scene_outcome){
        .finite = move_evaluate_move(s, s->kernels->kick_drift, &kick_drift, v, 1,
                                     keeps && !s->last ? NULL : implicit_kick, &last_kick),
        .known = keeps ? ELASTIC_FORCE : NO_FORCE,
    };
}

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
        return scene_leapfrog_with_heavy_damping(s);
    const bool keeps = !scene_callback_uses_velocity(s->scene), predicts = scene_forces_use_velocity(s->scene);
    find_start_force(s, v_at(s, s->from));
    scene_motion kick_drift = whole_step(s), last_kick = whole_step(s);
    kick_drift.kick = last_kick.kick = s->h / 2;
    kick_drift.ends_step = keeps && !s->first;
    kick_drift.predicted = predicts ? predicted_velocities(s) : NULL;
    last_kick.v0 = kick_drift.v;
    last_kick.force = force_at(s, s->to);
    particle_kernel *const implicit_kick = keeps && !s->last ? NULL : s->kernels->implicit_kick;
    const scalar *const v = predicts ? kick_drift.predicted : kick_drift.v;
    return (scene_outcome){
        .finite = move_evaluate_move(s, s->kernels->kick_drift, &kick_drift, v, 1, implicit_kick, &last_kick),
        .known = !keeps     ? NO_FORCE
                 : predicts ? PREDICTED_FORCE
                            : FORCE,
    };
}

static double scene_leapfrog_limit(const scene_bounds *b)
{
    return 2 / spring_sqrt(b->stiffness);
}

/* With explicit damping c of links: h^2 k/4 + h c < 1. */
static double scene_leapfrog_explicit_limit(const scene_bounds *b)
{
    return 2 / (b->damping + spring_hypot(b->damping, spring_sqrt(b->stiffness)));
}

/* y1 = y + h/6 (k1 + 2 k2 + 2 k3 + k4) */
static scene_outcome scene_rk4(scene_step *s)
{
    static const double fraction[] = {0.5, 0.5, 1}; /* of the step, at the next stage */
    find_start_force(s, v_at(s, s->from));
    scene_motion end = whole_step(s), stage = whole_step(s);
    stage.x = stage_storage(s, 0);
    stage.v = stage_storage(s, 1);
    stage.sum_x = end.sum_x = stage_storage(s, 2);
    stage.sum_v = end.sum_v = stage_storage(s, 3);
    stage.weight = 2;
    for (int k = 0; k < 3; k++) {
        stage.kick = stage.drift = (scalar)fraction[k] * s->h;
        if (!move(s, k == 0 ? s->kernels->first_stage : s->kernels->next_stage, &stage))
            return (scene_outcome){.finite = false};
        evaluate(s, stage.x, stage.v, fraction[k]);
        stage.stage_v = end.stage_v = stage.v;
        stage.force = end.force = force_at(s, s->to);
    }
    end.kick = end.drift = s->h / 6;
    end.weight = 1;
    return (scene_outcome){.finite = move(s, s->kernels->last_stage, &end)};
}

static double scene_rk4_limit(const scene_bounds *b)
{
    const double limit = 2.61; /* for |h z| below it RK4 is stable in the whole left half plane */
    return limit / fmax(spring_sqrt(b->stiffness), b->damping);
}

_Static_assert((int)rkn8_stages == (int)nystrom_stages, "the kernels compute the stages of RKN8");

/* Indices of the factors that RKN8 stores for each mass, with drag: growth e^(g c h/2) and decay e^(-g c h/2) for each
   c of the stages after the first, and loss e^(-g h/2) - 1. */
enum { RKN8_GROWTH, RKN8_DECAY = rkn8_stages, RKN8_LOSS = 2 * rkn8_stages, RKN8_FACTORS };

static void compute_rkn8_factors(const scene_step *s)
{
    const scene_particles *p = &s->particles;
    const size_t count = p->mass_stride != 0 ? p->count : padding;
    for (size_t i = 0; i < count; i++) {
        const bool same = i > 0 && p->inverse_mass[i] == p->inverse_mass[i - 1];
        const double z = (double)(p->drag * p->inverse_mass[i]) * (double)s->h / 2;
        for (unsigned k = 0; k < rkn8_stages; k++) {
            scalar *growth = mass_factor(s, RKN8_GROWTH + k), *decay = mass_factor(s, RKN8_DECAY + k);
            growth[i] = same ? growth[i - 1] : (scalar)(1 + spring_expm1(rkn8_c[k] * z));
            decay[i] = same ? decay[i - 1] : (scalar)(1 + spring_expm1(-rkn8_c[k] * z));
        }
        scalar *loss = mass_factor(s, RKN8_LOSS);
        loss[i] = same ? loss[i - 1] : (scalar)spring_expm1(-z);
    }
}

/* The first of the nine stages uses the forces at the end of the previous step. */
static scene_outcome scene_rkn8(scene_step *s)
{
    const bool dragged = s->particles.drag != 0;
    if (s->first && dragged)
        compute_rkn8_factors(s);
    find_start_force(s, v_at(s, s->from));
    scene_motion end = whole_step(s), stage = whole_step(s);
    scene_nystrom n = {.square = s->h * s->h,
                       .accel = stage_storage(s, 0),
                       .accel_stride = s->scene->layout.quantity,
                       .stage_x = stage_storage(s, rkn8_stages)};
    end.nystrom = stage.nystrom = &n;
    stage.x = stage_storage(s, rkn8_stages);
    for (unsigned k = 0; k < rkn8_stages; k++) {
        n.number = k + 1;
        stage.drift = (scalar)rkn8_c[k] * s->h;
        n.weight_x = rkn8_a[k];
        n.decay = dragged ? mass_factor(s, RKN8_DECAY + k) : NULL;
        if (!move_and_evaluate(s, s->kernels->nystrom_stage, &stage, stage.v0, rkn8_c[k]))
            return (scene_outcome){.finite = false};
        stage.force = end.force = force_at(s, s->to);
        n.growth = dragged ? mass_factor(s, RKN8_GROWTH + k) : NULL;
    }
    n.weight_x = rkn8_b;
    n.weight_v = rkn8_b_v;
    n.loss = dragged ? mass_factor(s, RKN8_LOSS) : NULL;
    return (scene_outcome){.finite = move_and_evaluate(s, s->kernels->nystrom_end, &end, end.v, 1), .known = FORCE};
}

/* A growth far beyond e^20 would overflow in float, and leave no significant digit of a stage. */
static double scene_rkn8_limit(const scene_bounds *b)
{
    return fmin(3.14 / spring_sqrt(b->stiffness), 40 / b->damping);
}

/* Indices of the factors that SRKN6 stores for each mass, with drag, for each of its different drifts; see
   scene_motion. */
enum { SRKN6_SPAN, SRKN6_LOSS = srkn6_different, SRKN6_FACTORS = 2 * srkn6_different };

static void compute_srkn6_factors(const scene_step *s)
{
    const scene_particles *p = &s->particles;
    const size_t count = p->mass_stride != 0 ? p->count : padding;
    for (size_t i = 0; i < count; i++) {
        const bool as_before = i > 0 && p->inverse_mass[i] == p->inverse_mass[i - 1];
        const double drag = (double)(p->drag * p->inverse_mass[i]);
        for (unsigned k = 0; k < srkn6_different; k++) {
            scalar *span = mass_factor(s, SRKN6_SPAN + k), *loss = mass_factor(s, SRKN6_LOSS + k);
            const double drift = srkn6_a[k] * (double)s->h, z = drag * drift;
            const double change = as_before ? 0 : spring_expm1(-z);
            span[i] = as_before ? span[i - 1] : (scalar)(z != 0 ? drift * (-change / z) : drift);
            loss[i] = as_before ? loss[i - 1] : (scalar)change;
        }
    }
}

/* Alternating kicks and drifts. The last kick of a step and the first kick of the next are one fused pass over the
   particles, with the results of two passes. Drag acts in drifts alone. */
static scene_outcome scene_srkn6(scene_step *s)
{
    const bool dragged = (scalar)s->scene->drag != 0;
    if (s->first && dragged)
        compute_srkn6_factors(s);
    find_start_force(s, v_at(s, s->from));
    s->particles.drag = 0;
    particle_kernel *const kick_drift = dragged ? s->kernels->kick_damped_drift : s->kernels->kick_drift;
    scene_motion m = whole_step(s), last_kick = whole_step(s);
    last_kick.v0 = last_kick.v;
    last_kick.force = force_at(s, s->to);
    last_kick.kick = (scalar)srkn6_b[0] * s->h;
    for (int i = 0; i < srkn6_stages; i++) {
        const unsigned k = (unsigned)srkn6_index(i, srkn6_stages);
        m.kick = (scalar)srkn6_b[srkn6_index(i, srkn6_stages + 1)] * s->h;
        m.drift = (scalar)srkn6_a[k] * s->h;
        m.ends_step = i == 0 && !s->first;
        m.span = dragged ? mass_factor(s, SRKN6_SPAN + k) : NULL;
        m.loss = dragged ? mass_factor(s, SRKN6_LOSS + k) : NULL;
        particle_kernel *const then = s->last && i + 1 == srkn6_stages ? s->kernels->implicit_kick : NULL;
        if (!move_evaluate_move(s, kick_drift, &m, m.v, srkn6_c[i], then, &last_kick))
            return (scene_outcome){.finite = false};
        m.x0 = m.x;
        m.v0 = m.v;
        m.force = last_kick.force;
    }
    return (scene_outcome){.finite = true, .known = FORCE};
}

/* With heavy drag, the growth in backward drifts would exceed the decay in the others; see srkn6.h. */
static double scene_srkn6_limit(const scene_bounds *b)
{
    return fmin(9.07 / spring_sqrt(b->stiffness), 20 / b->damping);
}

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
