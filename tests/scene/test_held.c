/* SPDX-License-Identifier: MIT */
/* Held forces, and moving a whole scene by an affine map. */
#include "test_scene.h"

/* ---------------------------------------------------------------------------------------------------------------- held */

static const uint32_t shapes[][3] = {{6, 1, 1}, {11, 2, 1}, {5, 4, 3}, {70, 4, 1}};
enum { shape_count = sizeof shapes / sizeof shapes[0] };

static void run_all_methods(spring_scene *s, const method_list *all)
{
    for (const spring_method *method = all->at; *method != no_method; method++)
        CHECK(spring_scene_advance(s, *method, 1e-3, 10) == SPRING_OK, "stable");
}

static void check_close_states(const spring_scene *s, const spring_scene *other, size_t count, size_t particles,
                               double bound, const char *why)
{
    static state a, b;
    get_state(s, particles, &a);
    get_state(other, particles, &b);
    for (size_t i = 0; i < count; i++) {
        CHECK_CLOSE(a.x[i], b.x[i], bound * fmax(1, fabs(b.x[i])), why);
        CHECK_CLOSE(a.v[i], b.v[i], bound * fmax(1, fabs(b.v[i])), why);
    }
}

/* A held force m g is gravity, with every method, for pinned particles, too. */
static void like_gravity(void)
{
    static model m;
    static double force[3 * most];
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 29)
            for (size_t k = 0; k < shape_count; k++) {
                build(&m, shapes[k], axes, features | GRAVITY);
                const method_list all = methods_of(m.def);
                spring_scene *falling = scene_of(&m.def);
                for (size_t i = 0; i < m.def.particles; i++)
                    for (uint32_t a = 0; a < axes; a++)
                        force[i * axes + a] = mass_in(&m.def, i) * m.def.gravity[a];
                memset(m.def.gravity, 0, sizeof m.def.gravity);
                m.def.flags |= SPRING_SCENE_FORCES;
                spring_scene *held = scene_of(&m.def);
                CHECK(spring_scene_set(held, SPRING_FORCE, force, 0, 0, m.def.particles) == SPRING_OK, "held");
                run_all_methods(falling, &all);
                run_all_methods(held, &all);
                check_close_states(
                    held, falling, m.def.particles * axes, m.def.particles, 1000 * EPS,
                    "three roundings of an acceleration of 10 in each of 50 steps, and what they become");
                free(falling);
                free(held);
            }
}

/* Without the flag there is no room; with it, forces of 0 change no bit. */
static void zero_is_absent(void)
{
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 17) {
            build(&m, shapes[features % shape_count], axes, features);
            const method_list all = methods_of(m.def);
            size_t bytes = 0, more = 0;
            spring_scene_bytes(&m.def, &bytes);
            spring_scene *s = scene_of(&m.def);
            m.def.flags |= SPRING_SCENE_FORCES;
            spring_scene_bytes(&m.def, &more);
            const size_t quantity = (s->layout.quantity * sizeof(scalar) + 63) / 64 * 64;
            CHECK(more == bytes + quantity, "one quantity of all particles");
            spring_scene *held = scene_of(&m.def);
            run_all_methods(s, &all);
            run_all_methods(held, &all);
            CHECK(same_bits(s, held, m.def.particles, axes), "no force is held");
            free(s);
            free(held);
        }
}

static spring_scene *run_held(const scene_kernels *kernels, const spring_scene_def *def, const double *force)
{
    spring_scene *s = scene_of(def);
    const method_list all = methods_of(*def);
    CHECK(spring_scene_set(s, SPRING_FORCE, force, 0, 0, def->particles) == SPRING_OK, "held");
    for (const spring_method *method = all.at; *method != no_method; method++)
        CHECK(spring_scene_advance_with(kernels, s, *method, 1e-3, 5) == SPRING_OK, "stable");
    return s;
}

static void same_with_all_kernels(void)
{
    static model m;
    static double force[3 * most];
    for (size_t i = 0; i < 3 * most; i++)
        force[i] = random_uniform(-3, 3);
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 21) {
            build(&m, shapes[features % shape_count], axes, features);
            m.def.flags |= SPRING_SCENE_FORCES;
            spring_scene *first = run_held(kernels_of(0), &m.def, force);
            for (int k = 1; k < kernel_count; k++)
                if (kernels_of(k) != NULL) {
                    spring_scene *s = run_held(kernels_of(k), &m.def, force);
                    CHECK(same_bits(s, first, m.def.particles, axes), "lane by lane the same operations");
                    free(s);
                }
            free(first);
        }
}

static unsigned calls;

static void count_calls(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                        scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v, (void)force;
    calls++;
}

/* Forces that change every frame cost no evaluation, and act from the next step on. */
static void changed_every_frame(void)
{
    static model m;
    static double force[3 * most];
    enum { frames = 20, steps = 8 };
    build(&m, (uint32_t[]){9, 7, 1}, 3, GRAVITY | DRAG);
    m.def.flags = SPRING_SCENE_FORCES | SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    m.def.force = count_calls;
    spring_scene *s = scene_of(&m.def);
    calls = 0;
    for (int frame = 0; frame < frames; frame++) {
        for (size_t i = 0; i < 3 * m.def.particles; i++)
            force[i] = random_uniform(-1, 1);
        CHECK(spring_scene_set(s, SPRING_FORCE, force, 0, 0, m.def.particles) == SPRING_OK &&
                  spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, steps) == SPRING_OK,
              "stable");
    }
    CHECK(calls == 1 + frames * steps, "one evaluation a step, and one at the start");
    free(s);
}

/* A single particle under a force that changes between calls: x'' = F/m, which leapfrog integrates exactly. */
static void exact_motion(void)
{
    const double start[] = {0.3, -0.2, 0.1}, mass = 1.7, dt = 0.01;
    const spring_scene_def def = {.flags = SPRING_SCENE_FORCES, .particles = 1, .position = start, .mass_all = mass};
    spring_scene *s = scene_of(&def);
    double x[3], v[3] = {0}, now[3], speed[3];
    memcpy(x, start, sizeof x);
    for (int call = 0; call < 5; call++) {
        const double force[] = {0.3 * call, -1.1, 0.7 - call}, t = 20 * dt;
        CHECK(spring_scene_set(s, SPRING_FORCE, force, 0, 0, 1) == SPRING_OK &&
                  spring_scene_advance(s, SPRING_LEAPFROG, dt, 20) == SPRING_OK,
              "stable");
        spring_scene_get(s, SPRING_POSITION, now, 0, 0, 1);
        spring_scene_get(s, SPRING_VELOCITY, speed, 0, 0, 1);
        for (int a = 0; a < 3; a++) {
            x[a] += t * v[a] + t * t / 2 * force[a] / mass;
            v[a] += t * force[a] / mass;
            CHECK_CLOSE(now[a], x[a], 400 * EPS, "two roundings in each of 100 steps, of numbers up to 2");
            CHECK_CLOSE(speed[a], v[a], 400 * EPS, "two roundings in each of 100 steps, of numbers up to 2");
        }
    }
    free(s);
}

/* They are stored in the precision of the scene, with any stride; not for a scene without them. */
static void stored(void)
{
    static model m;
    static double force[4 * most], back[4 * most];
    static float backf[4 * most];
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t k = 0; k < shape_count; k++) {
            build(&m, shapes[k], axes, 0);
            spring_scene *without = scene_of(&m.def);
            for (size_t i = 0; i < 4 * most; i++)
                force[i] = random_uniform(-9, 9);
            CHECK(spring_scene_set(without, SPRING_FORCE, force, 4, 0, 1) == SPRING_EDISABLED &&
                      spring_scene_get(without, SPRING_FORCE, back, 4, 0, 1) == SPRING_EDISABLED &&
                      spring_scene_getf(without, SPRING_FORCE, backf, 4, 0, 1) == SPRING_EDISABLED,
                  "no room");
            free(without);
            m.def.flags = SPRING_SCENE_FORCES;
            spring_scene *s = scene_of(&m.def);
            const size_t n = m.def.particles;
            CHECK(spring_scene_get(s, SPRING_FORCE, back, 0, 0, n) == SPRING_OK, "there is room");
            for (size_t i = 0; i < n * axes; i++)
                CHECK_BITS(back[i], 0, "at first nothing is held");
            CHECK(spring_scene_set(s, SPRING_FORCE, force, 4, 1, n - 1) == SPRING_OK &&
                      spring_scene_get(s, SPRING_FORCE, back, 4, 1, n - 1) == SPRING_OK &&
                      spring_scene_getf(s, SPRING_FORCE, backf, 4, 1, n - 1) == SPRING_OK,
                  "set and get");
            for (size_t i = 0; i + 1 < n; i++)
                for (uint32_t a = 0; a < axes; a++) {
                    CHECK_BITS(back[4 * i + a], (double)(scalar)force[4 * i + a], "in the precision of the scene");
                    CHECK_BITS((double)backf[4 * i + a], (double)(float)(scalar)force[4 * i + a], "as a float");
                }
            force[0] = INFINITY;
            CHECK(spring_scene_set(s, SPRING_FORCE, force, 4, 1, 1) == SPRING_EINVAL &&
                      spring_scene_set(s, SPRING_FORCE, force, 4, n, 1) == SPRING_ERANGE &&
                      spring_scene_set(s, SPRING_FORCE, NULL, 4, 0, 1) == SPRING_EINVAL &&
                      spring_scene_set(s, (spring_quantity)3, force + 4, 4, 0, 1) == SPRING_EINVAL,
                  "bad input");
            spring_scene_get(s, SPRING_FORCE, force, 4, 1, n - 1);
            CHECK(memcmp(force, back, 4 * sizeof force[0] - (4 - axes) * sizeof force[0]) == 0, "changes nothing");
            free(s);
        }
}

/* A force of -m g balances gravity; it is counted by at_rest() and not by energy and tension. */
static void at_rest(void)
{
    const double x[] = {0, 0, 0, 1, 0, 0}, mass = 1.3;
    const spring_link link = {0, 1, 1, 70, 0};
    for (uint32_t more = 0; more <= 40; more += 40) { /* small, and not */
        static double position[3 * 42], force[3 * 42];
        memcpy(position, x, sizeof x);
        for (size_t i = 0; i < 42; i++)
            force[3 * i + 1] = mass * 9.81;
        const spring_scene_def def = {.flags = SPRING_SCENE_FORCES,
                                      .particles = 2 + more,
                                      .links = 1,
                                      .position = position,
                                      .mass_all = mass,
                                      .link = &link,
                                      .gravity = {0, -9.81, 0}};
        spring_scene *s = scene_of(&def);
        CHECK(!spring_scene_at_rest(s, 0, 1), "falls");
        const spring_scene_energies before = spring_scene_energy(s);
        spring_scene_set(s, SPRING_FORCE, force, 0, 0, def.particles);
        CHECK(spring_scene_at_rest(s, 0, 20 * EPS), "is held, except for rounding");
        const spring_scene_energies after = spring_scene_energy(s);
        CHECK(memcmp(&before, &after, sizeof before) == 0 && spring_scene_tension(s, 0) == 0, "no energy, no tension");
        free(s);
    }
}

/* A call that fails leaves them alone, also without rollback; a snapshot has them; a pin does not feel them. */
static void failures_and_snapshots(void)
{
    static model m;
    static double force[3 * most], back[3 * most];
    for (int undo = 0; undo < 2; undo++)
        for (size_t k = 0; k < shape_count; k++) {
            build(&m, shapes[k], 3, GRAVITY | MASSES);
            m.def.flags = SPRING_SCENE_FORCES | (undo ? 0 : SPRING_SCENE_NO_UNDO);
            const size_t n = m.def.particles, size = 3 * n * sizeof force[0];
            size_t bytes = 0;
            spring_scene_bytes(&m.def, &bytes);
            spring_scene *s = scene_of(&m.def), *copy = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
            for (size_t i = 0; i < 3 * n; i++)
                force[i] = (double)(scalar)random_uniform(-3, 3);
            spring_scene_set(s, SPRING_FORCE, force, 0, 0, n);
            memcpy(copy, s, bytes);
            static state y;
            get_state(s, n, &y);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, sizeof(scalar) == 4 ? 1e38 : 1e300, 9) == SPRING_ENONFINITE,
                  "overflows");
            CHECK(spring_scene_get(s, SPRING_FORCE, back, 0, 0, n) == SPRING_OK && memcmp(back, force, size) == 0,
                  "held forces stay");
            if (!undo)
                set_state(s, n, &y);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 5) == SPRING_OK &&
                      spring_scene_advance(copy, SPRING_LEAPFROG, 1e-3, 5) == SPRING_OK && same_bits(s, copy, n, 3),
                  "a snapshot goes on with them");
            free(copy);
            free(s);
        }
}

static void pinned(void)
{
    static model m;
    static double force[3 * most];
    build(&m, (uint32_t[]){30, 2, 1}, 3, PINNED | EDITABLE);
    for (size_t i = 0; i < m.def.particles; i++)
        m.pinned[i] = i < 5;
    memset(m.velocity, 0, sizeof m.velocity);
    m.def.flags |= SPRING_SCENE_FORCES;
    spring_scene *s = scene_of(&m.def);
    for (size_t i = 0; i < 3 * m.def.particles; i++)
        force[i] = 1e3;
    spring_scene_set(s, SPRING_FORCE, force, 0, 0, m.def.particles);
    spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 3);
    double v[3];
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 2, 1);
    CHECK(v[0] == 0 && v[1] == 0 && v[2] == 0, "a pin feels no force");
    spring_scene_set_pinned(s, 2, 1, &(uint8_t){0});
    spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 1);
    spring_scene_get(s, SPRING_VELOCITY, v, 0, 2, 1);
    for (int a = 0; a < 3; a++)
        CHECK_CLOSE(v[a], 1e3 / 1.7 * 1e-3, 0.1, "free, it does: F/m dt, and little by links");
    free(s);
}

/* ----------------------------------------------------------------------------------------------------------- transform */

/* A rotation about an axis through the origin by the angle t, and a shift. Two axes: in the plane. */
static void rigid(double matrix[12], uint32_t axes)
{
    const double t = random_uniform(-3, 3), c = cos(t), s = sin(t), turn[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
    const double u = axes == 3 ? random_uniform(-3, 3) : 0,
                 tilt[3][3] = {{1, 0, 0}, {0, cos(u), -sin(u)}, {0, sin(u), cos(u)}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            matrix[4 * i + j] = turn[i][0] * tilt[0][j] + turn[i][1] * tilt[1][j] + turn[i][2] * tilt[2][j];
        matrix[4 * i + 3] = random_uniform(-2, 2);
    }
    if (axes == 1) {
        matrix[0] = 1; /* a link on one axis has a direction */
        matrix[1] = NAN;
    }
    for (int i = 0; i < 3 && axes < 3; i++) /* no number that is read */
        matrix[4 * i + 2] = matrix[8 + i] = NAN;
}

static void transform_state(const double matrix[12], uint32_t axes, size_t particles, state *y)
{
    for (size_t i = 0; i < particles; i++) {
        double x[3] = {0}, v[3] = {0};
        for (uint32_t a = 0; a < axes; a++) {
            for (uint32_t b = 0; b < axes; b++) {
                x[a] += matrix[4 * a + b] * y->x[i * axes + b];
                v[a] += matrix[4 * a + b] * y->v[i * axes + b];
            }
            x[a] += matrix[4 * a + 3];
        }
        memcpy(&y->x[i * axes], x, axes * sizeof x[0]);
        memcpy(&y->v[i * axes], v, axes * sizeof v[0]);
    }
}

/* No energy changes, and the motion afterwards is the moved motion. */
static void rigid_motion(void)
{
    static model m;
    static state y, z;
    double matrix[12];
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 7) {
            build(&m, shapes[features % shape_count], axes, features & ~(unsigned)GRAVITY);
            for (size_t i = 0; i < m.def.links; i++) /* away from a length of 0, where a link has no direction */
                m.link[i].rest *= 0.5;
            m.def.methods = 1u << SPRING_LEAPFROG;
            spring_scene *s = scene_of(&m.def), *moved = scene_of(&m.def);
            CHECK(spring_scene_advance(moved, SPRING_LEAPFROG, 1e-3, 1) == SPRING_OK &&
                      spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 1) == SPRING_OK,
                  "a force is kept");
            rigid(matrix, axes);
            CHECK(spring_scene_transform(moved, matrix) == SPRING_OK, "a valid matrix");
            const spring_scene_energies e = spring_scene_energy(s), f = spring_scene_energy(moved);
            CHECK_CLOSE(f.kinetic, e.kinetic, 50 * EPS * e.kinetic, "a few roundings of each velocity");
            CHECK_CLOSE(f.elastic, e.elastic, 200 * EPS * (e.elastic + (double)m.def.links),
                        "a few roundings of positions up to 70, in lengths of about 1");
            get_state(s, m.def.particles, &y); /* the old scene, evaluated afresh as well */
            set_state(s, m.def.particles, &y);
            CHECK(spring_scene_advance(moved, SPRING_LEAPFROG, 1e-3, 100) == SPRING_OK &&
                      spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 100) == SPRING_OK,
                  "stable");
            get_state(s, m.def.particles, &y);
            transform_state(matrix, axes, m.def.particles, &y);
            get_state(moved, m.def.particles, &z);
            const double bound = sizeof(scalar) == 4 ? 1e-3 : 1e-12;
            for (size_t i = 0; i < m.def.particles * axes; i++) {
                CHECK_CLOSE(z.x[i], y.x[i], bound * fmax(1, fabs(y.x[i])), "the moved motion");
                CHECK_CLOSE(z.v[i], y.v[i], 20 * bound * fmax(1, fabs(y.v[i])),
                            "the moved motion; forces have 20 times the rounding of positions");
            }
            free(s);
            free(moved);
        }
}

/* The state becomes A x + b and A v, for any matrix, and the next step is that of a scene which starts there. */
static void any_matrix(void)
{
    static model m;
    static state y, z;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features += 11) {
            build(&m, shapes[features % shape_count], axes, features);
            double matrix[12];
            for (int i = 0; i < 12; i++)
                matrix[i] = random_uniform(-1.5, 1.5);
            spring_scene *s = scene_of(&m.def), *other = scene_of(&m.def);
            const double dt = 1e-3;
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 3) == SPRING_OK &&
                      spring_scene_advance(other, SPRING_LEAPFROG, dt, 3) == SPRING_OK,
                  "stable");
            get_state(s, m.def.particles, &y);
            transform_state(matrix, axes, m.def.particles, &y);
            CHECK(spring_scene_transform(s, matrix) == SPRING_OK, "any matrix");
            get_state(s, m.def.particles, &z);
            for (size_t i = 0; i < m.def.particles * axes; i++) {
                CHECK_CLOSE(z.x[i], y.x[i], EPS * fabs(y.x[i]) + 1e-14, "in double, then rounded");
                CHECK_CLOSE(z.v[i], y.v[i], EPS * fabs(y.v[i]) + 1e-14, "in double, then rounded");
            }
            set_state(other, m.def.particles, &z);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 3) == SPRING_OK &&
                      spring_scene_advance(other, SPRING_LEAPFROG, dt, 3) == SPRING_OK,
                  "stable");
            CHECK(same_bits(s, other, m.def.particles, axes), "no force is kept");
            free(s);
            free(other);
        }
}

static void bad_matrices(void)
{
    static model m;
    for (size_t k = 0; k < shape_count; k++) {
        build(&m, shapes[k], 3, 0);
        const double good[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        double matrix[12];
        size_t bytes = 0;
        spring_scene_bytes(&m.def, &bytes);
        spring_scene *s = scene_of(&m.def);
        void *before = malloc(bytes);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 1e-3, 1) == SPRING_OK, "a force is kept");
        memcpy(before, s, bytes);
        for (int i = 0; i < 12; i++)
            for (int bad = 0; bad < 2; bad++) {
                memcpy(matrix, good, sizeof matrix);
                matrix[i] = bad ? NAN : -INFINITY;
                CHECK(spring_scene_transform(s, matrix) == SPRING_EINVAL, "not finite");
            }
        memcpy(matrix, good, sizeof matrix);
        matrix[10] = sizeof(scalar) == 4 ? 3e38 : 1.7e308;
        matrix[11] = matrix[10];
        const double far[] = {0, 0, 5};
        CHECK(spring_scene_transform(NULL, good) == SPRING_EINVAL && spring_scene_transform(s, NULL) == SPRING_EINVAL,
              "NULL");
        CHECK(memcmp(before, s, bytes) == 0, "nothing changes");
        spring_scene_set(s, SPRING_POSITION, far, 0, m.def.particles - 1, 1);
        memcpy(before, s, bytes);
        CHECK(spring_scene_transform(s, matrix) == SPRING_ENONFINITE, "the last particle would be too far away");
        CHECK(memcmp(before, s, bytes) == 0, "nothing changes");
        free(before);
        free(s);
    }
}

int main(void)
{
    static const test tests[] = {
        {"held forces are like gravity", like_gravity},
        {"zero is absent", zero_is_absent},
        {"the same bits with every instruction set", same_with_all_kernels},
        {"forces that change every frame", changed_every_frame},
        {"exact motion", exact_motion},
        {"set and get", stored},
        {"at rest", at_rest},
        {"failures and snapshots", failures_and_snapshots},
        {"pinned particles", pinned},
        {"rigid motion", rigid_motion},
        {"any matrix", any_matrix},
        {"bad matrices", bad_matrices},
    };
    return RUN_TESTS("scene-held", tests);
}
