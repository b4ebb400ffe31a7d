/* SPDX-License-Identifier: MIT */
/*
 * A scene through time: forces, the three methods, and what can be asked of a scene and changed in it.
 *
 * Undo      The state lies in one of two frames of memory. The first step of a call reads it there and writes into the
 *           other one, and further steps stay in that; only a call that succeeds makes it the state. So undoing costs
 *           no copy. Without undo there is one frame.
 */
#include "scene_block.h"
#include "processor.h"

/* ------------------------------------------------------------------------------------------------------- forces */

static const scene_kernels *best_kernels(void)
{
    return SPRING_BEST_KERNELS(&SCENE(v128), &SCENE(v256), &SCENE(v512));
}

/* Does a(x, v) depend on v by more than drag? */
static bool velocity_forces(const scene *s)
{
    return s->damped_links > 0 || (s->force != NULL && (s->plan.flags & SPRING_SCENE_FORCE_STILL) == 0);
}

/* The forces of links and callback at time t, on positions and velocities at these offsets. */
static void evaluate(const scene_kernels *kernels, const scene *s, size_t x, size_t v, double t)
{
    const scene_plan *p = &s->plan;
    const bool damped = s->damped_links > 0;
    scene_row row[most_rows];
    scene_links links = {
        .particles = p->particles,
        .stride = p->stride,
        .x = scene_axis(s, x, 0),
        .v = scene_axis(s, v, 0),
        .force = scene_axis(s, p->force, 0),
        .rows = p->rows,
        .row = row,
    };
    for (uint32_t r = 0; r < p->rows; r++) {
        const row_place *place = &p->row[r];
        row[r] = (scene_row){
            .offset = place->offset,
            .first = place->first,
            .end = place->end,
            .present = place->equal ? scene_bytes_at(s, p->row_present) + place->present : NULL,
            .stiffness = scene_array(s, p->row_stiffness) + place->numbers,
            .rest = scene_array(s, p->row_rest) + place->numbers,
            .damping = damped ? scene_array(s, p->row_damping) + place->numbers : NULL,
        };
    }
    kernels->rows[p->axes - 1][damped](&links);
    if (p->list_links > 0) {
        links.list = (scene_list){
            .count = p->list_links,
            .a = scene_indices(s, p->list_a),
            .b = scene_indices(s, p->list_b),
            .stiffness = scene_array(s, p->list_stiffness),
            .rest = scene_array(s, p->list_rest),
            .damping = damped ? scene_array(s, p->list_damping) : NULL,
        };
        kernels->list[p->axes - 1][damped](&links);
    }
    if (s->force != NULL) {
        const scalar *position[3] = {NULL}, *velocity[3] = {NULL};
        scalar *force[3] = {NULL};
        for (uint32_t a = 0; a < p->axes; a++) {
            position[a] = scene_axis(s, x, a);
            velocity[a] = scene_axis(s, v, a);
            force[a] = scene_axis(s, p->force, a);
        }
        s->force(s->user, t, p->particles, position, velocity, force);
    }
}

static double time_of(const scene *s)
{
    return s->t0 + (double)s->steps * s->dt;
}

/* Forces of the state, unless they are at hand, in memory of the scene that is no part of its state. Those of a callback
   are not kept: what *user holds may change before the next step. */
static void update_force(scene *s)
{
    if (s->force_kept)
        return;
    evaluate(best_kernels(), s, s->plan.x[s->frame], s->plan.v[s->frame], time_of(s));
    s->force_kept = s->force == NULL;
}

/* ------------------------------------------------------------------------------------------------------ methods */

/* A part of a step: from one frame to another, or to itself. */
static scene_motion motion(const scene *s, double dt, uint32_t from, uint32_t to)
{
    const scene_plan *p = &s->plan;
    scene_motion m = {
        .particles = p->particles,
        .axes = p->axes,
        .stride = p->stride,
        .inverse_mass = p->inverse_mass != 0 ? scene_array(s, p->inverse_mass) : NULL,
        .inverse_mass_all = (scalar)(1 / s->mass_all),
        .drag = (scalar)s->drag,
        .h = (scalar)dt,
        .force = scene_axis(s, p->force, 0),
        .x0 = scene_axis(s, p->x[from], 0),
        .v0 = scene_axis(s, p->v[from], 0),
        .x = scene_axis(s, p->x[to], 0),
        .v = scene_axis(s, p->v[to], 0),
        .stage_v = scene_axis(s, p->v[from], 0),
        .sum_x = scene_axis(s, p->sum_x, 0),
        .sum_v = scene_axis(s, p->sum_v, 0),
    };
    for (uint32_t a = 0; a < p->axes; a++)
        m.gravity[a] = (scalar)s->gravity[a];
    return m;
}

/* The times of a step: never a sum of steps, and the end of one is the begin of the next, to the bit. */
typedef struct span {
    double begin, middle, end;
} span;

/* One step from a frame, whose forces are known, to a frame; whether the forces at its end are known, too. */
typedef struct outcome {
    bool finite, force_kept;
} outcome;

static outcome euler(const scene_kernels *kernels, scene *s, uint32_t from, uint32_t to, span t, double dt)
{
    (void)t;
    const scene_motion m = motion(s, dt, from, to);
    return (outcome){kernels->euler(&m), false};
}

/* What is not finite any more ends a step at once: a callback is shown nothing else. */
static outcome leapfrog(const scene_kernels *kernels, scene *s, uint32_t from, uint32_t to, span t, double dt)
{
    const scene_plan *p = &s->plan;
    const scene_motion first = motion(s, dt, from, to);
    scene_motion last = first;
    last.v0 = last.v;
    if (!kernels->kick_drift(&first))
        return (outcome){.finite = false};
    evaluate(kernels, s, p->x[to], p->v[to], t.end);
    if (!velocity_forces(s))
        return (outcome){kernels->kick(&last), true};
    scene_motion predict = last;
    predict.v = scene_axis(s, p->predicted, 0);
    if (!kernels->kick(&predict))
        return (outcome){.finite = false};
    evaluate(kernels, s, p->x[to], p->predicted, t.end);
    return (outcome){kernels->kick(&last), false};
}

static outcome rk4(const scene_kernels *kernels, scene *s, uint32_t from, uint32_t to, span t, double dt)
{
    const scene_plan *p = &s->plan;
    const double times[] = {t.middle, t.middle, t.end};
    scene_motion stage = motion(s, dt, from, p->work);
    for (int k = 0; k < 3; k++) {
        if (!kernels->rk4_stage[k](&stage))
            return (outcome){.finite = false};
        evaluate(kernels, s, p->x[p->work], p->v[p->work], times[k]);
        stage.stage_v = stage.v;
    }
    scene_motion end = motion(s, dt, from, to);
    end.stage_v = stage.v;
    return (outcome){kernels->rk4_end(&end), false};
}

typedef outcome scene_step(const scene_kernels *kernels, scene *s, uint32_t from, uint32_t to, span t,
                           double dt);

static bool finite_state(const scene *s)
{
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *x = scene_axis(s, s->plan.x[s->frame], a), *v = scene_axis(s, s->plan.v[s->frame], a);
        for (size_t i = 0; i < s->plan.particles; i++)
            if (!isfinite(x[i]) || !isfinite(v[i]))
                return false;
    }
    return true;
}

/* After a failure without undo nothing is left of the state, not even what is finite. */
static void lose(scene *s)
{
    const int nan = 0xff; /* in each byte */
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        memset(scene_axis(s, s->plan.x[s->frame], a), nan, s->plan.particles * sizeof(scalar));
        memset(scene_axis(s, s->plan.v[s->frame], a), nan, s->plan.particles * sizeof(scalar));
    }
    s->broken = true;
}

spring_status SCENE(advance_with)(const scene_kernels *kernels, scene *s, spring_method m, double dt,
                                  uint64_t n)
{
    static scene_step *const step[] = {
        [SPRING_EULER] = euler, [SPRING_LEAPFROG] = leapfrog, [SPRING_RK4] = rk4};
    if (s == NULL || spring_method_name(m) == NULL || !isfinite((scalar)dt))
        return SPRING_EINVAL;
    if ((s->plan.methods & 1u << m) == 0)
        return SPRING_EUNSUPPORTED;
    if (n == 0 || (scalar)dt == 0)
        return SPRING_OK;
    if (s->broken && !finite_state(s)) /* the caller has not set all that was lost */
        return SPRING_ENONFINITE;
    s->broken = false;
    const bool undo = (s->plan.flags & SPRING_SCENE_NO_UNDO) == 0;
    const bool same_run = s->dt == dt;
    const double t0 = same_run ? s->t0 : time_of(s);
    const uint64_t before = same_run ? s->steps : 0;
    if (!isfinite(t0 + (double)(before + n) * dt))
        return SPRING_ENONFINITE;
    uint32_t from = s->frame;
    const uint32_t to = undo ? 1 - from : from;
    for (uint64_t i = 0; i < n; i++) {
        const double done = (double)(before + i);
        const span t = {t0 + done * dt, t0 + (done + 0.5) * dt, t0 + (double)(before + i + 1) * dt};
        if (!s->force_kept)
            evaluate(kernels, s, s->plan.x[from], s->plan.v[from], t.begin);
        const outcome end = step[m](kernels, s, from, to, t, dt);
        s->force_kept = end.force_kept;
        if (!end.finite) {
            s->force_kept = false;
            if (!undo)
                lose(s);
            return SPRING_ENONFINITE;
        }
        from = to;
    }
    s->frame = to;
    s->t0 = t0;
    s->dt = dt;
    s->steps = before + n;
    return SPRING_OK;
}

spring_status SCENE(advance)(scene *s, spring_method m, double dt, uint64_t n)
{
    return SCENE(advance_with)(best_kernels(), s, m, dt, n);
}

/* ----------------------------------------------------------------------------------------------- the stable step */

typedef enum link_number { STIFFNESS, DAMPING } link_number;

/* Over the particles that move the largest sum of twice a number of their links, once where the other end is pinned, and
   of what each particle has of its own; by_mass: times the inverse mass. Uses the memory of the forces. */
static double largest_sum(scene *s, link_number number, double own, bool by_mass)
{
    const scalar *inverse_mass = s->plan.inverse_mass != 0 ? scene_array(s, s->plan.inverse_mass) : NULL;
    scalar *sum = scene_axis(s, s->plan.force, 0);
    memset(sum, 0, s->plan.particles * sizeof *sum);
    for (size_t i = 0; i < s->plan.links; i++) {
        const placed_link link = scene_link(s, i);
        const scalar *value = number == STIFFNESS ? link.stiffness : link.damping;
        if (value == NULL)
            continue;
        sum[link.a] += inverse_mass != NULL && inverse_mass[link.b] == 0 ? *value : 2 * *value;
        sum[link.b] += inverse_mass != NULL && inverse_mass[link.a] == 0 ? *value : 2 * *value;
    }
    double largest = 0;
    for (size_t i = 0; i < s->plan.particles; i++) {
        const double inverse = inverse_mass_at(s, i);
        if (inverse > 0)
            largest = fmax(largest, ((double)sum[i] + own) * (by_mass ? inverse : 1));
    }
    s->force_kept = false;
    return largest;
}

static void find_limits(scene *s)
{
    s->L = largest_sum(s, STIFFNESS, 0, true);
    s->G = largest_sum(s, DAMPING, s->drag, true);
    s->K = largest_sum(s, STIFFNESS, 0, false);
    s->limits_known = true;
}

double SCENE(stable_step)(const scene *s, spring_method m)
{
    const double rk4_limit =
        2.61; /* |hz| below which RK4 is stable in every direction of the left half plane */
    if (s == NULL || spring_method_name(m) == NULL || m == SPRING_EXACT)
        return NAN;
    if (!s->limits_known)
        find_limits((scene *)(uintptr_t)s);
    const double omega = sqrt(s->L), G = s->G, K = s->K;
    switch (m) {
    case SPRING_LEAPFROG:
        return s->damped_links > 0 ? fmin(2 / omega, 2 / G) : 2 / omega;
    case SPRING_RK4:
        return rk4_limit / fmax(omega, G);
    default:
        return K > 0 ? fmin(s->drag / K, 2 / G) : 2 / G;
    }
}

/* ----------------------------------------------------------------------------------------------------- questions */

double SCENE(time)(const scene *s)
{
    return s != NULL ? time_of(s) : NAN;
}

/* How a link is drawn out: its length, and how fast that grows. On one axis both have the sign of the link. */
typedef struct drawn {
    double length, rate;
} drawn;

static drawn draw(const scene *s, const placed_link *link)
{
    const scene_plan *p = &s->plan;
    double way[3] = {0}, relative[3] = {0};
    for (uint32_t a = 0; a < p->axes; a++) {
        const scalar *x = scene_axis(s, p->x[s->frame], a), *v = scene_axis(s, p->v[s->frame], a);
        way[a] = (double)x[link->b] - (double)x[link->a];
        relative[a] = (double)v[link->b] - (double)v[link->a];
    }
    if (p->axes == 1)
        return (drawn){way[0], relative[0]};
    const double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    const double rate = way[0] * relative[0] + way[1] * relative[1] + way[2] * relative[2];
    return (drawn){length, length > 0 ? rate / length : 0};
}

spring_scene_energies SCENE(energy)(const scene *s)
{
    if (s == NULL)
        return (spring_scene_energies){NAN, NAN, NAN};
    spring_scene_energies e = {0, 0, 0};
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *x = scene_axis(s, s->plan.x[s->frame], a), *v = scene_axis(s, s->plan.v[s->frame], a);
        for (size_t i = 0; i < s->plan.particles; i++) {
            const double inverse = inverse_mass_at(s, i);
            if (inverse > 0) {
                e.kinetic += (double)v[i] * (double)v[i] / inverse / 2;
                e.gravity -= (double)x[i] * s->gravity[a] / inverse;
            }
        }
    }
    for (size_t i = 0; i < s->plan.links; i++) {
        const placed_link link = scene_link(s, i);
        const double extension = draw(s, &link).length - (double)*link.rest;
        e.elastic += (double)*link.stiffness * extension * extension / 2;
    }
    return e;
}

bool SCENE(at_rest)(const scene *s, double v_tol, double a_tol)
{
    if (s == NULL || !(v_tol >= 0) || !(a_tol >= 0) || !finite_state(s))
        return false;
    update_force((scene *)(uintptr_t)s);
    const scene_motion m = motion(s, 0, s->frame, s->frame);
    for (size_t i = 0; i < m.particles; i++) {
        const double inverse = inverse_mass_at(s, i);
        double speed = 0, acceleration = 0; /* squared */
        for (uint32_t a = 0; a < m.axes; a++) {
            const double v = (double)m.v0[a * m.stride + i],
                         force = (double)m.force[a * m.stride + i] - s->drag * v;
            const double felt = inverse > 0 ? inverse * force + s->gravity[a] : 0;
            speed += v * v;
            acceleration += felt * felt;
        }
        if (!(sqrt(speed) <= v_tol) || !(sqrt(acceleration) <= a_tol))
            return false;
    }
    return true;
}

double SCENE(tension)(const scene *s, size_t index)
{
    if (s == NULL || index >= s->plan.links)
        return NAN;
    const placed_link link = scene_link(s, index);
    const bool reversed = s->plan.axes == 1 && signbit(*link.rest);
    const drawn d = draw(s, &link);
    const double pull = (double)*link.stiffness * (d.length - (double)*link.rest) +
                        (link.damping != NULL ? (double)*link.damping * d.rate : 0);
    return reversed ? -pull : pull;
}

/* ------------------------------------------------------------------------------------------------ in and out */

/* Checks what get, getf and set have in common; the stride in elements. */
static spring_status check_range(const scene *s, spring_quantity q, const void *buffer, size_t *stride,
                                 size_t first, size_t count)
{
    if (s == NULL || buffer == NULL || (q != SPRING_POSITION && q != SPRING_VELOCITY))
        return SPRING_EINVAL;
    if (*stride == 0)
        *stride = s->plan.axes;
    if (*stride < s->plan.axes)
        return SPRING_EINVAL;
    return first <= s->plan.particles && count <= s->plan.particles - first ? SPRING_OK : SPRING_ERANGE;
}

static scalar *quantity(const scene *s, spring_quantity q, uint32_t axis)
{
    return scene_axis(s, q == SPRING_POSITION ? s->plan.x[s->frame] : s->plan.v[s->frame], axis);
}

spring_status SCENE(get)(const scene *s, spring_quantity q, double *out, size_t stride, size_t first,
                         size_t count)
{
    const spring_status status = check_range(s, q, out, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *from = quantity(s, q, a) + first;
        for (size_t i = 0; i < count; i++)
            out[i * stride + a] = (double)from[i];
    }
    return SPRING_OK;
}

spring_status SCENE(getf)(const scene *s, spring_quantity q, float *out, size_t stride, size_t first,
                          size_t count)
{
    const spring_status status = check_range(s, q, out, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        const scalar *from = quantity(s, q, a) + first;
        for (size_t i = 0; i < count; i++)
            out[i * stride + a] = (float)from[i];
    }
    return SPRING_OK;
}

spring_status SCENE(set)(scene *s, spring_quantity q, const double *in, size_t stride, size_t first,
                         size_t count)
{
    const spring_status status = check_range(s, q, in, &stride, first, count);
    if (status != SPRING_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        for (uint32_t a = 0; a < s->plan.axes; a++)
            if (!isfinite((scalar)in[i * stride + a]))
                return SPRING_EINVAL;
    for (uint32_t a = 0; a < s->plan.axes; a++) {
        scalar *to = quantity(s, q, a) + first;
        for (size_t i = 0; i < count; i++)
            to[i] = (scalar)in[i * stride + a];
    }
    s->force_kept = false;
    return SPRING_OK;
}

spring_status SCENE(set_gravity)(scene *s, const double gravity[3])
{
    if (s == NULL || gravity == NULL)
        return SPRING_EINVAL;
    for (uint32_t a = 0; a < s->plan.axes; a++)
        if (!isfinite((scalar)gravity[a]))
            return SPRING_EINVAL;
    for (uint32_t a = 0; a < s->plan.axes; a++)
        s->gravity[a] = gravity[a];
    return SPRING_OK;
}

spring_status SCENE(set_force)(scene *s, scene_force_fn *force, void *user)
{
    if (s == NULL)
        return SPRING_EINVAL;
    s->force = force;
    s->user = user;
    s->force_kept = false;
    return SPRING_OK;
}
