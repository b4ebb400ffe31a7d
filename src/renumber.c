/* SPDX-License-Identifier: MIT */
/*
 * A numbering of particles that puts those near each other in memory which are joined.
 *
 * Method    Of four numberings the one is kept that leaves the fewest different offsets between the ends of links, since
 *           links of constant offset make a band (scene_init.c), and a small bandwidth leaves few, too. Two are those
 *           of Cuthill and McKee: breadth first from a particle at the rim, neighbours by ascending degree; one
 *           follows only the shortest links, which in a sheet or block are those along its rows, the other all. (Their
 *           reversal, which is for factors of matrices, changes no offset.) They number a sheet by diagonals, and the
 *           lengths of diagonals differ. So of each a second is made: of chains, each particle behind the last numbered
 *           of its neighbours that has none behind it yet. In a sheet they are its rows.
 * Start     The particle at the rim is pseudo-peripheral: of a numbering's last level one of least degree starts the
 *           next, as long as there are more levels each time.
 * Source    Cuthill, McKee, Reducing the bandwidth of sparse symmetric matrices (1969); George, Liu, An implementation
 *           of a pseudoperipheral node finder, ACM Transactions on Mathematical Software 5 (1979)
 */
#include <math.h>
#include <string.h>

#include <springstep/scene.h>

static const uint32_t none = UINT32_MAX; /* no number, no particle */

/* Neighbours of particle v: neighbour[start[v]] to neighbour[start[v + 1] - 1]. */
typedef struct graph {
    size_t particles, links;
    const spring_link *link;
    uint32_t *start, *neighbour;
    uint32_t *number; /* of each particle, or none */
    uint32_t *queue;  /* particles by number */
    uint32_t *next;   /* in its chain */
} graph;

static spring_status check(size_t particles, size_t links, const spring_link *link)
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

/* By ascending degree. A particle with very many links is left alone: this is quadratic. */
static void sort_neighbours(graph *g, uint32_t v)
{
    const uint32_t most = 64;
    uint32_t *list = g->neighbour + g->start[v];
    const uint32_t count = degree(g, v) <= most ? degree(g, v) : 0;
    for (uint32_t i = 1; i < count; i++) {
        const uint32_t moved = list[i];
        uint32_t at = i;
        for (; at > 0 && degree(g, list[at - 1]) > degree(g, moved); at--)
            list[at] = list[at - 1];
        list[at] = moved;
    }
}

/* Joined by links up to a length. */
static void list_neighbours(graph *g, double longest)
{
    memset(g->start, 0, (g->particles + 1) * sizeof *g->start);
    for (size_t i = 0; i < g->links; i++)
        if (!(g->link[i].rest > longest)) {
            g->start[g->link[i].a]++;
            g->start[g->link[i].b]++;
        }
    for (size_t v = 0; v < g->particles; v++)
        g->start[v + 1] += g->start[v];
    for (size_t i = g->links; i-- > 0;)
        if (!(g->link[i].rest > longest)) {
            g->neighbour[--g->start[g->link[i].a]] = g->link[i].b;
            g->neighbour[--g->start[g->link[i].b]] = g->link[i].a;
        }
    for (uint32_t v = 0; v < g->particles; v++)
        sort_neighbours(g, v);
}

typedef struct levels {
    uint32_t count, last, end; /* numbers of the last level: last to end - 1 */
} levels;

/* Numbers what is joined to root by breadth first, from first on. */
static levels sweep(graph *g, uint32_t root, uint32_t first)
{
    levels l = {1, first, first + 1};
    uint32_t level_end = l.end;
    g->queue[first] = root;
    g->number[root] = first;
    for (uint32_t at = first; at < l.end; at++) {
        if (at == level_end) {
            l.count++;
            l.last = at;
            level_end = l.end;
        }
        const uint32_t v = g->queue[at];
        for (uint32_t k = g->start[v]; k < g->start[v + 1]; k++) {
            const uint32_t w = g->neighbour[k];
            if (g->number[w] == none) {
                g->number[w] = l.end;
                g->queue[l.end++] = w;
            }
        }
    }
    return l;
}

static uint32_t least_degree(const graph *g, levels l)
{
    uint32_t least = g->queue[l.last];
    for (uint32_t at = l.last; at < l.end; at++)
        if (degree(g, g->queue[at]) < degree(g, least))
            least = g->queue[at];
    return least;
}

static void number_by_levels(graph *g)
{
    const int most_sweeps = 8; /* they are seldom more than three */
    memset(g->number, -1, g->particles * sizeof *g->number);
    uint32_t first = 0;
    for (uint32_t v = 0; v < g->particles; v++) {
        if (g->number[v] != none)
            continue;
        levels l = sweep(g, v, first), before = {0, 0, 0};
        for (int s = 1; s < most_sweeps && l.count > before.count; s++) {
            const uint32_t root = least_degree(g, l);
            for (uint32_t at = first; at < l.end; at++)
                g->number[g->queue[at]] = none;
            before = l;
            l = sweep(g, root, first);
        }
        first = l.end;
    }
}

static void number_by_chains(graph *g)
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
        for (uint32_t v = g->queue[at]; v != none && g->number[v] == none; v = g->next[v])
            g->number[v] = number++;
}

/* How many different offsets there are between the ends of links. */
static size_t count_offsets(graph *g)
{
    uint32_t *seen = g->next; /* not needed any more */
    memset(seen, 0, g->particles * sizeof *seen);
    size_t offsets = 0;
    for (size_t i = 0; i < g->links; i++) {
        const uint32_t a = g->number[g->link[i].a], b = g->number[g->link[i].b];
        const uint32_t offset = a < b ? b - a : a - b;
        offsets += seen[offset] == 0;
        seen[offset] = 1;
    }
    return offsets;
}

/* Keeps a numbering if it is the best so far: order is its inverse. */
static void keep_better(graph *g, size_t *least, uint32_t *order)
{
    const size_t offsets = count_offsets(g);
    if (offsets >= *least)
        return;
    *least = offsets;
    for (uint32_t v = 0; v < g->particles; v++)
        order[g->number[v]] = v;
}

static void find_order(graph *g, uint32_t *order)
{
    const double longer = 1.25; /* than the shortest link: between the edge of a square and its diagonal */
    double shortest = INFINITY;
    for (size_t i = 0; i < g->links; i++)
        shortest = g->link[i].rest < shortest ? g->link[i].rest : shortest;
    const double longest[] = {longer * shortest, INFINITY};
    size_t least = SIZE_MAX;
    for (int i = 0; i < 2; i++) {
        list_neighbours(g, longest[i]);
        number_by_levels(g);
        keep_better(g, &least, order);
        number_by_chains(g);
        keep_better(g, &least, order);
        if (g->start[g->particles] == 2 * g->links)
            break; /* all links were among the shortest */
    }
}

static uint32_t end_of(const spring_link *link, bool upper)
{
    return (link->a > link->b) == upper ? link->a : link->b;
}

/* Counting sort of indices of links by their lower or upper ends, stable; from: NULL for 0, 1, 2 ... */
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

/* link[i] becomes what link[from[i]] was, cycle by cycle; from is used up. */
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
    const spring_status status = check(particles, links, link);
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
    if (link_order != NULL && links > 0)
        memcpy(link_order, from, links * sizeof *from);
    permute(links, link, from);
    return SPRING_OK;
}
