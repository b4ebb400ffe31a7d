/* SPDX-License-Identifier: MIT */
/* Colliders of scenes of either precision: valid values, their state after some time, and in saved states. */
#include "contact.h"
#include "definition.h"
#include "state_numbers.h"

#include "../simd/size_begin.h"

static bool fits3(size_t precision, const double v[3], uint32_t axes)
{
    for (uint32_t a = 0; a < axes; a++)
        if (!value_fits(precision, v[a]))
            return false;
    return true;
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
    bool given = c->shape == SPRING_BOX;
    for (uint32_t i = 0; i < axes && is_custom(c->shape); i++)
        for (uint32_t a = 0; a < axes; a++)
            given = given || c->axis[i][a] != 0;
    return c->shape == SPRING_PLANE ? 1 : given ? axes : 0;
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
void spring_collider_orthonormalise(spring_collider *c, uint32_t axes)
{
    const uint32_t count = axes_of_shape(c, axes);
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

static bool fits_angles(size_t precision, const double v[3], uint32_t axes)
{
    return axes == 2 ? value_fits(precision, v[2]) : fits3(precision, v, axes);
}

const char *spring_collider_invalid_field(const spring_collider *c, size_t precision, double radius, uint32_t axes)
{
    const double tolerance = 1e-3; /* of axes; products of many matrices of floats have errors of 1e-6 */
    const bool capsule = c->shape == SPRING_CAPSULE, plane = c->shape == SPRING_PLANE, custom = is_custom(c->shape);
    if (!plane && !capsule && !custom && c->shape != SPRING_SPHERE && c->shape != SPRING_BOX)
        return "shape";
    if (!fits3(precision, c->at, axes))
        return "at";
    if (capsule && !fits3(precision, c->to, axes))
        return "to";
    if (!(orthonormality_error(c, axes_of_shape(c, axes), axes) <= tolerance))
        return "axis";
    if (plane && !value_fits(precision, dot_of(c->axis[0], c->at, axes) + radius))
        return "at";
    for (uint32_t a = 0; a < axes && c->shape == SPRING_BOX; a++)
        if (!value_not_negative(precision, c->half[a]))
            return "half";
    if (!plane && !(c->radius >= 0 && value_not_negative(precision, c->radius + radius)))
        return "radius";
    if (!fits3(precision, c->velocity, axes))
        return "velocity";
    if (capsule && !fits3(precision, c->velocity_to, axes))
        return "velocity_to";
    if (!fits_angles(precision, c->spin, axes))
        return "spin";
    if (!value_not_negative(precision, c->friction))
        return "friction";
    if (!(c->restitution >= 0 && c->restitution <= 1))
        return "restitution";
    if (!fits3(precision, c->acceleration, axes))
        return "acceleration";
    if (!fits_angles(precision, c->spin_acceleration, axes))
        return "spin_acceleration";
    if (!fits3(precision, c->surface, axes))
        return "surface";
    if (custom && c->gap == NULL)
        return "gap";
    if (custom && !(c->thickness > 0 && value_fits(precision, c->thickness)))
        return "thickness";
    return custom && !value_not_negative(precision, c->bound) ? "bound" : NULL;
}

static void store3(double to[3], vector3 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

void spring_collider_move(spring_collider *c, double t, uint32_t axes)
{
    const bool capsule = c->shape == SPRING_CAPSULE;
    contact_body b;
    spring_contact_place(&b, c, 0, DBL_EPSILON, t, t, axes);
    for (uint32_t a = 0; a < axes; a++) {
        const double change = t * c->acceleration[a];
        c->at[a] += t * (c->velocity[a] + change / 2);
        c->to[a] += capsule ? t * (c->velocity_to[a] + change / 2) : 0;
        c->velocity[a] += change;
        c->velocity_to[a] += capsule ? change : 0;
    }
    store3(c->spin, b.start.spin);
    for (int i = 0; i < (c->shape == SPRING_PLANE ? 1 : 3) && b.turns; i++)
        store3(c->axis[i], b.start.axis[i]);
    if (c->shape == SPRING_PLANE && b.turns) { /* b.surface is in its frame */
        double axis[3][3];
        for (int i = 0; i < 3; i++)
            store3(axis[i], b.start.axis[i]);
        for (uint32_t a = 0; a < axes; a++)
            c->surface[a] = b.surface.x * axis[0][a] + b.surface.y * axis[1][a] + b.surface.z * axis[2][a];
    }
}

/* ----------------------------------------------------------------------------------------------------- saved states */

/* Colliders: the shape and the mask, and numbers in the order of this table. */
static const struct {
    size_t offset, count;
} collider_numbers[] = {
    {offsetof(spring_collider, at), 3},           {offsetof(spring_collider, to), 3},
    {offsetof(spring_collider, axis), 9},         {offsetof(spring_collider, half), 3},
    {offsetof(spring_collider, radius), 1},       {offsetof(spring_collider, velocity), 3},
    {offsetof(spring_collider, velocity_to), 3},  {offsetof(spring_collider, spin), 3},
    {offsetof(spring_collider, friction), 1},     {offsetof(spring_collider, restitution), 1},
    {offsetof(spring_collider, acceleration), 3}, {offsetof(spring_collider, spin_acceleration), 3},
    {offsetof(spring_collider, surface), 3},      {offsetof(spring_collider, thickness), 1},
    {offsetof(spring_collider, bound), 1},
};
enum { collider_fields = sizeof collider_numbers / sizeof collider_numbers[0] };

/* Collider i of the scene, of which `set` are set: as it is, after it has been saved, or loaded, with its function. */
static spring_collider moved_collider(const spring_collider *own, uint32_t set, size_t i, uint8_t *state, bool load)
{
    spring_collider c = i < set ? own[i] : (spring_collider){0};
    uint64_t first = c.shape | (uint64_t)c.mask << 32;
    state += i * collider_words * word_bytes;
    move_numbers(&first, state, 1, word_bytes, load);
    c.shape = (spring_shape)(uint32_t)first;
    c.mask = (uint32_t)(first >> 32);
    state += word_bytes;
    for (int k = 0; k < collider_fields; state += collider_numbers[k++].count * word_bytes)
        move_numbers((char *)&c + collider_numbers[k].offset, state, collider_numbers[k].count, word_bytes, load);
    return c;
}

void spring_state_colliders(spring_collider *own, uint32_t set, size_t count, uint8_t *state, bool load)
{
    for (size_t i = 0; i < count; i++) {
        const spring_collider moved = moved_collider(own, set, i, state, load);
        if (load)
            own[i] = moved;
    }
}

bool spring_state_colliders_valid(const spring_collider *own, uint32_t set, size_t count, uint8_t *state,
                                  size_t precision, double radius, uint32_t axes)
{
    bool valid = true;
    for (size_t i = 0; i < count && valid; i++) {
        const spring_collider c = moved_collider(own, set, i, state, true);
        const bool custom = i < set && is_custom(own[i].shape);
        const uint32_t shape = (uint32_t)word_at(state + i * collider_words * word_bytes);
        valid = shape <= SPRING_CUSTOM && is_custom(c.shape) == custom &&
                spring_collider_invalid_field(&c, precision, radius, axes) == NULL;
    }
    return valid;
}

#include "../simd/size_end.h"
