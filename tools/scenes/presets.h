/* SPDX-License-Identifier: MIT */
/*
 * Five scenes with all that they are made of, and how they look at the start. Like disturbances.h and scene_run.h this
 * takes nothing but the library and memory, so that a scene has the same bits in every program that has it.
 *
 *     rope   particles in a row, level, held at one end, with gravity: it swings down
 *     cloth  a level sheet that hangs on two of its corners, with gravity
 *     jelly  a block that stands on its lowest layer, with gravity
 *     chain  masses on a line between two that are fixed, plucked in the middle; it moves along itself
 *     water  a sheet whose edges are pinned. On one axis it is a height field: each particle moves up and down only
 *
 * Source of the water (4 m x 4 m, three families of links of 25 000 N/m, 1 kg a particle, drag 0.5 N s/m): the original
 * study, whose numbers for one spring the report reproduces.
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

/* The words for them, in that order, ended by NULL. */
extern const char *const preset_names[];

/* NaN, or 0 for a count, where a scene has no such thing, or where nothing is chosen. */
typedef struct preset_settings {
    preset_kind kind;
    uint64_t size;     /* moving masses of a chain, particles of a rope, along an edge of others >= 2 */
    uint64_t axes;     /* water: 1 or 3 */
    uint32_t families; /* of links, SPRING_GRID_...; rope and chain have structural ones alone */
    double length;     /* [m] > 0 of an edge */
    double mass;       /* [kg] > 0 of a particle */
    double end_mass;   /* [kg] > 0 rope: of the last particle */
    double stiffness;  /* [N/m] of a link */
    double damping;    /* [N s/m] of a link */
    double drag;       /* [N s/m] of a particle */
    double gravity;    /* [m/s^2] downwards */
    double stretch;    /* length over rest length at the start > 0. Water on one axis, where 0 means that its links are
                         as stiff across as they are along; else > 1: their stiffness across is 1 - 1/stretch of that */
} preset_settings;

/* What a scene is made of unless the user says otherwise. */
preset_settings preset_defaults(preset_kind kind);

/** Nothing is chosen but the scene. */
preset_settings preset_unchosen(preset_kind kind);

/** What is chosen, and the defaults for the rest. The end of a rope is as heavy as its other particles unless a mass is
    chosen for it; what a scene has none of it does not get. */
preset_settings preset_chosen(const preset_settings *chosen);

/* A definition, and the arrays that it needs. */
typedef struct preset {
    spring_scene_def def;
    uint32_t count[3]; /* particles along x, y, z; particle (i, j, k) has index i + count[0] (j + count[1] k) */
    double *start;     /* [particles*3] x y z [m], z up, whatever axes the scene has */
    double *position;  /* [particles*axes] */
    uint8_t *pinned;   /* [particles] */
    double *mass;      /* [particles] */
    spring_link *link; /* [links] */
} preset;

/** Make the definition of a scene, except for its methods. SPRING_ERANGE: a scene cannot be of this size; SPRING_ENOMEM.
    After either there is nothing to clear. */
spring_status preset_init(preset *r, const preset_settings *s);
void preset_clear(preset *r);

/** Is the method for this scene? */
bool preset_takes(const preset *r, spring_method m);

/** Make the scene, in memory of its own of so many bytes: release it with free(). Otherwise *scene is NULL.

    @param methods  1u << SPRING_EULER | ...
    @param flags    SPRING_SCENE_..., besides those of the definition */
spring_status preset_start(const preset *r, uint32_t methods, uint32_t flags, spring_scene **scene, size_t *bytes);

/** Positions [particles*3] x y z [m] as in `start`. */
void preset_positions(const preset *r, const spring_scene *s, double *xyz);

#endif
