/* SPDX-License-Identifier: MIT */
/*
 * Arbitrary bytes as a saved state: the bytes themselves, or changes of some words of a valid state, with a valid check
 * value. A state that is refused changes no byte of the scene. A state that is accepted is saved again with the same
 * numbers, and the scene lives on.
 *
 * The first byte chooses the scene and what the others are.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/scene.h>

#include "../state_check.h"
#include "fuzz.h"

#ifdef FUZZ_FLOAT
#define SPRING_FLOAT
#endif
#include "../../src/kernels/single_precision.h"

#define spring_scene_def public_scene_def /* of the precision */

enum { room = 1 << 18, most_bytes = 1 << 15 };

enum { kinds = 64 };

static size_t block; /* [bytes] of the scene */

enum { most_particles = 48, most_links = 300 };

/* The arrays of a definition. */
typedef struct arrays {
    double position[3 * most_particles], radius[most_particles], friction[most_particles];
    double distance[2 * most_particles];
    uint8_t pinned[most_particles];
    uint32_t mask[most_particles], work[3 * most_particles];
    spring_link link[most_links];
    spring_weighted_link weighted[most_particles];
} arrays;

/* Tethers, weighted links in a band and elsewhere, and particles with contacts of their own. */
static void enrich(spring_scene_def *def, arrays *y)
{
    size_t tethers = most_links - def->links;
    if (def->axes > 1) {
        must(spring_links_tethers(def, 0.05, 0.1, y->link + def->links, &tethers, y->work, y->distance) == SPRING_OK,
             "tethers");
        for (size_t i = 0; i < tethers; i++)
            y->link[def->links + i].damping = i % 2 == 0 ? 0.01 : 0;
        def->links += tethers;
    }
    def->weighted_links = def->particles - 3;
    def->weighted_link = y->weighted;
    for (uint32_t i = 0; i < def->weighted_links; i++) {
        const bool band = i % 5 != 4;
        y->weighted[i] = (spring_weighted_link){.particle = {i, i + 1, i + 2, i + 3},
                                                .weight = {band ? 1 : -0.25, band ? -2 : -0.25, band ? 1 : -0.5, !band},
                                                .rest = i % 10 == 9 ? 0.1 : 0,
                                                .stiffness = 3,
                                                .damping = i % 4 * 0.01};
    }
    for (uint32_t i = 0; i < def->particles; i++) {
        y->radius[i] = 0.01 * (i % 3);
        y->friction[i] = i % 4;
        y->mask[i] = i % 4;
    }
    if (def->colliders > 0) {
        def->radius = y->radius;
        def->friction = y->friction;
        def->mask = y->mask;
    }
}

static spring_scene *make(void *memory, unsigned kind)
{
    const spring_grid g = {
        .count = {kind % 2 ? 3 : 12, 4},
        .axes = 1 + kind % 3,
        .height = kind % 3 == 0,
        .spacing = 0.1,
        .families = kind & 2 ? SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR : SPRING_GRID_STRUCTURAL,
        .stiffness = 30,
        .damping = kind & 4 ? 0.1 : 0,
        .pinned = SPRING_GRID_FIRST_X,
    };
    static arrays y;
    spring_scene_def def = {.axes = g.axes,
                            .flags = (kind & 8 ? SPRING_SCENE_EDITABLE : 0) | (kind & 16 ? SPRING_SCENE_FORCES : 0),
                            .position = y.position,
                            .pinned = y.pinned,
                            .link = y.link,
                            .drag = 0.1,
                            .colliders = g.axes > 1 ? 9 : 0};
    const bool rich = (kind & 32) != 0;
    spring_scene *s = NULL;
    must(spring_grid_size(&g, &def.particles, &def.links) == SPRING_OK && def.particles <= most_particles &&
             def.links <= most_links && spring_grid_fill(&g, y.position, y.pinned, y.link) == SPRING_OK,
         "a grid");
    if (rich)
        enrich(&def, &y);
    must(spring_scene_bytes(&def, &block) == SPRING_OK && spring_scene_init(memory, room, &def, &s) == SPRING_OK,
         "a scene");
    const spring_collider c[] = {
        {.shape = SPRING_SPHERE, .at = {0.1, 0.1, 0}, .radius = 0.11, .velocity = {0.1}},
        {.shape = SPRING_BOX,
         .at = {0.4, 0.1, 0},
         .axis = {{1}, {0, 1}, {0, 0, 1}},
         .half = {0.1, 0.15, 0.1},
         .velocity = {0.1},
         .spin = {0, 0, 1},
         .friction = 0.4,
         .restitution = 0.2,
         .acceleration = {0, 0.3},
         .spin_acceleration = {0, 0, 0.5},
         .surface = {0.1},
         .mask = 2},
    };
    if (def.colliders > 0)
        must(spring_scene_set_colliders(s, c, rich ? 2 : 1) == SPRING_OK, "colliders");
    must(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 20) == SPRING_OK, "steps");
    return s;
}

/* A scene, which is made only once. */
static spring_scene *scene_of(void *memory, unsigned kind)
{
    static _Alignas(SPRING_SCENE_ALIGN) uint8_t made[kinds][room];
    static size_t blocks[kinds];
    if (blocks[kind] == 0) {
        (void)make(made[kind], kind);
        blocks[kind] = block;
    }
    block = blocks[kind];
    return memcpy(memory, made[kind], block);
}

static size_t save(const spring_scene *s, uint8_t *state)
{
    size_t size = most_bytes;
    must(spring_scene_save(s, state, &size) == SPRING_OK && size % 8 == 0, "a scene can be saved");
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static _Alignas(SPRING_SCENE_ALIGN) uint8_t memory[room], before[room], state[most_bytes], again[most_bytes];
    enum { change = 10 }; /* bytes: two for the word, eight for its value */
    if (size == 0)
        return 0;
    const unsigned kind = data[0] % kinds;
    spring_scene *const s = scene_of(memory, kind);
    size_t bytes = save(s, state);
    if (data[0] < 64) {
        for (const uint8_t *at = data + 1; at + change <= data + size; at += change)
            set_state_word(state, (at[0] + 256u * at[1]) % (bytes / 8), state_word(at + 2, 0));
        sign_state(state, bytes / 8);
    } else {
        bytes = size - 1 < most_bytes ? size - 1 : most_bytes;
        memcpy(state, data + 1, bytes);
        if (data[0] < 128 && bytes >= 16) {
            bytes = bytes / 8 * 8;
            sign_state(state, bytes / 8);
        }
    }
    memcpy(before, memory, block);
    const spring_status status = spring_scene_load(s, state, bytes);
    if (status != SPRING_OK) {
        must((status == SPRING_EINVAL || status == SPRING_EMISMATCH) && memcmp(before, memory, block) == 0,
             "a refused state changes nothing");
        return 0;
    }
    const size_t now = save(s, again);
    must(now == bytes && spring_scene_load(s, again, now) == SPRING_OK && save(s, state) == now &&
             memcmp(state, again, now) == 0,
         "an accepted state can be saved and loaded");
    (void)spring_scene_stable_step(s, SPRING_LEAPFROG);
    (void)spring_scene_energy(s);
    (void)spring_scene_at_rest(s, 1, 1);
    (void)spring_scene_set_pinned(s, 5, 1, &(uint8_t){1}); /* tethers act, or cease to */
    (void)spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 3);
    (void)spring_scene_advance(s, SPRING_SYMPLECTIC_EULER, 2e-3, 3);
    (void)spring_scene_save(s, state, &(size_t){most_bytes});
    return 0;
}
