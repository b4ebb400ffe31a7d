/* SPDX-License-Identifier: MIT */
/* Properties of every spring: symmetry, linearity, scaling, reversal. Most hold bit for bit. */
#include <math.h>

#include "check.h"
#include "test_methods.h"

static const int draws = 100000;

typedef struct draw {
    spring_params p;
    spring_state s;
    double dt;
    uint64_t n;
} draw;

static draw random_draw(void)
{
    draw d = {.p = {.mass = random_log(1e-2, 1e2), .stiffness = random_log(1e-2, 1e2)}};
    const double omega = sqrt(d.p.stiffness / d.p.mass);
    const uint64_t features = random_bits();
    if (features & 1)
        d.p.damping = random_log(1e-3, 3) * sqrt(d.p.mass * d.p.stiffness);
    if (features & 2)
        d.p.load = d.p.stiffness * random_uniform(-1, 1);
    d.s = (spring_state){random_uniform(-1, 1), random_uniform(-1, 1) * omega};
    d.dt = random_log(1e-3, 1) / omega;
    d.n = 1 + random_bits() % 30;
    return d;
}

static spring_state run(draw d, spring_method m)
{
    CHECK(spring_advance(&d.s, &d.p, m, d.dt, d.n) == SPRING_OK, "a stable run");
    return d.s;
}

static void mirror(void)
{
    for (int i = 0; i < draws; i++) {
        const draw d = random_draw();
        draw mirrored = d;
        mirrored.s = (spring_state){-d.s.x, -d.s.v};
        mirrored.p.load = -d.p.load;
        for (const spring_method *m = spring_methods(); *m != no_method; m++) {
            const spring_state a = run(d, *m), b = run(mirrored, *m);
            CHECK_STATE(b, ((spring_state){-a.x, -a.v}), "x, v, load -> -x, -v, -load");
        }
    }
}

static void powers_of_two(void)
{
    for (int i = 0; i < draws; i++) {
        const draw d = random_draw();
        draw longer = d, heavier = d, slower = d;
        longer.s = (spring_state){d.s.x * 8, d.s.v * 8};
        longer.p.load *= 8;
        heavier.p = (spring_params){d.p.mass * 4, d.p.stiffness * 4, d.p.damping * 4, d.p.load * 4};
        slower.p = (spring_params){d.p.mass, d.p.stiffness / 4, d.p.damping / 2, d.p.load / 4};
        slower.s.v /= 2;
        slower.dt *= 2;
        for (const spring_method *m = spring_methods(); *m != no_method; m++) {
            const spring_state a = run(d, *m), b = run(longer, *m), c = run(slower, *m);
            CHECK_STATE(b, ((spring_state){a.x * 8, a.v * 8}), "length in other units");
            CHECK_STATE(run(heavier, *m), a, "mass in other units");
            CHECK_STATE(c, ((spring_state){a.x, a.v / 2}), "time in other units");
        }
    }
}

static double size_of(draw d) /* [m], of any state on the way */
{
    const double omega = sqrt(d.p.stiffness / d.p.mass), z = omega * d.dt;
    const double growth = exp((double)d.n * z * z / 2); /* Euler's; the others grow less below z = 1 */
    return 3 * growth * (hypot(d.s.x, d.s.v / omega) + fabs(d.p.load / d.p.stiffness));
}

static void superposition(void)
{
    for (int i = 0; i < draws; i++) {
        draw a = random_draw(), b = a, both = a;
        b.s = (spring_state){random_uniform(-1, 1), random_uniform(-1, 1)};
        b.p.load = a.p.load != 0 ? random_uniform(-1, 1) : 0;
        both.s = (spring_state){a.s.x + b.s.x, a.s.v + b.s.v};
        both.p.load = a.p.load + b.p.load;
        const double omega = sqrt(a.p.stiffness / a.p.mass);
        const double bound = 6 * (double)(a.n + 1) * DBL_EPSILON * (size_of(a) + size_of(b) + size_of(both));
        for (const spring_method *m = spring_methods(); *m != no_method; m++) {
            const spring_state ya = run(a, *m), yb = run(b, *m), sum = run(both, *m);
            CHECK_CLOSE(sum.x, ya.x + yb.x, bound, "linear, except for 6 eps a step");
            CHECK_CLOSE(sum.v, ya.v + yb.v, bound * omega, "linear, except for 6 eps a step");
        }
    }
}

/* Leapfrog without damping retraces its steps. */
static void reversal(void)
{
    for (int i = 0; i < draws; i++) {
        draw d = random_draw();
        d.p.damping = 0;
        draw back = d, turned = d;
        const double omega = sqrt(d.p.stiffness / d.p.mass);
        const double bound = 12 * (double)d.n * DBL_EPSILON * size_of(d);
        const spring_state there = run(d, SPRING_LEAPFROG);
        back.s = there;
        back.dt = -d.dt;
        turned.s = (spring_state){there.x, -there.v};
        const spring_state by_time = run(back, SPRING_LEAPFROG), by_velocity = run(turned, SPRING_LEAPFROG);
        CHECK_CLOSE(by_time.x, d.s.x, bound, "n steps back with -dt");
        CHECK_CLOSE(by_time.v, d.s.v, bound * omega, "n steps back with -dt");
        CHECK_STATE(by_velocity, ((spring_state){by_time.x, -by_time.v}), "-dt and -v are the same motion, to the bit");
    }
}

static void energy_is_what_it_says(void)
{
    for (int i = 0; i < draws; i++) {
        const draw d = random_draw();
        const double kinetic = d.p.mass * d.s.v * d.s.v / 2, elastic = d.p.stiffness * d.s.x * d.s.x / 2;
        const double work = d.p.load * d.s.x;
        CHECK_CLOSE(spring_energy(&d.s, &d.p), kinetic + elastic - work,
                    4 * DBL_EPSILON * (kinetic + elastic + fabs(work)), "rounding of a sum of three");
        if (d.p.damping == 0) {
            const spring_state later = run(d, SPRING_EXACT);
            const double rest = d.p.load * d.p.load / d.p.stiffness;
            CHECK_CLOSE(spring_energy(&later, &d.p), spring_energy(&d.s, &d.p),
                        60 * (1 + sqrt(d.p.stiffness / d.p.mass) * d.dt * (double)d.n) * DBL_EPSILON *
                            (kinetic + elastic + fabs(work) + rest),
                        "conserved by the true solution");
        }
    }
}

/* Symplectic is to keep the area of phase space, and so is the description: the determinant of a step without damping. */
static void area(void)
{
    const spring_params p = {.mass = 1.3, .stiffness = 2.7};
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        spring_state a = {1, 0}, b = {0, 1};
        if (spring_advance(&a, &p, m, 0.4, 1) != SPRING_OK || spring_advance(&b, &p, m, 0.4, 1) != SPRING_OK)
            continue; /* not for one spring */
        CHECK((fabs(a.x * b.v - a.v * b.x - 1) <= 4 * DBL_EPSILON) == spring_method_describe(m)->symplectic,
              spring_method_name(m));
    }
}

int main(void)
{
    static const test tests[] = {
        {"mirrored", mirror},
        {"other units, powers of two", powers_of_two},
        {"superposition", superposition},
        {"reversal", reversal},
        {"area", area},
        {"energy", energy_is_what_it_says},
    };
    return RUN_TESTS("property", tests);
}
