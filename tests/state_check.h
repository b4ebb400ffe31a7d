/* SPDX-License-Identifier: MIT */
/* The check value of a saved state, written from docs/details.md: for tests that make states which no scene saves. */
#ifndef TEST_STATE_CHECK_H
#define TEST_STATE_CHECK_H

#include <stddef.h>
#include <stdint.h>

static inline uint64_t state_word(const uint8_t *state, size_t i)
{
    uint64_t word = 0;
    for (unsigned k = 0; k < 8; k++)
        word |= (uint64_t)state[8 * i + k] << 8 * k;
    return word;
}

static inline void set_state_word(uint8_t *state, size_t i, uint64_t word)
{
    for (unsigned k = 0; k < 8; k++)
        state[8 * i + k] = (uint8_t)(word >> 8 * k);
}

static inline uint64_t mixed_word(uint64_t hash, uint64_t word)
{
    const uint64_t sum = hash + word;
    return (sum << 31 | sum >> 33) * UINT64_C(0x9E3779B97F4A7C15);
}

static inline uint64_t check_value(const uint8_t *state, size_t words)
{
    uint64_t lane[16] = {0}, hash = 8 * words;
    for (size_t i = 0; i < (words + 7) / 8 * 8; i++) {
        const uint64_t sum = lane[i % 8] + (i < words ? state_word(state, i) : 0);
        lane[i % 8] = sum << 32 | sum >> 32;
        lane[8 + i % 8] += lane[i % 8];
    }
    for (int k = 0; k < 16; k++)
        hash = mixed_word(hash, lane[k]);
    return hash ^ hash >> 32;
}

/* Makes the check value of a state of so many words right again. */
static inline void sign_state(uint8_t *state, size_t words)
{
    set_state_word(state, words - 1, check_value(state, words - 1));
}

#endif
