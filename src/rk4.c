/* SPDX-License-Identifier: MIT */
/* Runge-Kutta 4 for one spring, and its stable step; the formula is in rk4.h. */
#include "rk4.h"

#include "method.h"

#define SPRING_METHOD rk4
#include "loops.h"

void spring_step_rk4(spring_state *s, const spring_params *p, double dt)
{
    one_step(s, p, dt);
}

/* R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24 reaches -1..1 again at this distance along the negative real axis. */
static const double real_limit = 2.785293563405282;

/* |R(z)| = 1 along the ray z = r (-zeta + i eta), zeta^2 + eta^2 = 1, zeta >= 0. For every zeta there is one such r > 0;
   it lies in [2.61, 2.97], and |R|^2 is convex in r from there to 3, so Newton's method descends to it from 3. */
static double ray_limit(double zeta, double eta)
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

static double stable_step(const spring_roots *r)
{
    if (r->overdamped)
        return real_limit / spring_fast_root(r);
    if (r->w > 0)
        return ray_limit(r->b / r->omega, r->split / r->omega) / r->omega;
    return INFINITY;
}

const spring_method_row spring_method_rk4 = {"rk4", many_steps, stable_step};
