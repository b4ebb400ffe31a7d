/* SPDX-License-Identifier: MIT */
/* The energy in very long runs of SRKN6 is bounded, without a drift beyond rounding error. */
#include <math.h>
#include <stdlib.h>

#include <springstep/scene.h>

#include "check.h"

enum { samples = 2000 };

/* The largest error of the energy, |E - E0|/|E0|, and the change of a line by least squares from the first sample to the last.
   That has the standard deviation 2 sqrt(3/samples) of the scatter about it if samples are independent; roundings add a
   random walk, whose line changes by about as much as the walk itself. Each of 23 kicks and drifts a step rounds by 0.3 eps
   of a part of the energy. */
static void check_energy(const double energy[samples + 1], double bound, double steps)
{
    double sum = 0, moment = 0, squares = 0, largest = 0, rest = 0;
    for (int i = 0; i <= samples; i++) {
        const double error = energy[i] / energy[0] - 1, at = 2.0 * i / samples - 1;
        sum += error;
        moment += error * at;
        squares += at * at;
        largest = fmax(largest, fabs(error));
    }
    const double mean = sum / (samples + 1), slope = moment / squares;
    for (int i = 0; i <= samples; i++)
        rest += pow(energy[i] / energy[0] - 1 - mean - slope * (2.0 * i / samples - 1), 2);
    const double noise = 4 * 2 * sqrt(3.0 / samples) * sqrt(rest / samples), walk = 3 * DBL_EPSILON * sqrt(23 * steps);
    CHECK_BELOW(largest, bound, "bounded at all times");
    CHECK_BELOW(fabs(2 * slope), noise + walk, "no drift: four standard deviations of the line, and rounding");
}

/* x'' = -x - 2 x y, y'' = -y - x^2 + y^2 */
static void henon_heiles_force(void *user, double t, size_t particles, const double *const x[3],
                               const double *const v[3], double *const force[3])
{
    (void)user, (void)t, (void)particles, (void)v;
    force[0][0] -= x[0][0] + 2 * x[0][0] * x[1][0];
    force[1][0] -= x[1][0] + x[0][0] * x[0][0] - x[1][0] * x[1][0];
}

/* E = 0.09, where some orbits are chaotic; 10^5 periods of 2 pi, 9 steps each. */
static void henon_heiles(void)
{
    const double position[] = {0.12, 0.1}, velocity[] = {0.3, 0.22};
    const spring_scene_def def = {.axes = 2,
                                  .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                                  .methods = 1u << SPRING_SRKN6,
                                  .particles = 1,
                                  .position = position,
                                  .velocity = velocity,
                                  .force = henon_heiles_force};
    const uint64_t periods = 100000, per_period = 9, n = periods * per_period / samples;
    const double dt = 6.283185307179586 / (double)per_period;
    size_t bytes = 0;
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "a valid definition");
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    spring_scene *s;
    CHECK(spring_scene_init(memory, bytes, &def, &s) == SPRING_OK, "a valid definition");
    double energy[samples + 1];
    for (int i = 0; i <= samples; i++) {
        double x[2], v[2];
        CHECK(i == 0 || spring_scene_advance(s, SPRING_SRKN6, dt, n) == SPRING_OK, "finite numbers");
        spring_scene_get(s, SPRING_POSITION, x, 0, 0, 1);
        spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
        energy[i] = (v[0] * v[0] + v[1] * v[1] + x[0] * x[0] + x[1] * x[1]) / 2 + x[0] * x[0] * x[1] - pow(x[1], 3) / 3;
    }
    check_energy(energy, 1e-6, (double)(periods * per_period));
    free(s);
}

int main(void)
{
    static const test tests[] = {
        {"Henon-Heiles over 10^5 periods", henon_heiles},
    };
    return RUN_TESTS("long_runs", tests);
}
