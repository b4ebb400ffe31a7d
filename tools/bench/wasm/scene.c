/* SPDX-License-Identifier: MIT */
/* A scene for bench.mjs: one sheet of cloth or water, advanced by the library, with arrays accessible to JavaScript. */
#include <stdlib.h>

#include <springstep/scene.h>

#define EXPORT __attribute__((visibility("default"), used))

static struct {
    size_t particles, links;
    double *position, *now;
    uint8_t *pinned;
    spring_link *link;
    spring_scene *scene;
} all;

/* Creates a sheet of side x side particles, pinned at two edges, with structural, shear and bend links. Returns false
   on failure. */
EXPORT bool make(uint32_t side, bool water, double mass, double gravity)
{
    const spring_grid grid = {
        .count = {side, side},
        .height = water,
        .spacing = 0.1,
        .stretch = 1.05,
        .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
        .stiffness = 20000,
        .pinned = SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y,
    };
    if (spring_grid_size(&grid, &all.particles, &all.links) != SPRING_OK)
        return false;
    all.position = malloc(3 * all.particles * sizeof *all.position);
    all.now = malloc(3 * all.particles * sizeof *all.now);
    all.pinned = malloc(all.particles);
    all.link = malloc(all.links * sizeof *all.link);
    if (all.position == NULL || all.now == NULL || all.pinned == NULL || all.link == NULL)
        return false;
    spring_grid_fill(&grid, all.position, all.pinned, all.link);
    const spring_scene_def def = {
        .axes = water ? 1 : 3,
        .particles = all.particles,
        .links = all.links,
        .position = all.position,
        .mass_all = mass,
        .pinned = all.pinned,
        .link = all.link,
        .gravity = {water ? gravity : 0, gravity},
    };
    size_t bytes;
    if (spring_scene_bytes(&def, &bytes) != SPRING_OK)
        return false;
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    return memory != NULL && spring_scene_init(memory, bytes, &def, &all.scene) == SPRING_OK;
}

EXPORT double stable_step(void)
{
    return spring_scene_stable_step(all.scene, SPRING_LEAPFROG);
}

EXPORT bool advance(double dt, uint32_t steps)
{
    return spring_scene_advance(all.scene, SPRING_LEAPFROG, dt, steps) == SPRING_OK;
}

EXPORT uint32_t particles(void)
{
    return (uint32_t)all.particles;
}

EXPORT uint32_t links(void)
{
    return (uint32_t)all.links;
}

/* Positions of the definition. */
EXPORT const double *positions(void)
{
    return all.position;
}

EXPORT const uint8_t *pins(void)
{
    return all.pinned;
}

EXPORT uint32_t link_end(uint32_t link, bool b)
{
    return b ? all.link[link].b : all.link[link].a;
}

EXPORT double link_rest(uint32_t link)
{
    return all.link[link].rest;
}

EXPORT double link_stiffness(uint32_t link)
{
    return all.link[link].stiffness;
}

/* Current positions. */
EXPORT const double *state(void)
{
    spring_scene_get(all.scene, SPRING_POSITION, all.now, 0, 0, all.particles);
    return all.now;
}
