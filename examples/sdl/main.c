/* SPDX-License-Identifier: MIT */
/*
 * Cloth, rope, water, drape and cape in a window, to drag, cut and poke.
 *
 *     cc -std=c11 -O2 main.c world.c draw.c $(sdl2-config --cflags --libs) -lspringstep -lm -o springs
 *
 * world.c uses the library: scenes, dragging, cuts, pokes, and two states for interpolation. This file has the window,
 * keys, mouse, and fixed steps with variable frame times. draw.c draws.
 */
#include <SDL.h>
#include <springstep/clock.h>
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "draw.h"
#include "world.h"

enum { HISTORY = 600, MOST_STEPS = 64, LINE = 13 + 4 };
static const double frame_time = 1.0 / 60; /* [s] frame for which steps are counted */
static const double dampings[] = {0, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2}; /* of links; 1 is critical */
enum { DAMPINGS = sizeof dampings / sizeof *dampings };
/* About half the stable step of leapfrog, for water a third. */
static const uint64_t usual_steps[WORLD_KINDS] = {16, 20, 4, 16, 20};

typedef struct app {
    SDL_Window *window;
    SDL_Renderer *renderer;
    painter painter;
    camera camera;
    world world;
    vec3 drawn[MOST_PARTICLES]; /* positions for drawing */
    int method_index;           /* for spring_method_at() */
    uint64_t steps;             /* per frame */
    int damping;                /* index of dampings[] */
    bool wind, running, failed;
    spring_clock clock;
    spring_status trouble;  /* SPRING_OK, or the reason why the simulation stopped */
    double step_cost;       /* [s] smoothed */
    double energy[HISTORY]; /* [J] of the last frames */
    int mouse_x, mouse_y;
    double depth; /* [m] distance of the held particle from the camera */
} app;

/* ------------------------------------------------------------------------------------------------------- settings */

static spring_method method(const app *a)
{
    return spring_method_at(a->method_index);
}

static double step(const app *a)
{
    return frame_time / (double)a->steps;
}

/* Selects the next or the previous method for scenes. */
static void change_method(app *a, int delta)
{
    do
        a->method_index = (a->method_index + delta + SPRING_METHOD_COUNT) % SPRING_METHOD_COUNT;
    while (!spring_method_describe(method(a))->scenes);
}

static bool choose_method(app *a, const char *name)
{
    for (a->method_index = 0; a->method_index < SPRING_METHOD_COUNT; a->method_index++) {
        const spring_method_info *m = spring_method_describe(method(a));
        if (m->scenes && strcmp(m->name, name) == 0)
            return true;
    }
    return false;
}

/* Starts a world with the current settings. */
static bool start(app *a, world_kind kind)
{
    if (!world_open(&a->world, kind)) {
        fprintf(stderr, "springs: no memory for the scene\n");
        return false;
    }
    world_between(&a->world, 1, a->drawn);
    world_set_damping(&a->world, dampings[a->damping]);
    world_set_wind(&a->world, a->wind);
    a->clock = (spring_clock){0};
    a->trouble = SPRING_OK;
    a->step_cost = 0;
    for (int i = 0; i < HISTORY; i++)
        a->energy[i] = i < HISTORY - 1 ? NAN : world_energy(&a->world);
    return true;
}

static bool choose_world(app *a, world_kind kind)
{
    a->steps = usual_steps[kind];
    return start(a, kind);
}

static void quit(app *a, bool failed)
{
    a->running = false;
    a->failed = failed;
}

/* ------------------------------------------------------------------------------------------------------------ mouse */

/* The particle nearest to the mouse. Of equally near particles, such as in folds of a cloth, the one in front. */
static uint32_t under_mouse(const app *a)
{
    const double most = 60, before = 40; /* [pixels]; [pixels/m] bonus for being in front */
    uint32_t found = WORLD_NOTHING;
    double best = INFINITY;
    for (uint32_t i = 0; i < a->world.particles; i++) {
        const spot s = camera_project(&a->camera, a->drawn[i]);
        const double far = hypot(s.x - a->mouse_x, s.y - a->mouse_y), worth = far + before * s.depth;
        if (s.depth > 0 && far < most && worth < best) {
            best = worth;
            found = i;
        }
    }
    return found;
}

static bool exploded(const app *a)
{
    return a->trouble == SPRING_ENONFINITE;
}

static void grab(app *a)
{
    const uint32_t particle = under_mouse(a);
    if (particle == WORLD_NOTHING || exploded(a))
        return;
    a->depth = camera_project(&a->camera, a->drawn[particle]).depth;
    world_grab(&a->world, particle);
}

static void poke(app *a)
{
    const uint32_t particle = under_mouse(a);
    if (particle != WORLD_NOTHING && !exploded(a))
        world_poke(&a->world, particle);
}

/* Moves the target of the held particle to the mouse, at its distance from the camera; water moves up and down. */
static void pull(app *a)
{
    world *w = &a->world;
    if (w->grabbed == WORLD_NOTHING)
        return;
    if (w->kind == WORLD_WATER)
        world_pull(w, camera_pick_height(&a->camera, a->mouse_y, w->home[w->grabbed]));
    else
        world_pull(w, camera_pick(&a->camera, a->mouse_x, a->mouse_y, a->depth));
}

/* Two segments ab and cd cross if each has the ends of the other on different sides. */
static bool cross_over(spot a, spot b, spot c, spot d)
{
    const double abc = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const double abd = (b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x);
    const double cda = (d.x - c.x) * (a.y - c.y) - (d.y - c.y) * (a.x - c.x);
    const double cdb = (d.x - c.x) * (b.y - c.y) - (d.y - c.y) * (b.x - c.x);
    return (abc < 0) != (abd < 0) && (cda < 0) != (cdb < 0);
}

/* Cuts the links that the mouse has crossed. Water is poked instead. */
static void cut(app *a, int from_x, int from_y)
{
    world *w = &a->world;
    const spot from = {from_x, from_y, 0}, to = {a->mouse_x, a->mouse_y, 0};
    if (w->kind == WORLD_WATER)
        poke(a);
    else
        for (size_t i = 0; i < w->links && !exploded(a); i++) {
            const spring_link *l = &w->link[i];
            if (!world_is_cut(w, i) && cross_over(from, to, camera_project(&a->camera, a->drawn[l->a]),
                                                  camera_project(&a->camera, a->drawn[l->b])))
                world_cut(w, i);
        }
}

/* ----------------------------------------------------------------------------------------------------------- events */

static void key(app *a, SDL_Keycode pressed)
{
    switch (pressed) {
    case SDLK_1:
    case SDLK_2:
    case SDLK_3:
    case SDLK_4:
    case SDLK_5:
        if (!choose_world(a, (world_kind)(pressed - SDLK_1)))
            quit(a, true);
        break;
    case SDLK_r:
        if (!start(a, a->world.kind))
            quit(a, true);
        break;
    case SDLK_m:
    case SDLK_n:
        change_method(a, pressed == SDLK_m ? 1 : -1);
        break;
    case SDLK_UP:
    case SDLK_DOWN: /* a clock has one step length, so it is reset */
        if (pressed == SDLK_UP ? a->steps < MOST_STEPS : a->steps > 1)
            a->steps = pressed == SDLK_UP ? a->steps + 1 : a->steps - 1;
        a->clock = (spring_clock){0};
        break;
    case SDLK_RIGHT:
    case SDLK_LEFT:
        if (pressed == SDLK_RIGHT ? a->damping < DAMPINGS - 1 : a->damping > 0)
            a->damping += pressed == SDLK_RIGHT ? 1 : -1;
        world_set_damping(&a->world, dampings[a->damping]);
        break;
    case SDLK_w:
        a->wind = !a->wind;
        world_set_wind(&a->world, a->wind);
        break;
    case SDLK_SPACE:
        poke(a);
        break;
    case SDLK_ESCAPE:
        quit(a, false);
        break;
    default:
        return;
    }
    if (!exploded(a)) /* another method may support the scene */
        a->trouble = SPRING_OK;
}

static void handle(app *a, const SDL_Event *e)
{
    if (e->type == SDL_QUIT)
        quit(a, false);
    else if (e->type == SDL_KEYDOWN)
        key(a, e->key.keysym.sym);
    else if (e->type == SDL_MOUSEMOTION) {
        const int from_x = a->mouse_x, from_y = a->mouse_y;
        a->mouse_x = e->motion.x;
        a->mouse_y = e->motion.y;
        if (e->motion.state & SDL_BUTTON_RMASK)
            cut(a, from_x, from_y);
    } else if (e->type == SDL_MOUSEBUTTONDOWN) {
        a->mouse_x = e->button.x;
        a->mouse_y = e->button.y;
        if (e->button.button == SDL_BUTTON_LEFT)
            grab(a);
        else if (e->button.button == SDL_BUTTON_MIDDLE)
            poke(a);
    } else if (e->type == SDL_MOUSEBUTTONUP && e->button.button == SDL_BUTTON_LEFT)
        world_release(&a->world);
}

/* ----------------------------------------------------------------------------------------------------------- frames */

/* Takes the steps of a frame of this duration, and interpolates between the last two states for drawing. */
static void advance(app *a, double seconds)
{
    double alpha;
    if (a->trouble != SPRING_OK)
        return;
    const uint64_t n = spring_clock_tick(&a->clock, seconds, step(a), 6 * a->steps, &alpha);
    const Uint64 before = SDL_GetPerformanceCounter();
    pull(a);
    a->trouble = world_advance(&a->world, method(a), step(a), n, a->clock.pending);
    if (a->trouble != SPRING_OK)
        return;
    if (n > 0) {
        const Uint64 ticks = SDL_GetPerformanceCounter() - before;
        const double cost = (double)ticks / (double)SDL_GetPerformanceFrequency() / (double)n;
        a->step_cost += (a->step_cost > 0 ? 0.05 : 1) * (cost - a->step_cost);
    }
    memmove(a->energy, a->energy + 1, (HISTORY - 1) * sizeof *a->energy);
    a->energy[HISTORY - 1] = world_energy(&a->world);
    world_between(&a->world, alpha, a->drawn);
}

static const SDL_Color white = {235, 238, 242, 255}, grey = {165, 172, 182, 255};
static const SDL_Color amber = {255, 190, 70, 255}, red = {255, 104, 88, 255}, green = {120, 215, 150, 255};

/* Draws a label in grey and its value in white. */
static void row(app *a, int line, const char *word, const char *text)
{
    paint_text(&a->painter, 20, 20 + line * LINE, grey, word);
    paint_text(&a->painter, 92, 20 + line * LINE, white, text);
}

static void draw_settings(app *a)
{
    const world *w = &a->world;
    const spring_method_info *m = spring_method_describe(method(a));
    const double stable = spring_scene_stable_step(w->scene, method(a));
    char text[96], limit[48];
    paint_box(&a->painter, (SDL_Rect){8, 8, 366, 7 * LINE + 62}, (SDL_Color){16, 19, 26, 190});
    snprintf(text, sizeof text, "%s, %zu particles, %zu links", world_names[w->kind], w->particles, w->links);
    row(a, 0, "scene", text);
    snprintf(text, sizeof text, "%s, order %d", m->label, m->order);
    row(a, 1, "method", text);
    snprintf(limit, sizeof limit, step(a) < stable ? "stable below %.4g ms" : "above the stable step, %.2g ms",
             1e3 * stable);
    snprintf(text, sizeof text, "%.3f ms, %d a frame", 1e3 * step(a), (int)a->steps);
    row(a, 2, "step", text);
    paint_text(&a->painter, 92, 20 + 3 * LINE, step(a) < stable ? green : amber, limit);
    snprintf(text, sizeof text, "%.3g N s/m, %.1f %% of critical", w->damping, 100 * dampings[a->damping]);
    row(a, 4, "damping", text);
    snprintf(text, sizeof text, "%.1f us a step, %.2f ms a frame", 1e6 * a->step_cost,
             1e3 * a->step_cost * (double)a->steps);
    row(a, 5, "cost", text);
    snprintf(text, sizeof text, "%.4g J; the last 10 s:", a->energy[HISTORY - 1]);
    row(a, 6, "energy", text);
    paint_curve(&a->painter, (SDL_Rect){20, 24 + 7 * LINE, 342, 36}, green, a->energy, HISTORY);
}

/* Draws an error and its remedy below the middle of the window. */
static void draw_trouble(app *a, int width, int height)
{
    const char *label = spring_method_describe(method(a))->label;
    char what[96], then[96];
    if (exploded(a)) {
        snprintf(what, sizeof what, "%s has exploded.", label);
        snprintf(then, sizeof then, "R starts again. Before that: M for another method, Up for shorter steps.");
    } else if (world_has_bodies(&a->world)) {
        snprintf(what, sizeof what, "%s does not support contacts.", label);
        snprintf(then, sizeof then, "Press M for another method.");
    } else { /* SPRING_EUNSUPPORTED: see positions_only in spring_method_info */
        snprintf(what, sizeof what, "%s is not for damped links.", label);
        snprintf(then, sizeof then, "Press Left for less damping, M for another method.");
    }
    const int wide = 8 * (int)(strlen(what) > strlen(then) ? strlen(what) : strlen(then)) + 40;
    const SDL_Rect box = {(width - wide) / 2, height - 160, wide, 80};
    paint_box(&a->painter, box, (SDL_Color){40, 12, 14, 230});
    paint_text(&a->painter, box.x + 20, box.y + 20, red, what);
    paint_text(&a->painter, box.x + 20, box.y + 46, white, then);
}

static void draw_help(app *a, int height)
{
    const char *lines[] = {
        "1 to 5 scene   M N method   Up Down steps   Left Right damping   W wind   R again   Esc",
        a->world.kind == WORLD_WATER ? "mouse: left grabs, right, middle or Space pokes"
                                     : "mouse: left grabs, right cuts, middle or Space pokes",
    };
    paint_box(&a->painter, (SDL_Rect){8, height - 2 * LINE - 20, 8 * 86 + 24, 2 * LINE + 12},
              (SDL_Color){16, 19, 26, 150});
    for (int i = 0; i < 2; i++)
        paint_text(&a->painter, 20, height - 2 * LINE - 12 + i * LINE, grey, lines[i]);
}

static bool draw(app *a)
{
    int width, height;
    if (SDL_GetRendererOutputSize(a->renderer, &width, &height) != 0)
        return false;
    a->camera = camera_for(a->world.kind, width, height);
    paint_world(&a->painter, &a->camera, &a->world, a->drawn);
    if (a->world.grabbed != WORLD_NOTHING)
        paint_hand(&a->painter, camera_project(&a->camera, a->drawn[a->world.grabbed]), a->mouse_x, a->mouse_y);
    draw_settings(a);
    draw_help(a, height);
    if (a->trouble != SPRING_OK)
        draw_trouble(a, width, height);
    return true;
}

/* ------------------------------------------------------------------------------------------------------ the program */

typedef struct options {
    const char *world, *method;
} options;

static bool parse(options *o, int count, char **word)
{
    for (int i = 1; i < count; i += 2) {
        const char **value = strcmp(word[i], "--scene") == 0    ? &o->world
                             : strcmp(word[i], "--method") == 0 ? &o->method
                                                                : NULL;
        if (value == NULL || i + 1 == count) {
            fprintf(stderr, "springs: %s %s; usage: springs [--scene cloth|rope|water|drape|cape] [--method NAME]\n",
                    word[i], value == NULL ? "is not an option" : "should be followed by its value");
            return false;
        }
        *value = word[i + 1];
    }
    return true;
}

static bool find_world(const char *name, world_kind *kind)
{
    for (int i = 0; i < WORLD_KINDS; i++)
        if (strcmp(world_names[i], name) == 0) {
            *kind = (world_kind)i;
            return true;
        }
    return false;
}

/* Frames are synchronised to the screen. */
static bool open_window(app *a)
{
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        return false;
    a->window =
        SDL_CreateWindow("springstep", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, 1000, 720, SDL_WINDOW_RESIZABLE);
    if (a->window == NULL)
        return false;
    a->renderer = SDL_CreateRenderer(a->window, -1, SDL_RENDERER_PRESENTVSYNC);
    return a->renderer != NULL && painter_open(&a->painter, a->renderer);
}

static void run(app *a)
{
    Uint64 before = SDL_GetPerformanceCounter();
    for (a->running = true; a->running;) {
        SDL_Event e;
        while (a->running && SDL_PollEvent(&e))
            handle(a, &e);
        if (!a->running)
            break;
        const Uint64 now = SDL_GetPerformanceCounter();
        const double seconds = (double)(now - before) / (double)SDL_GetPerformanceFrequency();
        before = now;
        advance(a, seconds);
        if (!draw(a)) {
            fprintf(stderr, "springs: no picture: %s\n", SDL_GetError());
            quit(a, true);
        }
        SDL_RenderPresent(a->renderer);
    }
}

static void close_all(app *a)
{
    world_close(&a->world);
    painter_close(&a->painter);
    SDL_DestroyRenderer(a->renderer);
    SDL_DestroyWindow(a->window);
    SDL_Quit();
}

int main(int count, char **word)
{
    options o = {.world = "cloth", .method = "leapfrog"};
    static app a = {.damping = 2, .wind = true};
    world_kind kind;
    if (!parse(&o, count, word))
        return 2;
    if (!find_world(o.world, &kind) || !choose_method(&a, o.method)) {
        fprintf(stderr, "springs: no scene \"%s\" with method \"%s\"\n", o.world, o.method);
        return 2;
    }
    if (!open_window(&a)) {
        fprintf(stderr, "springs: no window: %s\n", SDL_GetError());
        a.failed = true;
    } else if (!choose_world(&a, kind))
        a.failed = true;
    else
        run(&a);
    close_all(&a);
    return a.failed;
}
