/* SPDX-License-Identifier: MIT */
/*
 * The Runge-Kutta-Nystrom method 8(6)9 of Dormand, El-Mikkawy and Prince, for scenes whose forces depend on positions,
 * and on velocities by drag alone.
 *
 * Method    X_i = x + c_i h v + h^2 sum a_ij A_j,   A_i = a(t + c_i h, X_i)
 *           x1 = x + h v + h^2 sum b_j A_j,   v1 = v + h sum b'_j A_j
 *           The ninth stage is the first of the next step, so a step evaluates eight forces.
 * Drag      with g = drag/mass is removed exactly by y = e^(g t/2) (x - x0), t from the start of the step, for which
 *           y'' = e^(g t/2) a + (g/2)^2 y. With growth E_i = e^(g c_i h/2) and d_i = X_i - x0:
 *               A_i = E_i (a(X_i) + (g/2)^2 d_i),   d_i = (c_i h v + h^2 sum a_ij A_j)/E_i,
 *           and the velocity is v1 = e^(-g h/2) (y' - g/2 y), written as v plus its change.
 * Order     8. Undamped phase error after time T: 2.2e-8 omega^9 h^8 T; relative energy loss 3.8e-8 z^10 per step,
 *           z = h omega.
 * Limit     z = 3.1402 without drag, larger with drag. (Steps are unstable from there to 3.1417, and again from 3.29.)
 *           E overflows from g h = 1400, in single precision from 176.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step (tests/spring/test_rkn8.c)
 * Source    Dormand, El-Mikkawy, Prince, High-order embedded Runge-Kutta-Nystrom formulae, IMA J. Numer. Anal. 7
 *           (1987)
 */
#ifndef SPRINGSTEP_RKN8_H
#define SPRINGSTEP_RKN8_H

#include "method_tmpl.h"

#ifndef SPRING_VECTOR
static const spring_method_info rkn8_info = {
    .name = "rkn8", .order = 8, .forces_per_step = 8, .scenes = true, .label = "RKN8", .positions_only = true};
static const method_row rkn8_method = {
    .info = &rkn8_info,
    .digest = UINT64_C(0x74494ed0e40a48e5),
};
#endif

#endif
