/* SPDX-License-Identifier: MIT */
/* SUNDIALS as an external solver: orders of its integrators, and that its work is counted. spring-validate compares the
   library with ARKODE and CVODE. */
#include <math.h>
#include <stdlib.h>
#include <sundials/sundials_config.h>

#include "check.h"
#include "harness/ode.h"

static const spring_params p = {1.3, 2.7, 0.2, 0.4};
static const spring_state start = {0.8, -0.9};
static const double scale[] = {1, 1};
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
        {"ARKStep with the table of order 8", arkstep_8},
        {"SPRKStep of order 6", sprkstep},
        {"speed and version", slowness},
    };
    return RUN_TESTS("sundials", tests);
}
