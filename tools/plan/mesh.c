/* SPDX-License-Identifier: MIT */
/* Scenes from mesh files; see mesh.h. */
#define _POSIX_C_SOURCE 200809L /* getc_unlocked() */
#include "mesh.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"

enum { longest_line = 1 << 24 }; /* [bytes] fits an element of two million vertices */

static const char blank[] = " \t\r\n";

/* The contents of a file read so far. */
typedef struct mesh {
    const char *path;
    size_t line;
    size_t vertices, links, vertex_capacity, link_capacity, corner_capacity;
    double (*position)[3]; /* [vertex_capacity] */
    spring_link *link;     /* [link_capacity] */
    uint32_t *corner;      /* [corner_capacity] of the current element */
} mesh;

static _Noreturn void refuse(const mesh *m, const char *what)
{
    cli_fail(CLI_USAGE, "--mesh: \"%s\", line %zu: %s", m->path, m->line, what);
}

static void *resized(void *array, size_t count, size_t size)
{
    void *memory = realloc(array, count * size);
    if (memory == NULL)
        cli_fail(CLI_FAILED, "no memory for this --mesh");
    return memory;
}

/* Returns the array with room for at least one more entry. */
static void *grown(void *array, size_t *capacity, size_t count, size_t size)
{
    if (count < *capacity)
        return array;
    *capacity = 2 * count + 256;
    return resized(array, *capacity, size);
}

static bool ends_word(char c)
{
    return strchr(blank, c) != NULL; /* or the line */
}

/* Ignores a weight or a colour after the coordinates. */
static void add_vertex(mesh *m, const char *at)
{
    m->position = grown(m->position, &m->vertex_capacity, m->vertices, sizeof *m->position);
    for (int axis = 0; axis < 3; axis++) {
        char *end;
        const double x = strtod(at, &end);
        if (end == at || !ends_word(*end) || !isfinite(x))
            refuse(m, "a vertex should have three finite numbers");
        m->position[m->vertices][axis] = x;
        at = end;
    }
    m->vertices++;
}

static void add_link(mesh *m, uint32_t a, uint32_t b)
{
    if (a == b)
        refuse(m, "an edge should join two vertices");
    m->link = grown(m->link, &m->link_capacity, m->links, sizeof *m->link);
    m->link[m->links++] = (spring_link){.a = a < b ? a : b, .b = a < b ? b : a};
}

/* 7, 7/1, 7//3 and 7/1/3 refer to the seventh vertex, -1 to the last vertex so far. */
static uint32_t read_corner(const mesh *m, const char **at)
{
    char *end;
    const long long number = strtoll(*at, &end, 10), count = (long long)m->vertices;
    if (end == *at || number == 0 || number > count || number < -count || (*end != '/' && !ends_word(*end)))
        refuse(m, "a corner should be the number of a vertex above");
    *at = end + strcspn(end, blank);
    return (uint32_t)(number > 0 ? number - 1 : count + number);
}

static void add_edges(mesh *m, const char *at, bool face)
{
    size_t corners = 0;
    for (; at += strspn(at, blank), *at != '\0'; corners++) {
        m->corner = grown(m->corner, &m->corner_capacity, corners, sizeof *m->corner);
        m->corner[corners] = read_corner(m, &at);
    }
    if (corners < (face ? 3 : 2))
        refuse(m, face ? "a face should have three corners" : "a line should have two ends");
    for (size_t i = 1; i < corners; i++)
        add_link(m, m->corner[i - 1], m->corner[i]);
    if (face)
        add_link(m, m->corner[corners - 1], m->corner[0]);
    if (face && corners == 4) {
        add_link(m, m->corner[0], m->corner[2]);
        add_link(m, m->corner[1], m->corner[3]);
    }
}

static void read_line(mesh *m, char *line)
{
    line[strcspn(line, "#")] = '\0';
    const char *word = line + strspn(line, blank);
    const size_t length = strcspn(word, blank);
    if (length == 1 && word[0] == 'v')
        add_vertex(m, word + 1);
    else if (length == 1 && (word[0] == 'f' || word[0] == 'l'))
        add_edges(m, word + 1, word[0] == 'f');
}

/* Reads the next line without its end; false: there are no more. */
static bool next_line(mesh *m, FILE *file, char **line, size_t *capacity)
{
    int c = getc_unlocked(file);
    if (c == EOF)
        return false;
    m->line++;
    size_t length = 0;
    for (; c != EOF && c != '\n'; c = getc_unlocked(file)) {
        if (c == '\0')
            refuse(m, "the file should be text without NUL bytes");
        if (length == longest_line)
            refuse(m, "a line should not be longer than 16 MiB");
        *line = grown(*line, capacity, length, 1);
        (*line)[length++] = (char)c;
    }
    *line = grown(*line, capacity, length, 1);
    (*line)[length] = '\0';
    return true;
}

static void read_file(mesh *m)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    FILE *file = fopen(m->path, "r");
    if (file == NULL)
        cli_fail(CLI_IO, "--mesh: cannot read \"%s\": %s", m->path, strerror(errno));
    char *line = NULL;
    size_t capacity = 0;
    while (next_line(m, file, &line, &capacity)) {
        const bool marked = m->line == 1 && strncmp(line, byte_order_mark, 3) == 0;
        read_line(m, marked ? line + 3 : line);
    }
    if (!feof(file))
        cli_fail(CLI_IO, "--mesh: cannot read \"%s\": %s", m->path, strerror(errno));
    free(line);
    free(m->corner);
    fclose(file);
    if (m->links == 0)
        cli_fail(CLI_USAGE, "--mesh: \"%s\" should have faces or lines", m->path);
}

static int by_ends(const void *left, const void *right)
{
    const spring_link *l = left, *r = right;
    return l->a != r->a ? (l->a > r->a) - (l->a < r->a) : (l->b > r->b) - (l->b < r->b);
}

/* Removes duplicate links: an edge of two faces is read twice. */
static void join_once(mesh *m, const mesh_settings *settings)
{
    qsort(m->link, m->links, sizeof *m->link, by_ends);
    size_t kept = 0;
    for (size_t i = 0; i < m->links; i++) {
        if (i > 0 && by_ends(&m->link[i], &m->link[i - 1]) == 0)
            continue;
        const double *a = m->position[m->link[i].a], *b = m->position[m->link[i].b];
        m->link[kept] = m->link[i];
        m->link[kept].rest = hypot(hypot(b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
        if (!isfinite(m->link[kept].rest))
            cli_fail(CLI_USAGE, "--mesh: \"%s\": the length of the edge between vertices %zu and %zu should be finite",
                     m->path, (size_t)m->link[i].a + 1, (size_t)m->link[i].b + 1);
        m->link[kept].stiffness = settings->stiffness;
        m->link[kept].damping = settings->damping;
        kept++;
    }
    m->links = kept;
}

/* Renumbers particles and links for locality in memory. */
static double *renumber(mesh *m)
{
    uint32_t *order = resized(NULL, m->vertices, sizeof *order);
    uint32_t *work = resized(NULL, 4 * m->vertices + 2 * m->links + 1, sizeof *work);
    if (spring_links_renumber(m->vertices, m->links, m->link, order, NULL, work) != SPRING_OK)
        cli_fail(CLI_USAGE, "--mesh: \"%s\" has more vertices or edges than a scene can have", m->path);
    double *position = resized(NULL, 3 * m->vertices, sizeof *position);
    for (size_t i = 0; i < m->vertices; i++)
        memcpy(&position[3 * i], m->position[order[i]], sizeof m->position[0]);
    free(order);
    free(work);
    return position;
}

/* Pins the highest linked vertices, and all vertices without links. */
static uint8_t *pin_highest(const mesh *m, const double *position)
{
    enum { free_to_move, held };
    uint8_t *pinned = resized(NULL, m->vertices, sizeof *pinned);
    memset(pinned, held, m->vertices);
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < m->links; i++) {
        const uint32_t ends[2] = {m->link[i].a, m->link[i].b};
        for (int end = 0; end < 2; end++) {
            pinned[ends[end]] = free_to_move;
            low = fmin(low, position[3 * ends[end] + 1]);
            high = fmax(high, position[3 * ends[end] + 1]);
        }
    }
    const double rounding = 1e-6; /* relative rounding of the numbers in a file */
    bool moves = false;
    for (size_t i = 0; i < m->vertices; i++) {
        if (position[3 * i + 1] >= high - (rounding * high - rounding * low)) /* high - low may overflow */
            pinned[i] = held;
        moves = moves || pinned[i] == free_to_move;
    }
    if (!moves)
        cli_fail(CLI_USAGE,
                 "--mesh: \"%s\" is level; some of its vertices should be lower than others, because the "
                 "highest are pinned (y is up)",
                 m->path);
    return pinned;
}

preset mesh_read(const char *path, const mesh_settings *settings)
{
    mesh m = {.path = path};
    read_file(&m);
    join_once(&m, settings);
    preset scene = {.position = renumber(&m), .link = m.link};
    free(m.position);
    scene.pinned = pin_highest(&m, scene.position);
    scene.def = (spring_scene_def){.axes = 3,
                                   .particles = m.vertices,
                                   .links = m.links,
                                   .position = scene.position,
                                   .mass_all = settings->mass,
                                   .pinned = scene.pinned,
                                   .link = scene.link,
                                   .gravity = {0, -9.81, 0},
                                   .drag = settings->drag};
    return scene;
}
