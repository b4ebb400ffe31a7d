/* SPDX-License-Identifier: MIT */
/*
 * The simulation: a cloth, a rope, water, a cloth that falls on a sphere, or a cape on a body that runs, jumps and is
 * teleported; dragging, cutting and poking. It is independent of windows and drawing.
 *
 * Lengths are in metres; x points right, y up, z towards the viewer.
 */
#ifndef SPRINGS_WORLD_H
#define SPRINGS_WORLD_H

#include <springstep/scene.h>

typedef struct vec3 {
    double x, y, z;
} vec3;

typedef enum world_kind { WORLD_CLOTH, WORLD_ROPE, WORLD_WATER, WORLD_DRAPE, WORLD_CAPE, WORLD_KINDS } world_kind;

enum { WORLD_BODIES = 2 }; /* of drape and cape: a sphere or capsule, and the ground */
enum { MOST_PARTICLES = 61 * 61, MOST_LINKS = 4 * MOST_PARTICLES };

extern const char *const world_names[WORLD_KINDS];

static const uint32_t WORLD_NOTHING = UINT32_MAX; /* no particle */

/* Bits of world.torn: the links from a particle to its neighbours in the grid. */
enum { TORN_RIGHT = 1, TORN_DOWN = 2, TORN_DOWN_RIGHT = 4, TORN_DOWN_LEFT = 8 };

/* Particle (column, row) has index column + columns * row. */
typedef struct world {
    world_kind kind;
    spring_scene *scene;
    uint32_t columns, rows, axes;
    size_t particles, links;
    double spacing, wave;           /* [m] between particles at rest; [m/s] speed of waves along them */
    double damping;                 /* [N s/m] of each link */
    double wind;                    /* [N] largest force on a particle; only for cloth and cape */
    spring_link link[MOST_LINKS];   /* initial links */
    uint8_t pinned[MOST_PARTICLES]; /* at the start */
    uint8_t torn[MOST_PARTICLES];   /* bits TORN_... of cut links */
    vec3 home[MOST_PARTICLES];      /* at the start */
    vec3 previous[MOST_PARTICLES];  /* before the last step */
    vec3 current[MOST_PARTICLES];   /* after it; drawing interpolates between both */
    spring_collider body[WORLD_BODIES];
    double step, late; /* [s] the last step; how long before its end the world is drawn */
    double away;       /* [m] total distance by which the body was teleported back */
    uint32_t grabbed;  /* particle, or WORLD_NOTHING */
    vec3 hand, goal;   /* position of the drag, and its target at the mouse */
} world;

/** Creates a world, and frees the one before. Returns false if out of memory. */
bool world_open(world *w, world_kind kind);

void world_close(world *w);

/** Takes n steps of dt [s], after which the time of the frame is `pending` [s] ahead of the scene, and moves the drag. After
    a failure, the states for drawing are unchanged.

    Returns the status of spring_scene_advance(), or SPRING_ENONFINITE if the energy is implausibly large. */
spring_status world_advance(world *w, spring_method method, double dt, uint64_t n, double pending);

/** Returns true if there are colliders. Euler and methods that require smooth forces do not support contacts. */
bool world_has_bodies(const world *w);

/** Writes positions [particles], interpolated by alpha between the states before and after the last step. The bodies are
    drawn at the same time. */
void world_between(world *w, double alpha, vec3 *out);

/** Kinetic, elastic and potential energy [J]. */
double world_energy(const world *w);

/** Sets the damping of every link that is not cut, relative to 2 sqrt(mass stiffness). */
void world_set_damping(world *w, double ratio);

/** Turns the wind on or off. */
void world_set_wind(world *w, bool blows);

/** Grabs a particle, sets the target of the drag, releases it. Particles that were pinned at the start stay pinned. */
void world_grab(world *w, uint32_t particle);
void world_pull(world *w, vec3 goal);
void world_release(world *w);

/** Cuts a link. */
void world_cut(world *w, size_t link);
bool world_is_cut(const world *w, size_t link);

/** Pushes a particle and its surroundings: cloth and cape away from the viewer, rope right, drape up, water down. */
void world_poke(world *w, uint32_t particle);

#endif
