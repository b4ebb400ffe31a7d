/* SPDX-License-Identifier: MIT */
/* The scenes of spring-bench; see scene_grids.h. All have a pinned edge. */
#include "scene_grids.h"

#include <stdlib.h>
#include <string.h>

#include "common/cli.h"

void *scene_allocate(size_t bytes)
{
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, (bytes / SPRING_SCENE_ALIGN + 2) * SPRING_SCENE_ALIGN);
    if (memory == NULL)
        cli_fail(CLI_FAILED, "no memory for %zu bytes of a scene", bytes);
    return memory;
}

uint32_t scene_axes(scene_shape shape)
{
    return shape == WATER ? 1 : 3;
}

static spring_grid grid_of(scene_shape shape, uint32_t side, double damping)
{
    return (spring_grid){
        .count = {side, shape == ROPE ? 1 : side, shape == JELLY ? side : 1},
        .height = shape == WATER,
        .spacing = 0.1,
        .stretch = 1.05, /* so that sheets do not crumple: compressed springs need shorter steps */
        .families =
            shape == ROPE ? SPRING_GRID_STRUCTURAL : SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
        .stiffness = 20000,
        .damping = damping,
        .pinned = shape == ROPE ? SPRING_GRID_FIRST_X : SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y,
    };
}

static void size_of(const spring_grid *grid, size_t *particles, size_t *links)
{
    if (spring_grid_size(grid, particles, links) != SPRING_OK)
        cli_fail(CLI_FAILED, "no grid of side %u", grid->count[0]);
}

size_t scene_links(scene_shape shape, uint32_t side)
{
    const spring_grid grid = grid_of(shape, side, 0);
    size_t particles, links;
    size_of(&grid, &particles, &links);
    return links;
}

/* A pseudorandom number below n, from the high bits of Knuth's 64-bit generator. */
static size_t below(uint64_t *state, size_t n)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (size_t)((*state >> 32) * n >> 32);
}

static void shuffle_links(scene_arrays *all, uint64_t *state)
{
    for (size_t i = all->links; i > 1; i--) { /* Fisher and Yates */
        const size_t j = below(state, i);
        const spring_link kept = all->link[i - 1];
        all->link[i - 1] = all->link[j];
        all->link[j] = kept;
    }
}

/* Numbers the particles at random. */
static void shuffle_particles(scene_arrays *all, uint64_t *state)
{
    uint32_t *number = scene_allocate(all->particles * sizeof *number);
    double *position = scene_allocate(all->particles * 3 * sizeof *position);
    uint8_t *pinned = scene_allocate(all->particles);
    for (size_t i = 0; i < all->particles; i++) { /* the same, inside-out variant */
        const size_t j = below(state, i + 1);
        number[i] = number[j];
        number[j] = (uint32_t)i;
    }
    for (size_t i = 0; i < all->particles; i++) {
        memcpy(&position[3 * number[i]], &all->position[3 * i], 3 * sizeof *position);
        pinned[number[i]] = all->pinned[i];
    }
    for (size_t i = 0; i < all->links; i++) {
        all->link[i].a = number[all->link[i].a];
        all->link[i].b = number[all->link[i].b];
    }
    free(number);
    free(all->position);
    free(all->pinned);
    all->position = position;
    all->pinned = pinned;
}

void scene_fill(scene_arrays *all, scene_shape shape, uint32_t side, scene_order order, double damping)
{
    const spring_grid grid = grid_of(shape, side, damping);
    free(all->position);
    free(all->mass);
    free(all->pinned);
    free(all->link);
    size_of(&grid, &all->particles, &all->links);
    all->position = scene_allocate(all->particles * 3 * sizeof *all->position);
    all->mass = scene_allocate(all->particles * sizeof *all->mass);
    all->pinned = scene_allocate(all->particles);
    all->link = scene_allocate(all->links * sizeof *all->link);
    spring_grid_fill(&grid, all->position, all->pinned, all->link);
    for (size_t i = 0; i < all->particles; i++)
        all->mass[i] = scene_mass * (1 + 0.1 * (double)(i % 7));
    uint64_t state = 1;
    if (order == SHUFFLED)
        shuffle_particles(all, &state);
    if (order != NATURAL)
        shuffle_links(all, &state);
}
