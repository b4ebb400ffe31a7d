/* SPDX-License-Identifier: MIT */
/*
 * The numbers of a saved state: their byte order, its check value, and tests of many numbers at once.
 *
 * Check     Eight lanes of 64-bit words, each with one rotation and one multiplication per word. CRC-32 and FNV-1a take
 *           a byte at a time, several times as long as two steps, and XXH64 has two multiplications per word. Adding a
 *           word, the rotation and the multiplication by an odd number are bijections, so a change of one word always
 *           changes the value. The rotation brings the sign bits of numbers where the multiplication spreads them.
 */
#ifndef SPRINGSTEP_STATE_NUMBERS_H
#define SPRINGSTEP_STATE_NUMBERS_H

#include "../simd/compiler.h"
#include "../simd/scalar.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

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

static inline scalar number_at(const uint8_t *state, size_t i)
{
    scalar number;
    copy_numbers(&number, state + i * sizeof number, 1, sizeof number);
    return number;
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
static inline uint64_t check_value(const uint8_t *state, size_t bytes)
{
    enum { lanes = 8 };
    uint64_t lane[lanes] = {0}, hash = bytes;
    size_t i = 0;
    for (; i + lanes * word_bytes <= bytes; i += lanes * word_bytes) {
        SPRING_UNROLL
        for (size_t k = 0; k < lanes; k++)
            lane[k] = hashed(lane[k], word_at(state + i + k * word_bytes));
    }
    for (size_t k = 0; i < bytes; i += word_bytes, k++)
        lane[k] = hashed(lane[k], word_at(state + i));
    for (size_t k = 0; k < lanes; k++)
        hash = hashed(hash, lane[k]);
    return hash ^ hash >> 32;
}

/* Words that are tested at once. */
#if defined(__GNUC__)
typedef uint64_t word_group __attribute__((vector_size(2 * sizeof(uint64_t))));
#else
typedef uint64_t word_group;
#endif

/* In single precision, a word has two numbers. The result has the signs of those that are not valid: for any_sign,
   adding `one` to an exponent that is too large carries into the sign. */
SPRING_INLINE word_group invalid_signs(const uint8_t *state, size_t words, uint64_t one, bool any_sign)
{
    const uint64_t exponents =
        sizeof(scalar) == sizeof(float) ? UINT64_C(0x7f8000007f800000) : UINT64_C(0x7ff0000000000000);
    word_group word = {0};
    copy_numbers(&word, state, words, word_bytes);
    return any_sign ? (word & exponents) + one : word | (word + one);
}

SPRING_INLINE bool all_valid(const uint8_t *state, size_t bytes, uint64_t one, bool any_sign)
{
    const uint64_t signs =
        sizeof(scalar) == sizeof(float) ? UINT64_C(0x8000000080000000) : UINT64_C(0x8000000000000000);
    enum { group = sizeof(word_group), groups = 4 };
    word_group invalid = {0};
    uint64_t part[group / word_bytes], all = 0;
    size_t i = 0;
    for (; i + groups * group <= bytes; i += groups * group) {
        SPRING_UNROLL
        for (size_t k = 0; k < groups; k++)
            invalid |= invalid_signs(state + i + k * group, group / word_bytes, one, any_sign);
    }
    for (; i < bytes; i += word_bytes)
        invalid |= invalid_signs(state + i, 1, one, any_sign);
    memcpy(part, &invalid, sizeof part);
    for (size_t k = 0; k < group / word_bytes; k++)
        all |= part[k];
    return (all & signs) == 0;
}

/* Whether all numbers of a padded section are finite, also if they are multiplied by a number below 2^headroom, which is
   less than the largest; and not negative, unless any_sign. */
static inline bool numbers_valid(const uint8_t *state, size_t bytes, bool any_sign, uint64_t headroom)
{
    const uint64_t last_bits =
        sizeof(scalar) == sizeof(float) ? UINT64_C(0x0080000000800000) : UINT64_C(0x0010000000000000);
    const uint64_t one = last_bits * (1 + headroom);
    return any_sign ? all_valid(state, bytes, one, true) : all_valid(state, bytes, one, false);
}

#endif
