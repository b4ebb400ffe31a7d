/* SPDX-License-Identifier: MIT */
/* The rules of colliders: valid colliders, touching and rest. test_random.c tests bits, calls and rollback. */
#include "test_contact.h"

static size_t count_touching(const spring_scene *s, size_t particles)
{
    uint32_t mask[most];
    size_t count = 0;
    CHECK(spring_scene_touching(s, mask, 0, particles) == SPRING_OK, "room for colliders");
    for (size_t i = 0; i < particles; i++)
        count += mask[i] != 0;
    return count;
}

/* A particle above a floor by less than its rounding error, near a sphere, so that it is computed with particles that hit
   the floor: the result is the same as without these. */
static void neighbours_change_nothing(void)
{
    enum { count = 16 };
    double x[count][3] = {{1, 3e-16, 0}}, v[count][3] = {{0, -1e-14, 0}}, end[2][6]; /* alone, among others */
    const spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .friction = 0.25},
                                  {.shape = SPRING_SPHERE, .at = {1, 1.001, 0}, .radius = 1}};
    for (size_t i = 1; i < count; i++) {
        x[i][0] = (double)(10 * i);
        x[i][1] = 0.001;
        v[i][1] = -2;
    }
    for (int m = 0; m < method_count; m++)
        for (int k = 0; k < kernel_count; k++) {
            if (kernels_of(k) == NULL)
                continue;
            for (int all = 0; all < 2; all++) {
                spring_scene_def def = falling(all ? count : 1, x[0], v[0], 2);
                def.gravity[1] = 0, def.colliders = 2;
                spring_scene *s = scene_with(&def, c);
                CHECK(spring_scene_advance_with(kernels_of(k), s, contact_methods[m], 0.01, 1) == SPRING_OK, "valid");
                get(s, end[all], end[all] + 3);
                free(s);
            }
            CHECK(memcmp(end[0], end[1], sizeof end[0]) == 0, "contacts of other particles change no bit");
        }
}

/* Random particles. The first one has the same results alone, in single steps and with other kernels. A link that is
   damped heavily, if there is one, joins it to the second one, which is never left out. */
static void others_change_nothing(void)
{
    enum { count = 32, runs = 3000, steps = 12, collider_count = 4 };
    size_t touched = 0;
    for (int number = 0; number < runs; number++) {
        double x[3 * (count + 1)], v[3 * (count + 1)], results[2][6];
        const uint32_t axes = 2 + (uint32_t)(random_bits() % 2);
        const double reach = random_log(0.5, 3), speed = random_log(0.003, 10), dt = random_log(0.002, 0.1);
        const size_t others =
            number % 2 == 0 ? count - 1 : 1 + random_bits() % 2; /* few, so that colliders are far at first */
        for (size_t i = 0; i < (count + 1) * axes; i++) {
            x[i] = random_uniform(-reach, reach);
            v[i] = random_uniform(-speed, speed);
        }
        spring_collider c[collider_count];
        for (int i = 0; i < collider_count; i++) {
            c[i] = random_collider(axes);
            for (uint32_t a = 0; a < axes; a++) {
                c[i].at[a] += random_uniform(-1, 1);
                c[i].surface[a] = i == 0 ? c[i].surface[a] : 0;
            }
        }
        const spring_method method = contact_methods[random_bits() % method_count];
        spring_scene_def def = {.axes = axes, .position = x, .velocity = v, .gravity = {0, -9.81, 0}};
        def.colliders = collider_count, def.particle_radius = random_uniform(0, 0.1), def.methods = 1u << method;
        const spring_link link = {0, 1, random_uniform(0, 1), random_log(0.1, 100), random_log(1, 1e4) / dt, 0};
        def.links = method == SPRING_LEAPFROG ? random_bits() % 2 : 0, def.link = &link;
        for (int all = 0; all < 2; all++) {
            const scene_kernels *kernels = kernels_of((int)(random_bits() % kernel_count));
            kernels = kernels != NULL ? kernels : kernels_of(0);
            def.particles = 1 + def.links + (all ? others : 0);
            spring_scene *s = scene_with(&def, c);
            for (int i = 0; i < (all ? 1 : steps); i++) {
                CHECK(spring_scene_advance_with(kernels, s, method, dt, all ? steps : 1) == SPRING_OK, "finite");
                touched += count_touching(s, 1);
            }
            memset(results[all], 0, sizeof results[all]);
            get(s, results[all], results[all] + 3);
            free(s);
        }
        CHECK(memcmp(results[0], results[1], sizeof results[0]) == 0, "other particles change no bit");
    }
    CHECK(touched > runs, "contacts took place");
}

/* Another view of a scene: in units of 2^length m, 2^time s and 2^mass kg, and mirrored along an axis unless that is < 0. */
typedef struct view {
    int length, time, mass, mirrored;
} view;

static double seen(view w, double value, int length, int time, int axis)
{
    return ldexp(axis == w.mirrored ? -value : value, length * w.length + time * w.time);
}

static void change_collider(spring_collider *c, view w)
{
    enum { no_axis = 3 };
    c->radius = seen(w, c->radius, 1, 0, no_axis);
    for (int a = 0; a < 3; a++) {
        const int of_surface = c->shape == SPRING_BOX ? no_axis : a; /* the axes of a box are mirrored as well */
        c->at[a] = seen(w, c->at[a], 1, 0, a);
        c->to[a] = seen(w, c->to[a], 1, 0, a);
        c->half[a] = seen(w, c->half[a], 1, 0, no_axis);
        c->velocity[a] = seen(w, c->velocity[a], 1, -1, a);
        c->velocity_to[a] = seen(w, c->velocity_to[a], 1, -1, a);
        c->surface[a] = seen(w, c->surface[a], 1, -1, of_surface);
        c->acceleration[a] = seen(w, c->acceleration[a], 1, -2, a);
        const int turns = w.mirrored < 0 || a == w.mirrored ? 1 : -1; /* axial vectors */
        c->spin[a] = turns * seen(w, c->spin[a], 0, -1, no_axis);
        c->spin_acceleration[a] = turns * seen(w, c->spin_acceleration[a], 0, -2, no_axis);
        for (int i = 0; i < 3; i++)
            c->axis[i][a] = seen(w, c->axis[i][a], 0, 0, a);
    }
}

static void change_model(model *m, view w)
{
    const size_t axes = m->def.axes;
    for (size_t i = 0; i < m->def.particles * axes; i++) {
        m->position[i] = seen(w, m->position[i], 1, 0, (int)(i % axes));
        m->velocity[i] = seen(w, m->velocity[i], 1, -1, (int)(i % axes));
    }
    for (size_t i = 0; i < m->def.particles; i++)
        m->mass[i] = ldexp(m->mass[i], w.mass);
    for (size_t i = 0; i < m->def.links; i++) {
        m->link[i].rest = ldexp(m->link[i].rest, w.length);
        m->link[i].stiffness = ldexp(m->link[i].stiffness, w.mass - 2 * w.time);
        m->link[i].damping = ldexp(m->link[i].damping, w.mass - w.time);
    }
    for (int a = 0; a < 3; a++)
        m->def.gravity[a] = seen(w, m->def.gravity[a], 1, -2, a);
    m->def.mass_all = ldexp(m->def.mass_all, w.mass);
    m->def.drag = ldexp(m->def.drag, w.mass - w.time);
    m->def.particle_radius = ldexp(m->def.particle_radius, w.length);
}

/* Whether vec_inverse_sqrt() uses the same formula for all links, in other units too. */
static bool are_ordinary(const model *m, const double *x)
{
    for (size_t i = 0; i < m->def.links; i++) {
        double square = 0;
        for (uint32_t a = 0; a < m->def.axes; a++)
            square += pow(x[m->link[i].b * m->def.axes + a] - x[m->link[i].a * m->def.axes + a], 2);
        if (!(square > 1e-20 && square < 1e10))
            return false;
    }
    return true;
}

/* Units and mirrors change no bit of a scene with contacts: no other constant has a unit, and no direction is preferred.
   The unit of damping is an even power of two, because heavy damping takes its root. */
static void units_and_mirrors(void)
{
    enum { runs = 1500, steps = 20, bodies = 3, furthest = 4 };
    static model m;
    static double x[2][3 * most], v[2][3 * most];
    size_t touched = 0, compared = 0;
    for (int number = 0; number < runs; number++) {
        const uint32_t axes = 2 + (uint32_t)(random_bits() % 2);
        view w = {.mirrored = (int)(random_bits() % axes)};
        if (number % 2 == 0) {
            w.length = (int)(random_bits() % (2 * furthest + 1)) - furthest;
            w.time = (int)(random_bits() % (2 * furthest + 1)) - furthest;
            w.mass = w.time + 2 * (int)(random_bits() % furthest);
            w.mirrored = -1;
        }
        const double dt = random_log(0.005, 0.05), heavy = random_bits() % 3 == 0 ? random_log(1, 1e3) : 1;
        const spring_method method = contact_methods[random_bits() % method_count];
        spring_collider c[bodies];
        build(&m, (uint32_t[]){4, 3, axes - 1}, axes, (unsigned)(random_bits() % feature_masks));
        for (int i = 0; i < bodies; i++)
            c[i] = random_collider(axes);
        for (size_t i = 0; i < m.def.links && method == SPRING_LEAPFROG; i++)
            m.link[i].damping *= heavy;
        m.def.colliders = bodies, m.def.methods = 1u << method, m.def.particle_radius = random_bits() % 2 ? 0.1 : 0;
        bool ordinary = true;
        for (int k = 0; k < 2; k++) {
            spring_scene *s = scene_with(&m.def, c);
            for (int step = 0; step < steps; step++) {
                run(s, method, ldexp(dt, k * w.time), 1);
                spring_scene_get(s, SPRING_POSITION, x[k], 0, 0, m.def.particles);
                ordinary = ordinary && are_ordinary(&m, x[k]);
            }
            spring_scene_get(s, SPRING_VELOCITY, v[k], 0, 0, m.def.particles);
            touched += count_touching(s, m.def.particles);
            free(s);
            change_model(&m, w);
            for (int i = 0; i < bodies; i++)
                change_collider(&c[i], w);
        }
        for (size_t i = 0; i < m.def.particles * axes && ordinary; i++)
            CHECK(x[1][i] == seen(w, x[0][i], 1, 0, (int)(i % axes)) &&
                      v[1][i] == seen(w, v[0][i], 1, -1, (int)(i % axes)),
                  w.mirrored < 0 ? "the same motion in other units" : "the same motion in a mirror");
        compared += ordinary;
    }
    CHECK(touched > runs && compared > runs / 2, "contacts took place, in ordinary scenes");
}

/* The speed limit counts what is left after the contact, and a moving collider may exceed it. */
static void speed_limit(void)
{
    const double x[] = {1, 0.001, 0}, v[] = {0, -5, 0};
    for (int m = 0; m < method_count; m++) {
        const spring_method method = contact_methods[m];
        spring_scene_def def = falling(1, x, v, 1);
        def.max_speed = 6, def.gravity[1] = -2000;
        spring_collider floor_below = ground;
        spring_scene *s = scene_with(&def, &floor_below);
        for (int i = 0; i < 3; i++)
            run(s, method, 0.001, 2); /* kicks of 2 m/s, which the floor takes */
        floor_below.velocity[1] = 7;
        set(s, &floor_below, 1);
        CHECK(spring_scene_advance(s, method, 0.001, 1) == SPRING_EUNSTABLE, "thrown up at 7 m/s");
        free(s);
    }
}

/* -------------------------------------------------------------------------------------------------------- valid input */

/* Refuses the second of two colliders, and names it and its field. field: NULL if it is valid. */
static void check_field(spring_scene *s, spring_collider c, const char *field)
{
    const spring_collider both[2] = {{.shape = SPRING_SPHERE}, c};
    const spring_status status = field != NULL ? SPRING_EINVAL : SPRING_OK;
    const char *found = "unset";
    size_t index = 99;
    CHECK(spring_scene_check_colliders(s, both, 2, &found, &index) == status, field);
    CHECK(field != NULL ? found != NULL && strcmp(found, field) == 0 && index == 1 : found == NULL && index == 0,
          field);
    CHECK(spring_scene_set_colliders(s, both, 2) == status, "as it was checked");
}

static const spring_collider good_box = {
    .shape = SPRING_BOX, .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .half = {1, 1, 1}};

#define FIELD(name) offsetof(spring_collider, name), sizeof((spring_collider *)NULL)->name / sizeof(double), #name

/* Each number of each shape with each bad value, in turn. */
static void bad_colliders(void)
{
    enum { plane = 1, sphere = 2, capsule = 4, box = 8, all = 15 };
    static const struct {
        size_t offset, numbers;
        const char *name;
        unsigned shapes; /* that have it */
        bool signed_number;
    } fields[] = {
        {FIELD(at), all, true},
        {FIELD(to), capsule, true},
        {FIELD(axis[0]), plane | box, true},
        {FIELD(axis[1]), box, true},
        {FIELD(axis[2]), box, true},
        {FIELD(half), box, false},
        {FIELD(radius), sphere | capsule | box, false},
        {FIELD(velocity), all, true},
        {FIELD(velocity_to), capsule, true},
        {FIELD(spin), all, true},
        {FIELD(friction), all, false},
        {FIELD(restitution), all, false},
        {FIELD(acceleration), all, true},
        {FIELD(spin_acceleration), all, true},
        {FIELD(surface), all, true},
    };
    const double bad[] = {NAN, INFINITY, -INFINITY, 1e308 * (sizeof(scalar) == 4 ? 1 : 10), -1e-9};
    const double x[] = {0, 5, 0, 1, 5, 0};
    spring_scene_def def = {
        .particles = 2, .position = x, .colliders = 2, .methods = 1u << SPRING_EULER | 1u << SPRING_LEAPFROG};
    spring_scene *s = scene_of(&def);
    for (int shape = 0; shape < shape_count; shape++)
        for (size_t f = 0; f < sizeof fields / sizeof fields[0]; f++)
            for (size_t i = 0; i < fields[f].numbers; i++)
                for (int k = 0; k < (fields[f].signed_number ? 4 : 5); k++) {
                    spring_collider c = good_box;
                    c.shape = (spring_shape)shape;
                    c.to[0] = c.radius = 1;
                    memcpy((char *)&c + fields[f].offset + i * sizeof(double), &bad[k], sizeof(double));
                    const bool is_axis = strncmp(fields[f].name, "axis", 4) == 0, has = fields[f].shapes >> shape & 1;
                    if (has || !is_axis || shape == SPRING_SPHERE || shape == SPRING_CAPSULE)
                        check_field(s, c, !has ? NULL : is_axis ? "axis" : fields[f].name);
                }
    spring_collider c = good_box;
    c.restitution = 1.001;
    check_field(s, c, "restitution");
    c = good_box, c.axis[1][0] = 1.01e-3;
    check_field(s, c, "axis");
    c = good_box, c.axis[1][0] = 0.99e-3;
    check_field(s, c, NULL);
    c = (spring_collider){.shape = SPRING_PLANE, .axis = {{0, 1.01, 0}}};
    check_field(s, c, "axis");
    c = ground, c.shape = (spring_shape)(SPRING_CUSTOM + 1);
    check_field(s, c, "shape");
    c = (spring_collider){
        .shape = SPRING_PLANE, .axis = {{0.6, 0.8, 0}}, .at = {(double)SCALAR_MAX, (double)SCALAR_MAX, 0}};
    check_field(s, c, "at"); /* its distance from the origin is infinite */
    CHECK(spring_scene_set_colliders(s, (spring_collider[3]){good_box, good_box, good_box}, 3) == SPRING_ERANGE,
          "room for two");
    CHECK(spring_scene_advance(s, SPRING_EULER, 0.01, 1) == SPRING_EUNSUPPORTED, "Euler has no drift");
    CHECK(spring_scene_set_colliders(s, NULL, 0) == SPRING_OK &&
              spring_scene_advance(s, SPRING_EULER, 0.01, 1) == SPRING_OK,
          "no colliders");
    free(s);
}

/* A rotation by a random angle about axis k, in single precision, applied to the axes of a collider. */
static void rotate_in_float(spring_collider *c, int k)
{
    const float angle = (float)random_uniform(-3, 3), cosine = cosf(angle), sine = sinf(angle);
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    for (int i = 0; i < 3; i++) {
        const float x = (float)c->axis[i][p], y = (float)c->axis[i][q];
        c->axis[i][p] = (double)(cosine * x - sine * y);
        c->axis[i][q] = (double)(sine * x + cosine * y);
    }
}

/* Axes that are products of many float matrices are accepted, and stored as the nearest orthonormal axes. */
static void axes_from_floats(void)
{
    const double x[] = {0, 5, 0};
    const spring_scene_def def = {.particles = 1, .position = x, .colliders = 1};
    spring_scene *s = scene_of(&def);
    const spring_collider *set = scene_read(s, ARRAY_COLLIDERS);
    double largest = 0;
    for (int number = 0; number < 2000; number++) {
        spring_collider c = good_box;
        for (int i = 0; i < 1 + number % 64; i++)
            rotate_in_float(&c, (int)(random_bits() % 3));
        const double slip = random_uniform(-4e-4, 4e-4); /* and now and then a model that was scaled or sheared */
        c.axis[0][0] += number % 5 == 0 ? slip : 0;
        CHECK(spring_scene_set_colliders(s, &c, 1) == SPRING_OK, "nearly orthonormal");
        for (int i = 0; i < 3; i++) {
            double change = 0;
            for (int j = 0; j < 3; j++) {
                double dot = 0;
                for (int a = 0; a < 3; a++)
                    dot += set->axis[i][a] * set->axis[j][a];
                CHECK_CLOSE(dot, i == j, 4 * DBL_EPSILON, "orthonormal to rounding");
                change = fmax(change, fabs(set->axis[i][j] - c.axis[i][j]));
            }
            CHECK_BELOW(change, number % 5 == 0 ? 5e-4 : 1e-5, "near the given axes");
            largest = fmax(largest, change);
        }
        const spring_collider once = *set;
        CHECK(spring_scene_set_colliders(s, &once, 1) == SPRING_OK &&
                  memcmp(once.axis, set->axis, sizeof once.axis) == 0,
              "orthonormal axes keep their bits");
    }
    CHECK(largest > 1e-6, "some axes would have been wrong");
    free(s);
}

/* ---------------------------------------------------------------------------------------------------- touching and rest */

/* Particles on a floor, one of them pinned below it. */
static spring_scene *on_floor(double friction)
{
    const double x[] = {0, 0.3, 0, 1, 0.3, 0, 2, -0.3, 0};
    const uint8_t pinned[] = {0, 0, 1};
    spring_scene_def def = falling(3, x, NULL, 1);
    def.flags = SPRING_SCENE_EDITABLE, def.pinned = pinned, def.gravity[1] = -10, def.colliders = 2;
    spring_collider c[] = {ground, ground};
    c[0].at[1] = -5, c[1].friction = friction;
    spring_scene *s = scene_with(&def, c);
    run(s, SPRING_LEAPFROG, 0.01, 200);
    return s;
}

static bool touches(const spring_scene *s, uint32_t first, uint32_t second, uint32_t third)
{
    uint32_t mask[3];
    CHECK(spring_scene_touching(s, mask, 0, 3) == SPRING_OK, "room");
    return mask[0] == first && mask[1] == second && mask[2] == third;
}

/* The colliders after `steps` steps of h, which have the colliders c at first. */
static void collider_after(const spring_collider *c, uint32_t axes, double h, uint64_t steps, spring_collider *out)
{
    const double far[3] = {1e3, 1e3, 1e3};
    const spring_scene_def def = {.axes = axes, .particles = 1, .position = far, .colliders = 1};
    spring_scene *s = scene_of(&def);
    uint32_t count = 1;
    set(s, c, 1);
    run(s, SPRING_LEAPFROG, h, steps);
    CHECK(spring_scene_get_colliders(s, out, &count) == SPRING_OK && count == 1, "valid");
    free(s);
}

/* Colliders at the present time: paths by their closed forms, axes that turn with the spin, and the same motion if they
   are set again. */
static void present_colliders(void)
{
    enum { runs = 500, steps = 16 };
    for (int number = 0; number < runs; number++) {
        const uint32_t axes = 2 + (uint32_t)(random_bits() % 2);
        const double h = 0x1p-10, t = steps * h; /* [s] */
        spring_collider c = random_collider(axes), now, before, after, again, later;
        const double growth = random_uniform(-1, 1); /* of the spin, in its direction */
        for (uint32_t a = 0; a < 3; a++) {
            c.acceleration[a] = a < axes ? random_uniform(-3, 3) : 0;
            c.spin[a] = a < axes || axes == 2 ? c.spin[a] + (axes == 2 && a == 2 ? 2 : 0) : 0;
            c.spin_acceleration[a] = growth * c.spin[a];
            c.surface[a] = a < axes ? random_uniform(-1, 1) : 0;
        }
        collider_after(&c, axes, h, steps, &now);
        collider_after(&c, axes, h, steps - 1, &before);
        collider_after(&c, axes, h, steps + 1, &after);
        collider_after(&now, axes, h, 2 * steps, &again);
        collider_after(&c, axes, h, 3 * steps, &later);
        const double rounding = 64 * DBL_EPSILON; /* of numbers below 4 */
        for (uint32_t a = 0; a < axes; a++) {
            CHECK_CLOSE(now.at[a], c.at[a] + t * c.velocity[a] + t * t / 2 * c.acceleration[a], rounding, "the path");
            CHECK_CLOSE(now.velocity[a], c.velocity[a] + t * c.acceleration[a], rounding, "its velocity");
            CHECK_CLOSE(again.at[a], later.at[a], rounding, "the path goes on");
            if (c.shape != SPRING_CAPSULE)
                continue;
            CHECK_CLOSE(now.to[a], c.to[a] + t * c.velocity_to[a] + t * t / 2 * c.acceleration[a], rounding, "to");
            CHECK_CLOSE(again.to[a], later.to[a], rounding, "it goes on");
        }
        const int count = c.shape == SPRING_PLANE ? 1 : c.shape == SPRING_BOX ? (int)axes : 0;
        for (int i = 0; i < count; i++) {
            double rate[3];
            cross(now.spin, now.axis[i], rate);
            for (uint32_t a = 0; a < axes; a++) {
                const double slope = (after.axis[i][a] - before.axis[i][a]) / (2 * h);
                CHECK_CLOSE(slope, rate[a], 1e-4, "spin x axis, with the error h^2/6 |spin|^3 of the slope");
                CHECK_CLOSE(again.axis[i][a], later.axis[i][a], rounding, "the rotation goes on");
            }
        }
        double surface_rate[3] = {0};
        if (c.shape == SPRING_PLANE)
            cross(now.spin, now.surface, surface_rate);
        for (int a = 0; a < 3; a++) {
            const double slope = (after.surface[a] - before.surface[a]) / (2 * h);
            CHECK_CLOSE(slope, surface_rate[a], 1.8e-4,
                        "the surface of a plane turns; sqrt(3) times the error of an axis");
            CHECK_CLOSE(again.surface[a], later.surface[a], rounding, "the surface goes on");
            CHECK_CLOSE(again.spin[a], later.spin[a], rounding, "the spin goes on");
        }
    }
    const double far[3] = {1e3, 1e3, 1e3};
    const spring_scene_def def = {.particles = 1, .position = far, .colliders = 3};
    spring_scene *s = scene_of(&def);
    spring_collider c[2] = {random_collider(3), random_collider(3)}, out[2] = {{.radius = 7}};
    uint32_t count = 5;
    CHECK(spring_scene_get_colliders(s, out, &count) == SPRING_OK && count == 0 && out[0].radius == 7, "none");
    set(s, c, 2);
    CHECK(spring_scene_get_colliders(s, NULL, &count) == SPRING_OK && count == 2, "their number");
    count = 1;
    CHECK(spring_scene_get_colliders(s, out, &count) == SPRING_ENOMEM && count == 2 && out[0].radius == 7, "no room");
    CHECK(spring_scene_get_colliders(s, out, NULL) == SPRING_EINVAL &&
              spring_scene_get_colliders(NULL, out, &count) == SPRING_EINVAL,
          "NULL");
    CHECK(spring_scene_get_colliders(s, out, &count) == SPRING_OK && count == 2 && out[1].radius == c[1].radius,
          "both");
    free(s);
}

static void touching_is_cleared(void)
{
    const double x[] = {0, 1, 0}, identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const spring_collider far = {.shape = SPRING_SPHERE, .at = {99, 0, 0}, .radius = 1};
    spring_scene *s = on_floor(0);
    CHECK(touches(s, 2, 2, 0), "the second collider; a pinned particle touches none");
    spring_scene_set(s, SPRING_VELOCITY, x, 0, 0, 1);
    CHECK(touches(s, 2, 2, 0), "its position is the same");
    spring_scene_set(s, SPRING_POSITION, x, 0, 0, 1);
    CHECK(touches(s, 0, 2, 0), "for the particle whose position was set");
    spring_scene_set_pinned(s, 1, 1, &(uint8_t){0});
    CHECK(touches(s, 0, 2, 0), "no change");
    spring_scene_set_pinned(s, 1, 1, &(uint8_t){1});
    CHECK(touches(s, 0, 0, 0), "a pin");
    free(s);
    s = on_floor(0);
    spring_scene_transform(s, identity);
    CHECK(touches(s, 0, 0, 0), "a transform");
    free(s);
    s = on_floor(0);
    spring_scene_set_colliders(s, &far, 1);
    CHECK(touches(s, 0, 0, 0), "other colliders");
    spring_scene_advance(s, SPRING_LEAPFROG, 0.01, 1);
    CHECK(touches(s, 0, 0, 0), "the floor is gone");
    free(s);
    s = on_floor(0);
    spring_scene_advance(s, SPRING_LEAPFROG, 0.01, 1); /* both buffers have bits */
    spring_scene_set_colliders(s, NULL, 0);
    for (int i = 0; i < 3; i++) {
        CHECK(touches(s, 0, 0, 0), "no colliders");
        spring_scene_advance(s, SPRING_LEAPFROG, 0.01, 1);
    }
    free(s);
}

static void rests(void)
{
    spring_scene *s = on_floor(0);
    CHECK(spring_scene_at_rest(s, 1e-9, 1e-9), "the floor balances gravity");
    const double pull[] = {4, 0, 0};
    spring_scene_set_gravity(s, pull);
    CHECK(!spring_scene_at_rest(s, 1e-9, 1e-9), "pulled sideways");
    free(s);
    s = on_floor(0.5);
    const double held[] = {4.9, -10, 0}, slips[] = {5.1, -10, 0}, up[] = {0, 1, 0};
    spring_scene_set_gravity(s, held);
    CHECK(spring_scene_at_rest(s, 1e-9, 1e-9), "static friction balances up to mu times the normal force");
    spring_scene_set_gravity(s, slips);
    CHECK(!spring_scene_at_rest(s, 1e-9, 0.09) && spring_scene_at_rest(s, 1e-9, 0.11), "0.1 m/s^2 are left");
    spring_scene_set_gravity(s, up);
    CHECK(!spring_scene_at_rest(s, 1e-9, 0.9), "a floor does not pull");
    free(s);
}

/* In a groove each plane presses the particle against the other. */
static void rests_in_a_groove(void)
{
    static const double slope[] = {15, 30, 45, 60, 75}; /* degrees */
    for (int k = 0; k < 5; k++) {
        const double x[] = {0.1, 1, 0}, angle = slope[k] / 180 * PI, c0 = cos(angle), s0 = sin(angle);
        const spring_scene_def def = {.particles = 1, .position = x, .gravity = {0, -10, 0}, .drag = 1, .colliders = 2};
        const spring_collider c[] = {{.shape = SPRING_PLANE, .axis = {{s0, c0, 0}}},
                                     {.shape = SPRING_PLANE, .axis = {{-s0, c0, 0}}}};
        spring_scene *s = scene_with(&def, c);
        run(s, SPRING_LEAPFROG, 0.01, 4000);
        CHECK(spring_scene_at_rest(s, 1e-3, 1e-3), "both planes balance it");
        free(s);
    }
}

/* A wall keeps the time since it was set: steps of other lengths, other times and a saved state change nothing in its
   motion. It is set long after the start, and its place does not have the rounding errors of times. */
static void time_of_a_wall(void)
{
    static const double x[] = {1.5, 0, 0};
    spring_scene_def def = {.particles = 1, .position = x, .colliders = 1};
    use_all_methods(&def);
    const spring_collider c = {
        .shape = SPRING_PLANE, .at = {1, 0, 0}, .axis = {{1, 0, 0}}, .velocity = {1, 0, 0}, .friction = 1};
    for (int m = 0; m < method_count; m++) {
        const spring_method method = contact_methods[m];
        spring_scene *s = scene_of(&def), *other = scene_of(&def);
        CHECK(spring_scene_set_time(s, 1e6) == SPRING_OK && spring_scene_set_colliders(s, &c, 1) == SPRING_OK, "valid");
        double dt = 1.0 / 64, elapsed = 0;
        for (int call = 0; call < 20; call++, dt *= 0.9) {
            uint8_t saved[1024];
            size_t bytes = sizeof saved;
            if (call % 5 == 4)
                CHECK(spring_scene_set_time(s, -3e5 * call) == SPRING_OK, "finite");
            CHECK(spring_scene_advance(s, method, dt, 7) == SPRING_OK &&
                      spring_scene_save(s, saved, &bytes) == SPRING_OK &&
                      spring_scene_load(other, saved, bytes) == SPRING_OK,
                  "finite");
            elapsed += 7 * dt;
            spring_scene *const before = s;
            s = other;
            other = before;
            double at[3];
            spring_scene_get(s, SPRING_POSITION, at, 0, 0, 1);
            CHECK_CLOSE(at[0], fmax(1.5, 1 + elapsed), 50 * EPS * (1 + elapsed),
                        "pushed by the wall; a rounding per step and call");
        }
        free(s);
        free(other);
    }
}

/* A particle that a collider was set around comes out at its surface, and gains no velocity, neither at rest nor when it
   moves inwards. Pinned particles stay. */
static void inside_at_first(void)
{
    for (int shape = 0; shape < shape_count; shape++)
        for (int m = 0; m < method_count; m++) {
            const double x[] = {0.1, 0.2, 0.05, 0.2, 0.3, 0.1};
            const uint8_t pinned[] = {0, 1};
            spring_scene_def def = falling(2, x, NULL, 1);
            def.pinned = pinned, def.gravity[1] = 0;
            spring_collider c = good_box;
            c.shape = (spring_shape)shape;
            c.radius = c.to[2] = 1;
            spring_scene *s = scene_with(&def, &c);
            run(s, contact_methods[m], 0.01, 1);
            double now[6], v[3];
            spring_scene_get(s, SPRING_POSITION, now, 0, 0, 2);
            spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
            CHECK_BELOW(length(v), 1e3 * EPS, "position only");
            if (shape == SPRING_SPHERE)
                CHECK_CLOSE(length(now), 1, 10 * EPS, "at the surface");
            if (shape == SPRING_BOX)
                CHECK_CLOSE(now[1], 2, 10 * EPS, "through the nearest face");
            const double inwards[] = {-0.1, -0.2, -0.05};
            spring_scene_set(s, SPRING_POSITION, x, 0, 0, 1);
            spring_scene_set(s, SPRING_VELOCITY, inwards, 0, 0, 1);
            run(s, contact_methods[m], 0.01, 1);
            spring_scene_get(s, SPRING_VELOCITY, v, 0, 0, 1);
            CHECK_BELOW(length(v), 0.25, "at most the speed that it had");
            CHECK(now[3] == (double)(scalar)x[3] && now[4] == (double)(scalar)x[4], "a pinned particle passes through");
            free(s);
        }
}

/* A heavy damper presses a particle into the floor. Restitution does not throw it back: it is no impact. */
static void pressed_by_damping(void)
{
    const double x[] = {0, 0, 0, 0, 1, 0}, v[] = {0, 0, 0, 0, -1, 0};
    const spring_link link = {0, 1, 1, 10, 1000, 0};
    spring_scene_def def = falling(2, x, v, 1);
    def.links = 1, def.link = &link;
    spring_collider c = ground;
    c.restitution = 0.9;
    double now[3], speed[3];
    end_of(scene_with(&def, &c), SPRING_LEAPFROG, 0.01, 1, now, speed);
    CHECK_CLOSE(now[1], 0, 10 * EPS, "stays on the floor");
    CHECK_BELOW(fabs(speed[1]), 10 * EPS, "at rest");
}

static const test tests[] = {
    {"neighbours in a SIMD vector", neighbours_change_nothing},
    {"other particles", others_change_nothing},
    {"units and mirrors", units_and_mirrors},
    {"speed limit", speed_limit},
    {"bad colliders", bad_colliders},
    {"axes from floats", axes_from_floats},
    {"present colliders", present_colliders},
    {"touching is cleared", touching_is_cleared},
    {"rests", rests},
    {"rests in a groove", rests_in_a_groove},
    {"time of a wall", time_of_a_wall},
    {"inside at first", inside_at_first},
    {"pressed by damping", pressed_by_damping},
};

int main(void)
{
    return RUN_TESTS("colliders", tests);
}
