/* SPDX-License-Identifier: MIT */
/*
 * Properties of random scenes with random calls. Every property also visits a table of special layouts.
 *
 *     test_scene_random [VECTORS [SCENES [states]]]    v128, v256, v512 or any; each scene has about six calls of
 *                                                      advance(). states: saved states, which take longer
 */
#include <stdio.h>

#include "state_check.h"
#include "test_scene.h"

enum { rounds = 6, most_moves = 4, line = SPRING_SCENE_ALIGN, alignment = 8 };

static const scene_kernels *given; /* NULL: any that this processor has */
static size_t scenes = 2000;

static bool one_in(size_t count)
{
    return below(count) == 0;
}

/* One random number on every processor, so that all see the same scenes. */
static const scene_kernels *any_kernels(void)
{
    size_t i = below(kernel_count);
    while (kernels_of((int)(i % kernel_count)) == NULL)
        i++;
    return given != NULL ? given : kernels_of((int)(i % kernel_count));
}

/* --------------------------------------------------------------------------------------------------------- links */

typedef enum link_layout { GRID, BANDS, PAIRS, LONG_BAND } link_layout;

/* Numbers of particles and links that random scenes rarely have: at the ends of SIMD vectors, tiles and chunks, and at the
   limits of what forms a band. First shapes of grids; then particles and the number of links (pairs) or of bands; then
   particles and the longest offset. */
static const uint32_t special[][3] = {{1, 1, 1},       {2, 1, 1},       {12, 1, 1},      {13, 1, 1},     {17, 1, 1},
                                      {2, 9, 1},       {17, 2, 3},      {13, 12, 8},     {4, 4, 0},      {12, 12, 0},
                                      {12, 13, 0},     {13, 12, 0},     {16, 64, 0},     {40, 39, 0},    {200, 40, 0},
                                      {3000, 6, 0},    {400, 33, 0},    {1023, 1, 0},    {1024, 2, 0},   {1025, 64, 0},
                                      {3001, 1024, 0}, {3072, 1025, 0}, {3003, 2700, 0}, {2100, 2090, 0}};
enum { after_grids = 8, after_pairs = 14, after_bands = 17, special_count = sizeof special / sizeof special[0] };

static void add_link(model *m, uint32_t a, uint32_t b)
{
    m->link[m->def.links++] = (spring_link){a, b, 0.8, 13.7, m->link[0].damping, 0};
}

/* Links of one offset between lower ends that begin and end anywhere, with gaps. */
static void add_band(model *m, uint32_t offset)
{
    const size_t room = m->def.particles - offset;
    const size_t first = below(room), left = room - first, gaps = below(2);
    const size_t end = first + 1 + below(left > 16 && offset > 193 ? 16 : left);
    for (size_t i = first; i < end; i++)
        if (gaps == 0 || i < first + 8 || !one_in(4))
            add_link(m, (uint32_t)i, (uint32_t)i + offset);
}

/* Replaces the links of a row of particles. */
static void link_row(model *m, link_layout layout, uint32_t number)
{
    static const uint32_t offsets[] = {1,  2,  3,  5,  7,  8,   9,   15,  16,  17,  31,  32,
                                       33, 63, 64, 65, 97, 127, 128, 129, 193, 700, 2500};
    const uint32_t particles = (uint32_t)m->def.particles;
    m->def.links = 0;
    for (uint32_t i = 0; i < number && layout == BANDS; i++) {
        const uint32_t offset = number >= most_bands ? i + 1 : offsets[below(sizeof offsets / sizeof offsets[0])];
        if (offset < particles)
            add_band(m, offset);
    }
    for (uint32_t i = 0; i < number && layout == PAIRS && particles > 1; i++) { /* in descending order: no bands */
        const uint32_t lower = (number - 1 - i) * (particles - 1) / number;
        add_link(m, lower, lower + 1 + (uint32_t)below(particles - 1 - lower));
    }
    for (uint32_t offset = 1; layout == LONG_BAND && offset > 0; offset = offset < number ? number : 0)
        for (uint32_t i = 0; i + offset < particles; i++)
            add_link(m, i, i + offset);
}

/* Cut links, springs alone, dampers alone, links without rest length, links that occur twice or in another order. */
static void vary_links(model *m, bool damped)
{
    for (size_t i = 0; i < m->def.links; i++) {
        spring_link *link = &m->link[i];
        link->damping = one_in(4) ? 0 : link->damping;
        if (one_in(8))
            link->rest = one_in(2) ? 0 : -0.0;
        if (damped && one_in(8))
            link->stiffness = 0;
        if (one_in(8))
            link->stiffness = link->damping = 0;
        if (one_in(16)) {
            const size_t j = below(m->def.links);
            const spring_link other = m->link[j];
            m->link[j] = *link;
            *link = one_in(2) ? other : *link;
        }
    }
}

/* Places some particles at the position of others, and two of them very near the origin or very far from it, on either
   side. The links of these two are cut where forces would be infinite. If all_defined, no link is so short or so long
   that its force is undefined. */
static void place_oddly(model *m, bool all_defined)
{
    enum { infinite = 2, defined = 4 };
    static const double in_double[] = {1e-14, 1e9, 1e160, 1.5e308, 1e-168, 1e-160, 1e154};
    static const double in_float[] = {1e-14, 1e9, 1e20, 3e38, 1e-30, 1e-22, 1e19};
    const uint32_t axes = m->def.axes;
    const size_t at = below(m->def.particles - 1),
                 k = below(all_defined ? defined : sizeof in_float / sizeof in_float[0]);
    for (size_t i = 1; i < m->def.particles; i++)
        if (one_in(8))
            memcpy(m->position + i * axes, m->position + (i - 1) * axes, axes * sizeof m->position[0]);
    for (size_t j = 0; j < 2; j++)
        m->position[(at + j) * axes] = (j == 0 ? 1 : -1) * (sizeof(scalar) == 4 ? in_float : in_double)[k];
    for (size_t i = 0; i < m->def.links && k >= infinite && k < defined; i++) {
        spring_link *link = &m->link[i];
        if (link->a == at || link->a == at + 1 || link->b == at || link->b == at + 1)
            link->stiffness = link->damping = 0;
    }
    for (size_t i = 0; i < m->def.weighted_links && k >= infinite; i++) {
        spring_weighted_link *w = &m->weighted[i];
        for (int j = 0; j < 4; j++)
            if (w->weight[j] != 0 && (w->particle[j] == at || w->particle[j] == at + 1))
                w->stiffness = w->damping = 0;
    }
}

/* ------------------------------------------------------------------------------------------------ forces, colliders */

typedef struct push {
    uint32_t axes;
    double strength;
    bool rubs, good; /* uses velocities; all arguments were valid */
    size_t calls;
} push;

/* A force that depends on time, so much that its last bit is seen, on places, and on velocities if it may. */
static void push_all(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                     scalar *const force[3])
{
    push *p = user;
    p->calls++;
    for (uint32_t a = 0; a < 3; a++)
        p->good = p->good && (a < p->axes) == (x[a] != NULL && v[a] != NULL && force[a] != NULL);
    for (uint32_t a = 0; a < p->axes; a++)
        for (size_t i = 0; i < particles; i++) {
            p->good = p->good && isfinite(x[a][i]) && (!p->rubs || isfinite(v[a][i]));
            force[a][i] += (scalar)(p->strength * sin(5000 * t + a)) - (scalar)0.01 * x[a][i];
            force[a][i] -= p->rubs ? (scalar)0.2 * v[a][i] : 0;
        }
}

static void add_nothing(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                        scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v, (void)force;
}

static spring_collider any_collider(uint32_t axes)
{
    spring_collider c = random_collider(axes);
    for (uint32_t a = 0; a < axes; a++)
        c.at[a] += random_uniform(-2, 2);
    return c;
}

/* The same collider, with other numbers where none is read. */
static spring_collider with_unused_numbers(spring_collider c, uint32_t axes)
{
    for (int a = 0; a < 3; a++) {
        c.half[a] = c.shape == SPRING_BOX ? c.half[a] : NAN;
        c.to[a] = c.shape == SPRING_CAPSULE ? c.to[a] : NAN;
    }
    if (axes == 2) {
        c.at[2] = c.to[2] = c.half[2] = c.velocity[2] = c.velocity_to[2] = c.spin[0] = c.spin[1] = NAN;
        for (int a = 0; a < 3; a++)
            c.axis[2][a] = c.axis[a][2] = NAN;
    }
    return c;
}

/* --------------------------------------------------------------------------------------------------- a random scene */

enum { IGNORES = SPRING_SCENE_FORCE_IGNORES_VELOCITY };

static void build_any(model *m, push *p, size_t number, bool all_defined)
{
    static const uint32_t shapes[][3] = {{2, 1, 1}, {3, 2, 1}, {12, 1, 1}, {30, 1, 1}, {5, 5, 1}, {9, 4, 1}, {3, 3, 3}};
    const uint32_t axes = 1 + (uint32_t)below(3);
    const bool is_special = number < 6 * special_count; /* on any axes */
    const size_t k = number % special_count;
    const link_layout layout = !is_special       ? (link_layout)below(LONG_BAND)
                               : k < after_grids ? GRID
                               : k < after_pairs ? PAIRS
                               : k < after_bands ? BANDS
                                                 : LONG_BAND;
    uint32_t shape[3] = {2 + (uint32_t)below(layout == BANDS ? 300 : 40), 1, 1};
    if (is_special)
        memcpy(shape, special[k], layout == GRID ? sizeof shape : sizeof shape[0]);
    else if (layout == GRID)
        memcpy(shape, shapes[below(sizeof shapes / sizeof shapes[0])], sizeof shape);
    const uint32_t links = is_special ? special[k][1] : 1 + (uint32_t)below(40);
    const unsigned features = (unsigned)below(feature_masks);
    build(m, shape, axes, features);
    spring_scene_def *def = &m->def;
    if (layout != GRID)
        link_row(m, layout, links);
    if (layout == GRID && def->particles <= 12 && one_in(2)) /* scenes without bands */
        def->links = def->links < 12 ? def->links : 12;
    if (one_in(2))
        vary_links(m, (features & DAMPED) != 0);
    if (one_in(2))
        add_further_links(m, (features & DAMPED) != 0);
    if (one_in(8)) /* only springs, or one damper */
        for (size_t i = 1; i < def->links; i++)
            m->link[i].damping = 0;
    const double heavy = one_in(3) ? random_log(1, 1e4) : 1; /* so heavy that leapfrog applies it as a series */
    for (size_t i = 0; i < def->links; i++)
        m->link[i].damping *= heavy;
    for (size_t i = 0; i < def->weighted_links; i++)
        m->weighted[i].damping *= heavy;
    if (def->particles > 1 && one_in(3))
        place_oddly(m, all_defined);
    else if (axes > 1 && one_in(3)) {
        def->colliders = 3;
        def->particle_radius = 0.05;
    }
    def->flags |= (one_in(3) ? SPRING_SCENE_NO_UNDO : 0) | (one_in(3) ? SPRING_SCENE_FORCES : 0) |
                  (one_in(2) ? IGNORES : 0) | (axes > 1 && one_in(3) ? SPRING_SCENE_TENSION_ONLY : 0);
    *p = (push){axes, 0.3, (def->flags & IGNORES) == 0 && one_in(2), true, 0};
    if (one_in(3))
        def->force = push_all, def->user = p;
    if (one_in(2))
        def->max_speed = 50;
    if (one_in(8))
        def->velocity = NULL;
    if (one_in(8))
        def->mass_all = 0;
    use_all_methods(def);
}

static spring_method any_method(const spring_scene_def *def)
{
    const method_list all = methods_of(*def);
    size_t count = 0;
    while (all.at[count] != no_method)
        count++;
    const uint32_t leapfrog = 1u << SPRING_LEAPFROG;
    if (def->methods == leapfrog || ((def->methods & leapfrog) != 0 && one_in(2)))
        return SPRING_LEAPFROG;
    spring_method method;
    do
        method = all.at[below(count)];
    while ((def->methods & 1u << method) == 0);
    return method;
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

static block block_of(const spring_scene_def *def)
{
    size_t bytes = 0;
    CHECK(spring_scene_bytes(def, &bytes) == SPRING_OK, "a valid definition");
    const block b = any_memory(bytes);
    spring_scene *result;
    CHECK(spring_scene_init(b.s, bytes, def, &result) == SPRING_OK && result == b.s, "at any multiple of 8");
    return b;
}

/* ---------------------------------------------------------------------------------------------- equal definitions */

/* Adds to a definition what changes nothing: storage, features of zero, pinned particles that nothing is joined to. */
static void add_absent(model *m, bool damped)
{
    static const double zeros[3 * most];
    spring_scene_def *def = &m->def;
    const uint32_t contacts = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4 | 1u << SPRING_SYMPLECTIC_EULER;
    size_t tethers = 0;
    for (size_t i = 0; i < def->links; i++)
        tethers += (m->link[i].flags & SPRING_LINK_TETHER) != 0;
    const bool few = def->particles <= 12 && def->links - tethers <= 12;
    for (size_t i = 0; i < def->particles && def->mass == NULL; i++)
        m->mass[i] = mass_in(def, i);
    for (size_t i = 0; i < def->particles && def->pinned == NULL; i++)
        m->pinned[i] = 0;
    /* In single precision, one mass for all is kept in double for the stable step and the series of heavy damping. */
    const bool in_double = sizeof(scalar) == sizeof(double) || def->mass != NULL || def->pinned != NULL ||
                           (def->flags & SPRING_SCENE_EDITABLE) != 0 || !damped;
    def->flags |= (one_in(3) ? SPRING_SCENE_NO_UNDO : 0) | (one_in(3) ? SPRING_SCENE_FORCES : 0) |
                  (in_double && one_in(3) ? SPRING_SCENE_EDITABLE : 0);
    if (def->force == NULL && (one_in(3) || def->particles > 1000)) /* then no pass is fused */
        def->force = add_nothing, def->flags |= IGNORES;
    if (def->velocity == NULL && one_in(2))
        def->velocity = zeros;
    if (in_double && one_in(3))
        def->mass = m->mass;
    if (in_double && one_in(3))
        def->pinned = m->pinned;
    double far = 0;
    for (size_t i = 0; i < def->particles * def->axes; i++)
        far = fmax(far, fabs(m->position[i]));
    if ((def->methods & ~contacts) == 0 && def->axes > 1 && def->colliders == 0 && far < 100 && def->max_speed > 0)
        def->colliders = 1;
    else if (one_in(2))
        use_all_methods(def);
    for (uint32_t a = def->axes; a < 3; a++)
        def->gravity[a] = NAN;
    if (in_double && !few && def->particles + 60 < most && def->velocity == m->velocity && one_in(3))
        add_strangers(m, 60);
    if (def->axes == 3 && one_in(2))
        def->axes = 0;
}

/* -------------------------------------------------------------------------------------------- calls that change nothing */

static void query(spring_scene *s, const model *m)
{
    static double out[3 * most];
    static float outf[3 * most];
    static uint32_t touching[most];
    spring_link link;
    spring_weighted_link weighted;
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
        spring_scene_find_link(s, below(m->def.particles), below(m->def.particles));
        spring_scene_get_link(s, below(m->def.links + 1), &link);
        spring_scene_get_weighted_link(s, below(m->def.weighted_links + 1), &weighted);
    }
}

/* Calls that do nothing: no steps, no time, or numbers as they are. */
static void do_nothing(spring_scene *s, const model *m)
{
    const bool steps = one_in(2);
    const spring_method method = any_method(&m->def);
    CHECK(spring_scene_set_gravity(s, m->def.gravity) == SPRING_OK, "gravity as it is");
    CHECK(spring_scene_advance(s, method, steps ? 0 : 0.01, steps ? 3 : 0) == spring_scene_advance(s, method, 0, 1),
          "a step of 0 and no step are the same");
    if ((s->layout.flags & SPRING_SCENE_EDITABLE) == 0)
        return;
    const size_t i = below(m->def.particles);
    const uint8_t pinned = inverse_mass_at(s, i) == 0;
    const double mass = mass_in(&m->def, i);
    CHECK(spring_scene_set_pinned(s, i, 1, &pinned) == SPRING_OK &&
              spring_scene_set_mass(s, i, 1, &mass) == SPRING_OK &&
              spring_scene_tear(s, INFINITY, NULL, NULL, 0, NULL) == SPRING_OK,
          "as it is");
}

/* Of both buffers: a later step may read them with longer vectors than those of the step that wrote them. */
static void check_padding(spring_scene *s)
{
    for (uint32_t buffer = 0; buffer < 2 && scene_has(s, positions_in(buffer)); buffer++)
        for (uint32_t a = 0; a < s->layout.axes; a++)
            for (size_t i = s->layout.particles; i < s->layout.stride; i++)
                CHECK(scalar_finite(scene_axis(s, positions_in(buffer), a)[i]) &&
                          scalar_finite(scene_axis(s, velocities_in(buffer), a)[i]),
                      "padding lanes stay finite");
}

/* Calls that fail. */
static void fail(const block *b, const model *m)
{
    spring_scene *const s = b->s;
    static const double nothing[12] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const spring_collider wrong = {.shape = SPRING_SPHERE, .radius = -1};
    const spring_link link = {0, 0, 1, 1, 1, 0};
    spring_weighted_link unbalanced = m->weighted[0];
    unbalanced.weight[0] += 1;
    const uint8_t pinned = 1;
    const size_t beyond = s->layout.particles + below(3);
    const block kept = copy_of(b);
    const spring_status status[] = {
        spring_scene_advance(s, any_method(&m->def), NAN, 1),
        spring_scene_advance(s, (spring_method)SPRING_METHOD_COUNT, 0.01, 1),
        spring_scene_advance(s, SPRING_EXACT, 0.01, 1),
        spring_scene_set(s, SPRING_VELOCITY, nothing, 0, 0, 1),
        spring_scene_set(s, SPRING_POSITION, nothing, 0, beyond, 1),
        spring_scene_set_gravity(s, nothing),
        spring_scene_set_colliders(s, &wrong, 1),
        spring_scene_set_link(s, 0, &link),
        spring_scene_set_weighted_links(s, 0, 1, &unbalanced),
        spring_scene_set_pinned(s, beyond, 1, &pinned),
        spring_scene_set_mass(s, 0, 1, nothing),
        spring_scene_tear(s, NAN, NULL, NULL, 0, NULL),
        spring_scene_transform(s, nothing),
        spring_scene_drive(s, beyond, nothing, 1),
    };
    for (size_t i = 0; i < sizeof status / sizeof status[0]; i++)
        CHECK(status[i] != SPRING_OK, "the call is invalid");
    CHECK(memcmp(kept.s, s, b->bytes) == 0, "an invalid call changes no byte");
    const double overflows = (double)SCALAR_MAX / 1e3; /* [s] */
    if ((s->layout.flags & SPRING_SCENE_NO_UNDO) == 0 &&
        spring_scene_advance(s, any_method(&m->def), one_in(2) ? overflows : -overflows, 1 + below(3)) == SPRING_OK)
        memcpy(s, kept.s, b->bytes); /* a scene that does not move cannot overflow */
    check_padding(s);
    free(kept.room);
}

/* Moves the scene to other memory, and takes steps that are taken back. */
static void move_memory(block *b, const model *m)
{
    const block copy = copy_of(b);
    if (one_in(2)) {
        spring_scene_advance(b->s, any_method(&m->def), random_log(1e-4, 0.1), 1 + below(3));
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

/* -------------------------------------------------------------------------------------------------------- two runs */

static void check_none(size_t number, const char *differs)
{
    if (differs != NULL)
        printf("# scene %zu: %s differs\n", number, differs);
    CHECK(differs == NULL, "the same bits");
}

static void set_colliders(spring_scene *const s[2], const model *m)
{
    spring_collider c[3], with_others[3];
    const uint32_t count = 1 + (uint32_t)below(3);
    for (uint32_t i = 0; i < count; i++) {
        c[i] = any_collider(m->def.axes);
        with_others[i] = with_unused_numbers(c[i], m->def.axes);
    }
    CHECK(spring_scene_set_colliders(s[0], c, count) == SPRING_OK &&
              spring_scene_set_colliders(s[1], with_others, count) == SPRING_OK,
          "valid colliders");
}

/* A change of both scenes, with the same arguments. */
static void change(spring_scene *const s[2], const model *m, push *p)
{
    const size_t i = below(m->def.particles), k = below(m->def.links + 1);
    const double v[3] = {random_uniform(-1, 1), random_uniform(-1, 1), random_uniform(-1, 1)};
    const uint8_t pinned = one_in(2);
    const size_t which = below(8);
    spring_link link = m->link[k];
    link.damping *= pinned;
    link.stiffness *= 0.7;
    const size_t w = below(m->def.weighted_links + 1);
    spring_weighted_link weighted = m->weighted[w]; /* which may leave its band */
    for (int j = 0; j < 4; j++)
        weighted.weight[j] *= v[0];
    weighted.rest = pinned ? 0.3 : 0;
    weighted.damping *= pinned;
    p->strength = random_uniform(0, 1);
    const bool editable = (m->def.flags & SPRING_SCENE_EDITABLE) != 0;
    for (int j = 0; j < 2; j++) {
        if (m->def.force == push_all && (s[j]->layout.flags & IGNORES) != 0)
            spring_scene_set_force(s[j], push_all, p);
        switch (which) {
        case 0:
            spring_scene_set(s[j], SPRING_VELOCITY, v, 0, i, 1);
            break;
        case 1:
            if ((m->def.flags & SPRING_SCENE_FORCES) != 0)
                spring_scene_set(s[j], SPRING_FORCE, v, 0, i, 1);
            break;
        case 2:
            spring_scene_drive(s[j], i, v, 0.3);
            break;
        case 3:
            if (editable)
                spring_scene_set_pinned(s[j], i, 1, &pinned);
            break;
        case 4:
            if (editable)
                spring_scene_set_link(s[j], k, &link), spring_scene_set_weighted_links(s[j], w, 1, &weighted);
            break;
        case 5:
            spring_scene_set_force(s[j], m->def.force, p);
            break;
        default:
            break;
        }
    }
    if (which > 5 && m->def.colliders > 0)
        set_colliders(s, m);
}

/* The stable steps of two scenes, which may store masses in different precisions. */
static const char *step_difference(spring_scene *s, spring_scene *other)
{
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const double step = spring_scene_stable_step(s, (spring_method)i);
        if (fabs(step - spring_scene_stable_step(other, (spring_method)i)) > 4 * EPS * step)
            return "the stable step";
    }
    return NULL;
}

static size_t contacts;

/* What differs between two scenes, or NULL. */
static const char *difference(const spring_scene *s, const spring_scene *other, const model *m)
{
    static uint32_t mask[2][most];
    const size_t n = m->def.particles;
    memset(mask[0], 0, n * sizeof mask[0][0]); /* a scene without colliders touches nothing */
    memset(mask[1], 0, n * sizeof mask[1][0]);
    spring_scene_touching(s, mask[0], 0, n);
    spring_scene_touching(other, mask[1], 0, n);
    for (size_t i = 0; i < n; i++)
        contacts += mask[0][i] != 0;
    const size_t link = below(m->def.links + 1);
    const double tension = spring_scene_tension(s, link), of_other = spring_scene_tension(other, link);
    return !same_bits(s, other, m->def.particles, m->def.axes)    ? "the state"
           : !(tension == of_other || isnan(of_other))            ? "the tension of a link"
           : memcmp(mask[0], mask[1], n * sizeof mask[0][0]) != 0 ? "the colliders that are touched"
           : spring_scene_time(s) != spring_scene_time(other)     ? "the time"
                                                                  : NULL;
}

/* After a call that failed, a scene is as it was. Without rollback it is lost, until all of it is set again. */
static void check_failure(spring_scene *s, const block *before, const model *m, spring_method method,
                          spring_status status)
{
    static state y, now;
    const size_t n = m->def.particles;
    get_state(before->s, n, &y);
    const size_t calls = m->def.force == push_all ? ((push *)m->def.user)->calls : 0;
    if ((m->def.flags & SPRING_SCENE_NO_UNDO) == 0 || (status != SPRING_ENONFINITE && status != SPRING_EUNSTABLE))
        CHECK(difference(s, before->s, m) == NULL, "all or nothing");
    else
        for (spring_quantity q = SPRING_POSITION; q <= SPRING_VELOCITY; q++) {
            get_state(s, n, &now);
            for (size_t i = 0; i < n * m->def.axes; i++)
                CHECK(isnan(now.v[i]) && isnan(now.x[i]) == (q == SPRING_POSITION), "nothing is left");
            CHECK(spring_scene_advance(s, method, 0.01, 1) == SPRING_ENONFINITE &&
                      !spring_scene_at_rest(s, INFINITY, INFINITY),
                  "not all is set again");
            spring_scene_set(s, q, q == SPRING_POSITION ? y.x : y.v, 0, 0, n);
        }
    CHECK(m->def.force != push_all || calls == ((push *)m->def.user)->calls, "nothing is computed from what is lost");
    CHECK(spring_scene_time(s) == spring_scene_time(before->s), "no time has passed");
    set_state(s, n, &y);
}

/* Advances the first scene by n steps in one call, the second in several calls. Returns what differs. */
static const char *advance_both(block *one, block *other, const model *m, spring_method method, double dt, uint64_t n)
{
    static state before, after;
    const block kept = copy_of(one), kept_other = copy_of(other);
    get_state(one->s, m->def.particles, &before);
    const spring_status status = spring_scene_advance_with(any_kernels(), one->s, method, dt, n);
    spring_status of_other = SPRING_OK;
    for (uint64_t done = 0, steps; done < n && of_other == SPRING_OK; done += steps) {
        steps = 1 + below(n - done);
        of_other = spring_scene_advance_with(any_kernels(), other->s, method, dt, steps);
    }
    const char *differs = status != of_other    ? "the status"
                          : status == SPRING_OK ? difference(one->s, other->s, m)
                                                : NULL;
    if (status != SPRING_OK) {
        check_failure(one->s, &kept, m, method, status);
        memcpy(other->s, kept_other.s, other->bytes);
        get_state(one->s, m->def.particles, &before);
        set_state(other->s, m->def.particles, &before);
    }
    get_state(one->s, m->def.particles, &after);
    for (size_t i = 0; i < m->def.particles * m->def.axes && status == SPRING_OK; i++)
        if (inverse_mass_at(one->s, i / m->def.axes) == 0) {
            CHECK_BITS(after.v[i], before.v[i], "no force changes the velocity of a pinned particle");
            const double way = (double)n * dt * before.v[i];
            CHECK_CLOSE(after.x[i], before.x[i] + way, 5 * (double)n * EPS * (fabs(before.x[i]) + fabs(way)),
                        "it moves straight on; each step, at most five roundings");
        }
    free(kept.room);
    free(kept_other.room);
    return differs;
}

static const char *run_both(const model *m, push *p)
{
    static model more;
    more = *m;
    more.def.position = more.position;
    more.def.link = more.link;
    more.def.weighted_link = more.weighted;
    more.def.velocity = m->def.velocity == NULL ? NULL : more.velocity;
    more.def.mass = m->def.mass == NULL ? NULL : more.mass;
    more.def.pinned = m->def.pinned == NULL ? NULL : more.pinned;
    bool damped = false;
    for (size_t i = 0; i < m->def.links; i++)
        damped = damped || m->link[i].damping > 0;
    for (size_t i = 0; i < m->def.weighted_links; i++)
        damped = damped || m->weighted[i].damping > 0;
    add_absent(&more, damped);
    if (m->def.force == push_all && !p->rubs && !damped)
        more.def.flags |= IGNORES; /* then leapfrog keeps forces, which are the same */
    block one = block_of(&m->def), other = block_of(&more.def);
    if (m->def.colliders == 0 && more.def.colliders > 0) {
        const spring_collider far = {.shape = SPRING_PLANE, .at = {0, -1000, 0}, .axis = {{0, 1, 0}}};
        CHECK(spring_scene_set_colliders(other.s, &far, 1) == SPRING_OK, "nothing touches it");
    }
    memset(more.position, 0xff, sizeof more.position); /* nothing is read from there any more */
    memset(more.link, 0xff, sizeof more.link);
    memset(more.weighted, 0xff, sizeof more.weighted);
    if (m->def.colliders > 0)
        set_colliders((spring_scene *[]){one.s, other.s}, m);
    spring_method method = any_method(&m->def);
    double dt = random_log(0.003, 0.1);
    const char *differs = NULL;
    for (int round = 0; round < (m->def.particles > most / 4 ? 2 : rounds) && differs == NULL; round++) {
        disturb(&other, m);
        differs = advance_both(&one, &other, m, method, one_in(8) ? -dt : dt, 1 + below(4));
        if (one_in(2))
            change((spring_scene *[]){one.s, other.s}, m, p);
        if (one_in(5))
            method = any_method(&m->def);
        if (one_in(5))
            dt = random_log(0.003, 0.1);
        if (one_in(25) && !damped && m->def.colliders == more.def.colliders) /* overflows, anywhere in a step */
            dt = random_log(1, sizeof(scalar) == 4 ? 1e37 : 1e305);
    }
    if (differs == NULL)
        differs = step_difference(one.s, other.s);
    free(one.room);
    free(other.room);
    return differs;
}

static void equal_runs(void)
{
    static model m;
    push p;
    for (size_t i = 0; i < scenes; i++) {
        build_any(&m, &p, i, false);
        if (one_in(2))
            m.def.methods = 1u << any_method(&m.def);
        check_none(i, run_both(&m, &p));
        CHECK(p.good, "the callback sees finite numbers, on the axes that there are");
    }
    printf("# %zu contacts\n", contacts);
    CHECK(contacts > scenes / 10, "contacts took place");
}

/* ----------------------------------------------------------------------------------------------------- saved states */

typedef struct saved {
    uint8_t *room, *bytes;
    size_t size;
} saved;

/* What a state may need, besides its header: docs/details.md lists it. */
static double content_of(const spring_scene *s)
{
    const scene_layout *const l = &s->layout;
    const double quantity = (double)(l->axes * l->particles * sizeof(scalar));
    const bool editable = (l->flags & SPRING_SCENE_EDITABLE) != 0, holds = (l->flags & SPRING_SCENE_FORCES) != 0;
    return quantity * (2 + (s->force_cache != NO_FORCE) + holds) + s->colliders * (double)sizeof(spring_collider) +
           editable * ((double)l->particles * (sizeof(scalar) + 1) +
                       (3.0 * (double)l->links + 8.0 * (double)l->weighted) * sizeof(scalar));
}

/* The state at an odd address, in memory that ends behind it. */
static saved save(const spring_scene *s)
{
    saved y = {.size = 0};
    CHECK(spring_scene_save(s, NULL, &y.size) == SPRING_OK, "the size");
    CHECK((double)y.size <= 1.1 * content_of(s) + 256, "a small header and little padding");
    y.room = malloc(y.size + 1);
    y.bytes = y.room + 1;
    memset(y.room, 0x5a, y.size + 1);
    size_t size = below(y.size);
    CHECK(spring_scene_save(s, y.bytes, &size) == SPRING_ENOMEM && size == y.size && y.bytes[below(size)] == 0x5a,
          "too small: nothing is written but the size");
    size = y.size + below(2);
    CHECK(spring_scene_save(s, y.bytes, &size) == SPRING_OK && size == y.size, "as large as announced");
    return y;
}

/* Damaged, truncated and extended states change nothing. */
static void check_damage(const block *b, const saved *y)
{
    const block kept = copy_of(b);
    uint8_t *const longer = calloc(1, y->size + 8), *const bytes = memcpy(longer, y->bytes, y->size);
    for (int i = 0; i < 3; i++) {
        const size_t at = below(y->size);
        const uint8_t bit = (uint8_t)(1 << below(8));
        bytes[at] ^= bit;
        CHECK(spring_scene_load(b->s, bytes, y->size) == SPRING_EINVAL, "a bit is wrong");
        bytes[at] ^= bit;
        CHECK(spring_scene_load(b->s, bytes, below(y->size)) == SPRING_EINVAL, "the end is missing");
    }
    CHECK(spring_scene_load(b->s, longer, y->size + 1 + below(8)) == SPRING_EINVAL, "something follows");
    CHECK(memcmp(kept.s, b->s, b->bytes) == 0, "nothing has changed");
    free(longer);
    free(kept.room);
}

static void load_word(spring_scene *s, const saved *y, size_t i, uint64_t word, spring_status want)
{
    const uint64_t kept = state_word(y->bytes, i);
    set_state_word(y->bytes, i, word);
    sign_state(y->bytes, y->size / 8);
    CHECK(spring_scene_load(s, y->bytes, y->size) == want, "a state with another word");
    set_state_word(y->bytes, i, kept);
    sign_state(y->bytes, y->size / 8);
}

/* States with a valid check value that no scene of this kind saves: of other definitions and versions, with numbers that
   are not finite, negative masses and coefficients, colliders and touching that are not there. */
static void check_other_words(const block *b, const saved *y)
{
    enum {
        magic = 0,
        size = 12,
        first_free,
        kept_force = first_free,
        damped,
        colliders = 15,
        touching,
        t0,
        dt,
        steps,
        base,
        from,
        gravity,
        header = 25
    };
    const block kept = copy_of(b);
    const scene_layout *const l = &b->s->layout;
    const size_t number = sizeof(scalar), quantity = (l->axes * l->particles * number + 7) / 8;
    const uint64_t nothing = UINT64_C(0x7ff8000000000000) | UINT64_C(0x7fc00000); /* NaN, also as two floats */
    for (size_t i = 0; i < first_free; i++)
        load_word(b->s, y, i, state_word(y->bytes, i) + 1, i == magic || i == size ? SPRING_EINVAL : SPRING_EMISMATCH);
    load_word(b->s, y, 2, 12 - number, SPRING_EMISMATCH); /* the other precision */
    load_word(b->s, y, kept_force, PREDICTED_FORCE + 1, SPRING_EINVAL);
    load_word(b->s, y, colliders, l->colliders + 1, SPRING_EINVAL);
    load_word(b->s, y, touching, state_word(y->bytes, touching) + 1, SPRING_EINVAL);
    for (size_t i = t0; i <= gravity; i += i == dt || i == base ? 2 : 1)
        load_word(b->s, y, i, nothing, SPRING_EINVAL);
    load_word(b->s, y, from, state_word(y->bytes, steps) + 1, SPRING_EINVAL);
    load_word(b->s, y, header + below(2 * quantity), nothing, SPRING_EINVAL);
    if ((l->flags & SPRING_SCENE_EDITABLE) != 0) {
        const bool keeps = state_word(y->bytes, kept_force) > 0, holds = (l->flags & SPRING_SCENE_FORCES) != 0;
        const size_t quantities = 2u + keeps + holds;
        const size_t masses = header + quantities * quantity, pins = masses + (l->particles * number + 7) / 8;
        const size_t rests = pins + (l->particles + 63) / 64, each = (l->links * number + 7) / 8;
        const size_t at = below((l->particles * number + 7) / 8);
        const uint64_t negative = UINT64_C(0xbf800000bf800000); /* also as two floats */
        load_word(b->s, y, masses + at, negative, SPRING_EINVAL);
        load_word(b->s, y, pins, UINT64_MAX, SPRING_OK); /* all pinned, or the first 64 */
        memcpy(b->s, kept.s, b->bytes);
        if (each > 0 && l->axes > 1)
            load_word(b->s, y, rests + below(each), negative, SPRING_EINVAL);
        if (each > 0)
            load_word(b->s, y, rests + each + below(each), negative, SPRING_EINVAL);
        if (l->weighted > 0) { /* after four weights */
            const size_t weighted = rests + (state_word(y->bytes, damped) > 0 ? 3 : 2) * each;
            load_word(b->s, y, weighted + number / 2, negative, SPRING_EINVAL); /* rest length */
        }
    }
    CHECK(memcmp(kept.s, b->s, b->bytes) == 0, "nothing has changed");
    free(kept.room);
}

/* A state whose weighted link would be too stiff for its particles, though each of its numbers is valid. */
static void too_stiff_for_masses(void)
{
    const double x[12] = {0};
    const spring_weighted_link weighted = {.particle = {0, 1, 2}, .weight = {1, -2, 1}, .stiffness = 3};
    spring_scene_def def = joined(2, 6, x, NULL, 0, NULL);
    def.flags = SPRING_SCENE_EDITABLE, def.mass_all = 0.5, def.weighted_links = 1, def.weighted_link = &weighted;
    const block b = block_of(&def);
    const saved y = save(b.s);
    const block kept = copy_of(&b);
    /* header, positions, velocities, masses, pins, and in the weighted link four weights and a rest length */
    uint8_t *const stiffness = y.bytes + 25 * 8 + (2 * 12 + 6) * sizeof(scalar) + 8 + 5 * sizeof(scalar);
    const scalar fine = 7, largest = SCALAR_MAX / 4;
    memcpy(stiffness, &largest, sizeof largest);
    sign_state(y.bytes, y.size / 8);
    CHECK(spring_scene_load(b.s, y.bytes, y.size) == SPRING_EINVAL && memcmp(kept.s, b.s, b.bytes) == 0,
          "stiffness weight^2/mass overflows");
    memcpy(stiffness, &fine, sizeof fine);
    sign_state(y.bytes, y.size / 8);
    CHECK(spring_scene_load(b.s, y.bytes, y.size) == SPRING_OK, "another stiffness");
    free(kept.room), free(y.room), free(b.room);
}

/* Replaces a scene by another one of the same definition, with a life of its own, which loads its state. */
static void travel(block *b, const model *m)
{
    const saved y = save(b->s);
    spring_scene_def def = m->def;
    def.flags ^= def.force == NULL && one_in(2) ? IGNORES : 0; /* means nothing without a callback */
    block other = block_of(&def);
    if (m->def.colliders > 0)
        set_colliders((spring_scene *[]){other.s, other.s}, m);
    spring_scene_set_gravity(other.s, (double[]){0.3, 0.2, 0.1});
    spring_scene_set(other.s, SPRING_FORCE, m->velocity, 0, 0, m->def.velocity != NULL ? m->def.particles : 0);
    spring_scene_set_mass(other.s, 0, 1, (double[]){2.2});
    spring_scene_set_pinned(other.s, 0, 1, (uint8_t[]){one_in(2)});
    spring_scene_tear(other.s, 1, NULL, NULL, 0, NULL);
    for (size_t i = 0; i < m->def.links; i++) {
        spring_link link = m->link[i];
        link.damping += 0.01;
        spring_scene_set_link(other.s, i, &link);
    }
    for (size_t i = 0; i < m->def.weighted_links; i++) {
        spring_weighted_link link = m->weighted[i];
        link.stiffness += 0.1;
        spring_scene_set_weighted_links(other.s, i, 1, &link);
    }
    const double dt = one_in(8) ? 1e3 : random_log(0.003, 0.1); /* now and then it is lost */
    spring_scene_advance(other.s, any_method(&m->def), dt, below(4));
    check_damage(&other, &y);
    check_other_words(&other, &y);
    CHECK(spring_scene_load(other.s, y.bytes, y.size) == SPRING_OK, "a state of the same definition");
    const saved again = save(other.s);
    CHECK(again.size == y.size && memcmp(again.bytes, y.bytes, y.size) == 0, "all of it has been loaded");
    CHECK(difference(b->s, other.s, m) == NULL && step_difference(b->s, other.s) == NULL, "the same scene");
    free(y.room);
    free(again.room);
    free(b->room);
    *b = other;
}

static const char *run_and_travel(const model *m, push *p)
{
    block one = block_of(&m->def), other = block_of(&m->def);
    if (m->def.colliders > 0)
        set_colliders((spring_scene *[]){one.s, other.s}, m);
    spring_method method = any_method(&m->def);
    double dt = random_log(0.003, 0.1);
    const char *differs = NULL;
    for (int round = 0; round < rounds && differs == NULL; round++) {
        const double t = random_uniform(-1e3, 1e3);
        const bool last = round == rounds - 1;
        if (one_in(2))
            change((spring_scene *[]){one.s, other.s}, m, p);
        if (one_in(5)) {
            CHECK(spring_scene_set_time(one.s, t) == SPRING_OK && spring_scene_set_time(other.s, t) == SPRING_OK,
                  "any time");
            if (m->def.force != NULL) /* forces are evaluated again anyway */
                spring_scene_set_force(other.s, m->def.force, p);
        }
        if (m->def.colliders > 0 && one_in(8))
            CHECK(spring_scene_set_colliders(one.s, NULL, 0) == SPRING_OK &&
                      spring_scene_set_colliders(other.s, NULL, 0) == SPRING_OK,
                  "none");
        if (one_in(2))
            travel(&other, m);
        differs = advance_both(&one, &other, m, method, one_in(8) ? -dt : dt,
                               last && m->def.particles < 100 ? 200 : 1 + below(4));
        if (one_in(5))
            method = any_method(&m->def);
        if (one_in(5))
            dt = random_log(0.003, 0.1);
    }
    free(one.room);
    free(other.room);
    return differs;
}

static void saved_states(void)
{
    static model m;
    push p;
    contacts = 0;
    saved before = {NULL, NULL, 0};
    for (size_t i = 0; i < scenes; i++) {
        build_any(&m, &p, i, false);
        check_none(i, run_and_travel(&m, &p));
        const block b = block_of(&m.def);
        const saved y = save(b.s);
        const bool same = i > 0 && y.size == before.size && memcmp(y.bytes + 16, before.bytes + 16, 80) == 0;
        CHECK(i == 0 || same || spring_scene_load(b.s, before.bytes, before.size) == SPRING_EMISMATCH,
              "of another scene");
        if (m.def.links > 0)
            m.link[0].flags ^= SPRING_LINK_TENSION_ONLY;
        if (m.def.links > 0 && spring_scene_check(&m.def, NULL, NULL) == SPRING_OK) {
            const block flagged = block_of(&m.def);
            CHECK(spring_scene_load(flagged.s, y.bytes, y.size) == SPRING_EMISMATCH, "other flags of a link");
            free(flagged.room);
        }
        free(before.room);
        free(b.room);
        before = y;
    }
    free(before.room);
    CHECK(contacts > scenes / 10, "contacts took place");
}

/* Two scenes have run differently, and get the same time, state and everything that differs. */
static const char *run_and_meet(model *m, push *p)
{
    static double zeros[3 * most];
    const size_t n = m->def.particles;
    block one = block_of(&m->def), other = block_of(&m->def);
    spring_scene *const both[] = {one.s, other.s};
    for (int j = 0; j < 2; j++)
        for (size_t calls = below(5); calls-- > 0;) {
            if (m->def.colliders > 0)
                set_colliders((spring_scene *[]){both[j], both[j]}, m);
            change((spring_scene *[]){both[j], both[j]}, m, p);
            spring_scene_advance(both[j], any_method(&m->def), one_in(20) ? 1e5 : random_log(0.003, 0.1), below(9));
        }
    const spring_collider c = any_collider(m->def.axes); /* with equal numbers also where none is read */
    const double t = random_uniform(-1e3, 1e3);
    for (size_t i = 0; i < n; i++) {
        m->mass[i] = mass_in(&m->def, i);
        m->pinned[i] = pinned_in(&m->def, i);
        m->mass[i] = m->mass[i] > 0 ? m->mass[i] : 1;
    }
    for (int j = 0; j < 2; j++) {
        spring_scene *const s = both[j];
        CHECK(spring_scene_set_time(s, t) == SPRING_OK, "finite");
        CHECK(m->def.colliders == 0 || spring_scene_set_colliders(s, &c, 1) == SPRING_OK, "a valid collider");
        spring_scene_set_gravity(s, m->def.gravity);
        spring_scene_set_force(s, m->def.force, p);
        spring_scene_set(s, SPRING_FORCE, zeros, 0, 0, n);
        if ((m->def.flags & SPRING_SCENE_EDITABLE) != 0)
            CHECK(spring_scene_set_mass(s, 0, n, m->mass) == SPRING_OK &&
                      spring_scene_set_pinned(s, 0, n, m->pinned) == SPRING_OK &&
                      spring_scene_set_links(s, 0, m->def.links, m->link) == SPRING_OK &&
                      spring_scene_set_weighted_links(s, 0, m->def.weighted_links, m->weighted) == SPRING_OK,
                  "those of the definition");
        CHECK(spring_scene_set(s, SPRING_POSITION, m->position, 0, 0, n) == SPRING_OK &&
                  spring_scene_set(s, SPRING_VELOCITY, m->velocity, 0, 0, n) == SPRING_OK,
              "finite");
    }
    CHECK(spring_scene_time(one.s) == t && spring_scene_set_time(one.s, NAN) == SPRING_EINVAL &&
              spring_scene_set_time(one.s, -INFINITY) == SPRING_EINVAL,
          "finite times only");
    const char *differs = NULL;
    const double dt = random_log(0.003, 0.1);
    for (int round = 0; round < 5 && differs == NULL; round++)
        differs = advance_both(&one, &other, m, any_method(&m->def), dt, n < 100 ? 200 : 20);
    const saved y = save(one.s), z = save(other.s);
    CHECK(differs != NULL || (y.size == z.size && memcmp(y.bytes, z.bytes, y.size) == 0), "equal states");
    free(y.room);
    free(z.room);
    free(one.room);
    free(other.room);
    return differs;
}

static void scenes_that_meet(void)
{
    static model m;
    push p;
    for (size_t i = 0; i < scenes; i++) {
        build_any(&m, &p, i, false);
        check_none(i, run_and_meet(&m, &p));
    }
}

/* ----------------------------------------------------------------------------------------------------------- forces */

static void forces(void)
{
    static model m;
    push p;
    size_t bands = 0, full = 0, unbanded = 0, both = 0, records = 0, three_points = 0, loose = 0, tethers = 0;
    for (size_t i = 0; i < scenes; i++) {
        build_any(&m, &p, i, true);
        spring_scene *s = scene_of(&m.def);
        bands += s->layout.bands > 0 && s->layout.unbanded == 0;
        full += s->layout.bands == most_bands;
        unbanded += s->layout.bands == 0 && s->layout.unbanded > 0;
        both += s->layout.bands > 0 && s->layout.unbanded > 0;
        records += scene_has(s, ARRAY_RECORDS);
        three_points += s->layout.weighted > s->layout.loose;
        loose += s->layout.loose > 0;
        tethers += s->layout.tethers > 0;
        free(s);
        for (int k = 0; k < kernel_count; k++)
            if (kernels_of(k) != NULL)
                check_forces(&m, kernels_of(k));
    }
    printf("# %zu scenes with bands alone, %zu with the most bands, %zu with unbanded links alone, %zu with both, "
           "%zu with records, %zu with bands of weighted links, %zu with other weighted links, %zu with tethers\n",
           bands, full, unbanded, both, records, three_points, loose, tethers);
    CHECK(fmin(fmin((double)bands, (double)full), fmin((double)unbanded, fmin((double)both, (double)records))) > 3 &&
              fmin((double)three_points, fmin((double)loose, (double)tethers)) > (double)scenes / 20,
          "all kinds of layouts");
}

/* ------------------------------------------------------------------------------------------------------------ edits */

static void transform_state(const double matrix[12], const model *m, state *y)
{
    const uint32_t axes = m->def.axes;
    for (size_t i = 0; i < m->def.particles; i++) {
        double x[3] = {0}, v[3] = {0};
        for (uint32_t a = 0; a < axes; a++) {
            for (uint32_t b = 0; b < axes; b++) {
                x[a] += matrix[4 * a + b] * y->x[i * axes + b];
                v[a] += matrix[4 * a + b] * y->v[i * axes + b];
            }
            x[a] += matrix[4 * a + 3];
        }
        memcpy(&y->x[i * axes], x, axes * sizeof x[0]);
        memcpy(&y->v[i * axes], v, axes * sizeof v[0]);
    }
}

static spring_link any_coefficients(const model *m, size_t i)
{
    spring_link link = m->link[i];
    link.rest = one_in(4) ? 0 : random_uniform(0, 1);
    link.stiffness = one_in(3) ? 0 : random_log(3, 60);
    link.damping = one_in(2) ? 0 : random_uniform(0, 0.6);
    if (one_in(3))
        reverse(&link);
    return link;
}

/* Cuts the links that are longer than a limit, and compares them with those of the state y. */
static bool tear(spring_scene *s, model *m, const state *y)
{
    static uint32_t want[most_links], torn[most_links];
    static double limit[most_links], length[most_links];
    double longest = 0; /* in units of the rest length */
    size_t count = 0, found = 0;
    for (size_t i = 0; i < m->def.links; i++) {
        const spring_link *const link = &m->link[i];
        limit[i] = one_in(4) ? INFINITY : random_log(0.8, 3);
        length[i] = evaluate_link(link, m->def.axes, y->x, y->v).length;
        if ((link->stiffness > 0 || link->damping > 0) && link->rest > 0 && (link->flags & SPRING_LINK_TETHER) == 0)
            longest = fmax(longest, length[i] / link->rest);
        else
            length[i] = 0;
    }
    const bool limits = one_in(3);
    const double stretch = longest < 1e30 && !one_in(4) ? 0.99 * longest : random_log(0.5, 4); /* few links, or many */
    for (size_t i = 0; i < m->def.links; i++)
        if (length[i] > (limits ? limit[i] : stretch) * (double)(scalar)m->link[i].rest) {
            m->link[i].stiffness = m->link[i].damping = 0;
            want[count++] = (uint32_t)i;
            for (size_t j = 0; j < m->def.weighted_links; j++) {
                spring_weighted_link *const w = &m->weighted[j];
                int ends = 0;
                for (int k = 0; k < 4; k++)
                    ends += w->weight[k] != 0 && (w->particle[k] == m->link[i].a || w->particle[k] == m->link[i].b);
                if (ends == 2)
                    w->stiffness = w->damping = 0;
            }
        }
    CHECK(spring_scene_tear_with(any_kernels(), s, stretch, limits ? limit : NULL, torn, most_links, &found) ==
                  SPRING_OK &&
              found == count && memcmp(torn, want, count * sizeof *torn) == 0,
          "those that are longer, in their order");
    CHECK(spring_scene_tear(s, stretch, limits ? limit : NULL, NULL, 0, &found) == SPRING_OK && found == 0,
          "and none again");
    return count > 0;
}

/* Changes a scene and its definition alike, its state y too, except for transforms, which round. Returns whether the
   scene then evaluates its forces again. */
static bool edit(spring_scene *s, model *m, state *y)
{
    const uint32_t axes = m->def.axes;
    const size_t i = below(m->def.particles);
    double numbers[12];
    for (int k = 0; k < 12; k++)
        numbers[k] = random_uniform(-1.5, 1.5);
    switch (below(12)) {
    case 10: /* weighted links, which stay in their bands */
        if (m->def.weighted_links > 0) {
            const size_t first = below(m->def.weighted_links), count = 1 + below(m->def.weighted_links - first);
            for (size_t k = first; k < first + count; k++) {
                m->weighted[k].stiffness = one_in(3) ? 0 : random_log(3, 60);
                m->weighted[k].damping = one_in(2) ? 0 : random_uniform(0, 0.6);
            }
            CHECK(spring_scene_set_weighted_links(s, first, count, m->weighted + first) == SPRING_OK, "editable");
        }
        return m->def.weighted_links > 0;
    case 0: /* links */
        if (m->def.links > 0) {
            const size_t first = below(m->def.links), count = 1 + below(m->def.links - first);
            for (size_t k = first; k < first + count; k++)
                m->link[k] = any_coefficients(m, k);
            CHECK(spring_scene_set_links(s, first, count, m->link + first) == SPRING_OK, "editable");
        }
        return m->def.links > 0;
    case 1: { /* a mass */
        const bool free = inverse_mass_at(s, i) > 0;
        m->mass[i] *= 1.3;
        CHECK(spring_scene_set_mass(s, i, 1, &m->mass[i]) == SPRING_OK, "editable");
        return free;
    }
    case 2: /* a pin; it stops */
        m->pinned[i] = !m->pinned[i];
        CHECK(spring_scene_set_pinned(s, i, 1, &m->pinned[i]) == SPRING_OK, "editable");
        for (uint32_t a = 0; a < axes && m->pinned[i]; a++)
            y->v[i * axes + a] = 0;
        return true;
    case 3: /* a driven particle */
        if (spring_scene_drive(s, i, numbers, 0.3) != SPRING_OK)
            return false;
        for (uint32_t a = 0; a < axes; a++)
            y->v[i * axes + a] = (double)(scalar)((numbers[a] - y->x[i * axes + a]) / 0.3);
        return true;
    case 4:
        if (spring_scene_transform(s, numbers) != SPRING_OK)
            return false;
        transform_state(numbers, m, y);
        return true;
    case 5:
    case 6:
    case 7:
        return tear(s, m, y);
    case 8: /* gravity, which is not part of the forces */
        memcpy(m->def.gravity, numbers, sizeof m->def.gravity);
        CHECK(spring_scene_set_gravity(s, numbers) == SPRING_OK, "finite");
        return false;
    case 9:
        m->def.force = m->def.force == NULL ? push_all : NULL;
        CHECK(spring_scene_set_force(s, m->def.force, m->def.user) == SPRING_OK, "a scene");
        return true;
    default:
        CHECK(spring_scene_set(s, SPRING_POSITION, numbers, 0, i, 1) == SPRING_OK, "finite");
        for (uint32_t a = 0; a < axes; a++)
            y->x[i * axes + a] = (double)(scalar)numbers[a];
        return true;
    }
}

/* A scene of this definition, at the time and with the held forces of another scene. */
static spring_scene *scene_like(const spring_scene *s, const spring_scene_def *def)
{
    static double held[3 * most];
    spring_scene *fresh = scene_of(def);
    fresh->t0 = s->t0;
    fresh->dt = s->dt;
    fresh->steps = s->steps;
    if (spring_scene_get(s, SPRING_FORCE, held, 0, 0, def->particles) == SPRING_OK)
        CHECK(spring_scene_set(fresh, SPRING_FORCE, held, 0, 0, def->particles) == SPRING_OK, "held forces");
    return fresh;
}

/* The energies, up to the roundings of a mass and its inverse. */
static void check_energies(const spring_scene *s, const spring_scene *fresh, const model *m, const state *y)
{
    const spring_scene_energies a = spring_scene_energy(s), b = spring_scene_energy(fresh);
    double heights = 0;
    for (size_t i = 0; i < m->def.particles * m->def.axes; i++)
        heights += mass_in(&m->def, i / m->def.axes) * fabs(m->def.gravity[i % m->def.axes] * y->x[i]);
    if (!isfinite(heights))
        return;
    CHECK_CLOSE(a.kinetic, b.kinetic, 8 * EPS * b.kinetic, "a mass, or 1 over it, is rounded");
    CHECK(a.elastic == b.elastic, "masses have no part in it");
    CHECK_CLOSE(a.gravity, b.gravity, 8 * EPS * heights, "a mass, or 1 over it, is rounded");
}

static const char *edit_and_define(model *m, push *p)
{
    static state y, now;
    const size_t size = m->def.particles * m->def.axes;
    m->def.flags |= SPRING_SCENE_EDITABLE;
    m->def.user = p;
    for (size_t i = 0; i < m->def.particles; i++) {
        m->mass[i] = mass_in(&m->def, i);
        m->pinned[i] = pinned_in(&m->def, i);
    }
    spring_scene *s = scene_of(&m->def);
    const spring_method method = any_method(&m->def);
    double dt = random_log(0.003, 0.02), next_dt = dt;
    const scene_bounds *const b = spring_scene_find_bounds(s);
    const bool crosses = method == SPRING_LEAPFROG && b->link_damping > 0 && one_in(3); /* from or to a series */
    if (crosses) {
        const double limit = 2 / (b->damping + hypot(b->damping, sqrt(b->stiffness))); /* of explicit damping */
        dt = one_in(2) ? limit / 2 : limit * 2;
        next_dt = limit * limit / dt;
    }
    spring_scene_advance(s, method, dt, 1 + below(5));
    get_state(s, m->def.particles, &y);
    if (!all_finite(s, m->def.particles, m->def.axes)) {
        free(s);
        return NULL;
    }
    const bool evaluates = crosses || edit(s, m, &y);
    get_state(s, m->def.particles, &now);
    for (size_t i = 0; i < size; i++) {
        CHECK_CLOSE(now.x[i], y.x[i], EPS * fabs(y.x[i]) + 1e-14, "as expected; transforms round");
        CHECK_CLOSE(now.v[i], y.v[i], EPS * fabs(y.v[i]) + 1e-14, "as expected; transforms round");
    }
    if (!evaluates)
        set_state(s, m->def.particles, &now);
    spring_scene_def def = m->def;
    use_all_methods(&def);
    m->def.methods = def.methods &=
        m->def.methods; /* an edit may rule out methods that evaluate forces at positions alone */
    def.position = now.x;
    def.velocity = now.v;
    def.mass = m->mass;
    def.pinned = m->pinned;
    if (one_in(2))
        def.flags &= ~SPRING_SCENE_EDITABLE;
    spring_scene *fresh = scene_like(s, &def);
    if (m->def.colliders > 0) {
        const spring_collider c = any_collider(m->def.axes);
        spring_scene_set_colliders(s, &c, 1);
        spring_scene_set_colliders(fresh, &c, 1);
    }
    const char *differs = difference(s, fresh, m);
    if (differs == NULL)
        differs = step_difference(s, fresh);
    check_energies(s, fresh, m, &now);
    const bool stays = crosses || (one_in(2) && (m->def.methods & 1u << method) != 0);
    const spring_method next = stays ? method : any_method(&m->def);
    for (uint64_t n = 1; n < 3 && differs == NULL; n++) {
        const spring_status status = spring_scene_advance_with(any_kernels(), s, next, next_dt, n);
        differs = spring_scene_advance_with(any_kernels(), fresh, next, next_dt, n) != status ? "the status"
                                                                                              : difference(s, fresh, m);
    }
    free(s);
    free(fresh);
    return differs;
}

static void edits(void)
{
    static model m;
    push p;
    for (size_t i = 0; i < scenes; i++) {
        build_any(&m, &p, i, true);
        check_none(i, edit_and_define(&m, &p));
    }
}

int main(int argc, char **argv)
{
    static const test tests[] = {
        {"equal runs", equal_runs},
        {"forces against a plain loop", forces},
        {"edits", edits},
    };
    static const test of_states[] = {
        {"saved and loaded scenes go on alike", saved_states},
        {"scenes that meet go on alike", scenes_that_meet},
        {"states that are too stiff", too_stiff_for_masses},
    };
    static const char *const names[] = {"v128", "v256", "v512"};
    for (int i = 0; i < 3 && argc > 1; i++)
        if (strcmp(argv[1], names[i]) == 0 && (given = kernels_of(i)) == NULL) {
            printf("1..0 # SKIP this processor or build has no %s\n", argv[1]);
            return 0;
        }
    if (argc > 2)
        scenes = strtoul(argv[2], NULL, 10);
    scenes = random_cases(scenes);
    if (argc > 3 && strcmp(argv[3], "states") == 0)
        return RUN_TESTS("states of random scenes", of_states);
    return RUN_TESTS("random scenes", tests);
}
