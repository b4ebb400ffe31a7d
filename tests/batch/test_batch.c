/* SPDX-License-Identifier: MIT */
/*
 * Batches compared with single springs, for one instruction set: v128, v256 or v512 on the command line. Built twice:
 * once with SPRING_FLOAT, for the single-precision version.
 *
 * In double precision, results are bit-identical to spring_advance(). In single precision, they are bit-identical to
 * the kernels without vectors, which are close to spring_advance() in double precision.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/batch_kernels.h"
#include "spring/propagator.h"
#include "simd/targets.h"
#include "check.h"
#include "test_methods.h"

static const batch_kernels *kernels;

static spring_status advance(const spring_batch *b, spring_method m, double dt, uint64_t n)
{
    return spring_batch_advance_with(kernels, b, m, dt, n);
}

/* ---- what should become of a spring */

typedef struct spring {
    scalar x, v, w, g, a;
} spring;

typedef struct outcome {
    scalar x, v;
    spring_status status;
} outcome;

static spring_params params_of(spring s)
{
    return (spring_params){.mass = 1, .stiffness = (double)s.w, .damping = (double)s.g, .load = (double)s.a};
}

static spring_status advance_in_double(spring_state *state, spring s, spring_method m, scalar dt, uint64_t n)
{
    const spring_params p = params_of(s);
    *state = (spring_state){(double)s.x, (double)s.v};
    return spring_advance(state, &p, m, (double)dt, n);
}

#ifdef SPRING_FLOAT

extern const batch_kernels plain_batch;

/* By the kernels that know no vectors, as the only spring of a batch. */
static outcome plain_spring(spring s, spring_method m, scalar dt, uint64_t n, uint32_t shared)
{
    outcome end = {s.x, s.v, SPRING_OK};
    const spring_batch one = {1, &end.x, &end.v, &s.w, &s.g, s.a != 0 ? &s.a : NULL, shared};
    end.status = spring_batch_advance_with(&plain_batch, &one, m, dt, n);
    return end;
}

static outcome advance_alone(spring s, spring_method m, scalar dt, uint64_t n, bool shared_coefficients)
{
    outcome end = {s.x, s.v, SPRING_OK};
    spring_state state;
    if (advance_in_double(&state, s, m, 1, 0) != SPRING_OK) {
        end.status = SPRING_EINVAL;
    } else if (m != SPRING_EXACT || shared_coefficients) {
        end = plain_spring(s, m, dt, n, shared_coefficients ? SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA : 0);
        CHECK(end.status == SPRING_OK || (end.status == SPRING_EPARTIAL && end.x == s.x && end.v == s.v),
              "valid; it advances or keeps its state");
        end.status = end.status == SPRING_OK ? SPRING_OK : SPRING_ENONFINITE;
    } else { /* with coefficients of its own: in double, rounded once */
        end.status = advance_in_double(&state, s, m, dt, n);
        end.x = (float)state.x;
        end.v = (float)state.v;
        if (end.status != SPRING_OK || !isfinite(end.x) || !isfinite(end.v))
            end = (outcome){s.x, s.v, SPRING_ENONFINITE};
    }
    return end;
}

#else

static outcome advance_alone(spring s, spring_method m, scalar dt, uint64_t n, bool shared_coefficients)
{
    (void)shared_coefficients;
    spring_state state;
    const spring_status status = advance_in_double(&state, s, m, dt, n);
    return (outcome){state.x, state.v, status};
}

#endif

/* ---- batches, and what lies around them */

enum { most = 1000, edge = 64 / sizeof(scalar), room = most + 2 * edge, arrays = 5, feature_count = 18 };
static const scalar outside = (scalar)NAN; /* to be neither read nor written */

typedef struct place {
    _Alignas(64) scalar of[arrays][room];
} place;

enum sharing { SHARED, EACH, NONE }; /* one element for all, one each, not modelled */

typedef struct features {
    enum sharing w, g, a;
} features;

static features features_of(size_t i)
{
    return (features){i % 2 ? SHARED : EACH, (enum sharing)(i / 2 % 3), (enum sharing)(i / 6 % 3)};
}

/* Spring i of a batch with these features, of which spring 0 gives what is shared. */
static spring seen(const spring *s, size_t i, features f)
{
    spring one = s[i];
    one.w = s[f.w == SHARED ? 0 : i].w;
    one.g = f.g == NONE ? 0 : s[f.g == SHARED ? 0 : i].g;
    one.a = f.a == NONE ? 0 : s[f.a == SHARED ? 0 : i].a;
    return one;
}

/* A bit for an array that is absent has no meaning, so there it is random. */
static bool shared_bit(enum sharing s)
{
    return s == SHARED || (s == NONE && random_bits() % 2);
}

static uint32_t shared_bits(features f)
{
    return (f.w == SHARED ? SPRING_SHARED_OMEGA2 : 0) | (shared_bit(f.g) ? SPRING_SHARED_GAMMA : 0) |
           (shared_bit(f.a) ? SPRING_SHARED_ACCEL : 0);
}

/* Lays a batch out, every array at an alignment of its own. */
static spring_batch lay_out(place *p, const spring *s, size_t count, features f)
{
    scalar *at[arrays];
    for (size_t i = 0; i < arrays; i++) {
        for (size_t j = 0; j < room; j++)
            p->of[i][j] = outside;
        at[i] = p->of[i] + random_bits() % edge;
    }
    for (size_t i = 0; i < count; i++) {
        at[0][i] = s[i].x;
        at[1][i] = s[i].v;
        if (f.w != SHARED || i == 0)
            at[2][i] = s[i].w;
        if (f.g == EACH || (f.g == SHARED && i == 0))
            at[3][i] = s[i].g;
        if (f.a == EACH || (f.a == SHARED && i == 0))
            at[4][i] = s[i].a;
    }
    return (spring_batch){count,         at[0], at[1], at[2], f.g == NONE ? NULL : at[3], f.a == NONE ? NULL : at[4],
                          shared_bits(f)};
}

/* All arrays and what is around them, bit for bit. Says where they first differ. */
static void check_place(const place *got, const place *want, const char *why)
{
    if (memcmp(got, want, sizeof *got) == 0)
        return;
    const scalar *a = &got->of[0][0], *b = &want->of[0][0];
    while (memcmp(a, b, sizeof *a) == 0) {
        a++;
        b++;
    }
    CHECK_BITS((double)*a, (double)*b, why);
    CHECK(false, why); /* NaN of different bits */
}

static void check_batch(const spring *s, size_t count, features f, spring_method m, scalar dt, uint64_t n,
                        const outcome *want)
{
    static place got, expected;
    const spring_batch b = lay_out(&got, s, count, f);
    spring_status status = SPRING_OK;
    char why[120];
    snprintf(why, sizeof why, "%s, %zu springs, %d steps of %g s, sharing of w %d, g %d, a %d", spring_method_name(m),
             count, (int)n, (double)dt, (int)f.w, (int)f.g, (int)f.a);
    expected = got;
    for (size_t i = 0; i < count; i++) {
        expected.of[0][b.x - got.of[0] + (ptrdiff_t)i] = want[i].x;
        expected.of[1][b.v - got.of[1] + (ptrdiff_t)i] = want[i].v;
        status = want[i].status == SPRING_OK ? status : SPRING_EPARTIAL;
    }
    const place start = got;
    CHECK(advance(&b, m, dt, n) == status, why);
    check_place(&got, &expected, why);

    if (random_bits() % 4 != 0) /* the rest is the same for all kernels */
        return;
    got = start;
    CHECK(spring_batch_advance(&b, m, dt, n) == status, why);
    check_place(&got, &expected, "the same bits with the instruction set that the library chooses");
    uint8_t failed[most + 1];
    memset(failed, 77, sizeof failed);
    got = start;
    CHECK(spring_batch_advance_marked(&b, m, dt, n, failed) == status, why);
    check_place(&got, &expected, why);
    bool marks = failed[count] == 77;
    for (size_t i = 0; i < count; i++)
        marks = marks && failed[i] == want[i].status;
    CHECK(marks, "the status of each spring");
}

static scalar any_sign(scalar zero_or_more)
{
    return random_bits() % 2 ? zero_or_more : -zero_or_more;
}

/* Of every kind, zeros of both signs included. The heavily damped ones are beyond the limits of Euler and RK4: over
   thousands of steps they overflow, and with leapfrog they come to rest among denormal numbers. */
static spring random_spring(void)
{
    static const double heavy[] = {60, 300}, tiny = 3e-42; /* half steps of damping 1.5 and 7.5 */
    spring s = {(scalar)random_uniform(-1, 1), (scalar)random_uniform(-1, 1), (scalar)random_log(0.1, 10),
                (scalar)random_log(1e-4, 1), (scalar)random_uniform(-1, 1)};
    const uint64_t kind = random_bits();
    if (kind % 8 == 0)
        s.x = any_sign(kind % 16 == 0 ? 0 : (scalar)tiny);
    if (kind / 16 % 8 == 0)
        s.v = any_sign(kind / 16 % 16 == 0 ? 0 : (scalar)tiny);
    if (kind / 256 % 8 == 0)
        s.w = any_sign(0);
    if (kind / 4096 % 4 == 0)
        s.g = kind / 4096 % 8 == 0 ? (scalar)heavy[kind / 32768 % 2] : any_sign(0);
    if (kind / 65536 % 4 == 0)
        s.a = any_sign(0);
    return s;
}

static const scalar huge_number = sizeof(scalar) == 4 ? (scalar)FLT_MAX : (scalar)DBL_MAX;

/* Spring 0 gives what is shared, so it stays valid. */
static void spoil(spring *s)
{
    const scalar bad[] = {NAN, INFINITY, -INFINITY}, negative = random_bits() % 2 ? -1 : -(scalar)1e-44;
    scalar *const fields[] = {&s->x, &s->v, &s->w, &s->g, &s->a};
    const uint64_t i = random_bits() % 5, not_finite = random_bits() % 2;
    if (not_finite || i == 4)
        *fields[i] = bad[random_bits() % 3];
    else if (i < 2)
        *fields[i] = any_sign(huge_number);
    else
        *fields[i] = random_bits() % 2 ? negative : huge_number;
}

/* ---- properties */

static const scalar step = (scalar)0.05;
static spring springs[most];
static outcome ends[most];

static void draw(uint64_t bad_of_1024)
{
    for (size_t i = 0; i < most; i++) {
        springs[i] = random_spring();
        if (i > 0 && random_bits() % 1024 < bad_of_1024)
            spoil(&springs[i]);
    }
}

/* Every method, combination of features, number of springs and number of steps; many steps with one number of springs. */
static void sweep(scalar dt, uint64_t bad_of_1024)
{
    static const size_t counts[] = {0, 1, 7, 8, 9, 63, 64, 65, 127, 128, 129, most};
    static const uint64_t steps[] = {1, 2, 16, 4097};
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        for (size_t k = 0; k < feature_count * 4; k++) {
            const features f = features_of(k);
            const uint64_t n = steps[k / feature_count];
            const size_t largest = n == 4097 ? 129 : most;
            draw(bad_of_1024);
            for (size_t i = 0; i < largest; i++)
                ends[i] = advance_alone(seen(springs, i, f), *m, dt, n, f.w == SHARED && f.g != EACH);
            for (size_t i = 0; i < sizeof counts / sizeof counts[0] && counts[i] <= largest; i++)
                if (n < 4097 || counts[i] == largest)
                    check_batch(springs, counts[i], f, *m, dt, n, ends);
        }
}

static void every_batch(void)
{
    sweep(step, 0);
    sweep(-step / 64, 0); /* backwards */
}

/* Bad springs keep their state, and all others advance. */
static void bad_neighbours(void)
{
    sweep(step, 1); /* one or none */
    sweep(step, 128);
    sweep(-step, 896);
}

/* The array of one parameter from spring `first` on. */
static const scalar *from(const scalar *array, enum sharing s, size_t first)
{
    return s == NONE ? NULL : s == SHARED ? array : array + first;
}

/* Arrays of exactly the right size, for tools that watch memory, in one call or several. */
static void in_several_calls(size_t count, features f, spring_method m, size_t pieces)
{
    scalar *of[arrays];
    for (size_t k = 0; k < arrays; k++) {
        of[k] = malloc(count * sizeof(scalar));
        CHECK(of[k] != NULL, "memory");
        for (size_t i = 0; i < count; i++) {
            const spring *s = &springs[i % most];
            of[k][i] = (const scalar[]){s->x, s->v, s->w, s->g, s->a}[k];
        }
    }
    for (size_t k = 0; k < pieces; k++) {
        const size_t first = count * k / pieces, after = count * (k + 1) / pieces;
        const spring_batch b = {after - first,           of[0] + first,           of[1] + first,
                                from(of[2], f.w, first), from(of[3], f.g, first), from(of[4], f.a, first),
                                shared_bits(f)};
        CHECK(advance(&b, m, step, 3) == SPRING_OK, "good input");
    }
    for (size_t i = 0; i < most; i++)
        ends[i] = advance_alone(seen(springs, i, f), m, step, 3, f.w == SHARED && f.g != EACH);
    size_t wrong = 0;
    for (size_t i = 0; i < count; i++)
        wrong += memcmp(&of[0][i], &ends[i % most].x, sizeof(scalar)) != 0 ||
                 memcmp(&of[1][i], &ends[i % most].v, sizeof(scalar)) != 0;
    CHECK(wrong == 0, "a spring's bits do not depend on its batch or its place in it");
    for (size_t k = 0; k < arrays; k++)
        free(of[k]);
}

static void pieces(void)
{
    draw(0);
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        for (size_t k = 0; k < feature_count; k++)
            for (size_t count = 1; count < 300; count += 64)
                in_several_calls(count, features_of(k), *m, 1 + k % 7);
    in_several_calls(1000003, (features){SHARED, EACH, EACH}, SPRING_RK4, 3);
}

/* Once every spring of a batch has overflowed, no number of steps takes long: so many equal springs overflow in the
   first of 10^12 steps, and the call ends. */
static void check_ends(spring one, size_t count, features f, spring_method m)
{
    static place got, want;
    for (size_t i = 0; i < count; i++)
        springs[i] = one;
    const spring_batch b = lay_out(&got, springs, count, f);
    want = got;
    CHECK(advance(&b, m, 5, 1000000000000) == SPRING_EPARTIAL, "all overflow");
    check_place(&got, &want, "all keep their state");
}

static void overflow_ends(void)
{
    const scalar w = (scalar)2.7, g = (scalar)0.6, a = (scalar)0.4, half = (scalar)0.5;
    for (size_t k = 0; k < feature_count; k++)
        for (size_t rest = 1; rest <= 1 + k; rest += k + (k == 0)) { /* a single spring, too, is lost as a whole */
            const features f = features_of(k);
            for (const spring_method *m = steppers(); *m != no_method; m++) {
                check_ends((spring){1, 0, w, g, a}, 128 + rest, f, *m);
                check_ends((spring){0, half, w, g, a}, 128 + rest, f, *m);
                if (f.a == EACH) /* by its load alone */
                    check_ends((spring){0, 0, w, g, a}, 128 + rest, f, *m);
            }
            if (f.g == EACH) /* by its damping alone */
                check_ends((spring){1, 0, (scalar)1e-12, 900, a}, 128 + rest, f, SPRING_EULER);
        }
}

/* Springs of every kind side by side, of all sizes: by any formula, or one that is not finite, each is what it is
   alone. */
static void exact_of_any_spring(void)
{
    const double far = sizeof(scalar) == 4 ? 1e30 : 1e250;
    const scalar lengths[] = {step, -step, 1000, (scalar)1e-9, (scalar)1e20, huge_number}; /* n dt may overflow */
    for (size_t k = 0; k < 24 * feature_count; k++) {
        const features f = features_of(k);
        const scalar dt = lengths[k / feature_count % 6];
        const uint64_t n = 1 + random_bits() % 7;
        draw(k % 3 * 128);
        for (size_t i = 0; i < most; i++) {
            spring *s = &springs[i];
            const uint64_t kind = random_bits() % 8;
            if (kind == 0) /* critically damped */
                s->g = (scalar)random_log(1e-3, 1e3), s->w = s->g * s->g / 4;
            if (kind == 1)
                s->w = (scalar)random_log(1 / far, far);
            if (kind == 2)
                s->g = (scalar)random_log(1 / far, far);
            if (kind == 3)
                s->w = (scalar)random_log(1 / far, far),
                s->g = 2 * (scalar)(sqrt((double)s->w) * random_log(1e-5, 1e5));
            if (kind == 4)
                s->x *= huge_number, s->v *= huge_number;
        }
        for (size_t i = 0; i < most; i++)
            ends[i] = advance_alone(seen(springs, i, f), SPRING_EXACT, dt, n, f.w == SHARED && f.g != EACH);
        check_batch(springs, most, f, SPRING_EXACT, dt, n, ends);
    }
}

static void nothing_to_do(void)
{
    static place got, want;
    for (size_t k = 0; k < feature_count; k++) {
        draw(128);
        const spring_batch b = lay_out(&got, springs, 129, features_of(k)), empty = {0};
        want = got;
        for (const spring_method *m = spring_methods(); *m != no_method; m++) {
            const spring_method method = *m;
            CHECK(advance(&b, method, step, 0) == SPRING_OK, "n = 0");
            CHECK(advance(&b, method, 0, 5) == SPRING_OK, "dt = 0");
            CHECK(advance(&b, method, -(scalar)0, UINT64_MAX) == SPRING_OK, "dt = -0");
            CHECK(advance(&empty, method, step, 5) == SPRING_OK, "no springs, no arrays");
            uint8_t failed[129] = {77};
            CHECK(spring_batch_advance_marked(&b, method, step, 0, failed) == SPRING_OK && failed[0] == 0,
                  "none failed");
        }
        check_place(&got, &want, "changes nothing");
    }
}

/* ---- bad batches */

static scalar memory[400];

static spring_status ask(const spring_batch *b, spring_method m, double dt)
{
    for (size_t i = 0; i < sizeof memory / sizeof memory[0]; i++)
        memory[i] = (scalar)0.5 + (scalar)i / 1024;
    return advance(b, m, dt, 3);
}

static void refuse(const spring_batch *b, spring_method m, double dt, const char *why)
{
    uint8_t failed = 77;
    CHECK(ask(b, m, dt) == SPRING_EINVAL, why);
    CHECK(spring_batch_advance_marked(b, m, dt, 3, &failed) == SPRING_EINVAL && failed == 77, why);
    bool same = true;
    for (size_t i = 0; i < sizeof memory / sizeof memory[0]; i++)
        same = same && memory[i] == (scalar)0.5 + (scalar)i / 1024;
    CHECK(same, "nothing has changed");
    if (isfinite((scalar)dt)) /* what is wrong is the batch or the method */
        CHECK(isnan(spring_batch_stable_step(b, m)), why);
}

static const spring_batch good = {10, memory + 100, memory + 200, memory + 300, memory + 320, memory + 340, 0};

static void overlaps(void)
{
    for (int shared = 0; shared <= 7; shared++)
        for (int i = -11; i <= 11; i++) {
            spring_batch b = good;
            b.shared = (uint32_t)shared;
            b.v = b.x + i;
            if (i > -10 && i < 10)
                refuse(&b, SPRING_EULER, step, "x over v");
            else
                CHECK(ask(&b, SPRING_EULER, step) == SPRING_OK, "side by side");
            for (int j = 0; j < 6; j++) {
                scalar *const state = j % 2 ? good.v : good.x;
                const scalar **const parameter = j / 2 == 0 ? &b.omega2 : j / 2 == 1 ? &b.gamma : &b.accel;
                const int length = shared >> (j / 2) & 1 ? 1 : 10; /* the bits are in this order */
                b = good;
                b.shared = (uint32_t)shared;
                *parameter = state + i;
                if (i > -length && i < 10)
                    refuse(&b, SPRING_EULER, step, "a parameter over the state");
                else
                    CHECK(ask(&b, SPRING_EULER, step) == SPRING_OK, "side by side");
            }
        }
    spring_batch b = good;
    b.gamma = b.accel = b.omega2;
    CHECK(ask(&b, SPRING_RK4, step) == SPRING_OK, "parameters may be one array");
}

static void bad_batches(void)
{
    const scalar *const m0 = memory + 300;
    scalar *const x = good.x, *const v = good.v;
    const struct {
        spring_batch b;
        const char *why;
    } bad[] = {{{10, NULL, v, m0, m0, m0, 0}, "no x"},
               {{10, x, NULL, m0, m0, m0, 0}, "no v"},
               {{10, x, v, NULL, m0, m0, 0}, "no omega2"},
               {{10, x, v, m0, m0, m0, 8}, "an unknown bit"},
               {{10, x, v, m0, m0, m0, UINT32_C(1) << 31}, "an unknown bit"},
               {{0, x, v, m0, m0, m0, 16}, "an unknown bit, even without springs"},
               {{SIZE_MAX / sizeof(scalar) + 1, x, v, m0, m0, m0, 0}, "more bytes than can be counted"},
               {{SIZE_MAX / sizeof(scalar) + 19, x, v, m0, m0, m0, 0}, "more bytes than can be counted"}};
    CHECK(ask(&good, SPRING_LEAPFROG, step) == SPRING_OK, "good input");
    CHECK(spring_batch_advance_marked(&good, SPRING_LEAPFROG, step, 3, NULL) == SPRING_EINVAL, "no marks");
    const scalar *const read_or_written[] = {good.x, good.v, good.omega2, good.gamma, good.accel};
    for (size_t i = 0; i < sizeof read_or_written / sizeof read_or_written[0]; i++)
        for (ptrdiff_t at = -9; at < (ptrdiff_t)(10 * sizeof(scalar)); at += 11)
            CHECK(spring_batch_advance_marked(&good, SPRING_LEAPFROG, step, 3,
                                              (uint8_t *)(uintptr_t)read_or_written[i] + at) == SPRING_EINVAL,
                  "marks over another array");
    refuse(NULL, SPRING_LEAPFROG, step, "no batch");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        refuse(&bad[i].b, SPRING_LEAPFROG, step, bad[i].why);
    for (int m = -2; m < 100; m++)
        if (m < 0 || m >= SPRING_METHOD_COUNT)
            refuse(&good, (spring_method)m, step, "no such method");
    const scalar lengths[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < 3; i++)
        refuse(&good, SPRING_LEAPFROG, lengths[i], "dt not finite");
}

/* Only a load may be negative. -0 is not negative. */
static void bad_shared_parameters(void)
{
    const scalar values[] = {NAN, INFINITY, -INFINITY, -1, -(scalar)1e-44, -(scalar)0};
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        for (size_t i = 0; i < 3 * 6; i++) {
            const scalar *const value = &values[i / 3];
            spring_batch b = good;
            *(i % 3 == 0 ? &b.omega2 : i % 3 == 1 ? &b.gamma : &b.accel) = value;
            b.shared = UINT32_C(1) << i % 3; /* the bits are in this order */
            if (isfinite(*value) && (*value == 0 || b.shared == SPRING_SHARED_ACCEL))
                CHECK(ask(&b, *m, step) == SPRING_OK, "good input");
            else
                refuse(&b, *m, step, "a bad parameter for all springs");
        }
}

#ifdef SPRING_FLOAT

/* A time step is double in both precisions. Here it is rounded to float once, at the start. */
static void steps_are_rounded(void)
{
    const double rounded[] = {0.05, -1.0 / 3, 0x1.fffffefffffffp127, 0x1.8p-149, -0x1p-130 / 3};
    const double zero[] = {0x1p-150, -0x1p-151, 1e-300, -DBL_TRUE_MIN};
    const double too_large[] = {0x1.ffffffp127, 1e39, -1e300, DBL_MAX, NAN, INFINITY, -INFINITY};
    static place got, start;
    draw(0);
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        for (size_t shared = 0; shared < feature_count; shared++) {
            const spring_batch b = lay_out(&got, springs, 129, features_of(shared));
            start = got;
            for (size_t k = 0; k < sizeof rounded / sizeof rounded[0]; k++) {
                got = start;
                const spring_status status = spring_batch_advance(&b, *m, rounded[k], 3);
                const place done = got;
                got = start;
                CHECK(advance(&b, *m, (float)rounded[k], 3) == status, "the step is rounded");
                check_place(&got, &done, "the step is rounded");
            }
            got = start;
            for (size_t k = 0; k < sizeof zero / sizeof zero[0]; k++)
                CHECK(advance(&b, *m, zero[k], UINT64_MAX) == SPRING_OK, "a step that rounds to 0");
            check_place(&got, &start, "changes nothing");
            for (size_t k = 0; k < sizeof too_large / sizeof too_large[0]; k++)
                refuse(&good, *m, too_large[k], "a step that is not finite as a float");
        }
}

#endif

/* ---- stable step */

/* Shared coefficients of the exact solution are rounded once, so their errors add up. An undamped spring has F = G = c and
   H wH = 1 - c^2 before rounding. F and G are below 1 and are rounded by at most eps/4, H and wH by eps/2 of themselves.
   So the amplitude, sqrt(F G + H wH), changes by at most eps (c + 2 - 2 c^2)/4, which is below 0.54 eps. */
static void shared_exact_solution_drifts(void)
{
    const uint64_t calls = 20000;
    for (int i = 0; i < 40; i++) {
        scalar x = 1, v = 0;
        const scalar w = (scalar)random_log(1, 1000);
        const spring_batch b = {.count = 1, .x = &x, .v = &v, .omega2 = &w, .shared = SPRING_SHARED_OMEGA2};
        for (uint64_t k = 0; k < calls; k++)
            if (advance(&b, SPRING_EXACT, 1.0 / 240, 1) != SPRING_OK)
                break;
        const double size = hypot((double)x, (double)v / sqrt((double)w));
        const double random = 8 * sqrt((double)calls) * (double)SCALAR_EPSILON;
        CHECK_CLOSE(size, 1, 0.54 * (double)calls * (double)SCALAR_EPSILON + random, "the amplitude");
    }
}

static void stable_step(void)
{
    static place p;
    const spring_batch empty = {0}, empty_shared = {.omega2 = &step, .shared = SPRING_SHARED_OMEGA2};
    CHECK(isnan(spring_batch_stable_step(&empty, SPRING_RKN8)), "not for springs");
    for (const spring_method *m = spring_methods(); *m != no_method; m++) {
        const spring_method method = *m;
        CHECK_BITS(spring_batch_stable_step(&empty, method), INFINITY, "no springs");
        CHECK_BITS(spring_batch_stable_step(&empty_shared, method), INFINITY, "no springs");
        for (size_t k = 0; k < feature_count; k++) {
            const features f = features_of(k);
            for (size_t count = 1; count < 40; count += 19) {
                draw(0);
                double least = INFINITY;
                for (size_t i = 0; i < count; i++) {
                    const spring_params one = params_of(seen(springs, i, f));
                    least = fmin(least, spring_stable_step(&one, method));
                }
                const spring_batch b = lay_out(&p, springs, count, f);
                CHECK_BITS(spring_batch_stable_step(&b, method), (double)(scalar)least, "the least of all");
                b.x[0] = NAN;
                CHECK_BITS(spring_batch_stable_step(&b, method), (double)(scalar)least, "whatever the state");
            }
        }
        for (size_t i = 0; i < 30; i++) { /* one bad spring */
            draw(0);
            springs[i % 10].w = i < 10 ? (scalar)NAN : springs[i % 10].w;
            springs[i % 10].g = i / 10 == 1 ? -1 : springs[i % 10].g;
            springs[i % 10].a = i / 10 == 2 ? (scalar)INFINITY : springs[i % 10].a;
            const features all = {EACH, EACH, EACH}, load = {SHARED, NONE, EACH};
            const spring_batch b = lay_out(&p, springs, 10, i / 10 == 2 ? load : all);
            CHECK(isnan(spring_batch_stable_step(&b, method)), "a bad spring");
        }
    }
}

#ifdef SPRING_FLOAT

/* ---- how near to double it is */

/* Each step of a stepper rounds by 2 eps (1 + z^2)^2 of (x, v/omega) at most, as in double (tests/spring/test_iterate.c). No
   step of exp(hM) makes that longer, and what a stepper differs by is at most (hM)^2/2, 2 z^2 of the length. */
static void near_double(void)
{
    for (int i = 0; i < 1000; i++) {
        const features each = {EACH, EACH, EACH};
        const uint64_t n = 1 + random_bits() % 64;
        const spring s = {(scalar)random_uniform(-1, 1), (scalar)random_uniform(-1, 1), (scalar)random_log(0.1, 10),
                          (scalar)random_log(1e-4, 3), (scalar)random_uniform(-1, 1)};
        const double omega = sqrt((double)s.w), z = fmax(omega, (double)s.g) * (double)step, steps = (double)n;
        const double grown = exp(2 * z * z * steps);
        const double size = hypot((double)s.x, (double)s.v / omega) + steps * (double)step * fabs((double)s.a) / omega;
        const double bound = steps * 2 * (double)FLT_EPSILON * pow(1 + z * z, 2) * size * grown * grown;
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            static place p;
            const spring_batch b = lay_out(&p, &s, 1, each);
            spring_state want;
            CHECK(advance(&b, *m, step, n) == SPRING_OK && advance_in_double(&want, s, *m, step, n) == SPRING_OK,
                  "good input");
            CHECK_CLOSE((double)b.x[0], want.x, bound, "n steps, each rounded by 2 eps (1 + z^2)^2");
            CHECK_CLOSE((double)b.v[0], want.v, bound * omega, "n steps, each rounded by 2 eps (1 + z^2)^2");
        }
    }
}

/* With coefficients for all springs every term of x and v goes through five roundings, and the load's part through the
   last of its sum as well. With coefficients of its own a spring is rounded once: tested to the bit above. */
static void exact_near_double(void)
{
    const double eps = 3 * (double)FLT_EPSILON;
    for (int i = 0; i < 3000; i++) {
        spring s = random_spring();
        s.g = i % 2 ? s.g : (scalar)random_log(1e-4, 30);
        const uint64_t n = random_bits() % 400 + 1;
        static place p;
        const spring_batch b = lay_out(&p, &s, 1, (features){SHARED, SHARED, EACH});
        const spring_params one = params_of(s);
        const spring_quotients r = spring_quotients_of(one.stiffness, one.damping, one.mass);
        const spring_propagator y = spring_propagator_of(&r, (double)step * (double)n, true);
        spring_state want;
        CHECK(advance(&b, SPRING_EXACT, step, n) == SPRING_OK &&
                  advance_in_double(&want, s, SPRING_EXACT, step, n) == SPRING_OK,
              "good input");
        const double x = fabs((double)s.x), v = fabs((double)s.v), a = fabs((double)s.a);
        const double smallest = 1e-44; /* some roundings of denormal numbers */
        CHECK_CLOSE((double)b.x[0], want.x, eps * (y.half * (fabs(y.F) * x + fabs(y.H) * v) + fabs(y.P) * a) + smallest,
                    "five roundings in float");
        CHECK_CLOSE((double)b.v[0], want.v, eps * y.half * (fabs(y.G) * v + fabs(y.wH) * x + fabs(y.H) * a) + smallest,
                    "five roundings in float");
    }
}

#endif

/* ---- main */

/* Sets kernels. Returns why not, or NULL. */
static const char *choose(const char *name)
{
    kernels = &spring_batch_v128;
    if (strcmp(name, "v128") == 0)
        return NULL;
#if SPRING_LONG_VECTORS
    const bool wide = strcmp(name, "v512") == 0;
    kernels = wide ? &spring_batch_v512 : &spring_batch_v256;
    if (wide && !(__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")))
        return "this processor has no AVX-512";
    return __builtin_cpu_supports("avx2") ? NULL : "this processor has no AVX2";
#else
    return "this build has only vectors of 16 bytes";
#endif
}

int main(int argc, char **argv)
{
    static const test tests[] = {
        {"every spring is bitwise identical to one advanced alone", every_batch},
        {"bad springs keep their state, all others advance", bad_neighbours},
        {"a million springs, and batches in several calls", pieces},
        {"overflow ends a batch", overflow_ends},
        {"the exact solution of any spring", exact_of_any_spring},
        {"nothing to do", nothing_to_do},
        {"overlapping arrays", overlaps},
        {"bad batches", bad_batches},
        {"bad shared parameters", bad_shared_parameters},
        {"shared exact solution drifts", shared_exact_solution_drifts},
        {"stable step", stable_step},
#ifdef SPRING_FLOAT
        {"a step is rounded to float", steps_are_rounded},
        {"near double", near_double},
        {"exact solution near double", exact_near_double},
#endif
    };
    if (argc != 2)
        return EXIT_FAILURE;
    const char *lacking = choose(argv[1]);
    if (lacking != NULL) {
        printf("1..0 # SKIP %s\n", lacking);
        return EXIT_SUCCESS;
    }
    return RUN_TESTS("batch", tests);
}
