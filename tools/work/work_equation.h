/* SPDX-License-Identifier: MIT */
/*
 * The right-hand side that GSL and SUNDIALS integrate for a scene: a plain loop over the links.
 *
 * The state holds what moves and nothing else: particles without pins, one after the other, so that no number is
 * copied. Links to pinned particles have a list of their own, those between two pinned ones none.
 */
#ifndef SPRINGSTEP_WORK_EQUATION_H
#define SPRINGSTEP_WORK_EQUATION_H

#include "harness/scenes.h"

typedef struct work_link {
    uint32_t a, b; /* among the particles that move */
    double stiffness, damping, rest;
} work_link;

typedef struct work_tie { /* a link to a point that does not move */
    uint32_t a;
    double point[3]; /* [m] */
    double stiffness, damping, rest;
} work_tie;

typedef struct work_equation {
    size_t axes, particles, links, ties;
    bool damped; /* a link is */
    work_link *link;
    work_tie *tie;
    double *per_mass; /* [particles] 1/mass */
    double gravity[3], drag;
    spring_scene_force_fn *force; /* of one axis, and of no particle that is pinned */
    void *user;
} work_equation;

void work_equation_init(work_equation *e, const scene_problem *p);
void work_equation_clear(work_equation *e);

/* dy/dt as in ode.h; data is a work_equation, y as in scenes.h. */
void work_equation_derivative(double t, const double *y, double *dy, const void *data);

#endif
