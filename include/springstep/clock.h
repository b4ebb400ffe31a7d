/* SPDX-License-Identifier: MIT */
/** @file
 * Fixed time steps from frames of variable duration.
 */
#ifndef SPRINGSTEP_CLOCK_H
#define SPRINGSTEP_CLOCK_H

#include <stdint.h>

#include <springstep/version.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Accumulates frame time that is not yet simulated. Zero-initialise.
 *
 * After the steps of a frame, the simulation is `pending` behind real time. A moving target, such as the hand that holds
 * a rope, must be reached after n dt + pending, counted from the start of the n steps, not after n dt. docs/games.md
 * has the loop. */
typedef struct spring_clock {
    double pending; /**< [s] time carried over to the next frame; always less than one step */
    double dropped; /**< [s] total time dropped because frames required more than max_steps steps */
    double skipped; /**< [s] time that the last tick dropped, usually 0 */
} spring_clock;

/**
 * Adds the duration of a frame to the clock, and returns the number of whole time steps that the clock now holds.
 *
 *     uint64_t n = spring_clock_tick(&clock, frame_dt, dt, 8, &alpha);
 *     for (; n > 0; n--) { previous = current; spring_step_leapfrog(&current, &p, dt); }
 *     draw(previous.x + alpha * (current.x - previous.x));
 *
 * A very long frame (a breakpoint, a page fault) would require more steps than there is time for. Whole steps beyond
 * max_steps are dropped. Their time is stored in clock->skipped and added to clock->dropped.
 *
 * @param[in,out] clock      zero-initialised at the start
 * @param[in]     frame_dt   duration of this frame [s]; a negative duration counts as 0
 * @param[in]     dt         time step > 0 [s]; the same at every call
 * @param[in]     max_steps  largest number of steps to return
 * @param[out]    alpha      in [0, 1): the remaining fraction of a step, for interpolation between the last two states;
 *                           may be NULL. NaN after invalid input.
 * @return number of steps to take now. Invalid input (NULL clock, a time that is not finite, dt <= 0, negative pending
 *         time, a sum of pending and frame_dt that overflows): 0 steps, *alpha = NaN and an unchanged clock. With valid
 *         input, *alpha is never NaN.
 * @par Accuracy  each frame rounds pending + frame_dt once; the carried-over time is the exact remainder of this sum
 *                divided by dt
 * @par Threads   re-entrant; allocates nothing and keeps no state except the clock
 */
SPRING_API uint64_t spring_clock_tick(spring_clock *clock, double frame_dt, double dt, uint64_t max_steps,
                                      double *alpha);

#ifdef __cplusplus
}
#endif

#endif
