/* SPDX-License-Identifier: MIT */
/* The parameters of a spring divided by its mass, each rounded once. All methods start from these. */
#ifndef SPRINGSTEP_RATES_TMPL_H
#define SPRINGSTEP_RATES_TMPL_H

#include "../simd/real_tmpl.h"

#include <springstep/spring.h>

/* Adding 0 turns -0 into 0, here and in the coefficients of methods. A zero then has one sign, so that a step with a
   damping or load of zero gives the same bits as a step without it (tests/spring/test_shapes.c). */
typedef struct spring_rates {
    real omega2; /* [1/s^2] stiffness/mass */
    real gamma;  /* [1/s]   damping/mass   */
    real accel;  /* [m/s^2] load/mass      */
} spring_rates;

#ifndef SPRING_VECTOR
SPRING_INLINE spring_rates spring_rates_of(const spring_params *p)
{
    return (spring_rates){(real)(p->stiffness / p->mass + 0.0), (real)(p->damping / p->mass + 0.0),
                          (real)(p->load / p->mass + 0.0)};
}

/* r: the result of spring_rates_of(p) */
SPRING_INLINE bool spring_rates_valid(const spring_params *p, const spring_rates *r)
{
    return p->mass > 0 && spring_finite(p->mass) && p->stiffness >= 0 && spring_finite(r->omega2) && p->damping >= 0 &&
           spring_finite(r->gamma) && spring_finite(r->accel);
}
#endif

#endif
