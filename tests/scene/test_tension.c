/* SPDX-License-Identifier: MIT */
/* Tension-only links: forces, energy and tension, order across the kink, and the bound on the stable step. */
#include "test_scene.h"

/* About half of the links are slack. */
static void build_net(model *m, const uint32_t count[3], uint32_t axes, unsigned features)
{
    build(m, count, axes, features);
    for (size_t i = 0; i < m->def.links && (features & OWN) == 0; i++)
        m->link[i].rest = 0.8;
    m->def.flags |= SPRING_SCENE_TENSION_ONLY;
    m->def.methods = 0;
    use_all_methods(&m->def);
}

static const uint32_t shapes[][3] = {{3, 1, 1}, {7, 1, 1}, {6, 2, 1},  {30, 1, 1},
                                     {9, 7, 1}, {5, 4, 3}, {70, 4, 1}, {0, 0, 0}};

static spring_scene *run_with(const scene_kernels *kernels, const spring_scene_def *def)
{
    const method_list all = methods_of(*def);
    spring_scene *s = scene_of(def);
    for (const spring_method *method = all.at; *method != no_method; method++)
        CHECK(spring_scene_advance_with(kernels, s, *method, 1e-3, 5) == SPRING_OK, "stable");
    return s;
}

static void check_kernels(const model *m)
{
    spring_scene *first = run_with(kernels_of(0), &m->def);
    for (int k = 0; k < kernel_count; k++) {
        if (kernels_of(k) == NULL)
            continue;
        check_forces(m, kernels_of(k));
        spring_scene *s = run_with(kernels_of(k), &m->def);
        CHECK(same_bits(s, first, m->def.particles, m->def.axes), "lane by lane the same operations");
        free(s);
    }
    free(first);
}

static void forces_and_bits(void)
{
    static model m;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 23)
            for (const uint32_t *shape = shapes[0]; shape[0] > 0; shape += 3) {
                build_net(&m, shape, axes, features);
                check_kernels(&m);
            }
}

/* Ends at one place and links that are cut have no force, in bands and in lists. */
static void odd_links(void)
{
    static model m;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 37)
            for (const uint32_t *shape = shapes[0]; shape[0] > 0; shape += 3) {
                build_net(&m, shape, axes, features | OWN);
                for (size_t i = 0; i < m.def.links; i++)
                    if (random_bits() % 5 == 0)
                        m.link[i].stiffness = m.link[i].damping = 0;
                    else if (random_bits() % 5 == 0)
                        m.link[i].rest = 0;
                for (size_t i = 1; i < m.def.particles; i++)
                    if (random_bits() % 8 == 0)
                        memcpy(m.position + i * axes, m.position + (i - 1) * axes, axes * sizeof m.position[0]);
                check_kernels(&m);
            }
}

/* Infinite distances are noticed as with other links, and not taken for slack. */
static void too_far(void)
{
    const double far = sizeof(scalar) == 4 ? 3e38 : 1.7e308, x[] = {-far, 0, far, 0, 0, 1}, v[6] = {0};
    for (uint32_t flags = 0; flags <= SPRING_SCENE_TENSION_ONLY; flags += SPRING_SCENE_TENSION_ONLY)
        for (int damped = 0; damped < 2; damped++) {
            const spring_link link = {0, 1, 0.7, 3, damped};
            const spring_scene_def def = {
                .axes = 2, .flags = flags, .particles = 3, .links = 1, .position = x, .velocity = v, .link = &link};
            spring_scene *s = scene_of(&def);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 1) == SPRING_ENONFINITE, "an infinite force");
            free(s);
        }
}

/* The force of the callback is that of the law, energies are those of the taut links, and tension is never negative. */
static void tension_and_energy(void)
{
    static model m;
    static state y;
    size_t slack = 0, pulled_in = 0;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 5) {
            build_net(&m, (uint32_t[]){5, 4, axes == 3 ? 2 : 1}, axes, features);
            spring_scene *s = scene_of(&m.def);
            get_state(s, m.def.particles, &y);
            double elastic = 0;
            for (size_t i = 0; i < m.def.links; i++) {
                const link_force f = evaluate_link(&m.link[i], axes, y.x, y.v);
                const double extension = f.length - (double)(scalar)m.link[i].rest;
                const double size =
                    m.link[i].stiffness * (f.length + m.link[i].rest) + m.link[i].damping * fabs(f.rate);
                CHECK_CLOSE(spring_scene_tension(s, i), extension > 0 && f.tension > 0 ? f.tension : 0,
                            8 * DBL_EPSILON * size, "the law of a tension-only link in double, a few roundings");
                slack += extension <= 0;
                pulled_in += extension > 0 && f.tension <= 0;
                elastic += extension > 0 ? (double)(scalar)m.link[i].stiffness * extension * extension / 2 : 0;
            }
            CHECK_CLOSE(spring_scene_energy(s).elastic, elastic, (double)m.def.links * DBL_EPSILON * elastic,
                        "the sum over the taut links");
            free(s);
        }
    CHECK(slack > 1000 && pulled_in > 10, "slack links, and damping that would push");
}

/* ----------------------------------------------------------------------------------------------- order and free flight */

/* A mass falls from 0.5 m below its pin until its rope of 1 m is taut, bounces, and flies up again: its height and speed
   at t. Between the two flights extension u is that of a spring with the load m g. */
static void bounce(double t, double k, double mass, double g, double *y, double *v)
{
    const double fall = sqrt(2 * 0.5 / g), speed = g * fall, omega = sqrt(k / mass), sag = g / (omega * omega);
    /* u = sag (1 - cos) + speed/omega sin, back at 0 with the opposite speed after the time `taut` */
    const double taut = (2 * acos(-1) - 2 * atan2(speed / omega, sag)) / omega, s = t - fall;
    if (s < 0) {
        *y = -0.5 - g * t * t / 2;
        *v = -g * t;
    } else if (s < taut) {
        *y = -1 - (sag * (1 - cos(omega * s)) + speed / omega * sin(omega * s));
        *v = -(sag * omega * sin(omega * s) + speed * cos(omega * s));
    } else {
        *y = -1 + speed * (s - taut) - g * (s - taut) * (s - taut) / 2;
        *v = speed - g * (s - taut);
    }
}

static double bounce_error(int n, double t, uint32_t strangers)
{
    static double x[3 * most];
    static uint8_t pinned[most];
    const double k = 300, mass = 1.3, g = 9.81;
    memset(x, 0, sizeof x);
    memset(pinned, 1, sizeof pinned);
    x[3 * 1 + 1] = -0.5;
    pinned[1] = 0;
    const spring_link link = {0, 1, 1, k, 0};
    const spring_scene_def def = {.flags = SPRING_SCENE_TENSION_ONLY | SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                                  .particles = 2 + strangers,
                                  .links = 1,
                                  .position = x,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = &link,
                                  .gravity = {0, -g, 0}};
    spring_scene *s = scene_of(&def);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, t / n, (uint64_t)n) == SPRING_OK, "stable");
    double now[3], speed[3], y, v;
    spring_scene_get(s, SPRING_POSITION, now, 0, 1, 1);
    spring_scene_get(s, SPRING_VELOCITY, speed, 0, 1, 1);
    free(s);
    bounce(t, k, mass, g, &y, &v);
    return hypot(now[1] - y, (speed[1] - v) / 10);
}

/* Where in a step the rope becomes taut changes the error by a factor, so the mean over several times is fitted. */
static void order_across_the_kink(void)
{
    if (sizeof(scalar) == 4) { /* rounding hides the order */
        CHECK_BELOW(bounce_error(400, 0.8, 0), 2e-4, "second order, in float");
        return;
    }
    for (uint32_t strangers = 0; strangers <= 20; strangers += 20) { /* few and many particles */
        double sum = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
        for (int i = 0; i <= 24; i++) {
            const int n = (int)(200 * pow(2, i / 4.0));
            double error = 0;
            for (int j = 0; j < 20; j++)
                error += bounce_error(n, 0.75 + 0.003 * j, strangers) / 20;
            const double x = log(1.0 / n), y = log(error);
            sum++, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
        }
        CHECK_CLOSE((sum * sum_xy - sum_x * sum_y) / (sum * sum_xx - sum_x * sum_x), 2, 0.05, "leapfrog has order 2");
    }
}

/* A rope of 14 m lies over 13.1 m, pinned at one end. Thrown upwards, its other end flies as if there were no links until the
   rope is taut, after 0.3 s. */
static void thrown_rope(void)
{
    enum { n = 40 };
    double x[3 * n] = {0}, v[3 * n] = {0};
    spring_link link[n - 1];
    uint8_t pinned[n] = {1};
    for (uint32_t i = 0; i < n; i++) {
        x[3 * i] = 13.1 / (n - 1) * i;
        v[3 * i + 1] = i == 0 ? 0 : 6;
        if (i > 0)
            link[i - 1] = (spring_link){i - 1, i, 14.0 / (n - 1), 4e4, 0.8};
    }
    const spring_scene_def def = {.flags = SPRING_SCENE_TENSION_ONLY,
                                  .particles = n,
                                  .links = n - 1,
                                  .position = x,
                                  .velocity = v,
                                  .mass_all = 0.05,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, -9.81, 0}};
    spring_scene *s = scene_of(&def);
    const double dt = 1e-4;
    double end[3];
    for (int step = 1; step <= 3000; step++) {
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK, "stable");
        for (size_t i = 0; i < n - 1 && step % 50 == 0; i++)
            CHECK(spring_scene_tension(s, i) >= 0, "no link pushes");
    }
    spring_scene_get(s, SPRING_POSITION, end, 0, n - 1, 1);
    const double t = spring_scene_time(s);
    CHECK_CLOSE(end[0], 13.1, 1e-4, "free flight");
    CHECK_CLOSE(end[1], 6 * t - 9.81 * t * t / 2, sizeof(scalar) == 4 ? 5e-4 : 1e-4,
                "free flight; in float 3000 roundings");
    free(s);
}

/* ---------------------------------------------------------------------------------------------------- the stable step */

/* y = M^-1/2 K M^-1/2 x at the state, K the matrix of second derivatives of the energy of the taut links. */
static void apply_matrix(const model *m, const double *at, const double *x, double *y)
{
    const uint32_t axes = m->def.axes;
    memset(y, 0, m->def.particles * axes * sizeof *y);
    for (size_t i = 0; i < m->def.links; i++) {
        const spring_link *link = &m->link[i];
        const double root_a = 1 / sqrt(m->mass[link->a]), root_b = 1 / sqrt(m->mass[link->b]);
        double delta[3] = {0}, relative[3] = {0}, square = 0, along = 0;
        for (uint32_t a = 0; a < axes; a++) {
            delta[a] = at[link->b * axes + a] - at[link->a * axes + a];
            relative[a] = x[link->b * axes + a] * root_b - x[link->a * axes + a] * root_a;
            square += delta[a] * delta[a];
            along += delta[a] * relative[a];
        }
        const double length = sqrt(square), across = 1 - link->rest / length;
        if (!(length > link->rest))
            continue;
        for (uint32_t a = 0; a < axes; a++) {
            const double parallel = along * delta[a] / square;
            const double force = link->stiffness * (parallel + across * (relative[a] - parallel));
            y[link->b * axes + a] += force * root_b;
            y[link->a * axes + a] -= force * root_a;
        }
    }
}

/* A Rayleigh quotient is at most the largest eigenvalue; power iteration comes close to it. */
static double largest_eigenvalue(const model *m, const double *at)
{
    static double x[3 * most], y[3 * most];
    const size_t count = m->def.particles * m->def.axes;
    double value = 0;
    for (size_t i = 0; i < count; i++)
        x[i] = random_uniform(-1, 1);
    for (int n = 0; n < 60; n++) {
        apply_matrix(m, at, x, y);
        double xy = 0, xx = 0, yy = 0;
        for (size_t i = 0; i < count; i++)
            xy += x[i] * y[i], xx += x[i] * x[i], yy += y[i] * y[i];
        value = xy / xx;
        for (size_t i = 0; i < count && yy > 0; i++)
            x[i] = y[i] / sqrt(yy);
    }
    return value;
}

static void bound_at_any_compression(void)
{
    static model m;
    double closest = 0;
    for (int n = 0; n < 3000; n++) {
        const uint32_t axes = n % 2 == 0 ? 2 : 3;
        build_net(&m, (uint32_t[]){4, 3, axes - 1}, axes, MASSES | (n % 3 == 0 ? OWN : 0));
        const double compressed = random_log(0.01, 3);
        for (size_t i = 0; i < m.def.particles * axes; i++)
            m.position[i] = random_uniform(0, compressed);
        spring_scene *s = scene_of(&m.def);
        const double step = spring_scene_stable_step(s, SPRING_LEAPFROG), limit = 4 / (step * step);
        const double value = largest_eigenvalue(&m, m.position);
        closest = fmax(closest, value / limit);
        CHECK_CLOSE(fmax(value, limit), limit, 100 * EPS * limit, "Gershgorin's bound, to rounding");
        free(s);
    }
    CHECK(closest > 0.5, "the bound is not far away");
}

/* Below the stable step, damping that acts only while a link is taut loses energy. */
static void damped_net_settles(void)
{
    static model m;
    build_net(&m, (uint32_t[]){9, 7, 1}, 3, DAMPED | GRAVITY | DRAG);
    memset(m.pinned, 0, sizeof m.pinned);
    m.pinned[0] = m.pinned[8] = 1;
    memset(m.velocity, 0, sizeof m.velocity);
    m.def.pinned = m.pinned;
    spring_scene *s = scene_of(&m.def);
    const double dt = 0.5 * spring_scene_stable_step(s, SPRING_LEAPFROG);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, (uint64_t)(200 / dt)) == SPRING_OK, "stable");
    CHECK_BELOW(spring_scene_energy(s).kinetic, sizeof(scalar) == 4 ? 1e-6 : 1e-10, "drag lets it come to rest");
    for (size_t i = 0; i < m.def.links; i++)
        CHECK(spring_scene_tension(s, i) >= 0, "no link pushes");
    free(s);
}

/* ------------------------------------------------------------------------------------------------------ the contract */

static void refused(void)
{
    const double x[] = {0, 1, 2, 3, 4, 5};
    spring_scene_def def = {.axes = 1, .flags = SPRING_SCENE_TENSION_ONLY, .particles = 2, .position = x};
    const char *field;
    size_t index = 9;
    CHECK(spring_scene_check(&def, &field, &index) == SPRING_EUNSUPPORTED && strcmp(field, "flags") == 0 && index == 0,
          "one axis");
    def.axes = 2;
    CHECK(spring_scene_check(&def, &field, &index) == SPRING_OK && field == NULL, "two axes");
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        if (!spring_method_describe(m)->positions_only)
            continue;
        def.methods = 1u << m;
        CHECK(spring_scene_check(&def, &field, &index) == SPRING_EUNSUPPORTED && strcmp(field, "methods") == 0,
              "methods that need smooth forces");
    }
    def.methods = 0;
    def.flags = 64;
    CHECK(spring_scene_check(&def, &field, &index) == SPRING_EINVAL && strcmp(field, "flags") == 0, "an unknown flag");
}

/* n steps are n calls, a copy goes on like the original, and a call that fails changes nothing. */
static void calls(void)
{
    static model m;
    for (unsigned features = 0; features < feature_masks; features += 11) {
        build_net(&m, (uint32_t[]){features % 2 ? 5 : 12, 2, 1}, 2 + features % 2, features);
        const method_list all = methods_of(m.def);
        size_t bytes = 0;
        spring_scene_bytes(&m.def, &bytes);
        spring_scene *s = scene_of(&m.def), *single = scene_of(&m.def);
        void *copy = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
        for (const spring_method *method = all.at; *method != no_method; method++) {
            CHECK(spring_scene_advance(s, *method, 1e-3, 6) == SPRING_OK, "stable");
            for (int n = 0; n < 6; n++)
                CHECK(spring_scene_advance(single, *method, 1e-3, 1) == SPRING_OK, "stable");
            CHECK(same_bits(s, single, m.def.particles, m.def.axes), "n steps are n calls");
            memcpy(copy, s, bytes);
            CHECK(spring_scene_advance(s, *method, sizeof(scalar) == 4 ? 1e38 : 1e300, 9) == SPRING_ENONFINITE,
                  "overflows");
            CHECK(same_bits(s, copy, m.def.particles, m.def.axes), "a call that fails changes nothing");
            CHECK(spring_scene_advance(s, *method, 1e-3, 1) == SPRING_OK &&
                      spring_scene_advance(copy, *method, 1e-3, 1) == SPRING_OK &&
                      spring_scene_advance(single, *method, 1e-3, 1) == SPRING_OK,
                  "stable");
            CHECK(same_bits(s, copy, m.def.particles, m.def.axes), "a copy is a snapshot");
            CHECK(same_bits(s, single, m.def.particles, m.def.axes), "as if the call had not been");
        }
        free(copy);
        free(s);
        free(single);
    }
}

int main(void)
{
    static const test tests[] = {
        {"forces against a plain loop, and the same bits with every instruction set", forces_and_bits},
        {"odd links", odd_links},
        {"too far apart", too_far},
        {"tension and energy", tension_and_energy},
        {"order across the kink", order_across_the_kink},
        {"a thrown rope flies freely", thrown_rope},
        {"the stable step holds at any compression", bound_at_any_compression},
        {"a damped net comes to rest", damped_net_settles},
        {"invalid definitions", refused},
        {"calls, copies, failures", calls},
    };
    return RUN_TESTS("scene-tension", tests);
}
