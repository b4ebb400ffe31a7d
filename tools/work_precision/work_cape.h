/* SPDX-License-Identifier: MIT */
/*
 * The cape of spring-work: a sheet that hangs on the shoulders of a figure of five capsules. The figure runs along a
 * curve, turns, hops and then stands still, in wind. Frames take 8 to 40 ms in a fixed sequence.
 *
 * The motion is chaotic, so positions of two solvers cannot be compared. Observables can: how far the cape stretches and
 * enters the figure, its energy, how still it is at the end, and the time that it takes.
 */
#ifndef SPRINGSTEP_WORK_CAPE_H
#define SPRINGSTEP_WORK_CAPE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/cli.h"

enum {
    CAPE_COLUMNS = 20,
    CAPE_ROWS = 30, /* the first one is pinned */
    CAPE_PARTICLES = CAPE_COLUMNS * CAPE_ROWS,
    CAPE_BODIES = 5
};

static const double cape_spacing = 0.04, cape_mass = 0.002, cape_drag = 0.0015; /* [m], [kg], [N s/m] of a particle */
static const double cape_skin = 0.01, cape_friction = 0.3;                      /* [m] radius of a particle */

/* The bodies, pins and air from one time of the scene to the next. All of them have constant velocities. */
typedef struct cape_motion {
    double duration; /* [s] */
    struct cape_body {
        double radius, at[2][3], velocity[2][3]; /* [m], [m/s] of the ends of its axis */
    } body[CAPE_BODIES];
    double pin[CAPE_COLUMNS][3], pin_to[CAPE_COLUMNS][3]; /* [m] at the start and at the end */
    double gravity[3];                                    /* [m/s^2], with the force of moving air */
} cape_motion;

/* XPBD in float, with as many substeps as steps are asked for; see work_cape_xpbd.c. */
typedef struct cape_xpbd cape_xpbd;
cape_xpbd *cape_xpbd_make(const double (*position)[3], double step, bool tethers, bool mesh);
void cape_xpbd_advance(cape_xpbd *s, const cape_motion *motion, uint64_t steps);
void cape_xpbd_get(const cape_xpbd *s, double (*position)[3], double (*velocity)[3]);

/* Runs all solvers and writes a row for each run. `equal` gets the times at equal stretch; may be NULL. */
extern const char cape_columns[], cape_equal_columns[];
void cape_write(cli_table *table, cli_table *equal, bool quick);

#endif
