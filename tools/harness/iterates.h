/* SPDX-License-Identifier: MIT */
/*
 * Independent implementations of the methods, written as in textbooks. Steps of the library are compared with them.
 *
 * iterates.c has one entry per method. docs/internals.md says how to add a method.
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
    double *room;       /* [iterate_room(count)] work space; also keeps values for the next step */
    bool changes;       /* the acceleration function may change between steps, so its values are not reused */
    uint64_t step;      /* index of the step in a run; 0: nothing is kept yet */
} iterate_scene;

typedef struct iterate {
    /* One step of h. Temporaries have the precision of x. */
    void (*spring)(mpfr_t x, mpfr_t v, const iterate_rates *r, const mpfr_t h);

    /* One step from t to t + h. Pinned coordinates keep their velocity. The last evaluation of the acceleration is at
       the end of the step, or at the last stage. */
    void (*scene)(const iterate_scene *s, double t, double h, double *x, double *v);
    size_t vectors; /* vectors of `count` numbers that need room */
} iterate;

/* Exits with a message if the method has no steps, such as SPRING_EXACT, or a function of the two is missing. */
const iterate *iterate_of(spring_method m);

/* Size of `room`, enough for every method. */
size_t iterate_room(size_t count);

#endif
