/* SPDX-License-Identifier: MIT */
/*
 * What springstep/scenes calls besides the functions of the library: definitions and grids from numbers, frames with
 * interpolation, positions as floats. With the library it makes the WebAssembly module, whose one import is the callback of
 * scenes in JavaScript.
 */
#include <springstep/clock.h>
#include <springstep/scene.h>

#include <stddef.h>
#include <string.h>

#define EXPORT(name) __attribute__((export_name(#name), used))
#include "memory.h"

/* The callback of the scene that is being called, in JavaScript. */
__attribute__((import_module("springstep"), import_name("force"))) void call_force(double t,
                                                                                   const double *const *position,
                                                                                   const double *const *velocity,
                                                                                   double *const *force);

/* definition.js fills these structures. */
_Static_assert(sizeof(spring_link) == 40 && offsetof(spring_link, rest) == 8 && offsetof(spring_link, flags) == 32,
               "spring_link");
_Static_assert(sizeof(spring_weighted_link) == 72 && offsetof(spring_weighted_link, weight) == 16 &&
                   offsetof(spring_weighted_link, rest) == 48,
               "spring_weighted_link");
_Static_assert(sizeof(spring_collider) == 8 * 44 && offsetof(spring_collider, axis) == 8 * 7 &&
                   offsetof(spring_collider, velocity) == 8 * 20 && offsetof(spring_collider, restitution) == 8 * 30 &&
                   offsetof(spring_collider, surface) == 8 * 37 && offsetof(spring_collider, mask) == 8 * 40,
               "spring_collider");

enum { most_colliders = 32 }; /* of a scene */

/* What frames depend on besides the scene and the state before the last step. */
typedef struct frames {
    spring_clock clock; /* dropped: by failed frames, and not yet in times[1] of a frame */
    double alpha;
    spring_impulse earlier[most_colliders]; /* of the last frame, without those of its last step */
} frames;

/* A scene and what is shown of it. */
typedef struct shown {
    spring_scene *scene;
    size_t bytes;
    void *saved; /* [bytes] the scene before a frame; NULL before the first */
    uint32_t axes;
    uint32_t component; /* of an element of `positions` that receives the first axis */
    size_t particles, links;
    frames frames, kept; /* kept: before the frame that has begun */
    spring_clock next;   /* after this frame */
    double next_alpha;
    bool in_frame;        /* whether a frame has begun that takes steps */
    double *before, *now; /* [particles*axes] the last two states of a frame; NULL before the first */
    float *positions;     /* [3*particles] */
} shown;

_Static_assert(offsetof(frames, earlier) == 8 * 4 && sizeof(frames) == 8 * (4 + 6 * most_colliders),
               "scene.js: #frames");

/* What def_check() found. */
static struct {
    const char *field;
    uint32_t index;
} failure;

EXPORT(failure_field) const char *failure_field(void)
{
    return failure.field;
}

EXPORT(failure_index) uint32_t failure_index(void)
{
    return failure.index;
}

static void force_of_javascript(void *user, double t, size_t particles, const double *const position[3],
                                const double *const velocity[3], double *const force[3])
{
    (void)user;
    (void)particles;
    call_force(t, position, velocity, force);
}

EXPORT(scene_set_force) spring_status scene_set_force(shown *s, bool called)
{
    return spring_scene_set_force(s->scene, called ? force_of_javascript : NULL, NULL);
}

EXPORT(scene_free) void scene_free(shown *s)
{
    if (s == NULL)
        return;
    give_back(s->scene);
    give_back(s->saved);
    give_back(s->before);
    give_back(s->now);
    give_back(s->positions);
    give_back(s);
}

/* The one definition that is being filled. */
static spring_scene_def def;

/* A new definition. All arrays are those of JavaScript's heap in this module, and copied by scene_new(). */
EXPORT(def_begin)
void def_begin(uint32_t axes, uint32_t flags, uint32_t methods, size_t particles, const double *position,
               const double *velocity, const double *mass, double mass_all, const uint8_t *pinned)
{
    def = (spring_scene_def){.axes = axes,
                             .flags = flags,
                             .methods = methods,
                             .particles = particles,
                             .position = position,
                             .velocity = velocity,
                             .mass = mass,
                             .mass_all = mass_all,
                             .pinned = pinned};
}

EXPORT(def_forces)
void def_forces(double x, double y, double z, double drag, double max_speed, bool called)
{
    def.gravity[0] = x;
    def.gravity[1] = y;
    def.gravity[2] = z;
    def.drag = drag;
    def.max_speed = max_speed;
    def.force = called ? force_of_javascript : NULL;
}

EXPORT(def_links) void def_links(size_t links, const spring_link *link)
{
    def.links = links;
    def.link = link;
}

EXPORT(def_contacts)
void def_contacts(uint32_t colliders, double particle_radius, const double *radius, const double *friction,
                  const uint32_t *mask)
{
    def.colliders = colliders;
    def.particle_radius = particle_radius;
    def.radius = radius;
    def.friction = friction;
    def.mask = mask;
}

EXPORT(def_weighted_links) void def_weighted_links(size_t links, const spring_weighted_link *link)
{
    def.weighted_links = links;
    def.weighted_link = link;
}

/* Checks the definition; failure_field() and failure_index() say what is wrong with it. */
EXPORT(def_check) spring_status def_check(void)
{
    size_t index;
    const spring_status status = spring_scene_check(&def, &failure.field, &index);
    failure.index = index;
    return status;
}

EXPORT(def_soften) spring_status def_soften(double dt, double fraction, spring_link *link)
{
    return spring_links_soften(&def, dt, fraction, link);
}

EXPORT(def_tethers)
spring_status def_tethers(double fraction, double slack, spring_link *out, size_t *count, uint32_t *work,
                          double *distance)
{
    return spring_links_tethers(&def, fraction, slack, out, count, work, distance);
}

EXPORT(scene_show) const float *scene_show(shown *s)
{
    spring_scene_getf(s->scene, SPRING_POSITION, s->positions + s->component, 3, 0, s->particles);
    return s->positions;
}

/* The defined scene, valid by def_check(); NULL: no memory. `base`, which may be NULL, is what positions contain where no
   axis writes. */
EXPORT(scene_new) shown *scene_new(uint32_t component, const float *base)
{
    shown *s = take_zeros(1, sizeof *s);
    if (s == NULL)
        return NULL;
    s->axes = def.axes > 0 ? def.axes : 3;
    s->component = component;
    s->particles = def.particles;
    s->links = def.links;
    spring_scene_bytes(&def, &s->bytes);
    void *memory = take(s->bytes);
    s->positions = take_zeros(3 * s->particles, sizeof *s->positions);
    if (memory != NULL && s->positions != NULL && spring_scene_init(memory, s->bytes, &def, &s->scene) == SPRING_OK) {
        if (base != NULL)
            memcpy(s->positions, base, 3 * s->particles * sizeof *base);
        scene_show(s);
        return s;
    }
    if (s->scene == NULL)
        give_back(memory);
    scene_free(s);
    return NULL;
}

EXPORT(scene_of) spring_scene *scene_of(const shown *s)
{
    return s->scene;
}

EXPORT(scene_bytes) size_t scene_bytes(const shown *s)
{
    return s->bytes;
}

EXPORT(scene_advance) spring_status scene_advance(shown *s, spring_method m, double dt, double n)
{
    const spring_status status = spring_scene_advance(s->scene, m, dt, (uint64_t)n);
    if (status == SPRING_OK)
        memset(s->frames.earlier, 0, sizeof s->frames.earlier);
    return status;
}

/* Positions have changed otherwise than by steps: frames do not interpolate across that. A frame that has begun replaces both
   states, or none if it fails. */
EXPORT(scene_moved) const float *scene_moved(shown *s)
{
    if (s->before != NULL && !s->in_frame) {
        spring_scene_get(s->scene, SPRING_POSITION, s->now, 0, 0, s->particles);
        memcpy(s->before, s->now, s->particles * s->axes * sizeof *s->now);
    }
    return scene_show(s);
}

static bool begin_frames(shown *s)
{
    const size_t numbers = s->particles * s->axes;
    s->saved = take(s->bytes);
    s->before = take_zeros(numbers, sizeof *s->before);
    s->now = take_zeros(numbers, sizeof *s->now);
    if (s->saved != NULL && s->before != NULL && s->now != NULL) {
        scene_moved(s);
        return true;
    }
    give_back(s->saved);
    give_back(s->before);
    give_back(s->now);
    s->saved = NULL;
    s->before = s->now = NULL;
    return false;
}

/* Begins a frame of `elapsed` seconds and returns the steps that are due, at most `most`; -1: no memory. times[0]: from the
   time of the scene to the end of the frame, times[1]: before that, dropped. */
EXPORT(scene_begin_frame)
double scene_begin_frame(shown *s, double elapsed, double dt, double most, double times[2])
{
    if (s->before == NULL && !begin_frames(s))
        return -1;
    s->next = s->frames.clock;
    const double n = (double)spring_clock_tick(&s->next, elapsed, dt, (uint64_t)most, &s->next_alpha);
    times[0] = n * dt + s->next.pending;
    times[1] = s->next.dropped;
    s->in_frame = n > 0;
    if (s->in_frame) {
        memcpy(s->saved, s->scene, s->bytes);
        s->kept = s->frames;
    }
    return n;
}

/* Takes the steps of a frame, n > 0. `before` stays as it is, because scene_undo_frame() may follow. */
EXPORT(scene_take_frame) spring_status scene_take_frame(shown *s, spring_method m, double dt, double n)
{
    spring_status status = spring_scene_advance(s->scene, m, dt, (uint64_t)n - 1);
    if (status != SPRING_OK)
        return status;
    spring_scene_get(s->scene, SPRING_POSITION, s->now, 0, 0, s->particles);
    spring_impulse *const j = s->frames.earlier;
    spring_collider from[most_colliders];      /* on the stack: a callback may take frames of other scenes */
    static spring_collider to[most_colliders]; /* not on the stack, which has 64 KiB */
    uint32_t count = most_colliders;
    spring_scene_get_colliders(s->scene, from, &count);
    spring_scene_impulses(s->scene, j, 0, count);
    status = spring_scene_advance(s->scene, m, dt, 1);
    spring_scene_get_colliders(s->scene, to, &count);
    for (uint32_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            j[i].angular[a] +=
                (from[i].at[b] - to[i].at[b]) * j[i].linear[c] - (from[i].at[c] - to[i].at[c]) * j[i].linear[b];
        }
    return status;
}

/* Positions between the last two states. */
static const float *show_between(shown *s)
{
    s->in_frame = false;
    for (size_t i = 0, k = 0; i < s->particles; i++)
        for (uint32_t a = 0; a < s->axes; a++, k++)
            s->positions[3 * i + s->component + a] =
                (float)(s->before[k] + s->frames.alpha * (s->now[k] - s->before[k]));
    return s->positions;
}

/* Ends a frame whose steps have been taken. */
EXPORT(scene_end_frame) const float *scene_end_frame(shown *s)
{
    if (s->in_frame) {
        double *const before = s->before;
        s->before = s->now;
        s->now = before;
        spring_scene_get(s->scene, SPRING_POSITION, s->now, 0, 0, s->particles);
        s->next.dropped = 0;
    }
    s->frames.clock = s->next;
    s->frames.alpha = s->next_alpha;
    return show_between(s);
}

/* After a failure: the scene is as before the frame, whose time is dropped. */
EXPORT(scene_undo_frame) const float *scene_undo_frame(shown *s, double elapsed)
{
    memcpy(s->scene, s->saved, s->bytes);
    spring_scene_get(s->scene, SPRING_POSITION, s->now, 0, 0, s->particles);
    s->frames = s->kept;
    s->frames.clock.dropped += elapsed;
    return show_between(s);
}

/* What frames depend on besides the scene, and the state before the last step, NULL before the first frame. */
EXPORT(scene_frames) frames *scene_frames(shown *s)
{
    return &s->frames;
}

EXPORT(scene_before) double *scene_before(const shown *s)
{
    return s->before;
}

/* The present links of a scene. */
EXPORT(scene_links) void scene_links(const shown *s, spring_link *link)
{
    for (size_t i = 0; i < s->links; i++)
        spring_scene_get_link(s->scene, i, &link[i]);
}

static spring_grid grid;

EXPORT(grid_begin)
spring_status grid_begin(uint32_t x, uint32_t y, uint32_t z, uint32_t axes, bool height, double spacing, double stretch,
                         uint32_t families, double stiffness, double damping, uint32_t pinned, size_t size[2])
{
    grid = (spring_grid){.count = {x, y, z},
                         .axes = axes,
                         .height = height,
                         .spacing = spacing,
                         .stretch = stretch,
                         .families = families,
                         .stiffness = stiffness,
                         .damping = damping,
                         .pinned = pinned};
    return spring_grid_size(&grid, &size[0], &size[1]);
}

EXPORT(grid_fill) spring_status grid_fill(double *position, uint8_t *pinned, spring_link *link)
{
    return spring_grid_fill(&grid, position, pinned, link);
}

EXPORT(grid_bend)
spring_status grid_bend(const uint8_t *pinned, bool diagonals, double rigidity, double damping_time,
                        spring_weighted_link *out, size_t *count)
{
    return spring_bend_grid(&grid, pinned, SPRING_BEND_ROWS | (diagonals ? SPRING_BEND_DIAGONALS : 0), rigidity,
                            damping_time, out, count);
}

/* Methods in the order of tables: a number, or -1 behind the last. */
EXPORT(method_at) int32_t method_at(uint32_t i)
{
    return i < SPRING_METHOD_COUNT ? (int32_t)spring_method_at(i) : -1;
}

EXPORT(method_order) int32_t method_order(spring_method m)
{
    const spring_method_info *info = spring_method_describe(m);
    return info->scenes ? info->order : 0;
}

EXPORT(method_forces) int32_t method_forces(spring_method m)
{
    return spring_method_describe(m)->forces_per_step;
}
