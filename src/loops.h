/* SPDX-License-Identifier: MIT */
/*
 * The loops around a linear one-step method, for every shape of data; there is one copy of each.
 *
 * Included by a method's file after it has defined `coefficients`, prepare() and step(). step() takes two flags that
 * are constant in every loop, so a spring without damping or load pays for neither.
 */
SPRING_INLINE spring_state loop(spring_state s, const spring_rates *r, double dt, uint64_t n, bool damped,
                                bool loaded)
{
    const coefficients c = prepare(*r, dt);
    for (; n > 0; n--)
        step(&s.x, &s.v, &c, damped, loaded);
    return s;
}

SPRING_INLINE spring_state steps(spring_state s, const spring_rates *r, double dt, uint64_t n)
{
    const bool damped = r->g != 0, loaded = r->a != 0;
    if (!damped && !loaded)
        return loop(s, r, dt, n, false, false);
    if (!loaded)
        return loop(s, r, dt, n, true, false);
    if (!damped)
        return loop(s, r, dt, n, false, true);
    return loop(s, r, dt, n, true, true);
}

static spring_state many_steps(spring_state s, const spring_rates *r, double dt, uint64_t n)
{
    return steps(s, r, dt, n);
}

SPRING_INLINE void one_step(spring_state *s, const spring_params *p, double dt)
{
    const spring_rates r = spring_rates_of(p);
    *s = steps(*s, &r, dt, 1);
}
