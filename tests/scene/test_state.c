/* SPDX-License-Identifier: MIT */
/* A scene across calls: runs in several calls, time, callbacks, failures, snapshots, reading and changing the state. */
#include "test_scene.h"

static const uint32_t sheet[] = {7, 5, 1};

/* ---------------------------------------------------------------------------------------------------------
   callbacks */

enum { most_calls = 100 };

typedef struct wind {
    uint32_t axes;
    double drag;
    size_t calls;
    double times[most_calls];
    bool good; /* what it was called with */
} wind;

/* A force that depends on time, so much that its last bit is seen, and on place and velocity. */
static void blow(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                 scalar *const force[3])
{
    wind *w = user;
    for (uint32_t a = 0; a < 3; a++)
        w->good = w->good && (a < w->axes) == (x[a] != NULL) && (a < w->axes) == (v[a] != NULL) &&
                  (a < w->axes) == (force[a] != NULL);
    for (uint32_t a = 0; a < w->axes; a++)
        for (size_t i = 0; i < particles; i++)
            force[a][i] +=
                (scalar)(0.8 * sin(5000 * t + (double)i) - 0.2 * sin((double)x[a][i])) - (scalar)w->drag * v[a][i];
    if (w->calls < most_calls)
        w->times[w->calls] = t;
    w->calls++;
}

static wind calm(uint32_t axes, double drag)
{
    return (wind){.axes = axes, .drag = drag, .good = true};
}

/* Eight steps with a callback: how often it is called, and at what times. */
static void check_calls(const spring_scene_def *def, wind *w, spring_method method)
{
    const double dt = 0.0137;
    const bool still = def->flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY, leapfrog = method == SPRING_LEAPFROG;
    const size_t forces = (size_t)spring_method_describe(method)->forces_per_step;
    const size_t a_step = leapfrog && !still ? 2 : forces; /* leapfrog predicts velocities, and keeps no force */
    *w = calm(def->axes, 0);
    spring_scene *s = scene_of(def);
    CHECK(spring_scene_advance(s, method, dt, 1) == SPRING_OK, "stable");
    const size_t first = w->calls;
    CHECK(first == a_step + (still && keeps_force(method)), "the first step has no force from the step before");
    CHECK(spring_scene_advance(s, method, dt, 7) == SPRING_OK, "stable");
    CHECK(w->calls - first == 7 * a_step, "as often as scene.h says");
    CHECK(w->good, "an array for each axis, NULL beyond");
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

/* A callback that uses no velocities may say so, and gets the same bits for a third of the evaluations. */
static void still_force(void)
{
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        wind w = calm(axes, 0);
        build(&m, sheet, axes, OWN | MASSES | PINNED | DRAG);
        m.def.methods = 1u << SPRING_LEAPFROG;
        m.def.force = blow;
        m.def.user = &w;
        spring_scene *predicted = scene_of(&m.def);
        m.def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
        spring_scene *still = scene_of(&m.def);
        const double dt = 0.0137;
        CHECK(spring_scene_advance(predicted, SPRING_LEAPFROG, dt, 30) == SPRING_OK &&
                  spring_scene_advance(still, SPRING_LEAPFROG, dt, 30) == SPRING_OK,
              "stable");
        CHECK(same_bits(predicted, still, m.def.particles, axes), "the same forces at the same times");
        free(predicted);
        free(still);
    }
}

/* ------------------------------------------------------------------------------------------------- runs in several
   calls */

enum { WIND = feature_masks, STILL_WIND = 2 * feature_masks };

static method_list windy_model(model *m, wind *w, uint32_t axes, unsigned features)
{
    build(m, sheet, axes, features);
    *w = calm(axes, features & STILL_WIND ? 0 : 0.3);
    if (features & (WIND | STILL_WIND)) {
        m->def.flags |= features & STILL_WIND ? SPRING_SCENE_FORCE_IGNORES_VELOCITY : 0;
        m->def.force = blow;
        m->def.user = w;
    }
    return use_all_methods(&m->def);
}

static spring_scene *windy_scene(model *m, wind *w, uint32_t axes, unsigned features)
{
    windy_model(m, w, axes, features);
    return scene_of(&m->def);
}

static const unsigned runs[] = {
    0,
    DRAG | GRAVITY,
    DAMPED | MASSES,
    WIND,
    STILL_WIND,
    STILL_WIND | DAMPED | EDITABLE,
    WIND | DAMPED | DRAG | PINNED | OWN | STRAY | MASSES | GRAVITY,
    STILL_WIND | DRAG | SHUFFLED | PINNED,
};
static const size_t run_count = sizeof runs / sizeof runs[0];

/* 30 steps at once, one by one, and with the state read and written back between. */
static void one_by_one(void)
{
    static model m;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t run = 0; run < run_count; run++) {
            wind w;
            const method_list all = windy_model(&m, &w, axes, runs[run]);
            for (const spring_method *k = all.at; *k != no_method; k++) {
                spring_scene *at_once = scene_of(&m.def), *single = scene_of(&m.def), *set = scene_of(&m.def);
                const double dt = 0.0137;
                CHECK(spring_scene_advance(at_once, *k, dt, 30) == SPRING_OK, "stable");
                for (int i = 0; i < 30; i++) {
                    spring_scene_advance(single, *k, dt, 1);
                    spring_scene_advance(set, *k, dt, 1);
                    get_state(set, m.def.particles, &y);
                    set_state(set, m.def.particles, &y);
                }
                CHECK(same_bits(single, at_once, m.def.particles, axes), "advance(30) is 30 times advance(1)");
                const bool kept = *k == SPRING_LEAPFROG && (runs[run] & DAMPED) != 0 && (runs[run] & WIND) == 0;
                CHECK(kept != same_bits(set, at_once, m.def.particles, axes),
                      "what is set unchanged changes nothing, except for the forces that leapfrog keeps for damped "
                      "links");
                CHECK_BITS(spring_scene_time(single), spring_scene_time(at_once), "nor is time accumulated");
                free(at_once);
                free(single);
                free(set);
            }
        }
}

static void mixed_methods_and_questions(void)
{
    static model m;
    for (size_t run = 0; run < run_count; run++) {
        wind w;
        const method_list all = windy_model(&m, &w, 2, runs[run]);
        spring_scene *s = scene_of(&m.def), *asked = scene_of(&m.def);
        for (int i = 0; i < 4; i++)
            for (const spring_method *k = all.at; *k != no_method; k++) {
                CHECK(spring_scene_advance(s, *k, 0.0137, 2) == SPRING_OK, "stable");
                for (int step = 0; step < 2; step++) {
                    (void)spring_scene_at_rest(asked, 0.1, 0.1);
                    (void)spring_scene_stable_step(asked, SPRING_RK4);
                    (void)spring_scene_energy(asked);
                    (void)spring_scene_tension(asked, 0);
                    spring_scene_advance(asked, *k, 0.0137, 1);
                }
            }
        CHECK(same_bits(s, asked, m.def.particles, 2), "questions change nothing");
        free(s);
        free(asked);
    }
}

/* Forces at predicted velocities belong to leapfrog: another method must not use them. */
static void change_of_method(void)
{
    static model m;
    static state y;
    for (size_t run = 0; run < run_count; run++) {
        wind w;
        const method_list all = windy_model(&m, &w, 2, runs[run]);
        for (const spring_method *first = all.at; *first != no_method; first++)
            for (const spring_method *second = all.at; *second != no_method; second++) {
                if (*first == *second)
                    continue;
                spring_scene *s = scene_of(&m.def), *set = scene_of(&m.def);
                CHECK(spring_scene_advance(s, *first, 0.0137, 3) == SPRING_OK, "stable");
                spring_scene_advance(set, *first, 0.0137, 3);
                get_state(set, m.def.particles, &y);
                set_state(set, m.def.particles, &y);
                spring_scene_advance(s, *second, 0.0137, 3);
                spring_scene_advance(set, *second, 0.0137, 3);
                CHECK(same_bits(s, set, m.def.particles, 2),
                      "another method starts from positions and velocities alone");
                free(s);
                free(set);
            }
    }
}

static void two_scenes(void)
{
    static model m, n;
    wind w, u;
    spring_scene *a = windy_scene(&m, &w, 3, WIND | DAMPED), *b = windy_scene(&n, &u, 1, DRAG | OWN);
    spring_scene *alone_a = scene_of(&m.def), *alone_b = scene_of(&n.def);
    for (int i = 0; i < 10; i++) {
        spring_scene_advance(a, SPRING_LEAPFROG, 0.0137, 1);
        spring_scene_advance(b, SPRING_RK4, 0.0059, 1);
    }
    spring_scene_advance(alone_a, SPRING_LEAPFROG, 0.0137, 10);
    spring_scene_advance(alone_b, SPRING_RK4, 0.0059, 10);
    CHECK(same_bits(a, alone_a, m.def.particles, 3) && same_bits(b, alone_b, n.def.particles, 1),
          "there is no state but the scene's");
    free(a);
    free(b);
    free(alone_a);
    free(alone_b);
}

static void snapshot(void)
{
    static model m;
    for (size_t run = 0; run < run_count; run++) {
        wind w;
        const method_list all = windy_model(&m, &w, 3, runs[run]);
        for (const spring_method *k = all.at; *k != no_method; k++) {
            spring_scene *s = windy_scene(&m, &w, 3, runs[run]);
            size_t bytes;
            spring_scene_bytes(&m.def, &bytes);
            spring_scene_advance(s, *k, 0.0137, 5);
            char *room = aligned_alloc(SPRING_SCENE_ALIGN, bytes + SPRING_SCENE_ALIGN);
            spring_scene *copy = (spring_scene *)(void *)(room + SPRING_SCENE_ALIGN);
            memcpy(copy, s, bytes);
            spring_scene_advance(s, *k, 0.0137, 9);
            memset(m.link, 0xff, sizeof m.link); /* nor does a scene look at what it was made from */
            memset(m.position, 0xff, sizeof m.position);
            CHECK(spring_scene_advance(copy, *k, 0.0137, 9) == SPRING_OK, "a copy is a scene");
            CHECK(same_bits(copy, s, m.def.particles, 3), "and goes on likewise");
            CHECK_BITS(spring_scene_time(copy), spring_scene_time(s), "at the same time");
            free(room);
            free(s);
        }
    }
}

/* ---------------------------------------------------------------------------------------------------------------
   time */

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

static void nothing_to_do(void)
{
    static model m;
    wind w;
    spring_scene *s = windy_scene(&m, &w, 2, WIND | DAMPED), *before = scene_of(&m.def);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 0) == SPRING_OK &&
              spring_scene_advance(s, SPRING_LEAPFROG, 0, 100) == SPRING_OK,
          "nothing to do is done");
    CHECK(same_bits(s, before, m.def.particles, 2) && w.calls == 0, "without a call");
    free(s);
    free(before);
}

/* -----------------------------------------------------------------------------------------------------------
   failures */

/* Whatever fails, a scene goes on as one to which nothing happened. */
static void failures(void)
{
    static model m;
    static state y;
    for (size_t run = 0; run < run_count; run++) {
        wind w;
        const method_list all = windy_model(&m, &w, 3, runs[run]);
        for (const spring_method *k = all.at; *k != no_method; k++) {
            spring_scene *s = scene_of(&m.def), *twin = scene_of(&m.def);
            const spring_method method = *k;
            const size_t n = m.def.particles;
            const double huge = sizeof(scalar) == 4 ? 1e30 : 1e200, bad[] = {1, NAN, 1}, infinite[] = {1, INFINITY, 0};
            spring_scene_advance(s, method, 0.0137, 4);
            spring_scene_advance(twin, method, 0.0137, 4);
            get_state(s, n, &y);
            CHECK(spring_scene_advance(s, method, huge, 8) == SPRING_ENONFINITE, "overflow");
            CHECK(spring_scene_advance(s, method, -huge, 8) == SPRING_ENONFINITE, "overflow");
            CHECK(spring_scene_advance(s, method, NAN, 1) == SPRING_EINVAL, "NaN");
            CHECK(spring_scene_advance(s, method, -INFINITY, 1) == SPRING_EINVAL, "infinite");
            CHECK(spring_scene_advance(s, no_method, 0.01, 1) == SPRING_EINVAL, "no method");
            CHECK(spring_scene_advance(s, SPRING_EXACT, 0.01, 1) == SPRING_EUNSUPPORTED, "not for scenes");
            CHECK(spring_scene_set(s, SPRING_POSITION, bad, 0, 3, 1) == SPRING_EINVAL, "NaN");
            CHECK(spring_scene_set(s, SPRING_VELOCITY, infinite, 0, 3, 1) == SPRING_EINVAL, "infinite");
            CHECK(spring_scene_set(s, SPRING_POSITION, y.x, 0, 1, n) == SPRING_ERANGE, "one too many");
            CHECK(spring_scene_set_gravity(s, bad) == SPRING_EINVAL, "NaN");
            const spring_link wrong = {m.link[0].a, m.link[0].b, 1, -1, 0};
            CHECK(spring_scene_set_link(s, 0, &wrong) == (runs[run] & EDITABLE ? SPRING_EINVAL : SPRING_EDISABLED),
                  "negative, or not editable");
            CHECK(same_bits(s, twin, n, 3), "as it was");
            CHECK_BITS(spring_scene_time(s), spring_scene_time(twin), "as it was");
            const spring_scene_energies e = spring_scene_energy(s), f = spring_scene_energy(twin);
            CHECK_BITS(e.kinetic + e.elastic + e.gravity, f.kinetic + f.elastic + f.gravity, "as it was");
            for (const spring_method *other = all.at; *other != no_method; other++) {
                CHECK(spring_scene_advance(s, *other, huge, 8) == SPRING_ENONFINITE, "overflow, of any method");
                spring_scene_advance(s, method, 0.0137, 2); /* what leapfrog keeps is still there */
                spring_scene_advance(twin, method, 0.0137, 2);
                spring_scene_advance(s, *other, 0.0137, 5);
                spring_scene_advance(twin, *other, 0.0137, 5);
            }
            CHECK(same_bits(s, twin, n, 3), "and goes on likewise");
            CHECK_BITS(spring_scene_time(s), spring_scene_time(twin), "and goes on likewise");
            free(s);
            free(twin);
        }
    }
}

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
        const spring_link link = {0, 1, 0.5, large, damped ? 1e-3 : 0};
        const spring_scene_def def = {
            .axes = 1, .particles = 2, .links = 1, .position = x, .velocity = v, .pinned = pinned, .link = &link};
        spring_scene *s = scene_of(&def), *twin = scene_of(&def);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1, 1) == SPRING_ENONFINITE, "noticed in the same step");
        CHECK(same_bits(s, twin, 2, 1), "as it was");
        free(s);
        free(twin);
    }
}

/* Particles that fall at their final speed are all there is: an unstable step is no failure where nothing departs from
   it. */
static void steady_fall(void)
{
    enum { particles = 19 };
    const double x[particles] = {0};
    double v[particles], now[particles];
    for (size_t i = 0; i < particles; i++)
        v[i] = -2;
    for (size_t n = 1; n <= particles; n++) {
        const spring_scene_def def = {
            .axes = 1, .particles = n, .position = x, .velocity = v, .gravity = {-4}, .drag = 2};
        spring_scene *s = scene_of(&def);
        CHECK(spring_scene_advance(s, SPRING_EULER, 2, 2000) == SPRING_OK, "-4 - 2 (-2) is 0, exactly");
        spring_scene_get(s, SPRING_VELOCITY, now, 0, 0, n);
        for (size_t i = 0; i < n; i++)
            CHECK_BITS(now[i], -2, "-4 - 2 (-2) is 0, exactly");
        CHECK(spring_scene_at_rest(s, 2, 0) && !spring_scene_at_rest(s, 1.9, 0), "nothing accelerates at 2 m/s");
        free(s);
    }
}

static void without_rollback(void)
{
    static model m;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (uint32_t n = 1; n <= 19; n++) {
            build(&m, (uint32_t[]){n, 1, 1}, axes, OWN | DAMPED | DRAG | (n % 2 ? MASSES : 0));
            for (uint32_t i = 0; i < n; i++)
                m.mass[i] += 1; /* so that drag does not take all of a velocity in a long step */
            const method_list all = methods_of(m.def);
            for (const spring_method *k = all.at; *k != no_method; k++) {
                m.def.flags = 0;
                spring_scene *kept = scene_of(&m.def);
                m.def.flags = SPRING_SCENE_NO_UNDO;
                spring_scene *s = scene_of(&m.def);
                get_state(s, n, &y);
                spring_scene_advance(s, *k, 0.0137, 6);
                spring_scene_advance(kept, *k, 0.0137, 6);
                CHECK(same_bits(s, kept, n, axes), "rollback changes no bits");
                const double time = spring_scene_time(s), huge = sizeof(scalar) == 4 ? 3e38 : 1e308;
                const double fast[3] = {huge, huge, huge};
                spring_scene_set(s, SPRING_VELOCITY, fast, 0, 0, 1);
                CHECK(spring_scene_advance(s, *k, huge, 1) == SPRING_ENONFINITE, "overflow");
                CHECK(spring_scene_advance(s, *k, 0.0137, 1) == SPRING_ENONFINITE, "unusable until set again");
                CHECK(!spring_scene_at_rest(s, INFINITY, INFINITY), "what is not finite is not at rest");
                set_state(s, n, &y);
                CHECK_BITS(spring_scene_time(s), time, "time did not pass");
                CHECK(spring_scene_advance(s, *k, 0.0137, 6) == SPRING_OK, "usable again");
                CHECK(same_bits(s, kept, n, axes), "and as good as new");
                free(s);
                free(kept);
            }
        }
}

/* ------------------------------------------------------------------------------------------------ reading and
   setting */

static void strides_and_ranges(void)
{
    static model m;
    const float outside = -77;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        build(&m, sheet, axes, 0);
        const size_t n = m.def.particles, stride = axes + 4, first = 3, count = n - 5;
        spring_scene *s = scene_of(&m.def);
        float vertex[8 * most];
        double wide[8 * most];
        for (size_t i = 0; i < stride * n; i++) {
            vertex[i] = outside;
            wide[i] = (double)outside;
        }
        CHECK(spring_scene_getf(s, SPRING_VELOCITY, vertex + 1, stride, first, count) == SPRING_OK &&
                  spring_scene_get(s, SPRING_POSITION, wide + 1, stride, first, count) == SPRING_OK,
              "into the middle of vertices");
        for (size_t i = 0; i < stride * n; i++) {
            const size_t particle = first + i / stride, axis = i % stride - 1; /* wraps around: no axis */
            const bool inside = i / stride < count && axis < axes;
            const size_t at = inside ? particle * axes + axis : 0;
            CHECK_BITS((double)vertex[i], (double)(inside ? (float)(scalar)m.velocity[at] : outside), "one rounding");
            CHECK_BITS(wide[i], inside ? (double)(scalar)m.position[at] : (double)outside, "no rounding");
            wide[i] += 0.5;
        }
        double back[3 * most], before[3 * most];
        spring_scene_get(s, SPRING_VELOCITY, before, 0, 0, n);
        CHECK(spring_scene_set(s, SPRING_POSITION, wide + 1, stride, first, count) == SPRING_OK, "back from there");
        spring_scene_get(s, SPRING_VELOCITY, back, 0, 0, n);
        CHECK(memcmp(back, before, n * axes * sizeof back[0]) == 0, "velocities are left alone");
        spring_scene_get(s, SPRING_POSITION, back, 0, 0, n);
        for (size_t i = 0; i < n * axes; i++) {
            const bool moved = i / axes >= first && i / axes < first + count;
            const double from = (double)(scalar)m.position[i];
            CHECK_BITS(back[i], moved ? (double)(scalar)(from + 0.5) : from, "these and no others");
        }
        free(s);
    }
}

static void bad_ranges(void)
{
    static model m;
    double out[3 * most] = {0};
    float outf[3 * most];
    build(&m, sheet, 3, 0);
    const size_t n = m.def.particles;
    spring_scene *s = scene_of(&m.def);
    const struct {
        spring_quantity q;
        bool null;
        size_t stride, first, count;
        spring_status want;
    } cases[] = {
        {SPRING_POSITION, false, 0, 0, n, SPRING_OK},
        {SPRING_VELOCITY, false, 3, n, 0, SPRING_OK},
        {SPRING_POSITION, false, 2, 0, 1, SPRING_EINVAL},
        {SPRING_POSITION, true, 0, 0, 1, SPRING_EINVAL},
        {(spring_quantity)3, false, 0, 0, 1, SPRING_EINVAL},
        {SPRING_POSITION, false, 0, 1, n, SPRING_ERANGE},
        {SPRING_POSITION, false, 0, n + 1, 0, SPRING_ERANGE},
        {SPRING_POSITION, false, 0, n, 1, SPRING_ERANGE},
        {SPRING_POSITION, false, 0, 2, SIZE_MAX, SPRING_ERANGE},
        {SPRING_POSITION, false, 0, SIZE_MAX, 2, SPRING_ERANGE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const spring_quantity q = cases[i].q;
        const size_t stride = cases[i].stride, first = cases[i].first, count = cases[i].count;
        double *d = cases[i].null ? NULL : out;
        CHECK(spring_scene_get(s, q, d, stride, first, count) == cases[i].want, "as scene.h says");
        CHECK(spring_scene_getf(s, q, cases[i].null ? NULL : outf, stride, first, count) == cases[i].want, "likewise");
        CHECK(spring_scene_set(s, q, d, stride, first, count) == cases[i].want, "likewise");
    }
    CHECK(spring_scene_get(NULL, SPRING_POSITION, out, 0, 0, 1) == SPRING_EINVAL &&
              spring_scene_getf(NULL, SPRING_POSITION, outf, 0, 0, 1) == SPRING_EINVAL &&
              spring_scene_set(NULL, SPRING_POSITION, out, 0, 0, 1) == SPRING_EINVAL,
          "no scene");
    const spring_scene_energies e = spring_scene_energy(NULL);
    CHECK(isnan(e.kinetic) && isnan(e.elastic) && isnan(e.gravity), "no scene");
    CHECK(isnan(spring_scene_tension(NULL, 0)) && isnan(spring_scene_tension(s, m.def.links)), "no link");
    CHECK(spring_scene_advance(NULL, SPRING_EULER, 0.1, 1) == SPRING_EINVAL &&
              spring_scene_set_force(NULL, NULL, NULL) == SPRING_EINVAL &&
              spring_scene_set_gravity(NULL, m.def.gravity) == SPRING_EINVAL &&
              spring_scene_set_gravity(s, NULL) == SPRING_EINVAL &&
              spring_scene_set_link(NULL, 0, m.link) == SPRING_EINVAL,
          "no scene");
    free(s);
}

/* ------------------------------------------------------------------------------------------------------------
   changes */

/* A pin goes straight on, whatever pulls at it, until it is told otherwise. */
static void moving_pins(void)
{
    static model m;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        wind w;
        const method_list all = windy_model(&m, &w, axes, WIND | DAMPED | PINNED | DRAG | GRAVITY);
        for (const spring_method *k = all.at; *k != no_method; k++) {
            spring_scene *s = scene_of(&m.def);
            const double dt = 1.0 / 64; /* so that no step rounds but the sums */
            size_t pins = 0;
            const double turn[] = {0.5, -0.25, 2};
            static double want[3 * most];
            for (size_t i = 0; i < m.def.particles * axes; i++)
                want[i] = m.position[i] + 20 * dt * m.velocity[i] + 12 * dt * turn[i % axes];
            CHECK(spring_scene_advance(s, *k, dt, 20) == SPRING_OK, "stable");
            get_state(s, m.def.particles, &y);
            for (size_t i = 0; i < m.def.particles; i++) {
                if (!m.pinned[i])
                    continue;
                pins++;
                for (uint32_t a = 0; a < axes; a++)
                    CHECK_BITS(y.v[i * axes + a], (double)(scalar)m.velocity[i * axes + a], "nothing changes it");
                spring_scene_set(s, SPRING_VELOCITY, turn, 0, i, 1);
            }
            CHECK(spring_scene_advance(s, *k, dt, 12) == SPRING_OK, "stable");
            get_state(s, m.def.particles, &y);
            for (size_t i = 0; i < m.def.particles * axes; i++)
                if (m.pinned[i / axes])
                    CHECK_CLOSE(y.x[i], want[i], 5 * 40 * EPS * (1 + fabs(want[i])),
                                "40 steps of at most five roundings each");
            CHECK(pins > 0, "there are pins");
            free(s);
        }
    }
}

/* Links that are cut are as good as not there; restored, as good as never cut; changed, as good as defined so. */
static void edited_links(void)
{
    static model m, changed;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < MASSES; features++) {
            build(&m, sheet, axes, features | EDITABLE);
            changed = m;
            changed.def.position = changed.position;
            changed.def.velocity = changed.velocity;
            changed.def.link = changed.link;
            for (size_t i = 0; i < m.def.links; i += 3) {
                changed.link[i].rest = random_uniform(0, 1);
                changed.link[i].stiffness = i % 2 ? 0 : random_log(3, 60);
                changed.link[i].damping = i % 2 ? 0 : 0.21;
            }
            const method_list all = use_all_methods(&changed.def);
            for (const spring_method *k = all.at; *k != no_method; k++) {
                spring_scene *s = scene_of(&m.def), *as_defined = scene_of(&changed.def);
                for (size_t i = 0; i < m.def.links; i += 3)
                    CHECK(spring_scene_set_link(s, i, &changed.link[i]) == SPRING_OK, "editable");
                CHECK_BITS(spring_scene_stable_step(s, SPRING_LEAPFROG),
                           spring_scene_stable_step(as_defined, SPRING_LEAPFROG), "the stable step knows");
                for (size_t i = 0; i < m.def.links; i++)
                    CHECK_BITS(spring_scene_tension(s, i), spring_scene_tension(as_defined, i), "so does the tension");
                spring_scene_advance(s, *k, 0.009, 7);
                spring_scene_advance(as_defined, *k, 0.009, 7);
                CHECK(same_bits(s, as_defined, m.def.particles, axes), "as good as defined so");
                for (size_t i = 0; i < m.def.links; i += 3) {
                    spring_scene_set_link(s, i, &m.link[i]);
                    spring_scene_set_link(as_defined, i, &m.link[i]);
                }
                static state y;
                get_state(s, m.def.particles, &y);
                spring_scene *never = scene_of(&m.def);
                set_state(never, m.def.particles, &y);
                spring_scene_advance(s, *k, 0.009, 7);
                spring_scene_advance(never, *k, 0.009, 7);
                CHECK(same_bits(s, never, m.def.particles, axes), "as good as never cut");
                free(s);
                free(as_defined);
                free(never);
            }
        }
}

/* Links that lose their damping cost no more than links that never had any. */
static void damping_taken_away(void)
{
    static model m;
    wind w = calm(2, 0);
    build(&m, sheet, 2, DAMPED);
    m.def.flags = SPRING_SCENE_EDITABLE | SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    m.def.force = blow;
    m.def.user = &w;
    spring_scene *s = scene_of(&m.def);
    for (size_t i = 0; i < m.def.links; i++) {
        m.link[i].damping = 0;
        spring_scene_set_link(s, i, &m.link[i]);
    }
    spring_scene_advance(s, SPRING_LEAPFROG, 0.009, 4);
    CHECK(w.calls == 1 + 4, "nothing left that uses velocities: one evaluation a step");
    m.link[0].damping = 0.1;
    spring_scene_set_link(s, 0, &m.link[0]);
    w.calls = 0;
    spring_scene_advance(s, SPRING_LEAPFROG, 0.009, 4);
    CHECK(w.calls == 1 + 4, "nor more where links do: they are predicted from the forces that are kept");
    m.link[0].damping = 0;
    spring_scene_set_link(s, 0, &m.link[0]);
    w.calls = 0;
    spring_scene_advance(s, SPRING_LEAPFROG, 0.009, 4);
    CHECK(w.calls == 1 + 4, "taken away once more");
    free(s);
}

/* A method of positions only refuses what it cannot do, when it has become so, and changes nothing. */
static void velocities_refused(void)
{
    static model m;
    wind w = calm(2, 0);
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

/* On two axes, with edges in records: a call that fails leaves nothing behind, also where damping is taken away then,
   and records have another size. */
static void damping_taken_away_after_failure(void)
{
    enum { n = 14 };
    const uint32_t order[n] = {7, 3, 11, 2, 9, 5, 13, 4, 8, 6, 12, 10, 0, 1};
    double x[2 * n];
    spring_link link[n + 1];
    for (size_t i = 0; i < n; i++) {
        x[2 * i] = (double)(i % 4) + 0.1 * (double)(i * 7 % 5);
        x[2 * i + 1] = (double)(i / 4) + 0.1 * (double)(i * 3 % 5);
        link[i] = (spring_link){order[i], order[(i + 1) % n], 0.7, 50, 0};
    }
    link[n] = (spring_link){2, 6, 0.7, 50, 0.5};
    const spring_scene_def def = {.axes = 2,
                                  .flags = SPRING_SCENE_EDITABLE,
                                  .particles = n,
                                  .links = n + 1,
                                  .position = x,
                                  .mass_all = 1.3,
                                  .link = link};
    const spring_link cut = {2, 6, 0.7, 0, 0};
    spring_scene *s = scene_of(&def), *twin = scene_of(&def);
    CHECK(spring_scene_advance(s, SPRING_SYMPLECTIC_EULER, 10, 1000) == SPRING_ENONFINITE, "much too long a step");
    for (int i = 0; i < 2; i++) {
        spring_scene *const one = i == 0 ? s : twin;
        CHECK(spring_scene_set_link(one, n, &cut) == SPRING_OK, "the damped link");
        CHECK(spring_scene_advance(one, SPRING_SYMPLECTIC_EULER, 0.001, 50) == SPRING_OK, "stable");
    }
    CHECK(same_bits(s, twin, n, 2), "as if nothing had failed");
    free(s);
    free(twin);
}

/* A cut in a rope: what hung falls. */
static void cut_rope(void)
{
    enum { n = 12 };
    double x[2 * n] = {0};
    uint8_t pinned[n] = {1};
    spring_link link[n - 1];
    for (uint32_t i = 0; i < n; i++) {
        x[2 * i + 1] = -0.5 * i;
        if (i > 0)
            link[i - 1] = (spring_link){i - 1, i, 0.5, 800, 1.5};
    }
    const spring_scene_def def = {.axes = 2,
                                  .flags = SPRING_SCENE_EDITABLE,
                                  .particles = n,
                                  .links = n - 1,
                                  .position = x,
                                  .mass_all = 0.2,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, -9.5, 0}};
    spring_scene *s = scene_of(&def);
    spring_scene_advance(s, SPRING_LEAPFROG, 1.0 / 256, 300);
    double before = 0, after = 0, v[2 * n];
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, n);
    for (int i = 6; i < n; i++)
        before += v[2 * i + 1] / (n - 6);
    const spring_link cut = {5, 6, 0.5, 0, 0};
    CHECK(spring_scene_set_link(s, 5, &cut) == SPRING_OK, "between 5 and 6");
    CHECK_BITS(spring_scene_tension(s, 5) + 0, 0, "nothing holds");
    spring_scene_advance(s, SPRING_LEAPFROG, 1.0 / 256, 128);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, n);
    for (int i = 6; i < n; i++)
        after += v[2 * i + 1] / (n - 6);
    /* its velocities below 10 m/s, forces of its links on each other below 800 N/m times 1 m, over 0.2 kg, for 0.5 s */
    CHECK_CLOSE(after - before, -9.5 * 0.5, 128 * 8 * EPS * (10 + 800 / 0.2 / 256 * 2),
                "the mean velocity of a free piece grows with gravity alone, except for rounding");
    free(s);
}

static void bad_edits(void)
{
    static model m;
    build(&m, sheet, 2, 0);
    spring_scene *fixed = scene_of(&m.def);
    CHECK(spring_scene_set_link(fixed, 0, m.link) == SPRING_EDISABLED, "not editable");
    free(fixed);
    m.def.flags = SPRING_SCENE_EDITABLE;
    spring_scene *s = scene_of(&m.def), *before = scene_of(&m.def);
    const uint32_t a = m.link[0].a, b = m.link[0].b;
    const double too_stiff = sizeof(scalar) == 4 ? 3e38 : 1.7e308;
    const spring_link bad[] = {
        {a, b + 1, 1, 1, 0}, {a + 1, b, 1, 1, 0}, {a, a, 1, 1, 0},        {a, b, -1, 1, 0},        {a, b, 1, -1, 0},
        {a, b, 1, 1, -1},    {a, b, NAN, 1, 0},   {a, b, 1, INFINITY, 0}, {a, b, 1, too_stiff, 0}, {a, b, 1, 1, NAN},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK(spring_scene_set_link(s, 0, &bad[i]) == SPRING_EINVAL, "bad input");
    CHECK(spring_scene_set_link(s, 0, NULL) == SPRING_EINVAL &&
              spring_scene_set_link(s, m.def.links, m.link) == SPRING_ERANGE,
          "bad input");
    spring_scene_advance(s, SPRING_LEAPFROG, 0.009, 9);
    spring_scene_advance(before, SPRING_LEAPFROG, 0.009, 9);
    CHECK(same_bits(s, before, m.def.particles, 2), "as it was");
    free(s);
    free(before);
}

/* On one axis a link has a direction: with its ends the other way round it is refused, or means what it says. */
static void turned_link(void)
{
    const double x[] = {0.2, 1.1};
    for (uint32_t a = 0; a < 2; a++) {
        const spring_link link = {a, 1 - a, 0.7, 5.3, 0}, turned = {1 - a, a, 0.4, 5.3, 0};
        const spring_scene_def def = {
            .axes = 1, .flags = SPRING_SCENE_EDITABLE, .particles = 2, .links = 1, .position = x, .link = &link};
        spring_scene *s = scene_of(&def);
        const double extension = x[turned.b] - x[turned.a] - 0.4;
        if (spring_scene_set_link(s, 0, &turned) == SPRING_OK) {
            double v[2];
            spring_scene_advance(s, SPRING_EULER, 0.25, 1);
            spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 2);
            CHECK_CLOSE(v[turned.a], 0.25 * 5.3 * extension, 8 * EPS, "a few roundings of numbers below 4");
        }
        free(s);
    }
}

static void changed_gravity_and_force(void)
{
    static model m;
    static state y;
    wind w;
    const method_list all = windy_model(&m, &w, 3, WIND | DAMPED | DRAG | GRAVITY);
    for (const spring_method *k = all.at; *k != no_method; k++) {
        const double moon[] = {0.3, -1.62, 0.1};
        spring_scene *s = windy_scene(&m, &w, 3, DAMPED | DRAG | GRAVITY);
        CHECK(spring_scene_advance(s, *k, 0.0137, 6) == SPRING_OK && w.calls == 0, "no wind yet");
        CHECK(spring_scene_set_gravity(s, moon) == SPRING_OK && spring_scene_set_force(s, blow, &w) == SPRING_OK,
              "from here on");
        get_state(s, m.def.particles, &y);
        memcpy(m.def.gravity, moon, sizeof moon);
        m.def.force = blow;
        m.def.user = &w;
        spring_scene_advance(s, *k, 0.0137, 1);
        spring_scene *other = scene_of(&m.def);
        spring_scene_advance(other, *k, 0.0137, 6); /* to the same time */
        set_state(other, m.def.particles, &y);
        spring_scene_advance(other, *k, 0.0137, 1);
        CHECK(same_bits(s, other, m.def.particles, 3), "as good as defined so");
        spring_scene_set_force(s, NULL, NULL);
        const size_t calls = w.calls;
        spring_scene_advance(s, *k, 0.0137, 3);
        CHECK(w.calls == calls, "no more wind");
        free(s);
        free(other);
    }
}

/* ----------------------------------------------------------------------------------------------------- zero is
   absent */

static void add_nothing(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                        scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v, (void)force;
}

static void absent_is_zero(void)
{
    static model m;
    static const double zeros[3 * most];
    static const uint8_t unpinned[most];
    double equal[most];
    for (size_t i = 0; i < most; i++)
        equal[i] = 1.7;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features <= DAMPED; features += DAMPED) {
            build(&m, sheet, axes, features);
            const spring_scene_def plain = m.def;
            const method_list all = methods_of(plain);
            for (const spring_method *k = all.at; *k != no_method; k++) {
                m.def = plain;
                m.def.velocity = NULL;
                spring_scene *shorter = scene_of(&m.def);
                spring_scene_advance(shorter, *k, 0.0137, 11);
                m.def.velocity = zeros;
                m.def.mass = equal;
                m.def.pinned = unpinned;
                m.def.force = add_nothing;
                m.def.methods = 1u << *k;
                if (features & DAMPED || spring_method_describe(*k)->positions_only) /* else none are kept */
                    m.def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
                spring_scene *longer = scene_of(&m.def);
                spring_scene_advance(longer, *k, 0.0137, 11);
                CHECK(same_bits(longer, shorter, m.def.particles, axes), "a feature of zero is absent");
                free(shorter);
                free(longer);
            }
        }
}

int main(void)
{
    static const test tests[] = {
        {"callbacks are called as often as said", callback_counts},
        {"a callback without velocities", still_force},
        {"n steps are n times one step", one_by_one},
        {"questions change nothing", mixed_methods_and_questions},
        {"a change of method", change_of_method},
        {"two scenes", two_scenes},
        {"snapshots", snapshot},
        {"time is not accumulated", time_is_not_accumulated},
        {"nothing to do", nothing_to_do},
        {"a failed call leaves everything as it was", failures},
        {"a force that is not finite once", recovers_from_a_bad_force},
        {"velocity alone overflows", velocity_alone_overflows},
        {"a steady fall", steady_fall},
        {"without rollback", without_rollback},
        {"strides and ranges", strides_and_ranges},
        {"bad ranges", bad_ranges},
        {"moving pins", moving_pins},
        {"edited links", edited_links},
        {"damping taken away", damping_taken_away},
        {"forces that use velocities are refused", velocities_refused},
        {"damping taken away after a failure", damping_taken_away_after_failure},
        {"a cut rope", cut_rope},
        {"bad edits", bad_edits},
        {"a link turned round", turned_link},
        {"gravity and callback change", changed_gravity_and_force},
        {"zero is absent", absent_is_zero},
    };
    return RUN_TESTS("scene_state", tests);
}
