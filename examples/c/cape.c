/* SPDX-License-Identifier: MIT */
/*
 * A cape in wind, on a capsule that runs, jumps and is teleported. Once per frame, the program sets the velocities of the
 * capsule and of the pinned row of the cape so that they reach the next pose. Tethers of every seventh row keep the cape
 * from stretching, and weighted links from wrinkling. It uses single precision, and 0.9 of the stable step: see docs/games.md.
 *     cc -std=c11 cape.c -lspringstep -lm -o cape
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { W = 20, H = 30, N = W * H, TELEPORT = 150 /* frame */ };
static const double frame = 1.0 / 60, mass = 0.002;      /* [s], [kg] of a particle */
static const double spacing = 0.04, skin = 0.01;         /* [m], radius of a particle */
static const double radius = 0.2, low = 0.4, high = 1.3; /* [m] radius and end heights of the body */
static const double air[3] = {-2, 0, 3}, drag = 0.0015;  /* [m/s], [N s/m] of a particle */
static double x[N][3];

static void must(spring_status status)
{
    if (status != SPRING_OK)
        exit(fprintf(stderr, "%s\n", spring_status_string(status)));
}

/* The position of the body in frame i. It runs, and jumps for 0.6 s at t = 1 s. After the teleport it runs back. */
static void place_body(int i, double facing, double at[2])
{
    const double t = i * frame, jump = t - 1, run = 4 * (t < 0.5 ? t * t : t - 0.25);
    at[0] = facing > 0 ? run : -100 - run;
    at[1] = jump > 0 && jump < 0.6 ? 9.81 / 2 * jump * (0.6 - jump) : 0;
}

/* Particles of the upper edge are on an arc behind the neck. */
static void place_pin(int k, const double at[2], double facing, double target[3])
{
    const double arc = radius + 2 * skin, angle = (k - (W - 1) / 2.0) * spacing / arc;
    target[0] = at[0] - facing * arc * cos(angle);
    target[1] = at[1] + high + 0.05;
    target[2] = facing * arc * sin(angle);
}

static void move_body(spring_scenef *cape, int i, double facing)
{
    double at[2], next[2], target[3];
    place_body(i, facing, at), place_body(i + 1, facing, next);
    spring_collider c[2] = {{.shape = SPRING_CAPSULE, .radius = radius, .friction = 0.3},
                            {.shape = SPRING_PLANE, .axis = {{0, 1, 0}}, .friction = 0.8}};
    c[0].at[0] = c[0].to[0] = at[0], c[0].at[1] = at[1] + low, c[0].to[1] = at[1] + high;
    c[0].velocity[0] = c[0].velocity_to[0] = (next[0] - at[0]) / frame;
    c[0].velocity[1] = c[0].velocity_to[1] = (next[1] - at[1]) / frame;
    must(spring_scenef_set_colliders(cape, c, 2));
    for (int k = 0; k < W; k++) {
        place_pin(k, next, facing, target);
        must(spring_scenef_drive(cape, (size_t)k, target, frame));
    }
}

static void show(const spring_scenef *cape, const double at[2], double facing)
{
    double depth = 0, longest = 0;
    must(spring_scenef_get(cape, SPRING_POSITION, x[0], 0, 0, N));
    for (int k = W; k < N; k++) {
        const double dx = x[k][0] - at[0], dy = x[k][1] - fmin(fmax(x[k][1], at[1] + low), at[1] + high);
        const double away = hypot(hypot(dx, dy), x[k][2]) - radius;
        const double *neck = x[k % W], chord = hypot(hypot(x[k][0] - neck[0], x[k][1] - neck[1]), x[k][2] - neck[2]);
        depth = fmax(depth, skin - fmin(away, x[k][1]));
        longest = fmax(longest, chord / (k / W * spacing));
    }
    printf(
        "%.2f s  body at %+.2f %.2f m  hem %.2f m behind, %.2f m up  inside %.1e m  stretch %.1f %%  elastic %.3f J\n",
        spring_scenef_time(cape), at[0], at[1], facing * (at[0] - x[N - W / 2][0]), x[N - W / 2][1], depth,
        100 * (longest - 1), spring_scenef_energy(cape).elastic);
}

int main(void)
{
    static spring_link link[5 * N]; /* fewer than four per particle, and a tether */
    static spring_weighted_link bend[2 * N];
    static uint8_t pinned[N];
    static uint32_t work[2 * N];
    static double distance[2 * N], at[2], facing = 1;
    spring_scenef *cape;
    spring_grid sheet = {.count = {W, H}, .spacing = spacing, .stiffness = 600};
    sheet.families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR, sheet.pinned = SPRING_GRID_FIRST_Y;
    size_t particles, links, bends = 2 * N, tethers = N, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, x[0], pinned, link));
    must(spring_bend_grid(&sheet, pinned, SPRING_BEND_ROWS, 1e-3, 0, bend, &bends)); /* [N m], as paper */
    place_body(0, facing, at);
    for (int i = 0; i < N; i++) /* hangs down behind the body */
        place_pin(i % W, at, facing, x[i]), x[i][1] -= i / W * spacing;
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
    void *memory = malloc(bytes);
    must(spring_scenef_init(memory, bytes, &def, &cape)); /* NULL memory gives SPRING_EINVAL */
    const uint64_t steps = (uint64_t)ceil(frame / (0.9 * spring_scenef_stable_step(cape, SPRING_LEAPFROG)));
    for (int i = 0; i <= 300; i++) {
        place_body(i, facing, at);
        if (i % 30 == 0)
            show(cape, at, facing);
        if (i == TELEPORT) { /* also turned by 180 degrees: x = -100 m - x, z = -z */
            must(spring_scenef_transform(cape, (const double[]){-1, 0, 0, -100, 0, 1, 0, 0, 0, 0, -1, 0}));
            place_body(i, facing = -1, at);
            show(cape, at, facing);
        }
        move_body(cape, i, facing);
        must(spring_scenef_advance(cape, SPRING_LEAPFROG, frame / (double)steps, steps));
    }
    free(memory);
    return 0;
}
