/* SPDX-License-Identifier: MIT */
/*
 * The problems and solvers of spring-work. One problem is open at a time, and solvers run on it.
 *
 * The state of a problem is a vector y, positions before velocities. Distances are Euclidean in (x, v/omega). Errors
 * are distances from the exact final state, relative to the size of the motion.
 */
#ifndef SPRINGSTEP_WORK_H
#define SPRINGSTEP_WORK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/scene.h>

#include "common/cli.h"
#include "harness/ode.h"
#include "harness/reference.h"
#include "harness/scenes.h"
#include "work_equation.h"
#include "work_implicit.h"
#include "work_xpbd.h"

typedef enum work_kind {
    WORK_SPRING, /* one spring, for spring_advance() */
    WORK_STUDY,  /* the spring of the original study; not for external solvers */
    WORK_SCENE   /* for spring_scene_advance() */
} work_kind;

typedef void work_derivative(double t, const double *y, double *dy, const void *data); /* as in ode.h */

typedef struct work_problem {
    const char *name;
    work_kind kind;
    double duration; /* [s] */
    double longest;  /* [s] a sweep ends after the first run that takes longer */

    /* a spring */
    spring_params p;
    spring_state start;
    double finest;    /* [s] step of a sweep */
    uint64_t periods; /* > 0: find the crossing of leapfrog and RK4 */

    /* a scene: a case of the harness, or its own case */
    const char *harness;
    const scene_case *own;
    work_derivative *derivative; /* written out, for few particles */
    uint64_t reference_steps;
} work_problem;

extern const work_problem work_problems[];
extern const size_t work_problem_count;

typedef struct work_constants {        /* of written-out equations */
    double omega2, gamma, accel, rest; /* as in batch.h; [m] */
} work_constants;

/* An open problem. */
typedef struct work {
    const work_problem *problem;
    size_t size; /* numbers in y */
    double *start, *exact;
    double *scale; /* [size] magnitudes, for the tolerances of external solvers */
    double duration, omega;
    double motion;           /* [m] amplitude, or half the largest distance of a scene from its start */
    double uncertainty;      /* of `exact`, relative to motion */
    double coarsest, finest; /* [s] steps of a sweep */
    double (*clock)(void);   /* [ns] clock for runs */

    /* for external solvers */
    work_derivative *derivative;
    const void *data;
    work_constants constants;
    bool damped;        /* a link is damped */
    bool uses_velocity; /* forces depend on velocities */

    reference reference; /* of a spring */

    /* of a scene: the scene that runs, a copy at the start, and one that counts callbacks */
    scene_problem scene;
    work_equation equation;
    spring_scene *moved, *fresh, *counting;
    spring_scene_def counted; /* the definition of `counting` */
    size_t bytes, counting_bytes;
    uint64_t calls; /* number of callbacks in `counting` */
    double *gathered;
    work_xpbd *xpbd;         /* NULL: not applicable */
    work_implicit *implicit; /* likewise */
} work;

void work_open(work *w, const work_problem *problem); /* exits with CLI_FAILED on failure */
void work_close(work *w);

/* The error relative to the motion, at least the uncertainty of `exact`. */
double work_error(const work *w, const double *y);

/* |energy - exact energy|, relative to the initial energy of a spring, or to the kinetic energy of a scene in its exact
   final state; NaN if a callback adds forces. */
double work_energy_error(const work *w, const double *y);

/* The energy of a scene [J]. */
double work_energy(const work *w, const double *y);

/* The distance of two states of a scene in (x, v/omega) [m]. */
double work_distance(const work *w, const double *a, const double *b);

/* The stretches of all links of a scene in space, length/rest - 1. */
void work_stretches(const work *w, const double *y, double *stretch);

/* The largest stretch of a link, length/rest - 1; NaN on one axis. */
double work_stretch(const work *w, const double *y);

typedef struct work_effort { /* one of these is set */
    uint64_t steps;
    double tolerance;
} work_effort;

typedef enum work_side {
    WORK_STEPPER, /* of the library */
    WORK_EXACT,   /* the exact solution */
    WORK_STAGES,  /* RK4 in the arithmetic of the original study, on its problem */
    WORK_EXTERNAL,
    WORK_SOFTENED, /* leapfrog with links softened until the step is stable, which changes the scene */
    WORK_XPBD,     /* the method of game engines, not a solver of differential equations */
    WORK_IMPLICIT  /* implicit methods of cloth simulation */
} work_side;

typedef struct work_result {
    const char *failure;  /* NULL: none */
    double spent;         /* [s] of all runs, without setup */
    uint64_t steps;       /* of one run */
    uint64_t evaluations; /* of one run; for scenes of the library see work_count() */
} work_result;

typedef struct work_solver work_solver;

struct work_solver {
    const char *name;
    work_side side;
    spring_method method; /* for WORK_STEPPER and WORK_EXACT */
    uint64_t a_step;      /* force evaluations per step of one spring, where they cannot be counted */
    /* for an external solver, one of these */
    const char *(*fixed)(ode *o, double *y, double h, uint64_t n);
    const char *(*adaptive)(ode *o, double *y, double duration, double tolerance);
    uint64_t (*implicit)(work_implicit *s, uint64_t n); /* for WORK_IMPLICIT */
    int order;                                          /* with fixed steps */
    bool positions_only;                                /* forces may not depend on velocities */
};

extern const size_t work_solver_count;

/* All solvers: methods by name, rk4-stages, leapfrog-softened, xpbd, bdf2-cg, projective, and external solvers (odeint only if found). */
const work_solver *work_solver_at(size_t i);

/* The solver of a method. */
const work_solver *work_solver_of(spring_method m);

bool work_applies(const work *w, const work_solver *s);

/* Runs a solver `runs` times from the start; y is the final state. */
work_result work_run(work *w, const work_solver *s, work_effort e, uint64_t runs, double *y);

/* The state of a scene. */
void work_get(const work *w, const spring_scene *scene, double *y);

/* Writes the rows of long runs of a scene in space; see work_long.c. */
void work_long(cli_table *table, work *w, bool quick);

/* Force evaluations of `steps` steps of a scene, counted by a callback in a copy of it. */
uint64_t work_count(work *w, spring_method m, uint64_t steps);

#endif
