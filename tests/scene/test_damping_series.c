/* SPDX-License-Identifier: MIT */
/* The series of an exponential kick: its coefficients in multiple precision, and the conditions of its stability. */
#include <math.h>
#include <mpfr.h>
#include <stdio.h>

#include "check.h"
#include "scene/exponential_kick.h"

enum { most_terms = 300, bits = 400 };

typedef struct coefficients {
    unsigned terms;
    double rho, c[most_terms], d[most_terms], e[most_terms];
} coefficients;

static coefficients coefficients_of(double reach)
{
    const damping_series p = spring_damping_series(reach);
    coefficients all = {.terms = p.terms, .rho = p.rho};
    CHECK(p.terms > 2 && p.terms < most_terms, "a series");
    for (series_term t = spring_last_term(&p);; spring_previous_term(&p, &t)) {
        all.c[t.k] = t.c;
        all.d[t.k] = t.d;
        all.e[t.k] = t.e;
        if (t.k == 0)
            return all;
    }
}

/* ------------------------------------------------------------------------------------------------ multiple precision */

/* I_k(rho) by its power series, whose terms are all positive. */
static void bessel(mpfr_t sum, double rho, unsigned k)
{
    mpfr_t term, half;
    mpfr_inits2(bits, term, half, (mpfr_ptr)0);
    mpfr_set_d(half, rho / 2, MPFR_RNDN);
    mpfr_set_ui(term, 1, MPFR_RNDN);
    for (unsigned i = 1; i <= k; i++) {
        mpfr_mul(term, term, half, MPFR_RNDN);
        mpfr_div_ui(term, term, i, MPFR_RNDN);
    }
    mpfr_set(sum, term, MPFR_RNDN);
    mpfr_sqr(half, half, MPFR_RNDN);
    for (unsigned i = 1; i < 20 + 2 * (unsigned)rho; i++) {
        mpfr_mul(term, term, half, MPFR_RNDN);
        mpfr_div_ui(term, term, i, MPFR_RNDN);
        mpfr_div_ui(term, term, i + k, MPFR_RNDN);
        mpfr_add(sum, sum, term, MPFR_RNDN);
    }
    mpfr_clears(term, half, (mpfr_ptr)0);
}

/* Solves the 3 x 3 system by elimination. */
static void solve(mpfr_t a[3][4], mpfr_t factor, mpfr_t product)
{
    for (int i = 0; i < 3; i++)
        for (int r = 0; r < 3; r++) {
            if (r == i)
                continue;
            mpfr_div(factor, a[r][i], a[i][i], MPFR_RNDN);
            for (int j = i; j < 4; j++) {
                mpfr_mul(product, factor, a[i][j], MPFR_RNDN);
                mpfr_sub(a[r][j], a[r][j], product, MPFR_RNDN);
            }
        }
    for (int i = 0; i < 3; i++)
        mpfr_div(a[i][3], a[i][3], a[i][i], MPFR_RNDN);
}

static void in_multiple_precision(void)
{
    static const double reaches[] = {0.61, 1, 3, 3.2, 10, 100, 900};
    static mpfr_t c[most_terms], d[most_terms];
    mpfr_t a[3][4], t, u, e;
    mpfr_inits2(bits, t, u, e, (mpfr_ptr)0);
    for (int i = 0; i < 12; i++)
        mpfr_init2(a[i / 4][i % 4], bits);
    for (int i = 0; i < most_terms; i++)
        mpfr_inits2(bits, c[i], d[i], (mpfr_ptr)0);
    for (size_t i = 0; i < sizeof reaches / sizeof reaches[0]; i++) {
        const coefficients got = coefficients_of(reaches[i]);
        const unsigned s = got.terms;
        for (int j = 0; j < 12; j++)
            mpfr_set_ui(a[j / 4][j % 4], 0, MPFR_RNDN);
        for (unsigned k = 0; k <= s; k++) {
            bessel(c[k], got.rho, k);
            mpfr_mul_ui(t, c[k], k > 0 ? 2 : 1, MPFR_RNDN);
            for (int power = 0; power < 5; power++) { /* the moments of K = k^2/rho */
                for (int r = 0; r < 3; r++)
                    if (power - r >= 0 && power - r < 3)
                        mpfr_add(a[r][power - r], a[r][power - r], t, MPFR_RNDN);
                mpfr_mul_ui(t, t, k * k, MPFR_RNDN);
                mpfr_div_d(t, t, got.rho, MPFR_RNDN);
            }
        }
        mpfr_set_ui(a[0][3], 1, MPFR_RNDN);
        mpfr_set_ui(a[1][3], 1, MPFR_RNDN);
        mpfr_set_ui(a[2][3], 1, MPFR_RNDN);
        mpfr_div_d(a[2][3], a[2][3], got.rho, MPFR_RNDN);
        mpfr_add_ui(a[2][3], a[2][3], 3, MPFR_RNDN);
        solve(a, t, u);
        for (unsigned k = 0; k <= s; k++) {
            mpfr_set_ui(t, k * k, MPFR_RNDN);
            mpfr_div_d(t, t, got.rho, MPFR_RNDN);
            mpfr_mul(u, a[2][3], t, MPFR_RNDN);
            mpfr_add(u, u, a[1][3], MPFR_RNDN);
            mpfr_mul(u, u, t, MPFR_RNDN);
            mpfr_add(u, u, a[0][3], MPFR_RNDN);
            mpfr_mul(c[k], c[k], u, MPFR_RNDN);
        }
        /* The weights of the smallest reaches lose digits in the 3 x 3 system, so errors are relative to the largest. */
        const double bound = 10 * s * DBL_EPSILON * (1 + 30 / reaches[i] / reaches[i]);
        for (unsigned k = 0; k <= s; k++) {
            CHECK_CLOSE(got.c[k], mpfr_get_d(c[k], MPFR_RNDN), bound, "a recurrence and the moments");
            mpfr_set_ui(d[k], 0, MPFR_RNDN);
            for (unsigned j = k + 1; j <= s; j++) {
                mpfr_mul_ui(t, c[j], j - k, MPFR_RNDN);
                mpfr_add(d[k], d[k], t, MPFR_RNDN);
            }
            mpfr_mul_ui(d[k], d[k], 4, MPFR_RNDN);
            mpfr_div_d(d[k], d[k], got.rho, MPFR_RNDN);
            CHECK_CLOSE(got.d[k], mpfr_get_d(d[k], MPFR_RNDN), bound, "two sums");
        }
        for (unsigned k = 0; k <= s; k++) {
            mpfr_set_ui(e, 0, MPFR_RNDN);
            for (unsigned j = k + 1; j <= s; j++) {
                mpfr_mul_ui(t, d[j], j - k, MPFR_RNDN);
                mpfr_add(e, e, t, MPFR_RNDN);
            }
            mpfr_mul_ui(e, e, 2, MPFR_RNDN);
            mpfr_div_d(e, e, got.rho, MPFR_RNDN);
            CHECK_CLOSE(got.e[k], mpfr_get_d(e, MPFR_RNDN), bound, "two more");
        }
    }
    mpfr_clears(t, u, e, (mpfr_ptr)0);
    for (int i = 0; i < 12; i++)
        mpfr_clear(a[i / 4][i % 4]);
    for (int i = 0; i < most_terms; i++)
        mpfr_clears(c[i], d[i], (mpfr_ptr)0);
}

/* -------------------------------------------------------------------------------------------------------- stability */

static double p_at(const coefficients *s, double y)
{
    double b1 = 0, b2 = 0;
    for (unsigned k = s->terms - 1; k > 0; k--) {
        const double b = s->d[k] + 2 * y * b1 - b2;
        b2 = b1;
        b1 = b;
    }
    return s->d[0] / 2 + y * b1 - b2;
}

/* From hG = 0.6 to the largest. Below, p = 1 - z/2, and p (1 + z/2) = 1 - z^2/4. */
static void scan(void)
{
    double worst = -1, least = 1;
    int count = 0;
    for (double reach = 0.6000001; reach <= most_damping; reach *= 1.003, count++) {
        const coefficients s = coefficients_of(reach);
        for (unsigned k = 0; k <= s.terms; k++)
            CHECK(s.c[k] >= 0, "a positive series");
        CHECK(2 * s.rho >= reach, "the spectrum lies in the interval");
        const int points = 6 * (int)s.terms;
        for (int i = 0; i <= points; i++) {
            const double y = cos(3.141592653589793 * i / points), z = s.rho * (1 - y), p = p_at(&s, y);
            worst = fmax(worst, p * (1 + z / 2) - 1);
            least = fmin(least, p);
        }
    }
    printf("# %d series: p (1 + z/2) - 1 at most %.1e, p at least %.1e\n", count, worst, least);
    CHECK_BELOW(worst, 1e-12, "the energy of the proof is positive");
    CHECK(least > 0, "damping takes energy");
    const coefficients largest = coefficients_of(most_damping);
    CHECK(largest.terms == 280, "as scene.h says: 279 evaluations");
}

int main(void)
{
    static const test tests[] = {
        {"multiple precision", in_multiple_precision},
        {"conditions of stability", scan},
    };
    return RUN_TESTS("damping_series", tests);
}
