/* SPDX-License-Identifier: MIT */
/* Changing the links, masses and pins of a scene, and the velocities of pinned particles. */
#include "weighted_links.h"

#include "../simd/size_begin.h"

/* Whether a link may replace the link with this index. */
static bool replaces_link(const spring_scene *s, size_t index, const spring_link *link)
{
    const stored_link old = scene_link(s, index);
    const bool same_ends = (link->a == old.a && link->b == old.b) || (link->a == old.b && link->b == old.a);
    return same_ends && spring_link_invalid_field(link, sizeof(scalar)) == NULL &&
           spring_link_overflows(link, sizeof(scalar), inverse_mass_at(s, old.a), inverse_mass_at(s, old.b)) == NULL;
}

spring_status spring_scene_set_links(spring_scene *s, size_t first, size_t count, const spring_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if (!scene_is_editable(s))
        return SPRING_EDISABLED;
    if (first > s->layout.links || count > s->layout.links - first)
        return SPRING_ERANGE;
    for (size_t i = 0; i < count; i++)
        if (!replaces_link(s, first + i, &link[i]))
            return SPRING_EINVAL;
    for (size_t i = 0; i < count; i++)
        scene_replace_link(s, first + i, &link[i]);
    return SPRING_OK;
}

spring_status spring_scene_set_link(spring_scene *s, size_t index, const spring_link *link)
{
    return spring_scene_set_links(s, index, 1, link);
}

spring_status spring_scene_get_link(const spring_scene *s, size_t index, spring_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if (index >= s->layout.links)
        return SPRING_ERANGE;
    const stored_link at = scene_link(s, index);
    const tether *const defined = scene_tether(s, index);
    const uint8_t *const flags = scene_read(s, ARRAY_FLAGS);
    const bool reversed = s->layout.axes == 1 && spring_sign_bit((double)at.rest);
    *link = (spring_link){
        .a = reversed ? at.b : at.a,
        .b = reversed ? at.a : at.b,
        .rest = fabs((double)at.rest),
        .stiffness = (double)(defined != NULL ? defined->stiffness : at.stiffness),
        .damping = (double)(defined != NULL ? defined->damping : at.damping),
        .flags = flags != NULL ? flags[index] : 0,
    };
    return SPRING_OK;
}

size_t spring_scene_find_link(const spring_scene *s, uint32_t a, uint32_t b)
{
    for (size_t i = 0; s != NULL && i < s->layout.links; i++) {
        const stored_link at = scene_link(s, i);
        if ((at.a == a && at.b == b) || (at.a == b && at.b == a))
            return i;
    }
    return SIZE_MAX;
}

/* --------------------------------------------------------------------------------------------- masses and pins */

/* A change of masses and pins that is checked before it is made. */
typedef struct proposal {
    size_t first, count;
    const uint8_t *pinned; /* NULL: unchanged */
    const double *mass;    /* NULL: unchanged */
} proposal;

static bool is_pinned_now(const spring_scene *s, size_t i)
{
    return inverse_mass_at(s, i) == 0;
}

/* The inverse mass of a particle while it is free; 0: its mass is not valid. */
static scalar free_inverse_mass(const spring_scene *s, const proposal *p, size_t i)
{
    const scalar *now = scene_read(s, ARRAY_FREE_MASS);
    return p->mass != NULL ? (scalar)(1 / p->mass[i - p->first]) : now[i];
}

static bool will_be_pinned(const spring_scene *s, const proposal *p, size_t i)
{
    return p->pinned != NULL ? p->pinned[i - p->first] != 0 : is_pinned_now(s, i);
}

/* The inverse mass after the change. */
static double proposed_inverse_mass(const spring_scene *s, const proposal *p, size_t i)
{
    if (i < p->first || i - p->first >= p->count)
        return inverse_mass_at(s, i);
    return will_be_pinned(s, p, i) ? 0 : (double)free_inverse_mass(s, p, i);
}

/* Whether a definition of the scene with these values would be valid. */
static bool proposal_valid(const spring_scene *s, const proposal *p)
{
    bool grows = false; /* some inverse mass */
    for (size_t i = p->first; i < p->first + p->count; i++) {
        const double inverse = proposed_inverse_mass(s, p, i);
        if (p->mass != NULL && !mass_valid(sizeof(scalar), p->mass[i - p->first]))
            return false;
        if (!will_be_pinned(s, p, i) && (inverse == 0 || !value_fits(sizeof(scalar), s->drag * inverse)))
            return false;
        grows = grows || inverse > inverse_mass_at(s, i);
    }
    spring_link link;
    for (size_t i = 0; grows && spring_scene_get_link(s, i, &link) == SPRING_OK; i++)
        if (spring_link_overflows(&link, sizeof(scalar), proposed_inverse_mass(s, p, link.a),
                                  proposed_inverse_mass(s, p, link.b)))
            return false;
    const stored_weighted *const weighted = scene_read(s, ARRAY_WEIGHTED);
    for (size_t i = 0; grows && i < s->layout.weighted; i++) {
        const spring_weighted_link now = scene_weighted(&weighted[i]);
        double inverse[4];
        for (int k = 0; k < 4; k++)
            inverse[k] = now.weight[k] != 0 ? proposed_inverse_mass(s, p, now.particle[k]) : 0;
        if (spring_weighted_overflows(&now, sizeof(scalar), inverse) != NULL)
            return false;
    }
    return true;
}

/* Whether an inverse mass changes. The mass of a pinned particle does not count. */
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
    if (!scene_is_editable(s))
        return SPRING_EDISABLED;
    if (p->first > s->layout.particles || p->count > s->layout.particles - p->first)
        return SPRING_ERANGE;
    if (!proposal_valid(s, p))
        return SPRING_EINVAL;
    const bool moves = proposal_moves(s, p);
    if (moves) {
        scene_drop_forces(s);
        s->bounds_known = false;
    }
    scalar *const freed = scene_memory(s, ARRAY_FREE_MASS);
    for (size_t i = p->first; i < p->first + p->count; i++) {
        const bool pinned = will_be_pinned(s, p, i);
        const scalar inverse = free_inverse_mass(s, p, i);
        for (uint32_t a = 0; a < s->layout.axes && pinned && !is_pinned_now(s, i); a++)
            scene_set_state(s, SPRING_VELOCITY, a)[i] = 0;
        if (pinned != is_pinned_now(s, i))
            scene_clear_touched(s, i, 1);
        freed[i] = inverse;
        scene_set_inverse_mass(s, i, pinned ? 0 : inverse);
    }
    const tether *const tethers = scene_read(s, ARRAY_TETHERS);
    for (size_t i = 0; moves && i < s->layout.tethers; i++) { /* some begin or cease to act */
        spring_link link;
        spring_scene_get_link(s, tethers[i].link, &link);
        scene_replace_link(s, tethers[i].link, &link);
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
    if (particle >= s->layout.particles)
        return SPRING_ERANGE;
    if (inverse_mass_at(s, particle) != 0)
        return SPRING_EINVAL;
    scalar velocity[3] = {0};
    for (uint32_t a = 0; a < s->layout.axes && target != NULL; a++) {
        const double distance = target[a] - (double)scene_state(s, SPRING_POSITION, a)[particle];
        velocity[a] = (scalar)(distance / duration);
        if (!(duration > 0) || !spring_finite(duration) || !spring_finite(distance) || !scalar_finite(velocity[a]))
            return SPRING_EINVAL;
    }
    bool same = true;
    for (uint32_t a = 0; a < s->layout.axes; a++) {
        scalar *v = scene_set_state(s, SPRING_VELOCITY, a) + particle;
        same = same && *v == velocity[a];
        *v = velocity[a];
    }
    if (!same && scene_forces_use_velocity(s))
        scene_drop_forces(s);
    return SPRING_OK;
}

#include "../simd/size_end.h"
