/* SPDX-License-Identifier: MIT */
/*
 * A lab is one pane of the live page: a preset scene, what disturbs it, and what is drawn of it. The functions marked
 * EXPORT are what the page calls; with the library they make the WebAssembly module, which imports nothing.
 */
#ifndef SPRINGSTEP_LAB_H
#define SPRINGSTEP_LAB_H

#include <springstep/clock.h>

#include "scenes/disturbances.h"
#include "scenes/presets.h"

#define EXPORT __attribute__((visibility("default"), used))

typedef struct ball { /* single springs, by the exact solution: free fall, then afloat */
    bool there, afloat;
    double x, y;
    spring_state state; /* height of its centre over the water at rest */
} ball;

typedef struct lab {
    preset_settings settings;
    preset preset;
    spring_scene *scene;
    void *saved; /* a copy, to return to */
    size_t bytes;
    disturbances *pushes;
    bool felt; /* has the scene a callback? */
    spring_clock clock;

    double *before, *now; /* [particles*3] the last two states */
    float *drawn;         /* [particles*3] between them */
    uint32_t *ends;       /* [links*2] */
    uint8_t *cut;         /* [links] */
    uint32_t cuts;        /* how many there are */
    spring_scene_energies energies;

    bool held;
    uint32_t particle; /* in the hand */
    double target[3];  /* [m] where the hand wants it */
    bool was_pinned;

    double wind; /* [m/s] */
    double rain; /* drops a second */
    double next_drop;
    uint64_t random;
    ball ball;
} lab;

/* The callback of scenes; user points to the lab. */
void lab_force(void *user, double t, size_t particles, const double *const position[3], const double *const velocity[3],
               double *const out[3]);

/* Gives the scene its callback if anything acts on it, else none: to be called after every change of that. */
void lab_feel(lab *l);

void hand_pull(lab *l, double duration);
void weather_force(const lab *l, double t, const double *const position[3], double *const force[3]);
void weather_rain(lab *l, double until);
void weather_ball(lab *l, double duration);

#endif
