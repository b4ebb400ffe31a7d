/* SPDX-License-Identifier: MIT */
/* A physics engine that spring-engines times: the same sheet in each, behind one interface. C and C++. */
#ifndef SPRINGSTEP_BENCH_ENGINE_H
#define SPRINGSTEP_BENCH_ENGINE_H

#include <springstep/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct physics_engine {
    const char *name;
    const char *precision;        /* its own */
    const char *(*version)(void); /* with what makes this build slow, if anything; call it before make() */
    uint32_t axes;                /* it works in two, or in three */

    /* What it needs for a definition; NULL: no memory. It may take gravity, masses, pins and links from there. */
    void *(*make)(const spring_scene_def *def);
    void (*step)(void *world, double dt);
    void (*position)(const void *world, size_t particle, double *x); /* [m] */
} physics_engine;

extern const physics_engine engine_bullet, engine_chipmunk;

#ifdef __cplusplus
}
#endif

#endif
