/* SPDX-License-Identifier: MIT */
/* What the steps of scenes are written with: buffers, forces, motion from one buffer to another. */
#ifndef SPRINGSTEP_SCENE_STEP_H
#define SPRINGSTEP_SCENE_STEP_H

#include "scene_block.h"

/* One step, from a buffer whose forces are known to a buffer, which may be the same. Its times are no sums of steps,
   and the end of one is the begin of the next, to the bit. */
typedef struct scene_step {
    const scene_kernels *kernels;
    const spring_scene *scene;
    uint32_t from, to;
    scalar h;           /* [s] */
    double middle, end; /* [s] */
} scene_step;

/* A step ends where the first number is not finite: a callback is shown nothing else. */
typedef struct scene_outcome {
    bool finite;
    bool force_kept; /* the forces at the end are known */
} scene_outcome;

/* What a scene stores for a method, besides the state and the force. */
enum {
    SCENE_STORES_PREDICTED = 1, /* velocities, where forces depend on velocities */
    SCENE_STORES_STAGE = 2,     /* positions and velocities of a stage */
    SCENE_STORES_SUMS = 4       /* over the stages, of their slopes and accelerations */
};

typedef struct scene_method {
    scene_outcome (*step)(const scene_step *s); /* NULL: not for scenes */
    double (*stable_step)(const scene_bounds *b);
    unsigned stores; /* SCENE_STORES_... */
} scene_method;

extern const scene_method *const spring_scene_methods[SPRING_METHOD_COUNT];

/* Does a(x, v) depend on v by more than drag? */
static inline bool scene_forces_use_velocity(const spring_scene *s)
{
    return s->damped_links > 0 || (s->force != NULL && (s->plan.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0);
}

static inline scalar *scene_stage_x(const scene_step *s)
{
    return scene_axis(s->scene, s->scene->plan.x[stage_buffer], 0);
}

static inline scalar *scene_stage_v(const scene_step *s)
{
    return scene_axis(s->scene, s->scene->plan.v[stage_buffer], 0);
}

static inline scalar *scene_predicted(const scene_step *s)
{
    return scene_axis(s->scene, s->scene->plan.predicted, 0);
}

/* A part of a step, over its whole length, from the state at its start to the one at its end. */
static inline scene_motion scene_motion_of(const scene_step *step)
{
    const spring_scene *s = step->scene;
    const scene_plan *p = &s->plan;
    scene_motion m = {
        .particles = p->particles,
        .axes = p->axes,
        .stride = p->stride,
        .inverse_mass = p->inverse_mass != 0 ? scene_array(s, p->inverse_mass) : NULL,
        .inverse_mass_all = (scalar)(1 / s->mass_all),
        .drag = (scalar)s->drag,
        .kick = step->h,
        .drift = step->h,
        .force = scene_axis(s, p->force, 0),
        .x0 = scene_axis(s, p->x[step->from], 0),
        .v0 = scene_axis(s, p->v[step->from], 0),
        .x = scene_axis(s, p->x[step->to], 0),
        .v = scene_axis(s, p->v[step->to], 0),
        .slope = scene_axis(s, p->v[step->from], 0),
        .sum_x = scene_axis(s, p->sum_x, 0),
        .sum_v = scene_axis(s, p->sum_v, 0),
    };
    for (uint32_t a = 0; a < p->axes; a++)
        m.gravity[a] = (scalar)s->gravity[a];
    return m;
}

/* The forces of links and callback at time t on positions x and velocities v, arrays of all axes. */
static inline void scene_find_forces(const scene_kernels *kernels, const spring_scene *s, const scalar *x,
                                     const scalar *v, double t)
{
    const scene_plan *p = &s->plan;
    const bool damped = s->damped_links > 0;
    scene_band bands[most_bands];
    scene_links links = {
        .particles = p->particles,
        .stride = p->stride,
        .x = x,
        .v = v,
        .force = scene_axis(s, p->force, 0),
        .bands = p->bands,
        .band = bands,
    };
    for (uint32_t i = 0; i < p->bands; i++) {
        const band_plan *band = &p->band[i];
        bands[i] = (scene_band){
            .offset = band->offset,
            .first = band->first,
            .end = band->end,
            .occupied = band->equal ? scene_bytes_at(s, p->band_occupied) + band->occupied : NULL,
            .stiffness = scene_array(s, p->band_stiffness) + band->coefficients,
            .rest = scene_array(s, p->band_rest) + band->coefficients,
            .damping = damped ? scene_array(s, p->band_damping) + band->coefficients : NULL,
        };
    }
    kernels->bands[p->axes - 1][damped](&links);
    if (p->edges > 0) {
        links.edge_list = (scene_edges){
            .count = p->edges,
            .a = scene_indices(s, p->edge_a),
            .b = scene_indices(s, p->edge_b),
            .stiffness = scene_array(s, p->edge_stiffness),
            .rest = scene_array(s, p->edge_rest),
            .damping = damped ? scene_array(s, p->edge_damping) : NULL,
        };
        kernels->edges[p->axes - 1][damped](&links);
    }
    if (s->force != NULL) {
        const scalar *position[3] = {NULL}, *velocity[3] = {NULL};
        scalar *force[3] = {NULL};
        for (uint32_t a = 0; a < p->axes; a++) {
            position[a] = x + a * p->stride;
            velocity[a] = v + a * p->stride;
            force[a] = scene_axis(s, p->force, a);
        }
        s->force(s->user, t, p->particles, position, velocity, force);
    }
}

static inline void scene_evaluate(const scene_step *s, const scalar *x, const scalar *v, double t)
{
    scene_find_forces(s->kernels, s->scene, x, v, t);
}

#endif
