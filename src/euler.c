/* SPDX-License-Identifier: MIT */
/* Explicit Euler for one spring, and its stable step; the formula is in euler.h. */
#include "euler.h"

#include "method.h"

#define SPRING_METHOD euler
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
