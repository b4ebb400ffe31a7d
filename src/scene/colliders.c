/* SPDX-License-Identifier: MIT */
/* Colliders of a scene: setting them, their poses during a step, and balance at rest. contact.c has the
   formulas of contacts. */
#include "block.h"
#include "../spring/roots.h"

#include "../simd/size_begin.h"

/* ------------------------------------------------------------------------------------------------------------ poses */

static void copy3(scalar to[3], vector3 from)
{
    to[0] = (scalar)from.x;
    to[1] = (scalar)from.y;
    to[2] = (scalar)from.z;
}

static double dot_of_vectors(vector3 a, vector3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* A finite bound for loops with SIMD, where infinity times 0 would be NaN. */
static scalar bounded(double value)
{
    return value > (double)SCALAR_MAX ? SCALAR_MAX : value < -(double)SCALAR_MAX ? -SCALAR_MAX : (scalar)value;
}

/* Bound k: a body in the precision of the scene. Its reach grows by more than the rounding errors of coordinates. */
static void place_bound(collider_bounds *bounds, unsigned k, const contact_body *b, scalar largest_radius)
{
    const double rounding = 64 * (double)SCALAR_EPSILON * (b->rounding_scale + (double)largest_radius);
    collider_bound *const to = &bounds->each[k];
    to->shape = is_custom(b->shape) ? SPRING_SPHERE : b->shape;
    copy3(to->at, b->start.at);
    copy3(to->shift, (vector3){b->end.at.x - b->start.at.x, b->end.at.y - b->start.at.y, b->end.at.z - b->start.at.z});
    for (int i = 0; i < 3; i++) {
        copy3(to->axis[i], b->start.axis[i]);
        to->half[i] = bounded(b->half[i]);
    }
    if (b->shape == SPRING_PLANE) {
        copy3(to->axis[1], b->end.axis[0]);
        to->offset[0] = (scalar)dot_of_vectors(b->start.axis[0], b->start.at);
        to->offset[1] = (scalar)dot_of_vectors(b->end.axis[0], b->end.at);
    }
    copy3(to->segment, b->start.segment);
    const double square = dot_of_vectors(b->start.segment, b->start.segment);
    to->inverse_square = square > 0 ? bounded(1 / square) : 0;
    to->reach = (scalar)((b->shape == SPRING_PLANE ? b->radius : b->reach) + rounding);
    to->growth = (scalar)b->growth;
    /* `rounding` once more for the clearance, since positions of colliders are rounded in each step. */
    const double margin = rounded_up * b->growth * (double)largest_radius + 2 * rounding;
    bounds->wide[k] = (scalar)(rounded_up * ((double)to->reach + b->growth * (double)largest_radius) + rounding);
    bounds->displacement[k] = (scalar)(rounded_up * spring_contact_motion(b));
    bounds->factor[k] = (scalar)(rounded_up * b->growth);
    for (int a = 0; a < 3; a++) {
        bounds->low[a][k] = (scalar)(b->low[a] - margin);
        bounds->high[a][k] = (scalar)(b->high[a] + margin);
    }
}

void spring_scene_place_colliders(spring_scene *s, double t0, double t1, bool all)
{
    const spring_collider *c = scene_read(s, ARRAY_COLLIDERS);
    contact_body *const body = scene_memory(s, ARRAY_PLACED);
    collider_bounds *const bounds = scene_memory(s, ARRAY_BOUNDS);
    const double skin =
        all ? spring_contact_skin(c, s->colliders, (double)SCALAR_EPSILON, s->layout.axes) : body[0].skin;
    bounds->count = s->colliders;
    for (uint32_t i = 0; i < s->colliders; i++) {
        if (all || body[i].moves) {
            spring_contact_place(&body[i], &c[i], skin, (double)SCALAR_EPSILON, t0, t1, s->layout.axes);
            place_bound(bounds, i, &body[i], s->largest_radius);
        }
    }
    for (uint32_t i = s->colliders; all && i < most_colliders; i++) { /* numbers, to fill the last vector */
        bounds->displacement[i] = bounds->wide[i] = bounds->factor[i] = 0;
        for (int a = 0; a < 3; a++)
            bounds->low[a][i] = bounds->high[a][i] = 0;
    }
}

/* The position of `at`, t after the colliders were set. */
static void find_origin(const spring_scene *s, const spring_collider *c, double t, double origin[3])
{
    for (uint32_t a = 0; a < 3; a++)
        origin[a] = a < s->layout.axes ? c->at[a] + t * c->velocity[a] + t * t / 2 * c->acceleration[a] : 0;
}

void spring_scene_begin_impulses(spring_scene *s, double t)
{
    const spring_collider *c = scene_read(s, ARRAY_COLLIDERS);
    spring_impulse *const sum = scene_memory(s, ARRAY_IMPULSES);
    double(*const origin)[3] = scene_memory(s, ARRAY_ORIGINS);
    for (uint32_t i = 0; i < s->colliders; i++) {
        sum[s->layout.colliders + i] = (spring_impulse){{0}, {0}};
        find_origin(s, &c[i], t, origin[i]);
    }
}

/* Moves the reference points of angular impulses to the positions at the end of the call. */
void spring_scene_end_impulses(spring_scene *s, double t)
{
    const spring_collider *c = scene_read(s, ARRAY_COLLIDERS);
    spring_impulse *const sum = scene_memory(s, ARRAY_IMPULSES);
    double(*const origin)[3] = scene_memory(s, ARRAY_ORIGINS);
    for (uint32_t i = 0; i < s->colliders; i++) {
        spring_impulse j = sum[s->layout.colliders + i];
        double end[3], arm[3];
        find_origin(s, &c[i], t, end);
        for (int a = 0; a < 3; a++)
            arm[a] = origin[i][a] - end[a];
        for (int a = 0; a < 3; a++)
            j.angular[a] += arm[(a + 1) % 3] * j.linear[(a + 2) % 3] - arm[(a + 2) % 3] * j.linear[(a + 1) % 3];
        sum[i] = j;
    }
}

/* ------------------------------------------------------------------------------------------------- public functions */

spring_status spring_scene_check_colliders(const spring_scene *s, const spring_collider *c, uint32_t count,
                                           const char **field, size_t *index)
{
    const char *name = NULL;
    spring_status status = SPRING_EINVAL;
    uint32_t i = 0;
    if (s == NULL)
        name = "scene";
    else if (c == NULL && count > 0)
        name = "c";
    else if (count > s->layout.colliders || s->layout.colliders == 0) {
        name = "count";
        status = s->layout.colliders == 0 ? SPRING_EDISABLED : SPRING_ERANGE;
    }
    while (name == NULL && i < count)
        if ((name = spring_collider_invalid_field(&c[i], sizeof(scalar), (double)s->largest_radius, s->layout.axes)) ==
            NULL)
            i++;
    if (field != NULL)
        *field = name;
    if (index != NULL)
        *index = name != NULL ? i : 0;
    return name != NULL ? status : SPRING_OK;
}

spring_status spring_scene_set_colliders(spring_scene *s, const spring_collider *c, uint32_t count)
{
    const spring_status status = spring_scene_check_colliders(s, c, count, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    spring_collider *const set = scene_memory(s, ARRAY_COLLIDERS);
    for (uint32_t i = 0; i < count; i++) {
        set[i] = c[i];
        spring_collider_orthonormalise(&set[i], s->layout.axes);
    }
    s->colliders = count;
    s->colliders_base = 0;
    s->colliders_from = s->steps;
    scene_clear_impulses(s);
    for (uint32_t buffer = 0; buffer < 2; buffer++) { /* without colliders no step writes them */
        uint32_t *const touched = scene_memory(s, touched_in(buffer));
        if (touched != NULL)
            memset(touched, 0, s->layout.particles * sizeof *touched);
    }
    return SPRING_OK;
}

spring_status spring_scene_get_colliders(const spring_scene *s, spring_collider *out, uint32_t *count)
{
    if (s == NULL || count == NULL)
        return SPRING_EINVAL;
    const uint32_t room = *count;
    *count = s->colliders;
    if (out == NULL || room < s->colliders)
        return out == NULL ? SPRING_OK : SPRING_ENOMEM;
    const double t = colliders_time(s);
    for (uint32_t i = 0; i < s->colliders; i++) {
        out[i] = ((const spring_collider *)scene_read(s, ARRAY_COLLIDERS))[i];
        if (t != 0)
            spring_collider_move(&out[i], t, s->layout.axes);
    }
    return SPRING_OK;
}

spring_status spring_scene_impulses(const spring_scene *s, spring_impulse *out, uint32_t first, uint32_t count)
{
    if (s == NULL || out == NULL)
        return SPRING_EINVAL;
    if (s->layout.colliders == 0)
        return SPRING_EDISABLED;
    if (first > s->colliders || count > s->colliders - first)
        return SPRING_ERANGE;
    const spring_impulse *const sum = scene_read(s, ARRAY_IMPULSES);
    memcpy(out, sum + first, count * sizeof *out);
    return SPRING_OK;
}

spring_status spring_scene_touching(const spring_scene *s, uint32_t *bits, size_t first, size_t count)
{
    if (s == NULL || bits == NULL)
        return SPRING_EINVAL;
    if (s->layout.colliders == 0)
        return SPRING_EDISABLED;
    if (first > s->layout.particles || count > s->layout.particles - first)
        return SPRING_ERANGE;
    const uint32_t *touched = scene_read(s, touched_in(s->buffer));
    memcpy(bits, touched + first, count * sizeof *bits);
    return SPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------------- at rest */

double spring_scene_balanced(const spring_scene *s, size_t i, const double accel[3])
{
    const uint32_t *touched = scene_read(s, touched_in(s->buffer));
    contact_surface surface[most_surfaces];
    contact_particle particle = {.touched = touched[i]};
    scene_contact_particle(s, i, &particle);
    double at[3] = {0};
    for (uint32_t a = 0; a < s->layout.axes; a++)
        at[a] = (double)scene_state(s, SPRING_POSITION, a)[i];
    const unsigned count = spring_contact_surfaces(scene_read(s, ARRAY_PLACED), s->colliders, &particle, true,
                                                   (vector3){at[0], at[1], at[2]}, (double)SCALAR_EPSILON, surface);
    return spring_contact_balance(surface, count, (vector3){accel[0], accel[1], accel[2]});
}

#include "../simd/size_end.h"
