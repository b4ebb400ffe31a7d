/* SPDX-License-Identifier: MIT */
/* Rest: the settling time compared with sampled motion, the test for rest, and the two constructors. */
#include <math.h>

#include "check.h"

static const double pi = 3.141592653589793;

static double distance_at(const spring_params *p, spring_state s, double rest, double t)
{
    spring_step_exact(&s, p, t);
    return fabs(s.x - rest);
}

/* After T no sample is outside the band; right before T the spring is. */
static void settling_time_by_sampling(void)
{
    for (int i = 0; i < 4000; i++) {
        spring_params p = {.mass = random_log(1e-2, 1e2), .stiffness = random_log(1e-2, 1e2)};
        const double omega = sqrt(p.stiffness / p.mass), zeta = i % 5 == 0 ? 1 : random_log(0.02, 50);
        p.damping = 2 * zeta * omega * p.mass;
        if (i % 2)
            p.load = p.stiffness * random_uniform(-1, 1);
        const double rest = p.load / p.stiffness;
        spring_state s = {rest + random_uniform(-1, 1), random_uniform(-1, 1) * omega * (i % 7 == 0 ? 20 : 1)};
        if (i % 11 == 0)
            s.v = 0;
        const double tol = random_log(1e-6, 1);
        const double T = spring_settling_time(&s, &p, tol);
        CHECK(T >= 0 && isfinite(T), "a damped spring comes to rest");
        const double slow = zeta <= 1 ? omega * zeta : omega / (2 * zeta), edge = 1e-9 * tol;
        for (int j = 0; j <= 400; j++) {
            const double t = T + 8 * (2 * pi / omega + 1 / slow) * j / 400;
            CHECK(distance_at(&p, s, rest, t) <= tol + edge, "it stays within the tolerance");
        }
        if (T > 0) {
            CHECK(distance_at(&p, s, rest, T * (1 - 1e-7)) > tol - edge * 100, "and is outside right before");
            CHECK_CLOSE(distance_at(&p, s, rest, T), tol, edge * 100, "at the edge of the band");
        } else {
            for (int j = 0; j <= 400; j++)
                CHECK(distance_at(&p, s, rest, 2 * pi / omega * j / 400) <= tol + edge, "never left");
        }
    }
}

/* Tolerances just above and below an extremum: it counts if it is larger, and not otherwise. A few ulp from it rounding decides,
   and the spring must stay inside all the same. */
static void settling_time_at_a_swing(void)
{
    for (int i = 0; i < 4000; i++) {
        const double mass = random_log(0.1, 10), k = random_log(0.1, 10), zeta = random_log(1e-3, 0.2);
        const spring_params p = {mass, k, 2 * zeta * sqrt(k * mass), 0};
        const double b = p.damping / mass / 2, spacing = pi / sqrt(k / mass - b * b);
        const double turn = spacing * (double)(1 + random_bits() % 20); /* from a start with v = 0 */
        const spring_state start = {0.8, 0};
        const double off = (i % 7 - 3) * (i % 2 ? DBL_EPSILON : 1e-12);
        const double tol = distance_at(&p, start, 0, turn) * (1 + off);
        const double T = spring_settling_time(&start, &p, tol);
        const double edge = 1e-5 * spacing; /* y is flat there: sqrt(2e-12) away in angle it has changed by 1e-12 */
        if (off >= 1e-12)
            CHECK(T > turn - spacing && T < turn + edge, "the swing before was beyond the tolerance, this is not");
        if (off <= -1e-12)
            CHECK(T > turn - edge && T < turn + spacing, "this swing is beyond the tolerance, the next is not");
        CHECK(distance_at(&p, start, 0, T) <= tol, "inside");
        CHECK(distance_at(&p, start, 0, turn + spacing) <= tol, "the next swing is smaller");
        CHECK(T < turn + spacing, "and is not waited for");
    }
}

/* Distances that are exactly the tolerance are within it, and numbers that the code compares with are not special. */
static void settling_time_at_the_tolerance(void)
{
    const spring_params damped = {1.3, 2.7, 0.6, 0}, thick = {1, 1, 2.5, 0};
    CHECK_BITS(spring_settling_time(&(spring_state){0.5, -0.1}, &damped, 0.5), 0, "never beyond it");
    CHECK_BITS(spring_settling_time(&(spring_state){0.5, -1.25}, &thick, 0.5), 0, "never beyond it");
    CHECK_CLOSE(spring_settling_time(&(spring_state){1, -2}, &thick, 0.1), log(10) / 2, 1e-15, "along the fast root");
    /* omega, b and sqrt(w - b^2) are 13/8, 12/8 and 5/8, to the bit: so are the turning points. In some of these the
       logarithm is rounded to the wrong side. */
    const spring_params p = {1, 169.0 / 64, 3, 0};
    for (int i = 0; i < 19 * 50; i++) {
        const spring_state start = {0.3 + 0.0137 * (i % 50), 0};
        const double spacing = pi / 0.625, turn = (1 + i / 50) * spacing, tol = distance_at(&p, start, 0, turn);
        const double at = spring_settling_time(&start, &p, tol),
                     below = spring_settling_time(&start, &p, nextafter(tol, 0));
        CHECK(at > turn - spacing && at < turn, "a swing as large as the tolerance is within it");
        CHECK(below > turn && below < turn + spacing, "a swing an ulp larger is not");
    }
}

/* T is the first double from which on the spring is inside, as far as doubles can tell. */
static void settling_time_is_the_first(void)
{
    const spring_params p = {1.3, 2.7, 0.6, 0}, thick = {1.3, 2.7, 6, 0};
    const spring_state start = {0.8, 0.9};
    for (int i = 0; i < 1000; i++) {
        const spring_params *q = i % 2 ? &p : &thick;
        const double tol = distance_at(q, start, 0, random_uniform(1, 20));
        const double T = spring_settling_time(&start, q, tol);
        CHECK(distance_at(q, start, 0, T) <= tol, "inside");
        CHECK(distance_at(q, start, 0, nextafter(T, 0)) > tol, "outside");
    }
}

/* After the time spring_at_rest() holds at every sample; right before it does not. */
static void rest_time_by_sampling(void)
{
    for (int i = 0; i < 4000; i++) {
        spring_params p = {.mass = random_log(0.1, 10), .stiffness = i % 13 == 0 ? 0 : random_log(0.1, 10)};
        const double omega = sqrt(p.stiffness / p.mass), zeta = i % 5 == 0 ? 1 : random_log(0.05, 20);
        p.damping = omega > 0 ? 2 * zeta * omega * p.mass : random_log(0.1, 10);
        if (omega > 0)
            p.load = random_uniform(-1, 1);
        const spring_state s = {random_uniform(-1, 1), random_uniform(-1, 1)};
        const double x_tol = random_log(1e-5, 1), v_tol = random_log(1e-5, 1), g = p.damping / p.mass;
        const double T = spring_rest_time(&s, &p, x_tol, v_tol), edge = 1e-8;
        CHECK(T >= spring_settling_time(&s, &p, x_tol) && isfinite(T), "both tolerances");
        if (omega == 0) {
            const double want = fmax(0, fmax(log(fabs(s.v) / g / x_tol), log(fabs(s.v) / v_tol)) / g);
            CHECK_CLOSE(T, want, 1e-12 / g, "exponential decay");
            continue;
        }
        for (int j = 0; j <= 200; j++) {
            spring_state after = s;
            spring_step_exact(&after, &p, T + 20 / omega * j / 200);
            CHECK(spring_at_rest(&after, &p, x_tol * (1 + edge), v_tol * (1 + edge)), "at rest for good");
        }
        spring_state before = s;
        spring_step_exact(&before, &p, T * (1 - 1e-7));
        CHECK(T == 0 || !spring_at_rest(&before, &p, x_tol * (1 - edge), v_tol * (1 - edge)), "not before");
    }
    const spring_params p = {1, 4, 1, 0}, undamped = {1, 4, 0, 0}, huge = {1, 1e300, 1, 0};
    const spring_state s = {1, 0}, large = {1e200, 0}, still = {0, 0};
    CHECK_BITS(spring_rest_time(&s, &undamped, 0.1, 9), INFINITY, "never in a distance of 0.1");
    CHECK_BITS(spring_rest_time(&s, &undamped, 9, 0.1), INFINITY, "never slower than 0.1");
    CHECK_BITS(spring_rest_time(&s, &undamped, 9, 9), 0, "always");
    CHECK_BITS(spring_rest_time(&still, &p, 0, 0), 0, "at rest");
    CHECK_BITS(spring_rest_time(&s, &p, 0.1, 0), INFINITY, "a tolerance of 0");
    CHECK_BITS(spring_rest_time(&large, &huge, 1, 1), INFINITY, "an acceleration that overflows");
    CHECK(isnan(spring_rest_time(NULL, &p, 1, 1)) && isnan(spring_rest_time(&s, &p, 1, NAN)) &&
              isnan(spring_rest_time(&s, &p, -1, 1)) && isnan(spring_rest_time(&s, &p, 1, -1)),
          "bad input");
}

static void settling_time_special(void)
{
    const spring_params undamped = {1.3, 2.7, 0, 0}, damped = {1.3, 2.7, 0.6, 0.54}, drag = {2, 0, 0.5, 0};
    const spring_params pushed = {2, 0, 0.5, 0.1}, nothing = {2, 0, 0, 0};
    const spring_state s = {0.5, 0.3}, still = {0.5, 0}, rest = {0.2, 0};
    const double amplitude = hypot(0.5, 0.3 / sqrt(2.7 / 1.3));
    CHECK_BITS(spring_settling_time(&s, &undamped, amplitude * 1.001), 0, "never leaves");
    CHECK_BITS(spring_settling_time(&s, &undamped, amplitude * 0.999), INFINITY, "swings for ever");
    CHECK_CLOSE(spring_settling_time(&rest, &damped, 1e-15), 0, 0, "at rest under its load");
    CHECK_BITS(spring_settling_time(&s, &damped, 0), INFINITY, "zero is never reached for good");
    CHECK_BITS(spring_settling_time(&s, &damped, INFINITY), 0, "anything is near enough");
    CHECK_BITS(spring_settling_time(&s, &pushed, 0.1), INFINITY, "pushed without a spring: never");
    CHECK_BITS(spring_settling_time(&s, &nothing, 0.1), INFINITY, "nothing stops it");
    CHECK_BITS(spring_settling_time(&s, &(spring_params){2, -0.0, -0.0, 0}, 0.1), INFINITY, "-0 is 0");
    CHECK_BITS(spring_settling_time(&still, &nothing, 0), 0, "nothing moves it");
    CHECK_CLOSE(spring_settling_time(&s, &drag, 0.01), 4 * log(1.2 / 0.01), 1e-14 * 20, "1.2 m to go, 1/g = 4 s");
    CHECK_BITS(spring_settling_time(&s, &drag, 1.3), 0, "less than the tolerance to go");
    CHECK_BITS(spring_settling_time(&s, &drag, -0.0), INFINITY, "zero is never reached, of either sign");
    CHECK_BITS(spring_settling_time(&s, &nothing, -0.0), INFINITY, "zero is never reached, of either sign");
    CHECK_CLOSE(spring_settling_time(&(spring_state){0, 1e200}, &drag, 1e-200), 4 * (log(4) + 400 * log(10)),
                4000 * 4 * DBL_EPSILON, "a ratio of 4e400");
    const double far = spring_settling_time(&(spring_state){1e200, 0}, &damped, 1e-200);
    CHECK_CLOSE(far, 400 * log(10) / (0.6 / 2.6), 2 * pi / sqrt(2.7 / 1.3), "the envelope, in a ratio of 1e400");
    const spring_params creeping = {1, 1e-300, 1, 0};
    CHECK(spring_settling_time(&s, &creeping, 0.01) > 1e299, "a root of 1e-300");
    CHECK_BITS(spring_settling_time(&s, &creeping, 0), INFINITY, "zero is never reached for good");
    const spring_params quick = {1, 1e8, 2e4, 0}, creeper = {1, 0.2, 1, 0};
    CHECK_BITS(spring_settling_time(&still, &quick, 0), INFINITY, "not even where it underflows in less than a second");
    CHECK_BITS(spring_settling_time(&(spring_state){0, 1}, &quick, 0), INFINITY, "nor if it starts there");
    const spring_state out = {1, 0.05}; /* turns after 0.23 s */
    const double later = spring_settling_time(&out, &creeper, distance_at(&creeper, out, 0, 0.4));
    CHECK_CLOSE(later, 0.4, 1e-13, "within at the start, and again in less than a second");
    const spring_params slower = {1, 1e-308, 1, 0}, weak = {1, 1e-300, 1, 1e300};
    CHECK_BITS(spring_settling_time(&s, &slower, 0.01), INFINITY, "4.4e308 s is more than a double holds");
    CHECK_BITS(spring_settling_time(&s, &weak, 0.01), INFINITY, "and so is a rest position of 1e600 m");
    const spring_params critical = {1, 1, 2, 0}, thick = {1, 1, 2.5, 0};
    CHECK_CLOSE(spring_settling_time(&(spring_state){0, 1}, &critical, 0.1), 3.577152063957297, 1e-14,
                "t exp(-t) = 0.1, the later time");
    /* y = (4 exp(-2 t) - exp(-t/2))/3: through 0, but never below -0.1 */
    CHECK_CLOSE(spring_settling_time(&(spring_state){1, -2.5}, &thick, 0.5), 0.25999693337078763, 1e-14, "y = 0.5");
}

/* Linear: mirrored, or from a start 2^k times as far with 2^k times the tolerance, the same time to the bit. However large one
   of x and v is compared with the other. Squares of frequencies times the largest states are beyond the range of a double. */
static void settling_time_of_any_size(void)
{
    static const double sizes[] = {1e-300, 1e-5, 1, 1e5, 1e300};
    const spring_params springs[] = {{1.3, 2.7, 0.6, 0}, {1.3, 2.7, 6, 0}, {1, 1e10, 1e4, 0}, {1, 1e18, 1e10, 0}};
    for (int i = 0; i < 100; i++) {
        const spring_params *p = &springs[i % 4];
        const spring_state s = {sizes[i / 4 % 5] * (i % 2 ? -1 : 1), sizes[i / 20]}, mirrored = {-s.x, -s.v};
        const double T = spring_settling_time(&s, p, 1e-3), larger = fmax(fabs(s.x), s.v) > 1e290 ? 0x1p-20 : 0x1p20;
        const spring_state scaled = {s.x * larger, s.v * larger};
        CHECK(isfinite(T), "a damped spring comes to rest");
        CHECK_BITS(spring_settling_time(&mirrored, p, 1e-3), T, "mirrored");
        CHECK_BITS(spring_settling_time(&scaled, p, 1e-3 * larger), T, "length in other units");
    }
    const spring_state near = {1, -1e5}, far = {0x1p996, -1e5 * 0x1p996};
    CHECK_BITS(spring_settling_time(&far, &springs[2], 0.1 * 0x1p996), spring_settling_time(&near, &springs[2], 0.1),
               "far");
}

static void settling_time_bad_input(void)
{
    const spring_params p = {1.3, 2.7, 0.6, 0.4}, bad = {1.3, -2.7, 0.6, 0.4};
    const spring_state s = {0.5, 0.3}, lost = {NAN, 0.3}, far = {0.5, INFINITY};
    CHECK(isnan(spring_settling_time(NULL, &p, 0.1)), "no state");
    CHECK(isnan(spring_settling_time(&s, NULL, 0.1)), "no parameters");
    CHECK(isnan(spring_settling_time(&s, &bad, 0.1)), "negative stiffness");
    CHECK(isnan(spring_settling_time(&lost, &p, 0.1)), "x not a number");
    CHECK(isnan(spring_settling_time(&far, &p, 0.1)), "v infinite");
    CHECK(isnan(spring_settling_time(&s, &p, -0.1)), "negative tolerance");
    CHECK(isnan(spring_settling_time(&s, &p, NAN)), "tolerance not a number");
}

static void at_rest(void)
{
    const spring_params p = {1.3, 2.5, 0.6, 0.5}; /* rests at 0.2 */
    const spring_params free_mass = {1.3, 0, 0, 0}, pushed = {1.3, 0, 0.6, 0.5}, bad = {1.3, NAN, 0.6, 0.5};
    const spring_state s = {0.25, -0.0625};
    CHECK(spring_at_rest(&s, &p, 0.0501, 0.0625), "within both");
    CHECK(!spring_at_rest(&s, &p, 0.0499, 0.0625), "too far");
    CHECK(!spring_at_rest(&s, &p, 0.0501, 0.0624), "too fast");
    CHECK(spring_at_rest(&(spring_state){1e9, 0}, &free_mass, 0, 0), "no stiffness: rest is anywhere");
    CHECK(!spring_at_rest(&(spring_state){1e9, 0.1}, &free_mass, 1, 0.05), "but not while moving");
    CHECK(!spring_at_rest(&(spring_state){1e9, -0.1}, &free_mass, 1, 0.05), "in either direction");
    CHECK(!spring_at_rest(&(spring_state){-0.5, 0}, &p, 0.6, 1), "too far on the other side");
    CHECK(spring_at_rest(&(spring_state){0.25, 0}, &(spring_params){1.3, 2.5, 0.6, 0}, 0.25, 0), "at both tolerances");
    CHECK(!spring_at_rest(&(spring_state){0, 0}, &pushed, 1, 1), "nowhere under a load");
    CHECK(!spring_at_rest(NULL, &p, 1, 1) && !spring_at_rest(&s, NULL, 1, 1), "NULL");
    CHECK(!spring_at_rest(&s, &bad, 1, 1), "bad parameters");
    CHECK(!spring_at_rest(&s, &p, NAN, 1) && !spring_at_rest(&s, &p, 1, NAN), "no tolerance");
    CHECK(!spring_at_rest(&s, &p, -1, 1) && !spring_at_rest(&s, &p, 1, -1), "negative tolerance");
    CHECK(!spring_at_rest(&(spring_state){1, 0}, &free_mass, -1, 1), "negative tolerance");
    CHECK(!spring_at_rest(&(spring_state){NAN, 0}, &p, 1, 1), "a lost state");
    CHECK(!spring_at_rest(&(spring_state){NAN, 0}, &free_mass, 1, 1), "a lost state");
    CHECK(!spring_at_rest(&(spring_state){INFINITY, 0}, &p, INFINITY, 1), "a lost state");
    CHECK(!spring_at_rest(&(spring_state){0, INFINITY}, &p, 1, INFINITY), "a lost state");
    const spring_params faint = {1e300, 1e-300, 0, 0};
    CHECK(spring_at_rest(&(spring_state){5, 0}, &faint, 0.1, 0.1), "stiffness/mass is 0: rest is anywhere");
    CHECK_BITS(spring_settling_time(&(spring_state){5, 0}, &faint, 0.1), 0, "and the same for the time");
}

static void params_from_frequency(void)
{
    for (int i = 0; i < 1000; i++) {
        const double hertz = random_log(1e-3, 1e3), zeta = i % 3 ? random_log(1e-3, 1e2) : 0;
        const spring_params p = spring_params_hertz(hertz, zeta);
        CHECK_BITS(p.mass, 1, "a kilogram");
        CHECK_BITS(p.load, 0, "no load");
        CHECK_CLOSE(sqrt(p.stiffness) / (2 * pi), hertz, 4 * DBL_EPSILON * hertz, "the undamped frequency");
        CHECK_CLOSE(p.damping / (2 * sqrt(p.stiffness)), zeta, 4 * DBL_EPSILON * zeta, "the damping ratio");
    }
    CHECK_BITS(spring_params_hertz(0x1.45f306dc9c883p-514, 0.5).stiffness, DBL_MIN, "the smallest with all its digits");
    const spring_params still = spring_params_hertz(0, 0.5);
    CHECK(still.mass == 1 && still.stiffness == 0 && still.damping == 0, "0 Hz is a free particle");
}

/* The ratio of two states one half-life apart, late enough that only the envelope is left. */
static void params_from_half_life(void)
{
    for (int i = 0; i < 1000; i++) {
        const double half_life = random_log(1e-2, 1e2), zeta = i % 5 ? random_log(1e-2, 1e2) : 1;
        const spring_params p = spring_params_half_life(half_life, zeta);
        CHECK_BITS(p.mass, 1, "a kilogram");
        CHECK_CLOSE(p.damping / (2 * sqrt(p.stiffness)), zeta, 4 * DBL_EPSILON * zeta, "the damping ratio");
        const double omega = sqrt(p.stiffness), b = p.damping / 2;
        if (zeta < 0.9) {
            /* x^2 + ((v + b x)/omega_d)^2 is the envelope squared */
            const double omega_d = sqrt(p.stiffness - b * b);
            spring_state s = {0.3, 0.8 * omega};
            const double before = hypot(s.x, (s.v + b * s.x) / omega_d);
            spring_step_exact(&s, &p, half_life);
            CHECK_CLOSE(hypot(s.x, (s.v + b * s.x) / omega_d), before / 2, 1e-13 * before, "half of the envelope");
        } else if (zeta > 1.1) {
            spring_state s = {1, 0};
            spring_step_exact(&s, &p, 40 * half_life); /* the fast root is gone: 2^-40 and faster */
            const double before = s.x;
            spring_step_exact(&s, &p, half_life);
            CHECK_CLOSE(s.x, before / 2, 1e-6 * before, "half of the slow exponential");
        }
        const double slow = zeta <= 1 ? b : b - omega * sqrt(zeta * zeta - 1);
        CHECK_CLOSE(slow * half_life, log(2), 8 * DBL_EPSILON * fmax(1, 4 * zeta * zeta), "b - sqrt(...) cancels");
    }
}

static void constructors_refuse(void)
{
    const spring_params bad[] = {
        spring_params_hertz(-1, 0.5),         spring_params_hertz(NAN, 0.5),
        spring_params_hertz(INFINITY, 0.5),   spring_params_hertz(1e160, 0.5),
        spring_params_hertz(1e-170, 0.5),     spring_params_hertz(1, -0.5),
        spring_params_hertz(0, -0.5), /* the damping would be -0 */
        spring_params_hertz(1e-150, -1e-200), spring_params_hertz(1, NAN),
        spring_params_half_life(1e170, 0.5),  spring_params_half_life(INFINITY, 0.5),
        spring_params_half_life(0, 0.5),      spring_params_half_life(-1, 0.5),
        spring_params_half_life(NAN, 0.5),    spring_params_half_life(1, 0),
        spring_params_half_life(1, -0.5),     spring_params_half_life(1, NAN),
        spring_params_half_life(1, INFINITY),
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        spring_state s = {0, 1};
        CHECK(isnan(bad[i].mass) && isnan(bad[i].stiffness) && isnan(bad[i].damping) && isnan(bad[i].load), "NaN");
        CHECK(spring_advance(&s, &bad[i], SPRING_LEAPFROG, 0.1, 1) == SPRING_EINVAL, "and spring_advance() refuses it");
    }
}

int main(void)
{
    static const test tests[] = {
        {"settling time against sampling", settling_time_by_sampling},
        {"settling time, tolerance at a swing", settling_time_at_a_swing},
        {"settling time, distances equal to the tolerance", settling_time_at_the_tolerance},
        {"settling time to the last bit", settling_time_is_the_first},
        {"settling time, special springs", settling_time_special},
        {"rest time by sampling", rest_time_by_sampling},
        {"settling time of states of any size", settling_time_of_any_size},
        {"settling time, bad input", settling_time_bad_input},
        {"at rest", at_rest},
        {"parameters from a frequency", params_from_frequency},
        {"parameters from a half-life", params_from_half_life},
        {"constructors refuse bad input", constructors_refuse},
    };
    return RUN_TESTS("settling", tests);
}
