/* SPDX-License-Identifier: MIT */
/*
 * Bending stiffness of rods and sheets, as weighted links with rest length 0.
 *
 * Rods      The vector between a particle and the chord of its neighbours, d = sum w x with w = (l2, -(l1 + l2), l1)/
 *           (l1 + l2), is l1 l2/2 times the curvature. Its energy EI l curvature^2/2, for the length l, which is half of
 *           both segments, is that of a spring of stiffness EI/l ((l1 + l2)/(l1 l2))^2: with equal segments, d is h^2/2
 *           times the curvature and the stiffness 4 EI/h^3.
 * Clamps    A segment between two pinned particles does not bend. It does not count in l, so the stiffness there is
 *           twice as large.
 * Grids     The same along rows, columns and diagonals, with (1/2, -1, 1/2). The stiffness 8 D/(3 h^2) along rows and
 *           columns and 2 D/(3 h^2) along diagonals gives D/2 (xx^2 + yy^2 + 2/3 xx yy + 4/3 xy^2) per area, where xx, yy
 *           and xy are the second derivatives: an isotropic plate of Poisson ratio 1/3.
 * Meshes    Over an edge of two triangles with the areas A0 and A1, d = sum w x with the cotangents of the angles at
 *           the edge. d/(A0 + A1) is a mean curvature, and the stiffness D/(A0 + A1).
 * Source    Bergou, Wardetzky, Harmon, Zorin, Grinspun, A quadratic bending model for inextensible surfaces (2006);
 *           Seung, Nelson, Defects in flexible membranes with crystalline order (1988): the stiffness for equilateral
 *           triangles
 */
#include "edges.h"

#include "../simd/size_begin.h"

/* Links to be written. A function first counts them, without `out`, and then writes them. */
typedef struct bend_links {
    spring_weighted_link *out;
    size_t count;
    double damping_time;
    bool valid;
} bend_links;

static void append(bend_links *l, spring_weighted_link link)
{
    link.damping = l->damping_time * link.stiffness;
    l->valid &= spring_finite(link.stiffness) && spring_finite(link.damping);
    if (l->out != NULL)
        l->out[l->count] = link;
    l->count++;
}

/* The model that a function makes links of. */
typedef struct bend_model {
    double rigidity;
    const uint8_t *pinned;
    size_t particles;
    uint32_t axes;
    const double *position;
    const spring_grid *grid;
    uint32_t families;
    mesh mesh;
    const uint32_t *sides; /* sorted */
} bend_model;

typedef void bend_fn(const bend_model *b, bend_links *out);

static spring_status make_links(const bend_model *b, bend_fn *make, double damping_time, spring_weighted_link *out,
                                size_t *count)
{
    if (!(b->rigidity >= 0 && spring_finite(b->rigidity) && damping_time >= 0 && spring_finite(damping_time)))
        return SPRING_EINVAL;
    bend_links links = {NULL, 0, damping_time, true};
    make(b, &links);
    if (!links.valid)
        return SPRING_EINVAL;
    const size_t room = *count;
    *count = links.count;
    if (out == NULL || room < links.count)
        return out == NULL ? SPRING_OK : SPRING_ENOMEM;
    links.out = out;
    links.count = 0;
    make(b, &links);
    return SPRING_OK;
}

static bool pinned_at(const bend_model *b, size_t i)
{
    return b->pinned != NULL && b->pinned[i] != 0;
}

static bool bends(const bend_model *b, size_t i, size_t j) /* the segment between i and j */
{
    return !(pinned_at(b, i) && pinned_at(b, j));
}

/* ------------------------------------------------------------------------------------------------------------ rods */

static void bend_rod(const bend_model *b, bend_links *out)
{
    double l1 = 0;
    for (uint32_t i = 0; i + 1 < b->particles; i++) {
        const double *at = &b->position[i * b->axes], l2 = mesh_distance(at, at + b->axes, b->axes);
        out->valid &= l2 > 0 && spring_finite(l2);
        if (i > 0 && (bends(b, i - 1, i) || bends(b, i, i + 1))) {
            const double length = (bends(b, i - 1, i) ? l1 / 2 : 0) + (bends(b, i, i + 1) ? l2 / 2 : 0);
            const double curvature = 1 / l1 + 1 / l2; /* for d = 1 */
            append(out, (spring_weighted_link){.particle = {i - 1, i, i + 1},
                                               .weight = {l2 / (l1 + l2), -1, l1 / (l1 + l2)},
                                               .stiffness = b->rigidity / length * curvature * curvature});
        }
        l1 = l2;
    }
}

spring_status spring_bend_rod(size_t particles, uint32_t axes, const double *position, const uint8_t *pinned,
                              double rigidity, double damping_time, spring_weighted_link *out, size_t *count)
{
    if (count == NULL || axes > 3 || (position == NULL && particles > 0))
        return SPRING_EINVAL;
    if (particles > UINT32_MAX)
        return SPRING_ERANGE;
    const bend_model b = {.rigidity = rigidity,
                          .pinned = pinned,
                          .particles = particles,
                          .axes = axes == 0 ? 3 : axes,
                          .position = position};
    return make_links(&b, bend_rod, damping_time, out, count);
}

/* ----------------------------------------------------------------------------------------------------------- grids */

/* Two axes of a sheet: the numbers of particles along them, and the index offsets of neighbours. */
typedef struct sheet {
    uint32_t count[2], offset[2];
} sheet;

static bool find_sheet(const spring_grid *g, sheet *s)
{
    uint32_t axes = 0, offset = 1;
    for (int a = 0; a < 3; a++)
        if (g->count[a] > 1) {
            if (axes == 2)
                return false;
            s->count[axes] = g->count[a];
            s->offset[axes++] = offset;
            offset *= g->count[a];
        }
    return axes == 2;
}

static void bend_grid(const bend_model *b, bend_links *out)
{
    static const int steps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    const bool diagonals = (b->families & SPRING_BEND_DIAGONALS) != 0;
    const double unit = b->rigidity / b->grid->spacing / b->grid->spacing;
    sheet s;
    find_sheet(b->grid, &s);
    for (int f = 0; f < (diagonals ? 4 : 2); f++) {
        const double stiffness = f >= 2 ? 2. / 3 * unit : diagonals ? 8. / 3 * unit : 4 * unit;
        const uint32_t margin[2] = {steps[f][0] != 0, (uint32_t)steps[f][1]};
        const uint32_t offset = (uint32_t)steps[f][0] * s.offset[0] + (uint32_t)steps[f][1] * s.offset[1];
        for (uint32_t j = margin[1]; j + margin[1] < s.count[1]; j++)
            for (uint32_t i = margin[0]; i + margin[0] < s.count[0]; i++) {
                const uint32_t at = i * s.offset[0] + j * s.offset[1];
                const uint32_t p[3] = {at - offset, at, at + offset};
                const bool first = bends(b, p[0], p[1]), second = bends(b, p[1], p[2]);
                if (!first && !second)
                    continue;
                const bool edge = (margin[0] == 0 && (i == 0 || i == s.count[0] - 1)) ||
                                  (margin[1] == 0 && (j == 0 || j == s.count[1] - 1));
                append(out,
                       (spring_weighted_link){.particle = {p[0], p[1], p[2]},
                                              .weight = {0.5, -1, 0.5},
                                              .stiffness = stiffness * (edge ? 0.5 : 1) * (first && second ? 1 : 2)});
            }
    }
}

spring_status spring_bend_grid(const spring_grid *g, const uint8_t *pinned, uint32_t families, double rigidity,
                               double damping_time, spring_weighted_link *out, size_t *count)
{
    size_t particles, links;
    sheet s;
    const spring_status status = spring_grid_size(g, &particles, &links);
    if (status != SPRING_OK)
        return status;
    const uint32_t both = SPRING_BEND_ROWS | SPRING_BEND_DIAGONALS;
    if (count == NULL || !find_sheet(g, &s) || (families != SPRING_BEND_ROWS && families != both))
        return SPRING_EINVAL;
    const bend_model b = {.rigidity = rigidity, .pinned = pinned, .grid = g, .families = families};
    return make_links(&b, bend_grid, damping_time, out, count);
}

/* ---------------------------------------------------------------------------------------------------------- meshes */

/* The area of the triangle of a side, or 0 if all its corners are pinned, and the cotangents at the ends of the side. */
typedef struct half_hinge {
    uint32_t opposite;
    double area, lower, upper;
} half_hinge;

static half_hinge half_hinge_at(const bend_model *b, uint32_t side)
{
    const mesh *m = &b->mesh;
    const uint32_t next = mesh_next(side), last = mesh_next(next);
    const mesh_angle first = mesh_angle_at(m, side), second = mesh_angle_at(m, next);
    const double at = first.product / first.area2, there = second.product / second.area2;
    const bool up = mesh_corner(m, side) < mesh_corner(m, next);
    const bool clamp = !bends(b, mesh_corner(m, side), mesh_corner(m, next)) && pinned_at(b, mesh_corner(m, last));
    return (half_hinge){mesh_corner(m, last), clamp ? 0 : first.area2 / 2, up ? at : there, up ? there : at};
}

static void bend_mesh(const bend_model *b, bend_links *out)
{
    const mesh *m = &b->mesh;
    const uint32_t sides = 3 * (uint32_t)m->triangles;
    for (uint32_t i = 0; i + 1 < sides; i++) {
        const uint32_t side = b->sides[i];
        if (!mesh_same_edge(m, side, b->sides[i + 1]))
            continue;
        const half_hinge p = half_hinge_at(b, side), q = half_hinge_at(b, b->sides[i + 1]);
        out->valid &= p.opposite != q.opposite && !(i + 2 < sides && mesh_same_edge(m, side, b->sides[i + 2]));
        const double area = p.area + q.area, w0 = p.upper + q.upper, w2 = -(p.lower + p.upper),
                     w3 = -(q.lower + q.upper);
        if (area > 0)
            append(out, (spring_weighted_link){
                            .particle = {mesh_lower_end(m, side), mesh_upper_end(m, side), p.opposite, q.opposite},
                            .weight = {w0, -(w0 + w2 + w3), w2, w3},
                            .stiffness = b->rigidity / area});
    }
}

spring_status spring_bend_mesh(size_t particles, const double *position, size_t triangles, const uint32_t *triangle,
                               const uint8_t *pinned, double rigidity, double damping_time, spring_weighted_link *out,
                               size_t *count, uint32_t *work)
{
    bend_model b = {.rigidity = rigidity, .pinned = pinned, .mesh = {particles, triangles, position, triangle, NULL}};
    if (count == NULL || work == NULL)
        return SPRING_EINVAL;
    const spring_status status = spring_mesh_check(&b.mesh);
    if (status != SPRING_OK || !spring_mesh_has_areas(&b.mesh))
        return status != SPRING_OK ? status : SPRING_EINVAL;
    b.sides = spring_mesh_sort_sides(&b.mesh, work);
    return make_links(&b, bend_mesh, damping_time, out, count);
}

#include "../simd/size_end.h"
