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
    METHOD(coefficients) c;
    METHOD(prepare)(&c, *r, dt, damped, loaded);
    for (; n > 0; n--)
        METHOD(step)(&s.x, &s.v, dt, &c, damped, loaded);
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
    return SPRING_BY_FEATURES(r->g != 0, r->a != 0, METHOD(loop), s, r, dt, n);
}

SPRING_INLINE void METHOD(one_step)(spring_state *s, const spring_params *p, double dt)
{
    const spring_rates r = spring_rates_of(p);
    *s = METHOD(shortest_loop)(*s, &r, dt, 1);
}

#undef SPRING_METHOD
