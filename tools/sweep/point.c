/* SPDX-License-Identifier: MIT */
/* One point of a sweep; see point.h. */
#include "sweep/point.h"

#include <math.h> /* sqrt(), fabs(), fmax(), fmin(), ceil(), floor(), rint(), isfinite(): exact on all systems */
#include <stdlib.h>
#include <string.h>

#include "scenes/disturbances.h"
#include "scenes/presets.h"
#include "scenes/scene_run.h"

static const double frame_rate = 60;            /* [1/s] */
static const double most_steps = 1e7;           /* of one spring; a tenth of a second */
static const double most_particle_steps = 1e10; /* of a scene; a minute or two */
static const double most_numbers = 2e7;         /* kept by a reference: 160 MB */
static const double pi = 3.14159265358979323846;

/* ------------------------------------------------------------------------------------------------------ parameters */

enum {
    ROPE = 2 << PRESET_ROPE,
    CLOTH = 2 << PRESET_CLOTH,
    JELLY = 2 << PRESET_JELLY,
    CHAIN = 2 << PRESET_CHAIN,
    WATER = 2 << PRESET_WATER,
    SPRING = 1 << SWEEP_SPRING,
    FALLING = ROPE | CLOTH | JELLY,
    SCENES = FALLING | CHAIN | WATER,
    NOTHING = SWEEP_PARAMETERS /* replaces no other parameter */
};

/* Values outside of these limits are rejected before divisions. */
static const double tiny = 1e-9, huge = 1e12;

const sweep_parameter_info sweep_parameters[SWEEP_PARAMETERS] = {
    [SWEEP_OMEGA_DT] = {"omega_dt", "omega_dt", "omega times the step (0.1)", 1e-6, 1e6, false, SPRING, NOTHING},
    [SWEEP_DAMPING_RATIO] = {"damping_ratio", "damping_ratio", "damping ratio; 1 is critical (0)", 0, 1e6, false,
                             SPRING, NOTHING},
    [SWEEP_PERIODS] = {"periods", "periods", "duration in periods without damping, to the nearest whole step (10)",
                       1e-6, 1e9, false, SPRING, NOTHING},
    [SWEEP_TOLERANCE] = {"tolerance", "tolerance", "instead of omega_dt: the longest step whose error is at most this",
                         1e-16, 1, false, SPRING, SWEEP_OMEGA_DT},
    [SWEEP_STEPS_PER_FRAME] = {"steps_per_frame", "steps_per_frame", "steps per frame of 1/60 s (8)", 1, 4096, true,
                               SCENES, NOTHING},
    [SWEEP_STABLE_FRACTION] = {"stable_fraction", "stable_fraction",
                               "instead of steps_per_frame: the step divided by the initial stable step", 1e-3, 100,
                               false, SCENES, SWEEP_STEPS_PER_FRAME},
    [SWEEP_DURATION] = {"duration", "duration_s", "duration in whole frames (2)", 1e-6, 3600, false, SCENES, NOTHING},
    [SWEEP_SIZE] = {"size", "size", "particles along an edge", 2, 1e6, true, SCENES, NOTHING},
    [SWEEP_LENGTH] = {"length", "length_m", "length of an edge", tiny, huge, false, SCENES, NOTHING},
    [SWEEP_MASS] = {"mass", "mass_kg", "mass of a particle", tiny, huge, false, SCENES, NOTHING},
    [SWEEP_MASS_RATIO] = {"mass_ratio", "mass_ratio", "mass of the last particle over the mass of the others (1)", tiny,
                          huge, false, ROPE, NOTHING},
    [SWEEP_STIFFNESS] = {"stiffness", "stiffness_N_per_m", "stiffness of a link", tiny, huge, false, SCENES, NOTHING},
    [SWEEP_DAMPING] = {"damping", "damping_N_s_per_m", "damping of a link", 0, huge, false, SCENES, NOTHING},
    [SWEEP_DRAG] = {"drag", "drag_N_s_per_m", "drag on a particle", 0, huge, false, SCENES, NOTHING},
    [SWEEP_GRAVITY] = {"gravity", "gravity_m_per_s2", "gravity, downwards", 0, huge, false, FALLING, NOTHING},
    [SWEEP_STRETCH] = {"stretch", "stretch", "initial length of the links over their rest length", tiny, 1e3, false,
                       SCENES, NOTHING},
    [SWEEP_ANGLE] = {"angle", "angle_deg", "initial angle of the rope; 0 is hanging, 90 is level (90)", 0, 180, false,
                     ROPE, NOTHING},
};

const char *const sweep_measure_names[] = {"error", "energy_error",  "steps",          "force_evaluations",
                                           "dt_s",  "stable_step_s", "explode_time_s", "settling_time_s",
                                           NULL};

const char *const sweep_status_names[] = {"stable",   "growing", "exploded", "unsupported", "no_step",
                                          "too_long", "invalid", "failed",   NULL};

const char *sweep_scene_name(int scene)
{
    return scene == SWEEP_SPRING ? "spring" : preset_names[scene - 1];
}

bool sweep_has(int scene, sweep_parameter p)
{
    return (sweep_parameters[p].scenes >> scene & 1) != 0;
}

static double chosen(const double *value, sweep_parameter p, double otherwise)
{
    return isnan(value[p]) ? otherwise : value[p];
}

/* -------------------------------------------------------------------------------------------------- what both share */

/* Measurements of a run. */
typedef struct looks {
    double error, energy_error; /* the largest so far */
    double exploded_at;         /* [s] infinite: not yet */
    double settled_at;          /* [s] infinite: not yet */
} looks;

static const looks no_looks = {0, 0, INFINITY, INFINITY};

static void look(looks *l, double t, double error, double energy_error, bool exploded, bool quiet)
{
    l->error = error > l->error || isnan(error) ? error : l->error;
    if (!(fabs(energy_error) <= fabs(l->energy_error)))
        l->energy_error = energy_error;
    if (exploded && t < l->exploded_at)
        l->exploded_at = t;
    if (!quiet)
        l->settled_at = INFINITY;
    else if (t < l->settled_at)
        l->settled_at = t;
}

static void overflow(looks *l, double t)
{
    look(l, t, INFINITY, INFINITY, true, false);
}

static void tell(sweep_result *r, const looks *l)
{
    r->number[SWEEP_ERROR] = l->error;
    r->number[SWEEP_ENERGY_ERROR] = l->energy_error;
    r->number[SWEEP_EXPLODE_TIME] = l->exploded_at;
    r->number[SWEEP_SETTLING_TIME] = l->settled_at;
}

static void tell_steps(sweep_result *r, spring_method m, double steps, double dt, double stable)
{
    r->number[SWEEP_STEPS] = steps;
    r->number[SWEEP_FORCE_EVALUATIONS] = steps * spring_method_describe(m)->forces_per_step;
    r->number[SWEEP_DT] = dt;
    r->number[SWEEP_STABLE_STEP] = stable;
}

/* ------------------------------------------------------------------------------------------------------- one spring */

static double length(double a, double b)
{
    return sqrt(a * a + b * b);
}

/* The largest singular value of (a b; c d). */
static double norm(double a, double b, double c, double d)
{
    return (length(a + d, b - c) + length(a - d, b + c)) / 2;
}

static const spring_state starts[2] = {{1, 0}, {0, 1}};

/* Compares a run with the exact solution at t. */
static void look_at_spring(looks *l, const spring_params *p, const spring_state *run, double t)
{
    const double settled = 0.01, hundredfold = 100;
    spring_state exact[2] = {starts[0], starts[1]};
    double largest = 0, off = 0;
    for (int i = 0; i < 2; i++) {
        spring_step_exact(&exact[i], p, t);
        const double energy = spring_energy(&run[i], p), of_start = spring_energy(&starts[i], p);
        const double difference = (energy - spring_energy(&exact[i], p)) / of_start;
        if (!(fabs(difference) <= fabs(off)))
            off = difference;
        largest = fmax(largest, energy / of_start);
    }
    look(l, t, norm(run[0].x - exact[0].x, run[1].x - exact[1].x, run[0].v - exact[0].v, run[1].v - exact[1].v), off,
         largest > hundredfold, fabs(run[0].x) <= settled && fabs(run[0].v) <= settled);
}

static void run_spring(looks *l, const spring_params *p, spring_method m, double dt, uint64_t steps)
{
    const uint64_t each = 128;
    spring_state run[2] = {starts[0], starts[1]};
    for (uint64_t i = 0; i < steps;) {
        const uint64_t wanted = i < each ? 1 : i / each, some = wanted < steps - i ? wanted : steps - i;
        i += some;
        for (int k = 0; k < 2; k++) {
            if (spring_advance(&run[k], p, m, dt, some) != SPRING_OK) {
                overflow(l, dt * (double)i);
                return;
            }
        }
        look_at_spring(l, p, run, dt * (double)i);
    }
}

/* Computes the step for a tolerance, without a run. */
static void plan_spring(sweep_result *r, const spring_params *p, spring_method m, double duration, double tolerance)
{
    const double dt = spring_accurate_step(p, m, duration, tolerance);
    if (!(dt > 0)) {
        r->status = SWEEP_NO_STEP;
        return;
    }
    tell_steps(r, m, rint(duration / dt), dt, spring_stable_step(p, m));
    r->number[SWEEP_ERROR] = spring_step_error(p, m, duration, dt);
    r->status = dt < r->number[SWEEP_STABLE_STEP] ? SWEEP_STABLE : SWEEP_GROWING;
}

static void measure_spring(sweep_result *r, const double *value, spring_method m)
{
    const spring_params p = {1, 1, 2 * chosen(value, SWEEP_DAMPING_RATIO, 0), 0};
    const double duration = 2 * pi * chosen(value, SWEEP_PERIODS, 10), dt = chosen(value, SWEEP_OMEGA_DT, 0.1);
    if (!spring_method_describe(m)->springs) {
        r->status = SWEEP_UNSUPPORTED;
        return;
    }
    if (!isnan(value[SWEEP_TOLERANCE])) {
        plan_spring(r, &p, m, duration, value[SWEEP_TOLERANCE]);
        return;
    }
    const double steps = fmax(rint(duration / dt), 1), stable = spring_stable_step(&p, m);
    tell_steps(r, m, steps, dt, stable);
    if (!(steps <= most_steps)) {
        r->status = SWEEP_TOO_LONG;
        return;
    }
    looks l = no_looks;
    run_spring(&l, &p, m, dt, (uint64_t)steps);
    tell(r, &l);
    r->status = dt < stable ? SWEEP_STABLE : l.exploded_at < INFINITY ? SWEEP_EXPLODED : SWEEP_GROWING;
}

/* ----------------------------------------------------------------------------------------------------------- scenes */

typedef struct subject {
    preset preset;
    disturbances *poke; /* NULL: none */
    size_t numbers;     /* size of all positions */
    double frame, dt;   /* [s] */
    uint64_t frames;
} subject;

/* The reference: RK4 with short steps. */
struct sweep_memory {
    double key[SWEEP_PARAMETERS + 3]; /* the inputs of the run: scene, values, frame and frames */
    bool known, overflows;
    double *position; /* [(frames + 1)*numbers], including the start */
    double *energy;   /* [frames + 1] */
    double kinetic;   /* [J] the largest */
    double motion;    /* [m] the largest distance from the start */
    bool moves;       /* by more than rounding errors */
};

sweep_memory *sweep_memory_new(void)
{
    return calloc(1, sizeof(sweep_memory));
}

void sweep_memory_free(sweep_memory *memory)
{
    if (memory == NULL)
        return;
    free(memory->position);
    free(memory->energy);
    free(memory);
}

static void positions_of(const subject *s, const spring_scene *scene, double *out)
{
    spring_scene_get(scene, SPRING_POSITION, out, 0, 0, s->preset.def.particles);
}

static preset_settings settings_of(int scene, const double *value)
{
    preset_settings s = preset_unchosen((preset_kind)(scene - 1));
    s.size = (uint64_t)chosen(value, SWEEP_SIZE, 0);
    s.length = value[SWEEP_LENGTH];
    s.mass = value[SWEEP_MASS];
    s.stiffness = value[SWEEP_STIFFNESS];
    s.damping = value[SWEEP_DAMPING];
    s.drag = value[SWEEP_DRAG];
    s.gravity = value[SWEEP_GRAVITY];
    s.stretch = value[SWEEP_STRETCH];
    s = preset_chosen(&s);
    s.end_mass = s.mass * chosen(value, SWEEP_MASS_RATIO, 1);
    return s;
}

/* The number of particles, computed before memory is allocated. */
static double particles_of(const preset_settings *s)
{
    const double n = (double)s->size;
    return s->kind == PRESET_JELLY ? n * n * n : s->kind == PRESET_CLOTH || s->kind == PRESET_WATER ? n * n : n;
}

/* Rotates by the reproducible sine and cosine of the library: the exact solution at the time `angle`. */
static void turn(preset *r, double angle)
{
    const spring_params unit = {1, 1, 0, 0};
    spring_state s = {1, 0};
    spring_step_exact(&s, &unit, angle * (pi / 180));
    for (size_t i = 0; i < r->def.particles; i++) {
        const double along = r->position[2 * i];
        r->position[2 * i] = along * -s.v;
        r->position[2 * i + 1] = along * -s.x;
    }
}

static spring_status begin(subject *s, const preset_settings *settings, const double *value)
{
    const spring_status status = preset_init(&s->preset, settings);
    if (status != SPRING_OK)
        return status;
    if (!isnan(value[SWEEP_ANGLE]))
        turn(&s->preset, value[SWEEP_ANGLE]);
    s->poke = NULL;
    s->numbers = s->preset.def.particles * s->preset.def.axes;
    if (settings->kind != PRESET_WATER)
        return SPRING_OK;
    const disturbance poke = disturbances_poke(&s->preset, settings, disturbance_duration);
    s->poke = disturbances_new(&s->preset, &poke, 1);
    if (s->poke == NULL)
        preset_clear(&s->preset);
    return s->poke == NULL ? SPRING_ENOMEM : SPRING_OK;
}

static void end(subject *s)
{
    disturbances_free(s->poke);
    preset_clear(&s->preset);
}

static spring_scene *start(const subject *s, spring_method m)
{
    size_t bytes;
    spring_scene *scene;
    preset_start(&s->preset, 1u << m, 0, &scene, &bytes);
    return scene;
}

/* Steps per frame, each at most a sixteenth of the stable steps of leapfrog and RK4. Damped links limit RK4 only. */
static double reference_steps(const subject *s, spring_scene *scene)
{
    const double leapfrog = spring_scene_stable_step(scene, SPRING_LEAPFROG);
    const double rk4 = spring_scene_stable_step(scene, SPRING_RK4);
    return fmax(ceil(s->frame / (fmin(leapfrog, rk4) / 16)), 1);
}

static void run_reference(sweep_memory *r, const subject *s, spring_scene *scene, uint64_t substeps)
{
    const double dt = s->frame / (double)substeps;
    positions_of(s, scene, r->position);
    r->overflows = false;
    r->kinetic = r->motion = 0;
    for (uint64_t i = 1; i <= s->frames && !r->overflows; i++) {
        double *now = &r->position[i * s->numbers];
        r->overflows = spring_scene_advance(scene, SPRING_RK4, dt, substeps) != SPRING_OK;
        positions_of(s, scene, now);
        const spring_scene_energies e = spring_scene_energy(scene);
        r->energy[i] = scene_run_total(&e);
        r->kinetic = fmax(r->kinetic, e.kinetic);
        r->motion = fmax(r->motion, scene_run_distance(now, r->position, s->numbers));
    }
    double extent = 0;
    for (size_t i = 0; i < s->numbers; i++)
        extent = fmax(extent, fabs(r->position[i]));
    r->moves = r->motion > 1e-9 * extent;
}

/* Computes the reference of a point, unless it is already known. Points that differ only in the step share it. */
static sweep_status remember(sweep_memory *r, const subject *s, int scene_number, const double *value)
{
    double key[SWEEP_PARAMETERS + 3];
    memcpy(key, value, SWEEP_PARAMETERS * sizeof key[0]);
    key[SWEEP_STEPS_PER_FRAME] = key[SWEEP_STABLE_FRACTION] = 0;
    key[SWEEP_PARAMETERS] = scene_number;
    key[SWEEP_PARAMETERS + 1] = s->frame;
    key[SWEEP_PARAMETERS + 2] = (double)s->frames;
    if (r->known && memcmp(r->key, key, sizeof key) == 0)
        return SWEEP_STABLE;
    r->known = false;
    free(r->position);
    free(r->energy);
    r->position = malloc((s->frames + 1) * s->numbers * sizeof *r->position);
    r->energy = malloc((s->frames + 1) * sizeof *r->energy);
    spring_scene *scene = start(s, SPRING_RK4);
    sweep_status status = SWEEP_FAILED;
    if (r->position != NULL && r->energy != NULL && scene != NULL) {
        const double substeps = reference_steps(s, scene);
        status = SWEEP_TOO_LONG;
        if (substeps * (double)s->frames * (double)s->preset.def.particles <= most_particle_steps) {
            run_reference(r, s, scene, (uint64_t)substeps);
            memcpy(r->key, key, sizeof key);
            r->known = true;
            status = SWEEP_STABLE;
        }
    }
    free(scene);
    return status;
}

/* Runs a scene and stops when it explodes. */
static bool run_scene(looks *l, const sweep_memory *r, const subject *s, spring_scene *scene, spring_method m,
                      uint64_t substeps)
{
    const double tenfold = 10,
                 quiet = 1e-4; /* relative to the largest kinetic energy; quiet is a hundredth of the speed */
    double *now = malloc(s->numbers * sizeof *now);
    if (now == NULL)
        return false;
    for (uint64_t i = 1; i <= s->frames && l->exploded_at == INFINITY; i++) {
        const double t = s->frame * (double)i;
        const bool holds = spring_scene_advance(scene, m, s->dt, substeps) == SPRING_OK;
        const spring_scene_energies e = spring_scene_energy(scene);
        positions_of(s, scene, now);
        const double error = scene_run_distance(now, &r->position[i * s->numbers], s->numbers) / r->motion;
        const double off = (scene_run_total(&e) - r->energy[i]) / r->kinetic;
        if (holds && isfinite(error) && isfinite(off))
            look(l, t, error, off, !(e.kinetic <= tenfold * r->kinetic), e.kinetic <= quiet * r->kinetic);
        else
            overflow(l, t);
    }
    free(now);
    return true;
}

static bool too_long(const subject *s, double particles, double substeps)
{
    const double frames = (double)s->frames;
    return !(particles * 3 * (frames + 1) <= most_numbers && particles * frames * substeps <= most_particle_steps);
}

/* Steps per frame, as chosen or from the stable step. In the latter case a frame is a whole number of steps, about
   1/60 s. */
static double divide(subject *s, const double *value, double stable)
{
    double substeps = chosen(value, SWEEP_STEPS_PER_FRAME, 8);
    s->frame = 1 / frame_rate;
    s->dt = scene_run_step(frame_rate, (uint64_t)substeps);
    if (!isnan(value[SWEEP_STABLE_FRACTION])) {
        s->dt = value[SWEEP_STABLE_FRACTION] * stable;
        substeps = fmax(floor(s->frame / s->dt), 1);
        s->frame = s->dt * substeps;
    }
    s->frames = (uint64_t)fmin(fmax(rint(chosen(value, SWEEP_DURATION, 2) / s->frame), 1), most_numbers);
    return substeps;
}

static sweep_status measure_started(sweep_memory *memory, sweep_result *r, subject *s, spring_scene *scene,
                                    int scene_number, const double *value, spring_method m)
{
    const double stable = spring_scene_stable_step(scene, m);
    if (!isnan(value[SWEEP_STABLE_FRACTION]) && !(stable > 0 && stable < INFINITY))
        return SWEEP_NO_STEP;
    const double substeps = divide(s, value, stable);
    tell_steps(r, m, substeps * (double)s->frames, s->dt, stable);
    if (too_long(s, (double)s->preset.def.particles, substeps))
        return SWEEP_TOO_LONG;
    const sweep_status status = remember(memory, s, scene_number, value);
    if (status != SWEEP_STABLE)
        return status;
    if (memory->overflows || !memory->moves)
        return SWEEP_INVALID;
    looks l = no_looks;
    if (!run_scene(&l, memory, s, scene, m, (uint64_t)substeps))
        return SWEEP_FAILED;
    tell(r, &l);
    return l.exploded_at < INFINITY ? SWEEP_EXPLODED : SWEEP_STABLE;
}

static sweep_status measure_scene(sweep_memory *memory, sweep_result *r, int scene_number, const double *value,
                                  spring_method m)
{
    const preset_settings settings = settings_of(scene_number, value);
    subject s;
    if (!spring_method_describe(m)->scenes)
        return SWEEP_UNSUPPORTED;
    if (particles_of(&settings) * 3 > most_numbers)
        return SWEEP_TOO_LONG;
    const spring_status begun = begin(&s, &settings, value);
    if (begun != SPRING_OK)
        return begun == SPRING_ENOMEM ? SWEEP_FAILED : SWEEP_INVALID;
    sweep_status status = preset_takes(&s.preset, SPRING_RK4) ? SWEEP_UNSUPPORTED : SWEEP_INVALID;
    if (preset_takes(&s.preset, m)) {
        spring_scene *scene = start(&s, m);
        status = scene == NULL ? SWEEP_FAILED : measure_started(memory, r, &s, scene, scene_number, value, m);
        free(scene);
    }
    end(&s);
    return status;
}

void sweep_measure_point(sweep_memory *memory, int scene, const double *value, spring_method m, sweep_result *result)
{
    for (int i = 0; i < SWEEP_MEASURES; i++)
        result->number[i] = NAN;
    if (scene == SWEEP_SPRING)
        measure_spring(result, value, m);
    else
        result->status = (int)measure_scene(memory, result, scene, value, m);
}
