/* SPDX-License-Identifier: MIT */
/*
 * spring-bench, scenes: the rows. Ropes, sheets, blocks of jelly and water, in natural and in other orders, the cost of
 * each feature, and the cost of creating a scene.
 */
#include <stdio.h>
#include <string.h>

#include "bench_limits.h"
#include "bench_scene.h"
#include "parts.h"

static const scene_feature plainly = {.method = SPRING_LEAPFROG};
static const scene_feature copied = {.method = SPRING_LEAPFROG, .copied = true};

/* ------------------------------------------------------------------------------------------------------------ goals */

/* Goals for vectors of AVX-512, of AVX2, and of 16 bytes. */
static double by_vector(double avx512, double avx2, double others)
{
    const size_t lanes = bench_limits_of(false)->together;
    return lanes == 8 ? avx512 : lanes == 4 ? avx2 : others;
}

/* The required speedup over the plain loop; 0: none. */
static double goal_speedup(const scene_subject *s)
{
    if (s->shape == ROPE)
        return s->steps == 1 ? 0 : s->side <= 8 ? 1 : s->side >= 16 ? by_vector(1 / 0.6, 1 / 0.6, 1 / 0.85) : 1;
    if (s->feature.damping > 0 || s->feature.drag > 0 || s->feature.masses)
        return 0;
    if (s->order != NATURAL)
        return 1;
    if (s->shape == JELLY)
        return s->side <= 20 ? by_vector(2.1, 1.6, 0) : 0; /* in cache */
    return s->side == 10                     ? by_vector(1.6, 1.3, 0)
           : s->side == 35 || s->side == 128 ? by_vector(2.1, 1.6, 0)
           : s->side == 1000                 ? 2.2
                                             : 0;
}

/* The largest allowed ratio to the time of the limit; INFINITY: none. */
static double goal_ratio(const scene_subject *s)
{
    if (s->against == DEFINITION || s->against == SIXTEEN_STEPS)
        return INFINITY;
    if (s->single)
        return 0.5;
    if (s->feature.method == SPRING_RK4)
        return 4.3;
    if (s->feature.damping > 0)
        return s->side < 1000 ? 1.6 : 2.1;
    return s->shape == WATER ? 2.2 : INFINITY;
}

static const double most_init = 18;   /* [ns] per link, for scenes of 10^6 particles */
static const double most_excess = 25; /* [ns] overhead per step of one step per call, compared with 16 steps per call */

/* ------------------------------------------------------------------------------------------------------------- rows */

/* The plain loop supports only three axes, double precision and leapfrog, without a callback. */
static bool is_looped(const scene_subject *s)
{
    return s->shape != WATER && !s->single && s->against != DEFINITION && s->feature.method == SPRING_LEAPFROG &&
           s->feature.force == NULL && s->feature.flags == 0;
}

static void add(const char *name, const scene_subject *s)
{
    static const char *const shapes[] = {[ROPE] = "rope", [SHEET] = "sheet", [JELLY] = "jelly", [WATER] = "water"};
    static const char *const orders[] = {
        [NATURAL] = "", [LINKS_SHUFFLED] = "_links_shuffled", [SHUFFLED] = "_shuffled"};
    static const char *const besides[] = {[LIMITS] = "streams",
                                          [LEAPFROG] = "leapfrog",
                                          [IN_DOUBLE] = "double",
                                          [SIXTEEN_STEPS] = "16_steps",
                                          [DEFINITION] = "definition"};
    const size_t links = scene_links(s->shape, s->side);
    const bool looped = is_looped(s);
    bench_row row = {
        .part = "scene",
        .precision = s->single ? "float" : "double",
        .count = links,
        .steps = s->steps,
        .goal_ratio = goal_ratio(s),
        .goal_ns = s->against == DEFINITION && s->side == 1000 ? most_init : INFINITY,
        .goal_excess_ns = s->against == SIXTEEN_STEPS ? most_excess : 0,
        .goal_speedup = looped ? goal_speedup(s) : 0,
        .limits = {besides[s->against], s->against == LIMITS ? "arithmetic" : NULL},
        .baseline = looped ? "list" : NULL,
        .long_only = links > 2000000,
        .time = scene_time,
    };
    if (s->against == DEFINITION)
        snprintf(row.kernel, sizeof row.kernel, "init_%s", shapes[s->shape]);
    else
        snprintf(row.kernel, sizeof row.kernel, "%s_%s_%d%s%s", spring_method_name(s->feature.method), shapes[s->shape],
                 (int)s->steps, orders[s->order], name);
    bench_add(&row, s, sizeof *s);
}

static const uint32_t sides[] = {10, 35, 128, 400, 1000};

enum { side_count = sizeof sides / sizeof sides[0] };

static void add_ropes(void)
{
    static const uint32_t particles[] = {2, 3, 4, 8, 16, 32, 64};
    for (size_t i = 0; i < sizeof particles / sizeof particles[0]; i++) {
        add("", &(scene_subject){.shape = ROPE, .side = particles[i], .feature = plainly, .steps = 16});
        add("", &(scene_subject){
                    .shape = ROPE, .side = particles[i], .feature = plainly, .steps = 1, .against = SIXTEEN_STEPS});
    }
}

/* Adds rows for one and for sixteen steps per call. */
static void add_both(scene_subject s)
{
    s.steps = 1;
    add("", &s);
    if ((s.order == LINKS_SHUFFLED || s.order == SHUFFLED) &&
        s.side > 128) /* slow, and no data stay in the cache between steps */
        return;
    s.steps = 16;
    add("", &s);
}

static void add_shapes(void)
{
    for (scene_order order = NATURAL; order <= SHUFFLED; order++)
        for (int i = 0; i < side_count; i++)
            add_both((scene_subject){.shape = SHEET, .side = sides[i], .order = order, .feature = plainly});
    for (uint32_t side = 10; side <= 40; side *= 2)
        add_both((scene_subject){.shape = JELLY, .side = side, .feature = plainly});
    add("_copied", &(scene_subject){.shape = JELLY, .side = 10, .feature = copied, .steps = 16, .against = LEAPFROG});
    for (int i = 1; i < side_count; i++) {
        add_both((scene_subject){.shape = WATER, .side = sides[i], .feature = plainly});
        add_both((scene_subject){
            .shape = SHEET, .side = sides[i], .feature = plainly, .against = IN_DOUBLE, .single = true});
    }
}

/* Wind. */
static void blow(void *user, double t, size_t particles, const double *const position[3],
                 const double *const velocity[3], double *const force[3])
{
    (void)user;
    (void)t;
    (void)position;
    (void)velocity;
    double *z = force[2];
    for (size_t i = 0; i < particles; i++)
        z[i] += 0.02;
}

/* Adds the other methods, then the features one by one, compared with the scene without them. */
static void add_features(uint32_t side)
{
    static const struct {
        const char *name;
        scene_feature feature;
    } features[] = {
        {"_damping", {.method = SPRING_LEAPFROG, .damping = 0.05}},
        {"_drag", {.method = SPRING_LEAPFROG, .drag = 0.01}},
        {"_masses", {.method = SPRING_LEAPFROG, .masses = true}},
        {"_callback", {.method = SPRING_LEAPFROG, .force = blow}},
        {"_callback_still", {.method = SPRING_LEAPFROG, .force = blow, .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY}},
        {"_editable", {.method = SPRING_LEAPFROG, .flags = SPRING_SCENE_EDITABLE}},
        {"_no_undo", {.method = SPRING_LEAPFROG, .flags = SPRING_SCENE_NO_UNDO}},
    };
    scene_subject s = {.shape = SHEET, .side = side, .steps = 16, .against = LEAPFROG};
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        s.feature = (scene_feature){.method = spring_method_at(i)};
        if (s.feature.method != SPRING_LEAPFROG && spring_method_describe(s.feature.method)->scenes && side <= 128)
            add("", &s);
    }
    for (size_t i = 0; i < sizeof features / sizeof features[0]; i++) {
        s.feature = features[i].feature;
        if (side <= 128 || s.feature.damping > 0) /* the feature with a second pass over the links */
            add(features[i].name, &s);
    }
}

void bench_add_scenes(void)
{
    add_ropes();
    add_shapes();
    add_features(35);
    add_features(128);
    add_features(1000);
    for (int i = 1; i < side_count; i++)
        add("",
            &(scene_subject){.shape = SHEET, .side = sides[i], .feature = plainly, .steps = 1, .against = DEFINITION});
}
