/* SPDX-License-Identifier: MIT */
/* Contacts of particles with damped links. */
#include "test_contact.h"

#include <stdio.h>

/* A mass on a damped spring that stands on the floor sinks by m g/k. If velocities that are predicted for the damping
   entered the floor, the damping would push it up by about c g dt/2k, here 1 mm. */
static void damped_spring_on_floor(void)
{
    const double x[6] = {0, 0.1, 0, 0, 0.6, 0}, k = 100, c = 2, m = 0.7, dt = 0.01;
    const spring_link link = {.a = 0, .b = 1, .rest = 0.5, .stiffness = k, .damping = c};
    spring_scene_def def = falling(2, x, NULL, m);
    def.links = 1, def.link = &link;
    spring_scene *s = scene_with(&def, &unit_box);
    double now[6];
    run(s, SPRING_LEAPFROG, dt, 2500); /* exp(-c t/2m) = 3e-16 */
    spring_scene_get(s, SPRING_POSITION, now, 0, 0, 2);
    CHECK_CLOSE(now[4] - now[1], 0.5 - m * gravity / k, in_double ? 1e-12 : 1e-5, "Hooke's law, to rounding");
    CHECK_CLOSE(now[1], 0.1, 16 * EPS, "the lower end stands on the floor");
    free(s);
}

static const double body_mass = 300, leg_stiffness = 4e4;

/* A body, 0.7 m above a particle of mass `foot` that touches the floor, on a spring between them. */
static spring_scene *body_on_spring(double foot, double radius, double rest, double damping)
{
    const double x[6] = {0, radius, 0, 0, radius + 0.7, 0}, mass[2] = {foot, body_mass};
    const spring_link link = {0, 1, rest, leg_stiffness, damping, 0};
    spring_scene_def def = falling(2, x, NULL, 0);
    def.mass = mass, def.links = 1, def.link = &link, def.particle_radius = (scalar)radius;
    return scene_of(&def);
}

/* The mean length [m] of a spring that is 0.7 m long under its load, on a platform that is shaken. */
static double length_on_platform(double dt, double damping_ratio, int every, double *G)
{
    const double foot = 40, A = 0.1, omega = 2 * PI, damping = 2 * damping_ratio * sqrt(leg_stiffness * body_mass);
    spring_scene *s = body_on_spring(foot, 0.3, 0.7 + body_mass * gravity / leg_stiffness, damping);
    spring_collider c = ground;
    double sum = 0;
    const int calls = (int)(10 / (dt * every));
    *G = 2 * damping / foot;
    for (int i = 0; i < calls; i++) {
        const double t = i * every * dt;
        c.at[1] = A * sin(omega * t), c.velocity[1] = A * omega * cos(omega * t);
        c.acceleration[1] = -A * omega * omega * sin(omega * t);
        set(s, &c, 1);
        run(s, SPRING_LEAPFROG, dt, (uint64_t)every);
        double now[6];
        spring_scene_get(s, SPRING_POSITION, now, 0, 0, 2);
        sum += now[4] - now[1];
    }
    free(s);
    return sum / calls;
}

/* A pose that is set differs from the last one because the acceleration changes, by up to 2e-5 m here. */
static void damped_body_on_platform(void)
{
    static const struct {
        double damping_ratio, least, most; /* the bounds are of dt G */
    } cases[] = {{0.1, 0, 0.4}, {1, 0.4, 1}, {10, 7, 8}};
    for (int i = 0; i < 6; i++) {
        double G;
        const double dt = 1. / 480, length = length_on_platform(dt, cases[i % 3].damping_ratio, i < 3 ? 8 : 1, &G);
        CHECK(dt * G > cases[i % 3].least && dt * G < cases[i % 3].most, "explicit and heavy damping");
        CHECK_CLOSE(length, 0.7, 0.002, "the body keeps its length");
    }
}

/* A body on a heavily damped spring, in a lift that accelerates: the spring bears m (g + a) and is at rest in the lift. */
static void damped_body_in_a_lift(void)
{
    const double foot = 4, rest = 0.8, damping = 2 * sqrt(leg_stiffness * body_mass), a = 3, dt = 1. / 480;
    spring_collider c = ground;
    c.acceleration[1] = a;
    spring_scene *s = body_on_spring(foot, 0, rest, damping);
    double now[6];
    CHECK(dt * 2 * damping / foot > 7, "an exponential kick of several terms");
    set(s, &c, 1);
    run(s, SPRING_LEAPFROG, dt, 480 * 6); /* exp(-6 k/c) = 1e-15 */
    spring_scene_get(s, SPRING_POSITION, now, 0, 0, 2);
    CHECK_CLOSE(now[4] - now[1], rest - body_mass * (gravity + a) / leg_stiffness, 64 * 54 * EPS,
                "Hooke's law, to rounding at 54 m");
    free(s);
}

/* Two particles on a damped link, with the same velocity v, which changes in a step of 0.01 s with a collider. */
static void step_of_pair(const double x[3], double v[3], const double g[3], const spring_collider *c, double dt_G,
                         double impulse[3])
{
    enum { mass = 2 };
    const double dt = 0.01, both[6] = {x[0], x[1], x[2], x[0], x[1], x[2] + 0.1},
                 velocity[6] = {v[0], v[1], v[2], v[0], v[1], v[2]};
    const spring_link link = {.b = 1, .rest = 0.1, .stiffness = 100, .damping = dt_G * mass / (2 * dt)};
    spring_scene_def def = falling(2, both, velocity, mass);
    def.links = 1, def.link = &link;
    memcpy(def.gravity, g, sizeof def.gravity);
    spring_scene *s = scene_with(&def, c);
    spring_impulse by;
    run(s, SPRING_LEAPFROG, dt, 1);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
    spring_scene_impulses(s, &by, 0, 1);
    memcpy(impulse, by.linear, sizeof by.linear);
    free(s);
}

static spring_collider random_ground(void)
{
    spring_collider c = ground;
    c.restitution = random_uniform(0, 1), c.friction = random_uniform(0, 1);
    return c;
}

/* Damping shortens a bounce and its friction: friction only brakes, and is at most the coefficient times the load. */
static void damped_bounces(void)
{
    for (int k = 0; k < 200; k++) {
        const spring_collider c = random_ground();
        const double dt_G = random_log(0.5, 1000), slope = random_log(1e-5, 0.3), fall = random_uniform(0.5, 3);
        const double g[3] = {gravity * sin(slope), -gravity * cos(slope), 0}, speed = k % 2 ? random_log(1e-4, 3) : 0;
        const double x[3] = {0, fall * random_uniform(0.001, 0.009), 0};
        double v[3] = {speed, -fall, 0}, impulse[3];
        const double along = speed + g[0] * 0.01;
        step_of_pair(x, v, g, &c, dt_G, impulse);
        const double rounding = 64 * EPS * 4 * fall;
        CHECK(v[0] >= -rounding && v[0] <= along + rounding, "friction brakes");
        const double bounce = c.restitution * (fall + 0.01 * gravity) / (1 + pow(dt_G / 2, 2));
        CHECK(v[1] >= -rounding && v[1] <= bounce + rounding, "a bounce, reduced by damping");
        CHECK(-impulse[1] > 0 && impulse[0] >= -rounding, "the collider pushes");
        CHECK_BELOW(fmax(0, impulse[0] + c.friction * impulse[1]), 8 * rounding, "friction beyond its limit");
    }
}

/* A particle that leaves a collider is not affected by it, also if it starts inside, and is moved out. */
static void damped_pair_leaves(void)
{
    for (int k = 0; k < 100; k++) {
        const spring_collider c = random_ground();
        const double x[3] = {0, k % 2 ? -random_log(1e-4, 0.1) : 0, 0}, before[3] = {1, random_log(0.01, 3), 0};
        double v[3] = {before[0], before[1], before[2]}, impulse[3];
        step_of_pair(x, v, none, &c, random_log(0.5, 1000), impulse);
        CHECK_BELOW(distance(v, before), 64 * EPS, "its velocity");
    }
}

/* max_speed limits velocities after bounces that damping has shortened. */
static void fastest_bounce(void)
{
    for (int k = 0; k < 400; k++) {
        spring_collider c = random_ground();
        c.friction *= 2;
        const double y = random_uniform(0, 0.02), x[2][3] = {{0, y, 0}, {0.3, y + random_uniform(-0.4, 0.4), 0}};
        const double v[2][3] = {{random_uniform(-5, 5), random_uniform(-8, 0), 0},
                                {random_uniform(-5, 5), random_uniform(-8, 3), 0}};
        const spring_link link = {
            .b = 1, .rest = hypot(0.3, x[1][1] - y), .stiffness = 100, .damping = random_log(100, 1e4)};
        spring_scene_def def = falling(2, x[0], v[0], 1);
        def.gravity[1] = 0, def.links = 1, def.link = &link;
        double fastest = 0, after[6];
        for (int limited = 0; limited < 3; limited++) {
            spring_scene *s = scene_with(&def, &c);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.01, 1) == (limited < 2 ? SPRING_OK : SPRING_EUNSTABLE),
                  "the velocity after the step is compared");
            spring_scene_get(s, SPRING_VELOCITY, after, 0, 0, 2);
            for (int i = 0; i < 6; i++)
                fastest = fmax(fastest, fabs(after[i]));
            def.max_speed = limited == 0 ? fastest : fastest * (1 - 4 * EPS);
            free(s);
        }
    }
}

/* A floor that no particle reaches changes nothing in the first step after it was set, however large the damping is. */
static void distant_floor(void)
{
    for (int k = 0; k < 100; k++) {
        enum { n = 6 };
        const double dt = 0.01, gap = random_log(1e-3, 0.1), size = 0.1, damping = random_log(0.5, 3e4) / (4 * dt);
        double x[n][3], v[n][3], end[2][n][3];
        spring_link link[n - 1];
        for (uint32_t i = 0; i < n; i++) {
            memcpy(x[i], (double[]){i * size, gap + (i % 2 ? 0.01 * size : 0), 0}, sizeof x[i]);
            memcpy(v[i], (double[]){random_uniform(-1, 1), random_uniform(0, 1), random_uniform(-1, 1)}, sizeof v[i]);
            if (i > 0)
                link[i - 1] = (spring_link){i - 1, i, size * hypot(1, 0.01), 100, damping, 0};
        }
        spring_scene_def def = falling(n, x[0], v[0], 1);
        def.gravity[1] = 0, def.links = n - 1, def.link = link;
        for (int floor = 0; floor < 2; floor++) {
            spring_collider c = ground;
            c.at[1] = floor ? 0 : -1e4, c.friction = 0.5;
            spring_scene *s = scene_with(&def, &c);
            run(s, SPRING_LEAPFROG, dt, 1);
            spring_scene_get(s, SPRING_VELOCITY, end[floor][0], 0, 0, n);
            free(s);
        }
        for (int i = 0; i < n; i++)
            CHECK_BELOW(distance(end[1][i], end[0][i]), 1e4 * EPS, "its velocity");
    }
}

/* A particle slides without friction or gravity through a fold of two faces: it loses the velocity into the second. */
static void folds(void)
{
    for (int k = 0; k < 60; k++) {
        const double angle = random_log(0.01, 1.2), r = 0.08, speed = random_uniform(0.5, 5);
        const double x[3] = {-0.3 * speed, r, 0}, v[3] = {speed, 0, 0}, dt = random_uniform(0.5, 1.5) / 480;
        faces fold = {2, {{0, 1, 0}, {-sin(angle), cos(angle), 0}}};
        const spring_collider c = {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .user = &fold, .thickness = 1};
        double now[3], u[3];
        end_of(ball_on(&c, 1, x, v, none, r), SPRING_LEAPFROG, dt, 480, now, u);
        CHECK_CLOSE(hypot(u[0], u[1]), speed * cos(angle), 1e3 * EPS * speed, "v cos(angle)");
    }
}

/* Where a heavily damped block is after 0.8 s [m], which slides sideways on a slope. */
static double place_on_slope(double dt)
{
    const double slope = 0.3, stiffness = 50, side = 0.1, damping = 0.5;
    double x[8][3], v[8][3] = {{0}}, sum = 0;
    spring_link link[28];
    spring_scene_def def = falling(8, x[0], v[0], 0.01);
    def.link = link;
    for (uint32_t a = 0; a < 8; a++) {
        turn((double[]){0, 0, slope}, (double[]){side * (a & 1), side * (a >> 1 & 1), side * (a >> 2)}, x[a]);
        v[a][2] = 1;
        for (uint32_t b = 0; b < a; b++)
            link[def.links++] = (spring_link){b, a, distance(x[a], x[b]), stiffness, damping, 0};
    }
    const spring_collider c = {.shape = SPRING_PLANE, .axis = {{-sin(slope), cos(slope), 0}}, .friction = 0.1};
    spring_scene *s = scene_with(&def, &c);
    run(s, SPRING_LEAPFROG, dt, (uint64_t)(0.8 / dt + 0.5));
    spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, 8);
    for (int a = 0; a < 8; a++)
        sum += x[a][2] / 8;
    free(s);
    return sum;
}

/* Friction turns with the velocity. If it kept the direction that it has at the start of a step, the error would be of
   first order, 4e-4 m here. */
static void damped_block_slides_sideways(void)
{
    const double fine = place_on_slope(0.0005), coarse = place_on_slope(0.004);
    CHECK_BELOW(fabs(coarse - fine), 5e-5, "m");
}

/* A heavy body stands on two feet of a fifteenth of its mass, with damped legs, on a level floor with friction. */
static void heavy_body_on_feet(void)
{
    static const double ratios[] = {1, 3, 10, 30, 100, 300}, steps[] = {0.9, 0.5, 0.25}, friction[] = {0.05, 0.2};
    for (int k = 0; k < 6 * 3 * 2; k++) {
        const double foot = 40, body = 600, damping = ratios[k % 6] * 2 * sqrt(4e4 * 300);
        const double x[9] = {-0.8, 0.3, 0, 0.8, 0.3, 0, 0.1, 1, 0}, mass[3] = {foot, foot, body};
        const spring_link link[3] = {{0, 1, 1.6, 2e6, 0.03 * sqrt(2 * 2e6 * foot), 0},
                                     {0, 2, 1.1 * hypot(0.9, 0.7), 4e4, damping, 0},
                                     {1, 2, 1.1 * hypot(0.7, 0.7), 4e4, damping, 0}};
        spring_scene_def def = falling(3, x, NULL, 0);
        def.mass = mass, def.links = 3, def.link = link, def.particle_radius = (scalar)0.3;
        spring_collider c = ground;
        c.friction = friction[k / 18];
        spring_scene *s = scene_with(&def, &c);
        const double dt = steps[k / 6 % 3] * spring_scene_stable_step(s, SPRING_LEAPFROG);
        double least = INFINITY, rise = 0, fall = 0;
        for (int i = 0; i * dt < 20; i++) {
            run(s, SPRING_LEAPFROG, dt, 1);
            const double now = total_energy(s);
            fall = i == 0 ? now : fall;
            least = fmin(least, now);
            rise = fmax(rise, now - least);
        }
        CHECK_BELOW(rise, 0.01 * (fall - least), "energy, in units of the energy lost");
        CHECK(spring_scene_at_rest(s, 1e-3, 0.1), "comes to rest");
        free(s);
    }
}

/* Bodies of particles of different masses that are all linked, with dampers of 0.3 to 1000 times the critical damping,
   fall on a slope or slide into a wall. Directions of links are frozen during a step, so energy may rise a little. */
static void damped_bodies_fall(void)
{
    enum { largest = 8 };
    double mean[2] = {0}; /* without and with restitution */
    const int bodies = 300;
    for (int i = 0; i < bodies; i++) {
        const uint32_t n = 4 + (uint32_t)random_uniform(0, 4.99);
        const double spread = random_log(1, 100), ratio = random_log(0.3, 1000), stiffness = random_log(100, 1e5);
        const double slope = i % 2 ? random_uniform(-0.4, 0.4) : 0, speed = random_uniform(0, 3);
        double x[largest][3], v[largest][3] = {{0}}, mass[largest];
        spring_link link[largest * largest];
        spring_scene_def def = falling(n, x[0], v[0], 0);
        def.mass = mass, def.link = link, def.colliders = i % 3 == 0 ? 2 : 1;
        for (uint32_t a = 0; a < n; a++) {
            mass[a] = random_log(1, spread);
            v[a][0] = speed;
            for (uint32_t k = 0; k < 3; k++)
                x[a][k] = random_uniform(-0.5, 0.5) + (k == 1 ? 1.2 : 0);
            for (uint32_t b = 0; b < a; b++) {
                const double reduced = mass[a] * mass[b] / (mass[a] + mass[b]);
                link[def.links++] =
                    (spring_link){b, a, distance(x[a], x[b]), stiffness, 2 * ratio * sqrt(stiffness * reduced), 0};
            }
        }
        const double friction = random_uniform(0, 1), restitution = i % 4 < 2 ? 0 : random_uniform(0, 0.8);
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{sin(slope), cos(slope), 0}}},
                                {.shape = SPRING_PLANE, .axis = {{-1, 0, 0}}, .at = {2, 0, 0}}};
        for (int k = 0; k < 2; k++)
            c[k].friction = friction, c[k].restitution = restitution;
        spring_scene *s = scene_with(&def, c);
        const double dt = random_uniform(0.3, 0.9) * spring_scene_stable_step(s, SPRING_LEAPFROG);
        double least = INFINITY, rise = 0, kinetic = 0;
        for (int k = 0; k * dt < 4; k++) {
            run(s, SPRING_LEAPFROG, dt, 1);
            least = fmin(least, total_energy(s));
            rise = fmax(rise, total_energy(s) - least);
            kinetic = fmax(kinetic, spring_scene_energy(s).kinetic);
        }
        mean[restitution > 0] += 2 * rise / kinetic / bodies;
        free(s);
    }
    printf("# energy rises by %.2g of the largest kinetic energy, on average; with restitution by %.2g\n", mean[0],
           mean[1]);
    CHECK_BELOW(mean[0], 0.003, "of the largest kinetic energy, on average");
    CHECK_BELOW(mean[1], 0.03, "with restitution");
}

/* Two particles joined by a damped link rest on a plane, one above the other. docs/details.md has the excess of RK4. */
static void damped_link_at_rest(void)
{
    const double k = 500, mass = 0.3, dt = 0.002, rest = 0.5, load = mass * gravity;
    for (double dt_G = 0.02; dt_G < 0.4; dt_G *= 2.5)
        for (int m = 0; m < second_order; m++) {
            const double x[6] = {0, 0, 0, 0, rest - load / k, 0};
            const spring_link link = {.b = 1, .rest = rest, .stiffness = k, .damping = dt_G / dt * mass / 2};
            spring_scene_def def = falling(2, x, NULL, mass);
            def.links = 1, def.link = &link;
            spring_scene *s = scene_with(&def, &ground);
            double end[6];
            run(s, contact_methods[m], dt, 10000);
            spring_scene_get(s, SPRING_POSITION, end, 0, 0, 2);
            const bool rests = spring_scene_at_rest(s, 0.01, 0.05);
            free(s);
            const double excess = k * (rest - (end[4] - end[1])) / load - 1, bound = in_double ? 1e-9 : 2e-4;
            const double L = 2 * k / mass, expected = dt_G / 2 + dt * dt * L / 6;
            CHECK(rests == (contact_methods[m] == SPRING_LEAPFROG), "the forces of RK4 are not in balance");
            if (contact_methods[m] == SPRING_LEAPFROG)
                CHECK_BELOW(excess, bound, "rounding errors: leapfrog rests in equilibrium");
            else
                CHECK_CLOSE(excess, expected, 0.05 * expected + bound, "higher orders of dt");
        }
}

/* Pairs of particles with a damped link come to rest in gutters of two planes at right angles, turned about z. */
static void damped_pair_in_a_gutter(void)
{
    double fastest = 0, strongest = 0; /* [m/s]; impulses in units of the weight times dt */
    for (int i = 0; i < 300; i++) {
        const double dt = 1. / 240, mass = 0.05, tilt = random_uniform(0.05, 0.7);
        const double x[6] = {0.03, 0.1, 0, 0.05, 0.12, 0.09};
        const spring_link link = {.b = 1, .rest = 0.1, .stiffness = 1000, .damping = random_log(1, 200)};
        spring_scene_def def = falling(2, x, NULL, mass);
        def.gravity[2] = 0.2, def.drag = 0.01, def.links = 1, def.link = &link, def.colliders = 2;
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{-sin(tilt), cos(tilt), 0}}},
                                {.shape = SPRING_PLANE, .axis = {{cos(tilt), sin(tilt), 0}}}};
        c[0].restitution = c[1].restitution = random_log(0.001, 0.5);
        c[0].friction = c[1].friction = random_uniform(0.1, 0.8);
        spring_scene *s = scene_with(&def, c);
        run(s, SPRING_LEAPFROG, dt, 1200);
        for (int step = 0; step < 400; step++) {
            double v[6];
            spring_impulse j[2];
            run(s, SPRING_LEAPFROG, dt, 1);
            spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 2);
            spring_scene_impulses(s, j, 0, 2);
            fastest = fmax(fastest, fmax(length(v), length(v + 3)));
            for (int k = 0; k < 2; k++)
                strongest = fmax(strongest, length(j[k].linear) / (2 * mass * gravity * dt));
        }
        free(s);
    }
    CHECK_BELOW(fastest, gravity / 240, "at rest, or falling for a step");
    CHECK_BELOW(strongest, 1.5, "they carry the weight");
}

static const test tests[] = {
    {"a damped spring on the floor", damped_spring_on_floor},
    {"damped body on a platform", damped_body_on_platform},
    {"damped body in a lift", damped_body_in_a_lift},
    {"damped bounces", damped_bounces},
    {"a damped pair leaves", damped_pair_leaves},
    {"the fastest bounce", fastest_bounce},
    {"a distant floor", distant_floor},
    {"folds", folds},
    {"damped block slides sideways", damped_block_slides_sideways},
    {"heavy body on feet", heavy_body_on_feet},
    {"damped bodies fall", damped_bodies_fall},
    {"a damped pair in a gutter", damped_pair_in_a_gutter},
    {"a damped link at rest", damped_link_at_rest},
};

int main(void)
{
    return RUN_TESTS("damped contacts", tests);
}
