/* SPDX-License-Identifier: MIT */
/*
 * The plain loop; see plain_loop.h. Compiled with -O2 in every build type, as most programs are.
 *
 * There is one division and one square root per link. Each force is computed once and added to both ends. There is one
 * pass over the particles before the links and one after. Link damping uses velocities half a step earlier, as in most
 * games, so there is one evaluation per step.
 */
#include "plain_loop.h"

#include <math.h>

/* Handles one axis. Callers write out the three axes, because -O2 would not unroll a loop. */
static inline double kicked(const plain_scene *s, const plain_particle *p, int axis, double h, bool dragged)
{
    const double force = dragged ? p->force[axis] - s->drag * p->v[axis] : p->force[axis];
    return p->v[axis] + h * (p->inverse_mass * force + s->gravity[axis]);
}

static inline void kick(const plain_scene *s, plain_particle *p, double h, bool dragged)
{
    if (p->inverse_mass > 0) {
        p->v[0] = kicked(s, p, 0, h, dragged);
        p->v[1] = kicked(s, p, 1, h, dragged);
        p->v[2] = kicked(s, p, 2, h, dragged);
    }
}

static inline void pull(const plain_scene *s, bool damped)
{
    for (const spring_link *link = s->link; link < s->link + s->links; link++) {
        plain_particle *a = &s->particle[link->a], *b = &s->particle[link->b];
        const double x = b->x[0] - a->x[0], y = b->x[1] - a->x[1], z = b->x[2] - a->x[2];
        const double length = sqrt(x * x + y * y + z * z);
        double scale;
        if (damped) {
            const double inverse = 1 / length;
            const double rate =
                (b->v[0] - a->v[0]) * x + (b->v[1] - a->v[1]) * y + (b->v[2] - a->v[2]) * z; /* times length */
            scale = (link->stiffness * (length - link->rest) + link->damping * rate * inverse) * inverse;
        } else {
            scale = link->stiffness * (length - link->rest) / length;
        }
        a->force[0] += scale * x;
        a->force[1] += scale * y;
        a->force[2] += scale * z;
        b->force[0] -= scale * x;
        b->force[1] -= scale * y;
        b->force[2] -= scale * z;
    }
}

static inline void advance(const plain_scene *s, double dt, uint64_t steps, bool damped, bool dragged)
{
    plain_particle *const end = s->particle + s->particles;
    for (; steps > 0; steps--) {
        for (plain_particle *p = s->particle; p < end; p++) {
            kick(s, p, dt / 2, dragged);
            p->x[0] += dt * p->v[0];
            p->x[1] += dt * p->v[1];
            p->x[2] += dt * p->v[2];
            p->force[0] = p->force[1] = p->force[2] = 0;
        }
        pull(s, damped);
        for (plain_particle *p = s->particle; p < end; p++)
            kick(s, p, dt / 2, dragged);
    }
}

void plain_advance(const plain_scene *s, double dt, uint64_t steps)
{
    if (s->damped)
        advance(s, dt, steps, true, s->drag > 0);
    else
        advance(s, dt, steps, false, s->drag > 0);
}
