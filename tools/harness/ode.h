/* SPDX-License-Identifier: MIT */
/*
 * External solvers behind one small interface: GSL's Runge-Kutta methods, SUNDIALS CVODE and ARKODE, Boost.odeint. C and C++.
 *
 * Each takes the state y at t = 0 to its end in place. NULL means done; anything else is a message, and y is
 * unspecified.
 */
#ifndef HARNESS_ODE_H
#define HARNESS_ODE_H

#include <stddef.h>
#include <stdint.h>

#include <springstep/spring.h>

typedef struct ode {
    size_t size;
    void (*derivative)(double t, const double *y, double *dy, const void *data);
    const void *data;
    const double *scale;   /* [size] the magnitude of each component: tolerances are relative to it */
    uint64_t evaluations;  /* counted by every solver below */
    uint64_t steps;        /* counted likewise: those that were not rejected */
    double (*clock)(void); /* NULL: time is of no interest */
    double spent;          /* by that clock, added up by every solver below: without setting up */
} ode;

static inline void ode_start_clock(ode *o)
{
    if (o->clock != NULL)
        o->spent -= o->clock();
}

static inline void ode_stop_clock(ode *o)
{
    if (o->clock != NULL)
        o->spent += o->clock();
}

/* y = (x, v) of one spring, from w, g, a each rounded once; data is a spring_params */
void ode_spring_derivative(double t, const double *y, double *dy, const void *data);

/* n calls of apply(h). Each is two RK4 steps of h/2 in GSL 2.7, which doubles its step, and Prince-Dormand 8(9). */
const char *ode_gsl_rk4(ode *o, double *y, double h, uint64_t n);
const char *ode_gsl_rk8pd_fixed(ode *o, double *y, double h, uint64_t n);

/* The same, adaptive, local tolerance relative to scale. */
const char *ode_gsl_rk4_adaptive(ode *o, double *y, double duration, double tolerance);
const char *ode_gsl_rk8pd(ode *o, double *y, double duration, double tolerance);

/* CVODE: variable order, variable step, local tolerance relative to scale; no limit on the number of steps. Adams with
   fixed-point iteration; BDF with Newton's, by a dense matrix, of more than a hundred unknowns by none: GMRES. */
const char *ode_cvode_adams(ode *o, double *y, double duration, double tolerance);
const char *ode_cvode_bdf(ode *o, double *y, double duration, double tolerance);

/* ARKODE with the classical Runge-Kutta table and fixed step h, as ARKStep. */
const char *ode_arkstep_rk4(ode *o, double *y, double h, uint64_t n);

/* The same with Fehlberg's table of order 8, 13 stages, that comes with ARKODE. */
const char *ode_arkstep_8(ode *o, double *y, double h, uint64_t n);

/* ARKODE's own explicit method of order 4, adaptive, local tolerance relative to scale; no limit on the number of
   steps. */
const char *ode_arkstep_adaptive(ode *o, double *y, double duration, double tolerance);

/* Boost.odeint, which is optional: programs that are compiled with SPRING_ODEINT have it. n steps of h of Fehlberg's 7(8),
   which evaluates 13 times a step, and of the symplectic method of order 4 by McLachlan, which evaluates 5 times and requires
   that accelerations depend on positions alone. Bulirsch-Stoer with odeint's own control of order and step, whose local
   tolerance is relative to the largest of scale. */
const char *ode_odeint_rkf78(ode *o, double *y, double h, uint64_t n);
const char *ode_odeint_sb3a_m4(ode *o, double *y, double h, uint64_t n);
const char *ode_odeint_bulirsch_stoer(ode *o, double *y, double duration, double tolerance);

/* The versions that were found: "2.7.1". */
const char *ode_gsl_version(void);
const char *ode_sundials_version(void);
const char *ode_odeint_version(void);

/* The time that SUNDIALS' linear sum of vectors takes, relative to a plain loop that is compiled with -O3; clock in ns.
   Negative: no memory. */
double ode_sundials_slowness(double (*clock)(void));

/* From that ratio on SUNDIALS counts as compiled without optimisation. Measured with gcc 12: 1.0 with -O3, about 3 with -O2,
   which does not vectorise this loop, and 5.3 to 7.6 with -O0. */
#define ODE_UNOPTIMISED 4

/* The same as ERKStep, before SUNDIALS 6.7.0 only, for the test that knows its error: it treats the table as
   first-same-as-last from the second step on. */
const char *ode_erkstep_rk4(ode *o, double *y, double h, uint64_t n);

#endif
