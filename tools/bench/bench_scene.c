/* SPDX-License-Identifier: MIT */
/*
 * spring-bench, scenes: sheets, blocks of jelly and water, in natural order and shuffled, beside the plain loop over a
 * list of links that anybody would write, and beside what memory and arithmetic alone would take (bench_limits.h).
 *
 * All of them have gravity and a pinned edge. The work of a scene is proportional to its links, so those are what
 * counts.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/scene.h>

#include "bench_limits.h"
#include "common/cli.h"
#include "common/timing.h"
#include "parts.h"
#include "rows.h"

typedef enum scene_shape { SHEET, JELLY, WATER } scene_shape;
typedef enum scene_order { NATURAL, LINKS_SHUFFLED, SHUFFLED } scene_order; /* SHUFFLED: the particles, too */

/* What a scene models beside its links, gravity and pins, or how it is advanced. */
typedef struct feature {
    spring_method method;
    uint32_t flags;
    double drag, damping;
    spring_scene_force_fn *force;
    bool masses;
} feature;

typedef struct subject {
    scene_shape shape;
    uint32_t side; /* particles along an edge */
    scene_order order;
    feature feature;
    uint64_t steps;
    bool single; /* float */
    bool init;   /* is what is timed */
} subject;

/* ---------------------------------------------------------------------------------------------------- the
   definition */

static struct {
    size_t particles, links;
    double *position, *mass;
    uint8_t *pinned;
    spring_link *link;
} all;

static const double mass = 0.1, gravity[3] = {0.3, -9.81, -0.5}; /* [kg], [m/s^2] */

static void *allocate(size_t bytes)
{
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, (bytes / SPRING_SCENE_ALIGN + 2) * SPRING_SCENE_ALIGN);
    if (memory == NULL)
        cli_fail(CLI_FAILED, "no memory for a scene of %zu links", all.links);
    return memory;
}

static uint32_t axes_of(scene_shape shape)
{
    return shape == WATER ? 1 : 3;
}

static spring_grid grid_of(const subject *s)
{
    return (spring_grid){
        .count = {s->side, s->side, s->shape == JELLY ? s->side : 1},
        .height = s->shape == WATER,
        .spacing = 0.1,
        .stretch = 1.05, /* so that no sheet crumples: springs that are pressed together need shorter steps */
        .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
        .stiffness = 20000,
        .damping = s->feature.damping,
        .pinned = SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y,
    };
}

static size_t links_of(const subject *s)
{
    const spring_grid grid = grid_of(s);
    size_t particles, links;
    if (spring_grid_size(&grid, &particles, &links) != SPRING_OK)
        cli_fail(CLI_FAILED, "no grid of side %u", s->side);
    return links;
}

/* Knuth's 64-bit generator, high bits: below n. */
static size_t below(uint64_t *state, size_t n)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (size_t)((*state >> 32) * n >> 32);
}

static void shuffle_links(uint64_t *state)
{
    for (size_t i = all.links; i > 1; i--) { /* Fisher and Yates */
        const size_t j = below(state, i);
        const spring_link kept = all.link[i - 1];
        all.link[i - 1] = all.link[j];
        all.link[j] = kept;
    }
}

/* Numbers the particles at random. */
static void shuffle_particles(uint64_t *state)
{
    uint32_t *number = allocate(all.particles * sizeof *number);
    double *position = allocate(all.particles * 3 * sizeof *position);
    uint8_t *pinned = allocate(all.particles);
    for (size_t i = 0; i < all.particles; i++) { /* the same, from the inside out */
        const size_t j = below(state, i + 1);
        number[i] = number[j];
        number[j] = (uint32_t)i;
    }
    for (size_t i = 0; i < all.particles; i++) {
        memcpy(&position[3 * number[i]], &all.position[3 * i], 3 * sizeof *position);
        pinned[number[i]] = all.pinned[i];
    }
    for (size_t i = 0; i < all.links; i++) {
        all.link[i].a = number[all.link[i].a];
        all.link[i].b = number[all.link[i].b];
    }
    free(number);
    free(all.position);
    free(all.pinned);
    all.position = position;
    all.pinned = pinned;
}

static void fill(const subject *s)
{
    const spring_grid grid = grid_of(s);
    if (spring_grid_size(&grid, &all.particles, &all.links) != SPRING_OK)
        cli_fail(CLI_FAILED, "no grid of side %u", s->side);
    all.position = allocate(all.particles * 3 * sizeof *all.position);
    all.pinned = allocate(all.particles);
    all.link = allocate(all.links * sizeof *all.link);
    all.mass = allocate(all.particles * sizeof *all.mass);
    spring_grid_fill(&grid, all.position, all.pinned, all.link);
    for (size_t i = 0; i < all.particles; i++)
        all.mass[i] = mass * (1 + 0.1 * (double)(i % 7));
    uint64_t state = 1;
    if (s->order == SHUFFLED)
        shuffle_particles(&state);
    if (s->order != NATURAL)
        shuffle_links(&state);
}

/* ----------------------------------------------------------------------------------------------------------- scenes */

static spring_scene_def definition(const feature *f, scene_shape shape)
{
    spring_scene_def def = {
        .axes = axes_of(shape),
        .flags = f->flags,
        .methods = 1u << f->method | 1u << SPRING_LEAPFROG,
        .particles = all.particles,
        .links = all.links,
        .position = all.position,
        .mass = f->masses ? all.mass : NULL,
        .mass_all = mass,
        .pinned = all.pinned,
        .link = all.link,
        .drag = f->drag,
        .force = f->force,
    };
    memcpy(def.gravity, gravity, sizeof def.gravity);
    return def;
}

/* The definition of a float scene; no row of one has a callback. */
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

/* The scene of a row, and that which it is compared with. */
typedef struct built {
    void *memory;
    size_t bytes;
    bool single;
    spring_scene *scene; /* one of the two */
    spring_scenef *scenef;
    double stable_step; /* [s] of its method */
} built;

static built ours, other;
static double dt; /* [s] half of what is safe for leapfrog */

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

static void build(built *b, const feature *f, scene_shape shape, bool is_single)
{
    const spring_scene_def def = definition(f, shape);
    const spring_scenef_def twin = single(&def);
    b->single = is_single;
    check(is_single ? spring_scenef_bytes(&twin, &b->bytes) : spring_scene_bytes(&def, &b->bytes));
    free(b->memory);
    b->memory = allocate(b->bytes);
    init(b, &def);
    b->stable_step = stable_step(b, f->method);
    dt = 0.5 * stable_step(b, SPRING_LEAPFROG);
}

static void advance(const built *b, spring_method method, uint64_t steps, uint64_t calls)
{
    /* where no step is stable a scene blows up: here after more steps than a row takes */
    const double h = b->stable_step > 0 ? fmin(dt, 0.5 * b->stable_step) : 1e-6 * dt;
    for (; calls > 0; calls--)
        check(b->single ? spring_scenef_advance(b->scenef, method, h, steps)
                        : spring_scene_advance(b->scene, method, h, steps));
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

/* ---------------------------------------------------------------------------------------------------- the plain
   loop */

typedef struct particle {
    double x[3], v[3], force[3], inverse_mass;
} particle;

static particle *plain;

static void build_plain(void)
{
    free(plain);
    plain = allocate(all.particles * sizeof *plain);
    for (size_t i = 0; i < all.particles; i++) {
        plain[i] = (particle){.inverse_mass = all.pinned[i] != 0 ? 0 : 1 / mass};
        memcpy(plain[i].x, &all.position[3 * i], sizeof plain[i].x);
    }
}

static void kick(double h)
{
    for (particle *p = plain; p < plain + all.particles; p++)
        if (p->inverse_mass > 0)
            for (int a = 0; a < 3; a++)
                p->v[a] += h * (p->inverse_mass * p->force[a] + gravity[a]);
}

static void drift(void)
{
    for (particle *p = plain; p < plain + all.particles; p++)
        for (int a = 0; a < 3; a++)
            p->x[a] += dt * p->v[a];
}

static void pull(void)
{
    for (particle *p = plain; p < plain + all.particles; p++)
        p->force[0] = p->force[1] = p->force[2] = 0;
    for (const spring_link *link = all.link; link < all.link + all.links; link++) {
        particle *a = &plain[link->a], *b = &plain[link->b];
        const double x = b->x[0] - a->x[0], y = b->x[1] - a->x[1], z = b->x[2] - a->x[2];
        const double length = sqrt(x * x + y * y + z * z);
        const double scale = link->stiffness * (length - link->rest) / length;
        a->force[0] += scale * x;
        a->force[1] += scale * y;
        a->force[2] += scale * z;
        b->force[0] -= scale * x;
        b->force[1] -= scale * y;
        b->force[2] -= scale * z;
    }
}

static void advance_plain(uint64_t steps)
{
    for (; steps > 0; steps--) { /* the forces of the last step are kept */
        kick(dt / 2);
        drift();
        pull();
        kick(dt / 2);
    }
}

/* ------------------------------------------------------------------------------------------------------- the
   samples */

/* Positions and velocities are read and written, forces read, and of each link what a scene keeps: of equal links in
   rows a byte, of listed ones two indices and two numbers. The memory is that of the definition, as far as it goes. */
static void move_memory(const subject *s, uint64_t passes)
{
    const bench_limits *limits = bench_limits_of(s->single);
    const size_t scalar = s->single ? sizeof(float) : sizeof(double), values = axes_of(s->shape) * all.particles;
    const size_t link_bytes = s->order == NATURAL ? 1 : 2 * sizeof(uint32_t) + 2 * scalar;
    static char *state;
    static size_t allocated;
    const size_t array = (values * scalar / SPRING_SCENE_ALIGN + 1) * SPRING_SCENE_ALIGN;
    if (allocated < 3 * array) {
        free(state);
        allocated = 3 * array;
        state = allocate(allocated);
        memset(state, 0, allocated);
    }
    const bench_streams streams = {values, state, state + array, state + 2 * array, NULL, NULL};
    for (; passes > 0; passes--) {
        limits->streams[1][0][0](&streams, 1);
        limits->read(all.link, all.links * link_bytes, 1);
    }
}

static void read_definition(uint64_t times)
{
    const bench_limits *limits = bench_limits_of(false);
    limits->read(all.link, all.links * sizeof *all.link, times);
}

static const feature plainly = {.method = SPRING_LEAPFROG};

static bool is_scene(const char *limit) /* or is it a kernel of bench_limits.h? */
{
    return strcmp(limit, "leapfrog") == 0 || strcmp(limit, "double") == 0;
}

static void prepare(const bench_row *row)
{
    static const subject *filled;
    const subject *s = row->subject;
    if (s == filled)
        return;
    filled = s;
    free(all.position);
    free(all.pinned);
    free(all.link);
    free(all.mass);
    fill(s);
    build(&ours, &s->feature, s->shape, s->single);
    if (is_scene(row->limits[0])) {
        for (size_t i = 0; i < all.links; i++)
            all.link[i].damping = 0;
        build(&other, &plainly, s->shape, false);
    }
    if (row->baseline != NULL)
        build_plain();
}

static double run(const bench_row *row, int which, uint64_t calls)
{
    const subject *s = row->subject;
    const bench_limits *limits = bench_limits_of(s->single);
    prepare(row);
    /* a step of the plain loop, or of a limit, takes as long as any other: in large scenes one stands for those of a
       call */
    const uint64_t share = all.links > 300000 ? s->steps : 1, steps = s->steps / share * calls;
    const char *limit = which == 0 || which == bench_baseline ? "" : row->limits[which - 1];
    const spring_scene_def def = definition(&s->feature, s->shape);
    const double begin = timing_busy();
    if (which == 0 && s->init) {
        for (uint64_t i = 0; i < calls; i++)
            init(&ours, &def);
    } else if (which == 0) {
        advance(&ours, s->feature.method, s->steps, calls);
    } else if (is_scene(limit)) {
        advance(&other, SPRING_LEAPFROG, s->steps, calls);
    } else if (which == bench_baseline) {
        advance_plain(steps);
    } else if (strcmp(limit, "definition") == 0) {
        read_definition(calls);
    } else if (strcmp(limit, "streams") == 0) {
        move_memory(s, steps);
    } else {
        limits->links[axes_of(s->shape) - 1](steps * all.links / limits->together + 1);
    }
    const double elapsed = timing_busy() - begin;
    return which == 0 || is_scene(limit) ? elapsed : elapsed * (double)share;
}

/* --------------------------------------------------------------------------------------------------------- the rows */

static const double least_speedup = 2.5, most_float = 0.65; /* what the library promises */
static const double most_init = 500;                        /* [ns] a link */

static const char *const shapes[] = {[SHEET] = "sheet", [JELLY] = "jelly", [WATER] = "water"},
                         *const orders[] = {
                             [NATURAL] = "", [LINKS_SHUFFLED] = "_links_shuffled", [SHUFFLED] = "_shuffled"};

/* A row beside the limits and the plain loop, or beside another scene. */
static void add(const char *name, subject s, const char *beside, double goal_ratio, double goal_ns)
{
    const bool looped = beside == NULL && s.shape != WATER && !s.single;
    const size_t links = links_of(&s);
    bench_row row = {
        .part = "scene",
        .precision = s.single ? "float" : "double",
        .count = links,
        .steps = s.steps,
        .goal_ratio = goal_ratio,
        .goal_ns = goal_ns,
        .limits = {beside != NULL ? beside : "streams", beside != NULL ? NULL : "arithmetic"},
        .baseline = looped ? "list" : NULL,
        .goal_speedup = looped && s.order == NATURAL && s.shape == SHEET && s.side >= 35 ? least_speedup : 0,
        .long_only = links > 2000000,
        .time = run,
    };
    if (s.init)
        snprintf(row.kernel, sizeof row.kernel, "init_%s%s", shapes[s.shape], orders[s.order]);
    else
        snprintf(row.kernel, sizeof row.kernel, "%s_%s_%d%s%s", spring_method_name(s.feature.method), shapes[s.shape],
                 (int)s.steps, orders[s.order], name);
    bench_add(&row, &s, sizeof s);
}

static void add_shapes(void)
{
    static const struct {
        scene_shape shape;
        scene_order order;
        uint32_t side;
        double goal_ns;
    } scenes[] = {
        {SHEET, NATURAL, 10, INFINITY},
        {SHEET, NATURAL, 35, 2.0},
        {SHEET, NATURAL, 128, 1.6},
        {SHEET, NATURAL, 400, INFINITY},
        {SHEET, NATURAL, 1000, 2.0},
        {JELLY, NATURAL, 10, 5},
        {JELLY, NATURAL, 20, 5},
        {JELLY, NATURAL, 40, 5},
        {SHEET, LINKS_SHUFFLED, 35, 5},
        {SHEET, LINKS_SHUFFLED, 128, 6.5},
        {SHEET, LINKS_SHUFFLED, 1000, INFINITY},
        {SHEET, SHUFFLED, 10, INFINITY},
        {SHEET, SHUFFLED, 35, 5},
        {SHEET, SHUFFLED, 128, 6.5},
        {SHEET, SHUFFLED, 400, INFINITY},
        {SHEET, SHUFFLED, 1000, INFINITY},
        {WATER, NATURAL, 35, 0.5},
        {WATER, NATURAL, 128, 0.5},
        {WATER, NATURAL, 1000, 0.5},
    };
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        subject s = {scenes[i].shape, scenes[i].side, scenes[i].order, plainly, .steps = 1};
        add("", s, NULL, INFINITY, scenes[i].goal_ns);
        if (s.order != NATURAL && s.side > 128) /* slow, and nothing of it stays in a cache from step to step */
            continue;
        s.steps = 16;
        add("", s, NULL, INFINITY, scenes[i].goal_ns);
    }
    static const uint32_t sides[] = {35, 128, 400, 1000};
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        subject s = {SHEET, sides[i], NATURAL, plainly, .steps = 16, .single = true};
        add("", s, "double", most_float, INFINITY);
        s.steps = 1;
        add("", s, "double", most_float, INFINITY);
    }
}

static const double most_rk4 = 4.3; /* what the library promises, beside leapfrog */

/* The other methods, then one feature after the other, beside the scene without it. */
static void add_features(void)
{
    static const struct {
        const char *name;
        feature feature;
    } features[] = {
        {"_drag", {.method = SPRING_LEAPFROG, .drag = 0.01}},
        {"_damping", {.method = SPRING_LEAPFROG, .damping = 0.05}},
        {"_masses", {.method = SPRING_LEAPFROG, .masses = true}},
        {"_callback", {.method = SPRING_LEAPFROG, .force = blow}},
        {"_callback_still", {.method = SPRING_LEAPFROG, .force = blow, .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY}},
        {"_editable", {.method = SPRING_LEAPFROG, .flags = SPRING_SCENE_EDITABLE}},
        {"_no_undo", {.method = SPRING_LEAPFROG, .flags = SPRING_SCENE_NO_UNDO}},
    };
    for (uint32_t side = 35; side <= 128; side += 93) {
        for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
            const spring_method m = spring_method_at(i);
            if (m != SPRING_LEAPFROG && spring_method_describe(m)->scenes)
                add("", (subject){SHEET, side, NATURAL, {.method = m}, .steps = 16}, "leapfrog",
                    m == SPRING_RK4 ? most_rk4 : INFINITY, INFINITY);
        }
        for (size_t i = 0; i < sizeof features / sizeof features[0]; i++)
            add(features[i].name, (subject){SHEET, side, NATURAL, features[i].feature, .steps = 16}, "leapfrog",
                INFINITY, INFINITY);
    }
}

static void add_init(void)
{
    for (scene_order o = NATURAL; o <= SHUFFLED; o += SHUFFLED)
        for (uint32_t side = 35; side <= 1000; side += side == 35 ? 365 : 600)
            add("", (subject){SHEET, side, o, plainly, .steps = 1, .init = true}, "definition", INFINITY, most_init);
}

void bench_add_scenes(void)
{
    add_shapes();
    add_features();
    add_init();
}
