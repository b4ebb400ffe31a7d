/* SPDX-License-Identifier: MIT */
/*
 * The table of corner cases for one spring. To add a case, add an entry to cases.c.
 */
#ifndef HARNESS_CASES_H
#define HARNESS_CASES_H

#include <stdbool.h>
#include <stddef.h>

#include <springstep/spring.h>

/* Parameters and step are constant within a segment. Most cases have one segment. Cases with a drive, jittered frame
   times or varying stiffness have one segment per step. */
typedef struct segment {
    spring_params p;
    double dt; /* [s] */
    uint64_t n;
} segment;

typedef struct validation_case validation_case;

struct validation_case {
    const char *name;
    const char *purpose; /* the fault that the case is designed to find */

    /* the spring, by undamped frequency and damping ratio; if omega is 0, there is no stiffness, and damping_ratio is
       damping/mass [1/s] */
    double mass, omega, damping_ratio; /* [kg], [1/s], [] */
    double rest;   /* [m] equilibrium position under the load; without stiffness: load/mass [m/s^2] */
    double x0, v0; /* [m], [m/s]; v0 in units of omega where omega > 0 */

    /* the step: a fixed length, or a fraction of the stable step of each method (0.01/omega if that is 0) */
    double dt;              /* [s] */
    double stable_fraction; /* [] */
    uint64_t n;

    bool stable_only; /* skip methods that are unstable at this step, or have no stable step */
    bool external;    /* compare with GSL and SUNDIALS as well */
    double tolerance; /* of their adaptive solvers, relative to the initial state; 0: the finest reliable one */
    bool slow;        /* takes more than a second: not part of quick runs */

    /* NULL: one segment of n steps. Otherwise there are n segments of one step each, and `vary` changes segment i. */
    void (*vary)(const validation_case *c, uint64_t i, segment *s);
    double drive;   /* [1/s] frequency of a continuous drive; 0: none */
    double sampled; /* the fraction of a step at which the drive is sampled: 0 or 0.5 */
};

extern const validation_case cases[];
extern const size_t case_count;

/* Returns true if the case is run with this method. */
bool case_takes(const validation_case *c, spring_method m);

/* The parameters and step of a case for one method. */
segment case_segment(const validation_case *c, spring_method m, spring_state *start);

/* The exact state under the continuous drive of a case after `duration`. Returns a bound on the error of sampling the
   drive once per step. */
double case_driven(const validation_case *c, double dt, double duration, spring_state *state);

#endif
