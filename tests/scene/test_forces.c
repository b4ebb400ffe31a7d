/* SPDX-License-Identifier: MIT */
/* Tension, energies and rest compared with sums over links; laws of perpendicular forces, of slack ropes and of
   drag. test_random.c compares the forces
   of links with a plain loop. */
#include <stdio.h>

#include "test_scene.h"

/* ------------------------------------------------------------------------------------------ tension, energies, rest */

/* A model with held forces, where about half of the links are slack, some ends are at one place, and whose particles have
   these accelerations [m/s^2]. size: what their rounding errors are relative to. */
static spring_scene *build_held(model *m, uint32_t axes, unsigned features, state *y, double *accel, double *size)
{
    static const uint32_t grids[][3] = {{1, 1, 1}, {23, 1, 1}, {2, 9, 1}, {13, 11, 1}, {5, 4, 7}, {17, 2, 3}};
    build(m, grids[features % 6], axes, features);
    m->def.flags |= SPRING_SCENE_FORCES | (axes > 1 && features % 2 ? SPRING_SCENE_TENSION_ONLY : 0);
    for (size_t i = 0; i < m->def.links && (features & OWN) == 0; i++)
        m->link[i].rest = 0.8;
    if (m->def.links > 0)
        m->link[0].rest = -0.0; /* reverses no link */
    if (m->def.particles > 1)
        memcpy(m->position, m->position + axes, axes * sizeof m->position[0]);
    m->def.methods = 1u << SPRING_LEAPFROG;
    spring_scene *s = scene_of(&m->def);
    const size_t n = m->def.particles;
    double held[3 * most];
    for (size_t i = 0; i < n * axes; i++)
        held[i] = random_uniform(-3, 3);
    CHECK(spring_scene_set(s, SPRING_FORCE, held, 0, 0, n) == SPRING_OK, "room for held forces");
    get_state(s, n, y);
    memcpy(accel, held, n * axes * sizeof *accel);
    memset(size, 0, n * sizeof *size);
    plain_forces(&m->def, axes, y->x, y->v, accel, size);
    for (size_t i = 0; i < n * axes; i++) {
        accel[i] = (accel[i] - m->def.drag * y->v[i]) / mass_in(&m->def, i / axes) + m->def.gravity[i % axes];
        accel[i] = pinned_in(&m->def, i / axes) ? 0 : accel[i];
    }
    return s;
}

static double largest_norm(const double *numbers, const model *m)
{
    double largest = 0;
    for (size_t i = 0; i < m->def.particles; i++) {
        double norm = 0;
        for (size_t a = 0; a < m->def.axes; a++)
            norm = hypot(norm, numbers[i * m->def.axes + a]);
        largest = fmax(largest, norm);
    }
    return largest;
}

static void check_rest(spring_scene *s, const model *m, const state *y, const double *accel, const double *size)
{
    double rounding = 0;
    for (size_t i = 0; i < m->def.particles; i++)
        rounding = fmax(rounding, (20 + (double)m->def.links) * EPS * (20 + size[i] / mass_in(&m->def, i)));
    const double v = largest_norm(y->v, m), a = largest_norm(accel, m);
    CHECK(spring_scene_at_rest(s, v * (1 + 8 * EPS), a + rounding), "the speed and acceleration that there are");
    CHECK(!spring_scene_at_rest(s, v * (1 - 8 * EPS), INFINITY), "a speed is larger, also of a pinned particle");
    CHECK(!(a > 2 * rounding) || !spring_scene_at_rest(s, INFINITY, a - rounding), "an acceleration is larger");
    CHECK(!spring_scene_at_rest(NULL, 1, 1) && !spring_scene_at_rest(s, -1, INFINITY) &&
              !spring_scene_at_rest(s, INFINITY, NAN),
          "bad input");
}

static void tension_energies_and_rest(void)
{
    static model m;
    static state y;
    static double accel[3 * most], sizes[most];
    size_t slack = 0, pulled_in = 0;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 5) {
            spring_scene *s = build_held(&m, axes, features, &y, accel, sizes);
            const bool tension_only = (m.def.flags & SPRING_SCENE_TENSION_ONLY) != 0;
            check_rest(s, &m, &y, accel, sizes);
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
                const double extension = f.length - (double)(scalar)link->rest, length = fabs(f.length) + link->rest;
                const bool pulls = !tension_only || link->rest == 0 || (extension > 0 && f.tension > 0);
                elastic += tension_only && extension <= 0 ? 0 : link->stiffness * extension * extension / 2;
                all += link->stiffness * length * length / 2;
                CHECK_CLOSE(spring_scene_tension(s, i), pulls ? f.tension : 0,
                            8 * EPS * (link->stiffness * length + 2 * link->damping),
                            "eight roundings, velocities below 1");
                slack += tension_only && extension <= 0;
                pulled_in += tension_only && extension > 0 && f.tension <= 0;
            }
            const spring_scene_energies e = spring_scene_energy(s);
            const double sums = (double)(m.def.particles + m.def.links) * DBL_EPSILON;
            CHECK_CLOSE(e.kinetic, kinetic, (8 * EPS + sums) * kinetic, "eight roundings and the sum's");
            CHECK_CLOSE(e.gravity, gravity, (8 * EPS + sums) * heights, "eight roundings and the sum's");
            CHECK_CLOSE(e.elastic, elastic, (8 * EPS + sums) * all, "eight roundings and the sum's");
            free(s);
        }
    CHECK(slack > 1000 && pulled_in > 10, "slack links, and damping that would push");
}

/* Infinite distances are noticed as with other links, and not taken for slack. */
static void too_far(void)
{
    const double far = sizeof(scalar) == 4 ? 3e38 : 1.7e308, x[] = {-far, 0, far, 0, 0, 1}, v[6] = {0};
    for (uint32_t flags = 0; flags <= SPRING_SCENE_TENSION_ONLY; flags += SPRING_SCENE_TENSION_ONLY)
        for (int damped = 0; damped < 2; damped++) {
            const spring_link link = {0, 1, 0.7, 3, damped, 0};
            const spring_scene_def def = {
                .axes = 2, .flags = flags, .particles = 3, .links = 1, .position = x, .velocity = v, .link = &link};
            spring_scene *s = scene_of(&def);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 1) == SPRING_ENONFINITE, "an infinite force");
            free(s);
        }
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
    const spring_link link = {0, 1, 0, mass * omega * omega, 0, 0};
    spring_scene_def def = joined(2, 2, x, v, omega > 0, &link);
    def.methods = 1u << m, def.mass_all = mass, def.pinned = pinned, def.force = magnetic, def.user = &rate;
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
    spring_scene_def def = joined(3, n, x, NULL, n - 1, link);
    def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, def.mass_all = mass, def.pinned = pinned, def.gravity[1] = -9.81;
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

/* A sheet that hangs at rest in single precision. Each step rounds positions by u/sqrt(12), where u is the spacing of floats
   there, which adds omega^2 u^2/12 to the mean square of the speed of a mode; damping with the rate g removes g dt of it. So
   the mean square of the speed is omega^2 u^2/(24 g dt) along each axis. The largest of all particles and frames is up to 5
   times its root, which is the rule of docs/games.md: omega u/sqrt(g dt). With heavy link damping, the exponential kick
   rounds further terms, and the rule has a factor of 5. */
static void rest_of_cloth(void)
{
    enum { w = 9, h = 12, n = w * h, frames = 120 };
    for (int i = 0; i < 24 && sizeof(scalar) == 4; i++) {
        const double k = random_log(50, 5000), mass = random_log(1e-3, 0.1), spacing = random_log(0.02, 0.2);
        const bool heavy = i % 4 == 3;
        const double drag_rate = random_log(0.3, 3); /* [1/s] */
        const double ratio = heavy ? random_log(0.1, 0.5) : i % 2 ? random_log(1e-3, 0.01) : 0;
        const double offset = i % 3 ? random_log(0.1, 100) : 0, damping = ratio * sqrt(2 * k * mass);
        const spring_grid sheet = {.count = {w, h},
                                   .spacing = spacing,
                                   .stiffness = k,
                                   .damping = damping,
                                   .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                                   .pinned = SPRING_GRID_FIRST_Y};
        double x[3 * n], farthest = 0;
        uint8_t pinned[n];
        spring_link link[4 * n];
        size_t particles, links;
        CHECK(spring_grid_size(&sheet, &particles, &links) == SPRING_OK, "a sheet");
        spring_grid_fill(&sheet, x, pinned, link);
        for (int a = 0; a < 3 * n; a++)
            x[a] += offset;
        spring_scene_def def = joined(3, n, x, NULL, links, link);
        def.mass_all = mass, def.pinned = pinned, def.gravity[1] = 9.81, def.drag = drag_rate * mass;
        spring_scene *s = scene_of(&def);
        const double dt = random_uniform(0.4, 0.9) * spring_scene_stable_step(s, SPRING_LEAPFROG);
        const double omega = 2 / spring_scene_stable_step(s, SPRING_LEAPFROG);
        const double rate = drag_rate + damping / k * omega * omega;
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, (uint64_t)(30 / drag_rate / dt)) == SPRING_OK, "stable");
        spring_scene_get(s, SPRING_POSITION, x, 0, 0, n);
        for (int a = 0; a < 3 * n; a++)
            farthest = fmax(farthest, fabs(x[a]));
        int exponent, at_rest = 0, quieter = 0;
        (void)frexp(farthest, &exponent);
        const double v = (heavy ? 5 : 1) * omega * ldexp(EPS, exponent - 1) / sqrt(rate * dt);
        for (int frame = 0; frame < frames; frame++) {
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, (uint64_t)ceil(1 / (60 * dt))) == SPRING_OK, "stable");
            at_rest += spring_scene_at_rest(s, v, omega * v);
            quieter += spring_scene_at_rest(s, v / 20, INFINITY);
        }
        printf("# stiffness %.0f N/m, mass %.4f kg, drag/mass %.2f/s, damping ratio %.4f, farthest %.3g m: tolerances "
               "%.2g m/s, "
               "%.2g m/s^2\n",
               k, mass, drag_rate, ratio, farthest, v, omega * v);
        CHECK(at_rest == frames, "the largest of 324 speeds and 120 frames is below 5 standard deviations");
        CHECK(heavy || quieter == 0,
              "the largest is not below a quarter of the standard deviation of the fastest modes");
        free(s);
    }
}

/* ---------------------------------------------------------------------------------- a rope that becomes taut, and drag */

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
    const spring_link link = {0, 1, 1, k, 0, 0};
    spring_scene_def def = joined(3, 2 + strangers, x, NULL, 1, &link);
    def.flags = SPRING_SCENE_TENSION_ONLY | SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    def.mass_all = mass, def.pinned = pinned, def.gravity[1] = -g;
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

int main(void)
{
    static const test tests[] = {
        {"tension, energies and rest", tension_energies_and_rest},
        {"too far apart", too_far},
        {"a force perpendicular to the velocity", perpendicular_force},
        {"order where a rope becomes taut", order_across_the_kink},
        {"drag without bias", drag_without_bias},
        {"rest far from the origin", rest_far_from_the_origin},
        {"rest of cloth in single precision", rest_of_cloth},
    };
    return RUN_TESTS("scene_forces", tests);
}
