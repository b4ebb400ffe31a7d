/* SPDX-License-Identifier: MIT */
/* The error of the steps of a method on a spring, and the steps for a given error; see accuracy.c. */
#ifndef SPRINGSTEP_ACCURACY_H
#define SPRINGSTEP_ACCURACY_H

#include "../methods/step_matrix.h"

/* A spring, a method and a duration T, without units. */
typedef struct accuracy {
    step_terms_fn *terms;
    int order;
    step_rates whole; /* the rates of one step that is as long as T */
} accuracy;

/* E after n steps of T/steps. Infinite if it overflows, and for more than 2^53 steps. */
SPRING_INTERNAL double spring_error_of(const accuracy *of, double steps, double n);

/* The least number of steps such that, for it and for every larger number n, E of n steps of T/n is at most the
   tolerance; above 8192, up to one part in 8192 more. Infinite if rounding errors exceed the tolerance first, and if it
   is more than 2^53. */
SPRING_INTERNAL double spring_accurate_steps(const accuracy *of, double tolerance);

#endif
