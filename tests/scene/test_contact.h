/* SPDX-License-Identifier: MIT */
/* Common parts of the tests of contacts: vectors, distances from colliders, and particles that fall on colliders. */
#ifndef TEST_CONTACT_H
#define TEST_CONTACT_H

#include "test_scene.h"

#define PI 3.14159265358979323846

enum { in_double = sizeof(scalar) == sizeof(double) };

static const double gravity = 9.81;
static const double frame = 1. / 60;                        /* [s] */
static const double none[3] = {0}, down[3] = {0, -9.81, 0}; /* [m/s^2] no gravity, and gravity along y */

static const spring_collider ground = {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}};
static const spring_collider unit_box = {
    .shape = SPRING_BOX, .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .half = {2, 0.1, 2}};

SPRING_INLINE double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

SPRING_INLINE double length(const double a[3])
{
    return sqrt(dot(a, a));
}

SPRING_INLINE double distance(const double a[3], const double b[3])
{
    return length((double[3]){a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

SPRING_INLINE void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* a turned by the vector phi (Rodrigues). */
SPRING_INLINE void turn(const double phi[3], const double a[3], double out[3])
{
    const double angle = length(phi);
    double n[3] = {0}, c[3];
    for (int i = 0; i < 3 && angle > 0; i++)
        n[i] = phi[i] / angle;
    cross(n, a, c);
    const double along = dot(n, a);
    for (int i = 0; i < 3; i++)
        out[i] = angle > 0 ? cos(angle) * a[i] + sin(angle) * c[i] + 2 * pow(sin(angle / 2), 2) * along * n[i] : a[i];
}

/* The axes of the scene, turned by the vector phi. */
SPRING_INLINE void turned_axes(const double phi[3], double axis[3][3])
{
    for (int k = 0; k < 3; k++)
        turn(phi, unit_box.axis[k], axis[k]);
}

SPRING_INLINE void random_axes(double axis[3][3])
{
    double phi[3];
    random_unit(phi, 3);
    const double angle = random_uniform(0, PI);
    for (int a = 0; a < 3; a++)
        phi[a] *= angle;
    turned_axes(phi, axis);
}

/* The distance from a collider at `time` after it was set, from the definition of each shape: independent of the library. */
SPRING_INLINE double gap_of(const spring_collider *c, double time, const double x[3], uint32_t axes)
{
    double arm[3] = {0}, segment[3] = {0}, back[3] = {0}, from[3], square = 0, deepest = -INFINITY;
    for (uint32_t a = 0; a < axes; a++) {
        arm[a] = x[a] - c->at[a] - time * c->velocity[a] - time * time / 2 * c->acceleration[a];
        segment[a] = c->to[a] - c->at[a] + time * (c->velocity_to[a] - c->velocity[a]);
    }
    for (uint32_t a = axes == 2 ? 2 : 0; a < 3; a++)
        back[a] = -(time * c->spin[a] + time * time / 2 * c->spin_acceleration[a]);
    turn(back, arm, from);
    if (c->shape == SPRING_PLANE)
        return dot(from, c->axis[0]);
    if (c->shape == SPRING_BOX) {
        for (uint32_t a = 0; a < axes; a++) {
            const double beyond = fabs(dot(from, c->axis[a])) - c->half[a];
            deepest = fmax(deepest, beyond);
            square += beyond > 0 ? beyond * beyond : 0;
        }
        return (square > 0 ? sqrt(square) : deepest) - c->radius;
    }
    const double along = fmin(fmax(dot(arm, segment) / fmax(dot(segment, segment), 1e-300), 0), 1);
    for (int a = 0; a < 3 && c->shape == SPRING_CAPSULE; a++)
        arm[a] -= along * segment[a];
    return length(arm) - c->radius;
}

static const spring_method contact_methods[] = {SPRING_LEAPFROG, SPRING_RK4, SPRING_SYMPLECTIC_EULER};
enum { method_count = 3, second_order = 2 }; /* the first two */

/* A custom body: the half-spaces below planes through the origin, with a contact for each. */
typedef struct faces {
    uint32_t count;
    double normal[3][3];
} faces;

SPRING_INLINE uint32_t gaps_of_faces(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const faces *f = user;
    memcpy(normal, f->normal, sizeof f->normal);
    for (uint32_t k = 0; k < f->count; k++)
        gap[k] = dot(f->normal[k], y);
    return f->count;
}

/* Free particles that fall on a collider. */
SPRING_INLINE spring_scene_def falling(size_t particles, const double *x, const double *v, double mass)
{
    spring_scene_def def = joined(3, particles, x, v, 0, NULL);
    def.mass_all = mass, def.gravity[1] = -gravity, def.colliders = 1;
    def.methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4 | 1u << SPRING_SYMPLECTIC_EULER;
    return def;
}

SPRING_INLINE void set(spring_scene *s, const spring_collider *c, uint32_t count)
{
    CHECK(spring_scene_set_colliders(s, c, count) == SPRING_OK, "valid colliders");
}

/* A scene with as many colliders as its definition has. */
SPRING_INLINE spring_scene *scene_with(const spring_scene_def *def, const spring_collider *c)
{
    spring_scene *s = scene_of(def);
    set(s, c, def->colliders);
    return s;
}

/* One free particle of 0.7 kg, with room for `count` colliders, which are set unless c is NULL. */
SPRING_INLINE spring_scene *ball_on(const spring_collider *c, uint32_t count, const double x[3], const double v[3],
                                    const double g[3], double radius)
{
    spring_scene_def def = falling(1, x, v, 0.7);
    def.colliders = count, def.particle_radius = radius;
    memcpy(def.gravity, g, sizeof def.gravity);
    return c != NULL ? scene_with(&def, c) : scene_of(&def);
}

SPRING_INLINE spring_scene *particle_on(const spring_collider *c, uint32_t count, const double x[3], const double v[3],
                                        const double g[3])
{
    return ball_on(c, count, x, v, g, 0);
}

/* The first particle. */
SPRING_INLINE void get(const spring_scene *s, double x[3], double v[3])
{
    spring_scene_get(s, SPRING_POSITION, x, 0, 0, 1);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
}

SPRING_INLINE void run(spring_scene *s, spring_method m, double dt, uint64_t n)
{
    CHECK(spring_scene_advance(s, m, dt, n) == SPRING_OK, "finite");
}

/* Takes n steps and frees the scene. */
SPRING_INLINE void end_of(spring_scene *s, spring_method m, double dt, uint64_t n, double x[3], double v[3])
{
    run(s, m, dt, n);
    get(s, x, v);
    free(s);
}

#endif
