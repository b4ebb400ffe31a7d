/* SPDX-License-Identifier: MIT */
/* The inverse square root of the kernels of scenes: its accuracy, and bit-identical results in every lane of every
   vector. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "simd/targets.h"

#ifdef SPRING_FLOAT
typedef float scalar;
#define MANTISSA FLT_MANT_DIG
#define LEAST    FLT_TRUE_MIN
#define LARGEST  FLT_MAX
#else
typedef double scalar;
#define MANTISSA DBL_MANT_DIG
#define LEAST    DBL_TRUE_MIN
#define LARGEST  DBL_MAX
#endif

typedef void inverse_sqrt_fn(scalar *a, const int8_t *where, size_t count);
extern inverse_sqrt_fn inverse_sqrt_plain, inverse_sqrt_v128, inverse_sqrt_v256, inverse_sqrt_v512;

enum { vector_count = 3, block = 1024 };

/* By ascending length; NULL: this processor lacks the instructions. */
static inverse_sqrt_fn *in_vectors(int i)
{
#if SPRING_LONG_VECTORS
    if (i == 1)
        return __builtin_cpu_supports("avx2") ? inverse_sqrt_v256 : NULL;
    if (i == 2)
        return __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") ? inverse_sqrt_v512 : NULL;
#endif
    return i == 0 ? inverse_sqrt_v128 : NULL;
}

/* |y sqrt(a) - 1| in units of y's last place. Powers of four are taken out of a, then 1 - a y^2 is formed with the
   errors of its products: 1/sqrt(a) is y (1 + r/2 + ...). */
static double error_in_ulp(scalar a, scalar y)
{
    int exponent, own;
    double square = frexp((double)a, &exponent);
    if (exponent % 2 != 0) {
        square *= 2;
        exponent--;
    }
    const double root = ldexp((double)y, exponent / 2), y2 = root * root, y2_error = fma(root, root, -y2);
    const double product = square * y2, product_error = fma(square, y2, -product);
    const double r = (1 - product) - product_error - square * y2_error;
    return ldexp(fabs(frexp(root, &own) * (r / 2 + 3 * r * r / 8)), MANTISSA);
}

/* The range in which a seed in float will do. */
static bool by_seed(scalar a)
{
#ifdef SPRING_FLOAT
    (void)a;
    return false;
#else
    return a >= 0x1p-84 && a < 0x1p44;
#endif
}

static scalar any_square(unsigned kind)
{
    const double log_least = log(LEAST), log_largest = log(LARGEST);
    static const double ends[] = {0x1p-84, 0x1p44, 0x1p-126, 0x1p127, 0x1p-1022, LEAST, LARGEST, 1, 4};
    scalar end = (scalar)ends[random_bits() % (sizeof ends / sizeof ends[0])];
    switch (kind % 5) {
    case 0:
        return (scalar)exp(random_uniform(log_least, log_largest));
    case 1:
        return (scalar)ldexp(random_uniform(1, 2), (int)(random_bits() % 132) - 86); /* where the quotient begins */
    case 2:
        return (scalar)ldexp(random_uniform(1, 4), 2 * (int)(random_bits() % 60) - 82);
    case 3: /* the ends of ranges, and a few ulp beyond */
        for (uint64_t ulps = random_bits() % 20, up = random_bits() % 2; ulps > 0; ulps--) {
            const double to = up ? (double)LARGEST : 0;
            end = (scalar)(sizeof(scalar) == 4 ? nextafterf((float)end, (float)to) : nextafter((double)end, to));
        }
        return end;
    default:
        return (scalar)ldexp(random_uniform(1, 1.01), 2 * (int)(random_bits() % 60) - 82); /* the worst */
    }
}

/* Each block by itself and, every second one, with squares next to it that are not read, or are rare. */
static void fill(scalar *a, int8_t *where, bool mixed)
{
    static const scalar rare[] = {0, LEAST, LARGEST, INFINITY, NAN, -NAN};
    for (size_t i = 0; i < block; i++) {
        a[i] = any_square((unsigned)random_bits());
        where[i] = -1;
        if (mixed && random_bits() % 8 == 0) {
            where[i] = random_bits() % 2 ? -1 : 0;
            a[i] = rare[random_bits() % (where[i] ? 4 : sizeof rare / sizeof rare[0])];
        }
    }
}

/* The error, and the same bits in every vector. */
static void accuracy(void)
{
    static scalar a[block], plain[block], vectors[block];
    static int8_t where[block];
    double worst_seed = 0, worst_quotient = 0;
    size_t differ = 0, inexact = 0;
    const int blocks = 10000; /* so 10^7 squares */
    for (int b = 0; b < blocks; b++) {
        fill(a, where, b % 2 != 0);
        memcpy(plain, a, sizeof a);
        inverse_sqrt_plain(plain, where, block);
        for (size_t i = 0; i < block; i++) {
            if (where[i] == 0)
                continue;
            inexact += a[i] == 0 && plain[i] != 0;
            double *const worst = by_seed(a[i]) ? &worst_seed : &worst_quotient;
            if (a[i] > 0)
                *worst = fmax(*worst, error_in_ulp(a[i], plain[i]));
        }
        for (int k = 0; k < vector_count; k++) {
            if (in_vectors(k) == NULL)
                continue;
            memcpy(vectors, a, sizeof a);
            in_vectors(k)(vectors, where, block);
            for (size_t i = 0; i < block; i++)
                differ += where[i] != 0 && memcmp(&vectors[i], &plain[i], sizeof plain[i]) != 0;
        }
    }
    CHECK(differ == 0, "lane by lane the same operations, whatever is next to it");
    CHECK(inexact == 0, "0 for 0");
    printf("# largest error %.4f ulp by a seed, %.4f ulp by a quotient\n", worst_seed, worst_quotient);
    CHECK_BELOW(worst_seed, 1.0001, "half an ulp of the sum, as much of a y^2, what is left out");
    CHECK_BELOW(worst_quotient, 1.5, "half an ulp of the quotient, one of the root below it");
}

int main(void)
{
    static const test tests[] = {
        {"accuracy, and lanes for themselves", accuracy},
    };
    return RUN_TESTS("inverse-sqrt", tests);
}
