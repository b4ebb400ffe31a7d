/* SPDX-License-Identifier: MIT */
/*
 * XPBD for the cape of spring-work, in single precision, as game engines have it: substeps of one Gauss-Seidel iteration
 * over links, then tethers (long range attachments), then contacts with friction. Links are rigid, the limit of no
 * compliance, with which XPBD stretches least.
 *
 * There are two loops over links. The one for meshes has a list of links for each colour, with the indices of their
 * ends, as cloth of any shape needs. The one for a sheet is written for sheets only: columns and rows of even and odd
 * numbers are arrays of their own. Links of one colour then join equal places of two arrays, up to a shift. All other
 * loops are shared. This file is compiled with -O3 -ffast-math, as users of such code compile it, for the instruction
 * sets of the kernels of the library.
 *
 * Sources: Macklin, Mueller, Chentanez, XPBD (2016); Macklin et al., Small steps in physics simulation (2019); Kim,
 * Chentanez, Mueller, Long range attachments (2012); Macklin et al., Unified particle physics (2014), friction.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "work_cape.h"

enum {
    AXES = 3,
    PARTS = 4, /* 0: even row, even column; 1: even row, odd column; 2: odd row, even column; 3: odd row, odd column */
    WIDTH = CAPE_COLUMNS / 2,
    PART = WIDTH * CAPE_ROWS / 2, /* particles of a part */
    LANES = 16,
    PADDED = (PART + LANES - 1) / LANES * LANES,
    MARGIN = LANES /* shifts read beyond both ends */
};

typedef float numbers[MARGIN + PADDED + MARGIN];

typedef struct colour_part { /* links from places i of one part to places i + shift of another */
    int a, b, shift;
    bool diagonal;
    numbers share_a, share_b; /* w/(w_a + w_b) of the ends; 0 where there is no link */
} colour_part;

/* A link of a mesh: the positions of its ends in an array of all particles. */
typedef struct listed {
    int a[PADDED], b[PADDED]; /* of a colour: links that share no particle */
    float rest[PADDED], share_a[PADDED], share_b[PADDED];
} listed;

struct cape_xpbd {
    numbers x[PARTS][AXES], old[PARTS][AXES], v[PARTS][AXES];
    numbers moving[PARTS];  /* 1; pinned: 0 */
    numbers pin[2][AXES];   /* the pin above each place of an even and of an odd column */
    numbers pin_v[2][AXES]; /* [m/s] */
    numbers length[2];      /* [m] of the tether in even and odd rows */
    colour_part links[16];
    listed list[16]; /* the same links */
    float step;
    bool tethers, mesh;
};

static int row_of(int part, int place)
{
    return 2 * (place / WIDTH) + part / 2;
}

static int column_of(int part, int place)
{
    return 2 * (place % WIDTH) + part % 2;
}

static void make_links(cape_xpbd *s)
{
    static const struct {
        int a, b, shift;
    } way[16] = {{0, 1, 0}, {2, 3, 0},  {1, 0, 1},     {3, 2, 1},     /* along rows */
                 {0, 2, 0}, {1, 3, 0},  {2, 0, WIDTH}, {3, 1, WIDTH}, /* along columns */
                 {0, 3, 0}, {1, 2, 1},  {2, 1, WIDTH}, {3, 0, WIDTH + 1},
                 {1, 2, 0}, {0, 3, -1}, {3, 0, WIDTH}, {2, 1, WIDTH - 1}};
    for (int k = 0; k < 16; k++) {
        colour_part *c = &s->links[k];
        c->a = way[k].a, c->b = way[k].b, c->shift = way[k].shift, c->diagonal = k >= 8;
        for (int i = 0; i < PART; i++) {
            const int j = i + c->shift;
            if (j < 0 || j >= PART || abs(column_of(c->a, i) - column_of(c->b, j)) > 1)
                continue; /* the end of a row */
            const float w_a = row_of(c->a, i) > 0, w_b = row_of(c->b, j) > 0;
            listed *l = &s->list[k];
            l->a[i] = (int)(&s->x[c->a][0][MARGIN + i] - s->x[0][0]);
            l->b[i] = (int)(&s->x[c->b][0][MARGIN + j] - s->x[0][0]);
            l->rest[i] = (float)(cape_spacing * (c->diagonal ? sqrt(2.0) : 1));
            if (w_a + w_b > 0)
                l->share_a[i] = w_a / (w_a + w_b), l->share_b[i] = w_b / (w_a + w_b);
            if (w_a + w_b > 0) {
                c->share_a[MARGIN + i] = w_a / (w_a + w_b);
                c->share_b[MARGIN + i] = w_b / (w_a + w_b);
            }
        }
    }
}

cape_xpbd *cape_xpbd_make(const double (*position)[3], double step, bool tethers, bool mesh)
{
    cape_xpbd *s = calloc(1, sizeof *s);
    if (s == NULL)
        cli_fail(CLI_FAILED, "no memory for XPBD");
    s->step = (float)step;
    s->tethers = tethers;
    s->mesh = mesh;
    for (int part = 0; part < PARTS; part++)
        for (int i = 0; i < PART; i++) {
            const int row = row_of(part, i);
            s->moving[part][MARGIN + i] = row > 0;
            s->length[part / 2][MARGIN + i] = (float)(row * cape_spacing);
            for (int d = 0; d < AXES; d++)
                s->x[part][d][MARGIN + i] = (float)position[row * CAPE_COLUMNS + column_of(part, i)][d];
        }
    make_links(s);
    return s;
}

void cape_xpbd_get(const cape_xpbd *s, double (*position)[3], double (*velocity)[3])
{
    for (int part = 0; part < PARTS; part++)
        for (int i = 0; i < PART; i++)
            for (int d = 0; d < AXES; d++) {
                const int particle = row_of(part, i) * CAPE_COLUMNS + column_of(part, i);
                position[particle][d] = s->x[part][d][MARGIN + i];
                velocity[particle][d] = s->v[part][d][MARGIN + i];
            }
}

/* ----------------------------------------------------------------------------------------------------- substeps */

#define INLINE static inline __attribute__((always_inline))
#if defined(__clang__)
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define INDEPENDENT _Pragma("GCC ivdep")
#endif

static const float smallest = 1e-20f; /* [m^2] avoids a division by 0 */

INLINE void predict(cape_xpbd *s, const float acceleration[AXES])
{
    const float h = s->step, decay = 1 / (1 + h * (float)(cape_drag / cape_mass));
    for (int part = 0; part < PARTS; part++)
        for (int d = 0; d < AXES; d++) {
            float *restrict x = s->x[part][d], *restrict old = s->old[part][d], *restrict v = s->v[part][d];
            const float *restrict moving = s->moving[part], *restrict pin_v = s->pin_v[part % 2][d];
            const float kick = h * acceleration[d];
            INDEPENDENT for (int i = MARGIN; i < MARGIN + PADDED; i++)
            {
                const float v1 = moving[i] * ((v[i] + kick) * decay) + (1 - moving[i]) * pin_v[i];
                old[i] = x[i];
                x[i] += h * v1;
            }
        }
}

/* Each link moves its ends by its shares of length - rest. */
INLINE void solve_links(cape_xpbd *s, const colour_part *c)
{
    const float rest = (float)(cape_spacing * (c->diagonal ? sqrt(2.0) : 1));
    float *restrict ax = s->x[c->a][0], *restrict ay = s->x[c->a][1], *restrict az = s->x[c->a][2];
    float *restrict bx = s->x[c->b][0] + c->shift, *restrict by = s->x[c->b][1] + c->shift,
                    *restrict bz = s->x[c->b][2] + c->shift;
    const float *restrict share_a = c->share_a, *restrict share_b = c->share_b;
    INDEPENDENT for (int i = MARGIN; i < MARGIN + PADDED; i++)
    {
        const float x = bx[i] - ax[i], y = by[i] - ay[i], z = bz[i] - az[i];
        const float l = 1 - rest / sqrtf(x * x + y * y + z * z + smallest), la = share_a[i] * l, lb = share_b[i] * l;
        ax[i] += la * x, ay[i] += la * y, az[i] += la * z;
        bx[i] -= lb * x, by[i] -= lb * y, bz[i] -= lb * z;
    }
}

/* Without INDEPENDENT: with vectors that gather and scatter, it takes 1.4 times as long. */
INLINE void solve_listed(cape_xpbd *s, const listed *c)
{
    enum { NEXT = MARGIN + PADDED + MARGIN }; /* from one axis to the next */
    float *restrict x = s->x[0][0];
    for (int i = 0; i < PART; i++) {
        const int a = c->a[i], b = c->b[i];
        const float dx = x[b] - x[a], dy = x[b + NEXT] - x[a + NEXT], dz = x[b + 2 * NEXT] - x[a + 2 * NEXT];
        const float l = 1 - c->rest[i] / sqrtf(dx * dx + dy * dy + dz * dz + smallest), la = c->share_a[i] * l,
                    lb = c->share_b[i] * l;
        x[a] += la * dx, x[a + NEXT] += la * dy, x[a + 2 * NEXT] += la * dz;
        x[b] -= lb * dx, x[b + NEXT] -= lb * dy, x[b + 2 * NEXT] -= lb * dz;
    }
}

INLINE void solve_tethers(cape_xpbd *s)
{
    for (int part = 0; part < PARTS; part++) {
        float *restrict px = s->x[part][0], *restrict py = s->x[part][1], *restrict pz = s->x[part][2];
        const float *restrict qx = s->pin[part % 2][0], *restrict qy = s->pin[part % 2][1],
                              *restrict qz = s->pin[part % 2][2];
        const float *restrict length = s->length[part / 2];
        INDEPENDENT for (int i = MARGIN; i < MARGIN + PADDED; i++)
        {
            const float x = px[i] - qx[i], y = py[i] - qy[i], z = pz[i] - qz[i];
            const float excess = 1 - length[i] / sqrtf(x * x + y * y + z * z + smallest), l = excess > 0 ? excess : 0;
            px[i] -= l * x, py[i] -= l * y, pz[i] -= l * z;
        }
    }
}

typedef struct capsule {
    float at[AXES], along[AXES], per_square, radius; /* 1/|along|^2; with the radius of particles */
    float velocity[AXES], turn[AXES];                /* [m/s] of a point at the fraction f: velocity + f turn */
} capsule;

/* Moves the particles inside a capsule to its surface, and reduces their motion along it by friction. */
INLINE void collide(cape_xpbd *s, const capsule *k, int part)
{
    const float h = s->step, friction = (float)cape_friction, square = k->radius * k->radius;
    float *restrict px = s->x[part][0], *restrict py = s->x[part][1], *restrict pz = s->x[part][2];
    const float *restrict ox = s->old[part][0], *restrict oy = s->old[part][1], *restrict oz = s->old[part][2];
    const float *restrict moving = s->moving[part];
    for (int first = MARGIN; first < MARGIN + PADDED; first += LANES) {
        float inside = 0;
        for (int i = first; i < first + LANES; i++) {
            const float x = px[i] - k->at[0], y = py[i] - k->at[1], z = pz[i] - k->at[2];
            const float f0 = k->per_square * (x * k->along[0] + y * k->along[1] + z * k->along[2]);
            const float f = f0 < 0 ? 0 : f0 > 1 ? 1 : f0;
            const float nx = x - f * k->along[0], ny = y - f * k->along[1], nz = z - f * k->along[2];
            const float depth = moving[i] * (square - (nx * nx + ny * ny + nz * nz));
            inside = depth > inside ? depth : inside;
        }
        if (!(inside > 0))
            continue;
        INDEPENDENT for (int i = first; i < first + LANES; i++)
        {
            const float x = px[i] - k->at[0], y = py[i] - k->at[1], z = pz[i] - k->at[2];
            const float f0 = k->per_square * (x * k->along[0] + y * k->along[1] + z * k->along[2]);
            const float f = f0 < 0 ? 0 : f0 > 1 ? 1 : f0;
            const float nx = x - f * k->along[0], ny = y - f * k->along[1], nz = z - f * k->along[2];
            const float away = sqrtf(nx * nx + ny * ny + nz * nz + smallest), over = 1 / away;
            const float depth0 = moving[i] * (k->radius - away), depth = depth0 > 0 ? depth0 : 0;
            const float mx = px[i] - ox[i] - h * (k->velocity[0] + f * k->turn[0]),
                        my = py[i] - oy[i] - h * (k->velocity[1] + f * k->turn[1]),
                        mz = pz[i] - oz[i] - h * (k->velocity[2] + f * k->turn[2]);
            const float normal = (mx * nx + my * ny + mz * nz) * over * over;
            const float tx = mx - normal * nx, ty = my - normal * ny, tz = mz - normal * nz;
            const float slid = sqrtf(tx * tx + ty * ty + tz * tz + smallest), most = friction * depth / slid;
            const float held = most < 1 ? most : 1, out = depth * over;
            px[i] += out * nx - held * tx, py[i] += out * ny - held * ty, pz[i] += out * nz - held * tz;
        }
    }
}

INLINE void find_velocities(cape_xpbd *s)
{
    const float per_step = 1 / s->step;
    for (int part = 0; part < PARTS; part++)
        for (int d = 0; d < AXES; d++) {
            const float *restrict x = s->x[part][d], *restrict old = s->old[part][d];
            float *restrict v = s->v[part][d];
            INDEPENDENT for (int i = MARGIN; i < MARGIN + PADDED; i++) v[i] = per_step * (x[i] - old[i]);
        }
}

INLINE void move_pins(cape_xpbd *s)
{
    for (int odd = 0; odd < 2; odd++)
        for (int d = 0; d < AXES; d++)
            for (int i = MARGIN; i < MARGIN + PADDED; i++)
                s->pin[odd][d][i] += s->step * s->pin_v[odd][d][i];
}

INLINE void substeps(cape_xpbd *s, const cape_motion *m, uint64_t steps)
{
    float acceleration[AXES];
    capsule body[CAPE_BODIES];
    for (int d = 0; d < AXES; d++) {
        acceleration[d] = (float)m->gravity[d];
        for (int odd = 0; odd < 2; odd++)
            for (int i = 0; i < PART; i++) {
                const int column = column_of(odd, i);
                s->pin[odd][d][MARGIN + i] = (float)m->pin[column][d];
                s->pin_v[odd][d][MARGIN + i] = (float)((m->pin_to[column][d] - m->pin[column][d]) / m->duration);
            }
        for (int part = 0; part < 2; part++) /* pins start where they are, without rounding errors that add up */
            for (int i = 0; i < WIDTH; i++)
                s->x[part][d][MARGIN + i] = (float)m->pin[column_of(part, i)][d];
    }
    for (uint64_t n = 1; n <= steps; n++) {
        const double t = (double)n * s->step;
        predict(s, acceleration);
        for (int k = 0; k < 16; k++)
            if (s->mesh)
                solve_listed(s, &s->list[k]);
            else
                solve_links(s, &s->links[k]);
        if (s->tethers) {
            move_pins(s);
            solve_tethers(s);
        }
        for (int k = 0; k < CAPE_BODIES; k++) {
            const struct cape_body *b = &m->body[k];
            float square = 0;
            for (int d = 0; d < AXES; d++) {
                const double turn = b->velocity[1][d] - b->velocity[0][d];
                body[k].at[d] = (float)(b->at[0][d] + t * b->velocity[0][d]);
                body[k].along[d] = (float)(b->at[1][d] - b->at[0][d] + t * turn);
                body[k].velocity[d] = (float)b->velocity[0][d];
                body[k].turn[d] = (float)turn;
                square += body[k].along[d] * body[k].along[d];
            }
            body[k].per_square = 1 / square;
            body[k].radius = (float)(b->radius + cape_skin);
            for (int part = 0; part < PARTS; part++)
                collide(s, &body[k], part);
        }
        find_velocities(s);
    }
}

/* The instruction sets of the kernels of the library. */
#if defined(__x86_64__)
__attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,fma"))) static void with_avx512(cape_xpbd *s,
                                                                                          const cape_motion *m,
                                                                                          uint64_t steps)
{
    substeps(s, m, steps);
}

__attribute__((target("avx2,fma"))) static void with_avx2(cape_xpbd *s, const cape_motion *m, uint64_t steps)
{
    substeps(s, m, steps);
}
#endif

void cape_xpbd_advance(cape_xpbd *s, const cape_motion *m, uint64_t steps)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
        with_avx512(s, m, steps);
        return;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        with_avx2(s, m, steps);
        return;
    }
#endif
    substeps(s, m, steps);
}
