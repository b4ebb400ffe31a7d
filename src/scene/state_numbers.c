/* SPDX-License-Identifier: MIT */
/*
 * The check value of a saved state, and tests of many numbers at once.
 *
 * Check     Eight lanes of 64-bit words, each with one rotation and one multiplication per word. CRC-32 and FNV-1a take
 *           a byte at a time, several times as long as two steps, and XXH64 has two multiplications per word. Adding a
 *           word, the rotation and the multiplication by an odd number are bijections, so a change of one word always
 *           changes the value. The rotation brings the sign bits of numbers where the multiplication spreads them.
 */
#include "state_numbers.h"

#include "../simd/compiler.h"

uint64_t spring_state_check(const uint8_t *state, size_t bytes)
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

/* The result has the signs of numbers that are not valid: for any_sign, adding `one` to an exponent that is too large
   carries into the sign. */
SPRING_INLINE word_group invalid_signs(const uint8_t *state, size_t words, uint64_t one, uint64_t exponents,
                                       bool any_sign)
{
    word_group word = {0};
    copy_numbers(&word, state, words, word_bytes);
    return any_sign ? (word & exponents) + one : word | (word + one);
}

SPRING_INLINE uint64_t all_invalid_signs(const uint8_t *state, size_t bytes, uint64_t one, uint64_t exponents,
                                         bool any_sign)
{
    enum { group = sizeof(word_group), groups = 4 };
    word_group invalid = {0};
    uint64_t part[group / word_bytes], all = 0;
    size_t i = 0;
    for (; i + groups * group <= bytes; i += groups * group) {
        SPRING_UNROLL
        for (size_t k = 0; k < groups; k++)
            invalid |= invalid_signs(state + i + k * group, group / word_bytes, one, exponents, any_sign);
    }
    for (; i < bytes; i += word_bytes)
        invalid |= invalid_signs(state + i, 1, one, exponents, any_sign);
    memcpy(part, &invalid, sizeof part);
    for (size_t k = 0; k < group / word_bytes; k++)
        all |= part[k];
    return all;
}

bool spring_state_valid(const uint8_t *state, size_t bytes, size_t precision, bool any_sign, uint64_t headroom)
{
    /* In single precision, a word has two numbers. */
    const uint64_t each = precision == sizeof(float) ? UINT64_C(0x100000001) : 1;
    const uint64_t sign = each * (precision == sizeof(float) ? UINT64_C(0x80000000) : UINT64_C(0x8000000000000000));
    const uint64_t last_bit = each * (precision == sizeof(float) ? UINT64_C(0x00800000) : UINT64_C(0x0010000000000000));
    const uint64_t one = last_bit * (1 + headroom), exponents = sign - last_bit;
    return (sign & (any_sign ? all_invalid_signs(state, bytes, one, exponents, true)
                             : all_invalid_signs(state, bytes, one, exponents, false))) == 0;
}
