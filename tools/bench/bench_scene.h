/* SPDX-License-Identifier: MIT */
/* The subject of a row of spring-bench on scenes. */
#ifndef SPRINGSTEP_BENCH_SCENE_H
#define SPRINGSTEP_BENCH_SCENE_H

#include "rows.h"
#include "scene_grids.h"

/* Features of a scene besides links, gravity and pins, and of its steps. */
typedef struct scene_feature {
    spring_method method;
    uint32_t flags;
    double drag, damping;
    spring_scene_force_fn *force;
    bool masses;
    bool copied; /* the scene is a copy whose arrays are not aligned to a cache line */
} scene_feature;

/* The comparison of a row. */
typedef enum scene_against {
    LIMITS,        /* the kernels of bench_limits.h */
    LEAPFROG,      /* the scene without its feature, by leapfrog */
    IN_DOUBLE,     /* the scene in double precision */
    SIXTEEN_STEPS, /* the scene with 16 steps per call */
    DEFINITION     /* the time to read the links of the definition: this row times spring_scene_init() */
} scene_against;

typedef struct scene_subject {
    scene_shape shape;
    uint32_t side; /* particles along an edge */
    scene_order order;
    scene_feature feature;
    uint64_t steps; /* per call */
    scene_against against;
    bool single; /* single precision */
} scene_subject;

/** The time of a row whose subject is a scene_subject. */
double scene_time(const bench_row *row, int which, uint64_t calls);

#endif
