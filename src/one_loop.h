/* SPDX-License-Identifier: MIT */
/*
 * The loops of a method for one spring, METHOD(loops), and its one step. Included by a method's header, once, with
 * SPRING_METHOD its name.
 *
 * The step takes two flags that are constant in every loop, so a spring without damping or load pays for neither.
 */
SPRING_INLINE spring_state METHOD(loop)(spring_state s, const spring_rates *r, double dt, uint64_t n, bool damped,
                                        bool loaded)
{
    const METHOD(coefficients) c = METHOD(prepare)(*r, dt, damped);
    for (; n > 0; n--)
        METHOD(step)(&s.x, &s.v, &c, damped, loaded);
    return s;
}

#define ONE_LOOP(name, damped, loaded)                                                             \
    static spring_state METHOD(name)(spring_state s, const spring_rates *r, double dt, uint64_t n) \
    {                                                                                              \
        return METHOD(loop)(s, r, dt, n, damped, loaded);                                          \
    }
ONE_LOOP(plain, false, false)
ONE_LOOP(loaded, false, true)
ONE_LOOP(damped, true, false)
ONE_LOOP(damped_loaded, true, true)
#undef ONE_LOOP

SPRING_INLINE spring_state METHOD(shortest_loop)(spring_state s, const spring_rates *r, double dt, uint64_t n)
{
    const bool damped = r->g != 0, loaded = r->a != 0;
    if (!damped && !loaded)
        return METHOD(loop)(s, r, dt, n, false, false);
    if (!loaded)
        return METHOD(loop)(s, r, dt, n, true, false);
    if (!damped)
        return METHOD(loop)(s, r, dt, n, false, true);
    return METHOD(loop)(s, r, dt, n, true, true);
}

SPRING_INLINE void METHOD(one_step)(spring_state *s, const spring_params *p, double dt)
{
    const spring_rates r = spring_rates_of(p);
    *s = METHOD(shortest_loop)(*s, &r, dt, 1);
}

#undef SPRING_METHOD
