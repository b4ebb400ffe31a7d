/* SPDX-License-Identifier: MIT */
/* The exact solution compared with multiple precision, to the bounds stated in spring.h.
       test_exact [POINTS]     number of points where the formula changes, default 10^5 */
#include <math.h>
#include <stdlib.h>

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
    if (!isfinite(mpfr_get_d(ref.x, MPFR_RNDN)) || !isfinite(mpfr_get_d(ref.v, MPFR_RNDN))) {
        CHECK(!isfinite(got.x) || !isfinite(got.v), "the solution overflows");
        return;
    }
    CHECK_BELOW(reference_distance(&ref, got), stated_bound(&p, t), "the bound stated in spring.h");
}

/* From rest under load: displacement P a and velocity H a. Both are relatively accurate where they do not change sign;
   an oscillating spring passes through zero again, with the error eps omega t of its angle. */
static void response(spring_params p, double t)
{
    spring_state got = {0, 0};
    spring_step_exact(&got, &p, t);
    reference_start(&ref, &p, (spring_state){0, 0});
    reference_exact(&ref, &p, t);
    const double omega = sqrt(p.stiffness / p.mass), b = p.damping / p.mass / 2, time = fabs(t);
    const double rate = b <= omega ? omega : t < 0 ? 2 * b : omega * omega / b; /* of what grows, or dies out last */
    const double x = mpfr_get_d(ref.x, MPFR_RNDN), v = mpfr_get_d(ref.v, MPFR_RNDN);
    const double largest = p.load / p.mass * fmin(time * time, 1 / (omega * omega)) * exp(b * (time - t) / 2);
    const double swing = b <= omega ? largest : 0;
    const double share = 8 * DBL_EPSILON * (1 + rate * time);
    const double least = 2 * DBL_TRUE_MIN; /* denormal, and rounded twice */
    const double bound_x = share * (fabs(x) + swing) + least, bound_v = share * (fabs(v) + swing * omega) + least;
    CHECK_CLOSE(got.x, x, bound_x, "the response from rest");
    CHECK_CLOSE(got.v, v, bound_v, "its velocity");
}

static void loaded(void)
{
    for (int i = 0; i < 20000; i++) {
        spring_params p = {.mass = random_log(1e-3, 1e3), .load = random_log(1e-3, 1e3)};
        const double time = random_log(1e-9, 1e3);
        if (i % 4 > 0)
            p.stiffness = p.mass * random_log(1e-12, 1e2) / time / time * (i % 4 == 3 ? 1e3 : 1);
        if (i % 3 > 0)
            p.damping = p.mass * random_log(1e-9, 1e3) / time;
        response(p, time);
    }
}

/* A threshold, missed by anything from an ulp to a hundredth. */
static double about(double threshold)
{
    return threshold * (1 + (random_bits() % 2 ? 1 : -1) * random_log(1e-17, 1e-2));
}

/* A spring by its damping ratio; its mass is 1 in one of four. */
static spring_params spring_of(double omega, double zeta)
{
    const double mass = random_bits() % 4 ? random_log(1e-3, 1e3) : 1;
    return (spring_params){mass, mass * omega * omega, 2 * zeta * mass * omega, 0};
}

/* |r| t, by damping ratio, of a time with omega t = 1: of the angle, and of the roots. */
static double angle_rate(double zeta)
{
    return sqrt(fabs(zeta - 1) * (zeta + 1));
}

static double fast_rate(double zeta)
{
    return zeta > 1 ? zeta + angle_rate(zeta) : zeta;
}

static double slow_rate(double zeta)
{
    return zeta > 1 ? 1 / fast_rate(zeta) : zeta;
}

typedef struct point {
    spring_params p;
    double t;
} point;

static point at(double omega, double zeta, double omega_t)
{
    return (point){spring_of(omega, zeta), omega_t / omega};
}

static double any_omega(void)
{
    return random_log(1e-5, 1e5);
}

static double any_zeta(void)
{
    return random_bits() % 2 ? random_log(1e-3, 0.999) : random_log(1.001, 1e3);
}

/* An odd multiple, of up to about 2 most + 1. */
static double odd_multiple(double of, double most)
{
    return about(of * (1 + 2 * floor(random_log(1, most))));
}

enum { change_count = 10 };

/* Near a place where the formula changes. */
static point near_change(unsigned long change)
{
    static const double logs[] = {708.4, 745.1, 750, 1416.8, 1490, 1500}, ends[] = {0x1p-400, 0x1p400};
    const double omega = any_omega(), zeta = any_zeta(), near_critical = random_bits() % 4 ? any_zeta() : about(1);
    const double light = random_log(1e-6, 0.999), heavy = random_log(2, 1e8), end = about(ends[random_bits() % 2]);
    const bool other = random_bits() % 2;
    switch (change) {
    case 0: /* critical damping */
        return at(omega, about(1), random_log(1e-3, 1e3));
    case 1: /* an angle of 2^-55 */
        return at(omega, zeta, about(0x1p-55) / angle_rate(zeta));
    case 2: /* an angle at an odd multiple of pi/4 */
        return at(omega, light, odd_multiple(0.78539816339744828, 300) / angle_rate(light));
    case 3: /* large angles */
        return at(omega, random_log(1e-20, 1e-16), about(other ? 0x1p51 : 0x1p26));
    case 4: /* an exponent at an odd multiple of ln(2)/2 */
        return at(omega, zeta,
                  odd_multiple(0.34657359027997264, 100) / (other      ? slow_rate(zeta)
                                                            : zeta > 1 ? 2 * angle_rate(zeta)
                                                                       : zeta));
    case 5: /* exponents where doubles end */
        return at(omega, zeta, about(logs[random_bits() % 6]) / (other ? slow_rate(zeta) : fast_rate(zeta)));
    case 6: /* frequencies of 2^-400, 2^400 */
        return at(other ? end : end / near_critical, near_critical, random_log(1e-3, 1e2));
    case 7: /* masses of 2^-400, 2^400 */
        return (point){{end, end * omega * omega, 2 * about(1) * end * omega, 0}, random_log(1e-3, 1e2) / omega};
    case 8: /* the larger root times t is 1 */
        return at(omega, near_critical, about(1) / fmax(1, fast_rate(near_critical)));
    default: /* the smaller root times t is 2^-55 */
        return at(omega, heavy, about(0x1p-55) / slow_rate(heavy));
    }
}

static unsigned long points = 100000;

/* Anywhere, along the fast root, and huge. */
static spring_state any_start(double omega, double zeta, double largest)
{
    const double angle = random_uniform(0, 2 * pi), size = random_bits() % 4 ? 1 : random_log(1 / largest, largest);
    spring_state start = {size * cos(angle), size * omega * sin(angle)};
    if (random_bits() % 4 == 0 && zeta > 1)
        start.v = -omega * fast_rate(zeta) * start.x;
    return start;
}

/* Forwards or, if it does not grow too much, backwards, and from rest under a load. */
static void check_point(point y, bool back, double largest)
{
    const double omega = sqrt(y.p.stiffness / y.p.mass), zeta = y.p.damping / y.p.mass / omega / 2;
    const bool grows = fmax(1, fast_rate(zeta)) * omega * y.t > 100; /* backwards: over w, beyond doubles */
    const double t = back && !grows ? -y.t : y.t;
    against_reference(y.p, any_start(omega, zeta, largest), t);
    y.p.load = y.p.mass * omega * omega;
    if (isnormal(y.p.load))
        response(y.p, t);
}

static void any_spring(void)
{
    for (int i = 0; i < 40000; i++) {
        const double off = random_log(1e-15, 0.02), omega = any_omega();
        const double zeta[] = {0, random_log(1e-4, 1e4), 1, 1 + off, 1 - off};
        check_point(at(omega, zeta[i % 5], 2 * pi * random_log(1e-9, 1e3)), i / 5 % 4 == 0, 1e290);
    }
}

static void where_it_changes(void)
{
    for (unsigned long i = 0; i < points; i++)
        check_point(near_change(i % change_count), i / change_count % 4 == 0, 1e100);
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

/* Damping alone, also backwards, where e^(-gamma t) overflows: x + (1 - e^(-gamma t))/gamma v and e^(-gamma t) v. */
static void without_stiffness(void)
{
    mpfr_t gamma, decay, way;
    mpfr_inits2(200, gamma, decay, way, (mpfr_ptr)NULL);
    for (int i = 0; i < 20000; i++) {
        const double mass = random_log(1e-3, 1e3), damping = random_log(1e-6, 1e6);
        const double t = (i % 2 ? 1 : -1) * random_log(1e-9, 1300) * mass / damping;
        const spring_params p = {mass, 0, damping, 0};
        const spring_state start = {random_uniform(-1e3, 1e3), i % 5 ? random_log(1e-3, 1e3) : 0};
        spring_state got = start;
        spring_step_exact(&got, &p, t);
        mpfr_set_d(gamma, damping, MPFR_RNDN);
        mpfr_div_d(gamma, gamma, mass, MPFR_RNDN);
        mpfr_mul_d(decay, gamma, -t, MPFR_RNDN);
        mpfr_expm1(way, decay, MPFR_RNDN);
        mpfr_exp(decay, decay, MPFR_RNDN);
        mpfr_mul_d(decay, decay, start.v, MPFR_RNDN);
        mpfr_mul_d(way, way, -start.v, MPFR_RNDN);
        mpfr_div(way, way, gamma, MPFR_RNDN);
        const double v = mpfr_get_d(decay, MPFR_RNDN), d = mpfr_get_d(way, MPFR_RNDN);
        const double share = 4 * DBL_EPSILON * (1 + damping / mass * fabs(t));
        if (!isfinite(start.x + d) || !isfinite(v)) {
            CHECK(!isfinite(got.x) || !isfinite(got.v), "the solution overflows");
            continue;
        }
        CHECK_CLOSE(got.x, start.x + d, start.v != 0 ? share * (fabs(start.x) + fabs(d)) + DBL_MIN : 0, "stated bound");
        CHECK_CLOSE(got.v, v, share * fabs(v) + DBL_MIN, "stated bound");
    }
    mpfr_clears(gamma, decay, way, (mpfr_ptr)NULL);
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

int main(int argc, char **argv)
{
    static const test tests[] = {
        {"any spring", any_spring},
        {"response to a load", loaded},
        {"where the formula changes", where_it_changes},
        {"at rest under load", stays_at_rest_under_load},
        {"without stiffness", without_stiffness},
        {"series to the last term", series_to_the_last_term},
        {"special springs", special_springs},
    };
    if (argc == 2)
        points = strtoul(argv[1], NULL, 10);
    reference_init(&ref);
    const int status = RUN_TESTS("exact", tests);
    reference_clear(&ref);
    mpfr_free_cache();
    return status;
}
