/* SPDX-License-Identifier: MIT */
/* The frame clock: the time of every frame is converted to steps, carried over, or counted as dropped. */
#include <math.h>
#include <springstep/clock.h>
#include <string.h>

#include "check.h"

static void whole_frames(void)
{
    static const struct {
        double frame, alpha; /* in steps */
        uint64_t steps;
    } frames[] = {{2, 0, 2}, {1.5, 0.5, 1}, {0.5, 0, 1}, {0, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};
    spring_clock clock = {0};
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        double alpha = -1;
        CHECK(spring_clock_tick(&clock, frames[i].frame * 0.125, 0.125, 100, &alpha) == frames[i].steps, "whole steps");
        CHECK_BITS(alpha, frames[i].alpha, "what is left over");
    }
    CHECK(spring_clock_tick(&clock, 0, 0.125, 100, NULL) == 0, "alpha is optional");
}

static void dropped_time(void)
{
    spring_clock clock = {0};
    double alpha = -1;
    CHECK(spring_clock_tick(&clock, 2.0625, 0.125, 8, &alpha) == 8, "sixteen steps and a half, eight allowed");
    CHECK_BITS(clock.dropped, 1, "eight steps dropped");
    CHECK_BITS(clock.skipped, 1, "in this frame");
    CHECK_BITS(alpha, 0.5, "the fraction is kept");
    CHECK(spring_clock_tick(&clock, 0.25, 0.125, 0, &alpha) == 0, "no steps allowed");
    CHECK_BITS(clock.dropped, 1.25, "dropped time adds up");
    CHECK_BITS(clock.skipped, 0.25, "in this frame");
    CHECK(spring_clock_tick(&clock, 0.125, 0.125, 8, &alpha) == 1, "a short frame");
    CHECK_BITS(clock.skipped, 0, "drops nothing");
    CHECK(spring_clock_tick(&clock, 0x1p64 - clock.pending, 1, UINT64_MAX, &alpha) == UINT64_MAX, "2^64 steps");
    CHECK(spring_clock_tick(&clock, 1e300, 1e-300, UINT64_MAX, &alpha) == UINT64_MAX, "more than 2^64 steps");
    CHECK(isfinite(clock.dropped) && clock.pending < 1e-300, "a long frame and a short step stay finite");
}

/* Steps dt + pending + dropped is the sum of all frames, over a million frames of any length. */
static void nothing_is_lost(void)
{
    spring_clock clock = {0};
    const double dt = 1.0 / 240;
    double frames = 0, lost = 0, skipped = 0; /* Kahan's sum */
    uint64_t steps = 0;
    const int count = 1000000;
    for (int i = 0; i < count; i++) {
        const double frame = random_uniform(0, i % 100 == 0 ? 0.2 : 1.0 / 30);
        double alpha = -1;
        steps += spring_clock_tick(&clock, frame, dt, 12, &alpha);
        CHECK(alpha >= 0 && alpha < 1, "a fraction of a step");
        CHECK(clock.pending >= 0 && clock.pending < dt, "less than a step is pending");
        skipped += clock.skipped;
        CHECK_BITS(clock.dropped, skipped, "the total of what each frame dropped");
        const double term = frame - lost, sum = frames + term;
        lost = (sum - frames) - term;
        frames = sum;
    }
    /* a frame rounds pending + frame (half an ulp of 0.25 s at most) and, when it drops, the dropped sum */
    const double per_frame = 0x1p-55, per_drop = clock.dropped * DBL_EPSILON;
    CHECK(clock.dropped > 0, "some frames were too long");
    CHECK_CLOSE((double)steps * dt + clock.pending + clock.dropped, frames,
                count * per_frame + count / 100 * per_drop + frames * DBL_EPSILON, "rounding of each addition");
}

static void nothing_is_dropped_without_need(void)
{
    spring_clock clock = {0};
    for (int i = 0; i < 10000; i++) {
        const uint64_t needed = (uint64_t)((clock.pending + 0.1) * 240); /* 24, or 25 with what was left over */
        CHECK(spring_clock_tick(&clock, 0.1, 1.0 / 240, needed, NULL) == needed, "as many as allowed");
        CHECK_BITS(clock.dropped, 0, "the rounding of so many steps is no dropped time");
    }
}

static void refuse(spring_clock start, double frame_dt, double dt, const char *why)
{
    spring_clock clock = start;
    double alpha = -1;
    CHECK(spring_clock_tick(&clock, frame_dt, dt, 10, &alpha) == 0, why);
    CHECK(memcmp(&clock, &start, sizeof clock) == 0, "bad input leaves the clock as it was");
    CHECK(isnan(alpha), "bad input is told from a frame without a step");
}

/* Some timers run backwards at times. */
static void negative_frames(void)
{
    for (int i = 0; i < 1000; i++) {
        spring_clock backwards = {i % 2 ? random_uniform(0, 0.125) : 0, 0.5, 0}, no_time = backwards;
        double alpha = -1, want = -1;
        CHECK(spring_clock_tick(&backwards, -random_log(1e-9, 1e300), 0.125, 10, &alpha) == 0, "no step");
        CHECK(spring_clock_tick(&no_time, 0, 0.125, 10, &want) == 0, "no step");
        CHECK(memcmp(&backwards, &no_time, sizeof backwards) == 0, "as a frame of no time");
        CHECK_BITS(alpha, want, "as a frame of no time");
    }
}

static void bad_input(void)
{
    const spring_clock start = {0.01, 0.5, 0.25};
    const double bad[] = {NAN, INFINITY, -INFINITY, 0, -0.1};
    for (int i = 0; i < 5; i++) {
        if (i < 3)
            refuse(start, bad[i], 0.1, "frame not finite");
        refuse(start, 0.1, bad[i], "step not finite, or not positive");
    }
    refuse((spring_clock){.pending = 1.7e308}, 1.7e308, 0.1, "the sum overflows");
    refuse((spring_clock){.pending = -1}, 0.1, 0.1, "a clock that was never started");
    double alpha = -1;
    CHECK(spring_clock_tick(NULL, 0.1, 0.1, 10, &alpha) == 0, "no clock");
    CHECK(isnan(alpha), "bad input is told from a frame without a step");
}

int main(void)
{
    static const test tests[] = {
        {"whole frames", whole_frames},       {"dropped time", dropped_time},
        {"nothing is lost", nothing_is_lost}, {"nothing is dropped without need", nothing_is_dropped_without_need},
        {"negative frames", negative_frames}, {"bad input", bad_input},
    };
    return RUN_TESTS("clock", tests);
}
