/* SPDX-License-Identifier: MIT */
/* Forces of banded and unbanded links compared with a plain loop, for every instruction set; tension, energy, rest. */
#include <stdio.h>

#include "test_scene.h"

/* ------------------------------------------------------------------------------------------------ against a plain
   loop */

static const uint32_t grids[][3] = {{23, 1, 1}, {2, 9, 1}, {3, 17, 1}, {13, 11, 1}, {5, 4, 7}, {17, 2, 3}};
static const size_t grid_count = sizeof grids / sizeof grids[0];

/* --------------------------------------------------------------------------------------------------- zero length */

static void zero_length(void)
{
    static model m;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (unsigned features = 0; features < MASSES; features++) {
            build(&m, grids[0], axes, features);
            for (size_t i = 0; i < m.def.particles * axes; i++)
                m.position[i] = 0.25; /* all collapsed into one point */
            const method_list all = methods_of(m.def);
            for (const spring_method *method = all.at; *method != no_method; method++) {
                spring_scene *s = scene_of(&m.def);
                static state before, after;
                get_state(s, m.def.particles, &before);
                CHECK(spring_scene_advance(s, SPRING_EULER, 0.01, 1) == SPRING_OK, "no direction, no force");
                get_state(s, m.def.particles, &after);
                CHECK(memcmp(before.v, after.v, m.def.particles * axes * sizeof after.v[0]) == 0,
                      "no direction, no force");
                set_state(s, m.def.particles, &before);
                CHECK(spring_scene_advance(s, *method, 0.004, 50) == SPRING_OK && all_finite(s, m.def.particles, axes),
                      "and off they fly");
                free(s);
            }
        }
}

/* ------------------------------------------------------------------------------------------ tension, energies, rest */

static void tension_and_energies(void)
{
    static model m;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 5) {
            build(&m, grids[features % grid_count], axes, features);
            spring_scene *s = scene_of(&m.def);
            get_state(s, m.def.particles, &y);
            double kinetic = 0, gravity = 0, elastic = 0, all = 0, heights = 0;
            for (size_t i = 0; i < m.def.particles; i++)
                for (uint32_t a = 0; a < axes && !pinned_in(&m.def, i); a++) {
                    const double mass = mass_in(&m.def, i), height = y.x[i * axes + a];
                    kinetic += mass * y.v[i * axes + a] * y.v[i * axes + a] / 2;
                    gravity -= mass * m.def.gravity[a] * height;
                    heights += fabs(mass * m.def.gravity[a] * height);
                }
            for (size_t i = 0; i < m.def.links; i++) {
                const spring_link *link = &m.def.link[i];
                const link_force f = evaluate_link(link, axes, y.x, y.v);
                const double extension = f.length - link->rest, size = fabs(f.length) + link->rest;
                elastic += link->stiffness * extension * extension / 2;
                all += link->stiffness * size * size / 2;
                CHECK_CLOSE(spring_scene_tension(s, i), f.tension,
                            8 * EPS * (link->stiffness * size + 2 * link->damping),
                            "eight roundings, velocities below 1");
            }
            const spring_scene_energies e = spring_scene_energy(s);
            const double sums = (double)(m.def.particles + m.def.links) * DBL_EPSILON;
            CHECK_CLOSE(e.kinetic, kinetic, (8 * EPS + sums) * kinetic, "eight roundings and the sum's");
            CHECK_CLOSE(e.gravity, gravity, (8 * EPS + sums) * heights, "eight roundings and the sum's");
            CHECK_CLOSE(e.elastic, elastic, (8 * EPS + sums) * all, "eight roundings and the sum's");
            free(s);
        }
}

static void at_rest(void)
{
    /* A weight on a spring, where it hangs still: k (length - rest) = m g. */
    const double k = 27, mass = 2.5, g = -8, rest = 0.5, drop = mass * -g / k;
    const double hanging[] = {0, 0, 0, 0, -rest - drop, 0};
    const uint8_t pinned[] = {1, 0};
    const double masses[] = {0, mass};
    const spring_link link = {0, 1, rest, k, 0};
    const spring_scene_def def = {.particles = 2,
                                  .links = 1,
                                  .position = hanging,
                                  .mass = masses,
                                  .pinned = pinned,
                                  .link = &link,
                                  .gravity = {0, g, 0}};
    spring_scene *s = scene_of(&def);
    const double rounding = 8 * EPS * -g * (rest + drop) / drop; /* of the acceleration */
    CHECK(spring_scene_at_rest(s, 0, rounding), "it hangs still");
    const double moved[] = {0, -rest - drop - 0.01, 0}, a = k * 0.01 / mass;
    spring_scene_set(s, SPRING_POSITION, moved, 0, 1, 1);
    CHECK(spring_scene_at_rest(s, 0, a * (1 + 1e-3)) && !spring_scene_at_rest(s, 1, a * (1 - 1e-3)), "k 0.01 m / m");
    spring_scene_set(s, SPRING_POSITION, hanging + 3, 0, 1, 1);
    const double v[] = {0.3, 0, -0.4};
    spring_scene_set(s, SPRING_VELOCITY, v, 0, 1, 1);
    CHECK(spring_scene_at_rest(s, 0.5 * (1 + 4 * EPS), rounding) && !spring_scene_at_rest(s, 0.49, 1), "0.5 m/s");
    const double still[] = {0, 0, 0};
    spring_scene_set(s, SPRING_VELOCITY, still, 0, 1, 1);
    spring_scene_set(s, SPRING_VELOCITY, v, 0, 0, 1);
    CHECK(!spring_scene_at_rest(s, 0.49, 1) && spring_scene_at_rest(s, 0.51, rounding), "a pin that moves is no rest");
    CHECK(!spring_scene_at_rest(NULL, 1, 1) && !spring_scene_at_rest(s, -1, 1) && !spring_scene_at_rest(s, 1, NAN),
          "bad input");
    free(s);
}

static void at_rest_with_drag(void)
{
    const double x[] = {0, 0}, v[] = {3, -1}; /* drag 0.6 on 1.5 kg: 0.4/s times hypot(3, 1) m/s */
    const spring_scene_def def = {
        .axes = 2, .particles = 1, .position = x, .velocity = v, .mass_all = 1.5, .drag = 0.6};
    spring_scene *s = scene_of(&def);
    const double speed = hypot(3, 1);
    CHECK(spring_scene_at_rest(s, speed * 1.001, 0.4 * speed * 1.001) &&
              !spring_scene_at_rest(s, speed * 1.001, 0.4 * speed * 0.999) &&
              !spring_scene_at_rest(s, speed * 0.999, 0.4 * speed * 1.001),
          "drag is an acceleration");
    free(s);
}

/* ------------------------------------------------------------------------- a force perpendicular to the velocity */

enum { gyro_mass_permille = 1300 };

/* mass rate |v|, perpendicular to the velocity; *user: the rate [1/s] */
static void magnetic(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                     scalar *const force[3])
{
    const scalar factor = (scalar)(*(const double *)user * gyro_mass_permille / 1000);
    (void)t, (void)x;
    for (size_t i = 0; i < particles; i++) {
        force[0][i] += factor * v[1][i];
        force[1][i] -= factor * v[0][i];
    }
}

/* The logarithm of the energy gained per step of 1 s by a particle in this force, on a spring of the angular frequency
   omega and of rest length 0, if omega > 0. The first half of the steps are not counted. */
static double gain_per_step(spring_method m, double rate, double omega, uint64_t n)
{
    const double x[] = {0, 0, 1, 0.2}, v[] = {0, 0, 0.1, -0.3}, mass = gyro_mass_permille / 1000.0;
    const uint8_t pinned[] = {1, 0};
    const spring_link link = {0, 1, 0, mass * omega * omega, 0};
    const spring_scene_def def = {.axes = 2,
                                  .methods = 1u << m,
                                  .particles = 2,
                                  .links = omega > 0,
                                  .position = x,
                                  .velocity = v,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = &link,
                                  .force = magnetic,
                                  .user = &rate};
    spring_scene *s = scene_of(&def);
    double energy[2];
    for (int half = 0; half < 2; half++) {
        CHECK(spring_scene_advance(s, m, 1, n / 2) == SPRING_OK, "no overflow");
        const spring_scene_energies e = spring_scene_energy(s);
        energy[half] = e.kinetic + e.elastic;
    }
    free(s);
    return log(energy[1] / energy[0]) / (double)(n / 2);
}

/* The laws of scene.h, at spring_scene_advance(). */
static void perpendicular_force(void)
{
    for (double z = 0.1; z < 0.9; z *= 2) {
        const double rounding = 20 * EPS, z2 = z * z;
        CHECK_CLOSE(gain_per_step(SPRING_LEAPFROG, z, 0, 200), log1p(z2 * z2 / 4), rounding, "|1 + iz - z^2/2|^2");
        CHECK_CLOSE(gain_per_step(SPRING_RK4, z, 0, 200), log1p(z2 * z2 * z2 * (z2 / 576 - 1.0 / 72)), rounding,
                    "RK4 of v' = iz v");
        CHECK_CLOSE(gain_per_step(SPRING_SYMPLECTIC_EULER, z, 0, 200), log1p(z2), rounding, "|1 + iz|^2");
    }
    for (double omega = 0.5; omega < 2; omega *= 1.5) {
        const double rate = 0.01, law = rate * pow(omega, 3) / 8 / sqrt(1 - omega * omega / 4);
        const double gain = gain_per_step(SPRING_LEAPFROG, rate, omega, (uint64_t)(20 / law));
        printf("# a spring of %.3f rad per step in a weak magnetic field gains %.3g of its energy per step\n", omega,
               gain);
        CHECK_CLOSE(gain, law, 0.06 * law, "first order in the rate; the next term is rate/omega, or less");
    }
    for (int i = 0; i < 200; i++) {
        const double rate = random_log(0.01, 1), omega = random_log(0.05, 1.5);
        CHECK(gain_per_step(SPRING_RK4, rate, omega, 2000) < 1e-5, "RK4 loses energy; but for the phase of the motion");
    }
}

/* ------------------------------------------------------------------------------------- rest far from the origin */

/* In how many of 600 frames a rope at rest is found at rest. The table of docs/games.md. */
static int frames_at_rest(double offset, double damping)
{
    enum { n = 20 };
    const double mass = 0.05, stiffness = 2000;
    double x[3 * n];
    uint8_t pinned[n];
    spring_link link[n - 1];
    spring_grid_fill(
        &(spring_grid){
            .count = {1, n}, .spacing = 0.1, .stiffness = stiffness, .damping = damping, .pinned = SPRING_GRID_LAST_Y},
        x, pinned, link);
    for (uint32_t i = n - 1; i-- > 0;) /* each link carries the particles below it */
        x[3 * i + 1] = x[3 * i + 4] - 0.1 - (i + 1) * mass * 9.81 / stiffness;
    for (size_t i = 0; i < n; i++)
        x[3 * i] += offset, x[3 * i + 1] += offset;
    const spring_scene_def def = {.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                                  .particles = n,
                                  .links = n - 1,
                                  .position = x,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, -9.81, 0}};
    spring_scene *s = scene_of(&def);
    int frames = 0;
    for (int i = 0; i < 600; i++) {
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1.0 / 960, 16) == SPRING_OK, "stable");
        frames += spring_scene_at_rest(s, 0.01, 0.5);
    }
    free(s);
    return frames;
}

static void rest_far_from_the_origin(void)
{
    static const double offsets[] = {0, 1, 10, 100, 1000};
    for (int damped = 0; damped < 2; damped++)
        for (size_t i = 0; i < sizeof offsets / sizeof *offsets; i++) {
            const int frames = frames_at_rest(offsets[i], damped);
            printf("# link damping %d N s/m, %g m from the origin: at rest in %d of 600 frames\n", damped, offsets[i],
                   frames);
            if (sizeof(scalar) == 8 || offsets[i] == 0)
                CHECK(frames == 600, "rounding errors are small");
            else if (offsets[i] == 1000)
                CHECK(frames == 0, "an ulp of the position, 6e-5 m, times stiffness/mass is 2.4 m/s^2");
        }
}

int main(void)
{
    static const test tests[] = {
        {"links of length zero", zero_length},
        {"tension and energies", tension_and_energies},
        {"at rest", at_rest},
        {"at rest with drag", at_rest_with_drag},
        {"a force perpendicular to the velocity", perpendicular_force},
        {"rest far from the origin", rest_far_from_the_origin},
    };
    return RUN_TESTS("scene_forces", tests);
}
