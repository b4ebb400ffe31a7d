/* SPDX-License-Identifier: MIT */
/*
 * A method and its arithmetic; see stepper.h. The classical Runge-Kutta method of order 4, stage by stage:
 *
 *     k1 = f(y),  k2 = f(y + h/2 k1),  k3 = f(y + h/2 k2),  k4 = f(y + h k3),   f(x, v) = (v, a - w x - g v)
 *
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1
 */
#include "common/stepper.h"

#include <math.h>
#include <stddef.h>

enum { LIBRARY, STAGES };

const char *const stepper_arithmetics[] = {[LIBRARY] = "library", [STAGES] = "stages", NULL};

const char *stepper_name(const stepper *m)
{
    return spring_method_name((spring_method)m->method);
}

void stepper_check(const stepper *m)
{
    if (m->arithmetic == STAGES && m->method != SPRING_RK4)
        cli_fail(CLI_USAGE, "--arithmetic: \"stages\" is for rk4 only; with --method %s it should be library",
                 stepper_name(m));
}

void stepper_remark(const stepper *m, const spring_params *p, double dt)
{
    run_length_remark_step(dt, spring_stable_step(p, (spring_method)m->method), (spring_method)m->method);
}

void stepper_comment(const stepper *m, cli_table *table)
{
    cli_comment(table, "method: %s, arithmetic: %s", stepper_name(m), stepper_arithmetics[m->arithmetic]);
}

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

/* As spring_advance(): checks for overflow at the same interval, and leaves the state unchanged if it overflows. */
static spring_status advance_by_stages(spring_state *s, const spring_params *p, double dt, uint64_t n)
{
    spring_state now = *s;
    while (n > 0) {
        const uint64_t some = n < SPRING_CHECK_INTERVAL ? n : SPRING_CHECK_INTERVAL;
        stages_advance(&now, p, dt, some);
        if (!isfinite(now.x) || !isfinite(now.v))
            return SPRING_ENONFINITE;
        n -= some;
    }
    *s = now;
    return SPRING_OK;
}

spring_status stepper_advance(const stepper *m, spring_state *s, const spring_params *p, double dt, uint64_t n)
{
    if (m->arithmetic == STAGES)
        return advance_by_stages(s, p, dt, n);
    return spring_advance(s, p, (spring_method)m->method, dt, n);
}
