/* SPDX-License-Identifier: MIT */
/*
 * Queries never change a run: random scenes with random queries, failed calls, empty calls and moves to other memory
 * between their steps are bit-identical to the same scenes without them.
 *
 *     test_scene_queries [VECTORS [SCENES]]    v128, v256, v512 or any; each scene has about six calls of advance()
 */
#include <stdio.h>

#include "test_scene.h"

enum { rounds = 6, most_moves = 4, line = SPRING_SCENE_ALIGN, alignment = 8 };

static const scene_kernels *given; /* NULL: any that this processor has */
static size_t scenes = 2000;

static size_t below(size_t count)
{
    return (size_t)(random_bits() % count);
}

static bool one_in(size_t count)
{
    return below(count) == 0;
}

/* ------------------------------------------------------------------------------------------------ a scene in memory */

typedef struct block {
    char *room;
    size_t bytes;
    spring_scene *s;
} block;

/* Memory at a random multiple of the least alignment, in a line. */
static block any_memory(size_t bytes)
{
    block b = {aligned_alloc(line, bytes + line), bytes, NULL};
    memset(b.room, 0xff, bytes + line);
    b.s = (spring_scene *)(void *)(b.room + alignment * below(line / alignment));
    return b;
}

static block copy_of(const block *b)
{
    const block copy = any_memory(b->bytes);
    memcpy(copy.s, b->s, b->bytes);
    return copy;
}

/* --------------------------------------------------------------------------------------------------- a random scene */

static void lift(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                 scalar *const force[3])
{
    (void)user, (void)v;
    for (size_t i = 0; i < particles; i++)
        force[0][i] += (scalar)(0.3 * sin(t)) - (scalar)0.1 * x[0][i];
}

static void brake(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                  scalar *const force[3])
{
    lift(user, t, particles, x, v, force);
    for (size_t i = 0; i < particles; i++)
        force[0][i] -= (scalar)0.2 * v[0][i];
}

static spring_collider any_collider(uint32_t axes)
{
    spring_collider c = {.shape = (spring_shape)below(4),
                         .radius = random_uniform(0.1, 0.6),
                         .half = {0.3, 0.5, 0.7},
                         .friction = random_uniform(0, 1),
                         .restitution = random_uniform(0, 1)};
    for (uint32_t a = 0; a < 3; a++) {
        c.axis[a][a] = 1;
        c.at[a] = random_uniform(-2, 2);
        c.to[a] = random_uniform(-2, 2);
        c.velocity[a] = c.velocity_to[a] = random_uniform(-1, 1);
        c.spin[a] = a >= axes ? 0 : random_uniform(-1, 1);
    }
    return c;
}

/* Damping of links: light, or so heavy that leapfrog applies it as a series. */
static void damp(model *m)
{
    const double strength = one_in(3) ? random_log(1, 1e4) : random_log(0.01, 1);
    for (size_t i = 0; i < m->def.links; i++)
        m->link[i].damping *= strength;
}

static void build_any(model *m)
{
    static const uint32_t shapes[][3] = {{2, 1, 1}, {3, 2, 1}, {12, 1, 1}, {30, 1, 1}, {5, 5, 1}, {9, 4, 1}, {3, 3, 3}};
    const uint32_t axes = 1 + (uint32_t)below(3);
    build(m, shapes[below(sizeof shapes / sizeof shapes[0])], axes, (unsigned)below(feature_masks));
    damp(m);
    spring_scene_def *def = &m->def;
    if (def->particles <= 12 && one_in(2)) /* small scenes, and scenes without bands */
        def->links = def->links < 12 ? def->links : 12;
    if (one_in(3))
        def->flags |= SPRING_SCENE_NO_UNDO;
    if (one_in(3))
        def->flags |= SPRING_SCENE_FORCES;
    if (one_in(2))
        def->flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    if (one_in(3))
        def->force = (def->flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) != 0 ? lift : brake;
    if (axes > 1 && one_in(3))
        def->flags |= SPRING_SCENE_TENSION_ONLY;
    if (axes > 1 && one_in(3)) {
        def->colliders = 3;
        def->particle_radius = 0.05;
    }
    if (one_in(3))
        def->max_speed = 50;
    use_all_methods(def);
}

/* ---------------------------------------------------------------------------------------- what must not change a run */

static spring_method any_method(const model *m)
{
    const method_list all = methods_of(m->def);
    size_t count = 0;
    while (all.at[count] != no_method)
        count++;
    return (m->def.methods & 1u << SPRING_LEAPFROG) != 0 && one_in(2) ? SPRING_LEAPFROG : all.at[below(count)];
}

static void query(spring_scene *s, const model *m)
{
    static double out[3 * most];
    static float outf[3 * most];
    uint32_t touching[most];
    spring_link link;
    switch (below(10)) {
    case 0:
    case 1:
    case 2:
        spring_scene_at_rest(s, random_log(1e-3, 10), random_log(1e-3, 1e3));
        break;
    case 3:
        spring_scene_stable_step(s, (spring_method)below(SPRING_METHOD_COUNT));
        break;
    case 4:
        spring_scene_energy(s);
        break;
    case 5:
        spring_scene_tension(s, below(m->def.links + 2));
        break;
    case 6:
        spring_scene_get(s, (spring_quantity)below(4), out, 0, 0, m->def.particles);
        break;
    case 7:
        spring_scene_getf(s, (spring_quantity)below(4), outf, 0, 0, m->def.particles);
        break;
    case 8:
        spring_scene_touching(s, touching, 0, m->def.particles);
        break;
    default:
        spring_scene_find_link(s, (uint32_t)below(m->def.particles), (uint32_t)below(m->def.particles));
        spring_scene_get_link(s, below(m->def.links + 1), &link);
    }
}

/* Calls that do nothing: no steps, no time, or gravity as it is. */
static void do_nothing(spring_scene *s, const model *m)
{
    const bool steps = one_in(2);
    const spring_method method = any_method(m);
    CHECK(spring_scene_set_gravity(s, m->def.gravity) == SPRING_OK, "gravity as it is");
    CHECK(spring_scene_advance(s, method, steps ? 0 : 0.01, steps ? 3 : 0) == spring_scene_advance(s, method, 0, 1),
          "a step of 0 and no step are the same");
}

/* Calls that fail. */
static void fail(const block *b, const model *m)
{
    spring_scene *const s = b->s;
    static const double nothing[12] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const spring_collider wrong = {.shape = SPRING_SPHERE, .radius = -1};
    const spring_link link = {0, 0, 1, 1, 1};
    const uint8_t pinned = 1;
    const size_t beyond = m->def.particles + below(3);
    const spring_status status[] = {
        spring_scene_advance(s, any_method(m), NAN, 1),
        spring_scene_advance(s, (spring_method)SPRING_METHOD_COUNT, 0.01, 1),
        spring_scene_advance(s, SPRING_EXACT, 0.01, 1),
        spring_scene_set(s, SPRING_VELOCITY, nothing, 0, 0, 1),
        spring_scene_set(s, SPRING_POSITION, nothing, 0, beyond, 1),
        spring_scene_set_gravity(s, nothing),
        spring_scene_set_colliders(s, &wrong, 1),
        spring_scene_set_link(s, 0, &link),
        spring_scene_set_pinned(s, beyond, 1, &pinned),
        spring_scene_set_mass(s, 0, 1, nothing),
        spring_scene_tear(s, NAN, NULL, NULL, 0, NULL),
        spring_scene_transform(s, nothing),
        spring_scene_drive(s, beyond, nothing, 1),
    };
    for (size_t i = 0; i < sizeof status / sizeof status[0]; i++)
        CHECK(status[i] != SPRING_OK, "the call is invalid");
    if ((m->def.flags & SPRING_SCENE_NO_UNDO) != 0)
        return;
    const double overflows = (double)SCALAR_MAX / 1e3; /* [s] */
    const block kept = copy_of(b);
    if (spring_scene_advance(s, any_method(m), overflows, 1 + below(3)) == SPRING_OK)
        memcpy(s, kept.s, b->bytes); /* a scene that does not move cannot overflow */
    free(kept.room);
}

/* Moves the scene to other memory, and takes steps that are taken back. */
static void move_memory(block *b, const model *m)
{
    const block copy = copy_of(b);
    if (one_in(2)) {
        spring_scene_advance(b->s, any_method(m), random_log(1e-4, 0.1), 1 + below(3));
        memcpy(b->s, copy.s, b->bytes);
        free(copy.room);
        return;
    }
    memset(b->s, 0xff, b->bytes); /* nothing is read from the old memory */
    free(b->room);
    *b = copy;
}

static void disturb(block *b, const model *m)
{
    for (size_t i = below(most_moves); i-- > 0;)
        switch (below(8)) {
        case 0:
            fail(b, m);
            break;
        case 1:
            do_nothing(b->s, m);
            break;
        case 2:
            move_memory(b, m);
            break;
        default:
            query(b->s, m);
        }
}

/* ------------------------------------------------------------------------------------------------------------ a run */

/* A change of both scenes, with the same arguments. */
static void change(spring_scene *const s[2], const model *m)
{
    const size_t i = below(m->def.particles), k = below(m->def.links);
    const double v[3] = {random_uniform(-1, 1), random_uniform(-1, 1), random_uniform(-1, 1)};
    const uint8_t pinned = one_in(2);
    const spring_collider c[2] = {any_collider(m->def.axes), any_collider(m->def.axes)};
    const size_t which = below(8);
    spring_link link = m->link[k];
    link.damping *= pinned;
    link.stiffness *= 0.7;
    for (int j = 0; j < 2; j++)
        switch (which) {
        case 0:
            spring_scene_set(s[j], SPRING_VELOCITY, v, 0, i, 1);
            break;
        case 1:
            spring_scene_set(s[j], SPRING_FORCE, v, 0, i, 1);
            break;
        case 2:
            spring_scene_drive(s[j], i, v, 0.3);
            break;
        case 3:
            spring_scene_set_pinned(s[j], i, 1, &pinned);
            break;
        case 4:
            spring_scene_set_link(s[j], k, &link);
            break;
        case 5:
            spring_scene_set_force(s[j], m->def.force, NULL);
            break;
        default:
            spring_scene_set_colliders(s[j], c, 2);
        }
}

static bool same_scenes(const spring_scene *s, const spring_scene *other, const model *m)
{
    static uint32_t mask[2][most];
    spring_scene_touching(s, mask[0], 0, m->def.particles);
    spring_scene_touching(other, mask[1], 0, m->def.particles);
    return same_bits(s, other, m->def.particles, m->def.axes) &&
           memcmp(mask[0], mask[1], m->def.particles * sizeof mask[0][0]) == 0 &&
           spring_scene_time(s) == spring_scene_time(other);
}

static const scene_kernels *any_kernels(void)
{
    const scene_kernels *kernels = given;
    while (kernels == NULL)
        kernels = kernels_of((int)below(kernel_count));
    return kernels;
}

static bool same_run(const model *m)
{
    size_t bytes = 0;
    bool same = true;
    CHECK(spring_scene_bytes(&m->def, &bytes) == SPRING_OK, "a valid definition");
    block plain = any_memory(bytes), queried = any_memory(bytes);
    spring_scene *result;
    CHECK(spring_scene_init(plain.s, bytes, &m->def, &result) == SPRING_OK && result == plain.s,
          "at any multiple of 8");
    CHECK(spring_scene_init(queried.s, bytes, &m->def, &result) == SPRING_OK && result == queried.s, "likewise");
    const scene_kernels *const kernels = any_kernels();
    spring_method method = any_method(m);
    double dt = random_log(0.003, 0.1);
    for (int round = 0; round < rounds && same; round++) {
        disturb(&queried, m);
        const uint64_t n = 1 + below(4);
        const spring_status status = spring_scene_advance_with(kernels, plain.s, method, dt, n);
        same = spring_scene_advance_with(kernels, queried.s, method, dt, n) == status &&
               same_scenes(plain.s, queried.s, m);
        if (one_in(2))
            change((spring_scene *[]){plain.s, queried.s}, m);
        if (one_in(5))
            method = any_method(m);
        if (one_in(5))
            dt = random_log(0.003, 0.1);
    }
    free(plain.room);
    free(queried.room);
    return same;
}

static void queries_change_nothing(void)
{
    static model m;
    size_t different = 0;
    for (size_t i = 0; i < scenes; i++) {
        build_any(&m);
        different += !same_run(&m);
    }
    printf("# %zu of %zu scenes differ\n", different, scenes);
    CHECK_BELOW((double)different, 0, "queries, failed calls and copies leave no trace");
}

int main(int argc, char **argv)
{
    static const test tests[] = {{"queries change nothing", queries_change_nothing}};
    static const char *const names[] = {"v128", "v256", "v512"};
    for (int i = 0; i < 3 && argc > 1; i++)
        if (strcmp(argv[1], names[i]) == 0 && (given = kernels_of(i)) == NULL) {
            printf("1..0 # SKIP this processor or build has no %s\n", argv[1]);
            return 0;
        }
    if (argc > 2)
        scenes = strtoul(argv[2], NULL, 10);
    return RUN_TESTS("queries of scenes", tests);
}
