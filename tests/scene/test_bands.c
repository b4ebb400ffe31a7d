/* SPDX-License-Identifier: MIT */
/* Which links form bands. test_random.c tests their forces. */
#include "test_scene.h"

/* So many links of an offset, from particle `first` on, the last of them moved up to particle `last`: bands, or
   none. */
static uint32_t bands_of(uint32_t links, uint32_t offset, uint32_t first, uint32_t last)
{
    static const double position[3 * 1200];
    spring_link link[64];
    for (uint32_t i = 0; i < links; i++) {
        const uint32_t lower = i + 1 < links ? first + i : last;
        link[i] = (spring_link){lower, lower + offset, 0.6, 2.7, 0, 0};
    }
    const uint32_t more = 13; /* so that the scene is not small */
    const spring_scene_def def = {
        .particles = last + offset + more, .links = links, .position = position, .link = link};
    spring_scene *s = scene_of(&def);
    const uint32_t bands = s->layout.bands;
    CHECK(s->layout.unbanded == (bands == 0 ? links : 0), "in a band, or in the edge list");
    free(s);
    return bands;
}

/* Eight links make a band if they take a quarter of its places. */
static void what_makes_a_band(void)
{
    for (uint32_t first = 0; first < 500; first += 499)
        for (uint32_t offset = 1; offset <= 256; offset += 255) {
            CHECK(bands_of(8, offset, first, first + 7) == 1, "eight links");
            CHECK(bands_of(7, offset, first, first + 6) == 0, "seven links are too few");
            CHECK(bands_of(10, offset, first, first + 42) == 1, "10 of 43 places, a quarter rounded down");
            CHECK(bands_of(10, offset, first, first + 43) == 0, "10 of 44 places are less than a quarter");
        }
}

/* The results of bands and of unbanded links differ in rounding errors, so a scene of few links must stay without bands. */
static void few_links_form_no_band(void)
{
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (uint32_t n = 9; n <= 13; n++) {
            build(&m, (uint32_t[]){n, 1, 1}, axes, 0);
            m.def.links = n - 1;
            for (uint32_t i = 0; i + 1 < n; i++)
                m.link[i] = (spring_link){i, i + 1, 0.3, 20, 0, 0};
            spring_scene *s = scene_of(&m.def);
            CHECK(s->layout.bands == (axes == 1 || n > 12), "a sorted rope of 12 particles has no band");
            free(s);
        }
}

static void check_layout(const model *m, size_t bands, size_t unbanded, const char *why)
{
    spring_scene *s = scene_of(&m->def);
    CHECK(s->layout.bands == bands && s->layout.unbanded == unbanded, why);
    free(s);
}

/* More offsets than there is room for bands, in ascending order and in descending order. */
static void many_offsets(void)
{
    enum { offsets = most_bands + 8, lowers = 10 };
    static model m;
    for (int descending = 0; descending < 2; descending++) {
        build(&m, (uint32_t[]){lowers + offsets, 1, 1}, 3, 0);
        m.def.links = 0;
        for (uint32_t k = 1; k <= offsets; k++) {
            const uint32_t offset = descending ? offsets + 1 - k : k;
            for (uint32_t i = offset % 5 == 0 ? 1 : 0; i < lowers; i++)
                m.link[m.def.links++] = (spring_link){i, i + offset, 0.6, 0.27 * offset, 0, 0};
        }
        check_layout(&m, most_bands, (offsets - most_bands) * (lowers - 1), "the longest have bands");
    }
}

/* As many bands as there can be, in the small table in which their offsets are counted: sheets of many widths. */
static void offsets_that_meet(void)
{
    static const uint32_t widths[] = {1, 3, 16, 35, 100, 255, 256, 257, 512, 1000, 1024};
    enum { lowers = 8, widest = 1024 };
    static const double position[lowers + most_bands * widest];
    static model m;
    for (size_t w = 0; w < sizeof widths / sizeof widths[0]; w++) {
        for (uint32_t i = 0; i < most_bands * lowers; i++)
            m.link[i] = (spring_link){i % lowers, i % lowers + (i / lowers + 1) * widths[w], 0.6, 2.7, 0, 0};
        m.def = joined(1, lowers + most_bands * widths[w], position, NULL, most_bands * lowers, m.link);
        check_layout(&m, most_bands, 0, "each has its band");
    }
}

/* Links that break the order of a band: one again, one late, one below the first. They alone lie in the edge list. And
   one link of every offset: far too few for bands. */
static void stray_links(void)
{
    enum { particles = 37, again = 11, late = 22 };
    static model m;
    build(&m, (uint32_t[]){particles, 1, 1}, 2, 0);
    m.def.links = 0;
    for (uint32_t i = 1; i + 1 < particles; i++) {
        const uint32_t lower[] = {i, i == late + 3 ? late : i};
        for (int k = i == late ? 2 : 0; k < (i == again || i == late + 3 ? 2 : 1); k++)
            m.link[m.def.links++] = (spring_link){lower[k], lower[k] + 1, 0.6, 2.7, 0, 0};
    }
    m.link[m.def.links++] = (spring_link){0, 1, 0.6, 2.7, 0, 0};
    check_layout(&m, 1, 3, "a band, and three unbanded links");
    build(&m, (uint32_t[]){most, 1, 1}, 2, 0);
    m.def.links = most - 1;
    for (uint32_t i = 0; i + 1 < most; i++)
        m.link[i] = (spring_link){0, i + 1, 0.5, 2, 0, 0};
    check_layout(&m, 0, most - 1, "one link makes no band");
    build(&m, (uint32_t[]){5, 6, 7}, 3, 0);
    check_layout(&m, 16, 0, "a block with diagonals and bending links has sixteen offsets, and each its band");
}

int main(void)
{
    static const test tests[] = {
        {"what makes a band", what_makes_a_band},
        {"few links form no band", few_links_form_no_band},
        {"many offsets", many_offsets},
        {"offsets that meet", offsets_that_meet},
        {"stray links", stray_links},
    };
    return RUN_TESTS("scene-bands", tests);
}
