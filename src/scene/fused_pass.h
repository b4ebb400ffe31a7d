/* SPDX-License-Identifier: MIT */
/* Motion, evaluation of forces and motion in one pass over the particles of a scene. */
#ifndef SPRINGSTEP_FUSED_PASS_H
#define SPRINGSTEP_FUSED_PASS_H

#include "pass.h"

/*
 * Advances all particles by `first`. Evaluates the forces at the positions first->x and the velocities v, at a fraction
 * of the step. Then, unless second_kernel is NULL, advances all particles by `second`, which uses these forces and does
 * not change positions. Returns false if a result is not finite.
 *
 * The results are those of move(), evaluate() and move(). If all links lie in bands and there is no callback, it is one
 * fused pass: the forces on a chunk of particles are computed as soon as `first` has advanced the other ends of their
 * links, and `second` advances the chunk while it is in the cache.
 */
SPRING_NOINLINE bool move_evaluate_move(scene_step *s, particle_kernel *first_kernel, const scene_motion *first,
                                        const scalar *v, double fraction, particle_kernel *second_kernel,
                                        const scene_motion *second)
{
    const scene_layout *l = &s->scene->layout;
    if (l->unbanded > 0 || s->scene->force != NULL || l->bands == 0) {
        if (!move(s, first_kernel, first))
            return false;
        evaluate(s, first->x, v, fraction);
        return second_kernel == NULL || move(s, second_kernel, second);
    }
    const size_t ahead = (l->band[l->bands - 1].offset + chunk - 1) / chunk * chunk;
    band_kernel *const forces = s->kernels->band_forces;
    for (size_t i = 0; i < l->particles + ahead; i += chunk) {
        if (i < l->particles &&
            !first_kernel(&s->particles, first, i, i + chunk < l->particles ? i + chunk : l->particles))
            return false;
        if (i < ahead)
            continue;
        const size_t from = i - ahead, to = from + chunk < l->particles ? from + chunk : l->particles;
        forces(s->links, first->x, v, &s->forces, from, to);
        if (second_kernel != NULL && !second_kernel(&s->particles, second, from, to))
            return false;
    }
    return true;
}

static inline bool move_and_evaluate(scene_step *s, particle_kernel *kernel, const scene_motion *m, const scalar *v,
                                     double fraction)
{
    return move_evaluate_move(s, kernel, m, v, fraction, NULL, NULL);
}

#endif
