/* SPDX-License-Identifier: MIT */
/* What a row of spring-bench on scenes is about. */
#ifndef SPRINGSTEP_BENCH_SCENE_H
#define SPRINGSTEP_BENCH_SCENE_H

#include "rows.h"
#include "scene_grids.h"

/* What a scene has besides its links, gravity and pins, or how it is advanced. */
typedef struct scene_feature {
    spring_method method;
    uint32_t flags;
    double drag, damping;
    spring_scene_force_fn *force;
    bool masses;
} scene_feature;

/* What a row is compared with. */
typedef enum scene_against {
    LIMITS,        /* the kernels of bench_limits.h */
    LEAPFROG,      /* the scene without its feature, by leapfrog */
    IN_DOUBLE,     /* the scene in double */
    SIXTEEN_STEPS, /* the scene, 16 steps a call */
    SHUFFLED_LIST  /* the plain loop, before the scene was renumbered */
} scene_against;

/* What is timed. */
typedef enum scene_work { STEPS, INIT, RENUMBER } scene_work;

typedef struct scene_subject {
    scene_shape shape;
    uint32_t side; /* particles along an edge */
    scene_order order;
    scene_feature feature;
    uint64_t steps; /* a call */
    scene_against against;
    bool single;     /* float */
    scene_work work; /* all but STEPS are compared with reading the links of the definition */
} scene_subject;

/** The time of a row whose subject is a scene_subject. */
double scene_time(const bench_row *row, int which, uint64_t calls);

#endif
