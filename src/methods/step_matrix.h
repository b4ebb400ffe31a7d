/* SPDX-License-Identifier: MIT */
/* One step of a method as a matrix, in powers of the step. The error of a method follows from it: spring/accuracy.c. */
#ifndef SPRINGSTEP_STEP_MATRIX_H
#define SPRINGSTEP_STEP_MATRIX_H

#include "../simd/arithmetic.h"

/* A matrix on (x, v/Omega), for any frequency Omega. */
typedef struct spring_matrix {
    double xx, xv, vx, vv;
} spring_matrix;

/* A spring and a step h in dimensionless form: h times the matrix of the spring is Z = (0, a; -c, -G). */
typedef struct step_rates {
    double a; /* h Omega */
    double c; /* h w/Omega */
    double G; /* h g */
} step_rates;

enum { STEP_TERMS = 5 }; /* more than the largest power of h in a step */

/* One step is (1 + term[1] + term[2] + ...)/(1 + implicit G). term[k] is proportional to h^k; term[0] is not read. */
typedef struct step_terms {
    double implicit; /* fraction of the step over which the damping is implicit */
    spring_matrix term[STEP_TERMS];
} step_terms;

typedef step_terms step_terms_fn(step_rates r);

static inline spring_matrix matrix_product(spring_matrix p, spring_matrix q)
{
    return (spring_matrix){p.xx * q.xx + p.xv * q.vx, p.xx * q.xv + p.xv * q.vv, p.vx * q.xx + p.vv * q.vx,
                           p.vx * q.xv + p.vv * q.vv};
}

/* p + factor q */
static inline spring_matrix matrix_sum(spring_matrix p, double factor, spring_matrix q)
{
    return (spring_matrix){p.xx + factor * q.xx, p.xv + factor * q.xv, p.vx + factor * q.vx, p.vv + factor * q.vv};
}

static inline spring_matrix matrix_of(step_rates r) /* Z */
{
    return (spring_matrix){0, r.a, -r.c, -r.G};
}

/* Z^k/k! from Z^(k-1)/(k-1)!. */
static inline spring_matrix next_power(spring_matrix power, spring_matrix Z, int k)
{
    const spring_matrix zero = {0};
    return matrix_sum(zero, 1.0 / k, matrix_product(power, Z));
}

/* The terms of a method whose step is the exponential series up to its order, such as Runge-Kutta methods of up to four
   stages. */
static inline step_terms exponential_terms(step_rates r, int order)
{
    const spring_matrix Z = matrix_of(r);
    step_terms t = {.term = {{1, 0, 0, 1}}};
    for (int k = 1; k <= order; k++)
        t.term[k] = next_power(t.term[k - 1], Z, k);
    return t;
}

#endif
