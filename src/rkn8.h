/* SPDX-License-Identifier: MIT */
/*
 * The Runge-Kutta-Nystrom method 8(6)9 of Dormand, El-Mikkawy and Prince, for scenes whose forces depend on positions,
 * and on velocities by drag alone.
 *
 * Method    X_i = x + c_i h v + h^2 sum a_ij A_j,   A_i = a(t + c_i h, X_i)
 *           x1 = x + h v + h^2 sum b_j A_j,   v1 = v + h sum b'_j A_j
 *           The ninth stage is the first of the next step: eight forces a step.
 * Drag      of g = drag/mass goes, exactly, into y = e^(g t/2) (x - x0), t from the start of the step, with
 *           y'' = e^(g t/2) a + (g/2)^2 y. With growth E_i = e^(g c_i h/2) and d_i = X_i - x0:
 *               A_i = E_i (a(X_i) + (g/2)^2 d_i),   d_i = (c_i h v + h^2 sum a_ij A_j)/E_i,
 *           and the velocity is v1 = e^(-g h/2) (y' - g/2 y), written as v plus what it changes by.
 * Order     8. Undamped phase error after time T: 2.2e-8 omega^9 h^8 T; a share of 3.8e-8 z^10 of the energy is lost a
 *           step, z = h omega.
 * Limit     z = 3.1402 without drag, larger with it. (There a gap begins that ends at 3.1417; the next is from 3.29 on.)
 *           From g h = 1400 on, in float 176, E is infinite.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step (tests/test_rkn8.c)
 * Source    Dormand, El-Mikkawy, Prince, High-order embedded Runge-Kutta-Nystrom formulae, IMA J. Numer. Anal. 7
 *           (1987)
 */
#ifndef SPRINGSTEP_RKN8_H
#define SPRINGSTEP_RKN8_H

#include "method.h"

#if defined(SPRING_SHAPE_ONE)
static const one_method rkn8_one = {
    .info = {.name = "rkn8", .order = 8, .forces_per_step = 8, .scenes = true, .label = "RKN8", .positions_only = true},
    .digest = UINT64_C(0x74494ed0e40a48e5),
};

#elif defined(SPRING_SHAPE_BATCH)
#define rkn8_batch NULL

#elif defined(SPRING_SHAPE_SCENE)
#include "propagator.h"

enum { rkn8_stages = nystrom_stages };

/* Of the second to the eighth stage. */
static const double rkn8_c[rkn8_stages] = {1. / 20, 1. / 10, 3. / 10, 1. / 2, 7. / 10, 9. / 10, 1};
#define QUOTIENT(p, q) ((scalar)((double)(p) / (q)))
/* clang-format off */
static const scalar rkn8_a[rkn8_stages][rkn8_stages] = {
    {QUOTIENT(1, 800)},
    {QUOTIENT(1, 600), QUOTIENT(1, 300)},
    {QUOTIENT(9, 200), QUOTIENT(-9, 100), QUOTIENT(9, 100)},
    {QUOTIENT(-66701, 197352), QUOTIENT(28325, 32892), QUOTIENT(-2665, 5482), QUOTIENT(2170, 24669)},
    {QUOTIENT(227015747, 304251000), QUOTIENT(-54897451, 30425100), QUOTIENT(12942349, 10141700), QUOTIENT(-9499, 304251),
     QUOTIENT(539, 9250)},
    {QUOTIENT(-1131891597, 901789000), QUOTIENT(41964921, 12882700), QUOTIENT(-6663147, 3220675), QUOTIENT(270954, 644135),
     QUOTIENT(-108, 5875), QUOTIENT(114, 1645)},
    {QUOTIENT(13836959, 3667458), QUOTIENT(-17731450, 1833729), QUOTIENT(1063919505, 156478208), QUOTIENT(-33213845, 39119552),
     QUOTIENT(13335, 28544), QUOTIENT(-705, 14272), QUOTIENT(1645, 57088)},
};
static const scalar rkn8_b[rkn8_stages + 1] = {
    QUOTIENT(223, 7938), 0, QUOTIENT(1175, 8064), QUOTIENT(925, 6048), QUOTIENT(41, 448), QUOTIENT(925, 14112), QUOTIENT(1175, 72576)};
static const scalar rkn8_b_v[rkn8_stages + 1] = {
    QUOTIENT(223, 7938), 0, QUOTIENT(5875, 36288), QUOTIENT(4625, 21168), QUOTIENT(41, 224), QUOTIENT(4625, 21168), QUOTIENT(5875, 36288),
    QUOTIENT(223, 7938)};
/* clang-format on */

/* What is stored of each particle where there is drag: E and 1/E of these stages, and e^(-g h/2) - 1. */
enum { rkn8_decay = rkn8_stages, rkn8_loss = 2 * rkn8_stages, rkn8_factors };

static void rkn8_find_factors(const scene_step *s)
{
    const scene_particles *p = &s->particles;
    const size_t count = p->mass_step != 0 ? p->count : padding;
    for (size_t i = 0; i < count; i++) {
        const bool same = i > 0 && p->inverse_mass[i] == p->inverse_mass[i - 1];
        const double z = (double)(p->drag * p->inverse_mass[i]) * (double)s->h / 2;
        for (unsigned k = 0; k < rkn8_stages; k++) {
            scalar *growth = scene_factor(s, k), *decay = scene_factor(s, rkn8_decay + k);
            growth[i] = same ? growth[i - 1] : (scalar)(1 + spring_expm1(rkn8_c[k] * z));
            decay[i] = same ? decay[i - 1] : (scalar)(1 + spring_expm1(-rkn8_c[k] * z));
        }
        scalar *loss = scene_factor(s, rkn8_loss);
        loss[i] = same ? loss[i - 1] : (scalar)spring_expm1(-z);
    }
}

static scene_outcome rkn8_scene_step(const scene_step *s)
{
    if (s->first && s->particles.drag != 0)
        rkn8_find_factors(s);
    scene_motion end = scene_motion_of(s), stage = scene_motion_of(s);
    scene_nystrom of = {.square = s->h * s->h,
                        .slopes = scene_stage(s, 0),
                        .slope_step = s->scene->plan.stage_step,
                        .stage_x = scene_stage(s, rkn8_stages)};
    end.nystrom = stage.nystrom = &of;
    stage.x = scene_stage(s, rkn8_stages);
    for (unsigned k = 0; k < rkn8_stages; k++) {
        stage.drift = (scalar)rkn8_c[k] * s->h;
        of.weight_x = rkn8_a[k];
        of.decay = scene_factor(s, rkn8_decay + k);
        if (!scene_sweep(s, &stage, s->kernels->nystrom_stage[k], stage.v0, rkn8_c[k], NULL, NULL))
            return (scene_outcome){.finite = false};
        stage.force = end.force = scene_force_of(s->scene, s->to);
        of.growth = scene_factor(s, k);
    }
    of.weight_x = rkn8_b;
    of.weight_v = rkn8_b_v;
    of.loss = scene_factor(s, rkn8_loss);
    return (scene_outcome){.finite = scene_sweep(s, &end, s->kernels->nystrom_end, end.v, 1, NULL, NULL),
                           .known = FORCE};
}

/* Growth far beyond e^20 would be infinite in float, and leaves no digit of a stage. */
static double rkn8_scene_stable_step(const scene_bounds *b)
{
    return fmin(3.14 / spring_sqrt(b->stiffness), 40 / b->damping);
}

static const scene_method rkn8_scene = {
    .step = rkn8_scene_step,
    .stable_step = rkn8_scene_stable_step,
    .stages = rkn8_stages + 1,
    .factors = rkn8_factors,
};
#endif

#endif
