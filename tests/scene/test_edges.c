/* SPDX-License-Identifier: MIT */
/* Scenes with very large numbers or without contents: the ends of bands, pins, time, queries. */
#include "test_scene.h"

enum { count = 16 };

/* Eight particles in a damped band, and one that is joined to nothing, so far and fast that its distance to the others
   squared is infinite. Vectors read it, and that must change nothing, whatever their length. */
static void stranger(void)
{
#ifdef SPRING_FLOAT
    const double far = 1e20, fast = 1e19;
#else
    const double far = 1e160, fast = 1e159;
#endif
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (uint32_t at = 9; at < count; at++)
            for (int k = 0; k < kernel_count; k++) {
                double position[3 * count] = {0}, velocity[3 * count] = {0};
                spring_link link[8];
                for (uint32_t i = 0; i < 9; i++)
                    position[axes * i] = 0.7 * i + 0.01 * (i % 3);
                position[axes * at] = far;
                velocity[axes * at] = fast;
                for (uint32_t i = 0; i < 8; i++)
                    link[i] = (spring_link){i, i + 1, 0.6, 2.7, 0.3};
                spring_scene_def def = {.axes = axes,
                                        .particles = count,
                                        .links = 8,
                                        .position = position,
                                        .velocity = velocity,
                                        .mass_all = 1.3,
                                        .link = link};
                if (kernels_of(k) == NULL)
                    continue;
                const method_list all = use_all_methods(&def);
                for (const spring_method *m = all.at; *m != no_method; m++) {
                    spring_scene *s = scene_of(&def);
                    CHECK(spring_scene_advance_with(kernels_of(k), s, *m, 0.01, 5) == SPRING_OK, "nothing joins them");
                    double x[3];
                    spring_scene_get(s, SPRING_POSITION, x, 0, 8, 1);
                    CHECK(fabs(x[0] - position[axes * 8]) < 0.1, "its neighbours move as ever");
                    free(s);
                }
            }
}

static void push_without_end(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                             scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v;
    force[0][0] = INFINITY;
}

/* A pin feels no force, of whatever size. */
static void infinite_force_on_a_pin(void)
{
    const double position[] = {0.2, 0, 0, 1.1, 0, 0}, velocity[] = {0.3, 0, 0, 0, 0, 0};
    const uint8_t pinned[] = {1, 0};
    spring_scene_def def = {
        .particles = 2, .position = position, .velocity = velocity, .pinned = pinned, .force = push_without_end};
    const method_list all = use_all_methods(&def);
    for (const spring_method *m = all.at; *m != no_method; m++) {
        spring_scene *s = scene_of(&def);
        CHECK(spring_scene_advance(s, *m, 0.1, 5) == SPRING_OK, "the pin does not feel it");
        double x[3];
        spring_scene_get(s, SPRING_POSITION, x, 0, 0, 1);
        CHECK_CLOSE(x[0], 0.2 + 5 * 0.1 * 0.3, 6 * EPS, "a straight line, rounded once a step");
        free(s);
    }
}

static void time_stays_finite(void)
{
    const double position[] = {0, 0, 0};
    const spring_scene_def def = {.particles = 1, .position = position};
    spring_scene *s = scene_of(&def);
#ifdef SPRING_FLOAT
    const double dt = 1e38, tiny = 1e-50; /* is 0 as a float */
#else
    const double dt = 1e308, tiny = 0;
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 10) == SPRING_ENONFINITE, "the time would be infinite");
    CHECK_BITS(spring_scene_time(s), 0, "nothing happened");
#endif
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK, "one such step is possible");
    CHECK_BITS(spring_scene_time(s), dt, "dt");
#ifndef SPRING_FLOAT
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_ENONFINITE, "a second one of the same run is not");
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, -dt, 1) == SPRING_OK && spring_scene_time(s) == 0, "back it may go");
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK, "and forth");
#endif
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, tiny, 3) == SPRING_OK, "a step that is no step in this precision");
    CHECK_BITS(spring_scene_time(s), dt, "takes no time");
    free(s);
}

/* A rest length of -0 is one of 0, and turns no link. */
static void negative_zero_rest(void)
{
    const double position[] = {0.1, 1.2};
    for (int turned = 0; turned < 2; turned++) {
        double tension[2];
        for (int negative = 0; negative < 2; negative++) {
            const spring_link link = {turned ? 1 : 0, turned ? 0 : 1, negative ? -0.0 : 0.0, 2.7, 0};
            const spring_scene_def def = {.axes = 1, .particles = 2, .links = 1, .position = position, .link = &link};
            spring_scene *s = scene_of(&def);
            tension[negative] = spring_scene_tension(s, 0);
            free(s);
        }
        CHECK_BITS(tension[1], tension[0], "one zero is as good as the other");
        CHECK_CLOSE(tension[0], turned ? -2.7 * 1.1 : 2.7 * 1.1, 3 * 4 * EPS, "stiffness (x_b - x_a), four roundings");
    }
}

static void push(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                 scalar *const force[3])
{
    (void)t, (void)particles, (void)x, (void)v;
    force[0][0] += (scalar) * (const double *)user;
}

/* A question about a scene does not freeze what the callback said then. */
static void questions_keep_no_callback(void)
{
    double strength = 0, x[2][3];
    const double position[] = {0, 0, 0};
    const spring_scene_def def = {
        .particles = 1, .position = position, .mass_all = 1.3, .force = push, .user = &strength};
    for (int asked = 0; asked < 2; asked++) {
        spring_scene *s = scene_of(&def);
        strength = 0;
        spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 1);
        if (asked)
            CHECK(spring_scene_at_rest(s, 0, 0), "nothing moves yet");
        strength = 0.7;
        spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 1);
        spring_scene_get(s, SPRING_POSITION, x[asked], 0, 0, 1);
        free(s);
    }
    CHECK_CLOSE(x[0][0], 0.1 * 0.05 * 0.7 / 1.3, 8 * EPS * 0.003, "h h/2 F/m, eight roundings");
    CHECK_BITS(x[1][0], x[0][0], "asked or not");
}

/* Light drag over many steps: rounding must not be of the same sign in each, or it adds up to n eps/2. */
static void drag_without_bias(void)
{
    const int n = 200000;
    const double position[] = {0, 0, 0}, velocity[] = {0.83, -0.59, 0}, h = 1e-3, drag = 0.02;
    const spring_scene_def def = {
        .particles = 1, .position = position, .velocity = velocity, .mass_all = 1.3, .drag = drag};
    spring_scene *s = scene_of(&def);
    double v[3];
    spring_scene_advance(s, SPRING_LEAPFROG, h, (uint64_t)n);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
    const double q = (double)(scalar)h / 2 * (double)(scalar)drag / 1.3;
    const double want = exp(n * (log1p(-q) - log1p(q)));
    /* each step rounds v by at most 4 half eps of it; unbiased, they add up like a walk: six deviations of it. The rest
       is what rounding q itself, once, does over all steps. */
    const double bound = 6 * 4 * EPS / 2 * sqrt(n) + 4 * EPS * n * q;
    CHECK_CLOSE(v[0] / velocity[0], want, bound * want, "a walk of rounding errors");
    CHECK_CLOSE(v[1] / velocity[1], want, bound * want, "a walk of rounding errors");
    free(s);
}

/* Particles of no stated mass have 1 kg, whether some are pinned or not. */
static void one_kilogram(void)
{
    const double x[] = {0, 1.5}, h = 0.25;
    const uint8_t pinned[] = {1, 0};
    const spring_link link = {0, 1, 0.5, 3, 0};
    for (int pins = 0; pins < 2; pins++) {
        const spring_scene_def def = {
            .axes = 1, .particles = 2, .links = 1, .position = x, .pinned = pins ? pinned : NULL, .link = &link};
        spring_scene *s = scene_of(&def);
        double v[2];
        spring_scene_advance(s, SPRING_EULER, h, 1);
        spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 2);
        CHECK_BITS(v[0], pins ? 0 : h * 3, "3 N on 1 kg, exactly");
        CHECK_BITS(v[1], -h * 3, "3 N on 1 kg, exactly");
        const double omega2 = pins ? 3 : 6; /* once where the other end is pinned, else twice */
        CHECK_CLOSE(spring_scene_stable_step(s, SPRING_LEAPFROG), 2 / sqrt(omega2), 4 * EPS,
                    "2/omega, three roundings");
        free(s);
    }
}

/* Drag of 1 kg/s is drag like any other. */
static void drag_of_one(void)
{
    const double position[] = {0, 0, 0}, velocity[] = {0.83, -0.59, 0.2}, h = 0.25, q = h / 2 / 1.3;
    const spring_scene_def def = {
        .particles = 1, .position = position, .velocity = velocity, .mass_all = 1.3, .drag = 1};
    spring_scene *s = scene_of(&def);
    double v[3];
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, h, 1) == SPRING_OK, "a step");
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
    for (int a = 0; a < 3; a++)
        CHECK_CLOSE(v[a], velocity[a] * (1 - q) / (1 + q), 8 * EPS * fabs(velocity[a]),
                    "the rounded start, q twice, and six roundings");
    free(s);
}

/* A single link with a damper among others without: leapfrog predicts the velocity for it, and Euler feels it. */
static void one_damper(void)
{
    const double x0[] = {0.2, 1.3}, v0[] = {0, -0.7}, k = 2.7, c = 0.4, m = 1.3, rest = 0.6, h = 0.125;
    const uint8_t pinned[] = {1, 0};
    const spring_method both[] = {SPRING_EULER, SPRING_LEAPFROG};
    for (int i = 0; i < 2; i++) {
        const spring_link link[] = {{0, 1, rest, k / 2, 0}, {0, 1, rest, k / 2, c}};
        const spring_scene_def def = {.axes = 1,
                                      .particles = 2,
                                      .links = 2,
                                      .position = x0,
                                      .velocity = v0,
                                      .mass_all = m,
                                      .pinned = pinned,
                                      .link = link};
        spring_scene *s = scene_of(&def);
        double v[2], want = v0[1] - h * (k * (x0[1] - x0[0] - rest) + c * v0[1]) / m;
        if (both[i] == SPRING_LEAPFROG) {
            const double half = (v0[1] + want) / 2, pull = k * (x0[1] + h * half - x0[0] - rest);
            want = half - h / 2 * (pull + c * want) / m; /* predicted is Euler's step */
        }
        CHECK(spring_scene_advance(s, both[i], h, 1) == SPRING_OK, "a step");
        spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 2);
        CHECK_CLOSE(v[1], want, 12 * EPS, "a kick, or two, of four roundings of numbers below 2");
        free(s);
    }
}

static void hold(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                 scalar *const force[3])
{
    (void)t, (void)x, (void)v;
    for (size_t i = 0; i < particles; i++)
        force[1][i] += *(const scalar *)user;
}

/* Particles of equal mass that a force holds against gravity are at rest, however many they are. */
static void at_rest_against_gravity(void)
{
    for (size_t particles = 1; particles <= count; particles++) {
        const double position[3 * count] = {0};
        scalar weight = 10; /* [N] of 1.25 kg at 8 m/s^2: exact */
        const spring_scene_def def = {.particles = particles,
                                      .position = position,
                                      .mass_all = 1.25,
                                      .gravity = {0, -8, 0},
                                      .force = hold,
                                      .user = &weight};
        spring_scene *s = scene_of(&def);
        CHECK(spring_scene_at_rest(s, 0, 0), "10 N/1.25 kg - 8 m/s^2 is 0, exactly");
        free(s);
    }
}

/* One bad element is enough on any axis there is, and of no interest on others. */
static void gravity_of_axes(void)
{
    const double position[] = {0, 0, 0};
    for (uint32_t axes = 1; axes <= 3; axes++) {
        const spring_scene_def def = {.axes = axes, .particles = 1, .position = position};
        spring_scene *s = scene_of(&def);
        for (uint32_t bad = 0; bad < 4; bad++) {
            double gravity[] = {0.5, 0.5, 0.5, 7}, v[3] = {0}; /* and one behind */
            const double time = spring_scene_time(s);
            gravity[bad] = NAN;
            const spring_status want = bad < axes ? SPRING_EINVAL : SPRING_OK;
            CHECK(spring_scene_set_gravity(s, gravity) == want, "elements beyond the axes are ignored");
            CHECK_BITS(spring_scene_time(s), time, "nothing else changes");
            spring_scene_set(s, SPRING_VELOCITY, v, 0, 0, 1);
            spring_scene_advance(s, SPRING_EULER, 0.5, 1);
            spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
            for (uint32_t a = 0; a < axes; a++)
                CHECK_BITS(v[a], want == SPRING_OK ? 0.25 : 0, "as set, or as it was");
        }
        free(s);
    }
}

/* Weak links limit Euler's step as strong ones do. Neither a damper nor drag limits that of leapfrog. */
static void limits_of_weak_links(void)
{
    static const struct {
        double damping, drag;
    } cases[] = {{0, 0.03}, {2.3, 0.03}, {0, 5}};
    const double position[] = {0, 1}, k = 0.05, m = 1.3;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double damping = cases[i].damping, drag = cases[i].drag;
        const spring_link link = {0, 1, 0.6, k, damping};
        const spring_scene_def def = {
            .axes = 1, .particles = 2, .links = 1, .position = position, .mass_all = m, .link = &link, .drag = drag};
        spring_scene *s = scene_of(&def);
        const double G = (drag + 2 * damping) / m, omega = sqrt(2 * k / m), euler = fmin(drag / (2 * k), 2 / G);
        const double leapfrog = 2 / omega;
        CHECK(i == 0 || 2 / G < 1 / omega, "it is the damper, or drag, that could limit");
        CHECK(i < 2 || 2 / G < drag / (2 * k), "and here it limits Euler's step");
        CHECK_CLOSE(spring_scene_stable_step(s, SPRING_EULER), euler, 8 * EPS * euler, "d/K or 2/G, a few roundings");
        CHECK_CLOSE(spring_scene_stable_step(s, SPRING_LEAPFROG), leapfrog, 8 * EPS * leapfrog,
                    "2/omega, a few roundings");
        free(s);
    }
}

/* A damped link of length 0 has no direction in which it could grow: it pulls, or pushes, by its stiffness alone. */
static void tension_at_length_zero(void)
{
    const double position[] = {0.3, 0.4, 0.5, 0.3, 0.4, 0.5}, velocity[] = {0, 0, 0, 1, 2, 3};
    const spring_link link = {0, 1, 0.5, 6, 0.7};
    for (uint32_t axes = 2; axes <= 3; axes++) {
        double x[6];
        for (size_t i = 0; i < 2 * axes; i++)
            x[i] = position[i % axes];
        const spring_scene_def def = {
            .axes = axes, .particles = 2, .links = 1, .position = x, .velocity = velocity, .link = &link};
        spring_scene *s = scene_of(&def);
        CHECK_BITS(spring_scene_tension(s, 0), -3, "6 N/m (0 - 0.5 m), exactly");
        free(s);
    }
}

/* Without links drag alone limits Euler's step. */
static void limit_of_drag_alone(void)
{
    const double position[] = {0, 0, 0};
    const spring_scene_def def = {.particles = 1, .position = position, .mass_all = 1.3, .drag = 0.7};
    spring_scene *s = scene_of(&def);
    CHECK_CLOSE(spring_scene_stable_step(s, SPRING_EULER), 2 * 1.3 / 0.7, 4 * 4 * EPS, "2 m/d, four roundings");
    free(s);
}

/* What lies behind the numbers to be set is not looked at. */
static void set_reads_no_further(void)
{
    const double position[] = {0, 0, 0, 1, 1, 1}, in[] = {0.3, 0.4, 0.5, NAN, NAN, NAN};
    const spring_scene_def def = {.particles = 2, .position = position};
    spring_scene *s = scene_of(&def);
    CHECK(spring_scene_set(s, SPRING_POSITION, in, 0, 1, 1) == SPRING_OK, "three numbers, all finite");
    free(s);
}

/* 2 stiffness/mass and 2 damping/mass just fit, or just do not. */
static void largest_link(void)
{
#ifdef SPRING_FLOAT
    const double largest = FLT_MAX;
#else
    const double largest = DBL_MAX;
#endif
    const double position[] = {0, 0, 0, 1, 1, 1}, mass[] = {1.5, 2};
    for (int damping = 0; damping < 2; damping++)
        for (int fits = 0; fits < 2; fits++) {
            const double value = fits ? largest / 2.5 * 1.5 : largest / 1.9 * 1.5;
            const spring_link link = {0, 1, 0.7, damping ? 0 : value, damping ? value : 0};
            const spring_scene_def def = {
                .particles = 2, .links = 1, .position = position, .mass = mass, .link = &link};
            const char *field;
            const spring_status status = spring_scene_check(&def, &field, NULL);
            CHECK(status == (fits ? SPRING_OK : SPRING_EINVAL), "2/mass of it is finite, or not");
            CHECK(fits || strcmp(field, damping ? "link.damping" : "link.stiffness") == 0, "and names it");
        }
}

int main(void)
{
    static const test tests[] = {
        {"drag alone limits the step", limit_of_drag_alone},
        {"set reads no further", set_reads_no_further},
        {"the largest links", largest_link},
        {"a particle far away that is joined to nothing", stranger},
        {"an infinite force on a pin", infinite_force_on_a_pin},
        {"time stays finite", time_stays_finite},
        {"a rest length of -0", negative_zero_rest},
        {"questions keep no force of a callback", questions_keep_no_callback},
        {"drag without bias", drag_without_bias},
        {"1 kg", one_kilogram},
        {"drag of 1", drag_of_one},
        {"one damper", one_damper},
        {"at rest against gravity", at_rest_against_gravity},
        {"gravity on the axes there are", gravity_of_axes},
        {"limits of weak links", limits_of_weak_links},
        {"tension at length 0", tension_at_length_zero},
    };
    return RUN_TESTS("scene-edges", tests);
}
