/* SPDX-License-Identifier: MIT */
/*
 * spring-energy: the error in the energy of an undamped spring after 1, 10, 100 ... seconds.
 *
 * The spring has mass 1 kg and stiffness 1 N/m and starts at rest from x = 1 m, with the energy 1/2 J.
 */
#include <math.h>
#include <stddef.h>

#include <springstep/spring.h>

#include "common/cli.h"
#include "scenes/random.h"
#include "common/stepper.h"

static const spring_params spring = {.mass = 1, .stiffness = 1};
static const spring_state start = {.x = 1, .v = 0};

static stepper chosen;
static run_length length = {.dt = 0.01, .duration = 1e8};
static bool half_step_velocity, jitter;

static const cli_option options[] = {
    {"method", CLI_METHOD, .choice = &chosen.method, .offers = cli_for_springs, .required = true, .value = "M"},
    {"dt", CLI_POSITIVE, .real = &length.dt, .value = "DT", .help = "step [s]"},
    {"duration", CLI_POSITIVE, .real = &length.duration, .value = "H",
     .help = "print a row for each power of ten from 1 s to H [s]"},
    {"steps", CLI_COUNT, .count = &length.steps, .least = 1, .most = CLI_MOST_STEPS, .value = "N",
     .help = "number of steps; two of DT, N and H set the third"},
    {"half-step-velocity", CLI_FLAG, .flag = &half_step_velocity,
     .help = "leapfrog only: compute the kinetic energy half a step ahead\n"
             "It uses the velocity at t + dt/2 and the position at t."},
    {"jitter", CLI_FLAG, .flag = &jitter, .help = "random steps from DT/2 to 3 DT/2, the same in every run"},
    {"arithmetic", CLI_CHOICE, .choice = &chosen.arithmetic, .choices = stepper_arithmetics, .value = "A",
     .help = "library, or stages (rk4 only: computes k1 to k4)"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-energy",
    .summary = "Measure the energy error of an undamped spring after 1, 10, 100 ... seconds.",
    .details = "The spring has a mass of 1 kg and a stiffness of 1 N/m, and starts at rest from x = 1 m. Its energy\n"
               "is 1/2 J.\n\n"
               "All steps are computed. H = 1e8 s takes 1e10 steps, which is one to three minutes. Progress is shown\n"
               "on a terminal.\n\n"
               "With --method exact, one evaluation covers the steps from one row to the next, at most 2^24 steps.\n"
               "With --jitter, the simulated time equals the duration only on average.\n\n"
               "A warning is printed if the step is not below the stable step. With --jitter, this is the longest\n"
               "step.",
    .columns = "method velocity duration_s steps energy_error_J",
    .meaning = "velocity is synchronised, or half_step_ahead with --half-step-velocity. duration_s is steps times\n"
               "DT, where steps is the whole number nearest to the power of ten, at least 1. energy_error_J is |E -\n"
               "1/2 J|. If the energy overflows, the error is inf and the exit status is 0.",
    .shown = {"duration_s", "energy_error_J"},
    .examples = {"--method leapfrog --duration 1e5", "--method leapfrog --duration 1e4 --half-step-velocity",
                 "--method rk4 --dt 0.1 --steps 1e6 -o energy.tsv"},
    .options = options,
};

static double energy_error(spring_state s)
{
    if (half_step_velocity)
        s.v -= length.dt / 2 * s.x; /* the first kick of the next step */
    return fabs(spring_energy(&s, &spring) - spring_energy(&start, &spring));
}

static bool advance(spring_state *s, uint64_t n)
{
    static uint64_t state = 0;
    if (!jitter)
        return stepper_advance(&chosen, s, &spring, length.dt, n) == SPRING_OK;
    bool finite = true;
    for (; finite && n > 0; n--)
        finite = stepper_advance(&chosen, s, &spring, length.dt * (0.5 + random_unit(&state)), 1) == SPRING_OK;
    return finite;
}

static uint64_t steps_to(double t)
{
    return (uint64_t)fmax(rint(t / length.dt), 1);
}

static uint64_t steps_to_last_row(void)
{
    double H = 1;
    while (H * 10 <= length.duration)
        H *= 10;
    return steps_to(H);
}

static void write_energies(cli_table *table)
{
    spring_state s = start;
    uint64_t step = 0;
    const uint64_t last = steps_to_last_row();
    bool finite = true;
    for (double H = 1; H <= length.duration; H *= 10) {
        const uint64_t steps = steps_to(H);
        while (finite && step < steps) {
            const uint64_t left = steps - step, n = left < stepper_leap ? left : stepper_leap;
            finite = advance(&s, n);
            step += n;
            cli_progress((double)step / (double)last);
        }
        cli_row(table, "%s\t%s\t%.17g\t%" PRIu64 "\t%.17g", stepper_name(&chosen),
                half_step_velocity ? "half_step_ahead" : "synchronised", (double)steps * length.dt, steps,
                finite ? energy_error(s) : INFINITY);
    }
}

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    stepper_check(&chosen);
    if (half_step_velocity && chosen.method != SPRING_LEAPFROG)
        cli_fail(CLI_USAGE, "--half-step-velocity: --method is %s, but it should be leapfrog", stepper_name(&chosen));
    run_length_settle(&length);
    if (!(length.duration >= 1))
        cli_fail(CLI_USAGE, "--duration: \"%g\" is not a time of at least 1 s", length.duration);

    cli_table *table = cli_open_output();
    stepper_comment(&chosen, table);
    cli_columns(table, program.columns);
    stepper_remark(&chosen, &spring, (jitter ? 1.5 : 1) * length.dt); /* the longest random step */
    write_energies(table);
    cli_finish();
    return 0;
}
