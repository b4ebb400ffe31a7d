/* SPDX-License-Identifier: MIT */
/* Changes of a running scene: pins, masses, driven particles. Finding links. */
#include "test_scene.h"

/* small, with bands, with unbanded links alone */
static const struct {
    uint32_t count[3];
    unsigned features;
} shapes[] = {
    {{5, 1, 1}, OWN},
    {{5, 1, 1}, DAMPED | DRAG},
    {{13, 7, 1}, GRAVITY | DRAG},
    {{13, 7, 1}, DAMPED | OWN | STRAY},
    {{4, 3, 5}, SHUFFLED | DAMPED | GRAVITY},
};
static const size_t shape_count = sizeof shapes / sizeof shapes[0];

static const double dt = 0.009;

static void check_same(spring_scene *s, spring_scene *as_defined, const model *m, spring_method method)
{
    CHECK_BITS(spring_scene_stable_step(s, method), spring_scene_stable_step(as_defined, method),
               "the stable step knows");
    CHECK(spring_scene_advance(s, method, dt, 7) == SPRING_OK &&
              spring_scene_advance(as_defined, method, dt, 7) == SPRING_OK,
          "stable");
    CHECK(same_bits(s, as_defined, m->def.particles, m->def.axes), "as good as defined so");
    const spring_scene_energies a = spring_scene_energy(s), b = spring_scene_energy(as_defined);
    CHECK(a.elastic == b.elastic && fabs(a.kinetic - b.kinetic) <= 8 * EPS * b.kinetic &&
              fabs(a.gravity - b.gravity) <= 1e3 * EPS * (1 + fabs(b.gravity)), /* a mass, or 1 over it, is rounded */
          "so do the energies");
}

/* A scene that was defined without pins and masses, and then given some, in the middle of its life. */
static void as_good_as_defined(void)
{
    static model m, changed;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t k = 0; k < shape_count; k++) {
            build(&m, shapes[k].count, axes, shapes[k].features | EDITABLE);
            m.pinned[1] = 1; /* one at least */
            const size_t n = m.def.particles;
            const method_list all = use_all_methods(&m.def);
            for (const spring_method *method = all.at; *method != no_method; method++) {
                spring_scene *s = scene_of(&m.def);
                CHECK(spring_scene_advance(s, *method, dt, 5) == SPRING_OK, "stable");
                const size_t half = n / 2;
                CHECK(spring_scene_set_mass(s, half, n - half, m.mass + half) == SPRING_OK, "the later ones");
                CHECK(spring_scene_set_pinned(s, 0, n, m.pinned) == SPRING_OK, "some");
                CHECK(spring_scene_set_mass(s, 0, half, m.mass) == SPRING_OK, "the first ones, some of them pinned");
                get_state(s, n, &y);
                for (size_t i = 0; i < n * axes; i++)
                    CHECK(!m.pinned[i / axes] || y.v[i] == 0, "who is pinned stops");
                changed = m;
                changed.def.flags = 0;
                changed.def.position = y.x;
                changed.def.velocity = y.v;
                changed.def.mass = changed.mass;
                changed.def.pinned = changed.pinned;
                changed.def.link = changed.link;
                spring_scene *as_defined = scene_of(&changed.def);
                check_same(s, as_defined, &m, *method);
                free(as_defined);

                const uint8_t *none = (const uint8_t[most]){0};
                CHECK(spring_scene_set_pinned(s, 0, n, none) == SPRING_OK, "all are freed");
                get_state(s, n, &y);
                changed.def.pinned = NULL;
                as_defined = scene_of(&changed.def);
                check_same(s, as_defined, &m, *method);
                free(as_defined);
                free(s);
            }
        }
}

/* Which mass a particle has that was defined as pinned. */
static void masses_of_the_freed(void)
{
    const double x[] = {0, 1, 2}, mass[] = {0, 0.4, -3};
    const uint8_t pinned[] = {1, 1, 1}, freed[] = {0};
    const spring_link link[] = {{0, 1, 0.5, 3, 0}, {1, 2, 0.5, 3, 0}};
    const struct {
        const double *mass;
        double all, want[3];
    } cases[] = {
        {NULL, 0, {1, 1, 1}}, {NULL, 0.7, {0.7, 0.7, 0.7}}, {mass, 0.7, {0.7, 0.4, 0.7}}, {mass, 0, {1, 0.4, 1}}};
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++)
        for (size_t i = 0; i < 3; i++) {
            const spring_scene_def def = {.axes = 1,
                                          .flags = SPRING_SCENE_EDITABLE,
                                          .particles = 3,
                                          .links = 2,
                                          .position = x,
                                          .mass = cases[c].mass,
                                          .mass_all = cases[c].all,
                                          .pinned = pinned,
                                          .link = link};
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

/* Everything that can be seen, and what the scene keeps: its block. */
static void *copy_of(const spring_scene *s, size_t bytes)
{
    void *copy = malloc(bytes);
    memcpy(copy, s, bytes);
    return copy;
}

#define REFUSES(status, call)                                            \
    do {                                                                 \
        void *before = copy_of(s, bytes);                                \
        CHECK((call) == (status), "refused");                            \
        CHECK(memcmp(s, before, bytes) == 0, "and nothing has changed"); \
        free(before);                                                    \
    } while (0)

static void refused_edits(void)
{
    enum { n = 14 };
    const double huge = sizeof(scalar) == 4 ? 1e38 : 1e307, x[2 * n] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    double mass[n] = {1e-310}; /* that of the first could not be defined, but it is pinned */
    uint8_t pinned[n] = {1, 1}, free_all[n] = {0};
    spring_link link[n - 1];
    for (uint32_t i = 0; i < n; i++)
        mass[i] = i == 0 ? 1e-310 : 1;
    for (uint32_t i = 0; i + 1 < n; i++)
        link[i] = (spring_link){i, i + 1, 0.5, i == 1 ? huge : 3, i == 4 ? huge : 0};
    spring_scene_def def = {.axes = 2,
                            .flags = SPRING_SCENE_EDITABLE,
                            .particles = n,
                            .links = n - 1,
                            .position = x,
                            .mass = mass,
                            .pinned = pinned,
                            .link = link,
                            .drag = huge};
    size_t bytes;
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "valid");
    spring_scene *s = scene_of(&def);
    const double good[n] = {2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2};
    REFUSES(SPRING_EINVAL, spring_scene_set_pinned(s, 0, 1, NULL));
    REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 0, 1, NULL));
    REFUSES(SPRING_ERANGE, spring_scene_set_pinned(s, 1, n, pinned));
    REFUSES(SPRING_ERANGE, spring_scene_set_pinned(s, n + 1, 0, pinned));
    REFUSES(SPRING_ERANGE, spring_scene_set_pinned(s, 1, SIZE_MAX, pinned));
    REFUSES(SPRING_ERANGE, spring_scene_set_mass(s, n, 1, good));
    REFUSES(SPRING_EINVAL, spring_scene_set_pinned(s, 0, 2, free_all)); /* the mass of the first */
    CHECK(spring_scene_set_pinned(s, 1, 1, free_all) == SPRING_OK &&
              spring_scene_set_pinned(s, 1, 1, pinned) == SPRING_OK,
          "the second has one");
    const double bad[] = {0, -1, NAN, INFINITY, 1e-310, 0.01 /* with this drag, or these links */};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 7, 1, &bad[i]));
    for (size_t i = 0; i < 5; i++) {
        double several[] = {2, 2, bad[i]};
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 0, 3, several));
        REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 0, 1, &bad[i])); /* of a pinned one, too */
    }
    CHECK(spring_scene_set_mass(s, 0, n, good) == SPRING_OK && spring_scene_set_mass(s, n, 0, good) == SPRING_OK,
          "fine");
    CHECK(spring_scene_set_mass(s, 1, 1, &bad[5]) == SPRING_OK, "of a pinned one it does not matter yet");
    REFUSES(SPRING_EINVAL, spring_scene_set_pinned(s, 0, 2, free_all)); /* now it does */
    free(s);

    def.drag = 0;
    s = scene_of(&def); /* the mass of an end of a link: too light for stiffness, then for damping, at either end */
    for (size_t i = 2; i < 7; i++) {
        const bool strong = i == 2 || i == 4 || i == 5;
        const double light = 0.01;
        if (strong)
            REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, i, 1, &light));
        else
            CHECK(spring_scene_set_mass(s, i, 1, &light) == SPRING_OK, "its links bear it");
    }
    const double not_the_next[] = {0.009, 0.01};
    CHECK(spring_scene_set_mass(s, 3, 1, not_the_next) == SPRING_OK, "of one, whatever comes next in the array");
    free(s);
    link[0] = (spring_link){2, 3, 0.5, huge, 0};
    def.links = 1;
    s = scene_of(&def);
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "valid");
    REFUSES(SPRING_EINVAL, spring_scene_set_mass(s, 2, 1, &bad[5])); /* of the only link */
    free(s);

    def.flags = 0;
    CHECK(spring_scene_bytes(&def, &bytes) == SPRING_OK, "valid");
    s = scene_of(&def);
    REFUSES(SPRING_EDISABLED, spring_scene_set_pinned(s, 0, 1, pinned));
    REFUSES(SPRING_EDISABLED, spring_scene_set_mass(s, 0, 1, good));
    CHECK(spring_scene_set_pinned(NULL, 0, 1, pinned) == SPRING_EINVAL &&
              spring_scene_set_mass(NULL, 0, 1, good) == SPRING_EINVAL,
          "no scene");
    free(s);
}

/* Edits that change nothing leave the forces that leapfrog keeps, which are part of the state where links are damped. */
static void edits_of_nothing(void)
{
    static model m;
    for (size_t k = 0; k < shape_count; k++) {
        build(&m, shapes[k].count, 2, shapes[k].features | EDITABLE | PINNED | MASSES);
        m.def.velocity = NULL;
        m.pinned[2] = 1;
        spring_scene *s = scene_of(&m.def), *other = scene_of(&m.def);
        for (int i = 0; i < 20; i++) {
            CHECK(spring_scene_set_pinned(s, 0, m.def.particles, m.pinned) == SPRING_OK &&
                      spring_scene_set_mass(s, 0, m.def.particles, m.mass) == SPRING_OK &&
                      spring_scene_set_mass(s, 3, 0, m.mass) == SPRING_OK &&
                      spring_scene_drive(s, 2, NULL, 0) == SPRING_OK,
                  "as they are");
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 1) == SPRING_OK &&
                      spring_scene_advance(other, SPRING_LEAPFROG, dt, 1) == SPRING_OK,
                  "stable");
        }
        CHECK(same_bits(s, other, m.def.particles, 2), "as if nothing had been said");
        free(s);
        free(other);
    }
}

/* Edits that are taken back leave every byte as it was: they write to nothing else. (What is computed anew is asked for
   before, by a link that is set to what it is.) */
static void edits_taken_back(void)
{
    static model m;
    const uint8_t pin = 1, free_again = 0;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t k = 0; k < shape_count; k++) {
            build(&m, shapes[k].count, axes, shapes[k].features | EDITABLE | PINNED | MASSES);
            const size_t n = m.def.particles, driven = n - 2, other = n - 1;
            m.pinned[driven] = 1, m.pinned[other] = 0;
            size_t bytes;
            CHECK(spring_scene_bytes(&m.def, &bytes) == SPRING_OK, "valid");
            spring_scene *s = scene_of(&m.def);
            for (uint64_t steps = 1; steps <= 2; steps++) { /* the state is in either buffer */
                spring_link link;
                CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, steps) == SPRING_OK &&
                          spring_scene_get_link(s, 0, &link) == SPRING_OK &&
                          spring_scene_set_link(s, 0, &link) == SPRING_OK,
                      "stable");
                spring_scene_stable_step(s, SPRING_LEAPFROG);
                void *before = copy_of(s, bytes);
                const double target[] = {5, 6, 7};
                double v[2 * 3];
                CHECK(spring_scene_get(s, SPRING_VELOCITY, v, axes, driven, 2) == SPRING_OK, "two particles");
                CHECK(spring_scene_drive(s, driven, target, 1) == SPRING_OK &&
                          spring_scene_set_pinned(s, other, 1, &pin) == SPRING_OK &&
                          spring_scene_set_pinned(s, other, 1, &free_again) == SPRING_OK &&
                          spring_scene_set(s, SPRING_VELOCITY, v, axes, driven, 2) == SPRING_OK,
                      "driven, pinned, and all taken back");
                spring_scene_stable_step(s, SPRING_LEAPFROG);
                CHECK(memcmp(s, before, bytes) == 0, "as it was");
                free(before);
            }
            free(s);
        }
}

/* ------------------------------------------------------------------------------------------------- driven particles */

static void driven(void)
{
    static model m;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t k = 0; k < shape_count; k++) {
            build(&m, shapes[k].count, axes, shapes[k].features | PINNED);
            m.pinned[2] = 1;
            const size_t n = m.def.particles;
            const method_list all = use_all_methods(&m.def);
            for (const spring_method *method = all.at; *method != no_method; method++) {
                spring_scene *s = scene_of(&m.def), *other = scene_of(&m.def);
                spring_scene_advance(s, *method, dt, 3);
                spring_scene_advance(other, *method, dt, 3);
                get_state(s, n, &y);
                double target[3], velocity[3];
                for (uint32_t a = 0; a < axes; a++) {
                    target[a] = y.x[2 * axes + a] + 0.3 * (a + 1);
                    velocity[a] = (target[a] - y.x[2 * axes + a]) / (4 * dt);
                }
                CHECK(spring_scene_drive(s, 2, target, 4 * dt) == SPRING_OK, "it is pinned");
                CHECK(spring_scene_set(other, SPRING_VELOCITY, velocity, 0, 2, 1) == SPRING_OK, "the same by hand");
                spring_scene_advance(s, *method, dt, 4);
                spring_scene_advance(other, *method, dt, 4);
                CHECK(same_bits(s, other, n, axes), "the velocity that brings it there");
                get_state(s, n, &y);
                for (uint32_t a = 0; a < axes; a++) /* 4 steps and a quotient are rounded */
                    CHECK_CLOSE(y.x[2 * axes + a], target[a], 16 * EPS * (1 + fabs(target[a])), "there it is");
                CHECK(spring_scene_drive(s, 2, NULL, NAN) == SPRING_OK, "it stops");
                spring_scene_advance(s, *method, dt, 4);
                double stays[3];
                spring_scene_get(s, SPRING_POSITION, stays, 0, 2, 1);
                CHECK(memcmp(stays, &y.x[2 * axes], axes * sizeof stays[0]) == 0, "and stays there");
                free(s);
                free(other);
            }
        }
}

static void refused_drives(void)
{
    static model m;
    build(&m, shapes[2].count, 2, PINNED);
    m.pinned[3] = 1, m.pinned[4] = 0;
    size_t bytes;
    CHECK(spring_scene_bytes(&m.def, &bytes) == SPRING_OK, "valid");
    spring_scene *s = scene_of(&m.def);
    const double target[] = {1, 2}, none[] = {1, NAN}, far[] = {1e308, 0};
    REFUSES(SPRING_EINVAL, spring_scene_drive(s, 4, target, 1));
    REFUSES(SPRING_EINVAL, spring_scene_drive(s, 4, NULL, 1));
    REFUSES(SPRING_ERANGE, spring_scene_drive(s, m.def.particles, target, 1));
    REFUSES(SPRING_EINVAL, spring_scene_drive(s, 3, none, 1));
    REFUSES(SPRING_EINVAL, spring_scene_drive(s, 3, far, 1e-9));
    const double durations[] = {0, -1, NAN, INFINITY};
    for (size_t i = 0; i < 4; i++)
        REFUSES(SPRING_EINVAL, spring_scene_drive(s, 3, target, durations[i]));
    CHECK(spring_scene_drive(NULL, 0, target, 1) == SPRING_EINVAL, "no scene");
    free(s);
}

static void count_call(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                       scalar *const force[3])
{
    (void)t, (void)particles, (void)x, (void)v, (void)force;
    ++*(size_t *)user;
}

/* Driving a particle each frame costs no evaluation, where no force sees its velocity. */
static void driving_is_free(void)
{
    static model m;
    size_t calls = 0;
    build(&m, shapes[2].count, 2, PINNED);
    m.pinned[3] = 1;
    m.def.flags |= SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    m.def.force = count_call;
    m.def.user = &calls;
    spring_scene *s = scene_of(&m.def);
    const double target[] = {1, 2};
    spring_scene_advance(s, SPRING_LEAPFROG, dt, 1);
    calls = 0;
    for (int frame = 0; frame < 5; frame++) {
        CHECK(spring_scene_drive(s, 3, target, 4 * dt) == SPRING_OK, "pinned");
        spring_scene_advance(s, SPRING_LEAPFROG, dt, 4);
    }
    CHECK(calls == 20, "one a step");
    free(s);
}

/* ------------------------------------------------------------------------------------------------------------ links */

static bool joins(const spring_link *link, uint32_t a, uint32_t b)
{
    return (link->a == a && link->b == b) || (link->a == b && link->b == a);
}

static void links_found(void)
{
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 3) {
            build(&m, shapes[4].count, axes, features);
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
                const spring_link cut = {want->a, want->b, 1, 0, 0};
                if (features & EDITABLE && spring_scene_set_link(s, i, &cut) == SPRING_OK)
                    CHECK(spring_scene_find_link(s, want->a, want->b) == least, "cut ones, too");
            }
            spring_link link;
            CHECK(spring_scene_find_link(s, 0, 0) == SIZE_MAX &&
                      spring_scene_find_link(s, (uint32_t)m.def.particles, 0) == SIZE_MAX &&
                      spring_scene_find_link(NULL, 0, 1) == SIZE_MAX,
                  "none");
            CHECK(spring_scene_get_link(s, m.def.links, &link) == SPRING_ERANGE &&
                      spring_scene_get_link(s, 0, NULL) == SPRING_EINVAL &&
                      spring_scene_get_link(NULL, 0, &link) == SPRING_EINVAL,
                  "bad input");
            free(s);
        }
}

/* A grabbed particle of a rope: pinned, dragged, let go with the speed of the hand. */
static void grabbed(void)
{
    enum { n = 20 };
    double x[2 * n] = {0};
    const uint8_t hold[] = {1}, let_go[] = {0};
    spring_link link[n - 1];
    for (uint32_t i = 0; i < n; i++) {
        x[2 * i] = 0.1 * i;
        if (i > 0)
            link[i - 1] = (spring_link){i - 1, i, 0.1, 400, 0.2};
    }
    const spring_scene_def def = {.axes = 2,
                                  .flags = SPRING_SCENE_EDITABLE,
                                  .particles = n,
                                  .links = n - 1,
                                  .position = x,
                                  .mass_all = 0.05,
                                  .link = link};
    spring_scene *s = scene_of(&def);
    CHECK(spring_scene_set_pinned(s, 9, 1, hold) == SPRING_OK, "grabbed");
    double hand[] = {0.9, 0};
    for (int frame = 1; frame <= 30; frame++) {
        hand[1] = 0.02 * frame;
        CHECK(spring_scene_drive(s, 9, hand, 1.0 / 60) == SPRING_OK &&
                  spring_scene_advance(s, SPRING_LEAPFROG, 1.0 / 960, 16) == SPRING_OK,
              "dragged");
    }
    double at[2], v[2];
    spring_scene_get(s, SPRING_POSITION, at, 0, 9, 1);
    CHECK_CLOSE(at[1], 0.6, 500 * EPS, "where the hand is: 480 steps are rounded");
    CHECK(spring_scene_set_pinned(s, 9, 1, let_go) == SPRING_OK, "let go");
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 9, 1);
    CHECK_CLOSE(v[1], 0.02 * 60, 2000 * EPS, "it flies on; the difference of two places is rounded, over a frame");
    free(s);
}

int main(void)
{
    static const test tests[] = {
        {"as good as defined so", as_good_as_defined},
        {"the masses of freed particles", masses_of_the_freed},
        {"edits that are refused", refused_edits},
        {"edits that change nothing", edits_of_nothing},
        {"edits that are taken back", edits_taken_back},
        {"driven particles", driven},
        {"drives that are refused", refused_drives},
        {"driving is free", driving_is_free},
        {"links are found", links_found},
        {"a grabbed particle", grabbed},
    };
    return RUN_TESTS("scene_edits", tests);
}
