/* SPDX-License-Identifier: MIT */
/* What steppers work from: parameters over mass, each rounded once. */
#ifndef SPRINGSTEP_RATES_H
#define SPRINGSTEP_RATES_H

#include "simd/real.h"

#include <springstep/spring.h>

/* Here and in the coefficients made of them, adding 0 turns -0 into 0: a zero feature then has one sign, and the long
   formulas of the steppers give the bits of the short ones (tests/test_shapes.c). */
typedef struct spring_rates {
    real w; /* [1/s^2] stiffness/mass */
    real g; /* [1/s]   damping/mass   */
    real a; /* [m/s^2] load/mass      */
} spring_rates;

#ifndef SPRING_VECTOR
SPRING_INLINE spring_rates spring_rates_of(const spring_params *p)
{
    return (spring_rates){(real)(p->stiffness / p->mass + 0.0), (real)(p->damping / p->mass + 0.0),
                          (real)(p->load / p->mass + 0.0)};
}

/* r is what spring_rates_of() made of p. */
SPRING_INLINE bool spring_rates_valid(const spring_params *p, const spring_rates *r)
{
    return p->mass > 0 && spring_finite(p->mass) && p->stiffness >= 0 && spring_finite(r->w) && p->damping >= 0 &&
           spring_finite(r->g) && spring_finite(r->a);
}
#endif

#endif
