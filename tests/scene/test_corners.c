/* SPDX-License-Identifier: MIT */
/* Particles on several colliders: grooves, crevices, floors of boxes, rooms, thin walls and plates, and edges. */
#include "test_contact.h"

#include <stdio.h>

/* Two planes that enclose an angle of 2 half. */
static void make_groove(double half, double friction, spring_collider c[2])
{
    for (int k = 0; k < 2; k++)
        c[k] = (spring_collider){
            .shape = SPRING_PLANE, .axis = {{k ? -cos(half) : cos(half), sin(half), 0}}, .friction = friction};
}

/* Two planes that enclose an angle of 0.5 to 60 degrees: a particle that falls between them comes to rest, outside of both.
   If they close in on a particle, they push it out. */
static void grooves(void)
{
    static const double degrees[] = {60, 20, 4, 2, 0.5};
    enum { closing = 2 }; /* others: friction or none */
    for (int i = 0; i < 5; i++)
        for (int how = 0; how <= closing; how++)
            for (int m = 0; m < second_order; m++) {
                const double half = degrees[i] * PI / 360;
                const double x[3] = {how == closing ? 0 : 0.3 * sin(half), 1, 0};
                const double toward = how == closing ? 0.02 * sin(half) : 0; /* [m/s] the corner rises by 0.02 m/s */
                double inside = 0, now[3], v[3];
                spring_collider c[2];
                make_groove(half, how == 1 ? 0.3 : 0, c);
                for (int k = 0; k < 2; k++)
                    for (int a = 0; a < 3; a++)
                        c[k].velocity[a] = toward * c[k].axis[0][a];
                spring_scene *s = particle_on(c, 2, x, none, down);
                for (int k = 1; k <= 480 * 6; k++) {
                    run(s, contact_methods[m], 1. / 480, 1);
                    get(s, now, v);
                    for (int j = 0; j < 2; j++)
                        inside = fmax(inside, k / 480. * toward - dot(now, c[j].axis[0]));
                }
                CHECK_BELOW(inside, in_double ? 1e-14 : 1e-6, "inside");
                CHECK_BELOW(length(v), how == closing ? 0.02 + gravity / 480 : in_double ? 1e-12 : 1e-4, "at rest");
                CHECK(how == closing || spring_scene_at_rest(s, 1e-3, 1e-3), "at rest");
                free(s);
            }
}

/* Two planes that enclose 90 to 165 degrees, without friction: after a minute, a particle is at most as fast as scene.h
   says. */
static void wide_grooves(void)
{
    double fastest = 0; /* in units of g dt */
    for (int i = 0; i < 60; i++) {
        const double half = random_uniform(90, 165) * PI / 360, dt = random_log(1. / 960, 1. / 60);
        const double x[3] = {random_uniform(-0.4, 0.4), 0.5, 0};
        spring_collider c[2];
        make_groove(half, 0, c);
        spring_scene *s = particle_on(c, 2, x, none, down);
        run(s, SPRING_LEAPFROG, dt, (uint64_t)(60 / dt));
        for (int k = 0; k < 200; k++) {
            double now[3], v[3];
            run(s, SPRING_LEAPFROG, dt, 1);
            get(s, now, v);
            fastest = fmax(fastest, length(v) / (gravity * dt));
        }
        free(s);
    }
    CHECK_BELOW(fastest, 2, "speed in a wide groove, in units of g dt: spring_scene_set_colliders()");
}

/* A particle starts inside several bodies that overlap, as a cape at the joints of a figure. It is moved out of all of them,
   to the surface of their union if there are two. */
static void inside_several(void)
{
    const size_t cases = random_cases(4000);
    double inside = 0, outside[2] = {0}; /* of two and of more bodies */
    size_t tried = 0;
    for (size_t i = 0; i < cases; i++) {
        spring_collider c[4];
        const uint32_t count = 2 + (uint32_t)(random_bits() % 3);
        for (uint32_t k = 0; k < count; k++) {
            const spring_collider body = random_collider(3);
            c[k] = (spring_collider){.shape = body.shape, .radius = body.radius, .friction = body.friction};
            if (body.shape == SPRING_CUSTOM || (body.shape == SPRING_PLANE && k > 0)) /* two planes may meet far away */
                c[k].shape = SPRING_CAPSULE;
            memcpy(c[k].at, body.at, sizeof body.at);
            memcpy(c[k].to, body.to, sizeof body.to);
            memcpy(c[k].axis, body.axis, sizeof body.axis);
            memcpy(c[k].half, body.half, sizeof body.half);
            if (k > 0 && random_bits() % 4 == 0)
                c[k] = c[0];
        }
        double x[3], now[3], v[3], deep[2] = {0}, least = INFINITY;
        for (int a = 0; a < 3; a++)
            x[a] = random_uniform(-0.5, 0.5);
        for (uint32_t k = 0; k < count; k++) {
            const double depth = -gap_of(&c[k], 0, x, 3);
            deep[1] = fmax(deep[1], fmin(depth, deep[0]));
            deep[0] = fmax(deep[0], depth);
        }
        if (!(deep[1] > 0))
            continue;
        tried++;
        end_of(particle_on(c, count, x, none, none), contact_methods[i % 2], frame, 1, now, v);
        for (uint32_t k = 0; k < count; k++)
            least = fmin(least, gap_of(&c[k], 0, now, 3));
        inside = fmax(inside, -least);
        outside[count > 2] = fmax(outside[count > 2], least / deep[0]);
    }
    CHECK(tried > cases / 8, "particles inside two bodies");
    CHECK_BELOW(inside, 8 * 5 * EPS, "inside a body: 8 eps (|x| + |at| + size)");
    CHECK_BELOW(outside[0], 0.01, "distance from both bodies, in units of the depth before");
    CHECK_BELOW(outside[1], 1, "distance from all bodies: passes of item 5 move it by up to the depth");
}

/* A ball comes down on a particle on the floor and stops where the particle does not fit between them. In no step is the
   particle moved farther than by a third beyond the nearest place where it fits. */
static void between_closing_bodies(void)
{
    static const double offsets[] = {0, 1e-6, 1e-4, 2e-3, 0.03};
    const double radius = 0.25, r = 0.01, end_gap = 0.005;
    const double fits = sqrt(pow(radius + r, 2) - pow(radius + end_gap - r, 2)); /* [m] from the axis */
    double farthest = 0;
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 6; k++) {
            const double speed = (const double[]){0.5, 2, 5}[k / 2], dt = k % 2 ? 1. / 960 : 1. / 240;
            const double x[3] = {offsets[i], r, 0};
            spring_collider c[2] = {ground, {.shape = SPRING_SPHERE, .radius = radius, .friction = 0.3}};
            c[0].friction = 0.5, c[1].at[1] = radius + end_gap + 0.05, c[1].velocity[1] = -speed;
            spring_scene *s = ball_on(c, 2, x, none, down, r);
            double before[3], now[3], v[3];
            for (int n = 0; n < (int)(0.05 / speed / dt); n++) {
                get(s, before, v);
                run(s, SPRING_LEAPFROG, dt, 1);
                get(s, now, v);
                if (hypot(before[0], before[2]) < fits)
                    farthest = fmax(farthest, hypot(now[0], now[2]) - length(v) * dt);
            }
            free(s);
        }
    CHECK_BELOW(farthest / fits, 4. / 3, "distance from the axis after a step, in units of that of the nearest place");
}

/* A particle that a force presses into the crevice between two round bodies slides along it: its velocity is that of its
   motion. */
static void crevice_of_round_bodies(void)
{
    const double dt = 1e-3;
    double worst = 0;
    const size_t cases = random_cases(1000);
    for (size_t i = 0; i < cases; i++) {
        const double friction = random_bits() % 3 ? 0 : random_uniform(0.1, 1), speed = random_uniform(-0.3, 0.3),
                     radius[2] = {0.2, random_uniform(0.05, 0.3)},
                     between = radius[0] + radius[1] - random_uniform(0.001, 0.05);
        const double along = (between + (pow(radius[0], 2) - pow(radius[1], 2)) / between) / 2;
        const double x[3] = {along, 0, sqrt(pow(radius[0], 2) - along * along)};
        const double pull = random_log(1, 1e5);
        const double g[3] = {pull * random_uniform(-0.3, 0.3), pull * random_uniform(-0.5, 0.5), -pull};
        spring_collider c[2] = {
            {.radius = radius[0], .friction = friction},
            {.radius = radius[1], .friction = friction, .at = {between, 0, 0}, .velocity = {speed, 0, 0}}};
        c[0].shape = c[1].shape = SPRING_SPHERE;
        if (random_bits() % 2) {
            c[0].shape = SPRING_CAPSULE;
            c[0].at[1] = -1;
            c[0].to[1] = 1;
        }
        spring_scene *s = particle_on(c, 2, x, none, g);
        double before[3], now[3], v[3];
        for (int n = 0; n < 60; n++) {
            get(s, before, v);
            run(s, contact_methods[i % 2], dt, 1);
            get(s, now, v);
            if (n > 4)
                worst =
                    fmax(worst, length(v) / (distance(now, before) / dt + length(g) * dt + fabs(speed) + 8 * EPS / dt));
        }
        free(s);
    }
    CHECK_BELOW(worst, 1, "velocity, in units of that of the motion, of the change in a step, and of the body");
}

/* A taut rope with links of length 0.1 that slides to and fro around a sharp edge of 90 degrees at the origin. The depth to
   which links enter the body [m], with particles of radius r. */
static double cut_of_links(double r)
{
    enum { n = 12 };
    const double spacing = 0.1, half = (n - 1) * spacing / 2, stretch = 1e-3;
    double x[n][2], deepest = 0;
    uint8_t pinned[n] = {[0] = 1, [n - 1] = 1};
    spring_link link[n - 1];
    for (uint32_t i = 0; i < n; i++) {
        const double along = (i * spacing - half) / sqrt(2);
        x[i][0] = 0.5 + along, x[i][1] = 0.5 - along;
        if (i > 0)
            link[i - 1] = (spring_link){i - 1, i, spacing, 1000, 0.5, 0};
    }
    spring_scene_def def = falling(n, x[0], NULL, 0.01);
    def.axes = 2, def.pinned = pinned, def.links = n - 1, def.link = link;
    def.gravity[1] = 0, def.drag = 0.05, def.particle_radius = (scalar)r, def.methods = 1u << SPRING_LEAPFROG;
    spring_collider box = {.shape = SPRING_BOX, .at = {-1, -1}, .half = {1, 1, 1}, .axis = {{1}, {0, 1}, {0, 0, 1}}};
    spring_scene *s = scene_with(&def, &box);
    const double leg = half * (1 + stretch) - r; /* from the edge to a pin, if a link is parallel to each face */
    for (int i = 0; i < 120; i++) {
        const double slide = i < 30 ? 0 : spacing * sin(0.1 * (i - 30));
        const double first[] = {-leg - slide, r + 1e-3}, last[] = {r + 1e-3, -leg + slide};
        CHECK(spring_scene_drive(s, 0, first, i < 10 ? 0.5 : 0.05) == SPRING_OK &&
                  spring_scene_drive(s, n - 1, last, i < 10 ? 0.5 : 0.05) == SPRING_OK,
              "pins");
        run(s, SPRING_LEAPFROG, 5e-4, 100);
        spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, n);
        for (int k = 1; k < n && i >= 30; k++)
            for (double f = 0; f <= 1; f += 0.01) {
                const double px = x[k - 1][0] + f * (x[k][0] - x[k - 1][0]),
                             py = x[k - 1][1] + f * (x[k][1] - x[k - 1][1]);
                deepest = fmax(deepest, fmin(-px, -py));
            }
    }
    free(s);
    return deepest;
}

static void links_at_an_edge(void)
{
    /* Ends at (-a, r) and (r, -a): s = sqrt(2) (a + r), and the middle is inside if r < a, that is, r < s/sqrt(8). */
    const double spacing = 0.1, depth = cut_of_links(0.25 * spacing);
    CHECK(cut_of_links(0.36 * spacing) == 0, "links stay outside if r >= s/sqrt(8) = 0.354 s, with the stretch of 1 %");
    printf("# particles of radius 0.25 s: links enter a sharp edge by %.3f s\n", depth / spacing);
    CHECK(depth > 0.01 * spacing, "smaller particles let them in");
}

enum { TILES = 5 };

/* A floor of boxes. It moves and has a random direction, unless it is still. *plane: the same floor as a plane. */
static void tiled_floor(spring_collider *box, spring_collider *plane, bool still, double size, double overlap,
                        const double off[2])
{
    double axis[3][3];
    turned_axes((double[3]){0}, axis);
    *plane = (spring_collider){.shape = SPRING_PLANE, .friction = random_bits() % 2 ? random_uniform(0, 0.6) : 0};
    if (!still)
        random_axes(axis);
    memcpy(plane->axis[0], axis[1], sizeof axis[1]);
    for (int a = 0; a < 3 && !still; a++)
        plane->velocity[a] = random_uniform(-2, 2);
    for (int i = 0; i < TILES * TILES; i++, box++) {
        const double to[] = {(i % TILES - 2) * size + off[0], -0.25, (i / TILES - 2) * size + off[1]};
        *box = *plane;
        box->shape = SPRING_BOX;
        memcpy(box->axis, axis, sizeof box->axis);
        for (int a = 0; a < 3; a++) {
            box->at[a] = to[0] * axis[0][a] + to[1] * axis[1][a] + to[2] * axis[2][a];
            box->half[a] = a == 1 ? 0.25 : size / 2 + overlap;
        }
    }
}

/* A particle falls onto a floor of boxes and slides over it, as on a plane, wherever it starts: also within the skin of a
   seam, or where four boxes meet. If it bounces, it does so along the normal. Tops whose heights differ by rounding errors
   of single precision are one floor, also in double. */
static void floor_of_boxes(void)
{
    enum { over_a_seam = 3, from_a_corner, onto_a_seam, starts }; /* otherwise anywhere */
    int misses[2] = {0};
    for (int k = 0; k < 3000; k++) {
        spring_collider box[TILES * TILES], plane;
        const int start = k % starts;
        const bool drops = start == onto_a_seam, anywhere = start < over_a_seam;
        const double size = random_uniform(0.3, 2), overlap = anywhere && k % 2 ? random_log(1e-3, 50) : 0,
                     dt = frame / (start == over_a_seam ? 8 : 1 << random_bits() % 3), seam = size / 2;
        const double off[] = {anywhere ? random_uniform(-0.5, 0.5) * size : seam,
                              start == from_a_corner ? seam : random_uniform(-0.5, 0.5) * size};
        const double radius = random_bits() % 2 && (anywhere || drops) ? random_uniform(0.002, 0.05) : 0;
        const double height = radius + (drops ? random_uniform(0.5, 2) : anywhere && k % 5 == 0 ? 0.2 : 0);
        const bool straight = start == over_a_seam || (start == from_a_corner && k % 4 < 2);
        const double angle = straight ? k % 4 / 2 * PI : random_uniform(0, 2 * PI),
                     speed = drops ? 0 : random_log(0.2, 15), skin = 32 * EPS * 2 * (size + 0.25),
                     before = start == over_a_seam ? 5 * dt * speed + skin * random_uniform(-2, 2) : 0;
        const bool rounded = anywhere && random_bits() % 2;
        const double far = drops ? random_log(0.1, 30) : 0; /* [m] from the origin, along each axis */
        const spring_method method = contact_methods[start == over_a_seam ? 0 : random_bits() % second_order];
        double x[3], v[3], g[3], end[2][3], u[2][3], apart[2][3];
        tiled_floor(box, &plane, start == from_a_corner || random_bits() % (start == over_a_seam ? 2 : 4) == 0, size,
                    overlap, off);
        const double *const up = box[0].axis[1];
        plane.restitution = drops ? k / starts % 3 / 2. : 0;
        for (int a = 0; a < 3; a++) {
            const double along = cos(angle) * box[0].axis[0][a] + sin(angle) * box[0].axis[2][a];
            x[a] = far + height * up[a] - before * along;
            plane.at[a] = far;
            v[a] = plane.velocity[a] + speed * along;
            g[a] = -gravity * up[a];
        }
        for (int i = 0; i < TILES * TILES; i++) {
            box[i].restitution = plane.restitution;
            for (int a = 0; a < 3; a++)
                box[i].at[a] = rounded ? (float)box[i].at[a] : far + box[i].at[a];
        }
        const uint64_t steps = (uint64_t)(fmin(1, 1.8 * size / fmax(speed, 1)) / dt);
        for (int whole = 0; whole < 2; whole++)
            end_of(ball_on(whole ? &plane : box, whole ? 1 : TILES * TILES, x, v, g, radius), method, dt, steps,
                   end[whole], u[whole]);
        for (int a = 0; a < 3; a++)
            apart[0][a] = end[0][a] - end[1][a], apart[1][a] = dt * (u[0][a] - u[1][a]);
        for (int i = 0; i < 2; i++) {
            const double normal = dot(apart[i], up);
            for (int a = 0; a < 3 && plane.restitution > 0; a++)
                apart[i][a] -= normal * up[a];
        }
        /* For a particle with the radius r, a step of the height d = 5e-7 m is a slope of sqrt(2 d/r). The skin of the
           boxes, whose sizes and coordinates add up to at most 130 m, is 32 EPS of that. */
        misses[start == over_a_seam] +=
            !(fmax(length(apart[0]), length(apart[1])) <= (1 + far) * (rounded || !in_double ? 1e-3 : 1e-12));
    }
    CHECK(misses[0] <= 1, "as on a plane, unless a step starts at an edge, to rounding errors");
    CHECK(misses[1] <= 4, "as on a plane, for 99 of 100 that start a step within two skins of a seam");
}

enum { ROOM_TILES = 3, ROOM_BODIES = ROOM_TILES * ROOM_TILES + 4, ROOM_PARTICLES = 8 };

/* A room with a floor of boxes, which walls touch. */
typedef struct room {
    double size, half;           /* [m] of a tile, of the room */
    double axis[3][3], at[3], t; /* now; the second axis is up; [m] the centre of the floor; [s] since the start */
    double first[3][3], rate[3], spin[3]; /* the axes at the start; [m/s]; [rad/s] */
    double place[ROOM_BODIES][3];         /* [m] of the bodies, in the room */
    spring_collider body[ROOM_BODIES];
    bool rounded; /* coordinates of the bodies are those of single precision */
} room;

/* A place, from its coordinates in the room. */
static void place_of(const room *r, const double to[3], double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = r->at[a] + to[0] * r->axis[0][a] + to[1] * r->axis[1][a] + to[2] * r->axis[2][a];
}

/* Moves the room to the time t. */
static void move_room(room *r, double t)
{
    double phi[3];
    for (int a = 0; a < 3; a++) {
        r->at[a] += (t - r->t) * r->rate[a];
        phi[a] = t * r->spin[a];
    }
    r->t = t;
    for (int k = 0; k < 3; k++)
        turn(phi, r->first[k], r->axis[k]);
    for (int i = 0; i < ROOM_BODIES; i++) {
        spring_collider *const c = &r->body[i];
        double arm[3], v[3];
        place_of(r, r->place[i], c->at);
        for (int a = 0; a < 3; a++)
            arm[a] = c->at[a] - r->at[a];
        cross(r->spin, arm, v);
        cross(r->spin, v, c->acceleration);
        for (int a = 0; a < 3; a++) {
            c->velocity[a] = r->rate[a] + v[a];
            c->at[a] = r->rounded ? (float)c->at[a] : c->at[a];
        }
        memcpy(c->spin, r->spin, sizeof c->spin);
        if (c->shape == SPRING_BOX)
            memcpy(c->axis, r->axis, sizeof c->axis);
        for (int a = 0; a < 3 && c->shape == SPRING_PLANE; a++)
            c->axis[0][a] = (i < 2 ? 1 : -1) * r->axis[i % 2 ? 0 : 2][a];
    }
}

/* Walls are boxes beside the floor, boxes that end at the level of the floor, or planes. */
static void random_room(room *r, int k)
{
    const double tilt[3] = {random_uniform(-0.4, 0.4), random_uniform(-3, 3), random_uniform(-0.4, 0.4)};
    const bool turned = k % 4 > 1, moves = k % 8 > 3, spins = moves && k % 3 != 0;
    r->rounded = k % 16 > 7;
    r->size = random_uniform(0.4, 1.2);
    r->half = ROOM_TILES * r->size / 2;
    r->t = 0;
    turned_axes(turned ? tilt : (double[3]){0}, r->first);
    for (int a = 0; a < 3; a++) {
        r->at[a] = random_uniform(-2, 2);
        r->rate[a] = moves ? random_uniform(-2, 2) : 0;
        r->spin[a] = spins ? random_uniform(-0.5, 0.5) : 0;
    }
    for (int i = 0; i < ROOM_BODIES; i++) {
        const int t = i - 4, along = i % 2 ? 0 : 2;
        spring_collider *const c = &r->body[i];
        double *const to = r->place[i];
        *c = (spring_collider){.shape = t < 0 && k % 3 == 0 ? SPRING_PLANE : SPRING_BOX,
                               .half = {r->size / 2, 0.25, r->size / 2},
                               .friction = k % 5 ? random_uniform(0, 0.8) : 0};
        memcpy(to, (double[]){(t % ROOM_TILES - 1) * r->size, -0.25, (t / ROOM_TILES - 1) * r->size},
               sizeof r->place[i]);
        if (t >= 0)
            continue;
        const double thickness = c->shape == SPRING_BOX ? 0.2 : 0;
        to[0] = to[2] = 0;
        to[along] = (i < 2 ? -1 : 1) * (r->half + thickness);
        to[1] = k % 3 == 1 ? 2 : 1;
        c->half[0] = c->half[2] = r->half + 0.4;
        c->half[1] = 2;
        c->half[along] = thickness;
    }
    move_room(r, 0);
}

/* Particles with links between all of them. */
static spring_scene *particles_in_room(const room *r, size_t count, double radius)
{
    const double from[3] = {random_uniform(-0.8, 0.8) * r->half, random_uniform(0.3, 0.6),
                            random_uniform(-0.8, 0.8) * r->half},
                 speed[3] = {random_uniform(-6, 6), random_uniform(-3, 1), random_uniform(-6, 6)};
    double x[ROOM_PARTICLES][3], v[ROOM_PARTICLES][3];
    spring_link link[ROOM_PARTICLES * (ROOM_PARTICLES - 1) / 2];
    spring_scene_def def = falling(count, x[0], v[0], 0.1);
    for (uint32_t i = 0; i < count; i++) {
        const double to[3] = {from[0] + 0.05 * (i & 1), from[1] + 0.05 * (i >> 1 & 1), from[2] + 0.05 * (i >> 2)};
        place_of(r, to, x[i]);
        for (int a = 0; a < 3; a++)
            v[i][a] = r->rate[a] + speed[a];
        for (uint32_t j = 0; j < i; j++)
            link[def.links++] = (spring_link){.a = j, .b = i, .rest = 0.06, .stiffness = 100, .damping = 0.3};
    }
    def.link = link, def.particle_radius = (scalar)radius, def.colliders = ROOM_BODIES;
    for (int a = 0; a < 3; a++)
        def.gravity[a] = -gravity * r->axis[1][a];
    return scene_of(&def);
}

/* [m] How far a particle is outside of a room. */
static double outside_of_room(const room *r, const double x[3])
{
    double from[3];
    for (int a = 0; a < 3; a++)
        from[a] = x[a] - r->at[a];
    return fmax(-dot(from, r->axis[1]), fmax(fabs(dot(from, r->axis[0])), fabs(dot(from, r->axis[2]))) - r->half);
}

/* [m/s] The velocity of a particle through the floor that it lies on, in a room without spin; otherwise 0. */
static double through_floor(const room *r, const double x[3], const double v[3])
{
    double u[3], from[3];
    for (int a = 0; a < 3; a++) {
        u[a] = v[a] - r->rate[a];
        from[a] = x[a] - r->at[a];
    }
    return length(r->spin) == 0 && dot(from, r->axis[1]) < 1e-4 ? fabs(dot(u, r->axis[1])) : 0;
}

/* Particles slide into the corners of a room of boxes that only touch, and come to rest there. They have no radius, unless
   the bodies do not fit each other to rounding errors: in a room that turns, and of rounded coordinates in double precision. */
static void room_of_boxes(void)
{
    double worst = -1, fastest = 0;
    for (int k = 0; k < 480; k++) {
        const size_t count = k % 7 ? 1 : ROOM_PARTICLES;
        const double dt = frame / (count == 1 ? 1 << k % 3 : 8);
        room r;
        random_room(&r, k);
        const bool spins = length(r.spin) > 0;
        const double radius = spins || (in_double && r.rounded) ? (k % 3 == 1 ? 1e-3 : 1e-4) : 0;
        const uint64_t steps = (uint64_t)(2 / dt), each = spins ? 1 : steps;
        spring_scene *s = particles_in_room(&r, count, radius);
        double x[ROOM_PARTICLES][3], v[ROOM_PARTICLES][3];
        for (uint64_t n = 0; n < steps; n += each) {
            move_room(&r, spring_scene_time(s));
            set(s, r.body, ROOM_BODIES);
            run(s, contact_methods[k % 11 == 0], dt, each);
        }
        move_room(&r, spring_scene_time(s));
        spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, count);
        spring_scene_get(s, SPRING_VELOCITY, v[0], 0, 0, count);
        for (size_t i = 0; i < count; i++)
            worst = fmax(worst, outside_of_room(&r, x[i]) + (spins || r.rounded ? 0 : radius));
        fastest = count == 1 ? fmax(fastest, through_floor(&r, x[0], v[0])) : fastest;
        free(s);
    }
    /* The sizes of the coordinates of a particle add up to at most 21 m, and those of a body, with its half extents, to 25 m. */
    CHECK(worst <= 8 * EPS * 46, "inside, to the slop");
    CHECK_BELOW(fastest, 64 * EPS, "it lies on the floor");
}

/* Planes shut in particles, however they turn: a box that is shaken, with a spin that changes every 1/12 s. */
static void room_of_planes(void)
{
    enum { COUNT = 20 };
    double worst = -1;
    for (int k = 0; k < 40; k++) {
        const double half[3] = {random_uniform(0.3, 1.5), random_uniform(0.3, 1.5), random_uniform(0.3, 1.5)};
        const double e = k % 2 ? random_uniform(0, 0.5) : 0, friction = random_uniform(0, 1), dt = 1. / 240;
        double axis[3][3], spin[3], x[COUNT][3];
        spring_collider c[6];
        spring_scene_def def = {.particles = COUNT,
                                .position = x[0],
                                .mass_all = 0.1,
                                .gravity = {0, -gravity, 0},
                                .colliders = 6,
                                .particle_radius = k % 4 < 2 ? (scalar)0.02 : 0,
                                .methods = 1u << SPRING_LEAPFROG | 1u << SPRING_RK4};
        for (int i = 0; i < COUNT; i++)
            for (int a = 0; a < 3; a++)
                x[i][a] = random_uniform(-0.9, 0.9) * half[a];
        memcpy(axis, unit_box.axis, sizeof axis);
        spring_scene *s = scene_of(&def);
        for (int n = 0; n < 400; n++) {
            const double fastest = 1 + k % 5;
            double phi[3];
            for (int a = 0; a < 3; a++) {
                spin[a] = n % 20 ? spin[a] : random_uniform(-fastest, fastest);
                phi[a] = spin[a] * dt;
            }
            for (int i = 0; i < 6; i++) {
                c[i] = (spring_collider){.shape = SPRING_PLANE, .friction = friction, .restitution = e};
                memcpy(c[i].spin, spin, sizeof spin);
                for (int a = 0; a < 3; a++) {
                    c[i].axis[0][a] = (i < 3 ? 1 : -1) * axis[i % 3][a];
                    c[i].at[a] = -half[i % 3] * c[i].axis[0][a];
                }
                cross(spin, c[i].at, c[i].velocity);
                cross(spin, c[i].velocity, c[i].acceleration);
            }
            set(s, c, 6);
            run(s, contact_methods[k % 3 == 0], dt, 1);
            for (int a = 0; a < 3; a++)
                turn(phi, (double[]){axis[a][0], axis[a][1], axis[a][2]}, axis[a]);
            spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, COUNT);
            for (int i = 0; i < COUNT; i++)
                for (int a = 0; a < 3; a++)
                    worst = fmax(worst, fabs(dot(x[i], axis[a])) + def.particle_radius - half[a]);
        }
        free(s);
    }
    /* The points `at` follow a parabola: (|spin| dt)^3/6 of 2.6 m, at spins of at most 5 sqrt(3) rad/s. */
    CHECK(worst <= 2.1e-5, "inside");
}

/* A small particle slides over a floor, or down a wall, to where they meet. The wall stands at the level of the floor and
   touches only its edge, or it extends below the floor, which enters it by very little. */
static void wall_on_a_floor(void)
{
    for (int k = 0; k < 460; k++) {
        const bool enters = k < 60;
        const double radius = k % 2 && !enters ? random_log(1e-5, 1e-2) : 0, dt = enters ? frame / (1 << k % 3) : frame;
        const double g[3] = {enters ? 3 : k % 3 ? 0.5 : 0, -gravity, 0}, bound = enters ? 1e4 * EPS : 64 * EPS;
        const double x[3] = {enters ? -0.2 : -random_log(1e-3, 0.5), enters ? random_uniform(0.1, 1) : radius, 0},
                     v[3] = {enters ? random_uniform(1, 8) : random_log(0.05, 5), 0, random_uniform(-0.2, 0.2)};
        spring_collider c[2] = {unit_box, unit_box}; /* the top of the floor is y = 0, and the wall begins at x = 0 */
        double now[3], u[3];
        c[0].at[0] = (!enters ? 0 : in_double ? 1e-7 : 1e-4) - c[0].half[0];
        c[0].at[1] = -c[0].half[1];
        c[1].half[1] = 2, c[1].at[1] = enters ? 0 : 2;
        c[1].at[0] = c[1].half[0];
        end_of(ball_on(c, 2, x, v, g, radius), contact_methods[k % second_order], dt, (uint64_t)(1.5 / dt), now, u);
        CHECK(now[1] >= radius - bound && now[1] <= radius + fmax(bound, 1024 * EPS) && now[0] <= bound - radius,
              "it lies on the floor, at the wall or before it");
    }
}

/* A particle rests in a corner of two planes and a floor that move together, in any direction. */
static void corner_of_planes(void)
{
    for (int k = 0; k < 2000; k++) {
        double axis[3][3], rate[3], at[3], g[3], x[3], v[3], now[3], u[3];
        spring_collider c[3] = {{.shape = SPRING_PLANE}, {.shape = SPRING_PLANE}, unit_box};
        random_axes(axis);
        memcpy(c[0].axis[0], axis[0], sizeof axis[0]);
        memcpy(c[1].axis[0], axis[2], sizeof axis[2]);
        memcpy(c[2].axis, axis, sizeof axis);
        for (int a = 0; a < 3; a++) {
            rate[a] = random_uniform(-2, 2);
            at[a] = random_uniform(-2, 2);
            g[a] = -gravity * axis[1][a];
            x[a] = at[a] + 0.01 * (axis[0][a] + axis[1][a] + axis[2][a]);
            v[a] = rate[a] - axis[0][a] - axis[2][a];
            for (int i = 0; i < 3; i++)
                c[i].at[a] = at[a], c[i].velocity[a] = rate[a];
            /* the edges of the floor touch the planes */
            c[2].at[a] += c[2].half[0] * axis[0][a] - c[2].half[1] * axis[1][a] + c[2].half[2] * axis[2][a];
        }
        end_of(particle_on(c, 3, x, v, g), SPRING_LEAPFROG, frame, 60, now, u);
        for (int a = 0; a < 3; a++)
            CHECK(fabs(now[a] - at[a] - 60 * frame * rate[a]) <= 64 * EPS * 30, "in the corner, to the skin");
    }
}

/* A wall stands on a floor, and particles are pressed into the corner. When the wall jumps forward, they are moved out
   through its front, and not through its bottom, into the floor. */
static void wall_that_jumps(void)
{
    static const double jumps[] = {1e-13, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.02, 0.1};
    for (size_t k = 0; k < 4 * sizeof jumps / sizeof jumps[0]; k++) {
        const double jump = jumps[k / 4], r = k % 4 > 1 ? 0.01 : 0, g[3] = {-10, -gravity, random_uniform(-1, 1)};
        const double x[3] = {0.1, r + 0.05, 0};
        spring_collider c[2] = {unit_box, unit_box};
        double now[3], v[3];
        c[0].at[1] = -c[0].half[1];
        c[0].half[0] = c[0].half[2] = c[1].half[2] = 5;
        if (k % 2)
            c[0] = ground;
        c[1].at[0] = -c[1].half[0];
        c[1].at[1] = c[1].half[1];
        spring_scene *s = ball_on(c, 2, x, none, g, r);
        run(s, SPRING_LEAPFROG, frame / 8, 200);
        c[1].at[0] += jump;
        set(s, c, 2);
        end_of(s, SPRING_LEAPFROG, frame / 8, 20, now, v);
        CHECK(now[1] > r - 1e3 * EPS && now[0] > jump + r - 1e3 * EPS, "on the floor, before the wall");
    }
}

/* Particles slide on a plate into the wedge under a ball that sits in it, and are pressed into the plate by more than half
   of its thickness. */
static void thin_plates(void)
{
    for (int k = 0; k < 1000; k++) {
        const double half = random_log(5e-4, 5e-3), over = random_uniform(0.05, 0.25), thrown = random_log(1, 50),
                     x[3] = {sqrt(0.09 - over * over) + random_uniform(0.15, 0.17), 0.001, 0}, v[3] = {-thrown, 0, 0};
        spring_collider c[2] = {unit_box, {.shape = SPRING_SPHERE, .at = {0, over, 0}, .radius = 0.3}};
        c[0].half[1] = half;
        c[0].at[1] = -half;
        c[0].restitution = c[1].restitution = k % 4 ? 0 : random_uniform(0, 1);
        double now[3], speed[3];
        end_of(particle_on(c, 2, x, v, down), contact_methods[k % second_order], random_log(1. / 960, frame), 60, now,
               speed);
        CHECK(now[1] > -half || fabs(now[0]) > unit_box.half[0] || fabs(now[2]) > unit_box.half[2],
              "a particle in a wedge is not pressed through the plate");
    }
}

/* Fast particles bounce many times in a step between thin walls, or, in a lift that rises, between two planes. */
static void thin_walls(void)
{
    for (int k = 0; k < 600; k++) {
        const bool lift = k % 3 == 0;
        const double reach = lift ? 0.02 : random_uniform(0.3, 1), half = 1e-3, rises = random_uniform(-3, 3),
                     fastest = lift ? random_log(3, 50) : random_log(10, 500);
        const double g[3] = {0, lift && k % 2 ? -gravity : 0, 0};
        spring_collider c[6];
        double x[3], v[3], now[3], speed[3];
        for (int i = 0; i < 6; i++) {
            c[i] = unit_box;
            for (int a = 0; a < 3; a++)
                c[i].half[a] = a == i / 2 ? half : reach + 2 * half;
            c[i].at[i / 2] = (i % 2 ? 1 : -1) * (reach + half);
            c[i].velocity[1] = rises;
            c[i].restitution = lift || k % 2 ? 1 : random_uniform(0, 1);
        }
        for (int a = 0; a < 3; a++) {
            x[a] = random_uniform(-0.9, 0.9) * reach;
            v[a] = lift ? a == 0 ? fastest : 0 : random_uniform(-1, 1) * fastest;
        }
        for (int i = 0; i < 2 && lift; i++) {
            const double side = i ? 1 : -1;
            c[i] = (spring_collider){.shape = SPRING_PLANE, .at = {side * reach}, .axis = {{-side}}, .restitution = 1};
            c[i].velocity[1] = rises;
        }
        x[1] = lift ? k % 4 < 2 ? -reach : -reach / 2 : x[1];
        v[1] += rises;
        end_of(particle_on(c, lift ? 3 : 6, x, v, lift ? g : none), contact_methods[k % second_order], frame, 30, now,
               speed);
        now[1] = lift ? fmin(0, now[1] - 30 * frame * rises) : now[1] - 30 * frame * rises; /* a lift has no ceiling */
        for (int a = 0; a < 3; a++)
            CHECK(fabs(now[a]) <= reach + 64 * EPS * 5, "between the walls");
    }
}

/* A ball comes down on a thin plate, near its edge, where particles rest. None of them goes through, or jumps farther than
   its speed and that of the ball allow. */
static void ball_on_an_edge(void)
{
    double farthest = 0;
    for (int k = 0; k < 2000; k++) {
        const double x[3] = {random_uniform(1.9, 2), 0, random_uniform(-0.2, 0.2)};
        const double half = random_log(1e-3, 0.02), falls = random_uniform(0.3, 2);
        spring_collider c[2] = {unit_box,
                                {.shape = SPRING_SPHERE, .at = {random_uniform(1.8, 2.1), 0.4, 0}, .radius = 0.3}};
        c[0].half[1] = half;
        c[0].at[1] = -half;
        c[1].velocity[1] = -falls;
        spring_scene *s = particle_on(c, 2, x, none, down);
        double before[3], now[3], v[3];
        for (int n = 0; n < 30; n++) {
            get(s, before, v);
            const double speed = length(v);
            run(s, contact_methods[k % second_order], frame, 1);
            get(s, now, v);
            farthest = fmax(farthest, distance(now, before) - frame * (falls + speed + length(v)));
        }
        free(s);
    }
    CHECK_BELOW(farthest, 0.3, "a jump: the radius of the ball");
}

/* Colliders that wait far away for their use do not change how a particle rests on a box. */
static void waiting_colliders(void)
{
    const double x[3] = {0};
    double now[2][3], speed[3];
    for (int k = 0; k < 4; k++) {
        spring_collider c[2] = {unit_box, unit_box};
        c[0].at[1] = -unit_box.half[1];
        c[1].shape = (spring_shape[]){SPRING_BOX, SPRING_PLANE, SPRING_SPHERE, SPRING_CAPSULE}[k];
        c[1].axis[0][0] = c[1].shape == SPRING_PLANE ? 0 : 1;
        c[1].axis[0][1] = c[1].shape == SPRING_PLANE ? 1 : 0;
        c[1].radius = 1;
        c[1].at[1] = c[1].to[1] = -1e5;
        for (uint32_t i = 0; i < 2; i++)
            end_of(particle_on(c, 1 + i, x, x, down), SPRING_LEAPFROG, frame, 10, now[i], speed);
        CHECK_BITS(now[1][1], now[0][1], "on the box");
    }
}

static faces level_ground = {1, {{0, 1, 0}}};

/* A particle that is put on the ground rests there: a box on it, at a distance, lifts it by the skin, without velocity. A
   box that waits deep below a plane, or far from a custom body with a bound, does not. */
static void boxes_on_the_ground(void)
{
    for (int k = 0; k < 200; k++) {
        const bool waits = k % 2;
        const double away = random_log(5, 1e4), at = random_uniform(-3, 3);
        const double radius = k % 3 ? 0 : random_uniform(0, 0.1), x[3] = {at, radius, 0}, angle = random_uniform(0, PI);
        const double skin = waits ? 0 : 33 * EPS * (away * (fabs(cos(angle)) + sin(angle)) + 4 * 0.5);
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{0, 1, 0}}}, unit_box};
        if (k % 4 > 1)
            c[0] = (spring_collider){.shape = SPRING_CUSTOM,
                                     .gap = gaps_of_faces,
                                     .user = &level_ground,
                                     .thickness = random_log(1, 1e9),
                                     .bound = 50};
        if (c[0].shape == SPRING_CUSTOM && !waits)
            c[0].bound = 0;
        c[0].friction = c[1].friction = k % 5 ? random_uniform(0, 1) : 0;
        for (int a = 0; a < 3; a++)
            c[1].half[a] = 0.5;
        memcpy(c[1].at, (double[]){away * cos(angle), 0.5, away * sin(angle)}, sizeof c[1].at);
        if (waits)
            memcpy(c[1].at, (double[]){0, -away - 100, 0}, sizeof c[1].at);
        const double dt = random_log(1e-3, 1. / 60);
        spring_scene *s = ball_on(c, 2, x, none, down, radius);
        for (int n = 0; n < 60; n++) {
            double now[3], v[3];
            uint32_t touches;
            run(s, contact_methods[k % second_order], dt, 1);
            get(s, now, v);
            CHECK(spring_scene_touching(s, &touches, 0, 1) == SPRING_OK && touches == 1, "on the ground alone");
            CHECK(now[0] == (scalar)at && now[1] >= radius - 32 * EPS && now[1] <= radius + skin + 32 * EPS,
                  "in its place");
            CHECK(length(v) == 0 && spring_scene_at_rest(s, 1e-9, 1e-9), "at rest");
        }
        free(s);
    }
}

/* The ground moves, and carries a particle by friction: rounding errors of its position are no velocity. */
static void carried_far_out(void)
{
    for (int k = 0; k < 100; k++) {
        const double far_out = random_log(1, 50), angle = random_uniform(-0.2, 0.2);
        const double n[3] = {sin(angle), cos(angle), 0}, x[3] = {far_out, far_out, far_out};
        const double V[3] = {random_uniform(-1, 1), random_uniform(-1, 1), random_uniform(-1, 1)};
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{n[0], n[1], 0}}, .friction = 0.5}, unit_box};
        c[1].at[0] = far_out + 3;
        c[1].at[1] = c[1].at[2] = far_out;
        for (int i = 0; i < 2; i++)
            memcpy(c[i].velocity, V, sizeof V);
        memcpy(c[0].at, x, sizeof x);
        spring_scene *s = ball_on(c, k % 2 ? 2 : 1, x, V, down, 0);
        for (int step = 0; step < 300; step++) {
            double now[3], v[3];
            uint32_t touches;
            run(s, contact_methods[k % second_order], 1. / 960, 1);
            get(s, now, v);
            CHECK(spring_scene_touching(s, &touches, 0, 1) == SPRING_OK && touches == 1, "on the ground");
            for (int a = 0; a < 3; a++)
                CHECK_BELOW(fabs(v[a] - V[a]), in_double ? 64 * EPS : gravity / 960, "carried, or falling for a step");
        }
        free(s);
    }
}

static const test tests[] = {
    {"grooves", grooves},
    {"wide grooves", wide_grooves},
    {"inside several", inside_several},
    {"between closing bodies", between_closing_bodies},
    {"crevice of round bodies", crevice_of_round_bodies},
    {"links at an edge", links_at_an_edge},
    {"floor of boxes", floor_of_boxes},
    {"room of boxes", room_of_boxes},
    {"room of planes", room_of_planes},
    {"wall on a floor", wall_on_a_floor},
    {"corner of planes", corner_of_planes},
    {"wall that jumps", wall_that_jumps},
    {"thin plates", thin_plates},
    {"thin walls", thin_walls},
    {"ball on an edge", ball_on_an_edge},
    {"waiting colliders", waiting_colliders},
    {"boxes on the ground", boxes_on_the_ground},
    {"carried far out", carried_far_out},
};

int main(void)
{
    return RUN_TESTS("corners", tests);
}
