/* SPDX-License-Identifier: MIT */
/*
 * Prints the bits of many springs after many steps, in hexadecimal (a digest for batches). They are the same for every
 * compiler, flag and processor.
 *
 * The library computes with + - * / and sqrt alone. The expected output is bits.txt; it changes only with a "Results"
 * line in CHANGELOG.md.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include <springstep/batch.h>
#include <springstep/clock.h>
#include <springstep/scene.h>
#include <springstep/spring.h>

static void print(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    printf(" %016" PRIx64, bits);
}

static const uint64_t no_digest = UINT64_C(0xcbf29ce484222325);

/* FNV-1a (Fowler, Noll, Vo 1991), of numbers in little-endian order on every processor */
static uint64_t digest_bits(uint64_t hash, uint64_t bits, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        hash = (hash ^ (bits >> 8 * i & 0xff)) * UINT64_C(0x100000001b3);
    return hash;
}

static uint64_t digest(uint64_t hash, const double *numbers, size_t how_many)
{
    for (size_t i = 0; i < how_many; i++) {
        uint64_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        hash = digest_bits(hash, bits, sizeof bits);
    }
    return hash;
}

static uint64_t digestf(uint64_t hash, float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return digest_bits(hash, bits, sizeof bits);
}

/* Numbers of about 1 become denormal floats, or doubles, with some twenty bits left. */
static const double to_denormal = 0x1p-1053;
static const float to_denormalf = 0x1p-131f;

enum { count = 141 }; /* springs: no multiple of any group, and more than the largest */

static void print_batches(const char *name, spring_method m, bool damped, bool loaded, uint32_t shared, bool denormal)
{
    static double x[count], v[count], w[count], g[count], a[count];
    static float xf[count], vf[count], wf[count], gf[count], af[count];
    for (int i = 0; i < count; i++) {
        xf[i] = (float)(x[i] = (i - 70) / 83.0);
        vf[i] = (float)(v[i] = (30 - i) / 59.0);
        wf[i] = (float)(w[i] = (i % 7 + 3) / 1.3);
        gf[i] = (float)(g[i] = i % 5 == 1 ? 0 : i % 5 == 2 ? 250 : (i % 11 + 1) / 19.0); /* some beyond the limits */
        af[i] = (float)(a[i] = (i % 13 - 6) / 1.7);
        if (denormal) {
            x[i] *= to_denormal, v[i] *= to_denormal, a[i] *= to_denormal;
            xf[i] *= to_denormalf, vf[i] *= to_denormalf, af[i] *= to_denormalf;
        }
    }
    const spring_batch b = {count, x, v, w, damped ? g : NULL, loaded ? a : NULL, shared};
    const spring_batchf bf = {count, xf, vf, wf, damped ? gf : NULL, loaded ? af : NULL, shared};
    static uint8_t failed[count], failedf[count];
    spring_batch_advance_marked(&b, m, 0.0123, 1000, failed);
    spring_batchf_advance_marked(&bf, m, 0.0123, 1000, failedf);
    uint8_t status = SPRING_OK, statusf = SPRING_OK; /* of the last spring that failed */
    uint64_t hash = no_digest, hashf = no_digest;
    for (int i = 0; i < count; i++) {
        hash = digest(digest(hash, &x[i], 1), &v[i], 1);
        hashf = digestf(digestf(hashf, xf[i]), vf[i]);
        status = failed[i] ? failed[i] : status;
        statusf = failedf[i] ? failedf[i] : statusf;
    }
    printf("batch-%s %s %016" PRIx64 " %s, float %016" PRIx64 " %s\n", name, spring_method_name(m), hash,
           spring_status_string((spring_status)status), hashf, spring_status_string((spring_status)statusf));
}

enum { particles = 7 * 5, most_links = 6 * particles };

/* What makes a scene here. */
typedef struct sheet {
    uint32_t axes;
    size_t links;
    double position[3 * particles];
    uint8_t pinned[particles];
    spring_link link[most_links + particles]; /* and tethers */
    size_t bends;
    spring_weighted_link bend[4 * particles];
} sheet;

/* A sheet of 7 x 5, or a height field. Jumbled, its links and their strengths have no order. */
static sheet *make_sheet(uint32_t axes, bool jumbled, bool damped)
{
    static sheet s; /* too large for the stack of WebAssembly */
    const spring_grid grid = {
        .count = {7, 5},
        .axes = axes,
        .height = axes == 1,
        .spacing = 0.1,
        .stretch = 1.1,
        .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
        .stiffness = 70,
        .damping = damped ? 0.02 : 0,
        .pinned = SPRING_GRID_FIRST_X,
    };
    memset(&s, 0, sizeof s);
    s.axes = axes;
    size_t nodes;
    spring_grid_size(&grid, &nodes, &s.links);
    spring_grid_fill(&grid, s.position, s.pinned, s.link);
    for (size_t i = 0; jumbled && i < s.links; i++) {
        const size_t other = (i * 37 + 11) % s.links;
        const spring_link old = s.link[i];
        s.link[i] = s.link[other];
        s.link[other] = old;
        s.link[i].stiffness += (double)(i % 5);
    }
    for (size_t i = 0; i < nodes * axes; i++)
        s.position[i] += (double)(i * 29 % 17) / 331; /* no product: nothing to fuse here */
    return &s;
}

/* The definition of a sheet, in either precision. */
#define SHEET_DEF(type)                                          \
    static type##_def type##_of(const sheet *s, spring_method m) \
    {                                                            \
        return (type##_def){.axes = s->axes,                     \
                            .methods = 1u << m,                  \
                            .particles = particles,              \
                            .links = s->links,                   \
                            .position = s->position,             \
                            .mass_all = 0.3,                     \
                            .pinned = s->pinned,                 \
                            .link = s->link,                     \
                            .weighted_links = s->bends,          \
                            .weighted_link = s->bend,            \
                            .gravity = {0.3, -9.81, 0.1},        \
                            .drag = 0.07};                       \
    }

SHEET_DEF(spring_scene)
SHEET_DEF(spring_scenef)

#define SCENE_BITS(type)                                                                                               \
    static uint64_t type##_bits(const sheet *given, spring_method m, double scale)                                     \
    {                                                                                                                  \
        static _Alignas(SPRING_SCENE_ALIGN) unsigned char memory[1 << 17];                                             \
        double position[3 * particles], out[2][3 * particles] = {{0}};                                                 \
        for (size_t i = 0; i < 3 * particles; i++)                                                                     \
            position[i] = given->position[i] * scale;                                                                  \
        type##_def def = type##_of(given, m);                                                                          \
        def.position = position;                                                                                       \
        for (int i = 0; i < 3; i++)                                                                                    \
            def.gravity[i] *= scale;                                                                                   \
        type *s;                                                                                                       \
        if (type##_init(memory, sizeof memory, &def, &s) != SPRING_OK || type##_advance(s, m, 1e-3, 300) != SPRING_OK) \
            return 0;                                                                                                  \
        type##_get(s, SPRING_POSITION, out[0], 0, 0, particles);                                                       \
        type##_get(s, SPRING_VELOCITY, out[1], 0, 0, particles);                                                       \
        const spring_scene_energies e = type##_energy(s);                                                              \
        const double more[] = {e.kinetic, e.elastic, e.gravity, type##_stable_step(s, m), type##_tension(s, 5)};       \
        return digest(digest(no_digest, out[0], 6 * particles), more, 5);                                              \
    }

SCENE_BITS(spring_scene)
SCENE_BITS(spring_scenef)

static void print_scene(const char *name, const sheet *s, spring_method m, double scale, double scalef)
{
    printf("scene-%s %" PRIu32 " %s %016" PRIx64 ", float %016" PRIx64 "\n", name, s->axes, spring_method_name(m),
           spring_scene_bits(s, m, scale), spring_scenef_bits(s, m, scalef));
}

/* Link damping beyond the limit of explicit damping, in scenes with bands, without, and small ones: far beyond, and where
   a step evaluates damping once. */
static void print_heavy_damping(void)
{
    for (int once = 0; once < 2; once++)
        for (uint32_t axes = 1; axes <= 3; axes++)
            for (int kind = 0; kind < 3; kind++) {
                sheet *const s = make_sheet(axes, kind == 1, true);
                if (kind == 2)
                    s->links = 12;
                for (size_t i = 0; i < s->links; i++)
                    s->link[i].damping *= once ? 300 : 1e4;
                static const char *const names[][3] = {{"heavy-rows", "heavy-list", "heavy-few"},
                                                       {"once-rows", "once-list", "once-few"}};
                print_scene(names[once][kind], s, SPRING_LEAPFROG, 1, 1);
            }
}

/* Bending by rows, columns and diagonals, attachments with rest lengths, and tethers. */
static void print_bending(spring_method m)
{
    const bool smooth = spring_method_describe(m)->positions_only;
    const spring_grid grid = {.count = {7, 5}, .spacing = 0.1};
    sheet *const s = make_sheet(3, false, !smooth);
    s->bends = 4 * particles;
    if (spring_bend_grid(&grid, s->pinned, SPRING_BEND_ROWS | SPRING_BEND_DIAGONALS, 0.03, smooth ? 0 : 1e-3, s->bend,
                         &s->bends) != SPRING_OK)
        return;
    for (uint32_t i = 0; i < 8; i++)
        s->bend[s->bends++] = (spring_weighted_link){.particle = {i, i + 9, i + 10, i + 17},
                                                     .weight = {-1, 0.25, 0.5, 0.25},
                                                     .rest = i % 3 * 0.1,
                                                     .stiffness = 3 + i};
    spring_scene_def def = {.particles = particles, .links = s->links, .position = s->position, .pinned = s->pinned};
    def.link = s->link, def.weighted_links = s->bends, def.weighted_link = s->bend;
    uint32_t work[2 * particles];
    double distance[2 * particles];
    size_t tethers = particles;
    if (!smooth && spring_links_tethers(&def, 0.05, 0.01, s->link + s->links, &tethers, work, distance) == SPRING_OK)
        s->links += tethers;
    print_scene("bending", s, m, 1, 1);
}

static uint64_t digest_weighted(uint64_t hash, const spring_weighted_link *link, size_t links)
{
    for (size_t i = 0; i < links; i++) {
        for (int k = 0; k < 4; k++)
            hash = digest_bits(hash, link[i].particle[k], 4);
        hash = digest(digest(hash, link[i].weight, 4), &link[i].stiffness, 1);
    }
    return hash;
}

/* The links of a rod with unequal segments and of a mesh with vertices that are split. */
static void print_mesh_links(void)
{
    enum { vertices = 4 * particles, triangles = 2 * particles };
    static double position[3 * vertices];
    static uint32_t triangle[3 * triangles], particle_of[vertices], work[3 * vertices + 6 * triangles + 1];
    static spring_link link[3 * triangles];
    static spring_weighted_link bend[3 * triangles];
    size_t corners = 0, found, links = 3 * triangles, bends = 3 * triangles;
    for (uint32_t i = 0; i < vertices; i++) {
        const uint32_t p = i % particles, x = p % 7, y = p / 7;
        position[3 * i] = x / 7. + p * p % 11 / 91. + i / particles / 4096.;
        position[3 * i + 1] = y / 7. - p * p % 13 / 97.;
        position[3 * i + 2] = p * p % 5 / 89.;
        if (i < particles && x < 6 && y < 4) {
            const uint32_t square[6] = {i, i + 1, i + 8, i, i + 8, i + 7};
            for (int k = 0; k < 6; k++)
                triangle[corners++] = square[k] + (i * 5 + (uint32_t)k * 3) % 4 * particles;
        }
    }
    uint64_t hash = no_digest;
    if (spring_links_from_mesh(vertices, position, corners / 3, triangle, 1e-3, particle_of, &found, link, &links,
                               work) == SPRING_OK)
        for (size_t i = 0; i < links; i++)
            hash = digest(digest_bits(hash, link[i].a * UINT64_C(1000) + link[i].b, 8), &link[i].rest, 1);
    for (size_t i = 0; i < corners; i++)
        triangle[i] = particle_of[triangle[i]];
    if (spring_bend_mesh(found, position, corners / 3, triangle, NULL, 0.3, 0, bend, &bends, work) == SPRING_OK)
        hash = digest_weighted(hash, bend, bends);
    bends = 3 * triangles;
    if (spring_bend_rod(particles, 3, position, NULL, 0.3, 0, bend, &bends) == SPRING_OK)
        hash = digest_weighted(hash, bend, bends);
    printf("mesh %zu %zu %zu %016" PRIx64 "\n", found, links, bends, hash);
}

/* Bending by rows and columns, or by any four particles, links that only pull, tethers, and links of rest length 0. */
static void print_further_links(spring_method m)
{
    const bool plain = spring_method_describe(m)->positions_only;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (int kind = 0; kind < (m == SPRING_LEAPFROG ? 3 : 2); kind++) {
            sheet *const s = make_sheet(axes, kind == 1, !plain);
            for (size_t i = 0; i < s->links; i++) {
                s->link[i].flags = axes > 1 && !plain && i % 3 == 0 ? 1 + (uint32_t)(i / 3 % 2) : 0;
                s->link[i].rest = i % 7 == 0 ? 0 : s->link[i].rest;
                s->link[i].damping *= kind == 2 ? 1e4 : 1;
            }
            for (uint32_t i = 0; i + 2 < particles; i++) {
                const uint32_t step = i % 7 < 5 || i + 14 >= particles ? 1 : 7;
                spring_weighted_link w = {
                    {i, i + step, i + 2 * step, (i + 4) % particles}, {0.5, -1, 0.5, 0}, 0, 40, 0};
                if (kind != 0 && i % 2 == 0) {
                    w.weight[2] = 0.25;
                    w.weight[3] = 0.25;
                    w.rest = i % 3 == 0 && axes > 1 ? 0.05 : 0;
                }
                w.damping = plain ? 0 : kind == 2 ? 90 : 0.03;
                if (w.weight[3] == 0 ||
                    (w.particle[3] != i && w.particle[3] != i + step && w.particle[3] != i + 2 * step))
                    s->bend[s->bends++] = w;
            }
            static const char *const names[] = {"bend-rows", "bend-list", "bend-heavy"};
            print_scene(names[kind], s, m, 1, 1);
        }
}

static void print_scenes(spring_method m)
{
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (int jumbled = 0; jumbled < 2; jumbled++) {
            const sheet *const s = make_sheet(axes, jumbled, jumbled && !spring_method_describe(m)->positions_only);
            print_scene(jumbled ? "list" : "rows", s, m, 1, 1);
        }
    const sheet *const height_field =
        make_sheet(1, false, false); /* is linear, so its motion is the same, except for rounding */
    print_scene("denormal", height_field, m, to_denormal, (double)to_denormalf);
}

/* Tension-only links, held forces, links that tear and are reeled in, and a scene that is moved as a whole. */
#define SLACK_BITS(type)                                                                                       \
    static uint64_t type##_slack_bits(const sheet *given, spring_method m)                                     \
    {                                                                                                          \
        static sheet s;                                                                                        \
        s = *given;                                                                                            \
        static _Alignas(SPRING_SCENE_ALIGN) unsigned char memory[1 << 17];                                     \
        static const double map[12] = {0.6, -0.8, 0, 1.3, 0.8, 0.6, 0, -0.7, 0, 0, -1, 0.3};                   \
        double force[3 * particles], out[2][3 * particles] = {{0}};                                            \
        for (int i = 0; i < 3 * particles; i++)                                                                \
            force[i] = (double)(i * 31 % 23 - 11) / 7;                                                         \
        type##_def def = type##_of(&s, m);                                                                     \
        def.flags = SPRING_SCENE_TENSION_ONLY | SPRING_SCENE_FORCES | SPRING_SCENE_EDITABLE;                   \
        type *scene;                                                                                           \
        size_t torn = 0;                                                                                       \
        uint32_t list[most_links] = {0};                                                                       \
        if (type##_init(memory, sizeof memory, &def, &scene) != SPRING_OK ||                                   \
            type##_set(scene, SPRING_FORCE, force, 0, 0, particles) != SPRING_OK ||                            \
            type##_advance(scene, m, 1e-3, 150) != SPRING_OK ||                                                \
            type##_tear(scene, 1.8, NULL, list, most_links, &torn) != SPRING_OK)                               \
            return 0;                                                                                          \
        for (size_t i = 0; i < s.links; i++)                                                                   \
            s.link[i].rest *= 0.75;                                                                            \
        if (type##_set_links(scene, 0, 9, s.link) != SPRING_OK || type##_transform(scene, map) != SPRING_OK || \
            type##_advance(scene, m, 1e-3, 150) != SPRING_OK)                                                  \
            return 0;                                                                                          \
        type##_get(scene, SPRING_POSITION, out[0], 0, 0, particles);                                           \
        type##_get(scene, SPRING_VELOCITY, out[1], 0, 0, particles);                                           \
        const spring_scene_energies e = type##_energy(scene);                                                  \
        const double more[] = {e.kinetic, e.elastic, (double)torn, (double)list[1], type##_tension(scene, 5)}; \
        return digest(digest(no_digest, out[0], 6 * particles), more, 5);                                      \
    }

SLACK_BITS(spring_scene)
SLACK_BITS(spring_scenef)

static void print_slack_scenes(spring_method m)
{
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (int jumbled = 0; jumbled < 2; jumbled++)
            for (int damped = 0; damped < 2; damped++) {
                const sheet *const s = make_sheet(axes, jumbled, damped);
                printf("slack-%s%s %" PRIu32 " %s %016" PRIx64 ", float %016" PRIx64 "\n", jumbled ? "list" : "rows",
                       damped ? "-damped" : "", axes, spring_method_name(m), spring_scene_slack_bits(s, m),
                       spring_scenef_slack_bits(s, m));
            }
}

/* Colliders of all shapes that move and spin, in the way of a sheet, or of few particles. */
#define CONTACT_BITS(type)                                                                                             \
    static uint64_t type##_contact_bits(const sheet *given, spring_method m, size_t used)                              \
    {                                                                                                                  \
        static _Alignas(SPRING_SCENE_ALIGN) unsigned char memory[1 << 17];                                             \
        static const spring_collider c[4] = {                                                                          \
            {.shape = SPRING_PLANE, .at = {0, -0.2, 0}, .axis = {{0.6, 0.8, 0}}, .friction = 0.4, .restitution = 0.3}, \
            {.shape = SPRING_SPHERE,                                                                                   \
             .at = {0.4, -0.25, 0},                                                                                    \
             .radius = 0.2,                                                                                            \
             .velocity = {0.1, 0.5, 0},                                                                                \
             .friction = 0.2},                                                                                         \
            {.shape = SPRING_CAPSULE,                                                                                  \
             .at = {0.1, -0.1, -1},                                                                                    \
             .to = {0.1, -0.2, 1},                                                                                     \
             .radius = 0.07,                                                                                           \
             .velocity_to = {0.2, 0, 0},                                                                               \
             .friction = 0.7},                                                                                         \
            {.shape = SPRING_BOX,                                                                                      \
             .at = {0.2, 0.8, 0},                                                                                      \
             .axis = {{0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}},                                                       \
             .half = {0.1, 0.2, 0.3},                                                                                  \
             .radius = 0.03,                                                                                           \
             .velocity = {0, -1, 0},                                                                                   \
             .spin = {0, 0, 4},                                                                                        \
             .friction = 0.5,                                                                                          \
             .restitution = 0.8}};                                                                                     \
        double out[2][3 * particles] = {{0}};                                                                          \
        uint32_t mask[particles] = {0}, ever[particles] = {0};                                                         \
        type##_def def = type##_of(given, m);                                                                          \
        def.particles = used, def.links = used < particles ? 0 : def.links;                                            \
        def.colliders = 4, def.particle_radius = 0.01;                                                                 \
        type *scene;                                                                                                   \
        if (type##_init(memory, sizeof memory, &def, &scene) != SPRING_OK ||                                           \
            type##_set_colliders(scene, c, 4) != SPRING_OK)                                                            \
            return 0;                                                                                                  \
        for (int call = 0; call < 30; call++) {                                                                        \
            if (type##_advance(scene, m, 1e-3, 20) != SPRING_OK)                                                       \
                return 0;                                                                                              \
            type##_touching(scene, mask, 0, used);                                                                     \
            for (size_t i = 0; i < used; i++)                                                                          \
                ever[i] |= mask[i];                                                                                    \
        }                                                                                                              \
        type##_get(scene, SPRING_POSITION, out[0], 0, 0, used);                                                        \
        type##_get(scene, SPRING_VELOCITY, out[1], 0, 0, used);                                                        \
        uint64_t hash = digest(no_digest, out[0], 6 * particles);                                                      \
        for (size_t i = 0; i < used; i++)                                                                              \
            hash = digest_bits(hash, ever[i], 4);                                                                      \
        return hash;                                                                                                   \
    }

CONTACT_BITS(spring_scene)
CONTACT_BITS(spring_scenef)

static void print_contacts(spring_method m)
{
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (int damped = 0; damped < 3; damped++)
            for (int few = 0; few < (damped ? 1 : 2); few++) {
                sheet *const s = make_sheet(axes, false, damped > 0);
                for (size_t i = 0; i < s->links; i++)
                    s->link[i].damping *= damped == 2 ? 500 : 1;
                printf("contacts-%s%s %" PRIu32 " %s %016" PRIx64 ", float %016" PRIx64 "\n", few ? "few" : "rows",
                       damped == 2 ? "-heavy"
                       : damped    ? "-damped"
                                   : "",
                       axes, spring_method_name(m), spring_scene_contact_bits(s, m, few ? 9 : particles),
                       spring_scenef_contact_bits(s, m, few ? 9 : particles));
            }
}

/* The bytes of a saved state, and those of the state 200 steps after it has been loaded into a new scene. Equal bytes are
   what lets a state travel from one target to another. */
#define STATE_BITS(type)                                                                                              \
    static type *type##_stated(void *memory, size_t bytes, const sheet *s)                                            \
    {                                                                                                                 \
        type##_def def = type##_of(s, SPRING_LEAPFROG);                                                               \
        def.flags = SPRING_SCENE_FORCES | SPRING_SCENE_EDITABLE, def.methods = 0;                                     \
        def.colliders = s->axes > 1 ? 9 : 0;                                                                          \
        type *scene = NULL;                                                                                           \
        return type##_init(memory, bytes, &def, &scene) == SPRING_OK ? scene : NULL;                                  \
    }                                                                                                                 \
    static uint64_t type##_state_bytes(const type *scene, unsigned char *state, size_t *bytes)                        \
    {                                                                                                                 \
        if (type##_save(scene, state, bytes) != SPRING_OK)                                                            \
            return 0;                                                                                                 \
        uint64_t hash = no_digest;                                                                                    \
        for (size_t i = 0; i < *bytes; i++)                                                                           \
            hash = digest_bits(hash, state[i], 1);                                                                    \
        return hash;                                                                                                  \
    }                                                                                                                 \
    static void type##_state_bits(const sheet *s, uint64_t hash[2])                                                   \
    {                                                                                                                 \
        static _Alignas(SPRING_SCENE_ALIGN) unsigned char memory[2][1 << 17], state[1 << 16];                         \
        double force[3 * particles];                                                                                  \
        spring_collider c[9] = {{.shape = SPRING_SPHERE, .at = {0.3, 0.1, 0.05}, .radius = 0.25, .velocity = {0.1}}}; \
        for (int i = 1; i < 9; i++)                                                                                   \
            c[i] = (spring_collider){.shape = SPRING_PLANE, .at = {0, -0.1 * i, 0}, .axis = {{0, 1, 0}}};             \
        for (int i = 0; i < 3 * particles; i++)                                                                       \
            force[i] = (double)(i * 31 % 23 - 11) / 7;                                                                \
        size_t bytes = sizeof state;                                                                                  \
        type *const one = type##_stated(memory[0], sizeof memory[0], s);                                              \
        type *const other = type##_stated(memory[1], sizeof memory[1], s);                                            \
        hash[0] = hash[1] = 0;                                                                                        \
        if (type##_set(one, SPRING_FORCE, force, 0, 0, particles) != SPRING_OK ||                                     \
            (s->axes > 1 && type##_set_colliders(one, c, 9) != SPRING_OK) ||                                          \
            type##_advance(one, SPRING_LEAPFROG, 1e-3, 150) != SPRING_OK ||                                           \
            type##_tear(one, 1.6, NULL, NULL, 0, NULL) != SPRING_OK ||                                                \
            type##_advance(one, SPRING_LEAPFROG, 1e-3, 20) != SPRING_OK)                                              \
            return;                                                                                                   \
        hash[0] = type##_state_bytes(one, state, &bytes);                                                             \
        if (type##_load(other, state, bytes) != SPRING_OK ||                                                          \
            type##_advance(other, SPRING_LEAPFROG, 1e-3, 200) != SPRING_OK)                                           \
            return;                                                                                                   \
        bytes = sizeof state;                                                                                         \
        hash[1] = type##_state_bytes(other, state, &bytes);                                                           \
    }

STATE_BITS(spring_scene)
STATE_BITS(spring_scenef)

static void print_states(void)
{
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (int jumbled = 0; jumbled < 2; jumbled++) {
            const sheet *const s = make_sheet(axes, jumbled, jumbled);
            uint64_t hash[2][2];
            spring_scene_state_bits(s, hash[0]);
            spring_scenef_state_bits(s, hash[1]);
            printf("state-%s %" PRIu32 " %016" PRIx64 " %016" PRIx64 ", float %016" PRIx64 " %016" PRIx64 "\n",
                   jumbled ? "list" : "rows", axes, hash[0][0], hash[0][1], hash[1][0], hash[1][1]);
        }
}

/* Few steps, many that oscillate or do not, and a few periods of many. */
static void print_accuracy(spring_method m)
{
    static const struct {
        spring_params p;
        double duration, tolerance;
    } asked[] = {{{1.3, 2.7, 0.1, 0}, 3, 1e-2},  {{1.3, 2.7, 0, 0}, 2000, 1e-3}, {{1.3, 2.7, 0.02, 0}, 900, 1e-4},
                 {{1.3, 2.7, 0.6, 0}, 20, 1e-5}, {{1.3, 2.7, 370, 0}, 1, 1e-3},  {{1.3, 1e-4, 0, 0}, 3, 1e-5},
                 {{1.3, 0, 0.6, 0.4}, 11, 1e-4}};
    printf("accuracy %s", spring_method_name(m));
    for (size_t i = 0; i < sizeof asked / sizeof asked[0]; i++) {
        const double step = spring_accurate_step(&asked[i].p, m, asked[i].duration, asked[i].tolerance);
        print(step);
        print(spring_step_error(&asked[i].p, m, asked[i].duration, 2.7 * step));
    }
    printf("\n");
}

/* Springs that follow a target that moves: on their way, and where they land after the target has stopped. */
static void print_follow(void)
{
    static const struct {
        const char *name;
        spring_params p;
    } cases[] = {{"undamped", {1.3, 2.7, 0, 0}},   {"damped", {1.3, 270, 6, 0}},  {"loaded", {0.7, 270, 9, 0.9}},
                 {"critical", {1, 400, 40, 0}},    {"heavy", {1.7, 30, 51, 0.2}}, {"dragged", {1.3, 0, 0.6, 0.9}},
                 {"denormal", {1.3, 2.7, 0.06, 0}}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double scale = i == 6 ? 1e-306 : 1;
        spring_state s = {0.83 * scale, -0.59 * scale};
        uint64_t hash = no_digest;
        spring_status status = SPRING_OK;
        for (int frame = 1; frame <= 6000 && status == SPRING_OK; frame++) {
            const double moved = frame <= 120 ? frame / 64.0 : 1.875; /* no product: nothing to fuse here */
            status = spring_follow(&s, &cases[i].p, moved * scale, frame <= 120 ? 60 * scale / 64 : 0, 1.0 / 60);
            hash = digest(digest(hash, &s.x, 1), &s.v, 1);
        }
        printf("follow %s %s %016" PRIx64, cases[i].name, spring_status_string(status), hash);
        print(s.x);
        print(s.v);
        printf("\n");
    }
}

static void print_follow_batches(const char *name, bool damped, bool loaded, uint32_t shared)
{
    static double x[count], v[count], w[count], g[count], a[count], target[count], v_target[count];
    static float xf[count], vf[count], wf[count], gf[count], af[count], targetf[count], vf_target[count];
    for (int i = 0; i < count; i++) {
        xf[i] = (float)(x[i] = (i - 70) / 83.0);
        vf[i] = (float)(v[i] = (30 - i) / 59.0);
        wf[i] = (float)(w[i] = i % 17 == 5 ? 0 : (i % 7 + 3) * 64);
        gf[i] = (float)(g[i] = i % 5 == 1 ? 0 : i % 5 == 2 ? 250 : (i % 11 + 1) * 2.5);
        af[i] = (float)(a[i] = (i % 13 - 6) / 1.7);
        targetf[i] = (float)(target[i] = (i % 29 - 14) / 0.3);
        vf_target[i] = (float)(v_target[i] = i % 3 == 0 ? 0 : i % 31 - 15);
    }
    const spring_batch b = {count, x, v, w, damped ? g : NULL, loaded ? a : NULL, shared};
    const spring_batchf bf = {count, xf, vf, wf, damped ? gf : NULL, loaded ? af : NULL, shared};
    uint64_t hash = no_digest, hashf = no_digest;
    for (int frame = 0; frame < 300; frame++) {
        const double tolerance = frame < 200 ? 0 : 0.01;
        size_t moving = 0, movingf = 0;
        spring_batch_follow(&b, target, 1.0 / 60, tolerance, tolerance, &moving);
        spring_batchf_follow(&bf, targetf, 1.0 / 60, tolerance, tolerance, &movingf);
        hash = digest_bits(hash, moving, 4);
        hashf = digest_bits(hashf, movingf, 4);
        for (int i = 0; i < count; i++) {
            hash = digest(digest(hash, &x[i], 1), &v[i], 1);
            hashf = digestf(digestf(hashf, xf[i]), vf[i]);
        }
    }
    printf("follow-batch %s %016" PRIx64 ", float %016" PRIx64 "\n", name, hash, hashf);
    hash = hashf = no_digest;
    for (int frame = 0; frame < 100; frame++) {
        size_t moving = 0, movingf = 0;
        for (int i = 0; i < count; i++)
            targetf[i] = (float)(target[i] = target[i] + v_target[i] / 64);
        spring_batch_follow_moving(&b, target, v_target, 1.0 / 64, 0.01, 0.01, &moving);
        spring_batchf_follow_moving(&bf, targetf, vf_target, 1.0 / 64, 0.01, 0.01, &movingf);
        hash = digest_bits(hash, moving, 4);
        hashf = digest_bits(hashf, movingf, 4);
        for (int i = 0; i < count; i++) {
            hash = digest(digest(hash, &x[i], 1), &v[i], 1);
            hashf = digestf(digestf(hashf, xf[i]), vf[i]);
        }
    }
    printf("follow-batch-moving %s %016" PRIx64 ", float %016" PRIx64 "\n", name, hash, hashf);
}

static void print_params(spring_params p)
{
    print(p.stiffness);
    print(p.damping);
}

int main(void)
{
    static const struct {
        const char *name;
        spring_params p;
        double dt;
    } cases[] = {
        {"plain", {1.3, 2.7, 0, 0}, 0.01},        {"damped", {1.3, 2.7, 0.06, 0}, 0.013},
        {"loaded", {0.7, 2.7, 0, 0.9}, 0.017},    {"both", {1.9, 3.1, 0.05, -0.7}, 0.011},
        {"backwards", {1.3, 2.7, 0, 0.9}, -0.01}, {"undone", {1.3, 2.7, 0.06, 0.2}, -0.003},
        {"critical", {1.0, 4.0, 4.0, 0.3}, 0.01}, {"overdamped", {1.7, 0.3, 5.1, 0}, 0.1},
        {"heavy", {7e20, 2e19, 1e17, 3e18}, 0.3}, {"light", {3e-22, 7e-21, 1e-23, 2e-22}, 0.02},
        {"free", {1.3, 0, 0, 0.9}, 0.01},         {"dragged", {1.3, 0, 0.6, 0.9}, 0.01},
        {"long", {1.3, 2.7, 1e-9, 0.3}, 1e6},
    };
    printf("self-test: %s\n", spring_status_string(spring_self_test()));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int j = 0; j < SPRING_METHOD_COUNT; j++) {
            const spring_method m = spring_method_at(j);
            if (!spring_method_describe(m)->springs)
                continue;
            spring_state s = {0.83, -0.59};
            const spring_status status = spring_advance(&s, &cases[i].p, m, cases[i].dt, 1000);
            printf("%s %s %s", cases[i].name, spring_method_name(m), spring_status_string(status));
            print(s.x);
            print(s.v);
            print(spring_energy(&s, &cases[i].p));
            print(spring_stable_step(&cases[i].p, m));
            printf("\n");
        }
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const spring_state s = {0.83, -0.59};
        printf("%s settles", cases[i].name);
        print(spring_settling_time(&s, &cases[i].p, 1e-3));
        printf("\n%s rests", cases[i].name);
        print(spring_rest_time(&s, &cases[i].p, 1e-3, 1e-4));
        printf("\n");
    }

    for (int j = 0; j < SPRING_METHOD_COUNT; j++) {
        const spring_method m = spring_method_at(j);
        if (!spring_method_describe(m)->springs)
            continue;
        print_batches("plain", m, false, false, 0, false);
        print_batches("damped", m, true, false, 0, false);
        print_batches("loaded", m, false, true, SPRING_SHARED_OMEGA2, false);
        print_batches("both", m, true, true, SPRING_SHARED_ACCEL, false);
        print_batches("same", m, true, true, SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA, false);
        print_batches("denormal", m, true, true, 0, true);
    }

    for (int j = 0; j < SPRING_METHOD_COUNT; j++)
        if (spring_method_describe(spring_method_at(j))->scenes)
            print_scenes(spring_method_at(j));

    spring_clock clock = {0};
    double alpha = 0;
    uint64_t steps = 0;
    for (int frame = 1; frame <= 1000; frame++)
        steps += spring_clock_tick(&clock, 0.37 / (frame % 29 + 1), 1.0 / 240, 7, &alpha);
    printf("clock %" PRIu64, steps);
    print(alpha);
    print(clock.pending);
    print(clock.dropped);
    printf("\n");

    for (int j = 0; j < SPRING_METHOD_COUNT; j++) {
        const spring_method m = spring_method_at(j);
        if (spring_method_describe(m)->springs)
            print_accuracy(m);
    }

    print_follow();
    print_follow_batches("own", true, false, 0);
    print_follow_batches("loaded", true, true, SPRING_SHARED_ACCEL);
    print_follow_batches("undamped", false, true, SPRING_SHARED_OMEGA2);
    print_follow_batches("same", true, false, SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA);
    print_follow_batches("same-loaded", true, true, SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA);
    printf("parameters");
    print_params(spring_params_response(0.5, 0.75));
    print_params(spring_params_bounce(0.5, 0.3));
    print_params(spring_params_bounce(0.7, -0.3));
    print_params(spring_params_settling(0.4, 1, 0.001));
    print_params(spring_params_settling(0.4, 0.3, 0.01));
    print_params(spring_params_settling(0.4, 3, 0.01));
    printf("\n");

    for (int j = 0; j < SPRING_METHOD_COUNT; j++) {
        const spring_method m = spring_method_at(j);
        if (spring_method_describe(m)->scenes && !spring_method_describe(m)->positions_only)
            print_slack_scenes(m);
    }
    print_heavy_damping();
    print_further_links(SPRING_LEAPFROG);
    print_further_links(SPRING_RK4);
    print_further_links(SPRING_SRKN6);
    print_contacts(SPRING_LEAPFROG);
    print_contacts(SPRING_SYMPLECTIC_EULER);
    print_contacts(SPRING_RK4);
    for (int j = 0; j < SPRING_METHOD_COUNT; j++)
        if (spring_method_describe(spring_method_at(j))->scenes)
            print_bending(spring_method_at(j));
    print_mesh_links();
    print_states();
    return 0;
}
