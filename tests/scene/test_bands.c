/* SPDX-License-Identifier: MIT */
/* Many bands of links, with large offsets; the influence of one link on the bits of others; motion and forces in one
   pass over memory; records of unbanded links. */
#include "test_scene.h"

/* The first n particles of two scenes, to the bit. */
static bool same_first(const spring_scene *s, const spring_scene *other, size_t n, uint32_t axes)
{
    const size_t count = n * axes;
    double *all = malloc(4 * count * sizeof *all);
    for (size_t q = 0; q < 2; q++) {
        const spring_quantity quantity = q == 0 ? SPRING_POSITION : SPRING_VELOCITY;
        CHECK(spring_scene_get(s, quantity, all + q * count, 0, 0, n) == SPRING_OK &&
                  spring_scene_get(other, quantity, all + (2 + q) * count, 0, 0, n) == SPRING_OK,
              "the first particles");
    }
    const bool same = memcmp(all, all + 2 * count, 2 * count * sizeof *all) == 0;
    free(all);
    return same;
}

/* A few steps with each method in turn. */
static spring_scene *run_with(const scene_kernels *kernels, const spring_scene_def *def, double dt)
{
    const method_list all = methods_of(*def);
    spring_scene *s = scene_of(def);
    for (const spring_method *method = all.at; *method != no_method; method++)
        CHECK(spring_scene_advance_with(kernels, s, *method, dt, 3) == SPRING_OK, "stable");
    return s;
}

/* Without vectors, and in vectors of each length. */
static void check_bits_of_kernels(const model *m, double dt)
{
    spring_scene *first = run_with(kernels_of(0), &m->def, dt);
    for (int k = 1; k < kernel_count; k++)
        if (kernels_of(k) != NULL) {
            spring_scene *s = run_with(kernels_of(k), &m->def, dt);
            CHECK(same_bits(s, first, m->def.particles, m->def.axes), "lane by lane the same operations");
            free(s);
        }
    free(first);
}

/* ----------------------------------------------------------------------------------------------------------- bands */

static const uint32_t offsets[] = {1,  2,  3,  7,  8,  9,   15,  16,  17,  31,  32,  33,  48,  62,  63,  64, 65,
                                   66, 80, 95, 96, 97, 127, 128, 129, 130, 160, 191, 192, 193, 200, 257, 320};
enum { offset_count = sizeof offsets / sizeof offsets[0] };

/* Links of one offset between lower ends that begin and end anywhere, with gaps and links that are cut; in ascending
   order. */
static void add_band(model *m, uint32_t offset, unsigned features)
{
    const size_t room = m->def.particles - offset;
    const uint32_t first = (uint32_t)(random_bits() % (room - 9));
    const uint32_t end = first + 9 + (uint32_t)(random_bits() % (room - first - 9));
    const uint64_t gaps = random_bits() % 2;
    for (uint32_t i = first; i < end; i++) {
        if (gaps != 0 && i > first + 8 && random_bits() % 4 == 0)
            continue;
        spring_link link = {i, i + offset, 0.9, 13.7, features & DAMPED ? 0.21 : 0};
        if (features & OWN) {
            link.rest = random_uniform(0, 1);
            link.stiffness = random_log(3, 30);
            link.damping = features & DAMPED && random_bits() % 2 ? random_uniform(0, 0.3) : 0;
        }
        if (features & (OWN | EDITABLE) && random_bits() % 9 == 0)
            link.stiffness = link.damping = 0;
        m->link[m->def.links++] = link;
    }
}

static void build_bands(model *m, uint32_t axes, unsigned features, size_t most_offsets)
{
    const uint32_t particles = 20 + (uint32_t)(random_bits() % (most - 20));
    build(m, (uint32_t[]){particles, 1, 1}, axes, features & ~(unsigned)STRAY);
    for (uint32_t i = 1; i < particles; i++)
        if (random_bits() % 8 == 0) /* ends at one place */
            memcpy(m->position + i * axes, m->position + random_bits() % i * axes, axes * sizeof m->position[0]);
    m->def.links = 0;
    const size_t skipped = offset_count > most_offsets ? offset_count - most_offsets : 0;
    for (size_t o = 0; o < offset_count; o++)
        if (offsets[o] + 10 < particles && random_bits() % offset_count >= skipped)
            add_band(m, offsets[o], features);
    for (int i = 0; i < 5 && features & STRAY; i++)
        m->link[m->def.links++] = (spring_link){particles - 1, (uint32_t)i, 0.8, 9.7, 0};
    use_all_methods(&m->def);
}

static void many_bands(void)
{
    static model m;
    size_t bands = 0, tiles = 0;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 7) {
            build_bands(&m, axes, features, features % 16 == 0 ? offset_count : 5);
            spring_scene *s = scene_of(&m.def);
            bands = s->layout.bands > bands ? s->layout.bands : bands;
            for (uint32_t r = 0; r < s->layout.bands; r++)
                tiles += s->layout.band[r].first > tile && s->layout.band[r].offset > tile;
            free(s);
            check_bits_of_kernels(&m, 0.001);
            for (int k = 0; k < kernel_count; k++)
                if (kernels_of(k) != NULL)
                    check_forces(&m, kernels_of(k));
        }
    CHECK(bands == most_bands && tiles > 100, "as many as there can be, and in later tiles");
}

/* One of all offsets is too many for the table of bands. (Bits of such a scene depend on how many it may have.) */
static void one_band_too_many(void)
{
    enum { offsets_here = most_bands + 1, lowers = 70 };
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        build(&m, (uint32_t[]){lowers + 4 * offsets_here, 1, 1}, axes, 0);
        m.def.links = 0;
        for (uint32_t o = 1; o <= offsets_here; o++)
            for (uint32_t i = 0; i < lowers - (o == 3); i++)
                m.link[m.def.links++] = (spring_link){i, i + 4 * o, 0.6, 2.7, 0};
        spring_scene *s = scene_of(&m.def);
        CHECK(s->layout.bands == 32 && s->layout.unbanded == lowers - 1, "the shortest has no band");
        free(s);
        check_bits_of_kernels(&m, 0.001);
        for (int k = 0; k < kernel_count; k++)
            if (kernels_of(k) != NULL)
                check_forces(&m, kernels_of(k));
    }
}

/* ----------------------------------------------------------------------------------------------- lanes by themselves */

/* A band, and in a gap of it two particles that are joined to each other alone, so far apart. */
static void build_odd_link(model *m, uint32_t axes, uint32_t at, double apart, bool damped)
{
    static double velocity[3 * most];
    const uint32_t particles = 2 * tile;
    uint32_t links = 0;
    for (uint32_t i = 0; i < particles; i++) {
        for (uint32_t a = 0; a < axes; a++) {
            m->position[i * axes + a] = (double)((7 * i + 5 * a) % 13) / 11;
            velocity[i * axes + a] = (double)((5 * i + 3 * a) % 17) / 13;
        }
        if (i + 1 < particles && (i == at || i + 1 < at || i > at + 1))
            m->link[links++] = (spring_link){i, i + 1, 0.3, 2.7, damped ? 0.11 : 0};
    }
    for (uint32_t a = 0; a < axes; a++) {
        m->position[at * axes + a] = a == 0 ? 0 : 0.25; /* so that the smallest distance is one */
        m->position[(at + 1) * axes + a] = a == 0 ? apart : 0.25;
    }
    m->def = (spring_scene_def){.axes = axes,
                                .particles = particles,
                                .links = links,
                                .position = m->position,
                                .velocity = velocity,
                                .mass_all = 1.3,
                                .link = m->link};
    use_all_methods(&m->def);
}

/* The squares of such lengths are 0, denormal, beyond the range of the seed on either side, infinite. */
static void odd_links(void)
{
    static model m;
    static state all, want;
    const double tiny = sizeof(scalar) == 4 ? 1e-22 : 1e-160, huge = sizeof(scalar) == 4 ? 2e19 : 2e154;
    const double apart[] = {0, tiny * 1e-8, tiny, 1e-14, 1e9, huge};
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (int damped = 0; damped < 2; damped++)
            for (uint32_t at = 0; at < 2 * tile - 2; at += at < tile + 4 ? 1 : 13)
                for (int k = 0; k < kernel_count; k++) {
                    if (kernels_of(k) == NULL)
                        continue;
                    build_odd_link(&m, axes, at, 0.5, damped != 0);
                    spring_scene *usual = run_with(kernels_of(k), &m.def, 0.004);
                    get_state(usual, m.def.particles, &want);
                    free(usual);
                    for (size_t d = 0; d < sizeof apart / sizeof apart[0]; d++) {
                        build_odd_link(&m, axes, at, apart[d], damped != 0);
                        spring_scene *s = run_with(kernels_of(k), &m.def, 0.004);
                        CHECK(s->layout.bands == 1 && s->layout.unbanded == 0, "all in a band");
                        get_state(s, m.def.particles, &all);
                        free(s);
                        size_t differ = 0;
                        for (size_t i = 0; i < m.def.particles * axes; i++)
                            if (i / axes != at && i / axes != at + 1)
                                differ += memcmp(&all.x[i], &want.x[i], sizeof all.x[i]) != 0 ||
                                          memcmp(&all.v[i], &want.v[i], sizeof all.v[i]) != 0;
                        CHECK(differ == 0, "each link by itself");
                    }
                }
}

/* A few links far from where the scene begins, between ends far apart, keep few forces; with links that do nothing from
   end to end of the scene, their band keeps as many as any. The forces are the same. */
static void short_bands(void)
{
    enum { room = 3100, few_links = 11 };
    static double position[3 * room];
    static spring_link link[few_links + 2 * room];
    for (size_t i = 0; i < 3 * room; i++)
        position[i] = random_uniform(-9, 9);
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (uint32_t offset = 190; offset < 2500; offset += 127) {
            const uint32_t particles = room - (uint32_t)(random_bits() % 130);
            const uint32_t first = (uint32_t)(random_bits() % (particles - offset - few_links));
            spring_scene_def def = {.axes = axes,
                                    .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                                    .particles = particles,
                                    .position = position,
                                    .link = link};
            for (uint32_t i = first; i < first + few_links; i++)
                link[def.links++] = (spring_link){i, i + offset, 0.7, 3, 0};
            spring_scene *few = scene_of(&def);
            def.links = 0;
            for (uint32_t i = 0; i + offset < particles; i++) {
                const bool pulls = i >= first && i < first + few_links;
                link[def.links++] = (spring_link){i, i + offset, 0.7, pulls ? 3 : 0, 0};
            }
            spring_scene *many = scene_of(&def);
            CHECK(few->layout.bands == 1 && many->layout.bands == 1 && few->layout.unbanded == 0, "a band");
            CHECK(few->layout.bytes < many->layout.bytes, "few links, little memory");
            for (int k = 0; k < kernel_count; k++) {
                if (kernels_of(k) == NULL)
                    continue;
                CHECK(spring_scene_advance_with(kernels_of(k), few, SPRING_LEAPFROG, 0.01, 3) == SPRING_OK &&
                          spring_scene_advance_with(kernels_of(k), many, SPRING_LEAPFROG, 0.01, 3) == SPRING_OK,
                      "stable");
                CHECK(same_first(few, many, particles, axes), "the same forces");
            }
            free(few);
            free(many);
        }
}

/* -------------------------------------------------------------------------------------------- one pass over memory */

static void add_nothing(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                        scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v, (void)force;
}

typedef struct large {
    spring_scene_def def;
    double *position, *velocity, *mass;
    uint8_t *pinned;
    spring_link *link;
} large;

static large large_of(const spring_grid *g, size_t longest, bool particular)
{
    size_t particles, links;
    CHECK(spring_grid_size(g, &particles, &links) == SPRING_OK, "a grid");
    large l = {
        .position = malloc(3 * particles * sizeof(double)),
        .velocity = malloc(3 * particles * sizeof(double)),
        .mass = malloc(particles * sizeof(double)),
        .pinned = malloc(particles),
        .link = malloc((links + particles) * sizeof(spring_link)),
    };
    spring_grid_fill(g, l.position, NULL, l.link);
    for (size_t i = 0; i < 3 * particles; i++) {
        l.position[i] += random_uniform(-0.1, 0.1);
        l.velocity[i] = random_uniform(-1, 1);
    }
    for (size_t i = 0; i < particles; i++) {
        l.mass[i] = random_log(0.5, 2);
        l.pinned[i] = random_bits() % 9 == 0;
    }
    for (uint32_t i = 0; longest > 0 && i + longest < particles; i++)
        l.link[links++] = (spring_link){i, (uint32_t)(i + longest), 3, 0.7 + (particular ? 1e-3 * i : 0), 0};
    l.def = (spring_scene_def){.axes = g->axes,
                               .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                               .particles = particles,
                               .links = links,
                               .position = l.position,
                               .velocity = l.velocity,
                               .mass = particular ? l.mass : NULL,
                               .pinned = particular ? l.pinned : NULL,
                               .link = l.link,
                               .gravity = {0.3, -9.81, 0.2},
                               .drag = particular ? 0.21 : 0};
    return l;
}

static void clear_large(large *l)
{
    free(l->position);
    free(l->velocity);
    free(l->mass);
    free(l->pinned);
    free(l->link);
}

/* Offsets within a tile, of some tiles, of more than all that moves at once, of nearly all particles. */
static const struct {
    spring_grid grid;
    size_t longest;
} sweeps[] = {
    {{.count = {1023}, .axes = 3, .spacing = 0.7, .stiffness = 27}, 0},
    {{.count = {1024}, .axes = 1, .spacing = 0.7, .stiffness = 27}, 2},
    {{.count = {1025}, .axes = 2, .spacing = 0.7, .stiffness = 27, .families = 5}, 64},
    {{.count = {3001}, .axes = 3, .spacing = 0.7, .stiffness = 27}, 1024},
    {{.count = {3072}, .axes = 2, .spacing = 0.7, .stiffness = 27}, 1025},
    {{.count = {5003}, .axes = 3, .spacing = 0.7, .stiffness = 27}, 2700},
    {{.count = {2100}, .axes = 1, .spacing = 0.7, .stiffness = 27}, 2090},
    {{.count = {61, 43}, .axes = 3, .spacing = 0.7, .stiffness = 27, .families = 7}, 0},
    {{.count = {15, 14, 13}, .axes = 3, .spacing = 0.7, .stiffness = 27, .families = 7}, 0},
};

/* A callback that does nothing has everything computed in parts, with the same bits. */
static void one_pass(void)
{
    for (size_t i = 0; i < sizeof sweeps / sizeof sweeps[0]; i++)
        for (int features = 0; features < 4; features++) {
            large l = large_of(&sweeps[i].grid, sweeps[i].longest, (features & 1) != 0);
            for (size_t j = 0; (features & 2) != 0 && j < l.def.links; j++)
                l.link[j].damping = random_uniform(0.1, 0.4);
            for (int k = 0; k < kernel_count; k++) {
                if (kernels_of(k) == NULL)
                    continue;
                l.def.force = NULL;
                spring_scene *swept = scene_of(&l.def);
                CHECK(swept->layout.unbanded == 0 && swept->layout.bands > 0, "bands alone");
                l.def.force = add_nothing;
                spring_scene *parts = scene_of(&l.def);
                for (uint64_t n = 1; n <= 3; n++) {
                    CHECK(spring_scene_advance_with(kernels_of(k), swept, SPRING_LEAPFROG, 0.01, n) == SPRING_OK &&
                              spring_scene_advance_with(kernels_of(k), parts, SPRING_LEAPFROG, 0.01, n) == SPRING_OK,
                          "stable");
                    CHECK(same_first(swept, parts, l.def.particles, l.def.axes), "the same operations");
                }
                free(swept);
                free(parts);
            }
            clear_large(&l);
        }
}

/* What overflows somewhere on the way, in the motion before the forces or after, is rolled back. */
static void one_pass_fails(void)
{
    const double huge = sizeof(scalar) == 4 ? 1e37 : 1e307;
    for (size_t i = 3; i < 6; i++)
        for (int late = 0; late < 2; late++)
            for (size_t at = 5; at < 3000; at += 1000) {
                const double dt = late ? 8 : 100; /* [s] after 8 it is still finite, the force by a link is not */
                large l = large_of(&sweeps[i].grid, sweeps[i].longest, false);
                spring_scene *s = scene_of(&l.def), *untouched = scene_of(&l.def);
                double fast[3] = {huge, huge, huge}, was[3];
                spring_scene_get(s, SPRING_VELOCITY, was, 0, at, 1);
                spring_scene_set(s, SPRING_VELOCITY, fast, 0, at, 1);
                CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_ENONFINITE, "overflow");
                spring_scene_set(s, SPRING_VELOCITY, was, 0, at, 1);
                CHECK(same_first(s, untouched, l.def.particles, l.def.axes), "and rolled back");
                spring_scene_advance(s, SPRING_LEAPFROG, 0.01, 2);
                spring_scene_advance(untouched, SPRING_LEAPFROG, 0.01, 2);
                CHECK(same_first(s, untouched, l.def.particles, l.def.axes), "as good as new");
                free(s);
                free(untouched);
                clear_large(&l);
            }
}

/* --------------------------------------------------------------------------------------------------------- records */

/* Many unbanded links go through records of their particles, few do not: with the same bits. */
static void records_of_links(void)
{
    static model m;
    size_t with_bands = 0, without = 0;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 3) {
            if (features % 2 == 0)
                build(&m, (uint32_t[]){16, 1, 1}, axes, (features | STRAY) & ~(unsigned)SHUFFLED);
            else
                build(&m, (uint32_t[]){6, 4, 1}, axes, features | SHUFFLED);
            const size_t particles = m.def.particles;
            add_strangers(&m, 0);
            const model few = m;
            add_strangers(&m, 200);
            for (int k = 0; k < kernel_count; k++) {
                if (kernels_of(k) == NULL)
                    continue;
                spring_scene_def def = m.def;
                def.particles = few.def.particles;
                spring_scene *by_records = run_with(kernels_of(k), &def, 0.004);
                spring_scene *by_edges = run_with(kernels_of(k), &m.def, 0.004);
                CHECK(scene_has(by_records, ARRAY_RECORDS) && !scene_has(by_edges, ARRAY_RECORDS) &&
                          by_records->layout.unbanded == by_edges->layout.unbanded,
                      "at least as many unbanded links as particles, or fewer");
                with_bands += by_records->layout.bands > 0;
                without += by_records->layout.bands == 0;
                CHECK(same_first(by_records, by_edges, particles, axes), "the same operations");
                free(by_records);
                free(by_edges);
            }
        }
    CHECK(with_bands > 0 && without > 0, "with bands, and alone");
}

int main(void)
{
    static const test tests[] = {
        {"many bands", many_bands},
        {"one band too many", one_band_too_many},
        {"a link among others", odd_links},
        {"a few links far apart", short_bands},
        {"one pass over memory", one_pass},
        {"one pass that fails", one_pass_fails},
        {"records of unbanded links", records_of_links},
    };
    return RUN_TESTS("scene-bands", tests);
}
