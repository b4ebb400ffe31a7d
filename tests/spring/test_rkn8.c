/* SPDX-License-Identifier: MIT */
/* RKN8 on one spring in a scene: rounding error, order and error constant, energy, stable step. The mass is a power of
   two, so that w and g are exactly those of the reference solutions. Tests of scenes check the properties of all
   methods. */
#include <springstep/batch.h>

#include "spring_in_scene.h"

static void against_iterate(void)
{
    check_against_iterate(SPRING_RKN8, 3.13, 1);
}

static double error_of(spring_params p, double duration, uint64_t n, spring_state start)
{
    return error_in_scene(SPRING_RKN8, p, duration, n, start);
}

static void order(void)
{
    check_order(SPRING_RKN8);
}

/* The phase is off by C omega^9 h^8 T, C = 2.1716e-8 from the trace and the determinant of the step's matrix, and the
   ellipse by less than 1.1e-8 z^8. */
static void error_constant(void)
{
    const spring_params p = {.mass = 0.5, .stiffness = 2.7};
    const spring_state start = {0.8, -0.9};
    const double C = 2.1716e-8, omega = omega_of(&p), size = hypot(start.x, start.v / omega);
    for (uint64_t n = 400; n <= 800; n *= 2) {
        const double angle = 160, z = angle / (double)n, law = C * angle * pow(z, 8) * size;
        CHECK_CLOSE(error_of(p, angle / omega, n, start), law, (0.01 + 0.5 * z * z) * law,
                    "half of the ellipse over the angle, and the next order");
    }
}

/* A step multiplies the energy by the determinant of its matrix, 1 - 3.7436e-8 z^10 + 4.6927e-9 z^12 - ..., except for
   what the ellipse is off. */
static void energy_law(void)
{
    const spring_params p = {.mass = 0.5, .stiffness = 2.7};
    const spring_state start = {0.8, -0.9};
    const double omega = omega_of(&p), before = spring_energy(&start, &p);
    for (double z = 0.6; z < 1.7; z *= 1.3) {
        const uint64_t n = 20000;
        const spring_state end = advance_in_scene(SPRING_RKN8, p, z / omega, n, start);
        const double lost =
            3.743628e-8 * pow(z, 10) - 4.692673e-9 * pow(z, 12) + 1.228181e-10 * pow(z, 14) - 7.815e-13 * pow(z, 16);
        const double want = before * exp((double)n * log1p(-lost));
        CHECK_CLOSE(spring_energy(&end, &p), want, before * (2.2e-8 * pow(z, 9) / sin(z) + 1e-14 * sqrt((double)n)),
                    "the ellipse, off by 2.0e-8 z^8 z/sin z and the next order; rounding");
        CHECK(want < before * (1 - 1e-7) || z < 0.8, "there is something to be seen");
    }
}

/* |eigenvalues| of a step at h omega = z, damping ratio `ratio`: is none above 1? */
static bool stable(double z, double ratio)
{
    const double rounding = 1e-14;
    const step_invariants step = invariants_of_step(SPRING_RKN8, z, ratio);
    return fabs(step.det) <= 1 + rounding && fabs(step.trace) <= 1 + step.det + rounding;
}

/* Without drag up to 3.1402, where two eigenvalues meet at -1; with drag up to that and, as a scene has it, to g h =
   40. */
static void stable_step(void)
{
    for (double ratio = 0; ratio < 100; ratio = ratio * 1.5 + 0.01)
        for (double z = fmin(3.14, 20 / ratio); z > 0.01; z *= 0.97)
            CHECK(stable(z, ratio), "no eigenvalue beyond 1");
    CHECK(!stable(3.141, 0), "it is the limit");
    CHECK(stable(3.2, 0) && !stable(3.3, 0), "that of a narrow gap, and the next one");
}

/* Where the exact solution is. */
static void not_for_springs(void)
{
    const spring_params p = {.mass = 0.5, .stiffness = 2.7};
    const spring_state start = {0.8, -0.9};
    const double omega2 = 5.4;
    spring_state s = start;
    CHECK(spring_advance(&s, &p, SPRING_RKN8, 0.1, 3) == SPRING_EUNSUPPORTED, "one spring");
    CHECK_STATE(s, start, "as it was");
    const spring_batch batch = {.count = 1, .x = &s.x, .v = &s.v, .omega2 = &omega2};
    CHECK(spring_batch_advance(&batch, SPRING_RKN8, 0.1, 3) == SPRING_EUNSUPPORTED, "a batch");
    CHECK_STATE(s, start, "as it was");
    CHECK(isnan(spring_stable_step(&p, SPRING_RKN8)) && isnan(spring_batch_stable_step(&batch, SPRING_RKN8)) &&
              spring_method_kernel(SPRING_RKN8) == NULL,
          "nothing to be stable");
}

int main(void)
{
    static const test tests[] = {
        {"against the method in exact arithmetic", against_iterate},
        {"order 8, with drag and without", order},
        {"the error constant", error_constant},
        {"the energy that is lost", energy_law},
        {"the stable step", stable_step},
        {"not for one spring, nor batches", not_for_springs},
    };
    return RUN_TESTS("rkn8", tests);
}
