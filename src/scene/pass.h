/* SPDX-License-Identifier: MIT */
/* Functions of the steppers: they advance the particles of a scene and evaluate its forces. */
#ifndef SPRINGSTEP_PASS_H
#define SPRINGSTEP_PASS_H

#include "contact_pass.h"
#include "damping_series.h"
#include "steppers.h"

#include <string.h>

/* One step, from the state in one buffer to the state in the other or the same buffer. */
struct scene_step {
    const scene_kernels *kernels;
    spring_scene *scene;
    const scene_links *links;
    scene_forces forces; /* .force: at the end of the step, or of its stages */
    scene_particles particles;
    uint32_t from, to;
    bool first, last;    /* of a call */
    scene_motion whole;  /* over the whole step, from the state at its start to the state at its end */
    scalar h;            /* [s] dt in the precision of the scene */
    double t0, dt, done; /* the step starts at the time t0 + done dt */
    double colliders_base, colliders_from; /* [s] and its step: see struct spring_scene */
    cached_force cached;                   /* the forces at the start */
    bool predicts;                         /* see method_limits */
    damping_series damping;
    scene_contacts contacts;
};

static inline scalar *x_at(const scene_step *s, uint32_t buffer)
{
    return scene_axis(s->scene, positions_in(buffer), 0);
}

static inline scalar *v_at(const scene_step *s, uint32_t buffer)
{
    return scene_axis(s->scene, velocities_in(buffer), 0);
}

static inline scalar *force_at(const scene_step *s, uint32_t buffer)
{
    return scene_axis(s->scene, forces_in(buffer), 0);
}

/* Storage of stage i, for all particles and axes. */
static inline scalar *stage_storage(const scene_step *s, unsigned i)
{
    return scene_axis(s->scene, ARRAY_STAGES, 0) + i * s->scene->layout.quantity;
}

/* Storage of factor i of each mass, indexed like scene_particles.inverse_mass. */
static inline scalar *mass_factor(const scene_step *s, unsigned i)
{
    return (scalar *)scene_memory(s->scene, ARRAY_MASS_FACTORS) + i * s->scene->layout.masses;
}

/* The array in which leapfrog stores predicted velocities. If a callback uses velocities, forces are not kept, so the
   force array of the other buffer is free. Otherwise it is ARRAY_PREDICTED or, if kernels may overwrite velocities by
   forces, the array in which the forces will be stored. */
static inline scalar *predicted_velocities(const scene_step *s)
{
    if (scene_callback_uses_velocity(s->scene))
        return force_at(s, 1 - s->to);
    return scene_has(s->scene, ARRAY_PREDICTED) ? scene_axis(s->scene, ARRAY_PREDICTED, 0) : force_at(s, s->to);
}

/* Array i of ARRAY_KICK: [m/s^2] the residual, two terms of the series and, with colliders, [m] positions. */
static inline scalar *kick_storage(const scene_step *s, unsigned i)
{
    return scene_axis(s->scene, ARRAY_KICK, 0) + i * s->scene->layout.quantity;
}

/* Prepares a step from the state in buffer `from` to the state in buffer `to`. */
static inline void prepare_step(scene_step *s, uint32_t from, uint32_t to)
{
    s->from = from;
    s->to = to;
    s->forces.force = force_at(s, to);
    s->whole = (scene_motion){
        .kick = s->h,
        .drift = s->h,
        .x0 = x_at(s, from),
        .v0 = v_at(s, from),
        .x = x_at(s, to),
        .v = v_at(s, to),
        .max_speed = s->scene->max_speed,
    };
}

/* The time at the end of a step is bit-identical to the time at the start of the next. */
static inline double time_at(const scene_step *s, double fraction)
{
    return s->t0 + (s->done + fraction) * s->dt;
}

/* [s] The time since the colliders were set. */
static inline double elapsed_at(const scene_step *s, double fraction)
{
    return s->colliders_base + (s->done - s->colliders_from + fraction) * s->dt;
}

/* A motion with the contacts that it has if the scene has colliders now. */
static inline contact_motion with_contacts(const scene_step *s, contact_motion kind)
{
    return s->contacts.setting.count > 0 ? kind : NO_CONTACTS;
}

/* Places the colliders for the step, and prepares the arguments of its contacts. */
static inline void prepare_contacts(scene_step *s)
{
    scene_contacts *const c = &s->contacts;
    if (c->setting.count == 0)
        return;
    spring_scene_place_colliders(s->scene, elapsed_at(s, 0), elapsed_at(s, 1), s->first);
    c->begins = s->first;
    c->x = x_at(s, s->to);
    c->friction = scene_read(s->scene, ARRAY_FRICTION);
    c->touched_before = scene_read(s->scene, touched_in(s->from));
    c->touched = scene_memory(s->scene, touched_in(s->to));
}

/* ----------------------------------------------------------------------------------------------------- preparation */

/* Added to a force, -0 changes no bit, while 0 would change -0. */
static const scalar nothing_held[padding] = {-0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0,
                                             -0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0};

static inline scene_particles scene_prepare_particles(const spring_scene *s)
{
    const scene_layout *l = &s->layout;
    const bool each = scene_has(s, ARRAY_INVERSE_MASS), holds = scene_has(s, ARRAY_HELD);
    return (scene_particles){
        .count = l->particles,
        .axes = l->axes,
        .stride = l->stride,
        .inverse_mass = each ? scene_read(s, ARRAY_INVERSE_MASS) : s->inverse_mass_vector,
        .mass_stride = each,
        .gravity = s->gravity_vectors[0],
        .drag = (scalar)s->drag,
        .held = holds ? scene_read_axis(s, ARRAY_HELD, 0) : nothing_held,
        .held_stride = holds,
    };
}

/* band: memory for the bands. */
static inline scene_links scene_prepare_links(spring_scene *s, scene_band band[most_bands])
{
    const scene_layout *l = &s->layout;
    const bool damped = s->damped_links > 0;
    const int8_t *occupied = scene_read(s, ARRAY_OCCUPIED);
    const scalar *stiffness = scene_read(s, ARRAY_BAND_STIFFNESS), *rest = scene_read(s, ARRAY_BAND_REST);
    const scalar *damping = scene_read(s, ARRAY_BAND_DAMPING);
    const scalar *const root = scene_read(s, ARRAY_ROOTS);
    scalar *const frozen = scene_memory(s, ARRAY_FROZEN);
    const size_t all_slots = l->band_slots + l->unbanded + padding;
    for (uint32_t i = 0; i < l->bands; i++) {
        const band_layout *b = &l->band[i];
        band[i] = (scene_band){
            .offset = (ptrdiff_t)b->offset,
            .start = (ptrdiff_t)(b->first / tile * tile),
            .end = (ptrdiff_t)b->end,
            .occupied = occupied + b->slots,
            .coefficient_stride = !b->equal,
            .stiffness = stiffness + b->coefficients,
            .rest = rest + b->coefficients,
            .damping = damped ? damping + b->coefficients : NULL,
            .direction_scale = frozen != NULL ? frozen + b->slots : NULL,
            .ring_start = b->ring_start,
            .ring = (ptrdiff_t)b->ring,
            .back = (ptrdiff_t)(b->offset % b->ring),
        };
    }
    return (scene_links){
        .particles = l->particles,
        .axes = l->axes,
        .terms = damped ? STIFFNESS_AND_DAMPING_TERM : STIFFNESS_TERM,
        .stride = l->stride,
        .bands = l->bands - l->three_point_bands,
        .all_bands = l->bands,
        .band = band,
        .unbanded =
            {
                .count = l->unbanded,
                .a = scene_read(s, ARRAY_LINK_A),
                .b = scene_read(s, ARRAY_LINK_B),
                .stiffness = scene_read(s, ARRAY_LINK_STIFFNESS),
                .rest = scene_read(s, ARRAY_LINK_REST),
                .damping = damped ? scene_read(s, ARRAY_LINK_DAMPING) : NULL,
                .root = root != NULL ? root + l->band_slots : NULL,
                .direction_scale = frozen != NULL ? frozen + l->band_slots : NULL,
                .turning = frozen != NULL ? frozen + all_slots + l->band_slots : NULL,
            },
        .weighted = s->loose > 0 ? l->weighted : 0,
        .weighted_link = scene_memory(s, ARRAY_WEIGHTED),
        .nonlinear = s->nonlinear > 0,
        .tension_only = scene_has(s, ARRAY_FLAGS) || (l->flags & SPRING_SCENE_TENSION_ONLY) != 0,
        .isotropic = s->isotropic_links > 0,
        .root_offset = frozen != NULL ? root - frozen : 0,
        .turning_offset = (ptrdiff_t)all_slots,
    };
}

/* force: where the forces will be stored. */
static inline scene_forces scene_prepare_forces(spring_scene *s, scalar *force)
{
    return (scene_forces){force, scene_memory(s, ARRAY_RINGS), scene_memory(s, ARRAY_RECORDS)};
}

/* ------------------------------------------------------------------------------------------------------- evaluation */

SPRING_NOINLINE void call_back(const spring_scene *s, const scalar *x, const scalar *v, double t, scalar *sum)
{
    const size_t stride = s->layout.stride;
    const bool second = s->layout.axes > 1, third = s->layout.axes > 2;
    const scalar *const position[3] = {x, second ? x + stride : NULL, third ? x + 2 * stride : NULL};
    const scalar *const velocity[3] = {v, second ? v + stride : NULL, third ? v + 2 * stride : NULL};
    scalar *const force[3] = {sum, second ? sum + stride : NULL, third ? sum + 2 * stride : NULL};
    s->force(s->user, t, s->layout.particles, position, velocity, force);
}

/* Computes out->force, the forces of links at positions x and velocities v. */
SPRING_NOINLINE void evaluate_links(const scene_kernels *kernels, const scene_links *links, const scalar *x,
                                    const scalar *v, scene_forces *out)
{
    const common_kernels *const common = kernels->common;
    const bool has_records = out->records != NULL && links->terms != FREEZING_TERMS;
    const bool weighted_in_records = has_records && links->weighted > 0 && !links->nonlinear;
    const bool records = weighted_in_records || (has_records && links->unbanded.count >= links->particles);
    if (links->all_bands > 0)
        kernels->band_forces(links, x, v, out, 0, links->particles);
    if (links->all_bands == 0 || links->unbanded.count > 0 || weighted_in_records)
        (records ? common->record_forces : common->unbanded_forces)(links, x, v, out);
    if (links->weighted > 0 && !weighted_in_records)
        spring_scene_add_weighted(links, x, v, out->force);
}

/* Whether bands have all links and weighted links, so that the forces on a part of the particles can be computed. */
static inline bool only_bands(const scene_links *links)
{
    return links->all_bands > 0 && links->unbanded.count == 0 && links->weighted == 0;
}

/* The same, with the forces of the callback at time t. */
static inline void scene_evaluate(const scene_kernels *kernels, spring_scene *s, const scene_links *links,
                                  const scalar *x, const scalar *v, double t, scene_forces *out)
{
    evaluate_links(kernels, links, x, v, out);
    if (s->force != NULL)
        call_back(s, x, v, t, out->force);
}

/* Evaluates the forces at x and v, at a fraction of the step, and stores them in s->forces. */
SPRING_NOINLINE void evaluate(scene_step *s, const scalar *x, const scalar *v, double fraction)
{
    scene_evaluate(s->kernels, s->scene, s->links, x, v, time_at(s, fraction), &s->forces);
}

/* Sets s->whole.force: the forces at the start of the step. They are evaluated unless they are cached. */
SPRING_NOINLINE void find_start_force(scene_step *s)
{
    s->whole.force = force_at(s, s->from);
    if (s->cached == FORCE || (s->cached == PREDICTED_FORCE && s->predicts))
        return;
    evaluate(s, s->whole.x0, s->whole.v0, 0);
    s->whole.force = s->forces.force; /* predicted forces stay in the other array, for a rollback */
}

/* ----------------------------------------------------------------------------------------------------------- motion */

/* Number of particles that are advanced on all axes before the next ones. Their masses (8 KB) stay in the first-level
   cache. In a fused pass, all their data (150 KB) stay in the second-level cache. */
enum { chunk = 16 * tile };

/* Advances particles from ... to - 1. */
SPRING_NOINLINE bool move_range(const scene_step *s, particle_kernel *kernel, const scene_motion *m, size_t from,
                                size_t to)
{
    if (m->contacts == NO_CONTACTS)
        return kernel(&s->particles, m, from, to);
    for (size_t i = from; i < to; i += contact_chunk)
        if (!move_chunk_in_contact(s->scene, &s->contacts, s->kernels->common, kernel, &s->particles, m, i,
                                   to - i < contact_chunk ? to - i : contact_chunk))
            return false;
    return true;
}

/* Advances all particles. Returns false if a result is not finite. */
static inline bool move(const scene_step *s, particle_kernel *kernel, const scene_motion *m)
{
    const size_t count = s->particles.count;
    for (size_t i = 0; i < count; i += chunk)
        if (!move_range(s, kernel, m, i, count - i > chunk ? i + chunk : count))
            return false;
    return true;
}

/*
 * Advances all particles by `first`. Evaluates the forces at the positions first->x and the velocities v, at a fraction
 * of the step. Then, unless second_kernel is NULL, advances all particles by `second`, which uses these forces and does
 * not change positions. Returns false if a result is not finite.
 *
 * The results are those of move(), evaluate() and move(). If all links are in bands and there is no callback, it is one
 * fused pass: the forces on a chunk of particles are computed as soon as `first` has advanced the other ends of their
 * links, and `second` advances the chunk while it is in the cache.
 */
SPRING_NOINLINE bool move_evaluate_move(scene_step *s, particle_kernel *first_kernel, const scene_motion *first,
                                        const scalar *v, double fraction, particle_kernel *second_kernel,
                                        const scene_motion *second)
{
    const scene_layout *l = &s->scene->layout;
    if (!only_bands(s->links) || s->scene->force != NULL) {
        if (!move(s, first_kernel, first))
            return false;
        evaluate(s, first->x, v, fraction);
        return second_kernel == NULL || move(s, second_kernel, second);
    }
    const size_t ahead = (l->reach + chunk - 1) / chunk * chunk;
    band_kernel *const forces = s->kernels->band_forces;
    for (size_t i = 0; i < l->particles + ahead; i += chunk) {
        if (i < l->particles &&
            !move_range(s, first_kernel, first, i, i + chunk < l->particles ? i + chunk : l->particles))
            return false;
        if (i < ahead)
            continue;
        const size_t from = i - ahead, to = from + chunk < l->particles ? from + chunk : l->particles;
        forces(s->links, first->x, v, &s->forces, from, to);
        if (second_kernel != NULL && !move_range(s, second_kernel, second, from, to))
            return false;
    }
    return true;
}

static inline bool move_and_evaluate(scene_step *s, particle_kernel *kernel, const scene_motion *m, const scalar *v,
                                     double fraction)
{
    return move_evaluate_move(s, kernel, m, v, fraction, NULL, NULL);
}

#endif
