/* SPDX-License-Identifier: MIT */
/* What the kernels of a scene work on, and their table: loops over its links and over its particles. */
#ifndef SPRINGSTEP_SCENE_KERNELS_H
#define SPRINGSTEP_SCENE_KERNELS_H

#include "simd/scalar.h"
#include "simd/targets.h"
#include "twins.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    padding = 16,       /* elements of the longest vector; so many stand before and behind a quantity */
    most_bands = 32,    /* a block with diagonals and bending links has 16 */
    nystrom_stages = 7, /* of a Runge-Kutta-Nystrom method, after the first */
    tile = 64           /* slots of a band whose forces are computed at once, in the first cache */
};
_Static_assert(tile % padding == 0, "a tile is whole vectors");

/* Links whose upper end is `offset` particles after the lower one. Arrays are of whole tiles of slots. */
typedef struct scene_band {
    ptrdiff_t offset;
    ptrdiff_t start, end;       /* slots: from the tile of the first lower end to behind the last */
    const int8_t *occupied;     /* -1 where there is a link that pulls, else 0 */
    ptrdiff_t coefficient_step; /* from slot to slot: 1, or 0: a vector of coefficients for all of them */
    const scalar *stiffness;    /* [N/m] */
    const scalar *rest;         /* [m]; negative on one axis where the link runs from the upper end to the lower */
    const scalar *damping;      /* [N s/m]; NULL: none in the scene */
    scalar *force;  /* [N] on the lower ends of the last slots, of each axis: a ring, and its first tile again */
    ptrdiff_t ring; /* slots: a multiple of tile, at least offset + tile, or all that are read and written */
    ptrdiff_t back; /* offset, less whole rings */
} scene_band;

typedef struct scene_edges {
    size_t count;
    const uint32_t *a, *b;
    const scalar *stiffness, *rest, *damping; /* damping as in scene_band */
} scene_edges;

typedef struct scene_links { /* what a force kernel works on */
    size_t particles;
    uint32_t axes;
    size_t stride; /* elements from one axis to the next */
    scalar *force;
    size_t bands;
    const scene_band *band;
    scene_edges edge_list;
    scalar *records; /* see record_edges() */
} scene_links;

/* What a motion kernel works on. Where quantities are quads, they are those of so many particles on one axis. */
typedef struct scene_particles {
    size_t count;
    uint32_t axes;
    size_t stride;              /* elements from one axis to the next */
    const scalar *inverse_mass; /* 0: pinned */
    size_t mass_step;           /* from particle to particle: 1, or 0: a vector for all of them */
    const scalar *gravity;      /* of each axis a vector; of quads one for all axes */
    scalar drag;
} scene_particles;

/* What stages of Runge-Kutta-Nystrom methods use besides. */
typedef struct scene_nystrom {
    scalar square;                       /* [s^2] of the step */
    scalar *slopes;                      /* accelerations of the stages ... */
    size_t slope_step;                   /* ... elements from one to the next */
    const scalar *weight_x, *weight_v;   /* of each of them */
    const scalar *stage_x;               /* positions of the stage that the force belongs to */
    const scalar *growth, *decay, *loss; /* of each mass, e^(drag t/2) at that stage, its inverse at the next, and
                                            e^(-drag kick/2) - 1 */
} scene_nystrom;

/* A part of a step. A kernel uses what its line in scene_kernels says. */
typedef struct scene_motion {
    scalar kick, drift; /* [s] how long forces act on v, and v on x */
    const scalar *force;
    const scalar *x0, *v0; /* from */
    scalar *x, *v;         /* to */
    scalar *predicted;     /* velocities; may be force */
    const scalar *slope;   /* the velocity of the stage that the force belongs to; v0 at first */
    scalar *sum_x, *sum_v; /* weighted sums of the slopes of stages, and of their accelerations */
    scalar weight;         /* of this stage */
    const scene_nystrom *nystrom;
} scene_motion;

/* From positions, and velocities if links are damped. s->force may be v for bands, and for records without bands. */
typedef void scene_force_kernel(const scene_links *s, const scalar *x, const scalar *v);
typedef void scene_band_kernel(const scene_links *s, const scalar *x, const scalar *v, size_t from, size_t to);
/* Of particles from ... to - 1, both multiples of tile, but for the last; false: a number is infinite or NaN. */
typedef bool scene_motion_kernel(const scene_particles *, const scene_motion *, size_t from, size_t to);

/* With a(u) the acceleration by force, gravity and the drag of u: */
typedef struct scene_kernels {
    const struct scene_kernels *small; /* those whose vectors hold at most a quad, for small scenes: what one kernel
                                          stores the next loads at once only in the same pieces */
    scene_band_kernel *bands[3][2];    /* the forces of bands; by axes - 1, damping */
    scene_force_kernel *edges[3][2];   /* adds those of the edge list */
    scene_force_kernel *records[2];    /* the same, for many edges without order; not on one axis */
    scene_force_kernel *quads[2];      /* the forces of the edge list, where the axes of a particle lie side by side */
    scene_motion_kernel *kick_drift[2][2];  /* v = v0 + kick a(v0);       x = x0 + drift v; by: solved_kick before it,
                                              and after it predicted = v + kick a(predicted) */
    scene_motion_kernel *solved_kick;       /* v = v0 + kick a(v) */
    scene_motion_kernel *solved_kick_drift; /* v = v0 + kick a(v);  x = x0 + drift v */
    scene_motion_kernel *stage;             /* v = v0 + kick a(slope);    x = x0 + drift slope */
    scene_motion_kernel *first_stage;       /* the same, and the sums are slope and a(slope) */
    scene_motion_kernel *next_stage;        /* the same, and they are added to the sums, times weight */
    scene_motion_kernel *last_stage;        /* v = v0 + kick (sum_v + a(slope));   x = x0 + drift (sum_x + slope) */
    scene_motion_kernel
        *nystrom_stage[nystrom_stages]; /* slopes[i] = a; x = x0 + drift v0 + square sum weight_x slopes */
    scene_motion_kernel *nystrom_end;   /* the same, and v = v0 + kick sum weight_v slopes */
} scene_kernels;

SPRING_INTERNAL const scene_kernels spring_scene_v128; /* by bits of a vector */
#if SPRING_LONG_VECTORS
SPRING_INTERNAL const scene_kernels spring_scene_v256, spring_scene_v512;
#endif

#endif
