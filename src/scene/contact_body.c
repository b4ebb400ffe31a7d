/* SPDX-License-Identifier: MIT */
/* Colliders as rigid bodies during a step: their poses at its start and end, bounds, and skins. The opening comment of
   contact.c explains them. */
#include "contact_vectors.h"

#include <float.h>

#include "../simd/size_begin.h"

/* Of a skin, in rounding errors of coordinates. It is four times as many as in slop_of(). */
static const double skin_thickness = 32;

/* The part of its skin by which the edges of a box are rounded. The rest makes the box wider, so that the seam of two
   boxes side by side lies on the faces of both. */
static const double skin_rounding = 0.25;

/* ------------------------------------------------------------------------------------------------------------ poses */

/* sin q/q, (1 - cos q)/q^2 and (q - sin q)/q^3, for the square of q. */
typedef struct rotation_factors {
    double first, second, third;
} rotation_factors;

static rotation_factors factors_of(double square)
{
    if (square < 1e-5) /* the first omitted terms are below 1e-19 */
        return (rotation_factors){1 - square / 6 * (1 - square / 20 * (1 - square / 42)),
                                  0.5 - square / 24 * (1 - square / 30 * (1 - square / 56)),
                                  1. / 6 - square / 120 * (1 - square / 42 * (1 - square / 72))};
    double sine, cosine, half_sine, half_cosine;
    const double angle = spring_sqrt(square);
    spring_sine_cosine(angle, &sine, &cosine);
    spring_sine_cosine(angle / 2, &half_sine, &half_cosine);
    return (rotation_factors){sine / angle, 2 * half_sine * half_sine / square, (angle - sine) / (angle * square)};
}

/* a turned by the vector phi (Rodrigues). */
static vector3 turned(vector3 phi, const rotation_factors *f, vector3 a)
{
    const vector3 b = cross(phi, a);
    return add_scaled(add_scaled(a, f->first, b), f->second, cross(phi, b));
}

static vector3 spin_of(const double spin[3], bool flat)
{
    return flat ? (vector3){0, 0, spin[2]} : vector_of(spin, false);
}

static bool has_spin(const spring_collider *c, bool flat)
{
    return !is_zero(spin_of(c->spin, flat)) || !is_zero(spin_of(c->spin_acceleration, flat));
}

static vector3 path_of(const double at[3], const double velocity[3], const double accel[3], double t, bool flat)
{
    return add_scaled(add_scaled(vector_of(at, flat), t, vector_of(velocity, flat)), t * t / 2, vector_of(accel, flat));
}

/* *phi: the angle vector since the collider was set. axis: at that time */
static void find_pose(body_pose *p, const spring_collider *c, const vector3 axis[3], double t, bool flat, bool turns,
                      vector3 *phi)
{
    p->at = path_of(c->at, c->velocity, c->acceleration, t, flat);
    p->velocity = add_scaled(vector_of(c->velocity, flat), t, vector_of(c->acceleration, flat));
    const vector3 spin = spin_of(c->spin, flat), spin_accel = spin_of(c->spin_acceleration, flat);
    const vector3 rate = add_scaled(spin, t, spin_accel);
    *phi = add_scaled(scale(t, spin), t * t / 2, spin_accel);
    p->spin = rate;
    for (int i = 0; i < 3; i++)
        p->axis[i] = axis[i];
    if (!turns)
        return;
    const rotation_factors f = factors_of(inner(*phi, *phi));
    for (int i = 0; i < 3; i++)
        p->axis[i] = turned(*phi, &f, axis[i]);
    const vector3 b = cross(*phi, rate);
    p->spin = add_scaled(add_scaled(rate, f.second, b), f.third, cross(*phi, b));
}

/* The axes at the time when the collider was set. */
static void find_axes(vector3 axis[3], const spring_collider *c, bool flat)
{
    for (int i = 0; i < 3; i++)
        axis[i] = (vector3){i == 0, i == 1, i == 2};
    bool given = c->shape == SPRING_BOX;
    for (int i = 0; i < 3 && is_custom(c->shape); i++)
        given = given || !is_zero(vector_of(c->axis[i], flat));
    for (int i = 0; i < (flat ? 2 : 3) && given; i++)
        axis[i] = vector_of(c->axis[i], flat);
    if (c->shape != SPRING_PLANE)
        return;
    axis[0] = vector_of(c->axis[0], flat);
    const vector3 other = fabs(axis[0].x) < 0.6 ? (vector3){1, 0, 0} : (vector3){0, 1, 0};
    const vector3 side = flat ? (vector3){-axis[0].y, axis[0].x, 0} : cross(axis[0], other);
    axis[1] = scale(1 / length3(side), side);
    axis[2] = cross(axis[0], axis[1]);
}

/* Turns the frame at the end of the step so that the axis of the capsule is the same in it, up to its length. The frame of
   a degenerate capsule does not turn. */
static void turn_with_segment(contact_body *b, vector3 from, vector3 to)
{
    const double before = length3(from), after = length3(to);
    b->start.segment = b->start.along = from;
    b->end.segment = b->end.along = to;
    const double cosine = inner(from, to) / (before * after);
    b->turns = !is_zero(subtract(from, to));
    b->degenerate = b->turns && !(before > 0 && after > 0 && cosine > -0.5);
    if (!b->turns || b->degenerate)
        return;
    const vector3 v = scale(1 / (before * after), cross(from, to));
    for (int i = 0; i < 3; i++) {
        const vector3 a = b->start.axis[i], once = cross(v, a);
        b->end.axis[i] = add_scaled(add(a, once), 1 / (1 + cosine), cross(v, once));
    }
    b->end.segment = scale(after / before, from);
}

/* ----------------------------------------------------------------------------------------------------------- bounds */

/* [m] The largest distance of the core from `at`. */
static double size_of_core(const contact_body *b)
{
    if (b->shape == SPRING_CAPSULE)
        return fmax(length3(b->start.segment), length3(b->end.segment));
    if (b->shape == SPRING_BOX)
        return length3((vector3){b->half[0], b->half[1], b->flat ? 0 : b->half[2]});
    return 0;
}

/* The box around the body at the start of the step, extended by `margin`. */
static void bound_with_box(contact_body *b, double margin)
{
    const body_pose *const p = &b->start;
    for (int a = 0; a < 3; a++) {
        const double at = component(p->at, a), along = component(p->along, a), n = component(p->axis[0], a);
        double below = b->shape == SPRING_CAPSULE ? fmin(along, 0) : 0;
        double above = b->shape == SPRING_CAPSULE ? fmax(along, 0) : 0;
        for (int i = 0; i < 3 && b->shape == SPRING_BOX; i++)
            above += !(b->flat && i == 2) ? fabs(component(p->axis[i], a)) * b->half[i] : 0;
        below = b->shape == SPRING_BOX ? -above : below;
        const bool plane = b->shape == SPRING_PLANE;
        b->low[a] = plane && (n != -1 || b->turns) ? -(double)INFINITY : at + below - margin;
        b->high[a] = plane && (n != 1 || b->turns) ? (double)INFINITY : at + above + margin;
    }
}

/* If a body turns by the angle A within a step, points of the frame at the distance l from its origin are displaced by
   A l, so |y1 - y0| <= |d - shift| + A |x0 - at|, where |x0 - at| <= distance from the core + size of the core. A chord
   touches the body only if the distance at its start is at most the radii + |y1 - y0|. */
static void find_bounds(contact_body *b, double angle, double custom_bound)
{
    const double infinite = (double)INFINITY, shift = length3(subtract(b->end.at, b->start.at));
    const double radius = is_custom(b->shape) ? b->radius + (custom_bound > 0 ? custom_bound : infinite) : b->radius;
    double stretch = 0;
    if (b->shape == SPRING_CAPSULE)
        stretch = length3(subtract(b->end.segment, b->start.segment));
    const bool unbounded = !(angle < 0.5);
    b->growth = unbounded ? 1 : 1 / (1 - angle);
    b->reach = unbounded ? infinite : (radius + stretch + angle * size_of_core(b)) * b->growth;
    bound_with_box(b, rounded_up * (b->reach + b->growth * shift));
}

/* [m] A bound on |x| + |y| + |z| of the points of a collider, relative to `at`. Planes: 0 */
static double extent_of(const spring_collider *c, bool flat)
{
    double extent = c->shape == SPRING_PLANE ? 0 : c->radius;
    if (c->shape == SPRING_CAPSULE)
        extent += size_sum(subtract(vector_of(c->to, flat), vector_of(c->at, flat)));
    if (c->shape == SPRING_BOX)
        extent += size_sum(vector_of(c->half, flat));
    if (is_custom(c->shape))
        extent += c->bound;
    return extent;
}

/* [m] The size of the coordinates that the surface of a collider follows from. */
static double size_of(const spring_collider *c, bool flat)
{
    const vector3 at = vector_of(c->at, flat), n = vector_of(c->axis[0], flat);
    const double extent = is_custom(c->shape) ? c->radius : extent_of(c, flat);
    return c->shape == SPRING_PLANE ? fabs(inner(n, at)) * size_sum(n) : size_sum(at) + extent;
}

/* Whether a collider may touch a box, or come close to it before colliders are set again. */
static bool is_near(const spring_collider *box, const spring_collider *c, bool flat)
{
    const double reach = 2 * (extent_of(box, flat) + extent_of(c, flat));
    const vector3 arm = subtract(vector_of(box->at, flat), vector_of(c->at, flat));
    const double distance = c->shape == SPRING_PLANE ? fabs(inner(vector_of(c->axis[0], flat), arm)) : size_sum(arm);
    return distance <= reach || (is_custom(c->shape) && c->bound == 0);
}

double spring_contact_skin(const spring_collider *c, unsigned count, double epsilon, uint32_t axes)
{
    const bool flat = axes == 2;
    double size = 0;
    for (unsigned i = 0; i < count; i++)
        for (unsigned k = 0; c[i].shape == SPRING_BOX && k < count; k++)
            if (k != i && is_near(&c[i], &c[k], flat))
                size = fmax(size, fmax(size_of(&c[i], flat), size_of(&c[k], flat)));
    return skin_thickness * epsilon * size;
}

double spring_contact_motion(const contact_body *b)
{
    const body_pose *const start = &b->start, *const end = &b->end;
    if (b->shape == SPRING_PLANE && b->turns)
        return (double)INFINITY;
    double motion = length3(subtract(start->at, end->at));
    for (int i = 0; i < (b->flat ? 2 : 3) && b->shape == SPRING_BOX && b->turns; i++)
        motion += b->half[i] * length3(subtract(start->axis[i], end->axis[i]));
    return b->shape == SPRING_CAPSULE ? motion + length3(subtract(start->along, end->along)) : motion;
}

double spring_contact_rounding_scale(const contact_body *b, const body_pose *pose, double epsilon)
{
    double size = size_sum(pose->at) + b->radius + size_sum(pose->segment) +
                  (is_custom(b->shape) ? b->thickness * (DBL_EPSILON / epsilon) : 0);
    for (int a = 0; a < (b->flat ? 2 : 3) && b->shape == SPRING_BOX; a++)
        size += b->half[a];
    return size;
}

void spring_contact_place(contact_body *b, const spring_collider *c, double skin, double epsilon, double t0, double t1,
                          uint32_t axes)
{
    const bool flat = axes == 2, capsule = c->shape == SPRING_CAPSULE, plane = c->shape == SPRING_PLANE;
    const bool spins = has_spin(c, flat), round = capsule || c->shape == SPRING_SPHERE;
    const vector3 velocity = vector_of(c->velocity, flat), accel = vector_of(c->acceleration, flat);
    const double wider = c->shape == SPRING_BOX ? (1 - skin_rounding) * skin : 0;
    *b = (contact_body){
        .shape = c->shape,
        .turns = spins && !round,
        .flat = flat,
        .bits = c->mask != 0 ? c->mask : UINT32_MAX,
        .half = {c->half[0] + wider, c->half[1] + wider, flat ? (double)INFINITY : c->half[2] + wider},
        .radius = (plane ? 0 : c->radius) + (skin - wider),
        .skin = skin,
        .friction = c->friction,
        .restitution = c->restitution,
        .thickness = c->thickness,
        .surface = vector_of(c->surface, flat),
        .gap = c->gap,
        .user = c->user,
    };
    b->slips = !is_zero(b->surface) || (spins && round);
    b->moves =
        b->turns || !is_zero(velocity) || !is_zero(accel) || (spins && !is_zero(spin_of(c->spin_acceleration, flat)));
    vector3 axis[3], phi0, phi1;
    find_axes(axis, c, flat);
    find_pose(&b->start, c, axis, t0, flat, b->turns, &phi0);
    find_pose(&b->end, c, axis, t1, flat, b->turns, &phi1);
    if (plane &&
        !b->turns) { /* the point that is nearest to the origin, so that the distance of `at` does not matter */
        const vector3 shift = subtract(b->end.at, b->start.at);
        b->start.at = scale(inner(axis[0], b->start.at), axis[0]);
        b->end.at = add(b->start.at, shift);
    }
    /* `surface` has the axes of the scene for shapes without axes of their own. */
    if (plane)
        b->surface = direction_in(&(body_pose){.axis = {axis[0], axis[1], axis[2]}}, b->surface);
    double angle = b->turns ? length3(subtract(phi1, phi0)) : 0;
    if (capsule) {
        vector3 from = subtract(vector_of(c->to, flat), vector_of(c->at, flat)), to = from;
        b->start.stretching = b->end.stretching = subtract(vector_of(c->velocity_to, flat), velocity);
        if (!is_zero(b->start.stretching)) {
            from = subtract(path_of(c->to, c->velocity_to, c->acceleration, t0, flat), b->start.at);
            to = subtract(path_of(c->to, c->velocity_to, c->acceleration, t1, flat), b->end.at);
            b->moves = true;
        }
        turn_with_segment(b, from, to);
        for (int i = 0; b->turns && i < 3; i++)
            angle += 2 * length3(subtract(b->end.axis[i], b->start.axis[i]));
    }
    b->rounding_scale = spring_contact_rounding_scale(b, &b->start, epsilon);
    find_bounds(b, angle, c->bound);
}

#include "../simd/size_end.h"
