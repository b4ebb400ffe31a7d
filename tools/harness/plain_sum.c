/* SPDX-License-Identifier: MIT */
/* A vector sum as a plain loop; see plain_sum.h. */
#include "harness/plain_sum.h"

void plain_sum(size_t n, double a, const double *x, double b, const double *y, double *z)
{
    for (size_t i = 0; i < n; i++)
        z[i] = a * x[i] + b * y[i];
}
