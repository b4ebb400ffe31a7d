/* SPDX-License-Identifier: MIT */
/*
 * The catalogue of corner cases for one spring. A case is data: to add one is to add one entry to cases.c.
 */
#ifndef HARNESS_CASES_H
#define HARNESS_CASES_H

#include <stdbool.h>
#include <stddef.h>

#include <springstep/spring.h>

/* Over one segment nothing changes but the state. Most cases are one segment; a drive, a jittered clock or a pumped
   spring is one segment a step. */
typedef struct segment {
    spring_params p;
    double dt; /* [s] */
    uint64_t n;
} segment;

typedef struct validation_case validation_case;

struct validation_case {
    const char *name;
    const char *purpose; /* the fault that the case is designed to find */

    /* the spring, by undamped frequency and damping ratio; omega 0: no stiffness, damping_ratio is damping/mass
       [1/s] */
    double mass, omega, damping_ratio; /* [kg], [1/s], [] */
    double rest;                       /* [m] where the load would hold it; without stiffness: load/mass [m/s^2] */
    double x0, v0;                     /* [m], [m/s]; v0 in units of omega where omega > 0 */

    /* the step: of fixed length, or a fraction of each method's own stable step (0.01/omega where that is 0) */
    double dt;              /* [s] */
    double stable_fraction; /* [] */
    uint64_t n;

    bool stable_only; /* not with methods that are not stable at this step; of a fraction: that have no stable step */
    bool external;    /* compare with GSL and SUNDIALS as well */
    double tolerance; /* of their adaptive solvers, relative to the start; 0: the finest to be trusted */
    bool slow;        /* more than a second: not in the quick catalogue */

    /* What changes from segment to segment; NULL: one segment of n steps. There are n segments otherwise, of one step
       each, and exact (if there is one) is the state that the continuous drive leads to after duration, with a bound on
       what sampling the drive once a step costs. */
    void (*vary)(uint64_t i, segment *s);
    double (*exact)(const validation_case *c, double dt, double duration, spring_state *state);
};

extern const validation_case cases[];
extern const size_t case_count;

/* Is a case tried with this method? */
bool case_takes(const validation_case *c, spring_method m);

/* The parameters and step of a case for one method. */
segment case_segment(const validation_case *c, spring_method m, spring_state *start);

#endif
