/* SPDX-License-Identifier: MIT */
/* Cloth, rope, water, drape and cape as mass-spring scenes; see world.h. */
#include "world.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const world_names[WORLD_KINDS] = {"cloth", "rope", "water", "drape", "cape"};

/* A curtain on hooks, a rope with a ball at its end, a pool 4 m wide, a cloth above a sphere, a cape. The stable step
   depends on the sum of the stiffnesses at a particle, 8 links in a sheet. For leapfrog, one step per frame of 1/60 s
   is too long in water, and about a dozen are too long in the other scenes. */
static const struct recipe {
    spring_grid grid;
    double mass, drag; /* [kg], [N s/m] of a particle */
    double gravity;    /* [m/s^2] */
} recipes[WORLD_KINDS] = {
    [WORLD_CLOTH] = {{.count = {37, 27},
                      .axes = 3,
                      .spacing = 0.05,
                      .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                      .stiffness = 400},
                     .mass = 0.01,
                     .drag = 0.004,
                     .gravity = 9.81},
    [WORLD_ROPE] = {{.count = {48}, .axes = 2, .spacing = 0.04, .stiffness = 6000, .pinned = SPRING_GRID_FIRST_X},
                    .mass = 0.02,
                    .drag = 0.008,
                    .gravity = 9.81},
    [WORLD_WATER] = {{.count = {61, 61},
                      .axes = 1,
                      .height = true,
                      .spacing = 4.0 / 60,
                      .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                      .stiffness = 320,
                      .pinned = SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y},
                     .mass = 0.2,
                     .drag = 0.08},
    [WORLD_DRAPE] = {{.count = {31, 31},
                      .axes = 3,
                      .spacing = 0.045,
                      .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                      .stiffness = 100},
                     .mass = 0.005,
                     .drag = 0.005,
                     .gravity = 9.81},
    [WORLD_CAPE] = {{.count = {20, 30},
                     .axes = 3,
                     .spacing = 0.04,
                     .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                     .stiffness = 600,
                     .pinned = SPRING_GRID_FIRST_Y},
                    .mass = 0.01,
                    .drag = 0.008,
                    .gravity = 9.81},
};

static const double skin = 0.012;       /* [m] radius of the particles of drape and cape */
static const double sphere = 0.35;      /* [m] radius, under the drape */
static const double body_radius = 0.18; /* [m] of the capsule with the cape; heights of its ends below */
static const double body_low = 0.35, body_high = 1.3;
static const double pace = 2.2, course = 3.0; /* [m/s] of the body, [m] its path between teleports */

static const double ball = 0.5;        /* [kg] at the end of the rope */
static const double strongest = 0.035; /* [N] on a particle: a third of its weight */
static const uint32_t hook_every = 6;  /* one hook per so many particles of the upper edge */
static const double gathered = 0.85;   /* width of the curtain relative to its cloth */
static const double most_energy = 1e5; /* [J] more than dragging can add, so the method is unstable */
static const double two_pi = 6.28318530717958648;

/* For calls that are valid: a failure is an error in this file. */
static void must(spring_status status, const char *what)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "springs: %s: %s\n", what, spring_status_string(status));
    abort();
}

/* ------------------------------------------------------------------------------------------------ how worlds begin */

/* Folds from hook to hook: a sine with the arc length of the cloth. */
static vec3 curtain(double column, double row, double spacing)
{
    const double fold = two_pi * column / hook_every, deep = 0.13 * hook_every * spacing * gathered;
    return (vec3){gathered * spacing * column, -spacing * row, deep * sin(fold)};
}

static vec3 hanging_aside(double along)
{
    return (vec3){0.8 * along, -0.6 * along, 0};
}

/* The drape starts level above the sphere, turned a little. */
static vec3 above_the_sphere(double column, double row, double spacing)
{
    const double x = spacing * (column - 15), z = spacing * (row - 15);
    return (vec3){0.92 * x - 0.38 * z, 1.1, 0.38 * x + 0.92 * z};
}

/* The cape hangs on an arc behind the neck of a body that faces to the right. */
static vec3 behind_the_neck(double column, double row, double spacing)
{
    const double arc = body_radius + 2 * skin, angle = (column - 9.5) * spacing / arc;
    return (vec3){-arc * cos(angle), body_high + 0.05 - spacing * row, arc * sin(angle)};
}

/* The position of the body at a time [s]. It jumps once on its path, then starts again. */
static vec3 body_at(const world *w, double time)
{
    const double far = pace * time - w->away, jump = (far - 1.1) / pace; /* [s] since the jump */
    return (vec3){far - course / 2, jump > 0 && jump < 0.55 ? 9.81 / 2 * jump * (0.55 - jump) : 0, 0};
}

bool world_has_bodies(const world *w)
{
    return w->kind == WORLD_DRAPE || w->kind == WORLD_CAPE;
}

static void set_home(world *w)
{
    for (uint32_t row = 0; row < w->rows; row++)
        for (uint32_t column = 0; column < w->columns; column++) {
            vec3 *p = &w->home[column + w->columns * row];
            if (w->kind == WORLD_CLOTH)
                *p = curtain(column, row, w->spacing);
            else if (w->kind == WORLD_ROPE)
                *p = hanging_aside(column * w->spacing);
            else if (w->kind == WORLD_DRAPE)
                *p = above_the_sphere(column, row, w->spacing);
            else if (w->kind == WORLD_CAPE) {
                *p = behind_the_neck(column, row, w->spacing);
                p->x -= course / 2;
            } else
                *p = (vec3){column * w->spacing, 0, row * w->spacing};
        }
}

/* Gusts that travel across the cloth. The callback does not use velocities; see SPRING_SCENE_FORCE_IGNORES_VELOCITY. */
static void blow(void *user, double t, size_t particles, const double *const position[3],
                 const double *const velocity[3], double *const force[3])
{
    const world *w = user;
    (void)position;
    (void)velocity;
    for (size_t i = 0; i < particles; i++)
        force[2][i] += w->wind * (0.4 + sin(0.7 * t) * sin(1.9 * t - 2.5 * w->home[i].x + w->home[i].y));
}

/* --------------------------------------------------------------------------------------------- between axes and xyz */

/* Coordinates along the axes of the scene. For water, the only axis is the height. */
static void to_axes(const world *w, vec3 p, double own[3])
{
    own[0] = w->axes == 1 ? p.y : p.x;
    own[1] = p.y;
    own[2] = p.z;
}

static void get_positions(const world *w, vec3 *out)
{
    for (size_t i = 0; i < w->particles; i++)
        out[i] = w->home[i];
    double *first = w->axes == 1 ? &out[0].y : &out[0].x;
    must(spring_scene_get(w->scene, SPRING_POSITION, first, 3, 0, w->particles), "get");
}

/* ------------------------------------------------------------------------------------------------- making, freeing */

/* All methods for scenes, so that the user can change the method at any time. RKN8 and SRKN6 do not support damped
   links, so links are created without damping, and world_set_damping() is called later. They do not support contacts
   either. */
static uint32_t all_methods(const world *w)
{
    uint32_t methods = 0;
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        const spring_method_info *info = spring_method_describe(m);
        if (info->scenes && !(info->positions_only && world_has_bodies(w)))
            methods |= 1u << m;
    }
    return methods;
}

static bool make_scene(world *w, const struct recipe *r)
{
    static double position[3 * MOST_PARTICLES], mass[MOST_PARTICLES];
    must(spring_grid_fill(&r->grid, position, w->pinned, w->link), "grid");
    set_home(w);
    for (size_t i = 0; i < w->particles; i++) {
        double own[3];
        to_axes(w, w->home[i], own);
        for (uint32_t axis = 0; axis < w->axes; axis++)
            position[w->axes * i + axis] = own[axis];
        mass[i] = r->mass;
        w->previous[i] = w->current[i] = w->home[i];
    }
    if (w->kind == WORLD_ROPE)
        mass[w->particles - 1] = ball;
    if (w->kind == WORLD_CLOTH)
        for (uint32_t column = 0; column < w->columns; column += hook_every)
            w->pinned[column] = 1;
    const bool bodies = world_has_bodies(w);
    const spring_scene_def def = {.axes = w->axes,
                                  .flags = SPRING_SCENE_EDITABLE | SPRING_SCENE_FORCE_IGNORES_VELOCITY,
                                  .methods = all_methods(w),
                                  .particles = w->particles,
                                  .links = w->links,
                                  .position = position,
                                  .mass = mass,
                                  .pinned = w->pinned,
                                  .link = w->link,
                                  .gravity = {0, -r->gravity},
                                  .drag = r->drag,
                                  .colliders = bodies ? WORLD_BODIES : 0,
                                  .particle_radius = bodies ? skin : 0};
    size_t bytes;
    must(spring_scene_bytes(&def, &bytes), "definition");
    void *memory = malloc(bytes);
    if (memory != NULL)
        must(spring_scene_init(memory, bytes, &def, &w->scene), "scene"); /* freed with its memory */
    return memory != NULL;
}

static void set_bodies(world *w)
{
    w->body[1] = (spring_collider){.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .friction = 0.8};
    must(spring_scene_set_colliders(w->scene, w->body, WORLD_BODIES), "bodies");
}

/* Moves the capsule and the pinned edge of the cape to the position of the body at the end of these steps. At the end
   of its path everything is moved back by a transform, which does not stretch links. */
static void move_body(world *w, double duration)
{
    const double time = spring_scene_time(w->scene);
    if (pace * time - w->away > course) {
        const double back[12] = {1, 0, 0, -course, 0, 1, 0, 0, 0, 0, 1, 0};
        must(spring_scene_transform(w->scene, back), "teleport");
        w->away += course;
        w->hand.x -= course;
    }
    const vec3 here = body_at(w, time), there = body_at(w, time + duration);
    const double u[2] = {(there.x - here.x) / duration, (there.y - here.y) / duration};
    w->body[0] = (spring_collider){.shape = SPRING_CAPSULE,
                                   .at = {here.x, here.y + body_low},
                                   .to = {here.x, here.y + body_high},
                                   .radius = body_radius,
                                   .velocity = {u[0], u[1]},
                                   .velocity_to = {u[0], u[1]},
                                   .friction = 0.3};
    set_bodies(w);
    for (uint32_t column = 0; column < w->columns; column++) {
        const vec3 pin = behind_the_neck(column, 0, w->spacing);
        const double target[3] = {pin.x + there.x, pin.y + there.y, pin.z};
        if (column != w->grabbed)
            must(spring_scene_drive(w->scene, column, target, duration), "drive");
    }
}

bool world_open(world *w, world_kind kind)
{
    const struct recipe *r = &recipes[kind];
    const spring_grid *g = &r->grid;
    world_close(w);
    w->kind = kind;
    w->columns = g->count[0];
    w->rows = g->count[1] > 0 ? g->count[1] : 1;
    w->axes = g->axes;
    w->spacing = g->spacing;
    w->wave = g->spacing * sqrt(g->stiffness / r->mass);
    w->grabbed = WORLD_NOTHING;
    must(spring_grid_size(g, &w->particles, &w->links), "size");
    if (!make_scene(w, r))
        return false;
    if (kind == WORLD_DRAPE) {
        w->body[0] = (spring_collider){.shape = SPRING_SPHERE, .at = {0, sphere}, .radius = sphere, .friction = 0.4};
        set_bodies(w);
    } else if (kind == WORLD_CAPE)
        move_body(w, 1);
    else if (kind == WORLD_WATER)
        world_poke(w, w->columns / 3 + w->columns * (w->rows / 2)); /* starts with a wave */
    return true;
}

void world_close(world *w)
{
    free(w->scene);
    memset(w, 0, sizeof *w);
}

/* ----------------------------------------------------------------------------------------------------------- motion */

/* The dragged particle moves towards the mouse at no more than half the wave speed. A faster drag stretches the adjacent
   links and requires shorter steps (docs/dragging.md). The mouse is where it is in this frame, `time` after the time of
   the scene; the steps last for `duration`. */
static void reach(world *w, double time, double duration)
{
    const vec3 d = {w->goal.x - w->hand.x, w->goal.y - w->hand.y, w->goal.z - w->hand.z};
    const double far = sqrt(d.x * d.x + d.y * d.y + d.z * d.z), most = 0.5 * w->wave * time;
    const double part = (far > most ? most / far : 1) * duration / time;
    double own[3];
    w->hand = (vec3){w->hand.x + part * d.x, w->hand.y + part * d.y, w->hand.z + part * d.z};
    to_axes(w, w->hand, own);
    must(spring_scene_drive(w->scene, w->grabbed, own, duration), "drive");
}

spring_status world_advance(world *w, spring_method method, double dt, uint64_t n, double pending)
{
    if (n == 0)
        return SPRING_OK;
    if (w->kind == WORLD_CAPE)
        move_body(w, (double)n * dt);
    if (w->grabbed != WORLD_NOTHING)
        reach(w, (double)n * dt + pending, (double)n * dt);
    spring_status status = spring_scene_advance(w->scene, method, dt, n - 1);
    if (status != SPRING_OK)
        return status;
    static vec3 before[MOST_PARTICLES];
    get_positions(w, before);
    status = spring_scene_advance(w->scene, method, dt, 1);
    if (status != SPRING_OK)
        return status;
    if (!(world_energy(w) < most_energy)) /* about to overflow */
        return SPRING_ENONFINITE;
    memcpy(w->previous, before, sizeof before);
    get_positions(w, w->current);
    for (int axis = 0; axis < 3; axis++) { /* for drawing */
        w->body[0].at[axis] += (double)n * dt * w->body[0].velocity[axis];
        w->body[0].to[axis] += (double)n * dt * w->body[0].velocity_to[axis];
    }
    w->step = dt;
    return SPRING_OK;
}

void world_between(world *w, double alpha, vec3 *out)
{
    w->late = (1 - alpha) * w->step;
    for (size_t i = 0; i < w->particles; i++) {
        const vec3 *a = &w->previous[i], *b = &w->current[i];
        out[i] = (vec3){a->x + alpha * (b->x - a->x), a->y + alpha * (b->y - a->y), a->z + alpha * (b->z - a->z)};
    }
}

double world_energy(const world *w)
{
    const spring_scene_energies e = spring_scene_energy(w->scene);
    return e.kinetic + e.elastic + e.gravity;
}

/* ------------------------------------------------------------------------------------------------------------ edits */

void world_set_damping(world *w, double ratio)
{
    const struct recipe *r = &recipes[w->kind];
    w->damping = ratio * 2 * sqrt(r->mass * r->grid.stiffness);
    for (size_t i = 0; i < w->links; i++)
        if (!world_is_cut(w, i)) {
            spring_link damped = w->link[i];
            damped.damping = w->damping;
            must(spring_scene_set_link(w->scene, i, &damped), "damp");
        }
}

/* Setting the callback also discards a kept force, which may be out of date. */
void world_set_wind(world *w, bool blows)
{
    w->wind = blows && (w->kind == WORLD_CLOTH || w->kind == WORLD_CAPE) ? strongest : 0;
    must(spring_scene_set_force(w->scene, w->wind > 0 ? blow : NULL, w), "wind");
}

void world_grab(world *w, uint32_t particle)
{
    const uint8_t yes = 1;
    world_release(w);
    w->grabbed = particle;
    w->hand = w->goal = w->current[particle];
    must(spring_scene_set_pinned(w->scene, particle, 1, &yes), "grab");
}

void world_pull(world *w, vec3 goal)
{
    w->goal = goal;
}

void world_release(world *w)
{
    if (w->grabbed == WORLD_NOTHING)
        return;
    const uint8_t no = 0;
    if (w->pinned[w->grabbed]) /* stays pinned, and would keep the velocity of the drag */
        must(spring_scene_drive(w->scene, w->grabbed, NULL, 0), "stop");
    else
        must(spring_scene_set_pinned(w->scene, w->grabbed, 1, &no), "let go");
    w->grabbed = WORLD_NOTHING;
}

/* The bit of a link in torn[link.a]. */
static uint8_t torn_bit(const world *w, const spring_link *l)
{
    const uint32_t offset = l->b - l->a;
    if (offset == 1)
        return TORN_RIGHT;
    if (offset == w->columns)
        return TORN_DOWN;
    return offset == w->columns + 1 ? TORN_DOWN_RIGHT : TORN_DOWN_LEFT;
}

void world_cut(world *w, size_t link)
{
    spring_link cut = w->link[link];
    cut.stiffness = cut.damping = 0;
    must(spring_scene_set_link(w->scene, link, &cut), "cut");
    w->torn[cut.a] |= torn_bit(w, &cut);
}

bool world_is_cut(const world *w, size_t link)
{
    const spring_link *l = &w->link[link];
    return w->torn[l->a] & torn_bit(w, l);
}

void world_poke(world *w, uint32_t particle)
{
    static const struct push {
        double speed[3], radius; /* [m/s] along the axes of the scene, [m] */
    } pushes[WORLD_KINDS] = {
        {{0, 0, -6}, 0.15}, {{4, 0, 0}, 0.2}, {{-8, 0, 0}, 0.2}, {{0, 4, 0}, 0.2}, {{0, 0, -4}, 0.15}};
    const struct push *push = &pushes[w->kind];
    const vec3 at = w->current[particle];
    for (uint32_t i = 0; i < w->particles; i++) {
        const vec3 p = w->current[i];
        const double x = p.x - at.x, y = p.y - at.y, z = p.z - at.z;
        const double part = exp(-(x * x + y * y + z * z) / (push->radius * push->radius));
        if (part < 0.01 || w->pinned[i] || i == w->grabbed) /* a pinned particle would keep the velocity */
            continue;
        double v[3] = {0};
        must(spring_scene_get(w->scene, SPRING_VELOCITY, v, 0, i, 1), "poke");
        for (uint32_t axis = 0; axis < w->axes; axis++)
            v[axis] += part * push->speed[axis];
        must(spring_scene_set(w->scene, SPRING_VELOCITY, v, 0, i, 1), "poke");
    }
}
