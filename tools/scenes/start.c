/* SPDX-License-Identifier: MIT */
/* Presets and disturbances for programs; see start.h. */
#include "start.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"

void start_preset(preset *r, const preset_settings *s)
{
    const spring_status status = preset_init(r, s);
    if (status == SPRING_ERANGE)
        cli_fail(CLI_USAGE, "--size: \"%" PRIu64 "\" makes more particles or links than a scene can have", s->size);
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "no memory for a scene of this --size");
}

void start_links(preset *r, double bend, double tethers)
{
    spring_status status = bend > 0 ? preset_bend(r, bend) : SPRING_OK;
    if (status == SPRING_EINVAL)
        cli_fail(CLI_USAGE, "--bend: \"%g\" is too large; the stiffness should be finite", bend);
    if (status == SPRING_OK && tethers > 0)
        status = preset_tether(r, tethers);
    if (status != SPRING_OK && status != SPRING_ENOMEM)
        cli_fail(CLI_USAGE, "--tethers: \"%g\": %s; the stiffness of tethers should be finite", tethers,
                 spring_status_string(status));
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "no memory for tethers or weighted links");
}

spring_scene *start_definition(const spring_scene_def *def, size_t *bytes)
{
    size_t needed = 0;
    spring_scene *scene = NULL;
    void *memory = spring_scene_bytes(def, &needed) == SPRING_OK ? malloc(needed) : NULL;
    if (memory == NULL || spring_scene_init(memory, needed, def, &scene) != SPRING_OK)
        cli_fail(CLI_FAILED, "no memory for a scene of %zu particles and %zu links, %zu bytes", def->particles,
                 def->links, needed);
    if (bytes != NULL)
        *bytes = needed;
    return scene;
}

static double value_of(const spring_scene_def *def, const char *field, size_t index)
{
    return strcmp(field, "mass") == 0             ? def->mass[index]
           : strcmp(field, "mass_all") == 0       ? def->mass_all
           : strcmp(field, "drag") == 0           ? def->drag
           : strcmp(field, "gravity") == 0        ? def->gravity[index]
           : strcmp(field, "link.stiffness") == 0 ? def->link[index].stiffness
           : strcmp(field, "link.damping") == 0   ? def->link[index].damping
                                                  : (double)NAN;
}

spring_scene *start_scene(const preset *r, spring_method m, size_t *bytes)
{
    spring_scene_def def = r->def;
    def.methods = 1u << m | 1u << SPRING_LEAPFROG;
    const char *field;
    size_t index;
    spring_scene *scene;
    const spring_status status = spring_scene_check(&def, &field, &index);
    if (status == SPRING_EUNSUPPORTED)
        cli_fail(CLI_USAGE, "--method: \"%s\" is not for scenes whose links are damped", spring_method_name(m));
    if (status != SPRING_OK)
        cli_fail(CLI_USAGE,
                 "--mass, --end-mass, --stiffness, --damping, --drag, --tethers: %s (number %zu) of this scene is "
                 "\"%g\"; mass, 1/mass, 2 stiffness/mass, 2 damping/mass and drag/mass should be finite",
                 field, index, value_of(&def, field, index));
    if (preset_start(r, def.methods, 0, &scene, bytes) != SPRING_OK)
        cli_fail(CLI_FAILED, "no memory for a scene of %zu particles, %zu bytes", def.particles, *bytes);
    return scene;
}

spring_scenef *start_single(const preset *r)
{
    const spring_scene_def *const d = &r->def;
    spring_scenef_def def = {
        .axes = d->axes,
        .flags = d->flags,
        .methods = 1u << SPRING_LEAPFROG,
        .particles = d->particles,
        .links = d->links,
        .position = d->position,
        .velocity = d->velocity,
        .mass = d->mass,
        .mass_all = d->mass_all,
        .pinned = d->pinned,
        .link = d->link,
        .drag = d->drag,
        .weighted_links = d->weighted_links,
        .weighted_link = d->weighted_link,
    };
    memcpy(def.gravity, d->gravity, sizeof def.gravity);
    size_t bytes;
    spring_scenef *scene = NULL;
    if (spring_scenef_bytes(&def, &bytes) != SPRING_OK)
        return NULL;
    void *memory = malloc(bytes);
    if (memory == NULL || spring_scenef_init(memory, bytes, &def, &scene) != SPRING_OK)
        cli_fail(CLI_FAILED, "no memory for a scene of %zu particles, %zu bytes", def.particles, bytes);
    return scene;
}

double start_stable_step_in_float(const preset *r)
{
    spring_scenef *const scene = start_single(r);
    const double step = scene != NULL ? spring_scenef_stable_step(scene, SPRING_LEAPFROG) : (double)NAN;
    free(scene);
    return step;
}

double start_stable_step(const preset *r, spring_method m)
{
    size_t bytes;
    spring_scene *scene = start_scene(r, m, &bytes);
    const double step = spring_scene_stable_step(scene, m);
    free(scene);
    return step;
}

disturbances *start_disturbances(preset *r, const disturbance *list, size_t count)
{
    disturbances *p = disturbances_new(r, list, count);
    if (p == NULL)
        cli_fail(CLI_FAILED, "no memory for the disturbances on a scene");
    return p;
}

disturbances *start_poke(preset *r, const preset_settings *s)
{
    if (s->kind != PRESET_WATER)
        return NULL;
    const disturbance poke = disturbances_poke(r, s, disturbance_duration);
    return start_disturbances(r, &poke, 1);
}
