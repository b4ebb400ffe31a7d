/* SPDX-License-Identifier: MIT */
/*
 * Particles that colliders press during an exponential kick (exponential_kick.h).
 *
 * Load      Colliders carry the load of a pressed particle, so damping must not spread it. In the directions in which it
 *           is not free, the particle has a given acceleration, that of the surface, as a pinned particle has. If a
 *           collider pulls a particle in the kick, the kick is repeated with this particle free.
 * Friction  Damping spreads friction over the body, so friction must act in the kick. If it acted only after the kick, on
 *           the particles that touch, the links would yield in every step, and a heavy body would push its feet apart
 *           and gain energy. Particles that friction may hold are held. After the kick, those whose friction exceeds its
 *           limit slide. Those that slide have friction of `coefficient` times their load, against their mean velocity.
 *           The kick is repeated until friction fits the load, at most kick_friction_passes times.
 * Energy    Friction f changes the energy of exponential_kick.h by h f.(v0 + v1)/2, which is not positive.
 * After     Contacts are computed after the kick. They receive the loads of pressed particles and remove them again; they
 *           add no friction to particles that slide.
 */
#ifndef SPRINGSTEP_PRESSED_H
#define SPRINGSTEP_PRESSED_H

#include "pass.h"

#include <math.h>

#include "../simd/size_begin.h"

enum { kick_friction_passes = 4 };

/* Friction differs from its limit by at most this part of it, unless all passes are used. */
static const double friction_tolerance = 0.001;

/* A particle that this fraction of the velocity by its load takes away from a collider returns within half of the step. */
static const scalar returning = (scalar)0.25;

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

/* --------------------------------------------------------------------------------------------------------- detection */

/* How one surface presses a particle. */
typedef struct pressing {
    unsigned collider;
    scalar normal[3];
    scalar u[3]; /* [m/s] its velocity relative to the surface */
    bool holds;  /* it does not slide now, and static friction is larger than its residual along the surface */
} pressing;

/* Whether this is the first step after colliders were set: no step has recorded which particles touch them. */
static inline bool touching_is_unknown(const scene_step *s)
{
    return s->contacts.setting.count > 0 && elapsed_at(s, 0) == 0;
}

/* Whether particles that leave a collider may return within half of the step and press it: after colliders were set, since
   their pose may differ a little from the last one, and after bounces. */
static inline bool may_return(const scene_step *s)
{
    bool may = touching_is_unknown(s);
    for (unsigned k = 0; k < s->contacts.setting.count; k++)
        may = may || s->contacts.setting.body[k].restitution > 0;
    return may;
}

/* Whether the surface of a collider that particle i touches presses it: its residual points into the collider, and it does
   not leave, or returns. It returns only if `alone`: several surfaces would multiply its velocity. */
static inline bool presses(const scene_step *s, const contact_surface *surface, size_t i, const scalar *residual,
                           bool alone, pressing *p)
{
    const size_t stride = s->scene->layout.stride;
    const double n[3] = {surface->normal.x, surface->normal.y, surface->normal.z};
    const double of_surface[3] = {surface->velocity.x, surface->velocity.y, surface->velocity.z};
    double leaving = 0, load = 0, speed = 0, slip = 0, pull = 0;
    for (uint32_t a = 0; a < s->particles.axes; a++) {
        const double v = (double)s->whole.v0[a * stride + i];
        p->normal[a] = (scalar)n[a];
        p->u[a] = (scalar)(v - of_surface[a]);
        leaving += (v - of_surface[a]) * n[a];
        speed += fabs(v) + fabs(of_surface[a]);
        load -= (double)(s->h * residual[a * stride + i]) * n[a];
    }
    for (uint32_t a = 0; a < s->particles.axes; a++) {
        const double along = (double)p->u[a] - leaving * n[a];
        const double force = (double)(s->h * residual[a * stride + i]) + load * n[a];
        slip += along * along;
        pull += force * force;
    }
    const double rounding = 64 * (double)SCALAR_EPSILON * speed, limit = surface->friction * load;
    p->collider = surface->index;
    p->holds = slip <= rounding * rounding && pull <= limit * limit;
    return load > 0 && (leaving <= rounding || (alone && may_return(s) && leaving <= (double)returning * load));
}

/* [m/s] wanted, written: the change of the velocity of particle i in this step with which it neither leaves the surface nor
   slides at the end. Contacts that are computed after the kick have impacts. slip, written: its velocity relative to the
   surface in the middle of the step, if its velocity does not change. Returns the component of `wanted` along the normal. */
static inline scalar wanted_change(const scene_step *s, size_t i, const pressing *by, scalar wanted[3], scalar slip[3])
{
    const size_t stride = s->particles.stride;
    const uint32_t axes = s->particles.axes;
    const vector3 x = load_vector(s->whole.x0 + i, stride, axes), v = load_vector(s->whole.v0 + i, stride, axes);
    vector3 mean;
    const vector3 change = spring_contact_velocity_change(&s->contacts.setting.body[by->collider], x,
                                                          vector_plus(x, (double)s->h / 2, v), &mean);
    const double by_surface[3] = {change.x, change.y, change.z}, until_middle[3] = {mean.x, mean.y, mean.z};
    scalar leaving = 0, along = 0;
    for (uint32_t a = 0; a < axes; a++)
        leaving += by->u[a] * by->normal[a];
    for (uint32_t a = 0; a < axes; a++) {
        slip[a] = by->u[a] - (scalar)until_middle[a];
        wanted[a] = (scalar)by_surface[a] - by->u[a] + (leaving < 0 ? leaving : 0) * by->normal[a];
        along += wanted[a] * by->normal[a];
    }
    return along;
}

/* Takes away the freedom of a particle along a further normal, unless it is nearly parallel to the others. change: [m/s]
   along the normal */
static inline void add_normal(const scene_step *s, pressed_particle *p, const scalar normal[3], scalar change)
{
    const scalar parallel = (scalar)1e-3; /* sine */
    const uint32_t axes = s->particles.axes;
    scalar free[3] = {normal[0], normal[1], axes > 2 ? normal[2] : 0};
    free_component(p, axes, free);
    const double size = spring_sqrt((double)(free[0] * free[0] + free[1] * free[1] + free[2] * free[2]));
    if (size < (double)parallel)
        return;
    for (uint32_t a = 0; a < axes; a++)
        change -= s->h * p->given[a] * normal[a];
    for (uint32_t a = 0; a < axes; a++)
        p->given[a] += change / (s->h * (scalar)(size * size)) * free[a];
    if (p->freedom == FREE_ALONG_LINE || axes == 2) {
        p->freedom = HELD;
        return;
    }
    const scalar n[3] = {p->line[0], p->line[1], p->line[2]};
    for (int a = 0; a < 3; a++)
        p->line[a] = (n[(a + 1) % 3] * free[(a + 2) % 3] - n[(a + 2) % 3] * free[(a + 1) % 3]) / (scalar)size;
    p->freedom = FREE_ALONG_LINE;
}

/* A particle that one surface presses. */
static inline void begin_pressed(const scene_step *s, pressed_particle *p, size_t i, const pressing *by)
{
    const scalar *const each = scene_read(s->scene, ARRAY_FRICTION);
    *p = (pressed_particle){.particle = (uint32_t)i, .freedom = FREE_IN_PLANE, .collider = by->collider};
    p->coefficient = s->contacts.setting.body[by->collider].friction * (each != NULL ? (double)each[i] : 1);
    const scalar change = wanted_change(s, i, by, p->wanted, p->slip);
    for (uint32_t a = 0; a < s->particles.axes; a++) {
        p->line[a] = p->outwards[a] = by->normal[a];
        p->given[a] = change / s->h * by->normal[a];
        p->wanted[a] -= change * by->normal[a];
    }
    free_component(p, s->particles.axes, p->slip);
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
   that moves in its frame. The friction of several surfaces acts after the kick, unless it holds the particle. */
SPRING_NOINLINE bool find_pressing_surfaces(const scene_step *s, size_t i, const scalar *residual, pressed_particle *p)
{
    unsigned count = 0;
    bool held = false;
    contact_surface surface[most_surfaces];
    const unsigned surfaces = surfaces_at(s, s->contacts.touched_before[i], i, false, s->whole.x0, surface);
    for (unsigned k = 0; k < surfaces; k++) {
        pressing by = {.holds = false};
        scalar wanted[3] = {0}, slip[3] = {0};
        if (!presses(s, &surface[k], i, residual, count == 0, &by))
            continue;
        held = held || by.holds;
        if (count++ == 0) {
            begin_pressed(s, p, i, &by);
            continue;
        }
        add_normal(s, p, by.normal, wanted_change(s, i, &by, wanted, slip));
        for (uint32_t a = 0; a < s->particles.axes; a++)
            p->outwards[a] += by.normal[a];
    }
    if (count > 1) {
        p->coefficient = 0;
        p->freedom = held ? HELD : p->freedom;
    }
    return count > 0;
}

/* Finds the particles of a chunk that touch colliders, or are so near that their load, as r->step moves them, reaches one. */
SPRING_NOINLINE void find_touching(const scene_step *s, candidate_chunk *r)
{
    const scene_contacts *const t = &s->contacts;
    const size_t stride = s->particles.stride;
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
        particle.x0 = load_vector(s->whole.x0 + i, stride, s->particles.axes);
        const vector3 way = vector_minus(load_vector(r->step->x + i, stride, s->particles.axes), particle.x0);
        const double reach = spring_sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
        for (unsigned c = 0; c < t->setting.count; c++)
            if ((r->candidate[k] >> c & 1) != 0 &&
                spring_contact_touches(&t->setting, &particle, &t->setting.body[c], reach))
                touched[k] |= UINT32_C(1) << c;
    }
}

/* Finds the pressed particles of a chunk. The residual is v of the motion m. */
SPRING_NOINLINE void find_pressed_from(const scene_step *s, const scene_motion *m, size_t from, pressed_list *found)
{
    candidate_chunk r;
    kept_motion kept;
    scalar vector[6][contact_chunk]; /* `normal` and `u` of pressing */
    const size_t left = s->particles.count - from;
    const bool unknown = touching_is_unknown(s);
    begin_rest(&s->contacts, &s->particles, m, &kept, from, left < contact_chunk ? left : contact_chunk, &r);
    if (unknown)
        find_touching(s, &r);
    if (list_touching(s->scene, &r, s->contacts.touched_before + from) == 0)
        return;
    r.change = vector[0];
    r.place = m->x0 + from;
    r.returning = may_return(s) ? returning : 0;
    s->kernels->common->find_pressing(&r);
    for (uint32_t l = 0; l < r.listed; l++) {
        const size_t k = r.list[l];
        pressed_particle *const p = &found->list[found->count];
        pressing by = {.collider = 0};
        if (r.done[k] == 0) {
            found->count += find_pressing_surfaces(s, from + k, m->v, p);
            continue;
        }
        if ((r.done[k] & RESTS_PRESSED) == 0)
            continue;
        while (r.candidate[k] != UINT32_C(1) << by.collider)
            by.collider++;
        for (uint32_t a = 0; a < s->particles.axes; a++) {
            by.normal[a] = vector[a][k];
            by.u[a] = vector[3 + a][k];
        }
        begin_pressed(s, p, from + k, &by);
        found->count++;
    }
}

/* ---------------------------------------------------------------------------------------------------------- friction */

/* The factor of a force in the kick: 1/mass, and less with drag. */
static inline double kick_weight(const scene_step *s, size_t i)
{
    const double inverse_mass = inverse_mass_at(s->scene, i), q = (double)(s->h * s->particles.drag) * inverse_mass;
    return inverse_mass / (1 + q * (0.5 + q / (12 + 2 * q)));
}

/* Evaluates the damping forces in the residual. x: positions of the kick */
static inline void evaluate_damping(scene_step *s, const scalar *x)
{
    scene_links links = *s->links;
    links.terms = DAMPING_TERM;
    links.turning_weight = (scalar)-0.5;
    evaluate_links(s->kernels, &links, x, s->whole.v0, &s->forces);
}

/* Replaces the residual of a particle, without its colliders, by its free component, friction and the given acceleration. */
static inline void set_residual(const scene_step *s, pressed_particle *p, const scalar full[3], scalar *residual)
{
    scalar free[3] = {full[0], full[1], full[2]};
    free_component(p, s->particles.axes, free);
    for (uint32_t a = 0; a < s->particles.axes; a++) {
        const scalar left = free[a] + (p->friction / s->h * p->against[a] + p->given[a]);
        p->taken[a] = full[a] - left;
        residual[a * s->scene->layout.stride + p->particle] = left;
    }
}

/* The residual of a particle without its colliders. */
static inline void full_residual(const scene_step *s, const pressed_particle *p, const scalar *residual, scalar full[3])
{
    for (uint32_t a = 0; a < s->particles.axes; a++)
        full[a] = residual[a * s->scene->layout.stride + p->particle] + p->taken[a];
}

/* Lets friction of `size` act against a velocity. Friction beyond the size of this velocity would reverse it. */
static inline void slide_against(pressed_particle *p, uint32_t axes, const scalar velocity[3], double size)
{
    double square = 0;
    for (uint32_t a = 0; a < axes; a++)
        square += (double)(velocity[a] * velocity[a]);
    p->most_friction = spring_sqrt(square);
    p->friction = (scalar)fmin(size, p->most_friction);
    for (uint32_t a = 0; a < axes; a++)
        p->against[a] = square > 0 ? -velocity[a] / (scalar)p->most_friction : 0;
}

/* Holds the particles that friction may stop in this step, and lets the others slide. The load without damping decides,
   because with damping at v0 it may be many times larger than its mean. x: positions of the kick */
SPRING_NOINLINE void begin_friction(scene_step *s, const pressed_list *pressed, const scalar *x, scalar *residual)
{
    const size_t stride = s->scene->layout.stride;
    const uint32_t axes = s->particles.axes;
    bool known = false; /* the damping forces */
    for (size_t j = 0; j < pressed->count; j++) {
        pressed_particle *const p = &pressed->list[j];
        const size_t i = p->particle;
        scalar full[3] = {0};
        double square = 0, speed = 0, limit = 0;
        for (uint32_t a = 0; a < axes; a++) {
            full[a] = residual[a * stride + i];
            square += (double)(p->wanted[a] * p->wanted[a]);
            speed += fabs((double)s->whole.v0[a * stride + i]);
        }
        const double rounding = 64 * (double)SCALAR_EPSILON * speed;
        bool holds = p->coefficient > 0 && square <= rounding * rounding;
        if (p->coefficient > 0 && !holds) {
            if (!known)
                evaluate_damping(s, x);
            known = true;
            const scalar weight = (scalar)kick_weight(s, i);
            for (uint32_t a = 0; a < axes; a++)
                limit -= (double)((full[a] - weight * s->forces.force[a * stride + i] - p->given[a]) * p->line[a]);
            limit = p->coefficient * (double)s->h * fmax(0, limit);
            holds = square <= limit * limit;
        }
        if (holds) {
            p->freedom = HELD;
            for (uint32_t a = 0; a < axes; a++)
                p->given[a] += p->wanted[a] / s->h;
        } else if (p->coefficient > 0) {
            slide_against(p, axes, p->slip, limit);
        }
        set_residual(s, p, full, residual);
    }
}

/* Changes the friction of a particle after a kick with the result v1, if it does not fit its limit. Returns whether it
   has. */
static inline bool correct_friction(const scene_step *s, pressed_particle *p, const scalar *v1)
{
    const size_t stride = s->scene->layout.stride;
    const uint32_t axes = s->particles.axes;
    scalar load = 0, given = 0, along = 0, held[3] = {0}, moves[3] = {0};
    double square = 0, mean_square = 0;
    for (uint32_t a = 0; a < axes; a++) {
        load -= p->removed[a] * p->line[a];
        given += p->given[a] * p->line[a];
    }
    const double limit = p->coefficient * fmax(0, (double)load);
    for (uint32_t a = 0; a < axes; a++) {
        held[a] = p->removed[a] + load * p->line[a]; /* the velocity that static friction took */
        square += (double)(held[a] * held[a]);
        /* twice the mean velocity along the surface */
        moves[a] = v1[a * stride + p->particle] - s->whole.v0[a * stride + p->particle] - s->h * given * p->line[a] +
                   2 * p->slip[a];
        along += p->against[a] * moves[a];
        mean_square += (double)(moves[a] * moves[a]);
    }
    if (p->freedom == HELD) {
        if (square <= limit * limit)
            return false;
        p->freedom = FREE_IN_PLANE;
        for (uint32_t a = 0; a < axes; a++)
            p->given[a] = given * p->line[a];
        slide_against(p, axes, held, limit);
        return true;
    }
    if (along > 0 && p->friction > 0) { /* it pushes the particle */
        if (p->reversed)
            p->most_friction = (double)p->friction / 2;
        else
            slide_against(p, axes, moves, limit);
        p->friction = (scalar)fmin((double)p->friction, p->most_friction);
        p->reversed = true;
        return true;
    }
    const double friction = fmin(limit, p->most_friction);
    const double across = mean_square - (double)along * (double)along, least = friction_tolerance * friction_tolerance;
    const bool turns = 4 * limit < p->most_friction && across > least * mean_square && across < 0.75 * mean_square;
    if (!turns && fabs(friction - (double)p->friction) <= friction_tolerance * limit)
        return false;
    for (uint32_t a = 0; a < axes && turns; a++)
        p->against[a] = -moves[a] / (scalar)spring_sqrt(mean_square);
    p->friction = (scalar)friction;
    return true;
}

/* Whether friction has changed after a kick with the result v1, so that the kick must be repeated. */
SPRING_NOINLINE bool change_friction(const scene_step *s, const pressed_list *pressed, const scalar *v1,
                                     scalar *residual)
{
    bool changed = false;
    for (size_t j = 0; j < pressed->count; j++) {
        pressed_particle *const p = &pressed->list[j];
        scalar full[3] = {0};
        if (p->coefficient == 0)
            continue;
        full_residual(s, p, residual, full);
        if (!correct_friction(s, p, v1))
            continue;
        set_residual(s, p, full, residual);
        changed = true;
    }
    return changed;
}

/* ---------------------------------------------------------------------------------------------------- around the kick */

/* load, written: the residual without damping, which at v0 may be many times larger than its mean. there, written: where
   it takes the particles in half of the step. x: positions of the kick */
SPRING_NOINLINE void find_loads(scene_step *s, const scalar *x, const scalar *residual, scalar *load, scalar *there)
{
    evaluate_damping(s, x);
    for (uint32_t a = 0; a < s->particles.axes; a++)
        for (size_t i = 0; i < s->particles.count; i++) {
            const size_t j = a * s->particles.stride + i;
            load[j] = residual[j] - (scalar)kick_weight(s, i) * s->forces.force[j];
            there[j] = s->whole.x0[j] + s->h * s->h / 8 * load[j];
        }
}

/* Finds the pressed particles, and takes their loads out of the residual. x: positions of the kick */
static inline pressed_list find_pressed(scene_step *s, const scalar *x, scalar *residual)
{
    pressed_list found = {.list = scene_memory(s->scene, ARRAY_PRESSED)};
    scene_motion start = s->whole;
    start.v = residual;
    start.force = s->forces.force;
    if (may_return(s)) {
        find_loads(s, x, residual, kick_storage(s, 1), kick_storage(s, 2));
        start.v = kick_storage(s, 1);
        start.x = kick_storage(s, 2);
    }
    if (touching_is_unknown(s))
        s->contacts.touched_before = s->contacts.touched;
    for (size_t i = 0; s->contacts.setting.count > 0 && i < s->particles.count; i += contact_chunk)
        find_pressed_from(s, &start, i, &found);
    if (found.count > 0)
        begin_friction(s, &found, x, residual);
    return found;
}

/* Gives the components of b - from in which pressed particles are not free the value given_weight times the given
   acceleration. from: NULL: 0, and b is a term of the series. A vector that is removed from a term b_k lowers the result
   b_0 by the same vector, apart from its damping forces, because 2 b_{k+1} - b_{k+2} continues a difference linearly. So
   p->removed is the sum of these vectors until the last term, where it becomes the change of the velocity. */
SPRING_NOINLINE void project_pressed(const scene_step *s, const pressed_list *pressed, const scalar *from,
                                     scalar given_weight, scalar *b)
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
            const scalar change = vector[a] + given_weight * p->given[a];
            const scalar end = change + (from != NULL ? from[a * stride + p->particle] : 0);
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

/* Gives each pressed particle back the load that its colliders took from its velocity v1 in the kick. The contacts that
   are computed next remove it again, with friction except for particles that slid in the kick. x: positions of the kick */
static inline void restore_loads(scene_step *s, const pressed_list *pressed, const scalar *x, scalar *v1)
{
    const scene_particles *const p = &s->particles;
    const scalar *const each = s->contacts.friction;
    scalar *const friction = kick_storage(s, 2);
    for (size_t i = 0; i < p->count; i++)
        friction[i] = each != NULL ? each[i] : 1;
    s->contacts.friction = friction;
    for (size_t j = 0; j < pressed->count; j++) {
        pressed_particle *const one = &pressed->list[j];
        const scalar along = removed_outwards(s, one);
        scalar square = 0;
        if (one->coefficient > 0 && one->freedom != HELD)
            friction[one->particle] = 0;
        for (uint32_t a = 0; a < p->axes; a++)
            square += one->outwards[a] * one->outwards[a];
        for (uint32_t a = 0; a < p->axes; a++) {
            scalar *const v = &v1[a * p->stride + one->particle], before = *v;
            *v += along / square * one->outwards[a];
            one->removed[a] += before - *v;
        }
        record_change(s, one->particle, one->collider, x, vector_from(one->removed));
    }
}

#include "../simd/size_end.h"

#endif
