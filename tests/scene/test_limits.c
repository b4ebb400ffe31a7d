/* SPDX-License-Identifier: MIT */
/* The stable step: its formula; it is stable and not much too small. Large motion, many links. */
#include <stdio.h>

#include "test_scene.h"

/* ------------------------------------------------------------------------------------------------------- formulas */

/* What the header's formulas are made of. */
typedef struct largest_sums {
    double L, G, K;  /* of stiffness and damping over mass, and of stiffness alone */
    double links;    /* of damping over mass, of links alone */
    double heaviest; /* [kg] that moves */
} largest_sums;

/* Over all particles in turn. */
static largest_sums sums_of(const spring_scene_def *def)
{
    largest_sums all = {0};
    for (size_t i = 0; i < def->particles; i++) {
        double stiffness = 0, damping = 0;
        for (size_t j = 0; j < def->links; j++) {
            const spring_link *link = &def->link[j];
            if (link->a != i && link->b != i)
                continue;
            const double ends = pinned_in(def, link->a == i ? link->b : link->a) ? 1 : 2;
            stiffness += ends * link->stiffness;
            damping += ends * link->damping;
        }
        if (pinned_in(def, i))
            continue;
        all.L = fmax(all.L, stiffness / mass_in(def, i));
        all.links = fmax(all.links, damping / mass_in(def, i));
        all.heaviest = fmax(all.heaviest, mass_in(def, i));
        all.G = fmax(all.G, (damping + def->drag) / mass_in(def, i));
        all.K = fmax(all.K, stiffness);
    }
    return all;
}

/* The header has the formula of each method. */
static void formulas(void)
{
    static model m;
    static const uint32_t grids[][3] = {{23, 1, 1}, {7, 5, 1}, {3, 4, 3}, {1, 1, 1}};
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < feature_masks; features++) {
            build(&m, grids[features % 7 % 4], axes, features);
            for (size_t i = 0; i < m.def.links && features % 5 == 0; i++)
                m.link[i].stiffness = 0; /* dampers alone */
            memset(m.pinned, 1, features % 11 == 0 ? m.def.particles : 0);
            spring_scene *s = scene_of(&m.def);
            const largest_sums all = sums_of(&m.def);
            const double frequency = 2 / sqrt(all.L), damping = 2 / all.G;
            const double p = all.links - (all.heaviest > 0 ? m.def.drag / all.heaviest : 0),
                         root = sqrt(p * p + 4 * all.L);
            const double want[SPRING_METHOD_COUNT] = {
                [SPRING_EULER] = all.K > 0 ? fmin(m.def.drag / all.K, damping) : damping,
                [SPRING_LEAPFROG] = frequency,
                [SPRING_RK4] = 2.61 / fmax(sqrt(all.L), all.G),
                [SPRING_SYMPLECTIC_EULER] = p > 0       ? 4 / (p + root)
                                            : all.L > 0 ? (root - p) / all.L
                                                        : INFINITY, /* nothing to be unstable with */
                [SPRING_RKN8] = fmin(3.14 / sqrt(all.L), 20 * damping),
                [SPRING_SRKN6] = m.def.drag > 0 ? fmin(8 / sqrt(all.L), 3 / all.G) : 9.07 / sqrt(all.L),
            };
            for (int i = 0; i < SPRING_METHOD_COUNT; i++)
                if (spring_method_describe((spring_method)i)->scenes)
                    CHECK_CLOSE(spring_scene_stable_step(s, (spring_method)i), want[i],
                                want[i] < INFINITY ? 60 * EPS * want[i] : 0,
                                "a sum of at most 50 links, and ten roundings; a method without a row in want[]: 0");
            CHECK(isnan(spring_scene_stable_step(s, SPRING_EXACT)) && isnan(spring_scene_stable_step(s, no_method)) &&
                      isnan(spring_scene_stable_step(NULL, SPRING_RK4)),
                  "bad input");
            free(s);
        }
}

/* The same scene in a unit of mass that is 2^mass kg and one of time that is 2^time s. */
static void change_units(model *m, int mass, int time)
{
    for (size_t i = 0; i < m->def.particles; i++)
        m->mass[i] = ldexp(m->mass[i], mass);
    m->def.mass_all = ldexp(mass_in(&(spring_scene_def){.mass_all = m->def.mass_all}, 0), mass);
    for (size_t i = 0; i < m->def.links; i++) {
        m->link[i].stiffness = ldexp(m->link[i].stiffness, mass - 2 * time);
        m->link[i].damping = ldexp(m->link[i].damping, mass - time);
    }
    m->def.drag = ldexp(m->def.drag, mass - time);
}

/* Units change no bit, near the largest and the least numbers either, with stiffness and damping that become 1. */
static void units(void)
{
    static model m;
    const int far = sizeof(scalar) == 4 ? 50 : 440;
    const struct {
        int mass, time;
    } unit[] = {{0, -1}, {2 * far, 0}, {2 * far, far}, {-2 * far, 0}, {-2 * far, -far}};
    for (unsigned features = 0; features < feature_masks; features++)
        for (size_t u = 0; u < sizeof unit / sizeof unit[0]; u++) {
            build(&m, (uint32_t[]){4, 3, 1}, 2, features);
            for (size_t i = 0; i < m.def.links && features % 3 == 0; i++) {
                m.link[i].stiffness = 0.25;
                m.link[i].damping = m.link[i].damping > 0 ? 0.5 : 0;
            }
            spring_scene *s = scene_of(&m.def);
            change_units(&m, unit[u].mass, unit[u].time);
            spring_scene *other = scene_of(&m.def);
            const method_list all = methods_of(m.def);
            for (const spring_method *method = all.at; *method != no_method; method++)
                CHECK_BITS(spring_scene_stable_step(other, *method),
                           ldexp(spring_scene_stable_step(s, *method), unit[u].time), "in this unit of time");
            free(s);
            free(other);
        }
}

/* A link between two pins does not count, however stiff, compared with one that is weak and pulls at a large mass. */
static void stiff_between_pins(void)
{
    const int far = sizeof(scalar) == 4 ? 100 : 900;
    const double x[] = {0, 1, 2}, mass[] = {1, 1, ldexp(1.7, far / 2)};
    const uint8_t pinned[] = {1, 1, 0};
    const spring_link link[] = {{1, 2, 0.7, 3.1, 0.4, 0}, {0, 1, 0.7, ldexp(1, far), ldexp(1, far), 0}};
    spring_scene_def def = {
        .axes = 1, .particles = 3, .links = 2, .position = x, .mass = mass, .pinned = pinned, .link = link};
    spring_scene *s = scene_of(&def);
    def.links = 1;
    spring_scene *without = scene_of(&def);
    const method_list all = methods_of(def);
    for (const spring_method *method = all.at; *method != no_method; method++)
        CHECK_BITS(spring_scene_stable_step(s, *method), spring_scene_stable_step(without, *method), "as without it");
    free(s);
    free(without);
}

/* Stiff links between heavy particles do not hide soft ones between light particles, of which the bound is. */
static void light_and_heavy(void)
{
    const double big = EPS < 1e-10 ? 1e300 : 1e30, tiny = EPS < 1e-10 ? 1e-100 : 1e-20, rate = 1e12; /* k/m [1/s^2] */
    const double huge = EPS < 1e-10 ? 1.7e308 : 3e38; /* twice this is infinite */
    const double position[] = {0, 1, 2, 3}, mass[] = {big, big, tiny, tiny};
    const spring_link link[] = {{0, 1, 1, huge, 0, 0}, {2, 3, 1, rate * tiny, 0, 0}};
    const spring_scene_def def = {
        .axes = 1, .particles = 4, .links = 2, .position = position, .mass = mass, .link = link};
    spring_scene *s = scene_of(&def);
    CHECK_CLOSE(spring_scene_stable_step(s, SPRING_LEAPFROG), 2 / sqrt(2 * rate), 8 * EPS,
                "2/sqrt(2 k/m) of the light ones");
    free(s);
}

/* A sum of stiffness beyond the largest double: no step is known, with any method and any damping. */
static void sums_that_overflow(void)
{
    const double huge = 8e307, position[] = {0, 1, 2, 3};
    if (EPS > 1e-10)
        return; /* floats do not reach it */
    for (int how = 0; how < 4; how++) {
        const double damping = how & 1 ? 0.3 : 0, drag = how & 2 ? 0.7 : 0;
        const spring_link link[] = {{0, 1, 1, huge, damping, 0}, {0, 2, 1, huge, 0, 0}, {0, 3, 1, huge, 0, 0}};
        const spring_scene_def def = {
            .axes = 1, .particles = 4, .links = 3, .position = position, .link = link, .drag = drag};
        spring_scene *s = scene_of(&def);
        for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
            const spring_method m = spring_method_at(i);
            if (spring_method_describe(m)->scenes)
                CHECK(spring_scene_stable_step(s, m) == 0, spring_method_name(m));
        }
        free(s);
    }
}

/* A kick that is solved for divides by 1 + drag dt/mass: where that is infinite the velocity would be 0, and finite. */
static void drag_that_overflows(void)
{
    const double large = EPS < 1e-10 ? 1e200 : 1e20, position[] = {1}, velocity[] = {5};
    const spring_scene_def def = {.axes = 1, .particles = 1, .position = position, .velocity = velocity, .drag = large};
    static const spring_method solved[] = {SPRING_SYMPLECTIC_EULER, SPRING_LEAPFROG};
    for (size_t i = 0; i < sizeof solved / sizeof solved[0]; i++) {
        spring_scene *s = scene_of(&def);
        double v = 0;
        CHECK(spring_scene_advance(s, solved[i], large, 1) == SPRING_ENONFINITE, spring_method_name(solved[i]));
        spring_scene_get(s, SPRING_VELOCITY, &v, 0, 0, 1);
        CHECK_BITS(v, 5.0, "the state is kept");
        free(s);
    }
}

/* -------------------------------------------------------------------------------------- stable, and how far from it */

enum { LINK_DAMPING = 1, WITH_DRAG = 2 };

typedef struct thing {
    const char *name;
    spring_grid grid;
} thing;

static const thing things[] = {
    {"rope",
     {.count = {17},
      .spacing = 0.2,
      .stretch = 1.1,
      .stiffness = 310,
      .pinned = SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X}},
    {"cloth", {.count = {9, 9}, .spacing = 0.2, .stretch = 1.1, .families = 7, .stiffness = 310, .pinned = 15}},
    {"jelly",
     {.count = {4, 4, 4},
      .spacing = 0.2,
      .stretch = 1,
      .families = 3,
      .stiffness = 310,
      .pinned = SPRING_GRID_FIRST_Z}},
    {"chain",
     {.count = {20},
      .axes = 1,
      .spacing = 0.2,
      .stretch = 1.1,
      .stiffness = 310,
      .pinned = SPRING_GRID_FIRST_X | SPRING_GRID_LAST_X}},
    {"water", {.count = {11, 11}, .height = true, .spacing = 1, .families = 7, .stiffness = 310, .pinned = 15}},
};
enum { rope, cloth, jelly, chain, water, thing_count };

/* A thing at its place; its particles have velocities in all directions, small, but far above rounding. */
static void build_thing(model *m, const thing *what, unsigned how)
{
    spring_grid g = what->grid;
    g.damping = how & LINK_DAMPING ? 4.3 : 0;
    const uint32_t axes = g.axes = g.height ? 1 : g.axes == 0 ? 3 : g.axes;
    const double small = sizeof(scalar) == 4 ? 1e-2 : 1e-6; /* [m/s] */
    build_grid(m, &g, 0.7);
    for (size_t i = 0; i < m->def.particles * axes; i++)
        m->velocity[i] = m->pinned[i / axes] ? 0 : random_uniform(-small, small);
    m->def.drag = how & WITH_DRAG ? 1.9 : 0;
    use_all_methods(&m->def);
}

/* How much the small velocities, of all particles together, have grown after n steps of dt, from n/2 on; INFINITY:
   overflow. */
static double growth(const model *m, spring_method method, double dt, uint64_t n)
{
    static state y;
    spring_scene *s = scene_of(&m->def);
    double largest[2] = {0, 0};
    bool finite = true;
    for (int part = 0; part < 2; part++)
        for (uint64_t i = 0; i < n / 2 && finite; i += 10) {
            finite = spring_scene_advance(s, method, dt, 10) == SPRING_OK;
            get_state(s, m->def.particles, &y);
            double square = 0;
            for (size_t j = 0; j < m->def.particles * m->def.axes; j++)
                square += y.v[j] * y.v[j];
            largest[part] = fmax(largest[part], sqrt(square));
        }
    free(s);
    return finite ? largest[1] / largest[0] : INFINITY;
}

static void stable_below(void)
{
    static model m;
    for (int w = 0; w < thing_count; w++)
        for (unsigned how = 0; how < 4; how++) {
            build_thing(&m, &things[w], how);
            const method_list all = methods_of(m.def);
            for (const spring_method *method = all.at; *method != no_method; method++) {
                const double step = stable_step_of(&m.def, *method);
                CHECK(step > 0 || (never_stable(*method) && !(how & WITH_DRAG)),
                      "only a method that is never stable without damping has none, and only without drag");
                if (step > 0)
                    CHECK_BELOW(growth(&m, *method, 0.95 * step, 4000), 1.2,
                                "modes of constant amplitude, in step and out of step, seen for 2000 steps twice");
            }
        }
}

/* Drag and damped links couple the modes of particles of different masses. Motion along one axis is linear. */
static void stable_with_any_masses(void)
{
    static model m;
    for (int round = 0; round < 500; round++) {
        const double damping = round % 4 == 0 ? random_log(0.01, 10) : 0;
        m.def = joined(1, round % 2 == 0 ? 3 : 4, m.position, m.velocity, 0, m.link);
        m.def.mass = m.mass, m.def.pinned = m.pinned, m.def.drag = random_log(1, 100);
        for (uint32_t i = 0; i < m.def.particles; i++) {
            m.position[i] = i;
            m.velocity[i] = i > 0 ? random_uniform(-1e-2, 1e-2) : 0;
            m.mass[i] = random_log(1, 30);
            m.pinned[i] = i == 0;
            for (uint32_t j = 0; j < i; j++)
                if (j == 0 || random_bits() % 2 == 0)
                    m.link[m.def.links++] = (spring_link){j, i, i - j, random_log(1, 1000), damping, 0};
        }
        use_all_methods(&m.def);
        const method_list all = methods_of(m.def);
        for (const spring_method *method = all.at; *method != no_method; method++) {
            const double step = stable_step_of(&m.def, *method);
            if (!never_stable(*method)) /* the others' steps are so short that 2000 may be less than a period */
                CHECK_BELOW(growth(&m, *method, 0.99 * step, 4000), 1.2,
                            "modes of constant amplitude, in step and out of step, seen for 2000 steps twice");
        }
    }
}

#ifndef SPRING_FLOAT

/* The limit is where small velocities begin to grow; by bisection. */
static double measured_limit(const model *m, spring_method method, double stable)
{
    double low = stable, high = 5 * stable;
    while (high - low > 0.02 * stable) {
        const double middle = (low + high) / 2;
        if (growth(m, method, middle, 2000) > 3)
            high = middle;
        else
            low = middle;
    }
    return low;
}

static void not_much_too_small(void)
{
    static model m;
    for (int w = 0; w < thing_count; w++)
        for (unsigned how = 0; how <= LINK_DAMPING; how++) {
            build_thing(&m, &things[w], how);
            const method_list all = methods_of(m.def);
            for (const spring_method *method = all.at; *method != no_method; method++) {
                const double step = stable_step_of(&m.def, *method);
                if (step == 0)
                    continue;
                const double limit = measured_limit(&m, *method, step);
                printf("# %s%s, %s: the limit is %.2f times the stable step\n", things[w].name,
                       how == LINK_DAMPING ? ", damped" : "", spring_method_name(*method), limit / step);
                CHECK(limit >= 0.99 * step, "a safe step");
                const bool wider = *method == SPRING_RK4 || *method == SPRING_RKN8;
                if (how == 0 && (w == cloth || w == water))
                    CHECK(limit <= (wider ? 2 : w == water ? 1.32 : 1.62) * step, "as the header says, and bisection");
                CHECK(growth(&m, *method, 1.1 * limit, 4000) > 100, "beyond the limit it does blow up");
            }
        }
}

#endif

/* ------------------------------------------------------------------------------------------- large motion */

typedef struct large_motion {
    const char *name;
    uint32_t count[3], families;
    double stiffness;
    uint32_t flags;
    double drag_per_mass, fraction; /* [1/s], of the stable step */
    bool gains;
} large_motion;

/* Released in a horizontal position. Returns the largest gain of energy in a minute, relative to the largest kinetic
   energy of the first two seconds. */
static double gain_in_a_minute(model *m, const large_motion *l)
{
    const double mass = 0.03;
    const spring_grid g = {.count = {l->count[0], l->count[1], l->count[2]},
                           .spacing = 0.1,
                           .stiffness = l->stiffness,
                           .families = l->families,
                           .pinned = SPRING_GRID_FIRST_X};
    build_grid(m, &g, mass);
    m->def.flags = l->flags | SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    m->def.gravity[1] = -9.81, m->def.gravity[2] = 0.3, m->def.drag = l->drag_per_mass * mass;
    spring_scene *s = scene_of(&m->def);
    const double dt = l->fraction * spring_scene_stable_step(s, SPRING_LEAPFROG), before = total_energy(s);
    const uint64_t steps = (uint64_t)ceil(0.1 / dt);
    double kinetic = 0, gain = 0;
    for (uint64_t i = 0; (double)(i * steps) * dt < 60; i++) {
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, steps) == SPRING_OK, "it does not overflow");
        if ((double)(i * steps) * dt < 2)
            kinetic = fmax(kinetic, spring_scene_energy(s).kinetic);
        gain = fmax(gain, total_energy(s) - before);
    }
    free(s);
    return gain / kinetic;
}

/* The recommendations of scene.h, at spring_scene_stable_step(). */
static void moves_far(void)
{
    enum { structural = 1, sheared = 3, all = 7, tension = SPRING_SCENE_TENSION_ONLY };
    static const large_motion motions[] = {
        {"tension-only rope", {20}, structural, 2000, tension, 0.1, 0.5, false},
        {"rope", {20}, structural, 100, 0, 0.1, 0.5, false},
        {"cloth", {10, 10}, all, 100, 0, 0.1, 0.9, false},
        {"tension-only net", {10, 10}, sheared, 100, tension, 0.1, 0.9, false},
        {"soft body", {4, 4, 4}, all, 20, 0, 0.1, 0.9, false},
        {"tension-only rope", {20}, structural, 2000, tension, 0, 0.5, true},
        {"tension-only rope", {20}, structural, 2000, tension, 0, 0.25, false},
        {"tension-only rope", {20}, structural, 2000, tension, 0.4, 0.9, true},
        {"rope", {20}, structural, 100, 0, 0, 0.75, true},
        {"rope", {20}, structural, 100, 0, 0, 0.125, false},
    };
    static model m;
    for (size_t i = 0; i < sizeof motions / sizeof *motions; i++) {
        const large_motion *l = &motions[i];
        const double gain = gain_in_a_minute(&m, l);
        printf("# %s, drag/mass %g/s, %g of the stable step: gains %.3g times its kinetic energy in a minute\n",
               l->name, l->drag_per_mass, l->fraction, gain);
        if (l->gains)
            CHECK(gain > 1, "below the stable step, large motion gains energy by resonance");
        else
            CHECK_BELOW(gain, l->drag_per_mass > 0 ? 1e-3 : 1, "drag removes it, or the step is short enough");
    }
}

/* 10^6 links without order: making the scene takes time in proportion to the links, or this would take hours. */
static void many_links(void)
{
    enum { particles = 200000, links = 1000000 };
    spring_link *link = malloc(links * sizeof *link);
    double *x = malloc(3 * particles * sizeof *x);
    for (size_t i = 0; i < 3 * particles; i++)
        x[i] = random_uniform(0, 100);
    for (size_t i = 0; i < links; i++) {
        const uint32_t a = (uint32_t)(random_bits() % particles), b = (uint32_t)(random_bits() % (particles - 1));
        link[i] = (spring_link){a, b < a ? b : b + 1, random_uniform(0, 1), 1.5, 0, 0};
    }
    const spring_scene_def def = {.particles = particles, .links = links, .position = x, .link = link, .mass_all = 3};
    spring_scene *s = scene_of(&def);
    const double dt = 0.5 * spring_scene_stable_step(s, SPRING_LEAPFROG);
    const double before = total_energy(s);
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, 3) == SPRING_OK, "stable");
    CHECK_CLOSE(total_energy(s), before, 0.1 * before, "of order (dt omega)^2/8 at most");
    CHECK(isfinite(spring_scene_tension(s, links - 1)), "the last one, too");
    free(s);
    free(x);
    free(link);
}

int main(void)
{
    static const test tests[] = {
        {"formulas of stable steps", formulas},
        {"units of mass and time", units},
        {"a stiff link between pins", stiff_between_pins},
        {"light particles linked to heavy ones", light_and_heavy},
        {"sums of stiffness that overflow", sums_that_overflow},
        {"drag that overflows in a solved kick", drag_that_overflows},
        {"stable at 0.95 of the stable step", stable_below},
        {"stable with different masses and drag", stable_with_any_masses},
#ifndef SPRING_FLOAT
        {"how much larger the limit is", not_much_too_small},
#endif
        {"a minute of large motion", moves_far},
        {"10^6 links", many_links},
    };
    return RUN_TESTS("scene_limits", tests);
}
