/* SPDX-License-Identifier: MIT */
/* The right-hand side of ropes and sheets; see work_equation.h. */
#include "work_equation.h"

#include "work_lanes.h"

enum { TILE = 8 }; /* vectors per block: forces of a block are computed, then added up while they are in the cache */

/* The index of the band of a link, or the number of bands if it has none yet. */
static size_t band_of(const work_equation *e, const spring_link *l)
{
    size_t b = 0;
    while (b < e->bands && e->band[b].offset != l->b - l->a)
        b++;
    return b;
}

static bool find_bands(work_equation *e, const scene_problem *p)
{
    for (size_t i = 0; i < p->def.links; i++) {
        const spring_link *l = &p->link[i];
        if (!(l->a < l->b))
            return false;
        const size_t b = band_of(e, l);
        if (b == WORK_BANDS)
            return false;
        if (b == e->bands)
            e->band[e->bands++] = (work_band){.offset = l->b - l->a, .rest = l->rest};
        if (!(fabs(e->band[b].rest - l->rest) <= 0))
            return false;
        e->damped = e->damped || l->damping > 0;
    }
    return true;
}

bool work_equation_applies(const scene_problem *p)
{
    work_equation e = {0};
    return (p->def.axes == 1 || p->def.axes == WORK_AXES) && p->def.force == NULL && find_bands(&e, p);
}

/* Allocates arrays that can be read before the first and after the last slot, where there are no links. */
static void make_arrays(work_equation *e, const scene_problem *p)
{
    size_t widest = 0;
    for (size_t b = 0; b < e->bands; b++)
        widest = e->band[b].offset > widest ? e->band[b].offset : widest;
    e->vectors = (p->def.particles + LANES - 1) / LANES;
    const size_t margin = (widest + LANES) / LANES * LANES, stride = margin + e->vectors * LANES + margin;
    double *next = e->memory = aligned_room((3 * WORK_AXES + 1 + (WORK_AXES + 2) * WORK_BANDS) * stride * sizeof *next);
    next += margin;
    for (size_t d = 0; d < WORK_AXES; d++) {
        e->x[d] = next, next += stride;
        e->v[d] = next, next += stride;
        e->a[d] = next, next += stride;
    }
    e->inverse_mass = next, next += stride;
    for (size_t b = 0; b < e->bands; b++) {
        e->band[b].stiffness = next, next += stride;
        e->band[b].damping = next, next += stride;
        for (size_t d = 0; d < WORK_AXES; d++)
            e->band[b].force[d] = next, next += stride;
    }
}

static void find_runs(work_equation *e, const scene_problem *p)
{
    e->run = scene_room(p->def.particles, sizeof *e->run);
    for (size_t i = 0; i < p->def.particles; i++) {
        if (p->pinned[i])
            continue;
        if (i == 0 || p->pinned[i - 1])
            e->run[e->runs++] = (work_segment){.first = i, .moving = e->moving};
        e->run[e->runs - 1].count++;
        e->moving++;
    }
}

void work_equation_init(work_equation *e, scene_problem *p)
{
    *e = (work_equation){.axes = p->def.axes, .drag = p->def.drag};
    memcpy(e->gravity, p->def.gravity, sizeof e->gravity);
    find_bands(e, p);
    make_arrays(e, p);
    find_runs(e, p);
    for (size_t i = 0; i < p->def.particles; i++) {
        e->inverse_mass[i] = 1 / p->mass[i];
        for (size_t d = 0; d < e->axes; d++)
            e->x[d][i] = p->position[e->axes * i + d];
    }
    for (size_t i = 0; i < p->def.links; i++) {
        const spring_link *l = &p->link[i];
        const work_band *band = &e->band[band_of(e, l)];
        band->stiffness[l->a] = l->stiffness;
        band->damping[l->a] = l->damping;
    }
    for (size_t d = 0; d < e->axes; d++)
        for (const work_segment *r = e->run; r < e->run + e->runs; r++)
            for (size_t i = 0; i < r->count; i++)
                p->coordinate[d * e->moving + r->moving + i] = e->axes * (r->first + i) + d;
}

void work_equation_clear(work_equation *e)
{
    free(e->run);
    free(e->memory);
}

/* ------------------------------------------------------------------------------------------------------- forces */

/* Computes the forces of the links of a band in eight slots. */
INLINE void find_forces(size_t axes, bool damped, const work_equation *e, const work_band *band, size_t at,
                        const lanes *x, const lanes *v)
{
    const double smallest = 1e-30; /* [m^2] avoids NaN in slots without a link, whose ends may coincide */
    lanes delta[WORK_AXES], other, stiffness, damping, scale, square = {0}, rate = {0}, inverse;
    LOAD(stiffness, band->stiffness + at);
    LOAD(damping, band->damping + at);
    UNROLL
    for (size_t d = 0; d < axes; d++) {
        LOAD(other, e->x[d] + at + band->offset);
        delta[d] = other - x[d];
        square += delta[d] * delta[d];
        if (damped) {
            LOAD(other, e->v[d] + at + band->offset);
            rate += delta[d] * (other - v[d]);
        }
    }
    if (axes == 1) {
        delta[0] = stiffness * (delta[0] - band->rest);
        STORE(band->force[0] + at, delta[0]);
        return;
    }
    square += smallest;
    inverse_root(&square, &inverse);
    scale = stiffness * (1 - band->rest * inverse);
    if (damped)
        scale += damping * rate * inverse * inverse;
    UNROLL
    for (size_t d = 0; d < axes; d++) {
        delta[d] *= scale;
        STORE(band->force[d] + at, delta[d]);
    }
}

INLINE void accelerate(size_t axes, const work_equation *e, size_t at)
{
    lanes inverse_mass;
    LOAD(inverse_mass, e->inverse_mass + at);
    UNROLL
    for (size_t d = 0; d < axes; d++) {
        lanes sum, v, lower, upper;
        LOAD(v, e->v[d] + at);
        sum = -e->drag * v;
        for (size_t b = 0; b < e->bands; b++) {
            LOAD(lower, e->band[b].force[d] + at);
            LOAD(upper, e->band[b].force[d] + at - e->band[b].offset);
            sum += lower - upper;
        }
        sum = sum * inverse_mass + e->gravity[d];
        STORE(e->a[d] + at, sum);
    }
}

INLINE void find_accelerations(size_t axes, bool damped, const work_equation *e)
{
    for (size_t first = 0; first < e->vectors; first += TILE) {
        const size_t end = first + TILE < e->vectors ? first + TILE : e->vectors;
        for (size_t i = first; i < end; i++) {
            lanes x[WORK_AXES], v[WORK_AXES];
            UNROLL
            for (size_t d = 0; d < axes; d++) {
                LOAD(x[d], e->x[d] + LANES * i);
                LOAD(v[d], e->v[d] + LANES * i);
            }
            for (size_t b = 0; b < e->bands; b++)
                find_forces(axes, damped, e, &e->band[b], LANES * i, x, v);
        }
        for (size_t i = first; i < end; i++)
            accelerate(axes, e, LANES * i);
    }
}

/* Selects a loop for the number of axes, with or without damping. */
INLINE void accelerations_of(const work_equation *e)
{
    if (e->axes == 1)
        find_accelerations(1, false, e);
    else if (e->damped)
        find_accelerations(WORK_AXES, true, e);
    else
        find_accelerations(WORK_AXES, false, e);
}

#if defined(__x86_64__)
__attribute__((target("avx512f,avx512dq,avx512vl,fma"))) static void with_avx512(const work_equation *e)
{
    accelerations_of(e);
}

__attribute__((target("avx2,fma"))) static void with_avx2(const work_equation *e)
{
    accelerations_of(e);
}
#endif

void work_equation_accelerations(const work_equation *e)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
        with_avx512(e);
        return;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        with_avx2(e);
        return;
    }
#endif
    accelerations_of(e);
}

void work_equation_derivative(double t, const double *y, double *dy, const void *data)
{
    const work_equation *e = data;
    const size_t half = e->axes * e->moving;
    (void)t;
    memcpy(dy, y + half, half * sizeof *dy);
    for (size_t d = 0; d < e->axes; d++)
        for (const work_segment *r = e->run; r < e->run + e->runs; r++) {
            const double *at = y + d * e->moving + r->moving;
            memcpy(e->x[d] + r->first, at, r->count * sizeof *at);
            memcpy(e->v[d] + r->first, at + half, r->count * sizeof *at);
        }
    work_equation_accelerations(e);
    for (size_t d = 0; d < e->axes; d++)
        for (const work_segment *r = e->run; r < e->run + e->runs; r++)
            memcpy(dy + half + d * e->moving + r->moving, e->a[d] + r->first, r->count * sizeof *dy);
}
