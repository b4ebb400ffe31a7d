/* SPDX-License-Identifier: MIT */
/*
 * The symplectic Runge-Kutta-Nystrom method of order 6 with 11 stages of Blanes and Moan (SRKN11b), for scenes whose
 * forces depend on positions, and on velocities only through drag.
 *
 * Method    for i = 1 ... 11:  v += h b_i a(x),  x += h a_i v;   then  v += h b_12 a(x)
 *           It is symmetric: b_(13-i) = b_i, a_(12-i) = a_i. The last kick and the first kick of the next step use the
 *           same force, so a step evaluates eleven forces.
 * Drag      with g = drag/mass belongs to the drift, x' = v, v' = -g v, which is solved exactly:
 *               x += v (1 - e^(-g a_i h))/g,   v += v (e^(-g a_i h) - 1)
 *           Order 6 requires that the triple commutator of the kick with the drift vanishes. It does: x' and v' = -g v
 *           are of degree 1 in v, and each commutator with the kick lowers these degrees by one. (With drag in the
 *           kick, this would not hold.) With drag as the only force the step is exact.
 * Order     6. Undamped phase error per step: 8.04e-8 z^7, z = h omega; the energy error of an oscillator
 *           is at most 2.84e-7 z^6 (1 + 0.3 z^2) at any time.
 * Limit     z = 9.0734 without drag. With drag, z < 9.07 and g h < 20 are sufficient for one mode
 *           (tests/spring/test_srkn6.c). Some a_i are negative, so velocities grow by e^(0.25 g h) within a step under
 *           heavy drag. If drag/mass differs between particles, it couples the modes, and less is stable: z < 8 and
 *           g h < 3 were sufficient in all of 10^8 systems of two or three coupled modes. At z = 8.2 and g h = 4 some
 *           grow by 0.6 % per step, and at z = 9.07 from g h = 0.1.
 * Source    Blanes, Moan, Practical symplectic partitioned Runge-Kutta and Runge-Kutta-Nystrom methods, J. Comput.
 *           Appl. Math. 142 (2002)
 */
#ifndef SPRINGSTEP_SRKN6_H
#define SPRINGSTEP_SRKN6_H

#include "method_tmpl.h"

#ifndef SPRING_VECTOR
static const spring_method_info srkn6_info = {.name = "srkn6",
                                              .order = 6,
                                              .forces_per_step = 11,
                                              .symplectic = true,
                                              .scenes = true,
                                              .label = "SRKN6",
                                              .positions_only = true};
static const method_row srkn6_method = {
    .info = &srkn6_info,
    .digest = UINT64_C(0x622b7f6e0da7bdbf),
};
#endif

#endif
