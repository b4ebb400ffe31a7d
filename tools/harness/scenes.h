/* SPDX-License-Identifier: MIT */
/*
 * The table of corner cases of scenes, and an independent implementation of the equation of a scene: forces link by
 * link, the steps of iterates.h, and bounds on their rounding errors.
 *
 * The state of a scene is a vector y: the positions of all coordinates that are not pinned, then their velocities.
 * Distances are Euclidean in (x, v/omega), where omega is a rate given by the case.
 */
#ifndef HARNESS_SCENES_H
#define HARNESS_SCENES_H

#include <stdbool.h>
#include <stddef.h>

#include <springstep/scene.h>

/* A definition with its arrays. Pinned particles do not move. */
typedef struct scene_problem {
    spring_scene_def def;
    double *position, *velocity, *mass;
    uint8_t *pinned;
    spring_link *link;
    size_t moving;      /* coordinates that are not pinned; y has twice as many numbers */
    size_t *coordinate; /* [moving] particle*axes + axis */
    double *drag;       /* [moving] drag/mass [1/s] */
    double *room;       /* position, velocity, force and its size, [axes*particles] each, axis by axis */
} scene_problem;

typedef struct scene_case scene_case;

struct scene_case {
    const char *name;
    const char *purpose; /* the fault that the case is designed to find */
    void (*build)(const scene_case *c, scene_problem *p);
    size_t count;                 /* parameter of `build`: number of particles, axes or masses */
    double x, v;                  /* [m], [m/s] start of the only coordinate, which ... */
    bool spring;                  /* ... has a spring with omega = 1/s, ... */
    spring_scene_force_fn *force; /* ... and this force; NULL: `build` makes another scene */
    double duration;              /* [s] */
    uint64_t steps[4];            /* for methods of order 1, 2, 4, and 8 or more; see scene_case_steps() */
    double omega;                 /* [1/s] */
    double length;                /* [m] scale of the motion; tolerances are relative to it */
    double callback;              /* [m/s^2] largest sum of the sizes of all terms in the callback, over mass */
    size_t known;                 /* number of leading components of the final y that are known to double precision */
    double digits[4];             /* their values */
    const char *formula;          /* name of an exact expression for ... */
    void (*iterate)(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t n,
                    double *y);                                               /* ... the method's steps */
    void (*solution)(const scene_case *c, const scene_problem *p, double *y); /* ... the exact end */
    double slowest, fastest; /* [1/s] rates of the modes of a linear scene; fastest 0: not linear */
    bool external;           /* compare with GSL and SUNDIALS */
    bool slow;               /* takes more than a tenth of a second: not part of quick runs */
};

extern const scene_case scene_cases[];
extern const size_t scene_case_count;

/* The number of steps for a method at its largest step, duration/steps; 0: skip this method. */
uint64_t scene_case_steps(const scene_case *c, spring_method m);

void *scene_room(size_t count, size_t size); /* zeroed; exits if out of memory */

/* All particles are at rest at the origin, not pinned, and have the same mass [kg]; links are zeroed. Exits if out of
   memory. */
void scene_problem_make(scene_problem *p, uint32_t axes, size_t particles, size_t links, double mass);
/* A grid at rest, with room for `more_links` after its own links. Returns the number of its own links. Exits if out of
   memory. */
size_t scene_problem_grid(scene_problem *p, const spring_grid *g, size_t more_links, double mass);
void scene_problem_init(scene_problem *p, const scene_case *c); /* exits if out of memory */
void scene_problem_clear(scene_problem *p);

void scene_start(const scene_problem *p, double *y);

/* dy/dt for the solvers of ode.h; `data` is a scene_problem. */
void scene_derivative(double t, const double *y, double *dy, const void *data);

/* Takes n steps of a method by iterates.h from the start, in doubles. Returns a bound on the rounding error of the
 * final state [m], its distance to the same steps in exact arithmetic, for every implementation in doubles.
 *
 * A step adds at most, with u = 2^-53, F the sum of the sizes of all terms of the acceleration, L the most links of a
 * particle and z the fastest rate times h,
 *
 *     u (1 + z^2)^2 (D |y| + 4 h |v| + (15 + L) h |F|/omega),   D = 2, with drag 4
 *
 * Leapfrog rounds x once and v twice, and drag divides v by a rounded number; h v is rounded once, after v; a link at
 * most eight times, mass and gravity once each, their sum L times, RK4's sum of stages five times. Within a step, these
 * errors grow by at most (1 + z^2)^2. The following steps amplify them by at most the norm of the product of their
 * matrices, which are formed by differences. For a linear scene this norm is known; see carrier_of() in scenes.c. */
double scene_rounding(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t n, double *end);

/* |a - b| over the leading `known` components of y, or over all if `known` is 0 */
double scene_distance(const scene_case *c, const scene_problem *p, const double *a, const double *b, size_t known);

#endif
