/* SPDX-License-Identifier: MIT */
/* Colliders of a scene: setting them, their poses during a step, and balance at rest. kernels/contact_collide_tmpl.h
   has the formulas of contacts. */
#include "block.h"
#include "../spring/roots.h"

/* ----------------------------------------------------------------------------------------------------- valid values */

static bool fits3(const double v[3], uint32_t axes)
{
    for (uint32_t a = 0; a < axes; a++)
        if (!scalar_finite((scalar)v[a]))
            return false;
    return true;
}

static bool fits_not_negative(double value)
{
    return value >= 0 && scalar_finite((scalar)value);
}

static double dot_of(const double a[3], const double b[3], uint32_t axes)
{
    double sum = 0;
    for (uint32_t i = 0; i < axes; i++)
        sum += a[i] * b[i];
    return sum;
}

/* The number of axes that a shape uses. */
static uint32_t axes_of_shape(const spring_collider *c, uint32_t axes)
{
    return c->shape == SPRING_PLANE ? 1 : c->shape == SPRING_BOX ? axes : 0;
}

/* The largest difference between a dot product of two of these axes and that of unit vectors at right angles. NaN if
   one is NaN. */
static double orthonormality_error(const spring_collider *c, uint32_t count, uint32_t axes)
{
    double largest = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = 0; j <= i; j++) {
            const double error = fabs(dot_of(c->axis[i], c->axis[j], axes) - (i == j));
            if (!spring_finite(error))
                return error;
            largest = fmax(largest, error);
        }
    return largest;
}

/* Replaces axes by the nearest orthonormal ones: Newton-Schulz iteration of the polar decomposition,
   a_i <- (3 a_i - sum over j of (a_i . a_j) a_j)/2, which squares the error. Axes without an error beyond rounding do
   not change. Source: Higham, Functions of Matrices (2008), section 8.3. */
static void orthonormalise(spring_collider *c, uint32_t count, uint32_t axes)
{
    const double rounding = 4 * DBL_EPSILON;
    enum { rounds = 4 }; /* from 1e-3: 8e-7, 5e-13, rounding */
    for (int round = 0; round < rounds && orthonormality_error(c, count, axes) > rounding; round++) {
        const spring_collider old = *c;
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t a = 0; a < axes; a++) {
                double sum = 0;
                for (uint32_t j = 0; j < count; j++)
                    sum += dot_of(old.axis[i], old.axis[j], axes) * old.axis[j][a];
                c->axis[i][a] = (3 * old.axis[i][a] - sum) / 2;
            }
    }
}

/* The name of the first field that is not valid; NULL: none. */
static const char *invalid_field(const spring_collider *c, double thickness, uint32_t axes)
{
    const double tolerance = 1e-3; /* of axes; products of many matrices of floats have errors of 1e-6 */
    const bool capsule = c->shape == SPRING_CAPSULE, plane = c->shape == SPRING_PLANE;
    if (!plane && !capsule && c->shape != SPRING_SPHERE && c->shape != SPRING_BOX)
        return "shape";
    if (!fits3(c->at, axes))
        return "at";
    if (capsule && !fits3(c->to, axes))
        return "to";
    if (!(orthonormality_error(c, axes_of_shape(c, axes), axes) <= tolerance))
        return "axis";
    if (plane && !scalar_finite((scalar)(dot_of(c->axis[0], c->at, axes) + thickness)))
        return "at";
    for (uint32_t a = 0; a < axes && c->shape == SPRING_BOX; a++)
        if (!fits_not_negative(c->half[a]))
            return "half";
    if (!plane && !(c->radius >= 0 && fits_not_negative(c->radius + thickness)))
        return "radius";
    if (!fits3(c->velocity, axes))
        return "velocity";
    if (capsule && !fits3(c->velocity_to, axes))
        return "velocity_to";
    if (axes == 2 ? !scalar_finite((scalar)c->spin[2]) : !fits3(c->spin, axes))
        return "spin";
    if (!fits_not_negative(c->friction))
        return "friction";
    return c->restitution >= 0 && c->restitution <= 1 ? NULL : "restitution";
}

/* ------------------------------------------------------------------------------------------------------------ poses */

/* The position of a point after `time`, in the precision of the scene. */
static void place_point(const double at[3], const double velocity[3], double time, uint32_t axes, scalar out[3])
{
    for (uint32_t a = 0; a < 3; a++)
        out[a] = a < axes ? (scalar)(at[a] + time * velocity[a]) : 0;
}

static scalar plane_offset(const spring_collider *c, double time, double thickness, uint32_t axes)
{
    return (scalar)(dot_of(c->axis[0], c->at, axes) + time * dot_of(c->axis[0], c->velocity, axes) + thickness);
}

static scalar length_of_shift(const scalar shift[3])
{
    const double square =
        (double)shift[0] * (double)shift[0] + (double)shift[1] * (double)shift[1] + (double)shift[2] * (double)shift[2];
    return (scalar)spring_sqrt(square);
}

/* Copies shape and material in the precision of the scene. With two axes, third components get neutral values. */
static void copy_shape(scene_collider *to, const spring_collider *c, double thickness, uint32_t axes)
{
    const bool flat = axes == 2;
    to->shape = c->shape;
    to->radius = (scalar)((c->shape == SPRING_PLANE ? 0 : c->radius) + thickness);
    to->friction = (scalar)c->friction;
    to->restitution = (scalar)c->restitution;
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t a = 0; a < 3; a++)
            to->axis[i][a] = flat && (i == 2 || a == 2) ? (scalar)(i == a) : (scalar)c->axis[i][a];
        to->half[i] = flat && i == 2 ? SCALAR_MAX : (scalar)c->half[i];
        to->velocity[i] = flat && i == 2 ? 0 : (scalar)c->velocity[i];
        to->velocity_to[i] = flat && i == 2 ? 0 : (scalar)c->velocity_to[i];
        to->spin[i] = flat && i < 2 ? 0 : (scalar)c->spin[i];
    }
    to->spins = to->spin[0] != 0 || to->spin[1] != 0 || to->spin[2] != 0;
}

/* [m] A bound on contact_slop() of particles at the collider. */
static scalar rounding_error_at(const scene_collider *c, uint32_t axes)
{
    const scalar eps = sizeof(scalar) == sizeof(float) ? (scalar)FLT_EPSILON : (scalar)DBL_EPSILON;
    double size = (double)c->radius;
    for (uint32_t a = 0; a < axes; a++) {
        size += fabs((double)c->at[a]);
        if (c->shape == SPRING_CAPSULE)
            size += fabs((double)c->to[a]);
        if (c->shape == SPRING_BOX)
            size += (double)c->half[a];
    }
    return 16 * eps * (scalar)size;
}

static void place_collider(scene_collider *to, const spring_collider *c, double time0, double time1, double thickness,
                           uint32_t axes)
{
    copy_shape(to, c, thickness, axes);
    place_point(c->at, c->velocity, time0, axes, to->at);
    place_point(c->at, c->velocity, time1, axes, to->at_end);
    place_point(c->to, c->velocity_to, time0, axes, to->to);
    place_point(c->to, c->velocity_to, time1, axes, to->to_end);
    scalar square = 0;
    for (uint32_t a = 0; a < 3; a++) {
        to->shift[a] = to->at_end[a] - to->at[a];
        to->shift_to[a] = to->to_end[a] - to->to[a];
        square += (to->to[a] - to->at[a]) * (to->to[a] - to->at[a]);
    }
    to->inverse_square = square > 0 ? 1 / square : 0;
    to->offset = plane_offset(c, time0, thickness, axes);
    to->offset_end = plane_offset(c, time1, thickness, axes);
    to->offset_shift = to->offset_end - to->offset;
    scalar shift = length_of_shift(to->shift);
    if (c->shape == SPRING_CAPSULE && length_of_shift(to->shift_to) > shift)
        shift = length_of_shift(to->shift_to);
    const scalar reach = to->radius + shift + rounding_error_at(to, axes);
    /* 1 + e with the two e of may_touch(), rounded up for rounding errors */
    to->reach_fast = (scalar)1.07 * reach * reach;
    to->reach_slow = (scalar)1.006 * reach * reach;
}

void spring_scene_place_colliders(spring_scene *s, double time0, double time1)
{
    const spring_collider *c = scene_read(s, ARRAY_COLLIDERS);
    scene_collider *placed = scene_memory(s, ARRAY_PLACED);
    for (uint32_t i = 0; i < s->colliders; i++)
        place_collider(&placed[i], &c[i], time0, time1, s->particle_radius, s->layout.axes);
}

/* ------------------------------------------------------------------------------------------------- public functions */

#include "../simd/size_begin.h"

spring_status spring_scene_check_colliders(const spring_scene *s, const spring_collider *c, uint32_t count,
                                           const char **field, size_t *index)
{
    const char *name = NULL;
    spring_status status = SPRING_EINVAL;
    uint32_t i = 0;
    if (s == NULL)
        name = "scene";
    else if (c == NULL && count > 0)
        name = "c";
    else if (count > s->layout.colliders || s->layout.colliders == 0) {
        name = "count";
        status = s->layout.colliders == 0 ? SPRING_EDISABLED : SPRING_ERANGE;
    }
    while (name == NULL && i < count)
        if ((name = invalid_field(&c[i], s->particle_radius, s->layout.axes)) == NULL)
            i++;
    if (field != NULL)
        *field = name;
    if (index != NULL)
        *index = name != NULL ? i : 0;
    return name != NULL ? status : SPRING_OK;
}

spring_status spring_scene_set_colliders(spring_scene *s, const spring_collider *c, uint32_t count)
{
    const spring_status status = spring_scene_check_colliders(s, c, count, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    spring_collider *const set = scene_memory(s, ARRAY_COLLIDERS);
    for (uint32_t i = 0; i < count; i++) {
        set[i] = c[i];
        orthonormalise(&set[i], axes_of_shape(&c[i], s->layout.axes), s->layout.axes);
    }
    s->colliders = count;
    s->colliders_base = 0;
    s->colliders_from = s->steps;
    for (uint32_t buffer = 0; buffer < 2; buffer++) { /* without colliders no step writes them */
        uint32_t *const touched = scene_memory(s, touched_in(buffer));
        if (touched != NULL)
            memset(touched, 0, s->layout.particles * sizeof *touched);
    }
    return SPRING_OK;
}

spring_status spring_scene_touching(const spring_scene *s, uint32_t *bits, size_t first, size_t count)
{
    if (s == NULL || bits == NULL)
        return SPRING_EINVAL;
    if (s->layout.colliders == 0)
        return SPRING_EDISABLED;
    if (first > s->layout.particles || count > s->layout.particles - first)
        return SPRING_ERANGE;
    const uint32_t *touched = scene_read(s, touched_in(s->buffer));
    memcpy(bits, touched + first, count * sizeof *bits);
    return SPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------------- at rest */

/* Adds the accelerations by which colliders press, which are not negative. This is projected Gauss-Seidel: in each
   round, each collider corrects its own acceleration. In a groove, colliders press a particle against each other. */
static void add_pressing(const double normal[][3], double pressing[], size_t count, double accel[3])
{
    enum { rounds = 200 }; /* between walls that enclose 170 degrees, each multiplies the error by 0.97 */
    for (int round = 0; round < rounds; round++)
        for (size_t k = 0; k < count; k++) {
            const double before = pressing[k];
            pressing[k] = fmax(0, before - dot_of(accel, normal[k], 3));
            for (int a = 0; a < 3; a++)
                accel[a] += (pressing[k] - before) * normal[k][a];
        }
}

double spring_scene_balanced(const scene_kernels *kernels, const spring_scene *s, size_t i, double accel[3])
{
    const uint32_t *touched = scene_read(s, touched_in(s->buffer));
    const scene_collider *placed = scene_read(s, ARRAY_PLACED);
    double normal[most_colliders][3], pressing[most_colliders] = {0}, friction[most_colliders];
    scalar at[3] = {0};
    size_t count = 0;
    for (uint32_t a = 0; a < s->layout.axes; a++)
        at[a] = scene_state(s, SPRING_POSITION, a)[i];
    for (uint32_t k = 0; k < s->colliders; k++) {
        if ((touched[i] >> k & 1) == 0)
            continue;
        scalar n[3], velocity[3];
        kernels->common->contact_surface(&placed[k], at, n, velocity);
        for (int a = 0; a < 3; a++)
            normal[count][a] = (double)n[a];
        friction[count++] = (double)placed[k].friction;
    }
    add_pressing((const double(*)[3])normal, pressing, count, accel);
    double left = spring_hypot(spring_hypot(fabs(accel[0]), fabs(accel[1])), fabs(accel[2]));
    for (size_t k = 0; k < count; k++) /* static friction */
        left = fmax(0, left - friction[k] * pressing[k]);
    return left;
}

#include "../simd/size_end.h"
