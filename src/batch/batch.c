/* SPDX-License-Identifier: MIT */
/*
 * Many independent springs: checks, choice of the kernels, and springs that do not fill a group.
 */
#include "../kernels/batch_kernels.h"
#include "../simd/targets.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { largest_vector = 16, largest_group = 8 * largest_vector }; /* [springs] 64 bytes of float */

static const uint32_t known_bits = SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA | SPRING_SHARED_ACCEL;

static bool is_shared(const spring_batch *b, uint32_t bit)
{
    return (b->shared & bit) != 0;
}

static bool bytes_overlap(const void *a, size_t a_bytes, const void *b, size_t b_bytes)
{
    const uintptr_t p = (uintptr_t)a, q = (uintptr_t)b;
    return p < q ? q - p < a_bytes : p - q < b_bytes;
}

static bool overlap(const scalar *a, size_t a_count, const scalar *b, size_t b_count)
{
    return bytes_overlap(a, a_count * sizeof(scalar), b, b_count * sizeof(scalar));
}

/* Whether an array of parameters is NULL or does not overlap the state. */
static bool leaves_state_alone(const spring_batch *b, const scalar *parameter, uint32_t bit)
{
    const size_t count = is_shared(b, bit) ? 1 : b->count;
    return parameter == NULL ||
           (!overlap(b->x, b->count, parameter, count) && !overlap(b->v, b->count, parameter, count));
}

/* An invalid shared parameter fails the call before any state changes. Other parameters concern one spring only. */
static bool shared_valid(const spring_batch *b, const scalar *parameter, uint32_t bit, scalar least)
{
    return parameter == NULL || !is_shared(b, bit) || (scalar_finite(*parameter) && *parameter >= least);
}

static bool batch_valid(const spring_batch *b)
{
    if ((b->shared & ~known_bits) != 0)
        return false;
    if (b->count == 0)
        return true;
    return b->x != NULL && b->v != NULL && b->omega2 != NULL && b->count <= SIZE_MAX / sizeof(scalar) &&
           !overlap(b->x, b->count, b->v, b->count) && leaves_state_alone(b, b->omega2, SPRING_SHARED_OMEGA2) &&
           leaves_state_alone(b, b->gamma, SPRING_SHARED_GAMMA) &&
           leaves_state_alone(b, b->accel, SPRING_SHARED_ACCEL) &&
           shared_valid(b, b->omega2, SPRING_SHARED_OMEGA2, 0) && shared_valid(b, b->gamma, SPRING_SHARED_GAMMA, 0) &&
           shared_valid(b, b->accel, SPRING_SHARED_ACCEL, -(scalar)INFINITY);
}

/* Whether the marks overlap an array of a valid batch. */
static bool touches_batch(const spring_batch *b, const uint8_t *failed)
{
    const scalar *const array[] = {b->x, b->v, b->omega2, b->gamma, b->accel};
    static const uint32_t bit[] = {0, 0, SPRING_SHARED_OMEGA2, SPRING_SHARED_GAMMA, SPRING_SHARED_ACCEL};
    for (size_t j = 0; j < sizeof array / sizeof array[0]; j++)
        if (array[j] != NULL &&
            bytes_overlap(array[j], (is_shared(b, bit[j]) ? 1 : b->count) * sizeof(scalar), failed, b->count))
            return true;
    return false;
}

static scalar element(const scalar *p, size_t i, bool shared)
{
    return p == NULL ? 0 : p[shared ? 0 : i];
}

/* Spring i as a single spring. */
static spring_params spring_at(const spring_batch *b, size_t i)
{
    return (spring_params){
        .mass = 1,
        .stiffness = (double)element(b->omega2, i, is_shared(b, SPRING_SHARED_OMEGA2)),
        .damping = (double)element(b->gamma, i, is_shared(b, SPRING_SHARED_GAMMA)),
        .load = (double)element(b->accel, i, is_shared(b, SPRING_SHARED_ACCEL)),
    };
}

static bool spring_valid(const spring_batch *b, const scalar *target, size_t i)
{
    const spring_params p = spring_at(b, i);
    return scalar_finite(b->x[i]) && scalar_finite(b->v[i]) && spring_params_valid(&p) &&
           (target == NULL || scalar_finite(target[i]));
}

static const batch_kernels *best_batch_kernels(void)
{
    return SPRING_BEST_KERNELS(&spring_batch_v128, &spring_batch_v256, &spring_batch_v512);
}

/* Copies `count` elements, and fills `to` up to `size` elements with copies of the first. */
static scalar *filled_up(scalar *to, const scalar *from, size_t count, size_t size)
{
    memcpy(to, from, count * sizeof *to);
    for (size_t i = count; i < size; i++)
        to[i] = from[0];
    return to;
}

/* Advances the springs that do not fill a group, with the narrowest kernels whose group is large enough. Copies of the
   first spring fill the group, so that the loop still ends early when no spring is finite any more. */
static bool advance_tail(const batch_kernels *kernels, const spring_batch *b, const batch_run *all, size_t first)
{
    scalar x[largest_group], v[largest_group];
    scalar omega2[largest_group], gamma[largest_group], accel[largest_group], target[largest_group];
    const size_t count = b->count - first;
    while (kernels->narrower != NULL && count <= kernels->narrower->group_size)
        kernels = kernels->narrower;
    const size_t size = kernels->group_size;
    batch_run tail = *all;
    tail.count = size;
    tail.x = filled_up(x, b->x + first, count, size);
    tail.v = filled_up(v, b->v + first, count, size);
    if (tail.omega2.stride > 0)
        tail.omega2.first = filled_up(omega2, b->omega2 + first, count, size);
    if (tail.gamma.stride > 0)
        tail.gamma.first = filled_up(gamma, b->gamma + first, count, size);
    if (tail.accel.stride > 0)
        tail.accel.first = filled_up(accel, b->accel + first, count, size);
    if (tail.target != NULL)
        tail.target = filled_up(target, all->target + first, count, size);
    tail.landing.counted = count;
    const bool done = kernels->advance(&tail);
    memcpy(b->x + first, x, count * sizeof *x);
    memcpy(b->v + first, v, count * sizeof *v);
    return done;
}

/* The array of a parameter for the kernels. A shared value is repeated in `same`. */
static batch_array array_of(const spring_batch *b, const scalar *parameter, uint32_t bit, scalar *same)
{
    if (parameter == NULL)
        return (batch_array){NULL, 0};
    if (!is_shared(b, bit))
        return (batch_array){parameter, 1};
    for (size_t i = 0; i < largest_vector; i++)
        same[i] = *parameter;
    return (batch_array){same, 0};
}

static bool advance_all(const batch_kernels *kernels, const spring_batch *b, batch_run run)
{
    scalar omega2[largest_vector], gamma[largest_vector], accel[largest_vector];
    run.count = b->count - b->count % kernels->group_size;
    run.landing.counted = run.count;
    run.x = b->x;
    run.v = b->v;
    run.omega2 = array_of(b, b->omega2, SPRING_SHARED_OMEGA2, omega2);
    run.gamma = array_of(b, b->gamma, SPRING_SHARED_GAMMA, gamma);
    run.accel = array_of(b, b->accel, SPRING_SHARED_ACCEL, accel);
    bool done = kernels->advance(&run);
    if (run.count < b->count)
        done &= advance_tail(kernels, b, &run, run.count);
    return done;
}

/* Checks that concern the whole batch. In single precision, the step must be finite as a float. */
static spring_status check_batch(const spring_batch *b, spring_method m, double step)
{
    const spring_method_info *info = spring_method_describe(m);
    if (b == NULL || !batch_valid(b) || info == NULL || !scalar_finite((scalar)step))
        return SPRING_EINVAL;
    return info->springs ? SPRING_OK : SPRING_EUNSUPPORTED;
}

/* Whether all springs have the same propagator. */
static bool same_propagator(const spring_batch *b)
{
    return is_shared(b, SPRING_SHARED_OMEGA2) && (b->gamma == NULL || is_shared(b, SPRING_SHARED_GAMMA));
}

static spring_propagator propagator_of(const spring_batch *b, double t, bool loaded)
{
    const spring_params p = spring_at(b, 0);
    const spring_quotients r = spring_quotients_of(p.stiffness, p.damping, p.mass);
    return spring_propagator_of(&r, t, loaded);
}

/* n steps, with a propagator if it is the same for all springs. */
static batch_run run_of(const spring_batch *b, spring_method m, scalar dt, uint64_t n, spring_propagator *propagator)
{
    batch_run run = {.method = m, .dt = dt, .n = n, .t = (double)dt * (double)n};
    if (m == SPRING_EXACT && same_propagator(b)) {
        *propagator = propagator_of(b, run.t, b->accel != NULL);
        run.propagator = propagator;
    }
    return run;
}

/* The step is rounded to the precision of the batch once, here. */
spring_status spring_batch_advance_with(const batch_kernels *kernels, const spring_batch *b, spring_method m,
                                        double step, uint64_t n)
{
    const spring_status status = check_batch(b, m, step);
    const scalar dt = (scalar)step;
    if (status != SPRING_OK || b->count == 0 || n == 0 || dt == 0)
        return status;
    spring_propagator propagator;
    const batch_run run = run_of(b, m, dt, n, &propagator);
    return advance_all(kernels, b, run) ? SPRING_OK : SPRING_EPARTIAL;
}

spring_status spring_batch_advance(const spring_batch *b, spring_method m, double dt, uint64_t n)
{
    return spring_batch_advance_with(best_batch_kernels(), b, m, dt, n);
}

/* Of a spring, from its target. */
static scalar rest_position(const spring_batch *b, const scalar *target, size_t i)
{
    const scalar a = element(b->accel, i, is_shared(b, SPRING_SHARED_ACCEL));
    const scalar w = element(b->omega2, i, is_shared(b, SPRING_SHARED_OMEGA2));
    return a != 0 ? target[i] + a / w : target[i];
}

/* The number of springs that are not at rest on their targets. */
static size_t count_moving(const spring_batch *b, const scalar *target, const scalar *speed,
                           const exact_landing *landing)
{
    size_t moving = 0;
    for (size_t i = 0; i < b->count; i++) {
        const scalar distance = b->x[i] - rest_position(b, target, i);
        const bool settled = fabs((double)distance) <= landing->x_tol && fabs((double)b->v[i]) <= landing->v_tol;
        moving += !(settled && (speed == NULL || speed[i] == 0) && spring_valid(b, target, i));
    }
    return moving;
}

/* Whether an array of targets or of their velocities may be used. */
static bool target_valid(const spring_batch *b, const scalar *target)
{
    return b->count == 0 ||
           (target != NULL && !overlap(b->x, b->count, target, b->count) && !overlap(b->v, b->count, target, b->count));
}

static bool follow_valid(const spring_batch *b, const scalar *target, double dt, double x_tol, double v_tol)
{
    return b != NULL && batch_valid(b) && spring_finite(dt) && x_tol >= 0 && v_tol >= 0 && target_valid(b, target);
}

/* In single precision, tolerances are rounded once, here. No infinite distance is tolerated. */
static exact_landing landing_of(double x_tol, double v_tol, size_t *moving)
{
    const double largest = (double)SCALAR_MAX;
    return (exact_landing){
        .x_tol = (double)(scalar)fmin(x_tol, largest), .v_tol = (double)(scalar)fmin(v_tol, largest), .moving = moving};
}

spring_status spring_batch_follow_with(const batch_kernels *kernels, const spring_batch *b, const scalar *target,
                                       double dt, double x_tol, double v_tol, size_t *moving)
{
    if (!follow_valid(b, target, dt, x_tol, v_tol))
        return SPRING_EINVAL;
    size_t count = 0;
    spring_status status = SPRING_OK;
    const exact_landing landing = landing_of(x_tol, v_tol, &count);
    if (b->count > 0 && dt == 0)
        count = count_moving(b, target, NULL, &landing);
    if (b->count > 0 && dt != 0) {
        batch_run run = {.method = SPRING_EXACT, .t = dt, .target = target, .landing = landing};
        spring_propagator propagator;
        if (same_propagator(b) && *b->omega2 > 0) {
            propagator = propagator_of(b, dt, false);
            run.propagator = &propagator;
        }
        status = advance_all(kernels, b, run) ? SPRING_OK : SPRING_EPARTIAL;
    }
    if (moving != NULL)
        *moving = count;
    return status;
}

spring_status spring_batch_follow(const spring_batch *b, const scalar *target, double dt, double x_tol, double v_tol,
                                  size_t *moving)
{
    return spring_batch_follow_with(best_batch_kernels(), b, target, dt, x_tol, v_tol, moving);
}

static const scalar *from_spring(const spring_batch *b, const scalar *parameter, uint32_t bit, size_t first)
{
    return parameter == NULL || is_shared(b, bit) ? parameter : parameter + first;
}

/* Springs first ... first + count - 1, with their states at x and v. */
static spring_batch part_of(const spring_batch *b, size_t first, size_t count, scalar *x, scalar *v)
{
    return (spring_batch){
        .count = count,
        .x = x,
        .v = v,
        .omega2 = from_spring(b, b->omega2, SPRING_SHARED_OMEGA2, first),
        .gamma = from_spring(b, b->gamma, SPRING_SHARED_GAMMA, first),
        .accel = from_spring(b, b->accel, SPRING_SHARED_ACCEL, first),
        .shared = b->shared,
    };
}

enum { part_size = 4 * largest_group }; /* [springs] that are copied to find those that fail */

/* Advances at most part_size springs, and writes the status of each spring. */
static bool advance_part(const spring_batch *b, const batch_run *run, uint8_t *failed)
{
    const batch_kernels *const kernels = best_batch_kernels();
    scalar x[part_size], v[part_size]; /* copies, advanced one by one to find the springs that fail */
    memcpy(x, b->x, b->count * sizeof *x);
    memcpy(v, b->v, b->count * sizeof *v);
    memset(failed, SPRING_OK, b->count);
    if (advance_all(kernels, b, *run))
        return true;
    for (size_t i = 0; i < b->count; i++) {
        const spring_batch one = part_of(b, i, 1, x + i, v + i);
        if (!advance_all(kernels, &one, *run))
            failed[i] = spring_valid(&one, NULL, 0) ? SPRING_ENONFINITE : SPRING_EINVAL;
    }
    return false;
}

spring_status spring_batch_advance_marked(const spring_batch *b, spring_method m, double step, uint64_t n,
                                          uint8_t *failed)
{
    spring_status status = failed != NULL ? check_batch(b, m, step) : SPRING_EINVAL;
    if (status == SPRING_OK && touches_batch(b, failed))
        status = SPRING_EINVAL;
    const scalar dt = (scalar)step;
    if (status != SPRING_OK || b->count == 0)
        return status;
    memset(failed, SPRING_OK, b->count);
    if (n == 0 || dt == 0)
        return status;
    spring_propagator propagator;
    const batch_run run = run_of(b, m, dt, n, &propagator);
    for (size_t first = 0; first < b->count; first += part_size) {
        const size_t count = b->count - first < part_size ? b->count - first : part_size;
        const spring_batch some = part_of(b, first, count, b->x + first, b->v + first);
        if (!advance_part(&some, &run, failed + first))
            status = SPRING_EPARTIAL;
    }
    return status;
}

/* A spring that follows a moving target, as in spring_follow(): its motion is computed relative to `from`, and ends
   relative to `to`. */
typedef struct moving_target {
    scalar from, to, rest, speed;
} moving_target;

static moving_target target_of(const spring_batch *b, const scalar *target, const scalar *speeds, size_t i, double dt)
{
    const scalar speed = speeds != NULL ? speeds[i] : 0;
    const scalar moved = speed != 0 ? (scalar)((double)speed * dt) : 0, rest = rest_position(b, target, i);
    if (element(b->omega2, i, is_shared(b, SPRING_SHARED_OMEGA2)) == 0) /* a target has no effect, but its velocity */
        return (moving_target){scalar_finite(target[i]) ? 0 : (scalar)NAN, moved, rest, speed};
    return (moving_target){rest - moved, rest, rest, speed};
}

/* Adds the target of a spring to its relative state y, u, or places it on its target. Returns whether it rests there. */
static bool add_target(const spring_params *p, const moving_target *m, const batch_run *run, scalar y, scalar u,
                       scalar *x, scalar *v)
{
    *x = m->to + y;
    *v = m->speed != 0 ? m->speed + u : u;
    const exact_landing *landing = &run->landing;
    const bool arrived = fabs((double)(*x - m->rest)) <= landing->x_tol && fabs((double)u) <= landing->v_tol;
    if (!arrived &&
        !spring_lands(p, (double)*x, (double)m->to, (double)y, (double)u, run->t, sizeof *x == sizeof(float)))
        return false;
    *x = m->rest;
    *v = m->speed;
    return m->speed == 0;
}

/* At most largest_group springs that follow moving targets. Their motion relative to the targets is advanced as a batch.
   A spring with invalid numbers fails there. */
static size_t follow_part(const spring_batch *b, const scalar *target, const scalar *speeds, const batch_run *run,
                          bool *all)
{
    scalar y[largest_group], u[largest_group], accel[largest_group];
    moving_target moving_to[largest_group];
    uint8_t failed[largest_group];
    for (size_t i = 0; i < b->count; i++) {
        moving_to[i] = target_of(b, target, speeds, i, run->t);
        y[i] = b->x[i] - moving_to[i].from;
        u[i] = b->v[i] - moving_to[i].speed;
        const bool is_free = element(b->omega2, i, is_shared(b, SPRING_SHARED_OMEGA2)) == 0;
        accel[i] = is_free ? element(b->accel, i, is_shared(b, SPRING_SHARED_ACCEL)) : 0;
    }
    spring_batch relative = *b;
    relative.x = y;
    relative.v = u;
    if (b->accel != NULL) {
        relative.accel = accel;
        relative.shared &= ~SPRING_SHARED_ACCEL;
    }
    advance_part(&relative, run, failed);
    size_t moving = 0;
    for (size_t i = 0; i < b->count; i++) {
        const spring_params p = spring_at(b, i);
        scalar x, v;
        const bool rests = add_target(&p, &moving_to[i], run, y[i], u[i], &x, &v);
        const bool stays = failed[i] != SPRING_OK || !scalar_finite(x) || !scalar_finite(v);
        if (!stays) {
            b->x[i] = x;
            b->v[i] = v;
        }
        *all &= !stays;
        moving += stays || !rests;
    }
    return moving;
}

spring_status spring_batch_follow_moving(const spring_batch *b, const scalar *target, const scalar *target_velocity,
                                         double dt, double x_tol, double v_tol, size_t *moving)
{
    if (!follow_valid(b, target, dt, x_tol, v_tol) || (target_velocity != NULL && !target_valid(b, target_velocity)))
        return SPRING_EINVAL;
    size_t count = 0;
    bool all = true;
    const exact_landing landing = landing_of(x_tol, v_tol, &count);
    batch_run run = {.method = SPRING_EXACT, .t = dt, .landing = landing};
    spring_propagator propagator;
    if (b->count > 0 && dt != 0 && same_propagator(b)) {
        propagator = propagator_of(b, dt, *b->omega2 == 0 && b->accel != NULL);
        run.propagator = &propagator;
    }
    if (dt == 0)
        count = count_moving(b, target, target_velocity, &landing);
    for (size_t first = 0; first < b->count && dt != 0; first += largest_group) {
        const size_t size = b->count - first < largest_group ? b->count - first : largest_group;
        const spring_batch some = part_of(b, first, size, b->x + first, b->v + first);
        const scalar *const speeds = target_velocity != NULL ? target_velocity + first : NULL;
        count += follow_part(&some, target + first, speeds, &run, &all);
    }
    if (moving != NULL)
        *moving = count;
    return all ? SPRING_OK : SPRING_EPARTIAL;
}

double spring_batch_stable_step(const spring_batch *b, spring_method m)
{
    const spring_method_info *const info = spring_method_describe(m);
    if (b == NULL || !batch_valid(b) || info == NULL || !info->springs)
        return (double)NAN;
    const bool all_shared = is_shared(b, SPRING_SHARED_OMEGA2) &&
                            (b->gamma == NULL || is_shared(b, SPRING_SHARED_GAMMA)) &&
                            (b->accel == NULL || is_shared(b, SPRING_SHARED_ACCEL));
    const size_t count = all_shared && b->count > 0 ? 1 : b->count;
    double least = (double)INFINITY;
    for (size_t i = 0; i < count; i++) {
        const spring_params p = spring_at(b, i);
        const double limit = spring_stable_step(&p, m);
        if (!(limit >= least))
            least = limit;
        if (limit != limit)
            return (double)NAN;
    }
    return (double)(scalar)least;
}
