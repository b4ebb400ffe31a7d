/* SPDX-License-Identifier: MIT */
/*
 * Many springs: checks, choice of the kernel, and what does not fill a group of vectors.
 */
#include "batch_kernels.h"
#include "propagator.h"
#include "simd/targets.h"

enum { largest_group = 128 }; /* springs: eight vectors of 64 bytes, in float */

static const uint32_t known_bits = SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA | SPRING_SHARED_ACCEL;

static bool shared(const spring_batch *b, uint32_t bit)
{
    return (b->shared & bit) != 0;
}

static bool overlap(const scalar *a, size_t a_count, const scalar *b, size_t b_count)
{
    const uintptr_t p = (uintptr_t)a, q = (uintptr_t)b;
    return p < q ? q - p < a_count * sizeof(scalar) : p - q < b_count * sizeof(scalar);
}

/* Does an array of parameters, if there is one, leave the state alone? */
static bool leaves_state_alone(const spring_batch *b, const scalar *parameter, uint32_t bit)
{
    const size_t count = shared(b, bit) ? 1 : b->count;
    return parameter == NULL ||
           (!overlap(b->x, b->count, parameter, count) && !overlap(b->v, b->count, parameter, count));
}

/* A parameter of all springs has to be valid before anything happens; one spring's is that spring's business. */
static bool shared_valid(const spring_batch *b, const scalar *parameter, uint32_t bit, scalar least)
{
    return parameter == NULL || !shared(b, bit) || (isfinite(*parameter) && *parameter >= least);
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
           shared_valid(b, b->accel, SPRING_SHARED_ACCEL, -INFINITY);
}

static scalar element(const scalar *p, size_t i, bool shared)
{
    return p == NULL ? 0 : p[shared ? 0 : i];
}

/* The single spring that spring i is. */
static spring_params spring_at(const spring_batch *b, size_t i)
{
    return (spring_params){
        .mass = 1,
        .stiffness = (double)element(b->omega2, i, shared(b, SPRING_SHARED_OMEGA2)),
        .damping = (double)element(b->gamma, i, shared(b, SPRING_SHARED_GAMMA)),
        .load = (double)element(b->accel, i, shared(b, SPRING_SHARED_ACCEL)),
    };
}

/* Why some springs have kept their state: it, or their parameters, was not valid, or would not have stayed finite. */
static spring_status reason(const spring_batch *b)
{
    for (size_t i = 0; i < b->count; i++) {
        const spring_params p = spring_at(b, i);
        if (!isfinite(b->x[i]) || !isfinite(b->v[i]) || !spring_params_valid(&p))
            return SPRING_EINVAL;
    }
    return SPRING_ENONFINITE;
}

static const batch_kernels *best_batch_kernels(void)
{
    return SPRING_BEST_KERNELS(&spring_batch_v128, &spring_batch_v256, &spring_batch_v512);
}

/* The springs that do not fill a group advance in one that is filled up with copies of the first of them, so that the
   group is given up when all of them are lost. */
static bool advance_tail(batch_kernel *kernel, size_t size, const spring_batch *b, const batch_block *all, size_t first)
{
    scalar x[largest_group] = {0}, v[largest_group] = {0}, w[largest_group] = {0}, g[largest_group] = {0},
           a[largest_group] = {0};
    const size_t count = b->count - first, bytes = count * sizeof(scalar);
    batch_block tail = *all;
    tail.count = size;
    tail.x = memcpy(x, b->x + first, bytes);
    tail.v = memcpy(v, b->v + first, bytes);
    if (!shared(b, SPRING_SHARED_OMEGA2))
        tail.w = memcpy(w, b->omega2 + first, bytes);
    if (b->gamma != NULL && !shared(b, SPRING_SHARED_GAMMA))
        tail.g = memcpy(g, b->gamma + first, bytes);
    if (b->accel != NULL && !shared(b, SPRING_SHARED_ACCEL))
        tail.a = memcpy(a, b->accel + first, bytes);
    for (size_t i = count; i < size; i++) {
        x[i] = x[0];
        v[i] = v[0];
        w[i] = w[0];
        g[i] = g[0];
        a[i] = a[0];
    }
    const bool done = kernel(&tail);
    memcpy(b->x + first, x, bytes);
    memcpy(b->v + first, v, bytes);
    return done;
}

static bool run(batch_kernel *kernel, size_t size, const spring_batch *b, batch_block block)
{
    scalar same[largest_group];
    block.count = b->count - b->count % size;
    block.x = b->x;
    block.v = b->v;
    block.w = b->omega2;
    block.g = b->gamma;
    block.a = b->accel;
    block.a_step = 1;
    if (b->accel != NULL && shared(b, SPRING_SHARED_ACCEL)) {
        for (size_t i = 0; i < largest_group; i++)
            same[i] = *b->accel;
        block.a = same;
        block.a_step = 0;
    }
    bool done = kernel(&block);
    if (block.count < b->count)
        done &= advance_tail(kernel, size, b, &block, block.count);
    return done;
}

/* Each spring by itself, in double. */
static bool advance_each(const spring_batch *b, spring_method m, scalar dt, uint64_t n)
{
    bool done = true;
    for (size_t i = 0; i < b->count; i++) {
        const spring_params p = spring_at(b, i);
        spring_state s = {(double)b->x[i], (double)b->v[i]};
        const bool advanced = spring_advance(&s, &p, m, (double)dt, n) == SPRING_OK;
        const scalar x = (scalar)s.x, v = (scalar)s.v;
        if (advanced && isfinite(x) && isfinite(v)) {
            b->x[i] = x;
            b->v[i] = v;
        } else {
            done = false;
        }
    }
    return done;
}

spring_status spring_batch_advance_with(const batch_kernels *kernels, const spring_batch *b, spring_method m, scalar dt,
                                        uint64_t n)
{
    const spring_method_info *info = spring_method_describe(m);
    if (b == NULL || !batch_valid(b) || info == NULL || !isfinite(dt))
        return SPRING_EINVAL;
    if (b->count == 0 || n == 0 || dt == 0 || !info->springs)
        return info->springs ? SPRING_OK : SPRING_EUNSUPPORTED;
    const bool w_shared = shared(b, SPRING_SHARED_OMEGA2), loaded = b->accel != NULL;
    const enum sharing g = b->gamma == NULL ? NONE : shared(b, SPRING_SHARED_GAMMA) ? SHARED : EACH;
    batch_kernel *kernel = kernels->method[m]->kernel[w_shared ? SHARED : EACH][g][loaded];
    if (kernel == NULL)
        return advance_each(b, m, dt, n) ? SPRING_OK : reason(b);
    batch_block block = {.dt = dt, .n = n};
    spring_propagator propagator;
    if (m == SPRING_EXACT) {
        const spring_params p = spring_at(b, 0);
        propagator = spring_propagator_of(&p, (double)dt * (double)n, loaded);
        block.propagator = &propagator;
    }
    return run(kernel, kernels->group, b, block) ? SPRING_OK : reason(b);
}

spring_status spring_batch_advance(const spring_batch *b, spring_method m, scalar dt, uint64_t n)
{
    return spring_batch_advance_with(best_batch_kernels(), b, m, dt, n);
}

scalar spring_batch_stable_step(const spring_batch *b, spring_method m)
{
    if (b == NULL || !batch_valid(b) || spring_method_name(m) == NULL)
        return NAN;
    const bool all_shared = shared(b, SPRING_SHARED_OMEGA2) && (b->gamma == NULL || shared(b, SPRING_SHARED_GAMMA)) &&
                            (b->accel == NULL || shared(b, SPRING_SHARED_ACCEL));
    const size_t count = all_shared && b->count > 0 ? 1 : b->count;
    double least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const spring_params p = spring_at(b, i);
        const double limit = spring_stable_step(&p, m);
        if (!(limit >= least))
            least = limit;
        if (isnan(limit))
            return NAN;
    }
    return (scalar)least;
}
