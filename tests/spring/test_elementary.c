/* SPDX-License-Identifier: MIT */
/* The functions of src/simd/elementary_tmpl.h, and powers that do not fit into a double, compared with multiple precision.
   Only for single numbers; tests of batches check that vectors are bit-identical. */
#include <math.h>
#include <stdio.h>

#include <mpfr.h>

#include "spring/exact_formula_tmpl.h"

#include "check.h"

enum { draws = 200000 };

static mpfr_t x, want, part;

/* |got - want| in units of the last place of want. */
static double error_in_ulp(double got)
{
    const double rounded = mpfr_get_d(want, MPFR_RNDN);
    const int exponent = rounded == 0 ? -1021 : ilogb(rounded);
    mpfr_sub_d(part, want, got, MPFR_RNDN);
    return ldexp(fabs(mpfr_get_d(part, MPFR_RNDN)), (DBL_MANT_DIG - 1) - (exponent < -1022 ? -1022 : exponent));
}

/* Somewhere, or a little off an odd multiple of `step`, where the nearest even one changes; of both signs. */
static double argument(double step, double largest)
{
    const double sign = random_bits() % 2 ? 1 : -1;
    switch (random_bits() % 4) {
    case 0:
        return sign * random_uniform(0, largest);
    case 1:
        return sign * random_log(1e-30, largest);
    default:
        return sign * step * (1 + 2 * floor(random_uniform(0, largest / step / 2))) *
               (1 + (random_bits() % 2 ? 1 : -1) * random_log(1e-17, 1e-3));
    }
}

/* e^x as far as doubles go, and beyond: as a product of two. */
static void powers_of_e(void)
{
    double worst = 0;
    for (int i = 0; i < draws; i++) {
        const double a = argument(0.34657359027997264, i % 2 ? 700 : 1);
        const exact_halves got = exact_halves_of(a);
        mpfr_set_d(x, a, MPFR_RNDN);
        mpfr_exp(want, x, MPFR_RNDN);
        worst = fmax(worst, error_in_ulp(got.half * got.other));
    }
    printf("# e^x: largest error %.3f ulp\n", worst);
    CHECK_BELOW(worst, 1.1, "half an ulp of the sum, a quarter of what is left of x, three roundings of e");
    for (int i = 0; i < 10000; i++) {
        const double a = random_uniform(-1480, 1480), far = a > 0 ? 0x1p-1000 : 0x1p1000;
        const exact_halves got = exact_halves_of(a);
        mpfr_set_d(x, a, MPFR_RNDN);
        mpfr_exp(want, x, MPFR_RNDN);
        mpfr_mul_d(want, want, far, MPFR_RNDN);
        if (mpfr_get_exp(want) < 1023 && mpfr_get_exp(want) > -1000)
            CHECK_BELOW(error_in_ulp(far * got.other * got.half), 1.6, "as above, and once more rounded");
    }
    const exact_halves none = exact_halves_of(-INFINITY), all = exact_halves_of(INFINITY), nan = exact_halves_of(NAN);
    CHECK_BITS(DBL_MAX * none.other * none.half, 0, "nothing is left of any number");
    CHECK_BITS(0x1p-1074 * all.other * all.half, INFINITY, "any number overflows");
    CHECK(isnan(nan.other * nan.half), "NaN");
}

/* e^x and 1 - e^x of what has decayed. */
static void decays(void)
{
    double worst_left = 0, worst_lost = 0;
    for (int i = 0; i < draws; i++) {
        const double a = -fabs(argument(0.34657359027997264, i % 2 ? 700 : 1));
        const exact_decay got = exact_decay_of(a);
        mpfr_set_d(x, a, MPFR_RNDN);
        mpfr_exp(want, x, MPFR_RNDN);
        worst_left = fmax(worst_left, error_in_ulp(got.left));
        mpfr_expm1(want, x, MPFR_RNDN);
        mpfr_neg(want, want, MPFR_RNDN);
        worst_lost = fmax(worst_lost, error_in_ulp(got.lost));
    }
    printf("# decays: largest error %.3f ulp of e^x, %.3f ulp of 1 - e^x\n", worst_left, worst_lost);
    CHECK_BELOW(worst_left, 1.1, "as e^x");
    CHECK_BELOW(worst_lost, 1.6, "near x = -0.35 the sum of 1/2 and 1/4 is less than either");
    for (int i = 0; i < 10000; i++) { /* down to the least number there is, and beyond */
        const double a = -random_uniform(700, 800);
        const exact_decay got = exact_decay_of(a);
        mpfr_set_d(x, a, MPFR_RNDN);
        mpfr_exp(want, x, MPFR_RNDN);
        CHECK_BELOW(error_in_ulp(got.left), 2, "denormal: rounded twice");
        CHECK_BITS(got.lost, 1, "all of it");
    }
    CHECK_BITS(exact_decay_of(-INFINITY).left, 0, "nothing is left");
    CHECK_BITS(exact_decay_of(0).left, 1, "nothing is lost");
    CHECK_BITS(fabs(exact_decay_of(0).lost), 0, "nothing is lost");
}

/* Near the zeros of sine and cosine an error of the angle is all there is; the bound grows with it. */
static double beyond_angle(double got, double angle, double share)
{
    const double rounded = mpfr_get_d(want, MPFR_RNDN);
    return error_in_ulp(got) - share * fabs(angle) / ldexp(1, ilogb(rounded) - (DBL_MANT_DIG - 1));
}

static double worst_of_angles(double largest, double share)
{
    double worst = 0;
    for (int i = 0; i < draws; i++) {
        const double a = argument(i % 2 ? 0.78539816339744828 : 1.5707963267948966, i % 3 ? largest : 10);
        const sine_cosine got = sine_cosine_of(a);
        mpfr_set_d(x, a, MPFR_RNDN);
        mpfr_sin(want, x, MPFR_RNDN);
        worst = fmax(worst, beyond_angle(got.sine, a, share));
        mpfr_cos(want, x, MPFR_RNDN);
        worst = fmax(worst, beyond_angle(got.cosine, a, share));
    }
    return worst;
}

static void angles(void)
{
    const double near = worst_of_angles(1e8, 1e-25), far = worst_of_angles(0x1p51 / 1.01, 0.51 * DBL_EPSILON);
    printf("# sine and cosine: largest error %.3f ulp to 10^8, %.3f ulp besides half an eps of the angle to 2^51\n",
           near, far);
    CHECK_BELOW(near, 1.5,
                "half an ulp of the last sum, another of what is left of the angle: of half as large a sine");
    CHECK_BELOW(far, 1.5, "and a multiple of the first part of pi/2 is rounded by half an ulp of the angle");
    for (int i = 0; i < 100000; i++) {
        const sine_cosine any = sine_cosine_of(random_log(0x1p50, DBL_MAX));
        CHECK_BELOW(fabs(any.sine), 1, "a sine, of whatever angle");
        CHECK_BELOW(fabs(any.cosine), 1, "a cosine");
    }
    CHECK(isnan(sine_cosine_of(INFINITY).sine) && isnan(sine_cosine_of(NAN).cosine), "no angle");
    CHECK_BITS(sine_cosine_of(0).sine, 0, "exact");
    CHECK_BITS(sine_cosine_of(0).cosine, 1, "exact");
}

static void errors_of_products(void)
{
    for (int i = 0; i < 100000; i++) {
        const double a = random_uniform(-1, 1) * random_log(0x1p-450, 0x1p450);
        const double b = random_uniform(-1, 1) * random_log(0x1p-450, 0x1p450), product = a * b, square = a * a;
        mpfr_set_d(want, a, MPFR_RNDN);
        mpfr_mul_d(want, want, b, MPFR_RNDN);
        mpfr_sub_d(want, want, product, MPFR_RNDN);
        CHECK_BITS(product_error(a, b, product) + 0.0, mpfr_get_d(want, MPFR_RNDN) + 0.0, "exactly");
        mpfr_set_d(want, a, MPFR_RNDN);
        mpfr_mul_d(want, want, a, MPFR_RNDN);
        mpfr_sub_d(want, want, square, MPFR_RNDN);
        CHECK_BITS(square_error(a, square) + 0.0, mpfr_get_d(want, MPFR_RNDN) + 0.0, "exactly");
    }
}

static void powers_of_two(void)
{
    for (int k = -1086; k <= 1086; k++)
        CHECK_BITS(power_of_two(k), ldexp(1, k), "exact");
}

/* What is in range is tested with what uses it. */
static void ends_of_hypot(void)
{
    CHECK_BITS(spring_hypot(0, 0), 0, "nothing to divide by");
    CHECK_BITS(spring_hypot(3e300, 4e300), 5e300, "squares beyond the range");
    CHECK_BITS(spring_hypot(3, INFINITY), INFINITY, "one is infinite");
    CHECK_BITS(spring_hypot(INFINITY, INFINITY), INFINITY, "both are");
}

int main(void)
{
    static const test tests[] = {
        {"e^x", powers_of_e},
        {"decays", decays},
        {"sine and cosine", angles},
        {"errors of products", errors_of_products},
        {"powers of two", powers_of_two},
        {"ends of hypot", ends_of_hypot},
    };
    mpfr_inits2(256, x, want, part, (mpfr_ptr)NULL);
    const int status = RUN_TESTS("elementary", tests);
    mpfr_clears(x, want, part, (mpfr_ptr)NULL);
    mpfr_free_cache();
    return status;
}
