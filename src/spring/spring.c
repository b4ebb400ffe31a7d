/* SPDX-License-Identifier: MIT */
/*
 * One spring: checks, dispatch, energy, stable and accurate steps, texts.
 */
#include "../methods/methods.h"
#include "accuracy.h"
#include "propagator.h"
#include "self_test.h"

#define INFO_ROW(value, info, row) [value] = &(info),
static const spring_method_info *const all_infos[SPRING_METHOD_COUNT] = {METHODS(INFO_ROW)};

#define METHOD_ROW(value, info, row) [value] = &(row),
static const method_row *const all_methods[SPRING_METHOD_COUNT] = {METHODS(METHOD_ROW)};

#define ORDER_ROW(value, info, row) value,
static const spring_method table_order[] = {METHODS(ORDER_ROW)};
_Static_assert(sizeof table_order / sizeof table_order[0] == SPRING_METHOD_COUNT,
               "each method has one row in methods.h");

static const method_row *find_method(spring_method m)
{
    const size_t index = (size_t)m; /* a negative value becomes a large one */
    return index < SPRING_METHOD_COUNT ? all_methods[index] : NULL;
}

#ifdef SPRING_WHOLE
uint64_t spring_expected_digest(spring_method m)
{
    return all_methods[m]->digest;
}
#endif

static bool finite_state(spring_state s)
{
    return spring_finite(s.x) && spring_finite(s.v);
}

/* n steps; the exact solution takes them as one. */
static spring_state advance_spring(spring_method m, spring_state s, const spring_params *p, const spring_rates *r,
                                   double dt, uint64_t n)
{
#define STEP_METHOD(value, prepare, start, step) \
    case value:                                  \
        return SPRING_BY_FEATURES(r->gamma != 0, r->accel != 0, take_steps, s, r, dt, n, prepare, start, step);
    switch ((int)m) {
        STEP_METHODS(STEP_METHOD)
    }
    return spring_exact(s, p, dt * (double)n);
}

spring_status spring_advance(spring_state *s, const spring_params *p, spring_method m, double dt, uint64_t n)
{
    const method_row *method = find_method(m);
    if (s == NULL || p == NULL || method == NULL || !spring_finite(dt))
        return SPRING_EINVAL;
    spring_state now = {s->x, s->v}; /* by field, see simd/arithmetic.h */
    const spring_rates r = spring_rates_of(p);
    if (!finite_state(now) || !spring_rates_valid(p, &r))
        return SPRING_EINVAL;
    if (n == 0 || dt == 0 || !method->info->springs)
        return method->info->springs ? SPRING_OK : SPRING_EUNSUPPORTED;
    while (n > 0) {
        const uint64_t some = n < SPRING_CHECK_INTERVAL || m == SPRING_EXACT ? n : SPRING_CHECK_INTERVAL;
        now = advance_spring(m, now, p, &r, dt, some);
        if (!finite_state(now))
            return SPRING_ENONFINITE;
        n -= some;
    }
    s->x = now.x;
    s->v = now.v;
    return SPRING_OK;
}

double spring_energy(const spring_state *s, const spring_params *p)
{
    return p->mass * s->v * s->v / 2 + p->stiffness * s->x * s->x / 2 - p->load * s->x;
}

bool spring_params_valid(const spring_params *p)
{
    if (p == NULL)
        return false;
    const spring_rates r = spring_rates_of(p);
    return spring_rates_valid(p, &r);
}

double spring_stable_step(const spring_params *p, spring_method m)
{
    const method_row *method = find_method(m);
    if (method == NULL || method->stable_step == NULL || !spring_params_valid(p))
        return (double)NAN;
    const spring_roots r = spring_roots_of(p);
    return method->stable_step(&r);
}

/* For valid parameters, in the variables (x, v/Omega), where Omega is the larger of omega and 1/duration. */
static accuracy accuracy_of(const spring_params *p, const method_row *method, double duration)
{
    const spring_rates r = spring_rates_of(p);
    const double angle = spring_sqrt(r.omega2) * duration;
    return (accuracy){
        .terms = method->terms,
        .order = method->info->order,
        .whole = {.a = fmax(angle, 1), .c = fmin(angle, 1) * angle, .G = r.gamma * duration},
    };
}

static bool positive(double a)
{
    return a > 0 && spring_finite(a);
}

double spring_accurate_step(const spring_params *p, spring_method m, double duration, double tolerance)
{
    const method_row *method = find_method(m);
    if (method == NULL || !method->info->springs || !spring_params_valid(p) || !positive(duration) ||
        !positive(tolerance))
        return (double)NAN;
    if (method->terms == NULL)
        return duration;
    const accuracy of = accuracy_of(p, method, duration);
    return duration / spring_accurate_steps(&of, tolerance);
}

double spring_step_error(const spring_params *p, spring_method m, double duration, double dt)
{
    const method_row *method = find_method(m);
    if (method == NULL || !method->info->springs || !spring_params_valid(p) || !positive(duration) || !positive(dt))
        return (double)NAN;
    if (method->terms == NULL)
        return 0;
    const accuracy of = accuracy_of(p, method, duration);
    const double steps = duration / dt, slack = 1 + 4 * DBL_EPSILON; /* rounding: duration/(duration/n) is n */
    return spring_error_of(&of, steps, fmax(1, floor(steps * slack)));
}

bool spring_at_rest(const spring_state *s, const spring_params *p, double x_tol, double v_tol)
{
    if (s == NULL || !finite_state(*s) || !spring_params_valid(p) || !(x_tol >= 0))
        return false;
    const bool slow = fabs(s->v) <= v_tol;
    if (p->stiffness / p->mass == 0)
        return slow && p->load == 0;
    return slow && fabs(s->x - p->load / p->stiffness) <= x_tol;
}

const spring_method_info *spring_method_describe(spring_method m)
{
    const size_t index = (size_t)m;
    return index < SPRING_METHOD_COUNT ? all_infos[index] : NULL;
}

const char *spring_method_name(spring_method m)
{
    const spring_method_info *info = spring_method_describe(m);
    return info != NULL ? info->name : NULL;
}

spring_step_fn *spring_method_kernel(spring_method m)
{
    const method_row *method = find_method(m);
    return method != NULL ? method->kernel : NULL;
}

spring_method spring_method_at(int place)
{
    return place >= 0 && place < SPRING_METHOD_COUNT ? table_order[place] : (spring_method)SPRING_METHOD_COUNT;
}

const char *spring_status_string(spring_status s)
{
    switch (s) {
    case SPRING_OK:
        return "ok";
    case SPRING_EINVAL:
        return "invalid input";
    case SPRING_ENONFINITE:
        return "the state would become infinite or not a number";
    case SPRING_ENOMEM:
        return "memory too small";
    case SPRING_EALIGN:
        return "memory not aligned";
    case SPRING_ERANGE:
        return "index or count out of range";
    case SPRING_EUNSUPPORTED:
        return "not supported";
    case SPRING_EDISABLED:
        return "not enabled in the definition of the scene";
    case SPRING_EROUNDING:
        return "the rounding mode is not round-to-nearest";
    case SPRING_EFLUSHED:
        return "denormal numbers are flushed to zero";
    case SPRING_EFUSED:
        return "products and sums are fused";
    case SPRING_EBITS:
        return "results are not bit-identical to the expected ones";
    case SPRING_EUNSTABLE:
        return "a particle is faster than max_speed, or a result is not finite";
    case SPRING_EPARTIAL:
        return "some springs of the batch failed, and all others advanced";
    case SPRING_EMISMATCH:
        return "the state of a scene with another definition";
    }
    return "unknown status";
}

const char *spring_version(void)
{
    return SPRING_VERSION;
}
