/* SPDX-License-Identifier: MIT */
/*
 * Wrong versions of spring_advance() and spring_scene_advance(), which spring-validate must detect. Linked with
 * -Dspring_advance=wrong_advance and similar. The environment variable WRONG selects the error.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#undef spring_advance
#undef spring_scene_advance
#include <springstep/scene.h>

spring_status wrong_advance(spring_state *s, const spring_params *p, spring_method m, double dt, uint64_t n);

spring_status wrong_advance(spring_state *s, const spring_params *p, spring_method m, double dt, uint64_t n)
{
    const char *way = getenv("WRONG");
    const spring_state start = *s;
    spring_status status = spring_advance(s, p, m, dt, n);
    if (strcmp(way, "refused") == 0)
        status = SPRING_EINVAL;
    if (strcmp(way, "refused") == 0 || strcmp(way, "unmoved") == 0)
        *s = start;
    if (strcmp(way, "lost") == 0)
        *s = (spring_state){NAN, NAN};
    if (strcmp(way, "x off") == 0)
        s->x *= 1 + 1e-5;
    if (strcmp(way, "v off") == 0)
        s->v *= 1 + 1e-5;
    return status;
}

/* Of all particles, as many as there are. */
static void scale(spring_scene *s, spring_quantity q, double factor)
{
    double x[3] = {0};
    for (size_t i = 0; spring_scene_get(s, q, x, 3, i, 1) == SPRING_OK; i++) {
        for (int axis = 0; axis < 3; axis++)
            x[axis] *= factor;
        spring_scene_set(s, q, x, 3, i, 1);
    }
}

/* A method of the highest order below; m itself if there is none. */
static spring_method next_lower(spring_method m)
{
    const int order = spring_method_describe(m)->order;
    spring_method lower = m;
    int highest = 0;
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method_info *info = spring_method_describe(spring_method_at(i));
        if (info->scenes && info->order < order && info->order > highest) {
            lower = spring_method_at(i);
            highest = info->order;
        }
    }
    return lower;
}

spring_status wrong_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n);

spring_status wrong_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n)
{
    const char *way = getenv("WRONG");
    if (strcmp(way, "refused") == 0)
        return SPRING_EINVAL;
    if (strcmp(way, "lost") == 0)
        return SPRING_ENONFINITE;
    if (strcmp(way, "unmoved") == 0)
        return SPRING_OK;
    if (strcmp(way, "lower order") == 0) { /* and the lowest a shorter run */
        const spring_method lower = next_lower(m);
        return lower == m ? spring_scene_advance(s, m, dt, n - 1) : spring_scene_advance(s, lower, dt, n);
    }
    const spring_status status = spring_scene_advance(s, m, dt, n);
    if (strcmp(way, "x off") == 0)
        scale(s, SPRING_POSITION, 1 + 1e-5);
    if (strcmp(way, "v off") == 0)
        scale(s, SPRING_VELOCITY, 1 + 1e-5);
    return status;
}
