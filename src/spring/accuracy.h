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

/* E of n steps of T/steps. Infinite where it overflows, and of more than 2^53 steps. */
SPRING_INTERNAL double spring_error_of(const accuracy *of, double steps, double n);

/* The least number n of steps of T/n with E at most the tolerance, for it and for all that are larger; above 8192 up to one
   part in 8192 more. Infinite where rounding exceeds the tolerance before, and where it is more than 2^53. */
SPRING_INTERNAL double spring_accurate_steps(const accuracy *of, double tolerance);

#endif
