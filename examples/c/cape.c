/* SPDX-License-Identifier: MIT */
/*
 * A cape in wind, on a capsule that runs, jumps, turns round and is teleported. Once per frame, the program sets the
 * capsule at its pose, and velocities with which it and the pinned row of the cape reach the next pose. Tethers of
 * every seventh row limit the stretch, and weighted links resist wrinkles. Single precision: see docs/games.md.
 *     cc -std=c11 cape.c -lspringstep -lm -o cape
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { W = 20, H = 30, N = W * H, TELEPORT = 180 /* frame */ };
static const double frame = 1.0 / 60, mass = 0.002;      /* [s], [kg] of a particle */
static const double spacing = 0.04, skin = 0.01;         /* [m], radius of a particle */
static const double radius = 0.2, low = 0.4, high = 1.3; /* [m] radius and end heights of the body */
static const double air[3] = {-2, 0, 3}, drag = 0.0015;  /* [m/s], [N s/m] of a particle */
static double x[N][3], distance[2 * N];

static void must(spring_status status)
{
    if (status != SPRING_OK)
        exit(fprintf(stderr, "%s\n", spring_status_string(status)));
}

typedef struct pose {
    double x, y, yaw; /* [m], [m] of the feet, [rad] about y. At yaw 0, the body faces x */
} pose;

/* Before the teleport: the body runs, jumps for 0.6 s at t = 1 s, and turns round in 1.2 s. Afterwards it runs back. */
static pose pose_in(int i)
{
    const double t = i * frame, jump = t - 1, turn = fmin(fmax(t - 1.7, 0), 1.2), part = turn / 1.2;
    const double run = 4 * (t < 0.5 ? t * t : fmin(t, 1.7) - 0.25), back = 4 * fmax(t - 2.9, 0);
    return (pose){.x = run + 4 * turn * (1 - part) - back - (i > TELEPORT ? 100 : 0),
                  .y = fmax(9.81 / 2 * jump * (0.6 - jump), 0),
                  .yaw = acos(-1) * part * part * (3 - 2 * part)};
}

/* Particles of the upper edge are on an arc behind the neck. */
static void place_pin(int k, const pose *p, double at[3])
{
    const double arc = radius + 2 * skin, angle = p->yaw + (k - (W - 1) / 2.0) * spacing / arc;
    at[0] = p->x - arc * cos(angle), at[1] = p->y + high + 0.05, at[2] = arc * sin(angle);
}

static void move_body(spring_scenef *cape, const pose *now, const pose *next)
{
    spring_collider c[2] = {{.shape = SPRING_CAPSULE, .radius = radius, .friction = 0.3},
                            {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .friction = 0.8}};
    c[0].at[0] = c[0].to[0] = now->x, c[0].at[1] = now->y + low, c[0].to[1] = now->y + high;
    c[0].velocity[0] = c[0].velocity_to[0] = (next->x - now->x) / frame;
    c[0].velocity[1] = c[0].velocity_to[1] = (next->y - now->y) / frame;
    c[0].spin[1] = (next->yaw - now->yaw) / frame; /* of its surface, about its axis */
    must(spring_scenef_set_colliders(cape, c, 2));
    for (int k = 0; k < W; k++) {
        double target[3];
        place_pin(k, next, target);
        must(spring_scenef_drive(cape, (size_t)k, target, frame));
    }
}

static void show(const spring_scenef *cape, const pose *p)
{
    double depth = 0, longest = 0, energy = spring_scenef_energy(cape).elastic;
    must(spring_scenef_get(cape, SPRING_POSITION, x[0], 0, 0, N));
    for (int k = W; k < N; k++) {
        const double dx = x[k][0] - p->x, dy = x[k][1] - fmin(fmax(x[k][1], p->y + low), p->y + high);
        const double *neck = x[k % W], chord = hypot(hypot(x[k][0] - neck[0], x[k][1] - neck[1]), x[k][2] - neck[2]);
        depth = fmax(depth, skin - fmin(hypot(hypot(dx, dy), x[k][2]) - radius, x[k][1]));
        longest = fmax(longest, chord / (k / W * spacing));
    }
    const double *hem = x[N - W / 2], behind = cos(p->yaw) * (p->x - hem[0]) + sin(p->yaw) * hem[2];
    printf(
        "%.2f s  body at %+.2f %.2f m  hem %.2f m behind, %.2f m up  inside %.1e m  stretch %.1f %%  elastic %.3f J\n",
        spring_scenef_time(cape), p->x, p->y, behind, hem[1], depth, 100 * (longest - 1), energy);
}

int main(void)
{
    static spring_link link[5 * N]; /* fewer than four per particle, and a tether */
    static spring_weighted_link bend[2 * N];
    static uint8_t pinned[N];
    static uint32_t work[2 * N];
    spring_scenef *cape;
    spring_grid sheet = {.count = {W, H}, .spacing = spacing, .stiffness = 600};
    sheet.families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR, sheet.pinned = SPRING_GRID_FIRST_Y;
    size_t particles, links, bends = 2 * N, tethers = N, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, x[0], pinned, link));
    must(spring_bend_grid(&sheet, pinned, SPRING_BEND_ROWS, 1e-3, 0, bend, &bends)); /* [N m], as paper */
    pose now = pose_in(0);
    for (int i = 0; i < N; i++) /* hangs down behind the body */
        place_pin(i % W, &now, x[i]), x[i][1] -= i / W * spacing;
    spring_scenef_def def = {.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, .drag = drag, .particle_radius = skin};
    def.particles = particles, def.position = x[0], def.mass_all = mass, def.pinned = pinned, def.colliders = 2;
    def.links = links, def.link = link, def.weighted_links = bends, def.weighted_link = bend;
    for (int axis = 0; axis < 3; axis++) /* moving air adds a constant force to drag; wind.c has wind on triangles */
        def.gravity[axis] = drag / mass * air[axis] - (axis == 1 ? 9.81 : 0);
    must(spring_linksf_tethers(&def, 0.05, 0, link + links, &tethers, work, distance));
    for (size_t i = 0; i < tethers; i++)
        if ((H - 1 - link[links + i].a / W) % 7 == 0) /* of every seventh row, from the hem */
            link[def.links++] = link[links + i];
    must(spring_scenef_bytes(&def, &bytes));
    must(spring_scenef_init(malloc(bytes), bytes, &def, &cape)); /* NULL memory gives SPRING_EINVAL */
    const uint64_t steps = (uint64_t)ceil(frame / (0.9 * spring_scenef_stable_step(cape, SPRING_LEAPFROG)));
    for (int i = 0; i <= 300; i++) {
        if (i % 30 == 0)
            show(cape, &now);
        if (i == TELEPORT) {
            must(spring_scenef_transform(cape, (const double[]){1, 0, 0, -100, 0, 1, 0, 0, 0, 0, 1, 0}));
            now.x -= 100, show(cape, &now);
        }
        const pose next = pose_in(i + 1);
        move_body(cape, &now, &next);
        must(spring_scenef_advance(cape, SPRING_LEAPFROG, frame / (double)steps, steps));
        now = next;
    }
    free(cape);
}
