/* SPDX-License-Identifier: MIT */
/*
 * The particles and links of a triangle mesh, whose vertices may be split at seams.
 *
 * Method    In ascending order, each vertex is welded to the first of the vertices before it that are not welded
 *           themselves and lie within the distance `weld`, or else becomes a particle. These vertices are in a hash table
 *           by cells of a grid. A cell is twice as wide as `weld`, so that all candidates are in the cell of a vertex and
 *           in its 26 neighbours, also after rounding. Particles in a cell are further apart than `weld`, so they are few.
 *           Edges are sorted, so that each is visited once.
 */
#include "edges.h"

#include <math.h>

#include "../simd/size_begin.h"

static const uint32_t no_vertex = UINT32_MAX;

spring_status spring_mesh_check(const mesh *m)
{
    if ((m->position == NULL && m->vertices > 0) || (m->triangle == NULL && m->triangles > 0))
        return SPRING_EINVAL;
    if (m->vertices >= UINT32_MAX || m->triangles > UINT32_MAX / 8)
        return SPRING_ERANGE;
    for (size_t i = 0; i < 3 * m->triangles; i++)
        if (m->triangle[i] >= m->vertices)
            return SPRING_ERANGE;
    for (size_t i = 0; i < 3 * m->vertices; i++)
        if (!spring_finite(m->position[i]))
            return SPRING_EINVAL;
    return SPRING_OK;
}

bool spring_mesh_has_areas(const mesh *m)
{
    for (uint32_t t = 0; t < m->triangles; t++) {
        const double area2 = mesh_angle_at(m, 3 * t).area2;
        if (!(area2 > 0 && spring_finite(area2)))
            return false;
    }
    return true;
}

/* Stable counting sort of sides by one of their ends. from: NULL for 0, 1, 2 ... */
static void sort_sides(const mesh *m, bool upper, const uint32_t *from, uint32_t *to, uint32_t *start)
{
    const uint32_t sides = 3 * (uint32_t)m->triangles;
    memset(start, 0, (m->vertices + 1) * sizeof *start);
    for (uint32_t i = 0; i < sides; i++)
        start[(upper ? mesh_upper_end(m, i) : mesh_lower_end(m, i)) + 1]++;
    for (size_t v = 0; v < m->vertices; v++)
        start[v + 1] += start[v];
    for (uint32_t i = 0; i < sides; i++) {
        const uint32_t side = from == NULL ? i : from[i];
        to[start[upper ? mesh_upper_end(m, side) : mesh_lower_end(m, side)]++] = side;
    }
}

const uint32_t *spring_mesh_sort_sides(const mesh *m, uint32_t *work)
{
    uint32_t *const by_upper = work + m->vertices + 1, *const sorted = by_upper + 3 * m->triangles;
    sort_sides(m, true, NULL, by_upper, work);
    sort_sides(m, false, by_upper, sorted, work);
    return sorted;
}

/* --------------------------------------------------------------------------------------------------------- welding */

typedef struct weld_table {
    const mesh *mesh;
    double weld;
    uint32_t *head, *next; /* [vertices] of the list of each hash, of a vertex in a list */
} weld_table;

/* A cell along one axis. Without a distance, each number is a cell. Adding 0 makes -0.0 equal to 0.0, since cells are
   compared by their bits. */
static double cell_of(const weld_table *t, double x)
{
    return (t->weld > 0 ? floor(x / (2 * t->weld)) : x) + 0.0;
}

static uint32_t *list_of(const weld_table *t, const double cell[3])
{
    const uint64_t odd = UINT64_C(0x9e3779b97f4a7c15); /* 2^64 divided by the golden ratio */
    uint64_t hash = 0;
    for (int a = 0; a < 3; a++) {
        uint64_t bits;
        memcpy(&bits, &cell[a], sizeof bits);
        hash = (hash ^ bits) * odd;
        hash ^= hash >> 32;
    }
    return &t->head[hash % t->mesh->vertices];
}

/* The first vertex in a cell that is not farther than `weld`, if it precedes `best`; else `best`. */
static uint32_t first_in_cell(const weld_table *t, const double cell[3], const double *x, uint32_t best)
{
    for (uint32_t v = *list_of(t, cell); v != no_vertex; v = t->next[v]) {
        const double *y = &t->mesh->position[3 * (size_t)v];
        if (v < best && mesh_distance(x, y, 3) <= t->weld)
            best = v;
    }
    return best;
}

static uint32_t first_near(const weld_table *t, const double *x, uint32_t vertex)
{
    const int reach = t->weld > 0;
    uint32_t best = vertex;
    for (int i = -reach; i <= reach; i++)
        for (int j = -reach; j <= reach; j++)
            for (int k = -reach; k <= reach; k++) {
                const double cell[3] = {cell_of(t, x[0]) + i, cell_of(t, x[1]) + j, cell_of(t, x[2]) + k};
                best = first_in_cell(t, cell, x, best);
            }
    return best;
}

static void weld_vertices(const mesh *m, double weld, uint32_t *welded, uint32_t *work)
{
    const weld_table t = {m, weld, work, work + m->vertices};
    memset(t.head, -1, m->vertices * sizeof *t.head);
    for (uint32_t v = 0; v < m->vertices; v++) {
        const double *x = &m->position[3 * (size_t)v];
        welded[v] = weld < 0 ? v : first_near(&t, x, v);
        if (welded[v] != v)
            continue;
        uint32_t *const list = list_of(&t, (const double[3]){cell_of(&t, x[0]), cell_of(&t, x[1]), cell_of(&t, x[2])});
        t.next[v] = *list;
        *list = v;
    }
}

/* ----------------------------------------------------------------------------------------------------------- links */

static size_t count_edges(const mesh *m, const uint32_t *sides)
{
    size_t edges = 0;
    for (uint32_t i = 0; i < 3 * m->triangles; i++)
        edges += i == 0 || !mesh_same_edge(m, sides[i - 1], sides[i]);
    return edges;
}

spring_status spring_links_from_mesh(size_t vertices, const double *position, size_t triangles,
                                     const uint32_t *triangle, double weld, uint32_t *particle_of, size_t *particles,
                                     spring_link *out, size_t *links, uint32_t *work)
{
    mesh m = {vertices, triangles, position, triangle, work};
    if (links == NULL || work == NULL || !spring_finite(weld) ||
        (out != NULL && (particle_of == NULL || particles == NULL)))
        return SPRING_EINVAL;
    const spring_status status = spring_mesh_check(&m);
    if (status != SPRING_OK)
        return status;
    weld_vertices(&m, weld, work, work + vertices);
    if (!spring_mesh_has_areas(&m))
        return SPRING_EINVAL;
    const uint32_t *const sides = spring_mesh_sort_sides(&m, work + vertices);
    const size_t edges = count_edges(&m, sides), room = *links;
    *links = edges;
    if (out == NULL || room < edges)
        return out == NULL ? SPRING_OK : SPRING_ENOMEM;
    *particles = 0;
    for (uint32_t v = 0; v < vertices; v++) /* a vertex is welded to one before it, whose number is known */
        particle_of[v] = m.welded[v] == v ? (uint32_t)(*particles)++ : particle_of[m.welded[v]];
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        if (i > 0 && mesh_same_edge(&m, sides[i - 1], sides[i]))
            continue;
        const uint32_t a = mesh_lower_end(&m, sides[i]), b = mesh_upper_end(&m, sides[i]);
        *out++ = (spring_link){.a = particle_of[a],
                               .b = particle_of[b],
                               .rest = mesh_distance(&position[3 * (size_t)a], &position[3 * (size_t)b], 3),
                               .stiffness = 1};
    }
    return SPRING_OK;
}

#include "../simd/size_end.h"
