/* SPDX-License-Identifier: MIT */
/*
 * Batches that follow targets, for one instruction set: v128, v256 or v512 on the command line. Built twice: once
 * with SPRING_FLOAT, for the single-precision version. In double precision, results are bit-identical to
 * spring_follow(), which tests/spring/test_follow.c tests. In single precision, they are bit-identical to the kernels
 * without vectors, which are close to spring_follow() in double precision, and land.
 *     test_follow_batchf VECTORS [SPRINGS]     number of springs that must reach the target, default 600
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/batch_kernels.h"
#include "simd/targets.h"
#include "check.h"

extern const batch_kernels plain_batch;
static const batch_kernels *kernels;
static size_t springs = 600; /* that must reach the target, in single precision */

static const double eps = sizeof(scalar) == sizeof(float) ? FLT_EPSILON : DBL_EPSILON;

enum { most = 301, arrays = 6 }; /* more than two groups of any vectors, and a rest */

typedef struct place {
    scalar x[most], v[most], w[most], g[most], a[most], target[most];
} place;

/* Bits of a set of features; SPRING_SHARED_... are the first three. */
enum { UNDAMPED = 8, UNLOADED = 16, all_features = 32 };

static spring_batch batch_of(place *p, unsigned features, size_t count)
{
    return (spring_batch){.count = count,
                          .x = p->x,
                          .v = p->v,
                          .omega2 = p->w,
                          .gamma = features & UNDAMPED ? NULL : p->g,
                          .accel = features & UNLOADED ? NULL : p->a,
                          .shared = features & 7};
}

static spring_params spring_at(const place *p, unsigned features, size_t i)
{
    return (spring_params){.mass = 1,
                           .stiffness = (double)p->w[features & SPRING_SHARED_OMEGA2 ? 0 : i],
                           .damping = features & UNDAMPED ? 0 : (double)p->g[features & SPRING_SHARED_GAMMA ? 0 : i],
                           .load = features & UNLOADED ? 0 : (double)p->a[features & SPRING_SHARED_ACCEL ? 0 : i]};
}

/* Springs some of which land in the next step, are at rest, or have no stiffness or no load. */
static void draw(place *p, double dt)
{
    for (size_t i = 0; i < most; i++) {
        const double omega = random_log(0.1, 300), zeta = random_log(0.01, 20);
        p->w[i] = (scalar)(random_bits() % 16 ? omega * omega : 0);
        p->g[i] = (scalar)(random_bits() % 16 ? 2 * zeta * omega : 0);
        p->a[i] = (scalar)(random_bits() % 4 ? random_uniform(-10, 10) : 0);
        p->target[i] = (scalar)random_uniform(-1000, 1000);
        const double rest = (double)p->target[i] + (p->w[i] > 0 ? (double)p->a[i] / (double)p->w[i] : 0);
        const double size = random_bits() % 2 ? 100 : fabs(rest) * eps * random_log(0.1, 1e4) / fmin(1, fabs(dt));
        p->x[i] = (scalar)(rest + size * random_uniform(-1, 1));
        p->v[i] = (scalar)(random_bits() % 8 ? size * omega * random_uniform(-1, 1) : 0);
    }
}

static const scalar bad_numbers[] = {NAN, INFINITY, -INFINITY, -1, -(scalar)0};

/* One in eight gets a number that is not valid, or may not be. Shared parameters, the first of their arrays, stay. */
static void spoil(place *p)
{
    for (size_t i = 1; i < most; i++) {
        scalar *const one[arrays] = {&p->x[i], &p->v[i], &p->w[i], &p->g[i], &p->a[i], &p->target[i]};
        if (random_bits() % 8 == 0)
            *one[random_bits() % arrays] = bad_numbers[random_bits() % 5];
    }
}

static bool same(scalar a, scalar b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* What becomes of spring i alone: its state and status, and whether it is counted. */
typedef struct outcome {
    scalar x, v;
    spring_status status;
    bool moving;
} outcome;

#ifdef SPRING_FLOAT
static outcome alone(place *p, unsigned features, size_t i, double dt, double x_tol, double v_tol)
{
    scalar w = (scalar)spring_at(p, features, i).stiffness, g = (scalar)spring_at(p, features, i).damping;
    scalar a = (scalar)spring_at(p, features, i).load, target = p->target[i];
    outcome end = {p->x[i], p->v[i], SPRING_OK, true};
    const spring_batch one = {1, &end.x, &end.v, &w, features & UNDAMPED ? NULL : &g, &a, features & 7};
    size_t moving;
    end.status = spring_batch_follow_with(&plain_batch, &one, &target, dt, x_tol, v_tol, &moving);
    end.moving = moving > 0;
    return end;
}
#else
static outcome alone(place *p, unsigned features, size_t i, double dt, double x_tol, double v_tol)
{
    const spring_params one = spring_at(p, features, i);
    spring_state s = {p->x[i], p->v[i]};
    const spring_status status = spring_follow(&s, &one, p->target[i], 0, dt);
    const double rest = one.load != 0 ? p->target[i] + one.load / one.stiffness : p->target[i];
    if (status == SPRING_OK && fabs(s.x - rest) <= x_tol && fabs(s.v) <= v_tol && isfinite(rest))
        return (outcome){rest, 0, status, false};
    return (outcome){s.x, s.v, status, true};
}
#endif

static void check_batch(place *p, unsigned features, size_t count, double dt, double x_tol, double v_tol)
{
    static outcome want[most];
    size_t moves = 0, moving = 12345;
    bool fails = false;
    for (size_t i = 0; i < count; i++) {
        want[i] = alone(p, features, i, dt, x_tol, v_tol);
        moves += want[i].moving;
        fails |= want[i].status != SPRING_OK;
    }
    const spring_batch b = batch_of(p, features, count);
    const scalar after_x = p->x[count < most ? count : 0], after_v = p->v[count < most ? count : 0];
    const spring_status got = spring_batch_follow_with(kernels, &b, p->target, dt, x_tol, v_tol, &moving);
    CHECK(got == (fails ? SPRING_EPARTIAL : SPRING_OK), "all other springs advance");
    CHECK(moving == moves, "springs that move or fail are counted");
    size_t differ = 0;
    for (size_t i = 0; i < count; i++)
        differ += !same(p->x[i], want[i].x) || !same(p->v[i], want[i].v);
    CHECK(differ == 0, "a spring of a batch has the bits of a single one");
    if (count < most)
        CHECK(same(p->x[count], after_x) && same(p->v[count], after_v), "the number after a batch is not touched");
}

static void bits_of_single_springs(void)
{
    static place p;
    static const double steps[] = {1.0 / 60, 1.0 / 240, 0.5, -0.01, 1e-6, 1e-12};
    static const double tolerances[][2] = {{0, 0}, {0.01, 0.1}, {50, 3000}, {0, INFINITY}, {INFINITY, 0.1}};
    for (unsigned features = 0; features < all_features; features++)
        for (size_t i = 0; i < 60; i++) {
            const double *tolerance = tolerances[i % 5], dt = steps[i / 5 % 6];
            draw(&p, dt);
            if (i % 3 == 0)
                spoil(&p);
            check_batch(&p, features, i % 2 ? most : i * 3, dt, tolerance[0], tolerance[1]);
        }
}

/* Damped springs of about the same frequency, all with the coefficients of the first if `features` says so. */
static void draw_alike(place *p, double lowest, double zeta)
{
    for (size_t j = 0; j < most; j++) {
        const double omega = lowest * random_uniform(1, 1.5), damping_ratio = zeta * random_uniform(1, 1.5);
        p->w[j] = (scalar)(omega * omega);
        p->g[j] = (scalar)(2 * damping_ratio * omega);
        p->target[j] = (scalar)random_uniform(-1000, 1000);
        p->a[j] = (scalar)(random_uniform(-1, 1) * omega * omega);
        p->x[j] = (scalar)random_uniform(-1000, 1000);
        p->v[j] = 0;
    }
}

#ifdef SPRING_FLOAT

static const double least_fraction = 0x1p-11; /* as in batch.h */

/* The decay rate of the slowest mode. */
static double slow_rate(const spring_params *p)
{
    const double omega = sqrt(p->stiffness), zeta = p->damping / 2 / omega;
    return omega * (zeta <= 1 ? zeta : 1 / (zeta + sqrt(zeta - 1) * sqrt(zeta + 1)));
}

/* In float every number goes through some roundings: five of F x0 + H v0, those of y and x, and a landing. */
static void near_single_springs(void)
{
    static place p, before;
    for (int i = 0; i < 200; i++) {
        const double dt = random_log(i % 4 > 1 ? 1e-17 : 1.0 / 240, 0.2);
        draw(&p, fmax(dt, 1e-3));
        before = p;
        const unsigned features = i % 2 ? 3 : 0;
        const spring_batch b = batch_of(&p, features, most);
        CHECK(spring_batch_follow_with(kernels, &b, p.target, dt, 0, 0, NULL) == SPRING_OK, "good input");
        for (size_t j = 0; j < most; j++) {
            const spring_params one = spring_at(&before, features, j);
            if (one.stiffness == 0)
                continue;
            const double target = (double)p.target[j], x0 = (double)before.x[j], v0 = (double)before.v[j];
            const double omega = sqrt(one.stiffness), rest = target + one.load / one.stiffness;
            const double decay = fmax(fmin(1, slow_rate(&one) * dt), least_fraction);
            spring_state s = {x0, v0};
            spring_follow(&s, &one, target, 0, dt);
            const bool lands = one.damping > 0 && (p.v[j] == 0 || s.v == 0);
            const double size = hypot(x0 - rest, v0 / omega);
            const double bound = eps * (8 * size + 4 * fabs(rest) + (lands ? 1.125 * fabs(rest) / decay : 0));
            CHECK_CLOSE((double)p.x[j], s.x, bound, "roundings to float, and landing");
            CHECK_CLOSE((double)p.v[j] / omega, s.v / omega, bound, "roundings to float, and landing");
        }
    }
}

/* The rest position, rounded as the header says. */
static scalar rest_of(const place *p, unsigned features, size_t i)
{
    const spring_params one = spring_at(p, features, i);
    return one.load != 0 ? p->target[i] + (scalar)one.load / (scalar)one.stiffness : p->target[i];
}

static unsigned alike_or_not(size_t i)
{
    return (i % 2 ? SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA : 0) | (i / 2 % 2 ? UNLOADED : 0);
}

/* Batches in frames, until none moves; with shared coefficients and load, and without. */
static void lands(void)
{
    static place p;
    const size_t batches = (springs + most - 1) / most;
    for (size_t i = 0; i < 3 * batches; i++) {
        const double dt = i % 3 == 0 ? 1.0 / 60 : i % 3 == 1 ? 1.0 / 240 : 1 / random_log(30, 240);
        double lowest, zeta, slowest;
        do {
            lowest = random_log(0.1, 300);
            zeta = random_log(0.1, 10);
            slowest = fmin(zeta * lowest, lowest / (3 * zeta));
        } while (slowest * dt < least_fraction);
        draw_alike(&p, lowest, zeta);
        const unsigned features = alike_or_not(i);
        const spring_batch b = batch_of(&p, features, most);
        size_t moving = most;
        for (double t = 0; moving > 0 && t < 200 / slowest; t += dt)
            spring_batch_follow_with(kernels, &b, p.target, dt, 0, 0, &moving);
        CHECK(moving == 0, "all land within 200 decay times");
        for (size_t j = 0; j < most; j++)
            CHECK(p.x[j] == rest_of(&p, features, j) && p.v[j] == 0, "on its target, or its rest position");
    }
}

/* Where steps are so short that rounding error may stop a spring before it lands. */
static void stops_near_the_target(void)
{
    static place p;
    enum { few = 8 };
    for (size_t i = 0; i < 4; i++) {
        const unsigned features = alike_or_not(i);
        draw_alike(&p, random_log(0.1, 100), random_log(0.3, 0.9));
        double slowest = INFINITY;
        for (size_t j = 0; j < few; j++) {
            const spring_params one = spring_at(&p, features, j);
            slowest = fmin(slowest, slow_rate(&one));
        }
        const double dt = least_fraction / 4 / slowest;
        for (size_t j = 0; j < few; j++) {
            const double rest = (double)rest_of(&p, features, j);
            p.x[j] = (scalar)(rest + 10 / least_fraction * eps * rest);
        }
        const spring_batch b = batch_of(&p, features, few);
        for (double n = 6 / (slowest * dt); n > 0; n--)
            spring_batch_follow_with(kernels, &b, p.target, dt, 0, 0, NULL);
        for (size_t j = 0; j < few; j++) {
            const spring_params one = spring_at(&p, features, j);
            const double rest = (double)rest_of(&p, features, j);
            CHECK_BELOW(hypot((double)p.x[j] - rest, (double)p.v[j] / sqrt(one.stiffness)),
                        1.2 / (slow_rate(&one) * dt) * eps * fabs(rest) * (1 + 10 / least_fraction * eps),
                        "the distance in the headers");
        }
    }
}

#endif

static void no_step_counts(void)
{
    static place p, before;
    draw(&p, 1);
    spoil(&p);
    p.x[7] = p.target[7] = 3; /* at rest but for its parameters */
    p.v[7] = p.a[7] = 0;
    p.g[7] = -1;
    before = p;
    for (unsigned features = 0; features < all_features; features++)
        for (int wide = 0; wide < 2; wide++) {
            const double x_tol = wide ? 50 : 1e-3, v_tol = wide ? 3000 : 1e-2;
            const spring_batch b = batch_of(&p, features, most);
            size_t moving = 12345, want = 0;
            for (size_t i = 0; i < most; i++) {
                const spring_params one = spring_at(&p, features, i);
                const double x = (double)p.x[i], v = (double)p.v[i];
                const scalar a = (scalar)one.load, w = (scalar)one.stiffness;
                const double rest = (double)(a != 0 ? p.target[i] + a / w : p.target[i]);
                want += !(spring_params_valid(&one) && fabs(x - rest) <= x_tol && fabs(v) <= v_tol);
            }
            CHECK(spring_batch_follow_with(kernels, &b, p.target, 0, x_tol, v_tol, &moving) == SPRING_OK, "dt = 0");
            CHECK(moving == want, "springs that move are counted");
            CHECK(memcmp(&p, &before, sizeof p) == 0, "nothing moves");
        }
}

static scalar speeds[most];

static void draw_speeds(bool spoilt)
{
    for (size_t i = 0; i < most; i++)
        speeds[i] = (scalar)(random_bits() % 3 ? random_uniform(-1000, 1000) : random_bits() % 2 ? 0 : -0.0);
    if (spoilt)
        speeds[random_bits() % most] = bad_numbers[random_bits() % 3];
}

/* A spring of a batch that follows a moving target, alone. */
static outcome alone_moving(const place *p, unsigned features, size_t i, double dt, double x_tol, double v_tol)
{
    const spring_params one = spring_at(p, features, i);
    spring_state s = {(double)p->x[i], (double)p->v[i]};
    const double target = (double)p->target[i], speed = (double)speeds[i];
    const double rest = one.load != 0 ? target + one.load / one.stiffness : target;
    const spring_status status = spring_follow(&s, &one, target, speed, dt);
    if (status == SPRING_OK && dt != 0 && fabs(s.x - rest) <= x_tol && isfinite(rest)) {
        /* v - speed, as it is before the velocity of the target is added */
        spring_state relative = {(double)p->x[i] - (one.stiffness > 0 ? rest - (speed != 0 ? speed * dt : 0) : 0),
                                 (double)p->v[i] - speed};
        const spring_params unloaded = {1, one.stiffness, one.damping, one.stiffness > 0 ? 0 : one.load};
        spring_step_exact(&relative, &unloaded, dt);
        if (fabs(relative.v) <= v_tol)
            s = (spring_state){rest, speed};
    }
    return (outcome){(scalar)s.x, (scalar)s.v, status, !(status == SPRING_OK && s.x == rest && s.v == 0 && speed == 0)};
}

/* Moving targets: the bits of single springs in double, all roundings in single precision. A spring that fails keeps its
   state. */
static void moving_targets(void)
{
    static place p, before;
    static const double steps[] = {1.0 / 60, 1.0 / 240, 0.5, -0.01, 1e-6, 0};
    for (unsigned features = 0; features < all_features; features++)
        for (size_t i = 0; i < 60; i++) {
            const double dt = steps[i % 6], x_tol = i % 4 == 3 ? 50 : 0, v_tol = i % 4 == 3 ? 3000 : 0;
            draw(&p, dt != 0 ? dt : 1);
            draw_speeds(i % 3 == 0);
            if (i % 3 == 0)
                spoil(&p);
            before = p;
            const size_t count = i % 2 ? most : i * 3;
            const spring_batch b = batch_of(&p, features, count);
            size_t moving = 12345, moves = 0, differ = 0;
            bool fails = false;
            const spring_status status = spring_batch_follow_moving(&b, p.target, speeds, dt, x_tol, v_tol, &moving);
            for (size_t j = 0; j < count; j++) {
                const outcome want = alone_moving(&before, features, j, dt, x_tol, v_tol);
                moves += want.moving;
                fails |= want.status != SPRING_OK && dt != 0;
                differ += !same(p.x[j], want.x) || !same(p.v[j], want.v);
#ifdef SPRING_FLOAT
                const double omega = sqrt(spring_at(&before, features, j).stiffness), speed = (double)speeds[j];
                if (i % 3 != 0 && x_tol == 0 && omega > 0 && dt > 1e-3) {
                    const double size = fabs((double)before.x[j]) + fabs((double)before.target[j]) +
                                        fabs((double)before.a[j]) / omega / omega + fabs(speed * dt) +
                                        (fabs((double)before.v[j]) + fabs(speed)) / omega;
                    const double bound = 40 * eps * size + 2400 * eps * fabs((double)want.x);
                    CHECK_CLOSE((double)p.x[j], (double)want.x, bound, "roundings to float, and landing");
                }
#endif
            }
            if (sizeof(scalar) == sizeof(double) && dt != 0) {
                CHECK(status == (fails ? SPRING_EPARTIAL : SPRING_OK), "all other springs advance");
                CHECK(differ == 0, "the bits of single springs");
                CHECK(moving == moves, "springs that move, follow or fail are counted");
            }
            if (dt == 0)
                CHECK(memcmp(&p, &before, sizeof p) == 0 && status == SPRING_OK, "nothing moves");
        }
}

/* A target at constant velocity is followed without lag, and its spring moves along with it. Without velocities of
   targets, nothing differs from spring_batch_follow(). */
static void moving_targets_without_lag(void)
{
    static place p, other;
    draw_alike(&p, 6, 0.7);
    other = p;
    const spring_batch b = batch_of(&p, UNLOADED, most), c = batch_of(&other, UNLOADED, most);
    for (int i = 0; i < 200; i++) {
        size_t moving, same_moving;
        spring_batch_follow_moving(&b, p.target, NULL, 1.0 / 60, 0.01, 0.1, &moving);
        spring_batch_follow_with(kernels, &c, other.target, 1.0 / 60, 0.01, 0.1, &same_moving);
        CHECK(moving == same_moving || sizeof(scalar) == sizeof(float), "as many move");
        for (size_t j = 0; j < most; j++)
            CHECK_CLOSE((double)p.x[j], (double)other.x[j], sizeof(scalar) == sizeof(float) ? 0.02 : 0,
                        "the same step");
    }
    for (size_t j = 0; j < most; j++)
        speeds[j] = (scalar)random_uniform(1, 100);
    for (int i = 0; i < 400; i++) {
        size_t moving;
        for (size_t j = 0; j < most; j++)
            p.target[j] += speeds[j] / 64;
        spring_batch_follow_moving(&b, p.target, speeds, 1.0 / 64, 0, 0, &moving);
        CHECK(moving == most, "they move along");
    }
    for (size_t j = 0; j < most; j++) {
        const double lag = sizeof(scalar) == sizeof(float) ? 0.02 : 1e-9;
        CHECK_CLOSE((double)p.x[j], (double)p.target[j], lag, "rounding errors of targets below 8000");
        CHECK_CLOSE((double)p.v[j], (double)speeds[j], 20 * lag, "the velocity of the target");
    }
}

static void bad_input_changes_nothing(void)
{
    static place p, before;
    draw(&p, 1);
    before = p;
    const spring_batch good = batch_of(&p, 0, most);
    const struct {
        const spring_batch *b;
        const scalar *target;
        double dt, x_tol, v_tol;
    } bad[] = {
        {NULL, p.target, 0.1, 0, 0},      {&good, NULL, 0.1, 0, 0},         {&good, p.x + 3, 0.1, 0, 0},
        {&good, p.v + 3, 0.1, 0, 0},      {&good, p.target, NAN, 0, 0},     {&good, p.target, INFINITY, 0, 0},
        {&good, p.target, 0.1, -1e-9, 0}, {&good, p.target, 0.1, 0, -1e-9}, {&good, p.target, 0.1, NAN, 0},
        {&good, p.target, 0.1, 0, NAN},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        size_t moving = 12345;
        CHECK(spring_batch_follow(bad[i].b, bad[i].target, bad[i].dt, bad[i].x_tol, bad[i].v_tol, &moving) ==
                  SPRING_EINVAL,
              "bad input");
        CHECK(moving == 12345, "not written");
    }
    spring_batch unknown = good, shared = good;
    CHECK(spring_batch_follow_moving(&good, p.target, p.v + 3, 0.1, 0, 0, NULL) == SPRING_EINVAL, "overlaps");
    CHECK(spring_batch_follow_moving(&good, NULL, p.a, 0.1, 0, 0, NULL) == SPRING_EINVAL, "no targets");
    unknown.shared = 8;
    CHECK(spring_batch_follow(&unknown, p.target, 0.1, 0, 0, NULL) == SPRING_EINVAL, "an unknown bit");
    shared.shared = SPRING_SHARED_OMEGA2;
    const scalar negative = -1;
    shared.omega2 = &negative;
    CHECK(spring_batch_follow(&shared, p.target, 0.1, 0, 0, NULL) == SPRING_EINVAL, "a shared parameter");
    CHECK(memcmp(&p, &before, sizeof p) == 0, "nothing changed");
    const spring_batch none = {.count = 0};
    size_t moving = 12345;
    CHECK(spring_batch_follow(&none, NULL, 0.1, 0, 0, &moving) == SPRING_OK && moving == 0, "no springs");
}

int main(int argc, char **argv)
{
    static const test tests[] = {
        {"bits of single springs", bits_of_single_springs},
#ifdef SPRING_FLOAT
        {"near single springs", near_single_springs},
        {"lands", lands},
        {"stops near the target", stops_near_the_target},
#endif
        {"a step of 0 counts", no_step_counts},
        {"moving targets", moving_targets},
        {"moving targets without lag", moving_targets_without_lag},
        {"bad input", bad_input_changes_nothing},
    };
    const char *vectors = argc > 1 ? argv[1] : "v128";
    if (strcmp(vectors, "v128") == 0)
        kernels = &spring_batch_v128;
#if SPRING_LONG_VECTORS
    if (strcmp(vectors, "v256") == 0 && __builtin_cpu_supports("avx2"))
        kernels = &spring_batch_v256;
    if (strcmp(vectors, "v512") == 0 && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        kernels = &spring_batch_v512;
#endif
    if (argc > 2)
        springs = strtoul(argv[2], NULL, 10);
    if (kernels == NULL) {
        printf("1..0 # SKIP this processor or build has no %s\n", vectors);
        return 0;
    }
    return RUN_TESTS(sizeof(scalar) == sizeof(float) ? "follow_batchf" : "follow_batch", tests);
}
