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

/* A particle that this fraction of the velocity by its load takes away from a collider returns within half of the step. */
static const scalar returning = (scalar)0.25;

/* Component a of a value of particle i. */
static inline scalar *pressed_component(const scene_step *s, pressed_value name, size_t i, uint32_t a)
{
    return (scalar *)scene_memory(s->scene, ARRAY_PRESSED) + (name + a) * s->particles.stride + i;
}

static inline freedom freedom_of(const scene_step *s, size_t i)
{
    return (freedom)*pressed_component(s, PRESSED_FREEDOM, i, 0);
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
SPRING_NOINLINE scalar wanted_change(const scene_step *s, size_t i, const pressing *by, scalar wanted[3],
                                     scalar slip[3])
{
    const size_t stride = s->particles.stride;
    const uint32_t axes = s->particles.axes;
    const vector3 x = load_vector(s->whole.x0 + i, stride, axes), v = load_vector(s->whole.v0 + i, stride, axes);
    vector3 mean;
    const vector3 change = spring_contact_velocity_change(&s->contacts.setting.body[by->collider], x,
                                                          vector_plus(x, (double)s->h / 2, v), &mean);
    const double by_surface[3] = {change.x, change.y, change.z}, until_middle[3] = {mean.x, mean.y, mean.z};
    scalar leaving = 0, along = 0;
    for (int a = 0; a < 3; a++)
        leaving += by->u[a] * by->normal[a];
    for (int a = 0; a < 3; a++) {
        slip[a] = by->u[a] - (scalar)until_middle[a];
        wanted[a] = (scalar)by_surface[a] - by->u[a] + (leaving < 0 ? leaving : 0) * by->normal[a];
        along += wanted[a] * by->normal[a];
    }
    return along;
}

/* A particle that one surface presses. */
static inline void press(const scene_step *s, size_t i, const pressing *by)
{
    const scalar *const each = scene_read(s->scene, ARRAY_FRICTION);
    const double coefficient = s->contacts.setting.body[by->collider].friction * (each != NULL ? (double)each[i] : 1);
    scalar wanted[3], slip[3], along = 0;
    const scalar change = wanted_change(s, i, by, wanted, slip);
    *pressed_component(s, PRESSED_FREEDOM, i, 0) = FREE_IN_PLANE;
    *pressed_component(s, PRESSED_COLLIDER, i, 0) = (scalar)by->collider;
    *pressed_component(s, PRESSED_COEFFICIENT, i, 0) = (scalar)coefficient;
    for (int a = 0; a < 3; a++)
        along += slip[a] * by->normal[a];
    for (uint32_t a = 0; a < 3; a++) {
        const scalar n = by->normal[a];
        *pressed_component(s, PRESSED_LINE, i, a) = *pressed_component(s, PRESSED_OUTWARDS, i, a) = n;
        *pressed_component(s, PRESSED_GIVEN, i, a) = change / s->h * n;
        *pressed_component(s, PRESSED_WANTED, i, a) = wanted[a] - change * n;
        *pressed_component(s, PRESSED_SLIP, i, a) = slip[a] - along * n;
    }
}

/* Takes away the freedom of particle i along a further normal, unless it is nearly parallel to the others. */
static inline void add_normal(const scene_step *s, size_t i, const pressing *by)
{
    const scalar parallel = (scalar)1e-3; /* sine */
    const scalar *const normal = by->normal;
    const freedom before = freedom_of(s, i);
    scalar *line[3], free[3], wanted[3], slip[3], along = 0, change = wanted_change(s, i, by, wanted, slip);
    for (uint32_t a = 0; a < 3; a++) {
        line[a] = pressed_component(s, PRESSED_LINE, i, a);
        along += normal[a] * *line[a];
        *pressed_component(s, PRESSED_OUTWARDS, i, a) += normal[a];
    }
    for (int a = 0; a < 3; a++)
        free[a] = before == HELD ? 0 : before == FREE_ALONG_LINE ? along * *line[a] : normal[a] - along * *line[a];
    const double size = spring_sqrt((double)(free[0] * free[0] + free[1] * free[1] + free[2] * free[2]));
    if (size < (double)parallel)
        return;
    for (uint32_t a = 0; a < 3; a++)
        change -= s->h * *pressed_component(s, PRESSED_GIVEN, i, a) * normal[a];
    for (uint32_t a = 0; a < 3; a++)
        *pressed_component(s, PRESSED_GIVEN, i, a) += change / (s->h * (scalar)(size * size)) * free[a];
    const bool held = before == FREE_ALONG_LINE || s->particles.axes == 2;
    *pressed_component(s, PRESSED_FREEDOM, i, 0) = held ? HELD : FREE_ALONG_LINE;
    if (held)
        return;
    const scalar n[3] = {*line[0], *line[1], *line[2]};
    for (int a = 0; a < 3; a++)
        *line[a] = (n[(a + 1) % 3] * free[(a + 2) % 3] - n[(a + 2) % 3] * free[(a + 1) % 3]) / (scalar)size;
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

/* Finds out whether and how particle i is pressed, if it touches several colliders, a custom body, or a surface that moves
   in its frame. The friction of several surfaces acts after the kick, unless it holds the particle. */
SPRING_NOINLINE bool press_by_surfaces(const scene_step *s, size_t i, const scalar *residual)
{
    unsigned count = 0;
    bool held = false;
    contact_surface surface[most_surfaces];
    const unsigned surfaces = surfaces_at(s, s->contacts.touched_before[i], i, false, s->whole.x0, surface);
    for (unsigned k = 0; k < surfaces; k++) {
        pressing by = {.holds = false};
        if (!presses(s, &surface[k], i, residual, count == 0, &by))
            continue;
        held = held || by.holds;
        if (count++ == 0)
            press(s, i, &by);
        else
            add_normal(s, i, &by);
    }
    if (count > 1)
        *pressed_component(s, PRESSED_COEFFICIENT, i, 0) = 0;
    if (count > 1 && held)
        *pressed_component(s, PRESSED_FREEDOM, i, 0) = HELD;
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

/* Finds the pressed particles of a chunk. The residual is v of the motion m. Returns whether there are any. */
SPRING_NOINLINE bool find_pressed_from(const scene_step *s, const scene_motion *m, size_t from)
{
    candidate_chunk r;
    kept_motion kept;
    const size_t left = s->particles.count - from;
    const bool unknown = touching_is_unknown(s);
    bool any = false;
    begin_rest(&s->contacts, &s->particles, m, &kept, from, left < contact_chunk ? left : contact_chunk, &r);
    if (unknown)
        find_touching(s, &r);
    if (list_touching(s->scene, &r, s->contacts.touched_before + from) == 0)
        return false;
    r.pressed = pressed_component(s, PRESSED_FREEDOM, 0, 0);
    r.place = m->x0 + from;
    r.returning = may_return(s) ? returning : 0;
    s->kernels->common->find_pressing(&r);
    for (uint32_t l = 0; l < r.listed; l++) {
        const size_t k = r.list[l];
        any = (r.done[k] == 0 ? press_by_surfaces(s, from + k, m->v) : (r.done[k] & RESTS_PRESSED) != 0) || any;
    }
    return any;
}

/* ---------------------------------------------------------------------------------------------------- around the kick */

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

/* Finds the pressed particles, and takes their loads out of the residual. x: positions of the kick. Returns whether there
   are any. */
static inline bool find_pressed(scene_step *s, const scalar *x, scalar *residual, pressed_kick *kick)
{
    bool any = false;
    *kick = (pressed_kick){&s->particles, .h = s->h, .v0 = s->whole.v0, .residual = residual};
    if (s->contacts.setting.count == 0)
        return false;
    kick->value = scene_memory(s->scene, ARRAY_PRESSED);
    memset(kick->value, 0, s->particles.stride * sizeof(scalar));                                     /* NOT_PRESSED */
    memset(pressed_component(s, PRESSED_AGAINST, 0, 0), 0, 5 * s->particles.stride * sizeof(scalar)); /* to REVERSED */
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
    for (size_t i = 0; i < s->particles.count; i += contact_chunk)
        any = find_pressed_from(s, &start, i) || any;
    if (any && s->kernels->common->press_hold(kick)) {
        evaluate_damping(s, x);
        kick->damping = s->forces.force;
        s->kernels->common->press_hold(kick);
    }
    return any;
}

/* Adds to collider k the impulse of particle i, whose velocity at x decreases by `removed`. */
static inline void record_change(const scene_step *s, size_t i, unsigned k, const scalar *x, vector3 removed)
{
    contact_particle particle;
    const vector3 at = load_vector(x + i, s->particles.stride, s->particles.axes), zero = {0, 0, 0};
    scene_contact_particle(s->scene, i, &particle);
    spring_contact_record(&s->contacts.setting, &particle, k, &at, &removed, &at, &zero);
}

/* Gives pressed particles back their loads in the velocities v1 after the kick, for the contacts that are computed next, and
   records the impulses. x: positions of the kick */
static inline void end_pressed(scene_step *s, pressed_kick *kick, const scalar *x, scalar *v1)
{
    const scalar *const each = s->contacts.friction;
    kick->term = v1;
    kick->friction = kick_storage(s, 2);
    for (size_t i = 0; i < s->particles.count; i++)
        kick->friction[i] = each != NULL ? each[i] : 1;
    s->contacts.friction = kick->friction;
    s->kernels->common->press_restore(kick);
    for (size_t i = 0; i < s->particles.count && s->contacts.setting.records; i++)
        if (freedom_of(s, i) != NOT_PRESSED)
            record_change(s, i, (unsigned)*pressed_component(s, PRESSED_COLLIDER, i, 0), x,
                          load_vector(pressed_component(s, PRESSED_REMOVED, i, 0), s->particles.stride, 3));
}

#include "../simd/size_end.h"

#endif
