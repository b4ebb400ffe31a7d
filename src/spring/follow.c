/* SPDX-License-Identifier: MIT */
/* One spring that follows a target: follow_formula_tmpl.h for one number instead of a SIMD vector. */
#include "follow_formula_tmpl.h"
#include "rates_tmpl.h"

spring_status spring_follow(spring_state *s, const spring_params *p, double target, double target_velocity, double dt)
{
    if (s == NULL || p == NULL || !spring_finite(target) || !spring_finite(target_velocity) || !spring_finite(dt))
        return SPRING_EINVAL;
    const double x0 = s->x, v0 = s->v;
    const bool has_load = p->load != 0;
    const spring_quotients r = spring_quotients_of(p->stiffness, p->damping, p->mass);
    const spring_rates rates = {r.omega2, 2 * r.b, has_load ? p->load / p->mass : 0};
    if (!spring_finite(x0) || !spring_finite(v0) || !spring_rates_valid(p, &rates))
        return SPRING_EINVAL;
    if (dt == 0)
        return SPRING_OK;

    /* A load shifts the rest position. Without stiffness there is no rest position, and x is measured from a target
       that starts at 0. */
    const bool is_free = r.omega2 == 0, pushed = is_free && has_load;
    const double rest = has_load ? target + p->load / p->stiffness : target;
    const double moved = target_velocity != 0 ? target_velocity * dt : 0;
    const double to = is_free ? moved : rest, from = is_free ? 0 : rest - moved;
    const spring_propagator propagator = spring_propagator_of(&r, dt, pushed);
    const follow_coefficients c = follow_prepare(exact_prepare(&propagator), r.omega2, dt, false);
    double y = x0 - from, u = v0 - target_velocity;
    exact_step(&y, &u, rates.accel, &c.exact, pushed);
    double x = to + y, v = target_velocity != 0 ? target_velocity + u : u; /* -0 stays -0, as in batches */
    if (follow_lands(x, to, y, u, &c, false)) {
        x = to;
        v = target_velocity;
    }
    if (!spring_finite(x) || !spring_finite(v))
        return SPRING_ENONFINITE;
    s->x = x;
    s->v = v;
    return SPRING_OK;
}

bool spring_lands(const spring_params *p, double x, double rest, double y, double u, double dt, bool single)
{
    follow_coefficients c = {.omega2 = p->stiffness, .fraction = follow_least_fraction(single)};
    if (!(p->stiffness > 0) || !follow_lands(x, rest, y, u, &c, single)) /* most springs are too far away */
        return false;
    const spring_quotients r = spring_quotients_of(p->stiffness, p->damping, 1);
    const spring_propagator propagator = spring_propagator_of(&r, dt, false);
    c = follow_prepare(exact_prepare(&propagator), r.omega2, dt, single);
    return follow_lands(x, rest, y, u, &c, single);
}
