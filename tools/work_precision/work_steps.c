/* SPDX-License-Identifier: MIT */
/*
 * The energy that motion gains with steps of different fractions of the stable step: the evidence for the rules for
 * steps. Each scene is released at rest or thrown, and runs for a minute or longer.
 */
#include "work_steps.h"

#include <math.h>
#include <stdlib.h>

#include <springstep/scene.h>

enum {
    STRUCTURAL = SPRING_GRID_STRUCTURAL,
    SHEARED = STRUCTURAL | SPRING_GRID_SHEAR,
    TENSION = SPRING_SCENE_TENSION_ONLY,
    MOST_PARTICLES = 128,
    ROOM = 4096
};

typedef struct steps_motion {
    const char *name;
    uint32_t count[3], families, flags;
    double stiffness, drag_rate; /* [N/m], [1/s] drag/mass */
    double ratio;                /* damping ratio of a link between two particles */
    double lean;                 /* how far the scene is released from hanging or standing straight; 1: level */
    double duration;             /* [s] */
    double span;  /* distance of two ends that are held, divided by the length between them; 0: one end is held */
    double speed; /* [m/s] at most, of each particle along each axis at the start */
} steps_motion;

static const double particle_mass = 0.03; /* [kg] */

static const steps_motion motions[] = {
    {"cloth", {10, 10, 1}, SHEARED, 0, 100, 0.1, 0, 1, 60, 0, 0},
    {"soft body", {4, 4, 4}, SHEARED, 0, 20, 0.1, 0, 1, 60, 0, 0},
    {"tension-only net", {10, 10, 1}, SHEARED, TENSION, 100, 0.1, 0, 1, 60, 0, 0},
    {"rope", {20, 1, 1}, STRUCTURAL, 0, 100, 0.1, 0, 1, 60, 0, 0},
    {"tension-only rope", {20, 1, 1}, STRUCTURAL, TENSION, 2000, 0.1, 0, 1, 60, 0, 0},
    {"thrown tension-only net", {10, 10, 1}, SHEARED, TENSION, 6400, 0.1, 0, 1, 60, 1, 4},
    {"thrown tension-only rope between two ends", {22, 1, 1}, STRUCTURAL, TENSION, 12800, 0.1, 0, 1, 60, 0.9, 4},
    {"rope with damped links", {20, 1, 1}, STRUCTURAL, 0, 100, 0, 0.02, 1, 60, 0, 0},
    {"tension-only rope with damped links", {20, 1, 1}, STRUCTURAL, TENSION, 2000, 0, 0.02, 1, 60, 0, 0},
    {"cloth with damped links", {10, 10, 1}, SHEARED, 0, 100, 0, 0.02, 1, 60, 0, 0},
    {"small motion of a rope", {20, 1, 1}, STRUCTURAL, 0, 10000, 0, 0, 0.1, 60, 0, 0},
    {"small motion of a cloth", {10, 10, 1}, SHEARED, 0, 10000, 0, 0, 0.1, 60, 0, 0},
    {"small motion of a rope, long", {20, 1, 1}, STRUCTURAL, 0, 10000, 0, 0, 0.1, 2000, 0, 0},
    {"rope", {20, 1, 1}, STRUCTURAL, 0, 100, 0, 0, 1, 60, 0, 0},
    {"rope, long", {20, 1, 1}, STRUCTURAL, 0, 100, 0, 0, 1, 2000, 0, 0},
    {"tension-only rope", {20, 1, 1}, STRUCTURAL, TENSION, 2000, 0, 0, 1, 60, 0, 0},
    {"tension-only net", {10, 10, 1}, SHEARED, TENSION, 100, 0, 0, 1, 60, 0, 0},
};

const char steps_columns[] = "problem motion drag_per_mass duration_s fraction energy_gain";

static double total_energy(const spring_scene *s)
{
    const spring_scene_energies e = spring_scene_energy(s);
    return e.kinetic + e.elastic + e.gravity;
}

/* The largest gain of energy, relative to the largest kinetic energy of the first two seconds. */
static double gain_of(const steps_motion *m, double fraction)
{
    static double position[MOST_PARTICLES][3], velocity[MOST_PARTICLES][3];
    static spring_link link[ROOM];
    static uint8_t pinned[MOST_PARTICLES];
    const spring_grid g = {.count = {m->count[0], m->count[1], m->count[2]},
                           .spacing = 0.1,
                           .stiffness = m->stiffness,
                           .damping = m->ratio * sqrt(2 * m->stiffness * particle_mass),
                           .families = m->families,
                           .pinned = SPRING_GRID_FIRST_X | (m->span > 0 ? SPRING_GRID_LAST_X : 0)};
    size_t particles, links, bytes;
    spring_scene *s = NULL;
    if (spring_grid_size(&g, &particles, &links) != SPRING_OK || particles > MOST_PARTICLES || links > ROOM)
        cli_fail(CLI_FAILED, "the grid of %s is too large", m->name);
    spring_grid_fill(&g, position[0], pinned, link);
    const double middle = (m->count[0] - 1) * g.spacing / 2, slope = sqrt(1 - m->span * m->span);
    for (size_t i = 0; i < 3 * particles; i++) /* in all directions, without a pattern */
        velocity[i / 3][i % 3] = pinned[i / 3] ? 0 : m->speed * sin(1.7 * (double)i + 0.01 * (double)(i * i));
    for (size_t i = 0; i < particles && m->span > 0; i++) { /* a level V of two straight halves */
        const double x = position[i][0];
        position[i][2] = slope * (x < middle ? x : 2 * middle - x);
        position[i][0] = m->span * x;
    }
    for (size_t i = 0; i < particles; i++) { /* along x, turned down to a part of its angle */
        const double angle = acos(0.0) * (1 - m->lean), x = position[i][0], y = position[i][1];
        position[i][0] = x * cos(angle) + y * sin(angle);
        position[i][1] = y * cos(angle) - x * sin(angle);
    }
    const spring_scene_def def = {.flags = m->flags | SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                                  .particles = particles,
                                  .links = links,
                                  .position = position[0],
                                  .velocity = velocity[0],
                                  .mass_all = particle_mass,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, -9.81, 0.3},
                                  .drag = m->drag_rate * particle_mass};
    if (spring_scene_bytes(&def, &bytes) != SPRING_OK || spring_scene_init(malloc(bytes), bytes, &def, &s) != SPRING_OK)
        cli_fail(CLI_FAILED, "no scene for %s", m->name);
    const double dt = fraction * spring_scene_stable_step(s, SPRING_LEAPFROG), before = total_energy(s);
    const uint64_t steps = (uint64_t)ceil(0.1 / dt);
    double kinetic = 0, gain = 0;
    for (uint64_t i = 0; (double)(i * steps) * dt < m->duration; i++) {
        if (spring_scene_advance(s, SPRING_LEAPFROG, dt, steps) != SPRING_OK) {
            gain = INFINITY;
            break;
        }
        if ((double)(i * steps) * dt < 2)
            kinetic = fmax(kinetic, spring_scene_energy(s).kinetic);
        gain = fmax(gain, total_energy(s) - before);
    }
    free(s);
    return gain < INFINITY ? gain / kinetic : INFINITY; /* the kinetic energy may have overflowed */
}

void steps_write(cli_table *table, bool quick)
{
    static const double fractions[] = {0.1, 0.125, 0.25, 0.5, 0.75, 0.9, 1.1};
    const size_t count = sizeof motions / sizeof motions[0];
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < sizeof fractions / sizeof fractions[0]; k++) {
            steps_motion m = motions[i];
            m.duration = quick ? fmin(m.duration, 30) : m.duration;
            cli_row(table, "steps\t%s\t%.3g\t%g\t%.3g\t%.3g", m.name, m.drag_rate, m.duration, fractions[k],
                    gain_of(&m, fractions[k]));
            cli_progress((double)(7 * i + k + 1) / (7.0 * (double)count));
        }
}
