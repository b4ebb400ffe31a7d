/* SPDX-License-Identifier: MIT */
/*
 * Fixed steps from frames of any length.
 *
 * Method    fmod() gives the exact remainder of the pending time by dt, so a frame adds the rounding error of one
 *           addition and no other.
 * Source    G. Fiedler, Fix your timestep (2004)
 */
#include "../simd/arithmetic.h"

#include <math.h>
#include <stddef.h>

#include <springstep/clock.h>

uint64_t spring_clock_tick(spring_clock *clock, double frame_dt, double dt, uint64_t max_steps, double *alpha)
{
    if (alpha != NULL)
        *alpha = (double)NAN;
    const double frame = frame_dt < 0 ? 0 : frame_dt;
    if (clock == NULL || !(clock->pending >= 0) || !spring_finite(frame_dt) || !(dt > 0) || !spring_finite(dt) ||
        !spring_finite(clock->pending + frame))
        return 0;
    const double total = clock->pending + frame;
    const double remainder = fmod(total, dt);
    const double whole = rint((total - remainder) / dt);
    const uint64_t steps = whole < (double)max_steps ? (uint64_t)whole : max_steps;
    clock->skipped = whole > (double)steps ? (total - remainder) - (double)steps * dt : 0;
    clock->dropped += clock->skipped;
    clock->pending = remainder;
    if (alpha != NULL)
        *alpha = remainder / dt;
    return steps;
}
