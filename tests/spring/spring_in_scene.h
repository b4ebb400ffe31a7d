/* SPDX-License-Identifier: MIT */
/* One spring as a scene of two particles, for methods that support scenes only. Its mass should be a power of two, so
   that w and g are exactly those of the reference solutions. */
#ifndef SPRING_IN_SCENE_H
#define SPRING_IN_SCENE_H

#include <math.h>
#include <stdlib.h>

#include <springstep/scene.h>

#include "check.h"
#include "harness/reference.h"

/* The state after n steps of dt. */
static inline spring_state advance_in_scene(spring_method m, spring_params p, double dt, uint64_t n, spring_state from)
{
    const double position[] = {0, from.x}, velocity[] = {0, from.v};
    const uint8_t pinned[] = {1, 0};
    const spring_link link = {0, 1, 0, p.stiffness, 0, 0};
    const spring_scene_def def = {.axes = 1,
                                  .methods = 1u << m,
                                  .particles = 2,
                                  .links = 1,
                                  .position = position,
                                  .velocity = velocity,
                                  .mass_all = p.mass,
                                  .pinned = pinned,
                                  .link = &link,
                                  .gravity = {p.load / p.mass},
                                  .drag = p.damping};
    size_t bytes = 0;
    spring_scene *s;
    spring_state end = {NAN, NAN};
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "a valid definition");
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    CHECK(spring_scene_init(memory, bytes, &def, &s) == SPRING_OK, "a valid definition");
    CHECK(spring_scene_advance(s, m, dt, n) == SPRING_OK, "finite numbers");
    spring_scene_get(s, SPRING_POSITION, &end.x, 0, 1, 1);
    spring_scene_get(s, SPRING_VELOCITY, &end.v, 0, 1, 1);
    free(memory);
    return end;
}

static inline double omega_of(const spring_params *p)
{
    return sqrt(p->stiffness / p->mass);
}

/* A random spring, its mass a power of two: every second one with damping, two of four with a load. */
static inline spring_params random_spring(int i)
{
    spring_params p = {.mass = ldexp(1, (int)(random_bits() % 12) - 6), .stiffness = random_log(1e-3, 1e3)};
    if (i % 2 != 0)
        p.damping = p.mass * omega_of(&p) * random_log(1e-4, 5);
    if (i % 4 >= 2)
        p.load = p.stiffness * random_uniform(-2, 2);
    return p;
}

/* The distance of n steps from the same steps in exact arithmetic, divided by the bound of its rounding, reference.h. */
static inline double rounding_of_steps(spring_method m, spring_params p, double dt, uint64_t n, spring_state start)
{
    double rounded, truncated;
    reference ref;
    reference_init(&ref);
    reference_start(&ref, &p, start);
    reference_bounds *bounds = reference_bounds_new(&p, start);
    reference_bounds_add(bounds, &p, m, dt, n);
    reference_bounds_end(bounds, &rounded, &truncated);
    reference_iterate(&ref, &p, m, dt, n);
    const double distance = reference_distance(&ref, advance_in_scene(m, p, dt, n, start));
    reference_clear(&ref);
    return distance / rounded;
}

/* Against the same method in exact arithmetic: springs of all sizes, steps up to h omega = limit or g h = 20, and back.
   bound: in units of that of reference.h. */
static inline void check_against_iterate(spring_method m, double limit, double bound)
{
    for (int i = 0; i < 400; i++) {
        const spring_params p = random_spring(i);
        const double omega = omega_of(&p), g = p.damping / p.mass;
        const spring_state start = {random_uniform(-1, 1), omega * random_uniform(-1, 1)};
        const double z = i % 5 == 0 ? limit : random_log(1e-3, limit);
        const double forward = fmin(z / omega, 20 / g), back = -fmin(z, 0.01) / (omega + g); /* where drag is growth */
        const uint64_t n = 1 + random_bits() % 300;
        CHECK_BELOW(rounding_of_steps(m, p, i % 7 == 0 ? back : forward, n, start), bound, "rounding of n steps");
    }
}

/* The distance of n steps from the exact solution. */
static inline double error_in_scene(spring_method m, spring_params p, double duration, uint64_t n, spring_state start)
{
    reference exact;
    reference_init(&exact);
    reference_start(&exact, &p, start);
    reference_exact(&exact, &p, duration);
    const double error = reference_distance(&exact, advance_in_scene(m, p, duration / (double)n, n, start));
    reference_clear(&exact);
    return error;
}

/* The distance in (x, v/omega), with and without drag and load, by steps of z = 0.7 and less. */
static inline void check_order(spring_method m)
{
    static const double dampings[] = {0, 0.02, 0.6}, loads[] = {0, 1.9};
    for (int i = 0; i < 6; i++) {
        const spring_params p = {0.5, 2.7, dampings[i % 3], loads[i / 3]};
        double error[3];
        for (int j = 0; j < 3; j++)
            error[j] = error_in_scene(m, p, 14 / omega_of(&p), (uint64_t)20 << j, (spring_state){0.8, -0.9});
        for (int j = 0; j < 2; j++)
            CHECK_CLOSE(log2(error[j] / error[j + 1]), spring_method_describe(m)->order, 0.1, "slope");
    }
}

/* The matrix of one step in (x, v/omega), of a spring with h omega = z and a damping ratio. */
typedef struct step_invariants {
    double trace, det;
} step_invariants;

static inline step_invariants invariants_of_step(spring_method m, double z, double ratio)
{
    spring_params p = {.mass = 0.5, .stiffness = 2.7};
    const double omega = omega_of(&p);
    p.damping = 2 * ratio * p.mass * omega;
    const spring_state a = advance_in_scene(m, p, z / omega, 1, (spring_state){1, 0}),
                       b = advance_in_scene(m, p, z / omega, 1, (spring_state){0, omega});
    return (step_invariants){a.x + b.v / omega, (a.x * b.v - a.v * b.x) / omega};
}

#endif
