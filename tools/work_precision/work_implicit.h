/* SPDX-License-Identifier: MIT */
/*
 * Two implicit methods of cloth simulation, with fixed steps of h, for sheets and ropes in space.
 *
 * bdf2-cg     Backward differentiation of order 2; the first step is implicit Euler. With b = 2h/3,
 *             X = (4 x - x')/3 and V = (4 v - v')/3 of the present and the previous state, the step solves
 *                 v1 = V + b a(X + b v1, v1),   x1 = X + b v1
 *             by one step of Newton's iteration from v: (M + b D + b^2 K) (v1 - v) = M (V - v + b a(X + b v, v)).
 *             K leaves out the negative part of the stiffness across compressed links, so the matrix is positive
 *             definite. Conjugate gradients, preconditioned with the diagonal blocks of particles and started from the
 *             previous step, end when the residual is small, relative to h. Pinned particles are filtered from the vectors.
 *             Sources: Baraff, Witkin, Large steps in cloth simulation (1998); Choi, Ko, Stable but responsive cloth
 *             (2002).
 * projective  Projective dynamics: implicit Euler by alternating between directions of links (local) and positions
 *             (global), once per step, from x + h v. The matrix M/h^2 + drag/h + sum of stiffness times Laplacian is constant,
 *             and is factorised once. Not for damped links.
 *             Source: Bouaziz, Martin, Liu, Kavan, Pauly, Projective dynamics (2014).
 */
#ifndef SPRINGSTEP_WORK_IMPLICIT_H
#define SPRINGSTEP_WORK_IMPLICIT_H

#include "work_equation.h"

typedef struct work_implicit work_implicit;

/** Uses the equation as work space. Exits if out of memory. */
work_implicit *work_implicit_make(const scene_problem *p, work_equation *e);
void work_implicit_free(work_implicit *s);

/** Resets to the start of the problem, for steps of h [s]; factorises the matrix if `projective`. */
void work_implicit_start(work_implicit *s, const scene_problem *p, double h, bool projective);

/** Take n steps. Both return the number of force evaluations. */
uint64_t work_bdf2_advance(work_implicit *s, uint64_t n);
uint64_t work_projective_advance(work_implicit *s, uint64_t n);

/** The state as in scenes.h. */
void work_implicit_get(const work_implicit *s, const scene_problem *p, double *y);

#endif
