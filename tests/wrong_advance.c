/* SPDX-License-Identifier: MIT */
/*
 * spring_advance() gone wrong, for a spring-validate that must notice: linked with -Dspring_advance=wrong_advance.
 * The environment variable WRONG says in which way.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#undef spring_advance
#include <springstep/spring.h>

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
