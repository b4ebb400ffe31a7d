/* SPDX-License-Identifier: MIT */
/* The right-hand side that GSL and SUNDIALS integrate for a scene; see work_equation.h. */
#include "work_equation.h"

#include <stdlib.h>
#include <string.h>

#include "harness/link.h"

static void tie(work_equation *e, const scene_problem *p, const spring_link *l, uint32_t moving, uint32_t held,
                const uint32_t *number)
{
    work_tie *t = &e->tie[e->ties++];
    *t = (work_tie){.a = number[moving], .stiffness = l->stiffness, .damping = l->damping, .rest = l->rest};
    /* on one axis the force is k (x_b - x_a - rest): seen from b the rest length has the other sign */
    if (e->axes == 1 && moving == l->b)
        t->rest = -l->rest;
    for (size_t d = 0; d < e->axes; d++)
        t->point[d] = p->position[held * e->axes + d];
}

void work_equation_init(work_equation *e, const scene_problem *p)
{
    const spring_scene_def *def = &p->def;
    uint32_t *number = scene_room(def->particles, sizeof *number);
    *e = (work_equation){.axes = def->axes, .drag = def->drag, .force = def->force, .user = def->user};
    memcpy(e->gravity, def->gravity, sizeof e->gravity);
    e->link = scene_room(def->links, sizeof *e->link);
    e->tie = scene_room(def->links, sizeof *e->tie);
    e->per_mass = scene_room(def->particles, sizeof *e->per_mass);
    for (size_t i = 0; i < def->particles; i++)
        if (!p->pinned[i]) {
            e->per_mass[e->particles] = 1 / p->mass[i];
            number[i] = (uint32_t)e->particles++;
        }
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *l = &p->link[i];
        e->damped = e->damped || l->damping > 0;
        if (!p->pinned[l->a] && !p->pinned[l->b])
            e->link[e->links++] = (work_link){number[l->a], number[l->b], l->stiffness, l->damping, l->rest};
        else if (!p->pinned[l->a])
            tie(e, p, l, l->a, l->b, number);
        else if (!p->pinned[l->b])
            tie(e, p, l, l->b, l->a, number);
    }
    free(number);
}

void work_equation_clear(work_equation *e)
{
    free(e->link);
    free(e->tie);
    free(e->per_mass);
}

typedef struct end { /* of a link */
    const double *x, *v;
    double *sum; /* of forces */
} end;

/* Adds the force of a link to the sums of both ends. */
static inline void add_link(size_t axes, bool damped, end a, end b, double stiffness, double damping, double rest)
{
    double delta[3] = {0}, relative[3] = {0};
    for (size_t d = 0; d < axes; d++) {
        delta[d] = b.x[d] - a.x[d];
        relative[d] = damped ? b.v[d] - a.v[d] : 0;
    }
    const link_force f = link_evaluate(axes, delta, relative, stiffness, damped ? damping : 0, rest);
    for (size_t d = 0; d < axes; d++) {
        a.sum[d] += f.force[d];
        b.sum[d] -= f.force[d];
    }
}

/* Called with constants, so that the compiler writes a loop for each number of axes, with damping and without. */
static inline void add_forces(size_t axes, bool damped, const work_equation *e, const double *x, const double *v,
                              double *sum)
{
    static const double still[3] = {0};
    double unused[3] = {0};
    for (const work_link *l = e->link; l < e->link + e->links; l++) {
        const size_t a = axes * l->a, b = axes * l->b;
        add_link(axes, damped, (end){x + a, v + a, sum + a}, (end){x + b, v + b, sum + b}, l->stiffness, l->damping,
                 l->rest);
    }
    for (const work_tie *t = e->tie; t < e->tie + e->ties; t++) {
        const size_t a = axes * t->a;
        add_link(axes, damped, (end){x + a, v + a, sum + a}, (end){t->point, still, unused}, t->stiffness, t->damping,
                 t->rest);
    }
    for (size_t i = 0; i < axes * e->particles && e->drag > 0; i++)
        sum[i] -= e->drag * v[i];
}

static void add_forces_of(const work_equation *e, const double *x, const double *v, double *sum)
{
    if (e->axes == 1)
        add_forces(1, true, e, x, v, sum);
    else if (e->axes == 2)
        add_forces(2, true, e, x, v, sum);
    else if (e->damped)
        add_forces(3, true, e, x, v, sum);
    else
        add_forces(3, false, e, x, v, sum);
}

static inline void divide(size_t axes, const work_equation *e, double *sum)
{
    for (size_t i = 0; i < e->particles; i++)
        for (size_t d = 0; d < axes; d++)
            sum[axes * i + d] = sum[axes * i + d] * e->per_mass[i] + e->gravity[d];
}

void work_equation_derivative(double t, const double *y, double *dy, const void *data)
{
    const work_equation *e = data;
    const size_t moving = e->axes * e->particles;
    const double *x = y, *v = y + moving;
    double *sum = dy + moving;
    memcpy(dy, v, moving * sizeof *dy);
    memset(sum, 0, moving * sizeof *sum);
    add_forces_of(e, x, v, sum);
    if (e->force != NULL)
        e->force(e->user, t, e->particles, (const double *const[3]){x}, (const double *const[3]){v},
                 (double *const[3]){sum});
    if (e->axes == 1)
        divide(1, e, sum);
    else if (e->axes == 2)
        divide(2, e, sum);
    else
        divide(3, e, sum);
}
