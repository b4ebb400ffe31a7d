/* SPDX-License-Identifier: MIT */
/*
 * Disturbances: forces on a scene that come and go, spread over the particles around a point.
 *
 * A disturbance that begins at T and lasts D has the force, along the last axis of the scene and downwards,
 *
 *     F(t) = peak (4 u (1 - u))^4,  u = (t - T)/D     for T < t < T + D, else 0
 *
 * whose first three derivatives are continuous, so that no method up to order 4 loses its order by it; its momentum is
 * 128/315 peak D. It is a polynomial, because sines differ from one C library to the next.
 * Of it a particle at the distance r (seen from above, at the start) gets a share in proportion to
 *
 *     round:   (1 - r^2/R^2)^2  where r < R, pi R^2 the area        square:   1 inside, 0 outside
 *
 * the shares of all particles that are not pinned adding up to 1. Where there is none of them the nearest gets all.
 */
#ifndef SPRINGSTEP_DISTURBANCES_H
#define SPRINGSTEP_DISTURBANCES_H

#include "presets.h"

static const double disturbance_duration = 0.02; /* [s] unless another is asked for */

typedef enum disturbance_shape { DISTURBANCE_ROUND, DISTURBANCE_SQUARE } disturbance_shape;

typedef struct disturbance {
    double start, duration; /* [s] */
    double x, y;            /* [m] */
    double peak;            /* [N] */
    double area;            /* [m^2] */
    disturbance_shape shape;
} disturbance;

/** [N] of a disturbance with this momentum [kg m/s]. */
double disturbances_peak(double momentum, double duration);

/** The poke that water gets where no disturbance is asked for: at once, in the middle. */
disturbance disturbances_poke(const preset *r, const preset_settings *s, double duration);

/** A drop of rain, anywhere, at any time from `begin` to `end`: a poke of (L/16)^2 m^2 with the momentum of one particle
    at 10 m/s. Rain is a drop in every 1/rate seconds. */
disturbance disturbances_drop(const preset *r, const preset_settings *s, double begin, double end, double duration,
                              uint64_t *random);

/** A box that has fallen from 1 m and hits the middle, evenly over (L/8)^2 m^2. */
disturbance disturbances_box(const preset *r, const preset_settings *s, double start, double mass, double duration);

typedef struct disturbances disturbances;

/** None yet, for the last axis of a scene; NULL without memory. */
disturbances *disturbances_new(const preset *r);
void disturbances_free(disturbances *p); /* NULL: nothing */

/** One more, before or while the scene runs; all of them should last equally long. Quick where it starts after those
    that there are; of equal starts the one added first comes first. SPRING_ENOMEM leaves those that there are. */
spring_status disturbances_add(disturbances *p, const preset *r, const disturbance *d);

/** Are there any, past ones that are not forgotten and future ones included? */
bool disturbances_any(const disturbances *p);

/** Forget all if all have ended at t, so that a scene that runs for ever takes no more memory for ever. */
void disturbances_forget(disturbances *p, double t);

/** The callback of a scene; user points to the disturbances. It adds to the last axis, and looks at the time alone. */
void disturbances_force(void *user, double t, size_t particles, const double *const position[3],
                        const double *const velocity[3], double *const force[3]);

#endif
