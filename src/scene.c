/* SPDX-License-Identifier: MIT */
/* What can be asked of a scene, and changed in it. */
#include "scene_links.h"

/* How a link is drawn out: its length, and how fast that grows. On one axis both have the sign of the link. */
typedef struct drawn {
    double length, rate;
} drawn;

static drawn draw(const spring_scene *s, const slotted_link *link)
{
    const scene_plan *p = &s->plan;
    double delta[3] = {0}, relative[3] = {0};
    for (uint32_t a = 0; a < p->axes; a++) {
        const scalar *x = scene_quantity(s, SPRING_POSITION, a), *v = scene_quantity(s, SPRING_VELOCITY, a);
        delta[a] = (double)x[p->step * link->b] - (double)x[p->step * link->a];
        relative[a] = (double)v[p->step * link->b] - (double)v[p->step * link->a];
    }
    if (p->axes == 1)
        return (drawn){delta[0], relative[0]};
    const double length = spring_sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]);
    const double rate = delta[0] * relative[0] + delta[1] * relative[1] + delta[2] * relative[2];
    return (drawn){length, length > 0 ? rate / length : 0};
}

spring_scene_energies spring_scene_energy(const spring_scene *s)
{
    if (s == NULL)
        return (spring_scene_energies){NAN, NAN, NAN};
    spring_scene_energies e = {0, 0, 0};
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *x = scene_quantity(s, SPRING_POSITION, a), *v = scene_quantity(s, SPRING_VELOCITY, a);
        for (size_t i = 0; i < s->plan.particles; i++) {
            const double inverse = inverse_mass_at(s, i), xi = (double)x[s->plan.step * i],
                         vi = (double)v[s->plan.step * i];
            if (inverse > 0) {
                e.kinetic += vi * vi / inverse / 2;
                e.gravity -= xi * s->gravity[a] / inverse;
            }
        }
    }
    for (size_t i = 0; i < s->plan.links; i++) {
        const slotted_link link = scene_link(s, i);
        const double extension = draw(s, &link).length - (double)*link.rest;
        e.elastic += (double)*link.stiffness * extension * extension / 2;
    }
    return e;
}

double spring_scene_tension(const spring_scene *s, size_t index)
{
    if (s == NULL || index >= s->plan.links)
        return NAN;
    const slotted_link link = scene_link(s, index);
    const bool reversed = s->plan.axes == 1 && signbit(*link.rest);
    const drawn d = draw(s, &link);
    const double pull = (double)*link.stiffness * (d.length - (double)*link.rest) +
                        (link.damping != NULL ? (double)*link.damping * d.rate : 0);
    return reversed ? -pull : pull;
}

/* ------------------------------------------------------------------------------------------------ in and out */

/* Checks what get, getf and set have in common; the stride in elements. */
static spring_status check_range(const spring_scene *s, spring_quantity q, const void *buffer, size_t *stride,
                                 size_t first, size_t count)
{
    if (s == NULL || buffer == NULL || (q != SPRING_POSITION && q != SPRING_VELOCITY))
        return SPRING_EINVAL;
    if (*stride == 0)
        *stride = s->plan.axes;
    if (*stride < s->plan.axes)
        return SPRING_EINVAL;
    return first <= s->plan.particles && count <= s->plan.particles - first ? SPRING_OK : SPRING_ERANGE;
}

spring_status spring_scene_get(const spring_scene *s, spring_quantity q, double *out, size_t stride, size_t first,
                               size_t count)
{
    const spring_status status = check_range(s, q, out, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *from = scene_quantity(s, q, a) + s->plan.step * first;
        for (size_t i = 0; i < count; i++)
            out[i * stride + a] = (double)from[s->plan.step * i];
    }
    return SPRING_OK;
}

spring_status spring_scene_getf(const spring_scene *s, spring_quantity q, float *out, size_t stride, size_t first,
                                size_t count)
{
    const spring_status status = check_range(s, q, out, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *from = scene_quantity(s, q, a) + s->plan.step * first;
        for (size_t i = 0; i < count; i++)
            out[i * stride + a] = (float)from[s->plan.step * i];
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
        for (uint32_t a = 0; a < s->plan.axes; a++)
            if (!isfinite((scalar)in[i * stride + a]))
                return SPRING_EINVAL;
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        scalar *to = scene_quantity(s, q, a) + s->plan.step * first;
        for (size_t i = 0; i < count; i++)
            to[s->plan.step * i] = (scalar)in[i * stride + a];
    }
    s->known = NO_FORCE;
    return SPRING_OK;
}

spring_status spring_scene_set_gravity(spring_scene *s, const double gravity[3])
{
    if (s == NULL || gravity == NULL)
        return SPRING_EINVAL;
    for (uint32_t a = 0; a < s->plan.axes; a++)
        if (!isfinite((scalar)gravity[a]))
            return SPRING_EINVAL;
    scene_place_gravity(s, gravity);
    return SPRING_OK;
}

spring_status spring_scene_set_force(spring_scene *s, spring_scene_force_fn *force, void *user)
{
    if (s == NULL)
        return SPRING_EINVAL;
    s->force = force;
    s->user = user;
    s->known = NO_FORCE;
    return SPRING_OK;
}

spring_status spring_scene_set_link(spring_scene *s, size_t index, const spring_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if ((s->plan.flags & SPRING_SCENE_EDITABLE) == 0)
        return SPRING_EUNSUPPORTED;
    if (index >= s->plan.links)
        return SPRING_ERANGE;
    const slotted_link old = scene_link(s, index);
    const bool same_ends = (link->a == old.a && link->b == old.b) || (link->a == old.b && link->b == old.a);
    if (!same_ends || scene_link_invalid_field(link) != NULL ||
        scene_link_overflows(link, inverse_mass_at(s, old.a), inverse_mass_at(s, old.b)) != NULL)
        return SPRING_EINVAL;
    s->damped_links -= *old.damping > 0;
    s->damped_links += (scalar)link->damping > 0;
    scene_place(s, index, link);
    s->known = NO_FORCE;
    s->bounds_known = false;
    return SPRING_OK;
}
