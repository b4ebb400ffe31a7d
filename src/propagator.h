/* SPDX-License-Identifier: MIT */
/* How the exact solution moves any state over a time: what exact.c computes once from a spring and that time. */
#ifndef SPRINGSTEP_PROPAGATOR_H
#define SPRINGSTEP_PROPAGATOR_H

#include <stdbool.h>

#include <springstep/spring.h>

typedef struct spring_propagator {
    double half;           /* e^(-bt/2), or of the slow root */
    double F, G, H, wH, P; /* times half; H [s], wH [1/s]; P [s^2] is complete */
} spring_propagator;

spring_propagator spring_propagator_of(const spring_params *p, double t, bool loaded); /* without loaded, P = 0 */

/* spring_step_exact(), by value. */
spring_state spring_exact(spring_state s, const spring_params *p, double t);

#endif
