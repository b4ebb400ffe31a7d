/* SPDX-License-Identifier: MIT */
/*
 * Link damping at steps beyond the limit of explicit damping: a Chebyshev series, applied to all velocities.
 *
 * Method    Damping alone, for a time t and with the directions of links frozen, changes velocities v to e^Z v,
 *           Z = -t M^-1 C. With Y = 1 + Z/rho, the exponential is a series of Chebyshev polynomials T_k with
 *           coefficients c_k > 0, which are modified Bessel functions:
 *
 *               e^(rho (Y - 1)) = sum c_k T_k(Y),   c_0 = e^-rho I_0(rho),   c_k = 2 e^-rho I_k(rho)
 *
 *           P is the sum of the terms up to k = s, where c_s is increased so that P'(0) = 1, divided by sum c_k. It is
 *           computed by Clenshaw's recurrence b_k = c_k v + 2 Y b_{k+1} - b_{k+2}, P v = c_0 v + Y b_1 - b_2, with s
 *           evaluations of the damping forces.
 *           The c_k follow from their downward recurrence (Miller), which requires + - * / and a square root only.
 * Limit     |T_k(y)| <= 1 for |y| <= 1, and all c_k are positive. So |P(z)| <= P(0) = 1 for -2 rho <= z <= 0, and
 *           damping never adds kinetic energy if this interval contains the spectrum of Z. The spectrum lies between
 *           -t G and 0, where G is scene_bounds.link_damping.
 * Accuracy  |P(z) - e^z| < 0.15 in the interval, and P(z) - e^z = O(z^3) for small t: tests/scene/test_damping.c
 * Source    Abramowitz, Stegun, Handbook of Mathematical Functions (1964), 9.6.34 and 9.12; Tal-Ezer, Kosloff, An
 *           accurate and efficient scheme for propagating the time dependent Schroedinger equation, J. Chem. Phys. 81
 *           (1984)
 */
#ifndef SPRINGSTEP_CHEBYSHEV_H
#define SPRINGSTEP_CHEBYSHEV_H

#include "pass.h"

/* The coefficients of all omitted terms sum up to less than this fraction of the total. More terms make no scene more
   accurate, since the error of a step comes from the splitting (docs/accuracy.md). */
static const double left_out = 0.05;

/* The least and the largest rho. Instead of a larger rho, damping acts for a shorter time, since rounding errors grow
   like rho^(1/2). Series have at most 12 500 terms in double and 760 in float. */
static const double least_rho = 0x1p-20, most_rho = sizeof(scalar) == sizeof(float) ? 1.5e5 : 4e7;

/* One step of the recurrence I_{k-1} = I_{k+1} + 2 k/rho I_k, downwards. */
static inline void bessel_step(double rho, unsigned k, double *above, double *here)
{
    const double below = *above + 2 * k / rho * *here;
    *above = *here;
    *here = below;
}

/* The series for damping over the time t; link_damping: see scene_bounds. */
static inline chebyshev_series chebyshev_for(double t, double link_damping)
{
    const double wanted = (1 + 0x1p-10) * t * link_damping / 2; /* a little more, for rounding errors of the bound */
    const double rho = wanted < least_rho ? least_rho : wanted < most_rho ? wanted : most_rho;
    const double covered = wanted > rho ? t * (rho / wanted) : t;
    const unsigned start = 20 + (unsigned)(10 * spring_sqrt(rho)); /* I_start < 1e-21 I_0 */
    double above = 0, here = 1e-30, total = 0;
    for (unsigned k = start; k > 0; bessel_step(rho, k--, &above, &here))
        total += 2 * here;
    total += here;
    unsigned terms = start;
    above = 0, here = 1e-30;
    for (double rest = 2 * here; terms > 3 && rest < left_out * total; rest += 2 * here)
        bessel_step(rho, terms--, &above, &here);
    const double last = here, beyond_last = above;
    double sum = 0, squares = 0; /* of c_k and k^2 c_k: P'(0) = squares/(rho sum) */
    for (unsigned k = terms; k > 0; bessel_step(rho, k--, &above, &here)) {
        sum += 2 * here;
        squares += 2 * here * k * k;
    }
    sum += here;
    const double more = (rho * sum - squares) / ((double)terms * terms - rho); /* added to the last coefficient */
    return (chebyshev_series){
        .terms = terms,
        .rho = rho,
        .last = 2 * last / (sum + more),
        .beyond_last = 2 * beyond_last / (sum + more),
        .more = more / (sum + more),
        .kick = covered / rho,
    };
}

/* Evaluates the damping forces at velocities v, then advances all particles by them. The results are those of
   evaluate_links() and move(). If all links lie in bands, it is one fused pass. */
static inline bool damping_term(scene_step *s, const scene_links *links, const scalar *x, const scalar *v,
                                particle_kernel *kernel, const scene_motion *m)
{
    const scene_layout *l = &s->scene->layout;
    scene_forces forces = s->forces;
    forces.force = damping_storage(s, 0);
    if (l->unbanded > 0) {
        evaluate_links(s->kernels, links, x, v, &forces);
        return move(s, kernel, m);
    }
    for (size_t i = 0; i < l->particles; i += chunk) {
        const size_t end = i + chunk < l->particles ? i + chunk : l->particles;
        s->kernels->band_forces(links, x, v, &forces, i, end);
        if (!kernel(&s->particles, m, i, end))
            return false;
    }
    return true;
}

/* Stores the directions of all links at positions x, times the square root of their damping, so that damping forces
   require no root and no quotient. The direction is 0 if the ends of a link coincide. */
static inline void freeze_directions(const scene_step *s, const scalar *x)
{
    const scene_layout *l = &s->scene->layout;
    const unbanded_links *links = &s->links->unbanded;
    if (l->bands > 0)
        s->kernels->common->band_directions(s->links, x, scene_memory(s->scene, ARRAY_BAND_DIRECTIONS));
    scalar *const direction = scene_memory(s->scene, ARRAY_LINK_DIRECTIONS);
    for (size_t j = 0; j < links->count; j++) {
        const scalar *const from = x + links->a[j], *const to = x + links->b[j];
        scalar delta[3], square = 0;
        for (uint32_t a = 0; a < l->axes; a++) {
            delta[a] = to[a * l->stride] - from[a * l->stride];
            square += delta[a] * delta[a];
        }
        const scalar root = (scalar)spring_sqrt((double)links->damping[j]),
                     length = (scalar)spring_sqrt((double)square);
        const bool acts = square > 0 && !(s->links->tension_only && length <= links->rest[j]);
        for (uint32_t a = 0; a < l->axes; a++)
            direction[quad_size * j + a] = l->axes == 1 ? root : acts ? root * (delta[a] / length) : 0;
    }
}

/* v = P v, with the directions of links at positions x. Returns false if a result is not finite. */
static inline bool damp_links(scene_step *s, const scalar *x, scalar *v)
{
    const chebyshev_series *p = &s->damping;
    scene_links links = *s->links;
    links.terms = DAMPING_TERM;
    scalar *const storage[] = {damping_storage(s, 1), damping_storage(s, 2)};
    double above = p->beyond_last, c = p->last; /* the coefficients k + 1 and k of the whole series */
    const double last = p->last + p->more;
    /* b_s = c_s v is not stored: the terms that follow from it use v. */
    scene_chebyshev term = {.before = v, .second_before = v};
    scene_motion m = {.v0 = v, .force = damping_storage(s, 0), .damping_term = &term};
    freeze_directions(s, x);
    bool finite = true;
    for (unsigned k = p->terms; k > 0 && finite; k--) {
        bessel_step(p->rho, k, &above, &c);
        const double own = k > 1 ? c : c / 2, times = k > 1 ? 2 : 1;
        const bool first = k == p->terms, second = k + 1 == p->terms;
        term.coefficient = (scalar)(first ? own + times * last : second ? own - last : own);
        term.before_weight = (scalar)(first ? 0 : times);
        term.second_weight = first || second ? 0 : 1;
        m.kick = (scalar)(first ? times * last * p->kick : times * p->kick);
        m.v = k > 1 ? storage[k % 2] : v;
        finite = damping_term(s, &links, x, term.before,
                              k > 1 ? s->kernels->common->damping_term : s->kernels->common->last_damping_term, &m);
        term.second_before = first ? v : term.before;
        term.before = m.v;
    }
    return finite;
}

#endif
