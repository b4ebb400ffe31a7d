/* SPDX-License-Identifier: MIT */
/* The law of a link, as numbers. The kernels have it for SIMD vectors: see bands.h and unbanded.h. */
#ifndef SPRINGSTEP_LINK_LAW_H
#define SPRINGSTEP_LINK_LAW_H

#include "../simd/arithmetic.h"

/* [N] > 0 pulls; rate: [m/s] rate of change of the length */
static inline double link_tension(double stiffness, double rest, double damping, double length, double rate)
{
    return stiffness * (length - rest) + damping * rate;
}

#endif
