/* SPDX-License-Identifier: MIT */
/* Lists of methods for tests, in the order of the table of the library. Tests include new methods automatically. */
#ifndef TEST_METHODS_H
#define TEST_METHODS_H

#include <springstep/spring.h>

/* Ends each list. */
static const spring_method no_method = (spring_method)SPRING_METHOD_COUNT;

typedef bool method_choice(const spring_method_info *m);

static inline const spring_method *list_methods(spring_method list[SPRING_METHOD_COUNT + 1], method_choice *chosen)
{
    int count = 0;
    for (int i = 0; i < SPRING_METHOD_COUNT; i++)
        if (chosen(spring_method_describe(spring_method_at(i))))
            list[count++] = spring_method_at(i);
    list[count] = no_method;
    return list;
}

static inline bool for_springs(const spring_method_info *m)
{
    return m->springs;
}

static inline bool steps_springs(const spring_method_info *m)
{
    return m->springs && m->order > 0;
}

/* For one spring and batches. */
static inline const spring_method *spring_methods(void)
{
    static spring_method list[SPRING_METHOD_COUNT + 1];
    return list_methods(list, for_springs);
}

/* Those of them whose error depends on the step: all but the exact solution. */
static inline const spring_method *steppers(void)
{
    static spring_method list[SPRING_METHOD_COUNT + 1];
    return list_methods(list, steps_springs);
}

/* Does a scene keep the force at the end of a step of it for the next? */
static inline bool keeps_force(spring_method m)
{
    return m == SPRING_LEAPFROG || m == SPRING_RKN8 || m == SPRING_SRKN6;
}

/* Without damping no step of it is stable, as with Euler's method. */
static inline bool never_stable(spring_method m)
{
    const spring_params undamped = {.mass = 1.3, .stiffness = 2.7};
    return spring_stable_step(&undamped, m) == 0;
}

#endif
