/* SPDX-License-Identifier: MIT */
/*
 * The loop of a method over a batch, and its twelve kernels. Included by a method's header, with SPRING_METHOD its name.
 *
 * What a method owes it: rates that are infinite or NaN leave x or v infinite or NaN, since only these are looked at
 * afterwards (see symplectic_euler_prepare()); and rates that are 0 give the bits of the step without them.
 */

/* many: vectors in a group. A single step needs no more than one: there is nothing to wait for but the next group,
   which the processor begins by itself. */
SPRING_INLINE bool METHOD(groups)(const batch_block *b, enum sharing w, enum sharing g, bool loaded, size_t many)
{
    const real h = splat(b->dt);
    bool all = true;
    for (size_t i = 0; i < b->count; i += many * lanes) {
        METHOD(coefficients) c[vectors];
        real x[vectors], v[vectors];
        SPRING_UNROLL
        for (size_t k = 0; k < many; k++) {
            const size_t j = i + k * lanes;
            c[k] = METHOD(prepare)(rates_at(b, j, w, g, loaded), h);
            x[k] = vec_load(b->x + j);
            v[k] = vec_load(b->v + j);
        }
        uint64_t left = many == 1 ? 1 : b->n;
        do {
            uint64_t some = left < SPRING_CHECK_INTERVAL ? left : SPRING_CHECK_INTERVAL;
            left -= some;
            for (; some > 0; some--) {
                SPRING_UNROLL
                for (size_t k = 0; k < many; k++)
                    METHOD(step)(&x[k], &v[k], &c[k], g != NONE, loaded);
            }
        } while (left > 0 && !all_lost(x, v));
        all &= store_group(b, i, x, v, many, w, g);
    }
    return all;
}

SPRING_INLINE bool METHOD(springs)(const batch_block *b, enum sharing w, enum sharing g, bool loaded)
{
    return b->n == 1 ? METHOD(groups)(b, w, g, loaded, 1) : METHOD(groups)(b, w, g, loaded, vectors);
}

#define BATCH_KERNEL(w, g)                                     \
    static bool METHOD(w##_##g)(const batch_block *b)          \
    {                                                          \
        return METHOD(springs)(b, w, g, false);                \
    }                                                          \
    static bool METHOD(w##_##g##_loaded)(const batch_block *b) \
    {                                                          \
        return METHOD(springs)(b, w, g, true);                 \
    }
BATCH_KERNEL(SHARED, SHARED)
BATCH_KERNEL(SHARED, EACH)
BATCH_KERNEL(SHARED, NONE)
BATCH_KERNEL(EACH, SHARED)
BATCH_KERNEL(EACH, EACH)
BATCH_KERNEL(EACH, NONE)
#undef BATCH_KERNEL

/* clang-format off */
#define BATCH_KERNEL(w, g) [g] = {METHOD(w##_##g), METHOD(w##_##g##_loaded)}
static const batch_method METHOD(batch) = {
    .kernel = {
        [SHARED] = {BATCH_KERNEL(SHARED, SHARED), BATCH_KERNEL(SHARED, EACH), BATCH_KERNEL(SHARED, NONE)},
        [EACH] = {BATCH_KERNEL(EACH, SHARED), BATCH_KERNEL(EACH, EACH), BATCH_KERNEL(EACH, NONE)},
    },
};
#undef BATCH_KERNEL
/* clang-format on */

#undef SPRING_METHOD
