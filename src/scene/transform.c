/* SPDX-License-Identifier: MIT */
/* Moving a whole scene by an affine map, x1 = A x + b and v1 = A v: teleport, rotation, reflection. */
#include "block.h"

#include "../simd/size_begin.h"

/* Element i of A x + b * part, for the particle whose coordinates start at x. */
static scalar transformed(const spring_scene *s, const double matrix[12], uint32_t row, const double x[3], double part)
{
    double sum = 0;
    for (uint32_t a = 0; a < s->layout.axes; a++)
        sum += matrix[4 * row + a] * x[a];
    return (scalar)(sum + part * matrix[4 * row + 3]);
}

/* Transforms a quantity of all particles, or only returns whether all results are finite. part: 1 adds b. */
static bool transform_quantity(spring_scene *s, spring_quantity q, const double matrix[12], double part, bool store)
{
    bool finite = true;
    for (size_t i = 0; i < s->layout.particles; i++) {
        double old[3] = {0};
        for (uint32_t a = 0; a < s->layout.axes; a++)
            old[a] = (double)scene_state(s, q, a)[i];
        for (uint32_t a = 0; a < s->layout.axes; a++) {
            const scalar moved = transformed(s, matrix, a, old, part);
            finite = finite && scalar_finite(moved);
            if (store)
                scene_set_state(s, q, a)[i] = moved;
        }
    }
    return finite;
}

spring_status spring_scene_transform(spring_scene *s, const double matrix[12])
{
    if (s == NULL || matrix == NULL)
        return SPRING_EINVAL;
    for (uint32_t row = 0; row < s->layout.axes; row++)
        for (uint32_t column = 0; column < 4; column++)
            if ((column < s->layout.axes || column == 3) && !spring_finite(matrix[4 * row + column]))
                return SPRING_EINVAL;
    if (!transform_quantity(s, SPRING_POSITION, matrix, 1, false) ||
        !transform_quantity(s, SPRING_VELOCITY, matrix, 0, false))
        return SPRING_ENONFINITE;
    transform_quantity(s, SPRING_POSITION, matrix, 1, true);
    transform_quantity(s, SPRING_VELOCITY, matrix, 0, true);
    scene_drop_forces(s);
    scene_clear_touched(s, 0, s->layout.particles);
    return SPRING_OK;
}

#include "../simd/size_end.h"
