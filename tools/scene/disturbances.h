/* SPDX-License-Identifier: MIT */
/*
 * Disturbances: forces on a scene that come and go, spread over the particles around a point.
 *
 * A disturbance that begins at T and lasts D has the force, along the last axis of the scene and downwards,
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
#ifndef SPRINGSTEP_DISTURBANCES_H
#define SPRINGSTEP_DISTURBANCES_H

#include "presets.h"

typedef enum disturbance_shape { DISTURBANCE_ROUND, DISTURBANCE_SQUARE } disturbance_shape;

typedef struct disturbance {
    double start, duration; /* [s] */
    double x, y;            /* [m] */
    double peak;            /* [N] */
    double area;            /* [m^2] */
    disturbance_shape shape;
} disturbance;

/** The poke that water gets where no disturbance is asked for: at once, in the middle. */
disturbance disturbances_poke(const preset *r, const preset_settings *s, double duration);

typedef struct disturbances disturbances;

/** Prepare disturbances of one duration, in any order; the list is sorted. Exits with a message without memory. */
disturbances *disturbances_new(const preset *r, disturbance *list, size_t count);
void disturbances_free(disturbances *p); /* NULL: nothing */

/** Pokes the scene if it is water, by its callback; NULL if it is none. */
disturbances *disturbances_poke_water(preset *r, const preset_settings *s, double duration);

/** The callback of a scene; user points to the disturbances. It adds to the last axis, and looks at the time alone. */
void disturbances_force(void *user, double t, size_t particles, const double *const position[3],
                        const double *const velocity[3], double *const force[3]);

#endif
