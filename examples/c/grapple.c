/* SPDX-License-Identifier: MIT */
/*
 * A grappling rope with a body of 60 kg at its end. The program simulates the body as a point; a physics engine could
 * do this instead. The body swings, is reeled in, jumps so that the rope is slack, and falls until the rope tears.
 *
 *     cc -std=c11 grapple.c -lspringstep -lm -o grapple
 *
 * The end of the rope is a pinned particle. In each update it is moved to the next position of the body, and the
 * tension of the last link pulls the body.
 */
#include <springstep/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINKS = 24, N = LINKS + 1, STEPS = 5, RATE = 1600 }; /* steps per update, updates per second */
static const double update = 1.0 / RATE, weight = 60, gravity = 9.81;
static spring_scene *rope;
static spring_link link[LINKS];
static double body[3], velocity[3], tension; /* [m], [m/s], [N] */

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

static void set_length(double length)
{
    for (uint32_t i = 0; i < LINKS; i++)
        link[i].rest = length / LINKS;
    must(spring_scene_set_links(rope, 0, LINKS, link));
}

/* One update: the body pulls the rope, the rope pulls the body. */
static void move(void)
{
    double end[2][3], along[3], length = 0;
    for (int a = 0; a < 3; a++)
        body[a] += update * velocity[a];
    must(spring_scene_drive(rope, LINKS, body, update));
    must(spring_scene_advance(rope, SPRING_LEAPFROG, update / STEPS, STEPS));
    must(spring_scene_get(rope, SPRING_POSITION, end[0], 0, LINKS - 1, 2));
    for (int a = 0; a < 3; a++)
        along[a] = end[0][a] - end[1][a], length = hypot(length, along[a]);
    tension = spring_scene_tension(rope, LINKS - 1);
    for (int a = 0; a < 3; a++)
        velocity[a] += update * (tension / weight * along[a] / length - (a == 1 ? gravity : 0));
}

static void tell(const char *what)
{
    printf("%s  %.2f s  distance %.3f m  tension %.0f N  height %.2f m\n", what, spring_scene_time(rope),
           hypot(body[0], body[1]), tension, body[1]);
}

/* A quarter period of a pendulum that starts at rest at this angle: pi/2 sqrt(L/g)/agm(1, cos(angle/2)). */
static double quarter_period(double length, double angle)
{
    double a = 1, b = cos(angle / 2);
    for (double mean; a - b > 1e-9; a = mean)
        mean = (a + b) / 2, b = sqrt(a * b);
    return acos(-1) / 2 * sqrt(length / gravity) / a;
}

int main(void)
{
    const double length = 10, angle = 1;
    double x[N][3];
    const uint8_t pinned[N] = {[0] = 1, [LINKS] = 1};
    for (uint32_t i = 0; i < N; i++) {
        x[i][0] = length * i / LINKS * sin(angle), x[i][1] = -length * i / LINKS * cos(angle), x[i][2] = 0;
        if (i < LINKS)
            link[i] = (spring_link){i, i + 1, length / LINKS, 5e5, 10, 0};
    }
    const spring_scene_def def = {.flags = SPRING_SCENE_TENSION_ONLY | SPRING_SCENE_EDITABLE,
                                  .particles = N,
                                  .links = LINKS,
                                  .position = x[0],
                                  .mass_all = 0.05,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, -gravity, 0},
                                  .drag = 0.05};
    size_t bytes;
    must(spring_scene_bytes(&def, &bytes));
    void *memory = malloc(bytes);
    must(spring_scene_init(memory, bytes, &def, &rope)); /* NULL memory gives SPRING_EINVAL */
    for (int a = 0; a < 3; a++)
        body[a] = x[LINKS][a];
    if (!(update / STEPS < spring_scene_stable_step(rope, SPRING_LEAPFROG)))
        return 1;

    while (body[0] > 0)
        move();
    printf("lowest after %.3f s, a pendulum after %.3f s\n", spring_scene_time(rope), quarter_period(length, angle));
    tell("swing");
    for (int i = 0; i < RATE / 2; i++) {
        set_length(length - 4.0 * (i + 1) / RATE); /* at 4 m/s */
        move();
    }
    tell("reeled");
    velocity[0] = 0, velocity[1] = 7; /* a jump */
    for (int i = 0; i < RATE / 2; i++)
        move();
    tell("slack");
    size_t torn = 0;
    while (torn == 0 && spring_scene_time(rope) < 60) {
        move();
        must(spring_scene_tear(rope, 1.015, NULL, NULL, 0, &torn));
    }
    tell("torn");
    for (int i = 0; i < RATE / 2; i++)
        move();
    tell("falls");
    free(memory);
    return 0;
}
