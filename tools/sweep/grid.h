/* SPDX-License-Identifier: MIT */
/*
 * The grid of a sweep: axes, values of points, and blocks of points.
 *
 * The first axis changes slowest, methods change fastest. Values use only + - * / and sqrt(), so they are bit-identical
 * on all systems. Nothing here prints or ends the program.
 */
#ifndef SPRINGSTEP_SWEEP_GRID_H
#define SPRINGSTEP_SWEEP_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "sweep/point.h"

typedef enum axis_kind { AXIS_LIST, AXIS_LINEAR, AXIS_LOGARITHMIC } axis_kind;

typedef struct axis {
    sweep_parameter parameter;
    axis_kind kind;
    double first, last;
    double *list; /* [count] AXIS_LIST */
    uint64_t count;
} axis;

typedef struct grid {
    int scene;
    size_t axes;
    axis axis[SWEEP_PARAMETERS];
    size_t methods;
    spring_method method[SPRING_METHOD_COUNT];
    size_t measures; /* in addition to the default measures */
    sweep_measure measure[SWEEP_MEASURES];
    uint64_t points, blocks, points_of_block;
    char message[400]; /* error message after a function returned false */
} grid;

/* An empty grid for one spring, without axes and methods. */
void grid_init(grid *g);
void grid_clear(grid *g);

bool grid_set_scene(grid *g, const char *name);     /* before the axes */
bool grid_add_axis(grid *g, const char *text);      /* NAME=A:B:N, NAME=A:B:log:N, NAME=A,B,... */
bool grid_add_methods(grid *g, const char *names);  /* separated by commas, or "all" */
bool grid_add_measures(grid *g, const char *names); /* separated by commas */
bool grid_finish(grid *g);                          /* checks the grid; counts points and blocks */

/**
 * Measures points.
 *
 * @param[out] values   [count*axes] values of the axes
 * @param[out] results  [count*methods]
 * @return false: no memory
 */
bool grid_measure(const grid *g, sweep_memory *memory, uint64_t first, uint64_t count, double *values,
                  sweep_result *results);

/** The number of points of a block. The last block can have fewer points. */
uint64_t grid_block_size(const grid *g, uint64_t block);

#endif
