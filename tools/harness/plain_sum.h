/* SPDX-License-Identifier: MIT */
/* The loop that SUNDIALS' vector sum is compared with. Compiled with -O3, whatever the build is compiled with. */
#ifndef HARNESS_PLAIN_SUM_H
#define HARNESS_PLAIN_SUM_H

#include <stddef.h>

/** z = a x + b y */
void plain_sum(size_t n, double a, const double *x, double b, const double *y, double *z);

#endif
