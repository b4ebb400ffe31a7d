/* SPDX-License-Identifier: MIT */
/*
 * A lamp hangs from a point inside a triangle of a canopy. A hook is attached to this point by a weighted link of rest
 * length 0, which pulls the corners of the triangle by their shares, and a cord joins the lamp to the hook.
 *
 *     cc -std=c11 lamp.c -lspringstep -lm -o lamp
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { W = 17, N = W * W, HOOK = N, LAMP = N + 1, STEPS = 20 };
static const double frame = 1.0 / 60, width = 2, cord = 0.5;         /* [s], [m] */
static const uint32_t corner[3] = {6 * W + 8, 6 * W + 9, 7 * W + 8}; /* of the triangle */
static const double share[3] = {0.25, 0.45, 0.3};                    /* of each corner: the barycentric coordinates */
static double x[N + 2][3], v[N + 2][3], mass[N + 2];

static void must(spring_status status)
{
    if (status != SPRING_OK)
        exit(fprintf(stderr, "%s\n", spring_status_string(status)));
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* The point of the canopy. */
static void find_point(double point[3])
{
    for (int axis = 0; axis < 3; axis++) {
        point[axis] = 0;
        for (int i = 0; i < 3; i++)
            point[axis] += share[i] * x[corner[i]][axis];
    }
}

int main(void)
{
    static spring_link link[5 * N];
    static spring_weighted_link weighted[2 * N + 1];
    static uint8_t pinned[N + 2];
    const spring_grid canopy = {.count = {W, 1, W}, /* in the plane of x and z */
                                .spacing = width / (W - 1),
                                .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                                .stiffness = 300,
                                .damping = 0.05};
    size_t particles, links, bends = 2 * N, bytes;
    must(spring_grid_size(&canopy, &particles, &links));
    must(spring_grid_fill(&canopy, x[0], pinned, link));
    pinned[0] = pinned[W - 1] = pinned[N - W] = pinned[N - 1] = 1; /* the corners */
    must(spring_bend_grid(&canopy, pinned, SPRING_BEND_ROWS, 1e-3, 0, weighted, &bends));

    find_point(x[HOOK]);
    for (int axis = 0; axis < 3; axis++)
        x[LAMP][axis] = x[HOOK][axis] - (axis == 1 ? cord : 0);
    for (int i = 0; i < N + 2; i++)
        mass[i] = i < N ? 0.004 : i == HOOK ? 0.02 : 0.3;
    v[LAMP][0] = 1.5; /* it swings */
    weighted[bends] = (spring_weighted_link){.particle = {HOOK, corner[0], corner[1], corner[2]},
                                             .weight = {-1, share[0], share[1], share[2]},
                                             .stiffness = 1500,
                                             .damping = 1};
    link[links] = (spring_link){.a = HOOK, .b = LAMP, .rest = cord, .stiffness = 1000, .damping = 0.5};
    link[links++].flags = SPRING_LINK_TENSION_ONLY;

    spring_scene_def def = {.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, .particles = N + 2, .position = x[0]};
    def.velocity = v[0], def.mass = mass, def.pinned = pinned, def.gravity[1] = -9.81, def.drag = 0.004;
    def.links = links, def.link = link, def.weighted_links = bends + 1, def.weighted_link = weighted;
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *s;
    must(spring_scene_init(memory, bytes, &def, &s)); /* NULL memory gives SPRING_EINVAL */
    for (int i = 0; i <= 600; i++) {
        if (i % 60 == 0) {
            double point[3];
            must(spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, N + 2));
            find_point(point);
            printf("%5.2f s  point %.3f m low  hook %.4f m from it  cord %.4f m  lamp %+.3f %+.3f m beside it\n",
                   spring_scene_time(s), -point[1], distance(x[HOOK], point), distance(x[HOOK], x[LAMP]),
                   x[LAMP][0] - point[0], x[LAMP][2] - point[2]);
        }
        must(spring_scene_advance(s, SPRING_LEAPFROG, frame / STEPS, STEPS));
    }
    free(memory);
    return 0;
}
