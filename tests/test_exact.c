/* SPDX-License-Identifier: MIT */
/* The exact solution against multiple precision, to the bound that spring.h states. */
#include <math.h>

#include "check.h"
#include "harness/reference.h"

static const double pi = 3.141592653589793;

static reference ref;

/* 4 eps (1 + omega t max(1, zeta)) |Phi| |(x, v/omega)| + DBL_MIN; the products in MPFR, since |Phi| may underflow. */
static double stated_bound(const spring_params *p, double t)
{
    const double omega = sqrt(p->stiffness / p->mass);
    const double zeta = p->damping / (2 * sqrt(p->stiffness) * sqrt(p->mass));
    mpfr_mul_d(ref.size, ref.size, 4 * DBL_EPSILON * (1 + omega * fabs(t) * fmax(1, zeta)), MPFR_RNDN);
    return mpfr_get_d(ref.size, MPFR_RNDU) + DBL_MIN;
}

static void against_reference(spring_params p, spring_state start, double t)
{
    spring_state got = start;
    spring_step_exact(&got, &p, t);
    reference_start(&ref, &p, start);
    reference_exact(&ref, &p, t);
    CHECK_BELOW(reference_distance(&ref, got), stated_bound(&p, t), "the bound stated in spring.h");
}

/* Masses, stiffnesses and times of all sizes at one damping ratio; starts anywhere, along the fast root, and huge. */
static void at_damping_ratio(double zeta, int draws)
{
    for (int i = 0; i < draws; i++) {
        spring_params p = {.mass = random_log(1e-6, 1e6), .stiffness = random_log(1e-6, 1e6)};
        const double omega = sqrt(p.stiffness / p.mass), angle = random_uniform(0, 2 * pi);
        p.damping = 2 * zeta * sqrt(p.stiffness * p.mass);
        spring_state start = {cos(angle), omega * sin(angle)};
        if (i % 4 == 1 && zeta > 1)
            start.v = -omega * (zeta + sqrt(zeta * zeta - 1)) * start.x;
        const double size = i % 4 == 2 ? random_log(1e-290, 1e290) : 1;
        start = (spring_state){start.x * size, start.v * size};
        against_reference(p, start, 2 * pi / omega * random_log(1e-9, 1e3));
    }
}

static void undamped(void)
{
    at_damping_ratio(0, 4000);
}

static void all_damping_ratios(void)
{
    for (double zeta = 1e-4; zeta < 1.1e4; zeta *= 1.3)
        at_damping_ratio(zeta, 400);
}

static void around_critical(void)
{
    at_damping_ratio(1, 2000);
    for (double off = 1e-15; off < 0.02; off *= 3) {
        at_damping_ratio(1 - off, 1000);
        at_damping_ratio(1 + off, 1000);
    }
}

static void backwards(void)
{
    for (int i = 0; i < 2000; i++) {
        const spring_params p = {random_log(0.1, 10), random_log(0.1, 10), i % 3 ? random_log(1e-3, 30) : 0, 0};
        const double rate = sqrt(p.stiffness / p.mass) + p.damping / p.mass;
        against_reference(p, (spring_state){random_uniform(-1, 1), random_uniform(-1, 1)},
                          -random_log(1e-6, 100) / rate);
    }
}

/* From rest under load: displacement P a and velocity H a. Both are relatively accurate where they do not change sign;
   an oscillating spring passes through zero again, with the error eps omega t of its angle. */
static void loaded(void)
{
    for (int i = 0; i < 20000; i++) {
        spring_params p = {.mass = random_log(1e-3, 1e3), .load = random_log(1e-3, 1e3)};
        const double time = random_log(1e-9, 1e3);
        if (i % 4 > 0)
            p.stiffness = p.mass * random_log(1e-12, 1e2) / time / time * (i % 4 == 3 ? 1e3 : 1);
        if (i % 3 > 0)
            p.damping = p.mass * random_log(1e-9, 1e3) / time;
        spring_state got = {0, 0};
        spring_step_exact(&got, &p, time);
        reference_start(&ref, &p, (spring_state){0, 0});
        reference_exact(&ref, &p, time);
        const double omega = sqrt(p.stiffness / p.mass), b = p.damping / p.mass / 2;
        const double x = mpfr_get_d(ref.x, MPFR_RNDN), v = mpfr_get_d(ref.v, MPFR_RNDN);
        const double swing = b <= omega ? p.load / p.mass * fmin(time * time, 1 / (omega * omega)) : 0;
        const double bound = 8 * DBL_EPSILON * (1 + (b <= omega ? omega : omega * omega / b) * time);
        CHECK_CLOSE(got.x, x, bound * (fabs(x) + swing), "the response from rest");
        CHECK_CLOSE(got.v, v, bound * (fabs(v) + swing * omega), "its velocity");
    }
}

static void stays_at_rest_under_load(void)
{
    for (int i = 0; i < 1000; i++) {
        const spring_params p = {random_log(0.1, 10), random_log(0.1, 10), random_uniform(0, 3), random_uniform(-1, 1)};
        const double rest = p.load / p.stiffness;
        spring_state s = {rest, 0};
        spring_step_exact(&s, &p, random_log(1e-3, 1e3));
        CHECK_CLOSE(s.x, rest, 6 * DBL_EPSILON * fabs(rest), "the errors of F and of 1 - F cancel");
        CHECK_CLOSE(s.v, 0, 4 * DBL_EPSILON * fabs(rest) * sqrt(p.stiffness / p.mass), "load against spring");
    }
}

/* cos and sin by their series, as far as t = 1 reaches into them: the last terms are a few eps. */
static void series_to_the_last_term(void)
{
    const spring_params p = {1, 1, 0, 0};
    for (int i = 1; i <= 1000; i++) {
        const double t = i / 1000.0;
        spring_state x = {1, 0}, v = {0, 1};
        spring_step_exact(&x, &p, t);
        spring_step_exact(&v, &p, t);
        CHECK_CLOSE(x.x, cos(t), 0.75 * DBL_EPSILON, "1.5 ulp of numbers below 1: rounding of both");
        CHECK_CLOSE(v.x, sin(t), 1.25 * DBL_EPSILON * sin(t), "rounding of S, of t S and of sin");
    }
}

static void special_springs(void)
{
    spring_state s = {1.5, -2};
    const spring_params nothing = {1.3, 0, 0, 0}, falling = {1.3, 0, 0, 2.6}, dragged = {2, 0, 1, 0};
    spring_step_exact(&s, &nothing, 3);
    CHECK_STATE(s, ((spring_state){-4.5, -2}), "a free particle, exactly");
    spring_step_exact(&s, &falling, 2);
    CHECK_CLOSE(s.x, -4.5 - 4 + 4, 8 * DBL_EPSILON, "free fall: a t^2/2");
    CHECK_CLOSE(s.v, 2, 8 * DBL_EPSILON, "free fall: a t");
    s = (spring_state){0, 1};
    spring_step_exact(&s, &dragged, 1e6);
    CHECK_CLOSE(s.x, 2, 4 * DBL_EPSILON, "drag stops it after m v/c");
    CHECK_BITS(s.v, 0, "drag stops it");
    s = (spring_state){1e300, -1e300};
    const spring_params strong = {1, 1e18, 1e13, 0};
    spring_step_exact(&s, &strong, 1);
    CHECK(isfinite(s.x) && isfinite(s.v), "w x is 1e318, and must not be formed");
    s = (spring_state){1, 0};
    const spring_params thick = {1, 1, 1e200, 0};
    spring_step_exact(&s, &thick, 1);
    CHECK_CLOSE(s.x, 1, DBL_EPSILON, "b^2 is 1e400, and must not be formed");
    s = (spring_state){1e280, 0};
    const spring_params critical = {1, 1, 2, 0};
    spring_step_exact(&s, &critical, 1000);
    reference_start(&ref, &critical, (spring_state){1e280, 0});
    reference_exact(&ref, &critical, 1000);
    CHECK_BELOW(reference_distance(&ref, s), stated_bound(&critical, 1000),
                "e^-1000 underflows, 1e280 e^-1000 does not");
}

int main(void)
{
    static const test tests[] = {
        {"undamped", undamped},
        {"damping ratio 1e-4 to 1e4", all_damping_ratios},
        {"damping ratio 1 +- 1e-15 to 1 +- 1e-2", around_critical},
        {"backwards", backwards},
        {"response to a load", loaded},
        {"at rest under load", stays_at_rest_under_load},
        {"series to the last term", series_to_the_last_term},
        {"special springs", special_springs},
    };
    reference_init(&ref);
    const int status = RUN_TESTS("exact", tests);
    reference_clear(&ref);
    mpfr_free_cache();
    return status;
}
