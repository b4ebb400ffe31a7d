/* SPDX-License-Identifier: MIT */
/*
 * spring-bench, scenes: timing of the rows, compared with a plain loop over the links and with limits from memory
 * bandwidth and arithmetic (bench_limits.h).
 *
 * The work of a scene is proportional to its links, so times are per link.
 */
#include "bench_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench_limits.h"
#include "common/cli.h"
#include "common/timing.h"
#include "plain_loop.h"

static scene_arrays all;
static double dt; /* [s] half the safe step of leapfrog */

/* ----------------------------------------------------------------------------------------------------------- scenes */

static spring_scene_def definition(const scene_feature *f, scene_shape shape)
{
    spring_scene_def def = {
        .axes = scene_axes(shape),
        .flags = f->flags,
        .methods = 1u << f->method | 1u << SPRING_LEAPFROG,
        .particles = all.particles,
        .links = all.links,
        .position = all.position,
        .mass = f->masses ? all.mass : NULL,
        .mass_all = scene_mass,
        .pinned = all.pinned,
        .link = all.link,
        .drag = f->drag,
        .force = f->force,
    };
    memcpy(def.gravity, scene_gravity, sizeof def.gravity);
    return def;
}

/* The definition of a single-precision scene; none of these rows has a callback. */
static spring_scenef_def single(const spring_scene_def *d)
{
    spring_scenef_def def = {
        .axes = d->axes,
        .flags = d->flags,
        .methods = d->methods,
        .particles = d->particles,
        .links = d->links,
        .position = d->position,
        .mass = d->mass,
        .mass_all = d->mass_all,
        .pinned = d->pinned,
        .link = d->link,
        .drag = d->drag,
    };
    memcpy(def.gravity, d->gravity, sizeof def.gravity);
    return def;
}

static void check(spring_status status)
{
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "a scene of %zu links: %s", all.links, spring_status_string(status));
}

/* The scene of a row, or of its comparison. */
typedef struct built {
    void *memory;
    size_t bytes;
    bool single;
    spring_scene *scene; /* one of these is set */
    spring_scenef *scenef;
    double stable_step; /* [s] of its method */
} built;

static built ours, other;

static void init(built *b, const spring_scene_def *def)
{
    if (b->single) {
        const spring_scenef_def f = single(def);
        check(spring_scenef_init(b->memory, b->bytes, &f, &b->scenef));
    } else {
        check(spring_scene_init(b->memory, b->bytes, def, &b->scene));
    }
}

static double stable_step(const built *b, spring_method m)
{
    return b->single ? spring_scenef_stable_step(b->scenef, m) : spring_scene_stable_step(b->scene, m);
}

static void build(built *b, const scene_feature *f, scene_shape shape, bool is_single)
{
    const spring_scene_def def = definition(f, shape);
    const spring_scenef_def twin = single(&def);
    b->single = is_single;
    check(is_single ? spring_scenef_bytes(&twin, &b->bytes) : spring_scene_bytes(&def, &b->bytes));
    free(b->memory);
    const size_t shift = f->copied ? SPRING_SCENE_ALIGN / 2 + 8 : 0;
    b->memory = scene_allocate(b->bytes + shift);
    init(b, &def);
    if (f->copied) {
        void *const copy = memmove((char *)b->memory + shift, b->memory, b->bytes);
        b->scene = b->single ? NULL : copy;
        b->scenef = b->single ? copy : NULL;
    }
    b->stable_step = stable_step(b, f->method);
    dt = 0.5 * stable_step(b, SPRING_LEAPFROG);
}

static void advance(const built *b, spring_method method, uint64_t steps, uint64_t calls)
{
    /* if no step is stable, the step is so short that the scene overflows only after more steps than a row takes */
    const double h = b->stable_step > 0 ? fmin(dt, 0.5 * b->stable_step) : 1e-6 * dt;
    for (; calls > 0; calls--)
        check(b->single ? spring_scenef_advance(b->scenef, method, h, steps)
                        : spring_scene_advance(b->scene, method, h, steps));
}

/* -------------------------------------------------------------------------------------------------- the plain loop */

static plain_scene plain;

static void build_plain(const scene_feature *f)
{
    free(plain.particle);
    plain = (plain_scene){
        .particles = all.particles,
        .links = all.links,
        .particle = scene_allocate(all.particles * sizeof *plain.particle),
        .link = all.link,
        .drag = f->drag,
        .damped = f->damping > 0,
    };
    memcpy(plain.gravity, scene_gravity, sizeof plain.gravity);
    for (size_t i = 0; i < all.particles; i++) {
        const double mass = f->masses ? all.mass[i] : scene_mass;
        plain.particle[i] = (plain_particle){.inverse_mass = all.pinned[i] != 0 ? 0 : 1 / mass};
        memcpy(plain.particle[i].x, &all.position[3 * i], sizeof plain.particle[i].x);
    }
}

/* ------------------------------------------------------------------------------------------------------ the samples */

/* Reads and writes positions and velocities, and reads forces and the data of each link: a byte for equal links in
   bands, two indices and two numbers for listed links. Uses the memory of the definition where possible. */
static void move_memory(const scene_subject *s, uint64_t passes)
{
    const bench_limits *limits = bench_limits_of(s->single);
    const size_t scalar = s->single ? sizeof(float) : sizeof(double), values = scene_axes(s->shape) * all.particles;
    const size_t link_bytes = s->order == NATURAL ? 1 : 2 * sizeof(uint32_t) + 2 * scalar;
    static char *state;
    static size_t allocated;
    const size_t array = (values * scalar / SPRING_SCENE_ALIGN + 1) * SPRING_SCENE_ALIGN;
    if (allocated < 3 * array) {
        free(state);
        allocated = 3 * array;
        state = scene_allocate(allocated);
        memset(state, 0, allocated);
    }
    const bench_streams streams = {values, state, state + array, 1, {state + 2 * array}};
    for (; passes > 0; passes--) {
        limits->streams(&streams, 1);
        limits->read(all.link, all.links * link_bytes, 1);
    }
}

static void build_other(const scene_subject *s)
{
    const scene_feature leapfrog = {.method = SPRING_LEAPFROG};
    for (size_t i = 0; i < all.links; i++)
        all.link[i].damping = 0;
    build(&other, &leapfrog, s->shape, false);
    for (size_t i = 0; i < all.links; i++)
        all.link[i].damping = s->feature.damping;
}

static void prepare(const bench_row *row)
{
    static const scene_subject *filled;
    const scene_subject *s = row->subject;
    if (s == filled)
        return;
    filled = s;
    scene_fill(&all, s->shape, s->side, s->order, s->feature.damping);
    build(&ours, &s->feature, s->shape, s->single);
    if (s->against == LEAPFROG || s->against == IN_DOUBLE)
        build_other(s);
    if (row->baseline != NULL)
        build_plain(&s->feature);
}

static void run_ours(const scene_subject *s, uint64_t calls)
{
    const spring_scene_def def = definition(&s->feature, s->shape);
    if (s->against != DEFINITION)
        advance(&ours, s->feature.method, s->steps, calls);
    else
        for (; calls > 0; calls--)
            init(&ours, &def);
}

static void run_limit(const scene_subject *s, int which, uint64_t calls, uint64_t steps)
{
    const bench_limits *limits = bench_limits_of(s->single);
    if (s->against == DEFINITION)
        limits->read(all.link, all.links * sizeof *all.link, calls);
    else if (s->against == SIXTEEN_STEPS)
        advance(&ours, s->feature.method, 16, (s->steps * calls + 15) / 16);
    else if (s->against != LIMITS)
        advance(&other, SPRING_LEAPFROG, s->steps, calls);
    else if (which == 1)
        move_memory(s, steps);
    else
        limits->links(scene_axes(s->shape), steps * all.links / limits->together + 1);
}

double scene_time(const bench_row *row, int which, uint64_t calls)
{
    const scene_subject *s = row->subject;
    prepare(row);
    /* all steps of the plain loop and of limits take the same time, so in large scenes one step is timed instead of a
       call */
    const bool scenes = which == 0 || (which != bench_baseline && s->against != LIMITS);
    const uint64_t share = all.links > 300000 && !scenes ? s->steps : 1, steps = s->steps / share;
    const double begin = timing_busy();
    if (which == 0)
        run_ours(s, calls);
    else if (which != bench_baseline)
        run_limit(s, which, calls, steps * calls);
    else
        for (uint64_t i = 0; i < calls; i++)
            plain_advance(&plain, dt, steps);
    return (timing_busy() - begin) * (double)share;
}
