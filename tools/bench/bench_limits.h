/* SPDX-License-Identifier: MIT */
/*
 * What no batch and no scene can be faster than: kernels that only move the memory, and kernels that only do the
 * arithmetic.
 *
 * streams     reads x, v and the parameters that are there, one by one, and writes x and v as they were.
 * read        reads memory.
 * arithmetic  does the multiplications and additions of a step and nothing else: states and coefficients stay in
 *             registers, on as many independent vectors as run best. A method that has none here gets that of one kick
 *             and one drift, less than which no step does.
 * links       does what the force of a link takes: differences, length, quotient, both ends' sums; all in registers.
 *
 * Like the library's they are compiled for vectors of 16, 32 and 64 bytes, and the widest that the processor has is
 * used.
 */
#ifndef SPRINGSTEP_BENCH_LIMITS_H
#define SPRINGSTEP_BENCH_LIMITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/spring.h>

typedef struct bench_streams {
    size_t count; /* springs; memory is touched up to the next whole vector */
    void *x, *v;
    const void *w, *g, *a; /* NULL: not there */
} bench_streams;

typedef struct bench_arithmetic {
    void (*run[2][2])(uint64_t steps); /* by damped, loaded */
} bench_arithmetic;

typedef struct bench_limits {
    size_t springs;                                                   /* that the arithmetic is done for, at once */
    void (*streams[2][2][2])(const bench_streams *s, uint64_t times); /* by: there is w, g, a */
    bench_arithmetic arithmetic[SPRING_METHOD_COUNT];                 /* by method; NULL: as little as there can be */
    bench_arithmetic least;
    void (*read)(const void *memory, size_t bytes, uint64_t times); /* up to the next whole vector */
    size_t together;                                                /* links that are computed at once */
    void (*links[3])(uint64_t times);                               /* by axes - 1 */
} bench_limits;

/** The limits in the widest vectors; single: of float instead of double. */
const bench_limits *bench_limits_of(bool single);

static inline const bench_arithmetic *bench_arithmetic_of(const bench_limits *l, spring_method m)
{
    return l->arithmetic[m].run[0][0] != NULL ? &l->arithmetic[m] : &l->least;
}

#endif
