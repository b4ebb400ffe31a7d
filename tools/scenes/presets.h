/* SPDX-License-Identifier: MIT */
/*
 * Five ready-made scenes: definitions and initial states. Like disturbances.h and scene_run.h, this file depends on the
 * library only, so that a scene is bit-identical in every program that uses it.
 *
 *     rope   a horizontal row of particles, pinned at one end, with gravity: it swings down
 *     cloth  a horizontal sheet, pinned at two corners, with gravity
 *     jelly  a soft block whose lowest layer is pinned, with gravity
 *     chain  masses on a line between two fixed ends, plucked in the middle; longitudinal motion
 *     water  a sheet with pinned edges. On one axis it is a height field: each particle moves up and down only
 *
 * Source of the water (4 m x 4 m; structural, shear and bend springs of 25 000 N/m; 1 kg per particle; drag 0.5 N s/m):
 * the original study, whose numbers for one spring the report reproduces.
 */
#ifndef SPRINGSTEP_PRESETS_H
#define SPRINGSTEP_PRESETS_H

#include <springstep/scene.h>

typedef enum preset_kind {
    PRESET_ROPE,
    PRESET_CLOTH,
    PRESET_JELLY,
    PRESET_CHAIN,
    PRESET_WATER,
    preset_kinds
} preset_kind;

/* The names in this order, ended by NULL. */
extern const char *const preset_names[];

/* A value of NaN, or 0 for a count, means that the scene has no such parameter or that none is chosen. */
typedef struct preset_settings {
    preset_kind kind;
    uint64_t size;     /* moving masses of a chain; particles of a rope; particles along an edge >= 2 of the others */
    uint64_t axes;     /* water: 1 or 3 */
    uint32_t families; /* of links, SPRING_GRID_...; rope and chain have structural links only */
    double length;     /* [m] > 0 of an edge */
    double mass;       /* [kg] > 0 of a particle */
    double end_mass;   /* [kg] > 0 rope: of the last particle */
    double stiffness;  /* [N/m] of a link */
    double damping;    /* [N s/m] of a link */
    double drag;       /* [N s/m] of a particle */
    double gravity;    /* [m/s^2] downwards */
    double stretch;    /* length over rest length at the start > 0. Water on one axis: if > 1, the transverse stiffness
                         of its links is 1 - 1/stretch of `stiffness`; if 0, it is equal to `stiffness` */
} preset_settings;

/* The defaults of a scene. */
preset_settings preset_defaults(preset_kind kind);

/** Settings of a scene with nothing chosen. */
preset_settings preset_unchosen(preset_kind kind);

/** Completes chosen settings with the defaults. The end mass of a rope defaults to the mass of its particles. Settings
    that a scene does not have are ignored. */
preset_settings preset_chosen(const preset_settings *chosen);

/* A definition and its arrays. */
typedef struct preset {
    spring_scene_def def;
    uint32_t count[3]; /* particles along x, y, z; particle (i, j, k) has index i + count[0] (j + count[1] k) */
    double *start;     /* [particles*3] x y z [m], z up, for any number of axes */
    double *position;  /* [particles*axes] */
    uint8_t *pinned;   /* [particles] */
    double *mass;      /* [particles] */
    spring_link *link; /* [links] */
    size_t tethers;    /* the last of the links */
    double fraction;   /* of the tethers */
    spring_weighted_link *bend;
} preset;

/** Makes the definition of a scene, without its methods. On failure (SPRING_ERANGE: the size is out of range;
    SPRING_ENOMEM) nothing is allocated. */
spring_status preset_init(preset *r, const preset_settings *s);
void preset_clear(preset *r);

/** Adds bending stiffness to a rope (EI [N m^2]) or a sheet (D [N m]). SPRING_EINVAL for other scenes; SPRING_ENOMEM */
spring_status preset_bend(preset *r, double rigidity);

/** Adds tethers with this fraction of the stiffness, or replaces them. SPRING_ENOMEM; otherwise as
    spring_links_tethers(). On failure there are none. */
spring_status preset_tether(preset *r, double fraction);

/** Returns true if the scene supports the method. */
bool preset_takes(const preset *r, spring_method m);

/** Creates the scene in one block of *bytes bytes; release it with free(). On failure *scene is NULL.

    @param methods  1u << SPRING_EULER | ...
    @param flags    SPRING_SCENE_..., in addition to the flags of the definition */
spring_status preset_start(const preset *r, uint32_t methods, uint32_t flags, spring_scene **scene, size_t *bytes);

/** Positions [particles*3] x y z [m] as in `start`. */
void preset_positions(const preset *r, const spring_scene *s, double *xyz);

#endif
