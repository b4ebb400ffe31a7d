/* SPDX-License-Identifier: MIT */
/* Leapfrog for one spring, and its stable step; the formula is in leapfrog.h. */
#include "leapfrog.h"

#include "method.h"

#define SPRING_METHOD leapfrog
#include "loops.h"

void spring_step_leapfrog(spring_state *s, const spring_params *p, double dt)
{
    one_step(s, p, dt);
}

static double stable_step(const spring_roots *r)
{
    return 2 / r->omega; /* IEEE 754: infinite without stiffness */
}

const spring_method_row spring_method_leapfrog = {"leapfrog", many_steps, stable_step};
