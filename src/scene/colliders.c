/* SPDX-License-Identifier: MIT */
/* Colliders of a scene: setting them, their poses during a step, and balance at rest. contact.c has the
   formulas of contacts. */
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
    bool given = c->shape == SPRING_BOX;
    for (uint32_t i = 0; i < axes && c->shape == SPRING_CUSTOM; i++)
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

static bool fits_angles(const double v[3], uint32_t axes)
{
    return axes == 2 ? scalar_finite((scalar)v[2]) : fits3(v, axes);
}

/* The name of the first field that is not valid; NULL: none. radius: of particles, the largest */
static const char *invalid_field(const spring_collider *c, double radius, uint32_t axes)
{
    const double tolerance = 1e-3; /* of axes; products of many matrices of floats have errors of 1e-6 */
    const bool capsule = c->shape == SPRING_CAPSULE, plane = c->shape == SPRING_PLANE,
               custom = c->shape == SPRING_CUSTOM;
    if (!plane && !capsule && !custom && c->shape != SPRING_SPHERE && c->shape != SPRING_BOX)
        return "shape";
    if (!fits3(c->at, axes))
        return "at";
    if (capsule && !fits3(c->to, axes))
        return "to";
    if (!(orthonormality_error(c, axes_of_shape(c, axes), axes) <= tolerance))
        return "axis";
    if (plane && !scalar_finite((scalar)(dot_of(c->axis[0], c->at, axes) + radius)))
        return "at";
    for (uint32_t a = 0; a < axes && c->shape == SPRING_BOX; a++)
        if (!fits_not_negative(c->half[a]))
            return "half";
    if (!plane && !(c->radius >= 0 && fits_not_negative(c->radius + radius)))
        return "radius";
    if (!fits3(c->velocity, axes))
        return "velocity";
    if (capsule && !fits3(c->velocity_to, axes))
        return "velocity_to";
    if (!fits_angles(c->spin, axes))
        return "spin";
    if (!fits_not_negative(c->friction))
        return "friction";
    if (!(c->restitution >= 0 && c->restitution <= 1))
        return "restitution";
    if (!fits3(c->acceleration, axes))
        return "acceleration";
    if (!fits_angles(c->spin_acceleration, axes))
        return "spin_acceleration";
    if (!fits3(c->surface, axes))
        return "surface";
    if (custom && c->gap == NULL)
        return "gap";
    if (custom && !(c->thickness > 0 && scalar_finite((scalar)c->thickness)))
        return "thickness";
    return custom && !fits_not_negative(c->bound) ? "bound" : NULL;
}

/* ------------------------------------------------------------------------------------------------------------ poses */

static void copy3(scalar to[3], vector3 from)
{
    to[0] = (scalar)from.x;
    to[1] = (scalar)from.y;
    to[2] = (scalar)from.z;
}

static double dot_of_vectors(vector3 a, vector3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* A finite bound for loops with SIMD, where infinity times 0 would be NaN. */
static scalar bounded(double value)
{
    return value > (double)SCALAR_MAX ? SCALAR_MAX : value < -(double)SCALAR_MAX ? -SCALAR_MAX : (scalar)value;
}

/* Bound k: a body in the precision of the scene. Its reach grows by more than the rounding errors of coordinates. */
static void place_bound(collider_bounds *bounds, unsigned k, const contact_body *b, scalar largest_radius)
{
    const double rounding = 64 * (double)SCALAR_EPSILON * (b->size + (double)largest_radius);
    collider_bound *const to = &bounds->each[k];
    to->shape = b->shape == SPRING_CUSTOM ? SPRING_SPHERE : b->shape;
    copy3(to->at, b->start.at);
    copy3(to->shift, (vector3){b->end.at.x - b->start.at.x, b->end.at.y - b->start.at.y, b->end.at.z - b->start.at.z});
    for (int i = 0; i < 3; i++) {
        copy3(to->axis[i], b->start.axis[i]);
        to->half[i] = bounded(b->half[i]);
    }
    if (b->shape == SPRING_PLANE) {
        copy3(to->axis[1], b->end.axis[0]);
        to->offset[0] = (scalar)dot_of_vectors(b->start.axis[0], b->start.at);
        to->offset[1] = (scalar)dot_of_vectors(b->end.axis[0], b->end.at);
    }
    copy3(to->segment, b->start.segment);
    const double square = dot_of_vectors(b->start.segment, b->start.segment);
    to->inverse_square = square > 0 ? bounded(1 / square) : 0;
    to->reach = (scalar)((b->shape == SPRING_PLANE ? 0 : b->reach) + rounding);
    to->growth = (scalar)b->growth;
    const double margin = reach_of_box * b->growth * (double)largest_radius + rounding;
    for (int a = 0; a < 3; a++) {
        bounds->low[a][k] = (scalar)(b->low[a] - margin);
        bounds->high[a][k] = (scalar)(b->high[a] + margin);
    }
}

void spring_scene_place_colliders(spring_scene *s, double t0, double t1, bool all)
{
    const spring_collider *c = scene_read(s, ARRAY_COLLIDERS);
    contact_body *const body = scene_memory(s, ARRAY_PLACED);
    collider_bounds *const bounds = scene_memory(s, ARRAY_BOUNDS);
    bounds->count = s->colliders;
    double growth = 1;
    for (uint32_t i = 0; i < s->colliders; i++) {
        if (all || body[i].moves) {
            spring_contact_place(&body[i], &c[i], t0, t1, s->layout.axes);
            place_bound(bounds, i, &body[i], s->largest_radius);
        }
        growth = fmax(growth, body[i].growth);
    }
    bounds->growth = (scalar)growth; /* of this step: particles that are near do not depend on earlier steps */
    for (uint32_t i = s->colliders; all && i < most_colliders; i++) /* fill the last vector: they touch nothing */
        for (int a = 0; a < 3; a++) {
            bounds->low[a][i] = SCALAR_MAX;
            bounds->high[a][i] = -SCALAR_MAX;
        }
}

/* The position of `at`, t after the colliders were set. */
static void find_origin(const spring_scene *s, const spring_collider *c, double t, double origin[3])
{
    for (uint32_t a = 0; a < 3; a++)
        origin[a] = a < s->layout.axes ? c->at[a] + t * c->velocity[a] + t * t / 2 * c->acceleration[a] : 0;
}

void spring_scene_begin_impulses(spring_scene *s, double t)
{
    const spring_collider *c = scene_read(s, ARRAY_COLLIDERS);
    spring_impulse *const sum = scene_memory(s, ARRAY_IMPULSES);
    double(*const origin)[3] = scene_memory(s, ARRAY_ORIGINS);
    for (uint32_t i = 0; i < s->colliders; i++) {
        sum[s->layout.colliders + i] = (spring_impulse){{0}, {0}};
        find_origin(s, &c[i], t, origin[i]);
    }
}

/* Moves the reference points of angular impulses to the positions at the end of the call. */
void spring_scene_end_impulses(spring_scene *s, double t)
{
    const spring_collider *c = scene_read(s, ARRAY_COLLIDERS);
    spring_impulse *const sum = scene_memory(s, ARRAY_IMPULSES);
    double(*const origin)[3] = scene_memory(s, ARRAY_ORIGINS);
    for (uint32_t i = 0; i < s->colliders; i++) {
        spring_impulse j = sum[s->layout.colliders + i];
        double end[3], arm[3];
        find_origin(s, &c[i], t, end);
        for (int a = 0; a < 3; a++)
            arm[a] = origin[i][a] - end[a];
        for (int a = 0; a < 3; a++)
            j.angular[a] += arm[(a + 1) % 3] * j.linear[(a + 2) % 3] - arm[(a + 2) % 3] * j.linear[(a + 1) % 3];
        sum[i] = j;
    }
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
        if ((name = invalid_field(&c[i], (double)s->largest_radius, s->layout.axes)) == NULL)
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
    scene_clear_impulses(s);
    for (uint32_t buffer = 0; buffer < 2; buffer++) { /* without colliders no step writes them */
        uint32_t *const touched = scene_memory(s, touched_in(buffer));
        if (touched != NULL)
            memset(touched, 0, s->layout.particles * sizeof *touched);
    }
    return SPRING_OK;
}

static void store3(double to[3], vector3 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

/* Replaces a collider by its state t after it was set. */
static void move_collider(spring_collider *c, double t, uint32_t axes)
{
    const bool capsule = c->shape == SPRING_CAPSULE;
    contact_body b;
    spring_contact_place(&b, c, t, t, axes);
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
}

spring_status spring_scene_get_colliders(const spring_scene *s, spring_collider *out, uint32_t *count)
{
    if (s == NULL || count == NULL)
        return SPRING_EINVAL;
    const uint32_t room = *count;
    *count = s->colliders;
    if (out == NULL || room < s->colliders)
        return out == NULL ? SPRING_OK : SPRING_ENOMEM;
    const double t = colliders_time(s);
    for (uint32_t i = 0; i < s->colliders; i++) {
        out[i] = ((const spring_collider *)scene_read(s, ARRAY_COLLIDERS))[i];
        if (t != 0)
            move_collider(&out[i], t, s->layout.axes);
    }
    return SPRING_OK;
}

spring_status spring_scene_impulses(const spring_scene *s, spring_impulse *out, uint32_t first, uint32_t count)
{
    if (s == NULL || out == NULL)
        return SPRING_EINVAL;
    if (s->layout.colliders == 0)
        return SPRING_EDISABLED;
    if (first > s->colliders || count > s->colliders - first)
        return SPRING_ERANGE;
    const spring_impulse *const sum = scene_read(s, ARRAY_IMPULSES);
    memcpy(out, sum + first, count * sizeof *out);
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

double spring_scene_balanced(const spring_scene *s, size_t i, const double accel[3])
{
    const uint32_t *touched = scene_read(s, touched_in(s->buffer));
    const contact_body *body = scene_read(s, ARRAY_PLACED);
    contact_surface surface[most_colliders];
    contact_particle particle = {0};
    scene_contact_particle(s, i, &particle);
    double at[3] = {0};
    unsigned count = 0;
    for (uint32_t a = 0; a < s->layout.axes; a++)
        at[a] = (double)scene_state(s, SPRING_POSITION, a)[i];
    for (uint32_t k = 0; k < s->colliders && count + 3 <= most_colliders; k++)
        if ((touched[i] >> k & 1) != 0)
            count += spring_contact_surfaces(&body[k], &particle, true, (vector3){at[0], at[1], at[2]},
                                             (double)SCALAR_EPSILON, surface + count);
    return spring_contact_balance(surface, count, (vector3){accel[0], accel[1], accel[2]});
}

#include "../simd/size_end.h"
