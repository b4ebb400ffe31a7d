/* SPDX-License-Identifier: MIT */
/*
 * Disturbances: short forces on a scene, distributed over the particles around a point.
 *
 * A disturbance that begins at T and lasts D has the force, downwards along the last axis of the scene,
 *
 *     F(t) = peak (4 u (1 - u))^4,  u = (t - T)/D     for T < t < T + D, else 0
 *
 * Its first three derivatives are continuous, so methods up to order 4 keep their order. Its momentum is
 * 128/315 peak D. It is a polynomial, because sin() differs between C libraries.
 *
 * A particle at the horizontal distance r at the start receives a fraction of the force in proportion to
 *
 *     round:   (1 - r^2/R^2)^2  where r < R, pi R^2 the area        square:   1 inside, 0 outside
 *
 * The fractions of all particles that are not pinned add up to 1. If none is in range, the nearest gets all the force.
 */
#ifndef SPRINGSTEP_DISTURBANCES_H
#define SPRINGSTEP_DISTURBANCES_H

#include "presets.h"

static const double disturbance_duration = 0.02; /* [s] default */

typedef enum disturbance_shape { DISTURBANCE_ROUND, DISTURBANCE_SQUARE } disturbance_shape;

typedef struct disturbance {
    double start, duration; /* [s] */
    double x, y;            /* [m] */
    double peak;            /* [N] */
    double area;            /* [m^2] */
    disturbance_shape shape;
} disturbance;

/** The default disturbance of height-field water: a poke in the middle at the start. */
disturbance disturbances_poke(const preset *r, const preset_settings *s, double duration);

/** A drop of rain at a random place and a random time from `begin` to `end`: a poke of (L/16)^2 m^2 with the momentum
    of one particle at 10 m/s. Rain is one drop every 1/rate seconds. */
disturbance disturbances_drop(const preset *r, const preset_settings *s, double begin, double end, double duration,
                              uint64_t *random);

/** A box that has fallen from a height of 1 m hits the middle. Its force is uniform over (L/8)^2 m^2. */
disturbance disturbances_box(const preset *r, const preset_settings *s, double start, double mass, double duration);

typedef struct disturbances disturbances;

/** Makes a list of disturbances the force callback of a scene; NULL: out of memory. All should have the same duration. */
disturbances *disturbances_new(preset *r, const disturbance *list, size_t count);
void disturbances_free(disturbances *p); /* NULL: nothing */

/** The force callback of a scene; `user` points to the disturbances. Forces are along the last axis and depend on time
    only. */
void disturbances_force(void *user, double t, size_t particles, const double *const position[3],
                        const double *const velocity[3], double *const force[3]);

#endif
