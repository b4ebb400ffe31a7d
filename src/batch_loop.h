/* SPDX-License-Identifier: MIT */
/*
 * The kernel of a method for a batch. Included by a method's header, with SPRING_METHOD its name.
 *
 * What a method owes it: rates that are infinite or NaN leave x or v infinite or NaN, since only these are looked at
 * afterwards (see symplectic_euler_prepare()); and rates that are 0 give the bits of the step without them.
 * A method that does better with several steps than to repeat one has NAME_steps() of its own and says SPRING_OWN_STEPS.
 */

/* The coefficients of the group of springs from i, and a sign bit where a rate is negative. */
SPRING_INLINE mask METHOD(prepare_group)(METHOD(coefficients) c[vectors], const batch_block *b, size_t i, real h,
                                         bool damped, bool loaded)
{
    mask signs = {0};
    SPRING_ROLLED
    for (size_t k = 0; k < vectors; k++) {
        const spring_rates r = rates_at(b, i + k * lanes, damped, loaded);
        METHOD(prepare)(&c[k], r, h, damped, loaded);
        signs |= sign_bit(r.w) | sign_bit(r.g);
    }
    return signs;
}

#ifndef SPRING_OWN_STEPS
SPRING_INLINE void METHOD(steps)(real *x, real *v, real h, const METHOD(coefficients) c[vectors], uint64_t n,
                                 bool damped, bool loaded)
{
    for (; n > 0; n--) {
        SPRING_HOT_LOOP("spring", group);
        vec_read_again(c);
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++)
            METHOD(step)(&x[k], &v[k], h, &c[k], damped, loaded);
    }
}
#endif

/* All steps of the group of springs from i; false if one of them keeps its state. b: a copy of *block. */
SPRING_INLINE bool METHOD(advance_group)(const batch_block *block, const batch_block *b, size_t i, real h,
                                         const METHOD(coefficients) c[vectors], mask signs, bool damped, bool loaded)
{
    real x[vectors], v[vectors];
    SPRING_UNROLL
    for (size_t k = 0; k < vectors; k++) {
        x[k] = vec_load(b->x + i + k * lanes);
        v[k] = vec_load(b->v + i + k * lanes);
    }
    uint64_t left = b->n;
    do {
        const uint64_t some = left < SPRING_CHECK_INTERVAL ? left : SPRING_CHECK_INTERVAL;
        left -= some;
        SPRING_BY_FEATURES(damped, loaded, METHOD(steps), x, v, h, c, some);
    } while (left > 0 && !all_lost(x, v));
    return store_group(block, i, b->x + i, b->v + i, x, v, vectors, signs);
}

/* One function for all sets of features: what it does before and after the steps of a group is there once. */
static bool METHOD(groups)(const batch_block *block, bool damped, bool loaded)
{
    const batch_block b = *block; /* which no store can change, for all the compiler knows */
    const bool same = b.w.step + b.g.step + b.a.step == 0;
    const real h = splat(b.dt);
    METHOD(coefficients) c[vectors];
    mask signs = {0};
    bool all = true;
    for (size_t i = 0; i < b.count; i += group) {
        if (i == 0 || !same)
            signs = SPRING_BY_FEATURES(damped, loaded, METHOD(prepare_group), c, &b, i, h);
        all &= METHOD(advance_group)(block, &b, i, h, c, signs, damped, loaded);
    }
    return all;
}

/* One step of one vector after the other: there is nothing to wait for but the next, which the processor begins by
   itself, and springs in memory are slower in groups of eight. */
SPRING_INLINE bool METHOD(single_step)(const batch_block *block, bool damped, bool loaded)
{
    const batch_block b = *block;
    const real h = splat(b.dt);
    bool all = true;
    for (size_t i = 0; i < b.count; i += lanes) {
        SPRING_HOT_LOOP("spring", lanes);
        const spring_rates r = rates_at(&b, i, damped, loaded);
        METHOD(coefficients) c;
        METHOD(prepare)(&c, r, h, damped, loaded);
        real x = vec_load(b.x + i), v = vec_load(b.v + i);
        METHOD(step)(&x, &v, h, &c, damped, loaded);
        all &= store_group(block, i, b.x + i, b.v + i, &x, &v, 1, sign_bit(r.w) | sign_bit(r.g));
    }
    return all;
}

static bool METHOD(batch)(const batch_block *b)
{
    const bool damped = b->g.first != NULL, loaded = b->a.first != NULL;
    if (b->n > 1)
        return METHOD(groups)(b, damped, loaded);
    return SPRING_BY_FEATURES(damped, loaded, METHOD(single_step), b);
}

#undef SPRING_OWN_STEPS
#undef SPRING_METHOD
