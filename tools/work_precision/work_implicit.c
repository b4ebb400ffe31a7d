/* SPDX-License-Identifier: MIT */
/* BDF2 with conjugate gradients, and projective dynamics; see work_implicit.h. */
#include "work_implicit.h"

#include "work_lanes.h"

enum { AXES = 3, TILE = 8, MOST_ITERATIONS = 1000 };

/* Local and global solves per step of projective dynamics. Three had 1.3 times the error for the same time in the
   stiff cloth after 0.25 s. */
enum { ITERATIONS = 1 };

/* Iterations end at this part of the residual, in the norm of the preconditioner, for steps of a frame, and at less for
   shorter steps. Ten times as many digits did not give a smaller error for the same time. */
static const double enough = 1e-2, frames = 60; /* [1/s] */

typedef struct band_matrix { /* of a link: across I + along n n' */
    double *normal[AXES], *across, *along;
} band_matrix;

/* A vector has three rows of `stride` numbers, one per axis. Rows begin and end with a margin of zeros. */
struct work_implicit {
    work_equation *e;
    size_t margin, stride, width, steps; /* width: number of subdiagonals, in whole vectors */
    double h;
    double *x, *v, *old_x, *old_v, *delta; /* vectors; old: one step before; delta: the last solution */
    double *base_x, *base_v, *r, *z, *p, *q;
    double *inverse[AXES][AXES];   /* rows: of the diagonal blocks, lower part; 0 for pinned particles */
    double *mass, *free, *inertia; /* rows; free: 1, or 0 if pinned; inertia: mass and drag in the matrix */
    band_matrix band[WORK_BANDS];
    double *factor; /* [slots][1 + width] columns of the Cholesky factor; the first number is 1/diagonal */
    double *memory;
};

static double *row_of(const work_implicit *s, double *vector, size_t d)
{
    return vector + d * s->stride + s->margin;
}

work_implicit *work_implicit_make(const scene_problem *p, work_equation *e)
{
    enum { VECTORS = 11, ROWS = 6 + 3 + 5 * WORK_BANDS };
    work_implicit *s = scene_room(1, sizeof *s);
    size_t widest = 0;
    for (size_t b = 0; b < e->bands; b++)
        widest = e->band[b].offset > widest ? e->band[b].offset : widest;
    s->e = e;
    s->width = (widest + LANES - 1) / LANES * LANES;
    s->margin = s->width + LANES;
    s->stride = e->vectors * LANES + 2 * s->margin;
    double *next = s->memory = aligned_room((VECTORS * AXES + ROWS) * s->stride * sizeof *next);
    double **const vectors[] = {&s->x,      &s->v, &s->old_x, &s->old_v, &s->delta, &s->base_x,
                                &s->base_v, &s->r, &s->z,     &s->p,     &s->q};
    for (size_t i = 0; i < VECTORS; i++)
        *vectors[i] = next, next += AXES * s->stride;
    next += s->margin;
    double **const rows[] = {&s->mass, &s->free, &s->inertia};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        *rows[i] = next, next += s->stride;
    for (size_t c = 0; c < AXES; c++)
        for (size_t d = 0; d <= c; d++)
            s->inverse[c][d] = next, next += s->stride;
    for (size_t b = 0; b < e->bands; b++) {
        band_matrix *m = &s->band[b];
        double **const parts[] = {&m->normal[0], &m->normal[1], &m->normal[2], &m->across, &m->along};
        for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
            *parts[i] = next, next += s->stride;
    }
    for (size_t i = 0; i < p->def.particles; i++) {
        s->mass[i] = p->mass[i];
        s->free[i] = p->pinned[i] ? 0 : 1;
    }
    return s;
}

void work_implicit_free(work_implicit *s)
{
    free(s->factor);
    free(s->memory);
    free(s);
}

void work_implicit_get(const work_implicit *s, const scene_problem *p, double *y)
{
    for (size_t i = 0; i < p->moving; i++) {
        const size_t d = p->coordinate[i] % AXES, at = p->coordinate[i] / AXES;
        y[i] = row_of(s, s->x, d)[at];
        y[p->moving + i] = row_of(s, s->v, d)[at];
    }
}

/* The accelerations at x and v, in the equation. */
static void accelerate(const work_implicit *s, const double *x, const double *v)
{
    const size_t bytes = s->e->vectors * sizeof(lanes);
    for (size_t d = 0; d < AXES; d++) {
        memcpy(s->e->x[d], x + d * s->stride + s->margin, bytes);
        memcpy(s->e->v[d], v + d * s->stride + s->margin, bytes);
    }
    work_equation_accelerations(s->e);
}

/* ------------------------------------------------------------------------------------------------------ vectors */

/* a = b + f c */
INLINE void add(const work_implicit *s, double *a, const double *b, double f, const double *c)
{
    for (size_t i = 0; i < AXES * s->stride; i += LANES) {
        lanes to, from;
        LOAD(to, b + i);
        LOAD(from, c + i);
        to += f * from;
        STORE(a + i, to);
    }
}

INLINE double dot(const work_implicit *s, const double *a, const double *b)
{
    lanes sum = {0};
    for (size_t i = 0; i < AXES * s->stride; i += LANES) {
        lanes left, right;
        LOAD(left, a + i);
        LOAD(right, b + i);
        sum += left * right;
    }
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/* r = f M (b (base - at) + a), 0 for pinned particles, with the accelerations a that were computed last. */
INLINE void find_residual(const work_implicit *s, double f, double b, const double *base, const double *at)
{
    for (size_t d = 0; d < AXES; d++)
        for (size_t i = 0; i < s->e->vectors * LANES; i += LANES) {
            const size_t k = d * s->stride + s->margin + i;
            lanes from, to, a, mass, moves;
            LOAD(from, at + k);
            LOAD(to, base + k);
            LOAD(a, s->e->a[d] + i);
            LOAD(mass, s->mass + i);
            LOAD(moves, s->free + i);
            a = f * moves * mass * (b * (to - from) + a);
            STORE(s->r + k, a);
        }
}

/* --------------------------------------------------------------------------------------------------------- BDF2 */

/* Selects bits, because a conditional expression of vectors is not C. */
typedef int64_t lane_bits __attribute__((vector_size(LANES * sizeof(int64_t))));
#define POSITIVE_PART(a) ((lanes)((lane_bits)(a) & ((a) > 0)))

/* The blocks b D + b^2 K of all links at x. */
INLINE void linearise(const work_implicit *s, const double *x, double b)
{
    const double smallest = 1e-30; /* [m^2] as in work_equation.c */
    for (size_t k = 0; k < s->e->bands; k++) {
        const work_band *band = &s->e->band[k];
        const band_matrix *m = &s->band[k];
        for (size_t i = 0; i < s->e->vectors * LANES; i += LANES) {
            lanes delta[AXES], low, square = {0}, inverse, stiffness, damping, across;
            UNROLL
            for (size_t d = 0; d < AXES; d++) {
                LOAD(low, x + d * s->stride + s->margin + i);
                LOAD(delta[d], x + d * s->stride + s->margin + i + band->offset);
                delta[d] -= low;
                square += delta[d] * delta[d];
            }
            square += smallest;
            inverse_root(&square, &inverse);
            LOAD(stiffness, band->stiffness + i);
            LOAD(damping, band->damping + i);
            across = 1 - band->rest * inverse;
            across = b * b * stiffness * POSITIVE_PART(across);
            const lanes along = b * b * stiffness + b * damping - across;
            UNROLL
            for (size_t d = 0; d < AXES; d++) {
                delta[d] *= inverse;
                STORE(m->normal[d] + i, delta[d]);
            }
            STORE(m->across + i, across);
            STORE(m->along + i, along);
        }
    }
}

/* Adds a block of a link to the lower part of a diagonal block. */
INLINE void add_block(lanes sum[AXES][AXES], const band_matrix *m, size_t i)
{
    lanes n[AXES], across, along;
    LOAD(across, m->across + i);
    LOAD(along, m->along + i);
    UNROLL
    for (size_t d = 0; d < AXES; d++)
        LOAD(n[d], m->normal[d] + i);
    UNROLL
    for (size_t c = 0; c < AXES; c++) {
        sum[c][c] += across;
        UNROLL
        for (size_t d = 0; d <= c; d++)
            sum[c][d] += along * n[c] * n[d];
    }
}

/* Inverts the diagonal block of each particle. */
INLINE void precondition(const work_implicit *s)
{
    for (size_t i = 0; i < s->e->vectors * LANES; i += LANES) {
        lanes a[AXES][AXES] = {0}, inertia, moves;
        LOAD(inertia, s->inertia + i);
        LOAD(moves, s->free + i);
        UNROLL
        for (size_t d = 0; d < AXES; d++)
            a[d][d] = inertia + (1 - moves);
        for (size_t k = 0; k < s->e->bands; k++) {
            add_block(a, &s->band[k], i);
            add_block(a, &s->band[k], i - s->e->band[k].offset);
        }
        const lanes xx = a[1][1] * a[2][2] - a[2][1] * a[2][1], yx = a[2][0] * a[2][1] - a[1][0] * a[2][2],
                    zx = a[1][0] * a[2][1] - a[2][0] * a[1][1], yy = a[0][0] * a[2][2] - a[2][0] * a[2][0],
                    zy = a[1][0] * a[2][0] - a[0][0] * a[2][1], zz = a[0][0] * a[1][1] - a[1][0] * a[1][0],
                    scale = moves / (a[0][0] * xx + a[1][0] * yx + a[2][0] * zx);
        const lanes inverse[AXES][AXES] = {
            {scale * xx}, {scale * yx, scale * yy}, {scale * zx, scale * zy, scale * zz}};
        for (size_t c = 0; c < AXES; c++)
            for (size_t d = 0; d <= c; d++)
                STORE(s->inverse[c][d] + i, inverse[c][d]);
    }
}

/* z = r times the inverses of diagonal blocks */
INLINE void apply_inverse(const work_implicit *s)
{
    for (size_t i = 0; i < s->e->vectors * LANES; i += LANES) {
        lanes r[AXES], part;
        for (size_t d = 0; d < AXES; d++)
            LOAD(r[d], s->r + d * s->stride + s->margin + i);
        for (size_t c = 0; c < AXES; c++) {
            lanes sum = {0};
            for (size_t d = 0; d < AXES; d++) {
                LOAD(part, s->inverse[c > d ? c : d][c > d ? d : c] + i);
                sum += part * r[d];
            }
            STORE(s->z + c * s->stride + s->margin + i, sum);
        }
    }
}

INLINE void multiply_links(const work_implicit *s, size_t k, const double *p, size_t i)
{
    const work_band *band = &s->e->band[k];
    const band_matrix *m = &s->band[k];
    lanes delta[AXES], n[AXES], low, across, along, sum = {0};
    UNROLL
    for (size_t d = 0; d < AXES; d++) {
        LOAD(low, p + d * s->stride + s->margin + i);
        LOAD(delta[d], p + d * s->stride + s->margin + i + band->offset);
        LOAD(n[d], m->normal[d] + i);
        delta[d] -= low;
        sum += n[d] * delta[d];
    }
    LOAD(across, m->across + i);
    LOAD(along, m->along + i);
    sum *= along;
    UNROLL
    for (size_t d = 0; d < AXES; d++) {
        delta[d] = across * delta[d] + sum * n[d];
        STORE(band->force[d] + i, delta[d]);
    }
}

/* q = (inertia + links) p, 0 for pinned particles. Links of a tile are added up while they are in the cache. */
INLINE void multiply(const work_implicit *s, const double *p, double *q)
{
    for (size_t first = 0; first < s->e->vectors; first += TILE) {
        const size_t end = first + TILE < s->e->vectors ? first + TILE : s->e->vectors;
        for (size_t i = LANES * first; i < LANES * end; i += LANES)
            for (size_t k = 0; k < s->e->bands; k++)
                multiply_links(s, k, p, i);
        for (size_t i = LANES * first; i < LANES * end; i += LANES) {
            lanes inertia, moves;
            LOAD(inertia, s->inertia + i);
            LOAD(moves, s->free + i);
            UNROLL
            for (size_t d = 0; d < AXES; d++) {
                lanes sum, lower, upper;
                LOAD(sum, p + d * s->stride + s->margin + i);
                sum *= inertia;
                for (size_t k = 0; k < s->e->bands; k++) {
                    LOAD(lower, s->e->band[k].force[d] + i);
                    LOAD(upper, s->e->band[k].force[d] + i - s->e->band[k].offset);
                    sum += upper - lower;
                }
                sum *= moves;
                STORE(q + d * s->stride + s->margin + i, sum);
            }
        }
    }
}

/* Solves for delta, from its previous value, with the right-hand side r. */
INLINE void solve(const work_implicit *s)
{
    apply_inverse(s);
    const double part = enough * fmin(1, frames * s->h), limit = part * part * dot(s, s->r, s->z);
    multiply(s, s->delta, s->q);
    add(s, s->r, s->r, -1, s->q);
    apply_inverse(s);
    double rz = dot(s, s->r, s->z);
    memcpy(s->p, s->z, AXES * s->stride * sizeof *s->p);
    for (int i = 0; rz > limit && i < MOST_ITERATIONS; i++) {
        multiply(s, s->p, s->q);
        const double step = rz / dot(s, s->p, s->q), before = rz;
        add(s, s->delta, s->delta, step, s->p);
        add(s, s->r, s->r, -step, s->q);
        apply_inverse(s);
        rz = dot(s, s->r, s->z);
        add(s, s->p, s->z, rz / before, s->p);
    }
}

INLINE void bdf2_step(work_implicit *s)
{
    const bool first = s->steps == 0;
    const double b = first ? s->h : s->h * 2 / 3;
    const size_t bytes = AXES * s->stride * sizeof *s->x;
    for (size_t i = 0; i < s->e->vectors * LANES; i++)
        s->inertia[i] = s->mass[i] + b * s->e->drag;
    add(s, s->base_x, s->x, -1, s->old_x);
    add(s, s->base_v, s->v, -1, s->old_v);
    add(s, s->base_x, s->x, first ? 0 : 1.0 / 3, s->base_x);
    add(s, s->base_v, s->v, first ? 0 : 1.0 / 3, s->base_v);
    memcpy(s->old_x, s->x, bytes);
    memcpy(s->old_v, s->v, bytes);
    add(s, s->x, s->base_x, b, s->v);
    accelerate(s, s->x, s->v);
    find_residual(s, b, 1 / b, s->base_v, s->v);
    linearise(s, s->x, b);
    precondition(s);
    solve(s);
    add(s, s->v, s->v, 1, s->delta);
    add(s, s->x, s->base_x, b, s->v);
    s->steps++;
}

INLINE void bdf2_steps(work_implicit *s, uint64_t n)
{
    for (uint64_t i = 0; i < n; i++)
        bdf2_step(s);
}

/* ---------------------------------------------------------------------------------------------------- projective */

/* Factorises the matrix of all particles; rows of pinned particles are those of the identity. */
static void factorise(work_implicit *s, const scene_problem *p)
{
    const size_t n = s->e->vectors * LANES, column = s->width + LANES; /* padded for whole vectors */
    free(s->factor);
    s->factor = aligned_room((n + s->width) * column * sizeof *s->factor);
    double *const L = s->factor;
    for (size_t i = 0; i < n; i++)
        L[i * column] = s->free[i] > 0 ? s->mass[i] / (s->h * s->h) + s->e->drag / s->h : 1;
    for (const spring_link *l = p->link; l < p->link + p->def.links; l++) { /* a < b: see work_equation_applies() */
        L[l->a * column] += s->free[l->a] * l->stiffness;
        L[l->b * column] += s->free[l->b] * l->stiffness;
        L[l->a * column + l->b - l->a] -= s->free[l->a] * s->free[l->b] * l->stiffness;
    }
    for (size_t j = 0; j < n; j++) {
        double *const c = L + j * column;
        c[0] = 1 / sqrt(c[0]);
        for (size_t i = 1; i <= s->width; i++)
            c[i] *= c[0];
        for (size_t k = 1; k <= s->width; k++)
            for (size_t i = k; i <= s->width; i++)
                L[(j + k) * column + i - k] -= c[i] * c[k];
    }
}

/* r = r times the inverse of the matrix */
INLINE void substitute(const work_implicit *s)
{
    const size_t n = s->e->vectors * LANES, column = s->width + LANES;
    double *const r[AXES] = {row_of(s, s->r, 0), row_of(s, s->r, 1), row_of(s, s->r, 2)};
    for (size_t j = 0; j < n; j++) {
        const double *c = s->factor + j * column;
        double y[AXES];
        for (size_t d = 0; d < AXES; d++)
            y[d] = r[d][j] *= c[0];
        for (size_t i = 1; i <= s->width; i += LANES) {
            lanes l, sum;
            LOAD(l, c + i);
            UNROLL
            for (size_t d = 0; d < AXES; d++) {
                LOAD(sum, r[d] + j + i);
                sum -= y[d] * l;
                STORE(r[d] + j + i, sum);
            }
        }
    }
    for (size_t j = n; j-- > 0;) {
        const double *c = s->factor + j * column;
        lanes sum[AXES] = {0};
        for (size_t i = 1; i <= s->width; i += LANES) {
            lanes l, x;
            LOAD(l, c + i);
            UNROLL
            for (size_t d = 0; d < AXES; d++) {
                LOAD(x, r[d] + j + i);
                sum[d] += l * x;
            }
        }
        for (size_t d = 0; d < AXES; d++) {
            const lanes a = sum[d];
            r[d][j] = (r[d][j] - (((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])))) * c[0];
        }
    }
}

/* v = (x - old x)/h */
INLINE void find_velocities(const work_implicit *s)
{
    const double per_h = 1 / s->h;
    for (size_t i = 0; i < AXES * s->stride; i++)
        s->v[i] = per_h * (s->x[i] - s->old_x[i]);
}

INLINE void projective_steps(work_implicit *s, uint64_t n)
{
    const double h = s->h;
    for (uint64_t k = 0; k < n; k++) {
        memcpy(s->old_x, s->x, AXES * s->stride * sizeof *s->x);
        add(s, s->base_x, s->x, h, s->v);
        memcpy(s->x, s->base_x, AXES * s->stride * sizeof *s->x);
        for (int i = 0; i < ITERATIONS; i++) {
            accelerate(s, s->x, s->v);
            find_residual(s, 1, 1 / (h * h), s->base_x, s->x);
            substitute(s);
            add(s, s->x, s->x, 1, s->r);
            find_velocities(s);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- calls */

void work_implicit_start(work_implicit *s, const scene_problem *p, double h, bool projective)
{
    memset(s->x, 0, AXES * s->stride * sizeof *s->x);
    memset(s->v, 0, AXES * s->stride * sizeof *s->v);
    memset(s->delta, 0, AXES * s->stride * sizeof *s->delta);
    s->steps = 0;
    s->h = h;
    for (size_t i = 0; i < AXES * p->def.particles; i++) {
        row_of(s, s->x, i % AXES)[i / AXES] = p->position[i];
        row_of(s, s->v, i % AXES)[i / AXES] = p->velocity[i];
    }
    if (projective)
        factorise(s, p);
}

INLINE void steps(work_implicit *s, uint64_t n, bool projective)
{
    if (projective)
        projective_steps(s, n);
    else
        bdf2_steps(s, n);
}

/* The instruction sets of the kernels of the library. */
#if defined(__x86_64__)
__attribute__((target("avx512f,avx512dq,avx512vl"))) static void with_avx512(work_implicit *s, uint64_t n, bool p)
{
    steps(s, n, p);
}

__attribute__((target("avx2"))) static void with_avx2(work_implicit *s, uint64_t n, bool p)
{
    steps(s, n, p);
}
#endif

static void dispatch(work_implicit *s, uint64_t n, bool projective)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
        with_avx512(s, n, projective);
        return;
    }
    if (__builtin_cpu_supports("avx2")) {
        with_avx2(s, n, projective);
        return;
    }
#endif
    steps(s, n, projective);
}

uint64_t work_bdf2_advance(work_implicit *s, uint64_t n)
{
    dispatch(s, n, false);
    return n;
}

uint64_t work_projective_advance(work_implicit *s, uint64_t n)
{
    dispatch(s, n, true);
    return n * ITERATIONS;
}
