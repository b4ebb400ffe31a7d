/* SPDX-License-Identifier: MIT */
/*
 * A soft block that a plate presses to a tenth of its height. Springs alone do not know inside from outside, so parts of
 * the block stay turned inside out. The callback gives each sixth of a cell a pressure that opposes this:
 *
 *     p = K min(J0 - J, J0) if J < J0, else 0,   J = signed volume / volume at rest,   force = p dV/dx
 *
 * Above J0 the block is as it was. Below 0 the pressure is constant, which limits its stiffness. By Gershgorin's
 * circles, it adds at most 23.3 K spacing = 93 k to the 48 k of the links of stiffness k at a particle. Leapfrog is
 * therefore stable up to sqrt(48/(48 + 93)) = 0.58 of the stable step; 0.52 is 0.9 of this.
 *
 *     cc -std=c11 block.c -lspringstep -lm -o block
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { W = 6, N = W * W * W, CELLS = (W - 1) * (W - 1) * (W - 1), SIXTHS = 6 * CELLS };
static const double spacing = 0.2, stiffness = 1000, mass = 0.1, skin = 0.02; /* [m], [N/m], [kg], [m] */
static const double least = 0.5;                                              /* J0 */
static uint32_t corner[SIXTHS][4];
static double x[N][3];

typedef struct volumes {
    double stiffness; /* [Pa] K */
    int inverted;     /* how many there are */
} volumes;

static void must(spring_status status)
{
    if (status != SPRING_OK)
        exit(fprintf(stderr, "%s\n", spring_status_string(status)));
}

/* Each cell is divided into six tetrahedra around its diagonal. Bits 1, 2 and 4: the neighbour along x, y and z. */
static void divide(void)
{
    static const uint32_t part[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                        {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    for (uint32_t cell = 0, at = 0; cell < CELLS; cell++) {
        const uint32_t i = cell % (W - 1), j = cell / (W - 1) % (W - 1), k = cell / ((W - 1) * (W - 1));
        for (int p = 0; p < 6; p++, at++)
            for (int c = 0; c < 4; c++) {
                const uint32_t bits = part[p][c];
                corner[at][c] = i + (bits & 1) + W * (j + (bits >> 1 & 1) + W * (k + (bits >> 2)));
            }
    }
}

/* J of a tetrahedron. gradient: the derivative of its volume by the corners 1, 2 and 3 */
static double volume(const double *const at[3], const uint32_t c[4], double gradient[3][3])
{
    double e[3][3], sum = 0;
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            e[i][a] = at[a][c[i + 1]] - at[a][c[0]];
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++) {
            const double *p = e[(i + 1) % 3], *q = e[(i + 2) % 3];
            gradient[i][a] = (p[(a + 1) % 3] * q[(a + 2) % 3] - p[(a + 2) % 3] * q[(a + 1) % 3]) / 6;
        }
    for (int a = 0; a < 3; a++)
        sum += e[0][a] * gradient[0][a];
    return sum / (spacing * spacing * spacing / 6);
}

static void resist(void *user, double t, size_t n, const double *const position[3], const double *const velocity[3],
                   double *const force[3])
{
    (void)t, (void)n, (void)velocity;
    volumes *parts = user;
    parts->inverted = 0;
    for (int s = 0; s < SIXTHS; s++) {
        double gradient[3][3];
        const double ratio = volume(position, corner[s], gradient);
        parts->inverted += ratio <= 0;
        const double p = parts->stiffness * fmin(fmax(least - ratio, 0), least);
        for (int i = 0; i < 3; i++)
            for (int a = 0; a < 3; a++) {
                force[a][corner[s][i + 1]] += p * gradient[i][a];
                force[a][corner[s][0]] -= p * gradient[i][a];
            }
    }
}

int main(void)
{
    static spring_link link[16 * N];
    spring_grid cube = {.count = {W, W, W}, .spacing = spacing, .stiffness = stiffness, .damping = 1};
    cube.families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND;
    size_t particles, links, bytes;
    must(spring_grid_size(&cube, &particles, &links));
    divide();
    for (int resists = 0; resists < 2; resists++) {
        volumes parts = {resists ? 4 * stiffness / spacing : 0, 0};
        must(spring_grid_fill(&cube, x[0], NULL, link));
        for (int i = 0; i < N; i++)
            x[i][1] += skin;
        spring_scene_def def = {.flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, .particles = N, .position = x[0]};
        def.links = links, def.link = link, def.mass_all = mass, def.gravity[1] = -9.81, def.drag = 0.02;
        def.colliders = 2, def.particle_radius = skin, def.force = resist, def.user = &parts;
        must(spring_scene_bytes(&def, &bytes));
        spring_scene *s;
        must(spring_scene_init(malloc(bytes), bytes, &def, &s)); /* NULL memory gives SPRING_EINVAL */
        const double dt = 0.52 * spring_scene_stable_step(s, SPRING_LEAPFROG), high = (W - 1) * spacing + 2 * skin;
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{0, 1}}, .friction = 0.5},
                                {.shape = SPRING_PLANE, .at = {0, high}, .axis = {{0, -1}}}};
        for (int up = 0; up < 2; up++) {
            const double duration = up ? 6 : 0.9 * (W - 1) * spacing; /* [s] */
            c[1].at[1] -= spring_scene_time(s), c[1].velocity[1] = up ? 0.5 : -1;
            must(spring_scene_set_colliders(s, c, 2));
            must(spring_scene_advance(s, SPRING_LEAPFROG, dt, (uint64_t)(duration / dt)));
            must(spring_scene_get(s, SPRING_POSITION, x[0], 0, N - 1, 1));
            printf("%s, %s: upper corner at %.3f m, %d of %d parts inside out\n", resists ? "volumes" : "springs alone",
                   up ? "6 s later" : "pressed", x[0][1] - skin, parts.inverted, SIXTHS);
        }
        free(s);
    }
}
