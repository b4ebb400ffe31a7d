/* SPDX-License-Identifier: MIT */
/*
 * References in multiple precision (MPFR): the true solution of a spring, and the numerical solution that a method
 * would give without rounding. Every number here has at least 30 digits to spare before it becomes a double.
 *
 * Distances are Euclidean in (x, v/omega), omega = sqrt(stiffness/mass), or in (x, v s) for a spring without stiffness.
 */
#ifndef HARNESS_REFERENCE_H
#define HARNESS_REFERENCE_H

#include <mpfr.h>

#include <springstep/spring.h>

typedef struct reference {
    mpfr_t x, v;  /* [m], [m/s] the state */
    mpfr_t omega; /* [1/s] the scale of distances */
    mpfr_t size;  /* [m] |(x, v/omega)| at the start, times the norms of the propagators applied since */
} reference;

void reference_init(reference *r);
void reference_clear(reference *r);

/* Start from a state; distances are measured with the omega of p. */
void reference_start(reference *r, const spring_params *p, spring_state start);

/* The true solution, t later. */
void reference_exact(reference *r, const spring_params *p, double t);

/* n steps of Euler, leapfrog or RK4 in exact arithmetic, from w = k/m, g = c/m, a = f/m each rounded to a double, as the
   library works from those. The step is applied to a basis in the textbook's form (RK4 by its four stages) and the
   resulting affine map is raised to the power n by repeated squaring. */
void reference_iterate(reference *r, const spring_params *p, spring_method m, double dt, uint64_t n);

/* |got - reference| [m] */
double reference_distance(const reference *r, spring_state got);

/* |E - E_reference|/E_reference, of the energy without load, m v^2/2 + k x^2/2; k > 0 */
double reference_energy_error(const reference *r, spring_state got);

/* What the steps of a method can add, in [m], the distances of reference_distance():
 *
 *     rounding    between the computed steps and reference_iterate(). A step adds at most
 *                 2 eps (1 + z^2)^2 (|y| + |a| dt/omega) + 8 DBL_TRUE_MIN,   z = max(omega, g) |dt|
 *                 (counting roundings: 4 half ulps of |y| suffice as z -> 0, 11 at z = 1, 44 at z = 2; z^4 is RK4's)
 *     truncation  between reference_iterate() and reference_exact(). A step adds |one step of the method - the true
 *                 solution| from the true y, the difference formed in multiple precision
 *
 * What a step adds, the steps that follow carry on: at most by the norm of the product of their matrices. The bounds are
 * the sums over all steps (Lady Windermere's fan), walked through in double precision. More than 10^6 equal steps are
 * not walked, and must be all there is, without damping and load: then by the closed forms for the norm,
 * 1/sqrt(1 - z^2/4) of leapfrog, (1 + z^2)^(n/2) of Euler and 1 of RK4 in its stable range. */
typedef struct reference_bounds reference_bounds;

reference_bounds *reference_bounds_new(const spring_params *p, spring_state start); /* exits without memory */
void reference_bounds_add(reference_bounds *b, const spring_params *p, spring_method m, double dt,
                          uint64_t n);
void reference_bounds_end(reference_bounds *b, double *rounding, double *truncation); /* and frees b */

/* The stable step of a method from its definition, by bisection on the eigenvalues of one step's matrix formed from the
   unrounded k/m and c/m [s]; 0 where no step is stable. Needs a limit: not for leapfrog without stiffness. */
double reference_stable_step(const spring_params *p, spring_method m);

#endif
