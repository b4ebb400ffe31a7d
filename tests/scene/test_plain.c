/* SPDX-License-Identifier: MIT */
/* Kernels compiled without vectors, for compilers without vector extensions, are bit-identical to vector kernels.
   The tests of scenes test them for scenes as well; see kernels_of(). */
#include "kernels/batch_kernels.h"
#include "test_methods.h"
#include "test_scene.h"

extern const batch_kernels plain_batch;

/* ------------------------------------------------------------------------------------------------------------
   batches */

enum { springs = 70 }; /* groups of both kinds, and a rest */

typedef struct springs_at {
    scalar x[springs], v[springs], w[springs], g[springs], a[springs];
} springs_at;

/* How many in eight are given a number that is not valid, or too large to stay finite. */
static void draw(springs_at *s, uint64_t bad_of_8)
{
    const scalar largest = (scalar)(sizeof(scalar) == 4 ? (double)FLT_MAX : DBL_MAX);
    for (size_t i = 0; i < springs; i++) {
        s->x[i] = (scalar)random_uniform(-1, 1);
        s->v[i] = (scalar)random_uniform(-1, 1);
        s->w[i] = (scalar)random_log(0.1, 10);
        s->g[i] = (scalar)random_log(1e-4, 60); /* q above and below 1 in leapfrog */
        s->a[i] = (scalar)random_uniform(-1, 1);
        scalar *const one[] = {&s->x[i], &s->v[i], &s->w[i], &s->g[i], &s->a[i]};
        const scalar bad[] = {NAN, INFINITY, -1, -(scalar)0, largest};
        if (random_bits() % 8 < bad_of_8)
            *one[random_bits() % 5] = bad[random_bits() % 5];
    }
}

/* Bit i of features: the array of w, g or a is shared; 8 and 16: no g, no a. */
static spring_batch batch_of(springs_at *s, unsigned features)
{
    return (spring_batch){springs,     s->x, s->v, s->w, features & 8 ? NULL : s->g, features & 16 ? NULL : s->a,
                          features & 7};
}

static void batches(void)
{
    static springs_at plain, vectors;
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        for (unsigned features = 0; features < 32; features++)
            for (size_t k = 0; k < 9; k++) {
                const uint64_t n = k % 3 != 0      ? k % 3
                                   : features == 7 ? 5000
                                                   : 16,
                               bad_of_8 = k / 3 * 4; /* none, half, all */
                const scalar dt = (scalar)(k == 4 ? -0.05 : 0.05);
                draw(&plain, bad_of_8);
                vectors = plain;
                const spring_batch b = batch_of(&plain, features), c = batch_of(&vectors, features);
                const spring_status got = spring_batch_advance_with(&plain_batch, &b, *m, dt, n);
                const spring_status want = spring_batch_advance_with(&spring_batch_v128, &c, *m, dt, n);
                CHECK(got == want, "lane by lane the same operations");
                CHECK(memcmp(&plain, &vectors, sizeof plain) == 0, "lane by lane the same operations");
            }
}

/* -------------------------------------------------------------------------------------------------------------
   scenes */

int main(void)
{
    static const test tests[] = {
        {"batches", batches},
    };
    return RUN_TESTS("plain", tests);
}
