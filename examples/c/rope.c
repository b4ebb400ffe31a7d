/* SPDX-License-Identifier: MIT */
/*
 * A rope hangs from a nail. It is grabbed, dragged, released, and cut.
 *
 *     cc -std=c11 rope.c -lspringstep -lm -o rope
 *
 * To drag a particle, pin it and move it with spring_scene_drive(). To release it, unpin it. The scene must have the
 * flag SPRING_SCENE_EDITABLE. For fast drags, see docs/dragging.md.
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 24, GRABBED = 23, CUT = 11, STEPS = 8 };              /* CUT: between 11 and 12; STEPS: per frame */
static const double frame_time = 1.0 / 60;                       /* [s] */
static const double spacing = 0.1, stiffness = 900, mass = 0.05; /* [m], [N/m], [kg] */

static void must(spring_status status, const char *what)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s: %s\n", what, spring_status_string(status));
    exit(1);
}

/* The mouse at time t [s]: up to the right, then a flick to the left. */
static void mouse(double t, double at[2])
{
    at[0] = t < 0.6 ? 1.2 * t : -0.4;
    at[1] = -2.3 + 0.9 * t;
}

/* The dragged particle follows the mouse at no more than half the wave speed of the rope; see docs/dragging.md. */
static void reach(double hand[2], const double to[2])
{
    const double most = 0.5 * spacing * sqrt(stiffness / mass) * frame_time; /* [m] per frame */
    const double way = hypot(to[0] - hand[0], to[1] - hand[1]), part = fmin(1, most / way);
    for (int axis = 0; axis < 2; axis++)
        hand[axis] += way > 0 ? part * (to[axis] - hand[axis]) : 0;
}

static void show(const char *what, const spring_scene *rope)
{
    double x[N][2], lower = 0;
    must(spring_scene_get(rope, SPRING_POSITION, x[0], 0, 0, N), "get");
    for (int i = CUT + 1; i < N; i++)
        lower += x[i][1] / (N - CUT - 1);
    printf("%-8s %.3f s  end %+.6f %+.6f m  lower half at %+.6f m\n", what, spring_scene_time(rope), x[N - 1][0],
           x[N - 1][1], lower);
}

int main(void)
{
    /* The grid lays the rope along x. Below, it is hung from its first particle. */
    const spring_grid grid = {.count = {N},
                              .axes = 2,
                              .spacing = spacing,
                              .stiffness = stiffness,
                              .damping = 0.3,
                              .pinned = SPRING_GRID_FIRST_X};
    double position[N][2];
    uint8_t pinned[N];
    spring_link link[N - 1];
    must(spring_grid_fill(&grid, position[0], pinned, link), "grid");
    for (int i = 0; i < N; i++) {
        position[i][1] = -position[i][0];
        position[i][0] = 0;
    }
    const spring_scene_def def = {.axes = 2,
                                  .flags = SPRING_SCENE_EDITABLE,
                                  .particles = N,
                                  .links = N - 1,
                                  .position = position[0],
                                  .mass_all = mass,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, -9.81}};
    size_t bytes;
    must(spring_scene_bytes(&def, &bytes), "definition");
    void *memory = malloc(bytes);
    if (memory == NULL)
        return 1;
    spring_scene *rope;
    must(spring_scene_init(memory, bytes, &def, &rope), "init");
    if (!(frame_time / STEPS < 0.5 * spring_scene_stable_step(rope, SPRING_LEAPFROG)))
        return 1;
    show("hangs", rope);

    const uint8_t yes = 1, no = 0;
    double hand[2], to[2];
    must(spring_scene_get(rope, SPRING_POSITION, hand, 0, GRABBED, 1), "get");
    must(spring_scene_set_pinned(rope, GRABBED, 1, &yes), "grab");
    for (int i = 1; i <= 60; i++) {
        mouse(i * frame_time, to);
        reach(hand, to);
        must(spring_scene_drive(rope, GRABBED, hand, frame_time), "drag"); /* arrives at the end of this frame */
        must(spring_scene_advance(rope, SPRING_LEAPFROG, frame_time / STEPS, STEPS), "advance");
        if (i % 4 == 0) {
            printf("mouse %+.6f %+.6f  hand %+.6f %+.6f m\n", to[0], to[1], hand[0], hand[1]);
            show("dragged", rope);
        }
    }
    must(spring_scene_set_pinned(rope, GRABBED, 1, &no), "let go"); /* it keeps the velocity of the drag */
    must(spring_scene_advance(rope, SPRING_LEAPFROG, frame_time / STEPS, 30 * STEPS), "advance");
    show("let go", rope);

    spring_link cut;
    const size_t index = spring_scene_find_link(rope, CUT, CUT + 1);
    must(spring_scene_get_link(rope, index, &cut), "find");
    cut.stiffness = cut.damping = 0;
    must(spring_scene_set_link(rope, index, &cut), "cut");
    for (int i = 0; i < 3; i++) { /* the lower half falls freely: second differences of its height are -g t^2 */
        show("cut", rope);
        must(spring_scene_advance(rope, SPRING_LEAPFROG, frame_time / STEPS, 15 * STEPS), "advance");
    }
    free(memory);
    return 0;
}
