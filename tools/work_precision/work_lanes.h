/* SPDX-License-Identifier: MIT */
/*
 * SIMD vectors of eight numbers, for the code with which spring-work compares the library. Files that include this are
 * compiled with -fno-math-errno, since otherwise each square root would be a call. They call their loops from functions
 * compiled for the same instruction sets as the kernels of the library.
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

/* Macros, because the calling convention for long vectors depends on the instruction set. */
#define LOAD(vector, array)  memcpy(&(vector), (array), sizeof(vector))
#define STORE(array, vector) memcpy((array), &(vector), sizeof(vector))

/* Placed before a loop over axes, so that its arrays stay in registers. */
#if defined(__clang__)
#define UNROLL _Pragma("clang loop unroll(full)")
#else
#define UNROLL _Pragma("GCC unroll 3")
#endif

/* Zeroed memory, aligned to a cache line; exits if out of memory. */
static inline void *aligned_room(size_t bytes)
{
    const size_t line = 64, whole = (bytes + line - 1) / line * line;
    void *room = aligned_alloc(line, whole);
    if (room == NULL)
        cli_fail(CLI_FAILED, "no memory for %zu bytes", whole);
    return memset(room, 0, whole);
}

/* 1/sqrt(a) by a square root and a quotient in single precision and one iteration of third order in double precision.
   Error at most 1 ulp for 1e-30 < a < 1e30. */
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
