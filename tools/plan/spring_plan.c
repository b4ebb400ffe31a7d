/* SPDX-License-Identifier: MIT */
/*
 * spring-plan: from an error and a duration, computes the steps of each method and sorts the methods, for one spring, a
 * preset scene, or a mesh. From a stretch, computes the least stiffness of a hanging scene and its steps.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/cli.h"
#include "common/timing.h"
#include "mesh.h"
#include "plan.h"
#include "scenes/start.h"

/* ---------------------------------------------------------------------------------------------- the command line */

static double error = NAN, duration = NAN, sag = NAN;
static double mass = NAN, stiffness = NAN, damping = NAN, hertz = NAN, damping_ratio = NAN, drag = NAN;
static double bend = NAN, tethers = NAN;
static int kind = -1;
static uint64_t size;
static const char *mesh;
static bool presets, quick;

static const cli_option options[] = {
    {"error", CLI_POSITIVE, .real = &error, .value = "E",
     .help = "largest error, relative to the size of the motion: 0.01 is 1 %"},
    {"duration", CLI_POSITIVE, .real = &duration, .value = "T", .help = "simulated time [s]"},
    {"mass", CLI_POSITIVE, .real = &mass, .value = "M",
     .help = "mass of the spring or of a particle [kg] (default: 1; by scene)"},
    {"stiffness", CLI_NOT_NEGATIVE, .real = &stiffness, .value = "K",
     .help = "stiffness of the spring or of a link of the scene [N/m]"},
    {"damping", CLI_NOT_NEGATIVE, .real = &damping, .value = "C",
     .help = "damping of the spring or of a link of the scene [N s/m] (default: 0)"},
    {"hertz", CLI_NOT_NEGATIVE, .real = &hertz, .value = "F",
     .help = "undamped frequency of the spring [Hz], instead of --stiffness"},
    {"damping-ratio", CLI_NOT_NEGATIVE, .real = &damping_ratio, .value = "Z",
     .help = "damping ratio of the spring, with --hertz; 1 is critical (default: 0)"},
    {"scene", CLI_CHOICE, .choice = &kind, .choices = preset_names, .value = "S",
     .help = "a preset of spring-scene: rope, cloth, jelly, chain or water"},
    {"size", CLI_COUNT, .count = &size, .least = 2, .most = 4000, .value = "N",
     .help = "particles along an edge of the scene"},
    {"mesh", CLI_INPUT, .file = &mesh, .value = "FILE",
     .help = "a scene from a mesh (Wavefront OBJ, y up); requires --stiffness or --sag\n"
             "Each vertex becomes a particle. Links join the ends of each edge, and the opposite corners of each\n"
             "face of four corners. The highest vertices are pinned, and gravity pulls the others. For example:\n"
             "spring-plan --error 0.05 --duration 1 --mesh flag.obj --stiffness 300 --mass 0.01"},
    {"drag", CLI_NOT_NEGATIVE, .real = &drag, .value = "D", .help = "drag on a particle of the scene [N s/m]"},
    {"bend", CLI_POSITIVE, .real = &bend, .value = "B",
     .help = "rope, cloth, water: bending stiffness, EI [N m^2] or D [N m]"},
    {"tethers", CLI_POSITIVE, .real = &tethers, .value = "FRACTION",
     .help = "rope, cloth, jelly, meshes: tethers to the nearest pins, such as 0.05\n"
             "With tethers, a scene sags less at the same stiffness, so that it needs fewer steps. See --tethers of\n"
             "spring-scene."},
    {"sag", CLI_POSITIVE, .real = &sag, .value = "S",
     .help = "print the stiffness with which --scene or --mesh becomes at most S longer\n"
             "S is from 1e-4 to 1, and 0.02 is 2 %. The steps for this stiffness are also printed. For example:\n"
             "spring-plan --sag 0.02 --scene cloth"},
    {"presets", CLI_FLAG, .flag = &presets,
     .help = "instead, print the steps that each scene needs for a frame of 1/60 s\n"
             "These are the steps for all scenes, or for --scene, with each method, for errors of 10, 1 and 0.1 %\n"
             "in a second."},
    {"quick", CLI_FLAG, .flag = &quick, .needs = &presets, .help = "with --presets: skip long runs"},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-plan",
    .summary = "Find the method and the step for a given error, or the stiffness for a given sag.",
    .details = "A spring is given by --stiffness or --hertz, and a scene by --scene or --mesh.\n\n"
               "For a spring, the error is the largest error in (x, v/omega) after any of the first 65536 steps, and\n"
               "after at most as many of the later steps, relative to the start and for the worst start. The\n"
               "prediction is spring_step_error(). For a scene, the error is the largest error at any frame: the\n"
               "Euclidean distance of all positions from a reference, divided by the largest distance of the\n"
               "reference from the start. The reference is extrapolated from two runs of the method of highest\n"
               "order. They are refined until the uncertainty is a twentieth of the error, or until the runs take\n"
               "too long. The predicted error follows from the error of a coarser step and the order. The number of\n"
               "steps per frame is a whole number.\n\n"
               "With --sag, the scene hangs until it is at rest. All links have the same stiffness. It is the\n"
               "smallest stiffness with which the scene is at most S longer along gravity than with links that do\n"
               "not stretch. A second row has the stiffness with which no link is longer than (1 + S) times its rest\n"
               "length. This stiffness is larger, because links near pins carry the weight of everything below them:\n"
               "a long rope needs twice the stiffness, and a cloth that hangs by two corners many times as much. For\n"
               "jelly, which stands on its pins, compression counts instead. The computation takes seconds, or\n"
               "minutes with thousands of particles.",
    .columns = "method dt_s steps force_evaluations predicted_error measured_error time_s uncertainty",
    .meaning = "time_s is the time on this machine, without setup. uncertainty is the uncertainty of the measured\n"
               "error. The fastest method comes first. Of methods whose times differ by less than a tenth, the most\n"
               "accurate comes first. A comment states the recommendation. A method without a sufficient number of\n"
               "steps comes last, with 0 steps, because its rounding error would be too large or the runs would take\n"
               "too long. force_evaluations counts one evaluation per step for leapfrog in scenes. With heavily\n"
               "damped links, a step also evaluates damping alone. A comment has the number. time_s includes it.\n"
               "Another comment states the largest fraction of the stable step that leapfrog may take for such a\n"
               "scene, and the steps for 1/60 s, in double and single precision: 0.9 if the damping ratio of links is\n"
               "at least 0.02, and for sheets and blocks with a drag/mass of at least 0.1/s, while no link is longer\n"
               "than twice its rest length; otherwise 0.5, and 0.25 for more than a minute without drag. Take half\n"
               "of it if links are tension-only, as with spring-scene --tension-only. A line\n"
               "\"limit:\" warns if the recommended step is longer than the stable step: the error is measured in a\n"
               "single run, and longer runs may be unstable.\n"
               "spring-work --problem steps measures what longer steps cost.\n\n"
               "With --presets: scene, method, error, substeps (per frame; 0: not known), dt_s, measured_error,\n"
               "uncertainty and stable_substeps (the fewest whose step is below the stable step; 0: none).\n\n"
               "With --sag: limit (scene or link, whose stretch is S or at most 0.1 % of S less), stiffness_N_per_m,\n"
               "scene_stretch and link_stretch (the stretch of the scene and of its most stretched link, at rest),\n"
               "stable_step_s (of leapfrog), steps_per_frame (the fewest steps for 1/60 s that this rule\n"
               "allows), dt_s, time_per_frame_s (on this machine) and precision (double or float). The rows\n"
               "of float have the stiffness and the stretch of double, and steps and a time of their own. A scene\n"
               "whose height depends on more than the stretch of its links, such as a hammock, has only the rows for\n"
               "link.",
    .shown = {"dt_s", "measured_error"},
    .examples = {"--error 0.01 --duration 10 --hertz 2 --damping-ratio 0.1", "--error 0.05 --duration 1 --scene chain",
                 "--sag 0.02 --scene rope -o stiffness.tsv"},
    .options = options,
};

static void refuse(const char *option, double value, const char *should)
{
    if (!isnan(value))
        cli_fail(CLI_USAGE, "--%s: \"%g\" %s", option, value, should);
}

static void check_presets(void)
{
    refuse("error", error, "is not for --presets, which uses 10, 1 and 0.1 %");
    refuse("duration", duration, "is not for --presets, which uses one second");
    refuse("sag", sag, "is not for --presets");
    refuse("stiffness", stiffness, "is not for --presets");
    refuse("hertz", hertz, "is not for --presets");
    refuse("damping-ratio", damping_ratio, "is not for --presets");
    refuse("mass", mass, "is not for --presets");
    refuse("damping", damping, "is not for --presets");
    refuse("drag", drag, "is not for --presets");
    refuse("bend", bend, "is not for --presets");
    refuse("tethers", tethers, "is not for --presets");
    if (size > 0)
        cli_fail(CLI_USAGE, "--size: \"%" PRIu64 "\" is not for --presets", size);
}

static void check_error(void)
{
    if (isnan(error))
        cli_fail(CLI_USAGE, "--error: is missing; it should be an error such as 0.01");
    if (isnan(duration))
        cli_fail(CLI_USAGE, "--duration: is missing; it should be a time in seconds");
    if (mesh != NULL && isnan(stiffness))
        cli_fail(CLI_USAGE, "--stiffness: is missing; --mesh requires the stiffness of its links");
}

static void check_sag(void)
{
    if (!(sag >= 1e-4 && sag <= 1)) /* smaller stretches take minutes, and are proportional to 1/stiffness */
        refuse("sag", sag, "should be a stretch from 1e-4 to 1, such as 0.02 for 2 %");
    if (kind < 0 && mesh == NULL)
        refuse("sag", sag, "requires --scene or --mesh");
    refuse("error", error, "is not for --sag");
    refuse("duration", duration, "is not for --sag");
    refuse("stiffness", stiffness, "is not for --sag, which finds the stiffness");
}

static void check_usage(void)
{
    if (mesh != NULL && (presets || kind >= 0))
        cli_fail(CLI_USAGE, "--mesh: \"%s\" cannot be combined with --scene or --presets", mesh);
    if (presets) {
        check_presets();
        return;
    }
    if (!isnan(sag))
        check_sag();
    else
        check_error();
    if (kind >= 0 || mesh != NULL) {
        refuse("hertz", hertz, "is for one spring, not for a scene");
        refuse("damping-ratio", damping_ratio, "is for one spring, not for a scene");
        if (mesh != NULL || kind == PRESET_JELLY || kind == PRESET_CHAIN)
            refuse("bend", bend, "is for rope, cloth and water");
        if (kind == PRESET_CHAIN || kind == PRESET_WATER)
            refuse("tethers", tethers, "is not for scenes with one axis");
        if (mesh != NULL && size > 0)
            cli_fail(CLI_USAGE, "--size: \"%" PRIu64 "\" is for --scene; a mesh has a fixed size", size);
        return;
    }
    refuse("drag", drag, "is for a scene; for one spring use --damping");
    refuse("bend", bend, "is for a scene");
    refuse("tethers", tethers, "is for a scene");
    if (size > 0)
        cli_fail(CLI_USAGE, "--size: \"%" PRIu64 "\" is for a scene", size);
    if (isnan(hertz) == isnan(stiffness))
        cli_fail(CLI_USAGE, "--stiffness: give exactly one of --stiffness, --hertz and --scene");
    if (isnan(hertz)) {
        refuse("damping-ratio", damping_ratio, "requires --hertz; with --stiffness use --damping");
    } else {
        refuse("damping", damping, "requires --stiffness; with --hertz use --damping-ratio");
        refuse("mass", mass, "requires --stiffness; with --hertz the mass has no effect");
    }
}

static double or_else(double value, double otherwise)
{
    return isnan(value) ? otherwise : value;
}

/* -------------------------------------------------------------------------------------------------------- the rows */

static plan_row rows[SPRING_METHOD_COUNT];
static int row_count;

static double error_of(const plan_row *r)
{
    return isnan(r->measured) ? r->predicted : r->measured;
}

/* The best row comes first: the most accurate row among those that take at most a tenth longer than the fastest. Then
   the best of the remaining rows, and so on. */
static void sort_rows(void)
{
    const double as_fast = 1.1;
    for (int place = 0; place < row_count; place++) {
        int best = place;
        for (int i = place + 1; i < row_count; i++)
            if (rows[i].time < rows[best].time)
                best = i;
        const double fastest = rows[best].time;
        for (int i = place; i < row_count; i++)
            if (rows[i].time < as_fast * fastest && error_of(&rows[i]) < error_of(&rows[best]))
                best = i;
        const plan_row row = rows[best];
        rows[best] = rows[place];
        rows[place] = row;
    }
}

/* ------------------------------------------------------------------------------------------------------ one spring */

static const double most_steps = 3e8; /* of a measured run: a second or two */

/* The largest singular value of (a b; c d). */
static double norm(double a, double b, double c, double d)
{
    return (hypot(a + d, b - c) + hypot(a - d, b + c)) / 2;
}

/* Compares a run from both unit states with the exact solution: at each of the first 2^16 steps, where fast-decaying
   components have their error, and at as many of the others. */
static double measured_error(const spring_params *p, spring_method m, double steps)
{
    const double dense = 65536, omega = fmax(sqrt(p->stiffness / p->mass), 1 / duration), dt = duration / steps;
    const uint64_t n = (uint64_t)steps, stride = (uint64_t)ceil(steps / dense);
    const spring_state start[2] = {{1, 0}, {0, omega}};
    spring_state run[2] = {start[0], start[1]};
    double most = 0;
    for (uint64_t i = 0; i < n;) {
        const uint64_t wanted = (double)i < dense ? 1 : stride, some = wanted < n - i ? wanted : n - i;
        i += some;
        spring_state off[2];
        for (int k = 0; k < 2; k++) {
            if (spring_advance(&run[k], p, m, dt, some) != SPRING_OK)
                return INFINITY;
            spring_state exact = start[k];
            spring_step_exact(&exact, p, dt * (double)i);
            off[k] = (spring_state){run[k].x - exact.x, run[k].v - exact.v};
        }
        most = fmax(most, norm(off[0].x, off[1].x, off[0].v / omega, off[1].v / omega));
    }
    return most;
}

/* Running time [s]: the shortest of five loops of at least 0.2 ms. */
static double time_of(const spring_params *p, spring_method m, double dt, uint64_t n)
{
    const double long_enough = 2e5; /* [ns] */
    double best = INFINITY;
    uint64_t runs = 1;
    for (int loop = 0; loop < 5; loop++) {
        spring_state s = {0.8, -0.9};
        const double before = timing_now();
        for (uint64_t i = 0; i < runs; i++)
            spring_advance(&s, p, m, dt, n);
        const double spent = timing_now() - before;
        best = fmin(best, spent / (double)runs);
        if (spent < long_enough) {
            runs *= 2;
            loop = -1;
            best = INFINITY;
        }
    }
    return best * 1e-9;
}

/* The largest rounding error of the exact solution in this duration, in the units of --error: the bound of
   spring_step_exact() until the motion has decayed. */
static double exact_rounding(const spring_params *p)
{
    const double omega = sqrt(p->stiffness / p->mass), b = p->damping / p->mass / 2;
    const double decay = b > omega ? omega / (b + sqrt((b - omega) * (b + omega))) * omega : b;
    return 4 * DBL_EPSILON * (1 + fmax(omega, b) * (decay > 0 ? fmin(duration, 1 / decay) : duration));
}

static plan_row plan_spring(const spring_params *p, spring_method m)
{
    const double dt = spring_accurate_step(p, m, duration, error);
    if (dt == 0 || (m == SPRING_EXACT && !(exact_rounding(p) <= error)))
        return (plan_row){.method = m, .predicted = NAN, .measured = NAN, .uncertainty = NAN, .time = INFINITY};
    const double steps = rint(duration / dt), timed = fmin(steps, most_steps / 30);
    return (plan_row){
        .method = m,
        .steps = steps,
        .dt = dt,
        .evaluations = steps * spring_method_describe(m)->forces_per_step,
        .predicted = spring_step_error(p, m, duration, dt),
        .measured = steps <= most_steps ? measured_error(p, m, steps) : NAN,
        .uncertainty = 0,
        .time = time_of(p, m, dt, (uint64_t)timed) * (steps / timed),
    };
}

static spring_params chosen_spring(void)
{
    const spring_params p = isnan(hertz) ? (spring_params){or_else(mass, 1), stiffness, or_else(damping, 0), 0}
                                         : spring_params_hertz(hertz, or_else(damping_ratio, 0));
    const spring_params undamped = spring_params_hertz(hertz, 0);
    if (!isnan(hertz) && !spring_params_valid(&p) && spring_params_valid(&undamped))
        cli_fail(CLI_USAGE, "--damping-ratio: \"%g\" is too large; 4 pi hertz damping_ratio should be finite",
                 damping_ratio);
    if (!isnan(hertz) && !spring_params_valid(&p))
        cli_fail(CLI_USAGE,
                 "--hertz: \"%g\" is too large or too small; (2 pi hertz)^2 should be a finite number greater than 0",
                 hertz);
    if (!spring_params_valid(&p))
        cli_fail(CLI_USAGE, "--mass: \"%g\" gives stiffness/mass %g and damping/mass %g; both should be finite", p.mass,
                 p.stiffness / p.mass, p.damping / p.mass);
    return p;
}

static void plan_one_spring(const spring_params *p)
{
    for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
        const spring_method m = spring_method_at(place);
        if (spring_method_describe(m)->springs)
            rows[row_count++] = plan_spring(p, m);
        cli_progress((place + 1.0) / SPRING_METHOD_COUNT);
    }
}

static void plan_one_scene(const preset *scene)
{
    const double work = 1e9; /* a second or two */
    plan_scene *s = plan_scene_new(scene, duration, error, work);
    for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
        const spring_method m = spring_method_at(place);
        if (spring_method_describe(m)->scenes)
            rows[row_count++] = plan_scene_row(s, m, error, work, true);
        cli_progress((place + 1.0) / SPRING_METHOD_COUNT);
    }
    if (row_count > 0 && rows[0].uncertainty > error)
        cli_warn("the uncertainty of the reference, %g, is larger than the requested error", rows[0].uncertainty);
    plan_scene_free(s);
}

/* A scene of spring-scene, with a poke if it is height-field water. */
static preset poked_preset(const preset_settings *settings, disturbances **poke)
{
    preset scene;
    start_preset(&scene, settings);
    *poke = start_poke(&scene, settings);
    return scene;
}

static preset chosen_scene(disturbances **poke)
{
    if (mesh != NULL) {
        const mesh_settings settings = {or_else(mass, 1), or_else(stiffness, 1), or_else(damping, 0), or_else(drag, 0)};
        preset read = mesh_read(mesh, &settings);
        start_links(&read, 0, or_else(tethers, 0));
        return read;
    }
    preset_settings chosen = preset_unchosen((preset_kind)kind);
    chosen.size = size;
    chosen.mass = mass;
    chosen.stiffness = stiffness;
    chosen.damping = damping;
    chosen.drag = drag;
    const preset_settings settings = preset_chosen(&chosen);
    preset scene = poked_preset(&settings, poke);
    start_links(&scene, or_else(bend, 0), or_else(tethers, 0));
    return scene;
}

static const plan_row *first_stepper(void)
{
    for (int i = 0; i < row_count; i++)
        if (rows[i].steps > 0 && spring_method_describe(rows[i].method)->order > 0)
            return &rows[i];
    return NULL;
}

/* Prints the first row in words and, for one spring, the first row of a step method. */
static void say(cli_table *table)
{
    const plan_row *first = &rows[0], *stepper = first_stepper();
    char steps[160] = "no stepper is known to be accurate enough";
    if (stepper != NULL)
        snprintf(steps, sizeof steps, "%s in %.0f step%s of %.4g s, %.3g s on this machine",
                 spring_method_describe(stepper->method)->label, stepper->steps, stepper->steps == 1 ? "" : "s",
                 stepper->dt, stepper->time);
    if (first->steps > 0 && first != stepper)
        cli_comment(
            table,
            "plan: for an error of %g after %g s, use the exact solution, %.3g s on this machine; as a stepper, %s.",
            error, duration, first->time, steps);
    else
        cli_comment(table, "plan: for an error of %g after %g s, %s%s.", error, duration, stepper != NULL ? "use " : "",
                    steps);
}

/* Prints the rule for the step of leapfrog, at most `most` of the stable step, with the stable steps [s] of both
   precisions. */
static void say_rule(cli_table *table, const preset *scene, double most, double stable, double stable_float)
{
    const char *what;
    const double fraction = fmin(most, plan_fraction(scene, duration, &what));
    char in_float[80] = "not representable";
    if (!isnan(stable_float))
        snprintf(in_float, sizeof in_float, "%.4g s, %.0f", fraction * stable_float,
                 ceil(plan_frame / (fraction * stable_float)));
    if (stable > 0 && isfinite(stable))
        cli_comment(table,
                    "steps: for %s, leapfrog may take %g of the stable step: %.4g s, %.0f per frame (float: %s).", what,
                    fraction, fraction * stable, ceil(plan_frame / (fraction * stable)), in_float);
}

/* Prints a warning if the recommended step is above the stable step: the error is measured in one run. */
static void say_limit(cli_table *table, const preset *scene)
{
    const plan_row *first = first_stepper();
    if (first == NULL)
        return;
    const double stable = start_stable_step(scene, first->method);
    if (first->dt > stable)
        cli_comment(table,
                    "limit: the step of the plan is longer than the stable step of this method, %.4g s; it may be "
                    "unstable in longer runs.",
                    stable);
}

/* Prints the cost of damped links in a step of leapfrog. */
static void say_damping(cli_table *table, const preset *scene)
{
    for (int i = 0; i < row_count; i++) {
        double reach;
        if (rows[i].method != SPRING_LEAPFROG || !(rows[i].steps > 0))
            continue;
        const unsigned evaluations = plan_damping_evaluations(scene, rows[i].dt, &reach);
        if (reach > 0)
            cli_comment(
                table,
                "damping: dt G = %.3g, so a step of leapfrog evaluates the forces once and damping alone %u time%s",
                reach, evaluations, evaluations == 1 ? "" : "s");
    }
}

static void write_plan(cli_table *table, const preset *scene)
{
    sort_rows();
    say(table);
    if (scene != NULL) {
        say_rule(table, scene, 1, start_stable_step(scene, SPRING_LEAPFROG), start_stable_step_in_float(scene));
        say_limit(table, scene);
        say_damping(table, scene);
    }
    cli_columns(table, program.columns);
    for (int i = 0; i < row_count; i++) {
        const plan_row *r = &rows[i];
        cli_row(table, "%s\t%.17g\t%.0f\t%.0f\t%.17g\t%.17g\t%.4g\t%.3g", spring_method_name(r->method), r->dt,
                r->steps, r->evaluations, r->predicted, r->measured, r->time, r->uncertainty);
    }
}

/* ------------------------------------------------------------------------------------------------------ all presets */

static double stable_substeps(const preset *r, spring_method m)
{
    const double step = start_stable_step(r, m);
    return step > 0 ? floor(plan_frame / step) + 1 : 0;
}

static void write_presets(void)
{
    cli_table *table = cli_open_output();
    static const double errors[] = {0.1, 0.01, 0.001};
    const double finest = 0.001, work = quick ? 3e7 : 1e9;
    cli_columns(table, "scene method error substeps dt_s measured_error uncertainty stable_substeps");
    for (int each = 0; each < preset_kinds; each++) {
        if (kind >= 0 && each != kind)
            continue;
        const preset_settings settings = preset_defaults((preset_kind)each);
        disturbances *poke;
        preset scene = poked_preset(&settings, &poke);
        plan_scene *s = plan_scene_new(&scene, 1, finest, work);
        for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
            const spring_method m = spring_method_at(place);
            if (!spring_method_describe(m)->scenes)
                continue;
            for (int k = 0; k < 3; k++) {
                const plan_row r = plan_scene_row(s, m, errors[k], work, false);
                cli_row(table, "%s\t%s\t%.17g\t%.0f\t%.17g\t%.17g\t%.17g\t%.0f", preset_names[each],
                        spring_method_name(m), errors[k], r.steps / (double)plan_scene_frames(s), r.dt, r.measured,
                        r.uncertainty, stable_substeps(&scene, m));
            }
        }
        plan_scene_free(s);
        disturbances_free(poke);
        preset_clear(&scene);
        cli_progress((each + 1.0) / preset_kinds);
    }
}

static void write_spring(void)
{
    const spring_params p = chosen_spring();
    cli_table *table = cli_open_output();
    timing_stamp(table);
    plan_one_spring(&p);
    write_plan(table, NULL);
}

static void write_sag(cli_table *table, preset *scene)
{
    static const char *const what[] = {[PLAN_SCENE] = "scene", [PLAN_LINK] = "link"};
    static const char *const precision[] = {[PLAN_DOUBLE] = "double", [PLAN_FLOAT] = "float"};
    plan_sag row[plan_limits];
    plan_stiffness(scene, sag, or_else(damping, 0), row);
    for (int i = 0; i < plan_limits; i++) {
        const plan_steps *const both = row[i].steps;
        char in_float[80] = "";
        if (!isnan(both[PLAN_FLOAT].time))
            snprintf(in_float, sizeof in_float, ", or %.3g s in single precision", both[PLAN_FLOAT].time);
        if (isnan(row[i].stiffness))
            cli_comment(
                table, "plan: no row for the scene, because its height depends on more than the stretch of its links.");
        else
            cli_comment(
                table,
                "plan: for a %s that is stretched by at most %g, use a stiffness of %.4g N/m and leapfrog with %.0f "
                "step%s per frame, %.3g s on this machine%s.",
                what[i], sag, row[i].stiffness, both->substeps, both->substeps == 1 ? "" : "s", both->time, in_float);
        if (!isnan(row[i].stiffness))
            say_rule(table, scene, row[i].most, both->stable_step, both[PLAN_FLOAT].stable_step);
    }
    cli_columns(table, "limit stiffness_N_per_m scene_stretch link_stretch stable_step_s steps_per_frame dt_s "
                       "time_per_frame_s precision");
    for (int i = 0; i < plan_limits; i++)
        for (int p = 0; p < plan_precisions && !isnan(row[i].stiffness); p++) {
            const plan_steps *const s = &row[i].steps[p];
            if (isnan(s->stable_step)) /* not representable in single precision */
                continue;
            cli_row(table, "%s\t%.17g\t%.17g\t%.17g\t%.17g\t%.0f\t%.17g\t%.4g\t%s", what[i], row[i].stiffness,
                    row[i].stretch[PLAN_SCENE], row[i].stretch[PLAN_LINK], s->stable_step, s->substeps,
                    plan_frame / s->substeps, s->time, precision[p]);
        }
}

static void write_scene(void)
{
    disturbances *poke = NULL;
    preset scene = chosen_scene(&poke);
    cli_table *table = cli_open_output();
    timing_stamp(table);
    char tethered[40] = "";
    if (scene.tethers > 0)
        snprintf(tethered, sizeof tethered, ", %zu tethers", scene.tethers);
    cli_comment(table, "scene: %s, %zu particles, %zu links%s", mesh != NULL ? "a mesh" : preset_names[kind],
                scene.def.particles, scene.def.links - scene.tethers, tethered);
    if (!isnan(sag)) {
        write_sag(table, &scene);
    } else {
        plan_one_scene(&scene);
        write_plan(table, &scene);
    }
    disturbances_free(poke);
    preset_clear(&scene);
}

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    check_usage();
    if (presets)
        write_presets();
    else if (kind >= 0 || mesh != NULL)
        write_scene();
    else
        write_spring();
    cli_finish();
    return 0;
}
