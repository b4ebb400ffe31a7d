/* SPDX-License-Identifier: MIT */
/*
 * Keys and mouse from a file, for tests: a program of your own does without.
 *
 *     wait 30            draw so many frames
 *     frame 0.02         frames take so many seconds from here on; 1/60 before
 *     key M              press and release a key, by SDL's name
 *     move 400 300       the mouse
 *     press left         a button where the mouse is: left, middle, right; then release left
 *     say                print the state of the program
 *     save picture.bmp   what is drawn
 */
#ifndef SPRINGS_SCRIPT_H
#define SPRINGS_SCRIPT_H

#include <SDL.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct script {
    FILE *file;
    const char *path;
    int line, wait;
    double frame_time; /* [s] */
    int x, y;          /* of the mouse */
    Uint32 held;       /* buttons, SDL_BUTTON_LMASK ... */
    bool failed;
} script;

/** False, with a message, if the file cannot be read. From here on real keys and a real mouse do nothing. */
bool script_open(script *s, const char *path);

/** Play the lines up to the next frame, between drawing and presenting one; state is for say. False at the end, and after
    an error, which is said. */
bool script_play(script *s, SDL_Renderer *renderer, const char *state);

void script_close(script *s);

#endif
