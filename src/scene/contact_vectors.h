/* SPDX-License-Identifier: MIT */
/* Vectors in double, and coordinates in the frame of a body. For the sources of contacts. */
#ifndef SPRINGSTEP_CONTACT_VECTORS_H
#define SPRINGSTEP_CONTACT_VECTORS_H

#include "contact.h"

#include "../simd/compiler.h"
#include "../spring/propagator.h"

#include <math.h>

static const vector3 zero3 = {0, 0, 0};

SPRING_INLINE vector3 add(vector3 a, vector3 b)
{
    return (vector3){a.x + b.x, a.y + b.y, a.z + b.z};
}

SPRING_INLINE vector3 subtract(vector3 a, vector3 b)
{
    return (vector3){a.x - b.x, a.y - b.y, a.z - b.z};
}

SPRING_INLINE vector3 scale(double s, vector3 a)
{
    return (vector3){s * a.x, s * a.y, s * a.z};
}

SPRING_INLINE vector3 add_scaled(vector3 a, double s, vector3 b) /* a + s b */
{
    return (vector3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

/* Copies one number at a time. Compilers would copy two at once, which waits for the stores of each. */
SPRING_INLINE void put(vector3 *to, vector3 from)
{
    to->x = from.x;
    to->y = from.y;
    to->z = from.z;
}

SPRING_INLINE double inner(vector3 a, vector3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

SPRING_INLINE double length3(vector3 a)
{
    return spring_sqrt(inner(a, a));
}

SPRING_INLINE double size_sum(vector3 a) /* the sum of the sizes of its components */
{
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

SPRING_INLINE vector3 cross(vector3 a, vector3 b)
{
    return (vector3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

SPRING_INLINE vector3 between(vector3 a, vector3 b, double fraction)
{
    return add_scaled(a, fraction, subtract(b, a));
}

SPRING_INLINE vector3 tangential(vector3 u, vector3 n)
{
    return add_scaled(u, -inner(u, n), n);
}

SPRING_INLINE vector3 vector_of(const double v[3], bool flat)
{
    return (vector3){v[0], v[1], flat ? 0 : v[2]};
}

SPRING_INLINE bool is_zero(vector3 a)
{
    return a.x == 0 && a.y == 0 && a.z == 0;
}

SPRING_INLINE double component(vector3 a, int i)
{
    return i == 0 ? a.x : i == 1 ? a.y : a.z;
}

/* The coordinates of a direction or a place in a frame, and back. */
SPRING_INLINE vector3 direction_in(const body_pose *p, vector3 a)
{
    return (vector3){inner(a, p->axis[0]), inner(a, p->axis[1]), inner(a, p->axis[2])};
}

SPRING_INLINE vector3 direction_out(const body_pose *p, vector3 y)
{
    return add_scaled(add_scaled(scale(y.x, p->axis[0]), y.y, p->axis[1]), y.z, p->axis[2]);
}

SPRING_INLINE vector3 place_in(const body_pose *p, vector3 x)
{
    return direction_in(p, subtract(x, p->at));
}

SPRING_INLINE vector3 place_out(const body_pose *p, vector3 y)
{
    return add(p->at, direction_out(p, y));
}

#endif
