/* SPDX-License-Identifier: MIT */
/*
 * spring-scene: simulates a preset scene (rope, cloth, jelly, chain or water) by any method with any step, until its
 * state overflows.
 */
#include <dirent.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/cli.h"
#include "common/run_length.h"
#include "scenes/collider_words.h"
#include "scenes/scene_run.h"
#include "scenes/start.h"

/* ---------------------------------------------------------------------------------------------- the command line */

static const char *const links[] = {"all", "structural", NULL};

static int kind, method, link_choice;
enum { MOST_DISTURBANCES = 100 }; /* of each kind */
static uint64_t seed = 1, steps_per_frame, pokes, boxes;
static run_length length = {.duration = 5};
static double frame_rate = 60, fps = 60, disturbance_time = disturbance_duration, rain;
static double tear; /* length over rest length; 0: links do not tear */
static bool tension_only;
static double bend, tethers;
static cli_words colliders;
static double particle_radius;                                       /* [m] */
static double poke[MOST_DISTURBANCES][5], box[MOST_DISTURBANCES][2]; /* t, x, y, force, area; t, mass */
static const char *frames, *positions, *save, *load;
static double start_time; /* [s] of the run: 0, or that of the loaded state */
static bool hash_alone;
static preset_settings given;

static const cli_option options[] = {
    {"scene", CLI_CHOICE, .choice = &kind, .choices = preset_names, .required = true, .value = "S"},
    {"method", CLI_METHOD, .choice = &method, .offers = cli_for_scenes, .required = true, .value = "M"},
    {"duration", CLI_POSITIVE, .real = &length.duration, .value = "H",
     .help = "simulated time [s]; two of H, DT and N set the third"},
    {"dt", CLI_POSITIVE, .real = &length.dt, .value = "DT",
     .help = "step [s] (default: half the stable step of leapfrog, or less)\n"
             "By default, a frame has the fewest steps that are at most half the stable step of leapfrog and at\n"
             "most an eighth of --push-duration. For other methods they are also at most half the stable step of\n"
             "RK4, which heavy link damping limits. A duration is rounded to whole steps."},
    {"steps", CLI_COUNT, .count = &length.steps, .least = 1, .most = CLI_MOST_STEPS, .value = "N",
     .help = "number of steps"},
    {"steps-per-frame", CLI_COUNT, .count = &steps_per_frame, .least = 1, .most = 1000000, .value = "N",
     .help = "instead of --dt: steps per frame; the step is 1/(R N) s"},
    {"frame-rate", CLI_POSITIVE, .real = &frame_rate, .value = "R", .needs = &steps_per_frame,
     .help = "frames per second, for --steps-per-frame"},
    {"size", CLI_COUNT, .count = &given.size, .least = 2, .most = 4000, .value = "N",
     .help = "particles along an edge; chain: free particles (default: by scene)\n"
             "Defaults: rope 20, cloth 25, jelly 8, chain 50, water 25."},
    {"axes", CLI_COUNT, .count = &given.axes, .least = 1, .most = 3, .value = "A",
     .help = "water only: 1 for vertical motion, 3 for all directions (default: 1)"},
    {"links", CLI_CHOICE, .choice = &link_choice, .choices = links, .value = "L",
     .help = "cloth, jelly, water: all springs, or only structural ones\n"
             "all means structural, shear and bend springs: to the next particle, across, and to the second next\n"
             "particle. Rope and chain have only structural springs."},
    {"length", CLI_POSITIVE, .real = &given.length, .value = "L",
     .help = "length of an edge [m] (default: by scene)\n"
             "Defaults: rope 2, cloth 2, jelly 0.7, chain 5, water 4."},
    {"mass", CLI_POSITIVE, .real = &given.mass, .value = "M",
     .help = "mass of a particle [kg] (default: by scene)\n"
             "Defaults: rope 0.05, cloth 0.01, jelly 0.01, chain 0.1, water 1."},
    {"end-mass", CLI_POSITIVE, .real = &given.end_mass, .value = "M",
     .help = "rope only: mass of the last particle [kg] (default: as --mass)"},
    {"stiffness", CLI_NOT_NEGATIVE, .real = &given.stiffness, .value = "K",
     .help = "stiffness of a link [N/m] (default: by scene)\n"
             "Defaults: rope 2000, cloth 500, jelly 40, chain 100, water 25000."},
    {"damping", CLI_NOT_NEGATIVE, .real = &given.damping, .value = "C",
     .help = "damping of a link [N s/m] (default: 0)"},
    {"drag", CLI_NOT_NEGATIVE, .real = &given.drag, .value = "D",
     .help = "drag on a particle [N s/m] (default: by scene)\n"
             "Defaults: rope 0.01, cloth 0.01, jelly 0.005, chain 0, water 0.5."},
    {"gravity", CLI_REAL, .real = &given.gravity, .value = "G",
     .help = "rope, cloth and jelly only: gravity, downwards [m/s^2] (default: 9.81)"},
    {"stretch", CLI_POSITIVE, .real = &given.stretch, .value = "S",
     .help = "initial length of the links over their rest length (default: by scene)\n"
             "The default is 1, and 1.25 for water on three axes. Links of water on one axis have no rest length,\n"
             "and their default is the full --stiffness. S > 1 multiplies it by 1 - 1/S, the transverse stiffness\n"
             "of a sheet with this stretch."},
    {"bend", CLI_POSITIVE, .real = &bend, .value = "B",
     .help = "rope, cloth, water: bending stiffness, EI [N m^2] or D [N m]\n"
             "The rope gets the links of spring_bend_rod(). Sheets get those of spring_bend_grid() along rows,\n"
             "columns and diagonals."},
    {"tethers", CLI_POSITIVE, .real = &tethers, .value = "FRACTION",
     .help = "tethers to the nearest pins, which limit the stretch; 0.05 is a good value\n"
             "FRACTION is the stiffness of a tether, relative to the sum of the stiffness of the links of its\n"
             "particle: see spring_links_tethers(). Not for scenes with one axis, and not for rkn8 and srkn6."},
    {"poke", CLI_REALS, .real = poke[0], .least = 5, .most = MOST_DISTURBANCES, .times = &pokes,
     .value = "T,X,Y,FORCE,AREA",
     .help = "push at time T [s] at (X, Y) [m] with FORCE [N] on AREA [m^2]; repeatable\n"
             "The force acts downwards, is at most FORCE, and is spread over a round area. AREA > 0 and 0 <= T <\n"
             "H. At most 100 pokes."},
    {"rain", CLI_NOT_NEGATIVE, .real = &rain, .value = "RATE", .help = "one raindrop in every 1/RATE seconds"},
    {"seed", CLI_COUNT, .count = &seed, .value = "N", .needs = &rain, .help = "seed of the random raindrops"},
    {"drop-box", CLI_REALS, .real = box[0], .least = 2, .most = MOST_DISTURBANCES, .times = &boxes, .value = "T,MASS",
     .help = "a box of MASS [kg] hits the middle at time T [s]; repeatable\n"
             "It falls from a height of 1 m, at 9.81 m/s^2. MASS > 0 and 0 <= T < H. At most 100 boxes."},
    {"push-duration", CLI_POSITIVE, .real = &disturbance_time, .value = "D",
     .help = "duration of a poke, a raindrop or a box impact [s]"},
    {"tension-only", CLI_FLAG, .flag = &tension_only,
     .help = "links pull and never push; not for scenes with one axis"},
    {"tear", CLI_POSITIVE, .real = &tear, .value = "STRETCH",
     .help = "after each row, cut links longer than STRETCH times their rest length\n"
             "The number of torn links is printed on standard error. Not for scenes with one axis."},
    {"collider", CLI_WORDS, .words = &colliders, .value = "SHAPE:FIELDS",
     .help = "a plane, sphere, capsule or box that particles cannot enter; repeatable\n"
             "Fields are NAME=NUMBER, separated by commas, and 0 by default. These fields apply to all shapes: x y\n"
             "z [m] is a point of the plane, the centre, or one end of the capsule. vx vy vz [m/s] is the\n"
             "velocity, ax ay az [m/s^2] the acceleration, wx wy wz [rad/s] the spin, which turns a plane or a box\n"
             "about its point, wax way waz [rad/s^2] the spin acceleration, and sx sy sz [m/s] the velocity of a\n"
             "belt on its surface. friction is at least 0, restitution from 0 to 1. mask is an integer: a particle\n"
             "collides if bit (index modulo 32) is set; 0 means all bits. A plane also has the normal nx ny nz,\n"
             "upwards by default. A sphere has a radius. A capsule has a radius and the other end x2 y2 z2. A box\n"
             "has hx hy hz, half of its size along x, y and z, and a radius, which rounds its edges. z is up. The\n"
             "rope has no y. At most 32 colliders. Not for scenes with one axis, and not for euler, rkn8 and\n"
             "srkn6."},
    {"particle-radius", CLI_NOT_NEGATIVE, .real = &particle_radius, .value = "R", .needs = &colliders,
     .help = "radius of every particle [m]"},
    {"fps", CLI_POSITIVE, .real = &fps, .value = "N", .help = "rows and frames per second"},
    {"frames", CLI_FOLDER, .file = &frames, .value = "DIR",
     .help = "write the positions of each frame to DIR/frame-000000.tsv and so on\n"
             "DIR is created. Older frames with the same numbers are replaced."},
    {"positions", CLI_FILE, .file = &positions, .value = "FILE", .help = "write the positions of all frames to FILE"},
    {"save", CLI_FILE, .file = &save, .value = "FILE",
     .help = "save the final state to FILE, for --load\n"
             "docs/details.md describes the format. If the scene explodes, it is the last state before."},
    {"load", CLI_INPUT, .file = &load, .value = "FILE",
     .help = "continue from a state that --save has written\n"
             "Give the same options of the scene, the same method and the same disturbances. The results are then\n"
             "those of one long run. H and N are further time and steps. Times of disturbances are those of the\n"
             "scene, with T < start + H, or later with --save. Colliders are those of the state. With --tear, a\n"
             "row should be a whole number of steps, and H a whole number of rows."},
    {"hash", CLI_FLAG, .flag = &hash_alone,
     .help = "print only a hash of the final state, 16 hexadecimal digits\n"
             "The hash is FNV-1a with 64 bits, over the doubles of all positions and then of all velocities,\n"
             "lowest byte first. If the scene explodes, it is the hash of the last state before."},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-scene",
    .summary = "Simulate a rope, a cloth, a soft body (jelly), a chain or height-field water.",
    .details = "The rope is held at one end and swings. The cloth hangs from two corners. The jelly stands on its\n"
               "lowest layer. The masses of the chain move along it, and the chain is plucked in the middle. The\n"
               "edges of the water are pinned. If no disturbance is given, the water is poked in the middle with\n"
               "10^5 N on (L/8)^2 m^2.\n\n"
               "A disturbance that begins at T has the force FORCE (4 u (1 - u))^4, with u = (t - T)/D and 0 < u <\n"
               "1. In the chain, the force acts along the chain. A poke is spread like (1 - r^2/R^2)^2. The box is\n"
               "spread evenly over a square of (L/8)^2 m^2, and loses its momentum, MASS 4.43 m/s. A raindrop is a\n"
               "poke of (L/16)^2 m^2 with the momentum of one particle at 10 m/s, at a random place and time within\n"
               "its 1/RATE seconds.\n\n"
               "Every step is accepted. A warning is printed if the step is not below the stable step, if it is D/4\n"
               "or more, so that disturbances become weaker or stronger, or if H is not a whole number of the given\n"
               "steps. When the energy overflows, the output ends, the time is printed on standard error, and the\n"
               "exit status is 1.",
    .columns = "t_s energy_J kinetic_J elastic_J gravity_J max_displacement_m",
    .meaning = "energy_J is the sum of kinetic_J, elastic_J and gravity_J (0 at the origin). max_displacement_m is\n"
               "the largest distance of a particle from its start. There is a row for each frame, at the nearest\n"
               "step, and a row for the end, at the step nearest to the duration but after at least one step. With\n"
               "--collider, the additional column touching has the number of particles that touch a collider.\n\n"
               "Columns of frames: t_s, particle, its indices i j k in the grid, and x_m y_m z_m, with z up.",
    .shown = {"t_s", "energy_J"},
    .examples = {"--scene cloth --method leapfrog --collider sphere:x=1,y=1,z=-.6,radius=.4 -o c.tsv",
                 "--scene water --method rk4 --duration 1 --poke 0,1,1,2e4,.1 --poke .5,3,2,2e4,.1",
                 "--scene rope --method leapfrog --dt 1e-3 --steps 500 --frames rope"},
    .options = options,
};

static void refuse_what_it_lacks(const char *option, double value, double usual)
{
    if (!isnan(value) && isnan(usual))
        cli_fail(CLI_USAGE, "--%s: \"%g\" is for other scenes; it does not apply to %s", option, value,
                 preset_names[kind]);
}

static bool is_disturbed(void)
{
    return pokes > 0 || boxes > 0 || rain > 0 || kind == PRESET_WATER;
}

/* On one axis, the extension of a link has a sign, so options that need lengths are refused. */
static void refuse_on_one_axis(const preset_settings *s)
{
    static const char why[] = "is not for scenes with one axis, such as this";
    if (s->axes == 1 && tension_only)
        cli_fail(CLI_USAGE, "--tension-only: %s %s", why, preset_names[kind]);
    if (s->axes == 1 && (tear > 0 || tethers > 0))
        cli_fail(CLI_USAGE, "--%s: \"%g\" %s %s", tear > 0 ? "tear" : "tethers", tear > 0 ? tear : tethers, why,
                 preset_names[kind]);
    if (s->axes == 1 && colliders.count > 0)
        cli_fail(CLI_USAGE, "--collider: \"%s\" %s %s", colliders.word[0], why, preset_names[kind]);
    if ((tension_only || tethers > 0) && spring_method_describe((spring_method)method)->positions_only)
        cli_fail(CLI_USAGE, "--%s: the method \"%s\" requires smooth forces; choose another --method",
                 tension_only ? "tension-only" : "tethers", spring_method_name((spring_method)method));
}

static void refuse_methods_without_contacts(void)
{
    const spring_method m = (spring_method)method;
    if (colliders.count > 0 && (m == SPRING_EULER || spring_method_describe(m)->positions_only))
        cli_fail(CLI_USAGE, "--collider: the method \"%s\" does not support contacts; choose another --method",
                 spring_method_name(m));
}

/* Particle i has bit i mod 32. Returns NULL if no collider has a mask. */
static uint32_t *make_masks(size_t particles, const spring_collider *c)
{
    bool any = false;
    for (size_t i = 0; i < colliders.count; i++)
        any = any || c[i].mask != 0;
    uint32_t *mask = any ? malloc(particles * sizeof *mask) : NULL;
    if (any && mask == NULL)
        cli_fail(CLI_FAILED, "no memory for %zu particles", particles);
    for (size_t i = 0; any && i < particles; i++)
        mask[i] = UINT32_C(1) << i % 32;
    return mask;
}

static void set_colliders(spring_scene *scene, const spring_collider *c)
{
    if (colliders.count > 0 && spring_scene_set_colliders(scene, c, (uint32_t)colliders.count) != SPRING_OK)
        cli_fail(CLI_USAGE, "--collider: a number in \"%s\" or in a later collider is too large", colliders.word[0]);
}

/* An option without effect is an error. */
static void refuse_what_does_not_count(void)
{
    const bool line = kind == PRESET_ROPE || kind == PRESET_CHAIN;
    if (line && cli_given(&link_choice))
        cli_fail(CLI_USAGE, "--links: \"%s\" is for other scenes; %s has only structural links", links[link_choice],
                 preset_names[kind]);
    if (bend > 0 && (kind == PRESET_JELLY || kind == PRESET_CHAIN))
        cli_fail(CLI_USAGE, "--bend: \"%g\" is for rope, cloth and water, not for %s", bend, preset_names[kind]);
    if (!is_disturbed() && cli_given(&disturbance_time))
        cli_fail(CLI_USAGE, "--push-duration: \"%g\" has no effect without --poke, --rain or --drop-box",
                 disturbance_time);
}

static preset_settings chosen_settings(void)
{
    const preset_settings usual = preset_defaults((preset_kind)kind);
    const bool water = kind == PRESET_WATER;
    given.kind = usual.kind;
    if (given.axes > 0 && !water && given.axes != usual.axes)
        cli_fail(CLI_USAGE, "--axes: \"%" PRIu64 "\" is for water; for the %s it should be %" PRIu64 ", or be omitted",
                 given.axes, preset_names[kind], usual.axes);
    if (given.axes == 2 && water)
        cli_fail(CLI_USAGE, "--axes: \"2\" is not a number of axes of water; it should be 1 or 3");
    refuse_what_it_lacks("end-mass", given.end_mass, usual.end_mass);
    refuse_what_it_lacks("gravity", given.gravity, usual.gravity);
    if (water && given.axes != 3 && given.stretch <= 1)
        cli_fail(CLI_USAGE, "--stretch: \"%g\" gives the water no stiffness; it should be greater than 1",
                 given.stretch);
    if (water && given.axes == 3 && isnan(given.stretch))
        given.stretch = 1.25;
    if (link_choice == 1)
        given.families = SPRING_GRID_STRUCTURAL;
    return preset_chosen(&given);
}

/* -------------------------------------------------------------------------------------------------- disturbances */

static void check_time(const char *option, double t)
{
    if (!(t >= 0))
        cli_fail(CLI_USAGE, "--%s: \"%g\" is not a time T of at least 0 s", option, t);
    const double end = start_time + length.duration;
    if (!(t < end) && save == NULL)
        cli_fail(CLI_USAGE, "--%s: \"%g\" is after the run; T should be below %g s", option, t, end);
}

static void check_poke(const preset *r, const double at[5])
{
    const double *far = &r->start[3 * (r->def.particles - 1)];
    check_time("poke", at[0]);
    if (!(at[4] > 0))
        cli_fail(CLI_USAGE, "--poke: \"%g\" is not an AREA greater than 0 m^2", at[4]);
    if (!(at[1] >= 0 && at[1] <= far[0] && at[2] >= 0 && at[2] <= far[1]))
        cli_fail(CLI_USAGE,
                 "--poke: \"%g,%g\" is not a point X,Y of the scene; X should be from 0 to %g, Y from 0 to %g m", at[1],
                 at[2], far[0], far[1]);
}

static void check_box(const double dropped[2])
{
    check_time("drop-box", dropped[0]);
    if (!(dropped[1] > 0))
        cli_fail(CLI_USAGE, "--drop-box: \"%g\" is not a MASS greater than 0 kg", dropped[1]);
}

/* The drops of all intervals that begin before the time `until`. Those that begin after the run do not act. */
static size_t fall(const preset *r, const preset_settings *s, double until, disturbance *list)
{
    uint64_t random = seed;
    size_t count = 0;
    for (uint64_t i = 0; (double)i / rain < until; i++)
        list[count++] = disturbances_drop(r, s, (double)i / rain, (double)(i + 1) / rain, disturbance_time, &random);
    return count;
}

static disturbances *chosen_disturbances(preset *r, const preset_settings *s)
{
    const double most_drops = 1e5, end = start_time + length.duration;
    if (!(rain * end <= most_drops))
        cli_fail(CLI_USAGE, "--rain: \"%g\" makes more than %g drops in %g s; it should be at most %g", rain,
                 most_drops, end, most_drops / end);
    for (uint64_t i = 0; i < pokes; i++)
        check_poke(r, poke[i]);
    for (uint64_t i = 0; i < boxes; i++)
        check_box(box[i]);
    /* The last step may end after H, by less than H unless it is the only one. The time of a damaged state may be negative. */
    const double until = fmax(0, end + length.duration);
    const size_t drops = (size_t)(rain * until) + 2; /* + 1 for a drop that has begun, + 1 for rounding */
    disturbance *list = malloc((drops + pokes + 1 + boxes) * sizeof *list);
    if (list == NULL)
        cli_fail(CLI_FAILED, "no memory for %zu drops", drops);
    size_t count = rain > 0 ? fall(r, s, until, list) : 0;
    for (uint64_t i = 0; i < pokes; i++)
        list[count++] = (disturbance){poke[i][0], disturbance_time, poke[i][1],       poke[i][2],
                                      poke[i][3], poke[i][4],       DISTURBANCE_ROUND};
    if (is_disturbed() && pokes == 0 && boxes == 0 && rain == 0)
        list[count++] = disturbances_poke(r, s, disturbance_time);
    for (uint64_t i = 0; i < boxes; i++)
        list[count++] = disturbances_box(r, s, box[i][0], box[i][1], disturbance_time);
    disturbances *p = is_disturbed() ? start_disturbances(r, list, count) : NULL;
    free(list);
    return p;
}

/* -------------------------------------------------------------------------------------------------- saved states */

typedef struct state {
    uint8_t *bytes;
    size_t size;
} state;

/* Words of the header, which docs/details.md describes, and the bytes of the header with the check value. */
enum { BYTES = 12, T0 = 17, DT, STEPS, GRAVITY = 22, LEAST = 26 * 8 };

static uint64_t word_of(const state *y, size_t index)
{
    uint64_t word = 0;
    for (size_t i = 0; i < sizeof word; i++)
        word |= (uint64_t)y->bytes[8 * index + i] << 8 * i;
    return word;
}

static double number_of(const state *y, size_t index)
{
    const uint64_t word = word_of(y, index);
    double number;
    memcpy(&number, &word, sizeof number);
    return number;
}

/* The file of --load. Sets start_time. */
static state read_state(void)
{
    state y = {NULL, 0};
    FILE *const file = fopen(load, "rb");
    size_t room = 0, got = 0;
    bool more; /* the header has the size */
    do {
        y.size += got;
        if (y.size == room)
            y.bytes = realloc(y.bytes, room = 2 * room + 65536);
        if (y.bytes == NULL)
            cli_fail(CLI_FAILED, "no memory for --load");
        more = y.size < LEAST || (memcmp(y.bytes, "SPRSTATE", 8) == 0 && y.size <= word_of(&y, BYTES));
    } while (more && file != NULL && (got = fread(y.bytes + y.size, 1, room - y.size, file)) > 0);
    if (file == NULL || ferror(file) != 0 || fclose(file) != 0)
        cli_fail(CLI_IO, "--load: cannot read \"%s\": %s", load, strerror(errno));
    if (y.size >= LEAST)
        start_time = number_of(&y, T0) + (double)word_of(&y, STEPS) * number_of(&y, DT);
    if (y.size < LEAST || !(fabs(start_time) <= DBL_MAX))
        cli_fail(CLI_USAGE, "--load: \"%s\" is not a saved state, or damaged", load);
    return y;
}

/* The state has its gravity, which would replace that of --gravity. Other options that the state does not have, such as
   --stiffness, are those of this run. */
static void load_state(spring_scene *scene, const spring_scene_def *def, const state *y)
{
    const spring_status status = spring_scene_load(scene, y->bytes, y->size);
    if (status == SPRING_EMISMATCH)
        cli_fail(CLI_USAGE,
                 "--load: \"%s\" is a state of another scene; all options of the scene, the method and the "
                 "disturbances should be those of the run that saved it",
                 load);
    if (status != SPRING_OK)
        cli_fail(CLI_USAGE, "--load: \"%s\" is not a saved state, or damaged", load);
    for (uint32_t axis = 0; axis < def->axes; axis++)
        if (number_of(y, GRAVITY + axis) != def->gravity[axis])
            cli_fail(CLI_USAGE,
                     "--gravity: the scene has \"%.17g\" m/s^2 along an axis, and the state in \"%s\" has %.17g; they "
                     "should be equal",
                     def->gravity[axis], load, number_of(y, GRAVITY + axis));
}

static void save_state(const spring_scene *scene, cli_table *file)
{
    size_t size = 0;
    spring_scene_save(scene, NULL, &size);
    void *const bytes = malloc(size);
    if (bytes == NULL || spring_scene_save(scene, bytes, &size) != SPRING_OK)
        cli_fail(CLI_FAILED, "--save: no memory for %zu bytes", size);
    cli_bytes(file, bytes, size);
    free(bytes);
}

/* -------------------------------------------------------------------------------------------------------- frames */

static const char frame_columns[] = "t_s particle i j k x_m y_m z_m";
static char frame_path[4096];

static void name_frame(uint64_t frame)
{
    const int needed = snprintf(frame_path, sizeof frame_path, "%s/frame-%06" PRIu64 ".tsv", frames, frame);
    if (needed >= (int)sizeof frame_path)
        cli_fail(CLI_IO, "--frames: cannot write to \"%s\": %s", frames, strerror(ENAMETOOLONG));
}

/* Frames of an earlier run must not be mistaken for new ones. Files that this run will write are removed now, in case
   it fails. Files with higher numbers are an error. */
static void prepare_frames(uint64_t count)
{
    if (mkdir(frames, 0777) != 0 && errno != EEXIST)
        cli_fail(CLI_IO, "--frames: cannot create \"%s\": %s; it should be a folder, or be in one", frames,
                 strerror(errno));
    DIR *folder = opendir(frames);
    if (folder == NULL)
        cli_fail(CLI_IO, "--frames: cannot read \"%s\": %s; it should be a folder", frames, strerror(errno));
    uint64_t number;
    int used = 0; /* characters, if all match */
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL; used = 0)
        if (sscanf(entry->d_name, "frame-%6" SCNu64 ".tsv%n", &number, &used) == 1 &&
            used == (int)strlen("frame-000000.tsv") && entry->d_name[used] == 0 && number >= count)
            cli_fail(
                CLI_IO,
                "--frames: \"%s/%s\" belongs to a longer run; the folder should be empty or belong to the same run",
                frames, entry->d_name);
    closedir(folder);
    for (uint64_t frame = 0; frame < count; frame++) {
        name_frame(frame);
        if (unlink(frame_path) != 0 && errno != ENOENT)
            cli_fail(CLI_IO, "--frames: cannot replace \"%s\": %s", frame_path, strerror(errno));
    }
}

static void write_positions(cli_table *table, const preset *r, double t, const double *xyz)
{
    const uint32_t *n = r->count;
    for (size_t i = 0; i < r->def.particles; i++)
        cli_row(table, "%.17g\t%zu\t%zu\t%zu\t%zu\t%.17g\t%.17g\t%.17g", t, i, i % n[0], i / n[0] % n[1],
                i / n[0] / n[1], xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
}

static void write_frame(uint64_t frame, const preset *r, double t, const double *xyz)
{
    name_frame(frame);
    cli_table *table = cli_open_file("frames", frame_path);
    cli_columns(table, frame_columns);
    write_positions(table, r, t, xyz);
    cli_close(table);
}

/* ------------------------------------------------------------------------------------------------------- the run */

typedef struct view { /* a scene and its outputs */
    const preset *preset;
    spring_scene *scene;
    void *saved;  /* copy for restoring the scene */
    size_t bytes; /* size of each */
    cli_table *output, *positions, *save;
    double *xyz;    /* [particles*3] */
    double lost_at; /* [s] time of the overflow */
    size_t torn;    /* links */
} view;

static size_t count_touching(const view *v)
{
    size_t touching = 0;
    for (size_t i = 0; i < v->preset->def.particles; i++) {
        uint32_t mask = 0;
        spring_scene_touching(v->scene, &mask, i, 1);
        touching += mask != 0;
    }
    return touching;
}

static void write_row(view *v)
{
    const spring_scene_energies e = spring_scene_energy(v->scene);
    double most = 0;
    preset_positions(v->preset, v->scene, v->xyz);
    for (size_t i = 0; i < v->preset->def.particles; i++) {
        const double *p = &v->xyz[3 * i], *q = &v->preset->start[3 * i];
        most = fmax(most, hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]));
    }
    if (hash_alone)
        return;
    char touching[24] = "";
    if (colliders.count > 0)
        snprintf(touching, sizeof touching, "\t%zu", count_touching(v));
    cli_row(v->output, "%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g%s", spring_scene_time(v->scene), scene_run_total(&e),
            e.kinetic, e.elastic, e.gravity, most, touching);
}

static void write_pictures(const view *v, uint64_t frame)
{
    const double t = spring_scene_time(v->scene);
    if (frames != NULL)
        write_frame(frame, v->preset, t, v->xyz);
    if (v->positions != NULL)
        write_positions(v->positions, v->preset, t, v->xyz);
}

/* Takes up to n steps. Returns false if it stopped early because the state would overflow. */
static bool advance(view *v, uint64_t n)
{
    const uint64_t leap = 1024;
    while (n > 0) {
        const uint64_t some = n < leap ? n : leap;
        if (scene_run_steps(v->scene, v->saved, v->bytes, (spring_method)method, length.dt, some) < some) {
            v->lost_at = spring_scene_time(v->scene) + length.dt;
            return false;
        }
        n -= some;
        cli_progress((spring_scene_time(v->scene) - start_time) / length.duration);
    }
    return true;
}

static void tear_links(view *v)
{
    size_t count = 0;
    if (spring_scene_tear(v->scene, tear, NULL, NULL, 0, &count) != SPRING_OK)
        cli_fail(CLI_FAILED, "the links of this scene cannot tear");
    v->torn += count;
}

/* Returns false if the state overflowed. */
static bool run(view *v, uint64_t frame_count)
{
    uint64_t step = 0;
    if (!scene_run_holds(v->scene))
        return false;
    for (uint64_t frame = 0; frame <= frame_count; frame++) {
        const bool end = frame == frame_count;
        const uint64_t next =
            end ? length.steps : (uint64_t)fmin(rint((double)frame / fps / length.dt), (double)length.steps);
        if (!advance(v, next - step))
            return false;
        if (frame == 0 || next > step)
            write_row(v);
        if (!end)
            write_pictures(v, frame);
        if (tear > 0)
            tear_links(v);
        step = next;
    }
    return true;
}

/* A frame has a whole number of steps, so that frames are equally spaced in time. */
static double default_step(spring_scene *scene, bool disturbed)
{
    double longest = 0.5 * spring_scene_stable_step(scene, SPRING_LEAPFROG);
    if (method != SPRING_LEAPFROG) /* damped links limit the step of the other methods */
        longest = fmin(longest, 0.5 * spring_scene_stable_step(scene, SPRING_RK4));
    if (disturbed)
        longest = fmin(longest, disturbance_time / 8);
    return 1 / (fps * fmax(ceil(1 / (fps * longest)), 1));
}

/* Called before the scene exists. A default step depends on the scene and is chosen later. */
static void choose_length(void)
{
    if (steps_per_frame > 0 && cli_given(&length.dt))
        cli_fail(CLI_USAGE, "--steps-per-frame: \"%" PRIu64 "\" cannot be combined with --dt", steps_per_frame);
    if (steps_per_frame > 0 && cli_given(&length.steps) && cli_given(&length.duration))
        cli_fail(CLI_USAGE, "--steps-per-frame: \"%" PRIu64 "\" cannot be combined with --steps and --duration",
                 steps_per_frame);
    if (steps_per_frame > 0)
        length.dt = scene_run_step(frame_rate, steps_per_frame);
    if (steps_per_frame > 0 && !(length.dt > 0))
        cli_fail(CLI_USAGE, "--frame-rate: \"%g\" with --steps-per-frame \"%" PRIu64 "\" gives a step of 0 s",
                 frame_rate, steps_per_frame);
    if (cli_given(&length.steps) && length.dt == 0 && !cli_given(&length.duration))
        cli_fail(CLI_USAGE,
                 "--steps: \"%" PRIu64 "\" does not set the time; give --dt, --steps-per-frame or --duration as well",
                 length.steps);
    if (length.dt > 0 || length.steps > 0)
        run_length_settle(&length);
}

static void choose_step(spring_scene *scene, bool disturbed)
{
    if (length.dt > 0)
        return;
    length.dt = default_step(scene, disturbed);
    if (!(length.dt > 0))
        cli_fail(CLI_USAGE,
                 "--fps: \"%g\" and --push-duration: \"%g\" give a default step of 0 s with a stable step of %.3g s; "
                 "try --dt",
                 fps, disturbance_time, spring_scene_stable_step(scene, SPRING_LEAPFROG));
    run_length_settle(&length);
}

static void remark_on_step(spring_scene *scene, bool disturbed)
{
    const spring_method m = (spring_method)method;
    if (cli_given(&length.dt) || cli_given(&length.duration) || steps_per_frame > 0)
        run_length_remark_end(&length);
    run_length_remark_step(length.dt, spring_scene_stable_step(scene, m), m);
    if (disturbed && !(length.dt < disturbance_time / 4))
        cli_warn("the step of %g s is not below a quarter of --push-duration, %g s: disturbances become "
                 "weaker or stronger",
                 length.dt, disturbance_time / 4);
}

static view open_view(const preset *r, spring_scene *scene, size_t bytes, uint64_t frame_count)
{
    view v = {
        .preset = r, .scene = scene, .bytes = bytes, .output = hash_alone ? cli_open_bare_output() : cli_open_output()};
    v.positions = positions != NULL ? cli_open_file("positions", positions) : NULL;
    v.save = save != NULL ? cli_open_file("save", save) : NULL;
    if (frames != NULL)
        prepare_frames(frame_count);
    v.saved = malloc(v.bytes);
    v.xyz = malloc(3 * r->def.particles * sizeof *v.xyz);
    if (v.saved == NULL || v.xyz == NULL)
        cli_fail(CLI_FAILED, "no memory for %zu particles", r->def.particles);
    if (v.positions != NULL)
        cli_columns(v.positions, frame_columns);
    if (hash_alone)
        return v;
    char more[100] = "";
    if (r->tethers > 0 || r->def.weighted_links > 0)
        snprintf(more, sizeof more, ", %zu tethers, %zu weighted links", r->tethers, r->def.weighted_links);
    cli_comment(v.output, "scene: %s, %zu particles, %zu links%s", preset_names[kind], r->def.particles,
                r->def.links - r->tethers, more);
    cli_comment(v.output, "method: %s, dt = %.17g s, stable step %.17g s", spring_method_name((spring_method)method),
                length.dt, spring_scene_stable_step(scene, (spring_method)method));
    if (load != NULL)
        cli_comment(v.output, "start: t = %.17g s", start_time);
    char columns[200];
    snprintf(columns, sizeof columns, "%s%s", program.columns, colliders.count > 0 ? " touching" : "");
    cli_columns(v.output, columns);
    return v;
}

static void check_frames(void)
{
    const double most_frames = 1e6; /* six digits */
    if (!(length.duration * fps < most_frames) && !cli_given(&fps))
        cli_fail(CLI_USAGE,
                 "--duration: a run of \"%g\" s has more than %g frames, at %g per second; it should be below %g s",
                 length.duration, most_frames, fps, most_frames / fps);
    if (!(length.duration * fps < most_frames))
        cli_fail(CLI_USAGE, "--fps: \"%g\" makes more than %g frames in %g s; it should be below %g", fps, most_frames,
                 length.duration, most_frames / length.duration);
}

int main(int argc, char **argv)
{
    given = preset_unchosen((preset_kind)kind);
    cli_parse(&program, argc, argv);
    state loaded = load != NULL ? read_state() : (state){NULL, 0};
    refuse_what_does_not_count();
    choose_length();
    check_frames();
    const preset_settings settings = chosen_settings();
    refuse_on_one_axis(&settings);
    refuse_methods_without_contacts();
    spring_collider collider[MOST_COLLIDERS];
    collider_words_read(&colliders, (uint32_t)settings.axes, collider);
    preset r;
    start_preset(&r, &settings);
    start_links(&r, bend, tethers);
    r.def.flags |= (tension_only ? SPRING_SCENE_TENSION_ONLY : 0) | (tear > 0 ? SPRING_SCENE_EDITABLE : 0);
    uint32_t *mask = make_masks(r.def.particles, collider);
    r.def.colliders = (uint32_t)colliders.count, r.def.particle_radius = particle_radius, r.def.mask = mask;
    disturbances *p = chosen_disturbances(&r, &settings);
    size_t bytes;
    spring_scene *scene = start_scene(&r, (spring_method)method, &bytes);
    set_colliders(scene, collider);
    choose_step(scene, p != NULL);
    remark_on_step(scene, p != NULL);
    if (load != NULL)
        load_state(scene, &r.def, &loaded);

    const uint64_t frame_count = (uint64_t)(length.duration * fps * (1 + DBL_EPSILON)) + 1;
    view v = open_view(&r, scene, bytes, frame_count);
    const bool survived = run(&v, frame_count);
    if (hash_alone)
        cli_row(v.output, "%016" PRIx64, scene_run_hash(scene, r.def.particles, r.def.axes));
    if (save != NULL)
        save_state(scene, v.save);
    cli_finish();
    if (tear > 0)
        cli_warn("%zu of %zu links have torn", v.torn, r.def.links - r.tethers);
    if (!survived)
        cli_warn("the scene explodes: its energy overflows at t = %.17g s", v.lost_at);
    free(loaded.bytes);
    free(v.xyz);
    free(v.saved);
    free(mask);
    free(scene);
    disturbances_free(p);
    preset_clear(&r);
    return survived ? 0 : CLI_FAILED;
}
