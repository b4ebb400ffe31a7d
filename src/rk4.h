/* SPDX-License-Identifier: MIT */
/*
 * The classical Runge-Kutta method of order 4 for a damped, loaded spring, in split form.
 *
 * Method    y' = M y + b with M = (0 1; -w -g), b = (0, a). The four stages collapse to
 *
 *               y1 = y + h (M y + b) + h Q (M y + b),   Q = Z/2 + Z^2/6 + Z^3/24,   Z = h M
 *
 *           Euler's step plus a correction, whose entries follow from two polynomials in W = w h^2, G = g h:
 *
 *               Q (0, 1) = (h E, F):   E = 1/2 - G/6 + (G^2 - W)/24
 *                                      F = -G/2 + (G^2 - W)/6 + G (2 W - G^2)/24
 *               x1 = x + (h v           + (-W E x   + h F v         + h^2 E a))
 *               v1 = v + (h (a - w x - g v) + (-w h F x - (W E + G F) v + h F a))
 *
 *           Kept apart, the two parts round better than their sum: the correction's error is small because it is
 *           small, and h v is rounded once. (Summed coefficients carry one rounding error into every step.)
 * Order     4. Undamped phase error after time T: w^(5/2) h^4 T/120; energy is lost at (w h^2)^3/72 a step.
 * Limit     |R(h r)| = 1 over the roots r of the spring, R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24: h omega = 2 sqrt 2
 *           without damping, h = 2.785.../(fast root) for real roots, Newton's method on |R|^2 = 1 in between.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/test_iterate.c)
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1
 */
#ifndef SPRINGSTEP_RK4_H
#define SPRINGSTEP_RK4_H

#include "method.h"

typedef struct rk4_coefficients {
    real hw, hg, ha;     /* Euler's part */
    real xx, xv, vx, vv; /* the correction to x and v, from x and v */
    real x_load, v_load; /* minus the correction from the load: subtracting a zero changes no bit */
} rk4_coefficients;

SPRING_INLINE void rk4_prepare(rk4_coefficients *c, spring_rates r, real h, bool damped, bool loaded)
{
    const real hw = h * r.w, W = h * hw, G = h * r.g;
    /* Without damping G is 0, and the short forms have the bits of the long ones. */
    const real E = (damped ? 12 - 4 * G + (G * G - W) : 12 - W) * (scalar)(1.0 / 24);
    const real F = (damped ? 4 * (G * G - W) - 12 * G + G * (2 * W - G * G) : 0 - 4 * W) * (scalar)(1.0 / 24);
    c->hw = hw;
    c->xx = -W * E;
    c->xv = h * F;
    c->vx = -hw * F;
    c->vv = c->xx - G * F;
    if (damped)
        c->hg = G + 0;
    if (loaded) {
        c->ha = h * r.a + 0;
        c->x_load = 0 - h * E * (h * r.a);
        c->v_load = 0 - F * (h * r.a);
    }
}

SPRING_INLINE void rk4_step(real *x, real *v, real h, const rk4_coefficients *c, bool damped, bool loaded)
{
    real pull = c->hw * *x;
    real dx = c->xx * *x + c->xv * *v;
    real dv = c->vx * *x + c->vv * *v;
    if (loaded) {
        pull -= c->ha;
        dx -= c->x_load;
        dv -= c->v_load;
    }
    if (damped)
        pull += c->hg * *v;
    *x += h * *v + dx;
    *v += dv - pull;
}

#if defined(SPRING_SHAPE_ONE)
#define SPRING_METHOD rk4
#include "one_loop.h"

void spring_step_rk4(spring_state *s, const spring_params *p, double dt)
{
    rk4_one_step(s, p, dt);
}

/* R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24 reaches -1..1 again at this distance along the negative real axis. */
static const double rk4_real_limit = 2.785293563405282;

/* |R(z)| = 1 along the ray z = r (-zeta + i eta), zeta^2 + eta^2 = 1, zeta >= 0. For every zeta there is one such r >
   0; it lies in [2.61, 2.97], and |R|^2 is convex in r from there to 3, so Newton's method descends to it from 3. */
static double rk4_ray_limit(double zeta, double eta)
{
    double r, next = 3;
    do {
        r = next;
        double R[2] = {1, 0}, dR[2] = {0, 0}; /* real and imaginary part; dR = dR/dr */
        for (int k = 4; k > 0; k--) {         /* Horner: R = 1 + z/k R */
            const double re = -zeta / k, im = eta / k;
            const double d_re = re * (R[0] + r * dR[0]) - im * (R[1] + r * dR[1]);
            const double d_im = re * (R[1] + r * dR[1]) + im * (R[0] + r * dR[0]);
            const double R_re = 1 + r * (re * R[0] - im * R[1]);
            R[1] = r * (re * R[1] + im * R[0]);
            R[0] = R_re;
            dR[0] = d_re;
            dR[1] = d_im;
        }
        next = r - (R[0] * R[0] + R[1] * R[1] - 1) / (2 * (R[0] * dR[0] + R[1] * dR[1]));
    } while (next < r);
    return r;
}

static double rk4_stable_step(const spring_roots *r)
{
    if (r->overdamped)
        return rk4_real_limit / spring_fast_root(r);
    if (r->w > 0)
        return rk4_ray_limit(r->b / r->omega, r->split / r->omega) / r->omega;
    return INFINITY;
}

static step_terms rk4_terms(step_rates r)
{
    return exponential_terms(r, 4);
}

static const one_method rk4_one = {
    .info = {.name = "rk4", .order = 4, .forces_per_step = 4, .springs = true, .scenes = true, .label = "RK4"},
    .kernel = spring_step_rk4,
    .loop = {{rk4_plain, rk4_loaded}, {rk4_damped, rk4_damped_loaded}},
    .stable_step = rk4_stable_step,
    .terms = rk4_terms,
    .digest = UINT64_C(0x3642d6157857a437),
};

#elif defined(SPRING_SHAPE_BATCH)
#define SPRING_METHOD rk4
#include "batch_loop.h"

#elif defined(SPRING_SHAPE_SCENE)
static scene_outcome rk4_scene_step(const scene_step *s)
{
    static const double parts[] = {0.5, 0.5, 1}; /* of the step, to the next stage */
    scene_motion end = scene_motion_of(s), stage = scene_motion_of(s);
    stage.x = scene_stage(s, 0);
    stage.v = scene_stage(s, 1);
    stage.sum_x = end.sum_x = scene_stage(s, 2);
    stage.sum_v = end.sum_v = scene_stage(s, 3);
    stage.weight = 2;
    for (int k = 0; k < 3; k++) {
        stage.kick = stage.drift = (scalar)parts[k] * s->h;
        if (!scene_move(s, &stage, k == 0 ? s->kernels->first_stage : s->kernels->next_stage))
            return (scene_outcome){.finite = false};
        scene_evaluate(s, stage.x, stage.v, parts[k]);
        stage.slope = stage.v;
        stage.force = end.force = scene_force_of(s->scene, s->to);
    }
    end.slope = stage.slope;
    end.kick = end.drift = s->h / 6;
    return (scene_outcome){.finite = scene_move(s, &end, s->kernels->last_stage)};
}

static double rk4_scene_stable_step(const scene_bounds *b)
{
    const double limit = 2.61; /* |hz| below which RK4 is stable in every direction of the left half plane */
    return limit / fmax(spring_sqrt(b->stiffness), b->damping);
}

static const scene_method rk4_scene = {
    .step = rk4_scene_step,
    .stable_step = rk4_scene_stable_step,
    .stages = 4,
};
#endif

#endif
