/* SPDX-License-Identifier: MIT */
/* The methods: against plain loops from their definitions, against normal modes, their orders, what they conserve. */
#include "test_scene.h"

/* ------------------------------------------------------------------------------------------- definitions, once more */

static const double push_friction = 0.31, push_spring = 0.2; /* [N s/m], [N] */

/* F(t, x, v) on an axis of a particle. */
static double push(double t, size_t i, uint32_t axis, double x, double v)
{
    return 0.8 * sin(1.3 * t + (double)i + axis) - push_friction * v - push_spring * sin(x);
}

static void push_all(void *user, double t, size_t particles, const scalar *const x[3],
                     const scalar *const v[3], scalar *const force[3])
{
    const model *m = user;
    for (uint32_t a = 0; a < m->def.axes; a++)
        for (size_t i = 0; i < particles; i++)
            force[a][i] += (scalar)push(t, i, a, (double)x[a][i], (double)v[a][i]);
}

typedef struct vector {
    double at[3 * most];
} vector;

/* Of everything but drag; 0 where pinned. */
static vector acceleration(const model *m, double t, const vector *x, const vector *v)
{
    const uint32_t axes = m->def.axes;
    vector f = {{0}};
    plain_forces(&m->def, axes, x->at, v->at, f.at, NULL);
    for (size_t i = 0; i < m->def.particles; i++)
        for (uint32_t a = 0; a < axes; a++) {
            const size_t j = i * axes + a;
            if (m->def.force != NULL)
                f.at[j] += push(t, i, a, x->at[j], v->at[j]);
            f.at[j] = pinned_in(&m->def, i) ? 0 : f.at[j] / mass_in(&m->def, i) + m->def.gravity[a];
        }
    return f;
}

static double drag_of(const model *m, size_t j)
{
    const size_t i = j / m->def.axes;
    return pinned_in(&m->def, i) ? 0 : m->def.drag / mass_in(&m->def, i);
}

static vector with_drag(const model *m, double t, const vector *x, const vector *v)
{
    vector a = acceleration(m, t, x, v);
    for (size_t j = 0; j < m->def.particles * m->def.axes; j++)
        a.at[j] -= drag_of(m, j) * v->at[j];
    return a;
}

static vector sum(const model *m, const vector *y, double h, const vector *d)
{
    vector r = *y;
    for (size_t j = 0; j < m->def.particles * m->def.axes; j++)
        r.at[j] += h * d->at[j];
    return r;
}

static void plain_euler(const model *m, double t, double h, vector *x, vector *v)
{
    const vector a = with_drag(m, t, x, v);
    *x = sum(m, x, h, v);
    *v = sum(m, v, h, &a);
}

static vector last_kick(const model *m, double h, const vector *v, const vector *a)
{
    vector r = sum(m, v, h / 2, a);
    for (size_t j = 0; j < m->def.particles * m->def.axes; j++)
        r.at[j] /= 1 + h / 2 * drag_of(m, j);
    return r;
}

static void plain_leapfrog(const model *m, double t, double h, vector *x, vector *v)
{
    vector a = with_drag(m, t, x, v);
    const vector half = sum(m, v, h / 2, &a);
    *x = sum(m, x, h, &half);
    a = acceleration(m, t + h, x, &half);
    const vector predicted = last_kick(m, h, &half, &a);
    a = acceleration(m, t + h, x, &predicted);
    *v = last_kick(m, h, &half, &a);
}

/* What RK4 adds in a step. */
static void rk4_increments(const model *m, double t, double h, const vector *x, const vector *v, vector *dx,
                           vector *dv)
{
    const vector a1 = with_drag(m, t, x, v);
    const vector x2 = sum(m, x, h / 2, v), v2 = sum(m, v, h / 2, &a1);
    const vector a2 = with_drag(m, t + h / 2, &x2, &v2);
    const vector x3 = sum(m, x, h / 2, &v2), v3 = sum(m, v, h / 2, &a2);
    const vector a3 = with_drag(m, t + h / 2, &x3, &v3);
    const vector x4 = sum(m, x, h, &v3), v4 = sum(m, v, h, &a3);
    const vector a4 = with_drag(m, t + h, &x4, &v4);
    for (size_t j = 0; j < m->def.particles * m->def.axes; j++) {
        dx->at[j] = h / 6 * (v->at[j] + 2 * v2.at[j] + 2 * v3.at[j] + v4.at[j]);
        dv->at[j] = h / 6 * (a1.at[j] + 2 * a2.at[j] + 2 * a3.at[j] + a4.at[j]);
    }
}

static void plain_rk4(const model *m, double t, double h, vector *x, vector *v)
{
    vector dx, dv;
    rk4_increments(m, t, h, x, v, &dx, &dv);
    *x = sum(m, x, 1, &dx);
    *v = sum(m, v, 1, &dv);
}

static void (*const plain_step[])(const model *, double, double, vector *,
                                  vector *) = {plain_euler, plain_leapfrog, plain_rk4};

static void start(const spring_scene *s, const model *m, vector *x, vector *v)
{
    spring_scene_get(s, SPRING_POSITION, x->at, 0, 0, m->def.particles);
    spring_scene_get(s, SPRING_VELOCITY, v->at, 0, 0, m->def.particles);
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
    static vector x, v;
    const uint32_t axes = m->def.axes;
    memset(size, 0, sizeof size);
    start(s, m, &x, &v);
    plain_forces(&m->def, axes, x.at, v.at, force, size);
    double largest = 0, far = 1, fast = 20; /* [m/s] no particle gets faster */
    for (size_t i = 0; i < m->def.particles; i++)
        largest = fmax(largest, size[i] / mass_in(&m->def, i));
    for (size_t j = 0; j < m->def.particles * axes; j++) {
        far = fmax(far, fabs(x.at[j]));
        fast = fmax(fast, fabs(v.at[j]));
    }
    const double rate =
        2.61 / spring_scene_stable_step(s, SPRING_RK4) + 1; /* frequency or damping; 1 for the callback */
    const double links = (double)m->def.links;
    return (rounding){
        .lipschitz = 2 * rate,
        .omega = rate,
        .velocity = (h * (20 + links) * (2 * largest + 20) + 8 * fast) *
                    EPS, /* forces at most double; 20 m/s^2 else */
        .position = (4 * far + 4 * h * fast) * EPS,
    };
}

static void check_iterate(model *m, spring_method method)
{
    const int n = 12;
    vector x, v;
    static state y;
    m->def.user = m;
    spring_scene *s = scene_of(&m->def);
    const double h = 1.0 / (double)(float)(6 * (rounding_of(m, s, 0).omega)); /* lipschitz n h = 4 */
    const double dt = (double)(scalar)h;
    const rounding r = rounding_of(m, s, dt);
    start(s, m, &x, &v);
    CHECK(spring_scene_advance(s, method, dt, (uint64_t)n) == SPRING_OK, "a few small steps");
    for (int i = 0; i < n; i++)
        plain_step[method](m, i * dt, dt, &x, &v);
    get_state(s, m->def.particles, &y);
    const double bound = n * (r.velocity + r.omega * r.position) * exp(r.lipschitz * n * dt);
    for (size_t j = 0; j < m->def.particles * m->def.axes; j++) {
        CHECK_CLOSE(y.x[j], x.at[j], bound / r.omega, "the roundings of each step, grown");
        CHECK_CLOSE(y.v[j], v.at[j], bound, "the roundings of each step, grown");
    }
    free(s);
}

static void against_definitions(void)
{
    static model m;
    static const uint32_t grids[][3] = {{4, 1, 1}, {4, 3, 1}, {3, 2, 2}};
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < EDITABLE; features++)
            for (int method = SPRING_EULER; method <= SPRING_RK4; method++) {
                build(&m, grids[features % 3], axes, features);
                m.def.force = features % 5 < 2 ? push_all : NULL;
                check_iterate(&m, (spring_method)method);
            }
}

/* ------------------------------------------------------------------------------------------------------- normal modes */

typedef struct mode {
    double omega2; /* [1/s^2] */
    double drag;   /* [1/s] solved for in leapfrog's last half kick */
    double gamma;  /* [1/s] of links and callback: predicted */
} mode;

typedef struct pair {
    double x, v;
} pair;

static pair rate_of(const mode *q, pair y)
{
    return (pair){y.v, -q->omega2 * y.x - (q->drag + q->gamma) * y.v};
}

static pair mode_step(const mode *q, spring_method method, double h, pair y)
{
    if (method == SPRING_EULER) {
        const pair d = rate_of(q, y);
        return (pair){y.x + h * d.x, y.v + h * d.v};
    }
    if (method == SPRING_RK4) { /* the series of exp(h A) to h^4, by Horner's rule */
        pair p = y;
        for (int k = 4; k > 0; k--) {
            const pair d = rate_of(q, p);
            p = (pair){y.x + h / k * d.x, y.v + h / k * d.v};
        }
        return p;
    }
    const double half = y.v + h / 2 * rate_of(q, y).v, x = y.x + h * half, solve = 1 + h / 2 * q->drag;
    const double predicted = (half - h / 2 * (q->omega2 * x + q->gamma * half)) / solve;
    return (pair){x, (half - h / 2 * (q->omega2 * x + q->gamma * predicted)) / solve};
}

/* n steps without damping, in closed form. */
static pair closed_iterate(double omega, spring_method method, double h, int n, pair y)
{
    const double z = omega * h;
    if (method == SPRING_LEAPFROG) {
        const double theta = 2 * asin(z / 2), s = sqrt(1 - z * z / 4);
        return (pair){cos(n * theta) * y.x + sin(n * theta) * y.v / (omega * s),
                      -omega * s * sin(n * theta) * y.x + cos(n * theta) * y.v};
    }
    const bool euler = method == SPRING_EULER; /* x - i v/omega is multiplied by R(iz) in every step */
    const double along = euler ? 1 : 1 - z * z / 2 + z * z * z * z / 24,
                 across = euler ? z : z - z * z * z / 6;
    const double grow = pow(hypot(along, across), n), angle = n * atan2(across, along);
    return (pair){grow * (cos(angle) * y.x + sin(angle) * y.v / omega),
                  grow * (-omega * sin(angle) * y.x + cos(angle) * y.v)};
}

static const double stiffness = 31.7, damping = 0.23, mass = 1.9, drag = 0.41, friction = 0.37,
                    pi = 3.14159265358979323846;

static void rub(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                scalar *const force[3])
{
    (void)user, (void)t, (void)x;
    for (size_t i = 0; i < particles; i++)
        force[0][i] -= (scalar)friction * v[0][i];
}

enum { LINK_DAMPING = 1, WITH_DRAG = 2, RUBBING = 4 };

/* A rope or height field of nx times ny particles on one axis with pinned edges, in mode (j, k) with amplitudes in position
   and velocity, for n steps, against the steps of one oscillator. */
static void check_mode(uint32_t nx, uint32_t ny, int j, int k, spring_method method, unsigned how)
{
    static double position[most], velocity[most], shape[most];
    static uint8_t pinned[most];
    static spring_link link[most_links];
    static state y;
    const bool rope = ny == 1;
    const spring_grid g = {
        .count = {nx, ny},
        .axes = 1,
        .height = !rope,
        .spacing = rope ? 0.35 : 1,
        .stretch = 1.2,
        .stiffness = stiffness,
        .damping = how & LINK_DAMPING ? damping : 0,
        .pinned = rope ? SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X : 15,
    };
    const pair first = {0.11, -0.23};
    size_t particles, links;
    spring_grid_size(&g, &particles, &links);
    spring_grid_fill(&g, position, pinned, link);
    const double alpha = j * pi / (nx - 1), beta = rope ? pi / 2 : k * pi / (ny - 1);
    double far = 0;
    for (uint32_t i = 0; i < particles; i++) {
        shape[i] = pinned[i] ? 0 : sin(alpha * (i % nx)) * (rope ? 1 : sin(beta * (i / nx)));
        far = fmax(far, fabs(position[i]));
        position[i] += first.x * shape[i];
        velocity[i] = first.v * shape[i];
    }
    const double curvature = 4 * pow(sin(alpha / 2), 2) + (rope ? 0 : 4 * pow(sin(beta / 2), 2));
    const mode q = {
        .omega2 = stiffness / mass * curvature,
        .drag = how & WITH_DRAG ? drag / mass : 0,
        .gamma =
            (how & LINK_DAMPING ? damping / mass * curvature : 0) + (how & RUBBING ? friction / mass : 0),
    };
    const spring_scene_def def = {.axes = 1,
                                  .methods = all_methods,
                                  .particles = particles,
                                  .links = links,
                                  .position = position,
                                  .velocity = velocity,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = link,
                                  .drag = how & WITH_DRAG ? drag : 0,
                                  .force = how & RUBBING ? rub : NULL};
    spring_scene *s = scene_of(&def);
    const double omega = sqrt(q.omega2), fastest = sqrt(stiffness / mass * (rope ? 4 : 8)),
                 h = (method == SPRING_EULER ? 0.05 : 0.6) / fastest;
    const double dt = (double)(scalar)h;
    static double rest[most];
    for (uint32_t i = 0; i < particles; i++)
        rest[i] = rope ? i * g.spacing : 0;
    const int n = 150;
    CHECK(spring_scene_advance(s, method, dt, (uint64_t)n) == SPRING_OK, "stable");
    get_state(s, particles, &y);
    pair want = first;
    for (int i = 0; i < n; i++)
        want = mode_step(&q, method, dt, want);
    if (how == 0) {
        const pair closed = closed_iterate(omega, method, dt, n, first);
        CHECK_CLOSE(closed.x, want.x, 4 * n * DBL_EPSILON, "some roundings of numbers below 1 in each step");
        CHECK_CLOSE(closed.v, want.v, 4 * n * DBL_EPSILON * fmax(1, omega), "some roundings in each step");
        want = closed;
    }
    /* Roundings of a step, all particles together; those of the slowest mode act for the whole time. */
    const double z = fastest * dt, speed = fabs(first.v) + fastest * fabs(first.x),
                 reach = far + speed * dt + 0.5;
    const double all = sqrt((double)particles);
    const double in_x = EPS * reach * all, in_v = 6 * EPS * (speed + dt * 4 * stiffness / mass * 2) * all;
    const double grow = method == SPRING_EULER ? pow(1 + z * z, n / 2.0) : 1 / sqrt(1 - z * z / 4);
    for (size_t i = 0; i < particles; i++) {
        CHECK_CLOSE(y.x[i] - rest[i], want.x * shape[i], n * (in_x + in_v * n * dt) * grow,
                    "the roundings of each step");
        CHECK_CLOSE(y.v[i], want.v * shape[i], n * (in_v + fastest * in_x) * grow,
                    "the roundings of each step");
    }
    free(s);
}

static void normal_modes(void)
{
    for (int method = SPRING_EULER; method <= SPRING_RK4; method++)
        for (unsigned how = 0; how < 8; how++) {
            for (int j = 1; j < 11; j += 3)
                check_mode(12, 1, j, 0, (spring_method)method, how);
            for (int j = 1; j < 7; j += 2)
                for (int k = 1; k < 6; k += 2)
                    check_mode(8, 7, j, k, (spring_method)method, how);
        }
}

/* -------------------------------------------------------------------------------------------- what is conserved */

/* Free particles of their own masses. */
static void build_free(model *m, unsigned features)
{
    build(m, (uint32_t[]){5, 4, 2}, 3, OWN | STRAY | MASSES | features);
}

typedef struct momenta {
    double linear[3], angular[3];
} momenta;

static momenta momenta_of(const model *m, const spring_scene *s)
{
    static state y;
    momenta p = {{0}, {0}};
    get_state(s, m->def.particles, &y);
    for (size_t i = 0; i < m->def.particles; i++)
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            const double *x = &y.x[3 * i], *v = &y.v[3 * i];
            const double kg = 1 / (double)(scalar)(1 / m->mass[i]); /* as it acts */
            p.linear[a] += kg * v[a];
            p.angular[a] += kg * (x[b] * v[c] - x[c] * v[b]);
        }
    return p;
}

static void momentum(void)
{
    static model m;
    const int n = 1000;
    for (unsigned features = 0; features <= (SHUFFLED | DAMPED); features += SHUFFLED)
        for (int method = SPRING_EULER; method <= SPRING_RK4; method++) {
            build_free(&m, features & (SHUFFLED | DAMPED));
            spring_scene *s = scene_of(&m.def);
            const double dt = 0.1 * spring_scene_stable_step(
                                        s, method == SPRING_EULER ? SPRING_LEAPFROG : (spring_method)method);
            const momenta before = momenta_of(&m, s);
            double all = 0, force = 0;
            for (size_t i = 0; i < m.def.particles; i++)
                all += m.mass[i];
            for (size_t i = 0; i < m.def.links; i++)
                force += m.link[i].stiffness * 10 + m.link[i].damping * 20; /* [N] below 10 m, 20 m/s */
            CHECK(spring_scene_advance(s, (spring_method)method, dt, (uint64_t)n) == SPRING_OK,
                  "stable, or short");
            const momenta after = momenta_of(&m, s);
            const double speed = 20, links = 40; /* of a particle, no more */
            const double bound = n * EPS * (dt * 2 * force * links + 4 * all * speed);
            const double distance = 10;
            for (int a = 0; a < 3; a++) {
                CHECK_CLOSE(after.linear[a], before.linear[a], bound,
                            "the roundings of forces and of velocities");
                if (method == SPRING_LEAPFROG)
                    CHECK_CLOSE(after.angular[a], before.angular[a], 2 * distance * bound,
                                "the same, at a distance");
            }
            const double turned = fabs(after.angular[2] - before.angular[2]);
            CHECK(method != SPRING_EULER || sizeof(scalar) == 4 || !(turned < 100 * distance * bound),
                  "Euler does not conserve it: it shows");
            free(s);
        }
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

static const int order_of[] = {[SPRING_EULER] = 1, [SPRING_LEAPFROG] = 2, [SPRING_RK4] = 4};

typedef struct error {
    double x, v;
} error;

enum { looks = 8 }; /* at the state, so that an error that passes through zero is not taken for a small one */

static error error_of(const model *m, spring_method method, double duration, int n, const vector x[looks],
                      const vector v[looks])
{
    static state y;
    spring_scene *s = scene_of(&m->def);
    error e = {0, 0};
    for (int look = 0; look < looks; look++) {
        spring_scene_advance(s, method, duration / n, (uint64_t)n / looks);
        get_state(s, m->def.particles, &y);
        for (size_t j = 0; j < m->def.particles * m->def.axes; j++) {
            e.x = hypot(e.x, y.x[j] - x[look].at[j]);
            e.v = hypot(e.v, y.v[j] - v[look].at[j]);
        }
    }
    free(s);
    return e;
}

/* Adds with the rounding error kept, so that many steps round no more than one. */
static void add_compensated(size_t count, vector *total, vector *lost, const vector *more)
{
    for (size_t j = 0; j < count; j++) {
        const double all = total->at[j] + (more->at[j] + lost->at[j]);
        lost->at[j] += more->at[j] - (all - total->at[j]);
        total->at[j] = all;
    }
}

static void check_order(const model *m)
{
    const double duration = 0.3;
    const int steps[] = {[SPRING_EULER] = 4000, [SPRING_LEAPFROG] = 400, [SPRING_RK4] = 64};
    const int reference = 8192, between = reference / looks;
    static vector x[looks], v[looks];
    vector x_now, v_now, x_lost = {{0}}, v_lost = {{0}};
    spring_scene *s = scene_of(&m->def);
    start(s, m, &x_now, &v_now);
    free(s);
    for (int i = 0; i < reference; i++) {
        vector dx, dv;
        rk4_increments(m, i * duration / reference, duration / reference, &x_now, &v_now, &dx, &dv);
        add_compensated(m->def.particles * m->def.axes, &x_now, &x_lost, &dx);
        add_compensated(m->def.particles * m->def.axes, &v_now, &v_lost, &dv);
        if ((i + 1) % between == 0) {
            x[i / between] = x_now;
            v[i / between] = v_now;
        }
    }
    for (int method = SPRING_EULER; method <= SPRING_RK4; method++) {
        error e[3];
        for (int i = 0; i < 3; i++)
            e[i] = error_of(m, (spring_method)method, duration, steps[method] << i, x, v);
        const error slope[] = {{log2(e[0].x / e[1].x), log2(e[0].v / e[1].v)},
                               {log2(e[1].x / e[2].x), log2(e[1].v / e[2].v)}};
        CHECK_CLOSE(2 * slope[1].x - slope[0].x, order_of[method], 0.02,
                    "the next order is extrapolated away");
        CHECK_CLOSE(2 * slope[1].v - slope[0].v, order_of[method], 0.02,
                    "the next order is extrapolated away");
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
                check_order(&m);
            }
}

#endif

int main(void)
{
    static const test tests[] = {
        {"against the definitions", against_definitions},
        {"normal modes of ropes and height fields", normal_modes},
        {"momentum", momentum},
        {"leapfrog is reversible", reversible},
#ifndef SPRING_FLOAT
        {"orders", orders},
#endif
    };
    return RUN_TESTS("scene_motion", tests);
}
