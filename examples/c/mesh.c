/* SPDX-License-Identifier: MIT */
/*
 * A scene from a mesh file (Wavefront OBJ), with a spring along each edge and across quadrilaterals. Renumbering makes
 * steps faster. Weld vertices at the same place first: the cloth falls apart at seams, where exporters split them.
 *
 *     cc -std=c11 mesh.c -lspringstep -lm -o mesh
 *     ./mesh flag.obj
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { MOST = 100000 }; /* vertices; springs */
static double position[MOST][3], sorted[MOST][3], moved[MOST][3];
static spring_link link[MOST];
static uint8_t pinned[MOST];
static uint32_t order[MOST], work[4 * MOST + 2 * MOST + 1];

/* Sorts links by their ends, so that duplicates from two faces are adjacent. */
static int compare(const void *left, const void *right)
{
    const spring_link *l = left, *r = right;
    return l->a != r->a ? (l->a > r->a) - (l->a < r->a) : (l->b > r->b) - (l->b < r->b);
}

/* Returns false if the file cannot be used. */
static bool read_mesh(FILE *file, size_t *vertices, size_t *links)
{
    char line[512];
    size_t n = *vertices = *links = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        double *x = position[*vertices];
        if (sscanf(line, "v %lf %lf %lf", &x[0], &x[1], &x[2]) == 3 && ++*vertices == MOST)
            return false;
        if (line[0] != 'f' || line[1] != ' ')
            continue;
        long corner[5];
        int corners = 0;
        for (char *at = line + 1; corners < 5; corners++) { /* 7, 7/1 and 7/1/3 are vertex 7, counted from 1 */
            char *end;
            corner[corners] = strtol(at, &end, 10);
            if (end == at)
                break;
            for (at = end; *at != ' ' && *at != '\0'; at++)
                ;
        }
        for (int i = 0; i < corners; i++)
            for (int j = 0; j < i; j++, n++) {
                const long a = corner[i] < corner[j] ? corner[i] : corner[j], b = corner[i] + corner[j] - a;
                if (n == MOST || corners == 5 || a < 1 || b > (long)*vertices || a == b)
                    return false;
                link[n] = (spring_link){.a = (uint32_t)(a - 1), .b = (uint32_t)(b - 1), .stiffness = 300};
            }
    }
    qsort(link, n, sizeof *link, compare);
    for (size_t i = 0; i < n; i++) {
        if (i > 0 && compare(&link[i], &link[i - 1]) == 0)
            continue;
        const double *a = position[link[i].a], *b = position[link[i].b];
        link[*links] = link[i];
        link[(*links)++].rest = sqrt(pow(b[0] - a[0], 2) + pow(b[1] - a[1], 2) + pow(b[2] - a[2], 2));
    }
    return *links > 0;
}

/* Simulates a second in wind; particles at x = 0 are on the pole. */
static bool fly(const char *name, double (*x)[3], size_t vertices, size_t links)
{
    double far = 0, middle[3] = {0};
    size_t bytes;
    for (size_t i = 0; i < vertices; i++)
        pinned[i] = x[i][0] == 0;
    for (size_t i = 0; i < links; i++)
        far += fabs((double)link[i].a - link[i].b) / (double)links;
    const spring_scene_def def = {.particles = vertices,
                                  .links = links,
                                  .position = x[0],
                                  .mass_all = 0.01,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {3, -9.81, 1},
                                  .drag = 0.01};
    spring_scene *flag;
    if (spring_scene_bytes(&def, &bytes) != SPRING_OK)
        return false;
    void *memory = malloc(bytes);
    if (memory == NULL || spring_scene_init(memory, bytes, &def, &flag) != SPRING_OK ||
        !(1.0 / 960 < spring_scene_stable_step(flag, SPRING_LEAPFROG)))
        return false;
    clock_t start = clock();
    if (spring_scene_advance(flag, SPRING_LEAPFROG, 1.0 / 960, 960) != SPRING_OK)
        return false;
    const double us = (double)(clock() - start) / CLOCKS_PER_SEC / 960 * 1e6;
    spring_scene_get(flag, SPRING_POSITION, moved[0], 0, 0, vertices);
    for (size_t i = 0; i < 3 * vertices; i++)
        middle[i % 3] += moved[i / 3][i % 3] / (double)vertices;
    printf("%s: ends %.1f apart  %zu bytes  %.2f us a step  middle after 1 s %+.9f %+.9f %+.9f m\n", name, far, bytes,
           us, middle[0], middle[1], middle[2]);
    free(memory);
    return true;
}

int main(int argc, char **argv)
{
    FILE *file = fopen(argc > 1 ? argv[1] : "flag.obj", "r");
    size_t vertices, links;
    if (file == NULL || !read_mesh(file, &vertices, &links))
        return fprintf(stderr, "the file should be a mesh of triangles and quadrilaterals\n"), 1;
    fclose(file);
    printf("%zu particles, %zu springs, pieces: %zu\n", vertices, links,
           spring_links_components(vertices, links, link, order)); /* too many pieces: seams are not welded */
    if (!fly("as in the file", position, vertices, links) ||
        spring_links_renumber(vertices, links, link, order, NULL, work) != SPRING_OK)
        return 1;
    for (size_t i = 0; i < 3 * vertices; i++) /* order[new index] is the old index; drawing needs it as well */
        sorted[i / 3][i % 3] = position[order[i / 3]][i % 3];
    return fly("renumbered", sorted, vertices, links) ? 0 : 1;
}
