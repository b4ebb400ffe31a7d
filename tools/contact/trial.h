/* SPDX-License-Identifier: MIT */
/*
 * A scene with one collider, simulated by leapfrog with the contacts of the library, or with one of two schemes of game
 * engines. The latter use the same leapfrog without colliders:
 *
 *     projection  After each step, a particle inside is moved to the surface. Its normal velocity is multiplied by
 *                 minus the restitution (or removed, if gravity would cause it within two steps). Friction reduces
 *                 motion and velocity along the surface by at most the coefficient times the change along the normal.
 *     penalty     A damped spring with a period of 8 pi steps pushes particles out. Its damping ratio follows from the
 *                 restitution. Friction is the coefficient times the normal force, proportional to speed below 1 mm/s.
 */
#ifndef SPRINGSTEP_TRIAL_H
#define SPRINGSTEP_TRIAL_H

#include <springstep/scene.h>

typedef enum contact_scheme { CONTACT_LIBRARY, CONTACT_PROJECTION, CONTACT_PENALTY, contact_schemes } contact_scheme;

extern const char *const contact_scheme_names[]; /* ended by NULL */

typedef struct trial {
    spring_scene *scene;
    contact_scheme scheme;
    spring_scene_def def;     /* its array of pinned particles must outlive the trial */
    spring_collider collider; /* at time 0 */
    double *before;           /* [particles*3] [m] positions at the start of a step */
    double dt;                /* [s] of all steps */
    double penalty, loss;     /* [1/s^2] stiffness/mass and [1/s] damping/mass of the penalty spring */
} trial;

/** Exits with a message if out of memory or if the scene is not valid. The trial must not move in memory. */
void trial_open(trial *t, const spring_scene_def *def, const spring_collider *c, contact_scheme scheme, double dt);
void trial_close(trial *t);

void trial_advance(trial *t, uint64_t steps);

/** Returns the distance of a point [m] from the surface of a collider at time 0, < 0 inside, and its normal. */
double trial_gap(const spring_collider *c, const double x[3], double n[3]);

#endif
