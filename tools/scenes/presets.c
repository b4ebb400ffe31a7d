/* SPDX-License-Identifier: MIT */
/* Five ready-made scenes; see presets.h. */
#include "presets.h"

#include <math.h> /* NAN, isnan() */
#include <stdlib.h>
#include <string.h>

const char *const preset_names[] = {"rope", "cloth", "jelly", "chain", "water", NULL};

enum { all_families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND };

/* presets.mjs reads the rows of these two tables. */
static const preset_settings defaults[] = {
    /* size, axes, families, length [m], mass, end mass [kg], stiffness [N/m], damping, drag [N s/m], gravity,
       stretch */
    [PRESET_ROPE] = {PRESET_ROPE, 20, 2, SPRING_GRID_STRUCTURAL, 2, 0.05, 0.05, 2000, 0, 0.01, 9.81, 1},
    [PRESET_CLOTH] = {PRESET_CLOTH, 25, 3, all_families, 2, 0.01, NAN, 500, 0, 0.01, 9.81, 1},
    [PRESET_JELLY] = {PRESET_JELLY, 8, 3, all_families, 0.7, 0.01, NAN, 40, 0, 0.005, 9.81, 1},
    [PRESET_CHAIN] = {PRESET_CHAIN, 50, 1, SPRING_GRID_STRUCTURAL, 5, 0.1, NAN, 100, 0, 0, NAN, 1},
    [PRESET_WATER] = {PRESET_WATER, 25, 1, all_families, 4, 1, NAN, 25000, 0, 0.5, NAN, 0},
};

/* Two corners of the cloth are pinned later. */
static const struct {
    uint32_t dimensions, ends; /* ends: fixed particles along an edge that the size does not count */
    uint32_t pinned;
} shapes[] = {
    [PRESET_ROPE] = {1, 0, SPRING_GRID_FIRST_X},
    [PRESET_CLOTH] = {2, 0, 0},
    [PRESET_JELLY] = {3, 0, SPRING_GRID_FIRST_Z},
    [PRESET_CHAIN] = {1, 2, SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X},
    [PRESET_WATER] = {2, 0, SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y},
};

preset_settings preset_defaults(preset_kind kind)
{
    return defaults[kind];
}

preset_settings preset_unchosen(preset_kind kind)
{
    return (preset_settings){.kind = kind,
                             .length = NAN,
                             .mass = NAN,
                             .end_mass = NAN,
                             .stiffness = NAN,
                             .damping = NAN,
                             .drag = NAN,
                             .gravity = NAN,
                             .stretch = NAN};
}

static double either(double chosen, double otherwise)
{
    return isnan(chosen) || isnan(otherwise) ? otherwise : chosen;
}

preset_settings preset_chosen(const preset_settings *chosen)
{
    const preset_settings *d = &defaults[chosen->kind];
    return (preset_settings){.kind = chosen->kind,
                             .size = chosen->size > 0 ? chosen->size : d->size,
                             .axes = chosen->axes > 0 ? chosen->axes : d->axes,
                             .families = chosen->families > 0 ? chosen->families : d->families,
                             .length = either(chosen->length, d->length),
                             .mass = either(chosen->mass, d->mass),
                             .end_mass = either(chosen->end_mass, either(chosen->mass, d->end_mass)),
                             .stiffness = either(chosen->stiffness, d->stiffness),
                             .damping = either(chosen->damping, d->damping),
                             .drag = either(chosen->drag, d->drag),
                             .gravity = either(chosen->gravity, d->gravity),
                             .stretch = either(chosen->stretch, d->stretch)};
}

static spring_grid grid_of(const preset_settings *s)
{
    const uint32_t n = (uint32_t)s->size + shapes[s->kind].ends;
    spring_grid g = {.axes = (uint32_t)s->axes,
                     .stiffness = s->stiffness,
                     .damping = s->damping,
                     .stretch = s->stretch,
                     .spacing = s->length / (n - 1),
                     .families = s->families,
                     .pinned = shapes[s->kind].pinned};
    for (uint32_t i = 0; i < shapes[s->kind].dimensions; i++)
        g.count[i] = n;
    if (s->kind == PRESET_WATER && s->axes == 1) {
        g.height = true;
        g.stretch = 1;
        g.stiffness *= s->stretch > 0 ? 1 - 1 / s->stretch : 1;
    }
    return g;
}

/* Fills the initial positions of a grid, on three axes. */
static void fill_start(preset *r, double spacing)
{
    const uint32_t *n = r->count;
    double *p = r->start;
    for (uint32_t k = 0; k < n[2]; k++)
        for (uint32_t j = 0; j < n[1]; j++)
            for (uint32_t i = 0; i < n[0]; i++, p += 3) {
                p[0] = i * spacing;
                p[1] = j * spacing;
                p[2] = k * spacing;
            }
}

/* Displaces the middle by half the distance of two masses. */
static void pluck(preset *r, double spacing)
{
    const double end = r->count[0] - 1;
    for (uint32_t i = 0; i < r->count[0]; i++) {
        const double aside = spacing * (2 * i < end ? i : end - i) / end;
        r->position[i] += aside;
        r->start[3 * i] += aside;
    }
}

static spring_status allocate(preset *r, size_t particles, size_t links)
{
    r->start = calloc(3 * particles, sizeof *r->start);
    r->position = calloc(3 * particles, sizeof *r->position);
    r->pinned = calloc(particles, sizeof *r->pinned);
    r->mass = calloc(particles, sizeof *r->mass);
    r->link = calloc(links, sizeof *r->link);
    if (r->start != NULL && r->position != NULL && r->pinned != NULL && r->mass != NULL && r->link != NULL)
        return SPRING_OK;
    preset_clear(r);
    return SPRING_ENOMEM;
}

spring_status preset_init(preset *r, const preset_settings *s)
{
    const spring_grid g = grid_of(s);
    size_t particles, links;
    if (spring_grid_size(&g, &particles, &links) != SPRING_OK)
        return SPRING_ERANGE;
    *r = (preset){.count = {g.count[0], g.count[1] > 0 ? g.count[1] : 1, g.count[2] > 0 ? g.count[2] : 1}};
    if (allocate(r, particles, links) != SPRING_OK)
        return SPRING_ENOMEM;
    spring_grid_fill(&g, r->position, r->pinned, r->link);
    fill_start(r, g.spacing);
    r->def = (spring_scene_def){.axes = (uint32_t)s->axes,
                                .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, /* disturbances depend on time only */
                                .particles = particles,
                                .links = links,
                                .position = r->position,
                                .mass_all = s->mass,
                                .pinned = r->pinned,
                                .link = r->link,
                                .drag = s->drag};
    if (!isnan(s->gravity))
        r->def.gravity[s->axes - 1] = -s->gravity;
    if (s->kind == PRESET_CLOTH)
        r->pinned[0] = r->pinned[r->count[0] - 1] = 1;
    if (s->kind == PRESET_CHAIN)
        pluck(r, g.spacing);
    if (s->kind == PRESET_ROPE && s->end_mass != s->mass) {
        for (size_t i = 0; i < particles; i++)
            r->mass[i] = i + 1 < particles ? s->mass : s->end_mass;
        r->def.mass = r->mass;
    }
    return SPRING_OK;
}

void preset_clear(preset *r)
{
    free(r->start);
    free(r->position);
    free(r->pinned);
    free(r->mass);
    free(r->link);
    free(r->bend);
}

static spring_status make_bend(const preset *r, double rigidity, spring_weighted_link *out, size_t *count)
{
    const uint32_t *n = r->count;
    const spring_grid g = {
        .count = {n[0], n[1], n[2]}, .height = r->def.axes == 1, .spacing = r->start[3] - r->start[0]};
    return n[1] == 1
               ? spring_bend_rod(n[0], r->def.axes, r->position, r->pinned, rigidity, 0, out, count)
               : spring_bend_grid(&g, r->pinned, SPRING_BEND_ROWS | SPRING_BEND_DIAGONALS, rigidity, 0, out, count);
}

spring_status preset_bend(preset *r, double rigidity)
{
    size_t count = 0;
    spring_status status = make_bend(r, rigidity, NULL, &count);
    if (status != SPRING_OK || count == 0)
        return status;
    free(r->bend);
    r->def.weighted_links = 0;
    r->def.weighted_link = r->bend = malloc(count * sizeof *r->bend);
    if (r->bend == NULL)
        return SPRING_ENOMEM;
    status = make_bend(r, rigidity, r->bend, &count);
    r->def.weighted_links = count;
    return status;
}

spring_status preset_tether(preset *r, double fraction)
{
    const size_t particles = r->def.particles;
    size_t count = particles;
    r->def.links -= r->tethers;
    r->tethers = 0;
    r->fraction = fraction;
    spring_link *link = realloc(r->link, (r->def.links + particles) * sizeof *link);
    uint32_t *work = malloc(2 * particles * sizeof *work);
    double *distance = malloc(2 * particles * sizeof *distance);
    spring_status status = SPRING_ENOMEM;
    if (link != NULL)
        r->def.link = r->link = link;
    if (link != NULL && work != NULL && distance != NULL)
        status = spring_links_tethers(&r->def, fraction, 0, link + r->def.links, &count, work, distance);
    if (status == SPRING_OK)
        r->def.links += r->tethers = count;
    free(work);
    free(distance);
    return status;
}

bool preset_takes(const preset *r, spring_method m)
{
    spring_scene_def def = r->def;
    def.methods = 1u << m;
    return spring_scene_check(&def, NULL, NULL) == SPRING_OK;
}

spring_status preset_start(const preset *r, uint32_t methods, uint32_t flags, spring_scene **scene, size_t *bytes)
{
    spring_scene_def def = r->def;
    def.methods = methods;
    def.flags |= flags;
    *scene = NULL;
    spring_status status = spring_scene_bytes(&def, bytes);
    if (status != SPRING_OK)
        return status;
    void *memory = malloc(*bytes);
    if (memory == NULL)
        return SPRING_ENOMEM;
    status = spring_scene_init(memory, *bytes, &def, scene);
    if (status != SPRING_OK)
        free(memory);
    return status;
}

void preset_positions(const preset *r, const spring_scene *s, double *xyz)
{
    const uint32_t axes = r->def.axes;
    const bool height = axes == 1 && r->count[1] > 1;
    spring_scene_get(s, SPRING_POSITION, xyz, 3, 0, r->def.particles);
    if (axes == 3)
        return;
    for (size_t i = 0; i < r->def.particles; i++) {
        const double first = xyz[3 * i], second = xyz[3 * i + 1], *start = &r->start[3 * i];
        xyz[3 * i] = height ? start[0] : first;
        xyz[3 * i + 1] = start[1];
        xyz[3 * i + 2] = height ? first : axes == 2 ? second : start[2];
    }
}
