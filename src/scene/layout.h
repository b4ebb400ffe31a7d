/* SPDX-License-Identifier: MIT */
/* The arrays and bands of a scene, in either precision. */
#ifndef SPRINGSTEP_LAYOUT_H
#define SPRINGSTEP_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    padding = 16,    /* elements of the longest SIMD vector; every array has as many before and after it */
    most_bands = 32, /* a block with shear and bend springs has 16 */
    tile = 64,       /* slots of a band whose forces are computed together; they fit the first-level cache */
    quad_size = 4    /* numbers of a quad, see simd/quad_tmpl.h */
};
_Static_assert(tile % padding == 0, "a tile consists of whole vectors");

static const uint32_t no_slot = UINT32_MAX;

/* The arrays, in the order of their offsets. layout.c says which scenes have them, and how many elements. */
typedef enum scene_array {
    ARRAY_X_0, /* [m] positions of all particles on all axes, in two buffers: see step.c */
    ARRAY_V_0, /* [m/s] velocities */
    ARRAY_X_1,
    ARRAY_V_1,
    ARRAY_FORCE_0,      /* [N] forces at the state in buffer 0 */
    ARRAY_FORCE_1,      /* [N] at the state in buffer 1; ARRAY_FORCE_0 if no forces depend on a predicted velocity */
    ARRAY_PREDICTED,    /* [m/s] velocities that leapfrog predicts; see predicted_velocities() */
    ARRAY_STAGES,       /* quantities that Runge-Kutta methods store */
    ARRAY_INVERSE_MASS, /* [1/kg] 0: pinned */
    ARRAY_FREE_MASS,    /* [1/kg] inverse mass of a particle when it is not pinned; 0: its mass is not valid */
    ARRAY_MASS_FACTORS, /* numbers that RKN8 and SRKN6 store for each mass, with drag */
    ARRAY_OCCUPIED,     /* bands: by slot, -1 where a link acts, else 0 */
    ARRAY_RINGS,        /* [N] bands: ring buffers of forces; see kernels/bands_tmpl.h */
    ARRAY_LINK_A,       /* unbanded links: particles at the ends */
    ARRAY_LINK_B,
    ARRAY_BAND_STIFFNESS, /* [N/m] by slot, or one vector for all slots of a band */
    ARRAY_LINK_STIFFNESS, /* [N/m] unbanded links; follows so that slots of an editable scene are an index for both */
    ARRAY_BAND_REST,      /* [m] */
    ARRAY_LINK_REST,      /* [m] */
    ARRAY_BAND_DAMPING,   /* [N s/m] */
    ARRAY_LINK_DAMPING,   /* [N s/m] */
    ARRAY_FLAGS,          /* by link: spring_link.flags; only if one is not 0 */
    ARRAY_TETHERS,        /* tether */
    ARRAY_WEIGHTED,       /* stored_weighted */
    ARRAY_SLOTS,   /* by link: its slot among the slots of all bands, or band_slots + its index among unbanded links */
    ARRAY_RECORDS, /* see kernels/unbanded_tmpl.h */
    ARRAY_ROOTS,   /* unbanded_links.root, for bands too, by slot like ARRAY_SLOTS */
    ARRAY_FROZEN,  /* direction_scale, then turning, likewise */
    ARRAY_KICK,    /* see kick_storage() */
    ARRAY_PRESSED, /* by particle: the values of pressed_value */
    ARRAY_SUMS,    /* by particle: work space of the stable step and of spring_scene_find_roots() */
    ARRAY_HELD,    /* [N] held forces: no call but spring_scene_set() changes them */
    ARRAY_COLLIDERS, /* spring_collider, as set */
    ARRAY_PLACED,    /* contact_body, in the current step */
    ARRAY_BOUNDS,    /* one collider_bounds: the same, to find particles that are near */
    ARRAY_CLEARANCE, /* [m] by chunk and collider: see kernels/contact_near_tmpl.h */
    ARRAY_IMPULSES,  /* spring_impulse of each collider, in the last call, then in the present call */
    ARRAY_ORIGINS,   /* [m] points that impulses of the present call are about: double[3] of each collider */
    ARRAY_RADIUS,    /* [m] by particle; absent: particle_radius */
    ARRAY_FRICTION,  /* by particle: factor of the friction of colliders */
    ARRAY_BITS,      /* by particle: which colliders it may touch */
    ARRAY_TOUCHED_0, /* by particle: bits of the colliders that it touches in buffer 0 */
    ARRAY_TOUCHED_1,
    ARRAY_COUNT
} scene_array;

/* The directions in which a particle may move that colliders press during an exponential kick: see pressed.h. */
typedef enum freedom { NOT_PRESSED, HELD, FREE_ALONG_LINE, FREE_IN_PLANE } freedom;

/* What is stored of each particle in ARRAY_PRESSED: `stride` numbers of each value, and of each component of a vector. */
typedef enum pressed_value {
    PRESSED_FREEDOM,
    PRESSED_COLLIDER,      /* the first one that it presses on */
    PRESSED_COEFFICIENT,   /* of friction, if it presses on one surface; else 0 */
    PRESSED_LINE,          /* unit vector: the normal, or the line along which the particle is free */
    PRESSED_OUTWARDS = 6,  /* sum of the normals */
    PRESSED_GIVEN = 9,     /* [m/s^2] acceleration in the directions in which it is not free */
    PRESSED_WANTED = 12,   /* [m/s] change of its velocity along the surface with which it does not slide at the end */
    PRESSED_SLIP = 15,     /* [m/s] velocity along the surface in the middle of the step, if it does not change */
    PRESSED_AGAINST = 18,  /* unit vector: the direction of friction, if it slides */
    PRESSED_FRICTION = 21, /* [m/s] change of its velocity by friction */
    PRESSED_REVERSED,      /* 1: friction has pushed it after a kick */
    PRESSED_MOST_FRICTION, /* [m/s] a larger one would reverse its motion */
    PRESSED_REMOVED = 24,  /* [m/s] change of velocity by colliders in the kick; [m/s^2] before its last term */
    PRESSED_TAKEN = 27,    /* [m/s^2] what was taken from its residual before the kick */
    pressed_values = 30
} pressed_value;

/* What a band consists of. Bands of tethers are found after those of other links, and bands of three-point links last,
   so that the former do not change how the latter are added up. */
typedef enum band_kind { BAND_OF_LINKS, BAND_OF_TETHERS, BAND_OF_THREE_POINTS } band_kind;

/* A band: its links, and where its slots, coefficients and ring start in the arrays of all bands. */
typedef struct band_layout {
    uint32_t offset;     /* upper end of a link minus its lower end; three points: from one to the next */
    uint32_t first, end; /* range of the lower ends */
    uint8_t kind;        /* band_kind */
    bool equal;          /* all links are equal and stay so: one vector of coefficients for all slots */
    size_t slots, coefficients, ring_start;
    size_t ring; /* see scene_band */
} band_layout;

/* [bytes] of elements that depend on the precision */
typedef struct element_sizes {
    size_t number, block, tether_link, weighted; /* block: struct spring_scene */
    size_t bounds_head, bound;                   /* a collider_bounds without colliders, and a collider_bound */
} element_sizes;

typedef struct scene_layout {
    uint32_t axes, flags, methods, colliders;
    size_t particles, links, weighted, tethers;
    size_t stride;   /* elements from one axis of a quantity to the next */
    size_t quantity; /* elements of a quantity */
    size_t masses;   /* elements of a quantity that depends on the mass */
    uint32_t bands;
    uint32_t three_point_bands;                      /* the last ones of these */
    size_t reach;                                    /* largest difference of the indices of a banded link */
    band_layout band[most_bands];                    /* by kind, tethers among other links, and ascending offset */
    size_t band_slots, band_coefficients, band_ring; /* of all bands */
    size_t unbanded;                                 /* links in no band, without weighted links */
    size_t loose;                                    /* weighted links that are defined to be in no band */
    size_t offset[ARRAY_COUNT];                      /* [bytes] from the start of the block; SIZE_MAX: absent */
    uint64_t bytes;                                  /* of the block; may exceed the address space */
} scene_layout;

/* The bytes of one coordinate of the particles whose contacts are found together: 32 doubles or 64 floats. The stack
   limits it. */
enum { contact_chunk_bytes = 256 };

/* Elements of ARRAY_CLEARANCE from one chunk to the next: whole vectors. */
static inline size_t clearance_stride(size_t colliders)
{
    return (colliders + 7) / 8 * 8;
}

#endif
