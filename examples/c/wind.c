/* SPDX-License-Identifier: MIT */
/*
 * A flag in wind. Once per frame, the force of the air on each triangle is computed from the state. The scene applies
 * these forces during all steps of the frame.
 *
 *     cc -std=c11 wind.c -lspringstep -lm -o wind
 *
 * The air pushes a triangle along its normal n with the force c (u.n) n, where u is the velocity of the air relative to
 * the triangle and c = density/2 area |u.n|. A force that is held too long reverses velocities and adds energy. This
 * cannot happen, at any density, with c/(1 + c T/m) instead of c, where T is the frame time and m the mass of the
 * triangle.
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { W = 24, H = 16, N = W * H, STEPS = 16 };
static const double frame = 1.0 / 60, mass = 0.004; /* [s], [kg] of a particle */
static const double density = 1.2 * 1.2;            /* [kg/m^3] of air, times the drag coefficient of a plate */
static double x[N][3], v[N][3], force[N][3];

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

static void push_triangle(int a, int b, int c, const double air[3])
{
    double e[3], f[3], u[3];
    for (int axis = 0; axis < 3; axis++) {
        e[axis] = x[b][axis] - x[a][axis];
        f[axis] = x[c][axis] - x[a][axis];
        u[axis] = air[axis] - (v[a][axis] + v[b][axis] + v[c][axis]) / 3;
    }
    double n[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
    const double twice_area = sqrt(dot(n, n));
    for (int axis = 0; axis < 3 && twice_area > 0; axis++)
        n[axis] /= twice_area;
    const double speed = dot(u, n), held = density / 2 * twice_area / 2 * fabs(speed);
    const double limited = held / (1 + held * frame / (mass / 2)); /* there are two triangles per particle */
    for (int axis = 0; axis < 3; axis++) {
        const double third = limited * speed * n[axis] / 3;
        force[a][axis] += third, force[b][axis] += third, force[c][axis] += third;
    }
}

static void blow(spring_scene *flag, const double air[3])
{
    must(spring_scene_get(flag, SPRING_POSITION, x[0], 0, 0, N));
    must(spring_scene_get(flag, SPRING_VELOCITY, v[0], 0, 0, N));
    for (int i = 0; i < N; i++)
        force[i][0] = force[i][1] = force[i][2] = 0;
    for (int i = 0; i + W < N; i++)
        if (i % W < W - 1) {
            push_triangle(i, i + 1, i + W + 1, air);
            push_triangle(i, i + W + 1, i + W, air);
        }
    must(spring_scene_set(flag, SPRING_FORCE, force[0], 0, 0, N));
}

static void fly(const char *name, const double air[3])
{
    static spring_link link[6 * N]; /* fewer than six per particle */
    static uint8_t pinned[N];
    const spring_grid sheet = {.count = {W, H},
                               .spacing = 0.06,
                               .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
                               .stiffness = 60,
                               .pinned = SPRING_GRID_FIRST_X};
    size_t particles, links, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, x[0], pinned, link));
    for (int i = 0; i < N; i++) /* initial disturbance */
        v[i][0] = v[i][1] = 0, v[i][2] = pinned[i] ? 0 : 3 * sin(5 * x[i][0]);
    const spring_scene_def def = {.flags = SPRING_SCENE_FORCES,
                                  .particles = particles,
                                  .links = links,
                                  .position = x[0],
                                  .velocity = v[0],
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, -9.81, 0}};
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *flag;
    if (memory == NULL)
        exit(1);
    must(spring_scene_init(memory, bytes, &def, &flag));
    double least = INFINITY, gain = 0;
    for (int i = 0; i <= 300; i++) {
        const spring_scene_energies e = spring_scene_energy(flag);
        const double energy = e.kinetic + e.elastic + e.gravity, *tip = x[N - 1];
        least = fmin(least, energy);
        gain = fmax(gain, energy - least);
        if (i % 60 == 0)
            printf("%s  %.1f s  energy %.4f J  gained at most %.1e J  tip %+.2f %+.2f %+.2f m\n", name,
                   spring_scene_time(flag), energy, gain, tip[0], tip[1], tip[2]);
        blow(flag, air);
        must(spring_scene_advance(flag, SPRING_LEAPFROG, frame / STEPS, STEPS));
    }
    free(memory);
}

int main(void)
{
    fly("still", (const double[3]){0, 0, 0});
    fly("wind", (const double[3]){7.2, 0, 3.6});
    return 0;
}
