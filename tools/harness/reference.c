/* SPDX-License-Identifier: MIT */
/* References in multiple precision; see reference.h. */
#include "harness/reference.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

/* 107 digits: n = 2^64 steps and damping ratios of 1e8 still leave more than 30. */
static const mpfr_prec_t precision = 384;

static const mpfr_rnd_t nearest = MPFR_RNDN;

void reference_init(reference *r)
{
    mpfr_inits2(precision, r->x, r->v, r->omega, r->scale, (mpfr_ptr)NULL);
}

void reference_clear(reference *r)
{
    mpfr_clears(r->x, r->v, r->omega, r->scale, (mpfr_ptr)NULL);
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

/* ------------------------------------------------------------------------------------------- the true solution */

/* By eigenvalues -b +- r, real or imaginary; at r = 0 by the limit. 107 digits make up for the cancellation that the
   library avoids. */
void reference_exact(reference *ref, const spring_params *p, spring_state start, double t)
{
    mpfr_t w, b, r, C, S, E, F, G, H, P, x0, v0, u;
    mpfr_inits2(precision, w, b, r, C, S, E, F, G, H, P, x0, v0, u, (mpfr_ptr)NULL);
    set_omega(ref->omega, p);
    mpfr_set_d(w, p->stiffness, nearest);
    mpfr_div_d(w, w, p->mass, nearest);
    mpfr_set_d(b, p->damping, nearest);
    mpfr_div_d(b, b, p->mass, nearest);
    mpfr_div_ui(b, b, 2, nearest);
    mpfr_sqr(r, b, nearest);
    mpfr_sub(r, w, r, nearest);
    const int oscillates = mpfr_sgn(r);
    mpfr_abs(r, r, nearest);
    mpfr_sqrt(r, r, nearest);

    mpfr_mul_d(u, r, t, nearest);
    if (oscillates > 0)
        mpfr_sin_cos(S, C, u, nearest);
    else
        mpfr_sinh_cosh(S, C, u, nearest);
    if (oscillates == 0)
        mpfr_set_d(S, t, nearest);
    else
        mpfr_div(S, S, r, nearest);
    mpfr_mul_d(E, b, -t, nearest);
    mpfr_exp(E, E, nearest);
    mpfr_mul(H, E, S, nearest);
    mpfr_mul(u, b, S, nearest);
    mpfr_add(F, C, u, nearest);
    mpfr_mul(F, F, E, nearest);
    mpfr_sub(G, C, u, nearest);
    mpfr_mul(G, G, E, nearest);

    /* the response to unit acceleration from rest: (1 - F)/w, or without stiffness (t - H)/(2 b), or t^2/2 */
    if (mpfr_sgn(w) > 0) {
        mpfr_ui_sub(P, 1, F, nearest);
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

    mpfr_set_d(x0, start.x, nearest);
    mpfr_set_d(v0, start.v, nearest);
    mpfr_fmma(ref->x, F, x0, H, v0, nearest);
    mpfr_mul(u, w, H, nearest);
    mpfr_fmms(ref->v, G, v0, u, x0, nearest);
    mpfr_set_d(C, p->load, nearest);
    mpfr_div_d(C, C, p->mass, nearest);
    mpfr_fma(ref->x, C, P, ref->x, nearest);
    mpfr_fma(ref->v, C, H, ref->v, nearest);

    mpfr_mul(S, H, ref->omega, nearest); /* the propagator in (x, v/omega): (F S; -w H/omega G) */
    mpfr_div(u, u, ref->omega, nearest);
    mpfr_neg(u, u, nearest);
    spectral_norm(ref->scale, F, S, u, G);
    mpfr_div(v0, v0, ref->omega, nearest);
    mpfr_hypot(u, x0, v0, nearest);
    mpfr_mul(ref->scale, ref->scale, u, nearest);
    mpfr_clears(w, b, r, C, S, E, F, G, H, P, x0, v0, u, (mpfr_ptr)NULL);
}

/* --------------------------------------------------------------------------------------- the numerical solution */

/* y -> M y + q on y = (x, v) */
typedef struct affine {
    mpfr_t m[2][2], q[2];
} affine;

static void affine_init(affine *f)
{
    for (int i = 0; i < 2; i++)
        mpfr_inits2(precision, f->m[i][0], f->m[i][1], f->q[i], (mpfr_ptr)NULL);
}

static void affine_clear(affine *f)
{
    for (int i = 0; i < 2; i++)
        mpfr_clears(f->m[i][0], f->m[i][1], f->q[i], (mpfr_ptr)NULL);
}

static void affine_set(affine *to, const affine *from)
{
    for (int i = 0; i < 2; i++) {
        mpfr_set(to->q[i], from->q[i], nearest);
        for (int j = 0; j < 2; j++)
            mpfr_set(to->m[i][j], from->m[i][j], nearest);
    }
}

/* to = after o before; to may be either */
static void affine_compose(affine *to, const affine *after, const affine *before)
{
    affine f;
    affine_init(&f);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++)
            mpfr_fmma(f.m[i][j], after->m[i][0], before->m[0][j], after->m[i][1], before->m[1][j], nearest);
        mpfr_fmma(f.q[i], after->m[i][0], before->q[0], after->m[i][1], before->q[1], nearest);
        mpfr_add(f.q[i], f.q[i], after->q[i], nearest);
    }
    affine_set(to, &f);
    affine_clear(&f);
}

typedef struct rates {
    mpfr_t w, g, a;
} rates;

/* acceleration = a - w x - g v */
static void acceleration(mpfr_t out, const rates *r, const mpfr_t x, const mpfr_t v)
{
    mpfr_fmma(out, r->w, x, r->g, v, nearest);
    mpfr_sub(out, r->a, out, nearest);
}

static void euler_step(mpfr_t x, mpfr_t v, const rates *r, const mpfr_t h)
{
    mpfr_t force;
    mpfr_init2(force, precision);
    acceleration(force, r, x, v);
    mpfr_fma(x, h, v, x, nearest);
    mpfr_fma(v, h, force, v, nearest);
    mpfr_clear(force);
}

static void leapfrog_step(mpfr_t x, mpfr_t v, const rates *r, const mpfr_t h)
{
    mpfr_t force, half, zero;
    mpfr_inits2(precision, force, half, zero, (mpfr_ptr)NULL);
    mpfr_set_zero(zero, 1);
    mpfr_div_ui(half, h, 2, nearest);
    acceleration(force, r, x, v);
    mpfr_fma(v, half, force, v, nearest);
    mpfr_fma(x, h, v, x, nearest);
    acceleration(force, r, x, zero);
    mpfr_fma(v, half, force, v, nearest);
    mpfr_mul(force, half, r->g, nearest);
    mpfr_add_ui(force, force, 1, nearest);
    mpfr_div(v, v, force, nearest);
    mpfr_clears(force, half, zero, (mpfr_ptr)NULL);
}

static void rk4_step(mpfr_t x, mpfr_t v, const rates *r, const mpfr_t h)
{
    static const int stage_at[] = {0, 1, 1, 2}; /* in half steps */
    static const unsigned weight[] = {1, 2, 2, 1};
    mpfr_t kx, kv, sum_x, sum_v, sx, sv, part;
    mpfr_inits2(precision, kx, kv, sum_x, sum_v, sx, sv, part, (mpfr_ptr)NULL);
    mpfr_set_zero(kx, 1);
    mpfr_set_zero(kv, 1);
    mpfr_set_zero(sum_x, 1);
    mpfr_set_zero(sum_v, 1);
    for (int i = 0; i < 4; i++) {
        mpfr_mul_si(part, h, stage_at[i], nearest);
        mpfr_div_ui(part, part, 2, nearest);
        mpfr_fma(sx, part, kx, x, nearest);
        mpfr_fma(sv, part, kv, v, nearest);
        mpfr_set(kx, sv, nearest);
        acceleration(kv, r, sx, sv);
        mpfr_mul_ui(part, kx, weight[i], nearest);
        mpfr_add(sum_x, sum_x, part, nearest);
        mpfr_mul_ui(part, kv, weight[i], nearest);
        mpfr_add(sum_v, sum_v, part, nearest);
    }
    mpfr_div_ui(part, h, 6, nearest);
    mpfr_fma(x, part, sum_x, x, nearest);
    mpfr_fma(v, part, sum_v, v, nearest);
    mpfr_clears(kx, kv, sum_x, sum_v, sx, sv, part, (mpfr_ptr)NULL);
}

static void apply_step(spring_method m, mpfr_t x, mpfr_t v, const rates *r, const mpfr_t h)
{
    if (m == SPRING_EULER)
        euler_step(x, v, r, h);
    else if (m == SPRING_LEAPFROG)
        leapfrog_step(x, v, r, h);
    else
        rk4_step(x, v, r, h);
}

/* One step as an affine map, by stepping the origin and two basis states. */
static void step_map(affine *f, spring_method m, const rates *r, const mpfr_t h)
{
    mpfr_set_zero(f->q[0], 1);
    mpfr_set_zero(f->q[1], 1);
    apply_step(m, f->q[0], f->q[1], r, h);
    for (int j = 0; j < 2; j++) {
        mpfr_set_ui(f->m[0][j], j == 0, nearest);
        mpfr_set_ui(f->m[1][j], j == 1, nearest);
        apply_step(m, f->m[0][j], f->m[1][j], r, h);
        mpfr_sub(f->m[0][j], f->m[0][j], f->q[0], nearest);
        mpfr_sub(f->m[1][j], f->m[1][j], f->q[1], nearest);
    }
}

static void rates_init_rounded(rates *r, const spring_params *p)
{
    mpfr_inits2(precision, r->w, r->g, r->a, (mpfr_ptr)NULL);
    mpfr_set_d(r->w, p->stiffness / p->mass, nearest);
    mpfr_set_d(r->g, p->damping / p->mass, nearest);
    mpfr_set_d(r->a, p->load / p->mass, nearest);
}

static void rates_clear(rates *r)
{
    mpfr_clears(r->w, r->g, r->a, (mpfr_ptr)NULL);
}

void reference_iterate(reference *ref, const spring_params *p, spring_method m, double dt, uint64_t n,
                       spring_state start)
{
    rates r;
    affine power, all;
    mpfr_t h, x, v;
    rates_init_rounded(&r, p);
    mpfr_inits2(precision, h, x, v, (mpfr_ptr)NULL);
    affine_init(&power);
    affine_init(&all);
    set_omega(ref->omega, p);
    mpfr_set_d(h, dt, nearest);
    step_map(&power, m, &r, h);
    for (int i = 0; i < 2; i++) {
        mpfr_set_zero(all.q[i], 1);
        for (int j = 0; j < 2; j++)
            mpfr_set_ui(all.m[i][j], i == j, nearest);
    }
    for (; n > 0; n /= 2) {
        if (n % 2 == 1)
            affine_compose(&all, &power, &all);
        affine_compose(&power, &power, &power);
    }
    mpfr_set_d(x, start.x, nearest);
    mpfr_set_d(v, start.v, nearest);
    mpfr_fmma(ref->x, all.m[0][0], x, all.m[0][1], v, nearest);
    mpfr_add(ref->x, ref->x, all.q[0], nearest);
    mpfr_fmma(ref->v, all.m[1][0], x, all.m[1][1], v, nearest);
    mpfr_add(ref->v, ref->v, all.q[1], nearest);
    mpfr_div(v, v, ref->omega, nearest);
    mpfr_hypot(ref->scale, x, v, nearest);
    affine_clear(&power);
    affine_clear(&all);
    mpfr_clears(h, x, v, (mpfr_ptr)NULL);
    rates_clear(&r);
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

/* -------------------------------------------------------------------------------------------- rounding, stability */

double reference_rounding(const spring_params *p, spring_method m, double dt, uint64_t n, spring_state start)
{
    rates r;
    affine f;
    mpfr_t h;
    rates_init_rounded(&r, p);
    mpfr_init2(h, precision);
    affine_init(&f);
    mpfr_set_d(h, dt, nearest);
    step_map(&f, m, &r, h);
    const double w = mpfr_get_d(r.w, nearest), omega = w > 0 ? sqrt(w) : 1;
    /* the map in (x, v/omega) */
    const double a = mpfr_get_d(f.m[0][0], nearest), b = mpfr_get_d(f.m[0][1], nearest) * omega;
    const double c = mpfr_get_d(f.m[1][0], nearest) / omega, d = mpfr_get_d(f.m[1][1], nearest);
    const double qx = mpfr_get_d(f.q[0], nearest), qv = mpfr_get_d(f.q[1], nearest) / omega;
    const double z = fmax(omega, mpfr_get_d(r.g, nearest)) * fabs(dt);
    const double local = 2 * DBL_EPSILON * pow(1 + z * z, 1.5);
    const double push = fabs(mpfr_get_d(r.a, nearest) * dt) / omega;
    affine_clear(&f);
    mpfr_clear(h);
    rates_clear(&r);

    /* sum over j of |M^(n-1-j)| |y_j|, with the largest power for all */
    double x = start.x, v = start.v / omega, sum = 0;
    double P[4] = {1, 0, 0, 1}, growth = 1; /* powers of M and the largest norm among them so far */
    for (uint64_t j = 0; j < n; j++) {
        sum += hypot(x, v) + push;
        const double x1 = a * x + b * v + qx;
        v = c * x + d * v + qv;
        x = x1;
        const double p0 = a * P[0] + b * P[2], p1 = a * P[1] + b * P[3];
        const double p2 = c * P[0] + d * P[2], p3 = c * P[1] + d * P[3];
        P[0] = p0, P[1] = p1, P[2] = p2, P[3] = p3;
        if (j + 1 < n)
            growth = fmax(growth, (hypot(p0 + p3, p1 - p2) + hypot(p0 - p3, p1 + p2)) / 2);
    }
    return local * sum * growth;
}

/* Jury's conditions for both eigenvalues in the closed unit circle, |det| <= 1 and |trace| <= 1 + det. Leapfrog
   without damping has det = 1: the slack is far above what 384 bits round and far below what a double can tell. */
static bool stable(const spring_params *p, spring_method m, const mpfr_t h)
{
    rates r;
    affine f;
    mpfr_t trace, det, edge;
    affine_init(&f);
    mpfr_inits2(precision, r.w, r.g, r.a, trace, det, edge, (mpfr_ptr)NULL);
    mpfr_set_d(r.w, p->stiffness, nearest);
    mpfr_div_d(r.w, r.w, p->mass, nearest);
    mpfr_set_d(r.g, p->damping, nearest);
    mpfr_div_d(r.g, r.g, p->mass, nearest);
    mpfr_set_zero(r.a, 1);
    step_map(&f, m, &r, h);
    mpfr_add(trace, f.m[0][0], f.m[1][1], nearest);
    mpfr_abs(trace, trace, nearest);
    mpfr_fmms(det, f.m[0][0], f.m[1][1], f.m[0][1], f.m[1][0], nearest);
    mpfr_set_ui_2exp(edge, 1, -300, nearest);
    mpfr_add_ui(edge, edge, 1, nearest);
    bool inside = mpfr_cmpabs(det, edge) <= 0;
    mpfr_add(edge, edge, det, nearest);
    inside = inside && mpfr_cmp(trace, edge) <= 0;
    affine_clear(&f);
    mpfr_clears(r.w, r.g, r.a, trace, det, edge, (mpfr_ptr)NULL);
    return inside;
}

double reference_stable_step(const spring_params *p, spring_method m)
{
    mpfr_t low, high, middle;
    mpfr_inits2(precision, low, high, middle, (mpfr_ptr)NULL);
    set_omega(high, p);
    mpfr_ui_div(high, 1, high, nearest);
    mpfr_mul_2si(high, high, -120,
                 nearest); /* a step so small that only a method that is never stable fails */
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
