/* SPDX-License-Identifier: MIT */
/* The stable step compared with its definition in multiple precision, and with steps just below and above it. */
#include <math.h>

#include "check.h"
#include "harness/reference.h"
#include "test_methods.h"

static spring_params spring_of(double omega, double zeta, double mass)
{
    return (spring_params){.mass = mass, .stiffness = mass * omega * omega, .damping = 2 * zeta * mass * omega};
}

static void against_definition(void)
{
    for (int i = 0; i < 600; i++) {
        double zeta = random_log(1e-6, 1e4);
        if (i % 3 == 1)
            zeta = 1 + (random_bits() % 2 ? 1 : -1) * random_log(1e-16, 1e-2);
        const spring_params p = spring_of(random_log(1e-6, 1e6), zeta, random_log(1e-6, 1e6));
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const double want = reference_stable_step(&p, *m);
            CHECK_CLOSE(spring_stable_step(&p, *m), want, 4 * DBL_EPSILON * want, "8 ulp");
        }
    }
}

static void special_springs(void)
{
    const spring_params undamped = spring_of(1.7, 0, 1.3), dragged = {1.3, 0, 0.6, 0.2}, free_mass = {1.3, 0, 0, 0.2};
    const double omega = sqrt(undamped.stiffness / 1.3), g = 0.6 / 1.3;
    CHECK_BITS(spring_stable_step(&undamped, SPRING_EULER), 0, "Euler without damping: never");
    CHECK_CLOSE(spring_stable_step(&undamped, SPRING_LEAPFROG), 2 / omega, 4 * DBL_EPSILON / omega, "2/omega");
    CHECK_CLOSE(spring_stable_step(&undamped, SPRING_RK4), sqrt(8) / omega, 8 * DBL_EPSILON / omega, "2 sqrt 2/omega");
    CHECK_CLOSE(spring_stable_step(&dragged, SPRING_EULER), 2 / g, 4 * DBL_EPSILON * 2 / g, "2/g");
    CHECK_CLOSE(spring_stable_step(&dragged, SPRING_RK4), 2.785293563405282 / g, 4 * DBL_EPSILON * 3 / g, "2.785.../g");
    CHECK_BITS(spring_stable_step(&dragged, SPRING_LEAPFROG), INFINITY, "leapfrog without stiffness: always");
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        CHECK_BITS(spring_stable_step(&free_mass, *m), INFINITY, "no force at all: always");
    CHECK_BITS(spring_stable_step(&undamped, SPRING_EXACT), INFINITY, "the exact solution: always");
    const spring_params negative_zeros = {1.3, -0.0, -0.0, -0.0}, one_zero = {1.3, 2.7, -0.0, 0};
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        CHECK_BITS(spring_stable_step(&negative_zeros, *m), INFINITY, "-0 is 0");
    CHECK_BITS(spring_stable_step(&one_zero, SPRING_EULER), 0, "-0 is 0");
    /* 5e-324/1.8625 rounds to 5e-324 again: what the steppers move, and nearly twice the quotient */
    const spring_params faint = {1.8625, 5e-324, 0, 0};
    const double faint_omega = sqrt(5e-324);
    CHECK_CLOSE(spring_stable_step(&faint, SPRING_RK4) * faint_omega, sqrt(8), 8 * DBL_EPSILON, "denormal stiffness");
    CHECK_CLOSE(spring_stable_step(&faint, SPRING_LEAPFROG) * faint_omega, 2, 8 * DBL_EPSILON, "denormal stiffness");
    static const double damping[] = {1e160, 1e165, 1e200, 1e300}, mass[] = {1, 1.3, 3};
    for (size_t i = 0; i < sizeof damping / sizeof damping[0]; i++)
        for (size_t k = 0; k < sizeof mass / sizeof mass[0]; k++) {
            const spring_params thick = {mass[k], 1, damping[i], 0};
            CHECK_CLOSE(spring_stable_step(&thick, SPRING_EULER) * damping[i], 2 * mass[k], 8 * DBL_EPSILON * mass[k],
                        "neither b^2 nor the rounding error of b overflows");
        }
}

static void bad_input(void)
{
    const spring_params good = {1.3, 2.7, 0.6, 0.4}, bad = {-1.3, 2.7, 0.6, 0.4};
    CHECK(isnan(spring_stable_step(NULL, SPRING_RK4)), "no parameters");
    CHECK(isnan(spring_stable_step(&bad, SPRING_RK4)), "negative mass");
    CHECK(isnan(spring_stable_step(&good, no_method)), "no such method");
    CHECK(isnan(spring_stable_step(&good, (spring_method)-1)), "no such method");
}

/* The larger modulus of the eigenvalues of one step of the library, from two basis states. */
static double spectral_radius(const spring_params *p, spring_method m, double dt)
{
    spring_state e = {1, 0}, f = {0, 1};
    CHECK(spring_advance(&e, p, m, dt, 1) == SPRING_OK && spring_advance(&f, p, m, dt, 1) == SPRING_OK, "one step");
    const double half_trace = (e.x + f.v) / 2, det = e.x * f.v - e.v * f.x;
    const double discriminant = half_trace * half_trace - det;
    return discriminant < 0 ? sqrt(det) : fabs(half_trace) + sqrt(discriminant);
}

static void inside_and_outside(void)
{
    for (int i = 0; i < 3000; i++) {
        const double zeta = i % 10 == 0 ? 0 : random_log(0.01, 100);
        const spring_params p = spring_of(random_log(0.1, 10), zeta, random_log(0.1, 10));
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const double limit = spring_stable_step(&p, *m);
            CHECK(limit > 0 || (zeta == 0 && never_stable(*m)), "a damped spring has a stable step");
            if (limit == 0) {
                CHECK(spectral_radius(&p, *m, random_log(0.03, 2) / sqrt(p.stiffness / p.mass)) > 1 + 1e-11,
                      "unstable at every step size");
                continue;
            }
            CHECK(spectral_radius(&p, *m, limit * (1 - 1e-6)) <= 1 + 4 * DBL_EPSILON, "just inside");
            CHECK(spectral_radius(&p, *m, limit * (1 + 1e-6)) > 1 + 1e-11,
                  "just outside: Euler grows by 2e-6 zeta^2 there");
        }
        if (zeta == 0) {
            const double z = random_log(1e-3, 2), omega = sqrt(p.stiffness / p.mass);
            CHECK_CLOSE(log(spectral_radius(&p, SPRING_EULER, z / omega)), log1p(z * z) / 2, 8 * DBL_EPSILON,
                        "Euler grows at every step size");
        }
    }
}

int main(void)
{
    static const test tests[] = {
        {"the definition, in multiple precision", against_definition},
        {"special springs", special_springs},
        {"bad input", bad_input},
        {"a millionth inside and outside", inside_and_outside},
    };
    return RUN_TESTS("stable_step", tests);
}
