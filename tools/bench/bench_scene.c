/* SPDX-License-Identifier: MIT */
/*
 * spring-bench, scenes: ropes, sheets, blocks of jelly and water, in natural and in other orders, the cost of each
 * feature, and the cost of creating a scene. They are compared with a plain loop over the links and with limits from
 * memory bandwidth and arithmetic (bench_limits.h).
 *
 * The work of a scene is proportional to its links, so times are per link.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_limits.h"
#include "common/cli.h"
#include "common/timing.h"
#include "plain_loop.h"
#include "rows.h"

typedef enum scene_shape { ROPE, SHEET, JELLY, WATER } scene_shape;

/* SHUFFLED: links and particles are shuffled. */
typedef enum scene_order { NATURAL, LINKS_SHUFFLED, SHUFFLED } scene_order;

/* The arrays of a definition. */
typedef struct scene_arrays {
    size_t particles, links;
    double *position, *mass; /* different masses, for scenes with this feature */
    uint8_t *pinned;
    spring_link *link;
    size_t tethers, bends; /* after the links; both only for scenes with these features */
    spring_weighted_link *bend;
} scene_arrays;

static const double scene_mass = 0.1, scene_gravity[3] = {0.3, -9.81, -0.5}; /* [kg], [m/s^2] */

/* Features of a scene besides links, gravity and pins, and of its steps. */
typedef struct scene_feature {
    spring_method method;
    uint32_t flags;
    double drag, damping;
    spring_scene_force_fn *force;
    bool masses;
    bool tethers, bend; /* of all particles; rows and columns resist bending */
    uint32_t capsules;  /* number of colliders */
    double far;         /* [m] distance of the capsules from the sheet; 0: they press against it */
    bool floor;         /* a plane that all free particles touch */
    bool copied;        /* the scene is a copy whose arrays are not aligned to a cache line */
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

/* ----------------------------------------------------------------------------------------------------------- grids */

/* Memory aligned for a scene, padded to a whole vector; exits if out of memory. */
static void *scene_allocate(size_t bytes)
{
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, (bytes / SPRING_SCENE_ALIGN + 2) * SPRING_SCENE_ALIGN);
    if (memory == NULL)
        cli_fail(CLI_FAILED, "no memory for %zu bytes of a scene", bytes);
    return memory;
}

static uint32_t scene_axes(scene_shape shape)
{
    return shape == WATER ? 1 : 3;
}

static spring_grid grid_of(scene_shape shape, uint32_t side, double damping)
{
    return (spring_grid){
        .count = {side, shape == ROPE ? 1 : side, shape == JELLY ? side : 1},
        .height = shape == WATER,
        .spacing = 0.1,
        .stretch = 1.05, /* so that sheets do not crumple: compressed springs need shorter steps */
        .families =
            shape == ROPE ? SPRING_GRID_STRUCTURAL : SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
        .stiffness = 20000,
        .damping = damping,
        .pinned = shape == ROPE ? SPRING_GRID_FIRST_X : SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y,
    };
}

static void size_of(const spring_grid *grid, size_t *particles, size_t *links)
{
    if (spring_grid_size(grid, particles, links) != SPRING_OK)
        cli_fail(CLI_FAILED, "no grid of side %u", grid->count[0]);
}

/* The number of links of a scene with `side` particles along an edge. */
static size_t scene_links(scene_shape shape, uint32_t side)
{
    const spring_grid grid = grid_of(shape, side, 0);
    size_t particles, links;
    size_of(&grid, &particles, &links);
    return links;
}

/* A pseudorandom number below n, from the high bits of Knuth's 64-bit generator. */
static size_t below(uint64_t *state, size_t n)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (size_t)((*state >> 32) * n >> 32);
}

static void shuffle_links(scene_arrays *all, uint64_t *state)
{
    for (size_t i = all->links; i > 1; i--) { /* Fisher and Yates */
        const size_t j = below(state, i);
        const spring_link kept = all->link[i - 1];
        all->link[i - 1] = all->link[j];
        all->link[j] = kept;
    }
}

/* Numbers the particles at random. */
static void shuffle_particles(scene_arrays *all, uint64_t *state)
{
    uint32_t *number = scene_allocate(all->particles * sizeof *number);
    double *position = scene_allocate(all->particles * 3 * sizeof *position);
    uint8_t *pinned = scene_allocate(all->particles);
    for (size_t i = 0; i < all->particles; i++) { /* the same, inside-out variant */
        const size_t j = below(state, i + 1);
        number[i] = number[j];
        number[j] = (uint32_t)i;
    }
    for (size_t i = 0; i < all->particles; i++) {
        memcpy(&position[3 * number[i]], &all->position[3 * i], 3 * sizeof *position);
        pinned[number[i]] = all->pinned[i];
    }
    for (size_t i = 0; i < all->links; i++) {
        all->link[i].a = number[all->link[i].a];
        all->link[i].b = number[all->link[i].b];
    }
    free(number);
    free(all->position);
    free(all->pinned);
    all->position = position;
    all->pinned = pinned;
}

/* Fills arrays, reproducibly; damping [N s/m] of every link. */
static void scene_fill(scene_arrays *all, scene_shape shape, uint32_t side, scene_order order, double damping)
{
    const spring_grid grid = grid_of(shape, side, damping);
    free(all->position);
    free(all->mass);
    free(all->pinned);
    free(all->link);
    free(all->bend);
    all->bend = NULL;
    all->tethers = all->bends = 0;
    size_of(&grid, &all->particles, &all->links);
    all->position = scene_allocate(all->particles * 3 * sizeof *all->position);
    all->mass = scene_allocate(all->particles * sizeof *all->mass);
    all->pinned = scene_allocate(all->particles);
    all->link = scene_allocate((all->links + all->particles) * sizeof *all->link);
    spring_grid_fill(&grid, all->position, all->pinned, all->link);
    for (size_t i = 0; i < all->particles; i++)
        all->mass[i] = scene_mass * (1 + 0.1 * (double)(i % 7));
    uint64_t state = 1;
    if (order == SHUFFLED)
        shuffle_particles(all, &state);
    if (order != NATURAL)
        shuffle_links(all, &state);
}

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
        .colliders = f->floor ? 1 : f->capsules,
        .particle_radius = f->capsules > 0 ? 0.01 : 0,
    };
    if (f->tethers)
        def.links += all.tethers;
    if (f->bend)
        def.weighted_links = all.bends, def.weighted_link = all.bend;
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

/* Capsules along the x axis, evenly spaced along y, below the sheet. */
static void set_capsules(built *b, const scene_feature *f, uint32_t side)
{
    const double radius = 0.1, length = 0.1 * side; /* [m] */
    spring_collider c[32] = {{0}};
    for (uint32_t i = 0; i < f->capsules; i++) {
        const double y = (i + 1) * length / (f->capsules + 1), z = -radius - f->far;
        c[i] = (spring_collider){.shape = SPRING_CAPSULE, .radius = radius, .friction = 0.3};
        c[i].at[1] = c[i].to[1] = y, c[i].at[2] = c[i].to[2] = z, c[i].to[0] = length;
    }
    check(spring_scene_set_colliders(b->scene, c, f->capsules));
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
    if (f->capsules > 0)
        set_capsules(b, f, (uint32_t)sqrt((double)all.particles));
    if (f->floor)
        check(spring_scene_set_colliders(
            b->scene, &(spring_collider){.shape = SPRING_PLANE, .axis = {{0, 0, 1}}, .friction = 0.3}, 1));
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

static void add_extras(const scene_subject *s)
{
    const spring_grid grid = grid_of(s->shape, s->side, 0);
    if (s->feature.tethers) {
        uint32_t *work = scene_allocate(2 * all.particles * sizeof *work);
        double *distance = scene_allocate(2 * all.particles * sizeof *distance);
        const spring_scene_def def = definition(&(scene_feature){.method = SPRING_LEAPFROG}, s->shape);
        all.tethers = all.particles;
        check(spring_links_tethers(&def, 0.05, 0, all.link + all.links, &all.tethers, work, distance));
        free(work);
        free(distance);
    }
    if (s->feature.bend) {
        all.bends = 2 * all.particles;
        all.bend = scene_allocate(all.bends * sizeof *all.bend);
        check(spring_bend_grid(&grid, all.pinned, SPRING_BEND_ROWS, 1e-3, 0, all.bend, &all.bends));
    }
}

static void prepare(const bench_row *row)
{
    static const scene_subject *filled;
    const scene_subject *s = row->subject;
    if (s == filled)
        return;
    filled = s;
    scene_fill(&all, s->shape, s->side, s->order, s->feature.damping);
    add_extras(s);
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

static double time(const bench_row *row, int which, uint64_t calls)
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
           s->feature.force == NULL && s->feature.flags == 0 && s->feature.capsules == 0 && !s->feature.tethers &&
           !s->feature.bend;
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
        .long_only = links > (s->shape == SHEET && s->order == NATURAL ? 2000000 : 500000),
        .time = time,
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
        {"_tethers", {.method = SPRING_LEAPFROG, .tethers = true}},
        {"_bending", {.method = SPRING_LEAPFROG, .bend = true}},
        {"_5_colliders_near", {.method = SPRING_LEAPFROG, .capsules = 5}},
        {"_5_colliders_far", {.method = SPRING_LEAPFROG, .capsules = 5, .far = 100}},
        {"_32_colliders_far", {.method = SPRING_LEAPFROG, .capsules = 32, .far = 100}},
        {"_on_a_plane", {.method = SPRING_LEAPFROG, .floor = true}},
    };
    scene_subject s = {.shape = SHEET, .side = side, .steps = 16, .against = LEAPFROG};
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        s.feature = (scene_feature){.method = spring_method_at(i)};
        if (s.feature.method != SPRING_LEAPFROG && spring_method_describe(s.feature.method)->scenes && side <= 128)
            add("", &s);
    }
    for (size_t i = 0; i < sizeof features / sizeof features[0]; i++) {
        s.feature = features[i].feature;
        const bool small_only = s.feature.tethers || s.feature.bend || s.feature.capsules > 0 || s.feature.floor;
        if (side <= (small_only ? 35 : 128) ||
            s.feature.damping > 0) /* the feature with a second pass over the links */
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
