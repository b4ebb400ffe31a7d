/* SPDX-License-Identifier: MIT */
/*
 * The part of spring-validate for scenes.
 *
 * Every method takes n, 2n and 4n steps, h = duration/n. Let R = 2^p, p its order, and its error C h^p + D h^(p+1) + ...
 * Extrapolated values, y_2n + (y_2n - y_n)/(R - 1) and the same from 4n and 2n, are wrong by multiples of D h^(p+1) and
 * differ by
 *
 *     b = |D| h^(p+1) (2R - 1)/(4R (R - 1))
 *
 * With C from y_n and y_2n alone, and D from b, taken twice since h is not infinitely small, the bounds are
 *
 *     y_2n            |y_2n - y_n|/(R - 1)        + 2 b 2R/(2R - 1)
 *     y_4n            |y_2n - y_n|/(R - 1)/R      + 2 b (3R - 1)/(R (2R - 1))
 *     extrapolated                                  2 b/(2R - 1)
 *
 * and rounding. No witness enters them. The second holds only if the error really falls by R, and the third says how far
 * from R: a method of order p - 1 would miss it by factors of 3.5 (leapfrog) and 2.2 (RK4). Steps are small enough, and
 * not so small that rounding matters, for the second to be at most 1.5/R of the first (tests/test_validate.c).
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "harness/ode.h"
#include "validate.h"

typedef struct trial {
    const scene_case *c;
    const scene_problem *p;
    spring_method m;
    double *run[3], *best[2]; /* n, 2n, 4n steps; extrapolated from the first and the last two */
    double b;                 /* [m] the distance of those */
    double rounding;          /* [m] of n steps */
    double rounding_of_all;   /* [m] of every run, and of what is extrapolated from them */
} trial;

static const double ratios[] = {2, 4, 16}; /* 2^order, by spring_method */

static void *vectors(const scene_problem *p, size_t count)
{
    void *room = malloc(count * 2 * p->moving * sizeof(double));
    if (room == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    return room;
}

/* NaN wherever the library does not do as it is told. */
static void run(const scene_problem *p, spring_method m, double dt, uint64_t n, double *y)
{
    const spring_scene_def *def = &p->def;
    const size_t numbers = def->axes * def->particles;
    size_t bytes = 0;
    spring_scene *scene;
    for (size_t i = 0; i < 2 * p->moving; i++)
        y[i] = NAN;
    if (spring_scene_bytes(def, &bytes) != SPRING_OK)
        return;
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    double *state = malloc(2 * numbers * sizeof *state);
    if (memory == NULL || state == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    if (spring_scene_init(memory, bytes, def, &scene) == SPRING_OK &&
        spring_scene_advance(scene, m, dt, n) == SPRING_OK &&
        spring_scene_get(scene, SPRING_POSITION, state, 0, 0, def->particles) == SPRING_OK &&
        spring_scene_get(scene, SPRING_VELOCITY, state + numbers, 0, 0, def->particles) == SPRING_OK)
        for (size_t i = 0; i < p->moving; i++) {
            y[i] = state[p->coordinate[i]];
            y[p->moving + i] = state[numbers + p->coordinate[i]];
        }
    free(memory);
    free(state);
}

static double step_of(const trial *t, int run_index)
{
    return t->c->duration / (double)(t->c->steps[t->m] << run_index);
}

static finding row(const trial *t, const char *witness, int run_index)
{
    return (finding){.of = t->c->name,
                     .method = spring_method_name(t->m),
                     .witness = witness,
                     .dt = step_of(t, run_index),
                     .steps = t->c->steps[t->m] << run_index,
                     .scene = true};
}

/* The same method with the same step, by somebody else: what differs is rounding, on as many sides as do. */
static void against_same(const trial *t, const char *witness, const double *y, int sides,
                         uint64_t evaluations)
{
    finding f = row(t, witness, 0);
    f.error = scene_distance(t->c, t->p, t->run[0], y, 0);
    f.bound = sides * t->rounding;
    f.reason = sides == 2 ? "rounding on both sides" : "rounding";
    f.evaluations = evaluations;
    judge(&f);
}

/* The true solution, as far as the witness knows it: y_2n and y_4n if runs, and in any case the extrapolated value. */
static void against_solution(const trial *t, const char *witness, const double *y, size_t known, bool runs,
                             double uncertainty, double witness_bound, uint64_t evaluations)
{
    const double R = ratios[t->m];
    const double first = scene_distance(t->c, t->p, t->run[1], t->run[0], known) / (R - 1);
    const struct {
        const double *got;
        int run_index;
        double bound;
        const char *reason;
    } rows[] = {
        {t->run[1], 1, first + 4 * R / (2 * R - 1) * t->b, "truncation measured at 2h and h"},
        {t->run[2], 2, first / R + 2 * (3 * R - 1) / (R * (2 * R - 1)) * t->b,
         "truncation measured at 4h and 2h, smaller by 2^order"},
        {t->best[1], 2, 2 / (2 * R - 1) * t->b, "extrapolated: truncation of the next order"},
    };
    for (int i = runs ? 0 : 2; i < 3; i++) {
        finding f = row(t, witness, rows[i].run_index);
        f.error = scene_distance(t->c, t->p, rows[i].got, y, known);
        f.bound = rows[i].bound + t->rounding_of_all + witness_bound;
        f.reason = rows[i].reason;
        f.uncertainty = uncertainty;
        f.evaluations = evaluations;
        judge(&f);
    }
}

static void try_method(trial *t)
{
    const double R = ratios[t->m];
    for (int i = 0; i < 3; i++)
        run(t->p, t->m, step_of(t, i), t->c->steps[t->m] << i, t->run[i]);
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < 2 * t->p->moving; i++)
            t->best[k][i] = t->run[k + 1][i] + (t->run[k + 1][i] - t->run[k][i]) / (R - 1);
    t->b = scene_distance(t->c, t->p, t->best[0], t->best[1], 0);
    /* Four times the steps are four times the rounding, and what carries it on differs little; twice that. The
       extrapolated value has it R/(R - 1) times from 4n steps, and 1/(R - 1) times from 2n. */
    t->rounding_of_all = 8 * t->rounding * (R + 1) / (R - 1);
}

/* -------------------------------------------------------------------------------------- other people's solvers */

static double *scale_of(const scene_case *c, const scene_problem *p)
{
    double *scale = vectors(p, 1);
    for (size_t i = 0; i < 2 * p->moving; i++)
        scale[i] = c->length * (i < p->moving ? 1 : c->omega);
    return scale;
}

static void against_rk4(const trial *t, const char *witness,
                        const char *(*solve)(ode *, double *, double, uint64_t), unsigned our_steps_a_step)
{
    double *y = vectors(t->p, 1), *scale = scale_of(t->c, t->p);
    ode o = {.size = 2 * t->p->moving, .derivative = scene_derivative, .data = t->p, .scale = scale};
    scene_start(t->p, y);
    const char *message =
        solve(&o, y, our_steps_a_step * step_of(t, 0), t->c->steps[t->m] / our_steps_a_step);
    if (message != NULL)
        cli_fail(CLI_FAILED, "%s: %s: %s", t->c->name, witness, message);
    against_same(t, witness, y, 2, o.evaluations);
    free(y);
    free(scale);
}

/* A solver with steps of its own, once more with a tenth of its tolerance: the difference is its uncertainty. */
typedef struct adaptive {
    const char *name;
    const char *(*solve)(ode *o, double *y, double duration, double tolerance);
    double *y, *coarse;
    double uncertainty;
    uint64_t evaluations;
} adaptive;

static const double finest = 1e-13; /* relative to the length of the case */

static void solve_adaptive(adaptive *a, const scene_case *c, const scene_problem *p)
{
    double *scale = scale_of(c, p);
    ode o = {.size = 2 * p->moving, .derivative = scene_derivative, .data = p, .scale = scale};
    a->y = vectors(p, 1);
    a->coarse = vectors(p, 1);
    for (int i = 0; i < 2; i++) {
        double *y = i == 0 ? a->coarse : a->y;
        scene_start(p, y);
        o.evaluations = 0;
        const char *message = a->solve(&o, y, c->duration, i == 0 ? 10 * finest : finest);
        if (message != NULL)
            cli_fail(CLI_FAILED, "%s: %s: %s", c->name, a->name, message);
    }
    a->uncertainty = scene_distance(c, p, a->coarse, a->y, 0);
    a->evaluations = o.evaluations;
    free(scale);
}

/* -------------------------------------------------------------------------------------------------------- a case */

static void same_method(const trial *t, const double *by_definition)
{
    const scene_case *c = t->c;
    against_same(t, "definition", by_definition, 2, 0);
    if (c->iterate != NULL) {
        double *y = vectors(t->p, 1);
        c->iterate(c, t->p, t->m, step_of(t, 0), c->steps[t->m], y);
        against_same(t, c->closed, y, 1, 0);
        free(y);
    }
    if (c->peers && t->m == SPRING_RK4) {
        against_rk4(t, "gsl-rk4", ode_gsl_rk4, 2);
        against_rk4(t, "arkode-rk4", ode_arkstep_rk4, 1);
    }
}

static void solutions(const trial *t, const adaptive *solvers, size_t solver_count)
{
    const scene_case *c = t->c;
    if (c->known > 0)
        against_solution(t, "digits", c->digits, c->known, true, 0, 0, 0);
    if (c->solution != NULL) {
        double *y = vectors(t->p, 1);
        c->solution(c, t->p, y);
        against_solution(t, c->closed, y, 0, true, 0, 0, 0);
        free(y);
    }
    const bool unknown = c->known == 0 && c->solution == NULL; /* then the first solver stands in */
    for (const adaptive *a = solvers; a < solvers + solver_count; a++)
        against_solution(t, a->name, a->y, 0, unknown && a == solvers, a->uncertainty,
                         2 * a->uncertainty + finest * c->length, a->evaluations);
}

void validate_scene(const scene_case *c)
{
    adaptive solvers[] = {{.name = "gsl-rk8pd", .solve = ode_gsl_rk8pd},
                          {.name = "cvode-adams", .solve = adams}};
    const size_t solver_count = c->peers ? sizeof solvers / sizeof solvers[0] : 0;
    scene_problem p;
    scene_problem_init(&p, c);
    for (adaptive *a = solvers; a < solvers + solver_count; a++)
        solve_adaptive(a, c, &p);
    for (int m = SPRING_EULER; m <= SPRING_RK4; m++) {
        if (c->steps[m] == 0)
            continue;
        trial t = {.c = c, .p = &p, .m = (spring_method)m};
        double *all = vectors(&p, 6), *by_definition = all + 10 * p.moving;
        for (int i = 0; i < 5; i++)
            *(i < 3 ? &t.run[i] : &t.best[i - 3]) = all + 2 * p.moving * (size_t)i;
        t.rounding = scene_rounding(c, &p, t.m, step_of(&t, 0), c->steps[m], by_definition);
        try_method(&t);
        same_method(&t, by_definition);
        solutions(&t, solvers, solver_count);
        free(all);
    }
    for (adaptive *a = solvers; a < solvers + solver_count; a++) {
        free(a->y);
        free(a->coarse);
    }
    scene_problem_clear(&p);
}
