/* SPDX-License-Identifier: MIT */
/*
 * The number of steps that a method needs for a scene; see plan.h.
 *
 * Method    The reference uses the method of the highest order that the scene supports, with a coarse and a fine step
 *           (half the coarse one): fine + (fine - coarse)/(2^order - 1), by Richardson extrapolation. The correction is
 *           taken as the uncertainty. For each method, steps are halved until the error is small enough. Then the
 *           number of steps per frame is bisected, in whole numbers.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/timing.h"
#include "plan.h"
#include "scenes/scene_run.h"
#include "scenes/start.h"

static const double most_numbers = 2e7; /* kept by the reference: a second of 10^5 particles */
static const double patience = 30;      /* a reference may take this many times the requested work */
static const double law_holds = 0.5;    /* errors below this follow the order of the method */

struct plan_scene {
    const preset *preset;
    uint64_t frames;
    double frame;       /* [s] */
    size_t numbers;     /* of positions per frame */
    double *reference;  /* [frames*numbers] */
    double motion;      /* [m] the largest distance of the reference from the start */
    double uncertainty; /* of the reference, over the motion */
};

static void *room(size_t count)
{
    double *all = calloc(count, sizeof *all);
    if (all == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    return all;
}

static void positions_of(const plan_scene *s, const spring_scene *scene, double *out)
{
    spring_scene_get(scene, SPRING_POSITION, out, 0, 0, s->preset->def.particles);
}

static spring_scene *start(const plan_scene *s, spring_method m)
{
    size_t bytes;
    return start_scene(s->preset, m, &bytes);
}

/* The work of all frames: force evaluations times particles and links. */
static double work_of(const plan_scene *s, spring_method m, double substeps)
{
    return substeps * (double)s->frames * spring_method_describe(m)->forces_per_step *
           (double)(s->preset->def.particles + s->preset->def.links);
}

/* Runs the scene and stores the positions at the ends of all frames. */
static bool run(const plan_scene *s, spring_method m, uint64_t substeps, double *out)
{
    spring_scene *scene = start(s, m);
    bool holds = true;
    for (uint64_t i = 0; i < s->frames && holds; i++) {
        holds = spring_scene_advance(scene, m, s->frame / (double)substeps, substeps) == SPRING_OK;
        positions_of(s, scene, &out[i * s->numbers]);
    }
    free(scene);
    return holds;
}

/* Returns the error of a run; infinite if the state overflows. */
static double error_of(const plan_scene *s, spring_method m, uint64_t substeps)
{
    spring_scene *scene = start(s, m);
    double *now = room(s->numbers), most = 0;
    for (uint64_t i = 0; i < s->frames && most < INFINITY; i++) {
        const bool holds = spring_scene_advance(scene, m, s->frame / (double)substeps, substeps) == SPRING_OK;
        positions_of(s, scene, now);
        const double error = scene_run_distance(now, &s->reference[i * s->numbers], s->numbers) / s->motion;
        most = holds && isfinite(error) ? fmax(most, error) : INFINITY;
    }
    free(now);
    free(scene);
    return most;
}

/* ---------------------------------------------------------------------------------------------------- the reference */

static spring_method best_method(const plan_scene *s)
{
    spring_method best = SPRING_LEAPFROG;
    for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
        const spring_method m = spring_method_at(place);
        if (spring_method_describe(m)->order > spring_method_describe(best)->order && preset_takes(s->preset, m))
            best = m;
    }
    return best;
}

static void measure_motion(plan_scene *s)
{
    double *first = room(s->numbers);
    spring_scene *scene = start(s, SPRING_LEAPFROG);
    positions_of(s, scene, first);
    free(scene);
    s->motion = 0;
    for (uint64_t i = 0; i < s->frames; i++)
        s->motion = fmax(s->motion, scene_run_distance(first, &s->reference[i * s->numbers], s->numbers));
    free(first);
}

static void run_reference(plan_scene *s, double error, double work)
{
    const spring_method m = best_method(s);
    const double below = ldexp(1, spring_method_describe(m)->order) - 1, share = 20;
    const double fewest = 2 * ceil(s->frame / fmin(start_stable_step(s->preset, m), s->frame));
    if (!(work_of(s, m, 3 * fewest) <= patience * work))
        cli_fail(CLI_FAILED,
                 "the reference of this scene would need %.3g steps per frame for %" PRIu64
                 " frames, which takes too long",
                 fewest, s->frames);
    uint64_t substeps = (uint64_t)fewest;
    double *coarse = room(s->frames * s->numbers), *fine = room(s->frames * s->numbers);
    bool known = run(s, m, substeps, coarse);
    for (;; substeps *= 2) {
        known = run(s, m, 2 * substeps, fine) && known;
        double off = 0;
        for (uint64_t i = 0; i < s->frames; i++)
            off = fmax(off, scene_run_distance(&fine[i * s->numbers], &coarse[i * s->numbers], s->numbers) / below);
        for (size_t i = 0; i < s->frames * s->numbers; i++)
            s->reference[i] = fine[i] + (fine[i] - coarse[i]) / below;
        measure_motion(s);
        s->uncertainty = off / s->motion;
        if (!(s->motion > 0) || s->uncertainty <= error / share || work_of(s, m, 4 * (double)substeps) > work)
            break;
        double *other = coarse;
        coarse = fine;
        fine = other;
    }
    free(coarse);
    free(fine);
    if (!known || !(s->motion > 0) || !isfinite(s->uncertainty))
        cli_fail(CLI_FAILED, "the reference of this scene overflows, or does not move");
}

plan_scene *plan_scene_new(const preset *scene, double duration, double error, double work)
{
    plan_scene *s = calloc(1, sizeof *s);
    if (s == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    s->preset = scene;
    s->numbers = s->preset->def.particles * s->preset->def.axes;
    const double frames = fmax(rint(duration / plan_frame), 1);
    if (frames * (double)s->numbers > most_numbers)
        cli_fail(CLI_USAGE, "--duration: \"%g\" of this scene is too long; it should be at most %.3g s", duration,
                 most_numbers / (double)s->numbers * plan_frame);
    s->frames = (uint64_t)frames;
    s->frame = duration / frames;
    s->reference = room(s->frames * s->numbers);
    run_reference(s, error, work);
    return s;
}

void plan_scene_free(plan_scene *s)
{
    free(s->reference);
    free(s);
}

uint64_t plan_scene_frames(const plan_scene *s)
{
    return s->frames;
}

/* ------------------------------------------------------------------------------------------------------- the search */

double plan_time(const preset *scene, plan_precision precision, spring_method m, double dt, uint64_t steps)
{
    const double long_enough = 1e7; /* [ns] */
    double best = INFINITY, all = 0;
    for (int i = 0; i < 2 || (i < 10 && all < long_enough); i++) {
        size_t bytes;
        spring_scene *running = precision == PLAN_DOUBLE ? start_scene(scene, m, &bytes) : NULL;
        spring_scenef *single = precision == PLAN_FLOAT ? start_single(scene) : NULL;
        const double before = timing_busy();
        if (single != NULL)
            spring_scenef_advance(single, m, dt, steps);
        else
            spring_scene_advance(running, m, dt, steps);
        const double spent = timing_busy() - before;
        best = fmin(best, spent);
        all += spent;
        free(running);
        free(single);
    }
    return best * 1e-9;
}

plan_row plan_scene_row(plan_scene *s, spring_method m, double error, double work, bool timed)
{
    plan_row row = {.method = m, .predicted = NAN, .measured = NAN, .uncertainty = NAN, .time = INFINITY};
    if (!preset_takes(s->preset, m))
        return row;
    const int order = spring_method_describe(m)->order;
    uint64_t few = 0, enough = 1;
    double now = error_of(s, m, enough);
    while (!(now <= error)) {
        if (work_of(s, m, 2 * (double)enough) > work)
            return row;
        few = enough;
        enough *= 2;
        now = error_of(s, m, enough);
    }
    while (enough - few > 1) {
        const uint64_t middle = few + (enough - few) / 2;
        const double there = error_of(s, m, middle);
        if (there <= error) {
            enough = middle;
            now = there;
        } else {
            few = middle;
        }
    }
    const uint64_t coarser = (enough + 1) / 2;
    const double of_coarser = coarser < enough ? error_of(s, m, coarser) : NAN;
    row.steps = (double)(enough * s->frames);
    row.dt = s->frame / (double)enough;
    row.evaluations = row.steps * spring_method_describe(m)->forces_per_step;
    if (of_coarser < law_holds)
        row.predicted = of_coarser * pow((double)coarser / (double)enough, order);
    row.measured = now;
    row.uncertainty = s->uncertainty;
    if (timed)
        row.time = plan_time(s->preset, PLAN_DOUBLE, m, s->frame / (double)enough, enough * s->frames);
    return row;
}

unsigned plan_damping_evaluations(const preset *scene, double dt, double *reach)
{
    const spring_scene_def *const def = &scene->def;
    double *const sum = calloc(def->particles, sizeof *sum), largest = 0, drag = 0;
    if (sum == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *const l = &def->link[i];
        sum[l->a] += l->damping * (def->pinned != NULL && def->pinned[l->b] ? 1 : 2);
        sum[l->b] += l->damping * (def->pinned != NULL && def->pinned[l->a] ? 1 : 2);
    }
    for (size_t i = 0; i < def->particles; i++) {
        const double each = def->mass != NULL ? def->mass[i] : def->mass_all == 0 ? 1 : def->mass_all;
        if (def->pinned != NULL && def->pinned[i])
            continue;
        largest = fmax(largest, sum[i] / each);
        drag = fmax(drag, def->drag / each);
    }
    free(sum);
    *reach = dt * largest;
    const double part = dt / start_stable_step(scene, SPRING_LEAPFROG), saturated = fmin(*reach, 30000);
    if (*reach == 0 || (*reach <= 0.4 && *reach + dt * drag <= 0.9 * (1 - part * part)))
        return 0;
    return saturated <= 0.6 ? 1 : (unsigned)fmax(3, ceil(sqrt(2.6 * saturated + 1))) - 1;
}

double plan_fraction(const preset *scene, double duration, const char **what)
{
    const double dragged = 0.1; /* [1/s] drag/mass */
    const double damped = 0.02; /* damping ratio of links */
    const double lone = 1.5;    /* links per particle of a rope */
    const double minute = 60;   /* [s] */
    const spring_scene_def *d = &scene->def;
    double heaviest = 0, ratio = INFINITY, links = 0; /* without tethers, which do not make a sheet of a rope */
    for (size_t i = 0; i < d->particles; i++)
        if (!scene->pinned[i])
            heaviest = fmax(heaviest, d->mass != NULL ? d->mass[i] : d->mass_all > 0 ? d->mass_all : 1);
    for (size_t i = 0; i < d->links; i++) {
        if (d->link[i].flags & SPRING_LINK_TETHER)
            continue;
        links++;
        if (d->link[i].stiffness > 0)
            ratio = fmin(ratio, d->link[i].damping / sqrt(2 * d->link[i].stiffness * heaviest));
    }
    const bool rope = links < lone * (double)d->particles, drags = d->drag >= dragged * heaviest;
    if (what != NULL)
        *what = ratio >= damped ? "damped links (half, if they are tension-only or stretch to twice their length)"
                : drags && !rope
                    ? "a sheet or a block with drag (half, if links are tension-only or stretch to twice their length)"
                : drags             ? "a rope with drag (half, if links are tension-only)"
                : duration > minute ? "a long run without damping"
                                    : "smooth motion without damping (0.25 if it is violent or long)";
    return ratio >= damped || (drags && !rope) ? 0.9 : duration > minute && !drags ? 0.25 : 0.5;
}
