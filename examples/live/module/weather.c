/* SPDX-License-Identifier: MIT */
/* Wind, rain, and a ball that falls into the water. */
#include <math.h> /* sqrt() */

#include "scenes/random.h"
#include "lab.h"

/* --------------------------------------------------------------------------------------------------------- wind */

/* A number in [-1, 1] that changes smoothly within a second. */
static double noise(double t, uint64_t stream)
{
    const double whole = (double)(int64_t)t, part = t - whole, smooth = part * part * (3 - 2 * part);
    uint64_t a = stream + (uint64_t)(int64_t)t, b = a + 1;
    const double first = random_unit(&a), second = random_unit(&b);
    return 2 * (first + smooth * (second - first)) - 1;
}

EXPORT void lab_wind(lab *l, double speed)
{
    l->wind = l->preset.def.axes == 3 ? speed : 0; /* what it blows at is on three axes */
    lab_feel(l);
    if (l->felt)
        spring_scene_set_force(l->scene, lab_force, l); /* at once: one that has been kept is of another wind */
}

static void difference(const double *const x[3], size_t a, size_t b, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = x[k][b] - x[k][a];
}

/* Pressure of still air on a sheet in the wind: F = rho/2 |w| (w n) A, n and A of the cells around a particle. It looks
   at positions alone, as the scene was promised, and at all three axes of them. */
void weather_force(const lab *l, double t, const double *const x[3], double *const force[3])
{
    const double density = 1.2; /* [kg/m^3] */
    const uint32_t columns = l->preset.count[0], rows = l->preset.count[1];
    const double gust = 0.75 + 0.25 * noise(1.3 * t, 1000);
    const double wind[3] = {l->wind * 0.35 * noise(0.7 * t, 2000), l->wind * gust,
                            l->wind * 0.3 * noise(0.9 * t, 3000)};
    const double speed = sqrt(wind[0] * wind[0] + wind[1] * wind[1] + wind[2] * wind[2]);
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            const uint32_t left = i > 0 ? i - 1 : i, right = i + 1 < columns ? i + 1 : i;
            const uint32_t up = j > 0 ? j - 1 : j, down = j + 1 < rows ? j + 1 : j;
            double u[3], v[3];
            difference(x, left + (size_t)columns * j, right + (size_t)columns * j, u);
            difference(x, i + (size_t)columns * up, i + (size_t)columns * down, v);
            const double area[3] = {0.25 * (u[1] * v[2] - u[2] * v[1]), 0.25 * (u[2] * v[0] - u[0] * v[2]),
                                    0.25 * (u[0] * v[1] - u[1] * v[0])};
            const double size = sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
            const double along = wind[0] * area[0] + wind[1] * area[1] + wind[2] * area[2];
            const double pressure = size > 0 ? 0.5 * density * speed * along / size : 0;
            for (int k = 0; k < 3; k++)
                force[k][i + (size_t)columns * j] += pressure * area[k];
        }
}

/* --------------------------------------------------------------------------------------------------------- rain */

EXPORT void lab_rain(lab *l, double drops_per_second)
{
    l->rain = drops_per_second;
    l->next_drop = spring_scene_time(l->scene);
}

void weather_rain(lab *l, double until)
{
    if (!(l->rain > 0))
        return;
    bool any = false;
    for (const double gap = 1 / l->rain; l->next_drop < until; l->next_drop += gap, any = true) {
        const disturbance d = disturbances_drop(&l->preset, &l->settings, l->next_drop, l->next_drop + gap,
                                                disturbance_duration, &l->random);
        disturbances_add(l->pushes, &l->preset, &d);
    }
    if (any)
        lab_feel(l);
}

/* --------------------------------------------------------------------------------------------------------- ball */

static const double ball_radius = 0.28, ball_mass = 12; /* [m], [kg] */

EXPORT void lab_ball_drop(lab *l, double x, double y, double height)
{
    l->ball = (ball){.there = true, .x = x, .y = y, .state = {height, 0}};
}

/* [m] of the water where the ball is. */
static double level(const lab *l)
{
    const double spacing = l->settings.length / (double)(l->settings.size - 1);
    const uint32_t i = (uint32_t)(l->ball.x / spacing + 0.5), j = (uint32_t)(l->ball.y / spacing + 0.5);
    return l->now[3 * (i + (size_t)l->preset.count[0] * j) + 2];
}

/* Into the water: what the ball brings along the water gets, and it stays afloat. */
static void splash(lab *l)
{
    const double pi = 3.14159265358979323846;
    const disturbance d = {.start = spring_scene_time(l->scene),
                           .duration = disturbance_duration,
                           .x = l->ball.x,
                           .y = l->ball.y,
                           .peak = disturbances_peak(-ball_mass * l->ball.state.v, disturbance_duration),
                           .area = pi * ball_radius * ball_radius};
    disturbances_add(l->pushes, &l->preset, &d);
    lab_feel(l);
    l->ball.afloat = true;
    l->ball.state.v *= 0.3;
}

void weather_ball(lab *l, double duration)
{
    ball *b = &l->ball;
    if (!b->there)
        return;
    spring_params p = {.mass = 1, .load = -9.81};
    if (b->afloat) { /* it swings about the height of the water, which is its goal */
        p = spring_params_hertz(4, 0.2);
        p.load = p.stiffness * (level(l) + 0.35 * ball_radius);
    }
    spring_step_exact(&b->state, &p, duration);
    if (!b->afloat && b->state.x < level(l) + 0.5 * ball_radius)
        splash(l);
}

EXPORT bool lab_ball_there(const lab *l)
{
    return l->ball.there;
}

/* 0: x, 1: y, 2: height of its centre, 3: radius [m] */
EXPORT double lab_ball(const lab *l, uint32_t which)
{
    return which == 0 ? l->ball.x : which == 1 ? l->ball.y : which == 2 ? l->ball.state.x : ball_radius;
}
