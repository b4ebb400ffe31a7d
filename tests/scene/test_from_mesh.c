/* SPDX-License-Identifier: MIT */
/* Particles and links of triangle meshes: a mesh that is split at seams and shuffled becomes the mesh that it was. Errors
   of the functions that make links, and tethers in renumbered meshes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/scene.h>

#include "check.h"

enum { most = 1200, most_triangles = 900, most_links = 3 * most_triangles };

typedef struct mesh {
    size_t vertices, triangles;
    double position[3 * most];
    uint32_t triangle[3 * most_triangles];
} mesh;

typedef struct result {
    size_t particles, links;
    uint32_t particle_of[most + 1];
    spring_link link[most_links + 1];
} result;

static uint32_t below(size_t n)
{
    return (uint32_t)(random_bits() % n);
}

static double distance(const double *x, const double *y)
{
    return sqrt((x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) + (x[2] - y[2]) * (x[2] - y[2]));
}

static spring_status read_mesh(const mesh *m, double weld, result *r)
{
    static uint32_t work[3 * most + 6 * most_triangles + 2];
    const size_t needed = 3 * m->vertices + 6 * m->triangles + 1;
    const uint32_t garbage = 0x5a5a5a5a;
    memset(work, 0x5a, sizeof work);
    r->particle_of[m->vertices] = garbage;
    r->links = 3 * m->triangles;
    const spring_status status = spring_links_from_mesh(m->vertices, m->position, m->triangles, m->triangle, weld,
                                                        r->particle_of, &r->particles, r->link, &r->links, work);
    CHECK(work[needed] == garbage && r->particle_of[m->vertices] == garbage, "nothing behind the arrays is written");
    return status;
}

/* A sheet, or a closed strip, with some holes and some particles without triangles, at random places. */
static void make_mesh(mesh *m)
{
    const uint32_t nx = 3 + below(12), ny = 2 + below(12);
    const bool closed = below(2) != 0;
    m->vertices = nx * ny + below(4);
    m->triangles = 0;
    for (size_t i = 0; i < m->vertices; i++) {
        m->position[3 * i] = (double)(i % nx) + random_uniform(-0.3, 0.3);
        m->position[3 * i + 1] = (double)(i / nx) + random_uniform(-0.3, 0.3);
        m->position[3 * i + 2] = random_uniform(-0.3, 0.3);
    }
    for (uint32_t j = 0; j + 1 < ny; j++)
        for (uint32_t i = 0; i + 1 < nx + closed; i++) {
            const uint32_t a = j * nx + i, b = j * nx + (i + 1) % nx, c = a + nx, d = b + nx;
            const uint32_t corners[6] = {a, b, d, a, d, c};
            if (below(8) == 0)
                continue;
            memcpy(&m->triangle[3 * m->triangles], corners, sizeof corners);
            m->triangles += 2;
        }
}

/* Splits vertices, each by at most half of `weld`, and puts vertices and triangles in random order. origin[new] = old. */
static void split(const mesh *m, double weld, mesh *to, uint32_t *origin)
{
    static uint32_t number[most], copy[3 * most_triangles];
    size_t count = 0;
    for (uint32_t i = 0; i < m->vertices; i++)
        origin[count++] = i;
    for (size_t i = 0; i < 3 * m->triangles; i++) {
        copy[i] = m->triangle[i];
        if (count < most && below(3) == 0) {
            copy[i] = (uint32_t)count;
            origin[count++] = m->triangle[i];
        }
    }
    for (size_t i = 0; i < count; i++) {
        const size_t j = below(i + 1);
        number[i] = number[j];
        number[j] = (uint32_t)i;
    }
    static uint32_t old[most];
    memcpy(old, origin, count * sizeof *old);
    for (size_t i = 0; i < count; i++) {
        origin[number[i]] = old[i];
        for (size_t a = 0; a < 3; a++)
            to->position[3 * number[i] + a] = m->position[3 * old[i] + a] + random_uniform(-0.28, 0.28) * weld;
    }
    to->vertices = count;
    to->triangles = 0;
    for (size_t i = 0; i < m->triangles; i++) { /* in random order, from any corner, some turned over */
        const size_t at = below(i + 1), turn = below(3), back = below(2);
        memcpy(&to->triangle[3 * i], &to->triangle[3 * at], 3 * sizeof *copy);
        for (size_t k = 0; k < 3; k++)
            to->triangle[3 * at + k] = number[copy[3 * i + (turn + (back ? 3 - k : k)) % 3]];
        to->triangles++;
    }
}

static int by_ends(const void *left, const void *right)
{
    const spring_link *l = left, *r = right;
    return l->a != r->a ? (l->a > r->a) - (l->a < r->a) : (l->b > r->b) - (l->b < r->b);
}

static void split_meshes_are_welded(void)
{
    static mesh m, cut;
    static result whole, r;
    static uint32_t origin[most], first[most], number[most];
    static spring_link expected[most_links];
    for (int i = 0; i < 300; i++) {
        const double weld = i % 2 == 0 ? 0 : random_log(1e-9, 1e-2);
        make_mesh(&m);
        CHECK(read_mesh(&m, -1, &whole) == SPRING_OK && whole.particles == m.vertices, "each vertex is a particle");
        split(&m, weld, &cut, origin);
        CHECK(read_mesh(&cut, weld, &r) == SPRING_OK && r.particles == m.vertices && r.links == whole.links,
              "as many particles and links as before");
        uint32_t next = 0;
        memset(first, -1, sizeof first);
        for (uint32_t v = 0; v < cut.vertices; v++) {
            if (first[origin[v]] == UINT32_MAX) {
                first[origin[v]] = v;
                number[origin[v]] = next++;
            }
            CHECK(r.particle_of[v] == number[origin[v]], "numbered in the order of their first vertices");
        }
        for (size_t l = 0; l < whole.links; l++) {
            const uint32_t a = whole.link[l].a, b = whole.link[l].b;
            const uint32_t lower = number[a] < number[b] ? number[a] : number[b];
            expected[l] = (spring_link){.a = lower, .b = number[a] + number[b] - lower, .stiffness = 1};
            expected[l].rest = distance(&cut.position[3 * first[a]], &cut.position[3 * first[b]]);
        }
        qsort(expected, whole.links, sizeof *expected, by_ends);
        for (size_t l = 0; l < whole.links; l++) {
            CHECK(by_ends(&expected[l], &r.link[l]) == 0 && r.link[l].damping == 0 && r.link[l].stiffness == 1 &&
                      r.link[l].flags == 0 && r.link[l].a < r.link[l].b,
                  "the same edges, each once, in order");
            CHECK_CLOSE(r.link[l].rest, expected[l].rest, 1e-15 * expected[l].rest,
                        "the distance of the first vertices");
        }
        CHECK(read_mesh(&cut, -1, &r) == SPRING_OK && r.particles == cut.vertices && r.links >= whole.links,
              "without welding it falls apart");
    }
}

/* Clouds in which many vertices are about as far from each other as they may be, also far from the origin. */
static void welding_is_greedy(void)
{
    static mesh m;
    static result r;
    for (int i = 0; i < 200; i++) {
        const double weld = i % 8 == 0 ? 0 : random_log(1e-12, 1e3), size = weld * random_uniform(0.5, 20);
        const double shift = below(2) ? 0 : random_log(1, 1e15) * (weld + 1e-3);
        uint32_t particles = 0;
        m.vertices = 300;
        m.triangles = 0;
        for (size_t v = 0; v < 3 * m.vertices; v++)
            m.position[v] = shift + (weld > 0 ? random_uniform(-size, size) : (below(4) - 1.0) * 0.1);
        for (size_t v = 0; v < 3 * m.vertices && (weld == 0 || shift == 0); v++) /* zeros of both signs */
            if (m.position[v] == 0 || (weld > 0 && below(8) == 0))
                m.position[v] = below(2) ? -0.0 : 0.0;
        CHECK(read_mesh(&m, weld, &r) == SPRING_OK && r.links == 0, "vertices alone");
        static uint32_t first[most];
        for (uint32_t v = 0; v < m.vertices; v++) {
            uint32_t p = 0;
            while (p < particles && !(distance(&m.position[3 * v], &m.position[3 * first[p]]) <= weld))
                p++;
            if (p == particles)
                first[particles++] = v;
            CHECK(r.particle_of[v] == p, "the first particle near enough, or a new one");
        }
        CHECK(r.particles == particles, "no others");
    }
}

/* Nothing is written but the count, and that only if there is no room. */
static void invalid_meshes(void)
{
    static mesh m, good;
    static result r, before;
    static spring_weighted_link bend[64];
    static uint32_t work[1000];
    good = (mesh){.vertices = 5,
                  .triangles = 3,
                  .position = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0},
                  .triangle = {0, 1, 2, 1, 3, 2, 1, 4, 3}};
    m = good;
    CHECK(read_mesh(&m, 0, &r) == SPRING_OK && r.links == 7, "a valid mesh");
    size_t count = 64;
    CHECK(spring_bend_mesh(5, m.position, 3, m.triangle, NULL, 1, 0, bend, &count, work) == SPRING_OK && count == 2,
          "two inner edges");
    typedef struct row {
        uint32_t corner; /* this is changed, or else the position */
        uint32_t vertex;
        double x;
        double weld;
        spring_status links, bends;
    } row;
    static const row rows[] = {
        {3, 5, 0, 0, SPRING_ERANGE, SPRING_ERANGE},        /* no such vertex */
        {3, 2, 0, 0, SPRING_EINVAL, SPRING_EINVAL},        /* two equal corners */
        {3, 4, 0, 0, SPRING_EINVAL, SPRING_EINVAL},        /* three vertices on a line */
        {4, 0, 0, 0, SPRING_OK, SPRING_EINVAL},            /* twice the same triangle, turned over */
        {8, 2, 0, 0, SPRING_OK, SPRING_EINVAL},            /* three triangles at an edge */
        {9, 0, 1, 0, SPRING_EINVAL, SPRING_EINVAL},        /* two vertices of a triangle at one place */
        {9, 0, NAN, 0, SPRING_EINVAL, SPRING_EINVAL},      /* positions */
        {9, 4, INFINITY, 0, SPRING_EINVAL, SPRING_EINVAL}, /* positions */
        {9, 0, -1e300, 0, SPRING_EINVAL, SPRING_EINVAL},   /* an area that overflows */
        {9, 0, 0, NAN, SPRING_EINVAL, SPRING_OK},          /* weld */
        {9, 0, 0, INFINITY, SPRING_EINVAL, SPRING_OK},     /* weld */
        {9, 0, 0, 1, SPRING_EINVAL, SPRING_OK},            /* welding leaves no triangles */
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        m = good;
        if (rows[i].corner < 9)
            m.triangle[rows[i].corner] = rows[i].vertex;
        else
            m.position[3 * rows[i].vertex] = rows[i].x;
        memset(&r, 0x33, sizeof r);
        before = r;
        const spring_status status = read_mesh(&m, rows[i].weld, &r);
        CHECK(status == rows[i].links, "the status of a mesh");
        if (status != SPRING_OK) {
            before.links = 3 * m.triangles;
            before.particle_of[m.vertices] = r.particle_of[m.vertices];
            CHECK(memcmp(&r, &before, sizeof r) == 0, "nothing is written");
        }
        memset(bend, 0x33, sizeof bend);
        count = 64;
        const spring_weighted_link untouched = bend[0];
        const spring_status bends = spring_bend_mesh(5, m.position, 3, m.triangle, NULL, 1, 0, bend, &count, work);
        CHECK(bends == rows[i].bends, "the status of bending");
        CHECK(bends == SPRING_OK || (count == 64 && memcmp(bend, &untouched, sizeof untouched) == 0),
              "nothing is written");
    }
    m = good;
    r.links = 6;
    memset(r.link, 0x33, sizeof r.link);
    before = r;
    before.links = 7;
    CHECK(spring_links_from_mesh(5, m.position, 3, m.triangle, 0, r.particle_of, &r.particles, r.link, &r.links,
                                 work) == SPRING_ENOMEM &&
              memcmp(&r, &before, sizeof r) == 0,
          "too small: only the number that is needed");
    r.links = 0;
    CHECK(spring_links_from_mesh(5, m.position, 3, m.triangle, 0, NULL, NULL, NULL, &r.links, work) == SPRING_OK &&
              r.links == 7,
          "counts");
    CHECK(spring_links_from_mesh(5, NULL, 3, m.triangle, 0, NULL, NULL, NULL, &r.links, work) == SPRING_EINVAL &&
              spring_links_from_mesh(5, m.position, 3, NULL, 0, NULL, NULL, NULL, &r.links, work) == SPRING_EINVAL &&
              spring_links_from_mesh(5, m.position, 3, m.triangle, 0, NULL, NULL, NULL, NULL, work) == SPRING_EINVAL &&
              spring_links_from_mesh(5, m.position, 3, m.triangle, 0, NULL, NULL, NULL, &r.links, NULL) ==
                  SPRING_EINVAL &&
              spring_links_from_mesh(5, m.position, 3, m.triangle, 0, NULL, &r.particles, r.link, &r.links, work) ==
                  SPRING_EINVAL &&
              spring_links_from_mesh(UINT32_MAX, m.position, 0, m.triangle, 0, NULL, NULL, NULL, &r.links, work) ==
                  SPRING_ERANGE,
          "NULL, and too many");
    CHECK(spring_links_from_mesh(0, NULL, 0, NULL, 0, NULL, NULL, NULL, &r.links, work) == SPRING_OK && r.links == 0,
          "nothing at all");
}

static void invalid_bending(void)
{
    static spring_weighted_link bend[64], before[64];
    const double x[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0};
    const double equal[9] = {0}, far[] = {0, 0, 0, 1e300, 0, 0, 1, 0, 0};
    const spring_grid sheet = {.count = {4, 3}, .spacing = 1}, rope = {.count = {9}, .spacing = 1},
                      block = {.count = {3, 3, 3}, .spacing = 1}, wrong = {.count = {4, 3}, .spacing = -1};
    const uint32_t both = SPRING_BEND_ROWS | SPRING_BEND_DIAGONALS;
    size_t n = 3;
    memset(bend, 0x33, sizeof bend);
    memcpy(before, bend, sizeof bend);
    const struct {
        spring_status got, want;
    } calls[] = {
        {spring_bend_rod(5, 3, NULL, NULL, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_rod(5, 3, x, NULL, 1, 0, bend, NULL), SPRING_EINVAL},
        {spring_bend_rod(5, 4, x, NULL, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_rod(5, 3, x, NULL, -1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_rod(5, 3, x, NULL, NAN, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_rod(5, 3, x, NULL, 1, -1, bend, &n), SPRING_EINVAL},
        {spring_bend_rod(5, 3, x, NULL, 1, INFINITY, bend, &n), SPRING_EINVAL},
        {spring_bend_rod(5, 3, x, NULL, 1e308, 0, bend, &n), SPRING_EINVAL}, /* the stiffness overflows */
        {spring_bend_rod(3, 3, equal, NULL, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_rod(3, 3, far, NULL, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_grid(NULL, NULL, both, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_grid(&sheet, NULL, both, 1, 0, bend, NULL), SPRING_EINVAL},
        {spring_bend_grid(&rope, NULL, both, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_grid(&block, NULL, both, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_grid(&wrong, NULL, both, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_grid(&sheet, NULL, 0, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_grid(&sheet, NULL, SPRING_BEND_DIAGONALS, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_grid(&sheet, NULL, both | 4, 1, 0, bend, &n), SPRING_EINVAL},
        {spring_bend_mesh(5, x, 0, NULL, NULL, 1, 0, bend, &n, NULL), SPRING_EINVAL},
    };
    CHECK(n == 3, "no count");
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++)
        CHECK(calls[i].got == calls[i].want, "the status of a call");
    n = 2;
    CHECK(spring_bend_rod(5, 3, x, NULL, 1, 0, bend, &n) == SPRING_ENOMEM && n == 3, "the number that is needed");
    n = 0;
    CHECK(spring_bend_grid(&sheet, NULL, both, 1, 0, bend, &n) == SPRING_ENOMEM && n == 2 * 3 + 4 + 2 * 2, "the same");
    n = 0;
    CHECK(spring_bend_grid(&sheet, NULL, both, 1, 0, NULL, &n) == SPRING_OK && n == 14, "counts");
    CHECK(memcmp(bend, before, sizeof bend) == 0, "nothing is written");
    n = 64;
    CHECK(spring_bend_rod(2, 3, x, NULL, 1, 0, bend, &n) == SPRING_OK && n == 0, "one segment does not bend");
    n = 64;
    CHECK(spring_bend_rod(5, 3, x, (const uint8_t[]){1, 1, 1, 1, 0}, 2, 0, bend, &n) == SPRING_OK && n == 1 &&
              bend[0].particle[0] == 2 && bend[0].stiffness == 2 * 8,
          "no links between pinned particles only; at the clamp twice as stiff");
}

/* Tethers are renumbered and sorted, and change nothing else. */
static void renumbering_with_tethers(void)
{
    static uint32_t order[2][400], work[4 * 400 + 2 * 3000 + 1], piece[400];
    static spring_link link[2][3000];
    const spring_grid g = {.count = {20, 20}, .spacing = 0.1, .stiffness = 1, .families = SPRING_GRID_STRUCTURAL};
    static double x[3 * 400];
    size_t particles, links;
    spring_grid_size(&g, &particles, &links);
    spring_grid_fill(&g, x, NULL, link[0]);
    memcpy(link[1], link[0], sizeof link[0]);
    for (uint32_t i = 0; i < 400; i++)
        link[1][links + i] = (spring_link){i, (i + 7) % 400, i % 2 ? 0 : 0.01, 1, 0, SPRING_LINK_TETHER};
    CHECK(spring_links_renumber(particles, links, link[0], order[0], NULL, work) == SPRING_OK &&
              spring_links_renumber(particles, links + 400, link[1], order[1], NULL, work) == SPRING_OK,
          "valid");
    CHECK(memcmp(order[0], order[1], sizeof order[0]) == 0, "the same numbering");
    size_t kept = 0;
    for (size_t i = 0; i < links + 400; i++)
        if (link[1][i].flags == 0)
            CHECK(memcmp(&link[1][i], &link[0][kept++], sizeof(spring_link)) == 0, "the same links in the same order");
    CHECK(kept == links, "all of them");
    CHECK(spring_links_components(particles, 400, &link[1][links], piece) > 0 &&
              spring_links_components(particles, links + 400, link[1], piece) == 1,
          "one piece");
    for (size_t i = 0; i < links + 400; i++)
        link[1][i].stiffness = link[1][i].flags == 0 ? 0 : 1;
    CHECK(spring_links_components(particles, links + 400, link[1], piece) == particles, "tethers join nothing");
}

int main(void)
{
    static const test tests[] = {
        {"split meshes are welded", split_meshes_are_welded},
        {"welding is greedy", welding_is_greedy},
        {"invalid meshes", invalid_meshes},
        {"invalid bending", invalid_bending},
        {"renumbering with tethers", renumbering_with_tethers},
    };
    return RUN_TESTS("from_mesh", tests);
}
