/* SPDX-License-Identifier: MIT */
/* Scenes without undo after a failure: until everything has been set again, nothing is computed. */
#include "test_scene.h"

static void count_calls(void *user, double t, size_t particles, const scalar *const x[3],
                        const scalar *const v[3], scalar *const force[3])
{
    (void)t, (void)particles, (void)x, (void)v, (void)force;
    ++*(int *)user;
}

/* A callback that looks into a table by position must not be handed NaN. */
static void callback_is_left_alone(void)
{
    const spring_method methods[] = {SPRING_EULER, SPRING_LEAPFROG, SPRING_RK4};
    const double position[] = {0.3, -0.9}, fast[] = {10, -20}, at_rest[] = {0, 0}, dt = 0.013;
    const double huge = sizeof(scalar) == 4 ? 3e38 : 1e308;
    for (size_t k = 0; k < 3; k++) {
        int calls = 0;
        const scene_def def = {.axes = 1,
                               .flags = SPRING_SCENE_NO_UNDO,
                               .methods = all_methods,
                               .particles = 2,
                               .position = position,
                               .velocity = fast,
                               .mass_all = 1.7,
                               .force = count_calls,
                               .user = &calls};
        scene *s = scene_of(&def);
        CHECK(SCENE(advance)(s, methods[k], huge, 1) == SPRING_ENONFINITE, "overflow");
        CHECK(calls > 0, "the callback was asked before");
        SCENE(set)(s, SPRING_POSITION, position, 0, 0, 1);
        SCENE(set)(s, SPRING_VELOCITY, at_rest, 0, 0, 2);
        calls = 0;
        CHECK(SCENE(advance)(s, methods[k], dt, 1) == SPRING_ENONFINITE, "one particle is still lost");
        CHECK(calls == 0, "nothing is computed from what is lost");
        SCENE(set)(s, SPRING_POSITION, position, 0, 0, 2);
        CHECK(SCENE(advance)(s, methods[k], dt, 1) == SPRING_OK && calls > 0, "usable again");
        free(s);
    }
}

int main(void)
{
    static const test tests[] = {{"the callback is left alone", callback_is_left_alone}};
    return RUN_TESTS("scene_broken", tests);
}
