/* SPDX-License-Identifier: MIT */
/* The limits in one vector and precision; see bench_limits.h. Included by bench_limits.c with SCALAR and BYTES set. */

typedef SCALAR NAME(real) __attribute__((vector_size(BYTES)));
typedef SCALAR NAME(unaligned) __attribute__((vector_size(BYTES), aligned(sizeof(SCALAR)), may_alias));
#define real NAME(real)

/* ---------------------------------------------------------------------------------------------------------- streams */

INLINE void NAME(stream)(const bench_streams *s, uint64_t times, bool w, bool g, bool a)
{
    const size_t vectors = (s->count * sizeof(SCALAR) + BYTES - 1) / BYTES;
    NAME(unaligned) *const x = s->x, *const v = s->v;
    const NAME(unaligned) *const parameter[] = {s->w, s->g, s->a};
    const bool there[] = {w, g, a};
    for (; times > 0; times--) {
        for (size_t i = 0; i < vectors; i++) {
            real xi = x[i], vi = v[i];
            TOUCH(xi);
            TOUCH(vi);
            UNROLL
            for (int k = 0; k < 3; k++) {
                if (there[k]) {
                    real p = parameter[k][i];
                    TOUCH(p);
                }
            }
            x[i] = xi;
            v[i] = vi;
        }
    }
}

#define STREAM(w, g, a)                                                        \
    static void NAME(stream_##w##g##a)(const bench_streams *s, uint64_t times) \
    {                                                                          \
        NAME(stream)(s, times, w, g, a);                                       \
    }
STREAM(0, 0, 0)
STREAM(0, 0, 1)
STREAM(0, 1, 0)
STREAM(0, 1, 1)
STREAM(1, 0, 0)
STREAM(1, 0, 1)
STREAM(1, 1, 0)
STREAM(1, 1, 1)
#undef STREAM

/* ------------------------------------------------------------------------------------------------------- arithmetic */

/* One step of a vector of springs; c holds the coefficients, whatever they are called. */
typedef void NAME(step)(real *x, real *v, const real *c, bool damped, bool loaded);

INLINE real NAME(pull)(const real *x, const real *v, const real *c, bool damped, bool loaded)
{
    real pull = c[1] * *x;
    if (loaded)
        pull -= c[2];
    if (damped)
        pull += c[3] * *v;
    return pull;
}

INLINE void NAME(euler)(real *x, real *v, const real *c, bool damped, bool loaded)
{
    const real pull = NAME(pull)(x, v, c, damped, loaded);
    *x += c[0] * *v;
    *v -= pull;
}

INLINE void NAME(leapfrog)(real *x, real *v, const real *c, bool damped, bool loaded)
{
    *v -= NAME(pull)(x, v, c, damped, loaded);
    *x += c[0] * *v;
    *v -= NAME(pull)(x, v, c, false, loaded);
    if (damped)
        *v = c[4] * *v + c[5] * *v;
}

INLINE void NAME(rk4)(real *x, real *v, const real *c, bool damped, bool loaded)
{
    real dx = c[2] * *x + c[3] * *v, dv = c[5] * *x + c[2] * *v;
    if (loaded) {
        dx -= c[3];
        dv -= c[5];
    }
    const real pull = NAME(pull)(x, v, c, damped, loaded);
    *x += c[0] * *v + dx;
    *v += dv - pull;
}

INLINE void NAME(exact)(real *x, real *v, const real *c, bool damped, bool loaded)
{
    (void)damped; /* in the coefficients */
    const real x0 = *x, v0 = *v;
    *x = c[4] * (c[4] * x0 + c[1] * v0);
    *v = c[4] * (c[4] * v0 - c[2] * x0);
    if (loaded) {
        *x += c[3];
        *v += c[5];
    }
}

enum { NAME(together) = BYTES == 64 ? 12 : 6 }; /* vectors: more do not fit into 32, or 16, registers */

INLINE void NAME(run)(NAME(step) * step, uint64_t steps, bool damped, bool loaded)
{
    real c[6], x[NAME(together)], v[NAME(together)];
    UNROLL
    for (int i = 0; i < 6; i++)
        c[i] = (SCALAR)coefficient[i] - (real){0};
    UNROLL
    for (int k = 0; k < NAME(together); k++) {
        x[k] = (SCALAR)start[0] - (real){0};
        v[k] = (SCALAR)start[1] - (real){0};
        TOUCH(x[k]); /* or all would be found to be the same */
        TOUCH(v[k]);
    }
    for (; steps > 0; steps--) {
        UNROLL
        for (int k = 0; k < NAME(together); k++) {
            step(&x[k], &v[k], c, damped, loaded);
            TOUCH(x[k]); /* or the compiler interleaves so many steps that registers run out */
            TOUCH(v[k]);
        }
    }
    UNROLL
    for (int k = 0; k < NAME(together); k++) {
        TOUCH(x[k]);
        TOUCH(v[k]);
    }
}

#define RUN(method, damped, loaded)                             \
    static void NAME(method##_##damped##loaded)(uint64_t steps) \
    {                                                           \
        NAME(run)(NAME(method), steps, damped, loaded);         \
    }
#define RUNS(method) RUN(method, 0, 0) RUN(method, 0, 1) RUN(method, 1, 0) RUN(method, 1, 1)
RUNS(euler)
RUNS(leapfrog)
RUNS(rk4)
RUNS(exact)
#undef RUNS
#undef RUN

#define RUNS(method)                             \
    {                                            \
        {NAME(method##_00), NAME(method##_01)},  \
        {                                        \
            NAME(method##_10), NAME(method##_11) \
        }                                        \
    }
static const bench_limits NAME(limits) = {
    .springs = NAME(together) * BYTES / sizeof(SCALAR),
    .streams = {{{NAME(stream_000), NAME(stream_001)}, {NAME(stream_010), NAME(stream_011)}},
                {{NAME(stream_100), NAME(stream_101)}, {NAME(stream_110), NAME(stream_111)}}},
    .arithmetic = {RUNS(euler), RUNS(leapfrog), RUNS(rk4), RUNS(exact)}, /* in the order of spring_method */
};
#undef RUNS

#undef real
#undef SCALAR
#undef BYTES
