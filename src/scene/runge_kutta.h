/* SPDX-License-Identifier: MIT */
/* The steps of RK4, RKN8 and SRKN6 for scenes. */
#ifndef SPRINGSTEP_RUNGE_KUTTA_H
#define SPRINGSTEP_RUNGE_KUTTA_H

#include "pass.h"
#include "../methods/rkn8_tableau.h"
#include "../methods/srkn6_coefficients.h"
#include "../spring/propagator.h"

/* Advances all particles, then evaluates the forces. Two passes: for a sheet that exceeds the cache, a fused pass is 4
   % slower. */
static bool rk4_stage(scene_step *s, particle_kernel *kernel, const scene_motion *m, double fraction)
{
    if (!move(s, kernel, m))
        return false;
    evaluate(s, m->x, m->v, fraction);
    return true;
}

/* y1 = y + h/6 (k1 + 2 k2 + 2 k3 + k4) */
static scene_outcome scene_rk4(scene_step *s)
{
    find_start_force(s);
    scene_motion end = s->whole, stage = s->whole;
    scene_stage sums = {.v = end.v0, .sum_x = stage_storage(s, 2), .sum_v = stage_storage(s, 3), .weight = 2};
    end.stage = stage.stage = &sums;
    stage.x = stage_storage(s, 0);
    stage.v = stage_storage(s, 1);
    stage.kick = stage.drift = s->h / 2;
    if (!rk4_stage(s, s->kernels->common->first_stage, &stage, 0.5))
        return (scene_outcome){.finite = false};
    sums.v = stage.v;
    stage.force = end.force = s->forces.force;
    for (int i = 1; i < 3; i++) {
        const double fraction = i == 1 ? 0.5 : 1;
        stage.kick = stage.drift = (scalar)fraction * s->h;
        if (!rk4_stage(s, s->kernels->common->next_stage, &stage, fraction))
            return (scene_outcome){.finite = false};
    }
    end.kick = end.drift = s->h / 6;
    sums.weight = 1;
    end.contacts = with_contacts(s, WHOLE_STEP_CONTACTS);
    return (scene_outcome){.finite = move(s, s->kernels->common->last_stage, &end)};
}

/* The time of the following steps is that of their many kernels. */
#include "../simd/size_begin.h"

_Static_assert((int)rkn8_stages == (int)nystrom_stages, "the kernels compute the stages of RKN8");
_Static_assert((int)rkn8_stage_arrays == (int)rkn8_stages + 1,
               "RKN8 stores accelerations and the positions of a stage");

/* Indices of the factors that RKN8 stores for each mass, with drag: growth e^(g c h/2) and decay e^(-g c h/2) for each
   c of the stages after the first, and loss e^(-g h/2) - 1. */
enum { RKN8_GROWTH, RKN8_DECAY = rkn8_stages, RKN8_LOSS = 2 * rkn8_stages };
_Static_assert((int)rkn8_mass_factors == (int)RKN8_LOSS + 1, "storage of all factors");

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
    find_start_force(s);
    scene_motion end = s->whole, stage = s->whole;
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
        if (!move_and_evaluate(s, s->kernels->common->nystrom_stage, &stage, stage.v0, rkn8_c[k]))
            return (scene_outcome){.finite = false};
        stage.force = end.force = s->forces.force;
        n.growth = dragged ? mass_factor(s, RKN8_GROWTH + k) : NULL;
    }
    n.weight_x = rkn8_b;
    n.weight_v = rkn8_b_v;
    n.loss = dragged ? mass_factor(s, RKN8_LOSS) : NULL;
    return (scene_outcome){.finite = move_and_evaluate(s, s->kernels->common->nystrom_end, &end, end.v, 1),
                           .cached = FORCE};
}

/* Indices of the factors that SRKN6 stores for each mass, with drag, for each of its different drifts; see
   scene_damped_drift. */
enum { SRKN6_SPAN, SRKN6_LOSS = srkn6_different };
_Static_assert((int)srkn6_mass_factors == 2 * (int)srkn6_different, "storage of all factors");

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
    find_start_force(s);
    s->particles.drag = 0;
    particle_kernel *const kick_drift = dragged ? s->kernels->common->kick_damped_drift : s->kernels->kick_drift;
    scene_motion m = s->whole, last_kick = s->whole;
    scene_damped_drift drift;
    m.damped_drift = &drift;
    last_kick.v0 = last_kick.v;
    last_kick.force = s->forces.force;
    last_kick.kick = (scalar)srkn6_b[0] * s->h;
    for (int i = 0; i < srkn6_stages; i++) {
        const unsigned k = (unsigned)srkn6_index(i, srkn6_stages);
        m.kick = (scalar)srkn6_b[srkn6_index(i, srkn6_stages + 1)] * s->h;
        m.drift = (scalar)srkn6_a[k] * s->h;
        m.ends_previous = i == 0 && !s->first;
        if (dragged)
            drift = (scene_damped_drift){mass_factor(s, SRKN6_SPAN + k), mass_factor(s, SRKN6_LOSS + k)};
        if (!move_and_evaluate(s, kick_drift, &m, m.v, srkn6_c[i]))
            return (scene_outcome){.finite = false};
        m.x0 = m.x;
        m.v0 = m.v;
        m.force = last_kick.force;
    }
    return (scene_outcome){.finite = !s->last || move(s, s->kernels->implicit_kick, &last_kick), .cached = FORCE};
}

#include "../simd/size_end.h"

#endif
