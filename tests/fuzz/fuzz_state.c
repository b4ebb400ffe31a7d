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

enum { room = 1 << 18, most_bytes = 1 << 15 };

static size_t block; /* [bytes] of the scene */

static void must(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "fuzz_state: %s\n", what);
    abort();
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
    static double position[3 * 48];
    static uint8_t pinned[48];
    static spring_link link[200];
    spring_scene_def def = {.axes = g.axes,
                            .flags = (kind & 8 ? SPRING_SCENE_EDITABLE : 0) | (kind & 16 ? SPRING_SCENE_FORCES : 0),
                            .position = position,
                            .pinned = pinned,
                            .link = link,
                            .drag = 0.1,
                            .colliders = g.axes > 1 ? 9 : 0};
    spring_scene *s = NULL;
    must(spring_grid_size(&g, &def.particles, &def.links) == SPRING_OK && def.links <= 200 &&
             spring_grid_fill(&g, position, pinned, link) == SPRING_OK &&
             spring_scene_bytes(&def, &block) == SPRING_OK && spring_scene_init(memory, room, &def, &s) == SPRING_OK,
         "a scene");
    const spring_collider c = {.shape = SPRING_SPHERE, .at = {0.1, 0.1, 0}, .radius = 0.11, .velocity = {0.1}};
    if (def.colliders > 0)
        must(spring_scene_set_colliders(s, &c, 1) == SPRING_OK, "a collider");
    must(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 20) == SPRING_OK, "steps");
    return s;
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
    const unsigned kind = data[0] % 32;
    spring_scene *const s = make(memory, kind);
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
        must(status == SPRING_EINVAL && memcmp(before, memory, block) == 0, "a refused state changes nothing");
        return 0;
    }
    const size_t now = save(s, again);
    must(now == bytes && spring_scene_load(s, again, now) == SPRING_OK && save(s, state) == now &&
             memcmp(state, again, now) == 0,
         "an accepted state can be saved and loaded");
    (void)spring_scene_stable_step(s, SPRING_LEAPFROG);
    (void)spring_scene_energy(s);
    (void)spring_scene_at_rest(s, 1, 1);
    (void)spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 3);
    (void)spring_scene_advance(s, SPRING_SYMPLECTIC_EULER, 2e-3, 3);
    (void)spring_scene_save(s, state, &(size_t){most_bytes});
    return 0;
}
