/* SPDX-License-Identifier: MIT */
/*
 * Ropes, sheets and blocks: the particles and links of a regular grid.
 *
 * Links are listed by their first particle, so that they form bands in a scene (scene/layout.c).
 */
#include "../simd/arithmetic.h"

#include <math.h>

#include <springstep/scene.h>

#include "../simd/size_begin.h"

typedef struct grid_direction {
    int step[3];
    uint32_t family;
} grid_direction;

/* One of each pair of opposite directions, so that the other end has the larger index. */
static const grid_direction directions[] = {
    {{1, 0, 0}, SPRING_GRID_STRUCTURAL}, {{0, 1, 0}, SPRING_GRID_STRUCTURAL}, {{0, 0, 1}, SPRING_GRID_STRUCTURAL},
    {{-1, 1, 0}, SPRING_GRID_SHEAR},     {{1, 1, 0}, SPRING_GRID_SHEAR},      {{-1, 0, 1}, SPRING_GRID_SHEAR},
    {{1, 0, 1}, SPRING_GRID_SHEAR},      {{0, -1, 1}, SPRING_GRID_SHEAR},     {{0, 1, 1}, SPRING_GRID_SHEAR},
    {{-1, -1, 1}, SPRING_GRID_SHEAR},    {{1, -1, 1}, SPRING_GRID_SHEAR},     {{-1, 1, 1}, SPRING_GRID_SHEAR},
    {{1, 1, 1}, SPRING_GRID_SHEAR},      {{2, 0, 0}, SPRING_GRID_BEND},       {{0, 2, 0}, SPRING_GRID_BEND},
    {{0, 0, 2}, SPRING_GRID_BEND},
};

enum { direction_count = sizeof directions / sizeof directions[0] };

static uint32_t count_of(const spring_grid *g, int axis)
{
    return g->count[axis] == 0 ? 1 : g->count[axis];
}

static uint32_t axes_of_grid(const spring_grid *g)
{
    return g->height ? 1 : g->axes == 0 ? 3 : g->axes;
}

static double stretch_of(const spring_grid *g)
{
    return g->stretch == 0 ? 1 : g->stretch;
}

static bool has_family(const spring_grid *g, const grid_direction *d)
{
    return ((g->families == 0 ? SPRING_GRID_STRUCTURAL : g->families) & d->family) != 0;
}

static bool valid(const spring_grid *g)
{
    const uint32_t families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND;
    const uint32_t faces = SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y |
                           SPRING_GRID_FIRST_Z | SPRING_GRID_LAST_Z;
    if (g == NULL || axes_of_grid(g) > 3 || (g->height && g->axes > 1) || (g->families & ~families) != 0 ||
        (g->pinned & ~faces) != 0)
        return false;
    for (int a = (int)axes_of_grid(g); a < 3 && !g->height; a++) /* one layer along axes that positions do not have */
        if (count_of(g, a) > 1)
            return false;
    const double longest = 4; /* [spacings] no link is longer */
    for (int a = 0; a < 3; a++)
        if (!spring_finite(count_of(g, a) * g->spacing))
            return false;
    return g->spacing > 0 && spring_finite(longest * g->spacing / stretch_of(g)) && g->stretch >= 0 &&
           spring_finite(g->stretch) && g->stiffness >= 0 && spring_finite(g->stiffness) && g->damping >= 0 &&
           spring_finite(g->damping);
}

/* The number of links in one direction. */
static uint64_t links_along(const spring_grid *g, const grid_direction *d)
{
    uint64_t links = 1;
    for (int a = 0; a < 3; a++) {
        const uint32_t step = (uint32_t)(d->step[a] < 0 ? -d->step[a] : d->step[a]);
        links *= count_of(g, a) > step ? count_of(g, a) - step : 0;
    }
    return links;
}

spring_status spring_grid_size(const spring_grid *g, size_t *particles, size_t *links)
{
    if (!valid(g) || particles == NULL || links == NULL)
        return SPRING_EINVAL;
    const uint64_t layer = (uint64_t)count_of(g, 0) * count_of(g, 1); /* < 2^64: two factors of 32 bits */
    if (layer > UINT32_MAX || layer * count_of(g, 2) > UINT32_MAX)
        return SPRING_ERANGE;
    uint64_t sum = 0;
    for (int d = 0; d < direction_count; d++)
        if (has_family(g, &directions[d]))
            sum += links_along(g, &directions[d]);
    if (sum > SIZE_MAX)
        return SPRING_ERANGE;
    *particles = (size_t)(layer * count_of(g, 2));
    *links = (size_t)sum;
    return SPRING_OK;
}

static bool on_pinned_face(const spring_grid *g, const uint32_t at[3])
{
    for (int a = 0; a < 3; a++) {
        const uint32_t faces = g->pinned >> 2 * a;
        if (((faces & 1) != 0 && at[a] == 0) || ((faces & 2) != 0 && at[a] == count_of(g, a) - 1))
            return true;
    }
    return false;
}

/* The index of the particle at the other end, or `index` if there is none. */
static uint32_t neighbour(const spring_grid *g, const uint32_t at[3], uint32_t index, const grid_direction *d)
{
    uint32_t other = index, stride = 1;
    for (int a = 0; a < 3; a++) {
        const int64_t there = (int64_t)at[a] + d->step[a];
        if (there < 0 || there >= count_of(g, a))
            return index;
        other += (uint32_t)d->step[a] * stride;
        stride *= count_of(g, a);
    }
    return other;
}

static spring_link make_link(const spring_grid *g, uint32_t a, uint32_t b, const grid_direction *d)
{
    const int *s = d->step;
    const double length = g->height ? 0 : g->spacing * spring_sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    return (spring_link){
        .a = a, .b = b, .rest = length / stretch_of(g), .stiffness = g->stiffness, .damping = g->damping};
}

spring_status spring_grid_fill(const spring_grid *g, double *position, uint8_t *pinned, spring_link *link)
{
    size_t particles, links;
    const spring_status status = spring_grid_size(g, &particles, &links);
    if (status != SPRING_OK || position == NULL)
        return status != SPRING_OK ? status : SPRING_EINVAL;
    const uint32_t axes = axes_of_grid(g);
    for (uint32_t i = 0; i < particles; i++) {
        const uint32_t nx = count_of(g, 0), ny = count_of(g, 1);
        const uint32_t at[3] = {i % nx, i / nx % ny, i / nx / ny};
        for (uint32_t a = 0; a < axes; a++)
            *position++ = g->height ? 0 : at[a] * g->spacing;
        if (pinned != NULL)
            pinned[i] = on_pinned_face(g, at);
        for (int d = 0; d < direction_count && link != NULL; d++) {
            const uint32_t other = has_family(g, &directions[d]) ? neighbour(g, at, i, &directions[d]) : i;
            if (other != i)
                *link++ = make_link(g, i, other, &directions[d]);
        }
    }
    return SPRING_OK;
}

#include "../simd/size_end.h"
