/* SPDX-License-Identifier: MIT */
/* Tension-only links: forces, energy and tension, order across the kink, and the bound on the stable step. */
#include "test_scene.h"

static const uint32_t shapes[][3] = {{3, 1, 1}, {7, 1, 1}, {6, 2, 1},  {30, 1, 1},
                                     {9, 7, 1}, {5, 4, 3}, {70, 4, 1}, {0, 0, 0}};

/* Infinite distances are noticed as with other links, and not taken for slack. */
static void too_far(void)
{
    const double far = sizeof(scalar) == 4 ? 3e38 : 1.7e308, x[] = {-far, 0, far, 0, 0, 1}, v[6] = {0};
    for (uint32_t flags = 0; flags <= SPRING_SCENE_TENSION_ONLY; flags += SPRING_SCENE_TENSION_ONLY)
        for (int damped = 0; damped < 2; damped++) {
            const spring_link link = {0, 1, 0.7, 3, damped};
            const spring_scene_def def = {
                .axes = 2, .flags = flags, .particles = 3, .links = 1, .position = x, .velocity = v, .link = &link};
            spring_scene *s = scene_of(&def);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 1) == SPRING_ENONFINITE, "an infinite force");
            free(s);
        }
}

/* ----------------------------------------------------------------------------------------------- order and free flight */

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
    const spring_link link = {0, 1, 1, k, 0};
    const spring_scene_def def = {.flags = SPRING_SCENE_TENSION_ONLY | SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                                  .particles = 2 + strangers,
                                  .links = 1,
                                  .position = x,
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = &link,
                                  .gravity = {0, -g, 0}};
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

int main(void)
{
    static const test tests[] = {
        {"too far apart", too_far},
        {"order across the kink", order_across_the_kink},
    };
    return RUN_TESTS("scene-tension", tests);
}
