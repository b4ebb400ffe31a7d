/* SPDX-License-Identifier: MIT */
/*
 * Pushes: forces on a scene that come and go, spread over the particles around a place.
 *
 * A push that begins at T and lasts D has the force, along the last axis of the scene and downwards,
 *
 *     F(t) = peak sin^4(pi (t - T)/D)     for T < t < T + D, else 0
 *
 * whose first three derivatives are continuous, so that no method loses its order by it; its momentum is 3/8 peak D.
 * Of it a particle at the distance r (seen from above, at the start) gets a share in proportion to
 *
 *     round:   (1 - r^2/R^2)^2  where r < R, pi R^2 the area        square:   1 inside, 0 outside
 *
 * the shares of all particles that are not pinned adding up to 1. Where there is none of them the nearest gets all.
 */
#ifndef SPRINGSTEP_PUSHES_H
#define SPRINGSTEP_PUSHES_H

#include "ready_scene.h"

typedef enum push_shape { PUSH_ROUND, PUSH_SQUARE } push_shape;

typedef struct push {
    double start, duration; /* [s] */
    double x, y;            /* [m] */
    double peak;            /* [N] */
    double area;            /* [m^2] */
    push_shape shape;
} push;

/** The poke that water gets where no push is asked for: at once, in the middle. */
push pushes_poke(const ready_scene *r, const ready_settings *s, double duration);

typedef struct pushes pushes;

/** Prepare pushes of one duration, in any order; the list is sorted. Exits with a message without memory. */
pushes *pushes_new(const ready_scene *r, push *list, size_t count);
void pushes_free(pushes *p);

/** The callback of a scene; user is a pushes. It adds to the last axis, and looks at the time alone. */
void pushes_force(void *user, double t, size_t particles, const double *const position[3],
                  const double *const velocity[3], double *const force[3]);

#endif
