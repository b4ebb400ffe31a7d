/* SPDX-License-Identifier: MIT */
/*
 * Keys and mouse from a file, for tests. Your own program does not need this.
 *
 *     wait 30            draw 30 frames
 *     frame 0.02         set the frame time [s]; the default is 1/60
 *     key M              press and release a key, by SDL's name
 *     move 400 300       move the mouse
 *     press left         press a button (left, middle, right) at the mouse; "release left" releases it
 *     say                print the state of the program
 *     save picture.bmp   save the window
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

/** Returns false, with a message, if the file cannot be read. From now on, real keys and mouse are ignored. */
bool script_open(script *s, const char *path);

/** Plays the lines up to the next frame. Call it between drawing and presenting a frame; `say` prints `state`. Returns
    false at the end, and after an error, which it prints. */
bool script_play(script *s, SDL_Renderer *renderer, const char *state);

void script_close(script *s);

#endif
