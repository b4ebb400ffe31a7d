/* SPDX-License-Identifier: MIT */
/* Each step method compared with the same method in exact arithmetic: the difference is rounding error, with a bound
   from counting operations. */
#include <math.h>

#include "check.h"
#include "harness/reference.h"
#include "test_methods.h"

static const char rounding[] = "rounding of n steps, counted in reference.h";

static void against_iterate(spring_params p, spring_method m, double dt, uint64_t n, spring_state start)
{
    reference ref;
    double rounded, truncated;
    spring_state got = start;
    reference_init(&ref);
    reference_start(&ref, &p, start);
    reference_bounds *bounds = reference_bounds_new(&p, start);
    reference_bounds_add(bounds, &p, m, dt, n);
    reference_bounds_end(bounds, &rounded, &truncated);
    reference_iterate(&ref, &p, m, dt, n);
    CHECK(spring_advance(&got, &p, m, dt, n) == SPRING_OK, "a stable run of finite numbers");
    CHECK_BELOW(reference_distance(&ref, got), rounded, rounding);
    reference_clear(&ref);
}

/* Draws springs of all sizes, steps up to just below the stable one (or 0.05/omega where that is 0). */
static void random_springs(bool damped, bool loaded, double direction)
{
    for (int i = 0; i < 200; i++) {
        spring_params p = {.mass = random_log(1e-3, 1e3), .stiffness = random_log(1e-3, 1e3)};
        const double omega = sqrt(p.stiffness / p.mass);
        if (damped)
            p.damping = 2 * random_log(1e-4, 10) * sqrt(p.stiffness * p.mass);
        if (loaded)
            p.load = p.stiffness * random_uniform(-2, 2);
        const spring_state start = {random_uniform(-1, 1), omega * random_uniform(-1, 1)};
        const double fraction = i % 5 == 0 ? 0.999 : random_log(1e-3, 1);
        const uint64_t n = 1 + random_bits() % 800;
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            double limit = fmin(spring_stable_step(&p, *m), 3 / omega);
            if (limit == 0)
                limit = 0.05 / omega; /* Euler's method grows by (1 + 0.0025)^(n/2) */
            if (direction < 0)
                limit = fmin(limit, 0.01 / (omega + p.damping / p.mass)); /* backwards damping is growth */
            against_iterate(p, *m, direction * limit * fraction, n, start);
        }
    }
}

static void forwards(void)
{
    for (int features = 0; features < 4; features++)
        random_springs(features % 2 == 1, features / 2 == 1, 1);
}

static void backwards(void)
{
    random_springs(false, false, -1);
    random_springs(true, true, -1);
}

/* The energies of the numerical solutions, in u = x + i v/omega. */
static void energy_laws(void)
{
    const spring_params p = {.mass = 1.3, .stiffness = 2.7};
    const double omega = sqrt(p.stiffness / p.mass);
    const spring_state start = {0.8, -0.9};
    const uint64_t n = 1000;
    for (double z = 0.01; z < 0.6; z *= 1.7) {
        const double dt = z / omega, e0 = spring_energy(&start, &p);
        spring_state s = start;
        spring_advance(&s, &p, SPRING_EULER, dt, n);
        const double euler = e0 * exp((double)n * log1p(z * z));
        CHECK_CLOSE(spring_energy(&s, &p), euler, 10 * (double)n * DBL_EPSILON * euler, "Euler: E0 (1 + z^2)^n");
        s = start;
        spring_advance(&s, &p, SPRING_RK4, dt, n);
        const double rk4 = e0 * exp((double)n * log1p(pow(z, 8) / 576 - pow(z, 6) / 72));
        CHECK_CLOSE(spring_energy(&s, &p), rk4, 10 * (double)n * DBL_EPSILON * e0, "RK4: E0 (1 - z^6/72 + z^8/576)^n");
        s = start;
        double worst = 0;
        const double shadow = start.v * start.v + omega * omega * (1 - z * z / 4) * start.x * start.x;
        for (uint64_t i = 0; i < n; i++) {
            spring_step_leapfrog(&s, &p, dt);
            worst = fmax(worst, fabs(s.v * s.v + omega * omega * (1 - z * z / 4) * s.x * s.x - shadow));
            CHECK(fabs(spring_energy(&s, &p) - e0) <= e0 * z * z / 2,
                  "E/E0 is within 1 and 1 - z^2/4 of the invariant, at both ends");
        }
        CHECK_BELOW(worst, 10 * (double)n * DBL_EPSILON * shadow, "leapfrog conserves v^2 + w (1 - z^2/4) x^2");
    }
}

/* x_n = cos(n theta) x0 + sin(n theta) v0/(omega s), v_n = -omega s sin(n theta) x0 + cos(n theta) v0. */
static void leapfrog_by_formula(void)
{
    for (int i = 0; i < 200; i++) {
        const spring_params p = {.mass = random_log(0.1, 10), .stiffness = random_log(0.1, 10)};
        const double omega = sqrt(p.stiffness / p.mass), z = random_uniform(0.01, 1.95);
        const uint64_t n = 1 + random_bits() % 100000;
        const spring_state start = {random_uniform(-1, 1), random_uniform(-1, 1) * omega};
        const double s = sqrt(1 - z * z / 4), angle = (double)n * 2 * asin(z / 2);
        spring_state got = start;
        spring_advance(&got, &p, SPRING_LEAPFROG, z / omega, n);
        /* 5 eps a step for both sides: 2 for the map's own angle, asin'(z/2) = 1/s, 3 for the steps */
        const double bound = 5 * (double)n * DBL_EPSILON / (s * s) * hypot(start.x, start.v / omega);
        CHECK_CLOSE(got.x, cos(angle) * start.x + sin(angle) * start.v / (omega * s), bound, "rounding near the limit");
        CHECK_CLOSE(got.v, -omega * s * sin(angle) * start.x + cos(angle) * start.v, bound * omega,
                    "rounding near the limit");
    }
}

/* A million steps: the biased rounding of a badly chosen form would show. */
static void long_runs(void)
{
    const spring_state start = {1.1, -0.4};
    for (const spring_method *m = steppers(); *m != no_method; m++)
        for (double damping = 0; damping < 1e-3; damping = damping * 100 + 1e-9) {
            const spring_params p = {.mass = 1.3, .stiffness = 2.7, .damping = damping};
            reference ref;
            reference_init(&ref);
            const double dt = never_stable(*m) ? 1e-6 : 0.013;
            const uint64_t n = 1000000;
            spring_state got = start;
            reference_start(&ref, &p, start);
            reference_iterate(&ref, &p, *m, dt, n);
            spring_advance(&got, &p, *m, dt, n);
            /* unbiased: sqrt(n) eps, and the one rounding of a coefficient, eps/4 of the angle omega t or less */
            const double t = dt * (double)n, omega = sqrt(2.7 / 1.3);
            CHECK_BELOW(reference_distance(&ref, got), (5 * sqrt((double)n) + omega * t / 4) * DBL_EPSILON * 1.2,
                        "rounding grows like sqrt(n), not like n");
            reference_clear(&ref);
        }
}

int main(void)
{
    static const test tests[] = {
        {"springs without and with damping and load", forwards},
        {"backwards", backwards},
        {"energy laws of Euler, leapfrog and RK4", energy_laws},
        {"the formula of n leapfrog steps", leapfrog_by_formula},
        {"a million steps round without bias", long_runs},
    };
    return RUN_TESTS("iterate", tests);
}
