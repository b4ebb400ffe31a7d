/* SPDX-License-Identifier: MIT */
/* The kernels of scenes (loops over links and over particles): their arguments, their formulas and the type of their
   table. scene_tmpl.h defines the tables: the field kick_drift is move_kick_drift(), and so on; band_forces is
   compute_band_forces() of bands_tmpl.h. */
#ifndef SPRINGSTEP_SCENE_KERNELS_H
#define SPRINGSTEP_SCENE_KERNELS_H

#include "../scene/contact.h"
#include "../scene/layout.h"
#include "../simd/scalar.h"
#include "../simd/targets.h"
#include "single_precision.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    nystrom_stages = 7, /* of a Runge-Kutta-Nystrom method, after the first */
    contact_chunk = contact_chunk_bytes / sizeof(scalar)
};

/* Which terms of the law of a link are computed. */
typedef enum link_terms {
    STIFFNESS_TERM,             /* no link is damped */
    STIFFNESS_AND_DAMPING_TERM, /* of scene_band.damping and unbanded_links.damping */
    FREEZING_TERMS,             /* the same for an exponential kick; stores direction_scale and turning */
    DAMPING_TERM                /* alone, along the directions at the same positions */
} link_terms;

/* A band: links whose upper end is `offset` particles after the lower end. A band has a slot for each particle of the
   tiles that contain lower ends. In a band of three-point links, a link joins the particles i, i + offset and
   i + 2 offset with the weights (w, -2w, w) and rest length 0, and its stiffness and damping are multiplied by w^2. */
typedef struct scene_band {
    ptrdiff_t offset;
    ptrdiff_t start, end;         /* slots, from the first tile with a lower end to the end of the last one */
    const int8_t *occupied;       /* -1 where a link acts, else 0 */
    ptrdiff_t coefficient_stride; /* from slot to slot: 1, or 0: one vector of coefficients for all slots */
    const scalar *stiffness;      /* [N/m] */
    const scalar *rest;           /* [m]; negative on one axis if the link runs from the upper to the lower end, on
                                     several axes if it pulls and never pushes */
    const scalar *damping;        /* [N s/m]; NULL: no link of the scene is damped */
    /* Of an exponential kick, by slot: root/length, on one axis root; 0: the link does not act, or its root is negative.
       NULL: the scene has none. The root of a link is scene_links.root_offset elements farther, its turning term
       scene_links.turning_offset. */
    scalar *direction_scale;
    size_t ring_start; /* of its ring of forces in scene_forces.rings */
    ptrdiff_t ring;    /* slots of the ring, a multiple of tile: at least offset + tile (with three
                                points, 2 offset + tile), or all slots of the band */
    ptrdiff_t back;    /* offset modulo ring */
} scene_band;

/* Links that belong to no band. */
typedef struct unbanded_links {
    size_t count;
    const uint32_t *a, *b;
    const scalar *stiffness, *rest, *damping; /* as in scene_band */
    /* [(N s/m)^(1/2)] square root of the damping, which may be saturated; negative for rest length 0 on several axes */
    const scalar *root;
    scalar *direction_scale; /* as in scene_band */
    scalar *turning;         /* [(N s/m)^(1/2) m/s] 2 root times delta of scene/exponential_kick.h */
} unbanded_links;

/* A weighted link that is not in a band. Its vector is the sum of weight[i] (x[particle[i]] - x[particle[0]]) for i > 0.
   This equals the sum of weight[i] x[particle[i]] since the sum of the weights is 0, and a translation adds no rounding
   error. */
typedef struct stored_weighted {
    uint32_t particle[4];                       /* first the particle with the largest weight */
    uint32_t slot;                              /* among the slots of all bands; no_slot: it cannot be in a band */
    uint8_t points;                             /* number of particles; 0: none */
    uint8_t place[4];                           /* index of each particle in spring_weighted_link */
    bool banded;                                /* a band computes its forces */
    scalar weight[4], rest, stiffness, damping; /* also in a saved state */
    scalar root, direction_scale, turning;      /* as in unbanded_links */
} stored_weighted;

/* Whether a weighted link has a force that no band computes. */
static inline bool weighted_acts(const stored_weighted *l)
{
    return !l->banded && l->points >= 2 && (l->stiffness > 0 || l->damping > 0);
}

typedef struct scene_links {
    size_t particles;
    uint32_t axes;
    link_terms terms;
    size_t stride;           /* elements from one axis to the next */
    size_t bands, all_bands; /* all: with those of three-point links, which follow */
    const scene_band *band;
    unbanded_links unbanded;
    size_t weighted;                /* 0: all weighted links are in bands */
    stored_weighted *weighted_link; /* [weighted] */
    bool nonlinear;                 /* one of these has a rest length, on two or three axes */
    bool tension_only;              /* on two or three axes, some links pull and never push */
    bool isotropic;                 /* on two or three axes, a link of rest length 0 is damped: in all directions */
    /* Further arguments of an exponential kick. */
    ptrdiff_t root_offset, turning_offset; /* elements from scene_band.direction_scale to root, and to turning */
    scalar turning_time;                   /* [s] FREEZING_TERMS: the time step */
    scalar turning_weight; /* DAMPING_TERM: factor of the turning terms, which are added to the rates of links */
} scene_links;

/* The damping of a weighted link, for terms with damping. In an exponential kick it may be saturated. */
static inline scalar weighted_damping(const scene_links *s, const stored_weighted *l)
{
    return s->terms == STIFFNESS_AND_DAMPING_TERM ? l->damping : l->root * l->root;
}

/* Outputs of the kernels of links. */
typedef struct scene_forces {
    scalar *force;   /* [N] on all particles */
    scalar *rings;   /* [N] for each band, the forces on lower ends in its last slots; the first tile is repeated */
    scalar *records; /* see unbanded_tmpl.h; NULL: the scene has none */
} scene_forces;

/* Compute forces from positions, and from velocities if `terms` has damping. A band_kernel computes the forces of all
   bands on particles from ... to - 1, both multiples of tile or the end; v may be the array of forces. An
   unbanded_kernel computes the forces of all unbanded links. With records, it also adds the forces of weighted
   links, unless one is nonlinear. */
typedef void band_kernel(const scene_links *, const scalar *x, const scalar *v, scene_forces *, size_t from, size_t to);
typedef void unbanded_kernel(const scene_links *, const scalar *x, const scalar *v, scene_forces *);

/* Returns whether a link of the bands is longer than `stretch` times its rest length, except for cut links and links of
   rest length 0. May also return true for a link that is shorter than that by at most 1e-5 of it. 0 <= stretch <= 1e9. */
typedef bool stretch_kernel(const scene_links *, const scalar *x, scalar stretch);

/* The particles of a scene. */
typedef struct scene_particles {
    size_t count;
    uint32_t axes;
    size_t stride;              /* elements from one axis to the next */
    const scalar *inverse_mass; /* [1/kg]; 0: pinned */
    size_t mass_stride;         /* from particle to particle: 1, or 0: one vector for all particles */
    const scalar *gravity;      /* [m/s^2] a vector for each axis */
    scalar drag;                /* [N s/m] */
    const scalar *held;         /* [N] held forces */
    size_t held_stride;         /* from particle to particle: 1, or 0: one vector of -0 for all particles */
} scene_particles;

/* Further arguments of the stages of Euler and RK4, and of drift_kick_drift, which uses v only. */
typedef struct scene_stage {
    const scalar *v;       /* [m/s] velocities of the stage that the force belongs to */
    scalar *sum_x, *sum_v; /* weighted sums of the velocities and accelerations of the stages */
    scalar weight;         /* of this stage */
} scene_stage;

/* Further arguments of the stages of a Runge-Kutta-Nystrom method. */
typedef struct scene_nystrom {
    size_t number;                       /* 1 to nystrom_stages */
    scalar square;                       /* [s^2] of the time step */
    scalar *accel;                       /* [m/s^2] accelerations of all stages */
    size_t accel_stride;                 /* elements from one stage to the next */
    const scalar *weight_x, *weight_v;   /* of the stages */
    const scalar *stage_x;               /* [m] positions of the stage that the force belongs to */
    const scalar *growth, *decay, *loss; /* by mass: e^(drag t/2) at that stage, its inverse at the next stage, and
                                            e^(-drag kick/2) - 1 */
} scene_nystrom;

/* Further arguments of a term of the series of an exponential kick. */
typedef struct scene_series {
    const scalar *residual;               /* [m/s^2] */
    const scalar *before, *second_before; /* [m/s^2] the two previous terms */
    scalar coefficient, before_weight, second_weight;
    scalar force_weight; /* [s] */
    scalar h;            /* [s] the time step */
} scene_series;

/* Further arguments of a drift with drag, by mass. */
typedef struct scene_damped_drift {
    const scalar *span; /* [s] (1 - e^(-drag drift))/drag */
    const scalar *loss; /* e^(-drag drift) - 1 */
} scene_damped_drift;

/* Bounds of a collider during a drift, to find particles that may touch it: see contact_body. */
typedef struct collider_bound {
    spring_shape shape;                /* SPRING_SPHERE for custom bodies */
    scalar at[3], shift[3];            /* [m] at the start of the drift, and its displacement */
    scalar axis[3][3], half[3];        /* box; plane: normal at the start and at the end */
    scalar offset[2];                  /* [m] plane: normal . at, at the start and at the end */
    scalar segment[3], inverse_square; /* capsule, at the start */
    scalar reach, growth;              /* see contact_body */
} collider_bound;

typedef struct collider_bounds {
    unsigned count;
    scalar displacement[most_colliders]; /* [m] of the core in the step, an upper bound */
    /* A particle with a path of length d that is farther away than wide [m] + factor d touches nothing. */
    scalar wide[most_colliders], factor[most_colliders];
    scalar low[3][most_colliders], high[3][most_colliders]; /* [m] boxes, extended by the radius of particles */
    collider_bound each[most_colliders];                    /* [colliders of the definition] */
} collider_bounds;

/* What a motion may overwrite. */
typedef struct kept_motion {
    scalar x0[3][contact_chunk], v0[3][contact_chunk];
    scalar force_copy[3][contact_chunk]; /* if velocities are predicted in the place of forces */
    const scalar *force;                 /* the forces, or their copy */
    size_t force_stride;
} kept_motion;

/* Which contacts a motion has. */
typedef enum contact_motion {
    NO_CONTACTS,
    KICK_DRIFT_CONTACTS,
    IMPLICIT_KICK_CONTACTS, /* it stops at the colliders that are touched */
    IMPLICIT_KICK_DRIFT_CONTACTS,
    WHOLE_STEP_CONTACTS
} contact_motion;

/* A motion of all particles, from x0 and v0 to x and v. */
typedef struct scene_motion {
    scalar kick, drift;    /* [s] factors of the acceleration and of the velocity */
    const scalar *force;   /* [N] */
    const scalar *x0, *v0; /* read */
    scalar *x, *v;         /* written */
    scalar max_speed;      /* [m/s] by axis, of free particles at the end of a step; SCALAR_MAX: no limit */
    contact_motion contacts;
    /* kick_drift */
    bool ends_previous; /* begin with the implicit kick that ends the previous step */
    scalar *predicted;  /* written: velocities at the end of the step; may be `force`. NULL: none */
    /* Further arguments: of Euler and RK4, of RKN8, of an exponential kick, and of drifts with drag. */
    const scene_stage *stage;
    const scene_nystrom *nystrom;
    const scene_series *series;
    const scene_damped_drift *damped_drift;
} scene_motion;

/* Advances particles from ... to - 1, both multiples of tile or the end. Returns false if a result is infinite or NaN,
   or if a velocity at the end of a step is above max_speed. */
typedef bool particle_kernel(const scene_particles *, const scene_motion *, size_t from, size_t to);

/* Copies x0 and v0 of particles first ... first + count - 1, and up to the end of the last vector; force if
   velocities are predicted in its place. */
typedef void keep_kernel(const scene_particles *, const scene_motion *, size_t first, size_t count, kept_motion *);

/* RESTS_DONE: the result is complete. RESTS_TOUCHING: the contact changed the motion. The others: how a particle presses
   on its collider, by find_pressing. */
typedef enum rest_result { RESTS_DONE = 1, RESTS_TOUCHING = 2, RESTS_PRESSED = 4 } rest_result;

/* Particles first ... first + count - 1 of a motion that may touch colliders. */
typedef struct candidate_chunk {
    const contact_setting *setting;
    const collider_bounds *bounds;
    const scene_particles *particles;
    const scene_motion *step; /* of stop_resting: a kick */
    kept_motion *kept;
    const scalar *radius;   /* [m] by particle, or one vector for all if radius_stride is 0 */
    const scalar *friction; /* by particle: factor; NULL: 1 */
    size_t radius_stride, first, count;
    scalar *clearance;   /* [m] by collider: see contact_near_tmpl.h */
    bool begins;         /* the clearance is not known yet */
    uint32_t nearby;     /* bits of the colliders that any of these may touch on paths of this length */
    scalar way;          /* [m] a bound on the length of all paths */
    const scalar *place; /* [m] positions for stop_resting and find_pressing: the first particle on the first axis */
    scalar returning;    /* for find_pressing: see presses() */
    bool at_end;         /* the stop is at the end of the step */
    uint32_t listed;     /* particles with a candidate */
    uint8_t list[contact_chunk + 1];   /* their places in the chunk, ascending */
    uint32_t candidate[contact_chunk]; /* bits of the colliders that the particle may touch */
    uint32_t done[contact_chunk];      /* bits of rest_result */
    scalar *change;                    /* [3][contact_chunk], written: [m/s] by the contact */
    scalar *pressed;                   /* ARRAY_PRESSED, written by find_pressing */
} candidate_chunk;

/* Sets `candidate`, `list`, `nearby` and `way` for the motion from kept.x0 to x, for free particles. Returns whether
   there is a candidate. */
typedef bool near_kernel(candidate_chunk *);

/* Kernels for particles with one candidate. They set `done`, and add impulses to those of the colliders. stop_resting
   completes a kick: it writes v and change. move_resting completes motions of particles that rest or slide: it writes x,
   v, predicted and change. For WHOLE_STEP_CONTACTS it also replaces kept.x0 by x of the motion without contacts.
   find_pressing finds particles that press on their collider at the start of a step, where v of the step is their
   residual. It adds no impulses, and writes the first values of these particles to `pressed`. */
typedef void rest_kernel(candidate_chunk *);

/* Friction of pressed particles differs from its limit by at most this part of it, unless all passes are used. */
static const double friction_tolerance = 0.001;

/* Particles that colliders press during an exponential kick: see scene/pressed.h and pressed_tmpl.h. */
typedef struct pressed_kick {
    const scene_particles *particles;
    scalar *value;         /* ARRAY_PRESSED */
    scalar h;              /* [s] the time step */
    const scalar *v0;      /* [m/s] at the start of the step */
    scalar *residual;      /* [m/s^2] */
    const scalar *damping; /* [N] for begin_friction: damping forces in the residual; NULL: not computed yet */
    scalar *term;          /* a term of the series, at last [m/s] the velocity after the kick */
    const scalar *from;    /* for project_pressed */
    scalar given_weight;
    scalar *friction; /* for restore_loads, written: factor of friction after the kick */
} pressed_kick;

/* The loops of scene/pressed.h over pressed particles, by pressed_tmpl.h. */
typedef void pressed_kernel(const pressed_kick *);
typedef bool pressed_test(const pressed_kick *);

/* The kernels for vectors of 16 or 32 bytes. a(u): the acceleration by force, gravity and the drag at velocity u */
typedef struct common_kernels {
    unbanded_kernel *unbanded_forces; /* the forces of unbanded links, added to those of bands if the scene has any */
    unbanded_kernel *record_forces;   /* the same for many unbanded links, on two or three axes */
    /* v = v0 + kick a(v0);  x = x0 + drift v;  predicted = v + kick a(predicted). With ends_previous, v0 is first
       replaced by the solution u of u = v0 + kick a(u). */
    particle_kernel *kick_drift;
    particle_kernel *implicit_kick;       /* v = v0 + kick a(v) */
    particle_kernel *implicit_kick_drift; /* v = v0 + kick a(v);  x = x0 + drift v */
    particle_kernel *stage;               /* v = v0 + kick a(stage.v);  x = x0 + drift stage.v */
    particle_kernel *first_stage;         /* the same, and the sums become stage.v and a(stage.v) */
    particle_kernel *next_stage;          /* the same, and weight times these is added to the sums */
    particle_kernel *last_stage;          /* v = v0 + kick (sum_v + weight a(stage.v));
                                             x = x0 + drift (sum_x + weight stage.v) */
    particle_kernel *nystrom_stage;       /* accel[number - 1] = a;  x = x0 + drift v0 + square sum weight_x accel */
    particle_kernel *nystrom_end;         /* the same, and v = v0 + kick sum weight_v accel */
    particle_kernel *drift;               /* x = x0 + drift v0 */
    particle_kernel *residual;            /* v = a(v0)/(1 + q/2 + q^2/(12 + 2q)), q = kick drag/mass */
    particle_kernel *series_term;         /* v = b = coefficient residual + before_weight before
                                             - second_weight second_before + force_weight force/mass', where
                                             mass' = mass (1 + q/2 + q^2/(12 + 2q)), q = h drag/mass */
    particle_kernel *last_series_term;    /* v = v0 + kick b and, unless x is NULL, x = x0 + drift v */
    particle_kernel *drift_kick_drift;    /* v = stage.v;  x = x0 + drift v0 + drift v */
    particle_kernel *kick_damped_drift;   /* v' = v0 + kick a;  x = x0 + span v';  v = v' + loss v' */
    stretch_kernel *stretched;            /* see above */
    keep_kernel *keep_motion;             /* see above */
    near_kernel *find_near;
    rest_kernel *stop_resting, *move_resting, *find_pressing;
    pressed_test *press_hold;      /* holds particles, or lets them slide; whether some wait for the damping forces */
    pressed_kernel *press_project; /* gives a term of the series the given acceleration */
    pressed_test *press_free;      /* frees the particles that colliders have pulled; whether there are any */
    pressed_test *press_slide;     /* changes friction that does not fit its limit; whether it has */
    pressed_kernel *press_restore; /* gives loads back to the velocities */
} common_kernels;

/* All kernels of a vector width. Besides `common`, they are compiled for vectors of 64 bytes as well, because they gain
   most. With held forces, they call those of `common`. */
typedef struct scene_kernels {
    const common_kernels *common;
    band_kernel *band_forces;                    /* the forces of all bands */
    particle_kernel *kick_drift, *implicit_kick; /* as above */
} scene_kernels;

/* Named by the bits of a SIMD vector. */
#if SPRING_HAS_V128
SPRING_INTERNAL const scene_kernels spring_scene_v128;
SPRING_INTERNAL const common_kernels spring_common_v128;
#endif
#if SPRING_HAS_V256
SPRING_INTERNAL const scene_kernels spring_scene_v256;
SPRING_INTERNAL const common_kernels spring_common_v256;
#endif
#if SPRING_HAS_V512
SPRING_INTERNAL const scene_kernels spring_scene_v512;
#endif

#endif
