/* SPDX-License-Identifier: MIT */
/*
 * One point of a sweep: one spring or one preset scene, with some of its parameters chosen, by one method.
 *
 * What is measured comes from the library, the harness and the four operations alone, so it has the same bits on every
 * processor, in the command-line tool and in the package for Python. Nothing here prints or ends the program.
 */
#ifndef SPRINGSTEP_SWEEP_POINT_H
#define SPRINGSTEP_SWEEP_POINT_H

#include <stdbool.h>
#include <stdint.h>

#include <springstep/spring.h>

/* Of what a point is: one spring, or a preset of scenes/presets.h, its number plus 1. */
enum { SWEEP_SPRING };

/** The word for it, "spring" or that of the preset; NULL: there are no more. */
const char *sweep_scene_name(int scene);

/* ------------------------------------------------------------------------------------------------------ parameters */

typedef enum sweep_parameter {
    SWEEP_OMEGA_DT,
    SWEEP_DAMPING_RATIO,
    SWEEP_PERIODS,
    SWEEP_TOLERANCE,
    SWEEP_STEPS_PER_FRAME,
    SWEEP_STABLE_FRACTION,
    SWEEP_DURATION,
    SWEEP_SIZE,
    SWEEP_LENGTH,
    SWEEP_MASS,
    SWEEP_MASS_RATIO,
    SWEEP_STIFFNESS,
    SWEEP_DAMPING,
    SWEEP_DRAG,
    SWEEP_GRAVITY,
    SWEEP_STRETCH,
    SWEEP_ANGLE,
    SWEEP_PARAMETERS
} sweep_parameter;

typedef struct sweep_parameter_info {
    const char *name;   /* as it is chosen: "stiffness" */
    const char *column; /* with its unit: "stiffness_N_per_m" */
    const char *help;
    double least, most; /* that are accepted */
    bool whole;         /* a whole number */
    uint32_t scenes;    /* bit i: scene i has it */
    int instead;        /* the parameter that it takes the place of, or SWEEP_PARAMETERS */
} sweep_parameter_info;

extern const sweep_parameter_info sweep_parameters[SWEEP_PARAMETERS];

bool sweep_has(int scene, sweep_parameter p);

/* -------------------------------------------------------------------------------------------------------- measures */

typedef enum sweep_measure {
    SWEEP_ERROR,
    SWEEP_ENERGY_ERROR,
    SWEEP_STEPS, /* from here on, those that have to be asked for */
    SWEEP_FORCE_EVALUATIONS,
    SWEEP_DT,
    SWEEP_STABLE_STEP,
    SWEEP_EXPLODE_TIME,
    SWEEP_SETTLING_TIME,
    SWEEP_MEASURES
} sweep_measure;

extern const char *const sweep_measure_names[SWEEP_MEASURES + 1];

typedef enum sweep_status {
    SWEEP_STABLE,  /* a spring: below the stable step. A scene: it never has ten times the kinetic energy it should */
    SWEEP_GROWING, /* a spring: at the stable step or beyond, and not exploded in this time */
    SWEEP_EXPLODED, /* a spring: as that, and has a hundredfold energy. A scene: not stable, or no finite numbers; what is
                       measured is of the time until then */
    SWEEP_UNSUPPORTED, /* the method is not for this */
    SWEEP_NO_STEP,     /* no step is accurate enough; the stable step is 0 */
    SWEEP_TOO_LONG,    /* more steps than a point may take, or more to remember than it may keep */
    SWEEP_INVALID,     /* numbers that the library refuses, or nothing moves */
    SWEEP_FAILED       /* no memory */
} sweep_status;

extern const char *const sweep_status_names[];

typedef struct sweep_result {
    double number[SWEEP_MEASURES]; /* NaN: not known */
    int status;                    /* a sweep_status */
} sweep_result;

/** What points of one sweep share: the reference that the last one needed. NULL: no memory. */
typedef struct sweep_memory sweep_memory;
sweep_memory *sweep_memory_new(void);
void sweep_memory_free(sweep_memory *memory);

/**
 * Measure a point. The result depends on scene, value and method alone.
 *
 * One spring has mass 1 kg and stiffness 1 N/m, so omega is 1/s. It is run from (x, v) = (1, 0) and from (0, 1), and
 * looked at after each of the first 256 steps, and then whenever a 128th of the time so far has passed:
 *
 *     error         the largest norm of the matrix (run - exact) of both, which is the error from the worst start
 *     energy_error  the difference of the energy from that of the exact solution, over that of the start: the largest
 *
 * With a tolerance the step is spring_accurate_step(), there is no run, and the error is spring_step_error().
 *
 * A scene is run as it is, water with a poke, and compared with RK4 in steps of at most a sixteenth of its stable step and of
 * leapfrog's, and looked at after each frame:
 *
 *     error         the largest distance of all positions, root of the sum of squares, over the largest distance of the
 *                   reference from its start
 *     energy_error  the difference of the energy from that of the reference, over the largest kinetic energy of the
 *                   reference: the largest; infinite where the state overflows
 *
 * @param[in] value  [SWEEP_PARAMETERS] NaN: not chosen
 */
void sweep_measure_point(sweep_memory *memory, int scene, const double *value, spring_method m, sweep_result *result);

#endif
