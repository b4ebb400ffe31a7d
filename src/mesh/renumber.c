/* SPDX-License-Identifier: MIT */
/*
 * A numbering of particles that places joined particles near each other in memory.
 *
 * Method    Links with a constant offset between their ends form bands (scene/layout.c). The Cuthill-McKee numbering is
 *           breadth first, from a particle at the rim, with neighbours by ascending degree. It numbers a sheet along
 *           its diagonals, whose lengths differ, so offsets vary. Therefore particles are then joined into chains: in
 *           the order of the numbering, each particle follows its last numbered neighbour that has no successor yet. If
 *           only the shortest links are used, the chains are the rows of a sheet. If chains leave many offsets, more
 *           than a sheet has particles along its edge, the numbering itself is tried, with all links. It has few
 *           offsets, though no bands, since its links join neighbouring levels only. (The reverse numbering, which is
 *           used for matrix factors, has the same offsets.)
 * Start     The particle at the rim is the last particle of a numbering from any other particle.
 * Source    Cuthill, McKee, Reducing the bandwidth of sparse symmetric matrices (1969)
 */
#include <math.h>
#include <string.h>

#include <springstep/scene.h>

#include "../simd/size_begin.h"

static const uint32_t none = UINT32_MAX; /* no number, no particle */

/* Neighbours of particle v: neighbour[start[v]] to neighbour[start[v + 1] - 1]. */
typedef struct graph {
    size_t particles, links;
    const spring_link *link;
    uint32_t *start, *neighbour;
    uint32_t *number; /* of each particle, or none */
    uint32_t *queue;  /* particles by level */
    uint32_t *next;   /* successor in the chain, or none */
} graph;

static spring_status links_status(size_t particles, size_t links, const spring_link *link)
{
    if (particles >= UINT32_MAX || links > UINT32_MAX / 8)
        return SPRING_ERANGE;
    for (size_t i = 0; i < links; i++) {
        if (link[i].a >= particles || link[i].b >= particles)
            return SPRING_ERANGE;
        if (link[i].a == link[i].b)
            return SPRING_EINVAL;
    }
    return SPRING_OK;
}

static uint32_t degree(const graph *g, uint32_t v)
{
    return g->start[v + 1] - g->start[v];
}

/* Whether a link is in the graph. Tethers lead from anywhere to a few particles. */
static bool counts(const spring_link *link, double longest)
{
    return !(link->rest > longest) && (link->flags & SPRING_LINK_TETHER) == 0;
}

/* Lists the neighbours that are joined by links of at most this rest length. */
static void list_neighbours(graph *g, double longest)
{
    memset(g->start, 0, (g->particles + 1) * sizeof *g->start);
    for (size_t i = 0; i < g->links; i++)
        if (counts(&g->link[i], longest)) {
            g->start[g->link[i].a]++;
            g->start[g->link[i].b]++;
        }
    for (size_t v = 0; v < g->particles; v++)
        g->start[v + 1] += g->start[v];
    for (size_t i = g->links; i-- > 0;)
        if (counts(&g->link[i], longest)) {
            g->neighbour[--g->start[g->link[i].a]] = g->link[i].b;
            g->neighbour[--g->start[g->link[i].b]] = g->link[i].a;
        }
}

/* Numbers the particles that are connected to root, breadth first, in the queue from `first` on. Returns its end. */
static uint32_t breadth_first(graph *g, uint32_t root, uint32_t first)
{
    /* of a particle in the queue; without a limit the time would be quadratic in the links of a particle */
    const uint32_t most_moves = 64;
    uint32_t end = first + 1;
    g->queue[first] = root;
    for (uint32_t at = first; at < end; at++) {
        const uint32_t v = g->queue[at], children = end;
        g->number[v] = at;
        for (uint32_t k = g->start[v]; k < g->start[v + 1]; k++) {
            const uint32_t w = g->neighbour[k];
            if (g->number[w] != none)
                continue;
            g->number[w] = 0; /* any number until it is known */
            uint32_t to = end++;
            for (; to > children && end - to <= most_moves && degree(g, g->queue[to - 1]) > degree(g, w); to--)
                g->queue[to] = g->queue[to - 1];
            g->queue[to] = w;
        }
    }
    return end;
}

static void number_by_levels(graph *g)
{
    memset(g->number, -1, g->particles * sizeof *g->number);
    uint32_t first = 0;
    for (uint32_t v = 0; v < g->particles; v++) {
        if (g->number[v] != none)
            continue;
        const uint32_t end = breadth_first(g, v, first);
        for (uint32_t at = first; at < end; at++)
            g->number[g->queue[at]] = none;
        first = breadth_first(g, g->queue[end - 1], first);
    }
}

/* Requires a numbering by levels. */
static void number_by_chains(graph *g, uint32_t *order)
{
    memset(g->next, -1, g->particles * sizeof *g->next);
    for (uint32_t at = 0; at < g->particles; at++) {
        const uint32_t v = g->queue[at];
        uint32_t before = none;
        for (uint32_t k = g->start[v]; k < g->start[v + 1]; k++) {
            const uint32_t w = g->neighbour[k];
            if (g->number[w] < at && g->next[w] == none && (before == none || g->number[w] > g->number[before]))
                before = w;
        }
        if (before != none)
            g->next[before] = v;
    }
    memset(g->number, -1, g->particles * sizeof *g->number);
    uint32_t number = 0;
    for (uint32_t at = 0; at < g->particles; at++)
        for (uint32_t v = g->queue[at]; v != none && g->number[v] == none; v = g->next[v]) {
            order[number] = v;
            g->number[v] = number++;
        }
}

/* The number of different offsets between the ends of links. */
static size_t count_offsets(graph *g)
{
    uint32_t *seen = g->next; /* not in use at this time */
    memset(seen, 0, g->particles * sizeof *seen);
    size_t offsets = 0;
    for (size_t i = 0; i < g->links; i++) {
        const uint32_t a = g->number[g->link[i].a], b = g->number[g->link[i].b];
        const uint32_t offset = a < b ? b - a : a - b;
        if (!counts(&g->link[i], (double)INFINITY))
            continue;
        offsets += seen[offset] == 0;
        seen[offset] = 1;
    }
    return offsets;
}

static void find_order(graph *g, uint32_t *order)
{
    const double longer = 1.25; /* than the shortest link: between the edge of a square and its diagonal */
    double shortest = (double)INFINITY;
    size_t counted = 0;
    for (size_t i = 0; i < g->links; i++) {
        counted += counts(&g->link[i], (double)INFINITY);
        if (counts(&g->link[i], shortest))
            shortest = g->link[i].rest;
    }
    list_neighbours(g, longer * shortest);
    number_by_levels(g);
    number_by_chains(g, order);
    const uint64_t offsets = count_offsets(g);
    if (offsets * offsets <= g->particles && counted >= g->particles) /* fewer: ropes */
        return;
    list_neighbours(g, (double)INFINITY);
    number_by_levels(g);
    if (count_offsets(g) < offsets)
        memcpy(order, g->queue, g->particles * sizeof *order);
}

static uint32_t end_of(const spring_link *link, bool upper)
{
    return (link->a > link->b) == upper ? link->a : link->b;
}

/* Stable counting sort of indices of links by their lower or upper ends. from: NULL for 0, 1, 2 ... */
static void sort_by_end(const graph *g, bool upper, const uint32_t *from, uint32_t *to)
{
    memset(g->start, 0, (g->particles + 1) * sizeof *g->start);
    for (size_t i = 0; i < g->links; i++)
        g->start[end_of(&g->link[i], upper) + 1]++;
    for (size_t v = 0; v < g->particles; v++)
        g->start[v + 1] += g->start[v];
    for (uint32_t i = 0; i < g->links; i++) {
        const uint32_t l = from == NULL ? i : from[i];
        to[g->start[end_of(&g->link[l], upper)]++] = l;
    }
}

/* Permutes links in place, cycle by cycle: link[i] becomes the old link[from[i]]. Overwrites `from`. */
static void permute(size_t links, spring_link *link, uint32_t *from)
{
    for (uint32_t i = 0; i < links; i++) {
        const spring_link kept = link[i];
        uint32_t at = i;
        while (from[at] != i) {
            const uint32_t next = from[at];
            link[at] = link[next];
            from[at] = at;
            at = next;
        }
        link[at] = kept;
        from[at] = at;
    }
}

spring_status spring_links_renumber(size_t particles, size_t links, spring_link *link, uint32_t *order,
                                    uint32_t *link_order, uint32_t *work)
{
    if (order == NULL || work == NULL || (link == NULL && links > 0))
        return SPRING_EINVAL;
    const spring_status status = links_status(particles, links, link);
    if (status != SPRING_OK)
        return status;
    graph g = {particles, links, link, work, NULL, NULL, NULL, NULL};
    g.number = g.start + particles + 1;
    g.queue = g.number + particles;
    g.next = g.queue + particles;
    g.neighbour = g.next + particles;
    find_order(&g, order);
    for (uint32_t i = 0; i < particles; i++)
        g.number[order[i]] = i;
    for (size_t i = 0; i < links; i++) {
        link[i].a = g.number[link[i].a];
        link[i].b = g.number[link[i].b];
    }
    uint32_t *from = g.neighbour + links;
    sort_by_end(&g, true, NULL, g.neighbour);
    sort_by_end(&g, false, g.neighbour, from);
    if (link_order != NULL)
        memcpy(link_order, from, links * sizeof *from);
    permute(links, link, from);
    return SPRING_OK;
}

#include "../simd/size_end.h"
