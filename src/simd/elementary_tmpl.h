/* SPDX-License-Identifier: MIT */
/*
 * Functions of the exact solution besides + - * / and sqrt: the error of a product, powers of two, e^x, sine and
 * cosine. They use `real`, in double, with multiplications, additions, integer operations and exact scalings alone. So
 * results are bit-identical in every lane, and with every compiler, processor and C library.
 *
 * Method    The nearest multiple of ln 2, or of pi/2, is subtracted from the argument in two parts. The first part has
 *           few bits, so its multiples are exact, and the remainder has the error of the second part alone. The
 *           function of the remainder is Taylor's polynomial about 0, by Horner's rule: its coefficients are well
 *           known, and it needs one or two terms more than the best polynomial.
 * Special   NaN and infinite angles give NaN. e^x of an infinite x is 0, or infinite.
 * Accuracy  e^x 1.1 ulp, 1 - e^x 1.6 ulp, sine and cosine 1.5 ulp and, of angles beyond 10^8, half an eps of the angle
 *           (tests/spring/test_elementary.c)
 * Source    Dekker, A floating-point technique for extending the available precision, Numer. Math. 18 (1971): products;
 *           Cody, Waite, Software Manual for the Elementary Functions (1980): reductions
 */
#ifndef SPRINGSTEP_ELEMENTARY_TMPL_H
#define SPRINGSTEP_ELEMENTARY_TMPL_H

#include "real_tmpl.h"

#ifndef SPRING_FLOAT

/* a = high + low, halves of 26 bits, so that products of halves are exact. For numbers below 2^990. */
typedef struct halves {
    real high, low;
} halves;

SPRING_INLINE halves halves_of(real a)
{
    const real c = (scalar)(0x1p27 + 1) * a, high = c - (c - a);
    return (halves){high, a - high};
}

/* a b - product, where product is a b rounded, and a^2 - square. Both are exact for numbers of 2^-450 ... 2^450. */
SPRING_INLINE real product_error(real a, real b, real product)
{
    const halves x = halves_of(a), y = halves_of(b);
    return ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low;
}

SPRING_INLINE real square_error(real a, real square)
{
    const halves x = halves_of(a);
    return ((x.high * x.high - square) + x.high * (2 * x.low)) + x.low * x.low;
}

/* Added to a number of less than 2^51, this leaves the nearest integer in the lowest bits. */
static const scalar to_integer = 0x1.8p52;

SPRING_INLINE real nearest(real a)
{
    return (a + to_integer) - to_integer;
}

/* 2^k of an integer k, |k| < 1087, including infinite and denormal results. */
SPRING_INLINE real power_of_two(real k)
{
    real shift = splat(0), back = splat(1);
    if (SPRING_UNLIKELY(any(vec_abs(k) > 1022))) {
        shift = select_real(k < 0, splat(64), splat(-64));
        back = select_real(k < 0, splat(0x1p-64), splat(0x1p64));
    }
    return from_bits(to_bits(k + shift + (to_integer + 1023)) << 52) * back;
}

/* c[0] + c[1] z + ..., an even number of terms. Horner's rule runs separately for even and odd powers, so that their
   latencies overlap. */
SPRING_INLINE real polynomial(real z, const scalar *c, int terms)
{
    const real square = z * z;
    real even = splat(c[terms - 2]), odd = splat(c[terms - 1]);
    SPRING_UNROLL
    for (int i = terms - 4; i >= 0; i -= 2) {
        even = even * square + c[i];
        odd = odd * square + c[i + 1];
    }
    return even + odd * z;
}

/* e^x = 2^k (1 + e), |e| < 0.42 */
typedef struct exponential {
    real k, e;
} exponential;

/* |x| <= 1500, which covers the range of double, for e^x and its inverse. */
SPRING_INLINE exponential exponential_of(real x)
{
    /* (e^r - 1 - r)/r^2; the first omitted term is 4e-18 of e^r */
    static const scalar c[] = {1. / 2,     1. / 6,      1. / 24,      1. / 120,      1. / 720,       1. / 5040,
                               1. / 40320, 1. / 362880, 1. / 3628800, 1. / 39916800, 1. / 479001600, 1. / 6227020800};
    const scalar log2_e = 0x1.71547652b82fep+0, ln2_high = 0x1.62e42ffp-1, ln2_low = -0x1.718432a1b0e26p-35;
    const real k = nearest(x * log2_e), r = (x - k * ln2_high) - k * ln2_low;
    return (exponential){k, r + r * r * polynomial(r, c, 12)};
}

typedef struct sine_cosine {
    real sine, cosine;
} sine_cosine;

SPRING_INLINE sine_cosine sine_cosine_of(real angle)
{
    /* (sin r - r)/r^3 and (cos r - 1 + r^2/2)/r^4; the first omitted terms are 8e-20 of r, 4e-21 */
    static const scalar odd[] = {-1. / 6,        1. / 120,        -1. / 5040,          1. / 362880,
                                 -1. / 39916800, 1. / 6227020800, -1. / 1307674368000, 1. / 355687428096000};
    static const scalar even[] = {1. / 24,        -1. / 720,         1. / 40320,          -1. / 3628800,
                                  1. / 479001600, -1. / 87178291200, 1. / 20922789888000, -1. / 6402373705728000};
    const scalar two_over_pi = 0x1.45f306dc9c883p-1, half_pi_high = 0x1.921fb54p+0, half_pi_low = 0x1.10b4611a62633p-30;
    /* Larger angles have an error of more than a turn, so 0 is as good. */
    const real valid = select_real(vec_abs(angle) < 0x1p51, angle, angle - angle);
    const real quarter = valid * two_over_pi + to_integer, q = quarter - to_integer;
    const real r = (valid - q * half_pi_high) - q * half_pi_low, z = r * r;
    const real sine = r + r * z * polynomial(z, odd, 8);
    const real leading = 1 - z / 2; /* its rounding error is added below */
    const real cosine = leading + (((1 - leading) - z / 2) + z * z * polynomial(z, even, 8));
    const real_bits turn = to_bits(quarter);
    const lane_mask odd_turn = (turn & 1) != 0;
    const real_bits minus_sine = (turn & 2) << 62, minus_cosine = ((turn + 1) & 2) << 62;
    return (sine_cosine){from_bits(to_bits(select_real(odd_turn, cosine, sine)) ^ minus_sine),
                         from_bits(to_bits(select_real(odd_turn, sine, cosine)) ^ minus_cosine)};
}

#endif

#endif
