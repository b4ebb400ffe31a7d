/* SPDX-License-Identifier: MIT */
/*
 * The theoretical position error of any method, without rounding, from steps in multiple precision. The spring is the
 * ideal one of the original study: m = k = 1, from 1 m at rest, so the exact position after H seconds is cos H.
 */
#ifndef SPRINGSTEP_EQUAL_ERROR_H
#define SPRINGSTEP_EQUAL_ERROR_H

#include <springstep/spring.h>

/** The constant C [m] of the leading term C n^-order of the error after n steps over the duration. */
double error_coefficient(spring_method m, double duration);

/** The least n from which the error after duration [s] never exceeds error [m] < 2. For durations above 10^5 s, only
    steps of at most 1 s are considered. Not for the exact solution. Exits with CLI_FAILED if the rounding error is as
    large as the error. */
uint64_t equal_error_steps(spring_method m, double duration, double error);

/** The least n whose error does not exceed `error`; larger n may exceed it again. 0 for durations above 10^5 s, for
    which it is not computed. */
uint64_t equal_error_first_steps(spring_method m, double duration, double error);

#endif
