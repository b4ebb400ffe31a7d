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

#include "pass.h"

#include <math.h>

/* Most of the time of a step is that of its kernels. */
#include "../simd/size_begin.h"

/* ------------------------------------------------------------------------------------------------ pressed particles */

typedef struct pressed_list {
    pressed_particle *list;
    size_t count;
} pressed_list;

/* The component of a vector in which a pressed particle is free. */
static inline void free_component(const pressed_particle *p, uint32_t axes, scalar vector[3])
{
    scalar along = 0;
    for (uint32_t a = 0; a < axes; a++)
        along += vector[a] * p->line[a];
    for (uint32_t a = 0; a < axes; a++)
        vector[a] = p->freedom == HELD              ? 0
                    : p->freedom == FREE_ALONG_LINE ? along * p->line[a]
                                                    : vector[a] - along * p->line[a];
}

/* Takes away the freedom of a particle along a further normal, unless it is nearly parallel to the others. */
static inline void add_normal(pressed_particle *p, uint32_t axes, const scalar normal[3])
{
    const scalar parallel = (scalar)1e-3; /* sine */
    scalar free[3] = {normal[0], normal[1], axes > 2 ? normal[2] : 0};
    free_component(p, axes, free);
    const double size = spring_sqrt((double)(free[0] * free[0] + free[1] * free[1] + free[2] * free[2]));
    if (size < (double)parallel)
        return;
    if (p->freedom == FREE_ALONG_LINE || axes == 2) {
        p->freedom = HELD;
        return;
    }
    const scalar n[3] = {p->line[0], p->line[1], p->line[2]};
    for (int a = 0; a < 3; a++)
        p->line[a] = (n[(a + 1) % 3] * free[(a + 2) % 3] - n[(a + 2) % 3] * free[(a + 1) % 3]) / (scalar)size;
    p->freedom = FREE_ALONG_LINE;
}

/* How a collider that particle i touched in the last step acts on it. It presses if the particle does not leave the
   surface, and its residual points into the collider. Static friction holds a pressed particle that does not slide.
   sliding, written: [m/s] its velocity along the surface */
typedef enum pressing { NOT_PRESSED, PRESSED, PRESSED_AND_HELD } pressing;

static inline pressing pressing_of(const scene_step *s, const contact_surface *surface, size_t i,
                                   const scalar *residual, scalar normal[3], scalar sliding[3])
{
    const size_t stride = s->scene->layout.stride;
    const uint32_t axes = s->particles.axes;
    const double n[3] = {surface->normal.x, surface->normal.y, surface->normal.z};
    const double of_surface[3] = {surface->velocity.x, surface->velocity.y, surface->velocity.z};
    double leaving = 0, pressed = 0, speed = 0;
    for (uint32_t a = 0; a < axes; a++) {
        const double v = (double)s->whole.v0[a * stride + i];
        normal[a] = (scalar)n[a];
        leaving += (v - of_surface[a]) * n[a];
        speed += fabs(v) + fabs(of_surface[a]);
        pressed -= (double)residual[a * stride + i] * n[a];
    }
    const double rounding = 64 * (double)SCALAR_EPSILON * speed, limit = surface->friction * pressed;
    if (!(pressed > 0) || leaving > rounding)
        return NOT_PRESSED;
    double speed_square = 0, pull_square = 0;
    for (uint32_t a = 0; a < axes; a++) {
        const double along = (double)s->whole.v0[a * stride + i] - of_surface[a] - leaving * n[a];
        const double force = (double)residual[a * stride + i] + pressed * n[a];
        speed_square += along * along;
        pull_square += force * force;
        sliding[a] = (scalar)along;
    }
    return speed_square <= rounding * rounding && pull_square <= limit * limit ? PRESSED_AND_HELD : PRESSED;
}

/* The surfaces of the colliders with these bits that particle i touches at x. Returns their number. */
static inline unsigned surfaces_at(const scene_step *s, uint32_t touched, size_t i, bool at_end, const scalar *x,
                                   contact_surface surface[most_surfaces])
{
    const contact_setting *const t = &s->contacts.setting;
    contact_particle particle = {.touched = touched};
    scene_contact_particle(s->scene, i, &particle);
    return spring_contact_surfaces(t->body, t->count, &particle, at_end,
                                   load_vector(x + i, s->particles.stride, s->particles.axes), t->epsilon, surface);
}

/* Whether particle i is pressed, and how: for a particle that touches several colliders, a custom body, or a surface
   that moves in its frame. */
SPRING_NOINLINE bool find_pressing_surfaces(const scene_step *s, size_t i, const scalar *residual, pressed_particle *p)
{
    const uint32_t axes = s->particles.axes;
    bool pressed = false;
    contact_surface surface[most_surfaces];
    const unsigned surfaces = surfaces_at(s, s->contacts.touched_before[i], i, false, s->whole.x0, surface);
    for (unsigned k = 0; k < surfaces; k++) {
        scalar normal[3] = {0}, sliding[3] = {0};
        const pressing how = pressing_of(s, &surface[k], i, residual, normal, sliding);
        if (how == NOT_PRESSED)
            continue;
        if (pressed)
            add_normal(p, axes, normal);
        else
            *p = (pressed_particle){.line = {normal[0], normal[1], normal[2]},
                                    .friction = {sliding[0], sliding[1], sliding[2]},
                                    .collider = surface[k].index};
        for (uint32_t a = 0; a < axes; a++)
            p->outwards[a] += normal[a];
        if (how == PRESSED_AND_HELD)
            p->freedom = HELD;
        pressed = true;
    }
    return pressed;
}

/* Whether this is the first step after colliders were set: no step has recorded which particles touch them. */
static inline bool touching_is_unknown(const scene_step *s)
{
    return s->contacts.setting.count > 0 && elapsed_at(s, 0) == 0;
}

/* Finds the particles of a chunk that touch colliders. r->step is a motion with x = x0. */
SPRING_NOINLINE void find_touching(const scene_step *s, candidate_chunk *r)
{
    const scene_contacts *const t = &s->contacts;
    uint32_t *const touched = t->touched + r->first;
    s->kernels->common->keep_motion(&s->particles, r->step, r->first, r->count, r->kept);
    memset(touched, 0, r->count * sizeof *touched);
    if (!s->kernels->common->find_near(r))
        return;
    apply_masks(s->scene, r);
    for (uint32_t l = 0; l < r->listed; l++) {
        const size_t k = r->list[l], i = r->first + k;
        contact_particle particle;
        scene_contact_particle(s->scene, i, &particle);
        particle.x0 = load_vector(s->whole.x0 + i, s->particles.stride, s->particles.axes);
        for (unsigned c = 0; c < t->setting.count; c++)
            if ((r->candidate[k] >> c & 1) != 0 && spring_contact_touches(&t->setting, &particle, &t->setting.body[c]))
                touched[k] |= UINT32_C(1) << c;
    }
}

/* The factor of a force in the kick: 1/mass, and less with drag. */
static inline double kick_weight(const scene_step *s, size_t i)
{
    const double inverse_mass = inverse_mass_at(s->scene, i), q = (double)(s->h * s->particles.drag) * inverse_mass;
    return inverse_mass / (1 + q * (0.5 + q / (12 + 2 * q)));
}

/* Finds the pressed particles of a chunk, and takes their loads out of the residual, which is v of the motion m. */
SPRING_NOINLINE void find_pressed_from(const scene_step *s, const scene_motion *m, size_t from, pressed_list *found)
{
    candidate_chunk r;
    kept_motion kept;
    scalar vector[6][contact_chunk]; /* normals, and velocities along the surface */
    const size_t left = s->particles.count - from, stride = s->scene->layout.stride;
    const uint32_t axes = s->particles.axes;
    begin_rest(s->scene, &s->contacts, &s->particles, m, &kept, from, left < contact_chunk ? left : contact_chunk, &r);
    if (touching_is_unknown(s))
        find_touching(s, &r);
    if (list_touching(s->scene, &r, s->contacts.touched_before + from) == 0)
        return;
    r.change = vector[0];
    r.place = m->x0 + from;
    s->kernels->common->find_pressing(&r);
    for (uint32_t l = 0; l < r.listed; l++) {
        const size_t k = r.list[l], i = from + k;
        pressed_particle *const p = &found->list[found->count];
        if ((r.done[k] & RESTS_PRESSED) != 0) {
            *p = (pressed_particle){.freedom = (r.done[k] & RESTS_HELD) != 0 ? HELD : FREE_IN_PLANE};
            for (uint32_t a = 0; a < axes; a++) {
                p->line[a] = p->outwards[a] = vector[a][k];
                p->friction[a] = vector[3 + a][k];
            }
            while (r.candidate[k] != UINT32_C(1) << p->collider)
                p->collider++;
        } else if (r.done[k] != 0 || !find_pressing_surfaces(s, i, m->v, p)) {
            continue;
        }
        p->particle = (uint32_t)i;
        scalar free[3];
        for (uint32_t a = 0; a < axes; a++)
            free[a] = m->v[a * stride + i];
        free_component(p, axes, free);
        for (uint32_t a = 0; a < axes; a++) {
            p->taken[a] = m->v[a * stride + i] - free[a];
            m->v[a * stride + i] = free[a];
        }
        found->count++;
    }
}

/* The friction that would stop a particle in the step, or as much of it as its collider can give. load: [m/s^2] its
   residual without damping */
static inline void set_friction(const scene_step *s, pressed_particle *p, double coefficient, const scalar load[3])
{
    const uint32_t axes = s->particles.axes;
    scalar pressed = 0;
    double square = 0;
    for (uint32_t a = 0; a < axes; a++)
        pressed -= load[a] * p->line[a];
    for (uint32_t a = 0; a < axes; a++) {
        p->friction[a] = -(load[a] + pressed * p->line[a] + p->friction[a] / s->h);
        square += (double)p->friction[a] * (double)p->friction[a];
    }
    const double limit = pressed > 0 ? coefficient * (double)pressed : 0;
    const scalar fraction = (scalar)(square > limit * limit ? limit / spring_sqrt(square) : 1);
    for (uint32_t a = 0; a < axes; a++)
        p->friction[a] *= fraction;
}

/* Lets friction act in the kick on pressed particles that it does not hold, so that damping spreads it over the body.
   If it acted only after the kick, on the particles that touch, a body could creep down a slope, or stop before its
   forces are in balance. Its limit follows from the load without damping, because with damping at v0 the load may be
   many times larger than its mean. x: positions of the kick */
SPRING_NOINLINE void add_friction(scene_step *s, const pressed_list *pressed, const scalar *x, scalar *residual)
{
    const scalar *const each = scene_read(s->scene, ARRAY_FRICTION);
    const size_t stride = s->scene->layout.stride;
    scene_links links = *s->links;
    bool known = false; /* the damping forces */
    links.terms = DAMPING_TERM;
    links.turning_weight = (scalar)-0.5; /* as in the residual */
    for (size_t j = 0; j < pressed->count; j++) {
        pressed_particle *const p = &pressed->list[j];
        const size_t i = p->particle;
        const double coefficient =
            s->contacts.setting.body[p->collider].friction * (each != NULL ? (double)each[i] : 1);
        if (p->freedom != FREE_IN_PLANE || coefficient == 0) {
            memset(p->friction, 0, sizeof p->friction);
            continue;
        }
        if (!known)
            evaluate_links(s->kernels, &links, x, s->whole.v0, &s->forces);
        known = true;
        const scalar weight = (scalar)kick_weight(s, i);
        scalar load[3];
        for (uint32_t a = 0; a < s->particles.axes; a++)
            load[a] = residual[a * stride + i] + p->taken[a] - weight * s->forces.force[a * stride + i];
        set_friction(s, p, coefficient, load);
        for (uint32_t a = 0; a < s->particles.axes; a++) {
            residual[a * stride + i] += p->friction[a];
            p->taken[a] -= p->friction[a];
        }
    }
}

static inline pressed_list find_pressed(scene_step *s, const scalar *x, scalar *residual)
{
    pressed_list found = {.list = scene_memory(s->scene, ARRAY_PRESSED)};
    scene_motion start = s->whole;
    start.v = residual;
    start.x = (scalar *)start.x0; /* which is not written to */
    start.force = s->forces.force;
    if (touching_is_unknown(s))
        s->contacts.touched_before = s->contacts.touched;
    for (size_t i = 0; s->contacts.setting.count > 0 && i < s->particles.count; i += contact_chunk)
        find_pressed_from(s, &start, i, &found);
    add_friction(s, &found, x, residual);
    return found;
}

/* Removes the components of b - from in which pressed particles are not free. from: NULL: 0, and b is a term of the
   series. A vector that is removed from a term b_k lowers the result b_0 by the same vector, apart from its damping
   forces, because 2 b_{k+1} - b_{k+2} continues a difference linearly. So p->removed is the sum of these vectors
   until the last term, where it becomes the change of the velocity. */
SPRING_NOINLINE void project_pressed(const scene_step *s, const pressed_list *pressed, const scalar *from, scalar *b)
{
    const size_t stride = s->scene->layout.stride;
    for (size_t j = 0; j < pressed->count; j++) {
        pressed_particle *const p = &pressed->list[j];
        scalar vector[3];
        for (uint32_t a = 0; a < s->particles.axes; a++)
            vector[a] = b[a * stride + p->particle] - (from != NULL ? from[a * stride + p->particle] : 0);
        free_component(p, s->particles.axes, vector);
        for (uint32_t a = 0; a < s->particles.axes; a++) {
            scalar *const at = &b[a * stride + p->particle];
            const scalar end = vector[a] + (from != NULL ? from[a * stride + p->particle] : 0);
            p->removed[a] = (from != NULL ? s->h * p->removed[a] : p->removed[a]) + (*at - end);
            *at = end;
        }
    }
}

/* The component of what was removed from a particle along its normals; positive if colliders pulled it. */
static inline scalar removed_outwards(const scene_step *s, const pressed_particle *p)
{
    scalar along = 0;
    for (uint32_t a = 0; a < s->particles.axes; a++)
        along += p->outwards[a] * p->removed[a];
    return along;
}

/* After a kick, removes the particles from the list that colliders have pulled, so that the kick can be repeated with
   them free. Returns whether there are any: the list becomes shorter each time. If colliders pulled particles, friction
   of the others would exceed its limit. */
static inline bool free_pulled(const scene_step *s, pressed_list *pressed, scalar *residual)
{
    const size_t count = pressed->count;
    pressed->count = 0;
    for (size_t j = 0; j < count; j++) {
        const pressed_particle *const p = &pressed->list[j];
        if (removed_outwards(s, p) <= 0)
            pressed->list[pressed->count++] = *p;
        else
            for (uint32_t a = 0; a < s->particles.axes; a++)
                residual[a * s->scene->layout.stride + p->particle] += p->taken[a];
    }
    return pressed->count < count;
}

/* Adds to collider k the impulse of particle i, whose velocity at x decreases by `removed`. */
static inline void record_change(const scene_step *s, size_t i, unsigned k, const scalar *x, vector3 removed)
{
    contact_particle particle;
    const vector3 at = load_vector(x + i, s->particles.stride, s->particles.axes), zero = {0, 0, 0};
    scene_contact_particle(s->scene, i, &particle);
    spring_contact_record(&s->contacts.setting, &particle, k, &at, &removed, &at, &zero);
}

/* Gives each pressed particle back what its colliders took from its velocity v1 in the kick: the load, and friction. The
   contacts that are computed next remove the load again, with the friction that belongs to it. x: positions of the kick */
static inline void restore_loads(const scene_step *s, const pressed_list *pressed, const scalar *x, scalar *v1)
{
    const scene_particles *const p = &s->particles;
    for (size_t j = 0; j < pressed->count; j++) {
        pressed_particle *const one = &pressed->list[j];
        const scalar along = removed_outwards(s, one);
        scalar square = 0;
        for (uint32_t a = 0; a < p->axes; a++)
            square += one->outwards[a] * one->outwards[a];
        for (uint32_t a = 0; a < p->axes; a++) {
            scalar *const v = &v1[a * p->stride + one->particle], before = *v;
            *v -= s->h * one->friction[a];
            *v += along / square * one->outwards[a];
            one->removed[a] += before - *v;
        }
        record_change(s, one->particle, one->collider, x, vector_from(one->removed));
    }
}

/* Reduces the velocities with which particles leave colliders with restitution. The kick before this impact has not
   damped them, and the next would be too late: a body would bounce in every step, and gain elastic energy. */
SPRING_NOINLINE void damp_bounces(const scene_step *s)
{
    const scalar *const remaining = scene_read(s->scene, ARRAY_SUMS);
    const size_t stride = s->scene->layout.stride;
    const uint32_t axes = s->particles.axes;
    for (unsigned k = 0; k < s->contacts.setting.count; k++) {
        const uint32_t bit = UINT32_C(1) << k;
        for (size_t i = 0; s->contacts.setting.body[k].restitution > 0 && i < s->particles.count; i++) {
            if ((s->contacts.touched[i] & bit) == 0 || remaining[i] == 1)
                continue;
            contact_surface surface[most_surfaces];
            const unsigned surfaces = surfaces_at(s, bit, i, true, s->whole.x, surface);
            for (unsigned j = 0; j < surfaces; j++) {
                const vector3 v = load_vector(s->whole.v + i, stride, axes), n = surface[j].normal,
                              u = vector_minus(v, surface[j].velocity);
                const double leaving = u.x * n.x + u.y * n.y + u.z * n.z;
                const double removed = (1 - (double)remaining[i]) * leaving;
                if (!(leaving > 0))
                    continue;
                /* the friction of a sliding particle decreases with the load */
                const vector3 sliding = vector_plus(u, -leaving, n);
                const double speed = spring_sqrt(sliding.x * sliding.x + sliding.y * sliding.y + sliding.z * sliding.z);
                const double returned = speed > 0 ? surface[j].friction * removed / speed : 0;
                const vector3 change = vector_plus(vector_times(removed, n), -returned, sliding);
                store_vector(s->whole.v + i, stride, axes, vector_plus(v, -1, change));
                record_change(s, i, k, s->whole.x, change);
            }
        }
    }
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
   is NULL. Returns false if a result is not finite, or faster than max_speed. */
static inline bool kick_exponentially(scene_step *s, const pressed_list *pressed, const scalar *x, scalar span,
                                      scalar *v1, scalar *x1, scalar max_speed)
{
    const common_kernels *const kernels = s->kernels->common;
    const damping_series *const p = &s->damping;
    scalar *const residual = kick_storage(s, 0), *const storage[] = {kick_storage(s, 1), kick_storage(s, 2)};
    scene_links links = *s->links;
    for (size_t j = 0; j < pressed->count; j++)
        memcpy(pressed->list[j].removed, pressed->list[j].taken, sizeof pressed->list[j].removed);
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
        project_pressed(s, pressed, k > 0 ? NULL : m.v0, m.v);
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
    pressed_list pressed;
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
        pressed = find_pressed(s, drift.x, residual.v);
        if (!kick_exponentially(s, &pressed, drift.x, s->h / 2, predicted, NULL, SCALAR_MAX))
            return failed;
        memcpy(s->forces.force, of_links, bytes);
        call_back(s->scene, drift.x, predicted, time_at(s, 0.5), s->forces.force);
        if (!move(s, kernels->residual, &residual))
            return failed;
    } else if (!move_evaluate_move(s, kernels->drift, &drift, s->whole.v0, 0.5, kernels->residual, &residual)) {
        return failed;
    }
    pressed = find_pressed(s, drift.x, residual.v);
    if (!collides)
        return (scene_outcome){.finite =
                                   kick_exponentially(s, &pressed, drift.x, s->h, v1, s->whole.x, s->whole.max_speed)};
    do {
        if (!kick_exponentially(s, &pressed, drift.x, s->h, v1, NULL, SCALAR_MAX))
            return failed;
    } while (free_pulled(s, &pressed, residual.v));
    if (pressed.count > 0)
        restore_loads(s, &pressed, drift.x, v1);
    const scene_stage kicked = {.v = v1};
    end.stage = &kicked;
    end.contacts = WHOLE_STEP_CONTACTS;
    if (!move(s, kernels->drift_kick_drift, &end))
        return failed;
    damp_bounces(s);
    return (scene_outcome){.finite = true};
}

#include "../simd/size_end.h"

#endif
