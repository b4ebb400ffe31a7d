/* SPDX-License-Identifier: MIT */
/* The accurate step and the error of a step, against runs in multiple precision that know nothing of their formulas. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "harness/reference.h"
#include "test_methods.h"

/* A spring, and a time to watch it. */
typedef struct watched {
    spring_params p;
    double duration; /* [s] */
} watched;

/* mass is a power of two, so the library works from the same k/m and c/m as the reference, to the last bit. */
static watched watched_of(double omega, double zeta, double turns)
{
    const double mass = ldexp(1, (int)random_uniform(-4, 5));
    return (watched){{mass, mass * omega * omega, 2 * zeta * mass * omega, 0.7}, turns / omega};
}

/* omega t in [rad]: the runs of heavily damped springs are sampled finely enough for the fast root. */
static watched undamped(void)
{
    return watched_of(random_log(1e-3, 1e3), 0, random_log(1, 1500));
}

static watched lightly_damped(void)
{
    return watched_of(random_log(1e-3, 1e3), random_log(1e-4, 0.1), random_log(1, 1500));
}

static watched damped(void)
{
    return watched_of(random_log(1e-3, 1e3), random_uniform(0.1, 0.98), random_log(1, 300));
}

static watched critical(void)
{
    const double off = random_bits() % 4 == 0 ? 0 : random_log(1e-16, 0.02);
    return watched_of(random_log(1e-3, 1e3), random_bits() % 2 ? 1 + off : 1 - off, random_log(1, 300));
}

static watched heavily_damped(void)
{
    const double zeta = random_log(1.02, 150);
    return watched_of(random_log(1e-3, 1e3), zeta, random_log(0.01, 1000 / zeta));
}

static watched slow(void)
{
    return watched_of(random_log(1e-3, 1e3), random_bits() % 2 ? random_log(1e-3, 100) : 0, random_log(1e-5, 1));
}

static watched without_stiffness(void)
{
    const double g = random_log(1e-3, 1e3);
    return (watched){{0.5, 0, 0.5 * g, 0.7}, random_log(1e-3, 300) / g};
}

static const struct regime {
    const char *name;
    watched (*make)(void);
} regimes[] = {{"undamped", undamped},   {"light", lightly_damped}, {"damped", damped},          {"critical", critical},
               {"heavy", heavily_damped}, {"slow", slow},            {"no stiffness", without_stiffness}};

enum { REGIMES = sizeof regimes / sizeof regimes[0], SPRINGS = 300 };

/* The measured error of n steps. More than 2^17 of them are sampled, a hundred times in the shortest time scale: what is
   missed of a maximum is at most 5e-4 of it. */
static double measured(const watched *w, spring_method m, double n)
{
    const double omega = sqrt(w->p.stiffness / w->p.mass), g = w->p.damping / w->p.mass;
    const double scales = fmax(1, fmax(omega, g) * w->duration);
    const double stride = n <= 0x1p17 ? 1 : fmax(1, floor(n / (100 * scales)));
    return reference_worst_error(&w->p, m, fmax(omega, 1 / w->duration), w->duration / n, (uint64_t)n,
                                 (uint64_t)stride);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Least, median and greatest, as a comment of the test's output. */
static double report(const char *what, const char *regime, const char *method, double *value, int count)
{
    if (count == 0)
        return NAN;
    qsort(value, (size_t)count, sizeof *value, ascending);
    printf("# %s, %s, %s: %d, %.5f ... %.5f ... %.5f\n", what, regime, method, count, value[0], value[count / 2],
           value[count - 1]);
    return value[count / 2];
}

/* The tolerances of one regime and method. */
static void against_runs_of(const struct regime *r, spring_method m)
{
    static double used[SPRINGS], predicted[SPRINGS];
    int runs = 0;
    for (int i = 0; i < SPRINGS; i++) {
        const watched w = r->make();
        const double tolerance = random_log(1e-12, 1e-1);
        const double step = spring_accurate_step(&w.p, m, w.duration, tolerance);
        CHECK(step >= 0 && step <= w.duration, "at least one step");
        if (step == 0)
            continue;
        const double n = rint(w.duration / step);
        CHECK_BITS(step, w.duration / n, "a whole number of steps");
        const double error = measured(&w, m, n), known = spring_step_error(&w.p, m, w.duration, step);
        CHECK(error <= 1.001 * tolerance, "accurate enough");
        if (error == 0)
            continue;
        CHECK(known >= 0.999 * error && known <= 1.05 * error, "as accurate as was said");
        if (!(known >= 0.999 * error && known <= 1.05 * error) || error > 1.001 * tolerance)
            printf("# %s %s: k %.17g c %.17g m %g T %.17g tol %g n %.17g error %g known %g\n", r->name, spring_method_name(m), w.p.stiffness, w.p.damping, w.p.mass, w.duration, tolerance, n, error, known);
        predicted[runs] = known / error;
        used[runs++] = n > 1 ? error / tolerance : 1;
    }
    const double median = report("error/tolerance", r->name, spring_method_name(m), used, runs);
    CHECK(!(median < 0.9), "no shorter than need be");
    report("predicted/measured", r->name, spring_method_name(m), predicted, runs);
}

static void against_runs(void)
{
    for (size_t i = 0; i < REGIMES; i++)
        for (const spring_method *m = steppers(); *m != no_method; m++)
            against_runs_of(&regimes[i], *m);
}

int main(void)
{
    static const test tests[] = {
        {"against runs in multiple precision", against_runs},
    };
    return RUN_TESTS("accurate_step", tests);
}
