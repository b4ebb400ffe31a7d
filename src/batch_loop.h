/* SPDX-License-Identifier: MIT */
/* The loop of a method over a batch, and its twelve kernels. Included by batch_kernels.h, with SPRING_METHOD its name. */

SPRING_INLINE bool METHOD(batch)(const batch_block *b, enum sharing w, enum sharing g, bool loaded)
{
    const real h = splat(b->dt);
    bool all = true;
    for (size_t i = 0; i < b->count; i += group) {
        METHOD(coefficients) c[vectors];
        real x[vectors], v[vectors];
        SPRING_UNROLL
        for (size_t k = 0; k < vectors; k++) {
            const size_t j = i + k * lanes;
            c[k] = METHOD(prepare)(rates_at(b, j, w, g, loaded), h);
            x[k] = load(b->x + j);
            v[k] = load(b->v + j);
        }
        uint64_t left = b->n;
        do {
            uint64_t some = left < check_interval ? left : check_interval;
            left -= some;
            for (; some > 0; some--) {
                SPRING_UNROLL
                for (size_t k = 0; k < vectors; k++)
                    METHOD(step)(&x[k], &v[k], &c[k], g != NONE, loaded);
            }
        } while (left > 0 && !all_lost(x, v));
        all &= store_group(b, i, x, v, w, g);
    }
    return all;
}

#define BATCH_KERNEL(w, g)                                     \
    static bool METHOD(w##_##g)(const batch_block *b)          \
    {                                                          \
        return METHOD(batch)(b, w, g, false);                  \
    }                                                          \
    static bool METHOD(w##_##g##_loaded)(const batch_block *b) \
    {                                                          \
        return METHOD(batch)(b, w, g, true);                   \
    }

BATCH_KERNEL(SHARED, SHARED)
BATCH_KERNEL(SHARED, EACH)
BATCH_KERNEL(SHARED, NONE)
BATCH_KERNEL(EACH, SHARED)
BATCH_KERNEL(EACH, EACH)
BATCH_KERNEL(EACH, NONE)

#undef BATCH_KERNEL
#undef SPRING_METHOD
