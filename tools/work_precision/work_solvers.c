/* SPDX-License-Identifier: MIT */
/* The solvers of spring-work; see work.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/stepper.h"
#include "scenes/start.h"
#include "work.h"

static const work_solver stages = {.name = "rk4-stages", .side = WORK_STAGES, .a_step = 4};
static const work_solver softened = {.name = "leapfrog-softened", .side = WORK_SOFTENED, .method = SPRING_LEAPFROG};
static const work_solver xpbd = {.name = "xpbd", .side = WORK_XPBD, .a_step = 1};

static const work_solver implicit[] = {
    {.name = "bdf2-cg", .side = WORK_IMPLICIT, .implicit = work_bdf2_advance, .order = 2},
    {.name = "projective", .side = WORK_IMPLICIT, .implicit = work_projective_advance, .order = 1},
};
enum { IMPLICITS = sizeof implicit / sizeof implicit[0] };

static const work_solver external[] = {
    {.name = "gsl-rk4", .side = WORK_EXTERNAL, .fixed = ode_gsl_rk4, .order = 4},
    {.name = "gsl-rk4-adaptive", .side = WORK_EXTERNAL, .adaptive = ode_gsl_rk4_adaptive},
    {.name = "gsl-rk8pd", .side = WORK_EXTERNAL, .fixed = ode_gsl_rk8pd_fixed, .order = 8},
    {.name = "gsl-rk8pd-adaptive", .side = WORK_EXTERNAL, .adaptive = ode_gsl_rk8pd},
    {.name = "arkode-rk4", .side = WORK_EXTERNAL, .fixed = ode_arkstep_rk4, .order = 4},
    {.name = "arkode-8", .side = WORK_EXTERNAL, .fixed = ode_arkstep_8, .order = 8},
    {.name = "arkode-adaptive", .side = WORK_EXTERNAL, .adaptive = ode_arkstep_adaptive},
#ifdef SPRING_SPRKSTEP
    {.name = "arkode-sprk6", .side = WORK_EXTERNAL, .fixed = ode_sprkstep_6, .positions_only = true, .order = 6},
#endif
    {.name = "cvode-adams", .side = WORK_EXTERNAL, .adaptive = ode_cvode_adams},
    {.name = "cvode-bdf2", .side = WORK_EXTERNAL, .adaptive = ode_cvode_bdf2},
    {.name = "cvode-bdf", .side = WORK_EXTERNAL, .adaptive = ode_cvode_bdf},
#ifdef SPRING_ODEINT
    {.name = "odeint-rkf78", .side = WORK_EXTERNAL, .fixed = ode_odeint_rkf78, .order = 8},
    {.name = "odeint-bulirsch-stoer", .side = WORK_EXTERNAL, .adaptive = ode_odeint_bulirsch_stoer},
    {.name = "odeint-sb3a-m4", .side = WORK_EXTERNAL, .fixed = ode_odeint_sb3a_m4, .positions_only = true, .order = 4},
#endif
};

const size_t work_solver_count = SPRING_METHOD_COUNT + 3 + IMPLICITS + sizeof external / sizeof external[0];

const work_solver *work_solver_of(spring_method m)
{
    static work_solver methods[SPRING_METHOD_COUNT];
    const spring_method_info *info = spring_method_describe(m);
    methods[m] = (work_solver){.name = info->name,
                               .side = info->order > 0 ? WORK_STEPPER : WORK_EXACT,
                               .method = m,
                               .a_step = (uint64_t)info->forces_per_step};
    return &methods[m];
}

const work_solver *work_solver_at(size_t i)
{
    if (i < SPRING_METHOD_COUNT)
        return work_solver_of(spring_method_at((int)i));
    const size_t other = i - SPRING_METHOD_COUNT;
    if (other < 3)
        return other == 0 ? &stages : other == 1 ? &softened : &xpbd;
    return other - 3 < IMPLICITS ? &implicit[other - 3] : &external[other - 3 - IMPLICITS];
}

bool work_applies(const work *w, const work_solver *s)
{
    const bool scene = w->problem->kind == WORK_SCENE, study = w->problem->kind == WORK_STUDY;
    if (s->side == WORK_STAGES)
        return study;
    if (s->side == WORK_EXTERNAL)
        return !study && !(s->positions_only && w->uses_velocity);
    if (s->side == WORK_IMPLICIT)
        return w->implicit != NULL && !(s->implicit == work_projective_advance && w->damped);
    if (s->side == WORK_XPBD || s->side == WORK_SOFTENED)
        return w->xpbd != NULL;
    return scene ? (w->scene.def.methods >> s->method & 1) != 0 : spring_method_describe(s->method)->springs;
}

/* Times all runs together, since one run can be shorter than a call of the clock. */
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

static void gather(const work *w, const spring_scene *scene, spring_quantity what, double *y)
{
    const scene_problem *p = &w->scene;
    spring_scene_get(scene, what, w->gathered, 0, 0, p->def.particles);
    for (size_t i = 0; i < p->moving; i++)
        y[i] = w->gathered[p->coordinate[i]];
}

void work_get(const work *w, const spring_scene *scene, double *y)
{
    gather(w, scene, SPRING_POSITION, y);
    gather(w, scene, SPRING_VELOCITY, y + w->scene.moving);
}

/* Each run copies the initial scene `fresh` to `moved`. */
static work_result run_scene_of(const work *w, spring_scene *moved, const spring_scene *fresh, size_t bytes,
                                spring_method m, uint64_t steps, uint64_t runs, double *y)
{
    work_result r = {.steps = steps};
    for (uint64_t i = 0; i < runs && r.failure == NULL; i++) {
        memcpy(moved, fresh, bytes);
        const double begin = w->clock();
        const spring_status status = spring_scene_advance(moved, m, w->duration / (double)steps, steps);
        r.spent += 1e-9 * (w->clock() - begin);
        if (status != SPRING_OK)
            r.failure = spring_status_string(status);
    }
    work_get(w, moved, y);
    return r;
}

static work_result run_scene(const work *w, const work_solver *s, uint64_t steps, uint64_t runs, double *y)
{
    return run_scene_of(w, w->moved, w->fresh, w->bytes, s->method, steps, runs, y);
}

static work_result run_softened(const work *w, const work_solver *s, uint64_t steps, uint64_t runs, double *y)
{
    const double fraction = 0.95; /* of the stable step; runs are too short for resonances */
    spring_scene_def def = w->scene.def;
    spring_link *link = scene_room(def.links, sizeof *link);
    size_t bytes;
    work_result r = {.failure = "links cannot be softened"};
    if (spring_links_soften(&def, w->duration / (double)steps, fraction, link) == SPRING_OK) {
        def.link = link;
        spring_scene *fresh = start_definition(&def, &bytes), *moved = start_definition(&def, &bytes);
        r = run_scene_of(w, moved, fresh, bytes, s->method, steps, runs, y);
        r.evaluations =
            w->damped ? steps : steps + 1; /* as counted by work_count(): heavily damped, no force is kept */
        free(fresh);
        free(moved);
    }
    free(link);
    return r;
}

static work_result run_xpbd(const work *w, const work_solver *s, uint64_t steps, uint64_t runs, double *y)
{
    work_result r = {.steps = steps, .evaluations = steps * s->a_step};
    for (uint64_t i = 0; i < runs; i++) {
        work_xpbd_start(w->xpbd, &w->scene, w->duration / (double)steps);
        const double begin = w->clock();
        work_xpbd_advance(w->xpbd, steps);
        r.spent += 1e-9 * (w->clock() - begin);
    }
    work_xpbd_get(w->xpbd, &w->scene, y);
    return r;
}

static work_result run_implicit(const work *w, const work_solver *s, uint64_t steps, uint64_t runs, double *y)
{
    work_result r = {.steps = steps};
    for (uint64_t i = 0; i < runs; i++) {
        work_implicit_start(w->implicit, &w->scene, w->duration / (double)steps,
                            s->implicit == work_projective_advance);
        const double begin = w->clock();
        r.evaluations = s->implicit(w->implicit, steps);
        r.spent += 1e-9 * (w->clock() - begin);
    }
    work_implicit_get(w->implicit, &w->scene, y);
    return r;
}

static work_result run_external(const work *w, const work_solver *s, work_effort e, uint64_t runs, double *y)
{
    ode o = {.size = w->size, .derivative = w->derivative, .data = w->data, .scale = w->scale, .clock = w->clock};
    const char *failure = NULL;
    for (uint64_t i = 0; i < runs && failure == NULL; i++) {
        memcpy(y, w->start, w->size * sizeof *y);
        o.evaluations = o.steps = 0;
        if (s->fixed != NULL)
            failure = s->fixed(&o, y, w->duration / (double)e.steps, e.steps);
        else
            failure = s->adaptive(&o, y, w->duration, e.tolerance);
    }
    return (work_result){.failure = failure, .spent = 1e-9 * o.spent, .steps = o.steps, .evaluations = o.evaluations};
}

work_result work_run(work *w, const work_solver *s, work_effort e, uint64_t runs, double *y)
{
    if (s->side == WORK_EXTERNAL)
        return run_external(w, s, e, runs, y);
    if (s->side == WORK_SOFTENED)
        return run_softened(w, s, e.steps, runs, y);
    if (s->side == WORK_XPBD)
        return run_xpbd(w, s, e.steps, runs, y);
    if (s->side == WORK_IMPLICIT)
        return run_implicit(w, s, e.steps, runs, y);
    return w->problem->kind == WORK_SCENE ? run_scene(w, s, e.steps, runs, y) : run_spring(w, s, e.steps, runs, y);
}
