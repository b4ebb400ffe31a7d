/* SPDX-License-Identifier: MIT */
/* Checks of a scene definition, in the order of its fields: the first field that is not valid is reported. */
#include "contact.h"
#include "definition.h"
#include "method_limits.h"

#include "../simd/size_begin.h"

/* ------------------------------------------------------------------------------------------------------------ links */

const char *spring_link_invalid_field(const spring_link *link, size_t precision)
{
    return !value_not_negative(precision, link->rest)        ? "link.rest"
           : !value_not_negative(precision, link->stiffness) ? "link.stiffness"
           : !value_not_negative(precision, link->damping)   ? "link.damping"
                                                             : NULL;
}

const char *spring_link_overflows(const spring_link *link, size_t precision, double inverse_a, double inverse_b)
{
    const double lightest = fmax(inverse_a, inverse_b);
    return !value_fits(precision, 2 * (link->stiffness * lightest)) ? "link.stiffness"
           : !value_fits(precision, 2 * (link->damping * lightest)) ? "link.damping"
                                                                    : NULL;
}

const char *spring_weighted_invalid_field(const spring_weighted_link *link, size_t precision)
{
    const double tolerance = 1e-12; /* of the sum, relative to the largest weight: rounding errors of decimal numbers */
    double sum = 0, largest = 0;
    for (int i = 0; i < 4; i++) {
        if (!value_fits(precision, link->weight[i]))
            return "weighted_link.weight";
        sum += link->weight[i];
        largest = fmax(largest, fabs(link->weight[i]));
    }
    return !(fabs(sum) <= tolerance * largest)               ? "weighted_link.weight"
           : !value_not_negative(precision, link->rest)      ? "weighted_link.rest"
           : !value_not_negative(precision, link->stiffness) ? "weighted_link.stiffness"
           : !value_not_negative(precision, link->damping)   ? "weighted_link.damping"
                                                             : NULL;
}

const char *spring_weighted_overflows(const spring_weighted_link *link, size_t precision, const double inverse_mass[4])
{
    for (int i = 0; i < 4; i++) {
        const double row = weighted_row(link->weight, inverse_mass, i);
        if (!value_fits(precision, link->stiffness * row) ||
            !value_fits(precision, link->stiffness * row * inverse_mass[i]))
            return "weighted_link.stiffness";
        if (!value_fits(precision, link->damping * row) ||
            !value_fits(precision, link->damping * row * inverse_mass[i]))
            return "weighted_link.damping";
    }
    return NULL;
}

/* ------------------------------------------------------------------------------------------------------- definition */

typedef struct def_error {
    spring_status status;
    const char *field;
    size_t index;
} def_error;

static const def_error no_error = {SPRING_OK, NULL, 0};

static def_error invalid(const char *field, size_t index)
{
    return (def_error){SPRING_EINVAL, field, index};
}

static def_error check_methods(uint32_t methods)
{
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        if ((methods & 1u << m) != 0 && spring_method_limits[m].stable_step == NULL)
            return (def_error){SPRING_EUNSUPPORTED, "methods", 0};
    return methods >> SPRING_METHOD_COUNT == 0 ? no_error : invalid("methods", 0);
}

static def_error check_contacts(const spring_scene_def *def, size_t precision)
{
    if (def->colliders > 0 && axes_of(def) == 1)
        return (def_error){SPRING_EUNSUPPORTED, "colliders", 0};
    if (def->colliders > most_colliders)
        return (def_error){SPRING_ERANGE, "colliders", 0};
    return value_not_negative(precision, def->particle_radius) ? no_error : invalid("particle_radius", 0);
}

static def_error check_head(const spring_scene_def *def, size_t precision)
{
    const uint32_t flags = SPRING_SCENE_EDITABLE | SPRING_SCENE_NO_UNDO | SPRING_SCENE_FORCE_IGNORES_VELOCITY |
                           SPRING_SCENE_TENSION_ONLY | SPRING_SCENE_FORCES;
    if (def->axes > 3)
        return invalid("axes", 0);
    if ((def->flags & ~flags) != 0)
        return invalid("flags", 0);
    if ((def->flags & SPRING_SCENE_TENSION_ONLY) != 0 && axes_of(def) == 1)
        return (def_error){SPRING_EUNSUPPORTED, "flags", 0};
    if (check_methods(def->methods).status != SPRING_OK)
        return check_methods(def->methods);
    if (def->particles == 0)
        return invalid("particles", 0);
    if (def->particles > UINT32_MAX - padding || def->particles > SIZE_MAX / 64 / sizeof(double))
        return (def_error){SPRING_ERANGE, "particles", 0};
    if (def->links > UINT32_MAX / 8 || def->links > SIZE_MAX / 64 / sizeof(double))
        return (def_error){SPRING_ERANGE, "links", 0};
    if (def->weighted_links > UINT32_MAX / 8 || def->weighted_links > SIZE_MAX / 64 / sizeof(double))
        return (def_error){SPRING_ERANGE, "weighted_links", 0};
    if (def->position == NULL)
        return invalid("position", 0);
    if (def->link == NULL && def->links > 0)
        return invalid("link", 0);
    if (def->weighted_link == NULL && def->weighted_links > 0)
        return invalid("weighted_link", 0);
    if (def->mass == NULL && def->mass_all != 0 && !mass_valid(precision, def->mass_all))
        return invalid("mass_all", 0);
    for (uint32_t a = 0; a < axes_of(def); a++)
        if (!value_fits(precision, def->gravity[a]))
            return invalid("gravity", a);
    if (!value_not_negative(precision, def->drag))
        return invalid("drag", 0);
    return value_not_negative(precision, def->max_speed) ? check_contacts(def, precision) : invalid("max_speed", 0);
}

static def_error check_particles(const spring_scene_def *def, size_t precision)
{
    const uint32_t axes = axes_of(def);
    for (size_t i = 0; i < def->particles; i++) {
        for (uint32_t a = 0; a < axes; a++) {
            if (!value_fits(precision, def->position[i * axes + a]))
                return invalid("position", i);
            if (def->velocity != NULL && !value_fits(precision, def->velocity[i * axes + a]))
                return invalid("velocity", i);
        }
        if (!is_pinned(def, i) && !mass_valid(precision, mass_of(def, i)))
            return invalid("mass", i);
        if (!value_fits(precision, def->drag * inverse_mass_of(def, precision, i)))
            return invalid("drag", i);
        if (def->colliders > 0 && def->radius != NULL && !value_not_negative(precision, def->radius[i]))
            return invalid("radius", i);
        if (def->colliders > 0 && def->friction != NULL && !value_not_negative(precision, def->friction[i]))
            return invalid("friction", i);
    }
    return no_error;
}

static def_error check_links(const spring_scene_def *def, size_t precision)
{
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        if (link->a >= def->particles)
            return (def_error){SPRING_ERANGE, "link.a", i};
        if (link->b >= def->particles)
            return (def_error){SPRING_ERANGE, "link.b", i};
        if (link->a == link->b)
            return invalid("link.b", i);
        if ((link->flags & ~(SPRING_LINK_TENSION_ONLY | SPRING_LINK_TETHER)) != 0)
            return invalid("link.flags", i);
        if (link->flags != 0 && axes_of(def) == 1)
            return (def_error){SPRING_EUNSUPPORTED, "link.flags", i};
        const char *field = spring_link_invalid_field(link, precision);
        if (field == NULL)
            field = spring_link_overflows(link, precision, inverse_mass_of(def, precision, link->a),
                                          inverse_mass_of(def, precision, link->b));
        if (field != NULL)
            return invalid(field, i);
    }
    return no_error;
}

static def_error check_weighted_links(const spring_scene_def *def, size_t precision)
{
    for (size_t i = 0; i < def->weighted_links; i++) {
        const spring_weighted_link *link = &def->weighted_link[i];
        double inverse[4] = {0};
        for (int k = 0; k < 4; k++) {
            if (link->weight[k] == 0)
                continue;
            if (link->particle[k] >= def->particles)
                return (def_error){SPRING_ERANGE, "weighted_link.particle", i};
            for (int before = 0; before < k; before++)
                if (link->weight[before] != 0 && link->particle[before] == link->particle[k])
                    return invalid("weighted_link.particle", i);
            inverse[k] = inverse_mass_of(def, precision, link->particle[k]);
        }
        const char *field = spring_weighted_invalid_field(link, precision);
        if (field == NULL)
            field = spring_weighted_overflows(link, precision, inverse);
        if (field != NULL)
            return invalid(field, i);
    }
    return no_error;
}

/* Rejects methods that evaluate forces at positions alone and require smooth motion, if forces depend on velocities or
   have a kink, or if there are contacts. */
static def_error check_velocities(const spring_scene_def *def)
{
    const bool kinked = (def->flags & SPRING_SCENE_TENSION_ONLY) != 0 || link_flags(def) != 0 || def->colliders > 0;
    const bool called = def->force != NULL && (def->flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0;
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        if ((def->methods & 1u << m) != 0 && spring_method_describe((spring_method)m)->positions_only &&
            (called || kinked || has_damped_links(def)))
            return (def_error){SPRING_EUNSUPPORTED, "methods", 0};
    return no_error;
}

static def_error check(const spring_scene_def *def, size_t precision)
{
    if (def == NULL)
        return invalid("def", 0);
    def_error found = check_head(def, precision);
    if (found.status == SPRING_OK)
        found = check_particles(def, precision);
    if (found.status == SPRING_OK)
        found = check_links(def, precision);
    if (found.status == SPRING_OK)
        found = check_weighted_links(def, precision);
    if (found.status == SPRING_OK)
        found = check_velocities(def);
    return found;
}

spring_status spring_definition_check(const spring_scene_def *def, size_t precision, const char **field, size_t *index)
{
    const def_error found = check(def, precision);
    if (field != NULL)
        *field = found.field;
    if (index != NULL)
        *index = found.index;
    return found.status;
}

#include "../simd/size_end.h"
