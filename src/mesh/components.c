/* SPDX-License-Identifier: MIT */
/*
 * Connected components of particles and links: the pieces of a torn scene.
 *
 * Method    Union-find. The parent of a particle is the particle itself, or one of the same component with a smaller
 *           index. So a root has the least index of its component, and one ascending pass numbers all particles.
 * Source    Tarjan, van Leeuwen, Worst-case analysis of set union algorithms (1984): path halving
 */
#include <springstep/scene.h>

#include "../simd/size_begin.h"

static bool valid_coefficient(double value)
{
    return value >= 0 && value - value == 0;
}

static bool valid_links(size_t particles, size_t links, const spring_link *link)
{
    for (size_t i = 0; i < links; i++)
        if (link[i].a >= particles || link[i].b >= particles || link[i].a == link[i].b ||
            !valid_coefficient(link[i].stiffness) || !valid_coefficient(link[i].damping))
            return false;
    return true;
}

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]]; /* halves the path of the next search */
        i = parent[i];
    }
    return i;
}

size_t spring_links_components(size_t particles, size_t links, const spring_link *link, uint32_t *component)
{
    if (component == NULL || particles > UINT32_MAX || (link == NULL && links > 0) ||
        !valid_links(particles, links, link))
        return 0;
    for (size_t i = 0; i < particles; i++)
        component[i] = (uint32_t)i;
    for (size_t i = 0; i < links; i++) {
        if (!(link[i].stiffness > 0 || link[i].damping > 0) || (link[i].flags & SPRING_LINK_TETHER) != 0)
            continue;
        const uint32_t a = root_of(component, link[i].a), b = root_of(component, link[i].b);
        component[a < b ? b : a] = a < b ? a : b;
    }
    uint32_t count = 0;
    for (size_t i = 0; i < particles; i++) /* parents before i are already component numbers */
        component[i] = component[i] == i ? count++ : component[component[i]];
    return count;
}

#include "../simd/size_end.h"
