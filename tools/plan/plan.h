/* SPDX-License-Identifier: MIT */
/* What spring-plan finds out of one method: the fewest steps with which the error stays within a tolerance. */
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

#endif
