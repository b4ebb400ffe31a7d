/* SPDX-License-Identifier: MIT */
/*
 * A scene with one collider, simulated by leapfrog with the contacts of the library, or with one of the two schemes that
 * engines use. Both are on top of the same leapfrog without colliders:
 *
 *     projection  after each step, a particle that is inside is moved to the surface. Its normal velocity is reversed times
 *                 the restitution (or removed, if gravity would give it that speed within two steps). Friction reduces the
 *                 motion and the velocity along the surface by at most friction times what is changed along the normal
 *     penalty     a damped spring pushes particles out, with a period of 8 pi steps. The damping ratio is that which gives
 *                 the restitution. Friction is friction times the normal force, in proportion to the speed below 1 mm/s
 */
#ifndef SPRINGSTEP_TRIAL_H
#define SPRINGSTEP_TRIAL_H

#include <springstep/scene.h>

typedef enum contact_scheme { CONTACT_LIBRARY, CONTACT_PROJECTION, CONTACT_PENALTY, contact_schemes } contact_scheme;

extern const char *const contact_scheme_names[]; /* ended by NULL */

typedef struct trial {
    spring_scene *scene;
    contact_scheme scheme;
    spring_scene_def def;     /* its pinned particles are used as long as the trial */
    spring_collider collider; /* at time 0 */
    double *before;           /* [particles*3] [m] positions at the start of a step */
    double dt;                /* [s] of all steps */
    double penalty, loss;     /* [1/s^2] stiffness/mass and [1/s] damping/mass of the penalty spring */
} trial;

/** Exits with a message if there is no memory or the scene is not valid. The trial must not move in memory. */
void trial_open(trial *t, const spring_scene_def *def, const spring_collider *c, contact_scheme scheme, double dt);
void trial_close(trial *t);

void trial_advance(trial *t, uint64_t steps);

/** Returns the distance of a point [m] from the surface of a collider at time 0, < 0 inside, and its normal. */
double trial_gap(const spring_collider *c, const double x[3], double n[3]);

#endif
