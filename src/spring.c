/* SPDX-License-Identifier: MIT */
/*
 * One spring: checks, dispatch, and the questions one can ask of it.
 */
#include <stddef.h>

#include "method.h"

/* A method is one row here. */
static const spring_method_row *const methods[] = {
    [SPRING_EULER] = &spring_method_euler,
    [SPRING_LEAPFROG] = &spring_method_leapfrog,
    [SPRING_RK4] = &spring_method_rk4,
    [SPRING_EXACT] = &spring_method_exact,
};

/* Steps between two looks at the state: rare enough to cost nothing, as often as rule "within 4096 steps" asks. */
static const uint64_t check_interval = 4096;

static const spring_method_row *find_method(spring_method m)
{
    const size_t index = (size_t)m; /* a negative value becomes a large one */
    return index < sizeof methods / sizeof methods[0] ? methods[index] : NULL;
}

static bool finite_state(spring_state s)
{
    return isfinite(s.x) && isfinite(s.v);
}

spring_status spring_advance(spring_state *s, const spring_params *p, spring_method m, double dt, uint64_t n)
{
    const spring_method_row *method = find_method(m);
    if (s == NULL || p == NULL || method == NULL || !isfinite(dt))
        return SPRING_EINVAL;
    spring_state now = {s->x, s->v}; /* by field, see method.h */
    const spring_rates r = spring_rates_of(p);
    if (!finite_state(now) || !spring_rates_valid(p, &r))
        return SPRING_EINVAL;
    if (n == 0 || dt == 0)
        return SPRING_OK;
    while (n > 0) {
        uint64_t some = n < check_interval ? n : check_interval;
        if (method->steps != NULL)
            now = method->steps(now, &r, dt, some);
        else
            now = spring_exact(now, p, dt * (double)(some = n));
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
    const spring_method_row *method = find_method(m);
    if (method == NULL || !spring_params_valid(p))
        return NAN;
    const spring_roots r = spring_roots_of(p);
    return method->stable_step(&r);
}

static spring_params params_of(double omega, double damping_ratio)
{
    const spring_params p = {.mass = 1, .stiffness = omega * omega, .damping = 2 * damping_ratio * omega};
    const bool lost = omega > 0 && p.stiffness < DBL_MIN; /* by underflow */
    return spring_params_valid(&p) && !lost ? p : (spring_params){NAN, NAN, NAN, NAN};
}

spring_params spring_params_hertz(double hertz, double damping_ratio)
{
    const double two_pi = 6.283185307179586;
    return params_of(hertz >= 0 ? two_pi * hertz : NAN, damping_ratio);
}

spring_params spring_params_half_life(double half_life, double damping_ratio)
{
    const double ln2 = 0.6931471805599453;
    const double z = damping_ratio;
    const double rate =
        z <= 1 ? z : 1 / (z + sqrt(z - 1) * sqrt(z + 1)); /* of the envelope, in units of omega */
    return params_of(half_life > 0 && isfinite(half_life) && z > 0 ? ln2 / half_life / rate : NAN, z);
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

const char *spring_method_name(spring_method m)
{
    const spring_method_row *method = find_method(m);
    return method != NULL ? method->name : NULL;
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
    }
    return "unknown status";
}

const char *spring_version(void)
{
    return SPRING_VERSION;
}
