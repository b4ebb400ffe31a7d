/* SPDX-License-Identifier: MIT */
/* Runs a scene while its state is finite, and measures and hashes the state; see scene_run.h. */
#include "scene_run.h"

#include <math.h> /* isfinite(), sqrt() */
#include <string.h>

double scene_run_step(double frame_rate, uint64_t steps_per_frame)
{
    return 1 / (frame_rate * (double)steps_per_frame);
}

double scene_run_total(const spring_scene_energies *e)
{
    return e->kinetic + e->elastic + e->gravity;
}

double scene_run_distance(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
}

bool scene_run_holds(const spring_scene *scene)
{
    const spring_scene_energies e = spring_scene_energy(scene);
    return isfinite(scene_run_total(&e));
}

static bool take(spring_scene *scene, void *saved, size_t bytes, spring_method m, double dt, uint64_t n)
{
    memcpy(saved, scene, bytes);
    if (spring_scene_advance(scene, m, dt, n) == SPRING_OK && scene_run_holds(scene))
        return true;
    memcpy(scene, saved, bytes);
    return false;
}

uint64_t scene_run_steps(spring_scene *scene, void *saved, size_t bytes, spring_method m, double dt, uint64_t n)
{
    if (take(scene, saved, bytes, m, dt, n))
        return n;
    uint64_t taken = 0;
    while (taken < n && take(scene, saved, bytes, m, dt, 1))
        taken++;
    return taken;
}

static uint64_t hash_number(uint64_t hash, double number)
{
    const uint64_t prime = 0x100000001b3;
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    for (int byte = 0; byte < 8; byte++)
        hash = (hash ^ (bits >> 8 * byte & 0xff)) * prime;
    return hash;
}

uint64_t scene_run_hash(const spring_scene *scene, size_t particles, uint32_t axes)
{
    static const spring_quantity quantities[] = {SPRING_POSITION, SPRING_VELOCITY};
    uint64_t hash = 0xcbf29ce484222325;
    for (int q = 0; q < 2; q++)
        for (size_t i = 0; i < particles; i++) {
            double numbers[3];
            spring_scene_get(scene, quantities[q], numbers, 0, i, 1);
            for (uint32_t a = 0; a < axes; a++)
                hash = hash_number(hash, numbers[a]);
        }
    return hash;
}
