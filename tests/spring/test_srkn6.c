/* SPDX-License-Identifier: MIT */
/* SRKN6: the order conditions of its coefficients; rounding error, order, phase, energy and stable step on one spring
   in a scene; its order with nonlinear forces; its time reversibility. Tests of scenes check the properties of all
   methods. */
#include <stdio.h>

#include "methods/srkn6_coefficients.h"
#include "spring_in_scene.h"

/* -------------------------------------------------------------------------------------------------- order conditions */

enum { kicks = srkn6_stages + 1 };

/* A tree: what it is at each kick, and for the exact solution factor t^(order - 1). */
typedef struct tree {
    double phi[kicks], factor;
    int order;
} tree;

static double kick_at(int i)
{
    return srkn6_b[srkn6_index(i, kicks)];
}

static double time_of_kick(int i)
{
    return i == 0 ? 0 : srkn6_c[i - 1];
}

static tree leaf(void)
{
    tree t = {.factor = 1, .order = 1};
    for (int i = 0; i < kicks; i++)
        t.phi[i] = 1;
    return t;
}

/* The tree with one more edge to a velocity. */
static tree times_velocity(tree t)
{
    for (int i = 0; i < kicks; i++)
        t.phi[i] *= time_of_kick(i);
    t.order++;
    return t;
}

/* The tree with one more edge to another tree: t^p adds t^(p + 2)/((p + 1) (p + 2)) to the position. */
static tree times_force(tree t, tree other)
{
    for (int i = 0; i < kicks; i++) {
        double sum = 0;
        for (int j = 0; j < i; j++)
            sum += kick_at(j) * (time_of_kick(i) - time_of_kick(j)) * other.phi[j];
        t.phi[i] *= sum;
    }
    t.factor *= other.factor / (other.order * (other.order + 1));
    t.order += other.order + 1;
    return t;
}

static void check_condition(tree t, int trees[7])
{
    double sum = 0;
    for (int i = 0; i < kicks; i++)
        sum += kick_at(i) * t.phi[i];
    CHECK_CLOSE(sum, t.factor / t.order, 2 * DBL_EPSILON, "coefficients of size 1/4 rounded once, in sums of 12");
    trees[t.order]++;
}

/* Every tree that grows from t by edges to velocities and to the trees of `branch` from the first on. */
static void check_trees(tree t, const tree *branch, int branches, int trees[7])
{
    for (tree with = t; with.order <= 6; with = times_velocity(with))
        check_condition(with, trees);
    for (int k = 0; k < branches; k++) {
        const tree with = times_force(t, branch[k]);
        if (with.order <= 6)
            check_trees(with, branch + k, branches - k, trees);
    }
}

/* Those of the velocity, for all Nystrom trees up to order 6. Those of the position follow from them, since the method is
   symplectic: its weights are b_i (1 - c_i). */
static void order_conditions(void)
{
    const tree one = leaf(), v = times_velocity(one), vv = times_velocity(v);
    const tree branch[] = {one,
                           v,
                           vv,
                           times_force(one, one),
                           times_velocity(vv),
                           times_velocity(times_force(one, one)),
                           times_force(one, v)};
    static const int nystrom_trees[7] = {0, 1, 1, 2, 3, 6, 10};
    int trees[7] = {0};
    check_trees(one, branch, sizeof branch / sizeof branch[0], trees);
    for (int order = 1; order <= 6; order++)
        CHECK(trees[order] == nystrom_trees[order], "as many as the textbook has");
    double time = 0;
    for (int i = 0; i < srkn6_stages; i++) {
        time += srkn6_a[srkn6_index(i, srkn6_stages)];
        CHECK_CLOSE(srkn6_c[i], time, 2 * DBL_EPSILON, "the sums of the drifts");
    }
}

/* -------------------------------------------------------------------------------------------------------- one spring */

static void against_iterate(void)
{
    for (int i = 0; i < 400; i++) {
        const spring_params p = random_spring(i);
        const double omega = omega_of(&p), g = p.damping / p.mass;
        const spring_state start = {random_uniform(-1, 1), omega * random_uniform(-1, 1)};
        const uint64_t n = 1 + random_bits() % 300;
        const double z = i % 5 == 0 ? 9.07 : random_log(1e-3, 9.07);
        const double forward = fmin(z / omega, 20 / g), back = -fmin(z, 0.01) / (omega + g); /* where drag is growth */
        CHECK_BELOW(rounding_of_steps(SPRING_SRKN6, p, i % 7 == 0 ? back : forward, n, start), 6,
                    "23 kicks and drifts round where the bound of reference.h counts 4 times");
    }
}

/* Of the distance in (x, v/omega); order_in_scenes() separates positions and velocities. */
static void order(void)
{
    static const double dampings[] = {0, 0.02, 0.6}, loads[] = {0, 1.9};
    for (int d = 0; d < 3; d++)
        for (int l = 0; l < 2; l++) {
            const spring_params p = {0.5, 2.7, dampings[d], loads[l]};
            const double duration = 14 / omega_of(&p);
            double error[3];
            for (int i = 0; i < 3; i++)
                error[i] = error_in_scene(SPRING_SRKN6, p, duration, (uint64_t)20 << i, (spring_state){0.8, -0.9});
            CHECK_CLOSE(log2(error[0] / error[1]), 6, 0.1, "slope");
            CHECK_CLOSE(log2(error[1] / error[2]), 6, 0.1, "slope");
        }
}

/* A step turns by less than z: by 8.0422e-8 z^7, and by 8.16e-8 z^7 at z = 1. It multiplies no area. */
static void phase_error(void)
{
    for (double z = 0.7; z < 2.2; z += 0.1) {
        const step_invariants step = invariants_of_step(SPRING_SRKN6, z, 0);
        const double law = 8.0422e-8 * pow(z, 7);
        CHECK_CLOSE(z - acos(step.trace / 2), law, 0.02 * z * z * law + 8 * DBL_EPSILON * (1 + z * z),
                    "the next order, and the rounding of the trace");
        CHECK_CLOSE(step.det, 1, 32 * DBL_EPSILON, "23 shears");
    }
}

/* The ellipse on which an oscillator moves is longer in v by 1.4194e-7 z^6 (1 + 0.2 z^2). */
static void energy_bounded(void)
{
    const spring_params p = {.mass = 0.5, .stiffness = 2.7};
    const double omega = omega_of(&p);
    for (double z = 0.5; z < 2.1; z += 0.3) {
        spring_state s = {0.8, -0.9};
        const double before = spring_energy(&s, &p), bound = 2 * 1.4194e-7 * pow(z, 6) * (1 + 0.33 * z * z);
        double largest = 0;
        for (int i = 0; i < 300; i++) {
            s = advance_in_scene(SPRING_SRKN6, p, z / omega, 37, s);
            largest = fmax(largest, fabs(spring_energy(&s, &p) / before - 1));
        }
        CHECK_BELOW(largest, bound + 1e-14 * sqrt(300 * 37), "twice the ellipse, and rounding");
        CHECK(largest > 0.3 * bound, "there is something to be seen");
    }
}

static bool stable(double z, double ratio, double rounding)
{
    const step_invariants step = invariants_of_step(SPRING_SRKN6, z, ratio);
    return fabs(step.det) <= 1 + rounding && fabs(step.trace) <= 1 + step.det + rounding * (1 + fabs(step.trace));
}

/* With drag to h omega = 9.07 and g h = 20, as scenes have it. Where the eigenvalues of an undamped spring meet at -1 and
   at 1, just beyond pi and 2 pi, they leave the circle a little: g h = 1.4e-3 is enough to bring them back. */
static void stable_step(void)
{
    const double rounding = 1e-13;
    for (double ratio = 1e-4; ratio < 1e4; ratio = ratio * 1.2 + 0.001)
        for (double z = fmin(9.07, 10 / ratio); z > 0.02; z *= 0.99)
            CHECK(stable(z, fmax(ratio, 7e-4 / z), rounding), "no eigenvalue beyond 1");
    for (double z = 0.001; z < 9.07; z += 0.001) {
        const bool gap = (z > 3.1413 && z < 3.1424) || (z > 6.3477 && z < 6.3494);
        CHECK(stable(z, 0, gap ? 3e-7 : rounding), "growth by at most acosh(1 + 2.2e-7) = 6.6e-4 a step");
    }
    CHECK(!stable(3.1419, 0, rounding) && !stable(6.3486, 0, rounding), "the two narrow gaps");
    CHECK(!stable(9.0737, 0, rounding), "it is the limit");
}

/* With drag alone, each step is exact. */
static void drag_alone(void)
{
    const spring_params p = {.mass = 0.5, .damping = 0.3};
    for (double dt = 0.01; dt < 30; dt *= 1.7) {
        const spring_state start = {0.8, -0.9}, end = advance_in_scene(SPRING_SRKN6, p, dt, 1, start);
        const double g = p.damping / p.mass, lost = -expm1(-g * dt), rounding = 40 * DBL_EPSILON * exp(0.3 * g * dt);
        CHECK_CLOSE(end.v, start.v * (1 - lost), rounding, "roundings that grow in drifts backwards");
        CHECK_CLOSE(end.x, start.x + start.v / g * lost, rounding * (1 + 1 / g), "likewise");
    }
}

/* ------------------------------------------------------------------------------------------------------------- scenes */

enum { most = 25, most_links = 100 };

typedef struct model {
    spring_scene_def def;
    double position[3 * most], velocity[3 * most], mass[most];
    uint8_t pinned[most];
    spring_link link[most_links];
} model;

/* A mass on a spring that swings in a plane. */
static void build_pendulum(model *m, double drag)
{
    *m = (model){.position = {0, 0, 1.1, -0.2},
                 .velocity = {0, 0, 0.3, 0.7},
                 .mass = {1, 0.7},
                 .pinned = {1, 0},
                 .link = {{0, 1, 0.9, 31.3, 0}}};
    m->def = (spring_scene_def){.axes = 2, .particles = 2, .links = 1, .gravity = {0, -9.81}, .drag = drag};
}

/* A cloth that is pinned along an edge, with masses of its own. */
static void build_cloth(model *m, double drag)
{
    const spring_grid g = {.count = {5, 5},
                           .spacing = 0.7,
                           .stretch = 1.2,
                           .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                           .stiffness = 27.3,
                           .pinned = SPRING_GRID_FIRST_Y};
    *m = (model){.def = {.axes = 3, .gravity = {0.2, 0.3, -9.81}, .drag = drag}};
    spring_grid_size(&g, &m->def.particles, &m->def.links);
    CHECK(m->def.particles <= most && m->def.links <= most_links, "fits into the model");
    spring_grid_fill(&g, m->position, m->pinned, m->link);
    for (size_t i = 0; i < m->def.particles; i++) {
        m->mass[i] = random_log(0.5, 2);
        for (int a = 0; a < 3 && !m->pinned[i]; a++)
            m->velocity[3 * i + (size_t)a] = random_uniform(-1, 1);
    }
}

typedef void build_model(model *m, double drag);

static spring_scene *scene_of(model *m)
{
    m->def.methods = 1u << SPRING_SRKN6;
    m->def.position = m->position;
    m->def.velocity = m->velocity;
    m->def.mass = m->mass;
    m->def.pinned = m->pinned;
    m->def.link = m->link;
    size_t bytes = 0;
    CHECK(spring_scene_bytes(&m->def, &bytes) == SPRING_OK, "a valid definition");
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    spring_scene *s;
    CHECK(spring_scene_init(memory, bytes, &m->def, &s) == SPRING_OK, "a valid definition");
    return s;
}

typedef struct state {
    double x[3 * most], v[3 * most];
} state;

static void get_state(const spring_scene *s, size_t particles, state *y)
{
    CHECK(spring_scene_get(s, SPRING_POSITION, y->x, 0, 0, particles) == SPRING_OK &&
              spring_scene_get(s, SPRING_VELOCITY, y->v, 0, 0, particles) == SPRING_OK,
          "the whole state");
}

static double distance(const double *x, const double *y, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum = hypot(sum, x[i] - y[i]);
    return sum;
}

enum { looks = 4, halvings = 4 };

/* The states at equal times of a run of n steps. */
static void run(model *m, double duration, uint64_t n, state at[looks])
{
    spring_scene *s = scene_of(m);
    for (int look = 0; look < looks; look++) {
        CHECK(spring_scene_advance(s, SPRING_SRKN6, duration / (double)n, n / looks) == SPRING_OK, "finite numbers");
        get_state(s, m->def.particles, &at[look]);
    }
    free(s);
}

/* From the differences between runs with steps that are halved, of positions and of velocities. */
static void check_order(model *m, double duration, uint64_t steps)
{
    static state at[halvings][looks];
    const size_t count = m->def.particles * m->def.axes;
    double dx[halvings - 1] = {0}, dv[halvings - 1] = {0};
    for (int i = 0; i < halvings; i++)
        run(m, duration, steps << i, at[i]);
    for (int i = 0; i + 1 < halvings; i++)
        for (int look = 0; look < looks; look++) {
            dx[i] += distance(at[i][look].x, at[i + 1][look].x, count);
            dv[i] += distance(at[i][look].v, at[i + 1][look].v, count);
        }
    printf("# slopes of x and v: %.3f %.3f, then %.3f %.3f\n", log2(dx[0] / dx[1]), log2(dv[0] / dv[1]),
           log2(dx[1] / dx[2]), log2(dv[1] / dv[2]));
    CHECK_CLOSE(log2(dx[1] / dx[2]), 6, 0.1, "slope of the positions");
    CHECK_CLOSE(log2(dv[1] / dv[2]), 6, 0.1, "slope of the velocities");
}

static void order_in_scenes(void)
{
    static model m;
    for (double drag = 0; drag < 1; drag += 0.4) {
        build_pendulum(&m, drag);
        check_order(&m, 1.7, 12);
        build_cloth(&m, drag);
        check_order(&m, 0.9, 16);
    }
}

/* Forward and back, also with drag, whose drift is inverted exactly. */
static void reversible(void)
{
    static model m;
    static state start, end;
    build_model *const builds[] = {build_pendulum, build_cloth};
    for (int k = 0; k < 2; k++)
        for (double drag = 0; drag < 1; drag += 0.4) {
            builds[k](&m, drag);
            const size_t count = m.def.particles * m.def.axes;
            spring_scene *s = scene_of(&m);
            const double dt = 0.3 * spring_scene_stable_step(s, SPRING_SRKN6);
            get_state(s, m.def.particles, &start);
            CHECK(spring_scene_advance(s, SPRING_SRKN6, dt, 7) == SPRING_OK &&
                      spring_scene_advance(s, SPRING_SRKN6, -dt, 7) == SPRING_OK,
                  "forward and back");
            get_state(s, m.def.particles, &end);
            CHECK_BELOW(distance(start.x, end.x, count), 1e-12, "the method is symmetric: rounding alone");
            CHECK_BELOW(distance(start.v, end.v, count), 1e-12, "the method is symmetric: rounding alone");
            free(s);
        }
}

/* The bound of scenes, which tests/scene/test_limits.c compares with what is stable. */
static void bound_of_scenes(void)
{
    static model m;
    for (double drag = 0; drag < 100; drag = 3 * drag + 0.4) {
        build_pendulum(&m, drag);
        spring_scene *s = scene_of(&m);
        const double want = fmin(9.07 / sqrt(31.3 / 0.7), 20 / (drag / 0.7));
        CHECK_CLOSE(spring_scene_stable_step(s, SPRING_SRKN6), want, 8 * DBL_EPSILON * want, "9.07/sqrt(L), 20/G");
        free(s);
    }
}

int main(void)
{
    static const test tests[] = {
        {"order conditions", order_conditions},    {"against the method in exact arithmetic", against_iterate},
        {"order 6, with drag and without", order}, {"the phase error of a step", phase_error},
        {"the energy is bounded", energy_bounded}, {"the stable step", stable_step},
        {"drag alone is exact", drag_alone},       {"order 6 in scenes", order_in_scenes},
        {"forward and back", reversible},          {"the stable step of scenes", bound_of_scenes},
    };
    return RUN_TESTS("srkn6", tests);
}
