/* SPDX-License-Identifier: MIT */
/*
 * Lowering stiffness until a time step is stable.
 *
 * Method    Leapfrog is stable for dt < 2/sqrt(L), where L is the largest row sum of stiffness/mass (stable_step.c). A
 *           particle allows the sum (2 fraction/dt)^2 mass. Weighted links keep their part of it, and what is left
 *           divided by the sum of the links, at most 1, is the factor of the particle. The stiffness of a link is
 *           multiplied by the smaller factor of its two ends. So no sum exceeds what is allowed, and the sum of the
 *           particle with the least factor reaches it.
 * Memory    No memory is needed besides the links: particles are processed in blocks, whose sums fit on the stack.
 *           Previous blocks may already have softened the links of a block, which only lowers its sums.
 */
#include "definition.h"

#include <string.h>

#include "../simd/size_begin.h"

enum { soften_block = 512 };

/* The sums of a block of particles. */
typedef struct link_sums {
    double stiffness[soften_block]; /* [N/m] of links */
    double weighted[soften_block];  /* [N/m] of weighted links */
    uint32_t links[soften_block];
} link_sums;

static bool in_block(size_t first, uint32_t particle)
{
    return particle >= first && particle - first < soften_block;
}

static void add_end(const spring_scene_def *def, link_sums *sums, size_t first, const spring_link *link, uint32_t end)
{
    if (in_block(first, end)) {
        sums->stiffness[end - first] += link_row(def, link, end);
        sums->links[end - first]++;
    }
}

static void add_weighted_links(const spring_scene_def *def, link_sums *sums, size_t first)
{
    for (size_t j = 0; j < def->weighted_links; j++) {
        const spring_weighted_link *link = &def->weighted_link[j];
        for (int k = 0; k < 4; k++)
            if (link->weight[k] != 0 && in_block(first, link->particle[k])) {
                sums->weighted[link->particle[k] - first] += weighted_link_row(def, link, k);
                sums->links[link->particle[k] - first]++;
            }
    }
}

/* What weighted links leave of the sum that a particle allows, and the factor of its links. Both are slightly less than
   exact results, since sums are rounded here and in the precision of the scene. most_rate2: [1/s^2] largest allowed
   sum/mass. */
typedef struct allowance {
    double left, factor;
} allowance;

static allowance allowance_of(const spring_scene_def *def, size_t precision, const link_sums *sums, size_t first,
                              size_t i, double most_rate2)
{
    const double epsilon = precision == sizeof(float) ? 0x1p-23 : 0x1p-52;
    const double rounding = (sums->links[i - first] + 8.0) * epsilon, sum = sums->stiffness[i - first];
    const double left = most_rate2 * mass_of(def, i) - sums->weighted[i - first] / (1 - rounding);
    /* the sum of a pinned particle is 0, and its mass may be anything */
    return (allowance){left, sum > 0 && sum > left * (1 - rounding) ? left / sum * (1 - rounding) : 1};
}

/* Whether weighted links leave something to the links of every particle. */
static bool weighted_links_leave_some(const spring_scene_def *def, size_t precision, double most_rate2)
{
    for (size_t first = 0; first < def->particles && def->weighted_links > 0; first += soften_block) {
        link_sums sums = {{0}, {0}, {0}};
        add_weighted_links(def, &sums, first);
        for (size_t i = first; i < def->particles && i - first < soften_block; i++)
            if (sums.weighted[i - first] > 0 && !(allowance_of(def, precision, &sums, first, i, most_rate2).left > 0))
                return false;
    }
    return true;
}

spring_status spring_definition_soften(const spring_scene_def *def, size_t precision, double dt, double fraction,
                                       spring_link *link)
{
    const spring_status status = spring_definition_check(def, precision, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    const double root = 2 * fraction / dt, most_rate2 = root * root;
    if (!(dt > 0) || !spring_finite(dt) || !(fraction > 0 && fraction <= 1) || (link == NULL && def->links > 0))
        return SPRING_EINVAL;
    if (!weighted_links_leave_some(def, precision, most_rate2))
        return SPRING_ERANGE;
    if (def->links > 0)
        memmove(link, def->link, def->links * sizeof *link);
    for (size_t first = 0; first < def->particles; first += soften_block) {
        link_sums sums = {{0}, {0}, {0}};
        for (size_t j = 0; j < def->links; j++) {
            add_end(def, &sums, first, &link[j], link[j].a);
            add_end(def, &sums, first, &link[j], link[j].b);
        }
        add_weighted_links(def, &sums, first);
        double *const factor = sums.stiffness; /* in the same place */
        for (size_t i = 0; i < soften_block && first + i < def->particles; i++)
            factor[i] = allowance_of(def, precision, &sums, first, first + i, most_rate2).factor;
        for (size_t j = 0; j < def->links; j++) {
            const double a = in_block(first, link[j].a) ? factor[link[j].a - first] : 1;
            const double b = in_block(first, link[j].b) ? factor[link[j].b - first] : 1;
            link[j].stiffness *= a < b ? a : b;
        }
    }
    return SPRING_OK;
}

#include "../simd/size_end.h"
