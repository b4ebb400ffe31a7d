/* SPDX-License-Identifier: MIT */
/*
 * Eight numbers at a time, for what spring-work compares the library with. Files that include this are compiled with
 * -fno-math-errno, or each root would be a call, and call their loops from functions for the instruction sets that the
 * library has kernels for.
 */
#ifndef SPRINGSTEP_WORK_LANES_H
#define SPRINGSTEP_WORK_LANES_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"

enum { LANES = 8 };

typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));
typedef float floats __attribute__((vector_size(LANES * sizeof(float))));

#define INLINE static inline __attribute__((always_inline))

/* A macro, since a function that returns long vectors has another convention for each instruction set. */
#define LOAD(vector, array)  memcpy(&(vector), (array), sizeof(vector))
#define STORE(array, vector) memcpy((array), &(vector), sizeof(vector))

/* Before a loop over axes whose arrays should be kept in registers. */
#if defined(__clang__)
#define UNROLL _Pragma("clang loop unroll(full)")
#else
#define UNROLL _Pragma("GCC unroll 3")
#endif

/* Zeros, at the start of a cache line; exits without memory. */
static inline void *aligned_room(size_t bytes)
{
    const size_t line = 64, whole = (bytes + line - 1) / line * line;
    void *room = aligned_alloc(line, whole);
    if (room == NULL)
        cli_fail(CLI_FAILED, "no memory for %zu bytes", whole);
    return memset(room, 0, whole);
}

/* 1/sqrt(a) by a square root and a quotient in float, and one step of third order in double: 1 ulp, for 1e-30 < a < 1e30. */
INLINE void inverse_root(const lanes *a, lanes *root)
{
    float each[LANES];
    floats seed = __builtin_convertvector(*a, floats);
    STORE(each, seed);
    for (int j = 0; j < LANES; j++)
        each[j] = sqrtf(each[j]);
    LOAD(seed, each);
    seed = 1 / seed;
    const lanes y = __builtin_convertvector(seed, lanes), r = 1 - *a * (y * y);
    *root = y + y * r * (0.5 + 0.375 * r);
}

#endif
