/* SPDX-License-Identifier: MIT */
/* Disturbances on a scene; see disturbances.h. */
#include "disturbances.h"

#include <math.h>
#include <stdlib.h>

#include "common/cli.h"

typedef struct share {
    uint32_t particle;
    double part; /* of the force of a disturbance */
} share;

struct disturbances {
    uint32_t last_axis;
    size_t count;
    disturbance *list; /* [count] by start */
    size_t *first;     /* [count + 1] of each in share */
    share *share;
};

static const double pi = 3.14159265358979323846;

disturbance disturbances_poke(const preset *r, const preset_settings *s, double duration)
{
    const double *far = &r->start[3 * (r->def.particles - 1)];
    return (disturbance){.start = 0,
                         .duration = duration,
                         .x = far[0] / 2,
                         .y = far[1] / 2,
                         .peak = 1e5,
                         .area = s->length * s->length / 64,
                         .shape = DISTURBANCE_ROUND};
}

static void *room(void *old, size_t bytes)
{
    void *memory = realloc(old, bytes > 0 ? bytes : 1);
    if (memory == NULL)
        cli_fail(CLI_FAILED, "no memory for the disturbances on a scene");
    return memory;
}

static double weight(const disturbance *p, double dx, double dy)
{
    const double half = 0.5 * sqrt(p->area), relative = (dx * dx + dy * dy) * pi / p->area;
    if (p->shape == DISTURBANCE_SQUARE)
        return fabs(dx) <= half && fabs(dy) <= half ? 1 : 0;
    return relative < 1 ? (1 - relative) * (1 - relative) : 0;
}

/* Writes the shares of one disturbance behind those that there are; returns where they end. */
static size_t spread(disturbances *all, const preset *r, const disturbance *p, size_t begin, size_t *capacity)
{
    double sum = 0, least = INFINITY;
    size_t end = begin, nearest = 0;
    for (size_t i = 0; i < r->def.particles; i++) {
        if (r->pinned[i])
            continue;
        const double dx = r->start[3 * i] - p->x, dy = r->start[3 * i + 1] - p->y, w = weight(p, dx, dy);
        if (hypot(dx, dy) < least) {
            least = hypot(dx, dy);
            nearest = i;
        }
        if (end + 2 > *capacity) { /* one more may be the nearest */
            *capacity = 2 * *capacity + 64;
            all->share = room(all->share, *capacity * sizeof *all->share);
        }
        if (w > 0)
            all->share[end++] = (share){(uint32_t)i, w};
        sum += w;
    }
    if (end == begin && least < INFINITY) {
        all->share[end++] = (share){(uint32_t)nearest, 1};
        sum = 1;
    }
    for (size_t i = begin; i < end; i++)
        all->share[i].part /= sum;
    return end;
}

static int by_start(const void *a, const void *b)
{
    const disturbance *p = a, *q = b;
    return (p->start > q->start) - (p->start < q->start);
}

disturbances *disturbances_new(const preset *r, disturbance *list, size_t count)
{
    disturbances *p = room(NULL, sizeof *p);
    size_t capacity = 0;
    qsort(list, count, sizeof *list, by_start);
    *p = (disturbances){.last_axis = r->def.axes - 1, .count = count};
    p->list = room(NULL, count * sizeof *p->list);
    p->first = room(NULL, (count + 1) * sizeof *p->first);
    p->first[0] = 0;
    for (size_t i = 0; i < count; i++) {
        p->list[i] = list[i];
        p->first[i + 1] = spread(p, r, &list[i], p->first[i], &capacity);
    }
    return p;
}

void disturbances_free(disturbances *p)
{
    if (p == NULL)
        return;
    free(p->list);
    free(p->first);
    free(p->share);
    free(p);
}

/* The first disturbance that has not ended at t. */
static size_t first_active(const disturbances *p, double t)
{
    size_t low = 0, high = p->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (p->list[middle].start + p->list[middle].duration > t)
            high = middle;
        else
            low = middle + 1;
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
    for (size_t i = first_active(p, t); i < p->count && p->list[i].start < t; i++) {
        const double s = sin(pi * (t - p->list[i].start) / p->list[i].duration);
        const double strength = p->list[i].peak * s * s * s * s;
        for (size_t k = p->first[i]; k < p->first[i + 1]; k++)
            down[p->share[k].particle] -= strength * p->share[k].part;
    }
}

disturbances *disturbances_poke_water(preset *r, const preset_settings *s, double duration)
{
    if (s->kind != PRESET_WATER)
        return NULL;
    disturbance poke = disturbances_poke(r, s, duration);
    disturbances *p = disturbances_new(r, &poke, 1);
    r->def.force = disturbances_force;
    r->def.user = p;
    return p;
}
