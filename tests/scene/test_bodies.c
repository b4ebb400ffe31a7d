/* SPDX-License-Identifier: MIT */
/* Colliders as bodies: rigid motion, static friction on them, friction across reversals, grooves, impulses, masks, radii,
   and bodies of any form. */
#include "contact/closed_forms.h"
#include "test_contact.h"

#include <stdio.h>

static const double frame = 1. / 60;

static const spring_method with_contacts[] = {SPRING_LEAPFROG, SPRING_RK4};
enum { method_count = 2 };

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
                    sum +=
                        pow(bat(with_contacts[m], 10, 0.05, e, (fine ? 1. / 7680 : 1. / 240) * (1 + 0.05 * k), 1 << 20)
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
    for (int m = 0; m < method_count && in_double; m++) {
        double error[2], now[3], u[3];
        for (int fine = 0; fine < 2; fine++) {
            const uint64_t steps = fine ? 2240 : 70;
            end_of(particle_on(&c, 1, x, v, down), with_contacts[m], end / (double)steps, steps, now, u);
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

/* A custom body: the half-spaces below planes through the origin, with a contact for each. */
typedef struct faces {
    uint32_t count;
    double normal[3][3];
} faces;

static uint32_t gaps_of_faces(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const faces *f = user;
    memcpy(normal, f->normal, sizeof f->normal);
    for (uint32_t k = 0; k < f->count; k++)
        gap[k] = dot(f->normal[k], y);
    return f->count;
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
    for (int m = 0; m < method_count && in_double; m++)
        for (int reversals = 0; reversals <= 3; reversals++) {
            double error[2];
            for (int fine = 0; fine < 2; fine++) {
                double sum = 0;
                for (int k = 0; k < 16; k++)
                    sum += pow(block_error(with_contacts[m], 1 + 0.013 * k, 0.5 * reversals + 0.31,
                                           (fine ? 1. / 7680 : 1. / 480) * (1 + 0.03 * k), k % 2 == 1, k % 4 > 1),
                               2);
                error[fine] = sqrt(sum / 16);
            }
            printf("# %d reversals: order %.2f\n", reversals, log2(error[0] / error[1]) / 4);
            CHECK(log2(error[0] / error[1]) / 4 >= 1.9, "second order, also after a reversal");
        }
}

/* Two planes that enclose an angle of 2 half. */
static void make_groove(double half, double friction, spring_collider c[2])
{
    for (int k = 0; k < 2; k++)
        c[k] = (spring_collider){
            .shape = SPRING_PLANE, .axis = {{k ? -cos(half) : cos(half), sin(half), 0}}, .friction = friction};
}

/* Two planes that enclose an angle of 0.5 to 60 degrees: a particle that falls between them comes to rest, outside of both.
   If they close in on a particle, they push it out. */
static void grooves(void)
{
    static const double degrees[] = {60, 20, 4, 2, 0.5};
    enum { closing = 2 }; /* others: friction or none */
    for (int i = 0; i < 5; i++)
        for (int how = 0; how <= closing; how++)
            for (int m = 0; m < method_count; m++) {
                const double half = degrees[i] * PI / 360;
                const double x[3] = {how == closing ? 0 : 0.3 * sin(half), 1, 0};
                const double toward = how == closing ? 0.02 * sin(half) : 0; /* [m/s] the corner rises by 0.02 m/s */
                double inside = 0, now[3], v[3];
                spring_collider c[2];
                make_groove(half, how == 1 ? 0.3 : 0, c);
                for (int k = 0; k < 2; k++)
                    for (int a = 0; a < 3; a++)
                        c[k].velocity[a] = toward * c[k].axis[0][a];
                spring_scene *s = particle_on(c, 2, x, none, down);
                for (int k = 1; k <= 480 * 6; k++) {
                    run(s, with_contacts[m], 1. / 480, 1);
                    get(s, now, v);
                    for (int j = 0; j < 2; j++)
                        inside = fmax(inside, k / 480. * toward - dot(now, c[j].axis[0]));
                }
                CHECK_BELOW(inside, in_double ? 1e-14 : 1e-6, "inside");
                CHECK_BELOW(length(v), how == closing ? 0.02 + gravity / 480 : in_double ? 1e-12 : 1e-4, "at rest");
                CHECK(how == closing || spring_scene_at_rest(s, 1e-3, 1e-3), "at rest");
                free(s);
            }
}

/* Two planes that enclose 90 to 165 degrees, without friction: after a minute, a particle is at most as fast as scene.h
   says. */
static void wide_grooves(void)
{
    double fastest = 0; /* in units of g dt */
    for (int i = 0; i < 60; i++) {
        const double half = random_uniform(90, 165) * PI / 360, dt = random_log(1. / 960, 1. / 60);
        const double x[3] = {random_uniform(-0.4, 0.4), 0.5, 0};
        spring_collider c[2];
        make_groove(half, 0, c);
        spring_scene *s = particle_on(c, 2, x, none, down);
        run(s, SPRING_LEAPFROG, dt, (uint64_t)(60 / dt));
        for (int k = 0; k < 200; k++) {
            double now[3], v[3];
            run(s, SPRING_LEAPFROG, dt, 1);
            get(s, now, v);
            fastest = fmax(fastest, length(v) / (gravity * dt));
        }
        free(s);
    }
    CHECK_BELOW(fastest, 2, "speed in a wide groove, in units of g dt: spring_scene_set_colliders()");
}

/* A particle starts inside several bodies that overlap, as a cape at the joints of a figure. It is moved out of all of them,
   to the surface of their union if there are two. */
static void inside_several(void)
{
    const size_t cases = random_cases(4000);
    double inside = 0, outside[2] = {0}; /* of two and of more bodies */
    size_t tried = 0;
    for (size_t i = 0; i < cases; i++) {
        spring_collider c[4];
        const uint32_t count = 2 + (uint32_t)(random_bits() % 3);
        for (uint32_t k = 0; k < count; k++) {
            const spring_collider body = random_collider(3);
            c[k] = (spring_collider){.shape = body.shape, .radius = body.radius, .friction = body.friction};
            if (body.shape == SPRING_CUSTOM || (body.shape == SPRING_PLANE && k > 0)) /* two planes may meet far away */
                c[k].shape = SPRING_CAPSULE;
            memcpy(c[k].at, body.at, sizeof body.at);
            memcpy(c[k].to, body.to, sizeof body.to);
            memcpy(c[k].axis, body.axis, sizeof body.axis);
            memcpy(c[k].half, body.half, sizeof body.half);
            if (k > 0 && random_bits() % 4 == 0)
                c[k] = c[0];
        }
        double x[3], now[3], v[3], deep[2] = {0}, least = INFINITY;
        for (int a = 0; a < 3; a++)
            x[a] = random_uniform(-0.5, 0.5);
        for (uint32_t k = 0; k < count; k++) {
            const double depth = -gap_of(&c[k], 0, x, 3);
            deep[1] = fmax(deep[1], fmin(depth, deep[0]));
            deep[0] = fmax(deep[0], depth);
        }
        if (!(deep[1] > 0))
            continue;
        tried++;
        end_of(particle_on(c, count, x, none, none), with_contacts[i % 2], frame, 1, now, v);
        for (uint32_t k = 0; k < count; k++)
            least = fmin(least, gap_of(&c[k], 0, now, 3));
        inside = fmax(inside, -least);
        outside[count > 2] = fmax(outside[count > 2], least / deep[0]);
    }
    CHECK(tried > cases / 8, "particles inside two bodies");
    CHECK_BELOW(inside, 8 * 5 * EPS, "inside a body: 8 eps (|x| + |at| + size)");
    CHECK_BELOW(outside[0], 0.01, "distance from both bodies, in units of the depth before");
    CHECK_BELOW(outside[1], 1, "distance from all bodies: passes of item 5 move it by up to the depth");
}

/* A ball comes down on a particle on the floor and stops where the particle does not fit between them. In no step is the
   particle moved farther than by a third beyond the nearest place where it fits. */
static void between_closing_bodies(void)
{
    static const double offsets[] = {0, 1e-6, 1e-4, 2e-3, 0.03};
    const double radius = 0.25, r = 0.01, end_gap = 0.005;
    const double fits = sqrt(pow(radius + r, 2) - pow(radius + end_gap - r, 2)); /* [m] from the axis */
    double farthest = 0;
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 6; k++) {
            const double speed = (const double[]){0.5, 2, 5}[k / 2], dt = k % 2 ? 1. / 960 : 1. / 240;
            const double x[3] = {offsets[i], r, 0};
            spring_collider c[2] = {ground, {.shape = SPRING_SPHERE, .radius = radius, .friction = 0.3}};
            c[0].friction = 0.5, c[1].at[1] = radius + end_gap + 0.05, c[1].velocity[1] = -speed;
            spring_scene *s = ball_on(c, 2, x, none, down, r);
            double before[3], now[3], v[3];
            for (int n = 0; n < (int)(0.05 / speed / dt); n++) {
                get(s, before, v);
                run(s, SPRING_LEAPFROG, dt, 1);
                get(s, now, v);
                if (hypot(before[0], before[2]) < fits)
                    farthest = fmax(farthest, hypot(now[0], now[2]) - length(v) * dt);
            }
            free(s);
        }
    CHECK_BELOW(farthest / fits, 4. / 3, "distance from the axis after a step, in units of that of the nearest place");
}

/* A particle that a force presses into the crevice between two round bodies slides along it: its velocity is that of its
   motion. */
static void crevice_of_round_bodies(void)
{
    const double dt = 1e-3;
    double worst = 0;
    const size_t cases = random_cases(1000);
    for (size_t i = 0; i < cases; i++) {
        const double friction = random_bits() % 3 ? 0 : random_uniform(0.1, 1), speed = random_uniform(-0.3, 0.3),
                     radius[2] = {0.2, random_uniform(0.05, 0.3)},
                     between = radius[0] + radius[1] - random_uniform(0.001, 0.05);
        const double along = (between + (pow(radius[0], 2) - pow(radius[1], 2)) / between) / 2;
        const double x[3] = {along, 0, sqrt(pow(radius[0], 2) - along * along)};
        const double pull = random_log(1, 1e5);
        const double g[3] = {pull * random_uniform(-0.3, 0.3), pull * random_uniform(-0.5, 0.5), -pull};
        spring_collider c[2] = {
            {.radius = radius[0], .friction = friction},
            {.radius = radius[1], .friction = friction, .at = {between, 0, 0}, .velocity = {speed, 0, 0}}};
        c[0].shape = c[1].shape = SPRING_SPHERE;
        if (random_bits() % 2) {
            c[0].shape = SPRING_CAPSULE;
            c[0].at[1] = -1;
            c[0].to[1] = 1;
        }
        spring_scene *s = particle_on(c, 2, x, none, g);
        double before[3], now[3], v[3];
        for (int n = 0; n < 60; n++) {
            get(s, before, v);
            run(s, with_contacts[i % 2], dt, 1);
            get(s, now, v);
            if (n > 4)
                worst =
                    fmax(worst, length(v) / (distance(now, before) / dt + length(g) * dt + fabs(speed) + 8 * EPS / dt));
        }
        free(s);
    }
    CHECK_BELOW(worst, 1, "velocity, in units of that of the motion, of the change in a step, and of the body");
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
            run(s, with_contacts[i % 2], dt, 1);
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

/* -------------------------------------------------------------------------------------------------------- tunnelling */

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

/* ---------------------------------------------------------------------------------------------------------- impulses */

/* A random scene, whose forces have no moment except for gravity, on random colliders: what particles lose, colliders
   get, with friction, too. */
static void balance(spring_method method, uint32_t axes, double *worst)
{
    enum { steps = 40, most_bodies = 3 };
    static model m;
    const double h = 0.004;
    build(&m, (const uint32_t[]){5, 4, axes - 1}, axes,
          (unsigned)random_bits() % feature_masks & ~(unsigned)(PINNED | DRAG));
    if (method == SPRING_RK4)
        m.def.links = 0; /* links act at the stages */
    const bool heavy = method == SPRING_LEAPFROG && m.link[0].damping > 0 && random_bits() % 2 == 0;
    for (size_t i = 0; i < m.def.links && heavy; i++)
        m.link[i].damping *= 1000; /* the exponential kick */
    m.def.colliders = 1 + (uint32_t)(random_bits() % most_bodies);
    m.def.particle_radius = 0.02;
    m.def.methods = 1u << method;
    spring_collider c[most_bodies];
    for (uint32_t i = 0; i < m.def.colliders; i++)
        c[i] = random_collider(axes);
    spring_scene *s = scene_with(&m.def, c);
    double gravity_of[3] = {0}, given[3] = {0}, turned[3] = {0}, size = 0;
    memcpy(gravity_of, m.def.gravity, axes * sizeof *gravity_of);
    const momenta first = momenta_of(&m, s);
    momenta last = first;
    for (int k = 0; k < steps; k++) {
        const momenta before = last;
        spring_impulse j[most_bodies];
        uint32_t count = most_bodies;
        run(s, method, h, 1);
        CHECK(spring_scene_impulses(s, j, 0, m.def.colliders) == SPRING_OK, "impulses");
        CHECK(spring_scene_get_colliders(s, c, &count) == SPRING_OK, "the points that impulses are about");
        last = momenta_of(&m, s);
        size += last.size;
        double middle[3], moment[3];
        /* where gravity acts: at the start, at both ends, or in the middle before contacts */
        for (int a = 0; a < 3; a++)
            middle[a] = method == SPRING_SYMPLECTIC_EULER     ? before.place[a]
                        : method == SPRING_LEAPFROG && !heavy ? (before.place[a] + last.place[a]) / 2
                                                              : before.place[a] + h / 2 * before.linear[a];
        cross(middle, gravity_of, moment);
        for (int a = 0; a < 3; a++)
            given[a] -= h * before.mass * gravity_of[a], turned[a] -= h * moment[a];
        for (uint32_t i = 0; i < count; i++) {
            cross(c[i].at, j[i].linear, moment);
            for (int a = 0; a < 3; a++)
                given[a] += j[i].linear[a], turned[a] += j[i].angular[a] + moment[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        *worst = fmax(*worst, fabs(last.linear[a] - first.linear[a] + given[a]) / size);
        *worst = fmax(*worst, fabs(last.angular[a] - first.angular[a] + turned[a]) / size);
    }
    free(s);
}

static void momentum_balance(void)
{
    static const spring_method of[] = {SPRING_LEAPFROG, SPRING_SYMPLECTIC_EULER, SPRING_RK4};
    for (int m = 0; m < 3; m++) {
        double worst = 0;
        for (int k = 0; k < 100; k++)
            balance(of[m], 2 + (uint32_t)k % 2, &worst);
        printf("# method %d: off by %.1e of the sum of m |v| (1 + |x|) over all steps\n", (int)of[m], worst);
        CHECK_BELOW(worst, in_double ? 1e-11 : 1e-5, "rounding errors, which narrow corners amplify");
    }
}

/* The loop of docs/games.md: a ball of mass M takes the impulses of `count` particles, m in total, after each call. The
   speed of the ball is the last one known, so energy is not conserved: its ratio to the right one, minus 1. */
static double coupled(int count, double ratio, double e)
{
    double x[64][3] = {{0}}, v[64][3] = {{0}};
    const double M = 5, m = ratio * M / count;
    for (int i = 0; i < count; i++) /* beams along x, that hit at different times */
        x[i][0] = -0.5 - 0.3 * i / count, v[i][0] = 3;
    const double P0 = count * m * 3, E0 = P0 * 3 / 2;
    spring_scene_def def = falling((size_t)count, x[0], v[0], m);
    def.gravity[1] = 0;
    spring_collider c = {.shape = SPRING_SPHERE, .radius = 0.1, .restitution = e};
    spring_scene *s = scene_of(&def);
    for (int f = 0; f < 60; f++) {
        spring_impulse j;
        set(s, &c, 1);
        run(s, SPRING_LEAPFROG, 1. / 480, 8);
        spring_scene_impulses(s, &j, 0, 1);
        for (int a = 0; a < 3; a++) {
            c.at[a] += 8. / 480 * c.velocity[a];
            c.velocity[a] += j.linear[a] / M;
        }
    }
    spring_scene_get(s, SPRING_VELOCITY, v[0], 0, 0, (size_t)count);
    double P1 = M * c.velocity[0], E1 = M * dot(c.velocity, c.velocity) / 2;
    for (int i = 0; i < count; i++)
        P1 += m * v[i][0], E1 += m * dot(v[i], v[i]) / 2;
    free(s);
    CHECK_BELOW(fabs(P1 / P0 - 1), in_double ? 1e-11 : 1e-5, "momentum is conserved");
    return E1 / E0;
}

static void coupling(void)
{
    for (int many = 0; many < 2; many++)
        for (int e = 0; e < 3; e++)
            for (int k = 0; k < 5; k++) {
                const double ratio[] = {0.01, 0.05, 0.2, 0.5, 1};
                const double energy = coupled(many ? 64 : 1, ratio[k], 0.5 * e);
                if (in_double)
                    printf("# %d particles, m/M %.2f, e %.1f: energy %.3f of the start\n", many ? 64 : 1, ratio[k],
                           0.5 * e, energy);
            }
}

/* A body on a column of particles, which moves up and down. */
typedef struct loaded_column {
    uint32_t links; /* at most 10, of 2000 N/m */
    double mass;    /* of the body, relative to that of a particle, 0.05 kg */
    double damping; /* damping ratio of the links */
    double T;       /* [s] of a call */
    uint64_t steps; /* of a call */
    bool extrapolates;
} loaded_column;

enum { most_column_links = 10 };

static const double column_stiffness = 2000, column_mass = 0.05; /* [N/m], [kg] */

static double column_omega(const loaded_column *c) /* [rad/s] of the body */
{
    return sqrt(column_stiffness / c->links / (c->mass * column_mass));
}

static spring_scene *make_column(const loaded_column *c, double *top)
{
    double x[3 * (most_column_links + 1)] = {0};
    spring_link link[most_column_links];
    uint8_t pinned[most_column_links + 1] = {1};
    const double unit = column_mass * gravity / column_stiffness; /* [m] compression by the weight of a particle */
    const double rest = 4 * unit * (c->mass + c->links);
    for (uint32_t i = 0; i < c->links; i++) {
        link[i] = (spring_link){.a = i, .b = i + 1, .rest = rest, .stiffness = column_stiffness};
        link[i].damping = c->damping * sqrt(2 * column_stiffness * column_mass);
        x[3 * i + 4] = x[3 * i + 1] + rest - unit * (c->mass + c->links - i);
    }
    *top = x[3 * c->links + 1];
    spring_scene_def def = falling(c->links + 1, x, NULL, column_mass);
    def.pinned = pinned, def.links = c->links, def.link = link;
    return scene_of(&def);
}

/* A call of the loop of docs/games.md, for a body of mass M that rests on a scene. *before: the impulse of the last call */
static void couple(spring_scene *s, spring_collider *body, double M, double T, uint64_t steps, bool extrapolates,
                   double *before)
{
    spring_impulse j;
    set(s, body, 1);
    run(s, SPRING_LEAPFROG, T / (double)steps, steps);
    spring_scene_impulses(s, &j, 0, 1);
    body->at[1] += T * body->velocity[1] + T * T / 2 * body->acceleration[1];
    body->velocity[1] += j.linear[1] / M - gravity * T;
    const double last = isnan(*before) ? j.linear[1] : *before;
    body->acceleration[1] = (extrapolates ? 3 * j.linear[1] - last : 2 * j.linear[1]) / (2 * T * M) - gravity;
    *before = j.linear[1];
}

/* The loop of docs/games.md, with or without extrapolation of the force, for 40 s and at least 50 periods. Returns the
   amplitude in the last fifth relative to that in the first fifth. */
static double amplitude_ratio(const loaded_column *c)
{
    double rest, before = NAN, first = 0, last = 0;
    spring_scene *s = make_column(c, &rest);
    const double omega = column_omega(c);
    const int calls = (int)(fmax(40, 100 * PI / omega) / c->T);
    spring_collider body = {.shape = SPRING_PLANE, .axis = {{0, -1, 0}}, .at = {0, rest, 0}};
    body.velocity[1] = -0.1 * gravity / omega;
    for (int i = 0; i < calls; i++) {
        couple(s, &body, c->mass * column_mass, c->T, c->steps, c->extrapolates, &before);
        if (i < calls / 5)
            first = fmax(first, fabs(body.at[1] - rest));
        if (i >= calls - calls / 5)
            last = fmax(last, fabs(body.at[1] - rest));
    }
    free(s);
    return last / first;
}

/* The rules of docs/games.md. Between a body on one spring and light particles, one vibration matters; in columns,
   others can resonate with the calls. */
static void coupled_oscillation(void)
{
    const double omega_T[] = {0.1, 0.2, 0.35, 0.5, 0.6};
    for (int i = 0; i < 5; i++) {
        loaded_column c = {.links = 1, .mass = 1e4, .steps = 16, .extrapolates = true};
        c.T = omega_T[i] / column_omega(&c);
        const double ratio = amplitude_ratio(&c);
        printf("# omega T %.2f: amplitude multiplied by %.3f\n", omega_T[i], ratio);
        CHECK_BELOW(ratio, 1, "the coupling adds no energy");
        c.extrapolates = false;
        CHECK(omega_T[i] > 0.35 || amplitude_ratio(&c) > 1, "without extrapolation it does");
    }
}

/* With damping, calls of at most twice the stable step; without, of one step. */
static void coupled_columns(void)
{
    const double stable = sqrt(column_mass / column_stiffness); /* [s] 2/sqrt(4 k/m) */
    const uint32_t links[] = {2, 3, 5, most_column_links};
    for (int damped = 0; damped < 2; damped++) {
        double largest = 0;
        for (int n = 0; n < 4; n++)
            for (double mass = 20; mass < 400; mass *= 1.6) {
                loaded_column c = {
                    .links = links[n], .mass = mass, .extrapolates = true, .T = 0.3 * stable, .steps = 1};
                if (damped) {
                    c.damping = 0.02;
                    c.T = fmin(2 * stable, 0.6 / column_omega(&c));
                    c.steps = 4;
                }
                largest = fmax(largest, amplitude_ratio(&c));
            }
        printf("# columns, damping ratio %.2f: amplitude multiplied by up to %.3f\n", damped ? 0.02 : 0, largest);
        CHECK_BELOW(largest, damped ? 1 : 1.02, "the coupling adds no energy; without damping, vibrations beat");
    }
}

/* A plane of `layers` times the mass of the particles that it rests on, on a damped block, in calls of twice the stable
   step. Returns its largest speed in the last of four parts of 20 s, relative to the first. */
static double block_speed_ratio(double layers)
{
    enum { side = 3, count = side * side * side };
    const spring_grid g = {.count = {side, side, side},
                           .spacing = 0.1,
                           .stiffness = 1000,
                           .damping = 0.02 * sqrt(2 * 1000 * 0.05),
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                           .pinned = SPRING_GRID_FIRST_Y};
    double x[3 * count], largest[4] = {0}, before = NAN;
    uint8_t pinned[count];
    spring_link link[9 * count];
    size_t particles, links;
    CHECK(spring_grid_size(&g, &particles, &links) == SPRING_OK && links <= 9 * count, "room for the links");
    spring_grid_fill(&g, x, pinned, link);
    spring_scene_def def = falling(particles, x, NULL, 0.05);
    def.pinned = pinned, def.links = links, def.link = link;
    spring_scene *s = scene_of(&def);
    const double T = 2 * spring_scene_stable_step(s, SPRING_LEAPFROG), M = layers * side * side * 0.05;
    const int calls = (int)(20 / T);
    spring_collider body = {
        .shape = SPRING_PLANE, .axis = {{0, -1, 0}}, .at = {0, 0.1 * (side - 1), 0}, .friction = 0.5};
    body.acceleration[1] = -gravity;
    for (int i = 0; i < calls; i++) {
        couple(s, &body, M, T, 3, true, &before);
        largest[4 * i / calls] = fmax(largest[4 * i / calls], fabs(body.velocity[1]));
    }
    free(s);
    return largest[3] / largest[0];
}

static void coupled_blocks(void)
{
    CHECK_BELOW(block_speed_ratio(6), 0.5, "comes to rest");
    CHECK_BELOW(block_speed_ratio(20), 0.5, "comes to rest");
    CHECK(block_speed_ratio(4) > 0.5, "vibrates on");
}

/* A ball that is a collider and may turn. */
typedef struct turning_ball {
    double mass, inertia, radius, friction;
    double at[3], v[3], accel[3], spin[3], spin_accel[3];
    double before[2][3]; /* linear and angular impulse of the call before */
    int calls;
} turning_ball;

/* A call of the loop of docs/games.md. g: [m/s^2] the acceleration of the ball by gravity */
static void push_ball(spring_scene *s, turning_ball *b, const double g[3], double T, uint64_t steps)
{
    spring_collider c = {.shape = SPRING_SPHERE, .radius = b->radius, .friction = b->friction};
    spring_impulse j;
    double pushed[3], correction[3];
    memcpy(c.at, b->at, sizeof c.at);
    memcpy(c.velocity, b->v, sizeof c.velocity);
    memcpy(c.acceleration, b->calls > 0 ? b->accel : g, sizeof c.acceleration);
    memcpy(c.spin, b->spin, sizeof c.spin);
    memcpy(c.spin_acceleration, b->spin_accel, sizeof c.spin_acceleration);
    set(s, &c, 1);
    run(s, SPRING_LEAPFROG, T / (double)steps, steps);
    spring_scene_impulses(s, &j, 0, 1);
    for (int a = 0; a < 3; a++)
        pushed[a] = c.acceleration[a] - g[a];
    cross(b->v, pushed, correction);
    for (int a = 0; a < 3; a++) {
        const double linear = j.linear[a], angular = j.angular[a] + b->mass * T * T / 2 * correction[a];
        const double last[2] = {b->calls > 0 ? b->before[0][a] : linear, b->calls > 0 ? b->before[1][a] : angular};
        b->at[a] += T * b->v[a] + T * T / 2 * c.acceleration[a];
        b->v[a] += linear / b->mass + g[a] * T;
        b->spin[a] += angular / b->inertia;
        b->accel[a] = g[a] + (3 * linear - last[0]) / (2 * T * b->mass);
        b->spin_accel[a] = (3 * angular - last[1]) / (2 * T * b->inertia);
        b->before[0][a] = linear;
        b->before[1][a] = angular;
    }
    b->calls++;
}

/* Without gravity and friction, a ball hits a soft block beside its centre. */
static void coupled_momenta(void)
{
    const spring_grid g = {.count = {4, 4, 4},
                           .spacing = 0.1,
                           .stiffness = 100,
                           .damping = 0.14,
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND};
    static model m;
    build_grid(&m, &g, 0.02);
    m.def.axes = 3;
    m.def.particle_radius = 0.05;
    m.def.colliders = 1;
    for (int i = 0; i < 2; i++) {
        const double T = i == 0 ? 1. / 60 : 1. / 240;
        spring_scene *s = scene_of(&m.def);
        turning_ball b = {.mass = 5, .inertia = 0.18, .radius = 0.3, .at = {-0.3, 0.75, 0.15}, .v = {2, -1, 0}};
        double change[3] = {0}, moment[3], end[3], size;
        const momenta first = momenta_of(&m, s);
        cross(b.at, b.v, moment);
        for (double t = 0; t < 1; t += T)
            push_ball(s, &b, none, T, i == 0 ? 4 : 1);
        const momenta last = momenta_of(&m, s);
        cross(b.at, b.v, end);
        size = b.mass * sqrt(dot(moment, moment));
        for (int a = 0; a < 3; a++)
            change[a] = last.angular[a] - first.angular[a] + b.mass * (end[a] - moment[a]) + b.inertia * b.spin[a];
        CHECK_BELOW(sqrt(dot(change, change)), (in_double ? 1e-11 : 1e-4) * size, "angular momentum is conserved");
        CHECK_BELOW(sqrt(dot(b.spin, b.spin)), i == 0 ? 0.02 : 0.005, "a ball without friction does not turn");
        free(s);
    }
}

/* A ball with friction lands on a trampoline, and rolls and bounces until it lies in one of its cells. */
static void coupled_rolling(void)
{
    enum { side = 15 };
    const double spacing = 0.14, k = 2000, mass = 0.02;
    const spring_grid g = {.count = {side, side},
                           .spacing = spacing,
                           .stiffness = k,
                           .damping = 0.02 * sqrt(2 * k * mass),
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                           .pinned =
                               SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y};
    static model m;
    build_grid(&m, &g, mass);
    for (size_t i = 0; i < m.def.particles; i++) {
        double *const x = &m.position[3 * i];
        x[0] -= spacing * (side - 1) / 2;
        x[2] = x[1] - spacing * (side - 1) / 2;
        x[1] = 0;
    }
    m.def.gravity[1] = -gravity;
    m.def.drag = mass;
    m.def.particle_radius = 0.05;
    m.def.colliders = 1;
    spring_scene *s = scene_of(&m.def);
    turning_ball b = {
        .mass = 5, .inertia = 0.045, .radius = 0.15, .friction = 0.5, .at = {0, 0.3, 0}, .v = {0.5, 0, 0.2}};
    const double T = 0.02 * sqrt(0.13); /* it sinks by 0.13 m */
    const uint64_t steps = (uint64_t)ceil(T / (0.5 * spring_scene_stable_step(s, SPRING_LEAPFROG)));
    double energy[5];
    for (int i = 0; i <= 4000; i++) {
        const spring_scene_energies e = spring_scene_energy(s);
        energy[i / 1000] = e.kinetic + e.elastic + e.gravity + b.mass * (dot(b.v, b.v) / 2 + gravity * b.at[1]) +
                           b.inertia * dot(b.spin, b.spin) / 2;
        push_ball(s, &b, down, T, steps);
    }
    printf("# a ball on a trampoline: energy %.2f, %.2f, %.2f, %.2f J\n", energy[0], energy[1], energy[2], energy[3]);
    for (int i = 0; i < 3; i++)
        CHECK(energy[i + 1] < energy[i], "the coupling adds no energy");
    CHECK_BELOW(hypot(b.at[0], b.at[2]), spacing * (side - 1) / 2, "on the trampoline");
    free(s);
}

enum { most_rope = 12 };

typedef struct attached_body {
    uint32_t particles;
    double T, omega_T; /* [stable steps] of an update; of the body on the last link */
    double damping;    /* ratio */
    uint64_t steps;    /* per update */
    bool pushed;       /* it moves as a body that is a collider, too */
} attached_body;

/* A rigid body that stretches a rope along it, by pull_body() of docs/games.md, is displaced from balance. Returns its
   largest distance from balance after 400 of 12 000 updates, relative to that in the first 400. */
static double attached_amplitude(const attached_body *b)
{
    const double k = 1000, m = 0.05, spacing = 0.1, stretch = 1.2, load = k * spacing * (stretch - 1);
    const uint32_t n = b->particles, last = n - 1;
    double x[3 * most_rope] = {0}, early = 0, late = 0, pull = load;
    uint8_t pinned[most_rope] = {1};
    spring_link link[most_rope];
    pinned[last] = 1;
    for (uint32_t i = 0; i < n; i++) {
        x[3 * i] = i * spacing * stretch;
        link[i] =
            (spring_link){.a = i, .b = i + 1, .rest = spacing, .stiffness = k, .damping = b->damping * sqrt(2 * k * m)};
    }
    const spring_scene_def def = {
        .particles = n, .position = x, .pinned = pinned, .mass_all = m, .links = last, .link = link};
    spring_scene *s = scene_of(&def);
    const double T = b->T * spring_scene_stable_step(s, SPRING_LEAPFROG), omega = b->omega_T / T,
                 M = k / (omega * omega);
    double end[3] = {x[3 * last]}, v = 1e-3 * omega * spacing;
    for (int i = 0; i < 12000 && late <= 10 * early; i++) {
        const double kick = T * (load - pull) / M;
        v += b->pushed ? 0 : kick;
        end[0] += T * (v + (b->pushed ? kick / 2 : 0));
        CHECK(spring_scene_drive(s, last, end, T) == SPRING_OK, "a pinned particle");
        run(s, SPRING_LEAPFROG, T / (double)b->steps, b->steps);
        pull = spring_scene_tension(s, last - 1);
        v += b->pushed ? (kick + T * (load - pull) / M) / 2 : 0;
        double *const largest = i < 400 ? &early : &late;
        *largest = fmax(*largest, fabs(end[0] - x[3 * last]));
    }
    free(s);
    return late / early;
}

/* Updates of at most twice the stable step, and damping or a small omega T. */
static void attached_bodies(void)
{
    double damped = 0, undamped = 0;
    for (int i = 0; i < 15; i++) {
        attached_body b = {.particles = 3 + (uint32_t)random_uniform(0, most_rope - 2),
                           .T = random_uniform(1, 2),
                           .omega_T = 0.25,
                           .damping = 0.01,
                           .steps = 3 + (uint64_t)random_uniform(0, 6),
                           .pushed = i % 2 == 1};
        damped = fmax(damped, attached_amplitude(&b));
        b.damping = 0;
        b.omega_T = 0.1;
        undamped = fmax(undamped, attached_amplitude(&b));
    }
    printf("# amplitude multiplied by up to %.3f with damping, and %.3f without\n", damped, undamped);
    CHECK_BELOW(damped, 1, "the coupling adds no energy");
    CHECK_BELOW(undamped, 1.2, "without damping, vibrations beat");
    CHECK(attached_amplitude(&(attached_body){4, 3, 0.25, 0, 8, false}) > 10,
          "with longer updates, a vibration resonates");
}

/* Two particles joined by a damped link rest on a plane, one above the other. docs/details.md has the excess of RK4. */
static void damped_link_at_rest(void)
{
    const double k = 500, mass = 0.3, dt = 0.002, rest = 0.5, load = mass * gravity;
    for (double dt_G = 0.02; dt_G < 0.4; dt_G *= 2.5)
        for (int m = 0; m < method_count; m++) {
            const double x[6] = {0, 0, 0, 0, rest - load / k, 0};
            const spring_link link = {.b = 1, .rest = rest, .stiffness = k, .damping = dt_G / dt * mass / 2};
            spring_scene_def def = falling(2, x, NULL, mass);
            def.links = 1, def.link = &link;
            spring_scene *s = scene_with(&def, &ground);
            double end[6];
            run(s, with_contacts[m], dt, 10000);
            spring_scene_get(s, SPRING_POSITION, end, 0, 0, 2);
            const bool rests = spring_scene_at_rest(s, 0.01, 0.05);
            free(s);
            const double excess = k * (rest - (end[4] - end[1])) / load - 1, bound = in_double ? 1e-9 : 2e-4;
            const double L = 2 * k / mass, expected = dt_G / 2 + dt * dt * L / 6;
            CHECK(rests == (with_contacts[m] == SPRING_LEAPFROG), "the forces of RK4 are not in balance");
            if (with_contacts[m] == SPRING_LEAPFROG)
                CHECK_BELOW(excess, bound, "rounding errors: leapfrog rests in equilibrium");
            else
                CHECK_CLOSE(excess, expected, 0.05 * expected + bound, "higher orders of dt");
        }
}

/* Impulses do not depend on the vector width. */
static void impulses_on_all_widths(void)
{
    static model m;
    for (int k = 0; k < 40; k++) {
        build(&m, (const uint32_t[]){9, 5, 1}, 3, (unsigned)random_bits() % feature_masks & ~(unsigned)PINNED);
        m.def.colliders = 2;
        m.def.particle_radius = 0.02;
        m.def.methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4;
        const spring_collider c[2] = {random_collider(3), random_collider(3)};
        spring_impulse first[2], j[2];
        for (int i = 0; i < kernel_count; i++) {
            if (kernels_of(i) == NULL)
                continue;
            spring_scene *s = scene_of(&m.def);
            set(s, c, 2);
            if (spring_scene_advance_with(kernels_of(i), s, with_contacts[k % 2], 0.01, 5) == SPRING_OK) {
                CHECK(spring_scene_impulses(s, i == 0 ? first : j, 0, 2) == SPRING_OK, "impulses");
                CHECK(i == 0 || memcmp(first, j, sizeof j) == 0, "the same bits");
            }
            free(s);
        }
    }
}

/* The rules of spring_scene_impulses(). */
static void impulse_rules(void)
{
    const double x[6] = {0, 0.01, 0, 1, 0.005, 0}, v[6] = {0, -3, 0, 0, -1, 0};
    const spring_scene_def def = {.particles = 2, .position = x, .velocity = v, .mass_all = 0.7, .colliders = 2};
    const spring_collider c = {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .at = {5, 0, 2}, .velocity = {1, 0, 0}};
    spring_impulse j[2], other[2];
    spring_scene *s = scene_of(&def);
    CHECK(spring_scene_impulses(s, j, 0, 0) == SPRING_OK && spring_scene_impulses(s, j, 0, 1) == SPRING_ERANGE, "none");
    set(s, &c, 1);
    CHECK(spring_scene_impulses(s, j, 0, 1) == SPRING_OK && j[0].linear[1] == 0, "0 at first");
    run(s, SPRING_LEAPFROG, 0.01, 1);
    CHECK(spring_scene_impulses(s, j, 0, 2) == SPRING_ERANGE && spring_scene_impulses(s, NULL, 0, 1) == SPRING_EINVAL,
          "one collider");
    CHECK(spring_scene_impulses(s, j, 0, 1) == SPRING_OK, "one collider");
    CHECK_CLOSE(j[0].linear[1], -0.7 * 4, 20 * EPS, "the momentum that was lost");
    /* about (5.01, 0, 2): (x - 5.01, 0, -2) x (0, -J, 0) = (-2 J, 0, -(x - 5.01) J), J = 2.1 and 0.7 */
    CHECK_CLOSE(j[0].angular[0], -2 * 2.8, 50 * EPS, "the angular momentum");
    CHECK_CLOSE(j[0].angular[2], 5.01 * 2.1 + 4.01 * 0.7, 100 * EPS, "the angular momentum");
    spring_scene_advance(s, SPRING_LEAPFROG, NAN, 1);
    CHECK(spring_scene_impulses(s, other, 0, 1) == SPRING_OK && memcmp(j, other, sizeof *j) == 0, "a failed call");
    run(s, SPRING_LEAPFROG, 0.01, 0);
    CHECK(spring_scene_impulses(s, j, 0, 1) == SPRING_OK && j[0].linear[1] == 0, "no step");
    free(s);
    const spring_scene_def bare = {.particles = 1, .position = x};
    s = scene_of(&bare);
    CHECK(spring_scene_impulses(s, j, 0, 0) == SPRING_EDISABLED, "no colliders");
    free(s);
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

/* Solid between the radii 0.9 and 0.9 + *user. */
static uint32_t shell(void *user, const double p[3], double gap[3], double normal[3][3])
{
    const double half = *(const double *)user / 2, middle = 0.9 + half, r = length(p);
    gap[0] = fabs(r - middle) - half;
    for (int a = 0; a < 3; a++)
        normal[0][a] = (r > middle ? 1 : -1) * p[a] / r;
    return 1;
}

/* ------------------------------------------------------------------------------------------------------ custom bodies */

static uint32_t hollow_sphere(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const double r = length(y);
    for (int a = 0; a < 3; a++)
        normal[0][a] = r > 0 ? -y[a] / r : a == 1;
    gap[0] = *(double *)user - r;
    return 1;
}

/* A height field h = A sin 3x cos 2z, over its largest slope. */
static uint32_t hills(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const double A = *(double *)user, h = A * sin(3 * y[0]) * cos(2 * y[2]), slope = sqrt(1 + 9 * A * A);
    const double n[3] = {-3 * A * cos(3 * y[0]) * cos(2 * y[2]), 1, 2 * A * sin(3 * y[0]) * sin(2 * y[2])};
    for (int a = 0; a < 3; a++)
        normal[0][a] = n[a] / length(n);
    gap[0] = (y[1] - h) / slope;
    return 1;
}

typedef struct mesh {
    size_t count;
    double at[512][3][3];
} mesh;

static void nearest_on_triangle(const double t[3][3], const double p[3], double out[3])
{
    double best = INFINITY, ab[3], ac[3], n[3], ap[3];
    for (int a = 0; a < 3; a++)
        ab[a] = t[1][a] - t[0][a], ac[a] = t[2][a] - t[0][a], ap[a] = p[a] - t[0][a];
    cross(ab, ac, n);
    double c1[3], c2[3];
    cross(ap, ac, c1);
    cross(ab, ap, c2);
    const double u = dot(c1, n) / dot(n, n), v = dot(c2, n) / dot(n, n);
    if (u >= 0 && v >= 0 && u + v <= 1) {
        for (int a = 0; a < 3; a++)
            out[a] = t[0][a] + u * ab[a] + v * ac[a];
        return;
    }
    for (int k = 0; k < 3; k++) {
        double edge[3], from[3], q[3], square = 0;
        for (int a = 0; a < 3; a++)
            edge[a] = t[(k + 1) % 3][a] - t[k][a], from[a] = p[a] - t[k][a];
        const double f = fmin(1, fmax(0, dot(from, edge) / dot(edge, edge)));
        for (int a = 0; a < 3; a++)
            q[a] = t[k][a] + f * edge[a], square += (p[a] - q[a]) * (p[a] - q[a]);
        if (square < best) {
            best = square;
            memcpy(out, q, sizeof q);
        }
    }
}

/* A shell: the distance from its triangles, to which the radius of the collider is added. */
static uint32_t mesh_distance(void *user, const double y[3], double gap[3], double normal[3][3])
{
    const mesh *m = user;
    gap[0] = INFINITY;
    for (size_t i = 0; i < m->count; i++) {
        double q[3], d[3];
        nearest_on_triangle(m->at[i], y, q);
        for (int a = 0; a < 3; a++)
            d[a] = y[a] - q[a];
        const double r = length(d);
        if (r < gap[0]) {
            gap[0] = r;
            for (int a = 0; a < 3; a++)
                normal[0][a] = r > 0 ? d[a] / r : a == 1;
        }
    }
    return 1;
}

static void add_triangle(mesh *m, const double a[3], const double b[3], const double c[3], int level)
{
    if (level == 0) {
        memcpy(m->at[m->count][0], a, 3 * sizeof *a);
        memcpy(m->at[m->count][1], b, 3 * sizeof *b);
        memcpy(m->at[m->count++][2], c, 3 * sizeof *c);
        return;
    }
    double ab[3], bc[3], ca[3];
    for (int k = 0; k < 3; k++)
        ab[k] = a[k] + b[k], bc[k] = b[k] + c[k], ca[k] = c[k] + a[k];
    const double l[3] = {length(ab), length(bc), length(ca)};
    for (int k = 0; k < 3; k++)
        ab[k] /= l[0], bc[k] /= l[1], ca[k] /= l[2];
    add_triangle(m, a, ab, ca, level - 1);
    add_triangle(m, ab, b, bc, level - 1);
    add_triangle(m, ca, bc, c, level - 1);
    add_triangle(m, ab, bc, ca, level - 1);
}

static void ball_of_triangles(mesh *m, int level)
{
    m->count = 0;
    for (int i = 0; i < 8; i++) {
        const double a[3] = {i & 1 ? -1 : 1, 0, 0}, b[3] = {0, i & 2 ? -1 : 1, 0}, c[3] = {0, 0, i & 4 ? -1 : 1};
        add_triangle(m, a, b, c, level);
    }
}

/* Shoots 50 particles about. Returns how many end on the other side. */
static int shots(spring_collider c, double radius, double speed, bool field, double g)
{
    enum { count = 50 };
    double x[count][3], v[count][3];
    for (int i = 0; i < count; i++) {
        double to[3], at[3];
        random_unit(to, 3);
        random_unit(at, 3);
        const double far = random_uniform(0, 0.5), u = speed * random_uniform(0.5, 1);
        for (int a = 0; a < 3; a++) {
            x[i][a] = field ? (a == 1 ? random_uniform(0.5, 1.5) : random_uniform(0, 4)) : far * at[a];
            v[i][a] = field ? speed * (a == 1 ? -random_uniform(0, 1) : random_uniform(-0.5, 0.5)) : u * to[a];
        }
    }
    spring_scene_def def = falling(count, x[0], v[0], 0.3);
    def.gravity[1] = -g, def.particle_radius = radius;
    spring_scene *s = scene_with(&def, &c);
    int out = 0;
    for (int k = 0; k < 300; k++)
        run(s, SPRING_LEAPFROG, 1. / 480, 1);
    for (size_t i = 0; i < count; i++) {
        double now[3], gap[3], normal[3][3];
        spring_scene_get(s, SPRING_POSITION, now, 0, i, 1);
        hills(c.user, now, gap, normal);
        out += field ? gap[0] < -1e-5 : !(length(now) < 1);
    }
    free(s);
    return out;
}

static void custom_bodies(void)
{
    static mesh fine, coarse;
    double radius = 1, height = 0.15, wall = 0.2;
    ball_of_triangles(&fine, 2);
    ball_of_triangles(&coarse, 0);
    int out = 0, all = 0;
    for (int bounces = 0; bounces < 2; bounces++) {
        spring_collider c = {.shape = SPRING_CUSTOM, .thickness = 0.04, .restitution = bounces * 0.9, .friction = 0.3};
        c.gap = hollow_sphere, c.user = &radius;
        out += shots(c, 0.01, 500, false, gravity);
        c.friction = 0, c.spin[0] = 1.5, c.spin[1] = 5;
        out += shots(c, 0.01, 500, false, gravity);
        c.friction = 0.3, c.spin[0] = c.spin[1] = 0, c.gap = hills, c.user = &height;
        out += shots(c, 0.01, 500, true, gravity);
        out += shots(c, 0.01, 5, true, gravity);
        c.gap = mesh_distance, c.user = &fine, c.radius = 0.01, c.thickness = 0.02;
        out += shots(c, 0.01, 500, false, 0);
        c.friction = 0, c.spin[1] = 3;
        out += shots(c, 0.01, 20, false, gravity);
        c.user = &coarse, c.spin[1] = 0, c.radius = 0.005, c.thickness = 0.01;
        out += shots(c, 0.005, 500, false, gravity);
        /* several diameters per step, so particles hit the wall again within a step and move straight into it */
        c = (spring_collider){.shape = SPRING_CUSTOM, .gap = shell, .user = &wall, .thickness = wall};
        c.restitution = bounces, c.friction = 0.3;
        out += shots(c, 0, 3000, false, 0);
        all += 8 * 50;
    }
    printf("# %d of %d particles left\n", out, all);
    CHECK(out == 0, "none passes through");
}

/* Slides on a body for a second. */
static void slide_on(spring_collider c, const double x[3], const double v[3], uint64_t steps, double out[3])
{
    double at[3] = {x[0], x[1], x[2]}, gap[3], n[3][3], u[3];
    for (int k = 0; k < 200; k++) {
        c.gap(c.user, at, gap, n);
        for (int a = 0; a < 3; a++)
            at[a] -= gap[0] * n[0][a];
    }
    c.gap(c.user, at, gap, n);
    for (int a = 0; a < 3; a++)
        u[a] = v[a] - dot(v, n[0]) * n[0][a];
    end_of(particle_on(&c, 1, at, u, down), SPRING_LEAPFROG, 1. / (double)steps, steps, out, u);
}

static void custom_order(void)
{
    double radius = 1, height = 0.15;
    for (int kind = 0; kind < 4 && in_double; kind++) {
        spring_collider c = {
            .shape = SPRING_CUSTOM, .thickness = 0.04, .friction = kind & 1 ? (kind & 2 ? 0.1 : 0.2) : 0};
        c.gap = kind & 2 ? hills : hollow_sphere, c.user = kind & 2 ? &height : &radius;
        const double x[3] = {kind & 2 ? 0.2 : 0.6, kind & 2 ? 0.1 : -0.7, 0.1},
                     v[3] = {kind & 2 ? 1 : 0.3, 0, kind & 2 ? 0.4 : 0.8};
        double best[3], now[3], error[2];
        slide_on(c, x, v, 1 << 15, best);
        for (int fine = 0; fine < 2; fine++) {
            slide_on(c, x, v, fine ? 1024 : 64, now);
            for (int a = 0; a < 3; a++)
                now[a] -= best[a];
            error[fine] = length(now);
        }
        printf("# %s: order %.2f\n", kind & 2 ? "hills" : "inside of a sphere", log2(error[0] / error[1]) / 4);
        CHECK(log2(error[0] / error[1]) / 4 >= 1.9, "second order");
    }
}

static uint32_t not_finite_gap(void *user, const double y[3], double gap[3], double normal[3][3])
{
    (void)user;
    gap[0] = y[1] > 0.5 ? y[1] : (double)NAN;
    normal[0][0] = normal[0][2] = 0, normal[0][1] = 1;
    return 1;
}

static faces level = {1, {{0, 1, 0}}}, floor_and_wall = {2, {{0, 1, 0}, {1, 0, 0}}},
             valley = {2, {{0.8, 0.6, 0}, {-0.8, 0.6, 0}}};

/* A valley of two faces, as two contacts of one body: a particle rests in it. Gaps that are not finite are reported. */
static void contacts_of_a_custom_body(void)
{
    const double x[3] = {0.1, 1, 0};
    spring_scene *s = particle_on(NULL, 1, x, none, down);
    spring_collider c = {.shape = SPRING_CUSTOM, .thickness = 1, .gap = gaps_of_faces, .user = &valley};
    double now[3], v[3];
    set(s, &c, 1);
    run(s, SPRING_LEAPFROG, 1. / 480, 4800);
    get(s, now, v);
    CHECK_BELOW(length(v), in_double ? 1e-10 : 1e-3, "at rest");
    CHECK_BELOW(hypot(now[0], now[1]), 1e-4, "at the bottom");
    CHECK(spring_scene_at_rest(s, 1e-3, 1e-3), "balanced by both contacts");
    free(s);
    s = particle_on(NULL, 1, x, none, down);
    c.gap = not_finite_gap;
    set(s, &c, 1);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1. / 480, 4800) == SPRING_ENONFINITE, "reported");
    get(s, now, v);
    CHECK(now[1] == 1, "nothing has changed");
    free(s);
}

/* A particle slides over the floor of a custom body to its wall, and not less far, wherever the body is and however thick. */
static void corner_of_a_custom_body(void)
{
    for (int k = 0; k < 60; k++) {
        const double at = k % 4 ? random_log(0.1, 100) : 0, thickness = random_log(1, 1e6), speed = random_log(0.1, 10);
        const double x[3] = {at + 0.7 * speed, 0, 0}, v[3] = {-speed, 0, 0}, dt = 1. / 480;
        spring_collider c = {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .user = &floor_and_wall, .at = {at}};
        c.thickness = thickness;
        /* rounding errors of positions, and 1000 slops of the function, see contact.c */
        const double off = fmax(100 * EPS * (at + 1), 8e3 * DBL_EPSILON * (2 * at + 1 + thickness));
        spring_scene *s = particle_on(&c, 1, x, v, down);
        double now[3], w[3] = {-speed, 0, 0};
        for (int n = 0; n < 480 && w[0] < -speed / 2; n++) {
            run(s, with_contacts[k % method_count], dt, 1);
            get(s, now, w);
        }
        CHECK_BELOW(now[0] - at, off, "it stops at the wall");
        CHECK_BELOW(w[0], off / dt, "a rounding error");
        free(s);
    }
}

/* A taut rope with links of length 0.1 that slides to and fro around a sharp edge of 90 degrees at the origin. The depth to
   which links enter the body [m], with particles of radius r. */
static double cut_of_links(double r)
{
    enum { n = 12 };
    const double spacing = 0.1, half = (n - 1) * spacing / 2, stretch = 1e-3;
    double x[n][2], deepest = 0;
    uint8_t pinned[n] = {[0] = 1, [n - 1] = 1};
    spring_link link[n - 1];
    for (uint32_t i = 0; i < n; i++) {
        const double along = (i * spacing - half) / sqrt(2);
        x[i][0] = 0.5 + along, x[i][1] = 0.5 - along;
        if (i > 0)
            link[i - 1] = (spring_link){i - 1, i, spacing, 1000, 0.5, 0};
    }
    spring_scene_def def = falling(n, x[0], NULL, 0.01);
    def.axes = 2, def.pinned = pinned, def.links = n - 1, def.link = link;
    def.gravity[1] = 0, def.drag = 0.05, def.particle_radius = (scalar)r, def.methods = 1u << SPRING_LEAPFROG;
    spring_collider box = {.shape = SPRING_BOX, .at = {-1, -1}, .half = {1, 1, 1}, .axis = {{1}, {0, 1}, {0, 0, 1}}};
    spring_scene *s = scene_with(&def, &box);
    const double leg = half * (1 + stretch) - r; /* from the edge to a pin, if a link is parallel to each face */
    for (int i = 0; i < 120; i++) {
        const double slide = i < 30 ? 0 : spacing * sin(0.1 * (i - 30));
        const double first[] = {-leg - slide, r + 1e-3}, last[] = {r + 1e-3, -leg + slide};
        CHECK(spring_scene_drive(s, 0, first, i < 10 ? 0.5 : 0.05) == SPRING_OK &&
                  spring_scene_drive(s, n - 1, last, i < 10 ? 0.5 : 0.05) == SPRING_OK,
              "pins");
        run(s, SPRING_LEAPFROG, 5e-4, 100);
        spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, n);
        for (int k = 1; k < n && i >= 30; k++)
            for (double f = 0; f <= 1; f += 0.01) {
                const double px = x[k - 1][0] + f * (x[k][0] - x[k - 1][0]),
                             py = x[k - 1][1] + f * (x[k][1] - x[k - 1][1]);
                deepest = fmax(deepest, fmin(-px, -py));
            }
    }
    free(s);
    return deepest;
}

static void links_at_an_edge(void)
{
    /* Ends at (-a, r) and (r, -a): s = sqrt(2) (a + r), and the middle is inside if r < a, that is, r < s/sqrt(8). */
    const double spacing = 0.1, depth = cut_of_links(0.25 * spacing);
    CHECK(cut_of_links(0.36 * spacing) == 0, "links stay outside if r >= s/sqrt(8) = 0.354 s, with the stretch of 1 %");
    printf("# particles of radius 0.25 s: links enter a sharp edge by %.3f s\n", depth / spacing);
    CHECK(depth > 0.01 * spacing, "smaller particles let them in");
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

/* A mass on a damped spring that stands on the floor sinks by m g/k. If velocities that are predicted for the damping
   entered the floor, the damping would push it up by about c g dt/2k, here 1 mm. */
static void damped_spring_on_floor(void)
{
    const double x[6] = {0, 0.1, 0, 0, 0.6, 0}, k = 100, c = 2, m = 0.7, dt = 0.01;
    const spring_link link = {.a = 0, .b = 1, .rest = 0.5, .stiffness = k, .damping = c};
    spring_scene_def def = falling(2, x, NULL, m);
    def.links = 1, def.link = &link;
    spring_scene *s = scene_with(&def, &unit_box);
    double now[6];
    run(s, SPRING_LEAPFROG, dt, 2500); /* exp(-c t/2m) = 3e-16 */
    spring_scene_get(s, SPRING_POSITION, now, 0, 0, 2);
    CHECK_CLOSE(now[4] - now[1], 0.5 - m * gravity / k, in_double ? 1e-12 : 1e-5, "Hooke's law, to rounding");
    CHECK_CLOSE(now[1], 0.1, 16 * EPS, "the lower end stands on the floor");
    free(s);
}

static const double body_mass = 300, leg_stiffness = 4e4;

/* A body, 0.7 m above a particle of mass `foot` that touches the floor, on a spring between them. */
static spring_scene *body_on_spring(double foot, double radius, double rest, double damping)
{
    const double x[6] = {0, radius, 0, 0, radius + 0.7, 0}, mass[2] = {foot, body_mass};
    const spring_link link = {0, 1, rest, leg_stiffness, damping, 0};
    spring_scene_def def = falling(2, x, NULL, 0);
    def.mass = mass, def.links = 1, def.link = &link, def.particle_radius = (scalar)radius;
    return scene_of(&def);
}

/* The mean length [m] of a spring that is 0.7 m long under its load, on a platform that is shaken. */
static double length_on_platform(double dt, double damping_ratio, int every, double *G)
{
    const double foot = 40, A = 0.1, omega = 2 * PI, damping = 2 * damping_ratio * sqrt(leg_stiffness * body_mass);
    spring_scene *s = body_on_spring(foot, 0.3, 0.7 + body_mass * gravity / leg_stiffness, damping);
    spring_collider c = ground;
    double sum = 0;
    const int calls = (int)(10 / (dt * every));
    *G = 2 * damping / foot;
    for (int i = 0; i < calls; i++) {
        const double t = i * every * dt;
        c.at[1] = A * sin(omega * t), c.velocity[1] = A * omega * cos(omega * t);
        c.acceleration[1] = -A * omega * omega * sin(omega * t);
        set(s, &c, 1);
        run(s, SPRING_LEAPFROG, dt, (uint64_t)every);
        double now[6];
        spring_scene_get(s, SPRING_POSITION, now, 0, 0, 2);
        sum += now[4] - now[1];
    }
    free(s);
    return sum / calls;
}

/* A pose that is set differs from the last one because the acceleration changes, by up to 2e-5 m here. */
static void damped_body_on_platform(void)
{
    static const struct {
        double damping_ratio, least, most; /* the bounds are of dt G */
    } cases[] = {{0.1, 0, 0.4}, {1, 0.4, 1}, {10, 7, 8}};
    for (int i = 0; i < 6; i++) {
        double G;
        const double dt = 1. / 480, length = length_on_platform(dt, cases[i % 3].damping_ratio, i < 3 ? 8 : 1, &G);
        CHECK(dt * G > cases[i % 3].least && dt * G < cases[i % 3].most, "explicit and heavy damping");
        CHECK_CLOSE(length, 0.7, 0.002, "the body keeps its length");
    }
}

/* A body on a heavily damped spring, in a lift that accelerates: the spring bears m (g + a) and is at rest in the lift. */
static void damped_body_in_a_lift(void)
{
    const double foot = 4, rest = 0.8, damping = 2 * sqrt(leg_stiffness * body_mass), a = 3, dt = 1. / 480;
    spring_collider c = ground;
    c.acceleration[1] = a;
    spring_scene *s = body_on_spring(foot, 0, rest, damping);
    double now[6];
    CHECK(dt * 2 * damping / foot > 7, "an exponential kick of several terms");
    set(s, &c, 1);
    run(s, SPRING_LEAPFROG, dt, 480 * 6); /* exp(-6 k/c) = 1e-15 */
    spring_scene_get(s, SPRING_POSITION, now, 0, 0, 2);
    CHECK_CLOSE(now[4] - now[1], rest - body_mass * (gravity + a) / leg_stiffness, 64 * 54 * EPS,
                "Hooke's law, to rounding at 54 m");
    free(s);
}

enum { TILES = 5 };

/* A floor of boxes. It moves and has a random direction, unless it is still. *plane: the same floor as a plane. */
static void tiled_floor(spring_collider *box, spring_collider *plane, bool still, double size, double overlap,
                        const double off[2])
{
    double axis[3][3];
    turned_axes((double[3]){0}, axis);
    *plane = (spring_collider){.shape = SPRING_PLANE, .friction = random_bits() % 2 ? random_uniform(0, 0.6) : 0};
    if (!still)
        random_axes(axis);
    memcpy(plane->axis[0], axis[1], sizeof axis[1]);
    for (int a = 0; a < 3 && !still; a++)
        plane->velocity[a] = random_uniform(-2, 2);
    for (int i = 0; i < TILES * TILES; i++, box++) {
        const double to[] = {(i % TILES - 2) * size + off[0], -0.25, (i / TILES - 2) * size + off[1]};
        *box = *plane;
        box->shape = SPRING_BOX;
        memcpy(box->axis, axis, sizeof box->axis);
        for (int a = 0; a < 3; a++) {
            box->at[a] = to[0] * axis[0][a] + to[1] * axis[1][a] + to[2] * axis[2][a];
            box->half[a] = a == 1 ? 0.25 : size / 2 + overlap;
        }
    }
}

/* A particle falls onto a floor of boxes and slides over it, as on a plane, wherever it starts: also within the skin of a
   seam, or where four boxes meet. If it bounces, it does so along the normal. Tops whose heights differ by rounding errors
   of single precision are one floor, also in double. */
static void floor_of_boxes(void)
{
    enum { over_a_seam = 3, from_a_corner, onto_a_seam, starts }; /* otherwise anywhere */
    int misses[2] = {0};
    for (int k = 0; k < 3000; k++) {
        spring_collider box[TILES * TILES], plane;
        const int start = k % starts;
        const bool drops = start == onto_a_seam, anywhere = start < over_a_seam;
        const double size = random_uniform(0.3, 2), overlap = anywhere && k % 2 ? random_log(1e-3, 50) : 0,
                     dt = frame / (start == over_a_seam ? 8 : 1 << random_bits() % 3), seam = size / 2;
        const double off[] = {anywhere ? random_uniform(-0.5, 0.5) * size : seam,
                              start == from_a_corner ? seam : random_uniform(-0.5, 0.5) * size};
        const double radius = random_bits() % 2 && (anywhere || drops) ? random_uniform(0.002, 0.05) : 0;
        const double height = radius + (drops ? random_uniform(0.5, 2) : anywhere && k % 5 == 0 ? 0.2 : 0);
        const bool straight = start == over_a_seam || (start == from_a_corner && k % 4 < 2);
        const double angle = straight ? k % 4 / 2 * PI : random_uniform(0, 2 * PI),
                     speed = drops ? 0 : random_log(0.2, 15), skin = 32 * EPS * 2 * (size + 0.25),
                     before = start == over_a_seam ? 5 * dt * speed + skin * random_uniform(-2, 2) : 0;
        const bool rounded = anywhere && random_bits() % 2;
        const double far = drops ? random_log(0.1, 30) : 0; /* [m] from the origin, along each axis */
        const spring_method method = with_contacts[start == over_a_seam ? 0 : random_bits() % method_count];
        double x[3], v[3], g[3], end[2][3], u[2][3], apart[2][3];
        tiled_floor(box, &plane, start == from_a_corner || random_bits() % (start == over_a_seam ? 2 : 4) == 0, size,
                    overlap, off);
        const double *const up = box[0].axis[1];
        plane.restitution = drops ? k / starts % 3 / 2. : 0;
        for (int a = 0; a < 3; a++) {
            const double along = cos(angle) * box[0].axis[0][a] + sin(angle) * box[0].axis[2][a];
            x[a] = far + height * up[a] - before * along;
            plane.at[a] = far;
            v[a] = plane.velocity[a] + speed * along;
            g[a] = -gravity * up[a];
        }
        for (int i = 0; i < TILES * TILES; i++) {
            box[i].restitution = plane.restitution;
            for (int a = 0; a < 3; a++)
                box[i].at[a] = rounded ? (float)box[i].at[a] : far + box[i].at[a];
        }
        const uint64_t steps = (uint64_t)(fmin(1, 1.8 * size / fmax(speed, 1)) / dt);
        for (int whole = 0; whole < 2; whole++)
            end_of(ball_on(whole ? &plane : box, whole ? 1 : TILES * TILES, x, v, g, radius), method, dt, steps,
                   end[whole], u[whole]);
        for (int a = 0; a < 3; a++)
            apart[0][a] = end[0][a] - end[1][a], apart[1][a] = dt * (u[0][a] - u[1][a]);
        for (int i = 0; i < 2; i++) {
            const double normal = dot(apart[i], up);
            for (int a = 0; a < 3 && plane.restitution > 0; a++)
                apart[i][a] -= normal * up[a];
        }
        /* For a particle with the radius r, a step of the height d = 5e-7 m is a slope of sqrt(2 d/r). The skin of the
           boxes, whose sizes and coordinates add up to at most 130 m, is 32 EPS of that. */
        misses[start == over_a_seam] +=
            !(fmax(length(apart[0]), length(apart[1])) <= (1 + far) * (rounded || !in_double ? 1e-3 : 1e-12));
    }
    CHECK(misses[0] <= 1, "as on a plane, unless a step starts at an edge, to rounding errors");
    CHECK(misses[1] <= 4, "as on a plane, for 99 of 100 that start a step within two skins of a seam");
}

enum { ROOM_TILES = 3, ROOM_BODIES = ROOM_TILES * ROOM_TILES + 4, ROOM_PARTICLES = 8 };

/* A room with a floor of boxes, which walls touch. */
typedef struct room {
    double size, half;           /* [m] of a tile, of the room */
    double axis[3][3], at[3], t; /* now; the second axis is up; [m] the centre of the floor; [s] since the start */
    double first[3][3], rate[3], spin[3]; /* the axes at the start; [m/s]; [rad/s] */
    double place[ROOM_BODIES][3];         /* [m] of the bodies, in the room */
    spring_collider body[ROOM_BODIES];
    bool rounded; /* coordinates of the bodies are those of single precision */
} room;

/* A place, from its coordinates in the room. */
static void place_of(const room *r, const double to[3], double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = r->at[a] + to[0] * r->axis[0][a] + to[1] * r->axis[1][a] + to[2] * r->axis[2][a];
}

/* Moves the room to the time t. */
static void move_room(room *r, double t)
{
    double phi[3];
    for (int a = 0; a < 3; a++) {
        r->at[a] += (t - r->t) * r->rate[a];
        phi[a] = t * r->spin[a];
    }
    r->t = t;
    for (int k = 0; k < 3; k++)
        turn(phi, r->first[k], r->axis[k]);
    for (int i = 0; i < ROOM_BODIES; i++) {
        spring_collider *const c = &r->body[i];
        double arm[3], v[3];
        place_of(r, r->place[i], c->at);
        for (int a = 0; a < 3; a++)
            arm[a] = c->at[a] - r->at[a];
        cross(r->spin, arm, v);
        cross(r->spin, v, c->acceleration);
        for (int a = 0; a < 3; a++) {
            c->velocity[a] = r->rate[a] + v[a];
            c->at[a] = r->rounded ? (float)c->at[a] : c->at[a];
        }
        memcpy(c->spin, r->spin, sizeof c->spin);
        if (c->shape == SPRING_BOX)
            memcpy(c->axis, r->axis, sizeof c->axis);
        for (int a = 0; a < 3 && c->shape == SPRING_PLANE; a++)
            c->axis[0][a] = (i < 2 ? 1 : -1) * r->axis[i % 2 ? 0 : 2][a];
    }
}

/* Walls are boxes beside the floor, boxes that end at the level of the floor, or planes. */
static void random_room(room *r, int k)
{
    const double tilt[3] = {random_uniform(-0.4, 0.4), random_uniform(-3, 3), random_uniform(-0.4, 0.4)};
    const bool turned = k % 4 > 1, moves = k % 8 > 3, spins = moves && k % 3 != 0;
    r->rounded = k % 16 > 7;
    r->size = random_uniform(0.4, 1.2);
    r->half = ROOM_TILES * r->size / 2;
    r->t = 0;
    turned_axes(turned ? tilt : (double[3]){0}, r->first);
    for (int a = 0; a < 3; a++) {
        r->at[a] = random_uniform(-2, 2);
        r->rate[a] = moves ? random_uniform(-2, 2) : 0;
        r->spin[a] = spins ? random_uniform(-0.5, 0.5) : 0;
    }
    for (int i = 0; i < ROOM_BODIES; i++) {
        const int t = i - 4, along = i % 2 ? 0 : 2;
        spring_collider *const c = &r->body[i];
        double *const to = r->place[i];
        *c = (spring_collider){.shape = t < 0 && k % 3 == 0 ? SPRING_PLANE : SPRING_BOX,
                               .half = {r->size / 2, 0.25, r->size / 2},
                               .friction = k % 5 ? random_uniform(0, 0.8) : 0};
        memcpy(to, (double[]){(t % ROOM_TILES - 1) * r->size, -0.25, (t / ROOM_TILES - 1) * r->size},
               sizeof r->place[i]);
        if (t >= 0)
            continue;
        const double thickness = c->shape == SPRING_BOX ? 0.2 : 0;
        to[0] = to[2] = 0;
        to[along] = (i < 2 ? -1 : 1) * (r->half + thickness);
        to[1] = k % 3 == 1 ? 2 : 1;
        c->half[0] = c->half[2] = r->half + 0.4;
        c->half[1] = 2;
        c->half[along] = thickness;
    }
    move_room(r, 0);
}

/* Particles with links between all of them. */
static spring_scene *particles_in_room(const room *r, size_t count, double radius)
{
    const double from[3] = {random_uniform(-0.8, 0.8) * r->half, random_uniform(0.3, 0.6),
                            random_uniform(-0.8, 0.8) * r->half},
                 speed[3] = {random_uniform(-6, 6), random_uniform(-3, 1), random_uniform(-6, 6)};
    double x[ROOM_PARTICLES][3], v[ROOM_PARTICLES][3];
    spring_link link[ROOM_PARTICLES * (ROOM_PARTICLES - 1) / 2];
    spring_scene_def def = falling(count, x[0], v[0], 0.1);
    for (uint32_t i = 0; i < count; i++) {
        const double to[3] = {from[0] + 0.05 * (i & 1), from[1] + 0.05 * (i >> 1 & 1), from[2] + 0.05 * (i >> 2)};
        place_of(r, to, x[i]);
        for (int a = 0; a < 3; a++)
            v[i][a] = r->rate[a] + speed[a];
        for (uint32_t j = 0; j < i; j++)
            link[def.links++] = (spring_link){.a = j, .b = i, .rest = 0.06, .stiffness = 100, .damping = 0.3};
    }
    def.link = link, def.particle_radius = (scalar)radius, def.colliders = ROOM_BODIES;
    for (int a = 0; a < 3; a++)
        def.gravity[a] = -gravity * r->axis[1][a];
    return scene_of(&def);
}

/* [m] How far a particle is outside of a room. */
static double outside_of_room(const room *r, const double x[3])
{
    double from[3];
    for (int a = 0; a < 3; a++)
        from[a] = x[a] - r->at[a];
    return fmax(-dot(from, r->axis[1]), fmax(fabs(dot(from, r->axis[0])), fabs(dot(from, r->axis[2]))) - r->half);
}

/* [m/s] The velocity of a particle through the floor that it lies on, in a room without spin; otherwise 0. */
static double through_floor(const room *r, const double x[3], const double v[3])
{
    double u[3], from[3];
    for (int a = 0; a < 3; a++) {
        u[a] = v[a] - r->rate[a];
        from[a] = x[a] - r->at[a];
    }
    return length(r->spin) == 0 && dot(from, r->axis[1]) < 1e-4 ? fabs(dot(u, r->axis[1])) : 0;
}

/* Particles slide into the corners of a room of boxes that only touch, and come to rest there. They have no radius, unless
   the bodies do not fit each other to rounding errors: in a room that turns, and of rounded coordinates in double precision. */
static void room_of_boxes(void)
{
    double worst = -1, fastest = 0;
    for (int k = 0; k < 480; k++) {
        const size_t count = k % 7 ? 1 : ROOM_PARTICLES;
        const double dt = frame / (count == 1 ? 1 << k % 3 : 8);
        room r;
        random_room(&r, k);
        const bool spins = length(r.spin) > 0;
        const double radius = spins || (in_double && r.rounded) ? (k % 3 == 1 ? 1e-3 : 1e-4) : 0;
        const uint64_t steps = (uint64_t)(2 / dt), each = spins ? 1 : steps;
        spring_scene *s = particles_in_room(&r, count, radius);
        double x[ROOM_PARTICLES][3], v[ROOM_PARTICLES][3];
        for (uint64_t n = 0; n < steps; n += each) {
            move_room(&r, spring_scene_time(s));
            set(s, r.body, ROOM_BODIES);
            run(s, with_contacts[k % 11 == 0], dt, each);
        }
        move_room(&r, spring_scene_time(s));
        spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, count);
        spring_scene_get(s, SPRING_VELOCITY, v[0], 0, 0, count);
        for (size_t i = 0; i < count; i++)
            worst = fmax(worst, outside_of_room(&r, x[i]) + (spins || r.rounded ? 0 : radius));
        fastest = count == 1 ? fmax(fastest, through_floor(&r, x[0], v[0])) : fastest;
        free(s);
    }
    /* The sizes of the coordinates of a particle add up to at most 21 m, and those of a body, with its half extents, to 25 m. */
    CHECK(worst <= 8 * EPS * 46, "inside, to the slop");
    CHECK_BELOW(fastest, 64 * EPS, "it lies on the floor");
}

/* Planes shut in particles, however they turn: a box that is shaken, with a spin that changes every 1/12 s. */
static void room_of_planes(void)
{
    enum { COUNT = 20 };
    double worst = -1;
    for (int k = 0; k < 40; k++) {
        const double half[3] = {random_uniform(0.3, 1.5), random_uniform(0.3, 1.5), random_uniform(0.3, 1.5)};
        const double e = k % 2 ? random_uniform(0, 0.5) : 0, friction = random_uniform(0, 1), dt = 1. / 240;
        double axis[3][3], spin[3], x[COUNT][3];
        spring_collider c[6];
        spring_scene_def def = {.particles = COUNT,
                                .position = x[0],
                                .mass_all = 0.1,
                                .gravity = {0, -gravity, 0},
                                .colliders = 6,
                                .particle_radius = k % 4 < 2 ? (scalar)0.02 : 0,
                                .methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4};
        for (int i = 0; i < COUNT; i++)
            for (int a = 0; a < 3; a++)
                x[i][a] = random_uniform(-0.9, 0.9) * half[a];
        memcpy(axis, unit_box.axis, sizeof axis);
        spring_scene *s = scene_of(&def);
        for (int n = 0; n < 400; n++) {
            const double fastest = 1 + k % 5;
            double phi[3];
            for (int a = 0; a < 3; a++) {
                spin[a] = n % 20 ? spin[a] : random_uniform(-fastest, fastest);
                phi[a] = spin[a] * dt;
            }
            for (int i = 0; i < 6; i++) {
                c[i] = (spring_collider){.shape = SPRING_PLANE, .friction = friction, .restitution = e};
                memcpy(c[i].spin, spin, sizeof spin);
                for (int a = 0; a < 3; a++) {
                    c[i].axis[0][a] = (i < 3 ? 1 : -1) * axis[i % 3][a];
                    c[i].at[a] = -half[i % 3] * c[i].axis[0][a];
                }
                cross(spin, c[i].at, c[i].velocity);
                cross(spin, c[i].velocity, c[i].acceleration);
            }
            set(s, c, 6);
            run(s, with_contacts[k % 3 == 0], dt, 1);
            for (int a = 0; a < 3; a++)
                turn(phi, (double[]){axis[a][0], axis[a][1], axis[a][2]}, axis[a]);
            spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, COUNT);
            for (int i = 0; i < COUNT; i++)
                for (int a = 0; a < 3; a++)
                    worst = fmax(worst, fabs(dot(x[i], axis[a])) + def.particle_radius - half[a]);
        }
        free(s);
    }
    /* The points `at` follow a parabola: (|spin| dt)^3/6 of 2.6 m, at spins of at most 5 sqrt(3) rad/s. */
    CHECK(worst <= 2.1e-5, "inside");
}

/* A small particle slides over a floor, or down a wall, to where they meet. The wall stands at the level of the floor and
   touches only its edge, or it extends below the floor, which enters it by very little. */
static void wall_on_a_floor(void)
{
    for (int k = 0; k < 460; k++) {
        const bool enters = k < 60;
        const double radius = k % 2 && !enters ? random_log(1e-5, 1e-2) : 0, dt = enters ? frame / (1 << k % 3) : frame;
        const double g[3] = {enters ? 3 : k % 3 ? 0.5 : 0, -gravity, 0}, bound = enters ? 1e4 * EPS : 64 * EPS;
        const double x[3] = {enters ? -0.2 : -random_log(1e-3, 0.5), enters ? random_uniform(0.1, 1) : radius, 0},
                     v[3] = {enters ? random_uniform(1, 8) : random_log(0.05, 5), 0, random_uniform(-0.2, 0.2)};
        spring_collider c[2] = {unit_box, unit_box}; /* the top of the floor is y = 0, and the wall begins at x = 0 */
        double now[3], u[3];
        c[0].at[0] = (!enters ? 0 : in_double ? 1e-7 : 1e-4) - c[0].half[0];
        c[0].at[1] = -c[0].half[1];
        c[1].half[1] = 2, c[1].at[1] = enters ? 0 : 2;
        c[1].at[0] = c[1].half[0];
        end_of(ball_on(c, 2, x, v, g, radius), with_contacts[k % method_count], dt, (uint64_t)(1.5 / dt), now, u);
        CHECK(now[1] >= radius - bound && now[1] <= radius + fmax(bound, 1024 * EPS) && now[0] <= bound - radius,
              "it lies on the floor, at the wall or before it");
    }
}

/* A particle rests in a corner of two planes and a floor that move together, in any direction. */
static void corner_of_planes(void)
{
    for (int k = 0; k < 2000; k++) {
        double axis[3][3], rate[3], at[3], g[3], x[3], v[3], now[3], u[3];
        spring_collider c[3] = {{.shape = SPRING_PLANE}, {.shape = SPRING_PLANE}, unit_box};
        random_axes(axis);
        memcpy(c[0].axis[0], axis[0], sizeof axis[0]);
        memcpy(c[1].axis[0], axis[2], sizeof axis[2]);
        memcpy(c[2].axis, axis, sizeof axis);
        for (int a = 0; a < 3; a++) {
            rate[a] = random_uniform(-2, 2);
            at[a] = random_uniform(-2, 2);
            g[a] = -gravity * axis[1][a];
            x[a] = at[a] + 0.01 * (axis[0][a] + axis[1][a] + axis[2][a]);
            v[a] = rate[a] - axis[0][a] - axis[2][a];
            for (int i = 0; i < 3; i++)
                c[i].at[a] = at[a], c[i].velocity[a] = rate[a];
            /* the edges of the floor touch the planes */
            c[2].at[a] += c[2].half[0] * axis[0][a] - c[2].half[1] * axis[1][a] + c[2].half[2] * axis[2][a];
        }
        end_of(particle_on(c, 3, x, v, g), SPRING_LEAPFROG, frame, 60, now, u);
        for (int a = 0; a < 3; a++)
            CHECK(fabs(now[a] - at[a] - 60 * frame * rate[a]) <= 64 * EPS * 30, "in the corner, to the skin");
    }
}

/* A wall stands on a floor, and particles are pressed into the corner. When the wall jumps forward, they are moved out
   through its front, and not through its bottom, into the floor. */
static void wall_that_jumps(void)
{
    static const double jumps[] = {1e-13, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.02, 0.1};
    for (size_t k = 0; k < 4 * sizeof jumps / sizeof jumps[0]; k++) {
        const double jump = jumps[k / 4], r = k % 4 > 1 ? 0.01 : 0, g[3] = {-10, -gravity, random_uniform(-1, 1)};
        const double x[3] = {0.1, r + 0.05, 0};
        spring_collider c[2] = {unit_box, unit_box};
        double now[3], v[3];
        c[0].at[1] = -c[0].half[1];
        c[0].half[0] = c[0].half[2] = c[1].half[2] = 5;
        if (k % 2)
            c[0] = ground;
        c[1].at[0] = -c[1].half[0];
        c[1].at[1] = c[1].half[1];
        spring_scene *s = ball_on(c, 2, x, none, g, r);
        run(s, SPRING_LEAPFROG, frame / 8, 200);
        c[1].at[0] += jump;
        set(s, c, 2);
        end_of(s, SPRING_LEAPFROG, frame / 8, 20, now, v);
        CHECK(now[1] > r - 1e3 * EPS && now[0] > jump + r - 1e3 * EPS, "on the floor, before the wall");
    }
}

/* Particles slide on a plate into the wedge under a ball that sits in it, and are pressed into the plate by more than half
   of its thickness. */
static void thin_plates(void)
{
    for (int k = 0; k < 1000; k++) {
        const double half = random_log(5e-4, 5e-3), over = random_uniform(0.05, 0.25), thrown = random_log(1, 50),
                     x[3] = {sqrt(0.09 - over * over) + random_uniform(0.15, 0.17), 0.001, 0}, v[3] = {-thrown, 0, 0};
        spring_collider c[2] = {unit_box, {.shape = SPRING_SPHERE, .at = {0, over, 0}, .radius = 0.3}};
        c[0].half[1] = half;
        c[0].at[1] = -half;
        c[0].restitution = c[1].restitution = k % 4 ? 0 : random_uniform(0, 1);
        double now[3], speed[3];
        end_of(particle_on(c, 2, x, v, down), with_contacts[k % method_count], random_log(1. / 960, frame), 60, now,
               speed);
        CHECK(now[1] > -half || fabs(now[0]) > unit_box.half[0] || fabs(now[2]) > unit_box.half[2],
              "a particle in a wedge is not pressed through the plate");
    }
}

/* Fast particles bounce many times in a step between thin walls, or, in a lift that rises, between two planes. */
static void thin_walls(void)
{
    for (int k = 0; k < 600; k++) {
        const bool lift = k % 3 == 0;
        const double reach = lift ? 0.02 : random_uniform(0.3, 1), half = 1e-3, rises = random_uniform(-3, 3),
                     fastest = lift ? random_log(3, 50) : random_log(10, 500);
        const double g[3] = {0, lift && k % 2 ? -gravity : 0, 0};
        spring_collider c[6];
        double x[3], v[3], now[3], speed[3];
        for (int i = 0; i < 6; i++) {
            c[i] = unit_box;
            for (int a = 0; a < 3; a++)
                c[i].half[a] = a == i / 2 ? half : reach + 2 * half;
            c[i].at[i / 2] = (i % 2 ? 1 : -1) * (reach + half);
            c[i].velocity[1] = rises;
            c[i].restitution = lift || k % 2 ? 1 : random_uniform(0, 1);
        }
        for (int a = 0; a < 3; a++) {
            x[a] = random_uniform(-0.9, 0.9) * reach;
            v[a] = lift ? a == 0 ? fastest : 0 : random_uniform(-1, 1) * fastest;
        }
        for (int i = 0; i < 2 && lift; i++) {
            const double side = i ? 1 : -1;
            c[i] = (spring_collider){.shape = SPRING_PLANE, .at = {side * reach}, .axis = {{-side}}, .restitution = 1};
            c[i].velocity[1] = rises;
        }
        x[1] = lift ? k % 4 < 2 ? -reach : -reach / 2 : x[1];
        v[1] += rises;
        end_of(particle_on(c, lift ? 3 : 6, x, v, lift ? g : none), with_contacts[k % method_count], frame, 30, now,
               speed);
        now[1] = lift ? fmin(0, now[1] - 30 * frame * rises) : now[1] - 30 * frame * rises; /* a lift has no ceiling */
        for (int a = 0; a < 3; a++)
            CHECK(fabs(now[a]) <= reach + 64 * EPS * 5, "between the walls");
    }
}

/* A ball comes down on a thin plate, near its edge, where particles rest. None of them goes through, or jumps farther than
   its speed and that of the ball allow. */
static void ball_on_an_edge(void)
{
    double farthest = 0;
    for (int k = 0; k < 2000; k++) {
        const double x[3] = {random_uniform(1.9, 2), 0, random_uniform(-0.2, 0.2)};
        const double half = random_log(1e-3, 0.02), falls = random_uniform(0.3, 2);
        spring_collider c[2] = {unit_box,
                                {.shape = SPRING_SPHERE, .at = {random_uniform(1.8, 2.1), 0.4, 0}, .radius = 0.3}};
        c[0].half[1] = half;
        c[0].at[1] = -half;
        c[1].velocity[1] = -falls;
        spring_scene *s = particle_on(c, 2, x, none, down);
        double before[3], now[3], v[3];
        for (int n = 0; n < 30; n++) {
            get(s, before, v);
            const double speed = length(v);
            run(s, with_contacts[k % method_count], frame, 1);
            get(s, now, v);
            farthest = fmax(farthest, distance(now, before) - frame * (falls + speed + length(v)));
        }
        free(s);
    }
    CHECK_BELOW(farthest, 0.3, "a jump: the radius of the ball");
}

/* Colliders that wait far away for their use do not change how a particle rests on a box. */
static void waiting_colliders(void)
{
    const double x[3] = {0};
    double now[2][3], speed[3];
    for (int k = 0; k < 4; k++) {
        spring_collider c[2] = {unit_box, unit_box};
        c[0].at[1] = -unit_box.half[1];
        c[1].shape = (spring_shape[]){SPRING_BOX, SPRING_PLANE, SPRING_SPHERE, SPRING_CAPSULE}[k];
        c[1].axis[0][0] = c[1].shape == SPRING_PLANE ? 0 : 1;
        c[1].axis[0][1] = c[1].shape == SPRING_PLANE ? 1 : 0;
        c[1].radius = 1;
        c[1].at[1] = c[1].to[1] = -1e5;
        for (uint32_t i = 0; i < 2; i++)
            end_of(particle_on(c, 1 + i, x, x, down), SPRING_LEAPFROG, frame, 10, now[i], speed);
        CHECK_BITS(now[1][1], now[0][1], "on the box");
    }
}

/* A particle that is put on the ground rests there: a box on it, at a distance, lifts it by the skin, without velocity. A
   box that waits deep below a plane, or far from a custom body with a bound, does not. */
static void boxes_on_the_ground(void)
{
    for (int k = 0; k < 200; k++) {
        const bool waits = k % 2;
        const double away = random_log(5, 1e4), at = random_uniform(-3, 3);
        const double radius = k % 3 ? 0 : random_uniform(0, 0.1), x[3] = {at, radius, 0}, angle = random_uniform(0, PI);
        const double skin = waits ? 0 : 33 * EPS * (away * (fabs(cos(angle)) + sin(angle)) + 4 * 0.5);
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{0, 1, 0}}}, unit_box};
        if (k % 4 > 1)
            c[0] = (spring_collider){.shape = SPRING_CUSTOM,
                                     .gap = gaps_of_faces,
                                     .user = &level,
                                     .thickness = random_log(1, 1e9),
                                     .bound = 50};
        if (c[0].shape == SPRING_CUSTOM && !waits)
            c[0].bound = 0;
        c[0].friction = c[1].friction = k % 5 ? random_uniform(0, 1) : 0;
        for (int a = 0; a < 3; a++)
            c[1].half[a] = 0.5;
        memcpy(c[1].at, (double[]){away * cos(angle), 0.5, away * sin(angle)}, sizeof c[1].at);
        if (waits)
            memcpy(c[1].at, (double[]){0, -away - 100, 0}, sizeof c[1].at);
        const double dt = random_log(1e-3, 1. / 60);
        spring_scene *s = ball_on(c, 2, x, none, down, radius);
        for (int n = 0; n < 60; n++) {
            double now[3], v[3];
            uint32_t touches;
            run(s, with_contacts[k % method_count], dt, 1);
            get(s, now, v);
            CHECK(spring_scene_touching(s, &touches, 0, 1) == SPRING_OK && touches == 1, "on the ground alone");
            CHECK(now[0] == (scalar)at && now[1] >= radius - 32 * EPS && now[1] <= radius + skin + 32 * EPS,
                  "in its place");
            CHECK(length(v) == 0 && spring_scene_at_rest(s, 1e-9, 1e-9), "at rest");
        }
        free(s);
    }
}

/* The ground moves, and carries a particle by friction: rounding errors of its position are no velocity. */
static void carried_far_out(void)
{
    for (int k = 0; k < 100; k++) {
        const double far_out = random_log(1, 50), angle = random_uniform(-0.2, 0.2);
        const double n[3] = {sin(angle), cos(angle), 0}, x[3] = {far_out, far_out, far_out};
        const double V[3] = {random_uniform(-1, 1), random_uniform(-1, 1), random_uniform(-1, 1)};
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{n[0], n[1], 0}}, .friction = 0.5}, unit_box};
        c[1].at[0] = far_out + 3;
        c[1].at[1] = c[1].at[2] = far_out;
        for (int i = 0; i < 2; i++)
            memcpy(c[i].velocity, V, sizeof V);
        memcpy(c[0].at, x, sizeof x);
        spring_scene *s = ball_on(c, k % 2 ? 2 : 1, x, V, down, 0);
        for (int step = 0; step < 300; step++) {
            double now[3], v[3];
            uint32_t touches;
            run(s, with_contacts[k % method_count], 1. / 960, 1);
            get(s, now, v);
            CHECK(spring_scene_touching(s, &touches, 0, 1) == SPRING_OK && touches == 1, "on the ground");
            for (int a = 0; a < 3; a++)
                CHECK_BELOW(fabs(v[a] - V[a]), in_double ? 64 * EPS : gravity / 960, "carried, or falling for a step");
        }
        free(s);
    }
}

/* Two particles on a damped link, with the same velocity v, which changes in a step of 0.01 s with a collider. */
static void step_of_pair(const double x[3], double v[3], const double g[3], const spring_collider *c, double dt_G,
                         double impulse[3])
{
    enum { mass = 2 };
    const double dt = 0.01, both[6] = {x[0], x[1], x[2], x[0], x[1], x[2] + 0.1},
                 velocity[6] = {v[0], v[1], v[2], v[0], v[1], v[2]};
    const spring_link link = {.b = 1, .rest = 0.1, .stiffness = 100, .damping = dt_G * mass / (2 * dt)};
    spring_scene_def def = falling(2, both, velocity, mass);
    def.links = 1, def.link = &link;
    memcpy(def.gravity, g, sizeof def.gravity);
    spring_scene *s = scene_with(&def, c);
    spring_impulse by;
    run(s, SPRING_LEAPFROG, dt, 1);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
    spring_scene_impulses(s, &by, 0, 1);
    memcpy(impulse, by.linear, sizeof by.linear);
    free(s);
}

static spring_collider random_ground(void)
{
    spring_collider c = ground;
    c.restitution = random_uniform(0, 1), c.friction = random_uniform(0, 1);
    return c;
}

/* Damping shortens a bounce and its friction: friction only brakes, and is at most the coefficient times the load. */
static void damped_bounces(void)
{
    for (int k = 0; k < 200; k++) {
        const spring_collider c = random_ground();
        const double dt_G = random_log(0.5, 1000), slope = random_log(1e-5, 0.3), fall = random_uniform(0.5, 3);
        const double g[3] = {gravity * sin(slope), -gravity * cos(slope), 0}, speed = k % 2 ? random_log(1e-4, 3) : 0;
        const double x[3] = {0, fall * random_uniform(0.001, 0.009), 0};
        double v[3] = {speed, -fall, 0}, impulse[3];
        const double along = speed + g[0] * 0.01;
        step_of_pair(x, v, g, &c, dt_G, impulse);
        const double rounding = 64 * EPS * 4 * fall;
        CHECK(v[0] >= -rounding && v[0] <= along + rounding, "friction brakes");
        const double bounce = c.restitution * (fall + 0.01 * gravity) / (1 + pow(dt_G / 2, 2));
        CHECK(v[1] >= -rounding && v[1] <= bounce + rounding, "a bounce, reduced by damping");
        CHECK(-impulse[1] > 0 && impulse[0] >= -rounding, "the collider pushes");
        CHECK_BELOW(fmax(0, impulse[0] + c.friction * impulse[1]), 8 * rounding, "friction beyond its limit");
    }
}

/* A particle that leaves a collider is not affected by it, also if it starts inside, and is moved out. */
static void damped_pair_leaves(void)
{
    for (int k = 0; k < 100; k++) {
        const spring_collider c = random_ground();
        const double x[3] = {0, k % 2 ? -random_log(1e-4, 0.1) : 0, 0}, before[3] = {1, random_log(0.01, 3), 0};
        double v[3] = {before[0], before[1], before[2]}, impulse[3];
        step_of_pair(x, v, none, &c, random_log(0.5, 1000), impulse);
        CHECK_BELOW(distance(v, before), 64 * EPS, "its velocity");
    }
}

/* max_speed limits velocities after bounces that damping has shortened. */
static void fastest_bounce(void)
{
    for (int k = 0; k < 400; k++) {
        spring_collider c = random_ground();
        c.friction *= 2;
        const double y = random_uniform(0, 0.02), x[2][3] = {{0, y, 0}, {0.3, y + random_uniform(-0.4, 0.4), 0}};
        const double v[2][3] = {{random_uniform(-5, 5), random_uniform(-8, 0), 0},
                                {random_uniform(-5, 5), random_uniform(-8, 3), 0}};
        const spring_link link = {
            .b = 1, .rest = hypot(0.3, x[1][1] - y), .stiffness = 100, .damping = random_log(100, 1e4)};
        spring_scene_def def = falling(2, x[0], v[0], 1);
        def.gravity[1] = 0, def.links = 1, def.link = &link;
        double fastest = 0, after[6];
        for (int limited = 0; limited < 3; limited++) {
            spring_scene *s = scene_with(&def, &c);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.01, 1) == (limited < 2 ? SPRING_OK : SPRING_EUNSTABLE),
                  "the velocity after the step is compared");
            spring_scene_get(s, SPRING_VELOCITY, after, 0, 0, 2);
            for (int i = 0; i < 6; i++)
                fastest = fmax(fastest, fabs(after[i]));
            def.max_speed = limited == 0 ? fastest : fastest * (1 - 4 * EPS);
            free(s);
        }
    }
}

/* A floor that no particle reaches changes nothing in the first step after it was set, however large the damping is. */
static void distant_floor(void)
{
    for (int k = 0; k < 100; k++) {
        enum { n = 6 };
        const double dt = 0.01, gap = random_log(1e-3, 0.1), size = 0.1, damping = random_log(0.5, 3e4) / (4 * dt);
        double x[n][3], v[n][3], end[2][n][3];
        spring_link link[n - 1];
        for (uint32_t i = 0; i < n; i++) {
            memcpy(x[i], (double[]){i * size, gap + (i % 2 ? 0.01 * size : 0), 0}, sizeof x[i]);
            memcpy(v[i], (double[]){random_uniform(-1, 1), random_uniform(0, 1), random_uniform(-1, 1)}, sizeof v[i]);
            if (i > 0)
                link[i - 1] = (spring_link){i - 1, i, size * hypot(1, 0.01), 100, damping, 0};
        }
        spring_scene_def def = falling(n, x[0], v[0], 1);
        def.gravity[1] = 0, def.links = n - 1, def.link = link;
        for (int floor = 0; floor < 2; floor++) {
            spring_collider c = ground;
            c.at[1] = floor ? 0 : -1e4, c.friction = 0.5;
            spring_scene *s = scene_with(&def, &c);
            run(s, SPRING_LEAPFROG, dt, 1);
            spring_scene_get(s, SPRING_VELOCITY, end[floor][0], 0, 0, n);
            free(s);
        }
        for (int i = 0; i < n; i++)
            CHECK_BELOW(distance(end[1][i], end[0][i]), 1e4 * EPS, "its velocity");
    }
}

/* A particle slides without friction or gravity through a fold of two faces: it loses the velocity into the second. */
static void folds(void)
{
    for (int k = 0; k < 60; k++) {
        const double angle = random_log(0.01, 1.2), r = 0.08, speed = random_uniform(0.5, 5);
        const double x[3] = {-0.3 * speed, r, 0}, v[3] = {speed, 0, 0}, dt = random_uniform(0.5, 1.5) / 480;
        faces fold = {2, {{0, 1, 0}, {-sin(angle), cos(angle), 0}}};
        const spring_collider c = {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .user = &fold, .thickness = 1};
        double now[3], u[3];
        end_of(ball_on(&c, 1, x, v, none, r), SPRING_LEAPFROG, dt, 480, now, u);
        CHECK_CLOSE(hypot(u[0], u[1]), speed * cos(angle), 1e3 * EPS * speed, "v cos(angle)");
    }
}

/* Where a heavily damped block is after 0.8 s [m], which slides sideways on a slope. */
static double place_on_slope(double dt)
{
    const double slope = 0.3, stiffness = 50, side = 0.1, damping = 0.5;
    double x[8][3], v[8][3] = {{0}}, sum = 0;
    spring_link link[28];
    spring_scene_def def = falling(8, x[0], v[0], 0.01);
    def.link = link;
    for (uint32_t a = 0; a < 8; a++) {
        turn((double[]){0, 0, slope}, (double[]){side * (a & 1), side * (a >> 1 & 1), side * (a >> 2)}, x[a]);
        v[a][2] = 1;
        for (uint32_t b = 0; b < a; b++)
            link[def.links++] = (spring_link){b, a, distance(x[a], x[b]), stiffness, damping, 0};
    }
    const spring_collider c = {.shape = SPRING_PLANE, .axis = {{-sin(slope), cos(slope), 0}}, .friction = 0.1};
    spring_scene *s = scene_with(&def, &c);
    run(s, SPRING_LEAPFROG, dt, (uint64_t)(0.8 / dt + 0.5));
    spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, 8);
    for (int a = 0; a < 8; a++)
        sum += x[a][2] / 8;
    free(s);
    return sum;
}

/* Friction turns with the velocity. If it kept the direction that it has at the start of a step, the error would be of
   first order, 4e-4 m here. */
static void damped_block_slides_sideways(void)
{
    const double fine = place_on_slope(0.0005), coarse = place_on_slope(0.004);
    CHECK_BELOW(fabs(coarse - fine), 5e-5, "m");
}

/* A heavy body stands on two feet of a fifteenth of its mass, with damped legs, on a level floor with friction. */
static void heavy_body_on_feet(void)
{
    static const double ratios[] = {1, 3, 10, 30, 100, 300}, steps[] = {0.9, 0.5, 0.25}, friction[] = {0.05, 0.2};
    for (int k = 0; k < 6 * 3 * 2; k++) {
        const double foot = 40, body = 600, damping = ratios[k % 6] * 2 * sqrt(4e4 * 300);
        const double x[9] = {-0.8, 0.3, 0, 0.8, 0.3, 0, 0.1, 1, 0}, mass[3] = {foot, foot, body};
        const spring_link link[3] = {{0, 1, 1.6, 2e6, 0.03 * sqrt(2 * 2e6 * foot), 0},
                                     {0, 2, 1.1 * hypot(0.9, 0.7), 4e4, damping, 0},
                                     {1, 2, 1.1 * hypot(0.7, 0.7), 4e4, damping, 0}};
        spring_scene_def def = falling(3, x, NULL, 0);
        def.mass = mass, def.links = 3, def.link = link, def.particle_radius = (scalar)0.3;
        spring_collider c = ground;
        c.friction = friction[k / 18];
        spring_scene *s = scene_with(&def, &c);
        const double dt = steps[k / 6 % 3] * spring_scene_stable_step(s, SPRING_LEAPFROG);
        double least = INFINITY, rise = 0, fall = 0;
        for (int i = 0; i * dt < 20; i++) {
            run(s, SPRING_LEAPFROG, dt, 1);
            const double now = total_energy(s);
            fall = i == 0 ? now : fall;
            least = fmin(least, now);
            rise = fmax(rise, now - least);
        }
        CHECK_BELOW(rise, 0.01 * (fall - least), "energy, in units of the energy lost");
        CHECK(spring_scene_at_rest(s, 1e-3, 0.1), "comes to rest");
        free(s);
    }
}

/* Bodies of particles of different masses that are all linked, with dampers of 0.3 to 1000 times the critical damping,
   fall on a slope or slide into a wall. Directions of links are frozen during a step, so energy may rise a little. */
static void damped_bodies_fall(void)
{
    enum { largest = 8 };
    double mean[2] = {0}; /* without and with restitution */
    const int bodies = 300;
    for (int i = 0; i < bodies; i++) {
        const uint32_t n = 4 + (uint32_t)random_uniform(0, 4.99);
        const double spread = random_log(1, 100), ratio = random_log(0.3, 1000), stiffness = random_log(100, 1e5);
        const double slope = i % 2 ? random_uniform(-0.4, 0.4) : 0, speed = random_uniform(0, 3);
        double x[largest][3], v[largest][3] = {{0}}, mass[largest];
        spring_link link[largest * largest];
        spring_scene_def def = falling(n, x[0], v[0], 0);
        def.mass = mass, def.link = link, def.colliders = i % 3 == 0 ? 2 : 1;
        for (uint32_t a = 0; a < n; a++) {
            mass[a] = random_log(1, spread);
            v[a][0] = speed;
            for (uint32_t k = 0; k < 3; k++)
                x[a][k] = random_uniform(-0.5, 0.5) + (k == 1 ? 1.2 : 0);
            for (uint32_t b = 0; b < a; b++) {
                const double reduced = mass[a] * mass[b] / (mass[a] + mass[b]);
                link[def.links++] =
                    (spring_link){b, a, distance(x[a], x[b]), stiffness, 2 * ratio * sqrt(stiffness * reduced), 0};
            }
        }
        const double friction = random_uniform(0, 1), restitution = i % 4 < 2 ? 0 : random_uniform(0, 0.8);
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{sin(slope), cos(slope), 0}}},
                                {.shape = SPRING_PLANE, .axis = {{-1, 0, 0}}, .at = {2, 0, 0}}};
        for (int k = 0; k < 2; k++)
            c[k].friction = friction, c[k].restitution = restitution;
        spring_scene *s = scene_with(&def, c);
        const double dt = random_uniform(0.3, 0.9) * spring_scene_stable_step(s, SPRING_LEAPFROG);
        double least = INFINITY, rise = 0, kinetic = 0;
        for (int k = 0; k * dt < 4; k++) {
            run(s, SPRING_LEAPFROG, dt, 1);
            least = fmin(least, total_energy(s));
            rise = fmax(rise, total_energy(s) - least);
            kinetic = fmax(kinetic, spring_scene_energy(s).kinetic);
        }
        mean[restitution > 0] += 2 * rise / kinetic / bodies;
        free(s);
    }
    printf("# energy rises by %.2g of the largest kinetic energy, on average; with restitution by %.2g\n", mean[0],
           mean[1]);
    CHECK_BELOW(mean[0], 0.003, "of the largest kinetic energy, on average");
    CHECK_BELOW(mean[1], 0.03, "with restitution");
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

/* A state does not have the functions of custom bodies: those of the scene stay, and must be in the same places. */
static void saved_bodies(void)
{
    const double x[3] = {0.7, 1, -0.9};
    spring_scene *s = particle_on(NULL, 2, x, none, down), *other = particle_on(NULL, 2, none, none, none);
    spring_collider c[2] = {unit_box, {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .thickness = 0.1}};
    c[1].user = &valley, c[1].friction = 0.1;
    c[0].at[1] = -5;
    c[0].acceleration[1] = 0.3;
    c[0].spin_acceleration[2] = 0.2;
    c[0].mask = c[1].mask = 6;
    c[1].surface[0] = 0.1;
    set(s, c, 2);
    run(s, SPRING_LEAPFROG, 1. / 480, 100);
    size_t bytes = 0;
    spring_scene_save(s, NULL, &bytes);
    uint8_t *const saved = malloc(bytes);
    CHECK(spring_scene_save(s, saved, &bytes) == SPRING_OK, "a state");
    CHECK(spring_scene_load(other, saved, bytes) == SPRING_EINVAL, "no custom body at index 1");
    const spring_collider wrong[2] = {c[1], c[0]};
    set(other, wrong, 2);
    CHECK(spring_scene_load(other, saved, bytes) == SPRING_EINVAL, "a custom body in another place");
    const spring_collider right[2] = {{.shape = SPRING_SPHERE, .radius = 1},
                                      {.shape = SPRING_CUSTOM, .gap = gaps_of_faces, .user = &valley, .thickness = 3}};
    set(other, right, 2);
    CHECK(spring_scene_load(other, saved, bytes) == SPRING_OK, "all but the function is in the state");
    run(s, SPRING_LEAPFROG, 1. / 480, 500);
    run(other, SPRING_LEAPFROG, 1. / 480, 500);
    CHECK(same_bits(s, other, 1, 3), "they go on alike");
    free(saved);
    free(s);
    free(other);
}

static const test tests[] = {
    {"damped body on a platform", damped_body_on_platform},
    {"damped body in a lift", damped_body_in_a_lift},
    {"heavy body on feet", heavy_body_on_feet},
    {"damped block slides sideways", damped_block_slides_sideways},
    {"floor of boxes", floor_of_boxes},
    {"room of boxes", room_of_boxes},
    {"room of planes", room_of_planes},
    {"wall on a floor", wall_on_a_floor},
    {"corner of planes", corner_of_planes},
    {"wall that jumps", wall_that_jumps},
    {"thin plates", thin_plates},
    {"thin walls", thin_walls},
    {"ball on an edge", ball_on_an_edge},
    {"waiting colliders", waiting_colliders},
    {"boxes on the ground", boxes_on_the_ground},
    {"carried far out", carried_far_out},
    {"corner of a custom body", corner_of_a_custom_body},
    {"folds", folds},
    {"damped bodies fall", damped_bodies_fall},
    {"damped bounces", damped_bounces},
    {"the fastest bounce", fastest_bounce},
    {"a damped pair leaves", damped_pair_leaves},
    {"a distant floor", distant_floor},
    {"lands on an end", lands_on_an_end},
    {"saved bodies", saved_bodies},
    {"a hit from rest", hit_from_rest},
    {"links at an edge", links_at_an_edge},
    {"a damped spring on the floor", damped_spring_on_floor},
    {"no tunnelling", no_tunnelling},
    {"momentum balance", momentum_balance},
    {"impulses", impulse_rules},
    {"impulses on all widths", impulses_on_all_widths},
    {"coupling", coupling},
    {"coupled oscillation", coupled_oscillation},
    {"coupled columns", coupled_columns},
    {"coupled blocks", coupled_blocks},
    {"coupled momenta", coupled_momenta},
    {"coupled rolling", coupled_rolling},
    {"attached bodies", attached_bodies},
    {"a damped link at rest", damped_link_at_rest},
    {"radius, friction and mask", values_of_particles},
    {"custom bodies", custom_bodies},
    {"order on custom bodies", custom_order},
    {"contacts of a custom body", contacts_of_a_custom_body},
    {"a turned box hits", turned_box_hits},
    {"a bead on a turning plane", bead_on_turning_plane},
    {"turntable", turntable},
    {"rocking box", rocking_box},
    {"platforms", platforms},
    {"a lift that starts", lift},
    {"friction across reversals", friction_across_reversals},
    {"grooves", grooves},
    {"wide grooves", wide_grooves},
    {"inside several", inside_several},
    {"between closing bodies", between_closing_bodies},
    {"crevice of round bodies", crevice_of_round_bodies},
    {"capsules that stretch", capsules_that_stretch},
    {"closing plates", closing_plates},
    {"spinning ball in motion", spinning_ball_in_motion},
};

int main(void)
{
    return RUN_TESTS("bodies", tests);
}
