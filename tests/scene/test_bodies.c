/* SPDX-License-Identifier: MIT */
/* Colliders as bodies: rigid motion, friction on them and across reversals, capsules that stretch, plates that hit, and
   radius, friction and mask of particles. */
#include "contact/closed_forms.h"
#include "test_contact.h"

#include <stdio.h>

/* ----------------------------------------------------------------------------------------------------- rigid motion */

typedef struct hit {
    double error, fastest;
    bool behind;
} hit;

/* A box of half thickness b turns about z through the origin and hits a particle at rest at (0.32, 0.24), without gravity
   or friction. Exact: after the impact it flies (e = 1), or slides out along the face, xi'' = omega^2 xi (e = 0). */
static hit bat(spring_method m, double omega, double b, double e, double dt, int every)
{
    const double x[3] = {0.32, 0.24, 0}, r = 0.4, theta = atan2(0.24, 0.32) - asin(b / r);
    const double at_hit = theta / omega, xi = sqrt(r * r - b * b), end = at_hit + (e > 0 ? 0.3 : 0.25) / omega;
    const int steps = (int)ceil(end / dt);
    spring_scene *s = particle_on(NULL, 1, x, none, none);
    spring_collider c = unit_box;
    c.half[0] = 0.5, c.half[1] = b, c.half[2] = 1, c.spin[2] = omega, c.restitution = e;
    hit h = {0};
    double now[3], v[3];
    for (int i = 0; i < steps; i++) {
        const double a = omega * end * i / steps;
        if (i % every == 0) {
            turned_axes((double[]){0, 0, a}, c.axis);
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
    for (int m = 0; m < second_order; m++)
        for (int thin = 0; thin < 2; thin++)
            for (int i = 0; i < 6; i++) {
                const hit h = bat(contact_methods[m], omega[i], thin ? 0.01 : 0.05, 0, 1. / 960, 16);
                CHECK(!h.behind, "it stays in front of the box");
                CHECK(h.fastest >= omega[i] * 0.4, "at least as fast as the surface");
            }
    for (int m = 0; m < second_order && in_double; m++)
        for (int e = 0; e < 2; e++) {
            double error[2];
            for (int fine = 0; fine < 2; fine++) {
                double sum = 0;
                for (int k = 0; k < 8; k++)
                    sum += pow(
                        bat(contact_methods[m], 10, 0.05, e, (fine ? 1. / 7680 : 1. / 240) * (1 + 0.05 * k), 1 << 20)
                            .error,
                        2);
                error[fine] = sqrt(sum / 8);
            }
            CHECK(log2(error[0] / error[1]) / 5 >= 1.9, "second order");
        }
}

/* A bead on a plane that turns about z through the origin. */
static void bead_on_turning_plane(void)
{
    const double omega = 2, rho = 0.3, speed = 2.5, end = 0.7;
    const double x[3] = {rho, 0, 0}, v[3] = {speed, omega * rho, 0};
    const spring_collider c = {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .spin = {0, 0, omega}};
    for (int m = 0; m < second_order && in_double; m++) {
        double error[2], now[3], u[3];
        for (int fine = 0; fine < 2; fine++) {
            const uint64_t steps = fine ? 2240 : 70;
            end_of(particle_on(&c, 1, x, v, down), contact_methods[m], end / (double)steps, steps, now, u);
            error[fine] = distance_on_turning_plane(omega, rho, speed, end, now);
        }
        CHECK(log2(error[0] / error[1]) / 5 >= 1.9, "second order");
    }
}

/* Static friction on a turntable of 3 rad/s, for 100 s. */
static void turntable(void)
{
    const double omega = 3, x[3] = {0.5, 0, 0}, v[3] = {0, 0, -omega * 0.5};
    for (int kind = 0; kind < 2; kind++)
        for (int n = 4; n <= 64; n *= 4)
            for (int once = 0; once < 2; once++) {
                spring_scene *s = particle_on(NULL, 1, x, v, down);
                spring_collider c = unit_box;
                c.at[1] = -0.1;
                if (kind == 0)
                    c = ground;
                c.friction = 0.8, c.spin[1] = omega;
                double off = 0, now[3], u[3];
                for (int f = 0; f < 6000; f++) {
                    if (kind == 1 && !once)
                        turned_axes((double[]){0, omega * f * frame, 0}, c.axis);
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
    const double axis[3] = {0.9 / sqrt(1.06), 0, 0.5 / sqrt(1.06)}, start[3] = {0.2, 0.1, 0.1};
    double v[3], now[3], u[3], slip = 0;
    cross((double[3]){0.7 * axis[0], 0, 0.7 * axis[2]}, start, v);
    spring_scene *s = particle_on(NULL, 1, start, v, down);
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
        slip = fmax(slip, distance(now, there));
    }
    CHECK_BELOW(slip, in_double ? 1e-8 : 1e-3, "the slip in 20 s");
    free(s);
}

/* A platform with a constant acceleration, and one that is shaken with 4 m/s^2 where friction holds 4.41 m/s^2; set once
   per frame with velocity and acceleration. */
static void platforms(void)
{
    for (int shaken = 0; shaken < 2; shaken++)
        for (int n = 4; n <= 64; n *= 4) {
            const double v[3] = {shaken ? 2 : 0.3, 0, 0};
            spring_scene *s = particle_on(NULL, 1, none, v, down);
            spring_collider c = unit_box;
            c.half[0] = 100, c.friction = 0.45, c.at[1] = -0.1;
            double slip = 0, now[3], u[3];
            for (int f = 0; f < (shaken ? 600 : 60); f++) {
                const double t = f * frame, t1 = t + frame;
                const double here = shaken ? sin(2 * t) : 0.3 * t + 2 * t * t,
                             next = shaken ? sin(2 * t1) : 0.3 * t1 + 2 * t1 * t1;
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

/* A lift that starts at 1 m/s, whose velocity the program does not know. The collider follows it as at
   spring_scene_set_colliders(), and a particle stays on it. */
static void lift(void)
{
    spring_scene *s = particle_on(NULL, 1, none, none, down);
    spring_collider c = unit_box;
    uint32_t count = 1, touched = 0;
    double now[3], u[3];
    c.half[0] = 100, c.at[1] = -0.1;
    set(s, &c, 1);
    for (int f = 0; f < 60; f++) {
        const double next = -0.1 + (f < 10 ? 0 : (f - 9) * frame);
        spring_scene_get_colliders(s, &c, &count);
        c.acceleration[1] = 16.0 / 9 * (next - c.at[1] - c.velocity[1] * frame) / frame / frame;
        set(s, &c, 1);
        run(s, SPRING_LEAPFROG, frame / 16, 16);
    }
    spring_scene_get_colliders(s, &c, &count);
    get(s, now, u);
    spring_scene_touching(s, &touched, 0, 1);
    CHECK_CLOSE(c.at[1], -0.1 + 50 * frame, 1e-9, "the collider is where the lift is");
    CHECK_CLOSE(c.velocity[1], 1, 1e-9, "and as fast");
    CHECK_CLOSE(u[1], 1, in_double ? 1e-9 : 1e-5, "and so is the particle");
    CHECK(touched == 1, "which stands on it");
    free(s);
}

/* The friction of a spinning ball on a particle that lands on it does not depend on a common velocity. */
static void spinning_ball_in_motion(void)
{
    double now[2][3], u[3];
    for (int moving = 0; moving < 2; moving++) {
        const double V = 20 * moving, x[3] = {0, 1.008, 0}, v[3] = {0, V - 4, 0}, g[3] = {0, -1000, 0};
        const spring_collider c = {
            .shape = SPRING_SPHERE, .radius = 1, .spin = {0, 0, 2}, .friction = 1.4, .velocity = {0, V, 0}};
        end_of(particle_on(&c, 1, x, v, g), SPRING_LEAPFROG, 1. / 240, 1, now[moving], u);
    }
    CHECK_CLOSE(now[1][0], now[0][0], 64 * EPS * fabs(now[0][0]), "rounding of positions of 1 m");
}

/* A capsule becomes longer or shorter along its own axis, from, to or through the length 0. It hits like one that turns. */
static void capsules_that_stretch(void)
{
    double inside = 0;
    const size_t cases = random_cases(2000);
    size_t hits = 0;
    for (size_t i = 0; i < cases; i++) {
        const double dt = 1. / 240, length_0 = random_bits() % 3 == 0 ? 0 : random_uniform(-0.5, 0.5);
        double along[3], x[3], now[3], v[3];
        spring_collider c = {.shape = SPRING_CAPSULE, .radius = 0.1, .friction = random_uniform(0, 1)};
        random_unit(along, 3);
        const double speed = random_uniform(-30, 30), ahead = random_uniform(-0.8, 0.8);
        for (int a = 0; a < 3; a++) {
            c.to[a] = length_0 * along[a];
            c.velocity_to[a] = speed * along[a];
            x[a] = ahead * along[a] + random_uniform(-0.08, 0.08);
        }
        if (gap_of(&c, 0, x, 3) < 1e-3)
            continue;
        spring_scene *s = particle_on(&c, 1, x, none, none);
        for (int k = 0; k < 8; k++) {
            uint32_t count = 1;
            run(s, contact_methods[i % 2], dt, 1);
            get(s, now, v);
            spring_scene_get_colliders(s, &c, &count);
            inside = fmax(inside, -gap_of(&c, 0, now, 3));
            hits += length(v) > 0;
        }
        free(s);
    }
    CHECK(hits > cases / 4, "capsules hit");
    CHECK_BELOW(inside, 8 * 5 * EPS, "inside: 8 eps (|x| + |at| + size)");
}

/* A wall that starts to move hits the particle that rests on it: (1 + e) V. A plate stops it. */
static void hit_from_rest(void)
{
    const double x[3] = {0.3, 0.1, -0.2}, e = 0.5, speed = 2;
    spring_collider both[2] = {unit_box, unit_box};
    both[0].restitution = e, both[0].velocity[1] = speed;
    double now[3], v[3];
    end_of(particle_on(both, 1, x, none, none), SPRING_LEAPFROG, 0.01, 3, now, v);
    CHECK_CLOSE(v[1], (1 + e) * speed, 8 * EPS * speed, "the velocity after an impact");
    CHECK_CLOSE(now[1], x[1] + 0.03 * v[1], 8 * EPS, "from the start of the step");
    /* On its new path there is a thin plate, which is far from the path without the wall. */
    const double below = 0.125;
    both[1].at[1] = below + 0.001, both[1].half[1] = 0.001, both[1].restitution = e;
    const double skin = 32 * EPS * (both[1].at[1] + both[1].half[0] + both[1].half[1] + both[1].half[2]);
    end_of(particle_on(both, 2, (double[]){x[0], x[1] + skin, x[2]}, none, none), SPRING_LEAPFROG, 0.01, 1, now, v);
    CHECK(now[1] <= below + 8 * EPS, "not through the plate");
    CHECK(v[1] <= 0, "nor toward it");
}

/* A particle that lands without restitution or friction on the end of a capsule that becomes shorter stays on it. */
static void lands_on_an_end(void)
{
    const double x[3] = {0.603, 0.807, 0}, v[3] = {0.827, -1.248, 0};
    const spring_collider c = {.shape = SPRING_CAPSULE,
                               .at = {0.166, -0.121, 0},
                               .to = {0.817, 0.302, 0},
                               .radius = 0.321,
                               .velocity = {0.519, 0.492, 0},
                               .velocity_to = {-0.796, 0.492, 0}};
    double speed[3] = {0}, now[3];
    for (int k = 0; k < 3; k++) {
        const int rate = 480 << 2 * k;
        int landings = 0;
        uint32_t touches = 0, before = 0;
        spring_scene *s = particle_on(&c, 1, x, v, down);
        for (int i = 0; i < 2 * rate / 5; i++, before = touches) {
            run(s, SPRING_LEAPFROG, 1. / rate, 1);
            spring_scene_touching(s, &touches, 0, 1);
            landings += touches != 0 && before == 0;
        }
        spring_scene_get(s, SPRING_VELOCITY, now, 0, 0, 1);
        speed[k] = now[1];
        CHECK(landings == 1, "it lands once");
        free(s);
    }
    CHECK_BELOW(fabs(speed[0] - speed[2]), 2e-4 + 1e4 * EPS, "v, of second order: (g dt)^2/|v| is 3e-4");
    CHECK_BELOW(fabs(speed[1] - speed[2]), 2e-4 / 8 + 1e4 * EPS, "about 16 times as small");
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

/* On a tilted plane, at rest or moving; the plane may be a custom body. */
static double block_error(spring_method m, double A, double end, double dt, bool moving, bool custom)
{
    faces tilted = {1, {{-sin(0.3), cos(0.3), 0}}};
    const double *const n = tilted.normal[0], velocity[3] = {3, 1, 2};
    double t[3] = {cos(0.3) * 0.8, sin(0.3) * 0.8, 0.6}, x[6], v[6], exact, rate;
    for (int a = 0; a < 3; a++) {
        x[a] = -10 * t[a], x[3 + a] = A * t[a];
        v[a] = v[3 + a] = moving ? velocity[a] : 0;
    }
    const uint8_t pinned[2] = {1, 0};
    const spring_link link = {.a = 0, .b = 1, .rest = 10, .stiffness = 0.7 * block_omega * block_omega};
    spring_scene_def def = falling(2, x, v, 0.7);
    def.pinned = pinned, def.links = 1, def.link = &link;
    spring_collider c = {.shape = SPRING_PLANE, .axis = {{n[0], n[1], n[2]}}, .friction = block_mu};
    if (custom)
        c = (spring_collider){
            .shape = SPRING_CUSTOM, .gap = gaps_of_faces, .user = &tilted, .thickness = 1, .friction = block_mu};
    for (int a = 0; a < 3; a++)
        c.velocity[a] = v[a], def.gravity[a] = -gravity * n[a];
    spring_scene *s = scene_with(&def, &c);
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
    for (int m = 0; m < second_order && in_double; m++)
        for (int reversals = 0; reversals <= 3; reversals++) {
            double error[2];
            for (int fine = 0; fine < 2; fine++) {
                double sum = 0;
                for (int k = 0; k < 16; k++)
                    sum += pow(block_error(contact_methods[m], 1 + 0.013 * k, 0.5 * reversals + 0.31,
                                           (fine ? 1. / 7680 : 1. / 480) * (1 + 0.03 * k), k % 2 == 1, k % 4 > 1),
                               2);
                error[fine] = sqrt(sum / 16);
            }
            printf("# %d reversals: order %.2f\n", reversals, log2(error[0] / error[1]) / 4);
            CHECK(log2(error[0] / error[1]) / 4 >= 1.9, "second order, also after a reversal");
        }
}

/* ------------------------------------------------------------------------------------------------------- tunnelling */

/* A plate 2 b thick flies through a cloud at up to 500 m/s and turns by up to 0.2 rad in a step. */
static void plates(spring_method m, double thick, double speed, double angle, double dt, size_t *contacts,
                   size_t *through, size_t *around)
{
    enum { count = 40 };
    double x[count][3], v[count][3], radius[count], velocity[3], spin[3];
    spring_collider c = {
        .shape = SPRING_BOX, .half = {thick / 2, random_uniform(0.3, 1), random_uniform(0.3, 1)}, .friction = 0.3};
    random_axes(c.axis);
    random_unit(velocity, 3);
    random_unit(spin, 3);
    const double fast = speed * random_uniform(0, 1), turning = angle / dt * random_uniform(0, 1);
    for (int a = 0; a < 3; a++)
        c.velocity[a] = fast * velocity[a], c.spin[a] = turning * spin[a];
    for (int i = 0; i < count; i++) {
        double target[3], direction[3];
        radius[i] = i % 2 ? 0.005 : 0;
        do {
            random_unit(target, 3);
            random_unit(direction, 3);
            const double far = 0.8 * random_uniform(0, 1), u = 0.3 * speed * random_uniform(0, 1) + 1;
            for (int a = 0; a < 3; a++) {
                v[i][a] = u * direction[a];
                x[i][a] = far * target[a] + 10 * dt * (c.velocity[a] - v[i][a]);
            }
        } while (gap_of(&c, 0, x[i], 3) < 0.01);
    }
    spring_scene_def def = falling(count, x[0], v[0], 0.4);
    def.radius = radius;
    spring_scene *s = scene_with(&def, &c);
    double before[count][3] = {{0}};
    for (int k = 0; k < 60; k++) {
        uint32_t touched[count];
        double phi[3];
        run(s, m, dt, 1);
        spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, count);
        spring_scene_touching(s, touched, 0, count);
        for (int a = 0; a < 3; a++)
            phi[a] = -(k + 1) * dt * c.spin[a];
        for (int i = 0; i < count; i++) {
            double from[3], back[3], y[3];
            for (int a = 0; a < 3; a++)
                from[a] = x[i][a] - (k + 1) * dt * c.velocity[a];
            turn(phi, from, back);
            for (int a = 0; a < 3; a++)
                y[a] = dot(back, c.axis[a]);
            *contacts += touched[i] != 0;
            if (k > 0 && before[i][0] * y[0] < 0) { /* another side: where? */
                const double f = before[i][0] / (before[i][0] - y[0]), *const old = before[i];
                const double edge = in_double ? 1e-9 : 1e-3; /* not on the sides */
                const bool inside = fabs(old[1] + f * (y[1] - old[1])) < c.half[1] - edge &&
                                    fabs(old[2] + f * (y[2] - old[2])) < c.half[2] - edge;
                const bool begins = fabs(old[1]) < c.half[1] - edge && fabs(old[2]) < c.half[2] - edge;
                const bool ends = fabs(y[1]) < c.half[1] - edge && fabs(y[2]) < c.half[2] - edge;
                *through += begins && ends;
                *around += inside && !(begins && ends);
            }
            memcpy(before[i], y, sizeof y);
        }
    }
    free(s);
}

static void no_tunnelling(void)
{
    static const spring_method methods[] = {SPRING_LEAPFROG, SPRING_RK4, SPRING_SYMPLECTIC_EULER};
    size_t contacts = 0, through = 0, around = 0;
    const size_t wanted = getenv("CONTACTS") != NULL ? (size_t)atol(getenv("CONTACTS")) : random_cases(20000);
    for (int i = 0; contacts < wanted; i++)
        plates(methods[i / 6 % 3], i % 2 ? 0.1 : 0.002, i % 2 ? 500 : 100, i % 3 ? 0.2 : 0.05, 1. / 480, &contacts,
               &through, &around);
    printf("# %zu contacts, %zu through a face, %zu around an edge in a step\n", contacts, through, around);
    CHECK(through == 0, "none passes through a face");
}

/* A particle bounces between two plates that close on each other almost face to face. While it fits between them, nothing
   makes it faster than its impacts. */
static void closing_plates(void)
{
    double fastest = 0;
    for (int i = 0; i < 8; i++)
        for (int e = 0; e <= 4; e++) {
            const double tilt = 0.04 * pow(0.1, i), x[3] = {0.01, 0, 0}, v[3] = {0, 10, 0};
            spring_collider c[2] = {unit_box, unit_box};
            double now[3], u[3];
            for (int k = 0; k < 2; k++) {
                const double side = k == 0 ? 1 : -1;
                turned_axes((double[]){0, 0, side * tilt / 2}, c[k].axis);
                c[k].at[1] = -side * 0.11, c[k].velocity[1] = side, c[k].restitution = 0.2 * e;
            }
            end_of(particle_on(c, 2, x, v, none), SPRING_LEAPFROG, 1. / 240, 1, now, u);
            fastest = fmax(fastest, length(u));
        }
    CHECK_BELOW(fastest, 12, "speed: 10 m/s, and at most twice the 1 m/s of a plate by an impact");
}

/* ---------------------------------------------------------------------------------------- radius, friction and mask */

static void values_of_particles(void)
{
    enum { count = 40 };
    double x[count][3] = {{0}}, radius[count], friction[count];
    uint32_t mask[count];
    for (int i = 0; i < count; i++) {
        x[i][0] = i, x[i][1] = 0.5;
        radius[i] = 0.01 * i, friction[i] = 0.25 * (i % 4), mask[i] = (uint32_t)i % 4;
    }
    const double tilt = 0.3, a = gravity * sin(tilt), b = gravity * cos(tilt);
    spring_scene_def def = falling(count, x[0], NULL, 2);
    def.gravity[1] = -b, def.gravity[2] = a;
    def.colliders = 2, def.radius = radius, def.friction = friction, def.mask = mask;
    const spring_collider c[2] = {
        {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .friction = 0.4, .mask = 1},
        {.shape = SPRING_PLANE, .at = {0, -1, 0}, .axis = {{0, 1, 0}}, .friction = 0.4, .mask = 2},
    };
    spring_scene *s = scene_with(&def, c);
    run(s, SPRING_LEAPFROG, 1. / 240, 480);
    for (size_t i = 0; i < count; i++) {
        double now[3], v[3];
        spring_scene_get(s, SPRING_POSITION, now, 0, i, 1);
        spring_scene_get(s, SPRING_VELOCITY, v, 0, i, 1);
        if (mask[i] == 0) {
            CHECK(now[1] < -5, "it never collides");
            continue;
        }
        CHECK_CLOSE(now[1], radius[i] - (mask[i] & 1 ? 0 : 1), 1e3 * EPS, "on the plane that it collides with");
        const double mu = 0.4 * friction[i]; /* 0.2 and more does not hold: tan 0.3 = 0.31 */
        CHECK(v[2] > 0 && (mu > 0 || fabs(v[2] - 2 * a) < 1e-3), "it slides");
    }
    free(s);
}

static const test tests[] = {
    {"a turned box hits", turned_box_hits},
    {"a bead on a turning plane", bead_on_turning_plane},
    {"turntable", turntable},
    {"rocking box", rocking_box},
    {"platforms", platforms},
    {"a lift that starts", lift},
    {"spinning ball in motion", spinning_ball_in_motion},
    {"capsules that stretch", capsules_that_stretch},
    {"a hit from rest", hit_from_rest},
    {"lands on an end", lands_on_an_end},
    {"friction across reversals", friction_across_reversals},
    {"no tunnelling", no_tunnelling},
    {"closing plates", closing_plates},
    {"radius, friction and mask", values_of_particles},
};

int main(void)
{
    return RUN_TESTS("bodies", tests);
}
