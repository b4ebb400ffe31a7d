/* SPDX-License-Identifier: MIT */
/*
 * The structure of a method for springs.
 *
 * A method has a file in this folder. Its formula is two functions on `real`, which is one number or a SIMD vector of
 * springs: prepare() computes coefficients from the rates of a spring and the step h, step() takes one step with them.
 * The loops around them are take_steps() below and those of kernels/springs_tmpl.h. Two flags, damped and loaded, are
 * constants in every loop, so that a spring without damping or load does not pay for it.
 *
 * The rest of the file is compiled for one spring only: the stable step, the step as a matrix, the entry in the table
 * of methods, and the public one-step function. Steps of scenes are in scene/steppers.c.
 */
#ifndef SPRINGSTEP_METHOD_TMPL_H
#define SPRINGSTEP_METHOD_TMPL_H

#include "../simd/real_tmpl.h"
#include "../spring/rates_tmpl.h"
#include "../spring/roots.h"
#include "implicit_kick_tmpl.h"
#include "step_matrix.h"

/* Coefficients of a step. The prepare() of each method sets those that its step() uses. */
typedef struct step_coefficients {
    real omega2, gamma, accel; /* the rates times the step; leapfrog: times half the step */
    implicit_factors damping;  /* of symplectic Euler and leapfrog */
    real xx, xv, vx, vv;       /* Runge-Kutta methods: correction of x and v, by x and v */
    real x_load, v_load;       /* minus the correction by the load; subtracting 0 changes no bit */
} step_coefficients;

/* kept: in methods with a start(), the force at the end of a step, for the start of the next step. */
typedef void method_prepare(step_coefficients *c, spring_rates r, real h, bool damped, bool loaded);
typedef real method_start(real x, const step_coefficients *c, bool loaded);
typedef void method_step(real *x, real *v, real *kept, real h, const step_coefficients *c, bool damped, bool loaded);

/* The start() of methods that do not keep a force. */
SPRING_INLINE real keeps_nothing(real x, const step_coefficients *c, bool loaded)
{
    (void)x;
    (void)c;
    (void)loaded;
    return splat(0);
}

/* Calls function(..., damped, loaded) with constant flags, so that the loops of the function have no branches. */
#define SPRING_BY_FEATURES(damped, loaded, function, ...)         \
    (!(damped) && !(loaded) ? function(__VA_ARGS__, false, false) \
     : !(damped)            ? function(__VA_ARGS__, false, true)  \
     : !(loaded)            ? function(__VA_ARGS__, true, false)  \
                            : function(__VA_ARGS__, true, true))

#ifndef SPRING_VECTOR
typedef struct method_row {
    const spring_method_info *info;
    spring_step_fn *kernel;                       /* NULL: not for springs */
    double (*stable_step)(const spring_roots *r); /* [s] */
    step_terms_fn *terms;                         /* NULL: the error of a step is rounding error only */
    uint64_t digest;                              /* see spring/self_test.c */
} method_row;

/* n steps of one spring. */
SPRING_INLINE spring_state take_steps(spring_state s, const spring_rates *r, double dt, uint64_t n,
                                      method_prepare *prepare, method_start *start, method_step *step, bool damped,
                                      bool loaded)
{
    step_coefficients c;
    prepare(&c, *r, dt, damped, loaded);
    real kept = start(s.x, &c, loaded);
    for (; n > 0; n--)
        step(&s.x, &s.v, &kept, dt, &c, damped, loaded);
    return s;
}

SPRING_INLINE void take_one_step(spring_state *s, const spring_params *p, double dt, method_prepare *prepare,
                                 method_start *start, method_step *step)
{
    const spring_rates r = spring_rates_of(p);
    *s = SPRING_BY_FEATURES(r.gamma != 0, r.accel != 0, take_steps, *s, &r, dt, 1, prepare, start, step);
}
#endif

#endif
