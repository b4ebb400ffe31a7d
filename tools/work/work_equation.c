/* SPDX-License-Identifier: MIT */
/* The right-hand side that GSL and SUNDIALS integrate for a scene; see work_equation.h. */
#include "work_equation.h"

#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "harness/link.h"

static void tie(work_equation *e, const scene_problem *p, const spring_link *l, uint32_t moving, uint32_t held,
                const uint32_t *number)
{
    work_tie *t = &e->tie[e->ties++];
    *t = (work_tie){.a = number[moving], .stiffness = l->stiffness, .rest = l->rest};
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
        if (l->damping > 0)
            cli_fail(CLI_FAILED, "link %zu is damped, which the external solvers' equation does not know", i);
        if (!p->pinned[l->a] && !p->pinned[l->b])
            e->link[e->links++] = (work_link){number[l->a], number[l->b], l->stiffness, l->rest};
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

/* Adds the force of an undamped link between two points to the sums of both. */
static inline void add_link(size_t axes, const double *a, const double *b, double stiffness, double rest,
                            double *restrict force_a, double *restrict force_b)
{
    const double delta[3] = {b[0] - a[0], axes > 1 ? b[1] - a[1] : 0, axes > 2 ? b[2] - a[2] : 0}, still[3] = {0};
    const link_force f = link_evaluate(axes, delta, still, stiffness, 0, rest);
    force_a[0] += f.force[0];
    force_b[0] -= f.force[0];
    if (axes > 1) {
        force_a[1] += f.force[1];
        force_b[1] -= f.force[1];
    }
    if (axes > 2) {
        force_a[2] += f.force[2];
        force_b[2] -= f.force[2];
    }
}

/* Called with constants, so that the compiler writes a loop for each number of axes. */
static inline void add_forces(size_t axes, const work_equation *e, const double *x, const double *v, double *sum)
{
    double unused[3] = {0};
    for (const work_link *l = e->link; l < e->link + e->links; l++)
        add_link(axes, x + axes * l->a, x + axes * l->b, l->stiffness, l->rest, sum + axes * l->a, sum + axes * l->b);
    for (const work_tie *t = e->tie; t < e->tie + e->ties; t++)
        add_link(axes, x + axes * t->a, t->point, t->stiffness, t->rest, sum + axes * t->a, unused);
    for (size_t i = 0; i < axes * e->particles && e->drag > 0; i++)
        sum[i] -= e->drag * v[i];
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
    if (e->axes == 1)
        add_forces(1, e, x, v, sum);
    else if (e->axes == 2)
        add_forces(2, e, x, v, sum);
    else
        add_forces(3, e, x, v, sum);
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
