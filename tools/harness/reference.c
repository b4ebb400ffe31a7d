/* SPDX-License-Identifier: MIT */
/* Reference solutions in multiple precision; see reference.h. */
#include "harness/reference.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/iterates.h"

/* [bits] With n = 2^64 steps and damping ratios of 1e8, more than 30 significant digits remain. */
static const mpfr_prec_t precision = 384;

static const mpfr_rnd_t nearest = MPFR_RNDN;

void reference_init(reference *r)
{
    mpfr_set_emin(mpfr_get_emin_min()); /* exp(b t) of a heavily damped spring can exceed 2^(2^30) */
    mpfr_set_emax(mpfr_get_emax_max());
    mpfr_inits2(precision, r->x, r->v, r->omega, r->size, (mpfr_ptr)NULL);
}

void reference_clear(reference *r)
{
    mpfr_clears(r->x, r->v, r->omega, r->size, (mpfr_ptr)NULL);
}

static void set_omega(mpfr_t omega, const spring_params *p)
{
    mpfr_set_d(omega, p->stiffness, nearest);
    mpfr_div_d(omega, omega, p->mass, nearest);
    mpfr_sqrt(omega, omega, nearest);
    if (mpfr_zero_p(omega))
        mpfr_set_ui(omega, 1, nearest);
}

/* The spectral norm of (a b; c d): half the sum of |(a + d, b - c)| and |(a - d, b + c)|. */
static void spectral_norm(mpfr_t norm, const mpfr_t a, const mpfr_t b, const mpfr_t c, const mpfr_t d)
{
    mpfr_t s, t;
    mpfr_inits2(precision, s, t, (mpfr_ptr)NULL);
    mpfr_add(s, a, d, nearest);
    mpfr_sub(t, b, c, nearest);
    mpfr_hypot(norm, s, t, nearest);
    mpfr_sub(s, a, d, nearest);
    mpfr_add(t, b, c, nearest);
    mpfr_hypot(s, s, t, nearest);
    mpfr_add(norm, norm, s, nearest);
    mpfr_div_ui(norm, norm, 2, nearest);
    mpfr_clears(s, t, (mpfr_ptr)NULL);
}

/* -------------------------------------------------------------------------------------------------- affine maps */

/* y -> M y + q on y = (x, v), with q in the last column of m */
typedef struct affine {
    mpfr_t m[2][3];
} affine;

static void affine_init(affine *f)
{
    for (int i = 0; i < 2; i++)
        mpfr_inits2(precision, f->m[i][0], f->m[i][1], f->m[i][2], (mpfr_ptr)NULL);
}

static void affine_clear(affine *f)
{
    for (int i = 0; i < 2; i++)
        mpfr_clears(f->m[i][0], f->m[i][1], f->m[i][2], (mpfr_ptr)NULL);
}

static void affine_set(affine *to, const affine *from)
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++)
            mpfr_set(to->m[i][j], from->m[i][j], nearest);
}

/* to = after o before; to may be either */
static void affine_compose(affine *to, const affine *after, const affine *before)
{
    affine f;
    affine_init(&f);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 3; j++)
            mpfr_fmma(f.m[i][j], after->m[i][0], before->m[0][j], after->m[i][1], before->m[1][j], nearest);
        mpfr_add(f.m[i][2], f.m[i][2], after->m[i][2], nearest);
    }
    affine_set(to, &f);
    affine_clear(&f);
}

/* The norm of the linear part in (x, v/omega). */
static void affine_norm(mpfr_t norm, const affine *f, const mpfr_t omega)
{
    mpfr_t b, c;
    mpfr_inits2(precision, b, c, (mpfr_ptr)NULL);
    mpfr_mul(b, f->m[0][1], omega, nearest);
    mpfr_div(c, f->m[1][0], omega, nearest);
    spectral_norm(norm, f->m[0][0], b, c, f->m[1][1]);
    mpfr_clears(b, c, (mpfr_ptr)NULL);
}

static void apply(reference *ref, const affine *f)
{
    mpfr_t x, norm;
    mpfr_inits2(precision, x, norm, (mpfr_ptr)NULL);
    affine_norm(norm, f, ref->omega);
    mpfr_mul(ref->size, ref->size, norm, nearest);
    mpfr_fmma(x, f->m[0][0], ref->x, f->m[0][1], ref->v, nearest);
    mpfr_fmma(ref->v, f->m[1][0], ref->x, f->m[1][1], ref->v, nearest);
    mpfr_add(ref->x, x, f->m[0][2], nearest);
    mpfr_add(ref->v, ref->v, f->m[1][2], nearest);
    mpfr_clears(x, norm, (mpfr_ptr)NULL);
}

void reference_start(reference *ref, const spring_params *p, spring_state start)
{
    mpfr_t u;
    mpfr_init2(u, precision);
    set_omega(ref->omega, p);
    mpfr_set_d(ref->x, start.x, nearest);
    mpfr_set_d(ref->v, start.v, nearest);
    mpfr_div(u, ref->v, ref->omega, nearest);
    mpfr_hypot(ref->size, ref->x, u, nearest);
    mpfr_clear(u);
}

/* ------------------------------------------------------------------------------------------- the exact solution */

/* The exact solution over t as a map. Its eigenvalues are -b +- r, with r real or imaginary; r = 0 is taken as a limit.
   The cancellation that the library avoids is harmless at this precision. */
static void solution_map(affine *f, const spring_params *p, double t)
{
    mpfr_t w, b, r, C, S, E, H, P, a;
    mpfr_inits2(precision, w, b, r, C, S, E, H, P, a, (mpfr_ptr)NULL);
    mpfr_set_d(w, p->stiffness, nearest);
    mpfr_div_d(w, w, p->mass, nearest);
    mpfr_set_d(b, p->damping, nearest);
    mpfr_div_d(b, b, p->mass, nearest);
    mpfr_div_ui(b, b, 2, nearest);
    mpfr_set_d(a, p->load, nearest);
    mpfr_div_d(a, a, p->mass, nearest);
    mpfr_sqr(r, b, nearest);
    mpfr_sub(r, w, r, nearest);
    const int oscillates = mpfr_sgn(r);
    mpfr_abs(r, r, nearest);
    mpfr_sqrt(r, r, nearest);

    mpfr_mul_d(E, r, t, nearest);
    if (oscillates > 0)
        mpfr_sin_cos(S, C, E, nearest);
    else
        mpfr_sinh_cosh(S, C, E, nearest);
    if (oscillates == 0)
        mpfr_set_d(S, t, nearest);
    else
        mpfr_div(S, S, r, nearest);
    mpfr_mul_d(E, b, -t, nearest);
    mpfr_exp(E, E, nearest);
    mpfr_mul(H, E, S, nearest);
    mpfr_mul(S, b, S, nearest);
    mpfr_add(f->m[0][0], C, S, nearest);
    mpfr_mul(f->m[0][0], f->m[0][0], E, nearest);
    mpfr_sub(f->m[1][1], C, S, nearest);
    mpfr_mul(f->m[1][1], f->m[1][1], E, nearest);
    mpfr_set(f->m[0][1], H, nearest);
    mpfr_mul(f->m[1][0], w, H, nearest);
    mpfr_neg(f->m[1][0], f->m[1][0], nearest);

    /* the response to unit acceleration from rest: (1 - F)/w, or without stiffness (t - H)/(2 b), or t^2/2 */
    if (mpfr_sgn(w) > 0) {
        mpfr_ui_sub(P, 1, f->m[0][0], nearest);
        mpfr_div(P, P, w, nearest);
    } else if (mpfr_sgn(b) > 0) {
        mpfr_d_sub(P, t, H, nearest);
        mpfr_div(P, P, b, nearest);
        mpfr_div_ui(P, P, 2, nearest);
    } else {
        mpfr_set_d(P, t, nearest);
        mpfr_sqr(P, P, nearest);
        mpfr_div_ui(P, P, 2, nearest);
    }
    mpfr_mul(f->m[0][2], a, P, nearest);
    mpfr_mul(f->m[1][2], a, H, nearest);
    mpfr_clears(w, b, r, C, S, E, H, P, a, (mpfr_ptr)NULL);
}

void reference_exact(reference *ref, const spring_params *p, double t)
{
    affine f;
    affine_init(&f);
    solution_map(&f, p, t);
    apply(ref, &f);
    affine_clear(&f);
}

/* --------------------------------------------------------------------------------------- the numerical solution */

/* One step as an affine map, from steps of the origin and of two basis states. */
static void step_map(affine *f, spring_method m, const iterate_rates *r, const mpfr_t h)
{
    const iterate *method = iterate_of(m);
    for (int j = 2; j >= 0; j--) { /* the last column is the origin, which has no 1 */
        mpfr_set_ui(f->m[0][j], j == 0, nearest);
        mpfr_set_ui(f->m[1][j], j == 1, nearest);
        method->spring(f->m[0][j], f->m[1][j], r, h);
        for (int i = 0; i < 2 && j < 2; i++)
            mpfr_sub(f->m[i][j], f->m[i][j], f->m[i][2], nearest);
    }
}

/* One step of a spring, from w = k/m, g = c/m, a = f/m, each rounded to a double as in the library, or unrounded. */
static void spring_map(affine *f, const spring_params *p, spring_method m, const mpfr_t h, bool rounded)
{
    iterate_rates r;
    mpfr_inits2(precision, r.w, r.g, r.a, (mpfr_ptr)NULL);
    const struct {
        mpfr_ptr out;
        double of;
    } rate[] = {{r.w, p->stiffness}, {r.g, p->damping}, {r.a, p->load}};
    for (int i = 0; i < 3; i++) {
        mpfr_set_d(rate[i].out, rounded ? rate[i].of / p->mass : rate[i].of, nearest);
        if (!rounded)
            mpfr_div_d(rate[i].out, rate[i].out, p->mass, nearest);
    }
    step_map(f, m, &r, h);
    mpfr_clears(r.w, r.g, r.a, (mpfr_ptr)NULL);
}

/* The same for a step that is a double. */
static void step_of(affine *f, const spring_params *p, spring_method m, double dt, bool rounded)
{
    mpfr_t h;
    mpfr_init2(h, precision);
    mpfr_set_d(h, dt, nearest);
    spring_map(f, p, m, h, rounded);
    mpfr_clear(h);
}

/* Replaces f by f composed n times, linear and constant part. */
static void affine_power(affine *f, uint64_t n)
{
    affine all;
    affine_init(&all);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++)
            mpfr_set_ui(all.m[i][j], i == j, nearest);
    for (; n > 0; n /= 2) {
        if (n % 2 == 1)
            affine_compose(&all, f, &all);
        if (n > 1)
            affine_compose(f, f, f);
    }
    affine_set(f, &all);
    affine_clear(&all);
}

void reference_iterate(reference *ref, const spring_params *p, spring_method m, double dt, uint64_t n)
{
    affine steps;
    affine_init(&steps);
    step_of(&steps, p, m, dt, true);
    affine_power(&steps, n);
    apply(ref, &steps);
    affine_clear(&steps);
}

/* One step of an undamped, unloaded spring. */
static void mode_map(affine *f, spring_method m, long double omega, double h)
{
    iterate_rates r;
    mpfr_t step;
    mpfr_inits2(precision, r.w, r.g, r.a, step, (mpfr_ptr)NULL);
    mpfr_set_ld(r.w, omega, nearest);
    mpfr_sqr(r.w, r.w, nearest);
    mpfr_set_zero(r.g, 1);
    mpfr_set_zero(r.a, 1);
    mpfr_set_d(step, h, nearest);
    step_map(f, m, &r, step);
    mpfr_clears(r.w, r.g, r.a, step, (mpfr_ptr)NULL);
}

void reference_mode(spring_method m, long double omega, double h, uint64_t n, long double *x, long double *v)
{
    affine f;
    mpfr_t x0, v0, end;
    affine_init(&f);
    mpfr_inits2(precision, x0, v0, end, (mpfr_ptr)NULL);
    mpfr_set_ld(x0, *x, nearest);
    mpfr_set_ld(v0, *v, nearest);
    mode_map(&f, m, omega, h);
    affine_power(&f, n);
    mpfr_fmma(end, f.m[0][0], x0, f.m[0][1], v0, nearest);
    *x = mpfr_get_ld(end, nearest);
    mpfr_fmma(end, f.m[1][0], x0, f.m[1][1], v0, nearest);
    *v = mpfr_get_ld(end, nearest);
    mpfr_clears(x0, v0, end, (mpfr_ptr)NULL);
    affine_clear(&f);
}

/* ------------------------------------------------------------------------------------------------ the worst error */

typedef struct wide_matrix {
    long double m[2][2];
} wide_matrix;

/* a - b, in (x, v/frequency); b may be NULL */
static wide_matrix wide_difference(const affine *a, const affine *b, double frequency)
{
    wide_matrix wide;
    mpfr_t d;
    mpfr_init2(d, precision);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            mpfr_set(d, a->m[i][j], nearest);
            if (b != NULL)
                mpfr_sub(d, d, b->m[i][j], nearest);
            if (i < j)
                mpfr_mul_d(d, d, frequency, nearest);
            else if (i > j)
                mpfr_div_d(d, d, frequency, nearest);
            wide.m[i][j] = mpfr_get_ld(d, nearest);
        }
    mpfr_clear(d);
    return wide;
}

/* a b + c d, where c may be NULL */
static wide_matrix wide_products(const wide_matrix *a, const wide_matrix *b, const wide_matrix *c, const wide_matrix *d)
{
    wide_matrix sum;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            sum.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j];
            if (c != NULL)
                sum.m[i][j] += c->m[i][0] * d->m[0][j] + c->m[i][1] * d->m[1][j];
        }
    return sum;
}

static double wide_norm(const wide_matrix *a)
{
    return (double)((hypotl(a->m[0][0] + a->m[1][1], a->m[0][1] - a->m[1][0]) +
                     hypotl(a->m[0][0] - a->m[1][1], a->m[0][1] + a->m[1][0])) /
                    2);
}

double reference_worst_error(const spring_params *p, spring_method m, double frequency, double h, uint64_t n,
                             uint64_t stride)
{
    enum { BLOCK = 1024 };
    enum { LAST, LEAP, BLOCKS, NOW, powers }; /* R^n, R^stride, R^(BLOCK stride), and R^i */
    affine step[powers], exact_step[powers];
    spring_params unloaded = *p;
    unloaded.load = 0;
    for (int k = 0; k < powers; k++) {
        affine_init(&step[k]);
        affine_init(&exact_step[k]);
        step_of(&step[k], &unloaded, m, h, false);
        solution_map(&exact_step[k], &unloaded, h);
        affine_power(&step[k], k == LAST ? n : k == BLOCKS ? BLOCK * stride : stride);
        affine_power(&exact_step[k], k == LAST ? n : k == BLOCKS ? BLOCK * stride : stride);
    }
    wide_matrix error = wide_difference(&step[LAST], &exact_step[LAST], frequency);
    double most = wide_norm(&error);

    const wide_matrix R = wide_difference(&step[LEAP], NULL, frequency);
    const wide_matrix F = wide_difference(&exact_step[LEAP], NULL, frequency);
    const wide_matrix D = wide_difference(&step[LEAP], &exact_step[LEAP], frequency);
    for (uint64_t i = stride; i <= n;) {
        error = wide_difference(&step[NOW], &exact_step[NOW], frequency);
        wide_matrix exact = wide_difference(&exact_step[NOW], NULL, frequency);
        for (int k = 0; k < BLOCK && i <= n; k++, i += stride) {
            most = fmax(most, wide_norm(&error));
            error = wide_products(&R, &error, &D, &exact);
            exact = wide_products(&F, &exact, NULL, NULL);
        }
        affine_compose(&step[NOW], &step[BLOCKS], &step[NOW]);
        affine_compose(&exact_step[NOW], &exact_step[BLOCKS], &exact_step[NOW]);
    }
    for (int k = 0; k < powers; k++) {
        affine_clear(&step[k]);
        affine_clear(&exact_step[k]);
    }
    return most;
}

/* ------------------------------------------------------------------------------------------------ steps as a turn */

/* With g^2 = det M and cos(angle) = trace/(2 g):   M = g (cos(angle) + sin(angle) J) */
bool reference_turn_of(reference_turn *t, spring_method m, double omega, double h)
{
    affine f;
    mpfr_t half, det, sine, part;
    affine_init(&f);
    mpfr_inits2(precision, half, det, sine, part, (mpfr_ptr)NULL);
    mode_map(&f, m, omega, h);
    mpfr_mul_d(f.m[0][1], f.m[0][1], omega, nearest);
    mpfr_div_d(f.m[1][0], f.m[1][0], omega, nearest);
    mpfr_add(half, f.m[0][0], f.m[1][1], nearest);
    mpfr_div_ui(half, half, 2, nearest);
    mpfr_fmms(det, f.m[0][0], f.m[1][1], f.m[0][1], f.m[1][0], nearest);
    mpfr_sqr(part, half, nearest);
    mpfr_sub(part, det, part, nearest);
    const bool turns = mpfr_sgn(part) > 0;
    if (turns) {
        mpfr_sqrt(sine, part, nearest);
        mpfr_div(f.m[1][0], f.m[1][0], sine, nearest);
        mpfr_div(f.m[0][1], f.m[0][1], sine, nearest);
        mpfr_sub(part, f.m[0][0], half, nearest);
        mpfr_div(part, part, sine, nearest);
        t->x_to_x = mpfr_get_d(part, nearest);
        t->v_to_x = mpfr_get_d(f.m[0][1], nearest);
        t->x_to_v = mpfr_get_d(f.m[1][0], nearest);
        mpfr_atan2(sine, sine, half, nearest);
        t->angle = mpfr_get_d(sine, nearest);
        mpfr_set_d(part, omega, nearest);
        mpfr_mul_d(part, part, h, nearest);
        mpfr_sub(sine, sine, part, nearest);
        t->ahead = mpfr_get_d(sine, nearest);
        mpfr_log(det, det, nearest);
        t->log_growth = mpfr_get_d(det, nearest) / 2;
    }
    mpfr_clears(half, det, sine, part, (mpfr_ptr)NULL);
    affine_clear(&f);
    return turns;
}

double reference_turn_norm(const reference_turn *t, uint64_t n)
{
    /* J has det 1, so its singular values are s and 1/s. The norm of cos + sin J is at most s. */
    const double squares = 2 * t->x_to_x * t->x_to_x + t->v_to_x * t->v_to_x + t->x_to_v * t->x_to_v;
    const double norm = (sqrt(squares + 2) + sqrt(fmax(squares - 2, 0))) / 2;
    return norm * exp(fmax((double)n * t->log_growth, 0));
}

double reference_distance(const reference *ref, spring_state got)
{
    mpfr_t x, v;
    mpfr_inits2(precision, x, v, (mpfr_ptr)NULL);
    mpfr_sub_d(x, ref->x, got.x, nearest);
    mpfr_sub_d(v, ref->v, got.v, nearest);
    mpfr_div(v, v, ref->omega, nearest);
    mpfr_hypot(x, x, v, nearest);
    const double distance = mpfr_get_d(x, nearest);
    mpfr_clears(x, v, (mpfr_ptr)NULL);
    return distance;
}

/* 2/k times the energy; `out` must not alias the inputs */
static void square(mpfr_t out, const mpfr_t x, const mpfr_t v, const mpfr_t omega)
{
    mpfr_div(out, v, omega, nearest);
    mpfr_fmma(out, x, x, out, out, nearest);
}

double reference_energy_error(const reference *ref, spring_state got)
{
    mpfr_t x, v, energy, want;
    mpfr_inits2(precision, x, v, energy, want, (mpfr_ptr)NULL);
    mpfr_set_d(x, got.x, nearest);
    mpfr_set_d(v, got.v, nearest);
    square(energy, x, v, ref->omega);
    square(want, ref->x, ref->v, ref->omega);
    mpfr_reldiff(energy, want, energy, nearest);
    const double error = fabs(mpfr_get_d(energy, nearest));
    mpfr_clears(x, v, energy, want, (mpfr_ptr)NULL);
    return error;
}

/* -------------------------------------------------------------------------------------------- rounding, stability */

typedef struct plane_map { /* an affine map in (x, v/omega), in doubles */
    double a, b, c, d, x, v;
} plane_map;

static plane_map plane_of(const affine *f, double omega)
{
    return (plane_map){
        mpfr_get_d(f->m[0][0], nearest),         mpfr_get_d(f->m[0][1], nearest) * omega,
        mpfr_get_d(f->m[1][0], nearest) / omega, mpfr_get_d(f->m[1][1], nearest),
        mpfr_get_d(f->m[0][2], nearest),         mpfr_get_d(f->m[1][2], nearest) / omega,
    };
}

static spring_state plane_apply(const plane_map *f, spring_state y)
{
    return (spring_state){f->a * y.x + f->b * y.v + f->x, f->c * y.x + f->d * y.v + f->v};
}

static plane_map plane_product(const plane_map *f, const plane_map *g) /* of the linear parts */
{
    return (plane_map){f->a * g->a + f->b * g->c,
                       f->a * g->b + f->b * g->d,
                       f->c * g->a + f->d * g->c,
                       f->c * g->b + f->d * g->d,
                       0,
                       0};
}

static double plane_norm(const plane_map *f)
{
    return (hypot(f->a + f->d, f->b - f->c) + hypot(f->a - f->d, f->b + f->c)) / 2;
}

/* step - solution, subtracted before rounding */
static plane_map plane_difference(affine *step, const affine *solution, double omega)
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++)
            mpfr_sub(step->m[i][j], step->m[i][j], solution->m[i][j], nearest);
    return plane_of(step, omega);
}

typedef struct added {
    double rounding, truncation; /* [m] by one step, or by all steps that are not evaluated one by one */
} added;

typedef struct walk {
    plane_map step;
    uint64_t n;
} walk;

struct reference_bounds {
    double omega;
    spring_state y, exact; /* (x, v/omega) by the method, and the exact one */
    added *steps;
    walk *walks;
    uint64_t step_count, walk_count;
};

static void *grown(void *array, uint64_t count, size_t size)
{
    void *larger = realloc(array, count * size);
    if (larger == NULL) {
        fputs("reference: out of memory\n", stderr);
        exit(EXIT_FAILURE);
    }
    return larger;
}

reference_bounds *reference_bounds_new(const spring_params *p, spring_state start)
{
    const double w = p->stiffness / p->mass, omega = w > 0 ? sqrt(w) : 1;
    const spring_state y = {start.x, start.v / omega};
    reference_bounds *b = grown(NULL, 1, sizeof *b);
    *b = (reference_bounds){.omega = omega, .y = y, .exact = y};
    return b;
}

void reference_bounds_add(reference_bounds *b, const spring_params *p, spring_method m, double dt, uint64_t n)
{
    const uint64_t most_walked = 1000000;
    const double omega = b->omega, z = fmax(sqrt(p->stiffness / p->mass), p->damping / p->mass) * fabs(dt);
    const double local = 2 * DBL_EPSILON * pow(1 + z * z, 2);
    const double loaded = fabs(p->load / p->mass * dt) / omega,
                 smallest = 8 * DBL_TRUE_MIN * fmax(fmax(1, 1 / omega), fabs(dt));
    affine step, solution;
    affine_init(&step);
    affine_init(&solution);
    step_of(&step, p, m, dt, true);
    solution_map(&solution, p, dt);
    const plane_map M = plane_of(&step, omega), exact = plane_of(&solution, omega);
    const plane_map defect = plane_difference(&step, &solution, omega);
    affine_clear(&step);
    affine_clear(&solution);

    const bool walked = n <= most_walked;
    b->walks = grown(b->walks, b->walk_count + 1, sizeof *b->walks);
    b->walks[b->walk_count++] = (walk){M, walked ? n : 1};
    b->steps = grown(b->steps, b->step_count + (walked ? n : 1), sizeof *b->steps);
    if (!walked) {
        reference_turn turn;
        const bool turns = p->damping == 0 && p->load == 0 && reference_turn_of(&turn, m, omega, dt);
        const double carried = turns ? reference_turn_norm(&turn, n) : NAN; /* NaN fails every check */
        const double all = (double)n * hypot(b->y.x, b->y.v) * carried;
        b->steps[b->step_count++] = (added){carried * all * local, all * plane_norm(&defect)};
        return;
    }
    for (uint64_t j = 0; j < n; j++) {
        const spring_state miss = plane_apply(&defect, b->exact);
        b->steps[b->step_count++] = (added){local * (hypot(b->y.x, b->y.v) + loaded) + smallest, hypot(miss.x, miss.v)};
        b->y = plane_apply(&M, b->y);
        b->exact = plane_apply(&exact, b->exact);
    }
}

void reference_bounds_end(reference_bounds *b, double *rounding, double *truncation)
{
    plane_map later = {1, 0, 0, 1, 0, 0}; /* the product of the steps that follow */
    uint64_t j = b->step_count;
    *rounding = *truncation = 0;
    for (uint64_t i = b->walk_count; i-- > 0;)
        for (uint64_t k = 0; k < b->walks[i].n; k++) {
            const double norm = plane_norm(&later);
            j--;
            *rounding += norm * b->steps[j].rounding;
            *truncation += norm * b->steps[j].truncation;
            later = plane_product(&later, &b->walks[i].step);
        }
    free(b->steps);
    free(b->walks);
    free(b);
}

/* Jury's conditions for both eigenvalues in the closed unit circle: |det| <= 1 and |trace| <= 1 + det. Leapfrog without
   damping has det = 1. The slack is far above the rounding error of 384 bits and far below that of a double. */
static bool stable(const spring_params *p, spring_method m, const mpfr_t h)
{
    affine f;
    mpfr_t trace, det, edge;
    affine_init(&f);
    mpfr_inits2(precision, trace, det, edge, (mpfr_ptr)NULL);
    spring_map(&f, p, m, h, false);
    mpfr_add(trace, f.m[0][0], f.m[1][1], nearest);
    mpfr_abs(trace, trace, nearest);
    mpfr_fmms(det, f.m[0][0], f.m[1][1], f.m[0][1], f.m[1][0], nearest);
    mpfr_set_ui_2exp(edge, 1, -300, nearest);
    mpfr_add_ui(edge, edge, 1, nearest);
    bool inside = mpfr_cmpabs(det, edge) <= 0;
    mpfr_add(edge, edge, det, nearest);
    inside = inside && mpfr_cmp(trace, edge) <= 0;
    affine_clear(&f);
    mpfr_clears(trace, det, edge, (mpfr_ptr)NULL);
    return inside;
}

double reference_stable_step(const spring_params *p, spring_method m)
{
    mpfr_t low, high, middle;
    mpfr_inits2(precision, low, high, middle, (mpfr_ptr)NULL);
    set_omega(high, p);
    mpfr_ui_div(high, 1, high, nearest);
    mpfr_mul_2si(high, high, -120, nearest); /* so small that only methods without any stable step fail */
    mpfr_set_zero(low, 1);
    while (stable(p, m, high)) {
        mpfr_set(low, high, nearest);
        mpfr_mul_ui(high, high, 2, nearest);
    }
    if (!mpfr_zero_p(low))
        for (int i = 0; i < 80; i++) { /* relative width 2^-80 */
            mpfr_add(middle, low, high, nearest);
            mpfr_div_ui(middle, middle, 2, nearest);
            mpfr_set(stable(p, m, middle) ? low : high, middle, nearest);
        }
    const double limit = mpfr_get_d(low, nearest);
    mpfr_clears(low, high, middle, (mpfr_ptr)NULL);
    return limit;
}
