/* SPDX-License-Identifier: MIT */
/* The interface of spring-engines to physics engines, which all simulate the same sheet. C and C++. */
#ifndef SPRINGSTEP_BENCH_ENGINE_H
#define SPRINGSTEP_BENCH_ENGINE_H

#include <springstep/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct physics_engine {
    const char *name;
    const char *precision;        /* of the engine */
    const char *(*version)(void); /* notes if the build is a slow one; call it before make() */
    uint32_t axes;                /* 2 or 3 */

    /* Creates a world from the gravity, masses, pins and links of a definition; NULL: out of memory. */
    void *(*make)(const spring_scene_def *def);
    void (*step)(void *world, double dt);
    void (*position)(const void *world, size_t particle, double *x); /* [m] */
} physics_engine;

extern const physics_engine engine_bullet, engine_chipmunk;

#ifdef __cplusplus
}
#endif

#endif
