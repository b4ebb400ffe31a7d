/* SPDX-License-Identifier: MIT */
/* What the steps of scenes are written with: buffers, forces, motion from one buffer to another. */
#ifndef SPRINGSTEP_SCENE_STEP_H
#define SPRINGSTEP_SCENE_STEP_H

#include "scene_block.h"

typedef struct scene_force scene_force;

/* One step, from a buffer whose forces are known to a buffer, which may be the same. */
typedef struct scene_step {
    const scene_kernels *kernels;
    const spring_scene *scene;
    scene_force *force;
    scene_particles particles;
    uint32_t from, to;
    bool first, last;    /* of a call */
    const scalar *known; /* the forces at the start */
    scalar h;            /* [s] */
    double t0, dt, done; /* the step starts at t0 + done dt */
} scene_step;

/* A step ends where the first number is not finite: a callback is shown nothing else. */
typedef struct scene_outcome {
    bool finite;
    known_force known; /* at the end */
} scene_outcome;

typedef struct scene_method {
    scene_outcome (*step)(const scene_step *s); /* NULL: not for scenes */
    double (*stable_step)(const scene_bounds *b);
    bool predicts;    /* stores velocities and forces of a prediction, where forces depend on velocities */
    unsigned stages;  /* quantities of all particles that it stores for its stages */
    unsigned factors; /* numbers of each mass that it stores where there is drag */
} scene_method;

SPRING_INTERNAL const scene_method *const spring_scene_methods[SPRING_METHOD_COUNT];

static inline bool scene_callback_uses_velocity(const spring_scene *s)
{
    return s->force != NULL && (s->plan.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0;
}

/* Does a(x, v) depend on v by more than drag? */
static inline bool scene_forces_use_velocity(const spring_scene *s)
{
    return s->damped_links > 0 || scene_callback_uses_velocity(s);
}

/* Of the quantities that are stored for stages one. */
static inline scalar *scene_stage(const scene_step *s, unsigned i)
{
    return scene_axis(s->scene, s->scene->plan.stages, 0) + i * s->scene->plan.stage_step;
}

/* Of the numbers that are stored of each mass one, in the order of scene_particles.inverse_mass. */
static inline scalar *scene_factor(const scene_step *s, unsigned i)
{
    return scene_array(s->scene, s->scene->plan.factors) + i * s->scene->plan.factor_step;
}

/* Where velocities are predicted: where the forces at them will be, if they are kept and these may overwrite those as
   they are found, else in memory of their own; if none are kept, where the others would be. */
static inline scalar *scene_predicted(const scene_step *s)
{
    const scene_plan *p = &s->scene->plan;
    if (scene_callback_uses_velocity(s->scene))
        return scene_force_of(s->scene, 1 - s->to);
    return p->predicted != 0 ? scene_axis(s->scene, p->predicted, 0) : scene_force_of(s->scene, s->to);
}

/* A motion over the whole step, from the state at its start to the one at its end. */
static inline scene_motion scene_motion_of(const scene_step *step)
{
    const spring_scene *s = step->scene;
    const scene_plan *p = &s->plan;
    return (scene_motion){
        .kick = step->h,
        .drift = step->h,
        .force = step->known,
        .x0 = scene_axis(s, p->x[step->from], 0),
        .v0 = scene_axis(s, p->v[step->from], 0),
        .x = scene_axis(s, p->x[step->to], 0),
        .v = scene_axis(s, p->v[step->to], 0),
        .slope = scene_axis(s, p->v[step->from], 0),
    };
}

static inline scene_particles scene_prepare_particles(const spring_scene *s)
{
    const scene_plan *p = &s->plan;
    const bool each = p->inverse_mass != 0;
    return (scene_particles){
        .count = p->small ? quad_size * p->particles : p->particles,
        .axes = p->small ? 1 : p->axes,
        .stride = p->stride,
        .inverse_mass = each ? scene_array(s, p->inverse_mass) : s->inverse_mass_vector,
        .mass_step = each,
        .gravity = s->gravity_vectors[0],
        .drag = (scalar)s->drag,
    };
}

/* The links of a scene, in terms of memory. */
struct scene_force {
    scene_links links;
    scene_band band[most_bands];
};

static inline void scene_prepare_force(const spring_scene *s, scene_force *f)
{
    const scene_plan *p = &s->plan;
    const bool damped = s->damped_links > 0;
    f->links = (scene_links){
        .particles = p->particles,
        .axes = p->axes,
        .stride = p->stride,
        .bands = p->bands,
        .band = f->band,
        .edge_list =
            {
                .count = p->edges,
                .a = scene_indices(s, p->edge_a),
                .b = scene_indices(s, p->edge_b),
                .stiffness = scene_array(s, p->edge_stiffness),
                .rest = scene_array(s, p->edge_rest),
                .damping = damped ? scene_array(s, p->edge_damping) : NULL,
            },
        .records = p->records != 0 ? scene_array(s, p->records) : NULL,
    };
    for (uint32_t i = 0; i < p->bands; i++) {
        const band_plan *band = &p->band[i];
        f->band[i] = (scene_band){
            .offset = band->offset,
            .start = band->first / tile * tile,
            .end = band->end,
            .occupied = scene_bytes_at(s, p->occupied) + band->slots,
            .coefficient_step = !band->equal,
            .stiffness = scene_array(s, p->band_stiffness) + band->coefficients,
            .rest = scene_array(s, p->band_rest) + band->coefficients,
            .damping = damped ? scene_array(s, p->band_damping) + band->coefficients : NULL,
            .force = scene_array(s, p->rings) + band->force,
            .ring = (ptrdiff_t)band->ring,
            .back = (ptrdiff_t)band->back,
        };
    }
}

/* What a callback adds in a small scene, at time t: it is shown each axis by itself. */
SPRING_NOINLINE void scene_call_back_small(const spring_scene *s, const scalar *x, const scalar *v, double t,
                                           scalar *sum)
{
    const size_t n = s->plan.particles;
    const scalar *position[3] = {NULL}, *velocity[3] = {NULL};
    scalar *force[3] = {NULL};
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        scalar *const shown = scene_array(s, s->plan.callback) + 3 * a * n;
        position[a] = shown;
        velocity[a] = shown + n;
        force[a] = shown + 2 * n;
        for (size_t i = 0; i < n; i++) {
            shown[i] = x[quad_size * i + a];
            shown[n + i] = v[quad_size * i + a];
            shown[2 * n + i] = sum[quad_size * i + a];
        }
    }
    s->force(s->user, t, n, position, velocity, force);
    for (uint32_t a = 0; a < s->plan.axes; a++)
        for (size_t i = 0; i < n; i++)
            sum[quad_size * i + a] = force[a][i];
}

/* And in any other. */
static inline void scene_call_back(const spring_scene *s, const scalar *x, const scalar *v, double t, scalar *sum)
{
    const size_t stride = s->plan.stride;
    const bool second = s->plan.axes > 1, third = s->plan.axes > 2;
    const scalar *const position[3] = {x, second ? x + stride : NULL, third ? x + 2 * stride : NULL};
    const scalar *const velocity[3] = {v, second ? v + stride : NULL, third ? v + 2 * stride : NULL};
    scalar *const force[3] = {sum, second ? sum + stride : NULL, third ? sum + 2 * stride : NULL};
    s->force(s->user, t, s->plan.particles, position, velocity, force);
}

/* The forces of links and callback at time t on positions x and velocities v, arrays of all axes. */
static inline void scene_find_forces(const scene_kernels *kernels, const spring_scene *s, scene_force *f,
                                     const scalar *x, const scalar *v, double t, scalar *force)
{
    const scene_plan *p = &s->plan;
    const bool damped = s->damped_links > 0;
    f->links.force = force;
    if (p->small)
        kernels->quads[damped](&f->links, x, v);
    else if (p->bands > 0)
        kernels->bands[p->axes - 1][damped](&f->links, x, v, 0, p->particles);
    else if (p->records == 0)
        for (uint32_t a = 0; a < p->axes; a++)
            memset(force + a * p->stride, 0, p->particles * sizeof *force);
    if (!p->small && p->edges > 0)
        (p->records != 0 ? kernels->records : kernels->edges[p->axes - 1])[damped](&f->links, x, v);
    if (s->force != NULL)
        (p->small ? scene_call_back_small : scene_call_back)(s, x, v, t, force);
}

/* Those after a part of a step. Times are no sums of steps, and the end of one is the begin of the next, to the bit. */
static inline void scene_evaluate(const scene_step *s, const scalar *x, const scalar *v, double part)
{
    scene_find_forces(s->kernels, s->scene, s->force, x, v, s->t0 + (s->done + part) * s->dt,
                      scene_force_of(s->scene, s->to));
}

/* Particles that are moved on all axes before the next: their masses, 8 KB, stay in the first cache, and in one pass
   (scene_sweep()) all that is read and written of them, 150 KB, in the second. */
enum { chunk = 16 * tile };

/* A motion of all particles by a kernel. */
static inline bool scene_move(const scene_step *s, const scene_motion *m, scene_motion_kernel *kernel)
{
    const size_t count = s->particles.count;
    for (size_t i = 0; i < count; i += chunk)
        if (!kernel(&s->particles, m, i, count - i > chunk ? i + chunk : count))
            return false;
    return true;
}

/* A motion, the forces at its end, after a part of the step, with velocities v, and, if not NULL, a motion by them,
   which leaves positions alone: one pass over memory where there are bands only. Then the forces on a particle are
   known as soon as those after it have moved that its links reach, and it is moved on while it is in the cache. */
static inline bool scene_sweep(const scene_step *s, const scene_motion *before, scene_motion_kernel *move_before,
                               const scalar *v, double part, const scene_motion *after, scene_motion_kernel *move_after)
{
    const spring_scene *scene = s->scene;
    const scene_plan *p = &scene->plan;
    if (p->small || p->edges > 0 || scene->force != NULL || p->bands == 0) {
        if (!scene_move(s, before, move_before))
            return false;
        scene_evaluate(s, before->x, v, part);
        return move_after == NULL || scene_move(s, after, move_after);
    }
    const size_t ahead = (p->band[p->bands - 1].offset + chunk - 1) / chunk * chunk;
    scene_band_kernel *const bands = s->kernels->bands[p->axes - 1][scene->damped_links > 0];
    s->force->links.force = scene_force_of(scene, s->to);
    for (size_t i = 0; i < p->particles + ahead; i += chunk) {
        if (i < p->particles &&
            !move_before(&s->particles, before, i, i + chunk < p->particles ? i + chunk : p->particles))
            return false;
        if (i < ahead)
            continue;
        const size_t from = i - ahead, to = from + chunk < p->particles ? from + chunk : p->particles;
        bands(&s->force->links, before->x, v, from, to);
        if (move_after != NULL && !move_after(&s->particles, after, from, to))
            return false;
    }
    return true;
}

#endif
