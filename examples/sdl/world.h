/* SPDX-License-Identifier: MIT */
/*
 * What moves: a cloth, a rope, water, a cloth that falls on a sphere, or a cape on a body that runs, jumps and is
 * teleported; and the hand that is at it. Nothing here knows of windows.
 *
 * Lengths are in metres; x to the right, y up, z towards the viewer.
 */
#ifndef SPRINGS_WORLD_H
#define SPRINGS_WORLD_H

#include <springstep/scene.h>

typedef struct vec3 {
    double x, y, z;
} vec3;

/* How the wind comes to a particle: cosine and sine of the phase of its gusts. */
typedef struct gust {
    double along, across;
} gust;

typedef enum world_kind { WORLD_CLOTH, WORLD_ROPE, WORLD_WATER, WORLD_DRAPE, WORLD_CAPE, WORLD_KINDS } world_kind;

enum { WORLD_BODIES = 2 }; /* of a drape or a cape: a sphere or capsule, and the ground */

extern const char *const world_names[WORLD_KINDS];

static const uint32_t WORLD_NOTHING = UINT32_MAX; /* no particle */

/* The link from a particle to its neighbour in the grid, as a bit of world.torn. */
enum { TORN_RIGHT = 1, TORN_DOWN = 2, TORN_DOWN_RIGHT = 4, TORN_DOWN_LEFT = 8 };

/* Particle (column, row) has index column + columns * row. */
typedef struct world {
    world_kind kind;
    spring_scene *scene;
    uint32_t columns, rows, axes;
    size_t particles, links;
    double spacing, wave; /* [m] between particles at rest; [m/s] speed of waves along them */
    double damping;       /* [N s/m] of each link */
    double wind;          /* [N] on a particle, at most; only a cloth or a cape feels it */
    gust *gust;           /* [particles] */
    spring_link *link;    /* [links] as the grid made them */
    uint8_t *pinned;      /* [particles] as they were at the start */
    uint8_t *torn;        /* [particles] bits TORN_... of their links that are cut */
    vec3 *home;           /* [particles] at the start */
    vec3 *previous;       /* [particles] before the last step, and */
    vec3 *current;        /* [particles] after it: what is drawn lies between them */
    vec3 *spare;          /* [particles] */
    spring_collider body[WORLD_BODIES];
    double away;      /* [m] the body of the cape has been teleported back by so much */
    uint32_t grabbed; /* particle, or WORLD_NOTHING */
    vec3 hand, goal;  /* where the hand is, and where the mouse wants it */
} world;

/** Make a world. False without memory, or if the library refuses it; the world is empty then. */
bool world_open(world *w, world_kind kind);

/** Free what it holds; an empty one holds nothing. */
void world_close(world *w);

/** Take n steps of dt [s], and the hand with them. After a failure what is drawn stays as it was.

    Returns what spring_scene_advance() does; SPRING_ENONFINITE, too, where there is more energy than can be. */
spring_status world_advance(world *w, spring_method method, double dt, uint64_t n);

/** Whether there are colliders; methods that require smooth forces, and Euler, have no contacts. */
bool world_has_bodies(const world *w);

/** Positions [particles] a part alpha of the way from the state before the last step to that after it. */
void world_between(const world *w, double alpha, vec3 *out);

/** Kinetic, elastic and potential energy [J]. */
double world_energy(const world *w);

/** Damp every link that is not cut, as a part of 2 sqrt(mass stiffness). */
void world_set_damping(world *w, double ratio);

/** Let the wind blow, or not. */
void world_set_wind(world *w, bool blows);

/** Take hold of a particle; where the hand is to go with it; let go. What was pinned at the start stays. */
void world_grab(world *w, uint32_t particle);
void world_pull(world *w, vec3 goal);
void world_release(world *w);

/** Cut a link. */
void world_cut(world *w, size_t link);
bool world_is_cut(const world *w, size_t link);

/** Push the surroundings of a particle: cloth and cape away from the viewer, a rope to the right, a drape up, water down. */
void world_poke(world *w, uint32_t particle);

#endif
