/* SPDX-License-Identifier: MIT */
/* The loop with which SUNDIALS' vector sum is compared. It is compiled with -O3 in every build type. */
#ifndef HARNESS_PLAIN_SUM_H
#define HARNESS_PLAIN_SUM_H

#include <stddef.h>

/** z = a x + b y */
void plain_sum(size_t n, double a, const double *x, double b, const double *y, double *z);

#endif
