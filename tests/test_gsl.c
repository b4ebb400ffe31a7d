/* SPDX-License-Identifier: MIT */
/* GSL's rk4 as an external solver. One apply(h) of GSL 2.7 is two RK4 steps of h/2, because it estimates its error by
   step doubling and keeps the finer result. */
#include <math.h>

#include "check.h"
#include "harness/ode.h"

static const spring_params springs[] = {
    {1.3, 2.7, 0, 0},
    {1.3, 2.7, 0.6, 0},
    {0.7, 19, 0.6, -1.4},
    {2.9, 0.31, 3.3, 0.2},
};

/* The library starts each step where GSL stands, so every step is compared by itself. */
static void along_gsl(const spring_params *p, double h)
{
    const double omega = sqrt(p->stiffness / p->mass), scale[] = {1, omega};
    ode o = {.size = 2, .derivative = ode_spring_derivative, .data = p, .scale = scale};
    double y[2] = {0.8, -0.9};
    for (int n = 0; n < 1000; n++) {
        spring_state ours = {y[0], y[1]};
        CHECK(ode_gsl_rk4(&o, y, h, 1) == NULL, "GSL steps");
        spring_step_rk4(&ours, p, h / 2);
        spring_step_rk4(&ours, p, h / 2);
        const double size = hypot(y[0], y[1] / omega) + fabs(p->load / p->stiffness);
        CHECK_BELOW(hypot(ours.x - y[0], (ours.v - y[1]) / omega), 2.5 * DBL_EPSILON * size,
                    "two RK4 steps of two implementations");
    }
    CHECK(o.evaluations >= 10 * o.steps && o.evaluations <= 12 * o.steps,
          "three RK4 steps an apply(), the derivative at the start shared or not");
}

static void library_step_by_step(void)
{
    for (size_t i = 0; i < sizeof springs / sizeof springs[0]; i++) {
        along_gsl(&springs[i], 0.01);
        along_gsl(&springs[i], 0.2);
    }
}

int main(void)
{
    static const test tests[] = {{"the library within 2.5 eps a step of GSL", library_step_by_step}};
    return RUN_TESTS("gsl", tests);
}
