/* SPDX-License-Identifier: MIT */
/* Disturbances on a scene; see disturbances.h. */
#include "disturbances.h"

#include <math.h> /* INFINITY, sqrt(), fabs() */
#include <stdlib.h>

#include "random.h"

typedef struct share {
    uint32_t particle;
    double part; /* fraction of the force of a disturbance */
} share;

typedef struct entry {
    disturbance what;
    size_t first, count; /* range of its shares */
} entry;

struct disturbances {
    uint32_t last_axis;
    size_t count, shares;
    entry *list; /* [count], sorted by start */
    share *share;
};

static const double pi = 3.14159265358979323846;

/* The peak force [N] of a disturbance with this momentum [kg m/s]. */
static double peak_of(double momentum, double duration)
{
    const double mean_of_profile = 128.0 / 315; /* 256 B(5, 5) */
    return momentum / (mean_of_profile * duration);
}

static const double *far_corner(const preset *r)
{
    return &r->start[3 * (r->def.particles - 1)];
}

disturbance disturbances_poke(const preset *r, const preset_settings *s, double duration)
{
    return (disturbance){.start = 0,
                         .duration = duration,
                         .x = far_corner(r)[0] / 2,
                         .y = far_corner(r)[1] / 2,
                         .peak = 1e5,
                         .area = s->length * s->length / 64,
                         .shape = DISTURBANCE_ROUND};
}

disturbance disturbances_drop(const preset *r, const preset_settings *s, double begin, double end, double duration,
                              uint64_t *random)
{
    const double speed = 10, edge = s->length / 16; /* [m/s], [m] */
    const double t = begin + (end - begin) * random_unit(random);
    const double x = far_corner(r)[0] * random_unit(random), y = far_corner(r)[1] * random_unit(random);
    return (disturbance){.start = t,
                         .duration = duration,
                         .x = x,
                         .y = y,
                         .area = edge * edge,
                         .peak = peak_of(s->mass * speed, duration)};
}

disturbance disturbances_box(const preset *r, const preset_settings *s, double start, double mass, double duration)
{
    const double height = 1, gravity = 9.81; /* [m], [m/s^2] */
    disturbance d = disturbances_poke(r, s, duration);
    d.start = start;
    d.peak = peak_of(mass * sqrt(2 * gravity * height), duration);
    d.shape = DISTURBANCE_SQUARE;
    return d;
}

static double weight(const disturbance *d, double dx, double dy)
{
    const double half = 0.5 * sqrt(d->area), relative = (dx * dx + dy * dy) * pi / d->area;
    if (d->shape == DISTURBANCE_SQUARE)
        return fabs(dx) <= half && fabs(dy) <= half ? 1 : 0;
    return relative < 1 ? (1 - relative) * (1 - relative) : 0;
}

/* Appends the shares of one disturbance. */
static void spread(disturbances *p, const preset *r, const disturbance *d)
{
    double sum = 0, least = INFINITY;
    const size_t first = p->shares;
    size_t nearest = 0;
    for (size_t i = 0; i < r->def.particles; i++) {
        if (r->pinned[i])
            continue;
        const double dx = r->start[3 * i] - d->x, dy = r->start[3 * i + 1] - d->y, w = weight(d, dx, dy);
        if (dx * dx + dy * dy < least) {
            least = dx * dx + dy * dy;
            nearest = i;
        }
        if (w > 0)
            p->share[p->shares++] = (share){(uint32_t)i, w};
        sum += w;
    }
    if (p->shares == first && least < INFINITY) {
        sum = 1;
        p->share[p->shares++] = (share){(uint32_t)nearest, 1};
    }
    for (size_t i = first; i < p->shares; i++)
        p->share[i].part /= sum;
}

void disturbances_free(disturbances *p)
{
    if (p == NULL)
        return;
    free(p->list);
    free(p->share);
    free(p);
}

disturbances *disturbances_new(preset *r, const disturbance *list, size_t count)
{
    disturbances *p = calloc(1, sizeof *p);
    if (p == NULL)
        return NULL;
    p->last_axis = r->def.axes - 1;
    p->list = malloc(count * sizeof *p->list);
    for (; p->list != NULL && p->count < count; p->count++) {
        share *more = realloc(p->share, (p->shares + r->def.particles) * sizeof *more);
        if (more == NULL)
            break;
        p->share = more;
        entry new = {.what = list[p->count], .first = p->shares};
        spread(p, r, &new.what);
        new.count = p->shares - new.first;
        size_t at = p->count;
        for (; at > 0 && p->list[at - 1].what.start > new.what.start; at--)
            p->list[at] = p->list[at - 1];
        p->list[at] = new;
    }
    if (p->count < count) {
        disturbances_free(p);
        return NULL;
    }
    r->def.force = disturbances_force;
    r->def.user = p;
    return p;
}

static bool has_ended(const disturbance *d, double t)
{
    return d->start + d->duration <= t;
}

/* The first disturbance that has not ended at t. */
static size_t first_active(const disturbances *p, double t)
{
    size_t low = 0, high = p->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (has_ended(&p->list[middle].what, t))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void disturbances_force(void *user, double t, size_t particles, const double *const position[3],
                        const double *const velocity[3], double *const force[3])
{
    (void)particles;
    (void)position;
    (void)velocity;
    const disturbances *p = user;
    double *down = force[p->last_axis];
    for (size_t i = first_active(p, t); i < p->count && p->list[i].what.start < t; i++) {
        const entry *e = &p->list[i];
        const double u = (t - e->what.start) / e->what.duration, s = 4 * u * (1 - u);
        const double strength = e->what.peak * (s * s) * (s * s);
        for (size_t k = e->first; k < e->first + e->count; k++)
            down[p->share[k].particle] -= strength * p->share[k].part;
    }
}
