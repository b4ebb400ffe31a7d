/* SPDX-License-Identifier: MIT */
/*
 * External solvers behind one interface: GSL's Runge-Kutta methods, SUNDIALS CVODE and ARKODE, Boost.odeint. For C and
 * C++.
 *
 * Each function integrates the state y from t = 0, in place. It returns NULL on success. Otherwise it returns a
 * message, and y is unspecified.
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
    const double *scale;   /* [size] magnitude of each component; tolerances are relative to it */
    uint64_t evaluations;  /* incremented by every solver below */
    uint64_t steps;        /* accepted steps, likewise */
    double (*clock)(void); /* NULL: time is not measured */
    double spent;          /* time of the integration without setup, by that clock; added up likewise */
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

/* The derivative of y = (x, v) for one spring, with w, g, a each rounded once; `data` is a spring_params */
void ode_spring_derivative(double t, const double *y, double *dy, const void *data);

/* n calls of apply(h), by RK4 and by Prince-Dormand 8(9). An RK4 call is two RK4 steps of h/2 in GSL 2.7. */
const char *ode_gsl_rk4(ode *o, double *y, double h, uint64_t n);
const char *ode_gsl_rk8pd_fixed(ode *o, double *y, double h, uint64_t n);

/* The same with adaptive steps; the local tolerance is relative to scale. */
const char *ode_gsl_rk4_adaptive(ode *o, double *y, double duration, double tolerance);
const char *ode_gsl_rk8pd(ode *o, double *y, double duration, double tolerance);

/* CVODE: variable order, variable step, local tolerance relative to scale, no limit on the number of steps. Adams uses
   fixed-point iteration. BDF uses Newton iteration, with a dense matrix up to a hundred unknowns and GMRES above. */
const char *ode_cvode_adams(ode *o, double *y, double duration, double tolerance);
const char *ode_cvode_bdf(ode *o, double *y, double duration, double tolerance);

/* BDF of order 2 at most, and GMRES with 30 Krylov vectors instead of CVODE's default of 5. */
const char *ode_cvode_bdf2(ode *o, double *y, double duration, double tolerance);

/* ARKODE's ARKStep with the classical Runge-Kutta table and fixed step h. */
const char *ode_arkstep_rk4(ode *o, double *y, double h, uint64_t n);

/* The same with ARKODE's built-in Fehlberg table of order 8, 13 stages. */
const char *ode_arkstep_8(ode *o, double *y, double h, uint64_t n);

/* ARKODE's default explicit method of order 4: adaptive, local tolerance relative to scale, no limit on the number of
   steps. */
const char *ode_arkstep_adaptive(ode *o, double *y, double duration, double tolerance);

/* ARKODE's symplectic partitioned Runge-Kutta method of order 6, with 8 stages, by Yoshida, for accelerations that depend
   on positions only. Only in programs compiled with SPRING_SPRKSTEP, which requires SUNDIALS 6.6 or later. */
const char *ode_sprkstep_6(ode *o, double *y, double h, uint64_t n);

/* Boost.odeint, only in programs compiled with SPRING_ODEINT. n steps of h by Fehlberg's 7(8), 13 evaluations per step,
   or by McLachlan's symplectic method of order 4, 5 evaluations per step, for accelerations that depend on positions
   only. Bulirsch-Stoer uses odeint's own control of order and step; its local tolerance is relative to the largest
   element of scale. */
const char *ode_odeint_rkf78(ode *o, double *y, double h, uint64_t n);
const char *ode_odeint_sb3a_m4(ode *o, double *y, double h, uint64_t n);
const char *ode_odeint_bulirsch_stoer(ode *o, double *y, double duration, double tolerance);

/* Versions of the libraries: "2.7.1". */
const char *ode_gsl_version(void);
const char *ode_sundials_version(void);
const char *ode_odeint_version(void);

/* The time of SUNDIALS' linear sum of vectors, relative to a plain loop compiled with -O3; clock in ns. Negative: out
   of memory. */
double ode_sundials_slowness(double (*clock)(void));

/* At this ratio or above, SUNDIALS is taken to be compiled without optimisation. Measured with gcc 12: 1.0 with -O3,
   about 3 with -O2, which does not vectorise this loop, and 3.9 to 7.6 with -O0. */
#define ODE_UNOPTIMISED 3.5

#endif
