/* SPDX-License-Identifier: MIT */
/*
 * XPBD (extended position-based dynamics), as used in game engines for rope and cloth. Each substep is one Gauss-Seidel
 * iteration over all links as compliant distance constraints.
 *
 *     x* = x + h v;   each link in turn: C = length - rest,
 *     l = -(C + c rate h)/((1 + c) (w_a + w_b) + 1/(k h^2)),   c = damping/(k h),   x*_a -= w_a l n,   x*_b += w_b l n;
 *     v' = (x* - x)/h
 *
 * Gravity and drag are added to v first; n points from a to b; w = 1/mass. Links are coloured: links of one colour
 * share no particle, so eight are solved at a time.
 *
 * Source: Macklin, Mueller, Chentanez, XPBD (2016), equations (18) and (26), where alpha~ = 1/(k h^2) and
 * beta~ = h^2 damping; Macklin et al., Small steps in physics simulation (2019).
 */
#ifndef SPRINGSTEP_WORK_XPBD_H
#define SPRINGSTEP_WORK_XPBD_H

#include "harness/scenes.h"

typedef struct work_xpbd work_xpbd;

/** Returns true if links are distance springs in space, and the only other forces are gravity and drag. */
bool work_xpbd_applies(const scene_problem *p);

/** Exits if out of memory. */
work_xpbd *work_xpbd_make(const scene_problem *p);
void work_xpbd_free(work_xpbd *s);

/** Resets to the start of the problem, for substeps of h [s]. */
void work_xpbd_start(work_xpbd *s, const scene_problem *p, double h);

/** Takes n substeps. */
void work_xpbd_advance(work_xpbd *s, uint64_t n);

/** The state as in scenes.h. */
void work_xpbd_get(const work_xpbd *s, const scene_problem *p, double *y);

#endif
