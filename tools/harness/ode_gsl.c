/* SPDX-License-Identifier: MIT */
/* GSL's Runge-Kutta methods; see ode.h. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>
#include <math.h>
#include <stdlib.h>

#include "harness/ode.h"

void ode_spring_derivative(double t, const double *y, double *dy, const void *data)
{
    (void)t;
    const spring_params *p = data;
    dy[0] = y[1];
    dy[1] = p->load / p->mass - p->stiffness / p->mass * y[0] - p->damping / p->mass * y[1];
}

static int gsl_derivative(double t, const double *y, double *dy, void *user)
{
    ode *o = user;
    o->evaluations++;
    o->derivative(t, y, dy, o->data);
    return GSL_SUCCESS;
}

static const char *fixed_steps(const gsl_odeiv2_step_type *type, ode *o, double *y, double h, uint64_t n)
{
    gsl_odeiv2_system system = {gsl_derivative, NULL, o->size, o};
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(type, o->size);
    double *error = calloc(o->size, sizeof *error);
    int status = step != NULL && error != NULL ? GSL_SUCCESS : GSL_ENOMEM;
    ode_start_clock(o);
    for (uint64_t i = 0; i < n && status == GSL_SUCCESS; i++)
        status = gsl_odeiv2_step_apply(step, (double)i * h, h, y, error, NULL, NULL, &system);
    ode_stop_clock(o);
    o->steps += n;
    gsl_odeiv2_step_free(step);
    free(error);
    return status == GSL_SUCCESS ? NULL : gsl_strerror(status);
}

const char *ode_gsl_rk4(ode *o, double *y, double h, uint64_t n)
{
    return fixed_steps(gsl_odeiv2_step_rk4, o, y, h, n);
}

const char *ode_gsl_rk8pd_fixed(ode *o, double *y, double h, uint64_t n)
{
    return fixed_steps(gsl_odeiv2_step_rk8pd, o, y, h, n);
}

static const char *adaptive(const gsl_odeiv2_step_type *type, ode *o, double *y, double duration, double tolerance)
{
    gsl_odeiv2_system system = {gsl_derivative, NULL, o->size, o};
    double t = 0;
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_scaled_new(
        &system, type, copysign(1e-3 * fabs(duration), duration), tolerance, 0, 1, 0, o->scale);
    if (driver == NULL)
        return gsl_strerror(GSL_ENOMEM);
    ode_start_clock(o);
    const int status = gsl_odeiv2_driver_apply(driver, &t, duration, y);
    ode_stop_clock(o);
    o->steps += driver->n;
    gsl_odeiv2_driver_free(driver);
    return status == GSL_SUCCESS ? NULL : gsl_strerror(status);
}

const char *ode_gsl_rk4_adaptive(ode *o, double *y, double duration, double tolerance)
{
    return adaptive(gsl_odeiv2_step_rk4, o, y, duration, tolerance);
}

const char *ode_gsl_rk8pd(ode *o, double *y, double duration, double tolerance)
{
    return adaptive(gsl_odeiv2_step_rk8pd, o, y, duration, tolerance);
}

const char *ode_gsl_version(void)
{
    return gsl_version;
}
