/* SPDX-License-Identifier: MIT */
/* The series of an exponential kick: exponential_kick.h has its formulas. */
#include "damping_series.h"

#include <math.h>

#include "../simd/size_begin.h"

/* One step of the recurrence I_{k-1} = I_{k+1} + 2 k/rho I_k, downwards. */
static void bessel_step(double rho, unsigned k, double *above, double *here)
{
    const double below = *above + 2 * k / rho * *here;
    *above = *here;
    *here = below;
}

/* Solves the symmetric system for the weights f, which make the moments of q = k^2/rho over c_-s ... c_s equal to those
   of e^-z: 1, 1 and 3 + 1/rho. m: the moments of I_k. */
static void solve_moments(const double m[5], double rho, double weight[3])
{
    const double right[3] = {1, 1, 3 + 1 / rho};
    const double c00 = m[2] * m[4] - m[3] * m[3], c01 = m[2] * m[3] - m[1] * m[4], c02 = m[1] * m[3] - m[2] * m[2],
                 c11 = m[0] * m[4] - m[2] * m[2], c12 = m[1] * m[2] - m[0] * m[3], c22 = m[0] * m[2] - m[1] * m[1];
    const double determinant = m[0] * c00 + m[1] * c01 + m[2] * c02;
    weight[0] = (c00 * right[0] + c01 * right[1] + c02 * right[2]) / determinant;
    weight[1] = (c01 * right[0] + c11 * right[1] + c12 * right[2]) / determinant;
    weight[2] = (c02 * right[0] + c12 * right[1] + c22 * right[2]) / determinant;
}

damping_series spring_damping_series(double reach)
{
    if (reach <= 0.6)
        return (damping_series){.terms = 2};
    const double rho = reach * 0.5 * (1 + 0x1p-10); /* a little more, for rounding errors of the bound */
    const unsigned wanted = (unsigned)ceil(spring_sqrt(2.6 * reach + 1)), terms = wanted < 3 ? 3 : wanted;
    const unsigned from = 20 + (unsigned)(10 * spring_sqrt(rho)), start = from > terms + 10 ? from : terms + 10;
    double above = 0, here = 1e-30; /* I_start < 1e-21 I_0 */
    damping_series p = {.terms = terms, .rho = rho};
    double moment[5] = {0};
    for (unsigned k = start; k + 1 > 0; k--) {
        if (k == terms) {
            p.last = here;
            p.beyond_last = above;
        }
        double term = k <= terms ? (k > 0 ? 2 * here : here) : 0;
        for (int j = 0; j < 5; j++) {
            moment[j] += term;
            term *= (double)k * k / rho;
        }
        if (k > 0)
            bessel_step(rho, k, &above, &here);
    }
    /* in units of I_0 */
    p.last /= here;
    p.beyond_last /= here;
    for (int j = 0; j < 5; j++)
        moment[j] /= here;
    solve_moments(moment, rho, p.weight);
    return p;
}

static void find_series_term(const damping_series *p, series_term *t)
{
    const double q = (double)t->k * t->k / p->rho;
    t->c = t->here * (p->weight[0] + q * (p->weight[1] + q * p->weight[2]));
    t->d = 4 / p->rho * t->sums_c;
    t->e = 2 / p->rho * t->sums_d;
}

series_term spring_last_term(const damping_series *p)
{
    series_term t = {.k = p->terms, .above = p->beyond_last, .here = p->last};
    find_series_term(p, &t);
    return t;
}

void spring_previous_term(const damping_series *p, series_term *t)
{
    t->sum_c += t->c;
    t->sums_c += t->sum_c;
    t->sum_d += t->d;
    t->sums_d += t->sum_d;
    bessel_step(p->rho, t->k--, &t->above, &t->here);
    find_series_term(p, t);
}

#include "../simd/size_end.h"
