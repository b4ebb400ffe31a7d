/* SPDX-License-Identifier: MIT */
/* spring-contacts: contacts of scenes compared with exact solutions and with two schemes of game engines. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "contact/closed_forms.h"
#include "scenes/start.h"

static const double pi = 3.14159265358979323846, g = 9.81; /* [m/s^2] */

/* ------------------------------------------------------------------------------------------------------- schemes */

/*
 * A scene with one collider, simulated by leapfrog with the contacts of the library, or with one of two schemes of game
 * engines. The latter use the same leapfrog without colliders:
 *
 *     projection  After each step, a particle inside is moved to the surface. Its normal velocity is multiplied by
 *                 minus the restitution (or removed, if gravity would cause it within two steps). Friction reduces
 *                 motion and velocity along the surface by at most the coefficient times the change along the normal.
 *     penalty     A damped spring with a period of 8 pi steps pushes particles out. Its damping ratio follows from the
 *                 restitution. Friction is the coefficient times the normal force, proportional to speed below 1 mm/s.
 */
typedef enum contact_scheme { CONTACT_LIBRARY, CONTACT_PROJECTION, CONTACT_PENALTY, contact_schemes } contact_scheme;

static const char *const contact_scheme_names[] = {"library", "projection", "penalty"};

typedef struct trial {
    spring_scene *scene;
    contact_scheme scheme;
    spring_scene_def def;     /* its array of pinned particles must outlive the trial */
    spring_collider collider; /* at time 0 */
    double *before;           /* [particles*3] [m] positions at the start of a step */
    double dt;                /* [s] of all steps */
    double penalty, loss;     /* [1/s^2] stiffness/mass and [1/s] damping/mass of the penalty spring */
} trial;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Gap and normal of a ball. */
static double gap_of_ball(const double centre[3], double radius, const double x[3], double n[3])
{
    for (int a = 0; a < 3; a++)
        n[a] = x[a] - centre[a];
    const double length = sqrt(dot(n, n));
    for (int a = 0; a < 3; a++)
        n[a] = length > 0 ? n[a] / length : a == 1;
    return length - radius;
}

static double gap_of_capsule(const spring_collider *c, const double x[3], double n[3])
{
    const double along[3] = {c->to[0] - c->at[0], c->to[1] - c->at[1], c->to[2] - c->at[2]};
    const double from[3] = {x[0] - c->at[0], x[1] - c->at[1], x[2] - c->at[2]};
    const double fraction = fmin(fmax(dot(from, along) / dot(along, along), 0), 1);
    const double centre[3] = {c->at[0] + fraction * along[0], c->at[1] + fraction * along[1],
                              c->at[2] + fraction * along[2]};
    return gap_of_ball(centre, c->radius, x, n);
}

/* Gap and normal of an axis-aligned box. Inside, the nearest face counts. */
static double gap_of_box(const spring_collider *c, const double x[3], double n[3])
{
    double centre[3], nearest = -INFINITY;
    int face = 0;
    for (int a = 0; a < 3; a++) {
        const double from = x[a] - c->at[a], gap = fabs(from) - c->half[a];
        centre[a] = c->at[a] + fmin(fmax(from, -c->half[a]), c->half[a]);
        if (gap > nearest)
            nearest = gap, face = a;
    }
    if (nearest > 0)
        return gap_of_ball(centre, c->radius, x, n);
    for (int a = 0; a < 3; a++)
        n[a] = a == face ? copysign(1, x[a] - c->at[a]) : 0;
    return nearest - c->radius;
}

/* Returns the distance of a point [m] from the surface of a collider at time 0, < 0 inside, and its normal. */
static double trial_gap(const spring_collider *c, const double x[3], double n[3])
{
    if (c->shape == SPRING_SPHERE)
        return gap_of_ball(c->at, c->radius, x, n);
    if (c->shape == SPRING_CAPSULE)
        return gap_of_capsule(c, x, n);
    if (c->shape == SPRING_BOX)
        return gap_of_box(c, x, n);
    memcpy(n, c->axis[0], 3 * sizeof *n);
    return dot(c->axis[0], x) - dot(c->axis[0], c->at);
}

static double gap_at(const trial *t, double time, const double x[3], double n[3])
{
    double then[3];
    for (int a = 0; a < 3; a++)
        then[a] = x[a] - time * t->collider.velocity[a];
    return trial_gap(&t->collider, then, n) - t->def.particle_radius;
}

/* ---------------------------------------------------------------------------------------------------- projection */

/* Friction: subtracts the component of d along the surface, shortened to the length `most` if it is longer. */
static void rub(const double n[3], double most, const double d[3], double from[3])
{
    const double along = dot(d, n);
    const double part[3] = {d[0] - along * n[0], d[1] - along * n[1], d[2] - along * n[2]};
    const double length = sqrt(dot(part, part)), lost = length > most ? most / length : 1;
    for (int a = 0; a < 3; a++)
        from[a] -= lost * part[a];
}

static void project(const trial *t, double time, const double before[3], double x[3], double v[3])
{
    double n[3], u[3], d[3];
    const double gap = gap_at(t, time, x, n);
    if (gap >= 0)
        return;
    for (int a = 0; a < 3; a++)
        u[a] = v[a] - t->collider.velocity[a], d[a] = x[a] - before[a] - t->dt * t->collider.velocity[a];
    for (int a = 0; a < 3; a++)
        x[a] -= gap * n[a];
    rub(n, -t->collider.friction * gap, d, x);
    const double along = dot(u, n), slow = 2 * t->dt * sqrt(dot(t->def.gravity, t->def.gravity));
    if (along >= 0)
        return;
    const double change = -(1 + (along < -slow ? t->collider.restitution : 0)) * along;
    for (int a = 0; a < 3; a++)
        v[a] += change * n[a];
    rub(n, t->collider.friction * change, u, v);
}

static void project_all(trial *t)
{
    const double time = spring_scene_time(t->scene);
    for (size_t i = 0; i < t->def.particles; i++) {
        double x[3], v[3], old[6];
        if (t->def.pinned != NULL && t->def.pinned[i])
            continue;
        spring_scene_get(t->scene, SPRING_POSITION, x, 0, i, 1);
        spring_scene_get(t->scene, SPRING_VELOCITY, v, 0, i, 1);
        memcpy(old, x, sizeof x), memcpy(old + 3, v, sizeof v);
        project(t, time, &t->before[3 * i], x, v);
        if (memcmp(old, x, sizeof x) != 0)
            spring_scene_set(t->scene, SPRING_POSITION, x, 0, i, 1);
        if (memcmp(old + 3, v, sizeof v) != 0)
            spring_scene_set(t->scene, SPRING_VELOCITY, v, 0, i, 1);
    }
}

/* ------------------------------------------------------------------------------------------------------- penalty */

static void push_out(void *user, double time, size_t particles, const double *const position[3],
                     const double *const velocity[3], double *const force[3])
{
    const trial *t = user;
    const double slow = 1e-3; /* [m/s] below this, friction is proportional to the speed */
    for (size_t i = 0; i < particles; i++) {
        const double x[3] = {position[0][i], position[1][i], position[2][i]};
        double n[3], u[3];
        const double gap = gap_at(t, time, x, n);
        if (gap >= 0)
            continue;
        for (int a = 0; a < 3; a++)
            u[a] = velocity[a][i] - t->collider.velocity[a];
        const double along = dot(u, n), push = t->def.mass_all * fmax(0, -t->penalty * gap - t->loss * along);
        for (int a = 0; a < 3; a++)
            u[a] -= along * n[a];
        const double drag = t->collider.friction * push / fmax(sqrt(dot(u, u)), slow);
        for (int a = 0; a < 3; a++)
            force[a][i] += push * n[a] - drag * u[a];
    }
}

/* ------------------------------------------------------------------------------------------------------- a trial */

/* Exits with a message if out of memory or if the scene is not valid. The trial must not move in memory. */
static void trial_open(trial *t, const spring_scene_def *def, const spring_collider *c, contact_scheme scheme,
                       double dt)
{
    const double bounce = log(fmax(c->restitution, 1e-3)), ratio = -bounce / hypot(pi, bounce);
    *t = (trial){.scheme = scheme, .def = *def, .collider = *c, .dt = dt, .penalty = pow(0.25 / dt, 2)};
    t->loss = 2 * ratio * sqrt(t->penalty);
    spring_scene_def own = *def;
    if (scheme == CONTACT_PENALTY)
        own.force = push_out, own.user = t;
    else
        own.flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    if (scheme == CONTACT_LIBRARY)
        own.colliders = 1;
    t->before = malloc(3 * def->particles * sizeof *t->before);
    t->scene = start_definition(&own, NULL);
    if (t->before == NULL || (scheme == CONTACT_LIBRARY && spring_scene_set_colliders(t->scene, c, 1) != SPRING_OK))
        cli_fail(CLI_FAILED, "no memory for a scene of %zu particles", def->particles);
}

static void trial_close(trial *t)
{
    free(t->before);
    free(t->scene);
}

static void trial_advance(trial *t, uint64_t steps)
{
    const uint64_t some = t->scheme == CONTACT_PROJECTION ? 1 : steps;
    for (uint64_t done = 0; done < steps; done += some) {
        if (t->scheme == CONTACT_PROJECTION)
            spring_scene_get(t->scene, SPRING_POSITION, t->before, 0, 0, t->def.particles);
        if (spring_scene_advance(t->scene, SPRING_LEAPFROG, t->dt, some) != SPRING_OK)
            cli_fail(CLI_FAILED, "a scene with the scheme %s is not finite", contact_scheme_names[t->scheme]);
        if (t->scheme == CONTACT_PROJECTION)
            project_all(t);
    }
}

/* --------------------------------------------------------------------------------------------------------- cases */

static spring_scene_def one_particle(const double x[3], const double v[3], double gravity)
{
    return (spring_scene_def){
        .particles = 1, .position = x, .velocity = v, .mass_all = 0.7, .gravity = {0, -gravity, 0}};
}

static const spring_collider ground = {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}};

/* [m] height of the third bounce after a drop from 1 m, from the energy at its highest point. */
static double bounce(contact_scheme scheme, double dt, double restitution)
{
    const double x[3] = {0, 1, 0}, v[3] = {0};
    const spring_scene_def def = one_particle(x, v, g);
    spring_collider c = ground;
    c.restitution = restitution;
    trial t;
    trial_open(&t, &def, &c, scheme, dt);
    int bounces = 0;
    double height = 0;
    for (double before = 0; bounces < 3 && spring_scene_time(t.scene) < 3;) {
        double y[3], u[3];
        trial_advance(&t, 1);
        spring_scene_get(t.scene, SPRING_POSITION, y, 0, 0, 1);
        spring_scene_get(t.scene, SPRING_VELOCITY, u, 0, 0, 1);
        if (before > 0 && u[1] <= 0) /* the highest point is in this step */
            bounces++, height = y[1] + u[1] * u[1] / (2 * g);
        before = u[1];
    }
    trial_close(&t);
    return height;
}

static void state_after(contact_scheme scheme, const spring_scene_def *def, const spring_collider *c, double dt,
                        double end, size_t particle, double x[3], double v[3])
{
    trial t;
    trial_open(&t, def, c, scheme, dt);
    trial_advance(&t, (uint64_t)llround(end / dt));
    spring_scene_get(t.scene, SPRING_POSITION, x, 0, particle, 1);
    spring_scene_get(t.scene, SPRING_VELOCITY, v, 0, particle, 1);
    trial_close(&t);
}

static const double omega = 2 * 3.14159265358979323846; /* [1/s] */

/* [m] distance from the exact position and velocity/omega. */
static double spring_case(contact_scheme scheme, double dt, double restitution)
{
    const double x[6] = {0, -10, 0, 0, 1, 0}, mass = 0.7;
    const uint8_t pinned[2] = {1, 0};
    const spring_link link = {0, 1, 9.5, mass * omega * omega, 0, 0}; /* along a line: linear */
    const spring_scene_def def = {
        .particles = 2, .links = 1, .position = x, .mass_all = mass, .pinned = pinned, .link = &link};
    spring_collider c = ground;
    c.restitution = restitution;
    double y[3], v[3];
    state_after(scheme, &def, &c, dt, 1.5, 1, y, v);
    return distance_on_spring(omega, restitution, 1.5, y[1], v[1]);
}

/* [m] distance from the exact position after 1.5 s of bounces at 3 m/s along the ground. */
static double oblique(contact_scheme scheme, double dt, double friction)
{
    const double x[3] = {0, 1, 0}, v[3] = {3, 0, 0}, end = 1.5;
    const spring_scene_def def = one_particle(x, v, g);
    spring_collider c = ground;
    c.restitution = 0.8, c.friction = friction;
    double y[3], u[3];
    state_after(scheme, &def, &c, dt, end, 0, y, u);
    return distance_of_bounces(v[0], c.restitution, c.friction, end, y);
}

/* A particle slides down a sphere of 1 m: d/dt of its angle from the top and of the angular rate. */
static void sliding(const double s[2], double mu, double out[2])
{
    out[0] = s[1];
    out[1] = g * sin(s[0]) - mu * (g * cos(s[0]) - s[1] * s[1]);
}

static void slide_exactly(double s[2], double mu, double end)
{
    enum { steps = 4096 }; /* of RK4, error 1e-14 */
    const double h = end / steps;
    for (int i = 0; i < steps; i++) {
        double k[4][2], at[2];
        sliding(s, mu, k[0]);
        for (int j = 1; j < 4; j++) {
            for (int a = 0; a < 2; a++)
                at[a] = s[a] + (j == 3 ? h : h / 2) * k[j - 1][a];
            sliding(at, mu, k[j]);
        }
        for (int a = 0; a < 2; a++)
            s[a] += h / 6 * (k[0][a] + 2 * k[1][a] + 2 * k[2][a] + k[3][a]);
    }
}

/* [m] distance from the exact position after 0.5 s. */
static double sphere(contact_scheme scheme, double dt, double mu)
{
    const double start = 0.2, speed = 1, end = 0.5;
    const double x[3] = {sin(start), cos(start), 0}, v[3] = {speed * cos(start), -speed * sin(start), 0};
    const spring_scene_def def = one_particle(x, v, g);
    const spring_collider c = {.shape = SPRING_SPHERE, .radius = 1, .friction = mu};
    double exact[2] = {start, speed}, y[3], u[3];
    slide_exactly(exact, mu, end);
    state_after(scheme, &def, &c, dt, end, 0, y, u);
    return hypot(y[0] - sin(exact[0]), y[1] - cos(exact[0]));
}

static const double slope = 3.14159265358979323846 / 6;

/* [m] distance of a block 2 s after its release on an incline. */
static double incline(contact_scheme scheme, double dt, double mu)
{
    const double x[3] = {0}, v[3] = {0};
    const spring_scene_def def = one_particle(x, v, g);
    const spring_collider c = {.shape = SPRING_PLANE, .axis = {{sin(slope), cos(slope), 0}}, .friction = mu};
    double y[3], u[3];
    state_after(scheme, &def, &c, dt, 2, 0, y, u);
    return hypot(hypot(y[0], y[1]), y[2]);
}

/* [m] distance in 3 s of a block that slides at 3 m/s with friction 0.4. */
static double stopping(contact_scheme scheme, double dt, double friction)
{
    const double x[3] = {0}, v[3] = {3, 0, 0};
    const spring_scene_def def = one_particle(x, v, g);
    spring_collider c = ground;
    c.friction = friction;
    double y[3], u[3];
    state_after(scheme, &def, &c, dt, 3, 0, y, u);
    return y[0];
}

/* Ratio of the tensions of a rope pulled over a cylinder, half a turn, with friction 0.3. */
static double capstan(contact_scheme scheme, double dt, double friction)
{
    enum { count = 64 };
    const double radius = 0.5, thick = 0.01, around = radius + thick, tail = 0.6, load = 5;
    const double length = pi * around + 2 * tail, spacing = length / (count - 1), stiffness = 500 / spacing;
    const double mass = 16 * stiffness / (480.0 * 480), damping = 0.3 * sqrt(stiffness * mass), speed = 0.01, end = 16;
    double x[3 * count], v[3 * count] = {0}, force[3] = {0};
    spring_link link[count - 1];
    uint8_t pinned[count] = {0};
    for (int i = 0; i < count; i++) {
        const double along = i * spacing, phi = fmin(fmax(along - tail, 0), pi * around) / around;
        const double beyond = along < tail ? tail - along : fmax(along - length + tail, 0);
        x[3 * i] = -around * cos(phi), x[3 * i + 1] = around * sin(phi) - beyond, x[3 * i + 2] = 0;
        if (i + 1 < count)
            link[i] = (spring_link){(uint32_t)i, (uint32_t)i + 1, spacing - load / stiffness, stiffness, damping, 0};
    }
    pinned[count - 1] = 1, v[3 * (count - 1) + 1] = -speed;
    const spring_scene_def def = {.flags = SPRING_SCENE_FORCES,
                                  .particles = count,
                                  .links = count - 1,
                                  .position = x,
                                  .velocity = v,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = link,
                                  .particle_radius = thick};
    const spring_collider c = {
        .shape = SPRING_CAPSULE, .at = {0, 0, -1}, .to = {0, 0, 1}, .radius = radius, .friction = friction};
    trial t;
    trial_open(&t, &def, &c, scheme, dt);
    const double frame = 1.0 / 60, moving = mass / spacing * speed * speed; /* momentum flux of the rope */
    const int frames = (int)lround(end / frame);
    double pulled = 0, loaded = 0;
    for (int i = 0; i < frames; i++) {
        double u[3];
        spring_scene_get(t.scene, SPRING_VELOCITY, u, 0, 0, 1);
        force[1] = -load - 20 * mass * u[1]; /* the load, with drag that damps the rope */
        spring_scene_set(t.scene, SPRING_FORCE, force, 0, 0, 1);
        trial_advance(&t, (uint64_t)llround(frame / dt));
        if (i < frames / 2)
            continue;
        pulled += spring_scene_tension(t.scene, count - 3) - moving;
        loaded += spring_scene_tension(t.scene, 1) - moving;
    }
    trial_close(&t);
    return pulled / loaded;
}

/* Of 1000 particles at rest, the number that a plate of 1 cm passes through. */
static double plate(contact_scheme scheme, double dt, double speed)
{
    enum { count = 1000 };
    static double x[3 * count];
    uint32_t random = 1;
    for (int i = 0; i < 3 * count; i++) {
        random = random * UINT32_C(1664525) + UINT32_C(1013904223);
        x[i] = i % 3 == 1 ? 1 + 3 * (random / 4294967296.0) : 2 * (random / 4294967296.0) - 1;
    }
    const spring_scene_def def = {.particles = count, .position = x, .mass_all = 0.7};
    const spring_collider c = {.shape = SPRING_BOX,
                               .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               .half = {5, 0.005, 5},
                               .velocity = {0, speed, 0}};
    trial t;
    trial_open(&t, &def, &c, scheme, dt);
    trial_advance(&t, (uint64_t)ceil(5 / speed / dt));
    const double front = speed * spring_scene_time(t.scene);
    int through = 0;
    for (size_t i = 0; i < count; i++) {
        double y[3];
        spring_scene_get(t.scene, SPRING_POSITION, y, 0, i, 1);
        through += y[1] < front;
    }
    trial_close(&t);
    return through;
}

/* [m] distance from the exact position, after a box that turns has hit a particle at rest. Half of its thickness is 5 cm. */
static double bat(contact_scheme scheme, double dt, double rate)
{
    const double x[3] = {0.32, 0.24, 0}, v[3] = {0}, half = 0.05, end = 0.1;
    const spring_scene_def def = one_particle(x, v, 0);
    const spring_collider c = {.shape = SPRING_BOX,
                               .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               .half = {0.5, half, 1},
                               .spin = {0, 0, rate},
                               .restitution = 1};
    const double r = hypot(x[0], x[1]), angle = atan2(x[1], x[0]) - asin(half / r);
    const double way = 2 * rate * sqrt(r * r - half * half) * (end - angle / rate);
    double y[3], u[3];
    state_after(scheme, &def, &c, dt, end, 0, y, u);
    return hypot(y[0] - x[0] + way * sin(angle), y[1] - x[1] - way * cos(angle));
}

/* [m] distance from the exact position of a bead on a plane that turns under it, rho'' = rate^2 rho - g sin(rate t). */
static double turning_plane(contact_scheme scheme, double dt, double rate)
{
    const double rho = 0.3, speed = 2.5, end = 0.7;
    const double x[3] = {rho, 0, 0}, v[3] = {speed, rate * rho, 0};
    const spring_scene_def def = one_particle(x, v, g);
    const spring_collider c = {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .spin = {0, 0, rate}};
    double y[3], u[3];
    state_after(scheme, &def, &c, dt, end, 0, y, u);
    return distance_on_turning_plane(rate, rho, speed, end, y);
}

/* [m] change of the radius of a particle that friction holds on a turntable for 100 s. */
static double turntable(contact_scheme scheme, double dt, double rate)
{
    const double radius = 0.5, x[3] = {radius, 0, 0}, v[3] = {0, 0, -rate * radius};
    const spring_scene_def def = one_particle(x, v, g);
    spring_collider c = ground;
    c.friction = 0.8, c.spin[1] = rate;
    double y[3], u[3];
    state_after(scheme, &def, &c, dt, 100, 0, y, u);
    return fabs(hypot(y[0], y[2]) - radius);
}

/* [m] distance from the exact position and velocity/rate of a block on a spring, released at 1 m, after a number of
   reversals. It moves on half waves about +- friction g/rate^2. */
static double block(contact_scheme scheme, double dt, double reversals)
{
    const double friction = 0.1, half = 0.47, rate = pi / half, shift = friction * g / (rate * rate), mass = 0.7;
    const double x[6] = {-10, 0, 0, 1, 0, 0}, end = 0.3 + 0.45 * reversals; /* [s] multiples of all steps */
    const uint8_t pinned[2] = {1, 0};
    const spring_link link = {0, 1, 10, mass * rate * rate, 0, 0};
    const spring_scene_def def = {.particles = 2,
                                  .links = 1,
                                  .position = x,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = &link,
                                  .gravity = {0, -g, 0}};
    spring_collider c = ground;
    c.friction = friction;
    double centre = shift, amplitude = 1 - shift, y[3], u[3];
    for (int i = 0; i < reversals; i++)
        amplitude -= 2 * shift, centre = -centre;
    const double phase = rate * (end - reversals * half), side = centre > 0 ? 1 : -1;
    state_after(scheme, &def, &c, dt, end, 1, y, u);
    return hypot(y[0] - centre - side * amplitude * cos(phase), u[0] / rate + side * amplitude * sin(phase));
}

typedef struct contact_case {
    const char *name, *purpose;
    double (*run)(contact_scheme scheme, double dt, double parameter);
    double parameter, exact;
    int schemes; /* number of schemes, the first of contact_scheme_names */
} contact_case;

enum { case_count = 16 };

static void make_cases(contact_case c[case_count])
{
    const double t = 2; /* [s] */
    const contact_case all[case_count] = {
        {"bounce", "height of the third bounce [m], restitution 0.8", bounce, 0.8, pow(0.8, 6), contact_schemes},
        {"spring-on-plane", "distance from the exact state [m], restitution 1", spring_case, 1, 0, contact_schemes},
        {"oblique", "distance from the exact position after 1.5 s [m], bounces with friction 0.1", oblique, 0.1, 0,
         contact_schemes},
        {"sphere", "distance from the exact position after 0.5 s [m], sliding with friction 0.3", sphere, 0.3, 0,
         contact_schemes},
        {"creep", "motion in 2 s [m] on an incline of 30 degrees, friction 1.001 tan 30", incline, 1.001 * tan(slope),
         0, contact_schemes},
        {"slide", "motion in 2 s [m] on an incline of 30 degrees, friction 0.3", incline, 0.3,
         g / 2 * (sin(slope) - 0.3 * cos(slope)) * t * t, contact_schemes},
        {"stopping", "distance to a stop [m] from 3 m/s, friction 0.4", stopping, 0.4, 9 / (2 * 0.4 * g),
         contact_schemes},
        {"capstan", "ratio of the tensions of a rope over a cylinder, friction 0.3", capstan, 0.3, exp(0.3 * pi),
         CONTACT_PROJECTION + 1},
        {"block-1", "distance from the exact state [m], block on a spring with friction 0.1, one reversal", block, 1, 0,
         contact_schemes},
        {"block-2", "the same after two reversals", block, 2, 0, contact_schemes},
        {"block-3", "the same after three reversals", block, 3, 0, contact_schemes},
        {"bat", "distance from the exact position [m], hit by a box that turns at 10 rad/s", bat, 10, 0, 1},
        {"turning-plane", "distance from the exact position [m], on a plane that turns at 2 rad/s", turning_plane, 2, 0,
         1},
        {"turntable", "change of the radius in 100 s [m], held by friction on a turntable at 3 rad/s", turntable, 3, 0,
         1},
        {"plate-80", "particles of 1000 that a plate at 80 m/s passes through", plate, 80, 0, contact_schemes},
        {"plate-500", "particles of 1000 that a plate at 500 m/s passes through", plate, 500, 0, contact_schemes},
    };
    memcpy(c, all, sizeof all);
}

/* -------------------------------------------------------------------------------------------------------- energy */

/* The largest energy in a minute, relative to the initial energy, of a soft body thrown into a box of six planes. */
static double energy_in_box(double restitution, double damping, double fraction, double *dt)
{
    const spring_grid grid = {.count = {4, 4, 4}, .spacing = 0.1, .families = 7, .stiffness = 40, .damping = damping};
    double x[3 * 64], v[3 * 64];
    static spring_link link[64 * 13];
    size_t particles, links;
    spring_grid_size(&grid, &particles, &links);
    spring_grid_fill(&grid, x, NULL, link);
    for (size_t i = 0; i < particles; i++)
        v[3 * i] = 2 - x[3 * i + 1], v[3 * i + 1] = 1 + x[3 * i], v[3 * i + 2] = -1.5;
    const spring_scene_def def = {.particles = particles,
                                  .links = links,
                                  .position = x,
                                  .velocity = v,
                                  .mass_all = 0.01,
                                  .link = link,
                                  .colliders = 6};
    spring_collider wall[6];
    for (int i = 0; i < 6; i++) {
        wall[i] = (spring_collider){.shape = SPRING_PLANE, .restitution = restitution};
        wall[i].axis[0][i / 2] = i % 2 == 0 ? 1 : -1;
        wall[i].at[i / 2] = i % 2 == 0 ? -0.2 : 0.6;
    }
    spring_scene *s = start_definition(&def, NULL);
    spring_scene_set_colliders(s, wall, 6);
    *dt = fraction * spring_scene_stable_step(s, SPRING_LEAPFROG);
    double first = 0, most = 0;
    for (int i = 0; i <= 600; i++) { /* ten times a second */
        const spring_scene_energies e = spring_scene_energy(s);
        const double energy = e.kinetic + e.elastic;
        first = i == 0 ? energy : first;
        most = fmax(most, energy / first);
        if (spring_scene_advance(s, SPRING_LEAPFROG, *dt, (uint64_t)lround(0.1 / *dt)) != SPRING_OK)
            most = INFINITY;
    }
    free(s);
    return most;
}

/* ------------------------------------------------------------------------------------------------------- the rows */

static const char *const parts[] = {"cases", "energy", "list", NULL};
static int part;
static bool quick;

static const cli_option options[] = {
    {"part", CLI_CHOICE, .choice = &part, .choices = parts, .value = "P",
     .help = "closed-form cases, energy in a box, or a list of cases"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer steps, rough results"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-contacts",
    .summary = "Compare contacts with closed-form solutions and with two schemes of game engines.",
    .details = "The method is leapfrog. There are three schemes. library is spring_scene_set_colliders(). projection\n"
               "moves particles that are inside a collider to its surface after each step, and changes their\n"
               "velocities there. penalty pushes them out with damped springs.\n\n"
               "With --part energy, a soft body bounces in a box of six planes for a minute, with the scheme library\n"
               "only.",
    .columns = "case scheme dt_s value exact error order",
    .meaning = "error is the distance of value from exact, divided by exact unless exact is 0. order is the mean\n"
               "slope of error against dt_s, from the longest step to this one.\n\n"
               "With --part energy: restitution, damping_Ns_per_m, stable_fraction (dt divided by the stable step),\n"
               "dt_s and largest_energy (divided by the initial energy). With --part list: case and purpose.",
    .shown = {"dt_s", "error"},
    .examples = {"--quick", "--part energy --quick", "--part list"},
    .options = options,
};

static void print_rows(cli_table *table, const contact_case *c, contact_scheme scheme)
{
    const bool slow = c->run == capstan;
    const int first = slow ? 8 : 4, last = quick ? 16 : slow ? 32 : 128; /* steps per frame */
    double first_error = 0;
    for (int steps = first; steps <= last; steps *= 2) {
        const double dt = 1.0 / 60 / steps, value = c->run(scheme, dt, c->parameter);
        const double error = fabs(c->exact != 0 ? value / c->exact - 1 : value);
        if (steps == first)
            first_error = error;
        const double order = error > 0 && steps > first ? log(first_error / error) / log(steps / (double)first) : NAN;
        cli_row(table, "%s\t%s\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g", c->name, contact_scheme_names[scheme], dt, value,
                c->exact, error, order);
    }
}

static void print_cases(cli_table *table, const contact_case *cases)
{
    cli_columns(table, program.columns);
    for (int i = 0; i < case_count; i++)
        for (int scheme = 0; scheme < cases[i].schemes; scheme++) {
            print_rows(table, &cases[i], (contact_scheme)scheme);
            cli_progress((i + 1.0) / case_count);
        }
}

static void print_energy(cli_table *table)
{
    static const double setting[][2] = {{1, 0}, {1, 0.02}, {0.9, 0}, {0.9, 0.02}, {0.5, 0}};
    static const double fractions[] = {0.125, 0.25, 0.5, 0.99};
    cli_columns(table, "restitution damping_Ns_per_m stable_fraction dt_s largest_energy");
    for (size_t i = 0; i < sizeof setting / sizeof setting[0]; i++)
        for (int k = quick ? 3 : 0; k < 4; k++) {
            double dt;
            const double most = energy_in_box(setting[i][0], setting[i][1], fractions[k], &dt);
            cli_row(table, "%.17g\t%.17g\t%.17g\t%.17g\t%.17g", setting[i][0], setting[i][1], fractions[k], dt, most);
        }
}

int main(int argc, char **argv)
{
    contact_case cases[case_count];
    cli_parse(&program, argc, argv);
    make_cases(cases);
    cli_table *table = cli_open_output();
    if (part == 0)
        print_cases(table, cases);
    if (part == 1)
        print_energy(table);
    if (part == 2) {
        cli_columns(table, "case purpose");
        for (int i = 0; i < case_count; i++)
            cli_row(table, "%s\t%s", cases[i].name, cases[i].purpose);
    }
    cli_finish();
    return 0;
}
