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

/* What n steps of a method can add, all in [m], the distances of reference_distance(). */
typedef struct reference_bounds {
    double
        growth; /* the largest norm among the first n powers of the step's matrix M: what it does to older errors */
    double rounding;   /* between n computed steps and reference_iterate() */
    double truncation; /* between reference_iterate() and reference_exact() */
} reference_bounds;

/* Step j adds an error e_j, and the n - 1 - j steps that follow carry it on: at most growth times the sum of all e_j.
 *
 *     rounding    e_j <= 2 eps (1 + z^2)^(3/2) (|y_j| + |a| dt/omega) + 8 DBL_TRUE_MIN,   z = max(omega, g) |dt|
 *                 (counting roundings: at most 4 half ulps of |y| as z -> 0, 11 at z = 1, 44 at z = 2)
 *     truncation  e_j = |one step of the method - the true solution| from the true y_j, formed in multiple precision
 *
 * Walks through the n steps in double precision; for n > 10^6, only without damping and load, by the closed forms
 * growth = 1, 1/sqrt(1 - z^2/4), (1 + z^2)^(n/2) of RK4, leapfrog and Euler, all in their stable range. */
reference_bounds reference_bounds_of(const spring_params *p, spring_method m, double dt, uint64_t n,
                                     spring_state start);

/* The stable step of a method from its definition, by bisection on the eigenvalues of one step's matrix formed from the
   unrounded k/m and c/m [s]; 0 where no step is stable. Needs a limit: not for leapfrog without stiffness. */
double reference_stable_step(const spring_params *p, spring_method m);

#endif
