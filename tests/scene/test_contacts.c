/* SPDX-License-Identifier: MIT */
/* Contacts compared with exact solutions: bounces, friction, time of impact, order, wedges, energy. The rules of the
   functions are tested in tests/scene/test_colliders.c. */
#include "contact/closed_forms.h"
#include "test_contact.h"

/* One particle. With fillers, pinned and far away, the scene has the layout of many particles. */
enum { fillers = 20 };

typedef struct setting {
    double x[3], v[3];
    double gravity[3], mass;
    spring_link link; /* stiffness > 0: from a pinned particle at `pin` */
    double pin[3];
    bool many;
    uint32_t colliders;
    spring_collider collider[6];
} setting;

static spring_scene *scene_for(const setting *w)
{
    const size_t particles = w->many ? 2 + fillers : 2;
    double x[(2 + fillers) * 3], v[(2 + fillers) * 3] = {0}, mass[2 + fillers];
    uint8_t pinned[2 + fillers] = {0, 1};
    for (size_t i = 0; i < particles; i++) {
        mass[i] = w->mass;
        for (size_t a = 0; a < 3; a++)
            x[3 * i + a] = 1000.0 + (double)i;
        pinned[i] = i > 0;
    }
    memcpy(x, w->x, sizeof w->x);
    memcpy(x + 3, w->pin, sizeof w->pin);
    memcpy(v, w->v, sizeof w->v);
    spring_scene_def def = {
        .particles = particles,
        .position = x,
        .velocity = v,
        .mass = mass,
        .pinned = pinned,
        .links = w->link.stiffness > 0,
        .link = &w->link,
        .colliders = 6,
        .methods = 1u << SPRING_SYMPLECTIC_EULER | 1u << SPRING_LEAPFROG | 1u << SPRING_RK4,
    };
    memcpy(def.gravity, w->gravity, sizeof def.gravity);
    spring_scene *s = scene_of(&def);
    set(s, w->collider, w->colliders);
    return s;
}

static void step_once(spring_scene *s, spring_method method, double dt, double x[3], double v[3])
{
    run(s, method, dt, 1);
    get(s, x, v);
}

static void run_to(const setting *w, spring_method method, double dt, double end, double x[3], double v[3])
{
    end_of(scene_for(w), method, dt, (uint64_t)lround(end / dt), x, v);
}

/* Acceleration of a particle that slides on a unit sphere: gravity, the normal force N, and friction mu N. Returns N. */
static double sliding_acceleration(const double x[3], const double v[3], double mu, double a[3])
{
    const double r = length(x), normal = gravity * x[1] / r - dot(v, v) / r;
    for (int i = 0; i < 3; i++)
        a[i] = normal * x[i] / r - mu * normal * v[i] / length(v);
    a[1] -= gravity;
    return normal;
}

/* The same motion by RK4 along the constraint, and free flight from where N becomes 0. */
static void slide_exactly(const setting *w, double mu, double end, double x[3])
{
    enum { steps = 100000 };
    const double h = end / steps;
    double v[3];
    memcpy(x, w->x, sizeof w->x);
    memcpy(v, w->v, sizeof v);
    for (int step = 0; step < steps; step++) {
        double kx[4][3], kv[4][3], y[3], u[3], a[3];
        static const double at[4] = {0, 0.5, 0.5, 1};
        if (sliding_acceleration(x, v, mu, a) <= 0) {
            const double t = end - step * h;
            for (int i = 0; i < 3; i++)
                x[i] += t * v[i] - (i == 1 ? gravity * t * t / 2 : 0);
            return;
        }
        for (int k = 0; k < 4; k++) {
            for (int i = 0; i < 3; i++) {
                y[i] = x[i] + (k > 0 ? at[k] * h * kx[k - 1][i] : 0);
                u[i] = v[i] + (k > 0 ? at[k] * h * kv[k - 1][i] : 0);
            }
            sliding_acceleration(y, u, mu, kv[k]);
            memcpy(kx[k], u, sizeof u);
        }
        for (int i = 0; i < 3; i++) {
            x[i] += h / 6 * (kx[0][i] + 2 * kx[1][i] + 2 * kx[2][i] + kx[3][i]);
            v[i] += h / 6 * (kv[0][i] + 2 * kv[1][i] + 2 * kv[2][i] + kv[3][i]);
        }
    }
}

/* The slope of an error between steps of 1/240 s and 1/3840 s, of the runs that `error` makes. */
static double slope(double (*error)(const setting *, spring_method, double), const setting *w, spring_method method)
{
    const double coarse = error(w, method, 1.0 / 240), fine = error(w, method, 1.0 / 3840);
    return log2(coarse / fine) / 4;
}

/* Drops bounce to e^2, e^4 and e^6 of the height; at the end the particle lies still. The bound is twice the error of the
   prototype of this scheme. */
static void bounce(void)
{
    const double e = 0.8, dt = 1.0 / 480;
    for (int many = 0; many < 2; many++)
        for (double drop = 0.5; drop <= 2; drop += 0.25) {
            setting w = {.x = {0, drop, 0},
                         .gravity = {0, -gravity, 0},
                         .mass = 0.7,
                         .many = many,
                         .colliders = 1,
                         .collider = {ground}};
            w.collider[0].restitution = e;
            spring_scene *s = scene_for(&w);
            double x[3], v[3], ratio = 1;
            bool falls = true;
            int found = 0;
            for (int i = 0; i < 480 * 12; i++) {
                step_once(s, SPRING_LEAPFROG, dt, x, v);
                if (!falls && v[1] <= 0 && found < 3) {
                    ratio *= e * e;
                    const double height = x[1] + v[1] * v[1] / (2 * gravity);
                    CHECK_CLOSE(height / (drop * ratio), 1, in_double ? 3e-5 : 1e-3,
                                "the time of impact is found, so the error is of second order");
                    found++;
                }
                falls = v[1] <= 0;
            }
            CHECK(found == 3, "three bounces");
            CHECK_BELOW(fabs(x[1]), in_double ? 1e-15 : 1e-6, "on the floor, to the rounding of a step there");
            CHECK(v[1] == 0, "at rest");
            free(s);
        }
}

static double spring_on_plane_error(const setting *w, spring_method method, double dt)
{
    double x[3], v[3];
    run_to(w, method, dt, 1.5, x, v);
    return distance_on_spring(2 * PI, w->collider[0].restitution, 1.5, x[1], v[1]);
}

/* A mass on a spring, whose rest position is inside the floor. */
static void spring_on_plane(void)
{
    const double omega = 2 * PI, mass = 1.3;
    for (int i = 0; i < 2; i++) {
        setting w = {.x = {0, 1, 0},
                     .mass = mass,
                     .pin = {0, -10, 0},
                     .link = {0, 1, 9.5, mass * omega * omega, 0, 0},
                     .colliders = 1,
                     .collider = {ground}};
        w.collider[0].restitution = i == 0 ? 1 : 0.8;
        for (int m = 0; m < second_order; m++)
            CHECK(!in_double || slope(spring_on_plane_error, &w, contact_methods[m]) >= 1.8,
                  "second order across impacts");
        CHECK_CLOSE(slope(spring_on_plane_error, &w, SPRING_SYMPLECTIC_EULER), 1, 0.1, "first order");
    }
}

static double oblique_error(const setting *w, spring_method method, double dt)
{
    double x[3], v[3];
    run_to(w, method, dt, 2, x, v);
    return distance_of_bounces(w->v[0], w->collider[0].restitution, w->collider[0].friction, 2, x);
}

/* Each bounce takes mu (1 + e) of the normal speed from the tangential one. */
static void oblique_bounces(void)
{
    setting w = {
        .x = {0, 1, 0}, .v = {4, 0, 0}, .gravity = {0, -gravity, 0}, .mass = 0.4, .colliders = 1, .collider = {ground}};
    w.collider[0].restitution = 0.7;
    w.collider[0].friction = 0.1;
    for (int m = 0; m < second_order; m++) {
        CHECK_BELOW(oblique_error(&w, contact_methods[m], 1.0 / 240), in_double ? 1e-5 : 1e-3,
                    "twice the prototype's error");
        CHECK(!in_double || slope(oblique_error, &w, contact_methods[m]) >= 1.8, "second order");
    }
}

static double slide_error(const setting *w, spring_method method, double dt)
{
    double x[3], v[3], exact[3];
    slide_exactly(w, w->collider[0].friction, 1, exact);
    run_to(w, method, dt, 1, x, v);
    return distance(x, exact);
}

/* Over the top of a sphere, then free flight, without friction and with it. */
static void slide_over_sphere(void)
{
    const double start = PI / 9;
    for (int many = 0; many < 2; many++)
        for (double mu = 0; mu < 0.5; mu += 0.3) {
            const setting w = {.x = {sin(start), cos(start), 0},
                               .v = {0.5 * cos(start), -0.5 * sin(start), 0.7},
                               .gravity = {0, -gravity, 0},
                               .mass = 0.4,
                               .many = many,
                               .colliders = 1,
                               .collider = {{.shape = SPRING_SPHERE, .radius = 1, .friction = mu}}};
            for (int m = 0; m < second_order && in_double; m++) {
                CHECK_BELOW(slide_error(&w, contact_methods[m], 1.0 / 240), 5e-5, "twice the prototype's error");
                CHECK(slope(slide_error, &w, contact_methods[m]) >= 1.8, "second order, also where it leaves");
            }
            CHECK_BELOW(slide_error(&w, SPRING_LEAPFROG, 1.0 / 240), in_double ? 5e-5 : 5e-3,
                        "in float by rounding errors");
        }
}

/* A wall that moves into a particle at rest, set after some time: the relative normal velocity is reversed times e, and
   friction pulls along its tangential velocity by at most mu (1 + e) of the normal one. */
static void moving_wall(void)
{
    const double e = 0.5, mu = 0.2, speed = 3;
    for (int m = 0; m < method_count; m++)
        for (int many = 0; many < 2; many++) {
            setting w = {.x = {1, 0.2, 0},
                         .mass = 0.8,
                         .many = many,
                         .colliders = 1,
                         .collider = {{.shape = SPRING_PLANE,
                                       .at = {0.9, 0, 0},
                                       .axis = {{1, 0, 0}},
                                       .velocity = {speed, 4, 0},
                                       .friction = mu,
                                       .restitution = e}}};
            spring_scene *s = scene_for(&w);
            double x[3], v[3];
            set(s, NULL, 0);
            run(s, contact_methods[m], 0.01, 25);
            set(s, w.collider, 1);
            end_of(s, contact_methods[m], 0.01, 10, x, v);
            const double hit = 0.1 / speed, after = 0.1 - hit;
            CHECK_CLOSE(v[0], (1 + e) * speed, 10 * EPS, "thrown ahead of it");
            CHECK_CLOSE(v[1], mu * (1 + e) * speed, 10 * EPS, "friction");
            CHECK_CLOSE(x[0], 1 + (1 + e) * speed * after, 100 * EPS, "since the time of the impact");
            CHECK_CLOSE(x[1], 0.2 + mu * (1 + e) * speed * after, 100 * EPS, "since the time of the impact");
        }
}

/* Static friction holds a block exactly. With less friction it slides by g (sin - mu cos) t^2/2. */
static void incline(void)
{
    const double angle = PI / 6, n[3] = {-sin(angle) * cos(0.7), cos(angle), -sin(angle) * sin(0.7)};
    for (int m = 0; m < method_count; m++)
        for (int many = 0; many < 2; many++)
            for (int steps = 4; steps <= 32; steps *= 2)
                for (int slides = 0; slides < 2; slides++) {
                    const double mu = slides ? 0.3 : 1.001 * tan(angle), dt = 1.0 / 60 / steps;
                    setting w = {.gravity = {0, -gravity, 0},
                                 .mass = 2.3,
                                 .many = many,
                                 .colliders = 1,
                                 .collider = {{.shape = SPRING_PLANE, .friction = mu}}};
                    memcpy(w.collider[0].axis[0], n, sizeof n);
                    double x[3], v[3];
                    run_to(&w, contact_methods[m], dt, 2, x, v);
                    const double slid = length(x), a = gravity * (sin(angle) - mu * cos(angle));
                    if (slides) /* symplectic Euler: positions of half a step later */
                        CHECK_CLOSE(slid / (a * 2 * (m < second_order ? 1 : 1 + dt / 2)), 1, in_double ? 1e-12 : 2e-4,
                                    "a constant force is integrated exactly");
                    else
                        CHECK(slid == 0 && v[0] == 0 && v[1] == 0 && v[2] == 0, "held, to the bit");
                }
}

/* The same far from the origin, where the start is on the plane only to a rounding error. */
static void incline_far_away(void)
{
    const double n[3] = {-0.48, 0.8, -0.36};
    for (int m = 0; m < method_count; m++)
        for (int i = 0; i < 20; i++) {
            setting w = {.x = {1234.56 + i, -765.4, 2345.6 - 0.3 * i},
                         .gravity = {0, -gravity, 0},
                         .mass = 2.3,
                         .colliders = 1,
                         .collider = {{.shape = SPRING_PLANE, .friction = 0.9}}};
            memcpy(w.collider[0].axis[0], n, sizeof n);
            memcpy(w.collider[0].at, w.x, sizeof w.x);
            double x[3], v[3], first[3];
            spring_scene *s = scene_for(&w);
            step_once(s, contact_methods[m], 1.0 / 240, first, v);
            for (int step = 0; step < 480; step++)
                step_once(s, contact_methods[m], 1.0 / 240, x, v);
            CHECK(memcmp(x, first, sizeof x) == 0 && v[0] == 0 && v[1] == 0 && v[2] == 0, "held, to the bit");
            free(s);
        }
}

/* A block stops after v^2/(2 mu g), within the mu g h^2/8 by which its last step may differ. */
static void stopping_distance(void)
{
    const double mu = 0.4, dt = 1.0 / 240;
    for (int i = 0; i < 40; i++) {
        const double speed = 0.1 + 0.07 * i;
        setting w = {.v = {speed, 0, 0.5 * speed},
                     .gravity = {0, -gravity, 0},
                     .mass = 0.3,
                     .colliders = 1,
                     .collider = {ground}};
        w.collider[0].friction = mu;
        double x[3], v[3];
        run_to(&w, SPRING_LEAPFROG, dt, 2, x, v);
        CHECK_CLOSE(hypot(x[0], x[2]), 1.25 * speed * speed / (2 * mu * gravity),
                    mu * gravity * dt * dt / 8 + 1e3 * EPS, "the last step");
        CHECK(v[0] == 0 && v[2] == 0, "at rest");
    }
}

/* A belt takes a particle along: it is behind by u^2/(2 mu g). So does the surface of a body at rest. A turning disc, the
   spin of a plane, likewise. */
static void conveyor(void)
{
    const double mu = 0.3, speed = 1;
    setting w = {.gravity = {0, -gravity, 0}, .mass = 0.3, .colliders = 1, .collider = {ground}};
    double x[3], v[3];
    w.collider[0].friction = mu;
    for (int at_rest = 0; at_rest < 2; at_rest++) {
        spring_collider *const c = &w.collider[0];
        c->velocity[0] = at_rest ? 0 : speed;
        c->surface[0] = at_rest ? speed : 0;
        c->surface[1] = at_rest ? 3 : 0; /* the normal part is ignored */
        run_to(&w, SPRING_LEAPFROG, 1.0 / 480, 2, x, v);
        CHECK_CLOSE(2 * speed - x[0], speed * speed / (2 * mu * gravity), 1e-5, "as a block that stops");
        CHECK_CLOSE(v[0], speed, 2 * EPS, "as fast as the belt");
        CHECK_BELOW(fabs(x[1]), 10 * EPS, "on the belt");
    }
    w.collider[0].surface[0] = w.collider[0].surface[1] = 0;
    w.collider[0].spin[1] = -2; /* the surface at (0, 0, -0.5) has the velocity spin x arm = (1, 0, 0) */
    w.x[2] = -0.5;
    spring_scene *s = scene_for(&w);
    step_once(s, SPRING_LEAPFROG, 1e-3, x, v);
    CHECK_CLOSE(v[0], mu * gravity * 1e-3, 100 * EPS, "pulled along by friction");
    CHECK_BELOW(fabs(v[2]), 1e-8 + 100 * EPS, "in its direction, which turns by 2/s times the way in a step");
    free(s);
}

/* ------------------------------------------------------------------------------------------------------ many particles */

/* The least gap of a free particle, with the poses `since` after they were set. */
static double least_gap(const spring_scene *s, const spring_collider *c, uint32_t colliders, double radius,
                        double since)
{
    double least = INFINITY;
    for (size_t i = 0; i < s->layout.particles; i++) {
        double x[3] = {0};
        spring_scene_get(s, SPRING_POSITION, x, 0, i, 1);
        for (uint32_t k = 0; k < colliders && inverse_mass_at(s, i) > 0; k++)
            least = fmin(least, gap_of(&c[k], since, x, s->layout.axes) - radius);
    }
    return least;
}

/* With one collider no particle is inside it at the end of any step, beyond rounding errors. */
static void never_inside(void)
{
    static model m;
    static const uint32_t shapes[][3] = {{5, 1, 1}, {20, 1, 1}, {6, 5, 1}, {4, 3, 3}};
    for (int number = 0; number < 1000; number++) {
        const uint32_t axes = number % 2 == 0 ? 2 : 3;
        build(&m, shapes[number / 2 % 4], axes, (unsigned)random_bits() % feature_masks & ~(unsigned)PINNED);
        for (size_t i = 0; i < m.def.links && number % 3 == 0 && number / 3 % 4 < 2; i++)
            m.link[i].damping *= 1000; /* with leapfrog, an exponential kick */
        m.def.colliders = 1;
        m.def.particle_radius = 0.02;
        m.def.methods = 1u << SPRING_LEAPFROG | 1u << SPRING_SYMPLECTIC_EULER | 1u << SPRING_RK4;
        const spring_collider c = random_collider(axes);
        spring_scene *s = scene_with(&m.def, &c);
        const double bound = 32 * EPS * (10 + c.radius); /* four times the slop, at most 10 m from the origin */
        for (int step = 0; step < 20; step++) {
            run(s, contact_methods[number % method_count], 0.01, 1);
            CHECK_BELOW(fmax(0, -least_gap(s, &c, 1, m.def.particle_radius, spring_scene_time(s))), bound, "outside");
        }
        free(s);
    }
}

/* Straight paths of one step: what meets the collider touches it, and what clearly misses it moves on as if it was not
   there. Near a miss by a twentieth of the path, the four iterations for the time of impact may report a contact. */
static void hits_and_misses(void)
{
    enum { count = 40, samples = 400 };
    double x[3 * count], v[3 * count];
    int hits = 0, misses = 0;
    for (int number = 0; number < 400; number++) {
        const uint32_t axes = number % 2 == 0 ? 2 : 3;
        const double dt = 0.25, radius = 0.02;
        spring_collider c = random_collider(axes);
        memset(c.acceleration, 0, sizeof c.acceleration); /* the path is a chord in the frame of the body */
        memcpy(c.velocity_to, c.velocity, sizeof c.velocity);
        if (c.shape == SPRING_PLANE || c.shape == SPRING_BOX)
            memset(c.spin, 0, sizeof c.spin), memset(c.spin_acceleration, 0, sizeof c.spin_acceleration);
        for (size_t i = 0; i < count * axes; i++) {
            x[i] = random_uniform(-2.5, 2.5);
            v[i] = random_uniform(-6, 6);
        }
        spring_scene_def def = falling(count, x, v, 1);
        def.axes = axes, def.gravity[1] = 0, def.particle_radius = (scalar)radius;
        spring_scene *s = scene_with(&def, &c);
        run(s, contact_methods[number % method_count], dt, 1);
        uint32_t mask[count];
        spring_scene_touching(s, mask, 0, count);
        for (size_t i = 0; i < count; i++) {
            double least = INFINITY, square = 0, now[3];
            for (uint32_t a = 0; a < axes; a++)
                square += v[i * axes + a] * v[i * axes + a];
            for (int k = 0; k <= samples; k++) {
                double at[3] = {0};
                for (uint32_t a = 0; a < axes; a++)
                    at[a] = x[i * axes + a] + v[i * axes + a] * dt * k / samples;
                least = fmin(least, gap_of(&c, dt * k / samples, at, axes) - radius);
            }
            spring_scene_get(s, SPRING_POSITION, now, 0, i, 1);
            if (least < -1e-3) {
                CHECK(mask[i] == 1, "it meets the collider");
                hits++;
            } else if (least > 0.05 * (sqrt(square) + 2) * dt) {
                CHECK(mask[i] == 0, "it misses the collider");
                CHECK_CLOSE(now[0], x[i * axes] + dt * v[i * axes], 10 * EPS, "and moves on");
                misses++;
            }
        }
        free(s);
    }
    CHECK(hits > 1000 && misses > 1000, "many of both");
}

/* In wedges between a sphere, a capsule and two planes a particle may be inside by a part of its motion in a step. */
static void wedges(void)
{
    enum { count = 2000 };
    static double x[3 * count], v[3 * count];
    for (int i = 0; i < count; i++) {
        x[3 * i] = random_uniform(-1, 1);
        x[3 * i + 1] = random_uniform(1, 2);
        x[3 * i + 2] = random_uniform(-1, 1);
        v[3 * i] = random_uniform(-2, 2);
        v[3 * i + 2] = random_uniform(-2, 2);
    }
    const spring_collider c[4] = {
        {.shape = SPRING_SPHERE, .at = {0, 0.3, 0}, .radius = 0.3, .friction = 0.3},
        {.shape = SPRING_CAPSULE, .at = {0.5, 0.1, -1}, .to = {0.5, 0.1, 1}, .radius = 0.15, .friction = 0.3},
        {.shape = SPRING_PLANE, .axis = {{0.3, sqrt(1 - 0.09), 0}}, .at = {-0.5, 0, 0}, .friction = 0.3},
        ground,
    };
    spring_scene_def def = falling(count, x, v, 1);
    def.colliders = 4, def.particle_radius = (scalar)0.01;
    spring_scene *s = scene_with(&def, c);
    double deepest = 0;
    for (int i = 0; i < 480 * 2; i++) {
        run(s, SPRING_LEAPFROG, 1.0 / 480, 1);
        if (i % 16 == 0)
            deepest = fmax(deepest, -least_gap(s, c, 4, 0.01, 0));
    }
    CHECK_BELOW(deepest, 1e-3, "a twentieth of the way in a step at 8 m/s");
    free(s);
}

/* In a wedge of two planes a particle is projected to one plane and to the other in turn, five times after the first
   contact in a step. Each projection leaves the cosine of the angle of the depth. */
static void wedge_of_planes(void)
{
    const double dt = 0.01, speed = 3;
    for (double angle = PI / 6; angle < 0.45 * PI; angle += PI / 18) {
        const spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{0, 1, 0}}},
                                      {.shape = SPRING_PLANE, .axis = {{sin(angle), -cos(angle), 0}}}};
        double deepest = 0;
        for (int i = 0; i < 400; i++) {
            const double r = random_uniform(0.02, 0.2), at = random_uniform(0.05, 0.95) * angle;
            const double direction = at + PI + random_uniform(-0.6, 0.6);
            const double x[3] = {r * cos(at), r * sin(at), 0};
            const double v[3] = {speed * cos(direction), speed * sin(direction), 0};
            spring_scene *s = particle_on(c, 2, x, v, none);
            for (int n = 0; n < 20; n++) {
                run(s, SPRING_LEAPFROG, dt, 1);
                deepest = fmax(deepest, -least_gap(s, c, 2, 0, 0));
            }
            free(s);
        }
        CHECK_BELOW(deepest, speed * dt * pow(cos(angle), 5), "five projections of at most the motion in a step");
    }
}

/* A soft body thrown about in a box of six planes: without restitution 1, contacts never add energy. */
static void energy_in_box(void)
{
    static double x[81], v[81];
    static spring_link link[400];
    const spring_grid g = {.count = {3, 3, 3},
                           .spacing = 0.2,
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                           .stiffness = 100,
                           .damping = 0.05};
    size_t particles, links;
    spring_grid_size(&g, &particles, &links);
    spring_grid_fill(&g, x, NULL, link);
    for (int i = 0; i < 27; i++) {
        const double n[3] = {i % 3, i / 3 % 3, i / 9};
        x[3 * i] += 0.3, x[3 * i + 1] += 0.2, x[3 * i + 2] += 0.25;
        v[3 * i] = 2 + n[1] - n[2], v[3 * i + 1] = 1 - n[0], v[3 * i + 2] = 2 * n[0] - 1;
    }
    const double side = 1.5;
    for (double e = 0; e <= 0.9; e += 0.45) {
        spring_scene_def def = falling(particles, x, v, 0.05);
        def.links = links, def.link = link, def.colliders = 6;
        spring_collider c[6] = {{0}};
        for (int k = 0; k < 6; k++) {
            c[k] = (spring_collider){.shape = SPRING_PLANE, .restitution = e, .friction = 0.2};
            c[k].axis[0][k % 3] = k < 3 ? 1 : -1;
            c[k].at[k % 3] = k < 3 ? 0 : side;
        }
        spring_scene *s = scene_with(&def, c);
        const double dt = 0.99 * spring_scene_stable_step(s, SPRING_LEAPFROG);
        const double first = total_energy(s);
        for (int i = 0; i * dt < 60; i++) {
            run(s, SPRING_LEAPFROG, dt, 1);
            if (i % 8 == 0)
                CHECK_BELOW(total_energy(s) / first, 1.002, "contacts add no energy");
        }
        free(s);
    }
}

static const test tests[] = {
    {"bounce heights", bounce},
    {"spring on a plane", spring_on_plane},
    {"oblique bounces", oblique_bounces},
    {"slide over a sphere", slide_over_sphere},
    {"incline", incline},
    {"incline far away", incline_far_away},
    {"moving wall", moving_wall},
    {"stopping distance", stopping_distance},
    {"conveyor belt", conveyor},
    {"never inside one collider", never_inside},
    {"hits and misses", hits_and_misses},
    {"wedges", wedges},
    {"wedge of planes", wedge_of_planes},
    {"energy in a box", energy_in_box},
};

int main(void)
{
    return RUN_TESTS("contacts", tests);
}
