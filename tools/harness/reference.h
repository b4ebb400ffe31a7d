/* SPDX-License-Identifier: MIT */
/*
 * Reference solutions in multiple precision (MPFR): the exact solution of a spring, and the numerical solution of a
 * method without rounding errors. At least 30 digits are correct before results are rounded to doubles.
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

/* Starts from a state; distances use the omega of p. */
void reference_start(reference *r, const spring_params *p, spring_state start);

/* Advances by t with the exact solution. */
void reference_exact(reference *r, const spring_params *p, double t);

/* Takes n steps of a method in exact arithmetic, from w = k/m, g = c/m, a = f/m each rounded to a double, as in the
   library. The step of iterates.h is applied to a basis, and the resulting affine map is raised to the power n by
   repeated squaring. */
void reference_iterate(reference *r, const spring_params *p, spring_method m, double dt, uint64_t n);

/* Takes n steps of x'' = -omega^2 x, likewise. */
void reference_mode(spring_method m, long double omega, double h, uint64_t n, long double *x, long double *v);

/* A step of any method on x'' = -omega^2 x rotates (x, v/omega) if the eigenvalues of its matrix M are complex:
 *
 *     M^n = exp(n log_growth) (cos(n angle) + sin(n angle) J),    J = (x_to_x, v_to_x; x_to_v, -x_to_x),   J^2 = -1
 *
 * For the exact solution the angle is omega h, and J = (0, 1; -1, 0). */
typedef struct reference_turn {
    double log_growth;
    double angle, ahead; /* [rad]; ahead = angle - omega h, to full precision */
    double x_to_x, v_to_x, x_to_v;
} reference_turn;

/* Returns false if the eigenvalues are real. */
bool reference_turn_of(reference_turn *t, spring_method m, double omega, double h);

/* A bound on the norm of up to n steps. */
double reference_turn_norm(const reference_turn *t, uint64_t n);

/* |got - reference| [m] */
double reference_distance(const reference *r, spring_state got);

/* |E - E_reference|/E_reference for the energy without load, m v^2/2 + k x^2/2; k > 0 */
double reference_energy_error(const reference *r, spring_state got);

/* Bounds on the errors of a method [m], as distances of reference_distance():
 *
 *     rounding    between the computed steps and reference_iterate(). A step adds at most
 *                 2 eps (1 + z^2)^2 (|y| + |a| dt/omega) + 8 DBL_TRUE_MIN max(1, |dt|),   z = max(omega, g) |dt|
 *                 (by counting: 4 half ulps of |y| suffice as z -> 0, 11 at z = 1, 44 at z = 2; z^4 is due to RK4)
 *     truncation  between reference_iterate() and reference_exact(). A step adds |one step of the method - the exact
 *                 solution| from the exact y, the difference formed in multiple precision
 *
 * The following steps amplify the error of a step by at most the norm of the product of their matrices. The bounds are
 * the sums over all steps (Lady Windermere's fan), evaluated step by step in double precision. More than 10^6 equal
 * steps must be the whole run, without damping and load; reference_turn_norm() then gives the bound. */
typedef struct reference_bounds reference_bounds;

reference_bounds *reference_bounds_new(const spring_params *p, spring_state start); /* exits if out of memory */
void reference_bounds_add(reference_bounds *b, const spring_params *p, spring_method m, double dt, uint64_t n);
void reference_bounds_end(reference_bounds *b, double *rounding, double *truncation); /* and frees b */

/* The largest |R^i - F^i| over i = stride, 2 stride, ... <= n, and n. R is one step of h in exact arithmetic and F the
   exact solution over h, both in (x, v/frequency) and from unrounded k/m and c/m. R^i - F^i is formed in multiple
   precision at every 1024th of these i, and continued from there with 64 bits, without cancellation. */
double reference_worst_error(const spring_params *p, spring_method m, double frequency, double h, uint64_t n,
                             uint64_t stride);

/* The stable step [s] of a method from its definition, by bisection on the eigenvalues of the step matrix from
   unrounded k/m and c/m; 0 if no step is stable. A limit must exist, so leapfrog without stiffness is excluded. */
double reference_stable_step(const spring_params *p, spring_method m);

#endif
