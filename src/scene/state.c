/* SPDX-License-Identifier: MIT */
/* Reading and setting the state of a scene: positions, velocities, energies, tension, gravity, the callback and the
   time. */
#include "../kernels/link_law.h"
#include "weighted_links.h"

/* The length of a link and its rate of change. On one axis both have the sign of the link. */
typedef struct link_extent {
    double length, rate;
} link_extent;

static link_extent length_and_rate(const spring_scene *s, const stored_link *link)
{
    double delta[3] = {0}, relative[3] = {0};
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        const scalar *x = scene_state(s, SPRING_POSITION, a), *v = scene_state(s, SPRING_VELOCITY, a);
        delta[a] = (double)x[link->b] - (double)x[link->a];
        relative[a] = (double)v[link->b] - (double)v[link->a];
    }
    if (s->layout.axes == 1)
        return (link_extent){delta[0], relative[0]};
    const double length = spring_sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]);
    const double rate = delta[0] * relative[0] + delta[1] * relative[1] + delta[2] * relative[2];
    return (link_extent){length, length > 0 ? rate / length : 0};
}

spring_scene_energies spring_scene_energy(const spring_scene *s)
{
    if (s == NULL)
        return (spring_scene_energies){(double)NAN, (double)NAN, (double)NAN};
    spring_scene_energies e = {0, 0, 0};
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        const scalar *x = scene_state(s, SPRING_POSITION, a), *v = scene_state(s, SPRING_VELOCITY, a);
        for (size_t i = 0; i < s->layout.particles; i++) {
            const double inverse = inverse_mass_at(s, i), xi = (double)x[i], vi = (double)v[i];
            if (inverse > 0) {
                e.kinetic += vi * vi / inverse / 2;
                e.gravity -= xi * s->gravity[a] / inverse;
            }
        }
    }
    for (size_t i = 0; i < s->layout.links; i++) {
        const stored_link link = scene_link(s, i);
        const double extension = length_and_rate(s, &link).length - (double)link.rest;
        if (link.stiffness > 0 && (extension > 0 || !scene_tension_only(s, i, link.rest)))
            e.elastic += (double)link.stiffness * extension * extension / 2;
    }
    const stored_weighted *const weighted = scene_read(s, ARRAY_WEIGHTED);
    for (size_t i = 0; i < s->layout.weighted; i++) {
        double d[3];
        spring_scene_weighted_vector(s, &weighted[i], d);
        const double length = s->layout.axes == 1 ? d[0] : spring_sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        const double extension = length - (double)weighted[i].rest;
        if (weighted[i].stiffness > 0)
            e.elastic += (double)weighted[i].stiffness * extension * extension / 2;
    }
    return e;
}

double spring_scene_tension(const spring_scene *s, size_t index)
{
    if (s == NULL || index >= s->layout.links)
        return (double)NAN;
    const stored_link link = scene_link(s, index);
    if (!(link.stiffness > 0) && !(link.damping > 0))
        return 0; /* also if the square of the length overflows */
    const bool reversed = s->layout.axes == 1 && spring_sign_bit((double)link.rest);
    const link_extent now = length_and_rate(s, &link);
    const double tension =
        link_tension((double)link.stiffness, (double)link.rest, (double)link.damping, now.length, now.rate);
    if (scene_tension_only(s, index, link.rest) && (now.length <= (double)link.rest || tension <= 0))
        return 0;
    return reversed ? -tension : tension;
}

/* ------------------------------------------------------------------------------------------------------ get and set */

/* Checks the arguments that get, getf and set share. *stride: in elements; 0 becomes the number of axes. */
static spring_status check_range(const spring_scene *s, spring_quantity q, const void *buffer, size_t *stride,
                                 size_t first, size_t count)
{
    if (s == NULL || buffer == NULL || (q != SPRING_POSITION && q != SPRING_VELOCITY && q != SPRING_FORCE))
        return SPRING_EINVAL;
    if (q == SPRING_FORCE && !scene_has(s, ARRAY_HELD))
        return SPRING_EDISABLED;
    if (*stride == 0)
        *stride = s->layout.axes;
    if (*stride < s->layout.axes)
        return SPRING_EINVAL;
    return first <= s->layout.particles && count <= s->layout.particles - first ? SPRING_OK : SPRING_ERANGE;
}

spring_status spring_scene_get(const spring_scene *s, spring_quantity q, double *out, size_t stride, size_t first,
                               size_t count)
{
    const spring_status status = check_range(s, q, out, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        const scalar *from = scene_state(s, q, a) + first;
        for (size_t i = 0; i < count; i++)
            out[i * stride + a] = (double)from[i];
    }
    return SPRING_OK;
}

spring_status spring_scene_getf(const spring_scene *s, spring_quantity q, float *out, size_t stride, size_t first,
                                size_t count)
{
    const spring_status status = check_range(s, q, out, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        const scalar *from = scene_state(s, q, a) + first;
        for (size_t i = 0; i < count; i++)
            out[i * stride + a] = (float)from[i];
    }
    return SPRING_OK;
}

spring_status spring_scene_set(spring_scene *s, spring_quantity q, const double *in, size_t stride, size_t first,
                               size_t count)
{
    const spring_status status = check_range(s, q, in, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        for (uint32_t a = 0; a < s->layout.axes; a++)
            if (!scalar_finite((scalar)in[i * stride + a]))
                return SPRING_EINVAL;
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        scalar *to = scene_set_state(s, q, a) + first;
        for (size_t i = 0; i < count; i++)
            to[i] = (scalar)in[i * stride + a];
    }
    if (q == SPRING_POSITION)
        scene_clear_touched(s, first, count);
    if (q != SPRING_FORCE && count > 0) /* held forces are no part of the stored force */
        scene_drop_forces(s);
    return SPRING_OK;
}

#include "../simd/size_begin.h"

spring_status spring_scene_set_gravity(spring_scene *s, const double gravity[3])
{
    if (s == NULL || gravity == NULL)
        return SPRING_EINVAL;
    for (uint32_t a = 0; a < s->layout.axes; a++)
        if (!scalar_finite((scalar)gravity[a]))
            return SPRING_EINVAL;
    scene_store_gravity(s, gravity);
    return SPRING_OK;
}

spring_status spring_scene_set_force(spring_scene *s, spring_scene_force_fn *force, void *user)
{
    if (s == NULL)
        return SPRING_EINVAL;
    s->force = force;
    s->user = user;
    scene_drop_forces(s);
    return SPRING_OK;
}

spring_status spring_scene_set_time(spring_scene *s, double t)
{
    if (s == NULL || !spring_finite(t))
        return SPRING_EINVAL;
    s->colliders_base = colliders_time(s);
    s->colliders_from = 0;
    s->t0 = t;
    s->dt = 0;
    s->steps = 0;
    if (s->force != NULL) /* it may depend on the time */
        scene_drop_forces(s);
    return SPRING_OK;
}

spring_scene_info spring_scene_describe(const spring_scene *s)
{
    if (s == NULL)
        return (spring_scene_info){0};
    const scene_layout *const l = &s->layout;
    return (spring_scene_info){
        .particles = l->particles,
        .links = l->links,
        .weighted_links = l->weighted,
        .axes = l->axes,
        .flags = l->flags,
        .methods = l->methods,
        .colliders = l->colliders,
    };
}

#include "../simd/size_end.h"
