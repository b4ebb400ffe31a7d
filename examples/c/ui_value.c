/* SPDX-License-Identifier: MIT */
/*
 * A value on a screen that follows a goal. The goal jumps, frames are of any length, steps are fixed, what is drawn lies
 * between the last two of them, and a value that has settled costs nothing.
 *
 *     cc -std=c11 ui_value.c -lspringstep -lm -o ui_value
 *
 * The goal goes into the load, stiffness * goal. Then x is the value itself, and nothing jumps with the goal. (With
 * x = value - goal the two states between which is drawn would be measured from two goals.)
 */
#include <springstep/clock.h>
#include <springstep/spring.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct ui_value {
    spring_params spring;
    spring_state previous, current; /* after the last step but one, after the last */
    spring_clock clock;
    bool asleep;
} ui_value;

static const double dt = 1.0 / 240;                      /* [s] of a step */
static const double near_enough = 0.05, slow_enough = 1; /* a twentieth of a pixel, a pixel a second */

static void set_goal(ui_value *u, double goal)
{
    u->spring.load = u->spring.stiffness * goal;
    u->asleep = false;
}

/* Take what a frame brings; returns what is to be drawn. */
static double frame(ui_value *u, double frame_time)
{
    double alpha;
    if (u->asleep)
        return u->current.x;
    for (uint64_t n = spring_clock_tick(&u->clock, frame_time, dt, 32, &alpha); n > 0; n--) {
        u->previous = u->current;
        spring_step_leapfrog(&u->current, &u->spring, dt);
    }
    if (spring_at_rest(&u->current, &u->spring, near_enough, slow_enough)) {
        u->current = (spring_state){u->spring.load / u->spring.stiffness, 0};
        u->previous = u->current;
        u->clock = (spring_clock){0};
        u->asleep = true;
        return u->current.x;
    }
    return u->previous.x + alpha * (u->current.x - u->previous.x);
}

int main(void)
{
    ui_value u = {.spring = spring_params_half_life(0.05, 0.7)}; /* swings over by a twentieth */
    if (!spring_params_valid(&u.spring) || !(dt < spring_stable_step(&u.spring, SPRING_LEAPFROG)))
        return 1;
    double t = 0, goal = 0;
    set_goal(&u, goal);
    for (int i = 0; i < 150; i++) {
        if (i == 10 || i == 30) { /* a click, and one while the value is still on its way */
            goal = i == 10 ? 100 : 40;
            set_goal(&u, goal);
            printf("goal %.0f  drawn %.5f, within %.2f of it in %.3f s\n", goal, frame(&u, 0), near_enough,
                   spring_settling_time(&u.current, &u.spring, near_enough));
        }
        const double frame_time = i % 7 == 3 ? 1.0 / 25 : 1.0 / 60; /* now and then one takes longer */
        t += frame_time;
        printf("%.4f s  goal %5.1f  drawn %9.5f%s\n", t, goal, frame(&u, frame_time), u.asleep ? "  asleep" : "");
    }
    return 0;
}
