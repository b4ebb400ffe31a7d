/* SPDX-License-Identifier: MIT */
/* The accurate step and the error of a step, compared with runs in multiple precision that do not use the formulas. */
#include <float.h>
#include <math.h>

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

/* Damping ratios and omega t [rad] of springs with stiffness. The runs of heavily damped springs are sampled finely enough
   for the fast root. */
static const struct regime {
    double least_zeta, most_zeta, shortest, longest;
} regimes[] = {{0, 0, 1, 1500},      {1e-4, 0.1, 1, 1500}, {0.1, 0.98, 1, 300}, {0.98, 1.02, 1, 300},
               {1.02, 3, 0.01, 300}, {3, 150, 0.01, 7},    {0, 0, 1e-5, 1},     {1e-3, 100, 1e-5, 1}};

/* The last regime has no stiffness, and one in eight of those around critical damping is nearly critical. */
static watched any_of(size_t regime)
{
    if (regime == sizeof regimes / sizeof regimes[0]) {
        const double g = random_log(1e-3, 1e3);
        return (watched){{0.5, 0, 0.5 * g, 0.7}, random_log(1e-3, 300) / g};
    }
    const struct regime *r = &regimes[regime];
    const bool critical = r->least_zeta < 1 && r->most_zeta > 1 && random_bits() % 8 == 0;
    const double zeta = critical ? 1 + random_log(1e-16, 0.02) : random_uniform(r->least_zeta, r->most_zeta);
    return watched_of(random_log(1e-3, 1e3), zeta, random_log(r->shortest, r->longest));
}

enum { REGIMES = sizeof regimes / sizeof regimes[0] + 1, SPRINGS = 100 };

/* The measured error of n steps. More than 2^14 of them are sampled, a hundred times in the shortest time scale: what is
   missed of a maximum is at most 5e-4 of it. */
static double measured(const watched *w, spring_method m, double n)
{
    const double omega = sqrt(w->p.stiffness / w->p.mass), g = w->p.damping / w->p.mass;
    const double scales = fmax(1, fmax(omega, g) * w->duration);
    const double stride = n <= 0x1p14 ? 1 : fmax(1, floor(n / (100 * scales)));
    return reference_worst_error(&w->p, m, fmax(omega, 1 / w->duration), w->duration / n, (uint64_t)n,
                                 (uint64_t)stride);
}

static void check_known(double known, double error)
{
    CHECK(known >= 0.999 * error && known <= 1.05 * error, "as large as it is");
}

/* Is the largest number of steps whose rounding, sqrt(n) eps, is within the tolerance still not enough? */
static bool rounding_forbids(const watched *w, spring_method m, double tolerance)
{
    const double most = floor(fmin(tolerance * tolerance / (DBL_EPSILON * DBL_EPSILON), 0x1p53));
    return !(spring_step_error(&w->p, m, w->duration, w->duration / most) <= tolerance);
}

static void against_runs(void)
{
    for (size_t i = 0; i < REGIMES * SPRINGS; i++)
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const watched w = any_of(i % REGIMES);
            const double tolerance = random_log(1e-12, 1e-1);
            const double step = spring_accurate_step(&w.p, *m, w.duration, tolerance);
            CHECK(step >= 0 && step <= w.duration, "at least one step");
            if (step == 0) {
                CHECK(rounding_forbids(&w, *m, tolerance), "no step is accurate enough");
                continue;
            }
            const double n = rint(w.duration / step);
            CHECK_BITS(step, w.duration / n, "a whole number of steps");
            const double error = measured(&w, *m, n), known = spring_step_error(&w.p, *m, w.duration, step);
            CHECK(error <= 1.001 * tolerance, "accurate enough");
            CHECK(n < 100 || error > 0.9 * tolerance, "one step less would be too few");
            if (error > 0)
                check_known(known, error);
        }
}

/* Steps of any length that nobody has asked for, unless they are useless. */
static void errors_of_any_step(void)
{
    for (int i = 0; i < 1400; i++)
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const watched w = any_of((size_t)i % REGIMES);
            const double n = floor(random_log(1, 20000)),
                         known = spring_step_error(&w.p, *m, w.duration, w.duration / n);
            const double error = measured(&w, *m, n), useless = 0.5;
            if (error < useless)
                check_known(known, error);
            else
                CHECK(known > useless * 0.999, "large");
        }
}

/* Of many steps few are looked at: the largest error lies between them. A thousandth of 2 to 30 rad apart, parabolas know a
   maximum to (2 omega t)^3/15.6, as norms oscillate twice a period, and steps come as near to it. */
static void maxima_between_samples(void)
{
    const double n = 16000;
    for (int i = 0; i < 30; i++) {
        const double turns = random_uniform(2, 30);
        const watched w = watched_of(random_log(1e-3, 1e3), i % 2 * random_log(1e-3, 0.3), turns);
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const double error = measured(&w, *m, n), bound = pow(2 * turns / 1000, 3) / 15.6;
            CHECK_CLOSE(spring_step_error(&w.p, *m, w.duration, w.duration / n), error, bound * error, "a parabola");
        }
    }
}

/* The largest error of symplectic Euler without damping comes twice a period. In runs that end shortly after it, it lies in
   the last interval between samples. */
static void maxima_in_the_last_interval(void)
{
    for (int i = 0; i < 40; i++) {
        const watched w = watched_of(random_log(1e-3, 1e3), 0, 105 + 0.02 * i); /* a quarter of the oscillation */
        const double n = 19472;
        check_known(spring_step_error(&w.p, SPRING_SYMPLECTIC_EULER, w.duration, w.duration / n),
                    measured(&w, SPRING_SYMPLECTIC_EULER, n));
    }
}

/* Just below the stable step of a method without dissipation, by less than damping_ratio^2/2 of it, the roots of a step are
   real, negative and all but equal: it does not turn with the spring, and errors of hundreds come before they decay. */
static void steps_that_do_not_turn(void)
{
    for (int i = 0; i < 20; i++) {
        const double zeta = random_log(1e-3, 3e-3);
        const watched w = watched_of(random_log(1e-3, 1e3), zeta, 10000);
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            if (!spring_method_describe(*m)->symplectic)
                continue;
            const double step = (1 - 0.1 * zeta * zeta) * spring_stable_step(&w.p, *m), n = floor(w.duration / step);
            const double error = measured(&(watched){w.p, n * step}, *m, n),
                         known = spring_step_error(&w.p, *m, n * step, step);
            check_known(known, error);
        }
    }
}

/* Euler's steps, a little longer than the stable step of 2 damping_ratio/omega, grow while the spring decays. */
static void steps_that_grow(void)
{
    for (int i = 0; i < 20; i++) {
        const double zeta = random_uniform(0.08, 0.12), z = zeta * random_uniform(2.04, 2.1);
        const double n = floor(random_uniform(1, 4) / (z * z / 2 - zeta * z));
        const watched w = watched_of(random_log(1e-3, 1e3), zeta, n * z);
        const double error = measured(&w, SPRING_EULER, n),
                     known = spring_step_error(&w.p, SPRING_EULER, w.duration, w.duration / n);
        CHECK(known >= 0.99 * error && known <= 1.3 * error, "an estimate, since these errors are far above 0.5");
    }
}

/* The tolerance holds for every larger number of steps, and not for one less, or 1/4000 fewer of many. With heavy
   damping symplectic Euler is better at coarse steps than at finer ones: |1/(1 + G) - e^-G| is largest, 0.2036, at
   G = 2.51. */
static void least_number_of_steps(void)
{
    const double hump = 0.2036;
    for (int i = 0; i < 1200; i++)
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const watched w = any_of((size_t)i % REGIMES);
            const double tolerance = random_bits() % 2 ? random_log(1e-6, 3) : hump * random_uniform(0.8, 1.01);
            const double step = spring_accurate_step(&w.p, *m, w.duration, tolerance), n = rint(w.duration / step);
            if (step == 0) {
                CHECK(rounding_forbids(&w, *m, tolerance), "no step is accurate enough");
                continue;
            }
            CHECK(spring_step_error(&w.p, *m, w.duration, step) <= tolerance, "enough");
            const double fewer = n - fmax(1, floor(n / 4000));
            CHECK(n == 1 || spring_step_error(&w.p, *m, w.duration, w.duration / fewer) > tolerance,
                  "no more than enough");
            for (int more = 0; more < 10; more++) {
                const double finer = w.duration / ceil(n * random_log(1, 30));
                const double beyond = tolerance <= 1 ? 1.001 : 1.01; /* as spring.h says */
                CHECK(spring_step_error(&w.p, *m, w.duration, finer) <= tolerance * beyond, "and so are finer steps");
            }
        }
}

/* A few springs whose error can be written down. */
static void known_errors(void)
{
    const spring_params undamped = {1.3, 2.7, 0, 0.4}, free_mass = {1.3, 0, 0, 0.4}, dragged = {1.3, 0, 0.6, 0.4};
    const double omega = sqrt(2.7 / 1.3), g = 0.6 / 1.3, turn = 4;
    for (double n = 400; n < 1e12; n *= 10) {
        const double z = turn / n; /* |(1 + i z)^n - e^(i z n)|: (1 + i z)^n grows, and its angle n atan(z) is behind */
        const double growth = n / 2 * log1p(z * z), behind = n * z * z * z * (1.0 / 3 - z * z / 5);
        const double want = hypot(expm1(growth), 2 * exp(growth / 2) * sin(behind / 2));
        CHECK_CLOSE(spring_step_error(&undamped, SPRING_EULER, turn / omega, z / omega), want, 1e-9 * want,
                    "Euler; what is left out of the angle is n z^7/7");
        const double lost = expm1(-z) + z;
        CHECK_CLOSE(spring_step_error(&dragged, SPRING_EULER, z / g, z / g), hypot(lost, lost / z), 1e-12,
                    "one step of drag: x/(Omega duration) and v, Omega = 1/duration");
    }
    for (const spring_method *m = steppers(); *m != no_method; m++) {
        CHECK_BITS(spring_step_error(&free_mass, *m, 17, 0.3), 0, "every method is exact without a force");
        CHECK_BITS(spring_accurate_step(&free_mass, *m, 17, 1e-9), 17, "one step");
        CHECK(spring_step_error(&undamped, *m, 1, 0x1p-52) < 1e-12, "2^52 steps");
        CHECK_BITS(spring_step_error(&undamped, *m, 1, 0x1p-53 / 1.5), INFINITY, "more steps than are counted");
        double longest = 1; /* of which 2^53 steps are not limited by rounding */
        while (spring_step_error(&undamped, *m, longest, 0x1p-53 * longest) < 1e-6)
            longest *= 2;
        const double limit = spring_step_error(&undamped, *m, longest, 0x1p-53 * longest);
        CHECK_BITS(spring_accurate_step(&undamped, *m, longest, limit), 0x1p-53 * longest, "2^53 steps are enough");
        CHECK_BITS(spring_accurate_step(&undamped, *m, longest, 0.999 * limit), 0, "more than 2^53 are not counted");
        CHECK_BITS(spring_step_error(&undamped, *m, longest, 0x1p-53 * longest * (1 - 1e-15)), INFINITY,
                   "more than 2^53 steps");
        spring_params loaded = undamped;
        loaded.load = -3;
        CHECK_BITS(spring_accurate_step(&undamped, *m, 17, 1e-4), spring_accurate_step(&loaded, *m, 17, 1e-4),
                   "a load shifts the origin");
        const double h = 17.0 / 300;
        const double error = spring_step_error(&undamped, *m, 17, h);
        CHECK_CLOSE(spring_step_error(&undamped, *m, 17 + h / 2, h), error, 1e-13 * error, "steps that end in time");
        const double coarse = 17.0 / 25; /* 17 over it is less than 25 when it is rounded */
        CHECK_BITS(spring_step_error(&undamped, *m, 17, coarse),
                   spring_step_error(&undamped, *m, 17 + coarse / 2, coarse), "a quotient that is rounded down");
        CHECK(spring_accurate_step(&undamped, *m, 17, 1e-17) == 0, "rounding");
        CHECK(spring_accurate_step(&undamped, *m, 1e30, 1e-3) == 0, "rounding of very many steps");
    }
    CHECK_BITS(spring_accurate_step(&undamped, SPRING_EXACT, 17, 1e-12), 17, "the exact solution");
    CHECK_BITS(spring_step_error(&undamped, SPRING_EXACT, 17, 0.1), 0, "the exact solution");
    CHECK_BITS(spring_step_error(&undamped, SPRING_EULER, 1e6, 10), INFINITY, "overflows");
    CHECK_BITS(spring_step_error(&undamped, SPRING_RK4, 1e6, 5), INFINITY, "overflows");
}

/* w and g, time and duration in other units: the same numbers, to rounding. */
static void units(void)
{
    const spring_params p = {1, 2.7, 0.3, 0}, fast = {1, ldexp(2.7, 400), ldexp(0.3, 200), 0};
    const spring_params faint = {1, ldexp(2.7, -400), ldexp(0.3, -200), 0};
    for (const spring_method *m = steppers(); *m != no_method; m++) {
        const double step = spring_accurate_step(&p, *m, 40, 1e-5);
        CHECK_BITS(spring_accurate_step(&fast, *m, ldexp(40, -200), 1e-5), ldexp(step, -200), "powers of two");
        CHECK_BITS(spring_accurate_step(&faint, *m, ldexp(40, 200), 1e-5), ldexp(step, 200), "powers of two");
    }
}

/* Numbers at the ends of what there is: an answer, and no endless search. */
static void extreme_numbers(void)
{
    static const double ends[] = {0, 5e-324, 1e-150, 1e-8, 0.9, 1e150, 1.7e308};
    enum { ENDS = sizeof ends / sizeof ends[0] };
    for (int k = 0; k < ENDS; k++)
        for (int c = 0; c < ENDS; c++)
            for (int t = 1; t < ENDS; t++)
                for (int e = 1; e < ENDS; e++)
                    for (const spring_method *m = steppers(); *m != no_method; m++) {
                        const spring_params p = {1, ends[k], ends[c], 0};
                        const double step = spring_accurate_step(&p, *m, ends[t], ends[e]);
                        CHECK(step >= 0 && step <= ends[t], "a step");
                        CHECK(spring_step_error(&p, *m, ends[t], ends[e]) >= 0, "an error");
                    }
}

static void bad_input(void)
{
    const spring_params good = {1.3, 2.7, 0.6, 0.4}, bad = {-1.3, 2.7, 0.6, 0.4};
    static const double not_positive[] = {0, -1, NAN, INFINITY, -INFINITY};
    double (*const ask[])(const spring_params *, spring_method, double, double) = {spring_accurate_step,
                                                                                   spring_step_error};
    for (int f = 0; f < 2; f++) {
        CHECK(ask[f](&good, SPRING_RK4, 1, 0.1) > 0, "good input");
        CHECK(isnan(ask[f](NULL, SPRING_RK4, 1, 0.1)), "no parameters");
        CHECK(isnan(ask[f](&bad, SPRING_RK4, 1, 0.1)), "negative mass");
        CHECK(isnan(ask[f](&good, no_method, 1, 0.1)), "no such method");
        CHECK(isnan(ask[f](&good, (spring_method)-1, 1, 0.1)), "no such method");
        for (int i = 0; i < 5; i++)
            for (const spring_method *m = spring_methods(); *m != no_method; m++) {
                CHECK(isnan(ask[f](&good, *m, not_positive[i], 0.1)), "a duration that is not positive");
                CHECK(isnan(ask[f](&good, *m, 1, not_positive[i])), "a tolerance or step that is not positive");
            }
        for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
            const spring_method m = spring_method_at(place);
            CHECK(isnan(ask[f](&good, m, 1, 0.1)) == !spring_method_describe(m)->springs, "a method for scenes alone");
        }
    }
}

int main(void)
{
    static const test tests[] = {
        {"known errors", known_errors},
        {"bad input", bad_input},
        {"other units", units},
        {"the least number of steps", least_number_of_steps},
        {"maxima between samples", maxima_between_samples},
        {"maxima in the last interval", maxima_in_the_last_interval},
        {"steps that do not turn", steps_that_do_not_turn},
        {"steps that grow", steps_that_grow},
        {"extreme numbers", extreme_numbers},
        {"errors of any step", errors_of_any_step},
        {"against runs in multiple precision", against_runs},
    };
    return RUN_TESTS("accurate_step", tests);
}
