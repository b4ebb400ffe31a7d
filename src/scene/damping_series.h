/* SPDX-License-Identifier: MIT */
/* The series of an exponential kick: see exponential_kick.h. */
#ifndef SPRINGSTEP_DAMPING_SERIES_H
#define SPRINGSTEP_DAMPING_SERIES_H

#include "../simd/arithmetic.h"

/* The largest h G. Beyond, the damping of each link saturates: see spring_scene_find_roots(). */
static const double most_damping = 3e4;

typedef struct damping_series {
    unsigned terms;           /* s; 0: links are damped explicitly */
    double rho;               /* the following are for s > 2 */
    double last, beyond_last; /* I_s and I_{s+1}, divided by I_0 */
    double weight[3];         /* f */
} damping_series;

/* The coefficients of term k, and what those of term k - 1 follow from. */
typedef struct series_term {
    unsigned k;
    double above, here; /* I_{k+1} and I_k */
    double c, d, e;
    double sum_c, sums_c, sum_d, sums_d; /* of terms k + 1 ... s, and of such sums */
} series_term;

/* The series for steps whose h G is `reach`, 0 <= reach <= most_damping. */
SPRING_INTERNAL damping_series spring_damping_series(double reach);

/* The coefficients of term s, then those of term k - 1. */
SPRING_INTERNAL series_term spring_last_term(const damping_series *p);
SPRING_INTERNAL void spring_previous_term(const damping_series *p, series_term *t);

#endif
