/* SPDX-License-Identifier: MIT */
/* Tethers: their ends, lengths and stiffness in random scenes, ropes and cloth that hang on them, and softened scenes
   with tethers and weighted links. */
#include "test_scene.h"

enum { room = 700 };

typedef struct weighted_model {
    model m;
    spring_weighted_link weighted[room];
    double distance[2 * room];
    uint32_t work[2 * room];
    spring_link tether[room];
} weighted_model;

static weighted_model w;

/* Particles and links in no order; lengths are multiples of 1/8, so that sums are exact and ties happen. */
static void build_random(size_t particles, bool own_tethers)
{
    model *m = &w.m;
    const size_t links = particles < 2 ? 0 : below(3 * particles), weighted = particles < 3 ? 0 : below(particles);
    memset(m, 0, sizeof *m);
    for (size_t i = 0; i < particles; i++) {
        m->pinned[i] = below(8) == 0;
        m->mass[i] = random_log(0.1, 10);
        for (int a = 0; a < 3; a++)
            m->position[3 * i + (size_t)a] = random_uniform(-1, 1);
    }
    for (size_t i = 0; i < links; i++) {
        const uint32_t a = below(particles), b = (a + 1 + below(particles - 1)) % (uint32_t)particles;
        m->link[i] = (spring_link){a, b, below(16) / 8., below(6) == 0 ? 0 : 1 + below(8), 0, 0};
        if (own_tethers && below(5) == 0)
            m->link[i].flags = SPRING_LINK_TETHER;
    }
    for (size_t i = 0; i < weighted; i++) {
        const uint32_t first = below(particles - 2);
        w.weighted[i] = (spring_weighted_link){
            .particle = {first, first + 1, first + 2}, .weight = {0.25, -1, 0.75}, .stiffness = 1 + below(8)};
    }
    m->def = joined(3, particles, m->position, NULL, links, m->link);
    m->def.mass = m->mass, m->def.pinned = m->pinned;
    m->def.weighted_links = weighted, m->def.weighted_link = w.weighted;
}

/* Appends tethers to the links of the model; returns their number. */
static size_t append_tethers(double fraction, double slack)
{
    size_t count = most_links - w.m.def.links;
    CHECK(spring_links_tethers(&w.m.def, fraction, slack, w.m.link + w.m.def.links, &count, w.work, w.distance) ==
              SPRING_OK,
          "a valid definition");
    w.m.def.links += count;
    return count;
}

/* The distance from a pinned particle along links with stiffness, from its definition. */
static void distance_from(uint32_t pin, const model *m, double *distance)
{
    for (size_t i = 0; i < m->def.particles; i++)
        distance[i] = i == pin ? 0 : INFINITY;
    for (size_t pass = 0; pass < m->def.particles; pass++)
        for (size_t i = 0; i < m->def.links; i++) {
            const spring_link *l = &m->link[i];
            if (l->stiffness > 0 && (l->flags & SPRING_LINK_TETHER) == 0) {
                distance[l->a] = fmin(distance[l->a], distance[l->b] + l->rest);
                distance[l->b] = fmin(distance[l->b], distance[l->a] + l->rest);
            }
        }
}

static void ends_and_lengths(void)
{
    static double from[room], nearest[room];
    static uint32_t pin[room];
    static double row[room];
    for (unsigned number = 0; number < 300; number++) {
        const size_t particles = 1 + below(60);
        const double fraction = random_log(1e-3, 2), slack = random_uniform(0, 0.1);
        build_random(particles, number % 2 == 1);
        const model *m = &w.m;
        bool joined[room] = {false};
        for (uint32_t i = 0; i < particles; i++) {
            nearest[i] = INFINITY;
            row[i] = 0;
        }
        for (uint32_t p = 0; p < particles; p++) {
            if (!m->pinned[p])
                continue;
            distance_from(p, m, from);
            for (uint32_t i = 0; i < particles; i++)
                if (from[i] < nearest[i]) {
                    nearest[i] = from[i];
                    pin[i] = p;
                }
        }
        for (size_t i = 0; i < m->def.links; i++) {
            const spring_link *l = &m->link[i];
            const bool a = !m->pinned[l->a], b = !m->pinned[l->b], is_tether = (l->flags & SPRING_LINK_TETHER) != 0;
            row[l->a] += is_tether && a == b ? 0 : l->stiffness * (a + b);
            row[l->b] += is_tether && a == b ? 0 : l->stiffness * (a + b);
            joined[l->a] |= !is_tether && l->stiffness > 0 && !b;
            joined[l->b] |= !is_tether && l->stiffness > 0 && !a;
        }
        for (size_t i = 0; i < m->def.weighted_links; i++)
            for (int j = 0; j < 3; j++)
                for (int k = 0; k < 3; k++) {
                    const spring_weighted_link *l = &w.weighted[i];
                    row[l->particle[j]] +=
                        m->pinned[l->particle[k]] ? 0 : l->stiffness * fabs(l->weight[j] * l->weight[k]);
                }
        size_t count = 12345, found = 0;
        CHECK(spring_links_tethers(&m->def, fraction, slack, NULL, &count, w.work, w.distance) == SPRING_OK, "counts");
        const spring_link garbage = {7, 7, 7, 7, 7, 7};
        w.tether[0] = garbage;
        w.tether[count] = garbage;
        size_t capacity = count / 2;
        if (count > 0)
            CHECK(spring_links_tethers(&m->def, fraction, slack, w.tether, &capacity, w.work, w.distance) ==
                          SPRING_ENOMEM &&
                      capacity == count && memcmp(&w.tether[0], &garbage, sizeof garbage) == 0,
                  "too small: the number that is needed");
        CHECK(spring_links_tethers(&m->def, fraction, slack, w.tether, &capacity, w.work, w.distance) == SPRING_OK &&
                  capacity == count && memcmp(&w.tether[count], &garbage, sizeof garbage) == 0,
              "large enough");
        for (uint32_t i = 0; i < particles; i++) {
            CHECK_BITS(w.distance[i], nearest[i], "the distance of each particle");
            if (m->pinned[i] || joined[i] || nearest[i] == INFINITY)
                continue;
            const spring_link *t = &w.tether[found++];
            CHECK(found <= count && t->a == i && t->b == pin[i] && t->flags == SPRING_LINK_TETHER && t->damping == 0,
                  "of each particle that hangs, in order, to the nearest pinned particle, of several the first");
            CHECK_CLOSE(t->rest, nearest[i] * (1 + slack), 1e-15 * nearest[i], "one rounding");
            CHECK_CLOSE(t->stiffness, fraction * row[i], 1e-14 * fraction * row[i], "sums in any order");
        }
        CHECK(found == count, "no others");
        spring_scene *s = scene_of(&m->def);
        const double before = spring_scene_stable_step(s, SPRING_LEAPFROG);
        free(s);
        append_tethers(fraction, slack);
        s = scene_of(&m->def);
        CHECK(spring_scene_stable_step(s, SPRING_LEAPFROG) * sqrt(1 + fraction) >= before * (1 - 200 * EPS),
              "no sum grows by more than 1 + fraction");
        free(s);
    }
}

static void invalid_input(void)
{
    build_random(20, false);
    w.m.pinned[0] = 1;
    size_t count = room;
    spring_scene_def *def = &w.m.def;
    const double bad[][2] = {{0, 0}, {-1, 0}, {NAN, 0}, {INFINITY, 0}, {0.1, -0.1}, {0.1, NAN}, {0.1, INFINITY}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK(spring_links_tethers(def, bad[i][0], bad[i][1], w.tether, &count, w.work, w.distance) == SPRING_EINVAL,
              "fraction and slack");
    CHECK(spring_links_tethers(NULL, 0.1, 0, w.tether, &count, w.work, w.distance) == SPRING_EINVAL &&
              spring_links_tethers(def, 0.1, 0, w.tether, NULL, w.work, w.distance) == SPRING_EINVAL &&
              spring_links_tethers(def, 0.1, 0, w.tether, &count, NULL, w.distance) == SPRING_EINVAL &&
              spring_links_tethers(def, 0.1, 0, w.tether, &count, w.work, NULL) == SPRING_EINVAL,
          "NULL");
    const double much = sizeof(scalar) == sizeof(double) ? 1e308 : 1e38, huge[][2] = {{much, 0}, {0.1, much}};
    for (size_t i = 0; i < w.m.def.links; i++)
        w.m.link[i].rest = w.m.link[i].stiffness = 100;
    for (int i = 0; i < 2; i++)
        CHECK(spring_links_tethers(def, huge[i][0], huge[i][1], w.tether, &count, w.work, w.distance) == SPRING_EINVAL,
              "a stiffness and a rest length that a scene would refuse");
    def->mass_all = -1;
    def->mass = NULL;
    CHECK(spring_links_tethers(def, 0.1, 0, w.tether, &count, w.work, w.distance) == SPRING_EINVAL, "a bad definition");
    def->mass_all = 0;
    def->axes = 1;
    CHECK(spring_links_tethers(def, 0.1, 0, w.tether, &count, w.work, w.distance) == SPRING_EUNSUPPORTED, "one axis");
    CHECK(count == room, "nothing is written");
}

/* ------------------------------------------------------------------------------------------------- hanging scenes */

typedef struct stretch {
    double lowest, link; /* [m]; largest length/rest - 1 of a link without tethers */
} stretch;

/* Lets a scene with gravity along -y come to rest at this time step. Drag makes it slow. */
static stretch settle(const spring_scene_def *def, size_t links, double dt)
{
    spring_scene *s = scene_of(def);
    CHECK(dt <= 0.501 * spring_scene_stable_step(s, SPRING_LEAPFROG), "half of the stable step");
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, dt, (uint64_t)(40 / dt)) == SPRING_OK, "stable");
    static state y;
    get_state(s, def->particles, &y);
    free(s);
    stretch most_of = {0, 0};
    for (size_t i = 0; i < def->particles; i++)
        most_of.lowest = fmin(most_of.lowest, y.x[3 * i + 1]);
    for (size_t i = 0; i < links; i++) {
        const double *a = &y.x[3 * def->link[i].a], *b = &y.x[3 * def->link[i].b];
        const double length = sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
        most_of.link = fmax(most_of.link, length / def->link[i].rest - 1);
    }
    return most_of;
}

static void build_falling(const spring_grid *g, double mass)
{
    build_grid(&w.m, g, mass);
    CHECK(w.m.def.particles <= room, "fits");
    w.m.def.gravity[1] = -9.81, w.m.def.drag = 2 * mass, w.m.def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
}

/* A rope of 40 links, as stiff as 4 steps per frame allow with half of the stable step. */
static void a_rope_keeps_its_length(void)
{
    const double dt = 1. / 240, mass = 0.005, fraction = 0.05, stiffness = pow(1 / dt, 2) * mass / 4 / (1 + fraction);
    const spring_grid g = {.count = {1, 41}, .spacing = 0.05, .stiffness = stiffness};
    double longer[2];
    for (int tethers = 0; tethers < 2; tethers++) {
        build_falling(&g, mass);
        w.m.pinned[0] = 1;
        for (size_t i = 0; i < 41; i++)
            w.m.position[3 * i + 1] *= -1;
        const size_t links = w.m.def.links;
        if (tethers)
            CHECK(append_tethers(fraction, 0) == 39, "the first particle is next to the pinned one");
        longer[tethers] = -settle(&w.m.def, links, dt).lowest / 2 - 1;
    }
    CHECK_CLOSE(longer[0], 9.81 * mass * 40 * 41 / (2 * stiffness) / 2, 0.01, "the formula of spring_grid");
    CHECK_BELOW(longer[1], 0.005, "with tethers, at most half a percent too long");
}

/* README's cloth, with softer links and tethers: 12 steps per frame instead of 23. */
static void a_cloth_keeps_its_shape(void)
{
    const double mass = 0.01;
    spring_grid g = {.count = {25, 25}, .spacing = 2. / 24};
    g.families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND;
    stretch s[2];
    for (int tethers = 0; tethers < 2; tethers++) {
        g.stiffness = tethers ? 200 : 20000; /* the stiff cloth is the reference solution */
        build_falling(&g, mass);
        w.m.pinned[0] = w.m.pinned[24] = 1;
        for (size_t i = 0; i < 625; i++)
            w.m.position[3 * i + 1] *= -1;
        const size_t links = w.m.def.links;
        if (tethers)
            append_tethers(0.05, 0);
        s[tethers] = settle(&w.m.def, links, 1. / (60 * (tethers ? 12 : 120)));
    }
    CHECK_BELOW(s[1].lowest / s[0].lowest - 1, 0.015, "at most 1.5 % too long");
    CHECK_BELOW(s[1].link, 0.05, "no link stretches by more than 5 %");
}

/* A scene of two ropes. When the anchor of one is freed, its tethers do not act. */
static void freed_anchors(void)
{
    for (int i = 0; i < 20; i++) {
        const double fraction = random_log(0.05, 2);
        const spring_grid g = {.count = {2 + below(20), 2}, .spacing = 0.1, .stiffness = 300, .damping = 0.1};
        spring_scene *s[2];
        for (int tethers = 0; tethers < 2; tethers++) {
            build_falling(&g, 0.02);
            w.m.def.flags |= SPRING_SCENE_EDITABLE;
            memset(w.m.pinned, 0, sizeof w.m.pinned);
            w.m.pinned[0] = w.m.pinned[g.count[0]] = 1;
            const size_t links = w.m.def.links;
            append_tethers(fraction, 0.01);
            if (!tethers) /* only the part that stays pinned keeps its tethers */
                for (size_t l = links; l < w.m.def.links; l++)
                    w.m.link[l].stiffness = w.m.link[l].b == 0 ? 0 : w.m.link[l].stiffness;
            s[tethers] = scene_of(&w.m.def);
        }
        CHECK(spring_scene_set_pinned(s[0], 0, 1, &(uint8_t){0}) == SPRING_OK &&
                  spring_scene_set_pinned(s[1], 0, 1, &(uint8_t){0}) == SPRING_OK,
              "editable");
        const double dt = 0.5 * spring_scene_stable_step(s[0], SPRING_LEAPFROG);
        CHECK_BITS(spring_scene_stable_step(s[1], SPRING_LEAPFROG), 2 * dt, "tethers that do not act do not count");
        CHECK(spring_scene_advance(s[0], SPRING_LEAPFROG, dt, 300) == SPRING_OK &&
                  spring_scene_advance(s[1], SPRING_LEAPFROG, dt, 300) == SPRING_OK,
              "stable");
        CHECK(same_bits(s[0], s[1], w.m.def.particles, 3), "as without the tethers of the freed part");
        free(s[0]);
        free(s[1]);
    }
}

/* ------------------------------------------------------------------------------------------------- softened scenes */

static void soften(void)
{
    static model before;
    unsigned too_stiff = 0, softened = 0;
    for (unsigned number = 0; number < 700; number++) {
        build_random(1 + below(number % 10 == 0 ? 650 : 40), true);
        const double factor = random_log(1, 1e3);
        for (size_t i = 0; i < w.m.def.links; i++) {
            w.m.link[i].stiffness *= random_log(1 / factor, factor);
            w.m.link[i].damping = random_uniform(0, 1);
        }
        for (size_t i = 0; i < w.m.def.particles; i++)
            w.m.mass[i] = w.m.pinned[i] ? -1 : w.m.mass[i]; /* which is not used */
        if (number % 3 == 0)
            w.m.def.weighted_links = 0;
        const double stable = stable_step_of(&w.m.def, SPRING_LEAPFROG);
        if (!(stable < INFINITY))
            continue;
        const double fraction = random_uniform(0.1, 1), dt = random_log(0.3, 30) * fraction * stable;
        spring_scene_def weighted = w.m.def;
        weighted.links = 0;
        const double limit = stable_step_of(&weighted, SPRING_LEAPFROG);
        before = w.m;
        const spring_status status = spring_links_soften(&w.m.def, dt, fraction, w.m.link);
        if (status == SPRING_ERANGE) {
            CHECK(dt > fraction * limit * (1 - 1e-4), "weighted links leave nothing");
            CHECK(memcmp(before.link, w.m.link, sizeof before.link) == 0, "nothing is written");
            too_stiff++;
            continue;
        }
        CHECK(status == SPRING_OK, "weighted links leave something");
        bool lowered = false;
        for (size_t i = 0; i < w.m.def.links; i++) {
            const spring_link *const now = &w.m.link[i], *const was = &before.link[i];
            CHECK(now->stiffness <= was->stiffness && (now->stiffness > 0 || was->stiffness == 0) &&
                      now->damping == was->damping && now->rest == was->rest && now->a == was->a && now->b == was->b &&
                      now->flags == was->flags,
                  "lower stiffness, and nothing else");
            lowered |= now->stiffness < was->stiffness;
        }
        const double now = stable_step_of(&w.m.def, SPRING_LEAPFROG);
        CHECK(dt <= fraction * now, "stable");
        CHECK(!lowered || w.m.def.weighted_links > 0 || now <= 1.4 * dt / fraction, "and no softer than needed");
        CHECK(lowered || now == stable, "nothing to do");
        CHECK(lowered == (dt > fraction * stable) || fabs(dt / (fraction * stable) - 1) < 1e-3, "only where needed");
        softened += lowered;
    }
    CHECK(too_stiff > 20 && softened > 20, "both happen");
}

int main(void)
{
    static const test tests[] = {
        {"ends and lengths", ends_and_lengths},
        {"invalid input", invalid_input},
        {"a rope keeps its length", a_rope_keeps_its_length},
        {"a cloth keeps its shape", a_cloth_keeps_its_shape},
        {"freed anchors", freed_anchors},
        {"soften", soften},
    };
    return RUN_TESTS("tethers", tests);
}
