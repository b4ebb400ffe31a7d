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
    const void *w, *g, *a; /* NULL: absent */
} bench_streams;

typedef struct bench_arithmetic {
    void (*run[2][2])(uint64_t steps); /* by damped, loaded */
} bench_arithmetic;

typedef struct bench_limits {
    size_t springs;                                                   /* springs per step of `arithmetic` */
    void (*streams[2][2][2])(const bench_streams *s, uint64_t times); /* by presence of w, g, a */
    bench_arithmetic arithmetic[SPRING_METHOD_COUNT];                 /* by method; NULL: use `least` */
    bench_arithmetic least;
    void (*read)(const void *memory, size_t bytes, uint64_t times); /* up to the next whole vector */
    size_t together;                                                /* links computed at once */
    void (*links[3])(uint64_t times);                               /* by axes - 1 */
} bench_limits;

/** The limits for the widest vectors; single: in single precision. */
const bench_limits *bench_limits_of(bool single);

static inline const bench_arithmetic *bench_arithmetic_of(const bench_limits *l, spring_method m)
{
    return l->arithmetic[m].run[0][0] != NULL ? &l->arithmetic[m] : &l->least;
}

#endif
