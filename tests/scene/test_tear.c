/* SPDX-License-Identifier: MIT */
/* Links that tear, setting many links at once, and connected components. */
#include "test_scene.h"

/* ------------------------------------------------------------------------------------------------------------ tearing */

/* With links that are cut, and links without rest length. */
static void build_torn(model *m, const uint32_t count[3], uint32_t axes, unsigned features)
{
    build(m, count, axes, features | EDITABLE);
    for (size_t i = 0; i < m->def.links; i++)
        if (random_bits() % 9 == 0)
            m->link[i].stiffness = m->link[i].damping = 0;
        else if (random_bits() % 9 == 0)
            m->link[i].rest = 0;
        else if (axes == 1)
            m->link[i].rest = random_uniform(0.1, 1);
}

/* The links that are longer than a limit, from their definition. Returns how many. */
static size_t longer_links(const spring_scene *s, double stretch, const double *limit, uint32_t *longer)
{
    static state y;
    const uint32_t axes = s->layout.axes;
    size_t count = 0;
    get_state(s, s->layout.particles, &y);
    for (size_t i = 0; i < s->layout.links; i++) {
        spring_link link;
        spring_scene_get_link(s, i, &link);
        double square = 0, delta = 0;
        for (uint32_t a = 0; a < axes; a++) {
            delta = y.x[link.b * axes + a] - y.x[link.a * axes + a];
            square += delta * delta;
        }
        const double length = axes == 1 ? delta : sqrt(square);
        if ((link.stiffness > 0 || link.damping > 0) && link.rest > 0 &&
            length > (limit != NULL ? limit[i] : stretch) * link.rest)
            longer[count++] = (uint32_t)i;
    }
    return count;
}

static double energy_of(const spring_scene *s, const uint32_t *links, size_t count)
{
    static state y;
    double sum = 0;
    get_state(s, s->layout.particles, &y);
    for (size_t i = 0; i < count; i++) {
        spring_link link;
        spring_scene_get_link(s, links[i], &link);
        const double extension = evaluate_link(&link, s->layout.axes, y.x, y.v).length - link.rest;
        if (extension > 0 || (s->layout.flags & SPRING_SCENE_TENSION_ONLY) == 0)
            sum += link.stiffness * extension * extension / 2;
    }
    return sum;
}

static void check_tear(const spring_scene *s, size_t bytes, double stretch, const double *limit)
{
    static uint32_t want[most_links], got[most_links];
    const size_t count = longer_links(s, stretch, limit, want);
    const double elastic = spring_scene_energy(s).elastic, lost = energy_of(s, want, count);
    spring_scene *copy = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    for (int k = 0; k < kernel_count; k++) {
        if (kernels_of(k) == NULL)
            continue;
        memcpy(copy, s, bytes); /* a rollback */
        size_t torn = 0;
        CHECK(spring_scene_tear_with(kernels_of(k), copy, stretch, limit, got, most_links, &torn) == SPRING_OK &&
                  torn == count && memcmp(got, want, count * sizeof *got) == 0,
              "those that are longer, in their order");
        CHECK_CLOSE(spring_scene_energy(copy).elastic, elastic - lost, 1e-14 * elastic,
                    "the energy falls by that of the torn links; sums of the same numbers");
        CHECK(longer_links(copy, stretch, limit, got) == 0, "none is left");
        CHECK(spring_scene_tear(copy, stretch, limit, NULL, 0, &torn) == SPRING_OK && torn == 0,
              "and none tears again");
        CHECK(same_bits(s, copy, s->layout.particles, s->layout.axes), "no particle moves");
    }
    free(copy);
}

static void tearing(void)
{
    static model m;
    static double limit[most_links];
    static const uint32_t shapes[][3] = {{6, 1, 1}, {11, 2, 1}, {5, 4, 3}, {70, 4, 1}};
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 17)
            for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++) {
                build_torn(&m, shapes[k], axes, features);
                if (axes > 1 && features % 2 == 0)
                    m.def.flags |= SPRING_SCENE_TENSION_ONLY;
                m.def.methods = 1u << SPRING_LEAPFROG;
                size_t bytes = 0;
                spring_scene_bytes(&m.def, &bytes);
                spring_scene *s = scene_of(&m.def);
                for (size_t i = 0; i < m.def.links; i++)
                    limit[i] = random_bits() % 4 == 0 ? INFINITY : random_log(0.8, 3);
                for (double stretch = 0; stretch < 4; stretch += 0.7)
                    check_tear(s, bytes, stretch, NULL);
                check_tear(s, bytes, INFINITY, NULL);
                check_tear(s, bytes, 1e12, NULL);
                check_tear(s, bytes, NAN, limit);
                free(s);
            }
}

/* A rope of three links stretched by exactly its limit holds, and by one bit more it tears. */
static void at_the_limit(void)
{
    double x[3 * 40] = {0};
    spring_link link[39];
    for (uint32_t i = 0; i < 40; i++) {
        x[3 * i] = 1.5 * i;
        if (i > 0)
            link[i - 1] = (spring_link){i, i - 1, 1, 3, 0.1};
    }
    const spring_scene_def def = {
        .flags = SPRING_SCENE_EDITABLE, .particles = 40, .links = 39, .position = x, .link = link};
    spring_scene *s = scene_of(&def);
    size_t count = 9;
    uint32_t torn[2] = {77, 77};
    CHECK(spring_scene_tear(s, 1.5, NULL, torn, 2, &count) == SPRING_OK && count == 0 && torn[0] == 77, "not longer");
    const double farther[] = {1.5 * 39 + 64 * EPS, 0, 0};
    spring_scene_set(s, SPRING_POSITION, farther, 0, 39, 1);
    CHECK(spring_scene_tear(s, 1.5, NULL, torn, 2, &count) == SPRING_OK && count == 1 && torn[0] == 38 && torn[1] == 77,
          "longer by a rounding");
    CHECK(spring_scene_tear(s, 1.4, NULL, torn, 2, &count) == SPRING_OK && count == 38 && torn[0] == 0 && torn[1] == 1,
          "no more than there is room for");
    CHECK(spring_scene_stable_step(s, SPRING_LEAPFROG) == INFINITY, "no link is left");
    free(s);
}

/* ---------------------------------------------------------------------------------------------------------- components */

/* Each particle takes the least number among its neighbours until nothing changes. */
static void spread_least(size_t particles, size_t links, const spring_link *link, uint32_t *least)
{
    for (size_t i = 0; i < particles; i++)
        least[i] = (uint32_t)i;
    for (bool changes = true; changes;) {
        changes = false;
        for (size_t i = 0; i < links; i++) {
            uint32_t *a = &least[link[i].a], *b = &least[link[i].b];
            if (*a != *b && (link[i].stiffness > 0 || link[i].damping > 0)) {
                *a = *b = *a < *b ? *a : *b;
                changes = true;
            }
        }
    }
}

static void components(void)
{
    enum { n = 200 };
    static spring_link link[n];
    static uint32_t least[n], got[n];
    for (int repeat = 0; repeat < 2000; repeat++) {
        const size_t particles = 2 + random_bits() % (n - 2), links = random_bits() % n;
        for (size_t i = 0; i < links; i++) {
            const uint32_t a = (uint32_t)(random_bits() % particles), b = (uint32_t)(random_bits() % (particles - 1));
            link[i] = (spring_link){a, b < a ? b : b + 1, 1, random_bits() % 3 ? 2 : 0, random_bits() % 3 ? 0 : 0.1};
        }
        spread_least(particles, links, link, least);
        size_t count = 0;
        bool same = true;
        const size_t found = spring_links_components(particles, links, link, got);
        for (size_t i = 0; i < particles; i++) {
            same = same && got[i] == (least[i] == i ? count : got[least[i]]);
            count += least[i] == i;
        }
        CHECK(same && found == count, "numbers in the order of the least particles");
    }
}

static void bad_components(void)
{
    uint32_t got[3] = {7, 7, 7};
    const spring_link good = {0, 1, 1, 1, 0};
    const spring_link bad[] = {{0, 3, 1, 1, 0},   {3, 0, 1, 1, 0},  {1, 1, 1, 1, 0},
                               {0, 1, 1, NAN, 0}, {0, 1, 1, 1, -1}, {0, 1, 1, INFINITY, 0}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK(spring_links_components(3, 2, (spring_link[]){good, bad[i]}, got) == 0 && got[0] == 7, "a bad link");
    CHECK(spring_links_components(3, 1, NULL, got) == 0 && spring_links_components(3, 1, &good, NULL) == 0 &&
              spring_links_components(0, 0, NULL, got) == 0 && got[0] == 7,
          "NULL, no particles");
    CHECK(spring_links_components(3, 0, NULL, got) == 3 && got[0] == 0 && got[1] == 1 && got[2] == 2, "no links");
}

int main(void)
{
    static const test tests[] = {
        {"torn links", tearing},
        {"at the limit", at_the_limit},
        {"components", components},
        {"bad components", bad_components},
    };
    return RUN_TESTS("scene-tear", tests);
}
