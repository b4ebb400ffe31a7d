/* SPDX-License-Identifier: MIT */
/* Pictures of worlds; see draw.h. */
#include "draw.h"

#include <math.h>
#include <stdlib.h>

#include "font.h"

/* -------------------------------------------------------------------------------------------------------- vectors */

static vec3 add(vec3 a, double scale, vec3 b)
{
    return (vec3){a.x + scale * b.x, a.y + scale * b.y, a.z + scale * b.z};
}

static vec3 from_to(vec3 a, vec3 b)
{
    return add(b, -1, a);
}

static double dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec3 cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static vec3 unit(vec3 a)
{
    const double length = sqrt(dot(a, a));
    return length > 0 ? (vec3){a.x / length, a.y / length, a.z / length} : (vec3){0, 0, 1};
}

/* --------------------------------------------------------------------------------------------------------- camera */

camera camera_for(world_kind kind, int width, int height)
{
    static const struct view {
        vec3 eye, target;
        double zoom; /* focal length over the height of the window */
    } views[WORLD_KINDS] = {
        {{1.3, -0.55, 3.0}, {0.52, -0.62, 0}, 1.35}, {{0, -1.05, 3.6}, {0, -1.05, 0}, 1.35},
        {{2, 2.9, 7.2}, {2, -0.1, 2.25}, 1.25},      {{0.4, 1.9, 3.0}, {0, 0.42, 0}, 1.35},
        {{-0.8, 1.5, 4.6}, {0, 0.85, 0}, 1.35},
    };
    const struct view *v = &views[kind];
    camera c = {.eye = v->eye, .forward = unit(from_to(v->eye, v->target)), .x = width / 2.0, .y = height / 2.0};
    c.right = unit(cross(c.forward, (vec3){0, 1, 0}));
    c.up = cross(c.right, c.forward);
    c.focal = v->zoom * fmin(height, 0.75 * width);
    return c;
}

spot camera_project(const camera *c, vec3 at)
{
    const vec3 d = from_to(c->eye, at);
    const double depth = dot(d, c->forward), scale = c->focal / fmax(depth, 1e-3);
    return (spot){c->x + scale * dot(d, c->right), c->y - scale * dot(d, c->up), depth};
}

vec3 camera_pick(const camera *c, double x, double y, double depth)
{
    const vec3 ahead = add(c->eye, depth, c->forward);
    return add(add(ahead, depth * (x - c->x) / c->focal, c->right), depth * (c->y - y) / c->focal, c->up);
}

/* The point (x, h, z) is at y on the screen if up.d = q forward.d, where d = (x, h, z) - eye; this is linear in h. */
vec3 camera_pick_height(const camera *c, double y, vec3 above)
{
    const double q = (c->y - y) / c->focal;
    const vec3 d = from_to(c->eye, (vec3){above.x, 0, above.z});
    const double h = (q * dot(d, c->forward) - dot(d, c->up)) / (c->up.y - q * c->forward.y);
    return (vec3){above.x, fmax(-1, fmin(1, h)), above.z};
}

/* ------------------------------------------------------------------------------------------------------ triangles */

bool painter_open(painter *p, SDL_Renderer *renderer)
{
    p->renderer = renderer;
    SDL_Surface *letters =
        SDL_CreateRGBSurfaceWithFormat(0, FONT_COUNT * FONT_WIDTH, FONT_HEIGHT, 32, SDL_PIXELFORMAT_RGBA32);
    if (letters == NULL)
        return false;
    for (int i = 0; i < FONT_COUNT; i++)
        for (int y = 0; y < FONT_HEIGHT; y++)
            for (int x = 0; x < FONT_WIDTH; x++)
                if (font_rows[i][y] >> (FONT_WIDTH - 1 - x) & 1) {
                    const SDL_Rect pixel = {i * FONT_WIDTH + x, y, 1, 1};
                    SDL_FillRect(letters, &pixel, SDL_MapRGBA(letters->format, 255, 255, 255, 255));
                }
    p->font = SDL_CreateTextureFromSurface(renderer, letters);
    SDL_FreeSurface(letters);
    if (p->font == NULL)
        return false;
    SDL_SetTextureBlendMode(p->font, SDL_BLENDMODE_BLEND);
    SDL_SetRenderDrawBlendMode(renderer, SDL_BLENDMODE_BLEND);
    return true;
}

void painter_close(painter *p)
{
    SDL_DestroyTexture(p->font);
}

/* Lights a colour, given as red, green, blue from 0 to 1. */
static SDL_Color shade(vec3 color, double light, double shine)
{
    const double rgb[3] = {color.x * light + shine, color.y * light + shine, color.z * light + shine};
    Uint8 byte[3];
    for (int i = 0; i < 3; i++)
        byte[i] = (Uint8)(255 * fmax(0, fmin(1, rgb[i])));
    return (SDL_Color){byte[0], byte[1], byte[2], 255};
}

static void paint_corners(painter *p)
{
    SDL_RenderGeometry(p->renderer, NULL, p->vertex, p->vertices, NULL, 0);
    p->vertices = 0;
}

static void corner(painter *p, double x, double y, SDL_Color color)
{
    if (p->vertices == sizeof p->vertex / sizeof *p->vertex)
        paint_corners(p);
    p->vertex[p->vertices++] = (SDL_Vertex){{(float)x, (float)y}, color, {0, 0}};
}

/* SDL has int pixels, which the positions of an exploding world can exceed. */
static bool near_the_window(const camera *c, const spot *s)
{
    return s->depth > 0.05 && fabs(s->x - c->x) < 8 * c->x && fabs(s->y - c->y) < 8 * c->y;
}

static void quad(painter *p, const double x[4], const double y[4], const SDL_Color color[4])
{
    static const int corners[6] = {0, 1, 2, 2, 1, 3};
    for (int i = 0; i < 6; i++)
        corner(p, x[corners[i]], y[corners[i]], color[corners[i]]);
}

/* Painted in bands, which are faster than shaded triangles without a GPU. */
static void background(painter *p, const camera *c)
{
    enum { BAND = 6 }; /* [pixels] */
    const int height = (int)(2 * c->y);
    for (int y = 0; y < height; y += BAND) {
        const vec3 above = {0.15, 0.17, 0.23}, below = {0.36, 0.38, 0.43};
        const SDL_Color color = shade(add(above, (double)y / height, from_to(above, below)), 1, 0);
        paint_box(p, (SDL_Rect){0, y, (int)(2 * c->x), BAND}, color);
    }
}

/* ------------------------------------------------------------------------------------------- surfaces: cloth, water */

typedef struct surface {
    const world *w;
    const camera *c;
    const vec3 *at; /* [particles] */
    spot seen[MOST_PARTICLES];
    vec3 normal[MOST_PARTICLES];   /* towards the viewer in the initial orientation */
    SDL_Color lit[MOST_PARTICLES]; /* water only, since cloth has two sides */
} surface;

typedef struct triangle {
    uint32_t a, b, c;
    double depth;
} triangle;

static int farthest_first(const void *left, const void *right)
{
    const double a = ((const triangle *)left)->depth, b = ((const triangle *)right)->depth;
    return (a < b) - (a > b);
}

/* Lists both triangles of each cell, except triangles with a cut edge. */
static size_t find_triangles(const surface *s, triangle *list)
{
    const world *w = s->w;
    size_t n = 0;
    for (uint32_t row = 0; row + 1 < w->rows; row++)
        for (uint32_t column = 0; column + 1 < w->columns; column++) {
            const uint32_t i = column + w->columns * row, below = i + w->columns;
            if (w->torn[i] & TORN_DOWN_RIGHT)
                continue;
            if (!(w->torn[i] & TORN_RIGHT) && !(w->torn[i + 1] & TORN_DOWN))
                list[n++] = (triangle){i, below + 1, i + 1, 0};
            if (!(w->torn[i] & TORN_DOWN) && !(w->torn[below] & TORN_RIGHT))
                list[n++] = (triangle){i, below, below + 1, 0};
        }
    return n;
}

/* The normal of a corner is the area-weighted sum of the normals of its triangles. */
static void find_normals(surface *s, const triangle *list, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const triangle t = list[i];
        const vec3 up = cross(from_to(s->at[t.a], s->at[t.b]), from_to(s->at[t.a], s->at[t.c]));
        s->normal[t.a] = add(s->normal[t.a], 1, up);
        s->normal[t.b] = add(s->normal[t.b], 1, up);
        s->normal[t.c] = add(s->normal[t.c], 1, up);
    }
    for (size_t i = 0; i < s->w->particles; i++)
        s->normal[i] = unit(s->normal[i]);
}

/* Woven stripes; the back is paler. */
static SDL_Color cloth_color(const surface *s, uint32_t i, uint32_t cell, bool front)
{
    static const vec3 red = {0.78, 0.16, 0.15}, cream = {0.93, 0.85, 0.70}, sun = {-0.35, 0.50, 0.79};
    const uint32_t column = cell % s->w->columns;
    vec3 color = column % 6 < 4 ? red : cream;
    if (!front)
        color = add((vec3){0.22, 0.20, 0.20}, 0.55, color);
    const vec3 normal = front ? s->normal[i] : add((vec3){0}, -1, s->normal[i]);
    const vec3 half = unit(add(unit(from_to(s->at[i], s->c->eye)), 1, sun));
    const double facing = fmax(0, dot(normal, sun)), shine = 0.07 * pow(fmax(0, dot(normal, half)), 24);
    return shade(color, 0.34 + 0.78 * facing, shine);
}

/* Deep water is dark. At flat angles it reflects the sky (Schlick's approximation), and the sun glitters. */
static SDL_Color water_color(const surface *s, uint32_t i)
{
    static const vec3 deep = {0.01, 0.16, 0.26}, shallow = {0.10, 0.55, 0.58};
    static const vec3 horizon = {0.95, 0.95, 0.90}, zenith = {0.30, 0.48, 0.72}, sun = {-0.30, 0.37, -0.88};
    const vec3 towards = unit(from_to(s->at[i], s->c->eye)), normal = s->normal[i];
    const double along = dot(normal, towards), reflectance = 0.06 + 0.94 * pow(1 - fmax(0, along), 5);
    const vec3 mirrored = unit(add(add((vec3){0}, 2 * along, normal), -1, towards));
    const vec3 sky = add(horizon, pow(fmax(0, mirrored.y), 0.6), from_to(horizon, zenith));
    const double high = fmax(0, fmin(1, 0.3 + 2.5 * s->at[i].y + 0.9 * normal.z));
    const vec3 body = add(deep, high, from_to(deep, shallow)), color = add(body, 1.6 * reflectance, from_to(body, sky));
    return shade(color, 1, 0.8 * pow(fmax(0, dot(mirrored, sun)), 120));
}

static void paint_triangle(painter *p, const surface *s, const triangle *t)
{
    const uint32_t i[3] = {t->a, t->b, t->c};
    const spot *a = &s->seen[i[0]], *b = &s->seen[i[1]], *c = &s->seen[i[2]];
    if (!near_the_window(s->c, a) || !near_the_window(s->c, b) || !near_the_window(s->c, c))
        return;
    const bool front = (b->x - a->x) * (c->y - a->y) < (c->x - a->x) * (b->y - a->y);
    for (int k = 0; k < 3; k++) {
        const SDL_Color color = s->w->kind == WORLD_WATER ? s->lit[i[k]] : cloth_color(s, i[k], t->a, front);
        corner(p, s->seen[i[k]].x, s->seen[i[k]].y, color);
    }
}

static void paint_body(painter *p, const camera *c, const world *w);

static vec3 middle_of_body(const world *w)
{
    const spring_collider *b = &w->body[0];
    const double *to = b->shape == SPRING_CAPSULE ? b->to : b->at;
    return (vec3){(b->at[0] + to[0]) / 2, (b->at[1] + to[1]) / 2, (b->at[2] + to[2]) / 2};
}

/* Paints a body over the triangles behind it, and before the triangles in front of it. */
static void paint_surface(painter *p, const camera *c, const world *w, const vec3 *at)
{
    static surface s;
    static triangle list[2 * MOST_PARTICLES];
    s = (surface){.w = w, .c = c, .at = at};
    const size_t n = find_triangles(&s, list);
    find_normals(&s, list, n);
    for (uint32_t i = 0; i < w->particles; i++) {
        s.seen[i] = camera_project(c, at[i]);
        if (w->kind == WORLD_WATER)
            s.lit[i] = water_color(&s, i);
    }
    for (size_t i = 0; i < n; i++)
        list[i].depth = s.seen[list[i].a].depth + s.seen[list[i].b].depth + s.seen[list[i].c].depth;
    qsort(list, n, sizeof *list, farthest_first);
    bool body = world_has_bodies(w);
    const double depth = body ? camera_project(c, middle_of_body(w)).depth : 0;
    for (size_t i = 0; i <= n; i++) {
        if (body && (i == n || list[i].depth < 3 * depth))
            body = false, paint_body(p, c, w);
        if (i < n)
            paint_triangle(p, &s, &list[i]);
    }
}

/* A flat slab between four corners. */
static void paint_slab(painter *p, const camera *c, const vec3 corners[4], vec3 color, double light_from,
                       double light_to)
{
    double x[4], y[4];
    for (int i = 0; i < 4; i++) {
        const spot s = camera_project(c, corners[i]);
        x[i] = s.x;
        y[i] = s.y;
    }
    const SDL_Color from = shade(color, light_from, 0), to = shade(color, light_to, 0),
                    colors[4] = {from, from, to, to};
    quad(p, x, y, colors);
}

/* The rim of the pool. The far side and the flanks are painted before the water, the near side after it. */
static void paint_rim(painter *p, const camera *c, bool near_side)
{
    static const vec3 stone = {0.74, 0.70, 0.64};
    enum { FAR_SIDE = 6, ALL = 8 };
    const double in = 0, out = 4, low = -0.35, top = 0.06, left = in - 0.28, right = out + 0.28;
    const struct slab {
        vec3 corner[4];
        double from, to; /* light */
    } slabs[ALL] = {
        {{{in, top, in}, {out, top, in}, {in, low, in}, {out, low, in}}, 0.5, 0.4},
        {{{in, top, in}, {in, top, out}, {in, low, in}, {in, low, out}}, 0.42, 0.35},
        {{{out, top, in}, {out, top, out}, {out, low, in}, {out, low, out}}, 0.6, 0.45},
        {{{left, top, left}, {right, top, left}, {left, top, in}, {right, top, in}}, 0.78, 0.82},
        {{{left, top, left}, {in, top, left}, {left, top, out}, {in, top, out}}, 0.80, 0.95},
        {{{out, top, left}, {right, top, left}, {out, top, out}, {right, top, out}}, 0.80, 0.95},
        {{{left, top, out}, {right, top, out}, {left, top, right}, {right, top, right}}, 0.95, 1.0},
        {{{left, top, right}, {right, top, right}, {left, low, right}, {right, low, right}}, 0.62, 0.4},
    };
    for (int i = near_side ? FAR_SIDE : 0; i < (near_side ? ALL : FAR_SIDE); i++)
        paint_slab(p, c, slabs[i].corner, stone, slabs[i].from, slabs[i].to);
}

/* The rod of the curtain. */
static void paint_rod(painter *p, const camera *c, const world *w)
{
    static const vec3 brass = {0.80, 0.62, 0.30};
    const double from = -0.12, to = w->home[w->columns - 1].x + 0.12, thick = 0.012, high = 0.035;
    const vec3 upper[4] = {{from, high + thick, 0}, {to, high + thick, 0}, {from, high, 0}, {to, high, 0}};
    const vec3 lower[4] = {{from, high, 0}, {to, high, 0}, {from, high - thick, 0}, {to, high - thick, 0}};
    paint_slab(p, c, upper, brass, 0.7, 1.25);
    paint_slab(p, c, lower, brass, 1.25, 0.45);
}

/* ------------------------------------------------------------------------------------------------------------- rope */

/* The link from particle i to the next, as wide as a cylinder of this thickness [m]: light along its middle. */
static void paint_link(painter *p, const camera *c, const vec3 *at, uint32_t i, double thick)
{
    static const vec3 hemp = {0.80, 0.66, 0.43};
    const spot ends[2] = {camera_project(c, at[i]), camera_project(c, at[i + 1])};
    if (!near_the_window(c, &ends[0]) || !near_the_window(c, &ends[1]))
        return;
    const double dx = ends[1].x - ends[0].x, dy = ends[1].y - ends[0].y, length = fmax(hypot(dx, dy), 1e-9);
    const SDL_Color edge = shade(hemp, 0.4, 0), middle = shade(hemp, i % 2 ? 0.85 : 1, 0);
    for (int side = -1; side <= 1; side += 2) {
        double x[4], y[4];
        for (int k = 0; k < 4; k++) {
            const spot *s = &ends[k / 2];
            const double across = k % 2 * side * 0.5 * thick * c->focal / s->depth;
            x[k] = s->x - across * dy / length;
            y[k] = s->y + across * dx / length;
        }
        quad(p, x, y, (const SDL_Color[4]){middle, edge, middle, edge});
    }
}

/* A ball, or a side of a capsule, in light from the upper left. */
static SDL_Color shade_round(vec3 color, vec3 normal)
{
    const double facing = fmax(0, dot(normal, (vec3){-0.45, 0.6, 0.66}));
    return shade(color, 0.25 + 0.8 * facing, 0.6 * pow(facing, 40));
}

/* A disc, shaded as a ball lit from the upper left. */
static void paint_ball(painter *p, const camera *c, vec3 at, double radius, vec3 color)
{
    enum { SECTORS = 40, RINGS = 8 };
    const spot s = camera_project(c, at);
    if (!near_the_window(c, &s))
        return;
    const double pixels = radius * c->focal / s.depth;
    for (int ring = 0; ring < RINGS; ring++)
        for (int sector = 0; sector < SECTORS; sector++) {
            double x[4], y[4];
            SDL_Color colors[4];
            for (int i = 0; i < 4; i++) {
                const double r = (double)(ring + i / 2) / RINGS,
                             angle = 6.28318530717958648 * (sector + i % 2) / SECTORS;
                const vec3 normal = {r * cos(angle), -r * sin(angle), sqrt(fmax(0, 1 - r * r))};
                x[i] = s.x + pixels * normal.x;
                y[i] = s.y - pixels * normal.y;
                colors[i] = shade_round(color, normal);
            }
            quad(p, x, y, colors);
        }
}

/* The body at the time for which the particles are drawn. */
static spring_collider drawn_body(const world *w)
{
    spring_collider b = w->body[0];
    for (int axis = 0; axis < 3; axis++) {
        b.at[axis] -= w->late * b.velocity[axis];
        b.to[axis] -= w->late * b.velocity_to[axis];
    }
    return b;
}

/* A sphere, or an upright capsule: two balls and the side of a cylinder between them. */
static void paint_body(painter *p, const camera *c, const world *w)
{
    enum { STRIPS = 24 };
    static const vec3 blue = {0.30, 0.42, 0.62};
    const spring_collider moved = drawn_body(w), *b = &moved;
    paint_ball(p, c, (vec3){b->at[0], b->at[1], b->at[2]}, b->radius, blue);
    if (b->shape != SPRING_CAPSULE)
        return;
    paint_ball(p, c, (vec3){b->to[0], b->to[1], b->to[2]}, b->radius, blue);
    for (int k = 0; k < STRIPS; k++) {
        double x[4], y[4];
        SDL_Color colors[4];
        for (int i = 0; i < 4; i++) {
            const double *end = i < 2 ? b->to : b->at, side = 2.0 * (k + i % 2) / STRIPS - 1;
            const spot s = camera_project(c, (vec3){end[0], end[1], end[2]});
            const vec3 normal = {side, 0, sqrt(fmax(0, 1 - side * side))};
            x[i] = s.x + side * b->radius * c->focal / s.depth;
            y[i] = s.y;
            colors[i] = shade_round(blue, normal);
        }
        quad(p, x, y, colors);
    }
}

static void paint_ground(painter *p, const camera *c)
{
    static const vec3 earth = {0.46, 0.44, 0.40};
    const double wide = 2.8, far = -1.5, near = 2.2;
    const vec3 corners[4] = {{-wide, 0, far}, {wide, 0, far}, {-wide, 0, near}, {wide, 0, near}};
    paint_slab(p, c, corners, earth, 0.6, 1.0);
}

static void paint_rope(painter *p, const camera *c, const world *w, const vec3 *at)
{
    static const vec3 wood = {0.45, 0.31, 0.20}, iron = {0.35, 0.37, 0.42}, steel = {0.42, 0.50, 0.62};
    const double thick = 0.045;
    const vec3 beam[4] = {{-0.38, 0.14, 0}, {0.38, 0.14, 0}, {-0.38, -0.03, 0}, {0.38, -0.03, 0}};
    paint_slab(p, c, beam, wood, 1.1, 0.75);
    for (uint32_t i = 0; i + 1 < w->particles; i++)
        if (!(w->torn[i] & TORN_RIGHT))
            paint_link(p, c, at, i, thick);
    paint_ball(p, c, at[0], 0.04, iron);
    paint_ball(p, c, at[w->particles - 1], 0.10, steel);
}

/* ------------------------------------------------------------------------------------------------------- all of it */

void paint_world(painter *p, const camera *c, const world *w, const vec3 *at)
{
    background(p, c);
    switch (w->kind) {
    case WORLD_ROPE:
        paint_rope(p, c, w, at);
        break;
    case WORLD_WATER:
        paint_rim(p, c, false);
        paint_surface(p, c, w, at);
        paint_rim(p, c, true);
        break;
    case WORLD_DRAPE:
    case WORLD_CAPE:
        paint_ground(p, c);
        paint_surface(p, c, w, at);
        break;
    default:
        paint_rod(p, c, w);
        paint_surface(p, c, w, at);
    }
    paint_corners(p);
}

void paint_hand(painter *p, spot held, double mouse_x, double mouse_y)
{
    enum { SIDES = 24 };
    SDL_FPoint ring[SIDES + 1];
    SDL_SetRenderDrawColor(p->renderer, 255, 214, 64, 255);
    for (double radius = 8; radius < 10; radius += 0.5) {
        for (int i = 0; i <= SIDES; i++) {
            const double angle = 6.28318530717958648 * i / SIDES;
            ring[i] = (SDL_FPoint){(float)(held.x + radius * cos(angle)), (float)(held.y + radius * sin(angle))};
        }
        SDL_RenderDrawLinesF(p->renderer, ring, SIDES + 1);
    }
    SDL_RenderDrawLineF(p->renderer, (float)held.x, (float)held.y, (float)mouse_x, (float)mouse_y);
}

int paint_text(painter *p, int x, int y, SDL_Color color, const char *text)
{
    SDL_Rect to = {x, y, FONT_WIDTH, FONT_HEIGHT};
    SDL_SetTextureColorMod(p->font, color.r, color.g, color.b);
    for (; *text != '\0'; text++, to.x += FONT_WIDTH) {
        const int letter = *text - FONT_FIRST;
        const SDL_Rect from = {letter * FONT_WIDTH, 0, FONT_WIDTH, FONT_HEIGHT};
        if (letter > 0 && letter < FONT_COUNT)
            SDL_RenderCopy(p->renderer, p->font, &from, &to);
    }
    return to.x - x;
}

void paint_box(painter *p, SDL_Rect box, SDL_Color color)
{
    SDL_SetRenderDrawColor(p->renderer, color.r, color.g, color.b, color.a);
    SDL_RenderFillRect(p->renderer, &box);
}

void paint_curve(painter *p, SDL_Rect box, SDL_Color color, const double *value, int count)
{
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < count; i++) {
        least = fmin(least, value[i]);
        most = fmax(most, value[i]);
    }
    const double scale = most > least ? box.h / (most - least) : 0;
    SDL_SetRenderDrawColor(p->renderer, color.r, color.g, color.b, color.a);
    for (int i = 1; i < count; i++) {
        if (isnan(value[i - 1]))
            continue;
        const double x = box.x + (double)box.w * i / count, left = x - (double)box.w / count, foot = box.y + box.h;
        SDL_RenderDrawLineF(p->renderer, (float)left, (float)(foot - scale * (value[i - 1] - least)), (float)x,
                            (float)(foot - scale * (value[i] - least)));
    }
}
