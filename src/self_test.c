/* SPDX-License-Identifier: MIT */
/*
 * Is the arithmetic here what the library promises its bits on?
 *
 * Method    Numbers that a compiler does not know are rounded, halved below the smallest normal number, multiplied and
 *           added. Then every method moves a spring, alone and in batches, for a few steps: a digest of the bits stands
 *           in its row. Of scenes nothing is run: their kernels are compiled as those of batches are.
 * Source    FNV-1a: Fowler, Noll, Vo (1991)
 */
#include <springstep/batch.h>

#include "self_test.h"
#include "simd/arithmetic.h"

#include <stddef.h>
#include <string.h>

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

static uint64_t digest_of(uint64_t digest, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    for (int i = 0; i < 64; i += 8)
        digest = (digest ^ (bits >> i & 0xff)) * UINT64_C(0x100000001b3);
    return digest;
}

uint64_t spring_digest_of_method(spring_method m)
{
    enum { steps = 7 };
    const double dt = 0.25, w = 2.7, g = 0.6, a = 0.4, x0 = 0.3, v0 = -0.7;
    uint64_t digest = UINT64_C(0xcbf29ce484222325);

    const spring_params p = {1, w, g, a};
    spring_state s = {x0, v0};
    spring_advance(&s, &p, m, dt, steps);
    digest = digest_of(digest_of(digest, s.x), s.v);

    double x = x0, v = v0;
    const spring_batch b = {1, &x, &v, &w, &g, &a, 0};
    spring_batch_advance(&b, m, dt, steps);
    digest = digest_of(digest_of(digest, x), v);

    const float wf = (float)w;
    float xf = (float)x0 * 0x1p-131F, vf = (float)v0 * 0x1p-131F; /* denormal */
    const spring_batchf bf = {1, &xf, &vf, &wf, NULL, NULL, 0};
    spring_batchf_advance(&bf, m, (float)dt, steps);
    return digest_of(digest_of(digest, (double)xf), (double)vf);
}

spring_status spring_self_test(void)
{
    if (!rounds_to_nearest())
        return SPRING_EROUNDING;
    if (!keeps_denormals())
        return SPRING_EFLUSHED;
    if (!rounds_products())
        return SPRING_EFUSED;
    for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
        const spring_method m = spring_method_at(place);
        if (spring_method_describe(m)->springs && spring_digest_of_method(m) != spring_expected_digest(m))
            return SPRING_EBITS;
    }
    return SPRING_OK;
}
