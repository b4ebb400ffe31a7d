/* SPDX-License-Identifier: MIT */
/*
 * Long runs of the stiff scenes without damping, for spring-work --long. Their motion is chaotic, so positions are
 * compared for two seconds only, with the reference method of work_problems.c. For the rest of a run, the table has
 * means that every accurate method agrees on.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/timing.h"
#include "scenes/start.h"
#include "work.h"

static const double frames = 60; /* [1/s] */
enum { PARTS_PER_S = 10, FRAMES_PER_PART = 6, COMPARED = 3, MOST_STEPS = 64 };
static const int compared[COMPARED] = {5, 10, 20};           /* parts after which errors are measured */
static const double softened = 0.95, longest_adaptive = 0.5; /* of the stable step; [s] for a part of a run */
static const double exploded = 100;                          /* times the energy that gravity released */

typedef struct observed { /* sums over the second half of a run */
    double sag, stretch, stretch_99, fall, start_energy, end_energy, error[COMPARED];
    int parts;
} observed;

/* A solver that can be stopped and continued. */
typedef struct runner {
    const work_solver *solver;
    spring_scene *scene; /* of a stepper */
    double dt;
    work_effort effort;
} runner;

static int by_size(const void *left, const void *right)
{
    const double l = *(const double *)left, r = *(const double *)right;
    return l < r ? -1 : l > r;
}

static bool start(work *w, runner *r, double *y)
{
    const work_side side = r->solver->side;
    if (side == WORK_XPBD)
        work_xpbd_start(w->xpbd, &w->scene, r->dt);
    else if (side == WORK_IMPLICIT)
        work_implicit_start(w->implicit, &w->scene, r->dt, r->solver->implicit == work_projective_advance);
    else if (side == WORK_EXTERNAL)
        memcpy(y, w->start, w->size * sizeof *y);
    else {
        spring_scene_def def = w->scene.def;
        spring_link *link = scene_room(def.links, sizeof *link);
        const bool soft = side == WORK_SOFTENED && spring_links_soften(&def, r->dt, softened, link) == SPRING_OK;
        if (soft)
            def.link = link;
        r->scene = start_definition(&def, NULL);
        free(link);
        return side == WORK_STEPPER || soft;
    }
    return true;
}

/* Advances by one part of a run. */
static bool advance(work *w, runner *r, double *y)
{
    const work_solver *s = r->solver;
    const uint64_t n = FRAMES_PER_PART * r->effort.steps;
    bool done = true;
    if (s->side == WORK_XPBD) {
        work_xpbd_advance(w->xpbd, n);
        work_xpbd_get(w->xpbd, &w->scene, y);
    } else if (s->side == WORK_IMPLICIT) {
        s->implicit(w->implicit, n);
        work_implicit_get(w->implicit, &w->scene, y);
    } else if (s->side == WORK_EXTERNAL) {
        ode o = {.size = w->size, .derivative = w->derivative, .data = w->data, .scale = w->scale};
        done = (s->fixed != NULL ? s->fixed(&o, y, r->dt, n)
                                 : s->adaptive(&o, y, 1.0 / PARTS_PER_S, r->effort.tolerance)) == NULL;
    } else {
        done = spring_scene_advance(r->scene, s->method, r->dt, n) == SPRING_OK;
        work_get(w, r->scene, y);
    }
    for (size_t i = 0; i < w->size; i++)
        done = done && isfinite(y[i]);
    return done;
}

static void observe(work *w, const double *y, double *stretch, observed *o)
{
    const size_t links = w->scene.def.links;
    double lowest = 0, fallen = 0;
    for (size_t i = 0; i < w->scene.moving; i++)
        if (w->scene.coordinate[i] % 3 == 2) {
            const double mass = w->scene.mass[w->scene.coordinate[i] / 3];
            lowest = fmin(lowest, y[i]);
            fallen += mass * w->scene.def.gravity[2] * y[i]; /* both negative */
        }
    work_stretches(w, y, stretch);
    qsort(stretch, links, sizeof *stretch, by_size);
    o->sag -= lowest;
    o->fall += fallen;
    o->stretch += stretch[links - 1];
    o->stretch_99 += stretch[links * 99 / 100];
    o->parts++;
}

/* Runs a solver for `parts`. Returns the time [s], or NaN if it failed. */
static double run(work *w, runner *r, int parts, double *const at[COMPARED], observed *o)
{
    double *y = scene_room(w->size, sizeof *y), *stretch = scene_room(w->scene.def.links, sizeof *stretch), spent = 0;
    const double longest = r->solver->adaptive != NULL ? longest_adaptive : INFINITY;
    bool runs = start(w, r, y);
    *o = (observed){.start_energy = work_energy(w, w->start)};
    for (int i = 1; i <= parts && runs; i++) {
        const double begin = timing_busy();
        runs = advance(w, r, y);
        const double part = 1e-9 * (timing_busy() - begin);
        spent += part;
        runs = runs && part <= longest;
        for (int k = 0; k < COMPARED && runs; k++)
            if (i == compared[k])
                o->error[k] = work_distance(w, y, at[k]) / w->motion;
        if (i > parts / 2 && runs)
            observe(w, y, stretch, o);
    }
    o->end_energy = work_energy(w, y);
    free(r->scene);
    free(stretch);
    free(y);
    return runs ? spent : NAN;
}

static void row(cli_table *table, work *w, runner r, int parts, double *const at[COMPARED])
{
    observed o;
    const double spent = run(w, &r, parts, at, &o), n = o.parts;
    if (isnan(spent) || !(fabs(o.end_energy - o.start_energy) <= exploded * o.fall / n))
        return;
    cli_row(table, "%s\t%s\t%" PRIu64 "\t%.4g\t%g\t%.4g\t%.3g\t%.3g\t%.3g\t%.4g\t%.4g\t%.4g\t%.4g", w->problem->name,
            r.solver->name, r.effort.steps, r.effort.tolerance, (double)parts / PARTS_PER_S,
            spent / (parts * FRAMES_PER_PART), o.error[0], o.error[1], o.error[2], o.sag / n, o.stretch / n,
            o.stretch_99 / n, (o.end_energy - o.start_energy) / (o.fall / n));
}

/* The states by the reference method, at the times that are compared. */
static void refer(const work *w, uint64_t steps_per_s, double *const at[COMPARED])
{
    ode o = {.size = w->size, .derivative = w->derivative, .data = w->data, .scale = w->scale};
    double *y = scene_room(w->size, sizeof *y);
    memcpy(y, w->start, w->size * sizeof *y);
    for (int k = 0, from = 0; k < COMPARED; from = compared[k++]) {
        const uint64_t n = (uint64_t)(compared[k] - from) * steps_per_s / PARTS_PER_S;
        const char *message = ode_gsl_rk8pd_fixed(&o, y, 1.0 / (double)steps_per_s, n);
        if (message != NULL)
            cli_fail(CLI_FAILED, "%s: no reference: %s", w->problem->name, message);
        memcpy(at[k], y, w->size * sizeof *y);
    }
    free(y);
}

static void write_reference(cli_table *table, const work *w, uint64_t steps_per_s, double *const at[COMPARED])
{
    double *coarse[COMPARED], error[COMPARED];
    for (int k = 0; k < COMPARED; k++)
        coarse[k] = scene_room(w->size, sizeof *coarse[k]);
    refer(w, steps_per_s / 2, coarse);
    for (int k = 0; k < COMPARED; k++) {
        error[k] = work_distance(w, coarse[k], at[k]) / w->motion;
        free(coarse[k]);
    }
    cli_row(table, "%s\treference\tnan\tnan\t%g\tnan\t%.3g\t%.3g\t%.3g\tnan\tnan\tnan\tnan", w->problem->name,
            (double)compared[COMPARED - 1] / PARTS_PER_S, error[0], error[1], error[2]);
}

void work_long(cli_table *table, work *w, bool quick)
{
    const int parts = quick ? 20 : 100;
    const uint64_t factor = quick ? 32 : 2, reference_steps = quick ? 4000 : 16000; /* [1/s] multiples of 20 */
    double *at[COMPARED];
    for (int k = 0; k < COMPARED; k++)
        at[k] = scene_room(w->size, sizeof *at[k]);
    refer(w, reference_steps, at);
    write_reference(table, w, reference_steps, at);
    for (size_t i = 0; i < work_solver_count; i++) {
        const work_solver *s = work_solver_at(i);
        if (!work_applies(w, s) || s->side == WORK_EXACT ||
            (s->side == WORK_EXTERNAL && strncmp(s->name, "cvode-bdf", 9) != 0))
            continue;
        if (s->adaptive != NULL && !quick)
            row(table, w, (runner){.solver = s, .effort.tolerance = 1e-2}, parts, at);
        for (uint64_t n = 1; n <= MOST_STEPS && s->adaptive == NULL; n *= factor)
            row(table, w, (runner){.solver = s, .effort.steps = n, .dt = 1 / (frames * (double)n)}, parts, at);
    }
    for (int k = 0; k < COMPARED; k++)
        free(at[k]);
}
