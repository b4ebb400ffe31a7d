/* SPDX-License-Identifier: MIT */
/* Scenes of few particles, which fill no SIMD vector: forces compared with a plain loop. */
#include "test_scene.h"

enum { most_small_particles = 13 };

/* Any links between particles in a box, in an order that makes no band. */
static void build_small(model *m, size_t particles, size_t links, uint32_t axes, unsigned features)
{
    build(m, (uint32_t[]){(uint32_t)particles, 1, 1}, axes, features & ~(unsigned)(STRAY | SHUFFLED));
    for (size_t i = 0; i < particles * axes; i++)
        m->position[i] = random_uniform(-1, 1);
    m->def.links = particles > 1 ? links : 0;
    for (size_t i = 0; i < m->def.links; i++) {
        const uint32_t lower = (uint32_t)((m->def.links - 1 - i) * (particles - 1) / m->def.links); /* descending */
        const uint32_t upper = lower + 1 + (uint32_t)(random_bits() % (particles - 1 - lower));
        const bool reversed = random_bits() % 2 != 0;
        m->link[i] = (spring_link){
            reversed ? upper : lower,    reversed ? lower : upper,
            random_uniform(0, 1),        random_bits() % 8 == 0 ? 0 : random_log(3, 60),
            features & DAMPED ? 0.3 : 0,
        };
        if (features & OWN && random_bits() % 2)
            m->link[i].damping = 0;
    }
    if (particles > 2 && random_bits() % 4 == 0) /* at one place */
        memcpy(m->position + axes, m->position, axes * sizeof m->position[0]);
    use_all_methods(&m->def);
}

static void against_a_plain_loop(void)
{
    static model m;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (size_t n = 1; n <= most_small_particles; n++)
            for (size_t links = 0; links <= most_small_particles; links++)
                for (unsigned features = 0; features < SHUFFLED; features++) {
                    build_small(&m, n, links, axes, features | (links % 2 ? DAMPED : 0));
                    for (int k = 0; k < kernel_count; k++)
                        if (kernels_of(k) != NULL)
                            check_forces(&m, kernels_of(k));
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
                m.link[i] = (spring_link){i, i + 1, 0.3, 20, 0};
            spring_scene *s = scene_of(&m.def);
            CHECK(s->layout.bands == (axes == 1 || n > 12), "a sorted rope of 12 particles has no band");
            free(s);
        }
}

int main(void)
{
    static const test tests[] = {
        {"forces against a plain loop", against_a_plain_loop},
        {"few links form no band", few_links_form_no_band},
    };
    return RUN_TESTS("scene-small", tests);
}
