/* SPDX-License-Identifier: MIT */
/*
 * Link damping at steps beyond the limit of explicit damping: a Chebyshev polynomial, applied to all velocities.
 *
 * Method    The velocities after damping alone for a time t, with the directions of links frozen, are e^Z v, Z = -t M^-1 C.
 *           They are computed as P(Z) v, the damped Chebyshev polynomial of second order by Sommeijer, Shampine and Verwer:
 *
 *               P(Z) = 1 + b (T_s(w0 + w1 Z) - T_s(w0)),   b = T_s''(w0)/T_s'(w0)^2,   w1 = T_s'(w0)/T_s''(w0),
 *               w0 = 1 + 2/(13 s^2)
 *
 *           by T_j(y) = 2 y T_{j-1}(y) - T_{j-2}(y), one evaluation of the forces of damping per term.
 * Limit     |P(z)| <= 1 for -(w0 + 1)/w1 <= z <= 0. So damping never adds kinetic energy if this interval holds the
 *           spectrum of Z, which is between -t G and 0 (G: scene_bounds.link_damping).
 * Accuracy  P(z) = e^z + O(z^3)
 * Source    Sommeijer, Shampine, Verwer, RKC: an explicit solver for parabolic PDEs, J. Comput. Appl. Math. 88 (1997)
 */
#ifndef SPRINGSTEP_CHEBYSHEV_H
#define SPRINGSTEP_CHEBYSHEV_H

#include "pass.h"

/* The largest number of terms. A polynomial of this many terms covers t G up to 0.65 terms^2, about 10^8 in double and
   10^6 in float; rounding errors grow like terms^1.5. Beyond it damping acts for the time that the polynomial covers. */
enum { most_damping_terms = sizeof(scalar) == sizeof(float) ? 1024 : 16384 };

/* The interval (w0 + 1)/w1 of the polynomial of s terms is at least (s - 1)^2/1.54 - 1 (tests/test_scene_damping.c). */
static inline unsigned chebyshev_terms(double reach)
{
    const double terms = 1 + spring_sqrt(1 + 1.54 * reach);
    return terms < 2 ? 2 : terms < most_damping_terms ? (unsigned)terms : most_damping_terms;
}

static inline chebyshev_polynomial chebyshev_of(unsigned terms)
{
    const double w0 = 1 + 2.0 / 13 / ((double)terms * terms);
    double value[2] = {1, w0}, slope[2] = {0, 1}, curvature[2] = {0, 0}; /* T_{j-1}, T_j and their derivatives at w0 */
    for (unsigned j = 2; j <= terms; j++) {
        const double next_curvature = 4 * slope[1] + 2 * w0 * curvature[1] - curvature[0];
        const double next_slope = 2 * value[1] + 2 * w0 * slope[1] - slope[0];
        const double next_value = 2 * w0 * value[1] - value[0];
        curvature[0] = curvature[1], curvature[1] = next_curvature;
        slope[0] = slope[1], slope[1] = next_slope;
        value[0] = value[1], value[1] = next_value;
    }
    return (chebyshev_polynomial){
        .terms = terms,
        .w0 = w0,
        .w1 = slope[1] / curvature[1],
        .b = curvature[1] / (slope[1] * slope[1]),
        .at_rest = value[1],
    };
}

/* The polynomial for damping over the time t at a bound of link_damping. */
static inline chebyshev_polynomial chebyshev_for(double t, double link_damping)
{
    chebyshev_polynomial p = chebyshev_of(chebyshev_terms(t * link_damping));
    const double covered = (p.w0 + 1) / p.w1 / link_damping;
    p.time = t < covered ? t : covered;
    return p;
}

/* The forces of damping at velocities v, then the motion of all particles by them. The results are those of
   evaluate_links() and move(). Where all links lie in bands it is one pass over memory. */
static inline bool damping_term(scene_step *s, const scene_links *links, const scalar *x, const scalar *v,
                                particle_kernel *kernel, const scene_motion *m)
{
    const scene_layout *l = &s->scene->layout;
    scene_forces forces = s->forces;
    forces.force = damping_storage(s, 0);
    if (l->small || l->unbanded > 0) {
        evaluate_links(s->kernels, s->scene, links, x, v, &forces);
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

/* Stores damping/length^2 of all links at positions x, so that damping at any velocities takes no root and no quotient. 0
   where the ends of a link are so near each other that it has no direction. */
static inline void freeze_directions(const scene_step *s, const scalar *x)
{
    const scene_layout *l = &s->scene->layout;
    const unbanded_links *links = &s->links->unbanded;
    scalar *const factor = scene_memory(s->scene, ARRAY_DAMPING_FACTORS);
    if (l->bands > 0)
        s->kernels->band_factors(s->links, x, factor);
    for (size_t j = 0; j < links->count; j++) {
        scalar square = 0;
        for (uint32_t a = 0; a < l->axes; a++) {
            const scalar *const axis = x + a * l->stride;
            const scalar delta = axis[l->particle_stride * links->b[j]] - axis[l->particle_stride * links->a[j]];
            square += delta * delta;
        }
        const scalar f = l->axes == 1 ? links->damping[j] : links->damping[j] / square;
        factor[l->band_slots + j] = f <= scalar_max ? f : 0;
    }
}

/* v1 = P(Z) v0, with the directions of links at the positions that freeze_directions() was called for last. v1 may be v0.
   Returns false if a result is not finite. */
static inline bool damp(scene_step *s, const scalar *x, const scalar *v0, scalar *v1)
{
    const chebyshev_polynomial *p = &s->damping_polynomial;
    scene_links links = *s->links;
    links.terms = DAMPING_TERM;
    const double kick = p->w1 * p->time;
    scalar *const storage[] = {damping_storage(s, 1), damping_storage(s, 2)};
    scene_chebyshev term = {.weight = (scalar)p->b, .at_rest = (scalar)p->at_rest, .argument = (scalar)p->w0};
    scene_motion m = {
        .v0 = v0, .v = storage[0], .force = damping_storage(s, 0), .kick = (scalar)kick, .chebyshev = &term};
    bool finite = damping_term(s, &links, x, v0, s->kernels->first_damping_term, &m);
    term.argument = (scalar)(2 * p->w0);
    m.kick = (scalar)(2 * kick);
    term.second_before = v0;
    for (unsigned j = 2; j <= p->terms && finite; j++) {
        term.before = m.v;
        m.v = j == p->terms ? v1 : storage[(j - 1) % 2];
        finite = damping_term(s, &links, x, term.before,
                              j == p->terms ? s->kernels->last_damping_term : s->kernels->next_damping_term, &m);
        term.second_before = term.before;
    }
    return finite;
}

#endif
