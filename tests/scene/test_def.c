/* SPDX-License-Identifier: MIT */
/* From definitions to scenes: invalid fields are rejected and named; size of the memory; ropes, sheets and blocks. */
#include <stdint.h>

#include "test_scene.h"

static const uint32_t sheet[] = {6, 5, 1};

/* ---------------------------------------------------------------------------------------------- invalid definitions */

static model good;

static void check_refused(spring_status status, const char *field, size_t index)
{
    const char *got_field = "";
    size_t got_index = 12345, bytes = 54321;
    static char room[1 << 16] __attribute__((aligned(SPRING_SCENE_ALIGN))), before[sizeof room];
    memset(room, 0x5a, sizeof room);
    memcpy(before, room, sizeof room);
    spring_scene *s = (spring_scene *)(void *)room;
    CHECK(spring_scene_check(&good.def, &got_field, &got_index) == status, field);
    CHECK(got_field != NULL && strcmp(got_field, field) == 0, field);
    CHECK(got_index == index, field);
    CHECK(spring_scene_check(&good.def, NULL, NULL) == status, "the outputs are optional");
    CHECK(spring_scene_bytes(&good.def, &bytes) == status && bytes == 54321, field);
    CHECK(spring_scene_init(room, sizeof room, &good.def, &s) == status && s == NULL, field);
    CHECK(memcmp(room, before, sizeof room) == 0, "nothing half-initialised");
}

/* Refused with a field changed, and then set back. */
#define REFUSED(lvalue, wrong, status, field, index)               \
    do {                                                           \
        __typeof__(lvalue) *const place = &(lvalue), was = *place; \
        *place = (wrong);                                          \
        check_refused((status), (field), (index));                 \
        *place = was;                                              \
    } while (0)

static void refused(void)
{
    build(&good, sheet, 2, OWN | DAMPED | MASSES | PINNED | DRAG | GRAVITY);
    spring_scene_def *d = &good.def;
    const char *field = "";
    size_t index = 7;
    CHECK(spring_scene_check(d, &field, &index) == SPRING_OK && field == NULL && index == 0, "nothing to name");
    index = 7;
    CHECK(spring_scene_check(NULL, &field, &index) == SPRING_EINVAL && strcmp(field, "def") == 0 && index == 0,
          "no definition");
    memset(good.pinned, 0, sizeof good.pinned);
    const double too_large = sizeof(scalar) == 4 ? 1e39 : INFINITY;

    REFUSED(d->axes, 4, SPRING_EINVAL, "axes", 0);
    const double no_radius[] = {-1, NAN, too_large};
    for (int i = 0; i < 3; i++) {
        REFUSED(d->particle_radius, no_radius[i], SPRING_EINVAL, "particle_radius", 0);
        REFUSED(d->max_speed, no_radius[i], SPRING_EINVAL, "max_speed", 0);
    }
    REFUSED(d->colliders, 33, SPRING_ERANGE, "colliders", 0);
    REFUSED(d->flags, 32, SPRING_EINVAL, "flags", 0);
    REFUSED(d->methods, 1u << SPRING_EXACT | 1, SPRING_EUNSUPPORTED, "methods", 0);
    REFUSED(d->methods, 1u << SPRING_METHOD_COUNT, SPRING_EINVAL, "methods", 0);
    REFUSED(d->particles, 0, SPRING_EINVAL, "particles", 0);
    REFUSED(d->particles, UINT32_MAX, SPRING_ERANGE, "particles", 0);
    REFUSED(d->particles, SIZE_MAX, SPRING_ERANGE, "particles", 0);
    REFUSED(d->particles, SIZE_MAX / 16 + 1, SPRING_ERANGE, "particles", 0); /* 16 bytes each overflow to 16 */
    REFUSED(d->links, SIZE_MAX, SPRING_ERANGE, "links", 0);
    REFUSED(d->links, SIZE_MAX / sizeof(spring_link) + 1, SPRING_ERANGE, "links", 0);
    REFUSED(d->links, UINT32_MAX, SPRING_ERANGE, "links", 0);
    REFUSED(d->weighted_links, UINT32_MAX, SPRING_ERANGE, "weighted_links", 0);
    double radius[most] = {0};
    d->colliders = 1;
    d->radius = radius;
    REFUSED(radius[4], -1, SPRING_EINVAL, "radius", 4);
    d->radius = NULL;
    d->colliders = 0;
    REFUSED(d->position, NULL, SPRING_EINVAL, "position", 0);
    REFUSED(d->link, NULL, SPRING_EINVAL, "link", 0);
    REFUSED(d->gravity[1], NAN, SPRING_EINVAL, "gravity", 1);
    REFUSED(d->gravity[0], -too_large, SPRING_EINVAL, "gravity", 0);
    REFUSED(d->drag, -0.1, SPRING_EINVAL, "drag", 0);
    REFUSED(d->drag, NAN, SPRING_EINVAL, "drag", 0);
    REFUSED(d->drag, too_large, SPRING_EINVAL, "drag", 0);

    REFUSED(good.position[2 * 11 + 1], NAN, SPRING_EINVAL, "position", 11);
    REFUSED(good.position[2 * 29], too_large, SPRING_EINVAL, "position", 29);
    REFUSED(good.velocity[2 * 7 + 1], -too_large, SPRING_EINVAL, "velocity", 7);
    REFUSED(good.velocity[2 * 8], NAN, SPRING_EINVAL, "velocity", 8);
    const double masses[] = {0, -1, NAN, INFINITY, 1e-310, sizeof(scalar) == 4 ? 1e-42 : -0.0};
    for (size_t i = 0; i < sizeof masses / sizeof masses[0]; i++)
        REFUSED(good.mass[13], masses[i], SPRING_EINVAL, "mass", 13);

    REFUSED(good.link[17].a, 30, SPRING_ERANGE, "link.a", 17);
    REFUSED(good.link[18].b, UINT32_MAX, SPRING_ERANGE, "link.b", 18);
    REFUSED(good.link[18].b, 30, SPRING_ERANGE, "link.b", 18);
    REFUSED(good.link[19].b, good.link[19].a, SPRING_EINVAL, "link.b", 19);
    const double negative[] = {-1e-300, NAN, too_large, -INFINITY};
    for (size_t i = sizeof(scalar) == 4 ? 1 : 0; i < sizeof negative / sizeof negative[0]; i++) {
        REFUSED(good.link[20].rest, negative[i], SPRING_EINVAL, "link.rest", 20);
        REFUSED(good.link[0].stiffness, negative[i], SPRING_EINVAL, "link.stiffness", 0);
        REFUSED(good.link[d->links - 1].damping, negative[i], SPRING_EINVAL, "link.damping", d->links - 1);
    }
    const double huge = sizeof(scalar) == 4 ? 3e38 : 1.7e308; /* finite, but not over these masses */
    good.mass[good.link[5].b] = 0.01;
    REFUSED(good.link[5].stiffness, huge, SPRING_EINVAL, "link.stiffness", 5);
    REFUSED(good.link[5].damping, huge, SPRING_EINVAL, "link.damping", 5);
    size_t lightest = 0; /* the first that is too light for this drag */
    while (!(good.mass[lightest] < 1))
        lightest++;
    REFUSED(d->drag, huge, SPRING_EINVAL, "drag", lightest);

    d->mass = NULL;
    for (size_t i = 0; i < sizeof masses / sizeof masses[0]; i++)
        if (masses[i] != 0)
            REFUSED(d->mass_all, masses[i], SPRING_EINVAL, "mass_all", 0);
}

static void do_nothing(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                       scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v, (void)force;
}

/* Tension-only links, colliders and methods for smooth forces: valid in some scenes. Links that just fit, or just do not. */
static void combinations(void)
{
    const double x[] = {0, 1, 2, 3, 4, 5}, largest = (double)SCALAR_MAX, mass[] = {1.5, 2, 3};
    spring_link link = {0, 1, 0.7, 0, 0, 0};
    good.def = (spring_scene_def){.axes = 1, .flags = SPRING_SCENE_TENSION_ONLY, .particles = 2, .position = x};
    spring_scene_def *d = &good.def;
    check_refused(SPRING_EUNSUPPORTED, "flags", 0);
    d->flags = 0, d->colliders = 32;
    check_refused(SPRING_EUNSUPPORTED, "colliders", 0);
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        d->methods = 1u << spring_method_at(i);
        for (int kind = 0; kind < 5; kind++) {
            const spring_link damped = {0, 1, 0.7, 2, 0.1, 0};
            *d = (spring_scene_def){.axes = 2, .methods = d->methods, .particles = 2, .position = x, .link = &damped};
            d->colliders = kind == 0 ? 32 : 0; /* a bit for each */
            d->flags = kind == 1 ? SPRING_SCENE_TENSION_ONLY : kind == 4 ? SPRING_SCENE_FORCE_IGNORES_VELOCITY : 0;
            d->links = kind == 2;
            d->force = kind > 2 ? do_nothing : NULL;
            if (kind < 4 && spring_method_describe(spring_method_at(i))->positions_only)
                check_refused(SPRING_EUNSUPPORTED, "methods", 0);
            else
                CHECK((spring_scene_check(d, NULL, NULL) == SPRING_OK) ==
                          spring_method_describe(spring_method_at(i))->scenes,
                      "forces need not be smooth, or they are");
        }
    }
    for (int damping = 0; damping < 2; damping++) {
        *d = (spring_scene_def){.particles = 2, .links = 1, .position = x, .mass = mass, .link = &link};
        (damping ? &link.damping : &link.stiffness)[0] = largest / 2.5 * 1.5;
        CHECK(spring_scene_check(d, NULL, NULL) == SPRING_OK, "2/mass of it is finite");
        (damping ? &link.damping : &link.stiffness)[0] = largest / 1.9 * 1.5;
        check_refused(SPRING_EINVAL, damping ? "link.damping" : "link.stiffness", 0);
        link.stiffness = link.damping = 0;
    }
    *d = (spring_scene_def){.particles = 2, .links = 1, .position = x, .mass_all = 1.4 / largest, .link = &link};
    CHECK(spring_scene_check(d, NULL, NULL) == SPRING_OK, "twice the inverse mass overflows; the link does not pull");
    for (uint32_t axes = 1; axes < 3; axes++) {
        *d = (spring_scene_def){
            .axes = axes,
            .particles = 1,
            .position = x,
        };
        d->gravity[axes - 1] = NAN;
        check_refused(SPRING_EINVAL, "gravity", axes - 1);
        *d = (spring_scene_def){.axes = axes, .particles = 1, .position = x};
        d->gravity[axes] = NAN;
        CHECK(spring_scene_check(d, NULL, NULL) == SPRING_OK, "elements beyond the axes are ignored");
    }
}

/* What looks wrong, but is not looked at or means something. */
static void accepted(void)
{
    build(&good, sheet, 2, MASSES | PINNED);
    memset(good.pinned, 0, sizeof good.pinned);
    good.pinned[4] = 2;
    good.mass[4] = NAN; /* nothing moves it */
    good.link[3].rest = 0;
    good.link[3].stiffness = 0;
    CHECK(spring_scene_check(&good.def, NULL, NULL) == SPRING_OK, "a pinned particle needs no mass");
    good.def.velocity = NULL;
    good.def.links = 0;
    good.def.link = NULL;
    CHECK(spring_scene_check(&good.def, NULL, NULL) == SPRING_OK, "no links, at rest");
    const double x[] = {1, 2, 3};
    const spring_scene_def least = {.particles = 1, .position = x};
    spring_scene *s = scene_of(&least);
    double y[3], g[3] = {0, 4, 0};
    spring_scene_set_gravity(s, g);
    CHECK(spring_scene_advance(s, SPRING_EULER, 0.5, 2) == SPRING_OK &&
              spring_scene_advance(s, SPRING_LEAPFROG, 0.5, 1) == SPRING_OK,
          "Euler and leapfrog are there when no method is named");
    CHECK(spring_scene_advance(s, SPRING_RK4, 0.5, 1) == SPRING_EDISABLED, "RK4 only for who asks for it");
    spring_scene_get(s, SPRING_POSITION, y, 0, 0, 1);
    CHECK(y[0] == 1 && y[1] == 2 + 1 + 2.5 && y[2] == 3,
          "three axes; Euler to 3 m and 4 m/s, half a kick, a drift: exact");
    free(s);
}

static void bad_memory(void)
{
    build(&good, sheet, 3, OWN | DAMPED);
    size_t bytes = 0;
    spring_scene *s = NULL;
    CHECK(spring_scene_bytes(&good.def, &bytes) == SPRING_OK && bytes % SPRING_SCENE_ALIGN == 0, "a multiple");
    char *room = aligned_alloc(SPRING_SCENE_ALIGN, bytes + SPRING_SCENE_ALIGN);
    memset(room, 0x5a, bytes + SPRING_SCENE_ALIGN);
    CHECK(spring_scene_init(room, bytes - 1, &good.def, &s) == SPRING_ENOMEM && s == NULL, "a byte too small");
    CHECK(spring_scene_init(room, 0, &good.def, &s) == SPRING_ENOMEM && s == NULL, "nothing");
    for (size_t beyond = 1; beyond < 8; beyond++)
        CHECK(spring_scene_init(room + beyond, bytes, &good.def, &s) == SPRING_EALIGN && s == NULL, "misaligned");
    CHECK(spring_scene_init(NULL, bytes, &good.def, &s) == SPRING_EINVAL && s == NULL, "no memory");
    CHECK(spring_scene_init(room, bytes, NULL, &s) == SPRING_EINVAL && s == NULL, "no definition");
    CHECK(spring_scene_init(room, bytes, &good.def, NULL) == SPRING_EINVAL, "nowhere to say");
    CHECK(spring_scene_bytes(&good.def, NULL) == SPRING_EINVAL && spring_scene_bytes(NULL, &bytes) == SPRING_EINVAL,
          "NULL");
    size_t touched = 0;
    for (size_t i = 0; i < bytes + SPRING_SCENE_ALIGN; i++)
        touched += room[i] != 0x5a;
    CHECK(touched == 0, "nothing half-initialised");
    for (size_t beyond = 0; beyond < SPRING_SCENE_ALIGN; beyond += 8) {
        memset(room, 0x5a, bytes + SPRING_SCENE_ALIGN);
        CHECK(spring_scene_init(room + beyond, bytes, &good.def, &s) == SPRING_OK, "just enough");
        for (int a = 0; a < ARRAY_COUNT; a++)
            CHECK(!scene_has(s, (scene_array)a) || (uintptr_t)scene_read(s, (scene_array)a) % SPRING_SCENE_ALIGN == 0,
                  "each array is aligned");
        spring_scene_advance(s, SPRING_RK4, 0.01, 3);
        spring_scene_advance(s, SPRING_LEAPFROG, 0.01, 3);
        for (size_t i = 0; i < SPRING_SCENE_ALIGN; i++)
            CHECK(room[i < beyond ? i : bytes + i] == 0x5a, "nothing outside of the block");
    }
    free(room);
}

/* ---------------------------------------------------------------------------------------------------- bytes */

static size_t bytes_of(const spring_scene_def *def)
{
    size_t bytes = 0;
    CHECK(spring_scene_bytes(def, &bytes) == SPRING_OK, "a valid definition");
    return bytes;
}

/* The bytes of each particle more, or of each link, from two scenes that differ in size. */
typedef struct cost {
    const char *what;
    double numbers, bytes; /* a particle or link: floating-point numbers, and bytes besides */
} cost;

enum { few = 4096, many = 12288 };

static double particle_cost(spring_scene_def def)
{
    static double zeros[3 * many], masses[many];
    for (size_t i = 0; i < many; i++)
        masses[i] = 1.5;
    def.position = zeros;
    def.mass = def.mass_all == 2 ? masses : NULL;
    def.particles = few;
    const size_t small = bytes_of(&def);
    def.particles = many;
    return (double)(bytes_of(&def) - small) / (many - few);
}

/* A particle has `axes` numbers for each of these, and one number for the stable step. */
static const cost particle_costs[] = {
    {"x and v twice, force, predicted v", 6, 0},
    {"without rollback: once", 4, 0},
    {"no callback with velocities, no damped links: no predicted v", 5, 0},
    {"RK4 too: one more buffer and two sums", 10, 0},
    {"Euler alone: no predicted v", 5, 0},
    {"RK4 alone, without rollback", 7, 0},
    {"held forces: once", 7, 0},
};

static void bytes_of_a_particle(void)
{
    const uint32_t leapfrog = 1u << SPRING_LEAPFROG, euler = 1u << SPRING_EULER, rk4 = 1u << SPRING_RK4;
    const spring_scene_def defs[] = {
        {.methods = leapfrog},
        {.methods = leapfrog, .flags = SPRING_SCENE_NO_UNDO},
        {.methods = leapfrog, .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY},
        {.methods = leapfrog | rk4},
        {.methods = euler},
        {.methods = rk4, .flags = SPRING_SCENE_NO_UNDO},
        {.methods = leapfrog, .flags = SPRING_SCENE_FORCES},
    };
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t i = 0; i < sizeof defs / sizeof defs[0]; i++) {
            spring_scene_def def = defs[i];
            def.axes = axes;
            CHECK_CLOSE(particle_cost(def), (particle_costs[i].numbers * axes + 1) * sizeof(scalar), 0,
                        particle_costs[i].what);
            def.mass_all = 2; /* an array of masses */
            CHECK_CLOSE(particle_cost(def), (particle_costs[i].numbers * axes + 2) * sizeof(scalar), 0,
                        "and one for its inverse mass");
        }
}

/* What a method stores in a scene without damping whose forces do not depend on velocities, numbers for each axis of a
   particle: nothing if it moves the state itself; of a stage at least x and v. Methods share what both
   have. */
static void methods_store_what_they_use(void)
{
    const spring_scene_def still = {.axes = 2, .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY};
    spring_scene_def def = still, one = {.particles = 1, .position = (double[3]){0}};
    const double axis = 2 * sizeof(scalar), sum = sizeof(scalar);
    const method_list all = methods_of(one);
    for (const spring_method *m = all.at; *m != no_method; m++) {
        def.methods = 1u << *m;
        const double alone = (particle_cost(def) - sum) / axis;
        CHECK(spring_method_describe(*m)->forces_per_step == 1 || spring_method_describe(*m)->symplectic ? alone == 5
                                                                                                         : alone >= 7,
              "x and v twice, the force; and x and v of a stage");
        for (const spring_method *other = all.at; *other != no_method; other++) {
            def.methods = 1u << *other;
            const double of_other = (particle_cost(def) - sum) / axis;
            def.methods |= 1u << *m;
            const double both = (particle_cost(def) - sum) / axis;
            CHECK(both >= fmax(alone, of_other) && both <= alone + of_other - 5, "what both need is stored once");
        }
    }
}

/* Bytes for each link of a long rope more, its particles left out. */
static double link_cost(unsigned kind, double damping, uint32_t flags)
{
    static double zeros[3 * (many + 1)];
    static spring_link link[many];
    for (uint32_t i = 0; i < many; i++)
        link[i] = (spring_link){i, i + 1, 0.4, kind == 0 ? 12.5 : 12.5 + i, damping, 0};
    if (kind == 2)
        for (uint32_t i = 0; i < many; i++) /* descending: no band */
            link[i] = (spring_link){many - 1 - i, many - i, 0.4, 12.5, damping, 0};
    const spring_scene_def def = {
        .flags = flags, .particles = many + 1, .position = zeros, .link = link, .links = many};
    spring_scene_def less = def;
    less.links = few;
    return (double)(bytes_of(&def) - bytes_of(&less)) / (many - few);
}

static void bytes_of_a_link(void)
{
    const struct {
        unsigned kind; /* equal, own numbers, edge list */
        double damping;
        uint32_t flags;
        cost cost;
    } cases[] = {
        {0, 0, 0, {"where it lies, and that it is there", 0, 4 + 1}},
        {0, 0.7, 0, {"damping is shared, too; its root, and two numbers of a kick", 3, 4 + 1}},
        {1, 0, 0, {"its own stiffness and rest length", 2, 4 + 1}},
        {1, 0.7, 0, {"and damping, its root, and two numbers of a kick", 3 + 3, 4 + 1}},
        {0,
         0,
         SPRING_SCENE_EDITABLE,
         {"editable: its own stiffness, rest length and damping, and the same", 3 + 3, 4 + 1}},
        {2, 0, 0, {"its ends, stiffness and rest length; where it lies is plain", 2, 8}},
        {2, 0.7, 0, {"and damping, and the same", 3 + 3, 8}},
        {2, 0, SPRING_SCENE_EDITABLE, {"the same when editable", 3 + 3, 8}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double want = cases[i].cost.numbers * sizeof(scalar) + cases[i].cost.bytes;
        const double got = link_cost(cases[i].kind, cases[i].damping, cases[i].flags);
        CHECK_CLOSE(got, want, 0, cases[i].cost.what);
    }
}

static void bytes_of_a_scene(void)
{
    const double x[] = {0};
    const spring_scene_def def = {.axes = 1, .methods = 1u << SPRING_EULER, .particles = 1, .position = x};
    CHECK(bytes_of(&def) <= 8192, "a scene of one particle: the plan and 16 numbers before and after each array");
    const spring_scene_def usual = {.particles = 1, .position = (double[3]){0}, .pinned = (uint8_t[1]){0}};
    CHECK(bytes_of(&usual) <= (sizeof(scalar) == 4 ? 5000 : 8000), "README.md: about so many");
}

/* As many particles and links as may be asked for, and one more; the lightest and the heaviest mass. */
static void definitions_at_the_limits(void)
{
    build(&good, sheet, 2, MASSES);
    spring_scene_def *d = &good.def;
    if (sizeof(size_t) > sizeof(uint32_t)) { /* what is missing then is found first */
        d->position = NULL;
        d->particles = UINT32_MAX - padding;
        check_refused(SPRING_EINVAL, "position", 0);
        d->particles++;
        check_refused(SPRING_ERANGE, "particles", 0);
        build(&good, sheet, 2, MASSES);
        d->link = NULL;
        d->links = UINT32_MAX / 8;
        check_refused(SPRING_EINVAL, "link", 0);
        d->links++;
        check_refused(SPRING_ERANGE, "links", 0);
    }
    build(&good, sheet, 2, MASSES);
    d->link = NULL;
    d->links = 1;
    check_refused(SPRING_EINVAL, "link", 0);
    d->links = 0;
    const double largest = sizeof(scalar) == 4 ? (double)FLT_MAX : DBL_MAX;
    const double extreme[] = {1.5 / largest, largest};
    for (int i = 0; i < 2; i++) {
        good.mass[7] = extreme[i];
        CHECK(spring_scene_check(d, NULL, NULL) == SPRING_OK, "it and its inverse are finite, and not 0");
    }
}

/* ------------------------------------------------------------------------------------------- ropes, sheets, blocks */

static const spring_grid grids[] = {
    {.count = {1}, .spacing = 0.3, .stiffness = 2},
    {.count = {14}, .axes = 1, .spacing = 0.3, .stretch = 1.25, .stiffness = 20, .damping = 0.5},
    {.count = {9, 4}, .axes = 2, .spacing = 0.3, .families = 7, .stiffness = 20, .pinned = SPRING_GRID_FIRST_X},
    {.count = {2, 3, 5},
     .spacing = 1.7,
     .families = 7,
     .stiffness = 20,
     .pinned = SPRING_GRID_LAST_Y | SPRING_GRID_FIRST_Z},
    {.count = {3, 1, 4},
     .spacing = 1.7,
     .families = 2,
     .stiffness = 20,
     .pinned = SPRING_GRID_LAST_Z | SPRING_GRID_LAST_X},
    {.count = {6, 5, 4}, .spacing = 1.7, .families = 4, .stretch = 0.8, .stiffness = 20, .pinned = SPRING_GRID_FIRST_Y},
    {.count = {7, 6}, .height = true, .spacing = 1, .families = 5, .stiffness = 20, .pinned = 15},
};

/* The family of a link between places that lie so far apart; 0: there is none. */
static uint32_t family_of(const int delta[3])
{
    int largest = 0, nonzero = 0;
    for (int a = 0; a < 3; a++) {
        const int length = abs(delta[a]);
        largest = length > largest ? length : largest;
        nonzero += length > 0;
    }
    return largest == 1 && nonzero == 1   ? SPRING_GRID_STRUCTURAL
           : largest == 1 && nonzero >= 2 ? SPRING_GRID_SHEAR
           : largest == 2 && nonzero == 1 ? SPRING_GRID_BEND
                                          : 0;
}

/* Where a link stands among those of its first particle, except for the index of the other one. */
static int rank_of(const int delta[3])
{
    int across = 0; /* of a link across a face: 0 if that is xy, 1 xz, 2 yz; 3 of a link through a cell */
    for (int a = 0; a < 3; a++)
        across = delta[a] == 0 ? 2 - a : across;
    if (delta[0] != 0 && delta[1] != 0 && delta[2] != 0)
        across = 3;
    const uint32_t family = family_of(delta);
    return (int)family * 4 + (family == SPRING_GRID_SHEAR ? across : 0);
}

static void check_grid(const spring_grid *g)
{
    static double position[3 * most];
    static uint8_t pinned[most];
    static spring_link link[most_links];
    size_t particles = 0, links = 0;
    CHECK(spring_grid_size(g, &particles, &links) == SPRING_OK && particles < most && links < most_links, "fits");
    for (size_t i = 0; i < 3 * most; i++)
        position[i] = -77;
    memset(pinned, 77, sizeof pinned);
    memset(link, 77, sizeof link);
    const spring_link untouched = link[0];
    CHECK(spring_grid_fill(g, position, pinned, link) == SPRING_OK, "as many");
    int count[3];
    for (int a = 0; a < 3; a++)
        count[a] = g->count[a] == 0 ? 1 : (int)g->count[a];
    CHECK((int)particles == count[0] * count[1] * count[2], "one at each place");
    const uint32_t axes = g->height ? 1 : g->axes == 0 ? 3 : g->axes, families = g->families == 0 ? 1 : g->families;
    CHECK(position[particles * axes] == -77 && pinned[particles] == 77 &&
              memcmp(&link[links], &untouched, sizeof untouched) == 0,
          "and no more");
    int at[most][3];
    for (int i = 0; i < (int)particles; i++) {
        bool face = false;
        for (int a = 0, rest = i; a < 3; rest /= count[a], a++) {
            at[i][a] = rest % count[a];
            face = face || (g->pinned >> 2 * a & 1 && at[i][a] == 0) ||
                   (g->pinned >> 2 * a & 2 && at[i][a] == count[a] - 1);
        }
        for (uint32_t a = 0; a < axes; a++)
            CHECK_BITS(position[(uint32_t)i * axes + a], g->height ? 0 : at[i][a] * g->spacing, "a grid");
        CHECK(pinned[i] == face, "the faces named");
    }
    size_t want = 0;
    for (size_t i = 0; i < particles; i++)
        for (size_t j = i + 1; j < particles; j++) {
            const int delta[] = {at[j][0] - at[i][0], at[j][1] - at[i][1], at[j][2] - at[i][2]};
            want += (family_of(delta) & families) != 0;
        }
    CHECK(links == want, "all pairs of the families");
    static bool seen[most][most];
    memset(seen, 0, sizeof seen);
    int last = 0;
    for (size_t i = 0; i < links; i++) {
        const uint32_t a = link[i].a, b = link[i].b;
        CHECK(a < b && b < particles, "from the lower to the upper");
        CHECK(!seen[a][b], "once each");
        seen[a][b] = true;
        const int delta[] = {at[b][0] - at[a][0], at[b][1] - at[a][1], at[b][2] - at[a][2]};
        CHECK((family_of(delta) & families) != 0, "of the families");
        const int rank = rank_of(delta);
        CHECK(i == 0 || a > link[i - 1].a ||
                  (a == link[i - 1].a && (rank > last || (rank == last && b > link[i - 1].b))),
              "in the order that scene.h names");
        last = rank;
        const double length = g->spacing * sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]);
        const double stretch = g->stretch == 0 ? 1 : g->stretch;
        CHECK_CLOSE(link[i].rest * stretch, g->height ? 0 : length, 2 * DBL_EPSILON * length,
                    "length over rest length");
        CHECK_BITS(link[i].stiffness, g->stiffness, "of every link");
        CHECK_BITS(link[i].damping, g->damping, "of every link");
    }
}

static void every_grid(void)
{
    for (size_t i = 0; i < sizeof grids / sizeof grids[0]; i++)
        check_grid(&grids[i]);
}

static void bad_grids(void)
{
    size_t particles = 11, links = 12;
    const spring_grid fine = {.count = {4, 3}, .axes = 2, .spacing = 0.5, .stiffness = 3};
    spring_grid bad[] = {fine, fine, fine, fine, fine, fine, fine, fine, fine, fine, fine, fine};
    bad[0].spacing = 0;
    bad[1].spacing = NAN;
    bad[2].stretch = -1;
    bad[3].stiffness = -1;
    bad[4].damping = INFINITY;
    bad[5].families = 8;
    bad[6].pinned = 64;
    bad[7].axes = 4;
    bad[8].axes = 1;      /* a sheet needs two */
    bad[9].height = true; /* and a height field has one */
    bad[10].count[2] = 2;
    bad[11].spacing = INFINITY;
    double position[24] = {-5};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK(spring_grid_size(&bad[i], &particles, &links) == SPRING_EINVAL, "bad input");
        CHECK(spring_grid_fill(&bad[i], position, NULL, NULL) == SPRING_EINVAL, "bad input");
    }
    spring_grid large = fine;
    large.axes = 3;
    large.count[0] = 1u << 16;
    large.count[1] = 1u << 16;
    CHECK(spring_grid_size(&large, &particles, &links) == SPRING_ERANGE, "2^32 particles");
    large.count[0] = large.count[1] = large.count[2] = UINT32_MAX;
    CHECK(spring_grid_size(&large, &particles, &links) == SPRING_ERANGE, "a product that overflows");
    CHECK(spring_grid_fill(&large, position, NULL, NULL) == SPRING_ERANGE, "and fills nothing");
    CHECK(spring_grid_size(NULL, &particles, &links) == SPRING_EINVAL &&
              spring_grid_size(&fine, NULL, &links) == SPRING_EINVAL &&
              spring_grid_size(&fine, &particles, NULL) == SPRING_EINVAL &&
              spring_grid_fill(&fine, NULL, NULL, NULL) == SPRING_EINVAL,
          "NULL");
    CHECK(particles == 11 && links == 12 && position[0] == -5, "nothing is written");
    CHECK(spring_grid_fill(&fine, position, NULL, NULL) == SPRING_OK && position[0] == 0,
          "pins and links are optional");
}

/* As many particles as indices can tell apart, as long as doubles reach; one more, or a little longer, is refused. */
static void grids_at_the_limits(void)
{
    size_t particles = 0, links = 0;
    spring_grid g = {.count = {65535, 65537}, .spacing = 0.5, .stiffness = 0.3};
    if (sizeof(size_t) > sizeof(uint32_t)) /* more links than 32 bits can count */
        CHECK(spring_grid_size(&g, &particles, &links) == SPRING_OK && particles == UINT32_MAX &&
                  links == UINT64_C(65534) * 65537 + UINT64_C(65535) * 65536,
              "2^32 - 1 particles, in rows and columns");
    const uint32_t too_many[][3] = {{1u << 16, 1u << 15, 2}, {1u << 16, 1u << 15, 4}, {1u << 31, 1u << 31, 4}};
    for (size_t i = 0; i < sizeof too_many / sizeof too_many[0]; i++) {
        memcpy(g.count, too_many[i], sizeof g.count);
        CHECK(spring_grid_size(&g, &particles, &links) == SPRING_ERANGE, "2^32, 2^33 and 2^64 particles");
    }
    for (int a = 0; a < 3; a++) {
        g = (spring_grid){.spacing = DBL_MAX / 4.5, .stiffness = 0};
        g.count[a] = 4;
        CHECK(spring_grid_size(&g, &particles, &links) == SPRING_OK && particles == 4 && links == 3,
              "places and links are finite, and springs need not pull");
        g.count[a] = 8;
        g.spacing = DBL_MAX / 9;
        CHECK(spring_grid_size(&g, &particles, &links) == SPRING_OK, "so are these");
        g.spacing = DBL_MAX / 6;
        CHECK(spring_grid_size(&g, &particles, &links) == SPRING_EINVAL, "7/6 DBL_MAX is infinite");
    }
    g = (spring_grid){.count = {4}, .spacing = 1e300, .stretch = 1e-10};
    CHECK(spring_grid_size(&g, &particles, &links) == SPRING_EINVAL, "rest lengths would be infinite");
    g.stretch = 1e-7;
    CHECK(spring_grid_size(&g, &particles, &links) == SPRING_OK, "1e307 is finite");
}

int main(void)
{
    static const test tests[] = {
        {"invalid definitions, and the fields that are named", refused},
        {"valid combinations", combinations},
        {"valid definitions", accepted},
        {"memory too small or misaligned", bad_memory},
        {"bytes of a particle", bytes_of_a_particle},
        {"methods store what they use", methods_store_what_they_use},
        {"bytes of a link", bytes_of_a_link},
        {"bytes of a scene", bytes_of_a_scene},
        {"definitions at the limits", definitions_at_the_limits},
        {"ropes, sheets and blocks", every_grid},
        {"bad grids", bad_grids},
        {"grids at the limits", grids_at_the_limits},
    };
    return RUN_TESTS("spring_scene_def", tests);
}
