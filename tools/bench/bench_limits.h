/* SPDX-License-Identifier: MIT */
/*
 * Lower limits on the time of batches and scenes: kernels that only move memory, and kernels that only do arithmetic.
 *
 * streams     reads x, v and the existing parameters, and writes x and v unchanged.
 * read        reads memory.
 * arithmetic  does only the multiplications and additions of a step. States and coefficients stay in registers, for the
 *             number of independent vectors that is fastest. Methods without an entry get one kick and one drift, the
 *             least that any step does.
 * links       does the arithmetic of the force of a link: differences, length, quotient, sums of both ends; all in
 *             registers.
 *
 * Like the kernels of the library, they are compiled for vectors of 16, 32 and 64 bytes, and the widest that the
 * processor supports is used.
 */
#ifndef SPRINGSTEP_BENCH_LIMITS_H
#define SPRINGSTEP_BENCH_LIMITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/spring.h>

typedef struct bench_streams {
    size_t count; /* springs; memory is accessed up to the next whole vector */
    void *x, *v;
    int parameters;
    const void *parameter[3]; /* [parameters] */
} bench_streams;

typedef struct bench_limits {
    size_t springs, together; /* springs per step of `arithmetic`; links computed at once */
    void (*streams)(const bench_streams *s, uint64_t times);
    void (*read)(const void *memory, size_t bytes, uint64_t times); /* up to the next whole vector */
    void (*arithmetic)(spring_method m, bool damped, bool loaded, uint64_t steps);
    void (*links)(uint32_t axes, uint64_t times); /* 1 or 3 axes */
} bench_limits;

/** The limits for the widest vectors; single: in single precision. */
const bench_limits *bench_limits_of(bool single);

#endif
