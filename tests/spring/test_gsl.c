/* SPDX-License-Identifier: MIT */
/*
 * GSL's rk4 as an external solver. One apply(h) of GSL 2.7 is two RK4 steps of h/2, because it estimates its error by
 * step doubling and keeps the finer result.
 */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "check.h"
#include "common/stages.h"

typedef struct counted_rates {
    double w, g, a;
    unsigned long calls;
} counted_rates;

static int right_hand_side(double t, const double y[], double dy[], void *user)
{
    (void)t;
    counted_rates *r = user;
    r->calls++;
    dy[0] = y[1];
    dy[1] = r->a - r->w * y[0] - r->g * y[1];
    return GSL_SUCCESS;
}

static const spring_params springs[] = {
    {1.3, 2.7, 0, 0},
    {1.3, 2.7, 0.6, 0},
    {0.7, 19, 0.6, -1.4},
    {2.9, 0.31, 3.3, 0.2},
};

/* The RK4 by stages of tools/common. spring-validate compares the library with GSL. */
static void along_gsl(double h, int steps)
{
    for (size_t i = 0; i < sizeof springs / sizeof springs[0]; i++) {
        const spring_params *p = &springs[i];
        counted_rates r = {p->stiffness / p->mass, p->damping / p->mass, p->load / p->mass, 0};
        gsl_odeiv2_system system = {right_hand_side, NULL, 2, &r};
        gsl_odeiv2_step *stepper = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk4, 2);
        double y[2] = {0.8, -0.9}, error[2];
        spring_state ours = {y[0], y[1]};
        CHECK(stepper != NULL, "GSL is here");
        for (int n = 0; n < steps; n++) {
            CHECK(gsl_odeiv2_step_apply(stepper, n * h, h, y, error, NULL, NULL, &system) == GSL_SUCCESS, "GSL steps");
            stages_advance_gsl(&ours, p, h / 2, 2);
            CHECK_STATE(ours, ((spring_state){y[0], y[1]}), "the same operations in the same order");
        }
        CHECK(r.calls >= 10UL * (unsigned long)steps && r.calls <= 12UL * (unsigned long)steps,
              "three RK4 steps an apply(), the derivative at the start shared or not");
        gsl_odeiv2_step_free(stepper);
    }
}

static void stages_bit_for_bit(void)
{
    along_gsl(0.01, 1000);
    along_gsl(0.37, 1000);
}

int main(void)
{
    static const test tests[] = {
        {"RK4 by stages equals two half steps of GSL bit for bit", stages_bit_for_bit},
    };
    return RUN_TESTS("gsl", tests);
}
