/* SPDX-License-Identifier: MIT */
/* What can be asked of a scene, and changed in it. */
#include "scene_links.h"
#include "scene_step.h"

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
    const bool reversed = s->plan.axes == 1 && spring_sign_bit((double)*link.rest);
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
            if (!spring_finite((scalar)in[i * stride + a]))
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
        if (!spring_finite((scalar)gravity[a]))
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

/* ----------------------------------------------------------------------------------------------------- links */

static bool is_editable(const spring_scene *s)
{
    return (s->plan.flags & SPRING_SCENE_EDITABLE) != 0;
}

spring_status spring_scene_set_link(spring_scene *s, size_t index, const spring_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if (!is_editable(s))
        return SPRING_EDISABLED;
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

spring_status spring_scene_get_link(const spring_scene *s, size_t index, spring_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if (index >= s->plan.links)
        return SPRING_ERANGE;
    const slotted_link at = scene_link(s, index);
    const bool reversed = s->plan.axes == 1 && spring_sign_bit((double)*at.rest);
    *link = (spring_link){
        .a = reversed ? at.b : at.a,
        .b = reversed ? at.a : at.b,
        .rest = fabs((double)*at.rest),
        .stiffness = (double)*at.stiffness,
        .damping = at.damping != NULL ? (double)*at.damping : 0,
    };
    return SPRING_OK;
}

size_t spring_scene_find_link(const spring_scene *s, uint32_t a, uint32_t b)
{
    for (size_t i = 0; s != NULL && i < s->plan.links; i++) {
        const slotted_link at = scene_link(s, i);
        if ((at.a == a && at.b == b) || (at.a == b && at.b == a))
            return i;
    }
    return SIZE_MAX;
}

/* --------------------------------------------------------------------------------------------- masses and pins */

/* What set_pinned and set_mass have in common: for each of these particles an inverse mass that is proposed for it. */
typedef struct proposal {
    size_t first, count;
    const uint8_t *pinned; /* NULL: as they are */
    const double *mass;    /* NULL: as they are */
} proposal;

static bool is_pinned_now(const spring_scene *s, size_t i)
{
    return scene_array(s, s->plan.inverse_mass)[s->plan.step * i] == 0;
}

/* Of a particle while it is not pinned; 0: none that is valid. */
static scalar free_inverse_mass(const spring_scene *s, const proposal *p, size_t i)
{
    return p->mass != NULL ? (scalar)(1 / p->mass[i - p->first]) : scene_array(s, s->plan.free_inverse_mass)[i];
}

static bool will_be_pinned(const spring_scene *s, const proposal *p, size_t i)
{
    return p->pinned != NULL ? p->pinned[i - p->first] != 0 : is_pinned_now(s, i);
}

/* Of any particle. */
static double proposed_inverse_mass(const spring_scene *s, const proposal *p, size_t i)
{
    if (i < p->first || i - p->first >= p->count)
        return inverse_mass_at(s, i);
    return will_be_pinned(s, p, i) ? 0 : (double)free_inverse_mass(s, p, i);
}

/* Could the scene be defined so? */
static bool proposal_valid(const spring_scene *s, const proposal *p)
{
    bool grows = false; /* an inverse mass */
    for (size_t i = p->first; i < p->first + p->count; i++) {
        const double inverse = proposed_inverse_mass(s, p, i);
        if (p->mass != NULL && !scene_mass_valid(p->mass[i - p->first]))
            return false;
        if (!will_be_pinned(s, p, i) && (inverse == 0 || !scene_fits(s->drag * inverse)))
            return false;
        grows = grows || inverse > inverse_mass_at(s, i);
    }
    spring_link link;
    for (size_t i = 0; grows && spring_scene_get_link(s, i, &link) == SPRING_OK; i++)
        if (scene_link_overflows(&link, proposed_inverse_mass(s, p, link.a), proposed_inverse_mass(s, p, link.b)))
            return false;
    return true;
}

/* Does it change anything but the mass that a pinned particle would have? */
static bool proposal_moves(const spring_scene *s, const proposal *p)
{
    bool moves = false;
    for (size_t i = p->first; i < p->first + p->count; i++)
        moves = moves || proposed_inverse_mass(s, p, i) != inverse_mass_at(s, i);
    return moves;
}

static spring_status propose(spring_scene *s, const proposal *p, const void *array)
{
    if (s == NULL || array == NULL)
        return SPRING_EINVAL;
    if (!is_editable(s))
        return SPRING_EDISABLED;
    if (p->first > s->plan.particles || p->count > s->plan.particles - p->first)
        return SPRING_ERANGE;
    if (!proposal_valid(s, p))
        return SPRING_EINVAL;
    if (proposal_moves(s, p)) {
        s->known = NO_FORCE;
        s->bounds_known = false;
    }
    for (size_t i = p->first; i < p->first + p->count; i++) {
        const bool pinned = will_be_pinned(s, p, i);
        const scalar inverse = free_inverse_mass(s, p, i);
        for (uint32_t a = 0; a < s->plan.axes && pinned && !is_pinned_now(s, i); a++)
            scene_quantity(s, SPRING_VELOCITY, a)[s->plan.step * i] = 0;
        scene_array(s, s->plan.free_inverse_mass)[i] = inverse;
        scene_place_inverse_mass(s, i, pinned ? 0 : inverse);
    }
    return SPRING_OK;
}

spring_status spring_scene_set_pinned(spring_scene *s, size_t first, size_t count, const uint8_t *pinned)
{
    return propose(s, &(proposal){.first = first, .count = count, .pinned = pinned}, pinned);
}

spring_status spring_scene_set_mass(spring_scene *s, size_t first, size_t count, const double *mass)
{
    return propose(s, &(proposal){.first = first, .count = count, .mass = mass}, mass);
}

spring_status spring_scene_drive(spring_scene *s, size_t particle, const double *target, double duration)
{
    if (s == NULL)
        return SPRING_EINVAL;
    if (particle >= s->plan.particles)
        return SPRING_ERANGE;
    if (inverse_mass_at(s, particle) != 0)
        return SPRING_EINVAL;
    scalar velocity[3] = {0};
    for (uint32_t a = 0; a < s->plan.axes && target != NULL; a++) {
        const double way = target[a] - (double)scene_quantity(s, SPRING_POSITION, a)[s->plan.step * particle];
        velocity[a] = (scalar)(way / duration);
        if (!(duration > 0) || !spring_finite(duration) || !spring_finite(way) || !spring_finite(velocity[a]))
            return SPRING_EINVAL;
    }
    bool same = true;
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        scalar *v = scene_quantity(s, SPRING_VELOCITY, a) + s->plan.step * particle;
        same = same && *v == velocity[a];
        *v = velocity[a];
    }
    if (!same && scene_forces_use_velocity(s))
        s->known = NO_FORCE;
    return SPRING_OK;
}
