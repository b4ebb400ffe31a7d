/* SPDX-License-Identifier: MIT */
/*
 * The steps of RK4, RKN8 and SRKN6 with their kernels inlined, for scenes of few particles, in which calls and the
 * preparation of loops take longer than the arithmetic. The results are those of steppers.c.
 *
 * Scenes    on one axis, or small (with two or three axes as quads, which are treated as numbers on one axis); without
 *           bands, colliders and held forces
 */
#ifndef SPRINGSTEP_ONE_AXIS_H
#define SPRINGSTEP_ONE_AXIS_H

#include "../scene/runge_kutta.h"
#include "particles.h"
#include "unbanded.h"

SPRING_INLINE void one_axis_forces(const scene_links *s, const scalar *x, const scalar *v, scene_forces *out)
{
    for (size_t i = 0; i < s->particles; i += lanes) /* not memset(), since the call takes longer than the stores */
        vec_store(out->force + i, splat(0));
    if (s->terms == STIFFNESS_AND_DAMPING_TERM)
        all_unbanded(s, x, v, out, 1, true, false);
    else
        all_unbanded(s, x, v, out, 1, false, false);
}

/* Stores forces again, as vectors, after links or a callback have stored them one by one; see vec_load_lanes(). */
SPRING_INLINE void join_forces(scalar *force, size_t count)
{
    for (size_t i = 0; i < count; i += lanes)
        vec_store(force + i, vec_load_lanes(force + i));
}

SPRING_INLINE void one_axis_evaluate(scene_step *s, const scalar *x, const scalar *v, double fraction)
{
    spring_scene *const scene = s->scene;
    scalar *const force = s->forces.force;
    const size_t count = s->particles.count;
    if (!scene->layout.quads) {
        one_axis_forces(s->links, x, v, &s->forces);
        if (scene->force != NULL)
            call_back(scene, x, v, time_at(s, fraction), force, 1);
        if (scene->force != NULL || s->links->unbanded.count > 0)
            join_forces(force, count);
        return;
    }
    compute_quad_forces(s->links, x, v, &s->forces);
    if (scene->force != NULL) {
        call_back_small(scene, x, v, time_at(s, fraction), force);
        join_forces(force, count);
    }
}

SPRING_INLINE scene_particles one_axis_particles(const scene_step *s)
{
    scene_particles p = s->particles;
    p.axes = 1; /* known to the compiler */
    return p;
}

/* Advances all particles. update and variant should be constants. */
SPRING_INLINE bool update_all(const scene_step *s, const scene_motion *m, particle_update *update, unsigned variant)
{
    const scene_particles p = one_axis_particles(s);
    return for_each_vector(&p, m, 0, p.count, update, variant, false);
}

SPRING_INLINE bool update_and_evaluate(scene_step *s, const scene_motion *m, const scalar *v, double fraction,
                                       particle_update *update, unsigned variant)
{
    if (!update_all(s, m, update, variant))
        return false;
    one_axis_evaluate(s, m->x, v, fraction);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- RK4 */

SPRING_INLINE bool one_axis_rk4_first_stage(scene_step *s, const scene_motion *m, const scalar *v, double fraction)
{
    return update_and_evaluate(s, m, v, fraction, update_stage, FIRST_SUM);
}

SPRING_INLINE bool one_axis_rk4_next_stage(scene_step *s, const scene_motion *m, const scalar *v, double fraction)
{
    return update_and_evaluate(s, m, v, fraction, update_stage, NEXT_SUM);
}

SPRING_INLINE bool one_axis_rk4_last_stage(const scene_step *s, const scene_motion *m)
{
    return update_all(s, m, update_last_stage, 0);
}

static scene_outcome one_axis_rk4(scene_step *s)
{
    return take_rk4_step(s, one_axis_evaluate, one_axis_rk4_first_stage, one_axis_rk4_next_stage,
                         one_axis_rk4_last_stage);
}

/* ------------------------------------------------------------------------------------------------------------ RKN8 */

SPRING_INLINE bool one_axis_rkn8_stage(scene_step *s, const scene_motion *m, const scalar *v, double fraction)
{
    const scene_particles p = one_axis_particles(s);
    if (!update_each_nystrom_stage(&p, m, 0, p.count, false))
        return false;
    one_axis_evaluate(s, m->x, v, fraction);
    return true;
}

SPRING_INLINE bool one_axis_rkn8_end(scene_step *s, const scene_motion *m, const scalar *v, double fraction)
{
    return update_and_evaluate(s, m, v, fraction, update_nystrom_end, 0);
}

static scene_outcome one_axis_rkn8(scene_step *s)
{
    return take_rkn8_step(s, one_axis_rkn8_stage, one_axis_rkn8_end);
}

/* ----------------------------------------------------------------------------------------------------------- SRKN6 */

SPRING_INLINE bool one_axis_srkn6_stage(scene_step *s, const scene_motion *m, const scalar *v, double fraction)
{
    const unsigned ends = m->ends_step ? ENDS_STEP : 0;
    if (!(m->span != NULL ? update_all(s, m, update_kick_damped_drift, ends)
          : ends != 0     ? update_all(s, m, update_kick_drift, ENDS_STEP)
                          : update_all(s, m, update_kick_drift, 0)))
        return false;
    one_axis_evaluate(s, m->x, v, fraction);
    return true;
}

static scene_outcome one_axis_srkn6(scene_step *s)
{
    return take_srkn6_step(s, one_axis_srkn6_stage);
}

#endif
