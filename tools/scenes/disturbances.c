/* SPDX-License-Identifier: MIT */
/* Disturbances on a scene; see disturbances.h. */
#include "disturbances.h"

#include <math.h> /* INFINITY, sqrt(), fabs() */
#include <stdlib.h>
#include <string.h>

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
    size_t count, capacity, shares, share_capacity;
    entry *list; /* [capacity], sorted by start */
    share *share;
};

static const double pi = 3.14159265358979323846;

double disturbances_peak(double momentum, double duration)
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
                         .peak = disturbances_peak(s->mass * speed, duration)};
}

disturbance disturbances_box(const preset *r, const preset_settings *s, double start, double mass, double duration)
{
    const double height = 1, gravity = 9.81; /* [m], [m/s^2] */
    disturbance d = disturbances_poke(r, s, duration);
    d.start = start;
    d.peak = disturbances_peak(mass * sqrt(2 * gravity * height), duration);
    d.shape = DISTURBANCE_SQUARE;
    return d;
}

/* Returns the array with room for at least one more entry. Out of memory: NULL, and the array is unchanged. */
static void *grown(void *array, size_t *capacity, size_t count, size_t size)
{
    if (count < *capacity)
        return array;
    const size_t more = 2 * count + 64;
    void *memory = realloc(array, more * size);
    if (memory != NULL)
        *capacity = more;
    return memory;
}

static double weight(const disturbance *d, double dx, double dy)
{
    const double half = 0.5 * sqrt(d->area), relative = (dx * dx + dy * dy) * pi / d->area;
    if (d->shape == DISTURBANCE_SQUARE)
        return fabs(dx) <= half && fabs(dy) <= half ? 1 : 0;
    return relative < 1 ? (1 - relative) * (1 - relative) : 0;
}

static bool add_share(disturbances *p, size_t at, size_t particle, double part)
{
    share *more = grown(p->share, &p->share_capacity, at, sizeof *more);
    if (more == NULL)
        return false;
    p->share = more;
    p->share[at] = (share){(uint32_t)particle, part};
    return true;
}

/* Appends the shares of one disturbance and stores their number in *count. */
static bool spread(disturbances *p, const preset *r, const disturbance *d, size_t *count)
{
    double sum = 0, least = INFINITY;
    size_t end = p->shares, nearest = 0;
    for (size_t i = 0; i < r->def.particles; i++) {
        if (r->pinned[i])
            continue;
        const double dx = r->start[3 * i] - d->x, dy = r->start[3 * i + 1] - d->y, w = weight(d, dx, dy);
        if (dx * dx + dy * dy < least) {
            least = dx * dx + dy * dy;
            nearest = i;
        }
        if (w > 0 && !add_share(p, end++, i, w))
            return false;
        sum += w;
    }
    if (end == p->shares && least < INFINITY) {
        sum = 1;
        if (!add_share(p, end++, nearest, 1))
            return false;
    }
    for (size_t i = p->shares; i < end; i++)
        p->share[i].part /= sum;
    *count = end - p->shares;
    return true;
}

disturbances *disturbances_new(const preset *r)
{
    disturbances *p = calloc(1, sizeof *p);
    if (p != NULL)
        p->last_axis = r->def.axes - 1;
    return p;
}

void disturbances_free(disturbances *p)
{
    if (p == NULL)
        return;
    free(p->list);
    free(p->share);
    free(p);
}

spring_status disturbances_add(disturbances *p, const preset *r, const disturbance *d)
{
    entry new = {.what = *d, .first = p->shares};
    entry *more = grown(p->list, &p->capacity, p->count, sizeof *more);
    if (more == NULL)
        return SPRING_ENOMEM;
    p->list = more;
    if (!spread(p, r, d, &new.count))
        return SPRING_ENOMEM;
    size_t at = p->count;
    while (at > 0 && p->list[at - 1].what.start > d->start)
        at--;
    memmove(&p->list[at + 1], &p->list[at], (p->count - at) * sizeof *p->list);
    p->list[at] = new;
    p->count++;
    p->shares += new.count;
    return SPRING_OK;
}

static bool has_ended(const disturbance *d, double t)
{
    return d->start + d->duration <= t;
}

bool disturbances_any(const disturbances *p)
{
    return p->count > 0;
}

void disturbances_forget(disturbances *p, double t)
{
    for (size_t i = 0; i < p->count; i++)
        if (!has_ended(&p->list[i].what, t))
            return;
    p->count = p->shares = 0;
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
