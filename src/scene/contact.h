/* SPDX-License-Identifier: MIT */
/* Contacts of one particle with the colliders of a scene, in double for both precisions of scenes. contact.c has the
   formulas. Particles that rest or slide on one collider are computed by kernels/contact_rest_tmpl.h instead. */
#ifndef SPRINGSTEP_CONTACT_H
#define SPRINGSTEP_CONTACT_H

#include "../simd/arithmetic.h"

#include <stddef.h>

#include <springstep/scene.h>

enum { most_colliders = 32 }; /* bits of a mask */

/* Factor of upper bounds on distances, for rounding errors. */
static const double rounded_up = 1.001;

/* SPRING_NO_CUSTOM omits the code of custom bodies, for bindings that cannot pass their functions. */
static inline bool is_custom(spring_shape shape)
{
#ifdef SPRING_NO_CUSTOM
    (void)shape;
    return false;
#else
    return shape == SPRING_CUSTOM;
#endif
}

typedef struct vector3 {
    double x, y, z; /* with two axes z is 0 */
} vector3;

/* A rigid frame at one time. */
typedef struct body_pose {
    vector3 at, velocity, spin; /* [m], [m/s], [rad/s] */
    vector3 axis[3];            /* unit vectors */
    vector3 segment;            /* [m] capsule: from `at` to `to`, in the frame */
    vector3 along;              /* the same, in the scene */
    vector3 stretching;         /* [m/s] capsule: velocity of `to` relative to `at` */
} body_pose;

/* A collider during a step. */
typedef struct contact_body {
    spring_shape shape;
    bool moves;      /* its pose depends on time */
    bool turns;      /* its frame turns, or its segment changes, in this step */
    bool degenerate; /* its segment has or passes the length 0, or turns far: the gap along a chord is not convex */
    bool slips;      /* its surface moves in the frame: the spin of a round body, or `surface` */
    bool flat;       /* two axes */
    uint32_t bits;   /* of the masks of particles */
    double half[3], radius, friction, restitution, thickness;
    double skin;           /* [m] part of `radius`, of a box mostly of `half` */
    double rounding_scale; /* [m] of the coordinates that a gap is computed from */
    vector3 surface;       /* [m/s] in the frame; of spheres and capsules, in the scene */
    spring_gap_fn *gap;
    void *user;
    body_pose start, end;
    /* Bounds on the position, at the start of the step, of a particle of radius r that can touch the body. The core is
       the point, segment or box of the shape, without its radius. */
    double reach, growth; /* [m] distance from the core <= reach + growth (r + |d - shift|), d: its displacement */
    /* [m] Box, to be extended by growth (r + |d|). +-INFINITY: not bounded. */
    double low[3], high[3];
} contact_body;

/* What the contacts of a step have in common. */
typedef struct contact_setting {
    const contact_body *body; /* [count] */
    unsigned count;
    double h;                /* [s] duration of the drift */
    double epsilon;          /* rounding error of coordinates */
    double (*origin)[3];     /* [count] [m] points that angular impulses are about */
    spring_impulse *impulse; /* [count] sums */
    bool records;            /* whether impulses are added */
} contact_setting;

/* A particle. */
typedef struct contact_particle {
    vector3 x0;          /* [m] at the start of the drift */
    vector3 v0;          /* [m/s] at the start */
    vector3 accel;       /* [m/s^2] of the kick before the drift */
    vector3 w;           /* [m/s] velocity of the drift */
    vector3 d;           /* [m] displacement */
    vector3 kick;        /* [m/s] velocity at the end minus w, if the drift is that of a whole step */
    double radius, mass; /* [m], [kg] */
    double friction;     /* factor of the friction of colliders */
    uint32_t bits;       /* its mask */
    uint32_t nearby;     /* bit i: its path may touch collider i, and masks allow it; UINT32_MAX: not known */
    uint32_t touched;    /* bit i: it touches collider i */
    bool wrong;          /* a gap is not finite */
} contact_particle;

/* The surface of a collider near a particle. */
typedef struct contact_surface {
    vector3 normal;   /* out of the collider */
    vector3 velocity; /* [m/s] */
    double friction;  /* with this particle */
    unsigned index;   /* of the collider */
} contact_surface;

/* The name of the first field of a collider that is not valid; NULL: none. precision: see definition.h. radius: [m] of
   particles, the largest */
SPRING_INTERNAL const char *spring_collider_invalid_field(const spring_collider *c, size_t precision, double radius,
                                                          uint32_t axes);

/* Replaces its axes by the nearest orthonormal ones. */
SPRING_INTERNAL void spring_collider_orthonormalise(spring_collider *c, uint32_t axes);

/* Replaces a collider by its state t after it was set. */
SPRING_INTERNAL void spring_collider_move(spring_collider *c, double t, uint32_t axes);

/* Places a collider, with a skin [m], for a drift that starts and ends t0 and t1 after the collider was set. epsilon:
   rounding error of coordinates */
SPRING_INTERNAL void spring_contact_place(contact_body *b, const spring_collider *c, double skin, double epsilon,
                                          double t0, double t1, uint32_t axes);

/* [m] The skin of colliders: see contact.c. 0 if none is near a box */
SPRING_INTERNAL double spring_contact_skin(const spring_collider *c, unsigned count, double epsilon, uint32_t axes);

/* [m] An upper bound on the displacements of the points of the core in the step; of a turning plane it is infinite. */
SPRING_INTERNAL double spring_contact_motion(const contact_body *b);

/* [m] The size of numbers that its distances are computed from, with this rounding error. The function of a custom body
   computes in double, so its thickness counts less in single precision. */
SPRING_INTERNAL double spring_contact_rounding_scale(const contact_body *b, const body_pose *pose, double epsilon);

/* Moves a particle: changes w and d by its contacts. */
SPRING_INTERNAL void spring_contact_drift(const contact_setting *s, contact_particle *p);

/* Removes from v the components into the colliders that are touched, with friction: the last kick, at x. */
SPRING_INTERNAL void spring_contact_stop(const contact_setting *s, contact_particle *p, uint32_t touched, bool at_end,
                                         vector3 x, vector3 *v);

/* Adds to collider i the impulse of a contact that changes the velocity of a particle from w to w1, and its position
   from x to x1. */
SPRING_INTERNAL void spring_contact_record(const contact_setting *s, const contact_particle *p, unsigned i,
                                           const vector3 *x, const vector3 *w, const vector3 *x1, const vector3 *w1);

enum { most_surfaces = 16 }; /* that a particle touches; further ones are ignored */

/* Whether a particle at p->x0 touches or is inside a collider at the start of the step. */
SPRING_INTERNAL bool spring_contact_touches(const contact_setting *s, contact_particle *p, const contact_body *b,
                                            double reach);

/* The surfaces of the touched colliders that a particle touches at x, at the start or the end of the drift: those whose
   gap is the least, at most 3 of each collider. Returns their number. */
SPRING_INTERNAL unsigned spring_contact_surfaces(const contact_body *body, unsigned bodies, const contact_particle *p,
                                                 bool at_end, vector3 x, double epsilon,
                                                 contact_surface surface[most_surfaces]);

/* [m/s] The change of the velocity of a point of the frame, which is at x at the start of the drift, in the drift. mean,
   written: the velocity of the frame at `middle` in the middle of the drift, minus that at x at the start */
SPRING_INTERNAL vector3 spring_contact_velocity_change(const contact_body *b, vector3 x, vector3 middle, vector3 *mean);

/* The acceleration that is left of `accel` by the normal forces and the static friction of the surfaces. */
SPRING_INTERNAL double spring_contact_balance(const contact_surface *surface, unsigned count, vector3 accel);

#endif
