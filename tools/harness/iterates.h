/* SPDX-License-Identifier: MIT */
/*
 * The methods a second time, as textbooks write them and not as the library does: what its steps are compared with.
 *
 * One entry a method in iterates.c. Whoever needs the step of a method looks it up here, and finds no other place that
 * would have to know of a new one.
 */
#ifndef HARNESS_ITERATES_H
#define HARNESS_ITERATES_H

#include <stddef.h>

#include <mpfr.h>

#include <stdbool.h>

#include <springstep/spring.h>

/* One spring, in multiple precision: x'' = a - w x - g v. */
typedef struct iterate_rates {
    mpfr_t w, g, a; /* [1/s^2], [1/s], [m/s^2] */
} iterate_rates;

/* A scene in doubles: `count` coordinates with x'' = acceleration(t, x, v) - drag v. */
typedef struct iterate_scene {
    size_t count;
    void (*acceleration)(const void *data, double t, const double *x, const double *v, double *a); /* 0 where pinned */
    const void *data;
    const double *drag; /* [count] drag/mass [1/s], 0 where pinned */
    double *room;       /* [iterate_room(count)] for what a step has to keep, also for the next one */
    bool changes;       /* acceleration may be another one before each step: nothing that it gave is used again */
    uint64_t step;      /* number of the step in a run of steps; 0: nothing is kept yet */
} iterate_scene;

typedef struct iterate {
    /* One step of h. Temporaries have the precision of x. */
    void (*spring)(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h);

    /* One step from t to t + h. What is pinned moves on with its velocity. The acceleration that is evaluated last is
       at the end of the step, or at the last stage. */
    void (*scene)(const iterate_scene *s, double t, double h, double *x, double *v);
    size_t vectors; /* [count] each, of room */
} iterate;

/* Exits with a message where a method takes no steps, as the exact solution. */
const iterate *iterate_of(spring_method m);

/* Numbers of room that a step takes, whatever the method. */
size_t iterate_room(size_t count);

#endif
