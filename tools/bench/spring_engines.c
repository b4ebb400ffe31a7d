/* SPDX-License-Identifier: MIT */
/*
 * spring-engines: the same sheet in the library and in physics engines for games, measured in one run. See rows.h
 * for the method.
 *
 * A sheet, pinned along two edges, hangs under gravity, with damped structural, shear and bend links. Both use the same
 * step, half the stable step.
 */
#include <math.h>
#include <stdlib.h>

#include "common/cli.h"
#include "common/timing.h"
#include "engine.h"
#include "rows.h"

static const char *const engines[] = {"bullet", "chipmunk", NULL};
static const physics_engine *const engine_of[] = {&engine_bullet, &engine_chipmunk};
static const uint32_t sides[] = {35, 128};
static int only_engine = -1;
static uint64_t substeps = 16;
static bool quick;

static const cli_option options[] = {
    {"engine", CLI_CHOICE, .choice = &only_engine, .choices = engines, .value = "NAME", .help = "bullet or chipmunk"},
    {"substeps", CLI_COUNT, .count = &substeps, .value = "N", .help = "steps per call", .least = 1, .most = 1000},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer and shorter samples; takes a few seconds"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-engines",
    .summary = "Compare a sheet in the library with the same sheet in physics engines of games.",
    .details =
        "The sheets have 35 x 35 and 128 x 128 particles with structural, shear and bend springs, all damped.\n"
        "They are pinned along two edges, under gravity. The library uses leapfrog. Both take the same steps.\n\n"
        "bullet: a soft body in a world of its own, with one iteration of its position solver per step. The\n"
        "solver moves both ends of a link to its length, so the material is different, but the work is\n"
        "equivalent to one force per link. Its links are in random order, as in Bullet's examples, which is\n"
        "the fastest order.\n\n"
        "chipmunk: damped springs between bodies, with one iteration per step. The forces are the same as in\n"
        "the library, on two axes. The library then also uses two axes. Nothing collides in either engine. A\n"
        "comment line of the table records whether Chipmunk was compiled with assertions, as Debian's package\n"
        "is. They make it slower. tools/bench/optimised builds it without assertions.\n\n"
        "Times are medians of alternating samples of processor time. spread is the distance between the\n"
        "quartiles over the median, the larger of both. verdict is ok, noisy (spread above 0.05: the machine\n"
        "was busy, and the row proves nothing) or above_goal (speedup below 15). The exit status does not\n"
        "depend on the verdict.",
    .columns = "engine precision links substeps speedup spread verdict engine_ns our_ns",
    .meaning = "precision is the precision of the engine. The library uses double. speedup is engine_ns/our_ns.\n"
               "engine_ns and our_ns are per link and step.",
    .shown = {"links", "speedup"},
    .examples = {"--quick", "--quick --engine bullet", "--quick --engine chipmunk --substeps 4 -o engines.tsv"},
    .options = options,
};

static const double least_speedup = 15; /* also in the help text */
static const double most_distance =
    1; /* [m] of the middle of an engine's sheet from the library's; materials may differ */

/* ------------------------------------------------------------------------------------------------------- the sheets */

typedef struct sheet {
    const physics_engine *engine;
    void *world; /* of the engine */
    spring_scene *scene;
    double dt; /* [s] */
    size_t particles;
} sheet;

static void *allocate(size_t bytes)
{
    const size_t align = SPRING_SCENE_ALIGN;
    void *memory = aligned_alloc(align, (bytes + align - 1) / align * align);
    if (memory == NULL)
        cli_fail(CLI_FAILED, "no memory for a sheet");
    return memory;
}

static void check(spring_status status)
{
    if (status != SPRING_OK)
        cli_fail(CLI_FAILED, "a sheet: %s", spring_status_string(status));
}

static spring_scene *scene_of(const spring_scene_def *def)
{
    size_t bytes;
    spring_scene *scene;
    check(spring_scene_bytes(def, &bytes));
    check(spring_scene_init(allocate(bytes), bytes, def, &scene));
    return scene;
}

/* Removes links between two pinned particles, which Chipmunk rejects. */
static size_t movable(spring_link *link, size_t links, const uint8_t *pinned)
{
    size_t kept = 0;
    for (size_t i = 0; i < links; i++)
        if (pinned[link[i].a] == 0 || pinned[link[i].b] == 0)
            link[kept++] = link[i];
    return kept;
}

static sheet make(const physics_engine *engine, uint32_t side, size_t *links)
{
    const spring_grid grid = {
        .count = {side, side},
        .axes = engine->axes,
        .spacing = 0.1,
        .stretch = 1.05, /* otherwise it crumples, which needs shorter steps */
        .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR | SPRING_GRID_BEND,
        .stiffness = 20000,
        .damping = 0.5,
        .pinned = SPRING_GRID_FIRST_Y | SPRING_GRID_LAST_Y,
    };
    size_t particles;
    check(spring_grid_size(&grid, &particles, links));
    double *position = allocate(particles * engine->axes * sizeof *position);
    uint8_t *pinned = allocate(particles);
    spring_link *link = allocate(*links * sizeof *link);
    check(spring_grid_fill(&grid, position, pinned, link));
    *links = movable(link, *links, pinned);
    const spring_scene_def def = {
        .axes = engine->axes,
        .methods = 1u << SPRING_LEAPFROG,
        .particles = particles,
        .links = *links,
        .position = position,
        .mass_all = 0.1,
        .pinned = pinned,
        .link = link,
        .gravity = {0.3, -9.81, -0.5},
    };
    spring_scene *scene = scene_of(&def);
    void *world = engine->make(&def);
    if (world == NULL)
        cli_fail(CLI_FAILED, "no memory for a sheet of %s", engine->name);
    free(position);
    free(pinned);
    free(link);
    return (sheet){engine, world, scene, 0.5 * spring_scene_stable_step(scene, SPRING_LEAPFROG), particles};
}

/* Rejects an engine whose sheet has exploded or does not move. */
static void check_engine(const sheet *s)
{
    double from[3], to[3];
    const size_t middle = s->particles / 2;
    spring_scene_get(s->scene, SPRING_POSITION, from, 0, middle, 1);
    s->engine->position(s->world, middle, to);
    for (uint32_t a = 0; a < s->engine->axes; a++)
        if (!(fabs(from[a] - to[a]) < most_distance))
            cli_fail(CLI_FAILED, "%s: the middle is %.3g m from where it should be", s->engine->name, from[a] - to[a]);
}

static double run(const bench_row *row, int which, uint64_t calls)
{
    const sheet *s = row->subject;
    const double begin = timing_busy();
    if (which == 0)
        for (; calls > 0; calls--)
            check(spring_scene_advance(s->scene, SPRING_LEAPFROG, s->dt, row->steps));
    else
        for (uint64_t i = 0; i < calls * row->steps; i++)
            s->engine->step(s->world, s->dt);
    return timing_busy() - begin;
}

static void write_row(cli_table *table, const physics_engine *engine, uint32_t side)
{
    size_t links;
    const sheet s = make(engine, side, &links);
    const bench_row row = {.count = links, .steps = substeps, .limits = {engine->name}, .time = run, .subject = &s};
    const bench_times t = bench_measure(&row, quick);
    check_engine(&s);
    const double speedup = t.limit / t.ours;
    cli_row(table, "%s\t%s\t%zu\t%" PRIu64 "\t%.4g\t%.2g\t%s\t%.4g\t%.4g", engine->name, engine->precision, links,
            substeps, speedup, t.spread,
            bench_is_noisy(t.spread)   ? "noisy"
            : speedup >= least_speedup ? "ok"
                                       : "above_goal",
            t.limit, t.ours);
}

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    cli_table *table = cli_open_output();
    timing_stamp(table);
    for (int e = 0; engines[e] != NULL; e++)
        if (only_engine < 0 || only_engine == e)
            cli_comment(table, "%s: %s", engines[e], engine_of[e]->version());
    cli_columns(table, program.columns);
    for (int e = 0; engines[e] != NULL; e++)
        for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++)
            if (only_engine < 0 || only_engine == e)
                write_row(table, engine_of[e], sides[i]);
    cli_finish();
    return 0;
}
