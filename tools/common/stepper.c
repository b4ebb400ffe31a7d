/* SPDX-License-Identifier: MIT */
/* A method and its arithmetic; see stepper.h. */
#include "common/stepper.h"

#include <math.h>
#include <stddef.h>

#include "common/stages.h"

enum { LIBRARY, STAGES };

const char *const stepper_arithmetics[] = {[LIBRARY] = "library", [STAGES] = "stages", NULL};

const char *stepper_name(const stepper *m)
{
    return spring_method_name((spring_method)m->method);
}

void stepper_check(const stepper *m)
{
    if (m->arithmetic == STAGES && m->method != SPRING_RK4)
        cli_fail(CLI_USAGE, "--arithmetic: \"stages\" is for rk4 only; with --method %s it should be library",
                 stepper_name(m));
}

void stepper_remark(const stepper *m, const spring_params *p, double dt)
{
    run_length_remark_step(dt, spring_stable_step(p, (spring_method)m->method), (spring_method)m->method);
}

void stepper_comment(const stepper *m, cli_table *table)
{
    cli_comment(table, "method: %s, arithmetic: %s", stepper_name(m), stepper_arithmetics[m->arithmetic]);
}

/* As spring_advance(): checks for overflow at the same interval, and leaves the state unchanged if it overflows. */
static spring_status advance_by_stages(spring_state *s, const spring_params *p, double dt, uint64_t n)
{
    spring_state now = *s;
    while (n > 0) {
        const uint64_t some = n < SPRING_CHECK_INTERVAL ? n : SPRING_CHECK_INTERVAL;
        stages_advance(&now, p, dt, some);
        if (!isfinite(now.x) || !isfinite(now.v))
            return SPRING_ENONFINITE;
        n -= some;
    }
    *s = now;
    return SPRING_OK;
}

spring_status stepper_advance(const stepper *m, spring_state *s, const spring_params *p, double dt, uint64_t n)
{
    if (m->arithmetic == STAGES)
        return advance_by_stages(s, p, dt, n);
    return spring_advance(s, p, (spring_method)m->method, dt, n);
}
