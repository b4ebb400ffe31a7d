/* SPDX-License-Identifier: MIT */
/*
 * A blob in the plane: a ring of springs with gas inside. It falls on the ground, and a bar presses it flat. The callback
 * pushes each edge outwards with the pressure p = K (1 - A/A0), where A is the area and A0 the area at rest.
 *
 *     cc -std=c11 blob.c -lspringstep -lm -o blob
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 40 };
static const double frame = 1.0 / 60, radius = 0.5, mass = 0.05; /* [s], [m], [kg] of a particle */
static double x[N][2];

typedef struct gas {
    double stiffness; /* [N/m] K */
    double area;      /* [m^2] A0 */
} gas;

static void must(spring_status status)
{
    if (status != SPRING_OK)
        exit(fprintf(stderr, "%s\n", spring_status_string(status)));
}

static double area_of(size_t n, const double *px, const double *py)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += px[i] * py[(i + 1) % n] - px[(i + 1) % n] * py[i];
    return sum / 2;
}

/* The force on a particle is p times the derivative of the area: half of the edges to both neighbours, turned outwards. */
static void press(void *user, double t, size_t n, const double *const position[3], const double *const velocity[3],
                  double *const force[3])
{
    (void)t, (void)velocity;
    const gas *g = user;
    const double *px = position[0], *py = position[1];
    const double p = g->stiffness * (1 - area_of(n, px, py) / g->area);
    for (size_t i = 0; i < n; i++) {
        const size_t next = (i + 1) % n, before = (i + n - 1) % n;
        force[0][i] += p / 2 * (py[next] - py[before]);
        force[1][i] -= p / 2 * (px[next] - px[before]);
    }
}

/* The bar comes down from 2 s to 2.5 s, and goes up again. */
static double bar_at(double t)
{
    return t < 2 || t > 4 ? 2 : t < 2.5 ? 2 - 3.4 * (t - 2) : t < 3.5 ? 0.3 : 0.3 + 3.4 * (t - 3.5);
}

int main(void)
{
    static spring_link link[N];
    const double pi = acos(-1), edge = 2 * radius * sin(pi / N);
    for (uint32_t i = 0; i < N; i++) {
        x[i][0] = radius * cos(2 * pi * i / N);
        x[i][1] = 1 + radius * sin(2 * pi * i / N);
        link[i] = (spring_link){i, (i + 1) % N, edge, 1000, 0.5, 0};
    }
    gas inside = {400, N * radius * radius / 2 * sin(2 * pi / N)};
    spring_scene_def def = {.axes = 2, .flags = SPRING_SCENE_FORCE_IGNORES_VELOCITY, .particles = N, .links = N};
    def.position = x[0], def.link = link, def.mass_all = mass, def.gravity[1] = -9.81, def.drag = 0.05;
    def.force = press, def.user = &inside, def.colliders = 2;
    size_t bytes;
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *s;
    must(spring_scene_init(memory, bytes, &def, &s)); /* NULL memory gives SPRING_EINVAL */
    /* The gas adds the stiffness K |dA/dx|^2/A0 to that of the links: see docs/games.md, Steps. */
    const double stable = spring_scene_stable_step(s, SPRING_LEAPFROG);
    const double kappa = inside.stiffness * N * edge * edge / inside.area;
    const double limit = 1 / sqrt(1 / (stable * stable) + kappa / (4 * mass));
    const uint64_t steps = (uint64_t)ceil(frame / (0.9 * limit));
    for (int i = 0; i <= 360; i++) {
        if (i % 20 == 0) {
            double px[N], py[N], low = INFINITY, high = -INFINITY, left = INFINITY, right = -INFINITY;
            must(spring_scene_get(s, SPRING_POSITION, x[0], 0, 0, N));
            for (int k = 0; k < N; k++) {
                px[k] = x[k][0], py[k] = x[k][1];
                left = fmin(left, px[k]), right = fmax(right, px[k]);
                low = fmin(low, py[k]), high = fmax(high, py[k]);
            }
            printf("%.2f s  %.3f m wide  %.3f m high  %.3f m above the ground  area %.3f of that at rest\n",
                   spring_scene_time(s), right - left, high - low, low, area_of(N, px, py) / inside.area);
        }
        spring_collider c[2] = {{.shape = SPRING_PLANE, .axis = {{0, 1}}, .friction = 0.5},
                                {.shape = SPRING_PLANE, .axis = {{0, -1}}, .friction = 0.5}};
        c[1].at[1] = bar_at(i * frame);
        c[1].velocity[1] = (bar_at((i + 1) * frame) - c[1].at[1]) / frame;
        must(spring_scene_set_colliders(s, c, 2));
        must(spring_scene_advance(s, SPRING_LEAPFROG, frame / (double)steps, steps));
    }
    free(memory);
    return 0;
}
