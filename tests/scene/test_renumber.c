/* SPDX-License-Identifier: MIT */
/*
 * Renumbering: the result is the same mesh with other numbers, sorted. Ropes and sheets get their bands back, other
 * meshes the numbering of Cuthill and McKee. The motion of a scene is bit-identical.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/scene.h>

#include "check.h"

enum { most_particles = 1300, most_links = 8000, most_work = 4 * most_particles + 2 * most_links + 1 };

typedef struct model {
    size_t particles, links;
    spring_link link[most_links];
} model;

typedef struct renumbered {
    spring_link link[most_links];
    uint32_t order[most_particles], link_order[most_links];
} renumbered;

static double position[3 * most_particles];

static uint32_t below(size_t n)
{
    return (uint32_t)(random_bits() % n);
}

static void join(model *m, size_t a, size_t b, double rest)
{
    m->link[m->links] = (spring_link){(uint32_t)a, (uint32_t)b, rest, 2.7 + (double)m->links, 0.6, 0};
    m->links++;
}

/* ----------------------------------------------------------------------------------------- what is to be renumbered */

static void sheet(model *m, uint32_t x, uint32_t y, uint32_t z, uint32_t families, bool height)
{
    const spring_grid g = {
        .count = {x, y, z}, .height = height, .spacing = 0.1, .families = families, .stiffness = 2.7};
    spring_grid_size(&g, &m->particles, &m->links);
    spring_grid_fill(&g, position, NULL, m->link);
    for (size_t i = 0; i < m->links; i++)
        m->link[i].stiffness += (double)i;
}

static void one(model *m)
{
    m->particles = 1;
}

static void nothing(model *m)
{
    m->particles = 0;
}

static void pair(model *m)
{
    m->particles = 2;
    join(m, 1, 0, 0.3);
}

static void rope(model *m)
{
    sheet(m, 300, 1, 1, SPRING_GRID_STRUCTURAL, false);
}

/* Each link with any of three lengths. */
static void uneven(model *m)
{
    rope(m);
    for (size_t i = 0; i < m->links; i++)
        m->link[i].rest = (const double[]){0.3, 0.36, 0.45}[below(3)];
}

/* Two ropes, a ring, and some particles that nothing is joined to. */
static void apart(model *m)
{
    m->particles = 100;
    for (size_t i = 0; i < 90; i++)
        if (i != 29 && i != 59)
            join(m, i, i + 1 == 90 ? 60 : i + 1, 0.2);
}

static void twice(model *m)
{
    rope(m);
    for (size_t i = 0; i < 299; i++)
        join(m, m->link[i].b, m->link[i].a, 0.1 * (double)(i % 3));
}

static void star(model *m)
{
    m->particles = 700;
    for (size_t i = 1; i < m->particles; i++)
        join(m, i % 2 == 0 ? 0 : i, i % 2 == 0 ? i : 0, 0.3);
}

static void random_graph(model *m)
{
    m->particles = 400;
    for (int i = 0; i < 1500; i++) {
        const uint32_t a = below(400);
        join(m, a, (a + 1 + below(399)) % 400, random_uniform(0, 1));
    }
}

/* Lengths that no scene takes are no reason to fall. */
static void odd_lengths(model *m)
{
    const double length[] = {-1, INFINITY, NAN, 0, -INFINITY};
    rope(m);
    for (size_t i = 0; i < m->links; i++)
        m->link[i].rest = length[i % 5];
}

/* Rows and columns whose lengths differ by less than a quarter. */
static void oblong(model *m)
{
    sheet(m, 20, 20, 1, SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR, false);
    for (size_t i = 0; i < m->links; i++)
        if (m->link[i].b - m->link[i].a == 20)
            m->link[i].rest *= 1.24;
}

/* Bounds: what numbering by rows gives, whichever way the rows run; where the lengths of links do not tell the rows,
   a link joins particles of the same level or of neighbouring ones, and a level is at most two diagonals. */
typedef struct row {
    void (*make)(model *m); /* NULL: a grid */
    uint32_t bandwidth;     /* at most */
    size_t offsets;         /* at most; 0: as many as there are */
    uint32_t count[3], families;
    bool height;
} row;

enum {
    structural = SPRING_GRID_STRUCTURAL,
    sheared = structural | SPRING_GRID_SHEAR,
    all = sheared | SPRING_GRID_BEND
};

static const row rows[] = {
    {.make = nothing},
    {.make = one},
    {pair, 1, 1, {0}, 0, 0},
    {rope, 1, 1, {0}, 0, 0},
    {uneven, 1, 1, {0}, 0, 0},
    {apart, 15, 3, {0}, 0, 0}, /* of the ring one half, then the other */
    {twice, 1, 1, {0}, 0, 0},
    {star, 699, 0, {0}, 0, 0},
    {random_graph, 399, 0, {0}, 0, 0},
    {odd_lengths, 1, 1, {0}, 0, 0},
    {NULL, 33, 2, {33, 21, 1}, structural, false},
    {NULL, 31 + 1, 4, {20, 31, 1}, sheared, false},
    {NULL, 2 * 35, 6, {35, 35, 1}, all, false},
    {oblong, 20 + 1, 4, {0}, 0, 0},
    {NULL, 30, 2, {30, 24, 1}, structural, true},
    {NULL, 4 * 24, 0, {30, 24, 1}, all, true},
    {NULL, 4 * 56, 0, {9, 8, 7}, all, false},
    {NULL, 2 * 5, 6, {5, 5, 1}, all, false}, /* so small that levels are tried, too */
};

enum { row_count = sizeof rows / sizeof rows[0] };

/* Numbers the particles at random, puts the links in random order and turns some round. new_number[old] is written. */
static void shuffle(model *m, uint32_t *new_number)
{
    for (size_t i = 0; i < m->particles; i++) {
        const uint32_t j = below(i + 1);
        new_number[i] = new_number[j];
        new_number[j] = (uint32_t)i;
    }
    for (size_t i = 0; i < m->links; i++) {
        const uint32_t a = new_number[m->link[i].a], b = new_number[m->link[i].b];
        const bool turn = below(2) != 0;
        m->link[i].a = turn ? b : a;
        m->link[i].b = turn ? a : b;
    }
    for (size_t i = m->links; i > 1; i--) {
        const size_t j = below(i);
        const spring_link kept = m->link[i - 1];
        m->link[i - 1] = m->link[j];
        m->link[j] = kept;
    }
}

static model *make(const row *r)
{
    static model m;
    static uint32_t number[most_particles];
    memset(&m, 0, sizeof m);
    if (r->make != NULL)
        r->make(&m);
    else
        sheet(&m, r->count[0], r->count[1], r->count[2], r->families, r->height);
    shuffle(&m, number);
    return &m;
}

/* With work that holds anything before; nothing behind what is needed is touched. */
static renumbered *renumber(const model *m, int garbage, bool with_links)
{
    renumbered *r = malloc(sizeof *r);
    uint32_t *work = malloc(most_work * sizeof *work);
    memset(work, garbage, most_work * sizeof *work);
    memset(r, garbage, sizeof *r);
    memcpy(r->link, m->link, m->links * sizeof *r->link);
    CHECK(spring_links_renumber(m->particles, m->links, r->link, r->order, with_links ? r->link_order : NULL, work) ==
              SPRING_OK,
          "valid links");
    uint32_t untouched;
    memset(&untouched, garbage, sizeof untouched);
    const size_t needed = 4 * m->particles + 2 * m->links + 1;
    CHECK(work[needed] == untouched && r->order[m->particles] == untouched &&
              r->link_order[with_links ? m->links : 0] == untouched,
          "nothing behind the arrays is written");
    free(work);
    return r;
}

/* ------------------------------------------------------------------------------------------------------- properties */

static bool is_permutation(const uint32_t *order, size_t count)
{
    static uint8_t seen[most_links];
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < count; i++) {
        if (order[i] >= count || seen[order[i]] != 0)
            return false;
        seen[order[i]] = 1;
    }
    return true;
}

static uint32_t lower(const spring_link *l)
{
    return l->a < l->b ? l->a : l->b;
}

static uint32_t upper(const spring_link *l)
{
    return l->a < l->b ? l->b : l->a;
}

static void the_same_links_in_order(void)
{
    for (size_t i = 0; i < 5 * row_count; i++) {
        const model *m = make(&rows[i % row_count]);
        renumbered *r = renumber(m, 0x5a, true);
        CHECK(is_permutation(r->order, m->particles), "every particle once");
        CHECK(is_permutation(r->link_order, m->links), "every link once");
        for (size_t l = 0; l < m->links; l++) {
            spring_link back = r->link[l];
            back.a = r->order[back.a];
            back.b = r->order[back.b];
            CHECK(memcmp(&back, &m->link[r->link_order[l]], sizeof back) == 0, "the link it was, from a to b");
            if (l == 0)
                continue;
            const spring_link *before = &r->link[l - 1], *now = &r->link[l];
            CHECK(lower(before) < lower(now) || (lower(before) == lower(now) && upper(before) <= upper(now)), "sorted");
            if (lower(before) == lower(now) && upper(before) == upper(now))
                CHECK(r->link_order[l - 1] < r->link_order[l], "several between two particles stay in their order");
        }
        free(r);
    }
}

typedef struct offsets {
    size_t count; /* of different ones */
    uint64_t sum; /* over the links */
    uint32_t greatest;
} offsets;

static offsets offsets_of(const spring_link *link, size_t links)
{
    bool seen[most_particles] = {false};
    offsets o = {0, 0, 0};
    for (size_t l = 0; l < links; l++) {
        const uint32_t offset = upper(&link[l]) - lower(&link[l]);
        o.count += !seen[offset];
        o.sum += offset;
        o.greatest = offset > o.greatest ? offset : o.greatest;
        seen[offset] = true;
    }
    return o;
}

static offsets renumbered_offsets(const model *m)
{
    renumbered *r = renumber(m, 0, true);
    const offsets o = offsets_of(r->link, m->links);
    free(r);
    return o;
}

static void few_offsets(void)
{
    for (size_t i = 0; i < row_count; i++)
        for (int times = 0; times < 5; times++) {
            const offsets o = renumbered_offsets(make(&rows[i]));
            CHECK_BELOW(o.greatest, rows[i].bandwidth, "rows, or two levels");
            if (rows[i].offsets != 0)
                CHECK_BELOW((double)o.count, (double)rows[i].offsets, "one for each direction of links");
        }
}

/* Whatever their number and shape: the offsets are those of the sheet as it was, or as it is with x and y swapped. */
static void sheets_get_their_rows_back(void)
{
    static model m, swapped;
    static uint32_t number[most_particles];
    for (uint32_t x = 2; x < 14; x++)
        for (uint32_t y = 2; y < 14; y++)
            for (uint32_t families = structural; families <= all; families += all - structural) {
                if (families == all && x * y < 6 * 6) /* so small that offsets may be fewer than directions of links */
                    continue;
                sheet(&swapped, y, x, 1, families, false);
                sheet(&m, x, y, 1, families, false);
                const offsets one_way = offsets_of(m.link, m.links), other = offsets_of(swapped.link, m.links);
                shuffle(&m, number);
                const offsets o = renumbered_offsets(&m);
                CHECK((o.count == one_way.count && o.sum == one_way.sum) ||
                          (o.count == other.count && o.sum == other.sum),
                      "rows");
            }
}

/* Links up to 5/4 of the shortest make rows, and no others. */
static void rows_are_of_the_shortest_links(void)
{
    static model m;
    static uint32_t number[most_particles];
    const double shortest = 0.5, longest = 0.625;
    for (int times = 0; times < 3; times++) {
        sheet(&m, 20, 30, 1, SPRING_GRID_STRUCTURAL, false);
        for (size_t i = 0; i < m.links; i++)
            if (upper(&m.link[i]) - lower(&m.link[i]) == 1)
                m.link[i].rest = shortest;
            else
                m.link[i].rest = times == 1 ? nextafter(longest, 1) : longest;
        shuffle(&m, number);
        if (times == 2)
            m.link[0].rest = shortest / 2; /* there is no other */
        const size_t count = renumbered_offsets(&m).count;
        CHECK(times == 0 ? count == 2 : count > 2, "rows, if those links belong to them");
    }
}

/* -------------------------------------------------------------------------------------- where there are no rows */

/* A tree of which no part has links of the same length, and more links. */
static void tree(model *m, size_t particles, size_t more)
{
    memset(m, 0, sizeof *m);
    m->particles = particles;
    for (size_t i = 1; i < particles; i++)
        join(m, i, below(i), random_uniform(1, 100));
    for (size_t i = 0; i < more; i++) {
        const uint32_t a = 1 + below(particles - 1);
        join(m, a, below(a), random_uniform(1, 100));
    }
}

typedef struct breadth_first {
    uint32_t parent[most_particles]; /* the first of all neighbours */
    uint32_t degree[most_particles];
} breadth_first;

static breadth_first parents_of(const model *m, const spring_link *link)
{
    breadth_first b = {{0}, {0}};
    memset(b.parent, -1, sizeof b.parent);
    for (size_t l = 0; l < m->links; l++) {
        const uint32_t low = lower(&link[l]), high = upper(&link[l]);
        b.degree[low]++;
        b.degree[high]++;
        b.parent[high] = low < b.parent[high] ? low : b.parent[high];
    }
    return b;
}

/* In a tree, if the first and the last have the greatest distance of all. */
static bool ends_of_a_diameter(const breadth_first *b, uint32_t particles)
{
    uint32_t distance[most_particles], farthest = 0;
    memset(distance, -1, sizeof distance);
    uint32_t depth = 0;
    for (uint32_t v = particles - 1; v > 0; v = b->parent[v])
        distance[v] = depth++;
    distance[0] = depth;
    for (uint32_t v = 1; v < particles; v++) {
        if (distance[v] == UINT32_MAX)
            distance[v] = distance[b->parent[v]] + 1;
        farthest = distance[v] > farthest ? distance[v] : farthest;
    }
    return farthest <= depth;
}

static void numbered_as_by_cuthill_and_mckee(void)
{
    static model m;
    for (size_t particles = 200; particles < 400; particles += 10)
        for (size_t more = 0; more <= particles; more += particles / 2) {
            tree(&m, particles, more);
            renumbered *r = renumber(&m, 0, true);
            const breadth_first b = parents_of(&m, r->link);
            for (uint32_t v = 1; v < particles; v++) {
                CHECK(b.parent[v] < v, "next to one that has a number");
                if (v == 1)
                    continue;
                CHECK(b.parent[v - 1] <= b.parent[v], "breadth first");
                CHECK(b.parent[v - 1] < b.parent[v] || b.degree[v - 1] <= b.degree[v], "by ascending degree");
            }
            if (more == 0)
                CHECK(ends_of_a_diameter(&b, (uint32_t)particles), "from a particle at the rim");
            free(r);
        }
}

/* Of a rope whose links are long and short in turn the short ones alone make many offsets, all of them make one. Single
   particles change neither, but there are so many that the offsets count as few, if there are as many links. Links that are
   there twice change nothing else. */
static void levels_where_offsets_are_many(void)
{
    static model m;
    static uint32_t number[most_particles];
    for (int times = 0; times < 50; times++) {
        memset(&m, 0, sizeof m);
        m.particles = 30;
        for (size_t i = 0; i + 1 < m.particles; i++)
            join(&m, i, i + 1, i % 2 == 0 ? 0.3 : 0.7);
        shuffle(&m, number);
        m.particles = most_particles - 1;
        CHECK(renumbered_offsets(&m).count == 1, "a rope, with its links alone");
        for (size_t i = 0; m.links < m.particles; i++)
            m.link[m.links++] = m.link[i];
        const size_t many = renumbered_offsets(&m).count;
        CHECK(many > 5, "the test sees a difference");
        m.particles = many * many;
        CHECK(renumbered_offsets(&m).count == many, "few enough");
        m.particles = many * many - 1;
        CHECK(renumbered_offsets(&m).count == 1, "too many");
    }
}

static void the_same_each_time(void)
{
    for (size_t i = 0; i < row_count; i++) {
        const model *m = make(&rows[i]);
        renumbered *first = renumber(m, 0, true), *again = renumber(m, -1, false);
        CHECK(memcmp(first->order, again->order, m->particles * sizeof *first->order) == 0 &&
                  memcmp(first->link, again->link, m->links * sizeof *first->link) == 0,
              "what was in the arrays before makes no difference, nor whether the order of links is asked for");
        free(first);
        free(again);
    }
}

static void bad_input(void)
{
    const model *m = make(&rows[3]);
    static spring_link link[most_links];
    static uint32_t order[most_particles], link_order[most_links], work[most_work];
    static const uint32_t zero[most_work];
    const size_t particles = m->particles, links = m->links;
    struct {
        size_t link;
        uint32_t a, b;
        spring_status status;
    } bad[] = {
        {0, (uint32_t)particles, 0, SPRING_ERANGE},
        {links - 1, 0, (uint32_t)particles, SPRING_ERANGE},
        {links - 1, UINT32_MAX, 1, SPRING_ERANGE},
        {links / 2, 5, 5, SPRING_EINVAL},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        memcpy(link, m->link, links * sizeof *link);
        link[bad[i].link].a = bad[i].a;
        link[bad[i].link].b = bad[i].b;
        spring_link kept[most_links];
        memcpy(kept, link, sizeof kept);
        CHECK(spring_links_renumber(particles, links, link, order, link_order, work) == bad[i].status, "a bad link");
        CHECK(memcmp(kept, link, sizeof kept) == 0, "links stay");
    }
    memcpy(link, m->link, links * sizeof *link);
    CHECK(spring_links_renumber(particles, links, NULL, order, link_order, work) == SPRING_EINVAL &&
              spring_links_renumber(particles, 1, NULL, order, link_order, work) == SPRING_EINVAL &&
              spring_links_renumber(particles, links, link, NULL, link_order, work) == SPRING_EINVAL &&
              spring_links_renumber(particles, links, link, order, link_order, NULL) == SPRING_EINVAL,
          "NULL");
    link[0].a = link[0].b = 5; /* an error that shows that numbers are not too large */
    CHECK(spring_links_renumber(UINT32_MAX - 1, 1, link, order, link_order, work) == SPRING_EINVAL &&
              spring_links_renumber(particles, UINT32_MAX / 8, link, order, link_order, work) == SPRING_EINVAL,
          "as many as can be counted");
    CHECK(spring_links_renumber(UINT32_MAX, 0, link, order, link_order, work) == SPRING_ERANGE &&
              spring_links_renumber(particles, UINT32_MAX / 8 + 1, link, order, link_order, work) == SPRING_ERANGE,
          "too many to be counted");
    CHECK(memcmp(order, zero, sizeof order) == 0 && memcmp(link_order, zero, sizeof link_order) == 0 &&
              memcmp(work, zero, sizeof work) == 0,
          "nothing is written");
    CHECK(spring_links_renumber(3, 0, NULL, order, NULL, work) == SPRING_OK && is_permutation(order, 3),
          "no links, no array of them");
}

/* ------------------------------------------------------------------------------------------------------------ scenes */

static spring_scene *scene_of(size_t particles, size_t links, const spring_link *link, const double *x,
                              const uint8_t *pinned)
{
    const spring_scene_def def = {.particles = particles,
                                  .links = links,
                                  .position = x,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0.5, -10, 0.25}};
    size_t bytes;
    spring_scene *s = NULL;
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "a scene");
    CHECK(spring_scene_init(aligned_alloc(SPRING_SCENE_ALIGN, bytes), bytes, &def, &s) == SPRING_OK, "a scene");
    return s;
}

/* A particle adds up its forces in another order. So nothing is rounded here: lengths at rest are 0, which makes forces
   linear, and all numbers multiples of a power of 2, of which each step takes seven more, 2^7 being 2/dt^2: from forces
   below 2^10 to 2^-35, what a kick of the last step is a multiple of, are 45 bits. */
static void a_scene_moves_as_before(void)
{
    enum { steps = 4, x = 20, y = 15, particles = x * y };
    const double dt = 0.125;
    static model m;
    sheet(&m, x, y, 1, all, false);
    static uint32_t number[particles];
    static double before[3 * particles], after[3 * particles];
    uint8_t pinned[particles], pinned_after[particles];
    shuffle(&m, number);
    renumbered *r = renumber(&m, 0, true);
    for (size_t i = 0; i < 3 * particles; i++)
        before[i] = below(32) / 8.0;
    for (uint32_t i = 0; i < particles; i++)
        pinned[i] = below(10) == 0;
    for (size_t i = 0; i < m.links; i++) {
        m.link[i].rest = m.link[i].damping = 0;
        m.link[i].stiffness = 1 + below(4);
    }
    for (size_t i = 0; i < m.links; i++) {
        r->link[i].rest = r->link[i].damping = 0;
        r->link[i].stiffness = m.link[r->link_order[i]].stiffness;
    }
    for (uint32_t i = 0; i < particles; i++) {
        memcpy(&after[3 * i], &before[3 * r->order[i]], 3 * sizeof *after);
        pinned_after[i] = pinned[r->order[i]];
    }
    spring_scene *a = scene_of(particles, m.links, m.link, before, pinned);
    spring_scene *b = scene_of(particles, m.links, r->link, after, pinned_after);
    CHECK(spring_scene_advance(a, SPRING_LEAPFROG, dt, steps) == SPRING_OK &&
              spring_scene_advance(b, SPRING_LEAPFROG, dt, steps) == SPRING_OK,
          "they move");
    for (int q = SPRING_POSITION; q <= SPRING_VELOCITY; q++) {
        spring_scene_get(a, (spring_quantity)q, before, 0, 0, particles);
        spring_scene_get(b, (spring_quantity)q, after, 0, 0, particles);
        for (uint32_t i = 0; i < particles; i++)
            for (uint32_t axis = 0; axis < 3; axis++) {
                CHECK_BITS(after[3 * i + axis], before[3 * r->order[i] + axis], "nothing is rounded");
                if (q == SPRING_VELOCITY)
                    CHECK(pinned_after[i] != 0 || after[3 * i + axis] != 0, "the test sees a motion");
            }
    }
    free(a);
    free(b);
    free(r);
}

int main(void)
{
    static const test tests[] = {
        {"the same links in order", the_same_links_in_order},
        {"few offsets", few_offsets},
        {"sheets get their rows back", sheets_get_their_rows_back},
        {"rows are of the shortest links", rows_are_of_the_shortest_links},
        {"numbered as by Cuthill and McKee", numbered_as_by_cuthill_and_mckee},
        {"levels where offsets are many", levels_where_offsets_are_many},
        {"the same each time", the_same_each_time},
        {"bad input", bad_input},
        {"a scene moves as before", a_scene_moves_as_before},
    };
    return RUN_TESTS("renumber", tests);
}
