/* SPDX-License-Identifier: MIT */
/* Rare cases of scenes: only springs or only dampers, the conditions for a band of links, calls between two steps that
   share a force, invalid numbers at the end, a scene that overflows. */
#include "test_scene.h"

static void count_calls(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                        scalar *const force[3])
{
    (void)t, (void)particles, (void)x, (void)v, (void)force;
    ++*(int *)user;
}

/* One Euler step of springs alone, or dampers alone, each with its own small number, in a band or an edge list, against
   a plain loop. */
static void weak_links(void)
{
    static model m;
    static state y, end;
    const double dt = 0.013;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned how = 0; how < 4; how++) {
            const bool dampers = how % 2 != 0;
            build(&m, (uint32_t[]){21, 1, 1}, axes, OWN | (how / 2 != 0 ? SHUFFLED : 0));
            for (size_t i = 0; i < m.def.links; i++) {
                const double number = 0.3 + 0.01 * (double)i;
                m.link[i].stiffness = dampers ? 0 : number;
                m.link[i].damping = dampers ? number : 0;
            }
            use_all_methods(&m.def);
            spring_scene *s = scene_of(&m.def);
            CHECK((s->layout.bands == 0) == (how / 2 != 0), "without order there are no bands");
            get_state(s, m.def.particles, &y);
            double force[3 * most] = {0}, size[most] = {0};
            plain_forces(&m.def, axes, y.x, y.v, force, size);
            CHECK(spring_scene_advance(s, SPRING_EULER, dt, 1) == SPRING_OK, "a step");
            get_state(s, m.def.particles, &end);
            for (size_t i = 0; i < m.def.particles * axes; i++) {
                const double pull = dt * size[i / axes] / m.def.mass_all;
                CHECK_CLOSE(end.v[i], y.v[i] + dt * force[i] / m.def.mass_all, EPS * (2 * fabs(y.v[i]) + 24 * pull),
                            "delta and relative velocity to 1 eps, 16 roundings of products, quotients and sums");
                CHECK_CLOSE(end.x[i], y.x[i] + dt * y.v[i], EPS * (fabs(y.x[i]) + 2 * dt * fabs(y.v[i])),
                            "a product and a sum");
            }
            free(s);
        }
}

/* So many links of an offset, from particle `first` on, the last of them moved up to particle `last`: bands, or
   none. */
static uint32_t bands_of(uint32_t links, uint32_t offset, uint32_t first, uint32_t last)
{
    static const double position[3 * 1200];
    spring_link link[64];
    for (uint32_t i = 0; i < links; i++) {
        const uint32_t lower = i + 1 < links ? first + i : last;
        link[i] = (spring_link){lower, lower + offset, 0.6, 2.7, 0};
    }
    const uint32_t more = 13; /* so that the scene is not small */
    const spring_scene_def def = {
        .particles = last + offset + more, .links = links, .position = position, .link = link};
    spring_scene *s = scene_of(&def);
    const uint32_t bands = s->layout.bands;
    CHECK(s->layout.unbanded == (bands == 0 ? links : 0), "in a band, or in the edge list");
    free(s);
    return bands;
}

/* Eight links make a band if they take a quarter of its places. */
static void what_makes_a_band(void)
{
    for (uint32_t first = 0; first < 500; first += 499)
        for (uint32_t offset = 1; offset <= 256; offset += 255) {
            CHECK(bands_of(8, offset, first, first + 7) == 1, "eight links");
            CHECK(bands_of(7, offset, first, first + 6) == 0, "seven links are too few");
            CHECK(bands_of(10, offset, first, first + 42) == 1, "10 of 43 places, a quarter rounded down");
            CHECK(bands_of(10, offset, first, first + 43) == 0, "10 of 44 places are less than a quarter");
        }
}

/* A step of leapfrog of links and gravity alone, against a plain loop: x1 = x + dt (v + dt/2 (F/m + g)). */
static void check_drift(const model *m, const spring_scene *end, const state *start)
{
    static state y;
    const double dt = 0.013, mass = m->def.mass_all;
    const uint32_t axes = m->def.axes;
    double force[3 * most] = {0}, size[most] = {0};
    plain_forces(&m->def, axes, start->x, start->v, force, size);
    get_state(end, m->def.particles, &y);
    for (size_t i = 0; i < m->def.particles * axes; i++) {
        const double half = start->v[i] + dt / 2 * (force[i] / mass + m->def.gravity[i % axes]);
        const double kick = dt / 2 * (size[i / axes] / mass + 10) * (40 + (double)m->def.links);
        CHECK_CLOSE(y.x[i], start->x[i] + dt * half, EPS * (fabs(start->x[i]) + dt * (3 * fabs(start->v[i]) + kick)),
                    "a force to 40 eps and one for each link, velocity to 3, the start to 1");
    }
}

/* Bands that begin and end anywhere, between particles that no link joins, in vectors of every length. */
static void bands_of_every_length(void)
{
    static const uint32_t offsets[] = {1, 5, 40};
    static model m;
    static state start;
    for (uint32_t axes = 1; axes <= 3; axes += 2)
        for (unsigned how = 0; how < 6; how++)
            for (uint32_t links = 8; links <= 40; links++) {
                const uint32_t offset = offsets[how % 3], first = links * 7 % 19, behind = links * 5 % 23;
                build(&m, (uint32_t[]){first + links + offset + behind, 1, 1}, axes, GRAVITY);
                m.def.links = links;
                for (uint32_t i = 0; i < links; i++)
                    m.link[i] = (spring_link){first + i, first + i + offset, 0.6, how / 3 ? 2.7 + 0.1 * i : 2.7, 0};
                for (int k = 0; k < kernel_count; k++) {
                    if (kernels_of(k) == NULL)
                        continue;
                    spring_scene *s = scene_of(&m.def);
                    CHECK(s->layout.bands == 1 && s->layout.band[0].equal == (how / 3 == 0), "a band");
                    get_state(s, m.def.particles, &start);
                    CHECK(spring_scene_advance_with(kernels_of(k), s, SPRING_LEAPFROG, 0.013, 1) == SPRING_OK,
                          "a step");
                    check_drift(&m, s, &start);
                    free(s);
                }
            }
}

/* More offsets than there is room for bands. */
static void many_offsets(void)
{
    enum { offsets = most_bands + 8, lowers = 10 };
    static model m;
    static state start;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (uint32_t shorter = 0; shorter < 2; shorter++) {
            build(&m, (uint32_t[]){lowers + offsets, 1, 1}, axes, 0);
            m.def.links = 0;
            for (uint32_t offset = offsets; offset > 0; offset--)
                for (uint32_t i = offset % 5 == 0 ? shorter : 0; i < lowers; i++)
                    m.link[m.def.links++] = (spring_link){i, i + offset, 0.6, 0.27 * offset, 0};
            spring_scene *s = scene_of(&m.def);
            CHECK(s->layout.bands == most_bands && s->layout.unbanded == (offsets - most_bands) * (lowers - shorter),
                  "the longest have bands, what has none is in the edge list");
            get_state(s, m.def.particles, &start);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.013, 1) == SPRING_OK, "a step");
            check_drift(&m, s, &start);
            free(s);
        }
}

/* As many bands as there can be, in the small table in which their offsets are counted: sheets of many widths. */
static void offsets_that_meet(void)
{
    static const uint32_t widths[] = {1, 3, 16, 35, 100, 255, 256, 257, 512, 1000, 1024};
    enum { lowers = 8, widest = 1024 };
    static const double position[lowers + most_bands * widest];
    spring_link link[most_bands * lowers];
    for (size_t w = 0; w < sizeof widths / sizeof widths[0]; w++) {
        for (uint32_t i = 0; i < most_bands * lowers; i++)
            link[i] = (spring_link){i % lowers, i % lowers + (i / lowers + 1) * widths[w], 0.6, 2.7, 0};
        const spring_scene_def def = {.axes = 1,
                                      .particles = lowers + most_bands * widths[w],
                                      .links = most_bands * lowers,
                                      .position = position,
                                      .link = link};
        spring_scene *s = scene_of(&def);
        CHECK(s->layout.bands == most_bands && s->layout.unbanded == 0, "each has its band");
        free(s);
    }
}

/* Links that break the order of a band: one again, one late, one below the first. They alone lie in the edge list. */
static void stray_links(void)
{
    static model m;
    static state start;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned own = 0; own <= OWN; own += OWN) {
            enum { particles = 37, again = 11, late = 22 };
            static spring_link sorted[particles - 1], link[particles];
            size_t links = 0;
            for (uint32_t i = 0; i + 1 < particles; i++)
                sorted[i] = (spring_link){i, i + 1, 0.6, own != 0 ? 2.7 + 0.1 * i : 2.7, 0};
            for (uint32_t i = 1; i + 1 < particles; i++) {
                if (i != late)
                    link[links++] = sorted[i];
                if (i == again)
                    link[links++] = sorted[i];
                if (i == late + 3)
                    link[links++] = sorted[late];
            }
            link[links++] = sorted[0];
            build(&m, (uint32_t[]){particles, 1, 1}, axes, 0);
            m.def.link = link;
            m.def.links = links;
            spring_scene *s = scene_of(&m.def);
            CHECK(s->layout.bands == 1 && s->layout.unbanded == 3, "a band, and three unbanded links");
            get_state(s, m.def.particles, &start);
            CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.013, 1) == SPRING_OK, "a step");
            check_drift(&m, s, &start);
            free(s);
        }
}

/* One link of every offset: far too few for bands. */
static void every_offset(void)
{
    enum { links = 5000 };
    double *position = malloc((links + 1) * sizeof *position);
    spring_link *link = malloc(links * sizeof *link);
    for (uint32_t i = 0; i <= links; i++)
        position[i] = i;
    for (uint32_t i = 0; i < links; i++)
        link[i] = (spring_link){0, i + 1, 0.5, 2, 0};
    const spring_scene_def def = {
        .axes = 1, .particles = links + 1, .links = links, .position = position, .link = link};
    spring_scene *s = scene_of(&def);
    CHECK(s->layout.bands == 0, "one link makes no band");
    for (uint32_t i = 0; i < links; i++)
        CHECK_BITS(spring_scene_tension(s, i), 2 * (i + 0.5), "2 N/m of (i + 1) m - 0.5 m, exactly");
    free(s);
    free(position);
    free(link);
}

/* A block with diagonals and bending links has sixteen offsets, and each its band. */
static void bands_of_a_block(void)
{
    static model m;
    build(&m, (uint32_t[]){5, 6, 7}, 3, 0);
    spring_scene *s = scene_of(&m.def);
    CHECK(s->layout.bands == 16 && s->layout.unbanded == 0, "no link is left for the edge list");
    free(s);
}

/* The stable step is found in the memory of the forces: those of the last step must not be taken from there then. */
static void question_after_edit(void)
{
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        build(&m, (uint32_t[]){5, 4, 1}, axes, OWN | EDITABLE | MASSES);
        spring_scene *asked = scene_of(&m.def), *other = scene_of(&m.def);
        spring_link link = m.link[3];
        link.stiffness *= 1700;
        for (int i = 0; i < 2; i++) {
            spring_scene *s = i == 0 ? asked : other;
            const double before = s == asked ? spring_scene_stable_step(s, SPRING_LEAPFROG) : 0;
            CHECK(spring_scene_set_link(s, 3, &link) == SPRING_OK, "an edit");
            spring_scene_advance(s, SPRING_LEAPFROG, 0.013, 1);
            if (s == asked)
                CHECK(spring_scene_stable_step(s, SPRING_LEAPFROG) < before, "a question, and a stiffer link");
            spring_scene_advance(s, SPRING_LEAPFROG, 0.013, 1);
        }
        CHECK(same_bits(asked, other, m.def.particles, axes), "asking changes nothing");
        free(asked);
        free(other);
    }
}

enum { OWN_NUMBERS = 1, WITH_DAMPERS = 2, CUT = 4, IN_EDGE_LIST = 8 };

/* Two particles that are joined to nothing lie in a gap of a band, and infinitely far apart; or what joined them, in a
   band or the edge list, has been cut. */
static void check_gap(uint32_t axes, unsigned how)
{
    enum { particles = 13 };
    const double far = sizeof(scalar) == 4 ? 3e38 : 1.5e308;
    double position[3 * particles] = {0};
    spring_link link[particles];
    size_t links = 0;
    for (uint32_t k = 0; k < particles; k++) {
        const uint32_t i = how & IN_EDGE_LIST ? particles - 1 - k : k; /* in descending order they make no band */
        const bool apart = i == 4 || i == 5 || i == 6;
        position[axes * i] = i == 5 ? far : i == 6 ? -far : 0.7 * i;
        if ((!apart || how & CUT) && i + 1 < particles)
            link[links++] = (spring_link){i, i + 1, 0.6, apart ? 0 : 2.7 + (how & OWN_NUMBERS ? 0.1 * i : 0),
                                          apart || !(how & WITH_DAMPERS) ? 0 : 0.3};
    }
    const spring_scene_def def = {
        .axes = axes, .particles = particles, .links = links, .position = position, .link = link};
    spring_scene *s = scene_of(&def);
    CHECK((s->layout.unbanded == 0) == !(how & IN_EDGE_LIST), "where the links lie");
    CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.013, 5) == SPRING_OK, "their distance does not matter");
    double x[3];
    spring_scene_get(s, SPRING_POSITION, x, 0, 5, 1);
    CHECK_BITS(x[0], (double)(scalar)far, "nothing pulls");
    free(s);
}

static void gap(void)
{
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned how = 0; how < 16; how++)
            check_gap(axes, how);
}

static void push(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                 scalar *const force[3])
{
    (void)user, (void)t, (void)particles, (void)x, (void)v;
    force[0][2] += (scalar)3.7;
}

/* A callback that uses no velocities and is set between two leapfrog steps acts in the next half kick. */
static void callback_between_steps(void)
{
    static model m;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        build(&m, (uint32_t[]){5, 4, 1}, axes, OWN | MASSES);
        m.def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
        spring_scene *s = scene_of(&m.def), *again = scene_of(&m.def);
        spring_scene_advance(s, SPRING_LEAPFROG, 0.013, 1);
        get_state(s, m.def.particles, &y);
        set_state(again, m.def.particles, &y);
        spring_scene_set_force(s, push, NULL);
        spring_scene_set_force(again, push, NULL);
        spring_scene_advance(s, SPRING_LEAPFROG, 0.013, 1);
        spring_scene_advance(again, SPRING_LEAPFROG, 0.013, 1);
        CHECK(same_bits(s, again, m.def.particles, axes), "as if it had been there from this state on");
        free(s);
        free(again);
    }
}

static void bad_number_at_the_end(void)
{
    static model m;
    static state y;
    for (uint32_t axes = 1; axes <= 3; axes++) {
        build(&m, (uint32_t[]){5, 4, 1}, axes, 0);
        spring_scene *s = scene_of(&m.def), *other = scene_of(&m.def);
        for (size_t i = 0; i < m.def.particles * axes; i++)
            y.x[i] = 7;
        y.x[m.def.particles * axes - 1] = NAN;
        CHECK(spring_scene_set(s, SPRING_POSITION, y.x, 0, 0, m.def.particles) == SPRING_EINVAL, "not a number");
        CHECK(same_bits(s, other, m.def.particles, axes), "nothing has been set");
        free(s);
        free(other);
    }
}

/* Without rollback all is lost, whichever particle overflows and on whichever axis, and all has to be set again. */
static void lost(void)
{
    enum { particles = 2 };
    const double position[3 * particles] = {0.3, 0.1, -0.2, -0.9, 0.4, 0.6}, still[3 * particles] = {0};
    const double huge = sizeof(scalar) == 4 ? 3e38 : 1e308;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (size_t fast = 0; fast < particles * axes; fast++) {
            double velocity[3 * particles] = {0}, y[3 * particles];
            velocity[fast] = 10;
            spring_scene_def def = {.axes = axes,
                                    .flags = SPRING_SCENE_NO_UNDO,
                                    .particles = particles,
                                    .position = position,
                                    .velocity = velocity};
            const method_list all = use_all_methods(&def);
            for (const spring_method *k = all.at; *k != no_method; k++) {
                spring_scene *s = scene_of(&def);
                CHECK(spring_scene_advance(s, *k, huge, 1) == SPRING_ENONFINITE, "overflow");
                CHECK(!spring_scene_at_rest(s, INFINITY, INFINITY), "what is lost is not at rest");
                for (spring_quantity q = SPRING_POSITION; q <= SPRING_VELOCITY; q++) {
                    spring_scene_get(s, q, y, 0, 0, particles);
                    for (size_t i = 0; i < particles * axes; i++)
                        CHECK(isnan(y[i]), "nothing is left");
                    for (size_t i = 0; i < particles; i++) {
                        CHECK(spring_scene_advance(s, *k, 0.1, 1) == SPRING_ENONFINITE, "not all is set again");
                        spring_scene_set(s, q, q == SPRING_POSITION ? position + i * axes : still, 0, i, 1);
                    }
                }
                CHECK(spring_scene_advance(s, *k, 0.1, 1) == SPRING_OK, "usable again");
                CHECK(spring_scene_at_rest(s, 0, 0), "and at rest");
                free(s);
            }
        }
}

static void bad_force(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                      scalar *const force[3])
{
    (void)t, (void)x, (void)v;
    for (size_t i = 0; i < particles && *(bool *)user; i++)
        force[0][i] = (scalar)NAN;
}

/* State that is set anew is finite, whatever the forces were that the scene still has. */
static void found(void)
{
    enum { particles = 50 };
    static const double zeros[3 * particles];
    for (uint32_t axes = 1; axes <= 3; axes++) {
        bool bad = true;
        const spring_scene_def def = {.axes = axes,
                                      .flags = SPRING_SCENE_NO_UNDO,
                                      .particles = particles,
                                      .position = zeros,
                                      .force = bad_force,
                                      .user = &bad};
        spring_scene *s = scene_of(&def);
        CHECK(spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 1) == SPRING_ENONFINITE, "lost");
        bad = false;
        CHECK(spring_scene_set(s, SPRING_POSITION, zeros, 0, 0, particles) == SPRING_OK &&
                  spring_scene_set(s, SPRING_VELOCITY, zeros, 0, 0, particles) == SPRING_OK &&
                  spring_scene_advance(s, SPRING_LEAPFROG, 0.1, 1) == SPRING_OK,
              "and found");
        free(s);
    }
}

/* A scene that may use more methods has more memory, and the same steps. */
static void methods_not_used(void)
{
    static model m;
    for (uint32_t axes = 1; axes <= 3; axes++)
        for (unsigned features = 0; features < EDITABLE; features += 3) {
            build(&m, (uint32_t[]){7, 5, 1}, axes, features);
            const spring_scene_def of_all = m.def;
            const method_list list = methods_of(of_all);
            for (const spring_method *method = list.at; *method != no_method; method++) {
                spring_scene *all = scene_of(&of_all);
                m.def.methods = 1u << *method;
                m.def.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY;
                spring_scene *one = scene_of(&m.def);
                for (const spring_method *other = list.at; *other != no_method; other++)
                    CHECK_BITS(spring_scene_stable_step(one, *other), spring_scene_stable_step(all, *other),
                               "nor other limits");
                for (int i = 0; i < 2; i++) {
                    spring_scene_advance(all, *method, 0.009, 3);
                    spring_scene_advance(one, *method, 0.009, 3);
                }
                CHECK(same_bits(one, all, m.def.particles, axes), "the same steps");
                free(all);
                free(one);
            }
        }
}

/* A callback that looks into a table by position must not be handed NaN. */
static void callback_is_left_alone(void)
{
    const double position[] = {0.3, -0.9}, fast[] = {10, -20}, at_rest[] = {0, 0}, dt = 0.013;
    const double huge = sizeof(scalar) == 4 ? 3e38 : 1e308;
    int calls = 0;
    spring_scene_def def = {.axes = 1,
                            .flags = SPRING_SCENE_NO_UNDO,
                            .particles = 2,
                            .position = position,
                            .velocity = fast,
                            .mass_all = 1.7,
                            .force = count_calls,
                            .user = &calls};
    const method_list all = use_all_methods(&def);
    for (const spring_method *k = all.at; *k != no_method; k++) {
        calls = 0;
        spring_scene *s = scene_of(&def);
        CHECK(spring_scene_advance(s, *k, huge, 1) == SPRING_ENONFINITE, "overflow");
        CHECK(calls > 0, "the callback was asked before");
        calls = 0;
        CHECK(!spring_scene_at_rest(s, 1, 1) && calls == 0, "nor is it for a question");
        spring_scene_set(s, SPRING_POSITION, position, 0, 0, 1);
        spring_scene_set(s, SPRING_VELOCITY, at_rest, 0, 0, 2);
        calls = 0;
        CHECK(spring_scene_advance(s, *k, dt, 1) == SPRING_ENONFINITE, "one particle is still lost");
        CHECK(calls == 0, "nothing is computed from what is lost");
        spring_scene_set(s, SPRING_POSITION, position, 0, 0, 2);
        CHECK(spring_scene_advance(s, *k, dt, 1) == SPRING_OK && calls > 0, "usable again");
        free(s);
    }
}

static void ask_finite(void *user, double t, size_t particles, const scalar *const x[3], const scalar *const v[3],
                       scalar *const force[3])
{
    (void)t;
    for (size_t i = 0; i < particles; i++) {
        *(bool *)user &= isfinite(x[0][i]) && isfinite(v[0][i]);
        force[0][i] += (scalar)-0.3 * v[0][i];
    }
}

/* A callback is not handed infinite numbers or NaN in the step in which a scene overflows, wherever in the step that
   is. */
static void finite_for_callbacks(void)
{
    const double position[] = {0, 1.5}, fastest = sizeof(scalar) == 4 ? 1e38 : 1e300;
    for (unsigned how = 0; how < 4; how++) {
        bool finite = true;
        const spring_link link = {0, 1, 1, 100, how % 2 != 0 ? 0.7 : 0};
        spring_scene_def def = {.axes = 1,
                                .flags = how / 2 != 0 ? SPRING_SCENE_NO_UNDO : 0,
                                .particles = 2,
                                .links = 1,
                                .position = position,
                                .link = &link,
                                .force = ask_finite,
                                .user = &finite};
        const method_list all = use_all_methods(&def);
        for (const spring_method *k = all.at; *k != no_method; k++)
            for (double dt = 0.1; dt < fastest; dt *= 7.3) {
                spring_scene *s = scene_of(&def);
                CHECK(spring_scene_advance(s, *k, dt, 4000) == SPRING_ENONFINITE || dt < 1, "overflow");
                CHECK(finite, "the callback sees finite numbers alone");
                free(s);
            }
    }
}

/* Twice the inverse mass overflows, and twice the stiffness over the mass does not. */
static void light_particles(void)
{
    const double position[] = {0, 1}, mass = sizeof(scalar) == 4 ? 4e-39 : 6e-309;
    const spring_link link = {0, 1, 1, 0, 0};
    const spring_scene_def def = {
        .axes = 1, .particles = 2, .links = 1, .position = position, .mass_all = mass, .link = &link};
    CHECK(spring_scene_check(&def, NULL, NULL) == SPRING_OK, "a link that does not pull is not too stiff");
}

static void gravity_beyond_the_axes(void)
{
    const double position[] = {0, 1, 2};
    for (uint32_t axes = 1; axes < 3; axes++) {
        spring_scene_def def = {.axes = axes, .particles = 1, .position = position};
        def.gravity[axes] = NAN;
        CHECK(spring_scene_check(&def, NULL, NULL) == SPRING_OK, "not looked at");
        def.gravity[axes - 1] = NAN;
        CHECK(spring_scene_check(&def, NULL, NULL) == SPRING_EINVAL, "and within them it is");
    }
}

/* Stiff links between heavy particles do not hide soft ones between light particles, of which the bound is. */
static void light_and_heavy(void)
{
    const double big = EPS < 1e-10 ? 1e300 : 1e30, tiny = EPS < 1e-10 ? 1e-100 : 1e-20, rate = 1e3; /* k/m [1/s^2] */
    const double position[] = {0, 1, 2, 3}, mass[] = {big, big, tiny, tiny};
    const spring_link link[] = {{0, 1, 1, big, 0}, {2, 3, 1, rate * tiny, 0}};
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
        const spring_link link[] = {{0, 1, 1, huge, damping}, {0, 2, 1, huge, 0}, {0, 3, 1, huge, 0}};
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

int main(void)
{
    static const test tests[] = {
        {"weak springs, weak dampers", weak_links},
        {"what makes a band", what_makes_a_band},
        {"bands of every length", bands_of_every_length},
        {"many offsets", many_offsets},
        {"offsets that meet", offsets_that_meet},
        {"stray links", stray_links},
        {"every offset", every_offset},
        {"bands of a block", bands_of_a_block},
        {"a question after an edit", question_after_edit},
        {"a gap", gap},
        {"a callback between steps", callback_between_steps},
        {"a bad number at the end", bad_number_at_the_end},
        {"nothing is computed from lost values", callback_is_left_alone},
        {"finite numbers for callbacks", finite_for_callbacks},
        {"lost", lost},
        {"found", found},
        {"light particles", light_particles},
        {"gravity beyond the axes", gravity_beyond_the_axes},
        {"methods that are not used", methods_not_used},
        {"light particles linked to heavy ones", light_and_heavy},
        {"sums of stiffness that overflow", sums_that_overflow},
        {"drag that overflows in a solved kick", drag_that_overflows},
    };
    return RUN_TESTS("scene_rare", tests);
}
