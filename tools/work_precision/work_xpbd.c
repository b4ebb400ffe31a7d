/* SPDX-License-Identifier: MIT */
/* XPBD in substeps, coloured and with SIMD; see work_xpbd.h. */
#include "work_xpbd.h"

#include "work_lanes.h"

enum { AXES = 3 };

/* Memory layouts of the ends of a block. All except the first are loaded and stored as whole vectors. */
typedef enum layout {
    SCATTERED,
    ROWS,  /* a and b each contiguous */
    PAIRS, /* abababab... */
    FOURS  /* aabbaabb... */
} layout;

/* Eight links of one colour, in four cache lines. Lanes without a link have shares of 0, so they change nothing. */
typedef struct block {
    uint32_t a[LANES], b[LANES];
    double rest[LANES];
    double share_a[LANES], share_b[LANES]; /* w_a and w_b over (1 + c) (w_a + w_b) + 1/(k h^2), for a substep of h */
} block;

typedef struct block_links { /* separate from the block, since substeps without damping do not read them */
    double stiffness[LANES], damping[LANES];
    double ratio[LANES]; /* c = damping/(k h) */
} block_links;

typedef struct group { /* blocks of one layout */
    size_t first, count;
    layout layout;
} group;

struct work_xpbd {
    size_t room, blocks, groups; /* room: particles, including unused lanes, in whole vectors */
    block *block;
    group *group;
    block_links *links;                    /* [blocks] */
    double *x[AXES], *old[AXES], *v[AXES]; /* [room] */
    double *inverse_mass, *moving, *decay; /* [room] moving: 1, or 0 if pinned; decay: 1/(1 + h drag/mass) */
    double *memory;
    double gravity[AXES], drag, h;
    bool damped;
};

bool work_xpbd_applies(const scene_problem *p)
{
    bool springs = p->def.axes == AXES && p->def.force == NULL && p->def.links > 0;
    for (size_t i = 0; i < p->def.links; i++)
        springs = springs && p->link[i].stiffness > 0;
    return springs;
}

/* ------------------------------------------------------------------------------------------------------ colours */

typedef struct coloured {
    uint32_t offset, colour, a, link;
} coloured;

static int by_colour(const void *left, const void *right)
{
    const coloured *l = left, *r = right;
    if (l->offset != r->offset)
        return l->offset < r->offset ? -1 : 1;
    if (l->colour != r->colour)
        return l->colour < r->colour ? -1 : 1;
    return l->a < r->a ? -1 : l->a > r->a;
}

/* Sorts the links by colour. Links with different offsets between their ends have different colours. A link gets the
   colour of the previous link if it is unused at both ends, otherwise the first unused colour. In a sheet, whole rows
   get one colour. */
static coloured *colour(const scene_problem *p)
{
    const size_t links = p->def.links;
    coloured *order = scene_room(links, sizeof *order);
    uint64_t *used = scene_room(p->def.particles, sizeof *used);
    for (size_t i = 0; i < links; i++) {
        const spring_link *l = &p->link[i];
        order[i] = (coloured){.offset = l->a < l->b ? l->b - l->a : l->a - l->b, .a = l->a, .link = (uint32_t)i};
    }
    qsort(order, links, sizeof *order, by_colour);
    for (size_t i = 0; i < links; i++) {
        if (i == 0 || order[i].offset != order[i - 1].offset)
            memset(used, 0, p->def.particles * sizeof *used);
        const spring_link *l = &p->link[order[i].link];
        const uint64_t taken = used[l->a] | used[l->b];
        if (i > 0 && order[i].offset == order[i - 1].offset)
            order[i].colour = order[i - 1].colour;
        if (taken >> order[i].colour & 1)
            for (order[i].colour = 0; taken >> order[i].colour & 1;)
                order[i].colour++; /* at most two links of one offset meet at a particle, so three colours suffice */
        used[l->a] |= UINT64_C(1) << order[i].colour;
        used[l->b] |= UINT64_C(1) << order[i].colour;
    }
    qsort(order, links, sizeof *order, by_colour);
    free(used);
    return order;
}

/* The offset of end a of lane j from end a of lane 0. */
static uint32_t lane_offset(layout at, uint32_t j)
{
    return at == ROWS ? j : at == PAIRS ? 2 * j : 4 * (j / 2) + j % 2;
}

static layout layout_of(uint32_t offset)
{
    return offset >= LANES ? ROWS : offset == 1 ? PAIRS : offset == 2 ? FOURS : SCATTERED;
}

/* The number of links from i that fit into a block. */
static size_t block_length(const scene_problem *p, const coloured *order, size_t i, layout at)
{
    const spring_link *first = &p->link[order[i].link];
    uint32_t n = 1;
    for (; n < LANES && i + n < p->def.links; n++) {
        const coloured *next = &order[i + n];
        const spring_link *l = &p->link[next->link];
        if (next->offset != order[i].offset || next->colour != order[i].colour ||
            (at != SCATTERED && (l->a != first->a + lane_offset(at, n) || l->b != first->b + lane_offset(at, n))))
            break;
    }
    return n;
}

static void fill_block(block *k, block_links *links, const scene_problem *p, const coloured *order, size_t count,
                       layout at)
{
    const uint32_t unused = (uint32_t)p->def.particles; /* and all above */
    const spring_link *first = &p->link[order[0].link];
    for (uint32_t j = 0; j < LANES; j++) {
        if (j < count) {
            const spring_link *l = &p->link[order[j].link];
            k->a[j] = l->a;
            k->b[j] = l->b;
            k->rest[j] = l->rest;
            links->stiffness[j] = l->stiffness;
            links->damping[j] = l->damping;
        } else {
            k->a[j] = at == SCATTERED ? unused + j : first->a + lane_offset(at, j);
            k->b[j] = at == SCATTERED ? unused + LANES + j : first->b + lane_offset(at, j);
        }
    }
}

static void make_blocks(work_xpbd *s, const scene_problem *p)
{
    coloured *order = colour(p);
    s->block = aligned_room(p->def.links * sizeof *s->block);
    s->links = scene_room(p->def.links, sizeof *s->links);
    s->group = scene_room(p->def.links, sizeof *s->group);
    for (size_t i = 0; i < p->def.links; s->blocks++) {
        const spring_link *first = &p->link[order[i].link];
        layout at = first->a < first->b ? layout_of(order[i].offset) : SCATTERED;
        const bool goes_on =
            s->groups > 0 && s->group[s->groups - 1].layout == at && order[i].offset == order[i - 1].offset;
        if (block_length(p, order, i, at) < LANES / 2 && !goes_on) /* the end of a row is a separate block */
            at = SCATTERED;
        const size_t count = block_length(p, order, i, at);
        fill_block(&s->block[s->blocks], &s->links[s->blocks], p, order + i, count, at);
        if (s->groups == 0 || s->group[s->groups - 1].layout != at)
            s->group[s->groups++] = (group){.first = s->blocks, .layout = at};
        s->group[s->groups - 1].count++;
        i += count;
    }
    free(order);
}

work_xpbd *work_xpbd_make(const scene_problem *p)
{
    enum { ARRAYS = 3 * AXES + 3 };
    work_xpbd *s = scene_room(1, sizeof *s);
    s->room = (p->def.particles + 3 * LANES) / LANES * LANES;
    s->memory = aligned_room(ARRAYS * s->room * sizeof *s->memory);
    double *next = s->memory;
    for (size_t d = 0; d < AXES; d++) {
        s->x[d] = next, next += s->room;
        s->old[d] = next, next += s->room;
        s->v[d] = next, next += s->room;
        s->gravity[d] = p->def.gravity[d];
    }
    s->inverse_mass = next;
    s->moving = next + s->room;
    s->decay = next + 2 * s->room;
    s->drag = p->def.drag;
    for (size_t i = 0; i < p->def.particles; i++)
        if (!p->pinned[i]) {
            s->inverse_mass[i] = 1 / p->mass[i];
            s->moving[i] = 1;
        }
    for (size_t i = 0; i < p->def.links; i++)
        s->damped = s->damped || p->link[i].damping > 0;
    make_blocks(s, p);
    return s;
}

void work_xpbd_free(work_xpbd *s)
{
    free(s->block);
    free(s->links);
    free(s->group);
    free(s->memory);
    free(s);
}

void work_xpbd_start(work_xpbd *s, const scene_problem *p, double h)
{
    s->h = h;
    for (size_t i = 0; i < AXES * p->def.particles; i++) {
        s->x[i % AXES][i / AXES] = p->position[i];
        s->v[i % AXES][i / AXES] = p->velocity[i];
    }
    for (size_t i = 0; i < s->room; i++)
        s->decay[i] = 1 / (1 + h * s->drag * s->inverse_mass[i]);
    for (size_t i = 0; i < s->blocks; i++)
        for (int j = 0; j < LANES; j++) {
            block *k = &s->block[i];
            block_links *l = &s->links[i];
            const double w_a = s->inverse_mass[k->a[j]], w_b = s->inverse_mass[k->b[j]];
            if (l->stiffness[j] > 0) {
                l->ratio[j] = l->damping[j] / (l->stiffness[j] * h);
                const double sum = (1 + l->ratio[j]) * (w_a + w_b) + 1 / (l->stiffness[j] * h * h);
                k->share_a[j] = w_a / sum;
                k->share_b[j] = w_b / sum;
            }
        }
}

void work_xpbd_get(const work_xpbd *s, const scene_problem *p, double *y)
{
    for (size_t i = 0; i < p->moving; i++) {
        const size_t at = p->coordinate[i];
        y[i] = s->x[at % AXES][at / AXES];
        y[p->moving + i] = s->v[at % AXES][at / AXES];
    }
}

/* ----------------------------------------------------------------------------------------------------- substeps */

#if defined(__clang__)
#define SHUFFLE(v, w, ...) __builtin_shufflevector(v, w, __VA_ARGS__)
#else
typedef int64_t lane_numbers __attribute__((vector_size(LANES * sizeof(int64_t))));
#define SHUFFLE(v, w, ...) __builtin_shuffle(v, w, (lane_numbers){__VA_ARGS__})
#endif

INLINE void load_ends(const double *array, const block *k, layout at, lanes *a, lanes *b)
{
    if (at == SCATTERED) {
        double each_a[LANES], each_b[LANES];
        for (int j = 0; j < LANES; j++) {
            each_a[j] = array[k->a[j]];
            each_b[j] = array[k->b[j]];
        }
        LOAD(*a, each_a);
        LOAD(*b, each_b);
        return;
    }
    lanes low, high;
    LOAD(low, array + k->a[0]);
    LOAD(high, array + (at == ROWS ? k->b[0] : k->a[0] + LANES));
    *a = at == ROWS    ? low
         : at == PAIRS ? SHUFFLE(low, high, 0, 2, 4, 6, 8, 10, 12, 14)
                       : SHUFFLE(low, high, 0, 1, 4, 5, 8, 9, 12, 13);
    *b = at == ROWS    ? high
         : at == PAIRS ? SHUFFLE(low, high, 1, 3, 5, 7, 9, 11, 13, 15)
                       : SHUFFLE(low, high, 2, 3, 6, 7, 10, 11, 14, 15);
}

/* Vectors are passed by address, because passing by value depends on the instruction set. */
INLINE void store_ends(double *array, const block *k, layout at, const lanes *at_a, const lanes *at_b)
{
    const lanes a = *at_a, b = *at_b;
    if (at == SCATTERED) {
        double each_a[LANES], each_b[LANES];
        STORE(each_a, a);
        STORE(each_b, b);
        for (int j = 0; j < LANES; j++) {
            array[k->a[j]] = each_a[j];
            array[k->b[j]] = each_b[j];
        }
        return;
    }
    const lanes low = at == ROWS    ? a
                      : at == PAIRS ? SHUFFLE(a, b, 0, 8, 1, 9, 2, 10, 3, 11)
                                    : SHUFFLE(a, b, 0, 1, 8, 9, 2, 3, 10, 11);
    const lanes high = at == ROWS    ? b
                       : at == PAIRS ? SHUFFLE(a, b, 4, 12, 5, 13, 6, 14, 7, 15)
                                     : SHUFFLE(a, b, 4, 5, 12, 13, 6, 7, 14, 15);
    STORE(array + k->a[0], low);
    STORE(array + (at == ROWS ? k->b[0] : k->a[0] + LANES), high);
}

INLINE void solve_block(const work_xpbd *s, const block *k, const block_links *links, layout at, bool damped)
{
    const double smallest = 1e-30; /* [m^2] avoids NaN for coinciding ends, which have no direction */
    lanes a[AXES], b[AXES], delta[AXES], square = {0}, moved = {0}, inverse, rest, share_a, share_b;
    UNROLL
    for (int d = 0; d < AXES; d++) {
        load_ends(s->x[d], k, at, &a[d], &b[d]);
        delta[d] = b[d] - a[d];
        square += delta[d] * delta[d];
        if (damped) {
            lanes old_a, old_b;
            load_ends(s->old[d], k, at, &old_a, &old_b);
            moved += delta[d] * (delta[d] - (old_b - old_a));
        }
    }
    square += smallest;
    inverse_root(&square, &inverse);
    LOAD(rest, k->rest);
    LOAD(share_a, k->share_a);
    LOAD(share_b, k->share_b);
    lanes l = rest * inverse - 1;
    if (damped) {
        lanes ratio;
        LOAD(ratio, links->ratio);
        l -= ratio * inverse * inverse * moved;
    }
    share_a *= l;
    share_b *= l;
    UNROLL
    for (int d = 0; d < AXES; d++) {
        a[d] -= share_a * delta[d];
        b[d] += share_b * delta[d];
        store_ends(s->x[d], k, at, &a[d], &b[d]);
    }
}

INLINE void solve_group(const work_xpbd *s, const group *g, layout at, bool damped)
{
    for (size_t i = g->first; i < g->first + g->count; i++)
        solve_block(s, &s->block[i], &s->links[i], at, damped);
}

INLINE void predict(const work_xpbd *s)
{
    for (int d = 0; d < AXES; d++)
        for (size_t i = 0; i < s->room; i += LANES) {
            lanes x, v, moving, decay;
            LOAD(x, s->x[d] + i);
            LOAD(v, s->v[d] + i);
            LOAD(moving, s->moving + i);
            LOAD(decay, s->decay + i);
            v = (v + s->h * s->gravity[d] * moving) * decay;
            STORE(s->old[d] + i, x);
            x += s->h * v;
            STORE(s->x[d] + i, x);
        }
}

INLINE void find_velocities(const work_xpbd *s)
{
    const double per_h = 1 / s->h;
    for (int d = 0; d < AXES; d++)
        for (size_t i = 0; i < s->room; i += LANES) {
            lanes x, old;
            LOAD(x, s->x[d] + i);
            LOAD(old, s->old[d] + i);
            const lanes v = per_h * (x - old);
            STORE(s->v[d] + i, v);
        }
}

INLINE void substeps(const work_xpbd *s, uint64_t n, bool damped)
{
    for (uint64_t i = 0; i < n; i++) {
        predict(s);
        for (const group *g = s->group; g < s->group + s->groups; g++)
            if (g->layout == ROWS)
                solve_group(s, g, ROWS, damped);
            else if (g->layout == PAIRS)
                solve_group(s, g, PAIRS, damped);
            else if (g->layout == FOURS)
                solve_group(s, g, FOURS, damped);
            else
                solve_group(s, g, SCATTERED, damped);
        find_velocities(s);
    }
}

INLINE void substeps_of(const work_xpbd *s, uint64_t n)
{
    if (s->damped)
        substeps(s, n, true);
    else
        substeps(s, n, false);
}

/* The instruction sets of the kernels of the library. */
#if defined(__x86_64__)
__attribute__((target("avx512f,avx512dq,avx512vl"))) static void with_avx512(const work_xpbd *s, uint64_t n)
{
    substeps_of(s, n);
}

__attribute__((target("avx2"))) static void with_avx2(const work_xpbd *s, uint64_t n)
{
    substeps_of(s, n);
}
#endif

void work_xpbd_advance(work_xpbd *s, uint64_t n)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
        with_avx512(s, n);
        return;
    }
    if (__builtin_cpu_supports("avx2")) {
        with_avx2(s, n);
        return;
    }
#endif
    substeps_of(s, n);
}
