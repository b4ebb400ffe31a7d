/* SPDX-License-Identifier: MIT */
/* The foundations of spring-work: counted work, one equation for all solvers, and an exact solution within its
   uncertainty. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "work_precision/work.h"

enum { MOST_PROBLEMS = 32 };
static work opened[MOST_PROBLEMS]; /* once for all tests: a reference takes seconds */

static work *work_of(size_t i)
{
    if (opened[i].problem == NULL)
        work_open(&opened[i], &work_problems[i]);
    return &opened[i];
}

static work *work_named(const char *name)
{
    size_t i = 0;
    while (strcmp(work_problems[i].name, name) != 0)
        i++;
    return work_of(i);
}

/* Fewer than overflow, with any method. */
static const uint64_t steps = 37;

static double short_step(const work *w)
{
    return spring_scene_stable_step(w->fresh, SPRING_LEAPFROG) / 50;
}

static void counts_of_a_scene(work *w)
{
    CHECK(work_count(w, SPRING_EULER, 1) == 1, "one force evaluation in one step of Euler");
    w->duration = (double)steps * short_step(w);
    CHECK(work_count(w, SPRING_EULER, steps) == steps, "one a step");
    CHECK(work_count(w, SPRING_LEAPFROG, steps) == steps + !w->damped,
          "one a step, and one at the start where forces are kept");
    CHECK(work_count(w, SPRING_RK4, steps) == 4 * steps, "four stages a step");
    CHECK(work_count(w, SPRING_RK4, steps) == 4 * steps, "from the start again, nothing is kept");
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method_info *info = spring_method_describe(spring_method_at(i));
        const uint64_t forces = (uint64_t)info->forces_per_step * steps;
        if (work_applies(w, work_solver_of(spring_method_at(i))))
            CHECK(work_count(w, spring_method_at(i), steps) - forces <= 1, "as the table says, and one at the start");
    }
}

/* The scene that counts moves as the one that is timed. */
static void counted_is_timed(work *w)
{
    const size_t count = w->scene.def.axes * w->scene.def.particles;
    double *timed = scene_room(count, sizeof *timed), *counted = scene_room(count, sizeof *counted);
    w->duration = (double)steps * short_step(w);
    for (int k = 0; k < SPRING_METHOD_COUNT; k++) {
        const spring_method m = spring_method_at(k);
        if (!work_applies(w, work_solver_of(m)))
            continue;
        memcpy(w->moved, w->fresh, w->bytes);
        CHECK(spring_scene_advance(w->moved, m, w->duration / (double)steps, steps) == SPRING_OK, "it moves");
        work_count(w, m, steps);
        spring_scene_get(w->moved, SPRING_VELOCITY, timed, 0, 0, w->scene.def.particles);
        spring_scene_get(w->counting, SPRING_VELOCITY, counted, 0, 0, w->scene.def.particles);
        bool same = true;
        for (size_t i = 0; i < count; i++)
            same = same && fabs(timed[i] - counted[i]) <= 0;
        CHECK(same, "the same velocities, to the bit, with the callback that counts");
    }
    free(timed);
    free(counted);
}

static void count_calls(void *user, double t, size_t particles, const double *const x[3], const double *const v[3],
                        double *const force[3])
{
    (void)t, (void)particles, (void)x, (void)v, (void)force;
    ++*(uint64_t *)user;
}

static void predicted_velocity(void)
{
    const double position[] = {0, 0.8};
    const spring_link link = {0, 1, 0.5, 2.7, 0, 0};
    uint64_t calls = 0;
    const spring_scene_def def = {.axes = 1,
                                  .particles = 2,
                                  .links = 1,
                                  .position = position,
                                  .mass_all = 1.3,
                                  .link = &link,
                                  .force = count_calls,
                                  .user = &calls};
    size_t bytes;
    spring_scene *scene;
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "a scene");
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    CHECK(spring_scene_init(memory, bytes, &def, &scene) == SPRING_OK, "a scene");
    CHECK(spring_scene_advance(scene, SPRING_LEAPFROG, 0.013, steps) == SPRING_OK, "it moves");
    CHECK(calls == 2 * steps, "two a step where a callback may use velocities");
    free(memory);
}

/* By the solvers' own counting, of a right-hand side that counts by itself, too. */
static uint64_t derivatives;

static void counted_derivative(double t, const double *y, double *dy, const void *data)
{
    derivatives++;
    ode_spring_derivative(t, y, dy, data);
}

static void counts_of_external_solvers(void)
{
    const double scale[] = {1, 1};
    for (size_t i = 0; i < work_solver_count; i++) {
        const work_solver *s = work_solver_at(i);
        const spring_params p = {1.3, 2.7, s->positions_only ? 0 : 0.2, 0.4};
        ode o = {.size = 2, .derivative = counted_derivative, .data = &p, .scale = scale};
        double y[] = {0.8, -0.9};
        if (s->side != WORK_EXTERNAL)
            continue;
        derivatives = 0;
        CHECK((s->fixed != NULL ? s->fixed(&o, y, 0.013, steps) : s->adaptive(&o, y, 0.5, 1e-6)) == NULL,
              "it integrates");
        CHECK(o.evaluations == derivatives, "every evaluation is counted");
        CHECK(s->fixed != NULL ? o.steps == steps : o.steps > 0, "steps are counted");
        const uint64_t once = s->fixed == ode_gsl_rk4       ? 11
                              : s->fixed == ode_arkstep_rk4 ? 4
                              : s->order == 4               ? 5
                              : s->order == 6               ? 8
                                                            : 13;
        CHECK(s->fixed == NULL || (derivatives >= once * steps && derivatives <= once * steps + 1),
              "GSL's RK4 4 + 3 + 4, since its step is doubled; ARKODE's RK4 4; McLachlan's 5; SPRKStep 8; order 8: 13");
    }
}

static double ticks(void)
{
    static double now;
    return now += 1;
}

static void speed_of_sundials(void)
{
    CHECK_CLOSE(ode_sundials_slowness(ticks), 1, 0, "by a clock that runs as fast for both sums");
    CHECK(atoi(ode_sundials_version()) >= 6, "a version");
}

static double error_of(work *w, const work_solver *s, work_effort e)
{
    double *y = scene_room(w->size, sizeof *y);
    CHECK(work_run(w, s, e, 1, y).failure == NULL, "it integrates");
    const double error = work_error(w, y);
    free(y);
    return error;
}

/* The number of steps, doubled until the error is small. */
static uint64_t steps_to(work *w, const work_solver *s, double error)
{
    uint64_t n = (uint64_t)ceil(2 * w->duration / w->coarsest);
    for (int doubled = 0; doubled < 12 && !(error_of(w, s, (work_effort){.steps = n}) <= error); doubled++)
        n *= 2;
    return n;
}

/* Where errors are between those of long steps and rounding errors. */
static void has_order(work *w, const work_solver *s)
{
    const uint64_t n = steps_to(w, s, s->order == 8 ? 1e-7 : 1e-5);
    const double coarse = error_of(w, s, (work_effort){.steps = n}),
                 fine = error_of(w, s, (work_effort){.steps = 2 * n});
    CHECK_CLOSE(log2(coarse / fine), s->order, 0.2, "its order, toward it: the next term is smaller by a step");
}

/* Error control keeps the error of a step: over a run it grows by the number of steps, and by how the motion spreads errors. */
static void follows_tolerance(work *w, const work_solver *s)
{
    const double tight = error_of(w, s, (work_effort){.tolerance = 1e-9});
    const double most = strcmp(s->name, "cvode-bdf2") == 0 ? 1e5 : 1e4; /* of order 2, which takes thousands of steps */
    CHECK_BELOW(tight, 1e-9 * most, "some hundred steps, each of whose errors grows by less than a hundred");
}

/* On one particle with its order; to the same end of scenes whose states are an array and a vector. */
static void external_solvers_converge(void)
{
    work *duffing = work_named("duffing"), *pendulum = work_named("elastic-pendulum"), *rope = work_named("stiff-rope");
    for (size_t i = 0; i < work_solver_count; i++) {
        const work_solver *s = work_solver_at(i);
        if (s->side != WORK_EXTERNAL)
            continue;
        if (s->fixed == NULL) {
            follows_tolerance(duffing, s);
            follows_tolerance(pendulum, s);
            follows_tolerance(rope, s);
            continue;
        }
        const double small = s->order == 8 ? 1e-10 : 1e-6;
        has_order(duffing, s);
        CHECK_BELOW(error_of(pendulum, s, (work_effort){.steps = steps_to(pendulum, s, small)}), small, "it converges");
        CHECK_BELOW(error_of(rope, s, (work_effort){.steps = steps_to(rope, s, small)}), small, "it converges");
    }
}

static void some_forces_use_velocities(void)
{
    static const char *const with[] = {"damped", "cloth", "water", "damped-cloth"};
    static const char *const without[] = {"ideal-1", "duffing", "elastic-pendulum", "stiff-and-soft", "stiff-cloth"};
    for (size_t i = 0; i < sizeof with / sizeof with[0]; i++)
        CHECK(work_named(with[i])->uses_velocity, "damping, drag or both");
    for (size_t i = 0; i < sizeof without / sizeof without[0]; i++)
        CHECK(!work_named(without[i])->uses_velocity, "neither, nor in a callback");
    for (size_t k = 0; k < work_solver_count; k++)
        CHECK(!work_solver_at(k)->positions_only || (!work_applies(work_named("cloth"), work_solver_at(k)) &&
                                                     work_applies(work_named("duffing"), work_solver_at(k))),
              "a solver for forces of positions is not run with drag");
}

/* Each component of dy/dt against the harness, from the sizes of what is added: eight links, sixteen roundings a
   link. */
static void one_equation(work *w)
{
    double *ours = scene_room(w->size, sizeof *ours), *theirs = scene_room(w->size, sizeof *theirs);
    double largest = 0, damping = 0, worst = 0;
    for (const spring_link *l = w->scene.link; l < w->scene.link + w->scene.def.links; l++) {
        largest = fmax(largest, l->stiffness);
        damping = fmax(damping, l->damping);
    }
    const double fastest = 2 * w->omega * w->motion; /* the distance from the start, at rest, is no larger */
    const double size = 8 * (largest * fmax(1, w->motion) + damping * fastest) / w->scene.mass[0] + 10;
    for (int at = 0; at < 2; at++) {
        const double *y = at == 0 ? w->start : w->exact;
        w->derivative(0.3, y, ours, w->data);
        scene_derivative(0.3, y, theirs, &w->scene);
        for (size_t i = 0; i < w->size; i++)
            worst = fmax(worst, fabs(ours[i] - theirs[i]));
    }
    CHECK_BELOW(worst, 16 * DBL_EPSILON * size, "the lean right-hand side is the harness's, up to rounding");
    free(ours);
    free(theirs);
}

/* By a stepper of the library, which had no part in it: RK4 gets nearer as h^4, once steps are short. */
static void exact_end_of_a_scene(work *w)
{
    double *y = scene_room(w->size, sizeof *y), coarse = INFINITY;
    const work_solver *const rk4 = work_solver_of(SPRING_RK4);
    /* Errors with one and two times as many steps are far from 1e-12, too. Modes that decay fast have no order until
       steps are short for them. */
    const double short_enough = w->damped ? 1e-10 : 1e-8;
    uint64_t n = (uint64_t)(w->duration / (spring_scene_stable_step(w->fresh, SPRING_LEAPFROG) / 8)) + 1;
    CHECK_BELOW(w->uncertainty, 1e-12, "it is good for every error of the table");
    CHECK_CLOSE(work_error(w, w->exact), 5 * w->uncertainty, 0, "no error below what it is known to");
    for (int doubled = 0; !(coarse <= short_enough) && doubled < 10; doubled++, n *= 2) {
        const bool moves = work_run(w, rk4, (work_effort){.steps = n}, 1, y).failure == NULL;
        coarse = moves ? work_error(w, y) : INFINITY;
    }
    work_run(w, rk4, (work_effort){.steps = n}, 1, y);
    CHECK_CLOSE(log2(coarse / work_error(w, y)), 4, w->damped ? 0.2 : 0.1,
                "fourth order, toward it: terms of the next one are h times smaller, by rates of decay if damped");
    y[0] = NAN;
    CHECK(!(work_error(w, y) <= 1), "NaN is no small error");
    free(y);
}

/* The numbers that the help promises of the stiff scenes, by the library's own bound. */
static void stiffness_of_frames(void)
{
    static const char *const stiff[] = {"stiff-cloth", "stiff-rope", "damped-cloth"};
    for (int i = 0; i < 3; i++) {
        const work *w = work_named(stiff[i]);
        const double step = spring_scene_stable_step(w->fresh, SPRING_LEAPFROG);
        CHECK_CLOSE(2 / step / 60, 50, 50 * 64 * DBL_EPSILON, "sqrt(L)/60 Hz, sums of a dozen links");
        CHECK_CLOSE(w->scene.link[0].damping / w->scene.mass[0] / 60, i == 2 ? 100 : 0, 100 * 4 * DBL_EPSILON,
                    "damping/mass/60 Hz, rounded twice on each side");
    }
}

static double xpbd_error(work *w, uint64_t substeps_of_a_frame, double *rms)
{
    const work_solver *s = work_solver_at(SPRING_METHOD_COUNT + 2);
    double *y = scene_room(w->size, sizeof *y), sum = 0;
    const uint64_t n = (uint64_t)rint(w->duration * 60) * substeps_of_a_frame;
    CHECK(strcmp(s->name, "xpbd") == 0 && work_applies(w, s), "it is for this scene");
    CHECK(work_run(w, s, (work_effort){.steps = n}, 1, y).failure == NULL, "it moves");
    for (size_t i = 0; i < w->scene.moving; i++)
        sum += pow(y[i] - w->exact[i], 2);
    *rms = sqrt(3 * sum / (double)w->scene.moving);
    const double error = work_error(w, y);
    free(y);
    return error;
}

/* XPBD goes to the same end, with its first order: substeps of Gauss-Seidel are a splitting of the implicit Euler method. */
static void xpbd_converges(void)
{
    static const char *const scenes[] = {"stiff-cloth", "stiff-rope", "damped-cloth"};
    for (int i = 0; i < 3; i++) {
        work *w = work_named(scenes[i]);
        double rms;
        const double coarse = xpbd_error(w, 1024, &rms);
        CHECK_CLOSE(log2(coarse / xpbd_error(w, 2048, &rms)), 1, 0.1,
                    "first order, toward it: the next term is a tenth of the error at 1024 substeps");
        xpbd_error(w, 512, &rms);
        CHECK(i != 0 || rms <= 2e-4, "0.2 mm at 512 substeps of a frame: less than half of that, measured");
    }
    CHECK(work_named("duffing")->xpbd == NULL, "not with forces of a callback");
}

/* Implicit methods go to the same end with their order, and repeat their bits. Where they have their order: BDF2 once
   steps are short for the decay of damped links, projective dynamics once its only iteration is enough. */
static void implicit_solvers_converge(void)
{
    for (size_t i = 0; i < work_solver_count; i++) {
        const work_solver *s = work_solver_at(i);
        if (s->side != WORK_IMPLICIT)
            continue;
        work *rope = work_named("stiff-rope"), *other = work_named(s->order == 2 ? "damped-cloth" : "stiff-rope");
        const uint64_t n = s->order == 2 ? 32 : 480;
        const double coarse = error_of(other, s, (work_effort){.steps = n});
        CHECK_CLOSE(log2(coarse / error_of(other, s, (work_effort){.steps = 2 * n})), s->order, 0.2,
                    "its order, toward it");
        double *y = scene_room(rope->size, sizeof *y), *again = scene_room(rope->size, sizeof *again);
        work_run(rope, s, (work_effort){.steps = 1500}, 1, y);
        work_run(rope, s, (work_effort){.steps = 1500}, 2, again);
        CHECK(memcmp(y, again, rope->size * sizeof *y) == 0, "a run leaves nothing behind");
        CHECK_BELOW(work_error(rope, y), s->order == 2 ? 2e-4 : 2e-2, "near the same end: half of that, measured");
        CHECK(!work_applies(work_named("duffing"), s) && !work_applies(work_named("water"), s), "only in space");
        free(y);
        free(again);
    }
    CHECK(!work_applies(work_named("damped-cloth"), work_solver_at(SPRING_METHOD_COUNT + 4)), "projective");
}

static void exact_end_of_a_spring(work *w)
{
    spring_state s = w->problem->start;
    const spring_params *p = &w->problem->p;
    const double zeta = p->damping / (2 * p->mass * w->omega);
    const double bound = 4 * DBL_EPSILON * (1 + w->omega * w->duration * fmax(1, zeta));
    spring_step_exact(&s, p, w->duration);
    const double y[] = {s.x, s.v};
    CHECK_BELOW(work_error(w, y), bound, "the bound of the exact solution");
    CHECK_BELOW(work_energy_error(w, y), 2 * bound, "energy is the square of that");
}

static void every_scene(work *w)
{
    const double duration = w->duration;
    counts_of_a_scene(w);
    counted_is_timed(w);
    w->duration = duration;
    one_equation(w);
    exact_end_of_a_scene(w);
}

/* Every problem, opened once for all tests. */
static void problems(void)
{
    CHECK(work_problem_count <= MOST_PROBLEMS, "there is room");
    for (size_t i = 0; i < work_problem_count; i++)
        if (work_problems[i].kind == WORK_SCENE)
            every_scene(work_of(i));
        else if (work_problems[i].kind == WORK_SPRING)
            exact_end_of_a_spring(work_of(i));
}

int main(void)
{
    static const test tests[] = {
        {"every problem: force evaluations, one equation, the exact end", problems},
        {"leapfrog with a callback that may use velocities", predicted_velocity},
        {"force evaluations of external solvers", counts_of_external_solvers},
        {"speed and version of SUNDIALS", speed_of_sundials},
        {"external solvers converge with their order", external_solvers_converge},
        {"forces that depend on velocities", some_forces_use_velocities},
        {"stiffness and damping of the stiff scenes", stiffness_of_frames},
        {"XPBD converges", xpbd_converges},
        {"implicit methods converge", implicit_solvers_converge},
    };
    const int status = RUN_TESTS("work", tests);
    for (size_t i = 0; i < work_problem_count; i++)
        if (opened[i].problem != NULL)
            work_close(&opened[i]);
    return status;
}
