/* SPDX-License-Identifier: MIT */
/*
 * The catalogue of corner cases of scenes, and the equation of a scene written down a second time, for reference:
 * forces link by link, the steps of iterates.h, and what rounding can do to them.
 *
 * A scene is a vector y here: the positions of all coordinates that are not pinned, then their velocities. Distances
 * are Euclidean in (x, v/omega), omega a rate that the case names.
 */
#ifndef HARNESS_SCENES_H
#define HARNESS_SCENES_H

#include <stdbool.h>
#include <stddef.h>

#include <springstep/scene.h>

/* A definition with its arrays. Particles that are pinned do not move. */
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
    size_t count;        /* of what there can be any number of */
    double duration;     /* [s] */
    uint64_t steps[4];   /* of methods of order 1, 2, 4, and 8 or more: see scene_case_steps() */
    double omega;        /* [1/s] */
    double length;       /* [m] of the motion: tolerances are relative to it */
    double callback;     /* [m/s^2] largest sum of the sizes of all terms in the callback, over mass */
    size_t known;        /* leading components of y at the end that are known, to all digits of a double */
    double digits[4];    /* they */
    const char *formula; /* name of an exact expression for ... */
    void (*iterate)(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t n,
                    double *y);                                               /* ... the method's steps */
    void (*solution)(const scene_case *c, const scene_problem *p, double *y); /* ... the exact end */
    double slowest, fastest; /* [1/s] of a linear scene: rates of its modes; fastest 0: not linear */
    bool external;           /* compare with GSL and SUNDIALS */
    bool slow;               /* more than a tenth of a second: not in the quick catalogue */
};

extern const scene_case scene_cases[];
extern const size_t scene_case_count;

/* The largest step of a method is duration/steps. 0: not with this method. */
uint64_t scene_case_steps(const scene_case *c, spring_method m);

void *scene_room(size_t count, size_t size); /* zeros; exits without memory */

/* At the origin, at rest, not pinned, links of zeros; all have one mass [kg]. Exits without memory. */
void scene_problem_make(scene_problem *p, uint32_t axes, size_t particles, size_t links, double mass);
/* A grid at rest, with room for more links behind those of the grid, whose number is returned. Exits if there is none. */
size_t scene_problem_grid(scene_problem *p, const spring_grid *g, size_t more_links, double mass);
void scene_problem_init(scene_problem *p, const scene_case *c); /* exits without memory */
void scene_problem_clear(scene_problem *p);

void scene_start(const scene_problem *p, double *y);

/* dy/dt, for the solvers of ode.h; data is a scene_problem. */
void scene_derivative(double t, const double *y, double *dy, const void *data);

/* n steps of a method by iterates.h, from the start, in doubles. Returns what rounding can have done to the end
 * [m], the distance to the same steps in exact arithmetic, whoever takes them in doubles.
 *
 * A step adds at most, with u = 2^-53, F the sum of the sizes of all terms of the acceleration, L the most links of a
 * particle and z the fastest rate times h,
 *
 *     u (1 + z^2)^2 (D |y| + 4 h |v| + (15 + L) h |F|/omega),   D = 2, with drag 4
 *
 * (x is rounded once and v twice with leapfrog, where drag divides v by what is itself rounded; h v once, after v; a
 * link at most eight times, mass and gravity once each, their sum L times, RK4's sum of stages five times; within a
 * step that is carried on by at most 1 + z^2 twice). The steps that follow carry it on by at most the norm of the
 * product of their matrices, which are formed by differences. Of a linear scene that norm is known: see carrier_of() in
 * scenes.c. */
double scene_rounding(const scene_case *c, const scene_problem *p, spring_method m, double h, uint64_t n, double *end);

/* |a - b| over the leading `known` components of y; 0: over all */
double scene_distance(const scene_case *c, const scene_problem *p, const double *a, const double *b, size_t known);

#endif
