/* SPDX-License-Identifier: MIT */
/*
 * Arbitrary bytes as a small scene and operations on it, in double or (FUZZ_FLOAT) single precision: a valid or invalid
 * definition, then steps, changes and queries. Two scenes with the same definition, in memory with different contents,
 * must have the same results, one in calls of n steps, one in n calls. Guards surround their blocks.
 *
 * Every choice is a byte, and so are most numbers, in sixteenths; in wild inputs some are extreme, and some any eight
 * bytes.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/scene.h>

#include "fuzz.h"

#ifdef FUZZ_FLOAT
#define SPRING_FLOAT
typedef float scalar;
#else
typedef double scalar;
#endif
#include "../../src/kernels/single_precision.h"

#define spring_scene_def public_scene_def /* of the precision */
typedef spring_scene scene;

enum { most_particles = 80, most_links = 1000, most_weighted = 40, most_calls = 40, guard = 2 * SPRING_SCENE_ALIGN };

/* ---------------------------------------------------------------------------------------------- bytes as choices */

static const uint8_t *next, *end;
static bool wild;

static uint8_t take(void)
{
    return next < end ? *next++ : 0;
}

static uint32_t choose(uint32_t count)
{
    return take() % count;
}

static double number(void)
{
    static const double extreme[] = {0.0,     -0.0,     INFINITY, -INFINITY, NAN,    DBL_MAX, -DBL_MAX, DBL_MIN,
                                     5e-324,  1e300,    1e-300,   1e154,     1e-154, 1e38,    -1e38,    1e-38,
                                     FLT_MAX, -FLT_MAX, FLT_MIN,  1e-45,     1e19,   1e-19};
    const uint32_t extremes = sizeof extreme / sizeof extreme[0], harmless = 228;
    const uint32_t byte = take();
    if (byte < harmless || !wild)
        return (byte - harmless / 2.0) / 16;
    if (byte < harmless + extremes)
        return extreme[byte - harmless];
    double any;
    uint8_t bits[sizeof any];
    for (size_t i = 0; i < sizeof bits; i++)
        bits[i] = take();
    memcpy(&any, bits, sizeof any);
    return any;
}

/* Not negative, as long as the byte is a harmless one. */
static double size(void)
{
    const double any = number();
    return any < 0 && any > -8 ? -any : any;
}

/* ---------------------------------------------------------------------------------------------------- definitions */

static bool for_scenes(int m)
{
    const spring_method_info *info = spring_method_describe((spring_method)m);
    return info != NULL && info->scenes;
}

/* As bits. */
static uint32_t scene_methods(void)
{
    uint32_t all = 0;
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        all |= for_scenes(m) ? 1u << m : 0;
    return all;
}

typedef struct definition {
    spring_scene_def def;
    double position[3 * most_particles], velocity[3 * most_particles], mass[most_particles];
    uint8_t pinned[most_particles];
    spring_link link[most_links];
    spring_weighted_link weighted[most_weighted];
    double radius[most_particles], friction[most_particles];
    uint32_t mask[most_particles];
} definition;

#define CALLBACK(name)                                                                        \
    static void name(void *user, double t, size_t particles, const scalar *const position[3], \
                     const scalar *const velocity[3], scalar *const force[3])

CALLBACK(still)
{
    (void)user, (void)velocity;
    for (size_t i = 0; i < particles; i++)
        force[0][i] += (scalar)0.5 * (scalar)sin(t) - position[0][i];
}

CALLBACK(moving)
{
    (void)user, (void)t, (void)position;
    for (size_t i = 0; i < particles; i++)
        force[0][i] -= velocity[0][i] * velocity[0][i];
}

/* A link between any two particles; now and then one that is not there, or to itself. */
static spring_link any_link(size_t particles)
{
    const uint32_t count = (uint32_t)(particles > 1 ? particles : 2), a = choose(count),
                   b = (a + 1 + choose(count - 1)) % count, other = choose(64) == 63 ? choose(count + 1) : b;
    return (spring_link){a, other, size(), size(), choose(2) == 0 ? 0 : size(), 0};
}

/* Weights (w, -2w, w) at particles in a row, or any, whose sum may not be 0. */
static spring_weighted_link any_weighted(size_t particles, size_t i)
{
    const uint32_t count = (uint32_t)(particles > 1 ? particles : 2), offset = 1 + choose(3);
    spring_weighted_link w = {.stiffness = size(), .damping = choose(2) == 0 ? 0 : size()};
    if (choose(2) == 0)
        return (spring_weighted_link){
            {(uint32_t)i, (uint32_t)i + offset, (uint32_t)i + 2 * offset}, {0.5, -1, 0.5}, 0, w.stiffness, w.damping};
    w.rest = choose(2) == 0 ? 0 : size();
    for (uint32_t k = 0; k < 4; k++)
        w.particle[k] = choose(16) == 15 ? choose(count + 1) : (choose(count) + k) % count;
    for (int k = 0; k < 3; k++) {
        w.weight[k] = choose(3) - 1.0;
        w.weight[3] -= w.weight[k];
    }
    w.weight[3] += choose(64) == 63 ? number() : 0;
    return w;
}

/* Weighted links and flags of links, for definitions without a callback. */
static void further_links(definition *d)
{
    const uint32_t how = take(), tethers = 1 + choose(4);
    for (size_t i = 0; how & 1 && i < d->def.links; i++)
        d->link[i].flags = i % tethers == 0 ? choose(32) == 31 ? 4 : how >> 4 & 3 : 0;
    d->def.weighted_links = how & 2 ? choose(most_weighted + 1) : 0;
    for (size_t i = 0; i < d->def.weighted_links; i++)
        d->weighted[i] = any_weighted(d->def.particles, i);
    d->def.weighted_link = d->weighted;
}

static void loose(definition *d)
{
    d->def.particles = choose(13);
    d->def.links = choose(25);
    for (size_t i = 0; i < 3 * d->def.particles; i++)
        d->position[i] = number();
    for (size_t i = 0; i < d->def.links; i++)
        d->link[i] = any_link(d->def.particles);
}

/* A grid, or loose links where there is none. */
static void grid(definition *d)
{
    const spring_grid g = {
        .count = {choose(6), choose(6), choose(4)},
        .axes = choose(5),
        .height = choose(2),
        .spacing = size(),
        .stretch = size(),
        .families = choose(9),
        .stiffness = size(),
        .damping = choose(2) == 0 ? 0 : size(),
        .pinned = choose(65),
    };
    size_t particles = 0, links = 0;
    const spring_status status = spring_grid_size(&g, &particles, &links);
    must(status == SPRING_OK || status == SPRING_EINVAL, "a small grid is good or bad");
    must(status != SPRING_OK || (particles <= most_particles && links < most_links), "few enough");
    must(spring_grid_fill(&g, d->position, d->pinned, d->link) == status, "both say the same");
    if (status != SPRING_OK) {
        loose(d);
        return;
    }
    d->def.axes = g.height ? 1 : g.axes == 0 ? 3 : g.axes;
    d->def.particles = particles;
    d->def.links = links;
}

/* Some links the other way round, some stiffer than the others, some gone. */
static void disturb(definition *d)
{
    const uint32_t how = take(), every = 1 + choose(8);
    size_t kept = 0;
    for (size_t i = 0; i < d->def.links; i++) {
        spring_link link = d->link[i];
        if (how & 1 && i % every == 0) {
            link.a = d->link[i].b;
            link.b = d->link[i].a;
        }
        if (how & 2 && i % 3 == 0)
            link.stiffness += (double)every;
        if (!(how & 4) || i % 5 != 0)
            d->link[kept++] = link;
    }
    d->def.links = kept;
}

/* Contacts of particles that differ. */
static void further_contacts(definition *d)
{
    const uint32_t how = take();
    for (size_t i = 0; how > 0 && i < d->def.particles; i++) {
        d->radius[i] = how & 1 ? size() : 0;
        d->friction[i] = how & 2 ? size() : 0;
        d->mask[i] = how & 4 ? choose(8) : 0;
    }
    d->def.radius = how & 1 ? d->radius : NULL;
    d->def.friction = how & 2 ? d->friction : NULL;
    d->def.mask = how & 4 ? d->mask : NULL;
}

static void define(definition *d)
{
    memset(d, 0, sizeof *d);
    const uint32_t axes = choose(5), what = take();
    wild = choose(4) == 0;
    const uint32_t flags = take(), unknown = 64;
    d->def.flags = (flags % 9 == 8 ? unknown : flags % 9) | flags / 9 % 4 * SPRING_SCENE_TENSION_ONLY;
    d->def.methods = choose(4) == 3 ? choose(2u << SPRING_METHOD_COUNT) : take() & scene_methods();
    d->def.axes = axes == 4 && choose(8) > 0 ? 1 : axes;
    if (what & 1)
        grid(d);
    else
        loose(d);
    disturb(d);
    for (size_t i = 0; i < d->def.particles; i++) {
        d->mass[i] = what & 2 ? size() : 1.3;
        d->pinned[i] = what & 4 ? (uint8_t)choose(2) : d->pinned[i];
    }
    for (size_t i = 0; i < 3 * d->def.particles; i++)
        d->velocity[i] = what & 8 ? number() : 0;
    for (int i = 0; i < 3; i++)
        d->def.gravity[i] = what & 16 ? number() : 0;
    d->def.drag = what & 32 ? size() : 0;
    d->def.mass_all = what & 64 ? size() : 0;
    d->def.position = choose(64) == 63 ? NULL : d->position;
    d->def.velocity = what & 8 ? d->velocity : NULL;
    d->def.mass = what & 2 ? d->mass : NULL;
    d->def.pinned = d->pinned;
    d->def.link = choose(64) == 63 ? NULL : d->link;
    if (what & 128)
        d->def.force = choose(2) == 0 || d->def.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY ? still : moving;
    d->def.colliders = choose(4) == 3 ? choose(34) : 0;
    d->def.particle_radius = d->def.colliders > 0 ? size() : 0;
    if ((what & 128) == 0)
        further_links(d);
    if (d->def.colliders > 0)
        further_contacts(d);
}

/* --------------------------------------------------------------------------------------------------------- a scene */

/* A block between guards, at any multiple of 8 bytes, which depends on the length of the input. */
typedef struct place {
    uint8_t *all, *block, fill;
    size_t bytes;
    scene *s;
} place;

static place place_for(size_t bytes, uint8_t fill)
{
    const size_t least = 8, shift = least * (((size_t)(end - next) + fill) % (SPRING_SCENE_ALIGN / least));
    place p = {aligned_alloc(SPRING_SCENE_ALIGN, bytes + 3 * guard), NULL, fill, bytes, NULL};
    must(p.all != NULL, "memory");
    memset(p.all, fill, bytes + 3 * guard);
    p.block = p.all + guard + shift;
    return p;
}

static void check_guards(const place *p)
{
    for (size_t i = 0; i < guard; i++)
        must((p->block - guard)[i] == p->fill && p->block[p->bytes + i] == p->fill,
             "nothing outside the block changes");
}

typedef struct state {
    double x[3 * most_particles], v[3 * most_particles], tension[most_links], time, held[3 * most_particles];
    double touching[most_particles]; /* bits */
} state;

/* All that can be seen of a scene but its forces. */
static void look(const scene *s, const definition *d, state *y)
{
    memset(y, 0, sizeof *y);
    must(spring_scene_get(s, SPRING_POSITION, y->x, 3, 0, d->def.particles) == SPRING_OK &&
             spring_scene_get(s, SPRING_VELOCITY, y->v, 3, 0, d->def.particles) == SPRING_OK,
         "the state can be had");
    for (size_t i = 0; i < d->def.links; i++)
        y->tension[i] = spring_scene_tension(s, i);
    y->time = spring_scene_time(s);
    must(spring_scene_get(s, SPRING_FORCE, y->held, 3, 0, d->def.particles) ==
             (d->def.flags & SPRING_SCENE_FORCES ? SPRING_OK : SPRING_EDISABLED),
         "held forces, too, if there is room");
    uint32_t mask[most_particles] = {0};
    must(spring_scene_touching(s, mask, 0, d->def.particles) == (d->def.colliders > 0 ? SPRING_OK : SPRING_EDISABLED),
         "what is touched, if there is room for colliders");
    for (size_t i = 0; i < most_particles; i++)
        y->touching[i] = mask[i];
}

static bool same_numbers(const double *a, const double *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i]))) /* NaN has many forms */
            return false;
    return true;
}

static bool same(const state *a, const state *b)
{
    return same_numbers(a->x, b->x, sizeof *a / sizeof(double));
}

static bool finite(const state *y)
{
    for (size_t i = 0; i < 3 * most_particles; i++)
        if (!isfinite(y->x[i]) || !isfinite(y->v[i]))
            return false;
    return true;
}

static definition pristine; /* before any edits */

static void keep_pristine(const definition *d)
{
    pristine = *d;
    spring_scene_def *const def = &pristine.def;
    def->position = def->position != NULL ? pristine.position : NULL;
    def->velocity = def->velocity != NULL ? pristine.velocity : NULL;
    def->mass = def->mass != NULL ? pristine.mass : NULL;
    def->pinned = pristine.pinned;
    def->link = def->link != NULL ? pristine.link : NULL;
    def->radius = def->radius != NULL ? pristine.radius : NULL;
    def->friction = def->friction != NULL ? pristine.friction : NULL;
    def->mask = def->mask != NULL ? pristine.mask : NULL;
}

/* Both scenes, and what is known of them. Only the first is queried, and only its calls fail or do nothing. */
typedef struct life {
    definition *d;
    place one, other;
    uint32_t axes;
    bool broken; /* an advance without rollback has failed */
    uint32_t colliders;
    spring_collider collider[4];
} life;

/* The other one becomes a copy, as a snapshot is taken. */
static void copy_over(life *l)
{
    memcpy(l->other.s, l->one.s, l->one.bytes);
}

static void must_agree(const life *l)
{
    static state a, b;
    look(l->one.s, l->d, &a);
    look(l->other.s, l->d, &b);
    must(same(&a, &b), "the same life, to the bit");
}

/* ------------------------------------------------------------------------------- changes, which both scenes get alike */

static state before, after; /* of the first scene, around a change */

/* The arguments of a change, drawn from the bytes. */
static struct arguments {
    spring_quantity q;
    size_t first, count, stride, apart; /* apart: the stride, or that of packed numbers */
    bool fits;                          /* the range of particles is one */
    bool pins;                          /* not masses */
    double number[4 * most_particles], vector[3], *to, duration;
    uint8_t pinned[most_particles + 10];
    spring_link link[most_links];
    spring_collider collider[4];
} with;

/* A range of particles, in order or beyond them. */
static void draw_range(const life *l)
{
    with.first = choose(90);
    with.count = choose(90);
    with.fits = with.first <= l->d->def.particles && with.count <= l->d->def.particles - with.first;
}

static void draw_stride(const life *l)
{
    with.stride = choose(5);
    with.apart = with.stride == 0 ? l->axes : with.stride;
}

static void draw_vector(const life *l)
{
    (void)l;
    for (int a = 0; a < 3; a++)
        with.vector[a] = number();
}

static void draw_state(const life *l)
{
    with.q = (spring_quantity)choose(4);
    draw_range(l);
    draw_stride(l);
    for (size_t i = 0; i < 4 * most_particles; i++)
        with.number[i] = 0.25 * (double)(i % 16);
    for (size_t i = 0; i < with.count && i < 4; i++)
        with.number[i * with.apart] = number();
}

static spring_status set_state(scene *s)
{
    return spring_scene_set(s, with.q, with.number, with.stride, with.first, with.fits ? with.count : 90);
}

static void draw_link(const life *l)
{
    with.first = choose(most_links);
    with.link[0] = any_link(l->d->def.particles);
    if (with.first < l->d->def.links && choose(4) > 0) {
        with.link[0].a = l->d->link[with.first].a;
        with.link[0].b = l->d->link[with.first].b;
    }
}

static spring_status set_link(scene *s)
{
    return spring_scene_set_link(s, with.first, with.link);
}

static void link_is_set(life *l)
{
    must(l->d->def.flags & SPRING_SCENE_EDITABLE && with.first < l->d->def.links, "it may be changed");
    with.link[0].flags = l->d->link[with.first].flags; /* which stay */
    l->d->link[with.first] = with.link[0];
}

static void draw_links(const life *l)
{
    draw_range(l);
    for (size_t i = 0; i < with.count; i++) {
        const size_t link = with.first + i;
        with.link[i] = link < l->d->def.links ? l->d->link[link] : any_link(l->d->def.particles);
        with.link[i].rest = size();
    }
    if (with.count > 0)
        with.link[with.count - 1].stiffness = size();
}

static spring_status set_links(scene *s)
{
    return spring_scene_set_links(s, with.first, with.count, with.link);
}

static void links_are_set(life *l)
{
    must(l->d->def.flags & SPRING_SCENE_EDITABLE && with.first + with.count <= l->d->def.links, "they may be changed");
    memcpy(&l->d->link[with.first], with.link, with.count * sizeof *with.link);
}

static void draw_matrix(const life *l)
{
    (void)l;
    for (int i = 0; i < 12; i++)
        with.number[i] = i < 4 ? number() : i % 5 == 0;
}

static spring_status transform(scene *s)
{
    return spring_scene_transform(s, with.number);
}

/* Axes that turn about one axis are orthonormal; now and then others. */
static void any_axes(double axis[3][3])
{
    memset(axis, 0, 9 * sizeof axis[0][0]);
    const uint32_t up = choose(3), first = (up + 1) % 3, second = (up + 2) % 3;
    const bool turned = choose(2) != 0;
    axis[up][up] = 1;
    axis[first][first] = axis[second][second] = turned ? 0.6 : 1;
    axis[first][second] = turned ? 0.8 : 0;
    axis[second][first] = turned ? -0.8 : 0;
    if (choose(16) == 15)
        axis[choose(3)][choose(3)] = number();
}

/* Hills, a valley as two contacts, hills with a hole, and a function that does not keep its promises. */
static uint32_t any_gap(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const uint8_t kind = *(const uint8_t *)user;
    for (int k = 0; k < 2; k++) {
        const double slope = kind == 1 ? (k ? 0.75 : -0.75) : 0.3 * cos(y[0]), root = sqrt(1 + slope * slope);
        const double n[3] = {-slope / root, 1 / root, 0};
        memcpy(normal[k], n, sizeof n);
        gap[k] = kind == 1 ? (y[1] - slope * y[0]) / root : (y[1] - 0.3 * sin(y[0])) / 1.05;
    }
    if (kind == 2 && y[0] > 1.5)
        gap[0] = (double)NAN;
    if (kind == 3)
        gap[0] = 5 * sin(9 * gap[0]), normal[0][0] = y[2];
    return kind == 1 ? 2 : 1;
}

/* What a collider may have besides a shape and a velocity. */
static void further_motion(spring_collider *c)
{
    static uint8_t kinds[] = {0, 1, 2, 3};
    const uint32_t how = take();
    for (int a = 0; a < 3 && how > 0; a++) {
        c->acceleration[a] = how & 1 ? number() : 0;
        c->spin_acceleration[a] = how & 2 ? number() : 0;
        c->surface[a] = how & 4 ? number() : 0;
    }
    c->mask = how & 8 ? choose(8) : 0;
    if (how & 16) {
        c->shape = SPRING_CUSTOM, c->gap = any_gap, c->user = &kinds[how >> 5 & 3];
        c->thickness = size(), c->bound = how & 128 ? size() : 0;
    }
}

static spring_collider any_collider(void)
{
    spring_collider c = {.shape = (spring_shape)choose(choose(16) == 15 ? 6 : 4), .radius = size()};
    any_axes(c.axis);
    for (int a = 0; a < 3; a++) {
        c.at[a] = number();
        c.to[a] = number();
        c.half[a] = size();
        c.velocity[a] = choose(2) == 0 ? 0 : number();
        c.velocity_to[a] = c.velocity[a];
        c.spin[a] = choose(4) == 0 ? number() : 0;
    }
    c.friction = choose(2) == 0 ? 0 : size();
    const uint32_t last = take();
    c.restitution = last % 9 / 8.0;
    if (last >= 96)
        further_motion(&c);
    return c;
}

static void draw_colliders(const life *l)
{
    (void)l;
    with.count = choose(5);
    for (size_t i = 0; i < with.count && i < 4; i++)
        with.collider[i] = any_collider();
}

static spring_status set_colliders(scene *s)
{
    return spring_scene_set_colliders(s, with.collider, (uint32_t)with.count);
}

static void colliders_are_set(life *l)
{
    must(l->d->def.colliders > 0, "there was room");
    l->colliders = (uint32_t)with.count;
    memcpy(l->collider, with.collider, sizeof l->collider);
}

/* Pins, or masses, of a range of particles. */
static void draw_pins_or_masses(const life *l)
{
    with.pins = choose(2);
    draw_range(l);
    for (size_t i = 0; i < 90; i++) {
        with.pinned[i] = i % 3 == 0;
        with.number[i] = 0.5 + 0.25 * (double)(i % 7);
    }
    with.pinned[0] = (uint8_t)choose(2);
    with.number[0] = size();
}

static spring_status set_pins_or_masses(scene *s)
{
    return with.pins ? spring_scene_set_pinned(s, with.first, with.count, with.pinned)
                     : spring_scene_set_mass(s, with.first, with.count, with.number);
}

static void pins_or_masses_are_set(life *l)
{
    definition *d = l->d;
    must(d->def.flags & SPRING_SCENE_EDITABLE && with.fits, "it was in order");
    const double all = d->def.mass_all == 0 ? 1 : d->def.mass_all;
    for (size_t i = 0; i < d->def.particles; i++)
        d->mass[i] = d->def.mass != NULL && d->mass[i] > 0 ? d->mass[i] : all;
    d->def.mass = d->mass;
    for (size_t i = 0; i < with.count; i++)
        if (with.pins)
            d->pinned[with.first + i] = with.pinned[i];
        else
            d->mass[with.first + i] = with.number[i];
}

static void draw_drive(const life *l)
{
    with.first = choose(90);
    draw_vector(l);
    with.duration = size();
    with.to = choose(4) == 0 ? NULL : with.vector;
}

static spring_status drive(scene *s)
{
    return spring_scene_drive(s, with.first, with.to, with.duration);
}

static spring_status set_gravity(scene *s)
{
    return spring_scene_set_gravity(s, with.vector);
}

static void gravity_is_set(life *l)
{
    memcpy(l->d->def.gravity, with.vector, sizeof with.vector);
}

typedef struct change {
    void (*draw)(const life *l);
    spring_status (*make)(scene *s);
    void (*done)(life *l); /* notes what has changed, or NULL */
    uint32_t failures;     /* bits of all other statuses that are documented */
} change;

enum { EINVAL_ = 1 << SPRING_EINVAL, RANGE_ = EINVAL_ | 1 << SPRING_ERANGE, EDIT_ = RANGE_ | 1 << SPRING_EDISABLED };

static const change changes[] = {
    {draw_state, set_state, NULL, EDIT_},
    {draw_link, set_link, link_is_set, EDIT_},
    {draw_vector, set_gravity, gravity_is_set, EINVAL_},
    {draw_pins_or_masses, set_pins_or_masses, pins_or_masses_are_set, EDIT_},
    {draw_drive, drive, NULL, RANGE_},
    {draw_links, set_links, links_are_set, EDIT_},
    {draw_matrix, transform, NULL, EINVAL_ | 1 << SPRING_ENONFINITE},
    {draw_colliders, set_colliders, colliders_are_set, EDIT_},
};

static void make(life *l, const change *c)
{
    c->draw(l);
    look(l->one.s, l->d, &before);
    const spring_status status = c->make(l->one.s);
    must(c->make(l->other.s) == status, "the same answer");
    look(l->one.s, l->d, &after);
    if (status == SPRING_OK) {
        must(!finite(&before) || finite(&after), "a finite state stays finite");
        if (c->done != NULL)
            c->done(l);
        return;
    }
    must(c->failures >> status & 1, "no other status is documented");
    must(same(&before, &after), "an error changes nothing");
}

/* ---------------------------------------------------------------------------------------------------------- the rest */

static void advance(life *l)
{
    const spring_method m = (spring_method)((int)choose(SPRING_METHOD_COUNT + 2) - 1);
    const double dt = choose(4) == 0 ? number() : number() / 64;
    const uint64_t n = choose(20);
    look(l->one.s, l->d, &before);
    const spring_status status = spring_scene_advance(l->one.s, m, dt, n);
    look(l->one.s, l->d, &after);
    must(status == SPRING_OK || status == SPRING_EINVAL || status == SPRING_EUNSUPPORTED ||
             status == SPRING_EDISABLED || status == SPRING_ENONFINITE,
         "no other status is documented");
    l->broken = l->broken && !finite(&before); /* what was set may be all that was lost */
    if (l->broken)
        must(status != SPRING_OK || n == 0 || (scalar)dt == 0, "a lost scene does not move");
    else if (status == SPRING_ENONFINITE && l->d->def.flags & SPRING_SCENE_NO_UNDO)
        l->broken = true;
    else if (status != SPRING_OK || n == 0 || (scalar)dt == 0)
        must(same(&before, &after), "an error, or nothing to do, changes nothing");
    else
        must(finite(&after), "the state is finite after SPRING_OK");
    if (status == SPRING_OK)
        for (uint64_t i = 0; i < n; i++)
            must(spring_scene_advance(l->other.s, m, dt, 1) == SPRING_OK, "n steps are n calls");
    else if (l->broken)
        copy_over(l);
}

/* All of it, so that a scene that was lost lives again. */
static void set_all(life *l)
{
    for (int i = 0; i < 2; i++) {
        double numbers[3 * most_particles];
        for (size_t k = 0; k < 3 * most_particles; k++)
            numbers[k] = i == 0 ? 0.5 * (double)(k % 11) : 0.125 * (double)(k % 5);
        const spring_quantity q = i == 0 ? SPRING_POSITION : SPRING_VELOCITY;
        must(spring_scene_set(l->one.s, q, numbers, 0, 0, l->d->def.particles) == SPRING_OK &&
                 spring_scene_set(l->other.s, q, numbers, 0, 0, l->d->def.particles) == SPRING_OK,
             "any finite state will do");
    }
    l->broken = false;
}

/* Of any range; tests/scene checks which numbers these are. */
static void get(life *l)
{
    double out[4 * most_particles];
    float outf[4 * most_particles];
    draw_range(l);
    draw_stride(l);
    with.q = (spring_quantity)choose(4);
    const spring_status status = spring_scene_get(l->one.s, with.q, out, with.stride, with.first, with.count);
    must(spring_scene_getf(l->one.s, with.q, outf, with.stride, with.first, with.count) == status, "both say the same");
    must(status == SPRING_OK ? with.fits && with.q <= SPRING_FORCE && with.apart >= l->axes : EDIT_ >> status & 1,
         "as documented");
}

/* Some links tear; then nothing is longer than its limit, and the pieces are those of the links that are left. */
static void cut_weighted(definition *d, const spring_link *link)
{
    for (size_t i = 0; i < d->def.weighted_links; i++) {
        spring_weighted_link *const w = &d->weighted[i];
        int ends = 0;
        for (int k = 0; k < 4; k++)
            ends += w->weight[k] != 0 && (w->particle[k] == link->a || w->particle[k] == link->b);
        if (ends == 2)
            w->stiffness = w->damping = 0;
    }
}

static void tear(life *l)
{
    static double limit[most_links];
    static uint32_t torn[most_links], component[most_particles];
    const bool each = choose(2) == 0;
    const double stretch = size();
    const size_t room = choose(30);
    size_t count = 77, again = 77;
    for (size_t i = 0; i < l->d->def.links; i++)
        limit[i] = each ? (i < 8 ? size() : 2) : stretch;
    const double *const limits = each ? limit : NULL;
    const spring_status status = spring_scene_tear(l->one.s, stretch, limits, torn, most_links, &count);
    must(spring_scene_tear(l->other.s, stretch, limits, torn, room, &again) == status && again == count,
         "the same answer");
    if (status != SPRING_OK) {
        must((status == SPRING_EINVAL || status == SPRING_EDISABLED) && count == 77, "no other status is documented");
        return;
    }
    must(l->d->def.flags & SPRING_SCENE_EDITABLE && count <= l->d->def.links, "links may tear");
    for (size_t i = 0; i < count; i++) {
        must(torn[i] < l->d->def.links && (i == 0 || torn[i - 1] < torn[i]), "in their order");
        must((l->d->link[torn[i]].flags & SPRING_LINK_TETHER) == 0, "a tether is not cut by its length");
        l->d->link[torn[i]].stiffness = l->d->link[torn[i]].damping = 0;
        cut_weighted(l->d, &l->d->link[torn[i]]);
        must(spring_scene_tension(l->one.s, torn[i]) == 0 || l->broken || wild, "a torn link does not pull");
    }
    must(spring_scene_tear(l->one.s, stretch, limits, NULL, 0, &again) == SPRING_OK && again == 0, "none tears twice");
    const size_t pieces = spring_links_components(l->d->def.particles, l->d->def.links, l->d->link, component);
    must(pieces > 0 && pieces <= l->d->def.particles && component[0] == 0, "the pieces of what is left");
    for (size_t i = 0; i < l->d->def.links; i++)
        must(component[l->d->link[i].a] == component[l->d->link[i].b] ||
                 !(l->d->link[i].stiffness > 0 || l->d->link[i].damping > 0) ||
                 (l->d->link[i].flags & SPRING_LINK_TETHER) != 0,
             "a link joins its ends");
}

static void ask(life *l)
{
    const spring_scene_energies e = spring_scene_energy(l->one.s);
    must(!(e.kinetic < 0) && !(e.elastic < 0), "energies of motion and of springs are not negative");
    for (int m = -1; m <= SPRING_METHOD_COUNT; m++) {
        const double step = spring_scene_stable_step(l->one.s, (spring_method)m);
        must(for_scenes(m) ? step >= 0 : isnan(step), "a step, 0 or infinite; NaN for no method");
    }
    must(isnan(spring_scene_tension(l->one.s, l->d->def.links)), "there are no more links");
    spring_impulse given[4];
    must(spring_scene_impulses(l->one.s, given, 0, l->colliders) ==
             (l->d->def.colliders > 0 ? SPRING_OK : SPRING_EDISABLED),
         "impulses of the present colliders");
    const double v_tol = size(), a_tol = size();
    (void)spring_scene_at_rest(l->one.s, v_tol, a_tol);
}

/* The second scene travels: a new scene of the first definition loads its state. */
static void travel(life *l)
{
    static uint8_t saved[1 << 17];
    size_t bytes = sizeof saved;
    const spring_status status = spring_scene_save(l->other.s, saved, &bytes);
    look(l->other.s, l->d, &before); /* a step that fails before it begins, for its time, loses nothing */
    must(status == SPRING_OK ? !l->broken || finite(&before) : l->broken && status == SPRING_ENONFINITE,
         "a state can be saved unless it is lost");
    if (status != SPRING_OK)
        return;
    must(spring_scene_init(l->other.block, l->other.bytes, &pristine.def, &l->other.s) == SPRING_OK, "as before");
    must(l->colliders == 0 || spring_scene_set_colliders(l->other.s, l->collider, l->colliders) == SPRING_OK,
         "functions of custom bodies do not travel");
    saved[bytes / 2] ^= 1;
    must(spring_scene_load(l->other.s, saved, bytes) == SPRING_EINVAL, "damaged");
    saved[bytes / 2] ^= 1;
    must(spring_scene_load(l->other.s, saved, bytes) == SPRING_OK, "of the same definition");
}

/* A few steps of both, on a copy of the old one. A callback may look at the time, which is another. */
static void goes_on_alike(life *l, const place *p)
{
    static state old, made;
    const double dt = 1.0 / 64;
    double first[3];
    copy_over(l);
    /* forces that leapfrog has kept for damped links are not in the new one: they are found afresh after this */
    if (spring_scene_get(l->other.s, SPRING_POSITION, first, 0, 0, 1) == SPRING_OK)
        (void)spring_scene_set(l->other.s, SPRING_POSITION, first, 0, 0, 1);
    const spring_status status = spring_scene_advance(l->other.s, SPRING_LEAPFROG, dt, 3);
    must(spring_scene_advance(p->s, SPRING_LEAPFROG, dt, 3) == status || l->d->def.force != NULL ||
             !isfinite(spring_scene_time(l->one.s) + 3 * dt),
         "the same answer");
    look(l->other.s, l->d, &old);
    look(p->s, l->d, &made);
    must(status != SPRING_OK || l->d->def.force != NULL ||
             (same_numbers(made.x, old.x, 3 * most_particles) && same_numbers(made.v, old.v, 3 * most_particles)),
         "and move alike");
    copy_over(l);
}

/* A new scene of the definition as it has become, put into the same state, goes on alike. */
static void remake(life *l)
{
    static state y, made;
    look(l->one.s, l->d, &y);
    if (l->broken || l->colliders > 0 || spring_scene_check(&l->d->def, NULL, NULL) != SPRING_OK)
        return;
    place p = place_for(l->one.bytes, 0xc3);
    must(spring_scene_init(p.block, p.bytes, &l->d->def, &p.s) == SPRING_OK, "as large as before");
    must(spring_scene_set(p.s, SPRING_POSITION, y.x, 3, 0, l->d->def.particles) == SPRING_OK &&
             spring_scene_set(p.s, SPRING_VELOCITY, y.v, 3, 0, l->d->def.particles) == SPRING_OK,
         "a state that was got can be set");
    if (l->d->def.flags & SPRING_SCENE_FORCES)
        must(spring_scene_set(p.s, SPRING_FORCE, y.held, 3, 0, l->d->def.particles) == SPRING_OK, "held forces, too");
    look(p.s, l->d, &made);
    must(same_numbers(made.x, y.x, 3 * most_particles) && same_numbers(made.v, y.v, 3 * most_particles) &&
             same_numbers(made.tension, y.tension, most_links),
         "links that were changed are as if made so");
    goes_on_alike(l, &p);
    check_guards(&p);
    free(p.all);
}

static void live(life *l)
{
    static const struct {
        void (*other)(life *l);
        size_t change;
    } choices[19] = {{NULL, 0},   {set_all, 0}, {get, 0},  {NULL, 1},    {NULL, 2},    {ask, 0},     {copy_over, 0},
                     {remake, 0}, {NULL, 3},    {NULL, 4}, {advance, 0}, {advance, 0}, {advance, 0}, {advance, 0},
                     {NULL, 5},   {tear, 0},    {NULL, 6}, {NULL, 7},    {travel, 0}};
    if (l->d->def.colliders > 0)
        make(l, &changes[7]); /* set_colliders() */
    for (int call = 0; call < most_calls && next < end; call++) {
        const uint32_t what = take(), old = 200, choice = what < old ? what % 14 : 14 + what % 5;
        if (choices[choice].other != NULL)
            choices[choice].other(l);
        else
            make(l, &changes[choices[choice].change]);
        must_agree(l);
    }
    check_guards(&l->one);
    check_guards(&l->other);
}

/* What the three functions say of a definition agrees; true if it is valid. */
static bool check_definition(const definition *d, size_t *bytes)
{
    const char *field = "unset";
    size_t index = 0;
    scene *s = (scene *)1;
    uint64_t tiny[SPRING_SCENE_ALIGN / sizeof(uint64_t)];
    const spring_status status = spring_scene_check(&d->def, &field, &index);
    must((field == NULL) == (status == SPRING_OK), "the error is named");
    must(index == 0 || index < d->def.particles || index < d->def.links || index < d->def.weighted_links || index < 3,
         "and where it is");
    must(spring_scene_bytes(&d->def, bytes) == status, "bytes() agrees with check()");
    if (status == SPRING_OK) {
        must(*bytes > 0 && *bytes % SPRING_SCENE_ALIGN == 0, "a multiple of the alignment");
        return true;
    }
    must(status == SPRING_EINVAL || status == SPRING_ERANGE || status == SPRING_EUNSUPPORTED, "no other status");
    must(spring_scene_init(tiny, SIZE_MAX, &d->def, &s) != SPRING_OK && s == NULL, "no scene of a bad definition");
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t data_size)
{
    static definition d;
    size_t bytes = 0;
    next = data;
    end = data + data_size;
    define(&d);
    if (!check_definition(&d, &bytes))
        return 0;
    keep_pristine(&d);
    life l = {.d = &d, .one = place_for(bytes, 0xa5), .other = place_for(bytes, 0x3c)};
    l.axes = d.def.axes == 0 ? 3 : d.def.axes;
    must(spring_scene_init(l.one.block, bytes - 1, &d.def, &l.one.s) == SPRING_ENOMEM && l.one.s == NULL, "too small");
    must(spring_scene_init(l.one.block - 4, bytes, &d.def, &l.one.s) == SPRING_EALIGN && l.one.s == NULL,
         "not aligned");
    check_guards(&l.one);
    must(spring_scene_init(l.one.block, bytes, &d.def, &l.one.s) == SPRING_OK &&
             spring_scene_init(l.other.block, bytes, &d.def, &l.other.s) == SPRING_OK,
         "init() agrees with check()");
    must_agree(&l);
    live(&l);
    free(l.one.all);
    free(l.other.all);
    return 0;
}
