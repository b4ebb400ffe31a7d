/* SPDX-License-Identifier: MIT */
/* SRKN6: rounding error, order, phase, energy and stable step on one spring in a scene; order with nonlinear forces; time
   reversibility. srkn6_coefficients.py checks the order conditions, and tests of scenes check the properties of all
   methods. */

#include "methods/srkn6_coefficients.h"
#include "spring_in_scene.h"

static void sums_of_drifts(void)
{
    double time = 0;
    for (int i = 0; i < srkn6_stages; i++) {
        time += srkn6_a[srkn6_index(i, srkn6_stages)];
        CHECK_CLOSE(srkn6_c[i], time, 2 * DBL_EPSILON, "the sums of the drifts");
    }
}

/* 23 kicks and drifts round where the bound of reference.h counts 4 times. */
static void against_iterate(void)
{
    check_against_iterate(SPRING_SRKN6, 9.07, 6);
}

static void order(void)
{
    check_order(SPRING_SRKN6);
}

/* A step turns by less than z: by 8.0422e-8 z^7, and by 8.16e-8 z^7 at z = 1. It multiplies no area. */
static void phase_error(void)
{
    for (double z = 0.7; z < 2.2; z += 0.1) {
        const step_invariants step = invariants_of_step(SPRING_SRKN6, z, 0);
        const double law = 8.0422e-8 * pow(z, 7);
        CHECK_CLOSE(z - acos(step.trace / 2), law, 0.02 * z * z * law + 8 * DBL_EPSILON * (1 + z * z),
                    "the next order, and the rounding of the trace");
        CHECK_CLOSE(step.det, 1, 32 * DBL_EPSILON, "23 shears");
    }
}

/* The ellipse on which an oscillator moves is longer in v by 1.4194e-7 z^6 (1 + 0.2 z^2). */
static void energy_bounded(void)
{
    const spring_params p = {.mass = 0.5, .stiffness = 2.7};
    const double omega = omega_of(&p);
    for (double z = 0.5; z < 2.1; z += 0.3) {
        spring_state s = {0.8, -0.9};
        const double before = spring_energy(&s, &p), bound = 2 * 1.4194e-7 * pow(z, 6) * (1 + 0.33 * z * z);
        double largest = 0;
        for (int i = 0; i < 300; i++) {
            s = advance_in_scene(SPRING_SRKN6, p, z / omega, 37, s);
            largest = fmax(largest, fabs(spring_energy(&s, &p) / before - 1));
        }
        CHECK_BELOW(largest, bound + 1e-14 * sqrt(300 * 37), "twice the ellipse, and rounding");
        CHECK(largest > 0.3 * bound, "there is something to be seen");
    }
}

static bool stable(double z, double ratio, double rounding)
{
    const step_invariants step = invariants_of_step(SPRING_SRKN6, z, ratio);
    return fabs(step.det) <= 1 + rounding && fabs(step.trace) <= 1 + step.det + rounding * (1 + fabs(step.trace));
}

/* With drag to h omega = 9.07 and g h = 20, as scenes have it. Where the eigenvalues of an undamped spring meet at -1 and
   at 1, just beyond pi and 2 pi, they leave the circle a little: g h = 1.4e-3 is enough to bring them back. */
static void stable_step(void)
{
    const double rounding = 1e-13;
    for (double ratio = 1e-4; ratio < 1e4; ratio = ratio * 1.2 + 0.001)
        for (double z = fmin(9.07, 10 / ratio); z > 0.02; z *= 0.99)
            CHECK(stable(z, fmax(ratio, 7e-4 / z), rounding), "no eigenvalue beyond 1");
    for (double z = 0.001; z < 9.07; z += 0.001) {
        const bool gap = (z > 3.1413 && z < 3.1424) || (z > 6.3477 && z < 6.3494);
        CHECK(stable(z, 0, gap ? 3e-7 : rounding), "growth by at most acosh(1 + 2.2e-7) = 6.6e-4 a step");
    }
    CHECK(!stable(3.1419, 0, rounding) && !stable(6.3486, 0, rounding), "the two narrow gaps");
    CHECK(!stable(9.0737, 0, rounding), "it is the limit");
}

/* With drag alone, each step is exact. */
static void drag_alone(void)
{
    const spring_params p = {.mass = 0.5, .damping = 0.3};
    for (double dt = 0.01; dt < 30; dt *= 1.7) {
        const spring_state start = {0.8, -0.9}, end = advance_in_scene(SPRING_SRKN6, p, dt, 1, start);
        const double g = p.damping / p.mass, lost = -expm1(-g * dt), rounding = 40 * DBL_EPSILON * exp(0.3 * g * dt);
        CHECK_CLOSE(end.v, start.v * (1 - lost), rounding, "roundings that grow in drifts backwards");
        CHECK_CLOSE(end.x, start.x + start.v / g * lost, rounding * (1 + 1 / g), "likewise");
    }
}

/* A mass on a spring that swings in a plane: forces that are not linear. */
static spring_scene *pendulum(double drag)
{
    static const double position[] = {0, 0, 1.1, -0.2}, velocity[] = {0, 0, 0.3, 0.7}, mass[] = {1, 0.7};
    static const uint8_t pinned[] = {1, 0};
    static const spring_link link = {0, 1, 0.9, 31.3, 0, 0};
    const spring_scene_def def = {.axes = 2,
                                  .methods = 1u << SPRING_SRKN6,
                                  .particles = 2,
                                  .links = 1,
                                  .position = position,
                                  .velocity = velocity,
                                  .mass = mass,
                                  .pinned = pinned,
                                  .link = &link,
                                  .gravity = {0, -9.81},
                                  .drag = drag};
    size_t bytes = 0;
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "a valid definition");
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    spring_scene *s;
    CHECK(spring_scene_init(memory, bytes, &def, &s) == SPRING_OK, "a valid definition");
    return s;
}

typedef struct state {
    double x[2], v[2];
} state;

static state after(spring_scene *s, double dt, uint64_t n)
{
    state y;
    CHECK(spring_scene_advance(s, SPRING_SRKN6, dt, n) == SPRING_OK, "finite numbers");
    spring_scene_get(s, SPRING_POSITION, y.x, 0, 1, 1);
    spring_scene_get(s, SPRING_VELOCITY, y.v, 0, 1, 1);
    return y;
}

/* From the differences between runs with steps that are halved, of positions and of velocities. */
static void nonlinear_order(void)
{
    for (double drag = 0; drag < 1; drag += 0.4) {
        double dx[3], dv[3];
        state before = {{0}, {0}};
        for (int i = 0; i < 4; i++) {
            spring_scene *s = pendulum(drag);
            const uint64_t n = UINT64_C(12) << i;
            const state now = after(s, 1.7 / (double)n, n);
            if (i > 0) {
                dx[i - 1] = hypot(now.x[0] - before.x[0], now.x[1] - before.x[1]);
                dv[i - 1] = hypot(now.v[0] - before.v[0], now.v[1] - before.v[1]);
            }
            before = now;
            free(s);
        }
        CHECK_CLOSE(log2(dx[1] / dx[2]), 6, 0.1, "slope of the positions");
        CHECK_CLOSE(log2(dv[1] / dv[2]), 6, 0.1, "slope of the velocities");
    }
}

/* Forward and back, also with drag, whose drift is inverted exactly. */
static void reversible(void)
{
    for (double drag = 0; drag < 1; drag += 0.4) {
        spring_scene *s = pendulum(drag);
        const double dt = 0.3 * spring_scene_stable_step(s, SPRING_SRKN6);
        const state start = after(s, dt, 0);
        after(s, dt, 7);
        const state end = after(s, -dt, 7);
        for (int a = 0; a < 2; a++) {
            CHECK_CLOSE(end.x[a], start.x[a], 1e-12, "the method is symmetric: only rounding");
            CHECK_CLOSE(end.v[a], start.v[a], 1e-12, "the method is symmetric: only rounding");
        }
        free(s);
    }
}

int main(void)
{
    static const test tests[] = {
        {"the times of the kicks", sums_of_drifts}, {"against the method in exact arithmetic", against_iterate},
        {"order 6, with drag and without", order},  {"the phase error of a step", phase_error},
        {"the energy is bounded", energy_bounded},  {"the stable step", stable_step},
        {"drag alone is exact", drag_alone},        {"order 6 of a pendulum", nonlinear_order},
        {"forward and back", reversible},
    };
    return RUN_TESTS("srkn6", tests);
}
