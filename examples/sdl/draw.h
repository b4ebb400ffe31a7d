/* SPDX-License-Identifier: MIT */
/* Pictures of worlds, and text, with SDL's renderer only: triangles with coloured corners, from back to front. */
#ifndef SPRINGS_DRAW_H
#define SPRINGS_DRAW_H

#include <SDL.h>

#include "world.h"

/* The view of a world. */
typedef struct camera {
    vec3 eye, right, up, forward;
    double focal, x, y; /* [pixels] size of 1 m at a distance of 1 m; middle of the window */
} camera;

/* A position on the screen, and its depth. */
typedef struct spot {
    double x, y;  /* [pixels] */
    double depth; /* [m] along the line of sight; <= 0 is behind the camera */
} spot;

typedef struct painter {
    SDL_Renderer *renderer;
    SDL_Texture *font;
    SDL_Vertex vertex[3 * 1024]; /* corners of triangles that are not painted yet, three by three */
    int vertices;
} painter;

/** Opens a painter. On failure it returns false with a message in SDL_GetError(), and the painter is empty. */
bool painter_open(painter *p, SDL_Renderer *renderer);
void painter_close(painter *p);

/** The camera for a world in a window of this size in pixels. */
camera camera_for(world_kind kind, int width, int height);

spot camera_project(const camera *c, vec3 at);

/** The point at a position on the screen: at a given depth, or (for water) straight above or below another point. */
vec3 camera_pick(const camera *c, double x, double y, double depth);
vec3 camera_pick_height(const camera *c, double y, vec3 above);

/** Paints a world with its particles at the positions at[particles]. */
void paint_world(painter *p, const camera *c, const world *w, const vec3 *at);

/** Paints a ring around the held particle and a line to its target. */
void paint_hand(painter *p, spot held, double mouse_x, double mouse_y);

/** Paints a line of text and returns its width [pixels]. */
int paint_text(painter *p, int x, int y, SDL_Color color, const char *text);

/** Paints a rectangle with the transparency of its colour. */
void paint_box(painter *p, SDL_Rect box, SDL_Color color);

/** Paints a curve through value[count], scaled from the bottom (least) to the top (greatest) of a box; omits NaN. */
void paint_curve(painter *p, SDL_Rect box, SDL_Color color, const double *value, int count);

#endif
