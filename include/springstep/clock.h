/* SPDX-License-Identifier: MIT */
/** @file
 * Fixed steps from frames of any length.
 */
#ifndef SPRINGSTEP_CLOCK_H
#define SPRINGSTEP_CLOCK_H

#include <stdint.h>

#include <springstep/version.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Frame time that has not become steps. All zero is the start. */
typedef struct spring_clock {
    double pending; /**< [s] waits for the next frame; always less than one step */
    double dropped; /**< [s] given up since the start, because a frame asked for more than max_steps */
} spring_clock;

/**
 * Add one frame to the clock and take out the whole fixed steps it now holds.
 *
 *     uint64_t n = spring_clock_tick(&clock, frame_dt, dt, 8, &alpha);
 *     for (; n > 0; n--) { previous = current; spring_step_leapfrog(&current, &p, dt); }
 *     draw(previous.x + alpha * (current.x - previous.x));
 *
 * A frame that was too long (a breakpoint, a page fault) would ask for more steps than the next frame can afford;
 * what goes beyond max_steps whole steps is dropped and added to clock->dropped.
 *
 * @param[in,out] clock      zero-initialised at the start
 * @param[in]     frame_dt   length of this frame >= 0 [s]
 * @param[in]     dt         length of a step > 0 [s]; the same at every call
 * @param[in]     max_steps  most steps to return
 * @param[out]    alpha      in [0, 1): the part of a step that is left over, to draw between the last two states;
 *                           may be NULL
 * @return steps to take now. Bad input (NULL clock, non-finite or negative times, dt <= 0): 0 steps, *alpha = 0 and
 *         the clock unchanged.
 * @par Accuracy  a frame rounds pending + frame_dt once; what is left over is the exact remainder of that by dt
 * @par Threads   re-entrant; allocates nothing, keeps nothing but the clock
 */
SPRING_API uint64_t spring_clock_tick(spring_clock *clock, double frame_dt, double dt, uint64_t max_steps,
                                      double *alpha);

#ifdef __cplusplus
}
#endif

#endif
