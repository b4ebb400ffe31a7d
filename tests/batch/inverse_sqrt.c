/* SPDX-License-Identifier: MIT */
/* vec_inverse_sqrt() for vectors of SPRING_VECTOR bytes, or without vectors, as a function named INVERSE_SQRT. See
   test_inverse_sqrt.c. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "simd/targets.h"

#if SPRING_VECTOR == 16 || SPRING_LONG_VECTORS

#include "simd/target_begin.h"

#include "simd/real_tmpl.h"

void INVERSE_SQRT(scalar *a, const int8_t *where, size_t count); /* in place; count: a multiple of 64 */

void INVERSE_SQRT(scalar *a, const int8_t *where, size_t count)
{
    enum { many = 4 };
    for (size_t i = 0; i < count; i += many * lanes) {
        real each[many];
        lane_mask joined[many];
        for (size_t k = 0; k < many; k++) {
            each[k] = vec_load(a + i + k * lanes);
            joined[k] = vec_load_mask(where + i + k * lanes);
        }
        vec_inverse_sqrt(each, joined, many);
        for (size_t k = 0; k < many; k++)
            vec_store(a + i + k * lanes, each[k]);
    }
}

#include "simd/target_end.h"

#endif
