/* SPDX-License-Identifier: MIT */
/* Kernels for particles that colliders press during an exponential kick, on SIMD vectors. scene/pressed.h has the method
   and the order of the calls. A lane has a particle at its index; vectors without a pressed particle are left out. */
#ifndef SPRINGSTEP_PRESSED_TMPL_H
#define SPRINGSTEP_PRESSED_TMPL_H

#include "contact_rest_tmpl.h"
#include "particles_tmpl.h"

/* A vector of particles. Values of particles that are not pressed have no meaning. */
typedef struct pressed_lanes {
    const pressed_kick *k;
    size_t i, next;  /* the first particle of this vector, and the one after it */
    lane_mask where; /* pressed particles */
    real freedom;
    real3 line;
} pressed_lanes;

SPRING_CONTACT_INLINE scalar *pressed_at(const pressed_lanes *l, pressed_value name)
{
    return l->k->value + name * l->k->particles->stride + l->i;
}

SPRING_CONTACT_INLINE real pressed_number(const pressed_lanes *l, pressed_value name)
{
    return vec_load(pressed_at(l, name));
}

SPRING_CONTACT_INLINE real3 pressed_vector(const pressed_lanes *l, pressed_value name)
{
    return load_place(pressed_at(l, name), l->k->particles->stride, 3);
}

SPRING_CONTACT_INLINE void put_number(const pressed_lanes *l, pressed_value name, lane_mask where, real value)
{
    vec_store(pressed_at(l, name), select_real(where, value, pressed_number(l, name)));
}

/* of: a quantity of all particles, on their axes */
SPRING_CONTACT_INLINE real3 of_particles(const pressed_lanes *l, const scalar *of)
{
    return load_place(of + l->i, l->k->particles->stride, l->k->particles->axes);
}

SPRING_NOINLINE void put_vector(scalar *at, size_t stride, uint32_t axes, const lane_mask *where, const real3 *value)
{
    const real each[3] = {value->x, value->y, value->z};
    for (uint32_t a = 0; a < axes; a++)
        vec_store(at + a * stride, select_real(*where, each[a], vec_load(at + a * stride)));
}

SPRING_CONTACT_INLINE void put_pressed(const pressed_lanes *l, pressed_value name, lane_mask where, real3 value)
{
    put_vector(pressed_at(l, name), l->k->particles->stride, 3, &where, &value);
}

SPRING_CONTACT_INLINE void put_of_particles(const pressed_lanes *l, scalar *of, lane_mask where, real3 value)
{
    put_vector(of + l->i, l->k->particles->stride, l->k->particles->axes, &where, &value);
}

SPRING_CONTACT_INLINE real3 over3(real3 a, real by)
{
    return (real3){a.x / by, a.y / by, a.z / by};
}

SPRING_CONTACT_INLINE lane_mask has_freedom(const pressed_lanes *l, freedom f)
{
    return l->freedom == splat((scalar)f);
}

/* Advances *l, which begins as {.k = k}, to the next vector with a pressed particle. Returns false if there is none. */
SPRING_NOINLINE bool next_pressed(pressed_lanes *l)
{
    for (l->i = l->next; l->i < l->k->particles->count; l->i += lanes) {
        l->freedom = pressed_number(l, PRESSED_FREEDOM);
        l->where = not_mask(has_freedom(l, NOT_PRESSED));
        if (any(l->where)) {
            l->line = pressed_vector(l, PRESSED_LINE);
            l->next = l->i + lanes;
            return true;
        }
    }
    return false;
}

/* The component of a vector in which the particle is free. */
SPRING_NOINLINE void find_free(const pressed_lanes *l, const real3 *vector, real3 *free)
{
    const real along = dot3(*vector, l->line);
    const real3 on_line = select3(has_freedom(l, HELD), zero_lanes(), times3(along, l->line));
    *free = select3(has_freedom(l, FREE_IN_PLANE), plus_scaled3(*vector, -along, l->line), on_line);
}

/* Replaces the residual, without colliders, by its free component, friction and the given acceleration. */
SPRING_NOINLINE void put_residual(const pressed_lanes *l, const lane_mask *where, const real3 *full)
{
    const real3 given = pressed_vector(l, PRESSED_GIVEN);
    real3 free;
    find_free(l, full, &free);
    const real accel = pressed_number(l, PRESSED_FRICTION) / l->k->h;
    const real3 left = plus3(free, plus3(times3(accel, pressed_vector(l, PRESSED_AGAINST)), given));
    put_pressed(l, PRESSED_TAKEN, *where, minus3(*full, left));
    put_of_particles(l, l->k->residual, *where, left);
}

/* Lets friction of this size act against a velocity. Friction beyond the size of this velocity would reverse it. */
SPRING_NOINLINE void slide_against(const pressed_lanes *l, const lane_mask *where, const real3 *velocity,
                                   const real *size)
{
    const real square = dot3(*velocity, *velocity), most = vec_sqrt(square);
    put_number(l, PRESSED_MOST_FRICTION, *where, most);
    put_number(l, PRESSED_FRICTION, *where, vec_min(*size, most));
    put_pressed(l, PRESSED_AGAINST, *where, select3(square > 0, over3(*velocity, -most), zero_lanes()));
}

/* Holds the particles that friction may stop in this step, and lets the others slide. The load without damping decides,
   because with damping at v0 it may be many times larger than its mean. Without the damping forces, it computes the
   particles that do not need them. Returns whether there are others. */
static bool begin_friction(const pressed_kick *k)
{
    const scene_particles *const p = k->particles;
    bool others = false;
    for (pressed_lanes l = {.k = k}; next_pressed(&l);) {
        const real3 full = of_particles(&l, k->residual), given = pressed_vector(&l, PRESSED_GIVEN);
        const real3 wanted = pressed_vector(&l, PRESSED_WANTED);
        const real square = dot3(wanted, wanted), coefficient = pressed_number(&l, PRESSED_COEFFICIENT);
        const real rounding = 64 * SCALAR_EPSILON * sum_of_sizes(of_particles(&l, k->v0));
        const lane_mask rough = l.where & (coefficient > 0);
        const lane_mask open = rough & not_mask(square <= rounding * rounding);
        lane_mask where = l.where & not_mask(open), holds = rough & where;
        if (k->damping != NULL) {
            const real inverse_mass = vec_load(p->inverse_mass + l.i * p->mass_stride);
            const real weight = inverse_mass / mass_increase(k->h * p->drag * inverse_mass);
            const real load = -dot3(minus3(plus_scaled3(full, -weight, of_particles(&l, k->damping)), given), l.line);
            const real limit = coefficient * k->h * vec_not_negative(load);
            where = open;
            holds = where & (square <= limit * limit);
            const lane_mask slides = where & not_mask(holds);
            const real3 slip = pressed_vector(&l, PRESSED_SLIP);
            slide_against(&l, &slides, &slip, &limit);
        }
        others |= any(open);
        l.freedom = select_real(holds, splat((scalar)HELD), l.freedom);
        vec_store(pressed_at(&l, PRESSED_FREEDOM), l.freedom);
        put_pressed(&l, PRESSED_GIVEN, holds, plus3(given, over3(wanted, splat(k->h))));
        put_residual(&l, &where, &full);
    }
    return others;
}

/* Gives the components of term - from in which particles are not free the value given_weight times the given
   acceleration. from: NULL: 0, and the term is one of the series. A vector that is removed from a term b_k lowers the
   result b_0 by the same vector, apart from its damping forces, because 2 b_{k+1} - b_{k+2} continues a difference
   linearly. So PRESSED_REMOVED is the sum of these vectors until the last term, where it becomes the change of the
   velocity. */
static void project_pressed(const pressed_kick *k)
{
    const bool last = k->from != NULL;
    for (pressed_lanes l = {.k = k}; next_pressed(&l);) {
        const real3 term = of_particles(&l, k->term), from = last ? of_particles(&l, k->from) : zero_lanes();
        const real3 given = pressed_vector(&l, PRESSED_GIVEN), removed = pressed_vector(&l, PRESSED_REMOVED);
        const real3 change = minus3(term, from);
        real3 free;
        find_free(&l, &change, &free);
        const real3 end = plus3(plus_scaled3(free, splat(k->given_weight), given), from),
                    before = times3(splat(last ? k->h : 1), removed);
        put_pressed(&l, PRESSED_REMOVED, l.where, plus3(before, minus3(term, end)));
        put_of_particles(&l, k->term, l.where, end);
    }
}

/* After a kick, frees the particles that colliders have pulled, so that the kick can be repeated. Returns whether there
   are any: the number of pressed particles becomes smaller each time. If colliders pulled particles, friction of the
   others would exceed its limit. */
static bool free_pulled(const pressed_kick *k)
{
    bool found = false;
    for (pressed_lanes l = {.k = k}; next_pressed(&l);) {
        const real outwards = dot3(pressed_vector(&l, PRESSED_OUTWARDS), pressed_vector(&l, PRESSED_REMOVED));
        const lane_mask pulled = l.where & not_mask(outwards <= 0);
        if (!any(pulled))
            continue;
        found = true;
        put_number(&l, PRESSED_FREEDOM, pulled, splat((scalar)NOT_PRESSED));
        put_of_particles(&l, k->residual, pulled,
                         plus3(of_particles(&l, k->residual), pressed_vector(&l, PRESSED_TAKEN)));
    }
    return found;
}

/* Changes friction after a kick with the result k->term, where it does not fit its limit. Returns whether it has. */
static bool change_friction(const pressed_kick *k)
{
    bool any_changed = false;
    for (pressed_lanes l = {.k = k}; next_pressed(&l);) {
        const scalar tolerance = (scalar)friction_tolerance;
        const real coefficient = pressed_number(&l, PRESSED_COEFFICIENT);
        const lane_mask rough = l.where & (coefficient > 0);
        const real3 removed = pressed_vector(&l, PRESSED_REMOVED), given = pressed_vector(&l, PRESSED_GIVEN);
        const real load = -dot3(removed, l.line), along_line = dot3(given, l.line);
        const real limit = coefficient * vec_not_negative(load);
        const real3 held = plus_scaled3(removed, load, l.line); /* the velocity that static friction took */
        const lane_mask was_held = rough & has_freedom(&l, HELD);
        const lane_mask breaks = was_held & not_mask(dot3(held, held) <= limit * limit);
        /* twice the mean velocity along the surface */
        const real3 moves = plus_scaled3(
            plus_scaled3(minus3(of_particles(&l, k->term), of_particles(&l, k->v0)), -(k->h * along_line), l.line),
            splat(2), pressed_vector(&l, PRESSED_SLIP));
        const real along = dot3(pressed_vector(&l, PRESSED_AGAINST), moves), square = dot3(moves, moves);
        const real now = pressed_number(&l, PRESSED_FRICTION), most = pressed_number(&l, PRESSED_MOST_FRICTION);
        const lane_mask slides = rough & not_mask(was_held), pushes = slides & (along > 0) & (now > 0);
        const lane_mask again = pushes & (pressed_number(&l, PRESSED_REVERSED) > 0), fits = slides & not_mask(pushes);
        const real next = vec_min(limit, most), across = square - along * along;
        const lane_mask turns =
            fits & (4 * limit < most) & (across > tolerance * tolerance * square) & (across < (scalar)0.75 * square);
        const lane_mask differs = fits & (turns | not_mask(vec_abs(next - now) <= tolerance * limit));
        const lane_mask changed = breaks | pushes | differs;
        if (!any(changed))
            continue;
        any_changed = true;
        const real3 full = plus3(of_particles(&l, k->residual), pressed_vector(&l, PRESSED_TAKEN));
        const lane_mask starts = breaks | (pushes & not_mask(again));
        l.freedom = select_real(breaks, splat((scalar)FREE_IN_PLANE), l.freedom);
        vec_store(pressed_at(&l, PRESSED_FREEDOM), l.freedom);
        put_pressed(&l, PRESSED_GIVEN, breaks, times3(along_line, l.line));
        const real3 against = select3(breaks, held, moves);
        slide_against(&l, &starts, &against, &limit);
        put_number(&l, PRESSED_MOST_FRICTION, again, now / 2);
        put_number(&l, PRESSED_FRICTION, again, now / 2);
        put_number(&l, PRESSED_REVERSED, pushes, splat(1));
        put_number(&l, PRESSED_FRICTION, differs, next);
        put_pressed(&l, PRESSED_AGAINST, turns, over3(moves, -vec_sqrt(square)));
        put_residual(&l, &changed, &full);
    }
    return any_changed;
}

/* Gives each particle back the load that its colliders took from its velocity, k->term, in the kick. The contacts that
   are computed next remove it again, with friction except for particles that slid in the kick. */
static void restore_loads(const pressed_kick *k)
{
    for (pressed_lanes l = {.k = k}; next_pressed(&l);) {
        const real3 outwards = pressed_vector(&l, PRESSED_OUTWARDS), removed = pressed_vector(&l, PRESSED_REMOVED);
        const real3 v = of_particles(&l, k->term);
        const real3 back = plus_scaled3(v, dot3(outwards, removed) / dot3(outwards, outwards), outwards);
        const lane_mask slid =
            l.where & (pressed_number(&l, PRESSED_COEFFICIENT) > 0) & not_mask(has_freedom(&l, HELD));
        put_pressed(&l, PRESSED_REMOVED, l.where, plus3(removed, minus3(v, back)));
        put_of_particles(&l, k->term, l.where, back);
        vec_store(k->friction + l.i, select_real(slid, splat(0), vec_load(k->friction + l.i)));
    }
}

#endif
