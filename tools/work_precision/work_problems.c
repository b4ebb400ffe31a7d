/* SPDX-License-Identifier: MIT */
/*
 * The problems of spring-work; see work.h.
 *
 * Exact state     A spring: in multiple precision. A scene: by GSL's Prince-Dormand 8(9) with fixed steps, and again
 *                 with half as many. The uncertainty is the difference, or the distance from known digits of the
 *                 harness.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/timing.h"
#include "scenes/start.h"
#include "work.h"

/* --------------------------------------------------------------------------------------------------- two sheets */

enum { SIDE = 25 }; /* particles along an edge of a sheet */

#define ALL_FAMILIES SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND

/* Hangs by one edge and falls from the horizontal. */
static void build_cloth(const scene_case *c, scene_problem *p)
{
    const spring_grid g = {.count = {SIDE, SIDE, 1},
                           .axes = 3,
                           .spacing = 0.04,
                           .stretch = 1.01,
                           .families = ALL_FAMILIES,
                           .stiffness = 60,
                           .pinned = SPRING_GRID_FIRST_Y};
    (void)c;
    scene_problem_grid(p, &g, 0, 0.003);
    p->def.gravity[1] = -1.7;
    p->def.gravity[2] = -9.66;
    p->def.drag = 0.001;
}

/* The sheet of water of the original study: 4 m x 4 m, masses of 1 kg, 25 000 N/m, drag. Poked near a corner. */
static void build_water(const scene_case *c, scene_problem *p)
{
    const double spacing = 4.0 / (SIDE - 1), wide = 0.5, at[] = {1.4, 1.7}; /* [m] */
    const spring_grid g = {.count = {SIDE, SIDE, 1},
                           .height = true,
                           .spacing = spacing,
                           .families = ALL_FAMILIES,
                           .stiffness = 25000,
                           .pinned =
                               SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X | SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y};
    scene_problem_grid(p, &g, 0, 1);
    p->def.drag = 0.5;
    for (size_t i = 0; i < p->def.particles; i++)
        if (!p->pinned[i]) {
            const double x = spacing * (double)(i % SIDE) - at[0], y = spacing * (double)(i / SIDE) - at[1];
            p->position[i] = -c->length * exp(-(x * x + y * y) / (wide * wide));
        }
}

/* ------------------------------------------------------------------------------------------------- stiff scenes */

/* Gives all links one stiffness and one damping, from the numbers that determine the steps per frame of 1/60 s:
   stiff = sqrt(L)/60 Hz, where L is the bound of spring_scene_stable_step(), and damped = damping/mass/60 Hz. */
static void stiffen(scene_problem *p, double stiff, double damped)
{
    const double frames = 60; /* [1/s] */
    double *sum = scene_room(p->def.particles, sizeof *sum), largest = 0;
    for (const spring_link *l = p->link; l < p->link + p->def.links; l++) {
        sum[l->a] += p->pinned[l->b] ? 1 : 2;
        sum[l->b] += p->pinned[l->a] ? 1 : 2;
    }
    for (size_t i = 0; i < p->def.particles; i++)
        if (!p->pinned[i])
            largest = fmax(largest, sum[i] / p->mass[i]);
    for (spring_link *l = p->link; l < p->link + p->def.links; l++) {
        l->stiffness = pow(stiff * frames, 2) / largest;
        l->damping = damped * frames * p->mass[0];
    }
    free(sum);
}

static const double stiff_scene = 50, damped_scene = 100; /* leapfrog takes half the first number in steps per frame */

/* The damped sheet is smaller, because the explicit reference takes hundreds of steps per frame. */
static void build_stiff(const scene_case *c, scene_problem *p);
static const scene_case stiff_cloth = {
    .name = "stiff-cloth", .build = build_stiff, .count = 32, .duration = 0.25, .omega = 300, .length = 0.1};
static const scene_case stiff_rope = {
    .name = "stiff-rope", .build = build_stiff, .count = 32, .duration = 0.25, .omega = 300, .length = 0.1};
static const scene_case damped_cloth = {
    .name = "damped-cloth", .build = build_stiff, .count = 16, .duration = 0.1, .omega = 30, .length = 0.03};

/* A rope or a sheet of one metre and one kilogram, with c->count particles along an edge, initially level and
   unstretched. Particles are a hundredth of the spacing above or below the plane, so that buckling does not start from
   rounding errors. A sheet hangs by two corners. A rope hangs by one end, and the particle at the other end is a
   hundred times as heavy. */
static void build_stiff(const scene_case *c, scene_problem *p)
{
    const uint32_t side = (uint32_t)c->count;
    const bool rope = c == &stiff_rope;
    const spring_grid g = {.count = {side, rope ? 1 : side, 1},
                           .axes = 3,
                           .spacing = 1.0 / (side - 1),
                           .families = rope ? 0 : ALL_FAMILIES};
    scene_problem_grid(p, &g, 0, 1.0 / (g.count[0] * g.count[1]));
    for (size_t i = 0; i < p->def.particles; i++)
        p->position[3 * i + 2] = 0.01 * g.spacing * sin(1.7 * (double)i);
    p->def.gravity[2] = -9.81;
    p->pinned[0] = 1;
    if (rope) {
        p->mass[side - 1] *= 100;
        p->def.mass = p->mass;
    } else {
        p->pinned[side - 1] = 1;
    }
    stiffen(p, stiff_scene, c == &damped_cloth ? damped_scene : 0);
}

static const scene_case cloth = {.name = "cloth", .build = build_cloth, .duration = 0.25, .omega = 30, .length = 0.04};
static const scene_case long_cloth = {
    .name = "long-cloth", .build = build_cloth, .duration = 1, .omega = 30, .length = 0.04};
static const scene_case water = {.name = "water", .build = build_water, .duration = 0.25, .omega = 77, .length = 0.1};

/* ------------------------------------------------------------------------- right-hand sides of a few numbers */

/* Written out for each problem, as a user would do. */
static void move_spring(double t, const double *y, double *dy, const void *data)
{
    const work_constants *c = data;
    (void)t;
    dy[0] = y[1];
    dy[1] = c->accel - c->omega2 * y[0] - c->gamma * y[1];
}

static void move_duffing(double t, const double *y, double *dy, const void *data)
{
    const work_constants *c = data;
    (void)t;
    dy[0] = y[1];
    dy[1] = -y[0] * (c->omega2 + y[0] * y[0]);
}

static void move_pendulum(double t, const double *y, double *dy, const void *data)
{
    const work_constants *c = data;
    const double pull = c->omega2 * (c->rest / sqrt(y[0] * y[0] + y[1] * y[1]) - 1);
    (void)t;
    dy[0] = y[2];
    dy[1] = y[3];
    dy[2] = pull * y[0];
    dy[3] = pull * y[1] + c->accel;
}

static double soft(double stretch)
{
    return 4 * stretch * stretch * stretch;
}

/* Stiff springs join particles 0 and 1, 2 and 3, 4 and 5. Soft springs join these pairs and the walls. */
static void move_stiff_and_soft(double t, const double *y, double *dy, const void *data)
{
    const work_constants *c = data;
    const double left = soft(y[0]), low = soft(y[2] - y[1]), high = soft(y[4] - y[3]), right = soft(-y[5]);
    const double first = c->omega2 * (y[1] - y[0]), second = c->omega2 * (y[3] - y[2]),
                 third = c->omega2 * (y[5] - y[4]);
    (void)t;
    for (int i = 0; i < 6; i++)
        dy[i] = y[6 + i];
    dy[6] = first - left;
    dy[7] = low - first;
    dy[8] = second - low;
    dy[9] = high - second;
    dy[10] = third - high;
    dy[11] = right - third;
}

/* ------------------------------------------------------------------------------------------------- the problems */

#define PERIODS(n) ((n)*6.283185307179586 / 1.4411533842457842) /* [s] of sqrt(2.7/1.3) */
#define SPRING     .kind = WORK_SPRING, .start = {0.8, -0.9}, .longest = 0.01

const work_problem work_problems[] = {
    {"seed-1000s", WORK_STUDY, 1000, INFINITY, .p = {1, 1, 0, 0}, .start = {1, 0}, .finest = 1e-4},
    {"ideal-1", SPRING, .p = {1.3, 2.7, 0, 0}, .duration = PERIODS(1), .finest = 1e-5, .periods = 1},
    {"ideal-10", SPRING, .p = {1.3, 2.7, 0, 0}, .duration = PERIODS(10), .finest = 5e-5, .periods = 10},
    {"ideal-100", SPRING, .p = {1.3, 2.7, 0, 0}, .duration = PERIODS(100), .finest = 2e-4},
    {"ideal-10000", WORK_SPRING, PERIODS(10000), 0.06, .p = {1.3, 2.7, 0, 0}, .start = {0.8, -0.9}, .finest = 2e-3},
    {"damped", SPRING, .p = {1.3, 2.7, 0.4, 0}, .duration = PERIODS(5), .finest = 2e-5},
    {"loaded", SPRING, .p = {1.3, 2.7, 0.1, 0.9}, .duration = PERIODS(10), .finest = 5e-5},
    {"stiff", SPRING, .p = {1.3, 2.7, 370, 0}, .duration = 100, .finest = 1e-4},
    {"duffing", WORK_SCENE, .longest = 0.01, .harness = "duffing-period", .derivative = move_duffing,
     .reference_steps = 512},
    {"elastic-pendulum", WORK_SCENE, .longest = 0.01, .harness = "elastic-pendulum", .derivative = move_pendulum,
     .reference_steps = 2048},
    {"stiff-and-soft", WORK_SCENE, .longest = 0.01, .harness = "stiff-and-soft-1", .derivative = move_stiff_and_soft,
     .reference_steps = 1024},
    {"cloth", WORK_SCENE, .longest = 0.02, .own = &cloth, .reference_steps = 1024},
    {"water", WORK_SCENE, .longest = 0.02, .own = &water, .reference_steps = 2048},
    {"long-cloth", WORK_SCENE, .longest = 0.05, .own = &long_cloth, .reference_steps = 4096},
    {"stiff-cloth", WORK_SCENE, .longest = 0.06, .own = &stiff_cloth, .reference_steps = 4096},
    {"stiff-rope", WORK_SCENE, .longest = 0.005, .own = &stiff_rope, .reference_steps = 4096},
    {"damped-cloth", WORK_SCENE, .longest = 0.06, .own = &damped_cloth, .reference_steps = 8192},
};
const size_t work_problem_count = sizeof work_problems / sizeof work_problems[0];

/* ---------------------------------------------------------------------------------------------------- one spring */

static double energy(const spring_params *p, const double *y)
{
    const double x = y[0] - p->load / p->stiffness;
    return (p->mass * y[1] * y[1] + p->stiffness * x * x) / 2;
}

static void open_spring(work *w)
{
    const spring_params *p = &w->problem->p;
    const spring_state s = w->problem->start;
    w->duration = w->problem->duration;
    w->omega = sqrt(p->stiffness / p->mass);
    w->motion = hypot(s.x - p->load / p->stiffness, s.v / w->omega);
    w->start[0] = s.x;
    w->start[1] = s.v;
    reference_init(&w->reference);
    reference_start(&w->reference, p, s);
    reference_exact(&w->reference, p, w->duration);
    w->exact[0] = mpfr_get_d(w->reference.x, MPFR_RNDN);
    w->exact[1] = mpfr_get_d(w->reference.v, MPFR_RNDN);
    /* above the limit of every solver: GSL's rk4 halves steps and is then stable up to 2.83/omega, without damping */
    w->coarsest = 6 / w->omega;
    w->finest = w->problem->finest;
    w->constants =
        (work_constants){.omega2 = p->stiffness / p->mass, .gamma = p->damping / p->mass, .accel = p->load / p->mass};
    w->derivative = move_spring;
    w->data = &w->constants;
    w->uses_velocity = p->damping > 0;
}

/* ------------------------------------------------------------------------------------------------------- a scene */

static const scene_case *case_of(const work_problem *problem)
{
    for (size_t i = 0; i < scene_case_count && problem->own == NULL; i++)
        if (strcmp(scene_cases[i].name, problem->harness) == 0)
            return &scene_cases[i];
    return problem->own;
}

static void count_call(void *user, double t, size_t particles, const double *const position[3],
                       const double *const velocity[3], double *const force[3])
{
    work *w = user;
    const spring_scene_def *def = &w->scene.def;
    w->calls++;
    if (def->force != NULL)
        def->force(def->user, t, particles, position, velocity, force);
}

static void make_scenes(work *w)
{
    spring_scene_def def = w->scene.def;
    w->moved = start_definition(&def, &w->bytes);
    w->fresh = start_definition(&def, &w->bytes);
    if (def.force == NULL)
        def.flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY; /* so that counting adds no evaluation */
    def.force = count_call;
    def.user = w;
    w->counted = def;
    w->counting = start_definition(&def, &w->counting_bytes);
}

uint64_t work_count(work *w, spring_method m, uint64_t steps)
{
    spring_scene *scene;
    w->calls = 0;
    spring_scene_init(w->counting, w->counting_bytes, &w->counted, &scene);
    spring_scene_advance(scene, m, w->duration / (double)steps, steps);
    return w->calls;
}

double work_distance(const work *w, const double *a, const double *b)
{
    return scene_distance(&(scene_case){.omega = w->omega}, &w->scene, a, b, 0);
}

enum { PARTS = 32 }; /* parts of the reference run after which the motion is measured */

/* Runs the reference in n steps; no equation here depends on time. Returns the largest distance from the start. */
static double refer(const work *w, uint64_t n, double *y)
{
    ode o = {.size = w->size, .derivative = w->derivative, .data = w->data, .scale = w->scale};
    double largest = 0;
    memcpy(y, w->start, w->size * sizeof *y);
    for (int i = 0; i < PARTS; i++) {
        const char *message = ode_gsl_rk8pd_fixed(&o, y, w->duration / (double)n, n / PARTS);
        if (message != NULL)
            cli_fail(CLI_FAILED, "%s: no reference: %s", w->problem->name, message);
        largest = fmax(largest, work_distance(w, y, w->start));
    }
    return largest;
}

static void find_exact_end(work *w, const scene_case *c)
{
    double *coarse = scene_room(w->size, sizeof *coarse), unknown;
    refer(w, w->problem->reference_steps / 2, coarse);
    w->motion = refer(w, w->problem->reference_steps, w->exact) / 2;
    unknown = work_distance(w, w->exact, coarse);
    if (c->known > 0)
        unknown = fmax(unknown, scene_distance(c, &w->scene, w->exact, c->digits, c->known));
    w->uncertainty = unknown / w->motion;
    if (!(w->uncertainty <= 1e-9))
        cli_fail(CLI_FAILED, "%s: the uncertainty of its reference is %g", w->problem->name, w->uncertainty);
    free(coarse);
}

/* Chooses the equation written out for the problem, or the equation of sheets. */
static void choose_equation(work *w)
{
    const spring_scene_def *def = &w->scene.def;
    for (size_t i = 0; i < def->links; i++)
        w->damped = w->damped || w->scene.link[i].damping > 0;
    if (w->problem->derivative != NULL) {
        w->constants = (work_constants){.omega2 = w->scene.link[0].stiffness / w->scene.mass[0],
                                        .rest = w->scene.link[0].rest,
                                        .accel = def->gravity[def->axes - 1]};
        w->derivative = w->problem->derivative;
        w->data = &w->constants;
        return;
    }
    if (!work_equation_applies(&w->scene))
        cli_fail(CLI_FAILED, "%s: no equation for its links", w->problem->name);
    work_equation_init(&w->equation, &w->scene);
    w->derivative = work_equation_derivative;
    w->data = &w->equation;
}

static void open_scene(work *w)
{
    const scene_case *c = case_of(w->problem);
    if (c == NULL)
        cli_fail(CLI_FAILED, "no scene \"%s\"", w->problem->harness);
    scene_problem_init(&w->scene, c);
    choose_equation(w);
    make_scenes(w);
    w->xpbd = work_xpbd_applies(&w->scene) ? work_xpbd_make(&w->scene) : NULL;
    w->implicit = w->xpbd != NULL && w->data == &w->equation ? work_implicit_make(&w->scene, &w->equation) : NULL;
    w->size = 2 * w->scene.moving;
    w->duration = c->duration;
    w->omega = c->omega;
    w->start = scene_room(w->size, sizeof *w->start);
    w->exact = scene_room(w->size, sizeof *w->exact);
    w->scale = scene_room(w->size, sizeof *w->scale);
    w->gathered = scene_room(w->scene.def.axes * w->scene.def.particles, sizeof *w->gathered);
    for (size_t i = 0; i < w->size; i++)
        w->scale[i] = c->length * (i < w->scene.moving ? 1 : c->omega);
    scene_start(&w->scene, w->start);
    w->uses_velocity = w->damped || w->scene.def.drag > 0 ||
                       (w->scene.def.force != NULL && !(w->scene.def.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY));
    find_exact_end(w, c);
    /* likewise; the stable step is a bound that does not include callbacks */
    w->coarsest = fmin(5 * spring_scene_stable_step(w->fresh, SPRING_LEAPFROG), c->duration / 4);
    w->finest = 0;
}

/* ---------------------------------------------------------------------------------------------------------- both */

void work_open(work *w, const work_problem *problem)
{
    *w = (work){.problem = problem, .size = 2, .clock = timing_now};
    if (problem->kind == WORK_SCENE) {
        open_scene(w);
        return;
    }
    w->start = scene_room(w->size, sizeof *w->start);
    w->exact = scene_room(w->size, sizeof *w->exact);
    w->scale = scene_room(w->size, sizeof *w->scale);
    open_spring(w);
    w->scale[0] = w->motion;
    w->scale[1] = w->motion * w->omega;
}

void work_close(work *w)
{
    free(w->start);
    free(w->exact);
    free(w->scale);
    if (w->problem->kind != WORK_SCENE) {
        reference_clear(&w->reference);
        return;
    }
    scene_problem_clear(&w->scene);
    work_equation_clear(&w->equation);
    free(w->moved);
    free(w->fresh);
    free(w->counting);
    free(w->gathered);
    if (w->xpbd != NULL)
        work_xpbd_free(w->xpbd);
    if (w->implicit != NULL)
        work_implicit_free(w->implicit);
}

double work_error(const work *w, const double *y)
{
    const double resolved = 5; /* uncertainties; larger errors are accurate to a quarter */
    if (w->problem->kind != WORK_SCENE)
        return reference_distance(&w->reference, (spring_state){y[0], y[1]}) / w->motion;
    const double error = work_distance(w, y, w->exact) / w->motion;
    return error > (resolved - 1) * w->uncertainty || isnan(error) ? error : resolved * w->uncertainty;
}

/* Expands positions or velocities of moving particles to all particles, in `to`. */
static void spread(const work *w, const double *fixed, const double *y, double *to)
{
    const scene_problem *p = &w->scene;
    memcpy(to, fixed, p->def.axes * p->def.particles * sizeof *to);
    for (size_t i = 0; i < p->moving; i++)
        to[p->coordinate[i]] = y[i];
}

static double length_of(const scene_problem *p, const double *x, const spring_link *l)
{
    double delta[3] = {0};
    for (size_t d = 0; d < p->def.axes; d++)
        delta[d] = x[p->def.axes * l->b + d] - x[p->def.axes * l->a + d];
    return p->def.axes == 1 ? delta[0] : sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]);
}

static double kinetic_energy(const work *w, const double *y)
{
    const scene_problem *p = &w->scene;
    double sum = 0;
    for (size_t i = 0; i < p->moving; i++)
        sum += p->mass[p->coordinate[i] / p->def.axes] * y[p->moving + i] * y[p->moving + i] / 2;
    return sum;
}

/* Omits the energy of pinned particles, which is constant. */
double work_energy(const work *w, const double *y)
{
    const scene_problem *p = &w->scene;
    const size_t axes = p->def.axes;
    double *x = w->gathered, sum = kinetic_energy(w, y);
    spread(w, p->position, y, x);
    for (size_t i = 0; i < p->moving; i++)
        sum -= p->mass[p->coordinate[i] / axes] * p->def.gravity[p->coordinate[i] % axes] * y[i];
    for (const spring_link *l = p->link; l < p->link + p->def.links; l++) {
        const double stretch = length_of(p, x, l) - l->rest;
        sum += l->stiffness * stretch * stretch / 2;
    }
    return sum;
}

void work_stretches(const work *w, const double *y, double *stretch)
{
    const scene_problem *p = &w->scene;
    spread(w, p->position, y, w->gathered);
    for (const spring_link *l = p->link; l < p->link + p->def.links; l++)
        *stretch++ = length_of(p, w->gathered, l) / l->rest - 1;
}

double work_stretch(const work *w, const double *y)
{
    const size_t links = w->scene.def.links;
    double most = NAN;
    if (w->problem->kind != WORK_SCENE || w->scene.def.axes == 1)
        return NAN;
    double *stretch = scene_room(links, sizeof *stretch);
    work_stretches(w, y, stretch);
    for (size_t i = 0; i < links; i++)
        most = fmax(most, stretch[i]);
    free(stretch);
    return most;
}

double work_energy_error(const work *w, const double *y)
{
    const spring_params *p = &w->problem->p;
    if (w->problem->kind == WORK_SCENE)
        return w->scene.def.force != NULL
                   ? NAN
                   : fabs(work_energy(w, y) - work_energy(w, w->exact)) / kinetic_energy(w, w->exact);
    return fabs(energy(p, y) - energy(p, w->exact)) / energy(p, w->start);
}
