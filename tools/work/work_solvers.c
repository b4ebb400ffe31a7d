/* SPDX-License-Identifier: MIT */
/* The solvers of spring-work; see work.h. */
#include <math.h>
#include <string.h>

#include "harness/stages.h"
#include "work.h"

static const char *adams(ode *o, double *y, double duration, double tolerance)
{
    return ode_cvode(o, y, duration, ODE_ADAMS, tolerance);
}

static const char *bdf(ode *o, double *y, double duration, double tolerance)
{
    return ode_cvode(o, y, duration, ODE_BDF, tolerance);
}

const work_solver work_solvers[] = {
    {.name = "euler", .side = WORK_STEPPER, .method = SPRING_EULER, .a_step = 1},
    {.name = "leapfrog", .side = WORK_STEPPER, .method = SPRING_LEAPFROG, .a_step = 1},
    {.name = "rk4", .side = WORK_STEPPER, .method = SPRING_RK4, .a_step = 4},
    {.name = "rk4-stages", .side = WORK_STAGES, .a_step = 4},
    {.name = "exact", .side = WORK_CLOSED, .method = SPRING_EXACT},
    {.name = "gsl-rk4", .side = WORK_PEER, .fixed = ode_gsl_rk4},
    {.name = "gsl-rk4-adaptive", .side = WORK_PEER, .adaptive = ode_gsl_rk4_adaptive},
    {.name = "gsl-rk8pd", .side = WORK_PEER, .fixed = ode_gsl_rk8pd_fixed},
    {.name = "gsl-rk8pd-adaptive", .side = WORK_PEER, .adaptive = ode_gsl_rk8pd},
    {.name = "arkode-rk4", .side = WORK_PEER, .fixed = ode_arkstep_rk4},
    {.name = "arkode-adaptive", .side = WORK_PEER, .adaptive = ode_arkstep_adaptive},
    {.name = "cvode-adams", .side = WORK_PEER, .adaptive = adams},
    {.name = "cvode-bdf", .side = WORK_PEER, .adaptive = bdf},
};
const size_t work_solver_count = sizeof work_solvers / sizeof work_solvers[0];

bool work_applies(const work *w, const work_solver *s)
{
    if (s->side == WORK_STAGES)
        return w->problem->kind == WORK_SEED;
    if (s->side == WORK_CLOSED)
        return w->problem->kind != WORK_SCENE;
    return s->side == WORK_STEPPER || w->problem->kind != WORK_SEED;
}

/* What a run of a spring takes may be less than a look at the clock: all runs together. */
static work_result run_spring(const work *w, const work_solver *s, uint64_t steps, uint64_t runs, double *y)
{
    const spring_params *p = &w->problem->p;
    const double dt = w->duration / (double)steps;
    spring_state state = w->problem->start;
    spring_status status = SPRING_OK;
    const double begin = w->clock();
    for (uint64_t i = 0; i < runs; i++) {
        state = w->problem->start;
        if (s->side == WORK_STAGES)
            stages_advance(&state, p, dt, steps);
        else
            status = spring_advance(&state, p, s->method, dt, steps);
    }
    const double spent = 1e-9 * (w->clock() - begin); /* [s] */
    y[0] = state.x;
    y[1] = state.v;
    if (status == SPRING_OK && !(isfinite(state.x) && isfinite(state.v)))
        status = SPRING_ENONFINITE;
    return (work_result){.failure = status == SPRING_OK ? NULL : spring_status_string(status),
                         .spent = spent,
                         .steps = steps,
                         .evaluations = steps * s->a_step};
}

static void gather(const work *w, spring_quantity what, double *y)
{
    const scene_problem *p = &w->scene;
    spring_scene_get(w->moved, what, w->gathered, 0, 0, p->def.particles);
    for (size_t i = 0; i < p->moving; i++)
        y[i] = w->gathered[p->coordinate[i]];
}

static work_result run_scene(const work *w, const work_solver *s, uint64_t steps, uint64_t runs, double *y)
{
    work_result r = {.steps = steps};
    for (uint64_t i = 0; i < runs && r.failure == NULL; i++) {
        memcpy(w->moved, w->fresh, w->bytes);
        const double begin = w->clock();
        const spring_status status =
            spring_scene_advance(w->moved, s->method, w->duration / (double)steps, steps);
        r.spent += 1e-9 * (w->clock() - begin);
        if (status != SPRING_OK)
            r.failure = spring_status_string(status);
    }
    gather(w, SPRING_POSITION, y);
    gather(w, SPRING_VELOCITY, y + w->scene.moving);
    return r;
}

static work_result run_peer(const work *w, const work_solver *s, work_effort e, uint64_t runs, double *y)
{
    ode o = {
        .size = w->size, .derivative = w->derivative, .data = w->data, .scale = w->scale, .clock = w->clock};
    const char *failure = NULL;
    for (uint64_t i = 0; i < runs && failure == NULL; i++) {
        memcpy(y, w->start, w->size * sizeof *y);
        o.evaluations = o.steps = 0;
        if (s->fixed != NULL)
            failure = s->fixed(&o, y, w->duration / (double)e.steps, e.steps);
        else
            failure = s->adaptive(&o, y, w->duration, e.tolerance);
    }
    return (work_result){
        .failure = failure, .spent = 1e-9 * o.spent, .steps = o.steps, .evaluations = o.evaluations};
}

work_result work_run(work *w, const work_solver *s, work_effort e, uint64_t runs, double *y)
{
    if (s->side == WORK_PEER)
        return run_peer(w, s, e, runs, y);
    return w->problem->kind == WORK_SCENE ? run_scene(w, s, e.steps, runs, y)
                                          : run_spring(w, s, e.steps, runs, y);
}
