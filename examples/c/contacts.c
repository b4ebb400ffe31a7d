/* SPDX-License-Identifier: MIT */
/*
 * A cloth falls on a ball and the floor around it. Contacts are projections between steps: a particle that is inside
 * something is moved to its surface, and loses the velocity that leads into it.
 *
 *     cc -std=c11 contacts.c -lspringstep -lm -o contacts
 *
 * Steps are short and one at a time, so that nothing gets deep before it is put right. Particles are kept out, not the
 * links between them: the spacing has to be small beside what they fall on.
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 21, N = SIDE * SIDE };
static const double dt = 1.0 / 480;                      /* [s] */
static const double ball[3] = {0, 0.3, 0}, radius = 0.3; /* [m] */
static const double skin = 0.01;                         /* [m] half the cloth's thickness */
static const double grip = 0.3;                          /* of the sliding speed, lost in each step */

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Out of a surface along its normal, by depth > 0: speed into it is lost, speed along it braked. */
static void project(double x[3], double v[3], const double normal[3], double depth)
{
    const double along = dot(v, normal), after = fmax(along, 0);
    for (int axis = 0; axis < 3; axis++) {
        x[axis] += depth * normal[axis];
        v[axis] = after * normal[axis] + (1 - grip) * (v[axis] - along * normal[axis]);
    }
}

static double from_ball(const double x[3], double normal[3])
{
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = x[axis] - ball[axis];
    const double length = sqrt(dot(normal, normal));
    for (int axis = 0; axis < 3; axis++)
        normal[axis] /= length; /* no particle gets to the middle in a step */
    return length - radius;
}

static void contacts(spring_scene *cloth, double x[N][3], double v[N][3])
{
    const double up[3] = {0, 1, 0};
    double normal[3];
    must(spring_scene_get(cloth, SPRING_POSITION, x[0], 0, 0, N));
    must(spring_scene_get(cloth, SPRING_VELOCITY, v[0], 0, 0, N));
    for (int i = 0; i < N; i++) {
        const double out = from_ball(x[i], normal);
        if (out < skin)
            project(x[i], v[i], normal, skin - out);
        if (x[i][1] < skin) /* the floor last: nothing is ever below it */
            project(x[i], v[i], up, skin - x[i][1]);
    }
    must(spring_scene_set(cloth, SPRING_POSITION, x[0], 0, 0, N));
    must(spring_scene_set(cloth, SPRING_VELOCITY, v[0], 0, 0, N));
}

int main(void)
{
    const spring_grid sheet = {.count = {SIDE, SIDE},
                               .spacing = 0.06,
                               .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                               .stiffness = 30,
                               .damping = 0.03};
    static double x[N][3], v[N][3];
    static spring_link link[6 * N]; /* less than six of each particle */
    size_t particles, links, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, x[0], NULL, link));
    for (int i = 0; i < N; i++) { /* flat, above the ball */
        x[i][0] -= 0.6;
        x[i][2] = x[i][1] - 0.6;
        x[i][1] = 0.8;
    }
    const spring_scene_def def = {.particles = particles,
                                  .links = links,
                                  .position = x[0],
                                  .mass_all = 0.01,
                                  .link = link,
                                  .gravity = {0, -9.81, 0},
                                  .drag = 0.01};
    must(spring_scene_bytes(&def, &bytes));
    void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);
    spring_scene *cloth;
    if (memory == NULL)
        return 1;
    must(spring_scene_init(memory, bytes, &def, &cloth));
    if (!(dt < 0.5 * spring_scene_stable_step(cloth, SPRING_LEAPFROG)))
        return 1;
    for (int step = 1; step <= 4 * 480; step++) {
        must(spring_scene_advance(cloth, SPRING_LEAPFROG, dt, 1));
        contacts(cloth, x, v);
        if (step % 120 != 0)
            continue;
        double lowest = INFINITY, highest = -INFINITY, nearest = INFINITY, normal[3];
        for (int i = 0; i < N; i++) {
            lowest = fmin(lowest, x[i][1]);
            highest = fmax(highest, x[i][1]);
            nearest = fmin(nearest, from_ball(x[i], normal));
        }
        printf("%.2f s  lowest %.4f m  highest %.4f m  from the ball %+.4f m  kinetic %.5f J\n",
               spring_scene_time(cloth), lowest, highest, nearest, spring_scene_energy(cloth).kinetic);
    }
    free(memory);
    return 0;
}
