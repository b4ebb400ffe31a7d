/* SPDX-License-Identifier: MIT */
/* SUNDIALS as an external solver: which of its integrators are correct, and that its work is counted. */
#include <math.h>
#include <stdlib.h>
#include <sundials/sundials_config.h>

#include "check.h"
#include "harness/ode.h"

static const spring_params p = {1.3, 2.7, 0.2, 0.4};
static const spring_state start = {0.8, -0.9};
static const double scale[] = {1, 1};
static const double h = 0.013;
static const uint64_t steps = 1000;

/* The distance between our RK4 and theirs, in eps of the state's size a step. */
static double distance(const char *(*solve)(ode *, double *, double, uint64_t), uint64_t *evaluations)
{
    ode o = {.size = 2, .derivative = ode_spring_derivative, .data = &p, .scale = scale};
    double y[] = {start.x, start.v};
    spring_state s = start;
    CHECK(solve(&o, y, h, steps) == NULL, "SUNDIALS is here and integrates");
    spring_advance(&s, &p, SPRING_RK4, h, steps);
    *evaluations = o.evaluations;
    return fmax(fabs(s.x - y[0]), fabs(s.v - y[1]));
}

static void arkstep(void)
{
    uint64_t evaluations;
    CHECK_BELOW(distance(ode_arkstep_rk4, &evaluations), 2 * 2 * DBL_EPSILON * (double)steps,
                "rounding, on both sides");
    CHECK(evaluations >= 4 * steps && evaluations <= 4 * steps + 1, "four stages a step");
}

/* Against the exact solution, with steps of such a length that neither rounding nor the next term counts. */
static double error_of_order_8(uint64_t n)
{
    const double duration = 10;
    ode o = {.size = 2, .derivative = ode_spring_derivative, .data = &p, .scale = scale};
    double y[] = {start.x, start.v};
    spring_state s = start;
    CHECK(ode_arkstep_8(&o, y, duration / (double)n, n) == NULL, "SUNDIALS has the table");
    CHECK(o.evaluations >= 13 * n && o.evaluations <= 13 * n + 1, "thirteen stages a step");
    spring_step_exact(&s, &p, duration);
    return hypot(s.x - y[0], s.v - y[1]);
}

static void arkstep_8(void)
{
    const double coarse = error_of_order_8(40), fine = error_of_order_8(80);
    CHECK_CLOSE(log2(coarse / fine), 8, 0.2, "eighth order, toward it: steps of a quarter and an eighth of a second");
    CHECK_BELOW(error_of_order_8(320), 4 * DBL_EPSILON * 320, "rounding");
}

#ifdef SPRING_SPRKSTEP
static double error_of_sprk(uint64_t n)
{
    const double duration = 10;
    const spring_params q = {p.mass, p.stiffness, 0, 0};
    ode o = {.size = 2, .derivative = ode_spring_derivative, .data = &q, .scale = scale};
    double y[] = {start.x, start.v};
    spring_state s = start;
    CHECK(ode_sprkstep_6(&o, y, duration / (double)n, n) == NULL, "SUNDIALS has the method");
    CHECK(o.evaluations >= 8 * n - 1 && o.evaluations <= 8 * n + 1, "eight stages a step");
    spring_step_exact(&s, &q, duration);
    return hypot(s.x - y[0], s.v - y[1]);
}
#endif

static void sprkstep(void)
{
#ifdef SPRING_SPRKSTEP
    CHECK_CLOSE(log2(error_of_sprk(80) / error_of_sprk(160)), 6, 0.3, "order six");
#else
    skip("SUNDIALS " SUNDIALS_VERSION " has no SPRKStep; it was added in 6.6");
#endif
}

/* CVODE's BDF works harder at damping 0.4 than at 0.5: its orders above 2 are unstable near the imaginary axis. */
static void bdf_in_trouble(void)
{
    const double damping[] = {0.4, 0.5};
    uint64_t evaluations[2];
    for (int i = 0; i < 2; i++) {
        const spring_params q = {1, 1, damping[i], 0};
        ode o = {.size = 2, .derivative = ode_spring_derivative, .data = &q, .scale = scale};
        double y[] = {1, 0};
        CHECK(ode_cvode_bdf(&o, y, 1000, 1e-6) == NULL, "CVODE integrates");
        CHECK_CLOSE(y[0], 0, 1e-4, "the spring has come to rest, exp(-200)");
        evaluations[i] = o.evaluations;
    }
    CHECK(evaluations[0] > 2 * evaluations[1], "1202 against 329 with SUNDIALS 6.4.1");
}

static double ticks(void)
{
    static double now;
    return now += 1;
}

static void slowness(void)
{
    CHECK_CLOSE(ode_sundials_slowness(ticks), 1, 0, "by a clock that runs as fast for both sums");
    CHECK(atoi(ode_sundials_version()) == SUNDIALS_VERSION_MAJOR, "the version of the headers");
}

int main(void)
{
    static const test tests[] = {
        {"ARKStep with the classical table agrees", arkstep},
        {"ARKStep with the table of order 8", arkstep_8},
        {"SPRKStep of order 6", sprkstep},
        {"speed and version", slowness},
        {"BDF on a lightly damped spring", bdf_in_trouble},
    };
    return RUN_TESTS("sundials", tests);
}
