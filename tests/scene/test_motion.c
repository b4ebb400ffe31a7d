/* SPDX-License-Identifier: MIT */
/* The methods compared with textbook steps over a plain loop of links; their orders and conserved quantities. */
#include "harness/iterates.h"

#include "test_scene.h"

/* ------------------------------------------------------------------------------------------------ a plain scene */

static const double push_friction = 0.31, push_spring = 0.2; /* [N s/m], [N] */

/* F(t, x, v) on an axis of a particle; with the promise F(t, x). */
static double push(const model *m, double t, size_t i, uint32_t axis, double x, double v)
{
    const bool rubs = (m->def.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0;
    return 0.8 * sin(1.3 * t + (double)i + axis) - (rubs ? push_friction * v : 0) - push_spring * sin(x);
}

static void push_all(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                     scalar *const force[3])
{
    const model *m = user;
    for (uint32_t a = 0; a < m->def.axes; a++)
        for (size_t i = 0; i < particles; i++)
            force[a][i] += (scalar)push(m, t, i, a, (double)x[a][i], (double)v[a][i]);
}

static double held[3 * most]; /* [N] */

/* Of everything but drag; 0 where pinned. */
static void acceleration(const void *data, double t, const double *x, const double *v, double *a)
{
    const model *m = data;
    const uint32_t axes = m->def.axes;
    memset(a, 0, m->def.particles * axes * sizeof *a);
    plain_forces(&m->def, axes, x, v, a, NULL);
    for (size_t j = 0; j < m->def.particles * axes; j++) {
        a[j] += held[j];
        if (m->def.force != NULL)
            a[j] += push(m, t, j / axes, (uint32_t)(j % axes), x[j], v[j]);
        a[j] = pinned_in(&m->def, j / axes) ? 0 : a[j] / mass_in(&m->def, j / axes) + m->def.gravity[j % axes];
    }
}

/* n steps of a method from t on, as textbooks write it. */
static void plain_steps(const model *m, spring_method method, double t, double h, int n, state *y)
{
    const uint32_t axes = m->def.axes;
    const size_t count = m->def.particles * axes;
    double drag[3 * most], *room = malloc(iterate_room(count) * sizeof *room);
    for (size_t j = 0; j < count; j++)
        drag[j] = pinned_in(&m->def, j / axes) ? 0 : m->def.drag / mass_in(&m->def, j / axes);
    const bool promised = (m->def.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) != 0;
    iterate_scene s = {count, acceleration, m, drag, room, .changes = m->def.force != NULL && !promised};
    for (; s.step < (uint64_t)n; s.step++)
        iterate_of(method)->scene(&s, t + (double)s.step * h, h, y->x, y->v);
    free(room);
}

/* -------------------------------------------------------------------------------------- against the definitions */

/* Rounding errors in n steps of h: those of a step, in position times omega and in velocity, n times, each growing no
   faster than exp(lipschitz t). */
typedef struct rounding {
    double lipschitz; /* [1/s] of the equations of motion for omega x and v */
    double omega;     /* [1/s] */
    double velocity;  /* [m/s] error of a step */
    double position;  /* [m] */
} rounding;

static rounding rounding_of(const model *m, spring_scene *s, double h)
{
    static double force[3 * most], size[most];
    static state y;
    const uint32_t axes = m->def.axes;
    memset(size, 0, sizeof size);
    get_state(s, m->def.particles, &y);
    plain_forces(&m->def, axes, y.x, y.v, force, size);
    double largest = 0, far = 1, fast = 20; /* [m/s] no particle gets faster */
    for (size_t i = 0; i < m->def.particles; i++)
        largest = fmax(largest, size[i] / mass_in(&m->def, i));
    for (size_t j = 0; j < m->def.particles * axes; j++) {
        far = fmax(far, fabs(y.x[j]));
        fast = fmax(fast, fabs(y.v[j]));
    }
    const double rate =
        2.61 / spring_scene_stable_step(s, SPRING_RK4) + 1; /* frequency or damping; 1 for the callback */
    const double links = (double)m->def.links;
    return (rounding){
        .lipschitz = 2 * rate,
        .omega = rate,
        .velocity = (h * (20 + links) * (2 * largest + 20) + 8 * fast) * EPS, /* forces at most double; 20 m/s^2 else */
        .position = (4 * far + 4 * h * fast) * EPS,
    };
}

static void check_iterate(const model *m, spring_method method)
{
    const int n = 12;
    static state got, want;
    spring_scene *s = scene_of(&m->def);
    const double h = 1.0 / (double)(float)(6 * (rounding_of(m, s, 0).omega)); /* lipschitz n h = 4 */
    const double dt = (double)(scalar)h;
    const rounding r = rounding_of(m, s, dt);
    get_state(s, m->def.particles, &want);
    CHECK(!(m->def.flags & SPRING_SCENE_FORCES) ||
              spring_scene_set(s, SPRING_FORCE, held, 0, 0, m->def.particles) == SPRING_OK,
          "room for held forces");
    CHECK(spring_scene_advance(s, method, dt, (uint64_t)n) == SPRING_OK, "a few small steps");
    plain_steps(m, method, 0, dt, n, &want);
    get_state(s, m->def.particles, &got);
    const double bound = n * (r.velocity + r.omega * r.position) * exp(r.lipschitz * n * dt);
    for (size_t j = 0; j < m->def.particles * m->def.axes; j++) {
        CHECK_CLOSE(got.x[j], want.x[j], bound / r.omega, "the roundings of each step, grown");
        CHECK_CLOSE(got.v[j], want.v[j], bound, "the roundings of each step, grown");
    }
    free(s);
}

static void against_definitions(void)
{
    static model m;
    static const uint32_t grids[][3] = {{4, 1, 1}, {4, 3, 1}, {3, 2, 2}, {23, 1, 1}};
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < EDITABLE; features++) {
            build(&m, grids[features % 4 == 1 && features % 3 > 0 ? 3 : features % 3], axes, features);
            if (features % 4 == 1)
                add_further_links(&m, (features & DAMPED) != 0);
            m.def.force = features % 5 < 3 ? push_all : NULL;
            m.def.user = &m;
            if (features % 5 == 2)
                m.def.flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY;
            for (size_t i = 0; i < m.def.particles * axes; i++)
                held[i] = features % 2 ? (double)(scalar)random_uniform(-5, 5) : 0;
            m.def.flags |= features % 2 ? SPRING_SCENE_FORCES : 0;
            const method_list all = use_all_methods(&m.def);
            for (const spring_method *method = all.at; *method != no_method; method++)
                check_iterate(&m, *method);
        }
    memset(held, 0, sizeof held);
}

/* -------------------------------------------------------------------------------------------- what is conserved */

/* Free particles of their own masses. */
static void build_free(model *m, unsigned features)
{
    build(m, (uint32_t[]){5, 4, 2}, 3, OWN | STRAY | MASSES | features);
}

static void check_momentum(const model *m, spring_method method)
{
    const int n = 1000;
    spring_scene *s = scene_of(&m->def);
    const double stable = spring_scene_stable_step(s, method);
    const double dt = 0.1 * (stable > 0 ? stable : spring_scene_stable_step(s, SPRING_LEAPFROG));
    const momenta before = momenta_of(m, s);
    double all = 0, force = 0;
    for (size_t i = 0; i < m->def.particles; i++)
        all += m->mass[i];
    for (size_t i = 0; i < m->def.links; i++)
        force += m->link[i].stiffness * 10 + m->link[i].damping * 20; /* [N] below 10 m, 20 m/s */
    CHECK(spring_scene_advance(s, method, dt, (uint64_t)n) == SPRING_OK, "stable, or short");
    const momenta after = momenta_of(m, s);
    const double speed = 20, links = 40; /* of a particle, no more */
    const double bound = n * EPS * (dt * 2 * force * links + 4 * all * speed);
    const double distance = 10;
    for (int a = 0; a < 3; a++) {
        CHECK_CLOSE(after.linear[a], before.linear[a], bound, "the roundings of forces and of velocities");
        if (spring_method_describe(method)->symplectic)
            CHECK_CLOSE(after.angular[a], before.angular[a], 2 * distance * bound, "the same, at a distance");
    }
    const double turned = fabs(after.angular[2] - before.angular[2]);
    CHECK(method != SPRING_EULER || sizeof(scalar) == 4 || !(turned < 100 * distance * bound),
          "Euler does not conserve it: it shows");
    free(s);
}

static void momentum(void)
{
    static model m;
    for (unsigned features = 0; features <= (SHUFFLED | DAMPED); features += SHUFFLED) {
        build_free(&m, features & (SHUFFLED | DAMPED));
        const method_list all = methods_of(m.def);
        for (const spring_method *method = all.at; *method != no_method; method++)
            check_momentum(&m, *method);
    }
    build_free(&m, DAMPED);
    for (size_t i = 0; i < m.def.links; i++)
        m.link[i].damping *= 300; /* a Chebyshev series */
    check_momentum(&m, SPRING_LEAPFROG);
}

static void reversible(void)
{
    static model m;
    static state before, after;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < EDITABLE; features++) {
            if (features & (DAMPED | DRAG))
                continue;
            build(&m, (uint32_t[]){4, 3, 1}, axes, features);
            spring_scene *s = scene_of(&m.def);
            const int n = 15;
            const double dt = 1 / (rounding_of(&m, s, 0).omega * n);
            const rounding r = rounding_of(&m, s, dt);
            get_state(s, m.def.particles, &before);
            spring_scene_advance(s, SPRING_LEAPFROG, dt, (uint64_t)n);
            spring_scene_advance(s, SPRING_LEAPFROG, -dt, (uint64_t)n);
            get_state(s, m.def.particles, &after);
            const double bound = 2 * n * (r.velocity + r.omega * r.position) * exp(2 * r.lipschitz * n * dt);
            for (size_t j = 0; j < m.def.particles * axes; j++) {
                CHECK_CLOSE(after.x[j], before.x[j], bound / r.omega, "the roundings of each step, grown");
                CHECK_CLOSE(after.v[j], before.v[j], bound, "the roundings of each step, grown");
            }
            free(s);
        }
}

/* ---------------------------------------------------------------------------------------------------------- orders */

#ifndef SPRING_FLOAT

typedef struct error {
    double x, v;
} error;

enum { looks = 8 }; /* at the state, so that an error that passes through zero is not taken for a small one */

static error error_of(const model *m, spring_method method, double duration, int n, const state want[looks])
{
    static state y;
    spring_scene *s = scene_of(&m->def);
    error e = {0, 0};
    for (int look = 0; look < looks; look++) {
        spring_scene_advance(s, method, duration / n, (uint64_t)n / looks);
        get_state(s, m->def.particles, &y);
        for (size_t j = 0; j < m->def.particles * m->def.axes; j++) {
            e.x = hypot(e.x, y.x[j] - want[look].x[j]);
            e.v = hypot(e.v, y.v[j] - want[look].v[j]);
        }
    }
    free(s);
    return e;
}

/* The solution by many more steps of RK4 than any method takes below. */
static void solve(const model *m, double duration, state at[looks])
{
    const int n = 4096 / looks;
    spring_scene *s = scene_of(&m->def);
    get_state(s, m->def.particles, &at[0]);
    free(s);
    for (int look = 0; look < looks; look++) {
        at[look] = at[look > 0 ? look - 1 : 0];
        plain_steps(m, SPRING_RK4, look * duration / looks, duration / looks / n, n, &at[look]);
    }
}

static void check_order(const model *m)
{
    const double duration = 0.3;
    static state want[looks];
    solve(m, duration, want);
    const method_list all = methods_of(m->def);
    for (const spring_method *method = all.at; *method != no_method; method++) {
        const int order = spring_method_describe(*method)->order;
        if (order > 4) /* between rounding and the order is no room with such motions: see test_rkn8.c */
            continue;
        const int steps =
            looks * (1 + 512 / (order * order * order)); /* so that the next order and rounding are small */
        error e[3];
        for (int i = 0; i < 3; i++)
            e[i] = error_of(m, *method, duration, steps << i, want);
        const error slope[] = {{log2(e[0].x / e[1].x), log2(e[0].v / e[1].v)},
                               {log2(e[1].x / e[2].x), log2(e[1].v / e[2].v)}};
        CHECK_CLOSE(2 * slope[1].x - slope[0].x, order, 0.02, "the next order is extrapolated away");
        CHECK_CLOSE(2 * slope[1].v - slope[0].v, order, 0.02, "the next order is extrapolated away");
    }
}

static void orders(void)
{
    static model m;
    static const unsigned features[] = {0, DRAG, DAMPED, DRAG | DAMPED | GRAVITY};
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t f = 0; f < sizeof features / sizeof features[0]; f++)
            for (int pushed = 0; pushed < 2; pushed++) {
                build(&m, (uint32_t[]){2, 2, 1}, axes, features[f] | MASSES | PINNED);
                memcpy(m.pinned, (uint8_t[]){1, 0, 0, 0}, 4); /* one, moving */
                m.def.force = pushed ? push_all : NULL;
                m.def.user = &m;
                use_all_methods(&m.def);
                check_order(&m);
            }
}

#endif

/* The largest energy of a link that rotates, stretched to `ratio` times its rest length, as a multiple of the energy at the
   start. */
static double energy_of_rotation(double ratio, double damping_ratio, double fraction)
{
    const double mass = 1.3, rest = 0.8, stiffness = 170, half = ratio * rest / 2;
    const double spin = sqrt(2 * stiffness / mass * (1 - 1 / ratio)), off = 1e-5;
    const double x[2][2] = {{-half, 0}, {half + off, 0}}, v[2][2] = {{0, -spin * half}, {0, spin * half}};
    const spring_link link = {0, 1, rest, stiffness, damping_ratio * sqrt(2 * stiffness * mass), 0};
    const spring_scene_def def = {
        .axes = 2, .particles = 2, .position = x[0], .velocity = v[0], .mass_all = mass, .links = 1, .link = &link};
    spring_scene *s = scene_of(&def);
    const double dt = fraction * spring_scene_stable_step(s, SPRING_LEAPFROG);
    const spring_scene_energies start = spring_scene_energy(s);
    double largest = 1;
    for (int i = 0; i < 2000; i++) {
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK, "the energy stays finite");
        const spring_scene_energies now = spring_scene_energy(s);
        largest = fmax(largest, (now.kinetic + now.elastic) / (start.kinetic + start.elastic));
    }
    free(s);
    return largest;
}

/* The rule of spring_scene_stable_step() for links that steady rotation stretches: 0.7 of the bound, and 0.9 is too much. */
static void rotation(void)
{
    for (int damped = 0; damped < 2; damped++) {
        const double damping_ratio = damped ? 0.02 : 0;
        for (double ratio = 1.02; ratio < 4; ratio *= 1.1)
            CHECK_BELOW(energy_of_rotation(ratio, damping_ratio, 0.7), 1.2,
                        "it oscillates a little, and does not grow");
        CHECK(energy_of_rotation(1.3, damping_ratio, 0.9) > 5, "the rule is needed");
    }
}

/* A driven particle reaches its target: misses by at most what spring_scene_drive() states, with every method. */
static void driven(void)
{
    static model m;
    static state y;
    double worst = 0; /* as a fraction of the bound */
    for (uint32_t round = 0; round < 2000; round++) {
        const uint32_t axes = 1 + round % 3;
        build(&m, (uint32_t[]){3, 2, 1}, axes, (unsigned)(random_bits() % feature_masks) | PINNED);
        const size_t i = random_bits() % m.def.particles;
        m.pinned[i] = 1;
        const bool heavy = random_bits() % 2;
        for (size_t l = 0; heavy && l < m.def.links; l++)
            m.link[l].damping = random_log(10, 1000);
        const method_list all = use_all_methods(&m.def);
        for (const spring_method *method = all.at; *method != no_method; method++) {
            spring_scene *s = scene_of(&m.def);
            double target[3], start[3];
            const size_t n = 1 + random_bits() % 200;
            const double longest = heavy && *method != SPRING_LEAPFROG ? 1e-4 : 1e-2; /* stable */
            const double dt = (double)(float)random_log(1e-6, longest);               /* n dt is exact */
            spring_scene_get(s, SPRING_POSITION, start, 0, i, 1);
            for (uint32_t a = 0; a < axes; a++)
                target[a] = (double)(scalar)(random_log(1e-3, 1e3) * (random_bits() % 2 ? -1 : 1));
            const bool reached = spring_scene_drive(s, i, target, (double)n * dt) == SPRING_OK &&
                                 spring_scene_advance(s, *method, dt, n) == SPRING_OK;
            CHECK(reached, "it moves");
            spring_scene_get(s, SPRING_POSITION, y.x, 0, i, 1);
            for (uint32_t a = 0; a < axes && reached; a++) {
                const double each = *method == SPRING_SRKN6 ? 6 : heavy && *method == SPRING_LEAPFROG ? 1 : 0.5;
                const double ulp = EPS * exp2(floor(log2(fmax(fabs(start[a]), fabs(target[a])))));
                worst = fmax(worst, fabs(y.x[a] - target[a]) / (ulp * (each * (double)n + 5)));
            }
            free(s);
        }
    }
    CHECK_BELOW(worst, 1, "the bound of spring_scene_drive()");
}

int main(void)
{
    static const test tests[] = {
        {"steady rotation", rotation},
        {"driven particles", driven},
        {"against the definitions", against_definitions},
        {"momentum", momentum},
        {"leapfrog is reversible", reversible},
#ifndef SPRING_FLOAT
        {"orders", orders},
#endif
    };
    return RUN_TESTS("scene_motion", tests);
}
