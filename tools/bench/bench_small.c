/* SPDX-License-Identifier: MIT */
/*
 * spring-bench, scenes of one to six particles: the library compared with the same method, written in C for each scene.
 *
 * Times are per force evaluation. The limit of duffing is the time of its callback.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <springstep/scene.h>

#include "common/cli.h"
#include "common/timing.h"
#include "rows.h"

/* The tables only, so that the code below has the same constant coefficients as the library. */
#include "../../src/methods/rkn8_tableau.h"
#include "../../src/methods/srkn6_coefficients.h"

enum { most_axes = 6, most_particles = 6, most_links = 3, steps = 1000, rkn8_forces = 8 };
static const double mass = 1.3, dt = 1e-3, omega = 50;
static volatile double sink;

typedef const double *const *state_arrays;
typedef double *const *force_arrays;
typedef void accelerate(const double *x, double *a);

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline)) /* specialises loops for constant arguments */
#else
#define INLINE static inline
#endif

/* ------------------------------------------------------------------------------------------- methods, written out */

INLINE void plain_rk4(accelerate *f, int axes, double *x, double *v)
{
    static const double fraction[] = {0.5, 0.5, 1}, weight[] = {2, 2, 1};
    double a[most_axes], stage_x[most_axes], stage_v[most_axes], sum_x[most_axes], sum_v[most_axes];
    f(x, a);
    for (int k = 0; k < axes; k++) {
        stage_v[k] = sum_x[k] = v[k];
        sum_v[k] = a[k];
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < axes; k++) {
            stage_x[k] = x[k] + fraction[i] * dt * stage_v[k];
            stage_v[k] = v[k] + fraction[i] * dt * a[k];
        }
        f(stage_x, a);
        for (int k = 0; k < axes; k++) {
            sum_x[k] += weight[i] * stage_v[k];
            sum_v[k] += weight[i] * a[k];
        }
    }
    for (int k = 0; k < axes; k++) {
        x[k] += dt / 6 * sum_x[k];
        v[k] += dt / 6 * sum_v[k];
    }
}

INLINE void plain_rkn8(accelerate *f, int axes, double *x, double *v, double a[rkn8_forces][most_axes])
{
    double stage[most_axes];
    for (int i = 0; i < rkn8_stages; i++) {
        for (int k = 0; k < axes; k++) {
            double sum = 0;
            for (int j = 0; j <= i; j++)
                sum += rkn8_a[i][j] * a[j][k];
            stage[k] = x[k] + rkn8_c[i] * dt * v[k] + dt * dt * sum;
        }
        f(stage, a[i + 1]);
    }
    for (int k = 0; k < axes; k++) {
        double sum_x = 0, sum_v = 0;
        for (int j = 0; j <= rkn8_stages; j++) {
            sum_x += rkn8_b[j] * a[j][k];
            sum_v += rkn8_b_v[j] * a[j][k];
        }
        x[k] += dt * v[k] + dt * dt * sum_x;
        v[k] += dt * sum_v;
    }
    f(x, a[0]);
}

INLINE void plain_srkn6(accelerate *f, int axes, double *x, double *v, double *a)
{
    for (int i = 0; i < srkn6_stages; i++) {
        const double kick = dt * srkn6_b[srkn6_index(i, srkn6_stages + 1)];
        const double drift = dt * srkn6_a[srkn6_index(i, srkn6_stages)];
        for (int k = 0; k < axes; k++) {
            v[k] += kick * a[k];
            x[k] += drift * v[k];
        }
        f(x, a);
    }
    for (int k = 0; k < axes; k++)
        v[k] += dt * srkn6_b[0] * a[k];
}

INLINE void plain_steps(spring_method m, accelerate *f, int axes, double *x, double *v, uint64_t n)
{
    double a[rkn8_forces][most_axes];
    f(x, a[0]);
    for (uint64_t i = 0; i < n; i++)
        if (m == SPRING_RK4)
            plain_rk4(f, axes, x, v);
        else if (m == SPRING_RKN8)
            plain_rkn8(f, axes, x, v, a);
        else
            plain_srkn6(f, axes, x, v, a[0]);
}

/* ----------------------------------------------------------------------------------------------------- the scenes */

/* A particle with a spring of 1 N/m per kilogram to a pinned one, and x^3 by the callback. */
static void cubic(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    (void)user, (void)t, (void)particles, (void)v;
    force[0][1] -= mass * x[0][1] * x[0][1] * x[0][1];
}

/* The potential x^4 between pairs of particles and to the walls; see tools/harness/scene_cases.c. */
static void soft_quartic(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    (void)user, (void)t, (void)v;
    for (size_t i = 0; i <= particles; i += 2) {
        const double apart = (i < particles ? x[0][i] : 0) - (i > 0 ? x[0][i - 1] : 0);
        const double pull = 4 * mass * apart * apart * apart;
        if (i > 0)
            force[0][i - 1] += pull;
        if (i < particles)
            force[0][i] -= pull;
    }
}

static void accelerate_stiff_and_soft(const double *x, double *a)
{
    const double stiff = omega * omega / 2, d[] = {x[0], x[2] - x[1], x[4] - x[3], -x[5]};
    for (int i = 0; i < 3; i++) {
        const double pull = stiff * (x[2 * i + 1] - x[2 * i]);
        a[2 * i] = pull - 4 * d[i] * d[i] * d[i];
        a[2 * i + 1] = 4 * d[i + 1] * d[i + 1] * d[i + 1] - pull;
    }
}

static void accelerate_pendulum(const double *x, double *a)
{
    const double pull = -52 / mass * (1 - 1 / sqrt(x[0] * x[0] + x[1] * x[1]));
    a[0] = pull * x[0];
    a[1] = pull * x[1] - 9.81;
}

typedef enum small_scene { DUFFING, STIFF_AND_SOFT, PENDULUM, SMALL_SCENES } small_scene;
static const char *const names[SMALL_SCENES] = {"duffing", "stiff_and_soft", "elastic_pendulum"};

typedef struct subject {
    small_scene scene;
    spring_method method;
} subject;

static spring_scene *make_scene(const subject *s)
{
    static const uint8_t first[most_particles] = {1};
    static const spring_link one = {0, 1, 0, 1.3, 0, 0}, pendulum = {0, 1, 1, 52, 0, 0};
    static const double unit[] = {0, 1}, swing[] = {0, 0, 1.2, -0.1}, swing_v[] = {0, 0, -0.3, 0.4},
                        row_v[most_particles] = {0, 1.4142135623730951};
    const double row[most_particles] = {(1 - 1 / omega) / sqrt(2), (1 + 1 / omega) / sqrt(2)};
    spring_link stiff[most_links];
    for (uint32_t i = 0; i < most_links; i++)
        stiff[i] = (spring_link){2 * i, 2 * i + 1, 0, mass * omega * omega / 2, 0, 0};
    spring_scene_def def[SMALL_SCENES] = {
        [DUFFING] =
            {.axes = 1, .particles = 2, .links = 1, .position = unit, .pinned = first, .link = &one, .force = cubic},
        [STIFF_AND_SOFT] = {.axes = 1,
                            .particles = most_particles,
                            .links = most_links,
                            .position = row,
                            .velocity = row_v,
                            .link = stiff,
                            .force = soft_quartic},
        [PENDULUM] = {.axes = 2,
                      .particles = 2,
                      .links = 1,
                      .position = swing,
                      .velocity = swing_v,
                      .pinned = first,
                      .link = &pendulum,
                      .gravity = {0, -9.81}},
    };
    spring_scene_def *const d = &def[s->scene];
    d->flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    d->methods = 1u << s->method;
    d->mass_all = mass;
    size_t bytes = 0;
    spring_scene *scene = NULL;
    if (spring_scene_bytes(d, &bytes) != SPRING_OK ||
        spring_scene_init(aligned_alloc(SPRING_SCENE_ALIGN, bytes), bytes, d, &scene) != SPRING_OK)
        cli_fail(CLI_FAILED, "no memory for a scene");
    return scene;
}

static double time_library(const subject *s, uint64_t calls)
{
    spring_scene *scene = make_scene(s);
    const double start = timing_busy();
    for (uint64_t i = 0; i < calls; i++)
        if (spring_scene_advance(scene, s->method, dt, steps) != SPRING_OK)
            cli_fail(CLI_FAILED, "a scene exploded");
    const double time = timing_busy() - start;
    free(scene);
    return time;
}

/* Times the callbacks of a run, called through a pointer as in the library. */
static double time_callback(const subject *s, uint64_t calls)
{
    const uint64_t forces = (uint64_t)spring_method_describe(s->method)->forces_per_step;
    spring_scene_force_fn *volatile const hidden = cubic;
    double x[] = {0, 0.5}, v[] = {0, 0}, force[] = {0, 0};
    const double *const position[3] = {x}, *const velocity[3] = {v};
    double *const out[3] = {force};
    const double start = timing_busy();
    for (uint64_t i = 0; i < calls * steps * forces; i++)
        hidden(NULL, 0, 2, position, velocity, out);
    sink = force[1];
    return timing_busy() - start;
}

#define PLAIN_STEPS(method)                                                      \
    (s->scene == PENDULUM ? plain_steps(method, accelerate_pendulum, 2, x, v, n) \
                          : plain_steps(method, accelerate_stiff_and_soft, most_axes, x, v, n))

static double time_written_out(const subject *s, uint64_t calls)
{
    const uint64_t n = calls * steps;
    double x[most_axes] = {1.2, -0.1}, v[most_axes] = {-0.3, 0.4};
    const double start = timing_busy();
    if (s->method == SPRING_RK4)
        PLAIN_STEPS(SPRING_RK4);
    else if (s->method == SPRING_RKN8)
        PLAIN_STEPS(SPRING_RKN8);
    else
        PLAIN_STEPS(SPRING_SRKN6);
    sink = x[0];
    return timing_busy() - start;
}

static double run(const bench_row *row, int which, uint64_t calls)
{
    const subject *s = row->subject;
    if (which == 0)
        return time_library(s, calls);
    return s->scene == DUFFING ? time_callback(s, calls) : time_written_out(s, calls);
}

void bench_add_small_scenes(void)
{
    static const spring_method methods[] = {SPRING_RK4, SPRING_SRKN6, SPRING_RKN8};
    for (int i = 0; i < SMALL_SCENES; i++)
        for (size_t m = 0; m < sizeof methods / sizeof methods[0]; m++) {
            const subject s = {(small_scene)i, methods[m]};
            const int forces = spring_method_describe(methods[m])->forces_per_step;
            bench_row row = {
                .part = "small",
                .precision = "double",
                .count = (uint64_t)forces,
                .steps = steps,
                .goal_ratio = i == DUFFING ? INFINITY : 1.6,
                .goal_ns = INFINITY,
                .goal_excess_ns = i == DUFFING ? 15 * forces : 0,
                .limits = {i == DUFFING ? "callback" : "written_out"},
                .time = run,
            };
            snprintf(row.kernel, sizeof row.kernel, "%s_%s", spring_method_name(methods[m]), names[i]);
            bench_add(&row, &s, sizeof s);
        }
}
