/* SPDX-License-Identifier: MIT */
/*
 * Lowering stiffness until a time step is stable.
 *
 * Method    Leapfrog is stable for dt < 2/sqrt(L), where L is the largest sum of (2/mass) stiffness over the links of a
 *           particle (stable_step.c). A particle allows the factor f = (2 fraction/dt)^2/sum, at most 1. The stiffness
 *           of a link is multiplied by the smaller factor of its two ends. So no sum exceeds (2 fraction/dt)^2, and the
 *           sum of the particle with the least factor reaches it.
 * Memory    No memory is needed besides the links: particles are processed in blocks, whose sums fit on the stack.
 *           Previous blocks may already have softened the links of a block, which only lowers its sums.
 */
#include "definition.h"
#include "steppers.h"

#include <string.h>

#include "../simd/size_begin.h"

enum { soften_block = 1024 };

/* The sums of a block of particles. */
typedef struct link_sums {
    double stiffness[soften_block]; /* [N/m] twice the stiffness of each link, or once if its other end is pinned */
    uint32_t links[soften_block];
} link_sums;

static bool in_block(size_t first, uint32_t particle)
{
    return particle >= first && particle - first < soften_block;
}

static void add_end(const spring_scene_def *def, link_sums *sums, size_t first, uint32_t end, uint32_t other,
                    double stiffness)
{
    if (in_block(first, end) && !is_pinned(def, end)) {
        sums->stiffness[end - first] += is_pinned(def, other) ? stiffness : 2 * stiffness;
        sums->links[end - first]++;
    }
}

/* The factor that a particle allows, given its sum. It is slightly less than the quotient, since sums are rounded here
   and in the precision of the scene. most_rate2: [1/s^2] largest allowed sum/mass. */
static double factor_of(const spring_scene_def *def, size_t i, double sum, uint32_t links, double most_rate2)
{
    const double epsilon = sizeof(scalar) == sizeof(float) ? 0x1p-23 : 0x1p-52, most = most_rate2 * mass_of(def, i);
    const double rounding = (links + 8.0) * epsilon;
    return sum > most * (1 - rounding) ? most / sum * (1 - rounding) : 1;
}

spring_status spring_links_soften(const spring_scene_def *def, double dt, double fraction, spring_link *link)
{
    const spring_status status = spring_scene_check(def, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    const double root = 2 * fraction / dt, most_rate2 = root * root;
    if (!(dt > 0) || !spring_finite(dt) || !(fraction > 0 && fraction <= 1) || (link == NULL && def->links > 0))
        return SPRING_EINVAL;
    if (def->links > 0)
        memmove(link, def->link, def->links * sizeof *link);
    for (size_t first = 0; first < def->particles; first += soften_block) {
        link_sums sums = {{0}, {0}};
        for (size_t j = 0; j < def->links; j++) {
            add_end(def, &sums, first, link[j].a, link[j].b, link[j].stiffness);
            add_end(def, &sums, first, link[j].b, link[j].a, link[j].stiffness);
        }
        double *const factor = sums.stiffness; /* in the same place */
        for (size_t i = 0; i < soften_block && first + i < def->particles; i++)
            factor[i] = factor_of(def, first + i, sums.stiffness[i], sums.links[i], most_rate2);
        for (size_t j = 0; j < def->links; j++) {
            const double a = in_block(first, link[j].a) ? factor[link[j].a - first] : 1;
            const double b = in_block(first, link[j].b) ? factor[link[j].b - first] : 1;
            link[j].stiffness *= a < b ? a : b;
        }
    }
    return SPRING_OK;
}

#include "../simd/size_end.h"
