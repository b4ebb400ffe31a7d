/* SPDX-License-Identifier: MIT */
/*
 * The force of a link, written from its definition in scene.h and independently of src/. Used by reference solutions,
 * tests, and the equation that GSL and SUNDIALS integrate.
 *
 *     tension = stiffness (length - rest) + damping rate,    force on a = tension (b - a)/length,    on b the opposite
 *
 * On one axis length and rate are the differences b - a of position and velocity, with their sign. A link of rest
 * length 0 is linear: force on a = stiffness (b - a) + damping (derivative of b - a). A weighted link has the sum of
 * weight x in place of b - a, and the force on a particle is -weight times the "force on a".
 */
#ifndef HARNESS_LINK_H
#define HARNESS_LINK_H

#include <math.h>
#include <stddef.h>

typedef struct link_force {
    double length, rate; /* [m], [m/s] */
    double tension;      /* [N] */
    double scale;        /* [N/m] tension/length; 0 if the ends coincide. Unused on one axis */
    double force[3];     /* [N] on end a */
} link_force;

/** Evaluates a link from b - a, in position [m] and velocity [m/s]. With a constant `axes`, compilers unroll loops. */
static inline link_force link_evaluate(size_t axes, const double *delta, const double *relative, double stiffness,
                                       double damping, double rest)
{
    link_force r = {.force = {0}};
    if (axes == 1) {
        r.length = delta[0];
        r.rate = relative[0];
        r.tension = r.force[0] = stiffness * (r.length - rest) + damping * r.rate;
        return r;
    }
    const double z = axes == 3 ? delta[2] : 0, product_z = axes == 3 ? delta[2] * relative[2] : 0;
    r.length = sqrt(delta[0] * delta[0] + delta[1] * delta[1] + z * z);
    if (r.length > 0)
        r.rate = (delta[0] * relative[0] + delta[1] * relative[1] + product_z) / r.length;
    r.tension = stiffness * (r.length - rest) + damping * r.rate;
    r.scale = r.length > 0 ? r.tension / r.length : 0;
    r.force[0] = r.scale * delta[0];
    r.force[1] = r.scale * delta[1];
    r.force[2] = r.scale * z;
    for (size_t d = 0; d < axes && rest == 0; d++)
        r.force[d] = stiffness * delta[d] + damping * relative[d];
    return r;
}

#endif
