/* SPDX-License-Identifier: MIT */
/* The limits for one vector width and precision; see bench_limits.h. Included by bench_limits.c, which defines SCALAR
   and BYTES, and ROOT if there is an instruction for it. */

typedef SCALAR NAME(real) __attribute__((vector_size(BYTES)));
typedef SCALAR NAME(unaligned) __attribute__((vector_size(BYTES), aligned(sizeof(SCALAR)), may_alias));
#define real NAME(real)

/* ---------------------------------------------------------------------------------------------------------- streams */

INLINE void NAME(stream)(const bench_streams *s, uint64_t times, int parameters)
{
    const size_t vectors = (s->count * sizeof(SCALAR) + BYTES - 1) / BYTES;
    NAME(unaligned) *const x = s->x, *const v = s->v;
    const NAME(unaligned) *const parameter[] = {s->parameter[0], s->parameter[1], s->parameter[2]};
    for (; times > 0; times--) {
        for (size_t i = 0; i < vectors; i++) {
            real xi = x[i], vi = v[i];
            TOUCH(xi);
            TOUCH(vi);
            UNROLL
            for (int k = 0; k < parameters; k++) {
                real p = parameter[k][i];
                TOUCH(p);
            }
            x[i] = xi;
            v[i] = vi;
        }
    }
}

static void NAME(streams)(const bench_streams *s, uint64_t times)
{
    if (s->parameters == 0)
        NAME(stream)(s, times, 0);
    else if (s->parameters == 1)
        NAME(stream)(s, times, 1);
    else if (s->parameters == 2)
        NAME(stream)(s, times, 2);
    else
        NAME(stream)(s, times, 3);
}

static void NAME(read)(const void *memory, size_t bytes, uint64_t times)
{
    const NAME(unaligned) *const from = memory;
    for (; times > 0; times--) {
        for (size_t i = 0; i < (bytes + BYTES - 1) / BYTES; i++) {
            real r = from[i];
            TOUCH(r);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ links */

INLINE real NAME(root)(real a)
{
#ifdef ROOT
    return (real)ROOT(a);
#else
    for (size_t i = 0; i < BYTES / sizeof(SCALAR); i++)
        a[i] = (SCALAR)sqrt((double)a[i]);
    return a;
#endif
}

INLINE void NAME(link)(uint64_t times, int axes)
{
    const real k = (SCALAR)coefficient[0] - (real){0}, rest = (SCALAR)coefficient[1] - (real){0};
    real from[3], to[3], force_from[3], force_to[3];
    UNROLL
    for (int a = 0; a < axes; a++) {
        from[a] = (SCALAR)start[0] - (real){0};
        to[a] = (SCALAR)start[1] - (real){0};
        force_from[a] = force_to[a] = (real){0};
    }
    for (; times > 0; times--) {
        real delta[3], square = {0};
        UNROLL
        for (int a = 0; a < axes; a++) {
            TOUCH(to[a]); /* to the compiler, this is a different link */
            delta[a] = to[a] - from[a];
            square += delta[a] * delta[a];
        }
        const real scale = axes == 1 ? k * (delta[0] - rest) : k * (1 - rest / NAME(root)(square));
        UNROLL
        for (int a = 0; a < axes; a++) {
            const real force = axes == 1 ? scale : scale * delta[a];
            force_from[a] += force;
            force_to[a] -= force;
        }
    }
    UNROLL
    for (int a = 0; a < axes; a++) {
        TOUCH(force_from[a]);
        TOUCH(force_to[a]);
    }
}

static void NAME(links)(uint32_t axes, uint64_t times)
{
    if (axes == 1)
        NAME(link)(times, 1);
    else
        NAME(link)(times, 3);
}

/* ------------------------------------------------------------------------------------------------------- arithmetic */

/* One step of a vector of springs with the coefficients c. */
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

INLINE void NAME(kick_drift)(real *x, real *v, const real *c, bool damped, bool loaded)
{
    *v -= NAME(pull)(x, v, c, damped, loaded);
    *x += c[0] * *v;
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
    (void)damped; /* included in the coefficients */
    const real x0 = *x, v0 = *v;
    *x = c[4] * (c[4] * x0 + c[1] * v0);
    *v = c[4] * (c[4] * v0 - c[2] * x0);
    if (loaded) {
        *x += c[3];
        *v += c[5];
    }
}

enum { NAME(together) = BYTES == 64 ? 12 : 6 }; /* vectors that fit into 32, or 16, registers */

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
        TOUCH(x[k]); /* otherwise the compiler sees that all are equal */
        TOUCH(v[k]);
    }
    for (; steps > 0; steps--) {
        UNROLL
        for (int k = 0; k < NAME(together); k++) {
            step(&x[k], &v[k], c, damped, loaded);
            TOUCH(x[k]); /* otherwise the compiler interleaves steps until registers spill */
            TOUCH(v[k]);
        }
    }
    UNROLL
    for (int k = 0; k < NAME(together); k++) {
        TOUCH(x[k]);
        TOUCH(v[k]);
    }
}

INLINE void NAME(run_with)(NAME(step) * step, uint64_t steps, bool damped, bool loaded)
{
    if (damped && loaded)
        NAME(run)(step, steps, true, true);
    else if (damped)
        NAME(run)(step, steps, true, false);
    else if (loaded)
        NAME(run)(step, steps, false, true);
    else
        NAME(run)(step, steps, false, false);
}

static void NAME(arithmetic)(spring_method m, bool damped, bool loaded, uint64_t steps)
{
    if (m == SPRING_LEAPFROG)
        NAME(run_with)(NAME(leapfrog), steps, damped, loaded);
    else if (m == SPRING_RK4)
        NAME(run_with)(NAME(rk4), steps, damped, loaded);
    else if (m == SPRING_EXACT)
        NAME(run_with)(NAME(exact), steps, damped, loaded);
    else
        NAME(run_with)(NAME(kick_drift), steps, damped, loaded);
}

static const bench_limits NAME(limits) = {
    .springs = NAME(together) * BYTES / sizeof(SCALAR),
    .together = BYTES / sizeof(SCALAR),
    .streams = NAME(streams),
    .read = NAME(read),
    .arithmetic = NAME(arithmetic),
    .links = NAME(links),
};

#undef real
#undef SCALAR
#undef BYTES
#undef ROOT
