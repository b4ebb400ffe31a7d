/* SPDX-License-Identifier: MIT */
/* Common parts of the tests of scenes: scenes in allocated memory, models with every feature, and a plain loop over
   links. */
#ifndef TEST_SCENE_H
#define TEST_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "harness/link.h"
#include "test_methods.h"
#include "scene/block.h"
#include "simd/targets.h"

#define spring_scene_def public_scene_def /* of the precision */
typedef spring_scene scene;

#ifdef SPRING_FLOAT
#define EPS ((double)FLT_EPSILON)
#else
#define EPS DBL_EPSILON
#endif

extern const scene_kernels plain_scene; /* without vectors, see plain_kernels.c */

enum { kernel_count = 4, shape_count = SPRING_BOX + 1 };

/* By ascending length of the vectors, and without vectors; NULL: this processor lacks the instructions. */
SPRING_INLINE const scene_kernels *kernels_of(int i)
{
#if SPRING_LONG_VECTORS
    if (i == 1)
        return __builtin_cpu_supports("avx2") ? &spring_scene_v256 : NULL;
    if (i == 2)
        return __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") ? &spring_scene_v512 : NULL;
#endif
    return i == 0 ? &spring_scene_v128 : i == 3 ? &plain_scene : NULL;
}

/* The methods that take a definition, in the order of the table, up to no_method. */
typedef struct method_list {
    spring_method at[SPRING_METHOD_COUNT + 1];
} method_list;

SPRING_INLINE method_list methods_of(spring_scene_def def)
{
    method_list list;
    int count = 0;
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        def.methods = 1u << spring_method_at(i);
        if (spring_scene_check(&def, NULL, NULL) == SPRING_OK)
            list.at[count++] = spring_method_at(i);
    }
    list.at[count] = no_method;
    CHECK(count > 0, "some method takes it");
    return list;
}

/* Has a definition ask for all methods that take it; returns them. */
SPRING_INLINE method_list use_all_methods(spring_scene_def *def)
{
    const method_list list = methods_of(*def);
    def->methods = 0;
    for (const spring_method *m = list.at; *m != no_method; m++)
        def->methods |= 1u << *m;
    return list;
}

SPRING_INLINE uint32_t below(size_t count)
{
    return (uint32_t)(random_bits() % count);
}

/* A scene in memory of its own, to be given to free(). */
SPRING_INLINE spring_scene *scene_of(const spring_scene_def *def)
{
    size_t bytes = 0;
    CHECK(spring_scene_bytes(def, &bytes) == SPRING_OK && bytes > 0, "a valid definition");
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    spring_scene *s;
    CHECK(spring_scene_init(memory, bytes, def, &s) == SPRING_OK && (void *)s == memory,
          "the scene is the block, or a copy of the block would be none");
    return memory;
}

/* Particles on two or three axes, joined by links. */
SPRING_INLINE spring_scene_def joined(uint32_t axes, size_t particles, const double *x, const double *v, size_t links,
                                      const spring_link *link)
{
    return (spring_scene_def){
        .axes = axes, .particles = particles, .position = x, .velocity = v, .links = links, .link = link};
}

/* The stable step of a scene of this definition. */
SPRING_INLINE double stable_step_of(const spring_scene_def *def, spring_method method)
{
    spring_scene *s = scene_of(def);
    const double step = spring_scene_stable_step(s, method);
    free(s);
    return step;
}

/* ---------------------------------------------------------------------------------------------------------- models */

enum { most = 3100, most_links = 20000, most_weighted = 4000 }; /* particles and links of a model */

/* features of a model, random numbers where there are numbers */
enum {
    OWN = 1,      /* each link has its own stiffness and rest length */
    SHUFFLED = 2, /* no order among the links, and no common direction: no bands */
    REVERSED = 4, /* links run from the upper particle to the lower */
    DAMPED = 8,   /* links */
    STRAY = 16,   /* links between any two particles as well: bands and an edge list */
    MASSES = 32,  /* each particle its own */
    PINNED = 64,  /* some particles, moving */
    DRAG = 128,
    GRAVITY = 256,
    EDITABLE = 512,
    feature_masks = 1024
};

typedef struct model {
    spring_scene_def def;
    double position[3 * most], velocity[3 * most], mass[most];
    uint8_t pinned[most];
    spring_link link[most_links];
    spring_weighted_link weighted[most_weighted];
} model;

SPRING_INLINE void reverse(spring_link *link)
{
    const uint32_t a = link->a;
    link->a = link->b;
    link->b = a;
}

SPRING_INLINE void shuffle(spring_link *link, size_t count)
{
    for (size_t i = count; i > 1; i--) {
        const size_t j = random_bits() % i;
        const spring_link other = link[j];
        link[j] = link[i - 1];
        link[i - 1] = other;
        if (random_bits() % 2)
            reverse(&link[i - 1]);
    }
}

/* A grid at its place and at rest. All particles have the same mass. */
SPRING_INLINE void build_grid(model *m, const spring_grid *g, double mass)
{
    size_t particles = 0, links = 0;
    CHECK(spring_grid_size(g, &particles, &links) == SPRING_OK && particles <= most && links <= most_links, "fits");
    spring_grid_fill(g, m->position, m->pinned, m->link);
    memset(m->velocity, 0, sizeof m->velocity);
    for (size_t i = 0; i < particles; i++)
        m->mass[i] = mass;
    m->def = joined(g->height ? 1 : g->axes, particles, m->position, m->velocity, links, m->link);
    m->def.pinned = m->pinned, m->def.mass = m->mass, m->def.mass_all = mass;
}

/* The links of a grid with all families between particles that lie near the grid, on so many axes. */
SPRING_INLINE void build(model *m, const uint32_t count[3], uint32_t axes, unsigned features)
{
    const spring_grid g = {
        .count = {count[0], count[1], count[2]},
        .spacing = 0.7,
        .stretch = 1.3,
        .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
        .stiffness = 27.3,
        .damping = features & DAMPED ? 0.43 : 0,
    };
    size_t particles = 0, links = 0;
    const spring_status size = spring_grid_size(&g, &particles, &links);
    CHECK(size == SPRING_OK && particles <= most && links <= most_links - 20, "fits into a model");
    spring_grid_fill(&g, m->position, NULL, m->link);
    for (size_t i = 0; i < particles; i++) {
        for (uint32_t a = 0; a < axes; a++) /* in place: axes <= 3, so what is still to be read lies behind */
            m->position[i * axes + a] = m->position[i * 3 + a] + random_uniform(-0.2, 0.2);
        m->mass[i] = random_log(0.3, 5);
        m->pinned[i] = random_bits() % 5 == 0;
    }
    for (size_t i = 0; i < particles * axes; i++)
        m->velocity[i] = random_uniform(-1, 1);
    for (size_t i = 0; i < links; i++) {
        spring_link *link = &m->link[i];
        if (features & OWN) {
            link->rest = random_uniform(0, 1);
            link->stiffness = random_log(3, 60);
            link->damping = features & DAMPED && random_bits() % 2 ? random_uniform(0, 0.6) : 0;
        }
        if (features & REVERSED)
            reverse(link);
    }
    for (size_t i = 0; i < 20 && features & STRAY && particles > 1; i++) {
        const uint32_t one = (uint32_t)(random_bits() % particles);
        const uint32_t other = (uint32_t)(random_bits() % (particles - 1));
        m->link[links++] = (spring_link){one, other < one ? other : other + 1, 0.8, 9.7, m->link[0].damping, 0};
    }
    if (features & SHUFFLED)
        shuffle(m->link, links);
    for (size_t i = particles * axes; i < (particles + 20) * axes && i < 3 * most; i++)
        m->position[i] = m->velocity[i] = NAN; /* nothing behind the arrays is read */
    for (size_t i = particles; i < particles + 20 && i < most; i++)
        m->mass[i] = NAN;
    for (size_t i = links; i < links + 20 && i < most_links; i++)
        m->link[i] = (spring_link){UINT32_MAX, 0, NAN, -1, 1, 0};
    m->def = (spring_scene_def){
        .axes = axes,
        .flags = features & EDITABLE ? SPRING_SCENE_EDITABLE : 0,
        .particles = particles,
        .links = links,
        .position = m->position,
        .velocity = m->velocity,
        .mass = features & MASSES ? m->mass : NULL,
        .mass_all = 1.7,
        .pinned = features & PINNED ? m->pinned : NULL,
        .link = m->link,
        .gravity = {features & GRAVITY ? 1.1 : 0, features & GRAVITY ? -9.81 : 0, features & GRAVITY ? 0.4 : 0},
        .drag = features & DRAG ? 0.37 : 0,
    };
    use_all_methods(&m->def);
}

/* Weights that add up to 0: (w, -2w, w) at lower, lower + offset and lower + 2 offset, now and then one more or with a
   rest length; with offset 0 any. */
SPRING_INLINE spring_weighted_link random_weighted(size_t particles, uint32_t offset, uint32_t lower)
{
    spring_weighted_link w = {.stiffness = random_bits() % 8 ? random_log(3, 60) : 0};
    if (offset > 0) {
        const double weight = random_bits() % 2 ? 0.5 : random_uniform(-1, 1);
        const uint32_t unused = (uint32_t)(random_bits() % 4), down = random_bits() % 2;
        const uint32_t last = lower + 2 * offset, beyond = last + 1 < particles && random_bits() % 32 == 0;
        for (uint32_t i = 0, k = 0; i < 4; i++) {
            const uint32_t place = down ? 2 - k : k;
            w.particle[i] = i == unused ? UINT32_MAX : lower + place * offset + (place == 2 ? beyond : 0);
            w.weight[i] = i == unused ? 0 : k == 1 ? -2 * weight : weight;
            k += i != unused;
        }
        w.rest = random_bits() % 32 == 0 ? 0.2 : 0;
        return w;
    }
    const uint32_t points = 2 + (uint32_t)(random_bits() % 3);
    double sum = 0;
    for (uint32_t i = 0; i < points; i++) {
        bool other;
        do {
            w.particle[i] = (uint32_t)(random_bits() % particles);
            other = true;
            for (uint32_t j = 0; j < i; j++)
                other = other && w.particle[j] != w.particle[i];
        } while (!other);
        w.weight[i] = i + 1 < points ? random_uniform(-1, 1) : -sum;
        sum += w.weight[i];
    }
    w.rest = random_bits() % 2 ? random_uniform(0.01, 1) : 0;
    return w;
}

/* Weighted links in bands and in no order, and flags of links. */
SPRING_INLINE void add_further_links(model *m, bool damped)
{
    static const uint32_t offsets[] = {1, 2, 5, 8, 31, 33, 64, 100};
    const size_t particles = m->def.particles;
    size_t count = 0;
    const unsigned bands = (unsigned)(random_bits() % 3),
                   strays = random_bits() % 3 ? 0 : (unsigned)(random_bits() % 12);
    for (unsigned b = 0; b < bands; b++) {
        const uint32_t offset = offsets[random_bits() % (sizeof offsets / sizeof offsets[0])];
        for (uint32_t i = 0; i + 2 * (size_t)offset < particles && count < most_weighted - 20; i++)
            if (random_bits() % 8)
                m->weighted[count++] = random_weighted(particles, offset, i);
    }
    for (unsigned i = 0; i < strays && particles >= 4; i++)
        m->weighted[count++] = random_weighted(particles, 0, 0);
    for (size_t i = 0; i < count; i++)
        m->weighted[i].damping = damped && random_bits() % 2 ? random_uniform(0, 0.6) : 0;
    m->def.weighted_links = count;
    m->def.weighted_link = m->weighted;
    const unsigned flags = (unsigned)(random_bits() % 4); /* none, of some links, tethers among them */
    for (size_t i = 0; i < m->def.links && m->def.axes > 1 && flags > 0; i++)
        m->link[i].flags = random_bits() % 3 ? 0 : (uint32_t)(1 + random_bits() % flags);
    m->def.methods = 0;
    use_all_methods(&m->def);
}

SPRING_INLINE double mass_in(const spring_scene_def *def, size_t i)
{
    return def->mass != NULL ? def->mass[i] : def->mass_all == 0 ? 1 : def->mass_all;
}

SPRING_INLINE bool pinned_in(const spring_scene_def *def, size_t i)
{
    return def->pinned != NULL && def->pinned[i] != 0;
}

/* ----------------------------------------------------------------------------------------------------------- states */

typedef struct state {
    double x[3 * most], v[3 * most];
} state;

SPRING_INLINE void get_state(const spring_scene *s, size_t particles, state *y)
{
    CHECK(spring_scene_get(s, SPRING_POSITION, y->x, 0, 0, particles) == SPRING_OK &&
              spring_scene_get(s, SPRING_VELOCITY, y->v, 0, 0, particles) == SPRING_OK,
          "the whole state");
}

SPRING_INLINE void set_state(spring_scene *s, size_t particles, const state *y)
{
    CHECK(spring_scene_set(s, SPRING_POSITION, y->x, 0, 0, particles) == SPRING_OK &&
              spring_scene_set(s, SPRING_VELOCITY, y->v, 0, 0, particles) == SPRING_OK,
          "the whole state");
}

/* Positions and velocities of two scenes of equal size, to the bit. */
SPRING_INLINE bool same_bits(const spring_scene *s, const spring_scene *other, size_t particles, uint32_t axes)
{
    static state a, b;
    get_state(s, particles, &a);
    get_state(other, particles, &b);
    return memcmp(a.x, b.x, particles * axes * sizeof a.x[0]) == 0 &&
           memcmp(a.v, b.v, particles * axes * sizeof a.v[0]) == 0;
}

SPRING_INLINE bool all_finite(const spring_scene *s, size_t particles, uint32_t axes)
{
    static state y;
    get_state(s, particles, &y);
    for (size_t i = 0; i < particles * axes; i++)
        if (!isfinite(y.x[i]) || !isfinite(y.v[i]))
            return false;
    return true;
}

SPRING_INLINE double total_energy(const spring_scene *s)
{
    const spring_scene_energies e = spring_scene_energy(s);
    return e.kinetic + e.elastic + e.gravity;
}

typedef struct momenta {
    double linear[3], angular[3], place[3]; /* place: mass times position */
    double mass, size; /* size: the sum of m |v| (1 + |x|), of which rounding errors are fractions */
} momenta;

/* Of all particles, with the masses with which they act. */
SPRING_INLINE momenta momenta_of(const model *m, const spring_scene *s)
{
    static state y;
    momenta p = {{0}, {0}, {0}, 0, 0};
    get_state(s, m->def.particles, &y);
    for (size_t i = 0; i < m->def.particles; i++) {
        const double kg = 1 / (double)(scalar)(1 / mass_in(&m->def, i));
        double x[3] = {0}, v[3] = {0};
        memcpy(x, &y.x[m->def.axes * i], m->def.axes * sizeof *x);
        memcpy(v, &y.v[m->def.axes * i], m->def.axes * sizeof *v);
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            p.linear[a] += kg * v[a], p.angular[a] += kg * (x[b] * v[c] - x[c] * v[b]), p.place[a] += kg * x[a];
        }
        p.mass += kg;
        p.size += kg * hypot(hypot(v[0], v[1]), v[2]) * (1 + hypot(hypot(x[0], x[1]), x[2]));
    }
    return p;
}

/* ---------------------------------------------------------------------------------------------------- a plain loop */

/* The parameters of a link are those that the scene stores: rounded to float in single precision. */
SPRING_INLINE link_force evaluate_link(const spring_link *link, uint32_t axes, const double *x, const double *v)
{
    double delta[3], relative[3];
    for (uint32_t a = 0; a < axes; a++) {
        delta[a] = x[link->b * axes + a] - x[link->a * axes + a];
        relative[a] = v[link->b * axes + a] - v[link->a * axes + a];
    }
    return link_evaluate(axes, delta, relative, (double)(scalar)link->stiffness, (double)(scalar)link->damping,
                         (double)(scalar)link->rest);
}

/* Whether a link pulls only, and whether it is a tether that does not act. */
SPRING_INLINE bool pulls_only(const spring_scene_def *def, const spring_link *link)
{
    return ((def->flags & SPRING_SCENE_TENSION_ONLY) != 0 || link->flags != 0) && link->rest > 0;
}

SPRING_INLINE bool is_idle(const spring_scene_def *def, const spring_link *link)
{
    return (link->flags & SPRING_LINK_TETHER) != 0 && pinned_in(def, link->a) == pinned_in(def, link->b);
}

/* Index of the particle with the largest weight. */
SPRING_INLINE int heaviest(const spring_weighted_link *w)
{
    int first = 0;
    for (int i = 1; i < 4; i++)
        first = fabs(w->weight[i]) > fabs(w->weight[first]) ? i : first;
    return first;
}

/* The sum of weight (q - q of the heaviest), with weights in the precision of the scene. *size: of its terms */
SPRING_INLINE void weighted_vector(const spring_weighted_link *w, uint32_t axes, const double *q, double d[3],
                                   double *size)
{
    const int first = heaviest(w);
    *size = 0;
    for (uint32_t a = 0; a < axes; a++) {
        d[a] = 0;
        for (int i = 0; i < 4; i++)
            if (i != first && w->weight[i] != 0) {
                const double from = q[w->particle[i] * axes + a] - q[w->particle[first] * axes + a];
                d[a] += (double)(scalar)w->weight[i] * from;
                *size += fabs(w->weight[i] * from);
            }
    }
}

SPRING_INLINE link_force evaluate_weighted(const spring_weighted_link *w, uint32_t axes, const double *x,
                                           const double *v, double *size)
{
    double d[3], rate[3], places, speeds;
    weighted_vector(w, axes, x, d, &places);
    weighted_vector(w, axes, v, rate, &speeds);
    const link_force f =
        link_evaluate(axes, d, rate, (double)(scalar)w->stiffness, (double)(scalar)w->damping, (double)(scalar)w->rest);
    const double turns = w->rest > 0 && axes > 1 && f.length > 0 ? 1 + places / f.length : 1; /* a rounded direction */
    *size = (w->stiffness * (places + 2 * w->rest) + w->damping * speeds) * turns;
    return f;
}

/* Adds the forces of weighted links, as plain_forces() does. */
SPRING_INLINE void plain_weighted_forces(const spring_scene_def *def, uint32_t axes, const double *x, const double *v,
                                         double *force, double *size)
{
    for (size_t i = 0; i < def->weighted_links; i++) {
        const spring_weighted_link *w = &def->weighted_link[i];
        double larger, sum = 0;
        if (w->stiffness == 0 && w->damping == 0)
            continue;
        const link_force f = evaluate_weighted(w, axes, x, v, &larger);
        for (int k = 0; k < 4; k++) {
            const double weight = (double)(scalar)w->weight[k];
            if (k == heaviest(w) || weight == 0)
                continue;
            for (uint32_t a = 0; a < axes; a++) {
                force[w->particle[k] * axes + a] -= weight * f.force[a];
                force[w->particle[heaviest(w)] * axes + a] += weight * f.force[a];
            }
            sum += fabs(weight);
            if (size != NULL)
                size[w->particle[k]] += fabs(weight) * larger;
        }
        if (size != NULL && sum > 0)
            size[w->particle[heaviest(w)]] += 2 * sum * larger;
    }
}

/* Adds the forces of the links; size[i] is the sum over the links of particle i of stiffness (length + 2 rest) +
   damping |relative velocity|, what the rounding errors of its force are relative to. size may be NULL. */
SPRING_INLINE void plain_forces(const spring_scene_def *def, uint32_t axes, const double *x, const double *v,
                                double *force, double *size)
{
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        const link_force f = evaluate_link(link, axes, x, v);
        if ((link->stiffness == 0 && link->damping == 0) || is_idle(def, link)) /* at any distance */
            continue;
        if (pulls_only(def, link) && (f.length <= (double)(scalar)link->rest || f.tension <= 0))
            continue;
        for (uint32_t a = 0; a < axes; a++) {
            force[link->a * axes + a] += f.force[a];
            force[link->b * axes + a] -= f.force[a];
        }
        if (size == NULL)
            continue;
        double relative = 0;
        for (uint32_t a = 0; a < axes; a++)
            relative = hypot(relative, v[link->b * axes + a] - v[link->a * axes + a]);
        const double larger = link->stiffness * (fabs(f.length) + 2 * link->rest) + link->damping * relative;
        size[link->a] += larger;
        size[link->b] += larger;
    }
    plain_weighted_forces(def, axes, x, v, force, size);
}

typedef struct seen_forces {
    uint32_t axes;
    double force[3 * most];
} seen_forces;

/* A callback that only looks: the forces of the links are there when it is called. */
SPRING_INLINE void look(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                        scalar *const force[3])
{
    (void)t, (void)x, (void)v;
    seen_forces *all = user;
    for (size_t i = 0; i < particles; i++)
        for (uint32_t a = 0; a < all->axes; a++)
            all->force[i * all->axes + a] = (double)force[a][i];
}

SPRING_INLINE void check_forces(const model *m, const scene_kernels *kernels)
{
    static seen_forces all;
    static state y;
    static double force[3 * most], size[most];
    static unsigned degree[most];
    const uint32_t axes = all.axes = m->def.axes;
    const size_t particles = m->def.particles;
    spring_scene_def def = m->def;
    def.methods = 1u << SPRING_EULER;
    def.force = look;
    def.user = &all;
    def.max_speed = 0;
    static spring_weighted_link defined[most_weighted];
    const bool edited = (def.flags & SPRING_SCENE_EDITABLE) != 0 && def.weighted_links > 0;
    for (size_t i = 0; i < def.weighted_links && edited; i++) { /* at other places, in or out of bands */
        defined[i] = m->weighted[i];
        const int first = heaviest(&defined[i]);
        const double most_weight = defined[i].weight[first], half = most_weight / 2;
        int others = 0;
        for (int k = 0; k < 4; k++)
            others += k != first && defined[i].weight[k] != 0;
        for (int k = 0; k < 4 && others == 2; k++) /* (w, -2w, w), or (w, w, -2w) times numbers that round */
            if (k != first && defined[i].weight[k] != 0)
                defined[i].weight[k] = -half;
        defined[i].rest = i % 3 == 0 ? defined[i].rest : 0;
        defined[i].stiffness = 1;
    }
    def.weighted_link = edited ? defined : def.weighted_link;
    spring_scene *s = scene_of(&def);
    if (edited)
        CHECK(spring_scene_set_weighted_links(s, 0, def.weighted_links, m->weighted) == SPRING_OK, "as defined");
    get_state(s, particles, &y);
    CHECK(spring_scene_advance_with(kernels, s, SPRING_EULER, 1e-3, 1) == SPRING_OK, "a small step");
    memset(force, 0, particles * axes * sizeof force[0]);
    memset(size, 0, particles * sizeof size[0]);
    memset(degree, 0, particles * sizeof degree[0]);
    plain_forces(&m->def, axes, y.x, y.v, force, size);
    for (size_t i = 0; i < m->def.links; i++) {
        degree[m->def.link[i].a]++;
        degree[m->def.link[i].b]++;
    }
    for (size_t i = 0; i < m->def.weighted_links; i++)
        for (int k = 0; k < 4; k++)
            if (m->weighted[i].weight[k] != 0)
                degree[m->weighted[i].particle[k]]++;
    for (size_t i = 0; i < particles; i++)
        for (uint32_t a = 0; a < axes; a++)
            CHECK_CLOSE(all.force[i * axes + a], force[i * axes + a], (15 + degree[i]) * EPS * size[i],
                        "15 roundings of half an eps in each link here and there, and one for each sum");
    free(s);
}

/* ------------------------------------------------------------------------------------------------------- colliders */

SPRING_INLINE void random_unit(double axis[3], uint32_t axes)
{
    double square;
    do {
        square = 0;
        for (uint32_t a = 0; a < 3; a++) {
            axis[a] = a < axes ? random_uniform(-1, 1) : 0;
            square += axis[a] * axis[a];
        }
    } while (square > 1 || square < 0.01);
    for (int a = 0; a < 3; a++)
        axis[a] /= sqrt(square);
}

/* Of any shape, moving and spinning, about the origin. */
SPRING_INLINE spring_collider random_collider(uint32_t axes)
{
    spring_collider c = {.shape = (spring_shape)(random_bits() % shape_count),
                         .radius = random_uniform(0.2, 0.5),
                         .friction = random_bits() % 3 ? random_uniform(0, 1) : 0,
                         .restitution = random_bits() % 3 ? random_uniform(0, 1) : 0};
    for (uint32_t a = 0; a < axes; a++) {
        c.at[a] = random_uniform(-0.5, 0.5);
        c.to[a] = random_uniform(-0.5, 0.5);
        c.half[a] = random_uniform(0.2, 0.6);
        c.velocity[a] = random_uniform(-1, 1);
        c.velocity_to[a] = c.velocity[a] + (c.radius > 0.3 ? 1 : 0) * random_uniform(-0.5, 0.5); /* or rigid */
        c.spin[a] = random_uniform(-3, 3);
        c.acceleration[a] = c.radius > 0.4 ? 8 * c.at[a] : 0;
        c.spin_acceleration[a] = c.radius < 0.3 ? 8 * c.at[a] : 0;
        c.surface[a] = c.friction > 0.6 ? 2 * c.at[a] : 0;
    }
    random_unit(c.axis[0], axes);
    const double *const u = c.axis[0];
    if (axes == 2) {
        c.axis[1][0] = -u[1];
        c.axis[1][1] = u[0];
    } else {
        double other[3], along;
        do {
            random_unit(other, 3);
            along = u[0] * other[0] + u[1] * other[1] + u[2] * other[2];
        } while (fabs(along) > 0.9);
        const double rest = sqrt(1 - along * along);
        for (int a = 0; a < 3; a++)
            c.axis[1][a] = (other[a] - along * u[a]) / rest;
        for (int a = 0; a < 3; a++)
            c.axis[2][a] = u[(a + 1) % 3] * c.axis[1][(a + 2) % 3] - u[(a + 2) % 3] * c.axis[1][(a + 1) % 3];
    }
    return c;
}

/* ------------------------------------------------------------------------------------------------------- strangers */

/* More particles, which are pinned and joined to nothing: what there is must not notice. */
SPRING_INLINE void add_strangers(model *m, size_t strangers)
{
    const size_t particles = m->def.particles;
    CHECK(particles + strangers <= most, "fits into a model");
    for (size_t i = 0; i < particles && m->def.pinned == NULL; i++)
        m->pinned[i] = 0;
    for (size_t i = particles; i < particles + strangers; i++) {
        m->pinned[i] = 1;
        m->mass[i] = 1;
        for (uint32_t a = 0; a < m->def.axes; a++) {
            m->position[i * m->def.axes + a] = (double)(i + a);
            m->velocity[i * m->def.axes + a] = 0;
        }
    }
    m->def.pinned = m->pinned;
    m->def.particles += strangers;
}

#endif
