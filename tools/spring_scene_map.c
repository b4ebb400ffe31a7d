/* SPDX-License-Identifier: MIT */
/*
 * spring-scene-map: the stability and energy error of each preset with each method, for 1, 2, 3 ... steps per frame of
 * 1/60 s.
 *
 * Method    Each scene of spring-scene runs for four seconds. The reference is leapfrog with a sixteenth of its stable
 *           step. Errors of the energy at each frame are relative to the largest kinetic energy of the reference.
 *           The error of the reference is below 1/256 (z^2/4 of the energy of a mode, z = omega dt <= 2/16).
 */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/timing.h"
#include "scenes/scene_run.h"
#include "scenes/start.h"

static const double frame_time = 1.0 / 60; /* [s] */

static int only_scene = -1, only_method = -1;
static bool quick, timed;
static const char *map_file;

static const cli_option options[] = {
    {"scene", CLI_CHOICE, .choice = &only_scene, .choices = preset_names, .value = "S"},
    {"method", CLI_METHOD, .choice = &only_method, .offers = cli_for_scenes, .value = "M"},
    {"quick", CLI_FLAG, .flag = &quick, .help = "fewer numbers of steps, and one second instead of four"},
    {"time", CLI_FLAG, .flag = &timed,
     .help = "instead, measure how many particles can be simulated per millisecond\n"
             "Each method takes the fewest steps per frame from which on all runs are fine and below the stable\n"
             "step."},
    {"map", CLI_FILE, .file = &map_file, .value = "FILE", .help = "with --time: also write the table of the runs"},
    {.name = NULL},
};

static const char map_columns[] = "scene method particles links substeps dt_s stable_step_s energy_error verdict";
static const char time_columns[] = "scene method substeps dt_s stable_step_s particles links frame_ms particles_per_ms";

static const cli_program program = {
    .name = "spring-scene-map",
    .summary = "Simulate each preset with each method and number of steps per frame, and judge the energy.",
    .details = "All scenes are simulated, or only the scene of --scene, with all methods, or only the method of\n"
               "--method. The scenes are the defaults of spring-scene, for four seconds.",
    .columns = map_columns,
    .meaning = "substeps is the number of steps per frame of 1/60 s. stable_step_s is the stable step that the\n"
               "library returns. energy_error is the largest difference between the energy at a frame and the energy\n"
               "of a run in very short steps, relative to the largest kinetic energy of that run. verdict is fine if\n"
               "energy_error is at most 0.05. It is exploded if the state overflows, or if the kinetic energy\n"
               "exceeds ten times the largest kinetic energy of that run. Otherwise it is lossy or gaining, by the\n"
               "sign of the difference.\n\n"
               "With --time: scene, method, substeps, dt_s, stable_step_s, particles, links, frame_ms and\n"
               "particles_per_ms. The scene is enlarged until a frame takes about a millisecond. frame_ms is the\n"
               "shortest of five times. A method that is not fine with 64 steps per frame has no row.",
    .shown = {"substeps", "energy_error"},
    .examples = {"--scene chain --quick", "--scene rope --method leapfrog -o rope.tsv",
                 "--scene chain --method rk4 --time --quick --map map.tsv"},
    .options = options,
};

/* ------------------------------------------------------------------------------------------------------- a run */

typedef struct subject {
    preset preset;
    disturbances *poke; /* NULL: none */
    uint64_t frames;
    double *energy; /* [frames] of the reference */
    double kinetic; /* the largest in the reference */
} subject;

typedef struct outcome {
    double error; /* signed, relative to the largest kinetic energy; infinite if the state overflows */
    bool exploded;
} outcome;

static spring_scene *start(const subject *s, spring_method m)
{
    size_t bytes;
    return start_scene(&s->preset, m, &bytes);
}

static void run_reference(subject *s)
{
    spring_scene *scene = start(s, SPRING_LEAPFROG);
    const double finest = spring_scene_stable_step(scene, SPRING_LEAPFROG) / 16;
    const uint64_t substeps = (uint64_t)ceil(frame_time / finest);
    for (uint64_t i = 0; i < s->frames; i++) {
        if (spring_scene_advance(scene, SPRING_LEAPFROG, frame_time / (double)substeps, substeps) != SPRING_OK)
            cli_fail(CLI_FAILED, "the run in very short steps overflows");
        const spring_scene_energies e = spring_scene_energy(scene);
        s->energy[i] = scene_run_total(&e);
        s->kinetic = fmax(s->kinetic, e.kinetic);
    }
    free(scene);
}

static outcome run(const subject *s, spring_method m, uint64_t substeps)
{
    const double much = 10;
    spring_scene *scene = start(s, m);
    outcome o = {0, false};
    for (uint64_t i = 0; i < s->frames && !o.exploded; i++) {
        const spring_status status = spring_scene_advance(scene, m, frame_time / (double)substeps, substeps);
        const spring_scene_energies e = spring_scene_energy(scene);
        const double error = (scene_run_total(&e) - s->energy[i]) / s->kinetic;
        o.exploded = status != SPRING_OK || !(e.kinetic <= much * s->kinetic);
        if (!(fabs(error) <= fabs(o.error)))
            o.error = status == SPRING_OK && isfinite(error) ? error : INFINITY;
    }
    free(scene);
    return o;
}

static const char *verdict_of(outcome o)
{
    if (o.exploded)
        return "exploded";
    if (fabs(o.error) <= 0.05)
        return "fine";
    return o.error < 0 ? "lossy" : "gaining";
}

/* ------------------------------------------------------------------------------------------------------ the map */

static uint64_t next_number(uint64_t substeps)
{
    return quick ? 2 * substeps : substeps + 1 + substeps / 8;
}

static void begin(subject *s, const preset_settings *settings)
{
    *s = (subject){.frames = quick ? 60 : 240};
    start_preset(&s->preset, settings);
    s->poke = start_poke(&s->preset, settings);
    s->energy = calloc(s->frames, sizeof *s->energy);
    if (s->energy == NULL)
        cli_fail(CLI_FAILED, "out of memory");
}

static void end(subject *s)
{
    free(s->energy);
    disturbances_free(s->poke);
    preset_clear(&s->preset);
}

/* Writes a row for each number of steps per frame, unless table is NULL. Returns the least number from which all runs
   are fine and below the stable step, or 0. Runs above the stable step do not count even if they are fine: larger
   scenes of the same kind could overflow. */
static uint64_t map_method(cli_table *table, const subject *s, preset_kind kind, spring_method m)
{
    const uint64_t most_substeps = 64;
    const double stable = start_stable_step(&s->preset, m);
    uint64_t fewest = 0;
    for (uint64_t n = 1; n <= most_substeps; n = next_number(n)) {
        const outcome o = run(s, m, n);
        const char *verdict = verdict_of(o);
        if (strcmp(verdict, "fine") != 0 || !(frame_time / (double)n < stable))
            fewest = 0;
        else if (fewest == 0)
            fewest = n;
        if (table != NULL)
            cli_row(table, "%s\t%s\t%zu\t%zu\t%" PRIu64 "\t%.17g\t%.17g\t%.17g\t%s", preset_names[kind],
                    spring_method_name(m), s->preset.def.particles, s->preset.def.links, n, frame_time / (double)n,
                    stable, fabs(o.error), verdict);
    }
    return fewest;
}

/* ------------------------------------------------------------------------------------------------------ its time */

/* [ms] per frame, for the first frames of a scene. */
static double time_frames(const subject *s, spring_method m, uint64_t substeps)
{
    const double long_enough = quick ? 2.5 : 5, nanosecond = 1e-6; /* [ms] */
    const int enough = quick ? 3 : 5;
    double best = INFINITY;
    uint64_t frames = 1;
    for (int loops = 0; loops < enough; loops++) {
        spring_scene *scene = start(s, m);
        const double before = timing_busy();
        for (uint64_t i = 0; i < frames; i++)
            if (spring_scene_advance(scene, m, frame_time / (double)substeps, substeps) != SPRING_OK)
                cli_fail(CLI_FAILED, "a scene overflows while it is timed");
        const double spent = nanosecond * (timing_busy() - before);
        free(scene);
        best = fmin(best, spent / (double)frames);
        if (spent < long_enough) {
            frames *= 2;
            loops = -1;
            best = INFINITY;
        }
    }
    return best;
}

/* Increases the size of a scene, at about constant spacing, until a frame takes about a millisecond. */
static void time_method(cli_table *table, preset_kind kind, spring_method m, uint64_t substeps)
{
    static const double directions[] = {
        [PRESET_ROPE] = 1, [PRESET_CLOTH] = 2, [PRESET_JELLY] = 3, [PRESET_CHAIN] = 1, [PRESET_WATER] = 2};
    const double most_size = 1e6;
    const int rounds = quick ? 2 : 4;
    preset_settings settings = preset_defaults(kind);
    const double spacing = settings.length / (double)settings.size;
    double frame = 1;
    for (int round = 0; round < rounds; round++) {
        const double size = (double)settings.size * pow(frame, -1 / directions[kind]);
        settings.size = (uint64_t)fmin(fmax(size, 3), most_size);
        settings.length = spacing * (double)settings.size;
        subject s;
        begin(&s, &settings);
        frame = time_frames(&s, m, substeps);
        if (round == rounds - 1)
            cli_row(table, "%s\t%s\t%" PRIu64 "\t%.17g\t%.17g\t%zu\t%zu\t%.4g\t%.4g", preset_names[kind],
                    spring_method_name(m), substeps, frame_time / (double)substeps, start_stable_step(&s.preset, m),
                    s.preset.def.particles, s.preset.def.links, frame, (double)s.preset.def.particles / frame);
        end(&s);
    }
}

/* Either table can be NULL. */
static void work_on(cli_table *map, cli_table *times, preset_kind kind)
{
    const preset_settings settings = preset_defaults(kind);
    subject s;
    begin(&s, &settings);
    run_reference(&s);
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        if (!spring_method_describe(m)->scenes || (only_method >= 0 && (int)m != only_method))
            continue;
        const uint64_t fewest = map_method(map, &s, kind, m);
        if (times != NULL && fewest > 0)
            time_method(times, kind, m, fewest);
    }
    end(&s);
}

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    if (map_file != NULL && !timed)
        cli_fail(CLI_USAGE, "--map: \"%s\" has no effect without --time", map_file);
    cli_table *map = map_file != NULL ? cli_open_file("map", map_file) : NULL, *output = cli_open_output();
    cli_table *times = timed ? output : NULL;
    if (timed) {
        timing_stamp(times);
        cli_columns(times, time_columns);
    } else {
        map = output;
    }
    if (map != NULL)
        cli_columns(map, map_columns);
    for (int kind = 0; kind < preset_kinds; kind++) {
        if (only_scene < 0 || kind == only_scene)
            work_on(map, times, (preset_kind)kind);
        cli_progress((kind + 1.0) / preset_kinds);
    }
    cli_finish();
    return 0;
}
