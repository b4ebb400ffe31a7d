/* SPDX-License-Identifier: MIT */
/* The exact solution over a given time as coefficients that apply to any state of a spring; see exact.c. */
#ifndef SPRINGSTEP_PROPAGATOR_H
#define SPRINGSTEP_PROPAGATOR_H

#include "../simd/targets.h"
#include "roots.h"

#include <stdbool.h>
#include <stddef.h>

#include <springstep/spring.h>

typedef struct spring_propagator {
    double half;           /* e^(-bt/2), or of the slow root */
    double F, G, H, wH, P; /* times half; H [s], wH [1/s]; P [s^2] is complete */
    double decay_rate;     /* [1/s] for t > 0, of the slowest mode */
} spring_propagator;

SPRING_INTERNAL spring_propagator spring_propagator_of(const spring_quotients *r, double t,
                                                       bool loaded); /* without loaded, P = 0 */

/* Whether a spring of 1 kg that follows a target lands after a step of dt: the rule of follow_formula_tmpl.h. y, u:
   relative to the rest position and its velocity. single: x is a float. */
SPRING_INTERNAL bool spring_lands(const spring_params *p, double x, double rest, double y, double u, double dt,
                                  bool single);

/* spring_step_exact(), by value. */
SPRING_INTERNAL spring_state spring_exact(spring_state s, const spring_params *p, double t);

/* e^x - 1 */
SPRING_INTERNAL double spring_expm1(double x);

SPRING_INTERNAL void spring_sine_cosine(double angle, double *sine, double *cosine);

/* Springs that the exact solution advances with coefficients for each spring, in double in both precisions:
   bit-identical to spring_exact(). A spring that would not stay finite, or has a negative rate, keeps its state. */
typedef struct exact_array {
    const void *first; /* NULL: all are 0 */
    size_t stride;     /* from spring to spring: 1, or 0 for a vector of equal elements */
} exact_array;

/* Springs that follow targets: see spring_batch_follow(). */
typedef struct exact_landing {
    double x_tol, v_tol; /* finite */
    size_t counted;      /* springs that are counted; further ones only fill a vector */
    size_t *moving;      /* incremented by the number of springs that are not at rest on their targets */
} exact_landing;

typedef struct exact_run {
    size_t count; /* a multiple of the lanes of any vector */
    bool single;  /* arrays of float, not double */
    void *x, *v;
    exact_array omega2, gamma, accel;
    const void *target; /* NULL: springs follow no targets */
    exact_landing landing;
    double t; /* [s] */
} exact_run;

typedef bool exact_kernel(const exact_run *b); /* false: at least one spring has kept its state */

#ifndef SPRING_NO_BATCH
#if SPRING_HAS_V128
SPRING_INTERNAL exact_kernel spring_exact_v128;
#endif
#if SPRING_HAS_V256
SPRING_INTERNAL exact_kernel spring_exact_v256;
#endif
#if SPRING_HAS_V512
SPRING_INTERNAL exact_kernel spring_exact_v512;
#endif
#endif

#endif
