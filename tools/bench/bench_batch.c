/* SPDX-License-Identifier: MIT */
/*
 * spring-bench, batches: every method for 10^3 to 10^7 springs, and the cost of each feature, compared with limits from
 * memory bandwidth and arithmetic (bench_limits.h).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/batch.h>

#include "bench_limits.h"
#include "common/cli.h"
#include "common/timing.h"
#include "rows.h"

enum { alignment = 64 }; /* [bytes] the widest vector, and a cache line */

typedef enum sharing { NONE, SHARED, OWN, ZERO } sharing; /* ZERO: an array of zeros, which is not free */

/* The limit of the kernel. */
typedef enum against {
    LIMITS,   /* the kernels of bench_limits.h */
    ORDINARY, /* the same kernel with an ordinary initial state in aligned arrays */
    TEXTBOOK  /* the textbook formula, one spring at a time */
} against;

typedef struct subject {
    spring_method method;
    size_t count;
    uint64_t steps;
    sharing omega2, gamma, accel;
    bool single; /* float */
    against against;
    bool settled, unaligned; /* ORDINARY */
    bool mixed;              /* TEXTBOOK: every second spring overdamped */
} subject;

/* ------------------------------------------------------------------------------------------------------- the memory */

static const double dt = 1e-4; /* [s]; over the minutes that a row simulates, nothing overflows or decays to 0 */

/* Arrays repeat after this number of springs. */
enum { period = 1000 };

typedef struct array {
    void *memory;
    double mean; /* of the values, which vary by a tenth */
    sharing sharing;
} array;

/* x, v, omega2, gamma, accel */
enum { X, V, OMEGA2, GAMMA, ACCEL, arrays };
static array all[arrays] = {
    [X] = {.mean = 0.83, .sharing = OWN},
    [V] = {.mean = -0.59, .sharing = OWN},
    [OMEGA2] = {.mean = 2.1},
    [GAMMA] = {.mean = 0.046},
    [ACCEL] = {.mean = 0.69},
};

static void set(void *memory, bool single, size_t i, double value)
{
    if (single)
        ((float *)memory)[i] = (float)value;
    else
        ((double *)memory)[i] = value;
}

static double get(const void *memory, bool single, size_t i)
{
    return single ? (double)((const float *)memory)[i] : ((const double *)memory)[i];
}

/* So overdamped that no spring settles within minutes. */
static const double overdamped = 1000;

static void fill(const array *a, const subject *s, double scale)
{
    const double odd = s->mixed && a == &all[GAMMA] ? overdamped : 1;
    const size_t element = s->single ? sizeof(float) : sizeof(double);
    char *memory = a->memory;
    for (size_t i = 0; i < period; i++)
        set(memory, s->single, i,
            a->sharing == ZERO ? 0 : scale * a->mean * (i % 2 ? odd : 1) * (1 + 0.1 * (double)(i % 7) / 7));
    for (size_t i = period; i < s->count + alignment; i += period) /* vectors can extend beyond the last spring */
        memcpy(memory + i * element, memory, period * element);
}

/* Prepares the batch, and fills it if it differs from the last one. */
static void prepare(const subject *s, bool settled)
{
    static const subject *filled;
    static bool filled_settled;
    if (s == filled && settled == filled_settled)
        return;
    filled = s;
    filled_settled = settled;
    all[OMEGA2].sharing = s->omega2;
    all[GAMMA].sharing = s->gamma;
    all[ACCEL].sharing = s->accel;
    for (int i = 0; i < arrays; i++) {
        const size_t bytes = (s->count + 2 * period) * sizeof(double);
        static size_t allocated[arrays];
        if (all[i].sharing == NONE)
            continue;
        if (allocated[i] < bytes) {
            free(all[i].memory);
            allocated[i] = (bytes + alignment - 1) / alignment * alignment;
            all[i].memory = aligned_alloc(alignment, allocated[i]);
            if (all[i].memory == NULL)
                cli_fail(CLI_FAILED, "no memory for %zu springs", s->count);
        }
        fill(&all[i], s, settled && i <= V ? 1e-310 : 1); /* denormal */
    }
}

/* -------------------------------------------------------------------------------------------------------- the calls */

static void *start(int i, const subject *s, bool unaligned)
{
    const size_t element = s->single ? sizeof(float) : sizeof(double);
    return all[i].sharing == NONE ? NULL : (char *)all[i].memory + (unaligned ? element : 0);
}

static void advance(const subject *s, bool unaligned, uint64_t calls)
{
    const uint32_t shared = (s->omega2 == SHARED ? SPRING_SHARED_OMEGA2 : 0) |
                            (s->gamma == SHARED ? SPRING_SHARED_GAMMA : 0) |
                            (s->accel == SHARED ? SPRING_SHARED_ACCEL : 0);
    void *a[arrays];
    for (int i = 0; i < arrays; i++)
        a[i] = start(i, s, unaligned);
    const spring_batch b = {s->count, a[X], a[V], a[OMEGA2], a[GAMMA], a[ACCEL], shared};
    const spring_batchf f = {s->count, a[X], a[V], a[OMEGA2], a[GAMMA], a[ACCEL], shared};
    spring_status status = SPRING_OK;
    for (; calls > 0 && status == SPRING_OK; calls--)
        status = s->single ? spring_batchf_advance(&f, s->method, dt, s->steps)
                           : spring_batch_advance(&b, s->method, dt, s->steps);
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "%zu springs: %s", s->count, spring_status_string(status));
}

static void move_streams(const bench_limits *limits, const subject *s, uint64_t calls)
{
    bench_streams streams = {.count = s->count, .x = all[X].memory, .v = all[V].memory};
    for (int i = OMEGA2; i < arrays; i++)
        if (all[i].sharing >= OWN)
            streams.parameter[streams.parameters++] = all[i].memory;
    limits->streams(&streams, calls);
}

static void textbook(const subject *s, uint64_t calls)
{
    const bool damped = s->gamma != NONE, loaded = s->accel != NONE, single = s->single;
    for (; calls > 0; calls--) {
        for (size_t i = 0; i < s->count; i++) {
            const spring_state y =
                bench_textbook((spring_state){get(all[X].memory, single, i), get(all[V].memory, single, i)},
                               get(all[OMEGA2].memory, single, i), damped ? get(all[GAMMA].memory, single, i) : 0,
                               loaded ? get(all[ACCEL].memory, single, i) : 0, dt, damped, loaded);
            set(all[X].memory, single, i, y.x);
            set(all[V].memory, single, i, y.v);
        }
    }
}

static double run(const bench_row *row, int which, uint64_t calls)
{
    const subject *s = row->subject;
    const bench_limits *limits = bench_limits_of(s->single);
    const double springs = (double)s->count * (double)s->steps / (double)limits->springs * (double)calls;
    const uint64_t steps = (uint64_t)springs + 1; /* of the arithmetic kernel, for the same number of springs */
    const bool as_it_is = which == 0;
    prepare(s, as_it_is && s->settled);
    const double begin = timing_busy();
    if (as_it_is || s->against == ORDINARY)
        advance(s, as_it_is && s->unaligned, calls);
    else if (s->against == TEXTBOOK)
        textbook(s, calls);
    else if (which == 1)
        move_streams(limits, s, calls);
    else
        limits->arithmetic(s->method, s->gamma != NONE, s->accel != NONE, steps);
    const double elapsed = timing_busy() - begin;
    return which == 2 ? elapsed * springs / (double)steps : elapsed;
}

/* --------------------------------------------------------------------------------------------------------- the rows */

/* Ratios to the limit in the same run: one step over springs in memory, and several steps. */
static const double memory_goal = 1 / 0.88, memory_goal_rk4 = 1 / 0.85, steps_goal = 1 / 0.8;
enum { from_memory = 10000000, in_cache = 1000 };

static void add(const char *feature, subject s)
{
    const bool limited = s.against == LIMITS;
    bench_row row = {
        .part = "batch",
        .precision = s.single ? "float" : "double",
        .count = s.count,
        .steps = s.steps,
        .goal_ratio = !limited                 ? INFINITY
                      : s.steps > 1            ? steps_goal
                      : s.count != from_memory ? INFINITY
                      : s.method == SPRING_RK4 ? memory_goal_rk4
                                               : memory_goal,
        .goal_ns = INFINITY,
        .limits = {limited                 ? "streams"
                   : s.against == ORDINARY ? "ordinary"
                                           : "textbook",
                   limited ? "arithmetic" : NULL},
        .time = run,
    };
    snprintf(row.kernel, sizeof row.kernel, "%s_batch_%d%s", spring_method_name(s.method), (int)s.steps, feature);
    bench_add(&row, &s, sizeof s);
}

static void add_counts(spring_method m, uint64_t steps)
{
    const bool exact = m == SPRING_EXACT; /* with own stiffnesses: see add_special() */
    for (int single = 0; single < 2; single++)
        for (size_t count = in_cache; count <= from_memory; count *= 10)
            add(exact ? "_shared_omega2" : "", (subject){m, count, steps, exact ? SHARED : OWN, .single = single});
}

/* Adds every method, at every count, in both precisions. */
static void add_methods(void)
{
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        const spring_method_info *info = spring_method_describe(m);
        if (!info->springs)
            continue;
        add_counts(m, 1);
        if (info->order > 0)
            add_counts(m, 16);
    }
}

static const spring_method accurate[] = {SPRING_LEAPFROG, SPRING_RK4};

/* Adds the features one by one. */
static void add_features(void)
{
    static const struct {
        const char *name;
        sharing omega2, gamma, accel;
    } features[] = {
        {"_shared_omega2", SHARED, NONE, NONE}, {"_shared_gamma", OWN, SHARED, NONE},
        {"_own_gamma", OWN, OWN, NONE},         {"_shared_accel", OWN, NONE, SHARED},
        {"_own_accel", OWN, NONE, OWN},         {"_own_gamma_accel", OWN, OWN, OWN},
        {"_zero_gamma_accel", OWN, ZERO, ZERO},
    };
    static const struct {
        size_t count;
        uint64_t steps;
    } at[] = {{in_cache, 16}, {in_cache, 1}, {from_memory, 1}};
    for (size_t k = 0; k < sizeof accurate / sizeof accurate[0]; k++)
        for (size_t i = 0; i < sizeof at / sizeof at[0]; i++)
            for (size_t f = 0; f < sizeof features / sizeof features[0]; f++)
                add(features[f].name, (subject){.method = accurate[k],
                                                .count = at[i].count,
                                                .steps = at[i].steps,
                                                .omega2 = features[f].omega2,
                                                .gamma = features[f].gamma,
                                                .accel = features[f].accel});
}

static void add_special(void)
{
    for (int single = 0; single < 2; single++) {
        const subject undamped = {SPRING_EXACT, in_cache, 1, OWN, .single = single, .against = TEXTBOOK};
        subject exact = undamped;
        add("", exact);
        exact.gamma = OWN;
        add("_own_gamma", exact);
        exact.mixed = true;
        add("_own_gamma_mixed", exact);
        exact.mixed = false;
        exact.accel = OWN;
        add("_own_gamma_accel", exact);
    }
    for (size_t i = 0; i < sizeof accurate / sizeof accurate[0]; i++)
        add("_settled", (subject){accurate[i], in_cache, 16, OWN, .against = ORDINARY, .settled = true});
    add("_unaligned", (subject){SPRING_LEAPFROG, in_cache, 1, OWN, .against = ORDINARY, .unaligned = true});
}

void bench_add_batches(void)
{
    add_methods();
    add_features();
    add_special();
}
