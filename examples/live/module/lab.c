/* SPDX-License-Identifier: MIT */
/* Scenes of the live page: made, advanced, asked; see lab.h. */
#include "lab.h"

#include <math.h> /* sqrt() */
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_run.h"

static const double frame_rate = 60;

void lab_force(void *user, double t, size_t particles, const double *const position[3], const double *const velocity[3],
               double *const out[3])
{
    const lab *l = user;
    disturbances_force(l->pushes, t, particles, position, velocity, out);
    if (l->wind > 0)
        weather_force(l, t, position, out);
}

/* Without a callback steps take one pass over memory, with the same bits. But leapfrog keeps forces from step to step, and
   of damped links what it has kept decides the bits of the next: there the callback stays, and nothing is found again. */
void lab_feel(lab *l)
{
    const bool needed = l->wind > 0 || l->settings.damping > 0 || disturbances_any(l->pushes);
    if (needed != l->felt)
        spring_scene_set_force(l->scene, needed ? lab_force : NULL, l);
    l->felt = needed;
}

EXPORT void lab_free(lab *l)
{
    if (l == NULL)
        return;
    preset_clear(&l->preset);
    disturbances_free(l->pushes);
    free(l->scene);
    free(l->saved);
    free(l->before);
    free(l->now);
    free(l->drawn);
    free(l->ends);
    free(l->cut);
    free(l);
}

/* Of water nothing is edited, and links that cannot be take a byte each. */
static uint32_t flags_of(const lab *l)
{
    return l->settings.kind == PRESET_WATER ? 0 : SPRING_SCENE_EDITABLE;
}

static uint32_t all_methods(const preset *r)
{
    uint32_t methods = 0;
    for (int i = 0; i < SPRING_METHOD_COUNT; i++)
        if (preset_takes(r, (spring_method)i))
            methods |= 1u << i;
    return methods;
}

static bool allocate(lab *l)
{
    const size_t n = l->preset.def.particles, links = l->preset.def.links;
    l->saved = aligned_alloc(SPRING_SCENE_ALIGN, l->bytes);
    l->before = calloc(3 * n, sizeof *l->before);
    l->now = calloc(3 * n, sizeof *l->now);
    l->drawn = calloc(3 * n, sizeof *l->drawn);
    l->ends = calloc(2 * links, sizeof *l->ends);
    l->cut = calloc(links, sizeof *l->cut);
    return l->saved != NULL && l->before != NULL && l->now != NULL && l->drawn != NULL && l->ends != NULL &&
           l->cut != NULL;
}

static bool make(lab *l, bool calm)
{
    if (preset_init(&l->preset, &l->settings) != SPRING_OK)
        return false;
    l->pushes = disturbances_new(&l->preset);
    if (l->pushes == NULL ||
        preset_start(&l->preset, all_methods(&l->preset), flags_of(l), &l->scene, &l->bytes) != SPRING_OK)
        return false;
    if (!allocate(l))
        return false;
    for (size_t i = 0; i < l->preset.def.links; i++) {
        l->ends[2 * i] = l->preset.link[i].a;
        l->ends[2 * i + 1] = l->preset.link[i].b;
    }
    preset_positions(&l->preset, l->scene, l->now);
    memcpy(l->before, l->now, 3 * l->preset.def.particles * sizeof *l->now);
    l->random = 1;
    if (l->settings.kind == PRESET_WATER && !calm) {
        const disturbance poke = disturbances_poke(&l->preset, &l->settings, disturbance_duration);
        if (disturbances_add(l->pushes, &l->preset, &poke) != SPRING_OK)
            return false;
    }
    lab_feel(l);
    return true;
}

/* A scene of spring-scene, with what is a number in place of its defaults: size [particles], damping of links, drag
   [N s/m], mass, mass of the rope's end [kg], stiffness [N/m]; 0 or NaN: the default. Water is poked at the start unless
   it is to be calm. NULL if there is no such scene, or it cannot be. */
EXPORT lab *lab_new(uint32_t kind, uint32_t size, double damping, double drag, double mass, double end_mass,
                    double stiffness, bool calm)
{
    lab *l = kind < preset_kinds ? calloc(1, sizeof *l) : NULL;
    if (l == NULL)
        return NULL;
    preset_settings chosen = preset_unchosen((preset_kind)kind);
    chosen.size = size;
    chosen.damping = damping;
    chosen.drag = drag;
    chosen.mass = mass;
    chosen.end_mass = end_mass;
    chosen.stiffness = stiffness;
    l->settings = preset_chosen(&chosen);
    if (make(l, calm))
        return l;
    lab_free(l);
    return NULL;
}

/* The methods in the order of the table; -1: no more. */
EXPORT int32_t lab_method(int32_t i)
{
    return i < SPRING_METHOD_COUNT ? (int32_t)spring_method_at(i) : -1;
}

/* Scenes by their place; NULL: no more. */
EXPORT const char *lab_scene_name(uint32_t kind)
{
    return preset_names[kind];
}

EXPORT const char *lab_method_name(uint32_t method)
{
    return spring_method_name((spring_method)method);
}

EXPORT uint32_t lab_method_order(uint32_t method)
{
    return (uint32_t)spring_method_describe((spring_method)method)->order;
}

EXPORT uint32_t lab_forces_per_step(uint32_t method)
{
    return (uint32_t)spring_method_describe((spring_method)method)->forces_per_step;
}

EXPORT bool lab_takes(const lab *l, uint32_t method)
{
    return preset_takes(&l->preset, (spring_method)method);
}

/* All of n steps, and what is drawn before the last of them; where it explodes false, and the scene as it was. */
static bool take(lab *l, spring_method m, double dt, uint64_t n)
{
    memcpy(l->saved, l->scene, l->bytes);
    bool holds = spring_scene_advance(l->scene, m, dt, n - 1) == SPRING_OK;
    preset_positions(&l->preset, l->scene, l->before);
    holds = holds && spring_scene_advance(l->scene, m, dt, 1) == SPRING_OK && scene_run_holds(l->scene);
    if (!holds)
        memcpy(l->scene, l->saved, l->bytes);
    return holds;
}

/* Takes n steps of 1/(60 steps_per_frame) s, or as many as the scene survives; returns how many. */
EXPORT uint32_t lab_advance(lab *l, uint32_t method, uint32_t steps_per_frame, uint32_t n)
{
    const double dt = scene_run_step(frame_rate, steps_per_frame), duration = n * dt, now = spring_scene_time(l->scene);
    if (n == 0)
        return 0;
    hand_pull(l, duration);
    weather_rain(l, now + duration);
    weather_ball(l, duration);
    const bool all = take(l, (spring_method)method, dt, n);
    const uint64_t taken = all ? n : scene_run_steps(l->scene, l->saved, l->bytes, (spring_method)method, dt, n);
    preset_positions(&l->preset, l->scene, l->now);
    if (!all) /* what take() saw last is no state of this scene: it is drawn as it is now */
        memcpy(l->before, l->now, 3 * l->preset.def.particles * sizeof *l->now);
    disturbances_forget(l->pushes, spring_scene_time(l->scene));
    lab_feel(l);
    return (uint32_t)taken;
}

/* How many steps are due when `elapsed` seconds have passed; what is beyond the most is given up. */
EXPORT uint32_t lab_due(lab *l, double elapsed, uint32_t steps_per_frame, uint32_t most_steps)
{
    double alpha;
    const double dt = scene_run_step(frame_rate, steps_per_frame);
    return (uint32_t)spring_clock_tick(&l->clock, elapsed, dt, most_steps, &alpha);
}

/* x y z of all particles [m], between the last two states: at the time that the clock holds. */
EXPORT const float *lab_draw(lab *l, uint32_t steps_per_frame)
{
    const double dt = scene_run_step(frame_rate, steps_per_frame), part = l->clock.pending / dt,
                 alpha = part < 1 ? part : 1;
    for (size_t i = 0; i < 3 * l->preset.def.particles; i++)
        l->drawn[i] = (float)(l->before[i] + alpha * (l->now[i] - l->before[i]));
    return l->drawn;
}

EXPORT uint32_t lab_particles(const lab *l)
{
    return (uint32_t)l->preset.def.particles;
}

EXPORT uint32_t lab_links(const lab *l)
{
    return (uint32_t)l->preset.def.links;
}

/* Particles along x, y, z. */
EXPORT uint32_t lab_count(const lab *l, uint32_t axis)
{
    return l->preset.count[axis];
}

EXPORT const uint8_t *lab_pinned(const lab *l)
{
    return l->preset.pinned;
}

EXPORT double lab_length(const lab *l)
{
    return l->settings.length;
}

/* Of the particle that is heaviest, over that of the others. */
EXPORT double lab_mass_ratio(const lab *l)
{
    return l->settings.kind == PRESET_ROPE ? l->settings.end_mass / l->settings.mass : 1;
}

EXPORT double lab_time(const lab *l)
{
    return spring_scene_time(l->scene);
}

/* Kinetic, elastic, of gravity [J]; until it is called again. */
EXPORT const spring_scene_energies *lab_energies(lab *l)
{
    l->energies = spring_scene_energy(l->scene);
    return &l->energies;
}

EXPORT double lab_stable_step(lab *l, uint32_t method)
{
    return spring_scene_stable_step(l->scene, (spring_method)method);
}

EXPORT uint64_t lab_hash(const lab *l)
{
    return scene_run_hash(l->scene, l->preset.def.particles, l->preset.def.axes);
}

/* Of the positions of two labs of one scene, root mean square [m]. */
EXPORT double lab_distance(const lab *a, const lab *b)
{
    const size_t n = 3 * a->preset.def.particles;
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += (a->now[i] - b->now[i]) * (a->now[i] - b->now[i]);
    return sqrt(sum / (double)a->preset.def.particles);
}

/* The largest distance of a particle from its start [m]. */
EXPORT double lab_farthest(const lab *l)
{
    double most = 0;
    for (size_t i = 0; i < l->preset.def.particles; i++) {
        const double *p = &l->now[3 * i], *q = &l->preset.start[3 * i];
        const double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]}, square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        most = square > most ? square : most;
    }
    return sqrt(most);
}

/* As spring-scene --poke. It begins with no force, so one that has been kept holds. */
EXPORT bool lab_poke(lab *l, double start, double x, double y, double peak, double area)
{
    const disturbance d = {start, disturbance_duration, x, y, peak, area, DISTURBANCE_ROUND};
    const bool done = disturbances_add(l->pushes, &l->preset, &d) == SPRING_OK;
    lab_feel(l);
    return done;
}
