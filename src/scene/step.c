/* SPDX-License-Identifier: MIT */
/*
 * Advancing a scene: the loop over the steps of a call.
 *
 * Rollback  The state is in one of two buffers. The first step of a call reads this buffer and writes to the other
 *           buffer. Further steps read and write the other buffer, which becomes the state when the call succeeds. So a
 *           rollback copies nothing. Without rollback there is one buffer.
 */
#include "exponential_kick.h"
#include "../spring/roots.h"

static const scene_kernels *best_scene_kernels(void)
{
    return SPRING_BEST_KERNELS(&spring_scene_v128, &spring_scene_v256, &spring_scene_v512);
}

static double time_of(const spring_scene *s)
{
    return s->t0 + (double)s->steps * s->dt;
}

double spring_scene_time(const spring_scene *s)
{
    return s != NULL ? time_of(s) : (double)NAN;
}

#include "../simd/size_begin.h"

/* Sets padding lanes to 0 after a failure: a NaN there would make later steps with longer vectors fail, and no caller can
   overwrite it. */
static void clear_padding(spring_scene *s, uint32_t buffer)
{
    const size_t first = s->layout.particles, count = s->layout.stride - first;
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        memset(scene_axis(s, positions_in(buffer), a) + first, 0, count * sizeof(scalar));
        memset(scene_axis(s, velocities_in(buffer), a) + first, 0, count * sizeof(scalar));
    }
}

/* After a failure without rollback, the whole state becomes NaN, so that a caller cannot use numbers that are still
   finite. */
static void invalidate(spring_scene *s)
{
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        scalar *x = scene_set_state(s, SPRING_POSITION, a), *v = scene_set_state(s, SPRING_VELOCITY, a);
        for (size_t i = 0; i < s->layout.particles; i++)
            x[i] = v[i] = (scalar)NAN;
    }
    scene_clear_touched(s, 0, s->layout.particles);
    s->lost = true;
}

#include "../simd/size_end.h"

/* Returns why a call cannot advance the scene, or SPRING_OK. */
static spring_status check_advance(const spring_scene *s, spring_method m, double dt)
{
    if (s == NULL || spring_method_describe(m) == NULL || !scalar_finite((scalar)dt))
        return SPRING_EINVAL;
    if ((s->layout.methods & 1u << m) == 0)
        return spring_scene_steppers[m] == NULL ? SPRING_EUNSUPPORTED : SPRING_EDISABLED;
    if (spring_method_describe(m)->positions_only && scene_forces_use_velocity(s))
        return SPRING_EUNSUPPORTED;
    return s->colliders > 0 && m == SPRING_EULER ? SPRING_EUNSUPPORTED : SPRING_OK;
}

/* Takes n steps. A run is a sequence of calls with the same dt; `before` is the number of its steps before this call.
   Returns the forces that are cached at the end. *finite: whether the results of every step are finite. */
static cached_force take_scene_steps(scene_step *step, step_function *take, uint64_t before, uint64_t n, bool *finite)
{
    step->cached = step->scene->force_cache;
    for (uint64_t i = 0; i < n; i++) {
        step->done = (double)(before + i);
        step->first = i == 0;
        step->last = i + 1 == n;
        if (i == 1)
            prepare_step(step, step->to, step->to);
        prepare_contacts(step);
        const scene_outcome outcome = take(step);
        *finite = outcome.finite;
        if (!outcome.finite)
            return NO_FORCE;
        step->cached = outcome.cached;
    }
    return step->cached;
}

/* Chooses an exponential kick if dt is beyond the limit of explicit damping. A negative dt is not. */
static void choose_damping(scene_step *step, scene_links *links, const method_limits *limits)
{
    spring_scene *const s = step->scene;
    if (s->damped_links == 0 || limits->explicit_limit == NULL)
        return;
    const scene_bounds *const bounds = spring_scene_find_bounds(s);
    if (step->dt <= limits->explicit_limit(bounds))
        return;
    const double reach = step->dt * bounds->link_damping;
    step->damping = spring_damping_series(fmin(reach, most_damping));
    links->terms = FREEZING_TERMS;
    if (s->roots_dt != step->dt)
        spring_scene_find_roots(s, step->dt, most_damping);
    s->roots_dt = step->dt;
    links->turning_time = step->h;
}

/* The contacts of a call. */
static void prepare_collisions(scene_step *step)
{
    spring_scene *const s = step->scene;
    scene_contacts *const c = &step->contacts;
    if (s->colliders == 0)
        return;
    c->setting = (contact_setting){
        .body = scene_read(s, ARRAY_PLACED),
        .count = s->colliders,
        .h = (double)step->h,
        .epsilon = (double)SCALAR_EPSILON,
        .origin = scene_memory(s, ARRAY_ORIGINS),
        .impulse = (spring_impulse *)scene_memory(s, ARRAY_IMPULSES) + s->layout.colliders,
        .records = true,
    };
    c->bounds = scene_read(s, ARRAY_BOUNDS);
    c->clearance = scene_memory(s, ARRAY_CLEARANCE);
    for (size_t i = 0; i < padding; i++)
        c->equal_radius[i] = s->particle_radius;
    c->radius_stride = scene_has(s, ARRAY_RADIUS);
    c->radius = scene_has(s, ARRAY_RADIUS) ? scene_read(s, ARRAY_RADIUS) : c->equal_radius;
    spring_scene_begin_impulses(s, elapsed_at(step, 0));
}

spring_status spring_scene_advance_with(const scene_kernels *kernels, spring_scene *s, spring_method m, double dt,
                                        uint64_t n)
{
    const spring_status status = check_advance(s, m, dt);
    if (status == SPRING_OK && (n == 0 || (scalar)dt == 0))
        scene_clear_impulses(s);
    if (status != SPRING_OK || n == 0 || (scalar)dt == 0)
        return status;
    if (s->lost && !scene_finite(s)) /* the caller has not set it anew */
        return SPRING_ENONFINITE;
    s->lost = false;
    const bool rollback = (s->layout.flags & SPRING_SCENE_NO_UNDO) == 0;
    const bool same_run = s->dt == dt;
    const double t0 = same_run ? s->t0 : time_of(s);
    const uint64_t before = same_run ? s->steps : 0;
    const double colliders_base = same_run ? s->colliders_base : colliders_time(s);
    const uint64_t colliders_from = same_run ? s->colliders_from : 0;
    if (!spring_finite(t0 + (double)(before + n) * dt))
        return SPRING_ENONFINITE;
    scene_band band[most_bands];
    scene_links links = scene_prepare_links(s, band);
    scene_step step = {.kernels = kernels,
                       .scene = s,
                       .links = &links,
                       .forces = scene_prepare_forces(s, NULL),
                       .particles = scene_prepare_particles(s),
                       .h = (scalar)dt,
                       .t0 = t0,
                       .dt = dt,
                       .done = (double)before,
                       .colliders_base = colliders_base,
                       .colliders_from = (double)colliders_from,
                       .predicts = spring_method_limits[m].predicts};
    prepare_collisions(&step);
    choose_damping(&step, &links, &spring_method_limits[m]);
    prepare_step(&step, s->buffer, rollback ? 1 - s->buffer : s->buffer);
    bool finite = true;
    const cached_force cached = take_scene_steps(&step, spring_scene_steppers[m], before, n, &finite);
    if (!finite) {
        clear_padding(s, step.to);
        if (!rollback)
            invalidate(s);
        if (s->force_cache != PREDICTED_FORCE) /* the cached forces may be overwritten, or not finite themselves */
            scene_drop_forces(s);
        return s->max_speed < SCALAR_MAX ? SPRING_EUNSTABLE : SPRING_ENONFINITE;
    }
    if (s->colliders > 0)
        spring_scene_end_impulses(s, elapsed_at(&step, 1));
    s->force_cache = cached;
    s->buffer = step.to;
    s->t0 = t0;
    s->dt = dt;
    s->steps = before + n;
    s->colliders_base = colliders_base;
    s->colliders_from = colliders_from;
    return SPRING_OK;
}

spring_status spring_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n)
{
    return spring_scene_advance_with(best_scene_kernels(), s, m, dt, n);
}

/* ---------------------------------------------------------------------------------------------------------- at rest */

#include "../simd/size_begin.h"

/* The forces at the state. The cache stays as it is, so that a later step does not depend on this query. */
static const scalar *forces_of_state(spring_scene *s)
{
    if (s->force_cache == FORCE)
        return scene_axis(s, forces_in(s->buffer), 0);
    scalar *const force = scene_spare_forces(s);
    scene_band band[most_bands];
    const scene_links links = scene_prepare_links(s, band);
    scene_forces forces = scene_prepare_forces(s, force);
    scene_evaluate(best_scene_kernels(), s, &links, scene_state(s, SPRING_POSITION, 0),
                   scene_state(s, SPRING_VELOCITY, 0), time_of(s), &forces);
    return force;
}

bool spring_scene_at_rest(spring_scene *s, double v_tol, double a_tol)
{
    if (s == NULL || !(v_tol >= 0) || !(a_tol >= 0) || !scene_finite(s))
        return false;
    const scalar *all = forces_of_state(s);
    if (s->colliders > 0)
        spring_scene_place_colliders(s, colliders_time(s), colliders_time(s), true);
    for (size_t i = 0; i < s->layout.particles; i++) {
        const double inverse = inverse_mass_at(s, i);
        double speed = 0, accel[3] = {0};
        for (uint32_t a = 0; a < s->layout.axes; a++) {
            const double v = (double)scene_state(s, SPRING_VELOCITY, a)[i];
            const double held = scene_has(s, ARRAY_HELD) ? (double)scene_state(s, SPRING_FORCE, a)[i] : 0;
            const double force = (double)all[a * s->layout.stride + i] + held - s->drag * v;
            accel[a] = inverse > 0 ? inverse * force + s->gravity[a] : 0;
            speed = spring_hypot(speed, fabs(v));
        }
        const double acceleration = s->colliders > 0
                                        ? spring_scene_balanced(s, i, accel)
                                        : spring_hypot(spring_hypot(fabs(accel[0]), fabs(accel[1])), fabs(accel[2]));
        if (!(speed <= v_tol) || !(acceleration <= a_tol))
            return false;
    }
    return true;
}

#include "../simd/size_end.h"
