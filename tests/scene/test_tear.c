/* SPDX-License-Identifier: MIT */
/* Links at the limit of tearing, and connected components. test_random.c compares torn links with their definition. */
#include "test_scene.h"

/* A rope of three links stretched by exactly its limit holds, and by one bit more it tears. */
static void at_the_limit(void)
{
    double x[3 * 40] = {0};
    spring_link link[39];
    for (uint32_t i = 0; i < 40; i++) {
        x[3 * i] = 1.5 * i;
        if (i > 0)
            link[i - 1] = (spring_link){i, i - 1, 1, 3, 0.1, 0};
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
            link[i] = (spring_link){a, b < a ? b : b + 1, 1, random_bits() % 3 ? 2 : 0, random_bits() % 3 ? 0 : 0.1, 0};
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
    const spring_link good = {0, 1, 1, 1, 0, 0};
    const spring_link bad[] = {{0, 3, 1, 1, 0, 0},   {3, 0, 1, 1, 0, 0},  {1, 1, 1, 1, 0, 0},
                               {0, 1, 1, NAN, 0, 0}, {0, 1, 1, 1, -1, 0}, {0, 1, 1, INFINITY, 0, 0}};
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
        {"at the limit", at_the_limit},
        {"components", components},
        {"bad components", bad_components},
    };
    return RUN_TESTS("scene-tear", tests);
}
