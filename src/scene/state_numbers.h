/* SPDX-License-Identifier: MIT */
/* The numbers of a saved state: their byte order, its check value, and tests of many numbers at once. */
#ifndef SPRINGSTEP_STATE_NUMBERS_H
#define SPRINGSTEP_STATE_NUMBERS_H

#include "../simd/arithmetic.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <springstep/scene.h>

enum { word_bytes = sizeof(uint64_t) };

static inline bool little_endian(void)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, sizeof first);
    return first == 1;
}

/* Copies numbers of this processor to or from a state. */
static inline void copy_numbers(void *to, const void *from, size_t count, size_t size)
{
    if (little_endian()) {
        memcpy(to, from, count * size);
        return;
    }
    uint8_t *const out = to;
    const uint8_t *const in = from;
    for (size_t i = 0; i < count * size; i += size)
        for (size_t k = 0; k < size; k++)
            out[i + k] = in[i + size - 1 - k];
}

/* Loads numbers from a state, or saves them. */
static inline void move_numbers(void *numbers, uint8_t *state, size_t count, size_t size, bool load)
{
    copy_numbers(load ? numbers : state, load ? state : numbers, count, size);
}

static inline uint64_t word_at(const uint8_t *state)
{
    uint64_t word;
    copy_numbers(&word, state, 1, sizeof word);
    return word;
}

static inline bool bit_at(const uint8_t *state, size_t i)
{
    return (state[i / 8] >> i % 8 & 1) != 0;
}

/* Sets bit i, which is 0. */
static inline void set_bit(uint8_t *state, size_t i)
{
    state[i / 8] = (uint8_t)(state[i / 8] | 1 << i % 8);
}

/* A bit after bit i, so that those in between are 0. */
static inline size_t next_bit(const uint8_t *state, size_t i)
{
    return state[i / 8] == 0 ? i / 8 * 8 + 8 : i + 1;
}

/* `hash` with one more word. */
static inline uint64_t hashed(uint64_t hash, uint64_t word)
{
    const uint64_t sum = hash + word;
    return (sum << 31 | sum >> 33) * UINT64_C(0x9E3779B97F4A7C15);
}

/* bytes: a multiple of 8 */
SPRING_INTERNAL uint64_t spring_state_check(const uint8_t *state, size_t bytes);

/* Whether all numbers of a padded section are finite, also if they are multiplied by a number below 2^headroom, which
   is less than the largest; and not negative, unless any_sign. precision: [bytes] of a number */
SPRING_INTERNAL bool spring_state_valid(const uint8_t *state, size_t bytes, size_t precision, bool any_sign,
                                        uint64_t headroom);

enum { collider_words = 1 + 41 }; /* of a saved collider */

/* Loads or saves `count` colliders of a scene, of which `set` are set. A loaded collider keeps its function. */
SPRING_INTERNAL void spring_state_colliders(spring_collider *own, uint32_t set, size_t count, uint8_t *state,
                                            bool load);

/* Whether saved colliders are valid. The last arguments are those of spring_collider_invalid_field(). */
SPRING_INTERNAL bool spring_state_colliders_valid(const spring_collider *own, uint32_t set, size_t count,
                                                  uint8_t *state, size_t precision, double radius, uint32_t axes);

#endif
