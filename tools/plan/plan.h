/* SPDX-License-Identifier: MIT */
/* The computations of spring-plan: the least number of steps with which the error of a method is within a tolerance,
   and the least stiffness with which the stretch of a hanging scene is within a limit. */
#ifndef SPRINGSTEP_PLAN_H
#define SPRINGSTEP_PLAN_H

#include "scenes/presets.h"

/* The error of a spring is the largest at any step, relative to the size of the initial state, for the worst initial
   state (spring_accurate_step()). The error of a scene is the largest at any frame of 1/60 s: the Euclidean distance of
   all positions from an extrapolated reference, relative to the largest distance of the reference from its start. */
typedef struct plan_row {
    spring_method method;
    double steps;       /* 0: no sufficient number is known */
    double dt;          /* [s] */
    double evaluations; /* force evaluations */
    double predicted;   /* error; spring: by spring_step_error(), scene: from twice the step; NaN: unknown */
    double measured;    /* error; NaN: takes too long */
    double uncertainty; /* of the measured error */
    double time;        /* [s] running time of the steps; INFINITY: no steps */
} plan_row;

/* A scene with its reference. */
typedef struct plan_scene plan_scene;

/** Refines the reference until its uncertainty is a twentieth of `error`, or until it would take more than `work`:
    force evaluations times particles and links. Exits with a message if the reference overflows. Keeps a pointer to the
    definition, which the caller releases later. */
plan_scene *plan_scene_new(const preset *scene, double duration, double error, double work);
void plan_scene_free(plan_scene *s);

/** If the scene does not support the method, the row has 0 steps and otherwise NaN. */
plan_row plan_scene_row(plan_scene *s, spring_method m, double error, double work, bool timed);

uint64_t plan_scene_frames(const plan_scene *s);

/** How often a step of leapfrog evaluates the damping of links alone, in addition to the forces: see "Leapfrog with
    heavy link damping" in scene.h. *reach: dt G. */
unsigned plan_damping_evaluations(const preset *scene, double dt, double *reach);

/** The largest fraction of the stable step that leapfrog may take in a scene of this kind, by the rules of scene.h.
    duration: [s] NaN: not known. *what: the kind; what may be NULL. */
double plan_fraction(const preset *scene, double duration, const char **what);

/* The precision of a scene. */
typedef enum plan_precision { PLAN_DOUBLE, PLAN_FLOAT, plan_precisions } plan_precision;

/** The running time [s] of `steps` steps from the start of a scene, without setup: the shortest of two to ten runs. In
    single precision, `m` is leapfrog. */
double plan_time(const preset *scene, plan_precision precision, spring_method m, double dt, uint64_t steps);

static const double plan_frame = 1.0 / 60; /* [s] */

/* The quantity whose stretch is limited: the whole scene, or its most stretched link. */
typedef enum plan_limit { PLAN_SCENE, PLAN_LINK, plan_limits } plan_limit;

/* The steps of a scene by leapfrog. */
typedef struct plan_steps {
    double stable_step; /* [s] */
    double substeps;    /* steps per frame: the fewest that plan_fraction() and `most` allow */
    double time;        /* [s] running time of a frame */
} plan_steps;

/* The stiffness of a scene, and its steps. */
typedef struct plan_sag {
    double stiffness;  /* [N/m] of every link; NaN: the height does not only depend on the stretch of links */
    double stretch[2]; /* by plan_limit: of the scene, and of its most stretched link, in double precision */
    double most;       /* fraction of the stable step: less if links become longer than twice their rest length */
    plan_steps steps[plan_precisions];
} plan_sag;

/** Finds the least stiffness with which a settled scene is stretched by at most `sag`, and the least stiffness with
    which every link is.

    The stretch of a link is length/rest - 1. The stretch of a scene is height/(height with unstretchable links) - 1. If
    the scene stands on its pins, both have the opposite sign. Links get the given damping. Exits with a message if the
    scene has no gravity, if a part of it is not linked to a pin, or if there is no such stiffness. */
void plan_stiffness(preset *scene, double sag, double damping, plan_sag row[plan_limits]);

#endif
