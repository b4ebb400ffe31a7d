/* SPDX-License-Identifier: MIT */
/* Small scenes, which store particles as quads: forces compared with a plain loop, and all queries and edits compared
   with the same scene plus so many unconnected particles that it is not small. */
#include "test_scene.h"

enum { most_small_particles = 13, strangers = 14 };

/* Any links between particles in a box, in an order that makes no band. */
static void build_small(model *m, size_t particles, size_t links, uint32_t axes, unsigned features)
{
    build(m, (uint32_t[]){(uint32_t)particles, 1, 1}, axes, features & ~(unsigned)(STRAY | SHUFFLED));
    for (size_t i = 0; i < particles * axes; i++)
        m->position[i] = random_uniform(-1, 1);
    m->def.links = particles > 1 ? links : 0;
    for (size_t i = 0; i < m->def.links; i++) {
        const uint32_t lower = (uint32_t)((m->def.links - 1 - i) * (particles - 1) / m->def.links); /* descending */
        const uint32_t upper = lower + 1 + (uint32_t)(random_bits() % (particles - 1 - lower));
        const bool reversed = random_bits() % 2 != 0;
        m->link[i] = (spring_link){
            reversed ? upper : lower,    reversed ? lower : upper,
            random_uniform(0, 1),        random_bits() % 8 == 0 ? 0 : random_log(3, 60),
            features & DAMPED ? 0.3 : 0,
        };
        if (features & OWN && random_bits() % 2)
            m->link[i].damping = 0;
    }
    if (particles > 2 && random_bits() % 4 == 0) /* at one place */
        memcpy(m->position + axes, m->position, axes * sizeof m->position[0]);
    use_all_methods(&m->def);
}

static void against_a_plain_loop(void)
{
    static model m;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (size_t n = 1; n <= most_small_particles; n++)
            for (size_t links = 0; links <= most_small_particles; links++)
                for (unsigned features = 0; features < SHUFFLED; features++) {
                    build_small(&m, n, links, axes, features | (links % 2 ? DAMPED : 0));
                    spring_scene *s = scene_of(&m.def);
                    CHECK(s->layout.quads == (n <= 12 && m.def.links <= 12), "twelve particles and links");
                    free(s);
                    for (int k = 0; k < kernel_count; k++)
                        if (kernels_of(k) != NULL)
                            check_forces(&m, kernels_of(k));
                }
}

/* ------------------------------------------------------------------------------------------- small, and not so small */

/* What a callback is shown, and what it adds. */
typedef struct wind {
    uint32_t axes;
    size_t first; /* particles are blown at, the others are strangers */
    size_t calls;
    bool as_said;
    bool by_velocity;
    double sum; /* of all that it has been shown of them */
} wind;

static void blow(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                 scalar *const force[3])
{
    wind *w = user;
    w->calls++;
    w->as_said &= particles >= w->first;
    for (uint32_t a = 0; a < 3; a++) {
        if (a >= w->axes) {
            w->as_said &= x[a] == NULL && v[a] == NULL && force[a] == NULL;
            continue;
        }
        for (size_t i = 0; i < w->first; i++) {
            w->sum += (double)x[a][i] + (double)v[a][i] + (double)force[a][i];
            force[a][i] += (scalar)0.3 * (scalar)(i + a) - (scalar)0.2 * x[a][i] + (scalar)(t > 0.02 ? 0.1 : 0);
            if (w->by_velocity)
                force[a][i] -= (scalar)0.1 * v[a][i];
        }
    }
}

/* The same scene twice: small, and with strangers. */
typedef struct pair {
    model *m;
    spring_scene *s, *other;
    const scene_kernels *kernels;
    method_list methods;
    size_t n;
    wind w, other_w;
} pair;

static pair pair_of(model *m, const scene_kernels *kernels, int blowing)
{
    static model larger;
    const size_t n = m->def.particles;
    pair p = {.m = m, .kernels = kernels, .n = n};
    p.w = (wind){.axes = m->def.axes, .first = n, .as_said = true, .by_velocity = blowing == 2};
    p.other_w = p.w;
    spring_scene_def def = m->def;
    add_strangers(m, strangers);
    larger = *m;
    m->def.particles = n;
    def.pinned = m->pinned;
    larger.def.position = larger.position;
    larger.def.velocity = larger.velocity;
    larger.def.mass = m->def.mass != NULL ? larger.mass : NULL;
    larger.def.pinned = larger.pinned;
    larger.def.link = larger.link;
    def.force = larger.def.force = blowing != 0 ? blow : NULL;
    if (blowing < 2)
        def.flags = larger.def.flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    def.user = &p.w;
    larger.def.user = &p.other_w;
    p.methods = use_all_methods(&def);
    use_all_methods(&larger.def);
    p.s = scene_of(&def);
    p.other = scene_of(&larger.def);
    CHECK(p.s->layout.quads && !p.other->layout.quads && p.other->layout.unbanded == def.links, "quads, and not");
    return p;
}

/* The user pointers, where the pair is now. */
static void set_winds(pair *p)
{
    if (p->s->force != NULL) {
        spring_scene_set_force(p->s, blow, &p->w);
        spring_scene_set_force(p->other, blow, &p->other_w);
    }
}

static void check_energies(const pair *p)
{
    const spring_scene_energies e = spring_scene_energy(p->s), f = spring_scene_energy(p->other);
    CHECK_BITS(e.kinetic, f.kinetic, "strangers are at rest");
    CHECK_BITS(e.elastic, f.elastic, "and joined to nothing");
    CHECK_BITS(e.gravity, f.gravity, "and pinned");
}

/* Everything that can be asked. */
static void check_same(pair *p)
{
    static state a, b;
    static float c[5 * most_small_particles], d[5 * most_small_particles];
    const uint32_t axes = p->m->def.axes;
    const size_t bytes = p->n * axes * sizeof a.x[0];
    memset(c, 0, sizeof c);
    memset(d, 0, sizeof d);
    get_state(p->s, p->n, &a);
    get_state(p->other, p->n, &b);
    CHECK(memcmp(a.x, b.x, bytes) == 0 && memcmp(a.v, b.v, bytes) == 0, "the same operations");
    CHECK(spring_scene_getf(p->s, SPRING_POSITION, c, 5, 1, p->n - 1) == SPRING_OK &&
              spring_scene_getf(p->other, SPRING_POSITION, d, 5, 1, p->n - 1) == SPRING_OK &&
              memcmp(c, d, sizeof c) == 0,
          "all but the first");
    for (size_t i = 0; i + 1 < p->n; i++)
        for (uint32_t k = 0; k < axes; k++)
            CHECK_BITS((double)c[5 * i + k], (double)(float)a.x[(i + 1) * axes + k], "the same particle");
    check_energies(p);
    for (size_t i = 0; i < p->m->def.links; i++)
        CHECK_BITS(spring_scene_tension(p->s, i), spring_scene_tension(p->other, i), "of each link");
    CHECK(isnan(spring_scene_tension(p->s, p->m->def.links)), "no more links");
    for (const spring_method *m = p->methods.at; *m != no_method; m++)
        CHECK_BITS(spring_scene_stable_step(p->s, *m), spring_scene_stable_step(p->other, *m), "the same limit");
    CHECK_BITS(spring_scene_time(p->s), spring_scene_time(p->other), "as much time");
    for (double tolerance = 1e-3; tolerance < 1e4; tolerance *= 1.7) {
        CHECK(spring_scene_at_rest(p->s, tolerance, INFINITY) == spring_scene_at_rest(p->other, tolerance, INFINITY),
              "speeds");
        CHECK(spring_scene_at_rest(p->s, INFINITY, tolerance) == spring_scene_at_rest(p->other, INFINITY, tolerance),
              "accelerations");
    }
    CHECK(p->w.as_said && p->other_w.as_said, "a callback is shown arrays of each axis");
    CHECK(p->w.calls == p->other_w.calls, "as often");
    CHECK_BITS(p->w.sum, p->other_w.sum, "the same numbers");
}

static void advance(pair *p, spring_method m, uint64_t n)
{
    const bool damped = p->s->damped_links > 0, refused = damped && spring_method_describe(m)->positions_only;
    const spring_status want = refused ? SPRING_EUNSUPPORTED : SPRING_OK;
    CHECK(spring_scene_advance_with(p->kernels, p->s, m, 0.004, n) == want &&
              spring_scene_advance_with(p->kernels, p->other, m, 0.004, n) == want,
          "stable, or refused");
    check_same(p);
}

/* Everything that can be done. */
static void check_small(model *m, const scene_kernels *kernels, int blowing)
{
    const uint32_t axes = m->def.axes;
    const double moon[] = {0.2, -1.62, 0.4};
    double some[5 * most_small_particles];
    pair p = pair_of(m, kernels, blowing);
    set_winds(&p);
    check_same(&p);
    for (const spring_method *method = p.methods.at; *method != no_method; method++) {
        advance(&p, *method, 3);
        CHECK(spring_scene_set_gravity(p.s, moon) == SPRING_OK && spring_scene_set_gravity(p.other, moon) == SPRING_OK,
              "gravity");
        advance(&p, *method, 1);
        CHECK(spring_scene_get(p.s, SPRING_VELOCITY, some, 5, p.n / 2, p.n - p.n / 2) == SPRING_OK, "half of them");
        for (size_t i = 0; i < p.n - p.n / 2; i++)
            for (uint32_t a = 0; a < axes; a++)
                some[5 * i + a] *= -0.5;
        CHECK(spring_scene_set(p.s, SPRING_VELOCITY, some, 5, p.n / 2, p.n - p.n / 2) == SPRING_OK &&
                  spring_scene_set(p.other, SPRING_VELOCITY, some, 5, p.n / 2, p.n - p.n / 2) == SPRING_OK,
              "are turned round");
        advance(&p, *method, 2);
        for (size_t i = 0; i < m->def.links && (m->def.flags & SPRING_SCENE_EDITABLE) != 0; i += 2) {
            spring_link link = m->link[i];
            link.stiffness = i % 4 ? 0 : 7.3;
            link.damping = i % 4 ? 0 : 0.2;
            CHECK(spring_scene_set_link(p.s, i, &link) == SPRING_OK &&
                      spring_scene_set_link(p.other, i, &link) == SPRING_OK,
                  "every second link");
        }
        advance(&p, *method, 2);
    }
    /* overflow, where not all particles are pinned and stay so */
    const double huge = sizeof(scalar) == 4 ? 3e38 : 1e308, fast[3] = {huge, huge, huge};
    const bool rollback = (m->def.flags & SPRING_SCENE_NO_UNDO) == 0;
    static state y;
    get_state(p.s, p.n, &y);
    spring_scene *const both[] = {p.s, p.other};
    for (int i = 0; i < 2; i++) {
        spring_scene_set(both[i], SPRING_VELOCITY, fast, 0, 0, 1);
        CHECK(spring_scene_advance_with(kernels, both[i], SPRING_EULER, huge, 1) == SPRING_ENONFINITE, "overflow");
        CHECK(rollback || !all_finite(both[i], p.n, axes), "the state is lost, or as it was");
        set_state(both[i], p.n, &y);
    }
    if (!rollback) { /* strangers are to be set again, too */
        double rest[3 * strangers] = {0};
        spring_scene_set(p.other, SPRING_POSITION, rest, 0, p.n, strangers);
        spring_scene_set(p.other, SPRING_VELOCITY, rest, 0, p.n, strangers);
    }
    p.w.calls = p.other_w.calls = 0; /* one may have noticed earlier: it has more numbers to look at */
    p.w.sum = p.other_w.sum = 0;
    for (const spring_method *method = p.methods.at; *method != no_method; method++)
        advance(&p, *method, 2);
    free(p.s);
    free(p.other);
}

static void against_larger_scenes(void)
{
    static model m;
    unsigned features = 0;
    for (uint32_t axes = 2; axes <= 3; axes++)
        for (size_t n = 1; n <= 12; n++)
            for (int round = 0; round < 12; round++) {
                features = (features + 37) % feature_masks;
                build_small(&m, n, random_bits() % 13, axes, features);
                m.def.flags |= round % 4 == 3 ? SPRING_SCENE_NO_UNDO : 0;
                for (int k = 0; k < kernel_count; k++)
                    if (kernels_of(k) != NULL)
                        check_small(&m, kernels_of(k), round % 3);
            }
}

/* The block may be copied to another place. */
static void snapshots(void)
{
    static model m;
    for (uint32_t axes = 2; axes <= 3; axes++) {
        build_small(&m, 7, 9, axes, DAMPED | MASSES | GRAVITY);
        spring_scene *s = scene_of(&m.def), *copy = scene_of(&m.def);
        size_t bytes = 0;
        spring_scene_bytes(&m.def, &bytes);
        spring_scene_advance(s, SPRING_LEAPFROG, 0.004, 5);
        memcpy(copy, s, bytes);
        spring_scene_advance(s, SPRING_RK4, 0.004, 5);
        spring_scene_advance(copy, SPRING_RK4, 0.004, 5);
        CHECK(same_bits(s, copy, m.def.particles, axes), "a working scene");
        free(s);
        free(copy);
    }
}

int main(void)
{
    static const test tests[] = {
        {"forces against a plain loop", against_a_plain_loop},
        {"as in larger scenes", against_larger_scenes},
        {"snapshots", snapshots},
    };
    return RUN_TESTS("scene-small", tests);
}
