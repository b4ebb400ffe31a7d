/* SPDX-License-Identifier: MIT */
/*
 * References in multiple precision (MPFR): the exact solution of a spring, and the numerical solution that a method
 * would give without rounding. Every number here has at least 30 digits to spare before it becomes a double.
 *
 * Distances are Euclidean in (x, v/omega), omega = sqrt(stiffness/mass), or in (x, v s) for a spring without stiffness.
 */
#ifndef HARNESS_REFERENCE_H
#define HARNESS_REFERENCE_H

#include <stdbool.h>

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

/* The exact solution, t later. */
void reference_exact(reference *r, const spring_params *p, double t);

/* n steps of a method in exact arithmetic, from w = k/m, g = c/m, a = f/m each rounded to a double, as the library
   works from those. The step of iterates.h is applied to a basis, and the resulting affine map is raised to the power n
   by repeated squaring. */
void reference_iterate(reference *r, const spring_params *p, spring_method m, double dt, uint64_t n);

/* n steps of x'' = -omega^2 x, likewise. */
void reference_mode(spring_method m, long double omega, double h, uint64_t n, long double *x, long double *v);

/* A step of any method on x'' = -omega^2 x turns (x, v/omega), as long as the eigenvalues of its matrix M are complex:
 *
 *     M^n = exp(n log_growth) (cos(n angle) + sin(n angle) J),    J = (x_to_x, v_to_x; x_to_v, -x_to_x),   J^2 = -1
 *
 * Of the exact solution the angle is omega h, and J = (0, 1; -1, 0). */
typedef struct reference_turn {
    double log_growth;
    double angle, ahead; /* [rad]; ahead = angle - omega h, to all digits */
    double x_to_x, v_to_x, x_to_v;
} reference_turn;

/* Returns false if they are not. */
bool reference_turn_of(reference_turn *t, spring_method m, double omega, double h);

/* A bound of the norm of up to n steps. */
double reference_turn_norm(const reference_turn *t, uint64_t n);

/* |got - reference| [m] */
double reference_distance(const reference *r, spring_state got);

/* |E - E_reference|/E_reference, of the energy without load, m v^2/2 + k x^2/2; k > 0 */
double reference_energy_error(const reference *r, spring_state got);

/* What the steps of a method can add, in [m], the distances of reference_distance():
 *
 *     rounding    between the computed steps and reference_iterate(). A step adds at most
 *                 2 eps (1 + z^2)^2 (|y| + |a| dt/omega) + 8 DBL_TRUE_MIN max(1, |dt|),   z = max(omega, g) |dt|
 *                 (counting roundings: 4 half ulps of |y| suffice as z -> 0, 11 at z = 1, 44 at z = 2; z^4 is RK4's)
 *     truncation  between reference_iterate() and reference_exact(). A step adds |one step of the method - the exact
 *                 solution| from the exact y, the difference formed in multiple precision
 *
 * What a step adds, the steps that follow carry on: at most by the norm of the product of their matrices. The bounds
 * are the sums over all steps (Lady Windermere's fan), walked through in double precision. More than 10^6 equal steps
 * are not walked, and must be all there is, without damping and load: then by reference_turn_norm(). */
typedef struct reference_bounds reference_bounds;

reference_bounds *reference_bounds_new(const spring_params *p, spring_state start); /* exits without memory */
void reference_bounds_add(reference_bounds *b, const spring_params *p, spring_method m, double dt, uint64_t n);
void reference_bounds_end(reference_bounds *b, double *rounding, double *truncation); /* and frees b */

/* The largest |R^i - F^i| over i = stride, 2 stride, ... <= n, and n: R one step of h, in exact arithmetic, F the exact
   solution over it, both in (x, v/frequency) and from k/m and c/m unrounded. R^i - F^i is formed in multiple precision
   at every 1024th of them, and is carried on from there with 64 bits, without a cancellation. */
double reference_worst_error(const spring_params *p, spring_method m, double frequency, double h, uint64_t n,
                             uint64_t stride);

/* The stable step of a method from its definition, by bisection on the eigenvalues of one step's matrix formed from the
   unrounded k/m and c/m [s]; 0 where no step is stable. Needs a limit: not for leapfrog without stiffness. */
double reference_stable_step(const spring_params *p, spring_method m);

#endif
