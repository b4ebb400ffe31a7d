/* SPDX-License-Identifier: MIT */
/*
 * Problems with published solutions that have no other test: theory beside measurement, which the test prints. Theory is
 * computed here, by closed forms, GSL's special functions or GSL's Runge-Kutta method 8(9).
 */
#include <gsl/gsl_sf_bessel.h>
#include <gsl/gsl_sf_elljac.h>
#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_laguerre.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "harness/ode.h"
#include "harness/scenes.h"
#include "scenes/start.h"

static const double pi = 3.14159265358979323846;

static void found(const char *what, double theory, double measured, double bound, const char *why)
{
    printf("# %s: theory %.12g, measured %.12g, relative difference %.1e\n", what, theory, measured,
           fabs(measured / theory - 1));
    CHECK_CLOSE(measured / theory, 1, bound, why);
}

/* Takes n steps to t from the start; x: positions of all particles. */
static void run(const scene_problem *p, spring_method m, double t, uint64_t n, double *x)
{
    spring_scene_def def = p->def;
    def.methods = 1u << m;
    spring_scene *scene = start_definition(&def, NULL);
    CHECK(spring_scene_advance(scene, m, t / (double)n, n) == SPRING_OK, "it runs");
    spring_scene_get(scene, SPRING_POSITION, x, 0, 0, p->def.particles);
    free(scene);
}

/* A solution of f(x) = 0 between low and high, where f changes its sign. */
static double root(double (*f)(double x, const double *of), const double *of, double low, double high)
{
    const bool rises = f(high, of) > 0;
    for (int i = 0; i < 200; i++) {
        const double middle = low + (high - low) / 2;
        if ((f(middle, of) > 0) == rises)
            high = middle;
        else
            low = middle;
    }
    return low;
}

/* The angular frequency of small vibrations along axis 0, from a start in the shape of a mode: the shape is multiplied by
   cos(omega t). By RKN8, whose error is below 1e-12 with these steps. */
static double frequency(scene_problem *p, const double *shape, double theory)
{
    const size_t axes = p->def.axes;
    const double quarter = pi / 2 / theory;
    double *rest = scene_room(axes * p->def.particles, sizeof *rest),
           *x = scene_room(axes * p->def.particles, sizeof *x);
    double product = 0, square = 0;
    memcpy(rest, p->position, axes * p->def.particles * sizeof *rest);
    for (size_t i = 0; i < p->def.particles; i++)
        p->position[axes * i] += shape[i];
    run(p, SPRING_RKN8, quarter, 2000, x);
    for (size_t i = 0; i < p->def.particles; i++) {
        product += p->mass[i] * shape[i] * (x[axes * i] - rest[axes * i]);
        square += p->mass[i] * shape[i] * shape[i];
    }
    free(rest);
    free(x);
    return acos(product / square) / quarter;
}

/* ------------------------------------------------------------------------------------------ one nonlinear spring */

static const scene_case *case_named(const char *name)
{
    for (size_t i = 0; i < scene_case_count; i++)
        if (strcmp(scene_cases[i].name, name) == 0)
            return &scene_cases[i];
    exit(EXIT_FAILURE);
}

/* x'' = -x - x^3 from rest at a: x = a cn(W t, m) with W^2 = 1 + a^2 and m = a^2/(2 W^2), period 4 K(m)/W. */
static void duffing(void)
{
    const scene_case *c = case_named("duffing"), *period = case_named("duffing-period");
    const double a = c->x, W = sqrt(1 + a * a), m = a * a / (2 * W * W), close = 16 * DBL_EPSILON;
    double sn, cn, dn;
    gsl_sf_elljac_e(W * c->duration, m, &sn, &cn, &dn);
    found("Duffing oscillator, position / m", a * cn, c->digits[0], close, "digits of the harness, functions of GSL");
    found("Duffing oscillator, period / s", 4 * gsl_sf_ellint_Kcomp(sqrt(m), GSL_PREC_DOUBLE) / W, period->duration,
          close, "digits of the harness, functions of GSL");
}

/* x'' = -sin x from rest at a: sin(x/2) = k cn(t, k^2)/dn(t, k^2) with k = sin(a/2), period 4 K. Near the top, dn is small
   and has the relative error eps/dn^2. */
static void pendulum(void)
{
    const scene_case *c = case_named("pendulum"), *period = case_named("pendulum-period");
    const double k = sin(c->x / 2), close = 16 * DBL_EPSILON / (1 - k * k);
    double sn, cn, dn;
    gsl_sf_elljac_e(c->duration, k * k, &sn, &cn, &dn);
    found("pendulum, angle / rad", 2 * asin(k * cn / dn), c->digits[0], close,
          "digits of the harness, functions of GSL");
    found("pendulum, period / s", 4 * gsl_sf_ellint_Kcomp(k, GSL_PREC_DOUBLE), period->duration, close,
          "digits of the harness, functions of GSL");
}

/* ----------------------------------------------------------------------------------------- chains with callbacks */

enum { SITES = 64, FPUT = 31 };

/* A row of equal masses with links of stiffness 1 and spacing 1 along one axis, pinned at both ends. */
static void make_row(scene_problem *p, uint32_t particles, spring_scene_force_fn *force)
{
    scene_problem_make(p, 1, particles, particles - 1, 1);
    for (uint32_t i = 0; i + 1 < particles; i++)
        p->link[i] = (spring_link){.a = i, .b = i + 1, .rest = 1, .stiffness = 1};
    for (uint32_t i = 0; i < particles; i++)
        p->position[i] = i;
    p->pinned[0] = p->pinned[particles - 1] = 1;
    p->def.force = force;
    p->def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
}

static const double alpha = 0.25; /* of Fermi, Pasta, Ulam and Tsingou */

static void quadratic(void *user, double t, size_t particles, const double *const x[3], const double *const v[3],
                      double *const force[3])
{
    (void)user, (void)t, (void)v;
    for (size_t i = 0; i + 1 < particles; i++) {
        const double r = x[0][i + 1] - x[0][i] - 1;
        force[0][i] += alpha * r * r;
        force[0][i + 1] -= alpha * r * r;
    }
}

/* The energy of the first mode; y as in scenes.h. */
static double first_mode(const double *y, double omega)
{
    double a = 0, b = 0;
    for (int i = 1; i <= FPUT; i++) {
        const double shape = sqrt(2.0 / (FPUT + 1)) * sin(pi * i / (FPUT + 1));
        a += shape * (y[i - 1] - i);
        b += shape * y[FPUT + i - 1];
    }
    return (b * b + omega * omega * a * a) / 2;
}

static void build_fput(const scene_case *c, scene_problem *p)
{
    make_row(p, FPUT + 2, quadratic);
    for (int i = 1; i <= FPUT; i++)
        p->position[i] += c->length * sin(pi * i / (FPUT + 1));
}

/* Nearly all energy returns to the first mode. Theory: GSL, and Toda's formula for long chains,
   T/T1 = 3/(pi^1.5 sqrt 2) (N + 1)^1.5/sqrt(alpha B), where B is the largest displacement at the start.
   Sources: Fermi, Pasta, Ulam, Tsingou, Studies of nonlinear problems (1955); Toda, Theory of nonlinear lattices (1989). */
static void recurrence(void)
{
    const double omega = 2 * sin(pi / (2 * (FPUT + 1))), T1 = 2 * pi / omega, B = 1;
    const int periods = 170, parts = 20; /* samples per period */
    scene_problem p = {0};
    double y[2 * FPUT], theirs[2 * FPUT], best[2] = {0}, at[2] = {0};
    scene_problem_init(&p, &(scene_case){.build = build_fput, .length = B});
    spring_scene *scene = start_definition(&p.def, NULL);
    scene_start(&p, theirs);
    ode o = {.size = 2 * FPUT, .derivative = scene_derivative, .data = &p};
    for (int i = 1; i <= periods * parts; i++) {
        CHECK(spring_scene_advance(scene, SPRING_RKN8, T1 / parts / 16, 16) == SPRING_OK, "it runs");
        CHECK(ode_gsl_rk8pd_fixed(&o, theirs, T1 / parts / 16, 16) == NULL, "so does GSL");
        spring_scene_get(scene, SPRING_POSITION, y, 0, 1, FPUT);
        spring_scene_get(scene, SPRING_VELOCITY, y + FPUT, 0, 1, FPUT);
        for (int k = 0; k < 2; k++) {
            const double energy = first_mode(k == 0 ? y : theirs, omega);
            if (i > periods * parts / 2 && energy > best[k]) {
                best[k] = energy;
                at[k] = (double)i / parts;
            }
        }
    }
    found("FPUT recurrence / T1, GSL", at[1], at[0], 0, "the same sample");
    found("FPUT recurrence, energy of the first mode", best[1], best[0], 1e-9,
          "RKN8 and rk8pd with 320 steps per period");
    found("FPUT recurrence / T1, Toda", 3 / (pow(pi, 1.5) * sqrt(2)) * pow(FPUT + 1, 1.5) / sqrt(alpha * B), at[0], 0.1,
          "a formula for long chains: 6 % with 32 links, measured");
    free(scene);
    scene_problem_clear(&p);
}

static void exponential(void *user, double t, size_t particles, const double *const x[3], const double *const v[3],
                        double *const force[3])
{
    (void)user, (void)t, (void)v;
    for (size_t i = 0; i + 1 < particles; i++) {
        const double r = x[0][i + 1] - x[0][i] - 1, further = 1 - exp(-r) - r; /* tension without that of the link */
        force[0][i] += further;
        force[0][i + 1] -= further;
    }
}

static double log_cosh(double a)
{
    return fabs(a) + log1p(exp(-2 * fabs(a))) - log(2);
}

/* Displacement and velocity at site n: x = ln cosh(a - kappa) - ln cosh a, a = kappa n - sinh(kappa) t. */
static spring_state soliton(double n, double t)
{
    const double kappa = 1, a = kappa * n - sinh(kappa) * t;
    return (spring_state){log_cosh(a - kappa) - log_cosh(a), sinh(kappa) * (tanh(a) - tanh(a - kappa))};
}

/* The lattice with the tension 1 - exp(-r), of every method. Source: Toda, Theory of nonlinear lattices (1989). */
static void soliton_moves(void)
{
    const double duration = 20;
    scene_problem p = {0};
    make_row(&p, SITES, exponential);
    for (int i = 0; i < SITES; i++) {
        const spring_state s = soliton(i - 20, 0);
        p.position[i] += s.x;
        p.velocity[i] = p.pinned[i] ? 0 : s.v;
    }
    for (int k = 0; k < SPRING_METHOD_COUNT; k++) {
        const spring_method m = spring_method_at(k);
        const int order = spring_method_describe(m)->order;
        if (!spring_method_describe(m)->scenes || m == SPRING_EULER)
            continue;
        double x[SITES], error[2] = {0};
        for (int fine = 0; fine < 2; fine++) {
            run(&p, m, duration, (order > 4 ? 100u : order > 1 ? 400u : 20000u) << fine, x);
            for (int i = 0; i < SITES; i++)
                error[fine] = fmax(error[fine], fabs(x[i] - i - soliton(i - 20, duration).x));
        }
        printf("# Toda soliton, %s: errors %.2g and %.2g m\n", spring_method_name(m), error[0], error[1]);
        CHECK_CLOSE(log2(error[0] / error[1]), order, 0.3, "its order, toward it");
    }
    scene_problem_clear(&p);
}

/* --------------------------------------------------------------------------------------------------------- modes */

/* L_n(x): omega^2 l/g of a chain of n masses at distances l are its zeros. */
static double laguerre(double x, const double *of)
{
    return gsl_sf_laguerre_n((int)of[0], 0, x);
}

/* A chain that hangs by its upper end and swings. Links are so much shorter at rest that they have the length l under
   the weight. For many masses, the frequencies are j_k/2 sqrt(g/L) with the zeros of the Bessel function J0.
   Source: D. Bernoulli (1738); Lamb, Hydrodynamics; the discrete chain: Levinson, J. Sound Vib. 49 (1976). */
static void hanging_chain(void)
{
    enum { COUNT = 12 };
    const double g = 9.81, l = 0.1, k = 1e5, small = 1e-6;
    const double n = COUNT, step = 0.01;
    double low = 0, shape[COUNT + 1] = {0};
    for (int mode = 0; mode < 3; mode++) {
        double high = low + step;
        while (laguerre(low, &n) * laguerre(high, &n) > 0)
            low = high, high += step;
        const double zero = root(laguerre, &n, low, high), theory = sqrt(zero * g / l);
        scene_problem p = {0};
        scene_problem_make(&p, 2, COUNT + 1, COUNT, 1);
        p.pinned[0] = 1;
        p.def.gravity[1] = -g;
        for (uint32_t i = 0; i <= COUNT; i++) {
            p.position[2 * i + 1] = -l * i;
            shape[i] = small * gsl_sf_laguerre_n((int)(COUNT - i), 0, zero); /* 0 at the pin */
            if (i > 0)
                p.link[i - 1] = (spring_link){.a = i - 1, .b = i, .rest = l - (COUNT - i + 1) * g / k, .stiffness = k};
        }
        shape[0] = 0;
        char what[64];
        snprintf(what, sizeof what, "hanging chain, mode %d / (rad/s)", mode + 1);
        found(what, theory, frequency(&p, shape, theory), 1e-7, "amplitudes are small");
        printf("# the same as a continuous chain: %.6g rad/s\n",
               gsl_sf_bessel_zero_J0((unsigned)mode + 1) / 2 * sqrt(g / (l * (COUNT + 0.5))));
        scene_problem_clear(&p);
        low = high;
    }
}

/* of: number of masses, end mass/mass */
static double rod_end(double angle, const double *of)
{
    return of[1] * (2 - 2 * cos(angle)) * sin(of[0] * angle) - sin(of[0] * angle) + sin((of[0] - 1) * angle);
}

static double continuous_rod(double b, const double *of)
{
    return b * sin(b) - cos(b) / of[1];
}

/* A rod that is clamped at one end and has a mass at the other end vibrates along its axis: omega = b sqrt(k/m), where k
   and m are those of the whole rod, and b tan b = m/M. As n masses, the last one M: shape sin(i angle), omega^2 = k/m
   (2 - 2 cos angle). Source: Timoshenko, Vibration problems in engineering (1937). */
static void rod_with_end_mass(void)
{
    const double rod = 1, stiffness = 4e4, end = 3; /* [kg], [N/m], [kg] */
    double error[2];
    for (uint32_t fine = 0; fine < 2; fine++) {
        enum { MOST = 40 };
        const uint32_t n = (uint32_t)MOST / 2 << fine;
        const double m = rod / n, k = stiffness * n, M = end + m / 2, of[] = {n, M / m}, of_rod[] = {0, end / rod};
        const double angle = root(rod_end, of, 1e-6, pi / 2 / n), theory = sqrt(k / m) * 2 * sin(angle / 2);
        const double whole = root(continuous_rod, of_rod, 0, pi / 2) * sqrt(stiffness / rod);
        double shape[MOST + 1];
        scene_problem p = {0};
        scene_problem_make(&p, 1, n + 1, n, m);
        p.pinned[0] = 1;
        p.mass[n] = M;
        p.def.mass = p.mass;
        for (uint32_t i = 0; i <= n; i++) {
            p.position[i] = (double)i / n;
            shape[i] = 1e-3 * sin(i * angle);
            if (i > 0)
                p.link[i - 1] = (spring_link){.a = i - 1, .b = i, .rest = 1.0 / n, .stiffness = k};
        }
        const double measured = frequency(&p, shape, theory);
        found("rod with an end mass, as masses and links / (rad/s)", theory, measured, 1e-10,
              "rounding errors, cosine near 0");
        found("rod with an end mass / (rad/s)", whole, measured, 1.0 / (n * n), "of order 2 in the length of links");
        error[fine] = fabs(measured / whole - 1);
        scene_problem_clear(&p);
    }
    CHECK_CLOSE(log2(error[0] / error[1]), 2, 0.05, "order 2 in the length of links");
}

/* A square membrane of height a, tension T per length and density d: omega = pi/a sqrt((p^2 + q^2) T/d). As N x N
   particles: omega^2 = 4 k/m (sin^2(p pi/2(N-1)) + sin^2(q pi/2(N-1))). */
static void membrane(void)
{
    const double stiffness = 2.7, mass = 0.4; /* T, and d for distances of 1 */
    double error[2];
    for (uint32_t fine = 0; fine < 2; fine++) {
        enum { MOST = 33 };
        const uint32_t N = fine ? MOST : MOST / 2 + 1;
        const double quarter = pi / 2 / (N - 1), p = 2, q = 1;
        const double theory = 2 * sqrt(stiffness / mass * (pow(sin(p * quarter), 2) + pow(sin(q * quarter), 2)));
        const double whole = pi / (N - 1) * sqrt((p * p + q * q) * stiffness / mass);
        const spring_grid g = {.count = {N, N},
                               .height = true,
                               .spacing = 1,
                               .families = SPRING_GRID_STRUCTURAL,
                               .stiffness = stiffness,
                               .pinned =
                                   SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y};
        scene_problem s = {0};
        double shape[MOST * MOST];
        scene_problem_grid(&s, &g, 0, mass);
        for (uint32_t i = 0; i < N * N; i++)
            shape[i] = s.pinned[i] ? 0 : sin(p * 2 * quarter * (i % N)) * sin(q * 2 * quarter * (i / N));
        const double measured = frequency(&s, shape, theory);
        found("membrane, mode (2, 1), as particles / (rad/s)", theory, measured, 1e-10, "rounding errors");
        found("membrane, mode (2, 1) / (rad/s)", whole, measured, 10.0 / (N * N),
              "of order 2 in the distance of particles");
        error[fine] = fabs(measured / whole - 1);
        scene_problem_clear(&s);
    }
    CHECK_CLOSE(log2(error[0] / error[1]), 2, 0.05, "order 2 in the distance of particles");
}

/* ------------------------------------------------------------------------------------------------------ catenary */

typedef struct cable {
    double length, weight, stiffness, across; /* [m], [N], EA [N], [m] between supports at one height */
} cable;

/* Irvine, Cable structures (1981): a cable between supports at one height, with the horizontal tension H. The distance of
   the supports, and the sag below them. */
static double distance(const cable *c, double H)
{
    return H * c->length / c->stiffness + 2 * H * c->length / c->weight * asinh(c->weight / (2 * H));
}

static double sag(const cable *c, double H)
{
    const double V = c->weight / 2;
    return c->weight * c->length / (8 * c->stiffness) + H * c->length / c->weight * (sqrt(1 + V * V / (H * H)) - 1);
}

static double too_far(double H, const double *of)
{
    const cable c = {of[0], of[1], of[2], of[3]};
    return distance(&c, H) - c.across;
}

/* The sag of n links at rest. Masses are those of the cable around them, so the pinned ones carry half of a link. */
static double hanging_sag(const cable *c, uint32_t n)
{
    const double g = 9.81, mass = c->weight / g / n, spacing = c->length / n, k = c->stiffness / spacing;
    scene_problem p = {0};
    scene_problem_make(&p, 2, n + 1, n, mass);
    p.def.gravity[1] = -g;
    p.def.drag = 2 * mass * sqrt(g / c->length);
    p.pinned[0] = p.pinned[n] = 1;
    for (uint32_t i = 0; i <= n; i++) {
        p.position[2 * i] = c->across * i / n;
        p.position[2 * i + 1] = -0.3 * sin(pi * i / n);
        if (i > 0)
            p.link[i - 1] = (spring_link){.a = i - 1, .b = i, .rest = spacing, .stiffness = k};
    }
    spring_scene *scene = start_definition(&p.def, NULL);
    double lowest[2];
    const double dt = spring_scene_stable_step(scene, SPRING_LEAPFROG) / 2;
    CHECK(spring_scene_advance(scene, SPRING_LEAPFROG, dt, (uint64_t)(60 / dt)) == SPRING_OK, "it comes to rest");
    spring_scene_get(scene, SPRING_POSITION, lowest, 0, n / 2, 1);
    free(scene);
    scene_problem_clear(&p);
    return -lowest[1];
}

static void catenary(void)
{
    const cable c = {1.2, 30, 400, 1};
    const double of[] = {c.length, c.weight, c.stiffness, c.across}, H = root(too_far, of, 1e-3, 1e4);
    const double theory = sag(&c, H), coarse = hanging_sag(&c, 20), fine = hanging_sag(&c, 40);
    found("elastic catenary of 20 links, sag / m", theory, coarse, 2e-3, "of order 2 in the length of links");
    found("elastic catenary, extrapolated from 20 and 40 links", theory, fine + (fine - coarse) / 3, 2e-6,
          "of order 4");
    CHECK_CLOSE(log2((coarse - theory) / (fine - theory)), 2, 0.05, "order 2 in the length of links");
}

int main(void)
{
    static const test tests[] = {
        {"Duffing oscillator", duffing}, {"pendulum", pendulum},           {"FPUT recurrence", recurrence},
        {"Toda soliton", soliton_moves}, {"hanging chain", hanging_chain}, {"rod with an end mass", rod_with_end_mass},
        {"square membrane", membrane},   {"elastic catenary", catenary},
    };
    return RUN_TESTS("published", tests);
}
