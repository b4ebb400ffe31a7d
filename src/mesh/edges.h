/* SPDX-License-Identifier: MIT */
/* Triangle meshes: checks, and edges sorted by their ends. */
#ifndef SPRINGSTEP_EDGES_H
#define SPRINGSTEP_EDGES_H

#include "../simd/arithmetic.h"

#include <springstep/scene.h>

typedef struct mesh {
    size_t vertices, triangles;
    const double *position;
    const uint32_t *triangle;
    const uint32_t *welded; /* [vertices] the vertex in whose place a vertex is; NULL: each is in its own place */
} mesh;

/* Side 3 t + c of triangle t joins its corner c and the next corner. */
static inline uint32_t mesh_corner(const mesh *m, uint32_t side)
{
    const uint32_t vertex = m->triangle[side];
    return m->welded == NULL ? vertex : m->welded[vertex];
}

static inline uint32_t mesh_next(uint32_t side)
{
    return side % 3 == 2 ? side - 2 : side + 1;
}

static inline uint32_t mesh_lower_end(const mesh *m, uint32_t side)
{
    const uint32_t a = mesh_corner(m, side), b = mesh_corner(m, mesh_next(side));
    return a < b ? a : b;
}

static inline uint32_t mesh_upper_end(const mesh *m, uint32_t side)
{
    const uint32_t a = mesh_corner(m, side), b = mesh_corner(m, mesh_next(side));
    return a < b ? b : a;
}

static inline bool mesh_same_edge(const mesh *m, uint32_t side, uint32_t other)
{
    return mesh_lower_end(m, side) == mesh_lower_end(m, other) && mesh_upper_end(m, side) == mesh_upper_end(m, other);
}

static inline double mesh_distance(const double *x, const double *y, uint32_t axes)
{
    double sum = 0;
    for (uint32_t a = 0; a < axes; a++)
        sum += (y[a] - x[a]) * (y[a] - x[a]);
    return spring_sqrt(sum);
}

/* Counts, indices and positions. */
SPRING_INTERNAL spring_status spring_mesh_check(const mesh *m);

/* Whether every triangle has an area > 0. */
SPRING_INTERNAL bool spring_mesh_has_areas(const mesh *m);

/* The sides in the order of their lower, then of their upper ends, then of their numbers: sides of the same edge are
   adjacent. work: [vertices + 1 + 6 triangles], which contains the result, [3 triangles] */
SPRING_INTERNAL const uint32_t *spring_mesh_sort_sides(const mesh *m, uint32_t *work);

/* Twice the area of the triangle that begins with this side, and the scalar product of this side and the one before. */
typedef struct mesh_angle {
    double area2, product; /* their quotient is the tangent of the angle at the corner */
} mesh_angle;

static inline mesh_angle mesh_angle_at(const mesh *m, uint32_t side)
{
    const uint32_t next = mesh_next(side);
    const double *at = &m->position[3 * (size_t)mesh_corner(m, side)];
    const double *b = &m->position[3 * (size_t)mesh_corner(m, next)];
    const double *c = &m->position[3 * (size_t)mesh_corner(m, mesh_next(next))];
    double p[3], q[3];
    for (int a = 0; a < 3; a++) {
        p[a] = b[a] - at[a];
        q[a] = c[a] - at[a];
    }
    const double x = p[1] * q[2] - p[2] * q[1], y = p[2] * q[0] - p[0] * q[2], z = p[0] * q[1] - p[1] * q[0];
    return (mesh_angle){spring_sqrt(x * x + y * y + z * z), p[0] * q[0] + p[1] * q[1] + p[2] * q[2]};
}

#endif
