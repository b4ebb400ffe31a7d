/* SPDX-License-Identifier: MIT */
/*
 * A scene through time: its steps, its stable step, and whether it is at rest.
 *
 * Rollback  The state lies in one of two buffers. The first step of a call reads it there and writes into the other
 *           one, and further steps stay in that; only a call that succeeds makes it the state. So rolling back costs no
 *           copy. Without rollback there is one buffer.
 */
#define SPRING_SHAPE_SCENE
#include "methods.h"
#include "scene_links.h"
#include "simd/targets.h"

#include <limits.h>

#define SCENE_ROW(value, method) [value] = &method##_scene,
SPRING_TABLE const scene_method *const spring_scene_methods[SPRING_METHOD_COUNT] = {SPRING_METHODS(SCENE_ROW)};

/* ------------------------------------------------------------------------------------------------------- steps */

static const scene_kernels *best_scene_kernels(void)
{
    return SPRING_BEST_KERNELS(&spring_scene_v128, &spring_scene_v256, &spring_scene_v512);
}

static double time_of(const spring_scene *s)
{
    return s->t0 + (double)s->steps * s->dt;
}

double spring_scene_time(const spring_scene *s)
{
    return s != NULL ? time_of(s) : NAN;
}

static bool finite_scene(const spring_scene *s)
{
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *x = scene_quantity(s, SPRING_POSITION, a), *v = scene_quantity(s, SPRING_VELOCITY, a);
        for (size_t i = 0; i < s->plan.particles; i++)
            if (!spring_finite(x[s->plan.step * i]) || !spring_finite(v[s->plan.step * i]))
                return false;
    }
    return true;
}

/* After a failure without rollback nothing is left of the state, not even what is finite. */
static void invalidate(spring_scene *s)
{
    for (uint32_t a = 0; a < (s->plan.small ? quad_size : s->plan.axes); a++) {
        const bool axis = a < s->plan.axes; /* nobody sets the other numbers of a quad again */
        scalar *x = scene_quantity(s, SPRING_POSITION, a), *v = scene_quantity(s, SPRING_VELOCITY, a);
        for (size_t i = 0; i < s->plan.particles; i++)
            x[s->plan.step * i] = v[s->plan.step * i] = axis ? (scalar)NAN : 0;
    }
    s->lost = true;
}

spring_status spring_scene_advance_with(const scene_kernels *kernels, spring_scene *s, spring_method m, double dt,
                                        uint64_t n)
{
    if (s == NULL || spring_method_describe(m) == NULL || !spring_finite((scalar)dt))
        return SPRING_EINVAL;
    if ((s->plan.methods & 1u << m) == 0)
        return spring_scene_methods[m]->step == NULL ? SPRING_EUNSUPPORTED : SPRING_EDISABLED;
    if (spring_method_describe(m)->positions_only && scene_forces_use_velocity(s))
        return SPRING_EUNSUPPORTED;
    if (n == 0 || (scalar)dt == 0)
        return SPRING_OK;
    if (s->lost && !finite_scene(s)) /* the caller has not set it anew */
        return SPRING_ENONFINITE;
    s->lost = false;
    const bool rollback = (s->plan.flags & SPRING_SCENE_NO_UNDO) == 0;
    const bool same_run = s->dt == dt;
    const double t0 = same_run ? s->t0 : time_of(s);
    const uint64_t before = same_run ? s->steps : 0;
    if (!spring_finite(t0 + (double)(before + n) * dt))
        return SPRING_ENONFINITE;
    const scene_method *method = spring_scene_methods[m];
    scene_force force;
    scene_prepare_force(s, &force);
    scene_step step = {.kernels = s->plan.small ? kernels->small : kernels,
                       .scene = s,
                       .force = &force,
                       .particles = scene_prepare_particles(s),
                       .from = s->buffer,
                       .to = rollback ? 1 - s->buffer : s->buffer,
                       .h = (scalar)dt,
                       .t0 = t0,
                       .dt = dt};
    known_force known = s->known;
    for (uint64_t i = 0; i < n; i++) {
        step.done = (double)(before + i);
        step.known = scene_force_of(s, step.from);
        step.first = i == 0;
        step.last = i + 1 == n;
        if (known == NO_FORCE || (known == PREDICTED_FORCE && !method->predicts)) {
            scene_evaluate(&step, scene_axis(s, s->plan.x[step.from], 0), scene_axis(s, s->plan.v[step.from], 0), 0);
            step.known = scene_force_of(s, step.to); /* those that were kept may have to be rolled back to */
        }
        const scene_outcome outcome = method->step(&step);
        if (!outcome.finite) {
            if (!rollback)
                invalidate(s);
            if (s->known != PREDICTED_FORCE) /* the kept force may have been overwritten, or may itself not be finite */
                s->known = NO_FORCE;
            return SPRING_ENONFINITE;
        }
        known = outcome.known;
        step.from = step.to;
    }
    s->known = known;
    s->buffer = step.to;
    s->t0 = t0;
    s->dt = dt;
    s->steps = before + n;
    return SPRING_OK;
}

spring_status spring_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n)
{
    return spring_scene_advance_with(best_scene_kernels(), s, m, dt, n);
}

/* ----------------------------------------------------------------------------------------------- the stable step */

typedef enum link_coefficient { STIFFNESS, DAMPING } link_coefficient;

static const scalar *coefficient_of(const slotted_link *link, link_coefficient which)
{
    return which == STIFFNESS ? link->stiffness : link->damping;
}

static int exponent_of(double value)
{
    int exponent;
    frexp(value, &exponent);
    return exponent;
}

/* Sums are kept in units of powers of two, which change no bit: that of the inverse mass of each particle, times one
   for all that keeps the largest term below 1. So none overflows, and what underflows does not count. */
static int mass_exponent(const spring_scene *s, size_t i, bool by_mass)
{
    const double inverse = inverse_mass_at(s, i);
    const int pinned = INT_MIN / 4; /* no term */
    return !by_mass ? 0 : inverse > 0 ? exponent_of(inverse) : pinned;
}

/* Of the terms of all sums; 0 where there are none. */
static int largest_exponent(const spring_scene *s, link_coefficient which, double own, bool by_mass)
{
    const int none = INT_MIN / 2;
    int largest = none;
    for (size_t i = 0; i < s->plan.particles && own > 0; i++) {
        const int exponent = exponent_of(own) + mass_exponent(s, i, by_mass);
        largest = exponent > largest ? exponent : largest;
    }
    for (size_t i = 0; i < s->plan.links; i++) {
        const slotted_link link = scene_link(s, i);
        const scalar *value = coefficient_of(&link, which);
        if (value == NULL || *value == 0)
            continue;
        const int a = mass_exponent(s, link.a, by_mass), b = mass_exponent(s, link.b, by_mass);
        const int exponent = exponent_of((double)*value) + (a > b ? a : b);
        largest = exponent > largest ? exponent : largest;
    }
    return largest > none ? largest : 0;
}

/* Over the particles that move the largest sum of twice a coefficient of their links, once where the other end is
   pinned, and of what each particle has of its own; by_mass: times the inverse mass. Uses memory of forces. */
static double largest_sum(spring_scene *s, link_coefficient which, double own, bool by_mass)
{
    const scalar *inverse_mass = s->plan.inverse_mass != 0 ? scene_array(s, s->plan.inverse_mass) : NULL;
    const int exponent = largest_exponent(s, which, own, by_mass);
    scalar *sum = scene_force_of(s, 1 - s->buffer);
    memset(sum, 0, s->plan.particles * sizeof *sum);
    for (size_t i = 0; i < s->plan.links; i++) {
        const slotted_link link = scene_link(s, i);
        const scalar *value = coefficient_of(&link, which);
        if (value == NULL || *value == 0)
            continue;
        const int twice_a = inverse_mass == NULL || inverse_mass[s->plan.step * link.b] != 0;
        const int twice_b = inverse_mass == NULL || inverse_mass[s->plan.step * link.a] != 0;
        sum[link.a] += (scalar)ldexp((double)*value, twice_a + mass_exponent(s, link.a, by_mass) - exponent);
        sum[link.b] += (scalar)ldexp((double)*value, twice_b + mass_exponent(s, link.b, by_mass) - exponent);
    }
    double largest = 0;
    for (size_t i = 0; i < s->plan.particles; i++) {
        const double inverse = inverse_mass_at(s, i);
        const int unit = mass_exponent(s, i, by_mass);
        if (inverse > 0)
            largest =
                fmax(largest, ((double)sum[i] + ldexp(own, unit - exponent)) * (by_mass ? ldexp(inverse, -unit) : 1));
    }
    if (sum == scene_force_of(s, s->buffer))
        s->known = NO_FORCE;
    return ldexp(largest, exponent);
}

static double least_inverse_mass(const spring_scene *s) /* of the particles that move; 0: none */
{
    double least = INFINITY;
    for (size_t i = 0; i < s->plan.particles; i++)
        if (inverse_mass_at(s, i) > 0)
            least = fmin(least, inverse_mass_at(s, i));
    return least < INFINITY ? least : 0;
}

static scene_bounds bounds_of(spring_scene *s)
{
    return (scene_bounds){
        .stiffness = largest_sum(s, STIFFNESS, 0, true),
        .link_damping = largest_sum(s, DAMPING, 0, true),
        .damping = largest_sum(s, DAMPING, s->drag, true),
        .stiffness_sum = largest_sum(s, STIFFNESS, 0, false),
        .drag = s->drag,
        .least_drag = s->drag * least_inverse_mass(s),
    };
}

double spring_scene_stable_step(spring_scene *s, spring_method m)
{
    if (s == NULL || spring_method_describe(m) == NULL || spring_scene_methods[m]->stable_step == NULL)
        return NAN;
    if (!s->bounds_known) {
        s->bounds = bounds_of(s);
        s->bounds_known = true;
    }
    return spring_scene_methods[m]->stable_step(&s->bounds);
}

/* -------------------------------------------------------------------------------------------------------- at rest */

/* The forces of the state. Those of a callback are not kept: what *user holds may change before the next step. */
static const scalar *force_of_state(spring_scene *s)
{
    if (s->known == FORCE)
        return scene_force_of(s, s->buffer);
    scalar *force = scene_force_of(s, s->known == NO_FORCE ? s->buffer : 1 - s->buffer);
    scene_force links;
    scene_prepare_force(s, &links);
    scene_find_forces(best_scene_kernels(), s, &links, scene_quantity(s, SPRING_POSITION, 0),
                      scene_quantity(s, SPRING_VELOCITY, 0), time_of(s), force);
    if (s->known == NO_FORCE && s->force == NULL)
        s->known = FORCE;
    return force;
}

bool spring_scene_at_rest(spring_scene *s, double v_tol, double a_tol)
{
    if (s == NULL || !(v_tol >= 0) || !(a_tol >= 0) || !finite_scene(s))
        return false;
    const scalar *all = force_of_state(s);
    for (size_t i = 0; i < s->plan.particles; i++) {
        const double inverse = inverse_mass_at(s, i);
        double speed = 0, acceleration = 0;
        for (uint32_t a = 0; a < s->plan.axes; a++) {
            const double v = (double)scene_quantity(s, SPRING_VELOCITY, a)[s->plan.step * i];
            const double force = (double)all[a * s->plan.stride + s->plan.step * i] - s->drag * v;
            const double felt = inverse > 0 ? inverse * force + s->gravity[a] : 0;
            speed = spring_hypot(speed, fabs(v));
            acceleration = spring_hypot(acceleration, fabs(felt));
        }
        if (!(speed <= v_tol) || !(acceleration <= a_tol))
            return false;
    }
    return true;
}
