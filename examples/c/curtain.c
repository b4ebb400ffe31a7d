/* SPDX-License-Identifier: MIT */
/*
 * A curtain that tears. Its lower edge is pulled; links that are stretched too far break, first along a weak seam. The
 * program counts the pieces, and cuts the tethers between them.
 *
 *     cc -std=c11 curtain.c -lspringstep -lm -o curtain
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { W = 40, H = 25, N = W * H, MOST_LINKS = 5 * N, STEPS = 30 };
enum { HAND = W / 2 - 3, HELD = 6 };  /* the pulled particles of the lowest row */
enum { SEAM = 12 * W };               /* the seam is below this particle */
static const double frame = 1.0 / 60; /* [s] */

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

int main(void)
{
    static double x[N][3];
    static uint8_t pinned[N];
    static spring_link link[MOST_LINKS];
    const spring_grid sheet = {.count = {W, H},
                               .spacing = 0.05,
                               .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                               .stiffness = 400,
                               .damping = 0.1,
                               .pinned = SPRING_GRID_LAST_Y};
    size_t particles, links, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    must(spring_grid_fill(&sheet, x[0], pinned, link));
    static double limit[MOST_LINKS]; /* length over rest length at which a link breaks; tethers do not */
    for (size_t i = 0; i < MOST_LINKS; i++)
        limit[i] = i >= links ? INFINITY : (link[i].a < SEAM) != (link[i].b < SEAM) ? 1.2 : 1.6;
    spring_scene_def def = {.flags = SPRING_SCENE_EDITABLE | SPRING_SCENE_TENSION_ONLY,
                            .particles = particles,
                            .links = links,
                            .position = x[0],
                            .mass_all = 0.005,
                            .pinned = pinned,
                            .link = link,
                            .gravity = {0, -9.81, 0},
                            .drag = 0.005};
    static uint32_t work[2 * N];
    static double distance[2 * N];
    size_t tethers = MOST_LINKS - links; /* to the rail; looser than the seam, so that it tears first */
    must(spring_links_tethers(&def, 0.05, 0.5, link + links, &tethers, work, distance));
    def.links += tethers;
    for (int i = HAND; i < HAND + HELD; i++)
        pinned[i] = 1;
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    spring_scene *curtain;
    if (memory == NULL)
        return 1;
    must(spring_scene_init(memory, bytes, &def, &curtain));
    if (!(frame / STEPS < 0.45 * spring_scene_stable_step(curtain, SPRING_LEAPFROG)))
        return 1;

    size_t torn_links = 0;
    for (int i = 1; i <= 180; i++) {
        for (int k = HAND; k < HAND + HELD && i <= 120; k++) { /* pull for two seconds, down and towards the viewer */
            const double target[] = {x[k][0], x[k][1] - 0.4 * i * frame, x[k][2] + 0.2 * i * frame};
            must(spring_scene_drive(curtain, (size_t)k, i < 120 ? target : NULL, frame));
        }
        must(spring_scene_advance(curtain, SPRING_LEAPFROG, frame / STEPS, STEPS));

        static uint32_t torn[MOST_LINKS];
        size_t count;
        must(spring_scene_tear(curtain, 0, limit, torn, MOST_LINKS, &count));
        for (size_t k = 0; k < count; k++) /* mark torn links in our copy, for drawing and for counting the pieces */
            link[torn[k]].stiffness = link[torn[k]].damping = 0;
        torn_links += count;
        static uint32_t piece[N];
        const size_t pieces = spring_links_components(particles, links, link, piece);
        for (size_t k = links; k < def.links; k++) /* tethers of a piece that has come off */
            if (piece[link[k].a] != piece[link[k].b] && link[k].stiffness > 0) {
                link[k].stiffness = 0;
                must(spring_scene_set_link(curtain, k, &link[k]));
            }
        if (i % 30 != 0)
            continue;
        size_t in_hand = 0;
        for (int k = 0; k < N; k++)
            in_hand += piece[k] == piece[HAND];
        const spring_scene_energies e = spring_scene_energy(curtain);
        printf("%.1f s  torn links %zu  pieces %zu  particles in the hand's piece %zu  elastic energy %.3f J\n",
               spring_scene_time(curtain), torn_links, pieces, in_hand, e.elastic);
    }
    free(memory);
    return 0;
}
