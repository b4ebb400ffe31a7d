/* SPDX-License-Identifier: MIT */
/*
 * The classical Runge-Kutta method of order 4, stage by stage:
 *
 *     k1 = f(y),  k2 = f(y + h/2 k1),  k3 = f(y + h/2 k2),  k4 = f(y + h k3),   f(x, v) = (v, a - w x - g v)
 *
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1
 */
#include "common/stages.h"

static inline spring_state add(spring_state y, double h, spring_state k)
{
    return (spring_state){y.x + h * k.x, y.v + h * k.v};
}

void stages_advance(spring_state *s, const spring_params *p, double h, uint64_t n)
{
    const double w = p->stiffness / p->mass, g = p->damping / p->mass, a = p->load / p->mass;
    const double fraction[] = {h / 2, h / 2, h};
    spring_state y = *s, k[4];
    for (; n > 0; n--) {
        for (int i = 0; i < 4; i++) {
            const spring_state at = i == 0 ? y : add(y, fraction[i - 1], k[i - 1]);
            k[i] = (spring_state){at.v, a - w * at.x - g * at.v};
        }
        y = add(y, h / 6,
                (spring_state){k[0].x + 2 * k[1].x + 2 * k[2].x + k[3].x, k[0].v + 2 * k[1].v + 2 * k[2].v + k[3].v});
    }
    *s = y;
}
