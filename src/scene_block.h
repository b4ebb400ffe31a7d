/* SPDX-License-Identifier: MIT */
/*
 * A scene as it lies in its block of memory: this structure, and behind it arrays that are found by their offsets from
 * it, never by pointers, so that the block may be copied to any other place.
 */
#ifndef SPRINGSTEP_SCENE_BLOCK_H
#define SPRINGSTEP_SCENE_BLOCK_H

#include "scene_kernels.h"
#include "simd/quad.h"

enum { buffers = 2 }; /* of positions and velocities: they take turns for rule "all or nothing" */

/* A band of links and its slots, one for each particle of the tiles that hold its lower ends. For each slot a byte says
   whether it is occupied by a link. Each slot has coefficients (stiffness, rest length, damping); or, where all links are
   equal and stay so, there is one vector of them for all. */
typedef struct band_plan {
    uint32_t offset;     /* from the lower end of a link to its upper end */
    uint32_t first, end; /* of the lower ends */
    bool equal;
    size_t slots;             /* where its slots begin among those of all bands */
    size_t coefficients;      /* of its coefficients among those of all bands */
    size_t ring, back, force; /* of its ring of forces, see scene_band; and where it is among all rings */
} band_plan;

/* What a scene consists of, and where: offsets in bytes from its start, 0 for what it does not have. */
typedef struct scene_plan {
    uint32_t axes, flags, methods;
    size_t particles, links;
    bool small;                                       /* quantities are arrays of quads, and all links are edges */
    size_t stride;                                    /* elements from one axis of a quantity to the next */
    size_t step;                                      /* elements from one particle to the next */
    size_t band_slots, band_coefficients, band_force; /* in all bands together */
    size_t edges;                                     /* links that lie in no band */
    uint32_t bands;
    band_plan band[most_bands]; /* by ascending offset */
    size_t x[buffers], v[buffers];
    size_t force[buffers];       /* at the state in each buffer, or the same for both, see scene_force_of() */
    size_t predicted;            /* velocities, where they cannot lie where the forces will */
    size_t stages, stage_step;   /* quantities that a method stores for its stages; elements from one to the next */
    size_t factors, factor_step; /* what a method stores of each mass where there is drag, likewise */
    size_t inverse_mass;
    size_t free_inverse_mass; /* of an editable scene: what it is while the particle is not pinned, 0 if not valid */
    size_t occupied, band_stiffness, band_rest, band_damping, rings;
    size_t edge_a, edge_b, edge_stiffness, edge_rest, edge_damping;
    size_t records;  /* see records() */
    size_t callback; /* of a small scene: what a callback is shown, arrays of each axis of position, velocity, force */
    size_t slot;     /* of each link: in the bands, or band_slots and its place in the edge list; without bands none */
    uint64_t bytes;  /* may be more than there are addresses for */
} scene_plan;

/* What bounds the stable step. */
typedef struct scene_bounds {
    double stiffness;    /* [1/s^2] largest sum of (2/mass) stiffness over the links of a particle, 1/mass with a pin */
    double link_damping; /* [1/s]   the same of damping */
    double damping;      /* [1/s]   the same of damping, and drag/mass */
    double stiffness_sum; /* [N/m]   the same as stiffness, without the mass */
    double drag;          /* [N s/m] */
    double least_drag;    /* [1/s]   drag over the largest mass */
} scene_bounds;

/* The forces that are known at a state. */
typedef enum known_force {
    NO_FORCE,
    FORCE,          /* those of its positions and velocities */
    PREDICTED_FORCE /* those of its positions and the velocities that leapfrog had predicted; part of the state */
} known_force;

struct spring_scene {
    scene_plan plan;
    spring_scene_force_fn *force;
    void *user;
    double mass_all, drag, gravity[3];
    scalar gravity_vectors[3][padding];  /* of each axis; in a small scene the first holds quads of all */
    scalar inverse_mass_vector[padding]; /* where particles have none of their own */
    double t0, dt;                       /* time is t0 + steps dt */
    uint64_t steps;
    uint64_t damped_links;
    uint32_t buffer; /* that holds the state */
    known_force known;
    bool lost; /* an advance without rollback has failed */
    bool bounds_known;
    scene_bounds bounds;
};

/* spring_scene_advance() with a given instruction set, for tests. */
SPRING_INTERNAL spring_status spring_scene_advance_with(const scene_kernels *kernels, spring_scene *s, spring_method m,
                                                        double dt, uint64_t n);

/* A quantity of all particles, one axis: that of particle i at plan.step * i. */
SPRING_INLINE scalar *scene_axis(const spring_scene *s, size_t offset, uint32_t axis)
{
    return (scalar *)((char *)(uintptr_t)s + offset) + axis * s->plan.stride + padding;
}

SPRING_INLINE scalar *scene_array(const spring_scene *s, size_t offset)
{
    return (scalar *)((char *)(uintptr_t)s + offset);
}

SPRING_INLINE scalar *scene_quantity(const spring_scene *s, spring_quantity q, uint32_t axis) /* of the state */
{
    return scene_axis(s, (q == SPRING_POSITION ? s->plan.x : s->plan.v)[s->buffer], axis);
}

/* The forces at the state in a buffer. */
SPRING_INLINE scalar *scene_force_of(const spring_scene *s, uint32_t buffer)
{
    return scene_axis(s, s->plan.force[buffer], 0);
}

SPRING_INLINE uint32_t *scene_indices(const spring_scene *s, size_t offset)
{
    return (uint32_t *)((char *)(uintptr_t)s + offset);
}

SPRING_INLINE int8_t *scene_bytes_at(const spring_scene *s, size_t offset)
{
    return (int8_t *)(uintptr_t)s + offset;
}

SPRING_INLINE double inverse_mass_at(const spring_scene *s, size_t i)
{
    return s->plan.inverse_mass != 0 ? (double)scene_array(s, s->plan.inverse_mass)[s->plan.step * i] : 1 / s->mass_all;
}

#endif
