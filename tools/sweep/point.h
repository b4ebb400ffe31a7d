/* SPDX-License-Identifier: MIT */
/*
 * One point of a sweep: one spring or one preset scene with chosen parameters, by one method.
 *
 * Results depend only on the library, the harness and the four basic operations. So they are bit-identical on every
 * processor, in the command-line tool and in the Python package. Nothing here prints or ends the program.
 */
#ifndef SPRINGSTEP_SWEEP_POINT_H
#define SPRINGSTEP_SWEEP_POINT_H

#include <stdbool.h>
#include <stdint.h>

#include <springstep/spring.h>

/* The subject of a point: one spring, or a preset of scenes/presets.h, as its number plus 1. */
enum { SWEEP_SPRING };

/** The name of a subject, "spring" or the name of the preset; NULL: there are no more. */
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
    const char *name;   /* for selection: "stiffness" */
    const char *column; /* with unit: "stiffness_N_per_m" */
    const char *help;
    double least, most; /* accepted range */
    bool whole;         /* a whole number */
    uint32_t scenes;    /* bit i: scene i has it */
    int instead;        /* the parameter that it replaces, or SWEEP_PARAMETERS */
} sweep_parameter_info;

extern const sweep_parameter_info sweep_parameters[SWEEP_PARAMETERS];

bool sweep_has(int scene, sweep_parameter p);

/* -------------------------------------------------------------------------------------------------------- measures */

typedef enum sweep_measure {
    SWEEP_ERROR,
    SWEEP_ENERGY_ERROR,
    SWEEP_STEPS, /* from here on only on request */
    SWEEP_FORCE_EVALUATIONS,
    SWEEP_DT,
    SWEEP_STABLE_STEP,
    SWEEP_EXPLODE_TIME,
    SWEEP_SETTLING_TIME,
    SWEEP_MEASURES
} sweep_measure;

extern const char *const sweep_measure_names[SWEEP_MEASURES + 1];

typedef enum sweep_status {
    SWEEP_STABLE,   /* spring: below the stable step. Scene: kinetic energy always below ten times the reference */
    SWEEP_GROWING,  /* spring: at or above the stable step, but not exploded within the duration */
    SWEEP_EXPLODED, /* spring: at or above the stable step, with a hundredfold energy. Scene: not stable, or not finite.
                       Measurements end at that time */
    SWEEP_UNSUPPORTED, /* the method does not support this subject */
    SWEEP_NO_STEP,     /* no step is accurate enough, or the stable step is 0 */
    SWEEP_TOO_LONG,    /* too many steps, or too much memory for a reference */
    SWEEP_INVALID,     /* invalid parameters, or nothing moves */
    SWEEP_FAILED       /* out of memory */
} sweep_status;

extern const char *const sweep_status_names[];

typedef struct sweep_result {
    double number[SWEEP_MEASURES]; /* NaN: not known */
    int status;                    /* a sweep_status */
} sweep_result;

/** Memory shared by the points of a sweep: the last reference. NULL: out of memory. */
typedef struct sweep_memory sweep_memory;
sweep_memory *sweep_memory_new(void);
void sweep_memory_free(sweep_memory *memory);

/**
 * Measures a point. The result depends on scene, value and method only.
 *
 * One spring has mass 1 kg and stiffness 1 N/m, so omega is 1/s. It is run from (x, v) = (1, 0) and from (0, 1), and
 * measured after each of the first 256 steps, then at intervals of a 128th of the elapsed time:
 *
 *     error         the largest norm of the matrix (run - exact) of both runs, the error from the worst initial state
 *     energy_error  the largest difference of the energy from the exact solution, relative to the initial energy
 *
 * With a tolerance, the step is spring_accurate_step(), there is no run, and the error is spring_step_error().
 *
 * A scene is run as it is (water with a poke) and measured after each frame. The reference is RK4 with at most a
 * sixteenth of the stable steps of RK4 and of leapfrog:
 *
 *     error         the largest Euclidean distance of all positions from the reference, relative to the largest
 *                   distance of the reference from its start
 *     energy_error  the largest difference of the energy from the reference, relative to the largest kinetic energy of
 *                   the reference; infinite if the state overflows
 *
 * @param[in] value  [SWEEP_PARAMETERS] NaN: not chosen
 */
void sweep_measure_point(sweep_memory *memory, int scene, const double *value, spring_method m, sweep_result *result);

#endif
