/* SPDX-License-Identifier: MIT */
/*
 * What theory says of the error in position of any method, on the ideal spring of the original study: m = k = 1, from 1
 * m at rest, so that the exact position after H seconds is cos H. From the multiple-precision iterate, without
 * rounding.
 */
#ifndef SPRINGSTEP_EQUAL_ERROR_H
#define SPRINGSTEP_EQUAL_ERROR_H

#include <springstep/spring.h>

/** C of the leading term C n^-order of the error in n steps over the duration [m]. */
double error_coefficient(spring_method m, double duration);

/** The smallest n from which on the error after duration [s] never exceeds error [m] < 2, among steps of at most 1 s
    where that is more than 10^5 s; not for the exact solution. Exits with CLI_FAILED if rounding is of that size. */
uint64_t equal_error_steps(spring_method m, double duration, double error);

/** The smallest n whose error happens not to exceed it; it may do so again beyond. 0: not looked for, where the
    duration is longer. */
uint64_t equal_error_first_steps(spring_method m, double duration, double error);

#endif
