/* SPDX-License-Identifier: MIT */
/* The length of a run; see run_length.h. */
#include "common/run_length.h"

#include <math.h>

#include "common/cli.h"

static void count_steps(run_length *run)
{
    const double most_steps = (double)CLI_MOST_STEPS, steps = fmax(rint(run->duration / run->dt), 1);
    if (!(steps <= most_steps) && cli_given(&run->dt))
        cli_fail(CLI_USAGE, "--dt: \"%g\" makes more than 2^53 steps in %g s; it should be at least %g", run->dt,
                 run->duration, run->duration / most_steps);
    if (!(steps <= most_steps))
        cli_fail(CLI_USAGE, "a run of %g s takes more than 2^53 steps of %g s; it should be at most %g s",
                 run->duration, run->dt, run->dt * most_steps);
    run->steps = (uint64_t)steps;
}

void run_length_settle(run_length *run)
{
    const bool dt = cli_given(&run->dt), duration = cli_given(&run->duration), steps = cli_given(&run->steps);
    if (dt && duration && steps)
        cli_fail(CLI_USAGE, "--dt, --steps, --duration: two of them set the third; give two, not three");
    const bool by_steps = steps || (run->duration == 0 && run->steps > 0);
    const bool by_duration = by_steps && duration;
    if ((by_steps && !by_duration && run->dt == 0) || (!by_steps && (run->dt == 0 || run->duration == 0)))
        cli_fail(CLI_USAGE, "--dt, --steps, --duration: give two of them");
    if (!by_steps)
        count_steps(run);
    else if (by_duration)
        run->dt = run->duration / (double)run->steps;
    else
        run->duration = run->dt * (double)run->steps;
    if (!(run->dt > 0))
        cli_fail(CLI_USAGE, "--duration: \"%g\" in %" PRIu64 " steps makes each step 0; it should be larger",
                 run->duration, run->steps);
    if (!isfinite(run->duration) && dt)
        cli_fail(CLI_USAGE, "--dt: \"%g\" is too long for %" PRIu64 " steps; the duration should be finite", run->dt,
                 run->steps);
    if (!isfinite(run->duration))
        cli_fail(CLI_USAGE, "--steps: \"%" PRIu64 "\" is too many of %g s; the duration should be finite", run->steps,
                 run->dt);
}

void run_length_remark_end(const run_length *run)
{
    const double end = (double)run->steps * run->dt, rounding = 1e-9; /* of a number typed with ten digits */
    if (!(fabs(end - run->duration) <= rounding * run->duration))
        cli_warn("a duration of %.10g s is not a whole number of steps of %.10g s: the run takes %" PRIu64
                 " and ends at %.10g s",
                 run->duration, run->dt, run->steps, end);
}

void run_length_remark_step(double dt, double stable, spring_method m)
{
    if (stable == 0)
        cli_warn("no step of %s is stable here", spring_method_name(m));
    else if (!(dt < stable))
        cli_warn("the step of %g s is not below the stable step of %s here, %g s", dt, spring_method_name(m), stable);
}
