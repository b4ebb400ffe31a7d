/* SPDX-License-Identifier: MIT */
/*
 * Explicit Euler for a damped, loaded spring.
 *
 * Method    x1 = x + h v;   v1 = v - ((h w) x - h a + (h g) v)
 * Order     1. Undamped error after time T: about (w h T/2) times the amplitude.
 * Limit     (1 + h r) over the roots r of the spring must lie in the unit circle: h < g/w for complex roots,
 *           h < 2/(fast root) for real ones. Undamped never: E grows by 1 + w h^2 a step, exactly.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section I.7
 */
#include "method.h"

typedef struct coefficients {
    double h, hw, hg, ha;
} coefficients;

SPRING_INLINE coefficients prepare(spring_rates r, double h)
{
    return (coefficients){.h = h, .hw = h * r.w, .hg = h * r.g + 0.0, .ha = h * r.a + 0.0};
}

SPRING_INLINE void step(double *x, double *v, const coefficients *c, bool damped, bool loaded)
{
    double pull = c->hw * *x;
    if (loaded)
        pull -= c->ha;
    if (damped)
        pull += c->hg * *v;
    *x += c->h * *v;
    *v -= pull;
}

#include "loops.h"

void spring_step_euler(spring_state *s, const spring_params *p, double dt)
{
    one_step(s, p, dt);
}

static double stable_step(const spring_roots *r)
{
    if (r->overdamped)
        return 2 / spring_fast_root(r);
    if (r->w > 0)
        return 2 * r->b / r->w;
    return INFINITY;
}

const spring_method_row spring_method_euler = {"euler", many_steps, stable_step};
