/* SPDX-License-Identifier: MIT */
/* How many steps a method needs for a given error, on the ideal spring of the seed study (m = k = 1, from 1 m at rest). */
#ifndef SPRINGSTEP_EQUAL_ERROR_H
#define SPRINGSTEP_EQUAL_ERROR_H

#include <springstep/spring.h>

/** The smallest n from which on the error in position after duration [s] never exceeds error [m]; not for the closed
    form. Exits with CLI_FAILED if rounding is of that size. */
uint64_t equal_error_steps(spring_method m, double duration, double error);

/** The smallest n whose error happens not to exceed it; it may do so again beyond. */
uint64_t equal_error_first_steps(spring_method m, double duration, double error);

#endif
