/* SPDX-License-Identifier: MIT */
/*
 * An animated UI value follows a target. The target jumps, once while the value is still moving. Frame times vary. A
 * settled value sleeps and costs no time.
 *
 *     cc -std=c11 ui_value.c -lspringstep -lm -o ui_value
 */
#include <math.h>
#include <springstep/spring.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct ui_value {
    spring_params spring;
    spring_state state; /* the value and its velocity */
    double target;
    bool asleep;
} ui_value;

static const double near_enough = 0.05, slow_enough = 1; /* [pixels], [pixels/s] */

static void set_target(ui_value *u, double target)
{
    u->target = target; /* the state is kept, so neither the value nor its velocity jumps */
    u->asleep = false;
}

/* Advances by a frame. Returns the value to draw. */
static double frame(ui_value *u, double frame_time)
{
    if (u->asleep)
        return u->state.x;
    spring_follow(&u->state, &u->spring, u->target, 0, frame_time);
    if (fabs(u->state.x - u->target) <= near_enough && fabs(u->state.v) <= slow_enough) {
        u->state = (spring_state){u->target, 0};
        u->asleep = true;
    }
    return u->state.x;
}

/* The time until the value has settled near its target. */
static double time_left(const ui_value *u)
{
    const spring_state from_target = {u->state.x - u->target, u->state.v};
    return spring_settling_time(&from_target, &u->spring, near_enough);
}

int main(void)
{
    ui_value u = {.spring = spring_params_bounce(0.3, 0.3)}; /* overshoots by 5 % */
    if (!spring_params_valid(&u.spring))
        return 1;
    double t = 0;
    for (int i = 0; i < 150; i++) {
        if (i == 10 || i == 30) {
            set_target(&u, i == 10 ? 100 : 40);
            printf("target %.0f  drawn %.5f, within %.2f of it in %.3f s\n", u.target, u.state.x, near_enough,
                   time_left(&u));
        }
        const double frame_time = i % 7 == 3 ? 1.0 / 25 : 1.0 / 60; /* some frames take longer */
        const double drawn = frame(&u, frame_time);
        t += frame_time;
        printf("%.4f s  target %5.1f  drawn %9.5f%s\n", t, u.target, drawn, u.asleep ? "  asleep" : "");
    }
    return 0;
}
