/* SPDX-License-Identifier: MIT */
/* What spring-plan computes: the fewest steps with which the error of a method stays within a tolerance, and the stiffness with
   which a scene hangs by at most a given stretch. */
#ifndef SPRINGSTEP_PLAN_H
#define SPRINGSTEP_PLAN_H

#include "scenes/presets.h"

/* Errors are the largest at any step of a spring, relative to the size of the start, for the worst start
   (spring_accurate_step()); of a scene at any frame of 1/60 s: the Euclidean distance of all positions from those of an
   extrapolated reference, relative to the largest distance of those from the start. */
typedef struct plan_row {
    spring_method method;
    double steps;       /* 0: none are known to be enough */
    double dt;          /* [s] */
    double evaluations; /* of forces */
    double predicted;   /* error: of a spring by spring_step_error(), of a scene by twice the step; NaN: unknown */
    double measured;    /* error; NaN: takes too long */
    double uncertainty; /* of the measured error */
    double time;        /* [s] that the steps take; INFINITY: no steps */
} plan_row;

plan_row plan_spring(const spring_params *p, spring_method m, double duration, double error);

/* A scene with its reference. */
typedef struct plan_scene plan_scene;

/** Runs the reference until its uncertainty is a twentieth of the error, or it would take more work than that: force
    evaluations times particles and links. Exits with a message where that overflows. The definition stays the caller's,
    for as long as this lives. */
plan_scene *plan_scene_new(const preset *scene, double duration, double error, double work);
void plan_scene_free(plan_scene *s);

/** A method that the scene does not support has no steps, and NaN for the rest. */
plan_row plan_scene_row(plan_scene *s, spring_method m, double error, double work, bool timed);

uint64_t plan_scene_frames(const plan_scene *s);

/** [s] The time of that many steps from the start of a scene, without setup: the shortest of two to ten runs. */
double plan_time(const preset *scene, spring_method m, double dt, uint64_t steps);

static const double plan_frame = 1.0 / 60; /* [s] */

/* What is at most as long as asked for. */
typedef enum plan_limit { PLAN_SCENE, PLAN_LINK, plan_limits } plan_limit;

/* A scene that is stiff enough, and its steps by leapfrog. */
typedef struct plan_sag {
    double stiffness;   /* [N/m] of every link; NaN: the height of the scene depends on more than how links stretch */
    double stretch[2];  /* by limit: of the scene and of the link that is stretched most */
    double stable_step; /* [s] */
    double substeps;    /* steps in a frame, at most half of the stable step each */
    double time;        /* [s] of a frame */
} plan_sag;

/** Finds the least stiffness with which a settled scene is stretched by at most `sag`, and another one for its links.

    The stretch of a link is length/rest - 1, that of a scene is height/(height with unstretchable links) - 1. In a scene that
    stands on its pins both count with the opposite sign. Links get the given damping. Exits with a message if the scene has
    no gravity, if a part of it is not linked to a pin, or if there is no such stiffness. */
void plan_stiffness(preset *scene, double sag, double damping, plan_sag row[plan_limits]);

#endif
