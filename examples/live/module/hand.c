/* SPDX-License-Identifier: MIT */
/* The hand of the live page: it grabs a particle, pulls it no faster than the scene can follow, and tears links. */
#include <math.h> /* sqrt() */

#include "lab.h"

/* [m/s] Half of the speed of waves, with which links stretch to two or three times their length at worst; docs/hand.md. */
static double speed_limit(const lab *l)
{
    const double spacing = l->settings.length / (double)(l->settings.size - 1);
    return 0.5 * spacing * sqrt(l->settings.stiffness / l->settings.mass);
}

/* The axes of the scene in x y z of what is drawn. */
static uint32_t shown(const lab *l, uint32_t axis)
{
    const uint32_t axes = l->preset.def.axes;
    return axes == 1 ? 2 : axes == 2 && axis == 1 ? 2 : axis;
}

EXPORT void lab_release(lab *l)
{
    if (l->held && !l->was_pinned) {
        const uint8_t no = 0;
        spring_scene_set_pinned(l->scene, l->particle, 1, &no);
    } else if (l->held) {
        spring_scene_drive(l->scene, l->particle, NULL, 1);
    }
    l->held = false;
}

EXPORT void lab_grab(lab *l, uint32_t particle)
{
    lab_release(l);
    if (particle >= l->preset.def.particles)
        return;
    const uint8_t yes = 1;
    l->was_pinned = l->preset.pinned[particle];
    l->held = spring_scene_set_pinned(l->scene, particle, 1, &yes) == SPRING_OK;
    l->particle = particle;
    for (int a = 0; a < 3; a++)
        l->target[a] = l->now[3 * particle + (uint32_t)a];
}

EXPORT void lab_drag(lab *l, double x, double y, double z)
{
    l->target[0] = x;
    l->target[1] = y;
    l->target[2] = z;
}

void hand_pull(lab *l, double duration)
{
    if (!l->held)
        return;
    const uint32_t axes = l->preset.def.axes;
    double position[3], square = 0;
    spring_scene_get(l->scene, SPRING_POSITION, position, 0, l->particle, 1);
    for (uint32_t a = 0; a < axes; a++) {
        const double d = l->target[shown(l, a)] - position[a];
        square += d * d;
    }
    const double most = speed_limit(l) * duration, part = square > most * most ? most / sqrt(square) : 1;
    for (uint32_t a = 0; a < axes; a++)
        position[a] += part * (l->target[shown(l, a)] - position[a]);
    spring_scene_drive(l->scene, l->particle, position, duration);
}

static void cut(lab *l, size_t i)
{
    spring_link link;
    spring_scene_get_link(l->scene, i, &link);
    link.stiffness = link.damping = 0;
    spring_scene_set_link(l->scene, i, &link);
    l->cut[i] = 1;
    l->cuts++;
}

static double distance_square(const lab *l, uint32_t i, uint32_t j)
{
    const double *p = &l->now[3 * i], *q = &l->now[3 * j];
    return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]);
}

/* Cuts the links that are longer than `most` times their rest length; returns how many are cut by now. */
EXPORT uint32_t lab_tear(lab *l, double most)
{
    for (size_t i = 0; i < l->preset.def.links; i++) {
        const double limit = most * l->preset.link[i].rest;
        if (!l->cut[i] && distance_square(l, l->ends[2 * i], l->ends[2 * i + 1]) > limit * limit)
            cut(l, i);
    }
    return l->cuts;
}

/* Cuts all links of a particle. */
EXPORT uint32_t lab_snip(lab *l, uint32_t particle)
{
    for (size_t i = 0; i < l->preset.def.links; i++)
        if (!l->cut[i] && (l->ends[2 * i] == particle || l->ends[2 * i + 1] == particle))
            cut(l, i);
    return l->cuts;
}

EXPORT const uint8_t *lab_cut(const lab *l)
{
    return l->cut;
}

EXPORT const uint32_t *lab_ends(const lab *l)
{
    return l->ends;
}
