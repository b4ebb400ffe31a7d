/* SPDX-License-Identifier: MIT */
/*
 * What a method is: one header with every form of it, and one row of methods.h.
 *
 * The header, NAME.h, is read once for each shape of data, which the including file chooses by a definition:
 *
 *     SPRING_SHAPE_ONE    in spring.c      NAME_one    what it is called, its kernel, loops, stable step
 *     SPRING_SHAPE_BATCH  in kernels.h     NAME_batch  its kernel for vectors of springs, a function
 *     SPRING_SHAPE_SCENE  in scene_step.c  NAME_scene  its step and stable step in a scene, what a scene stores for it
 *
 * The others are constant objects, of types that one_method and scene_method name; what a method does not offer is 0 in
 * them. Only the exact solution has no loops.
 */
#ifndef SPRINGSTEP_METHOD_H
#define SPRINGSTEP_METHOD_H

#include "rates.h"
#include "roots.h"
#include "simd/real.h"
#include "step_terms.h"

#if defined(SPRING_SHAPE_BATCH)
#include "batch_group.h"
#elif defined(SPRING_SHAPE_SCENE)
#include "scene_step.h"
#endif

/* n kernel calls in one. */
typedef spring_state spring_loop(spring_state s, const spring_rates *r, double dt, uint64_t n);

typedef struct one_method {
    spring_method_info info;
    spring_step_fn *kernel;
    spring_loop *loop[2][2];                      /* by damped, loaded; NULL: n steps are one evaluation over n dt */
    double (*stable_step)(const spring_roots *r); /* [s] */
    step_terms_fn *terms;                         /* NULL: a step has no error but rounding */
    uint64_t digest;                              /* see self_test.c */
} one_method;

/* What is written once for all methods is included with SPRING_METHOD set to one, and names its parts so. */
#define SPRING_PASTE(method, name)  method##_##name
#define SPRING_PASTED(method, name) SPRING_PASTE(method, name)
#define METHOD(name)                SPRING_PASTED(SPRING_METHOD, name)

/* function(..., damped, loaded) with flags that are constants there: one choice here, none in its loops. */
#define SPRING_BY_FEATURES(damped, loaded, function, ...)         \
    (!(damped) && !(loaded) ? function(__VA_ARGS__, false, false) \
     : !(damped)            ? function(__VA_ARGS__, false, true)  \
     : !(loaded)            ? function(__VA_ARGS__, true, false)  \
                            : function(__VA_ARGS__, true, true))

#endif
