/* SPDX-License-Identifier: MIT */
/*
 * Checks that the floating-point environment of this thread gives reproducible results.
 *
 * Method    Numbers that the compiler cannot fold are rounded, halved below the smallest normal number, multiplied and
 *           added. Then every method advances a spring, a batch and a scene by a few steps, as far as it supports them.
 *           The digest of the results must equal the digest in the row of the method.
 * Source    FNV-1a: Fowler, Noll, Vo (1991)
 */
#include <springstep/batch.h>
#include <springstep/scene.h>

#include "self_test.h"
#include "../simd/arithmetic.h"

#include <stddef.h>
#include <string.h>

#include "../simd/size_begin.h"

static bool rounds_to_nearest(void)
{
    const volatile double one = 1, less_than_half = 0x1p-54, more_than_half = 0x1.8p-53; /* of an ulp */
    return one + less_than_half == 1 && -one - less_than_half == -1 && one + more_than_half == 1 + DBL_EPSILON &&
           -one - more_than_half == -1 - DBL_EPSILON;
}

static bool keeps_denormals(void)
{
    const volatile double least = 0x1p-1074, normal = DBL_MIN;
    const volatile float leastf = 0x1p-149F, normalf = FLT_MIN;
    return least > 0 && normal / 2 > 0 && leastf > 0 && normalf / 2 > 0;
}

static bool rounds_products(void)
{
    const volatile double a = 1 + 0x1p-30;
    const double x = a, product = x * x - (1 + 0x1p-29); /* fused: 2^-60 */
    return product == 0;
}

#ifdef SPRING_WHOLE

static uint64_t digest_of(uint64_t digest, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    for (int i = 0; i < 64; i += 8)
        digest = (digest ^ (bits >> i & 0xff)) * UINT64_C(0x100000001b3);
    return digest;
}

enum { test_steps = 7 };
static const double test_dt = 0.23, test_mass = 1.3, test_stiffness = 2.7, test_x = 0.3, test_v = -0.7;

/* In batches, the second spring overflows unless the method is stable for every step. */
static uint64_t digest_of_springs(uint64_t digest, spring_method m)
{
    const spring_params p = {test_mass, test_stiffness, 0.6, 0.4};
    spring_state s = {test_x, test_v};
    spring_advance(&s, &p, m, test_dt, test_steps);
    digest = digest_of(digest_of(digest, s.x), s.v);

    double x[] = {test_x, test_x}, v[] = {test_v, test_v};
    const double w[] = {test_stiffness / test_mass, 1e150}, g[] = {0.6 / test_mass, 1e100}, a[] = {0.4 / test_mass, 0};
    const spring_batch b = {2, x, v, w, g, a, 0};
    uint8_t failed[2];
    spring_batch_advance_marked(&b, m, test_dt, test_steps, failed);
    digest = digest_of(digest, failed[1]);

    float xf[] = {(float)test_x * 0x1p-131F, (float)test_x},
          vf[] = {(float)test_v * 0x1p-131F, (float)test_v}; /* the first denormal */
    const float wf[] = {(float)w[0], 1e30F}, gf[] = {(float)g[0], 1e20F};
    const spring_batchf bf = {2, xf, vf, wf, gf, NULL, 0};
    spring_batchf_advance_marked(&bf, m, test_dt, test_steps, failed);
    digest = digest_of(digest, failed[1]);
    for (int i = 0; i < 2; i++)
        digest = digest_of(digest_of(digest_of(digest_of(digest, x[i]), v[i]), (double)xf[i]), (double)vf[i]);
    return digest;
}

static uint64_t digest_of_scene(uint64_t digest, spring_method m)
{
    const spring_link link = {.a = 0, .b = 1, .rest = 1.25, .stiffness = test_stiffness};
    uint64_t memory[1 << 11]; /* aligned to 8 bytes */
    double position[] = {test_x, test_v, 1 - test_x, 1 + test_v};
    const spring_scene_def def = {.axes = 2,
                                  .methods = 1u << m,
                                  .particles = 2,
                                  .links = 1,
                                  .position = position,
                                  .mass_all = test_mass,
                                  .link = &link,
                                  .gravity = {0, -9.81},
                                  .drag = 0.6};
    spring_scene *s;
    if (spring_scene_init(memory, sizeof memory, &def, &s) == SPRING_OK &&
        spring_scene_advance(s, m, test_dt, test_steps) == SPRING_OK)
        spring_scene_get(s, SPRING_POSITION, position, 0, 0, def.particles);
    for (int i = 0; i < 4; i++)
        digest = digest_of(digest, position[i]);
    return digest;
}

uint64_t spring_digest_of_method(spring_method m)
{
    const spring_method_info *info = spring_method_describe(m);
    uint64_t digest = UINT64_C(0xcbf29ce484222325);
    if (info->springs)
        digest = digest_of_springs(digest, m);
    if (info->scenes)
        digest = digest_of_scene(digest, m);
    return digest;
}

static bool bits_are_right(void)
{
    bool right = true;
    for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
        const spring_method m = spring_method_at(place);
        right = right && spring_digest_of_method(m) == spring_expected_digest(m);
    }
    return right;
}

#else
static bool bits_are_right(void)
{
    return true;
}
#endif

spring_status spring_self_test(void)
{
    return !rounds_to_nearest() ? SPRING_EROUNDING
           : !keeps_denormals() ? SPRING_EFLUSHED
           : !rounds_products() ? SPRING_EFUSED
           : !bits_are_right()  ? SPRING_EBITS
                                : SPRING_OK;
}

#include "../simd/size_end.h"
