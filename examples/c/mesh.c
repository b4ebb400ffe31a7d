/* SPDX-License-Identifier: MIT */
/*
 * A flag from a triangle mesh for drawing (Wavefront OBJ). Vertices that are split at seams are welded, edges become
 * springs, and pairs of triangles resist bending. Renumbering makes steps faster.
 *
 *     cc -std=c11 mesh.c -lspringstep -lm -o mesh
 *     ./mesh flag.obj
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST = 50000 }; /* vertices; triangles */
static double vertex[MOST][3], position[MOST][3], sorted[MOST][3], moved[MOST][3];
static uint32_t triangle[MOST][3], particle_of[MOST], order[MOST], number[MOST], work[10 * MOST];
static spring_link link[3 * MOST];
static spring_weighted_link bend[3 * MOST];
static uint8_t pinned[MOST];

/* Reads vertices and triangles. Faces with more corners are divided. Returns false if the file cannot be used. */
static bool read_mesh(FILE *file, size_t *vertices, size_t *triangles)
{
    char line[512];
    *vertices = *triangles = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        double *x = vertex[*vertices];
        if (sscanf(line, "v %lf %lf %lf", &x[0], &x[1], &x[2]) == 3 && ++*vertices == MOST)
            return false;
        uint32_t corner[3];
        char *at = line + 1, *end;
        for (int i = 0; line[0] == 'f' && line[1] == ' '; i++) { /* 7, 7/1 and 7/1/3 are vertex 7, counted from 1 */
            const long index = strtol(at, &end, 10);
            if (end == at)
                break;
            if (index < 1 || index > MOST || *triangles == MOST)
                return false;
            corner[i < 2 ? i : 2] = (uint32_t)(index - 1);
            if (i >= 2) {
                memcpy(triangle[(*triangles)++], corner, sizeof corner);
                corner[1] = corner[2];
            }
            at = end + strcspn(end, " ");
        }
    }
    return *triangles > 0;
}

/* Simulates a second in wind; particles at x = 0 are on the pole. */
static bool fly(const char *name, double (*x)[3], size_t particles, size_t links, size_t triangles)
{
    double far = 0, middle[3] = {0};
    size_t bytes = 0, bends = 3 * MOST;
    for (size_t i = 0; i < particles; i++)
        pinned[i] = x[i][0] == 0;
    for (size_t i = 0; i < links; i++)
        far += fabs((double)link[i].a - link[i].b) / (double)links;
    if (spring_bend_mesh(particles, x[0], triangles, triangle[0], pinned, 1e-4, 0, bend, &bends, work) != SPRING_OK)
        return false;
    spring_scene_def def = {.particles = particles, .position = x[0], .mass_all = 0.01, .pinned = pinned};
    def.links = links, def.link = link, def.weighted_links = bends, def.weighted_link = bend;
    def.gravity[0] = 3, def.gravity[1] = -9.81, def.gravity[2] = 1, def.drag = 0.01;
    spring_scene *flag;
    void *memory = spring_scene_bytes(&def, &bytes) == SPRING_OK ? malloc(bytes) : NULL;
    if (spring_scene_init(memory, bytes, &def, &flag) != SPRING_OK ||
        !(1.0 / 960 < spring_scene_stable_step(flag, SPRING_LEAPFROG)))
        return false;
    clock_t start = clock();
    if (spring_scene_advance(flag, SPRING_LEAPFROG, 1.0 / 960, 960) != SPRING_OK)
        return false;
    const double us = (double)(clock() - start) / CLOCKS_PER_SEC / 960 * 1e6;
    spring_scene_get(flag, SPRING_POSITION, moved[0], 0, 0, particles);
    for (size_t i = 0; i < 3 * particles; i++)
        middle[i % 3] += moved[i / 3][i % 3] / (double)particles;
    printf("%s: ends %.1f apart  %zu bytes  %.2f us a step  middle after 1 s %+.9f %+.9f %+.9f m\n", name, far, bytes,
           us, middle[0], middle[1], middle[2]);
    free(memory);
    return true;
}

/* weld: [m] vertices that are not farther apart become one particle; negative: none do */
static bool connect(size_t vertices, size_t triangles, double weld, size_t *particles, size_t *links)
{
    *links = 3 * MOST;
    if (spring_links_from_mesh(vertices, vertex[0], triangles, triangle[0], weld, particle_of, particles, link, links,
                               work) != SPRING_OK)
        return false;
    for (size_t i = 0; i < *links; i++)
        link[i].stiffness = 300;
    printf("%zu vertices %s: %zu particles, %zu springs, pieces: %zu\n", vertices, weld < 0 ? "as they are" : "welded",
           *particles, *links, spring_links_components(*particles, *links, link, order));
    return true;
}

int main(int argc, char **argv)
{
    FILE *file = fopen(argc > 1 ? argv[1] : "flag.obj", "r");
    size_t vertices, triangles, particles, links;
    if (file == NULL || !read_mesh(file, &vertices, &triangles) ||
        !connect(vertices, triangles, -1, &particles, &links) ||
        !connect(vertices, triangles, 1e-6, &particles, &links))
        return fprintf(stderr, "the file should be a mesh whose triangles have an area\n"), 1;
    fclose(file);
    for (size_t i = vertices; i-- > 0;) /* a particle is at its first vertex; draw vertex i at particle_of[i] */
        memcpy(position[particle_of[i]], vertex[i], sizeof vertex[i]);
    for (size_t i = 0; i < 3 * triangles; i++)
        triangle[i / 3][i % 3] = particle_of[triangle[i / 3][i % 3]];
    if (!fly("as in the file", position, particles, links, triangles) ||
        spring_links_renumber(particles, links, link, order, NULL, work) != SPRING_OK)
        return 1;
    for (uint32_t i = 0; i < particles; i++) { /* order[new index] is the old index; drawing needs it as well */
        memcpy(sorted[i], position[order[i]], sizeof sorted[i]);
        number[order[i]] = i;
    }
    for (size_t i = 0; i < 3 * triangles; i++)
        triangle[i / 3][i % 3] = number[triangle[i / 3][i % 3]];
    return fly("renumbered", sorted, particles, links, triangles) ? 0 : 1;
}
