/* SPDX-License-Identifier: MIT */
/*
 * The table of corner cases of scenes; see scenes.h.
 *
 * The known digits of nonlinear cases were computed twice in quadruple precision, with different steps. Cases whose
 * equations have k = m = 1 are run with another mass and with forces scaled accordingly.
 *
 * The bound on the terms of a callback (.callback) follows from energy for the double pendulum (rates^2 <= 59 and 118)
 * and for the quartic springs (length^4 <= 2), otherwise from the amplitude.
 *
 * The largest steps are so small that errors follow their power law: over the whole run the phase error of the fastest
 * mode is less than a tenth, and Euler's method amplifies by less than e. They are powers of two if a force depends on
 * time.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/reference.h"
#include "harness/scenes.h"

static const double mass = 1.3; /* [kg] */
static const double pi = 3.14159265358979323846;

static void make(scene_problem *p, uint32_t axes, size_t particles, size_t links)
{
    scene_problem_make(p, axes, particles, links, mass);
}

/* Particles of different mass. */
static void weigh(scene_problem *p, size_t i, double kilograms)
{
    p->mass[i] = kilograms;
    p->def.mass = p->mass;
}

/* -------------------------------------------------------------------------------------- systems with a callback */

typedef const double *const *state_arrays;
typedef double *const *force_arrays;

static void cubic(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    (void)user, (void)t, (void)particles, (void)v;
    force[0][0] -= mass * x[0][0] * x[0][0] * x[0][0];
}

static void gravity_on_a_circle(void *user, double t, size_t particles, state_arrays x, state_arrays v,
                                force_arrays force)
{
    (void)user, (void)t, (void)particles, (void)v;
    force[0][0] -= mass * sin(x[0][0]);
}

static void cubic_driven(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    cubic(user, t, particles, x, v, force);
    force[0][0] += mass * 7.5 * cos(t);
}

static void van_der_pol(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    const double mu = (double)((const scene_case *)user)->count;
    (void)t, (void)particles;
    force[0][0] += mass * mu * (1 - x[0][0] * x[0][0]) * v[0][0];
}

static void resonant(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    (void)user, (void)particles, (void)x, (void)v;
    force[0][0] += mass * 0.7 * cos(t);
}

/* One moving coordinate with a force, attached to 0 (particle 1, which is pinned) if it has a spring. The damping of
   the chaotic motion is a drag. */
static void build_one(const scene_case *c, scene_problem *p)
{
    make(p, 1, 2, c->spring);
    p->position[0] = c->x;
    p->velocity[0] = c->v;
    p->pinned[1] = true;
    p->link[0] = (spring_link){0, 1, 0, mass, 0, 0};
    p->def.force = c->force;
    p->def.user = (void *)c;
    if (c->force == cubic_driven)
        p->def.drag = 0.05 * mass;
    if (c->force != van_der_pol && c->force != gravity_on_a_circle)
        p->def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
}

static void solve_resonance(const scene_case *c, const scene_problem *p, double *y)
{
    const double t = c->duration;
    (void)p;
    y[0] = 0.35 * t * sin(t);
    y[1] = 0.35 * (sin(t) + t * cos(t));
}

/* Two angles from the vertical, unit rods, equal masses. The mass matrix depends on the angles, and the forces depend
   on velocities. */
static void double_pendulum(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    (void)user, (void)t, (void)particles;
    const double g = 9.81, one = x[0][0], two = x[0][1], w1 = v[0][0] * v[0][0], w2 = v[0][1] * v[0][1];
    const double between = one - two, S = 2 * sin(between), C = cos(between), inertia = 3 - cos(2 * between);
    force[0][0] -= mass * (g * (3 * sin(one) + sin(one - 2 * two)) + S * (w2 + w1 * C)) / inertia;
    force[0][1] += mass * S * (2 * w1 + 2 * g * cos(one) + w2 * C) / inertia;
}

static void build_double_pendulum(const scene_case *c, scene_problem *p)
{
    (void)c;
    make(p, 1, 2, 0);
    p->position[0] = p->position[1] = pi / 2;
    p->def.force = double_pendulum;
}

/* The Fermi-Pasta-Ulam problem: the potential (q_2i+1 - q_2i)^4 between pairs and to the walls.
   Source: Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.5.1. */
static void soft_quartic(void *user, double t, size_t particles, state_arrays x, state_arrays v, force_arrays force)
{
    (void)user, (void)t, (void)v;
    for (size_t i = 0; i <= particles; i += 2) {
        const double left = i > 0 ? x[0][i - 1] : 0, right = i < particles ? x[0][i] : 0;
        const double pull = 4 * mass * pow(right - left, 3);
        if (i > 0)
            force[0][i - 1] += pull;
        if (i < particles)
            force[0][i] -= pull;
    }
}

static void build_stiff_and_soft(const scene_case *c, scene_problem *p)
{
    const double omega = 50;
    (void)c;
    make(p, 1, 6, 3);
    for (uint32_t i = 0; i < 3; i++)
        p->link[i] = (spring_link){2 * i, 2 * i + 1, 0, mass * omega * omega / 2, 0, 0};
    p->position[0] = (1 - 1 / omega) / sqrt(2);
    p->position[1] = (1 + 1 / omega) / sqrt(2);
    p->velocity[1] = sqrt(2);
    p->def.force = soft_quartic;
    p->def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
}

/* --------------------------------------------------------------------------------------------- scenes of links */

static void build_elastic_pendulum(const scene_case *c, scene_problem *p)
{
    (void)c;
    make(p, 2, 2, 1);
    p->pinned[0] = true;
    p->position[2] = 1.2;
    p->position[3] = -0.1;
    p->velocity[2] = -0.3;
    p->velocity[3] = 0.4;
    p->link[0] = (spring_link){0, 1, 1, 52, 0, 0};
    p->def.gravity[1] = -9.81;
}

/* A row of particles in the plane, sloping down by half. The first one is pinned. */
static void make_row(scene_problem *p, size_t particles, double spacing, double stretch)
{
    make(p, 2, particles, particles - 1);
    p->pinned[0] = true;
    for (uint32_t i = 0; i < particles; i++) {
        p->position[2 * i] = 0.6 * spacing * stretch * i;
        p->position[2 * i + 1] = -0.8 * spacing * stretch * i;
        if (i > 0)
            p->link[i - 1] = (spring_link){i - 1, i, spacing, 0, 0, 0};
    }
    p->def.gravity[1] = -9.81;
}

static void build_rope(const scene_case *c, scene_problem *p)
{
    const double light = 1e-3, heavy = 10; /* [kg] */
    (void)c;
    make_row(p, 12, 0.1, 1.08);
    for (size_t i = 0; i + 1 < p->def.particles; i++) {
        weigh(p, i, light);
        p->link[i].stiffness = 1e4;
        for (size_t d = 0; d < 2 && i > 0; d++)
            p->velocity[2 * i + d] = 3 * sin(2.1 * (double)(2 * i + d));
    }
    weigh(p, p->def.particles - 1, heavy);
}

static void build_stiffness_ratio(const scene_case *c, scene_problem *p)
{
    (void)c;
    make_row(p, 8, 0.5, 1.01);
    for (size_t i = 0; i < p->def.links; i++)
        p->link[i].stiffness = i % 2 == 0 ? 2.7e6 : 2.7;
}

/* Five bands of links (equal links, some with exchanged ends; a gap; different rest length, stiffness, damping) and two
   unbanded links. In the plane the scene falls freely. */
static void build_patchwork(const scene_case *c, scene_problem *p)
{
    const uint32_t axes = (uint32_t)c->count, particles = 14, gap = 6;
    make(p, axes, particles, 13 + 12 + 10 + 10 + 9 + 2);
    for (uint32_t i = 0; i < particles; i++) {
        p->pinned[i] = axes == 1 && (i == 0 || i == 7);
        for (uint32_t d = 0; d < axes; d++) {
            p->position[axes * i + d] = 0.3 * (d == 0 ? i : i % 3) + 0.05 * sin(2.3 * (3 * i + d));
            p->velocity[axes * i + d] = p->pinned[i] ? 0 : 0.4 * cos(1.9 * (3 * i + d));
        }
    }
    spring_link *link = p->link;
    for (uint32_t i = 1; i < particles; i++)
        *link++ = i % 4 == 0 ? (spring_link){i, i - 1, 0.25, 31, 0, 0} : (spring_link){i - 1, i, 0.25, 31, 0, 0};
    for (uint32_t i = 2; i < particles; i++)
        *link++ = (spring_link){i - 2, i, 0.5 + 0.03 * (i % 3), 23, 0, 0};
    for (uint32_t i = 3; i < particles; i++)
        if (i != gap)
            *link++ = (spring_link){i - 3, i, 0.8, 17, 0, 0};
    for (uint32_t i = 4; i < particles; i++)
        *link++ = (spring_link){i - 4, i, 1.1, 4.0 * (i % 3), 0.1, 0};
    for (uint32_t i = 5; i < particles; i++)
        *link++ = (spring_link){i - 5, i, 1.4, 3, 0.3 * (i % 2), 0};
    *link++ = (spring_link){1, 9, 2.1, 12, 0, 0};
    *link++ = (spring_link){10, 4, 1.9, 14, 0.2, 0};
    if (axes > 1)
        p->def.pinned = NULL;
    p->def.gravity[axes - 1] = -9.81;
    p->def.drag = 0.2;
}

static void build_cloth(const scene_case *c, scene_problem *p)
{
    const spring_grid g = {.count = {5, 5, 1},
                           .axes = 3,
                           .spacing = 0.2,
                           .stretch = 1.02,
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                           .stiffness = 500,
                           .damping = 0.4,
                           .pinned = SPRING_GRID_FIRST_Y};
    (void)c;
    scene_problem_grid(p, &g, 0, mass);
    p->def.gravity[1] = -2;
    p->def.gravity[2] = -9.5;
    p->def.drag = 0.3;
    for (size_t i = 0; i < 3 * p->def.particles; i++)
        if (!p->pinned[i / 3])
            p->velocity[i] = 0.8 * sin(2.1 * (double)i);
}

static void build_water(const scene_case *c, scene_problem *p)
{
    const spring_grid g = {.count = {7, 7, 1},
                           .height = true,
                           .spacing = 0.2,
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                           .stiffness = 25,
                           .pinned =
                               SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y};
    (void)c;
    scene_problem_grid(p, &g, 0, mass);
    for (size_t i = 0; i < p->def.particles; i++)
        if (!p->pinned[i]) {
            p->position[i] = 0.1 * exp(-0.5 * pow((double)i - 16, 2));
            p->velocity[i] = 0.5 * sin(1.7 * (double)i);
        }
    p->def.drag = 0.5;
}

/* A sheet of 4 m at rest in one of its modes, with N particles along an edge, named ...-mode-P-Q-KIND-N. KIND is
   height-field water with structural links only, or with structural, shear and bend links, or with these mirrored at
   the edges, or a sheet in space under tension. The links of spring_grid_fill() have no simple modes if bend links are
   included: a particle next to the edge lacks the bend link to its mirror image, which has the opposite height. A link
   of twice the stiffness to the edge replaces it. */
static void build_mode(const scene_case *c, scene_problem *p)
{
    unsigned P = 0, Q = 0, N = 0;
    char kind[16] = "";
    if (sscanf(c->name, "%*[a-z]-mode-%u-%u-%15[a-z]-%u", &P, &Q, kind, &N) != 4)
        exit(EXIT_FAILURE);
    const bool tension = strcmp(kind, "tension") == 0, mirrored = strcmp(kind, "mirrored") == 0,
               all = mirrored || strcmp(kind, "all") == 0;
    const spring_grid g = {
        .count = {N, N},
        .axes = tension ? 3 : 1,
        .height = !tension,
        .spacing = 4.0 / (N - 1),
        .stretch = tension ? 1.25 : 0,
        .families = all ? SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND : SPRING_GRID_STRUCTURAL,
        .stiffness = 25000,
        .pinned = SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y};
    size_t links = scene_problem_grid(p, &g, mirrored ? 4 * (N - 2) : 0, 1);
    for (uint32_t i = 1; mirrored && i + 1 < N; i++) {
        const uint32_t row = i * N, last = N * N - N,
                       twice[][2] = {{row, row + 1}, {row + N - 2, row + N - 1}, {i, N + i}, {last - N + i, last + i}};
        for (int side = 0; side < 4; side++)
            p->link[links++] = (spring_link){twice[side][0], twice[side][1], 0, 2 * g.stiffness, 0, 0};
    }
    for (size_t i = 0; i < p->def.particles; i++)
        if (!p->pinned[i])
            p->position[g.axes * i + g.axes - 1] =
                sin(pi * P * (double)(i % N) / (N - 1)) * sin(pi * Q * (double)(i / N) / (N - 1));
}

/* ------------------------------------------------------------------------------------------------ linear scenes */

static const double chain_stiffness = 2.7, chain_spacing = 0.5; /* [N/m], [m] */

/* Equal masses between two walls. */
static void build_chain(const scene_case *c, scene_problem *p)
{
    const size_t n = c->count;
    make(p, 1, n + 2, n + 1);
    p->pinned[0] = p->pinned[n + 1] = true;
    for (uint32_t i = 0; i < n + 2; i++) {
        const bool inside = !p->pinned[i];
        p->position[i] = chain_spacing * i + (inside ? 0.1 * sin(1.7 * i) : 0);
        p->velocity[i] = inside ? 0.15 * cos(2.3 * i) : 0;
        if (i > 0)
            p->link[i - 1] = (spring_link){i - 1, i, chain_spacing, chain_stiffness, 0, 0};
    }
}

/* omega_j = 2 sqrt(k/m) sin(j pi/(2 (n + 1))), shape sin(i j pi/(n + 1)). */
static void chain_modes(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t steps,
                        double *y)
{
    const size_t n = c->count, period = 2 * (n + 1);
    const long double quarter = 2 * atanl(1), highest = 2 * sqrtl((long double)chain_stiffness / mass);
    long double *sine = scene_room(period, sizeof *sine), *end = scene_room(2 * n, sizeof *end);
    for (size_t i = 0; i < period; i++)
        sine[i] = sinl(2 * quarter * (long double)i / (long double)(n + 1));
    for (size_t j = 1; j <= n; j++) {
        long double x = 0, v = 0;
        for (size_t i = 1; i <= n; i++) {
            x += sine[i * j % period] * (p->position[i] - chain_spacing * (long double)i);
            v += sine[i * j % period] * p->velocity[i];
        }
        reference_mode(m, highest * sinl(quarter * (long double)j / (long double)(n + 1)), h, steps, &x, &v);
        for (size_t i = 1; i <= n; i++) {
            end[i - 1] += sine[i * j % period] * x;
            end[n + i - 1] += sine[i * j % period] * v;
        }
    }
    for (size_t i = 0; i < n; i++) {
        y[i] = (double)(chain_spacing * (long double)(i + 1) + end[i] * 2 / (long double)(n + 1));
        y[n + i] = (double)(end[n + i] * 2 / (long double)(n + 1));
    }
    free(sine);
    free(end);
}

/* Two particles and a link. They move along their common line, and their centre of mass drifts. */
static const double pair_mass[] = {1.3, 0.4}, pair_stiffness = 2.7, pair_rest = 1.25; /* [kg], [N/m], [m] */
static const double pair_delta[] = {0.5, 1, 1}, pair_length = 1.5; /* [m] exactly: without rotation */
static const double pair_rate = -0.75;                             /* [m/s] rate of the length */
static const double pair_drift[] = {0.3, -0.2, 0.1};               /* [m/s] of the first particle */

static void build_pair(const scene_case *c, scene_problem *p)
{
    const uint32_t axes = (uint32_t)c->count;
    make(p, axes, 2, 1);
    for (uint32_t d = 0; d < axes; d++) {
        const double along = axes == 1 ? 1 : pair_delta[d] / pair_length;
        p->position[axes + d] = axes == 1 ? pair_length : pair_delta[d];
        p->velocity[d] = pair_drift[d];
        p->velocity[axes + d] = pair_drift[d] + pair_rate * along;
    }
    for (size_t i = 0; i < 2; i++)
        weigh(p, i, pair_mass[i]);
    p->link[0] = (spring_link){0, 1, pair_rest, pair_stiffness, 0, 0};
}

static void build_damped_pair(const scene_case *c, scene_problem *p)
{
    build_pair(c, p);
    p->link[0].damping = 0.4;
}

/* Computes both particles from the extension of the link, its rate, and the centre of mass. */
static void place_pair(const scene_case *c, const scene_problem *p, long double t, long double x, long double v,
                       double *y)
{
    const size_t axes = c->count;
    const long double share = pair_mass[1] / ((long double)pair_mass[0] + pair_mass[1]);
    for (size_t d = 0; d < axes; d++) {
        const long double along = axes == 1 ? 1 : pair_delta[d] / (long double)pair_length;
        const long double drift = p->velocity[d] + share * pair_rate * along;
        const long double centre = p->position[d] + share * pair_length * along + drift * t;
        const long double delta = (pair_rest + x) * along, rate = v * along;
        y[d] = (double)(centre - share * delta);
        y[axes + d] = (double)(centre + (1 - share) * delta);
        y[2 * axes + d] = (double)(drift - share * rate);
        y[3 * axes + d] = (double)(drift + (1 - share) * rate);
    }
}

static void iterate_pair(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t n, double *y)
{
    const long double inverse = 1 / (long double)pair_mass[0] + 1 / (long double)pair_mass[1];
    long double x = (long double)pair_length - pair_rest, v = pair_rate;
    reference_mode(m, sqrtl(pair_stiffness * inverse), h, n, &x, &v);
    place_pair(c, p, (long double)n * h, x, v, y);
}

static void solve_damped_pair(const scene_case *c, const scene_problem *p, double *y)
{
    const spring_params reduced = {1 / (1 / pair_mass[0] + 1 / pair_mass[1]), pair_stiffness, p->link[0].damping, 0};
    reference exact;
    reference_init(&exact);
    reference_start(&exact, &reduced, (spring_state){pair_length - pair_rest, pair_rate});
    reference_exact(&exact, &reduced, c->duration);
    place_pair(c, p, c->duration, mpfr_get_ld(exact.x, MPFR_RNDN), mpfr_get_ld(exact.v, MPFR_RNDN), y);
    reference_clear(&exact);
}

/* ------------------------------------------------------------------------------------------------ the catalogue */

#define STEPS(first, second, fourth, eighth) .steps = {first, second, fourth, eighth} /* order; eighth also for 6 */
#define CHAIN(n, first, last)                                                                                   \
    .build = build_chain, .count = n, .omega = 1.44, .length = 0.1, .formula = "modes", .iterate = chain_modes, \
    .slowest = first, .fastest = last
#define PAIR(axes)                                                                             \
    .build = build_pair, .count = axes, .omega = 2.97, .length = 1, .formula = "reduced-mass", \
    .iterate = iterate_pair, .slowest = 0, .fastest = 2.972
#define LONG  .duration = 16, STEPS(1024, 512, 512, 64)
#define BRIEF .duration = 0.125, STEPS(4, 4, 4, 4)
/* A mode for some eighths of a second, by methods of order 2 or more. RK4 uses about half its stable step,
   2.61/sqrt(8 k/m) with structural links and 2.61/sqrt(24 k/m) with all links. Leapfrog uses 0.4 of 2/sqrt(8 k/m): at
   half of it, the frequency error z^2/24 of mode (3, 1) at 15 x 15 exceeds half a percent. .length and .omega follow
   from the mode. */
#define MODE(name, purpose, eighths, second, fourth, eighth, takes_long)                                       \
    {                                                                                                          \
        name, purpose, build_mode, .duration = (eighths) / 8.0,                                                \
                                   STEPS(0, (eighths) * (second), (eighths) * (fourth), (eighths) * (eighth)), \
                                   .formula = "dispersion", .slow = (takes_long)                               \
    }
#define WAVE(mode, N, eighths, takes_long)                                                                          \
    MODE("water-mode-" mode "-structural-" N, "a standing wave of " N " x " N " heights", eighths, 70, 43, 36,      \
         takes_long),                                                                                               \
        MODE("water-mode-" mode "-mirrored-" N,                                                                     \
             "the same with structural, shear and bend springs, mirrored at the edges", (eighths) / 2, 121, 75, 62, \
             takes_long),                                                                                           \
        MODE("water-mode-" mode "-all-" N, "the same without mirroring: bend links are missing at the edges",       \
             (eighths) / 2, 121, 75, 62, takes_long)

const scene_case scene_cases[] = {
    /* callbacks, with digits known */
    /* x'' = -x - x^3 */
    {"duffing", "a spring that hardens", build_one, .spring = true, .x = 1, .force = cubic, .duration = 1,
     STEPS(512, 128, 32, 4), .omega = 1, .length = 1, .callback = 1, .known = 1, .digits = {0.233691791143141266259324},
     .external = true},
    {"duffing-period", "the same for one period, back to the start", build_one, .spring = true, .x = 1, .force = cubic,
     .duration = 4.768022029102460806304518, STEPS(4096, 512, 128, 16), .omega = 1, .length = 1, .callback = 1,
     .known = 2, .digits = {1, 0}},
    /* x'' = -sin x */
    {"pendulum", "a pendulum that starts next to its highest point", build_one, .x = 3, .force = gravity_on_a_circle,
     .duration = 10, STEPS(10240, 1280, 160, 0), .omega = 1, .length = 3, .callback = 1, .known = 1,
     .digits = {-2.650674563598209613232602}, .external = true},
    {"pendulum-period", "the same for one period, past the highest point", build_one, .x = 3,
     .force = gravity_on_a_circle, .duration = 16.15553937239337476376028, STEPS(16384, 2048, 256, 0), .omega = 1,
     .length = 3, .callback = 1, .known = 2, .digits = {3, 0}},
    /* x'' = -0.05 x' - x^3 + 7.5 cos t */
    {"chaotic-10", "chaotic motion under a drive", build_one, .x = 3, .v = 4, .force = cubic_driven, .duration = 10,
     STEPS(163840, 20480, 1280, 160), .omega = 1, .length = 4, .callback = 100, .known = 2,
     .digits = {-0.92175345784461174225, 5.2692478469465402339}, .external = true},
    {"chaotic-50", "the same for a longer time", build_one, .x = 3, .v = 4, .force = cubic_driven, .duration = 50,
     STEPS(0, 102400, 3200, 400), .omega = 1, .length = 4, .callback = 100, .known = 2,
     .digits = {1.2219466385675419578, 5.5654797876653488797}, .external = true, .slow = true},
    /* x'' = mu (1 - x^2) x' - x */
    {"van-der-pol-1", "damping that depends on position and drives the motion", build_one, .spring = true, .x = 2,
     .force = van_der_pol, .count = 1, .duration = 20, STEPS(81920, 10240, 1280, 0), .omega = 1, .length = 2,
     .callback = 17, .known = 2, .digits = {2.0081497621749485920, -0.042508875273202146986}, .external = true},
    {"van-der-pol-5", "the same with jumps", build_one, .spring = true, .x = 2, .force = van_der_pol, .count = 5,
     .duration = 20, STEPS(327680, 40960, 2560, 0), .omega = 1, .length = 2, .callback = 205, .known = 2,
     .digits = {-1.6012968795428539088, 0.19832667633866208454}, .external = true, .slow = true},
    {"stiff-and-soft-1", "stiff springs and soft quartic ones in a row", build_stiff_and_soft, .duration = 1,
     STEPS(16384, 2048, 512, 64), .omega = 50, .length = 1, .callback = 12, .known = 2,
     .digits = {0.51767820806882268094, 0.53980860868328140544}, .external = true},
    {"stiff-and-soft-10", "the same for a longer time", build_stiff_and_soft, .duration = 10,
     STEPS(0, 81920, 2560, 320), .omega = 50, .length = 1, .callback = 12, .known = 2,
     .digits = {0.75633242161029198993, 0.71735962155453710255}, .external = true, .slow = true},
    {"double-pendulum", "inertia that depends on the angles", build_double_pendulum, .duration = 5,
     STEPS(81920, 10240, 640, 0), .omega = 3, .length = 1, .callback = 256, .known = 2,
     .digits = {-0.62718670506653073014, -1.3013155502098116779}, .external = true},
    /* x'' = -x + 0.7 cos t */
    {"resonant-drive", "a drive in the callback, sampled at every stage", build_one, .spring = true, .force = resonant,
     .duration = 20, STEPS(20480, 2560, 640, 80), .omega = 1, .length = 7, .callback = 0.7, .formula = "formula",
     .solution = solve_resonance, .external = true},
    /* links */
    {"elastic-pendulum", "a spring that swings", build_elastic_pendulum, .duration = 8, STEPS(65536, 4096, 1024, 56),
     .omega = 6, .length = 1, .external = true},
    {"heavy-end", "a rope with 10^4 times the mass at its end", build_rope, .duration = 1.0 / 32,
     STEPS(0, 4096, 1024, 128), .omega = 6325, .length = 0.1, .external = true, .slow = true},
    {"stiff-links", "alternating stiffnesses 1 : 10^6", build_stiffness_ratio, .duration = 1.0 / 16,
     STEPS(0, 4096, 1024, 128), .omega = 2038, .length = 0.5, .external = true, .slow = true},
    {"patchwork", "rows of links, each different from the next, on a line", build_patchwork, .count = 1,
     .duration = 0.5, STEPS(512, 128, 64, 0), .omega = 21, .length = 0.3, .external = true},
    {"patchwork-2d", "the same in the plane, falling", build_patchwork, .count = 2, .duration = 0.5,
     STEPS(512, 128, 64, 0), .omega = 21, .length = 0.3, .external = true},
    {"cloth", "a sheet in space, damped, falling", build_cloth, .duration = 0.25, STEPS(0, 256, 128, 0), .omega = 100,
     .length = 0.2, .external = true, .slow = true},
    {"water", "height-field water", build_water, .duration = 1, STEPS(2048, 256, 128, 16), .omega = 21, .length = 0.1,
     .external = true, .slow = true},
    /* linear chains, with fixed ends */
    {"chain-1", "one mass between walls", CHAIN(1, 2.038, 2.039), LONG},
    {"chain-2", "two", CHAIN(2, 1.441, 2.497), LONG},
    {"chain-2-briefly", "so few steps that rounding errors cannot cancel", CHAIN(2, 1.441, 2.497), BRIEF},
    {"chain-10", "ten", CHAIN(10, 0.410, 2.853), LONG},
    {"chain-100", "a hundred masses", CHAIN(100, 0.0448, 2.883), LONG},
    {"chain-1000", "a thousand masses: waves as long as the chain and as short as a link", CHAIN(1000, 0.00452, 2.883),
     LONG, .slow = true},
    /* two particles */
    {"pair", "two masses on a line and their link: one spring of the reduced mass", PAIR(1), LONG},
    {"pair-3d", "the same in space, drifting", PAIR(3), LONG},
    {"pair-briefly", "the same with so few steps that rounding errors cannot cancel", PAIR(3), BRIEF},
    {"pair-damped", "the same with damping along the link", build_damped_pair, .count = 3, .duration = 4,
     STEPS(1024, 256, 64, 0), .omega = 2.97, .length = 1, .formula = "reduced-mass", .solution = solve_damped_pair,
     .external = true},
    /* standing waves */
    WAVE("1-1", "15", 4, false),
    WAVE("2-1", "15", 4, false),
    WAVE("2-2", "15", 4, false),
    WAVE("3-1", "15", 4, false),
    WAVE("1-1", "25", 4, true),
    WAVE("2-1", "25", 4, true),
    WAVE("2-2", "25", 4, true),
    WAVE("3-1", "25", 4, true),
    WAVE("1-1", "35", 6, true),
    WAVE("2-1", "35", 6, true),
    WAVE("2-2", "35", 6, true),
    WAVE("3-1", "35", 6, true),
    MODE("sheet-mode-1-1-tension-15", "a standing wave of a sheet in space, under tension", 8, 70, 43, 36, false),
};

uint64_t scene_case_steps(const scene_case *c, spring_method m)
{
    const spring_method_info *info = spring_method_describe(m);
    if (!info->scenes)
        return 0;
    return c->steps[info->order < 2 ? 0 : info->order < 4 ? 1 : info->order < 6 ? 2 : 3];
}

const size_t scene_case_count = sizeof scene_cases / sizeof scene_cases[0];
