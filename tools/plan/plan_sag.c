/* SPDX-License-Identifier: MIT */
/*
 * The least stiffness with which the stretch of a hanging scene is within a limit; see plan.h.
 *
 * Method    For each trial stiffness, leapfrog runs with drag until all forces balance, from the rest positions of the
 *           last trial. The drag is critical for a pendulum of the length of the scene. The stretch of the settled
 *           scene is close to a power of the stiffness, so the next trial follows from the secant through the logarithms
 *           of the last two. The height with unstretchable links is extrapolated from two stiff scenes: to first order,
 *           the difference from it is proportional to 1/stiffness. (It is not for a sheet without diagonals that hangs
 *           by two corners, which presets and triangle meshes are not.)
 */
#include <math.h>
#include <stdlib.h>

#include "common/cli.h"
#include "plan.h"
#include "scenes/start.h"

static const double fraction = 0.5;      /* of the stable step, while the scene settles */
static const double rest_share = 1e-5;   /* largest acceleration of a scene at rest, relative to gravity */
static const double window = 1e-3;       /* the stretch is smaller than requested by at most this fraction */
static const double accuracy = 1e-2;     /* of a stretch by an extrapolated height, with a margin */
static const double most_work = 2e10;    /* steps times particles and links of a trial; half a minute */
static const double most_measured = 1e8; /* the same for a run whose time is measured */

typedef struct hanging {
    preset *scene;
    double gravity;   /* [m/s^2] */
    double up[3];     /* direction against gravity */
    double drag_rate; /* [1/s] drag/mass while the scene settles */
    bool stands;      /* stands on its pins */
    double height;    /* [m] with unstretchable links, once known */
} hanging;

static double height_of(const hanging *h, size_t particle)
{
    const uint32_t axes = h->scene->def.axes;
    double height = 0;
    for (uint32_t a = 0; a < axes; a++)
        height += h->up[a] * h->scene->position[particle * axes + a];
    return height;
}

static double length_of(const preset *scene, const spring_link *link)
{
    const uint32_t axes = scene->def.axes;
    double length = 0;
    for (uint32_t a = 0; a < axes; a++)
        length = hypot(length, scene->position[link->b * axes + a] - scene->position[link->a * axes + a]);
    return length;
}

/* ------------------------------------------------------------------------------------------------ what the scene is */

/* A part of the scene without pins would fall forever. */
static void check_pins(const preset *scene)
{
    const size_t particles = scene->def.particles;
    uint32_t *part = malloc(particles * sizeof *part);
    bool *held = calloc(particles, sizeof *held);
    if (part == NULL || held == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    spring_links_components(particles, scene->def.links, scene->link, part);
    for (size_t i = 0; i < particles; i++)
        held[part[i]] = held[part[i]] || scene->pinned[i];
    size_t i = 0;
    while (i < particles && held[part[i]])
        i++;
    free(part);
    free(held);
    if (i < particles)
        cli_fail(CLI_USAGE,
                 "--sag: the vertex at \"%g %g %g\" is connected to no pin; all parts of a mesh should be connected "
                 "to its highest vertices, which are pinned",
                 scene->position[3 * i], scene->position[3 * i + 1], scene->position[3 * i + 2]);
}

/* [m] Diagonal of the bounding box of all linked particles. */
static double diagonal_of(const preset *scene)
{
    const uint32_t axes = scene->def.axes;
    double diagonal = 0;
    for (uint32_t a = 0; a < axes; a++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < scene->def.links; i++) {
            const double ends[2] = {scene->position[scene->link[i].a * axes + a],
                                    scene->position[scene->link[i].b * axes + a]};
            low = fmin(low, fmin(ends[0], ends[1]));
            high = fmax(high, fmax(ends[0], ends[1]));
        }
        diagonal = hypot(diagonal, high - low);
    }
    return diagonal;
}

/* Returns true if, on balance, the particles linked to pins are above them. */
static bool is_above_pins(const hanging *h)
{
    const preset *scene = h->scene;
    double above = 0;
    for (size_t i = 0; i < scene->def.links; i++) {
        const spring_link *link = &scene->link[i];
        const int to_free = (scene->pinned[link->a] != 0) - (scene->pinned[link->b] != 0); /* 0: both ends are free */
        above += to_free * (height_of(h, link->b) - height_of(h, link->a));
    }
    return above > 0;
}

static hanging examine(preset *scene)
{
    hanging h = {.scene = scene};
    for (uint32_t a = 0; a < scene->def.axes; a++)
        h.gravity = hypot(h.gravity, scene->def.gravity[a]);
    if (!(h.gravity > 0))
        cli_fail(CLI_USAGE,
                 "--sag: the gravity of this scene is \"%g\" m/s^2; it should not be 0, as in rope, cloth, jelly and "
                 "meshes",
                 h.gravity);
    for (uint32_t a = 0; a < scene->def.axes; a++)
        h.up[a] = -scene->def.gravity[a] / h.gravity;
    check_pins(scene);
    h.stands = is_above_pins(&h);
    h.drag_rate = 2 * sqrt(h.gravity / diagonal_of(scene));
    return h;
}

/* Tethers and links with two pinned ends or without length do not count. */
static bool counts(const preset *scene, const spring_link *link)
{
    return link->rest > 0 && link->flags == 0 && !(scene->pinned[link->a] && scene->pinned[link->b]);
}

/* The stiffness with which the links at the pins would carry the scene if all pulled straight up. A scene that could
   collapse gets more. */
static double first_trial(const hanging *h, double sag)
{
    const preset *scene = h->scene;
    const double margin = h->stands ? 10 : 1;
    double weight = 0, rest = 0;
    for (size_t i = 0; i < scene->def.particles; i++)
        weight += scene->pinned[i] ? 0 : scene->def.mass_all * h->gravity;
    for (size_t i = 0; i < scene->def.links; i++)
        if (scene->link[i].flags == 0 && scene->pinned[scene->link[i].a] != scene->pinned[scene->link[i].b])
            rest += scene->link[i].rest;
    return margin * weight / (sag * rest);
}

/* --------------------------------------------------------------------------------------------------- settled scenes */

static void set_links(preset *scene, double stiffness, double damping)
{
    for (size_t i = 0; i < scene->def.links; i++) {
        scene->link[i].stiffness = stiffness;
        scene->link[i].damping = damping;
    }
    if (scene->fraction > 0)
        start_links(scene, 0, scene->fraction);
}

static _Noreturn void refuse_sag(double sag, double stiffness, const char *why)
{
    cli_fail(CLI_FAILED, "--sag: \"%g\" cannot be reached: with links of %.3g N/m this scene %s; try another sag", sag,
             stiffness, why);
}

/* Runs the scene until it is at rest. It is damped by drag only, since damped links would slow it down. */
static void settle(const hanging *h, double sag, double stiffness)
{
    preset *scene = h->scene;
    const double drag = scene->def.drag, tolerance = rest_share * h->gravity;
    set_links(scene, stiffness, 0);
    scene->def.drag = h->drag_rate * scene->def.mass_all;
    size_t bytes;
    spring_scene *moving = start_scene(scene, SPRING_LEAPFROG, &bytes);
    const double dt = fraction * spring_scene_stable_step(moving, SPRING_LEAPFROG);
    const double each = (double)(scene->def.particles + scene->def.links), some = ceil(1 / (h->drag_rate * dt));
    double work = 0;
    do {
        work += some * each;
        if (!(work <= most_work))
            refuse_sag(sag, stiffness, "does not come to rest in a reasonable time");
        if (spring_scene_advance(moving, SPRING_LEAPFROG, dt, (uint64_t)some) != SPRING_OK)
            refuse_sag(sag, stiffness, "is not stable");
    } while (!spring_scene_at_rest(moving, tolerance / h->drag_rate, tolerance));
    spring_scene_get(moving, SPRING_POSITION, scene->position, 0, 0, scene->def.particles);
    free(moving);
    scene->def.drag = drag;
}

static double stretch_of_links(const hanging *h)
{
    const preset *scene = h->scene;
    const double sign = h->stands ? -1 : 1;
    double most = 0;
    for (size_t i = 0; i < scene->def.links; i++) {
        const spring_link *link = &scene->link[i];
        if (counts(scene, link))
            most = fmax(most, sign * (length_of(scene, link) / link->rest - 1));
    }
    return most;
}

static double settled_height(const hanging *h)
{
    const preset *scene = h->scene;
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < scene->def.links; i++) {
        const double a = height_of(h, scene->link[i].a), b = height_of(h, scene->link[i].b);
        low = fmin(low, fmin(a, b));
        high = fmax(high, fmax(a, b));
    }
    return high - low;
}

static double stretch_of_height(const hanging *h, double height)
{
    return (h->stands ? -1 : 1) * (height / h->height - 1);
}

static double stretch_of_scene(const hanging *h)
{
    return stretch_of_height(h, settled_height(h));
}

/* ------------------------------------------------------------------------------------------------------- the search */

static const double most_compression = 0.5; /* of links; with more, spring_scene_stable_step() is not a bound */

static void check_shape(const hanging *h, double sag, double stiffness)
{
    if (h->stands && (stretch_of_links(h) > most_compression || !is_above_pins(h)))
        refuse_sag(sag, stiffness, "collapses");
}

/* Returns the stiffness, and leaves the scene settled with it. */
static double search(const hanging *h, double sag, double first, double stretch_of(const hanging *))
{
    enum { most_trials = 30 };
    const double aim = sag * (1 - window / 2), flattest = 0.3, steepest = 2;
    double stiffness = first, power = 1, last_stiffness = NAN, last_stretch = NAN;
    for (int trial = 0; trial < most_trials; trial++) {
        settle(h, sag, stiffness);
        const double stretch = stretch_of(h);
        if (stretch <= sag && stretch >= sag * (1 - window)) {
            check_shape(h, sag, stiffness);
            return stiffness;
        }
        if (!(stretch > 0))
            refuse_sag(sag, stiffness, "is not stretched");
        if (trial > 0)
            power = fmin(fmax(log(last_stretch / stretch) / log(stiffness / last_stiffness), flattest), steepest);
        last_stiffness = stiffness;
        last_stretch = stretch;
        stiffness *= pow(stretch / aim, 1 / power);
    }
    refuse_sag(sag, last_stiffness, "comes to rest in more than one shape");
}

/* Computes the steps for a stiffness. */
static void add_steps(preset *scene, double damping, plan_sag *plan)
{
    const double far = 1; /* links of twice their rest length */
    set_links(scene, plan->stiffness, damping);
    plan->most = plan->stretch[PLAN_LINK] > far ? 0.5 : 1;
    const double allowed = fmin(plan_fraction(scene, NAN, NULL), plan->most);
    for (int p = 0; p < plan_precisions; p++) {
        plan_steps *s = &plan->steps[p];
        s->stable_step =
            p == PLAN_DOUBLE ? start_stable_step(scene, SPRING_LEAPFROG) : start_stable_step_in_float(scene);
        s->substeps = s->time = NAN;
        if (isnan(s->stable_step)) /* not representable in single precision */
            continue;
        s->substeps = ceil(plan_frame / (allowed * s->stable_step));
        const double work = s->substeps * (double)(scene->def.particles + scene->def.links);
        const double frames = fmax(fmin(floor(most_measured / work), 60), 1), steps = frames * s->substeps;
        s->time =
            plan_time(scene, (plan_precision)p, SPRING_LEAPFROG, plan_frame / s->substeps, (uint64_t)steps) / frames;
    }
}

void plan_stiffness(preset *scene, double sag, double damping, plan_sag row[plan_limits])
{
    hanging h = examine(scene);
    plan_sag *links = &row[PLAN_LINK], *whole = &row[PLAN_SCENE];
    *links = *whole = (plan_sag){.stiffness = NAN};
    if (h.stands && sag > most_compression)
        cli_fail(CLI_USAGE, "--sag: \"%g\" is too much for a scene that stands on its pins; it should be at most %g",
                 sag, most_compression);
    links->stiffness = search(&h, sag, first_trial(&h, sag), stretch_of_links);
    links->stretch[PLAN_LINK] = stretch_of_links(&h);
    const double height = settled_height(&h);
    settle(&h, sag, 2 * links->stiffness);
    h.height = 2 * settled_height(&h) - height;
    links->stretch[PLAN_SCENE] = stretch_of_height(&h, height);
    add_steps(scene, damping, links);
    const double share = links->stretch[PLAN_SCENE] / sag;
    if (!(share > 0 && share <= 1 + accuracy)) /* a straight row of links cannot stretch more than each of them */
        return;
    whole->stiffness = search(&h, sag, share * links->stiffness, stretch_of_scene);
    whole->stretch[PLAN_LINK] = stretch_of_links(&h);
    whole->stretch[PLAN_SCENE] = stretch_of_scene(&h);
    add_steps(scene, damping, whole);
}
