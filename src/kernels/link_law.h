/* SPDX-License-Identifier: MIT */
/* The force law of a link, for single numbers. bands_tmpl.h and unbanded_tmpl.h have it for SIMD vectors. */
#ifndef SPRINGSTEP_LINK_LAW_H
#define SPRINGSTEP_LINK_LAW_H

#include "../simd/arithmetic.h"

/* [N] positive if the link pulls; rate: [m/s] rate of change of the length */
static inline double link_tension(double stiffness, double rest, double damping, double length, double rate)
{
    return stiffness * (length - rest) + damping * rate;
}

#endif
