/* SPDX-License-Identifier: MIT */
/* A spring that follows a target: it reaches the target exactly, does not lag, and has an error within the bound stated
   in spring.h. Parameters from other conventions.
       test_follow [SPRINGS]     number of springs that must reach the target, default 2000 */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "harness/reference.h"

static const double two_pi = 6.283185307179586;

static unsigned long springs = 2000;
static reference ref;

/* Of the values of user interfaces: 0.02 to 50 Hz, damping ratio 0.1 to 10, a tenth of them critical or nearly so. */
static spring_params any_spring(double *omega, double *zeta)
{
    *omega = two_pi * random_log(0.02, 50);
    *zeta = random_bits() % 10 == 0 ? 1 + (double)(random_bits() % 3) * 1e-9 : random_log(0.1, 10);
    const double mass = random_bits() % 2 ? 1 : random_log(0.1, 10);
    return (spring_params){mass, mass * *omega * *omega, 2 * *zeta * mass * *omega, 0};
}

/* The decay rate of the slowest mode. */
static double slow_rate(double omega, double zeta)
{
    return omega * (zeta <= 1 ? zeta : 1 / (zeta + sqrt(zeta - 1) * sqrt(zeta + 1)));
}

/* Targets around powers of two are the difficult ones: x has a larger ulp on one side. */
static double any_target(void)
{
    if (random_bits() % 4 > 0)
        return random_uniform(-1000, 1000);
    double target = ldexp(random_bits() % 2 ? 1 : -1, (int)(random_bits() % 20) - 10);
    for (uint64_t ulps = random_bits() % 9; ulps > 0; ulps--)
        target = nextafter(target, ulps % 2 ? 0 : 2 * target);
    return target;
}

static double ulp_of(double a)
{
    return nextafter(fabs(a), INFINITY) - fabs(a);
}

/* How far from its target a spring may be that is placed on it. */
static double landing_distance(double ulp, double decay)
{
    return (1.125 * ulp + DBL_MIN) / fmax(fmin(1, decay), 0x1p-16);
}

/* Frames until the spring has landed, but not for more than 200 decay times. */
static void lands(void)
{
    for (unsigned long i = 0; i < springs; i++) {
        double omega, zeta;
        const spring_params p = any_spring(&omega, &zeta);
        const double dt = i % 3 == 0 ? 1.0 / 60 : i % 3 == 1 ? 1.0 / 240 : 1 / random_log(30, 240);
        const double target = any_target(), slow = slow_rate(omega, zeta);
        spring_state s = {random_uniform(-1000, 1000), random_uniform(-100, 100) * omega};
        double frames = 0;
        while (!(s.x == target && s.v == 0) && frames * dt * slow < 200) {
            if (spring_follow(&s, &p, target, 0, dt) != SPRING_OK)
                break;
            frames++;
        }
        CHECK(s.x == target && s.v == 0, "it lands within 200 decay times");
        spring_follow(&s, &p, target, 0, dt);
        CHECK(s.x == target && s.v == 0, "and stays");
    }
}

/* The rule as spring.h states it, from the motion about the target as spring_step_exact() gives it. Only where rounding
   might decide there is no check. */
static void lands_where_stated(void)
{
    int landed = 0;
    for (int i = 0; i < 200000; i++) {
        double omega, zeta;
        const spring_params p = any_spring(&omega, &zeta);
        const double decay = random_bits() % 4 ? random_log(1e-4, 1) : random_log(random_bits() % 2 ? 1e-18 : 1, 20);
        const double dt = decay / slow_rate(omega, zeta), target = any_target();
        const double size = landing_distance(ulp_of(target), decay) * exp(fmin(decay, 3)) * random_log(0.1, 10);
        spring_state s = {target + random_uniform(-1, 1) * size, random_uniform(-1, 1) * size * omega};
        spring_state about = {s.x - target, s.v};
        spring_step_exact(&about, &p, dt);
        spring_follow(&s, &p, target, 0, dt);
        const double x = target + about.x, ulp = fmax(ulp_of(x), ulp_of(target));
        const double distance = hypot(about.x, about.v / omega) / landing_distance(ulp, decay);
        const bool at_rest = s.x == target && s.v == 0;
        if (distance < 1 - 1e-6)
            CHECK(at_rest, "near enough to land");
        if (distance > 1 + 1e-6) {
            CHECK_BITS(s.x, x, "too far away to land");
            CHECK_BITS(s.v, about.v, "too far away to land");
        }
        landed += at_rest;
    }
    CHECK(landed > 50000 && landed < 150000, "both happen");
}

static void lands_at_zero(void)
{
    for (int i = 0; i < 300; i++) {
        double omega, zeta;
        const spring_params p = any_spring(&omega, &zeta);
        spring_state s = {1, 0};
        for (int j = 0; j < 30000 && (s.x != 0 || s.v != 0); j++) {
            spring_follow(&s, &p, 0, 0, 0.05 / slow_rate(omega, zeta));
            CHECK(s.x == 0 || hypot(s.x, s.v / omega) >= DBL_MIN, "it lands where numbers would become denormal");
        }
        CHECK(s.x == 0 && s.v == 0, "it lands");
    }
}

/* y'' = -omega^2 y - gamma y' in multiple precision, y and u formed there, and then the target and its velocity added. */
static void against_reference(void)
{
    mpfr_t rest, moved;
    mpfr_inits2(mpfr_get_prec(ref.x), rest, moved, (mpfr_ptr)NULL);
    for (int i = 0; i < 40000; i++) {
        double omega, zeta;
        spring_params p = any_spring(&omega, &zeta);
        const double shortest = i % 3 ? 1e-3 : 1e-18, target = any_target();
        const double dt = (i % 5 == 0 ? -0.3 : 1) * random_log(shortest, 30) / omega / fmax(1, zeta);
        const double velocity = i % 3 ? random_uniform(-100, 100) : 0;
        if (i % 4 == 0)
            p.load = p.stiffness * random_uniform(-100, 100);
        const double shift = p.load / p.stiffness, near = i % 7 ? 1000 : 1e-11;
        const spring_state start = {target + shift + near * random_uniform(-1, 1),
                                    velocity + near * random_uniform(-1, 1)};
        spring_state got = start;
        CHECK(spring_follow(&got, &p, target, velocity, dt) == SPRING_OK, "good input");

        mpfr_set_d(rest, p.load, MPFR_RNDN);
        mpfr_div_d(rest, rest, p.stiffness, MPFR_RNDN);
        mpfr_add_d(rest, rest, target, MPFR_RNDN);
        mpfr_set_d(moved, velocity, MPFR_RNDN);
        mpfr_mul_d(moved, moved, dt, MPFR_RNDN);
        p.load = 0;
        const spring_state about = {start.x - (target + shift - velocity * dt), start.v - velocity};
        reference_start(&ref, &p, about);
        mpfr_d_sub(ref.x, start.x, rest, MPFR_RNDN);
        mpfr_add(ref.x, ref.x, moved, MPFR_RNDN);
        mpfr_set_d(ref.v, start.v, MPFR_RNDN);
        mpfr_sub_d(ref.v, ref.v, velocity, MPFR_RNDN);
        reference_exact(&ref, &p, dt);
        mpfr_add(ref.x, ref.x, rest, MPFR_RNDN);
        mpfr_add_d(ref.v, ref.v, velocity, MPFR_RNDN);

        const double y = hypot(about.x, about.v / omega), moves = mpfr_get_d(ref.size, MPFR_RNDU);
        const double growth = y > 0 ? fmax(1, moves / y) : 1, to = target + shift;
        double bound = 4 * DBL_EPSILON * (1 + omega * fabs(dt) * fmax(1, zeta)) * moves + DBL_MIN * (1 + 1 / omega);
        bound += 2 * DBL_EPSILON * growth * (fabs(to) + fabs(shift) + fabs(velocity * dt) + fabs(velocity) / omega);
        if (got.x == to && got.v == velocity)
            bound += landing_distance(ulp_of(fmax(fabs(to), fabs(mpfr_get_d(ref.x, MPFR_RNDA)))),
                                      slow_rate(omega, zeta) * dt);
        CHECK_BELOW(reference_distance(&ref, got), bound, "the bound stated in spring.h");
    }
    mpfr_clears(rest, moved, (mpfr_ptr)NULL);
}

/* A step towards a target at rest. Returns the bound of its error, with 6 instead of 4 for the rounding of dt. */
static double follow(spring_state *s, const spring_params *p, double omega, double zeta, double target, double dt)
{
    const double size = hypot(s->x - target, s->v / omega);
    double bound = 6 * DBL_EPSILON * (1 + omega * dt * fmax(1, zeta)) * size + DBL_MIN * (1 + 1 / omega);
    bound += 2 * DBL_EPSILON * fabs(target);
    CHECK(spring_follow(s, p, target, 0, dt) == SPRING_OK, "good input");
    if (size > 0 && s->x == target && s->v == 0)
        bound += landing_distance(ulp_of(1.001 * target), slow_rate(omega, zeta) * dt);
    return bound;
}

/* Steps of any lengths agree with one step over the same time, to within the sum of the bounds. An error in (x, v/omega)
   does not grow, because energy does not. Frames add up with rounding errors, so that many runs end with a step as short
   as a rounding error. */
static void any_partition(void)
{
    static const double rates[] = {60, 240, 44100, 48000, 96000};
    int landed = 0;
    for (int i = 0; i < 7000; i++) {
        double omega, zeta;
        const spring_params p = any_spring(&omega, &zeta);
        const double target = any_target(), slow = slow_rate(omega, zeta);
        const double rate = i % 7 < 5 ? rates[i % 7] : 0;
        const double time = rate > 0 ? (double)(1 + random_bits() % 1000) / rate : random_log(0.01, 10) / slow;
        const double near = fmin(ulp_of(target) * exp(slow * time) * random_log(0.1, 1e12), 1000);
        const spring_state start = {target + near * random_uniform(-1, 1), near * omega * random_uniform(-1, 1)};
        spring_state one = start, s = start;
        double bound = follow(&one, &p, omega, zeta, target, time), t = 0;
        for (int j = 0; t < time; j++) {
            const double any = j < 100 ? time * random_log(1e-17, 1) : time;
            const double end = fmin(t + (rate > 0 ? 1 / rate : i % 7 == 5 ? time / 10 : any), time);
            bound += follow(&s, &p, omega, zeta, target, end - t);
            t = end;
        }
        CHECK_BELOW(hypot(s.x - one.x, (s.v - one.v) / omega), bound, "the sum of the bounds of all steps");
        landed += s.x == target && s.v == 0;
    }
    CHECK(landed > 500 && landed < 6500, "both happen");
}

/* Where steps are so short that rounding error may stop a spring before it lands. */
static void stops_near_the_target(void)
{
    for (int i = 0; i < 6; i++) {
        double omega, zeta;
        const spring_params p = any_spring(&omega, &zeta);
        const double decay = 0x1p-18 * random_uniform(0.9, 1), target = any_target();
        const double distance = 1.2 / decay * ulp_of(1.001 * target);
        spring_state s = {target + 2 * distance, 0};
        for (double n = 6 / decay; n > 0; n--)
            spring_follow(&s, &p, target, 0, decay / slow_rate(omega, zeta));
        CHECK_BELOW(hypot(s.x - target, s.v / omega), distance, "the distance in spring.h");
    }
}

/* A target at constant velocity, for 2 s, from the same start: frames of several lengths and of random length. */
static double after_two_seconds(const spring_params *p, double rate, double velocity)
{
    spring_state s = {0.3, -0.2};
    double t = 0;
    while (t < 2) {
        const double frame = rate > 0 ? 1 / rate : random_uniform(1.0 / 240, 1.0 / 20);
        const double end = fmin(t + frame, 2) > 2 - 1e-9 ? 2 : t + frame;
        spring_follow(&s, p, velocity * end, velocity, end - t);
        t = end;
    }
    return s.x;
}

static void follows_without_lag(void)
{
    for (int i = 0; i < 100; i++) {
        double omega, zeta;
        const spring_params p = any_spring(&omega, &zeta);
        const double velocity = random_uniform(-1, 1), want = after_two_seconds(&p, 60, velocity);
        const double rates[] = {30, 144, 0};
        for (int j = 0; j < 3; j++)
            CHECK_CLOSE(after_two_seconds(&p, rates[j], velocity), want, 1e-12, "independent of the frame rate");
        spring_state s = {5, velocity};
        double t = 0;
        for (int frame = 1; frame <= 600; frame++) {
            t = frame / 60.0;
            spring_follow(&s, &p, 5 + velocity * t, velocity, 1 / 60.0);
        }
        CHECK_CLOSE(s.x, 5 + velocity * t, 1e-12, "no lag");
        CHECK_CLOSE(s.v, velocity, 1e-12 * fmax(1, omega), "the velocity of the target");
    }
}

/* With the mean velocities of the target, which has the acceleration a, the spring lags by a (mass/stiffness - dt^2/12):
   between the ends of frames, the target that it follows is ahead by dt^2 a/12 on average. */
static void lags_behind_an_acceleration(void)
{
    const double accel = 3.7;
    for (double dt = 1. / 240; dt < 0.11; dt *= 2)
        for (double damping_ratio = 0.5; damping_ratio < 1.5; damping_ratio += 0.3) {
            const double mass = 1.3, omega = 4 * acos(-1), stiffness = mass * omega * omega;
            const spring_params p = {mass, stiffness, 2 * damping_ratio * omega * mass, 0};
            spring_state s = {0, 0};
            double before = 0, target = 0;
            for (int i = 1; i * dt < 4; i++, before = target) {
                target = accel * (i * dt) * (i * dt) / 2;
                CHECK(spring_follow(&s, &p, target, (target - before) / dt, dt) == SPRING_OK, "a step");
            }
            CHECK_CLOSE(target - s.x, accel * (mass / stiffness - dt * dt / 12), 0.02 * accel * mass / stiffness,
                        "about: it also responds to the harmonics of the frame rate");
        }
}

/* Undamped springs and steps backwards never land, not even a step from the target. */
static void lands_only_if_it_decays(void)
{
    const spring_params undamped = {1, 40, 0, 0}, damped = {1, 40, 6, 0};
    const spring_state start = {nextafter(3, 4), 0};
    spring_state s = start;
    for (int i = 0; i < 1000; i++)
        spring_follow(&s, &undamped, 3, 0, 1.0 / 60);
    CHECK(s.x != 3 || s.v != 0, "without damping it goes on");
    s = start;
    spring_follow(&s, &damped, 3, 0, -1.0 / 60);
    CHECK(s.v != 0, "backwards it moves away");
    s = (spring_state){3.5, 1};
    spring_follow(&s, &damped, 3, 0, 0.25);
    spring_follow(&s, &damped, 3, 0, -0.25);
    CHECK_CLOSE(s.x, 3.5, 1e-14, "there and back: rounding, grown by e^(3 0.25)");
    CHECK_CLOSE(s.v, 1, 1e-13, "there and back");
}

static void special_springs(void)
{
    const spring_params dragged = {2, 0, 6, 0}, pushed = {2, 0, 6, 3}, hanging = {2, 50, 6, -20},
                        soft = {1, 1e-300, 1, 1};
    spring_state s = {4, 7};
    spring_follow(&s, &dragged, 1e6, 2, 100);
    CHECK_CLOSE(s.x, 4 + 2 * 100 + 5 / 3.0, 1e-13, "without stiffness: a target velocity, and 5 m/s that decay at 3/s");
    CHECK_BITS(s.v, 2, "damped towards the velocity of the target alone");
    s = (spring_state){4, 2};
    spring_follow(&s, &pushed, -1e6, 2, 100);
    CHECK_CLOSE(s.v, 2.5, 4 * DBL_EPSILON, "load/damping faster than the target");
    CHECK_CLOSE(s.x, 4 + 2.5 * 100 - 0.5 / 3, 1e-13, "the time to get there");
    s = (spring_state){4, 2};
    for (int i = 0; i < 10000; i++)
        spring_follow(&s, &hanging, 9, 0, 1.0 / 60);
    CHECK_BITS(s.x, 9 - 20 / 50.0, "the rest position under load");
    CHECK_BITS(s.v, 0, "at rest");
    s = (spring_state){1, 2};
    CHECK(spring_follow(&s, &soft, 0, 0, 1) == SPRING_OK && isfinite(s.x), "a rest position of 1e300");
    s = (spring_state){nextafter(DBL_MAX, 0), 0};
    for (int i = 0; i < 1000; i++)
        spring_follow(&s, &hanging, DBL_MAX, 0, 0.1);
    CHECK_BITS(s.x, DBL_MAX, "the largest target");
}

static void bad_input_changes_nothing(void)
{
    const spring_params good = {1.3, 40, 2, 0.5};
    const double bad[] = {NAN, INFINITY, -INFINITY};
    const spring_params bad_params[] = {
        {0, 40, 2, 0},       {-1, 40, 2, 0},       {NAN, 40, 2, 0},    {INFINITY, 40, 2, 0}, {1, -40, 2, 0},
        {1, 40, -2, 0},      {1, NAN, 2, 0},       {1, 40, NAN, 0},    {1, 40, 2, NAN},      {1, 40, 2, INFINITY},
        {1e-300, 1e9, 2, 0}, {1e-300, 40, 1e9, 0}, {1e-300, 1, 1, 1e9}};
    const spring_state start = {0.3, -0.7};
    spring_state s = start;
    CHECK(spring_follow(NULL, &good, 1, 0, 0.1) == SPRING_EINVAL, "no state");
    CHECK(spring_follow(&s, NULL, 1, 0, 0.1) == SPRING_EINVAL, "no parameters");
    for (int i = 0; i < 3; i++) {
        CHECK(spring_follow(&s, &good, bad[i], 0, 0.1) == SPRING_EINVAL, "target");
        CHECK(spring_follow(&s, &good, 1, bad[i], 0.1) == SPRING_EINVAL, "target velocity");
        CHECK(spring_follow(&s, &good, 1, 0, bad[i]) == SPRING_EINVAL, "step");
        CHECK_STATE(s, start, "unchanged");
        spring_state x = {bad[i], 1}, v = {1, bad[i]};
        CHECK(spring_follow(&x, &good, 1, 0, 0.1) == SPRING_EINVAL, "state");
        CHECK(spring_follow(&v, &good, 1, 0, 0.1) == SPRING_EINVAL, "state");
        CHECK_STATE(x, ((spring_state){bad[i], 1}), "unchanged");
        CHECK_STATE(v, ((spring_state){1, bad[i]}), "unchanged");
    }
    for (size_t i = 0; i < sizeof bad_params / sizeof bad_params[0]; i++) {
        CHECK(spring_follow(&s, &bad_params[i], 1, 0, 0.1) == SPRING_EINVAL, "parameters");
        CHECK(spring_follow(&s, &bad_params[i], 1, 0, 0) == SPRING_EINVAL, "parameters, and no step");
        CHECK_STATE(s, start, "unchanged");
    }
    const spring_params growing = {1, 1, 9, 0};
    CHECK(spring_follow(&s, &growing, 1, 0, -1e3) == SPRING_ENONFINITE, "e^8888 is beyond doubles");
    CHECK(spring_follow(&s, &good, 1, 1e300, 1e200) == SPRING_ENONFINITE, "a target from beyond doubles");
    CHECK_STATE(s, start, "unchanged");
}

/* ---------------------------------------------------------------------------------------------------- parameters */

static void check_params(spring_params p, double stiffness, double damping, double error)
{
    CHECK_BITS(p.mass, 1, "1 kg");
    CHECK_BITS(p.load, 0, "no load");
    CHECK_CLOSE(p.stiffness, stiffness, error * stiffness, "stiffness");
    CHECK_CLOSE(p.damping, damping, error * damping, "damping");
}

/* Computed independently, with 15 digits where the error is 1e-12. */
static void parameters_of_swiftui(void)
{
    check_params(spring_params_response(0.5, 0.75), 157.913670417430, 18.8495559215388, 1e-12);
    check_params(spring_params_response(0.3, 0.7), 438.649084492860, 29.3215314335047, 1e-12);
    check_params(spring_params_bounce(0.5, 0.25), 157.913670417430, 18.8495559215388, 1e-12);
    check_params(spring_params_bounce(0.5, -0.3), 157.913670417430, 2 * two_pi / 0.5 / 0.7, 1e-12);
    check_params(spring_params_bounce(0.5, 1), 157.913670417430, 0, 1e-12);
    check_params(spring_params_bounce(0.5, 0), 157.913670417430, 2 * two_pi / 0.5, 1e-12);
}

static void parameters_by_settling_time(void)
{
    check_params(spring_params_settling(0.4, 1, 0.001), 9.23341 / 0.4 * 9.23341 / 0.4, 2 * 9.23341 / 0.4, 1e-6);
    for (int i = 0; i < 2000; i++) {
        const double time = random_log(1e-3, 1e3), zeta = i % 10 ? random_log(0.05, 5) : 1, tol = random_log(1e-6, 0.5);
        const spring_params p = spring_params_settling(time, zeta, tol);
        const spring_state released = {1, 0};
        CHECK_CLOSE(spring_settling_time(&released, &p, tol), time, 1e-9 * time, "the settling time asked for");
        CHECK_CLOSE(p.damping, 2 * zeta * sqrt(p.stiffness), 1e-14 * p.damping, "the damping ratio asked for");
    }
}

static void bad_parameters_are_nan(void)
{
    const spring_params bad[] = {
        spring_params_response(0, 1),           spring_params_response(-1, 1),
        spring_params_response(NAN, 1),         spring_params_response(INFINITY, 1),
        spring_params_response(1, -0.1),        spring_params_response(1, NAN),
        spring_params_response(1, INFINITY),    spring_params_response(1e-200, 1),
        spring_params_response(1e200, 1),       spring_params_bounce(0, 0),
        spring_params_bounce(INFINITY, 0),      spring_params_bounce(1, -1),
        spring_params_bounce(1, 1.01),          spring_params_bounce(1, NAN),
        spring_params_settling(0, 1, 0.1),      spring_params_settling(NAN, 1, 0.1),
        spring_params_settling(1, 0, 0.1),      spring_params_settling(1, NAN, 0.1),
        spring_params_settling(1, -1, 0.1),     spring_params_settling(1, 1, 0),
        spring_params_settling(1, 1, 1),        spring_params_settling(1, 1, NAN),
        spring_params_settling(1e-200, 1, 0.1), spring_params_settling(1, INFINITY, 0.1),
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        const spring_params p = bad[i];
        CHECK(isnan(p.mass) && isnan(p.stiffness) && isnan(p.damping) && isnan(p.load), "NaN in all fields");
    }
}

int main(int argc, char **argv)
{
    static const test tests[] = {
        {"lands where spring.h says", lands_where_stated},
        {"lands at zero", lands_at_zero},
        {"against multiple precision", against_reference},
        {"any partition", any_partition},
        {"stops near the target", stops_near_the_target},
        {"follows without lag", follows_without_lag},
        {"lags behind an acceleration", lags_behind_an_acceleration},
        {"lands only if it decays", lands_only_if_it_decays},
        {"special springs", special_springs},
        {"bad input", bad_input_changes_nothing},
        {"parameters of SwiftUI", parameters_of_swiftui},
        {"parameters by settling time", parameters_by_settling_time},
        {"bad parameters", bad_parameters_are_nan},
        {"lands", lands},
    };
    if (argc == 2)
        springs = strtoul(argv[1], NULL, 10);
    reference_init(&ref);
    const int status = RUN_TESTS("follow", tests);
    reference_clear(&ref);
    mpfr_free_cache();
    return status;
}
