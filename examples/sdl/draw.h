/* SPDX-License-Identifier: MIT */
/* Pictures of worlds, and text, by SDL's renderer alone: triangles whose corners are coloured, the farthest first. */
#ifndef SPRINGS_DRAW_H
#define SPRINGS_DRAW_H

#include <SDL.h>

#include "world.h"

/* From where a world is seen. */
typedef struct camera {
    vec3 eye, right, up, forward;
    double focal, x, y; /* [pixels] a length of 1 m at a distance of 1 m; the middle of the window */
} camera;

/* Where on the screen, and how far away. */
typedef struct spot {
    double x, y;  /* [pixels] */
    double depth; /* [m] along the line of sight; what is not positive is behind the camera */
} spot;

typedef struct painter {
    SDL_Renderer *renderer;
    SDL_Texture *font;
    SDL_Vertex *vertex; /* [room] corners of triangles, three by three */
    size_t vertices, room;
    bool incomplete; /* there was no memory for a triangle */
} painter;

/** Everything to draw with. False with a message in SDL_GetError(); the painter is empty then. */
bool painter_open(painter *p, SDL_Renderer *renderer);
void painter_close(painter *p);

/** The camera for a world in a window of so many pixels. */
camera camera_for(world_kind kind, int width, int height);

spot camera_project(const camera *c, vec3 at);

/** The point that is seen there: of cloth and rope at that depth; of water, straight above or below another. */
vec3 camera_pick(const camera *c, double x, double y, double depth);
vec3 camera_pick_height(const camera *c, double y, vec3 above);

/** A world whose particles are at [particles]. False without memory. */
bool paint_world(painter *p, const camera *c, const world *w, const vec3 *at);

/** A ring around what is held, and a line to where it is to go. */
void paint_hand(painter *p, spot held, double mouse_x, double mouse_y);

/** A line of text; returns its width [pixels]. */
int paint_text(painter *p, int x, int y, SDL_Color color, const char *text);

/** A rectangle, translucent as its colour says. */
void paint_box(painter *p, SDL_Rect box, SDL_Color color);

/** A curve through values [count], the least at the lower, the greatest at the upper edge of a box; NaN is left out. */
void paint_curve(painter *p, SDL_Rect box, SDL_Color color, const double *value, int count);

#endif
