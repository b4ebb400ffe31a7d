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
    mpfr_t x, v;  /* [m], [m/s] */
    mpfr_t omega; /* [1/s] the scale of distances */
    mpfr_t scale; /* [m] what the bounds below are proportional to */
} reference;

void reference_init(reference *r);
void reference_clear(reference *r);

/* The true solution at time t. scale becomes |Phi(t)| |(x, v/omega)|, Phi the propagator without load. */
void reference_exact(reference *r, const spring_params *p, spring_state start, double t);

/* The state after n steps of Euler, leapfrog or RK4 in exact arithmetic, from w = k/m, g = c/m, a = f/m each rounded to
   a double, as the library works from those. The step is applied to a basis in the textbook's form (RK4 by its four
   stages) and the resulting affine map is raised to the power n by repeated squaring. */
void reference_iterate(reference *r, const spring_params *p, spring_method m, double dt, uint64_t n,
                       spring_state start);

/* How far rounding can take n steps of a method from its reference_iterate() [m]: each step adds at most
 *
 *     2 eps (1 + z^2)^(3/2) (|y| + |a| dt/omega),   z = max(omega, g) |dt|
 *
 * and what step j adds is carried on by the n - 1 - j steps that follow. (Counting roundings: at most 4 half ulps of
 * |y| as z -> 0, 11 at z = 1, 44 at z = 2; the methods stay below that.) Costs n small matrix products. */
double reference_rounding(const spring_params *p, spring_method m, double dt, uint64_t n, spring_state start);

/* |got - reference|, and scale, as doubles (error 2^-53, relative) [m]. */
double reference_distance(const reference *r, spring_state got);

/* The stable step of a method from its definition, by bisection on the eigenvalues of one step's matrix formed from the
 * unrounded k/m and c/m [s]; 0 where no step is stable. Needs a limit: not for leapfrog without stiffness. */
double reference_stable_step(const spring_params *p, spring_method m);

#endif
