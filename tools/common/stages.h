/* SPDX-License-Identifier: MIT */
/* The classical Runge-Kutta method of order 4 with its four stages evaluated one by one, as textbooks write it. */
#ifndef SPRINGSTEP_SPRINGSTEP_STAGES_H
#define SPRINGSTEP_SPRINGSTEP_STAGES_H

#include <stdint.h>

#include <springstep/spring.h>

/** Takes n steps with the sum of the original study, y += (h/6) (k1 + 2 k2 + 2 k3 + k4), and reproduces it to the last
    digit. The library computes the same step from a polynomial, with other rounding errors. Works from stiffness/mass,
    damping/mass and load/mass, each rounded once, and does not check its parameters. */
void stages_advance(spring_state *s, const spring_params *p, double h, uint64_t n);

#endif
