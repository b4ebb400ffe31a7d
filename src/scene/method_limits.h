/* SPDX-License-Identifier: MIT */
/* What scenes of either precision have for each method: its stable step and its storage. */
#ifndef SPRINGSTEP_METHOD_LIMITS_H
#define SPRINGSTEP_METHOD_LIMITS_H

#include "../simd/arithmetic.h"

#include <springstep/spring.h>

/* Bounds from which the stable steps follow; see stable_step.c. Each motion u'' = -omega2 u - gamma u' of the scene
   about rest has omega2 <= stiffness, gamma <= damping, and with drag gamma/omega2 >= drag/stiffness_sum. */
typedef struct scene_bounds {
    double stiffness;     /* [1/s^2] largest sum of (2/mass) stiffness over the links of a particle; 1/mass to a pin */
    double link_damping;  /* [1/s]   the same for damping */
    double damping;       /* [1/s]   the same for damping, plus drag/mass */
    double stiffness_sum; /* [N/m]   like stiffness, without the mass */
    double drag;          /* [N s/m] */
    double least_drag;    /* [1/s]   drag divided by the largest mass */
} scene_bounds;

/* Storage of methods: arrays of a quantity of all particles for stages, and with drag numbers for each mass. */
enum { rk4_stage_arrays = 4, rkn8_stage_arrays = 8, rkn8_mass_factors = 15, srkn6_mass_factors = 12 };

typedef struct method_limits {
    double (*stable_step)(const scene_bounds *b); /* NULL: the method is not for scenes */
    bool predicts; /* stores predicted velocities, and the forces at these, if forces depend on velocities */
    double (*explicit_limit)(const scene_bounds *b); /* of dt; beyond, kicks are exponential: exponential_kick.h */
    unsigned stage_arrays, mass_factors;
} method_limits;

SPRING_INTERNAL const method_limits spring_method_limits[SPRING_METHOD_COUNT];

#endif
