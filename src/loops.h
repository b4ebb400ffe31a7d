/* SPDX-License-Identifier: MIT */
/*
 * The loops of a method for one spring. Included by a method's file, once, with SPRING_METHOD its name.
 *
 * The step takes two flags that are constant in every loop, so a spring without damping or load pays for neither.
 */
SPRING_INLINE spring_state loop(spring_state s, const spring_rates *r, double dt, uint64_t n, bool damped,
                                bool loaded)
{
    const METHOD(coefficients) c = METHOD(prepare)(*r, dt);
    for (; n > 0; n--)
        METHOD(step)(&s.x, &s.v, &c, damped, loaded);
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
