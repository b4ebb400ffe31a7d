/* SPDX-License-Identifier: MIT */
/* Stable steps of scenes, from bounds on the sums over the links of a particle (stable_step.c), and storage of each
   method. The formulas of the methods are in steppers.c. */
#include "method_limits.h"

#include "../spring/roots.h"

#include "../simd/size_begin.h"

static double scene_euler_limit(const scene_bounds *b)
{
    return b->stiffness_sum > 0 ? fmin(b->drag / b->stiffness_sum, 2 / b->damping) : 2 / b->damping;
}

/* Explicit link damping lowers the limit, and implicit drag raises it. A motion with stiffness k, link damping c and
   drag d, all divided by the mass, is stable for h^2 k + 2 h c < 4 + 2 h d. */
static double scene_symplectic_euler_limit(const scene_bounds *b)
{
    const double excess = b->link_damping - b->least_drag;
    const double root = spring_hypot(fabs(excess), 2 * spring_sqrt(b->stiffness));
    if (excess > 0 || root == 0 || root == (double)INFINITY) /* infinite: no stable step is known */
        return 4 / (excess + root);
    return (root - excess) / b->stiffness;
}

static double scene_leapfrog_limit(const scene_bounds *b)
{
    return 2 / spring_sqrt(b->stiffness);
}

/* Explicit damping c of links is stable for h^2 k/4 + h c < 1. Beyond 0.9 of it, or for h c > 0.4, the exponential kick
   is more accurate at a similar cost. */
static double scene_leapfrog_explicit_limit(const scene_bounds *b)
{
    const double least = 0.9, most = 0.4, damping = b->damping / least;
    return fmin(most / b->link_damping, 2 / (damping + spring_hypot(damping, spring_sqrt(b->stiffness))));
}

static double scene_rk4_limit(const scene_bounds *b)
{
    const double limit = 2.61; /* for |h z| below it RK4 is stable in the whole left half plane */
    return limit / fmax(spring_sqrt(b->stiffness), b->damping);
}

/* A growth far beyond e^20 would overflow in float, and leave no significant digit of a stage. */
static double scene_rkn8_limit(const scene_bounds *b)
{
    return fmin(3.14 / spring_sqrt(b->stiffness), 40 / b->damping);
}

/* With drag, particles of different masses can grow from smaller steps than a mode alone; see srkn6.h. */
static double scene_srkn6_limit(const scene_bounds *b)
{
    const double root = spring_sqrt(b->stiffness);
    return b->drag > 0 ? fmin(8 / root, 3 / b->damping) : 9.07 / root;
}

SPRING_TABLE const method_limits spring_method_limits[SPRING_METHOD_COUNT] = {
    [SPRING_EULER] = {.stable_step = scene_euler_limit},
    [SPRING_SYMPLECTIC_EULER] = {.stable_step = scene_symplectic_euler_limit},
    [SPRING_LEAPFROG] = {.stable_step = scene_leapfrog_limit,
                         .predicts = true,
                         .explicit_limit = scene_leapfrog_explicit_limit},
    [SPRING_RK4] = {.stable_step = scene_rk4_limit, .stage_arrays = rk4_stage_arrays},
    [SPRING_RKN8] = {.stable_step = scene_rkn8_limit,
                     .stage_arrays = rkn8_stage_arrays,
                     .mass_factors = rkn8_mass_factors},
    [SPRING_SRKN6] = {.stable_step = scene_srkn6_limit, .mass_factors = srkn6_mass_factors},
};

#include "../simd/size_end.h"
