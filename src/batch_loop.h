/* SPDX-License-Identifier: MIT */
/*
 * The loop of a method over a batch, and its four kernels. Included by a method's header, with SPRING_METHOD its name.
 *
 * What a method owes it: rates that are infinite or NaN leave x or v infinite or NaN, since only these are looked at
 * afterwards (see symplectic_euler_prepare()); and rates that are 0 give the bits of the step without them.
 */

/* many: vectors in a group. A single step needs no more than one: there is nothing to wait for but the next group,
   which the processor begins by itself, and springs in memory are slower in groups of eight. Several steps keep the
   coefficients from group to group where all springs share them; the loop for one step is faster if it does not ask. */
SPRING_INLINE bool METHOD(groups)(const batch_block *block, bool damped, bool loaded, size_t many)
{
    const batch_block b = *block; /* which no store can change, for all the compiler knows */
    const bool keep = many > 1 && b.w.step + b.g.step + b.a.step == 0;
    const real h = splat(b.dt);
    bool all = true;
    for (size_t i = 0; i < b.count;) {
        METHOD(coefficients) c[vectors];
        mask signs = {0};
        SPRING_UNROLL
        for (size_t k = 0; k < many; k++) {
            const spring_rates r = rates_at(&b, i + k * lanes, damped, loaded);
            c[k] = METHOD(prepare)(r, h, damped);
            signs |= sign_bit(r.w) | sign_bit(r.g);
        }
        do {
            real x[vectors], v[vectors];
            SPRING_UNROLL
            for (size_t k = 0; k < many; k++) {
                x[k] = vec_load(b.x + i + k * lanes);
                v[k] = vec_load(b.v + i + k * lanes);
            }
            uint64_t left = many == 1 ? 1 : b.n;
            do {
                uint64_t some = left < SPRING_CHECK_INTERVAL ? left : SPRING_CHECK_INTERVAL;
                left -= some;
                for (; some > 0; some--) {
                    SPRING_HOT_LOOP("spring", many * lanes);
                    SPRING_UNROLL
                    for (size_t k = 0; k < many; k++)
                        METHOD(step)(&x[k], &v[k], &c[k], damped, loaded);
                }
            } while (left > 0 && !all_lost(x, v));
            all &= store_group(block, i, b.x + i, b.v + i, x, v, many, signs);
            i += many * lanes;
        } while (keep && i < b.count);
    }
    return all;
}

SPRING_INLINE bool METHOD(springs)(const batch_block *b, bool damped, bool loaded)
{
    return b->n == 1 ? METHOD(groups)(b, damped, loaded, 1) : METHOD(groups)(b, damped, loaded, vectors);
}

static bool METHOD(batch_plain)(const batch_block *b)
{
    return METHOD(springs)(b, false, false);
}

static bool METHOD(batch_loaded)(const batch_block *b)
{
    return METHOD(springs)(b, false, true);
}

static bool METHOD(batch_damped)(const batch_block *b)
{
    return METHOD(springs)(b, true, false);
}

static bool METHOD(batch_damped_loaded)(const batch_block *b)
{
    return METHOD(springs)(b, true, true);
}

static const batch_method METHOD(batch) = {
    .kernel = {{METHOD(batch_plain), METHOD(batch_loaded)}, {METHOD(batch_damped), METHOD(batch_damped_loaded)}},
};

#undef SPRING_METHOD
