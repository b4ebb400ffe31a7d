/* SPDX-License-Identifier: MIT */
/* Impulses on colliders, and bodies that particles push: the loops of docs/games.md. */
#include "test_contact.h"

#include <stdio.h>

/* A random scene, whose forces have no moment except for gravity, on random colliders: what particles lose, colliders
   get, with friction, too. */
static void balance(spring_method method, uint32_t axes, double *worst)
{
    enum { steps = 40, most_bodies = 3 };
    static model m;
    const double h = 0.004;
    build(&m, (const uint32_t[]){5, 4, axes - 1}, axes,
          (unsigned)random_bits() % feature_masks & ~(unsigned)(PINNED | DRAG));
    if (method == SPRING_RK4)
        m.def.links = 0; /* links act at the stages */
    const bool heavy = method == SPRING_LEAPFROG && m.link[0].damping > 0 && random_bits() % 2 == 0;
    for (size_t i = 0; i < m.def.links && heavy; i++)
        m.link[i].damping *= 1000; /* the exponential kick */
    m.def.colliders = 1 + (uint32_t)(random_bits() % most_bodies);
    m.def.particle_radius = 0.02;
    m.def.methods = 1u << method;
    spring_collider c[most_bodies];
    for (uint32_t i = 0; i < m.def.colliders; i++)
        c[i] = random_collider(axes);
    spring_scene *s = scene_with(&m.def, c);
    double gravity_of[3] = {0}, given[3] = {0}, turned[3] = {0}, size = 0;
    memcpy(gravity_of, m.def.gravity, axes * sizeof *gravity_of);
    const momenta first = momenta_of(&m, s);
    momenta last = first;
    for (int k = 0; k < steps; k++) {
        const momenta before = last;
        spring_impulse j[most_bodies];
        uint32_t count = most_bodies;
        run(s, method, h, 1);
        CHECK(spring_scene_impulses(s, j, 0, m.def.colliders) == SPRING_OK, "impulses");
        CHECK(spring_scene_get_colliders(s, c, &count) == SPRING_OK, "the points that impulses are about");
        last = momenta_of(&m, s);
        size += last.size;
        double middle[3], moment[3];
        /* where gravity acts: at the start, at both ends, or in the middle before contacts */
        for (int a = 0; a < 3; a++)
            middle[a] = method == SPRING_SYMPLECTIC_EULER     ? before.place[a]
                        : method == SPRING_LEAPFROG && !heavy ? (before.place[a] + last.place[a]) / 2
                                                              : before.place[a] + h / 2 * before.linear[a];
        cross(middle, gravity_of, moment);
        for (int a = 0; a < 3; a++)
            given[a] -= h * before.mass * gravity_of[a], turned[a] -= h * moment[a];
        for (uint32_t i = 0; i < count; i++) {
            cross(c[i].at, j[i].linear, moment);
            for (int a = 0; a < 3; a++)
                given[a] += j[i].linear[a], turned[a] += j[i].angular[a] + moment[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        *worst = fmax(*worst, fabs(last.linear[a] - first.linear[a] + given[a]) / size);
        *worst = fmax(*worst, fabs(last.angular[a] - first.angular[a] + turned[a]) / size);
    }
    free(s);
}

static void momentum_balance(void)
{
    static const spring_method of[] = {SPRING_LEAPFROG, SPRING_SYMPLECTIC_EULER, SPRING_RK4};
    for (int m = 0; m < 3; m++) {
        double worst = 0;
        for (int k = 0; k < 100; k++)
            balance(of[m], 2 + (uint32_t)k % 2, &worst);
        printf("# method %d: off by %.1e of the sum of m |v| (1 + |x|) over all steps\n", (int)of[m], worst);
        CHECK_BELOW(worst, in_double ? 1e-11 : 1e-5, "rounding errors, which narrow corners amplify");
    }
}

/* The loop of docs/games.md: a ball of mass M takes the impulses of `count` particles, m in total, after each call. The
   speed of the ball is the last one known, so energy is not conserved: its ratio to the right one, minus 1. */
static double coupled(int count, double ratio, double e)
{
    double x[64][3] = {{0}}, v[64][3] = {{0}};
    const double M = 5, m = ratio * M / count;
    for (int i = 0; i < count; i++) /* beams along x, that hit at different times */
        x[i][0] = -0.5 - 0.3 * i / count, v[i][0] = 3;
    const double P0 = count * m * 3, E0 = P0 * 3 / 2;
    spring_scene_def def = falling((size_t)count, x[0], v[0], m);
    def.gravity[1] = 0;
    spring_collider c = {.shape = SPRING_SPHERE, .radius = 0.1, .restitution = e};
    spring_scene *s = scene_of(&def);
    for (int f = 0; f < 60; f++) {
        spring_impulse j;
        set(s, &c, 1);
        run(s, SPRING_LEAPFROG, 1. / 480, 8);
        spring_scene_impulses(s, &j, 0, 1);
        for (int a = 0; a < 3; a++) {
            c.at[a] += 8. / 480 * c.velocity[a];
            c.velocity[a] += j.linear[a] / M;
        }
    }
    spring_scene_get(s, SPRING_VELOCITY, v[0], 0, 0, (size_t)count);
    double P1 = M * c.velocity[0], E1 = M * dot(c.velocity, c.velocity) / 2;
    for (int i = 0; i < count; i++)
        P1 += m * v[i][0], E1 += m * dot(v[i], v[i]) / 2;
    free(s);
    CHECK_BELOW(fabs(P1 / P0 - 1), in_double ? 1e-11 : 1e-5, "momentum is conserved");
    return E1 / E0;
}

static void coupling(void)
{
    for (int many = 0; many < 2; many++)
        for (int e = 0; e < 3; e++)
            for (int k = 0; k < 5; k++) {
                const double ratio[] = {0.01, 0.05, 0.2, 0.5, 1};
                const double energy = coupled(many ? 64 : 1, ratio[k], 0.5 * e);
                if (in_double)
                    printf("# %d particles, m/M %.2f, e %.1f: energy %.3f of the start\n", many ? 64 : 1, ratio[k],
                           0.5 * e, energy);
            }
}

/* A body on a column of particles, which moves up and down. */
typedef struct loaded_column {
    uint32_t links; /* at most 10, of 2000 N/m */
    double mass;    /* of the body, relative to that of a particle, 0.05 kg */
    double damping; /* damping ratio of the links */
    double T;       /* [s] of a call */
    uint64_t steps; /* of a call */
    bool extrapolates;
} loaded_column;

enum { most_column_links = 10 };

static const double column_stiffness = 2000, column_mass = 0.05; /* [N/m], [kg] */

static double column_omega(const loaded_column *c) /* [rad/s] of the body */
{
    return sqrt(column_stiffness / c->links / (c->mass * column_mass));
}

static spring_scene *make_column(const loaded_column *c, double *top)
{
    double x[3 * (most_column_links + 1)] = {0};
    spring_link link[most_column_links];
    uint8_t pinned[most_column_links + 1] = {1};
    const double unit = column_mass * gravity / column_stiffness; /* [m] compression by the weight of a particle */
    const double rest = 4 * unit * (c->mass + c->links);
    for (uint32_t i = 0; i < c->links; i++) {
        link[i] = (spring_link){.a = i, .b = i + 1, .rest = rest, .stiffness = column_stiffness};
        link[i].damping = c->damping * sqrt(2 * column_stiffness * column_mass);
        x[3 * i + 4] = x[3 * i + 1] + rest - unit * (c->mass + c->links - i);
    }
    *top = x[3 * c->links + 1];
    spring_scene_def def = falling(c->links + 1, x, NULL, column_mass);
    def.pinned = pinned, def.links = c->links, def.link = link;
    return scene_of(&def);
}

/* A call of the loop of docs/games.md, for a body of mass M that rests on a scene. *before: the impulse of the last call */
static void couple(spring_scene *s, spring_collider *body, double M, double T, uint64_t steps, bool extrapolates,
                   double *before)
{
    spring_impulse j;
    set(s, body, 1);
    run(s, SPRING_LEAPFROG, T / (double)steps, steps);
    spring_scene_impulses(s, &j, 0, 1);
    body->at[1] += T * body->velocity[1] + T * T / 2 * body->acceleration[1];
    body->velocity[1] += j.linear[1] / M - gravity * T;
    const double last = isnan(*before) ? j.linear[1] : *before;
    body->acceleration[1] = (extrapolates ? 3 * j.linear[1] - last : 2 * j.linear[1]) / (2 * T * M) - gravity;
    *before = j.linear[1];
}

/* The loop of docs/games.md, with or without extrapolation of the force, for 40 s and at least 50 periods. Returns the
   amplitude in the last fifth relative to that in the first fifth. */
static double amplitude_ratio(const loaded_column *c)
{
    double rest, before = NAN, first = 0, last = 0;
    spring_scene *s = make_column(c, &rest);
    const double omega = column_omega(c);
    const int calls = (int)(fmax(40, 100 * PI / omega) / c->T);
    spring_collider body = {.shape = SPRING_PLANE, .axis = {{0, -1, 0}}, .at = {0, rest, 0}};
    body.velocity[1] = -0.1 * gravity / omega;
    for (int i = 0; i < calls; i++) {
        couple(s, &body, c->mass * column_mass, c->T, c->steps, c->extrapolates, &before);
        if (i < calls / 5)
            first = fmax(first, fabs(body.at[1] - rest));
        if (i >= calls - calls / 5)
            last = fmax(last, fabs(body.at[1] - rest));
    }
    free(s);
    return last / first;
}

/* The rules of docs/games.md. Between a body on one spring and light particles, one vibration matters; in columns,
   others can resonate with the calls. */
static void coupled_oscillation(void)
{
    const double omega_T[] = {0.1, 0.2, 0.35, 0.5, 0.6};
    for (int i = 0; i < 5; i++) {
        loaded_column c = {.links = 1, .mass = 1e4, .steps = 16, .extrapolates = true};
        c.T = omega_T[i] / column_omega(&c);
        const double ratio = amplitude_ratio(&c);
        printf("# omega T %.2f: amplitude multiplied by %.3f\n", omega_T[i], ratio);
        CHECK_BELOW(ratio, 1, "the coupling adds no energy");
        c.extrapolates = false;
        CHECK(omega_T[i] > 0.35 || amplitude_ratio(&c) > 1, "without extrapolation it does");
    }
}

/* With damping, calls of at most twice the stable step; without, of one step. */
static void coupled_columns(void)
{
    const double stable = sqrt(column_mass / column_stiffness); /* [s] 2/sqrt(4 k/m) */
    const uint32_t links[] = {2, 3, 5, most_column_links};
    for (int damped = 0; damped < 2; damped++) {
        double largest = 0;
        for (int n = 0; n < 4; n++)
            for (double mass = 20; mass < 400; mass *= 1.6) {
                loaded_column c = {
                    .links = links[n], .mass = mass, .extrapolates = true, .T = 0.3 * stable, .steps = 1};
                if (damped) {
                    c.damping = 0.02;
                    c.T = fmin(2 * stable, 0.6 / column_omega(&c));
                    c.steps = 4;
                }
                largest = fmax(largest, amplitude_ratio(&c));
            }
        printf("# columns, damping ratio %.2f: amplitude multiplied by up to %.3f\n", damped ? 0.02 : 0, largest);
        CHECK_BELOW(largest, damped ? 1 : 1.02, "the coupling adds no energy; without damping, vibrations beat");
    }
}

/* A plane of `layers` times the mass of the particles that it rests on, on a damped block, in calls of twice the stable
   step. Returns its largest speed in the last of four parts of 20 s, relative to the first. */
static double block_speed_ratio(double layers)
{
    enum { side = 3, count = side * side * side };
    const spring_grid g = {.count = {side, side, side},
                           .spacing = 0.1,
                           .stiffness = 1000,
                           .damping = 0.02 * sqrt(2 * 1000 * 0.05),
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                           .pinned = SPRING_GRID_FIRST_Y};
    double x[3 * count], largest[4] = {0}, before = NAN;
    uint8_t pinned[count];
    spring_link link[9 * count];
    size_t particles, links;
    CHECK(spring_grid_size(&g, &particles, &links) == SPRING_OK && links <= 9 * count, "room for the links");
    spring_grid_fill(&g, x, pinned, link);
    spring_scene_def def = falling(particles, x, NULL, 0.05);
    def.pinned = pinned, def.links = links, def.link = link;
    spring_scene *s = scene_of(&def);
    const double T = 2 * spring_scene_stable_step(s, SPRING_LEAPFROG), M = layers * side * side * 0.05;
    const int calls = (int)(20 / T);
    spring_collider body = {
        .shape = SPRING_PLANE, .axis = {{0, -1, 0}}, .at = {0, 0.1 * (side - 1), 0}, .friction = 0.5};
    body.acceleration[1] = -gravity;
    for (int i = 0; i < calls; i++) {
        couple(s, &body, M, T, 3, true, &before);
        largest[4 * i / calls] = fmax(largest[4 * i / calls], fabs(body.velocity[1]));
    }
    free(s);
    return largest[3] / largest[0];
}

static void coupled_blocks(void)
{
    CHECK_BELOW(block_speed_ratio(6), 0.5, "comes to rest");
    CHECK_BELOW(block_speed_ratio(20), 0.5, "comes to rest");
    CHECK(block_speed_ratio(4) > 0.5, "vibrates on");
}

/* A ball that is a collider and may turn. */
typedef struct turning_ball {
    double mass, inertia, radius, friction;
    double at[3], v[3], accel[3], spin[3], spin_accel[3];
    double before[2][3]; /* linear and angular impulse of the call before */
    int calls;
} turning_ball;

/* A call of the loop of docs/games.md. g: [m/s^2] the acceleration of the ball by gravity */
static void push_ball(spring_scene *s, turning_ball *b, const double g[3], double T, uint64_t steps)
{
    spring_collider c = {.shape = SPRING_SPHERE, .radius = b->radius, .friction = b->friction};
    spring_impulse j;
    double pushed[3], correction[3];
    memcpy(c.at, b->at, sizeof c.at);
    memcpy(c.velocity, b->v, sizeof c.velocity);
    memcpy(c.acceleration, b->calls > 0 ? b->accel : g, sizeof c.acceleration);
    memcpy(c.spin, b->spin, sizeof c.spin);
    memcpy(c.spin_acceleration, b->spin_accel, sizeof c.spin_acceleration);
    set(s, &c, 1);
    run(s, SPRING_LEAPFROG, T / (double)steps, steps);
    spring_scene_impulses(s, &j, 0, 1);
    for (int a = 0; a < 3; a++)
        pushed[a] = c.acceleration[a] - g[a];
    cross(b->v, pushed, correction);
    for (int a = 0; a < 3; a++) {
        const double linear = j.linear[a], angular = j.angular[a] + b->mass * T * T / 2 * correction[a];
        const double last[2] = {b->calls > 0 ? b->before[0][a] : linear, b->calls > 0 ? b->before[1][a] : angular};
        b->at[a] += T * b->v[a] + T * T / 2 * c.acceleration[a];
        b->v[a] += linear / b->mass + g[a] * T;
        b->spin[a] += angular / b->inertia;
        b->accel[a] = g[a] + (3 * linear - last[0]) / (2 * T * b->mass);
        b->spin_accel[a] = (3 * angular - last[1]) / (2 * T * b->inertia);
        b->before[0][a] = linear;
        b->before[1][a] = angular;
    }
    b->calls++;
}

/* Without gravity and friction, a ball hits a soft block beside its centre. */
static void coupled_momenta(void)
{
    const spring_grid g = {.count = {4, 4, 4},
                           .spacing = 0.1,
                           .stiffness = 100,
                           .damping = 0.14,
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND};
    static model m;
    build_grid(&m, &g, 0.02);
    m.def.axes = 3;
    m.def.particle_radius = 0.05;
    m.def.colliders = 1;
    for (int i = 0; i < 2; i++) {
        const double T = i == 0 ? 1. / 60 : 1. / 240;
        spring_scene *s = scene_of(&m.def);
        turning_ball b = {.mass = 5, .inertia = 0.18, .radius = 0.3, .at = {-0.3, 0.75, 0.15}, .v = {2, -1, 0}};
        double change[3] = {0}, moment[3], end[3], size;
        const momenta first = momenta_of(&m, s);
        cross(b.at, b.v, moment);
        for (double t = 0; t < 1; t += T)
            push_ball(s, &b, none, T, i == 0 ? 4 : 1);
        const momenta last = momenta_of(&m, s);
        cross(b.at, b.v, end);
        size = b.mass * sqrt(dot(moment, moment));
        for (int a = 0; a < 3; a++)
            change[a] = last.angular[a] - first.angular[a] + b.mass * (end[a] - moment[a]) + b.inertia * b.spin[a];
        CHECK_BELOW(sqrt(dot(change, change)), (in_double ? 1e-11 : 1e-4) * size, "angular momentum is conserved");
        CHECK_BELOW(sqrt(dot(b.spin, b.spin)), i == 0 ? 0.02 : 0.005, "a ball without friction does not turn");
        free(s);
    }
}

/* A ball with friction lands on a trampoline, and rolls and bounces until it lies in one of its cells. */
static void coupled_rolling(void)
{
    enum { side = 15 };
    const double spacing = 0.14, k = 2000, mass = 0.02;
    const spring_grid g = {.count = {side, side},
                           .spacing = spacing,
                           .stiffness = k,
                           .damping = 0.02 * sqrt(2 * k * mass),
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                           .pinned =
                               SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y};
    static model m;
    build_grid(&m, &g, mass);
    for (size_t i = 0; i < m.def.particles; i++) {
        double *const x = &m.position[3 * i];
        x[0] -= spacing * (side - 1) / 2;
        x[2] = x[1] - spacing * (side - 1) / 2;
        x[1] = 0;
    }
    m.def.gravity[1] = -gravity;
    m.def.drag = mass;
    m.def.particle_radius = 0.05;
    m.def.colliders = 1;
    spring_scene *s = scene_of(&m.def);
    turning_ball b = {
        .mass = 5, .inertia = 0.045, .radius = 0.15, .friction = 0.5, .at = {0, 0.3, 0}, .v = {0.5, 0, 0.2}};
    const double T = 0.02 * sqrt(0.13); /* it sinks by 0.13 m */
    const uint64_t steps = (uint64_t)ceil(T / (0.5 * spring_scene_stable_step(s, SPRING_LEAPFROG)));
    double energy[5];
    for (int i = 0; i <= 4000; i++) {
        const spring_scene_energies e = spring_scene_energy(s);
        energy[i / 1000] = e.kinetic + e.elastic + e.gravity + b.mass * (dot(b.v, b.v) / 2 + gravity * b.at[1]) +
                           b.inertia * dot(b.spin, b.spin) / 2;
        push_ball(s, &b, down, T, steps);
    }
    printf("# a ball on a trampoline: energy %.2f, %.2f, %.2f, %.2f J\n", energy[0], energy[1], energy[2], energy[3]);
    for (int i = 0; i < 3; i++)
        CHECK(energy[i + 1] < energy[i], "the coupling adds no energy");
    CHECK_BELOW(hypot(b.at[0], b.at[2]), spacing * (side - 1) / 2, "on the trampoline");
    free(s);
}

enum { most_rope = 12 };

typedef struct attached_body {
    uint32_t particles;
    double T, omega_T; /* [stable steps] of an update; of the body on the last link */
    double damping;    /* ratio */
    uint64_t steps;    /* per update */
    bool pushed;       /* it moves as a body that is a collider, too */
} attached_body;

/* A rigid body that stretches a rope along it, by pull_body() of docs/games.md, is displaced from balance. Returns its
   largest distance from balance after 400 of 12 000 updates, relative to that in the first 400. */
static double attached_amplitude(const attached_body *b)
{
    const double k = 1000, m = 0.05, spacing = 0.1, stretch = 1.2, load = k * spacing * (stretch - 1);
    const uint32_t n = b->particles, last = n - 1;
    double x[3 * most_rope] = {0}, early = 0, late = 0, pull = load;
    uint8_t pinned[most_rope] = {1};
    spring_link link[most_rope];
    pinned[last] = 1;
    for (uint32_t i = 0; i < n; i++) {
        x[3 * i] = i * spacing * stretch;
        link[i] =
            (spring_link){.a = i, .b = i + 1, .rest = spacing, .stiffness = k, .damping = b->damping * sqrt(2 * k * m)};
    }
    const spring_scene_def def = {
        .particles = n, .position = x, .pinned = pinned, .mass_all = m, .links = last, .link = link};
    spring_scene *s = scene_of(&def);
    const double T = b->T * spring_scene_stable_step(s, SPRING_LEAPFROG), omega = b->omega_T / T,
                 M = k / (omega * omega);
    double end[3] = {x[3 * last]}, v = 1e-3 * omega * spacing;
    for (int i = 0; i < 12000 && late <= 10 * early; i++) {
        const double kick = T * (load - pull) / M;
        v += b->pushed ? 0 : kick;
        end[0] += T * (v + (b->pushed ? kick / 2 : 0));
        CHECK(spring_scene_drive(s, last, end, T) == SPRING_OK, "a pinned particle");
        run(s, SPRING_LEAPFROG, T / (double)b->steps, b->steps);
        pull = spring_scene_tension(s, last - 1);
        v += b->pushed ? (kick + T * (load - pull) / M) / 2 : 0;
        double *const largest = i < 400 ? &early : &late;
        *largest = fmax(*largest, fabs(end[0] - x[3 * last]));
    }
    free(s);
    return late / early;
}

/* Updates of at most twice the stable step, and damping or a small omega T. */
static void attached_bodies(void)
{
    double damped = 0, undamped = 0;
    for (int i = 0; i < 15; i++) {
        attached_body b = {.particles = 3 + (uint32_t)random_uniform(0, most_rope - 2),
                           .T = random_uniform(1, 2),
                           .omega_T = 0.25,
                           .damping = 0.01,
                           .steps = 3 + (uint64_t)random_uniform(0, 6),
                           .pushed = i % 2 == 1};
        damped = fmax(damped, attached_amplitude(&b));
        b.damping = 0;
        b.omega_T = 0.1;
        undamped = fmax(undamped, attached_amplitude(&b));
    }
    printf("# amplitude multiplied by up to %.3f with damping, and %.3f without\n", damped, undamped);
    CHECK_BELOW(damped, 1, "the coupling adds no energy");
    CHECK_BELOW(undamped, 1.2, "without damping, vibrations beat");
    CHECK(attached_amplitude(&(attached_body){4, 3, 0.25, 0, 8, false}) > 10,
          "with longer updates, a vibration resonates");
}

/* Impulses do not depend on the vector width. */
static void impulses_on_all_widths(void)
{
    static model m;
    for (int k = 0; k < 40; k++) {
        build(&m, (const uint32_t[]){9, 5, 1}, 3, (unsigned)random_bits() % feature_masks & ~(unsigned)PINNED);
        m.def.colliders = 2;
        m.def.particle_radius = 0.02;
        m.def.methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4;
        const spring_collider c[2] = {random_collider(3), random_collider(3)};
        spring_impulse first[2], j[2];
        for (int i = 0; i < kernel_count; i++) {
            if (kernels_of(i) == NULL)
                continue;
            spring_scene *s = scene_of(&m.def);
            set(s, c, 2);
            if (spring_scene_advance_with(kernels_of(i), s, contact_methods[k % 2], 0.01, 5) == SPRING_OK) {
                CHECK(spring_scene_impulses(s, i == 0 ? first : j, 0, 2) == SPRING_OK, "impulses");
                CHECK(i == 0 || memcmp(first, j, sizeof j) == 0, "the same bits");
            }
            free(s);
        }
    }
}

/* The rules of spring_scene_impulses(). */
static void impulse_rules(void)
{
    const double x[6] = {0, 0.01, 0, 1, 0.005, 0}, v[6] = {0, -3, 0, 0, -1, 0};
    const spring_scene_def def = {.particles = 2, .position = x, .velocity = v, .mass_all = 0.7, .colliders = 2};
    const spring_collider c = {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .at = {5, 0, 2}, .velocity = {1, 0, 0}};
    spring_impulse j[2], other[2];
    spring_scene *s = scene_of(&def);
    CHECK(spring_scene_impulses(s, j, 0, 0) == SPRING_OK && spring_scene_impulses(s, j, 0, 1) == SPRING_ERANGE, "none");
    set(s, &c, 1);
    CHECK(spring_scene_impulses(s, j, 0, 1) == SPRING_OK && j[0].linear[1] == 0, "0 at first");
    run(s, SPRING_LEAPFROG, 0.01, 1);
    CHECK(spring_scene_impulses(s, j, 0, 2) == SPRING_ERANGE && spring_scene_impulses(s, NULL, 0, 1) == SPRING_EINVAL,
          "one collider");
    CHECK(spring_scene_impulses(s, j, 0, 1) == SPRING_OK, "one collider");
    CHECK_CLOSE(j[0].linear[1], -0.7 * 4, 20 * EPS, "the momentum that was lost");
    /* about (5.01, 0, 2): (x - 5.01, 0, -2) x (0, -J, 0) = (-2 J, 0, -(x - 5.01) J), J = 2.1 and 0.7 */
    CHECK_CLOSE(j[0].angular[0], -2 * 2.8, 50 * EPS, "the angular momentum");
    CHECK_CLOSE(j[0].angular[2], 5.01 * 2.1 + 4.01 * 0.7, 100 * EPS, "the angular momentum");
    spring_scene_advance(s, SPRING_LEAPFROG, NAN, 1);
    CHECK(spring_scene_impulses(s, other, 0, 1) == SPRING_OK && memcmp(j, other, sizeof *j) == 0, "a failed call");
    run(s, SPRING_LEAPFROG, 0.01, 0);
    CHECK(spring_scene_impulses(s, j, 0, 1) == SPRING_OK && j[0].linear[1] == 0, "no step");
    free(s);
    const spring_scene_def bare = {.particles = 1, .position = x};
    s = scene_of(&bare);
    CHECK(spring_scene_impulses(s, j, 0, 0) == SPRING_EDISABLED, "no colliders");
    free(s);
}

static const test tests[] = {
    {"momentum balance", momentum_balance},
    {"coupling", coupling},
    {"coupled oscillation", coupled_oscillation},
    {"coupled columns", coupled_columns},
    {"coupled blocks", coupled_blocks},
    {"coupled momenta", coupled_momenta},
    {"coupled rolling", coupled_rolling},
    {"attached bodies", attached_bodies},
    {"impulses on all widths", impulses_on_all_widths},
    {"impulses", impulse_rules},
};

int main(void)
{
    return RUN_TESTS("coupling", tests);
}
