/* SPDX-License-Identifier: MIT */
/*
 * The memory block of a scene: struct spring_scene, followed by arrays. Arrays are found by their offsets from the
 * start of the block and never by pointers, so that the block may be copied to any other address.
 */
#ifndef SPRINGSTEP_BLOCK_H
#define SPRINGSTEP_BLOCK_H

#include "../kernels/scene_kernels.h"
#include "method_limits.h"
#include "../simd/arithmetic.h"
#include "../simd/compiler.h"

/* The coefficients of a tether. While it does not act, ARRAY_BAND_... and ARRAY_LINK_... have 0 instead. */
typedef struct tether {
    uint32_t link;
    scalar stiffness, damping;
} tether;

/* The forces that a step keeps for the next step, in the force array of the buffer that holds the state. Only steps
   write the array and set this value; scene_drop_forces() clears it when something changes on which forces depend. */
typedef enum cached_force {
    NO_FORCE,
    FORCE,          /* at the positions and velocities of the state */
    PREDICTED_FORCE /* at its positions and at velocities that leapfrog predicted; part of the state */
} cached_force;

struct spring_scene {
    scene_layout layout;
    spring_scene_force_fn *force;
    void *user;
    double mass_all, drag, gravity[3];
    scalar max_speed;                    /* [m/s] SCALAR_MAX: no limit */
    scalar gravity_vectors[3][padding];  /* [m/s^2] by axis */
    scalar inverse_mass_vector[padding]; /* for scenes without ARRAY_INVERSE_MASS */
    double t0, dt;                       /* time is t0 + steps dt */
    uint64_t steps;
    uint64_t damped_links, isotropic_links; /* isotropic: on two or three axes, damped and of rest length 0 */
    uint64_t damped_weighted;               /* weighted links among the damped ones */
    size_t loose;                           /* weighted links that are in no band now */
    size_t nonlinear;                       /* weighted links with a rest length, on two or three axes */
    uint64_t ends;                          /* a number for the ends of the links, see layout.c */
    uint32_t buffer;                        /* 0 or 1: holds the state */
    cached_force force_cache;
    bool lost; /* an advance without rollback failed */
    bool bounds_known;
    double roots_dt;       /* [s] step for which ARRAY_ROOTS is known; 0: none */
    uint32_t colliders;    /* at most layout.colliders */
    double colliders_base; /* [s] since they were set, at step colliders_from of the run: never a difference of times */
    uint64_t colliders_from;
    scalar particle_radius; /* [m] */
    scalar largest_radius;  /* [m] of a particle */
    scene_bounds bounds;
};

/* Places the colliders for a drift from t0 to t1, in seconds since they were set. all: not only those that move. */
SPRING_INTERNAL void spring_scene_place_colliders(spring_scene *s, double t0, double t1, bool all);

/* Begins and ends the sums of impulses of a call. t: [s] since the colliders were set */
SPRING_INTERNAL void spring_scene_begin_impulses(spring_scene *s, double t);
SPRING_INTERNAL void spring_scene_end_impulses(spring_scene *s, double t);

/* The size of the acceleration of a particle that the touched colliders do not balance. */
SPRING_INTERNAL double spring_scene_balanced(const spring_scene *s, size_t particle, const double accel[3]);

/* Computes ARRAY_ROOTS, the square roots of the damping of links. The damping saturates: each particle has a factor by
   which dt times the sum of 2 damping/mass over its links (damping/mass to a pin), hG, is at most `most`, and a link
   takes the smaller factor of its ends. Stores 1/(1 + (hG/2)^2) of each particle in ARRAY_SUMS, see damp_bounces(). */
SPRING_INTERNAL void spring_scene_find_roots(spring_scene *s, double dt, double most);

/* Adds the forces of weighted links that are not in bands, with the arguments of an unbanded_kernel. */
SPRING_INTERNAL void spring_scene_add_weighted(const scene_links *s, const scalar *x, const scalar *v, scalar *force);

/* The vector of a weighted link in double, from the state; d: [3] */
SPRING_INTERNAL void spring_scene_weighted_vector(const spring_scene *s, const stored_weighted *l, double d[3]);

/* The bounds for the current links and masses. */
SPRING_INTERNAL const scene_bounds *spring_scene_find_bounds(spring_scene *s);

/* spring_scene_advance() with a given instruction set, for tests. */
SPRING_INTERNAL spring_status spring_scene_advance_with(const scene_kernels *kernels, spring_scene *s, spring_method m,
                                                        double dt, uint64_t n);

/* spring_scene_tear() with a given instruction set, for tests. */
SPRING_INTERNAL spring_status spring_scene_tear_with(const scene_kernels *kernels, spring_scene *s, double stretch,
                                                     const double *limit, uint32_t *torn, size_t capacity,
                                                     size_t *count);

/* ------------------------------------------------------------------------------------------------- access to arrays */

static inline bool scene_has(const spring_scene *s, scene_array a)
{
    return s->layout.offset[a] != SIZE_MAX;
}

/* NULL: the scene does not have the array. */
static inline void *scene_memory(spring_scene *s, scene_array a)
{
    return scene_has(s, a) ? (char *)s + s->layout.offset[a] : NULL;
}

static inline const void *scene_read(const spring_scene *s, scene_array a)
{
    return scene_has(s, a) ? (const char *)s + s->layout.offset[a] : NULL;
}

/* The element of particle 0 on an axis, for a quantity that every scene has. */
static inline scalar *scene_axis(spring_scene *s, scene_array a, uint32_t axis)
{
    void *start = (char *)s + s->layout.offset[a];
    return (scalar *)start + axis * s->layout.stride + padding;
}

static inline const scalar *scene_read_axis(const spring_scene *s, scene_array a, uint32_t axis)
{
    const void *start = (const char *)s + s->layout.offset[a];
    return (const scalar *)start + axis * s->layout.stride + padding;
}

/* [s] since the colliders were set. */
static inline double colliders_time(const spring_scene *s)
{
    return s->colliders_base + (double)(s->steps - s->colliders_from) * s->dt;
}

/* The arrays of a buffer. */
static inline scene_array positions_in(uint32_t buffer)
{
    return buffer == 0 ? ARRAY_X_0 : ARRAY_X_1;
}

static inline scene_array velocities_in(uint32_t buffer)
{
    return buffer == 0 ? ARRAY_V_0 : ARRAY_V_1;
}

static inline scene_array forces_in(uint32_t buffer)
{
    return buffer == 0 ? ARRAY_FORCE_0 : ARRAY_FORCE_1;
}

static inline scene_array touched_in(uint32_t buffer)
{
    return buffer == 0 ? ARRAY_TOUCHED_0 : ARRAY_TOUCHED_1;
}

static inline void scene_drop_forces(spring_scene *s)
{
    s->force_cache = NO_FORCE;
}

/* An array for forces outside of a step, which is not the array of cached forces at predicted velocities. A scene that
   caches such forces has two arrays. */
static inline scalar *scene_spare_forces(spring_scene *s)
{
    return scene_axis(s, forces_in(1 - s->buffer), 0);
}

/* Clears the touched bits of these particles. */
static inline void scene_clear_touched(spring_scene *s, size_t first, size_t count)
{
    uint32_t *const touched = scene_memory(s, touched_in(s->buffer));
    if (touched != NULL)
        memset(touched + first, 0, count * sizeof *touched);
}

static inline void scene_clear_impulses(spring_scene *s)
{
    void *const sums = scene_memory(s, ARRAY_IMPULSES);
    if (sums != NULL)
        memset(sums, 0, s->layout.colliders * sizeof(spring_impulse));
}

/* The array that holds a quantity of the state. */
static inline scene_array state_array(const spring_scene *s, spring_quantity q)
{
    if (q == SPRING_FORCE)
        return ARRAY_HELD;
    return q == SPRING_POSITION ? positions_in(s->buffer) : velocities_in(s->buffer);
}

/* A quantity of the state on an axis, like scene_axis(). */
static inline const scalar *scene_state(const spring_scene *s, spring_quantity q, uint32_t axis)
{
    return scene_read_axis(s, state_array(s, q), axis);
}

static inline scalar *scene_set_state(spring_scene *s, spring_quantity q, uint32_t axis)
{
    return scene_axis(s, state_array(s, q), axis);
}

SPRING_NOINLINE bool scene_finite(const spring_scene *s)
{
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        const scalar *x = scene_state(s, SPRING_POSITION, a), *v = scene_state(s, SPRING_VELOCITY, a);
        for (size_t i = 0; i < s->layout.particles; i++)
            if (!scalar_finite(x[i]) || !scalar_finite(v[i]))
                return false;
    }
    return true;
}

static inline double inverse_mass_at(const spring_scene *s, size_t i)
{
    const scalar *each = scene_read(s, ARRAY_INVERSE_MASS);
    return each != NULL ? (double)each[i] : 1 / s->mass_all;
}

/* What contacts of particle i depend on besides its state. */
static inline void scene_contact_particle(const spring_scene *s, size_t i, contact_particle *p)
{
    const scalar *const radius = scene_read(s, ARRAY_RADIUS), *const friction = scene_read(s, ARRAY_FRICTION);
    const scalar *const inverse_mass = scene_read(s, ARRAY_INVERSE_MASS);
    const uint32_t *const bits = scene_read(s, ARRAY_BITS);
    p->radius = (double)(radius != NULL ? radius[i] : s->particle_radius);
    p->mass = inverse_mass != NULL ? 1 / (double)inverse_mass[i] : s->mass_all;
    p->friction = friction != NULL ? (double)friction[i] : 1;
    p->bits = bits != NULL ? bits[i] : UINT32_MAX;
    p->kick = (vector3){0, 0, 0};
    p->wrong = false;
}

static inline bool scene_is_editable(const spring_scene *s)
{
    return (s->layout.flags & SPRING_SCENE_EDITABLE) != 0;
}

static inline bool scene_callback_uses_velocity(const spring_scene *s)
{
    return s->force != NULL && (s->layout.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0;
}

/* The flags of a link, which include those of the scene. */
static inline uint32_t scene_link_flags(const spring_scene *s, size_t index)
{
    const uint8_t *const flags = scene_read(s, ARRAY_FLAGS);
    const bool all = (s->layout.flags & SPRING_SCENE_TENSION_ONLY) != 0;
    return (flags != NULL ? flags[index] : 0) | (all ? SPRING_LINK_TENSION_ONLY : 0);
}

/* Whether a link pulls and never pushes. rest: its rest length [m] */
static inline bool scene_tension_only(const spring_scene *s, size_t index, scalar rest)
{
    return scene_link_flags(s, index) != 0 && rest > 0;
}

/* Whether forces other than drag depend on velocities. */
static inline bool scene_forces_use_velocity(const spring_scene *s)
{
    return s->damped_links > 0 || scene_callback_uses_velocity(s);
}

#endif
