/* SPDX-License-Identifier: MIT */
/* The cape of spring-work: the figure, the observables, and the solvers; see work_cape.h. */
#include "work_cape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/clock.h>
#include <springstep/scene.h>

#include "common/timing.h"

static const double rest_time = 10;    /* [s] at the end, without motion of the figure */
static const double settled_time = 1;  /* [s] at the very end, for the jitter */
static const double first_seconds = 2; /* [s] not observed: the cape falls onto the shoulders */
static const double pi = 3.14159265358979323846;

/* ------------------------------------------------------------------------------------------------------ the figure */

/* The pose at a time. All of it is a function of a time that slows down to a stop. */
typedef struct pose {
    double end[CAPE_BODIES][2][3], pin[CAPE_COLUMNS][3]; /* [m] */
} pose;

static const double radius[CAPE_BODIES] = {0.18, 0.06, 0.06, 0.08, 0.08}; /* [m] trunk, arms, legs */
static const double shoulder = 1.4;                                       /* [m] height */

/* 0 before 0, 1 after 1, smooth between. */
static double ramp(double s)
{
    s = fmin(fmax(s, 0), 1);
    return s * s * (3 - 2 * s);
}

/* Turns by half of a circle or a third within half a second, every three seconds. */
static double heading(double t)
{
    const double period = 3, turn = 0.5; /* [s] */
    double angle = 0;
    for (int i = 0; i * period < t; i++)
        angle += (i % 3 == 1 ? -2 * pi / 3 : pi) * ramp((t - i * period) / turn);
    return angle;
}

static void place(double t, double duration, pose *p)
{
    const double braking = 2, begin = duration - rest_time - braking; /* [s] */
    const double late = fmin(fmax(t - begin, 0), braking), run = fmin(t, begin) + late - late * late / (2 * braking);
    const double angle = heading(run), c = cos(angle), s = sin(angle), stride = sin(2 * pi * 1.5 * run);
    const double jump = fmod(run, 10) - 5; /* [s] a hop of 0.6 s every ten seconds */
    const double ground[3] = {6 * sin(0.5 * run), 0.04 * stride * stride, 4 * sin(0.7 * run)};
    const double height = jump > 0 && jump < 0.6 ? 9.81 / 2 * jump * (0.6 - jump) : 0, swing = 0.6 * stride; /* [rad] */
    const double arm = 0.6, leg = 0.8, lean = 0.05, side = 0.24;                                             /* [m] */
    const double hip = 0.085; /* [m] no particle fits between the legs, where a cape would be caught */
    /* forward, up, left */
    const double local[CAPE_BODIES][2][3] = {
        {{0, 0.95, 0}, {lean, shoulder - 0.12, 0}},
        {{lean, shoulder - 0.06, side}, {lean + arm * sin(swing), shoulder - 0.06 - arm * cos(swing), side + 0.1}},
        {{lean, shoulder - 0.06, -side}, {lean - arm * sin(swing), shoulder - 0.06 - arm * cos(swing), -side - 0.1}},
        {{0, 0.9, hip}, {-leg * sin(swing), 0.9 - leg * cos(swing), hip}},
        {{0, 0.9, -hip}, {leg * sin(swing), 0.9 - leg * cos(swing), -hip}},
    };
    for (int k = 0; k < CAPE_BODIES; k++)
        for (int end = 0; end < 2; end++) {
            const double *l = local[k][end];
            p->end[k][end][0] = ground[0] + c * l[0] + s * l[2];
            p->end[k][end][1] = ground[1] + height + l[1];
            p->end[k][end][2] = ground[2] - s * l[0] + c * l[2];
        }
    for (int k = 0; k < CAPE_COLUMNS; k++) { /* on an arc around the back */
        const double arc = 0.27, across = (k - (CAPE_COLUMNS - 1) / 2.0) * cape_spacing / arc; /* [m], [rad] */
        const double l[2] = {lean - arc * cos(across), arc * sin(across)};
        p->pin[k][0] = ground[0] + c * l[0] + s * l[1];
        p->pin[k][1] = ground[1] + height + shoulder + 0.03;
        p->pin[k][2] = ground[2] - s * l[0] + c * l[1];
    }
}

static void move(double t, double duration, double time, cape_motion *m)
{
    pose from, to;
    place(t, time, &from);
    place(t + duration, time, &to);
    m->duration = duration;
    for (int k = 0; k < CAPE_BODIES; k++) {
        m->body[k].radius = radius[k];
        for (int end = 0; end < 2; end++)
            for (int d = 0; d < 3; d++) {
                m->body[k].at[end][d] = from.end[k][end][d];
                m->body[k].velocity[end][d] = (to.end[k][end][d] - from.end[k][end][d]) / duration;
            }
    }
    memcpy(m->pin, from.pin, sizeof m->pin);
    memcpy(m->pin_to, to.pin, sizeof m->pin_to);
    const double gust = t < time - rest_time ? 3 + 2 * sin(1.3 * t) : 0;                         /* [m/s] */
    const double air[3] = {-0.7 * gust, 0, gust}, gravity = -9.81, rate = cape_drag / cape_mass; /* moving air pulls */
    for (int d = 0; d < 3; d++)
        m->gravity[d] = rate * air[d] + (d == 1 ? gravity : 0);
}

/* ----------------------------------------------------------------------------------------------------- observables */

enum { MOST_FRAMES = 7500 }; /* 60 s in frames of 8 ms */

typedef struct observed {
    double column[MOST_FRAMES * CAPE_COLUMNS], link[MOST_FRAMES]; /* stretch */
    size_t frames;
    double depth, kinetic, jitter; /* [m], [J], [m/s] sums or largest until finished */
    size_t moments;                /* frames at rest */
} observed;

static double distance(const double *a, const double *b)
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* [m] of a particle's surface below that of a body */
static double depth_in(const double *x, const double *a, const double *b, double r)
{
    double square = 0, along = 0, away[3];
    for (int d = 0; d < 3; d++) {
        square += (b[d] - a[d]) * (b[d] - a[d]);
        along += (x[d] - a[d]) * (b[d] - a[d]);
    }
    const double f = fmin(fmax(along / square, 0), 1);
    for (int d = 0; d < 3; d++)
        away[d] = a[d] + f * (b[d] - a[d]);
    return r + cape_skin - distance(x, away);
}

static void observe(observed *o, double t, double time, const double (*x)[3], const double (*v)[3])
{
    double kinetic = 0, square = 0, worst = 0;
    for (int i = CAPE_COLUMNS; i < CAPE_PARTICLES; i++)
        square += v[i][0] * v[i][0] + v[i][1] * v[i][1] + v[i][2] * v[i][2];
    kinetic = cape_mass / 2 * square;
    if (t > time - settled_time) {
        o->jitter += square / (CAPE_PARTICLES - CAPE_COLUMNS);
        o->moments++;
    }
    if (t < first_seconds || t > time - rest_time)
        return;
    pose p;
    place(t, time, &p);
    for (int i = CAPE_COLUMNS; i < CAPE_PARTICLES; i++)
        for (int k = 0; k < CAPE_BODIES; k++)
            o->depth = fmax(o->depth, depth_in(x[i], p.end[k][0], p.end[k][1], radius[k]));
    for (int column = 0; column < CAPE_COLUMNS; column++) {
        double length = 0;
        for (int row = 1; row < CAPE_ROWS; row++) {
            const int i = row * CAPE_COLUMNS + column;
            const double here = distance(x[i], x[i - CAPE_COLUMNS]);
            length += here;
            worst = fmax(worst, here / cape_spacing - 1);
        }
        o->column[o->frames * CAPE_COLUMNS + (size_t)column] = length / ((CAPE_ROWS - 1) * cape_spacing) - 1;
    }
    for (int i = CAPE_COLUMNS; i < CAPE_PARTICLES; i++)
        if (i % CAPE_COLUMNS > 0)
            worst = fmax(worst, distance(x[i], x[i - 1]) / cape_spacing - 1);
    o->link[o->frames++] = worst;
    o->kinetic += kinetic;
}

static int ascending(const void *a, const void *b)
{
    const double *l = a, *r = b;
    return (*l > *r) - (*l < *r);
}

static double percentile_99(double *values, size_t count)
{
    qsort(values, count, sizeof *values, ascending);
    return values[(size_t)(0.99 * (double)(count - 1))];
}

/* --------------------------------------------------------------------------------------------------------- solvers */

typedef enum cape_method { LEAPFROG, XPBD_MESH, XPBD_SHEET } cape_method;

typedef struct cape_setting {
    cape_method method;
    bool single;     /* float */
    int tether_rows; /* every row, every seventh row from the hem; 0: no tethers */
    double fraction; /* of the stable step */
    double damping;  /* damping ratio of a link between two particles */
    bool alone;      /* without the figure */
} cape_setting;

static const double tether_fraction = 0.05; /* of the stiffness of a particle */

typedef struct cape_run {
    double time; /* [us] per 1/60 s */
    double stiffness, column, link, depth, kinetic, jitter;
    bool failed;
} cape_run;

typedef struct cape_solver {
    const cape_setting *setting;
    cape_xpbd *xpbd; /* one of these is set */
    spring_scene *scene;
    spring_scenef *scenef;
    void *memory;
    double stiffness;
} cape_solver;

static double start[CAPE_PARTICLES][3], x[CAPE_PARTICLES][3], v[CAPE_PARTICLES][3];

static void must(spring_status status)
{
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "the cape: %s", spring_status_string(status));
}

static spring_scenef_def single_of(const spring_scene_def *d)
{
    spring_scenef_def f = {.flags = d->flags, .particles = d->particles, .links = d->links, .position = d->position};
    f.mass_all = d->mass_all, f.pinned = d->pinned, f.link = d->link, f.drag = d->drag;
    f.colliders = d->colliders, f.particle_radius = d->particle_radius;
    return f;
}

/* Appends tethers of the particles of some rows. */
static void add_tethers(spring_scene_def *def, spring_link *link, size_t room, size_t rows)
{
    static uint32_t work[2 * CAPE_PARTICLES];
    static double far[2 * CAPE_PARTICLES];
    must(spring_links_tethers(def, tether_fraction, 0, link + def->links, &room, work, far));
    const spring_link *tether = link + def->links;
    for (size_t i = 0; i < room; i++)
        if ((CAPE_ROWS - 1 - tether[i].a / CAPE_COLUMNS) % rows == 0)
            link[def->links++] = tether[i];
}

/* The links are as stiff as the step allows. */
static void open_scene(cape_solver *s, double step)
{
    enum { ROOM = 5 * CAPE_PARTICLES }; /* fewer than four links per particle, and a tether */
    static spring_link link[ROOM];
    static double flat[CAPE_PARTICLES][3];
    static uint8_t pinned[CAPE_PARTICLES];
    const cape_setting *c = s->setting;
    size_t particles, sheet_links, bytes;
    spring_grid sheet = {
        .count = {CAPE_COLUMNS, CAPE_ROWS}, .spacing = cape_spacing, .stiffness = 1, .damping = c->damping};
    sheet.families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR, sheet.pinned = SPRING_GRID_FIRST_Y;
    must(spring_grid_size(&sheet, &particles, &sheet_links));
    must(spring_grid_fill(&sheet, flat[0], pinned, link));
    spring_scene_def def = {.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, .drag = cape_drag, .mass_all = cape_mass};
    def.particles = particles, def.position = start[0], def.pinned = pinned, def.links = sheet_links, def.link = link;
    def.colliders = c->alone ? 0 : CAPE_BODIES, def.particle_radius = cape_skin;
    if (c->tether_rows > 0)
        add_tethers(&def, link, ROOM - sheet_links, (size_t)c->tether_rows);
    must(spring_scene_bytes(&def, &bytes));
    s->memory = malloc(bytes);
    must(spring_scene_init(s->memory, bytes, &def, &s->scene));
    const double root = spring_scene_stable_step(s->scene, SPRING_LEAPFROG) * c->fraction / step;
    s->stiffness = root * root;
    for (size_t i = 0; i < def.links; i++)
        link[i].stiffness *= s->stiffness;
    for (size_t i = 0; i < sheet_links; i++)
        link[i].damping = c->damping * sqrt(2 * s->stiffness * cape_mass);
    if (c->single) {
        const spring_scenef_def f = single_of(&def);
        must(spring_scenef_init(s->memory, bytes, &f, &s->scenef));
    } else {
        must(spring_scene_init(s->memory, bytes, &def, &s->scene));
    }
}

static cape_solver open_solver(const cape_setting *c, double step)
{
    cape_solver s = {.setting = c};
    if (c->method != LEAPFROG)
        s.xpbd = cape_xpbd_make((const double(*)[3])start, step, c->tether_rows > 0, c->method == XPBD_MESH);
    else
        open_scene(&s, step);
    return s;
}

static spring_status advance(const cape_solver *s, const cape_motion *m, double step, uint64_t n)
{
    if (s->xpbd != NULL) {
        cape_xpbd_advance(s->xpbd, m, n);
        return SPRING_OK;
    }
    spring_collider body[CAPE_BODIES];
    memset(body, 0, sizeof body);
    for (int k = 0; k < CAPE_BODIES; k++) {
        body[k].shape = SPRING_CAPSULE, body[k].radius = m->body[k].radius, body[k].friction = cape_friction;
        memcpy(body[k].at, m->body[k].at[0], sizeof body[k].at);
        memcpy(body[k].to, m->body[k].at[1], sizeof body[k].to);
        memcpy(body[k].velocity, m->body[k].velocity[0], sizeof body[k].velocity);
        memcpy(body[k].velocity_to, m->body[k].velocity[1], sizeof body[k].velocity_to);
    }
    const uint32_t bodies = s->setting->alone ? 0 : CAPE_BODIES;
    if (s->setting->single) {
        spring_scenef_set_gravity(s->scenef, m->gravity);
        spring_scenef_set_colliders(s->scenef, body, bodies);
        for (size_t k = 0; k < CAPE_COLUMNS; k++)
            spring_scenef_drive(s->scenef, k, m->pin_to[k], m->duration);
        return spring_scenef_advance(s->scenef, SPRING_LEAPFROG, step, n);
    }
    spring_scene_set_gravity(s->scene, m->gravity);
    spring_scene_set_colliders(s->scene, body, bodies);
    for (size_t k = 0; k < CAPE_COLUMNS; k++)
        spring_scene_drive(s->scene, k, m->pin_to[k], m->duration);
    return spring_scene_advance(s->scene, SPRING_LEAPFROG, step, n);
}

static void get(const cape_solver *s)
{
    if (s->xpbd != NULL) {
        cape_xpbd_get(s->xpbd, x, v);
    } else if (s->setting->single) {
        spring_scenef_get(s->scenef, SPRING_POSITION, x[0], 0, 0, CAPE_PARTICLES);
        spring_scenef_get(s->scenef, SPRING_VELOCITY, v[0], 0, 0, CAPE_PARTICLES);
    } else {
        spring_scene_get(s->scene, SPRING_POSITION, x[0], 0, 0, CAPE_PARTICLES);
        spring_scene_get(s->scene, SPRING_VELOCITY, v[0], 0, 0, CAPE_PARTICLES);
    }
}

/* A frame of 8 to 40 ms, from the high bits of Knuth's 64-bit generator. */
static double next_frame(uint64_t *state)
{
    const double shortest = 0.008, longest = 0.040, two_to_32 = 4294967296.0; /* [s] */
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return shortest + (longest - shortest) * (double)(*state >> 32) / two_to_32;
}

static cape_run run_cape(const cape_setting *c, int steps, double time)
{
    const double step = 1.0 / 60 / steps;
    static observed o;
    memset(&o, 0, sizeof o);
    pose p;
    place(0, time, &p);
    for (int i = 0; i < CAPE_PARTICLES; i++) { /* hangs down from the pins */
        memcpy(start[i], p.pin[i % CAPE_COLUMNS], sizeof start[i]);
        start[i][1] -= i / CAPE_COLUMNS * cape_spacing;
    }
    cape_solver s = open_solver(c, step);
    cape_run r = {.stiffness = c->method == LEAPFROG ? s.stiffness : INFINITY};
    spring_clock clock = {0};
    uint64_t random = 1, taken = 0;
    double spent = 0; /* [ns] */
    while ((double)taken * step < time && !r.failed) {
        const uint64_t n = spring_clock_tick(&clock, next_frame(&random), step, UINT64_MAX, NULL);
        if (n == 0)
            continue;
        cape_motion m;
        move((double)taken * step, (double)n * step, time, &m);
        const double begin = timing_busy();
        r.failed = advance(&s, &m, step, n) != SPRING_OK;
        spent += timing_busy() - begin;
        taken += n;
        get(&s);
        observe(&o, (double)taken * step, time, (const double(*)[3])x, (const double(*)[3])v);
    }
    free(s.memory);
    free(s.xpbd);
    if (r.failed)
        return r;
    r.time = 1e-3 * spent / ((double)taken * step * 60);
    r.column = percentile_99(o.column, o.frames * CAPE_COLUMNS);
    r.link = percentile_99(o.link, o.frames);
    r.depth = o.depth;
    r.kinetic = o.kinetic / (double)o.frames;
    r.jitter = sqrt(o.jitter / (double)o.moments);
    return r;
}

/* ------------------------------------------------------------------------------------------------------------ rows */

const char cape_columns[] = "problem solver precision tethers fraction damping_ratio effort steps_per_frame "
                            "stiffness_N_per_m time_us column_stretch link_stretch depth_m kinetic_J jitter_mps";
const char cape_equal_columns[] = "problem solver precision tethers fraction stretch time_us";

static const char *const method_names[] = {"leapfrog", "xpbd-mesh", "xpbd-sheet"};

static const char *tethers_of(const cape_setting *c)
{
    return c->tether_rows == 0 ? "none" : c->tether_rows == 1 ? "all" : "rows";
}

static cape_run measure(cli_table *table, const cape_setting *c, const char *effort, int steps, double time)
{
    const cape_run r = run_cape(c, steps, time);
    if (!r.failed)
        cli_row(table, "cape\t%s\t%s\t%s\t%.3g\t%.3g\t%s\t%d\t%.6g\t%.4g\t%.6g\t%.6g\t%.4g\t%.6g\t%.4g",
                method_names[c->method], c->single ? "float" : "double", tethers_of(c), c->fraction, c->damping, effort,
                steps, r.stiffness, r.time, r.column, r.link, r.depth, r.kinetic, r.jitter);
    return r;
}

/* The times at two stretches, by a power law through the runs. */
static void write_equal(cli_table *equal, const cape_setting *c, const cape_run *run, int runs)
{
    static const double stretch[] = {0.06, 0.03};
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < runs; i++) {
        if (run[i].failed)
            return;
        const double a = log(run[i].column), b = log(run[i].time);
        n++, sx += a, sy += b, sxx += a * a, sxy += a * b;
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx), level = (sy - slope * sx) / n;
    for (int i = 0; i < 2; i++)
        cli_row(equal, "cape\t%s\t%s\t%s\t%.3g\t%.3g\t%.4g", method_names[c->method], c->single ? "float" : "double",
                tethers_of(c), c->fraction, stretch[i], exp(level + slope * log(stretch[i])));
}

/* The seventh row and so on: four rows of tethers stretch hardly more than all, and take half of their time. */
enum { ALL = 1, FOUR = 7 };

static const cape_setting settings[] = {
    {.method = LEAPFROG, .single = true, .tether_rows = FOUR, .fraction = 0.9},
    {.method = LEAPFROG, .single = true, .tether_rows = FOUR, .fraction = 0.5},
    {.method = LEAPFROG, .single = true, .tether_rows = ALL, .fraction = 0.9},
    {.method = LEAPFROG, .single = true, .fraction = 0.9},
    {.method = LEAPFROG, .single = true, .fraction = 0.5},
    {.method = LEAPFROG, .tether_rows = FOUR, .fraction = 0.9},
    {.method = LEAPFROG, .fraction = 0.9},
    {.method = LEAPFROG, .fraction = 0.5},
    {.method = XPBD_MESH},
    {.method = XPBD_MESH, .tether_rows = ALL},
    {.method = XPBD_SHEET},
    {.method = XPBD_SHEET, .tether_rows = ALL},
};

void cape_write(cli_table *table, cli_table *equal, bool quick)
{
    static const int steps[] = {10, 14, 20, 28, 40}, substeps[] = {5, 7, 10, 14, 20}, quick_steps[] = {10, 30},
                     quick_substeps[] = {5, 20};
    static const double fractions[] = {0.25, 0.5, 0.7, 0.9, 1, 1.1, 1.3}, dampings[] = {0.005, 0.02};
    const double time = quick ? 16 : 60; /* [s] */
    const int runs = quick ? 2 : 5, total = (int)(sizeof settings / sizeof settings[0]);
    for (int i = 0; i < total; i++) {
        cape_setting c = settings[i];
        const bool leapfrog = c.method == LEAPFROG;
        c.single = c.single || !leapfrog;
        cape_run run[5];
        for (int k = 0; k < runs; k++)
            run[k] =
                measure(table, &c, "steps",
                        leapfrog ? (quick ? quick_steps : steps)[k] : (quick ? quick_substeps : substeps)[k], time);
        if (equal != NULL)
            write_equal(equal, &c, run, runs);
        cli_progress((double)(i + 1) / (total + 1));
    }
    for (size_t k = 0; k < sizeof fractions / sizeof fractions[0]; k += quick ? 3 : 1) { /* 0.9 is one of them */
        cape_setting c = settings[0];
        c.fraction = fractions[k];
        measure(table, &c, "fraction", 20, time);
    }
    for (size_t k = 0; k < sizeof dampings / sizeof dampings[0]; k++) {
        cape_setting c = settings[0];
        c.damping = dampings[k];
        measure(table, &c, "damping", 20, time);
    }
    for (int tethers = 0; tethers <= FOUR; tethers += FOUR) {
        cape_setting c = settings[0];
        c.alone = true;
        c.tether_rows = tethers;
        measure(table, &c, "no-figure", 20, time);
    }
}
