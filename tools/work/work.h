/* SPDX-License-Identifier: MIT */
/*
 * What spring-work compares: problems, which are opened one at a time, and solvers, which are run on the one that is
 * open.
 *
 * The state of a problem is a vector y, positions before velocities. Distances are Euclidean in (x, v/omega), and
 * errors are distances to the exact end relative to the size of the motion.
 */
#ifndef SPRINGSTEP_WORK_H
#define SPRINGSTEP_WORK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/scene.h>

#include "harness/ode.h"
#include "harness/reference.h"
#include "harness/scenes.h"
#include "work_equation.h"
#include "work_xpbd.h"

typedef enum work_kind {
    WORK_SPRING, /* one spring, for spring_advance() */
    WORK_STUDY,  /* that of the original study; no external solvers run on it */
    WORK_SCENE   /* for spring_scene_advance() */
} work_kind;

typedef void work_derivative(double t, const double *y, double *dy, const void *data); /* as in ode.h */

typedef struct work_problem {
    const char *name;
    work_kind kind;
    double duration; /* [s] */
    double longest;  /* [s] a sweep ends with the first run that takes longer */

    /* a spring */
    spring_params p;
    spring_state start;
    double finest;    /* [s] step of a sweep */
    uint64_t periods; /* more than 0: look for the crossing of leapfrog and RK4 */

    /* a scene: a case of the harness, or one of its own */
    const char *harness;
    const scene_case *own;
    work_derivative *derivative; /* of few particles: written out for them */
    uint64_t reference_steps;
} work_problem;

extern const work_problem work_problems[];
extern const size_t work_problem_count;

typedef struct work_constants {        /* of equations that are written out */
    double omega2, gamma, accel, rest; /* as in batch.h; [m] */
} work_constants;

/* A problem that is open. */
typedef struct work {
    const work_problem *problem;
    size_t size; /* numbers in y */
    double *start, *exact;
    double *scale; /* [size] magnitudes, for the tolerances of external solvers */
    double duration, omega;
    double motion;           /* [m] amplitude, or half the largest distance of a scene from its start */
    double uncertainty;      /* of the exact end, relative to motion */
    double coarsest, finest; /* [s] steps of a sweep */
    double (*clock)(void);   /* [ns] by which runs are timed */

    /* what external solvers integrate */
    work_derivative *derivative;
    const void *data;
    work_constants constants;
    bool damped;        /* a link is */
    bool uses_velocity; /* the forces depend on velocities */

    reference reference; /* of a spring */

    /* of a scene: as the library moves it, as it was at the start, and with calls counted */
    scene_problem scene;
    work_equation equation;
    spring_scene *moved, *fresh, *counting;
    spring_scene_def counted; /* the definition of the last */
    size_t bytes, counting_bytes;
    uint64_t calls; /* of its callback */
    double *gathered;
    work_xpbd *xpbd; /* NULL: not for this scene */
} work;

void work_open(work *w, const work_problem *problem); /* exits with CLI_FAILED where it cannot be done */
void work_close(work *w);

/* As it is at the start, in memory of its own; exits where it cannot be done. */
spring_scene *work_make_scene(const spring_scene_def *def, size_t *bytes);

/* Relative to the motion; never below what the exact end is known to. */
double work_error(const work *w, const double *y);

/* |energy - exact energy|, of a spring relative to the energy at the start, of a scene to its kinetic energy at the exact
   end; NaN if a callback adds forces. */
double work_energy_error(const work *w, const double *y);

/* The largest length of a link relative to its rest length, less 1; NaN on one axis. */
double work_stretch(const work *w, const double *y);

typedef struct work_effort { /* what is varied: one of them */
    uint64_t steps;
    double tolerance;
} work_effort;

typedef enum work_side {
    WORK_STEPPER, /* of the library */
    WORK_EXACT,   /* the exact solution: no stepper */
    WORK_STAGES,  /* the original study's arithmetic, on its problem */
    WORK_EXTERNAL,
    WORK_SOFTENED, /* leapfrog, with links that are softened until the step is stable: another scene */
    WORK_XPBD      /* no solver of differential equations, but what game engines do */
} work_side;

typedef struct work_result {
    const char *failure;  /* NULL: none */
    double spent;         /* [s] in all runs, without setting up */
    uint64_t steps;       /* of one run */
    uint64_t evaluations; /* of one run; of the library's scenes see work_count() */
} work_result;

typedef struct work_solver work_solver;

struct work_solver {
    const char *name;
    work_side side;
    spring_method method; /* of a stepper and the exact solution */
    uint64_t a_step;      /* force evaluations that a step of one spring stands for: there is nothing to count */
    /* of an external solver, one of them */
    const char *(*fixed)(ode *o, double *y, double h, uint64_t n);
    const char *(*adaptive)(ode *o, double *y, double duration, double tolerance);
    int order;           /* with fixed steps */
    bool positions_only; /* forces may not depend on velocities */
};

extern const size_t work_solver_count;

/* Each method by its name, rk4-stages, leapfrog-softened, xpbd, and the external solvers: those of odeint where it was found. */
const work_solver *work_solver_at(size_t i);

/* The solver that is a method. */
const work_solver *work_solver_of(spring_method m);

bool work_applies(const work *w, const work_solver *s);

/* Run a solver from the start, so many times; y is the end. */
work_result work_run(work *w, const work_solver *s, work_effort e, uint64_t runs, double *y);

/* Force evaluations of so many steps of a scene, counted by a callback in a scene that is otherwise the same. */
uint64_t work_count(work *w, spring_method m, uint64_t steps);

#endif
