/* SPDX-License-Identifier: MIT */
/* An independent implementation of the equation of a scene; see scenes.h. */
#include "harness/scenes.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/iterates.h"
#include "harness/link.h"
#include "harness/reference.h"

void *scene_room(size_t count, size_t size)
{
    void *array = calloc(count + 1, size); /* no array is empty */
    if (array == NULL) {
        fputs("scenes: out of memory\n", stderr);
        exit(EXIT_FAILURE);
    }
    return array;
}

static double *numbers(size_t count)
{
    return scene_room(count, sizeof(double));
}

void scene_problem_make(scene_problem *p, uint32_t axes, size_t particles, size_t links, double mass)
{
    p->position = scene_room(axes * particles, sizeof *p->position);
    p->velocity = scene_room(axes * particles, sizeof *p->velocity);
    p->mass = scene_room(particles, sizeof *p->mass);
    p->pinned = scene_room(particles, sizeof *p->pinned);
    p->link = scene_room(links, sizeof *p->link);
    for (size_t i = 0; i < particles; i++)
        p->mass[i] = mass;
    p->def = (spring_scene_def){.axes = axes,
                                .particles = particles,
                                .links = links,
                                .position = p->position,
                                .velocity = p->velocity,
                                .mass_all = mass,
                                .pinned = p->pinned,
                                .link = p->link};
}

size_t scene_problem_grid(scene_problem *p, const spring_grid *g, size_t more_links, double mass)
{
    size_t particles, links;
    if (spring_grid_size(g, &particles, &links) != SPRING_OK) {
        fputs("scenes: not a grid\n", stderr);
        exit(EXIT_FAILURE);
    }
    scene_problem_make(p, g->height ? 1 : g->axes, particles, links + more_links, mass);
    spring_grid_fill(g, p->position, p->pinned, p->link);
    return links;
}

/* The methods that accept a definition. */
static uint32_t methods_of(spring_scene_def def)
{
    uint32_t methods = 0;
    for (int m = 0; m < SPRING_METHOD_COUNT; m++) {
        def.methods = 1u << m;
        if (spring_scene_check(&def, NULL, NULL) == SPRING_OK)
            methods |= def.methods;
    }
    return methods;
}

void scene_problem_init(scene_problem *p, const scene_case *c)
{
    *p = (scene_problem){.moving = 0};
    c->build(c, p);
    p->def.methods = methods_of(p->def);
    const size_t axes = p->def.axes, particles = p->def.particles;
    p->coordinate = scene_room(axes * particles, sizeof *p->coordinate);
    p->room = numbers(4 * axes * particles);
    for (size_t i = 0; i < axes * particles; i++)
        if (!p->pinned[i / axes])
            p->coordinate[p->moving++] = i;
    p->drag = numbers(p->moving);
    for (size_t i = 0; i < p->moving; i++)
        p->drag[i] = p->def.drag / p->mass[p->coordinate[i] / axes];
}

void scene_problem_clear(scene_problem *p)
{
    free(p->position);
    free(p->velocity);
    free(p->mass);
    free(p->pinned);
    free(p->link);
    free(p->coordinate);
    free(p->drag);
    free(p->room);
}

void scene_start(const scene_problem *p, double *y)
{
    for (size_t i = 0; i < p->moving; i++) {
        y[i] = p->position[p->coordinate[i]];
        y[p->moving + i] = p->velocity[p->coordinate[i]];
    }
}

double scene_distance(const scene_case *c, const scene_problem *p, const double *a, const double *b, size_t known)
{
    double sum = 0;
    for (size_t i = 0; i < (known > 0 ? known : 2 * p->moving); i++) {
        const double part = (a[i] - b[i]) / (i < p->moving ? 1 : c->omega);
        sum += part * part;
    }
    return sqrt(sum);
}

/* ------------------------------------------------------------------------------------------------------- forces */

enum { POSITION, VELOCITY, FORCE, SIZE };

static double *axis_of(const scene_problem *p, int what, size_t axis)
{
    return p->room + ((size_t)what * p->def.axes + axis) * p->def.particles;
}

/* Adds the force of a link to both ends, and the sizes of its terms. */
static void add_link(const scene_problem *p, const spring_link *link)
{
    const size_t axes = p->def.axes, a = link->a, b = link->b;
    double delta[3], relative[3];
    for (size_t d = 0; d < axes; d++) {
        delta[d] = axis_of(p, POSITION, d)[b] - axis_of(p, POSITION, d)[a];
        relative[d] = axis_of(p, VELOCITY, d)[b] - axis_of(p, VELOCITY, d)[a];
    }
    const link_force f = link_evaluate(axes, delta, relative, link->stiffness, link->damping, link->rest);
    const double size = link->stiffness * (fabs(f.length) + link->rest) + link->damping * fabs(f.rate);
    for (size_t d = 0; d < axes; d++) {
        const double along = axes == 1 ? 1 : f.length > 0 ? fabs(delta[d] / f.length) : 0;
        axis_of(p, FORCE, d)[a] += f.force[d];
        axis_of(p, FORCE, d)[b] -= f.force[d];
        axis_of(p, SIZE, d)[a] += size * along;
        axis_of(p, SIZE, d)[b] += size * along;
    }
}

/* Accelerations of all moving coordinates, without drag. */
static void accelerations(const void *data, double t, const double *x, const double *v, double *a)
{
    const scene_problem *p = data;
    const spring_scene_def *def = &p->def;
    const size_t axes = def->axes;
    double *axis[4][3] = {{NULL}};
    for (int what = POSITION; what <= SIZE; what++)
        for (size_t d = 0; d < axes; d++)
            axis[what][d] = axis_of(p, what, d);
    memset(axis[FORCE][0], 0, 2 * axes * def->particles * sizeof(double));
    for (size_t i = 0; i < axes * def->particles; i++) {
        axis[POSITION][i % axes][i / axes] = p->position[i];
        axis[VELOCITY][i % axes][i / axes] = 0;
    }
    for (size_t i = 0; i < p->moving; i++) {
        const size_t at = p->coordinate[i];
        axis[POSITION][at % axes][at / axes] = x[i];
        axis[VELOCITY][at % axes][at / axes] = v[i];
    }
    for (size_t i = 0; i < def->links; i++)
        add_link(p, &p->link[i]);
    if (def->force != NULL)
        def->force(def->user, t, def->particles, (const double *const *)axis[POSITION],
                   (const double *const *)axis[VELOCITY], axis[FORCE]);
    for (size_t i = 0; i < p->moving; i++) {
        const size_t at = p->coordinate[i];
        a[i] = axis[FORCE][at % axes][at / axes] / p->mass[at / axes] + def->gravity[at % axes];
    }
}

void scene_derivative(double t, const double *y, double *dy, const void *data)
{
    const scene_problem *p = data;
    const double *v = y + p->moving;
    accelerations(p, t, y, v, dy + p->moving);
    for (size_t i = 0; i < p->moving; i++) {
        dy[i] = v[i];
        dy[p->moving + i] -= p->drag[i] * v[i];
    }
}

/* Takes step i of a run, from t. `room` has iterate_room(moving) numbers and keeps values from step to step. */
static void step(const scene_problem *p, spring_method m, double h, double t, uint64_t i, double *y, double *room)
{
    const bool promised = (p->def.flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) != 0;
    const iterate_scene scene = {.count = p->moving,
                                 .acceleration = accelerations,
                                 .data = p,
                                 .drag = p->drag,
                                 .room = room,
                                 .changes = p->def.force != NULL && !promised,
                                 .step = i};
    iterate_of(m)->scene(&scene, t, h, y, y + p->moving);
}

/* ----------------------------------------------------------------------------------------------------- rounding */

typedef struct roundings { /* quantities of the formula in scenes.h */
    double rate;           /* [1/s] z/h */
    double links;          /* L */
    double state;          /* D */
} roundings;

/* The fastest rate by Gershgorin's circles, or the omega of the case if it is larger because of a callback. */
static roundings count_roundings(const scene_case *c, const scene_problem *p)
{
    double *sum = numbers(p->def.particles), *links = numbers(p->def.particles), highest = 0;
    roundings r = {.state = p->def.drag > 0 ? 4 : 2};
    for (size_t i = 0; i < p->def.links; i++) {
        const spring_link *l = &p->link[i];
        sum[l->a] += 2 * l->stiffness;
        sum[l->b] += 2 * l->stiffness;
        links[l->a]++;
        links[l->b]++;
    }
    for (size_t i = 0; i < p->def.particles; i++) {
        r.links = fmax(r.links, links[i]);
        highest = fmax(highest, p->pinned[i] ? 0 : sum[i] / p->mass[i]);
    }
    r.rate = fmax(c->omega, sqrt(highest));
    free(sum);
    free(links);
    return r;
}

/* The rounding error of a step that ends in y. Call it right after the forces at y were evaluated, since it uses their
   sizes in p->room. */
static double added(const scene_case *c, const scene_problem *p, const roundings *r, double h, const double *y)
{
    const size_t axes = p->def.axes;
    double state = 0, speed = 0, force = 0;
    for (size_t i = 0; i < p->moving; i++) {
        const size_t at = p->coordinate[i];
        const double v = y[p->moving + i];
        const double F = axis_of(p, SIZE, at % axes)[at / axes] / p->mass[at / axes] + fabs(p->def.gravity[at % axes]) +
                         c->callback + p->drag[i] * fabs(v);
        state += y[i] * y[i] + v * v / (c->omega * c->omega);
        speed += v * v;
        force += F * F;
    }
    const double unit = DBL_EPSILON / 2, z = r->rate * h;
    return unit * pow(1 + z * z, 2) *
           (r->state * sqrt(state) + 4 * h * sqrt(speed) + (15 + r->links) * h * sqrt(force) / c->omega);
}

/* The growth of an error over many steps of a linear scene. In (x, v/rate), n steps of a mode have the norm of
   reference_turn_norm(), at most the norm of the fastest mode. In (x, v/omega) it is larger by the ratio of the rates,
   but for a slow mode at most by the growth of a free drift. */
typedef struct carrier {
    reference_turn turn; /* of the fastest mode in a step */
    bool turns;
} carrier;

static carrier carrier_of(const scene_case *c, spring_method m, double h)
{
    carrier r;
    r.turns = reference_turn_of(&r.turn, m, c->fastest, h);
    return r;
}

static double carried(const scene_case *c, const carrier *r, double h, uint64_t n)
{
    const double duration = (double)n * h, slow = fmin(c->omega / c->slowest, 1 + c->omega * duration);
    const double norm = r->turns ? reference_turn_norm(&r->turn, n) : NAN; /* NaN fails every check */
    return norm * fmax(1, fmax(slow, c->fastest / c->omega));
}

/* The matrix of a step in (x, v/omega) by one-sided differences, with a relative error of about 1e-7 h times a rate.
   Accelerations at the start are evaluated at (x, v); the values that leapfrog keeps differ by a truncation error. */
static void step_matrix(const scene_case *c, const scene_problem *p, spring_method m, double h, double t,
                        const double *y, double *matrix, double *work)
{
    const size_t size = 2 * p->moving;
    const double nudge = 1e-7 * c->length;
    double *base = work, *moved = work + size, *room = work + 2 * size;
    memcpy(base, y, size * sizeof *y);
    step(p, m, h, t, 0, base, room);
    for (size_t j = 0; j < size; j++) {
        memcpy(moved, y, size * sizeof *y);
        moved[j] += nudge * (j < p->moving ? 1 : c->omega);
        step(p, m, h, t, 0, moved, room);
        for (size_t k = 0; k < size; k++)
            matrix[k * size + j] = (moved[k] - base[k]) / nudge / (k < p->moving ? 1 : c->omega);
    }
}

/* An upper bound on the spectral norm: the Frobenius norm, or sqrt(largest column sum * largest row sum) if smaller. */
static double norm_bound(const double *matrix, size_t size, double *column)
{
    double squares = 0, largest_row = 0, largest_column = 0;
    memset(column, 0, size * sizeof *column);
    for (size_t i = 0; i < size; i++) {
        double row = 0;
        for (size_t j = 0; j < size; j++) {
            const double entry = fabs(matrix[i * size + j]);
            row += entry;
            column[j] += entry;
            squares += entry * entry;
        }
        largest_row = fmax(largest_row, row);
    }
    for (size_t j = 0; j < size; j++)
        largest_column = fmax(largest_column, column[j]);
    return fmin(sqrt(squares), sqrt(largest_row * largest_column));
}

static void multiply(double *restrict out, const double *restrict a, const double *restrict b, size_t size)
{
    memset(out, 0, size * size * sizeof *out);
    for (size_t i = 0; i < size; i++)
        for (size_t k = 0; k < size; k++) {
            const double factor = a[i * size + k];
            for (size_t j = 0; j < size; j++)
                out[i * size + j] += factor * b[k * size + j];
        }
}

/* Sums backwards over the states after each step, with the product of the matrices of all later steps. */
static double walked_back(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t n,
                          const double *states, const double *local)
{
    const size_t size = 2 * p->moving;
    double *later = numbers(size * size), *matrix = numbers(size * size), *product = numbers(size * size),
           *work = numbers(2 * size + iterate_room(p->moving)), sum = 0;
    for (size_t i = 0; i < size; i++)
        later[i * size + i] = 1;
    for (uint64_t i = n; i-- > 0;) {
        sum += local[i] * (i + 1 < n ? norm_bound(later, size, work) : 1);
        step_matrix(c, p, m, h, (double)i * h, states + i * size, matrix, work);
        multiply(product, later, matrix, size);
        double *const swapped = later;
        later = product;
        product = swapped;
    }
    free(later);
    free(matrix);
    free(product);
    free(work);
    return sum;
}

double scene_rounding(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t n, double *end)
{
    const size_t size = 2 * p->moving;
    const bool linear = c->fastest > 0;
    const roundings r = count_roundings(c, p);
    const carrier linearly = linear ? carrier_of(c, m, h) : (carrier){.turns = false};
    double *states = numbers(linear ? 0 : n * size), *local = numbers(n), *room = numbers(iterate_room(p->moving)),
           sum = 0;
    scene_start(p, end);
    for (uint64_t i = 0; i < n; i++) {
        if (!linear)
            memcpy(states + i * size, end, size * sizeof *end);
        step(p, m, h, (double)i * h, i, end, room);
        local[i] = added(c, p, &r, h, end);
        if (linear)
            sum += local[i] * carried(c, &linearly, h, n - 1 - i);
    }
    if (!linear)
        sum = walked_back(c, p, m, h, n, states, local);
    free(states);
    free(local);
    free(room);
    return sum;
}
