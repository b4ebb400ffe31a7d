/* SPDX-License-Identifier: MIT */
/* Colliders as bodies: rigid motion, static friction on them, friction across reversals, grooves, impulses, masks, radii,
   and bodies of any form. */
#include "test_scene.h"

#include <stdio.h>

#define PI 3.14159265358979323846

static const double gravity = 9.81, frame = 1. / 60;

enum { in_double = sizeof(scalar) == sizeof(double) };

static const spring_method with_contacts[] = {SPRING_LEAPFROG, SPRING_RK4};
enum { method_count = 2 };

static const spring_collider unit_box = {
    .shape = SPRING_BOX, .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .half = {2, 0.1, 2}};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double length(const double a[3])
{
    return sqrt(dot(a, a));
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* a turned by the vector phi (Rodrigues). */
static void turn(const double phi[3], const double a[3], double out[3])
{
    const double angle = length(phi);
    double n[3] = {0}, c[3];
    for (int i = 0; i < 3 && angle > 0; i++)
        n[i] = phi[i] / angle;
    cross(n, a, c);
    for (int i = 0; i < 3; i++)
        out[i] = angle > 0 ? cos(angle) * a[i] + sin(angle) * c[i] + 2 * pow(sin(angle / 2), 2) * dot(n, a) * n[i] : a[i];
}

/* One free particle of 0.7 kg. */
static spring_scene *particle_at(const double x[3], const double v[3], const double g[3], uint32_t colliders)
{
    spring_scene_def def = {.particles = 1,
                            .position = x,
                            .velocity = v,
                            .mass_all = 0.7,
                            .colliders = colliders,
                            .methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4};
    memcpy(def.gravity, g, sizeof def.gravity);
    return scene_of(&def);
}

static void get(const spring_scene *s, double x[3], double v[3])
{
    spring_scene_get(s, SPRING_POSITION, x, 0, 0, 1);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
}

static void set(spring_scene *s, const spring_collider *c, uint32_t count)
{
    CHECK(spring_scene_set_colliders(s, c, count) == SPRING_OK, "valid colliders");
}

static void run(spring_scene *s, spring_method m, double dt, uint64_t n)
{
    CHECK(spring_scene_advance(s, m, dt, n) == SPRING_OK, "finite");
}

/* ----------------------------------------------------------------------------------------------------- rigid motion */

typedef struct hit {
    double error, fastest;
    bool behind;
} hit;

/* A box of half thickness b turns about z through the origin and hits a particle at rest at (0.32, 0.24), without gravity
   or friction. Exact: after the impact it flies (e = 1), or slides out along the face, xi'' = omega^2 xi (e = 0). */
static hit bat(spring_method m, double omega, double b, double e, double dt, int every)
{
    const double x[3] = {0.32, 0.24, 0}, none[3] = {0}, r = 0.4, theta = atan2(0.24, 0.32) - asin(b / r);
    const double at_hit = theta / omega, xi = sqrt(r * r - b * b), end = at_hit + (e > 0 ? 0.3 : 0.25) / omega;
    const int steps = (int)ceil(end / dt);
    spring_scene *s = particle_at(x, none, none, 1);
    spring_collider c = unit_box;
    c.half[0] = 0.5, c.half[1] = b, c.half[2] = 1, c.spin[2] = omega, c.restitution = e;
    hit h = {0};
    double now[3], v[3];
    for (int i = 0; i < steps; i++) {
        const double a = omega * end * i / steps;
        if (i % every == 0) {
            memcpy(c.axis, (double[3][3]){{cos(a), sin(a), 0}, {-sin(a), cos(a), 0}, {0, 0, 1}}, sizeof c.axis);
            set(s, &c, 1);
        }
        run(s, m, end / steps, 1);
        get(s, now, v);
        h.fastest = fmax(h.fastest, length(v));
    }
    const double tau = end - at_hit, a = omega * end, out = xi * cosh(omega * tau) + b * sinh(omega * tau);
    const double speed = (1 + e) * omega * xi * tau;
    const double flown[2] = {x[0] - sin(theta) * speed, x[1] + cos(theta) * speed};
    const double slid[2] = {out * cos(a) - b * sin(a), out * sin(a) + b * cos(a)};
    h.error = e > 0 ? hypot(now[0] - flown[0], now[1] - flown[1]) : hypot(now[0] - slid[0], now[1] - slid[1]);
    h.behind = -sin(a) * now[0] + cos(a) * now[1] < b - 1e4 * EPS;
    free(s);
    return h;
}

static void turned_box_hits(void)
{
    static const double omega[] = {0.5, 2, 10, 30, 100, 300};
    for (int m = 0; m < method_count; m++)
        for (int thin = 0; thin < 2; thin++)
            for (int i = 0; i < 6; i++) {
                const hit h = bat(with_contacts[m], omega[i], thin ? 0.01 : 0.05, 0, 1. / 960, 16);
                CHECK(!h.behind, "it stays in front of the box");
                CHECK(h.fastest >= omega[i] * 0.4, "at least as fast as the surface");
            }
    for (int m = 0; m < method_count && in_double; m++)
        for (int e = 0; e < 2; e++) {
            double error[2];
            for (int fine = 0; fine < 2; fine++) {
                double sum = 0;
                for (int k = 0; k < 8; k++)
                    sum += pow(bat(with_contacts[m], 10, 0.05, e, (fine ? 1. / 7680 : 1. / 240) * (1 + 0.05 * k), 1 << 20).error, 2);
                error[fine] = sqrt(sum / 8);
            }
            CHECK(log2(error[0] / error[1]) / 5 >= 1.9, "second order");
        }
}

/* A bead on a plane that turns about z through the origin: rho'' = omega^2 rho - g sin(omega t). */
static void bead_on_turning_plane(void)
{
    const double omega = 2, rho = 0.3, speed = 2.5, end = 0.7, g[3] = {0, -gravity, 0};
    const double x[3] = {rho, 0, 0}, v[3] = {speed, omega * rho, 0}, B = (speed - gravity / (2 * omega)) / omega;
    const double exact =
        rho * cosh(omega * end) + B * sinh(omega * end) + gravity / (2 * omega * omega) * sin(omega * end);
    for (int m = 0; m < method_count && in_double; m++) {
        double error[2], now[3], u[3];
        for (int fine = 0; fine < 2; fine++) {
            spring_scene *s = particle_at(x, v, g, 1);
            set(s, &(spring_collider){.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .spin = {0, 0, omega}}, 1);
            const uint64_t steps = fine ? 2240 : 70;
            run(s, with_contacts[m], end / (double)steps, steps);
            get(s, now, u);
            error[fine] = hypot(now[0] - exact * cos(omega * end), now[1] - exact * sin(omega * end));
            free(s);
        }
        CHECK(log2(error[0] / error[1]) / 5 >= 1.9, "second order");
    }
}

/* Static friction on a turntable of 3 rad/s, for 100 s. */
static void turntable(void)
{
    const double omega = 3, x[3] = {0.5, 0, 0}, v[3] = {0, 0, -omega * 0.5}, g[3] = {0, -gravity, 0};
    for (int kind = 0; kind < 2; kind++)
        for (int n = 4; n <= 64; n *= 4)
            for (int once = 0; once < 2; once++) {
                spring_scene *s = particle_at(x, v, g, 1);
                spring_collider c = unit_box;
                c.at[1] = -0.1;
                if (kind == 0)
                    c = (spring_collider){.shape = SPRING_PLANE, .axis = {{0, 1, 0}}};
                c.friction = 0.8, c.spin[1] = omega;
                double off = 0, now[3], u[3];
                for (int f = 0; f < 6000; f++) {
                    const double phi[3] = {0, omega * f * frame, 0};
                    for (int k = 0; k < 3 && kind == 1 && !once; k++)
                        turn(phi, unit_box.axis[k], c.axis[k]);
                    if (f == 0 || !once)
                        set(s, &c, 1);
                    run(s, SPRING_LEAPFROG, frame / n, (uint64_t)n);
                    get(s, now, u);
                    off = fmax(off, fabs(hypot(now[0], now[2]) - 0.5));
                }
                const double angle = remainder(atan2(-now[2], now[0]) - omega * 100, 2 * PI);
                CHECK_BELOW(off, in_double ? 1e-11 : 6000. * n * 0x1p-25, "half an ulp in a step");
                CHECK_BELOW(fabs(angle), in_double ? 1e-10 : 1, "carried along");
                free(s);
            }
}

/* A box that rocks by 0.35 rad about a tilted axis, set once per frame at the exact pose, with the spin at its start and
   the mean spin acceleration. */
static void rocking_box(void)
{
    const double axis[3] = {0.9 / sqrt(1.06), 0, 0.5 / sqrt(1.06)}, start[3] = {0.2, 0.1, 0.1}, g[3] = {0, -gravity, 0};
    double v[3], now[3], u[3], slip = 0;
    cross((double[3]){0.7 * axis[0], 0, 0.7 * axis[2]}, start, v);
    spring_scene *s = particle_at(start, v, g, 1);
    spring_collider c = unit_box;
    c.half[0] = c.half[2] = 1, c.friction = 0.9;
    for (int f = 0; f < 1200; f++) {
        const double t = f * frame, q0 = 0.35 * sin(2 * t), q1 = 0.35 * sin(2 * (t + frame)), rate = 0.7 * cos(2 * t);
        const double accel = 2 * (q1 - q0 - rate * frame) / frame / frame;
        for (int k = 0; k < 3; k++) {
            turn((double[3]){q0 * axis[0], 0, q0 * axis[2]}, unit_box.axis[k], c.axis[k]);
            c.spin[k] = rate * axis[k], c.spin_acceleration[k] = accel * axis[k];
        }
        set(s, &c, 1);
        run(s, SPRING_LEAPFROG, 1. / 480, 8);
        get(s, now, u);
        double there[3];
        turn((double[3]){q1 * axis[0], 0, q1 * axis[2]}, start, there);
        slip = fmax(slip, hypot(hypot(now[0] - there[0], now[1] - there[1]), now[2] - there[2]));
    }
    CHECK_BELOW(slip, in_double ? 1e-8 : 1e-3, "the slip in 20 s");
    free(s);
}

/* A platform with a constant acceleration, and one that is shaken with 4 m/s^2 where friction holds 4.41 m/s^2; set once
   per frame with velocity and acceleration. */
static void platforms(void)
{
    const double none[3] = {0}, g[3] = {0, -gravity, 0};
    for (int shaken = 0; shaken < 2; shaken++)
        for (int n = 4; n <= 64; n *= 4) {
            const double v[3] = {shaken ? 2 : 0.3, 0, 0};
            spring_scene *s = particle_at(none, v, g, 1);
            spring_collider c = unit_box;
            c.half[0] = 100, c.friction = 0.45, c.at[1] = -0.1;
            double slip = 0, now[3], u[3];
            for (int f = 0; f < (shaken ? 600 : 60); f++) {
                const double t = f * frame, t1 = t + frame;
                const double here = shaken ? sin(2 * t) : 0.3 * t + 2 * t * t, next = shaken ? sin(2 * t1) : 0.3 * t1 + 2 * t1 * t1;
                c.at[0] = here, c.velocity[0] = shaken ? 2 * cos(2 * t) : 0.3 + 4 * t;
                c.acceleration[0] = shaken ? 2 * (next - here - c.velocity[0] * frame) / frame / frame : 4;
                set(s, &c, 1);
                run(s, SPRING_LEAPFROG, frame / n, (uint64_t)n);
                get(s, now, u);
                slip = fmax(slip, fabs(now[0] - next));
            }
            CHECK_BELOW(slip, !in_double ? 1e-3 : shaken ? 1e-3 : 1e-12, "it is carried along");
            free(s);
        }
}

/* --------------------------------------------------------------------------------------------------------- friction */

static const double block_mu = 0.1, block_omega = 2 * PI;

/* A block on a spring, released at A: it moves on half waves about +- mu g/omega^2, until it sticks. */
static void block_exact(double A, double t, double *x, double *v)
{
    const double shift = block_mu * gravity / (block_omega * block_omega), half = PI / block_omega;
    double from = A;
    while (fabs(from) > shift && t >= half) {
        from = -(from - (from > 0 ? 2 : -2) * shift);
        t -= half;
    }
    const double centre = from > 0 ? shift : -shift;
    const bool sticks = fabs(from) <= shift;
    *x = sticks ? from : centre + (from - centre) * cos(block_omega * t);
    *v = sticks ? 0 : -block_omega * (from - centre) * sin(block_omega * t);
}

/* On a tilted plane, at rest or moving. */
static double block_error(spring_method m, double A, double end, double dt, bool moving)
{
    const double n[3] = {-sin(0.3), cos(0.3), 0}, velocity[3] = {3, 1, 2};
    double t[3] = {cos(0.3) * 0.8, sin(0.3) * 0.8, 0.6}, x[6], v[6], exact, rate;
    for (int a = 0; a < 3; a++) {
        x[a] = -10 * t[a], x[3 + a] = A * t[a];
        v[a] = v[3 + a] = moving ? velocity[a] : 0;
    }
    const uint8_t pinned[2] = {1, 0};
    const spring_link link = {0, 1, 10, 0.7 * block_omega * block_omega, 0};
    const spring_scene_def def = {.particles = 2,
                                  .position = x,
                                  .velocity = v,
                                  .pinned = pinned,
                                  .mass_all = 0.7,
                                  .links = 1,
                                  .link = &link,
                                  .gravity = {-gravity * n[0], -gravity * n[1], 0},
                                  .colliders = 1,
                                  .methods = 1u << m};
    spring_scene *s = scene_of(&def);
    spring_collider c = {.shape = SPRING_PLANE, .axis = {{n[0], n[1], n[2]}}, .friction = block_mu};
    memcpy(c.velocity, v, sizeof c.velocity);
    set(s, &c, 1);
    const uint64_t steps = (uint64_t)lround(end / dt);
    run(s, m, end / (double)steps, steps);
    block_exact(A, end, &exact, &rate);
    double now[3], u[3], side = 0;
    spring_scene_get(s, SPRING_POSITION, now, 0, 1, 1);
    spring_scene_get(s, SPRING_VELOCITY, u, 0, 1, 1);
    for (int a = 0; a < 3; a++)
        now[a] -= end * v[a], u[a] -= v[a];
    for (int a = 0; a < 3; a++)
        side = hypot(side, now[a] - dot(now, t) * t[a]);
    free(s);
    return hypot(dot(now, t) - exact, (dot(u, t) - rate) / block_omega) + side;
}

static void friction_across_reversals(void)
{
    for (int m = 0; m < method_count && in_double; m++)
        for (int reversals = 0; reversals <= 3; reversals++) {
            double error[2];
            for (int fine = 0; fine < 2; fine++) {
                double sum = 0;
                for (int k = 0; k < 16; k++)
                    sum += pow(block_error(with_contacts[m], 1 + 0.013 * k, 0.5 * reversals + 0.31,
                                           (fine ? 1. / 7680 : 1. / 480) * (1 + 0.03 * k), k % 2 == 1),
                               2);
                error[fine] = sqrt(sum / 16);
            }
            printf("# %d reversals: order %.2f\n", reversals, log2(error[0] / error[1]) / 4);
            CHECK(log2(error[0] / error[1]) / 4 >= 1.9, "second order, also after a reversal");
        }
}

/* Two planes that enclose an angle of 0.5 to 60 degrees: a particle that falls between them comes to rest, outside of both. */
static void grooves(void)
{
    static const double degrees[] = {60, 20, 4, 2, 0.5};
    for (int i = 0; i < 5; i++)
        for (int mu = 0; mu < 2; mu++)
            for (int m = 0; m < method_count; m++) {
                const double half = degrees[i] * PI / 360, x[3] = {0.3 * sin(half), 1, 0}, none[3] = {0}, g[3] = {0, -gravity, 0};
                spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{cos(half), sin(half), 0}}, .friction = 0.3 * mu},
                                        {.shape = SPRING_PLANE, .axis = {{-cos(half), sin(half), 0}}, .friction = 0.3 * mu}};
                spring_scene *s = particle_at(x, none, g, 2);
                set(s, c, 2);
                double inside = 0, now[3], v[3];
                for (int k = 0; k < 480 * 6; k++) {
                    run(s, with_contacts[m], 1. / 480, 1);
                    get(s, now, v);
                    for (int j = 0; j < 2; j++)
                        inside = fmax(inside, -dot(now, c[j].axis[0]));
                }
                CHECK_BELOW(inside, in_double ? 1e-14 : 1e-6, "inside");
                CHECK_BELOW(length(v), in_double ? 1e-12 : 1e-4, "at rest");
                CHECK(spring_scene_at_rest(s, 1e-3, 1e-3), "at rest");
                free(s);
            }
}

static const test tests[] = {
    {"a turned box hits", turned_box_hits},
    {"a bead on a turning plane", bead_on_turning_plane},
    {"turntable", turntable},
    {"rocking box", rocking_box},
    {"platforms", platforms},
    {"friction across reversals", friction_across_reversals},
    {"grooves", grooves},
};

int main(void)
{
    return RUN_TESTS("bodies", tests);
}
