/* SPDX-License-Identifier: MIT */
/* A scene across calls: time, callbacks, failures, reading and changing the state. test_random.c tests that runs do not
   depend on how they are divided into calls. */
#include "test_scene.h"

static const uint32_t sheet[] = {7, 5, 1};

/* ---------------------------------------------------------------------------------------------------- callbacks */

enum { most_calls = 100 };

typedef struct wind {
    uint32_t axes;
    size_t calls;
    double times[most_calls];
} wind;

/* A force that depends on time and place. */
static void blow(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                 scalar *const force[3])
{
    wind *w = user;
    (void)v;
    for (uint32_t a = 0; a < w->axes; a++)
        for (size_t i = 0; i < particles; i++)
            force[a][i] += (scalar)(0.8 * sin(5000 * t + (double)i) - 0.2 * sin((double)x[a][i]));
    if (w->calls < most_calls)
        w->times[w->calls] = t;
    w->calls++;
}

static wind calm(uint32_t axes)
{
    return (wind){.axes = axes};
}

/* Eight steps with a callback: how often it is called, and at what times. */
static void check_calls(const spring_scene_def *def, wind *w, spring_method method)
{
    const double dt = 0.0137;
    const bool still = def->flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY, leapfrog = method == SPRING_LEAPFROG;
    const size_t forces = (size_t)spring_method_describe(method)->forces_per_step;
    const size_t a_step = leapfrog && !still ? 2 : forces; /* leapfrog predicts velocities, and keeps no force */
    *w = calm(def->axes);
    spring_scene *s = scene_of(def);
    CHECK(spring_scene_advance(s, method, dt, 1) == SPRING_OK, "stable");
    const size_t first = w->calls;
    CHECK(first == a_step + (still && keeps_force(method)), "the first step has no force from the step before");
    CHECK(spring_scene_advance(s, method, dt, 7) == SPRING_OK, "stable");
    CHECK(w->calls - first == 7 * a_step, "as often as scene.h says");
    CHECK_BITS(w->times[0], 0, "the time of the start");
    for (size_t c = 0; c < w->calls; c++) {
        const double start = dt * (double)(c / a_step), rounded = 2 * DBL_EPSILON * 8 * dt;
        if (a_step == 1)
            CHECK_BITS(w->times[c], (double)c * dt, "step i is at t0 + i dt");
        else
            CHECK(w->times[c] >= start - rounded && w->times[c] <= start + dt + rounded, "within its step");
        if (method == SPRING_RK4)
            CHECK_CLOSE(w->times[c],
                        start + (c % 4 == 0   ? 0
                                 : c % 4 == 3 ? dt
                                              : dt / 2),
                        rounded, "nodes 0, 1/2, 1/2, 1");
    }
    if (keeps_force(method))
        CHECK_CLOSE(w->times[w->calls - 1], 8 * dt, 2 * DBL_EPSILON * 8 * dt, "its last force is at the end");
    free(s);
}

static void callback_counts(void)
{
    static model m;
    wind w;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned still = 0; still < 2; still++) {
            build(&m, sheet, axes, DRAG | GRAVITY);
            m.def.flags = still ? SPRING_SCENE_FORCE_IGNORES_VELOCITY : 0;
            m.def.force = blow;
            m.def.user = &w;
            const method_list all = use_all_methods(&m.def);
            for (const spring_method *method = all.at; *method != no_method; method++)
                check_calls(&m.def, &w, *method);
        }
}

/* Calls that cost no evaluation: changes of held forces, a driven particle where no force sees its velocity, links that
   do not tear or lose their damping. */
static void evaluations(void)
{
    static model m;
    static double force[3 * most];
    wind w = calm(3);
    build(&m, sheet, 3, EDITABLE | PINNED | DAMPED);
    m.pinned[3] = 1;
    m.def.flags |= SPRING_SCENE_FORCES | SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    m.def.force = blow;
    m.def.user = &w;
    spring_scene *s = scene_of(&m.def);
    for (size_t i = 0; i < m.def.links; i++) {
        m.link[i].damping = 0;
        spring_scene_set_link(s, i, &m.link[i]);
    }
    spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 4);
    CHECK(w.calls == 1 + 4, "nothing left that uses velocities: one evaluation a step");
    for (int frame = 0; frame < 5; frame++) {
        const double target[] = {1, 2, 0.1 * frame};
        for (size_t i = 0; i < 3 * m.def.particles; i++)
            force[i] = random_uniform(-1, 1);
        CHECK(spring_scene_set(s, SPRING_FORCE, force, 0, 0, m.def.particles) == SPRING_OK &&
                  spring_scene_drive(s, 3, target, 4e-3) == SPRING_OK &&
                  spring_scene_tear(s, 1e3, NULL, NULL, 0, NULL) == SPRING_OK &&
                  spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 4) == SPRING_OK,
              "stable");
    }
    CHECK(w.calls == 1 + 4 + 5 * 4, "one a step");
    m.link[0].damping = 0.1;
    spring_scene_set_link(s, 0, &m.link[0]);
    spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 4);
    CHECK(w.calls == 1 + 4 + 5 * 4 + 1 + 4, "velocities are predicted from the forces that are kept");
    CHECK(spring_scene_tear(s, 0.1, NULL, NULL, 0, NULL) == SPRING_OK &&
              spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 1) == SPRING_OK && w.calls == 1 + 4 + 5 * 4 + 1 + 4 + 2,
          "torn links: the force is evaluated again");
    free(s);
}

/* A method of positions only refuses what it cannot do, when it has become so, and changes nothing. */
static void velocities_refused(void)
{
    static model m;
    wind w = calm(2);
    build(&m, sheet, 2, EDITABLE | DRAG);
    m.def.methods = 1u << SPRING_RKN8 | 1u << SPRING_LEAPFROG;
    spring_scene *s = scene_of(&m.def), *other = scene_of(&m.def);
    for (int round = 0; round < 2; round++) {
        CHECK(spring_scene_advance(s, SPRING_RKN8, 0.009, 3) == SPRING_OK &&
                  spring_scene_advance(other, SPRING_RKN8, 0.009, 3) == SPRING_OK,
              "no velocities");
        spring_link damped = m.link[5];
        damped.damping = 0.1;
        spring_scene_set_link(s, 5, &damped);
        CHECK(spring_scene_advance(s, SPRING_RKN8, 0.009, 3) == SPRING_EUNSUPPORTED &&
                  spring_scene_advance(s, SPRING_RKN8, 0.009, 0) == SPRING_EUNSUPPORTED,
              "a damped link");
        spring_scene_set_link(s, 5, &m.link[5]);
        spring_scene_set_force(s, blow, &w);
        CHECK(spring_scene_advance(s, SPRING_RKN8, 0.009, 3) == SPRING_EUNSUPPORTED && w.calls == 0,
              "a callback that has promised nothing");
        spring_scene_set_force(s, NULL, NULL);
        CHECK(same_bits(s, other, m.def.particles, 2) && spring_scene_time(s) == spring_scene_time(other),
              "nothing has changed");
    }
    free(s);
    free(other);
}

/* ------------------------------------------------------------------------------------------------------------ time */

static void time_is_not_accumulated(void)
{
    const double x[] = {0.3, 1.1};
    const spring_scene_def def = {.axes = 1, .particles = 2, .position = x};
    spring_scene *s = scene_of(&def);
    CHECK_BITS(spring_scene_time(s), 0, "time starts at 0");
    const double dt = 0.1, later = -0.03;
    for (int i = 0; i < 1000; i++)
        spring_scene_advance(s, i % 2 ? SPRING_LEAPFROG : SPRING_EULER, dt, 3);
    CHECK_BITS(spring_scene_time(s), 3000 * dt, "t0 + i dt");
    spring_scene_advance(s, SPRING_EULER, later, 7);
    CHECK_BITS(spring_scene_time(s), 3000 * dt + 7 * later, "with another dt a run starts where the one before ended");
    spring_scene_advance(s, SPRING_EULER, later, 0);
    spring_scene_advance(s, SPRING_EULER, 0, 5);
    spring_scene_advance(s, SPRING_EULER, later, 2);
    CHECK_BITS(spring_scene_time(s), 3000 * dt + 9 * later, "no steps, or of length 0, are none");
    CHECK(isnan(spring_scene_time(NULL)), "bad input");
    free(s);
}

static void time_stays_finite(void)
{
    const double position[] = {0, 0, 0};
    const spring_scene_def def = {.particles = 1, .position = position};
    spring_scene *s = scene_of(&def);
#ifdef SPRING_FLOAT
    const double dt = 1e38, tiny = 1e-50; /* is 0 as a float */
#else
    const double dt = 1e308, tiny = 0;
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 10) == SPRING_ENONFINITE, "the time would be infinite");
    CHECK_BITS(spring_scene_time(s), 0, "nothing happened");
#endif
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK, "one such step is possible");
    CHECK_BITS(spring_scene_time(s), dt, "dt");
#ifndef SPRING_FLOAT
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_ENONFINITE, "a second one of the same run is not");
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, -dt, 1) == SPRING_OK && spring_scene_time(s) == 0, "back it may go");
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK, "and forth");
#endif
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, tiny, 3) == SPRING_OK, "a step that is no step in this precision");
    CHECK_BITS(spring_scene_time(s), dt, "takes no time");
    free(s);
}

/* -------------------------------------------------------------------------------------------------------- failures */

typedef struct bad_call {
    unsigned calls, bad; /* the number of the call that gives NaN, from 1 on; 0: none */
} bad_call;

static void sometimes_nan(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                          scalar *const force[3])
{
    bad_call *b = user;
    (void)t, (void)v;
    b->calls++;
    for (size_t i = 0; i < particles; i++)
        force[0][i] += b->calls == b->bad ? (scalar)NAN : (scalar)0.1 * x[1][i];
}

/* RKN8 evaluates the last force of a call for the next call alone. */
static void recovers_from_a_bad_force(void)
{
    static model m;
    build(&m, sheet, 3, EDITABLE | MASSES);
    bad_call never = {0}, once = {0, 1 + 8};
    m.def.force = sometimes_nan;
    m.def.flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    m.def.methods = 1u << SPRING_RKN8 | 1u << SPRING_LEAPFROG;
    m.def.user = &never;
    spring_scene *good = scene_of(&m.def);
    m.def.user = &once;
    spring_scene *bad = scene_of(&m.def);
    CHECK(spring_scene_advance(bad, SPRING_RKN8, 0.0137, 1) == SPRING_OK, "the state is finite");
    CHECK(spring_scene_advance(bad, SPRING_RKN8, 0.0137, 1) == SPRING_ENONFINITE, "the force at its start is not");
    CHECK(spring_scene_advance(bad, SPRING_RKN8, 0.0137, 1) == SPRING_OK, "the callback is asked again");
    spring_scene_advance(good, SPRING_RKN8, 0.0137, 2);
    CHECK(same_bits(bad, good, m.def.particles, 3), "as if nothing had happened");
    free(good);
    free(bad);
}

/* The last kick of leapfrog overflows where all before it was finite: stiffness times the distance of a step. */
static void velocity_alone_overflows(void)
{
    const double large = sizeof(scalar) == 4 ? 1e20 : 1e160; /* its square is infinite */
    const double x[] = {0, 0.5}, v[] = {0, large};
    const uint8_t pinned[] = {1, 0};
    for (unsigned damped = 0; damped < 2; damped++) {
        const spring_link link = {0, 1, 0.5, large, damped ? 1e-3 : 0, 0};
        const spring_scene_def def = {
            .axes = 1, .particles = 2, .links = 1, .position = x, .velocity = v, .pinned = pinned, .link = &link};
        spring_scene *s = scene_of(&def), *twin = scene_of(&def);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1, 1) == SPRING_ENONFINITE, "noticed in the same step");
        CHECK(same_bits(s, twin, 2, 1), "as it was");
        free(s);
        free(twin);
    }
}

static void push_without_end(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                             scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v;
    force[0][0] = INFINITY;
}

/* A pin feels no force, of whatever size. */
static void infinite_force_on_a_pin(void)
{
    const double position[] = {0.2, 0, 0, 1.1, 0, 0}, velocity[] = {0.3, 0, 0, 0, 0, 0};
    const uint8_t pinned[] = {1, 0};
    spring_scene_def def = {
        .particles = 2, .position = position, .velocity = velocity, .pinned = pinned, .force = push_without_end};
    const method_list all = use_all_methods(&def);
    for (const spring_method *m = all.at; *m != no_method; m++) {
        spring_scene *s = scene_of(&def);
        CHECK(spring_scene_advance(s, *m, 0.1, 5) == SPRING_OK, "the pin does not feel it");
        double x[3];
        spring_scene_get(s, SPRING_POSITION, x, 0, 0, 1);
        CHECK_CLOSE(x[0], 0.2 + 5 * 0.1 * 0.3, 6 * EPS, "a straight line, rounded once a step");
        free(s);
    }
}

/* ----------------------------------------------------------------------------------------------- reading and setting */

/* Into the middle of vertices, and back from there. */
static void strides_and_ranges(void)
{
    static model m;
    static float vertex[8 * most];
    static double wide[8 * most], before[3][3 * most], back[3 * most];
    const float outside = -77;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        build(&m, sheet, axes, 0);
        m.def.flags = SPRING_SCENE_FORCES;
        const size_t n = m.def.particles, stride = axes + 4, first = 3, count = n - 5;
        spring_scene *s = scene_of(&m.def);
        for (spring_quantity q = SPRING_POSITION; q <= SPRING_FORCE; q++) {
            spring_scene_get(s, q, before[q], 0, 0, n);
            for (size_t i = 0; i < n * axes && q == SPRING_FORCE; i++)
                CHECK_BITS(before[q][i], 0, "at first nothing is held");
        }
        for (spring_quantity q = SPRING_POSITION; q <= SPRING_FORCE; q++) {
            for (size_t i = 0; i < stride * n; i++)
                wide[i] = (double)(vertex[i] = outside);
            CHECK(spring_scene_getf(s, q, vertex + 1, stride, first, count) == SPRING_OK &&
                      spring_scene_get(s, q, wide + 1, stride, first, count) == SPRING_OK,
                  "into the middle of vertices");
            for (size_t i = 0; i < stride * n; i++) {
                const size_t particle = first + i / stride, axis = i % stride - 1; /* wraps around: no axis */
                const bool inside = i / stride < count && axis < axes;
                const double now = inside ? before[q][particle * axes + axis] : (double)outside;
                CHECK_BITS((double)vertex[i], (double)(float)now, "one rounding");
                CHECK_BITS(wide[i], now, "no rounding");
                wide[i] += 0.3;
            }
            for (size_t i = first * axes; i < (first + count) * axes; i++)
                before[q][i] = (double)(scalar)(before[q][i] + 0.3);
            CHECK(spring_scene_set(s, q, wide + 1, stride, first, count) == SPRING_OK, "back from there");
            for (spring_quantity other = SPRING_POSITION; other <= SPRING_FORCE; other++) {
                spring_scene_get(s, other, back, 0, 0, n);
                CHECK(memcmp(back, before[other], n * axes * sizeof back[0]) == 0, "these numbers and no others");
            }
        }
        for (size_t i = 0; i < n * axes; i++) {
            CHECK_BITS(before[SPRING_POSITION][i],
                       (double)(scalar)((double)(scalar)m.position[i] +
                                        (i / axes >= first && i / axes < first + count ? 0.3 : 0)),
                       "rounded to the precision of the scene");
        }
        free(s);
    }
}

/* Which mass a particle has that was defined as pinned. */
static void masses_of_the_freed(void)
{
    const double x[] = {0, 1, 2}, mass[] = {0, 0.4, -3};
    const uint8_t pinned[] = {1, 1, 1}, freed[] = {0};
    const spring_link link[] = {{0, 1, 0.5, 3, 0, 0}, {1, 2, 0.5, 3, 0, 0}};
    const struct {
        const double *mass;
        double all, want[3];
    } cases[] = {
        {NULL, 0, {1, 1, 1}}, {NULL, 0.7, {0.7, 0.7, 0.7}}, {mass, 0.7, {0.7, 0.4, 0.7}}, {mass, 0, {1, 0.4, 1}}};
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++)
        for (size_t i = 0; i < 3; i++) {
            spring_scene_def def = joined(1, 3, x, NULL, 2, link);
            def.flags = SPRING_SCENE_EDITABLE, def.pinned = pinned;
            def.mass = cases[c].mass, def.mass_all = cases[c].all;
            spring_scene *s = scene_of(&def);
            const double speed[] = {2};
            spring_scene_set(s, SPRING_VELOCITY, speed, 0, i, 1);
            CHECK_BITS(spring_scene_energy(s).kinetic, 0, "a pinned one has none");
            CHECK(spring_scene_set_pinned(s, i, 1, freed) == SPRING_OK, "freed");
            CHECK_CLOSE(spring_scene_energy(s).kinetic, 2 * cases[c].want[i], 4 * EPS,
                        "its mass, and it keeps its speed");
            free(s);
        }
}

static bool joins(const spring_link *link, uint32_t a, uint32_t b)
{
    return (link->a == a && link->b == b) || (link->a == b && link->b == a);
}

static void links_found(void)
{
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 3) {
            build(&m, (uint32_t[]){4, 3, 5}, axes, features);
            spring_scene *s = scene_of(&m.def);
            for (size_t i = 0; i < m.def.links; i += 7) {
                const spring_link *want = &m.link[i];
                spring_link link;
                CHECK(spring_scene_get_link(s, i, &link) == SPRING_OK, "there is one");
                CHECK(link.a == want->a && link.b == want->b ? true : axes > 1 && joins(&link, want->a, want->b),
                      "between the same, on one axis in the same direction");
                CHECK(link.rest == (scalar)want->rest && link.stiffness == (scalar)want->stiffness &&
                          link.damping == (scalar)want->damping,
                      "as defined");
                size_t least = 0;
                while (!joins(&m.link[least], want->a, want->b))
                    least++;
                CHECK(spring_scene_find_link(s, want->a, want->b) == least &&
                          spring_scene_find_link(s, want->b, want->a) == least,
                      "the first between these two");
                const spring_link cut = {want->a, want->b, 1, 0, 0, 0};
                if (features & EDITABLE && spring_scene_set_link(s, i, &cut) == SPRING_OK)
                    CHECK(spring_scene_find_link(s, want->a, want->b) == least, "cut ones, too");
            }
            free(s);
        }
}

/* ---------------------------------------------------------------------------------------------------- calls that fail */

#define REFUSES(status, call)                                            \
    do {                                                                 \
        memcpy(before, s, bytes);                                        \
        CHECK((call) == (status), "refused");                            \
        CHECK(memcmp(s, before, bytes) == 0, "and nothing has changed"); \
    } while (0)

/* Particles 0 and 1 are pinned; 0 has a mass that is not valid. Links 2 and 4 just bear the masses of their ends, and
   drag that of the particles. */
static void refused_calls(void)
{
    enum { n = 14, links = n - 1 };
    const double huge = sizeof(scalar) == 4 ? 1e38 : 1e307, tiny = 1e-310, light = 0.01;
    double x[3 * n] = {0}, mass[n] = {tiny}, out[3 * n], limit[links];
    float outf[3 * n];
    uint8_t pinned[n] = {1, 1};
    const uint8_t free_all[n] = {0};
    const spring_collider ball = {.shape = SPRING_SPHERE};
    uint32_t torn[1] = {77};
    size_t bytes, count = 9;
    spring_link link[links];
    for (uint32_t i = 0; i < n; i++) {
        x[3 * i] = i;
        mass[i] = i == 0 ? tiny : 1;
        if (i < links)
            link[i] = (spring_link){i, i + 1, 0.5, i == 2 ? huge : 3, i == 4 ? huge : 0, 0}, limit[i] = 1;
    }
    spring_scene_def def = joined(3, n, x, NULL, links, link);
    def.flags = SPRING_SCENE_EDITABLE, def.methods = 1u << SPRING_LEAPFROG, def.colliders = 1;
    def.mass = mass, def.pinned = pinned;
    spring_scene *s = scene_of(&def);
    spring_scene_bytes(&def, &bytes);
    void *before = malloc(bytes);
    spring_scene_advance(s, SPRING_LEAPFROG, 0, 1);

    /* invalid numbers */
    const double bad[] = {NAN, INFINITY, -1, 0, tiny};
    for (int i = 0; i < 5; i++) {
        const double several[] = {2, 2, bad[i]}, place[] = {0, 0, i < 2 ? bad[i] : NAN};
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 2, 1, &bad[i]));
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 0, 1, &bad[i])); /* of a pinned particle */
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 5, 3, several));
        REFUSES(SPRING_EINVAL, spring_scene_set(s, SPRING_POSITION, place, 0, n - 1, 1));
        REFUSES(SPRING_EINVAL, spring_scene_set(s, SPRING_VELOCITY, place, 0, 3, 1));
        REFUSES(SPRING_EINVAL, spring_scene_set_gravity(s, place));
        REFUSES(SPRING_EINVAL, spring_scene_drive(s, 0, place, 1));
        if (i < 4)
            REFUSES(SPRING_EINVAL, spring_scene_drive(s, 0, x, bad[i]));
        if (i < 2)
            REFUSES(SPRING_EINVAL, spring_scene_advance(s, SPRING_LEAPFROG, bad[i], 1));
        for (int k = 0; k < 4 && i < 3; k++) {
            spring_link last[] = {{links - 2, links - 1, 0.3, 2, 0, 0}, link[links - 1]}; /* the first is valid */
            double *const number[] = {&last[1].rest, &last[1].stiffness, &last[1].damping,
                                      &limit[k % 2 ? 0 : links - 1]};
            *number[k] = bad[i];
            if (k < 3)
                REFUSES(SPRING_EINVAL, spring_scene_set_links(s, links - 2, 2, last));
            else if (bad[i] < INFINITY || isnan(bad[i]))
                REFUSES(SPRING_EINVAL, spring_scene_tear(s, 1, limit, torn, 1, &count));
            limit[0] = limit[links - 1] = 1;
        }
        for (int k = 0; k < 12 && i < 2; k++) {
            double matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
            matrix[k] = bad[i];
            REFUSES(SPRING_EINVAL, spring_scene_transform(s, matrix));
        }
    }
    const double farther[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, huge, huge * 10}, far[] = {0, 0, 10};
    spring_scene_set(s, SPRING_POSITION, far, 0, n - 1, 1);
    REFUSES(SPRING_ENONFINITE, spring_scene_transform(s, farther)); /* the last particle */
    REFUSES(SPRING_EINVAL, spring_scene_drive(s, 0, &huge, tiny));
    REFUSES(SPRING_EINVAL, spring_scene_drive(s, 4, x, 1)); /* not pinned */
    REFUSES(SPRING_EINVAL, spring_scene_drive(s, 4, NULL, 1));
    REFUSES(SPRING_EINVAL, spring_scene_tear(s, -1, NULL, torn, 1, &count));
    REFUSES(SPRING_EINVAL, spring_scene_tear(s, NAN, NULL, torn, 1, &count));

    /* numbers that overflow with others */
    REFUSES(SPRING_EINVAL, spring_scene_set_pinned(s, 0, 2, free_all)); /* the mass of the first */
    for (size_t i = 2; i <= 5; i++)
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, i, 1, &light)); /* for a link at either end */
    const spring_link stiff = {6, 7, 1, 20 * huge, 0, 0},
                      ends[] = {{6, 8, 1, 1, 0, 0}, {5, 7, 1, 1, 0, 0}, {6, 6, 1, 1, 0, 0}};
    REFUSES(SPRING_EINVAL, spring_scene_set_link(s, 6, &stiff));
    for (int i = 0; i < 3; i++)
        REFUSES(SPRING_EINVAL, spring_scene_set_link(s, 6, &ends[i]));

    /* ranges, strides, quantities, methods */
    const struct {
        size_t first, count;
    } beyond[] = {{1, n}, {n + 1, 0}, {n, 1}, {2, SIZE_MAX}, {SIZE_MAX, 2}};
    for (int i = 0; i < 5; i++) {
        const size_t first = beyond[i].first, number = beyond[i].count;
        REFUSES(SPRING_ERANGE, spring_scene_get(s, SPRING_POSITION, out, 0, first, number));
        REFUSES(SPRING_ERANGE, spring_scene_getf(s, SPRING_POSITION, outf, 0, first, number));
        REFUSES(SPRING_ERANGE, spring_scene_set(s, SPRING_POSITION, x, 0, first, number));
        REFUSES(SPRING_ERANGE, spring_scene_set_pinned(s, first, number, pinned));
        REFUSES(SPRING_ERANGE, spring_scene_set_mass(s, first, number, mass));
        REFUSES(SPRING_ERANGE, spring_scene_set_links(s, first - (first == n), number, link));
        REFUSES(SPRING_ERANGE, spring_scene_touching(s, torn, first, number));
    }
    REFUSES(SPRING_ERANGE, spring_scene_set_link(s, links, link));
    REFUSES(SPRING_ERANGE, spring_scene_get_link(s, links, link));
    REFUSES(SPRING_ERANGE, spring_scene_drive(s, n, x, 1));
    for (int i = 0; i < 2; i++) {
        const spring_quantity q = i ? SPRING_POSITION : (spring_quantity)3;
        REFUSES(SPRING_EINVAL, spring_scene_get(s, q, out, i ? 2 : 0, 0, 1));
        REFUSES(SPRING_EINVAL, spring_scene_getf(s, q, outf, i ? 2 : 0, 0, 1));
        REFUSES(SPRING_EINVAL, spring_scene_set(s, q, x, i ? 2 : 0, 0, 1));
    }
    REFUSES(SPRING_EDISABLED, spring_scene_get(s, SPRING_FORCE, out, 0, 0, 1));
    REFUSES(SPRING_EDISABLED, spring_scene_getf(s, SPRING_FORCE, outf, 0, 0, 1));
    REFUSES(SPRING_EDISABLED, spring_scene_set(s, SPRING_FORCE, x, 0, 0, 1));
    REFUSES(SPRING_EINVAL, spring_scene_advance(s, no_method, 0.1, 1));
    REFUSES(SPRING_EDISABLED, spring_scene_advance(s, SPRING_RK4, 0.1, 1));
    REFUSES(SPRING_EUNSUPPORTED, spring_scene_advance(s, SPRING_EXACT, 0.1, 1));

    /* NULL, for the scene and for arrays */
    for (int i = 0; i < 2; i++) {
        spring_scene *const none = i == 0 ? NULL : s;
        REFUSES(SPRING_EINVAL, spring_scene_get(none, SPRING_POSITION, i ? NULL : out, 0, 0, 1));
        REFUSES(SPRING_EINVAL, spring_scene_getf(none, SPRING_POSITION, i ? NULL : outf, 0, 0, 1));
        REFUSES(SPRING_EINVAL, spring_scene_set(none, SPRING_POSITION, i ? NULL : x, 0, 0, 1));
        REFUSES(SPRING_EINVAL, spring_scene_set_gravity(none, i ? NULL : x));
        REFUSES(SPRING_EINVAL, spring_scene_set_link(none, 0, i ? NULL : link));
        REFUSES(SPRING_EINVAL, spring_scene_set_links(none, 0, 1, i ? NULL : link));
        REFUSES(SPRING_EINVAL, spring_scene_get_link(none, 0, i ? NULL : link));
        REFUSES(SPRING_EINVAL, spring_scene_set_pinned(none, 0, 1, i ? NULL : pinned));
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(none, 2, 1, i ? NULL : mass));
        REFUSES(SPRING_EINVAL, spring_scene_transform(none, i ? NULL : farther));
        REFUSES(SPRING_EINVAL, spring_scene_tear(none, 1, NULL, i ? NULL : torn, 1, &count));
        REFUSES(SPRING_EINVAL, spring_scene_touching(none, i ? NULL : torn, 0, 1));
        REFUSES(SPRING_EINVAL, spring_scene_set_colliders(none, i ? NULL : &ball, 1));
    }
    REFUSES(SPRING_EINVAL, spring_scene_drive(NULL, 0, x, 1));
    REFUSES(SPRING_EINVAL, spring_scene_advance(NULL, SPRING_LEAPFROG, 0.1, 1));
    REFUSES(SPRING_EINVAL, spring_scene_set_force(NULL, NULL, NULL));
    const spring_scene_energies e = spring_scene_energy(NULL);
    CHECK(isnan(e.kinetic) && isnan(e.elastic) && isnan(e.gravity) && isnan(spring_scene_tension(NULL, 0)) &&
              isnan(spring_scene_tension(s, links)),
          "no scene, no link");
    CHECK(spring_scene_find_link(s, 0, 0) == SIZE_MAX && spring_scene_find_link(s, n, 0) == SIZE_MAX &&
              spring_scene_find_link(NULL, 0, 1) == SIZE_MAX,
          "none");
    CHECK(count == 9 && torn[0] == 77, "outputs are not written");

    /* what looks like this, and is valid */
    REFUSES(SPRING_OK, spring_scene_set_links(s, links, 0, link));
    REFUSES(SPRING_OK, spring_scene_set_mass(s, n, 0, mass));
    REFUSES(SPRING_OK, spring_scene_get(s, SPRING_VELOCITY, out, 3, n, 0));
    const double behind[] = {1, 2, 3, NAN};
    CHECK(spring_scene_set(s, SPRING_POSITION, behind, 0, 7, 1) == SPRING_OK &&
              spring_scene_set_mass(s, 8, 2, (const double[]){light, 1, NAN}) == SPRING_OK,
          "no number behind is read");
    CHECK(spring_scene_set_mass(s, 1, 1, &light) == SPRING_OK &&
              spring_scene_set_pinned(s, 1, 1, free_all) == SPRING_OK,
          "links of 3 N/m bear it");

    free(s);
    def.drag = huge;
    s = scene_of(&def);
    REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 7, 1, &light)); /* for drag */
    CHECK(spring_scene_set_mass(s, 1, 1, &light) == SPRING_OK, "of a pinned particle it does not matter yet");
    REFUSES(SPRING_EINVAL, spring_scene_set_pinned(s, 1, 1, free_all));
    free(s);
    def.flags = def.colliders = 0;
    s = scene_of(&def);
    spring_scene_bytes(&def, &bytes);
    REFUSES(SPRING_EDISABLED, spring_scene_set_link(s, 0, link));
    REFUSES(SPRING_EDISABLED, spring_scene_set_links(s, 0, 1, link));
    REFUSES(SPRING_EDISABLED, spring_scene_set_pinned(s, 0, 1, pinned));
    REFUSES(SPRING_EDISABLED, spring_scene_set_mass(s, 2, 1, mass + 2));
    REFUSES(SPRING_EDISABLED, spring_scene_tear(s, 1, NULL, torn, 1, &count));
    REFUSES(SPRING_EDISABLED, spring_scene_touching(s, torn, 0, 1));
    REFUSES(SPRING_EDISABLED, spring_scene_set_colliders(s, &ball, 1));
    free(s);
    free(before);
}

static void sizes_and_options(void)
{
    const double x[12] = {0};
    const spring_link link[2] = {{0, 1, 0, 2, 0, 0}, {1, 2, 0, 2, 0, 0}};
    const spring_weighted_link weighted = {.particle = {0, 1, 2}, .weight = {1, -2, 1}, .stiffness = 3};
    spring_scene_def def = joined(2, 6, x, NULL, 2, link);
    def.flags = SPRING_SCENE_EDITABLE, def.methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4;
    def.weighted_links = 1, def.weighted_link = &weighted, def.colliders = 5;
    spring_scene *s = scene_of(&def);
    const spring_scene_info is = spring_scene_describe(s), none = spring_scene_describe(NULL);
    CHECK(is.axes == 2 && is.flags == def.flags && is.methods == def.methods && is.particles == 6 && is.links == 2 &&
              is.weighted_links == 1 && is.colliders == 5,
          "as defined");
    CHECK(none.axes == 0 && none.flags == 0 && none.methods == 0 && none.particles == 0 && none.links == 0 &&
              none.weighted_links == 0 && none.colliders == 0,
          "NULL");
    free(s);
}

/* stiffness weight^2/mass must be finite, also when a mass changes. */
static void too_light_for_weighted(void)
{
    const double x[12] = {0}, large = (double)SCALAR_MAX / 1e6, light = 1e-9, fine = 0.5;
    const spring_weighted_link weighted = {.particle = {0, 1, 2}, .weight = {1, -2, 1}, .stiffness = large};
    spring_scene_def def = joined(2, 6, x, NULL, 0, NULL);
    def.flags = SPRING_SCENE_EDITABLE, def.mass_all = 2, def.weighted_links = 1, def.weighted_link = &weighted;
    spring_scene *s = scene_of(&def);
    CHECK(spring_scene_set_mass(s, 1, 1, &light) == SPRING_EINVAL && spring_scene_set_mass(s, 1, 1, &fine) == SPRING_OK,
          "of a particle of the link");
    CHECK(spring_scene_set_mass(s, 5, 1, &light) == SPRING_OK, "of another particle");
    free(s);
}

/* The weights of a link in a band may underflow in single precision: its state is then one that loads. */
static void weights_that_underflow(void)
{
    enum { particles = 40 };
    static const double sizes[] = {1, 1e-50, 1.5e-45, 3e-45, 1e-300};
    double x[3 * particles] = {0};
    spring_weighted_link link[particles - 2];
    for (uint32_t i = 0; i < particles; i++)
        x[3 * i] = i;
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++)
        for (int edited = 0; edited < 2; edited++) {
            for (uint32_t i = 0; i < particles - 2; i++)
                link[i] =
                    (spring_weighted_link){.particle = {i, i + 1, i + 2}, .weight = {0.5, -1, 0.5}, .stiffness = 10};
            spring_weighted_link other = link[5];
            for (int j = 0; j < 3; j++)
                other.weight[j] *= sizes[k];
            if (!edited)
                link[5] = other;
            spring_scene_def def = joined(3, particles, x, NULL, 0, NULL);
            def.flags = SPRING_SCENE_EDITABLE, def.weighted_links = particles - 2, def.weighted_link = link;
            spring_scene *s = scene_of(&def);
            CHECK(!edited || spring_scene_set_weighted_links(s, 5, 1, &other) == SPRING_OK, "small weights");
            size_t bytes;
            CHECK(spring_scene_save(s, NULL, &bytes) == SPRING_OK, "its size");
            void *saved = malloc(bytes);
            CHECK(spring_scene_save(s, saved, &bytes) == SPRING_OK && spring_scene_load(s, saved, bytes) == SPRING_OK,
                  "its own state");
            free(saved);
            free(s);
        }
}

/* A change of no particle or no link changes nothing, not even the forces that leapfrog keeps. */
static void changes_of_nothing(void)
{
    static model m;
    build(&m, sheet, 3, DAMPED);
    m.def.flags = SPRING_SCENE_EDITABLE;
    spring_scene *s = scene_of(&m.def);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 3) == SPRING_OK, "forces are kept");
    size_t bytes;
    spring_scene_bytes(&m.def, &bytes);
    void *const before = malloc(bytes);
    memcpy(before, s, bytes);
    const uint8_t pin = 1;
    CHECK(spring_scene_set(s, SPRING_POSITION, m.position, 0, m.def.particles, 0) == SPRING_OK &&
              spring_scene_set(s, SPRING_VELOCITY, m.position, 0, 0, 0) == SPRING_OK &&
              spring_scene_set_links(s, 0, 0, m.link) == SPRING_OK &&
              spring_scene_set_weighted_links(s, 0, 0, m.weighted) == SPRING_OK &&
              spring_scene_set_mass(s, 0, 0, m.position) == SPRING_OK &&
              spring_scene_set_pinned(s, 0, 0, &pin) == SPRING_OK,
          "nothing is set");
    CHECK(memcmp(before, s, bytes) == 0, "nothing has changed");
    free(before);
    free(s);
}

/* Weighted links that are set to the values that they have do not change the scene. */
static void equal_weighted_links(void)
{
    static model m;
    for (int round = 0; round < 100; round++) {
        build(&m, sheet, 3, EDITABLE);
        add_further_links(&m, true);
        spring_scene *s = scene_of(&m.def);
        size_t bytes;
        spring_scene_bytes(&m.def, &bytes);
        void *const before = malloc(bytes);
        memcpy(before, s, bytes);
        for (size_t i = 0; i < m.def.weighted_links; i++) {
            spring_weighted_link now;
            CHECK(spring_scene_get_weighted_link(s, i, &now) == SPRING_OK &&
                      spring_scene_set_weighted_links(s, i, 1, &now) == SPRING_OK,
                  "its own value");
        }
        CHECK(memcmp(before, s, bytes) == 0, "the same scene");
        free(before);
        free(s);
    }
}

int main(void)
{
    static const test tests[] = {
        {"equal weighted links", equal_weighted_links},
        {"callbacks are called as often as said", callback_counts},
        {"calls that cost no evaluation", evaluations},
        {"forces that use velocities are refused", velocities_refused},
        {"time is not accumulated", time_is_not_accumulated},
        {"time stays finite", time_stays_finite},
        {"a force that is not finite once", recovers_from_a_bad_force},
        {"velocity alone overflows", velocity_alone_overflows},
        {"an infinite force on a pin", infinite_force_on_a_pin},
        {"strides and ranges", strides_and_ranges},
        {"the masses of freed particles", masses_of_the_freed},
        {"links are found", links_found},
        {"calls that are refused", refused_calls},
        {"sizes and options", sizes_and_options},
        {"masses that are too small for weighted links", too_light_for_weighted},
        {"weights that underflow", weights_that_underflow},
        {"changes of nothing", changes_of_nothing},
    };
    return RUN_TESTS("scene_state", tests);
}
