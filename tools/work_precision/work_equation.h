/* SPDX-License-Identifier: MIT */
/*
 * The right-hand side that external solvers integrate for ropes and sheets, with the same SIMD instructions as the
 * library.
 *
 * The state holds the moving particles, axis by axis. Links with one offset between their ends form a band. Forces of a
 * band are computed for eight slots at a time, stored, and added up for both ends, as in the library. The code is
 * independent of src/.
 */
#ifndef SPRINGSTEP_WORK_EQUATION_H
#define SPRINGSTEP_WORK_EQUATION_H

#include "harness/scenes.h"

enum { WORK_BANDS = 8, WORK_AXES = 3 };

typedef struct work_band {
    size_t offset;
    double rest;
    double *stiffness, *damping; /* [slots] 0 where there is no link */
    double *force[WORK_AXES];    /* [slots] on the lower ends */
} work_band;

typedef struct work_segment {    /* moving particles without a pinned one between them */
    size_t first, moving, count; /* index of the first one among all particles, and among moving ones */
} work_segment;

typedef struct work_equation {
    size_t axes, moving, vectors, bands, runs; /* moving: particles */
    bool damped;
    double gravity[WORK_AXES], drag;
    double *x[WORK_AXES], *v[WORK_AXES], *a[WORK_AXES], *inverse_mass; /* of all particles */
    work_band band[WORK_BANDS];
    work_segment *run;
    double *memory;
} work_equation;

/** Returns true for a rope or a sheet in space, or a height field: all links in bands of one rest length each. */
bool work_equation_applies(const scene_problem *p);

/** Sorts the coordinates of the problem by axes. Exits if out of memory. */
void work_equation_init(work_equation *e, scene_problem *p);
void work_equation_clear(work_equation *e);

/** dy/dt as in ode.h; data is a work_equation. */
void work_equation_derivative(double t, const double *y, double *dy, const void *data);

/** Computes e->a of all particles, pinned ones included, from e->x and e->v. */
void work_equation_accelerations(const work_equation *e);

#endif
