/* SPDX-License-Identifier: MIT */
/* SUNDIALS CVODE and ARKODE, 6.4 to 7.x; see ode.h. */
#include <arkode/arkode_arkstep.h>
#ifdef SPRING_SPRKSTEP
#include <arkode/arkode_sprkstep.h>
#endif
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "harness/ode.h"
#include "harness/plain_sum.h"

/* Uses the names of version 7.1, in which the older names are deprecated. */
#if SUNDIALS_VERSION_MAJOR < 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR < 1)
#define ARKodeEvolve         ARKStepEvolve
#define ARKodeFree           ARKStepFree
#define ARKodeGetNumSteps    ARKStepGetNumSteps
#define ARKodeSVtolerances   ARKStepSVtolerances
#define ARKodeSetFixedStep   ARKStepSetFixedStep
#define ARKodeSetMaxNumSteps ARKStepSetMaxNumSteps
#define ARKodeSetOrder       ARKStepSetOrder
#define ARKodeSetStopTime    ARKStepSetStopTime
#define ARKodeSetUserData    ARKStepSetUserData
#elif defined(SPRING_SPRKSTEP)
#define SPRKStepEvolve       ARKodeEvolve
#define SPRKStepFree         ARKodeFree
#define SPRKStepSetFixedStep ARKodeSetFixedStep
#define SPRKStepSetOrder     ARKodeSetOrder
#define SPRKStepSetUserData  ARKodeSetUserData
#endif

/* Errors are returned, not printed. Since 7.0 this is a setting of the context, before of each solver. */
#if SUNDIALS_VERSION_MAJOR >= 7
#define CVodeSetErrFile(memory, file)   ((void)0)
#define ARKStepSetErrFile(memory, file) ((void)0)
#else
#define SUN_COMM_NULL                        NULL
#define SUNContext_ClearErrHandlers(context) ((void)0)
#endif

static int derivative(sunrealtype t, N_Vector y, N_Vector dy, void *user)
{
    ode *o = user;
    o->evaluations++;
    o->derivative(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy), o->data);
    return 0;
}

/* The resources of an integration, freed in one place. */
typedef struct session {
    SUNContext context;
    N_Vector y, tolerance;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver nonlinear;
    void *memory;
} session;

static const char *open_session(session *s, const ode *o, double *y, double tolerance)
{
    *s = (session){0};
    if (SUNContext_Create(SUN_COMM_NULL, &s->context) != 0)
        return "SUNDIALS: no context";
    SUNContext_ClearErrHandlers(s->context);
    s->y = N_VMake_Serial((sunindextype)o->size, y, s->context);
    s->tolerance = N_VNew_Serial((sunindextype)o->size, s->context);
    if (s->y == NULL || s->tolerance == NULL)
        return "SUNDIALS: no vector";
    for (size_t i = 0; i < o->size; i++)
        N_VGetArrayPointer(s->tolerance)[i] = tolerance * o->scale[i];
    return NULL;
}

static void close_session(session *s)
{
    if (s->nonlinear != NULL)
        SUNNonlinSolFree(s->nonlinear);
    if (s->linear != NULL)
        SUNLinSolFree(s->linear);
    if (s->matrix != NULL)
        SUNMatDestroy(s->matrix);
    if (s->y != NULL)
        N_VDestroy(s->y);
    if (s->tolerance != NULL)
        N_VDestroy(s->tolerance);
    if (s->context != NULL)
        SUNContext_Free(&s->context);
}

/* For larger systems, CVODE's manual recommends sparse or iterative solvers: a dense matrix costs size^3 operations. */
static const size_t dense_at_most = 100;

static const char *set_up_cvode(session *s, ode *o, double duration, int method, int order, double tolerance)
{
    s->memory = CVodeCreate(method, s->context);
    if (s->memory == NULL || CVodeInit(s->memory, derivative, 0, s->y) != CV_SUCCESS)
        return "CVODE: cannot start";
    CVodeSetErrFile(s->memory, NULL);
    if (CVodeSVtolerances(s->memory, tolerance, s->tolerance) != CV_SUCCESS ||
        CVodeSetUserData(s->memory, o) != CV_SUCCESS || CVodeSetMaxNumSteps(s->memory, -1) != CV_SUCCESS ||
        CVodeSetStopTime(s->memory, duration) != CV_SUCCESS)
        return "CVODE: refuses its settings";
    if (order > 0 && CVodeSetMaxOrd(s->memory, order) != CV_SUCCESS)
        return "CVODE: refuses its order";
    if (method == CV_ADAMS) {
        s->nonlinear = SUNNonlinSol_FixedPoint(s->y, 0, s->context);
        if (s->nonlinear == NULL || CVodeSetNonlinearSolver(s->memory, s->nonlinear) != CV_SUCCESS)
            return "CVODE: no fixed-point solver";
    } else if (o->size > dense_at_most) {
        s->linear = SUNLinSol_SPGMR(s->y, SUN_PREC_NONE, order > 0 ? 30 : 0, s->context);
        if (s->linear == NULL || CVodeSetLinearSolver(s->memory, s->linear, NULL) != CV_SUCCESS)
            return "CVODE: no iterative solver";
    } else {
        s->matrix = SUNDenseMatrix((sunindextype)o->size, (sunindextype)o->size, s->context);
        s->linear = s->matrix != NULL ? SUNLinSol_Dense(s->y, s->matrix, s->context) : NULL;
        if (s->linear == NULL || CVodeSetLinearSolver(s->memory, s->linear, s->matrix) != CV_SUCCESS)
            return "CVODE: no dense solver";
    }
    return NULL;
}

static const char *cvode(ode *o, double *y, double duration, int method, int order, double tolerance)
{
    session s;
    const char *message = open_session(&s, o, y, tolerance);
    if (message == NULL)
        message = set_up_cvode(&s, o, duration, method, order, tolerance);
    double reached = 0;
    long steps = 0;
    ode_start_clock(o);
    if (message == NULL && CVode(s.memory, duration, s.y, &reached, CV_NORMAL) < 0)
        message = "CVODE: the integration failed";
    ode_stop_clock(o);
    if (message == NULL && CVodeGetNumSteps(s.memory, &steps) == CV_SUCCESS)
        o->steps += (uint64_t)steps;
    if (s.memory != NULL)
        CVodeFree(&s.memory);
    close_session(&s);
    return message;
}

const char *ode_cvode_adams(ode *o, double *y, double duration, double tolerance)
{
    return cvode(o, y, duration, CV_ADAMS, 0, tolerance);
}

const char *ode_cvode_bdf(ode *o, double *y, double duration, double tolerance)
{
    return cvode(o, y, duration, CV_BDF, 0, tolerance);
}

const char *ode_cvode_bdf2(ode *o, double *y, double duration, double tolerance)
{
    return cvode(o, y, duration, CV_BDF, 2, tolerance);
}

static ARKodeButcherTable classical_table(void)
{
    sunrealtype c[] = {0, 0.5, 0.5, 1};
    sunrealtype A[] = {0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0};
    sunrealtype b[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    return ARKodeButcherTable_Create(4, 4, 0, c, A, b, NULL);
}

/* ARKodeEvolve(), or its older name in a module of ARKODE. */
typedef int evolve_function(void *memory, sunrealtype end, N_Vector y, sunrealtype *t, int task);

/* Takes n steps of exactly h, one at a time, without ARKODE's error control. Returns false if one fails. */
static bool take_steps(session *s, ode *o, evolve_function *evolve, double h, uint64_t n)
{
    sunrealtype t = 0;
    bool taken = true;
    ode_start_clock(o);
    for (uint64_t i = 0; i < n && taken; i++)
        taken = evolve(s->memory, h * (double)n, s->y, &t, ARK_ONE_STEP) >= 0;
    ode_stop_clock(o);
    o->steps += n;
    return taken;
}

static bool set_up_arkstep(session *s, ode *o, double h, double end, double tolerance, int order,
                           ARKodeButcherTable table)
{
    s->memory = ARKStepCreate(derivative, NULL, 0, s->y, s->context);
    if (s->memory == NULL)
        return false;
    ARKStepSetErrFile(s->memory, NULL);
    if (ARKodeSetUserData(s->memory, o) != ARK_SUCCESS)
        return false;
    if (h != 0)
        return table != NULL && ARKStepSetTables(s->memory, order, 0, NULL, table) == ARK_SUCCESS &&
               ARKodeSetFixedStep(s->memory, h) == ARK_SUCCESS;
    return ARKodeSetOrder(s->memory, order) == ARK_SUCCESS &&
           ARKodeSVtolerances(s->memory, tolerance, s->tolerance) == ARK_SUCCESS &&
           ARKodeSetMaxNumSteps(s->memory, -1) == ARK_SUCCESS && ARKodeSetStopTime(s->memory, end) == ARK_SUCCESS;
}

/* Takes n steps of h by a table, which it frees, or without a table adaptive steps to the end. */
static const char *arkstep(ode *o, double *y, double h, uint64_t n, double end, double tolerance, int order,
                           ARKodeButcherTable table)
{
    session s;
    const char *message = open_session(&s, o, y, tolerance);
    double t = 0;
    long steps = 0;
    if (message == NULL && !set_up_arkstep(&s, o, h, end, tolerance, order, table))
        message = "ARKStep: cannot start";
    if (message == NULL && h != 0 && !take_steps(&s, o, ARKodeEvolve, h, n))
        message = "ARKStep: the integration failed";
    if (message == NULL && h == 0) {
        ode_start_clock(o);
        if (ARKodeEvolve(s.memory, end, s.y, &t, ARK_NORMAL) < 0)
            message = "ARKStep: the integration failed";
        ode_stop_clock(o);
        if (message == NULL && ARKodeGetNumSteps(s.memory, &steps) == ARK_SUCCESS)
            o->steps += (uint64_t)steps;
    }
    if (s.memory != NULL)
        ARKodeFree(&s.memory);
    ARKodeButcherTable_Free(table);
    close_session(&s);
    return message;
}

const char *ode_arkstep_rk4(ode *o, double *y, double h, uint64_t n)
{
    return arkstep(o, y, h, n, 0, 1, 4, classical_table());
}

const char *ode_arkstep_8(ode *o, double *y, double h, uint64_t n)
{
    return arkstep(o, y, h, n, 0, 1, 8, ARKodeButcherTable_LoadERK(ARKODE_FEHLBERG_13_7_8));
}

const char *ode_arkstep_adaptive(ode *o, double *y, double duration, double tolerance)
{
    return arkstep(o, y, 0, 0, duration, tolerance, 4, NULL);
}

#ifdef SPRING_SPRKSTEP
/* The state is (x, v). Both functions set the other half of dy to 0. */
static int accelerations(sunrealtype t, N_Vector y, N_Vector dy, void *user)
{
    const ode *o = user;
    derivative(t, y, dy, user);
    memset(N_VGetArrayPointer(dy), 0, o->size / 2 * sizeof(sunrealtype));
    return 0;
}

static int velocities(sunrealtype t, N_Vector y, N_Vector dy, void *user)
{
    const ode *o = user;
    const size_t half = o->size / 2;
    sunrealtype *const out = N_VGetArrayPointer(dy);
    (void)t;
    memcpy(out, N_VGetArrayPointer(y) + half, half * sizeof *out);
    memset(out + half, 0, half * sizeof *out);
    return 0;
}

const char *ode_sprkstep_6(ode *o, double *y, double h, uint64_t n)
{
    session s;
    const char *message = open_session(&s, o, y, 1);
    if (message == NULL) {
        s.memory = SPRKStepCreate(accelerations, velocities, 0, s.y, s.context);
        if (s.memory == NULL || SPRKStepSetUserData(s.memory, o) != ARK_SUCCESS ||
            SPRKStepSetOrder(s.memory, 6) != ARK_SUCCESS || SPRKStepSetFixedStep(s.memory, h) != ARK_SUCCESS)
            message = "SPRKStep: cannot start";
    }
    if (message == NULL && !take_steps(&s, o, SPRKStepEvolve, h, n))
        message = "SPRKStep: the integration failed";
    if (s.memory != NULL)
        SPRKStepFree(&s.memory);
    close_session(&s);
    return message;
}
#endif

const char *ode_sundials_version(void)
{
    static char version[32];
    return SUNDIALSGetVersion(version, sizeof version) == 0 ? version : "unknown";
}

/* Uses the minimum of several times, because other processes can only make them longer. */
static double sum_ratio(double (*clock)(void), N_Vector x, N_Vector y, N_Vector z)
{
    const int samples = 20, sums = 50;
    const size_t n = (size_t)N_VGetLength(x);
    const double a = 0.7, b = -1.3; /* 1 and -1 have special loops */
    double theirs = INFINITY, plain = INFINITY;
    for (int i = 0; i < samples; i++) {
        const double begin = clock();
        for (int k = 0; k < sums; k++)
            N_VLinearSum(a, x, b, y, z);
        const double between = clock();
        for (int k = 0; k < sums; k++)
            plain_sum(n, a, N_VGetArrayPointer(x), b, N_VGetArrayPointer(y), N_VGetArrayPointer(z));
        theirs = fmin(theirs, between - begin);
        plain = fmin(plain, clock() - between);
    }
    return theirs / plain;
}

double ode_sundials_slowness(double (*clock)(void))
{
    double room[1000], ratio = -1;
    const ode o = {.size = sizeof room / sizeof room[0], .scale = room};
    session s;
    for (size_t i = 0; i < o.size; i++)
        room[i] = 1 + (double)i;
    if (open_session(&s, &o, room, 1) == NULL) {
        N_Vector sum = N_VClone(s.y);
        if (sum != NULL) {
            ratio = sum_ratio(clock, s.y, s.tolerance, sum);
            N_VDestroy(sum);
        }
    }
    close_session(&s);
    return ratio;
}
