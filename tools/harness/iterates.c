/* SPDX-License-Identifier: MIT */
/*
 * Textbook versions of the methods; see iterates.h.
 *
 * Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), sections I.7 and II.1 (Euler,
 *           RK4); Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 *           (symplectic Euler, leapfrog); Dormand, El-Mikkawy, Prince, High-order embedded Runge-Kutta-Nystrom
 *           formulae, IMA J. Numer. Anal. 7 (1987); Blanes, Moan, Practical symplectic partitioned Runge-Kutta and
 *           Runge-Kutta-Nystrom methods, J. Comput. Appl. Math. 142 (2002), SRKN11b
 */
#include "harness/iterates.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const mpfr_rnd_t nearest = MPFR_RNDN;

/* a - w x - g v */
static void spring_acceleration(mpfr_t out, const iterate_rates *r, const mpfr_t x, const mpfr_t v)
{
    mpfr_fmma(out, r->w, x, r->g, v, nearest);
    mpfr_sub(out, r->a, out, nearest);
}

static void scene_acceleration(const iterate_scene *s, double t, const double *x, const double *v, double *a)
{
    s->acceleration(s->data, t, x, v, a);
    for (size_t i = 0; i < s->count; i++)
        a[i] -= s->drag[i] * v[i];
}

/* ------------------------------------------------------------------------------------------------ explicit Euler */

static void euler_spring(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h)
{
    mpfr_t a;
    mpfr_init2(a, mpfr_get_prec(x));
    spring_acceleration(a, r, x, v);
    mpfr_fma(x, h, v, x, nearest);
    mpfr_fma(v, h, a, v, nearest);
    mpfr_clear(a);
}

static void euler_scene(const iterate_scene *s, double t, double h, double *x, double *v)
{
    double *a = s->room;
    scene_acceleration(s, t, x, v, a);
    for (size_t i = 0; i < s->count; i++) {
        x[i] += h * v[i];
        v[i] += h * a[i];
    }
}

/* ---------------------------------------------------------------------------------------------- symplectic Euler */

static void symplectic_euler_spring(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h)
{
    mpfr_t a, zero;
    mpfr_inits2(mpfr_get_prec(x), a, zero, (mpfr_ptr)NULL);
    mpfr_set_zero(zero, 1);
    spring_acceleration(a, r, x, zero);
    mpfr_fma(v, h, a, v, nearest);
    mpfr_mul(a, h, r->g, nearest);
    mpfr_add_ui(a, a, 1, nearest);
    mpfr_div(v, v, a, nearest);
    mpfr_fma(x, h, v, x, nearest);
    mpfr_clears(a, zero, (mpfr_ptr)NULL);
}

static void symplectic_euler_scene(const iterate_scene *s, double t, double h, double *x, double *v)
{
    double *a = s->room;
    s->acceleration(s->data, t, x, v, a);
    for (size_t i = 0; i < s->count; i++) {
        v[i] = (v[i] + h * a[i]) / (1 + h * s->drag[i]);
        x[i] += h * v[i];
    }
}

/* ------------------------------------------------------------------------------------------------------ leapfrog */

static void leapfrog_spring(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h)
{
    mpfr_t a, half, zero;
    mpfr_inits2(mpfr_get_prec(x), a, half, zero, (mpfr_ptr)NULL);
    mpfr_set_zero(zero, 1);
    mpfr_div_ui(half, h, 2, nearest);
    spring_acceleration(a, r, x, v);
    mpfr_fma(v, half, a, v, nearest);
    mpfr_fma(x, h, v, x, nearest);
    spring_acceleration(a, r, x, zero);
    mpfr_fma(v, half, a, v, nearest);
    mpfr_mul(a, half, r->g, nearest);
    mpfr_add_ui(a, a, 1, nearest);
    mpfr_div(v, v, a, nearest);
    mpfr_clears(a, half, zero, (mpfr_ptr)NULL);
}

/* v1 = (v' + h/2 a)/(1 + h/2 drag) */
static void last_kick(const iterate_scene *s, double h, const double *a, const double *v, double *v1)
{
    for (size_t i = 0; i < s->count; i++)
        v1[i] = (v[i] + h / 2 * a[i]) / (1 + h / 2 * s->drag[i]);
}

/* Forces that depend on velocity are evaluated with a predicted velocity: the last kick with the acceleration at the
   start of the step. The resulting acceleration also starts the next step. Other forces are not affected. */
static void leapfrog_scene(const iterate_scene *s, double t, double h, double *x, double *v)
{
    double *a = s->room, *predicted = s->room + s->count;
    if (s->step == 0 || s->changes)
        s->acceleration(s->data, t, x, v, a);
    for (size_t i = 0; i < s->count; i++) {
        v[i] += h / 2 * (a[i] - s->drag[i] * v[i]);
        x[i] += h * v[i];
    }
    last_kick(s, h, a, v, predicted);
    s->acceleration(s->data, t + h, x, predicted, a);
    last_kick(s, h, a, v, v);
}

/* ----------------------------------------------------------------------------------------------------------- RK4 */

enum { RK4_STAGES = 4 };
static const int rk4_at[RK4_STAGES] = {0, 1, 1, 2}; /* in half steps */
static const unsigned rk4_weight[RK4_STAGES] = {1, 2, 2, 1};

static void rk4_spring(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h)
{
    mpfr_t kx, kv, sum_x, sum_v, stage_x, stage_v, part;
    mpfr_inits2(mpfr_get_prec(x), kx, kv, sum_x, sum_v, stage_x, stage_v, part, (mpfr_ptr)NULL);
    mpfr_set_zero(kx, 1);
    mpfr_set_zero(kv, 1);
    mpfr_set_zero(sum_x, 1);
    mpfr_set_zero(sum_v, 1);
    for (int i = 0; i < RK4_STAGES; i++) {
        mpfr_mul_si(part, h, rk4_at[i], nearest);
        mpfr_div_ui(part, part, 2, nearest);
        mpfr_fma(stage_x, part, kx, x, nearest);
        mpfr_fma(stage_v, part, kv, v, nearest);
        mpfr_set(kx, stage_v, nearest);
        spring_acceleration(kv, r, stage_x, stage_v);
        mpfr_mul_ui(part, kx, rk4_weight[i], nearest);
        mpfr_add(sum_x, sum_x, part, nearest);
        mpfr_mul_ui(part, kv, rk4_weight[i], nearest);
        mpfr_add(sum_v, sum_v, part, nearest);
    }
    mpfr_div_ui(part, h, 6, nearest);
    mpfr_fma(x, part, sum_x, x, nearest);
    mpfr_fma(v, part, sum_v, v, nearest);
    mpfr_clears(kx, kv, sum_x, sum_v, stage_x, stage_v, part, (mpfr_ptr)NULL);
}

static void rk4_scene(const iterate_scene *s, double t, double h, double *x, double *v)
{
    const size_t n = s->count;
    double *kx = s->room, *kv = kx + n, *stage_x = kv + n, *stage_v = stage_x + n, *sum_x = stage_v + n,
           *sum_v = sum_x + n;
    memset(s->room, 0, 6 * n * sizeof *s->room);
    for (int k = 0; k < RK4_STAGES; k++) {
        const double part = h / 2 * rk4_at[k];
        for (size_t i = 0; i < n; i++) {
            stage_x[i] = x[i] + part * kx[i];
            stage_v[i] = v[i] + part * kv[i];
        }
        memcpy(kx, stage_v, n * sizeof *kx);
        scene_acceleration(s, t + part, stage_x, stage_v, kv);
        for (size_t i = 0; i < n; i++) {
            sum_x[i] += rk4_weight[k] * kx[i];
            sum_v[i] += rk4_weight[k] * kv[i];
        }
    }
    for (size_t i = 0; i < n; i++) {
        x[i] += h / 6 * sum_x[i];
        v[i] += h / 6 * sum_v[i];
    }
}

/* ------------------------------------------------------------------------------------------------ RKN 8(6)9 */

/* Number of stages. The coefficients of the last stage are the weights of the final position. */
enum { RKN_STAGES = 9 };
typedef struct quotient {
    long of, by;
} quotient;
static const quotient rkn_at[RKN_STAGES] = {{0, 1},  {1, 20}, {1, 10}, {3, 10}, {1, 2},
                                            {7, 10}, {9, 10}, {1, 1},  {1, 1}};
/* clang-format off */
static const quotient rkn_from[RKN_STAGES][RKN_STAGES - 1] = {
    {{0, 1}},
    {{1, 800}},
    {{1, 600}, {1, 300}},
    {{9, 200}, {-9, 100}, {9, 100}},
    {{-66701, 197352}, {28325, 32892}, {-2665, 5482}, {2170, 24669}},
    {{227015747, 304251000}, {-54897451, 30425100}, {12942349, 10141700}, {-9499, 304251}, {539, 9250}},
    {{-1131891597, 901789000}, {41964921, 12882700}, {-6663147, 3220675}, {270954, 644135}, {-108, 5875},
     {114, 1645}},
    {{13836959, 3667458}, {-17731450, 1833729}, {1063919505, 156478208}, {-33213845, 39119552}, {13335, 28544},
     {-705, 14272}, {1645, 57088}},
    {{223, 7938}, {0, 1}, {1175, 8064}, {925, 6048}, {41, 448}, {925, 14112}, {1175, 72576}, {0, 1}},
};
static const quotient rkn_kick[RKN_STAGES - 1] = {
    {223, 7938}, {0, 1}, {5875, 36288}, {4625, 21168}, {41, 224}, {4625, 21168}, {5875, 36288}, {223, 7938}};
/* clang-format on */

/* sum += h q value */
static void add_quotient(mpfr_t sum, quotient q, const mpfr_t h, const mpfr_t value)
{
    mpfr_t part;
    mpfr_init2(part, mpfr_get_prec(sum));
    mpfr_mul_si(part, h, q.of, nearest);
    mpfr_div_si(part, part, q.by, nearest);
    mpfr_fma(sum, part, value, sum, nearest);
    mpfr_clear(part);
}

/* Integrates y = e^(g t/2) (x - x0), for which y'' = e^(g t/2) (a - w x) + (g/2)^2 y. */
static void rkn8_spring(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h)
{
    mpfr_t slope[RKN_STAGES - 1], y, dy, growth, square, half, position, zero;
    mpfr_inits2(mpfr_get_prec(x), y, dy, growth, square, half, position, zero, (mpfr_ptr)NULL);
    mpfr_set_zero(zero, 1);
    mpfr_sqr(square, h, nearest);
    mpfr_div_ui(half, r->g, 2, nearest);
    for (int i = 0; i < RKN_STAGES; i++) {
        mpfr_set_zero(y, 1);
        add_quotient(y, rkn_at[i], h, v);
        for (int j = 0; j < i; j++)
            add_quotient(y, rkn_from[i][j], square, slope[j]);
        mpfr_set_zero(growth, 1);
        add_quotient(growth, rkn_at[i], h, half);
        mpfr_exp(growth, growth, nearest);
        mpfr_div(position, y, growth, nearest);
        mpfr_add(position, x, position, nearest);
        if (i + 1 == RKN_STAGES)
            break;
        mpfr_init2(slope[i], mpfr_get_prec(x));
        spring_acceleration(slope[i], r, position, zero);
        mpfr_mul(slope[i], slope[i], growth, nearest);
        mpfr_sqr(dy, half, nearest);
        mpfr_fma(slope[i], dy, y, slope[i], nearest);
    }
    mpfr_set(dy, v, nearest);
    for (int j = 0; j < RKN_STAGES - 1; j++) {
        add_quotient(dy, rkn_kick[j], h, slope[j]);
        mpfr_clear(slope[j]);
    }
    mpfr_mul(y, y, half, nearest);
    mpfr_sub(dy, dy, y, nearest);
    mpfr_div(v, dy, growth, nearest);
    mpfr_set(x, position, nearest);
    mpfr_clears(y, dy, growth, square, half, position, zero, (mpfr_ptr)NULL);
}

static double value_of(quotient q)
{
    return (double)q.of / (double)q.by;
}

/* Forces must not depend on velocity. The last stage is kept, since it is the first stage of the next step. */
static void rkn8_scene(const iterate_scene *s, double t, double h, double *x, double *v)
{
    const size_t n = s->count;
    double *const kept = s->room, *const stage = kept + n, *const slope = stage + n;
    if (s->step == 0 || s->changes)
        s->acceleration(s->data, t, x, v, kept);
    memcpy(slope, kept, n * sizeof *slope);
    for (int i = 1; i < RKN_STAGES; i++) {
        const double at = h * value_of(rkn_at[i]);
        for (size_t k = 0; k < n; k++) {
            double y = at * v[k];
            for (int j = 0; j < i; j++)
                y += h * h * value_of(rkn_from[i][j]) * slope[(size_t)j * n + k];
            stage[k] = x[k] + exp(-s->drag[k] / 2 * at) * y;
        }
        s->acceleration(s->data, t + at, stage, v, kept);
        for (size_t k = 0; k < n && i + 1 < RKN_STAGES; k++) {
            const double growth = exp(s->drag[k] / 2 * at), half = s->drag[k] / 2;
            slope[(size_t)i * n + k] = growth * (kept[k] + half * half * (stage[k] - x[k]));
        }
    }
    for (size_t k = 0; k < n; k++) {
        double dy = v[k];
        for (int j = 0; j < RKN_STAGES - 1; j++)
            dy += h * value_of(rkn_kick[j]) * slope[(size_t)j * n + k];
        v[k] = exp(-s->drag[k] / 2 * h) * dy - s->drag[k] / 2 * (stage[k] - x[k]);
        x[k] = stage[k];
    }
}

/* ------------------------------------------------------------------------------------------------------- SRKN6 */

/* The coefficients of the paper, to full precision by tests/spring/srkn6_coefficients.py. The middle ones follow from sums. */
enum { SRKN_STAGES = 11, SRKN_GIVEN = 5 };
static const char *const srkn_kick[SRKN_GIVEN] = {
    "0.04146499851826284329877813391470493672394", "0.1981286719180665411367264731814969606125",
    "-0.04000619210415268688882836353594483937569", "0.07525398430158034112787887852704275554175",
    "-0.01151138742068777006244320150128919955259"};
static const char *const srkn_drift[SRKN_GIVEN] = {
    "0.1232297759462711515610863803333667525905", "0.2905537977995582703664141693279161833302",
    "-0.127049212625416915662505053827485934473", "-0.246331761062075404194973489104062862596",
    "0.3572088727959277526198603496193104628369"};

/* out = given[i], or (1 - 2 (sum of all given))/halves for the middle coefficient. */
static void srkn_coefficient(mpfr_t out, const char *const given[SRKN_GIVEN], int i, unsigned long halves)
{
    mpfr_set_ui(out, i < SRKN_GIVEN ? 0 : 1, nearest);
    mpfr_t number;
    mpfr_init2(number, mpfr_get_prec(out));
    for (int k = 0; k < SRKN_GIVEN; k++) {
        mpfr_set_str(number, given[k], 10, nearest);
        if (i == k)
            mpfr_set(out, number, nearest);
        mpfr_mul_ui(number, number, 2, nearest);
        if (i == SRKN_GIVEN)
            mpfr_sub(out, out, number, nearest);
    }
    if (i == SRKN_GIVEN)
        mpfr_div_ui(out, out, halves, nearest);
    mpfr_clear(number);
}

static int srkn_mirrored(int i, int n)
{
    return i < n / 2 ? i : n - 1 - i;
}

/* Solves x' = v, v' = -g v over h: x += v (1 - e^(-g h))/g, v *= e^(-g h) */
static void srkn_drift_spring(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h)
{
    mpfr_t lost;
    if (mpfr_zero_p(r->g)) {
        mpfr_fma(x, h, v, x, nearest);
        return;
    }
    mpfr_init2(lost, mpfr_get_prec(x));
    mpfr_mul(lost, r->g, h, nearest);
    mpfr_neg(lost, lost, nearest);
    mpfr_expm1(lost, lost, nearest);
    mpfr_mul(lost, lost, v, nearest);
    mpfr_add(v, v, lost, nearest);
    mpfr_div(lost, lost, r->g, nearest);
    mpfr_sub(x, x, lost, nearest);
    mpfr_clear(lost);
}

static void srkn6_spring(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h)
{
    mpfr_t a, part, zero;
    mpfr_inits2(mpfr_get_prec(x), a, part, zero, (mpfr_ptr)NULL);
    mpfr_set_zero(zero, 1);
    for (int i = 0; i <= SRKN_STAGES; i++) {
        spring_acceleration(a, r, x, zero);
        srkn_coefficient(part, srkn_kick, srkn_mirrored(i, SRKN_STAGES + 1), 2);
        mpfr_mul(part, part, h, nearest);
        mpfr_fma(v, part, a, v, nearest);
        if (i == SRKN_STAGES)
            break;
        srkn_coefficient(part, srkn_drift, srkn_mirrored(i, SRKN_STAGES), 1);
        mpfr_mul(part, part, h, nearest);
        srkn_drift_spring(x, v, r, part);
    }
    mpfr_clears(a, part, zero, (mpfr_ptr)NULL);
}

static void srkn_numbers(const char *const given[SRKN_GIVEN], double middle, double number[SRKN_GIVEN + 1])
{
    number[SRKN_GIVEN] = middle;
    for (int i = 0; i < SRKN_GIVEN; i++) {
        number[i] = strtod(given[i], NULL);
        number[SRKN_GIVEN] -= 2 * middle * number[i];
    }
}

/* Forces must not depend on velocity. The last force is kept, since it is the first force of the next step. */
static void srkn6_scene(const iterate_scene *s, double t, double h, double *x, double *v)
{
    double *const a = s->room, kick[SRKN_GIVEN + 1], drift[SRKN_GIVEN + 1], at = 0;
    srkn_numbers(srkn_kick, 0.5, kick);
    srkn_numbers(srkn_drift, 1, drift);
    if (s->step == 0 || s->changes)
        s->acceleration(s->data, t, x, v, a);
    for (int i = 0; i < SRKN_STAGES; i++) {
        const double span = h * drift[srkn_mirrored(i, SRKN_STAGES)];
        for (size_t k = 0; k < s->count; k++) {
            v[k] += h * kick[srkn_mirrored(i, SRKN_STAGES + 1)] * a[k];
            x[k] += s->drag[k] != 0 ? -expm1(-s->drag[k] * span) / s->drag[k] * v[k] : span * v[k];
            v[k] *= exp(-s->drag[k] * span);
        }
        at += span;
        s->acceleration(s->data, i + 1 < SRKN_STAGES ? t + at : t + h, x, v, a);
    }
    for (size_t k = 0; k < s->count; k++)
        v[k] += h * kick[0] * a[k];
}

/* -------------------------------------------------------------------------------------------------- the methods */

static const iterate iterates[] = {
    [SPRING_EULER] = {.spring = euler_spring, .scene = euler_scene, .vectors = 1},
    [SPRING_LEAPFROG] = {.spring = leapfrog_spring, .scene = leapfrog_scene, .vectors = 2},
    [SPRING_RK4] = {.spring = rk4_spring, .scene = rk4_scene, .vectors = 6},
    [SPRING_EXACT] = {.spring = NULL}, /* takes no steps */
    [SPRING_SYMPLECTIC_EULER] = {.spring = symplectic_euler_spring, .scene = symplectic_euler_scene, .vectors = 1},
    [SPRING_RKN8] = {.spring = rkn8_spring, .scene = rkn8_scene, .vectors = 2 + RKN_STAGES - 1},
    [SPRING_SRKN6] = {.spring = srkn6_spring, .scene = srkn6_scene, .vectors = 1},
};
_Static_assert(sizeof iterates / sizeof iterates[0] == SPRING_METHOD_COUNT, "each method has an entry");

const iterate *iterate_of(spring_method m)
{
    if ((unsigned)m >= SPRING_METHOD_COUNT || iterates[m].spring == NULL || iterates[m].scene == NULL) {
        fprintf(stderr, "iterates: method %d takes no steps, or has no entry\n", (int)m);
        exit(EXIT_FAILURE);
    }
    return &iterates[m];
}

size_t iterate_room(size_t count)
{
    size_t most = 0;
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        most = iterates[m].vectors > most ? iterates[m].vectors : most;
    return most * count;
}
