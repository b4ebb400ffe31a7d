/* SPDX-License-Identifier: MIT */
/*
 * The classical Runge-Kutta method of order 4 for a damped, loaded spring, in split form.
 *
 * Method    y' = M y + b with M = (0 1; -w -g), b = (0, a). The four stages collapse to
 *
 *               y1 = y + h (M y + b) + h Q (M y + b),   Q = Z/2 + Z^2/6 + Z^3/24,   Z = h M
 *
 *           This is Euler's step plus a correction, whose entries follow from two polynomials in W = w h^2, G = g h:
 *
 *               Q (0, 1) = (h E, F):   E = 1/2 - G/6 + (G^2 - W)/24
 *                                      F = -G/2 + (G^2 - W)/6 + G (2 W - G^2)/24
 *               x1 = x + (h v           + (-W E x   + h F v         + h^2 E a))
 *               v1 = v + (h (a - w x - g v) + (-w h F x - (W E + G F) v + h F a))
 *
 *           Euler's step and the correction are added separately, because this has smaller rounding errors: the
 *           correction is small, so its error is small too, and h v is rounded once. (The rounding error of a summed
 *           coefficient would be the same in every step, and would accumulate.)
 * Order     4. Undamped phase error after time T: w^(5/2) h^4 T/120; relative energy loss (w h^2)^3/72 per step.
 * Limit     |R(h r)| = 1 over the roots r of the spring, R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24: h omega = 2 sqrt 2
 *           without damping, h = 2.785.../(fast root) for real roots, Newton's method on |R|^2 = 1 in between.
 * Accuracy  rounding at most 2 eps (1 + z^2)^2 |(x, v/omega)| a step, z = h max(omega, g) (tests/spring/test_iterate.c)
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1
 */
#ifndef SPRINGSTEP_RK4_TMPL_H
#define SPRINGSTEP_RK4_TMPL_H

#include "method_tmpl.h"

SPRING_INLINE void rk4_prepare(step_coefficients *c, spring_rates r, real h, bool damped, bool loaded)
{
    const real hw = h * r.omega2, W = h * hw, G = h * r.gamma;
    /* Without damping G is 0, and the short forms are bit-identical to the long ones. */
    const real E = (damped ? 12 - 4 * G + (G * G - W) : 12 - W) * (scalar)(1.0 / 24);
    const real F = (damped ? 4 * (G * G - W) - 12 * G + G * (2 * W - G * G) : 0 - 4 * W) * (scalar)(1.0 / 24);
    c->omega2 = hw;
    c->xx = -W * E;
    c->xv = h * F;
    c->vx = -hw * F;
    c->vv = c->xx - G * F;
    if (damped)
        c->gamma = G + 0; /* + 0 turns the -0 of a negative step into 0 */
    if (loaded) {
        c->accel = h * r.accel + 0;
        c->x_load = 0 - h * E * (h * r.accel);
        c->v_load = 0 - F * (h * r.accel);
    }
}

SPRING_INLINE void rk4_step(real *x, real *v, real *kept, real h, const step_coefficients *c, bool damped, bool loaded)
{
    (void)kept;
    real pull = c->omega2 * *x;
    real dx = c->xx * *x + c->xv * *v;
    real dv = c->vx * *x + c->vv * *v;
    if (loaded) {
        pull -= c->accel;
        dx -= c->x_load;
        dv -= c->v_load;
    }
    if (damped)
        pull += c->gamma * *v;
    *x += h * *v + dx;
    *v += dv - pull;
}

#ifndef SPRING_VECTOR
void spring_step_rk4(spring_state *s, const spring_params *p, double dt)
{
    take_one_step(s, p, dt, rk4_prepare, keeps_nothing, rk4_step);
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
    if (r->omega2 > 0)
        return rk4_ray_limit(r->b / r->omega, r->split / r->omega) / r->omega;
    return (double)INFINITY;
}

static step_terms rk4_terms(step_rates r)
{
    return exponential_terms(r, 4);
}

static const spring_method_info rk4_info = {
    .name = "rk4", .order = 4, .forces_per_step = 4, .springs = true, .scenes = true, .label = "RK4"};
static const method_row rk4_method = {
    .info = &rk4_info,
    .kernel = spring_step_rk4,
    .stable_step = rk4_stable_step,
    .terms = rk4_terms,
    .digest = UINT64_C(0x3642d6157857a437),
};
#endif

#endif
