/* SPDX-License-Identifier: MIT */
/*
 * Leapfrog with heavy link damping: drift, exponential kick, drift.
 *
 * Symbols   h is the time step. M has the masses, C the damping of the links, K their stiffness. Z = M^-1 C, and G bounds
 *           its spectrum. r, the residual, is the acceleration at the positions x' of the middle of the step, with the
 *           velocities v0 of its start. s is the number of terms of the series.
 * Method    With the directions of links frozen, damping alone changes velocities by v' = r - Z (v - v0). The exact
 *           change in the time h is h p(hZ) r with p(z) = (1 - e^-z)/z:
 *
 *               x' = x0 + h/2 v0;   v1 = v0 + h p(hZ) r(x', v0);   x1 = x' + h/2 v1
 *
 *           p is computed as a polynomial of degree s - 1. For s = 2 it is 1 - z/2. Otherwise let
 *           rho >= (h G)/2 and Y = 1 - hZ/rho. A sum of Chebyshev polynomials with positive coefficients approximates
 *           e^-z:
 *
 *               R = c_0 + 2 sum c_k T_k(Y),   c_k = I_k(rho) (f_0 + f_1 q + f_2 q^2),   q = k^2/rho
 *
 *           I_k: modified Bessel functions, by their downward recurrence (Miller). f: numbers for which R has the value,
 *           slope and second derivative of e^-z at 0 (damping_series.c). Then
 *
 *               p = (1 - R)/z = d_0/2 + sum d_k T_k(Y),   d_k = (4/rho) sum_{j>k} (j - k) c_j
 *               m = (1 - p)/z = e_0/2 + sum e_k T_k(Y),   e_k = (2/rho) sum_{j>k} (j - k) d_j
 *
 *           Clenshaw's recurrence b_k = d_k r - e_k r2 + 2 Y b_{k+1} - b_{k+2} requires s - 1 evaluations of damping
 *           forces. r2 corrects for turning, see below. The result p r - m r2 is the last b_0, which has d_0/2, e_0/2 and
 *           Y in place of 2 Y.
 * Turning   Directions of links turn during a step. If the ends of a link of length l move across it at the relative
 *           velocity V, its rate changes by delta = l/(2h) t (1 + t/4 + t^2/8), t = min(1, (h V/l)^2), in half a step:
 *           this is the exact value of a steady rotation, to third order in t. So the rate in r is lower by delta, and
 *           r2 is the acceleration by damping at the rate -2 delta. Without it, damping would multiply the inertia
 *           along turning links. On one axis there is none. With s = 2, m is 1/2.
 * Drag      M is replaced by M (1 + q/2 + q^2/(12 + 2q)), q = h drag/M, and r includes -drag v0. For drag alone, this
 *           is a Pade approximant of e^-q.
 * Limit     For constant Z and stiffness K, stable if h^2 M^-1 K < 4, as without damping: the energy
 *           (v.(W - h^2 K/4) v + x.K x)/2, W = M (p(hZ)^-1 - hZ/2), never grows, and is positive if
 *           p(z) (1 + z/2) <= 1. Z and K need not commute.
 * Accuracy  0 < p(z) and p(z) (1 + z/2) <= 1 + 1e-12 for 0 <= z <= h G: tests/scene/test_damping_series.c
 * Source    Hochbruck, Ostermann, Exponential integrators, Acta Numerica 19 (2010); Abramowitz, Stegun, Handbook of
 *           Mathematical Functions (1964), 9.6.26 and 9.12; Clenshaw, A note on the summation of Chebyshev series,
 *           Math. Tables 9 (1955)
 */
#ifndef SPRINGSTEP_EXPONENTIAL_KICK_H
#define SPRINGSTEP_EXPONENTIAL_KICK_H

#include "pressed.h"

#include <math.h>

/* Most of the time of a step is that of its kernels. */
#include "../simd/size_begin.h"

/* ---------------------------------------------------------------------------------------------------------- bounces */

/* Reduces the velocities with which particles leave colliders with restitution, by at most the impulse of the impact. The
   kick before this impact has not damped them, and the next would be too late: a body would bounce in every step, and gain
   elastic energy. Friction that exceeds the limit of the smaller impulse is given back, unless the particle touches
   several surfaces: what is not normal to one of them is then not friction alone. before: velocities before the
   contacts. Returns false if a particle is then faster than max_speed */
SPRING_NOINLINE bool damp_bounces(const scene_step *s, const scalar *before)
{
    const scalar *const remaining = scene_read(s->scene, ARRAY_SUMS);
    const size_t stride = s->scene->layout.stride;
    const uint32_t axes = s->particles.axes;
    bool bounces = false;
    for (unsigned k = 0; k < s->contacts.setting.count; k++)
        bounces = bounces || s->contacts.setting.body[k].restitution > 0;
    for (size_t i = 0; bounces && i < s->particles.count; i++) {
        if (s->contacts.touched[i] == 0 || remaining[i] == 1)
            continue;
        contact_surface surface[most_surfaces];
        const unsigned surfaces = surfaces_at(s, s->contacts.touched[i], i, true, s->whole.x, surface);
        for (unsigned j = 0; j < surfaces; j++) {
            if (s->contacts.setting.body[surface[j].index].restitution == 0)
                continue;
            const vector3 v = load_vector(s->whole.v + i, stride, axes), n = surface[j].normal,
                          u = vector_minus(v, surface[j].velocity),
                          impact = vector_minus(v, load_vector(before + i, stride, axes));
            const double leaving = vector_dot(u, n), push = vector_dot(impact, n);
            const double removed = fmin((1 - (double)remaining[i]) * leaving, push);
            if (!(removed > 0))
                continue;
            const vector3 friction = vector_plus(impact, -push, n);
            const double size = spring_sqrt(vector_dot(friction, friction));
            const double excess = surfaces == 1 ? size - surface[j].friction * (push - removed) : 0;
            const vector3 change = vector_plus(vector_times(removed, n), excess > 0 ? excess / size : 0, friction);
            store_vector(s->whole.v + i, stride, axes, vector_plus(v, -1, change));
            record_change(s, i, surface[j].index, s->whole.x, change);
        }
    }
    size_t i = s->whole.max_speed < SCALAR_MAX ? 0 : s->particles.count;
    while (i < s->particles.count && !wrong_state(&s->particles, &s->whole, i))
        i++;
    return i == s->particles.count;
}

/* ---------------------------------------------------------------------------------------------------- the series */

/* Evaluates the damping forces at positions x and velocities v, then advances all particles by them. The results are
   those of evaluate_links() and move(). If all links lie in bands, it is one fused pass. */
static inline bool damping_term(scene_step *s, const scene_links *links, const scalar *x, const scalar *v,
                                particle_kernel *kernel, const scene_motion *m)
{
    const scene_layout *l = &s->scene->layout;
    if (!only_bands(links)) {
        evaluate_links(s->kernels, links, x, v, &s->forces);
        return move(s, kernel, m);
    }
    for (size_t i = 0; i < l->particles; i += chunk) {
        const size_t end = i + chunk < l->particles ? i + chunk : l->particles;
        s->kernels->band_forces(links, x, v, &s->forces, i, end);
        if (!kernel(&s->particles, m, i, end))
            return false;
    }
    return true;
}

/* v1 = v0 + span p(hZ) r, at positions x and with the residual r in kick_storage(s, 0); and x1 = x + h/2 v1 unless x1
   is NULL. pressed: NULL: no particles are. Returns false if a result is not finite, or faster than max_speed. */
static inline bool kick_exponentially(scene_step *s, pressed_kick *pressed, const scalar *x, scalar span, scalar *v1,
                                      scalar *x1, scalar max_speed)
{
    const common_kernels *const kernels = s->kernels->common;
    const damping_series *const p = &s->damping;
    scalar *const residual = kick_storage(s, 0), *const storage[] = {kick_storage(s, 1), kick_storage(s, 2)};
    scene_links links = *s->links;
    if (pressed != NULL)
        memcpy(pressed_component(s, PRESSED_REMOVED, 0, 0), pressed_component(s, PRESSED_TAKEN, 0, 0),
               3 * s->particles.stride * sizeof(scalar));
    links.terms = DAMPING_TERM;
    scene_series term = {.residual = residual, .before = residual, .second_before = residual, .h = s->h};
    scene_motion m = s->whole;
    m.force = s->forces.force;
    m.series = &term;
    m.kick = span;
    m.drift = s->h / 2;
    m.x0 = x;
    m.x = x1;
    m.max_speed = max_speed;
    /* b_{s-1} = d_{s-1} r is not stored: the terms that follow from it use r. For s = 2, p = 1 - z/2 and m = 1/2. */
    const bool two = p->terms == 2;
    series_term t = {.e = 1};
    if (!two) {
        t = spring_last_term(p);
        spring_previous_term(p, &t);
    }
    const double last = t.d;
    scalar given[2] = {1, 1}; /* the terms without damping, in units of the residual */
    for (unsigned k = p->terms - 1; k-- > 0;) {
        if (!two)
            spring_previous_term(p, &t);
        const bool first = k + 2 == p->terms, second = k + 3 == p->terms;
        const double share = k > 0 ? 1 : 0.5, times = k > 0 ? 2 : 1;
        const double weight = two ? (double)s->h / 2 : times * (first ? last : 1) * (double)s->h / p->rho;
        term.coefficient = (scalar)(two      ? 1
                                    : first  ? share * t.d + times * last
                                    : second ? share * t.d - last
                                             : share * t.d);
        term.before_weight = (scalar)(first ? 0 : times);
        term.second_weight = first || second ? 0 : 1;
        term.force_weight = (scalar)weight;
        links.turning_weight = (scalar)(share * t.e / weight);
        m.v = k > 0 ? storage[k % 2] : v1;
        if (!damping_term(s, &links, x, term.before, k > 0 ? kernels->series_term : kernels->last_series_term, &m))
            return false;
        const scalar of_given = term.coefficient + term.before_weight * given[0] - term.second_weight * given[1];
        if (pressed != NULL) {
            pressed->term = m.v;
            pressed->from = k > 0 ? NULL : m.v0;
            pressed->given_weight = k > 0 ? of_given : span * of_given;
            kernels->press_project(pressed);
        }
        given[1] = first ? 1 : given[0];
        given[0] = of_given;
        term.second_before = first ? residual : term.before;
        term.before = m.v;
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------- the step */

/* See above. A callback that uses velocities is called twice, with v0 and with the mean v* of v0 and v1. The kick is
   repeated with its forces at v*. */
SPRING_NOINLINE scene_outcome scene_exponential_leapfrog(scene_step *s)
{
    const common_kernels *const kernels = s->kernels->common;
    const bool collides = s->contacts.setting.count > 0, predicts = scene_callback_uses_velocity(s->scene);
    const scene_outcome failed = {.finite = false};
    scene_motion drift = s->whole, residual = s->whole, end = s->whole;
    drift.drift = end.drift = s->h / 2;
    drift.x = collides ? kick_storage(s, 3) : s->whole.x; /* contacts require x0 */
    residual.v = kick_storage(s, 0);
    residual.force = end.force = s->forces.force;
    scalar *const v1 = collides ? kick_storage(s, 1) : s->whole.v;
    pressed_kick pressed;
    bool presses;
    if (predicts) {
        const size_t bytes = s->scene->layout.axes * s->scene->layout.stride * sizeof(scalar);
        scalar *const of_links = force_at(s, 1 - s->to), *const predicted = kick_storage(s, 1);
        if (!move(s, kernels->drift, &drift))
            return failed;
        evaluate_links(s->kernels, s->links, drift.x, s->whole.v0, &s->forces);
        memcpy(of_links, s->forces.force, bytes);
        call_back(s->scene, drift.x, s->whole.v0, time_at(s, 0.5), s->forces.force);
        if (!move(s, kernels->residual, &residual))
            return failed;
        presses = find_pressed(s, drift.x, residual.v, &pressed);
        if (!kick_exponentially(s, presses ? &pressed : NULL, drift.x, s->h / 2, predicted, NULL, SCALAR_MAX))
            return failed;
        memcpy(s->forces.force, of_links, bytes);
        call_back(s->scene, drift.x, predicted, time_at(s, 0.5), s->forces.force);
        if (!move(s, kernels->residual, &residual))
            return failed;
    } else if (!move_evaluate_move(s, kernels->drift, &drift, s->whole.v0, 0.5, kernels->residual, &residual)) {
        return failed;
    }
    presses = find_pressed(s, drift.x, residual.v, &pressed);
    if (!collides)
        return (scene_outcome){.finite =
                                   kick_exponentially(s, NULL, drift.x, s->h, v1, s->whole.x, s->whole.max_speed)};
    int passes = 0; /* that have changed friction */
    do {
        if (!kick_exponentially(s, presses ? &pressed : NULL, drift.x, s->h, v1, NULL, SCALAR_MAX))
            return failed;
        pressed.term = v1;
    } while (presses &&
             (kernels->press_free(&pressed) || (passes++ < kick_friction_passes && kernels->press_slide(&pressed))));
    if (presses)
        end_pressed(s, &pressed, drift.x, v1);
    const scene_stage kicked = {.v = v1};
    end.stage = &kicked;
    end.contacts = WHOLE_STEP_CONTACTS;
    end.max_speed = SCALAR_MAX; /* of the velocities after damp_bounces() */
    return (scene_outcome){.finite = move(s, kernels->drift_kick_drift, &end) && damp_bounces(s, v1)};
}

#include "../simd/size_end.h"

#endif
