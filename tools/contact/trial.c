/* SPDX-License-Identifier: MIT */
/* One collider by three schemes; see trial.h. */
#include "trial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "scenes/start.h"

const char *const contact_scheme_names[] = {"library", "projection", "penalty", NULL};

static const double pi = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Gap and normal of a ball. */
static double gap_of_ball(const double centre[3], double radius, const double x[3], double n[3])
{
    for (int a = 0; a < 3; a++)
        n[a] = x[a] - centre[a];
    const double length = sqrt(dot(n, n));
    for (int a = 0; a < 3; a++)
        n[a] = length > 0 ? n[a] / length : a == 1;
    return length - radius;
}

static double gap_of_capsule(const spring_collider *c, const double x[3], double n[3])
{
    const double along[3] = {c->to[0] - c->at[0], c->to[1] - c->at[1], c->to[2] - c->at[2]};
    const double from[3] = {x[0] - c->at[0], x[1] - c->at[1], x[2] - c->at[2]};
    const double fraction = fmin(fmax(dot(from, along) / dot(along, along), 0), 1);
    const double centre[3] = {c->at[0] + fraction * along[0], c->at[1] + fraction * along[1],
                              c->at[2] + fraction * along[2]};
    return gap_of_ball(centre, c->radius, x, n);
}

/* Gap and normal of an axis-aligned box. Inside, the nearest face counts. */
static double gap_of_box(const spring_collider *c, const double x[3], double n[3])
{
    double centre[3], nearest = -INFINITY;
    int face = 0;
    for (int a = 0; a < 3; a++) {
        const double from = x[a] - c->at[a], gap = fabs(from) - c->half[a];
        centre[a] = c->at[a] + fmin(fmax(from, -c->half[a]), c->half[a]);
        if (gap > nearest)
            nearest = gap, face = a;
    }
    if (nearest > 0)
        return gap_of_ball(centre, c->radius, x, n);
    for (int a = 0; a < 3; a++)
        n[a] = a == face ? copysign(1, x[a] - c->at[a]) : 0;
    return nearest - c->radius;
}

double trial_gap(const spring_collider *c, const double x[3], double n[3])
{
    if (c->shape == SPRING_SPHERE)
        return gap_of_ball(c->at, c->radius, x, n);
    if (c->shape == SPRING_CAPSULE)
        return gap_of_capsule(c, x, n);
    if (c->shape == SPRING_BOX)
        return gap_of_box(c, x, n);
    memcpy(n, c->axis[0], 3 * sizeof *n);
    return dot(c->axis[0], x) - dot(c->axis[0], c->at);
}

static double gap_at(const trial *t, double time, const double x[3], double n[3])
{
    double then[3];
    for (int a = 0; a < 3; a++)
        then[a] = x[a] - time * t->collider.velocity[a];
    return trial_gap(&t->collider, then, n) - t->def.particle_radius;
}

/* ---------------------------------------------------------------------------------------------------- projection */

/* Friction: subtracts the component of d along the surface, shortened to the length `most` if it is longer. */
static void rub(const double n[3], double most, const double d[3], double from[3])
{
    const double along = dot(d, n);
    const double part[3] = {d[0] - along * n[0], d[1] - along * n[1], d[2] - along * n[2]};
    const double length = sqrt(dot(part, part)), lost = length > most ? most / length : 1;
    for (int a = 0; a < 3; a++)
        from[a] -= lost * part[a];
}

static void project(const trial *t, double time, const double before[3], double x[3], double v[3])
{
    double n[3], u[3], d[3];
    const double gap = gap_at(t, time, x, n);
    if (gap >= 0)
        return;
    for (int a = 0; a < 3; a++)
        u[a] = v[a] - t->collider.velocity[a], d[a] = x[a] - before[a] - t->dt * t->collider.velocity[a];
    for (int a = 0; a < 3; a++)
        x[a] -= gap * n[a];
    rub(n, -t->collider.friction * gap, d, x);
    const double along = dot(u, n), slow = 2 * t->dt * sqrt(dot(t->def.gravity, t->def.gravity));
    if (along >= 0)
        return;
    const double change = -(1 + (along < -slow ? t->collider.restitution : 0)) * along;
    for (int a = 0; a < 3; a++)
        v[a] += change * n[a];
    rub(n, t->collider.friction * change, u, v);
}

static void project_all(trial *t)
{
    const double time = spring_scene_time(t->scene);
    for (size_t i = 0; i < t->def.particles; i++) {
        double x[3], v[3], old[6];
        if (t->def.pinned != NULL && t->def.pinned[i])
            continue;
        spring_scene_get(t->scene, SPRING_POSITION, x, 0, i, 1);
        spring_scene_get(t->scene, SPRING_VELOCITY, v, 0, i, 1);
        memcpy(old, x, sizeof x), memcpy(old + 3, v, sizeof v);
        project(t, time, &t->before[3 * i], x, v);
        if (memcmp(old, x, sizeof x) != 0)
            spring_scene_set(t->scene, SPRING_POSITION, x, 0, i, 1);
        if (memcmp(old + 3, v, sizeof v) != 0)
            spring_scene_set(t->scene, SPRING_VELOCITY, v, 0, i, 1);
    }
}

/* ------------------------------------------------------------------------------------------------------- penalty */

static void push_out(void *user, double time, size_t particles, const double *const position[3],
                     const double *const velocity[3], double *const force[3])
{
    const trial *t = user;
    const double slow = 1e-3; /* [m/s] below this, friction is proportional to the speed */
    for (size_t i = 0; i < particles; i++) {
        const double x[3] = {position[0][i], position[1][i], position[2][i]};
        double n[3], u[3];
        const double gap = gap_at(t, time, x, n);
        if (gap >= 0)
            continue;
        for (int a = 0; a < 3; a++)
            u[a] = velocity[a][i] - t->collider.velocity[a];
        const double along = dot(u, n), push = t->def.mass_all * fmax(0, -t->penalty * gap - t->loss * along);
        for (int a = 0; a < 3; a++)
            u[a] -= along * n[a];
        const double drag = t->collider.friction * push / fmax(sqrt(dot(u, u)), slow);
        for (int a = 0; a < 3; a++)
            force[a][i] += push * n[a] - drag * u[a];
    }
}

/* ------------------------------------------------------------------------------------------------------- a trial */

void trial_open(trial *t, const spring_scene_def *def, const spring_collider *c, contact_scheme scheme, double dt)
{
    const double bounce = log(fmax(c->restitution, 1e-3)), ratio = -bounce / hypot(pi, bounce);
    *t = (trial){.scheme = scheme, .def = *def, .collider = *c, .dt = dt, .penalty = pow(0.25 / dt, 2)};
    t->loss = 2 * ratio * sqrt(t->penalty);
    spring_scene_def own = *def;
    if (scheme == CONTACT_PENALTY)
        own.force = push_out, own.user = t;
    else
        own.flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    if (scheme == CONTACT_LIBRARY)
        own.colliders = 1;
    t->before = malloc(3 * def->particles * sizeof *t->before);
    t->scene = start_definition(&own, NULL);
    if (t->before == NULL || (scheme == CONTACT_LIBRARY && spring_scene_set_colliders(t->scene, c, 1) != SPRING_OK))
        cli_fail(CLI_FAILED, "no memory for a scene of %zu particles", def->particles);
}

void trial_close(trial *t)
{
    free(t->before);
    free(t->scene);
}

void trial_advance(trial *t, uint64_t steps)
{
    const uint64_t some = t->scheme == CONTACT_PROJECTION ? 1 : steps;
    for (uint64_t done = 0; done < steps; done += some) {
        if (t->scheme == CONTACT_PROJECTION)
            spring_scene_get(t->scene, SPRING_POSITION, t->before, 0, 0, t->def.particles);
        if (spring_scene_advance(t->scene, SPRING_LEAPFROG, t->dt, some) != SPRING_OK)
            cli_fail(CLI_FAILED, "a scene with the scheme %s is not finite", contact_scheme_names[t->scheme]);
        if (t->scheme == CONTACT_PROJECTION)
            project_all(t);
    }
}
