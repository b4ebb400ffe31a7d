/* SPDX-License-Identifier: MIT */
/*
 * Contacts of particles with rigid colliders: constraints on the drift, with the time of impact.
 *
 * Symbols   x0 is the position of a particle, v0 its velocity at the start of the step and w after the kick, a the
 *           acceleration of that kick, h the step, d = h w the displacement, V the velocity of the surface, n the normal,
 *           and theta the fraction of the step before the contact. u is a velocity relative to V, and u_t its component
 *           along the surface. e is the restitution and mu the friction. R and c are the rotation and the origin of the
 *           frame of the body.
 * Frame     All distances are computed in the frame of the body, where it is at rest: y = R^T (x - c) at the start and
 *           at the end of the step. The path is defined as the chord y0 + theta (y1 - y0). The gap to a convex body
 *           along a chord is a convex function. A capsule whose ends have different velocities turns by the smallest
 *           rotation that takes its axis along. The spin of spheres and capsules does not turn their frame.
 * Skin      In scenes with a box and another collider near it, all bodies are larger by 32 rounding errors, so that a
 *           particle without radius on one of them is not beyond the edge of another. The skin is the same for all, so
 *           that the tops of boxes side by side stay one face. A path that starts in a skin is moved out of it.
 * Drift     For each contact, in the order of the times of impact:
 *           1. A particle that is inside at the start is moved out along n, without a change of velocity. If it is
 *              inside several colliders, it is moved out of the first, and then out of each that it is still inside.
 *           2. Newton's method on the gap along the chord gives the time of impact: theta <- theta + gap/(rate of
 *              approach). It never overshoots, because the gap is convex. Custom bodies: see find_custom_impact().
 *           3. Impact, if n.u < 0, with u = v0 + theta h a - V, or u = w - V at a second contact: the impulse is
 *              -(1 + e) n.u n times the mass, with friction along -u_t of at most mu times its size. The rest of the
 *              path, (1 - theta) h, has the changed velocity.
 *           4. Pressing, if the rest of the path still ends inside. Early, in the first half of the step: the impulse
 *              is lambda n, with the lambda for which the path ends on the surface. Late (in the second half of the step,
 *              at a second contact of the step, or after item 1): the path is projected to the tangent plane, and w
 *              loses its component into the collider. Where another body continues the face, as on a floor of boxes,
 *              the path ends on the tangent plane. The same if a path along a face of a box hits another body.
 *           5. After a contact, the other colliders are tested with the changed path. After eight contacts, a path that
 *              would pass through the next body ends on it. A particle that is still inside at the end (corners) is moved
 *              by the least D with n_i.D >= depth_i, and w loses its components into these. A pass moves it by at most the
 *              length of its path and the largest depth, because the tangent planes of surfaces that are almost face to
 *              face meet far away. Each pass lengthens the path, so the next can move it farther. A particle that is then
 *              on the other side of a box that it has touched returns to its place at the start.
 * Friction  A particle that rests on the surface from the start slides by u' = (A - F u/|u|)/h, where A is the change
 *           of u by other forces and F = 2 mu lambda. It stops within the step where u = 0, and then sticks if
 *           |A| <= F. w is chosen so that the last kick gives the velocity at the end. A particle that sticks from the
 *           start is carried by the rigid motion.
 * Kick      The last kick, for colliders that were touched: v loses its components into them, by the least change
 *           with n_i.v >= n_i.V_i, with friction of at most mu times each of these. Static friction gives v = V.
 * Impulses  A contact that changes the end of the path from x to x1 and the velocity from w to w1 gives its collider the
 *           impulse m (w - w1) and the angular impulse m cross(x, w) - m cross(x1, w1). A free path keeps cross(x, w),
 *           so this is exact for changes at any time of the step, and for displacements.
 * Order     2 with leapfrog and RK4, also across impacts, with sliding friction, and across reversals: docs/evidence.md.
 * Source    impulses: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988); the constraint in
 *           the drift: Andersen, RATTLE, J. Comput. Phys. 52 (1983); rotations: Rodrigues (1840). The closed forms are
 *           in tests/scene/test_contacts.c.
 */
#include "contact_vectors.h"

#include <float.h>

#include "../simd/size_begin.h"

enum {
    impact_iterations = 12, /* of item 2 */
    friction_passes = 2,    /* of item 4: friction changes where the path ends, and so the impulse */
    surface_iterations = 3, /* of item 4 */
    custom_iterations = 8,  /* the same for custom bodies */
    march_steps = 256,      /* of find_custom_impact() */
    root_steps = 40,
    walk_steps = 128, /* of walk() */
    walk_pushes = 8,
    contact_rounds = 8,    /* contacts of a particle in a drift */
    corner_passes = 6,     /* of item 5 */
    most_constraints = 12, /* on a particle; further ones are ignored */
    seidel_rounds = 32,    /* where no particle can fit, as between plates that close */
    slide_parts = 4        /* of a step in which friction turns */
};

/* Fractions of a step up to this size are rounding errors. */
static const double least_fraction = 1e-13;

/* The cosine between normals of a custom body on the same face. */
static const double same_face = 0.9;

/* Contacts of a custom body whose gaps differ by this number of slops are at the same place: rounding errors of its
   function, which computes in double, and of the position of the particle. */
static const double same_place = 1e3, same_position = 4;

/* The cosine between normals of faces that are one face. */
static const double same_plane = 1 - 1e-9;

/* The cosine between the normals at the start and at the end of a path that presses; a smaller one counts as this. */
static const double least_cosine = 0.1;

/* u, or u shortened to the length `most`. */
SPRING_INLINE vector3 shortened(vector3 u, double most)
{
    const double square = inner(u, u);
    return square > most * most ? scale(most / spring_sqrt(square), u) : u;
}

/* -------------------------------------------------------------------------------------------------------- distances */

/* A place near a body, in its frame. */
typedef struct near_point {
    double gap;     /* [m] negative inside */
    vector3 normal; /* unit vector, out of the body */
    double along;   /* capsule: position of the nearest point of its axis, from 0 at `at` to 1 at `to`; else 0 */
    bool several;   /* the function of a custom body returned several contacts */
} near_point;

/* from_core: from the nearest point of the core. In the core itself, the normal is +y. */
SPRING_INLINE void find_round(near_point *out, vector3 from_core, double radius)
{
    const double square = inner(from_core, from_core), distance = spring_sqrt(square);
    out->normal = square > 0 ? scale(1 / distance, from_core) : (vector3){0, 1, 0};
    out->gap = distance - radius;
}

SPRING_INLINE void find_capsule(near_point *out, vector3 y, vector3 axis, double radius)
{
    const double square = inner(axis, axis), along = square > 0 ? inner(y, axis) / square : 0;
    out->along = along > 0 ? (along < 1 ? along : 1) : 0;
    find_round(out, add_scaled(y, -out->along, axis), radius);
}

/* How far a coordinate is beyond +-half, with its sign. */
SPRING_INLINE double beyond(double a, double half)
{
    return a > half ? a - half : a < -half ? a + half : 0;
}

SPRING_INLINE void find_box(near_point *out, const contact_body *b, vector3 y, double radius)
{
    const double x_gap = fabs(y.x) - b->half[0], y_gap = fabs(y.y) - b->half[1], z_gap = fabs(y.z) - b->half[2];
    if ((x_gap > 0) + (y_gap > 0) + (z_gap > 0) > 1) { /* an edge or a corner */
        const vector3 over = {beyond(y.x, b->half[0]), beyond(y.y, b->half[1]), beyond(y.z, b->half[2])};
        find_round(out, over, radius);
        return;
    }
    const bool z_first = z_gap > x_gap && z_gap > y_gap, y_first = !z_first && y_gap > x_gap;
    const double at = z_first ? y.z : y_first ? y.y : y.x, side = at < 0 ? -1 : 1;
    out->gap = (z_first ? z_gap : y_first ? y_gap : x_gap) - radius;
    out->normal.x = z_first || y_first ? 0 : side;
    out->normal.y = y_first ? side : 0;
    out->normal.z = z_first ? side : 0;
}

/* Calls the function of a custom body. Returns the number of contacts, 1 to 3. */
static unsigned find_custom(contact_particle *p, const contact_body *b, vector3 y, near_point out[3])
{
    const double point[3] = {y.x, y.y, y.z};
    double gap[3] = {0}, normal[3][3] = {{0}};
    unsigned count = b->gap(b->user, point, gap, normal);
    bool finite = count > 0;
    count = count > 3 ? 3 : count;
    for (unsigned i = 0; i < count; i++) {
        out[i] = (near_point){gap[i] - b->radius - p->radius, vector_of(normal[i], b->flat), 0, count > 1};
        finite = finite && spring_finite(out[i].gap) && spring_finite(size_sum(out[i].normal));
    }
    if (finite)
        return count;
    p->wrong = true;
    out[0] = (near_point){DBL_MAX, {0, 1, 0}, 0, false}; /* so that all loops end */
    return 1;
}

/* The nearest point of the surface from y, at the given fraction of the step. */
SPRING_NOINLINE void find_nearest_to(contact_particle *p, const contact_body *b, double fraction, double x, double y_,
                                     double z, near_point *out)
{
    const vector3 y = {x, y_, z};
    const double radius = b->radius + p->radius;
    out->along = 0;
    switch (b->shape) {
    case SPRING_PLANE:
        out->normal = (vector3){1, 0, 0};
        out->gap = y.x - radius;
        break;
    case SPRING_CAPSULE:
        find_capsule(out, y, b->turns ? between(b->start.segment, b->end.segment, fraction) : b->start.segment, radius);
        break;
    case SPRING_BOX:
        find_box(out, b, y, radius);
        break;
    case SPRING_CUSTOM: {
        if (!is_custom(b->shape))
            break;
        near_point all[3];
        const unsigned count = find_custom(p, b, y, all);
        *out = all[0];
        for (unsigned i = 1; i < count; i++)
            *out = all[i].gap < out->gap ? all[i] : *out;
        break;
    }
    case SPRING_SPHERE:
        find_round(out, y, radius);
        break;
    }
}

SPRING_INLINE void find_nearest(contact_particle *p, const contact_body *b, double fraction, vector3 y, near_point *out)
{
    find_nearest_to(p, b, fraction, y.x, y.y, y.z, out);
}

/* All contacts at x, with their normals in the scene. More than one only for some custom bodies. The end of a step
   must give the same bits as the start of the next one. A capsule has another frame in each step, so it is computed in
   the axes of the scene. */
static unsigned find_all(contact_particle *p, const contact_body *b, const body_pose *pose, vector3 x,
                         near_point out[3])
{
    if (b->shape == SPRING_CAPSULE) {
        find_capsule(out, subtract(x, pose->at), pose->along, b->radius + p->radius);
        return 1;
    }
    const vector3 y = place_in(pose, x);
    unsigned count = 1;
    if (is_custom(b->shape))
        count = find_custom(p, b, y, out);
    else
        find_nearest(p, b, 0, y, out);
    for (unsigned i = 0; i < count; i++)
        out[i].normal = direction_out(pose, out[i].normal);
    return count;
}

/* [m] Gaps below this are rounding errors. */
SPRING_INLINE double slop_at(const contact_setting *s, vector3 x, double size, double particle_radius)
{
    return 8 * s->epsilon * (size_sum(x) + size + particle_radius);
}

SPRING_INLINE double slop_of(const contact_setting *s, const contact_particle *p, const contact_body *b)
{
    return slop_at(s, p->x0, b->rounding_scale, p->radius);
}

/* [m] Faces side by side whose heights differ by less are one face, in double precision too: coordinates may have been
   computed in single precision. */
SPRING_INLINE double flush_of(const contact_particle *p, const contact_body *b)
{
    return 8 * (double)FLT_EPSILON * (size_sum(p->x0) + b->rounding_scale + p->radius);
}

/* [m] Contacts whose gaps differ by less act together in a stop at x. It depends on the pose and not on the step, so
   that the end of a step has the result of the start of the next. */
static double gap_tolerance(const contact_setting *s, const contact_particle *p, const contact_body *b, bool at_end,
                            vector3 x)
{
    const double size = spring_contact_rounding_scale(b, at_end ? &b->end : &b->start, s->epsilon);
    return fmax(same_place * (DBL_EPSILON / s->epsilon), same_position) * slop_at(s, x, size, p->radius);
}

/* [m/s] Velocity of a point of the frame at x. */
SPRING_INLINE vector3 frame_velocity(const contact_body *b, const body_pose *pose, double along, vector3 x)
{
    const vector3 v = b->shape == SPRING_CAPSULE ? add_scaled(pose->velocity, along, pose->stretching) : pose->velocity;
    return b->turns && b->shape != SPRING_CAPSULE ? add(v, cross(pose->spin, subtract(x, pose->at))) : v;
}

/* [m/s] Velocity of the surface relative to the frame, at x. n: in the scene */
SPRING_NOINLINE vector3 slip_velocity(const contact_body *b, const body_pose *pose, double along, vector3 x, vector3 n)
{
    const bool round = b->shape == SPRING_SPHERE || b->shape == SPRING_CAPSULE; /* in the axes of the scene */
    vector3 v = tangential(round ? b->surface : direction_out(pose, b->surface), n);
    if (round) {
        const vector3 centre = add_scaled(pose->at, along, pose->along);
        v = add(v, cross(pose->spin, subtract(x, centre)));
    }
    return v;
}

SPRING_INLINE vector3 surface_velocity(const contact_body *b, const body_pose *pose, double along, vector3 x, vector3 n)
{
    const vector3 v = frame_velocity(b, pose, along, x);
    return b->slips ? add(v, slip_velocity(b, pose, along, x, n)) : v;
}

/* --------------------------------------------------------------------------------------------------------- impulses */

/* The moment is cross(x - x1, w1) + cross(x - origin, w - w1). In the first term w1 is replaced by w1 + kick, the
   velocity at the end of the step. */
void spring_contact_record(const contact_setting *s, const contact_particle *p, unsigned i, const vector3 *x,
                           const vector3 *w, const vector3 *x1, const vector3 *w1)
{
    if (!s->records)
        return;
    const double *const origin = s->origin[i];
    const vector3 arm = {x->x - origin[0], x->y - origin[1], x->z - origin[2]};
    const vector3 change = subtract(*w, *w1), way = subtract(*x, *x1);
    const vector3 moment = add(cross(arm, change), cross(way, add(*w1, p->kick)));
    double *const linear = s->impulse[i].linear, *const angular = s->impulse[i].angular;
    linear[0] += p->mass * change.x;
    linear[1] += p->mass * change.y;
    linear[2] += p->mass * change.z;
    angular[0] += p->mass * moment.x;
    angular[1] += p->mass * moment.y;
    angular[2] += p->mass * moment.z;
}

/* --------------------------------------------------------------------------------------------------------- friction */

/* Sliding over the rest of a step. kick: [m/s] the velocity that the last kick, by A/2 with friction F/2, turns into the
   velocity at the end */
typedef struct slide_result {
    bool sticks;  /* at the end */
    vector3 mean; /* [m/s] velocity */
    vector3 kick;
} slide_result;

/* u' = A - F u/|u| from u0 for a unit of time, with the stop at u = 0 and what follows. On a line it is exact. Where
   friction turns, the time is divided into parts. */
SPRING_NOINLINE void slide_from(double ux, double uy, double uz, double ax, double ay, double az, double F,
                                int most_parts, slide_result *out)
{
    const vector3 u0 = {ux, uy, uz}, A = {ax, ay, az};
    out->sticks = true;
    out->mean = out->kick = zero3;
    if (is_zero(u0) && inner(A, A) <= F * F)
        return;
    const vector3 across = cross(u0, A);
    const double square = inner(u0, u0);
    const bool turns = square < 64 * F * F && inner(across, across) > 1e-24 * square * inner(A, A);
    const int parts = turns ? most_parts : 1;
    const double part = 1. / parts, f = F * part;
    const vector3 a = scale(part, A);
    vector3 u = u0, sum = zero3, direction = zero3; /* sum: twice the way, in units of a part */
    bool sticks = false;
    for (int i = 0; i < parts; i++) {
        const double speed = length3(u);
        vector3 at_stop = zero3;
        double stop = 0; /* time of the stop, in parts */
        if (speed > 0) {
            const vector3 along = scale(1 / speed, u);
            const double deceleration = f - inner(a, along);
            if (!(deceleration > speed)) { /* it does not stop */
                vector3 next = add(u, a);
                double length = length3(next);
                if (parts == 1 || speed > 4 * f) { /* Heun's method, if friction turns */
                    const vector3 end = parts == 1 ? along : add_scaled(next, -f, along);
                    const double end_length = parts == 1 ? 1 : length3(end);
                    next = add_scaled(add_scaled(next, -f / 2, along), -f / 2 / end_length, end);
                    direction = along;
                } else { /* slow: the direction at the end, or it would zigzag */
                    next = length > f ? scale(1 - f / length, next) : zero3;
                }
                sum = add(sum, add(u, next));
                u = next;
                length = length3(u);
                sticks = !(length > 0);
                if (!sticks && parts > 1)
                    direction = scale(1 / length, u);
                continue;
            }
            stop = speed / deceleration;
            at_stop = tangential(add_scaled(u, stop, add_scaled(a, -f, along)), along);
        }
        const double rest = 1 - stop;
        const vector3 pushed = add_scaled(at_stop, rest, a);
        const double length = length3(pushed);
        sum = add_scaled(sum, stop, add(u, at_stop));
        sticks = length <= f * rest;
        if (sticks) {
            const double left = length3(at_stop);
            sum = add_scaled(sum, f > 0 ? fmin(rest, left / f) : 0, at_stop);
            u = zero3;
            continue;
        }
        direction = scale(1 / length, pushed);
        const vector3 end = add_scaled(pushed, -f * rest, direction);
        sum = add_scaled(sum, rest, add(at_stop, end));
        u = end;
    }
    out->sticks = sticks;
    out->mean = scale(part / 2, sum);
    if (!sticks)
        out->kick = add_scaled(add_scaled(u, -0.5, A), 0.5 * F, direction);
}

SPRING_INLINE void slide(vector3 u0, vector3 A, double F, int most_parts, slide_result *out)
{
    slide_from(u0.x, u0.y, u0.z, A.x, A.y, A.z, F, most_parts, out);
}

/* -------------------------------------------------------------------------------------------------------- one collider */

/* The contacts of a particle in a step. */
typedef struct contact_history {
    unsigned count;
    unsigned body[contact_rounds];
    vector3 normal[contact_rounds]; /* in the scene */
} contact_history;

/* A contact of a particle with a body during a drift. */
typedef struct meeting {
    const contact_body *b;
    unsigned index;
    bool again;                     /* the particle has touched a collider in this step */
    const contact_history *earlier; /* NULL: none */
    double slop;                    /* [m] */
    vector3 start, way;             /* [m] in the frame: the chord */
    near_point at;                  /* at the time of the contact */
    double fraction, gap;
    double start_depth; /* [m] inside the body at the start, if that is more than the slop; else 0 */
    vector3 place;      /* in the frame */
    vector3 n, n_end;   /* normal in the scene, and its direction at the end of the step */
    double time_left;   /* [s] of the step, after the contact */
    vector3 velocity;   /* [m/s] of the surface */
    bool walks;         /* the way is long compared with a custom body's thickness */
    bool goes_on;       /* the path stays on the tangent plane: another body continues the face, or is hit */
} meeting;

enum { NO_CONTACT = 0, CONTACT = 1, CLEAR = 2 }; /* CLEAR: the path is known to end outside */

/* [m] The step by which a path may enter a custom body: less than half of its thickness, so that it does not reach the
   middle, where the normal changes sides. */
SPRING_INLINE double custom_step(const contact_body *b)
{
    return 0.4 * b->thickness;
}

SPRING_INLINE vector3 end_in_frame(const contact_body *b, const contact_particle *p)
{
    return place_in(&b->end, add(p->x0, p->d));
}

static double gap_at_end(contact_particle *p, const contact_body *b, near_point *at)
{
    find_nearest(p, b, 1, end_in_frame(b, p), at);
    return at->gap;
}

/* Subtracts the motion of the nearest point when a capsule changes its length. */
SPRING_INLINE double approach(const meeting *m)
{
    const contact_body *const b = m->b;
    const double rate = inner(m->at.normal, m->way);
    if (b->shape != SPRING_CAPSULE || !b->turns)
        return rate;
    return rate - m->at.along * inner(m->at.normal, subtract(b->end.segment, b->start.segment));
}

static bool find_convex_impact(contact_particle *p, meeting *m)
{
    for (int i = 0;; i++) {
        const double rate = approach(m);
        if (m->start_depth > 0)
            return true;
        if (m->gap + (1 - m->fraction) * rate >= 0)
            return false;
        const double step = m->gap / -rate;
        if (i == impact_iterations || !(step > 1e-14 * (1 - m->fraction)))
            return true;
        m->fraction += step;
        find_nearest(p, m->b, m->fraction, add_scaled(m->start, m->fraction, m->way), &m->at);
        m->gap = m->at.gap > 0 ? m->at.gap : 0;
    }
}

/* Marches along the chord by the gap, but at least by custom_step(), until it is inside, and then finds the root. If
   there is no end to it, the path ends at the last point that is known to be outside. */
static bool find_custom_impact(contact_particle *p, meeting *m)
{
    const contact_body *const b = m->b;
    const double length = length3(m->way);
    if (!(length > 0))
        return false;
    double last = 0, before = m->gap;
    near_point outside = m->at, next;
    for (int i = 0; i < march_steps; i++) {
        const double now = fmin(1, last + fmax(before, custom_step(b)) / length);
        find_nearest(p, b, now, add_scaled(m->start, now, m->way), &next);
        if (next.gap >= 0) {
            last = now;
            before = next.gap;
            outside = next;
            if (now >= 1)
                return false;
            continue;
        }
        double low = last, high = now, above = before, below = next.gap;
        for (int k = 0; k < root_steps && high - low > 1e-15; k++) {
            const double share = k < root_steps / 2 ? fmin(0.9, fmax(0.1, above / (above - below))) : 0.5;
            const double middle = low + (high - low) * share;
            find_nearest(p, b, middle, add_scaled(m->start, middle, m->way), &next);
            if (next.gap < 0) {
                high = middle;
                below = next.gap;
                continue;
            }
            low = middle;
            above = next.gap;
            outside = next;
            if (above < 1e-13 * (length + p->radius))
                break;
        }
        m->fraction = low;
        m->gap = above;
        m->at = outside;
        return true;
    }
    p->d = subtract(place_out(&b->end, add_scaled(m->start, last, m->way)), p->x0);
    return false;
}

/* Whether a face of a box continues a face that the particle has touched in this step, and the chord stays on its outer
   side. Along the face, Newton's method would take rounding errors for an impact. flush: [m] how deep the chord may start.
   If it starts away from the box, it may also go so much deeper. */
static bool passes_face(const contact_body *b, const meeting *m, double radius, double flush)
{
    const double down = m->at.gap > m->slop ? flush : m->slop;
    for (unsigned k = 0; m->earlier != NULL && k < m->earlier->count && b->shape == SPRING_BOX; k++) {
        const vector3 n = direction_in(&b->end, m->earlier->normal[k]);
        for (int a = 0; a < 3; a++) {
            const double side = component(n, a), above = side * component(m->start, a) - b->half[a] - radius;
            if (fabs(side) > same_plane && above >= -flush && side * component(m->way, a) >= -fmax(above, 0) - down)
                return true;
        }
    }
    return false;
}

/* Whether the gap to another body is from `least` to `most`, at the distance `out` from the start of the chord along a normal
   of a box. facing: the largest cosine between the normals */
static bool is_beyond(const contact_setting *s, contact_particle *p, const meeting *m, vector3 normal, double out,
                      double least, double most, double facing)
{
    const vector3 x = place_out(&m->b->start, add_scaled(m->start, out, normal));
    const vector3 n = direction_out(&m->b->start, normal);
    for (unsigned i = 0; i < s->count; i++) {
        const contact_body *const b = &s->body[i];
        near_point at;
        if (i == m->index || (b->bits & p->bits) == 0 || is_custom(b->shape))
            continue;
        find_nearest(p, b, 0, place_in(&b->start, x), &at);
        if (at.gap >= least && at.gap < most && inner(direction_out(&b->start, at.normal), n) <= facing)
            return true;
    }
    return false;
}

/* Whether another body is beyond the face of a box with this normal. skins: its least depth there, in units of the skin */
static bool is_covered(const contact_setting *s, contact_particle *p, const meeting *m, vector3 normal, double skins)
{
    return is_beyond(s, p, m, normal, 4 * m->b->skin, -(double)INFINITY, -skins * m->b->skin, 1.1);
}

/* Whether another body adjoins the nearest face of a box, as the floor under a wall: nothing fits between. */
static bool adjoins(const contact_setting *s, contact_particle *p, const meeting *m)
{
    const double flush = flush_of(p, m->b) + 2 * m->b->skin;
    return is_beyond(s, p, m, m->at.normal, -m->at.gap - p->radius, -p->radius - flush, -p->radius + flush,
                     -same_plane);
}

/* Inside a box, chooses another face than the nearest one. At an edge: the face into which the path goes fastest, of those
   that no other body covers. If a body adjoins the nearest face: the next nearest one, unless a body covers it, or it is
   farther than the smallest half size of the box. radius: [m] of the box and the particle */
static void choose_face(const contact_setting *s, contact_particle *p, meeting *m, double radius)
{
    const contact_body *const b = m->b;
    const double nearest = m->at.gap;
    const bool adjoined = adjoins(s, p, m);
    double most = 0, next = -(double)INFINITY, thinnest = (double)INFINITY;
    vector3 next_normal = zero3;
    for (int a = 0; a < (b->flat ? 2 : 3); a++) {
        const double side = component(m->start, a) < 0 ? -1 : 1;
        const vector3 normal = {a == 0 ? side : 0, a == 1 ? side : 0, a == 2 ? side : 0};
        const double rate = inner(normal, m->way), gap = inner(normal, m->start) - b->half[a] - radius;
        thinnest = fmin(thinnest, b->half[a]);
        if (gap > next && !(inner(normal, m->at.normal) > 0)) {
            next = gap;
            next_normal = normal;
        }
        if (!(gap >= nearest - m->slop) || !(rate < most) || is_covered(s, p, m, normal, 0))
            continue;
        most = rate;
        m->at.gap = gap;
        m->at.normal = normal;
    }
    if (most == 0 && adjoined && next > -thinnest - radius && !is_covered(s, p, m, next_normal, 2)) {
        m->at.gap = next;
        m->at.normal = next_normal;
    }
}

/* Items 1 and 2. Returns whether there is a contact. */
static bool meet(const contact_setting *s, contact_particle *p, meeting *m)
{
    const contact_body *const b = m->b;
    m->slop = slop_of(s, p, b);
    m->goes_on = false;
    m->start = place_in(&b->start, p->x0);
    m->way = subtract(end_in_frame(b, p), m->start);
    m->fraction = 0;
    find_nearest(p, b, 0, m->start, &m->at);
    if (b->skin > 0 && b->shape == SPRING_BOX && m->at.gap < -m->slop)
        choose_face(s, p, m, b->radius + p->radius);
    m->start_depth =
        m->at.gap < -m->slop - b->skin ? -m->at.gap : 0; /* a particle may start on the body, in its skin */
    near_point there;
    if (m->again && m->start_depth > 0 && gap_at_end(p, b, &there) >= -m->slop)
        return false; /* an earlier contact of this step has moved it out */
    if (passes_face(b, m, b->radius + p->radius, flush_of(p, b) + b->skin))
        return false;
    m->gap = m->at.gap < m->slop ? 0 : m->at.gap; /* a rounding error divided by h would be a velocity */
    const bool custom = is_custom(b->shape), enters = m->gap == 0 && inner(m->at.normal, m->way) < 0;
    if (custom && m->start_depth == 0 && !enters ? !find_custom_impact(p, m) : !custom && !find_convex_impact(p, m))
        return false;
    if (m->gap < m->slop)
        m->gap = 0;
    /* Rounding errors of many steps are corrected, so that they stay below the slop. */
    if (m->fraction == 0 && fabs(m->at.gap) > m->slop / 2 && m->start_depth == 0)
        m->gap = m->at.gap;
    m->time_left = (1 - m->fraction) * s->h;
    m->place = add_scaled(m->start, m->fraction, m->way);
    m->walks = custom && length3(m->way) > custom_step(b);
    const vector3 x = add_scaled(p->x0, m->fraction, p->d), n = direction_out(&b->start, m->at.normal);
    put(&m->n, n);
    put(&m->n_end, n);
    if (b->turns) {
        m->n_end = direction_out(&b->end, m->at.normal);
        const vector3 middle = between(n, m->n_end, m->fraction);
        m->n = scale(1 / length3(middle), middle);
    }
    body_pose then = b->start;
    if (!(m->fraction < least_fraction) && b->moves) {
        then.at = between(b->start.at, b->end.at, m->fraction);
        then.velocity = between(b->start.velocity, b->end.velocity, m->fraction);
        then.spin = between(b->start.spin, b->end.spin, m->fraction);
        then.along = between(b->start.along, b->end.along, m->fraction);
    }
    m->velocity = surface_velocity(b, &then, m->at.along, x, m->n);
    return true;
}

/* [m] Of the end of the path from the tangent plane; negative inside. */
static double inward_at(const meeting *m, vector3 end)
{
    const contact_body *const b = m->b;
    const bool deep = m->start_depth > 0;
    const double inward = deep ? inner(m->at.normal, subtract(end, m->start)) - m->start_depth
                               : m->gap + inner(m->at.normal, subtract(end, m->place));
    if (b->shape != SPRING_CAPSULE || !b->turns)
        return inward;
    const double part = m->at.along * (deep ? 1 : 1 - m->fraction); /* of the motion of its end in the frame */
    return inward - part * inner(m->at.normal, subtract(b->end.segment, b->start.segment));
}

/* Item 4, late. */
static int press_late(const contact_setting *s, contact_particle *p, const meeting *m)
{
    const contact_body *const b = m->b;
    const vector3 u = subtract(p->w, m->velocity);
    const double rate = inner(u, m->n), lost = rate * s->h < 0 ? -rate : 0;
    const vector3 friction = shortened(tangential(u, m->n), b->friction * p->friction * fabs(lost));
    p->w = add(p->w, subtract(scale(lost, m->n), friction));
    p->d = add_scaled(p->d, -m->time_left, friction);
    /* Onto the tangent plane, in the frame of the body: outside, if the body is convex. */
    const vector3 end = end_in_frame(b, p);
    const double inward = inward_at(m, end);
    const bool deep = m->again && -inward < 2 * m->start_depth; /* in several bodies from the start */
    if (inward < 0 && !deep)
        p->d = add_scaled(p->d, -inward, m->n_end);
    near_point there;
    const double gap = gap_at_end(p, b, &there);
    if (gap < 0 && !m->walks)
        p->d = add_scaled(p->d, -gap, direction_out(&b->end, there.normal));
    return CONTACT;
}

/* Item 4, early: the lambda for which x + lambda |left| n lies on the surface at the end. Returns whether it surely
   does. */
SPRING_INLINE bool find_lambda(contact_particle *p, const meeting *m, vector3 x, bool last_pass, double *lambda)
{
    const contact_body *const b = m->b;
    if (m->goes_on || (b->shape == SPRING_PLANE && !b->turns))
        return !b->turns;
    const double duration = fabs(m->time_left);
    const bool custom = is_custom(b->shape);
    const int most = m->walks ? 0 : custom ? custom_iterations : last_pass ? surface_iterations : 1;
    double last_gap = 0, last = 0;
    for (int i = 0; i < most; i++) {
        near_point there;
        find_nearest(p, b, 1, place_in(&b->end, add_scaled(x, *lambda * duration, m->n)), &there);
        const double cosine = inner(m->n, direction_out(&b->end, there.normal));
        if (fabs(there.gap) < m->slop / 4)
            return true;
        const bool another = custom && there.several && there.gap < 0 && cosine < 1 - 1e-9;
        if (another || !(cosine > (custom ? same_face : least_cosine))) /* in a corner, item 5 follows */
            return false;
        double change = -there.gap / (duration * cosine);
        const double slope = there.gap - last_gap;
        if (custom && i > 0 && slope * (*lambda - last) > 0 && fabs(slope) > 1e-3 * fabs(last_gap))
            change = -there.gap * (*lambda - last) / slope;
        last_gap = there.gap;
        last = *lambda;
        *lambda = fmax(0, *lambda + change);
    }
    return false;
}

/* Item 4, early. start: [m/s] velocity of the particle at the start of the step; end_of_path: in the frame; inward: [m]
   from the tangent plane */
static int press_from_start(const contact_setting *s, contact_particle *p, const meeting *m, vector3 start,
                            vector3 end_of_path, double inward)
{
    const contact_body *const b = m->b;
    const double duration = fabs(m->time_left), mu = b->friction * p->friction;
    const double toward = fmax(least_cosine, inner(m->n, m->n_end));
    const bool rests = m->fraction < least_fraction;
    const vector3 x0 = add_scaled(p->x0, m->fraction, p->d), x1 = add(p->x0, p->d);
    vector3 slip = zero3; /* mean velocity of the surface in the frame */
    if (b->slips) {
        const vector3 growth = subtract(b->end.along, b->start.along);
        const vector3 shift_of_core = add_scaled(subtract(b->end.at, b->start.at), m->at.along, growth);
        slip = slip_velocity(b, &b->start, m->at.along, add_scaled(x0, -m->fraction, shift_of_core), m->n);
        if (b->turns && b->shape != SPRING_CAPSULE)
            slip = scale(0.5, add(slip, slip_velocity(b, &b->end, m->at.along, x0, m->n)));
        else if (b->shape != SPRING_PLANE)
            slip = add_scaled(slip, m->time_left / 2, cross(b->start.spin, slip));
    }
    /* way along the surface, relative to it; velocity at the start, and its change by other forces */
    const vector3 way = direction_out(&b->end, subtract(end_of_path, m->place));
    const vector3 along = tangential(add_scaled(way, -m->time_left, slip), m->n);
    const vector3 mean = scale(1 / m->time_left, along);
    const vector3 u0 = tangential(subtract(start, m->velocity), m->n), A = scale(2, subtract(mean, u0));
    double lambda = fmax(0, -inward) / (duration * toward);
    slide_result end = {false, mean, mean};
    vector3 shift = zero3; /* by friction */
    bool clear = false;
    const int passes = mu > 0 ? friction_passes : 0;
    for (int pass = 0;; pass++) {
        if (b->turns && pass > 0) {
            const vector3 there = place_in(&b->end, add(x1, shift));
            lambda = fmax(0, -(m->gap + inner(m->at.normal, subtract(there, m->place)))) / (duration * toward);
        }
        clear = find_lambda(p, m, add(x1, shift), pass == passes, &lambda);
        if (pass == passes)
            break;
        if (rests) {
            slide(u0, A, 2 * mu * lambda, pass + 1 < passes ? 2 : slide_parts, &end);
            if (end.sticks && is_zero(end.mean) && !b->slips && b->shape != SPRING_CAPSULE)
                break;
        } else { /* friction of a particle that landed in this step */
            const double speed = length3(mean), limit = mu * lambda, first = length3(u0);
            end.sticks = !(speed > limit);
            end.mean = end.kick = end.sticks ? zero3 : scale(1 - limit / speed, mean);
            /* Friction along the velocity at the start makes the kicks before and after the drift adjoint. */
            if (!end.sticks && first > 2 * limit && inner(u0, mean) > 0.5 * first * speed)
                end.mean = end.kick = add_scaled(mean, -limit / first, u0);
        }
        shift = subtract(scale(m->time_left, end.mean), along);
    }
    if (rests && end.sticks && length3(u0) * duration <= m->slop && !b->slips) { /* carried exactly */
        vector3 there = m->start;
        if (b->shape == SPRING_CAPSULE)
            there = add_scaled(there, m->at.along, subtract(b->end.segment, b->start.segment));
        p->d = b->moves ? subtract(place_out(&b->end, there), p->x0) : zero3;
        p->w = scale(1 / s->h, p->d);
        clear = !(m->gap < 0);
        if (!clear && b->moves) /* rounding errors of many steps, and the skin, do not enter the velocity */
            p->d = add_scaled(p->d, -m->gap, m->n_end);
    } else {
        vector3 change = scale(s->h < 0 ? -lambda : lambda, m->n);
        if (mu > 0)
            change = add(change, subtract(end.kick, mean));
        p->w = add(p->w, change);
        p->d = add_scaled(add(p->d, shift), lambda * duration, m->n);
    }
    return clear ? CONTACT | CLEAR : CONTACT;
}

/* Items 1, 3 and 4. */
static int collide_once(const contact_setting *s, contact_particle *p, const meeting *m)
{
    const contact_body *const b = m->b;
    const vector3 at_impact = m->again ? p->w : add_scaled(p->v0, m->fraction * s->h, p->accel);
    const vector3 u = subtract(at_impact, m->velocity);
    const double rate = inner(u, m->n);
    vector3 start = p->v0;
    if (rate * s->h < -m->slop && !(m->again && m->fraction <= 0)) {
        const double normal = -(1 + b->restitution) * rate;
        const vector3 friction = shortened(tangential(u, m->n), b->friction * p->friction * fabs(normal));
        const vector3 change = subtract(scale(normal, m->n), friction);
        p->w = add(p->w, change);
        p->d = add_scaled(p->d, m->time_left, change);
        start = add(start, change);
    }
    if (m->start_depth > 0 && !m->again)
        p->d = add_scaled(p->d, m->start_depth, m->n);
    if (!(fabs(m->time_left) > 0))
        return CONTACT;
    const vector3 end = end_in_frame(b, p);
    const double inward = inward_at(m, end);
    if (inward >= 0 && m->start_depth == 0) {
        near_point there;
        if (b->shape == SPRING_PLANE && !b->turns)
            return CONTACT | CLEAR;
        find_nearest(p, b, 1, end, &there);
        if (there.gap >= 0)
            return CONTACT | CLEAR;
    }
    if (m->fraction > 0.5 || m->again || m->start_depth > 0)
        return press_late(s, p, m);
    return press_from_start(s, p, m, start, end, inward);
}

/* Continues the path after the bend in steps that cannot pass the middle of a custom body, and pushes it out after
   each. */
static void walk(const contact_setting *s, contact_particle *p, const meeting *m)
{
    const contact_body *const b = m->b;
    vector3 y = m->place;
    const vector3 way = subtract(end_in_frame(b, p), y);
    double left = length3(way);
    near_point at, pusher = m->at;
    find_nearest(p, b, 1, y, &at);
    if (left <= custom_step(b))
        return;
    const vector3 along = scale(1 / left, way);
    bool pushed = false;
    for (int i = 0; i < walk_steps && left > 0; i++) {
        const double step = fmin(left, fmax(at.gap, custom_step(b)));
        y = add_scaled(y, step, along);
        left -= step;
        find_nearest(p, b, 1, y, &at);
        for (int k = 0; k < walk_pushes && at.gap < 0; k++) {
            y = add_scaled(y, -at.gap, at.normal);
            pusher = at;
            pushed = true;
            find_nearest(p, b, 1, y, &at);
        }
    }
    if (!pushed && !(left > 0))
        return;
    p->d = subtract(place_out(&b->end, y), p->x0);
    if (!pushed)
        return;
    const vector3 n = direction_out(&b->end, pusher.normal), x = add(p->x0, p->d);
    const vector3 u = subtract(p->w, surface_velocity(b, &b->end, 0, x, n));
    const double rate = inner(u, n);
    if (rate * s->h >= 0)
        return;
    const double normal = -(1 + b->restitution) * rate;
    const vector3 friction = shortened(tangential(u, n), b->friction * p->friction * fabs(normal));
    p->w = add(p->w, subtract(scale(normal, n), friction));
}

static int collide(const contact_setting *s, contact_particle *p, const meeting *m)
{
    const vector3 x = add(p->x0, p->d);
    vector3 w;
    put(&w, p->w);
    int found = collide_once(s, p, m);
    if (is_custom(m->b->shape)) {
        walk(s, p, m);
        found = CONTACT;
    }
    const vector3 x1 = add(p->x0, p->d);
    spring_contact_record(s, p, m->index, &x, &w, &x1, &p->w);
    return found;
}

/* ------------------------------------------------------------------------------------------------- several colliders */

/* n.change >= least */
typedef struct constraint {
    vector3 n, velocity;
    double least, multiplier, friction;
    unsigned index;
} constraint;

static bool fits(const constraint *c, unsigned count, vector3 change, double tolerance)
{
    for (unsigned i = 0; i < count; i++)
        if (!(inner(c[i].n, change) >= c[i].least - tolerance))
            return false;
    return true;
}

/* Sets the multipliers of the active constraints, and returns their sum of multiplier n, if it fits all constraints. */
static bool try_active(constraint *c, unsigned count, const unsigned active[3], const double value[3], unsigned used,
                       double tolerance, vector3 *change)
{
    vector3 sum = zero3;
    double size = 0;
    for (unsigned k = 0; k < used; k++) {
        if (!(value[k] >= 0))
            return false;
        sum = add_scaled(sum, value[k], c[active[k]].n);
        size += value[k];
    }
    if (!fits(c, count, sum, tolerance + 1e-13 * size))
        return false;
    for (unsigned k = 0; k < used; k++)
        c[active[k]].multiplier = value[k];
    *change = sum;
    return true;
}

/* The least change that fits all constraints: its active set has at most three normals, for which it is known in closed
   form. If none fits, by projected Gauss-Seidel. */
static vector3 least_change(constraint *c, unsigned count)
{
    double largest = 0;
    for (unsigned i = 0; i < count; i++) {
        largest = fmax(largest, fabs(c[i].least));
        c[i].multiplier = 0;
    }
    const double tolerance = 1e-12 * largest;
    vector3 change = zero3;
    if (fits(c, count, change, tolerance))
        return change;
    for (unsigned i = 0; i < count; i++)
        if (try_active(c, count, (const unsigned[3]){i}, (const double[3]){c[i].least}, 1, tolerance, &change))
            return change;
    for (unsigned i = 0; i < count; i++)
        for (unsigned j = i + 1; j < count; j++) {
            const vector3 across = cross(c[i].n, c[j].n);
            const double cosine = inner(c[i].n, c[j].n), det = inner(across, across); /* 1 - cosine^2 */
            const double value[3] = {(c[i].least - cosine * c[j].least) / det,
                                     (c[j].least - cosine * c[i].least) / det};
            if (det > 1e-20 && try_active(c, count, (const unsigned[3]){i, j}, value, 2, tolerance, &change))
                return change;
        }
    for (unsigned i = 0; i < count; i++)
        for (unsigned j = i + 1; j < count; j++)
            for (unsigned k = j + 1; k < count; k++) {
                const vector3 jk = cross(c[j].n, c[k].n), ki = cross(c[k].n, c[i].n), ij = cross(c[i].n, c[j].n);
                const double det = inner(c[i].n, jk);
                if (!(fabs(det) > 1e-10))
                    continue;
                const vector3 sum = add_scaled(add_scaled(scale(c[i].least, jk), c[j].least, ki), c[k].least, ij);
                const double value[3] = {inner(jk, sum) / det / det, inner(ki, sum) / det / det,
                                         inner(ij, sum) / det / det};
                if (try_active(c, count, (const unsigned[3]){i, j, k}, value, 3, tolerance, &change))
                    return change;
            }
    for (int round = 0; round < seidel_rounds; round++)
        for (unsigned i = 0; i < count; i++) {
            const double now = fmax(0, c[i].multiplier + c[i].least - inner(c[i].n, change));
            change = add_scaled(change, now - c[i].multiplier, c[i].n);
            c[i].multiplier = now;
        }
    return change;
}

/* Adds the contacts at x with collider i whose gaps are at most `most` larger than the smallest. */
static unsigned add_constraints(contact_particle *p, const contact_body *b, unsigned i, bool at_end, vector3 x,
                                double most, constraint *c, unsigned count)
{
    const body_pose *const pose = at_end ? &b->end : &b->start;
    near_point at[3];
    const unsigned found = find_all(p, b, pose, x, at);
    double nearest = at[0].gap;
    for (unsigned k = 1; k < found; k++)
        nearest = fmin(nearest, at[k].gap);
    for (unsigned k = 0; k < found && count < most_constraints; k++) {
        if (at[k].gap > nearest + most)
            continue;
        constraint *const to = &c[count++];
        put(&to->n, at[k].normal);
        put(&to->velocity, surface_velocity(b, pose, at[k].along, x, at[k].normal));
        to->least = -at[k].gap;
        to->multiplier = 0;
        to->friction = b->friction * p->friction;
        to->index = i;
    }
    return count;
}

/* Removes the components of v into several surfaces. Friction acts only in directions that no contact resists. */
static void stop_jointly(const contact_setting *s, const contact_particle *p, constraint *c, unsigned count, vector3 x,
                         vector3 *v)
{
    const double sign = s->h < 0 ? -1 : 1;
    for (unsigned i = 0; i < count; i++)
        c[i].least = -sign * inner(subtract(*v, c[i].velocity), c[i].n);
    least_change(c, count);
    for (unsigned i = 0; i < count; i++) {
        if (!(c[i].multiplier > 0))
            continue;
        const vector3 before = *v;
        *v = add_scaled(before, sign * c[i].multiplier, c[i].n);
        spring_contact_record(s, p, c[i].index, &x, &before, &x, v);
    }
    for (unsigned i = 0; i < count; i++) {
        if (!(c[i].multiplier > 0))
            continue;
        const vector3 u = tangential(subtract(*v, c[i].velocity), c[i].n);
        vector3 friction = shortened(u, c[i].friction * c[i].multiplier);
        for (unsigned k = 0; k < count; k++) {
            const vector3 line = cross(c[i].n, c[k].n);
            const double square = inner(line, line);
            if (k != i && c[k].multiplier > 0 && square > 0)
                friction = scale(inner(friction, line) / square, line);
        }
        const vector3 before = *v;
        *v = subtract(before, friction);
        spring_contact_record(s, p, c[i].index, &x, &before, &x, v);
    }
}

static void stop(const contact_setting *s, const contact_particle *p, constraint *c, unsigned count, vector3 x,
                 vector3 *v)
{
    if (count > 1) {
        stop_jointly(s, p, c, count, x, v);
        return;
    }
    if (count == 0)
        return;
    const vector3 u = subtract(*v, c->velocity), before = *v;
    const double rate = inner(u, c->n);
    if (!(rate * s->h < 0))
        return;
    const vector3 along = tangential(u, c->n);
    const double limit = c->friction * fabs(rate), square = inner(along, along);
    if (square <= limit * limit)
        *v = c->velocity;
    else
        *v = subtract(add_scaled(*v, -rate, c->n), scale(limit / spring_sqrt(square), along));
    spring_contact_record(s, p, c->index, &x, &before, &x, v);
}

/* Removes the constraints of surfaces that the particle has left in this step, if only a very large velocity fits them and
   all others, as between surfaces that close almost face to face. Returns the number that remains. left: [m] gaps at x
   above which it has left */
static unsigned without_distant(constraint *c, unsigned count, const double *gap, const double *left, double sign,
                                vector3 v)
{
    double fastest = length3(v);
    bool leaves = false;
    for (unsigned i = 0; i < count; i++) {
        fastest += length3(c[i].velocity);
        c[i].least = -sign * inner(subtract(v, c[i].velocity), c[i].n);
        leaves = leaves || gap[i] > left[i];
    }
    if (!leaves || !(length3(least_change(c, count)) > 2 * fastest))
        return count;
    unsigned kept = 0;
    for (unsigned i = 0; i < count; i++)
        if (!(gap[i] > left[i]))
            c[kept++] = c[i];
    return kept;
}

void spring_contact_stop(const contact_setting *s, contact_particle *p, uint32_t touched, bool at_end, vector3 x,
                         vector3 *v)
{
    constraint c[most_constraints];
    double gap[most_constraints], left[most_constraints];
    unsigned count = 0;
    for (unsigned i = 0; i < s->count; i++) {
        if ((touched >> i & 1) == 0)
            continue;
        const double tolerance = gap_tolerance(s, p, &s->body[i], at_end, x);
        unsigned k = count;
        for (count = add_constraints(p, &s->body[i], i, at_end, x, tolerance, c, count); k < count; k++) {
            gap[k] = -c[k].least;
            left[k] = tolerance;
        }
    }
    if (count > 1)
        count = without_distant(c, count, gap, left, s->h < 0 ? -1 : 1, *v);
    stop(s, p, c, count, x, v);
}

/* Bits of the colliders that the path of a particle may touch. */
static uint32_t near_path(const contact_setting *s, const contact_particle *p)
{
    if (s->count == 1)
        return (s->body[0].bits & p->bits) != 0;
    const double way = length3(p->d);
    uint32_t nearby = 0;
    for (unsigned i = 0; i < s->count; i++) {
        const contact_body *const b = &s->body[i];
        const double margin = rounded_up * b->growth * (p->radius + way) + 4 * slop_of(s, p, b);
        bool meets = (b->bits & p->bits) != 0;
        for (int a = 0; a < 3 && meets; a++) {
            const double at = component(p->x0, a);
            meets = !(at < b->low[a] - margin) && !(at > b->high[a] + margin);
        }
        nearby |= (uint32_t)meets << i;
    }
    return nearby;
}

/* Returns a particle that other bodies have pressed through a thin box to its place at the start of the step, although it
   may then be inside the others. */
static uint32_t return_through(const contact_setting *s, contact_particle *p, const contact_history *earlier)
{
    for (unsigned i = 0; i < earlier->count; i++) {
        const unsigned k = earlier->body[i];
        if (s->body[k].shape != SPRING_BOX)
            continue;
        const contact_body *const b = &s->body[k];
        const vector3 n = direction_in(&b->end, earlier->normal[i]), y = end_in_frame(b, p);
        bool through = inner(n, y) < 0;
        for (int a = 0; a < (b->flat ? 2 : 3); a++)
            through = through && (fabs(component(n, a)) > 0.5 || fabs(component(y, a)) < b->half[a]);
        if (!through)
            continue;
        const vector3 x = add(p->x0, p->d), x1 = place_out(&b->end, place_in(&b->start, p->x0));
        p->d = subtract(x1, p->x0);
        spring_contact_record(s, p, k, &x, &p->w, &x1, &p->w);
        return UINT32_C(1) << k;
    }
    return 0;
}

/* Item 5, after all colliders. clear: bits of the colliders outside of which the path is known to end */
static void leave(const contact_setting *s, contact_particle *p, const contact_history *earlier, uint32_t nearby,
                  uint32_t clear)
{
    constraint c[most_constraints];
    uint32_t inside = 0;
    for (int pass = 0; pass < corner_passes && (pass > 0 || (nearby & ~clear) != 0); pass++) {
        unsigned count = 0;
        double deepest = 0;
        const vector3 x = add(p->x0, p->d);
        const double way = length3(p->d);
        for (unsigned i = 0; i < s->count; i++) {
            if ((nearby >> i & 1) == 0)
                continue;
            const unsigned before = count,
                           found = add_constraints(p, &s->body[i], i, true, x, (double)INFINITY, c, count);
            for (unsigned k = before; k < found; k++) {
                const bool deep = c[k].least > slop_of(s, p, &s->body[i]);
                deepest = deep ? fmax(deepest, c[k].least) : deepest;
                inside |= (uint32_t)deep << i;
                if ((inside >> i & 1) != 0 || ((p->touched >> i & 1) != 0 && -c[k].least < way))
                    c[count++] = c[k];
            }
        }
        if (!(deepest > 0))
            break;
        const vector3 change = least_change(c, count);
        const double share = fmin(1, (way + deepest) / length3(change)); /* 1 if the change is 0 */
        p->d = add_scaled(p->d, share, change);
        for (unsigned i = 0; i < count; i++) {
            const vector3 x1 = add_scaled(x, share * c[i].multiplier, c[i].n);
            spring_contact_record(s, p, c[i].index, &x, &p->w, &x1, &p->w);
        }
        nearby |= near_path(s, p);
    }
    if (inside != 0 || earlier->count == contact_rounds)
        inside |= return_through(s, p, earlier);
    if (inside == 0)
        return;
    p->touched |= inside;
    spring_contact_stop(s, p, inside, true, add(p->x0, p->d), &p->w);
}

/* The index of a body that continues the face on which a path is pressed, as on a floor of boxes, and on which the path
   ends; or the number of bodies. Otherwise the particle would fall from the start of the step, and hit the edge of that
   body. Sets goes_on, also if a path along the face hits another body, as a wall beside the floor. */
static unsigned next_face(const contact_setting *s, contact_particle *p, uint32_t nearby, meeting *m)
{
    contact_particle straight = *p;
    meeting other = {.again = false};
    if (m->again || m->start_depth > 0 || m->fraction > 0.5 || is_custom(m->b->shape))
        return s->count;
    const double inward = inward_at(m, end_in_frame(m->b, p));
    const vector3 end = add_scaled(add(p->x0, p->d), -inward, m->n_end);
    near_point at;
    find_nearest(p, m->b, 1, place_in(&m->b->end, end), &at);
    if (!(inward < 0) || !(at.gap > 0))
        return s->count;
    for (unsigned i = 0; i < s->count; i++) {
        const contact_body *const b = &s->body[i];
        if ((nearby >> i & 1) == 0 || i == m->index || is_custom(b->shape))
            continue;
        find_nearest(p, b, 1, place_in(&b->end, end), &at);
        if (fabs(at.gap) <= flush_of(p, b) && inner(direction_out(&b->end, at.normal), m->n_end) > same_plane) {
            m->goes_on = true;
            return i;
        }
        straight.d = subtract(end, p->x0);
        other.b = b;
        other.index = i;
        m->goes_on = m->goes_on || (m->b->shape == SPRING_BOX && meet(s, &straight, &other) && other.fraction > 0);
    }
    return s->count;
}

/* The first contact of a path with some bodies, in one of each[2]; NULL: none. Sets the bits of `clear` for bodies that the
   path does not touch. */
static meeting *first_contact(const contact_setting *s, contact_particle *p, const contact_history *earlier,
                              uint32_t bodies, meeting each[2], uint32_t *clear)
{
    meeting *first = NULL, *next = &each[0];
    for (unsigned i = 0; i < s->count; i++) {
        const uint32_t bit = UINT32_C(1) << i;
        if ((bodies & bit) == 0)
            continue;
        next->b = &s->body[i];
        next->index = i;
        next->again = earlier->count > 0;
        next->earlier = earlier;
        if (!meet(s, p, next))
            *clear |= s->body[i].degenerate ? 0 : bit;
        else if (first == NULL || next->fraction < first->fraction ||
                 (next->fraction == first->fraction && next->at.gap < first->at.gap)) {
            first = next;
            next = first == &each[0] ? &each[1] : &each[0];
        }
    }
    return first;
}

/* Ends a path at a further contact if it would pass through the body, on the surface as it is at the end of the step, and
   leaves the impact to the next step. Otherwise leave() moves its end out. */
static bool end_at_contact(const contact_setting *s, contact_particle *p, const meeting *m)
{
    near_point there;
    gap_at_end(p, m->b, &there);
    if (m->fraction <= least_fraction || inner(there.normal, m->at.normal) > 0)
        return false;
    const vector3 x = add(p->x0, p->d), x1 = place_out(&m->b->end, m->place);
    p->d = subtract(x1, p->x0);
    spring_contact_record(s, p, m->index, &x, &p->w, &x1, &p->w);
    return true;
}

/* Moves the path of a particle that starts in a body by rounding errors, or in its skin, out of it. Otherwise this depth,
   divided by h, would become a velocity. raised: [m] by which this has moved the path */
static void leave_skin(const contact_setting *s, contact_particle *p, const meeting *m, vector3 *raised)
{
    const vector3 n = direction_out(&m->b->start, m->at.normal), x = add(p->x0, p->d);
    const double missing = -m->gap - inner(n, *raised);
    if (!(m->gap < 0) || !(missing > 0))
        return;
    const vector3 x1 = add_scaled(x, missing, n);
    *raised = add_scaled(*raised, missing, n);
    p->d = add_scaled(p->d, missing, n);
    spring_contact_record(s, p, m->index, &x, &p->w, &x1, &p->w);
}

void spring_contact_drift(const contact_setting *s, contact_particle *p)
{
    vector3 raised = zero3;
    uint32_t nearby = p->nearby == UINT32_MAX ? near_path(s, p) : p->nearby, clear = 0, last = 0;
    contact_history earlier = {.count = 0};
    p->touched = 0;
    for (;;) {
        meeting each[2];
        meeting *const first = first_contact(s, p, &earlier, nearby & ~clear & ~last, each, &clear);
        if (first == NULL)
            break;
        const uint32_t bit = UINT32_C(1) << first->index;
        if (earlier.count == contact_rounds) {
            if (end_at_contact(s, p, first)) {
                clear = last = 0;
                break;
            }
            last |= bit; /* leave() treats a particle that is pressed on it */
            continue;
        }
        last = bit;
        earlier.body[earlier.count] = first->index;
        put(&earlier.normal[earlier.count++], first->n_end);
        leave_skin(s, p, first, &raised);
        const unsigned next_one = (nearby & (nearby - 1)) != 0 ? next_face(s, p, nearby, first) : s->count;
        const vector3 before = p->d;
        const uint32_t cleared = (collide(s, p, first) & CLEAR) != 0 ? last : 0;
        const bool same = size_sum(subtract(p->d, before)) <= first->slop / 8; /* the path, to rounding errors */
        clear = cleared | (same ? clear : 0);
        near_point there;
        const bool beyond =
            next_one < s->count && gap_at_end(p, first->b, &there) > gap_at_end(p, &s->body[next_one], &there);
        p->touched |= beyond ? UINT32_C(1) << next_one : last;
        nearby = near_path(s, p) | p->touched;
    }
    leave(s, p, &earlier, nearby, clear);
}

/* ---------------------------------------------------------------------------------------------------------- queries */

bool spring_contact_touches(const contact_setting *s, contact_particle *p, const contact_body *b, double reach)
{
    near_point at[3];
    const unsigned found = find_all(p, b, &b->start, p->x0, at);
    for (unsigned i = 0; i < found; i++)
        if (at[i].gap <= slop_of(s, p, b) + reach)
            return true;
    return false;
}

unsigned spring_contact_surfaces(const contact_body *body, unsigned bodies, const contact_particle *p, bool at_end,
                                 vector3 x, double epsilon, contact_surface surface[most_surfaces])
{
    const contact_setting s = {.epsilon = epsilon};
    unsigned count = 0;
    for (unsigned k = 0; k < bodies && count + 3 <= most_surfaces; k++) {
        if ((p->touched >> k & 1) == 0)
            continue;
        constraint c[most_constraints];
        contact_particle particle = *p;
        const double tolerance = gap_tolerance(&s, p, &body[k], at_end, x);
        const unsigned found = add_constraints(&particle, &body[k], 0, at_end, x, tolerance, c, 0);
        for (unsigned i = 0; i < found; i++)
            surface[count++] = (contact_surface){c[i].n, c[i].velocity, c[i].friction, k};
    }
    return count;
}

vector3 spring_contact_velocity_change(const contact_body *b, vector3 x, vector3 middle, vector3 *mean)
{
    const vector3 now = frame_velocity(b, &b->start, 0, x);
    const vector3 carried = place_out(&b->end, place_in(&b->start, x));
    const vector3 first = frame_velocity(b, &b->start, 0, middle), last = frame_velocity(b, &b->end, 0, middle);
    *mean = subtract(between(first, last, 0.5), now);
    return subtract(frame_velocity(b, &b->end, 0, carried), now);
}

double spring_contact_balance(const contact_surface *surface, unsigned count, vector3 accel)
{
    constraint c[most_constraints];
    count = count < most_constraints ? count : most_constraints;
    for (unsigned i = 0; i < count; i++)
        c[i] = (constraint){.n = surface[i].normal, .least = -inner(accel, surface[i].normal)};
    double left = length3(add(accel, least_change(c, count)));
    for (unsigned i = 0; i < count; i++)
        left = fmax(0, left - surface[i].friction * c[i].multiplier);
    return left;
}

#include "../simd/size_end.h"
