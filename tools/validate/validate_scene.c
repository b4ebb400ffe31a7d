/* SPDX-License-Identifier: MIT */
/*
 * The part of spring-validate for scenes.
 *
 * Every method takes n, 2n and 4n steps, h = duration/n. Let R = 2^p, where p is its order, and let its error be
 * C h^p + D h^(p+1) + ... The extrapolated values, y_2n + (y_2n - y_n)/(R - 1) and the same from 4n and 2n, have errors
 * that are multiples of D h^(p+1), and they differ by
 *
 *     b = |D| h^(p+1) (2R - 1)/(4R (R - 1))
 *
 * With C from y_n and y_2n only, and D from b, doubled since h is finite, the bounds are
 *
 *     y_2n            |y_2n - y_n|/(R - 1)        + 2 b 2R/(2R - 1)
 *     y_4n            |y_2n - y_n|/(R - 1)/R      + 2 b (3R - 1)/(R (2R - 1))
 *     extrapolated                                  2 b/(2R - 1)
 *
 * plus rounding. They are independent of any reference. The second holds only if the error falls by R, and the third
 * limits the deviation from R: a method of order p - 1 would exceed it by factors of 3.5 (leapfrog) and 2.2 (RK4).
 * Steps are so small that the second is at most 1.5/R of the first, but not so small that rounding matters
 * (tests/cli/test_validate.c).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "harness/ode.h"
#include "harness/reference.h"
#include "rows.h"
#include "scenes/start.h"

typedef struct trial {
    const scene_case *c;
    const scene_problem *p;
    spring_method m;
    uint64_t steps;           /* n */
    double *run[3], *best[2]; /* n, 2n, 4n steps; extrapolated from the first and the last two */
    double b;                 /* [m] distance of the extrapolated values */
    double rounding;          /* [m] of n steps */
    double rounding_of_all;   /* [m] of every run and of the extrapolated values */
} trial;

static double ratio_of(spring_method m) /* 2^order */
{
    return ldexp(1, spring_method_describe(m)->order);
}

static double *vectors(const scene_problem *p, size_t count)
{
    return scene_room(count * 2 * p->moving, sizeof(double));
}

/* Reads the state of a scene: NaN if the library does not follow its specification. `room` is for two vectors of all
   particles. */
static void get_state(const scene_problem *p, const spring_scene *scene, double *room, double *y)
{
    const size_t numbers = p->def.axes * p->def.particles;
    const bool known = spring_scene_get(scene, SPRING_POSITION, room, 0, 0, p->def.particles) == SPRING_OK &&
                       spring_scene_get(scene, SPRING_VELOCITY, room + numbers, 0, 0, p->def.particles) == SPRING_OK;
    for (size_t i = 0; i < 2 * p->moving; i++)
        y[i] = !known ? NAN : i < p->moving ? room[p->coordinate[i]] : room[numbers + p->coordinate[i - p->moving]];
}

/* Stores the state after n steps; NaN if a call fails. */
static void run(const scene_problem *p, spring_method m, double dt, uint64_t n, double *y)
{
    double *room = scene_room(2 * p->def.axes * p->def.particles, sizeof *room);
    spring_scene *scene = start_definition(&p->def, NULL);
    const bool done = spring_scene_advance(scene, m, dt, n) == SPRING_OK;
    get_state(p, scene, room, y);
    for (size_t i = 0; i < 2 * p->moving && !done; i++)
        y[i] = NAN;
    free(scene);
    free(room);
}

static double step_of(const trial *t, int run_index)
{
    return t->c->duration / (double)(t->steps << run_index);
}

static validate_row row(const trial *t, const char *by, int run_index)
{
    return (validate_row){.of = t->c->name,
                          .method = spring_method_name(t->m),
                          .reference = by,
                          .dt = step_of(t, run_index),
                          .steps = t->steps << run_index,
                          .scene = true};
}

/* The same method with the same step, by another program. The difference is rounding error, of `sides` programs. */
static void against_same(const trial *t, const char *by, const double *y, int sides, uint64_t evaluations)
{
    validate_row f = row(t, by, 0);
    f.error = scene_distance(t->c, t->p, t->run[0], y, 0);
    f.bound = sides * t->rounding;
    f.reason = sides == 2 ? "rounding on both sides" : "rounding";
    f.evaluations = evaluations;
    validate_check(&f);
}

/* The exact solution, for its `known` components. Checks the extrapolated value and, if `runs`, y_2n and y_4n. */
static void against_solution(const trial *t, const char *by, const double *y, size_t known, bool runs,
                             double uncertainty, double reference_bound, uint64_t evaluations)
{
    const double R = ratio_of(t->m);
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
        validate_row f = row(t, by, rows[i].run_index);
        f.error = scene_distance(t->c, t->p, rows[i].got, y, known);
        f.bound = rows[i].bound + t->rounding_of_all + reference_bound;
        f.reason = rows[i].reason;
        f.uncertainty = uncertainty;
        f.evaluations = evaluations;
        validate_check(&f);
    }
}

static void try_method(trial *t)
{
    const double R = ratio_of(t->m);
    for (int i = 0; i < 3; i++)
        run(t->p, t->m, step_of(t, i), t->steps << i, t->run[i]);
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < 2 * t->p->moving; i++)
            t->best[k][i] = t->run[k + 1][i] + (t->run[k + 1][i] - t->run[k][i]) / (R - 1);
    t->b = scene_distance(t->c, t->p, t->best[0], t->best[1], 0);
    /* Four times the steps have four times the rounding error; its amplification differs little, which a factor of 2
       covers. The extrapolated value has R/(R - 1) times the error of 4n steps and 1/(R - 1) times that error of 2n. */
    t->rounding_of_all = 8 * t->rounding * (R + 1) / (R - 1);
}

/* -------------------------------------------------------------------------------------- external solvers */

static double *scale_of(const scene_case *c, const scene_problem *p)
{
    double *scale = vectors(p, 1);
    for (size_t i = 0; i < 2 * p->moving; i++)
        scale[i] = c->length * (i < p->moving ? 1 : c->omega);
    return scale;
}

static void against_rk4(const trial *t, const char *by, const char *(*solve)(ode *, double *, double, uint64_t),
                        unsigned our_steps_a_step)
{
    double *y = vectors(t->p, 1), *scale = scale_of(t->c, t->p);
    ode o = {.size = 2 * t->p->moving, .derivative = scene_derivative, .data = t->p, .scale = scale};
    scene_start(t->p, y);
    const char *message = solve(&o, y, our_steps_a_step * step_of(t, 0), t->steps / our_steps_a_step);
    if (message != NULL)
        cli_fail(CLI_FAILED, "%s: %s: %s", t->c->name, by, message);
    against_same(t, by, y, 2, o.evaluations);
    free(y);
    free(scale);
}

/* An adaptive solver, run again with a tenth of its tolerance; the difference is its uncertainty. */
typedef struct adaptive {
    const char *name;
    const char *(*solve)(ode *o, double *y, double duration, double tolerance);
    double *y, *coarse;
    double uncertainty;
    uint64_t evaluations;
} adaptive;

static const double finest = 1e-13; /* tolerance relative to the length of the case */

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

/* ------------------------------------------------------------------------------------------------- modes of sheets */

/*
 * The phase of a mode is followed step by step. It is the angle of (q, -p/(omega s)), where q and p are the projections
 * of displacement and velocity on the shape, and s is the ratio of the axes of the ellipse under the method. The
 * initial amplitude is 1 m divided by the total phase, so that the path in (x, v/omega) is 1 m long. So distances along
 * it [m] are also relative errors of the frequency.
 *
 * With a = P pi/(N - 1), b = Q pi/(N - 1) the frequency on an infinite lattice is
 *
 *     omega^2 = k/m sum over d of (2 - 2 cos d)
 *
 * with d = a, b for structural, d = a + b, a - b for shear, and d = 2a, 2b for bend links. The frequency of long waves
 * has d^2 instead of 2 - 2 cos d, which is larger by at most d^4/12.
 */
typedef struct sheet_mode {
    unsigned P, Q, N;
    char kind[16];
    double stiffness_over_mass; /* [1/s^2] transverse */
    double omega;               /* [1/s] */
    double uncertainty;         /* of omega, relative */
    double compared;            /* [1/s] of long waves, or of the infinite lattice if omega is not from it */
    double comparison_bound;    /* relative */
    const char *comparison;     /* contributions to the bound */
    double nonlinear;           /* bound on the relative change of omega by an amplitude of 1 m */
    double *shape;              /* [N*N], squares add up to 1 */
} sheet_mode;

static bool has_all_families(const sheet_mode *s)
{
    return strcmp(s->kind, "mirrored") == 0 || strcmp(s->kind, "all") == 0;
}

/* sum of 2 - 2 cos d, d^2 or d^4 */
static double lattice_sum(const sheet_mode *s, int power)
{
    const double unit = acos(-1) / (s->N - 1), a = s->P * unit, b = s->Q * unit;
    const double d[] = {a, b, a + b, a - b, 2 * a, 2 * b};
    double sum = 0;
    for (int i = 0; i < (has_all_families(s) ? 6 : 2); i++)
        sum += power == 0 ? 4 * pow(sin(d[i] / 2), 2) : pow(d[i], power);
    return sum;
}

/* m/k times the force of structural, shear and bend links on a sheet of heights u, from the stencil; 0 at the edges. */
static void pull_sheet(unsigned N, const double *u, double *force)
{
    static const int offset[][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 0}, {0, 2}};
    const int n = (int)N;
    memset(force, 0, (size_t)N * N * sizeof *force);
    for (int y = 1; y < n - 1; y++)
        for (int x = 1; x < n - 1; x++)
            for (int i = 0; i < 12; i++) {
                const int sign = i < 6 ? 1 : -1, ox = x + sign * offset[i % 6][0], oy = y + sign * offset[i % 6][1];
                if (ox >= 0 && ox < n && oy >= 0 && oy < n)
                    force[y * n + x] += u[y * n + x] - u[oy * n + ox];
            }
}

static double dot(size_t count, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

static void normalise(size_t count, double *u)
{
    const double size = sqrt(dot(count, u, u));
    for (size_t i = 0; i < count; i++)
        u[i] /= size;
}

/* Solves pull_sheet(u) = right for u by conjugate gradients; `work` has room for three sheets. */
static void solve_sheet(unsigned N, const double *right, double *u, double *work)
{
    const size_t count = (size_t)N * N;
    double *residue = work, *direction = work + count, *image = work + 2 * count;
    pull_sheet(N, u, image);
    for (size_t i = 0; i < count; i++)
        direction[i] = residue[i] = right[i] - image[i];
    double square = dot(count, residue, residue);
    const double enough = 1e-26 * dot(count, right, right);
    for (size_t k = 0; k < count && square > enough; k++) {
        pull_sheet(N, direction, image);
        const double along = square / dot(count, direction, image), before = square;
        for (size_t i = 0; i < count; i++) {
            u[i] += along * direction[i];
            residue[i] -= along * image[i];
        }
        square = dot(count, residue, residue);
        for (size_t i = 0; i < count; i++)
            direction[i] = residue[i] + square / before * direction[i];
    }
}

/* Projects u on the symmetry of sin(Pa x) sin(Qa y) - sin(Qa x) sin(Pa y), or of the first term if P = Q: rotation by
   180 degrees, exchange of x and y and, if P and Q are both even or both odd, reflection of x. Otherwise rounding
   errors would excite slower modes. */
static void keep_symmetry(const sheet_mode *s, double *u, double *work)
{
    const size_t N = s->N, last = N - 1;
    const double turned = (s->P + s->Q) % 2 == 0 ? 1 : -1, swapped = s->P == s->Q ? 1 : -1,
                 mirrored = s->P % 2 == 1 ? 1 : -1;
    for (int image = 0; image < ((s->P + s->Q) % 2 == 0 ? 3 : 2); image++) {
        memcpy(work, u, N * N * sizeof *u);
        for (size_t y = 0; y < N; y++)
            for (size_t x = 0; x < N; x++) {
                const double other = image == 0   ? turned * work[(last - y) * N + last - x]
                                     : image == 1 ? swapped * work[x * N + y]
                                                  : mirrored * work[y * N + last - x];
                u[y * N + x] = (work[y * N + x] + other) / 2;
            }
    }
}

/* The slowest mode of that symmetry, by inverse iteration. The residual bounds the error of its Rayleigh quotient. */
static void find_mode(sheet_mode *s)
{
    const int most = 100; /* the uncertainty includes the rest of other modes */
    const unsigned N = s->N;
    const size_t count = (size_t)N * N;
    double *before = scene_room(5 * count, sizeof *before), *image = before + count, *work = before + 2 * count;
    const double enough = 1e-10; /* its effect on the projection is quadratic */
    double quotient, residual;
    for (int k = 0;; k++) {
        keep_symmetry(s, s->shape, before);
        normalise(count, s->shape);
        pull_sheet(N, s->shape, image);
        quotient = dot(count, s->shape, image);
        for (size_t i = 0; i < count; i++)
            image[i] -= quotient * s->shape[i];
        residual = sqrt(dot(count, image, image)) / quotient;
        if (residual <= enough || k == most)
            break;
        memcpy(before, s->shape, count * sizeof *before);
        for (size_t i = 0; i < count; i++)
            s->shape[i] /= quotient;
        solve_sheet(N, before, s->shape, work);
    }
    s->omega = sqrt(s->stiffness_over_mass * quotient);
    s->uncertainty = residual;
    free(before);
}

/* The mode of a case, if it is one. The shape is the initial state of the scene. */
static bool mode_of(const scene_case *c, const scene_problem *p, sheet_mode *s)
{
    *s = (sheet_mode){.P = 0};
    if (sscanf(c->name, "%*[a-z]-mode-%u-%u-%15[a-z]-%u", &s->P, &s->Q, s->kind, &s->N) != 4)
        return false;
    const size_t axes = p->def.axes, count = (size_t)s->N * s->N;
    const spring_link *link = p->link;
    double largest = 0;
    s->shape = scene_room(count, sizeof *s->shape);
    for (size_t i = 0; i < count; i++)
        s->shape[i] = p->position[axes * i + axes - 1];
    normalise(count, s->shape);
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, fabs(s->shape[i]));
    s->stiffness_over_mass = link->stiffness / p->mass[0];
    if (axes == 3) { /* the transverse stiffness is the extension over the length */
        const double spacing = p->position[3], drawn = 1 - link->rest / spacing;
        s->stiffness_over_mass *= drawn;
        const double slope = largest * acos(-1) / (spacing * (s->N - 1));
        s->nonlinear = slope * slope / 4 / drawn; /* the length grows by slope^2/2, the frequency by half of that */
    }
    const double lattice = sqrt(s->stiffness_over_mass * lattice_sum(s, 0));
    s->omega = lattice;
    s->compared = sqrt(s->stiffness_over_mass * lattice_sum(s, 2));
    s->comparison_bound = 1 - sqrt(1 - lattice_sum(s, 4) / (12 * lattice_sum(s, 2)));
    s->comparison = "long waves: d^4/12 of d^2, and the step";
    if (strcmp(s->kind, "all") == 0) {
        find_mode(s);
        s->compared = lattice;
        s->comparison_bound = 1.0 / (s->N - 1);
        s->comparison = "infinite lattice: half a spacing at each edge, and the step";
    }
    return true;
}

/* The state of the mode in (q, p/omega), and its total phase. */
typedef struct followed {
    double q, p, phase;
} followed;

/* The coordinate that is in quadrature with q; see reference_turn. */
static double across(const reference_turn *step, const followed *f)
{
    return step->x_to_x * f->q + step->v_to_x * f->p;
}

static followed look_at_mode(const trial *t, const sheet_mode *s, const spring_scene *scene, double *room)
{
    const scene_problem *p = t->p;
    const size_t axes = p->def.axes;
    double *y = room + 2 * axes * p->def.particles;
    followed f = {0, 0, 0};
    get_state(p, scene, room, y);
    for (size_t i = 0; i < p->moving; i++)
        if (p->coordinate[i] % axes == axes - 1) {
            f.q += s->shape[p->coordinate[i] / axes] * y[i];
            f.p += s->shape[p->coordinate[i] / axes] * y[p->moving + i] / s->omega;
        }
    return f;
}

static followed follow(const trial *t, const sheet_mode *s, const reference_turn *step)
{
    const scene_problem *p = t->p;
    double *room = scene_room(2 * p->def.axes * p->def.particles + 2 * p->moving, sizeof *room);
    spring_scene *scene = start_definition(&p->def, NULL);
    followed f = look_at_mode(t, s, scene, room);
    for (uint64_t i = 0; i < t->steps; i++) {
        const bool done = spring_scene_advance(scene, t->m, step_of(t, 0), 1) == SPRING_OK;
        followed next = look_at_mode(t, s, scene, room);
        const double p0 = across(step, &f), p1 = across(step, &next);
        next.phase = done ? f.phase + atan2(next.q * p0 - p1 * f.q, next.q * f.q + p1 * p0) : NAN;
        f = next;
    }
    free(scene);
    free(room);
    return f;
}

static const double requirement = 0.005; /* relative, of a frequency */

/* Checks the frequency against the dispersion relation, the motion against the relation with the effect of the step,
   and the distance of the frequency from a simpler theory. */
static void check_mode(const trial *t, const sheet_mode *s, const reference_turn *step)
{
    const double h = step_of(t, 0), n = (double)t->steps, whole = s->omega * t->c->duration;
    const double size = exp(n * step->log_growth) / whole, error_of_step = fabs(step->ahead / (s->omega * h));
    const followed f = follow(t, s, step);
    validate_row row_of = row(t, t->c->formula, 0);
    row_of.uncertainty = s->uncertainty;
    row_of.error = fabs(f.phase / whole - 1);
    row_of.bound = requirement;
    row_of.reason = "frequency: the requirement, half a percent";
    validate_check(&row_of);
    const double C = cos(n * step->angle), S = sin(n * step->angle);
    row_of.error = hypot(f.q - size * (C + step->x_to_x * S), f.p - size * step->x_to_v * S);
    row_of.bound = t->rounding + s->uncertainty + s->nonlinear / (whole * whole);
    row_of.reason =
        s->nonlinear > 0 ? "motion with this step: rounding, and the amplitude" : "motion with this step: rounding";
    validate_check(&row_of);
    row_of.error = fabs(f.phase / t->c->duration / s->compared - 1);
    row_of.bound = s->comparison_bound + error_of_step;
    row_of.reason = s->comparison;
    validate_check(&row_of);
}

/* Chooses steps so short that their shift of the frequency stays below most of the requirement. */
static reference_turn choose_steps(trial *t, const sheet_mode *s)
{
    reference_turn step;
    while (!reference_turn_of(&step, t->m, s->omega, step_of(t, 0)) ||
           fabs(step.ahead) > 0.9 * requirement * s->omega * step_of(t, 0))
        t->steps *= 2;
    return step;
}

static void validate_mode(const scene_case *c, scene_problem *p, sheet_mode *s)
{
    const size_t axes = p->def.axes;
    const double lowest = 2 * sin(acos(-1) / (2 * (s->N - 1))), amplitude = 1 / (s->omega * c->duration);
    scene_case of = *c;
    of.omega = s->omega;
    of.slowest = sqrt(2 * s->stiffness_over_mass) * lowest;
    of.fastest = sqrt((has_all_families(s) ? 24 : 8) * p->link->stiffness / p->mass[0]);
    for (size_t i = 0; i < p->def.particles; i++)
        p->position[axes * i + axes - 1] = p->pinned[i] ? 0 : amplitude * s->shape[i];
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        trial t = {.c = &of, .p = p, .m = spring_method_at(i)};
        t.steps = scene_case_steps(c, t.m);
        if (t.steps == 0)
            continue;
        const reference_turn step = choose_steps(&t, s);
        double *all = vectors(p, 2), *by_definition = all + 2 * p->moving;
        t.run[0] = all;
        t.rounding = scene_rounding(&of, p, t.m, step_of(&t, 0), t.steps, by_definition);
        run(p, t.m, step_of(&t, 0), t.steps, t.run[0]);
        against_same(&t, "definition", by_definition, 2, 0);
        check_mode(&t, s, &step);
        free(all);
    }
}

/* -------------------------------------------------------------------------------------------------------- a case */

static void same_method(const trial *t, const double *by_definition)
{
    const scene_case *c = t->c;
    against_same(t, "definition", by_definition, 2, 0);
    if (c->iterate != NULL) {
        double *y = vectors(t->p, 1);
        c->iterate(c, t->p, t->m, step_of(t, 0), t->steps, y);
        against_same(t, c->formula, y, 1, 0);
        free(y);
    }
    if (c->external && t->m == SPRING_RK4) {
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
        against_solution(t, c->formula, y, 0, true, 0, 0, 0);
        free(y);
    }
    const bool unknown = c->known == 0 && c->solution == NULL; /* then the first solver is the reference */
    for (const adaptive *a = solvers; a < solvers + solver_count; a++)
        against_solution(t, a->name, a->y, 0, unknown && a == solvers, a->uncertainty,
                         2 * a->uncertainty + finest * c->length, a->evaluations);
}

void validate_scene(const scene_case *c)
{
    adaptive solvers[] = {{.name = "gsl-rk8pd", .solve = ode_gsl_rk8pd},
                          {.name = "cvode-adams", .solve = ode_cvode_adams}};
    const size_t solver_count = c->external ? sizeof solvers / sizeof solvers[0] : 0;
    scene_problem p;
    sheet_mode mode;
    scene_problem_init(&p, c);
    if (mode_of(c, &p, &mode)) {
        validate_mode(c, &p, &mode);
        free(mode.shape);
        scene_problem_clear(&p);
        return;
    }
    for (adaptive *a = solvers; a < solvers + solver_count; a++)
        solve_adaptive(a, c, &p);
    for (int k = 0; k < SPRING_METHOD_COUNT; k++) {
        trial t = {.c = c, .p = &p, .m = spring_method_at(k)};
        t.steps = scene_case_steps(c, t.m);
        if (t.steps == 0)
            continue;
        double *all = vectors(&p, 6), *by_definition = all + 10 * p.moving;
        for (size_t i = 0; i < 3; i++)
            t.run[i] = all + 2 * p.moving * i;
        for (size_t i = 0; i < 2; i++)
            t.best[i] = all + 2 * p.moving * (3 + i);
        t.rounding = scene_rounding(c, &p, t.m, step_of(&t, 0), t.steps, by_definition);
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
