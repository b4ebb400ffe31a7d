/* SPDX-License-Identifier: MIT */
/* Leapfrog with heavy link damping: the series, its order and errors, stability, bits. max_speed and softened links. */
#include <stdio.h>

#include "test_scene.h"
#include "scene/exponential_kick.h"

/* ------------------------------------------------------------------------------------------------- errors and energy */

typedef enum motion { FROM_REST, IN_MOTION } motion;

/* A horizontal cloth that is pinned at two corners, or a rope with a heavy end, 1 m long; its stiffness and damping in
   units of a frame: sqrt(L) = stiff/frame, damping = damped mass/frame. */
static const double frame = 1.0 / 60;

static void build_stiff(model *m, uint32_t side, bool rope, double stiff, double damped, motion how)
{
    const spring_grid g = {.count = {side, rope ? 1 : side},
                           .spacing = 1.0 / (side - 1),
                           .families = rope ? SPRING_GRID_STRUCTURAL : 7,
                           .stiffness = 1};
    const double mass = rope ? 1.0 / 32 : 1.0 / (side * side);
    build_grid(m, &g, mass);
    for (size_t i = 0; i < m->def.particles; i++) {
        m->pinned[i] = i == 0 || (!rope && i == side - 1);
        m->position[3 * i + 2] += m->pinned[i] ? 0 : 0.02 * g.spacing * random_uniform(-0.5, 0.5);
        for (int a = 0; a < 3 && how == IN_MOTION && !m->pinned[i]; a++)
            m->velocity[3 * i + (size_t)a] = 0.4 * sin(3 * m->position[3 * i] + 2 * m->position[3 * i + 1] + a);
    }
    if (rope)
        m->mass[m->def.particles - 1] *= 100;
    m->def.gravity[2] = -9.81, m->def.methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4;
    const double limit = stable_step_of(&m->def, SPRING_LEAPFROG); /* 2/sqrt(L) at stiffness 1 */
    for (size_t j = 0; j < m->def.links; j++) {
        m->link[j].stiffness = pow(stiff / frame * limit / 2, 2);
        m->link[j].damping = damped * mass / frame;
    }
}

#ifndef SPRING_FLOAT

static double distance_between(const spring_scene *s, const spring_scene *other, size_t particles, spring_quantity q)
{
    static double a[3 * most], b[3 * most];
    double square = 0;
    spring_scene_get(s, q, a, 0, 0, particles);
    spring_scene_get(other, q, b, 0, 0, particles);
    for (size_t i = 0; i < 3 * particles; i++)
        square += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(square / (double)particles);
}

/* RMS error of positions after a quarter of a second. */
static double error_after(const model *m, int steps_per_frame)
{
    const int frames = 15;
    spring_scene *s = scene_of(&m->def), *reference = scene_of(&m->def);
    const uint64_t fine = (uint64_t)ceil(frames * frame / (0.9 * spring_scene_stable_step(reference, SPRING_RK4)));
    const uint64_t steps = fine < 1500 ? 1500 : fine;
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, frame / steps_per_frame, (uint64_t)(frames * steps_per_frame)) ==
              SPRING_OK,
          "stable");
    CHECK(spring_scene_advance(reference, SPRING_RK4, frames * frame / (double)steps, steps) == SPRING_OK,
          "the reference, too");
    const double error = distance_between(s, reference, m->def.particles, SPRING_POSITION);
    free(s);
    free(reference);
    return error;
}

/* The scenes S1 (here smaller cloths, so that the reference takes seconds) and S2 of the study of stiff scenes, at two
   thirds of the stable number of steps and at that number. The bounds are those of the study of the scheme, for the rope
   in motion with a margin for its random velocities. */
static void errors(void)
{
    static model m;
    static const struct {
        double damped, cloth[2], rope;
    } bound[] = {{10, {2e-5, 3e-5}, 4e-5}, {100, {8e-6, 1.2e-5}, 2e-5}, {1000, {5e-6, 1e-4}, 1e-5}};
    for (size_t i = 0; i < sizeof bound / sizeof bound[0]; i++)
        for (int how = FROM_REST; how <= IN_MOTION; how++) {
            build_stiff(&m, bound[i].damped < 1000 ? 20 : 8, false, 50, bound[i].damped, (motion)how);
            const double cloth = error_after(&m, 17);
            build_stiff(&m, 32, true, 50, bound[i].damped, (motion)how);
            const double rope = error_after(&m, 25);
            printf("# damping %g mass/frame, %s: cloth %.1e m, rope %.1e m\n", bound[i].damped,
                   how == FROM_REST ? "from rest" : "in motion", cloth, rope);
            CHECK_BELOW(cloth, bound[i].cloth[how], "measured by the study of the scheme");
            CHECK_BELOW(rope, bound[i].rope, "measured by the study of the scheme");
        }
}

/* The slope of the errors of position and velocity between steps of dt and dt/4, with the series at every step: a limit
   of explicit damping of 0 makes leapfrog use it. */
static void slopes(const model *m, double dt, int steps, double slope[2])
{
    double error[2][2];
    for (int finer = 0; finer < 2; finer++) {
        const int parts = finer ? 4 : 1;
        spring_scene *s = scene_of(&m->def), *reference = scene_of(&m->def);
        spring_scene_stable_step(s, SPRING_LEAPFROG);
        s->bounds.damping = INFINITY;
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt / parts, (uint64_t)(steps * parts)) == SPRING_OK &&
                  spring_scene_advance(reference, SPRING_RK4, dt / 100, (uint64_t)(100 * steps)) == SPRING_OK,
              "stable");
        error[finer][0] = distance_between(s, reference, m->def.particles, SPRING_POSITION);
        error[finer][1] = distance_between(s, reference, m->def.particles, SPRING_VELOCITY);
        free(s);
        free(reference);
    }
    for (int q = 0; q < 2; q++)
        slope[q] = log2(error[0][q] / error[1][q]) / 2;
}

/* Damping slow enough for second order, and so fast that the order falls. */
static void order(void)
{
    static model m;
    static const struct {
        double reach, least; /* of dt G; the least slope */
    } cases[] = {{0.25, 1.9}, {3, 1.9}, {10, 1.6}, {100, 1.3}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double slope[2];
        build_stiff(&m, 6, false, 10, 1, IN_MOTION);
        spring_scene *s = scene_of(&m.def);
        const double dt = 0.02 * 2 / sqrt(spring_scene_find_bounds(s)->stiffness);
        const double more = cases[i].reach / (dt * spring_scene_find_bounds(s)->link_damping);
        free(s);
        for (size_t j = 0; j < m.def.links; j++)
            m.link[j].damping *= more;
        slopes(&m, dt, 40, slope);
        printf("# dt G = %g: slope of the error of position %.2f, of velocity %.2f\n", cases[i].reach, slope[0],
               slope[1]);
        CHECK(slope[0] >= cases[i].least && slope[1] >= cases[i].least, "second order up to dt G = 3, less beyond");
    }
}

/* The error of three particles on two links that turn, with steps of dt G = `reach`. */
static double turning_error(double damping, double reach)
{
    const double position[] = {0, 0, 0, 1, 0, 0, 1.8, 0.5, 0}, velocity[] = {0, 1, 0, 0, -1, 0.3, 0.4, 0, 0};
    const spring_link link[] = {{.a = 0, .b = 1, .rest = 0.9, .stiffness = 30, .damping = damping},
                                {.a = 1, .b = 2, .rest = 0.9, .stiffness = 30, .damping = damping}};
    const spring_scene_def def = {.particles = 3, .position = position, .velocity = velocity, .links = 2, .link = link};
    double end[2][9], square = 0;
    for (int accurate = 0; accurate < 2; accurate++) {
        spring_scene *s = scene_of(&def);
        const double steps = accurate ? 1e5 : ceil(4 * damping / reach);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1 / steps, (uint64_t)steps) == SPRING_OK, "one second");
        spring_scene_get(s, SPRING_POSITION, end[accurate], 0, 0, 3);
        free(s);
    }
    for (int i = 0; i < 9; i++)
        square += (end[0][i] - end[1][i]) * (end[0][i] - end[1][i]);
    return sqrt(square);
}

/* At dt G = 0.6 the number of evaluations changes. The error of p is 2.5 times as large below it as above, and without the
   turning term it would be ten times as large. */
static void one_evaluation(void)
{
    for (double damping = 20; damping < 100; damping *= 1.7) {
        const double below = turning_error(damping, 0.59), above = turning_error(damping, 0.61);
        printf("# damping %g: error %.2g with one evaluation, %.2g with two\n", damping, below, above);
        CHECK_BELOW(below, 3 * above, "the error does not jump by an order of magnitude");
    }
}

#endif

/* At the stable step: the energy never rises above what it was, and falls from second to second. */
static void energy_falls(void)
{
    static model m;
    for (double damped = 10; damped <= 1000; damped *= 10)
        for (int rope = 0; rope < 2; rope++) {
            build_stiff(&m, rope ? 32 : 12, rope, 50, damped, FROM_REST);
            spring_scene *s = scene_of(&m.def);
            const double first = total_energy(s), weight = 9.81 * (rope ? 4 : 1);
            const int steps = (int)ceil(frame / spring_scene_stable_step(s, SPRING_LEAPFROG));
            double before = first;
            const double rounding = sizeof(scalar) == 4 ? 1e-4 : 1e-9;
            for (int second = 0; second < 10; second++) {
                CHECK(spring_scene_advance(s, SPRING_LEAPFROG, frame / steps, (uint64_t)(60 * steps)) == SPRING_OK,
                      "stable");
                const double now = total_energy(s);
                CHECK(now <= first + 0.001 * weight, "never more than at the start");
                CHECK(now <= before + (second < 5 ? 0 : rounding) + rounding * weight,
                      "and less from second to second");
                before = now;
            }
            free(s);
        }
}

/* ------------------------------------------------------------------------------------------------------- stability */

/* A random scene, small or large, of any layout, with masses, stiffness and damping over six decades. */
static void build_wild(model *m, unsigned number)
{
    static const uint32_t grids[][3] = {{4, 3, 1}, {3, 1, 1}, {9, 7, 1}, {3, 3, 3}, {40, 1, 1}};
    build(m, grids[number % 5], 1 + number / 5 % 3, (number * 37) % feature_masks | MASSES | DAMPED);
    for (size_t i = 0; i < m->def.particles; i++)
        m->mass[i] = random_log(1e-3, 1e3);
    for (size_t i = 0; i < m->def.links; i++) {
        m->link[i].stiffness = random_log(1e-3, 1e3);
        m->link[i].damping = random_bits() % 4 ? random_log(1e-3, 1e3) : 0;
        m->link[i].rest = m->def.axes == 1 ? 0 : 0.5 * m->link[i].rest;
    }
    for (size_t i = 0; i < 3 * m->def.particles; i++)
        m->velocity[i] *= 1e-3;
    m->def.methods = 1u << SPRING_LEAPFROG;
}

static const double of_stable_step = 0.95;

/* The largest kinetic and elastic energy of a run at this fraction of the stable step, its start included. */
static double energy_of_run(const model *m, int steps)
{
    spring_scene *s = scene_of(&m->def);
    const double dt = of_stable_step * fmin(spring_scene_stable_step(s, SPRING_LEAPFROG), 1e6);
    double largest = 0;
    for (int i = 0; i <= steps; i += 20) {
        const spring_scene_energies e = spring_scene_energy(s);
        largest = fmax(largest, e.kinetic + e.elastic);
        if (spring_scene_advance(s, SPRING_LEAPFROG, dt, 20) != SPRING_OK)
            largest = INFINITY;
    }
    free(s);
    return largest;
}

/* SPRINGSTEP_SCENES=3000 SPRINGSTEP_STEPS=10000 in the environment: more of them, for longer. */
static void stable_at_any_damping(void)
{
    static model m;
    const char *scenes = getenv("SPRINGSTEP_SCENES"), *steps = getenv("SPRINGSTEP_STEPS");
    unsigned heavy = 0;
    for (unsigned number = 0; number < (scenes != NULL ? (unsigned)atoi(scenes) : 60); number++) {
        build_wild(&m, number);
        const int length = steps != NULL ? atoi(steps) : 500;
        const double damped = energy_of_run(&m, length);
        spring_scene *s = scene_of(&m.def);
        const double stable = spring_scene_stable_step(s, SPRING_LEAPFROG);
        heavy += stable < INFINITY && stable * s->bounds.damping > 2;
        free(s);
        for (size_t i = 0; i < m.def.links; i++)
            m.link[i].damping = 0;
        const double undamped = energy_of_run(&m, length);
        /* What does not grow is v.(W - h^2 K/4) v + x.K x, which may be this much smaller. A moving pin that drags a
           particle stretches its links. */
        const double more = m.def.pinned != NULL ? 100 : 1 / (1 - of_stable_step * of_stable_step);
        CHECK_BELOW(damped, more * undamped, "damping adds no energy");
    }
    CHECK(heavy > 30, "most of these scenes use the series");
}

/* ----------------------------------------------------------------------------------------------------------- bits */

static const uint32_t grids[][3] = {{3, 1, 1}, {2, 2, 1}, {9, 7, 1}, {4, 3, 3}, {70, 1, 1}};
enum { grid_count = sizeof grids / sizeof grids[0] };

/* Tension-only links that are slack: heavy dampers do nothing, in bands and in small scenes. */
static void slack_links(void)
{
    static model m;
    for (uint32_t count = 3; count <= 40; count += 37) {
        build(&m, (uint32_t[]){count, 1, 1}, 3, DAMPED);
        for (size_t i = 0; i < m.def.links; i++) {
            m.link[i].damping *= 1e3;
            m.link[i].rest = 50;
        }
        m.def.flags |= SPRING_SCENE_TENSION_ONLY;
        m.def.methods = 1u << SPRING_LEAPFROG;
        spring_scene *s = scene_of(&m.def);
        static state before, after;
        get_state(s, m.def.particles, &before);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.4 * spring_scene_stable_step(s, SPRING_LEAPFROG), 5) ==
                  SPRING_OK,
              "stable");
        get_state(s, m.def.particles, &after);
        const double terms = 500; /* more than the series has here */
        for (size_t i = 0; i < 3 * m.def.particles; i++)
            CHECK_CLOSE(after.v[i], before.v[i], 5 * terms * sqrt(terms) * EPS,
                        "free flight: rounding of the series alone");
        free(s);
    }
}

/* So much damping that the number of terms is bounded: stable all the same. */
static void beyond_the_largest_number_of_terms(void)
{
    const double x[] = {0, 0, 1.1, 0}, v[] = {0.2, -0.1, 0, 0.3};
    for (double damping = 1e3; damping < 1e25; damping *= 1e7) {
        const spring_link link = {0, 1, 1, 30, damping, 0};
        const spring_scene_def def = {
            .axes = 2, .particles = 2, .links = 1, .position = x, .velocity = v, .mass_all = 1.3, .link = &link};
        spring_scene *s = scene_of(&def);
        CHECK_CLOSE(spring_scene_stable_step(s, SPRING_LEAPFROG), 2 / sqrt(2 * 30 / 1.3), 8 * EPS,
                    "the stable step does not depend on damping");
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 50) == SPRING_OK && total_energy(s) < 0.3,
              "no more than at the start, 0.24 J");
        free(s);
    }
}

/* -------------------------------------------------------------------------------------------------------- max_speed */

static void too_fast_scene(model *m, unsigned features, spring_method method, double max_speed)
{
    build(m, grids[features % grid_count], 2, features & ~(unsigned)(DAMPED | DRAG));
    for (size_t i = 0; i < m->def.particles; i++)
        m->velocity[2 * i] =
            pinned_in(&m->def, i) ? 2 * max_speed : m->velocity[2 * i]; /* pinned particles may be fast */
    m->def.methods = 1u << method;
    m->def.max_speed = max_speed;
}

/* A step too long: the call in which the scene first gets too fast fails, in the step where it does, and changes nothing.
   With half the step, from there, it continues. */
static void too_fast(void)
{
    static model m;
    build(&m, grids[0], 2, 0);
    const method_list methods = methods_of(m.def);
    for (const spring_method *method = methods.at; *method != no_method; method++)
        for (unsigned features = 0; features < feature_masks; features += 93) {
            const double limit = 30;
            too_fast_scene(&m, features, *method, limit);
            spring_scene *s = scene_of(&m.def);
            m.def.max_speed = 0;
            spring_scene *unlimited = scene_of(&m.def);
            const double own = spring_scene_stable_step(s, *method);
            const double dt = own > 0 ? 3 * own : spring_scene_stable_step(s, SPRING_LEAPFROG);
            if (!isfinite(dt)) { /* no link acts on a free particle */
                free(s), free(unlimited);
                continue;
            }
            int steps = 0;
            spring_status status = SPRING_OK;
            static state before, after;
            while (status == SPRING_OK && steps < 10000) {
                get_state(s, m.def.particles, &before);
                status = spring_scene_advance(s, *method, dt, 1);
                steps++;
                spring_scene_advance(unlimited, *method, dt, 1);
                static double v[3 * most];
                double fastest = 0;
                spring_scene_get(unlimited, SPRING_VELOCITY, v, 2, 0, m.def.particles);
                for (size_t i = 0; i < 2 * m.def.particles; i++)
                    if (!pinned_in(&m.def, i / 2))
                        fastest = fmax(fastest, isnan(v[i]) ? INFINITY : fabs(v[i]));
                CHECK((status == SPRING_OK) == (fastest <= limit), "the step after which it is too fast fails");
            }
            CHECK(status == SPRING_EUNSTABLE, "and says so");
            get_state(s, m.def.particles, &after);
            CHECK(memcmp(before.x, after.x, 2 * m.def.particles * sizeof(double)) == 0 &&
                      memcmp(before.v, after.v, 2 * m.def.particles * sizeof(double)) == 0,
                  "unchanged to the bit");
            spring_scene *at_once = scene_of(&m.def);
            free(at_once);
            m.def.max_speed = limit;
            at_once = scene_of(&m.def);
            CHECK(spring_scene_advance(at_once, *method, dt, (uint64_t)steps) == SPRING_EUNSTABLE &&
                      (steps == 1 || spring_scene_advance(at_once, *method, dt, (uint64_t)steps - 1) == SPRING_OK),
                  "in one call as in many");
            free(s), free(unlimited), free(at_once);
        }
}

/* Velocities at the ends of steps are compared, not those half a step later, which here are larger: ten steps a period, from
   rest, so that the velocity is largest in the middle of a step. */
static void speed_at_the_ends_of_steps(void)
{
    const double x[] = {0, 1}, pi = 3.141592653589793;
    const uint8_t pinned[] = {1, 0};
    const spring_link link = {0, 1, 0.4, 2.7, 0, 0};
    spring_scene_def def = {
        .axes = 1, .particles = 2, .links = 1, .position = x, .pinned = pinned, .link = &link, .mass_all = 1.3};
    const double dt = 2 * sin(pi / 10) / sqrt(2.7 / 1.3);
    spring_scene *s = scene_of(&def);
    double fastest = 0, v[2];
    for (int i = 0; i < 10; i++) {
        spring_scene_advance(s, SPRING_LEAPFROG, dt, 1);
        spring_scene_get(s, SPRING_VELOCITY, v, 1, 0, 2);
        fastest = fmax(fastest, fabs(v[1]));
    }
    free(s);
    def.max_speed = fastest;
    s = scene_of(&def);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 10) == SPRING_OK, "not above the limit");
    free(s);
    def.max_speed = fastest * 0.999;
    s = scene_of(&def);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 10) == SPRING_EUNSTABLE, "above it");
    free(s);
}

/* --------------------------------------------------------------------------------------------------- softened links */

/* Bad input: nothing is written. */
static void soften_bad_input(void)
{
    static model m, before;
    build(&m, grids[2], 3, 0);
    before = m;
    const double bad[][2] = {{0, 0.5}, {-1, 0.5}, {NAN, 0.5}, {INFINITY, 0.5}, {0.1, 0}, {0.1, 1.1}, {0.1, NAN}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK(spring_links_soften(&m.def, bad[i][0], bad[i][1], m.link) == SPRING_EINVAL, "a step, or a fraction");
    CHECK(spring_links_soften(&m.def, 0.1, 0.5, NULL) == SPRING_EINVAL &&
              spring_links_soften(NULL, 0.1, 0.5, m.link) == SPRING_EINVAL,
          "NULL");
    m.def.particles = 0;
    CHECK(spring_links_soften(&m.def, 0.1, 0.5, m.link) == SPRING_EINVAL, "a bad definition");
    CHECK(memcmp(m.link, before.link, sizeof m.link) == 0, "nothing is written");
}

/* How far 200 random softened scenes get from the places of their pins, which teleport, in 60 frames of 17 and 100 ms, in
   radii of the sphere that holds these places. Nothing is damped, so what the pins do to a scene stays in it. */
static double farthest_of_softened(double fraction)
{
    static model m;
    double worst = 0;
    for (unsigned number = 0; number < 200; number++) {
        const bool rope = number % 2;
        const double long_frame = number % 4 < 2 ? 0.0166666 : 0.1, jump = 0.5;
        build_stiff(&m, rope ? 32 : 12, rope, random_log(10, 1000), 0, FROM_REST);
        for (size_t i = 0; i < m.def.particles; i++)
            m.mass[i] *= random_log(1, 1000);
        for (size_t i = 0; i < m.def.links; i++)
            m.link[i].stiffness *= random_log(0.03, 30);
        m.def.gravity[2] = 0;
        const double center = rope ? 0 : 0.5; /* of the places of the pins, along x */
        CHECK(spring_links_soften(&m.def, long_frame, fraction, m.link) == SPRING_OK, "a valid definition");
        spring_scene *s = scene_of(&m.def);
        double radius = 0, farthest = 0;
        for (int i = 0; i < 60; i++) {
            for (size_t p = 0; p < m.def.particles; p++)
                if (m.pinned[p]) {
                    double to[3];
                    for (size_t a = 0; a < 3; a++)
                        to[a] = m.position[3 * p + a] + jump * random_uniform(-1, 1);
                    radius = fmax(radius, hypot(hypot(to[0] - center, to[1]), to[2]));
                    spring_scene_drive(s, p, to, long_frame);
                }
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, long_frame, 1) == SPRING_OK, "it does not run away");
            static state y;
            get_state(s, m.def.particles, &y);
            for (size_t p = 0; p < m.def.particles; p++)
                farthest = fmax(farthest, hypot(hypot(y.x[3 * p] - center, y.x[3 * p + 1]), y.x[3 * p + 2]));
        }
        worst = fmax(worst, farthest / radius - 1);
        free(s);
    }
    return worst;
}

static void softened_scenes_stay(void)
{
    CHECK_BELOW(farthest_of_softened(0.3), 30, "at a step well below the limit they stay within a few times the size");
    CHECK_BELOW(farthest_of_softened(0.95), 100,
                "near the limit steps are in resonance with pins, but nothing runs away");
}

int main(void)
{
    static const test tests[] = {
        {"slack links", slack_links},
        {"more damping than terms", beyond_the_largest_number_of_terms},
        {"max_speed", too_fast},
        {"max_speed at the ends of steps", speed_at_the_ends_of_steps},
        {"soften: bad input", soften_bad_input},
        {"softened scenes", softened_scenes_stay},
        {"energy falls", energy_falls},
        {"stable at any damping", stable_at_any_damping},
#ifndef SPRING_FLOAT
        {"order", order},
        {"one evaluation", one_evaluation},
        {"errors", errors},
#endif
    };
    return RUN_TESTS("scene_damping", tests);
}
