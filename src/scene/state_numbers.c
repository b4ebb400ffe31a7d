/* SPDX-License-Identifier: MIT */
/*
 * The check value of a saved state, and tests of many numbers at once.
 *
 * Check     Eight lanes of 64-bit words, each with a sum of its words and a sum of these sums. Both are additions of SIMD
 *           vectors, which take a third of the time of a multiplication per word. After each word, the halves of the sum
 *           are exchanged: otherwise the second sum would lose the signs of numbers, which are the highest bits. Adding
 *           a word and exchanging halves are bijections, so a change of one word always changes the first sum of its
 *           lane.
 */
#include "state_numbers.h"

#include "../simd/compiler.h"

/* Words that are processed together. */
#if defined(__GNUC__)
typedef uint64_t word_group __attribute__((vector_size(2 * sizeof(uint64_t))));
#else
typedef uint64_t word_group;
#endif

enum {
    check_lanes = 8,
    group_bytes = sizeof(word_group),
    lane_groups = check_lanes * word_bytes / group_bytes,
    row_bytes = lane_groups * group_bytes
};

SPRING_INLINE word_group group_at(const uint8_t *state)
{
    word_group words;
    copy_numbers(&words, state, group_bytes / word_bytes, word_bytes);
    return words;
}

/* Exchanges the halves of each word. gcc 12 does not find the instruction. */
SPRING_INLINE word_group halves_exchanged(word_group words)
{
#if defined(__GNUC__) && defined(__SSE2__)
    return (word_group)_mm_shuffle_epi32((__m128i)words, 0xB1);
#else
    return words << 32 | words >> 32;
#endif
}

uint64_t spring_state_check(const uint8_t *state, size_t bytes)
{
    word_group sum[lane_groups], second[lane_groups];
    uint8_t last[row_bytes] = {0};
    uint64_t lane[2 * check_lanes], hash = bytes;
    memset(sum, 0, sizeof sum);
    memset(second, 0, sizeof second);
    memcpy(last, state + bytes / row_bytes * row_bytes, bytes % row_bytes);
    for (size_t i = 0; i < bytes; i += row_bytes) {
        const uint8_t *const at = i + row_bytes <= bytes ? state + i : last;
        SPRING_UNROLL
        for (size_t k = 0; k < lane_groups; k++) {
            sum[k] = halves_exchanged(sum[k] + group_at(at + k * group_bytes));
            second[k] += sum[k];
        }
    }
    memcpy(lane, sum, sizeof sum);
    memcpy(lane + check_lanes, second, sizeof second);
    for (size_t k = 0; k < 2 * check_lanes; k++)
        hash = hashed(hash, lane[k]);
    return hash ^ hash >> 32;
}

bool spring_state_valid(const uint8_t *state, size_t bytes, size_t precision, bool any_sign, uint64_t headroom)
{
    /* In single precision, a word has two numbers. */
    const uint64_t each = precision == sizeof(float) ? UINT64_C(0x100000001) : 1;
    const uint64_t sign = each * (precision == sizeof(float) ? UINT64_C(0x80000000) : UINT64_C(0x8000000000000000));
    const uint64_t last_bit = each * (precision == sizeof(float) ? UINT64_C(0x00800000) : UINT64_C(0x0010000000000000));
    const uint64_t one = last_bit * (1 + headroom), exponents = sign - last_bit, wrong = any_sign ? 0 : sign;
    word_group invalid[lane_groups]; /* has the signs of numbers that are not valid */
    uint8_t last[row_bytes] = {0};
    uint64_t lane[check_lanes], all = 0;
    memset(invalid, 0, sizeof invalid);
    memcpy(last, state + bytes / row_bytes * row_bytes, bytes % row_bytes);
    for (size_t i = 0; i < bytes; i += row_bytes) {
        const uint8_t *const at = i + row_bytes <= bytes ? state + i : last;
        SPRING_UNROLL
        for (size_t k = 0; k < lane_groups; k++) {
            const word_group words = group_at(at + k * group_bytes);
            invalid[k] |= ((words & exponents) + one) | (words & wrong); /* a large exponent carries into the sign */
        }
    }
    memcpy(lane, invalid, sizeof lane);
    for (size_t k = 0; k < check_lanes; k++)
        all |= lane[k];
    return (sign & all) == 0;
}
