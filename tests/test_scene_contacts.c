/* SPDX-License-Identifier: MIT */
/* Contacts against closed forms: bounces, friction, time of impact, order, wedges, energy. tests/test_scene_colliders.c has
   the rules of the functions. */
#include "test_scene.h"

#include <stdio.h>

#define PI 3.14159265358979323846

static const double gravity = 9.81;

enum { in_double = sizeof(scalar) == sizeof(double) };

/* One particle. With fillers, far away, the scene has the layout of many particles. */
typedef struct particle_in_scene {
    spring_scene *s;
    double x[3], v[3];
} particle_in_scene;

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
    CHECK(spring_scene_set_colliders(s, w->collider, w->colliders) == SPRING_OK, "valid colliders");
    return s;
}

static void step_once(spring_scene *s, spring_method method, double dt, double x[3], double v[3])
{
    CHECK(spring_scene_advance(s, method, dt, 1) == SPRING_OK, "finite");
    spring_scene_get(s, SPRING_POSITION, x, 0, 0, 1);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
}

static void run_to(const setting *w, spring_method method, double dt, double end, double x[3], double v[3])
{
    spring_scene *s = scene_for(w);
    CHECK(spring_scene_advance(s, method, dt, (uint64_t)lround(end / dt)) == SPRING_OK, "finite");
    spring_scene_get(s, SPRING_POSITION, x, 0, 0, 1);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
    free(s);
}

static const spring_collider floor_below = {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}};

/* Bounces of a dropped ball reach e^2, e^4, e^6 of the height; then it lies still. */
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
                         .collider = {floor_below}};
            w.collider[0].restitution = e;
            spring_scene *s = scene_for(&w);
            double x[3], v[3], ratio = 1;
            bool down = true;
            int found = 0;
            for (int i = 0; i < 480 * 12; i++) {
                step_once(s, SPRING_LEAPFROG, dt, x, v);
                if (!down && v[1] <= 0 && found < 3) {
                    ratio *= e * e;
                    const double height = x[1] + v[1] * v[1] / (2 * gravity);
                    printf("# drop %g bounce %d error %g\n", drop, found, height / (drop * ratio) - 1);
                    CHECK_CLOSE(height / (drop * ratio), 1, in_double ? 3e-5 : 1e-3,
                                "the time of impact is found to second order");
                    found++;
                }
                down = v[1] <= 0;
            }
            printf("# end %g %g\n", x[1], v[1]);
            CHECK(found == 3, "three bounces");
            CHECK_BELOW(fabs(x[1]), in_double ? 1e-15 : 1e-6, "at rest on the floor");
            CHECK(v[1] == 0, "at rest");
            free(s);
        }
}

/* A mass on a spring that hits a plane: between impacts a cosine about -0.5. */
static void spring_on_plane(void)
{
    const double omega = 2 * PI, end = 1.5;
    for (int m = 0; m < 3; m++)
        for (int k = 0; k < 2; k++) {
            const spring_method method = (spring_method[]){SPRING_LEAPFROG, SPRING_RK4, SPRING_SYMPLECTIC_EULER}[m];
            const double e = k ? 0.8 : 1, mass = 1.3;
            double t = 0, y = 1, v = 0;
            for (;;) {
                const double amplitude = hypot(y + 0.5, v / omega), phase = atan2(-v / omega, y + 0.5);
                const double q = acos(0.5 / amplitude);
                double after = fmod(q - phase + 4 * PI, 2 * PI) / omega;
                if (after < 1e-12)
                    after += 2 * (PI - q) / omega;
                if (t + after > end) {
                    y = -0.5 + amplitude * cos(omega * (end - t) + phase);
                    v = -amplitude * omega * sin(omega * (end - t) + phase);
                    break;
                }
                t += after;
                v = e * amplitude * omega * sin(q);
                y = 0;
            }
            setting w = {.x = {0, 1, 0},
                         .mass = mass,
                         .pin = {0, -10, 0},
                         .link = {0, 1, 9.5, mass * omega * omega, 0},
                         .colliders = 1,
                         .collider = {floor_below}};
            w.collider[0].restitution = e;
            printf("# spring on plane %d e=%g:", m, e);
            for (int per = 4; per <= 128; per *= 2) {
                double x[3], u[3];
                run_to(&w, method, 1.0 / 60 / per, end, x, u);
                printf(" %.2e", hypot(x[1] - y, (u[1] - v) / omega));
            }
            printf("\n");
        }
}

static void incline(void)
{
    const double angle = PI / 6, n[3] = {-sin(angle) * cos(0.7), cos(angle), -sin(angle) * sin(0.7)};
    for (int m = 0; m < 3; m++)
        for (int many = 0; many < 2; many++)
            for (int per = 4; per <= 32; per *= 2)
                for (int k = 0; k < 2; k++) {
                    const spring_method method =
                        (spring_method[]){SPRING_LEAPFROG, SPRING_RK4, SPRING_SYMPLECTIC_EULER}[m];
                    const double mu = k ? 0.3 : 1.001 * tan(angle);
                    setting w = {.gravity = {0, -gravity, 0},
                                 .mass = 2.3,
                                 .many = many,
                                 .colliders = 1,
                                 .collider = {{.shape = SPRING_PLANE, .friction = mu}}};
                    memcpy(w.collider[0].axis[0], n, sizeof n);
                    double x[3], v[3];
                    run_to(&w, method, 1.0 / 60 / per, 2, x, v);
                    const double slid = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
                    const double exact = k ? 0.5 * gravity * (sin(angle) - mu * cos(angle)) * 4 : 0;
                    printf("# incline %d %d mu %g per %d: %g (rel %g) v %g\n", m, many, mu, per, slid,
                           k ? slid / exact - 1 : 0, hypot(v[0], hypot(v[1], v[2])));
                }
}

/* Acceleration of a particle that slides on a unit sphere: gravity, the normal force N, and friction mu N. Returns N. */
static double sliding_acceleration(const double x[3], const double v[3], double mu, double a[3])
{
    const double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2], normal = gravity * x[1] / r - square / r;
    for (int i = 0; i < 3; i++)
        a[i] = normal * x[i] / r - mu * normal * v[i] / sqrt(square);
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

static void slide_over_sphere(void)
{
    for (int m = 0; m < 3; m++)
        for (int k = 0; k < 2; k++) {
            const spring_method method = (spring_method[]){SPRING_LEAPFROG, SPRING_RK4, SPRING_SYMPLECTIC_EULER}[m];
            const double t0 = PI / 9;
            setting w = {.x = {sin(t0), cos(t0), 0},
                         .v = {0.5 * cos(t0), -0.5 * sin(t0), 0.7},
                         .gravity = {0, -gravity, 0},
                         .mass = 0.4,
                         .colliders = 1,
                         .collider = {{.shape = SPRING_SPHERE, .radius = 1, .friction = k ? 0.3 : 0}}};
            double ref[3], v[3];
            slide_exactly(&w, k ? 0.3 : 0, 1, ref);
            printf("# slide over sphere %d mu %g:", m, k ? 0.3 : 0.0);
            for (int per = 4; per <= 128; per *= 2) {
                double x[3];
                run_to(&w, method, 1.0 / 60 / per, 1, x, v);
                printf(" %.2e", hypot(x[0] - ref[0], hypot(x[1] - ref[1], x[2] - ref[2])));
            }
            printf("\n");
        }
}

static void oblique(void)
{
    const double e = 0.7, mu = 0.1, end = 2;
    double t = 0, x = 0, y = 1, vx = 4, vy = 0;
    for (;;) {
        const double to = (vy + sqrt(vy * vy + 2 * gravity * y)) / gravity;
        if (t + to > end) {
            const double r = end - t;
            x += vx * r, y += vy * r - gravity * r * r / 2;
            break;
        }
        t += to, x += vx * to;
        const double vn = gravity * to - vy;
        vy = e * vn, y = 0;
        vx = fmax(0, vx - mu * (1 + e) * vn);
    }
    for (int m = 0; m < 3; m++) {
        const spring_method method = (spring_method[]){SPRING_LEAPFROG, SPRING_RK4, SPRING_SYMPLECTIC_EULER}[m];
        setting w = {.x = {0, 1, 0},
                     .v = {4, 0, 0},
                     .gravity = {0, -gravity, 0},
                     .mass = 0.4,
                     .colliders = 1,
                     .collider = {floor_below}};
        w.collider[0].restitution = e;
        w.collider[0].friction = mu;
        printf("# oblique %d:", m);
        for (int per = 4; per <= 128; per *= 2) {
            double now[3], v[3];
            run_to(&w, method, 1.0 / 60 / per, end, now, v);
            printf(" %.2e", hypot(now[0] - x, now[1] - y));
        }
        printf("\n");
    }
}

static const test tests[] = {
    {"bounce heights", bounce},   {"spring on a plane", spring_on_plane},
    {"incline", incline},         {"slide over a sphere", slide_over_sphere},
    {"oblique bounces", oblique},
};

int main(void)
{
    return RUN_TESTS("contacts", tests);
}
