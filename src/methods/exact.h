/* SPDX-License-Identifier: MIT */
/* The exact (closed-form) solution as a method. Its formula is in spring/exact_formula_tmpl.h. */
#ifndef SPRINGSTEP_EXACT_H
#define SPRINGSTEP_EXACT_H

#include "method_tmpl.h"

#ifndef SPRING_VECTOR
static double exact_stable_step(const spring_roots *r)
{
    (void)r;
    return (double)INFINITY;
}

static const spring_method_info exact_info = {
    .name = "exact", .order = 0, .forces_per_step = 0, .symplectic = true, .springs = true, .label = "exact"};
static const method_row exact_method = {
    .info = &exact_info,
    .kernel = spring_step_exact,
    .stable_step = exact_stable_step,
    .digest = UINT64_C(0x00349312ac922285),
};
#endif

#endif
